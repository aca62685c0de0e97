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

from itertools import accumulate, pairwise
from typing import Any, NamedTuple

import numpy as np

from proprotor.model.first_order import StateBlocks
from proprotor.stability.assignment import best_assignment
from proprotor.typing import Array

_BLOCK = 64  # steps whose matrices stay in the cache
_APART = (
    10.0  # more than likeness and distance can be: taken off where two modes are of blocks that do not couple
)
_COUPLED = 1e-6  # likeness of different modes; below it is rounding, and the modes pass each other uncoupled
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

    def joined(self, other: Spectrum) -> Spectrum:
        """Return the points of both spectra."""
        values, right = (np.concatenate(parts) for parts in zip(self[:2], other[:2], strict=True))
        both = self.shapes is not None and other.shapes is not None
        shapes = np.concatenate([self.shapes, other.shapes]) if both else None
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
    rows = _inverse(real)
    left = rows.astype(complex)
    point, place = np.nonzero(values.imag > 0)
    first, second = rows[point, place], rows[point, place + 1]
    left[point, place] = 0.5 * (first - 1j * second)
    left[point, place + 1] = 0.5 * (first + 1j * second)
    return left


def _inverse(matrices: Array) -> Array:
    try:
        return np.linalg.inv(matrices)
    except np.linalg.LinAlgError:  # at one point, which is defective
        return np.linalg.pinv(matrices)


def match_modes(spectrum: Spectrum, before: Array, after: Array) -> Matches:
    """Match the states of points `before` (steps,) with the states of points `after` (steps,).

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
    pairs = (spectrum.values.imag > 0).sum(axis=-1)
    alike = pairs[before] == pairs[after]
    for count in np.unique(pairs[before[alike]]):
        steps = np.flatnonzero(alike & (pairs[before] == count))
        for start in range(0, len(steps), _BLOCK):
            rows = _as_slice(steps[start : start + _BLOCK])
            successor[rows], quality[rows] = _match_block(spectrum, before[rows], after[rows], int(count))
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


class _Packed(NamedTuple):
    """Points with one number of pairs: places of the states, values, vectors.

    places (n, states): of the states above the real axis, of their conjugates, of real states; values (n, pairs + rest)
    above the real axis and real; columns (n, states, states) real: real parts of the vectors of the pairs, then
    imaginary parts, then the real vectors; rows, the inverse.
    """

    places: Array
    values: Array
    columns: Array
    rows: Array

    @classmethod
    def of(cls, spectrum: Spectrum, pairs: int) -> _Packed:
        values, right = spectrum.values, spectrum.right
        n, states = values.shape
        above = np.nonzero(values.imag > 0)[1].reshape(n, pairs)
        real = np.nonzero(~((values.imag > 0) | (values.imag < 0)))[1].reshape(n, states - 2 * pairs)
        upper = np.concatenate([above, real], axis=1)
        vectors = np.take_along_axis(right, upper[:, None, :], 2)
        pair, rest = vectors[..., :pairs], vectors[..., pairs:]
        columns = np.concatenate([pair.real, pair.imag, rest.real], axis=-1)
        places = np.concatenate([above, above + 1, real], axis=1)
        return cls(places, np.take_along_axis(values, upper, 1), columns, _inverse(columns))

    def at(self, points: slice) -> _Packed:
        return _Packed(*(part[points] for part in self))


def _match_block(spectrum: Spectrum, before: Array, after: Array, pairs: int) -> tuple[Array, Array]:
    """Match modes of points with one number of pairs; -1 where the best candidates are not all different."""
    if np.array_equal(after, before + 1) and isinstance(_as_slice(before), slice):
        every = _Packed.of(spectrum.at(slice(int(before[0]), int(after[-1]) + 1)), pairs)
        first, last = every.at(slice(None, -1)), every.at(slice(1, None))
    else:
        first, last = (_Packed.of(spectrum.at(points), pairs) for points in (before, after))
    likeness = _packed_likeness(first, last, pairs)
    scale = np.sqrt(np.fmax.reduce(first.values.real**2 + first.values.imag**2, axis=1))[:, None, None]
    ends = np.concatenate([last.values[:, :pairs], last.values[:, :pairs].conj(), last.values[:, pairs:]], 1)
    gain = likeness - _distance(first.values[:, :, None], ends[:, None, :], scale)
    if len(spectrum.blocks) > 1:
        own, other = (spectrum.block[one.places] for one in (first, last))
        own = np.concatenate([own[:, :pairs], own[:, 2 * pairs :]], axis=1)
        gain -= _APART * (own[:, :, None] != other[:, None, :])
    choice = gain.argmax(axis=2)
    # Upper states go to pairs, real ones to real ones, each to another.
    target = np.where((choice >= pairs) & (choice < 2 * pairs), choice - pairs, choice)
    rows = np.arange(likeness.shape[1])
    good = (np.sort(target, axis=1) == np.where(rows < pairs, rows, rows + pairs)).all(axis=1)
    good &= (choice[:, :pairs] < 2 * pairs).all(axis=1)
    above, real = np.split(np.take_along_axis(last.places, choice, 1), [pairs], axis=1)
    turned = np.where(choice[:, :pairs] < pairs, 1, -1)  # a state that turns over the real axis
    trust = _trust(likeness, choice, first.values, np.take_along_axis(ends, choice, 1))
    own = first.places.argsort(axis=1)
    successor = np.take_along_axis(np.concatenate([above, above + turned, real], axis=1), own, 1)
    successor[~good] = -1
    return successor, np.take_along_axis(np.concatenate([trust[:, :pairs], trust], axis=1), own, 1)


def _packed_likeness(first: _Packed, last: _Packed, pairs: int) -> Array:
    """Return S (n, pairs + rest, 2 pairs + rest): rows above the real axis, real; columns above, conjugate, real."""
    forward = _squares(first.rows @ last.columns, pairs)
    back = _squares(last.rows @ first.columns, pairs)
    # |l_j(2) r_i(1)| of a conjugate j is that of j with the conjugate of i.
    above, conjugates, real = slice(0, pairs), slice(pairs, 2 * pairs), slice(2 * pairs, None)
    rest = slice(pairs, None)
    for rows, of_above, of_conjugates in ((above, above, conjugates), (rest, real, real)):
        forward[:, rows, above] *= back[:, above, of_above].swapaxes(1, 2)
        forward[:, rows, conjugates] *= back[:, above, of_conjugates].swapaxes(1, 2)
        forward[:, rows, real] *= back[:, rest, of_above].swapaxes(1, 2)
    np.sqrt(forward, out=forward)
    return np.sqrt(forward, out=forward)


def _squares(product: Array, pairs: int) -> Array:
    """Return |l r|² (n, pairs + rest, 2 pairs + rest) from the products of packed rows and columns.

    With l = (p - iq)/2 and r = a + ib, or a - ib for the conjugate; rows and columns of real states stand alone.
    """
    a, b, c = slice(0, pairs), slice(pairs, 2 * pairs), slice(2 * pairs, None)
    rest = slice(pairs, None)
    found = np.empty((len(product), product.shape[1] - pairs, product.shape[1]))
    pa, pb, qa, qb = product[:, a, a], product[:, a, b], product[:, b, a], product[:, b, b]
    found[:, a, a] = ((pa + qb) ** 2 + (pb - qa) ** 2) / 4
    found[:, a, b] = ((pa - qb) ** 2 + (pb + qa) ** 2) / 4
    found[:, a, c] = (product[:, a, c] ** 2 + product[:, b, c] ** 2) / 4
    found[:, rest, a] = product[:, c, a] ** 2 + product[:, c, b] ** 2
    found[:, rest, b] = found[:, rest, a]
    found[:, rest, c] = product[:, c, c] ** 2
    return found


def _trust(likeness: Array, choice: Array, start: Array, end: Array) -> Array:
    """Return the quality (n, m) of steps from likeness (n, m, any), chosen successors and eigenvalues at both ends."""
    n, m = choice.shape
    # mixing[i, k]: likeness of state i to the successor of state k
    mixing = np.take_along_axis(likeness, np.broadcast_to(choice[:, None, :], (n, m, m)), 2)
    own = np.diagonal(mixing, axis1=1, axis2=2).copy()
    mixing[:, np.arange(m), np.arange(m)] = 0
    step, one, other = np.nonzero(mixing > _COUPLED)
    index = _index(
        mixing[step, one, other], start[step, one] - start[step, other], end[step, one] - end[step, other]
    )
    mixing[...] = 0
    mixing[step, one, other] = index
    worst = np.maximum(mixing.max(axis=2, initial=0), mixing.max(axis=1, initial=0))
    return np.asarray(np.clip(np.minimum(own, 1) - worst, 0, 1))


def _index(mixing: Array, apart: Array, later: Array) -> Array:
    """Return S max(|Δ1|, |Δ2|) / |Δmin|; 0 where a point does not have one of the states."""
    nearest = np.fmax(way_to_zero(apart, later), 1e-300)
    with np.errstate(over="ignore"):
        index = mixing * np.maximum(np.abs(apart), np.abs(later)) / nearest
    return np.where(np.isnan(index), 0.0, index)


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
    counts = ~related & (mixing > _COUPLED)
    apart, later = start[:, None] - start, end[successor][:, None] - end[successor]
    index = np.zeros(mixing.shape)
    index[counts] = _index(mixing[counts], apart[counts], later[counts])
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


def way_to_zero(start: Array, end: Array) -> Array:
    """Return the distance from zero to the straight line between two complex numbers."""
    way = end - start
    length = np.abs(way) ** 2
    at = np.clip(-(start.conj() * way).real / np.where(length > 0, length, 1), 0, 1)
    return np.asarray(np.abs(start + at * way))


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
