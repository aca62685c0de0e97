"""Finding and reading deck files: bundled names, paths, and decks that alter another deck."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Callable, Mapping
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any

from proprotor.deck.reading import FileName, PerRevolution, read_quantity
from proprotor.errors import InputError, unknown_name
from proprotor.files.text import read_text
from proprotor.rotor.rotor import MASS_INTEGRALS

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable

# Fields of [rotor]: of each pair a deck gives exactly one side, whole.
ALTERNATIVES = (
    (("flap_stiffness",), ("flap_frequency",)),
    (("lag_stiffness",), ("lag_frequency",)),
    (("chord",), ("lock_number",)),
    (MASS_INTEGRALS, ("mass_distribution",)),
)
# Fields of [rotor.airfoil]: one side only.
AIRFOIL_ALTERNATIVES = ((("lift_slope", "zero_lift_angle", "drag", "moment"), ("table",)),)
# Fields of [operation]: the air as it is, or that of the standard atmosphere.
AIR_ALTERNATIVES = ((("density", "speed_of_sound"), ("altitude", "temperature_offset")),)
# Fields of [operation.trim] and of [support]: one side only.
TRIM_ALTERNATIVES = ((("collective",), ("thrust_coefficient",), ("power_coefficient",)),)
DAMPING_ALTERNATIVES = ((("damping_ratio",), ("loss_factor",)),)
FILE_ALTERNATIVES = ((("file",), ("mass", "stiffness", "damping", "dofs")),)
_REPLACING = (
    (("rotor",), ALTERNATIVES),
    (("rotor", "airfoil"), AIRFOIL_ALTERNATIVES),
    (("operation",), AIR_ALTERNATIVES),
    (("operation", "trim"), TRIM_ALTERNATIVES),
    (("support",), (*DAMPING_ALTERNATIVES, *FILE_ALTERNATIVES)),
)
_FILES = (
    ("rotor", "airfoil", "table", "value"),
    *(("support", name, "value") for name in ("file", "mass", "stiffness", "damping", "dofs")),
)
_MAY_BE_COLUMNS = ("chord", "twist", "mass_distribution")  # of [rotor]: { file = ..., column = ... }

_LARGEST = 1_000_000  # bytes


def list_cases() -> tuple[str, ...]:
    """Names of the bundled decks, for `load_case`.

    Returns
    -------
    tuple of str
        In alphabetical order.
    """
    return tuple(sorted(_bundled()))


def read_tables(name_or_path: str | os.PathLike[str]) -> dict[str, Any]:
    """The tables of a deck by its bundled name or path, put into those of its base, if it has one.

    A frequency per revolution is a `PerRevolution`: it knows the rotor speed of its own file, which is that of the
    file's base where the file gives none.

    Raises
    ------
    InputError
        When a file cannot be found, cannot be read or is not TOML.
    """
    return _tables(os.fspath(name_or_path), Path(), ())


def _tables(name: str, folder: Path, altered_by: tuple[str, ...]) -> dict[str, Any]:
    file = _find(name, folder)
    tables = _parse(file, name)
    folder = file.parent if isinstance(file, Path) else folder
    for place in _FILES:
        _locate_file(tables, folder, place)
    for name in _MAY_BE_COLUMNS if isinstance(tables.get("rotor"), dict) else ():
        _locate_file(tables["rotor"].get(name), folder, ("file",))
    if "base" not in tables:
        return per_revolution_of(tables, tables)
    base = tables.pop("base")
    if not isinstance(base, str):
        raise InputError("base", base, "must be the name or path of a deck")
    if str(file) in altered_by:
        raise InputError("base", base, "must not lead back to the deck itself")
    inherited = _without(_tables(base, folder, (*altered_by, str(file))), ("case", "name"))  # one deck's only
    whole = altered(inherited, tables)
    return per_revolution_of(whole, whole)


def per_revolution_of(speed: Mapping[str, Any], tables: dict[str, Any]) -> dict[str, Any]:
    """Tables whose frequencies per revolution are those of a rotor speed, that of other tables, unless they have one.

    Left as they are where the others have no rotor speed that can be read: what is wrong with it is told elsewhere.
    """
    rotor_speed = _rotor_speed(speed)
    if rotor_speed is None:
        return tables

    def told(entry: Any) -> Any:
        if isinstance(entry, str) and entry.endswith("/rev") and not isinstance(entry, PerRevolution):
            return PerRevolution.of(entry, rotor_speed)
        return entry

    whole: dict[str, Any] = _every(tables, told)
    return whole


def as_one_file(tables: dict[str, Any]) -> dict[str, Any]:
    """Tables as a file of their own may hold them: frequencies per revolution of another rotor speed in rad/s."""
    rotor_speed = _rotor_speed(tables)

    def told(entry: Any) -> Any:
        other = isinstance(entry, PerRevolution) and entry.rotor_speed != rotor_speed
        return entry.per_second if other else entry

    whole: dict[str, Any] = _every(tables, told)
    return whole


def _every(entry: Any, changed: Callable[[Any], Any]) -> Any:
    """Nested tables and lists with each value changed."""
    if isinstance(entry, dict):
        return {name: _every(value, changed) for name, value in entry.items()}
    if isinstance(entry, list):
        return [_every(value, changed) for value in entry]
    return changed(entry)


def _rotor_speed(tables: Mapping[str, Any]) -> float | None:
    """rad/s of a deck, None where it has none that can be read."""
    try:
        return float(read_quantity(tables["operation"]["rotor_speed"], "rad/s").si)
    except (InputError, KeyError, TypeError):
        return None


def _bundled() -> dict[str, Traversable]:
    folder = resources.files("proprotor.deck") / "decks"
    return {file.name.removesuffix(".toml"): file for file in folder.iterdir() if file.name.endswith(".toml")}


def _find(name: str, folder: Path) -> Traversable:
    bundled = _bundled()
    if name in bundled:
        return bundled[name]
    path = folder / name
    try:
        if path.is_file():
            return path.resolve()  # one name for one file, so that a circle of bases is seen
        if name and path.is_dir():
            raise InputError("deck", name, "must be a file, not a folder")
    except OSError as error:  # a name too long, a folder one may not enter
        raise InputError("deck", name, f"cannot be read ({error.strerror})") from None
    if name.endswith(".toml") or os.sep in name:
        raise InputError("deck", name, "no such file")
    raise InputError("deck", name, unknown_name(name, list_cases(), "deck"))


def _parse(file: Traversable, name: str) -> dict[str, Any]:
    text = read_text(file, "deck", name, _LARGEST)
    try:
        return tomllib.loads(text)
    except ValueError as error:  # TOMLDecodeError, with the line; or an integer of thousands of digits
        raise InputError("deck", name, f"is not TOML: {error}") from None
    except RecursionError:
        raise InputError("deck", name, "is not a deck: nested too deeply") from None


def _locate_file(tables: Any, folder: Path, place: tuple[str, ...]) -> None:
    """Have the name of a file, at a place in the tables or on the way there, start from the deck's folder."""
    key, *further = place
    entry = tables.get(key) if isinstance(tables, dict) else None
    if isinstance(entry, str):
        tables[key] = FileName.inside(folder, entry)
    elif further:
        _locate_file(entry, folder, tuple(further))


def altered(base: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    """Tables with changes put in: a field replaces its alternatives, and another kind of support all of it."""
    superseded = [
        place for section, choices in _REPLACING for place in _superseded(changes, section, choices)
    ]
    superseded += (
        [("support",)] if _is_section(changes.get("support")) and "kind" in changes["support"] else []
    )
    rotor: Any = changes.get("rotor")
    if _is_section(rotor) and not rotor.keys().isdisjoint(MASS_INTEGRALS):
        superseded.append(("rotor", "hub_mass"))  # which stood beside a distribution; integrals hold it
    for place in superseded:
        base = _without(base, place)
    return _merged(base, changes)


def _superseded(changes: Any, section: tuple[str, ...], alternatives: Any) -> list[tuple[str, ...]]:
    """Fields of a section that give way to those the changes have there."""
    for key in section:
        changes = changes.get(key) if isinstance(changes, dict) else None
    given = set(changes) if isinstance(changes, dict) else set()
    return [
        (*section, name)
        for choice in alternatives
        for side in choice
        if given.intersection(side)
        for other in choice
        if other != side
        for name in other
    ]


def _without(tables: Any, place: tuple[str, ...]) -> Any:
    key, *further = place
    if not isinstance(tables, dict) or key not in tables:
        return tables
    rest = {name: entry for name, entry in tables.items() if name != key}
    return rest | {key: _without(tables[key], tuple(further))} if further else rest


def _merged(base: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    result = base | changes
    for key, change in changes.items():
        if _is_section(change) and _is_section(base.get(key)):
            result[key] = _merged(base[key], change)
    return result


def _is_section(entry: Any) -> bool:
    return isinstance(entry, dict) and "value" not in entry and "column" not in entry
