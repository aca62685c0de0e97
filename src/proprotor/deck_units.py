"""The unit in which a deck has a number, for derivatives and tables that people read."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from proprotor.units import factor_to_si

if TYPE_CHECKING:
    from proprotor.datum import Datum

_NUMBER = re.compile(r"\s*[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?\s*")


def deck_unit(number: Datum) -> tuple[str, float]:
    """The unit a number is written in, and how many SI units it is; "/rev" is the rotor speed of its file."""
    match = _NUMBER.match(number.written)
    unit = number.written[match.end() :].strip() if match else ""
    if unit == "/rev" and number.rotor_speed is not None:
        return "/rev", number.rotor_speed
    if not unit:
        return number.unit, 1.0
    return unit, factor_to_si(number.written, unit, number.unit)
