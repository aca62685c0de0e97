"""Find and read deck files: bundled names, paths, and decks that alter another deck."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Iterator
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any

from proprotor.deck.alternatives import altered, without
from proprotor.deck.default_provenance import with_default_provenance
from proprotor.deck.left import nested
from proprotor.deck.per_revolution import per_revolution_of
from proprotor.deck.written import FileName
from proprotor.errors import InputError, nearest_name, unknown_name
from proprotor.files.text import is_file, read_text

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable

_FILES = (
    ("rotor", "airfoil", "table", "value"),
    *(("support", name, "value") for name in ("file", "mass", "stiffness", "damping", "dofs", "hub_motion")),
)
_MAY_BE_COLUMNS = (
    "chord",
    "twist",
    "mass_distribution",
    "mass_offset",
    "aerodynamic_center",
)  # in [rotor]: { file = ..., column = ... }

_LARGEST = 1_000_000  # bytes


def list_cases() -> tuple[str, ...]:
    """Return the names of the bundled decks, for `load_case`.

    Returns
    -------
    tuple of str
        In alphabetical order.
    """
    return tuple(sorted(_bundled()))


def read_tables(name_or_path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the tables of a deck by its bundled name or path; a deck with a base is merged into the base.

    A frequency per revolution is a `PerRevolution`: it has the rotor speed of its own file, or of the file's base if
    the file gives none.

    Raises
    ------
    InputError
        When a file cannot be found, cannot be read or is not TOML.
    """
    return _tables(os.fspath(name_or_path), Path(), ())


def _tables(name: str, folder: Path, altered_by: tuple[str, ...]) -> dict[str, Any]:
    """Return the tables of a deck that is named from a folder; `altered_by` are the files that lead to it as a base."""
    file = _find(name, folder)
    tables = _parse(file, name)
    for part in _with_variants(tables):
        if "left" in part:
            part["left"] = nested(part["left"])
    tables = with_default_provenance(tables)
    folder = file.parent if isinstance(file, Path) else folder
    for part in _with_variants(tables):
        _locate_files(part, folder)
    if "base" not in tables:
        return per_revolution_of(tables, tables)
    base = tables.pop("base")
    if not isinstance(base, str):
        raise InputError("base", base, "must be the name or path of a deck")
    if str(file) in altered_by:
        raise InputError("base", base, "must not lead back to the deck itself")
    # The name of a case belongs to one deck, so a base does not pass its own on.
    inherited = without(_tables(base, folder, (*altered_by, str(file))), ("case", "name"))
    whole = altered(inherited, tables)
    return per_revolution_of(whole, whole)


def _with_variants(tables: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Yield the tables of a deck, then those of each variant that is a table."""
    yield tables
    variants = tables.get("variants")
    if isinstance(variants, dict):
        yield from (variant for variant in variants.values() if isinstance(variant, dict))


def _locate_files(tables: dict[str, Any], folder: Path) -> None:
    """Make all names of files in the tables of a deck or of a variant start from a folder."""
    for place in _FILES:
        _locate_file(tables, folder, place)
    for name in _MAY_BE_COLUMNS if isinstance(tables.get("rotor"), dict) else ():
        _locate_file(tables["rotor"].get(name), folder, ("file",))


def _bundled() -> dict[str, Traversable]:
    """Return the files of the bundled decks by name."""
    folder = resources.files("proprotor.deck") / "decks"
    return {file.name.removesuffix(".toml"): file for file in folder.iterdir() if file.name.endswith(".toml")}


def _find(name: str, folder: Path) -> Traversable:
    """Return the file of a deck by its bundled name, or by its path from a folder."""
    bundled = _bundled()
    if name in bundled:
        return bundled[name]
    path = folder / name
    try:
        if is_file(path):
            return path.resolve()  # one name for one file, to detect a circle of bases
        if name and path.is_dir():
            raise InputError("deck", name, "must be a file, not a folder")
    except OSError as error:  # a name that is too long, a folder without permission
        raise InputError("deck", name, f"cannot be read ({error.strerror})") from None
    if name.endswith(".toml") or Path(name).name != name:
        nearest = nearest_name(Path(name).name.removesuffix(".toml"), bundled)
        hint = f"; did you mean the bundled deck {nearest}?" if nearest else ""
        raise InputError("deck", name, f"no such file{hint}")
    raise InputError("deck", name, unknown_name(name, list_cases(), "deck"))


def _parse(file: Traversable, name: str) -> dict[str, Any]:
    """Return the tables of a TOML file."""
    text = read_text(file, "deck", name, _LARGEST)
    try:
        return tomllib.loads(text)
    except ValueError as error:  # TOMLDecodeError, with the line; or an integer of thousands of digits
        path = ": write a path with / or in single quotes" if "'\\'" in str(error) else ""
        raise InputError("deck", name, f"is not TOML: {error}{path}") from None
    except RecursionError:
        raise InputError("deck", name, "is not a deck: nested too deeply") from None


def _locate_file(tables: Any, folder: Path, place: tuple[str, ...]) -> None:
    """Make the names of files, at a place in the tables or on the path to that place, start from the deck's folder."""
    key, *further = place
    entry = tables.get(key) if isinstance(tables, dict) else None
    if isinstance(entry, str):
        tables[key] = FileName.inside(folder, entry)
    elif isinstance(entry, list):
        tables[key] = [FileName.inside(folder, one) if isinstance(one, str) else one for one in entry]
    elif further:
        _locate_file(entry, folder, tuple(further))
