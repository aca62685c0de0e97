"""Add the lag of lift to the matrices of a rotor: circulation that follows its quasi-steady value late.

`derive/lift_lag.py` has the equations of one blade. In shape functions along the blade, circulation x follows the
change f of circulation by rates and displacements q of the blade and by gusts u, f = F_r q̇ + F_d q + F_g u, in two
states of different speed, i = 1 and 2:

    G ẋ_i + b_i H x_i = b_i H G⁻¹ f

and the loads lack A_i (G⁻¹ f - x_i) times the work W of circulation, which vanishes in every steady state. x is the
rate of a coordinate without stiffness. Each blade has an x of its own, as it has a flap angle, and the sum over the
blades is the same: the generated functions find x in the place of flap. Reactionless motions of the blades have
circulation of their own in the same way, in each harmonic apart.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from proprotor_equations import BLADE_COORDINATES, airloads, lift_lag, multiblade
from proprotor_equations.coordinates import DIFFERENTIAL, FIXED, REACTIONLESS_PAIR, SWASHPLATE, Coordinate

from proprotor.rotor.generated import evaluate
from proprotor.rotor.lift_lag import Shapes, circulation, polynomials
from proprotor.rotor.motions import LAG_SHAPES, LAGS
from proprotor.rotor.options import Options
from proprotor.rotor.section_loads import BladeSections
from proprotor.typing import Array

# Jones' approximation of Wagner's function, 1 - Σ A exp(-b s), s in half chords: A and b of each state.
# NACA Report 681 (1940).
JONES = dict(zip(LAGS, ((0.165, 0.0455), (0.335, 0.300)), strict=True))
_ANGLE = "flap"  # any angle that each blade has for itself
_BLADE_ANGLE = BLADE_COORDINATES.index(_ANGLE)
_MOTIONS = ("virtual_motion", "rate_motion", "displacement_motion", "gust_motion")
_CHANGES = ("change_by_rates", "change_by_displacements", "change_by_gusts")
_NOTHING = np.zeros((len(BLADE_COORDINATES),) * 2)


def with_lift_lag(
    rotor: Mapping[str, Array], blade: LaggingBlade, quantities: Mapping[str, Any]
) -> dict[str, Array]:
    """Return M, C, K and B of a rotor with the lag of lift added.

    Parameters
    ----------
    rotor : mapping of str to array
        M, C, K (points, 18, 18) and B (points, 18, 6) of the rotor with quasi-steady lift.
    blade : LaggingBlade
        Of the same points.
    quantities : mapping
        Quantities of the blade at trim by name, numbers or arrays (points,).

    Returns
    -------
    dict of str to array
        On the coordinates of Eq. 17, then those of `proprotor.rotor.motions.lag_coordinates`.
    """
    return _with_lag(rotor, blade, _Sum.of(FIXED, "", quantities), partial(_gust_loads, quantities))


def reactionless_with_lift_lag(
    block: Mapping[str, Array], blade: LaggingBlade, quantities: Mapping[str, Any]
) -> dict[str, Array]:
    """Return M, C and K of the reactionless motions of one harmonic, or of the differential ones, with the lag added.

    Parameters
    ----------
    block : mapping of str to array
        M, C, K (points, n, n) with quasi-steady lift, on six coordinates of a harmonic or three differential ones.
    blade : LaggingBlade
    quantities : mapping
        As for `with_lift_lag`, with ``harmonic`` for a harmonic.
    """
    pair = block["M"].shape[-1] == len(REACTIONLESS_PAIR)
    coordinates, prefix = (REACTIONLESS_PAIR, "reactionless_") if pair else (DIFFERENTIAL, "differential_")
    points = len(blade.weight)  # which may share a matrix
    whole = {name: np.broadcast_to(matrix, (points, *matrix.shape[-2:])) for name, matrix in block.items()}
    return _with_lag(whole, blade, _Sum.of(coordinates, prefix, quantities), None)


class _Sum(NamedTuple):
    """The sum over the blades in coordinates of the fixed frame.

    damping, stiffness : functions that return matrices of the rotor from M and C, and from M, C and K, of one blade;
    angle : places of the coordinates of the blade's angle in whose place circulation stands.
    """

    damping: Callable[..., Array]
    stiffness: Callable[..., Array]
    angle: Array

    @classmethod
    def of(cls, coordinates: tuple[Coordinate, ...], prefix: str, quantities: Mapping[str, Any]) -> _Sum:
        places = [place for place, coordinate in enumerate(coordinates) if coordinate.angle == _ANGLE]
        functions = (getattr(multiblade, f"{prefix}{kind}") for kind in ("damping", "stiffness"))
        damping, stiffness = (partial(evaluate, function, quantities) for function in functions)
        return cls(damping, stiffness, np.array(places))

    def rows(self, rotor: Array) -> Array:
        """Return the rows (points, parts k, n) of the angle, of matrices (k, points, own, n) of the rotor."""
        rows = np.moveaxis(rotor[..., self.angle, :], 0, 1)
        return rows.reshape(len(rows), -1, rows.shape[-1])

    def own(self, rotor: Array) -> Array:
        """Return the entries (points, parts k, parts k) of the angle, of matrices (k, k, points, own, own)."""
        entries = np.transpose(rotor[..., self.angle[:, None], self.angle], (2, 0, 3, 1, 4))
        count = entries.shape[1] * len(self.angle)
        return entries.reshape(len(entries), count, count)


class LaggingBlade(NamedTuple):
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


def lagging_blade(
    sections: BladeSections,
    quantities: Mapping[str, Any],
    points: int,
    options: Options,
    shapes: Shapes | None = None,
) -> LaggingBlade:
    """Return the equations of one blade whose lift lags, at trim.

    Parameters
    ----------
    sections : BladeSections
    quantities : mapping
        Quantities of the blade at trim by name, numbers or arrays (points,).
    points : int
    options : Options
    shapes : callable, optional
        Shape functions along the blade; the first `LAG_SHAPES` polynomials by default.
    """
    found = circulation(
        sections,
        quantities,
        points,
        shapes or polynomials(LAG_SHAPES),
        compressibility=options.compressibility,
        lift_slope_only=options.airloads == "lift-slope",
    )
    segments = found.segments
    arrays = {name: evaluate(getattr(airloads, name), segments) for name in _MOTIONS}
    arrays |= {name: evaluate(getattr(lift_lag, name), segments) for name in ("change", "load")}
    changes = (evaluate(getattr(lift_lag, name), arrays)[..., 0, :] for name in _CHANGES)
    by_rates, by_displacements, by_gusts = (
        np.moveaxis(np.linalg.solve(found.weight, change), -2, 0) for change in changes
    )
    work = np.moveaxis(evaluate(lift_lag.work, arrays)[..., 0], -2, 0)
    return LaggingBlade(work, by_rates, by_displacements, by_gusts, found.weight, found.decay)


def _with_lag(
    rotor: Mapping[str, Array], blade: LaggingBlade, total: _Sum, gust_loads: Callable[[Array], Array] | None
) -> dict[str, Array]:
    """Return the matrices of some coordinates with the lag of lift, and its states behind; without gusts no B."""
    own = rotor["M"].shape[-1]
    states = len(total.angle) * len(blade.work)
    whole = padded(rotor, len(JONES) * states, np.result_type(*blade))
    _add_loads_at_once(whole, own, blade, total, gust_loads)
    for place, (share, rate) in enumerate(JONES.values()):
        start = own + place * states
        _add_state(whole, own, slice(start, start + states), blade, total, share, rate)
        if gust_loads is not None:
            driven = np.einsum("pkl,lpj->kpj", rate * blade.decay, blade.by_gusts)
            whole["B"][:, start : start + states, len(SWASHPLATE) :] = total.rows(
                gust_loads(_of_angle(driven))
            )
    return whole


def _gust_loads(quantities: Mapping[str, Any], gusts: Array) -> Array:
    return np.asarray(evaluate(multiblade.gust_loads, quantities, gusts))


def padded(rotor: Mapping[str, Array], more: int, kind: np.dtype[Any]) -> dict[str, Array]:
    """Return the matrices with rows, and of M, C and K columns too, of zeros for more coordinates."""
    return {
        name: np.pad(
            matrix.astype(np.result_type(matrix, kind), copy=False),
            [(0, 0), (0, more), (0, 0 if name == "B" else more)],
        )
        for name, matrix in rotor.items()
    }


def _add_loads_at_once(
    whole: dict[str, Array],
    own: int,
    blade: LaggingBlade,
    total: _Sum,
    gust_loads: Callable[[Array], Array] | None,
) -> None:
    """Take off the share of the loads that comes late, A W G⁻¹ f of both states."""
    late = sum(share for share, _ in JONES.values())
    damping, stiffness, gusts = (
        late * np.einsum("kpi,kpj->pij", blade.work, change)
        for change in (blade.by_rates, blade.by_displacements, blade.by_gusts)
    )
    whole["C"][:, :own, :own] += total.damping(_NOTHING, damping)
    whole["K"][:, :own, :own] += total.stiffness(_NOTHING, damping, stiffness)
    if gust_loads is not None:
        whole["B"][:, :own, len(SWASHPLATE) :] -= gust_loads(gusts)


def _add_state(
    whole: dict[str, Array],
    own: int,
    places: slice,
    blade: LaggingBlade,
    total: _Sum,
    share: float,
    rate: float,
) -> None:
    """Add the equations of one state, G ẋ + b H x = b H G⁻¹ f, and its loads, A W x."""
    decay = rate * blade.decay
    damping, stiffness = (
        _of_angle(np.einsum("pkl,lpj->kpj", decay, -change))
        for change in (blade.by_rates, blade.by_displacements)
    )
    whole["C"][:, places, :own] = total.rows(total.damping(_NOTHING, damping))
    whole["K"][:, places, :own] = total.rows(total.stiffness(_NOTHING, damping, stiffness))
    loads = np.swapaxes(_of_angle(-share * blade.work), -1, -2)
    columns = total.damping(_NOTHING, loads)
    whole["C"][:, :own, places] = np.swapaxes(total.rows(np.swapaxes(columns, -1, -2)), -1, -2)
    weight, decay = _entry(blade.weight), _entry(decay)
    whole["M"][:, places, places] = total.own(total.damping(_NOTHING, weight))
    turned = total.stiffness(_NOTHING, weight, _NOTHING)
    whole["C"][:, places, places] = total.own(turned + total.damping(_NOTHING, decay))


def _of_angle(row: Array) -> Array:
    """Return matrices (..., 12, n) of one blade with a row (..., n) for an angle of the blade, and no other."""
    matrix = np.zeros((*row.shape[:-1], len(BLADE_COORDINATES), row.shape[-1]), dtype=row.dtype)
    matrix[..., _BLADE_ANGLE, :] = row
    return matrix


def _entry(entries: Array) -> Array:
    """Return matrices (k, k, points, 12, 12) of one blade with an entry (points, k, k) of an angle, and no other."""
    moved = np.moveaxis(entries, 0, -1)
    matrix = np.zeros((*moved.shape, *_NOTHING.shape), dtype=moved.dtype)
    matrix[..., _BLADE_ANGLE, _BLADE_ANGLE] = moved
    return matrix
