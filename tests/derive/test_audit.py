"""The audit judges every printed equation by computation, and a changed print changes its verdict."""

import csv
import re
from dataclasses import replace

import pytest
import sympy as sp

from derive.audit import consequences, invariants, printed, report
from derive.audit.comparison import READINGS, VERDICTS, EquationVerdict
from derive.audit.comparison import audit as judge
from derive.published import DROPPED_TERMS
from proprotor.errors import InputError

MUTATIONS = {"sign": -1, "factor": 2}


def outcome(result: EquationVerdict) -> set[tuple]:
    return {(t.part, t.term, t.printed, t.derived, t.verdict, t.note) for t in result.terms}


def conflicts(result: EquationVerdict) -> set[tuple]:
    return {(t.part, t.term, t.printed, t.derived) for t in result.conflicts}


def mutants(equation: printed.PrintedEquation):
    """The equation with one term of the print changed, for each term and each way to change it."""
    for part, expression in equation.parts.items():
        for addend in sp.Add.make_args(sp.expand(expression)):
            for name, factor in MUTATIONS.items():
                changed = sp.expand(expression) + (factor - 1) * addend
                yield (
                    f"{name} of {addend} in {part}",
                    replace(equation, parts=equation.parts | {part: changed}),
                )


def test_every_equation_and_table_has_a_computed_verdict():
    assert sorted(printed.EQUATIONS) == list(range(1, 38))
    verdicts = report.equation_verdicts()
    assert all(result.terms and result.verdict in VERDICTS for result in verdicts.values())
    assert set(verdicts) == set(printed.EQUATIONS) | set(printed.NOMENCLATURE)
    tables = report.table_verdicts()
    assert set(tables) == {"Table 1", "Table 2"}
    for result in tables.values():
        assert {value for relation in result.relations for value in relation.values} == set(
            result.table.values
        )


def test_verdicts_are_the_recorded_ones():
    found = report.changes(report.recorded(), report.computed())
    assert not found, "`python -m derive.audit --accept` records these:\n" + "\n".join(found)


@pytest.mark.parametrize("number", sorted(printed.EQUATIONS))
def test_every_changed_term_changes_the_verdict(number):
    equation, was = printed.EQUATIONS[number], report.equation_verdicts()[number]
    sense_is_open = [
        symbol
        for name in equation.readings
        for symbol in READINGS[name]
        if -symbol in READINGS[name].values()
    ]
    for label, mutant in mutants(equation):
        now = judge(mutant)
        assert outcome(now) != outcome(was), label
        if not any(str(symbol) in label for symbol in sense_is_open):
            assert conflicts(now) != conflicts(was), label


def test_a_sign_that_only_a_reading_explains_is_judged_by_that_reading():
    """The positive sense of the airload moment in Eq. 32 is not given: either sign agrees, by different readings."""
    was = report.equation_verdicts()[32]
    (flipped,) = (m for label, m in mutants(was.equation) if label.startswith("sign of dM_theta_aero"))
    (doubled,) = (m for label, m in mutants(was.equation) if label.startswith("factor of dM_theta_aero"))
    assert not judge(flipped).conflicts and outcome(judge(flipped)) != outcome(was)
    assert judge(doubled).conflicts


def test_what_contradicts_the_derivation_breaks_an_invariant_and_nothing_else_does():
    by_derivation = {number for number, result in report.equation_verdicts().items() if result.conflicts}
    assert by_derivation == set(report.broken_invariants()) == {13, 35, "ν_β", "ν_ζ"}


def test_what_is_absent_is_a_named_dropped_term():
    for number in printed.EQUATIONS:
        for term in report.equation_verdicts()[number].terms:
            if term.printed == 0:
                assert term.note and all(name in DROPPED_TERMS for name in term.note.split(", ")), (
                    number,
                    term,
                )


@pytest.mark.parametrize(
    "number, part, term",
    [(13, "inertia and springs", "zeta_prime"), (11, "j", "zeta_dot"), (11, "i", "beta_dot")],
)
def test_skewness_sees_the_coriolis_pair(number, part, term):
    """Turning one sign of the pair breaks what held, or mends what was broken, without the derivation."""
    equation = printed.EQUATIONS[number]
    terms = sp.expand(equation.parts[part])
    turned = sp.Add(*(-t if t.has(sp.Symbol(term, real=True)) else t for t in sp.Add.make_args(terms)))
    changed = printed.EQUATIONS | {number: replace(equation, parts=equation.parts | {part: turned})}
    was = [finding.holds for finding in invariants.skewness(printed.EQUATIONS)]
    assert [finding.holds for finding in invariants.skewness(changed)] != was


def test_the_gimbals_coriolis_term_alone_is_no_motion_of_a_rigid_yoke():
    assert not any(invariants.rigid_tilt_rest(printed.EQUATIONS[11]))
    assert any(invariants.rigid_tilt_rest(printed.EQUATIONS[11], invariants.coriolis_of_gimbal()))
    tilt = consequences.steady_tilt()
    assert tilt["rigid yoke"] == pytest.approx(0, abs=1e-12)
    assert abs(tilt["Coriolis term alone"]) > 1


def test_i_beta_alpha_of_table_1_is_the_integral_no_blade_has():
    one, two = (report.table_verdicts()[name] for name in ("Table 1", "Table 2"))
    assert not two.conflicts
    alone = [r.values for r in one.conflicts if r.name.startswith("the misfit is not due to")]
    assert alone == [("I_βα",)]


def test_the_printed_i_beta_alpha_is_refused_by_the_rotor_and_moves_the_boundary():
    rotor = consequences.xv15().rotor
    printed_value = printed.TABLES[0].values["I_βα"] * consequences.SLUG_FT2
    offset = (printed_value - rotor.flap_inertia) / rotor.flap_first_moment
    with pytest.raises(InputError, match="I_βα"):
        replace(rotor, flap_hinge_offset=offset, lag_hinge_offset=offset)
    case = consequences.with_flap_hub_inertia(printed_value)
    assert case.rotor.flap_hub_inertia == printed_value
    assert rotor.flap_hub_inertia < printed_value
    assert abs(consequences.boundary(case) - consequences.base()) > 1


def test_a_changed_verdict_is_reported_and_can_be_recorded(tmp_path, monkeypatch, capsys):
    record = tmp_path / "audit.csv"
    monkeypatch.setattr(report, "RECORD", record)
    rows = report.computed()
    report.record([(*rows[0][:-2], "contradicts", ""), *rows[1:]])
    assert report.main(["--quick"]) == 1
    assert "- 1, β_G" in capsys.readouterr().out
    assert report.main(["--quick", "--accept"]) == 0
    with record.open(newline="", encoding="utf-8") as file:
        assert len(list(csv.reader(file))) == len(rows) + 1


def test_the_report_has_the_verdicts():
    page = report.REPORT.read_text(encoding="utf-8")
    for number, title, verdict, terms, *_ in report.summary(lambda number: ""):
        assert f"| {number} | {title} | {verdict} | {terms} |" in page


KNOTS = re.compile(r"(none below )?[0-9.]+ kt|none$", re.MULTILINE)


@pytest.fixture
def any_boundary(monkeypatch):
    """Boundaries without their sweeps, which the last notebook compares with its page."""
    for name in ("base", "boundary", "without", "published_with"):
        monkeypatch.setattr(consequences, name, lambda *of, **options: 300.0)
    kept = report.consequence_of_conflict, report._consequences
    for cached in kept:
        cached.cache_clear()
    yield
    for cached in kept:
        cached.cache_clear()


def test_the_report_is_what_the_audit_writes(tmp_path, monkeypatch, capsys, any_boundary):
    """All of it but the boundaries, and the table on the terminal has them too."""
    page = report.REPORT.read_text(encoding="utf-8")
    monkeypatch.setattr(report, "ROOT", tmp_path)
    monkeypatch.setattr(report, "REPORT", tmp_path / "audit.md")
    assert report.main([]) == 0
    written = report.REPORT.read_text(encoding="utf-8")
    assert KNOTS.sub("kt", written) == KNOTS.sub("kt", page), "`make audit` writes the report anew"
    shown = capsys.readouterr().out
    assert "written: audit.md" in shown and "verdicts, all as recorded" in shown
    assert shown.count("300.0 kt") >= 2 * len(consequences.OF_CONFLICT)  # as printed, instead of derived
