"""A number with its provenance: the text in the deck, the SI value, the unit, the status and the source.

Every number of a deck becomes a `Datum`, which results and reports show. `deck_unit` says in which unit the
number was written.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from proprotor.errors import InputError
from proprotor.units import factor_to_si

STATUSES = ("published", "measured", "derived", "recalled", "calibrated", "assumed")
UNSTATED = "unstated"  # the status of a number whose deck does not say
PER_REV = "1/rev"
_NUMBER = re.compile(r"\s*[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?\s*")


@dataclass(frozen=True)
class Datum:
    """A number, a distribution along the blade or a file of numbers, with provenance.

    Attributes
    ----------
    written : str
        The value as the deck gives it.
    si : float, int, array, tuple of float or str
        The value in `unit`: a number, an array of the numbers of many designs, a tuple for a distribution, a `FilePath`
        for a file, or the word of a choice.
    unit : str
        SI unit, ``""`` for a plain number.
    status : str
        published, measured, derived, recalled, calibrated or assumed; ``"unstated"`` when the deck does not say.
    source : str
        Where the number was read, or how it was found.
    r_over_R : tuple of float or None
        Stations of a distribution.
    rotor_speed : float or None
        One per revolution in rad/s, for a frequency of a deck.
    beyond : str or None
        The blade beyond the stations of a distribution: "held", "nothing", or None when the deck does not say.
    form : str
        What else the number may be written as: "tangent", the angle of which it is the tangent; "frequency", a
        frequency per revolution; "" for nothing else.
    """

    written: str
    si: Any
    unit: str
    status: str = UNSTATED
    source: str = ""
    r_over_R: tuple[float, ...] | None = None
    rotor_speed: float | None = None
    beyond: str | None = None
    form: str = ""


def deck_unit(number: Datum) -> tuple[str, float]:
    """Return the unit in which a number was written, and how many SI units one such unit is.

    A unit "/rev" is as many rad/s as the rotor speed in the deck of that number.
    """
    match = _NUMBER.match(number.written)
    unit = number.written[match.end() :].strip() if match else ""
    if unit == "/rev" and number.rotor_speed is not None:
        return "/rev", number.rotor_speed
    if not unit:
        return number.unit, 1.0
    try:
        return unit, factor_to_si(number.written, unit, number.unit)
    except InputError:  # an angle whose tangent is the number
        return number.unit, 1.0
