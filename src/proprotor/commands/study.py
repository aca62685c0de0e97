"""The command `proprotor study`: many designs of a case, as a table, as CSV or JSON, and into files."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from proprotor.commands import arguments, output
from proprotor.commands.waiting import waiting
from proprotor.errors import InputError
from proprotor.exchange.netcdf import check_path, load_results, save_results
from proprotor.files.json_text import json_text
from proprotor.files.output import check_place
from proprotor.model import stamp
from proprotor.model.doubts import marked
from proprotor.study import sampling
from proprotor.study.designs import AIRSPEED
from proprotor.study.study import study as study_of
from proprotor.study.study_file import is_study_file, read_study, repeated, save_study
from proprotor.study.uncertainty import distribution
from proprotor.study.variables import DEFAULT_QUANTITIES
from proprotor.tables.percentiles import percentile_text
from proprotor.tables.sobol_table import SHARES, SOBOL_COLUMNS, WHY_NOT, sobol_cells
from proprotor.tables.study_summary import study_summary
from proprotor.tables.study_table import StudyTable
from proprotor.typing import Dataset
from proprotor.units import KNOT, KTAS, speeds

_SAMPLES = ("latin-hypercube", "sobol", "saltelli")
_REASONS = 5  # most frequent reasons of failures that are printed
_MOST_ROWS = 20  # designs that are printed
_UNITS = ((1.0, ".2f"), (KNOT, ".1f"))  # of percentiles that are printed: m/s and knots
_OF_STUDY = (
    "case",
    "inputs",
    "airspeed",
    "quantities",
    "tolerance",
)  # arguments that are no options of the model
_RUN = (
    "case",
    "workers",
    "checkpoint",
    "out",
    "save",
    "csv",
    "as_json",
)  # what a repeated study may be given anew


@arguments.command()
@arguments.case_argument
@click.option(
    "--vary",
    "varied",
    multiple=True,
    type=arguments.InputValues(),
    metavar="INPUT=VALUES",
    help='Input that varies, by deck path, and its values: "rotor.precone=1:4:0.5 deg" or "=1 deg, 2 deg"; with '
    '--sample its limits: "=1:4 deg" or "=0.9:1.1 of deck". Repeatable.',
)
@arguments.range_option('Airspeeds with their unit: "160:460:20kt" or "300 kt".')
@click.option("--out", metavar="FILE", help="Write the results: a .nc file (netCDF).")
@click.option("--save", metavar="FILE", help="Write what is asked: a .toml file, which this command repeats.")
@click.option(
    "--sample", type=click.Choice(_SAMPLES), help="Draw a sample of the inputs instead of all combinations."
)
@click.option("--size", type=click.IntRange(1), default=256, show_default=True, help="Size of the sample.")
@click.option("--seed", type=click.IntRange(0), default=0, show_default=True, help="Seed of the sample.")
@click.option("--flutter", is_flag=True, help="Find the flutter speed of each design in the range.")
@click.option("--checkpoint", metavar="FOLDER", help="Folder that keeps finished batches, for a restart.")
@click.option("--workers", type=click.IntRange(1), help="Number of processes; by default one for each core.")
@output.output_options(csv="Write a row for each design.")
@arguments.model_options
def study(
    request: arguments.Request,
    outputs: output.Outputs,
    out: str | None,
    save: str | None,
    checkpoint: str | None,
    workers: int | None,
    **asked: Any,
) -> None:
    """Analyse stability and trim of many designs of a case.

    CASE is a bundled case or a TOML file; `proprotor describe` lists the inputs. A study with a checkpoint that was
    stopped goes on where it stopped when the same command runs again.

    In place of CASE, a file of --save, or the .nc file of --out, repeats its study.

    \b
    Examples:
      proprotor study xv15 --vary "rotor.precone=1:4:1 deg" --speed 160:460:20kt \\
        --flutter --csv designs.csv
      proprotor study xv15 --vary "rotor.precone=1:4 deg" \\
        --vary "support.chord_frequency=0.9:1.1 of deck" \\
        --sample latin-hypercube --size 1000 --speed 160:460:20kt --flutter \\
        --out study.nc --checkpoint batches
      proprotor study study.nc --csv designs.csv
    """
    files = {"results": out} | _outputs_in_file(request.name)
    files |= {name: given for name, given in (("results", out), ("csv", outputs.csv)) if given}
    _check_files(files, save)
    with waiting("Reading"):
        found = _repeated(request) or _asked(request, **asked)
    case, request = found["case"], found.pop("request")
    with output.one_message("--checkpoint", checkpoint):
        try:
            results = study_of(**found, workers=workers, checkpoint=checkpoint)
        except KeyboardInterrupt as stopped:
            if checkpoint is not None:
                stopped.add_note(
                    f"{checkpoint} keeps all finished batches, and the same command goes on with them"
                )
            raise
    with waiting("Writing"):
        table = StudyTable(results)
        _write(results, files, save)
        document = (
            output.about(case, request) | table.document() if outputs.as_json or "json" in files else {}
        )
    if in_file := files.get("json"):
        output.write("json", in_file, f"{json_text(document)}\n".encode())
    outputs._replace(csv=files.get("csv")).write(
        document=lambda: document | {"results": files["results"]},
        table=lambda: _print(results, table),
        csv=table.csv,
    )
    output.exit_without((results.reason == "").any())


def _outputs_in_file(name: str) -> dict[str, str]:
    """Return the files that a study file asks for."""
    return dict(read_study(name).get("outputs", {})) if is_study_file(name) else {}


def _check_files(files: Mapping[str, str | None], save: str | None) -> None:
    """Refuse files that cannot be written, before anything is analysed."""
    if files["results"]:
        output.check_writable("--out", files["results"])
        check_path(files["results"], "--out")
    if save:
        output.check_writable("--save", save)
        check_place(save, ".toml", "--save")
    for name in ("csv", "json"):
        if files.get(name) not in (None, "-"):
            output.check_writable(f"--{name}", files[name])


def _write(results: Dataset, files: Mapping[str, str | None], save: str | None) -> None:
    """Write the results of `--out`, and the study file of `--save` with the files that were written."""
    if out := files["results"]:
        with output.one_message("--out", out):
            save_results(results, out)
        click.echo(f"Wrote {out}", err=True)
    if save:
        with output.one_message("--save", save):
            save_study(results, save, {name: file for name, file in files.items() if file and file != "-"})
        click.echo(f"Wrote {save}", err=True)


def _repeated(request: arguments.Request) -> dict[str, Any] | None:
    """Return the arguments of the study of a file, in place of a case; None for a case.

    Raises
    ------
    InputError
        When the command changes what stands in the file.
    """
    file = Path(request.name)
    if is_study_file(file):
        source: Any = file
    elif file.suffix.lower() == ".nc" and file.is_file():
        source = load_results(file)
    else:
        return None
    context = click.get_current_context()
    for option in context.command.params:
        source_of = context.get_parameter_source(str(option.name))
        if source_of is ParameterSource.COMMANDLINE and option.name not in _RUN:
            raise InputError(option.opts[0], None, f"stands in the study of {file}: change it there")
    found = repeated(source, None, {})
    assert found is not None
    options = {name: value for name, value in found.items() if name not in _OF_STUDY}
    return found | {"request": arguments.Request(request.name, {}, options)}


def _asked(
    request: arguments.Request,
    varied: tuple[str, ...],
    speed: str | None,
    sample: str | None,
    size: int,
    seed: int,
    flutter: bool,
) -> dict[str, Any]:
    """Return the arguments of the study that the options of the command stand for."""
    if not varied:
        raise InputError("--vary", None, 'must be given at least once, such as "rotor.precone=1:4:1 deg"')
    case, plan = request.load(), _plan(varied, sample, size, seed)
    if (speed is None) != (AIRSPEED in plan.inputs):
        rule = 'must be given, such as "160:460:20kt", or airspeed must vary among the inputs'
        raise InputError("--speed", speed, rule)
    if speed is not None:
        speeds(speed, "--speed", stamp.one_density(case, plan.inputs))
    quantities = (*DEFAULT_QUANTITIES, *["flutter"] * flutter)
    found = {"case": case, "inputs": plan, "airspeed": speed, "quantities": quantities}
    return found | {"request": request} | dict(request.options)


def _plan(varied: tuple[str, ...], sample: str | None, size: int, seed: int) -> sampling.Plan:
    """Return the grid or sample of the inputs of `--vary`."""
    inputs = {}
    for text in varied:
        rule = 'must be an input and its values, such as "rotor.precone=1:4:0.5 deg"'
        path, values = arguments.name_and_value("--vary", text, rule)
        if path in inputs:
            raise InputError("--vary", text, "must not vary an input twice")
        listed = [value.strip() for value in values.split(",")]
        inputs[path] = (
            arguments.limits("--vary", text, values) if sample else listed if len(listed) > 1 else listed[0]
        )
    if sample is None:
        return sampling.grid(inputs)
    draw: Callable[..., sampling.Plan] = getattr(sampling, sample.replace("-", "_"))
    return draw(inputs, size, seed)


def _print(results: Dataset, table: StudyTable) -> None:
    out, found = output.console(), study_summary(results)
    out.print(f"{found['title']}: {found['points']} points, {found['failed']} failed")
    for text, count in list(found["reasons"].items())[:_REASONS]:
        out.print_hanging(f"  {count} × ", text)
    if "sample" not in results.attrs:
        _print_designs(table)
    if "flutter_speed" in results:
        _print_flutter(results, found)
    elif "points unstable" in found:
        damping = marked(f"{found['lowest damping (% of critical)']:.3g}", found["points doubtful"])
        out.print(f"{found['points unstable']} points unstable; lowest damping {damping} %")
    doubts = found["doubts of points"].items()
    output.print_footnotes(
        f"Doubtful at {count} of {found['points']} points: {text}." for text, count in doubts
    )
    for line in (*stamp.unusual_options(results.attrs), results.attrs["reservations"]):
        out.print(line)


def _print_designs(table: StudyTable) -> None:
    """Print a row for each of the first designs: its inputs and its flutter speed, or its lowest damping."""
    records = table.records()
    inputs = [head for head in table.inputs if head != "airspeed (m/s)"]
    rows = [(*(f"{record[head]:g}" for head in inputs), *_cells(record)) for record in records[:_MOST_ROWS]]
    flutter = "result" in records[0]
    heads = (KTAS, "Hz", "mode") if flutter else ("lowest damping, %", "Hz", "")
    output.print_table((*inputs, *heads), rows, text=heads[-1:])
    if len(records) > _MOST_ROWS:
        output.console().print(f"{len(records) - _MOST_ROWS} more designs: --csv writes all.")


def _cells(record: Mapping[str, Any]) -> tuple[str, str, str]:
    """Return what became of a design: speed or damping, frequency, and mode or why there is none."""
    failed = record["reason"] or record.get("note", "")
    if "result" not in record:
        damping, frequency = record["lowest damping (% of critical)"], record["lowest damping frequency (Hz)"]
        if damping is None:
            return "", "", failed
        return marked(f"{damping:.3g}", record["doubts"]), f"{frequency:.3f}", failed
    above, below, speed = (record[f"flutter speed{side} ({KTAS})"] for side in (" above", " below", ""))
    if above is not None:
        return f"> {above:.2f}", "", record["note"]
    if below is not None:
        return f"< {below:.2f}", "", record["note"]
    if speed is None:
        return "", "", failed
    return (
        marked(f"{speed:.2f}", record["warning"]),
        f"{record['flutter frequency (Hz)']:.3f}",
        record["flutter mode"],
    )


def _print_flutter(results: Dataset, found: Mapping[str, Any]) -> None:
    """Print percentiles of the flutter speeds of a sample, or the range of the flutter speeds of chosen designs."""
    out = output.console()
    if "sample" in results.attrs:
        _print_percentiles(results)
        _print_shares(found)
    elif found["flutter speeds found"]:
        low, high = (found[f"{end} flutter speed (m/s)"] / KNOT for end in ("lowest", "highest"))
        doubts = found["flutter speeds doubtful"]
        range_ = f"{marked(f'{low:.2f}', doubts)} to {marked(f'{high:.2f}', doubts)} {KTAS}"
        count = f"{found['flutter speeds found']} of {results.flutter_speed.size}"
        out.print(f"flutter speeds of {count} designs, {range_}")
    else:
        out.print("no flutter speed was found")
    for text, count in list(found["notes"].items())[:_REASONS]:
        out.print_hanging(f"  {count} × ", text)


def _print_shares(found: Mapping[str, Any]) -> None:
    """Print each input's share of the variance of a Saltelli sample with its interval, or why there is none."""
    if SHARES in found:
        doubts = found["doubts of the shares"]
        cells = (sobol_cells(record, doubts) for record in found[SHARES])
        output.print_table(SOBOL_COLUMNS, cells, text=SOBOL_COLUMNS[:1])
        half = f"± is half of an interval of {100 * found['confidence of the shares']:g} % confidence"
        treatment = found["treatment of the shares"]
        output.console().print(f"Shares of the variance; {half}. {treatment}")
    elif WHY_NOT in found:
        output.console().print(f"No shares of the variance: {found[WHY_NOT]}.")


def _print_percentiles(results: Dataset) -> None:
    try:
        found = distribution(results)
    except InputError:
        output.console().print("no flutter speed was found")
        return
    doubts = found.attrs["doubts"]
    rows = [
        (f"{share:g}", *(marked(percentile_text(found, place, unit, form), doubts) for unit, form in _UNITS))
        for place, share in enumerate(found.percentile.values)
    ]
    output.print_table(("% of designs", "flutter speed at most, m/s", KTAS), rows)
    if doubts:
        counted = f"{int(found.doubtful)} of {int(found.known)} flutter speeds"
        output.print_footnotes([f"Doubtful are {counted}: {doubts}."])
