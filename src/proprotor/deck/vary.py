"""Build other designs of a case by other values for numbers of its deck, one design or many at once."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from proprotor.control.control_loop import ControlLoop
from proprotor.datum import Datum
from proprotor.deck.build import C, assemble
from proprotor.deck.build_control import IN_PYTHON, law_warnings, numbers_of_loops
from proprotor.deck.input_values import input_values
from proprotor.deck.left_out import number_left_out
from proprotor.deck.numbers import numbers_of
from proprotor.errors import InputError, unknown_name
from proprotor.model.configuration import Configuration
from proprotor.units import has_own_unit

_FIXED = (str, int, tuple)  # files, whole numbers and lists, which have no range
_BY_REGION = "rotor.airfoil."  # in the paths of lists with a number for each region of the span
_ENTRY = re.compile(r"(.+)\[(\d+)\]")


def design_inputs(case: Configuration) -> dict[str, Datum]:
    """Return the numbers of a case's deck that may vary, by path, with value, SI unit, status and source.

    A path is the place in the deck: ``rotor.precone``, ``rotor.airfoil.lift_slope``, ``operation.rotor_speed``,
    ``drive_train.shaft_stiffness``, ``support.modes[beam].frequency``. A list with a number for each region of the
    span has the paths of its entries from the root outward, ``rotor.airfoil.lift_slope[1]``. Distributions along the
    blade, blade frequencies, files, numbers that follow from other numbers, and the envelope's are left out.

    Parameters
    ----------
    case : Case
        A case built from a deck.

    Returns
    -------
    dict of str to Datum

    Raises
    ------
    InputError
        When the case was not built from a deck.
    """
    if case.deck is None:
        raise InputError("case", case.name, "must be made from a deck, whose numbers may then vary")
    return {
        path: number
        for whole, given in case.given.items()
        for path, number in _entries(whole, given)
        if number.r_over_R is None
        and not isinstance(number.si, _FIXED)
        and not path.startswith(("rotor.frequencies.", "envelope."))
    }


def _entries(path: str, number: Datum) -> Iterator[tuple[str, Datum]]:
    """Yield a number with its path, or each entry of a list by region with the path of the entry."""
    if not isinstance(number.si, tuple) or _BY_REGION not in path:
        yield path, number
        return
    for place, value in enumerate(number.si, start=1):
        written = value if isinstance(value, str) else _written(np.asarray(value), number.unit)
        yield f"{path}[{place}]", replace(number, written=written, si=value)


def list_of(path: str) -> str:
    """Return the path of the list by region of which a path is an entry; "" for any other path."""
    entry = _ENTRY.fullmatch(path)
    return "" if entry is None else entry[1]


def _written(number: Any, unit: str) -> str:
    """Return a number as a deck has it, or how many there are."""
    if np.isrealobj(number) and not number.ndim:
        return f"{number:g} {unit}".strip()
    return f"{number.size} values"


def check_input(path: str, known: Collection[str]) -> None:
    """Refuse a path that is not among the paths of the inputs, `known`.

    Raises
    ------
    InputError
        With the nearest known path or, without a near path, all paths.
    """
    if path not in known:
        raise InputError(path, None, unknown_name(path, known, "input"))


def inputs_at(case: Configuration, paths: Iterable[str]) -> dict[str, Datum]:
    """Return the numbers of a case at some paths, those that its deck leaves out at their defaults.

    Parameters
    ----------
    case : Case
        A case built from a deck.
    paths : iterable of str
        See `design_inputs`; also fields that the deck leaves out and that have a number as default, such as
        ``rotor.kinematic_pitch_flap_coupling``.

    Returns
    -------
    dict of str to Datum
        In the order of the paths.

    Raises
    ------
    InputError
        For an unknown path, with the nearest known one; for a field that cannot vary, with what the deck must give
        first; and when the case was not built from a deck.
    """
    known = design_inputs(case)
    return {path: known[path] if path in known else number_left_out(case.deck, path, known) for path in paths}


def vary(case: C, values: Mapping[str, Any]) -> C:
    """Return the case with other values for some numbers of its deck.

    Numbers that follow from a changed number change too: a spring from a frequency and an inertia, the chord from the
    Lock number. A frequency per revolution was converted to rad/s at the rotor speed of its deck, and keeps this value
    when the rotor speed varies, by `vary` as by a setting or a variant of the deck.

    Parameters
    ----------
    case : Case
    values : mapping of str to float, array, text, pint quantity or xarray.DataArray
        By path, see `inputs_at`: numbers in SI; text such as "1.5 deg", quantities, and data arrays with an
        attribute ``units`` are converted, an angle to its tangent where a deck takes both. Arrays broadcast with each
        other and with the airspeeds of `Case.linearize`. Complex numbers are allowed, for derivatives by a complex
        step.

    Returns
    -------
    Case
        A case whose rotor, operation and support have arrays for numbers given as arrays.

    Raises
    ------
    InputError
        For an unknown path, with the nearest known one, or a value that is not physical.
    """
    known, numbers = inputs_at(case, values), dict(case.given)
    for path, value in values.items():
        number = _number(path, value, known[path])
        varied = replace(known[path], written=_written(number, known[path].unit), si=number[()])
        if (entry := _ENTRY.fullmatch(path)) is None:
            numbers[path] = varied
        else:
            numbers[entry[1]] = _with_entry(numbers[entry[1]], int(entry[2]), varied)
    return assemble(case.deck, numbers, tuple(case.support.names), case.loops, kind=type(case))


def _with_entry(whole: Datum, place: int, varied: Datum) -> Datum:
    """Return a list by region with another number at one of its places, counted from 1."""
    values = (*whole.si[: place - 1], varied.si, *whole.si[place:])
    return replace(whole, written=f"{whole.written}; [{place}] {varied.written}", si=values)


def varied_numbers(case: Configuration) -> dict[str, Any]:
    """Return the SI values, by path, of the numbers in which a case differs from the deck that it was made from.

    `vary` of the case of the deck, with these numbers, gives the case again.

    Parameters
    ----------
    case : Case
        A case built from a deck.
    """
    own = {
        path: number.si
        for whole, given in numbers_of(case.deck).items()
        for path, number in _entries(whole, given)
    }
    return {
        path: number.si
        for whole, given in case.given.items()
        for path, number in _entries(whole, given)
        if path not in own or not _same(number.si, own[path])
    }


def _same(one: Any, other: Any) -> bool:
    return type(one) is type(other) and np.shape(one) == np.shape(other) and bool(np.all(one == other))


def _number(path: str, value: Any, known: Datum) -> np.ndarray:
    """Return the SI value of a number as an array, of floats or complex numbers."""
    if has_own_unit(value):
        value = input_values(path, value, known)
    number = np.asarray(value)
    if number.dtype.kind not in "fciu":
        raise InputError(path, value, "must be a number or an array of numbers")
    if not np.isfinite(number).all():
        raise InputError(path, value, "must be finite")
    return number if number.dtype.kind == "c" else number.astype(float)


def with_control(case: C, *loops: ControlLoop) -> C:
    """Return the case with control loops closed, in place of those that it has; without loops, with none closed.

    Parameters
    ----------
    case : Case
    *loops : ControlLoop
        Their numbers may vary like those of the deck: ``control.loops[damper].gain``.

    Returns
    -------
    Case

    Raises
    ------
    InputError
        For something that is no control loop, and two loops of one name. Sensors and inputs are compared with those of
        the model once it is made.
    """
    names: list[str] = []
    for loop in loops:
        if not isinstance(loop, ControlLoop):
            raise InputError("loops", type(loop).__name__, "must be a ControlLoop")
        if loop.name in names:
            raise InputError("loops", loop.name, "must not be the name of two loops")
        names.append(loop.name)
    own, old = numbers_of_loops(loops), law_warnings(case.loops)
    given, sources = (
        {path: number for path, number in numbers.items() if not path.startswith("control.")} | own
        for numbers in (case.given, case.sources)
    )
    remarks = (*(text for text in case.remarks if text not in old), *law_warnings(loops))
    return replace(case, loops=loops, given=given, sources=sources, remarks=remarks)


def added_loops(case: Configuration) -> bool:
    """Return whether the control loops of a case are others than those of its deck, so that the deck does not tell."""
    own = {} if case.deck.control is None else {one.name: one for one in case.deck.control.loops}
    given = {loop.name for loop in case.loops}
    return own.keys() != given or any(
        number.source == IN_PYTHON for path, number in case.given.items() if path.startswith("control.")
    )
