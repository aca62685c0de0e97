"""Stability map: where in the plane of two inputs a case is stable."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from proprotor.model.doubts import map_doubts
from proprotor.model.stamp import density_of
from proprotor.plots.canvas import axes_or_new, grid, note, say_origin
from proprotor.plots.line_of_sweep import Positions, axis_of
from proprotor.plots.points import draw_points, quantity_of
from proprotor.plots.style import (
    GREY,
    LABEL_SIZE,
    STABLE,
    TITLE_SIZE,
    UNKNOWN,
    UNSTABLE,
    halo,
    in_style,
    styles_of_modes,
    white_box,
)
from proprotor.stability.boundary_lines import BoundaryLine
from proprotor.tables.points import Points, Quantity
from proprotor.typing import Array, Axes, Dataset
from proprotor.units import KNOT, KTAS

_Point = tuple[float, float]
_Edge = tuple[int, int, int]  # row, column, and 0 for an edge along x or 1 for an edge along y
_BORDER = 0.15  # of the axes: a name so near their edge is written away from the edge
_ROOM = 0.06  # a region that is narrower than this share of the axes has no name in it


@in_style
def plot_stability_map(
    found: Dataset,
    ax: Axes | None = None,
    *,
    lines: Sequence[BoundaryLine] = (),
    units: Mapping[str, str] | None = None,
    points: Points | None = None,
) -> Axes:
    """Draw the stability boundary in the plane of two inputs, with the stable side shaded.

    Cells of the grid with a corner that could not be analysed are hatched, and their corners have a cross.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `Case.stability_map`.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default.
    lines : sequence of BoundaryLine, optional
        Result of `proprotor.stability.boundary_lines.boundary_lines`: parts of the boundary, each named after the mode
        that is neutral. Without lines the boundary is one black line.
    units : mapping of str to str, optional
        Units of the axes by input; the usual ones by default.
    points : Points, optional
        Of `proprotor.tables.points.read_points`, with a column for each of the two inputs.

    Returns
    -------
    matplotlib.axes.Axes
        The given axes, or the new ones.

    Raises
    ------
    InputError
        If a unit does not fit its input, and for points without the columns.
    """
    names = [str(name) for name in found.axis.values]
    x, y = (_axis(found, name, (units or {}).get(name)) for name in names)
    ax = axes_or_new(ax, size=(7.5, 5.5))
    growth = found.growth.transpose(*names[::-1]).values
    vertices = found.boundary.values / np.array([x.factor, y.factor])
    _shade(ax, x.values, y.values, growth, vertices)
    _hatch_unknown(ax, x.values, y.values, growth)
    if not lines:
        ax.plot(*vertices.T, color="black", linewidth=1.8)
    failed = np.argwhere(np.isnan(growth))
    ax.plot(x.values[failed[:, 1]], y.values[failed[:, 0]], "x", color="0.4", markersize=4)
    ax.set(xlim=x.values[[0, -1]], xlabel=x.label)
    ax.set(ylim=y.values[[0, -1]], ylabel=y.label)
    if points is not None:
        draw_points(ax, points, _quantity(found, x), _quantity(found, y))
    _draw_named(ax, lines, x, y)
    _name_regions(ax, x.values, y.values, growth)
    _mark_deck(ax, found, x, y)
    if "airspeed" in found.attrs:
        note(ax, f"Everywhere at {float(found.attrs['airspeed']) / KNOT:.4g} {KTAS}")
    if level := float(found.attrs.get("level", 0.0)):
        note(ax, f"“stable”: every mode has more than {100 * level:g} % of critical damping")
    if len(failed):
        note(ax, "Crosses and hatches: could not be analysed")
    grid(ax)
    say_origin(ax, found.attrs, map_doubts(found))
    return ax


def _quantity(found: Dataset, axis: Positions) -> Quantity:
    """Return the quantity of an axis, to which points are converted."""
    si = "m/s" if axis.name == "airspeed" else str(found[axis.name].attrs.get("units", ""))
    return quantity_of(axis, si, density_of(found.attrs))


def _axis(found: Dataset, name: str, unit: str | None) -> Positions:
    si = "m/s" if name == "airspeed" else str(found[name].attrs.get("units", ""))
    return axis_of(name, found[name].values, si, unit, density_of(found.attrs))


def _shade(ax: Axes, x: Array, y: Array, growth: Array, vertices: Array) -> None:
    """Fill the stable part of every cell of the grid, up to the crossings that were found on the edges of the cell."""
    from matplotlib.collections import PolyCollection

    crossings = _by_edge(x, y, vertices)
    polygons = [
        polygon
        for row, column in np.ndindex(len(y) - 1, len(x) - 1)
        for polygon in _stable_part(x, y, growth, crossings, row, column)
    ]
    style: dict[str, Any] = {"facecolors": STABLE, "edgecolors": STABLE, "linewidths": 0.3, "zorder": 0.5}
    ax.add_collection(PolyCollection(polygons, **style))


def _hatch_unknown(ax: Axes, x: Array, y: Array, growth: Array) -> None:
    """Hatch the cells of which a corner could not be analysed; whether they are stable is not known."""
    from matplotlib.collections import PolyCollection

    ax.set_facecolor(UNSTABLE)
    known = np.isfinite(growth)
    cells = known[:-1, :-1] & known[1:, :-1] & known[:-1, 1:] & known[1:, 1:]
    polygons = [
        [(x[column], y[row]), (x[column + 1], y[row]), (x[column + 1], y[row + 1]), (x[column], y[row + 1])]
        for row, column in np.argwhere(~cells)
    ]
    style = {f"{name}s" if name.endswith("color") else name: value for name, value in UNKNOWN.items()}
    ax.add_collection(PolyCollection(polygons, zorder=0.4, **style))


def _by_edge(x: Array, y: Array, vertices: Array) -> dict[_Edge, _Point]:
    """Return the crossings by the edge of the grid on which they lie."""
    found: dict[_Edge, _Point] = {}
    for here in vertices[np.isfinite(vertices).all(axis=1)]:
        off = [np.abs(axis - value) / np.ptp(axis) for axis, value in zip((x, y), here, strict=True)]
        along_x = off[1].min() <= off[0].min()  # on a line of equal y
        column, row = (
            int(np.clip(np.searchsorted(axis, value, side="right") - 1, 0, len(axis) - 2))
            for axis, value in zip((x, y), here, strict=True)
        )
        place = (int(off[1].argmin()), column, 0) if along_x else (row, int(off[0].argmin()), 1)
        found[place] = (float(here[0]), float(here[1]))
    return found


def _stable_part(
    x: Array, y: Array, growth: Array, crossings: Mapping[_Edge, _Point], row: int, column: int
) -> list[list[_Point]]:
    """Return the stable polygons of one cell; none if a corner could not be analysed."""
    corners = [(row, column), (row, column + 1), (row + 1, column + 1), (row + 1, column)]
    values = [growth[corner] for corner in corners]
    if not np.isfinite(values).all():
        return []
    edges = [(row, column, 0), (row, column + 1, 1), (row + 1, column, 0), (row, column, 1)]
    outline: list[_Point] = []
    own: list[list[_Point]] = []  # a polygon at each stable corner, for corners that are not joined
    for place, (corner, value) in enumerate(zip(corners, values, strict=True)):
        after, before = crossings.get(edges[place]), crossings.get(edges[place - 1])
        if value <= 0:
            outline.append((float(x[corner[1]]), float(y[corner[0]])))
            own.append([p for p in (before, outline[-1], after) if p is not None])
        if after is not None:
            outline.append(after)
    apart = len(own) == 2 and len(outline) == 6 and np.mean(values) > 0
    return own if apart else [outline] if len(outline) > 2 and own else []


def _draw_named(ax: Axes, lines: Sequence[BoundaryLine], x: Positions, y: Positions) -> None:
    """Draw the lines of each mode in one style, with the name of the mode beside its longest line."""
    for mode, (colour, dashes, *_) in styles_of_modes(line.mode for line in lines).items():
        own = [line for line in lines if line.mode == mode]
        style: dict[str, Any] = {"color": colour, "linestyle": dashes, "linewidth": 2.0, "zorder": 3}
        for line in own:
            label = mode if line is own[0] else f"_{mode}"  # one label for all lines of a mode
            ax.plot(line.x / x.factor, line.y / y.factor, label=label, **style)
        longest = max(own, key=lambda line: float(_steps(line, x, y).sum()))
        at, offset = _beside(ax, longest, x, y)
        box = white_box(1.2) | {"alpha": 0.85}
        text: dict[str, Any] = {"fontsize": LABEL_SIZE, "color": colour, "bbox": box, "zorder": 4}
        text |= {"ha": "center" if abs(offset[0]) < 6 else "left" if offset[0] > 0 else "right"}
        text |= {"va": "center" if abs(offset[1]) < 6 else "bottom" if offset[1] > 0 else "top"}
        across = float(ax.transLimits.transform(at)[0])
        if min(across, 1 - across) < _BORDER:  # a name in the middle would leave the axes
            text |= {"ha": "left" if across < 0.5 else "right"}
        ax.annotate(mode, at, xytext=offset, textcoords="offset points", annotation_clip=True, **text)


def _mark_deck(ax: Axes, found: Dataset, x: Positions, y: Positions) -> None:
    """Mark the deck's own values: a point, or a line where the other axis is the airspeed, of which a deck has none."""
    own = [float(found[axis.name].attrs.get("of_deck", np.nan)) / axis.factor for axis in (x, y)]
    within = [
        low <= value <= high for value, (low, high) in zip(own, (ax.get_xlim(), ax.get_ylim()), strict=True)
    ]
    text: dict[str, Any] = {"fontsize": LABEL_SIZE, "path_effects": halo(), "zorder": 5}
    text |= {"textcoords": "offset points", "xytext": (6, 4)}
    if all(within):
        ax.plot(*own, "*", color="black", markeredgecolor="white", markersize=11, zorder=5)
        ax.annotate("the deck", (own[0], own[1]), **text)
    elif within[1] and np.isnan(own[0]):
        ax.axhline(own[1], color=GREY, linewidth=0.9, linestyle=":", zorder=2)
        ax.annotate("the deck", (0, own[1]), xycoords=ax.get_yaxis_transform(), **text)
    elif within[0] and np.isnan(own[1]):
        ax.axvline(own[0], color=GREY, linewidth=0.9, linestyle=":", zorder=2)
        ax.annotate("the deck", (own[0], 0), xycoords=ax.get_xaxis_transform(), **text)


def _steps(line: BoundaryLine, x: Positions, y: Positions) -> Array:
    """Return the lengths between the vertices of a line, in fractions of the axes."""
    across = np.diff(line.x / x.factor) / np.ptp(x.values)
    return np.asarray(np.hypot(across, np.diff(line.y / y.factor) / np.ptp(y.values)))


def _beside(ax: Axes, line: BoundaryLine, x: Positions, y: Positions) -> tuple[_Point, _Point]:
    """Return the middle of a line, and an offset across the line, in points, towards the middle of the axes."""
    along = np.concatenate([[0.0], np.cumsum(_steps(line, x, y))])
    shares = np.clip(along[-1] * np.array([0.45, 0.5, 0.55]), 0, along[-1])
    ends = line.x / x.factor, line.y / y.factor
    points = np.column_stack([np.interp(shares, along, part) for part in ends])
    before, middle, after = ax.transAxes.inverted().transform(ax.transData.transform(points))
    across = (after - before)[::-1] * (-1, 1) * ax.bbox.size[::-1]  # normal on the page
    size = np.hypot(*across)
    across = across / size if size > 0 else np.array([1.0, 0.0])
    inwards = np.sign(across @ (0.5 - middle)) or 1.0
    return tuple(points[1].tolist()), tuple((9.0 * inwards * across).tolist())


def _name_regions(ax: Axes, x: Array, y: Array, growth: Array) -> None:
    """Write "stable", "unstable" and "not known" where each region is widest."""
    from scipy.ndimage import distance_transform_edt  # here, because scipy.ndimage takes long to import

    fine = np.linspace(0, 1, 60)
    columns, rows = (
        np.abs((axis - axis[0]) / np.ptp(axis) - fine[:, None]).argmin(axis=1) for axis in (x, y)
    )
    signs = growth[np.ix_(rows, columns)]
    regions = {"stable": signs <= 0, "unstable": signs > 0, "not known": np.isnan(signs)}
    for name, region in regions.items():
        room = distance_transform_edt(np.pad(region, 1))[1:-1, 1:-1] / len(fine)
        if room.max() >= _ROOM:
            row, column = np.unravel_index(room.argmax(), room.shape)
            style: dict[str, Any] = {"ha": "center", "va": "center", "color": "0.3", "style": "italic"}
            style |= {
                "transform": ax.transAxes,
                "fontsize": TITLE_SIZE,
                "bbox": white_box(1.5) | {"alpha": 0.6},
            }
            ax.text(float(fine[column]), float(fine[row]), name, **style)
