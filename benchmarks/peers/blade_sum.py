"""From one blade's matrices to the rotor's by numbers: the sum over the blades, without the generated equations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

FIXED = (
    *(
        "x",
        "y",
        "z",
        "alpha_x",
        "alpha_y",
        "alpha_z",
        "flap_0",
        "flap_1c",
        "flap_1s",
        "lag_0",
        "lag_1c",
        "lag_1s",
    ),
    *("pitch_0", "pitch_1c", "pitch_1s", "azimuth", "gimbal_1c", "gimbal_1s"),
)
# Each blade coordinate in those of the rotor, as (mean, cosine, sine) parts.
SHARES: dict[str, dict[str, tuple[float, float, float]]] = {
    "hub_i": {"x": (0, 0, 1), "y": (0, -1, 0)},
    "hub_j": {"x": (0, 1, 0), "y": (0, 0, 1)},
    "hub_k": {"z": (1, 0, 0)},
    "turn_i": {"alpha_x": (0, 0, 1), "alpha_y": (0, -1, 0)},
    "turn_j": {"alpha_x": (0, 1, 0), "alpha_y": (0, 0, 1)},
    "turn_k": {"alpha_z": (1, 0, 0)},
    "flap": {"flap_0": (1, 0, 0), "flap_1c": (0, 1, 0), "flap_1s": (0, 0, 1)},
    "lag": {"lag_0": (1, 0, 0), "lag_1c": (0, 1, 0), "lag_1s": (0, 0, 1)},
    "pitch": {"pitch_0": (1, 0, 0), "pitch_1c": (0, 1, 0), "pitch_1s": (0, 0, 1)},
    "azimuth": {"azimuth": (1, 0, 0)},
    "gimbal_flap": {"gimbal_1c": (0, 1, 0), "gimbal_1s": (0, 0, 1)},
    "gimbal_roll": {"gimbal_1c": (0, 0, -1), "gimbal_1s": (0, 1, 0)},
}


def fixed_coordinates(blade: Sequence[str]) -> list[str]:
    """The rotor's coordinates that these of a blade make."""
    needed = {name for coordinate in blade for name in SHARES[coordinate]}
    return [name for name in FIXED if name in needed]


def transformation(blade: Sequence[str], azimuth: float) -> tuple[NDArray, NDArray, NDArray]:
    """One blade's coordinates in those of the rotor (rows, columns), and first and second derivative by azimuth."""
    fixed, c, s = fixed_coordinates(blade), np.cos(azimuth), np.sin(azimuth)
    found = np.zeros((3, len(blade), len(fixed)))
    for row, coordinate in enumerate(blade):
        for name, (mean, cosine, sine) in SHARES[coordinate].items():
            found[:, row, fixed.index(name)] = (
                mean + cosine * c + sine * s,
                sine * c - cosine * s,
                -cosine * c - sine * s,
            )
    return tuple(found)


def over_blades(
    quantities: Mapping[str, Any],
    blade: Sequence[str],
    matrices: tuple[NDArray, NDArray, NDArray],
    count: int = 3,
) -> tuple[NDArray, NDArray, NDArray]:
    """M, C, K of the rotor (..., m, m) from those of one blade (..., n, n) in its coordinates."""
    speed = np.asarray(quantities["rotor_speed"])[..., None, None]
    mass, damping, stiffness = matrices
    total = [0.0, 0.0, 0.0]
    for azimuth in 0.3 + 2 * np.pi / count * np.arange(count):  # any azimuth: the coefficients are constant
        t, t1, t2 = transformation(blade, azimuth)
        total[0] = total[0] + t.T @ mass @ t
        total[1] = total[1] + t.T @ (2 * speed * mass @ t1 + damping @ t)
        total[2] = total[2] + t.T @ (speed**2 * mass @ t2 + speed * damping @ t1 + stiffness @ t)
    return tuple(total)
