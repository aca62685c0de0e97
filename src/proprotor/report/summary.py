"""The first page of a report: the verdict with its margin, the numbers of the rotor, and what the result hangs on."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from itertools import islice

import numpy as np

from proprotor.case import Case
from proprotor.model.amounts import amounts, blade_at_trims
from proprotor.model.doubts import MARK, marked
from proprotor.model.options_in_force import options_in_result, options_text
from proprotor.model.provenance import doubtful_inputs
from proprotor.report.analyses import Findings
from proprotor.report.document import Table, Text
from proprotor.stability.flutter_messages import answer, remarks
from proprotor.tables.digits import significant
from proprotor.tables.envelope_table import envelope_verdict
from proprotor.tables.sensitivity_summary import READ_IN, sensitivity_records, sensitivity_row

_MOST = 5  # inputs in a list of those that matter most
_NO_MARGIN = (
    "No margin: the deck has no [envelope], and no airspeed was given whose margin is wanted (--margin-at)."
)
_OF_ROTOR = {"Lock number": "Lock number γ", "solidity": "solidity σ", "tip Mach number": "tip Mach Ω R / a"}
_OF_BLADE = {
    "ν_β, /rev": "flap_frequency",
    "ν_ζ, /rev": "lag_frequency",
    "K_Pβ": "pitch_flap_coupling",
    "K_Pζ": "pitch_lag_coupling",
}


def verdict(case: Case, found: Findings, margin_at: float | None, unit: str, factor: float) -> Iterator[str]:
    """Yield the sentences at the top of a report: the answer and its margin, the envelope, and other onsets.

    Parameters
    ----------
    case : Case
    found : Findings
    margin_at : float, optional
        Airspeed (m/s) whose margin is wanted.
    unit, factor : str, float
        Unit of airspeeds, and the unit in m/s.
    """
    flutter, omega = found.flutter, float(case.operation.rotor_speed)
    if found.flutters:
        yield (
            f"Flutter speed {marked(f'{flutter.speed / factor:.2f}', flutter.warning)} {unit}: "
            f"{flutter.mode}, {flutter.kind}, "
            f"at {flutter.frequency / (2 * math.pi):.3f} Hz, {flutter.frequency / omega:.3f} per rev."
        )
    for sentence in answer(flutter, margin_at, unit, factor):
        if not sentence.startswith("Flutter speed"):
            yield sentence
    if found.envelope is not None:
        yield f"Envelope: {envelope_verdict(found.envelope)}"
    elif found.no_envelope:
        yield f"The envelope could not be found: {found.no_envelope}."
    elif margin_at is None and found.flutters:
        yield _NO_MARGIN
    if math.isfinite(flutter.searched[0]):
        yield from remarks(flutter, unit, factor)


def summary(
    case: Case, found: Findings, settings: Mapping[str, str], unit: str, factor: float
) -> Iterator[Text | Table]:
    """Yield what stands on the first page beneath verdict and reservations.

    Parameters
    ----------
    case : Case
    found : Findings
    settings : mapping
        Fields set for this run, with their values as text.
    unit, factor : str, float
        Unit of airspeeds, and the unit in m/s.
    """
    yield from _numbers(case, found, unit, factor)
    yield from _inputs_that_matter(case, found)
    speeds = found.sweep.airspeed.values / factor
    own = [f"Set for this run: {', '.join(f'{path} = {value}' for path, value in settings.items())}."]
    yield Text(
        (
            f"Analysed: {len(speeds)} airspeeds from {speeds.min():.4g} to {speeds.max():.4g} {unit}; "
            f"{options_text(options_in_result(found.sweep.attrs))}.",
            *(own if settings else []),
        )
    )


def _numbers(case: Case, found: Findings, unit: str, factor: float) -> Iterator[Table | Text]:
    """Yield the numbers that follow from the inputs, and the rules that doubtful ones break."""
    found_amounts = {one.name: one for one in amounts(case)}
    of_rotor = {head: found_amounts[name] for name, head in _OF_ROTOR.items()}
    cells = {head: marked(significant(one.value, 3), one.doubt) for head, one in of_rotor.items()}
    doubts = [one.doubt for one in of_rotor.values()]
    where = ""
    for blade in blade_at_trims(case, np.array([found.speed])) if found.mode else ():
        where = f"; tip Mach along the helix, ν and K_P at {found.speed / factor:.4g} {unit}"
        cells["along the helix"] = significant(_helical_mach(case, found.speed), 3)
        for head, name in _OF_BLADE.items():
            value = getattr(blade, name)
            cells[head] = "–" if math.isnan(value) else marked(f"{value:.3f}", blade.doubt)
        doubts.append(blade.doubt)
    cells["K_PG"] = f"{float(case.rotor.pitch_gimbal_coupling):.3f}"
    side = " of the right rotor" if case.left is not None else ""
    caption = f"Numbers{side} that follow from the inputs{where}"
    yield Table(caption, tuple(cells), (tuple(cells.values()),), frozenset(cells))
    if told := tuple(dict.fromkeys(f"{MARK} {doubt}." for doubt in doubts if doubt)):
        yield Text(told, warning=True)


def _helical_mach(case: Case, airspeed: float) -> float:
    """Return the Mach number of the tip of a blade along its helix."""
    operation = case.operation
    around = float(operation.rotor_speed * case.rotor.radius)
    return math.hypot(around, airspeed) / float(operation.speed_of_sound)


def _inputs_that_matter(case: Case, found: Findings) -> Iterator[Table]:
    """Yield the inputs that move the result most, and those among the inputs that were not read in a source."""
    if found.causes is None:
        return
    of = "flutter_speed" if found.flutters else "damping"
    what = "flutter speed" if found.flutters else f"damping of {found.mode}"
    read_in, doubtful = READ_IN[of][0], doubtful_inputs(case)
    rates = found.causes.sensitivity
    records = sensitivity_records(case, rates.isel(mode=0) if "mode" in rates.dims else rates, of)
    columns = ("input", "value", f"{read_in} for +1 %", "status")
    for caption, among in (
        (f"Inputs that move the {what} most", records),
        (
            f"Inputs not read in a source that move the {what} most, of {len(doubtful)}",
            (record for record in records if record["input"] in doubtful),
        ),
    ):
        rows = []
        for record in islice(among, _MOST):
            path, value, *_, change = sensitivity_row(record, read_in)
            rows.append((path, value, change or "–", record["status"] + "*" * (path in doubtful)))
        if rows:
            yield Table(caption, columns, tuple(rows), frozenset(columns[2:3]))
