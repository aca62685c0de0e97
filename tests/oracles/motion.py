"""A quantity that moves in time: its value, rate and acceleration, carried through the chain rule exactly.

The oracles state positions only. Velocities and accelerations follow from this arithmetic, and so do
virtual displacements: a virtual displacement is the rate of a motion with the clock stopped. Everything in
it is analytic, so a complex step through it is exact too.
"""

import numpy as np


class Motion:
    """Value, rate and acceleration of an array (all three broadcast to one shape)."""

    __array_ufunc__ = None  # arrays on the left let this class do the arithmetic

    def __init__(self, value, rate=0.0, acceleration=0.0):
        self.value, self.rate, self.acceleration = np.broadcast_arrays(value, rate, acceleration)

    def __getitem__(self, index):
        return Motion(self.value[index], self.rate[index], self.acceleration[index])

    def __add__(self, other):
        pairs = zip(_parts(self), _parts(still(other)), strict=True)
        return Motion(*(mine + its for mine, its in pairs))

    def __neg__(self):
        return Motion(-self.value, -self.rate, -self.acceleration)

    def __sub__(self, other):
        return self + (-still(other))

    def __rsub__(self, other):
        return still(other) - self

    def __mul__(self, other):
        return product(np.multiply, self, other)

    def __truediv__(self, other):
        return self * reciprocal(other)

    __radd__, __rmul__ = __add__, __mul__


def still(quantity):
    """A constant as a motion."""
    return quantity if isinstance(quantity, Motion) else Motion(np.asarray(quantity))


def product(multiply, a, b):
    """Any bilinear product of two motions."""
    if not isinstance(b, Motion):
        return Motion(multiply(a.value, b), multiply(a.rate, b), multiply(a.acceleration, b))
    a = still(a)
    return Motion(
        multiply(a.value, b.value),
        multiply(a.rate, b.value) + multiply(a.value, b.rate),
        multiply(a.acceleration, b.value) + 2 * multiply(a.rate, b.rate) + multiply(a.value, b.acceleration),
    )


def reciprocal(a):
    inverse = 1 / a.value
    rate = -(inverse**2) * a.rate
    return Motion(inverse, rate, -(inverse**2) * a.acceleration - 2 * inverse * a.rate * rate)


def sin(angle):
    s, c = np.sin(angle.value), np.cos(angle.value)
    return Motion(s, c * angle.rate, c * angle.acceleration - s * angle.rate**2)


def cos(angle):
    s, c = np.sin(angle.value), np.cos(angle.value)
    return Motion(c, -s * angle.rate, -s * angle.acceleration - c * angle.rate**2)


def dot(a, b):
    return product(lambda u, v: (u * v).sum(-1), a, b)


def cross(a, b):
    return product(np.cross, a, b)


def vector(x, y, z):
    """A vector from its three components, which are stacked along the last axis."""
    x, y, z = still(x), still(y), still(z)
    return Motion(*(_stack(*parts) for parts in zip(_parts(x), _parts(y), _parts(z), strict=True)))


def scaled(scale, a):
    """A scalar times a vector."""
    return scale[..., None] * a


def turned(rotation, a):
    """The vector `a` turned by the rotation vector: exp([rotation]×) a.

    The two coefficients are power series of the squared angle, exact to rounding for angles below one half.
    """
    squared = dot(rotation, rotation)
    sine_over_angle = versine_over_square = still(0.0)
    for k in reversed(range(9)):  # Horner; 0.5^18/19! is far below rounding
        sine_over_angle = -(sine_over_angle * squared) + 1.0 / _factorial(2 * k + 1)
        versine_over_square = -(versine_over_square * squared) + 1.0 / _factorial(2 * k + 2)
    once = cross(rotation, a)
    twice = cross(rotation, once)
    return a + scaled(sine_over_angle, once) + scaled(versine_over_square, twice)


def _factorial(n):
    return float(np.prod(np.arange(1, n + 1)))


def _parts(a):
    return a.value, a.rate, a.acceleration


def _stack(*components):
    return np.stack(np.broadcast_arrays(*components), axis=-1)
