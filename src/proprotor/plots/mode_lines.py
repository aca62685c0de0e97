"""Lines of the modes of a sweep along airspeeds or one input; several sweeps on one axes stay apart."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import ArrayLike

from proprotor.model import stamp
from proprotor.plots import small_print
from proprotor.plots.canvas import grid, note, write_headline
from proprotor.plots.line_of_sweep import Positions, with_gaps
from proprotor.plots.onsets import Told, told_by
from proprotor.plots.style import LABEL_SIZE, RING, UNKNOWN, ModeStyle, mode_styles, of_later_sweep, white_box
from proprotor.tables.sweep_summary import broad_modes, leaps, modes_of_interest
from proprotor.typing import Array, Axes, Dataset, Line2D

_MOST = 24  # names that have room beside axes of the usual height
_NAMED = 0.03  # of the width of the axes: a failed stretch that is broader has its name in it


class _Drawn(NamedTuple):
    """A sweep on axes: its stamp, its name where the axes hold several, the lines of its modes, and what it tells."""

    stamp: dict[str, str]
    name: str
    lines: dict[str, Line2D]
    told: Told


_sweeps: WeakKeyDictionary[Axes, list[_Drawn]] = WeakKeyDictionary()


def draw_modes(
    ax: Axes,
    sweep: Dataset,
    values: Array,
    line: Positions,
    name: str = "",
    rotor_speed: ArrayLike | None = None,
) -> list[Line2D]:
    """Draw a line for each mode through values (points, modes); return the lines on the axes that are to have names.

    Of more modes than have room for their names, only modes of the support and unstable modes have lines. Points of the
    sweep that could not be analysed are gaps, with a cross on the axis, and a hatched stretch around them. Lines of a
    further sweep on the same axes have the colours of the first, other dashes and hollow markers, and the `name` of
    their sweep in their labels.
    """
    told = told_by(sweep, line, rotor_speed)
    shown = modes_drawn(ax, sweep)
    sweep, values = sweep.isel(mode=shown), values[:, shown]
    earlier = earlier_sweeps(ax)
    spacing, gaps = max(1, len(line.values) // 7), leaps(sweep)
    lines: dict[str, Line2D] = {}
    for place, (mode, style) in enumerate(styles_beside(earlier, sweep)):
        markers: dict[str, Any] = {"markevery": (3 * place % spacing, spacing), "markersize": 5}
        markers |= {"markerfacecolor": "white"} if earlier else {}
        x, y = with_gaps(gaps[:, place], line.values, values[:, place])
        (lines[mode],) = ax.plot(x, y, label=mode, **markers, **style._asdict())
    mark_failed(ax, line, sweep.reason.values != "", first=not earlier)
    grid(ax)
    return named(ax, sweep, lines, name, told)


def earlier_sweeps(ax: Axes) -> list[_Drawn]:
    """Return the sweeps that axes hold, without those whose lines were removed."""
    kept = [one for one in _sweeps.get(ax, []) if any(line.axes is ax for line in one.lines.values())]
    _sweeps[ax] = kept
    return kept


def styles_beside(earlier: list[_Drawn], sweep: Dataset) -> list[tuple[str, ModeStyle]]:
    """Return each mode of a sweep and the style of its line beside earlier sweeps on the axes."""
    colours = {mode: str(line.get_color()) for one in earlier for mode, line in one.lines.items()}
    found = list(zip(sweep.mode.values.tolist(), mode_styles(sweep), strict=True))
    if not earlier:
        return found
    return [
        (mode, of_later_sweep(style, len(earlier))._replace(color=colours.get(mode, style.color)))
        for mode, style in found
    ]


def named(ax: Axes, sweep: Dataset, lines: dict[str, Line2D], name: str, told: Told) -> list[Line2D]:
    """Keep the lines of a sweep; return the lines on the axes that are to have names.

    The labels of several sweeps end in what tells the sweeps apart. Where all names have no room, those of broad lines
    alone are returned.
    """
    kept = _sweeps.setdefault(ax, [])
    kept.append(_Drawn(stamp.of(sweep.attrs), name, lines, told))
    every = [line for one in kept for line in one.lines.values()]
    if len(kept) == 1:
        return every
    for one, own in zip(kept, _names(kept), strict=True):
        for mode, line in one.lines.items():
            line.set_label(f"{mode}, {own}")
        if own in (of := stamp.line(one.stamp)):
            continue
        # A bare origin stands there for the whole plot, which holds another sweep now.
        small_print.rewrite(ax, re.sub(rf"(?<!”: ){re.escape(of)}", "", small_print.read(ax)))
        note(ax, f"“{own}”: {of}")
    if len(every) <= _MOST:
        return every
    broad = _broad_lines(kept)
    note(ax, "Thin lines are other modes, without names")
    return broad


def mark_boundaries(ax: Axes, x: Sequence[float], y: Sequence[float]) -> None:
    """Draw a circle at each boundary of a sweep, and tell what circles and the numbers after names are."""
    ax.plot(x, y, "o", **RING)
    if x:
        note(ax, "Circles, and numbers after names: boundaries, interpolated between points of the sweep")


def unstable_lines(ax: Axes) -> dict[Line2D, str]:
    """Return, of the lines of all sweeps on axes, where their modes are unstable, in words."""
    return {
        line: one.told.unstable.get(mode, "")
        for one in _sweeps.get(ax, [])
        for mode, line in one.lines.items()
    }


def write_headline_of_sweeps(ax: Axes) -> None:
    """Write above axes what their sweep tells, or in few words what each of several sweeps tells."""
    kept = _sweeps.get(ax, [])
    if len(kept) == 1:
        write_headline(ax, kept[0].told.headline)
    else:
        each = zip(_names(kept), kept, strict=True)
        write_headline(ax, "; ".join(f"{name}: {one.told.short}" for name, one in each))


def _broad_lines(kept: list[_Drawn]) -> list[Line2D]:
    """Return the lines of the modes that are broad in one of several sweeps."""
    least = 0.9 * max(line.get_linewidth() for one in kept for line in one.lines.values())
    modes = {mode for one in kept for mode, line in one.lines.items() if line.get_linewidth() >= least}
    return [line for one in kept for mode, line in one.lines.items() if mode in modes]


def _names(kept: list[_Drawn]) -> list[str]:
    """Return a name for each sweep on axes: as given, or the case or the options, where these differ, or a number."""
    cases = [one.stamp.get("case", "") for one in kept]
    options = [stamp.line(one.stamp).partition("), ")[2].rstrip(".") for one in kept]
    told = next((part for part in (cases, options) if len(set(part)) == len(part)), None)
    usual = told or [f"sweep {number}" for number in range(1, len(kept) + 1)]
    return [one.name or own for one, own in zip(kept, usual, strict=True)]


def mark_failed(ax: Axes, line: Positions, failed: Array, *, first: bool) -> None:
    """Draw a cross on the axis at each failed point and, of the first sweep, hatch the stretches of such points."""
    ax.set_xlabel(line.label + (", x where it could not be analysed" if failed.any() else ""))
    if not failed.any():
        return  # a line without points, not clipped, would take the corner of the figure into the layout
    on_the_axis: dict[str, Any] = {"transform": ax.get_xaxis_transform(), "clip_on": False}
    at = line.values[failed]
    ax.plot(at, np.zeros(len(at)), "x", color="0.4", **on_the_axis)
    if not first or len(failed) < 2:
        return
    order = np.argsort(line.values)
    x, failed = line.values[order], failed[order]
    middles = np.concatenate([x[:1], (x[1:] + x[:-1]) / 2, x[-1:]])
    changes = np.flatnonzero(np.diff(np.concatenate([[False], failed, [False]]).astype(int)))
    for start, stop in middles[changes].reshape(-1, 2):
        ax.axvspan(start, stop, zorder=0.6, **UNKNOWN)
        if stop - start > _NAMED * np.ptp(x):
            style: dict[str, Any] = {"rotation": 90, "ha": "center", "va": "center", "fontsize": LABEL_SIZE}
            style |= {"transform": ax.get_xaxis_transform(), "bbox": white_box(1.5), "color": "0.3"}
            ax.text((start + stop) / 2, 0.5, "could not be analysed", zorder=0.7, **style)


def modes_drawn(ax: Axes, sweep: Dataset) -> list[int]:
    """Return the places of the modes that have lines, and tell beneath the axes how many modes have none."""
    if len(sweep.mode) <= _MOST:
        return list(range(len(sweep.mode)))
    broad = np.isin(sweep.mode.values, list(broad_modes(sweep)))
    shown = modes_of_interest(sweep, min(_MOST, int(broad.sum())))
    note(
        ax,
        f"Modes of the support and unstable modes; {len(sweep.mode) - len(shown)} other modes are not drawn",
    )
    return shown
