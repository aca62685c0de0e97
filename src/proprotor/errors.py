"""What a user is told when an input is wrong: the field, the value, and the rule it breaks."""

from __future__ import annotations

import difflib
import unicodedata
from collections.abc import Collection, Iterable
from typing import Any

import numpy as np

_WIDEST_VALUE = 60  # characters of a value worth repeating in a message
# Controls, formats such as those that turn the direction of text round, halves of characters, characters without a
# known shape, ends of lines.
_NEVER = ("Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp")


class InputError(ValueError):
    """An input that cannot be used, told in one line: ``field = value: rule``.

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
        super().__init__(field, value, rule, self.others)  # all of them, so that the error can be pickled

    def __str__(self) -> str:
        shown = "" if self.value is None else f" = {_on_one_line(self.value)}"
        told = f"{_on_one_line(self.field)}{shown}: {printable(self.rule)}"
        return "\n".join([told, *map(str, self.others)])

    def within(self, path: str) -> InputError:
        """The same error, with the field named from further outside.

        Parameters
        ----------
        path : str
            Of the section, put before the field.

        Returns
        -------
        InputError
        """
        return InputError(".".join(filter(None, (path, self.field))), self.value, self.rule, self.others)


def check_number(field: str, value: object) -> None:
    """Refuse what is neither a number nor an array of numbers.

    Raises
    ------
    InputError
        For text, None and the like.
    """
    if getattr(np.asarray(value), "dtype", np.dtype(object)).kind not in "biufc":
        raise InputError(field, value, "must be a number in SI units")


def unknown_name(name: str, known: Collection[str], what: str = "field") -> str:
    """The rule an unknown name breaks, with the nearest known name, or else all of them."""
    by_lower_case = {k.lower(): k for k in known}
    nearest = difflib.get_close_matches(name.lower(), by_lower_case, n=1) or [
        k
        for k in by_lower_case
        if name and k.startswith(f"{name.lower()}_")  # "thrust" for thrust_coefficient
    ]
    hint = f"did you mean {by_lower_case[nearest[0]]}?" if nearest else f"known: {', '.join(known)}"
    return f"unknown {what} {_on_one_line(name)!r}; {hint}"


def _on_one_line(value: object) -> str:
    if isinstance(value, bool):
        value = str(value).lower()  # as TOML has it
    if isinstance(value, dict):
        value = "{ … }"
    text = str(value) or '""'
    text = printable(text)
    return text if len(text) <= _WIDEST_VALUE else f"{text[: _WIDEST_VALUE - 1]}…"


def unprintable(text: str) -> str:
    """The first character of a text that may not be shown, such as ``U+001B``; empty where there is none."""
    found = next((c for c in text if unicodedata.category(c) in _NEVER), "")
    return f"U+{ord(found):04X}" if found else ""


def printable(text: str, keep: str = "") -> str:
    """A text with a space for each character that may not be shown, except those to keep."""
    if text.isprintable():
        return text
    return "".join(c if c in keep or c.isprintable() else " " for c in text)


def is_choice(value: Any, choices: tuple[bool | str, ...]) -> bool:
    """Whether a value is one of some words, true or false; 1 is not true."""
    return isinstance(value, bool | str) and value in choices


def told_choices(choices: tuple[bool | str, ...]) -> str:
    """The choices as a message lists them."""
    return " or ".join(f'"{choice}"' if isinstance(choice, str) else as_toml(choice) for choice in choices)


def as_toml(value: bool | str) -> str:
    """A word, true or false as a deck has it, without quotation marks."""
    return value if isinstance(value, str) else str(value).lower()
