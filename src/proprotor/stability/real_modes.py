"""The modes of points in real numbers, one of each pair, and how alike the modes of two points are.

Of a pair, the real and the imaginary part of the right vector are two columns; the rows of the inverse of all columns
are p and q of the left vector l = (p - iq)/2. A real mode has one column and one row. So all that is asked of left and
right vectors follows from real matrices, and of both modes of a pair at once. Where numbers are compared mode by mode
the points stand last, so that the loops of NumPy are long.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from proprotor.typing import Array

COUPLED = 1e-6  # likeness of different modes; below it is rounding, and the modes pass each other uncoupled
_SMALL = 1e-300


class RealModes(NamedTuple):
    """Modes of points with one number of pairs.

    places (n, states) : of the states above the real axis, of their conjugates, of real states; values (n, modes) above
    the real axis, then real; columns (n, states, states) : real parts of the right vectors of the pairs, then imaginary
    parts, then right vectors of real states; rows (n, states, states) : the inverse.
    """

    places: Array
    values: Array
    columns: Array
    rows: Array

    @classmethod
    def of(cls, values: Array, right: Array, pairs: int) -> RealModes:
        """Return the modes of points from eigenvalues (n, states) and right vectors (n, states, states)."""
        places = places_of(values, pairs)
        upper = upper_places(places, pairs)
        vectors = np.take_along_axis(right, upper[:, None, :], 2)
        columns = np.empty(right.shape)
        columns[..., :pairs] = vectors[..., :pairs].real
        columns[..., pairs : 2 * pairs] = vectors[..., :pairs].imag
        columns[..., 2 * pairs :] = vectors[..., pairs:].real
        return cls(places, np.take_along_axis(values, upper, 1), columns, inverse(columns))

    def at(self, points: Any) -> RealModes:
        """Return some of the points."""
        return RealModes(*(part[points] for part in self))

    @property
    def upper(self) -> Array:
        """Places (n, modes) of the states above the real axis, and of real states."""
        return upper_places(self.places, self.pairs)

    @property
    def pairs(self) -> int:
        """Number of pairs of a point."""
        return int(self.places.shape[1] - self.values.shape[1])

    @property
    def right(self) -> Array:
        """Right vectors in columns (states, modes, n)."""
        return self._complex(np.moveaxis(self.columns, 0, -1), 1.0, 1.0)

    @property
    def left(self) -> Array:
        """Left vectors in columns (states, modes, n), left times right vector 1."""
        return self._complex(self.rows.T, 0.5, -0.5)

    def _complex(self, columns: Array, real: float, imaginary: float) -> Array:
        """Return columns of pairs as complex ones, their parts times two factors, and real columns as they are."""
        pairs, (states, _, n) = self.pairs, columns.shape
        found = np.zeros((states, states - pairs, n), dtype=complex)
        np.multiply(columns[:, :pairs], real, out=found.real[:, :pairs])
        np.multiply(columns[:, pairs : 2 * pairs], imaginary, out=found.imag[:, :pairs])
        found.real[:, pairs:] = columns[:, 2 * pairs :]
        return found


def places_of(values: Array, pairs: int) -> Array:
    """Return the places (n, states) of states above the real axis, of their conjugates, and of real states."""
    n, states = values.shape
    above = np.nonzero(values.imag > 0)[1].reshape(n, pairs)
    real = np.nonzero(~((values.imag > 0) | (values.imag < 0)))[1].reshape(n, states - 2 * pairs)
    return np.concatenate([above, above + 1, real], axis=1)


def upper_places(places: Array, pairs: int) -> Array:
    """Return of such places those of one mode of each pair, and of real modes (n, modes)."""
    return np.concatenate([places[:, :pairs], places[:, 2 * pairs :]], axis=1)


def mode_of_states(values: Array, upper: Array) -> Array:
    """Return the mode (n, states) of each state, by its place among the modes of `upper`; a pair is one mode."""
    mode = np.empty(values.shape, dtype=int)
    np.put_along_axis(mode, upper, np.broadcast_to(np.arange(upper.shape[1]), upper.shape), 1)
    lower = values.imag < 0
    mode[lower] = mode[:, :-1][lower[:, 1:]]
    return mode


def by_pairs(values: Array, at_once: int | None = None) -> Iterator[tuple[Array, int]]:
    """Yield the places of points (points, states) that work, in parts with one number of pairs, and this number.

    A part has at most so many points.
    """
    works = np.isfinite(values).any(axis=-1)
    pairs = np.where(works, (values.imag > 0).sum(axis=-1), -1)
    for count in np.unique(pairs[works]).tolist():
        points = np.flatnonzero(pairs == count)
        for start in range(0, len(points), at_once or len(points)):
            yield points[start : start + (at_once or len(points))], count


def inverse(matrices: Array) -> Array:
    """Return inverses; where a matrix has none, as at a point that is defective, pseudo-inverses."""
    try:
        return np.linalg.inv(matrices)
    except np.linalg.LinAlgError:
        return np.linalg.pinv(matrices)


def likeness(first: RealModes, last: RealModes) -> Array:
    """Return the likeness S (modes, states, n) of each mode of the first points to the states of the last.

    Modes above the real axis stand first, then real ones; states above, their conjugates, real ones.
    """
    pairs = first.pairs
    forward = _squares(first.rows @ last.columns, pairs)
    back = _squares(last.rows @ first.columns, pairs)
    # |l_j(2) r_i(1)| of a conjugate j is that of j with the conjugate of i.
    above, conjugates, real = slice(0, pairs), slice(pairs, 2 * pairs), slice(2 * pairs, None)
    rest = slice(pairs, None)
    for rows, of_above, of_conjugates in ((above, above, conjugates), (rest, real, real)):
        forward[rows, above] *= back[above, of_above].swapaxes(0, 1)
        forward[rows, conjugates] *= back[above, of_conjugates].swapaxes(0, 1)
        forward[rows, real] *= back[rest, of_above].swapaxes(0, 1)
    np.sqrt(forward, out=forward)
    return np.sqrt(forward, out=forward)


def _squares(product: Array, pairs: int) -> Array:
    """Return |l r|² (modes, states, n) from the products (n, states, states) of rows and columns.

    With l = (p - iq)/2 and r = a + ib, or a - ib for the conjugate; rows and columns of real states stand alone.
    """
    product = np.moveaxis(product, 0, -1).copy()
    a, b, c = slice(0, pairs), slice(pairs, 2 * pairs), slice(2 * pairs, None)
    rest = slice(pairs, None)
    found = np.empty((product.shape[0] - pairs, *product.shape[1:]))
    pa, pb, qa, qb = product[a, a], product[a, b], product[b, a], product[b, b]
    found[a, a] = ((pa + qb) ** 2 + (pb - qa) ** 2) / 4
    found[a, b] = ((pa - qb) ** 2 + (pb + qa) ** 2) / 4
    found[a, c] = (product[a, c] ** 2 + product[b, c] ** 2) / 4
    found[rest, a] = product[c, a] ** 2 + product[c, b] ** 2
    found[rest, b] = found[rest, a]
    found[rest, c] = product[c, c] ** 2
    return found


def quality(like: Array, choice: Array, start: Array, end: Array) -> Array:
    """Return the quality of steps (modes, n), see `proprotor.stability.matching.match_modes`.

    Parameters
    ----------
    like : array (modes, states, n)
        Of `likeness`.
    choice : array (modes, n) of int
        The state that each mode becomes.
    start, end : array (modes, n)
        Eigenvalues at both ends.
    """
    modes = np.arange(len(choice))
    one, other = np.triu_indices(len(choice), 1)
    mixing = np.take_along_axis(like, choice[None], 1)  # of mode i with the successor of mode k
    own = np.minimum(mixing[modes, modes], 1)
    mixed = np.maximum(mixing[one, other], mixing[other, one])
    mixed *= mixed > COUPLED
    mixed *= closeness(start[one] - start[other], end[one] - end[other])
    index = np.zeros(mixing.shape)
    index[one, other] = index[other, one] = np.nan_to_num(mixed) if np.isnan(mixed).any() else mixed
    return np.asarray(np.clip(own - index.max(axis=0), 0, 1))


def closeness(apart: Array, later: Array) -> Array:
    """Return max(|Δ1|, |Δ2|) / |Δmin| of two roots that are Δ1, then Δ2 apart; NaN without one of the roots."""
    x, y, u, v = apart.real, apart.imag, later.real, later.imag
    before, after = x * x + y * y, u * u + v * v
    along, across = u - x, v - y
    length = along * along + across * across
    with np.errstate(all="ignore"):
        way = np.clip(-(x * along + y * across) / np.where(length > 0, length, 1), 0, 1)
        near_x, near_y = x + way * along, y + way * across
        nearest = np.maximum(near_x * near_x + near_y * near_y, _SMALL)
        return np.asarray(np.sqrt(np.maximum(before, after) / nearest))
