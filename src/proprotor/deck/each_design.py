"""Build each different design of a batch once, and put the designs at the points of the batch."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np

from proprotor.datum import Datum
from proprotor.deck.numbers import own_numbers
from proprotor.errors import InputError
from proprotor.needs import check_memory
from proprotor.support.airframe import Airframe
from proprotor.support.normal_modes import NormalModes
from proprotor.typing import Array

_BYTES = 16_000  # at most, of matrices of a beam wing for each pair of nodes
_PART = 200e6  # bytes of beam wings that are built at once
_Support = TypeVar("_Support", bound=NormalModes)


def different_designs(given: Mapping[str, Any], nodes: int) -> tuple[list[dict[str, Any]], Array]:
    """Return the numbers of all different designs of a batch, and the place of each point's design among these.

    A search evaluates one design at many airspeeds, so equal designs are built once. The designs come in parts that fit
    into memory, each part with arrays (designs,) of the numbers that vary.

    Parameters
    ----------
    given : mapping of str to number, array (...), profile or word
        The numbers of the structure by name, with a span.
    nodes : int
        Number of nodes of the finite elements of one design.

    Raises
    ------
    InputError
        When the matrices of one design would not fit into the memory.
    """
    check_memory("elements", None, _BYTES * nodes**2, f"the matrices of {nodes} nodes")
    varied = {name: value for name, value in given.items() if np.ndim(value) and not isinstance(value, tuple)}
    spread = np.broadcast_arrays(np.zeros(()), *varied.values())[1:]
    shape = np.broadcast_shapes(*(value.shape for value in varied.values()))
    columns = [part.ravel() for value in spread for part in (np.real(value), np.imag(value))]
    table = np.stack(columns or [np.zeros(1)], axis=-1)
    _, first, place = np.unique(table, axis=0, return_index=True, return_inverse=True)
    different = {name: value.ravel()[first] for name, value in zip(varied, spread, strict=True)}
    if "span" not in different:  # one design is a batch of one
        different["span"] = np.broadcast_to(given["span"], first.shape)
    step = max(1, int(_PART // (_BYTES * nodes**2)))
    parts = [slice(start, start + step) for start in range(0, len(first), step)]
    designs = [dict(given) | {name: value[part] for name, value in different.items()} for part in parts]
    return designs, place.reshape(shape)


def at_each_point(
    parts: Sequence[tuple[_Support, Sequence[Array]]], place: Array, own: Sequence[int]
) -> tuple[_Support, list[Array]]:
    """Return the supports of all designs, and what moves with them, at each point of a batch.

    Parameters
    ----------
    parts : sequence of (NormalModes, sequence of arrays)
        Supports of many designs (designs,), and further arrays (designs, ...).
    place : array (...) of int
        Place of each point's design among all designs.
    own : sequence of int
        How many axes each of the further arrays has for one design.
    """
    supports, moved = zip(*parts, strict=True)
    counts = [support.mass.shape[0] for support in supports]

    def spread(arrays: Iterable[Array], axes: int) -> Array:
        """Put arrays (designs, ...) of the parts one after another; `axes` counts the axes of one design."""
        whole = [
            np.broadcast_to(array, (count, *array.shape[array.ndim - axes :]))
            for array, count in zip(arrays, counts, strict=True)
        ]
        return np.concatenate(whole)[place]

    names = ["mass", "damping", "stiffness", "hub", *["left_hub"] * isinstance(supports[0], Airframe)]
    matrices: dict[str, Any] = {
        name: spread((getattr(support, name) for support in supports), 2) for name in names
    }
    several: dict[str, Any] = {"shapes": None, "warning": None}
    if place.ndim and supports[0].shapes is not None:
        several = {
            "shapes": spread((support.shapes for support in supports), 2),
            "warning": spread((support.warning for support in supports), 0),
        }
    along = [spread(arrays, axes) for arrays, axes in zip(zip(*moved, strict=True), own, strict=True)]
    return replace(supports[0], **matrices, **several), along


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
