"""The command `proprotor map`: in which part of the plane of two inputs a case is stable."""

from __future__ import annotations

from typing import Any, NamedTuple

import click
import numpy as np

from proprotor.case import Case
from proprotor.commands import arguments, output
from proprotor.commands.waiting import waiting
from proprotor.deck.input_values import shown_unit
from proprotor.deck.vary import inputs_at
from proprotor.errors import InputError
from proprotor.model import stamp
from proprotor.model.doubts import MARK, map_doubts, marked
from proprotor.study.sampling import grid
from proprotor.tables.csv_text import csv_of
from proprotor.tables.points import Quantity
from proprotor.typing import Array, Dataset
from proprotor.units import airspeed_unit, factor_to_si, speed_factor, speeds

_AIRSPEED = "airspeed"
_EXAMPLE = '"rotor.precone=0:5:0.25 deg"'
_MARKS = {"stable": ".", "unstable": "#", "failed": "x"}


class _Axis(NamedTuple):
    path: str
    values: Array  # SI
    unit: str  # as written
    factor: float  # the unit in SI units


def _axis_option(name: str, meaning: str) -> arguments.Option:
    """Return the option of one axis; `meaning` is the help."""
    values = arguments.InputValues()
    return click.option(name, required=True, type=values, metavar="INPUT=RANGE", help=meaning)


@arguments.command("map")
@arguments.case_argument
@_axis_option(
    "--x", f'Input on the axis across, by deck path, and its values: {_EXAMPLE} or "airspeed=100:400:10kt".'
)
@_axis_option("--y", "Input on the axis up, and its values, likewise.")
@click.option(
    "--speed", metavar="SPEED", help='Airspeed, if it is neither x nor y: "300 ktas" or "300 keas".'
)
@arguments.level_option
@arguments.points_option
@output.output_options(
    csv="Write a row for each point of the grid.", plot="Draw the boundary, the stable side shaded"
)
@arguments.model_options
def stability_map(
    request: arguments.Request,
    outputs: output.Outputs,
    x: str,
    y: str,
    speed: str | None,
    level: float,
    points: str | None,
) -> None:
    """Show where in the plane of two inputs a case is stable, and the boundary.

    CASE is a bundled case or a TOML file; `proprotor describe` lists the inputs. A point is stable if every mode is
    stable. Between neighbours of the grid of which only one is stable, the boundary is exact to rounding. The map does
    not show islands that are smaller than a cell of the grid.

    \b
    Examples:
      proprotor map xv15 --x airspeed=200:400:10kt \\
        --y "rotor.precone=0:5:0.5 deg" --plot map.png
      proprotor map xv15 --speed "350 kt" \\
        --x "support.beam_frequency=2:4:0.1 Hz" \\
        --y "support.modes[torsion].frequency=6:12:0.2 Hz" --csv map.csv
    """
    from proprotor.plots import plot_stability_map  # here, so that --help answers without it

    case = request.load()
    airspeed = None if speed is None else arguments.one_speed(speed, case)
    given = [_named(option, text) for option, text in (("--x", x), ("--y", y))]
    density = stamp.one_density(case, [path for path, _ in given])
    axes = (_axis("--x", *given[0], case, density), _axis("--y", *given[1], case, density))
    if axes[0].path == axes[1].path:
        raise InputError("--y", y, "must not be the input of --x")
    if airspeed is None and _AIRSPEED not in (axis.path for axis in axes):
        raise InputError("--speed", None, "must be given, or be --x or --y: airspeed=100:400:10kt")
    across, up = (_quantity(axis, case, density) for axis in axes)
    measured = arguments.points_of(points, outputs.plot, across, [up])
    with waiting("Analysing"):
        values = {axis.path: axis.values for axis in axes}
        found = case.stability_map(values, airspeed=airspeed, level=level, **request.options)
    units = {axis.path: axis.unit for axis in axes if axis.unit}
    outputs.write(
        document=lambda: output.about(case, request) | _document(found, axes, airspeed),
        table=lambda: _print(case, found, axes),
        csv=lambda: csv_of(records := _records(found, axes), list(records[0]), found.attrs),
        plot=lambda: output.with_origin(
            plot_stability_map(found, units=units, points=measured), case, list(values)
        ),
    )
    output.exit_without(np.isfinite(found.growth.values).any())


def _named(option: str, text: str) -> tuple[str, str]:
    """Return the input and the values of ``INPUT=RANGE``."""
    return arguments.name_and_value(option, text, f"must be an input and its values, such as {_EXAMPLE}")


def _axis(option: str, path: str, given: str, case: Case, density: float | None) -> _Axis:
    """Return the axis of an input and its values; `density` is that of all points, None where the points differ."""
    unit = arguments.unit_of(given)
    if path == _AIRSPEED:
        values, factor = speeds(given, option, density), float(speed_factor(unit, density))
        unit = airspeed_unit(unit)
    else:
        known = inputs_at(case, [path])
        values, unit = grid({path: given}).resolve(known).values[path], shown_unit(unit, known[path])
        factor = factor_to_si(given, unit, known[path].unit)
    if len(values) < 2:
        raise InputError(option, f"{path}={given}", f"must be a range, start:stop:step, such as {_EXAMPLE}")
    return _Axis(path, values, unit, factor)


def _quantity(axis: _Axis, case: Case, density: float | None) -> Quantity:
    """Return what a column of points for an axis may be."""
    if axis.path == _AIRSPEED:
        return arguments.airspeed_points(density)
    return Quantity(axis.path, inputs_at(case, [axis.path])[axis.path].unit)


def _label(axis: _Axis) -> str:
    return f"{axis.path} ({axis.unit})" if axis.unit else axis.path


def _written(axis: _Axis) -> list[float]:
    """Return the values in the unit of the command line, without the rounding of the conversion."""
    return [float(f"{value:.10g}") for value in axis.values / axis.factor]


def _records(found: Dataset, axes: tuple[_Axis, _Axis]) -> list[dict[str, Any]]:
    """Return a record for each point of the grid, row by row."""
    x, y = axes
    columns = (_label(x), _label(y), "largest growth (1/s)", "frequency (rad/s)", "warning", "failure")
    places = ((across, up) for up in _written(y) for across in _written(x))
    names = ("growth", "frequency", "warning", "reason")
    values = zip(
        *(found[name].transpose(y.path, x.path).values.ravel().tolist() for name in names), strict=True
    )
    return [
        dict(zip(columns, (*at, *of_point), strict=True)) for at, of_point in zip(places, values, strict=True)
    ]


def _lines(found: Dataset, axes: tuple[_Axis, _Axis]) -> list[tuple[list[list[float]], list[str]]]:
    """Return the boundary as lines of points (x, y) in the units of the axes, with the warnings of the points."""
    vertices = found.boundary.sel(axis=[axis.path for axis in axes]).values
    vertices = vertices / np.array([axis.factor for axis in axes])
    warnings = found.boundary_warning.values
    good = np.isfinite(vertices).all(axis=1)
    parts = np.split(np.arange(len(vertices)), np.flatnonzero(~good))
    return [
        (vertices[line].tolist(), warnings[line].tolist()) for part in parts if len(line := part[good[part]])
    ]


def _document(found: Dataset, axes: tuple[_Axis, _Axis], airspeed: float | None) -> dict[str, Any]:
    lines = _lines(found, axes)
    return {
        "level (damping ratio)": float(found.attrs["level"]),
        "airspeed (m/s)": airspeed,
        "x": _label(axes[0]),
        "y": _label(axes[1]),
        "boundary": [line for line, _ in lines],
        "boundary warnings": [warnings for _, warnings in lines],
        "points": _records(found, axes),
        "eigen-solves": int(found.attrs["eigen_solves"]),
    }


def _print(case: Case, found: Dataset, axes: tuple[_Axis, _Axis]) -> None:
    output.print_head(case, found.attrs, [axis.path for axis in axes])
    x, y = axes
    growth = found.growth.transpose(y.path, x.path).values
    state = np.where(np.isnan(growth), "failed", np.where(growth > 0, "unstable", "stable"))
    warnings = found.warning.transpose(y.path, x.path).values
    doubtful = bool((warnings != "").any())
    out = output.console()
    up, across = _written(y), _written(x)
    width = max(len(f"{value:g}") for value in up)
    out.print(_label(y))
    for row in reversed(range(len(up))):
        marks = "".join(
            _MARKS[str(entry)] + (marked("", warning) or " ") * doubtful
            for entry, warning in zip(state[row], warnings[row], strict=True)
        )
        out.print(f"{up[row]:>{width}g} {marks}", soft_wrap=True)
    out.print(f"{'':>{width}} {_label(x)} from {across[0]:g} to {across[-1]:g}", soft_wrap=True)
    level = 100 * float(found.attrs["level"])
    beyond = f"below {level:g} % of critical" if level else "unstable"
    doubt = f"   {MARK} doubtful" if doubtful else ""
    out.print(f"\n. stable   # {beyond}   x could not be analysed{doubt}\n")
    counts = {name: int((state == name).sum()) for name in _MARKS}
    out.print(", ".join(f"{count} points {name}" for name, count in counts.items()), style="bold")
    for number, (line, doubts) in enumerate(_lines(found, axes), start=1):
        ends = " to ".join(
            marked(f"({line[place][0]:.4g}, {line[place][1]:.4g})", doubts[place]) for place in (0, -1)
        )
        count = sum(map(bool, doubts))
        out.print(f"boundary {number}: {len(line)} points from {ends}" + f", {count} doubtful" * bool(count))
    output.print_footnotes(map_doubts(found))
