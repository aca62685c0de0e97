"""Add the lag of lift to the matrices of a rotor: circulation that follows its quasi-steady value late.

`derive/lift_lag.py` has the equations of one blade. In shape functions along the blade, circulation x follows the
change f of circulation by rates and displacements q of the blade and by gusts u, f = F_r q̇ + F_d q + F_g u, in two
states of different speed, i = 1 and 2:

    G ẋ_i + b_i H x_i = b_i H G⁻¹ f

and the loads lack A_i (G⁻¹ f - x_i) times the work W of circulation, which vanishes in every steady state. x is the
rate of a coordinate without stiffness. Each blade has an x of its own, as it has a flap angle, and the sum over the
blades is the same: the generated functions find x in the place of flap.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from proprotor_equations import BLADE_COORDINATES, FIXED_COORDINATES, airloads, lift_lag, multiblade
from proprotor_equations.coordinates import SWASHPLATE

from proprotor.rotor.generated import evaluate
from proprotor.rotor.lift_lag import Circulation, Shapes, circulation, polynomials
from proprotor.rotor.motions import LAG_SHAPES, LAGS
from proprotor.rotor.options import Options
from proprotor.rotor.section_loads import BladeSections
from proprotor.typing import Array

# Jones' approximation of Wagner's function, 1 - Σ A exp(-b s), s in half chords: A and b of each state.
# NACA Report 681 (1940).
_JONES = dict(zip(LAGS, ((0.165, 0.0455), (0.335, 0.300)), strict=True))
_PARTS = ("0", "1c", "1s")
_ANGLE = BLADE_COORDINATES.index("flap")  # any angle that each blade has for itself
_ANGLES = np.array([FIXED_COORDINATES.index(f"flap_{part}") for part in _PARTS])
_MOTIONS = ("virtual_motion", "rate_motion", "displacement_motion", "gust_motion")
_CHANGES = ("change_by_rates", "change_by_displacements", "change_by_gusts")
_NOTHING = np.zeros((len(BLADE_COORDINATES),) * 2)


def with_lift_lag(
    rotor: Mapping[str, Array],
    sections: BladeSections,
    quantities: Mapping[str, Any],
    options: Options,
    shapes: Shapes | None = None,
) -> dict[str, Array]:
    """Return M, C, K and B of a rotor with the lag of lift added.

    Parameters
    ----------
    rotor : mapping of str to array
        M, C, K (points, 18, 18) and B (points, 18, 6) of the rotor with quasi-steady lift.
    sections : BladeSections
        Of the same points.
    quantities : mapping
        Quantities of the blade at trim by name, numbers or arrays (points,).
    options : Options
    shapes : callable, optional
        Shape functions along the blade; the first `LAG_SHAPES` polynomials by default.

    Returns
    -------
    dict of str to array
        On the coordinates of Eq. 17, then those of `proprotor.rotor.motions.lag_coordinates`.
    """
    found = circulation(
        sections,
        quantities,
        len(rotor["M"]),
        shapes or polynomials(LAG_SHAPES),
        compressibility=options.compressibility,
        lift_slope_only=options.airloads == "lift-slope",
    )
    blade, own = _blade(found), len(FIXED_COORDINATES)
    states = len(_PARTS) * len(blade.work)
    whole = _padded(rotor, len(_JONES) * states)
    _add_loads_at_once(whole, blade, quantities)
    for place, (share, rate) in enumerate(_JONES.values()):
        start = own + place * states
        _add_state(whole, slice(start, start + states), blade, quantities, share, rate)
    return whole


class _Blade(NamedTuple):
    """One blade in rotating axes, in k shape functions.

    work (k, points, 12) : work of circulation; by_rates, by_displacements (k, points, 12), by_gusts (k, points, 3) :
    G⁻¹ f per unit of each; weight, decay (points, k, k) : G and H.
    """

    work: Array
    by_rates: Array
    by_displacements: Array
    by_gusts: Array
    weight: Array
    decay: Array


def _blade(found: Circulation) -> _Blade:
    """Return the equations of one blade from the circulation along it."""
    segments = found.segments
    arrays = {name: evaluate(getattr(airloads, name), segments) for name in _MOTIONS}
    arrays |= {name: evaluate(getattr(lift_lag, name), segments) for name in ("change", "load")}
    changes = (evaluate(getattr(lift_lag, name), arrays)[..., 0, :] for name in _CHANGES)
    by_rates, by_displacements, by_gusts = (
        np.moveaxis(np.linalg.solve(found.weight, change), -2, 0) for change in changes
    )
    work = np.moveaxis(evaluate(lift_lag.work, arrays)[..., 0], -2, 0)
    return _Blade(work, by_rates, by_displacements, by_gusts, found.weight, found.decay)


def _padded(rotor: Mapping[str, Array], more: int) -> dict[str, Array]:
    """Return the matrices with rows, and of M, C and K columns too, of zeros for more coordinates."""
    return {
        name: np.pad(matrix, [(0, 0), (0, more), (0, 0 if name == "B" else more)])
        for name, matrix in rotor.items()
    }


def _add_loads_at_once(whole: dict[str, Array], blade: _Blade, quantities: Mapping[str, Any]) -> None:
    """Take off the share of the loads that comes late, A W G⁻¹ f of both states."""
    own, late = len(FIXED_COORDINATES), sum(share for share, _ in _JONES.values())
    damping, stiffness, gusts = (
        late * np.einsum("kpi,kpj->pij", blade.work, change)
        for change in (blade.by_rates, blade.by_displacements, blade.by_gusts)
    )
    whole["C"][:, :own, :own] += evaluate(multiblade.damping, quantities, _NOTHING, damping)
    whole["K"][:, :own, :own] += evaluate(multiblade.stiffness, quantities, _NOTHING, damping, stiffness)
    whole["B"][:, :own, len(SWASHPLATE) :] -= evaluate(multiblade.gust_loads, quantities, gusts)


def _add_state(
    whole: dict[str, Array],
    places: slice,
    blade: _Blade,
    quantities: Mapping[str, Any],
    share: float,
    rate: float,
) -> None:
    """Add the equations of one state, G ẋ + b H x = b H G⁻¹ f, and its loads, A W x."""
    own = slice(len(FIXED_COORDINATES))
    decay = rate * blade.decay
    damping, stiffness, gusts = (
        _of_angle(np.einsum("pkl,lpj->kpj", decay, change))
        for change in (-blade.by_rates, -blade.by_displacements, blade.by_gusts)
    )
    whole["C"][:, places, own] = _rows(evaluate(multiblade.damping, quantities, _NOTHING, damping))
    whole["K"][:, places, own] = _rows(
        evaluate(multiblade.stiffness, quantities, _NOTHING, damping, stiffness)
    )
    whole["B"][:, places, len(SWASHPLATE) :] = _rows(evaluate(multiblade.gust_loads, quantities, gusts))
    loads = np.swapaxes(_of_angle(-share * blade.work), -1, -2)
    columns = evaluate(multiblade.damping, quantities, _NOTHING, loads)
    whole["C"][:, own, places] = np.swapaxes(_rows(np.swapaxes(columns, -1, -2)), -1, -2)
    weight, decay = _entry(blade.weight), _entry(decay)
    whole["M"][:, places, places] = _own(evaluate(multiblade.damping, quantities, _NOTHING, weight))
    turned = evaluate(multiblade.stiffness, quantities, _NOTHING, weight, _NOTHING)
    whole["C"][:, places, places] = _own(turned + evaluate(multiblade.damping, quantities, _NOTHING, decay))


def _of_angle(row: Array) -> Array:
    """Return matrices (..., 12, n) of one blade with a row (..., n) for an angle of the blade, and no other."""
    matrix = np.zeros((*row.shape[:-1], len(BLADE_COORDINATES), row.shape[-1]), dtype=row.dtype)
    matrix[..., _ANGLE, :] = row
    return matrix


def _entry(entries: Array) -> Array:
    """Return matrices (k, k, points, 12, 12) of one blade with an entry (points, k, k) of an angle, and no other."""
    moved = np.moveaxis(entries, 0, -1)
    matrix = np.zeros((*moved.shape, *_NOTHING.shape), dtype=moved.dtype)
    matrix[..., _ANGLE, _ANGLE] = moved
    return matrix


def _rows(rotor: Array) -> Array:
    """Return the rows (points, 3 k, n) of the angle, of matrices (k, points, 18, n) of the rotor."""
    rows = np.moveaxis(rotor[..., _ANGLES, :], 0, 1)
    return rows.reshape(len(rows), -1, rows.shape[-1])


def _own(rotor: Array) -> Array:
    """Return the entries (points, 3 k, 3 k) of the angle, of matrices (k, k, points, 18, 18) of the rotor."""
    entries = np.transpose(rotor[..., _ANGLES[:, None], _ANGLES], (2, 0, 3, 1, 4))
    count = entries.shape[1] * len(_PARTS)
    return entries.reshape(len(entries), count, count)
