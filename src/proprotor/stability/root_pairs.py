"""Two roots that cannot be told apart over a step, or that join in it: how near they come to the level.

Where two roots meet or veer, each moves like a square root, and which is which may not be known. Their sum s and the
square of their difference d = (λ1 - λ2)² are the same for either choice, and are as smooth as the matrices: polynomials
give s and d over the step, in a band of their likely error, and the roots are (s ± √d)/2. A pair of conjugates that
parts into two real roots is such a case.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from proprotor.stability.cubic import band, bend, hermite
from proprotor.stability.matching import size_of
from proprotor.stability.root_error import growth
from proprotor.stability.steps import Ends, Steps
from proprotor.typing import Array

_APPROACH = 0.9  # of the distance at the nearer end: roots that come nearer on the straight way may meet
_MEETING = 0.5  # of the distance at the farther end: roots that are nearer than this at one end may meet too
_WITHIN_REACH = (
    3.0  # ways of two roots: if shorter ones lead each to the end of the other, they may have passed
)
_OF_CHORD = 0.01  # of what parts a polynomial of a scan from the chord: its least error
_INSIDE = np.linspace(0.0, 1.0, 33)[1:-1]
MANY, _FEW = 6, 4  # points of a scan through which polynomials go


class _Smooth(NamedTuple):
    """A smooth quantity of pairs (m, places) within their steps, and how wrong it may be."""

    value: Array
    wrong: Array


PairsWithin = Callable[[Ends, Array, Array, Array], tuple[_Smooth, _Smooth]]


def may_meet(first: Array, last: Array, way: Array, state: Array, block: Array) -> Array:
    """Return which roots (n, k, states) some roots, state (n, k), may meet or turn away from between two points.

    Values (n, states) and how far each root may go, way (n, states), decide. The straight ways of two roots come nearer
    to each other than their ends, or the roots are much nearer at one end, or each may have gone to the end of the
    other: the nearest roots at the ends of a step are not the same ones where two roots have passed. With this last
    reason the answer is the same whichever of two equally good choices of the ends was taken. Roots of blocks that do
    not couple, block (states,), pass each other.
    """
    own, end, reach = (np.take_along_axis(part, state, 1)[:, :, None] for part in (first, last, way))
    others, ends = first[:, None, :], last[:, None, :]
    near, far, nearest = _squares_of_distance(own - others, end - ends)
    near_each_other = (nearest < _APPROACH**2 * near) | (near < _MEETING**2 * far)
    exchanged = size_of(ends - own) + size_of(end - others)
    within_reach = exchanged <= _WITHIN_REACH * (reach + way[:, None, :])
    others_alone = state[:, :, None] != np.arange(first.shape[1])
    same_block = block[state][:, :, None] == block
    return np.asarray((near_each_other | within_reach) & others_alone & same_block)


def _squares_of_distance(apart: Array, later: Array) -> tuple[Array, Array, Array]:
    """Return the squares of the shorter, of the longer, and of the least distance on the straight way between both."""
    x, y, u, v = apart.real, apart.imag, later.real, later.imag
    one, other = x * x + y * y, u * u + v * v
    along, across = u - x, v - y
    length = along * along + across * across
    length[length == 0] = 1
    at = np.clip(-(x * along + y * across) / length, 0, 1)
    return np.minimum(one, other), np.maximum(one, other), (x + at * along) ** 2 + (y + at * across) ** 2


def _partners(ends: Ends, row: Array, state: Array) -> Array:
    """Return the root (m,) that one root of some steps, state (m,), may meet, if neither may meet a third; else -1."""
    first, last, way = ends.values[0, row], ends.values[1, row], ends.ways[row]
    block, rows = ends.points.spectrum.block, np.arange(len(state))
    meeting = may_meet(first, last, way, state[:, None], block)[:, 0]
    partner = meeting.argmax(axis=1)
    others = may_meet(first, last, way, partner[:, None], block)[:, 0]
    alone = (meeting.sum(axis=1) == 1) & (others.sum(axis=1) == 1) & others[rows, state]
    return np.where(alone, partner, -1)


def keep_off(ends: Ends, row: Array, state: Array, level: float, trust: float, within: PairsWithin) -> Array:
    """Return which states (m,) of steps stay on one side of the level for certain, with the root that each may meet."""
    found = np.zeros(len(row), dtype=bool)
    if not len(row):
        return found
    partner = _partners(ends, row, state)
    own, other = (ends.sides[:, row, one] for one in (state, partner))
    side = own[0]
    alike = (np.concatenate([own, other]) == side).all(axis=0)
    asked = np.flatnonzero((partner >= 0) & (np.abs(side) == 1) & alike)
    if len(asked):
        pairs = within(ends, row[asked], state[asked], partner[asked])
        found[asked] = _off(*pairs, side[asked], level, trust)
    return found


def _off(sums: _Smooth, squares: _Smooth, side: Array, level: float, trust: float) -> Array:
    """Return whether both roots (m,) of a pair stay on a side of the level all over their step, bands included."""
    wrong_sum, wrong_square = (part.wrong / trust for part in (sums, squares))
    root = np.sqrt(squares.value)
    with np.errstate(divide="ignore", invalid="ignore"):  # |√(d + e) - √d| is within both of these
        wrong_root = np.fmin(np.sqrt(wrong_square), wrong_square / size_of(root))
    wrong = (1 + abs(level)) * (wrong_sum + wrong_root) / 2
    margins = [side[:, None] * growth((sums.value + way * root) / 2, level) - wrong for way in (1, -1)]
    return np.asarray((np.minimum(*margins) > 0).all(axis=1))


def by_derivatives(ends: Ends, row: Array, state: Array, partner: Array) -> tuple[_Smooth, _Smooth]:
    """Return s and d (m, places) of pairs within their steps, cubics by the derivatives of both roots."""
    sums, squares = _sums_and_squares(ends, row, state, partner)
    return _cubic(sums), _cubic(squares)


def _sums_and_squares(ends: Ends, row: Array, state: Array, partner: Array) -> tuple[Array, Array]:
    """Return s and d of pairs at the ends of their steps (4, m): values, then slopes times the length of the step."""
    value, other = (ends.values[:, row, one] for one in (state, partner))
    change, other_change = (ends.changes[:, row, one] * ends.length[row, 0] for one in (state, partner))
    apart = value - other
    sums = np.concatenate([value + other, change + other_change])
    return sums, np.concatenate([apart**2, 2 * apart * (change - other_change)])


def _couples(ends: Ends) -> tuple[Array, Array, Array]:
    """Return steps (k,), two states (2, k) that are real at one end and a pair at the other, and which end that is."""
    values, block = ends.values, ends.points.spectrum.block
    real = values.imag == 0
    found = []
    for end in (0, 1):
        mixed = real[end] & ~real[1 - end] & np.isfinite(values[0]) & np.isfinite(values[1])
        some = np.flatnonzero(mixed.sum(axis=1) > 1)
        own, pair = mixed[some], values[1 - end, some]
        join = own[:, :, None] & own[:, None, :] & (pair[:, :, None] == pair[:, None, :].conj())
        join &= block[:, None] == block
        row, one, other = np.nonzero(np.triu(join, 1))
        found.append(np.stack([some[row], one, other, np.full(len(row), end)]))
    rows, *couples, ends_of = np.concatenate(found, axis=1)
    return rows, np.stack(couples), ends_of


def joining_roots(ends: Ends) -> tuple[Array, Array, Array, Array, Array]:
    """Return steps (k,) in which two real roots join or part, the two states (2, k), the end at which they are real.

    Then the cubics (4, k), by their ends, of the mean of the two roots and of the square of half their distance.
    """
    rows, couples, real_end = _couples(ends)
    sums, squares = _sums_and_squares(ends, rows, *couples)
    return rows, couples, real_end, sums.real / 2, squares.real / 4


def _cubic(ends: Array) -> _Smooth:
    """Return cubics within their steps by their ends (4, m); they may be wrong by as much as they bend."""
    return _Smooth(hermite(_INSIDE, ends[:, :, None]), bend(ends)[:, None] * band(_INSIDE))


def along_scan(ends: Ends, row: Array, state: Array, partner: Array) -> tuple[_Smooth, _Smooth]:
    """Return s and d of pairs by polynomials through six points of the scan about the step; NaN where a line has fewer.

    Their difference from polynomials through four points is the error of the latter, and an upper bound of their own.
    The steps are all steps of their lines, one after the other.
    """
    steps, points = ends.steps, ends.points
    line = points.line[steps.before]
    first, last = np.searchsorted(line, line[row]), np.searchsorted(line, line[row], side="right")
    start = np.clip(row - MANY // 2 + 1, first, np.maximum(last - MANY + 1, first))
    enough = last - first >= MANY - 1
    start = np.where(enough, start, 0)
    here = np.where(enough, row - start, 0)
    chain = np.minimum(start + np.arange(MANY - 1)[:, None], len(line) - 1)
    at = np.concatenate([steps.before[chain], steps.after[chain[-1:]]])
    values = [points.spectrum.values[at, _places(steps, chain, here, one)] for one in (state, partner)]
    x = points.position[at]
    begin, end = (points.position[part[row]] for part in (steps.before, steps.after))
    wanted = begin[:, None] + _INSIDE * (end - begin)[:, None]
    every = np.broadcast_to(np.arange(MANY)[:, None], x.shape)
    nearest = np.clip(here - _FEW // 2 + 1, 0, MANY - _FEW) + np.arange(_FEW)[:, None]
    through = (every, nearest, here + np.array([[0], [1]]))
    shares = [
        np.where(enough[:, None], _lagrange(np.take_along_axis(x, some, 0), wanted), np.nan)
        for some in through
    ]
    found = []
    for y in (values[0] + values[1], (values[0] - values[1]) ** 2):
        value, rough, chord = (
            (share * np.take_along_axis(y, some, 0)[:, :, None]).sum(axis=0)
            for share, some in zip(shares, through, strict=True)
        )
        found.append(_Smooth(value, np.abs(value - rough) + _OF_CHORD * np.abs(value - chord)))
    return found[0], found[1]


def _places(steps: Steps, chain: Array, here: Array, state: Array) -> Array:
    """Return places (points, m) of states along chains of steps (points - 1, m), known at the step `here`."""
    before = np.argsort(steps.successor, axis=1)
    places = np.tile(state, (len(chain) + 1, 1))
    for k, step in enumerate(chain):
        places[k + 1] = np.where(k >= here, steps.successor[step, places[k]], places[k + 1])
    for k in range(len(chain) - 1, -1, -1):
        places[k] = np.where(k < here, before[chain[k], places[k + 1]], places[k])
    return places


def _lagrange(x: Array, wanted: Array) -> Array:
    """Return the share (k, m, any) of each of k points, x (k, m), in polynomials through them at places (m, any)."""
    ways = wanted - x[:, :, None]
    share = np.ones((len(x), *wanted.shape))
    for one in range(1, len(x)):  # the product of all ways before, then of all that follow
        np.multiply(share[one - 1], ways[one - 1], out=share[one])
    after = np.ones(wanted.shape)
    with np.errstate(all="ignore"):
        for one in range(len(x) - 1, -1, -1):
            apart = np.prod(x[one] - np.delete(x, one, axis=0), axis=0)
            share[one] *= after / apart[:, None]
            after *= ways[one]
    return share
