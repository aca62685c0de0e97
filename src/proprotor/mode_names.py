"""Names of modes, from the coordinates that take part in them and the way they whirl.

A model has as many names as modes: one for each coordinate of the support, for coning and the collective motion of
each other blade angle, for the rotor speed, and two for the cyclic motion of each blade angle and of the gimbal,
regressive and progressive. A mode gets its name at one point, the anchor, by the assignment with the largest sum of
participations, one name to one mode, and keeps it wherever it is followed.

Progressive and regressive are meant as the blades see it. A cyclic motion of frequency ν in the rotating frame appears
in the fixed frame at ν + 1 per revolution, whirling with the rotor, when it runs round the rotor forwards, and at
|ν - 1| when it runs backwards; the latter whirls against the rotor in the fixed frame for ν > 1 and with it, but slower
than the blades, for ν < 1. So a mode is progressive where its eigenvector whirls with the rotor faster than the rotor,
and regressive otherwise. How it whirls in the fixed frame is another number, `whirl`. From one to the other,
β_1c + i β_1s is what whirls with the rotor and β_1c - i β_1s what whirls against it, for s = iω, ω > 0 and an azimuth
that grows with rotation (β = β_1c cos ψ + β_1s sin ψ).
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from proprotor_equations import FIXED_COORDINATES

from proprotor.arrays import Array
from proprotor.errors import InputError
from proprotor.model import HUB, ROTOR_SPEED, reactionless_coordinates
from proprotor.printable import unprintable

_COLLECTIVE = {"flap": "coning"}
_AZIMUTH = "rotor speed"
SECOND = ", second root"


class Motion(NamedTuple):
    """A coordinate, or a cyclic pair of them, and the names of its modes.

    Attributes
    ----------
    names : tuple of str
        One, or regressive and progressive.
    places : tuple of int
        Of the coordinate, or of its cosine and its sine part, among the coordinates of the model.
    """

    names: tuple[str, ...]
    places: tuple[int, ...]


def motions(dofs: tuple[str, ...]) -> list[Motion]:
    """The motions of a model, in the order of its coordinates."""
    found = []
    for place, dof in enumerate(dofs):
        partner = dof[:-1] + "s"
        if _is_cosine(dof) and partner in dofs:
            found.append(Motion(_cyclic_names(dof), (place, dofs.index(partner))))
        elif not (_is_cosine(dof[:-1] + "c") and dof[:-1] + "c" in dofs and dof.endswith("s")):
            found.append(Motion((_single_name(dof),), (place,)))
    return found


def _is_cosine(dof: str) -> bool:
    stem, _, part = dof.rpartition("_")
    return bool(stem) and part.endswith("c") and part[:-1].isdigit()


def _cyclic_names(dof: str) -> tuple[str, str]:
    stem, _, part = dof.rpartition("_")
    motion = stem if part == "1c" else f"{stem} {part[:-1]}"
    return f"regressive {motion}", f"progressive {motion}"


def _single_name(dof: str) -> str:
    stem, _, part = dof.rpartition("_")
    if dof == ROTOR_SPEED:
        return _AZIMUTH
    if stem and part == "0":
        return _COLLECTIVE.get(stem, f"collective {stem}")
    if stem and part == "d":
        return f"differential {stem}"
    return dof


def name_list(dofs: tuple[str, ...]) -> list[str]:
    """All names of a model, in the order of its coordinates."""
    return [name for motion in motions(dofs) for name in motion.names]


def check_support_names(field: str, names: Sequence[str]) -> None:
    """Refuse names of a support's coordinates that a rotor's coordinate or mode has, or that make two modes alike.

    Parameters
    ----------
    field : str
        What a message calls the names.
    names : sequence of str

    Raises
    ------
    InputError
        For a name that is no printable text, or one that is taken, with the first of them.
    """
    for name in names:
        if unprintable(name) or not name.strip():
            raise InputError(field, name, "must be printable text")
        if re.sub(r"\d+", "2", name) in _names_of_rotors() or name.endswith(SECOND):
            rule = "must not be the name that a motion of a rotor has, which results would take it for"
            raise InputError(field, name, rule)
    check_distinct(field, tuple(names))


def check_distinct(field: str, dofs: tuple[str, ...]) -> None:
    """Refuse coordinates of a model where two modes would have one name.

    Raises
    ------
    InputError
        With the coordinates whose modes would.
    """
    by_name: dict[str, str] = {}
    for motion in motions(dofs):
        own = ", ".join(dofs[place] for place in motion.places)
        for name in (other + ending for other in motion.names for ending in ("", SECOND)):
            if name in by_name:
                raise InputError(field, f"{by_name[name]}, {own}", f'must differ: both have a mode "{name}"')
            by_name[name] = own


@lru_cache(maxsize=1)
def _names_of_rotors() -> frozenset[str]:
    """Coordinates and modes of rotors with any number of blades, the number of a harmonic written as 2."""
    dofs = (*FIXED_COORDINATES[len(HUB) :], *reactionless_coordinates(6))
    return frozenset(re.sub(r"\d+", "2", name) for name in (*dofs, *name_list(dofs)))


def whirl_shares(motion: Motion, held: list[int], left: Array, right: Array) -> tuple[Array, Array]:
    """Participation of what whirls against and with the rotor in each state, two arrays (..., states).

    Parameters
    ----------
    motion : Motion
        A cyclic one.
    held : list of int
        Coordinates whose displacement is a state.
    left, right : array (..., states, states)
        Left vectors in rows, right ones in columns.
    """
    with_rotor, against = np.zeros(()), np.zeros(())
    for cosine, sine in zip(*(_states(place, held, right.shape[-2]) for place in motion.places), strict=True):
        c, s = right[..., cosine, :], right[..., sine, :]
        lc, ls = left[..., :, cosine], left[..., :, sine]
        with_rotor = with_rotor + np.abs((c + 1j * s) * (lc - 1j * ls)) / 2
        against = against + np.abs((c - 1j * s) * (lc + 1j * ls)) / 2
    return against, with_rotor


def _states(place: int, held: list[int], states: int) -> list[int]:
    """States of a coordinate: its displacement, unless it has none, and its rate."""
    rate = len(held) + place
    return [held.index(place), rate] if place in held else [rate]


def whirl(dofs: tuple[str, ...], held: list[int], values: Array, left: Array, right: Array) -> Array:
    """Sense of whirl in the fixed frame (..., states): 1 with the rotor, -1 against it, by participation.

    NaN for real roots and where a model has no cyclic motion.
    """
    against, with_rotor = np.zeros(values.shape), np.zeros(values.shape)
    for motion in motions(dofs):
        if len(motion.places) == 2:
            shares = whirl_shares(motion, held, left, right)
            against, with_rotor = against + shares[0], with_rotor + shares[1]
    total = against + with_rotor
    turned = np.where(values.imag < 0, -1.0, 1.0) * (with_rotor - against)
    return np.where((total > 0) & (values.imag != 0), turned / np.where(total > 0, total, 1), np.nan)


def name_shares(
    dofs: tuple[str, ...],
    held: list[int],
    values: Array,
    left: Array,
    right: Array,
    rotor_speed: float | None,
) -> Array:
    """Share of each name in each state of one point (names, states); sums to 1 over the names."""
    columns = []
    faster = np.abs(values.imag) > (np.inf if rotor_speed is None else abs(rotor_speed))
    for motion in motions(dofs):
        if len(motion.places) == 1:
            places = _states(motion.places[0], held, right.shape[-2])
            columns.append(sum(np.abs(left[:, place] * right[place]) for place in places))
            continue
        against, with_rotor = whirl_shares(motion, held, left, right)
        swapped = values.imag < 0  # the conjugate of a state whirls as the state does
        against, with_rotor = (
            np.where(swapped, with_rotor, against),
            np.where(swapped, against, with_rotor),
        )
        if rotor_speed is None:
            columns += [against, with_rotor]
        else:
            columns += [against + np.where(faster, 0, with_rotor), np.where(faster, with_rotor, 0)]
    sums = np.array(columns)
    shares: Array = sums / sums.sum(axis=0)
    return shares


def assign_names(dofs: tuple[str, ...], held: list[int], shares: Array, values: Array) -> list[str]:
    """The name of each state of one point; both states of a pair have the same one.

    Parameters
    ----------
    dofs : tuple of str
    held : list of int
    shares : array (names, states)
        Of `name_shares`.
    values : array (states,)
        Eigenvalues, each pair side by side.
    """
    slots = _slots(dofs, held)
    fixed: dict[int, int] = {}
    while True:
        given = _assignment(shares, slots, fixed)
        torn = [k for k in np.flatnonzero(values.imag > 0) if given[k] != given[k + 1]]
        if not torn:
            names = name_list(dofs)
            return [names[name] for name in given]
        # A pair has one name, of those with room for both its states: the likelier of the two, and whoever has its
        # other half finds another. Each round settles one pair more, so that there is an end.
        room = np.bincount(slots) - np.bincount(list(fixed.values()), minlength=slots.max() + 1)
        surest = max(torn, key=lambda k: shares[[given[k], given[k + 1]], k].max())
        whole = [name for name in (given[surest], given[surest + 1]) if room[name] >= 2]
        name = max(whole or np.flatnonzero(room >= 2), key=lambda name: shares[name, surest])
        fixed |= {int(surest): int(name), int(surest) + 1: int(name)}


def _slots(dofs: tuple[str, ...], held: list[int]) -> Array:
    """The name of each of as many places as there are states: two for each mode, one for a rate alone."""
    slots, count = [], 0
    for motion in motions(dofs):
        for _ in motion.names:
            rate_alone = len(motion.places) == 1 and motion.places[0] not in held
            slots += [count] * (1 if rate_alone else 2)
            count += 1
    return np.array(slots)


def _assignment(shares: Array, slots: Array, fixed: dict[int, int]) -> Array:
    from scipy.optimize import linear_sum_assignment  # here, because it takes long to import

    gain = shares[slots].T.copy()  # (states, slots)
    for state, name in fixed.items():
        gain[state] = np.where(slots == name, 1e3, 0)
    assigned: Array = slots[linear_sum_assignment(gain, maximize=True)[1]]
    return assigned
