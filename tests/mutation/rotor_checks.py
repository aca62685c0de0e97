"""From one blade to the rotor, and engine and shaft: sums over the blades as numbers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from proprotor_equations import BLADE_COORDINATES, FIXED_COORDINATES

from tests.mutation.comparison import Check, matrix_check
from tests.mutation.one_blade import Matrices
from tests.mutation.transform import ANGLES, gusts_over_blades, summed_over_blades

_KINDS = ("mass", "damping", "stiffness")
_SHAPE = (len(BLADE_COORDINATES),) * 2
_ROTOR_SPEED, _SHAFT = 1.7, 0.4  # rad/s and rad, like any other
_HARMONICS = ((5, 2), (7, 3), (8, 3))  # of so many blades


def checks() -> Iterator[Check]:
    for n_blades in (3, 4, 5):
        yield from _rotor(n_blades)
        yield _cyclic_restraint(n_blades)
    for n_blades, n in _HARMONICS:
        names = tuple(f"{angle}_{n}{part}" for angle in ANGLES for part in "cs")
        yield from _sums("reactionless_", n_blades, names, harmonic=n)
    for n_blades in (4, 6):
        yield from _sums("differential_", n_blades, tuple(f"{angle}_d" for angle in ANGLES))
    yield from _drive_train()


def _random(n_blades: int) -> Matrices:
    """Matrices of a blade without zeros and without symmetry."""
    rng = np.random.default_rng(n_blades)
    return tuple(rng.uniform(0.5, 1.5, _SHAPE) * rng.choice([-1, 1], _SHAPE) for _ in _KINDS)


def _sums(prefix: str, n_blades: int, names: tuple[str, ...], **more: Any) -> Iterator[Check]:
    blade, given = _random(n_blades), {"n_blades": n_blades, "rotor_speed": _ROTOR_SPEED} | more
    sums, sizes = summed_over_blades(blade, names, n_blades, _ROTOR_SPEED, _SHAFT)
    for count, kind in enumerate(_KINDS):
        sees, told = ("multiblade", prefix + kind), "the sum over the blades"
        yield matrix_check(sees, told, given, sums[count], sizes[count], *blade[: count + 1])


def _rotor(n_blades: int) -> Iterator[Check]:
    yield from _sums("", n_blades, FIXED_COORDINATES)
    gusts = np.random.default_rng(n_blades).uniform(0.5, 1.5, (_SHAPE[0], 3))
    expected = gusts_over_blades(gusts, FIXED_COORDINATES, n_blades, _SHAFT)
    sees, given = ("multiblade", "gust_loads"), {"n_blades": n_blades}
    yield matrix_check(sees, "the sum over the blades", given, expected, n_blades, gusts)


def _cyclic_restraint(n_blades: int) -> Check:
    """Springs on every blade that collective motion does not feel: Σ k (β_C cos ψ + β_S sin ψ)², and of pitch alike."""
    azimuth = _SHAFT + 2 * np.pi * np.arange(n_blades) / n_blades
    springs = {"flap": 2.3, "pitch": 3.7}
    expected = np.zeros((len(FIXED_COORDINATES),) * 2)
    for angle, spring in springs.items():
        seen = np.zeros((n_blades, len(FIXED_COORDINATES)))
        seen[:, FIXED_COORDINATES.index(f"{angle}_1c")] = np.cos(azimuth)
        seen[:, FIXED_COORDINATES.index(f"{angle}_1s")] = np.sin(azimuth)
        expected += spring * seen.T @ seen
    given = {
        "n_blades": n_blades,
        "cyclic_flap_stiffness_excess": springs["flap"],
        "cyclic_control_stiffness_excess": springs["pitch"],
    }
    sees, told = ("multiblade", "cyclic_restraint"), "the sum over the blades"
    return matrix_check(sees, told, given, expected, n_blades)


def _drive_train() -> Iterator[Check]:
    """½ I (ψ̇s + α̇z)² turns with rotor and hub; damper and shaft act on the azimuth."""
    given = {"drive_inertia": 31.0, "drive_damping": 7.0, "shaft_stiffness": 5e4}
    azimuth, turn = (np.array(FIXED_COORDINATES) == name for name in ("azimuth", "alpha_z"))
    along = (azimuth | turn, azimuth, azimuth)
    for kind, value, coordinates in zip(_KINDS, given.values(), along, strict=True):
        expected = value * np.outer(coordinates, coordinates)
        yield matrix_check(("drive_train", kind), "energies of engine and shaft", given, expected, value)
