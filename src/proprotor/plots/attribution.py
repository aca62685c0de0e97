"""Bars of the terms of the equations that drive or damp a mode, by the physical origin of the terms."""

from __future__ import annotations

from typing import Any

import numpy as np

from proprotor.errors import check_known
from proprotor.model.doubts import marked
from proprotor.plots.bars import centre_on_zero, name_bars, signed, write_beside
from proprotor.plots.canvas import axes_or_new, note, say_origin
from proprotor.plots.style import DAMPS, DRIVES, in_style
from proprotor.stability.sensitivity import damping_rate
from proprotor.typing import Axes, Dataset
from proprotor.units import KNOT, KTAS


@in_style
def plot_attribution(
    found: Dataset,
    mode: str | None = None,
    ax: Axes | None = None,
    *,
    count: int = 15,
) -> Axes:
    """Draw what each origin of terms adds to the damping of a mode, in percent of critical, to first order.

    A bar is the change of the damping ratio if all terms of one origin grew by 100 %, extrapolated from the rate at the
    present terms. Over all origins the changes sum to zero.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `Case.attribution`.
    mode : str, optional
        Name of the mode; not needed if the result has one mode only.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default.
    count : int
        Number of bars, the longest; one more bar is the sum of all others.

    Returns
    -------
    matplotlib.axes.Axes
        The given axes, or the new ones.

    Raises
    ------
    InputError
        If the mode is unknown, or if the result has several modes and none is named.
    """
    names = found.mode.values.tolist()
    if mode is None and len(names) == 1:
        mode = names[0]
    check_known("mode", mode, names, "mode")
    chosen = found.sel(mode=mode)
    value = np.asarray(chosen.eigenvalue.values)
    changes = 100 * damping_rate(value, chosen.contribution.values)
    bars = list(zip(chosen.origin.values.tolist(), changes.tolist(), strict=True))
    bars.sort(key=lambda bar: -abs(bar[1]))
    if len(bars) > count:
        bars = [*bars[:count], (f"all {len(bars) - count} others", float(sum(x for _, x in bars[count:])))]
    bars.sort(key=lambda bar: bar[1])
    ax = axes_or_new(ax, size=(8, 1.4 + 0.27 * len(bars)))
    _draw(ax, bars)
    ax.set_xlabel(f"Change of damping of {mode} per 100 % of the terms (% of critical)")
    ratio = 100 * float(-value.real / np.abs(value))
    doubt = found.warning.item()
    damping = marked(f"{ratio:.2f}", doubt)
    note(ax, f"{mode}: damping {damping} % of critical; the bars sum to zero, to first order")
    at = f"at {found.attrs['airspeed'] / KNOT:.4g} {KTAS}"
    say_origin(ax, found.attrs, [f"Doubtful {at}: {doubt}."] if doubt else ())
    return ax


def _draw(ax: Axes, bars: list[tuple[str, float]]) -> None:
    """Draw a bar for each origin, in the colour of terms that drive or of terms that damp."""
    places, values = np.arange(len(bars)), np.array([value for _, value in bars])
    for drives, colour, hatch, label in ((True, DRIVES, "////", "drives it"), (False, DAMPS, "", "damps it")):
        chosen = (values < 0) == drives
        style: dict[str, Any] = {"color": colour, "hatch": hatch, "edgecolor": "white", "linewidth": 0}
        ax.barh(places[chosen], values[chosen], height=0.7, label=label, **style)
    for place, value in enumerate(values.tolist()):
        write_beside(ax, place, value, signed(value))
    centre_on_zero(ax, 1.2 * max(np.abs(values).max(initial=0), 1e-12))
    name_bars(ax, [name for name, _ in bars])
    ax.set_ylim(-0.6, len(bars) - 0.4)
    ax.legend(loc="lower right")
