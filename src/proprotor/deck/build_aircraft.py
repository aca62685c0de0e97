"""Build the airframe of a whole aircraft from a deck, for one design or a batch of designs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import fields, replace
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from proprotor.datum import Datum
from proprotor.deck.each_design import at_each_point, different_designs, si_values
from proprotor.deck.numbers import LEFT
from proprotor.errors import InputError
from proprotor.support.aircraft_airloads import AircraftMotion, Tail, aircraft_motion, with_airloads
from proprotor.support.aircraft_structure import CarryThrough, Fuselage, WingSide, half_aircraft
from proprotor.support.airframe import Airframe
from proprotor.support.beam_wing import Pylon, Wing
from proprotor.support.free_airframe import KINDS, free_airframe
from proprotor.support.wing_aerodynamics import Strips, WingAerodynamics
from proprotor.typing import Array, Numbers

if TYPE_CHECKING:
    from proprotor.deck.support_sections import AircraftSection

_STRUCTURE = ("", "fuselage.", "carry_through.")  # sections of [support] with numbers of the structure
_R = TypeVar("_R")
_Numbers = dict[str, Any]


def build_aircraft(
    section: AircraftSection,
    numbers: Mapping[str, Datum],
    names: tuple[str, ...] = (),
    left: AircraftSection | None = None,
) -> Airframe:
    """Return the airframe of the section [support] of kind "aircraft".

    Parameters
    ----------
    section : AircraftSection
    numbers : mapping of str to Datum
        The deck's numbers by path, perhaps arrays of many designs, or complex.
    names : tuple of str
        The order of the coordinates of many designs, by default the order of the first design.
    left : AircraftSection, optional
        The section of the left side, where it differs.

    Raises
    ------
    InputError
        When a number is not physical.
    """
    given = _of_structure(numbers)
    elements = (
        given.get("elements", Wing.elements),
        given.get("carry_through.elements", CarryThrough.elements),
    )
    nodes = (sum(elements) + 1) * (1 if left is None else 2)
    designs, place = different_designs(given, nodes)
    parts = [_aircraft(part, section, left, names, batch=place.ndim > 0) for part in designs]
    airframe, (refusal, fuselage, *strips) = at_each_point(parts, place, own=(0, 2, *(1, 2, 2) * 2))
    airframe = replace(airframe, refusal=refusal if np.any(refusal != "") else None)
    motion = AircraftMotion(fuselage, Strips(*strips[:3]), Strips(*strips[3:]))
    return _loaded(airframe, motion, section, numbers, given)


def fuselage_of(section: AircraftSection, numbers: Mapping[str, Datum]) -> dict[str, Datum]:
    """Return the numbers of the fuselage that follow from those of the whole aircraft, by path.

    Many designs, and a deck that has the fuselage itself, have none.
    """
    given = _of_structure(numbers)
    if not section.fuselage.whole_aircraft or any(isinstance(value, np.ndarray) for value in given.values()):
        return {}
    found, _ = _fuselage(given, section, _side(given, section), batch=False)
    units = {"mass": "kg", "centre_forward": "m", "centre_up": "m"}
    source = "the whole aircraft less wings, nacelles and rotors (point masses of hub and blades)"
    return {
        f"support.fuselage.{entry.name} (fuselage alone)": Datum(
            "less wings, nacelles, rotors",
            np.asarray(getattr(found, entry.name))[()],
            units.get(entry.name, "kg*m**2"),
            "derived",
            source,
        )
        for entry in fields(found)
    }


def _of_structure(numbers: Mapping[str, Datum]) -> _Numbers:
    """Return the numbers of the structure by their path below [support], those of the left side with "left." before."""
    return {
        f"{side}{inner}{name}": value
        for side in ("", LEFT)
        for inner in _STRUCTURE
        for name, value in si_values(numbers, f"{side}support.{inner}".rstrip(".")).items()
    }


def _aircraft(
    given: _Numbers,
    section: AircraftSection,
    left: AircraftSection | None,
    names: tuple[str, ...],
    *,
    batch: bool,
) -> tuple[Airframe, tuple[Array, ...]]:
    """Return the airframes of designs (designs,), their refusals, and the motion of what the air loads."""
    right = _side(given, section)
    other = None
    if left is not None:
        own = {name.removeprefix(LEFT): value for name, value in given.items() if name.startswith(LEFT)}
        with _errors_within(f"{LEFT}support"):
            other = _side(given | own, left)
    fuselage, refusal = _fuselage(given, section, right, batch=batch)
    free = free_airframe(
        fuselage,
        right,
        other,
        modes=given["modes"],
        symmetry=section.symmetry,
        damping_ratio=_damping_ratios(given),
        rotor_mass=given["rotor_mass"],
        names=names if batch else (),
    )
    motion = aircraft_motion(free)
    return free.airframe, (refusal, motion.fuselage, *motion.right, *motion.left)


def _side(given: _Numbers, section: AircraftSection) -> WingSide:
    """Return one side of an aircraft."""
    state = "on" if section.downstop else "off"
    pylon = replace(
        _record(Pylon, given),
        pitch_stiffness=given.get(f"downstop_stiffness_{state}"),
        yaw_stiffness=given.get(f"spindle_yaw_stiffness_{state}"),
    )
    return WingSide(_record(CarryThrough, given, "carry_through."), _record(Wing, given), pylon)


def _record(kind: type[_R], given: _Numbers, section: str = "") -> _R:
    """Return a record of the numbers that a deck gives for its fields."""
    names = [entry.name for entry in fields(kind) if section + entry.name in given]  # type: ignore[arg-type]
    with _errors_within(section.rstrip(".")):
        return kind(**{name: given[section + name] for name in names})


@contextmanager
def _errors_within(section: str) -> Iterator[None]:
    """Put the name of a section before the field of an error."""
    try:
        yield
    except InputError as error:
        raise error.within(section) from None


def _fuselage(
    given: _Numbers, section: AircraftSection, side: WingSide, *, batch: bool
) -> tuple[Fuselage, Array]:
    """Return the fuselage as the deck has it, or as what wings, nacelles and rotors leave of it, and refusals (...).

    The numbers of the whole aircraft are those of an aircraft whose left side is as the right side. A design of a batch
    of which too little is left has the whole aircraft as its fuselage, and a refusal, so that its points fail alone.
    """
    body = _record(Fuselage, given, "fuselage.")
    if not section.fuselage.whole_aircraft:
        return body, np.array("")
    rest = half_aircraft(side).rigid_mass(given["rotor_mass"])
    errors = body.lacking(rest) if batch else np.array(None)
    texts = ["" if error is None else str(error.within("support.fuselage")) for error in errors.flat]
    refusal = np.array(texts, dtype=object).reshape(errors.shape)
    with _errors_within("fuselage"):
        return body.without(np.where((refusal != "")[..., None, None], 0.0, rest)), refusal


def _damping_ratios(given: _Numbers) -> dict[str, Numbers]:
    """Return the damping ratio of each kind of mode."""
    every: Numbers = given["damping_ratio"] if "damping_ratio" in given else given["loss_factor"] / 2
    fields_of = {kind: f"{kind.replace(' ', '_')}_damping_ratio" for kind in KINDS}
    return {kind: given.get(field, every) for kind, field in fields_of.items()}


def _loaded(
    airframe: Any,
    motion: AircraftMotion,
    section: AircraftSection,
    numbers: Mapping[str, Datum],
    given: _Numbers,
) -> Airframe:
    """Return the airframe with the airloads that the deck asks for."""
    values = partial(si_values, numbers)
    wing = None
    if section.wing_aerodynamics is not None:
        if (flap := section.wing_aerodynamics.flap_chord) is not None:
            rule = "goes with a wing that carries one rotor: an aircraft has no flaperon"
            raise InputError("wing_aerodynamics.flap_chord", flap.written, rule)
        wing = WingAerodynamics(**values("support.wing_aerodynamics"), sweep=given.get("sweep", 0.0))
    tails = {
        name: Tail(**values(f"support.{name}"))
        for name in ("horizontal_tail", "vertical_tail")
        if getattr(section, name) is not None
    }
    return with_airloads(airframe, motion, wing=wing, **tails)
