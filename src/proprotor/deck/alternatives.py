"""Fields of which a deck gives one side only, and how the changes of a variant replace the other side."""

from __future__ import annotations

from typing import Any

from proprotor.rotor.rotor import MASS_INTEGRALS

# Fields of [rotor]: of each pair a deck gives exactly one side, whole.
ALTERNATIVES = (
    (("flap_stiffness",), ("flap_frequency",)),
    (("lag_stiffness",), ("lag_frequency",)),
    (("chord",), ("lock_number",)),
    (MASS_INTEGRALS, ("mass_distribution",)),
)
# Fields of [rotor.airfoil]: one side only.
AIRFOIL_ALTERNATIVES = (
    (("lift_slope", "zero_lift_angle", "drag", "moment"), ("table", "table_name", "table_reynolds")),
)
# Fields of [operation]: the air by its properties, or by an altitude in the standard atmosphere.
AIR_ALTERNATIVES = ((("density", "speed_of_sound"), ("altitude", "temperature_offset")),)
# Fields of [operation.trim] and of [support]: one side only.
TRIM_ALTERNATIVES = ((("collective",), ("thrust_coefficient",), ("power_coefficient",)),)
DAMPING_ALTERNATIVES = ((("damping_ratio",), ("loss_factor",)),)
ROTOR_ALTERNATIVES = ((("rotor_mass",), ("rotor_held",)),)
STIFFNESS_ALTERNATIVES = tuple(
    ((f"{kind}_stiffness_factor",), (f"{kind}_frequency",)) for kind in ("beam", "chord", "torsion")
)
FILE_ALTERNATIVES = ((("file",), ("mass", "stiffness", "damping", "dofs", "hub_motion")),)
_BY_SECTION = (
    (("rotor",), ALTERNATIVES),
    (("rotor", "airfoil"), AIRFOIL_ALTERNATIVES),
    (("operation",), AIR_ALTERNATIVES),
    (("operation", "trim"), TRIM_ALTERNATIVES),
    (
        ("support",),
        (*DAMPING_ALTERNATIVES, *ROTOR_ALTERNATIVES, *STIFFNESS_ALTERNATIVES, *FILE_ALTERNATIVES),
    ),
)

_Place = tuple[str, ...]


def fields_instead_of(name: str) -> tuple[str, ...]:
    """Return the fields of [rotor] that a deck may give in place of a field."""
    return tuple(other for left, right in ALTERNATIVES if name in left for other in right)


def altered(base: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    """Return tables with changes: a field replaces its alternatives, another kind of support the whole support."""
    superseded = [
        place for section, choices in _BY_SECTION for place in _superseded(changes, section, choices)
    ]
    if is_section(changes.get("support")) and "kind" in changes["support"]:
        superseded.append(("support",))
    rotor: Any = changes.get("rotor")
    if is_section(rotor) and not rotor.keys().isdisjoint(MASS_INTEGRALS):
        # Both belong to a distribution; the integrals contain the hub.
        superseded += [("rotor", "hub_mass"), ("rotor", "mass_offset")]
    for place in superseded:
        base = without(base, place)
    return _merged(base, changes)


def without(tables: Any, place: _Place) -> Any:
    """Return tables without the entry at a place."""
    key, *further = place
    if not isinstance(tables, dict) or key not in tables:
        return tables
    rest = {name: entry for name, entry in tables.items() if name != key}
    return rest | {key: without(tables[key], tuple(further))} if further else rest


def _superseded(changes: Any, section: _Place, alternatives: Any) -> list[_Place]:
    """Return the places of a section whose fields the changes in that section replace."""
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


def _merged(base: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    """Return tables with changes, section by section."""
    result = base | changes
    for key, change in changes.items():
        if is_section(change) and is_section(base.get(key)):
            result[key] = _merged(base[key], change)
    return result


def is_section(entry: Any) -> bool:
    """Return whether an entry is a section, rather than a number written as a table."""
    return isinstance(entry, dict) and "value" not in entry and "column" not in entry
