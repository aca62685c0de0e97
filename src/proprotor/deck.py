"""The sections and fields of a deck, and what each must be.

A deck is a TOML file. A number with a dimension is text, ``radius = "12.5 ft"``, US and SI units as one
likes; a plain number has none. Either may be a table that says where it comes from::

    radius = { value = "12.5 ft", status = "published", source = "AIAA-2002-1604, Table 1" }

with a status of published, derived, recalled, calibrated or assumed. Chord and twist take one value (twist:
the linear change from centre to tip) or a distribution ``{ r_over_R = [...], value = [...], unit = "deg" }``,
linear between its stations and constant beyond them.

``base``
    Above all sections: the deck this one alters, a bundled name or a file beside it. A field given here
    replaces the base's; one of two alternatives removes the other.
``[case]``
    name, title, description, calibration (what was calibrated to what), warnings.
``[rotor]``
    The arguments of `proprotor.Rotor`, or instead of flap_stiffness and lag_stiffness: flap_frequency and
    lag_frequency, non-rotating, K = I ω²; of chord: lock_number γ, chord = γ I_b / (ρ c_lα R⁴) at the
    deck's density; of the seven mass integrals: mass_distribution.
``[rotor.airfoil]``
    The arguments of `proprotor.Airfoil`, or instead of them: table, a C81 file, its name starting from the
    deck's folder.
``[operation]``
    rotor_speed, density, speed_of_sound, trim = "windmill" or { collective = "30 deg" }.
``[support]``
    kind and the fields of that kind: `proprotor.support_sections` lists them.

A frequency is in rad/s, in Hz (cycles per second) or, ``"0.42/rev"``, per revolution at the deck's rotor
speed. `proprotor.units` lists the units.
"""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, PlainValidator, ValidationError, model_validator

from proprotor.datum import read_quantity
from proprotor.deck_fields import (
    Angle,
    Chord,
    Count,
    Damping,
    Density,
    File,
    FirstMoment,
    Fraction,
    Frequency,
    Inertia,
    InertiaOrNone,
    Length,
    Mass,
    MassDistribution,
    Name,
    NotNegative,
    Number,
    Positive,
    PositiveLength,
    RotorSpeed,
    Section,
    Slope,
    Speed,
    Stiffness,
    Text,
    Twist,
)
from proprotor.deck_file import ALTERNATIVES
from proprotor.errors import InputError, unknown_name
from proprotor.support_sections import SUPPORT_KINDS, SUPPORT_TABLES, SupportSection


class CaseSection(Section):
    name: Name
    title: Text
    description: str = ""
    calibration: str = ""
    warnings: list[Text] = Field(default_factory=list)


class AirfoilSection(Section):
    lift_slope: Slope = None
    zero_lift_angle: Angle = None
    drag: NotNegative = None
    moment: Number = None
    table: File = None

    @model_validator(mode="after")
    def _numbers_or_a_table(self) -> AirfoilSection:
        numbers = [name for name in type(self).model_fields if name in self.model_fields_set - {"table"}]
        if "table" in self.model_fields_set and numbers:
            raise InputError("table", self.table.written, f"must not be given with {', '.join(numbers)}")
        if "table" not in self.model_fields_set and "lift_slope" not in numbers:
            raise InputError("lift_slope", None, "is missing; give lift_slope or table")
        return self


class RotorSection(Section):
    n_blades: Count
    radius: PositiveLength
    root_cutout: Length
    flap_hinge_offset: Length
    lag_hinge_offset: Length
    precone: Angle
    blade_mass: Mass = None
    blade_first_moment: FirstMoment = None
    blade_inertia: Inertia = None
    flap_first_moment: FirstMoment = None
    flap_inertia: Inertia = None
    lag_first_moment: FirstMoment = None
    lag_inertia: Inertia = None
    mass_distribution: MassDistribution = None
    flap_stiffness: Stiffness = None
    flap_frequency: Frequency = None
    lag_stiffness: Stiffness = None
    lag_frequency: Frequency = None
    flap_outboard_fraction: Fraction
    lag_outboard_fraction: Fraction
    structural_pitch_offset: Angle = None
    gimbal_stiffness: Stiffness
    pitch_gimbal_coupling: Number
    pitch_inertia: InertiaOrNone
    control_stiffness: Stiffness
    flap_damping: Damping = None
    lag_damping: Damping = None
    pitch_damping: Damping = None
    gimbal_damping: Damping = None
    propeller_moment: bool = True
    chord: Chord = None
    lock_number: Positive = None
    twist: Twist
    airfoil: AirfoilSection

    @model_validator(mode="after")
    def _one_side_of_each_pair(self) -> RotorSection:
        for pair in ALTERNATIVES:
            sides = [side for side in pair if self.model_fields_set.intersection(side)]
            both = " or ".join(_listed(side) for side in pair)
            if not sides:
                raise InputError(pair[0][0], None, f"is missing; give {both}")
            if len(sides) > 1:
                raise InputError(sides[1][0], None, f"must not be given twice over; give {both}")
            for name in sides[0]:
                if name not in self.model_fields_set:
                    raise InputError(name, None, "is missing")
        return self


class FixedTrim(Section):
    collective: Angle


def _read_trim(raw: Any) -> str | FixedTrim:
    if raw == "windmill":
        return raw
    if not isinstance(raw, dict) or set(raw) != {"collective"}:
        raise InputError("", raw, 'must be "windmill" or { collective = "30 deg" }')
    try:
        return FixedTrim.model_construct(collective=read_quantity(raw["collective"], "rad"))
    except InputError as error:
        raise error.within("collective") from None


class OperationSection(Section):
    rotor_speed: RotorSpeed
    density: Density
    speed_of_sound: Speed
    trim: Annotated[Any, PlainValidator(_read_trim)] = "windmill"


class Deck(Section):
    case: CaseSection
    rotor: RotorSection
    operation: OperationSection
    support: SupportSection


_SECTIONS: dict[tuple[str, ...], type[Section]] = {
    (): Deck,
    ("case",): CaseSection,
    ("rotor",): RotorSection,
    ("rotor", "airfoil"): AirfoilSection,
    ("operation",): OperationSection,
    **{("support", *place): section for place, section in SUPPORT_TABLES.items()},
}

# How a message states what pydantic found, by pydantic's name for it.
_RULES = {
    "model_type": "must be a table",
    "model_attributes_type": "must be a table",
    "dict_type": "must be a table",
    "int_type": "must be a whole number",
    "list_type": "must be a list",
    "string_type": "must be text",
    "bool_type": "must be true or false",
    "too_short": "must not be empty",
    "string_too_short": "must not be empty",
    "string_pattern_mismatch": "must be letters, digits, spaces, dots, dashes and underscores",
}


def validate(tables: dict[str, Any]) -> Deck:
    """The tables of a TOML file as a deck.

    Raises
    ------
    InputError
        With every problem found, one line each.
    """
    try:
        return Deck.model_validate(tables)
    except ValidationError as error:
        first, *others = [_input_error(problem, tables) for problem in error.errors(include_url=False)]
        raise InputError(first.field, first.value, first.rule, others) from None


def _input_error(problem: Any, tables: dict[str, Any]) -> InputError:
    place, kind = problem["loc"], problem["type"]
    field = field_name(_in_the_deck(place), tables)
    if kind == "value_error":
        return problem["ctx"]["error"].within(field)
    if kind == "extra_forbidden":
        known = _SECTIONS[tuple(part for part in place[:-1] if isinstance(part, str))].model_fields
        return InputError(field, problem["input"], unknown_name(str(place[-1]), known))
    if kind == "literal_error":
        return InputError(field, problem["input"], f"must be {problem['ctx']['expected']}")
    if kind in ("missing", "union_tag_not_found"):
        return InputError(field if kind == "missing" else f"{field}.kind", None, "is missing")
    if kind == "union_tag_invalid":
        rule = f"must be {', '.join(map(repr, SUPPORT_KINDS))}"
        return InputError(f"{field}.kind", problem["ctx"]["tag"], rule)
    return InputError(field, problem["input"], _RULES.get(kind, problem["msg"]))


def _in_the_deck(place: tuple[str | int, ...]) -> tuple[str | int, ...]:
    """A place without the kind of support, which pydantic puts in."""
    return (place[0], *place[2:]) if place[:1] == ("support",) and len(place) > 1 else place


def field_name(place: tuple[str | int, ...], tables: Any) -> str:
    """``("support", "modes", 0, "x")`` as ``support.modes[beam].x``, an entry of a list by its name."""
    text = ""
    for part in place:
        tables = tables[part] if not isinstance(tables, dict) or part in tables else None
        if isinstance(part, str):
            text += f".{part}" if text else part
        else:
            name = tables.get("name") if isinstance(tables, dict) else None
            text += f"[{name if isinstance(name, str) and name else part}]"
    return text


def _listed(names: tuple[str, ...]) -> str:
    return names[0] if len(names) == 1 else f"({', '.join(names)})"
