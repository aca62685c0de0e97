"""The command `proprotor study`: many designs of a case, into a netCDF file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import click
import numpy as np

from proprotor.commands.arguments import case_argument, loaded_case, settings_of
from proprotor.commands.output import print_json
from proprotor.errors import InputError

if TYPE_CHECKING:
    import xarray

    from proprotor.sampling import Plan

Command = Callable[..., Any]
SAMPLES = ("latin-hypercube", "sobol", "saltelli")
_OF_DECK = " of deck"
_REASONS = 5  # of failures, the most frequent first


def study_command(model_options: Callable[[Command], Command], epilog: str) -> click.Command:
    """The command, with a flag for each option of the model.

    Parameters
    ----------
    model_options : decorator
        Adds the flags.
    epilog : str
        What stands at the end of the help.
    """
    return click.command("study", epilog=epilog, short_help="Many designs: grids, lists and samples.")(
        case_argument(_options(model_options(_study)))
    )


def _options(command: Command) -> Command:
    declared = (
        click.option(
            "--vary",
            "varied",
            multiple=True,
            required=True,
            metavar="INPUT=VALUES",
            help='What varies, by deck path: "rotor.precone=1:4:0.5 deg" or "=1 deg, 2 deg"; in a sample the limits, '
            '"=1:4 deg" or "=0.9:1.1 of deck". Repeatable.',
        ),
        click.option(
            "--speed", required=True, metavar="RANGE", help='Airspeeds: "160:460:20kt" or "300 kt".'
        ),
        click.option("--out", metavar="FILE", help="Write the results: a .nc file (netCDF)."),
        click.option(
            "--sample", type=click.Choice(SAMPLES), help="Sample the inputs; without it all combinations."
        ),
        click.option("--size", type=click.IntRange(1), default=256, show_default=True, help="Of the sample."),
        click.option("--seed", type=int, default=0, show_default=True, help="Of the sample."),
        click.option("--flutter", is_flag=True, help="Find the flutter speed of each design in the range."),
        click.option(
            "--checkpoint", metavar="FOLDER", help="Keep finished batches, and go on from those kept."
        ),
        click.option("--json", "as_json", is_flag=True, help="Print the summary as JSON instead of text."),
        click.option("--workers", type=click.IntRange(1), help="Processes; by default one for each core."),
    )
    for option in reversed(declared):
        command = option(command)
    return command


def _study(
    case: str,
    settings: tuple[str, ...],
    varied: tuple[str, ...],
    speed: str,
    out: str | None,
    sample: str | None,
    size: int,
    seed: int,
    flutter: bool,
    checkpoint: str | None,
    as_json: bool,
    workers: int | None,
    **options: Any,
) -> None:
    """Stability and trim of many designs of a case.

    CASE is a bundled case or a TOML file; `proprotor cases CASE` lists its inputs. A study that was stopped goes on
    where it was when it has a checkpoint.

    \b
    Examples:
      proprotor study xv15 --vary "rotor.precone=1:4:1 deg" --speed 160:460:20kt --flutter
      proprotor study xv15 --vary "rotor.precone=1:4 deg" --vary "support.modes[chord].frequency=0.9:1.1 of deck"
        --sample latin-hypercube --size 1000 --speed 160:460:20kt --flutter --out study.nc --checkpoint batches
    """
    from proprotor.results_file import check_path, save_results
    from proprotor.study import study
    from proprotor.study_batch import DEFAULT_QUANTITIES
    from proprotor.units import speeds

    if out:
        check_path(out, "--out")
    airspeeds = speeds(speed, "--speed")
    with _told("--checkpoint", checkpoint):
        results = study(
            loaded_case(case, settings),
            _plan(varied, sample, size, seed),
            airspeeds if len(airspeeds) > 1 else airspeeds[0],
            (*DEFAULT_QUANTITIES, *["flutter"] * flutter),
            workers=workers,
            checkpoint=checkpoint,
            **{name: value for name, value in options.items() if value is not None},
        )
    if out:
        with _told("--out", out):
            save_results(results, out)
        click.echo(f"Wrote {out}", err=True)
    if as_json:
        print_json(_summary(results) | {"set": settings_of(settings), "results": out})
    else:
        _print(results)
    if bool((results.reason != "").all()):
        raise click.exceptions.Exit(1)


@contextmanager
def _told(option: str, path: str | None) -> Iterator[None]:
    """An output that cannot be written, in one message."""
    try:
        yield
    except OSError as error:
        if path is None:
            raise
        reason = error.strerror or error
        raise click.ClickException(f"{option} = {path}: cannot be written ({reason})") from None


def _plan(varied: tuple[str, ...], sample: str | None, size: int, seed: int) -> Plan:
    from proprotor import sampling

    inputs = {}
    for text in varied:
        path, equals, values = text.partition("=")
        if not equals or not values.strip():
            raise InputError(
                "--vary", text, 'must be an input and its values, such as "rotor.precone=1:4:0.5 deg"'
            )
        if path.strip() in inputs:
            raise InputError("--vary", text, "must not vary an input twice")
        inputs[path.strip()] = _limits(text, values) if sample else _values(values)
    if sample is None:
        return sampling.grid(inputs)
    draw: Callable[..., Plan] = getattr(sampling, sample.replace("-", "_"))
    return draw(inputs, size, seed)


def _values(text: str) -> Any:
    parts = [part.strip() for part in text.split(",")]
    return parts if len(parts) > 1 else parts[0]


def _limits(whole: str, text: str) -> Any:
    """``"1:4 deg"`` or ``"0.9:1.1 of deck"``."""
    from proprotor.sampling import Relative

    low, colon, high = text.removesuffix(_OF_DECK).strip().partition(":")
    if not colon or ":" in high:
        raise InputError("--vary", whole, 'must have two limits, such as "rotor.precone=1:4 deg"')
    if text.endswith(_OF_DECK):
        try:
            return Relative(float(low), float(high))
        except ValueError:
            raise InputError("--vary", whole, 'must have two factors, such as "0.9:1.1 of deck"') from None
    unit = high.strip().lstrip("0123456789.+-eE").strip()
    return f"{low.strip()} {unit}", high.strip()


def _summary(results: xarray.Dataset) -> dict[str, Any]:
    """The summary as plain data."""
    reasons = Counter(str(text) for text in results.reason.values.ravel() if text)
    summary: dict[str, Any] = {
        "title": results.title,
        "points": int(results.reason.size),
        "failed": sum(reasons.values()),
        "reasons": dict(reasons.most_common()),
        "reservations": results.attrs["reservations"],
    }
    if "flutter_speed" in results:
        found = np.asarray(results.flutter_speed.values, dtype=float).ravel()
        notes = Counter(str(text) for text in results.flutter_note.values.ravel() if text)
        speeds = np.sort(found[np.isfinite(found)])
        return summary | {
            "flutter speeds found": len(speeds),
            "lowest flutter speed (m/s)": float(speeds[0]) if len(speeds) else None,
            "median flutter speed (m/s)": float(np.median(speeds)) if len(speeds) else None,
            "highest flutter speed (m/s)": float(speeds[-1]) if len(speeds) else None,
            "notes": dict(notes.most_common()),
        }
    if summary["failed"] == summary["points"]:
        return summary
    return summary | {
        "points unstable": int((results.growth_rate > 0).sum()),
        "lowest damping (% of critical)": 100 * float(results.damping_ratio.min()),
    }


def _print(results: xarray.Dataset) -> None:
    from rich.console import Console
    from rich.table import Table

    console = Console(highlight=False, soft_wrap=True)
    reasons = Counter(text for text in results.reason.values.ravel() if text)
    failed = sum(reasons.values())
    console.print(f"{results.title}: {results.reason.size} points, {failed} failed")
    for text, count in reasons.most_common(_REASONS):
        console.print(f"  {count} × {text}", markup=False)
    if "flutter_speed" in results:
        _print_flutter(console, results, Table)
    elif failed < results.reason.size:
        unstable = int((results.growth_rate > 0).sum())
        console.print(
            f"{unstable} points unstable; lowest damping {100 * float(results.damping_ratio.min()):.3g} %"
        )
    console.print(results.attrs["reservations"])


def _print_flutter(console: Any, results: xarray.Dataset, Table: Any) -> None:
    from proprotor.uncertainty import distribution

    stacked = results[["flutter_speed", "flutter_note"]]
    if "design" not in stacked.dims:
        stacked = stacked.stack(design=stacked.flutter_speed.dims)
    notes = Counter(text for text in stacked.flutter_note.values if text)
    try:
        found = distribution(stacked)
    except InputError:
        console.print("no flutter speed was found")
    else:
        table = Table("% of designs", "flutter speed at most, m/s", "kt")
        for share, speed in zip(found.percentile.values, found.value.values, strict=True):
            table.add_row(f"{share:g}", f"{speed:.2f}", f"{speed * 3600 / 1852:.1f}")
        console.print(table)
    for text, count in notes.most_common(_REASONS):
        console.print(f"  {count} × {text}", markup=False)
