"""Bars of the coordinates that take part in a mode."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError, check_known
from proprotor.plots.bars import name_bars
from proprotor.plots.canvas import along, axes_or_new, say_origin
from proprotor.plots.line_of_sweep import positions, written
from proprotor.plots.style import COLOURS, in_style
from proprotor.typing import Array, Axes, Dataset

_LEAST = 0.01  # smallest share with which a coordinate has bars of its own
_HATCHES = ("", "////", "....", "xxxx", "\\\\\\\\")


@in_style
def plot_participation(
    sweep: Dataset,
    mode: str,
    ax: Axes | None = None,
    *,
    at: ArrayLike | None = None,
    unit: str | None = None,
) -> Axes:
    """Draw the share of each coordinate in a mode, at one or several points of a sweep.

    Parameters
    ----------
    sweep : xarray.Dataset
        Result of `Case.sweep`, along airspeeds or one input.
    mode : str
        Name of the mode.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default.
    at : float or sequence of float, optional
        At most five airspeeds, or values of the input, in `unit`. The plot shows and names the nearest points of the
        sweep that could be analysed; by default the first and the last such point.
    unit : str, optional
        Unit of `at`; "ktas" by default for airspeeds.

    Returns
    -------
    matplotlib.axes.Axes
        The given axes, or the new ones.

    Raises
    ------
    InputError
        For an unknown mode or unit, too many points, or a mode that exists at no point.
    """
    check_known("mode", mode, sweep.mode.values.tolist(), "mode")
    line = positions(sweep, unit)
    chosen = sweep.participation.sel(mode=mode).values
    points = _nearest(line.values, np.isfinite(chosen).all(axis=-1), at)
    dofs, shares = _largest(sweep.dof.values.tolist(), chosen[points])
    ax = axes_or_new(ax, size=(7, 1.3 + (0.1 + 0.13 * len(points)) * len(dofs)))
    height = 0.84 / len(points)
    for place, point in enumerate(points):
        style: dict[str, Any] = {"color": COLOURS[1 + place], "hatch": _HATCHES[place], "edgecolor": "white"}
        where = np.arange(len(dofs)) + height * (place - (len(points) - 1) / 2)
        label = f"{line.values[point]:.4g} {written(line.unit)}".strip()
        ax.barh(where, 100 * shares[place], height=height, linewidth=0, label=label, **style)
    name_bars(ax, dofs)
    ax.set_ylim(len(dofs) - 0.4, -0.6)
    ax.set_xlabel(f"Participation in the mode “{mode}” (%)")
    ax.set_xlim(0, None)
    title = "Airspeed" if line.name == "airspeed" else line.label.partition(" (")[0]
    ax.legend(title=title, loc="lower right")
    say_origin(ax, sweep.attrs, along(sweep.isel({line.name: points}), line))
    return ax


def _largest(dofs: list[str], shares: Array) -> tuple[list[str], Array]:
    """Return names and shares (points, names) of coordinates with a share of note, and of all others together."""
    counts: Array = np.asarray((shares >= _LEAST).any(axis=0))
    names = [name.replace("_", " ") for name, own in zip(dofs, counts.tolist(), strict=True) if own]
    if counts.all():
        return names, shares
    rest = shares[:, ~counts].sum(axis=1, keepdims=True)
    return [*names, f"{int((~counts).sum())} others"], np.concatenate([shares[:, counts], rest], axis=1)


def _nearest(values: Array, works: Array, at: ArrayLike | None) -> list[int]:
    """Return the points that work nearest to the wanted values, each once."""
    good = np.flatnonzero(works)
    if not len(good):
        raise InputError("sweep", None, "has no point at which this mode exists")
    wanted = values[good[[0, -1]]] if at is None else np.atleast_1d(np.asarray(at, dtype=float))
    points = list(dict.fromkeys(int(good[np.abs(values[good] - value).argmin()]) for value in wanted))
    if len(points) > len(_HATCHES):
        raise InputError("at", len(points), f"must be at most {len(_HATCHES)} points")
    return points
