"""One blade of the nonlinear rotor, its matrices in rotating axes by complex steps, and what its sections meet.

The rotor of `tests.oracles` with a single blade at no azimuth has as many coordinates as a blade in rotating axes, so
every entry of a blade's matrices can be had from it: nothing is hidden by the sum over the blades.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tests.mutation.sections import POLYNOMIAL, Air, PolynomialAirfoil, StraightAirfoil, section_loads
from tests.mutation.transform import ONE_BLADE, in_rotating_axes, seen_from_blade
from tests.oracles.motion import Motion
from tests.oracles.nonlinear_rotor import (
    DOFS,
    FLAP,
    LAG,
    PITCH,
    NonlinearRotor,
    blades,
    clock,
    damper_rows,
    inertia_rows,
    linearised,
    spring_rows,
)
from tests.oracles.random_rotors import Pair, random_rotor
from tests.oracles.virtual_work import Aerodynamics, assembled, nose_up_rotation, quadrature

STEP = 1e-30
ORDER = 3  # stations in a panel: both sides use the same, so they need not integrate well
BALANCES = [DOFS.index(name) for name in ("flap_0", "lag_0", "pitch_0", "azimuth", "z")]
_PLACES = np.array([DOFS.index(name) for name in ONE_BLADE])

Matrices = tuple[NDArray, NDArray, NDArray]


@dataclass(frozen=True, eq=False)
class Point:
    """A rotor with everything at work, at a steady state that nothing need balance.

    rotor has a single blade and its share of the gimbal's spring and damper; trim are its steady coordinates.
    """

    pair: Pair
    rotor: NonlinearRotor
    trim: NDArray
    air: Aerodynamics
    n_blades: int
    pitch_flap_coupling: float
    pitch_lag_coupling: float
    airfoil: PolynomialAirfoil | StraightAirfoil = POLYNOMIAL

    @classmethod
    def random(cls, seed: int) -> Point:
        """Angles are larger than a rotor's, so that their higher orders count."""
        rng = np.random.default_rng(1000 + seed)
        n_blades = 3 + seed % 3
        pair = random_rotor(
            seed,
            n_blades=n_blades,
            precone=rng.uniform(0.1, 0.2),
            lag_hinge_offset=0.9 + 0.1 * seed,
            tables=bool(seed % 2),
        )
        state = {
            "coning": rng.uniform(0.1, 0.2),
            "lag": rng.uniform(-0.25, -0.15),
            "elastic_pitch": rng.uniform(-0.1, -0.05),
            "collective": rng.uniform(0.7, 0.9),
        }
        whole, trim = pair.oracle(_State(**state))
        shares = {name: getattr(whole, name) / n_blades for name in ("gimbal_stiffness", "gimbal_damping")}
        couplings = rng.uniform(0.2, 0.5, 2)
        air = pair.air(rng.uniform(90, 130), 1.1)
        return cls(pair, replace(whole, n_blades=1, **shares), trim, air, n_blades, *couplings)

    @property
    def state(self) -> dict[str, float]:
        """Trim state by the names of the derivation."""
        return {
            "coning": self.trim[FLAP],
            "lag": self.trim[LAG],
            "elastic_pitch": self.trim[PITCH],
            "collective": self.rotor.collective,
        }


@dataclass(frozen=True)
class _State:
    coning: float
    lag: float
    elastic_pitch: float
    collective: float


def quantities(point: Point) -> dict[str, float]:
    """What generated functions take of the whole blade, by name; mass integrals are sums over the point masses."""
    apart = ("airfoil", "chord", "twist", "aerodynamic_center", "offset_mass", "propeller_inertia")
    given = {k: v for k, v in point.pair.fields.items() if k not in apart}
    given |= point.state | hub_couplings(point) | offset_moments(point)
    rotor = point.rotor
    given["pitch_inertia"] = rotor.lumped_inertia
    given["propeller_moment"] = rotor.lumped_propeller_inertia / rotor.lumped_inertia
    given["pitch"] = given["collective"] + given["elastic_pitch"] - turned_by_linkages(point)
    given["structural_pitch"] = given["pitch"] + given["structural_pitch_offset"]
    return given | {
        "rotor_speed": point.rotor.rotor_speed,
        "airspeed": point.air.airspeed,
        "density": point.air.density,
        "speed_of_sound": point.air.speed_of_sound,
        "section_damping": 1.0,
        "pitch_flap_coupling": point.pitch_flap_coupling,
        "pitch_lag_coupling": point.pitch_lag_coupling,
    }


def turned_by_linkages(point: Point) -> float:
    """Angle, nose down, by which the linkages of the hinges turn the blade at its steady coning and lag."""
    rotor = point.rotor
    of_coning = rotor.kinematic_pitch_flap_coupling * point.trim[FLAP]
    return float(of_coning + rotor.kinematic_pitch_lag_coupling * point.trim[LAG])


def without_linkages(point: Point) -> Point:
    """The same blade at the same steady pitch, which its hinges do not turn."""
    gone = {"kinematic_pitch_flap_coupling": 0.0, "kinematic_pitch_lag_coupling": 0.0}
    collective = point.rotor.collective - turned_by_linkages(point)
    return replace(point, rotor=replace(point.rotor, collective=collective, **gone))


def all_on_axis(point: Point) -> Point:
    """The same blade with its masses and aerodynamic centres on the pitch axis."""
    center = (np.array([0.0, point.air.radius]), np.zeros(2))
    given = {"mass_offset": 0.0, "propeller_inertia": None}
    return replace(
        point, rotor=replace(point.rotor, **given), air=replace(point.air, aerodynamic_center=center)
    )


def arms(point: Point) -> tuple[NDArray, NDArray, NDArray]:
    """r, ρβ and ρζ of the point masses."""
    r, rotor = point.rotor.station, point.rotor
    return r, np.maximum(r - rotor.flap_hinge_offset, 0.0), np.maximum(r - rotor.lag_hinge_offset, 0.0)


def hub_couplings(point: Point) -> dict[str, float]:
    """I_βα, I_ζα and I_βζ."""
    mass, (r, flap_arm, lag_arm) = point.rotor.mass, arms(point)
    return {
        "flap_hub_inertia": mass @ (r * flap_arm),
        "lag_hub_inertia": mass @ (r * lag_arm),
        "flap_lag_inertia": mass @ (flap_arm * lag_arm),
    }


def offset_moments(point: Point) -> dict[str, float]:
    """Integrals of the masses beside the pitch axis, turned by the twist alone."""
    rotor, (_, _, lag_arm) = point.rotor, arms(point)
    cosine, sine = rotor.offset * np.cos(rotor.mass_twist), rotor.offset * np.sin(rotor.mass_twist)
    found = {}
    for name, x in (("cosine", cosine), ("sine", sine)):
        found[f"offset_{name}_moment"] = rotor.mass @ x
        found[f"offset_{name}_lag_inertia"] = rotor.mass @ (x * lag_arm)
    squares = {"cosine": cosine**2, "product": cosine * sine, "sine": sine**2}
    return found | {f"offset_{name}_inertia": rotor.mass @ square for name, square in squares.items()}


def beside_line(point: Point) -> dict[str, float]:
    """Sums over the masses beside the pitch axis at trim, by the names of the derivation."""
    rotor, (r, outboard, lag_arm) = point.rotor, arms(point)
    angle = rotor.mass_twist + quantities(point)["pitch"]
    root, cone, lag = rotor.precone, rotor.precone + point.state["coning"], point.state["lag"]
    inboard, flap_arm = r - outboard, outboard - lag_arm * (1 - np.cos(lag))
    offsets = {"along": rotor.offset * np.cos(angle), "below": rotor.offset * np.sin(angle)}
    along = {
        "radial": np.cos(root) * inboard + np.cos(cone) * flap_arm,
        "axial": np.sin(root) * inboard + np.sin(cone) * flap_arm,
        "flap": flap_arm,
        "lag": lag_arm,
    }
    found = {f"{name}_offset_moment": rotor.mass @ x for name, x in offsets.items()}
    for name, x in offsets.items():
        found |= {f"{name}_offset_{arm}_inertia": rotor.mass @ (x * length) for arm, length in along.items()}
        found[f"{name}_offset_inertia"] = rotor.mass @ x**2
    return found | {"along_below_offset_inertia": rotor.mass @ (offsets["along"] * offsets["below"])}


# Matrices in rotating axes


def blade_matrices(rows: Callable, point: Point, rotor: NonlinearRotor | None = None) -> Matrices:
    """M, C, K (12, 12) in rotating axes of rows(rotor, q, time)."""
    rotor = rotor or point.rotor
    fixed = linearised(lambda q, time: rows(rotor, q, time), point.trim, 0.0)
    one = tuple(matrix[np.ix_(_PLACES, _PLACES)] for matrix in fixed)
    return in_rotating_axes(one, rotor.rotor_speed)


def without(rotor: NonlinearRotor, *names: str) -> NonlinearRotor:
    """The rotor with some of its fields at zero; a hinge spring as soft as numbers allow, for it is divided by."""
    return replace(
        rotor, **{name: 1e-40 if name in ("flap_stiffness", "lag_stiffness") else 0 for name in names}
    )


def without_lumped(rotor: NonlinearRotor) -> NonlinearRotor:
    """The rotor with no pitch inertia but that of the masses beside the axis."""
    return replace(rotor, pitch_inertia=(rotor.mass * rotor.offset**2).sum())


def on_axis(rotor: NonlinearRotor) -> NonlinearRotor:
    """The rotor with its masses on the pitch axis, and without pitch inertia."""
    return replace(rotor, mass_offset=0.0, pitch_inertia=0.0)


def lumped(rotor: NonlinearRotor) -> NonlinearRotor:
    """The rotor with its masses on the pitch axis, and the lumped pitch inertia."""
    given = {"pitch_inertia": rotor.lumped_inertia, "propeller_inertia": rotor.lumped_propeller_inertia}
    return replace(rotor, mass_offset=0.0, **given)


@functools.cache
def mass_matrices(point: Point) -> Matrices:
    """Of the point masses alone, on the pitch axis."""
    return blade_matrices(inertia_rows, point, on_axis(point.rotor))


@functools.cache
def offset_matrices(point: Point) -> Matrices:
    """What the point masses have more where they lie beside the axis."""
    whole = blade_matrices(inertia_rows, point, without_lumped(point.rotor))
    return tuple(a - b for a, b in zip(whole, mass_matrices(point), strict=True))


def spring_matrices(point: Point) -> Matrices:
    """Of the hinge springs alone."""
    rotor = without(point.rotor, "control_stiffness", "gimbal_stiffness", "propeller_moment")
    return blade_matrices(spring_rows, point, rotor)


@functools.cache
def pitch_matrices(point: Point, *gone: str) -> Matrices:
    """Of pitch inertia, propeller moment, control system, gimbal restraint and dampers."""
    rotor = without(point.rotor, "flap_stiffness", "lag_stiffness", *gone)
    rotor = replace(lumped(rotor), mass=0 * rotor.mass)

    def rows(rotor, q, time):
        return inertia_rows(rotor, q, time) + spring_rows(rotor, q, time) + damper_rows(rotor, q, time)

    return blade_matrices(rows, point, rotor)


def vacuum_rows(rotor: NonlinearRotor, q: Motion, time: float) -> NDArray:
    return inertia_rows(rotor, q, time) + spring_rows(rotor, q, time)


# The air


def stations(point: Point) -> tuple[NDArray, NDArray, NDArray]:
    """Radius, weight and segment of each station: inboard of the hinges, between them, outboard."""
    r, weight = quadrature(point.air, point.rotor, ORDER)
    hinges = np.array([point.rotor.flap_hinge_offset, point.rotor.lag_hinge_offset])
    return r, weight, (r[:, None] > hinges).sum(axis=1)


def air_at(point: Point, r: NDArray, motion, drift=0.0) -> Air:
    """What sections of the first blade at r meet; `motion` is of `blades`, `drift` the velocity of the air."""
    velocity = motion.position.rate + np.array([0.0, 0.0, point.air.airspeed]) - drift
    pitch = motion.pitch.value
    pitch = pitch - point.pitch_flap_coupling * (motion.flap.value - point.trim[FLAP])
    pitch = pitch - point.pitch_lag_coupling * (motion.lag.value - point.trim[LAG])
    return Air(
        tangential=-(velocity * motion.chordwise.value).sum(-1),
        axial=(velocity * motion.normal.value).sum(-1),
        radial=(velocity * motion.spanwise.value).sum(-1),
        pitch=pitch + np.interp(r, *point.air.twist),
        spin=nose_up_rotation(motion),
        chord=np.interp(r, *point.air.chord),
        center=np.interp(r, *point.air.aerodynamic_center),
        density=point.air.density,
        speed_of_sound=point.air.speed_of_sound,
    )


def airload_rows(point: Point, rotor: NonlinearRotor, q: Motion, time: float, drift=0.0) -> NDArray:
    """What the airloads add to the left-hand side."""
    r, weight, _ = stations(point)
    motion = blades(rotor, r, q, clock(rotor, time))
    loads = section_loads(point.airfoil, air_at(point, r, motion, drift))
    force = loads["fx"][..., None] * motion.chordwise.value
    force = (
        force + loads["fn"][..., None] * motion.normal.value + loads["fd"][..., None] * motion.spanwise.value
    )
    return -assembled(rotor, r, q, time, motion, force * weight[:, None], loads["m"] * weight)


def air_matrices(point: Point) -> Matrices:
    """Of the airloads."""
    return blade_matrices(lambda rotor, q, time: airload_rows(point, rotor, q, time), point)


def gust_columns(point: Point) -> NDArray:
    """Loads (12, 3) on the right-hand side per unit velocity of the air along i, j, k."""
    columns = []
    for axis in ((0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)):  # i, j, k at no azimuth
        rows = airload_rows(point, point.rotor, Motion(point.trim), 0.0, 1j * STEP * np.array(axis))
        columns.append(-rows[_PLACES].imag / STEP)
    back = np.linalg.inv(seen_from_blade(ONE_BLADE, 0.0)[0])
    return back.T @ np.array(columns).T


def trim_air(point: Point) -> Air:
    """What the sections at the stations meet in steady flight, each number (stations,)."""
    r, _, _ = stations(point)
    motion = blades(point.rotor, r, Motion(point.trim), clock(point.rotor, 0.0))
    return air_at(point, r, motion).mapped(lambda number: np.broadcast_to(np.real(number), (1, len(r)))[0])


# The steady balance


def steady_rows(rows: Callable, point: Point) -> tuple[NDArray, NDArray]:
    """Steady loads (5,) of rows(rotor, q, time), and derivatives (5, 4) with coning, lag, elastic pitch, collective."""
    steady = rows(point.rotor, Motion(point.trim), 0.0)[BALANCES]
    slopes = np.zeros((len(BALANCES), 4))
    for column, place in enumerate((FLAP, LAG, PITCH)):
        moved = point.trim + 1j * STEP * np.eye(len(DOFS))[place]
        slopes[:, column] = rows(point.rotor, Motion(moved), 0.0)[BALANCES].imag / STEP
    turned = replace(point.rotor, collective=point.rotor.collective + 1j * STEP)
    slopes[:, 3] = rows(turned, Motion(point.trim), 0.0)[BALANCES].imag / STEP
    return steady.real, slopes
