"""Coordinates, loads and motions of the equations: each is declared here, once, with what it stands for.

A record says which angle or displacement a coordinate is a part of, with which harmonic, and in which unit; which
section load a load of a segment comes from, and with which power of the radius. Nothing else is read out of a name.
`proprotor_equations.coordinates` holds the same records.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeVar

from derive.symbols import Dimension, dimension_of_unit


@dataclass(frozen=True)
class Named:
    """What has a name and a unit."""

    name: str
    unit: str

    @property
    def dimension(self) -> Dimension:
        return dimension_of_unit(self.unit)


@dataclass(frozen=True)
class Coordinate(Named):
    """A coordinate, or an input (gust, swashplate) that stands in the equations as a coordinate does.

    angle is the motion the coordinate is a part of; harmonic, how often that motion passes through zero in a turn, as
    one blade sees it; part, whether it goes with the cosine ("c") or the sine ("s") of that many azimuths.
    """

    angle: str
    harmonic: int | str = 0
    part: str = ""


@dataclass(frozen=True)
class Load(Named):
    """A generalised load of a segment: the integral of a section load times a power of the radius."""

    section_load: str
    axis: str
    power: int


@dataclass(frozen=True)
class Motion(Named):
    """A motion of the air along a segment, at r = 0 or per unit radius, or a turn of the segment's sections.

    argument is the argument of the section loads that it changes; axis, the section axis of a velocity.
    """

    argument: str
    axis: str
    power: int


# One blade, resolved in rotating axes. Hub rotation and gimbal tilt are exponential coordinates.
BLADE = (
    *(Coordinate(f"hub_{axis}", "m", "hub") for axis in "ijk"),
    *(Coordinate(f"turn_{axis}", "rad", "turn") for axis in "ijk"),
    *(Coordinate(angle, "rad", angle) for angle in ("flap", "lag", "pitch", "azimuth")),
    Coordinate("gimbal_flap", "rad", "gimbal"),
    Coordinate("gimbal_roll", "rad", "gimbal"),
)

BLADE_ANGLES = ("flap", "lag", "pitch")  # each blade's own; in the fixed frame they are collective and cyclic

# The rotor in the fixed frame, Eq. 17.
FIXED = (
    *(Coordinate(axis, "m", "hub", harmonic) for axis, harmonic in (("x", 1), ("y", 1), ("z", 0))),
    *(
        Coordinate(f"alpha_{axis}", "rad", "turn", harmonic)
        for axis, harmonic in (("x", 1), ("y", 1), ("z", 0))
    ),
    *(
        Coordinate(f"{angle}_{harmonic}{part}", "rad", angle, harmonic, part)
        for angle in BLADE_ANGLES
        for harmonic, part in ((0, ""), (1, "c"), (1, "s"))
    ),
    Coordinate("azimuth", "rad", "azimuth"),
    *(Coordinate(f"gimbal_1{part}", "rad", "gimbal", 1, part) for part in "cs"),
)

# Motions of the blades in which nothing reaches the hub: harmonics 2 and above below N/2 come in pairs, and for even N
# neighbouring blades may move against each other.
REACTIONLESS_PAIR = tuple(
    Coordinate(f"{angle}_n{part}", "rad", angle, "n", part) for angle in BLADE_ANGLES for part in "cs"
)
DIFFERENTIAL = tuple(Coordinate(f"{angle}_d", "rad", angle, "N/2") for angle in BLADE_ANGLES)

# Inputs: gusts along a blade's axes and in the fixed frame, and the swashplate.
BLADE_GUSTS = tuple(Coordinate(f"gust_{axis}", "m/s", "gust") for axis in "ijk")
FIXED_GUSTS = tuple(
    Coordinate(f"gust_{axis}", "m/s", "gust", harmonic) for axis, harmonic in (("x", 1), ("y", 1), ("z", 0))
)
SWASHPLATE = (
    Coordinate("collective", "rad", "pitch"),
    *(Coordinate(f"cyclic_1{part}", "rad", "pitch", 1, part) for part in "cs"),
)

INPUTS = (*SWASHPLATE, *FIXED_GUSTS)

# Induced velocity through the disk: uniform, and growing with the distance from the diameter about which it turns over.
# A blade sees the latter two as it sees the flap and the roll of a gimbal.
BLADE_INFLOW = tuple(
    Coordinate(f"inflow_{part}", "m/s", "inflow") for part in ("uniform", "outward", "aside")
)
FIXED_INFLOW = (
    Coordinate("inflow_0", "m/s", "inflow"),
    *(Coordinate(f"inflow_1{part}", "m/s", "inflow", 1, part) for part in "cs"),
)

# A straight segment of the blade between its hinges, in section axes.
SECTION_AXES = ("x", "n", "d")
SEGMENT_LOADS = (
    *(Load(f"{axis}_0", "N", f"f{axis}", axis, 0) for axis in SECTION_AXES),
    *(Load(f"{axis}_1", "N m", f"f{axis}", axis, 1) for axis in SECTION_AXES),
    Load("rotation", "N m", "m", "", 0),
)
_VELOCITIES = tuple(zip(("ut", "up", "ur"), SECTION_AXES, strict=True))
SEGMENT_MOTIONS = (
    *(Motion(f"{name}_0", "m/s", name, axis, 0) for name, axis in _VELOCITIES),
    *(Motion(f"{name}_1", "1/s", name, axis, 1) for name, axis in _VELOCITIES),
    Motion("spin", "rad/s", "spin", "", 0),
    Motion("theta", "rad", "theta", "", 0),
)

Record = TypeVar("Record", bound=Named)


def names(records: Iterable[Named]) -> tuple[str, ...]:
    return tuple(record.name for record in records)


def by_name(*lists: Iterable[Record]) -> dict[str, Record]:
    return {record.name: record for records in lists for record in records}


COORDINATE = by_name(
    *(BLADE, FIXED, REACTIONLESS_PAIR, DIFFERENTIAL, BLADE_GUSTS, FIXED_GUSTS, SWASHPLATE),
    *(BLADE_INFLOW, FIXED_INFLOW),
)  # a name that two lists have is the same motion in both
# Motions in pairs that a quarter turn of the rotor carries into each other, each with the other.
PARTNER = {
    one.name: other.name
    for motions in (FIXED, REACTIONLESS_PAIR, FIXED_GUSTS, SWASHPLATE)
    for one in motions
    for other in motions
    if one != other and one.harmonic and (one.angle, one.harmonic) == (other.angle, other.harmonic)
}
# Turns of the whole blade by shaft and gimbal, each with the turn of the hub that moves the blade alike.
SAME_TURN = {"azimuth": "turn_k", "gimbal_flap": "turn_i", "gimbal_roll": "turn_j"}
LOAD, MOTION = by_name(SEGMENT_LOADS), by_name(SEGMENT_MOTIONS)

# The lists that the generated module has, with what each is.
LISTS = {
    "BLADE": "Coordinates of one blade in rotating axes, in the order of its matrices.",
    "FIXED": "Coordinates of the rotor in the fixed frame, Eq. 17 of AIAA-2002-1604.",
    "REACTIONLESS_PAIR": "Motions of the blades of a harmonic n, 2 to below N/2, that do not reach the hub.",
    "DIFFERENTIAL": "Motions of neighbouring blades against each other, for even N.",
    "BLADE_GUSTS": "Gusts along a blade's axes.",
    "FIXED_GUSTS": "Gusts in the fixed frame.",
    "SWASHPLATE": "Motions of the swashplate.",
    "BLADE_INFLOW": "Induced velocity that one blade sees.",
    "FIXED_INFLOW": "Induced velocity of the rotor: uniform, and its first harmonics.",
    "SEGMENT_LOADS": "Generalised loads of a segment, rows of L and W.",
    "SEGMENT_MOTIONS": "Motions along a segment, columns of L and rows of U.",
}
