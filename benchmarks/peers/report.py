"""The page benchmarks/peers.md from the measurements."""

from __future__ import annotations

import importlib.metadata
import platform
from collections.abc import Sequence
from pathlib import Path
from typing import Any

Result = dict[str, Any]
BATCHES = ("1", "100", "10000")
KANE_COORDINATES = {
    "kane-2": "flap, lag",
    "kane-4": "flap, lag, pitch, azimuth",
    "kane-5": "hub displacement, flap, lag",
    "kane-6": "flap, lag, pitch, azimuth, gimbal",
    "kane-8": "hub displacement and turn, flap, lag",
    "kane-12": "all",
}
EVALUATED = {
    "generated": "generated",
    "lambdify-cse": "`lambdify(cse=True)`",
    "lambdify-plain": "`lambdify(cse=False)`",
    "jax-positions": "JAX, slopes of positions",
    "jax-Lagrangian": "JAX, Lagrangian",
}


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [head, ["---"] + ["---:"] * (len(head) - 1), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def number(value: float, digits: int = 3) -> str:
    """Rounded to some digits, thousands parted."""
    if value >= 10 ** (digits - 1):
        rounded = round(value, digits - len(str(int(value))))
        return f"{rounded:,.0f}"
    return f"{value:.{digits}g}"


def processor() -> str:
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor()


def machine() -> str:
    versions = [f"{name} {importlib.metadata.version(name)}" for name in ("numpy", "sympy", "jax")]
    return f"{processor()}, one core; Python {platform.python_version()}, {', '.join(versions)}"


def report(found: dict[str, Result]) -> str:
    """Text of the page."""
    largest = [name for name in KANE_COORDINATES if "stopped" not in found[name]][-1]
    runtime = found["generated"]["runtime"]
    return TEXT.format(
        machine=machine(),
        largest=KANE_COORDINATES[largest],
        kane_operations=number(found[largest]["operations"]),
        kane_seconds=number(_kane_total(found[largest])),
        kane_code=number(found[largest]["code"]["operations"]),
        whole_kane=_whole_kane(found["kane-12"]),
        some=number(found["regeneration"]["without airloads"]),
        every=number(found["regeneration"]["all"]),
        kane_1=number(found[largest]["microseconds"]["1"]),
        kane_10000=number(found[largest]["microseconds"]["10000"]),
        cse_operations=number(found["lambdify-cse"]["code"]["operations"]),
        blade_bytes=number(found["generated"]["blade code"]["bytes"]),
        blade_operations=number(found["generated"]["blade code"]["operations"]),
        rotor_bytes=number(found["generated"]["code"]["bytes"]),
        rotor_operations=number(found["generated"]["code"]["operations"]),
        kane=kane_table(found),
        evaluation=evaluation_table(found),
        ratios=ratio_table(found),
        setup=setup_table(found),
        remarks=remarks(found),
        runtime_100=number(runtime["100"]),
        runtime_10000=number(runtime["10000"]),
        share=number(100 * found["generated"]["microseconds"]["10000"] / runtime["10000"], 2),
    )


def _kane_total(result: Result) -> float:
    return sum(seconds for name, seconds in result["seconds"].items() if name != "lambdify")


def _whole_kane(result: Result) -> str:
    if "stopped" in result:
        used = result["stopped"]
        return (
            f"All twelve coordinates were stopped unfinished after {used} s (the limit is 900 s, or by hand)."
        )
    return f"With all twelve coordinates it took {number(_kane_total(result))} s."


def _worst(result: Result) -> str:
    return f"{max(result['disagreement'].values()):.0e}"


def kane_table(found: dict[str, Result]) -> str:
    head = ["coordinates of the blade", "equations, s", "linearised, s", "operations before cse"]
    head += ["bytes of entries", "operations after cse", "bytes after cse", "differs from generated"]
    rows = []
    for name, coordinates in KANE_COORDINATES.items():
        result = found[name]
        if "stopped" in result:
            rows.append([coordinates, f"stopped at {result['stopped']} s", *[""] * 6])
            continue
        seconds = result["seconds"]
        rows.append(
            [
                coordinates,
                number(seconds["model"] + seconds["equations of motion"]),
                number(seconds["linearised"]),
                number(result["operations"]),
                number(result["plain bytes"]),
                number(result["code"]["operations"]),
                number(result["code"]["bytes"]),
                _worst(result),
            ]
        )
    return table(head, rows)


def evaluation_table(found: dict[str, Result]) -> str:
    rows = [
        [
            label,
            *(number(found[name]["microseconds"][batch]) for batch in BATCHES),
            number(found[name]["memory"]),
            _worst(found[name]) if "disagreement" in found[name] else "-",
        ]
        for name, label in EVALUATED.items()
    ]
    head = ["μs a point at a batch of", "1", "100", "10,000", "memory beyond the start, MB", "differs"]
    return table(head, rows)


def ratio_table(found: dict[str, Result]) -> str:
    own = found["generated"]["microseconds"]
    rows = [
        [label, *(number(found[name]["microseconds"][batch] / own[batch]) for batch in BATCHES)]
        for name, label in EVALUATED.items()
        if name != "generated"
    ]
    return table(["time in those of the generated equations", "1", "100", "10,000"], rows)


def setup_table(found: dict[str, Result]) -> str:
    rows = []
    for name, label in EVALUATED.items():
        result = found[name]
        code = result.get("code", {})
        rows.append(
            [
                label,
                number(result["lambdify"]) if "lambdify" in result else "-",
                *(number(result["first call"][batch]) for batch in BATCHES),
                *(number(code[part]) if part in code else "-" for part in ("operations", "bytes")),
            ]
        )
    head = [
        "",
        "`lambdify`, s",
        "first call at 1, s",
        "at 100, s",
        "at 10,000, s",
        "operations",
        "bytes of code",
    ]
    return table(head, rows)


def remarks(found: dict[str, Result]) -> str:
    """What the figures say, the peers' better sides first."""
    own = found["generated"]["microseconds"]
    lines = []
    for name, label in EVALUATED.items():
        if name == "generated":
            continue
        theirs = found[name]["microseconds"]
        faster = [f"{own[b] / theirs[b]:.1f} times at {int(b):,}" for b in BATCHES if theirs[b] < own[b]]
        slower = [f"{theirs[b] / own[b]:.1f} times at {int(b):,}" for b in BATCHES if theirs[b] >= own[b]]
        said = [f"faster {', '.join(faster)}"] * bool(faster) + [f"slower {', '.join(slower)}"] * bool(slower)
        lines.append(f"- {label}: {'; '.join(said)}.")
    return "\n".join(lines)


TEXT = """# The generated equations beside their peers

    python -m pip install --group peers
    python -m benchmarks.peers.run

One run each, every measurement in a process of its own.
{machine}.
Times are processor time, since the machine is shared; the shortest of
five rounds, or of two calls where one takes more than two seconds.

The rotor is that of the equations without airloads: flap, lag, pitch, gimbal, azimuth and six hub motions,
hinge springs that turn with the pitch, propeller moment, dampers; three blades. Matrices are M, C and K about
a given trim. "Differs" is the greatest difference from the generated matrices over a hundred random rotors,
relative to the entry or to Ω^k √(M_ii M_jj) if that is larger.

## Derivation: Kane's method of `sympy.physics.mechanics`

One blade in axes that turn at the rotor speed, as in `derive/`: the twelve coordinates that make the eighteen
of the rotor. The blade is three thin rods, inboard of the flap hinge, between the hinges and outboard of the
lag hinge, each with a symbolic mass, centre and inertia; any mass distribution along the line has such rods.
So this is the same rotor, not a simpler one. The lumped pitch inertia is a body of its own that turns by the
pitch relative to the shaft, springs and dampers are torques. Reduced rotors hold the coordinates that are not
named.

{kane}

Deriving and emitting the same rotor here, all twelve coordinates and the sum over the blades, with dimensions
checked and the text formatted, and with what more those modules hold: **{some} s**.
Everything, airloads, trim and the published set too: {every} s.
The emitted functions of the blade hold {blade_operations} operations in {blade_bytes} bytes; with the sum
over the blades {rotor_operations} in {rotor_bytes}. Docstrings and comments do not count on either side. The
largest rotor that Kane's method finished ({largest}) took {kane_seconds} s and holds {kane_operations}
operations, {kane_code} of them left after `cse`. {whole_kane}

Two things to know about this peer:

- `KanesMethod.linearize` (SymPy 1.14) counts forces that depend on neither speeds nor accelerations twice, so
  that every centrifugal stiffness in a frame of prescribed rotation is doubled: a bead on a turning arm comes
  out with k − 2mw² in place of k − mw² (`benchmarks.peers.kane_rotor.bead_stiffness`). The comparison takes
  the surplus out of the linearizer before it is used; without that the stiffness differs and with it all
  agrees.
- The hub rows of Kane's blade are generalised forces of body-axis angles, those here moment resultants. A
  blade has a steady moment about the hub, so the two differ blade by blade; the sum over the blades has none,
  and there they agree. That is where they are compared, the sum formed by numbers
  (`benchmarks/peers/blade_sum.py`).

Kane's method asks for less: frames and bodies in, equations out, and constraints or another joint cost a
line. What is gained here comes from knowing that only positions of a line need differentiating and that the
mass enters by a few integrals.

## Evaluation: `lambdify` and JAX

All start from the blade's numbers (mass integrals, offsets, springs, trim angles) and return M, C and K, 18 x
18 each.

- *generated*: the readable functions of `proprotor_equations`, called by the names of quantities.
- *lambdify*: the derivation's own expressions without temporaries, one function for all three matrices. Each
  nonzero entry is a returned value that is put into place, so that batches work.
- *JAX*: the nonlinear rotor written from its geometry (`benchmarks/peers/jax_rotor.py`), 64 bit.
  *Lagrangian*: d/dt ∂L/∂q' − ∂L/∂q by `jvp` of `grad`, matrices by `jacfwd`. *Slopes of positions*: a hand
  has put in that M, C and K follow from the slopes of positions, by `jacfwd`, `jvp` and `hessian`. `jit`, and
  `vmap` for batches. One thread.

{evaluation}

{ratios}

{setup}

A first call of JAX compiles, for each size of a batch; of the others it is the first call, nothing more.

{remarks}

What the figures do not show:

- `lambdify(cse=True)` sees the zeros of the blade through the sum over the blades, shares subexpressions across
  M, C and K, and writes each entry once: {cse_operations} operations against {rotor_operations}. The generated
  functions fill seven arrays of a blade, add them, and fill three of the rotor, entry by entry, so that each
  matrix can be read, tested and replaced by itself, with a name and an equation number beside every entry.
- The model takes the fused functions beside the readable ones, `proprotor_equations.fused`: 342 operations from the
  springs to M, C, K and B. `python -m benchmarks.fused`, interleaved rounds of one run, gives their time in that of
  `lambdify(cse=True)`: 0.51 at 1, 1.00 at 100, 0.61 at 10,000 (numpy 2.4.6, OpenBLAS 0.3.31 Haswell). So `lambdify` is
  as fast as the fused functions at 100, where calls of NumPy and the filling of the matrices are the cost of both.
- What it is worth: the whole of `rotor_model` for the XV-15, trim and airloads included, takes {runtime_100} μs a
  point at a batch of 100 and {runtime_10000} μs at 10,000; the matrices of this page are {share} % of the latter.
- `lambdify` starts from the derivation of this project. From Kane's equations, with `cse=True`, one blade of the
  largest rotor that finished ({largest}) takes {kane_1} μs at 1 and {kane_10000} μs at 10,000, before any sum over
  the blades.
- The memory of JAX grows with the batch; in pieces it would need less.
- JAX needs no derivation, has derivatives with any input to machine precision without a complex step, and
  runs on other hardware; none of this is measured here. Its agreement is also a check: nothing but the
  geometry and the mass integrals is shared.
- Airloads, trim and eigenvalues are not in these times.
"""
