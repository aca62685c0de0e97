"""A blade about a trim that moves: its points, axes and pitch written down anew, with derivatives by complex steps.

Second derivatives are eighth-order differences of these, of vectors that are smooth over a radian: rounding leaves
1e-12 of them.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from math import factorial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from proprotor_equations import BLADE_COORDINATES

from tests.mutation import one_blade
from tests.mutation.airload_checks import BEYOND_FLAP, BEYOND_LAG
from tests.mutation.comparison import Check, Names, matrix_check, values_check
from tests.mutation.inputs import GENERAL, Quantities, blade_quantities, points, stacked
from tests.mutation.one_blade import STEP, Point
from tests.oracles.motion import Motion
from tests.oracles.nonlinear_rotor import central_difference, hinge_spring_energy

_HUB, _TURN = slice(0, 3), slice(3, 6)
_FLAP, _LAG, _PITCH, _AZIMUTH, _TILT_FLAP, _TILT_ROLL = range(6, 12)
_NONE = np.zeros(len(BLADE_COORDINATES))
_ARMS = ("inboard", "outboard", "lag")
_TERMS = 10  # of the power series of sine and versine


class Moving(NamedTuple):
    """A point with a trim that moves, and what steady forces and speeds are given there."""

    point: Point
    tilt: NDArray
    cyclic: NDArray
    force: NDArray  # (3 arms, 3)
    moments: NDArray  # on the pitch relative to shaft and yoke
    velocity: NDArray  # (2 powers, 3)
    section_moment: NDArray  # (segments,)
    spin: float


def checks() -> Iterator[Check]:
    yield from _angles()
    yield from _arms()
    yield from _tilt()
    yield from _geometry()
    yield from _second_order()
    yield from _springs()


@functools.cache
def _moving() -> tuple[Moving, ...]:
    found = []
    for seed, point in enumerate(points(GENERAL)):
        rng = np.random.default_rng([seed, 71])
        found.append(
            Moving(
                point,
                rng.uniform(0.2, 0.4, 2),
                rng.uniform(0.1, 0.2, 2),
                rng.uniform(1, 2, (3, 3)),
                rng.uniform(1, 2, 2),
                rng.uniform(1, 2, (2, 3)),
                rng.uniform(1, 2, len(BEYOND_FLAP)),
                float(rng.uniform(1, 2)),
            )
        )
    return tuple(found)


# Geometry


def _cross(vector: NDArray) -> NDArray:
    a, b, c = vector
    return np.array([[0, -c, b], [c, 0, -a], [-b, a, 0]])


def _yoke(tilt: NDArray) -> NDArray:
    """Rodrigues' rotation."""
    axis = np.array([tilt[0], tilt[1], 0 * tilt[0]])
    angle = np.sqrt(axis @ axis)
    spin = _cross(axis)
    return np.eye(3) + np.sin(angle) / angle * spin + (1 - np.cos(angle)) / angle**2 * spin @ spin


def _turned(moving: Moving, q: NDArray, vector: NDArray) -> NDArray:
    """A vector of the yoke in rotating axes; turns of hub and azimuth to second order."""
    hub, azimuth = _cross(q[_TURN]), _cross(np.array([0, 0, q[_AZIMUTH]]))
    yoke = _yoke(moving.tilt + q[_TILT_FLAP:])
    for turn in (np.eye(3) + azimuth + azimuth @ azimuth / 2, yoke, np.eye(3) + hub + hub @ hub / 2):
        vector = turn @ vector
    return vector


def _along(cone: Any, lag: Any = 0.0) -> NDArray:
    """Direction of a blade part by cone and lag."""
    out = np.cos(lag)
    return np.array([np.sin(lag) + 0 * out, out * np.cos(cone), out * np.sin(cone)])


def _position(moving: Moving, q: NDArray) -> NDArray:
    """Position per unit of each arm (3, 3), from the hub."""
    root, state = moving.point.rotor.precone, moving.point.state
    cone, lag = root + state["coning"] + q[_FLAP], state["lag"] + q[_LAG]
    lines = (_along(root), _along(cone), _along(cone, lag) - _along(cone))
    return np.array([_turned(moving, q, line) for line in lines])


def _axes(moving: Moving, q: NDArray, segment: int) -> NDArray:
    """i', n and d (3, 3) of the sections of a segment."""
    root, state = moving.point.rotor.precone, moving.point.state
    cone = root + BEYOND_FLAP[segment] * (state["coning"] + q[_FLAP])
    lag = BEYOND_LAG[segment] * (state["lag"] + q[_LAG])
    normal = np.array([0 * cone, -np.sin(cone), np.cos(cone)])
    outward = _along(cone)
    chordwise = np.array([np.cos(lag) + 0 * cone, 0, 0]) - np.sin(lag) * outward
    return np.array([_turned(moving, q, axis) for axis in (chordwise, normal, _along(cone, lag))])


def _pitch(moving: Moving, q: NDArray) -> NDArray:
    """Pitch relative to shaft and yoke; azimuth to second order."""
    rotor = moving.point.rotor
    cosine, sine = 1 - q[_AZIMUTH] ** 2 / 2, q[_AZIMUTH]

    def seen(along: NDArray) -> tuple[Any, Any]:
        return along[0] * cosine + along[1] * sine, along[1] * cosine - along[0] * sine

    flap, roll = seen(moving.tilt + q[_TILT_FLAP:])
    shaft = one_blade.quantities(moving.point)["pitch"] + q[_PITCH] + seen(moving.cyclic)[0]
    shaft = shaft - rotor.pitch_gimbal_coupling * flap
    shaft = shaft - rotor.kinematic_pitch_flap_coupling * q[_FLAP]
    shaft = shaft - rotor.kinematic_pitch_lag_coupling * q[_LAG]
    return np.array([shaft, shaft - roll])


def _changes(function: Callable[[NDArray], NDArray], at: NDArray = _NONE) -> NDArray:
    """Derivatives with each coordinate, along a last axis."""
    columns = [np.imag(function(at + 1j * STEP * unit)) / STEP for unit in np.eye(len(at))]
    return np.stack(columns, axis=-1)


def _with_value(function: Callable[[NDArray], NDArray]) -> NDArray:
    """Derivatives with each coordinate, then the value, along a last axis."""
    return np.concatenate([_changes(function), np.real(function(_NONE))[..., None]], axis=-1)


def _quantities() -> Quantities:
    """Of the whole blade (points,)."""
    found = []
    for m in _moving():
        own = {"trim_gimbal_flap": m.tilt[0], "trim_gimbal_roll": m.tilt[1]}
        own |= {"trim_cyclic": m.cyclic[0], "trim_cyclic_slope": m.cyclic[1]}
        own |= {
            f"{arm}_force_{axis}": m.force[i, j]
            for i, arm in enumerate(_ARMS)
            for j, axis in enumerate("ijk")
        }
        own |= {"shaft_pitch_moment": m.moments[0], "yoke_pitch_moment": m.moments[1], "trim_spin": m.spin}
        own |= {
            f"point_velocity_{axis}_{power}": m.velocity[power, j]
            for power in (0, 1)
            for j, axis in enumerate("ijk")
        }
        found.append(own | _turns(_rotation_of(m.tilt)))
    return blade_quantities(GENERAL) | stacked(found)


def _of_segments() -> Quantities:
    """Of the segments (points, segments)."""
    whole = {name: value[:, None] if np.ndim(value) else value for name, value in _quantities().items()}
    whole |= {"beyond_flap_hinge": BEYOND_FLAP[None], "beyond_lag_hinge": BEYOND_LAG[None]}
    whole |= {"m_0": np.array([m.section_moment for m in _moving()])} | _section_waves()
    chordwise = np.array([[_axes(m, _NONE, s)[0] for s in range(len(BEYOND_FLAP))] for m in _moving()])
    return whole | {f"chordwise_{axis}": chordwise[..., place] for place, axis in enumerate("ijk")}


def _section_waves() -> Quantities:
    root, coning, lag = (blade_quantities(GENERAL)[name][:, None] for name in ("precone", "coning", "lag"))
    return _waves(root + 0 * BEYOND_FLAP, root + BEYOND_FLAP * coning, BEYOND_LAG * lag)


def _waves(root: Any, cone: Any, lag: Any) -> Quantities:
    angles = {"precone": root, "cone": cone, "lag": lag}
    return {f"{f.__name__}_{name}": f(angle) for name, angle in angles.items() for f in (np.cos, np.sin)}


# Checks


def _angles() -> Iterator[Check]:
    q = blade_quantities(GENERAL)
    expected = _waves(q["precone"], q["precone"] + q["coning"], q["lag"])
    yield values_check(("moving", "blade_angles"), "sines and cosines", q, expected)
    yield values_check(("moving", "section_angles"), "sines and cosines", _of_segments(), _section_waves())


def _arms() -> Iterator[Check]:
    expected, lines = [], []
    for p in points(GENERAL):
        r, outboard, lag = one_blade.arms(p)
        arms = np.array([r - outboard, outboard, lag, np.ones_like(r)])
        expected.append((p.rotor.mass * arms) @ arms.T)
        flap, hinge = p.rotor.flap_hinge_offset, p.rotor.lag_hinge_offset
        by_segment = []
        for out, lagged in zip(BEYOND_FLAP, BEYOND_LAG, strict=True):
            ends = [[r - out * (r - flap), out * (r - flap), lagged * (r - hinge), 1.0] for r in (0.0, 1.0)]
            by_segment.append([ends[0], np.subtract(ends[1], ends[0])])
        lines.append(by_segment)
    sums = np.array(expected)
    size = sums.max(axis=(-2, -1), keepdims=True) * 1e3
    q = blade_quantities(GENERAL)
    yield matrix_check(("moving", "arm_inertia"), "sums over point masses", q, sums, size)
    sees = ("moving", "arms_of_segment")
    yield matrix_check(sees, "arms along a straight segment", _of_segments(), np.array(lines), 1.0)


def _series(square: float) -> dict[str, list[float]]:
    """Sine and versine over the angle and its square, with two derivatives, by their power series."""
    found = {}
    for name, first in (("sine", 1), ("versine", 2)):
        powers = np.polynomial.Polynomial([(-1) ** n / factorial(2 * n + first) for n in range(_TERMS)])
        found[name] = [powers.deriv(order)(square) if order else powers(square) for order in range(3)]
    return found


def _rotation_of(tilt: NDArray) -> dict[str, NDArray]:
    """Rotation of the yoke and its derivatives by the chain rule."""
    series = _series(float(tilt @ tilt))
    (a, a1, a2), (b, b1, b2) = series["sine"], series["versine"]
    spin = _cross(np.array([*tilt, 0.0]))
    units = [_cross(unit) for unit in np.eye(3)[:2]]
    both = [unit @ spin + spin @ unit for unit in units]

    def first(i: int) -> NDArray:
        return 2 * tilt[i] * (a1 * spin + b1 * spin @ spin) + a * units[i] + b * both[i]

    def second(i: int, j: int) -> NDArray:
        found = 4 * tilt[i] * tilt[j] * (a2 * spin + b2 * spin @ spin)
        found = found + 2 * tilt[i] * (a1 * units[j] + b1 * both[j])
        found = found + 2 * tilt[j] * (a1 * units[i] + b1 * both[i])
        found = found + 2 * (i == j) * (a1 * spin + b1 * spin @ spin)
        return found + b * (units[i] @ units[j] + units[j] @ units[i])

    return {
        "yoke": np.eye(3) + a * spin + b * spin @ spin,
        "yoke_flap": first(0),
        "yoke_roll": first(1),
        "yoke_flap_flap": second(0, 0),
        "yoke_flap_roll": second(0, 1),
        "yoke_roll_roll": second(1, 1),
    }


def _turns(of: dict[str, NDArray]) -> dict[str, float]:
    return {
        f"{name}_{row}{column}": matrix[i, j]
        for name, matrix in of.items()
        for i, row in enumerate("ijk")
        for j, column in enumerate("ijk")
    }


def _tilt() -> Iterator[Check]:
    """A tilt of several radians, at which every term of the series counts."""
    tilts = np.array([[3.1, 4.2], [2.3, -4.6], [-5.0, 1.7]])
    expected = []
    for tilt in tilts:
        found = {"tilt_squared": float(tilt @ tilt)}
        for name, values in _series(float(tilt @ tilt)).items():
            found |= dict(
                zip((f"tilt_{name}{end}" for end in ("", "_slope", "_curvature")), values, strict=True)
            )
        expected.append(found | _turns(_rotation_of(tilt)))
    quantities = {"trim_gimbal_flap": tilts[:, 0], "trim_gimbal_roll": tilts[:, 1]}
    values = stacked(expected)
    sees = ("moving", "tilt_of_yoke")
    yield values_check(
        sees, "Rodrigues' rotation by power series", quantities, values, dict.fromkeys(values, 1e2)
    )


def _geometry() -> Iterator[Check]:
    told = "the blade's geometry, by complex steps"
    q, segments = _quantities(), _of_segments()

    def flat(found: NDArray) -> NDArray:
        return found.reshape(-1, found.shape[-1])

    expected = np.array([flat(_with_value(functools.partial(_position, m))) for m in _moving()])
    yield matrix_check(("moving", "points"), told, q, expected, 1.0)
    every = range(len(BEYOND_FLAP))
    expected = np.array(
        [[flat(_with_value(functools.partial(_axes, m, segment=s))) for s in every] for m in _moving()]
    )
    yield matrix_check(("moving", "axes"), told, segments, expected, 1.0)
    expected = np.array([_with_value(functools.partial(_pitch, m)) for m in _moving()])
    yield matrix_check(("moving", "pitch_of_blade"), told, q, expected, 1.0)
    expected = np.array([[[_rotation(m, s, _NONE)] for s in every] for m in _moving()])
    yield matrix_check(("moving", "rotation_of_section"), told, segments, expected, 1.0)
    expected = np.array([[_velocity(m, s) for s in every] for m in _moving()])[..., None]
    yield matrix_check(("moving", "trim_velocity"), told, segments, expected, 1.0)


def _velocity(moving: Moving, segment: int) -> NDArray:
    axes = _axes(moving, _NONE, segment)
    along = [np.array([-1, 1, 1]) * (axes @ moving.velocity[power]) for power in (0, 1)]
    return np.real([*along[0], *along[1], moving.spin])


def _rotation(moving: Moving, segment: int, at: NDArray) -> NDArray:
    """Virtual rotations (12,) about d, with i' as it is at trim; those of the hub are about fixed axes."""
    chordwise = np.real(_axes(moving, _NONE, segment)[0])
    changes = _changes(functools.partial(_axes, moving, segment=segment), at)
    found = np.einsum("xj,x->j", changes[1], chordwise)
    found[_TURN] = np.real(_axes(moving, at, segment)[2])
    return found + _changes(functools.partial(_pitch, moving), at)[1]


def _work(moving: Moving, at: NDArray) -> NDArray:
    """Virtual work (12,) of the steady forces; that of hub rotations is their moment about the hub."""
    found = np.einsum("axj,ax->j", _changes(functools.partial(_position, moving), at), moving.force)
    found[_TURN] = np.cross(np.real(_position(moving, at)), moving.force).sum(axis=0)
    return found


def _differenced(function: Callable[[NDArray], NDArray]) -> NDArray:
    """Derivatives (12, 12) of virtual work or rotations (12,) with each coordinate, along the last axis."""
    columns = [central_difference(lambda h, u=unit: function(h * u), 0.02) for unit in np.eye(len(_NONE))]
    return np.stack(columns, axis=-1)


def _second_order() -> Iterator[Check]:
    told = "the blade's geometry, by complex steps and differences"
    q, segments, every = _quantities(), _of_segments(), range(len(BEYOND_FLAP))
    expected = np.array([_differenced(functools.partial(_work, m)) for m in _moving()])
    yield _rounded(("moving", "force_stiffness"), told, q, expected)
    expected = np.array(
        [
            [m.section_moment[s] * _differenced(functools.partial(_rotation, m, s)) for s in every]
            for m in _moving()
        ]
    )
    yield _rounded(("moving", "moment_stiffness"), told, segments, expected)
    expected = np.array(
        [
            _differenced(lambda at, m=m: m.moments @ _changes(functools.partial(_pitch, m), at))
            for m in _moving()
        ]
    )
    yield _rounded(("moving", "pitch_stiffness"), told, q, expected)


def _rounded(sees: Names, told: str, quantities: Quantities, expected: NDArray) -> Check:
    """A check of a matrix whose expectation holds rounding of differences, 1e-11 of its largest entries."""
    return matrix_check(sees, told, quantities, expected, 1e2 * np.abs(expected).max())


def _energy(point: Point, angles: NDArray) -> Any:
    """Springs and propeller moment by flap, lag and pitch relative to the yoke."""
    rotor = point.rotor
    flap, lag, pitch = (Motion(angle) for angle in angles)
    hinges = hinge_spring_energy(rotor, flap, lag, pitch + rotor.structural_pitch_offset).value
    return hinges + 0.5 * rotor.pitch_inertia * rotor.rotor_speed**2 * np.sin(angles[2]) ** 2


def _springs() -> Iterator[Check]:
    told = "energy of springs in series and propeller moment"
    places = [_FLAP, _LAG, _PITCH]
    moments = np.zeros((len(points(GENERAL)), len(_NONE), 1))
    stiffness = np.zeros((len(points(GENERAL)), len(_NONE), len(_NONE)))
    for number, p in enumerate(points(GENERAL)):
        q = one_blade.quantities(p)
        at = np.array([q["coning"], q["lag"], q["pitch"]])

        def gradient(angles: NDArray, p: Point = p) -> NDArray:
            return _changes(lambda moved: _energy(p, moved), angles)

        moments[number, places, 0] = gradient(at)
        columns = [central_difference(lambda h, u=u, at=at: gradient(at + h * u), 0.02) for u in np.eye(3)]
        stiffness[number][np.ix_(places, places)] = np.stack(columns, axis=-1)
    given = blade_quantities(GENERAL) | {
        name: 0.0 for name in ("kinematic_pitch_flap_coupling", "kinematic_pitch_lag_coupling")
    }
    yield matrix_check(("moving", "spring_moment"), told, given, moments, np.abs(moments).max())
    yield _rounded(("moving", "spring_stiffness"), told, given, stiffness)
