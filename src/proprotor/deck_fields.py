"""Types of the fields of a deck: what a value must be, in which unit, and how it is read."""

from __future__ import annotations

from functools import partial
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, PlainValidator, StringConstraints, ValidationInfo

from proprotor.datum import (
    ANY,
    BELOW_CRITICAL,
    FRACTION,
    NOT_NEGATIVE,
    POSITIVE,
    Bound,
    Datum,
    read_count,
    read_distribution,
    read_file,
    read_frequency,
    read_profile,
    read_quantity,
)
from proprotor.errors import InputError


def read_by(reader: Any, *args: Any) -> Any:
    """A field that a reader of `proprotor.datum` reads."""
    return Annotated[Datum | None, PlainValidator(lambda raw: reader(raw, *args))]


quantity = partial(read_by, read_quantity)

Number = quantity("", ANY)
NotNegative = quantity("", NOT_NEGATIVE)
Positive = quantity("", POSITIVE)
Fraction = quantity("", FRACTION)
Angle = quantity("rad", ANY)
Length = quantity("m", NOT_NEGATIVE)
PositiveLength = quantity("m", POSITIVE)
Mass = quantity("kg", POSITIVE)
FirstMoment = quantity("kg*m", NOT_NEGATIVE)
Inertia = quantity("kg*m**2", POSITIVE)
InertiaOrNone = quantity("kg*m**2", NOT_NEGATIVE)
PositiveStiffness = quantity("N*m/rad", POSITIVE)
Stiffness = quantity("N*m/rad", NOT_NEGATIVE)
Damping = quantity("N*m*s/rad", NOT_NEGATIVE)
Slope = quantity("1/rad", POSITIVE)
RotorSpeed = quantity("rad/s", POSITIVE)
Density = quantity("kg/m**3", NOT_NEGATIVE)
Speed = quantity("m/s", POSITIVE)
DampingRatio = quantity("", BELOW_CRITICAL)
Frequency = read_by(read_frequency)
Count = read_by(read_count, 3)
Size = read_by(read_count, 1)
Chord = read_by(read_profile, "m", POSITIVE)
Twist = read_by(read_profile, "rad", ANY)
File = read_by(read_file)
MassOrNone = quantity("kg", NOT_NEGATIVE)
Offset = quantity("m", ANY)
MassDistribution = read_by(read_distribution, "kg/m", NOT_NEGATIVE)

Text = Annotated[str, StringConstraints(min_length=1, max_length=2000)]
Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9][A-Za-z0-9 _.-]*$", max_length=60)]


def _by_coordinate(of_length: str, of_angle: str, bound: Bound = ANY) -> Any:
    """A quantity whose unit follows the mode's coordinate, a field that must be read before it."""

    def read(raw: Any, info: ValidationInfo) -> Datum | None:
        if "coordinate" not in info.data:  # itself wrong, and reported
            return None
        return read_quantity(raw, of_length if info.data["coordinate"] == "length" else of_angle, bound)

    return Annotated[Datum | None, PlainValidator(read)]


GeneralizedMass = _by_coordinate("kg", "kg*m**2", POSITIVE)
HubDisplacement = _by_coordinate("", "m/rad")
HubRotation = _by_coordinate("rad/m", "")


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


BendingStiffness = read_by(read_spanwise, "N*m**2", POSITIVE)
AxialStiffness = read_by(read_spanwise, "N", POSITIVE)
MassPerLength = read_by(read_spanwise, "kg/m", NOT_NEGATIVE)
InertiaPerLength = read_by(read_spanwise, "kg*m**2/m", NOT_NEGATIVE)


class Section(BaseModel):
    """A table of a deck: no field of another type, none unknown."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)
