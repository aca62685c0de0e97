"""Parts that all plots of bars share: the names of the bars, and numbers beside the ends of the bars."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from proprotor.plots.canvas import grid
from proprotor.plots.style import LABEL_SIZE, SMALL_SIZE
from proprotor.typing import Axes


def name_bars(ax: Axes, names: Sequence[str]) -> None:
    """Write the names of horizontal bars beside the axis, and draw grid lines across the bars only."""
    ax.set_yticks(np.arange(len(names)), names, fontsize=LABEL_SIZE)
    grid(ax)
    ax.grid(visible=False, axis="y")


def centre_on_zero(ax: Axes, reach: float) -> None:
    """Draw the line of no change in the middle of axes that reach equally far to both sides."""
    ax.axvline(0, color="black", linewidth=0.8)
    ax.set_xlim(-reach, reach)


def write_beside(ax: Axes, place: int, end: float, text: str) -> None:
    """Write a text beside the end of the bar at a place, on the far side from zero."""
    side, offset = ("left", 3) if end >= 0 else ("right", -3)
    style: dict[str, Any] = {
        "fontsize": SMALL_SIZE,
        "va": "center",
        "ha": side,
        "textcoords": "offset points",
    }
    ax.annotate(text, (end, place), xytext=(offset, 0), **style)


def signed(value: float) -> str:
    """Return a change as the text beside its bar: two digits, with a sign."""
    text = f"{value:+.0f}" if abs(value) >= 9.95 else f"{value:+#.2g}"  # 9.97 has an exponent otherwise
    return text.replace("-", "−")
