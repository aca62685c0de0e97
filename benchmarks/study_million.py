"""A million flutter speeds on two cores: time, memory, and a SIGKILL half-way that changes nothing.

    python -m benchmarks.study_million [designs] [--backend auto]

The study of flutter speeds, each with the least damping of its range, runs once without interruption. It then runs
again in a process of its own that is killed once half of its batches are kept, its workers with it or left to find out,
and is called once more until it ends. Both results are compared bit by bit. The last line is a row for the table in
`docs/studies.md`.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import xarray as xr
from rich.console import Console

import proprotor as pp
from benchmarks.study import INPUTS, SPEEDS
from benchmarks.study_100k import MB, modified, most_of_a_worker
from proprotor import sampling
from proprotor.study.workers import end_workers

DESIGNS = 1_000_000
WORKERS = 2


def run(designs: int, backend: str, folder: str) -> None:
    """Run the study with a checkpoint; print its time, the most memory of it and of a worker, and its bits."""
    inputs = {name: limits for name, limits in INPUTS.items() if name != "airspeed"}
    plan = sampling.latin_hypercube(inputs, designs, seed=1)
    start = time.perf_counter()
    found = pp.study(
        pp.load_case("xv15-uncoupled"),
        plan,
        SPEEDS,
        "flutter",
        workers=WORKERS,
        checkpoint=folder,
        progress=False,
        backend=backend,
    )
    analysed = time.perf_counter() - start
    largest_worker = most_of_a_worker()
    end_workers()  # their processor time is told once they have ended
    own, workers = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    size = sum(variable.nbytes for variable in found.variables.values()) / 1024**2
    print(
        f"{analysed:.1f}",
        f"{workers.ru_utime + workers.ru_stime:.1f}",
        f"{size:.0f}",
        f"{own.ru_maxrss * MB:.0f}",
        f"{largest_worker:.0f}",
        int((found.flutter_note != "").sum()),
        bits(found),
        flush=True,
    )


def bits(found: xr.Dataset) -> str:
    """Return a digest of all numbers and texts of a result."""
    digest = hashlib.sha256()
    for name in sorted(map(str, found.variables)):
        values = found[name].values
        digest.update(name.encode())
        digest.update(values if values.dtype.kind in "fic" else "\0".join(values.ravel().tolist()).encode())
    return digest.hexdigest()


def started(designs: int, backend: str, folder: Path) -> subprocess.Popen:
    """Start the study in a process of its own."""
    asked = [str(designs), "--backend", backend, "--into", str(folder)]
    command = [sys.executable, "-m", "benchmarks.study_million", *asked]
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True, encoding="utf-8")


def killed_half_way(process: subprocess.Popen, folder: Path, batches: int) -> dict[str, int]:
    """Kill a study once half of its batches are kept, and return when each of these was written."""
    while process.poll() is None and len(modified(folder)) < batches / 2:
        time.sleep(0.05)
    process.send_signal(signal.SIGKILL)
    process.communicate()
    return modified(folder)


def compare(designs: int, backend: str, console: Console, place: Path) -> None:
    """Run, kill and go on with the study, and print what it took and whether anything differs."""
    whole, killed = place / "whole", place / "killed"
    *told, digest = started(designs, backend, whole).communicate()[0].split()
    analysed, of_workers, size, own, largest_worker, noted = map(float, told)
    batches = len(modified(whole))
    console.print(
        f"{designs} designs at {SPEEDS.size} airspeeds in {analysed:.1f} s, {of_workers:.1f} s of {WORKERS} workers' "
        f"processors; {noted:.0f} without a flutter speed in the range; results {size:.0f} MB; most memory: this "
        f"process {own:.0f} MB, a worker {largest_worker:.0f} MB"
    )
    kept = killed_half_way(started(designs, backend, killed), killed, batches)
    console.print(f"killed with {len(kept)} of {batches} batches kept")
    again, *_, other = started(designs, backend, killed).communicate()[0].split()
    untouched = kept.items() <= modified(killed).items()
    console.print(
        f"gone on with in {again} s; no batch computed twice: {untouched}; every bit the same: {other == digest}"
    )
    megabytes = sum(os.path.getsize(path) for path in whole.iterdir()) / 1024**2
    console.print(f"checkpoint {megabytes:.0f} MB")
    if not (other == digest and untouched and 0 < len(kept) < batches):
        sys.exit("the study that was killed differs, or was not killed half-way")
    each = f"{1e3 * of_workers / designs:.2f} ms | {analysed:.0f} s | {own:.0f} MB | {largest_worker:.0f} MB"
    console.print(
        f'| {designs:,} flutter speeds, `backend="{backend}"` | {each} | {size:.0f} MB | {megabytes:.0f} MB |'
    )


def main() -> None:
    """Print all of it."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("designs", type=int, nargs="?", default=DESIGNS)
    parser.add_argument("--backend", choices=("auto", "compiled", "numpy"), default="auto")
    parser.add_argument("--into", metavar="FOLDER", help="run the study alone, with its batches in a folder")
    given = parser.parse_args()
    if given.into:
        run(given.designs, given.backend, given.into)
        return
    with tempfile.TemporaryDirectory() as place:
        compare(
            given.designs, given.backend, Console(width=140, highlight=False, soft_wrap=True), Path(place)
        )


if __name__ == "__main__":
    main()
