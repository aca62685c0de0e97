"""Results of a study of a sample: how a result is distributed, and which inputs cause its variance."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import cycle
from typing import Any

import numpy as np

from proprotor.model.stamp import density_of
from proprotor.plots.bars import name_bars
from proprotor.plots.canvas import axes_or_new, grid, note, say_origin
from proprotor.plots.input_names import short_names
from proprotor.plots.line_of_sweep import axis_of
from proprotor.plots.style import COLOURS, LABEL_SIZE, in_style, white_box
from proprotor.study.uncertainty import distribution
from proprotor.tables.percentiles import percentile_text
from proprotor.typing import Axes, Dataset

_BEYOND = {"above": "stable throughout the airspeeds", "below": "unstable from the lowest airspeed on"}
_DASHES = ("--", "-", "-.", ":")


@in_style
def plot_distribution(
    results: Dataset,
    ax: Axes | None = None,
    *,
    of: str = "flutter_speed",
    percentiles: Sequence[float] = (5, 50, 95),
    unit: str | None = None,
    bins: int | str = "auto",
) -> Axes:
    """Draw how a result is distributed over the designs of a sample, with percentiles.

    Parameters
    ----------
    results : xarray.Dataset
        Study of a sample, as for `proprotor.distribution`.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default.
    of : str
        Name of a variable with one number for each design.
    percentiles : sequence of float
        0 to 100, dimensionless. A percentile that lies among designs beyond the range of the study has no line: the
        note above the axes gives its bounds and counts these designs.
    unit : str, optional
        Unit of the result; "ktas" by default for speeds.
    bins : int or str
        As `numpy.histogram` takes them.

    Returns
    -------
    matplotlib.axes.Axes
        The given axes, or the new ones.

    Raises
    ------
    InputError
        As `proprotor.distribution`, and for a unit that does not fit the result.
    """
    found = distribution(results, of, percentiles)
    values, si = results[of].values.astype(float), results[of].attrs.get("units", "")
    axis = axis_of(of, values, si, unit, density_of(results.attrs))
    known = axis.values[np.isfinite(axis.values)]
    ax = axes_or_new(ax, size=(7, 4.5))
    heights, edges = np.histogram(known, bins)
    counted = int(sum(int(found[name]) for name in ("known", "above", "below")))
    share = 100 * heights / counted
    bar: dict[str, Any] = {"align": "edge", "color": COLOURS[6], "edgecolor": "white", "linewidth": 0.5}
    ax.bar(edges[:-1], share, np.diff(edges), **bar)
    top = float(share.max(initial=0)) or 1.0
    ax.set_ylim(0, 1.2 * top)
    values = (found.value.values / axis.factor).tolist()
    for percentile, value, dashes in zip(percentiles, values, cycle(_DASHES), strict=False):
        if np.isfinite(value):
            ax.axvline(value, color="black", linewidth=1.2, linestyle=dashes)
            style: dict[str, Any] = {"fontsize": LABEL_SIZE, "ha": "center", "va": "top"}
            ax.text(value, 1.18 * top, f"{percentile:g} %\n{value:.4g}", bbox=white_box(1), **style)
    ax.set(xlabel=axis.label, ylabel="Share of the designs (%)")
    grid(ax)
    others = [f"{int(found[name])} {text}" for name, text in _BEYOND.items() if int(found[name])]
    bounds = [
        f"; {percentile:g} %: {percentile_text(found, place, axis.factor, '.4g')}"
        for place, percentile in enumerate(percentiles)
        if not np.isfinite(values[place])
    ]
    failed = f"; {int(found.failed)} failed and are left out" if int(found.failed) else ""
    note(
        ax,
        f"{counted} designs"
        + (f", of them {', '.join(others)}" if others else "")
        + failed
        + "".join(bounds),
    )
    say_origin(ax, found.attrs, _doubts(found))
    return ax


def _doubts(found: Dataset) -> list[str]:
    """Return a sentence on the doubtful designs behind a distribution or shares of variance, if any."""
    text = found.attrs.get("doubts")
    return [f"Doubtful for {int(found.doubtful)} designs: {text}."] if text else []


@in_style
def plot_sobol(indices: Dataset, ax: Axes | None = None, *, count: int = 15) -> Axes:
    """Draw each input's share of the variance, alone and with its interactions, with confidence intervals.

    Parameters
    ----------
    indices : xarray.Dataset
        Result of `proprotor.sobol_indices`.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default.
    count : int
        Number of inputs at most, the inputs with the largest total shares.

    Returns
    -------
    matplotlib.axes.Axes
        The given axes, or the new ones.
    """
    order = np.argsort(-indices.total.values)[:count][::-1]
    shown = indices.isel(input=order)
    ax = axes_or_new(ax, size=(7, 1.6 + 0.42 * len(order)))
    places = np.arange(len(order))
    for name, label, offset, colour, hatch in (
        ("total", "with all its interactions", 0.2, COLOURS[1], ""),
        ("first", "alone", -0.2, COLOURS[5], "////"),
    ):
        error: dict[str, Any] = {"ecolor": "black", "elinewidth": 0.9, "capsize": 2.5}
        style: dict[str, Any] = {"color": colour, "hatch": hatch, "edgecolor": "white", "linewidth": 0}
        values, half = 100 * shown[name].values, 100 * shown[f"{name}_half_interval"].values
        ax.barh(places + offset, values, 0.38, xerr=half, error_kw=error, label=label, **style)
    ax.axvline(0, color="black", linewidth=0.8)
    name_bars(ax, short_names(shown.input.values.tolist()))
    result = str(indices.attrs.get("of", "the result")).replace("_", " ")
    ax.set_xlabel(f"Share of the variance of {result} (%)")
    ax.legend(loc="lower right")
    if len(order) < indices.sizes["input"]:
        note(ax, f"The {len(order)} of {indices.sizes['input']} inputs with the largest shares")
    say_origin(ax, indices.attrs, _doubts(indices))
    return ax
