"""Where in the plane of two inputs a case is stable, and the line between.

A grid of points is evaluated as one batch. Where one of two neighbours of the grid is stable and the other is not, the
first onset on the way from the stable one is found as any boundary is (`proprotor.stability.crossings`), all edges at once;
marching squares joins them into lines. Two crossings on one edge, between neighbours that are both stable or both not,
are finer than the grid.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.deck.vary import design_inputs
from proprotor.errors import InputError, unknown_name
from proprotor.model import stamp
from proprotor.model.linear_model import LinearModel
from proprotor.needs import check_memory
from proprotor.stability.crossings import Brackets, Search
from proprotor.stability.parameter_lines import AIRSPEED, models_at
from proprotor.stability.root_error import growth, growth_error, roots
from proprotor.typing import Array
from proprotor.units import in_metres_per_second

if TYPE_CHECKING:
    import xarray

    from proprotor.model.configuration import Configuration

_AT_ONCE = 4096  # points of one batch
_BYTES_PER_POINT = 100.0  # of the grid: where it is, what was found there, and the line between

Plane = Callable[[Array, Array], LinearModel]  # x and y (k,) to the models there
Point = tuple[int, int]  # row and column in the grid
Edge = tuple[Point, Point]


class Edges(NamedTuple):
    """Edges of the grid that the boundary crosses: places of both ends and the crossing, (k, 2) each; its root (k,)."""

    first: Array
    last: Array
    crossing: Array
    eigenvalue: Array


def largest_growth(model: LinearModel, level: float = 0.0) -> tuple[Array, Array]:
    """Largest growth Re λ + ζ0 |λ| of all modes (...,) and the eigenvalue that has it; NaN at failed points.

    The growth of a root that is neutral within its error is zero.
    """
    values, error = roots(model, level)
    found = growth(values, level)
    found = np.where(np.abs(found) <= growth_error(error, level), 0.0, found)
    place = np.where(np.isnan(found), -np.inf, found).argmax(axis=-1)[..., None]
    best, critical = (np.take_along_axis(part, place, -1)[..., 0] for part in (found, values))
    return best, critical.real + 1j * np.abs(critical.imag)


def stability_map(
    case: Configuration,
    axes: Mapping[str, ArrayLike],
    *,
    airspeed: Any = None,
    level: float = 0.0,
    **options: Any,
) -> xarray.Dataset:
    """Stability of a case over two inputs.

    Parameters
    ----------
    case : Case
    axes : mapping of str to array
        Two inputs, x and y, and their values, rising: paths in the deck (`proprotor.deck.vary.design_inputs`), or
        "airspeed". Numbers are in SI; text such as "1:4:0.5 deg", quantities and data arrays have their unit.
    airspeed : float in m/s, text such as "300 kt", or pint quantity
        Where it is not one of the axes.
    level : float
        Damping ratio that counts as the boundary.
    **options
        See `proprotor.rotor.options.Options`.

    Returns
    -------
    xarray.Dataset
        growth (y, x), the largest Re λ + ζ0 |λ| of all modes, 1/s, positive where a mode is beyond the level; frequency
        of that mode, rad/s; reason of points that failed, warning of those that are doubtful. boundary (vertex, axis):
        the line between, in lines parted by NaN; boundary_eigenvalue (vertex,), the root that crosses there, rad/s;
        boundary_warning (vertex,), what makes it doubtful there. Attributes: level, airspeed in m/s where it is given,
        eigen_solves, and the case and its options (`proprotor.model.stamp`).

    Raises
    ------
    InputError
        For axes that are not two, values that do not rise, an unknown input, an airspeed that is missing, or a grid
        that does not fit into memory.
    """
    names, values = _axes(case, axes)
    plane = _plane(case, names, airspeed, options)
    x, y = values
    points = len(x) * len(y)
    check_memory("axes", f"{points:.4g} points", _BYTES_PER_POINT * points, "the map", "take larger steps")
    grid_x, grid_y = (part.reshape(-1) for part in np.meshgrid(x, y))
    parts = [
        _evaluated(plane, grid_x[start : start + _AT_ONCE], grid_y[start : start + _AT_ONCE], level)
        for start in range(0, len(grid_x), _AT_ONCE)
    ]
    shape = (len(y), len(x))
    largest, value, reason, warning = (
        np.concatenate(part).reshape(shape) for part in zip(*parts, strict=True)
    )
    edges, solves = _crossings(plane, x, y, largest, level)
    found = _dataset(names, values, largest, value, edges)
    for name, texts, meaning in (
        ("reason", reason, "why a point failed"),
        ("warning", warning, "what makes a point doubtful"),
    ):
        found[name] = names[::-1], texts.astype(str), {"long_name": meaning}
    found["boundary_warning"] = (
        "vertex",
        _warnings_at(plane, found.boundary.values),
        {"long_name": "what makes the boundary doubtful"},
    )
    found.attrs = stamp.of_case(case, options) | {"level": level}
    if airspeed is not None:
        found.attrs[AIRSPEED] = float(in_metres_per_second(airspeed))
    found.attrs["eigen_solves"] = int(np.isfinite(largest).sum()) + solves
    for name in names:
        found[name].attrs["units"] = "m/s" if name == AIRSPEED else design_inputs(case)[name].unit
    return found


def _axes(case: Configuration, axes: Mapping[str, ArrayLike]) -> tuple[tuple[str, str], tuple[Array, Array]]:
    if len(axes) != 2:
        raise InputError("axes", ", ".join(axes), "must be two inputs")
    from proprotor.units import values_in_si

    known = design_inputs(case)
    for name in axes:
        if name != AIRSPEED and name not in known:
            raise InputError(name, None, unknown_name(name, known, "input"))
    names = tuple(axes)
    values = tuple(
        in_metres_per_second(given) if name == AIRSPEED else values_in_si(given, known[name].unit, name)
        for name, given in axes.items()
    )
    for name, given in zip(names, values, strict=True):
        if given.ndim != 1 or len(given) < 2 or not np.all(np.diff(given) > 0):
            raise InputError(name, given.tolist(), "must be a list of values that rise")
    (x, y), (along_x, along_y) = names, values
    return (x, y), (along_x, along_y)


def _plane(case: Configuration, names: tuple[str, str], airspeed: Any, options: Mapping[str, Any]) -> Plane:
    if AIRSPEED not in names and airspeed is None:
        raise InputError("airspeed", None, "must be given, or be one of the axes")
    if AIRSPEED in names and airspeed is not None:
        raise InputError("airspeed", airspeed, "is one of the axes already")

    own = {} if AIRSPEED in names else {AIRSPEED: airspeed}
    return lambda x, y: models_at(case, own | dict(zip(names, (x, y), strict=True)), options)


def _evaluated(plane: Plane, x: Array, y: Array, level: float) -> tuple[Array, Array, Array, Array]:
    model = plane(x, y)
    return *largest_growth(model, level), model.trim.reason, model.trim.warning


def _warnings_at(plane: Plane, vertices: Array) -> Array:
    """What makes each vertex (vertices, 2) doubtful; nothing between two lines."""
    warnings = np.full(len(vertices), "", dtype=object)
    there = np.flatnonzero(np.isfinite(vertices).all(axis=1))
    for start in range(0, len(there), _AT_ONCE):
        some = there[start : start + _AT_ONCE]
        warnings[some] = plane(vertices[some, 0], vertices[some, 1]).trim.warning
    return warnings.astype(str)


def _crossings(plane: Plane, x: Array, y: Array, largest: Array, level: float) -> tuple[Edges, int]:
    """The boundary on the edges of the grid: the first onset on the way from the stable end, on all of them at once."""
    unstable = largest > 0
    good = np.isfinite(largest)
    along_x = np.argwhere((unstable[:, 1:] != unstable[:, :-1]) & good[:, 1:] & good[:, :-1])
    along_y = np.argwhere((unstable[1:] != unstable[:-1]) & good[1:] & good[:-1])
    first = np.concatenate([along_x, along_y])
    last = np.concatenate([along_x + np.array([0, 1]), along_y + np.array([1, 0])])
    turned = unstable[tuple(first.T)][:, None]
    stable, other = np.where(turned, last, first), np.where(turned, first, last)
    start, end = (np.stack([x[place[:, 1]], y[place[:, 0]]], axis=1) for place in (stable, other))
    share, value = np.full(len(first), 0.5), np.full(len(first), complex(np.nan, np.nan))
    solves = 0
    for begin in range(0, len(first), _AT_ONCE // 2):
        some = slice(begin, begin + _AT_ONCE // 2)
        share[some], value[some], count = _onsets(plane, start[some], end[some], level)
        solves += count
    return Edges(first, last, start + share[:, None] * (end - start), value), solves


def _onsets(plane: Plane, start: Array, end: Array, level: float) -> tuple[Array, Array, int]:
    """First onset on the straight way from each start to its end, as a share of it, the root there, and eigen-solves.

    Where a point on the way cannot be analysed, the middle of what holds the onset.
    """

    def models(edge: Array, share: Array) -> LinearModel:
        at = start[edge] + share[:, None] * (end[edge] - start[edge])
        return plane(at[:, 0], at[:, 1])

    count = len(start)
    share, value = np.full(count, np.inf), np.full(count, complex(np.nan, np.nan))
    if not count:
        return share, value, 0
    search = Search(
        models, np.repeat(np.arange(count), 2), np.tile([0.0, 1.0], count), level, onset_only=True
    )
    if search.scanned.points is None:
        return np.full(count, 0.5), value, 0
    brackets = Brackets(search)
    for one in brackets.close():
        if one.position < share[one.line]:
            share[one.line], value[one.line] = one.position, one.value.real + 1j * abs(one.value.imag)
    for place in brackets.lost:
        edge = brackets.line[place]
        share[edge] = min(share[edge], brackets.x[:, place].mean())
    return np.where(np.isfinite(share), share, 0.5), value, int(search.solves.sum() + brackets.solves.sum())


def _lines(edges: Edges, largest: Array) -> Array:
    """Places (vertices,) of crossings in the order of the lines they form, parted by -1."""
    place = {
        (tuple(first), tuple(last)): number
        for number, (first, last) in enumerate(zip(edges.first.tolist(), edges.last.tolist(), strict=True))
    }
    neighbours: dict[int, list[int]] = defaultdict(list)
    for row, column in np.ndindex(largest.shape[0] - 1, largest.shape[1] - 1):
        for one, other in _in_cell(place, row, column, largest):
            neighbours[one].append(other)
            neighbours[other].append(one)
    ordered: list[int] = []
    left = set(neighbours)
    while left:
        ends = [number for number in left if len(neighbours[number]) == 1]
        line = _walk(min(ends or left), neighbours, left)
        ordered += [*line, -1]
    return np.array(ordered[:-1], dtype=int)


def _walk(start: int, neighbours: Mapping[int, list[int]], left: set[int]) -> list[int]:
    """Vertices from one end of a line to the other; a closed line ends where it began."""
    line, here = [start], start
    left.discard(start)
    while ahead := [number for number in neighbours[here] if number in left]:
        here = ahead[0]
        line.append(here)
        left.discard(here)
    if len(line) > 2 and start in neighbours[here]:
        line.append(start)
    return line


def _in_cell(place: Mapping[Edge, int], row: int, column: int, largest: Array) -> list[tuple[int, int]]:
    """Pairs of crossings that the boundary joins within one cell; two pairs at a saddle, by the mean of its corners."""
    a, b, c, d = (row, column), (row, column + 1), (row + 1, column + 1), (row + 1, column)
    sides = ((a, b), (b, c), (d, c), (a, d))
    found = [place[edge] for edge in sides if edge in place]
    if len(found) == 2:
        return [(found[0], found[1])]
    if len(found) < 4:
        return []
    first, second, third, fourth = found
    centre = np.mean([largest[corner] for corner in (a, b, c, d)]) > 0
    if centre == (largest[a] > 0):  # a and c are joined: the boundary cuts off b and d
        return [(first, second), (third, fourth)]
    return [(first, fourth), (second, third)]


def _dataset(
    names: tuple[str, str],
    values: tuple[Array, Array],
    largest: Array,
    value: Array,
    edges: Edges,
) -> xarray.Dataset:
    import xarray  # here, because it takes long to import

    line = _lines(edges, largest)
    vertices = np.where((line < 0)[:, None], np.nan, edges.crossing[line]) if len(line) else np.empty((0, 2))
    root = np.where(line < 0, np.nan, edges.eigenvalue[line]) if len(line) else np.empty(0, dtype=complex)

    dims = names[::-1]
    frequency = np.where(np.isnan(largest), np.nan, value.imag)
    return xarray.Dataset(
        {
            "growth": (dims, largest, {"units": "1/s", "long_name": "largest growth of all modes"}),
            "frequency": (dims, frequency, {"units": "rad/s", "long_name": "of the mode that grows most"}),
            "boundary": (("vertex", "axis"), vertices),
            "boundary_eigenvalue": (
                "vertex",
                root,
                {"units": "rad/s", "long_name": "root that is neutral there"},
            ),
        },
        coords={names[0]: values[0], names[1]: values[1], "axis": list(names)},
    )
