"""Errors of inputs: the field, the value and the rule that the value breaks, and the words that messages are made of.

`InputError` is the only error that an input raises. The checks of numbers and matrices, the lists of names and
choices that messages have in common, and the way in which a text is shown on a terminal stand here too.
"""

from __future__ import annotations

import difflib
import math
import operator
import unicodedata
from collections.abc import Collection, Iterable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np

_WIDEST_VALUE = 60  # characters of a value worth repeating in a message
# Unicode categories that are never shown: controls, formats (some reverse the direction of text), halves of characters,
# characters without a known shape, ends of lines.
_NEVER = ("Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp")
_SIGNS = {
    "not negative": (operator.lt, "must not be negative"),
    "above zero": (operator.le, "must be above zero"),
}


class InputError(ValueError):
    """An input that cannot be used, with a message of one line: ``field = value: rule``.

    Parameters
    ----------
    field : str
        Name of the input, dotted inside a deck (``rotor.lag_hinge_offset``).
    value : object
        The value as the user gave it; None when it was not given at all.
    rule : str
        What the value must be, as the end of a sentence (``must not be negative``).
    others : iterable of InputError
        Further problems found in the same input; each adds a line to the message.

    Examples
    --------
    >>> print(InputError("rotor.lag_hinge_offset", "0.5 ft", "must not be inboard of the flap hinge"))
    rotor.lag_hinge_offset = 0.5 ft: must not be inboard of the flap hinge
    """

    def __init__(self, field: str, value: object, rule: str, others: Iterable[InputError] = ()) -> None:
        self.field, self.value, self.rule, self.others = field, value, rule, tuple(others)
        super().__init__(field, value, rule, self.others)  # all arguments, so that the error can be pickled

    def __str__(self) -> str:
        shown = "" if self.value is None else f" = {_on_one_line(self.value)}"
        message = f"{_on_one_line(self.field)}{shown}: {printable(self.rule)}"
        return "\n".join([message, *map(str, self.others)])

    def within(self, path: str) -> InputError:
        """Return the same error with the name of a section before the field.

        Parameters
        ----------
        path : str
            Name of the section.

        Returns
        -------
        InputError
        """
        return InputError(".".join(filter(None, (path, self.field))), self.value, self.rule, self.others)


# Checks of numbers --------------------------------------------------------------------------------


def check_number(field: str, value: object) -> None:
    """Refuse a value that is neither a number nor an array of numbers.

    Raises
    ------
    InputError
        For text, None and the like.
    """
    import numpy as np  # here, as below, so that messages need no NumPy: `proprotor --help` answers without

    if getattr(np.asarray(value), "dtype", np.dtype(object)).kind not in "biufc":
        raise InputError(field, value, "must be a number in SI units")


def check_finite(field: str, value: Any, sign: str = "") -> None:
    """Refuse a value that is no number, is not finite or, in its real part, has the wrong sign.

    Parameters
    ----------
    field : str
        Name of the input, for the message.
    value : float or array
    sign : "", "not negative" or "above zero"
        What the real part must be.

    Raises
    ------
    InputError
        With the first rule that the value breaks.
    """
    if isinstance(value, float) and math.isfinite(value) and not (sign and _SIGNS[sign][0](value, 0)):
        return  # most numbers, without NumPy's way around
    import numpy as np

    check_number(field, value)
    if not np.all(np.isfinite(value)):
        raise InputError(field, value, "must be finite")
    if sign:
        broken, rule = _SIGNS[sign]
        if np.any(broken(np.real(value), 0)):
            raise InputError(field, value, rule)


def nowhere_negative(matrix: np.ndarray[Any, Any]) -> bool:
    """Return whether symmetric matrices (..., n, n) have no negative eigenvalue.

    The matrices are scaled to a unit diagonal, so that kg and kg m² in one matrix do not set the tolerance.
    """
    import numpy as np

    diagonal = np.diagonal(matrix, axis1=-2, axis2=-1)
    if (diagonal < 0).any():
        return False
    scale = np.sqrt(np.where(diagonal > 0, diagonal, 1.0))
    scaled = matrix / (scale[..., :, None] * scale[..., None, :])
    return bool((np.linalg.eigvalsh(scaled) > -1e-9).all())


# Names and choices in messages --------------------------------------------------------------------


def unknown_name(name: str, known: Collection[str], what: str = "field") -> str:
    """Return the rule that an unknown name breaks, with the nearest known name or, without a near name, all names."""
    nearest = nearest_name(name, known)
    hint = f"did you mean {nearest}?" if nearest else f"known: {', '.join(known)}"
    return f"unknown {what} {_on_one_line(name)!r}; {hint}"


def nearest_name(name: str, known: Iterable[str]) -> str | None:
    """Return the known name that a name may be meant for, in upper or lower case; None if no known name is near."""
    by_lower_case = {k.lower(): k for k in known}
    # As "thrust_coefficient" for "thrust".
    longer = [k for k in by_lower_case if name and k.startswith(f"{name.lower()}_")]
    nearest = difflib.get_close_matches(name.lower(), by_lower_case, n=1) or longer
    return by_lower_case[nearest[0]] if nearest else None


def check_known(field: str, name: object, known: Collection[str], what: str) -> None:
    """Refuse a name that is not among the known names; `what` says what it should be the name of, such as "mode".

    Raises
    ------
    InputError
        With the nearest known name or, without a near name, all names.
    """
    if name not in known:
        raise InputError(field, name, unknown_name(str(name), known, what))


def is_choice(value: Any, choices: tuple[bool | str, ...]) -> bool:
    """Return whether a value is one of the choices, which are words, true or false; 1 is not true."""
    return isinstance(value, bool | str) and value in choices


def list_choices(choices: tuple[bool | str, ...]) -> str:
    """Return the choices as a message lists them: ``"held" or "free"``."""
    return " or ".join(f'"{choice}"' if isinstance(choice, str) else as_toml(choice) for choice in choices)


def as_toml(value: bool | str) -> str:
    """Return a word, true or false as a deck writes the value, without quotation marks."""
    return value if isinstance(value, str) else str(value).lower()


# Texts on a terminal ------------------------------------------------------------------------------


def unprintable(text: str) -> str:
    """Return the first character of a text that may not be shown, such as ``U+001B``; empty if all may be shown."""
    found = next((c for c in text if unicodedata.category(c) in _NEVER), "")
    return f"U+{ord(found):04X}" if found else ""


def printable(text: str, keep: str = "") -> str:
    """Return a text with a space in place of each character that may not be shown, except the characters to keep."""
    if text.isprintable():
        return text
    return "".join(c if c in keep or c.isprintable() else " " for c in text)


def _on_one_line(value: object) -> str:
    """Return a value as a message shows it: printable, on one line, and cut in its middle where it is too long.

    Its end stays, where the name of a file is.
    """
    if isinstance(value, bool):
        value = as_toml(value)
    if isinstance(value, dict):
        value = "{ … }"
    text = printable(str(value) or '""')
    if len(text) <= _WIDEST_VALUE:
        return text
    start = _WIDEST_VALUE // 3
    return f"{text[:start]}…{text[start + 1 - _WIDEST_VALUE :]}"
