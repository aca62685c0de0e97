"""Finding and reading deck files: bundled names, paths, and decks that alter another deck."""

from __future__ import annotations

import os
import tomllib
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any

from proprotor.errors import InputError, unknown_name
from proprotor.rotor import MASS_INTEGRALS

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable

# Fields of [rotor]: of each pair a deck gives exactly one side, whole.
ALTERNATIVES = (
    (("flap_stiffness",), ("flap_frequency",)),
    (("lag_stiffness",), ("lag_frequency",)),
    (("chord",), ("lock_number",)),
    (MASS_INTEGRALS, ("mass_distribution",)),
)

_LARGEST = 1_000_000  # bytes


def list_cases() -> tuple[str, ...]:
    """Names of the bundled decks, for `load_case`."""
    return tuple(sorted(_bundled()))


def read_tables(name_or_path: str | os.PathLike[str]) -> dict[str, Any]:
    """The tables of a deck by its bundled name or path, put into those of its base, if it has one.

    Raises
    ------
    InputError
        When a file cannot be found, cannot be read or is not TOML.
    """
    return _tables(os.fspath(name_or_path), Path(), ())


def _tables(name: str, folder: Path, altered_by: tuple[str, ...]) -> dict[str, Any]:
    file = _find(name, folder)
    tables = _parse(file, name)
    if "base" not in tables:
        return tables
    base = tables.pop("base")
    if not isinstance(base, str):
        raise InputError("base", base, "must be the name or path of a deck")
    if str(file) in altered_by:
        raise InputError("base", base, "must not lead back to the deck itself")
    folder = file.parent if isinstance(file, Path) else folder
    return _altered(_tables(base, folder, (*altered_by, str(file))), tables)


def _bundled() -> dict[str, Traversable]:
    folder = resources.files("proprotor") / "decks"
    return {file.name.removesuffix(".toml"): file for file in folder.iterdir() if file.name.endswith(".toml")}


def _find(name: str, folder: Path) -> Traversable:
    bundled = _bundled()
    if name in bundled:
        return bundled[name]
    path = folder / name
    try:
        if path.is_file():
            return path.resolve()  # one name for one file, so that a circle of bases is seen
    except OSError as error:  # a name too long, a folder one may not enter
        raise InputError("deck", name, f"cannot be read ({error.strerror})") from None
    if name.endswith(".toml") or os.sep in name:
        raise InputError("deck", name, "no such file")
    raise InputError("deck", name, unknown_name(name, list_cases(), "deck"))


def _parse(file: Traversable, name: str) -> dict[str, Any]:
    try:
        with file.open("rb") as stream:
            content = stream.read(_LARGEST + 1)
    except OSError as error:
        raise InputError("deck", name, f"cannot be read ({error.strerror})") from None
    if len(content) > _LARGEST:
        raise InputError("deck", name, f"must not be larger than {_LARGEST} bytes")
    try:
        return tomllib.loads(content.decode("utf-8"))
    except UnicodeDecodeError:
        raise InputError("deck", name, "must be text in UTF-8") from None
    except ValueError as error:  # TOMLDecodeError, with the line; or an integer of thousands of digits
        raise InputError("deck", name, f"is not TOML: {error}") from None
    except RecursionError:
        raise InputError("deck", name, "is not a deck: nested too deeply") from None


def _altered(base: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    """The base with the changes put in; a name belongs to one deck only."""
    for section, name in (("case", "name"), *_superseded(changes)):
        if isinstance(base.get(section), dict):
            base[section] = {key: value for key, value in base[section].items() if key != name}
    return _merged(base, changes)


def _superseded(changes: dict[str, Any]) -> list[tuple[str, str]]:
    rotor = changes.get("rotor")
    given = set(rotor) if isinstance(rotor, dict) else set()
    sides = [(side, other) for pair in ALTERNATIVES for side, other in (pair, pair[::-1])]
    return [("rotor", name) for side, other in sides if given.intersection(side) for name in other]


def _merged(base: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    result = base | changes
    for key, change in changes.items():
        if _is_section(change) and _is_section(base.get(key)):
            result[key] = _merged(base[key], change)
    return result


def _is_section(entry: Any) -> bool:
    return isinstance(entry, dict) and "value" not in entry
