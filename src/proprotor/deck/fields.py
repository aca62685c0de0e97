"""Types of the fields of a deck: what a value must be, in which unit, and how it is read.

A type says it once: the reader, the documentation (`proprotor.deck.describe`) and the JSON schema
(`proprotor.deck.schema`) all ask the `Reading` of the field.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from pydantic import BaseModel, ConfigDict, Field, StringConstraints, ValidationInfo
from pydantic_core import CoreSchema, core_schema

from proprotor.datum import Datum
from proprotor.deck.reading import (
    ANY,
    BELOW_CRITICAL,
    FRACTION,
    NOT_NEGATIVE,
    POSITIVE,
    Bound,
    read_choice,
    read_column,
    read_count,
    read_curve,
    read_distribution,
    read_file,
    read_frequency,
    read_list,
    read_profile,
    read_quantity,
)
from proprotor.errors import InputError
from proprotor.rotor.rotor import HELD, NOTHING
from proprotor.support.normal_modes import INCLUDES_ROTOR, SHAFT


def read_spanwise(raw: Any, unit: str, bound: Bound = ANY) -> Datum:
    """One number for the whole wing, or a table ``{ y_over_span, value, unit, status, source }`` along it."""
    if not isinstance(raw, dict) or "y_over_span" not in raw:
        return read_quantity(raw, unit, bound)
    try:
        table = {"r_over_R" if key == "y_over_span" else key: entry for key, entry in raw.items()}
        return read_distribution(table, unit, bound)
    except InputError as error:
        field = error.field.replace("r_over_R", "y_over_span")
        rule = error.rule.replace("r_over_R", "y_over_span").replace("centre of rotation", "mount")
        raise InputError(field, error.value, rule) from None


_READERS: dict[str, Callable[..., Datum]] = {
    "number": read_quantity,
    "frequency": lambda raw, unit, bound: read_frequency(raw, bound),
    "along the blade": read_profile,
    "distribution": read_distribution,
    "along the wing": read_spanwise,
    "curve": read_curve,
    "rising list": read_list,
    "file": lambda raw, unit, bound: read_file(raw),
}


@dataclass(frozen=True)
class Reading:
    """How a field that becomes a `Datum` is read.

    Parameters
    ----------
    form : str
        "number", "count", "frequency", "along the blade", "distribution" (along the blade, never one number),
        "along the wing", "curve" (one number or a list of them), "rising list", "file" or "choice".
    unit : str
        SI unit.
    bound : Bound
    least : int
        Of a count.
    choices : tuple of str or bool
        Of a choice.
    beyond : str
        What a distribution along the blade may say of the blade beyond its stations.
    """

    form: str
    unit: str = ""
    bound: Bound = ANY
    least: int = 0
    choices: tuple[bool | str, ...] = ()
    beyond: str = ""

    def read(self, raw: Any) -> Datum:
        """The value of a field.

        Raises
        ------
        InputError
            With the field's name left to who calls.
        """
        if self.form == "count":
            return read_count(raw, self.least)
        if self.form == "choice":
            return read_choice(raw, self.choices)
        if self.beyond:
            return _READERS[self.form](raw, self.unit, self.bound, self.beyond)
        return _READERS[self.form](raw, self.unit, self.bound)

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: Any) -> dict[str, Any]:
        from proprotor.deck.schema import value_schema

        return value_schema(self)


@dataclass(frozen=True)
class ByCoordinate(Reading):
    """A quantity whose unit follows the mode's coordinate, a field that is read before it.

    Parameters
    ----------
    unit : str
        SI unit where the coordinate is a length.
    of_angle : str
        SI unit where it is an angle.
    """

    of_angle: str = ""

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        def read(raw: Any, info: ValidationInfo) -> Datum | None:
            if "coordinate" not in info.data:  # itself wrong, and reported
                return None
            length = info.data["coordinate"] == "length"
            return read_quantity(raw, self.unit if length else self.of_angle, self.bound)

        return core_schema.with_info_plain_validator_function(read)


@dataclass(frozen=True)
class ByAbscissa(Reading):
    """Where a curve has its values, whose unit follows what it is against, a field that is read before.

    Parameters
    ----------
    unit : str
        SI unit against the collective.
    of_speed : str
        SI unit against the airspeed.
    """

    of_speed: str = ""

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        def read(raw: Any, info: ValidationInfo) -> Datum | None:
            if "against" not in info.data:  # itself wrong, and reported
                return None
            unit = self.unit if info.data["against"] == "collective" else self.of_speed
            return read_list(raw, unit, self.bound, rising=True)

        return core_schema.with_info_plain_validator_function(read)


class AlongTheBlade(Reading):
    """Values at blade stations, which may stand in a file, there perhaps by r: hence the radius is read before."""

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        def read(raw: Any, info: ValidationInfo) -> Datum | None:
            if not isinstance(raw, dict) or not {"file", "column"}.intersection(raw):
                return self.read(raw)
            if info.data.get("radius") is None:  # itself wrong or missing, and reported
                return None
            return read_column(raw, self.unit, self.bound, info.data["radius"].si, self.beyond)

        return core_schema.with_info_plain_validator_function(read)


Number = Annotated[Datum | None, Reading("number")]
NotNegative = Annotated[Datum | None, Reading("number", "", NOT_NEGATIVE)]
Positive = Annotated[Datum | None, Reading("number", "", POSITIVE)]
Fraction = Annotated[Datum | None, Reading("number", "", FRACTION)]
Angle = Annotated[Datum | None, Reading("number", "rad")]
Length = Annotated[Datum | None, Reading("number", "m", NOT_NEGATIVE)]
PositiveLength = Annotated[Datum | None, Reading("number", "m", POSITIVE)]
Offset = Annotated[Datum | None, Reading("number", "m")]
Mass = Annotated[Datum | None, Reading("number", "kg", POSITIVE)]
MassOrNone = Annotated[Datum | None, Reading("number", "kg", NOT_NEGATIVE)]
FirstMoment = Annotated[Datum | None, Reading("number", "kg*m", NOT_NEGATIVE)]
Inertia = Annotated[Datum | None, Reading("number", "kg*m**2", POSITIVE)]
InertiaOrNone = Annotated[Datum | None, Reading("number", "kg*m**2", NOT_NEGATIVE)]
PositiveStiffness = Annotated[Datum | None, Reading("number", "N*m/rad", POSITIVE)]
Stiffness = Annotated[Datum | None, Reading("number", "N*m/rad", NOT_NEGATIVE)]
Damping = Annotated[Datum | None, Reading("number", "N*m*s/rad", NOT_NEGATIVE)]
Slope = Annotated[Datum | None, Reading("number", "1/rad", POSITIVE)]
RotorSpeed = Annotated[Datum, Reading("number", "rad/s", POSITIVE)]
Density = Annotated[Datum | None, Reading("number", "kg/m**3", NOT_NEGATIVE)]
Speed = Annotated[Datum | None, Reading("number", "m/s", POSITIVE)]
DampingRatio = Annotated[Datum | None, Reading("number", "", BELOW_CRITICAL)]
Frequency = Annotated[Datum | None, Reading("frequency", "rad/s", NOT_NEGATIVE)]
Count = Annotated[Datum | None, Reading("count", least=3)]
Size = Annotated[Datum | None, Reading("count", least=1)]
Chord = Annotated[Datum | None, AlongTheBlade("along the blade", "m", POSITIVE, beyond=HELD)]
Twist = Annotated[Datum | None, AlongTheBlade("along the blade", "rad", beyond=HELD)]
MassDistribution = Annotated[
    Datum | None, AlongTheBlade("distribution", "kg/m", NOT_NEGATIVE, beyond=NOTHING)
]
TemperatureDifference = Annotated[Datum | None, Reading("number", "K")]
CurvePerRev = Annotated[Datum | None, Reading("curve", "", POSITIVE)]
Abscissa = Annotated[Datum | None, ByAbscissa("rising list", "rad", of_speed="m/s")]
File = Annotated[Datum | None, Reading("file")]
IncludesRotor = Annotated[Datum, Reading("choice", choices=INCLUDES_ROTOR)]
Shaft = Annotated[Datum | None, Reading("choice", choices=SHAFT)]

GeneralizedMass = Annotated[Datum | None, ByCoordinate("number", "kg", POSITIVE, of_angle="kg*m**2")]
HubDisplacement = Annotated[Datum | None, ByCoordinate("number", "", of_angle="m/rad")]
HubRotation = Annotated[Datum | None, ByCoordinate("number", "rad/m", of_angle="")]

BendingStiffness = Annotated[Datum | None, Reading("along the wing", "N*m**2", POSITIVE)]
AxialStiffness = Annotated[Datum | None, Reading("along the wing", "N", POSITIVE)]
MassPerLength = Annotated[Datum | None, Reading("along the wing", "kg/m", NOT_NEGATIVE)]
InertiaPerLength = Annotated[Datum | None, Reading("along the wing", "kg*m**2/m", NOT_NEGATIVE)]

Text = Annotated[str, StringConstraints(min_length=1, max_length=2000)]
Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9][A-Za-z0-9 _.-]*$", max_length=60)]

Sides = tuple[tuple[str, ...], ...]  # of each choice, the fields of every side


class Section(BaseModel):
    """A table of a deck: no field of another type, none unknown."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)

    alternatives: ClassVar[tuple[Sides, ...]] = ()  # of each, the fields of one side only
    needed_unless_replaced: ClassVar[tuple[str, ...]] = ()  # those a deck must have, or their alternatives


def needed(meaning: str) -> Any:
    """A field that must be given, or may have to be (see `Section.alternatives`), and what it means."""
    return Field(description=meaning)


def optional(meaning: str, default: Any = None) -> Any:
    """A field that may be left out, and what it means."""
    return Field(default=default, description=meaning)
