"""Build the support of a deck, for one design or a batch of designs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from proprotor.datum import Datum
from proprotor.deck.numbers import own_numbers
from proprotor.errors import InputError
from proprotor.model.rotor_share import rotor_share
from proprotor.support.beam_wing import Pylon, Wing, beam_structure, on_coordinates
from proprotor.support.matrix_files import read_matrix_market, read_npz
from proprotor.support.nastran import nastran_modes
from proprotor.support.normal_modes import HUB_AXES, NormalModes, rigid_support, two_axis_pivot
from proprotor.support.stiffness_factors import KINDS, stiffened, stiffness_factors
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
_BYTES = 16_000  # at most, of matrices of a beam wing for each pair of nodes
_PART = 200e6  # bytes of beam wings that are built at once


def build_support(
    section: support_sections.SupportSection,
    numbers: Mapping[str, Datum],
    names: tuple[str, ...] = (),
    *,
    mass_at_rest: Array,
) -> NormalModes:
    """Return the support of the section [support] of a deck.

    Parameters
    ----------
    section : SupportSection
    numbers : mapping of str to Datum
        The deck's numbers by path, perhaps arrays of many designs, or complex. The numbers of a file must be real.
    names : tuple of str
        The order of the coordinates of many designs of a beam wing, by default the order of the first design.
    mass_at_rest : array (..., 8, 8)
        Mass of the rotor, see `proprotor.model.mass_at_rest`, for a beam wing whose modes include the rotor.

    Raises
    ------
    InputError
        When a number is not physical, or a file cannot be used.
    """
    if section.kind == "beam-wing":
        return _beam_wing(section, numbers, names, mass_at_rest)
    return _BUILDERS[section.kind](section, numbers)


def _normal_modes(section: support_sections.NormalModesSection, numbers: Mapping[str, Datum]) -> NormalModes:
    """Return the support of normal modes."""
    names = [mode.name for mode in section.modes]
    modes = [_values(numbers, f"support.modes[{name}]") for name in names]
    hub = [_side_by_side(mode.get(axis, 0.0) for mode in modes) for axis in HUB_AXES]
    support = NormalModes.from_frequencies(
        names=names,
        generalized_mass=_side_by_side(mode["generalized_mass"] for mode in modes),
        frequency=_side_by_side(mode["frequency"] for mode in modes),
        damping_ratio=_side_by_side(mode["damping_ratio"] for mode in modes),
        hub=np.stack(np.broadcast_arrays(*hub), axis=-2),
        **_values(numbers, "support"),
    )
    return _with_assumed_airloads(support, section, numbers)


def _pivot(section: support_sections.PivotSection, numbers: Mapping[str, Datum]) -> NormalModes:
    """Return the support of a shaft on a pivot."""
    given = _values(numbers, "support")
    pairs: dict[str, Any] = {
        name: _side_by_side(given.pop(f"{axis}_{name}", 0.0) for axis in ("pitch", "yaw"))
        for name in ("inertia", "stiffness", "damping")
    }
    return two_axis_pivot(**given, **pairs)


def _from_files(
    section: support_sections.MatricesSection | support_sections.NastranSection, numbers: Mapping[str, Datum]
) -> NormalModes:
    """Return the support in the files of a section."""
    given = _values(numbers, "support")
    _must_be_real(given)
    read: Callable[..., NormalModes] = nastran_modes
    if section.kind == "matrices":
        read = read_matrix_market if section.file is None else read_npz
    return _with_assumed_airloads(read(**given, hub=section.hub), section, numbers)


def _beam_wing(
    section: support_sections.BeamWingSection,
    numbers: Mapping[str, Datum],
    names: tuple[str, ...],
    mass_at_rest: Array,
) -> NormalModes:
    """Return the support of a beam wing, for many designs with the coordinates in the order of the names."""
    given = _wing_numbers(numbers, mass_at_rest)
    designs, place = _different_designs(given)
    parts = [_beam_wings(part, section.downstop, names if place.ndim else ()) for part in designs]
    support, strips = _at_each_point(parts, place)
    if section.wing_aerodynamics is None:
        return support
    airloads = _values(numbers, "support.wing_aerodynamics")
    return in_airstream(support, strips, WingAerodynamics(**airloads, sweep=given.get("sweep", 0.0)))


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
    designs, place = _different_designs(_wing_numbers(numbers, mass_at_rest))
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
    """Return the stiffness factors (designs,) of beam wings by kind."""
    frequency = {kind: given[f"{kind}_frequency"] for kind in kinds}
    found = stiffness_factors(*_wing_and_pylon(given, downstop), _at_hub(given), frequency)
    for kind, reasons in found.reasons.items():
        for value, reason in zip(np.broadcast_to(frequency[kind], reasons.shape), reasons, strict=True):
            if reason:
                raise InputError(f"{kind}_frequency", float(np.real(value)), reason)
    return found.factors


def _wing_numbers(numbers: Mapping[str, Datum], mass_at_rest: Array) -> dict[str, Any]:
    """Return the numbers of a beam wing and, entry by entry, the mass of its rotor on the motions of the hub."""
    given = _values(numbers, "support")
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
    given = _values(numbers, "support.wing_aerodynamics")
    strips = cantilever_strips(support, given.pop("span"), given.pop("mast_length"))
    return in_airstream(support, strips, WingAerodynamics(**given))


_BUILDERS: dict[str, Callable[[Any, Mapping[str, Datum]], NormalModes]] = {
    "normal-modes": _normal_modes,
    "matrices": _from_files,
    "nastran": _from_files,
    "pivot": _pivot,
    "rigid": lambda section, numbers: rigid_support(),
}


def _different_designs(given: Mapping[str, Any]) -> tuple[list[dict[str, Any]], Array]:
    """Return the numbers of all different designs of a batch, and the place of each point's design among these.

    A search evaluates one design at many airspeeds, so equal designs are built once. The designs come in parts that fit
    into memory, each part with arrays (designs,) of the numbers that vary.
    """
    varied = {name: value for name, value in given.items() if np.ndim(value) and not isinstance(value, tuple)}
    spread = np.broadcast_arrays(np.zeros(()), *varied.values())[1:]
    shape = np.broadcast_shapes(*(value.shape for value in varied.values()))
    columns = [part.ravel() for value in spread for part in (np.real(value), np.imag(value))]
    table = np.stack(columns or [np.zeros(1)], axis=-1)
    _, first, place = np.unique(table, axis=0, return_index=True, return_inverse=True)
    different = {name: value.ravel()[first] for name, value in zip(varied, spread, strict=True)}
    if "span" not in different:  # one design is a batch of one
        different["span"] = np.broadcast_to(given["span"], first.shape)
    size = _BYTES * (given.get("elements", Wing.elements) + 1) ** 2
    step = max(1, int(_PART // size))
    parts = [slice(start, start + step) for start in range(0, len(first), step)]
    designs = [dict(given) | {name: value[part] for name, value in different.items()} for part in parts]
    return designs, place.reshape(shape)


def _at_each_point(parts: Sequence[tuple[NormalModes, Strips]], place: Array) -> tuple[NormalModes, Strips]:
    """Return the supports and strips of all designs at each point of a batch, by the place of its design."""
    supports, strips = zip(*parts, strict=True)

    def spread(arrays: Iterable[Array], own: int) -> Array:
        """Put arrays (designs, ...) of the parts one after another; `own` counts the axes of one design."""
        whole = [
            np.broadcast_to(array, (count, *array.shape[array.ndim - own :]))
            for array, count in zip(arrays, counts, strict=True)
        ]
        return np.concatenate(whole)[place]

    counts = [support.mass.shape[0] for support in supports]
    matrices: dict[str, Any] = {
        name: spread((getattr(support, name) for support in supports), 2)
        for name in ("mass", "damping", "stiffness", "hub")
    }
    several: dict[str, Any] = {"shapes": None, "warning": None}
    if place.ndim and supports[0].shapes is not None:
        several = {
            "shapes": spread((support.shapes for support in supports), 2),
            "warning": spread((support.warning for support in supports), 0),
        }
    along = (spread(arrays, own) for arrays, own in zip(zip(*strips, strict=True), (1, 2, 2), strict=True))
    return replace(supports[0], **matrices, **several), Strips(*along)


def _must_be_real(given: Mapping[str, Any]) -> None:
    """Refuse complex numbers."""
    for name, value in given.items():
        if np.iscomplexobj(value):
            raise InputError(
                name, None, "must be real here; take differences for the derivative with respect to it"
            )


def _values(numbers: Mapping[str, Datum], section: str) -> dict[str, Any]:
    """Return the SI values of a section's own numbers by field; along the wing as (stations, values)."""
    return {
        name: n.si if n.r_over_R is None else (np.array(n.r_over_R), np.array(n.si))
        for name, n in own_numbers(numbers, section).items()
    }


def _side_by_side(values: Iterable[Any]) -> Array:
    """Return the numbers of the modes along a last axis; leading axes are the axes of many designs."""
    return np.stack(np.broadcast_arrays(*values), axis=-1)
