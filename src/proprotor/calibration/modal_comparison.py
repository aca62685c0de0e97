"""Measured modes of a structure beside those of a model: frequencies, damping, and how alike the motions of the hub
are.

The modal assurance criterion of two motions a and b of the hub is |a·b|² / (a·a b·b), 1 for the same motion and 0 for
motions at right angles (Allemang and Brown, 1982). Rotations count as the displacement at a distance. Six motions of
one point tell modes apart that move the hub differently, and no others.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from proprotor.errors import InputError
from proprotor.model import mass_at_rest, stamp
from proprotor.model.configuration import Configuration
from proprotor.model.rotor_share import without_rotors
from proprotor.support import ROTATION, Airframe, NormalModes
from proprotor.typing import Array, Dataset
from proprotor.units import values_in_si

_MODES = 12  # of the model at most, by frequency
_ALIKE = 0.1  # of the criterion: a second mode this near to the best makes the pair doubtful


class _StructureModes(NamedTuple):
    """Modes of a structure: names, frequency (modes,) in rad/s, damping ratio, motion of the hub (6, modes)."""

    names: tuple[str, ...]
    frequency: Array
    damping: Array
    hub: Array


def compare_modes(case: Configuration, measured: NormalModes, *, distance: Any = None) -> Dataset:
    """Return measured modes of a structure beside those of the support of a case, at rest and without air.

    The rotor of the case is held as it was in the test: `measured.includes_rotor` and `measured.shaft`.

    Parameters
    ----------
    case : Case
        One design with one rotor.
    measured : NormalModes
        Such as `proprotor.support.universal_modes.universal_modes` reads, or the support of another case.
    distance : float in m, text, or pint quantity, optional
        At which a rotation counts as a displacement; the radius of the rotor by default.

    Returns
    -------
    xarray.Dataset
        mac (measured, model); by measured mode: pair, the model's mode that goes with it, so that the sum of the
        criterion over all pairs is largest and no mode has two; measured_frequency and model_frequency, rad/s;
        frequency_misfit, model over measured less 1; measured_damping and model_damping; pair_mac; warning. Attributes:
        distance (m), the case and its options (`proprotor.model.stamp`).

    Raises
    ------
    InputError
        For an aircraft with two rotors, many designs, and a structure without mass for the rotor that it includes.
    """
    import xarray  # here, because it takes long to import
    from scipy.optimize import linear_sum_assignment

    if isinstance(case.support, Airframe) or isinstance(measured, Airframe):
        raise InputError("support", "an aircraft", "must carry one rotor for a comparison of modes")
    length = np.asarray(case.rotor.radius) if distance is None else values_in_si(distance, "m", "distance")
    if length.ndim or case.support.mass.ndim != 2 or measured.mass.ndim != 2:
        raise InputError("case", case.name, "must be one design")
    model, test = _modes(_held_as(case, measured)), _modes(measured)
    mac = _assurance(test.hub, model.hub, float(length))
    rows, columns = linear_sum_assignment(-mac)
    pair = np.full(len(test.names), -1)
    pair[rows] = columns
    there = pair >= 0
    frequency, damping = (np.where(there, own[pair], np.nan) for own in (model.frequency, model.damping))
    by_measured = {
        "pair": np.where(there, np.array(model.names)[pair], ""),
        "measured_frequency": test.frequency,
        "model_frequency": frequency,
        "frequency_misfit": frequency / test.frequency - 1,
        "measured_damping": test.damping,
        "model_damping": damping,
        "pair_mac": np.where(there, mac[np.arange(len(pair)), pair], np.nan),
        "warning": np.array(_doubts(mac, pair, model.names)),
    }
    return xarray.Dataset(
        {
            "mac": (("measured", "model"), mac),
            **{name: ("measured", own) for name, own in by_measured.items()},
        },
        coords={
            "measured": list(test.names),
            "model": list(model.names),
            "frequency_of_model": ("model", model.frequency, {"units": "rad/s"}),
        },
        attrs=stamp.of_case(case, {}) | {"distance": float(length)},
    )


def _assurance(one: Array, other: Array, distance: float) -> Array:
    """Return the modal assurance criterion (k, m) of motions of the hub (6, k) and (6, m).

    Parameters
    ----------
    one, other : array (6, k), array (6, m)
        m and rad.
    distance : float
        At which a rotation counts as a displacement, m.
    """
    first, second = (np.array(own) for own in (one, other))
    first[ROTATION] *= distance
    second[ROTATION] *= distance
    sizes = (first**2).sum(axis=0)[:, None] * (second**2).sum(axis=0)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.nan_to_num((first.T @ second) ** 2 / sizes))


def _held_as(case: Configuration, measured: NormalModes) -> NormalModes:
    """Return the support of a case with its rotor held as in a test."""
    support, at_rest = case.support, mass_at_rest(case.rotor)
    bare, refusal = without_rotors(support, [(support.hub, at_rest)])
    if refusal is not None and np.any(refusal != ""):
        raise InputError("support.includes_rotor", support.includes_rotor, str(np.ravel(refusal)[0]))
    # What is taken off a structure without mass is minus what the rotor adds.
    holding = _with_mass(support, np.zeros_like(support.mass), measured)
    taken, _ = without_rotors(holding, [(support.hub, at_rest)])
    return _with_mass(support, bare - taken, measured)


def _with_mass(support: NormalModes, mass: Array, like: NormalModes) -> NormalModes:
    """Return plain normal modes with another mass, of which the rotor is held as in another support."""
    return NormalModes(
        support.names,
        mass,
        support.damping,
        support.stiffness,
        support.hub,
        like.includes_rotor,
        like.shaft,
    )


def _modes(support: NormalModes) -> _StructureModes:
    """Return the normal modes of a structure."""
    from scipy.linalg import eigh  # here, because scipy.linalg takes long to import

    square, shapes = eigh(np.real(support.stiffness), np.real(support.mass))
    kept = np.arange(len(square))[:_MODES]
    square, shapes = square[kept], shapes[:, kept]
    frequency = np.sqrt(square.clip(0))
    damping = np.einsum("im,ij,jm->m", shapes, np.real(support.damping), shapes)
    with np.errstate(invalid="ignore", divide="ignore"):
        ratio = np.where(frequency > 0, damping / (2 * frequency), np.nan)
    energy = shapes * (np.real(support.mass) @ shapes)  # of each coordinate in each mode
    return _StructureModes(
        _named(tuple(support.names), energy), frequency, ratio, np.real(support.hub) @ shapes
    )


def _named(names: tuple[str, ...], energy: Array) -> tuple[str, ...]:
    """Return a name for each mode: the coordinate with most of its energy, numbered where it comes again."""
    found: list[str] = []
    for column in energy.T:
        name = names[int(np.argmax(column))]
        again = sum(other == name or other.startswith(f"{name} ") for other in found)
        found.append(f"{name} {again + 1}" if again else name)
    return tuple(found)


def _doubts(mac: Array, pair: Array, names: tuple[str, ...]) -> list[str]:
    """Return why the pair of each measured mode is doubtful."""
    found = []
    for row, chosen in zip(mac, pair, strict=True):
        if chosen < 0:
            found.append("no mode of the model is left for it")
            continue
        near = [
            name for place, name in enumerate(names) if place != chosen and row[place] > row[chosen] - _ALIKE
        ]
        found.append(f"{' and '.join(near)} moves the hub as much like it" if near else "")
    return found
