"""The content of a report: the findings in sentences, tables and pictures."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from importlib.metadata import version
from itertools import groupby
from typing import Any

import numpy as np

from proprotor.case import Case
from proprotor.datum import Datum
from proprotor.deck.written import FilePath
from proprotor.errors import as_toml
from proprotor.model.deck_fingerprint import deck_fingerprint
from proprotor.model.doubts import MARK, doubt_at, footnotes, marked
from proprotor.model.options_in_force import chosen, option_text, options_in_result
from proprotor.model.provenance import doubtful_inputs, reservations
from proprotor.report import pictures
from proprotor.report.analyses import Findings
from proprotor.report.document import Document, Section, Table, Text
from proprotor.report.summary import summary, verdict
from proprotor.stability.flutter_messages import boundary_record, boundary_row
from proprotor.tables.amounts_table import amounts_tables
from proprotor.tables.digits import alike
from proprotor.tables.envelope_table import (
    COLUMNS,
    HEADING,
    SCOPE,
    TEXT,
    envelope_footnotes,
    envelope_rows,
    envelope_verdict,
)
from proprotor.tables.points import Points
from proprotor.tables.sensitivity_summary import (
    NEARLY_DEFECTIVE,
    READ_IN,
    sensitivity_records,
    sensitivity_row,
)
from proprotor.tables.sweep_table import SweepTable, rotor_speed_in_words
from proprotor.typing import Array
from proprotor.units import airspeed_unit, speed_factor

_SPEEDS = 9  # airspeeds in the tables of modes and of trim
_ANGLES = ("collective", "coning", "lag", "elastic_pitch")  # of the trim
_PAIRS = 5  # stations in a row of a distribution

_CONVENTIONS = (
    "Airspeed is true airspeed, in KTAS or m/s; equivalent airspeed where KEAS is said.",
    "Inputs are converted to SI units; hub axes have z along the shaft, which is the direction of flight.",
    "Flap is positive towards thrust, lag against the rotation, pitch nose up at 0.75 R.",
    "Eigenvalues s = −ζω ± iω√(1 − ζ²). Damping is −Re s/|s| in percent of critical, negative where a mode is "
    "unstable. Frequency is |Im s|; per revolution (/rev) means divided by the rotor speed.",
    "Airloads are strip theory, quasi-steady unless the options say that lift lags, without induced velocity unless "
    "the options say so, and without stall.",
    "A point without trim is left out with its reason; it does not affect the other points.",
)


def report_document(
    case: Case,
    found: Findings,
    *,
    settings: Mapping[str, str],
    deck_hash: str,
    date: str,
    unit: str = "kt",
    margin_at: float | None = None,
    points: Points | None = None,
) -> Document:
    """Return the report on a case.

    Parameters
    ----------
    case : Case
    found : Findings
        Result of `proprotor.report.analyse`.
    settings : mapping
        Fields set for this run, with their values as text.
    deck_hash : str
        Hash of the deck as it was read.
    date : str
        Day of the report, ISO 8601.
    unit : str
        Unit of airspeeds.
    margin_at : float, optional
        Airspeed (m/s) whose margin to flutter is wanted.
    points : Points, optional
        Of `proprotor.tables.points.read_points`, to stand on the plots of frequency and damping.

    Raises
    ------
    InputError
        If the unit is no unit of airspeed.
    """
    unit, factor = airspeed_unit(unit), float(speed_factor(unit, case.operation.density, field="unit"))
    table = SweepTable(found.sweep, float(case.operation.rotor_speed), unit)
    sections = (
        Section("Envelope", tuple(_envelope(found))),
        Section("Boundaries", tuple(_boundaries(case, found, unit, factor))),
        Section("Modes", tuple(_modes(table))),
        Section("Trim", tuple(_trim(found, table))),
        Section(
            "Frequency and damping",
            tuple(pictures.of_sweep(case, found, unit, factor, points) if found.mode else ()),
        ),
        Section(f"Causes {_where(found, unit, factor)}".strip(), tuple(_causes(found, unit, factor))),
        Section("Sensitivities", tuple(_sensitivities(case, found, unit, factor))),
        Section("What was analysed", tuple(_model(case, table, settings))),
        Section("Conventions", (Text(_CONVENTIONS),)),
        Section("What the inputs amount to", tuple(_amounts(case))),
        Section("Inputs", tuple(_inputs(case))),
        Section("Reproduction", (_reproduction(case, deck_hash, date),)),
    )
    failures = (f"Not analysed {airspeeds}: {reason}." for airspeeds, _, reason in _failed(table))
    return Document(
        title=case.title or case.name,
        subtitle=f"Case {case.name}, {rotor_speed_in_words(case)}",
        date=date,
        verdict=tuple(verdict(case, found, margin_at, unit, factor)),
        caution=(*reservations(case), *case.warnings, *_doubts(found, table, unit, factor), *failures),
        summary=tuple(summary(case, found, settings, unit, factor)),
        sections=tuple(section for section in sections if section.blocks),
    )


def _doubts(found: Findings, table: SweepTable, unit: str, factor: float) -> Iterator[str]:
    """Yield a sentence on each doubt at the airspeeds of the plots, and one on a doubtful flutter speed."""
    yield from (f"{MARK} {doubt}" for doubt in table.doubts())
    if found.flutters and found.warning:
        yield f"{MARK} Doubtful {_at(found, unit, factor)}, the flutter speed: {found.warning}."


def _failed(table: SweepTable) -> Iterator[tuple[str, str, str]]:
    """Yield the airspeeds, the number of points and the reason of each range that could not be analysed, as text."""
    for reason, run in groupby(enumerate(table.sweep.reason.values.tolist()), key=lambda point: point[1]):
        places = [place for place, _ in run]
        if reason:
            yield _range(table, places[0], places[-1]), str(len(places)), reason


def _range(table: SweepTable, first: int, last: int) -> str:
    """Return the airspeeds between two points as text."""
    ends = f"{table.airspeed[first]:.4g} {table.unit}", f"{table.airspeed[last]:.4g} {table.unit}"
    return f"at {ends[0]}" if first == last else f"from {ends[0]} to {ends[1]}"


def _where(found: Findings, unit: str, factor: float) -> str:
    """Return the end of the heading of the causes: the airspeed to which the causes belong."""
    if not found.mode:
        return ""
    at = _at(found, unit, factor)
    return f"at the flutter speed, {at[3:]}" if found.flutters else at


def _at(found: Findings, unit: str, factor: float) -> str:
    return f"at {marked(f'{found.speed / factor:.2f}', found.warning)} {unit}"


# Boundaries and the model -------------------------------------------------------------------------------------------


def _boundaries(case: Case, found: Findings, unit: str, factor: float) -> Iterator[Table | Text]:
    """Yield the range that was searched, and the table of all boundaries in this range."""
    low, high = (
        marked(f"{at / factor:.4g}", doubt_at(found.flutter.doubts, at)) for at in found.flutter.searched
    )
    if not math.isfinite(found.flutter.searched[0]):
        yield Text(("No airspeed could be analysed, so boundaries are not known.",))
        return
    yield Text((f"Crossings of zero damping between {low} and {high} {unit}, to rounding.",))
    if not found.flutter.boundaries:
        yield Text(("No mode crosses zero damping.",))
        return
    columns = (f"airspeed, {unit}", "m/s", "Hz", "/rev", "mode", "kind", "instability", "mechanism")
    rows = []
    for boundary in found.flutter.boundaries:
        speed, *others = boundary_row(boundary_record(boundary, case), factor)
        rows.append((speed, marked(f"{boundary.position:.3f}", boundary.warning), *others))
    yield Table("Boundaries by airspeed", columns, tuple(rows), frozenset(columns[:4]))
    if doubts := tuple(f"{MARK} {line}" for line in footnotes(found.flutter.doubts, unit, factor)):
        yield Text(doubts, warning=True)


def _envelope(found: Findings) -> Iterator[Any]:
    """Yield the envelope of a deck that has one: its verdict, its picture, a table of its conditions, its scope."""
    if found.no_envelope:
        yield Text((f"The envelope could not be found: {found.no_envelope}.",), warning=True)
    if found.envelope is None:
        return
    yield Text((envelope_verdict(found.envelope),))
    yield from pictures.of_envelope(found.envelope)
    yield Table(HEADING, COLUMNS, tuple(envelope_rows(found.envelope)), frozenset(COLUMNS) - set(TEXT))
    if remarks := tuple(envelope_footnotes(found.envelope)):
        yield Text(remarks, warning=True)
    yield Text((SCOPE,))


def _model(case: Case, table: SweepTable, settings: Mapping[str, str]) -> Iterator[Table | Text]:
    """Yield the airspeeds, the options of the model and the fields that were set."""
    paragraphs = (case.description, f"{len(table.airspeed)} airspeeds, {_range(table, 0, -1)[5:]}.")
    yield Text(tuple(filter(None, paragraphs)))
    every = options_in_result(table.sweep.attrs)
    other = chosen(every)
    rows = [
        (name.replace("_", " "), option_text(value), "chosen" if name in other else "default")
        for name, value in every.items()
        if value is not None
    ]
    yield Table("Options of the model", ("option", "choice", "chosen or default"), tuple(rows))
    if settings:
        yield Table("Fields set for this run", ("field", "value"), tuple(settings.items()))


def _causes(found: Findings, unit: str, factor: float) -> Iterator[Any]:
    """Yield the pictures of the causes, or the reason why the causes could not be found."""
    if found.causes is None:
        yield Text((f"Causes could not be found: {found.no_causes}.",))
        return
    at = _at(found, unit, factor)
    if not found.flutters:
        shown = (
            f"{found.mode}, the mode that is damped least {at}, the highest airspeed that could be analysed"
        )
        yield Text((f"Nothing becomes unstable. Shown for {shown}.",))
    yield from pictures.of_causes(found.causes, found.mode, at, unit)


# Tables -------------------------------------------------------------------------------------------------------------


def _some(working: Array) -> list[int]:
    """Return a few places of True, evenly spread, with the first place and the last place."""
    places = np.flatnonzero(working)
    chosen = np.linspace(0, len(places) - 1, min(_SPEEDS, len(places))).round().astype(int)
    return places[chosen].tolist() if len(places) else []


def _modes(table: SweepTable) -> Iterator[Table | Text]:
    """Yield tables of frequency and damping at a few airspeeds."""
    at = _some(~table.failed)
    if not at:
        return
    warnings = table.sweep.warning.values
    texts = alike([table.airspeed[point] for point in at], 4)
    speeds = tuple(
        marked(f"{text} {table.unit}", warnings[point]) for text, point in zip(texts, at, strict=True)
    )
    for caption, values, form in (
        ("Frequency |Im s| per revolution", table.frequency, ".3f"),
        ("Damping −Re s/|s|, percent of critical; * where a mode is unstable", table.damping, ".2f"),
    ):
        unstable = table.unstable & caption.startswith("Damping")
        rows = tuple(
            (str(mode), *(_cell(values[point, place], form, unstable[point, place]) for point in at))
            for place, mode in enumerate(table.sweep.mode.values)
        )
        yield Table(caption, ("mode", *speeds), rows, frozenset(speeds))
    if mixed := table.mixed():
        yield Text((mixed,))


def _cell(value: float, form: str, unstable: bool) -> str:
    return f"{value:{form}}{'*' if unstable else ''}" if math.isfinite(value) else "–"


def _sensitivities(case: Case, found: Findings, unit: str, factor: float) -> Iterator[Table | Text]:
    """Yield the table of derivatives by all inputs."""
    if found.causes is None:
        return
    rates = found.causes.sensitivity
    if "mode" in rates.dims:
        rates = rates.isel(mode=0)
    of = "flutter_speed" if found.flutters else "damping"
    read_in = READ_IN[of][0]
    damping = f"damping of {found.mode} at {found.speed / factor:.2f} {unit}"
    caption = f"Exact derivatives of the {'flutter speed' if found.flutters else damping}, trim included"
    columns = ("input", "value", f"{read_in} per unit", "unit", f"{read_in} for +1 %", "status")
    rows = []
    for record in sensitivity_records(case, rates, of):
        *cells, change = sensitivity_row(record, read_in)
        rows.append((*cells, change or "–", record["status"]))
    yield Table(caption, columns, tuple(rows), frozenset((columns[2], columns[4])))
    if doubt := rates.warning.item():
        yield Text((f"{MARK} Doubtful: {doubt}.",), warning=True)
    if bool(rates.nearly_defective):
        yield Text((NEARLY_DEFECTIVE,), warning=True)


def _trim(found: Findings, table: SweepTable) -> Iterator[Table | Text]:
    """Yield the steady state at a few airspeeds, and the airspeeds that could not be analysed."""
    trim, degree = found.trim, math.pi / 180
    angles = (f"{name.replace('_', ' ')}, deg" for name in _ANGLES)
    columns = (f"airspeed, {table.unit}", *angles, "thrust, N", "torque, N·m", "doubt")
    at = _some(~table.failed)
    rows = [
        (
            marked(speed, trim.warning[point]),
            *(f"{getattr(trim, name)[point] / degree:.3f}" for name in _ANGLES),
            f"{trim.thrust[point]:.0f}",
            f"{round(trim.torque[point]) + 0:d}",
            str(trim.warning[point]) or "–",
        )
        for point, speed in zip(at, alike([table.airspeed[point] for point in at], 4), strict=True)
    ]
    failed = tuple(_failed(table))
    if rows:
        caption = f"Steady state at some airspeeds{'' if failed else '; every airspeed could be analysed'}"
        yield Table(caption, columns, tuple(rows), frozenset(columns[:-1]))
    if failed:
        head = ("airspeeds", "points", "reason")
        yield Table("Airspeeds that could not be analysed", head, failed, frozenset(("points",)))


# Inputs -------------------------------------------------------------------------------------------------------------


def _inputs(case: Case) -> Iterator[Table | Text]:
    """Yield the table of all inputs with their sources, and a table for each distribution along the blade."""
    doubtful = doubtful_inputs(case)
    counts = f"{len(doubtful)} of {len(case.sources)} inputs"
    yield Text((f"{counts} were not read in a source; they are marked *.",))
    rows = tuple(
        (path, number.written, _si(number), number.status + "*" * (path in doubtful), number.source or "–")
        for path, number in case.sources.items()
    )
    columns = ("field", "as written", "SI", "status", "source")
    yield Table("All inputs, and the numbers that follow from the inputs", columns, rows)
    for path, number in case.sources.items():
        if number.r_over_R is not None:
            yield _distribution(path, number)


def _si(number: Datum) -> str:
    """Return the SI value of an input as text."""
    if number.r_over_R is not None:
        low, high = min(number.si), max(number.si)
        return f"{low:.6g} to {high:.6g} {number.unit}".strip() + ", see below"
    if isinstance(number.si, FilePath):
        return "a file"
    if isinstance(number.si, tuple):
        return "files" if isinstance(number.si[0], FilePath) else _listed(number.si, number.unit)
    if isinstance(number.si, bool | str):
        return as_toml(number.si)
    return f"{number.si:.6g} {number.unit}".strip()


def _listed(values: tuple[float, ...], unit: str) -> str:
    """Return a list of values with their unit."""
    return f"{', '.join(f'{value:.6g}' for value in values)} {unit}".strip()


def _distribution(path: str, number: Datum) -> Table:
    """Return the table of a distribution along the blade, several stations in a row."""
    stations = list(zip(number.r_over_R or (), number.si, strict=True))
    count = math.ceil(len(stations) / _PAIRS)
    pair = ("r/R", number.unit or "value")
    rows = []
    for place in range(count):
        cells = [text for r, value in stations[place::count] for text in (f"{r:.4g}", f"{value:.6g}")]
        rows.append(tuple(cells + [""] * (2 * _PAIRS - len(cells))))
    return Table(f"{path} along the blade", pair * _PAIRS, tuple(rows), frozenset(pair))


def _amounts(case: Case) -> Iterator[Table | Text]:
    """Yield the tables of what the inputs amount to, and the rules that doubtful numbers break."""
    tables, doubts = amounts_tables(case)
    for table in tables:
        yield Table(
            table.caption, table.columns, table.rows, frozenset(table.columns) - frozenset(table.text)
        )
    if doubts:
        yield Text(doubts, warning=True)


def _reproduction(case: Case, deck_hash: str, date: str) -> Table:
    """Return the table of all that one needs to make the same report again."""
    rows = (
        ("proprotor", version("proprotor")),
        ("case", case.name),
        ("numbers of the deck", deck_fingerprint(case)),
        ("deck, SHA-256", deck_hash),
        ("date", date),
    )
    return Table("The same deck and options give the same report, but for the date", ("what", "value"), rows)
