"""Print and write the audit of AIAA-2002-1604: all printed equations and tables against the derivation.

python -m derive.audit            print the table, write docs/audit.md; exit 1 if a verdict is not the recorded one
python -m derive.audit --accept   record the verdicts in tests/golden/audit.csv
python -m derive.audit --quick    without the boundaries of the XV-15, and without writing docs/audit.md
"""

from __future__ import annotations

import argparse
import csv
import functools
import io
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

import sympy as sp
from rich.console import Console
from rich.progress import track
from rich.table import Table

from derive.audit import consequences, invariants, printed
from derive.audit.comparison import ABSENT_FROM_PRINT, AFTER_READING, VERDICTS, EquationVerdict, audit
from derive.audit.consequences import in_knots
from derive.audit.counterparts import COUNTERPARTS
from derive.audit.headings import anchor, heading
from derive.audit.invariants import Finding
from derive.audit.printed.notation import latex_names
from derive.audit.tables import TableVerdict, audit_table
from derive.files import write_whole
from derive.published import DROPPED_TERMS

ROOT = Path(__file__).resolve().parents[2]
RECORD = ROOT / "tests" / "golden" / "audit.csv"
REPORT = ROOT / "docs" / "audit.md"
HEADER = ("number", "part", "term", "printed", "derived", "verdict", "note")
LETTERS = dict(
    zip(
        VERDICTS,
        ("reproduced", "after a reading", "absent from print", "absent from derivation", "contradict"),
        strict=True,
    )
)

_ADDENDS = 5  # of a sum in one line of a column

Row = tuple[str, ...]


@functools.cache
def equation_verdict(number: int | str) -> EquationVerdict:
    """Judge an equation, once."""
    return audit((printed.EQUATIONS | printed.NOMENCLATURE)[number])


@functools.cache
def equation_verdicts() -> dict[int | str, EquationVerdict]:
    """Return the verdicts on all equations by number."""
    return {number: equation_verdict(number) for number in (*printed.EQUATIONS, *printed.NOMENCLATURE)}


@functools.cache
def table_verdicts() -> dict[str, TableVerdict]:
    """Return the verdicts on both tables by heading."""
    return {f"Table {table.number}": audit_table(table) for table in printed.TABLES}


@functools.cache
def findings() -> tuple[Finding, ...]:
    """Return the findings of all invariants."""
    return tuple(invariants.findings())


@functools.cache
def broken_invariants() -> dict[int | str, list[Finding]]:
    """Return, by equation, the findings of the invariants that the print does not obey."""
    broken: dict[int | str, list[Finding]] = {}
    for finding in findings():
        if not finding.holds:
            broken.setdefault(finding.number, []).append(finding)
    return broken


def invariants_of(number: int | str) -> list[str]:
    """Return the names of the invariants that an equation or a table breaks."""
    if number in table_verdicts():
        return sorted({relation.invariant for relation in table_verdicts()[number].conflicts})
    return [finding.invariant for finding in broken_invariants().get(number, [])]


# Record


def recorded() -> list[Row]:
    """Return the rows of the record."""
    with RECORD.open(newline="", encoding="utf-8") as file:
        return [tuple(row) for row in csv.reader(file)][1:]


def computed() -> list[Row]:
    """Return a row for each term of an equation and for each relation of a table."""
    rows: list[Row] = []
    for number, result in equation_verdicts().items():
        for t in sorted(result.terms, key=lambda t: (list(result.equation.parts).index(t.part), str(t.term))):
            rows.append((str(number), t.part, str(t.term), str(t.printed), str(t.derived), t.verdict, t.note))
    for name, table in table_verdicts().items():
        rows += [(name, r.name, ", ".join(r.values), "", "", r.verdict, r.invariant) for r in table.relations]
    return rows


def record(rows: list[Row]) -> None:
    """Write the record tests/golden/audit.csv."""
    RECORD.parent.mkdir(parents=True, exist_ok=True)
    text = io.StringIO(newline="")
    csv.writer(text, lineterminator="\n").writerows([HEADER, *rows])
    write_whole(RECORD, text.getvalue())


def changes(was: list[Row], now: list[Row]) -> list[str]:
    """Return the rows that are gone, then the new ones, in the order of the equations."""
    gone = [f"- {', '.join(row)}" for row in was if row not in set(now)]
    return gone + [f"+ {', '.join(row)}" for row in now if row not in set(was)]


# Report


def summary(boundaries: Callable[[int | str], str]) -> Iterator[tuple[str, ...]]:
    """Yield equation, title, verdict, terms, broken invariants and consequence."""
    for number, result in equation_verdicts().items():
        counts = "; ".join(f"{result.count(v)} {LETTERS[v]}" for v in VERDICTS if result.count(v))
        broken = ", ".join(invariants_of(number))
        yield (str(number), result.equation.title, result.verdict, counts, broken, boundaries(number))
    for name, table in table_verdicts().items():
        counts = f"{len(table.relations)} relations; {len(table.conflicts)} contradict"
        yield (
            name,
            table.table.title,
            table.verdict,
            counts,
            ", ".join(invariants_of(name)),
            boundaries(name),
        )


def dropped_terms_of(result: EquationVerdict) -> list[str]:
    """Return the names of the dropped terms that explain what the print does not have."""
    names = {name for term in result.terms for name in term.note.split(", ") if name in DROPPED_TERMS}
    return [name for name in DROPPED_TERMS if name in names]


@functools.cache
def consequence_of_conflict(number: int | str) -> str:
    """Return the boundary of the XV-15 with a conflict as printed; empty for an equation without conflict."""
    if number not in consequences.OF_CONFLICT:
        return ""
    label, changed, base = consequences.OF_CONFLICT[number]()
    return f"{label}: {in_knots(changed)} instead of {in_knots(base)}"


@functools.cache
def _consequences() -> dict[int | str, str]:
    """Return the boundary of the XV-15 with each conflict as printed, and without each absent term."""
    found = {number: consequence_of_conflict(number) for number in consequences.OF_CONFLICT}
    names = {name for result in equation_verdicts().values() for name in dropped_terms_of(result)}
    for name in track(sorted(names), description="boundaries without a term"):
        found[name] = f"{in_knots(consequences.without(name))} instead of {in_knots(consequences.base())}"
    return found


def consequence(number: int | str) -> str:
    """Return what the conflict and the absent terms of an equation do to the boundary of the XV-15."""
    parts = [_consequences()[number]] if number in _consequences() else []
    if number in equation_verdicts():
        terms = dropped_terms_of(equation_verdicts()[number])
        parts += [f"without {name}: {_consequences()[name].partition(' instead')[0]}" for name in terms]
    return "; ".join(parts)


def markdown() -> str:
    """Return the report as Markdown."""
    lines = [
        "# AIAA-2002-1604 against the derivation",
        "",
        "Written by `python -m derive.audit`; every verdict is computed. A term is a product of coordinates,",
        "harmonics and parameters of the expanded equation. The derivation is taken to the paper's own order: first",
        "order in the cone, no trim lag in the blade's position. Boundaries are the XV-15's,",
        f"{in_knots(consequences.base())} with the consistent equations; several inputs of that deck are assumed or",
        "recalled, so differences matter here, not the boundary itself.",
        "",
        *_markdown_table(
            ("", "what", "verdict", "terms", "invariant broken", "XV-15 boundary", "derived by"),
            ((*row, _derived_by(row[0])) for row in summary(consequence)),
        ),
        "",
        "## Conflicts",
        "",
        *_conflicts(),
        "",
        "## Terms the print does not have",
        "",
        *_absences(),
        "",
        "## The gimbal in Eq. 3",
        "",
        *_gimbal(),
        "",
        "## Tables",
        "",
        *_tables(),
        "",
        "## Readings and doubts",
        "",
        *_doubts(),
        "",
        "## Invariants",
        "",
        *_invariants(),
    ]
    return "\n".join(lines) + "\n"


def _markdown_table(header: Sequence[str], rows: Iterable[Iterable[object]]) -> list[str]:
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return lines + ["| " + " | ".join(str(cell).replace("|", r"\|") for cell in row) + " |" for row in rows]


def _derived_by(number: str) -> str:
    """Return the name of the counterpart, without its module, with a link to its place in the index of equations."""
    known = {str(key): key for key in COUNTERPARTS}
    name = "audit_table"
    if number in known:
        function = COUNTERPARTS[known[number]]
        name = getattr(function, "func", function).__name__
    return f"[`{name}`](equations.md#{anchor(heading(known.get(number, number)))})"


def _math(expression: sp.Expr) -> str:
    return f"${sp.latex(expression, symbol_names=latex_names())}$"


def _sum_in_lines(expression: sp.Expr) -> str:
    """Write a long sum in lines that fit a column."""
    addends = expression.as_ordered_terms()
    lines = [
        sp.Add(*addends[first : first + _ADDENDS], evaluate=False)
        for first in range(0, len(addends), _ADDENDS)
    ]
    first, *rest = map(_math, lines)
    return "<br>".join([first, *(line if line.startswith("$-") else f"$+{line[1:]}" for line in rest)])


def _conflicts() -> list[str]:
    rows = []
    for number, result in equation_verdicts().items():
        for term in result.conflicts:
            breaks = ", ".join(invariants_of(number)) or "none"
            rows.append((number, _math(term.printed * term.term), _math(term.derived * term.term), breaks))
    return _markdown_table(("equation", "printed", "derived", "breaks"), rows)


def _absences() -> list[str]:
    rows = []
    for number, result in equation_verdicts().items():
        for note in dict.fromkeys(term.note for term in result.of(ABSENT_FROM_PRINT)):
            terms = [t for t in result.of(ABSENT_FROM_PRINT) if t.note == note]
            for part in dict.fromkeys(t.part for t in terms):
                total = sp.Add(*(t.derived * t.term for t in terms if t.part == part))
                rows.append((number, part, _sum_in_lines(sp.factor(total)), note or "see Conflicts"))
    return _markdown_table(("equation", "part", "derived", "dropped term"), rows)


def _gimbal() -> list[str]:
    tilt = consequences.steady_tilt()
    alone, both = tilt["Coriolis term alone"], tilt["rigid yoke"]
    rest = invariants.rigid_tilt_rest(printed.EQUATIONS[11], invariants.coriolis_of_gimbal())[0]
    return [
        "Eq. 3 has the Coriolis term of blade flapping and none of the gimbal's. Alone, that term would accelerate",
        "the blade in-plane under a steady tilt, which moves nothing relative to the tilted yoke:",
        f"{alone:.2f} m/s² at the XV-15's tip per degree. The rigid yoke rolls about the blade's radius too, and with",
        f"both terms the same is {both:.2f} m/s². Without the derivation: a hub tilted with the gimbal tilted back",
        "leaves every mass where it was. Eq. 11 as printed obeys that; with the Coriolis term alone there is left,",
        f"along i, {_math(sp.factor(rest))}.",
        "",
        *_markdown_table(
            ("equations", "XV-15 boundary"),
            ((label, in_knots(value)) for label, value in consequences.gimbal_question().items()),
        ),
    ]


def _tables() -> list[str]:
    rows = [
        (name, relation.name, relation.verdict, relation.evidence)
        for name, result in table_verdicts().items()
        for relation in result.relations
    ]
    return [
        "A blade is any non-negative mass along the radius, hinge offsets on a grid of R/160 and, where no blade is",
        "found there, from its best point on; deviations are in half units of the last printed digit.",
        "",
        *_markdown_table(("", "relation", "verdict", "evidence"), rows),
    ]


def _doubts() -> list[str]:
    rows = []
    for number, result in equation_verdicts().items():
        notes = dict.fromkeys(term.note for term in result.of(AFTER_READING))
        if notes or result.equation.doubt:
            rows.append((number, "; ".join(notes), result.equation.doubt))
    rows += [(name, "", result.table.doubt) for name, result in table_verdicts().items()]
    return _markdown_table(("", "readings used", "doubt"), rows)


def _invariants() -> list[str]:
    by_name: dict[str, list[Finding]] = {}
    for finding in findings():
        by_name.setdefault(finding.invariant, []).append(finding)
    rows = []
    for name, found in by_name.items():
        broken = "; ".join(f"{f.number}: {f.evidence}" for f in found if not f.holds)
        rows.append((name, len(found), broken or "-"))
    return _markdown_table(("invariant", "equations checked", "broken by"), rows)


def _print_summary(boundaries: Callable[[int | str], str]) -> None:
    table = Table(
        "",
        "what",
        "verdict",
        "terms",
        "invariant broken",
        "XV-15 boundary",
        title="AIAA-2002-1604 against the derivation",
    )
    for row in summary(boundaries):
        table.add_row(*row)
    Console(width=180).print(table)


def main(arguments: list[str] | None = None) -> int:
    """Run the command; return 1 if a verdict is not the recorded one."""
    parser = argparse.ArgumentParser(
        prog="python -m derive.audit",
        description="Print every equation's verdict; exit 1 if one is not the recorded one.",
    )
    parser.add_argument("--accept", action="store_true", help="record the verdicts as they are")
    parser.add_argument("--quick", action="store_true", help="leave out the boundaries and docs/audit.md")
    options = parser.parse_args(arguments)
    for number in track([*printed.EQUATIONS, *printed.NOMENCLATURE], description="equations"):
        equation_verdict(number)  # the derivation is slow and the verdict is cached
    _print_summary((lambda number: "") if options.quick else consequence)
    now = computed()
    if options.accept:
        record(now)
    if not options.quick:
        write_whole(REPORT, markdown())
        print(f"written: {REPORT.relative_to(ROOT)}")
    found = changes(recorded() if RECORD.exists() else [], now)
    print("\n".join(found) if found else f"{len(now)} verdicts, all as recorded")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
