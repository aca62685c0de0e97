"""One input after another: made from a seed and a number, used, judged."""

from __future__ import annotations

import contextlib
import functools
import importlib
import os
import shutil
import tempfile
import traceback
import warnings
from collections.abc import Iterator
from pathlib import Path
from random import Random
from typing import NamedTuple

import click
from rich.cells import cell_len

from proprotor import InputError
from tests.fuzz import airfoils, decks, nastran, structures, supports
from tests.fuzz.watch import Breach, TooSlow, watched

KINDS = {"deck": decks, "support": supports, "structure": structures, "airfoil": airfoils, "nastran": nastran}
SHARES = {"deck": 0.25, "support": 0.15, "structure": 0.2, "airfoil": 0.2, "nastran": 0.2}
_OUTPUT = "out"
_WARM_UP = (
    150  # inputs of each kind before the watch: modules are imported, units are read, caches are filled
)

_IMPORTED_LATE = (
    "scipy.sparse.linalg",
    "dask.array",
    "distributed",
    *(f"encodings.utf_{width}_{order}" for width in (16, 32) for order in ("le", "be")),
)  # by functions that a warm-up may not meet


class Verdict(NamedTuple):
    """What became of an input: accepted, refused, or a fault of the program with what there is to tell."""

    kind: str
    number: int
    outcome: str
    told: str = ""


def inputs(count: int) -> Iterator[tuple[str, int]]:
    """The kinds and numbers of a campaign of so many."""
    for kind, share in SHARES.items():
        for number in range(round(share * count)):
            yield kind, number


def make(kind: str, number: int, seed: int) -> tuple[dict[str, bytes], dict]:
    """The files of an input, and how they are used; the same in every process."""
    return KINDS[kind].make(Random(f"{seed} {kind} {number}"))


def judged(kind: str, number: int, seed: int, folder: Path) -> Verdict:
    """Write the files of an input to a folder of their own, use them under watch, and judge."""
    files, how = make(kind, number, seed)
    _write(files, folder)
    before = Path.cwd()
    os.chdir(folder)  # whatever an input might write would be seen beside it
    try:
        with warnings.catch_warnings(), watched(folder / _OUTPUT) as breaches:
            warnings.simplefilter("error")
            outcome, told = _used(kind, folder, how)
    finally:
        os.chdir(before)
    if breaches:
        outcome, told = "breach", "\n".join(breaches)
    elif changed := _changed(files, folder):
        outcome, told = "breach", f"files changed: {changed}"
    return Verdict(kind, number, outcome, told)


def _used(kind: str, folder: Path, how: dict) -> tuple[str, str]:
    try:
        KINDS[kind].use(folder, **how)
    except (InputError, click.ClickException) as refusal:
        told = str(refusal) if isinstance(refusal, InputError) else refusal.message
        good = told and all(": " in line and line.isprintable() for line in told.split("\n"))
        return ("refused", "") if good else ("bad message", repr(told))
    except TooSlow:
        return "too slow", traceback.format_exc(limit=-6)
    except (Exception, Breach):
        return "fault", traceback.format_exc(limit=-8)
    return "accepted", ""


def _write(files: dict[str, bytes], folder: Path) -> None:
    (folder / _OUTPUT).mkdir()
    for name, content in files.items():
        (folder / name).write_bytes(content)


def _changed(files: dict[str, bytes], folder: Path) -> list[str]:
    """Files that are new, gone or not what they were, outside the output folder."""
    left = {path.name for path in folder.iterdir()} - {_OUTPUT}
    rewritten = {name for name in left & set(files) if (folder / name).read_bytes() != files[name]}
    return sorted(left ^ set(files) | rewritten)


@contextlib.contextmanager
def _workshop() -> Iterator[Path]:
    """A folder to use again and again, in memory where there is such a place."""
    memory = Path("/dev/shm")
    place = memory if memory.is_dir() and os.access(memory, os.W_OK) else None
    with tempfile.TemporaryDirectory(prefix="fuzz-", dir=place) as folder:
        yield Path(folder)


def campaign(seed: int, which: list[tuple[str, int]]) -> Iterator[Verdict]:
    """The verdicts of some inputs."""
    warm_up(seed)
    with _workshop() as workshop:
        for count, (kind, number) in enumerate(which):
            folder = workshop / str(count)
            folder.mkdir()
            yield judged(kind, number, seed, folder)
            shutil.rmtree(folder)


@functools.cache
def warm_up(seed: int) -> None:
    """Use some other inputs first, so that what a process does once only is done before the watch."""
    for module in _IMPORTED_LATE:
        with contextlib.suppress(ImportError):
            importlib.import_module(module)
    cell_len("😀")  # loads a table of widths
    with _workshop() as workshop:
        for kind in KINDS:
            for number in range(_WARM_UP):
                files, how = make(kind, number, -1 - seed)
                if kind == "deck":
                    how |= {"linearized": True, "swept": number % 10 == 0}
                folder = workshop / f"{kind}{number}"
                folder.mkdir()
                _write(files, folder)
                with warnings.catch_warnings(), contextlib.suppress(Exception):
                    warnings.simplefilter("error")
                    KINDS[kind].use(folder, **how)
                shutil.rmtree(folder)
