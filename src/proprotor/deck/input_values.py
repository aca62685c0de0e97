"""Read values of an input, in every form in which a deck may have the number."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from proprotor.datum import Datum
from proprotor.deck.reading import BELOW_QUARTER_TURN, rule_of_tangent
from proprotor.errors import InputError
from proprotor.units import factor_to_si, values_in_si

_PER_REV = "/rev"


def input_values(path: str, given: Any, number: Datum) -> NDArray[np.float64]:
    """Return values of an input in SI.

    Parameters
    ----------
    path : str
        Of the input, for the message.
    given : array_like, str, pint.Quantity, xarray.DataArray, or a list of them
        As `proprotor.units.values_in_si` takes it: a number is in SI, and text may be a range, ``"1:4:0.5 deg"``. As in
        a deck, a tangent may be given by its angle, ``"-15 deg"``, and a frequency per revolution, ``"0.42/rev"``.
    number : Datum
        The deck's number, see `proprotor.deck.vary.design_inputs`. One per revolution is its rotor speed.

    Returns
    -------
    array (...)
        The steps of a range are equal in the unit in which they are written.

    Raises
    ------
    InputError
        When a value has another dimension or is not numeric, for an angle of 90 degrees or more whose tangent is
        wanted, and a range that does not rise.
    """
    if isinstance(given, list | tuple):
        try:
            return np.array([input_values(path, value, number) for value in given], dtype=float)
        except ValueError as error:  # lists of different lengths
            if isinstance(error, InputError):
                raise
            raise InputError(path, given, "must be a list of values") from None
    if number.rotor_speed is not None and isinstance(given, str) and given.strip().endswith(_PER_REV):
        try:
            return values_in_si(given.strip().removesuffix(_PER_REV), "", path) * number.rotor_speed
        except InputError as error:
            raise InputError(path, given, error.rule) from None
    try:
        return values_in_si(given, number.unit, path)
    except InputError as error:
        if number.form != "tangent":
            raise
        of_number = error
    try:
        angle = values_in_si(given, "rad", path)
    except InputError:
        raise InputError(path, given, rule_of_tangent(of_number)) from None
    if not all(map(BELOW_QUARTER_TURN.holds, angle.ravel().tolist())):
        raise InputError(path, given, BELOW_QUARTER_TURN.rule)
    return np.tan(angle)


def shown_unit(unit: str, number: Datum) -> str:
    """Return the unit in which results show an input: that of the values, if it is a multiple of the SI unit.

    The tangents of angles are plain numbers, and frequencies per revolution are in rad/s.
    """
    try:
        factor_to_si(unit, unit, number.unit)
    except InputError:
        return number.unit
    return unit
