"""What an input of a study may be: values, or a distribution from which values are drawn, read into SI units."""

from __future__ import annotations

from collections.abc import Sized
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from proprotor.datum import Datum
from proprotor.deck.input_values import input_values
from proprotor.errors import InputError
from proprotor.typing import Array


class Range(NamedTuple):
    """Any value between two limits, all equally likely; numbers are in SI.

    Parameters
    ----------
    low, high : float, text with a unit, or pint quantity
    """

    low: Any
    high: Any

    def ppf(self, share: Array) -> Array:
        """Return the value below which a share of the distribution lies.

        Parameters
        ----------
        share : array (...)
            0 to 1, dimensionless.

        Returns
        -------
        array (...)
            In the unit of the limits, SI once the range is resolved.
        """
        value: Array = self.low + (self.high - self.low) * share
        return value


class LogRange(NamedTuple):
    """Any value between two limits above zero, all ratios equally likely; numbers are in SI.

    Parameters
    ----------
    low, high : float, text with a unit, or pint quantity
    """

    low: Any
    high: Any

    def ppf(self, share: Array) -> Array:
        """Return the value below which a share of the distribution lies.

        Parameters
        ----------
        share : array (...)
            0 to 1, dimensionless.

        Returns
        -------
        array (...)
            In the unit of the limits, SI once the range is resolved.
        """
        value: Array = self.low * (self.high / self.low) ** share
        return value


class Normal(NamedTuple):
    """A normal distribution by its mean and standard deviation, in any unit of the input.

    Parameters
    ----------
    mean, deviation : float, text with a unit, or pint quantity
        The deviation is the standard deviation; numbers are in SI.
    """

    mean: Any
    deviation: Any

    def ppf(self, share: Array) -> Array:
        """Return the value below which a share of the distribution lies.

        Parameters
        ----------
        share : array (...)
            0 to 1, dimensionless.

        Returns
        -------
        array (...)
            In the unit of the mean, SI once the distribution is resolved.
        """
        from scipy.special import ndtri

        value: Array = self.mean + self.deviation * ndtri(share)
        return value


class Relative(NamedTuple):
    """Any value between two multiples of the deck's value: ``Relative(0.9, 1.1)`` is 10 % either way.

    Parameters
    ----------
    low, high : float
        Factors, dimensionless.
    logarithmic : bool
        Whether all ratios between the factors are equally likely, and not all differences.
    """

    low: float
    high: float
    logarithmic: bool = False


def read_values(name: str, given: Any, known: Datum) -> Array:
    """Return the values of an input in SI: an array of one dimension, of none for a single value.

    Raises
    ------
    InputError
        For a value of another dimension than the input's, an array of several dimensions, or no value.
    """
    values = input_values(name, given, known)
    if values.ndim > 1:
        raise InputError(name, f"array of shape {values.shape}", "must be a value or a list of values")
    if not values.size:
        raise InputError(name, given, "must have at least one value")
    return values


def read_distribution(name: str, given: Any, known: Datum) -> Any:
    """Return the distribution of an input in SI: an object with a method ``ppf``.

    Raises
    ------
    InputError
        For an object that is no distribution, limits in the wrong order, or factors on a number that the deck has not.
    """
    if isinstance(given, Relative):
        return _relative(name, given, known)
    if hasattr(given, "ppf") and not isinstance(given, Range | LogRange | Normal):
        return given
    is_pair = (
        not isinstance(given, str) and np.iterable(given) and isinstance(given, Sized) and len(given) == 2
    )
    if not is_pair:
        rule = "must be a pair of limits, a Range, LogRange, Normal or Relative, or a distribution of scipy.stats"
        raise InputError(name, given, rule)
    if isinstance(given, Normal):
        known = replace(known, form="")  # the deviation of an angle has no tangent
    first, second = (float(read_values(name, value, known)) for value in given)
    if isinstance(given, Normal):
        if not second > 0:
            raise InputError(name, second, "must have a standard deviation above zero")
        return Normal(first, second)
    if not first < second:
        raise InputError(name, given, "must have its lower limit first")
    if isinstance(given, LogRange):
        return LogRange(_above_zero(name, first), second)
    return Range(first, second)


def _relative(name: str, given: Relative, known: Datum) -> Range | LogRange:
    """Return the range between two multiples of the deck's number."""
    if not has_number(known):
        raise InputError(name, given, "must be given in absolute terms: the deck has no such number")
    if known.si == 0:
        raise InputError(name, given, "must be given in absolute terms: the number is 0")
    low, high = (float(factor) for factor in given[:2])
    if given.logarithmic:
        return LogRange(_above_zero(name, low) * known.si, _above_zero(name, high) * known.si)
    return Range(*sorted((low * known.si, high * known.si)))


def has_number(known: Datum) -> bool:
    """Return whether the deck has one number for an input, which a factor can multiply."""
    return bool(np.isscalar(known.si)) and not isinstance(known.si, str)


def _above_zero(name: str, limit: float) -> float:
    if not limit > 0:
        raise InputError(name, limit, "must have limits above zero, for ratios to be equally likely")
    return limit
