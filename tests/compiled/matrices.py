"""Matrices that try the solver of eigenvalue problems: families of many, from harmless to hostile."""

import numpy as np


def _random(rng, count, n):
    return rng.standard_normal((count, n, n))


def _companion(rng, count, n):
    found = np.zeros((count, n, n))
    found[:, 0] = rng.standard_normal((count, n)) * 10.0 ** rng.uniform(-3, 3, (count, n))
    found[:, np.arange(1, n), np.arange(n - 1)] = 1
    return found


def _of_whole_roots(rng, count, n):
    """Companion matrices of polynomials with the roots 1 to n, of which no digit is left."""
    found = np.zeros((count, n, n))
    found[:, 0] = -np.poly(np.arange(1, n + 1))[1:]
    found[:, np.arange(1, n), np.arange(n - 1)] = 1
    return found


def _defective(rng, count, n):
    jordan = np.zeros((count, n, n))
    jordan[:, np.arange(n - 1), np.arange(1, n)] = 1
    jordan[:, np.arange(n), np.arange(n)] = rng.integers(-2, 3, (count, 1))
    turns = np.linalg.qr(_random(rng, count, n))[0]
    turned = turns @ jordan @ turns.swapaxes(1, 2)
    return np.where(np.arange(count)[:, None, None] % 2, jordan, turned)


def _graded(rng, count, n):
    size = 10.0 ** (-rng.uniform(0, 1, (count, 1)) * np.arange(n))
    return _random(rng, count, n) * size[:, :, None] * size[:, None, :]


def _badly_scaled(rng, count, n):
    units = 10.0 ** rng.uniform(-8, 8, (count, n))
    return _random(rng, count, n) * units[:, :, None] / units[:, None, :]


def _block(rng, count, n):
    found = _random(rng, count, n)
    found[:, n // 2 :, : n // 2] = 0
    return found


def _twins(rng, count, n):
    """Two equal blocks, all of whose eigenvalues are double."""
    found, half = _block(rng, count, n), n // 2
    found[:, :half, half:] = 0
    found[:, half : 2 * half, half : 2 * half] = found[:, :half, :half]
    return found


def _triangular(rng, count, n):
    return np.triu(_random(rng, count, n))


def _rank_one(rng, count, n):
    return rng.standard_normal((count, n, 1)) * rng.standard_normal((count, 1, n))


def _skew(rng, count, n):
    found = _random(rng, count, n)
    return found - found.swapaxes(1, 2)


def _permutations(rng, count, n):
    return np.eye(n)[rng.permuted(np.broadcast_to(np.arange(n), (count, n)), axis=1)]


def _whole_numbers(rng, count, n):
    return rng.integers(-2, 3, (count, n, n)).astype(float)


def _zero(rng, count, n):
    return np.zeros((count, n, n))


def _one(rng, count, n):
    return np.broadcast_to(np.eye(n), (count, n, n)).copy()


def _small(rng, count, n):
    return 1e-200 * _random(rng, count, n)


def _large(rng, count, n):
    return 1e200 * _random(rng, count, n)


def _denormal(rng, count, n):
    return 1e-310 * _random(rng, count, n)


def _almost_split(rng, count, n):
    """Hessenberg matrices with subdiagonals of all sizes down to nothing."""
    found = np.triu(_random(rng, count, n), -1)
    found[:, np.arange(1, n), np.arange(n - 1)] *= 10.0 ** rng.uniform(-20, 0, (count, n - 1))
    return found


def _with_noise(rng, count, n):
    """Hessenberg matrices with noise below, which balancing would take for numbers."""
    return np.triu(_random(rng, count, n), -1) + 1e-16 * _random(rng, count, n)


def _of_motion(rng, count, n):
    """State matrices of equations of motion with stiffness of all sizes."""
    half = max(n // 2, 1)
    mass, stiffness = (_random(rng, count, half) for _ in range(2))
    mass = mass @ mass.swapaxes(1, 2) + 0.1 * np.eye(half)
    stiffness = stiffness @ stiffness.swapaxes(1, 2) * 10.0 ** rng.uniform(0, 8, (count, 1, 1))
    found = np.zeros((count, 2 * half, 2 * half))
    found[:, :half, half:] = np.eye(half)
    found[:, half:, :half] = -np.linalg.solve(mass, stiffness)
    found[:, half:, half:] = -np.linalg.solve(mass, _random(rng, count, half))
    return found


FAMILIES = {
    function.__name__.strip("_").replace("_", " "): function
    for function in (
        *(
            _random,
            _companion,
            _of_whole_roots,
            _defective,
            _graded,
            _badly_scaled,
            _block,
            _twins,
            _triangular,
        ),
        *(
            _rank_one,
            _skew,
            _permutations,
            _whole_numbers,
            _zero,
            _one,
            _small,
            _large,
            _denormal,
            _almost_split,
        ),
        *(_with_noise, _of_motion),
    )
}


def normalised(matrices):
    """Return the matrices divided by their largest entry, and this entry; 1 for zero."""
    size = np.abs(matrices).max(axis=(1, 2))
    size = np.where(size == 0, 1.0, size)
    return matrices / size[:, None, None], size


def divided(values, size):
    """Complex numbers divided part by part, so that the smallest numbers do not overflow."""
    return values.real / size + 1j * (values.imag / size)


def backward_error(matrices, values):
    """Return the largest of the smallest singular values of A - λI over the norm of A, for each matrix."""
    alike, size = normalised(matrices)
    norm = np.linalg.norm(alike, axis=(1, 2))
    own = divided(values, size[:, None])
    moved = alike[:, None] - own[..., None, None] * np.eye(matrices.shape[-1])
    smallest = np.linalg.svd(moved, compute_uv=False)[..., -1].max(axis=1)
    return smallest / np.where(norm == 0, 1, norm)


def residual(matrices, values, right):
    """Return the largest |A x - λ x| of vectors of length one over the norm of A, for each matrix."""
    alike, size = normalised(matrices)
    norm = np.linalg.norm(alike, axis=(1, 2))
    left = alike @ right - right * divided(values, size[:, None])[:, None, :]
    return np.linalg.norm(left, axis=1).max(axis=1) / np.where(norm == 0, 1, norm)
