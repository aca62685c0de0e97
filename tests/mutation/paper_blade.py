"""One blade as published: the nonlinear rotor's kinematics without what AIAA-2002-1604 leaves out, as numbers.

Inertia: first order in the cone, no trim lag, no roll of the yoke, and accelerations of single coordinates without the
components that Eq. 11 does not have. Airloads: sections of a flat blade whose loads change with the air and keep their
arms and directions.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from proprotor_equations import BLADE_COORDINATES

from tests.mutation.one_blade import STEP, Matrices, Point, air_at, stations
from tests.mutation.sections import LOADS, POLYNOMIAL, section_loads
from tests.mutation.transform import ONE_BLADE, in_rotating_axes, seen_from_blade
from tests.oracles.motion import Motion
from tests.oracles.nonlinear_rotor import DOFS, FLAP, LAG, blades, central_difference, clock

_AXES = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])  # i, j, k at no azimuth
_PLACES = np.array([DOFS.index(name) for name in ONE_BLADE])
_ROLL = BLADE_COORDINATES.index("gimbal_roll")
# Components (i, j, k) of an acceleration that Eq. 11 does not have, by coordinate.
_ABSENT = {"turn_i": (0, 1), "turn_j": (0, 1), "gimbal_flap": (0, 1), "flap": (1,)}
_CONE_STEP = 0.02  # of the blade's, in the eighth-order differences that take the first order


def _spun(vectors: NDArray) -> NDArray:
    """k × v in components along i, j, k."""
    return np.cross([0.0, 0.0, 1.0], vectors)


def _kinematics(rotor, trim: NDArray) -> tuple[NDArray, NDArray, NDArray, NDArray]:
    """Arm (s, 3), its derivatives (12, s, 3), virtual displacements (12, s, 3) and their derivatives (12, 12, s, 3).

    In rotating axes. Hub rows are a force along, and a moment about, the axes at the displaced hub.
    """
    # Rows i move at a rate, columns j by a complex step: the rate's imaginary part is the second derivative.
    unit = np.linalg.inv(seen_from_blade(ONE_BLADE, 0.0)[0]).T @ np.eye(len(DOFS))[_PLACES]
    q = Motion(trim + 1j * STEP * unit[None, :, :], unit[:, None, :] * np.ones((1, len(ONE_BLADE), 1)))
    motion = blades(rotor, rotor.station, q, clock(rotor, 0.0, running=False))
    into = _AXES.T
    rate = motion.position.rate[:, :, 0] @ into  # (row, column, station, 3)
    arm = motion.arm.value[:, :, 0] @ into
    first, second = np.real(rate[:, 0]), np.imag(rate) / STEP
    change = np.imag(arm[0]) / STEP  # of the arm with each column
    virtual, virtual_change = first.copy(), second.copy()
    for axis in range(3):
        about = np.eye(3)[axis]
        virtual[3 + axis] = np.cross(about, np.real(arm[0, 0]))
        virtual_change[3 + axis] = np.cross(about, change)
        virtual_change[axis] = 0.0
    return np.real(arm[0, 0]), first, virtual, virtual_change


def _kept(accelerations: NDArray) -> NDArray:
    """Accelerations (12, s, 3) without the components that are absent."""
    kept = accelerations.copy()
    for name, components in _ABSENT.items():
        kept[BLADE_COORDINATES.index(name), :, components] = 0.0
    return kept


def _inertia(point: Point, cone: float, published: bool) -> NDArray:
    """M, C, K (3, 12, 12) with `cone` times the blade's precone and coning; not published, with everything."""
    trim, rotor = point.trim.copy(), point.rotor
    if published:
        trim[LAG] = 0.0
        trim[FLAP] *= cone
        rotor = replace(rotor, precone=cone * rotor.precone)
    arm, derivative, virtual, change = _kinematics(rotor, trim)
    omega, mass = rotor.rotor_speed, rotor.mass
    rows = mass[:, None] * virtual
    accelerations = [derivative, 2 * omega * _spun(derivative), omega**2 * _spun(_spun(derivative))]
    if published:
        accelerations = [_kept(a) for a in accelerations]
    M, C, K = (np.einsum("isx,jsx->ij", rows, a) for a in accelerations)
    K = K + omega**2 * np.einsum("s,ijsx,sx->ij", mass, change, _spun(_spun(arm)))
    return np.array([M, C, K])


def consistent_mass_matrices(point: Point) -> Matrices:
    """With nothing left out: what accelerations give in `one_blade`, by another road."""
    return tuple(_inertia(point, 1.0, published=False))


def mass_matrices(point: Point) -> Matrices:
    """Of the point masses, as published."""

    def with_cone(cone: float) -> NDArray:
        return _inertia(point, cone, published=True)

    matrices = with_cone(0.0) + central_difference(with_cone, _CONE_STEP)
    matrices[:, _ROLL, :] = matrices[:, :, _ROLL] = 0.0
    return tuple(matrices)


# The air


def flat(point: Point) -> Point:
    """The same blade in the disk, at the same pitch."""
    trim = point.trim.copy()
    trim[[FLAP, LAG]] = 0.0
    return replace(point, rotor=replace(point.rotor, precone=0.0), trim=trim)


def _airload_rows(point: Point, q: Motion, drift=0.0) -> NDArray:
    """What the airloads add to the left-hand side: they change, but keep place and direction of trim."""
    r, weight, _ = stations(point)
    stopped = clock(point.rotor, 0.0, running=False)
    motion = blades(point.rotor, r, q, clock(point.rotor, 0.0))
    steady = blades(point.rotor, r, Motion(point.trim[None, :], np.eye(len(DOFS))), stopped)
    axes = {"fx": steady.chordwise, "fn": steady.normal, "fd": steady.spanwise}
    loads = section_loads(POLYNOMIAL, air_at(point, r, motion, drift))
    turn = (steady.normal.rate * steady.chordwise.value).sum(-1) + steady.pitch.rate
    reach = {name: (steady.position.rate * axis.value).sum(-1) for name, axis in axes.items()} | {"m": turn}
    work = sum(reach[name] * loads[name][..., None, :, :] for name in LOADS)
    return -(work * weight).sum((-2, -1))


def _without_roll(matrices: Matrices) -> Matrices:
    for matrix in matrices:
        matrix[_ROLL] = 0.0
        if matrix.shape[1] > _ROLL:
            matrix[:, _ROLL] = 0.0
    return matrices


def air_matrices(point: Point) -> Matrices:
    """Of the airloads, as published; `point` is flat."""
    moved = 1j * STEP * np.eye(len(DOFS))
    columns = (Motion(point.trim, 0.0, moved), Motion(point.trim, moved), Motion(point.trim + moved))
    fixed = (_airload_rows(point, q).imag.T / STEP for q in columns)
    one = tuple(matrix[np.ix_(_PLACES, _PLACES)] for matrix in fixed)
    return _without_roll(in_rotating_axes(one, point.rotor.rotor_speed))


def gust_columns(point: Point) -> NDArray:
    """Loads (12, 3) on the right-hand side per unit velocity of the air along i, j, k; `point` is flat."""
    columns = [
        -_airload_rows(point, Motion(point.trim), 1j * STEP * axis)[_PLACES].imag / STEP for axis in _AXES
    ]
    back = np.linalg.inv(seen_from_blade(ONE_BLADE, 0.0)[0])
    (loads,) = _without_roll((back.T @ np.array(columns).T,))
    return loads
