"""Build the support of a deck, for one design or a batch of designs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from proprotor.datum import Datum
from proprotor.deck.build_aircraft import build_aircraft
from proprotor.deck.each_design import at_each_point, different_designs, must_be_real, si_values
from proprotor.errors import InputError
from proprotor.files.fingerprint import fingerprint
from proprotor.model.rotor_share import rotor_share
from proprotor.support.beam_wing import Pylon, Wing, beam_structure, on_coordinates
from proprotor.support.matlab_file import read_matlab
from proprotor.support.matrix_files import read_matrix_market, read_npz
from proprotor.support.nastran import nastran_modes
from proprotor.support.normal_modes import HUB_AXES, NormalModes, rigid_support, two_axis_pivot
from proprotor.support.stiffness_factors import KINDS, stiffened, stiffness_factors
from proprotor.support.universal_modes import universal_modes
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

_AT_HUB = "mass at the hub {} {}"
_FACTORS: dict[tuple[str | bytes, ...], Array] = {}  # stiffness factors of the wings that were fitted last
_MOST_FACTORS = 100_000


def build_support(
    section: support_sections.SupportSection,
    numbers: Mapping[str, Datum],
    names: tuple[str, ...] = (),
    *,
    mass_at_rest: Array,
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
    mass_at_rest : array (..., 8, 8)
        Mass of the rotor, see `proprotor.model.mass_at_rest`, for a beam wing whose modes include the rotor.
    left : AircraftSection, optional
        The section of the left side of an aircraft whose structure differs there.

    Raises
    ------
    InputError
        When a number is not physical, or a file cannot be used.
    """
    if section.kind == "beam-wing":
        return _beam_wing(section, numbers, names, mass_at_rest)
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
        if str(given.get("file", "")).lower().endswith(".mat"):
            read = read_matlab
    else:
        given["names"] = section.names
    return _with_assumed_airloads(read(**given, hub=section.hub), section, numbers)


def _universal(section: support_sections.UniversalSection, numbers: Mapping[str, Datum]) -> NormalModes:
    """Return the support in a universal file."""
    given = si_values(numbers, "support")
    must_be_real(given)
    nodes = [int(word) for word in section.rigid_nodes.replace(",", " ").split()]
    support = universal_modes(**given, rigid_nodes=nodes, hub=section.hub)
    return _with_assumed_airloads(support, section, numbers)


def _beam_wing(
    section: support_sections.BeamWingSection,
    numbers: Mapping[str, Datum],
    names: tuple[str, ...],
    mass_at_rest: Array,
) -> NormalModes:
    """Return the support of a beam wing, for many designs with the coordinates in the order of the names."""
    given = _wing_numbers(numbers, mass_at_rest)
    designs, place = _different_wings(given)
    parts = [_beam_wings(part, section.downstop, names if place.ndim else ()) for part in designs]
    support, strips = at_each_point(parts, place, own=(1, 2, 2))
    if section.wing_aerodynamics is None:
        return support
    airloads = si_values(numbers, "support.wing_aerodynamics")
    return in_airstream(support, Strips(*strips), WingAerodynamics(**airloads, sweep=given.get("sweep", 0.0)))


def fitted_stiffness_factors(
    section: support_sections.SupportSection, numbers: Mapping[str, Datum], mass_at_rest: Array
) -> dict[str, Datum]:
    """Return the stiffness factors, by path, that are fitted to the frequencies of a beam wing, if it has any.

    Parameters
    ----------
    section : SupportSection
    numbers : mapping of str to Datum
    mass_at_rest : array (..., 8, 8)
        As for `build_support`.

    Raises
    ------
    InputError
        When a frequency cannot be had.
    """
    wanted = [kind for kind in KINDS if f"support.{kind}_frequency" in numbers]
    if section.kind != "beam-wing" or not wanted:
        return {}
    designs, place = _different_wings(_wing_numbers(numbers, mass_at_rest))
    parts = [_fitted(part, section.downstop, wanted) for part in designs]
    factors = {kind: np.concatenate([part[kind] for part in parts])[place] for kind in wanted}
    return {
        f"support.{kind}_stiffness_factor": _fitted_factor(kind, factor, section, numbers)
        for kind, factor in factors.items()
    }


def _fitted_factor(
    kind: str, factor: Array, section: support_sections.BeamWingSection, numbers: Mapping[str, Datum]
) -> Datum:
    """Return a fitted factor as a number of the deck."""
    rotor = "the rotor's mass" if section.rotor_held is None else f"the rotor {section.rotor_held.si}"
    given = numbers[f"support.{kind}_frequency"]
    source = f"fitted to {kind}_frequency with {rotor} at the hub; {given.source}"
    return Datum("a batch" if factor.ndim else f"{factor:.5g}", factor, "", "calibrated", source)


def _fitted(given: Mapping[str, Any], downstop: bool, kinds: Sequence[str]) -> dict[str, Array]:
    """Return the stiffness factors (designs,) of beam wings by kind.

    A search builds its designs anew at each step, and a fit takes longer than all else: factors that were found stay.
    """
    varied = {name: value for name, value in given.items() if isinstance(value, np.ndarray) and value.ndim}
    same = fingerprint((downstop, kinds, {name: given[name] for name in given.keys() - varied.keys()}))
    table = np.stack(list(varied.values()), axis=-1)
    keys = [(same, *varied, row.tobytes()) for row in table]
    known = {key: _FACTORS[key] for key in keys if key in _FACTORS}
    if new := [place for place, key in enumerate(keys) if key not in known]:
        wings = {name: value[new] for name, value in varied.items()}
        factors = _newly_fitted(dict(given) | wings, downstop, kinds)
        known.update(zip([keys[place] for place in new], factors, strict=True))
        if len(_FACTORS) > _MOST_FACTORS:
            _FACTORS.clear()
        _FACTORS.update(known)
    found = np.stack([known[key] for key in keys])
    return {kind: found[..., place] for place, kind in enumerate(kinds)}


def _newly_fitted(given: Mapping[str, Any], downstop: bool, kinds: Sequence[str]) -> Array:
    """Return the stiffness factors (designs, kinds) of beam wings."""
    frequency = {kind: given[f"{kind}_frequency"] for kind in kinds}
    found = stiffness_factors(*_wing_and_pylon(given, downstop), _at_hub(given), frequency)
    for kind, reasons in found.reasons.items():
        for value, reason in zip(np.broadcast_to(frequency[kind], reasons.shape), reasons, strict=True):
            if reason:
                raise InputError(f"{kind}_frequency", float(np.real(value)), reason)
    return np.stack([found.factors[kind] for kind in kinds], axis=-1)


def _different_wings(given: Mapping[str, Any]) -> tuple[list[dict[str, Any]], Array]:
    """Return the numbers of all different wings, and the place of each point's wing, see `different_designs`."""
    return different_designs(given, nodes=given.get("elements", Wing.elements) + 1)


def _wing_numbers(numbers: Mapping[str, Datum], mass_at_rest: Array) -> dict[str, Any]:
    """Return the numbers of a beam wing and, entry by entry, the mass of its rotor on the motions of the hub."""
    given = si_values(numbers, "support")
    if "rotor_held" not in given:
        share = np.asarray(given["rotor_mass"])[..., None, None] * np.diag([1.0] * 3 + [0.0] * 3)
    else:
        share = rotor_share(mass_at_rest, given["rotor_held"], given.get("shaft", "held"))
    return given | {_AT_HUB.format(*place): share[..., *place] for place in np.ndindex(6, 6)}


def _at_hub(given: Mapping[str, Any]) -> Array:
    """Return the mass of the rotor on the motions of the hub (..., 6, 6)."""
    entries = [given[_AT_HUB.format(*place)] for place in np.ndindex(6, 6)]
    whole = np.stack(np.broadcast_arrays(*entries), axis=-1)
    return whole.reshape(*whole.shape[:-1], 6, 6)


def _wing_and_pylon(given: Mapping[str, Any], downstop: bool) -> tuple[Wing, Pylon]:
    """Return wing and pylon, the stiffnesses of the wing with the factors that are given."""
    spring = given.get("downstop_stiffness_on" if downstop else "downstop_stiffness_off")
    wing, pylon = (
        {entry.name: given[entry.name] for entry in fields(kind) if entry.name in given}
        for kind in (Wing, Pylon)
    )
    factors = {kind: given[name] for kind in KINDS if (name := f"{kind}_stiffness_factor") in given}
    return stiffened(Wing(**wing), factors), Pylon(**pylon, pitch_stiffness=spring)


def _beam_wings(
    given: Mapping[str, Any], downstop: bool, names: tuple[str, ...]
) -> tuple[NormalModes, Strips]:
    """Return the supports and the aerodynamic strips of beam wings, whose numbers are arrays (designs,)."""
    structure = beam_structure(*_wing_and_pylon(given, downstop))
    every = given["damping_ratio"] if "damping_ratio" in given else given["loss_factor"] / 2
    ratios = {kind: given.get(f"{kind}_damping_ratio", every) for kind in KINDS} | {"axial": every}
    found = on_coordinates(structure, given.get("modes"), ratios, 0.0, names, _at_hub(given))
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
    "universal": _universal,
    "pivot": _pivot,
    "rigid": lambda section, numbers: rigid_support(),
}


def _side_by_side(values: Iterable[Any]) -> Array:
    """Return the numbers of the modes along a last axis; leading axes are the axes of many designs."""
    return np.stack(np.broadcast_arrays(*values), axis=-1)
