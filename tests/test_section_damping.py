"""Quasi-steady pitch damping of the sections, by the rotation of a straight blade about its own axis written out."""

import dataclasses

import numpy as np
from proprotor_equations import FIXED_COORDINATES

import proprotor as pp

SPEED = 90.0


def flat_rotor() -> tuple[pp.Rotor, pp.Operation]:
    """The XV-15's rotor without precone: its blades lie in the disk when flap and lag are locked."""
    case = pp.load_case("xv15")
    rotor = dataclasses.replace(case.rotor, precone=0.0, chord=lambda r: 0.3 + 0.01 * r)
    return rotor, dataclasses.replace(case.operation, trim={"collective": 0.7})


def damping_constant(rotor: pp.Rotor, operation: pp.Operation) -> float:
    """Integral of pi/8 rho c³ U along one blade."""
    nodes, weights = np.polynomial.legendre.leggauss(40)
    half = (rotor.radius - rotor.root_cutout) / 2
    r = rotor.root_cutout + half * (1 + nodes)
    speed = np.hypot(operation.rotor_speed * r, SPEED)
    return np.pi / 8 * operation.density * (half * weights) @ ((0.3 + 0.01 * r) ** 3 * speed)


def rotation_about_span(psi: float, rotor: pp.Rotor) -> np.ndarray:
    """Turn of a section about the radius at azimuth psi per unit of each coordinate: hub, pitch, and gimbal by K_PG.

    The roll of the yoke and what the swashplate gives back of it cancel.
    """
    turn = dict.fromkeys(FIXED_COORDINATES, 0.0)
    turn |= {"alpha_x": np.cos(psi), "alpha_y": np.sin(psi)}
    turn |= {"pitch_0": 1.0, "pitch_1c": np.cos(psi), "pitch_1s": np.sin(psi)}
    turn |= {"gimbal_1c": -rotor.pitch_gimbal_coupling * np.cos(psi)}
    turn |= {"gimbal_1s": -rotor.pitch_gimbal_coupling * np.sin(psi)}
    return np.array([turn[name] for name in FIXED_COORDINATES])


def tilt_of_span(psi: float) -> np.ndarray:
    """Rise of the span out of the disk, which turns the section with the rotor speed: hub and gimbal."""
    rise = dict.fromkeys(FIXED_COORDINATES, 0.0)
    rise |= {
        "alpha_x": np.sin(psi),
        "alpha_y": -np.cos(psi),
        "gimbal_1c": np.cos(psi),
        "gimbal_1s": np.sin(psi),
    }
    return np.array([rise[name] for name in FIXED_COORDINATES])


def expected(rotor: pp.Rotor, operation: pp.Operation) -> tuple[np.ndarray, np.ndarray]:
    constant, omega, step = damping_constant(rotor, operation), operation.rotor_speed, 1e-6
    damping, stiffness = np.zeros((18, 18)), np.zeros((18, 18))
    for psi in 0.3 + 2 * np.pi * np.arange(rotor.n_blades) / rotor.n_blades:
        turn = rotation_about_span(psi, rotor)
        # The rate of a rotating component is that of the coordinate and Omega times its change with azimuth. A tilt of
        # the hub has such a change and yet is no rotation, which the rise of the span takes off again.
        change = (rotation_about_span(psi + step, rotor) - rotation_about_span(psi - step, rotor)) / (
            2 * step
        )
        damping += constant * np.outer(turn, turn)
        stiffness += constant * omega * np.outer(turn, change + tilt_of_span(psi))
    return damping, stiffness


def test_pitch_damping_of_the_sections():
    rotor, operation = flat_rotor()
    options = {"locked": ("flap", "lag")}
    without = pp.rotor_model(rotor, operation, SPEED, **options)
    damped = pp.rotor_model(rotor, operation, SPEED, section_damping=True, **options)
    assert (
        damped.trim.elastic_pitch == without.trim.elastic_pitch
    )  # a flat blade does not turn about its span at trim
    places = [FIXED_COORDINATES.index(name) for name in without.dofs]
    for name, matrix in zip("CK", expected(rotor, operation), strict=True):
        change = getattr(damped, name) - getattr(without, name)
        reference = matrix[np.ix_(places, places)]
        size = np.abs(reference).max()
        assert np.abs(change - reference).max() < 1e-8 * size, name
        assert size > 0


def test_a_tilt_that_stays_is_no_rotation():
    """Hub and gimbal tilted and held: no section turns about its span, so nothing is damped."""
    rotor, operation = flat_rotor()
    _, stiffness = expected(rotor, operation)
    held = [FIXED_COORDINATES.index(name) for name in ("alpha_x", "alpha_y")]
    assert np.abs(stiffness[:, held]).max() < 1e-6 * np.abs(stiffness).max()
