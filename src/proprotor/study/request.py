"""The request that a study answers: designs and airspeeds in SI, read and checked, and the analysis of each batch."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from proprotor_equations import FIXED_COORDINATES

from proprotor.case import Case
from proprotor.compiled.library import compiler_version
from proprotor.deck.vary import inputs_at
from proprotor.errors import InputError, check_known
from proprotor.files.fingerprint import fingerprint
from proprotor.model import stamp
from proprotor.model.linear_model import LinearModel
from proprotor.rotor.motions import HALVES, HUB, INFLOW, LAGS_PER_BLADE, half_of, wing_lag_names
from proprotor.rotor.options import parse_options
from proprotor.study.batch import Analysis, Batch
from proprotor.study.description import as_attribute, described, with_deck_units
from proprotor.study.designs import AIRSPEED, Designs, paths_of
from proprotor.study.sampling import as_plan
from proprotor.study.variables import ALONG_AIRSPEEDS, POINT, QUANTITIES, bytes_of, shape_of, variables
from proprotor.support.airframe import Airframe
from proprotor.typing import Array, Dataset
from proprotor.units import in_metres_per_second

_SHAFT, _INTERCONNECT = "drive_train.shaft_stiffness", "drive_train.interconnect_stiffness"
_MOST_TRIED = 25  # airspeeds, to see the coordinates of the model


@dataclass(frozen=True, eq=False)
class Request:
    """The request that a study answers.

    Parameters
    ----------
    analysis : Analysis
        The analysis of each batch.
    designs : Designs
    airspeed : array (speeds,) or None
        m/s, the same for every design; None if airspeed is among the inputs.
    scalar_airspeed : bool
        Whether one airspeed was given as a number, so that the results have no axis of airspeeds.
    description : mapping
        What the study was asked, as plain data: see `proprotor.study.description`.
    """

    analysis: Analysis
    designs: Designs
    airspeed: Array | None
    scalar_airspeed: bool
    description: Mapping[str, Any] = field(default_factory=dict)

    @property
    def shape(self) -> tuple[int, int]:
        """Number of designs and of airspeeds."""
        return len(self.designs), 1 if self.airspeed is None else len(self.airspeed)

    @property
    def identity(self) -> dict[str, str]:
        """Fingerprints of everything that the results depend on, and the backend by its name."""
        from importlib.metadata import version

        analysis = self.analysis
        options = dict(analysis.options)
        backend = options.pop("backend", "")
        packages = ("proprotor", "numpy", "scipy", "fluids")
        compilers = [compiler_version()] if backend == "compiled" else []
        parts = {
            "case": analysis.case,
            "inputs": [self.designs.values, self.designs.axes],
            "airspeeds": self.airspeed,
            "quantities": analysis.quantities,
            "options": options,
            "tolerance": analysis.tolerance,
            "code": analysis.code,
            "versions": [version(package) for package in packages] + compilers,
        }
        return {name: fingerprint(part, name) for name, part in parts.items()} | {"backend": backend}

    @property
    def size(self) -> float:
        """Bytes of all results at most, estimated before the coordinates are known."""
        dofs = _most_coordinates(self.analysis.case, self.analysis.options)
        found = variables(self.analysis.quantities).values()
        return float(
            sum(math.prod(shape_of(one, self.shape, 2 * dofs, dofs)) * bytes_of(one) for one in found)
        )

    def batch(self, block: tuple[slice, slice]) -> Batch:
        """Return the designs and airspeeds of a block."""
        return Batch(self.designs.values, self.airspeed).some(*block)

    def with_coordinates(self) -> Request:
        """Return the same request with the coordinates of the model, found by the analysis of a few points."""
        case, options = self.analysis.case, self.analysis.options
        tried = self.designs.values[AIRSPEED] if self.airspeed is None else self.airspeed
        model = _model_of_points(case, tried, options)
        loose = len(model.azimuths) - _held_azimuths(case, self.designs, options, model)
        states = 2 * len(model.dofs) - len(model.rates) - loose
        return replace(self, analysis=replace(self.analysis, dofs=model.dofs, states=states))

    def dataset(self, found: Mapping[str, Array]) -> Dataset:
        """Return variables of all designs and airspeeds as a dataset over the inputs and airspeeds."""
        import xarray  # here, because it takes long to import

        analysis, axes = self.analysis, tuple(self.designs.axes)
        over_speeds = self.airspeed is not None and not self.scalar_airspeed
        data = {}
        for name, one in variables(analysis.quantities).items():
            array, along = found[name], over_speeds and one.on == POINT
            if name == "missing" and not (array != "").any():
                continue
            shape = (*self.designs.shape, *self.shape[1:] * along, *array.shape[1 + (one.on == POINT) :])
            attributes = {"long_name": one.meaning} | ({"units": one.units} if one.units else {})
            data[name] = ((*axes, *[AIRSPEED] * along, *one.dims), array.reshape(shape), attributes)
        coordinates: dict[str, Any] = with_deck_units(self.designs.coordinates, analysis.case)
        if self.airspeed is not None:
            speeds = self.airspeed if over_speeds else self.airspeed[0]
            coordinates[AIRSPEED] = ((AIRSPEED,) * over_speeds, speeds, {"units": "m/s"})
        if "vectors" in analysis.quantities:
            coordinates["dof"] = list(analysis.dofs)
        own = stamp.of_case(analysis.case, analysis.options, self.designs.values) | self.designs.attributes
        return xarray.Dataset(data, coordinates, own | as_attribute(self.description))


def requested(
    case: Case,
    inputs: Any,
    airspeed: Any,
    quantities: str | Sequence[str],
    tolerance: Any,
    options: Mapping[str, Any],
    code: str,
    backend: str,
) -> Request:
    """Return the request that the arguments of `proprotor.study` make, to be computed by a backend.

    Raises
    ------
    InputError
        For an unknown input, quantity or option, a value with a wrong unit, or airspeeds that the quantities refuse.
    """
    quantities = _known_quantities(quantities)
    computed = {**options, "backend": backend}
    parse_options(case.model_options(computed))
    plan = as_plan(inputs)
    varied = [path for path in paths_of(plan.inputs) if path != AIRSPEED]
    known = inputs_at(case, varied) if varied else {}
    designs = plan.resolve(known)
    own = AIRSPEED in plan.inputs
    if own == (airspeed is not None):
        raise InputError(AIRSPEED, airspeed, "must be given, either for all designs or among the inputs")
    speeds = None if own else in_metres_per_second(airspeed, stamp.one_density(case, paths_of(plan.inputs)))
    if speeds is not None and (speeds.ndim > 1 or not speeds.size):
        raise InputError(AIRSPEED, f"array of shape {speeds.shape}", "must be a speed or a list of speeds")
    for name in ALONG_AIRSPEEDS:
        if name in quantities:
            _check_range(speeds, name)
    analysis = Analysis(case, quantities, computed, code=code)
    if tolerance is not None:
        if not isinstance(tolerance, int | float) or not tolerance > 0:
            raise InputError("tolerance", tolerance, "must be a number above zero")
        analysis = replace(analysis, tolerance=float(tolerance))
    line = None if speeds is None else np.atleast_1d(speeds)
    description = described(case, plan, known, airspeed, speeds, quantities, tolerance, options)
    return Request(analysis, designs, line, speeds is not None and not speeds.ndim, description)


def _known_quantities(quantities: str | Sequence[str]) -> tuple[str, ...]:
    """Return the quantities in their own order, each once."""
    chosen = (quantities,) if isinstance(quantities, str) else tuple(quantities)
    for name in chosen:
        check_known("quantities", name, QUANTITIES, "quantity")
    if not chosen:
        raise InputError("quantities", None, f"must be of {', '.join(QUANTITIES)}")
    return tuple(name for name in QUANTITIES if name in chosen)


def _check_range(speeds: Array | None, quantity: str) -> None:
    if speeds is None or speeds.ndim != 1 or speeds.size < 2 or not np.all(np.diff(speeds) > 0):
        given = "among the inputs" if speeds is None else np.array2string(speeds, threshold=4)
        raise InputError(AIRSPEED, given, f'must be a range of increasing speeds for quantities="{quantity}"')


# Coordinates of the model -------------------------------------------------------------------------


def _held_azimuths(case: Case, designs: Designs, options: Mapping[str, Any], model: LinearModel) -> int:
    """Return how many azimuths a shaft holds in any design, which then has as many eigenvalues more than others."""
    of_shaft = len(model.azimuths)
    of_interconnect = sum(half_of(name)[0] == HALVES[1] for name in model.azimuths)
    for path, held in ((_SHAFT, of_shaft), (_INTERCONNECT, of_interconnect)):
        if any(np.any(np.nan_to_num(given) > 0) for given in _given(case, designs, options, path)):
            return held
    return 0


def _given(case: Case, designs: Designs, options: Mapping[str, Any], path: str) -> Iterator[Any]:
    """Yield the values of a field of the drive trains of a case, in all its designs."""
    trains = {"": case.model_options(options).get("drive_train")}
    if "drive_train" not in options and case.left is not None:
        trains["left."] = case.left.drive_train
    for side, train in trains.items():
        own = 0.0 if train is None else getattr(train, path.rpartition(".")[2])
        yield own if "drive_train" in options else designs.values.get(f"{side}{path}", own)


def _most_coordinates(case: Case, options: Mapping[str, Any]) -> int:
    """Return the number of coordinates of a model of the case with everything free."""
    blades = int(np.max(case.rotor.n_blades)) if options.get("reactionless") else 3
    own = len(FIXED_COORDINATES) - len(HUB) + 1 + 3 * (blades - 3)  # and the twist of the mast
    choice = parse_options(case.model_options(options))
    own += LAGS_PER_BLADE * blades * choice.blades_lag
    own += len(INFLOW) * choice.inflow_is_dynamic
    lift = case.support.wing if choice.wing_lags else None
    of_wing = 0 if lift is None else len(wing_lag_names(lift.symmetry))
    return len(case.support.names) + of_wing + own * (2 if isinstance(case.support, Airframe) else 1)


def _model_of_points(case: Case, speeds: Array, options: Mapping[str, Any]) -> LinearModel:
    """Return the case's model at some points, for its coordinates.

    Raises
    ------
    InputError
        When options hold arrays, which would make many models of one point.
    """
    few = speeds[np.unique(np.linspace(0, len(speeds) - 1, _MOST_TRIED).astype(int))]
    few = np.roll(few, -(len(few) // 2))  # the middle is the likeliest to have a trim
    for tried in (few[:1], few):
        model = case.linearize(tried, **options)
        if model.trim.converged.any():
            break
    if model.M.shape[:-2] != tried.shape:
        rule = "must not hold arrays: vary the case's inputs instead"
        raise InputError("options", ", ".join(options), rule)
    return model
