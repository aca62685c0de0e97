"""Build the control loops of a deck, and give loops other numbers by their paths."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from proprotor.control.control_loop import NUMBERS, ControlLoop
from proprotor.datum import Datum
from proprotor.errors import InputError, check_known

if TYPE_CHECKING:
    from proprotor.deck.control_sections import ControlLoopSection
    from proprotor.deck.sections import Deck

_FURTHER = ("weights", "scheduled_at", "scheduled_gains")
_MATRICES = ("A", "B", "C", "D")
IN_PYTHON = "given in Python"


def _path_of(loop: str, field: str = "") -> str:
    """Return the path of a loop, or of one of its numbers: ``control.loops[damper].gain``."""
    return ".".join(filter(None, (f"control.loops[{loop}]", field)))


def loops_of(deck: Deck) -> tuple[ControlLoop, ...]:
    """Return the control loops of a deck.

    Raises
    ------
    InputError
        For a loop that cannot be, with its field as the deck has it.
    """
    if deck.control is None:
        return ()
    names = [section.name for section in deck.control.loops]
    for place, name in enumerate(names):
        if name in names[:place]:
            raise InputError(_path_of(name, "name"), name, "must not be the name of two loops")
    return tuple(map(_loop, deck.control.loops))


def _loop(section: ControlLoopSection) -> ControlLoop:
    """Return one loop of a deck."""
    given: dict[str, Any] = {
        name: number.si for name in (*NUMBERS, *_FURTHER) if (number := getattr(section, name)) is not None
    }
    if section.delay_order is not None:
        given["delay_order"] = section.delay_order.si
    try:
        return ControlLoop(
            name=section.name, sensors=section.sensors, inputs=section.inputs, law=_law(section), **given
        )
    except InputError as error:
        number = getattr(section, error.field, None)
        value = number.written if isinstance(number, Datum) else error.value
        raise InputError(_path_of(section.name, error.field), value, error.rule) from None


def _law(section: ControlLoopSection) -> Any:
    """Return the law of a loop as `ControlLaw.of` takes it; None for a gain alone."""
    if section.numerator is not None and section.denominator is not None:
        return section.numerator.si, section.denominator.si
    if section.state_space is None:
        return None
    for name in section.state_space:
        check_known("state_space", name, _MATRICES, "matrix")
    for name in _MATRICES:
        if name not in section.state_space:
            raise InputError(f"state_space.{name}", None, "is missing")
    return tuple(section.state_space[name] for name in _MATRICES)


def numbers_of_loops(loops: Iterable[ControlLoop]) -> dict[str, Datum]:
    """Return the numbers of loops that were given in Python, by path, as numbers that may vary."""
    return {
        _path_of(loop.name, field): Datum(f"{value:g} {unit}".strip(), value, unit, "assumed", IN_PYTHON)
        for loop in loops
        for field, unit, value in _plain_numbers(loop)
    }


def _plain_numbers(loop: ControlLoop) -> Iterator[tuple[str, str, float]]:
    """Yield the field, the unit and the value of each number of a loop that is one real number."""
    for field, unit in NUMBERS.items():
        value = getattr(loop, field)
        if value is not None and np.ndim(value) == 0 and not np.iscomplexobj(value):
            yield field, unit, float(value)


def with_numbers(loop: ControlLoop, numbers: Mapping[str, Datum]) -> ControlLoop:
    """Return a loop with the numbers that stand at its paths, perhaps arrays of many designs.

    Raises
    ------
    InputError
        For a number that is not physical, with its path.
    """
    given: dict[str, Any] = {
        field: number.si
        for field in NUMBERS
        if (number := numbers.get(_path_of(loop.name, field))) is not None
    }
    try:
        return replace(loop, **given)
    except InputError as error:
        raise InputError(_path_of(loop.name, error.field), error.value, error.rule) from None


def law_warnings(loops: Iterable[ControlLoop]) -> tuple[str, ...]:
    """Return a sentence for each loop whose law is unstable by itself."""
    found = []
    for loop in loops:
        poles = loop.law.poles
        growing = poles[poles.real > 1e-9 * np.abs(poles)]
        if len(growing):
            worst = growing[growing.real.argmax()]
            found.append(
                f"Control loop {loop.name}: its law is unstable by itself, with a pole at {worst.real:.3g} "
                f"± {abs(worst.imag):.3g}i rad/s; nothing holds it where the loop is cut."
            )
    return tuple(found)
