"""Airframes made up by hand for tests: free to fly, with elastic coordinates and hub motions of both symmetries."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import proprotor as pp
from proprotor.support.airframe import Airframe

OUTBOARD, AHEAD, ABOVE = 4.9, 1.3, 0.4  # of the right hub from the centre of gravity, m
SYMMETRIC = ("heave", "surge", "pitch", "beam", "chord", "torsion")
ANTISYMMETRIC = ("sway", "roll", "yaw", "beam", "chord", "torsion")
RATES = ("symmetric heave", "symmetric surge", "antisymmetric sway", "antisymmetric roll")
MIRROR = np.diag([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])


def turned(axis: int) -> np.ndarray:
    """Return the motion (6,) of the right hub when the aircraft turns about an axis through its centre of gravity."""
    turn = np.eye(3)[axis]
    return np.concatenate([np.cross(turn, [ABOVE, OUTBOARD, AHEAD]), turn])


def half(symmetry: str, seed: int, flexibility: float = 1.0, airloads: float = 1.0) -> Airframe:
    """Return the coordinates of one symmetry: three of the rigid body, three elastic ones."""
    numbers = np.random.default_rng(seed)
    own = SYMMETRIC if symmetry == "symmetric" else ANTISYMMETRIC
    axes = (0, 2, 4) if symmetry == "symmetric" else (1, 5, 3)  # of HUB_AXES, in the order of the names
    rigid = np.stack([np.eye(6)[axis] if axis < 3 else turned(axis - 3) for axis in axes], axis=1)
    elastic = numbers.normal(size=(6, 3)) * np.array([1.0, 0.3, 1.0, 0.2, 0.4, 0.2])[:, None]
    inertia = np.array([2500.0, 2500.0, 1.2e4] if symmetry == "symmetric" else [2500.0, 3e4, 4e4])
    shares = numbers.normal(size=(3, 3))
    mass = np.diag([*inertia, 0, 0, 0])
    mass[3:, 3:] = 400.0 * np.eye(3) + 30.0 * (shares + shares.T)
    frequency = np.array([20.0, 38.0, 55.0]) * (1.0 if symmetry == "symmetric" else 1.2) / flexibility**0.5
    stiffness = np.zeros((6, 6))
    stiffness[3:, 3:] = np.diag(frequency**2 * np.diagonal(mass)[3:])
    damping = np.zeros((6, 6))
    damping[3:, 3:] = np.diag(2 * 0.02 * frequency * np.diagonal(mass)[3:])
    free, aside = (0, 1), 2  # places of the rates, and of the coordinate with incidence
    air_damping, air_stiffness = np.zeros((6, 6)), np.zeros((6, 6))
    lift = numbers.normal(size=(6, 6))
    air_damping = airloads * (lift @ lift.T / 6 * 1.5 + 4.0 * np.eye(6))
    air_stiffness[:, aside] = airloads * numbers.normal(size=6)
    air_stiffness[aside, aside] = airloads * 8.0
    air_stiffness[3:, 3:] += airloads * 0.3 * numbers.normal(size=(3, 3))
    assert not air_stiffness[:, list(free)].any()
    hub = np.concatenate([rigid, elastic], axis=1)
    names = tuple(f"{symmetry} {name}" for name in own)
    return Airframe(
        names=names,
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        hub=hub,
        includes_rotor=False,
        left_hub=hub if symmetry == "symmetric" else -hub,
        symmetry=(symmetry,) * 6,
        rigid_body=names[:3],
        rates=tuple(name for name in RATES if name in names),
        airload_damping=air_damping,
        airload_stiffness=air_stiffness,
    )


def whole(seed: int = 3, **more: float) -> Airframe:
    """Return an airframe with the coordinates of both symmetries, which its own matrices do not couple."""
    parts = [half("symmetric", seed, **more), half("antisymmetric", seed + 1, **more)]
    return joined(*parts)


def joined(one: Airframe, other: Airframe) -> Airframe:
    """Return one airframe with the coordinates of two, which do not couple."""

    def diagonal(name: str) -> np.ndarray:
        first, second = (np.asarray(getattr(part, name)) for part in (one, other))
        found = np.zeros((len(first) + len(second),) * 2)
        found[: len(first), : len(first)], found[len(first) :, len(first) :] = first, second
        return found

    matrices = {name: diagonal(name) for name in MATRICES}
    hubs = {
        name: np.concatenate([getattr(part, name) for part in (one, other)], axis=1)
        for name in ("hub", "left_hub")
    }
    tuples = {
        name: getattr(one, name) + getattr(other, name)
        for name in ("names", "symmetry", "rigid_body", "rates")
    }
    return Airframe(**matrices, **hubs, **tuples, includes_rotor=False)


MATRICES = ("mass", "damping", "stiffness", "airload_damping", "airload_stiffness")


def aircraft(airframe: Airframe | None = None, deck: str = "xv15-uncoupled", **more: object) -> pp.Case:
    """Return the case of a bundled deck with its rotor on both sides of an airframe."""
    base = pp.load_case(deck)
    return replace(
        base, name="aircraft", support=whole() if airframe is None else airframe, deck=None, **more
    )
