"""The section [support] of a deck, one set of fields for each kind.

``kind = "normal-modes"``
    includes_rotor and shaft, how the rotor was held when the modes were found with it on, see `proprotor.model.rotor_share`;
    a table ``[[support.modes]]`` for each mode with name; coordinate, "length" or "angle"; generalized_mass,
    frequency, damping_ratio; and the motion of the hub per unit of the coordinate, x, y, z, alpha_x, alpha_y,
    alpha_z, zero where left out.
``kind = "beam-wing"``
    The arguments of `proprotor.support.beam_wing.Wing` and `Pylon`, a property along the wing one value or
    ``{ y_over_span = [...], value = [...], unit = "lbf*in**2" }``. The downstop: downstop, on (true) or off;
    downstop_stiffness_on and downstop_stiffness_off, rigid where left out. rotor_mass, what the rotor model has at
    the hub. modes, how many to keep, all coordinates when left out; damping_ratio or loss_factor of every mode and
    beam_damping_ratio, chord_damping_ratio, torsion_damping_ratio of those.
``kind = "matrices"``
    file, an .npz file, or mass, stiffness, dofs and perhaps damping, Matrix Market files and a list of names: see
    `proprotor.support.matrix_files`. A table hub; includes_rotor, shaft, rotor_mass, modes, damping_ratio, length_unit,
    mass_unit.
``kind = "nastran"``
    file, an .op2 file, and grid: see `proprotor.support.nastran`. subcase, a table hub, includes_rotor, shaft, modes,
    damping_ratio, length_unit, mass_unit.
``kind = "pivot"``
    distance from pivot to hub; pitch_inertia, yaw_inertia, pitch_stiffness, yaw_stiffness, pitch_damping,
    yaw_damping; includes_rotor, shaft.
``kind = "rigid"``
    Nothing: the hub does not move.
``[support.wing_aerodynamics]``
    Quasi-steady airloads of the wing, left out unless this table is there: lift_slope, chord, elastic_axis and perhaps
    aerodynamic_centre and downwash_point, see `proprotor.support.wing_aerodynamics`; for kinds other than beam-wing
    also span, mast_length and sweep.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator

from proprotor.deck.alternatives import DAMPING_ALTERNATIVES, FILE_ALTERNATIVES
from proprotor.deck.fields import (
    Angle,
    AxialStiffness,
    BendingStiffness,
    Damping,
    DampingRatio,
    File,
    Frequency,
    GeneralizedMass,
    HubDisplacement,
    HubRotation,
    IncludesRotor,
    Inertia,
    InertiaOrNone,
    InertiaPerLength,
    Mass,
    MassOrNone,
    MassPerLength,
    Name,
    NotNegative,
    Number,
    Offset,
    PositiveLength,
    PositiveStiffness,
    Section,
    Shaft,
    Sides,
    Size,
    Slope,
    Stiffness,
    needed,
    optional,
)
from proprotor.errors import InputError
from proprotor.support.normal_modes import HUB_AXES

_HELD = (
    "How the rotor, whose share is taken off, was held in these modes: tilting on its gimbal, as one body with the "
    "shaft, a point mass at the hub; false where it was not on, true gimballed where there is a gimbal, else rigid."
)
_SHAFT = "Whether the rotor could turn about its shaft then, gimballed or rigid; held where left out."


class WingAerodynamicsSection(Section):
    """Quasi-steady airloads of the wing."""

    lift_slope: Slope = needed("Of a section across the elastic axis.")
    chord: PositiveLength = needed("Streamwise.")
    elastic_axis: Number = needed("In chords behind the leading edge.")
    aerodynamic_centre: Number = optional("In chords behind the leading edge.")
    downwash_point: Number = optional("In chords behind the leading edge.")


class AssumedShapeSection(WingAerodynamicsSection):
    """Quasi-steady airloads of a wing that is assumed to bend as a cantilever with a load at its tip."""

    span: PositiveLength = needed("From the mount to the pylon.")
    mast_length: Offset = needed("From the elastic axis at the tip forward to the hub.")
    sweep: Angle = optional("Of the elastic axis, back positive.")


class ModeSection(Section):
    """A normal mode: its generalised mass, and the hub's motion per unit of its coordinate, 0 where left out."""

    name: Name = needed("Of the mode, everywhere.")
    coordinate: Literal["length", "angle"] = needed("What one unit of the mode is.")
    generalized_mass: GeneralizedMass = needed("Mass for a length, moment of inertia for an angle.")
    frequency: Frequency = needed("Undamped, without airloads.")
    damping_ratio: DampingRatio = needed("Structural, of critical.")
    x: HubDisplacement = optional("Hub motion up per unit of the coordinate.")
    y: HubDisplacement = optional("Hub motion outboard per unit of the coordinate.")
    z: HubDisplacement = optional("Hub motion forward along the shaft per unit of the coordinate.")
    alpha_x: HubRotation = optional("Hub rotation about x per unit of the coordinate.")
    alpha_y: HubRotation = optional("Hub rotation about y, nose up, per unit of the coordinate.")
    alpha_z: HubRotation = optional("Hub rotation about the shaft per unit of the coordinate.")

    @model_validator(mode="after")
    def _moves_the_hub(self) -> ModeSection:
        if not self.model_fields_set.intersection(HUB_AXES):
            raise InputError("", None, f"must move the hub; give one or more of {', '.join(HUB_AXES)}")
        return self


class NormalModesSection(Section):
    """A support of normal modes, given by number."""

    kind: Literal["normal-modes"] = needed("Normal modes, a `[[support.modes]]` each.")
    includes_rotor: IncludesRotor = needed(_HELD)
    shaft: Shaft = optional(_SHAFT)
    modes: Annotated[list[ModeSection], Field(min_length=1)] = needed("One table for each mode.")
    wing_aerodynamics: AssumedShapeSection | None = optional("Airloads of the wing; none where left out.")

    @model_validator(mode="after")
    def _names_differ(self) -> NormalModesSection:
        names = [mode.name for mode in self.modes]
        for name in names:
            if names.count(name) > 1:
                raise InputError("modes.name", name, "must not name two modes")
        return self


class BeamWingSection(Section):
    """A cantilever wing of beam elements with a rigid pylon."""

    alternatives: ClassVar[tuple[Sides, ...]] = DAMPING_ALTERNATIVES
    needed_unless_replaced: ClassVar[tuple[str, ...]] = ("damping_ratio", "loss_factor")

    kind: Literal["beam-wing"] = needed("A wing of beam elements.")
    span: PositiveLength = needed("From the mount to the pylon, outboard.")
    beam_stiffness: BendingStiffness = needed("EI of bending up and down.")
    chord_stiffness: BendingStiffness = needed("EI of bending fore and aft.")
    torsion_stiffness: BendingStiffness = needed("GJ.")
    axial_stiffness: AxialStiffness = needed("EA.")
    mass_per_length: MassPerLength = needed("Along the elastic axis, the centre of mass on it.")
    torsional_inertia_per_length: InertiaPerLength = needed("About the elastic axis.")
    sweep: Angle = optional("Of the elastic axis, back positive.")
    dihedral: Angle = optional("Of the elastic axis, up positive.")
    elements: Size = optional("How many, of equal length.")
    nacelle_mass: MassOrNone = needed("Without the rotor.")
    nacelle_pitch_inertia: InertiaOrNone = needed("About the nacelle's centre of mass, nose up.")
    nacelle_yaw_inertia: InertiaOrNone = needed("About the nacelle's centre of mass, about the upward axis.")
    nacelle_roll_inertia: InertiaOrNone = needed("About the nacelle's centre of mass, about the shaft.")
    nacelle_forward: Offset = optional("From the elastic axis at the tip to the nacelle's centre of mass.")
    nacelle_up: Offset = optional("From the elastic axis at the tip to the nacelle's centre of mass.")
    nacelle_outboard: Offset = optional("From the elastic axis at the tip to the nacelle's centre of mass.")
    mast_length: Offset = needed("From the elastic axis at the tip forward to the hub.")
    mast_height: Offset = optional("From the elastic axis at the tip up to the hub.")
    mast_outboard: Offset = optional("From the elastic axis at the tip outboard to the hub.")
    hub_mass: MassOrNone = optional("What belongs to the rotor and is not in its blades.")
    rotor_mass: MassOrNone = needed("What the rotor model has at the hub; modes are those with it.")
    downstop: bool = optional("Whether the pylon is on its downstop.", True)
    downstop_stiffness_on: PositiveStiffness = optional(
        "Pylon to wing in pitch, on the downstop; rigid where left out."
    )
    downstop_stiffness_off: PositiveStiffness = optional(
        "Pylon to wing in pitch, off the downstop; rigid where left out."
    )
    modes: Size = optional("How many of the lowest modes to keep; all coordinates where left out.")
    damping_ratio: DampingRatio = optional("Of every mode, of critical.")
    loss_factor: NotNegative = optional("Structural g of every mode, taken as g/2 of critical.")
    beam_damping_ratio: DampingRatio = optional("Of beam modes instead of that of every mode.")
    chord_damping_ratio: DampingRatio = optional("Of chord modes instead of that of every mode.")
    torsion_damping_ratio: DampingRatio = optional("Of torsion modes instead of that of every mode.")
    wing_aerodynamics: WingAerodynamicsSection | None = optional("Airloads of the wing; none where left out.")

    @model_validator(mode="after")
    def _one_damping(self) -> BeamWingSection:
        _exactly_one(self, "damping_ratio", "loss_factor")
        return self


class MatricesSection(Section):
    """Mass, stiffness and damping matrices of any finite-element code."""

    alternatives: ClassVar[tuple[Sides, ...]] = FILE_ALTERNATIVES
    needed_unless_replaced: ClassVar[tuple[str, ...]] = ("file", "mass", "stiffness", "dofs")

    kind: Literal["matrices"] = needed("Matrices from files.")
    file: File = optional("An .npz file with mass, stiffness, dofs and perhaps damping.")
    mass: File = optional("A Matrix Market file.")
    stiffness: File = optional("A Matrix Market file.")
    damping: File = optional("A Matrix Market file.")
    dofs: File = optional("A text file, the name of a coordinate on each line.")
    hub: dict[str, str] | None = optional(
        'For each of x, y, z, alpha_x, alpha_y, alpha_z the coordinate of the hub, "-" before it where it points '
        "the other way; hub_x and so on where left out."
    )
    includes_rotor: IncludesRotor = needed(_HELD)
    shaft: Shaft = optional(_SHAFT)
    rotor_mass: MassOrNone = optional(
        "What the rotor model has at the hub; modes are those with it. Not where the matrix includes the rotor."
    )
    modes: Size = optional("How many of the lowest modes to keep; all coordinates where left out.")
    damping_ratio: DampingRatio = optional(
        "Of every mode, of critical, where no damping matrix is given; 0 where left out."
    )
    length_unit: PositiveLength = optional("The files' unit of length; 1 m where left out.")
    mass_unit: Mass = optional("The files' unit of mass; 1 kg where left out.")
    wing_aerodynamics: AssumedShapeSection | None = optional("Airloads of the wing; none where left out.")

    @model_validator(mode="after")
    def _one_file_or_several(self) -> MatricesSection:
        _exactly_one(self, "file", "mass")
        several = [name for name in ("stiffness", "damping", "dofs") if name in self.model_fields_set]
        if self.file is not None and several:
            raise InputError(several[0], None, "must not be given with file, which holds it")
        for name in ("stiffness", "dofs"):
            if self.file is None and name not in self.model_fields_set:
                raise InputError(name, None, "is missing")
        return self


class NastranSection(Section):
    """Real modes and generalised masses of a Nastran run at a grid point."""

    kind: Literal["nastran"] = needed("An .op2 file.")
    file: File = needed("The .op2 file.")
    grid: Size = needed("The grid point at the hub.")
    subcase: Size = optional("Needed where the file has several.")
    hub: dict[str, str] | None = optional(
        'For each of x, y, z, alpha_x, alpha_y, alpha_z one of T1 to R3, "-" before it where it points the other '
        "way; aircraft axes where left out."
    )
    includes_rotor: IncludesRotor = needed(_HELD)
    shaft: Shaft = optional(_SHAFT)
    modes: Size = optional("How many of the lowest modes; all where left out.")
    damping_ratio: DampingRatio = optional("Of every mode, of critical; 0 where left out.")
    length_unit: PositiveLength = optional("The run's unit of length; 1 m where left out.")
    mass_unit: Mass = optional("The run's unit of mass; 1 kg where left out.")
    wing_aerodynamics: AssumedShapeSection | None = optional("Airloads of the wing; none where left out.")


class PivotSection(Section):
    """A rigid shaft that pitches and yaws about a point behind the hub; dampings left out are 0."""

    kind: Literal["pivot"] = needed("A shaft on a pivot.")
    includes_rotor: IncludesRotor = needed(_HELD)
    shaft: Shaft = optional(_SHAFT)
    distance: Offset = needed("From the pivot forward to the hub.")
    pitch_inertia: Inertia = needed("About the pivot.")
    yaw_inertia: Inertia = needed("About the pivot.")
    pitch_stiffness: Stiffness = needed("Of the pivot.")
    yaw_stiffness: Stiffness = needed("Of the pivot.")
    pitch_damping: Damping = optional("Of the pivot.")
    yaw_damping: Damping = optional("Of the pivot.")


class RigidSection(Section):
    """A hub that does not move."""

    kind: Literal["rigid"] = needed("A hub that does not move.")


SupportSection = Annotated[
    NormalModesSection | BeamWingSection | MatricesSection | NastranSection | PivotSection | RigidSection,
    Field(discriminator="kind"),
]

# The tables of each kind by their place within [support].
SUPPORT_TABLES: dict[tuple[str, ...], type[Section]] = {
    ("normal-modes",): NormalModesSection,
    ("normal-modes", "modes"): ModeSection,
    ("normal-modes", "wing_aerodynamics"): AssumedShapeSection,
    ("beam-wing",): BeamWingSection,
    ("beam-wing", "wing_aerodynamics"): WingAerodynamicsSection,
    ("matrices",): MatricesSection,
    ("matrices", "wing_aerodynamics"): AssumedShapeSection,
    ("nastran",): NastranSection,
    ("nastran", "wing_aerodynamics"): AssumedShapeSection,
    ("pivot",): PivotSection,
    ("rigid",): RigidSection,
}
SUPPORT_KINDS = tuple(place[0] for place in SUPPORT_TABLES if len(place) == 1)


def _exactly_one(section: Section, one: str, other: str) -> None:
    given = section.model_fields_set.intersection((one, other))
    if not given:
        raise InputError(one, None, f"is missing; give {one} or {other}")
    if len(given) > 1:
        raise InputError(other, None, f"must not be given with {one}")
