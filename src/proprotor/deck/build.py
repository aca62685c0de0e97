"""Build a configuration from a deck: rotor, operation and support from numbers, with the source of every number."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from proprotor.datum import PER_REV, Datum
from proprotor.deck.file import ALTERNATIVES, read_tables
from proprotor.deck.support_of_deck import support_of
from proprotor.errors import InputError
from proprotor.model.configuration import Configuration
from proprotor.model.mass_at_rest import mass_at_rest
from proprotor.model.rotor_share import settled, spring_warnings
from proprotor.rotor.airfoil import Airfoil, SectionModel
from proprotor.rotor.airfoil_table import AirfoilTable
from proprotor.rotor.atmosphere import standard_air
from proprotor.rotor.blade_frequencies import BladeFrequencies
from proprotor.rotor.drive_train import DriveTrain
from proprotor.rotor.operation import Operation
from proprotor.rotor.rotor import Rotor
from proprotor.support.normal_modes import NormalModes

if TYPE_CHECKING:
    from proprotor.deck.fields import Section
    from proprotor.deck.sections import Deck

C = TypeVar("C", bound=Configuration)


def load(
    name_or_path: str | os.PathLike[str], settings: Mapping[str, str] | None = None, *, kind: type[C]
) -> C:
    """Read a deck and build what it describes: see `proprotor.load_case`."""
    from proprotor.deck.sections import validate  # here, because pydantic is slow to import

    tables = read_tables(name_or_path)
    if settings:
        from proprotor.deck.settings import with_settings

        tables = with_settings(tables, settings)
    deck = validate(tables)
    speed = deck.operation.rotor_speed.si
    return assemble(deck, {path: _per_second(n, speed) for path, n in _numbers(deck)}, kind=kind)


def assemble(deck: Deck, numbers: Mapping[str, Datum], names: tuple[str, ...] = (), *, kind: type[C]) -> C:
    """Build what a deck describes with given numbers.

    Parameters
    ----------
    deck : Deck
    numbers : mapping of str to Datum
        By path. Values may be arrays of many designs, or complex for derivatives by a complex step.
    names : tuple of str
        Names of the support's coordinates, in the order in which designs of a beam wing have these coordinates.
    kind : type
        What to build: `Configuration`, or a class that adds methods to `Configuration`.

    Raises
    ------
    InputError
        When a number is not physical, as the deck has it.
    """
    with _told_as_written("operation", numbers):
        trim = deck.operation.trim
        given, air = _with_air(_values(numbers, "operation"))
        operation = Operation(
            **given,
            trim=trim if isinstance(trim, str) else _values(numbers, "operation.trim"),
        )
    with _told_as_written("rotor.airfoil", numbers):
        airfoil = _airfoil(_values(numbers, "rotor.airfoil"))
    with _told_as_written("rotor", numbers):
        given = {"airfoil": airfoil, "propeller_moment": deck.rotor.propeller_moment}
        rotor, derived = _rotor(_values(numbers, "rotor") | given, operation.density)
    with _told_as_written("rotor.frequencies", numbers):
        frequencies = _frequencies(deck, _values(numbers, "rotor.frequencies"))
    with _told_as_written("drive_train", numbers):
        train = None if deck.drive_train is None else DriveTrain(**_values(numbers, "drive_train"))
    with _told_as_written("support", numbers):
        at_rest = mass_at_rest(rotor)
        support = settled(support_of(deck.support, numbers, names), at_rest)
        doubts = spring_warnings(support, at_rest, rotor.gimbal_stiffness)
    return kind(
        name=deck.case.name,
        title=deck.case.title,
        description=deck.case.description,
        calibration=deck.case.calibration,
        warnings=(*deck.case.warnings, *doubts),
        rotor=rotor,
        operation=operation,
        support=support,
        sources=dict(numbers) | air | derived | _how_held(support, numbers),
        frequencies=frequencies,
        drive_train=train,
        deck=deck,
        given=numbers,
    )


def _numbers(section: Section, path: str = "") -> Iterator[tuple[str, Datum]]:
    """Every number of a section and those within it, by its path."""
    for name in type(section).model_fields:
        entry, here = getattr(section, name), f"{path}.{name}" if path else name
        if isinstance(entry, Datum):
            yield here, entry
        elif name == "modes" and entry is not None:
            for mode in entry:
                yield from _numbers(mode, f"{here}[{mode.name}]")
        elif hasattr(type(entry), "model_fields"):
            yield from _numbers(entry, here)


def _per_second(number: Datum, rotor_speed: float) -> Datum:
    """A frequency per revolution in rad/s: n cycles per revolution are n Ω, with Ω of the file it was written in."""
    if number.unit != PER_REV:
        return number
    own = rotor_speed if number.rotor_speed is None else number.rotor_speed
    return replace(number, si=number.si * own, unit="rad/s", rotor_speed=own)


def _values(numbers: Mapping[str, Datum], section: str) -> dict[str, Any]:
    """The SI values of a section's own numbers by field; a distribution as (r in m, values) and what lies beyond."""
    own = {
        path.removeprefix(f"{section}."): n for path, n in numbers.items() if path.startswith(f"{section}.")
    }
    return {name: _value(n, numbers) for name, n in own.items() if "." not in name}


def _value(number: Datum, numbers: Mapping[str, Datum]) -> Any:
    if number.r_over_R is None:
        return number.si
    radius = np.asarray(numbers["rotor.radius"].si)
    beyond = () if number.beyond is None else (number.beyond,)
    return np.array(number.r_over_R) * radius[..., None], np.array(number.si), *beyond


def _with_air(given: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Datum]]:
    """What an operation is given, and the air that follows from its altitude."""
    if "altitude" not in given:
        return given, {}
    found = standard_air(given.pop("altitude"), given.pop("temperature_offset", 0.0))
    source = "altitude, temperature_offset: standard atmosphere"
    air = {
        "density": Datum("p / R T", found.density, "kg/m**3", "derived", source),
        "speed_of_sound": Datum("√(γ R T)", found.speed_of_sound, "m/s", "derived", source),
    }
    given |= {name: number.si for name, number in air.items()}
    return given, {f"operation.{name}": number for name, number in air.items()}


def _airfoil(given: dict[str, Any]) -> SectionModel:
    return AirfoilTable.from_c81(given["table"]) if "table" in given else Airfoil(**given)


def _frequencies(deck: Deck, given: dict[str, Any]) -> BladeFrequencies | None:
    section = deck.rotor.frequencies
    return None if section is None else BladeFrequencies(against=section.against, **given)


def _rotor(given: dict[str, Any], density: float) -> tuple[Rotor, dict[str, Datum]]:
    """The rotor, and the numbers that follow from those given."""
    omega = {name: given.pop(f"{name}_frequency") for name in ("flap", "lag") if f"{name}_frequency" in given}
    lock_number = given.pop("lock_number", None)
    build: Callable[..., Rotor] = Rotor
    if "mass_distribution" in given:
        build = partial(
            Rotor.from_mass_distribution,
            *given.pop("mass_distribution"),
            hub_mass=given.pop("hub_mass", None),
        )
    # Springs and chord may follow from inertias that only the rotor knows: hence the stand-ins.
    bare = build(**{"flap_stiffness": 0.0, "lag_stiffness": 0.0, "chord": 1.0} | given)
    derived = {f"{name}_stiffness": _spring(bare, name, frequency) for name, frequency in omega.items()}
    if lock_number is not None:
        derived["chord"] = _chord(bare, lock_number, density)
    rotor = replace(bare, **{name: number.si for name, number in derived.items()})
    return rotor, {f"rotor.{name}": number for name, number in derived.items()}


def _how_held(support: NormalModes, numbers: Mapping[str, Datum]) -> dict[str, Datum]:
    """Return how the rotor was held while the modes were found, where the deck leaves that to the program."""
    taken = {}
    given = numbers.get("support.includes_rotor")
    if given is not None and given.si is True:
        source = (
            f"{given.source}; " * bool(given.source) + 'true: taken as "gimballed", for there is a gimbal'
        )
        taken["support.includes_rotor"] = replace(given, si=support.includes_rotor, source=source)
    if support.includes_rotor in ("gimballed", "rigid") and "support.shaft" not in numbers:
        taken["support.shaft"] = Datum("held", "held", "", source="left out")
    return taken


def _spring(rotor: Rotor, hinge: str, frequency: float) -> Datum:
    stiffness = getattr(rotor, f"{hinge}_inertia") * frequency**2
    return Datum(
        "I ω²", stiffness, "N*m/rad", "derived", f"{hinge}_inertia, {hinge}_frequency (non-rotating)"
    )


def _chord(rotor: Rotor, lock_number: float, density: float) -> Datum:
    if np.any(np.asarray(density) == 0):
        raise InputError("lock_number", lock_number, "needs a density above zero; give chord instead")
    if not isinstance(rotor.airfoil, Airfoil):
        raise InputError("lock_number", lock_number, "needs a lift_slope; with an airfoil table give chord")
    chord = lock_number * rotor.blade_inertia / (density * rotor.airfoil.lift_slope * rotor.radius**4)
    return Datum(
        "γ I_b / (ρ c_lα R⁴)", chord, "m", "derived", "lock_number, density, lift_slope, blade_inertia"
    )


@contextmanager
def _told_as_written(section: str, numbers: Mapping[str, Datum]) -> Iterator[None]:
    """Errors about an SI value told with the deck's field, and the value as the deck has it."""
    try:
        yield
    except InputError as error:
        name = error.field.rpartition(".")[2]
        for written_as in (name, *_instead_of(name)):
            if number := numbers.get(f"{section}.{written_as}"):
                raise InputError(f"{section}.{written_as}", number.written, error.rule) from None
        raise error.within(section) from None


def _instead_of(name: str) -> tuple[str, ...]:
    """The fields that may be given in place of one."""
    return tuple(other for left, right in ALTERNATIVES if name in left for other in right)
