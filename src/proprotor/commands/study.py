"""The command `proprotor study`: many designs of a case, into a netCDF file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import Any

import click

from proprotor.commands import arguments, output
from proprotor.errors import InputError
from proprotor.exchange.netcdf import check_path, save_results
from proprotor.model import stamp
from proprotor.model.doubts import marked
from proprotor.study import sampling
from proprotor.study.study import study as study_of
from proprotor.study.uncertainty import distribution
from proprotor.study.variables import DEFAULT_QUANTITIES
from proprotor.tables.study_summary import study_summary
from proprotor.typing import Dataset
from proprotor.units import KNOT, KTAS, speeds

_SAMPLES = ("latin-hypercube", "sobol", "saltelli")
_OF_DECK = " of deck"
_REASONS = 5  # most frequent reasons of failures that are printed


@arguments.command()
@arguments.case_argument
@click.option(
    "--vary",
    "varied",
    multiple=True,
    required=True,
    type=arguments.InputValues(),
    metavar="INPUT=VALUES",
    help='Input that varies, by deck path, and its values: "rotor.precone=1:4:0.5 deg" or "=1 deg, 2 deg"; with '
    '--sample its limits: "=1:4 deg" or "=0.9:1.1 of deck". Repeatable.',
)
@arguments.range_option('Airspeeds with their unit: "160:460:20kt" or "300 kt".', required=True)
@click.option("--out", metavar="FILE", help="Write the results: a .nc file (netCDF).")
@click.option(
    "--sample", type=click.Choice(_SAMPLES), help="Draw a sample of the inputs instead of all combinations."
)
@click.option("--size", type=click.IntRange(1), default=256, show_default=True, help="Size of the sample.")
@click.option("--seed", type=click.IntRange(0), default=0, show_default=True, help="Seed of the sample.")
@click.option("--flutter", is_flag=True, help="Find the flutter speed of each design in the range.")
@click.option("--checkpoint", metavar="FOLDER", help="Folder that keeps finished batches, for a restart.")
@click.option("--workers", type=click.IntRange(1), help="Number of processes; by default one for each core.")
@output.json_option
@arguments.model_options
def study(
    request: arguments.Request,
    varied: tuple[str, ...],
    speed: str,
    out: str | None,
    sample: str | None,
    size: int,
    seed: int,
    flutter: bool,
    checkpoint: str | None,
    workers: int | None,
    as_json: bool,
) -> None:
    """Analyse stability and trim of many designs of a case.

    CASE is a bundled case or a TOML file; `proprotor describe` lists the inputs. A study with a checkpoint that was
    stopped goes on where it stopped when the same command runs again.

    \b
    Examples:
      proprotor study xv15 --vary "rotor.precone=1:4:1 deg" --speed 160:460:20kt --flutter
      proprotor study xv15 --vary "rotor.precone=1:4 deg" --vary "support.chord_frequency=0.9:1.1 of deck"
        --sample latin-hypercube --size 1000 --speed 160:460:20kt --flutter --out study.nc --checkpoint batches
    """
    output.check_writable("--out", out)
    if out:
        check_path(out, "--out")
    case, plan = request.load(), _plan(varied, sample, size, seed)
    airspeeds = speeds(speed, "--speed", stamp.one_density(case, plan.inputs))
    with output.one_message("--checkpoint", checkpoint):
        results = study_of(
            case,
            plan,
            airspeeds if len(airspeeds) > 1 else airspeeds[0],
            (*DEFAULT_QUANTITIES, *["flutter"] * flutter),
            workers=workers,
            checkpoint=checkpoint,
            **request.options,
        )
    if out:
        with output.one_message("--out", out):
            save_results(results, out)
        click.echo(f"Wrote {out}", err=True)
    if as_json:
        output.print_json(output.about(case, request) | study_summary(results) | {"results": out})
    else:
        _print(results)
    output.exit_without((results.reason == "").any())


def _plan(varied: tuple[str, ...], sample: str | None, size: int, seed: int) -> sampling.Plan:
    """Return the grid or sample of the inputs of `--vary`."""
    inputs = {}
    for text in varied:
        rule = 'must be an input and its values, such as "rotor.precone=1:4:0.5 deg"'
        path, values = arguments.name_and_value("--vary", text, rule)
        if path in inputs:
            raise InputError("--vary", text, "must not vary an input twice")
        listed = [value.strip() for value in values.split(",")]
        inputs[path] = _limits(text, values) if sample else listed if len(listed) > 1 else listed[0]
    if sample is None:
        return sampling.grid(inputs)
    draw: Callable[..., sampling.Plan] = getattr(sampling, sample.replace("-", "_"))
    return draw(inputs, size, seed)


def _limits(whole: str, text: str) -> Any:
    """Return the limits of ``"1:4 deg"`` or ``"0.9:1.1 of deck"``."""
    low, colon, high = text.removesuffix(_OF_DECK).strip().partition(":")
    if not colon or ":" in high:
        raise InputError("--vary", whole, 'must have two limits, such as "rotor.precone=1:4 deg"')
    if text.endswith(_OF_DECK):
        try:
            return sampling.Relative(float(low), float(high))
        except ValueError:
            raise InputError("--vary", whole, 'must have two factors, such as "0.9:1.1 of deck"') from None
    return f"{low.strip()} {arguments.unit_of(high)}", high.strip()


def _print(results: Dataset) -> None:
    out, found = output.console(), study_summary(results)
    out.print(f"{found['title']}: {found['points']} points, {found['failed']} failed")
    for text, count in list(found["reasons"].items())[:_REASONS]:
        out.print(f"  {count} × {text}", soft_wrap=True)
    if "flutter_speed" in results:
        _print_flutter(results)
    elif "points unstable" in found:
        damping = marked(f"{found['lowest damping (% of critical)']:.3g}", found["points doubtful"])
        out.print(f"{found['points unstable']} points unstable; lowest damping {damping} %")
    doubts = found["doubts of points"].items()
    output.print_footnotes(
        f"Doubtful at {count} of {found['points']} points: {text}." for text, count in doubts
    )
    for line in (*stamp.unusual_options(results.attrs), results.attrs["reservations"]):
        out.print(line)


def _print_flutter(results: Dataset) -> None:
    stacked = results[["flutter_speed", "flutter_note", "flutter_warning"]]
    if "design" not in stacked.dims:
        stacked = stacked.stack(design=stacked.flutter_speed.dims)
    notes = Counter(text for text in stacked.flutter_note.values if text)
    try:
        found = distribution(stacked)
    except InputError:
        output.console().print("no flutter speed was found")
    else:
        shares = zip(found.percentile.values, found.value.values, strict=True)
        doubts = found.attrs["doubts"]
        rows = (
            (f"{share:g}", marked(f"{speed:.2f}", doubts), marked(f"{speed / KNOT:.1f}", doubts))
            for share, speed in shares
        )
        output.print_table(("% of designs", "flutter speed at most, m/s", KTAS), rows)
        if doubts:
            counted = f"{int(found.doubtful)} of {int(found.known)} flutter speeds"
            output.print_footnotes([f"Doubtful are {counted}: {doubts}."])
    for text, count in notes.most_common(_REASONS):
        output.console().print(f"  {count} × {text}", soft_wrap=True)
