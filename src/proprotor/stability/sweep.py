"""Modes along a line of points by what moves in them, each with the root that it is, followed from point to point."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from proprotor.deck.vary import vary as vary_case
from proprotor.errors import InputError, unknown_name
from proprotor.model import stamp
from proprotor.model.first_order import held_coordinates, some_points
from proprotor.model.linear_model import LinearModel
from proprotor.model.quantities import batch_shape
from proprotor.needs import check_memory
from proprotor.rotor.motions import SECOND, name_list
from proprotor.stability.branches import Named, branches
from proprotor.stability.following import Line, Path, follow, path_of
from proprotor.stability.matching import Modes, Spectrum, link, side_by_side
from proprotor.stability.mode_names import Moving, moving, whirl
from proprotor.stability.modes import (
    Eigensystem,
    coordinate_motion,
    coordinate_shares,
    mode_dataset,
    with_azimuth,
)
from proprotor.stability.root_error import errors_of
from proprotor.typing import Array
from proprotor.units import in_metres_per_second

if TYPE_CHECKING:
    import xarray

    from proprotor.model.configuration import Configuration

ANCHORS = (0.7, 0.5, 0.35, 0.2)  # of the tip speed: where branches get labels, the first that has a trim
_BYTES_PER_POINT = 230_000.0  # while modes are followed and boundaries found; measured with wings of beams
_STRIDE = 0.02  # of the tip speed, between the first points of the way there


def track(system: Eigensystem | Spectrum) -> Array:
    """Order (points, states) that keeps each state of the eigensystem in its place along the points.

    States may come in any order. Failed points are passed over.
    """
    places = side_by_side(system.values)
    paired = Spectrum(
        np.take_along_axis(system.values, places, 1),
        np.take_along_axis(system.right, places[:, None, :], 2),
    )
    return np.take_along_axis(places, path_of(paired).order(len(places)), 1)


def sweep(
    model: LinearModel,
    line: Line | None = None,
    *,
    approach: Line | None = None,
) -> xarray.Dataset:
    """Modes of a line of points, named and followed.

    Parameters
    ----------
    model : LinearModel
        One point for each position of the line.
    line : Line, optional
        Airspeeds of the model by default; with its `linearize`, steps that do not tell which mode is which are divided.
    approach : Line, optional
        From the anchor, where branches get their labels, to the point of the line that is nearest to it, both included:
        labels then do not depend on where the line begins and ends. Without it, or where it fails, they are given at
        the first point that works.

    Returns
    -------
    xarray.Dataset
        As `LinearModel.modes`, with mode names as coordinate: what moves (`proprotor.stability.mode_names`), at each point by
        itself, so that a name passes from one root to another where they exchange their motions. share, how much of the
        mode is that motion, 0 to 1; branch, which exact root has the name at a point, by its label where branches are
        named (`proprotor.stability.branches`); tracking_quality, the trust in that label, 0 to 1: the least of all steps from
        there; whirl (-1 against the rotor to 1 with it, in the fixed frame). A step that does not tell roots apart is a
        warning. Attributes: eigen_solves, named_at, where branches are named, and the case and its
        options (`proprotor.model.stamp`).

    Raises
    ------
    InputError
        When the points do not form a line.
    """
    if model.airspeed.ndim != 1:
        raise InputError(
            "airspeed", f"array of shape {model.airspeed.shape}", "must be a list of speeds to sweep"
        )
    line = Line(model.airspeed) if line is None else line
    points, path = len(model.airspeed), follow(model, line)
    named = state_names(model, line, path, approach)
    spectrum = path.spectrum.at(slice(points))
    values, right, left = spectrum.all_modes
    found = moving(model, values, left, right)
    columns, modes = mode_columns(found, values)
    data = _by_motion(model, line, Modes(values, right, left), errors_of(model, spectrum), columns)
    by_mode = data.eigenvalue.dims
    followed = branches(path, named, points)
    for name, told in (
        ("share", (found.share, "participation of the motion that the mode is named after")),
        ("branch", (followed.label, "exact root, by what moves in it where branches are named")),
        ("tracking_quality", (followed.trust, "trust in the steps from there to the point")),
    ):
        values, meaning = told
        data[name] = by_mode, _at_columns(values, columns), {"long_name": meaning}
    data["branch"] = data.branch.astype(str)
    data["warning"] = data.warning.dims, _joined(data.warning.values, followed.doubt), data.warning.attrs
    data.attrs |= {"eigen_solves": len(path.points) + named.eigen_solves, "named_at": named.told}
    return data.assign_coords(mode=modes)


def _by_motion(model: LinearModel, line: Line, every: Modes, error: Array, columns: Array) -> xarray.Dataset:
    """The dataset of the states in the columns (points, modes), with the sense in which they whirl."""
    n, held, there = len(model.dofs), held_coordinates(model, every.right.shape[-2]), columns >= 0
    places = np.maximum(columns, 0)
    modes = Spectrum(every.values, every.right).modes(places)
    values = np.where(there, modes.values, np.nan)
    shapes = coordinate_motion(held, n, values, modes.right)
    shares = np.where(there[:, None, :], coordinate_shares(held, n, modes.left, modes.right), np.nan)
    data = mode_dataset(model, values, _at_columns(error, columns), shapes, shares, line)
    sense = np.where(there, whirl(model, modes.values, modes.left, modes.right), np.nan)
    told = {"units": "1", "long_name": "whirl with the rotor, in the fixed frame"}
    data["whirl"] = data.eigenvalue.dims, sense, told
    return data


def _at_columns(values: Array, columns: Array) -> Array:
    """Of each point the values (points, states) of the states in its columns; nothing where it has none."""
    nothing = "" if values.dtype == object else np.nan
    return np.where(columns >= 0, np.take_along_axis(values, np.maximum(columns, 0), 1), nothing)


def _joined(first: Array, second: Array) -> Array:
    both = ["; ".join(filter(None, texts)) for texts in zip(first.tolist(), second.tolist(), strict=True)]
    return np.array(both, dtype=str)


def state_names(model: LinearModel, line: Line, path: Path, approach: Line | None) -> Named:
    """Names of states at the point nearest to the anchor, followed from there; else given at the first point."""
    known = name_list(model.dofs)
    if not len(path.points):
        return Named(0, known, np.empty(0, dtype=int), np.empty(0), "", 0)
    if approach is not None:
        near = approach.models(approach.positions)
        # A shaft may hold the azimuth on one of the two lines only.
        held = max(held_coordinates(model), held_coordinates(near), key=len)
        leg = follow(near, approach, held)
        last = len(approach.positions) - 1
        if len(leg.points) and [leg.points[0], leg.points[-1]] == [0, last]:
            nearest = int(np.argmin(np.abs(path.positions[path.points] - approach.end)))
            here = path.spectrum.at([int(path.points[nearest])])
            given = names_at(near, leg.spectrum, 0)[leg.places[0]]
            states = _same_point(leg, last, with_azimuth(here, model.dofs, len(held) + len(model.dofs)))
            place, trust = np.empty_like(given), np.empty(len(given))
            place[states], trust[states] = given, leg.quality.min(axis=0, initial=1)
            own = here.values.shape[1]
            told = f"{approach.name} {approach.positions[0]:.6g} {approach.units}"
            return Named(nearest, known, place[:own], trust[:own], told, len(leg.points))
    start = int(np.flatnonzero(path.points < len(line.positions))[0])  # a point of the line, and none between
    first = int(path.points[start])
    told = f"{line.name} {float(line.positions[first]):.6g} {line.units}"
    place = names_at(model, path.spectrum, first)
    return Named(start, known, place, np.ones(len(place)), told, 0)


def _same_point(leg: Path, last: int, here: Spectrum) -> Array:
    """Which states of a point, a spectrum (1, states), the followed states of a path are at the same point."""
    both = leg.spectrum.at([last]).joined(here)
    successor = link(both, np.array([0]), np.array([1])).successor[0]
    states: Array = successor[leg.places[-1]]
    return states


def names_at(model: LinearModel, spectrum: Spectrum, point: int) -> Array:
    """What moves in each state (states,) of a point of a line of models, by its place in `name_list`."""
    values, right, left = spectrum.at(point).all_modes
    return moving(some_points(model, point), values, left, right).place


def mode_columns(found: Moving, values: Array) -> tuple[Array, list[str]]:
    """Which state each mode is at each point (points, modes), -1 where there is none, and what the modes are called.

    In the order of the coordinates. A mode is the state of a pair that is above the real axis, or a real root. Two real
    roots that have one name are two modes: the one that decays faster, or grows less, is the second root.
    """
    columns, modes = [], []
    counts = values.imag >= 0
    for place, name in enumerate(found.known):
        own = counts & (found.place == place)
        for suffix in ("", SECOND):
            if not own.any():
                break
            best = np.where(own, values.real, -np.inf).argmax(axis=1)
            columns.append(np.where(own.any(axis=1), best, -1))
            modes.append(name + suffix)
            own[np.arange(len(own)), best] = False
    stacked = np.stack(columns, axis=1) if columns else np.empty((len(values), 0), dtype=int)
    return stacked, modes


def sweep_case(
    case: Configuration, airspeeds: Any, vary: Mapping[str, ArrayLike] | None = None, **options: Any
) -> xarray.Dataset:
    """Modes of a case along airspeeds, or along one input at one airspeed: see `sweep`.

    Modes have their names by what moves at each point. Branches get their labels at the case's own inputs and near
    cruise (`anchor_speed`), and are followed from there, in steps that are divided until they tell roots apart. So both
    are the same in any range and for any step.

    Parameters
    ----------
    case : Case
    airspeeds : array (points,) in m/s, text such as "50:400:5kt", or pint quantity
        One airspeed with `vary`.
    vary : mapping of str to array (points,), optional
        One input by its path in the deck (`proprotor.deck.vary.design_inputs`), and its values in SI.
    **options
        See `proprotor.rotor.options.Options`.

    Returns
    -------
    xarray.Dataset
        As `sweep` has it.

    Raises
    ------
    InputError
        For an unknown option or input, airspeeds that do not form a line, or more than one input.
    """
    found = _sweep_of(case, airspeeds, vary, options)
    return found.assign_attrs(stamp.of_case(case, options))  # of the case itself, not of one that is varied


def _sweep_of(
    case: Configuration, airspeeds: Any, vary: Mapping[str, ArrayLike] | None, options: Mapping[str, Any]
) -> xarray.Dataset:
    line = line_of_case(case, airspeeds, vary, options)
    if line is None:  # points differ in more than their airspeed
        return sweep(case.linearize(airspeeds, **options))
    model = line.models(line.positions)
    return sweep(model, line, approach=approach_to(case, line, model, options))


def line_of_case(
    case: Configuration, airspeeds: Any, vary: Mapping[str, ArrayLike] | None, options: Mapping[str, Any]
) -> Line | None:
    """The line of airspeeds, or of an input; None where points differ in more than one number.

    Raises
    ------
    InputError
        For airspeeds that do not form a line, more than one input, an unknown one, or points that do not fit into
        memory.
    """
    speeds = in_metres_per_second(airspeeds)
    speeds = speeds if speeds.ndim else speeds.reshape(1)  # one speed is the shortest list
    _check_points("airspeed", speeds.size)
    if vary is not None:
        return _line_of_input(case, speeds.reshape(-1), vary, options)
    if _is_batch(case, options):
        return None
    if speeds.ndim != 1:
        raise InputError("airspeed", f"array of shape {speeds.shape}", "must be a list of speeds to sweep")
    return Line(speeds, lambda speed: case.linearize(speed, **options))


def _check_points(field: str, points: int) -> None:
    size = _BYTES_PER_POINT * points
    check_memory(field, f"{points} points", size, "following their modes", "take fewer points")


def _line_of_input(
    case: Configuration, speed: Array, vary: Mapping[str, ArrayLike], options: Mapping[str, Any]
) -> Line:
    from proprotor.deck.vary import design_inputs
    from proprotor.units import values_in_si

    if len(vary) != 1:
        raise InputError("vary", ", ".join(vary), "must be one input to sweep")
    (path, given), *_ = vary.items()
    known = design_inputs(case)
    if path not in known:
        raise InputError(path, None, unknown_name(path, known, "input"))
    unit = known[path].unit
    values = values_in_si(given, unit, path)
    if len(speed) != 1 or values.ndim != 1:
        raise InputError("vary", path, "needs a list of values, and one airspeed")
    _check_points(path, values.size)

    def linearize(positions: Array) -> LinearModel:
        return vary_case(case, {path: positions}).linearize(speed[0], **options)

    vary_case(case, {path: values})  # which tells what is wrong with the values
    return Line(values, linearize, path, unit)


def approach_to(
    case: Configuration, line: Line, model: LinearModel, options: Mapping[str, Any]
) -> Line | None:
    """The way to a line from the anchor: the case's own inputs near cruise (`anchor_speed`).

    Along airspeeds to the line's own, or to its one airspeed; there, from the case's own value of the input to its
    nearest on the line. None where there is no anchor, or the line has no point that works.
    """
    start, works = anchor_speed(case, **options), np.flatnonzero(model.trim.converged)
    if start is None or not len(works):
        return None
    tip, values = tip_speed(case), np.asarray(line.positions)
    if line.name == "airspeed":
        end = float(values[works[np.argmin(np.abs(values[works] - start))]])
        count = 2 + int(abs(end - start) / (_STRIDE * tip))
        return Line(np.linspace(start, end, count), line.linearize)
    from proprotor.deck.vary import design_inputs

    own, speed = float(design_inputs(case)[line.name].si), float(np.real(model.airspeed.flat[0]))
    end = float(values[works[np.argmin(np.abs(values[works] - own))]])
    first, second = abs(speed - start) / tip, abs(end - own) / max(abs(own), abs(end), 1e-300)

    def linearize(way: Array) -> LinearModel:
        done = np.clip(way / first, 0, 1) if first > 0 else np.ones_like(way)
        beyond = np.clip((way - first) / second, 0, 1) if second > 0 else np.zeros_like(way)
        varied = vary_case(case, {line.name: own + beyond * (end - own)})
        return varied.linearize(start + done * (speed - start), **options)

    count = 2 + int((first + second) / _STRIDE)
    return Line(np.linspace(0.0, first + second, count), linearize, "way from the anchor", "1", end)


def tip_speed(case: Configuration) -> float:
    """Rotor speed times radius of a case, m/s."""
    return float(case.operation.rotor_speed) * float(case.rotor.radius)


def anchor_speed(case: Configuration, **options: Any) -> float | None:
    """Airspeed in m/s at which the branches of a case get their labels.

    Seven tenths of the tip speed, which is near cruise; less where there is no trim; None where there is none at all.
    """
    speeds = tip_speed(case) * np.array(ANCHORS)
    works = np.flatnonzero(case.linearize(speeds, **options).trim.converged)
    return float(speeds[works[0]]) if len(works) else None


def _is_batch(case: Configuration, options: Mapping[str, Any]) -> bool:
    train = case.model_options(options).get("drive_train")
    return batch_shape(case.rotor, case.operation, np.zeros(()), train) != () or any(
        np.ndim(value) > 0 for name, value in options.items() if name.endswith("_coupling")
    )
