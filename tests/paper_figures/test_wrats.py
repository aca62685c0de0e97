"""The decks of the 1/5-scale models: Table 2 as printed, honest statuses, one blade, and what changes between them."""

import numpy as np
import pytest

import proprotor as pp
from derive.audit.printed.tables import TABLES
from derive.audit.tables import implied_offset
from proprotor.datum import STATUSES

FT, SLUG = 0.3048, 0.45359237 * 9.80665 / 0.3048
WRATS = {"wrats-742-off": 742, "wrats-888-off": 888, "wrats-770-on": 770, "wrats-888-on": 888}
MODELS = (*WRATS, "v22-fifth-scale")
TABLE_2 = next(table.values for table in TABLES if table.number == 2)
PUBLISHED = {
    "n_blades": ("N", 1),
    "radius": ("R", FT),
    "blade_inertia": ("I_b", SLUG * FT**2),
    "flap_inertia": ("I_β", SLUG * FT**2),
    "lag_inertia": ("I_ζ", SLUG * FT**2),
    "flap_first_moment": ("S_β", SLUG * FT),
    "lag_first_moment": ("S_ζ", SLUG * FT),
    "flap_outboard_fraction": ("R_β", 1),
    "lag_outboard_fraction": ("R_ζ", 1),
    "pitch_gimbal_coupling": ("K_PG", 1),
}


@pytest.fixture(scope="module")
def cases():
    return {name: pp.load_case(name) for name in MODELS}


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("field", PUBLISHED)
def test_the_rotor_is_that_of_table_2(cases, name, field):
    symbol, unit = PUBLISHED[field]
    assert getattr(cases[name].rotor, field) == pytest.approx(TABLE_2[symbol] * unit, rel=1e-9)
    assert cases[name].sources[f"rotor.{field}"].status == "published"


@pytest.mark.parametrize("name", MODELS)
def test_non_rotating_frequencies_give_the_springs(cases, name):
    rotor = cases[name].rotor
    for hinge, symbol in (("flap", "ω_β0"), ("lag", "ω_ζ0")):
        stiffness, inertia = getattr(rotor, f"{hinge}_stiffness"), getattr(rotor, f"{hinge}_inertia")
        assert np.sqrt(stiffness / inertia) == pytest.approx(TABLE_2[symbol], rel=1e-9)


@pytest.mark.parametrize("name", MODELS)
def test_the_chord_gives_lock_number_and_solidity(cases, name):
    rotor, density = cases[name].rotor, cases[name].operation.density
    lock = density * rotor.airfoil.lift_slope * rotor.chord * rotor.radius**4 / rotor.blade_inertia
    assert rotor.airfoil.lift_slope == TABLE_2["c_lα"]
    assert lock == pytest.approx(TABLE_2["γ"], rel=1e-3)
    assert 3 * rotor.chord / (np.pi * rotor.radius) == pytest.approx(TABLE_2["σ"], abs=5e-4)


@pytest.mark.parametrize(("name", "rpm"), [*WRATS.items(), ("v22-fifth-scale", 755)])
def test_rotor_speed_is_that_of_the_name(cases, name, rpm):
    assert cases[name].operation.rotor_speed == pytest.approx(rpm * np.pi / 30, rel=1e-9)


@pytest.mark.parametrize("name", pp.list_cases())
def test_every_number_of_every_bundled_deck_says_where_it_comes_from(name):
    for path, number in pp.load_case(name).sources.items():
        assert number.status in STATUSES, path
        assert number.source.strip(), path


@pytest.mark.parametrize("name", MODELS)
def test_a_wing_that_is_not_at_hand_is_called_assumed(cases, name):
    case = cases[name]
    for mode in case.support.names:
        for quantity in ("frequency", "damping_ratio", "generalized_mass"):
            assert case.sources[f"support.modes[{mode}].{quantity}"].status == "assumed"
    assert "no prediction" in case.warnings[0]
    assert case.calibration.startswith("nothing of this model")


def misfit(rotor, flap, *left_out):
    """Least deviation of any non-negative mass from the integrals of the deck and Table 2, in half last digits."""
    from scipy.optimize import linprog

    lag = implied_offset(TABLE_2, "ζ")
    r = np.unique(np.concatenate([np.linspace(0, 3.8, 401), [flap, lag]]))
    of_flap, of_lag = np.maximum(r - flap, 0), np.maximum(r - lag, 0)
    arms = {
        "I_b": (r**2, TABLE_2["I_b"], 5e-4),
        "I_β": (of_flap**2, TABLE_2["I_β"], 5e-4),
        "I_βα": (r * of_flap, TABLE_2["I_βα"], 5e-4),  # printed with three digits, 0.200
        "I_ζ": (of_lag**2, TABLE_2["I_ζ"], 5e-4),
        "I_ζα": (r * of_lag, TABLE_2["I_ζα"], 5e-4),
        "S_β": (of_flap, TABLE_2["S_β"], 5e-5),
        "S_ζ": (of_lag, TABLE_2["S_ζ"], 5e-5),
        "m_b": (np.ones_like(r), rotor.blade_mass / SLUG, 5e-4),
        "S_b": (r, rotor.blade_first_moment / (SLUG * FT), 5e-4),
    }
    kept = [arms[name] for name in arms if name not in left_out]
    rows = np.array([arm * 0.01 / half for arm, _, half in kept])  # unknowns in 0.01 slug
    wanted = np.array([value / half for _, value, half in kept])
    slack = -np.ones((len(kept), 1))
    constraints = np.vstack([np.hstack([rows, slack]), np.hstack([-rows, slack])])
    cost = np.append(np.zeros(len(r)), 1.0)
    found = linprog(cost, A_ub=constraints, b_ub=np.concatenate([wanted, -wanted]), method="highs")
    assert found.status == 0
    return found.fun


def test_one_blade_has_the_integrals_of_the_deck_within_their_rounding(cases):
    rotor = cases["wrats-742-off"].rotor
    assert rotor.lag_hinge_offset / FT == pytest.approx(implied_offset(TABLE_2, "ζ"), abs=5e-4)
    assert misfit(rotor, rotor.flap_hinge_offset / FT, "I_βα") <= 1


@pytest.mark.parametrize("offset", [0.2, 0.207, 0.214, 0.221, 0.228, 0.235])
def test_no_blade_with_this_lag_hinge_has_all_integrals_as_the_deck_warns(cases, offset):
    rotor = cases["wrats-742-off"].rotor
    assert misfit(rotor, offset, "m_b", "S_b") > 1
    assert (misfit(rotor, offset, "m_b", "S_b", "I_βα") <= 1) == (0.2065 < offset < 0.2235)
    assert "no non-negative mass distribution" in cases["wrats-742-off"].warnings[1]


def test_the_downstop_stiffens_chord_and_torsion_alone(cases):
    frequency = {
        name: [cases[name].sources[f"support.modes[{m}].frequency"].si for m in cases[name].support.names]
        for name in WRATS
    }
    assert frequency["wrats-742-off"] == frequency["wrats-888-off"]
    assert frequency["wrats-770-on"] == frequency["wrats-888-on"]
    (beam, chord, torsion), (beam_on, chord_on, torsion_on) = (
        frequency[f"wrats-888-{stop}"] for stop in ("off", "on")
    )
    assert beam_on == beam and chord_on > chord and torsion_on > torsion
    # the ratios of the XV-15 on and off its downstop, NASA TM X-62,407
    assert chord_on / chord == pytest.approx(5.8 / 5.5, rel=0.01)
    assert torsion_on / torsion == pytest.approx(7.9 / 6.9, rel=0.01)


@pytest.mark.parametrize("name", MODELS)
def test_each_model_has_a_trim_and_a_stable_wing_at_low_speed(cases, name):
    model = cases[name].linearize(np.array([60.0, 120.0]) * 1852 / 3600, pitch="coupling")
    assert not any(model.trim.reason)
    for mass in np.linalg.eigvalsh((model.M + np.swapaxes(model.M, -1, -2)) / 2):
        assert mass.min() > 0
    assert model.modes().damping_ratio.min() > 0
