"""What moves the flutter speed most: a bar for each input, the longest on top."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from proprotor.errors import InputError, unknown_name
from proprotor.model.doubts import marked
from proprotor.plots.canvas import axes_or_new, grid, note, say_origin, signed
from proprotor.plots.input_names import short_names
from proprotor.plots.style import DAMPS, DRIVES, LABEL_SIZE, STATUS_HATCHES
from proprotor.typing import Array
from proprotor.units import factor_to_si

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

_TOLD = {"flutter_speed": "flutter speed", "damping": "damping"}


class _Bar(NamedTuple):
    input: str
    low: float  # what the lower end of the range does
    high: float


def plot_sensitivity(
    found: xarray.Dataset,
    ax: Axes | None = None,
    *,
    percent: float = 1.0,
    ranges: Mapping[str, tuple[float, float]] | None = None,
    count: int = 15,
    unit: str = "kt",
) -> Axes:
    """Draw how much inputs move the flutter speed, or the damping of a mode, to first order.

    Hatches tell which inputs were not read in a source.

    Parameters
    ----------
    found : xarray.Dataset
        Of `Case.sensitivity`, of the flutter speed or of the damping of one mode.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default.
    percent : float
        Every input grows by so many percent of itself, where no ranges are given; those that are zero are left out.
    ranges : mapping of str to (low, high), optional
        Of some inputs by path, in SI: what both ends of each would do, a bar to either side.
    count : int
        Bars at most, the longest.
    unit : str
        Of the speed. Damping is in percent of critical.

    Returns
    -------
    matplotlib.axes.Axes
        The one given, or the new one.

    Raises
    ------
    InputError
        For derivatives of eigenvalues or of several modes, an unknown input, or a unit that is not one of speed.
    """
    scale, told = _scale(found, unit)
    bars = _of_percent(found, percent, scale) if ranges is None else _of_ranges(found, ranges, scale)
    bars = sorted(bars, key=lambda bar: max(abs(bar.low), abs(bar.high)), reverse=True)
    shown = bars[:count][::-1]
    ax = axes_or_new(ax, size=(8, 1.4 + 0.27 * len(shown)))
    status = dict(zip(found.input.values.tolist(), found.status.values.tolist(), strict=True))
    _draw(ax, shown, status, both=ranges is not None)
    ax.axvline(0, color="black", linewidth=0.8)
    reach = max((abs(value) for bar in shown for value in bar[1:]), default=1.0) or 1.0
    ax.set_xlim(-1.25 * reach, 1.25 * reach)
    how = "over the range of each input" if ranges is not None else f"for {percent:+g} % of each input"
    ax.set_xlabel(f"Change of {told} {how}")
    if len(shown) < len(bars):
        note(ax, f"The {len(shown)} of {len(bars)} inputs that move it most; to first order")
    _legend(ax, {status[bar.input] for bar in shown}, both=ranges is not None)
    doubt = found.warning.item()
    say_origin(ax, found.attrs, [f"Doubtful: {doubt}."] if doubt else ())
    return ax


def _scale(found: xarray.Dataset, unit: str) -> tuple[float, str]:
    """Units of the plot per SI unit, and what it is that changes."""
    of = str(found.attrs.get("of"))
    if of not in _TOLD:
        raise InputError("found", of, f"must be derivatives of {' or '.join(_TOLD)}")
    if found.derivative.size != found.sizes["input"]:
        raise InputError("found", f"{found.sizes['mode']} modes", "must be of one mode: choose it with mode=")
    if of == "damping":
        mode = str(found.mode.values.reshape(-1)[0])
        return 100.0, f"damping of {mode} (% of critical)"
    factor = factor_to_si(unit, unit, "m/s")
    value = marked(f"{found.attrs['value'] / factor:.0f}", found.warning.item())
    return 1 / factor, f"flutter speed, {value} {unit} ({found.attrs['mode']}), in {unit}"


def _derivatives(found: xarray.Dataset) -> dict[str, float]:
    values = found.derivative.values.reshape(-1).tolist()
    return dict(zip(found.input.values.tolist(), values, strict=True))


def _of_percent(found: xarray.Dataset, percent: float, scale: float) -> list[_Bar]:
    # The input's own size, not its value: a twist of -2 grows to -2.02, and what rises with it is to the right.
    values: Array = found.value.values
    changes = [
        rate * value * percent / 100 * scale
        for rate, value in zip(_derivatives(found).values(), values.tolist(), strict=True)
    ]
    return [
        _Bar(path, change, change)
        for path, change, value in zip(found.input.values.tolist(), changes, values.tolist(), strict=True)
        if value != 0
    ]


def _of_ranges(found: xarray.Dataset, ranges: Mapping[str, tuple[float, float]], scale: float) -> list[_Bar]:
    rates = _derivatives(found)
    values = dict(zip(found.input.values.tolist(), found.value.values.tolist(), strict=True))
    for path in ranges:
        if path not in rates:
            raise InputError("ranges", path, unknown_name(path, rates, "input"))
    return [
        _Bar(path, *(scale * rates[path] * (end - values[path]) for end in ends))
        for path, ends in ranges.items()
    ]


def _draw(ax: Axes, bars: list[_Bar], status: Mapping[str, str], *, both: bool) -> None:
    places = np.arange(len(bars))
    style: dict[str, Any] = {"height": 0.7, "edgecolor": "white", "linewidth": 0.0}
    hatches = [STATUS_HATCHES.get(status[bar.input], "") for bar in bars]
    for side, end in enumerate(("low", "high") if both else ("high",)):
        values = [getattr(bar, end) for bar in bars]
        colours = [(DRIVES, DAMPS)[side if both else int(value >= 0)] for value in values]
        ax.barh(places, values, color=colours, hatch=hatches, **style)
    for place, bar in zip(places.tolist(), bars, strict=True):
        _tell(ax, place, sorted({bar.low, bar.high} - {0.0}))
    ax.set_yticks(places, short_names([bar.input for bar in bars]), fontsize=LABEL_SIZE)
    ax.set_ylim(-0.6, len(bars) - 0.4)
    grid(ax)
    ax.grid(visible=False, axis="y")


def _tell(ax: Axes, place: int, values: list[float]) -> None:
    """Numbers beside the ends of a bar; of two ends on the same side, both beside the farther one."""
    for right in (False, True):
        own = [value for value in values if (value > 0) == right]
        if own:
            farthest = max(own, key=abs)
            style: dict[str, Any] = {"fontsize": 7, "va": "center", "ha": "left" if right else "right"}
            style |= {"textcoords": "offset points", "xytext": (3 if right else -3, 0)}
            ax.annotate(", ".join(signed(value) for value in own), (farthest, place), **style)


def _legend(ax: Axes, statuses: set[str], *, both: bool) -> None:
    from matplotlib.patches import Patch

    names = ("lower end of the range", "upper end") if both else ("lowers it", "raises it")
    handles = [Patch(color=colour, label=name) for colour, name in zip((DRIVES, DAMPS), names, strict=True)]
    for status, hatch in STATUS_HATCHES.items():
        if hatch and status in statuses:
            handles.append(Patch(facecolor="0.45", edgecolor="white", hatch=hatch, linewidth=0, label=status))
    ax.legend(handles=handles, fontsize=7, loc="lower right", framealpha=0.95)
