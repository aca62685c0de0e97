"""Write numbers of a column alike: with as many significant digits, or as many decimals, in each row."""

from __future__ import annotations

from collections.abc import Sequence


def significant(value: float, digits: int, sign: str = "") -> str:
    """Return a number as text with its significant digits, zeros at the end included.

    Parameters
    ----------
    value : float
    digits : int
        Significant digits.
    sign : str
        "+" for a sign before positive numbers as well.
    """
    return f"{value:{sign}#.{digits}g}".removesuffix(".")


def alike(values: Sequence[float], digits: int) -> list[str]:
    """Return numbers as texts with the same count of decimals, the most that any needs for its significant digits.

    Parameters
    ----------
    values : sequence of float
    digits : int
        Significant digits; zeros at the end need no decimals, so that whole numbers stay whole.
    """
    decimals = max((len(f"{value:.{digits}g}".partition(".")[2]) for value in values), default=0)
    return [f"{value:.{decimals}f}" for value in values]
