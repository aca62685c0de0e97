"""The command `proprotor report`: all results on a case, in one file."""

from __future__ import annotations

import os
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from proprotor.case import Case
from proprotor.commands import arguments, output
from proprotor.commands.waiting import waiting
from proprotor.deck.file import read_tables
from proprotor.deck.written import FilePath
from proprotor.errors import InputError
from proprotor.files.fingerprint import fingerprint
from proprotor.stability.flutter_messages import boundary_record, failed_records
from proprotor.units import speeds

if TYPE_CHECKING:
    from proprotor.report import Document, Findings

_SUFFIXES = (".html", ".pdf", ".docx")


@arguments.command()
@arguments.case_argument
@arguments.range_option(
    'Airspeeds to analyse: "50:400:5kt"; by default 0.2 to 1.2 of the tip speed, in knots.'
)
@click.option(
    "--out",
    metavar="FILE",
    help="File to write, .html, .pdf or .docx; by default the name of the case and -report.html.",
)
@click.option("--pdf", is_flag=True, help="Write a PDF as well (pip install 'proprotor[report]').")
@click.option(
    "--docx",
    is_flag=True,
    help="Write a DOCX as well, to go on writing in (pip install 'proprotor[report]').",
)
@click.option(
    "--margin-at",
    metavar="SPEED",
    help='Airspeed whose margin to flutter stands in the summary: "250 ktas" or "250 keas".',
)
@arguments.points_option
@output.json_option
@arguments.model_options
def report(
    request: arguments.Request,
    speed: str | None,
    out: str | None,
    pdf: bool,
    docx: bool,
    margin_at: str | None,
    points: str | None,
    as_json: bool,
) -> None:
    """Write a report on a case: boundaries, plots, causes, sensitivities, and every input with its source.

    CASE is a bundled case or a TOML file. The report is one file that needs no other file. Its first page is a
    summary: the verdict with its margin, the reservations about the numbers, the numbers that follow from the inputs,
    and the inputs that matter most. The same deck and options give the same file, except for the date;
    the environment variable SOURCE_DATE_EPOCH (seconds since 1970) sets the date.

    \b
    Examples:
      proprotor report xv15
      proprotor report my.toml --out my.docx --margin-at "250 keas"
      proprotor report my.toml --speed 100:400:5kt --set rotor.precone="1.5 deg" \\
        --pdf
    """
    # Here, because the packages behind a report take long to import.
    from proprotor.report import analyse, report_document

    date, case = _date(), request.load()
    airspeeds = None if speed is None else speeds(speed, "--speed", case.operation.density)
    up = [arguments.FREQUENCY, arguments.DAMPING]
    across = arguments.airspeed_points(case.operation.density)
    measured = arguments.points_of(points, out or case.name, across, up)
    at = None if margin_at is None else arguments.one_speed(margin_at, case)
    if at == 0:
        raise InputError("--margin-at", margin_at, "must be above zero")
    places = _places(out or f"{case.name}-report.html", [".pdf"] * pdf + [".docx"] * docx)
    for place in places:
        output.check_writable("--out", place)
    with waiting("Analysing") as tell:
        found = analyse(case, airspeeds, request.options, tell)
    with waiting("Drawing"):
        document = report_document(
            case,
            found,
            settings=request.settings,
            deck_hash=_deck_hash(case, request),
            date=date,
            unit=arguments.unit_of(speed or "kt"),
            margin_at=at,
            points=measured,
        )
        contents = {place: _content_of(document, place) for place in places}
    for place, content in contents.items():
        output.write("--out", place, content)
    if as_json:
        output.print_json(output.about(case, request) | _document(case, found, document, places, at))
    else:
        output.print_head(case, found.sweep.attrs)
        for sentence in document.verdict:
            output.console().print(sentence, style="bold")
    output.exit_without(found.mode)


def _places(out: str, more: list[str]) -> list[str]:
    """Return the files to write: `out`, and one beside it for each further suffix.

    Refuse other kinds of files, and those whose package is missing, before the analysis.
    """
    from proprotor.report import check_typesetter, check_word

    place = Path(out)
    if place.suffix.lower() not in _SUFFIXES:
        raise InputError("--out", out, f"must end in {' or '.join(_SUFFIXES)}")
    suffixes = [suffix for suffix in more if suffix != place.suffix.lower()]
    for suffix in (place.suffix.lower(), *suffixes):
        {".pdf": check_typesetter, ".docx": check_word}.get(suffix, lambda: None)()
    return [out, *(str(place.with_suffix(suffix)) for suffix in suffixes)]


def _content_of(document: Document, place: str) -> bytes:
    """Return the document in the form of a file."""
    from proprotor.report import docx_of, html_of, pdf_of

    makers = {".pdf": pdf_of, ".docx": docx_of}
    made = makers.get(Path(place).suffix.lower())
    return html_of(document).encode() if made is None else made(document)


def _date() -> str:
    """Return the date of today, or of SOURCE_DATE_EPOCH, which reproducible builds set."""
    given = os.environ.get("SOURCE_DATE_EPOCH")
    if given is None:
        return datetime.now(UTC).date().isoformat()
    try:
        return datetime.fromtimestamp(int(given), UTC).date().isoformat()
    except (ValueError, OverflowError, OSError):
        raise InputError("SOURCE_DATE_EPOCH", given, "must be seconds since 1970") from None


def _deck_hash(case: Case, request: arguments.Request) -> str:
    """Return the SHA-256 of a deck with its base, the fields of `--set`, and the content of the files in the deck."""
    from proprotor.deck.settings import with_settings  # here, because pydantic takes long to import

    numbers = {path: _content(number.si) for path, number in case.given.items()}
    return fingerprint((with_settings(read_tables(request.name), request.settings), numbers))


def _content(value: Any) -> Any:
    """Return the content of a file, or of each file of a list; any other value as it is."""
    if isinstance(value, tuple):
        return tuple(map(_content, value))
    return Path(value).read_bytes() if isinstance(value, FilePath) else value


def _document(
    case: Case, found: Findings, document: Document, places: list[str], at: float | None
) -> dict[str, Any]:
    margin = {} if at is None else {"margin at (m/s)": at, "margin": found.flutter.margin(at)}
    return margin | {
        "written": places,
        "date": document.date,
        "searched (m/s)": list(found.flutter.searched),
        "not analysed": failed_records(found.flutter),
        "flutter speed (m/s)": found.flutter.speed,
        "mode": found.flutter.mode or None,
        "warning": found.flutter.warning,
        "boundaries": [boundary_record(boundary, case) for boundary in found.flutter.boundaries],
        "doubts": output.doubts_as_data(found.flutter.doubts),
        "failed airspeeds (m/s)": found.sweep.airspeed.values[found.sweep.reason.values != ""].tolist(),
    }
