"""The command `proprotor figures`: the analytical figures of the paper."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from operator import methodcaller
from pathlib import Path
from typing import TYPE_CHECKING

import click

from proprotor.commands import output
from proprotor.commands.arguments import EXIT_CODES
from proprotor.errors import InputError
from proprotor.files.output import write_whole

if TYPE_CHECKING:
    from rich.progress import Progress

_KINDS = ("png", "csv")
_BAND_WORK = 10  # a sample takes about as long as so many figures


@click.command(epilog=EXIT_CODES, short_help="The analytical figures of AIAA-2002-1604.")
@click.argument("numbers", nargs=-1, type=int, metavar="[NUMBER]...")
@click.option(
    "--out",
    default="figures",
    show_default=True,
    metavar="FOLDER",
    help="Where to write figure-04.png, figure-04.csv and so on; made if it is not there.",
)
@click.option(
    "--samples",
    default=300,
    show_default=True,
    type=click.IntRange(0, 100_000),
    help="Designs of the uncertainty bands; 0 for none.",
)
@click.option(
    "--step",
    default=5.0,
    show_default=True,
    type=click.FloatRange(0.5, 50),
    help="Between airspeeds, kt.",
)
@click.option("--seed", default=0, show_default=True, type=click.IntRange(0), help="Of the samples.")
@output.json_option
def figures(numbers: tuple[int, ...], out: str, samples: int, step: float, seed: int, as_json: bool) -> None:
    """Make the analytical figures of AIAA-2002-1604, each with its numbers as CSV.

    NUMBER is a figure of the paper: 4 to 12, 14 to 18, 21 to 24; all of them without any. Bands show what the
    doubtful inputs of a case leave of a result; ranges and reasons stand in proprotor/input_ranges.py.

    \b
    Examples:
      proprotor figures --out figures/
      proprotor figures 4 5 6 --samples 0
    """
    from benchmarks.paper_figures import NUMBERS, Analyses, csv_of, decks_with_bands, make_figure
    from benchmarks.paper_figures.catalogue import check_number
    from benchmarks.paper_figures.drawing import save

    wanted = sorted(set(numbers)) or NUMBERS
    for number in wanted:
        check_number(number)
    folder = _folder(out, wanted)
    bands = decks_with_bands(wanted) if samples else ()
    with _progress() as progress:
        task = progress.add_task("Analysing", total=len(wanted) + _BAND_WORK * len(bands))
        analyses = Analyses(step, samples, seed, lambda share: progress.advance(task, _BAND_WORK * share))
        for number in wanted:
            progress.update(task, description=f"Figure {number}")
            content = make_figure(number, analyses)
            with output.one_message("--out", str(folder)):
                write_whole(_place(folder, number, "png"), partial(save, content))
                write_whole(_place(folder, number, "csv"), methodcaller("write", csv_of(content)))
            progress.advance(task)
    told = "1 figure" if len(wanted) == 1 else f"{len(wanted)} figures"
    click.echo(f"Wrote {told} to {folder}, a .png and a .csv each", err=True)
    if as_json:
        names = {number: [str(_place(folder, number, kind)) for kind in _KINDS] for number in wanted}
        output.print_json({"samples": samples, "step (kt)": step, "seed": seed, "figures": names})


def _folder(out: str, numbers: Sequence[int]) -> Path:
    """The folder of the figures, in which each of them can be written."""
    folder = Path(out)
    if folder.exists() and not folder.is_dir():
        raise InputError("--out", out, "must be a folder")
    with output.one_message("--out", out):
        folder.mkdir(parents=True, exist_ok=True)
    for number in numbers:
        for kind in _KINDS:
            output.check_writable("--out", str(_place(folder, number, kind)))
    return folder


def _place(folder: Path, number: int, kind: str) -> Path:
    return folder / f"figure-{number:02}.{kind}"


def _progress() -> Progress:
    from rich.console import Console  # here, because rich takes long to import
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description:<10}"), BarColumn(), TextColumn("{task.percentage:>3.0f} %"))
    console = Console(stderr=True)
    return Progress(*columns, TimeElapsedColumn(), console=console, disable=not console.is_terminal)
