"""All peers on this machine, one after another, each in a process of its own; writes benchmarks/peers.md.

    python -m pip install --group peers
    python -m benchmarks.peers.run            # everything, about half an hour of processor time
    python -m benchmarks.peers.run generated  # one measurement again; the others are kept in build/peers
    python -m benchmarks.peers.run page       # the page alone, from what is kept

A measurement that passes the limit of processor time is stopped and reported as such.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

from benchmarks.peers.report import report

LIMIT = 900  # processor seconds of one measurement
RESULTS, PAGE = Path("build/peers"), Path("benchmarks/peers.md")
HUB = ("hub_i", "hub_j", "hub_k", "turn_i", "turn_j", "turn_k")
GIMBAL = ("azimuth", "gimbal_flap", "gimbal_roll")
MEASUREMENTS: dict[str, tuple[str, ...]] = {
    "regeneration": ("regeneration",),
    "generated": ("generated",),
    "fused": ("fused",),
    "lambdify-cse": ("lambdify", "cse"),
    "lambdify-plain": ("lambdify", "plain"),
    "jax-Lagrangian": ("jax", "Lagrangian"),
    "jax-positions": ("jax", "positions"),
    "kane-2": ("kane", "flap", "lag"),
    "kane-4": ("kane", "flap", "lag", "pitch", "azimuth"),
    "kane-5": ("kane", *HUB[:3], "flap", "lag"),
    "kane-6": ("kane", "flap", "lag", "pitch", *GIMBAL),
    "kane-8": ("kane", *HUB, "flap", "lag"),
    "kane-12": ("kane",),
}
_ONE_THREAD = {
    "OPENBLAS_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
    "XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false",
    "JAX_PLATFORMS": "cpu",
}


def measure(name: str) -> dict:
    """The result of one measurement, or `stopped` with the limit."""
    command = [sys.executable, "-m", "benchmarks.peers.measure", *MEASUREMENTS[name]]
    cores = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {max(cores)})  # the child's only core
    child = subprocess.Popen(
        command, stdout=subprocess.PIPE, text=True, encoding="utf-8", env=os.environ | _ONE_THREAD
    )
    os.sched_setaffinity(0, cores)
    used = 0.0
    while child.poll() is None:
        used = processor_seconds(child.pid)
        if used > LIMIT:
            child.terminate()
            child.wait()
        time.sleep(1)
    if child.returncode == -signal.SIGTERM:  # here, or by hand
        return {"stopped": round(used)}
    if child.returncode:
        raise SystemExit(f"{name} failed")
    return json.loads(child.stdout.read())


def processor_seconds(process: int) -> float:
    """Time a process has had; a limit set by the kernel would coarsen the clock that the process itself reads."""
    fields = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main(names: list[str]) -> None:
    RESULTS.mkdir(parents=True, exist_ok=True)
    for name in [name for name in names or MEASUREMENTS if name != "page"]:
        print(name, flush=True)
        (RESULTS / f"{name}.json").write_text(json.dumps(measure(name), indent=1), encoding="utf-8")
    found = {
        name: json.loads(path.read_text(encoding="utf-8"))
        for name in MEASUREMENTS
        if (path := RESULTS / f"{name}.json").exists()
    }
    if missing := sorted(set(MEASUREMENTS) - set(found)):
        print(f"{PAGE} is not written: {', '.join(missing)} not measured")
        return
    PAGE.write_text(report(found), encoding="utf-8")
    print(PAGE)


if __name__ == "__main__":
    main(sys.argv[1:])
