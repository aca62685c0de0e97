"""Names of modes: what moves in a mode at a point, by participation and by the way cyclic motion whirls.

A model has as many names as modes: one for each coordinate of the support, for coning and the collective motion of each
other blade angle, for the rotor speed, and two for the cyclic motion of each blade angle and of the gimbal, regressive
and progressive. At each point the modes get their names by the assignment with the largest sum of participations, one
name to one mode. The halves of the motion of an aircraft that do not couple have assignments of their own. The names
depend on the eigenvalues and vectors of the point alone, and on no other point. Where two branches veer and exchange
their motions, the names pass from one branch to the other in the middle: where the sum of participations is the same
for either assignment. Which branch is which is another question, answered by following roots:
`proprotor.stability.branches`.

The share that a mode has in its own name says how much the name is worth: near 1 nothing else moves, below one third
something else may move more.

A cyclic motion alone has two modes. In the rotating frame they have one frequency ν and run round the rotor forwards,
progressive, or backwards, regressive; in the fixed frame they appear at ν + 1 and at |ν - 1| per revolution. The
progressive mode whirls with the rotor in the fixed frame; the regressive mode against the rotor for ν > 1, and with the
rotor, but slower than the blades, for ν < 1. A mode of the whole system is progressive by the participation of the
progressive mode, and regressive by that of the regressive mode: motion and rate of β_1c + i β_1s are the sum of both.
How a mode whirls in the fixed frame is another number, `whirl`. In the fixed frame β_1c + i β_1s is what whirls with
the rotor and β_1c - i β_1s what whirls against it, for s = iω, ω > 0 and an azimuth that grows with rotation (β = β_1c
cos ψ + β_1s sin ψ).
"""

from __future__ import annotations

from functools import lru_cache
from itertools import combinations
from typing import NamedTuple

import numpy as np

from proprotor.model.first_order import held_coordinates, some_points
from proprotor.model.linear_model import LinearModel
from proprotor.rotor.motions import HUB, SECOND, motions, name_list
from proprotor.stability.assignment import best_assignment
from proprotor.stability.matching import Modes
from proprotor.stability.modes import coordinate_motion
from proprotor.stability.participation import participation, whirling
from proprotor.stability.real_modes import by_pairs, mode_of_states, places_of, upper_places
from proprotor.typing import Array

DOUBTFUL = 1 / 3  # a share below which two other motions may each move more
_TIE = 1e-6  # of a share: what parts names that fit equally well, above the rounding of vectors
_AT_ONCE = 256  # points whose vectors stay in the cache
_STILL = 1e-6  # participation of cyclic motion below which the way it whirls is rounding


class Moving(NamedTuple):
    """What moves in the modes of points.

    Attributes
    ----------
    known : list of str
        The names of the model, in the order of its coordinates.
    place : array (..., states) of int
        The name of each state, by its place in `known`; -1 at failed points. Both states of a pair have one name; a
        name that two real roots have stands twice.
    shares : array (..., names, states)
        Participation of each name's motion in each state, 0 to 1; NaN at failed points.
    is_second : array (..., states) of bool
        Whether a state is the second of two real roots with one name: the one that decays faster, or grows less.
    """

    known: list[str]
    place: Array
    shares: Array
    is_second: Array

    @property
    def names(self) -> Array:
        """The name of each state (..., states), as text, different for all modes of a point; empty at failed points."""
        several = [*self.known, *(name + SECOND for name in self.known), ""]
        return np.array(several, dtype=object)[
            np.where(self.is_second, len(self.known) + self.place, self.place)
        ]

    @property
    def share(self) -> Array:
        """Participation (..., states) of the motion that each state is named after, 0 to 1."""
        rows = np.maximum(self.place, 0)[..., None, :]
        share: Array = np.take_along_axis(self.shares, rows, -2)[..., 0, :]
        return share


def moving(model: LinearModel, values: Array, left: Array, right: Array) -> Moving:
    """Return what moves in each mode of each point: a function of the point alone.

    Parameters
    ----------
    model : LinearModel
        Its points (...) are the points of the eigenvalues.
    values : array (..., states)
        All eigenvalues, rad/s, each pair side by side.
    left, right : array (..., states, states)
        Left vectors in rows, right ones in columns, left @ right = 1, as from
        `proprotor.stability.matching.Spectrum.all_modes`.
    """
    states = values.shape[-1]
    known, held = name_list(model.dofs), held_coordinates(model, states)
    place, shares = (
        np.full((values.size // states, states), -1),
        np.full((values.size // states, len(known), states), np.nan),
    )
    for points, pairs in by_pairs(values.reshape(-1, states), _AT_ONCE):
        at = np.unravel_index(points, values.shape[:-1]) if values.ndim > 1 else None
        roots, part = values[at], some_points(model, at)
        upper = upper_places(places_of(roots, pairs), pairs)
        vectors = np.take_along_axis(right[at], upper[:, None, :], -1)
        rows = np.take_along_axis(left[at], upper[:, :, None], -2)
        taken = participation(part, held, rows.T, np.moveaxis(vectors, 0, -1)).names
        mode = mode_of_states(roots, upper)
        place[points] = np.take_along_axis(named_after(part, roots, upper, taken).T, mode, 1)
        shares[points] = np.moveaxis(np.take_along_axis(taken, mode.T[None], 1), -1, 0)
    place = place.reshape(values.shape)
    shares = shares.reshape(*values.shape[:-1], len(known), states)
    return Moving(known, place, shares, _second_roots(place, values))


def _second_roots(place: Array, values: Array) -> Array:
    """Return whether states (..., states) are the second of two real roots with one name."""
    of_real = np.where(values.imag == 0, place, -1)
    order = np.lexsort((-values.real, of_real), axis=-1)
    ordered = np.take_along_axis(of_real, order, -1)
    second = np.zeros(place.shape, dtype=bool)
    second[..., 1:] = (ordered[..., 1:] == ordered[..., :-1]) & (ordered[..., 1:] >= 0)
    found = np.empty(place.shape, dtype=bool)
    np.put_along_axis(found, order, second, -1)
    return found


def named_after(model: LinearModel, values: Array, upper: Array, shares: Array) -> Array:
    """Return the name of each mode (modes, points) of points with one number of pairs, by its place in `name_list`.

    Parameters
    ----------
    model : LinearModel
        Of the points.
    values : array (points, states)
        All eigenvalues, each pair side by side; NaN for a state that a point does not have, though others do, which
        stands as a root at zero while names are given.
    upper : array (points, modes) of int
        State of one mode of each pair, and of each real mode.
    shares : array (names, modes, points)
        Participation in these modes.
    """
    held = tuple(held_coordinates(model, values.shape[-1]))
    groups = _groups(model.dofs, tuple(map(tuple, model.blocks)), held)
    return _assign_names(groups, np.where(np.isnan(values), 0, values), upper, shares)


def _assign_names(groups: tuple[_Group, ...], values: Array, upper: Array, shares: Array) -> Array:
    """Return names as `named_after`, from the names and states of coordinates that do not couple with others.

    The assignment with the largest sum of shares is taken. Where the best names of all states are different, these are
    that assignment. Of assignments that are equally good, as for a propeller on a pivot that is alike in all
    directions, the one is taken in which frequencies rise in the order of the names, so that rounding does not decide.
    """
    rank, of_name = np.empty(values.shape), np.empty(len(shares))
    for one in groups:
        rank[:, one.states] = _ranks(values[:, one.states])
        of_name[one.names] = np.linspace(0, 1, len(one.names))
    gain = np.take_along_axis(rank, upper, 1).T * (_TIE * of_name)[:, None, None]
    gain += shares
    best: Array = gain.argmax(axis=0)
    is_pair = np.take_along_axis(values, upper, 1).T.imag > 0
    points = np.arange(len(values))
    counts = np.bincount(
        (best * len(points) + points).ravel(), (1 + is_pair).ravel(), minlength=len(shares) * len(points)
    ).reshape(len(shares), -1)
    for one in groups:
        for point in np.flatnonzero((counts[one.names] != one.counts[:, None]).any(axis=0)):
            modes = np.flatnonzero((upper[point] >= one.states.start) & (upper[point] < one.states.stop))
            fit = gain[one.names, modes[:, None], point]
            best[modes, point] = one.names[_assigned(one, fit, is_pair[modes, point])]
    return best


class _Group(NamedTuple):
    """Names and states of coordinates that do not couple with others.

    names (k,) : places of the names in `name_list`; states : place of the states in the spectrum; counts (k,) : number
    of states that have each name; whole, half : the names of two states, a pair or two real roots, and those of one, by
    their place in `names`.
    """

    names: Array
    states: slice
    counts: Array
    whole: list[int]
    half: list[int]


@lru_cache(maxsize=16)  # of the models of an analysis, which has many batches
def _groups(
    dofs: tuple[str, ...], blocks: tuple[tuple[int, ...], ...], held: tuple[int, ...]
) -> tuple[_Group, ...]:
    """Return the groups of coordinates: a mode's name counts twice, that of a rate alone once."""
    known, found, first = name_list(dofs), [], 0
    for own in blocks:
        some = motions(tuple(dofs[one] for one in own))
        names = [(known.index(name), motion.places) for motion in some for name in motion.names]
        counts = [1 if len(places) == 1 and own[places[0]] not in held else 2 for _, places in names]
        states = slice(first, first := first + sum(counts))
        whole, half = ([place for place, one in enumerate(counts) if one == count] for count in (2, 1))
        found.append(_Group(np.array([name for name, _ in names]), states, np.array(counts), whole, half))
    return tuple(found)


def whirl(model: LinearModel, modes: Modes) -> Array:
    """Return the sense of whirl in the fixed frame (..., modes): 1 with the rotor, -1 against the rotor.

    The cyclic motion of blades and gimbal counts, by participation. In a mode without cyclic motion, as in all modes of
    a propeller on a pivot, the motion of the shaft's axis counts, and where the axis does not tilt, that of the hub's
    centre. NaN for real roots, and where nothing goes round.
    """
    values, right, left = modes
    held = held_coordinates(model, right.shape[-2])
    shares = whirling(model.dofs, held, np.moveaxis(left, -1, 0), np.moveaxis(right, -2, 0)).sum(axis=1)
    shares = np.where(shares.sum(axis=0) < _STILL, _hub_whirl(model, values, right), shares)
    against, with_rotor = shares
    total = against + with_rotor
    turned = np.where(values.imag < 0, -1.0, 1.0) * (with_rotor - against)
    return np.where((total > 0) & (values.imag != 0), turned / np.where(total > 0, total, 1), np.nan)


def _hub_whirl(model: LinearModel, values: Array, right: Array) -> Array:
    """Return the squares of motion against and with the rotor (2, ..., modes) of the shaft's axis, or of the hub."""
    n = len(model.dofs)
    shape = np.nan_to_num(coordinate_motion(held_coordinates(model, right.shape[-2]), n, values, right))
    if model.hub is not None:
        moved = np.asarray(model.hub) @ shape
    else:
        moved = np.zeros((*shape.shape[:-2], len(HUB), shape.shape[-1]), dtype=complex)
        for axis, name in enumerate(HUB):
            if name in model.dofs:
                moved[..., axis, :] = shape[..., model.dofs.index(name), :]
    x, y, _, about_x, about_y, _ = np.moveaxis(moved, -2, 0)
    # The axis k leans by α × k = (α_y, -α_x); x leads y by a quarter where a point goes round with the rotor.
    tilt, way = (np.abs([a - 1j * b, a + 1j * b]) ** 2 for a, b in ((about_y, -about_x), (x, y)))
    return np.where(tilt.sum(axis=0) > 0, tilt, way)


def _ranks(values: Array) -> Array:
    """Return the ranks of frequencies (points, states), 0 to 1."""
    order = np.lexsort((values.real, np.abs(values.imag)), axis=-1)
    rank = np.empty(values.shape)
    np.put_along_axis(rank, order, np.broadcast_to(np.linspace(0, 1, values.shape[-1]), values.shape), -1)
    return rank


def _assigned(group: _Group, gain: Array, is_pair: Array) -> Array:
    """Return the best assignment of names to the modes (modes,) of one point, by their place in the group.

    Both states of a pair have one name.

    Parameters
    ----------
    group : _Group
    gain : array (modes, names)
    is_pair : array (modes,) of bool
        Whether a mode is a pair, or a real root.
    """
    pairs, real = is_pair.nonzero()[0], (~is_pair).nonzero()[0]
    if len(pairs) != len(group.whole):
        modes = np.repeat(np.arange(len(gain)), 1 + is_pair)
        slots = np.repeat(np.arange(len(group.counts)), group.counts)
        of_states = slots[best_assignment(gain[modes[:, None], slots])]
        first = np.searchsorted(modes, np.arange(len(gain)))
        given: Array = of_states[first]
        # Of two rates that swing as one pair, the pair has one of their names.
        if len(pairs) > len(group.whole) or (of_states[first[pairs] + 1] == given[pairs]).all():
            return given
    # Two real roots that fit different names would split the names of a pair: try each choice of names for real roots.
    given, largest = np.empty(len(gain), dtype=int), -np.inf
    for left in combinations(group.whole, len(group.whole) - len(pairs)):
        of_pairs = [name for name in group.whole if name not in left]
        total, chosen = 0.0, []
        for modes, names, states in ((pairs, of_pairs, 2), (real, [*left, *left, *group.half], 1)):
            fit = gain[modes[:, None], names]
            best = best_assignment(fit)
            total += states * fit[np.arange(len(modes)), best].sum()
            chosen.append(np.array(names, dtype=int)[best])
        if total > largest:
            largest = total
            given[pairs], given[real] = chosen
    return given
