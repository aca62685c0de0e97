"""Named modes of a case along airspeeds, without the rest of a sweep, so that a page can follow a slider."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from proprotor.case import Case
from proprotor.model.first_order import some_points
from proprotor.model.linear_model import LinearModel
from proprotor.stability.branches import NamedStates, branch_labels, named_at
from proprotor.stability.following import Branches, follow
from proprotor.stability.mode_names import moving
from proprotor.stability.modes import at_columns
from proprotor.stability.parameter_lines import ANCHORS, ParameterLine, tip_speed
from proprotor.stability.root_error import error_near_zero
from proprotor.stability.sweep import mode_columns
from proprotor.tables.sweep_summary import UnstableRange, leaps, unstable_ranges
from proprotor.typing import Array, Dataset

_NEAREST = 4  # points through which a cubic goes


@dataclass(frozen=True, eq=False)
class LiveModes:
    """Modes along airspeeds.

    Attributes
    ----------
    airspeed : array (points,)
        m/s.
    names : list of str
        Names of the modes, in the order of the coordinates after which the modes are named.
    eigenvalue : array (points, modes)
        rad/s; NaN at failed points.
    reason, warning : array (points,) of str
        Reasons for which a point failed, or is doubtful; empty for all other points.
    unstable : list of UnstableRange
        Unstable ranges of airspeed, with ends interpolated between the points.
    leaps : array (points - 1, modes) of bool
        True where a name passes to a root that lies elsewhere, see `proprotor.tables.sweep_summary.leaps`.
    rigid_body : tuple of str
        Names of the coordinates that move an aircraft as one body.
    """

    airspeed: Array
    names: list[str]
    eigenvalue: Array
    reason: Array
    warning: Array
    unstable: list[UnstableRange]
    leaps: Array
    rigid_body: tuple[str, ...] = ()

    @property
    def flutter(self) -> UnstableRange | None:
        """The unstable range that begins at the lowest airspeed; None if no mode becomes unstable within the points.

        Modes that are named after a motion of an aircraft as one body do not count.
        """
        onsets = [
            found for found in self.unstable if not found.open_start and found.mode not in self.rigid_body
        ]
        return min(onsets, key=lambda found: found.start, default=None)

    @property
    def damping(self) -> Array:
        """-Re s/|s| (points, modes) in percent of critical, NaN for a root at zero."""
        size = np.abs(self.eigenvalue)
        with np.errstate(all="ignore"):
            return np.where(size > 0, -100 * self.eigenvalue.real / size, np.nan)


def live_modes(
    case: Case, airspeeds: Array, values: Mapping[str, float] | None = None, **options: Any
) -> LiveModes:
    """Return the modes of a case, or of the case with other inputs, along airspeeds.

    Modes are those of `Case.sweep`, with the same names. To find the ends of unstable ranges, roots are followed from
    point to point. Where a step is too large to follow the roots, the matrices within the step come from cubics
    through the matrices at the points, and not from new trims. No number on the page comes from these matrices.

    Parameters
    ----------
    case : Case
    airspeeds : array (points,)
        m/s, rising.
    values : mapping of str to float, optional
        SI values by path, see `proprotor.deck.vary.design_inputs`.
    **options
        See `proprotor.rotor.options.Options`.

    Raises
    ------
    InputError
        For values that are not physical, and as `Case.sweep`.
    """
    varied = case.vary(values) if values else case
    anchors = np.array(ANCHORS) * tip_speed(varied)
    within = anchors[(anchors > airspeeds[0]) & (anchors < airspeeds[-1])]
    positions = np.union1d(airspeeds, within)
    shown = np.searchsorted(positions, airspeeds)
    model = varied.linearize(positions, **options)
    line = ParameterLine(positions, _between(model), model=model)
    branches = follow(model, line)
    followed = branch_labels(branches, _named(branches, line, within), len(positions))
    roots, right, left = branches.spectrum.at(shown).all_modes
    at_points = some_points(model, shown)
    columns, names = mode_columns(moving(at_points, roots, left, right), roots)
    found, labels, error = (
        at_columns(values, columns)
        for values in (roots, followed.label[shown], error_near_zero(at_points, roots))
    )
    reason, warning = model.trim.reason[shown], model.trim.warning[shown]
    sweep = _as_sweep(airspeeds, names, found, labels, error)
    ranges = unstable_ranges(sweep)
    return LiveModes(airspeeds, names, found, reason, warning, ranges, leaps(sweep), model.rigid_body)


def _between(model: LinearModel) -> Any:
    """Return a function that gives models between the points of a model, by cubics through the nearest four points.

    Return None if there are too few points for cubics.
    """
    good = np.flatnonzero(model.trim.converged)
    if len(good) < _NEAREST:
        return None

    def linearize(positions: Array) -> LinearModel:
        known = model.airspeed[good]
        first = np.clip(np.searchsorted(known, positions) - _NEAREST // 2, 0, len(good) - _NEAREST)
        places = first[:, None] + np.arange(_NEAREST)
        weights = _weights(positions, known[places])
        M, C, K = (
            np.einsum("pk,pkij->pij", weights, matrix[good[places]]) for matrix in (model.M, model.C, model.K)
        )
        parts: dict[str, Any] = dict.fromkeys(("B", "rotor", "left", "shapes"))
        return replace(model, airspeed=positions, M=M, C=C, K=K, **parts)

    return linearize


def _weights(positions: Array, known: Array) -> Array:
    """Return the weights (n, k) of values at known positions (n, k) in Lagrange's polynomial at positions (n,)."""
    apart = known[:, :, None] - known[:, None] + np.eye(known.shape[1])
    from_known = positions[:, None] - known
    others = np.where(np.eye(known.shape[1], dtype=bool), 1.0, from_known[:, None, :])
    return np.asarray(others.prod(axis=-1) / apart.prod(axis=-1))


def _named(branches: Branches, line: ParameterLine, anchors: Array) -> NamedStates:
    """Return the names of the states at the first anchor with a trim, or else at the first point with a trim."""
    at = branches.positions[branches.points]
    places = [int(np.flatnonzero(at == anchor)[0]) for anchor in anchors if anchor in at]
    return named_at(branches, line, places[0] if places else 0)


def _as_sweep(airspeeds: Array, names: list[str], eigenvalue: Array, labels: Array, error: Array) -> Dataset:
    """Return the part of a sweep that its summary reads."""
    import xarray

    arrays = {"eigenvalue": eigenvalue, "branch": labels, "eigenvalue_error": error}
    data = {name: (("airspeed", "mode"), array) for name, array in arrays.items()}
    return xarray.Dataset(data, coords={"airspeed": airspeeds, "mode": names})
