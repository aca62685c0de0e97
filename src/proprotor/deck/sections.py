"""The sections and fields of a deck, with the meaning and the form of each.

`proprotor describe` and docs/decks.md list all fields, from the definitions in this file.

A deck is a TOML file. A number with a dimension is text with its unit, ``radius = "12.5 ft"``, US or SI; a number
without a dimension is plain. Either may be a table that names its source::

    radius = { value = "12.5 ft", status = "published", source = "AIAA-2002-1604, Table 1" }

with a status of published, measured, derived, recalled, calibrated or assumed, see `default_status` of [case] for a
status of all numbers of a file. Chord and twist take one value (twist:
the linear change from centre to tip) or a distribution ``{ r_over_R = [...], value = [...], unit = "deg" }``,
linear between its stations, as mass_offset and aerodynamic_center do; all of these and mass_distribution may also be a
column of a CSV file, ``{ file = "stations.csv", column = "twist" }`` (`proprotor.deck.stations`).

Stations of chord, twist and aerodynamic_center reach from the root cutout to the tip, or their table says
``beyond = "held"``: the end values hold there. Stations of mass_distribution reach from the centre of rotation, or with
hub_mass from anywhere, to the tip, or their table says ``beyond = "nothing"``: no mass there.

``base``
    Above all sections: the deck that this deck alters, a bundled name or a file in the same folder. A field of this
    deck replaces the field of the base; one of two alternatives removes the other.
``[case]``
    name, title, description, calibration (which inputs to which result), warnings; default_status and default_source:
    the status and the source of every number of this file that states no status, not of its base and its variants.
``[rotor]``
    The arguments of `proprotor.Rotor`, or instead of flap_stiffness and lag_stiffness: flap_frequency and
    lag_frequency, non-rotating, K = I ω²; of chord: lock_number γ, chord = γ I_b / (ρ c_lα R⁴) at the
    deck's density; of the seven mass integrals: mass_distribution.
``[rotor.airfoil]``
    The arguments of `proprotor.Airfoil`, or instead: table, a C81 file, whose name starts from the deck's folder. With
    region_ends, ``{ value = [0.55, 0.80] }`` in r/R, there are several airfoils along the span, and each field may be a
    list with a value for each region from the root outward: ``moment = { value = [-0.08, -0.01, -0.02] }``, or of
    files,
    ``table = ["root.c81", "middle.c81", "tip.c81"]``. blend is the width across which one passes into the next.
``[rotor.frequencies]``
    Optional; the arguments of `proprotor.BladeFrequencies`: at_rotor_speed, at which the blade has the frequencies;
    against, "collective" or "airspeed"; at, a table ``{ value = [0, 20, 40], unit = "deg" }``; flap, lag and perhaps
    cyclic_flap, rotating, per revolution of at_rotor_speed, one number or a table ``{ value = [1.9, 1.8, 1.7] }`` with
    a value for each of at; pitch_coupling. The model has structure="tabulated", with springs that follow from the
    frequencies and hold at any rotor speed.
``[operation]``
    rotor_speed, trim = "windmill" or { collective = "30 deg" }, { thrust_coefficient = 0.008 },
    { power_coefficient = 0.01 }; density and speed_of_sound, or instead: altitude, a pressure altitude in the
    standard atmosphere, and temperature_offset (`proprotor.rotor.atmosphere`).
``[drive_train]``
    Optional; the arguments of `proprotor.DriveTrain`: drive_inertia, drive_damping, shaft_stiffness, mast_stiffness,
    engine_inertia, engine_damping and, of an aircraft, interconnect_stiffness.
``[control]``
    Optional; control loops that every result has closed, a table ``[[control.loops]]`` each:
    `proprotor.deck.control_sections` lists the fields.
``[support]``
    kind and the fields of that kind: `proprotor.deck.support_sections` lists them.

``[left]``
    Optional, for a support of kind "aircraft": fields that differ on the left side, ``support.downstop = false`` or
    ``rotor.control_stiffness = "8000 ft*lbf/rad"``; of [rotor] all but the number of blades and the radius, of
    [operation] the trim, of [drive_train] all but the interconnect shaft, and of [support] the wing, the
    carry-through box, the pylon and its springs. The whole unsymmetric aircraft is then one problem.

``[envelope]``
    Optional; what `proprotor envelope` needs: dive_speed, altitudes and perhaps dive_mach, speed_factor,
    failure_speed_factor, damping_ratio, temperature_offset, rotor_speeds and powers.
``[variants.NAME]``
    Optional, a table for each condition of the deck: condition, "normal" or "failure", and the fields that differ,
    ``support.downstop = false``.

A frequency is in rad/s, in Hz (cycles per second) or, ``"0.42/rev"``, per revolution of the rotor speed that is
written in the same file, or in the base if the file gives none. The frequency is then fixed in hertz: a deck that
alters this deck, ``--set``, a study and a map change the rotor speed and not the frequency. A frequency set in /rev
also refers to the deck's own rotor speed. `proprotor.units` lists the units.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar, Literal, get_args

from pydantic import Field, PlainValidator, PrivateAttr, model_validator

from proprotor.datum import STATUSES, UNSTATED, Datum
from proprotor.deck import fields
from proprotor.deck.alternatives import (
    AIR_ALTERNATIVES,
    AIRFOIL_ALTERNATIVES,
    ALTERNATIVES,
    TRIM_ALTERNATIVES,
)
from proprotor.deck.control_sections import ControlSection
from proprotor.deck.default_provenance import DEFAULT_SOURCE, DEFAULT_STATUS
from proprotor.deck.envelope_sections import EnvelopeSection, VariantSection
from proprotor.deck.fields import Section, Sides, needed, optional
from proprotor.deck.reading import read_quantity
from proprotor.deck.support_sections import SupportSection
from proprotor.errors import InputError, unknown_name


class CaseSection(Section):
    """The case in words."""

    name: fields.Name = needed("Short name; a deck that alters another deck has its own.")
    title: fields.Text = needed("Title of tables and plots.")
    description: str = optional("Description of the model.", "")
    calibration: str = optional("Which inputs were matched to which result; repeated with every result.", "")
    warnings: list[fields.Text] = Field(
        default_factory=list, description="Remarks that a reader of results needs, one text each."
    )
    default_status: Literal[UNSTATED, *STATUSES] = optional(  # type: ignore[valid-type]
        "Status of every number of this file that states none; its base and its variants have their own.",
        UNSTATED,
    )
    default_source: str = optional("Source of every number that has the default_status.", "")

    @model_validator(mode="after")
    def _defaults_of_a_file(self) -> CaseSection:
        """Refuse a default that came from elsewhere: `proprotor.deck.default_provenance` takes those of files."""
        for name, none in ((DEFAULT_STATUS, UNSTATED), (DEFAULT_SOURCE, "")):
            if getattr(self, name) != none:
                rule = "must stand in the file of a deck; a number that is set for a run is assumed"
                raise InputError(name, getattr(self, name), rule)
        return self


class AirfoilSection(Section):
    """Sections of the blade: a straight lift line with constant drag and moment, or a table; or several by region."""

    alternatives: ClassVar[tuple[Sides, ...]] = AIRFOIL_ALTERNATIVES
    may_lack: ClassVar[tuple[str, ...]] = (
        "zero_lift_angle",
        "drag",
        "moment",
        "table_name",
        "table_reynolds",
    )
    needs: ClassVar[Mapping[str, str]] = {"blend": "region_ends"}

    lift_slope: fields.Slopes = optional("Slope of the lift coefficient with the angle of attack.")
    zero_lift_angle: fields.Angles = optional("Angle of attack without lift.")
    drag: fields.NotNegatives = optional("Drag coefficient.")
    moment: fields.Numbers = optional("Moment coefficient about the reference line, nose up.")
    table: fields.Files = optional("A C81 file, or one for each region; names start from the deck's folder.")
    table_name: str | list[fields.Text] = optional(
        "Title of the table in a file of several, or a title for each region; the first if left out.", ""
    )
    table_reynolds: fields.Size = optional(
        "Reynolds number of the table, in a file with tables of one airfoil at several."
    )

    region_ends: fields.Fractions = optional(
        "Outer ends r/R of the regions from the root outward, but for the last, which ends at the tip; every other "
        "field of the airfoil may then have a value for each region."
    )
    blend: fields.Fractions = optional(
        "Width, of the radius, across which the coefficients of one region pass linearly into those of the next, "
        "centred on the end; one width, or one for each end. 0 is a sharp change."
    )

    @model_validator(mode="after")
    def _numbers_or_a_table(self) -> AirfoilSection:
        of_table, joints = {"table", "table_name", "table_reynolds"}, {"region_ends", "blend"}
        numbers = [
            name for name in type(self).model_fields if name in self.model_fields_set - of_table - joints
        ]
        if self.table is not None and numbers:
            raise InputError("table", self.table.written, f"must not be given with {', '.join(numbers)}")
        for name in sorted(of_table & self.model_fields_set):
            if self.table is None:
                raise InputError(name, None, "must be given with table")
        if self.table is None and "lift_slope" not in numbers:
            raise InputError("lift_slope", None, "is missing; give lift_slope or table")
        return self

    @model_validator(mode="after")
    def _one_value_for_each_region(self) -> AirfoilSection:
        ends = self.region_ends
        if ends is None:
            for name, (count, written) in self._lists().items():
                raise InputError(
                    "region_ends", None, f"is missing; {name} has {written or f'{count} values'}"
                )
            if self.blend is not None:
                raise InputError("blend", self.blend.written, "must be given with region_ends")
            return self
        regions = 1 + (len(ends.si) if isinstance(ends.si, tuple) else 1)
        for name, (count, written) in self._lists().items():
            needed_count = regions - (name == "blend")
            if count != needed_count:
                each = "end of a region" if name == "blend" else "region"
                raise InputError(name, written, f"must have one value for each {each}, {needed_count}")
        return self

    def _lists(self) -> dict[str, tuple[int, str]]:
        """Return the number of values, and the values as written, of each field that is a list, but for the ends."""
        found = {}
        for name in type(self).model_fields:
            entry = getattr(self, name)
            values = entry.si if isinstance(entry, Datum) else entry
            if name != "region_ends" and isinstance(values, list | tuple):
                found[name] = (
                    len(values),
                    entry.written if isinstance(entry, Datum) else f"{len(values)} titles",
                )
        return found


class FrequenciesSection(Section):
    """Rotating blade frequencies from a table, in place of springs; `--structure coupled` ignores the table."""

    at_rotor_speed: fields.RotorSpeed = needed(
        "Rotor speed at which the blade has these frequencies; the springs that follow hold at any rotor speed."
    )
    against: Literal["collective", "airspeed"] = optional("Abscissa of the frequencies.", "collective")
    at: fields.Abscissa = optional("Rising collectives or airspeeds at which the lists have their values.")
    flap: fields.CurvePerRev = needed("Flap frequency per revolution, without lag and at zero cone.")
    lag: fields.CurvePerRev = needed("Lag frequency per revolution, without flap and at zero cone.")
    cyclic_flap: fields.CurvePerRev = optional("Cyclic flap frequency, if it differs from flap.")
    pitch_coupling: Literal["none", "springs"] = optional(
        'Whether a bent blade turns in pitch: not at all, or "springs", as with the rotor\'s own springs.',
        "none",
    )

    @model_validator(mode="before")
    @classmethod
    def _with_rotor_speed(cls, raw: Any) -> Any:
        """Refuse a table that does not say at which rotor speed it holds."""
        if isinstance(raw, dict) and "at_rotor_speed" not in raw:
            rule = 'is missing; frequencies per revolution hold at one rotor speed: write at_rotor_speed = "458 rpm"'
            raise InputError("at_rotor_speed", None, rule)
        return raw

    @model_validator(mode="after")
    def _one_value_for_each_place(self) -> FrequenciesSection:
        places = None if self.at is None else len(self.at.si)
        for name in ("flap", "lag", "cyclic_flap"):
            curve = getattr(self, name)
            if curve is None or not isinstance(curve.si, tuple):
                continue
            if places is None:
                raise InputError("at", None, f"is missing; {name} has {curve.written}")
            if len(curve.si) != places:
                raise InputError(name, curve.written, f"must have one value for each of the {places} of at")
        return self


class RotorSection(Section):
    """The rotor: the arguments of `proprotor.Rotor`, and numbers from which some of them may follow."""

    alternatives: ClassVar[tuple[Sides, ...]] = ALTERNATIVES

    n_blades: fields.Count = needed("Number of blades.")
    radius: fields.PositiveLength = needed("Radius, from the centre of rotation to the tip.")
    root_cutout: fields.Length = needed("Distance from the centre of rotation to the start of the airloads.")
    flap_hinge_offset: fields.Length = needed(
        "Distance from the centre of rotation to the flap hinge; at 0 lock flap or gimbal."
    )
    lag_hinge_offset: fields.Length = needed(
        "Distance from the centre of rotation to the lag hinge, not inboard of the flap hinge."
    )
    precone: fields.Angle = needed("Cone built into the hub, towards thrust.")
    blade_mass: fields.Mass = optional("Integral of m over the whole blade.")
    blade_first_moment: fields.FirstMoment = optional("Integral of m r over the whole blade.")
    blade_inertia: fields.Inertia = optional("I_b, integral of m r² over the whole blade.")
    flap_first_moment: fields.FirstMoment = optional("Integral of m (r - e) outboard of the flap hinge.")
    flap_inertia: fields.Inertia = optional("Integral of m (r - e)² outboard of the flap hinge.")
    lag_first_moment: fields.FirstMoment = optional("Integral of m (r - e) outboard of the lag hinge.")
    lag_inertia: fields.Inertia = optional("Integral of m (r - e)² outboard of the lag hinge.")
    mass_distribution: fields.MassDistribution = optional(
        "Mass per length from the centre (or with hub_mass from anywhere) to the tip, which gives all seven integrals; "
        'beyond = "nothing" for a blade without mass beyond the stations.'
    )
    hub_mass: fields.MassOrNone = optional(
        "Mass of the whole hub at the centre of rotation, for a mass_distribution that begins further out; not to be "
        "included in the masses of the support again."
    )
    flap_stiffness: fields.Stiffness = optional("Stiffness of the flap spring, hub and blade in series.")
    flap_frequency: fields.Frequency = optional("Flap frequency without rotation, K = I ω².")
    lag_stiffness: fields.Stiffness = optional("Stiffness of the lag spring, hub and blade in series.")
    lag_frequency: fields.Frequency = optional("Lag frequency without rotation, K = I ω².")
    flap_outboard_fraction: fields.Fraction = needed(
        "Share of the flap flexibility beyond the pitch bearing."
    )
    lag_outboard_fraction: fields.Fraction = needed("Share of the lag flexibility beyond the pitch bearing.")
    structural_pitch_offset: fields.Angle = optional(
        "Angle from the collective reference to the blade's structural axes."
    )
    gimbal_stiffness: fields.Stiffness = needed("Stiffness of the hub spring.")
    pitch_gimbal_coupling: fields.Tangent = needed(
        "K_PG = tan δ3, pitch nose down per gimbal tilt; an angle is δ3 itself."
    )
    kinematic_pitch_flap_coupling: fields.Tangent = optional(
        "K_P3 = tan δ3 of the blade's own flap hinge, pitch nose down per flap; an angle is δ3 itself."
    )
    kinematic_pitch_lag_coupling: fields.Tangent = optional(
        "K_P4 = tan δ4 of the blade's own lag hinge, pitch nose down per lag; an angle is δ4 itself."
    )
    pitch_inertia: fields.InertiaOrNone = needed("Inertia of one blade about its pitch axis.")
    control_stiffness: fields.Stiffness = needed(
        "Control system stiffness of one blade, about its pitch axis."
    )
    cyclic_control_stiffness: fields.Stiffness = optional(
        "Control system stiffness of one blade where the swashplate tilts; that of control_stiffness if left out."
    )
    flap_damping: fields.Damping = optional("Viscous damping of the flap hinge.")
    lag_damping: fields.Damping = optional("Viscous damping of the lag hinge.")
    pitch_damping: fields.Damping = optional("Viscous damping of the blade's pitch.")
    gimbal_damping: fields.Damping = optional("Viscous damping of the gimbal, in non-rotating axes.")
    propeller_moment: bool = optional("Whether the propeller moment acts on the blade's pitch.", True)
    propeller_inertia: fields.InertiaOrNone = optional(
        "I_xx - I_yy of one blade, chordwise less through the thickness, which makes the propeller moment; that of "
        "pitch_inertia, a thin blade, if left out."
    )
    chord: fields.Chord = optional(
        "Chord of the blade, one value or along r from root cutout to tip; "
        'beyond = "held" if the end values hold beyond the stations.'
    )
    lock_number: fields.Positive = optional("Lock number γ; chord = γ I_b / (ρ c_lα R⁴), ρ of the deck.")
    twist: fields.Twist = needed(
        "Twist, one value for a linear change from centre to tip, or along r from root cutout to tip; "
        'beyond = "held" if the end values hold beyond the stations. Pitch is zero at 0.75 R.'
    )
    mass_offset: fields.PlaceOnChord = optional(
        "Centre of the mass aft of the pitch axis, one value or along r from lag hinge to tip, with mass_distribution; "
        "it counts outboard of the lag hinge."
    )
    aerodynamic_center: fields.PlaceOnChord = optional(
        "Aerodynamic centre (quarter chord) aft of the pitch axis, one value or along r from root cutout to tip."
    )
    airfoil: AirfoilSection = needed("Sections of the blade.")
    frequencies: FrequenciesSection | None = optional("Blade frequencies; from the springs if left out.")

    @model_validator(mode="after")
    def _one_side_of_each_pair(self) -> RotorSection:
        for pair in ALTERNATIVES:
            _one_side(self, pair)
        if self.hub_mass is not None and self.mass_distribution is None:
            rule = "must be given with mass_distribution; blade_mass holds the hub's mass"
            raise InputError("hub_mass", self.hub_mass.written, rule)
        if self.mass_offset is not None and self.mass_distribution is None:
            rule = "must be given with mass_distribution: the seven integrals do not tell where the mass is"
            raise InputError("mass_offset", self.mass_offset.written, rule)
        return self


class TrimSection(Section):
    """The target of the trim, instead of windmilling."""

    alternatives: ClassVar[tuple[Sides, ...]] = TRIM_ALTERNATIVES

    collective: fields.Angle = optional("Collective pitch at 0.75 R.")
    thrust_coefficient: fields.Number = optional("C_T = T/(ρπR²(ΩR)²).")
    power_coefficient: fields.Number = optional("C_P = P/(ρπR²(ΩR)³), positive for power into the rotor.")


_TRIM_RULE = (
    'must be "windmill" or { collective = "30 deg" }, or likewise a thrust_coefficient or power_coefficient'
)


def _read_trim(raw: Any) -> str | TrimSection:
    """Return the trim of an operation: "windmill", or a section with one target."""
    if raw == "windmill":
        return "windmill"
    if not isinstance(raw, dict) or len(raw) != 1:
        raise InputError("", raw, _TRIM_RULE)
    ((name, given),) = raw.items()
    if name not in TrimSection.model_fields:
        raise InputError(name, given, unknown_name(name, TrimSection.model_fields, "trim"))
    try:
        number = read_quantity(given, "rad" if name == "collective" else "")
    except InputError as error:
        raise error.within(name) from None
    target: dict[str, Any] = {name: number}
    return TrimSection.model_construct(**target)


class OperationSection(Section):
    """The operation of the rotor, and the air."""

    alternatives: ClassVar[tuple[Sides, ...]] = AIR_ALTERNATIVES
    may_lack: ClassVar[tuple[str, ...]] = ("temperature_offset",)
    defaults: ClassVar[Mapping[str, float]] = {"temperature_offset": 0.0}

    rotor_speed: fields.RotorSpeed = needed("Rotor speed Ω.")
    density: fields.Density = optional("Air density; 0 for a vacuum.")
    speed_of_sound: fields.Speed = optional("Speed of sound in the air.")
    altitude: fields.Offset = optional("Pressure altitude in the standard atmosphere (ISA), -610 m to 32 km.")
    temperature_offset: fields.TemperatureDifference = optional(
        "Air temperature above the standard temperature at the altitude; none by default."
    )
    trim: Annotated[str | TrimSection, PlainValidator(_read_trim)] = optional(
        '"windmill" for the collective without torque, or one target: { collective = "30 deg" }, '
        "{ thrust_coefficient = 0.008 } or { power_coefficient = 0.01 }.",
        "windmill",
    )

    @model_validator(mode="after")
    def _given_air_or_standard(self) -> OperationSection:
        _one_side(self, AIR_ALTERNATIVES[0])
        return self


class DriveTrainSection(Section):
    """Engine and shaft on the rotor's azimuth, referred to the rotor's speed."""

    drive_inertia: fields.InertiaOrNone = optional("Inertia that turns with the rotor, without the blades.")
    drive_damping: fields.Damping = optional("Torque per change of rotor speed.")
    shaft_stiffness: fields.Stiffness = optional(
        "Torque per azimuth of a shaft with an end of constant speed; 0 for a rotor whose speed is free."
    )
    mast_stiffness: fields.PositiveStiffness = optional(
        "Torque per twist of the mast between the rotor and its gearbox; a rigid mast if left out."
    )
    engine_inertia: fields.InertiaOrNone = optional(
        "Inertia of gearbox and engine, behind the mast; above 0 with mast_stiffness."
    )
    engine_damping: fields.Damping = optional("Torque per change of the speed of gearbox and engine.")
    interconnect_stiffness: fields.Stiffness = optional(
        "Of an aircraft: torque of the shaft between both gearboxes per difference of their azimuths."
    )


class LeftSection(Section):
    """Fields that differ on the left side of an aircraft, by their place: support.downstop = false."""

    rotor: dict[str, Any] | None = optional("Fields of the left rotor.")
    operation: dict[str, Any] | None = optional("The trim of the left rotor.")
    drive_train: dict[str, Any] | None = optional("Fields of the left drive train.")
    support: dict[str, Any] | None = optional(
        "Fields of the left wing, carry-through box, pylon and springs."
    )


class Deck(Section):
    """A case of the whirl-flutter analysis proprotor."""

    case: CaseSection = needed("The case in words.")
    rotor: RotorSection = needed("The rotor.")
    operation: OperationSection = needed("The operation of the rotor, and the air.")
    drive_train: DriveTrainSection | None = optional("Engine and shaft; none if left out.")
    support: SupportSection = needed("The support of the rotor.")
    control: ControlSection | None = optional("Control loops; none if left out.")
    left: LeftSection | None = optional("What differs on the left side of an aircraft; nothing if left out.")
    envelope: EnvelopeSection | None = optional("Speeds and altitudes to be free of flutter.")
    variants: dict[fields.Name, VariantSection] = Field(
        default_factory=dict, description="Conditions of the deck by name: other loads, and failures."
    )

    _left_side: Deck | None = PrivateAttr(default=None)
    _tables: dict[str, Any] = PrivateAttr(default_factory=dict)
    _origin: tuple[str, dict[str, str]] = PrivateAttr(default=("", {}))

    @property
    def origin(self) -> tuple[str, dict[str, str]]:
        """The bundled name or the path that the deck was read from, and the fields that were set, as text."""
        return self._origin

    def with_origin(self, name: str, settings: Mapping[str, str]) -> Deck:
        """Return the deck with the name or path that it was read from, and the fields that were set."""
        whole = self.model_copy()
        whole._origin = (name, dict(settings))
        return whole

    @property
    def left_side(self) -> Deck | None:
        """The whole deck of the left side, if the left side differs."""
        return self._left_side

    @property
    def tables(self) -> dict[str, Any]:
        """The tables that the deck was made from, without those of its envelope and its variants."""
        return self._tables

    def with_tables(self, tables: Mapping[str, Any]) -> Deck:
        """Return the deck with the tables that it was made from."""
        whole = self.model_copy()
        whole._tables = dict(tables)
        return whole

    def with_left_side(self, other: Deck) -> Deck:
        """Return the deck with the whole deck of the left side."""
        whole = self.model_copy()
        whole._left_side = other
        return whole


def sections_of(annotation: Any) -> list[type[Section]]:
    """Return the sections that a field with an annotation may hold; none for a field that is no section."""
    if isinstance(annotation, type):
        return [annotation] if issubclass(annotation, Section) else []
    return [section for choice in get_args(annotation) for section in sections_of(choice)]


def _places(
    section: type[Section], place: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], type[Section]]]:
    """Yield a section and the sections inside, each with its place; below [support] the place has the kind."""
    yield place, section
    for name, field in section.model_fields.items():
        for inner in sections_of(field.annotation):
            kind = get_args(inner.model_fields["kind"].annotation) if "kind" in inner.model_fields else ()
            yield from _places(inner, (*place, name, *kind))


SECTIONS = dict(_places(Deck))
LISTS = ("support.modes", "control.loops")  # places of lists of sections, whose entries have names
SUPPORT_KINDS = tuple(place[1] for place in SECTIONS if place[:1] == ("support",) and len(place) == 2)


def is_number_of(section: type[Section], name: str) -> bool:
    """Return whether a section has a field of a name that is a number, rather than a word or a section."""
    field = section.model_fields.get(name)
    return field is not None and any(isinstance(part, fields.Reading) for part in field.metadata)


def sections_at(place: tuple[str, ...]) -> dict[str, type[Section]]:
    """Return the sections at a place, such as ``("support", "modes")``, by kind of support; "" for other sections."""
    return {
        known[1] if known[:1] == ("support",) else "": section
        for known, section in SECTIONS.items()
        if in_the_deck(known) == place
    }


def section_places() -> list[tuple[str, ...]]:
    """Return every place of a section in a deck, without the deck itself."""
    return list(dict.fromkeys(tuple(map(str, in_the_deck(known))) for known in SECTIONS if known))


def in_the_deck(place: tuple[str | int, ...]) -> tuple[str | int, ...]:
    """Return a place without the kind of support, which pydantic inserts."""
    return (place[0], *place[2:]) if place[:1] == ("support",) and len(place) > 1 else place


def _one_side(section: Section, choice: Sides) -> None:
    """Refuse a section that does not give exactly one side of a choice, with all fields but the fields it may lack."""
    given = section.model_fields_set
    sides = [side for side in choice if given.intersection(side)]
    both = " or ".join(_listed(side) for side in choice)
    if not sides:
        raise InputError(choice[0][0], None, f"is missing; give {both}")
    if len(sides) > 1:
        twice = next(name for name in sides[1] if name in given)
        raise InputError(twice, None, f"must not be given twice over; give {both}")
    for name in sides[0]:
        if name not in given and name not in section.may_lack:
            raise InputError(name, None, "is missing")


def _listed(names: tuple[str, ...]) -> str:
    """Return names in a list, several of them in brackets."""
    return names[0] if len(names) == 1 else f"({', '.join(names)})"
