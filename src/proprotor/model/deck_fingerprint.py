"""A short text that identifies the deck of a case, or a value that cannot be written out."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from proprotor.errors import InputError
from proprotor.files.fingerprint import fingerprint
from proprotor.rotor.kept import kept

if TYPE_CHECKING:
    from proprotor.model.configuration import Configuration

_DIGITS = 16


@kept
def deck_fingerprint(case: Configuration) -> str:
    """Return a text that is the same for the same numbers and choices of a deck, whatever their names and titles.

    For a case without a deck the text identifies the rotor, operation and support themselves.
    """
    if case.deck is None:
        parts = [case.rotor, case.operation, case.support, case.frequencies, case.drive_train, case.left]
        return short_fingerprint([*parts, *_loops(case)])
    numbers = {path: [_number(n.si), n.r_over_R] for path, n in case.given.items() if not _names_files(n.si)}
    airfoil_file = case.rotor.airfoil if "rotor.airfoil.table" in case.given else None
    return short_fingerprint([numbers, _choices(case.deck), airfoil_file, *_loops(case)])


def _loops(case: Configuration) -> list[Any]:
    """Return what the control loops of a case are, in a list that is empty without loops."""
    return [[vars(loop) | {"law": vars(loop.law)} for loop in case.loops]] if case.loops else []


def short_fingerprint(content: Any) -> str:
    """Return the first digits of the fingerprint of some content; "unknown" for content that has no fingerprint."""
    try:
        return fingerprint(content)[:_DIGITS]
    except InputError:
        return "unknown"


def _number(si: Any) -> Any:
    """Return one number as a Python number, whatever its type was, also in a list; arrays as they are."""
    if isinstance(si, tuple):
        return tuple(map(_number, si))
    return np.asarray(si).item() if np.ndim(si) == 0 else si


def _choices(section: Any) -> dict[str, Any]:
    """Return the entries of a section of a deck that are neither numbers nor prose: kinds, flags and file names."""
    found: dict[str, Any] = {}
    for name in sorted(type(section).model_fields):
        entry = getattr(section, name)
        if hasattr(type(entry), "model_fields"):
            found[name] = {} if name == "case" else _choices(entry)
        elif isinstance(entry, list | tuple):
            found[name] = [_choices(one) if hasattr(type(one), "model_fields") else one for one in entry]
        elif name == "variants":
            found[name] = {key: _choices(one) for key, one in entry.items()}
        elif isinstance(entry, str | bool | int | dict) or entry is None:
            found[name] = entry
        elif _names_files(getattr(entry, "si", None)):
            found[name] = entry.written
    return found


def _names_files(si: Any) -> bool:
    """Return whether a value names a file, or several files, or is a word."""
    return isinstance(si, str) or (isinstance(si, tuple) and isinstance(si[0], str))
