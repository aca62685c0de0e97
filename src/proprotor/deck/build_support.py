"""Build the support of a deck, for one design or a batch of designs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from proprotor.datum import Datum
from proprotor.deck.numbers import own_numbers
from proprotor.errors import InputError
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
    section: support_sections.SupportSection, numbers: Mapping[str, Datum], names: tuple[str, ...] = ()
) -> NormalModes:
    """Return the support of the section [support] of a deck.

    Parameters
    ----------
    section : SupportSection
    numbers : mapping of str to Datum
        The deck's numbers by path, perhaps arrays of many designs, or complex. Numbers of the structure of a beam
        wing, and the units of a file, must be real.
    names : tuple of str
        The order of the coordinates of many designs of a beam wing, by default the order of the first design.

    Raises
    ------
    InputError
        When a number is not physical, or a file cannot be used.
    """
    if section.kind == "beam-wing":
        return _beam_wing(section, numbers, names)
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
    section: support_sections.BeamWingSection, numbers: Mapping[str, Datum], names: tuple[str, ...]
) -> NormalModes:
    """Return the support of a beam wing, for many designs with the coordinates in the order of the names."""
    given = _values(numbers, "support")
    _must_be_real(given)
    made = _each_design(given, lambda one: _one_beam_wing(one, section.downstop))
    support, strips = _stacked(made, names or made.flat[0][0].names)
    if section.wing_aerodynamics is None:
        return support
    airloads = _values(numbers, "support.wing_aerodynamics")
    return in_airstream(support, strips, WingAerodynamics(**airloads, sweep=given.get("sweep", 0.0)))


def _one_beam_wing(given: dict[str, Any], downstop: bool) -> tuple[NormalModes, Strips]:
    """Return the support and the aerodynamic strips of one beam wing."""
    spring = given.get("downstop_stiffness_on" if downstop else "downstop_stiffness_off")
    wing, pylon = (
        {entry.name: given[entry.name] for entry in fields(kind) if entry.name in given}
        for kind in (Wing, Pylon)
    )
    structure = beam_structure(Wing(**wing), Pylon(**pylon, pitch_stiffness=spring))
    every = given["damping_ratio"] if "damping_ratio" in given else given["loss_factor"] / 2
    ratios = {kind: given.get(f"{kind}_damping_ratio", every) for kind in _KINDS_OF_STRAIN} | {"axial": every}
    found = on_coordinates(structure, given.get("modes"), ratios, given["rotor_mass"])
    shapes = None if given.get("modes") is None else found.shapes
    return replace(found.support, shapes=shapes), beam_strips(structure, found.shapes)


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


def _each_design(given: Mapping[str, Any], build: Callable[[dict[str, Any]], Any]) -> Any:
    """Return the result of `build` for each design of a batch, in an array of the batch's shape.

    Equal designs are built once, because a search evaluates one design at many airspeeds.
    """
    varied = {name: value for name, value in given.items() if isinstance(value, np.ndarray)}
    spread = np.broadcast_arrays(*varied.values())
    made = np.empty(np.broadcast_shapes(*(value.shape for value in spread)), dtype=object)
    built: dict[tuple[float, ...], Any] = {}
    for place in np.ndindex(made.shape):
        design = tuple(float(value[place]) for value in spread)
        if design not in built:
            built[design] = build(dict(given) | dict(zip(varied, design, strict=True)))
        made[place] = built[design]
    return made


def _stacked(made: Array, names: tuple[str, ...]) -> tuple[NormalModes, Strips]:
    """Return the designs of a batch as one support and its strips, with the axes of the batch in front.

    The coordinates of each design are put in the order of the names, so that the order is the same in every batch.
    """
    first, strips = made.flat[0]
    if not made.shape:
        return replace(first, shapes=None), strips

    def stack(parts: list[Any]) -> Array:
        return np.stack(parts).reshape(*made.shape, *parts[0].shape)

    ordered = [_in_order(support, own, names) for support, own in made.flat]
    matrices: dict[str, Any] = {
        name: stack([getattr(support, name) for support, _ in ordered])
        for name in ("mass", "damping", "stiffness", "hub")
    }
    if first.shapes is not None:
        matrices["shapes"] = stack([support.shapes for support, _ in ordered])
        warnings = [_named_otherwise(support.names, names) for support, _ in made.flat]
        matrices["warning"] = np.array(warnings, dtype=object).reshape(made.shape)
    together = zip(*(own for _, own in ordered), strict=True)
    return replace(first, names=names, **matrices), Strips(*(stack(list(parts)) for parts in together))


def _in_order(support: NormalModes, strips: Strips, names: Sequence[str]) -> tuple[NormalModes, Strips]:
    """Return a support and its strips with coordinates in the order of names; other names fill the free places."""
    if support.names == names:
        return support, strips
    own = list(support.names)
    others = iter([place for place, name in enumerate(own) if name not in names])
    places = [own.index(name) if name in own else next(others) for name in names]
    square = {name: getattr(support, name)[np.ix_(places, places)] for name in support.symmetric}
    along = {name: getattr(support, name)[:, places] for name in ("hub", "shapes")}
    turned = strips._replace(rise=strips.rise[..., places], pitch=strips.pitch[..., places])
    return replace(support, names=names, **square, **along), turned


def _named_otherwise(own: Sequence[str], names: Sequence[str]) -> str:
    """Return a warning for a design whose modes have other names than the modes of the case's own design, or ""."""
    others = [name for name in own if name not in names]
    missing = [name for name in names if name not in own]
    renamed = [f"{name} is named {place}" for name, place in zip(others, missing, strict=True)]
    return f"the wing has other modes than in the case's own design: {', '.join(renamed)}" if renamed else ""


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
