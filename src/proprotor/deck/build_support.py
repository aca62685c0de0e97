"""Build the support of a deck, for one design or a batch of designs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from proprotor.datum import Datum
from proprotor.deck.build_aircraft import build_aircraft
from proprotor.deck.each_design import at_each_point, different_designs, must_be_real, si_values
from proprotor.support.beam_wing import Pylon, Wing, beam_structure, on_coordinates
from proprotor.support.matrix_files import read_matrix_market, read_npz
from proprotor.support.nastran import nastran_modes
from proprotor.support.normal_modes import HUB_AXES, NormalModes, rigid_support, two_axis_pivot
from proprotor.support.wing_aerodynamics import (
    Strips,
    WingAerodynamics,
    beam_strips,
    cantilever_strips,
    in_airstream,
)
from proprotor.typing import Array

if TYPE_CHECKING:
    from proprotor.deck import support_sections

_KINDS_OF_STRAIN = ("beam", "chord", "torsion")


def build_support(
    section: support_sections.SupportSection,
    numbers: Mapping[str, Datum],
    names: tuple[str, ...] = (),
    left: support_sections.AircraftSection | None = None,
) -> NormalModes:
    """Return the support of the section [support] of a deck.

    Parameters
    ----------
    section : SupportSection
    numbers : mapping of str to Datum
        The deck's numbers by path, perhaps arrays of many designs, or complex. The numbers of a file must be real.
    names : tuple of str
        The order of the coordinates of many designs of a beam wing or an aircraft, by default the order of the first
        design.
    left : AircraftSection, optional
        The section of the left side of an aircraft whose structure differs there.

    Raises
    ------
    InputError
        When a number is not physical, or a file cannot be used.
    """
    if section.kind == "beam-wing":
        return _beam_wing(section, numbers, names)
    if section.kind == "aircraft":
        return build_aircraft(section, numbers, names, left)
    return _BUILDERS[section.kind](section, numbers)


def _normal_modes(section: support_sections.NormalModesSection, numbers: Mapping[str, Datum]) -> NormalModes:
    """Return the support of normal modes."""
    names = [mode.name for mode in section.modes]
    modes = [si_values(numbers, f"support.modes[{name}]") for name in names]
    hub = [_side_by_side(mode.get(axis, 0.0) for mode in modes) for axis in HUB_AXES]
    support = NormalModes.from_frequencies(
        names=names,
        generalized_mass=_side_by_side(mode["generalized_mass"] for mode in modes),
        frequency=_side_by_side(mode["frequency"] for mode in modes),
        damping_ratio=_side_by_side(mode["damping_ratio"] for mode in modes),
        hub=np.stack(np.broadcast_arrays(*hub), axis=-2),
        **si_values(numbers, "support"),
    )
    return _with_assumed_airloads(support, section, numbers)


def _pivot(section: support_sections.PivotSection, numbers: Mapping[str, Datum]) -> NormalModes:
    """Return the support of a shaft on a pivot."""
    given = si_values(numbers, "support")
    pairs: dict[str, Any] = {
        name: _side_by_side(given.pop(f"{axis}_{name}", 0.0) for axis in ("pitch", "yaw"))
        for name in ("inertia", "stiffness", "damping")
    }
    return two_axis_pivot(**given, **pairs)


def _from_files(
    section: support_sections.MatricesSection | support_sections.NastranSection, numbers: Mapping[str, Datum]
) -> NormalModes:
    """Return the support in the files of a section."""
    given = si_values(numbers, "support")
    must_be_real(given)
    read: Callable[..., NormalModes] = nastran_modes
    if section.kind == "matrices":
        read = read_matrix_market if section.file is None else read_npz
    return _with_assumed_airloads(read(**given, hub=section.hub), section, numbers)


def _beam_wing(
    section: support_sections.BeamWingSection, numbers: Mapping[str, Datum], names: tuple[str, ...]
) -> NormalModes:
    """Return the support of a beam wing, for many designs with the coordinates in the order of the names."""
    given = si_values(numbers, "support")
    designs, place = different_designs(given)
    parts = [_beam_wings(part, section.downstop, names if place.ndim else ()) for part in designs]
    support, strips = at_each_point(parts, place, own=(1, 2, 2))
    if section.wing_aerodynamics is None:
        return support
    airloads = si_values(numbers, "support.wing_aerodynamics")
    return in_airstream(support, Strips(*strips), WingAerodynamics(**airloads, sweep=given.get("sweep", 0.0)))


def _beam_wings(
    given: Mapping[str, Any], downstop: bool, names: tuple[str, ...]
) -> tuple[NormalModes, Strips]:
    """Return the supports and the aerodynamic strips of beam wings, whose numbers are arrays (designs,)."""
    spring = given.get("downstop_stiffness_on" if downstop else "downstop_stiffness_off")
    wing, pylon = (
        {entry.name: given[entry.name] for entry in fields(kind) if entry.name in given}
        for kind in (Wing, Pylon)
    )
    structure = beam_structure(Wing(**wing), Pylon(**pylon, pitch_stiffness=spring))
    every = given["damping_ratio"] if "damping_ratio" in given else given["loss_factor"] / 2
    ratios = {kind: given.get(f"{kind}_damping_ratio", every) for kind in _KINDS_OF_STRAIN} | {"axial": every}
    found = on_coordinates(structure, given.get("modes"), ratios, given["rotor_mass"], names)
    return found.support, beam_strips(structure, found.shapes)


def _with_assumed_airloads(support: NormalModes, section: Any, numbers: Mapping[str, Datum]) -> NormalModes:
    """Return the support with the airloads of a wing that bends as a cantilever, if the section has any."""
    if section.wing_aerodynamics is None:
        return support
    given = si_values(numbers, "support.wing_aerodynamics")
    strips = cantilever_strips(support, given.pop("span"), given.pop("mast_length"))
    return in_airstream(support, strips, WingAerodynamics(**given))


_BUILDERS: dict[str, Callable[[Any, Mapping[str, Datum]], NormalModes]] = {
    "normal-modes": _normal_modes,
    "matrices": _from_files,
    "nastran": _from_files,
    "pivot": _pivot,
    "rigid": lambda section, numbers: rigid_support(),
}


def _side_by_side(values: Iterable[Any]) -> Array:
    """Return the numbers of the modes along a last axis; leading axes are the axes of many designs."""
    return np.stack(np.broadcast_arrays(*values), axis=-1)
