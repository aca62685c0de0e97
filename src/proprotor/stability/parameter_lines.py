"""Lines of points along which modes are followed: airspeeds of a case, or one input at one airspeed, and the approach.

The approach of a line is a line as well: from the anchor, where branches get their labels, to the point of the first
line that is nearest to the anchor. The anchor is the case with its own inputs, near cruise.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from proprotor.deck.input_values import input_values
from proprotor.deck.vary import inputs_at
from proprotor.deck.vary import vary as vary_case
from proprotor.errors import InputError
from proprotor.model import stamp
from proprotor.model.batches import as_grid
from proprotor.model.configuration import Configuration
from proprotor.model.first_order import in_one_axis, some_points
from proprotor.model.linear_model import LinearModel
from proprotor.model.quantities import batch_shape
from proprotor.needs import check_memory
from proprotor.rotor.options import parse_options
from proprotor.rotor.trim import Trim
from proprotor.typing import Array
from proprotor.units import in_metres_per_second

_Inputs = Callable[[Array], dict[str, Array]]  # positions (k,) along a line to the inputs there, by name

AIRSPEED = "airspeed"
ANCHORS = (0.7, 0.5, 0.35, 0.2)  # of the tip speed: where branches get labels, the first that has a trim
_BYTES_PER_POINT = 230_000.0  # while modes are followed and boundaries found; measured with wings of beams
_STRIDE = 0.02  # of the tip speed, or of the input: between the first points of an approach
_LONGEST = 10.0  # tip speeds: beyond them nothing has a trim, and an approach needs no more points


@dataclass(frozen=True, eq=False)
class ParameterLine:
    """Points along which modes are followed.

    Parameters
    ----------
    positions : array (points,)
        Airspeeds in m/s, or values of another input in SI.
    linearize : callable, optional
        Takes positions (k,) and returns the models there; needed for points between the points of the line.
    name, units : str
        Name and SI unit of the input.
    end : float, optional
        Of an approach: the position on the followed line at which the approach ends; the last position of the approach
        by default.
    inputs : callable, optional
        Of a line of a case: takes positions (k,) and returns the inputs there by name, the airspeed among them.
    model : LinearModel, optional
        Models at the positions of the line, where these are known already.
    """

    positions: Array
    linearize: Callable[[Array], LinearModel] | None = None
    name: str = AIRSPEED
    units: str = "m/s"
    end: float | None = None
    inputs: _Inputs | None = None
    model: LinearModel | None = None

    def models(self, positions: Array | None = None) -> LinearModel:
        """Return models at positions (k,) on the line or between its points; at its own points by default.

        Raises
        ------
        InputError
            When the line came without a function that linearises.
        """
        if positions is None and self.model is not None:
            return self.model
        if self.linearize is None:
            raise InputError("line", self.name, "must come with a function that linearises at its positions")
        return self.linearize(self.positions if positions is None else positions)


def models_at(case: Configuration, inputs: Mapping[str, Any], options: Mapping[str, Any]) -> LinearModel:
    """Return the models of a case with other values (k,) of some inputs, the airspeed (m/s) among them."""
    values, speed = as_grid({name: one for name, one in inputs.items() if name != AIRSPEED}, inputs[AIRSPEED])
    return in_one_axis((vary_case(case, values) if values else case).linearize(speed, **options))


def line_of_case(
    case: Configuration, airspeeds: Any, vary: Mapping[str, ArrayLike] | None, options: Mapping[str, Any]
) -> ParameterLine | None:
    """Return the line of airspeeds, or of an input; None where points differ in more than one number.

    Raises
    ------
    InputError
        For airspeeds that do not form a line, more than one input, an unknown input, or points that do not fit into
        memory.
    """
    given = in_metres_per_second(airspeeds, stamp.one_density(case, vary or ()))
    speeds = np.atleast_1d(given)  # one speed is the shortest list
    _check_points(AIRSPEED, speeds.size)
    if vary is not None:
        return _line_of_input(case, speeds.reshape(-1), vary, options)
    if _is_batch(case, options):
        return None
    if speeds.ndim != 1:
        raise InputError("airspeed", f"array of shape {speeds.shape}", "must be a list of speeds to sweep")
    return _line(case, options, speeds, lambda speed: {AIRSPEED: speed})


def _line(
    case: Configuration, options: Mapping[str, Any], positions: Array, inputs: _Inputs, *labels: Any
) -> ParameterLine:
    """Return a line of a case from its positions and the inputs at them, then name, unit and end of the line."""
    line = ParameterLine(positions, lambda at: models_at(case, inputs(at), options), *labels)
    return replace(line, inputs=inputs)


def _check_points(field: str, points: int) -> None:
    size = _BYTES_PER_POINT * points
    check_memory(field, f"{points} points", size, "following their modes", "take fewer points")


def _is_batch(case: Configuration, options: Mapping[str, Any]) -> bool:
    """Return whether a case or its options hold arrays, so that one airspeed has many models."""
    choice = parse_options(case.model_options(options))
    return batch_shape(case.rotor, case.operation, np.zeros(()), choice) != () or any(
        np.ndim(value) > 0 for name, value in options.items() if name.endswith("_coupling")
    )


def _line_of_input(
    case: Configuration, speed: Array, vary: Mapping[str, ArrayLike], options: Mapping[str, Any]
) -> ParameterLine:
    if len(vary) != 1:
        raise InputError("vary", ", ".join(vary), "must be one input to sweep")
    (path, given), *_ = vary.items()
    number = inputs_at(case, [path])[path]
    values = input_values(path, given, number)
    if len(speed) != 1 or values.ndim != 1:
        raise InputError("vary", path, "needs a list of values, and one airspeed")
    _check_points(path, values.size)
    vary_case(case, {path: values})  # raises an error that names what is wrong with the values

    def inputs(values: Array) -> dict[str, Array]:
        return {path: values, AIRSPEED: np.broadcast_to(speed, np.shape(values))}

    return _line(case, options, values, inputs, path, number.unit)


# The approach --------------------------------------------------------------------------------------------------------


def with_approach(
    case: Configuration, line: ParameterLine, options: Mapping[str, Any]
) -> tuple[LinearModel, ParameterLine | None]:
    """Return the models of a line of a case and its approach, see `approach_to`, linearised in one batch.

    The batch holds the approach from the first anchor to the nearest point of the line. Where one of these two has no
    trim, the approach is looked for once more.
    """
    reachable = np.asarray(line.positions)[np.isfinite(line.positions)]
    if not len(reachable):
        return line.models(), None
    approach = _approach(case, line, options, ANCHORS[0] * tip_speed(case), reachable)
    assert line.inputs is not None and approach.inputs is not None  # of lines of a case
    own, way = line.inputs(np.asarray(line.positions)), approach.inputs(np.asarray(approach.positions))
    both = models_at(case, {name: np.concatenate([own[name], way[name]]) for name in own}, options)
    count = len(line.positions)
    model, near = _points_of(both, slice(count)), _points_of(both, slice(count, None))
    if near.trim.converged[0] and near.trim.converged[-1]:
        return model, replace(approach, model=near)
    return model, approach_to(case, line, model.trim.converged, options)


def approach_to(
    case: Configuration, line: ParameterLine, works: Array, options: Mapping[str, Any]
) -> ParameterLine | None:
    """Return the approach to the nearest point of a line of a case that works, with the models along the approach.

    The anchor is the case with its own inputs at seven tenths of the tip speed, near cruise; at a lower airspeed where
    there is no trim. The approach goes along airspeeds to the line's own, or to its one airspeed, and then from the
    case's own value of the input to the nearest value on the line. None where there is no anchor, or the line has no
    point that works.
    """
    reachable = np.asarray(line.positions)[works]
    for start in np.array(ANCHORS) * tip_speed(case) if len(reachable) else ():
        approach = _approach(case, line, options, float(start), reachable)
        model = approach.models()
        if model.trim.converged[0]:
            return replace(approach, model=model)
    return None


def _approach(
    case: Configuration, line: ParameterLine, options: Mapping[str, Any], start: float, reachable: Array
) -> ParameterLine:
    """Return the approach from the anchor at an airspeed to the nearest of some positions of a line."""
    tip = tip_speed(case)
    if line.name == AIRSPEED:
        end = _nearest(reachable, start)
        return replace(line, positions=np.linspace(start, end, _points_over(abs(end - start), tip)))
    assert line.inputs is not None  # of a line of a case
    speed = float(line.inputs(reachable[:1])[AIRSPEED][0])
    own = float(inputs_at(case, [line.name])[line.name].si)
    end = _nearest(reachable, own)
    first, second = abs(speed - start) / tip, abs(end - own) / max(abs(own), abs(end), 1e-300)

    def inputs(way: Array) -> dict[str, Array]:
        done = np.clip(way / first, 0, 1) if first > 0 else np.ones_like(way)
        beyond = np.clip((way - first) / second, 0, 1) if second > 0 else np.zeros_like(way)
        return {line.name: own + beyond * (end - own), AIRSPEED: start + done * (speed - start)}

    positions = np.linspace(0.0, first + second, _points_over(first + second, 1.0))
    return _line(case, options, positions, inputs, "way from the anchor", "1", end)


def _points_over(way: float, unit: float) -> int:
    """Return how many points an approach has over a way, in a unit of one tip speed or of the input itself."""
    return 2 + int(min(way, _LONGEST * unit) / (_STRIDE * unit))


def _nearest(positions: Array, to: float) -> float:
    return float(positions[np.argmin(np.abs(positions - to))])


def tip_speed(case: Configuration) -> float:
    """Return the rotor speed of a case times its radius, m/s."""
    return float(case.operation.rotor_speed) * float(case.rotor.radius)


def _points_of(model: LinearModel, points: slice) -> LinearModel:
    """Return a model of some points of a line of models, with their trim."""
    trim = Trim(**{entry.name: getattr(model.trim, entry.name)[points] for entry in fields(Trim)})
    hub, left_hub = (
        hub if hub is None or hub.ndim == 2 else hub[points] for hub in (model.hub, model.left_hub)
    )
    part = some_points(model, points)
    return replace(part, trim=trim, airspeed=model.airspeed[points], hub=hub, left_hub=left_hub)
