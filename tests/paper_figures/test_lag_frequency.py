"""The numbers of docs/lag-frequency.md that follow from Table 1 by hand, and the deck of Bell's frequencies."""

from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp
from benchmarks import lag_frequency
from benchmarks.paper_figures.blade_state import on_rigid_hub

OMEGA = 458 * np.pi / 30
# AIAA-2002-1604, Table 1: slug ft², slug ft, rad/s; the lag hinge at (82.6 - 70.4)/8.69 ft.
FLAP_INERTIA, LAG_INERTIA, FLAP, LAG = 81.8, 70.4, 59.8, 103.0
CENTRIFUGAL = (82.6 - 70.4) / LAG_INERTIA


def by_hand(structural_pitch, rotor_speed=OMEGA):
    """ν_ζ of springs that turn whole: K_ζζ = K_ζ cos² + K_β sin²."""
    turned = LAG_INERTIA * LAG**2 * np.cos(structural_pitch) ** 2
    turned += FLAP_INERTIA * FLAP**2 * np.sin(structural_pitch) ** 2
    return np.sqrt(CENTRIFUGAL + turned / (LAG_INERTIA * rotor_speed**2))


def test_table_1_gives_no_lag_frequency_below_1_4():
    turn = np.radians(np.linspace(0, 90, 91))
    rotor = lag_frequency.ROTOR
    for rpm in (458, 565):
        speed = rpm * np.pi / 30
        found = lag_frequency.lag_frequency(rotor, turn - rotor.structural_pitch_offset, speed)
        # 1e-4: the deck rounds the hinge offset to a thousandth of a foot
        np.testing.assert_allclose(found, by_hand(turn, speed), rtol=1e-4)
    assert by_hand(np.pi / 2) == pytest.approx(1.407, abs=5e-4)
    assert lag_frequency.blade_alone(rotor, turn).min() == pytest.approx(by_hand(np.pi / 2), rel=1e-4)


def test_both_springs_and_one_input_give_what_they_are_asked_for():
    for target in lag_frequency.targets():
        found = lag_frequency.lag_frequency(lag_frequency.both_springs(target), target.pitch)
        np.testing.assert_allclose(found, target.frequency, rtol=1e-12)
    spring = lag_frequency.inputs()[0]
    value, _ = lag_frequency.value_for(spring, 1.8, np.radians(10.0))
    assert lag_frequency.lag_frequency(spring.rotor(value), np.radians(10.0)) == pytest.approx(1.8, rel=1e-9)
    value, nearest = lag_frequency.value_for(spring, 1.0, np.radians(70.0))
    assert np.isnan(value) and nearest > 1.0


def test_the_rotor_of_bell_has_bells_frequencies_in_a_vacuum():
    """Cyclic lag at ν - 1 and coning at ν on a rigid hub; precone and gimbal move them by less than .003."""
    case = pp.load_case("xv15-bell-frequencies")
    still = replace(case.operation, density=0.0, trim={"collective": np.radians([20.0, 50.0])})
    options = {
        "structure": "tabulated",
        "frequencies": case.frequencies,
        "airloads": "none",
        "pitch": "rigid",
    }
    found = on_rigid_hub(replace(case, operation=still), np.full(2, 100.0), **options)
    np.testing.assert_allclose(1 + found["low cyclic lag"], [1.454, 1.052], atol=3e-3)
    np.testing.assert_allclose(found["coning"], [1.69, 2.04], atol=3e-3)


def test_the_deck_of_bell_differs_from_its_base_in_the_frequencies_alone():
    bell, base = pp.load_case("xv15-bell-frequencies"), pp.load_case("xv15")
    own = {path for path in bell.given if path.startswith("rotor.frequencies.")}
    assert {path: number for path, number in bell.given.items() if path not in own} == dict(base.given)
    assert own == {f"rotor.frequencies.{name}" for name in ("at_rotor_speed", "at", "flap", "lag")}
