"""A rotor at an angle to its flight and in a pull-up, against a nonlinear rotor that shares no code with it.

The oracle knows positions alone. Its residual at the periodic trim and its matrices by a complex step have no
approximation; both are compared to rounding, 1e-12 of the largest entry. What eight harmonics leave of the trim is held
to 1e-7 of the loads.
"""

import numpy as np
import pytest

import proprotor as pp
from proprotor.model.floquet import transition
from proprotor.model.rotor_model import model_of, rotor_model
from tests.oracles.motion import Motion
from tests.oracles.nonlinear_rotor import DOFS, GENERALISED, inertia_rows, linearised, rows_in_vacuum
from tests.oracles.random_rotors import NO_OFFSETS, SPEED_OF_SOUND, random_rotor
from tests.oracles.tilted_flight import GRAVITY, TiltedFlight, coordinates_of
from tests.oracles.virtual_work import airload_rows

DENSITY = 1.1
AZIMUTH = DOFS.index("azimuth")
FLIGHTS = [(3, 110.0, 0.1, 2.5), (5, 80.0, -0.15, -1.0), (4, 120.0, 0.0, 2.0), (6, 95.0, 0.2, 1.0)]


def operation(pair):
    return pp.Operation(rotor_speed=pair.rotor_speed, density=DENSITY, speed_of_sound=SPEED_OF_SOUND)


class Case:
    """A random rotor in tilted flight, by the package and by the oracle."""

    def __init__(self, seed, airspeed, shaft_angle, load_factor, **options):
        pair = random_rotor(seed, n_blades=3, **NO_OFFSETS)
        given = {"shaft_angle": shaft_angle, "load_factor": load_factor} | options
        self.model = model_of(pair.package, operation(pair), airspeed, given, around=True)
        self.swing = self.model.swing
        steady = {"collective": self.swing.collective, "coning": 0.0, "lag": 0.0, "elastic_pitch": 0.0}
        self.rotor, _ = pair.oracle(type("Trim", (), steady))
        self.flight = TiltedFlight.of(airspeed, shaft_angle, load_factor)
        self.air = pair.air(airspeed * np.cos(shaft_angle), DENSITY)
        self.steps = self.model.M.shape[0]

    def time(self, step):
        return 2 * np.pi / 3 * step / self.steps / self.rotor.rotor_speed

    def trim(self, time):
        return coordinates_of(self.rotor, self.swing.angles, self.swing.tilt, time)

    def rows(self, q, time, order=14):
        return self.flight.rows(self.air, self.rotor, q, time, order)


@pytest.mark.parametrize("flight", FLIGHTS)
def test_the_trim_is_in_balance(flight):
    case = Case(*flight)
    torque, scale = [], []
    blades = [DOFS.index(name) for name in DOFS[GENERALISED] if name != "azimuth"]
    for step in range(case.steps):
        rows = case.rows(case.trim(case.time(step)), case.time(step)).real
        still = Motion(0 * case.trim(0.0).value)
        scale.append(np.abs(case.rows(still, 0.0)[GENERALISED]).max())
        assert np.abs(rows[blades]).max() < 1e-7 * scale[-1]
        torque.append(rows[AZIMUTH])
    assert abs(np.mean(torque)) < 1e-9 * max(scale)


@pytest.mark.parametrize("flight", FLIGHTS)
def test_matrices_at_each_azimuth(flight):
    case = Case(*flight)
    others = np.delete(
        np.arange(18), AZIMUTH
    )  # the package's azimuth carries the swing of the blades with it
    for step in range(0, case.steps, 3):
        time = case.time(step)
        found = case.flight.linearised(case.air, case.rotor, case.trim(time), time)
        for name, expected in zip("MCK", found, strict=True):
            actual = getattr(case.model, name)[step]
            error = np.abs(actual - expected)[np.ix_(others, others)].max()
            assert error < 1e-12 * np.abs(expected).max(), (name, step)


@pytest.mark.parametrize("flight", FLIGHTS[:2])
def test_azimuth_carries_the_swing_of_the_blades(flight):
    """The column of the azimuth is that of the oracle and those of the blades, by the rate of their swing."""
    case = Case(*flight)
    small = 1e-6
    for step in (0, 5):
        time, ahead = case.time(step), case.time(step) + small / case.rotor.rotor_speed
        before = time - small / case.rotor.rotor_speed
        swing = (case.trim(ahead).value - case.trim(before).value) / (2 * small)
        # The oracle's multiblade angles turn with the azimuth that is not disturbed: the blade's own swing is theirs
        # along the blade's azimuth.
        psi = case.rotor.rotor_speed * time
        swing = _along_blades(case, swing, psi)
        M, _, _ = case.flight.linearised(case.air, case.rotor, case.trim(time), time)
        column = M[:, AZIMUTH] + M @ swing
        others = np.delete(np.arange(18), AZIMUTH)
        error = np.abs(case.model.M[step][others, AZIMUTH] - column[others]).max()
        assert error < 1e-7 * np.abs(column).max()


def _along_blades(case, fixed_swing, psi):
    """Swing per azimuth of multiblade coordinates, with the turn of their waves: each blade's own swing."""
    value = case.trim(psi / case.rotor.rotor_speed).value
    swing = fixed_swing.copy()
    for first in (6, 9, 12):
        cosine, sine = value[first + 1], value[first + 2]
        swing[first + 1] += sine
        swing[first + 2] -= cosine
    return swing


def test_axial_flight_is_the_limit():
    """At a hundred thousandth of a degree the average is the model in axial flight, to the square of the angle."""
    pair = random_rotor(7, tables=True, **NO_OFFSETS)
    axial = rotor_model(pair.package, operation(pair), [90.0, 120.0])
    tilted = rotor_model(pair.package, operation(pair), [90.0, 120.0], shaft_angle=1e-13)
    for name in "MCKB":
        expected = getattr(axial, name)
        assert np.abs(getattr(tilted, name) - expected).max() < 1e-12 * np.abs(expected).max(), name


@pytest.mark.parametrize("n_blades", [3, 4, 5])
def test_first_order_in_the_shaft_angle(n_blades):
    """A rotor whose shaft is tilted stands where the linear model in axial flight puts it."""
    pair = random_rotor(n_blades, n_blades=n_blades, **NO_OFFSETS)
    axial = rotor_model(pair.package, operation(pair), 100.0)
    own = [place for place, name in enumerate(DOFS) if place > 5 and name != "azimuth"]
    tilt = DOFS.index("alpha_y")
    small = 1e-6
    expected = -np.linalg.solve(axial.K[np.ix_(own, own)], axial.K[own, tilt])
    swing = rotor_model(pair.package, operation(pair), 100.0, shaft_angle=small).swing
    assert np.allclose(swing.tilt.mean(axis=0) / small, expected[-2:], rtol=1e-5)
    for place, name in enumerate(("flap", "lag", "pitch")):
        waves = np.fft.fft(swing.angles[:, place]) / len(swing.angles)
        first = expected[own.index(DOFS.index(f"{name}_1c"))], expected[own.index(DOFS.index(f"{name}_1s"))]
        assert np.allclose(2 * np.array([waves[1].real, -waves[1].imag]) / small, first, rtol=1e-5)


def test_first_order_in_the_load_factor():
    """A hub that turns at q, and is accelerated by V q."""
    pair = random_rotor(11, n_blades=3, **NO_OFFSETS)
    airspeed, small = 100.0, 1e-4
    axial = rotor_model(pair.package, operation(pair), airspeed)
    own = [place for place, name in enumerate(DOFS) if place > 5 and name != "azimuth"]
    turn, up = DOFS.index("alpha_y"), DOFS.index("x")
    rate = GRAVITY * small / airspeed
    loads = axial.C[own, turn] * rate + axial.M[own, up] * airspeed * rate
    expected = -np.linalg.solve(axial.K[np.ix_(own, own)], loads)
    swing = rotor_model(pair.package, operation(pair), airspeed, load_factor=1 + small).swing
    assert np.allclose(swing.tilt.mean(axis=0), expected[-2:], rtol=1e-5)


def test_cyclic_pitch_keeps_the_gimbal_level():
    case = Case(3, 110.0, 0.1, 1.5, cyclic="level")
    assert np.abs(case.swing.tilt.mean(axis=0)).max() < 1e-12
    assert np.abs(case.swing.cyclic).max() > 0.01
    free = Case(3, 110.0, 0.1, 1.5)
    assert np.abs(free.swing.tilt.mean(axis=0)).max() > 0.01
    # A swashplate that turns the blades is elastic pitch that loads no control system.
    angles = case.swing.angles.copy()
    psi = 2 * np.pi * np.arange(len(angles)) / len(angles)
    of_swashplate = case.swing.cyclic[0] * np.cos(psi) + case.swing.cyclic[1] * np.sin(psi)
    angles[:, 2] += of_swashplate
    q = coordinates_of(case.rotor, angles, case.swing.tilt, 0.0)
    rows = case.rows(q, 0.0).real
    hinged = [place for place, name in enumerate(DOFS) if name.startswith(("flap", "lag", "gimbal"))]
    assert np.abs(rows[hinged]).max() < 1e-7 * np.abs(rows).max()


def test_without_a_gimbal_cyclic_pitch_stops_flapping_once_a_turn():
    case = Case(3, 110.0, 0.1, 1.0, cyclic="level", locked=("gimbal",))
    first = np.fft.fft(case.swing.angles[:, 0])[1] / len(case.swing.angles)
    assert abs(first) < 1e-12
    assert np.abs(case.swing.cyclic).max() > 0.001


def march(case, free, start, steps):
    """States (n, states) after a third of a turn of the nonlinear blades on a hub that is held, by Runge-Kutta."""
    period = 2 * np.pi / 3 / case.rotor.rotor_speed
    h, n = period / steps, len(start)

    def rate(time, state):
        value, speed = (np.zeros((n, 18), dtype=complex) for _ in range(2))
        value[:, free], speed[:, free] = state[:, : len(free)], state[:, len(free) :]
        still = case.rows(Motion(value, speed, 0 * value), time, order=6)[:, free]
        each = np.concatenate([np.eye(18)[free], np.zeros((1, 18))])[:, None, :]
        loads = inertia_rows(case.rotor, Motion(value, 0 * value, each + 0 * value), time)
        mass = loads[:-1] - loads[-1]
        acceleration = np.linalg.solve(np.moveaxis(mass[..., free], 0, -1), -still[..., None])[..., 0]
        return np.concatenate([state[:, len(free) :], acceleration], axis=1)

    state = start
    for step in range(steps):
        time = step * h
        k1 = rate(time, state)
        k2 = rate(time + h / 2, state + h / 2 * k1)
        k3 = rate(time + h / 2, state + h / 2 * k2)
        k4 = rate(time + h, state + h * k3)
        state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return state


def test_a_march_repeats_itself_and_carries_a_disturbance_as_the_transition_does():
    """Blades that lag on a gimbal: two steps of Runge-Kutta, extrapolated, leave 1e-5."""
    case = Case(3, 110.0, 0.1, 2.5, locked=("pitch", "flap"))
    free = [place for place, name in enumerate(DOFS) if name.startswith(("lag", "gimbal"))]
    scale = np.concatenate([np.full(len(free), case.rotor.rotor_speed), np.ones(len(free))])
    trim = case.trim(0.0)
    start = np.zeros((2, len(scale)), dtype=complex) + np.concatenate([trim.value[free], trim.rate[free]])
    disturbance = np.random.default_rng(1).standard_normal(len(scale)) / scale
    start[1] += 1j * 1e-30 * disturbance
    coarse, fine = (march(case, free, start, steps) for steps in (14, 28))
    end = fine + (fine - coarse) / 15
    assert np.abs(scale * (end[0] - start[0]).real).max() < 1e-5 * np.abs(scale * start[0]).max()
    held = case.model.submodel(tuple(DOFS[place] for place in free))
    rates = np.linalg.solve(held.M, -np.concatenate([held.K, held.C], axis=-1))
    unit = np.broadcast_to(np.eye(len(free)), rates[..., : len(free)].shape)
    around = np.concatenate([np.concatenate([0 * unit, unit], axis=-1), rates], axis=-2)
    carried = scale * (transition(around, 2 * np.pi / 3 / case.rotor.rotor_speed) @ disturbance)
    assert np.abs(carried - scale * end[1].imag / 1e-30).max() < 1e-5 * np.abs(carried).max()


def test_axial_oracle_is_the_flight_without_angle():
    pair = random_rotor(5, n_blades=3, **NO_OFFSETS)
    rotor, trim = pair.oracle(
        type("T", (), {"collective": 0.7, "coning": -0.02, "lag": 0.03, "elastic_pitch": -0.04})
    )
    air, flight = pair.air(110.0, DENSITY), TiltedFlight.of(110.0, 0.0, 1.0)
    axial = linearised(lambda q, t: rows_in_vacuum(rotor, q, t) + airload_rows(air, rotor, q, t), trim, 0.0)
    still = Motion(trim, np.zeros(18), np.zeros(18))
    for found, expected in zip(flight.linearised(air, rotor, still, 0.0), axial, strict=True):
        assert np.abs(found - expected).max() < 1e-14 * np.abs(expected).max()


def test_a_wind_from_the_side_is_the_tilt_of_a_shaft():
    """The frame that turns, against a rotation of the hub itself: the wind in its axes and the loads are the same."""
    pair = random_rotor(5, n_blades=3, **NO_OFFSETS)
    rotor, trim = pair.oracle(
        type("T", (), {"collective": 0.7, "coning": -0.02, "lag": 0.03, "elastic_pitch": -0.04})
    )
    angle = 0.1
    flight = TiltedFlight.of(110.0, angle, 1.0)
    tilted = trim.copy()
    tilted[DOFS.index("alpha_y")] = angle
    still = Motion(trim, np.zeros(18), np.zeros(18))
    in_frame = flight.rows(pair.air(110.0 * np.cos(angle), DENSITY), rotor, still, 0.0)[GENERALISED]
    turned = airload_rows(pair.air(110.0, DENSITY), rotor, Motion(tilted), 0.0)[GENERALISED]
    turned = turned + rows_in_vacuum(rotor, Motion(tilted), 0.0)[GENERALISED]
    assert np.abs(in_frame - turned).max() < 1e-12 * np.abs(turned).max()
