"""Rotor and wing at one phase of a mode, seen from ahead, from the side, from above or in perspective."""

from __future__ import annotations

from typing import Any

import numpy as np

from proprotor.errors import InputError, check_known
from proprotor.model.doubts import marked
from proprotor.plots import small_print
from proprotor.plots.canvas import note, say_origin
from proprotor.plots.mode_motion import ModeMotion
from proprotor.plots.style import LABEL_SIZE, in_style
from proprotor.typing import Array, Axes
from proprotor.units import KNOT, KTAS

# The axes of each view: 0, 1, 2 for x, y, z, and the sign of the coordinate. x is up, y outboard, z along the shaft.
# Seen from ahead, outboard is to the left on a right wing; the perspective is right-handed with x up.
_AXES = {
    "front": ((1, -1.0), (0, 1.0)),
    "side": ((2, 1.0), (0, 1.0)),
    "top": ((1, 1.0), (2, 1.0)),
    "3d": ((2, 1.0), (1, -1.0), (0, 1.0)),
}
_LABELS = {
    "front": ("−y, inboard (radii)", "x, up (radii)"),
    "side": ("z, along the shaft (radii)", "x, up (radii)"),
    "top": ("y, outboard (radii)", "z, along the shaft (radii)"),
}
_LINES = {
    "wing": ("#009E73", 1.6),
    "mast": ("#000000", 2.6),
    "blade": ("#0072B2", 1.4),
    "tip path": ("#D55E00", 1.6),
}
_MARGIN = 0.25  # radii


@in_style
def plot_mode_shape(
    motion: ModeMotion, ax: Axes | None = None, *, view: str = "front", phase: float = 0.0
) -> Axes:
    """Draw rotor and wing at one phase of a mode, over the trim state in grey.

    Parameters
    ----------
    motion : ModeMotion
        Result of `proprotor.plots.mode_motion.mode_motion`.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default. The view "3d" needs axes with the projection "3d".
    view : "front", "side", "top" or "3d"
        View from ahead of the rotor, from outboard, from above, or in perspective.
    phase : float
        Phase of the cycle, rad.

    Returns
    -------
    matplotlib.axes.Axes
        The given axes, or the new ones. Lengths are in radii of the rotor, from the hub at trim.

    Raises
    ------
    InputError
        For an unknown view, or axes with another projection than the view needs.
    """
    check_known("view", view, _AXES, "view")
    ax = _axes(ax, view)
    draw_still(ax, motion, view)
    draw_moving(ax, motion, view, phase)
    _name_parts(ax)
    note(ax, f"{title_of(motion)}; amplitude enlarged; thin grey: trim")
    say_origin(ax, motion.stamp, [f"Doubtful: {motion.warning}."] if motion.warning else ())
    return ax


def title_of(motion: ModeMotion) -> str:
    """Return the title of a mode: its name, airspeed, frequency and damping.

    Parameters
    ----------
    motion : ModeMotion

    Returns
    -------
    str
    """
    value = motion.eigenvalue
    per_rev = f", {value.imag / motion.rotor_speed:.2f}/rev" if motion.rotor_speed else ""
    damping = -100 * value.real / abs(value)
    hertz = value.imag / (2 * np.pi)
    return (
        f"{motion.mode} at {marked(f'{motion.airspeed / KNOT:.0f}', motion.warning)} {KTAS}: {hertz:.2f} Hz{per_rev}, "
        f"damping {damping:.2f} % of critical"
    )


def _name_parts(ax: Axes) -> None:
    """Write a legend of the lines of the parts that the axes show."""
    lines = {name: line for name in _LINES for line in ax.lines if line.get_color() == _LINES[name][0]}
    ax.legend(list(lines.values()), list(lines), loc="upper right")


def _axes(ax: Axes | None, view: str) -> Axes:
    """Return the given axes if they fit the view, or new axes."""
    solid = view == "3d"
    if ax is None:
        import matplotlib.pyplot as plt  # here, because matplotlib takes long to import

        figure = plt.figure(figsize=(6, 5.5), layout="constrained")
        small_print.own(figure)
        return figure.add_subplot(projection="3d" if solid else None)
    if solid != (ax.name == "3d"):
        raise InputError("ax", ax.name, f'must have {"" if solid else "no "}projection "3d" for this view')
    return ax


def draw_moving(ax: Axes, motion: ModeMotion, view: str, phase: float) -> list[Any]:
    """Draw the moving lines, and return them so that the caller can remove them again."""
    lines = []
    for name, points in motion.at(phase).items():
        colour, width = _LINES[name.rstrip("0123456789 ")]
        solid: dict[str, Any] = {"solid_capstyle": "round", "zorder": 3}
        lines += ax.plot(*_seen(points / motion.radius, view), color=colour, linewidth=width, **solid)
    return lines


def draw_still(ax: Axes, motion: ModeMotion, view: str) -> None:
    """Draw the trim state in grey, and set limits and labels."""
    still = {part.name: part.points / motion.radius for part in motion.parts}
    for points in still.values():
        ax.plot(*_seen(points, view), color="0.75", linewidth=0.8, zorder=1)
    every = np.concatenate(list(still.values()))
    ends = every.min(axis=0) - _MARGIN, every.max(axis=0) + _MARGIN
    limits = np.sort(_seen(np.array(ends), view), axis=1)
    ax.set(**dict(zip(("xlim", "ylim", "zlim"), limits, strict=False)))
    if view == "3d":
        _look_from_ahead(ax, np.ptp(limits, axis=1))
        return
    across, up = _LABELS[view]
    ax.set_aspect("equal")
    ax.set_xlabel(across, fontsize=LABEL_SIZE)
    ax.set_ylabel(up, fontsize=LABEL_SIZE)
    ax.tick_params(labelsize=LABEL_SIZE - 1)
    ax.grid(color="0.92", linewidth=0.5)
    ax.set_axisbelow(True)


def _look_from_ahead(ax: Any, size: Array) -> None:
    """Set a view from ahead, above and outboard on space of a size (3,), without the box of the axes."""
    ax.set_box_aspect(size, zoom=1.55)
    ax.view_init(elev=22, azim=-40)
    ax.set_axis_off()


def _seen(points: Array, view: str) -> tuple[Array, ...]:
    """Return the coordinates of points (k, 3) along the axes of a view."""
    return tuple(sign * points[:, axis] for axis, sign in _AXES[view])
