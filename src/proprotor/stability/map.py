"""Where in the plane of two inputs a case is stable, and the boundary between stable and unstable points.

A grid of points is evaluated as one batch. Where one of two neighbours of the grid is stable and the other is not, the
first onset on the way from the stable one is found as any boundary is (`proprotor.stability.crossings`), all edges at
once; contourpy joins these crossings into lines. Two crossings on one edge, between neighbours that are both stable or
both not, are finer than the grid.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.deck.input_values import input_values
from proprotor.deck.vary import inputs_at
from proprotor.errors import InputError
from proprotor.model import stamp
from proprotor.model.configuration import Configuration
from proprotor.model.linear_model import LinearModel
from proprotor.needs import check_memory
from proprotor.stability.brackets import Brackets
from proprotor.stability.crossings import Search
from proprotor.stability.parameter_lines import AIRSPEED, models_at
from proprotor.stability.root_error import growth, growth_error, roots
from proprotor.typing import Array, Dataset
from proprotor.units import in_metres_per_second

_AT_ONCE = 4096  # points of one batch
_OFF_ZERO = 1e-6  # of the largest growth: no corner is nearer to zero while lines are joined
_BYTES_PER_POINT = 100.0  # of the grid: its inputs, its results, and the edges of the boundary

_Plane = Callable[[Array, Array], LinearModel]  # x and y (k,) to the models there


class _Edges(NamedTuple):
    """Edges of the grid that the boundary crosses.

    first, last : row and column of both ends (k, 2); crossing (k, 2), in SI; eigenvalue (k,), the root at the crossing.
    """

    first: Array
    last: Array
    crossing: Array
    eigenvalue: Array


def largest_growth(model: LinearModel, level: float = 0.0) -> tuple[Array, Array]:
    """Return the largest growth Re λ + ζ0 |λ| of all modes (...,), 1/s, and the eigenvalue that has it, rad/s.

    The growth of a root that is neutral within its error is zero. Growth and eigenvalue are NaN at failed points.
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
) -> Dataset:
    """Return the stability of a case over two inputs, by modes of every kind: of an aircraft also those of its flight.

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
        of the mode that grows most, rad/s; reason of points that failed, warning of points that are doubtful. boundary
        (vertex, axis): the boundary between stable and unstable points, NaN between its lines; boundary_eigenvalue
        (vertex,), the root that crosses at a vertex, rad/s; boundary_warning (vertex,), what makes a vertex doubtful.
        The axes have the deck's own values as attribute of_deck. Attributes: level, airspeed in m/s where it is given,
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
    inner = int(
        names[1] == AIRSPEED
    )  # the axis along which points follow each other: what varies least is derived once
    grid = np.meshgrid(x, y, indexing="ij" if inner else "xy")
    grid_x, grid_y = (part.reshape(-1) for part in grid)
    parts = []
    for some in _batches(points, max(1, _AT_ONCE // len(values[inner])) * len(values[inner])):
        model = plane(grid_x[some], grid_y[some])
        parts.append((*largest_growth(model, level), model.trim.reason, model.trim.warning))
    found_there = [np.concatenate(part).reshape(grid[0].shape) for part in zip(*parts, strict=True)]
    largest, value, reason, warning = (part.T if inner else part for part in found_there)
    edges, solves = _crossings(plane, x, y, largest, level)
    found = _dataset(names, values, largest, value, edges)
    found["reason"] = names[::-1], reason.astype(str), {"long_name": "why a point failed"}
    found["warning"] = names[::-1], warning.astype(str), {"long_name": "what makes a point doubtful"}
    doubtful = _warnings_at(plane, found.boundary.values)
    found["boundary_warning"] = "vertex", doubtful, {"long_name": "what makes the boundary doubtful"}
    found.attrs = stamp.of_case(case, options, names) | {"level": level}
    if airspeed is not None:
        found.attrs[AIRSPEED] = float(in_metres_per_second(airspeed, case.operation.density))
    found.attrs["eigen_solves"] = int(np.isfinite(largest).sum()) + solves
    for name in names:
        found[name].attrs |= {"units": "m/s"} if name == AIRSPEED else _of_deck(case, name)
    return found


def _of_deck(case: Configuration, name: str) -> dict[str, Any]:
    """Return the unit of an input, and its value in the deck where that is one number."""
    own = inputs_at(case, [name])[name]
    value = {"of_deck": float(own.si)} if np.ndim(own.si) == 0 else {}
    return {"units": own.unit} | value


def _axes(case: Configuration, axes: Mapping[str, ArrayLike]) -> tuple[tuple[str, str], tuple[Array, Array]]:
    """Return the names and the values, in SI, of both axes."""
    if len(axes) != 2:
        raise InputError("axes", ", ".join(axes), "must be two inputs")
    known, found = inputs_at(case, [name for name in axes if name != AIRSPEED]), {}
    for name, given in axes.items():
        values = (
            in_metres_per_second(given, stamp.one_density(case, axes))
            if name == AIRSPEED
            else input_values(name, given, known[name])
        )
        if values.ndim != 1 or len(values) < 2 or not np.all(np.diff(values) > 0):
            raise InputError(name, values.tolist(), "must be a list of values that rise")
        found[name] = values
    x, y = found
    return (x, y), (found[x], found[y])


def _plane(case: Configuration, names: tuple[str, str], airspeed: Any, options: Mapping[str, Any]) -> _Plane:
    """Return the function that linearises the case at points of the plane."""
    if AIRSPEED not in names and airspeed is None:
        raise InputError("airspeed", None, "must be given, or be one of the axes")
    if AIRSPEED in names and airspeed is not None:
        raise InputError("airspeed", airspeed, "is one of the axes already")
    own = (
        {}
        if AIRSPEED in names
        else {AIRSPEED: in_metres_per_second(airspeed, stamp.one_density(case, names))}
    )
    return lambda x, y: models_at(case, own | dict(zip(names, (x, y), strict=True)), options)


def _batches(count: int, most: int = _AT_ONCE) -> list[slice]:
    """Return slices that divide so many points into batches."""
    return [slice(start, start + most) for start in range(0, count, most)]


def _warnings_at(plane: _Plane, vertices: Array) -> Array:
    """Return what makes each vertex (vertices, 2) doubtful; nothing between two lines."""
    warnings = np.full(len(vertices), "", dtype=object)
    there = np.flatnonzero(np.isfinite(vertices).all(axis=1))
    for batch in _batches(len(there)):
        warnings[there[batch]] = plane(*vertices[there[batch]].T).trim.warning
    return warnings.astype(str)


def _crossings(plane: _Plane, x: Array, y: Array, largest: Array, level: float) -> tuple[_Edges, int]:
    """Find the first onset on each edge of the grid on the way from its stable end, and count eigen-solves."""
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
    for some in _batches(len(first), _AT_ONCE // 2):
        share[some], value[some], count = _onsets(plane, start[some], end[some], level)
        solves += count
    return _Edges(first, last, start + share[:, None] * (end - start), value), solves


def _onsets(plane: _Plane, start: Array, end: Array, level: float) -> tuple[Array, Array, int]:
    """Return the first onset on the straight way from each start to its end, its root, and the number of eigen-solves.

    The onset is a share of the way. Where a point on the way cannot be analysed, it is the middle of the bracket.
    """

    def models(edge: Array, share: Array) -> LinearModel:
        at = start[edge] + share[:, None] * (end[edge] - start[edge])
        return plane(at[:, 0], at[:, 1])

    count = len(start)
    share, value = np.full(count, np.inf), np.full(count, complex(np.nan, np.nan))
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


def _lines(edges: _Edges, largest: Array) -> Array:
    """Return places (vertices,) of crossings in the order of the lines that they form, parted by -1.

    At a saddle the mean of the four corners tells which crossings are joined.
    """
    from contourpy import contour_generator  # here, because few need it

    if not len(edges.first):
        return np.empty(0, dtype=int)
    # A corner at zero would put a vertex on two edges at once.
    least = _OFF_ZERO * np.nanmax(np.abs(largest))
    height = np.where(largest > 0, np.maximum(largest, least), np.minimum(largest, -least))
    drawn = contour_generator(z=np.ma.masked_invalid(height), corner_mask=True).lines(0.0)
    place = {tuple(twice): number for number, twice in enumerate((edges.first + edges.last).tolist())}
    lines = []
    for vertices in drawn:
        # Beside a failed corner a line ends on a diagonal, which is none of the edges.
        line = [place[twice] for twice in _twice_middle(np.asarray(vertices)) if twice in place]
        if len(line) > 1:
            lines.append(line if line[0] < line[-1] else line[::-1])
    return np.array([number for line in sorted(lines) for number in (*line, -1)][:-1], dtype=int)


def _twice_middle(vertices: Array) -> list[tuple[int, int]]:
    """Return twice the row and column of the middle of the edge on which each vertex (k, 2), of x and y, lies."""
    on_grid = np.round(vertices)
    twice = np.where(np.abs(vertices - on_grid) < _OFF_ZERO / 10, 2 * on_grid, 2 * np.floor(vertices) + 1)
    return [(int(row), int(column)) for column, row in twice]


def _dataset(
    names: tuple[str, str],
    values: tuple[Array, Array],
    largest: Array,
    value: Array,
    edges: _Edges,
) -> Dataset:
    """Return the dataset of a map from what was found at its points and on its edges."""
    import xarray  # here, because it takes long to import

    line = _lines(edges, largest)
    vertices = np.where((line < 0)[:, None], np.nan, edges.crossing[line])
    root = np.where(line < 0, np.nan, edges.eigenvalue[line])
    dims = names[::-1]
    frequency = np.where(np.isnan(largest), np.nan, value.imag)
    meaning = {"units": "rad/s", "long_name": "root that is neutral at the vertex"}
    return xarray.Dataset(
        {
            "growth": (dims, largest, {"units": "1/s", "long_name": "largest growth of all modes"}),
            "frequency": (dims, frequency, {"units": "rad/s", "long_name": "of the mode that grows most"}),
            "boundary": (("vertex", "axis"), vertices),
            "boundary_eigenvalue": ("vertex", root, meaning),
        },
        coords={names[0]: values[0], names[1]: values[1], "axis": list(names)},
    )
