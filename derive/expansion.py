"""A vector to second order at trim: its value and its first and second derivatives with the blade's coordinates.

Vectors are polynomial in the perturbations, and their components at trim are polynomials of one ring. Inertia and
airloads are both made of such vectors: where a point is, where it may virtually go, and how axes turn.
"""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp
from sympy.polys.rings import PolyElement

from derive import kinematics as kin
from derive.polynomials import PolynomialRing

Vector = list[PolyElement]
Along = tuple[str, ...]  # the coordinates that a derivative is taken along; () is the value


class Expansion:
    """A vector to second order at trim: its value, first and second derivatives by coordinate."""

    def __init__(self, ring: PolynomialRing, parts: Mapping[Along, Vector]):
        self.ring = ring
        self.parts = parts

    @classmethod
    def of(cls, ring: PolynomialRing, vector: sp.Matrix) -> Expansion:
        """Expand a vector that is polynomial in the perturbations; sines and cosines at trim go by their names."""
        perturbations = list(kin.q.values())
        parts: dict[Along, Vector] = {}
        for place, component in enumerate(vector):
            for powers, coefficient in sp.Poly(component, *perturbations).terms():
                if sum(powers) > 2:
                    continue
                key = tuple(name for name, n in zip(kin.COORDINATES, powers, strict=True) for _ in range(n))
                factor = 2 if any(n == 2 for n in powers) else 1
                values = parts.setdefault(key, [ring(0)] * len(vector))
                values[place] = ring(coefficient * factor)
                parts[key[::-1]] = values
        return cls(ring, parts)

    def along(self, *names: str) -> Vector:
        """Return the derivative along one or two coordinates, or the value if no coordinate is named."""
        return self.parts.get(names, [self.ring.ring.zero] * 3)

    def __add__(self, other: Expansion) -> Expansion:
        return Expansion(
            self.ring, {key: add(self.along(*key), other.along(*key)) for key in {*self.parts, *other.parts}}
        )

    def turned(self, turn: list[Expansion]) -> Expansion:
        """Return the product of a matrix, given by rows, and the vector."""
        keys = {key for factor in (*turn, self) for key in factor.parts}
        keys |= {a + b for a in keys for b in keys if len(a) + len(b) <= 2}
        return Expansion(self.ring, {key: [self._product(row, key) for row in turn] for key in keys})

    def _product(self, row: Expansion, key: Along) -> PolyElement:
        """Return a derivative of the product of a row and the vector."""
        ways: list[tuple[Along, Along]] = [(key, ()), ((), key)] if key else [((), ())]
        if len(key) == 2:
            ways += [(key[:1], key[1:]), (key[1:], key[:1])]
        return sum(dot(row.along(*a), self.along(*b)) for a, b in ways)


class MovingPoint:
    """A point of the blade's line, in rotating axes: where it is, and where it may virtually go.

    Parameters
    ----------
    ring : PolynomialRing
    line : Matrix
        The point in the yoke, in the arms of the deflected blade: `kinematics.deflected_line`, trigonometry named.
    """

    def __init__(self, ring: PolynomialRing, line: sp.Matrix):
        self.ring = ring
        self.turn = [Expansion.of(ring, kin.BLADE_TO_ROTATING[place, :]) for place in range(3)]
        self.about_hub = Expansion.of(ring, line).turned(self.turn)
        self.position = self.about_hub + Expansion.of(ring, kin.HUB)

    def virtual_displacement(self, row: str, *along: str) -> Vector:
        """Return the displacement per unit of a row's virtual motion, or a derivative of that displacement.

        A row is the generalised force of its coordinate, with one exception: the rows of hub rotation are moment
        resultants about the displaced hub point. Their virtual motion is a turn about fixed axes, and no change of
        exponential coordinates.
        """
        if row in kin.HUB_ROTATION:
            return cross(self.fixed_axis(row), self.about_hub.along(*along))
        return self.position.along(row, *along)

    def fixed_axis(self, row: str) -> Vector:
        """Return the axis of a hub rotation."""
        return self.ring.vector((kin.I_AXIS, kin.J_AXIS, kin.K_AXIS)[kin.HUB_ROTATION.index(row)])


def add(a: Vector, b: Vector) -> Vector:
    return [x + y for x, y in zip(a, b, strict=True)]


def dot(a: Vector, b: Vector) -> PolyElement:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def spin(vector: Vector) -> Vector:
    """k x vector."""
    return [-vector[1], vector[0], 0 * vector[2]]
