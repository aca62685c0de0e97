"""The nearest hinged blade: blades that are hinged, in all but the length of their flexures, and known couplings."""

import numpy as np
import pytest

from proprotor.errors import InputError
from proprotor.rotor.blade_stations import BladeStations
from proprotor.rotor.hinged_blade import hinged_blade, spring_matrix

PITCH = np.radians([5.0, 20.0, 35.0, 50.0])
SPEED = 2.0
RIGID = 1e3
FLAP, LAG = 3.0, 20.0  # EI of the flexures
LENGTH, RAMP = 0.03, 0.003


def with_flexures(flap_at, lag_at, bearing, twist=0.0, **changed):
    """A rigid blade with a short flexure in each direction."""
    r = [0.0, 0.75, 1.0]
    for place in {flap_at, lag_at}:
        r += [place - LENGTH / 2 - RAMP, place - LENGTH / 2, place + LENGTH / 2, place + LENGTH / 2 + RAMP]
    r = np.array(sorted(r))

    def soft(at, stiffness):
        return np.where(np.abs(r - at) <= LENGTH / 2 + 1e-9, stiffness, RIGID)

    given = {
        "radius": r,
        "mass_per_length": 1.5 - 0.5 * r,
        "flatwise_stiffness": soft(flap_at, FLAP * LENGTH),
        "edgewise_stiffness": soft(lag_at, LAG * LENGTH),
        "torsion_stiffness": np.full(len(r), 1e6),
        "twist": np.where(r < 0.5, twist, 0.0),
        "pitch_inertia_per_length": np.full(len(r), 0.01),
        "control_stiffness": 7.0,
        "pitch_bearing": bearing,
    }
    return hinged_blade(BladeStations(**given | changed), SPEED, PITCH)


def test_a_blade_with_flexures_inboard_of_its_bearing_has_no_couplings():
    """Offsets and springs are those of the flexures, and nothing turns with the pitch."""
    found = with_flexures(0.06, 0.12, bearing=0.2)
    numbers = found.numbers
    assert numbers["flap_hinge_offset"] == pytest.approx(0.06, abs=5e-3)
    assert numbers["lag_hinge_offset"] == pytest.approx(0.12, abs=5e-3)
    assert numbers["flap_stiffness"] == pytest.approx(FLAP, rel=0.04)
    assert numbers["lag_stiffness"] == pytest.approx(LAG, rel=0.04)
    assert numbers["flap_outboard_fraction"] < 0.01
    assert numbers["lag_outboard_fraction"] < 0.01
    _, slope = spring_matrix(numbers, PITCH)
    assert np.abs(slope).max() < 0.02 * LAG


@pytest.mark.parametrize("twist", [0.0, 0.2])
def test_a_blade_with_flexures_outboard_of_its_bearing_turns_with_the_pitch(twist):
    """All flexibility is outboard, at the angle of the flexures; a torque there turns the control system alone."""
    found = with_flexures(0.1, 0.1, bearing=0.02, twist=twist)
    numbers = found.numbers
    assert numbers["flap_hinge_offset"] == pytest.approx(0.1, abs=5e-3)
    assert numbers["flap_stiffness"] == pytest.approx(FLAP, rel=0.04)
    assert numbers["lag_stiffness"] == pytest.approx(LAG, rel=0.04)
    assert numbers["flap_outboard_fraction"] > 0.99
    assert numbers["lag_outboard_fraction"] > 0.98
    assert numbers["structural_pitch_offset"] == pytest.approx(twist, abs=5e-3)
    assert numbers["control_stiffness"] == pytest.approx(7.0, rel=0.04)
    assert found.pitch_stiffness.even == pytest.approx(7.0, rel=1e-3)


def test_mass_integrals():
    """Of m = 1.5 - r/2 from the centre to 1, in closed form."""
    numbers = with_flexures(0.06, 0.12, bearing=0.2).numbers
    assert numbers["blade_mass"] == pytest.approx(1.25, rel=1e-12)
    assert numbers["blade_first_moment"] == pytest.approx(1.5 / 2 - 0.5 / 3, rel=1e-12)
    assert numbers["blade_inertia"] == pytest.approx(1.5 / 3 - 0.5 / 4, rel=1e-12)
    e = numbers["flap_hinge_offset"]
    s = 1.5 * (1 - e) ** 2 / 2 - 0.5 * ((1 - e**3) / 3 - e * (1 - e**2) / 2)
    assert numbers["flap_first_moment"] == pytest.approx(s, rel=1e-3)
    assert numbers["pitch_inertia"] == pytest.approx(0.01 * 0.8, rel=1e-9)


def test_the_springs_have_the_slope_that_their_pitch_gives_them():
    numbers = with_flexures(0.1, 0.1, bearing=0.02, twist=0.1).numbers
    ends = [spring_matrix(numbers, PITCH + side * 1e-5)[0] for side in (1, -1)]
    _, slope = spring_matrix(numbers, PITCH)
    np.testing.assert_allclose(slope, (ends[0] - ends[1]) / 2e-5, rtol=1e-6, atol=1e-6 * LAG)


def test_a_blade_too_heavy_for_its_stiffness_is_refused_in_words():
    """A table in the wrong unit of mass: its bending is all centrifugal, and no spring at a hinge stands for that."""
    slug_per_foot = 47.880259
    heavy = BladeStations(
        radius=np.array([0.20, 0.24, 0.26, 0.34, 0.36, 1.00, 1.90, 2.85, 3.80]),
        mass_per_length=slug_per_foot * np.array([40, 40, 30, 30, 20, 9, 8, 7, 7]),
        flatwise_stiffness=np.array([4e6, 4e6, 6e3, 6e3, 3e6, 2e6, 1e6, 5e5, 2e5]),
        edgewise_stiffness=np.array([4e6, 4e6, 4e4, 4e4, 6e6, 5e6, 4e6, 2e6, 1e6]),
        torsion_stiffness=np.array([4e5, 4e5, 3e5, 3e5, 3e5, 1e5, 5e4, 2e4, 7e3]),
        twist=np.radians([29, 29, 29, 28, 28, 18, 7, 0, -6]),
        control_stiffness=3e4,
        pitch_bearing=0.24,
    )
    with pytest.raises(
        InputError, match=r"have no hinged blade: .* in lag more easily than a straight blade"
    ):
        hinged_blade(heavy, 458 * np.pi / 30, np.radians([20.0, 30.0, 40.0, 50.0]))
