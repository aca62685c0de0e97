"""The generated equations entry by entry, and a sample of mutants of them; `make mutate` takes every one.

Tolerances stand in `tests.mutation.comparison`.
"""

import dataclasses
import functools
import re
from pathlib import Path

import numpy as np
import pytest
from proprotor_equations import inertia, pitch

import proprotor as pp
from tests.mutation import __main__ as command_line
from tests.mutation import one_blade, paper_blade, survey
from tests.mutation.checks import all_checks, checks_of
from tests.mutation.comparison import Check
from tests.mutation.inputs import points
from tests.mutation.mutants import Mutant, MutatedFunction, generated_functions, generated_modules
from tests.mutation.report import report
from tests.mutation.survey import Outcome, mutant_counts, outcomes_of

PAGE = Path(__file__).parents[2] / "docs" / "mutation.md"
EVERY = 40  # of the mutants of a function


# The equations


def test_every_entry_is_what_other_sources_give():
    wrong = {(*check.sees, check.told): check.excess() for check in all_checks() if not check.excess() <= 1}
    assert wrong == {}


def test_every_generated_function_is_checked():
    assert all(checks_of(names) for names in generated_functions())


OPTIONS = (
    {"section_damping": True, "drive_train": pp.DriveTrain(drive_inertia=20.0), "reactionless": True},
    {"pitch": "coupling"},
    {"airloads": "none"},
    {"lift": "lagged"},
    {"inflow": "dynamic"},
    {"shaft_angle": 0.02},
    {
        "structure": "tabulated",
        "frequencies": pp.BladeFrequencies(at_rotor_speed=40.0, flap=1.1, lag=1.6, cyclic_flap=1.3),
    },
    {"equations": "published"},
    {"equations": "published", "airloads": "lift-slope", "compressibility": False},
)


# What the model does not call: it takes the same from the fused functions, which tests/derive/test_fused.py compares.
FOR_USE_ALONE = {("rotor", "matrices")}


def test_every_generated_function_is_of_the_model(monkeypatch):
    """What is checked is what runs: the model finds each where a mutant is put."""
    called = set()

    def counted(names, function):
        @functools.wraps(function)
        def counting(*arguments, **keywords):
            called.add(names)
            return function(*arguments, **keywords)

        return counting

    for names in generated_functions():
        module, name = generated_modules()[names[0]], names[1]
        monkeypatch.setattr(module, name, counted(names, getattr(module, name)))
    case = pp.load_case("xv15-uncoupled")
    airfoil = dataclasses.replace(case.rotor.airfoil, moment=-0.02)
    for n_blades in (4, 5):
        rotor = dataclasses.replace(case.rotor, n_blades=n_blades, airfoil=airfoil)
        for options in OPTIONS:
            model = pp.rotor_model(rotor, case.operation, 100.0, **options)
            assert model.trim.converged
    masses = {entry.name: 1e-3 for entry in dataclasses.fields(pp.OffsetMass)}
    beside = dataclasses.replace(
        case.rotor, airfoil=airfoil, offset_mass=pp.OffsetMass(**masses), aerodynamic_center=0.01
    )
    for options in ({}, {"pitch": "coupling"}, {"lift": "lagged"}, {"equations": "published"}):
        assert pp.rotor_model(beside, case.operation, [100.0, 110.0], **options).trim.converged.all()
    angles = np.linspace(-0.6, 0.6, 25)[:, None]
    table = pp.AirfoilTable(
        alpha=angles[:, 0], mach=[0.0], lift=5.7 * angles, drag=0.01 + angles**2, moment=0 * angles
    )
    pp.rotor_model(dataclasses.replace(beside, airfoil=table), case.operation, 100.0)
    soft = dataclasses.replace(case.rotor, control_stiffness=case.rotor.control_stiffness / 50)
    pp.rotor_model(soft, case.operation, 10.0)  # a trim that starts by a search for the rigid blade's pitch
    pp.load_case("xv15-wing")
    ones = dict.fromkeys(
        ("mass_per_length", "flatwise_stiffness", "edgewise_stiffness", "torsion_stiffness", "chord"),
        np.ones(3),
    )
    blade = pp.BladeStations(
        radius=np.linspace(0, 1, 3), twist=np.linspace(0.3, 0, 3), control_stiffness=1.0, **ones
    )
    pp.Rotor.from_stations(blade, rotor_speed=1.0, pitch=[0.1, 0.2, 0.3], n_blades=3, airfoil=airfoil)
    assert set(generated_functions()) - called == FOR_USE_ALONE


def test_two_roads_to_the_inertia_of_a_blade():
    """The kinematics that the published equations are checked by, with nothing left out, beside accelerations."""
    for point in points():
        roads = one_blade.mass_matrices(point), paper_blade.consistent_mass_matrices(point)
        for accelerations, kinematics in zip(*roads, strict=True):
            assert np.abs(accelerations - kinematics).max() < 1e-14 * np.abs(accelerations).max()


# The mutants


def test_a_sample_of_mutants_is_detected():
    survivors = []
    for names, count in mutant_counts().items():
        places = range(min(EVERY, count) // 2, count, EVERY)
        outcomes = outcomes_of(*names, places)
        assert len(outcomes) == len(places)
        survivors += [str(outcome.mutant) for outcome in outcomes if not outcome.detected]
    assert survivors == []


def test_what_the_mutants_of_an_entry_are():
    found = [m for m in MutatedFunction("pitch", "mass").mutants() if m.entry == "[..., PITCH, PITCH]"]
    assert [m.change for m in found] == ["sign flipped", "dropped", "times 1.01"]
    assert {m.expression for m in found} == {"pitch_inertia"}


def test_what_the_mutants_of_a_sum_do():
    """I_βα = S_β e_β + I_β with S_β = 3, e_β = 5 and I_β = 7: the whole and each term."""
    given = dict.fromkeys(("lag_hinge_offset", "lag_first_moment", "lag_inertia"), 1.0)
    given |= {"flap_first_moment": 3.0, "flap_hinge_offset": 5.0, "flap_inertia": 7.0}
    values = {}
    with MutatedFunction("inertia", "dependent_inertias").each(range(9)) as mutants:
        for mutant in mutants:
            value = inertia.dependent_inertias(**given).flap_hub_inertia
            values.setdefault(mutant.expression, []).append(value)
    expected = {
        "flap_first_moment * flap_hinge_offset + flap_inertia": [-22.0, 0.0, 1.01 * 22],
        "flap_first_moment * flap_hinge_offset": [-8.0, 7.0, 1.01 * 15 + 7],
        "flap_inertia": [8.0, 15.0, 15 + 1.01 * 7],
    }
    assert values.keys() == expected.keys()
    for name, numbers in expected.items():
        assert np.allclose(values[name], numbers, rtol=1e-15), name


def test_every_term_of_every_sum_has_its_turn():
    """cos ζ − 1 inside a product inside a sum."""
    found = {
        m.expression
        for m in MutatedFunction("inertia", "trim_integrals").mutants()
        if m.entry == "flap_moment"
    }
    whole = "flap_first_moment + lag_first_moment * (cos_lag - 1)"
    assert found == {whole, "flap_first_moment", "lag_first_moment * (cos_lag - 1)", "cos_lag", "1"}


def test_nothing_is_left_of_a_mutant():
    original = pitch.mass
    with pytest.raises(ZeroDivisionError), MutatedFunction("pitch", "mass").each(range(3)) as mutants:
        next(mutants)
        assert pitch.mass is not original
        raise ZeroDivisionError
    assert pitch.mass is original


@pytest.mark.parametrize("value", [np.nan, np.inf, 1.0 + 2e-10, 0.0, -1.0])
def test_what_a_check_sees(value):
    check = Check(
        ("", ""), "", lambda: {"entry": np.array([1.0, value])}, {"entry": np.ones(2)}, {"entry": 0.0}
    )
    assert check.excess() > 1


def test_a_check_lets_rounding_pass():
    entries = np.array([1e6, 1e-6])
    actual, expected = {"entry": entries * (1 + 1e-12)}, {"entry": entries}
    assert Check(("", ""), "", lambda: actual, expected, {"entry": 0.0}).excess() < 0.1


def test_what_breaks_down_is_seen():
    def broken():
        raise ValueError

    assert Check(("", ""), "", broken, {}, {}).excess() == np.inf


# The report


def outcome(excess, line=1):
    return Outcome(Mutant("trim", "jacobian", line, "[..., LAG, LAG]", "lag", "dropped"), excess, 0.002)


def test_the_report_names_survivors():
    page = report([outcome(1e4), outcome(0.5, line=77), outcome(np.inf)], 12.3, 2)
    assert "**3 mutants, 2 detected, 1 survivors**, in 12 s on 2 processes." in page
    assert "| `trim` | 3 | 2 | 1 | 1.0e+04 | 2 |" in page
    assert page.endswith("## Survivors\n\n- `trim.jacobian`, line 77, `[..., LAG, LAG]`: `lag` dropped\n")


def test_a_mutant_that_nothing_checks_survives(monkeypatch):
    monkeypatch.setattr(survey, "checks_of", lambda names: [])
    assert [o.detected for o in outcomes_of("pitch", "mass", range(2))] == [False, False]


@pytest.mark.parametrize(("excess", "code"), [(5.0, 0), (0.5, 1)])
def test_the_command_fails_where_something_survives(excess, code, monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(command_line, "survey", lambda processes, told: [outcome(excess), outcome(9.0)])
    page = tmp_path / "mutation.md"
    monkeypatch.setattr("sys.argv", ["mutation", "--report", str(page)])
    assert command_line.main() == code
    assert page.read_text(encoding="utf-8").endswith(capsys.readouterr().out[-40:-1])


def test_a_survey_refuses_checks_that_fail_without_a_mutant(monkeypatch):
    wrong = Check(("trim", "residual"), "", lambda: {"r": 1.0}, {"r": 2.0}, {"r": 0.0})
    monkeypatch.setattr(survey, "all_checks", lambda: (*all_checks()[:1], wrong))
    with pytest.raises(ValueError, match=r"^no mutant, and yet wrong: trim\.residual$"):
        survey.survey()


def test_the_page_is_of_these_equations():
    """`make mutate` writes it."""
    told = re.search(r"\*\*(\d+) mutants, (\d+) detected, 0 survivors\*\*", PAGE.read_text(encoding="utf-8"))
    assert told, "survivors"
    assert {int(number) for number in told.groups()} == {sum(mutant_counts().values())}
