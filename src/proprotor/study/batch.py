"""What a study finds out about one batch of designs: eigenvalues, the least stable mode, trim, flutter speed.

A design that cannot be, or a point that fails, has its reason and NaN; the rest of the batch is as if it were alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from proprotor.errors import InputError
from proprotor.files.source_code import check_code
from proprotor.model.first_order import held_coordinates, missing_roots
from proprotor.stability.crossings import Brackets, Crossing, Search
from proprotor.stability.matching import NOT_TOLD, Spectrum
from proprotor.stability.mode_names import moving
from proprotor.stability.modes import coordinate_motion, coordinate_shares, decomposition, eigenvalues
from proprotor.stability.root_error import error_near_zero
from proprotor.study.mode_histories import follow_designs
from proprotor.study.sampling import AIRSPEED
from proprotor.typing import Array

if TYPE_CHECKING:
    from proprotor.case import Case
    from proprotor.model.linear_model import LinearModel

QUANTITIES = ("eigenvalue", "least_stable", "trim", "flutter", "vectors", "modes")
ALONG_AIRSPEEDS = ("flutter", "modes")  # need all airspeeds of a design at once
DEFAULT_QUANTITIES = QUANTITIES[:3]
STABLE = "stable throughout"
UNSTABLE = "unstable at the lowest airspeed"
_TOLERANCE = 1e-5  # m/s, on a flutter speed
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
            DESIGN, (), float, "m/s", "lowest airspeed of the range at which a mode becomes unstable"
        ),
        "flutter_frequency": Variable(
            DESIGN, (), float, "rad/s", "|Im s| of the mode that loses it; 0: divergence"
        ),
        "flutter_mode": Variable(DESIGN, (), str, "", "what moves in it at that airspeed"),
        "flutter_coordinate": Variable(DESIGN, (), str, "", "coordinate that takes part in it most"),
        "flutter_warning": Variable(DESIGN, (), str, "", "what makes the flutter speed doubtful"),
        "flutter_note": Variable(
            DESIGN, (), str, "", "why there is no flutter speed, or that it is not the first instability"
        ),
        "flutter_least_damping": Variable(
            DESIGN, (), float, "1", "lowest -Re s/|s| of all modes at the airspeeds of the range"
        ),
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
    "missing": Variable(POINT, (), str, "", "why a point has fewer eigenvalues than others"),
}

VARIABLE = {name: it for of in (*VARIABLES.values(), ALWAYS) for name, it in of.items()}


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
    tolerance: float = _TOLERANCE
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
        if "flutter" in self.quantities:
            self._find_flutter(found, batch)
        if self.quantities == ("flutter",):
            return found
        try:
            self._put(found, *every, self._points(batch))
        except _BAD_INPUT:
            refused = self._refusals(batch)
            found["reason"][:] = refused[:, None]
            self._fill(found, batch, np.flatnonzero(refused == ""), every[1])
        return found

    def _blank(self, shape: tuple[int, int]) -> dict[str, Array]:
        sizes = {"state": self.states, "dof": len(self.dofs)}
        return {
            name: empty(it, (*(shape if it.on == POINT else shape[:1]), *(sizes[dim] for dim in it.dims)))
            for name, it in variables(self.quantities).items()
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
        found: dict[str, Array] = {name: getattr(model.trim, name) for name in ("reason", "warning")}
        found["missing"] = missing_roots(model, self.states)
        if "trim" in self.quantities:
            found |= {name: getattr(model.trim, name) for name in VARIABLES["trim"]}
        if "modes" in self.quantities:
            found |= _followed(model, "vectors" in self.quantities)
            found["warning"] = _with_doubt(found["warning"], found["mode_quality"])
        elif "vectors" in self.quantities:
            found |= _eigenvalues_and_vectors(model)
        elif {"eigenvalue", "least_stable"} & set(self.quantities):
            found["eigenvalue"] = _eigenvalues(model)
        found = {name: self._with_all_states(name, array) for name, array in found.items()}
        if "least_stable" in self.quantities:
            found |= _least_stable(model, found["eigenvalue"])
        return found

    def _with_all_states(self, name: str, found: Array) -> Array:
        """An array over the states, which may be fewer in one batch than in others, with room for those of all."""
        more = self.states - found.shape[-1]
        if VARIABLE[name].dims[-1:] != ("state",) or not more:
            return found
        missing: Any = "" if found.dtype == object else np.nan
        return np.pad(found, [*[(0, 0)] * (found.ndim - 1), (0, more)], constant_values=missing)

    # Flutter speed --------------------------------------------------------------------------------

    def _find_flutter(self, found: dict[str, Array], batch: Batch) -> None:
        designs, speeds = batch.shape
        refused = np.full(designs, "", dtype=object)
        if batch.numbers:
            try:
                self.case.vary(batch.numbers)
            except InputError:
                refused = self._refusals(batch)
        found["reason"][:] = refused[:, None]
        rows = np.flatnonzero(refused == "")
        if not len(rows):
            found["flutter_note"][:] = refused
            return
        search = Search(
            lambda line, speed: self._model_of_each(batch.some(line), speed),
            np.repeat(rows, speeds),
            np.tile(np.asarray(batch.speeds, dtype=float), len(rows)),
            onset_only=True,
            forgiving=True,
            states=self.states or None,
        )
        scanned = search.scanned
        for name in ALWAYS:
            found[name][rows] = getattr(scanned, name).reshape(len(rows), speeds)
        found["flutter_note"][:] = self._notes(found["reason"], batch, search)
        if search.scanned.points is not None:
            brackets = Brackets(search, self.tolerance)
            first = _lowest(brackets.close())
            for place, why in brackets.lost.items():
                if brackets.line[place] not in first:
                    found["flutter_note"][brackets.line[place]] = f"the search for its boundary failed: {why}"
            _put_least_damping(found, search)
            self._put_onsets(found, first, batch)

    def _model_of_each(self, batch: Batch, speeds: Array) -> LinearModel:
        """Models of designs at an airspeed of its own each (designs,)."""
        numbers = {name: values[:, 0] for name, values in batch.numbers.items()}
        return (self.case.vary(numbers) if numbers else self.case).linearize(speeds, **self.options)

    def _put_onsets(self, found: dict[str, Array], first: Mapping[int, Crossing], batch: Batch) -> None:
        """Put the lowest onset of each design that has one in its place, with what moves there."""
        if not first:
            return
        rows, onsets = np.array(list(first)), list(first.values())
        model = self._model_of_each(batch.some(rows), np.array([one.position for one in onsets]))
        spectra = (np.stack([getattr(one.spectrum, part) for one in onsets]) for part in ("values", "right"))
        values, right, left = Spectrum(*spectra).all_modes
        every, state = np.arange(len(rows)), np.array([one.state for one in onsets])
        held = held_coordinates(model, values.shape[-1])
        shares = coordinate_shares(held, len(model.dofs), left, right)[every, :, state]
        found["flutter_speed"][rows] = [one.position for one in onsets]
        found["flutter_frequency"][rows] = [abs(one.value.imag) for one in onsets]
        found["flutter_mode"][rows] = moving(model, values, left, right).names[every, state]
        found["flutter_coordinate"][rows] = np.array(model.dofs, dtype=object)[shares.argmax(axis=-1)]
        found["flutter_warning"][rows] = model.trim.warning
        stable = found["flutter_note"][rows] != UNSTABLE
        found["flutter_note"][rows[stable]] = ""

    @staticmethod
    def _notes(reason: Array, batch: Batch, search: Search) -> Array:
        """What there is to say of each design before any boundary is known."""
        note = np.full(len(reason), "", dtype=object)
        works, unstable = np.zeros(len(reason), dtype=bool), np.zeros(len(reason), dtype=bool)
        if search.scanned.points is not None:
            points = search.first_points
            order = np.lexsort((points.position, points.line))
            lines, place = np.unique(points.line[order], return_index=True)
            first = order[place]
            works[lines], unstable[lines] = True, (points.growth[first] > points.error[first]).any(axis=1)
        for row, why in enumerate(reason):
            failed = np.flatnonzero(why != "")
            if not works[row]:
                note[row] = why[0] or "no airspeed could be analysed"
            elif unstable[row]:
                note[row] = UNSTABLE
            else:
                note[row] = STABLE + _beyond(failed, batch.speeds, why)
        return note


def _beyond(failed: Array, airspeed: Array, reason: Array) -> str:
    """What leaves open whether a design is stable."""
    if not len(failed):
        return ""
    return f"; {len(failed)} airspeeds failed, at {airspeed[failed[0]]:.6g} m/s: {reason[failed[0]]}"


def _lowest(found: list[Crossing]) -> dict[int, Crossing]:
    """The lowest onset of each design that has one."""
    first: dict[int, Crossing] = {}
    for one in sorted(found, key=lambda one: one.position, reverse=True):
        first[one.line] = one
    return first


def _put_least_damping(found: dict[str, Array], search: Search) -> None:
    """Put the lowest damping ratio of each design at the airspeeds of the range in its place."""
    scanned = search.scanned.points
    assert scanned is not None  # of a search with points
    values, size = scanned.spectrum.values, np.abs(scanned.spectrum.values)
    with np.errstate(all="ignore"):
        ratio = np.where(size > scanned.error, -values.real / size, np.inf).min(axis=1)
    least = np.full(len(found["flutter_note"]), np.inf)
    np.minimum.at(least, scanned.line, ratio)
    found["flutter_least_damping"][:] = np.where(np.isfinite(least), least, np.nan)


def _eigenvalues(model: LinearModel) -> Array:
    """All eigenvalues (..., states), by |Im s| and the one above the real axis first, NaN last and at failed points."""
    values = eigenvalues(model)
    return np.take_along_axis(values, _by_frequency(values), -1)


def _by_frequency(values: Array) -> Array:
    return np.lexsort((values.real, values.imag < 0, np.abs(values.imag)), axis=-1)


def _eigenvalues_and_vectors(model: LinearModel) -> dict[str, Array]:
    """The same with the motion of the coordinates (..., n, states), its largest component 1."""
    spectrum = decomposition(model)
    ordered = np.take_along_axis(spectrum.values, _by_frequency(spectrum.values), -1)
    return {"eigenvalue": ordered} | _vectors(model, spectrum.values, spectrum.right)


def _vectors(model: LinearModel, values: Array, right: Array) -> dict[str, Array]:
    """Motion of the coordinates (..., n, states) by frequency, a block of points at a time."""
    n, held, states = len(model.dofs), held_coordinates(model), values.shape[-1]
    flat, columns = values.reshape(-1, states), right.reshape(-1, states, states)
    found = np.empty((len(flat), n, states), dtype=complex)
    for start in range(0, len(flat), _BLOCK):
        rows = slice(start, start + _BLOCK)
        shapes = coordinate_motion(held, n, flat[rows], columns[rows])
        shapes = np.where(np.isnan(flat[rows])[:, None, :], np.nan, shapes)
        order = _by_frequency(flat[rows])
        found[rows] = _largest_one(np.take_along_axis(shapes, order[:, None, :], -1))
    return {"vector": found.reshape(*values.shape[:-1], n, states)}


def _followed(model: LinearModel, with_vectors: bool) -> dict[str, Array]:
    """Eigenvalues by frequency and followed along the airspeeds, and the motion of the coordinates if asked for."""
    spectrum = decomposition(model)
    values, right, left = spectrum.all_modes
    order = _by_frequency(values)
    places, quality, first = follow_designs(spectrum, order)
    designs = np.arange(len(values))
    moves = moving(model, values, left, right)
    shares = coordinate_shares(
        held_coordinates(model), len(model.dofs), left[designs, first], right[designs, first]
    )
    main = np.take_along_axis(np.nan_to_num(shares).argmax(axis=-2), places[designs, first], -1)
    followed = np.take_along_axis(values, places, -1)
    none = np.isnan(followed[designs, first])
    found = {
        "eigenvalue": np.take_along_axis(values, order, -1),
        "mode_eigenvalue": followed,
        "mode_quality": np.where(np.isnan(followed), np.nan, quality),
        "mode_name": np.take_along_axis(moves.names, places, -1),
        "mode_share": np.take_along_axis(moves.share, places, -1),
        "mode_coordinate": np.where(none, "", np.array(model.dofs, dtype=object)[main]),
    }
    return found | (_vectors(model, values, right) if with_vectors else {})


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


def _least_stable(model: LinearModel, values: Array) -> dict[str, Array]:
    """Growth of the batch's points, damping and frequency of the mode damped least, from eigenvalues (..., states).

    A root at zero within its error does not count, and the growth of one that is neutral is zero.
    """
    error = error_near_zero(model, values)
    size = np.abs(values)
    counts = size > error
    with np.errstate(all="ignore"):
        ratio = np.where(counts, -values.real / size, np.inf)
    place = ratio.argmin(axis=-1)[..., None]
    failed = np.isnan(values).all(axis=-1)
    growth = np.where(counts, np.where(np.abs(values.real) <= error, 0.0, values.real), -np.inf).max(axis=-1)
    return {
        "growth_rate": np.where(failed, np.nan, growth),
        "damping_ratio": np.where(failed, np.nan, np.take_along_axis(ratio, place, -1)[..., 0]),
        "frequency": np.where(failed, np.nan, np.abs(np.take_along_axis(values.imag, place, -1)[..., 0])),
    }
