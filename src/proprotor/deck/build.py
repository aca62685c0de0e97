"""Build a configuration from a deck: rotor, operation and support from numbers, with the source of every number."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np

from proprotor.control.control_loop import ControlLoop
from proprotor.datum import Datum
from proprotor.deck.alternatives import fields_instead_of
from proprotor.deck.build_aircraft import fuselage_of
from proprotor.deck.build_airfoil import airfoil_of
from proprotor.deck.build_control import law_warnings, loops_of, with_numbers
from proprotor.deck.build_support import build_support, fitted_stiffness_factors
from proprotor.deck.file import read_tables
from proprotor.deck.numbers import LEFT, left_numbers, numbers_of, own_numbers
from proprotor.errors import InputError
from proprotor.model.configuration import Configuration
from proprotor.model.mass_at_rest import mass_at_rest
from proprotor.model.rotor_share import rotor_share, settled, spring_warnings
from proprotor.model.side import Side
from proprotor.model.unit_doubts import unit_warnings
from proprotor.rotor.airfoil import Airfoil
from proprotor.rotor.atmosphere import standard_air
from proprotor.rotor.blade_frequencies import BladeFrequencies
from proprotor.rotor.drive_train import DriveTrain
from proprotor.rotor.operation import Operation
from proprotor.rotor.rotor import Rotor
from proprotor.support.normal_modes import NormalModes
from proprotor.typing import Array

if TYPE_CHECKING:
    from proprotor.deck.sections import Deck

C = TypeVar("C", bound=Configuration)
_FROM_FILES = ("matrices", "nastran", "universal")  # kinds of supports whose units no file tells


def load(
    name_or_path: str | os.PathLike[str], settings: Mapping[str, str] | None = None, *, kind: type[C]
) -> C:
    """Read a deck, set some of its fields, and build the configuration: see `proprotor.load_case`."""
    from proprotor.deck.validation import validate  # here, because pydantic is slow to import

    tables = read_tables(name_or_path)
    if settings:
        from proprotor.deck.settings import with_settings

        tables = with_settings(tables, settings)
    deck = validate(tables).with_origin(os.fspath(name_or_path), settings or {})
    return assemble(deck, numbers_of(deck), kind=kind)


def assemble(
    deck: Deck,
    numbers: Mapping[str, Datum],
    names: tuple[str, ...] = (),
    loops: Sequence[ControlLoop] | None = None,
    *,
    kind: type[C],
) -> C:
    """Build the configuration of a deck with given numbers.

    Parameters
    ----------
    deck : Deck
    numbers : mapping of str to Datum
        By path. Values may be arrays of many designs, or complex for derivatives by a complex step.
    names : tuple of str
        Names of the support's coordinates, in the order in which designs of a beam wing have these coordinates.
    loops : sequence of ControlLoop, optional
        Control loops in place of the deck's own.
    kind : type
        Class to build: `Configuration`, or a class that adds methods to `Configuration`.

    Raises
    ------
    InputError
        When a number is not physical, with the number as the deck has it.
    """
    rotor, operation, frequencies, train, derived = _machinery(deck, numbers)
    with _errors_as_written("support", numbers):
        at_rest = mass_at_rest(rotor)
        fitted = fitted_stiffness_factors(deck.support, numbers, at_rest)
        built = build_support(
            deck.support, dict(numbers) | fitted, names, mass_at_rest=at_rest, left=_left_structure(deck)
        )
        support = settled(built, at_rest)
        as_given = _with_rotor(support, numbers, at_rest) if fitted else support
        from_files = support if deck.support.kind in _FROM_FILES else None
        doubts = partial(_doubts, as_given, from_files, at_rest, rotor.gimbal_stiffness)
        if deck.support.kind == "aircraft":
            derived |= fuselage_of(deck.support, numbers)
    closed = [with_numbers(loop, numbers) for loop in (loops_of(deck) if loops is None else loops)]
    return kind(
        name=deck.case.name,
        title=deck.case.title,
        description=deck.case.description,
        calibration=deck.case.calibration,
        remarks=(*deck.case.warnings, *law_warnings(closed)),
        find_doubts=doubts,
        rotor=rotor,
        operation=operation,
        support=support,
        sources=dict(numbers) | derived | fitted | _how_held(support, numbers),
        frequencies=frequencies,
        drive_train=train,
        left=_left(deck, numbers),
        deck=deck,
        given=numbers,
        loops=tuple(closed),
    )


def _doubts(
    as_given: NormalModes, from_files: NormalModes | None, at_rest: Array, gimbal_stiffness: Any
) -> tuple[str, ...]:
    """Return warnings of a hub spring, and of the units of a support whose files do not tell them."""
    units = () if from_files is None else unit_warnings(from_files, at_rest)
    return spring_warnings(as_given, at_rest, gimbal_stiffness) + units


class _Machinery(NamedTuple):
    """What turns, and the numbers that follow from given ones."""

    rotor: Rotor
    operation: Operation
    frequencies: BladeFrequencies | None
    drive_train: DriveTrain | None
    derived: dict[str, Datum]


def _machinery(deck: Deck, numbers: Mapping[str, Datum]) -> _Machinery:
    """Return rotor, operation, blade frequencies and drive train of a deck."""
    with _errors_as_written("operation", numbers):
        operation, air = _operation(deck, numbers)
    with _errors_as_written("rotor.airfoil", numbers):
        airfoil = airfoil_of(_values(numbers, "rotor.airfoil"), deck.rotor.airfoil.table_name)
    with _errors_as_written("rotor", numbers):
        given = {"airfoil": airfoil, "propeller_moment": deck.rotor.propeller_moment}
        rotor, derived = _rotor(_values(numbers, "rotor") | given, operation.density)
    with _errors_as_written("rotor.frequencies", numbers):
        frequencies = _frequencies(deck, _values(numbers, "rotor.frequencies"))
    with _errors_as_written("drive_train", numbers):
        train = None if deck.drive_train is None else DriveTrain(**_values(numbers, "drive_train"))
    return _Machinery(rotor, operation, frequencies, train, air | derived)


def _left(deck: Deck, numbers: Mapping[str, Datum]) -> Side | None:
    """Return the left side of an aircraft, if more than the structure differs there."""
    if deck.left is None or deck.left_side is None:
        return None
    if deck.left.model_fields_set <= {"support"}:
        return None
    try:
        rotor, operation, frequencies, train, _ = _machinery(
            deck.left_side, left_numbers(deck.left_side, numbers)
        )
    except InputError as error:
        raise error.within("left") from None
    return Side(rotor, operation, frequencies, train)


def _left_structure(deck: Deck) -> Any:
    """Return the section [support] of the left side, if it differs."""
    if deck.left is None or deck.left.support is None or deck.left_side is None:
        return None
    return deck.left_side.support


def _with_rotor(support: NormalModes, numbers: Mapping[str, Datum], mass_at_rest: Array) -> NormalModes:
    """Return a wing whose stiffness was fitted to frequencies with the rotor, with the rotor in its mass."""
    held = numbers.get("support.rotor_held")
    if held is None:
        return support
    shaft = numbers["support.shaft"].si if "support.shaft" in numbers else "held"
    share = rotor_share(mass_at_rest, held.si, shaft)
    mass = support.mass + np.swapaxes(support.hub, -1, -2) @ share @ support.hub
    return replace(support, mass=mass, includes_rotor=held.si)


@contextmanager
def _errors_as_written(section: str, numbers: Mapping[str, Datum]) -> Iterator[None]:
    """Turn errors about an SI value into errors about the deck's field and the value as the deck has it."""
    try:
        yield
    except InputError as error:
        inner, _, name = error.field.removeprefix(f"{section}.").rpartition(".")
        of_left = inner.startswith(LEFT)
        places = (inner,) if of_left else (f"{section}.{inner}".rstrip("."), section)
        for place in dict.fromkeys(places):
            for written_as in (name, *fields_instead_of(name)):
                if number := numbers.get(f"{place}.{written_as}"):
                    raise InputError(f"{place}.{written_as}", number.written, error.rule) from None
        raise error if of_left else error.within(section) from None


def _values(numbers: Mapping[str, Datum], section: str) -> dict[str, Any]:
    """Return the SI values of a section's own numbers by field."""
    return {name: _value(number, numbers) for name, number in own_numbers(numbers, section).items()}


def _value(number: Datum, numbers: Mapping[str, Datum]) -> Any:
    """Return an SI value; a distribution as its stations in m, its values, and its word for the blade beyond."""
    if number.r_over_R is None:
        return number.si
    radius = np.asarray(numbers["rotor.radius"].si)
    beyond = () if number.beyond is None else (number.beyond,)
    return np.array(number.r_over_R) * radius[..., None], np.array(number.si), *beyond


def _operation(deck: Deck, numbers: Mapping[str, Datum]) -> tuple[Operation, dict[str, Datum]]:
    """Return the operation, and the properties of the air that follow from the altitude."""
    given, air = _values(numbers, "operation"), {}
    if "altitude" in given:
        found = standard_air(given.pop("altitude"), given.pop("temperature_offset", 0.0))
        source = "altitude, temperature_offset: standard atmosphere"
        air = {
            "density": Datum("p / R T", found.density, "kg/m**3", "derived", source),
            "speed_of_sound": Datum("√(γ R T)", found.speed_of_sound, "m/s", "derived", source),
        }
        given |= {name: number.si for name, number in air.items()}
    trim = deck.operation.trim
    operation = Operation(**given, trim=trim if isinstance(trim, str) else _values(numbers, "operation.trim"))
    return operation, {f"operation.{name}": number for name, number in air.items()}


def _rotor(given: dict[str, Any], density: float) -> tuple[Rotor, dict[str, Datum]]:
    """Return the rotor, and the numbers that follow from the given ones."""
    omega = {name: given.pop(f"{name}_frequency") for name in ("flap", "lag") if f"{name}_frequency" in given}
    lock_number = given.pop("lock_number", None)
    build: Callable[..., Rotor] = Rotor
    if "mass_distribution" in given:
        beside = {name: given.pop(name, None) for name in ("hub_mass", "mass_offset")}
        build = partial(Rotor.from_mass_distribution, *given.pop("mass_distribution"), **beside)
    # Springs and chord may follow from inertias that only a rotor has, so this rotor has placeholders.
    bare = build(**{"flap_stiffness": 0.0, "lag_stiffness": 0.0, "chord": 1.0} | given)
    derived = {f"{name}_stiffness": _spring(bare, name, frequency) for name, frequency in omega.items()}
    if lock_number is not None:
        derived["chord"] = _chord(bare, lock_number, density)
    rotor = replace(bare, **{name: number.si for name, number in derived.items()})
    return rotor, {f"rotor.{name}": number for name, number in derived.items()}


def _spring(rotor: Rotor, hinge: str, frequency: float) -> Datum:
    """Return the stiffness of a hinge from its frequency without rotation."""
    stiffness = getattr(rotor, f"{hinge}_inertia") * frequency**2
    source = f"{hinge}_inertia, {hinge}_frequency (non-rotating)"
    return Datum("I ω²", stiffness, "N*m/rad", "derived", source)


def _chord(rotor: Rotor, lock_number: float, density: float) -> Datum:
    """Return the chord from the Lock number."""
    if np.any(np.asarray(density) == 0):
        raise InputError("lock_number", lock_number, "needs a density above zero; give chord instead")
    if not isinstance(rotor.airfoil, Airfoil):
        raise InputError(
            "lock_number", lock_number, "needs one lift_slope; with airfoil tables or regions give chord"
        )
    chord = lock_number * rotor.blade_inertia / (density * rotor.airfoil.lift_slope * rotor.radius**4)
    source = "lock_number, density, lift_slope, blade_inertia"
    return Datum("γ I_b / (ρ c_lα R⁴)", chord, "m", "derived", source)


def _frequencies(deck: Deck, given: dict[str, Any]) -> BladeFrequencies | None:
    section = deck.rotor.frequencies
    if section is None:
        return None
    return BladeFrequencies(against=section.against, pitch_coupling=section.pitch_coupling, **given)


def _how_held(support: NormalModes, numbers: Mapping[str, Datum]) -> dict[str, Datum]:
    """Return how the rotor was held while the modes were found, where the deck leaves this to the program."""
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
