"""An element of an elastic blade that bends while it turns, from its energies per length.

Rotating axes of the rotor: j along the blade, k along the shaft, i against the rotation, so that displacements have the
senses of lag (in plane, along i) and of flap (out of plane, along k). The blade is straight but for its structural
twist, and does not stretch: where it bends, its points come nearer to the shaft,

    p(r) = (r + u) j + v i + w k,        u = - 1/2 int_0^r v'^2 + w'^2 dr.

To second order the work of the centrifugal force on u is that of a tension on the slopes, the tension at a station
being the centrifugal force of all that is outboard (`tension`):

    T = 1/2 int m |dp/dt + Omega k x p|^2 dr        U = 1/2 int EI_1 kappa_1^2 + EI_2 kappa_2^2 dr,

kappa_1 flatwise and kappa_2 edgewise curvature, in axes that are turned by the angle of the section as the pitch turns
the flap-lag springs. Between the ends of an element v and w are cubics. All properties are those at one station: the
entries are per length, and the sum over stations is left to a quadrature, since sines of a twist have no simple
integral.
"""

from __future__ import annotations

import functools

import sympy as sp

from derive import beam, flap_lag_springs
from derive import kinematics as kin
from derive import symbols as s
from derive.symbols import NUMBER, Dimension, dimension_of_unit

MOTIONS = ("in_plane", "in_plane_slope", "out_of_plane", "out_of_plane_slope")
COORDINATES = tuple(f"{end}_{motion}" for end in beam.ENDS for motion in MOTIONS)

station_flatwise_stiffness = s.quantity(
    "station_flatwise_stiffness", "EI_1", "N m^2", "flatwise bending stiffness at a station"
)
station_edgewise_stiffness = s.quantity(
    "station_edgewise_stiffness", "EI_2", "N m^2", "edgewise bending stiffness at a station"
)
station_angle = s.quantity(
    "station_angle", r"\Theta", "rad", "angle of the section's axes from the disk, nose up"
)
station_mass = s.quantity("station_mass", "m", "kg/m", "mass per length at a station")
station_tension = s.quantity(
    "station_tension", r"\mathcal{T}", "N", "centrifugal force of all that is outboard"
)
inner_radius = s.quantity("inner_radius", "r_0", "m", "inner end of the element from the centre of rotation")
outer_tension = s.quantity("outer_tension", r"\mathcal{T}_1", "N", "tension at the outer end of the element")

_COORDINATE = {name: sp.Symbol(name) for name in COORDINATES}
_RATE = {name: sp.Symbol(f"rate_{name}") for name in COORDINATES}


def dimension_of_motion(motion: str) -> Dimension:
    """Return the dimension of a motion of a station or of an end."""
    return NUMBER if "slope" in motion else dimension_of_unit("m")


@functools.cache
def displacements(rates: bool = False) -> dict[str, sp.Expr]:
    """Return the displacements of a station, or their rates, in the motions of the ends."""
    known = _RATE if rates else _COORDINATE
    return {
        motion: sum(
            cubic * known[f"{end}_{part}"]
            for cubic, (end, part) in zip(
                beam.cubics(),
                ((end, part) for end in beam.ENDS for part in (motion, f"{motion}_slope")),
                strict=True,
            )
        )
        for motion in ("in_plane", "out_of_plane")
    }


@functools.cache
def strain_energy() -> sp.Expr:
    """Return the strain energy per length: curvature flatwise and edgewise, as the section turns with the pitch."""
    bent = displacements()
    curvature = sp.Matrix([beam.along(beam.along(bent[motion])) for motion in ("out_of_plane", "in_plane")])
    flatwise, edgewise = flap_lag_springs.blade_axes(station_angle).T * curvature
    return (station_flatwise_stiffness * flatwise**2 + station_edgewise_stiffness * edgewise**2) / 2


@functools.cache
def kinetic_energy() -> sp.Expr:
    """Return the kinetic energy per length to second order, without what no bending changes.

    The mass m at r moves by u, the sum over all stations inboard of r of -(v'^2 + w'^2)/2. So the sum over all masses
    of m Omega^2 r u is minus the sum over all stations of the tension there times (v'^2 + w'^2)/2.
    """
    moved, rates = displacements(), displacements(rates=True)
    across = kin.I_AXIS * moved["in_plane"] + kin.K_AXIS * moved["out_of_plane"]
    rate = kin.I_AXIS * rates["in_plane"] + kin.K_AXIS * rates["out_of_plane"]
    velocity = rate + s.rotor_speed * kin.K_AXIS.cross(across)
    slopes = sum(beam.along(bent) ** 2 for bent in moved.values())
    return station_mass * velocity.dot(velocity) / 2 - station_tension * slopes / 2


def motion(row: str, column: str) -> sp.Expr:
    """Displacements and slopes of a station of a blade element per motion of its ends."""
    name = row.removesuffix("_slope")
    bent = displacements()[name]
    return sp.factor(sp.diff(beam.along(bent) if row != name else bent, _COORDINATE[column]))


def mass(row: str, column: str) -> sp.Expr:
    """Mass of a blade element per length, at a station."""
    return sp.factor(sp.diff(kinetic_energy(), _RATE[row], _RATE[column]))


def stiffness(row: str, column: str) -> sp.Expr:
    """Stiffness of a blade element per length, at a station: bending, tension and centrifugal force in the disk."""
    still = kinetic_energy().subs(dict.fromkeys(_RATE.values(), 0))
    return sp.factor_terms(sp.diff(strain_energy() - still, _COORDINATE[row], _COORDINATE[column]))


def twist_stiffness(row: str, column: str) -> sp.Expr:
    """Change of the stiffness of a blade element per length with the angle of the section, at a station.

    Half of it, times the motions of the ends twice, is the torque per length that opposes a turn of the section.
    """
    return sp.factor_terms(sp.diff(strain_energy(), _COORDINATE[row], _COORDINATE[column], station_angle))


def tension() -> list[tuple[sp.Symbol, sp.Expr]]:
    """Centrifugal force of all that is outboard of a station, for a mass per length that is linear in the element."""
    eta, length = beam.element_position, beam.element_length
    inner, outer = beam.SECTION_MASS[0, 0]
    place = sp.Symbol("place")
    per_length = ((1 - place) * inner + place * outer) * (inner_radius + place * length)
    of_element = s.rotor_speed**2 * length * sp.integrate(sp.expand(per_length), (place, eta, 1))
    return [(station_tension, outer_tension + sp.factor(of_element))]
