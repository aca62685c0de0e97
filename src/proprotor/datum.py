"""One number of a deck: what was written, its SI value, and where it comes from."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from proprotor.units import factor_to_si

STATUSES = ("published", "derived", "recalled", "calibrated", "assumed")
PER_REV = "1/rev"
_NUMBER = re.compile(r"\s*[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?\s*")


@dataclass(frozen=True)
class Datum:
    """A number, a distribution along the blade or a file of numbers, with its provenance.

    Attributes
    ----------
    written : str
        The value as the deck gives it.
    si : float, int, array, tuple of float or str
        The value in `unit`; an array of those of many designs, a tuple for a distribution, a `FilePath` for a file, the
        word for a choice.
    unit : str
        SI unit, ``""`` for a plain number.
    status : str
        published, derived, recalled, calibrated or assumed; ``"unstated"`` when the deck does not say.
    source : str
        Where the number was read, or how it was found.
    r_over_R : tuple of float or None
        Stations of a distribution.
    rotor_speed : float or None
        rad/s, of a frequency written per revolution: what one per revolution is.
    beyond : str or None
        What a distribution says of the blade beyond its stations: "held" or "nothing"; None where it says nothing.
    """

    written: str
    si: Any
    unit: str
    status: str = "unstated"
    source: str = ""
    r_over_R: tuple[float, ...] | None = None
    rotor_speed: float | None = None
    beyond: str | None = None


def deck_unit(number: Datum) -> tuple[str, float]:
    """The unit a number is written in, and how many SI units it is; "/rev" is the rotor speed of its file."""
    match = _NUMBER.match(number.written)
    unit = number.written[match.end() :].strip() if match else ""
    if unit == "/rev" and number.rotor_speed is not None:
        return "/rev", number.rotor_speed
    if not unit:
        return number.unit, 1.0
    return unit, factor_to_si(number.written, unit, number.unit)
