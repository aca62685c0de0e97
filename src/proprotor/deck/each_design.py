"""Build the structure of each design of a batch, and put the designs into one support."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from proprotor.datum import Datum
from proprotor.deck.numbers import own_numbers
from proprotor.errors import InputError
from proprotor.support.airframe import Airframe
from proprotor.support.normal_modes import NormalModes
from proprotor.typing import Array

_SQUARE = ("mass", "damping", "stiffness")


class Design(NamedTuple):
    """One design, or many designs with the axes of the batch in front.

    support : NormalModes
    moved : tuple of arrays
        Of what the air loads: first the widths of strips, then motions (..., n) per unit of each coordinate.
    """

    support: NormalModes
    moved: tuple[Array, ...]


def each_design(given: Mapping[str, Any], build: Callable[[dict[str, Any]], Any]) -> Any:
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


def stacked(made: Array, names: tuple[str, ...]) -> Design:
    """Return the designs of a batch as one, with the axes of the batch in front.

    The coordinates of each design are put in the order of the names, so that the order is the same in every batch.
    """
    first, moved = made.flat[0]
    if not made.shape:
        return Design(replace(first, shapes=None), moved)

    def stack(parts: list[Any]) -> Array:
        return np.stack(parts).reshape(*made.shape, *parts[0].shape)

    ordered = [_in_order(design, names) for design in made.flat]
    matrices: dict[str, Any] = {
        name: stack([getattr(design.support, name) for design in ordered])
        for name in (*_SQUARE, *_along(first))
    }
    if first.shapes is not None:
        warnings = [_named_otherwise(design.support.names, names) for design in made.flat]
        matrices["warning"] = np.array(warnings, dtype=object).reshape(made.shape)
    together = zip(*(design.moved for design in ordered), strict=True)
    return Design(replace(first, names=names, **matrices), tuple(stack(list(parts)) for parts in together))


def _along(support: NormalModes) -> tuple[str, ...]:
    """Return the names of the matrices that have one column for each coordinate."""
    of_left = ("left_hub",) * isinstance(support, Airframe)
    return ("hub", *of_left, *(("shapes",) * (support.shapes is not None)))


def _in_order(design: Design, names: Sequence[str]) -> Design:
    """Return a design with coordinates in the order of names; other names fill the free places."""
    support, (widths, *motions) = design
    if support.names == names:
        return design
    own = list(support.names)
    others = iter([place for place, name in enumerate(own) if name not in names])
    places = [own.index(name) if name in own else next(others) for name in names]
    matrices: dict[str, Any] = {name: getattr(support, name)[np.ix_(places, places)] for name in _SQUARE}
    matrices |= {name: getattr(support, name)[:, places] for name in _along(support)}
    turned = (motion[..., places] for motion in motions)
    return Design(replace(support, names=names, **matrices), (widths, *turned))


def _named_otherwise(own: Sequence[str], names: Sequence[str]) -> str:
    """Return a warning for a design whose modes have other names than the modes of the case's own design, or ""."""
    others = [name for name in own if name not in names]
    missing = [name for name in names if name not in own]
    renamed = [f"{name} is named {place}" for name, place in zip(others, missing, strict=True)]
    return f"the wing has other modes than in the case's own design: {', '.join(renamed)}" if renamed else ""


def must_be_real(given: Mapping[str, Any]) -> None:
    """Refuse complex numbers."""
    for name, value in given.items():
        if np.iscomplexobj(value):
            raise InputError(
                name, None, "must be real here; take differences for the derivative with respect to it"
            )


def si_values(numbers: Mapping[str, Datum], section: str) -> dict[str, Any]:
    """Return the SI values of a section's own numbers by field; along the wing as (stations, values)."""
    return {
        name: n.si if n.r_over_R is None else (np.array(n.r_over_R), np.array(n.si))
        for name, n in own_numbers(numbers, section).items()
    }
