"""A frequency written per revolution is one of the rotor speed of its file, and a frequency in hertz from then on.

So the same question has the same answer by `--set`, by a variant of a deck, by vary, a study, a map, a sensitivity and
a deck that the explorer writes. Expected frequencies are products worked out here.
"""

import numpy as np
import pytest

import proprotor as pp
from proprotor.deck.describe import deck_fields
from proprotor.deck.file import read_tables
from proprotor.deck.template import deck_text
from proprotor.explore.altered_deck import altered_deck
from proprotor.explore.inputs import slider_input

RPM = np.pi / 30
SPEED = "operation.rotor_speed"
OWN, FASTER = 458 * RPM, 500 * RPM
HUB = "rotor.lag_frequency"
DECK = """
base = "xv15-uncoupled"
[case]
name = "per-rev"
[rotor]
flap_frequency = { value = "1.25/rev", status = "assumed", source = "made up" }
lag_frequency = "2.125/rev"
"""
# Every field of a deck that takes a frequency, with its value per revolution in DECK.
FREQUENCIES = {
    "rotor.flap_frequency": 1.25,
    "rotor.lag_frequency": 2.125,
    "support.modes[beam].frequency": 0.42,
    "support.modes[chord].frequency": 0.70,
    "support.modes[torsion].frequency": 1.30,
}


@pytest.fixture
def deck(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "deck.toml"
    file.write_text(DECK)
    return file


def hertz(case):
    return {path: case.given[path].si / (2 * np.pi) for path in FREQUENCIES}


def expected(rotor_speed=OWN):
    return {path: pytest.approx(per_rev * rotor_speed / (2 * np.pi)) for path, per_rev in FREQUENCIES.items()}


def roots(case):
    values = case.linearize(150.0).modes().eigenvalue.values
    return values[np.argsort(values.imag, kind="stable")]


def test_these_are_all_the_fields_that_take_a_frequency():
    fields = {field.path for field in deck_fields() if field.form == "frequency"}
    of_wing = {f"support.{kind}_frequency" for kind in ("beam", "chord", "torsion")}
    of_loop = {"control.loops[NAME].actuator_bandwidth"}  # tests/deck/test_control_deck.py
    modes = {"rotor.flap_frequency", "rotor.lag_frequency", "support.modes[NAME].frequency"}
    assert fields == modes | of_wing | of_loop


def test_a_frequency_is_per_revolution_of_its_file(deck):
    assert hertz(pp.load_case(deck)) == expected()


def test_a_set_rotor_speed_leaves_frequencies_their_hertz(deck):
    case = pp.load_case(deck, {SPEED: "500 rpm"})
    assert float(case.operation.rotor_speed) == pytest.approx(FASTER)
    assert hertz(case) == expected()


def test_a_set_rotor_speed_leaves_the_frequencies_of_a_wing_their_hertz():
    deck, faster = pp.load_case("xv15"), pp.load_case("xv15", {SPEED: "500 rpm"})
    for kind, per_rev in {"beam": 0.42, "chord": 0.70, "torsion": 1.30}.items():
        path, factor = f"support.{kind}_frequency", f"support.{kind}_stiffness_factor"
        assert faster.given[path].si == deck.given[path].si == pytest.approx(per_rev * OWN)
        assert faster.sources[factor].si == deck.sources[factor].si


def test_set_vary_variant_study_and_map_have_one_answer(deck, tmp_path):
    variant = tmp_path / "variant.toml"
    variant.write_text('base = "deck.toml"\n[case]\nname = "faster"\n[operation]\nrotor_speed = "500 rpm"\n')
    of_deck = pp.load_case(deck)
    found = roots(pp.load_case(deck, {SPEED: "500 rpm"}))
    for case in (of_deck.vary({SPEED: FASTER}), of_deck.vary({SPEED: "500 rpm"}), pp.load_case(variant)):
        np.testing.assert_allclose(roots(case), found, rtol=1e-9)
    of_study = pp.study(of_deck, {SPEED: [OWN, FASTER]}, [150.0], "eigenvalue", workers=1).eigenvalue.values[
        1, 0
    ]
    np.testing.assert_allclose(of_study[of_study.imag >= 0], found, rtol=1e-9)
    precone = of_deck.given["rotor.precone"].si
    axes = {SPEED: [OWN, FASTER], "rotor.precone": [precone, 1.1 * precone]}
    growth = of_deck.stability_map(axes, airspeed=150.0).growth.values[0, 1]
    assert growth == pytest.approx(found.real.max(), rel=1e-9)


def test_the_flutter_speed_of_the_xv15_is_the_same_by_set_and_by_study():
    """373.8 kt and 367.0 kt once."""
    speeds = np.arange(160.0, 211.0, 5.0)
    by_set = pp.load_case("xv15-uncoupled", {SPEED: "500 rpm"}).flutter_point(speeds).speed
    by_vary = pp.load_case("xv15-uncoupled").vary({SPEED: FASTER}).flutter_point(speeds).speed
    assert by_set == pytest.approx(by_vary, rel=1e-9)
    assert np.isfinite(by_set)


@pytest.mark.parametrize("path", FREQUENCIES)
def test_a_set_frequency_is_per_revolution_of_the_decks_own_speed(deck, path):
    for settings in (
        {path: "0.9/rev"},
        {path: "0.9/rev", SPEED: "500 rpm"},
        {SPEED: "500 rpm", path: "0.9/rev"},
    ):
        assert hertz(pp.load_case(deck, settings)) == expected() | {
            path: pytest.approx(0.9 * OWN / (2 * np.pi))
        }


def test_each_file_has_its_own_revolution(tmp_path, deck):
    """A variant's own frequency is one of the variant's speed; what it inherits stays what it was."""
    variant = tmp_path / "variant.toml"
    variant.write_text(
        'base = "deck.toml"\n[case]\nname = "faster"\n[rotor]\nlag_frequency = "2/rev"\n'
        '[operation]\nrotor_speed = "500 rpm"\n'
    )
    case = pp.load_case(variant)
    assert hertz(case) == expected() | {HUB: pytest.approx(2 * FASTER / (2 * np.pi))}
    assert case.given[HUB].written == "2/rev"
    assert slider_input(case, HUB).value == pytest.approx(2)
    assert slider_input(case, "rotor.flap_frequency").value == pytest.approx(1.25)
    again = tmp_path / "again.toml"
    again.write_text('base = "variant.toml"\n[case]\nname = "again"\n[operation]\nrotor_speed = "300 rpm"\n')
    assert hertz(pp.load_case(again)) == hertz(case)


@pytest.mark.parametrize("values", [{}, {SPEED: FASTER}, {HUB: 90.0}, {SPEED: FASTER, HUB: 90.0}], ids=str)
@pytest.mark.parametrize(
    "settings", [{}, {SPEED: "430 rpm"}, {"support.modes[beam].frequency": "0.5/rev"}], ids=str
)
def test_what_the_explorer_writes_is_what_it_showed(deck, values, settings):
    case = pp.load_case(deck, settings)
    shown = case.vary(values) if values else case
    written = deck.parent / "explored.toml"
    written.write_text(altered_deck(deck.name, case, values, settings))
    read = pp.load_case(written)
    for path, number in shown.given.items():
        expected = number.si if isinstance(number.si, str | bool) else pytest.approx(number.si, rel=1e-11)
        assert read.given[path].si == expected, path


def test_the_explorer_of_a_variant_writes_what_it_showed(deck):
    """Its sliders are in revolutions of the file that each number came from."""
    variant = deck.parent / "variant.toml"
    variant.write_text('base = "deck.toml"\n[case]\nname = "faster"\n[operation]\nrotor_speed = "500 rpm"\n')
    case, values = pp.load_case(variant), {HUB: 90.0, "support.modes[chord].frequency": 30.0}
    written = deck.parent / "explored.toml"
    written.write_text(altered_deck(variant.name, case, values))
    assert hertz(pp.load_case(written)) == pytest.approx(hertz(case.vary(values)), rel=1e-11)


def test_a_deck_written_out_whole_has_the_same_numbers(deck):
    variant, whole = deck.parent / "variant.toml", deck.parent / "whole.toml"
    variant.write_text('base = "deck.toml"\n[case]\nname = "faster"\n[operation]\nrotor_speed = "500 rpm"\n')
    whole.write_text(deck_text(read_tables(variant), whole))
    assert hertz(pp.load_case(whole)) == hertz(pp.load_case(variant))


def test_the_sensitivity_to_the_rotor_speed_is_that_of_setting_it(deck):
    case = pp.load_case(deck)
    found = case.sensitivity("eigenvalue", [SPEED], airspeed=150.0, mode="torsion").derivative.values.item()
    step = 0.01  # rpm
    ends = [
        pp.load_case(deck, {SPEED: f"{458 + sign * step} rpm"})
        .sweep(150.0)
        .eigenvalue.sel(mode="torsion")
        .item()
        for sign in (1, -1)
    ]
    assert found == pytest.approx((ends[0] - ends[1]) / (2 * step * RPM), rel=1e-6)
