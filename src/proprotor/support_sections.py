"""The section [support] of a deck, one set of fields for each kind.

``kind = "normal-modes"``
    includes_rotor, whether the generalised masses hold the rotor's rigid-body share; a table
    ``[[support.modes]]`` for each mode with name; coordinate, "length" or "angle"; generalized_mass,
    frequency, damping_ratio; and the motion of the hub per unit of the coordinate, x, y, z, alpha_x, alpha_y,
    alpha_z, zero where left out.
``kind = "beam-wing"``
    The arguments of `proprotor.beam_wing.Wing` and `Pylon`, a property along the wing one value or
    ``{ y_over_span = [...], value = [...], unit = "lbf*in**2" }``. The downstop: downstop, on (true) or off;
    downstop_stiffness_on and downstop_stiffness_off, rigid where left out. rotor_mass, what the rotor model has at
    the hub. modes, how many to keep, all coordinates when left out; damping_ratio or loss_factor of every mode and
    beam_damping_ratio, chord_damping_ratio, torsion_damping_ratio of those.
``kind = "matrices"``
    file, an .npz file, or mass, stiffness, dofs and perhaps damping, Matrix Market files and a list of names: see
    `proprotor.support_file`. A table hub; includes_rotor, rotor_mass, modes, damping_ratio, length_unit, mass_unit.
``kind = "nastran"``
    file, an .op2 file, and grid: see `proprotor.nastran`. subcase, a table hub, includes_rotor, modes, damping_ratio,
    length_unit, mass_unit.
``kind = "pivot"``
    distance from pivot to hub; pitch_inertia, yaw_inertia, pitch_stiffness, yaw_stiffness, pitch_damping,
    yaw_damping; includes_rotor.
``kind = "rigid"``
    Nothing: the hub does not move.
``[support.wing_aerodynamics]``
    Quasi-steady airloads of the wing, left out unless this table is there: lift_slope, chord, elastic_axis and perhaps
    aerodynamic_centre and downwash_point, see `proprotor.wing_aerodynamics`; for kinds other than beam-wing
    also span, mast_length and sweep.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from proprotor.deck_fields import (
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
    Size,
    Slope,
    Stiffness,
)
from proprotor.errors import InputError
from proprotor.support import HUB_AXES


class WingAerodynamicsSection(Section):
    lift_slope: Slope
    chord: PositiveLength
    elastic_axis: Number
    aerodynamic_centre: Number = None
    downwash_point: Number = None


class AssumedShapeSection(WingAerodynamicsSection):
    span: PositiveLength
    mast_length: Offset
    sweep: Angle = None


class ModeSection(Section):
    name: Name
    coordinate: Literal["length", "angle"]
    generalized_mass: GeneralizedMass
    frequency: Frequency
    damping_ratio: DampingRatio
    x: HubDisplacement = None
    y: HubDisplacement = None
    z: HubDisplacement = None
    alpha_x: HubRotation = None
    alpha_y: HubRotation = None
    alpha_z: HubRotation = None

    @model_validator(mode="after")
    def _moves_the_hub(self) -> ModeSection:
        if not self.model_fields_set.intersection(HUB_AXES):
            raise InputError("", None, f"must move the hub; give one or more of {', '.join(HUB_AXES)}")
        return self


class NormalModesSection(Section):
    kind: Literal["normal-modes"]
    includes_rotor: bool
    modes: Annotated[list[ModeSection], Field(min_length=1)]
    wing_aerodynamics: AssumedShapeSection | None = None

    @model_validator(mode="after")
    def _names_differ(self) -> NormalModesSection:
        names = [mode.name for mode in self.modes]
        for name in names:
            if names.count(name) > 1:
                raise InputError("modes.name", name, "must not name two modes")
        return self


class BeamWingSection(Section):
    kind: Literal["beam-wing"]
    span: PositiveLength
    beam_stiffness: BendingStiffness
    chord_stiffness: BendingStiffness
    torsion_stiffness: BendingStiffness
    axial_stiffness: AxialStiffness
    mass_per_length: MassPerLength
    torsional_inertia_per_length: InertiaPerLength
    sweep: Angle = None
    dihedral: Angle = None
    elements: Size = None
    nacelle_mass: MassOrNone
    nacelle_pitch_inertia: InertiaOrNone
    nacelle_yaw_inertia: InertiaOrNone
    nacelle_roll_inertia: InertiaOrNone
    nacelle_forward: Offset = None
    nacelle_up: Offset = None
    nacelle_outboard: Offset = None
    mast_length: Offset
    mast_height: Offset = None
    mast_outboard: Offset = None
    hub_mass: MassOrNone = None
    rotor_mass: MassOrNone
    downstop: bool = True
    downstop_stiffness_on: PositiveStiffness = None
    downstop_stiffness_off: PositiveStiffness = None
    modes: Size = None
    damping_ratio: DampingRatio = None
    loss_factor: NotNegative = None
    beam_damping_ratio: DampingRatio = None
    chord_damping_ratio: DampingRatio = None
    torsion_damping_ratio: DampingRatio = None
    wing_aerodynamics: WingAerodynamicsSection | None = None

    @model_validator(mode="after")
    def _one_damping(self) -> BeamWingSection:
        _exactly_one(self, "damping_ratio", "loss_factor")
        return self


class MatricesSection(Section):
    kind: Literal["matrices"]
    file: File = None
    mass: File = None
    stiffness: File = None
    damping: File = None
    dofs: File = None
    hub: dict[str, str] | None = None
    includes_rotor: bool
    rotor_mass: MassOrNone = None
    modes: Size = None
    damping_ratio: DampingRatio = None
    length_unit: PositiveLength = None
    mass_unit: Mass = None
    wing_aerodynamics: AssumedShapeSection | None = None

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
    kind: Literal["nastran"]
    file: File
    grid: Size
    subcase: Size = None
    hub: dict[str, str] | None = None
    includes_rotor: bool
    modes: Size = None
    damping_ratio: DampingRatio = None
    length_unit: PositiveLength = None
    mass_unit: Mass = None
    wing_aerodynamics: AssumedShapeSection | None = None


class PivotSection(Section):
    kind: Literal["pivot"]
    includes_rotor: bool
    distance: Offset
    pitch_inertia: Inertia
    yaw_inertia: Inertia
    pitch_stiffness: Stiffness
    yaw_stiffness: Stiffness
    pitch_damping: Damping = None
    yaw_damping: Damping = None


class RigidSection(Section):
    kind: Literal["rigid"]


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
