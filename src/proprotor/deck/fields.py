"""Types of the fields of a deck: the form of a value, its unit, and how to read it.

Each type is declared once. The documentation (`proprotor.deck.describe`) and the JSON schema (`proprotor.deck.schema`)
walk the fields and ask the `Reading` of each.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Annotated, Any, ClassVar

from pydantic import BaseModel, ConfigDict, Field, StringConstraints
from pydantic_core import CoreSchema, core_schema

from proprotor.datum import Datum
from proprotor.deck import reading, reading_lists
from proprotor.deck.reading import ANY, BELOW_CRITICAL, FRACTION, NOT_NEGATIVE, POSITIVE, Bound
from proprotor.rotor.rotor import HELD, NOTHING
from proprotor.support.aircraft_structure import JOINT
from proprotor.support.normal_modes import CARRIES, INCLUDES_ROTOR, SHAFT


@dataclass(frozen=True)
class Reading:
    """How to read a field that becomes a `Datum`.

    Parameters
    ----------
    form : str
        "number", "tangent" (a number, or the angle of which it is the tangent), "count", "joint" (a number or a
        choice), "frequency", "along the blade", "distribution" (along the blade, never one number), "along the wing",
        "curve" (one number or a list of them), "rising list", "file", "files" (one file or a list of them) or
        "choice".
    unit : str
        SI unit.
    bound : Bound
    least : int
        Smallest count.
    choices : tuple of str or bool
        Possible choices.
    beyond : str
        Word that a distribution along the blade may have for the blade beyond its stations.
    """

    form: str
    unit: str = ""
    bound: Bound = ANY
    least: int = 0
    choices: tuple[bool | str, ...] = ()
    beyond: str = ""

    def read(self, raw: Any) -> Datum:
        """Return the number of a field.

        Raises
        ------
        InputError
            For a malformed value; the caller adds the name of the field.
        """
        return _READERS[self.form](raw, self)

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        return core_schema.with_info_plain_validator_function(
            lambda raw, info: self.read_after(raw, info.data), metadata={"reading": self}
        )

    def read_after(self, raw: Any, before: Mapping[str, Any]) -> Datum | None:
        """Return the number of a field, given the fields of its section that were read before.

        Return None where the unit follows from an earlier field that is malformed: that error is reported already.
        """
        return self.read(raw)

    def unit_after(self, before: Mapping[str, Any]) -> str:
        """Return the SI unit, given the fields of its section."""
        return self.unit


_READERS: dict[str, Callable[[Any, Reading], Datum]] = {
    "number": lambda raw, field: reading.read_quantity(raw, field.unit, field.bound),
    "tangent": lambda raw, field: reading.read_tangent(raw),
    "count": lambda raw, field: reading.read_count(raw, field.least),
    "choice": lambda raw, field: reading.read_choice(raw, field.choices),
    "joint": lambda raw, field: reading.read_joint(raw, field.unit, field.bound, field.choices),
    "frequency": lambda raw, field: reading.read_frequency(raw, field.bound),
    "along the blade": lambda raw, field: reading_lists.read_profile(
        raw, field.unit, field.bound, field.beyond
    ),
    "distribution": lambda raw, field: reading_lists.read_distribution(
        raw, field.unit, field.bound, field.beyond
    ),
    "along the wing": lambda raw, field: reading_lists.read_spanwise(raw, field.unit, field.bound),
    "curve": lambda raw, field: reading_lists.read_curve(raw, field.unit, field.bound),
    "rising list": lambda raw, field: reading_lists.read_list(raw, field.unit, field.bound, rising=True),
    "file": lambda raw, field: reading.read_file(raw),
    "files": lambda raw, field: reading.read_files(raw),
}


@dataclass(frozen=True)
class AfterChoice(Reading):
    """A number or a list whose unit follows from a choice, an earlier field.

    Parameters
    ----------
    unit : str
        SI unit where the earlier field has the word `usual`.
    choice : str
        Name of the earlier field.
    usual : str
    other_unit : str
        SI unit where the earlier field has another word.
    """

    choice: str = ""
    usual: str = ""
    other_unit: str = ""

    def read_after(self, raw: Any, before: Mapping[str, Any]) -> Datum | None:
        """Return the value in the unit that follows from the earlier field."""
        if self.choice not in before:
            return None
        return replace(self, unit=self.unit_after(before)).read(raw)

    def unit_after(self, before: Mapping[str, Any]) -> str:
        """Return the SI unit that follows from the earlier field."""
        return self.unit if before[self.choice] == self.usual else self.other_unit


class _AlongTheBlade(Reading):
    """Values at blade stations, perhaps in a file with stations in units of length: the radius is an earlier field."""

    def read_after(self, raw: Any, before: Mapping[str, Any]) -> Datum | None:
        """Return the values of a table, or of the file that the table names."""
        if not isinstance(raw, dict) or not {"file", "column"}.intersection(raw):
            return self.read(raw)
        if before.get("radius") is None:
            return None
        return reading_lists.read_column(raw, self.unit, self.bound, before["radius"].si, self.beyond)


Number = Annotated[Datum | None, Reading("number")]
NotNegative = Annotated[Datum | None, Reading("number", "", NOT_NEGATIVE)]
Positive = Annotated[Datum | None, Reading("number", "", POSITIVE)]
Fraction = Annotated[Datum | None, Reading("number", "", FRACTION)]
Angle = Annotated[Datum | None, Reading("number", "rad")]
Tangent = Annotated[Datum | None, Reading("tangent")]
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
Time = Annotated[Datum | None, Reading("number", "s", POSITIVE)]
Speed = Annotated[Datum | None, Reading("number", "m/s", POSITIVE)]
EquivalentSpeed = Annotated[Datum | None, Reading("number", "keas", POSITIVE)]
Altitudes = Annotated[Datum | None, Reading("rising list", "m")]
RotorSpeeds = Annotated[Datum | None, Reading("rising list", "rad/s", POSITIVE)]
Powers = Annotated[Datum | None, Reading("rising list", "W")]
DampingRatio = Annotated[Datum | None, Reading("number", "", BELOW_CRITICAL)]
DampingRatios = Annotated[Datum | None, Reading("curve", "", BELOW_CRITICAL)]
Positives = Annotated[Datum | None, Reading("curve", "", POSITIVE)]
PositiveFrequency = Annotated[Datum | None, Reading("frequency", "rad/s", POSITIVE)]
Frequency = Annotated[Datum | None, Reading("frequency", "rad/s", NOT_NEGATIVE)]
Count = Annotated[Datum | None, Reading("count", least=3)]
Size = Annotated[Datum | None, Reading("count", least=1)]
Chord = Annotated[Datum | None, _AlongTheBlade("along the blade", "m", POSITIVE, beyond=HELD)]
Twist = Annotated[Datum | None, _AlongTheBlade("along the blade", "rad", beyond=HELD)]
PlaceOnChord = Annotated[Datum | None, _AlongTheBlade("along the blade", "m", beyond=HELD)]
MassDistribution = Annotated[
    Datum | None, _AlongTheBlade("distribution", "kg/m", NOT_NEGATIVE, beyond=NOTHING)
]
TemperatureDifference = Annotated[Datum | None, Reading("number", "K")]
CurvePerRev = Annotated[Datum | None, Reading("curve", "", POSITIVE)]
Abscissa = Annotated[
    Datum | None,
    AfterChoice("rising list", "rad", choice="against", usual="collective", other_unit="m/s"),
]
Airspeeds = Annotated[Datum | None, Reading("rising list", "m/s")]
File = Annotated[Datum | None, Reading("file")]
Slopes = Annotated[Datum | None, Reading("curve", "1/rad", POSITIVE)]
Angles = Annotated[Datum | None, Reading("curve", "rad")]
NotNegatives = Annotated[Datum | None, Reading("curve", "", NOT_NEGATIVE)]
Numbers = Annotated[Datum | None, Reading("curve")]
Fractions = Annotated[Datum | None, Reading("curve", "", FRACTION)]
Files = Annotated[Datum | None, Reading("files")]
IncludesRotor = Annotated[Datum, Reading("choice", choices=INCLUDES_ROTOR)]
Shaft = Annotated[Datum | None, Reading("choice", choices=SHAFT)]
Held = Annotated[
    Datum | None, Reading("choice", choices=tuple(held for held in INCLUDES_ROTOR if isinstance(held, str)))
]
Carries = Annotated[Datum | None, Reading("choice", choices=CARRIES)]

_of_mode = partial(AfterChoice, "number", choice="coordinate", usual="length")
GeneralizedMass = Annotated[Datum | None, _of_mode("kg", POSITIVE, other_unit="kg*m**2")]
HubDisplacement = Annotated[Datum | None, _of_mode("", other_unit="m/rad")]
HubRotation = Annotated[Datum | None, _of_mode("rad/m", other_unit="")]

BendingStiffness = Annotated[Datum | None, Reading("along the wing", "N*m**2", POSITIVE)]
AxialStiffness = Annotated[Datum | None, Reading("along the wing", "N", POSITIVE)]
MassPerLength = Annotated[Datum | None, Reading("along the wing", "kg/m", NOT_NEGATIVE)]
InertiaPerLength = Annotated[Datum | None, Reading("along the wing", "kg*m**2/m", NOT_NEGATIVE)]
OffsetOfMass = Annotated[Datum | None, Reading("along the wing", "m")]

UniformStiffness = Annotated[Datum | None, Reading("number", "N*m**2", POSITIVE)]
UniformAxialStiffness = Annotated[Datum | None, Reading("number", "N", POSITIVE)]
UniformMass = Annotated[Datum | None, Reading("number", "kg/m", NOT_NEGATIVE)]
UniformInertia = Annotated[Datum | None, Reading("number", "kg*m**2/m", NOT_NEGATIVE)]
ProductOfInertia = Annotated[Datum | None, Reading("number", "kg*m**2")]
Area = Annotated[Datum | None, Reading("number", "m**2", POSITIVE)]
Joint = Annotated[Datum | None, Reading("joint", "N*m/rad", POSITIVE, choices=JOINT)]

Text = Annotated[str, StringConstraints(min_length=1, max_length=2000)]
Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9][A-Za-z0-9 _.-]*$", max_length=60)]

Sides = tuple[tuple[str, ...], ...]  # the fields of every side of a choice


class Section(BaseModel):
    """A table of a deck, without fields of a wrong type and without unknown fields."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)

    alternatives: ClassVar[tuple[Sides, ...]] = ()  # choices of which a deck gives one side
    may_lack: ClassVar[tuple[str, ...]] = ()  # fields of these choices that a deck may leave out
    needs: ClassVar[Mapping[str, str]] = {}  # fields that have a meaning beside another field alone
    defaults: ClassVar[
        Mapping[str, float]
    ] = {}  # SI values of fields left out, beside those of a class of the model


def needed(meaning: str) -> Any:
    """Return a field that a deck must give, unless the deck gives an alternative, with the meaning of the field."""
    return Field(description=meaning)


def optional(meaning: str, default: Any = None) -> Any:
    """Return a field that a deck may leave out, with the meaning of the field."""
    return Field(default=default, description=meaning)
