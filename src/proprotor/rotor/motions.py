"""Motions of a model: which coordinates make one, alone or as a cyclic pair, and what its modes are called."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

from proprotor_equations import FIXED_COORDINATES

from proprotor.errors import InputError, unprintable

HUB = FIXED_COORDINATES[:6]
ROTOR_SPEED = "azimuth"  # enters as a rate: nothing holds the rotor's azimuth
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


def reactionless_coordinates(n_blades: int) -> tuple[str, ...]:
    """Blade motions beyond Eq. 17: harmonics 2 to below N/2, and for even N neighbours against each other."""
    angles = ("flap", "lag", "pitch")
    pairs = [f"{angle}_{n}{part}" for n in range(2, (n_blades + 1) // 2) for angle in angles for part in "cs"]
    return tuple(pairs + [f"{angle}_d" for angle in angles] * (n_blades % 2 == 0))


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
