"""A study: many designs at many airspeeds, on all cores or a cluster, in batches that are kept as they are finished."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any
from warnings import warn

import numpy as np

from proprotor.case import Case
from proprotor.files.source_code import code_fingerprint
from proprotor.study import workers as study_workers
from proprotor.study.backend import backend_of
from proprotor.study.checkpoint import Checkpoint
from proprotor.study.designs import Plan
from proprotor.study.division import Block, blocks_of, check_needs, points_at_once
from proprotor.study.progress import Progress, Shown, shown_progress
from proprotor.study.request import Request, requested
from proprotor.study.study_file import repeated
from proprotor.study.variables import DEFAULT_QUANTITIES, POINT, VARIABLE, blank
from proprotor.typing import Array, Dataset

if TYPE_CHECKING:
    from distributed import Client

_SMALL = 4000  # points that are analysed before worker processes have started


def study(
    case: Case | Dataset | str | os.PathLike[str],
    inputs: Plan | Mapping[str, Any] | Dataset | str | os.PathLike[str] | None = None,
    airspeed: Any = None,
    quantities: str | Sequence[str] = DEFAULT_QUANTITIES,
    *,
    workers: int | None = None,
    client: Client | None = None,
    checkpoint: str | os.PathLike[str] | None = None,
    progress: Shown = None,
    batch: int | None = None,
    tolerance: float | None = None,
    **options: Any,
) -> Dataset:
    """Return the stability and trim of many designs.

    ``study(file)`` and ``study(results)`` repeat a study, from a file (`proprotor.save_study`) or from its results;
    ``study(case, file)`` repeats a study of a case that was not loaded from a deck.

    Parameters
    ----------
    case : Case; or xarray.Dataset or path, to repeat a study
    inputs : mapping or plan; or xarray.Dataset or path, to repeat a study
        How inputs vary, by deck path (`proprotor.design_inputs`): a mapping of lists is a grid of all combinations;
        lists point by point, Latin hypercube, Sobol and Saltelli samples are plans of `proprotor.sampling`. Values are
        in SI, pint quantities or text with a unit. ``"airspeed"`` may be among the inputs.
    airspeed : float or array in m/s, text such as "100:300:20kt", pint quantity or xarray.DataArray
        For every design; not where it is among the inputs.
    quantities : str or sequence of str
        "eigenvalue", "least_stable", "trim" (the default three); "flutter", the lowest airspeed of the range at
        which each design loses stability; "vectors", mode shapes; "modes", eigenvalues followed along the airspeeds.
        See `proprotor.study.variables.VARIABLES`.
    workers : int, optional
        Processes, by default one for each core, and none for a small study; 1 is this process alone.
    client : distributed.Client, optional
        A cluster that analyses the batches in place of this computer.
    checkpoint : path, optional
        A folder that keeps each finished batch. The same call goes on where a killed one was, with the same results
        to the last bit, as long as the code is the same. With ``backend="auto"`` the backend that began the study
        goes on with it.
    progress : bool or callable, optional
        A progress bar; by default on a terminal (the error stream) and in a notebook. A callable is called with the
        numbers of points that are done, of all points, and of points that failed.
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
        For an unknown input, quantity or option, a value with a wrong unit, a checkpoint of another study, of other
        code or of another backend, a cluster that runs other code, or results, batches or workers that do not fit into
        memory; for a study to repeat that was not written out, or whose deck has changed.
    """
    given = {"airspeed": airspeed, "tolerance": tolerance} | options
    given |= {} if quantities is DEFAULT_QUANTITIES else {"quantities": quantities}
    again = repeated(case, inputs, given)
    if again is not None:
        run: dict[str, Any] = {"workers": workers, "client": client, "checkpoint": checkpoint}
        return study(**again, **run, progress=progress, batch=batch)
    assert isinstance(case, Case)
    # Results that are kept, or come from other computers, must all be of one code.
    code = "" if checkpoint is None and client is None else code_fingerprint()
    with ExitStack() as held:
        told = held.enter_context(shown_progress(progress))
        kept = None if checkpoint is None else Checkpoint(checkpoint)
        backend = backend_of(case, options, kept)
        request = requested(case, inputs, airspeed, quantities, tolerance, options, code, backend)
        check_needs(request, batch, workers, client)
        division = {"points": batch or points_at_once(request, workers, client)}
        if kept:
            division = held.enter_context(kept.open(request.identity, division))
        request = request.with_coordinates()
        blocks = blocks_of(request, int(division["points"]))
        return request.dataset(_found(request, blocks, kept, workers, client, told))


def _found(
    request: Request,
    blocks: list[Block],
    kept: Checkpoint | None,
    workers: int | None,
    client: Client | None,
    progress: Progress,
) -> dict[str, Array]:
    """Return the variables of all designs, from batches that were kept and batches that are analysed now."""
    analysis = request.analysis
    found = blank(analysis.quantities, request.shape, analysis.states, len(analysis.dofs))
    todo = dict(enumerate(blocks))
    for number, results in kept.finished(len(blocks)) if kept else ():
        _put(found, todo.pop(number), results)
    remaining = sum(map(_points_in, todo.values()))
    points = int(np.prod(request.shape))
    progress.begin(points, points - remaining)
    if not todo:
        return found
    for number, results in _analysed(request, todo, remaining, workers, client):
        if kept:
            kept.save(number, results)
        _put(found, blocks[number], results)
        progress.advance(_points_in(blocks[number]), int(np.count_nonzero(results["reason"] != "")))
    return found


def _put(found: dict[str, Array], block: Block, results: Mapping[str, Array]) -> None:
    """Put the results of a batch in their places."""
    for name, array in found.items():
        array[block if VARIABLE[name].on == POINT else block[0]] = results[name]


def _points_in(block: Block) -> int:
    rows, columns = block
    return int((rows.stop - rows.start) * (columns.stop - columns.start))


def _analysed(
    request: Request, todo: Mapping[int, Block], points: int, workers: int | None, client: Client | None
) -> study_workers.Found:
    """Return the results of batches as they come: from this process, from worker processes or from a cluster."""
    analysis = request.analysis
    batches = ((number, request.batch(block)) for number, block in todo.items())
    if client is not None:
        return study_workers.on_cluster(analysis, batches, client)
    if workers is None:
        small = points <= _SMALL and not study_workers.idle_workers()
        workers = 1 if small else study_workers.cores()
    workers = min(workers, len(todo))
    if workers > 1:
        try:
            study_workers.check_loadable(analysis)
            return study_workers.Processes(analysis, batches, workers).results()
        except study_workers.NotLoadable as error:
            reason = f"because others cannot load the case: {error}"
            warn(f"one process analyses the study, {reason}", stacklevel=4)
    return study_workers.here(analysis, batches)
