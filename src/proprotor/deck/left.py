"""What differs on the left side of an aircraft: the table [left] of a deck, fields by their place in the deck."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from proprotor.deck.alternatives import altered, is_section
from proprotor.errors import InputError

_WHOLE_SECTIONS = ("rotor", "drive_train")
# Both sides have the blades and the size of one rotor, and one shaft between them.
_SHARED = ("rotor.n_blades", "rotor.radius", "drive_train.interconnect_stiffness")
_OF_BOTH = (
    *("kind", "symmetry", "modes", "elements", "rotor_mass", "damping_ratio", "loss_factor"),
    *(f"{kind}_damping_ratio" for kind in ("beam", "chord", "torsion", "pylon_yaw")),
    *("fuselage", "horizontal_tail", "vertical_tail", "wing_aerodynamics"),
)
_OF_BOTH_IN_BOX = ("half_width", "elements")


def nested(left: Any) -> Any:
    """Return the table [left] with tables inside, also where a field is given by its path in quotation marks.

    Raises
    ------
    InputError
        For a field that is given twice.
    """
    if not isinstance(left, dict):
        return left
    tables: dict[str, Any] = {}
    for path, entry in _leaves(left, ""):
        *outer, last = path.split(".")
        within = tables
        for name in outer:
            within = within.setdefault(name, {})
            if not is_section(within):
                raise InputError(f"left.{path}", entry, "must not be given twice")
        if last in within:
            raise InputError(f"left.{path}", entry, "must not be given twice")
        within[last] = entry
    return tables


def left_paths(left: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the paths of the fields of the table [left]."""
    return tuple(path for path, entry in _leaves(left, "") if entry is not None)


def _leaves(table: Mapping[str, Any], outer: str) -> Iterator[tuple[str, Any]]:
    """Yield the path and the value of each field of nested tables."""
    for name, entry in table.items():
        path = f"{outer}.{name}" if outer else name
        if is_section(entry) and "r_over_R" not in entry and "y_over_span" not in entry:
            yield from _leaves(entry, path)
        else:
            yield path, entry


def left_tables(own: dict[str, Any], left: dict[str, Any]) -> dict[str, Any]:
    """Return the tables of the whole left side.

    Parameters
    ----------
    own : dict
        Tables of a valid deck, without the table [left].
    left : dict
        The table [left], nested.

    Raises
    ------
    InputError
        For a support with one rotor, and for a field that both sides must share.
    """
    if own["support"]["kind"] != "aircraft":
        raise InputError(
            "left", ", ".join(left_paths(left)), 'must be given with [support] kind = "aircraft" only'
        )
    if own["support"].get("symmetry", "both") != "both":
        rule = 'must be "both" for an aircraft whose left side differs'
        raise InputError("support.symmetry", own["support"]["symmetry"], rule)
    for path in left_paths(left):
        if not _may_differ(path):
            raise InputError(
                f"left.{path}", None, "must be the same on both sides; set it for the whole aircraft"
            )
    return altered(own, left)


def _may_differ(path: str) -> bool:
    """Return whether a field may differ on the left side."""
    section, _, name = path.partition(".")
    if section in _WHOLE_SECTIONS:
        return path not in _SHARED
    if section == "support":
        first, _, inner = name.partition(".")
        return first not in _OF_BOTH and not (first == "carry_through" and inner in _OF_BOTH_IN_BOX)
    return path.startswith("operation.trim")
