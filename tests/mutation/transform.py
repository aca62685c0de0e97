"""Coordinates of one blade in rotating axes by those of the rotor in the fixed frame, and the sum over blades: numbers.

Rotating axes at azimuth ψ: i = I sin ψ − J cos ψ towards the trailing edge, j = I cos ψ + J sin ψ outboard, k = K. The
tilt of the gimbal, β_GS I − β_GC J, has the component flap along i and roll along j.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from proprotor_equations import BLADE_COORDINATES

ANGLES = ("flap", "lag", "pitch")


def _wave(order: int, azimuth: float, part: str) -> NDArray:
    """cos nψ (part "c") or sin nψ ("s"), and its first and second derivative with azimuth."""
    cosine, sine = np.cos(order * azimuth), np.sin(order * azimuth)
    if part == "s":
        return np.array([sine, order * cosine, -(order**2) * sine])
    return np.array([cosine, -order * sine, -(order**2) * cosine])


def _constant(value: float) -> NDArray:
    return np.array([value, 0.0, 0.0])


def _components(name: str, azimuth: float, blade: int) -> dict[str, NDArray]:
    """Coordinates of a blade per unit of one coordinate of the rotor, each with two derivatives with azimuth."""
    cosine, sine = (_wave(1, azimuth, part) for part in "cs")
    along = {"x": (sine, cosine), "y": (-cosine, sine)}
    kind, _, part = name.rpartition("_")
    if name in along:
        return dict(zip(("hub_i", "hub_j"), along[name], strict=True))
    if name in ("alpha_x", "alpha_y"):
        return dict(zip(("turn_i", "turn_j"), along[part], strict=True))
    if name in ("z", "alpha_z", "azimuth"):
        return {{"z": "hub_k", "alpha_z": "turn_k", "azimuth": "azimuth"}[name]: _constant(1.0)}
    if name == "gimbal_1s":
        return {"gimbal_flap": sine, "gimbal_roll": cosine}
    if name == "gimbal_1c":
        return {"gimbal_flap": cosine, "gimbal_roll": -sine}
    if part in ("0", "d"):
        return {kind: _constant((-1.0) ** blade if part == "d" else 1.0)}
    return {kind: _wave(int(part[:-1]), azimuth, part[-1])}


def seen_from_blade(names: tuple[str, ...], azimuth: float, blade: int = 0) -> NDArray:
    """T, T', T'' (3, 12, n): coordinates of a blade at `azimuth` per unit of the rotor's, and derivatives."""
    transform = np.zeros((3, len(BLADE_COORDINATES), len(names)))
    for column, name in enumerate(names):
        for row, values in _components(name, azimuth, blade).items():
            transform[:, BLADE_COORDINATES.index(row), column] = values
    return transform


def summed_over_blades(
    blade: tuple[NDArray, NDArray, NDArray],
    names: tuple[str, ...],
    n_blades: int,
    rotor_speed: float,
    shaft: float,
) -> tuple[list[NDArray], list[NDArray]]:
    """M, C, K of the rotor from those of one blade, and the same sums of absolute values, for their rounding."""

    def total(M: NDArray, C: NDArray, K: NDArray, size: bool) -> list[NDArray]:
        sums = [np.zeros((len(names), len(names))) for _ in range(3)]
        for m in range(n_blades):
            transform = seen_from_blade(names, shaft + 2 * np.pi * m / n_blades, m)
            T, rate, acceleration = np.abs(transform) if size else transform
            rate, acceleration = rotor_speed * rate, rotor_speed**2 * acceleration
            sums[0] += T.T @ M @ T
            sums[1] += T.T @ (2 * M @ rate + C @ T)
            sums[2] += T.T @ (M @ acceleration + C @ rate + K @ T)
        return sums

    return total(*blade, size=False), total(*(np.abs(part) for part in blade), size=True)


def gusts_over_blades(blade: NDArray, names: tuple[str, ...], n_blades: int, shaft: float) -> NDArray:
    """Loads (n, 3) of gusts along I, J, K on the rotor, from those (12, 3) of gusts along i, j, k on a blade."""
    total = np.zeros((len(names), 3))
    for m in range(n_blades):
        azimuth = shaft + 2 * np.pi * m / n_blades
        T = seen_from_blade(names, azimuth)[0]
        s, c = np.sin(azimuth), np.cos(azimuth)
        total += T.T @ blade @ np.array([[s, -c, 0.0], [c, s, 0.0], [0.0, 0.0, 1.0]])
    return total


ONE_BLADE = (
    *("x", "y", "z", "alpha_x", "alpha_y", "alpha_z"),
    *("flap_0", "lag_0", "pitch_0", "azimuth", "gimbal_1c", "gimbal_1s"),
)
"""Coordinates of a rotor of one blade: as many as a blade has in rotating axes."""


def in_rotating_axes(
    fixed: tuple[NDArray, NDArray, NDArray], rotor_speed: float
) -> tuple[NDArray, NDArray, NDArray]:
    """M, C, K of one blade at no azimuth from those of a rotor of one blade, on `ONE_BLADE`."""
    T, rate, acceleration = seen_from_blade(ONE_BLADE, 0.0)
    rate, acceleration = rotor_speed * rate, rotor_speed**2 * acceleration
    back = np.linalg.inv(T)  # a permutation with signs: nothing is rounded
    M, C, K = (back.T @ matrix @ back for matrix in fixed)
    C = C - 2 * M @ rate @ back
    return M, C, K - M @ acceleration @ back - C @ rate @ back
