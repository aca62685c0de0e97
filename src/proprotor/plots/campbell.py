"""Campbell's diagram: frequencies in the fixed frame over the rotor speed, with the harmonics of the rotor."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from proprotor.errors import InputError
from proprotor.plots.canvas import along, axes_or_new, say_origin
from proprotor.plots.end_labels import label_lines
from proprotor.plots.line_of_sweep import positions
from proprotor.plots.mode_lines import draw_modes
from proprotor.plots.points import draw_points, frequency_quantity, quantity_of
from proprotor.plots.style import LABEL_SIZE, SMALL_SIZE, in_style, white_box
from proprotor.tables.points import Points
from proprotor.tables.sweep_summary import damped_frequency
from proprotor.typing import Axes, Dataset

_ROTOR_SPEED = "operation.rotor_speed"
_HARMONICS = 5
_ALONG = (0.955, 0.87, 0.78)  # of a ray: places for its name
_WIDTH = 0.06  # of the axes: of a name and half a mark of a rotor speed


@in_style
def plot_campbell(
    sweep: Dataset,
    ax: Axes | None = None,
    *,
    harmonics: Sequence[int] | None = None,
    n_blades: int | None = None,
    rotor_speed: float | None = None,
    unit: str = "rpm",
    limits: tuple[float, float] | None = None,
    points: Points | None = None,
) -> Axes:
    """Draw the frequency |Im s| of each mode in the fixed frame over the rotor speed, and rays of n per revolution.

    Parameters
    ----------
    sweep : xarray.Dataset
        Result of `Case.sweep` at one airspeed with ``vary={"operation.rotor_speed": ...}``: windmilling in air, or in
        vacuum with ``airloads="none"``.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default. Labels stand to its right.
    harmonics : sequence of int, optional
        The n of the rays; by default 1 to 5, or 1 to one more than the number of blades.
    n_blades : int, optional
        Number of blades. Rays of its multiples, at which blades shake the fixed frame, are black.
    rotor_speed : float, optional
        Operating speed of the rotor, rad/s, drawn as a vertical line.
    unit : str
        Unit of the axis of rotor speed.
    limits : (float, float), optional
        Ends of the frequency axis, Hz; up to the highest ray by default. A note beneath the axes names the modes of
        which no point lies within.
    points : Points, optional
        Of `proprotor.tables.points.read_points`: columns rotor_speed and frequency.

    Returns
    -------
    matplotlib.axes.Axes
        The given axes, or the new ones.

    Raises
    ------
    InputError
        If the sweep is not over the rotor speed, or the unit does not fit it; for points without the columns.
    """
    if sweep.eigenvalue.dims[0] != _ROTOR_SPEED:
        raise InputError("sweep", str(sweep.eigenvalue.dims[0]), f"must be over {_ROTOR_SPEED}")
    line = positions(sweep, unit)
    ax = axes_or_new(ax, size=(8, 6), labels_beside=True)
    rays = list(harmonics or range(1, max(_HARMONICS, (n_blades or 0) + 1) + 1))
    omega = sweep[_ROTOR_SPEED].values
    lines = draw_modes(ax, sweep, damped_frequency(sweep) / (2 * np.pi), line)
    ax.set_xlim(0, float(line.values.max()))
    ax.set_ylim(*(limits or (0, max(rays) * float(omega.max()) / (2 * np.pi))))
    draw_points(ax, points, quantity_of(line, "rad/s"), frequency_quantity(line, None))
    at = None if rotor_speed is None else rotor_speed / line.factor
    _draw_rays(ax, rays, line.factor / (2 * np.pi), n_blades, at)
    if at is not None:
        ax.axvline(at, color="0.35", linewidth=1.0, linestyle="-.", zorder=1)
        style: dict[str, Any] = {"fontsize": LABEL_SIZE, "color": "0.25", "rotation": 90}
        style |= {"ha": "right", "va": "top", "zorder": 4, "textcoords": "offset points", "xytext": (-3, 0)}
        ax.annotate(
            f"{at:.0f} {unit}", (at, 0.98), xycoords=ax.get_xaxis_transform(), bbox=white_box(1), **style
        )
    ax.set_ylabel("Frequency |Im s| in the fixed frame (Hz)")
    label_lines(ax, lines, "frequency")
    say_origin(ax, sweep.attrs, along(sweep, line))
    return ax


def _draw_rays(
    ax: Axes, harmonics: Sequence[int], hertz: float, n_blades: int | None, kept_free: float | None
) -> None:
    """Draw the lines of n times the rotor speed, with n near the end of each, away from a rotor speed to keep free.

    `hertz` is one unit of rotor speed.
    """
    right, top = ax.get_xlim()[1], ax.get_ylim()[1]
    for n in harmonics:
        strong = n_blades is not None and n % n_blades == 0
        end = min(right, top / (n * hertz))
        style: dict[str, Any] = {"color": "0.1" if strong else "0.55", "zorder": 1}
        ax.plot([0, end], [0, n * hertz * end], linewidth=1.1 if strong else 0.7, dashes=(2, 2), **style)
        near = _free_place([share * end for share in _ALONG], kept_free, _WIDTH * right)
        style |= {"fontsize": SMALL_SIZE, "ha": "center", "va": "center"}
        ax.text(near, n * hertz * near, f"{n}/rev", bbox=white_box(0.8), **style)


def _free_place(places: Sequence[float], kept_free: float | None, width: float) -> float:
    """Return the first of some rotor speeds that is farther than a width from the one to keep free, or the last."""
    free = (place for place in places if kept_free is None or abs(place - kept_free) > width)
    return next(free, places[-1])
