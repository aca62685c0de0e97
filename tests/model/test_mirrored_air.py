"""A rotor that turns the other way is a mirror image, with the states of its air and of its circulation.

Seen in a mirror along the plane of the shaft and x: azimuth runs backwards, so what goes with its sine changes sign;
forces in the plane of the disk, pitch, nose-up moments and speeds along the chord change sign, those along the shaft
and along the blade do not. The parities are those of geometry, and the functions get any sign of the rotor speed.
"""

import sys

import numpy as np
import pytest
from proprotor_equations import BLADE_COORDINATES, FIXED_COORDINATES

from proprotor.model.inflow import with_inflow
from proprotor.model.lift_lag import LaggingBlade, with_lift_lag
from proprotor.model.linear_model import INPUTS
from proprotor.rotor.motions import INFLOW, lag_coordinates
from tests.derive.test_invariants import REVERSED
from tests.oracles.random_rotors import RotorInAir

REVERSED_ON_BLADE = ("hub_i", "turn_j", "turn_k", "lag", "pitch", "azimuth", "gimbal_roll")
REVERSED_LOADS = ("fx", "m")  # in the plane, and nose up
REVERSED_MOTIONS = ("ut", "theta", "spin")  # along the chord, and nose up
REVERSED_NUMBERS = (
    *("rotor_speed", "lag", "sin_lag", "pitch", "collective", "elastic_pitch", "structural_pitch"),
    *("pitch_gimbal_coupling", "kinematic_pitch_flap_coupling", "pitch_flap_coupling"),
)
CASES = (
    {"seed": 41, "n_blades": 3, "airspeed": 90.0, "trim": "windmill"},
    {"seed": 43, "n_blades": 4, "airspeed": 40.0, "trim": {"thrust_coefficient": 0.012}},
)


def signs(names, turned):
    return np.array([-1.0 if name in turned else 1.0 for name in names])


def mirrored_segments(segments):
    """Radial moments of section loads, fx_theta_1, of a blade that turns the other way."""
    found = {}
    for name, value in segments.items():
        load, *motion = name.split("_")
        turns = (load in REVERSED_LOADS) + (motion[0] in REVERSED_MOTIONS if motion else False)
        found[name] = value * (-1.0) ** turns if load in ("fx", "fn", "fd", "m") else value
    return found


def mirrored_numbers(quantities):
    return {name: -value if name in REVERSED_NUMBERS else value for name, value in quantities.items()}


def taken(monkeypatch, name, given, **options):
    """The model, and what it gives to one of the functions that add states."""
    module = sys.modules["proprotor.model.rotor_model"]
    calls, real = [], getattr(module, name)

    def watched(*arguments):
        calls.append(arguments)
        return real(*arguments)

    monkeypatch.setattr(module, name, watched)
    RotorInAir(**given).model(**options)
    return calls[-1]


def assert_mirrored(image, own, states):
    """Entry by entry, of rotor and states; sine parts of the states change sign."""
    of_states = [-1.0 if name.endswith("1s") else 1.0 for name in states]
    row = np.concatenate([signs(FIXED_COORDINATES, REVERSED), of_states])
    column = {"B": signs(INPUTS, ("collective", "cyclic_1c", "gust_y"))}
    for name, matrix in own.items():
        seen = row[:, None] * image[name] * column.get(name, row)
        largest = np.abs(matrix).max()
        assert largest > 0
        np.testing.assert_allclose(seen, matrix, rtol=1e-10, atol=1e-13 * largest, err_msg=name)


def nothing(rotor):
    return {name: np.zeros_like(matrix) for name, matrix in rotor.items()}


@pytest.mark.parametrize("given", CASES)
def test_inflow_of_a_rotor_that_turns_the_other_way(given, monkeypatch):
    rotor, segments, quantities, induced, options = taken(monkeypatch, "with_inflow", given, inflow="dynamic")
    own = with_inflow(nothing(rotor), segments, quantities, induced, options)
    image = with_inflow(
        nothing(rotor), mirrored_segments(segments), mirrored_numbers(quantities), induced, options
    )
    assert_mirrored(image, own, [one.name for one in INFLOW])


@pytest.mark.parametrize("given", CASES)
def test_lift_that_lags_on_a_rotor_that_turns_the_other_way(given, monkeypatch):
    """Loads and changes of circulation of one blade, whose axis i points ahead in the disk, are mirrored by hand.

    The sum over the blades is what is tested.
    """
    rotor, blade, quantities = taken(monkeypatch, "with_lift_lag", given, lift="lagged")
    of_blade, of_gusts = signs(BLADE_COORDINATES, REVERSED_ON_BLADE), signs("ijk", "i")
    image_blade = LaggingBlade(
        blade.work * of_blade,
        blade.by_rates * of_blade,
        blade.by_displacements * of_blade,
        blade.by_gusts * of_gusts,
        blade.weight,
        blade.decay,
    )
    own = with_lift_lag(nothing(rotor), blade, quantities)
    image = with_lift_lag(nothing(rotor), image_blade, mirrored_numbers(quantities))
    assert_mirrored(image, own, [one.name for one in lag_coordinates()])
