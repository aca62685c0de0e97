"""Tornado plot: a bar for each input that moves the flutter speed or a damping, the longest on top."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from proprotor.errors import InputError, check_known
from proprotor.model.doubts import marked
from proprotor.model.stamp import density_of
from proprotor.plots.bars import centre_on_zero, name_bars, signed, write_beside
from proprotor.plots.canvas import axes_or_new, note, say_origin
from proprotor.plots.input_names import short_names
from proprotor.plots.style import DAMPS, DRIVES, STATUS_HATCHES, in_style
from proprotor.typing import Axes, Dataset
from proprotor.units import airspeed_unit, speed_factor

_QUANTITIES = ("flutter_speed", "damping")


class _Bar(NamedTuple):
    input: str
    low: float  # change at the lower end of the range of the input
    high: float


@in_style
def plot_sensitivity(
    found: Dataset,
    ax: Axes | None = None,
    *,
    percent: float = 1.0,
    ranges: Mapping[str, tuple[float, float]] | None = None,
    count: int = 15,
    unit: str = "kt",
) -> Axes:
    """Draw how much inputs move the flutter speed, or the damping of a mode, to first order.

    Hatches mark inputs that were not read in a source.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `Case.sensitivity` for the flutter speed or the damping of one mode.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default.
    percent : float
        Growth of every input, in percent of itself, if no ranges are given; inputs that are zero have no bar.
    ranges : mapping of str to (low, high), optional
        Ranges of some inputs by path, in SI units: a bar shows the change at both ends of the range of an input.
    count : int
        Number of bars at most, the longest.
    unit : str
        Unit of the flutter speed. Damping is in percent of critical.

    Returns
    -------
    matplotlib.axes.Axes
        The given axes, or the new ones.

    Raises
    ------
    InputError
        For derivatives of eigenvalues or of several modes, an unknown input, or a unit that is no unit of speed.
    """
    scale, changing = _scale(found, unit)
    bars = _of_percent(found, percent, scale) if ranges is None else _of_ranges(found, ranges, scale)
    bars = sorted(bars, key=lambda bar: max(abs(bar.low), abs(bar.high)), reverse=True)
    shown = bars[:count][::-1]
    ax = axes_or_new(ax, size=(8, 1.4 + 0.27 * len(shown)))
    status = dict(zip(found.input.values.tolist(), found.status.values.tolist(), strict=True))
    _draw(ax, shown, status, both=ranges is not None)
    centre_on_zero(ax, 1.25 * (max((abs(value) for bar in shown for value in bar[1:]), default=1.0) or 1.0))
    how = "over the range of each input" if ranges is not None else f"for {percent:+g} % of each input"
    ax.set_xlabel(f"Change of {changing} {how}")
    if len(shown) < len(bars):
        note(ax, f"The {len(shown)} of {len(bars)} inputs that move it most; to first order")
    _legend(ax, {status[bar.input] for bar in shown}, both=ranges is not None)
    doubt = found.warning.item()
    say_origin(ax, found.attrs, [f"Doubtful: {doubt}."] if doubt else ())
    return ax


def _scale(found: Dataset, unit: str) -> tuple[float, str]:
    """Return the units of the plot in one SI unit, and the name of the quantity that changes."""
    of = str(found.attrs.get("of"))
    if of not in _QUANTITIES:
        raise InputError("found", of, f"must be derivatives of {' or '.join(_QUANTITIES)}")
    if found.derivative.size != found.sizes["input"]:
        raise InputError("found", f"{found.sizes['mode']} modes", "must be of one mode: choose it with mode=")
    if of == "damping":
        return 100.0, f"damping of {found.mode.values.reshape(-1)[0]} (% of critical)"
    unit, factor = airspeed_unit(unit), float(speed_factor(unit, density_of(found.attrs), field="unit"))
    value = marked(f"{found.attrs['value'] / factor:.0f}", found.warning.item())
    return 1 / factor, f"flutter speed, {value} {unit} ({found.attrs['mode']}), in {unit}"


def _of_percent(found: Dataset, percent: float, scale: float) -> list[_Bar]:
    """Return a bar for each input that is not zero: its growth in size, so that a twist of -2 grows to -2.02."""
    values = found.value.values
    changes = found.derivative.values.reshape(-1) * values * percent / 100 * scale
    found_for = zip(found.input.values.tolist(), values, changes, strict=True)
    return [_Bar(path, change, change) for path, value, change in found_for if value]


def _of_ranges(found: Dataset, ranges: Mapping[str, tuple[float, float]], scale: float) -> list[_Bar]:
    """Return a bar for each given range: the changes at both ends, from the present value of the input."""
    places = {path: place for place, path in enumerate(found.input.values.tolist())}
    for path in ranges:
        check_known("ranges", path, places, "input")
    rates, values = found.derivative.values.reshape(-1), found.value.values
    return [
        _Bar(path, *(float(scale * rates[places[path]] * (end - values[places[path]])) for end in ends))
        for path, ends in ranges.items()
    ]


def _draw(ax: Axes, bars: list[_Bar], status: Mapping[str, str], *, both: bool) -> None:
    """Draw the bars with their hatches, names and changes: both ends of a range, or one change."""
    places = np.arange(len(bars))
    style: dict[str, Any] = {"height": 0.7, "edgecolor": "white", "linewidth": 0.0}
    hatches = [STATUS_HATCHES.get(status[bar.input], "") for bar in bars]
    for side, end in enumerate(("low", "high") if both else ("high",)):
        values = [getattr(bar, end) for bar in bars]
        colours = [(DRIVES, DAMPS)[side if both else int(value >= 0)] for value in values]
        ax.barh(places, values, color=colours, hatch=hatches, **style)
    for place, bar in enumerate(bars):
        _write_changes(ax, place, sorted({bar.low, bar.high} - {0.0}))
    name_bars(ax, short_names([bar.input for bar in bars]))
    ax.set_ylim(-0.6, len(bars) - 0.4)


def _write_changes(ax: Axes, place: int, values: list[float]) -> None:
    """Write the changes of a bar beside its ends; two changes of the same sign both stand beside the farther end."""
    for own in ([value for value in values if value < 0], [value for value in values if value > 0]):
        if own:
            write_beside(ax, place, max(own, key=abs), ", ".join(map(signed, own)))


def _legend(ax: Axes, statuses: set[str], *, both: bool) -> None:
    """Name the colours of the bars, and the hatches of the statuses that occur."""
    from matplotlib.patches import Patch

    names = ("lower end of the range", "upper end") if both else ("lowers it", "raises it")
    handles = [Patch(color=colour, label=name) for colour, name in zip((DRIVES, DAMPS), names, strict=True)]
    for status, hatch in STATUS_HATCHES.items():
        if status in statuses:
            handles.append(Patch(facecolor="0.45", edgecolor="white", hatch=hatch, linewidth=0, label=status))
    ax.legend(handles=handles, loc="lower right")
