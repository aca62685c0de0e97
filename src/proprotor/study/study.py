"""Many designs at many airspeeds, on all cores or a cluster, in batches that are kept as they are finished."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any
from warnings import warn

import numpy as np
from numpy.typing import ArrayLike
from proprotor_equations import FIXED_COORDINATES

from proprotor.errors import InputError, unknown_name
from proprotor.files.fingerprint import fingerprint
from proprotor.files.source_code import code_fingerprint
from proprotor.model import stamp
from proprotor.needs import check_memory, free_memory
from proprotor.rotor.motions import HUB, ROTOR_SPEED
from proprotor.rotor.options import parse_options
from proprotor.study import workers as study_workers
from proprotor.study.batch import (
    ALONG_AIRSPEEDS,
    DEFAULT_QUANTITIES,
    POINT,
    QUANTITIES,
    Analysis,
    Batch,
    empty,
    variables,
)
from proprotor.study.checkpoint import Checkpoint
from proprotor.study.progress import progress_bar
from proprotor.study.sampling import AIRSPEED, Designs, Plan, as_plan
from proprotor.typing import Array
from proprotor.units import in_metres_per_second

if TYPE_CHECKING:
    import xarray
    from distributed import Client

    from proprotor.case import Case

BATCH = 2000  # points at most: enough for NumPy's own cost to vanish beside LAPACK's
_BYTES_PER_POINT = 100_000  # while a batch is analysed; the XV-15 takes 30 kB, 46 kB with vectors
_BYTES_PER_WORKER = 150e6  # of a process with NumPy, SciPy and a case
_SHARE_OF_MEMORY = 0.25  # of what is free, for the batches of all processes together
_SMALL = 4000  # points that are analysed before worker processes have started
_SHAFT = "drive_train.shaft_stiffness"
_MOST_TRIED = 25  # airspeeds, to see the coordinates of the model


def study(
    case: Case,
    inputs: Plan | Mapping[str, Any],
    airspeed: Any = None,
    quantities: str | Sequence[str] = DEFAULT_QUANTITIES,
    *,
    workers: int | None = None,
    client: Client | None = None,
    checkpoint: str | os.PathLike[str] | None = None,
    progress: bool | None = None,
    batch: int | None = None,
    tolerance: float | None = None,
    **options: Any,
) -> xarray.Dataset:
    """Stability and trim of many designs.

    Parameters
    ----------
    case : Case
    inputs : mapping or plan
        What varies, by deck path (`proprotor.design_inputs`): a mapping of lists is a grid of all combinations; lists
        point by point, Latin hypercube, Sobol and Saltelli samples are plans of `proprotor.study.sampling`. Values are in SI,
        pint quantities or text with a unit. ``"airspeed"`` may be among them.
    airspeed : float or array in m/s, text such as "100:300:20kt", pint quantity or xarray.DataArray
        For every design; not where it is among the inputs.
    quantities : str or sequence of str
        "eigenvalue", "least_stable", "trim" (these three by default); "flutter", the lowest airspeed of the range at
        which each design loses stability; "vectors", mode shapes; "modes", eigenvalues followed along the airspeeds.
        See `proprotor.study.batch.VARIABLES`.
    workers : int, optional
        Processes, by default one for each core, and none for a small study; 1 is this process alone.
    client : distributed.Client, optional
        A cluster that analyses the batches in place of this computer.
    checkpoint : path, optional
        A folder that keeps each finished batch. The same call goes on where a killed one was, with the same results
        to the last bit, as long as the code is the same.
    progress : bool, optional
        A progress bar on the error stream; by default on a terminal.
    batch : int, optional
        Points analysed at once, by default as many as memory allows up to 2000.
    tolerance : float, optional
        On a flutter speed, m/s; 1e-5 by default.
    **options
        See `proprotor.rotor.options.Options`.

    Returns
    -------
    xarray.Dataset
        Dimensions are the inputs of a grid, or ``design``, then ``airspeed``. Inputs are coordinates. Failed points are
        NaN, with the ``reason``. `proprotor.save_results` writes it.

    Raises
    ------
    InputError
        For an unknown input, quantity or option, a value with a wrong unit, a checkpoint of another study or of other
        code, a cluster that runs other code, or results, batches or workers that do not fit into memory.
    """
    # What is kept, or comes from other computers, must all be of one code.
    code = "" if checkpoint is None and client is None else code_fingerprint()
    work = _Study.of(case, inputs, airspeed, quantities, tolerance, options, code)
    if batch is not None and (not isinstance(batch, int) or batch < 1):
        raise InputError("batch", batch, "must be a whole number above zero")
    if workers is not None and (not isinstance(workers, int) or workers < 1):
        raise InputError("workers", workers, "must be a whole number above zero")
    _check_needs(work, batch, workers, client)
    division = {"points": batch or _points_at_once(work, workers, client)}
    with ExitStack() as held:
        kept = None
        if checkpoint is not None:
            kept = Checkpoint(checkpoint)
            division = held.enter_context(kept.open(work.identity, division))
        work = work.with_coordinates()
        _run(work, work.blocks(int(division["points"])), kept, workers, client, progress)
    return work.dataset()


@dataclass(frozen=True, eq=False)
class _Study:
    """A study, and the arrays that its results are put into as they come."""

    analysis: Analysis
    designs: Designs
    airspeed: Array | None  # None where it is among the inputs
    scalar_airspeed: bool
    found: dict[str, Array] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        case: Case,
        inputs: Any,
        airspeed: Any,
        quantities: Any,
        tolerance: Any,
        options: Mapping[str, Any],
        code: str,
    ) -> _Study:
        quantities = _known_quantities(quantities)
        parse_options(case.model_options(options))
        plan = as_plan(inputs)
        from proprotor.deck.vary import design_inputs

        deck = design_inputs(case) if set(plan.inputs) - {AIRSPEED} else {}
        designs = plan.resolve(deck)
        own = AIRSPEED in plan.inputs
        if own == (airspeed is not None):
            raise InputError(AIRSPEED, airspeed, "must be given, either for all designs or among the inputs")
        speeds = None if own else in_metres_per_second(airspeed)
        if speeds is not None and (speeds.ndim > 1 or not speeds.size):
            raise InputError(
                AIRSPEED, f"array of shape {speeds.shape}", "must be a speed or a list of speeds"
            )
        if set(ALONG_AIRSPEEDS) & set(quantities):
            _check_range(speeds, next(name for name in ALONG_AIRSPEEDS if name in quantities))
        analysis = Analysis(case, quantities, options, code=code)
        if tolerance is not None:
            analysis = replace(analysis, tolerance=_positive("tolerance", tolerance))
        line = None if speeds is None else np.atleast_1d(speeds)
        return cls(analysis, designs, line, speeds is not None and not speeds.ndim)

    @property
    def shape(self) -> tuple[int, int]:
        """Designs and airspeeds."""
        return len(self.designs), 1 if self.airspeed is None else len(self.airspeed)

    @property
    def identity(self) -> dict[str, str]:
        """Fingerprints of all that the results depend on."""
        from importlib.metadata import version

        analysis = self.analysis
        parts = {
            "case": analysis.case,
            "inputs": [self.designs.values, self.designs.axes],
            "airspeeds": self.airspeed,
            "quantities": analysis.quantities,
            "options": dict(analysis.options),
            "tolerance": analysis.tolerance,
            "code": analysis.code,
            "versions": [
                version(package) for package in ("proprotor", "numpy", "scipy", "pystran", "fluids")
            ],
        }
        return {name: fingerprint(part, name) for name, part in parts.items()}

    def blocks(self, points: int) -> list[tuple[slice, slice]]:
        """Designs and airspeeds of each batch."""
        designs, speeds = self.shape
        if speeds > points and not set(ALONG_AIRSPEEDS) & set(self.analysis.quantities):
            columns = _slices(speeds, points)
        else:
            columns = [slice(0, speeds)]
        width = columns[0].stop
        return [(rows, some) for rows in _slices(designs, max(1, points // width)) for some in columns]

    def batch(self, block: tuple[slice, slice]) -> Batch:
        rows, columns = block
        speeds = None if self.airspeed is None else self.airspeed[columns]
        return Batch({name: values[rows] for name, values in self.designs.values.items()}, speeds)

    def with_coordinates(self) -> _Study:
        """The same study with the coordinates of the model, for which a point is analysed."""
        it = self.analysis
        tried = self.designs.values[AIRSPEED] if self.airspeed is None else self.airspeed
        dofs = _coordinates(it.case, tried, it.options)
        held = _a_shaft_holds(it.case, self.designs, it.options)
        states = 2 * len(dofs) - (ROTOR_SPEED in dofs and not held)
        return replace(self, analysis=replace(it, dofs=dofs, states=states))

    @property
    def size(self) -> float:
        """Bytes of all results at most, before the coordinates are known."""
        dofs = _most_coordinates(self.analysis.case, self.analysis.options)
        sizes = {"state": 2 * dofs, "dof": dofs}
        return float(
            sum(
                math.prod(self.shape if it.on == POINT else self.shape[:1])
                * math.prod(sizes[dim] for dim in it.dims)
                * empty(it, ()).itemsize
                for it in variables(self.analysis.quantities).values()
            )
        )

    def allocate(self) -> None:
        """Arrays for all results, once."""
        sizes = {"state": self.analysis.states, "dof": len(self.analysis.dofs)}
        for name, it in variables(self.analysis.quantities).items():
            leading = self.shape if it.on == POINT else self.shape[:1]
            self.found[name] = empty(it, (*leading, *(sizes[dim] for dim in it.dims)))

    def put(self, block: tuple[slice, slice], results: Mapping[str, Array]) -> int:
        """Put the results of a batch into their place; how many points failed."""
        rows, columns = block
        for name, it in variables(self.analysis.quantities).items():
            self.found[name][(rows, columns) if it.on == POINT else rows] = results[name]
        return int(np.count_nonzero(results["reason"] != ""))

    def dataset(self) -> xarray.Dataset:
        """The results over the inputs and airspeeds."""
        import xarray  # here, because it takes long to import

        axes, shape = tuple(self.designs.axes), self.designs.shape
        over_speeds = self.airspeed is not None and not self.scalar_airspeed
        data = {}
        for name, it in variables(self.analysis.quantities).items():
            array = self.found[name]
            if name == "missing" and not (array != "").any():
                continue
            if it.on == POINT:
                array = array.reshape(*shape, *self.shape[1:] * over_speeds, *array.shape[2:])
            else:
                array = array.reshape(*shape, *array.shape[1:])
            dims = (*axes, *[AIRSPEED] * (over_speeds and it.on == POINT), *it.dims)
            attributes = {"long_name": it.meaning} | ({"units": it.units} if it.units else {})
            data[name] = (dims, array, attributes)
        coordinates: dict[str, Any] = dict(self.designs.coordinates)
        if self.airspeed is not None:
            speeds = self.airspeed if over_speeds else self.airspeed[0]
            coordinates[AIRSPEED] = ((AIRSPEED,) * over_speeds, speeds, {"units": "m/s"})
        if "vectors" in self.analysis.quantities:
            coordinates["dof"] = list(self.analysis.dofs)
        return xarray.Dataset(data, coords=coordinates, attrs=self._attributes())

    def _attributes(self) -> dict[str, str]:
        return stamp.of_case(self.analysis.case, self.analysis.options) | self.designs.attributes


def _run(
    work: _Study,
    blocks: list[tuple[slice, slice]],
    kept: Checkpoint | None,
    workers: int | None,
    client: Client | None,
    progress: bool | None,
) -> None:
    work.allocate()
    todo = dict(enumerate(blocks))
    points = {number: (b[0].stop - b[0].start) * (b[1].stop - b[1].start) for number, b in todo.items()}
    done = 0
    for number, results in kept.finished(len(blocks)) if kept else ():
        work.put(todo.pop(number), results)
        done += points[number]
    if not todo:
        return
    batches = ((number, work.batch(block)) for number, block in todo.items())
    remaining = int(np.prod(work.shape)) - done
    with progress_bar(int(np.prod(work.shape)), done, progress) as advance:
        for number, results in _analysed(work.analysis, batches, len(todo), remaining, workers, client):
            if kept:
                kept.save(number, results)
            failed = work.put(blocks[number], results)
            advance(points[number], failed)


def _analysed(
    analysis: Analysis,
    batches: Iterator[tuple[int, Batch]],
    count: int,
    points: int,
    workers: int | None,
    client: Client | None,
) -> study_workers.Found:
    """Results of the batches, from whoever is to analyse them."""
    if client is not None:
        return study_workers.on_cluster(analysis, batches, client)
    if workers is None:
        small = points <= _SMALL and not study_workers.idle_workers()
        workers = 1 if small else study_workers.cores()
    workers = min(workers, count)
    if workers == 1:
        return study_workers.here(analysis, batches)
    try:
        study_workers.check_loadable(analysis)
    except study_workers.NotLoadable as error:
        warn(f"one process analyses the study, because others cannot load the case: {error}", stacklevel=4)
        return study_workers.here(analysis, batches)
    return study_workers.in_processes(analysis, batches, workers)


def _slices(size: int, width: int) -> list[slice]:
    return [slice(start, min(start + width, size)) for start in range(0, size, width)]


def _check_needs(work: _Study, batch: int | None, workers: int | None, client: Client | None) -> None:
    """Refuse results, batches and workers that do not fit into memory."""
    designs, speeds = work.shape
    told = f"{designs} designs at {speeds} airspeeds"
    check_memory("inputs", told, work.size, "the results", "take fewer, or fewer quantities")
    if client is not None:  # whose computers have memory of their own
        return
    at_once = min(batch or 1, designs * speeds)
    processes = min(workers or 1, -(-designs * speeds // at_once))
    if processes > 1:
        check_memory("workers", workers, _BYTES_PER_WORKER * processes, f"{processes} processes")
    check_memory("batch", batch, _BYTES_PER_POINT * at_once * processes, "the batches of all workers")


def _points_at_once(work: _Study, workers: int | None, client: Client | None) -> int:
    """Points of a batch, so that the batches of all workers fit into memory and come out even."""
    workers = workers or study_workers.cores()
    most = BATCH
    if client is not None:
        workers = study_workers.threads_of(client)
    else:
        most = int(np.clip(_SHARE_OF_MEMORY * free_memory() / workers / _BYTES_PER_POINT, 50, BATCH))
    points = int(np.prod(work.shape))
    rounds = -(-points // (most * workers))
    return -(-points // (rounds * workers))


def _known_quantities(quantities: str | Sequence[str]) -> tuple[str, ...]:
    chosen = (quantities,) if isinstance(quantities, str) else tuple(quantities)
    for name in chosen:
        if name not in QUANTITIES:
            raise InputError("quantities", name, unknown_name(str(name), QUANTITIES, "quantity"))
    if not chosen:
        raise InputError("quantities", None, f"must be of {', '.join(QUANTITIES)}")
    return tuple(name for name in QUANTITIES if name in chosen)


def _check_range(speeds: Array | None, quantity: str) -> None:
    if speeds is None or speeds.ndim != 1 or speeds.size < 2 or not np.all(np.diff(speeds) > 0):
        told = "among the inputs" if speeds is None else np.array2string(speeds, threshold=4)
        raise InputError(AIRSPEED, told, f'must be a range of increasing speeds for quantities="{quantity}"')


def _positive(name: str, value: ArrayLike) -> float:
    if not isinstance(value, int | float) or not value > 0:
        raise InputError(name, value, "must be a number above zero")
    return float(value)


def _a_shaft_holds(case: Case, designs: Designs, options: Mapping[str, Any]) -> bool:
    """Whether a shaft holds the azimuth of any design, which then has one eigenvalue more than others."""
    train = case.model_options(options).get("drive_train")
    stiffness = 0.0 if train is None else train.shaft_stiffness
    if "drive_train" not in options:
        stiffness = designs.values.get(_SHAFT, stiffness)
    return bool(np.any(np.nan_to_num(stiffness) > 0))


def _most_coordinates(case: Case, options: Mapping[str, Any]) -> int:
    """Coordinates of a model of the case with everything free."""
    blades = 3 * (int(np.max(case.rotor.n_blades)) - 3) if options.get("reactionless") else 0
    return len(case.support.names) + len(FIXED_COORDINATES) - len(HUB) + blades


def _coordinates(case: Case, speeds: Array, options: Mapping[str, Any]) -> tuple[str, ...]:
    """Coordinates of the case's model."""
    few = speeds[np.unique(np.linspace(0, len(speeds) - 1, _MOST_TRIED).astype(int))]
    few = np.roll(few, -(len(few) // 2))  # the middle is the likeliest to have a trim
    for tried in (few[:1], few):
        model = case.linearize(tried, **options)
        if model.trim.converged.any():
            break
    if model.M.shape[:-2] != tried.shape:
        raise InputError(
            "options", ", ".join(options), "must not hold arrays: vary the case's inputs instead"
        )
    return model.dofs
