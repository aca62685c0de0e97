"""Modes followed along a line of points, each one under its own name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.arrays import Array
from proprotor.errors import InputError, unknown_name
from proprotor.mode_names import SECOND, assign_names, name_list, name_shares, whirl
from proprotor.model import LinearModel, batch_shape
from proprotor.modes import (
    Eigensystem,
    coordinate_motion,
    coordinate_shares,
    held_coordinates,
    mode_dataset,
    with_azimuth,
)
from proprotor.path import Line, Path, follow, path_of
from proprotor.speed import in_metres_per_second
from proprotor.tracking import Spectrum, link, side_by_side

if TYPE_CHECKING:
    import xarray

    from proprotor.case import Case

ANCHORS = (0.7, 0.5, 0.35, 0.2)  # of the tip speed: where modes get their names, the first that has a trim
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
    rotor_speed: float | None = None,
    approach: Line | None = None,
) -> xarray.Dataset:
    """Modes of a line of points, tracked and named.

    Parameters
    ----------
    model : LinearModel
        One point for each position of the line.
    line : Line, optional
        Airspeeds of the model by default; with its `linearize`, steps that do not tell which mode is which are divided.
    rotor_speed : float, optional
        rad/s, where the modes get their names. Without it, regressive and progressive are told by the whirl in the
        fixed frame alone.
    approach : Line, optional
        From the anchor, where modes get their names, to the point of the line that is nearest to it, both included:
        names then do not depend on where the line begins and ends. Without it, or where it fails, they are given at
        the first point that works.

    Returns
    -------
    xarray.Dataset
        As `LinearModel.modes`, with mode names (`proprotor.mode_names`) as coordinate and the same mode in the same
        place at every point; whirl (-1 against the rotor to 1 with it, in the fixed frame); tracking_quality, the
        trust in the steps that led to a point, 0 to 1. Attributes: eigen_solves, and named_at, where names were given.

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
    points, n, held = len(model.airspeed), len(model.dofs), held_coordinates(model)
    path = follow(model, line)
    order = path.order(points)
    named = state_names(model, line, path, rotor_speed, approach)
    columns, modes = mode_columns(model.dofs, path, named)
    values, right, left = path.spectrum.at(slice(points)).modes(order[:, columns])
    # Of a pair that parts into two real roots the second is a mode only where it is real.
    values = np.where(values.imag < 0, np.nan, values)
    shapes = coordinate_motion(held, n, values, right)
    data = mode_dataset(model, values, shapes, coordinate_shares(held, n, left, right), line)
    by_mode = data.eigenvalue.dims
    sense = np.where(np.isnan(values), np.nan, whirl(model.dofs, held, values, left, right))
    works = path.spectrum.works[:points, None]
    trust = np.where(works, path.trust(points)[:, columns], np.nan)
    data["whirl"] = by_mode, sense, {"units": "1", "long_name": "whirl with the rotor, in the fixed frame"}
    data["tracking_quality"] = by_mode, trust, {"units": "1", "long_name": "trust in the steps to a point"}
    data.attrs = {"eigen_solves": len(path.points) + named.eigen_solves, "named_at": named.told}
    return data.assign_coords(mode=modes)


class Named(NamedTuple):
    """Names of the states of one point of a path, in the order of its spectrum.

    point : place of the point in the path; names : one for each state; told : where names were given;
    eigen_solves : what that took beyond the path's own.
    """

    point: int
    names: list[str]
    told: str
    eigen_solves: int


def state_names(
    model: LinearModel, line: Line, path: Path, rotor_speed: float | None, approach: Line | None
) -> Named:
    """Names of states at the point nearest to the anchor, followed from there; else given at the first point."""
    held = held_coordinates(model)
    if not len(path.points):
        return Named(0, [], "", 0)
    if approach is not None:
        on_the_way = approach.models(approach.positions)
        # A shaft may hold the azimuth on the way there, or on the line, alone.
        of_both = max(held, held_coordinates(on_the_way), key=len)
        leg = follow(on_the_way, approach, of_both)
        ends = [0, len(approach.positions) - 1]
        if len(leg.points) and [leg.points[0], leg.points[-1]] == ends:
            nearest = int(np.argmin(np.abs(path.positions[path.points] - approach.end)))
            given = names_at(model.dofs, of_both, leg.spectrum, 0, rotor_speed)
            here = path.spectrum.at([int(path.points[nearest])])
            whole = with_azimuth(here, model.dofs, len(of_both) + len(model.dofs))
            successor = _same_point(leg, ends[1], whole)
            names = {int(state): given[first] for first, state in zip(leg.places[0], successor, strict=True)}
            told = f"{approach.name} {approach.positions[0]:.6g} {approach.units}"
            given = [names[state] for state in range(here.values.shape[1])]
            return Named(nearest, given, told, len(leg.points))
    first = int(path.points[0])
    told = f"{line.name} {float(line.positions[first]):.6g} {line.units}"
    return Named(0, names_at(model.dofs, held, path.spectrum, first, rotor_speed), told, 0)


def _same_point(leg: Path, last: int, here: Spectrum) -> Array:
    """Which states of a point, a spectrum (1, states), the followed states of a path are at the same point."""
    both = leg.spectrum.at([last]).joined(here)
    successor = link(both, np.array([0]), np.array([1])).successor[0]
    states: Array = successor[leg.places[-1]]
    return states


def names_at(
    dofs: tuple[str, ...], held: list[int], spectrum: Spectrum, point: int, rotor_speed: float | None
) -> list[str]:
    values, right, left = spectrum.at(point).all_modes
    shares = name_shares(dofs, held, values, left, right, rotor_speed)
    return assign_names(dofs, held, shares, values)


def mode_columns(dofs: tuple[str, ...], path: Path, named: Named) -> tuple[Array, list[str]]:
    """Which followed states are modes, in the order of the coordinates, and what they are called.

    A state is a mode where it is in the upper half plane, or real; of each pair the one above is, and the other only if
    it is real somewhere, as the second root. A root that some points do not have comes after one that all have.
    """
    if not len(path.points):  # no point worked: there are no modes
        return np.empty(0, dtype=int), []
    values = path.values
    names = [named.names[state] for state in path.places[named.point]]
    above, real = (values.imag > 0).sum(axis=0), (values.imag == 0).any(axis=0)
    below = (values.imag < 0).sum(axis=0)
    slow, absent = np.nan_to_num(np.abs(values)).mean(axis=0), np.isnan(values).sum(axis=0)
    columns, modes = [], []
    for name in name_list(dofs):
        own = [c for c, called in enumerate(names) if called == name]
        own.sort(key=lambda c: (below[c] - above[c], absent[c], slow[c]))
        for place, column in enumerate(own):
            if place == 0 or real[column]:
                columns.append(column)
                modes.append(name + SECOND * (place > 0))
    return np.array(columns, dtype=int), modes


def sweep_case(
    case: Case, airspeeds: Any, vary: Mapping[str, ArrayLike] | None = None, **options: Any
) -> xarray.Dataset:
    """Modes of a case along airspeeds, or along one input at one airspeed: see `sweep`.

    Modes get their names at the case's own inputs and near cruise (`anchor_speed`), and are followed from there, so
    that names are the same in any range. Steps that do not tell modes apart are divided.

    Parameters
    ----------
    case : Case
    airspeeds : array (points,) in m/s, text such as "50:400:5kt", or pint quantity
        One airspeed with `vary`.
    vary : mapping of str to array (points,), optional
        One input by its path in the deck (`proprotor.design.design_inputs`), and its values in SI.
    **options
        See `proprotor.options.Options`.

    Returns
    -------
    xarray.Dataset
        As `sweep` has it.

    Raises
    ------
    InputError
        For an unknown option or input, airspeeds that do not form a line, or more than one input.
    """
    line = line_of_case(case, airspeeds, vary, options)
    if line is None:  # points differ in more than their airspeed
        return sweep(case.linearize(airspeeds, **options), rotor_speed=rotor_speed_of(case))
    model = line.models(line.positions)
    return sweep(
        model, line, rotor_speed=rotor_speed_of(case), approach=approach_to(case, line, model, options)
    )


def line_of_case(
    case: Case, airspeeds: Any, vary: Mapping[str, ArrayLike] | None, options: Mapping[str, Any]
) -> Line | None:
    """The line of airspeeds, or of an input; None where points differ in more than one number.

    Raises
    ------
    InputError
        For airspeeds that do not form a line, more than one input, or an unknown one.
    """
    speeds = in_metres_per_second(airspeeds)
    speeds = speeds if speeds.ndim else speeds.reshape(1)  # one speed is the shortest list
    if vary is not None:
        return _line_of_input(case, speeds.reshape(-1), vary, options)
    if _is_batch(case, options):
        return None
    if speeds.ndim != 1:
        raise InputError("airspeed", f"array of shape {speeds.shape}", "must be a list of speeds to sweep")
    return Line(speeds, lambda speed: case.linearize(speed, **options))


def _line_of_input(
    case: Case, speed: Array, vary: Mapping[str, ArrayLike], options: Mapping[str, Any]
) -> Line:
    from proprotor.design import design_inputs
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

    def linearize(positions: Array) -> LinearModel:
        return case.vary({path: positions}).linearize(speed[0], **options)

    case.vary({path: values})  # which tells what is wrong with the values
    return Line(values, linearize, path, unit)


def approach_to(case: Case, line: Line, model: LinearModel, options: Mapping[str, Any]) -> Line | None:
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
    from proprotor.design import design_inputs

    own, speed = float(design_inputs(case)[line.name].si), float(np.real(model.airspeed.flat[0]))
    end = float(values[works[np.argmin(np.abs(values[works] - own))]])
    first, second = abs(speed - start) / tip, abs(end - own) / max(abs(own), abs(end), 1e-300)

    def linearize(way: Array) -> LinearModel:
        done = np.clip(way / first, 0, 1) if first > 0 else np.ones_like(way)
        beyond = np.clip((way - first) / second, 0, 1) if second > 0 else np.zeros_like(way)
        varied = case.vary({line.name: own + beyond * (end - own)})
        return varied.linearize(start + done * (speed - start), **options)

    count = 2 + int((first + second) / _STRIDE)
    return Line(np.linspace(0.0, first + second, count), linearize, "way from the anchor", "1", end)


def tip_speed(case: Case) -> float:
    """Rotor speed times radius of a case, m/s."""
    return float(case.operation.rotor_speed) * float(case.rotor.radius)


def anchor_speed(case: Case, **options: Any) -> float | None:
    """Airspeed in m/s at which the modes of a case get their names.

    Seven tenths of the tip speed, which is near cruise; less where there is no trim; None where there is none at all.
    """
    speeds = tip_speed(case) * np.array(ANCHORS)
    works = np.flatnonzero(case.linearize(speeds, **options).trim.converged)
    return float(speeds[works[0]]) if len(works) else None


def rotor_speed_of(case: Case) -> float | None:
    """rad/s of a case that has one rotor speed."""
    return float(case.operation.rotor_speed) if np.ndim(case.operation.rotor_speed) == 0 else None


def _is_batch(case: Case, options: Mapping[str, Any]) -> bool:
    train = case.model_options(options).get("drive_train")
    return batch_shape(case.rotor, case.operation, np.zeros(()), train) != () or any(
        np.ndim(value) > 0 for name, value in options.items() if name.endswith("_coupling")
    )
