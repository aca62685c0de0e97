"""The section [support] of a deck, one set of fields for each kind.

``kind = "normal-modes"``
    includes_rotor and shaft, how the rotor was held while the modes were found with the rotor on, see
    `proprotor.model.rotor_share`; carries, one rotor or two; a table ``[[support.modes]]`` for each mode with name;
    coordinate, "length" or "angle"; generalized_mass, frequency, damping_ratio; and the motion of the hub per unit of
    the coordinate, x, y, z, alpha_x, alpha_y, alpha_z, zero if left out.
``kind = "beam-wing"``
    The arguments of `proprotor.support.beam_wing.Wing` and `Pylon`, a property along the wing one value or
    ``{ y_over_span = [...], value = [...], unit = "lbf*in**2" }``. The downstop: downstop, on (true) or off;
    downstop_stiffness_on and downstop_stiffness_off, rigid if left out. The rotor in the wing's modes: rotor_mass, the
    mass of the rotor model at the hub, or rotor_held and shaft, how this rotor is held. beam_stiffness_factor and so
    on, or beam_frequency and so on, to which these factors are fitted: `proprotor.support.stiffness_factors`. modes,
    the number of modes, all coordinates if left out; damping_ratio or loss_factor of every mode, and
    beam_damping_ratio, chord_damping_ratio, torsion_damping_ratio of the modes of these kinds.
``kind = "aircraft"``
    The fields of a beam wing, for each side of the aircraft; spindle_yaw_stiffness_on, spindle_yaw_stiffness_off and
    pylon_yaw_damping_ratio; modes, the number of elastic modes of each symmetry; symmetry, "both", "symmetric" or
    "antisymmetric". Tables fuselage, carry_through, horizontal_tail, vertical_tail: see
    `proprotor.support.aircraft_structure`, `free_airframe` and `aircraft_airloads`. A table ``[left]`` at the top of
    the deck has what differs on the left side.
``kind = "matrices"``
    file, an .npz or .mat file, or mass, stiffness, dofs and perhaps damping, Matrix Market files and a list of names:
    see `proprotor.support.matrix_files` and `matlab_file`. A table hub, or for modal coordinates the motion of the hub
    (the array hub of the .npz file, or hub_motion) and carries, one rotor or two. includes_rotor, shaft, rotor_mass,
    modes, damping_ratio, length_unit, mass_unit.
``kind = "nastran"``
    file, of a Nastran run, and grid: see `proprotor.support.nastran`. subcase, generalized_mass, coordinates, a table
    hub, names, includes_rotor, shaft, modes, damping_ratio, length_unit, mass_unit; carries, one rotor or two.
``kind = "universal"``
    file, a universal file (.unv, .uff), and node, or rigid_nodes around it: see `proprotor.support.universal_modes`. A
    table hub, includes_rotor, shaft, modes, damping_ratio, length_unit, mass_unit; carries, one rotor or two.
``kind = "pivot"``
    distance from pivot to hub; pitch_inertia, yaw_inertia, pitch_stiffness, yaw_stiffness, pitch_damping,
    yaw_damping; includes_rotor, shaft.
``kind = "rigid"``
    No fields: the hub does not move.
``[support.wing_aerodynamics]``
    Quasi-steady airloads of the wing, only with this table: lift_slope, chord, elastic_axis and perhaps
    aerodynamic_centre and downwash_point, see `proprotor.support.wing_aerodynamics`; for kinds other than beam-wing
    also span, mast_length and sweep.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, field_validator, model_validator

from proprotor.deck import fields
from proprotor.deck.alternatives import (
    DAMPING_ALTERNATIVES,
    FILE_ALTERNATIVES,
    ROTOR_ALTERNATIVES,
    STIFFNESS_ALTERNATIVES,
)
from proprotor.deck.fields import Section, Sides, needed, optional
from proprotor.errors import InputError
from proprotor.support.normal_modes import HUB_AXES

_HELD = (
    "How the rotor, whose share is taken off, was held in these modes: tilting on its gimbal, as one body with the "
    "shaft, or a point mass at the hub; false for modes without rotor, true for gimballed if the rotor has a gimbal, "
    "else rigid."
)
_CARRIES = (
    "What the structure of these masses carries: one rotor, as a semispan or half an aircraft does, or two rotors, as "
    "a whole aircraft does, in modes of one symmetry; half of its masses then go with one rotor."
)
_SHAFT = "Whether a gimballed or rigid rotor could turn about its shaft in these modes; held if left out."


class WingAerodynamicsSection(Section):
    """Quasi-steady airloads of the wing."""

    lift_slope: fields.Slope = needed("Lift slope of a section across the elastic axis.")
    chord: fields.PositiveLength = needed("Streamwise chord of the wing.")
    elastic_axis: fields.Number = needed("Elastic axis, in chords behind the leading edge.")
    aerodynamic_centre: fields.Number = optional("Aerodynamic centre, in chords behind the leading edge.")
    downwash_point: fields.Number = optional("Point of the downwash, in chords behind the leading edge.")
    flap_chord: fields.Fraction = optional(
        "Chord of a flaperon over that of the wing, an input of control loops; not of an aircraft. None if left out."
    )
    flap_inboard: fields.Fraction = optional("Inboard end of the flaperon, in parts of the span.")
    flap_outboard: fields.Fraction = optional("Outboard end of the flaperon, in parts of the span.")


class AssumedShapeSection(WingAerodynamicsSection):
    """Quasi-steady airloads of a wing that is assumed to bend as a cantilever with a load at its tip."""

    span: fields.PositiveLength = needed("Span, from the mount to the pylon.")
    mast_length: fields.Offset = needed("Length from the elastic axis at the tip forward to the hub.")
    sweep: fields.Angle = optional("Sweep of the elastic axis, back positive.")


class ModeSection(Section):
    """A normal mode: its generalised mass, and the hub's motion per unit of its coordinate, 0 if left out."""

    defaults: ClassVar[Mapping[str, float]] = dict.fromkeys(HUB_AXES, 0.0)

    name: fields.Name = needed("Name of the mode in all results.")
    coordinate: Literal["length", "angle"] = needed("Whether the mode's coordinate is a length or an angle.")
    generalized_mass: fields.GeneralizedMass = needed("Mass for a length, moment of inertia for an angle.")
    frequency: fields.Frequency = needed("Undamped frequency, without airloads.")
    damping_ratio: fields.DampingRatio = needed("Structural damping ratio, relative to critical.")
    x: fields.HubDisplacement = optional("Hub motion up per unit of the coordinate.")
    y: fields.HubDisplacement = optional("Hub motion outboard per unit of the coordinate.")
    z: fields.HubDisplacement = optional("Hub motion forward along the shaft per unit of the coordinate.")
    alpha_x: fields.HubRotation = optional("Hub rotation about x per unit of the coordinate.")
    alpha_y: fields.HubRotation = optional("Hub rotation about y, nose up, per unit of the coordinate.")
    alpha_z: fields.HubRotation = optional("Hub rotation about the shaft per unit of the coordinate.")

    @model_validator(mode="after")
    def _moves_the_hub(self) -> ModeSection:
        if not self.model_fields_set.intersection(HUB_AXES):
            raise InputError("", None, f"must move the hub; give one or more of {', '.join(HUB_AXES)}")
        return self


class NormalModesSection(Section):
    """A support of normal modes, given by number."""

    kind: Literal["normal-modes"] = needed("Normal modes, a `[[support.modes]]` each.")
    includes_rotor: fields.IncludesRotor = needed(_HELD)
    shaft: fields.Shaft = optional(_SHAFT)
    carries: fields.Carries = optional(f"{_CARRIES} One rotor if left out.")
    modes: Annotated[list[ModeSection], Field(min_length=1)] = needed("One table for each mode.")
    wing_aerodynamics: AssumedShapeSection | None = optional("Airloads of the wing; none if left out.")

    @model_validator(mode="after")
    def _names_differ(self) -> NormalModesSection:
        names = [mode.name for mode in self.modes]
        for name in names:
            if names.count(name) > 1:
                raise InputError("modes.name", name, "must not name two modes")
        return self


class _WingSection(Section):
    """A wing of beam elements with a pylon: what a cantilever and one side of an aircraft have in common."""

    alternatives: ClassVar[tuple[Sides, ...]] = DAMPING_ALTERNATIVES

    kind: Any = needed("")
    span: fields.PositiveLength = needed("Span, from the mount outboard to the pylon.")
    beam_stiffness: fields.BendingStiffness = needed("Stiffness EI of bending up and down.")
    chord_stiffness: fields.BendingStiffness = needed("Stiffness EI of bending fore and aft.")
    torsion_stiffness: fields.BendingStiffness = needed("Torsion stiffness GJ.")
    axial_stiffness: fields.AxialStiffness = needed("Axial stiffness EA.")
    mass_per_length: fields.MassPerLength = needed("Mass per length.")
    torsional_inertia_per_length: fields.InertiaPerLength = needed(
        "Inertia per length of twist, about the centre of mass of the section."
    )
    mass_forward: fields.OffsetOfMass = optional("Centre of mass of the section ahead of the elastic axis.")
    mass_up: fields.OffsetOfMass = optional("Centre of mass of the section above the elastic axis.")
    sweep: fields.Angle = optional("Sweep of the elastic axis, back positive.")
    dihedral: fields.Angle = optional("Dihedral of the elastic axis, up positive.")
    elements: fields.Size = optional("Number of elements of equal length.")
    nacelle_mass: fields.MassOrNone = needed("Mass of the nacelle without the rotor.")
    nacelle_pitch_inertia: fields.InertiaOrNone = needed(
        "Nose-up inertia about the nacelle's centre of mass."
    )
    nacelle_yaw_inertia: fields.InertiaOrNone = needed("Inertia about the upward axis at the centre of mass.")
    nacelle_roll_inertia: fields.InertiaOrNone = needed("Inertia about the shaft axis at the centre of mass.")
    nacelle_forward: fields.Offset = optional("Centre of mass forward of the elastic axis at the tip.")
    nacelle_up: fields.Offset = optional("Centre of mass above the elastic axis at the tip.")
    nacelle_outboard: fields.Offset = optional("Centre of mass outboard of the tip.")
    mast_length: fields.Offset = needed("Length from the elastic axis at the tip forward to the hub.")
    mast_height: fields.Offset = optional("Offset of the hub above the elastic axis at the tip.")
    mast_outboard: fields.Offset = optional("Offset of the hub outboard of the tip.")
    hub_mass: fields.MassOrNone = optional("Mass of the rotor's hub, without the blades.")
    rotor_mass: fields.MassOrNone = needed("Mass of the rotor model at the hub, which the modes include.")
    downstop: bool = optional("Whether the pylon is on its downstop.", True)
    downstop_stiffness_on: fields.PositiveStiffness = optional(
        "Pitch stiffness from pylon to wing, on the downstop; rigid if left out."
    )
    downstop_stiffness_off: fields.PositiveStiffness = optional(
        "Pitch stiffness from pylon to wing, off the downstop; rigid if left out."
    )
    modes: fields.Size = optional("Number of lowest modes to keep; all coordinates if left out.")
    damping_ratio: fields.DampingRatio = optional("Damping ratio of every mode, relative to critical.")
    loss_factor: fields.NotNegative = optional("Structural g of every mode, used as a damping ratio g/2.")
    beam_damping_ratio: fields.DampingRatio = optional("Damping ratio of beam modes, if it differs.")
    chord_damping_ratio: fields.DampingRatio = optional("Damping ratio of chord modes, if it differs.")
    torsion_damping_ratio: fields.DampingRatio = optional("Damping ratio of torsion modes, if it differs.")
    wing_aerodynamics: WingAerodynamicsSection | None = optional("Airloads of the wing; none if left out.")

    @model_validator(mode="after")
    def _one_damping(self) -> Self:
        _exactly_one(self, "damping_ratio", "loss_factor")
        return self


class BeamWingSection(_WingSection):
    """A cantilever wing of beam elements with a rigid pylon."""

    alternatives: ClassVar[tuple[Sides, ...]] = (
        *DAMPING_ALTERNATIVES,
        *ROTOR_ALTERNATIVES,
        *STIFFNESS_ALTERNATIVES,
    )
    may_lack: ClassVar[tuple[str, ...]] = tuple(
        name for choice in STIFFNESS_ALTERNATIVES for side in choice for name in side
    )
    defaults: ClassVar[Mapping[str, float]] = {factor: 1.0 for (factor,), _ in STIFFNESS_ALTERNATIVES}

    kind: Literal["beam-wing"] = needed("A wing of beam elements.")
    rotor_mass: fields.MassOrNone = optional("Mass of the rotor model at the hub, which the modes include.")
    rotor_held: fields.Held = optional(
        "How the rotor, which the modes include, is held in them, in place of a mass: tilting on its gimbal, as one "
        "body with the shaft, or a point mass at the hub."
    )
    shaft: fields.Shaft = optional(
        "Whether a rotor that is held gimballed or rigid can turn about its shaft; held if left out."
    )
    beam_stiffness_factor: fields.Positive = optional("Factor on beam_stiffness; 1 if left out.")
    chord_stiffness_factor: fields.Positive = optional("Factor on chord_stiffness; 1 if left out.")
    torsion_stiffness_factor: fields.Positive = optional("Factor on torsion_stiffness; 1 if left out.")
    beam_frequency: fields.PositiveFrequency = optional(
        "Frequency of the beam mode with the rotor, to which beam_stiffness_factor is fitted."
    )
    chord_frequency: fields.PositiveFrequency = optional(
        "Frequency of the chord mode with the rotor, to which chord_stiffness_factor is fitted."
    )
    torsion_frequency: fields.PositiveFrequency = optional(
        "Frequency of the torsion mode with the rotor, to which torsion_stiffness_factor is fitted."
    )

    @model_validator(mode="after")
    def _one_rotor(self) -> BeamWingSection:
        _exactly_one(self, "rotor_mass", "rotor_held")
        for (factor,), (frequency,) in STIFFNESS_ALTERNATIVES:
            if self.model_fields_set.issuperset((factor, frequency)):
                rule = f"must not be given with {frequency}, to which the factor is fitted"
                raise InputError(factor, None, rule)
        return self


class FuselageSection(Section):
    """A free rigid fuselage, by its own mass or by that of the whole aircraft."""

    whole_aircraft: bool = needed(
        "Whether the numbers are those of the whole aircraft; what wings, nacelles and rotors have is then taken off."
    )
    mass: fields.Mass = needed("Mass.")
    roll_inertia: fields.Inertia = needed("Inertia about the axis forward through the centre of mass.")
    pitch_inertia: fields.Inertia = needed("Inertia about the axis outboard through the centre of mass.")
    yaw_inertia: fields.Inertia = needed("Inertia about the axis upward through the centre of mass.")
    product_of_inertia: fields.ProductOfInertia = optional(
        "Integral of distance forward times distance up from the centre of mass."
    )
    centre_forward: fields.Offset = needed(
        "Centre of mass ahead of the elastic axis of the wing at the fuselage side."
    )
    centre_up: fields.Offset = needed(
        "Centre of mass above the elastic axis of the wing at the fuselage side."
    )


class CarryThroughSection(Section):
    """The box that carries the wing through the fuselage, and what the fuselage holds at its side.

    Displacements are held; properties left out are those of the wing root."""

    half_width: fields.PositiveLength = needed("Distance from the plane of symmetry to the fuselage side.")
    beam_stiffness: fields.UniformStiffness = optional("Stiffness EI of bending up and down.")
    chord_stiffness: fields.UniformStiffness = optional("Stiffness EI of bending fore and aft.")
    torsion_stiffness: fields.UniformStiffness = optional("Torsion stiffness GJ.")
    axial_stiffness: fields.UniformAxialStiffness = optional("Axial stiffness EA.")
    mass_per_length: fields.UniformMass = optional("Mass per length.")
    torsional_inertia_per_length: fields.UniformInertia = optional(
        "Inertia per length about the elastic axis."
    )
    bending_slope: fields.Joint = optional(
        'Turn of the wing against the fuselage about the forward axis: "held", "free" or a stiffness at each side; '
        "free if left out."
    )
    chord_slope: fields.Joint = optional(
        'Turn of the wing against the fuselage about the upward axis: "held", "free" or a stiffness at each side; '
        "free if left out."
    )
    twist: fields.Joint = optional(
        'Turn of the wing against the fuselage about the outboard axis: "held" or a stiffness at each side, or "free" '
        "on one side alone or with antisymmetric motion alone; held if left out."
    )
    elements: fields.Size = optional("Number of elements of equal length.")


class TailSection(Section):
    """A tail of the aircraft: quasi-steady airloads on the motion of the fuselage."""

    area: fields.Area = needed("Area; of all vertical tails together.")
    lift_slope: fields.Slope = needed("Lift slope of the whole tail on its area.")
    arm: fields.Offset = needed(
        "Aerodynamic centre behind the elastic axis of the wing at the fuselage side."
    )
    height: fields.Offset = optional(
        "Aerodynamic centre above the elastic axis of the wing at the fuselage side."
    )
    wash: fields.Fraction = optional(
        "Downwash dε/dα or sidewash: share of the incidence that is lost at the tail."
    )


class AircraftSection(_WingSection):
    """A whole aircraft with two mirrored rotors: free fuselage, box, wings, and pylons on springs.

    The fields of the wing and the pylon are those of each side, the span from the fuselage side to the pylon."""

    kind: Literal["aircraft"] = needed("A whole aircraft.")
    modes: fields.Size = needed("Number of lowest elastic modes of each symmetry.")
    symmetry: Literal["both", "symmetric", "antisymmetric"] = optional(
        "Which motions of the aircraft the model has.", "both"
    )
    spindle_yaw_stiffness_on: fields.PositiveStiffness = optional(
        "Yaw stiffness from pylon to wing, on the downstop; rigid if left out."
    )
    spindle_yaw_stiffness_off: fields.PositiveStiffness = optional(
        "Yaw stiffness from pylon to wing, off the downstop; rigid if left out."
    )
    pylon_yaw_damping_ratio: fields.DampingRatio = optional(
        "Damping ratio of pylon yaw modes, if it differs."
    )
    fuselage: FuselageSection = needed("The fuselage.")
    carry_through: CarryThroughSection = needed("The box through the fuselage.")
    horizontal_tail: TailSection | None = optional("Airloads of the horizontal tail; none if left out.")
    vertical_tail: TailSection | None = optional("Airloads of the vertical tails; none if left out.")


class MatricesSection(Section):
    """Mass, stiffness and damping matrices of any finite-element code."""

    alternatives: ClassVar[tuple[Sides, ...]] = FILE_ALTERNATIVES
    may_lack: ClassVar[tuple[str, ...]] = ("damping", "hub_motion")

    kind: Literal["matrices"] = needed("Matrices from files.")
    file: fields.File = optional(
        "An .npz file with mass, stiffness, dofs and perhaps damping, hub for modal coordinates; or a .mat file of "
        "MATLAB with M, K, dofs and perhaps C, Phi."
    )
    mass: fields.File = optional("Matrix Market file of the mass.")
    stiffness: fields.File = optional("Matrix Market file of the stiffness.")
    damping: fields.File = optional("Matrix Market file of the damping.")
    dofs: fields.File = optional("Text file with the name of a coordinate on each line.")
    hub_motion: fields.File = optional(
        "Matrix Market file of the hub's motion, 6 rows with x to alpha_z and a column for each modal coordinate."
    )
    hub: dict[str, str] | None = optional(
        'Coordinate of the hub for each of x, y, z, alpha_x, alpha_y, alpha_z, with "-" in front if it has the '
        "opposite direction; hub_x and so on if left out. Not for modal coordinates."
    )
    carries: fields.Carries = optional(f"{_CARRIES} Needed for modal coordinates, and for no others.")
    includes_rotor: fields.IncludesRotor = needed(_HELD)
    shaft: fields.Shaft = optional(_SHAFT)
    rotor_mass: fields.MassOrNone = optional(
        "Mass of the rotor model at the hub, which the modes include; not for a mass matrix that includes the rotor."
    )
    modes: fields.Size = optional("Number of lowest modes to keep; all coordinates if left out.")
    damping_ratio: fields.DampingRatios = optional(
        "Damping ratio of every mode, relative to critical, or a list with one for each of the lowest; added to "
        "a damping matrix; 0 if left out."
    )
    length_unit: fields.PositiveLength = optional("Unit of length of the files; 1 m if left out.")
    mass_unit: fields.Mass = optional("Unit of mass of the files; 1 kg if left out.")
    wing_aerodynamics: AssumedShapeSection | None = optional("Airloads of the wing; none if left out.")

    @model_validator(mode="after")
    def _one_file_or_several(self) -> MatricesSection:
        _exactly_one(self, "file", "mass")
        several = [
            name for name in ("stiffness", "damping", "dofs", "hub_motion") if name in self.model_fields_set
        ]
        if self.file is not None and several:
            raise InputError(several[0], None, "must not be given with file, which holds it")
        for name in ("stiffness", "dofs"):
            if self.file is None and name not in self.model_fields_set:
                raise InputError(name, None, "is missing")
        if self.hub_motion is not None and self.hub is not None:
            raise InputError(
                "hub", None, "must not be given with hub_motion, which has the motion of the hub"
            )
        return self


class NastranSection(Section):
    """Real modes of a Nastran run at a grid point, or the matrices of a reduced structure."""

    kind: Literal["nastran"] = needed("A file of a Nastran run.")
    file: fields.File = needed("Real modes: .op2, .h5, .pch or .f06. Matrices of EXTSEOUT: .pch or .op4.")
    grid: fields.Size = needed("The grid point at the hub.")
    subcase: fields.Size = optional("Subcase, needed for a file with several.")
    generalized_mass: fields.Positives = optional(
        "Generalised mass of every mode, in units of the run, or of each of the lowest modes in a list whose last "
        "value holds for all above. Needed for a file without eigenvalue table (LAMA), and for no other."
    )
    coordinates: fields.File = optional(
        "For an .op4 file: the file of bulk data beside it (.pch or .asm), whose entry EXTRN names the coordinates."
    )
    hub: dict[str, str] | None = optional(
        'One of T1 to R3 for each of x, y, z, alpha_x, alpha_y, alpha_z, with "-" in front if it has the opposite '
        "direction; aircraft axes if left out."
    )
    names: Annotated[list[fields.Name], Field(min_length=1)] | None = optional(
        "Names of the modes; mode_1 and so on, by the numbers of the run, if left out."
    )
    includes_rotor: fields.IncludesRotor = needed(_HELD)
    shaft: fields.Shaft = optional(_SHAFT)
    carries: fields.Carries = optional(f"{_CARRIES} One rotor if left out.")
    modes: fields.Size = optional("Number of lowest modes to keep; all if left out.")
    damping_ratio: fields.DampingRatios = optional(
        "Damping ratio of every mode, or of each of the lowest modes in a list whose last value holds for all above; 0 "
        "if left out."
    )
    length_unit: fields.PositiveLength = optional("Unit of length of the run; 1 m if left out.")
    mass_unit: fields.Mass = optional("Unit of mass of the run; 1 kg if left out.")
    wing_aerodynamics: AssumedShapeSection | None = optional("Airloads of the wing; none if left out.")


class UniversalSection(Section):
    """Real normal modes of a universal file, of a test or of a finite-element code, with their modal masses."""

    kind: Literal["universal"] = needed("A universal file (.unv, .uff).")
    file: fields.File = needed("The universal file.")
    node: fields.Size = needed("The node at the hub.")
    rigid_nodes: str = optional(
        "Measured nodes that are rigid with the hub, separated by blanks, for a test with translations alone; the node "
        "at the hub needs a position in the file then.",
        "",
    )
    hub: dict[str, str] | None = optional(
        'One of X, Y, Z, RX, RY, RZ for each of x, y, z, alpha_x, alpha_y, alpha_z, with "-" in front if it has the '
        "opposite direction; aircraft axes if left out."
    )
    includes_rotor: fields.IncludesRotor = needed(_HELD)
    shaft: fields.Shaft = optional(_SHAFT)
    carries: fields.Carries = optional(f"{_CARRIES} One rotor if left out.")
    modes: fields.Size = optional("Number of lowest modes to keep; all if left out.")
    damping_ratio: fields.DampingRatios = optional(
        "Damping ratio of every mode, or a list with one for each of the lowest; those of the file if left out."
    )
    length_unit: fields.PositiveLength = optional(
        "Unit of length of the file; that of its dataset 164 if left out."
    )
    mass_unit: fields.Mass = optional("Unit of mass of the file; that of its dataset 164 if left out.")
    wing_aerodynamics: AssumedShapeSection | None = optional("Airloads of the wing; none if left out.")

    @field_validator("rigid_nodes")
    @classmethod
    def _whole_numbers(cls, text: str) -> str:
        """Refuse a list of nodes that is none."""
        if not all(word.isascii() and word.isdigit() for word in text.replace(",", " ").split()):
            raise InputError("", text, 'must be whole numbers, such as "101 102 103"')
        return text


class PivotSection(Section):
    """A rigid shaft that pitches and yaws about a point behind the hub; damping is 0 if left out."""

    defaults: ClassVar[Mapping[str, float]] = {"pitch_damping": 0.0, "yaw_damping": 0.0}

    kind: Literal["pivot"] = needed("A shaft on a pivot.")
    includes_rotor: fields.IncludesRotor = needed(_HELD)
    shaft: fields.Shaft = optional(_SHAFT)
    distance: fields.Offset = needed("Distance from the pivot forward to the hub.")
    pitch_inertia: fields.Inertia = needed("Moment of inertia in pitch about the pivot.")
    yaw_inertia: fields.Inertia = needed("Moment of inertia in yaw about the pivot.")
    pitch_stiffness: fields.Stiffness = needed("Pitch stiffness of the pivot.")
    yaw_stiffness: fields.Stiffness = needed("Yaw stiffness of the pivot.")
    pitch_damping: fields.Damping = optional("Pitch damping of the pivot.")
    yaw_damping: fields.Damping = optional("Yaw damping of the pivot.")


class RigidSection(Section):
    """A hub that does not move."""

    kind: Literal["rigid"] = needed("A hub that does not move.")


SupportSection = Annotated[
    NormalModesSection
    | BeamWingSection
    | AircraftSection
    | MatricesSection
    | NastranSection
    | UniversalSection
    | PivotSection
    | RigidSection,
    Field(discriminator="kind"),
]


def _exactly_one(section: Section, one: str, other: str) -> None:
    """Refuse a section that gives both of two fields, or neither."""
    given = section.model_fields_set.intersection((one, other))
    if not given:
        raise InputError(one, None, f"is missing; give {one} or {other}")
    if len(given) > 1:
        raise InputError(other, None, f"must not be given with {one}")
