"""Lines of the modes of a sweep along airspeeds or one input, and the names of the lines beside the axes."""

from __future__ import annotations

from typing import Any

import numpy as np

from proprotor.plots.canvas import grid, note
from proprotor.plots.line_of_sweep import Positions, with_gaps
from proprotor.plots.style import mode_styles
from proprotor.tables.sweep_summary import broad_modes, leaps, modes_of_interest
from proprotor.typing import Array, Axes, Dataset, Line2D

_MOST = 24  # names that have room beside axes of the usual height


def draw_modes(ax: Axes, sweep: Dataset, values: Array, line: Positions) -> list[Line2D]:
    """Draw a line for each mode through values (points, modes), and return the lines.

    Of more modes than have room for their names, only modes of the support and unstable modes have lines. Points of the
    sweep that could not be analysed are gaps, with a cross on the axis.
    """
    shown = modes_drawn(ax, sweep)
    sweep, values = sweep.isel(mode=shown), values[:, shown]
    spacing, gaps = max(1, len(line.values) // 7), leaps(sweep)
    lines: list[Line2D] = []
    for place, (mode, style) in enumerate(zip(sweep.mode.values.tolist(), mode_styles(sweep), strict=True)):
        markers: dict[str, Any] = {"markevery": (3 * place % spacing, spacing), "markersize": 5}
        x, y = with_gaps(gaps[:, place], line.values, values[:, place])
        lines += ax.plot(x, y, label=mode, **markers, **style._asdict())
    failed = line.values[sweep.reason.values != ""]
    on_the_axis: dict[str, Any] = {"transform": ax.get_xaxis_transform(), "clip_on": False}
    ax.plot(failed, np.zeros(len(failed)), "x", color="0.4", **on_the_axis)
    ax.set_xlabel(line.label + (", x where it could not be analysed" if len(failed) else ""))
    grid(ax)
    return lines


def modes_drawn(ax: Axes, sweep: Dataset) -> list[int]:
    """Return the places of the modes that have lines, and write above the axes how many modes have none."""
    if len(sweep.mode) <= _MOST:
        return list(range(len(sweep.mode)))
    broad = np.isin(sweep.mode.values, list(broad_modes(sweep)))
    shown = modes_of_interest(sweep, min(_MOST, int(broad.sum())))
    note(
        ax,
        f"Modes of the support and unstable modes; {len(sweep.mode) - len(shown)} other modes are not drawn",
    )
    return shown
