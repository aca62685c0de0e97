"""A straight beam element in space, from its strain and kinetic energy.

Element axes are x up, y along the elastic axis from the inner to the outer end, z forward. Each end has six motions:
displacements along x, y, z and rotations about x, y, z. Between the ends the beam bends as a cubic in each of two
planes (Euler-Bernoulli: a section turns with the slope of the axis), and twists and stretches linearly:

    U = 1/2 int EI_b u''^2 + EI_c w''^2 + GJ theta'^2 + EA v'^2 dy        T = 1/2 int int |v + phi x r|^2 dm dy

with v the velocity of the elastic axis, phi the rate of turn of a section and r the place of a mass in the section. The
integrals over the section are its mass, two first moments (the mass centre beside the elastic axis), three second
moments, and the polar inertia of twist, which is given by itself. Every property is linear along the element.
"""

from __future__ import annotations

import functools

import sympy as sp

from derive import symbols as s
from derive.symbols import NUMBER, Dimension, dimension_of_unit

AXES = ("x", "y", "z", "alpha_x", "alpha_y", "alpha_z")
ENDS = ("inner", "outer")
COORDINATES = tuple(f"{end}_{axis}" for end in ENDS for axis in AXES)

element_length = s.quantity("element_length", r"\ell", "m", "length of a beam element")
element_position = s.quantity(
    "element_position",
    r"\eta",
    "",
    "place of a section: 0 at the inner end of its element, 1 at the outer end",
)


def _property(name: str, latex: str, part: str, unit: str, meaning: str) -> tuple[sp.Symbol, sp.Symbol]:
    """Declare the values of a property at both ends of an element; `part` is a subscript of its symbol."""
    inner, outer = (
        s.quantity(f"{end}_{name}", f"{latex}_{{{part}{count}}}", unit, f"{meaning}, at the {end} end")
        for count, end in enumerate(ENDS)
    )
    return inner, outer


BEAM_STIFFNESS = _property("beam_stiffness", "EI", "b", "N m^2", "bending stiffness up and down")
CHORD_STIFFNESS = _property("chord_stiffness", "EI", "c", "N m^2", "bending stiffness fore and aft")
TORSION_STIFFNESS = _property("torsion_stiffness", "GJ", "", "N m^2", "torsion stiffness")
AXIAL_STIFFNESS = _property("axial_stiffness", "EA", "", "N", "axial stiffness")
# Integrals over the section by the powers of the mass's distances above and ahead of the elastic axis.
_FIRST, _SECOND = "first moment of mass per length,", "second moment of mass per length,"
SECTION_MASS = {
    (0, 0): _property("mass_per_length", r"\mu", "", "kg/m", "mass per length"),
    (1, 0): _property("first_moment_up", r"\mu", "x", "kg", f"{_FIRST} above the axis"),
    (0, 1): _property("first_moment_forward", r"\mu", "z", "kg", f"{_FIRST} ahead of the axis"),
    (2, 0): _property("second_moment_up", r"\mu", "xx", "kg m", f"{_SECOND} above the axis"),
    (1, 1): _property("product_of_inertia", r"\mu", "xz", "kg m", f"{_SECOND} up times forward"),
    (0, 2): _property("second_moment_forward", r"\mu", "zz", "kg m", f"{_SECOND} ahead of the axis"),
}
TWIST_INERTIA = _property(
    "twist_inertia", r"\mu", r"\theta", "kg m", "polar inertia per length about the axis"
)

_DISTANCE = sp.symbols("up forward")
_ENDS_OF = {axis: [sp.Symbol(f"{end}_{axis}") for end in ENDS] for axis in AXES}
_COORDINATE = {f"{end}_{axis}": _ENDS_OF[axis][place] for place, end in enumerate(ENDS) for axis in AXES}


def dimension_of_motion(axis: str) -> Dimension:
    """Return the dimension of a motion of a section or of an end."""
    return NUMBER if "alpha" in axis else dimension_of_unit("m")


@functools.cache
def cubics() -> tuple[sp.Expr, ...]:
    """Return the cubics of unit displacement and slope at the inner end, then at the outer end."""
    eta, length = element_position, element_length
    factors = sp.symbols("c_0:4")
    cubic = sum(factor * eta**power for power, factor in enumerate(factors))
    slope = sp.diff(cubic, eta) / length
    ends = [part.subs(eta, place) for place in (0, 1) for part in (cubic, slope)]
    shapes = []
    for own in range(len(ends)):
        given = [end - int(place == own) for place, end in enumerate(ends)]
        shapes.append(sp.factor(cubic.subs(sp.solve(given, factors))))
    return tuple(shapes)


def _bent(displacement: str, slope_sign: int, rotation: str) -> sp.Expr:
    """Return the displacement of a section across the axis; a rotation of an end is its slope times the sign."""
    (at_inner, at_outer), turns = _ENDS_OF[displacement], _ENDS_OF[rotation]
    parts = (at_inner, slope_sign * turns[0], at_outer, slope_sign * turns[1])
    return sum(shape * part for shape, part in zip(cubics(), parts, strict=True))


def _linear(inner: sp.Expr, outer: sp.Expr) -> sp.Expr:
    return (1 - element_position) * inner + element_position * outer


def along(expression: sp.Expr) -> sp.Expr:
    """Return the derivative along the beam."""
    return sp.diff(expression, element_position) / element_length


@functools.cache
def section_motion() -> dict[str, sp.Expr]:
    """Return displacements and rotations of a section in the motions of the ends.

    A rotation about z lowers what lies outboard, a rotation about x carries it forward.
    """
    up, forward = _bent("x", -1, "alpha_z"), _bent("z", 1, "alpha_x")
    stretch, twist = _linear(*_ENDS_OF["y"]), _linear(*_ENDS_OF["alpha_y"])
    turns = (along(forward), twist, -along(up))
    return dict(zip(AXES, (up, stretch, forward, *turns), strict=True))


@functools.cache
def strain_energies() -> dict[str, sp.Expr]:
    """Return the strain energy per length of each part of the stiffness."""
    motion = section_motion()
    strains = {
        "beam": (BEAM_STIFFNESS, along(along(motion["x"]))),
        "chord": (CHORD_STIFFNESS, along(along(motion["z"]))),
        "torsion": (TORSION_STIFFNESS, along(motion["alpha_y"])),
        "axial": (AXIAL_STIFFNESS, along(motion["y"])),
    }
    return {part: _linear(*ends) * strain**2 / 2 for part, (ends, strain) in strains.items()}


@functools.cache
def kinetic_energy() -> sp.Expr:
    """Return the kinetic energy per length, for rates in place of the motions."""
    motion = section_motion()
    up, forward = _DISTANCE
    velocity = sp.Matrix([motion[axis] for axis in AXES[:3]])
    spin = sp.Matrix([sp.Symbol(f"spin_{axis}") for axis in "xyz"])
    of_mass = velocity + spin.cross(sp.Matrix([up, 0, forward]))
    polynomial = sp.Poly(sp.expand(of_mass.dot(of_mass)), up, forward)
    # Twist has a polar inertia of its own, in place of the sum of two second moments.
    energy = _linear(*TWIST_INERTIA) * spin[1] ** 2
    for powers, coefficient in polynomial.terms():
        per_mass = coefficient.subs(spin[1] ** 2, 0) if sum(powers) == 2 else coefficient
        energy += _linear(*SECTION_MASS[powers]) * per_mass
    return energy.subs(dict(zip(spin, (motion[axis] for axis in AXES[3:]), strict=True))) / 2


def motion(axis: str, coordinate: str) -> sp.Expr:
    """Motion of a section of a beam element per motion of its ends."""
    return sp.factor(sp.diff(section_motion()[axis], _COORDINATE[coordinate]))


def mass(row: str, column: str) -> sp.Expr:
    """Mass of a beam element, consistent with its shapes."""
    return _second_derivative(kinetic_energy(), row, column)


def beam_stiffness(row: str, column: str) -> sp.Expr:
    """Stiffness of a beam element in bending up and down."""
    return _second_derivative(strain_energies()["beam"], row, column)


def chord_stiffness(row: str, column: str) -> sp.Expr:
    """Stiffness of a beam element in bending fore and aft."""
    return _second_derivative(strain_energies()["chord"], row, column)


def torsion_stiffness(row: str, column: str) -> sp.Expr:
    """Stiffness of a beam element in twist."""
    return _second_derivative(strain_energies()["torsion"], row, column)


def axial_stiffness(row: str, column: str) -> sp.Expr:
    """Stiffness of a beam element in extension."""
    return _second_derivative(strain_energies()["axial"], row, column)


def _second_derivative(per_length: sp.Expr, row: str, column: str) -> sp.Expr:
    """Return the second derivative of an energy, a polynomial in the position, integrated along the element."""
    entry = sp.expand(sp.diff(per_length, _COORDINATE[row], _COORDINATE[column]))
    terms = sp.Poly(entry, element_position).terms()
    whole = sum((coefficient / (power + 1) for (power,), coefficient in terms), sp.Integer(0))
    return sp.factor_terms(sp.expand(whole * element_length))
