"""Points of many lines of models, solved at once: the roots of each point, how they move, and their growth.

The level is a damping ratio ζ0, and the growth G = Re λ + ζ0 |λ| is positive where the damping -Re λ/|λ| is below the
level. Each root has G and its exact derivative at every point, from matrices a complex step away.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from proprotor.errors import InputError
from proprotor.model.first_order import blocks, held_coordinates, missing_roots, some_points
from proprotor.model.linear_model import LinearModel
from proprotor.stability.eigenvalue_derivatives import eigenvalue_change, with_changes
from proprotor.stability.matching import Spectrum
from proprotor.stability.modes import decomposition
from proprotor.stability.root_error import growth, growth_error, refined_near, roots
from proprotor.typing import Array

_AT_ONCE = 2000  # points whose matrices are in memory: enough for NumPy's own cost to vanish

Models = Callable[[Array, Array], LinearModel]  # lines (k,) of int and positions (k,) to the models there


def growth_rate(values: Array, changes: Array, level: float = 0.0) -> Array:
    """Return the change of G with a change of λ."""
    if not level:
        return changes.real
    size = np.abs(values)
    return changes.real + level * (values.conj() * changes).real / np.where(size > 0, size, 1)


class Points(NamedTuple):
    """Points of lines: the roots of each point, refined, and how they move.

    line, position (k,); spectrum; change (k, states) : of each root with the position; growth, slope, error
    (k, states) : the growth G, its change with the position, and its error.
    """

    line: Array
    position: Array
    spectrum: Spectrum
    change: Array
    growth: Array
    slope: Array
    error: Array

    def at(self, rows: Array) -> Points:
        """Return some of the points."""
        parts = {name: own[rows] for name, own in self._asdict().items() if name != "spectrum"}
        return Points(spectrum=self.spectrum.at(rows), **parts)

    def joined(self, *others: Points) -> Points:
        """Return these points and all others."""
        spectrum = self.spectrum.joined(*(other.spectrum for other in others))
        parts = {
            name: np.concatenate([own, *(getattr(other, name) for other in others)])
            for name, own in self._asdict().items()
            if name != "spectrum"
        }
        return Points(spectrum=spectrum, **parts)


class Solved(NamedTuple):
    """The result of a number of eigen-solves.

    points : the points that work, None if no point does; works (k,) : which of all points these are; reason (k,) : why
    a point failed; warning (k,) : what makes a point doubtful; missing (k,) : why a point has fewer eigenvalues than
    others; is_compiled : whether compiled functions took the points.
    """

    points: Points | None
    works: Array
    reason: Array
    warning: Array
    missing: Array
    is_compiled: bool = False


def solve_points(
    models: Models,
    line: Array,
    position: Array,
    level: float,
    forgiving: bool = False,
    states: int | None = None,
    plain: bool = False,
) -> Solved:
    """Solve points of lines, a number of them at once; a point that cannot be solved spoils no other point.

    Parameters
    ----------
    models : callable
        Takes lines (k,) and positions (k,) and returns the models of these points.
    line, position : array (k,)
        The points.
    level : float
        Damping ratio.
    forgiving : bool
        Whether an impossible input is the reason of its point, and not raised.
    states : int, optional
        Number of eigenvalues that arrays have room for; by default that of the point with the most.
    plain : bool
        Whether to find eigenvalues alone, for a quarter of the cost: the spectrum then has no vectors, and derivatives
        are NaN.

    Raises
    ------
    InputError
        For an impossible input, unless `forgiving`.
    """
    failures = (np.linalg.LinAlgError, InputError) if forgiving else np.linalg.LinAlgError
    if len(line) <= _AT_ONCE:
        try:
            return _solved(models, line, position, level, states, plain)
        except failures as error:
            failure = str(error)
        if len(line) == 1:
            reason = np.array([" ".join(failure.split("\n"))], dtype=object)
            nothing = np.array([""], dtype=object)
            return Solved(None, np.array([False]), reason, nothing, nothing)
    count = max(2, -(-len(line) // _AT_ONCE))
    parts = [
        solve_points(models, line[some], position[some], level, forgiving, states, plain)
        for some in _parts(line, count)
    ]
    counts = {part.points.growth.shape[1] for part in parts if part.points is not None}
    if len(counts) > 1:  # a shaft holds the azimuth in some parts alone
        return solve_points(models, line, position, level, forgiving, max(counts), plain)
    return _together(parts)


def _parts(line: Array, count: int) -> list[Array]:
    """Return the places of points in about so many parts, of whole lines where there is more than one line."""
    ends = np.flatnonzero(line[1:] != line[:-1]) + 1
    cuts = np.arange(1, count) * len(line) // count
    if len(ends):
        cuts = np.unique(ends[np.minimum(np.searchsorted(ends, cuts), len(ends) - 1)])
    return np.split(np.arange(len(line)), cuts)


def _together(parts: list[Solved]) -> Solved:
    """Return the points of some results as one."""
    works, reason, warning, missing = (
        np.concatenate(own) for own in zip(*(part[1:5] for part in parts), strict=True)
    )
    found = [part.points for part in parts if part.points is not None]
    points = found[0].joined(*found[1:]) if found else None
    return Solved(points, works, reason, warning, missing, any(part.is_compiled for part in parts))


def _solved(
    models: Models, line: Array, position: Array, level: float, states: int | None, plain: bool
) -> Solved:
    """Solve points of lines; raise an error if one of them cannot be solved."""
    if plain:
        return _values_alone(models(line, position), line, position, level, states)
    model, changes = with_changes(lambda x: models(line, x), position)
    spectrum = decomposition(model, None if states is None else held_coordinates(model, states))
    works, states = spectrum.works, spectrum.values.shape[-1]
    if not works.any():
        return Solved(None, works, *_texts(model, states))
    part, some = some_points(model, works), spectrum.at(works)
    modes = some.all_modes
    found = refined_near(part, modes, level)
    mass, damping, stiffness = (np.broadcast_to(one, model.K.shape)[works] for one in changes)
    moved = modes._replace(values=found.values)
    change = eigenvalue_change(part, (mass, damping, stiffness), moved)
    spectrum = some._replace(values=found.values)
    points = _points(line[works], position[works], spectrum, change, found.error, level)
    return Solved(points, works, *_texts(model, states))


def _values_alone(
    model: LinearModel, line: Array, position: Array, level: float, states: int | None
) -> Solved:
    """Return the points without vectors and derivatives."""
    values, error = roots(model, level)
    works = np.asarray(np.isfinite(values).any(axis=-1))
    states = values.shape[-1] if states is None else states
    if not works.any():
        return Solved(None, works, *_texts(model, states))
    if not works.all():
        values, error = values[works], error[works]
    values, error = (_with_room(part, model, states) for part in (values, error))
    held = held_coordinates(model, states)
    none = np.empty((*values.shape, 0), dtype=complex)
    spectrum = Spectrum(values, none, held=tuple(held), blocks=blocks(model, held))
    unknown = np.full(values.shape, complex(np.nan))
    points = _points(line[works], position[works], spectrum, unknown, error, level)
    return Solved(points, works, *_texts(model, states), model.is_compiled)


def _with_room(values: Array, model: LinearModel, states: int) -> Array:
    """Return values (k, states of the model) with NaN at the end of each block that has room for more states."""
    if values.shape[1] == states:
        return values
    found = np.full((len(values), states), np.nan, dtype=values.dtype)
    narrow, wide = (blocks(model, held_coordinates(model, count)) for count in (values.shape[-1], states))
    for (_, own), (_, new) in zip(narrow, wide, strict=True):
        found[:, new.start : new.start + own.stop - own.start] = values[:, own]
    return found


def _points(
    line: Array, position: Array, spectrum: Spectrum, change: Array, error: Array, level: float
) -> Points:
    """Return points with the growth of each root, by its change with the position and its error (k, states)."""
    values = spectrum.values
    slope = growth_rate(values, change, level)
    return Points(line, position, spectrum, change, growth(values, level), slope, growth_error(error, level))


def _texts(model: LinearModel, states: int) -> tuple[Array, Array, Array]:
    """Return why points failed, what makes them doubtful, and why they have fewer roots than `states`."""
    reason, warning = (np.array(part, dtype=object) for part in (model.trim.reason, model.trim.warning))
    return reason, warning, missing_roots(model, states)
