"""Who analyses the batches of a study: this process, processes of this computer, or a dask.distributed cluster.

Each of the three is a generator that takes numbered batches and yields pairs (number, variables), in no particular
order, and never holds more than a few batches.

Processes and not threads, because most of the time beside LAPACK is spent in short NumPy calls that hold the
interpreter. Compiled functions leave it to others, but it is held for more than a third of the time that points take
then, and for three quarters of the time of flutter speeds (`python -m benchmarks.study` measures it). Each process has
one BLAS thread, because matrices of this size gain nothing from more, and threads that share one BLAS wait for each
other.
"""

from __future__ import annotations

import atexit
import errno
import logging
import os
import subprocess
import sys
from collections.abc import Iterable, Iterator
from contextlib import suppress
from itertools import islice
from queue import SimpleQueue
from threading import Lock, Thread
from typing import TYPE_CHECKING, Any

from proprotor.study.worker import main, receive, send

if TYPE_CHECKING:
    from distributed import Client

    from proprotor.study.batch import Analysis, Batch

Numbered = Iterable[tuple[int, "Batch"]]
Found = Iterator[tuple[int, dict[str, Any]]]

_ONE_THREAD = (
    "OPENBLAS_NUM_THREADS",
    "OMP_NUM_THREADS",
    "MKL_NUM_THREADS",
    "BLIS_NUM_THREADS",
    "VECLIB_MAXIMUM_THREADS",
)
_log = logging.getLogger(__name__)
_GONE = (errno.EPIPE, errno.EINVAL)  # a pipe whose reader has ended; Windows says the latter, too
_MOST_DEATHS = 3  # of workers at one batch: then the batch kills them
_AHEAD = 2  # batches per worker of a cluster, so that no worker waits for its next batch


class NotLoadable(Exception):
    """The analysis of a study cannot be loaded in another process."""


def cores() -> int:
    """Return the number of processor cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def here(analysis: Analysis, batches: Numbered) -> Found:
    """Analyse batches one after another in this process."""
    for number, batch in batches:
        yield number, analysis(batch)


# Processes ----------------------------------------------------------------------------------------


class Worker:
    """One process, kept from study to study, because starting a process takes longer than a small study."""

    def __init__(self) -> None:
        environment = os.environ | dict.fromkeys(_ONE_THREAD, "1")
        path = [entry or os.getcwd() for entry in sys.path if isinstance(entry, str)]
        # Not by PYTHONPATH, because a folder may have the separator of paths in its name.
        code = f"import sys; sys.path[:] = {path!r}; from {main.__module__} import main; main()"
        command = [sys.executable, "-c", code]
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(command, env=environment, stdin=pipe, stdout=pipe)
        assert self.process.stdin is not None and self.process.stdout is not None  # pipes
        self.questions, self.answers = self.process.stdin, self.process.stdout

    def ask(self, message: Any) -> Any:
        """Return the answer to a message.

        Raises
        ------
        EOFError
            When the process has died.
        """
        try:
            send(self.questions, message)
            answer = receive(self.answers)
        except OSError as error:
            if error.errno not in _GONE:
                raise
            raise EOFError from None
        if isinstance(answer, Exception):
            raise answer
        return answer

    @property
    def lives(self) -> bool:
        """Whether the process is running."""
        return self.process.poll() is None

    def end(self) -> None:
        """End the process at once."""
        self.process.kill()
        self.process.wait()
        for pipe in (self.questions, self.answers):
            with suppress(OSError):  # a message that was not sent any more
                pipe.close()


_idle: list[Worker] = []
_lock = Lock()


def idle_workers() -> int:
    """Return the number of workers that wait for a study."""
    with _lock:
        return sum(worker.lives for worker in _idle)


def _take() -> Worker:
    with _lock:
        while _idle:
            worker = _idle.pop()
            if worker.lives:
                return worker
            worker.end()
    return Worker()


def _give_back(worker: Worker) -> None:
    with _lock:
        _idle.append(worker)


@atexit.register
def end_workers() -> None:
    """End the processes that wait for a study."""
    with _lock:
        while _idle:
            _idle.pop().end()


def check_loadable(analysis: Analysis) -> None:
    """Check that a worker process can load an analysis.

    Raises
    ------
    NotLoadable
        When the case holds an object that exists in this process only, such as a function of a script.
    """
    worker = _take()
    try:
        worker.ask(analysis)
    except EOFError:
        worker.end()
        raise RuntimeError("a worker process of the study died as it started") from None
    except Exception as error:
        worker.end()
        raise NotLoadable(str(error)) from error
    _give_back(worker)


class Processes:
    """Several processes that analyse batches, with a thread for each process.

    The thread hands over batches and waits for the answers. The batch of a process that dies goes to another process.
    """

    def __init__(self, analysis: Analysis, batches: Numbered, workers: int) -> None:
        self.analysis, self.batches, self.workers = analysis, iter(batches), workers
        self.lock, self.stopped = Lock(), False
        self.found: SimpleQueue[Any] = SimpleQueue()
        self.at_work: list[Worker] = []

    def results(self) -> Found:
        """Yield the results of all batches.

        Raises
        ------
        RuntimeError
            When one batch has killed three workers.
        """
        threads = [Thread(target=self._serve, daemon=True) for _ in range(self.workers)]
        for thread in threads:
            thread.start()
        running = len(threads)
        try:
            while running:
                item = self.found.get()
                if item is None:
                    running -= 1
                elif isinstance(item, BaseException):
                    raise item
                else:
                    yield item
        finally:
            self.stopped = True
            if running:  # ended before all was done: nobody waits for the batches still at work
                with self.lock:
                    for worker in self.at_work:
                        worker.process.kill()
            for thread in threads:
                thread.join()

    def _next(self) -> tuple[int, Batch] | None:
        with self.lock:
            return None if self.stopped else next(self.batches, None)

    def _serve(self) -> None:
        worker = None
        try:
            while (numbered := self._next()) is not None:
                number, batch = numbered
                for death in range(1, _MOST_DEATHS + 1):
                    try:
                        worker = worker or self._begin()
                        self.found.put((number, worker.ask(batch)))
                        break
                    except EOFError:
                        if worker is not None:
                            self._release(worker)
                        worker = None
                        if self.stopped:
                            return
                        _log.warning(
                            "batch %d has ended its worker process, %d of %d times",
                            number,
                            death,
                            _MOST_DEATHS,
                        )
                        if death == _MOST_DEATHS:
                            deaths = f"batch {number} of the study has killed {death} worker processes"
                            raise RuntimeError(f"{deaths}; is memory short?") from None
        except BaseException as error:
            self.found.put(error)
        finally:
            if worker is not None:
                self._release(worker, keep=worker.lives and not self.stopped)
            self.found.put(None)

    def _begin(self) -> Worker:
        worker = _take()
        with self.lock:
            self.at_work.append(worker)
        try:
            worker.ask(self.analysis)
        except BaseException:
            self._release(worker)
            raise
        return worker

    def _release(self, worker: Worker, keep: bool = False) -> None:
        """Take a worker off the study: keep it for the next study, or end it."""
        with self.lock:
            self.at_work.remove(worker)
        _give_back(worker) if keep else worker.end()


# A cluster ----------------------------------------------------------------------------------------


def on_cluster(analysis: Analysis, batches: Numbered, client: Client) -> Found:
    """Analyse batches on a `dask.distributed` cluster, which gives the batches of a lost worker to another worker.

    At most two batches a thread of the cluster are under way, so that neither side holds many results.
    """
    from distributed import as_completed

    sent = client.scatter(analysis, broadcast=True, hash=False)
    todo = iter(batches)

    def submit(numbered: tuple[int, Batch]) -> Any:
        return client.submit(_numbered, sent, *numbered, pure=False)

    under_way = as_completed([submit(numbered) for numbered in islice(todo, _AHEAD * threads_of(client))])
    try:
        for future in under_way:
            yield future.result()
            future.release()
            for numbered in islice(todo, 1):
                under_way.add(submit(numbered))
    finally:
        client.cancel(list(under_way.futures))


def threads_of(client: Client) -> int:
    """Return the number of batches that a cluster analyses at once."""
    return max(1, int(sum(client.nthreads().values())))


def _numbered(analysis: Analysis, number: int, batch: Batch) -> tuple[int, dict[str, Any]]:
    return number, analysis(batch)
