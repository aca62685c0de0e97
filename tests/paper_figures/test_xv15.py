"""The XV-15 against what AIAA-2002-1604 says of it, and the variations of its inputs against altered decks."""

from pathlib import Path

import numpy as np
import pytest

import proprotor as pp
from benchmarks import xv15_inputs as inputs
from benchmarks import xv15_switches as study
from proprotor.units import KNOT


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


@pytest.fixture(scope="module")
def rows(case):
    return study.switch_table(case, "consistent")


def change(rows, label):
    return rows[label]["chord"] - rows["baseline"]["chord"]


def test_the_couplings_lower_the_boundary_by_more_than_100_knots(rows):
    assert change(rows, "K_Pβ = K_Pζ = 0") > 100
    for mode in ("beam", "torsion"):
        assert np.isinf(rows["K_Pβ = K_Pζ = 0"][mode])


def test_pitch_flap_coupling_alone_matters_much_less_but_matters(rows):
    assert 5 < change(rows, "K_Pβ = 0") < change(rows, "K_Pβ = K_Pζ = 0") / 3


def test_couplings_do_most_of_what_the_pitch_equations_do(rows):
    assert abs(change(rows, "pitch equations")) < change(rows, "K_Pβ = K_Pζ = 0") / 10


def test_flap_lag_stiffness_moves_the_boundary_by_tens_of_knots_at_most(rows):
    assert 10 < change(rows, "K_βζ = 0, couplings as they were") < 40


def test_pitch_lag_coupling_at_the_boundary_is_what_it_was_calibrated_to(case, rows):
    state = study.blade_state(case, rows["baseline"]["chord"] * KNOT)
    assert state.pitch_lag_coupling == pytest.approx(-0.3, abs=0.02)
    assert state.pitch_flap_coupling == pytest.approx(state.pitch_lag_coupling, rel=0.3)


def test_pitch_lag_coupling_vanishes_at_45_degrees_without_trim_lag(case):
    _, angle = study.zero_of_pitch_lag_coupling(case, "pitch_lag_coupling_without_lag")
    assert angle == pytest.approx(45, abs=1e-6)
    speed, angle = study.zero_of_pitch_lag_coupling(case, "pitch_lag_coupling")
    assert speed == pytest.approx(201, abs=1) and angle == pytest.approx(53.1, abs=0.1)


DECK = Path(pp.__file__).parent / "deck" / "decks" / "xv15-uncoupled.toml"
WRITTEN = {
    ("chord", "frequency"): ("0.70/rev", "0.91/rev"),
    ("chord", "damping"): ("2 %", "2.6 %"),
    ("torsion", "generalised mass"): ("1000 slug*ft**2", "1300 slug*ft**2"),
}


@pytest.mark.parametrize(("mode", "quantity"), WRITTEN)
def test_a_varied_wing_mode_is_that_of_an_altered_deck(case, tmp_path, mode, quantity):
    old, new = WRITTEN[mode, quantity]
    text = DECK.read_text(encoding="utf-8")
    assert text.count(f'"{old}"') == 1
    path = tmp_path / "deck.toml"
    path.write_text(text.replace(f'"{old}"', f'"{new}"'), encoding="utf-8")
    varied, altered = inputs.scaled_mode(1.3, mode, quantity)(case).support, pp.load_case(path).support
    for name in ("mass", "damping", "stiffness"):
        np.testing.assert_allclose(getattr(varied, name), getattr(altered, name), rtol=1e-12)


def test_every_input_can_be_varied(case):
    for one in (*inputs.wing_inputs(), *inputs.rotor_inputs(), *inputs.air_inputs()):
        for told, alter in (one.low, one.high):
            if one.name == "I_βα" and told.startswith("105"):
                with pytest.raises(pp.InputError):
                    alter(case)
            else:
                assert isinstance(alter(case), pp.Case)
