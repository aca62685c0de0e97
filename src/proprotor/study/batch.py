"""The analysis of one batch of designs, in the process of a study or in one of its worker processes.

A design that is not physical, or a point that cannot be analysed, has NaN and the reason in its places. The results of
all other points are the same with and without such a design or point in the batch.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from proprotor.case import Case
from proprotor.errors import InputError
from proprotor.files.source_code import check_code
from proprotor.model.batches import as_grid, keep_memory
from proprotor.model.first_order import in_one_axis, missing_roots
from proprotor.model.linear_model import LinearModel
from proprotor.stability.kinds import flies_free
from proprotor.stability.modes import eigenvalues, few_spectra
from proprotor.study.backend import check_backend
from proprotor.study.designs import AIRSPEED
from proprotor.study.flutter_speeds import put_flutter_speeds
from proprotor.study.followed_modes import doubted, modes_along, walk
from proprotor.study.roots import least_stable, ordered, vectors
from proprotor.study.variables import POINT, VARIABLE, VARIABLES, blank
from proprotor.typing import Array

_TOLERANCE = 1e-5  # m/s, on a flutter speed
_BAD_INPUT = (InputError, np.linalg.LinAlgError)


@dataclass(frozen=True)
class Batch:
    """A block of designs at a block of airspeeds.

    Parameters
    ----------
    inputs : mapping of array (designs,)
        SI, by deck path; airspeed is among the inputs where it varies with the design.
    airspeed : array (speeds,) or None
        m/s, for every design.
    """

    inputs: Mapping[str, Array]
    airspeed: Array | None

    def some(self, rows: Any, columns: Any = slice(None)) -> Batch:
        """Return some of the designs, at some of the airspeeds."""
        speeds = None if self.airspeed is None else self.airspeed[columns]
        return Batch({name: values[rows] for name, values in self.inputs.items()}, speeds)

    @property
    def shape(self) -> tuple[int, int]:
        """Number of designs and of airspeeds."""
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
    """The analysis of a batch: the same for all batches of a study, and sent to each worker once.

    Parameters
    ----------
    case : Case
    quantities : tuple of str
        The quantities to find, of `proprotor.study.variables.QUANTITIES`.
    options : mapping
        Options of `Case.linearize`.
    dofs : tuple of str
        Coordinates of the model.
    states : int
        Number of eigenvalues of the model.
    tolerance : float
        Tolerance of a flutter speed, m/s.
    code : str
        Fingerprint of the code with which a process must analyse; empty if any code may.
    """

    case: Case
    quantities: tuple[str, ...]
    options: Mapping[str, Any] = field(default_factory=dict)
    dofs: tuple[str, ...] = ()
    states: int = 0
    tolerance: float = _TOLERANCE
    code: str = ""

    def __call__(self, batch: Batch) -> dict[str, Array]:
        """Return all variables of a batch: (designs, speeds, …) if points have them, (designs, …) if designs have them.

        Raises
        ------
        InputError
            When this process runs other code than `code`, or has no compiled functions for a study that has them.
        """
        if self.code:
            check_code(self.code)
        check_backend(self.options)
        keep_memory()
        found = blank(self.quantities, batch.shape, self.states, len(self.dofs))
        if "flutter" in self.quantities:
            self._find_flutter(found, batch)
        if self.quantities != ("flutter",):
            self._find_at_points(found, batch)
        return found

    def _find_flutter(self, found: dict[str, Array], batch: Batch) -> None:
        refused = self._refusals(batch)
        found["reason"][:], found["flutter_note"][:] = refused[:, None], refused

        def models(rows: Array, speeds: Array) -> LinearModel:
            numbers, along = as_grid(
                {name: values[rows, 0] for name, values in batch.numbers.items()}, speeds
            )
            return in_one_axis(self._varied(numbers).linearize(along, **self.options))

        if len(rows := np.flatnonzero(refused == "")):
            put_flutter_speeds(found, batch, rows, models, self.states, self.tolerance, flies_free(self.case))

    def _find_at_points(self, found: dict[str, Array], batch: Batch) -> None:
        rows, columns = (np.arange(size) for size in batch.shape)
        if self._put(found, batch, rows, columns):
            refused = self._refusals(batch)
            found["reason"][:] = refused[:, None]
            self._put_parts(found, batch, np.flatnonzero(refused == ""), columns)

    def _refusals(self, batch: Batch) -> Array:
        """Return the reason for which the case refuses each design; empty for a design that it takes.

        A group of designs that is refused is halved until each refused design stands alone.
        """
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
                    reasons[rows] = self._reason(batch.some(rows), error)
        return reasons

    def _reason(self, single: Batch, error: Exception) -> str:
        """Return a refusal on one line, with plain numbers of the design in place of arrays."""
        try:
            self.case.vary({name: float(values[0, 0]) for name, values in single.numbers.items()})
        except InputError as plain:
            error = plain
        return " ".join(str(error).split("\n"))

    def _put(self, found: dict[str, Array], batch: Batch, rows: Array, columns: Array) -> Exception | None:
        """Put the variables of some designs and airspeeds in their places, or return the error of their analysis."""
        try:
            points = self._points(batch.some(rows, columns))
        except _BAD_INPUT as error:
            return error
        for name in found.keys() & points.keys():
            if points[name].shape == found[name].shape:  # of the whole batch
                found[name] = points[name]
            else:
                found[name][np.ix_(rows, columns) if VARIABLE[name].on == POINT else rows] = points[name]
        return None

    def _put_parts(self, found: dict[str, Array], batch: Batch, rows: Array, columns: Array) -> None:
        """Analyse designs and airspeeds at once; if that fails, halve them until each bad design or point is alone."""
        if not len(rows) or not len(columns) or not (error := self._put(found, batch, rows, columns)):
            return
        if len(rows) > 1:
            for half in np.array_split(rows, 2):
                self._put_parts(found, batch, half, columns)
            return
        errors = [self._put(found, batch, rows, columns[[place]]) for place in range(len(columns))]
        bad = np.array([one is not None for one in errors])
        if not bad.any():
            raise error
        for column, one in zip(columns, errors, strict=True):
            if one:
                found["reason"][rows, column] = self._reason(batch.some(rows, [column]), one)
        self._put_parts(found, batch, rows, columns[~bad])

    def _varied(self, numbers: Mapping[str, Array]) -> Case:
        return self.case.vary(numbers) if numbers else self.case

    def _points(self, batch: Batch) -> dict[str, Array]:
        """Return variables of the points of a batch: at least the variables of the chosen quantities."""
        shape = np.broadcast_shapes(np.shape(batch.speeds), (batch.shape[0], 1))
        model = self._varied(batch.numbers).linearize(np.broadcast_to(batch.speeds, shape), **self.options)
        of_trim = ("reason", "warning", *VARIABLES["trim"])
        found: dict[str, Array] = {name: getattr(model.trim, name) for name in of_trim}
        found["missing"] = missing_roots(model, self.states)
        found |= self._roots(model)
        if "modes" in self.quantities:
            found["warning"] = doubted(found["warning"], found["mode_quality"])
        found = {name: self._with_all_states(name, array) for name, array in found.items()}
        if "least_stable" in self.quantities:
            found |= least_stable(model, found["eigenvalue"])
        return found

    def _roots(self, model: LinearModel) -> dict[str, Array]:
        """Return the eigenvalues, and the variables of vectors and modes if they are among the quantities."""
        if not {"modes", "vectors"} & set(self.quantities):
            needed = {"eigenvalue", "least_stable"} & set(self.quantities)
            return {"eigenvalue": ordered(eigenvalues(model))} if needed else {}
        shape, found, walks = model.M.shape[:-2], defaultdict(list), []
        for some, spectrum in few_spectra(model):
            found["eigenvalue"].append(ordered(spectrum.values))
            if "vectors" in self.quantities:
                found["vector"].append(vectors(some, spectrum))
            if "modes" in self.quantities:
                walks.append(walk(some, spectrum))
        joined = {name: np.concatenate(parts) for name, parts in found.items()}
        return joined | (modes_along(walks, shape[1], model.dofs) if walks else {})

    def _with_all_states(self, name: str, found: Array) -> Array:
        """Return an array (…, states) with all states of the study: NaN or "" for states that the batch has not."""
        more = self.states - found.shape[-1]
        if VARIABLE[name].dims[-1:] != ("state",) or not more:
            return found
        missing: Any = "" if found.dtype == object else np.nan
        return np.pad(found, [*[(0, 0)] * (found.ndim - 1), (0, more)], constant_values=missing)
