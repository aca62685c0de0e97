"""Motions of a model: a single coordinate or a cyclic pair of coordinates, with the names of each motion's modes."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

from proprotor_equations import FIXED_COORDINATES
from proprotor_equations.coordinates import DIFFERENTIAL, FIXED, FIXED_INFLOW, REACTIONLESS_PAIR, Coordinate

from proprotor.errors import InputError, unprintable

HUB = tuple(coordinate.name for coordinate in FIXED if coordinate.angle in ("hub", "turn"))
ROTOR_SPEED = (
    "azimuth"  # only the rate of this coordinate is a state, because nothing holds the rotor's azimuth
)
MAST_TWIST = "mast twist"
HALVES = ("symmetric", "antisymmetric")  # of the motion of an aircraft with two mirrored rotors
_NAMES = {
    ROTOR_SPEED: "rotor speed",
    "flap_0": "coning",
    "inflow_0": "uniform inflow",
}  # of the modes of single coordinates
_PARTS = {"0": "collective", "d": "differential"}  # of a motion, by the ends of the coordinates' names
SECOND = ", second root"
# Coordinates whose rates are induced velocity, in m/s.
INFLOW = tuple(coordinate._replace(unit="m") for coordinate in FIXED_INFLOW)
LIFT = "lift"  # the motion of coordinates whose rates are circulation that lags
LAGS = ("slow", "fast")  # states of lift that lags
LAG_SHAPES = 2  # functions of the radius in which lift lags; tests/model/test_lift_lag.py has their error
LAGS_PER_BLADE = len(LAGS) * LAG_SHAPES
_LIFT = re.compile(r"(^| )(slow|fast) lift( \d+)?$")  # stems of their coordinates
_OF_LOOP = re.compile(r" (law|delay|actuator)( \d+)?(_[ab])?$")
_OF_LAW = re.compile(r"(.* law(?: \d+)?)_([ab])")  # two states of a control law, which may swing as one pair


class Motion(NamedTuple):
    """A coordinate or a cyclic pair of coordinates, with the names of the modes.

    Attributes
    ----------
    names : tuple of str
        One name, or the names of the regressive and the progressive mode. A cyclic pair of which only the rates are
        states, of lift that lags or of inflow, has one mode, and so have two states of a control law.
    places : tuple of int
        Places of the coordinate, or of the cosine and the sine part, or of two states, among the coordinates of the
        model.
    """

    names: tuple[str, ...]
    places: tuple[int, ...]


def reactionless_coordinates(n_blades: int) -> list[Coordinate]:
    """Return the blade motions that Eq. 17 leaves out: harmonics 2 to below N/2, for even N also opposed neighbours."""
    return [motion for group in reactionless_groups(n_blades) for motion in group]


def reactionless_groups(n_blades: int) -> list[tuple[Coordinate, ...]]:
    """Return `reactionless_coordinates` in groups of which no two couple, for equal blades: one for each harmonic."""
    pairs = [
        tuple(
            motion._replace(name=f"{motion.angle}_{harmonic}{motion.part}", harmonic=harmonic)
            for motion in REACTIONLESS_PAIR
        )
        for harmonic in reactionless_harmonics(n_blades)
    ]
    return pairs + [tuple(DIFFERENTIAL)] * (n_blades % 2 == 0)


def reactionless_harmonics(n_blades: int) -> range:
    """Return the harmonics of the reactionless pairs of coordinates, 2 to below N/2."""
    return range(2, (n_blades + 1) // 2)


def lag_coordinates(shapes: int = LAG_SHAPES) -> tuple[Coordinate, ...]:
    """Return the coordinates whose rates are circulation that lags, in m/s, for a number of functions of the radius."""
    return _lagging(("0", "1c", "1s"), shapes)


def wing_lag_names(symmetry: Sequence[str]) -> tuple[str, ...]:
    """Return the names of the coordinates whose rates are downwash of a wing that takes effect late, in m/s.

    Parameters
    ----------
    symmetry : sequence of str
        The half of the motion of each function of the span, "" on a single wing.
    """
    numbers = [symmetry[: place + 1].count(half) for place, half in enumerate(symmetry)]
    return tuple(
        f"{half} {lag} wing lift{f' {number}' if number > 1 else ''}".lstrip()
        for lag in LAGS
        for half, number in zip(symmetry, numbers, strict=True)
    )


def with_lag(group: tuple[Coordinate, ...], shapes: int = LAG_SHAPES) -> tuple[Coordinate, ...]:
    """Return one of the `reactionless_groups` with the coordinates of circulation that lags behind its own."""
    return (*group, *_lagging(tuple(c.name.partition("_")[2] for c in group if c.angle == "flap"), shapes))


def _lagging(parts: tuple[str, ...], shapes: int) -> tuple[Coordinate, ...]:
    """Return coordinates of circulation by the ends of their names, such as 1c."""
    return tuple(
        Coordinate(
            f"{lag} lift{f' {shape}' if shape > 1 else ''}_{part}",
            LIFT,
            "N/2" if part == "d" else int(part.rstrip("cs")),
            part.lstrip("0123456789d"),
            "m",
        )
        for lag in LAGS
        for shape in range(1, shapes + 1)
        for part in parts
    )


def is_lift(name: str) -> bool:
    """Return whether a coordinate is one of those of lift that lags, of any rotor."""
    return bool(_LIFT.search(name.rpartition("_")[0]))


def is_inflow(name: str) -> bool:
    """Return whether a coordinate is one of those of the inflow, of any rotor."""
    return half_of(name)[1].rpartition(" ")[2] in [coordinate.name for coordinate in INFLOW]


def is_of_rotor(name: str) -> bool:
    """Return whether a coordinate or mode of a model is one of a rotor, and not of its support."""
    return re.sub(r"\d+", "2", half_of(name)[1]) in _names_of_rotors()


def is_of_loop(name: str) -> bool:
    """Return whether a coordinate or mode of a model has the name of a law, a delay or an actuator of a loop."""
    return bool(_OF_LOOP.search(name))


def motions(dofs: tuple[str, ...]) -> list[Motion]:
    """Return the motions of a model, in the order of its coordinates."""
    found = []
    for place, dof in enumerate(dofs):
        partner = dof[:-1] + "s"
        of_law = _OF_LAW.fullmatch(dof)
        if of_law:
            if of_law[2] == "a":
                found.append(Motion((of_law[1],), (place, dofs.index(f"{of_law[1]}_b"))))
        elif _is_cosine(dof) and partner in dofs:
            found.append(Motion(_cyclic_names(dof), (place, dofs.index(partner))))
        elif not (_is_cosine(dof[:-1] + "c") and dof[:-1] + "c" in dofs and dof.endswith("s")):
            found.append(Motion((_single_name(dof),), (place,)))
    return found


def in_half(half: str, name: str) -> str:
    """Return the name of a rotor's coordinate, mode or input in one half of the motion of an aircraft."""
    return f"{half} {name}"


def half_of(name: str) -> tuple[str, str]:
    """Return the half of the motion that a name begins with, "" for none, and the rest of the name."""
    half, _, rest = name.partition(" ")
    return (half, rest) if half in HALVES and rest else ("", name)


def _is_cosine(dof: str) -> bool:
    """Return whether a coordinate is the cosine part of a cyclic motion, such as flap_1c."""
    stem, _, part = dof.rpartition("_")
    return bool(stem) and part.endswith("c") and part[:-1].isdigit()


def _cyclic_names(dof: str) -> tuple[str, ...]:
    """Return the names of the modes of a cyclic motion, by its cosine part."""
    half, own = half_of(dof)
    stem, _, part = own.rpartition("_")
    if is_lift(own) or is_inflow(own):
        beyond = "" if part == "1c" else f", harmonic {part[:-1]}"
        return (f"{half} cyclic {stem}{beyond}".lstrip(),)
    motion = stem if part == "1c" else f"{stem} {part[:-1]}"
    regressive, progressive = (f"{half} {way} {motion}".lstrip() for way in ("regressive", "progressive"))
    return regressive, progressive


def _single_name(dof: str) -> str:
    """Return the name of the mode of a single coordinate."""
    half, own = half_of(dof)
    stem, _, part = own.rpartition("_")
    name = _NAMES.get(own) or (f"{_PARTS[part]} {stem}" if stem and part in _PARTS else own)
    return in_half(half, name) if half else name


def name_list(dofs: tuple[str, ...]) -> list[str]:
    """Return all mode names of a model, in the order of its coordinates."""
    return [name for motion in motions(dofs) for name in motion.names]


def check_support_names(field: str, names: Sequence[str]) -> None:
    """Refuse names of a support's coordinates that a rotor's coordinate or mode has, or that give two modes one name.

    Parameters
    ----------
    field : str
        Name of the input, for the message.
    names : sequence of str

    Raises
    ------
    InputError
        For the first name that is not printable text or is already taken.
    """
    for name in names:
        if unprintable(name) or not name.strip():
            raise InputError(field, name, "must be printable text")
        if re.sub(r"\d+", "2", name) in _names_of_rotors() or name.endswith(SECOND):
            rule = "must not be the name that a motion of a rotor has: results could not tell the two apart"
            raise InputError(field, name, rule)
    check_distinct(field, tuple(names))


@lru_cache(maxsize=16)  # of the supports of an analysis, which mounts many batches
def check_distinct(field: str, dofs: tuple[str, ...]) -> None:
    """Refuse coordinates of a model whose modes would have the same name.

    Raises
    ------
    InputError
        With the first two such coordinates.
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
    """Return the coordinates and modes of rotors with any number of blades, each harmonic written as 2."""
    reactionless = (coordinate.name for group in reactionless_groups(6) for coordinate in with_lag(group))
    lift = (coordinate.name for coordinate in lag_coordinates())
    inflow = (coordinate.name for coordinate in INFLOW)
    dofs = (*FIXED_COORDINATES[len(HUB) :], MAST_TWIST, *inflow, *lift, *reactionless)
    return frozenset(re.sub(r"\d+", "2", name) for name in (*dofs, *name_list(dofs)))
