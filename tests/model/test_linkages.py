"""Linkages of the blade's hinges and a control system of two stiffnesses, through trim, model, deck and options."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp
from proprotor.datum import deck_unit
from proprotor.errors import InputError

SPEED = 100.0  # m/s
ROUNDING = 1e-12


@pytest.fixture(scope="module")
def case() -> pp.Case:
    return pp.load_case("xv15-uncoupled")


def linked(case: pp.Case, **changes: float) -> pp.Case:
    return replace(case, rotor=replace(case.rotor, **changes))


def test_the_swashplate_makes_up_for_what_the_linkages_turn_the_blade_by(case: pp.Case) -> None:
    """Nothing twists these blades, so no link carries a load, and the blade windmills at the pitch without linkages."""
    rotor = replace(
        case.rotor,
        airfoil=replace(case.rotor.airfoil, moment=0.0),
        propeller_moment=False,
        flap_outboard_fraction=0.0,
        lag_outboard_fraction=0.0,
    )
    case, options = replace(case, rotor=rotor), {"pitch": "rigid", "section_damping": False}
    plain = case.linearize(SPEED, **options).trim
    for flap, lag in ((0.3, 0.0), (0.0, -0.4), (0.3, -0.4)):
        model = linked(case, kinematic_pitch_flap_coupling=flap, kinematic_pitch_lag_coupling=lag)
        trim = model.linearize(SPEED, **options).trim
        assert float(trim.coning) == pytest.approx(float(plain.coning), rel=1e-9)
        assert float(trim.lag) == pytest.approx(float(plain.lag), rel=1e-9)
        asked = plain.collective + flap * plain.coning + lag * plain.lag
        assert float(trim.collective) == pytest.approx(float(asked), abs=ROUNDING)
        assert abs(trim.collective - plain.collective) > 1e-6


def test_one_point_and_a_batch_have_the_same_trim(case: pp.Case) -> None:
    model = linked(case, kinematic_pitch_flap_coupling=0.3, kinematic_pitch_lag_coupling=-0.4)
    one, batch = model.linearize(SPEED), model.linearize(np.array([SPEED, 1.1 * SPEED]))
    for name in ("collective", "coning", "lag", "elastic_pitch"):
        assert getattr(one.trim, name) == pytest.approx(getattr(batch.trim, name)[0], abs=ROUNDING)
    for name in "MCK":
        whole = getattr(batch, name)[0]
        assert np.abs(getattr(one, name) - whole).max() < 1e-10 * np.abs(whole).max()


def test_a_softer_swashplate_tilt_changes_only_cyclic_pitch(case: pp.Case) -> None:
    rotor = case.rotor
    softer = linked(case, cyclic_control_stiffness=0.6 * rotor.control_stiffness)
    ours, theirs = softer.linearize(SPEED), case.linearize(SPEED)
    for name in (
        "collective",
        "coning",
    ):  # by the plans for all rotors, and by those for rotors without linkages
        assert getattr(ours.trim, name) == pytest.approx(getattr(theirs.trim, name), abs=ROUNDING)
    changed = ours.K - theirs.K
    places = [ours.dofs.index(name) for name in ("pitch_1c", "pitch_1s")]
    lost = -0.4 * rotor.control_stiffness * rotor.n_blades / 2
    assert np.diag(changed)[places] == pytest.approx(lost, rel=1e-9)
    changed[places, places] = 0
    assert np.abs(changed).max() <= ROUNDING * np.abs(theirs.K).max()
    for name in "MC":
        own, other = getattr(ours, name), getattr(theirs, name)
        assert np.abs(own - other).max() <= ROUNDING * np.abs(other).max()
    inputs = ours.B - theirs.B
    assert inputs[places, [1, 2]] == pytest.approx(lost, rel=1e-9)  # the swashplate's cyclic motions
    inputs[places, [1, 2]] = 0
    assert np.abs(inputs).max() <= ROUNDING * np.abs(theirs.B).max()


def test_equal_stiffness_of_both_is_none_of_its_own(case: pp.Case) -> None:
    same = linked(case, cyclic_control_stiffness=case.rotor.control_stiffness)
    assert (same.linearize(SPEED).K == case.linearize(SPEED).K).all()


def test_a_second_stiffness_is_refused_where_couplings_stand_for_the_pitch(case: pp.Case) -> None:
    softer = linked(case, cyclic_control_stiffness=9000.0)
    with pytest.raises(InputError, match=r"cyclic_control_stiffness = 9000\.0: must be left out with pitch="):
        softer.linearize(SPEED, pitch="coupling")
    with pytest.raises(InputError, match="cyclic_control_stiffness"):
        linked(case, cyclic_control_stiffness=-1.0)


@pytest.mark.parametrize(
    "field", ["pitch_gimbal_coupling", "kinematic_pitch_flap_coupling", "kinematic_pitch_lag_coupling"]
)
def test_a_deck_takes_the_angle_or_its_tangent(field: str) -> None:
    by_angle = pp.load_case("xv15", {f"rotor.{field}": "-15 deg"})
    number = by_angle.given[f"rotor.{field}"]
    assert number.si == pytest.approx(-0.2679491924311227, abs=1e-15)  # tan 15° = 2 - √3
    assert (number.written, number.unit, deck_unit(number)) == ("-15 deg", "", ("", 1.0))
    assert getattr(by_angle.rotor, field) == number.si
    plain = pp.load_case("xv15", {f"rotor.{field}": "-0.25"})
    assert getattr(plain.rotor, field) == -0.25


@pytest.mark.parametrize(
    ("text", "rule"),
    [("90 deg", "must lie within 90 deg"), ("3 ft", "a plain number"), ("true", "plain number")],
)
def test_what_is_neither_is_refused(text: str, rule: str) -> None:
    with pytest.raises(InputError, match=rule):
        pp.load_case("xv15", {"rotor.pitch_gimbal_coupling": text})
