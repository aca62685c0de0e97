"""What a study finds out about one batch of designs: eigenvalues, the least stable mode, trim, flutter speed.

A design that cannot be, or a point that fails, has its reason and NaN; the rest of the batch is as if it were alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from proprotor import flutter_scan
from proprotor.arrays import Array
from proprotor.errors import InputError
from proprotor.mode_names import moving
from proprotor.modes import (
    coordinate_motion,
    coordinate_shares,
    decomposition,
    eigensystem,
    held_coordinates,
    participation,
    state_matrix,
)
from proprotor.sampling import AIRSPEED
from proprotor.source_code import check_code
from proprotor.study_modes import follow_designs
from proprotor.tracking import NOT_TOLD

if TYPE_CHECKING:
    from proprotor.case import Case
    from proprotor.model import LinearModel

QUANTITIES = ("eigenvalue", "least_stable", "trim", "flutter", "vectors", "modes")
ALONG_AIRSPEEDS = ("flutter", "modes")  # need all airspeeds of a design at once
DEFAULT_QUANTITIES = QUANTITIES[:3]
_NEUTRAL = 1e-12  # of the largest eigenvalue: a root at zero has no damping
_BLOCK = 64  # points whose vectors stay in the cache
_BAD_INPUT = (InputError, np.linalg.LinAlgError)

POINT, DESIGN = "point", "design"


class Variable(NamedTuple):
    """A variable of the results: on points or designs, further dimensions, type, unit and meaning."""

    on: str
    dims: tuple[str, ...]
    dtype: Any
    units: str
    meaning: str


VARIABLES: dict[str, dict[str, Variable]] = {
    "eigenvalue": {
        "eigenvalue": Variable(POINT, ("state",), complex, "rad/s", "all eigenvalues, by frequency |Im s|"),
    },
    "least_stable": {
        "growth_rate": Variable(POINT, (), float, "1/s", "largest real part of all eigenvalues"),
        "damping_ratio": Variable(
            POINT, (), float, "1", "-Re s/|s| of the mode with the lowest damping ratio"
        ),
        "frequency": Variable(POINT, (), float, "rad/s", "|Im s| of the mode with the lowest damping ratio"),
    },
    "trim": {
        "collective": Variable(POINT, (), float, "rad", "pitch at 0.75 R without the elastic pitch"),
        "coning": Variable(POINT, (), float, "rad", "trim flap angle beyond the precone"),
        "lag": Variable(POINT, (), float, "rad", "trim lag angle"),
        "elastic_pitch": Variable(POINT, (), float, "rad", "trim elastic pitch"),
        "thrust": Variable(POINT, (), float, "N", "of the airloads on the rotor"),
        "torque": Variable(
            POINT, (), float, "N*m", "of the airloads on the rotor, positive where it speeds it up"
        ),
    },
    "flutter": {
        "flutter_speed": Variable(
            DESIGN, (), float, "m/s", "lowest airspeed of the range at which stability is lost"
        ),
        "flutter_frequency": Variable(
            DESIGN, (), float, "rad/s", "|Im s| of the mode that loses it; 0: divergence"
        ),
        "flutter_mode": Variable(DESIGN, (), str, "", "what moves in it at that airspeed"),
        "flutter_coordinate": Variable(DESIGN, (), str, "", "coordinate that takes part in it most"),
        "flutter_note": Variable(DESIGN, (), str, "", "why there is no flutter speed"),
    },
    "vectors": {
        "vector": Variable(
            POINT, ("dof", "state"), complex, "", "motion of the coordinates; largest component 1"
        ),
    },
    "modes": {
        "mode_eigenvalue": Variable(
            POINT, ("state",), complex, "rad/s", "eigenvalues, followed along the airspeeds"
        ),
        "mode_quality": Variable(
            POINT, ("state",), float, "1", "trust in the step from the airspeed before, 0 to 1"
        ),
        "mode_name": Variable(POINT, ("state",), str, "", "what moves in it at the point"),
        "mode_share": Variable(POINT, ("state",), float, "1", "participation of what its name says, 0 to 1"),
        "mode_coordinate": Variable(DESIGN, ("state",), str, "", "coordinate that takes part most at first"),
    },
}
ALWAYS = {
    "reason": Variable(POINT, (), str, "", "why a point failed"),
    "warning": Variable(POINT, (), str, "", "what makes a point doubtful"),
}

_SCAN = {  # what the search for a flutter speed needs of every point, whether or not it is among the results
    "growth_rate": VARIABLES["least_stable"]["growth_rate"],
    "neutral_growth": Variable(POINT, (), float, "1/s", "growth that is rounding of a neutral root"),
}
VARIABLE = {name: it for of in (*VARIABLES.values(), ALWAYS, _SCAN) for name, it in of.items()}


def variables(quantities: tuple[str, ...]) -> dict[str, Variable]:
    """The variables of the chosen quantities, by name."""
    return {name: it for quantity in quantities for name, it in VARIABLES[quantity].items()} | ALWAYS


def empty(variable: Variable, shape: tuple[int, ...]) -> Array:
    """An array of a variable with nothing found yet."""
    dtype = object if variable.dtype is str else variable.dtype
    return np.full(shape, "" if variable.dtype is str else np.nan, dtype=dtype)


@dataclass(frozen=True)
class Batch:
    """A block of designs at a block of airspeeds.

    inputs: SI values (designs,) by deck path, airspeed among them where it varies with the design; airspeed (speeds,).
    """

    inputs: Mapping[str, Array]
    airspeed: Array | None

    def some(self, rows: Any, columns: Any = slice(None)) -> Batch:
        """Some of the designs, at some of the airspeeds."""
        speeds = None if self.airspeed is None else self.airspeed[columns]
        return Batch({name: values[rows] for name, values in self.inputs.items()}, speeds)

    @property
    def shape(self) -> tuple[int, int]:
        """Designs and airspeeds."""
        speeds = 1 if self.airspeed is None else len(self.airspeed)
        return len(next(iter(self.inputs.values()))) if self.inputs else 1, speeds

    @property
    def speeds(self) -> Array:
        """Airspeeds that broadcast to the shape of the batch."""
        return self.inputs[AIRSPEED][:, None] if self.airspeed is None else self.airspeed

    @property
    def numbers(self) -> dict[str, Array]:
        """Numbers of the deck that vary, (designs, 1)."""
        return {name: values[:, None] for name, values in self.inputs.items() if name != AIRSPEED}


@dataclass(frozen=True)
class Analysis:
    """What to find for any batch; the same everywhere in a study, and sent to its workers once.

    Parameters
    ----------
    case : Case
    quantities : tuple of str
        Of `QUANTITIES`.
    options : mapping
        Of `Case.linearize`.
    dofs : tuple of str
        Coordinates of the model.
    states : int
        Its number of eigenvalues.
    tolerance : float
        On a flutter speed, m/s.
    code : str
        Fingerprint of the code that must analyse; empty where any may.
    """

    case: Case
    quantities: tuple[str, ...]
    options: Mapping[str, Any] = field(default_factory=dict)
    dofs: tuple[str, ...] = ()
    states: int = 0
    tolerance: float = flutter_scan.TOLERANCE
    code: str = ""

    def __call__(self, batch: Batch) -> dict[str, Array]:
        """All variables of a batch: (designs, speeds, …) those of points, (designs,) those of designs.

        Raises
        ------
        InputError
            When this process runs other code than it should.
        """
        if self.code:
            check_code(self.code)
        found = self._blank(batch.shape)
        every = np.arange(batch.shape[0]), np.arange(batch.shape[1])
        try:
            self._put(found, *every, self._points(batch))
        except _BAD_INPUT:
            refused = self._refusals(batch)
            found["reason"][:] = refused[:, None]
            self._fill(found, batch, np.flatnonzero(refused == ""), every[1])
        if "flutter" in self.quantities:
            self._find_flutter(found, batch)
        return {name: found[name] for name in variables(self.quantities)}

    def _blank(self, shape: tuple[int, int]) -> dict[str, Array]:
        sizes = {"state": self.states, "dof": len(self.dofs)}
        wanted = variables(self.quantities) | (_SCAN if "flutter" in self.quantities else {})
        return {
            name: empty(it, (*(shape if it.on == POINT else shape[:1]), *(sizes[dim] for dim in it.dims)))
            for name, it in wanted.items()
        }

    def _refusals(self, batch: Batch) -> Array:
        """Why each design cannot be, empty where it can: those refused together are halved until one stands alone."""
        reasons = np.full(batch.shape[0], "", dtype=object)
        parts = [np.arange(batch.shape[0])] if batch.numbers else []
        while parts:
            rows = parts.pop()
            try:
                self.case.vary(batch.some(rows).numbers)
            except InputError as error:
                if len(rows) > 1:
                    parts.extend(np.array_split(rows, 2))
                else:
                    reasons[rows] = self._told(batch.some(rows), error)
        return reasons

    def _told(self, single: Batch, error: Exception) -> str:
        """A refusal on one line, with plain numbers of the design in place of arrays."""
        try:
            self.case.vary({name: float(values[0, 0]) for name, values in single.numbers.items()})
        except InputError as plain:
            error = plain
        return " ".join(str(error).split("\n"))

    def _fill(self, found: dict[str, Array], batch: Batch, rows: Array, columns: Array) -> None:
        """Analyse designs and airspeeds at once; where that fails, halves of them, until what is wrong stands alone."""
        if not len(rows) or not len(columns):
            return
        part = batch.some(rows, columns)
        try:
            points = self._points(part)
        except _BAD_INPUT as error:
            if len(rows) > 1:
                for half in np.array_split(rows, 2):
                    self._fill(found, batch, half, columns)
            elif len(columns) > 1:
                alone = np.array([self._is_refused(batch.some(rows, [column])) for column in columns])
                if not alone.any():
                    raise
                for column in columns[alone]:
                    self._fill(found, batch, rows, np.array([column]))
                self._fill(found, batch, rows, columns[~alone])
            else:
                found["reason"][np.ix_(rows, columns)] = self._told(part, error)
            return
        self._put(found, rows, columns, points)

    @staticmethod
    def _put(found: dict[str, Array], rows: Array, columns: Array, points: dict[str, Array]) -> None:
        for name in found.keys() & points.keys():
            found[name][np.ix_(rows, columns) if VARIABLE[name].on == POINT else rows] = points[name]

    def _is_refused(self, point: Batch) -> bool:
        try:
            self._points(point)
        except _BAD_INPUT:
            return True
        return False

    def _model(self, batch: Batch, speeds: Array) -> LinearModel:
        case = self.case.vary(batch.numbers) if batch.numbers else self.case
        shape = np.broadcast_shapes(np.shape(speeds), (batch.shape[0], 1))
        return case.linearize(np.broadcast_to(speeds, shape), **self.options)

    def _points(self, batch: Batch) -> dict[str, Array]:
        model = self._model(batch, batch.speeds)
        found: dict[str, Array] = {name: getattr(model.trim, name) for name in ALWAYS}
        if "trim" in self.quantities:
            found |= {name: getattr(model.trim, name) for name in VARIABLES["trim"]}
        if "modes" in self.quantities:
            found |= _followed(model, "vectors" in self.quantities)
            found["warning"] = _with_doubt(found["warning"], found["mode_quality"])
        elif "vectors" in self.quantities:
            found |= _eigenvalues_and_vectors(model, self.states)
        else:
            found["eigenvalue"] = _eigenvalues(model, self.states)
        if {"least_stable", "flutter"} & set(self.quantities):
            found |= _least_stable(found["eigenvalue"])
        return found

    # Flutter speed --------------------------------------------------------------------------------

    def _find_flutter(self, found: dict[str, Array], batch: Batch) -> None:
        scan = (found["growth_rate"], batch.speeds, found["reason"], found["neutral_growth"])
        bracket = flutter_scan.brackets(*scan)
        found["flutter_note"][:] = bracket.note
        failure = np.full(batch.shape[0], "", dtype=object)

        def growth(rows: Array, speeds: Array) -> Array:
            values, failure[rows] = self._one_speed_each(batch.some(rows), speeds, self._growth_of)
            return values.get("growth_rate", np.full(len(rows), np.nan))

        speed = flutter_scan.refine(bracket, growth, self.tolerance)
        found["flutter_speed"][:] = speed
        rows = np.flatnonzero(np.isfinite(speed))
        if len(rows):
            values, _ = self._one_speed_each(batch.some(rows), speed[rows], self._mode_at_boundary)
            for name, array in values.items():
                found[name][rows] = array
        for row in np.flatnonzero(np.isnan(speed) & (bracket.note == "")):
            found["flutter_note"][row] = failure[row] or "the search between two airspeeds did not converge"

    def _one_speed_each(
        self, batch: Batch, speeds: Array, analyse: Callable[[LinearModel], dict[str, Array]]
    ) -> tuple[dict[str, Array], Array]:
        """What an analysis finds for each design at an airspeed of its own (designs,), and why it failed."""
        try:
            model = self._model(batch, speeds[:, None])
            return {name: array[:, 0] for name, array in analyse(model).items()}, model.trim.reason[:, 0]
        except _BAD_INPUT as error:
            if len(speeds) == 1:
                return {}, np.array([self._told(batch, error)], dtype=object)
        parts = np.array_split(np.arange(len(speeds)), 2)
        halves = [self._one_speed_each(batch.some(part), speeds[part], analyse) for part in parts]
        values: dict[str, Array] = {}
        for part, (half, _) in zip(parts, halves, strict=True):
            for name, array in half.items():
                missing = "" if array.dtype == object else np.nan
                values.setdefault(name, np.full(len(speeds), missing, dtype=array.dtype))[part] = array
        return values, np.concatenate([reason for _, reason in halves])

    def _growth_of(self, model: LinearModel) -> dict[str, Array]:
        return _least_stable(_eigenvalues(model, self.states))

    @staticmethod
    def _mode_at_boundary(model: LinearModel) -> dict[str, Array]:
        """Frequency, name and main coordinate of the mode with the largest real part."""
        system = eigensystem(model)
        place = np.nan_to_num(_growth(system.values), nan=-np.inf).argmax(axis=-1)[..., None]
        shares = np.take_along_axis(participation(model, system), place[..., None], -1)[..., 0]
        frequency = np.abs(np.take_along_axis(system.values, place, -1)[..., 0].imag)
        main = np.array(model.dofs, dtype=object)[np.nan_to_num(shares).argmax(axis=-1)]
        names = moving(model, system.values, system.left, system.right).names
        name = np.take_along_axis(names, place, -1)[..., 0]
        return {"flutter_frequency": frequency, "flutter_mode": name, "flutter_coordinate": main}


def _good_part(model: LinearModel) -> tuple[Array | None, LinearModel]:
    """Which points have a trim, None for all of them, and the model there."""
    good = np.asarray(model.trim.converged)
    if good.all():
        return None, model
    names = ("M", "C", "K", "airspeed", "shapes")
    parts = {name: getattr(model, name)[good] for name in names if getattr(model, name) is not None}
    return good, replace(model, **parts)


def _at(good: Array | None, found: Array, shape: tuple[int, ...]) -> Array:
    """What was found at the good points, in the shape of the batch, NaN at the others."""
    if good is None:
        return found
    whole = np.full((*shape, *found.shape[1:]), np.nan, dtype=found.dtype)
    whole[good] = found
    return whole


def _eigenvalues(model: LinearModel, states: int) -> Array:
    """All eigenvalues (..., states), by |Im s| and the one above the real axis first; NaN at failed points."""
    good, part = _good_part(model)
    if good is not None and not good.any():
        return np.full((*good.shape, states), np.nan, dtype=complex)
    values = np.linalg.eigvals(state_matrix(part)).astype(complex, copy=False)
    values = np.take_along_axis(values, _by_frequency(values), -1)
    return _at(good, values, model.M.shape[:-2])


def _by_frequency(values: Array) -> Array:
    return np.lexsort((values.real, values.imag < 0, np.abs(values.imag)), axis=-1)


def _eigenvalues_and_vectors(model: LinearModel, states: int) -> dict[str, Array]:
    """The same with the motion of the coordinates (..., n, states), its largest component 1."""
    good, part = _good_part(model)
    n, shape = len(model.dofs), model.M.shape[:-2]
    if good is not None and not good.any():
        sizes = {"eigenvalue": (states,), "vector": (n, states)}
        return {name: np.full((*shape, *size), np.nan, dtype=complex) for name, size in sizes.items()}
    matrix = state_matrix(part)
    flat = matrix.reshape(-1, *matrix.shape[-2:])
    values, vectors = (
        np.empty((len(flat), states), dtype=complex),
        np.empty((len(flat), n, states), dtype=complex),
    )
    for start in range(0, len(flat), _BLOCK):
        rows = slice(start, start + _BLOCK)
        found, right = np.linalg.eig(flat[rows])
        order = _by_frequency(found)
        values[rows] = np.take_along_axis(found, order, -1)
        shapes = coordinate_motion(held_coordinates(part), n, found, right)
        vectors[rows] = _largest_one(np.take_along_axis(shapes, order[:, None, :], -1))
    leading = matrix.shape[:-2]
    return {
        name: _at(good, array.reshape(*leading, *array.shape[1:]), shape)
        for name, array in (("eigenvalue", values), ("vector", vectors))
    }


def _followed(model: LinearModel, with_vectors: bool) -> dict[str, Array]:
    """Eigenvalues by frequency and followed along the airspeeds, and the motion of the coordinates if asked for."""
    spectrum = decomposition(model)
    values, right, left = spectrum.all_modes
    held, n = held_coordinates(model), len(model.dofs)
    order = _by_frequency(values)
    places, quality, first = follow_designs(spectrum, order)
    designs = np.arange(len(values))
    moves = moving(model, values, left, right)
    shares = coordinate_shares(held, n, left[designs, first], right[designs, first])
    main = np.take_along_axis(np.nan_to_num(shares).argmax(axis=-2), places[designs, first], -1)
    found = {
        "eigenvalue": np.take_along_axis(values, order, -1),
        "mode_eigenvalue": np.take_along_axis(values, places, -1),
        "mode_quality": quality,
        "mode_name": np.take_along_axis(moves.names, places, -1),
        "mode_share": np.take_along_axis(moves.share, places, -1),
        "mode_coordinate": np.where((first < 0)[:, None], "", np.array(model.dofs, dtype=object)[main]),
    }
    if with_vectors:
        shapes = coordinate_motion(held, n, values, right)
        found["vector"] = _largest_one(np.take_along_axis(shapes, order[..., None, :], -1))
    return found


def _with_doubt(warning: Array, quality: Array) -> Array:
    """Warnings (designs, speeds) with one more at points to which a step of no quality leads."""
    joined = np.array(warning, dtype=object)
    lost = (quality <= 0).any(axis=-1)
    joined[lost] = [f"{text}; {NOT_TOLD}" if text else NOT_TOLD for text in joined[lost]]
    return joined


def _largest_one(shapes: Array) -> Array:
    """Columns divided by their largest component."""
    size = np.nan_to_num(shapes.real**2 + shapes.imag**2)
    with np.errstate(all="ignore"):
        scaled: Array = shapes / np.take_along_axis(shapes, size.argmax(axis=-2)[..., None, :], -2)
    return scaled


def _growth(values: Array) -> Array:
    """Real part of each eigenvalue; that of a root at zero does not count."""
    size = np.abs(values)
    return np.where(size <= _NEUTRAL * size.max(axis=-1, keepdims=True), -np.inf, values.real)


def _least_stable(values: Array) -> dict[str, Array]:
    """Growth of the batch's points, damping and frequency of the mode damped least, from eigenvalues (..., states)."""
    size = np.abs(values)
    largest = size.max(axis=-1)
    counts = size > _NEUTRAL * largest[..., None]
    with np.errstate(all="ignore"):
        ratio = np.where(counts, -values.real / size, np.inf)
    place = ratio.argmin(axis=-1)[..., None]
    failed = np.isnan(largest)
    growth = np.where(counts, values.real, -np.inf).max(axis=-1)
    return {
        "growth_rate": np.where(failed, np.nan, growth),
        "neutral_growth": flutter_scan.NOT_UNSTABLE * largest,
        "damping_ratio": np.where(failed, np.nan, np.take_along_axis(ratio, place, -1)[..., 0]),
        "frequency": np.where(failed, np.nan, np.abs(np.take_along_axis(values.imag, place, -1)[..., 0])),
    }
