"""The hinged blade beside the elastic blade: the same rotor both ways, and a blade that is no hinged one."""

import numpy as np
import pytest

import proprotor as pp
from proprotor.model.blade_comparison import compare_blades, hinged_frequencies, in_vacuum
from proprotor.rotor.from_stations import rotor_from_stations
from proprotor.rotor.hinged_blade import hinged_blade

PITCH, SPEED = np.radians([10.0, 30.0, 50.0]), 3.0
AIRFOIL = pp.Airfoil(lift_slope=5.7, drag=0.01)


def blade(flat, edge, **more):
    r = np.array([0.0, 0.05, 0.06, 0.08, 0.09, 0.4, 0.75, 1.0])
    soft = (r > 0.055) & (r < 0.085)
    given = {
        "radius": r,
        "mass_per_length": np.ones(8),
        "flatwise_stiffness": np.where(soft, flat, 40.0),
        "edgewise_stiffness": np.where(soft, edge, 80.0),
        "torsion_stiffness": np.full(8, 50.0),
        "twist": -0.4 * r,
        "chord": np.full(8, 0.1),
        "control_stiffness": 2.0,
    }
    return pp.BladeStations(**given | more)


def test_a_blade_of_flexures_is_a_hinged_blade():
    table = blade(0.05, 0.3)
    found = compare_blades(table, hinged_blade(table, SPEED, PITCH))
    assert not found.poor, [(one.name, one.difference) for one in found.poor]


def test_a_blade_that_bends_all_along_is_none():
    table = blade(
        1.0,
        1.5,
        flatwise_stiffness=np.ones(8),
        edgewise_stiffness=np.full(8, 1.5),
        twist=-1.2 * np.linspace(0, 1, 8),
    )
    found = compare_blades(table, hinged_blade(table, SPEED, PITCH))
    assert "flap at 0.75 R, of the tip's" in [one.name for one in found.poor]


def test_frequencies_in_rotating_axes_of_a_blade_without_springs_in_the_disk():
    """ν_β² = 1 + (e S + K/Ω²)/I and ν_ζ² = (e S + K/Ω²)/I at zero pitch offset, and the gimbal once per revolution."""
    table = blade(0.05, 0.3, twist=np.zeros(8), pitch_bearing=0.2)
    fixed = dict.fromkeys(("flap_outboard_fraction", "lag_outboard_fraction"), 0.0)
    found = hinged_blade(table, SPEED, PITCH)
    hinged = found._replace(numbers=found.numbers | fixed)
    numbers = hinged.numbers
    collective, cyclic = hinged_frequencies(in_vacuum(hinged), SPEED, PITCH)
    flap, lag = (
        (
            numbers[f"{name}_hinge_offset"] * numbers[f"{name}_first_moment"] * SPEED**2
            + numbers[f"{name}_stiffness"]
        )
        / numbers[f"{name}_inertia"]
        for name in ("flap", "lag")
    )
    expected = np.sort(np.sqrt([SPEED**2 + flap, lag]))
    np.testing.assert_allclose(collective, np.broadcast_to(expected, (3, 2)), rtol=1e-9)
    assert (np.diff(cyclic, axis=1) > 0).all()


def test_a_rotor_from_stations():
    table = blade(0.05, 0.3)
    more = {"n_blades": 3, "airfoil": AIRFOIL, "gimbal_stiffness": 1.0}
    made = rotor_from_stations(table, rotor_speed=SPEED, pitch=PITCH, **more)
    rotor = pp.Rotor.from_stations(table, rotor_speed=SPEED, pitch=PITCH, **more)
    assert rotor.flap_stiffness == made.rotor.flap_stiffness == made.blade.numbers["flap_stiffness"]
    assert rotor.twist_at(np.array([0.75]))[0] == pytest.approx(0.0, abs=1e-12)
    held = pp.Rotor.from_stations(
        table, rotor_speed=SPEED, pitch=PITCH, lag_damping=2.0, control_stiffness=9.0, **more
    )
    assert (held.lag_damping, held.control_stiffness) == (2.0, 9.0)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"pitch": [0.1, 0.2, 0.2]}, "must be a list of at least 3 different collectives"),
        ({"rotor_speed": 0.0}, "rotor_speed = 0.0: must be above zero"),
    ],
)
def test_what_no_rotor_can_be_made_of(changed, message):
    given = {"rotor_speed": SPEED, "pitch": PITCH, "n_blades": 3, "airfoil": AIRFOIL} | changed
    with pytest.raises(pp.InputError, match=message):
        pp.Rotor.from_stations(blade(0.05, 0.3), **given)


def test_a_chord_is_needed():
    with pytest.raises(pp.InputError, match="chord: must be a column of the stations, or be given"):
        pp.Rotor.from_stations(
            blade(0.05, 0.3, chord=None), rotor_speed=SPEED, pitch=PITCH, n_blades=3, airfoil=AIRFOIL
        )
