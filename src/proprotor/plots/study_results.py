"""What a study of a sample says of its result: how it is distributed, and which inputs are behind that."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from proprotor.plots.canvas import axes_or_new, grid, note, say_origin
from proprotor.plots.input_names import short_names
from proprotor.plots.line_of_sweep import axis_of
from proprotor.plots.style import COLOURS, LABEL_SIZE
from proprotor.study.uncertainty import distribution

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

_DASHES = ("--", "-", "-.", ":")


def plot_distribution(
    results: xarray.Dataset,
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
        A study of a sample, as for `proprotor.distribution`.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default.
    of : str
        A variable with one number for each design.
    percentiles : sequence of float
        0 to 100, dimensionless. Those that lie among designs beyond the range of the study have no line; the note
        above the axes counts these designs.
    unit : str, optional
        Of the result; "kt" by default for speeds.
    bins : int or str
        As `numpy.histogram` takes them.

    Returns
    -------
    matplotlib.axes.Axes
        The one given, or the new one.

    Raises
    ------
    InputError
        As `proprotor.distribution`, and for a unit that is not one of the result.
    """
    found = distribution(results, of, percentiles)
    axis = axis_of(of, results[of].values.astype(float), results[of].attrs.get("units", ""), unit)
    known = axis.values[np.isfinite(axis.values)]
    ax = axes_or_new(ax, size=(7, 4.5))
    heights, edges = np.histogram(known, bins)
    counted = int(sum(int(found[name]) for name in ("known", "above", "below")))
    share = 100 * heights / counted
    ax.bar(
        edges[:-1], share, np.diff(edges), align="edge", color=COLOURS[6], edgecolor="white", linewidth=0.5
    )
    top = float(share.max(initial=0)) or 1.0
    ax.set_ylim(0, 1.2 * top)
    for place, (percentile, value) in enumerate(
        zip(percentiles, found.value.values / axis.factor, strict=True)
    ):
        if np.isfinite(value):
            ax.axvline(value, color="black", linewidth=1.2, linestyle=_DASHES[place % len(_DASHES)])
            box: dict[str, Any] = {"facecolor": "white", "edgecolor": "none", "pad": 1}
            style: dict[str, Any] = {"fontsize": LABEL_SIZE, "ha": "center", "va": "top", "bbox": box}
            ax.text(value, 1.18 * top, f"{percentile:g} %\n{value:.4g}", **style)
    ax.set_xlabel(axis.label)
    ax.set_ylabel("Share of the designs (%)")
    grid(ax)
    others = [f"{int(found[name])} {told}" for name, told in _BEYOND.items() if int(found[name])]
    note(ax, f"{counted} designs" + (f", of them {', '.join(others)}" if others else "") + _failed(found))
    say_origin(ax, found.attrs, _doubts(found))
    return ax


def _doubts(found: xarray.Dataset) -> list[str]:
    """What is doubtful in a distribution, or in shares of its variance."""
    text = found.attrs.get("doubts")
    return [f"Doubtful for {int(found.doubtful)} designs: {text}."] if text else []


_BEYOND = {"above": "stable throughout the airspeeds", "below": "unstable from the lowest airspeed on"}


def _failed(found: xarray.Dataset) -> str:
    return f"; {int(found.failed)} failed and are left out" if int(found.failed) else ""


def plot_sobol(indices: xarray.Dataset, ax: Axes | None = None, *, count: int = 15) -> Axes:
    """Draw each input's share of the variance, alone and with its interactions, with confidence intervals.

    Parameters
    ----------
    indices : xarray.Dataset
        Of `proprotor.sobol_indices`.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default.
    count : int
        Inputs at most, those with the largest total share.

    Returns
    -------
    matplotlib.axes.Axes
        The one given, or the new one.
    """
    order = np.argsort(-indices.total.values)[:count][::-1]
    shown = indices.isel(input=order)
    ax = axes_or_new(ax, size=(7, 1.6 + 0.42 * len(order)))
    places = np.arange(len(order))
    for name, told, offset, colour, hatch in (
        ("total", "with all its interactions", 0.2, COLOURS[1], ""),
        ("first", "alone", -0.2, COLOURS[5], "////"),
    ):
        error: dict[str, Any] = {"ecolor": "black", "elinewidth": 0.9, "capsize": 2.5}
        style: dict[str, Any] = {"color": colour, "hatch": hatch, "edgecolor": "white", "linewidth": 0}
        values, half = 100 * shown[name].values, 100 * shown[f"{name}_half_interval"].values
        ax.barh(places + offset, values, 0.38, xerr=half, error_kw=error, label=told, **style)
    ax.axvline(0, color="black", linewidth=0.8)
    ax.set_yticks(places, short_names(shown.input.values.tolist()), fontsize=LABEL_SIZE)
    ax.set_xlabel(
        f"Share of the variance of {str(indices.attrs.get('of', 'the result')).replace('_', ' ')} (%)"
    )
    grid(ax)
    ax.grid(visible=False, axis="y")
    ax.legend(fontsize=LABEL_SIZE, loc="lower right")
    if len(order) < indices.sizes["input"]:
        note(ax, f"The {len(order)} of {indices.sizes['input']} inputs with the largest shares")
    say_origin(ax, indices.attrs, _doubts(indices))
    return ax
