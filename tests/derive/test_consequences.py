"""What the audit's variants of the equations are made of, and the digits the tables are printed with."""

import inspect

import numpy as np
import pytest
from proprotor_equations import BLADE_COORDINATES

from derive.audit import consequences, printed, tables
from derive.equations import REDUCED_MODULES
from derive.published import DROPPED_TERMS, PUBLISHED
from proprotor.rotor.options import Options


@pytest.mark.parametrize("term", [name for name, term in DROPPED_TERMS.items() if not term.option])
def test_a_module_that_a_term_does_not_reach_does_not_name_it(term):
    """The derivation of a module names the terms it can lose, in its own source or in that of the kinematics."""
    reached = consequences.reached_by(term)
    assert reached
    for module in REDUCED_MODULES:
        source = inspect.getsource(__import__(f"derive.{module}", fromlist=["derive"]))
        if f'"{term}"' in source:
            assert module in reached
        elif term != "yoke_roll":  # asked for by the kinematics, which all modules use
            assert module not in reached


@pytest.mark.parametrize("name", [name for name, term in DROPPED_TERMS.items() if term.option])
def test_a_term_that_an_option_drops_reaches_no_module_and_is_off_in_the_published_set_alone(name):
    assert not consequences.reached_by(name)
    option = DROPPED_TERMS[name].option
    assert getattr(Options(), option) is True
    assert getattr(Options(equations="published"), option) is False
    assert consequences.AS_THE_PAPER[option] is False


def test_yoke_roll_reaches_every_module_that_has_the_gimbal():
    assert set(consequences.reached_by("yoke_roll")) == set(REDUCED_MODULES)


def test_with_all_terms_dropped_a_variant_is_the_published_set():
    """The module derived again and the one checked in are the same function."""
    made = consequences.equations_without(PUBLISHED, "consistent", frozenset({"propeller_moment"})).pitch
    checked_in = consequences.equation_set("published").pitch
    quantities = {
        name: 0.1 + 0.37 * place
        for place, name in enumerate(inspect.signature(checked_in.stiffness).parameters)
    }
    assert inspect.signature(made.stiffness) == inspect.signature(checked_in.stiffness)
    np.testing.assert_array_equal(made.stiffness(**quantities), checked_in.stiffness(**quantities))


def test_a_term_that_nobody_drops_is_told():
    with pytest.raises(ValueError, match="no such term: weight; known: "):
        consequences.consistent_but("weight")


def test_the_modules_of_a_set_are_those_that_its_name_stands_for():
    for equations in ("consistent", "published"):
        assert consequences.equation_set(equations) == Options(equations=equations).equation_set


def test_eq_13_as_printed_turns_one_entry_of_the_gyroscopic_matrix_round():
    changed, derived = (
        of("published").inertia.gyroscopic
        for of in (consequences.with_printed_coriolis_sign, consequences.equation_set)
    )
    quantities = {
        name: 0.2 + 0.31 * place for place, name in enumerate(inspect.signature(derived).parameters)
    }
    sign = np.ones_like(derived(**quantities))
    sign[BLADE_COORDINATES.index("flap"), BLADE_COORDINATES.index("lag")] = -1
    assert np.count_nonzero(derived(**quantities) * (sign == -1)) == 1
    np.testing.assert_array_equal(changed(**quantities), sign * derived(**quantities))


def test_the_couplings_turned_round_are_those_of_the_model_with_the_other_sign():
    """Given values in place of the closed form: the same values make the same model, the opposite ones the turned."""
    case, options = consequences.xv15(), {"pitch": "coupling"}
    model = case.linearize(150.0, **options)
    flap, lag = consequences.couplings(model)
    given = case.linearize(150.0, **options, pitch_flap_coupling=flap, pitch_lag_coupling=lag)
    opposite = case.linearize(150.0, **options, pitch_flap_coupling=-flap, pitch_lag_coupling=-lag)
    turned = consequences.couplings_turned().linearize(150.0, **options)
    np.testing.assert_allclose(given.K, model.K, rtol=1e-12)
    np.testing.assert_array_equal(turned.K, opposite.K)
    assert not np.allclose(turned.K, model.K)


def test_boundaries_are_told_by_mode():
    modes = consequences.modes_of()
    of = consequences.boundaries(modes)
    assert consequences.lowest(of) == min(of.values()) == consequences.boundary()
    name = min(of, key=of.get)
    damping = modes.damping_ratio.sel(branch=name)
    speeds = consequences.SPEEDS / consequences.KNOT
    assert float(damping[speeds <= of[name]].min()) > 0 > float(damping[speeds > of[name]][0])
    assert np.isnan(consequences.lowest({})) and consequences.in_knots(np.nan) == "none below 520 kt"


def test_the_printed_i_beta_alpha_makes_a_mode_that_grows_at_every_speed():
    printed_value = printed.TABLES[0].values["I_βα"] * consequences.SLUG_FT2
    case = consequences.with_flap_hub_inertia(printed_value)
    assert np.linalg.eigvalsh(case.linearize(120.0).M)[0] < 0
    assert np.linalg.eigvalsh(consequences.xv15().linearize(120.0).M)[0] > 0
    assert (
        consequences.least_damping_at_best(case)
        < -0.5
        < 0
        < consequences.least_damping_at_best(consequences.xv15())
    )


def test_a_steady_tilt_shakes_the_blade_once_per_revolution_with_half_of_the_pair():
    """2 Omega r cone beta_G' with beta_G' = Omega beta_GS cos psi, worked out by hand, against the derivation."""
    rotor, speed = consequences.xv15().rotor, consequences.xv15().operation.rotor_speed
    amplitude = 2 * speed**2 * rotor.radius * rotor.precone * np.radians(1)
    for azimuth in (0.0, 1.1, 2.5):
        tilt = consequences.steady_tilt(azimuth)
        assert tilt["Coriolis term alone"] == pytest.approx(amplitude * np.cos(azimuth))
        assert tilt["roll of the yoke alone"] == pytest.approx(-amplitude * np.cos(azimuth))
        assert tilt["rigid yoke"] == pytest.approx(0, abs=1e-12)


def test_a_printed_number_keeps_its_digits():
    """0.200 is known to a thousandth, 0.2 to a tenth."""
    model = printed.TABLES[1].values
    assert tables.rounding(model["I_βα"]) == pytest.approx(0.0005)
    assert tables.rounding(model["S_β"]) == pytest.approx(0.00005)
    assert tables.rounding(model["R_β"]) == pytest.approx(0.005)
    assert tables.rounding(printed.TABLES[0].values["I_b"]) == pytest.approx(0.5)


def test_the_search_for_a_blade_does_not_stop_at_the_grid():
    """Table 2: on the grid no blade is within the printed digits, beside it one is."""
    v = printed.TABLES[1].values
    least, flap, lag = tables.nearest_blade(v, tables.INTEGRALS)
    assert least <= 1
    assert tables.misfit(v, tables.INTEGRALS, flap[0], lag[0]) == pytest.approx(least)
    grid = np.linspace(0.19, 0.26, 8)
    implied = tables.implied_offset(v, "ζ")
    assert min(tables.misfit(v, tables.INTEGRALS, offset, implied) for offset in grid) > 1


@pytest.mark.parametrize("options", [{}, {"equations": "published"}, {"pitch": "coupling"}])
def test_the_lowest_boundary_is_that_of_the_search_which_follows_each_root(options):
    found = consequences.xv15().flutter_point(consequences.SPEEDS, **consequences.AS_THE_PAPER | options)
    first = min(one.position for one in found.boundaries if one.onset)
    assert consequences.boundary(**options) * consequences.KNOT == pytest.approx(first, abs=0.1)


def test_motion_that_is_handed_from_root_to_root_is_no_boundary():
    case = consequences.with_flap_hub_inertia(printed.TABLES[0].values["I_βα"] * consequences.SLUG_FT2)
    damping = case.sweep(consequences.SPEEDS, **consequences.AS_THE_PAPER).damping_ratio.values
    first = np.searchsorted(consequences.SPEEDS / consequences.KNOT, consequences.boundary(case)) - 1
    unstable = (damping < 0).sum(axis=1)
    assert unstable[first + 1] > unstable[first] and (np.diff(unstable[: first + 1]) <= 0).all()
