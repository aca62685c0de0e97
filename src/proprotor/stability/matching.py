"""The same mode at neighbouring points: one-to-one, by vectors and eigenvalues, with a measure of trust.

A mode is followed by the likeness of its vectors at two points,

    S_ij = √( |l_i(1) r_j(2)| |l_j(2) r_i(1)| ),

l the rows of the inverse of the matrix of right vectors r. They are the mass-weighted left vectors: S is 1 for a mode
that has not changed and 0 for any other, whatever units coordinates have and however vectors are scaled. The distance
of the eigenvalues, as a part of the largest, is subtracted. The assignment with the largest sum of S_ij - d_ij is the
step. Where the best candidates of all states are different, they are the assignment: no permutation exceeds the sum of
the largest entries of the rows. Elsewhere `proprotor.stability.assignment` finds it.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import accumulate, pairwise
from typing import Any, NamedTuple

import numpy as np

from proprotor.model.first_order import StateBlocks
from proprotor.stability.assignment import best_assignment
from proprotor.stability.real_modes import COUPLED, RealModes, closeness, inverse, likeness, quality
from proprotor.typing import Array

_BLOCK = 128  # steps whose matrices stay in the cache
_APART = (
    10.0  # more than likeness and distance can be: taken off where two modes are of blocks that do not couple
)
NOT_TOLD = "the step to here does not tell which root is which"
POOR = 0.5  # quality of a step below which it is divided


class Matches(NamedTuple):
    """Which mode of a point is which at a later point, for some pairs of points.

    Attributes
    ----------
    successor : array (steps, states) of int
        Place at the later point of each state of the earlier point.
    quality : array (steps, states)
        Trust in the step of each state, 0 to 1: see `match_modes`.
    """

    successor: Array
    quality: Array


class Modes(NamedTuple):
    """Some modes of points: values (..., modes), right vectors (..., states, modes), left vectors (..., modes, states).

    left @ right is 1 for a mode with itself and 0 with any other mode.
    """

    values: Array
    right: Array
    left: Array

    def at(self, places: Array) -> Modes:
        """Return the modes of each point at some places (..., modes)."""
        return Modes(
            np.take_along_axis(self.values, places, -1),
            np.take_along_axis(self.right, places[..., None, :], -1),
            np.take_along_axis(self.left, places[..., :, None], -2),
        )


class Spectrum(NamedTuple):
    """Eigenvalues (..., states) and right vectors in columns (..., states, states), each pair side by side.

    A state that a point does not have, though others do, has a vector, and NaN as eigenvalue; a failed point has NaN
    alone.
    shapes (..., m, k) : shapes of the first k coordinates where these differ from point to point, else None; held :
    places of the coordinates whose displacement is a state, which shapes need; blocks : the rows and columns of states
    that do not couple with others, empty where all may couple.
    """

    values: Array
    right: Array
    shapes: Array | None = None
    held: tuple[int, ...] = ()
    blocks: StateBlocks = ()

    def at(self, points: Any) -> Spectrum:
        """Return some of the points, by an index as of an array."""
        shapes = None if self.shapes is None else self.shapes[points]
        return self._replace(values=self.values[points], right=self.right[points], shapes=shapes)

    def joined(self, *others: Spectrum) -> Spectrum:
        """Return the points of this spectrum and of all others."""
        every = (self, *others)
        values, right = (np.concatenate(parts) for parts in zip(*(one[:2] for one in every), strict=True))
        known = [one.shapes for one in every if one.shapes is not None]
        shapes = np.concatenate(known) if len(known) == len(every) else None
        return self._replace(values=values, right=right, shapes=shapes)

    @property
    def block(self) -> Array:
        """Number of the block that each state (states,) is a mode of."""
        number = np.zeros(self.values.shape[-1], dtype=int)
        for place, (_, columns) in enumerate(self.blocks):
            number[columns] = place
        return number

    @property
    def works(self) -> Array:
        """Which points have not failed."""
        return np.asarray(np.isfinite(self.values).any(axis=-1))

    def nearest(self, roots: Array) -> Array:
        """Return the places (..., k) of the states that are nearest to some roots (..., k) of the points."""
        apart = size_of(self.values[..., None, :] - roots[..., :, None])
        return np.asarray(np.where(np.isnan(apart), np.inf, apart).argmin(axis=-1))

    @property
    def all_modes(self) -> Modes:
        """Every state of every point, with left vectors."""
        return Modes(self.values, self.right, _left_by_block(self.values, self.right, self.blocks))

    def modes(self, places: Array) -> Modes:
        """Return the states of each point at some places (..., modes)."""
        return self.all_modes.at(places)


def _left_by_block(values: Array, right: Array, blocks: StateBlocks) -> Array:
    """Return left vectors as `_left_vectors` does; exactly zero in all blocks but the mode's own."""
    if len(blocks) < 2:
        return _left_vectors(values, right)
    left = np.zeros(right.shape, dtype=complex)
    for rows, columns in blocks:
        left[..., columns, rows] = _left_vectors(values[..., columns], right[..., rows, columns])
    left[~np.isfinite(values).any(axis=-1)] = np.nan
    return left


def _left_vectors(values: Array, right: Array) -> Array:
    """Return rows (..., states, states) with rows @ right = 1, for a real matrix whose pairs stand side by side.

    The columns a + ib and a - ib span the same space as a and b: their inverse follows from the inverse of the real
    matrix with the columns a and b, at a third of the cost. A defective matrix has no inverse, and gets its
    pseudo-inverse. NaN at failed points.
    """
    states = values.shape[-1]
    flat, vectors = values.reshape(-1, states), right.reshape(-1, states, states)
    left = np.full(vectors.shape, np.nan, dtype=complex)
    good = np.flatnonzero(np.isfinite(flat).any(axis=-1))
    for start in range(0, len(good), _BLOCK):
        rows = _as_slice(good[start : start + _BLOCK])
        left[rows] = _left_block(flat[rows], vectors[rows])
    return left.reshape(right.shape)


def _left_block(values: Array, right: Array) -> Array:
    real = np.where((values.imag < 0)[:, None, :], -right.imag, right.real)
    rows = inverse(real)
    left = rows.astype(complex)
    point, place = np.nonzero(values.imag > 0)
    first, second = rows[point, place], rows[point, place + 1]
    left[point, place] = 0.5 * (first - 1j * second)
    left[point, place + 1] = 0.5 * (first + 1j * second)
    return left


def match_modes(
    spectrum: Spectrum, before: Array, after: Array, known: Mapping[int, RealModes] | None = None
) -> Matches:
    """Match the states of points `before` (steps,) with the states of points `after` (steps,).

    The modes of all points that work may be given in real numbers, by the number of pairs of a point.

    The quality of a step is the likeness of a state to its successor, less the largest of

        S_ij' max(|Δ1|, |Δ2|) / |Δmin|

    over the other states, with S_ij' the likeness of the state to the successor of another, Δ1 and Δ2 the differences
    of their eigenvalues at both points, and Δmin the smallest on the straight way from Δ1 to Δ2. Two states that mix by
    S while they are Δ apart are coupled by about S Δ: where they would come nearer to each other than S Δ, they may
    have passed or may have turned away between the points, and the step does not tell. The conjugate of a state and its
    other half, where a pair parts into two real roots or two join, do not count as others.

    A state that a point does not have is at no distance from any other: its likeness alone tells which state
    it becomes at a next point that has this state, and from this point on it has an eigenvalue.
    """
    if spectrum.shapes is not None:
        return _match_in_common(spectrum, spectrum.shapes, before, after)
    states = spectrum.values.shape[-1]
    successor = np.full((len(before), states), -1)
    quality = np.empty((len(before), states))
    pairs = np.where(spectrum.works, (spectrum.values.imag > 0).sum(axis=-1), -1)
    alike = pairs[before] == pairs[after]
    for count in np.unique(pairs[before[alike]]).tolist():
        steps = np.flatnonzero(alike & (pairs[before] == count))
        place = np.cumsum(pairs == count) - 1  # among the points with this number of pairs
        for start in range(0, len(steps), _BLOCK):
            rows = _as_slice(steps[start : start + _BLOCK])
            if known is None:
                every, ends = _of_some(spectrum, before[rows], after[rows], count)
            else:
                every, ends = known[count], (place[before[rows]], place[after[rows]])
            successor[rows], quality[rows] = _match_block(spectrum, every, *ends)
    for step in np.flatnonzero(successor[:, 0] < 0):
        successor[step], quality[step] = _match_alone(spectrum.at(before[step]), spectrum.at(after[step]))
    return Matches(successor, quality)


def _match_in_common(spectrum: Spectrum, shapes: Array, before: Array, after: Array) -> Matches:
    """Match modes of points whose coordinates have different shapes, in the coordinates of the earlier point."""
    turn = np.linalg.pinv(shapes[before]) @ shapes[after]
    held, right = spectrum.held, spectrum.right[after]
    rates = slice(len(held), len(held) + turn.shape[-1])
    moved = [place for place in held if place < turn.shape[-1]]
    right[:, rates] = turn @ right[:, rates]
    right[:, : len(moved)] = turn[:, moved][:, :, moved] @ right[:, : len(moved)]
    first = spectrum._replace(shapes=None).at(before)
    last = first._replace(values=spectrum.values[after], right=right)
    rows = np.arange(len(before))
    return match_modes(first.joined(last), rows, len(rows) + rows)


def _of_some(
    spectrum: Spectrum, before: Array, after: Array, pairs: int
) -> tuple[RealModes, tuple[Array, Array]]:
    """Return the modes of the points of some steps, and the places of both ends of each step among these points."""
    points, ends = np.unique(np.concatenate([before, after]), return_inverse=True)
    some = spectrum.at(_as_slice(points))
    return RealModes.of(some.values, some.right, pairs), (ends[: len(before)], ends[len(before) :])


def _match_block(spectrum: Spectrum, every: RealModes, before: Array, after: Array) -> tuple[Array, Array]:
    """Match modes of points with one number of pairs, from places `before` (steps,) to places `after`.

    The successors of a step are -1 where the best candidates of the modes are not all different.
    """
    low, high = int(before.min()), int(after.max())
    if np.array_equal(after, before + 1) and high - low < 2 * len(before):  # neighbours, which need no copies
        successor, trust = _match_ends(
            every.at(slice(low, high)), every.at(slice(low + 1, high + 1)), spectrum
        )
        return successor[before - low], trust[before - low]
    return _match_ends(every.at(before), every.at(after), spectrum)


def _match_ends(first: RealModes, last: RealModes, spectrum: Spectrum) -> tuple[Array, Array]:
    """Match modes of points, each with those of another point, as `_match_block`."""
    start, end = (np.ascontiguousarray(one.values.T) for one in (first, last))
    modes, pairs = len(start), first.pairs
    alike = likeness(first, last)
    candidates = np.concatenate([end[:pairs], end[:pairs].conj(), end[pairs:]])
    scale = np.sqrt(np.fmax.reduce(start.real**2 + start.imag**2, axis=0))
    gain = alike - _distance(start[:, None], candidates, scale)
    if len(spectrum.blocks) > 1:
        own = spectrum.block[first.upper].T
        gain -= _APART * (own[:, None] != spectrum.block[last.places].T)
    choice = gain.argmax(axis=1)
    # Upper states go to pairs, real ones to real ones, each to another.
    target = np.where((choice >= pairs) & (choice < 2 * pairs), choice - pairs, choice)
    rows = np.arange(modes)[:, None]
    good = (np.sort(target, axis=0) == np.where(rows < pairs, rows, rows + pairs)).all(axis=0)
    good &= (choice[:pairs] < 2 * pairs).all(axis=0)
    above, real = np.split(np.take_along_axis(last.places.T, choice, 0), [pairs])
    turned = np.where(choice[:pairs] < pairs, 1, -1)  # a state that turns over the real axis
    trust = quality(alike, choice, start, np.take_along_axis(candidates, choice, 0))
    own = first.places.argsort(axis=1)
    successor = np.take_along_axis(np.concatenate([above, above + turned, real]).T, own, 1)
    successor[~good] = -1
    return successor, np.take_along_axis(np.concatenate([trust[:pairs], trust]).T, own, 1)


def _match_alone(first: Spectrum, last: Spectrum) -> tuple[Array, Array]:
    """Return successors and quality (states,) of one step of any kind, by the assignment with the largest sum."""
    (start, columns, rows), (end, later_columns, later_rows) = first.all_modes, last.all_modes
    likeness = np.sqrt(size_of((rows @ later_columns) * (later_rows @ columns).T))
    gain = likeness - _distance(start[:, None], end, np.nanmax(np.abs(start)))
    gain -= _APART * (first.block[:, None] != last.block)
    successor = best_assignment(np.where(np.isfinite(gain), gain, -1e300))
    mixing = likeness[:, successor]
    own = np.diagonal(mixing).copy()
    states, twins = np.arange(len(start)), (conjugate(start), conjugate(end))
    related = (states[:, None] == states) | (twins[0][:, None] == states)
    related |= twins[1][successor][:, None] == successor
    counts = ~related & (mixing > COUPLED)
    apart, later = start[:, None] - start, end[successor][:, None] - end[successor]
    index = np.zeros(mixing.shape)
    index[counts] = np.nan_to_num(mixing[counts] * closeness(apart[counts], later[counts]))
    return successor, np.clip(np.minimum(own, 1) - np.maximum(index.max(axis=0), index.max(axis=1)), 0, 1)


def _as_slice(points: Array) -> slice | Array:
    """Return points as a slice where they are neighbours, so that an index makes no copy."""
    if len(points) and points[-1] - points[0] == len(points) - 1 and np.all(np.diff(points) == 1):
        return slice(int(points[0]), int(points[-1]) + 1)
    return points


def conjugate(values: Array) -> Array:
    """Return the place of the conjugate of each state (..., states); a real state is its own conjugate."""
    return np.arange(values.shape[-1]) + (values.imag > 0) - (values.imag < 0)


def size_of(numbers: Array) -> Array:
    """Return |z| without np.abs's overflow guard, twice as fast."""
    return np.asarray(np.sqrt(numbers.real**2 + numbers.imag**2))


def _distance(start: Array, end: Array, scale: Array) -> Array:
    """Return the distance of eigenvalues as a part of `scale`; 0 from or to a state that a point does not have."""
    distance = size_of(start - end) / scale
    return np.where(np.isnan(distance), 0.0, distance)


def chain(successor: Array, start: Array) -> Array:
    """Return places (steps + 1, states) of states along consecutive steps (steps, states), from places (states,)."""
    return np.stack(list(accumulate(successor, lambda places, step: step.take(places), initial=start)))


def keep_upper(values: Array, block: Array) -> Array:
    """Return swaps (points, states) that keep a followed state in the upper half plane after two real roots joined.

    Parameters
    ----------
    values : array (points, states)
        Followed eigenvalues, in their places.
    block : array (states,) of int
        Of the followed states: two roots of different blocks do not join.

    Returns
    -------
    array (points, states) of int
        Places from which to take each state. Of two states that are conjugate to each other, the one that has been
        above before goes above; of two real states that join for the first time, the one in the earlier place.
    """
    order = np.tile(np.arange(values.shape[1]), (len(values), 1))
    if not len(values):
        return order
    side = np.sign(np.nan_to_num(values.imag))
    changes = np.flatnonzero((side[1:] != side[:-1]).any(axis=1)) + 1
    above = side[0] > 0
    for begin, end in pairwise([*changes, len(values)]):
        places, now = order[begin].copy(), values[begin]
        for low in np.flatnonzero(now.imag < 0):
            high = int(np.nanargmin(np.where(block == block[low], np.abs(now - now[low].conj()), np.nan)))
            if above[low] > above[high] or (low < high and not above[low] and not above[high]):
                places[[low, high]] = high, low
        order[begin:end] = places
        above = above | (now[places].imag > 0)
    return order
