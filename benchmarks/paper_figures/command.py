"""The program that makes the analytical figures of the paper: `python -m benchmarks.paper_figures`."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

import click

from benchmarks.paper_figures.analyses import Analyses
from benchmarks.paper_figures.catalogue import NUMBERS, check_number, make_figure
from benchmarks.paper_figures.content import csv_of
from benchmarks.paper_figures.drawing import save
from proprotor.commands.exit_codes import EXIT_CODES
from proprotor.commands.main import errors_as_messages
from proprotor.commands.output import check_writable, write
from proprotor.commands.waiting import waiting
from proprotor.errors import InputError

_KINDS = ("png", "csv")


@click.command(epilog=EXIT_CODES, context_settings={"max_content_width": 100})
@click.argument("numbers", nargs=-1, type=int, metavar="[NUMBER]...")
@click.option(
    "--out",
    default="figures",
    show_default=True,
    metavar="FOLDER",
    help="Where to write figure-04.png, figure-04.csv and so on; made if the folder does not exist.",
)
@click.option(
    "--samples",
    default=300,
    show_default=True,
    type=click.IntRange(0, 100_000),
    help="Designs of the uncertainty bands; 0 for none.",
)
@click.option(
    "--step", default=5.0, show_default=True, type=click.FloatRange(0.5, 50), help="Between airspeeds, kt."
)
@click.option("--seed", default=0, show_default=True, type=click.IntRange(0), help="Seed of the samples.")
def figures(numbers: tuple[int, ...], out: str, samples: int, step: float, seed: int) -> None:
    """Make the analytical figures of AIAA-2002-1604, each with its numbers as CSV.

    NUMBER is a figure of the paper: 4 to 12, 14 to 18, 21 to 24; without any, all of them. Bands show what the
    doubtful inputs of a case leave of a result; benchmarks/paper_figures/input_ranges.py has ranges and reasons.

    \b
    Examples:
      python -m benchmarks.paper_figures --out figures/
      python -m benchmarks.paper_figures 4 5 6 --samples 0
    """
    with errors_as_messages():
        wanted = sorted(set(numbers)) or NUMBERS
        for number in wanted:
            check_number(number)
        folder = _folder(out, wanted)
        analyses = Analyses(step, samples, seed)
        for place, number in enumerate(wanted, start=1):
            with waiting(f"Figure {number}, {place} of {len(wanted)}"):
                content = make_figure(number, analyses)
            write("--out", _place(folder, number, "png"), partial(save, content))
            write("--out", _place(folder, number, "csv"), csv_of(content))


def _folder(out: str, numbers: Sequence[int]) -> Path:
    """Return the folder of the figures, in which each figure can be written."""
    folder = Path(out)
    if folder.exists() and not folder.is_dir():
        raise InputError("--out", out, "must be a folder")
    folder.mkdir(parents=True, exist_ok=True)
    for number in numbers:
        for kind in _KINDS:
            check_writable("--out", _place(folder, number, kind))
    return folder


def _place(folder: Path, number: int, kind: str) -> str:
    return str(folder / f"figure-{number:02}.{kind}")
