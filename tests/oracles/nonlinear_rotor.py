"""A rotor of N blades, written down nonlinearly in its eighteen fixed-frame coordinates.

Nothing is expanded: positions come from rotations of the hub, the yoke and the blade, and everything else
from `motion`. Blade angles are those of a multiblade transform, q0 + q1c cos ψm + q1s sin ψm, so the
equations have constant coefficients once linearised (tested, not assumed).
"""

from dataclasses import dataclass, replace

import numpy as np

from tests.oracles.motion import Motion, cos, dot, scaled, sin, turned, vector

DOFS = (
    *("x", "y", "z", "alpha_x", "alpha_y", "alpha_z"),
    *("flap_0", "flap_1c", "flap_1s", "lag_0", "lag_1c", "lag_1s", "pitch_0", "pitch_1c", "pitch_1s"),
    *("azimuth", "gimbal_1c", "gimbal_1s"),
)
HUB_FORCE, HUB_MOMENT = slice(0, 3), slice(3, 6)
FLAP, LAG, PITCH = (DOFS.index(name) for name in ("flap_0", "lag_0", "pitch_0"))
AZIMUTH, GIMBAL_C, GIMBAL_S = (DOFS.index(name) for name in ("azimuth", "gimbal_1c", "gimbal_1s"))
UNIT = np.eye(len(DOFS))
GENERALISED = slice(6, None)  # the rows of virtual work; the six hub rows are resultants


@dataclass(frozen=True)
class NonlinearRotor:
    """Blades of point masses `mass` at the radii `station`, and everything the rotor equations ask for."""

    n_blades: int
    rotor_speed: float
    flap_hinge_offset: float
    lag_hinge_offset: float
    precone: float
    station: np.ndarray
    mass: np.ndarray
    collective: float  # trim pitch at three quarters of the radius without the elastic pitch
    flap_stiffness: float
    lag_stiffness: float
    flap_outboard_fraction: float
    lag_outboard_fraction: float
    gimbal_stiffness: float
    pitch_gimbal_coupling: float
    pitch_inertia: float
    control_stiffness: float
    structural_pitch_offset: float
    propeller_moment: bool
    flap_damping: float = 0.0
    lag_damping: float = 0.0
    pitch_damping: float = 0.0
    gimbal_damping: float = 0.0
    kinematic_pitch_flap_coupling: float = 0.0
    kinematic_pitch_lag_coupling: float = 0.0
    cyclic_control_stiffness: float | None = None  # of one blade; as that of the collective by default
    mass_offset: np.ndarray | float = 0.0  # of each point mass beyond the lag hinge, aft of the pitch axis
    mass_twist: np.ndarray | float = 0.0  # at each point mass, from three quarters of the radius
    propeller_inertia: float | None = None  # as the pitch inertia by default

    @property
    def offset(self):
        """Distance of each point mass from the pitch axis: those inboard of the lag hinge lie on it."""
        return np.where(self.station > self.lag_hinge_offset, self.mass_offset, 0.0)

    @property
    def lumped_inertia(self):
        """Pitch inertia that the point masses beside the axis do not have themselves."""
        return self.pitch_inertia - (self.mass * self.offset**2).sum()

    @property
    def lumped_propeller_inertia(self):
        whole = self.pitch_inertia if self.propeller_inertia is None else self.propeller_inertia
        return self.propeller_moment * (whole - (self.mass * self.offset**2).sum())


@dataclass(frozen=True)
class Blades:
    """What the blades do. Scalars are (..., blade, 1), vectors (..., blade, station, 3)."""

    position: Motion  # from the inertial origin
    arm: Motion  # from the hub
    chordwise: Motion  # i', towards the trailing edge
    spanwise: Motion  # d, outboard
    normal: Motion  # n, towards the thrust
    pitch: Motion  # Θy, relative to the yoke
    shaft_pitch: Motion  # Θs, relative to the shaft
    flap: Motion
    lag: Motion
    elastic_pitch: Motion


def clock(rotor, time, running=True):
    """Ωt as a motion; a stopped clock turns velocities into virtual displacements."""
    return Motion(rotor.rotor_speed * time, rotor.rotor_speed if running else 0.0)


def blade_azimuths(rotor, shaft):
    """ψm without the azimuth perturbation: (blade, 1)."""
    return shaft + 2 * np.pi / rotor.n_blades * np.arange(rotor.n_blades)[:, None]


def blade_angle(q, first, azimuth):
    """The multiblade coordinates first, first + 1, first + 2 seen on each blade."""
    mean, cosine, sine = (q[..., first + k, None, None] for k in range(3))
    return mean + cosine * cos(azimuth) + sine * sin(azimuth)


def blades(rotor, station, q, shaft):
    """Kinematics of the sections at `station` for coordinates q (..., 18) and shaft angle Ωt."""
    multiblade_azimuth = blade_azimuths(rotor, shaft)
    flap, lag, elastic_pitch = (blade_angle(q, first, multiblade_azimuth) for first in (FLAP, LAG, PITCH))
    azimuth = multiblade_azimuth + q[..., AZIMUTH, None, None]
    gimbal_c, gimbal_s = q[..., GIMBAL_C, None, None], q[..., GIMBAL_S, None, None]
    hub = q[..., None, None, HUB_FORCE]
    hub_rotation = q[..., None, None, HUB_MOMENT]
    tilt = vector(gimbal_s, -gimbal_c, 0.0)

    def inertial(along_i, along_j, along_k):
        """Components in the spinning axes i, j, k of the yoke to inertial axes."""
        s, c = sin(azimuth), cos(azimuth)
        in_yoke = vector(along_i * s + along_j * c, along_j * s - along_i * c, along_k)
        return turned(hub_rotation, turned(tilt, in_yoke))

    flap_arm = np.maximum(station - rotor.flap_hinge_offset, 0.0)
    lag_arm = np.maximum(station - rotor.lag_hinge_offset, 0.0)
    root, cone = rotor.precone, rotor.precone + flap
    flapped_length = flap_arm + lag_arm * (cos(lag) - 1.0)
    arm = inertial(
        lag_arm * sin(lag),
        (station - flap_arm) * np.cos(root) + flapped_length * cos(cone),
        (station - flap_arm) * np.sin(root) + flapped_length * sin(cone),
    )

    local_cone = root + flap * (flap_arm > 0)  # a section inboard of a hinge does not feel it
    local_lag = lag * (lag_arm > 0)
    gimbal_flap = gimbal_c * cos(azimuth) + gimbal_s * sin(azimuth)
    gimbal_roll = gimbal_s * cos(azimuth) - gimbal_c * sin(azimuth)
    by_linkages = (
        rotor.pitch_gimbal_coupling * gimbal_flap
        + rotor.kinematic_pitch_flap_coupling * flap
        + rotor.kinematic_pitch_lag_coupling * lag
    )
    shaft_pitch = rotor.collective + elastic_pitch - by_linkages
    return Blades(
        position=hub + arm,
        arm=arm,
        chordwise=inertial(
            cos(local_lag), -sin(local_lag) * cos(local_cone), -sin(local_lag) * sin(local_cone)
        ),
        spanwise=inertial(sin(local_lag), cos(local_lag) * cos(local_cone), cos(local_lag) * sin(local_cone)),
        normal=inertial(0.0, -sin(local_cone), cos(local_cone)),
        pitch=shaft_pitch - gimbal_roll,
        shaft_pitch=shaft_pitch,
        flap=flap,
        lag=lag,
        elastic_pitch=elastic_pitch,
    )


def beside_axis(motion, aft, twist):
    """From the pitch axis to points `aft` of it, on chords turned nose up by pitch and `twist`."""
    section_pitch = motion.pitch + twist
    return scaled(aft * cos(section_pitch), motion.chordwise) - scaled(
        aft * sin(section_pitch), motion.normal
    )


def masses(rotor, q, shaft):
    """Kinematics of the point masses."""
    motion = blades(rotor, rotor.station, q, shaft)
    beside = beside_axis(motion, rotor.offset, rotor.mass_twist)
    return replace(motion, position=motion.position + beside, arm=motion.arm + beside)


def virtual_displacements(rotor, station, q, time):
    """Blades whose rates are the derivatives by each generalised coordinate, on an axis before the blades."""
    return blades(rotor, station, virtual_motion(q), clock(rotor, time, running=False))


def virtual_motion(q):
    """Every generalised coordinate at a rate of one in its turn: (..., row, 18)."""
    return Motion(q[..., None, :], UNIT[GENERALISED])


def spring_energy(rotor, motion, coordinates):
    """Energy of the hinge springs, the control springs, the propeller moment and the gimbal spring."""
    gimbal = coordinates[..., GIMBAL_C : GIMBAL_S + 1]
    hinges = hinge_spring_energy(rotor, motion.flap, motion.lag, motion.pitch + rotor.structural_pitch_offset)
    control = 0.5 * rotor.control_stiffness * motion.elastic_pitch * motion.elastic_pitch
    propeller_stiffness = rotor.lumped_propeller_inertia * rotor.rotor_speed**2
    propeller = 0.5 * propeller_stiffness * sin(motion.pitch) * sin(motion.pitch)
    blades_and_gimbal = over_blades(hinges + control + propeller) + 0.5 * rotor.gimbal_stiffness * dot(
        gimbal, gimbal
    )
    return blades_and_gimbal + swashplate_energy(rotor, coordinates)


def swashplate_energy(rotor, coordinates):
    """What a swashplate on tilt springs of its own stores beside links that are all alike.

    A tilt a of the swashplate moves N links by a cos ψ, whose squares add up to N/2: links of stiffness k feel
    as a tilt spring of N k/2.
    """
    if rotor.cyclic_control_stiffness is None:
        return Motion(0.0)
    tilt = coordinates[..., PITCH + 1 : PITCH + 3]
    missing = rotor.cyclic_control_stiffness - rotor.control_stiffness
    return 0.5 * (rotor.n_blades / 2 * missing) * dot(tilt, tilt)


def hinge_spring_energy(rotor, flap, lag, turn):
    """Springs inboard of the pitch bearing and, turned with the blade, outboard of it, in series.

    Flexibilities add. The outboard springs bend along the blade's own axes: nose up by `turn`, the blade
    has its normal along n cos + i sin and its chord along i cos − n sin.
    """
    inboard_flap = (1 - rotor.flap_outboard_fraction) / rotor.flap_stiffness
    inboard_lag = (1 - rotor.lag_outboard_fraction) / rotor.lag_stiffness
    outboard_flap = rotor.flap_outboard_fraction / rotor.flap_stiffness
    outboard_lag = rotor.lag_outboard_fraction / rotor.lag_stiffness
    c, s = cos(turn), sin(turn)
    flap_flap = inboard_flap + outboard_flap * c * c + outboard_lag * s * s
    lag_lag = inboard_lag + outboard_flap * s * s + outboard_lag * c * c
    flap_lag = (outboard_flap - outboard_lag) * s * c
    determinant = flap_flap * lag_lag - flap_lag * flap_lag
    return 0.5 * (flap * flap * lag_lag - 2.0 * flap * lag * flap_lag + lag * lag * flap_flap) / determinant


def over_blades(scalar):
    """Sum of a per-blade scalar over the rotor."""
    return Motion(*(part.sum((-2, -1)) for part in (scalar.value, scalar.rate, scalar.acceleration)))


def lagrangian(rotor, q, q_rate, time):
    """L = T − U of the whole rotor at coordinates q and rates q_rate (..., 18)."""
    coordinates = Motion(q, q_rate)
    motion = masses(rotor, coordinates, clock(rotor, time))
    velocity, pitch_rate = motion.position.rate, motion.shaft_pitch.rate
    kinetic = 0.5 * ((velocity**2).sum(-1) * rotor.mass).sum((-2, -1))
    pitching = 0.5 * rotor.lumped_inertia * (pitch_rate**2).sum((-2, -1))
    return kinetic + pitching - spring_energy(rotor, motion, coordinates).value


_STENCIL = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}


def central_difference(function, step):
    """Derivative of a function of one real number at zero, of eighth order.

    Steps of one hundredth of a radian leave a truncation below 1e-12 for the harmonics of a rotor and as
    little rounding. The steps are real, so a complex step may pass through.
    """
    return sum(weight * (function(k * step) - function(-k * step)) for k, weight in _STENCIL.items()) / step


def lagrange_rows(rotor, q, time):
    """d/dt ∂L/∂q̇ − ∂L/∂q along the motion q, with the dampers: (..., 18).

    With no steady moment on the hub (the inertia forces of a steady rotor have none) the generalised forces
    of the hub rotations and the moments about the hub agree to first order.
    """
    step, rate_step = 0.01, rotor.rotor_speed

    def momentum(elapsed):
        coordinates = q.value + q.rate * elapsed + q.acceleration * elapsed**2 / 2
        rates = q.rate + q.acceleration * elapsed

        def with_rates(change):
            changed = rates[..., None, :] + change * UNIT
            return lagrangian(rotor, coordinates[..., None, :], changed, time + elapsed)

        # L is quadratic in the rates, so this difference is exact whatever the step.
        return (with_rates(rate_step) - with_rates(-rate_step)) / (2 * rate_step)

    def displaced(change):
        return lagrangian(rotor, q.value[..., None, :] + change * UNIT, q.rate[..., None, :], time)

    momentum_rate = central_difference(momentum, step / rotor.rotor_speed)
    return momentum_rate - central_difference(displaced, step) + damper_rows(rotor, q, time)


def damper_rows(rotor, q, time):
    """Viscous dampers on the hinges and the pitch of each blade, and on the gimbal in fixed axes."""
    azimuth = blade_azimuths(rotor, clock(rotor, time))
    harmonics = np.stack([np.ones_like(azimuth.value), np.cos(azimuth.value), np.sin(azimuth.value)])[..., 0]
    rows = np.zeros(q.rate.shape, dtype=complex)
    dampers = ((FLAP, rotor.flap_damping), (LAG, rotor.lag_damping), (PITCH, rotor.pitch_damping))
    for first, damping in dampers:
        rate = blade_angle(q, first, azimuth).rate[..., 0]
        rows[..., first : first + 3] = damping * rate @ harmonics.T
    rows[..., GIMBAL_C : GIMBAL_S + 1] = rotor.gimbal_damping * q.rate[..., GIMBAL_C : GIMBAL_S + 1]
    return rows


def inertia_rows(rotor, q, time):
    """The same rows from accelerations (d'Alembert): force and moment on the hub, virtual work on the rest.

    The lumped pitch inertia takes part where the shaft-relative pitch does, and never on the hub.
    """
    motion = masses(rotor, q, clock(rotor, time))
    inertia_force = rotor.mass[:, None] * motion.position.acceleration
    pitching_moment = rotor.lumped_inertia * motion.shaft_pitch.acceleration
    rows = np.zeros((*inertia_force.shape[:-3], len(DOFS)), dtype=complex)
    rows[..., HUB_FORCE] = inertia_force.sum((-3, -2))
    rows[..., HUB_MOMENT] = np.cross(motion.arm.value, inertia_force).sum((-3, -2))
    virtual = masses(rotor, virtual_motion(q.value), clock(rotor, time, running=False))
    work = (inertia_force[..., None, :, :, :] * virtual.position.rate).sum((-3, -2, -1))
    pitching_work = (pitching_moment[..., None, :, :] * virtual.shaft_pitch.rate).sum((-2, -1))
    rows[..., GENERALISED] = work + pitching_work
    return rows


def spring_rows(rotor, q, time):
    """Gradient of the spring energy."""
    rows = np.zeros(q.value.shape, dtype=complex)
    virtual = virtual_displacements(rotor, np.zeros(1), q.value, time)
    rows[..., GENERALISED] = spring_energy(rotor, virtual, virtual_motion(q.value)).rate
    return rows


def rows_in_vacuum(rotor, q, time):
    """Left-hand side of the equations of motion without airloads."""
    return inertia_rows(rotor, q, time) + spring_rows(rotor, q, time) + damper_rows(rotor, q, time)


def linearised(rows, trim, time):
    """M, C, K of rows(q: Motion, time) about the steady coordinates `trim`, by a complex step."""
    step = 1e-30
    moved = 1j * step * UNIT
    changes = (Motion(trim, 0.0, moved), Motion(trim, moved), Motion(trim + moved))
    return tuple(np.imag(rows(change, time)).T / step for change in changes)


def trim_coordinates(coning, lag, elastic_pitch):
    """The steady state: hub still, yoke level, every blade alike."""
    q = np.zeros(len(DOFS))
    q[[FLAP, LAG, PITCH]] = coning, lag, elastic_pitch
    return q
