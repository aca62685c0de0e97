"""Circulation of a blade in shape functions along the radius: what the lag of lift takes from the blade's sections."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
from proprotor_equations import lift_lag

from proprotor.rotor.airfoil import SectionCoefficients
from proprotor.rotor.generated import evaluate, keywords
from proprotor.rotor.section_loads import (
    BladeSections,
    aerodynamics,
    at_rows_of_points,
    quantities_of_air,
    segment_quantities,
)
from proprotor.typing import Array

# Values (..., stations, shapes) of the shape functions, from the radii (..., stations) as shares of the blade's radius.
Shapes = Callable[[Array], Array]
_MOMENTS = (
    *keywords(lift_lag.change),
    *keywords(lift_lag.load),
)  # a quantity of a section, "_", a power of r


class Circulation(NamedTuple):
    """Circulation of a blade in k shape functions, see `derive/lift_lag.py`.

    segments : mapping of str to array
        Quantities of each segment (points, 1, segments), and by shape function (points, k, segments) the moments of the
        change of circulation and of the forces that circulation makes.
    weight, decay : array (points, k, k)
        G in m³/s and H in m³/s².
    """

    segments: dict[str, Array]
    weight: Array
    decay: Array


def polynomials(count: int) -> Shapes:
    """Return the first Legendre polynomials, from axis to tip, as shape functions."""
    return lambda share: np.polynomial.legendre.legvander(2 * share - 1, count - 1)


def circulation(
    sections: BladeSections,
    quantities: Mapping[str, Any],
    points: int,
    shapes: Shapes,
    *,
    compressibility: bool,
    lift_slope_only: bool,
) -> Circulation:
    """Return the circulation of a blade at trim in shape functions.

    Parameters
    ----------
    sections : BladeSections
    quantities : mapping
        Quantities of the blade at trim by name, numbers or arrays (points,).
    points : int
    shapes : callable
    compressibility : bool
        Put the Prandtl-Glauert factor on the lift, before it lags, unless the airfoil contains compressibility.
    lift_slope_only : bool
        Keep the terms proportional to the lift slope and no others.
    """
    segments = segment_quantities(sections, quantities)
    needed = {name: segments[name] for name in quantities_of_air()}
    blocks = []
    for rows, here in sections.blocks(points):
        block = at_rows_of_points(needed, rows)
        air, coefficients, _ = aerodynamics(here, block, compressibility)
        if lift_slope_only:
            coefficients = SectionCoefficients(lift_coefficient_alpha=coefficients.lift_coefficient_alpha)
        change = lift_lag.change_beside_axis if here.beside_axis else lift_lag.change_of_circulation
        found = evaluate(change, air | coefficients._asdict())._asdict()
        blocks.append((rows, _integrals(here, found, shapes(here.quadrature.stations / block["radius"]))))
    integrals = {name: _at_all_points(blocks, name, points) for name in blocks[0][1]}
    weight, decay = integrals.pop("weight"), integrals.pop("decay")
    whole = {name: value[..., None, :] for name, value in segments.items()}
    return Circulation(whole | dict.fromkeys(_MOMENTS, 0.0) | integrals, weight, decay)


def _integrals(sections: BladeSections, found: Mapping[str, Array], along: Array) -> dict[str, Array]:
    """Return the moments (rows, k, segments) by name, and G and H (rows, k, k), of points or of one for all of them."""
    shapes = np.moveaxis(along, -1, 0)

    def moment(of_section: Array, power: int = 0) -> Array:
        return sections.quadrature.moments(np.atleast_2d(of_section))[..., power]

    def products(of_section: Array) -> Array:
        rows = [[moment(of_section * one * other).sum(axis=-1) for other in shapes] for one in shapes]
        return np.moveaxis(np.array(rows), -1, 0)

    moments = {}
    for name in _MOMENTS:
        quantity, _, power = name.rpartition("_")
        if quantity not in found:  # a moment about an axis through the aerodynamic centre
            continue
        moments[name] = np.stack([moment(found[quantity] * shape, int(power)) for shape in shapes], axis=-2)
    weight, decay = products(found["circulation_weight"]), products(found["circulation_decay"])
    return moments | {"weight": weight, "decay": decay}


def _at_all_points(blocks: list[tuple[Array | slice, dict[str, Array]]], name: str, points: int) -> Array:
    """Return an array of all points from those of blocks of points."""
    first = blocks[0][1][name]
    whole = np.empty((points, *first.shape[1:]), dtype=first.dtype)
    for rows, parts in blocks:
        whole[rows] = parts[name]
    return whole
