"""Upper bounds of the smallest singular values of A - λ for many matrices A and all of their λ, in n² operations a λ.

LAPACK reduces each matrix to Hessenberg form, Q' A Q = H. There H - λ has triangular factors in n² operations, for all
λ of many matrices side by side, and from them follow w = (H - λ)^-H b of a random b and y = (H - λ)^-1 w. The bound is
|(A - λ) x| / |x| with x = Q y and the matrix itself: it is a bound whatever x is, and near the smallest singular value
unless b has almost nothing along its vector.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg.lapack import dgehrd, dorghr

from proprotor.typing import Array

_AT_ONCE = 2**19  # entries of factors in memory
_LARGE = 1e100  # of an entry of a vector that grows, before it is scaled down


def bounds_of_singular_values(matrices: Array, values: Array, rng: np.random.Generator) -> Array:
    """Return upper bounds (k, m) of the smallest singular values of A - λ.

    Parameters
    ----------
    matrices : array (k, n, n)
        Real, with entries of size one at most.
    values : array (k, m) of complex
        λ of each matrix.
    rng : Generator
        Of the vectors b.

    Returns
    -------
    array (k, m)
        Without a bound, infinite.
    """
    count, n, _ = matrices.shape
    found = np.empty(values.shape)
    at_once = max(1, _AT_ONCE // (n * n * values.shape[1]))
    for first in range(0, count, at_once):
        part = slice(first, first + at_once)
        hessenberg, turns = _hessenberg(matrices[part])
        y = _singular_vectors(hessenberg, values[part], rng)
        x = turns @ y.real + 1j * (turns @ y.imag)
        ax = matrices[part] @ x.real + 1j * (matrices[part] @ x.imag)
        sizes = np.linalg.norm(ax - x * values[part, None, :], axis=1), np.linalg.norm(x, axis=1)
        with np.errstate(all="ignore"):
            found[part] = sizes[0] / sizes[1]
    return np.where(np.isfinite(found), found, np.inf)


def _hessenberg(matrices: Array) -> tuple[Array, Array]:
    """Return Hessenberg matrices H (k, n, n) and Q (k, n, n) with A = Q H Q'."""
    if matrices.shape[-1] == 1:  # LAPACK's function has no reflections to put together
        return matrices, np.ones_like(matrices)
    pairs = [dgehrd(matrix)[:2] for matrix in matrices]
    turns = np.array([dorghr(reflections, factors)[0] for reflections, factors in pairs])
    return np.triu(np.array([reflections for reflections, _ in pairs]), -1), turns


def _singular_vectors(hessenberg: Array, values: Array, rng: np.random.Generator) -> Array:
    """Return vectors (k, n, m) of length one that H - λ makes short."""
    (count, n, _), m = hessenberg.shape, values.shape[1]
    lane = np.repeat(np.arange(count), m)
    upper, factors, exchanged = _triangular_factors(hessenberg.transpose(1, 2, 0), lane, values.ravel())
    y = rng.standard_normal((n, count * m)) + 1j * rng.standard_normal((n, count * m))
    _solve_transposed(upper, y)
    for k in range(n - 2, -1, -1):  # the transposed elimination, backwards
        y[k] -= factors[k] * y[k + 1]
        y[k : k + 2] = np.where(exchanged[k], y[k : k + 2][::-1], y[k : k + 2])
    y /= np.linalg.norm(y, axis=0)
    y = y.conj()  # of the transposed matrix to the adjoint one
    for k in range(n - 1):
        y[k : k + 2] = np.where(exchanged[k], y[k : k + 2][::-1], y[k : k + 2])
        y[k + 1] -= factors[k] * y[k]
    _solve(upper, y)
    y /= np.linalg.norm(y, axis=0)
    return y.reshape(n, count, m).swapaxes(0, 1)


def _triangular_factors(entries: Array, lane: Array, values: Array) -> tuple[list[Array], Array, Array]:
    """Return the rows of U (n - k, lanes) of P (H - λ) = L U, the factors of L (n - 1, lanes), and the exchanges.

    A pivot that rounding makes zero is as large as rounding.
    """
    n = len(entries)
    upper, factors = [], np.empty((n - 1, len(lane)), dtype=complex)
    exchanged = np.empty((n - 1, len(lane)), dtype=bool)
    size = np.abs(entries).sum(axis=1).max(axis=0)
    least = np.finfo(float).eps * np.where(size > 0, size, 1)[lane]
    above = entries[0][:, lane].astype(complex)
    above[0] -= values
    for k in range(n):
        row = above
        if k + 1 < n:
            below = entries[k + 1, k:][:, lane].astype(complex)
            below[1] -= values
            exchanged[k] = np.abs(below[0]) > np.abs(above[0])
            row, rest = np.where(exchanged[k], below, above), np.where(exchanged[k], above, below)
        row[0] = np.where(np.abs(row[0]) < least, least, row[0])
        upper.append(row)
        if k + 1 < n:
            factors[k] = rest[0] / row[0]
            above = rest[1:]
            above -= factors[k] * row[1:]
    return upper, factors, exchanged


def _solve(upper: list[Array], y: Array) -> None:
    """Solve U x = y in place, to a factor of each lane."""
    for k in range(len(y) - 1, -1, -1):
        y[k] -= np.einsum("jl,jl->l", upper[k][1:], y[k + 1 :])
        y[k] /= upper[k][0]
        _scale_down(y, k)


def _solve_transposed(upper: list[Array], y: Array) -> None:
    """Solve the equations of the transposed U in place, to a factor of each lane."""
    for k in range(len(y)):
        y[k] /= upper[k][0]
        _scale_down(y, k)
        y[k + 1 :] -= upper[k][1:] * y[k]


def _scale_down(y: Array, k: int) -> None:
    """Scale the lanes down in which an entry is large, so that none overflows."""
    large = np.abs(y[k]) > _LARGE
    if large.any():
        y[:, large] /= _LARGE
