"""The campaign: many inputs in several processes, or one input again.

python -m tests.fuzz --inputs 100000
python -m tests.fuzz --kind deck --number 1234 --keep folder
"""

from __future__ import annotations

import argparse
import faulthandler
import json
import os
import resource
import subprocess
import sys
import time
import traceback
from collections import Counter
from pathlib import Path

from tests.fuzz.campaign import KINDS, Verdict, campaign, inputs, make

ROOT = Path(__file__).resolve().parents[2]
_MEMORY = 4 << 30  # bytes a process may have
_HANG = 300  # seconds of the clock without a verdict after which a process is ended: what holds on to the interpreter
_CHUNK = 2500  # inputs of one process, which the next then follows: what crashes costs no more than these
_FIRST = 3  # of the same fault are shown


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__.splitlines()[0])
    parser.add_argument("--inputs", type=int, default=100_000, help="how many (100000)")
    parser.add_argument("--seed", type=int, default=0, help="of all inputs (0)")
    parser.add_argument("--processes", type=int, default=os.cpu_count(), help="as many as there are cores")
    parser.add_argument("--kind", choices=KINDS, help="of one input")
    parser.add_argument("--number", type=int, help="of one input")
    parser.add_argument("--keep", type=Path, help="folder for the files of one input")
    parser.add_argument("--share", help=argparse.SUPPRESS)  # of a process: begin:end
    given = parser.parse_args(arguments)
    if given.share:
        return _share(given)
    if given.kind is not None:
        return _one(given)
    return _all(given)


def _one(given: argparse.Namespace) -> int:
    """One input again, with its files kept and its verdict told."""
    files, how = make(given.kind, given.number, given.seed)
    if given.keep:
        given.keep.mkdir(parents=True, exist_ok=True)
        for name, content in files.items():
            (given.keep / name).write_bytes(content)
    (found,) = campaign(given.seed, [(given.kind, given.number)])
    print(f"{found.kind} {found.number}, used with {how}: {found.outcome}\n{found.told}")
    return int(found.outcome not in ("accepted", "refused"))


def _share(given: argparse.Namespace) -> int:
    """Some inputs in this process; a line of JSON for each verdict."""
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    begin, end = map(int, given.share.split(":"))
    which = list(inputs(given.inputs))[begin:end]
    faulthandler.dump_traceback_later(2 * _HANG, exit=True)  # the warm-up imports much
    for verdict in campaign(given.seed, which):
        faulthandler.dump_traceback_later(_HANG, exit=True)
        print(json.dumps(verdict), flush=True)
    return 0


def _all(given: argparse.Namespace) -> int:
    """All inputs, a chunk after another in each process, and what came of them."""
    which = list(inputs(given.inputs))
    starts = iter(range(0, len(which), _CHUNK))
    begun = time.perf_counter()
    counts: Counter[tuple[str, str]] = Counter()
    faults: list[Verdict] = []
    running: dict[int, subprocess.Popen] = {}
    while True:
        while len(running) < given.processes and (start := next(starts, None)) is not None:
            running[start] = _process(given, start)
        if not running:
            break
        start = next(iter(running))
        found = _verdicts(running.pop(start), which[start : start + _CHUNK])
        counts.update((verdict.kind, verdict.outcome) for verdict in found)
        faults += [verdict for verdict in found if verdict.outcome not in ("accepted", "refused")]
        done, passed = sum(counts.values()), time.perf_counter() - begun
        print(f"{done:>7} inputs, {len(faults)} faults, {passed:.0f} s", file=sys.stderr, flush=True)
    _tell(counts, faults, given.seed, time.perf_counter() - begun)
    return int(bool(faults))


def _process(given: argparse.Namespace, start: int) -> subprocess.Popen:
    share = ["--share", f"{start}:{start + _CHUNK}", "--inputs", str(given.inputs), "--seed", str(given.seed)]
    one_thread = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL")}
    return subprocess.Popen(
        [sys.executable, "-m", "tests.fuzz", *share],
        cwd=ROOT,
        env=os.environ | one_thread,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def _verdicts(process: subprocess.Popen, which: list[tuple[str, int]]) -> list[Verdict]:
    """What a process found; the input at which it ended, if it did, has the fault of that."""
    out, told = process.communicate()
    found = [Verdict(*json.loads(line)) for line in out.splitlines() if line.startswith("[")]
    if len(found) < len(which):
        kind, number = which[len(found)]
        left = len(which) - len(found) - 1
        told = f"{told[-2000:]}\nthe process ended with code {process.returncode}; {left} inputs after it were not used"
        found.append(Verdict(kind, number, "crash", told))
    return found


def _tell(counts: Counter[tuple[str, str]], faults: list[Verdict], seed: int, seconds: float) -> None:
    """The faults by their last line, then how many inputs of each kind were accepted and refused."""
    alike: dict[str, list[Verdict]] = {}
    for fault in faults:
        alike.setdefault(f"{fault.outcome}: {fault.told.strip().splitlines()[-1][:100]}", []).append(fault)
    for told, those in sorted(alike.items(), key=lambda entry: -len(entry[1])):
        print(f"\n{len(those)} x {told}\n{those[0].told.rstrip()}")
        for fault in those[:_FIRST]:
            print(
                f"again: python -m tests.fuzz --seed {seed} --kind {fault.kind} --number {fault.number} --keep folder"
            )
    outcomes = sorted({outcome for _, outcome in counts})
    print(f"\n{'':<12}" + "".join(f"{outcome:>12}" for outcome in outcomes))
    for kind in KINDS:
        print(f"{kind:<12}" + "".join(f"{counts[kind, outcome]:>12}" for outcome in outcomes))
    print(f"{sum(counts.values())} inputs in {seconds:.0f} s, {len(faults)} faults")


if __name__ == "__main__":
    try:
        sys.exit(main())
    except BrokenPipeError:
        traceback.print_exc()
        sys.exit(1)
