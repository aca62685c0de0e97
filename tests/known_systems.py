"""Small systems whose matrices are written down, for what follows modes and finds boundaries."""

from collections.abc import Callable
from dataclasses import fields

import numpy as np
from numpy.typing import ArrayLike, NDArray

import proprotor as pp
from proprotor.rotor.trim import Trim


def linear_model(
    mass: ArrayLike, damping: ArrayLike, stiffness: ArrayLike, dofs: tuple[str, ...] | None = None
) -> pp.LinearModel:
    """A model of matrices (..., n, n) at hand; points with NaN have failed. Complex matrices are taken."""
    mass, damping, stiffness = np.broadcast_arrays(mass, damping, stiffness)
    shape, n = mass.shape[:-2], mass.shape[-1]
    failed = ~np.isfinite(stiffness).all(axis=(-2, -1))
    mass, damping = (np.where(failed[..., None, None], np.nan, part) for part in (mass, damping))
    trim = {entry.name: np.zeros(shape) for entry in fields(Trim)}
    trim |= {"reason": np.where(failed, "fails here", ""), "warning": np.full(shape, "")}
    names = dofs or tuple(f"q{place}" for place in range(n))
    return pp.LinearModel(
        mass, damping, stiffness, names, Trim(**trim | {"converged": ~failed}), np.zeros(shape)
    )


def along(matrices: Callable[[NDArray], tuple], **told) -> Callable[[NDArray], pp.LinearModel]:
    """Models at positions (k,), from a function of positions (k, 1, 1) that gives M, C and K."""
    return lambda x: linear_model(*matrices(np.asarray(x)[..., None, None]), **told)


def roots(model: pp.LinearModel) -> NDArray:
    """Roots of det(λ²M + λC + K) at each point (k, 2n), without eigenvectors: by the companion of M⁻¹C and M⁻¹K."""
    n = model.M.shape[-1]
    top = np.concatenate([np.zeros_like(model.M), np.broadcast_to(np.eye(n), model.M.shape)], axis=-1)
    bottom = -np.linalg.solve(model.M, np.concatenate([model.K, model.C], axis=-1))
    return np.linalg.eigvals(np.concatenate([top, bottom], axis=-2)).astype(complex)


def continued(values: NDArray) -> NDArray:
    """Roots (k, m) in the places of the nearest ones before: right where points are dense enough."""
    from scipy.optimize import linear_sum_assignment

    placed = [values[0]]
    for here in values[1:]:
        before = placed[-1] if len(placed) < 2 else 2 * placed[-1] - placed[-2]
        placed.append(here[linear_sum_assignment(np.abs(before[:, None] - here[None, :]))[1]])
    return np.array(placed)


def oscillators(position: NDArray, coupling: float, damping: tuple[float, float] = (0.0, 0.0)) -> tuple:
    """Two oscillators whose springs 100 ∓ 50 (1 - 2p) change places along p, with a spring between them."""
    half = 50 * (1 - 2 * position)
    one, other = np.diag([1.0, 0.0]), np.diag([0.0, 1.0])
    between = np.array([[0.0, 1.0], [1.0, 0.0]])
    stiffness = 100 * np.eye(2) - half * one + half * other + coupling * between
    return np.eye(2), np.diag(damping), stiffness
