"""Outputs over time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from proprotor.errors import InputError
from proprotor.plots.canvas import axes_or_new, grid, note, say_origin, write_headline
from proprotor.plots.input_names import output_name
from proprotor.plots.line_of_sweep import written
from proprotor.plots.style import in_style, line_style
from proprotor.stability import places_of
from proprotor.typing import Array, Axes, Dataset


@in_style
def plot_time_response(
    found: Dataset, ax: Axes | None = None, *, outputs: Sequence[str] | str | None = None
) -> Axes:
    """Draw outputs of one unit over time, a line for each output and gust.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `proprotor.responses.time_response.time_response` or
        `proprotor.responses.discrete_gust.discrete_gust`, at one airspeed.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default.
    outputs : sequence of str, optional
        Names of outputs of one unit; the first output, force_x where there is one, by default.

    Returns
    -------
    matplotlib.axes.Axes
        The given axes, or the new ones.

    Raises
    ------
    InputError
        For an unknown output, outputs of several units, and several airspeeds.
    """
    known = tuple(found.output.values.tolist())
    columns = places_of(outputs or ["force_x" if "force_x" in known else known[0]], known, "outputs")
    units = dict.fromkeys(str(found.output_unit.values[column]) for column in columns)
    if len(units) > 1:
        raise InputError("outputs", ", ".join(known[column] for column in columns), "must have one unit")
    (unit,) = units
    gusts = found.gradient.values.tolist() if "gradient" in found.dims else [None]
    response = found.response if "gradient" in found.dims else found.response.expand_dims("gradient")
    if response.ndim != 3:
        raise InputError("found", f"{response.ndim} axes", "must be at one airspeed: found.isel(airspeed=0)")
    response = response.transpose("gradient", "time", "output")
    ax = axes_or_new(ax)
    for row, gradient in enumerate(gusts):
        for place, column in enumerate(columns):
            style = line_style(row + place) | {"marker": "", "linewidth": 1.4}
            of_gust = "" if gradient is None else f"H = {gradient:.3g} m"
            label = ", ".join(
                filter(None, (output_name(known[column]) if len(columns) > 1 or not of_gust else "", of_gust))
            )
            ax.plot(found.time.values, response.values[row, :, column], label=label, **style)
    ax.axhline(0, color="black", linewidth=0.6)
    names = ", ".join(output_name(known[column]) for column in columns)
    ax.set(xlabel="Time (s)", ylabel=f"{names[:1].upper()}{names[1:]} ({written(unit)})")
    ax.margins(x=0)
    grid(ax)
    ax.legend()
    if "gradient" in found.dims:
        note(ax, "H: distance in which a gust grows from nothing to its full speed")
        write_headline(ax, _largest(response.values[..., columns], found.gradient.values, unit))
    say_origin(ax, found.attrs, filter(None, [str(found.warning.item())]))
    return ax


def _largest(values: Array, gradients: Array, unit: str) -> str:
    """Return the largest of responses (gradients, times, outputs), and the gust that has it."""
    peaks = np.nan_to_num(np.abs(values)).max(axis=(1, 2))
    place = int(peaks.argmax())
    largest = f"{float(f'{peaks[place]:.3g}'):,g}"  # without an exponent
    return f"largest: {largest} {written(unit)}, in the gust with H = {gradients[place]:.3g} m"
