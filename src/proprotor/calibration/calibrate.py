"""Fit inputs of a case to test points by weighted least squares."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from proprotor.calibration.identifiability import Directions, covariance, directions, not_told
from proprotor.calibration.predicted import Predictor, start_of
from proprotor.calibration.targets import Target, targets_of
from proprotor.deck.input_values import input_values
from proprotor.deck.vary import inputs_at
from proprotor.errors import InputError
from proprotor.model import stamp
from proprotor.model.configuration import Configuration
from proprotor.tables.points import Points
from proprotor.typing import Array, Dataset

_TOLERANCE = 1e-8  # relative, of inputs and of the sum of squares
_UNLIKELY = 0.01  # as chance: a misfit that the errors of the points do not explain
_AT_END = 1e-6  # of the width of the bounds


class Calibration(NamedTuple):
    """Calibrated inputs.

    Parameters
    ----------
    found : xarray.Dataset
        See `calibrate`.
    case : Case
        The case with the calibrated inputs.
    """

    found: Dataset
    case: Configuration

    @property
    def warning(self) -> str:
        """What makes the calibrated values doubtful; "" for nothing."""
        return str(self.found.warning.item())

    @property
    def stamp(self) -> stamp.Stamp:
        """The case that was calibrated and the options in force, see `proprotor.model.stamp`."""
        return stamp.of(self.found.attrs)


def calibrate(
    case: Configuration,
    points: Points,
    inputs: Sequence[str] | Mapping[str, Any],
    *,
    mode: str | None = None,
    **options: Any,
) -> Calibration:
    """Fit inputs of a case to measured frequencies and dampings, each weighted by its error.

    Parameters
    ----------
    case : Case
        One design, built from a deck; its values are those to start from.
    points : Points
        Of `proprotor.tables.points.read_points`: airspeed, frequency (damped) or damping or both with their errors, one
        standard error to either side, and the mode by its name in a sweep.
    inputs : sequence of str, or mapping of str to (low, high) or None
        Paths of inputs (`proprotor.deck.vary.design_inputs`), with bounds in SI or as text; None without bounds.
    mode : str, optional
        Of points whose file names no mode.
    **options
        See `proprotor.rotor.options.Options`.

    Returns
    -------
    Calibration
        The calibrated case, and a dataset. By input: value, start, standard_error, low, high (SI), unit and at_bound;
        covariance (input, other_input), by the errors of the points and exact derivatives, without inputs at a bound.
        By target: mode, airspeed, quantity, measured, measured_error, before, after, misfit (in errors) and name_after,
        what moves at the calibrated inputs. singular_value (direction) and direction (direction, input): the inverse of
        a singular value is the relative standard error of that combination of inputs. warning: what makes the values
        doubtful. Attributes: chi_squared, degrees_of_freedom, chance (of a larger misfit by the errors of the points),
        points, inputs, evaluations, the case and its options (`proprotor.model.stamp`).

    Raises
    ------
    InputError
        For unknown inputs or modes, bounds that do not hold the value of the deck, points without errors, fewer numbers
        than inputs, and a case that cannot be analysed.
    """
    bounds = _bounds(case, inputs)
    targets = targets_of(points, case, mode)
    if len(targets) < len(bounds):
        rule = f"must be at most as many as the numbers of the points, {len(targets)}"
        raise InputError("inputs", ", ".join(bounds), rule)
    predictor = Predictor(case, list(bounds), targets, options)
    fit = _fit(predictor, np.array(list(bounds.values())))
    return Calibration(_dataset(case, points, predictor, fit, bounds, options), predictor.design(fit.values))


class _Fit(NamedTuple):
    """values (inputs,), SI; jacobian (targets, inputs), over the errors; before, after (targets,); at_bound."""

    values: Array
    jacobian: Array
    before: Array
    after: Array
    at_bound: Array
    evaluations: int


def _bounds(case: Configuration, inputs: Sequence[str] | Mapping[str, Any]) -> dict[str, tuple[float, float]]:
    """Return the bounds of the inputs by path, SI."""
    given = (
        inputs
        if isinstance(inputs, Mapping)
        else dict.fromkeys([inputs] if isinstance(inputs, str) else inputs)
    )
    if not given:
        raise InputError("inputs", None, "must name at least one input")
    known, found = inputs_at(case, given), dict[str, tuple[float, float]]()
    for path, ends in given.items():
        value = known[path].si
        if np.ndim(value):
            raise InputError(path, f"array of shape {np.shape(value)}", "must be one number to start from")
        if ends is None:
            found[path] = (-np.inf, np.inf)
            continue
        if not isinstance(ends, Sequence) or isinstance(ends, str) or len(ends) != 2:
            raise InputError(path, ends, "must have two bounds, low and high")
        low, high = (float(input_values(path, end, known[path]).item()) for end in ends)
        if not low < value < high:
            raise InputError(
                path, f"{value:g} {known[path].unit}".strip(), f"must lie between {low:g} and {high:g}"
            )
        found[path] = (low, high)
    return found


def _fit(predictor: Predictor, bounds: Array) -> _Fit:
    """Return the values that leave the smallest sum of squared misfits, each over its error."""
    from scipy.optimize import least_squares  # here, because scipy.optimize takes long to import

    measured = np.array([target.value for target in predictor.targets])
    error = np.array([target.error for target in predictor.targets])
    start = predictor.at.copy()
    size = _input_size(start, bounds)

    def misfit(scaled: Array) -> Array:
        off = (predictor.values(scaled * size) - measured) / error
        return np.where(np.isfinite(off), off, np.inf)  # a step that ends here is made shorter

    def derivatives(scaled: Array) -> Array:
        return np.asarray(predictor.move_to(scaled * size) * size / error[:, None])

    before = predictor.values(start)
    done = least_squares(
        misfit,
        start / size,
        jac=derivatives,
        bounds=(bounds[:, 0] / size, bounds[:, 1] / size),
        xtol=_TOLERANCE,
        ftol=_TOLERANCE,
        gtol=_TOLERANCE,
    )
    values = done.x * size
    with np.errstate(invalid="ignore"):
        near = np.abs(values[:, None] - bounds) < _AT_END * np.ptp(bounds, axis=1)[:, None]
    at_bound = (near & np.isfinite(bounds)).any(axis=1)
    jacobian = predictor.move_to(values) / error[:, None]
    return _Fit(values, jacobian, before, predictor.values(values), at_bound, int(done.nfev))


def _input_size(start: Array, bounds: Array) -> Array:
    """Return the size of each input (inputs,), SI: its value, or where that is zero the width of its bounds."""
    width = np.ptp(bounds, axis=1)
    return np.asarray(np.where(start != 0, np.abs(start), np.where(np.isfinite(width), width, 1.0)))


def _dataset(
    case: Configuration,
    points: Points,
    predictor: Predictor,
    fit: _Fit,
    bounds: Mapping[str, tuple[float, float]],
    options: Mapping[str, Any],
) -> Dataset:
    import xarray  # here, because it takes long to import
    from scipy.stats import chi2

    start, ends = start_of(case, predictor.paths), np.array(list(bounds.values()))
    size = _input_size(start, ends)
    free = ~fit.at_bound
    told = directions(fit.jacobian * free, size)
    variance = covariance(directions(fit.jacobian[:, free], size[free]), size[free]) if free.any() else None
    spread = np.zeros((len(start), len(start)))
    if variance is not None:
        spread[np.ix_(free, free)] = variance
    error = np.array([target.error for target in predictor.targets])
    measured = np.array([target.value for target in predictor.targets])
    misfit = (fit.after - measured) / error
    freedom = len(error) - int(free.sum())
    chance = float(chi2.sf((misfit**2).sum(), freedom)) if freedom else 1.0
    names, doubts = predictor.names_and_doubts(fit.values)
    warnings = _warnings(predictor, fit, told, names, chance) + doubts
    units = [number.unit for number in inputs_at(case, predictor.paths).values()]
    by_target = {
        "measured": measured,
        "measured_error": error,
        "before": fit.before,
        "after": fit.after,
        "misfit": misfit,
        "name_after": np.array(names),
    }
    by_input = {
        "value": fit.values,
        "start": start,
        "standard_error": np.sqrt(spread.diagonal()),
        "low": ends[:, 0],
        "high": ends[:, 1],
        "at_bound": fit.at_bound,
    }
    return xarray.Dataset(
        {
            **{name: ("input", values) for name, values in by_input.items()},
            **{name: ("target", values) for name, values in by_target.items()},
            "covariance": (("input", "other_input"), spread),
            "singular_value": ("direction", told.values),
            "direction": (("direction", "input"), told.vectors),
            "warning": ((), "; ".join(warnings), {"long_name": "what makes the values doubtful"}),
        },
        coords={
            "input": list(predictor.paths),
            "other_input": list(predictor.paths),
            "unit": ("input", units),
            **_coordinates(predictor.targets),
        },
        attrs=stamp.of_case(case, options)
        | {
            "points": points.name,
            "inputs": ", ".join(predictor.paths),
            "chi_squared": float((misfit**2).sum()),
            "degrees_of_freedom": freedom,
            "chance": chance,
            "evaluations": fit.evaluations,
        },
    )


def _coordinates(targets: Sequence[Target]) -> dict[str, Any]:
    """Return the coordinates of the targets."""
    return {
        "mode": ("target", [target.mode for target in targets]),
        "airspeed": ("target", [target.airspeed for target in targets], {"units": "m/s"}),
        "quantity": ("target", [target.quantity for target in targets]),
        "target_unit": ("target", ["rad/s" if target.quantity == "frequency" else "1" for target in targets]),
    }


def _warnings(
    predictor: Predictor, fit: _Fit, told: Directions, names: Sequence[str], chance: float
) -> list[str]:
    """Return what makes the values doubtful."""
    found = []
    for path, stuck in zip(predictor.paths, fit.at_bound, strict=True):
        if stuck:
            found.append(f"{path} is at a bound, and the error of the others is for this value of it")
    free = int((~fit.at_bound).sum())
    found += not_told(Directions(told.values[:free], told.vectors[:free]), predictor.paths)
    if chance < _UNLIKELY:
        found.append(f"the model misses the points by more than their errors explain (chance {chance:.1g})")
    renamed = {
        f"what was fitted as {target.mode} is called {name} at the calibrated inputs"
        for target, name in zip(predictor.targets, names, strict=True)
        if name != target.mode
    }
    return found + sorted(renamed)
