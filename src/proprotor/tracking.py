"""The same mode at neighbouring points: one-to-one, by vectors and eigenvalues, with a measure of trust.

A mode is followed by the likeness of its vectors at two points,

    S_ij = √( |l_i(1) r_j(2)| |l_j(2) r_i(1)| ),

l the rows of the inverse of the matrix of right vectors r. They are the mass-weighted left vectors: S is 1 for a mode
that has not changed and 0 for any other, whatever units coordinates have and however vectors are scaled. The distance
of the eigenvalues, in parts of the largest, is taken off. The assignment with the largest sum of S_ij - d_ij is the
step. Where the best candidates of all states are different, that is the assignment: no permutation exceeds the sum of
the largest entries of the rows. Elsewhere `scipy.optimize.linear_sum_assignment` finds it.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

_BLOCK = 64  # steps whose matrices stay in the cache
_COUPLED = 0.01  # likeness of different modes below which they pass each other as strangers
POOR = 0.5  # quality of a step below which it is divided


class Steps(NamedTuple):
    """Pairs of neighbouring points.

    Attributes
    ----------
    successor : array (steps, states) of int
        Place at the later point of each state of the earlier one.
    quality : array (steps, states)
        Trust in the step of each state, 0 to 1: see `link`.
    """

    successor: NDArray
    quality: NDArray


class Spectrum(NamedTuple):
    """Eigenvalues (points, states), right vectors in columns and left ones in rows (points, states, states)."""

    values: NDArray
    right: NDArray
    left: NDArray

    def of(self, points: int) -> Spectrum:
        """The first points alone."""
        return Spectrum(self.values[:points], self.right[:points], self.left[:points])

    def modes(self, places: NDArray) -> Spectrum:
        """Some states of each point: places (..., modes)."""
        return Spectrum(
            np.take_along_axis(self.values, places, -1),
            np.take_along_axis(self.right, places[..., None, :], -1),
            np.take_along_axis(self.left, places[..., :, None], -2),
        )


def link(spectrum: Spectrum, before: NDArray, after: NDArray) -> Steps:
    """Successors of all states from points `before` (steps,) to points `after` (steps,).

    The quality of a step is the likeness of a state to its successor, less the largest of

        S_ij' max(|Δ1|, |Δ2|) / |Δmin|

    over the other states, with S_ij' the likeness of the state to the successor of another, Δ1 and Δ2 what parts
    their eigenvalues at both points, and Δmin the least on the straight way from one to the other. Two states that
    mix by S while they are Δ apart are coupled by about S Δ: where they would come nearer to each other than that,
    they may have passed or may have turned away between the points, and the step does not tell. The conjugate of a
    state and its other half, where a pair parts into two real roots or two join, do not count as others.
    """
    states = spectrum.values.shape[-1]
    successor = np.empty((len(before), states), dtype=int)
    quality = np.empty((len(before), states))
    for start in range(0, len(before), _BLOCK):
        rows = slice(start, start + _BLOCK)
        successor[rows], quality[rows] = _link_block(spectrum, before[rows], after[rows])
    return Steps(successor, quality)


def _link_block(spectrum: Spectrum, before: NDArray, after: NDArray) -> tuple[NDArray, NDArray]:
    before, after = _as_slice(before), _as_slice(after)
    first, last = spectrum.values[before], spectrum.values[after]
    half = _upper_half(first)
    likeness = _likeness(spectrum, before, after, half)
    here = np.take_along_axis(first, half, 1)
    distance = _size(here[:, :, None] - last[:, None, :]) / np.abs(first).max(axis=1)[:, None, None]
    successor = _best(likeness - distance, half, first, last)
    for step in np.flatnonzero(successor[:, 0] < 0):
        successor[step] = _assigned(spectrum, _nth(before, step), _nth(after, step))
    upper = _quality(likeness, half, successor, first, last)
    quality = np.ones(first.shape)
    np.put_along_axis(quality, half, upper, 1)
    twin = conjugate(first)
    quality = np.where(first.imag < 0, np.take_along_axis(quality, twin, 1), quality)
    return successor, quality


def _as_slice(points: NDArray) -> slice | NDArray:
    """Neighbouring points without a copy."""
    if len(points) and points[-1] - points[0] == len(points) - 1 and np.all(np.diff(points) == 1):
        return slice(int(points[0]), int(points[-1]) + 1)
    return points


def _nth(points: slice | NDArray, step: int) -> int:
    return points.start + step if isinstance(points, slice) else int(points[step])


def conjugate(values: NDArray) -> NDArray:
    """Place of the conjugate of each state (..., states); that of a real one is its own."""
    return np.arange(values.shape[-1]) + (values.imag > 0) - (values.imag < 0)


def side_by_side(values: NDArray) -> NDArray:
    """Places (points, states) that put conjugates side by side, as LAPACK has them, of eigenvalues in any order."""
    order = np.empty(values.shape, dtype=int)
    for point, here in enumerate(values):
        high = np.flatnonzero(here.imag > 0)
        low = np.flatnonzero(here.imag < 0)
        real = np.flatnonzero(~(here.imag != 0))
        high = high[np.lexsort([here[high].imag, here[high].real])]
        low = low[np.lexsort([-here[low].imag, here[low].real])]
        order[point] = [*np.stack([high, low], axis=1).ravel(), *real]
    return order


def _upper_half(values: NDArray) -> NDArray:
    """Places of all states with Im s >= 0 (points, count), filled up with others where a point has fewer."""
    lower = values.imag < 0
    count = values.shape[1] - int(lower.sum(axis=1).min(initial=values.shape[1]))
    return np.argsort(lower, axis=1, kind="stable")[:, :count]


def _likeness(spectrum: Spectrum, before: slice | NDArray, after: slice | NDArray, half: NDArray) -> NDArray:
    """S of the states `half` with all states of the later point (steps, count, states)."""
    rows = np.take_along_axis(spectrum.left[before], half[:, :, None], 1)
    columns = np.take_along_axis(spectrum.right[before], half[:, None, :], 2)
    product = rows @ spectrum.right[after]
    product *= (spectrum.left[after] @ columns).swapaxes(1, 2)
    return np.sqrt(_size(product))


def _size(numbers: NDArray) -> NDArray:
    """|z|, without the care that np.abs takes of the largest and smallest of numbers."""
    return np.sqrt(numbers.real**2 + numbers.imag**2)


def _best(gain: NDArray, half: NDArray, first: NDArray, last: NDArray) -> NDArray:
    """The permutation of each step's best candidates (steps, states), -1 where they are not all different."""
    successor = np.zeros(first.shape, dtype=int)
    np.put_along_axis(successor, half, gain.argmax(axis=2), 1)
    of_conjugate = np.take_along_axis(successor, conjugate(first), 1)
    followed = np.take_along_axis(conjugate(last), of_conjugate, 1)
    successor = np.where(first.imag < 0, followed, successor)
    different = (np.sort(successor, axis=1) == np.arange(first.shape[1])).all(axis=1)
    successor[~different] = -1
    return successor


def _assigned(spectrum: Spectrum, before: int, after: int) -> NDArray:
    """The assignment with the largest sum, of all states of one step."""
    from scipy.optimize import linear_sum_assignment  # here, because it takes long to import

    every = np.arange(spectrum.values.shape[1])[None]
    at = np.array([before]), np.array([after])
    likeness = _likeness(spectrum, *at, every)[0]
    first, last = spectrum.values[before], spectrum.values[after]
    distance = _size(first[:, None] - last[None, :]) / np.abs(first).max()
    return linear_sum_assignment(likeness - distance, maximize=True)[1]


def _quality(likeness: NDArray, half: NDArray, successor: NDArray, first: NDArray, last: NDArray) -> NDArray:
    """Quality (steps, count) of the states `half`."""
    steps, count = half.shape
    end = np.take_along_axis(successor, half, 1)
    own = np.take_along_axis(likeness, end[:, :, None], 2)[..., 0]
    # mixing[i, k]: likeness of state i to the successor of state k of the half
    mixing = np.take_along_axis(likeness, np.broadcast_to(end[:, None, :], (steps, count, count)), 2)
    step, i, k = np.nonzero(mixing > _COUPLED)
    one, other = half[step, i], half[step, k]
    twins = conjugate(first), conjugate(last)
    related = (one == other) | (twins[0][step, one] == other)
    related |= twins[1][step, successor[step, one]] == successor[step, other]
    step, i, k, one, other = (index[~related] for index in (step, i, k, one, other))
    apart = first[step, one] - first[step, other]
    later = last[step, successor[step, one]] - last[step, successor[step, other]]
    index = np.zeros((steps, count, count))
    with np.errstate(all="ignore"):
        nearest = np.fmax(_nearest_to_zero(apart, later), 1e-300)
        index[step, i, k] = mixing[step, i, k] * np.maximum(np.abs(apart), np.abs(later)) / nearest
    worst = np.maximum(index.max(axis=2, initial=0), index.max(axis=1, initial=0))
    return np.clip(np.minimum(own, 1) - worst, 0, 1)


def _nearest_to_zero(start: NDArray, end: NDArray) -> NDArray:
    """Distance from zero to the straight line between two complex numbers."""
    way = end - start
    length = np.abs(way) ** 2
    at = np.clip(-(start.conj() * way).real / np.where(length > 0, length, 1), 0, 1)
    return np.abs(start + at * way)


def chain(successor: NDArray, start: NDArray) -> NDArray:
    """Places (steps + 1, states) of states along consecutive steps (steps, states), from places (states,)."""
    order = np.empty((len(successor) + 1, successor.shape[-1]), dtype=int)
    order[0] = start
    for step, places in enumerate(successor):
        places.take(order[step], out=order[step + 1])
    return order


def keep_upper(values: NDArray) -> NDArray:
    """Swaps (points, states) that keep a followed state in the upper half plane after two real roots have joined.

    Parameters
    ----------
    values : array (points, states)
        Followed eigenvalues, in their places.

    Returns
    -------
    array (points, states) of int
        Places from which to take each state. Of two states that are conjugate to each other, that one goes above
        which has been above before; of two real ones that join for the first time, that in the earlier place.
    """
    order = np.tile(np.arange(values.shape[1]), (len(values), 1))
    if not len(values):
        return order
    side = np.sign(values.imag)
    changes = np.flatnonzero((side[1:] != side[:-1]).any(axis=1)) + 1
    above = side[0] > 0
    for begin, end in pairwise([*changes, len(values)]):
        places, now = order[begin].copy(), values[begin]
        for low in np.flatnonzero(now.imag < 0):
            high = int(np.argmin(np.abs(now - now[low].conj())))
            if above[low] > above[high] or (low < high and not above[low] and not above[high]):
                places[[low, high]] = high, low
        order[begin:end] = places
        above = above | (now[places].imag > 0)
    return order
