"""A hundred thousand designs on two cores: time, memory, and a SIGKILL that changes nothing.

    python -m benchmarks.study_100k [designs]

The study runs once without interruption. It then runs again in a process of its own that is killed at a random moment,
its workers with it or left to find out, and is called once more until it ends. Both results are compared bit by bit.
"""

from __future__ import annotations

import hashlib
import os
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import xarray as xr
from rich.console import Console

import proprotor as pp
from benchmarks.study import plan

DESIGNS = 100_000
MB = 1 / 1024  # of the kilobytes in which Linux tells memory


def most_of_a_worker() -> float:
    """Return the most memory of the living processes that this process started, MB.

    What `getrusage` tells of ended children counts the memory of this process too: they began as copies of it.
    """
    most = 0
    for status in Path("/proc").glob("[0-9]*/status"):
        try:
            told = dict(line.split(":", 1) for line in status.read_text(encoding="utf-8").splitlines())
        except OSError:  # it has ended
            continue
        if int(told["PPid"]) == os.getpid() and "VmHWM" in told:
            most = max(most, int(told["VmHWM"].split()[0]))
    return most * MB


def run(designs: int, folder: str, result: str) -> None:
    """The study with a checkpoint, into a file; prints time and the largest memory of it and of a worker."""
    start = time.perf_counter()
    found = pp.study(
        pp.load_case("xv15-uncoupled"), plan(designs), workers=2, checkpoint=folder, progress=False
    )
    analysed = time.perf_counter() - start
    pp.save_results(found, result)
    saved = time.perf_counter() - start - analysed
    own = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * MB
    failed = int((found.reason != "").sum())
    size = sum(variable.nbytes for variable in found.variables.values()) / 1024**2
    print(
        f"analysed in {analysed:.1f} s, saved in {saved:.1f} s; {failed} failed; results {size:.0f} MB; "
        f"largest memory: this process {own:.0f} MB, a worker {most_of_a_worker():.0f} MB",
        flush=True,
    )


def started(designs: int, folder: Path, result: Path) -> subprocess.Popen:
    """The study in a process of its own."""
    command = [sys.executable, "-m", "benchmarks.study_100k", str(designs), str(folder), str(result)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True, encoding="utf-8")


def bits(found: xr.Dataset) -> str:
    """A digest of all numbers and texts of a result."""
    digest = hashlib.sha256()
    for name in sorted(map(str, found.variables)):
        values = found[name].values
        digest.update(name.encode())
        digest.update(
            values.tobytes() if values.dtype.kind in "fic" else "\0".join(values.astype(str).flat).encode()
        )
    return digest.hexdigest()


def modified(folder: Path) -> dict[str, int]:
    """When each batch was written."""
    return {path.name: path.stat().st_mtime_ns for path in folder.glob("batch-*")}


def main() -> None:
    """Print all of it."""
    if len(sys.argv) == 4:
        run(int(sys.argv[1]), *sys.argv[2:])
        return
    designs = int(sys.argv[1]) if len(sys.argv) > 1 else DESIGNS
    console = Console(width=110, highlight=False, soft_wrap=True)
    with tempfile.TemporaryDirectory() as name:
        place = Path(name)
        begin = time.perf_counter()
        whole = started(designs, place / "whole", place / "whole.nc")
        console.print(f"{designs} designs: {whole.communicate()[0].strip()}")
        took = time.perf_counter() - begin
        moment = random.uniform(0.2, 0.8) * took
        killed = started(designs, place / "killed", place / "killed.nc")
        time.sleep(moment)
        killed.send_signal(signal.SIGKILL)
        killed.communicate()
        kept = modified(place / "killed")
        console.print(
            f"killed after {moment:.1f} s with {len(kept)} of {len(modified(place / 'whole'))} batches kept"
        )
        again = started(designs, place / "killed", place / "killed.nc")
        console.print(f"gone on: {again.communicate()[0].strip()}")
        untouched = kept.items() <= modified(place / "killed").items()
        same = bits(pp.load_results(place / "whole.nc")) == bits(pp.load_results(place / "killed.nc"))
        console.print(f"no batch computed twice: {untouched}; every bit as without interruption: {same}")
        megabytes = sum(os.path.getsize(path) for path in (place / "whole").iterdir()) / 1024**2
        console.print(
            f"checkpoint {megabytes:.0f} MB, file {os.path.getsize(place / 'whole.nc') / 1024**2:.0f} MB"
        )
        if not (same and untouched):
            sys.exit("the study that was killed differs")
        values = pp.load_results(place / "whole.nc").eigenvalue.values
        console.print(f"largest real part of all {np.nanmax(values.real):.3g} 1/s")


if __name__ == "__main__":
    main()
