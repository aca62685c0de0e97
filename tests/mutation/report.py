"""The outcomes of a survey as a page."""

from __future__ import annotations

import math
from collections.abc import Iterable

from tests.mutation.survey import Outcome

_HEAD = """# Mutation of the equations

Written by `make mutate`. One at a time, every value of every generated function and every term of every sum in it has
its sign flipped, is left out, or is multiplied by 1.01. Each such mutant takes the place of the function in memory, and
the checks of `tests/mutation/`, which `make test` runs on the equations as they are, either see it or do not.

Every entry is held to 1e-10 of itself, and where it is a small difference of large terms to 1e-13 of those. What it is
held to comes from elsewhere:

| equations | compared with |
|---|---|
| inertia | accelerations of point masses on one blade of the nonlinear rotor, by complex steps; integrals as sums |
| springs, pitch, couplings | energies of the same |
| section | lift, drag and moment along the air, by complex steps, of an airfoil with every derivative at work |
| airloads | positions, velocities and virtual work of the same blade; its matrices in rotating axes, before any sum |
| lift slope | quadrature |
| trim | steady loads on the same blade, at a state that nothing balances, and their derivatives |
| multiblade | sums over 3 to 8 blades, as numbers, of blade matrices at random: no zeros, no symmetry |
| drive train | energies of engine and shaft |
| coordinates | components along a blade's axes, and waves, as numbers |
| beam | strain of Hermite cubics and masses beside the axis, as sums over Gauss points |
| blade element | curvature, slope and displacement of Hermite cubics at a station; tension as a sum |
| moving | points, axes and pitch of a blade with tilted yoke, by complex steps and differences; energies of springs |
| rotor | one blade of the nonlinear rotor in the air, and sums over 3 to 5 such blades, as numbers |
| fused | the same rotors, blades and sections; tests/derive/test_fused.py has the readable functions |
| published | the same nonlinear rotor without what `derive/published.py` says the paper leaves out, stated once more |

Inputs come from the same sources, with one exception: the arrays of a segment that the airloads are products of (its
motions, virtual motions and load derivatives) are seen by the products, and while one is a mutant the others are as
generated.

That the published equations are the paper's is not asked here: `docs/audit.md` compares them with the print. How the
engine uses the functions is not asked either: the oracle tests of whole models do that.
"""


def report(outcomes: list[Outcome], seconds: float, processes: int) -> str:
    """Markdown: what was found, by module, the slowest, the ones nearest to being missed, and the survivors."""
    survivors = [outcome for outcome in outcomes if not outcome.detected]
    slowest = max(outcomes, key=lambda outcome: outcome.seconds)
    found = f"{len(outcomes)} mutants, {len(outcomes) - len(survivors)} detected, {len(survivors)} survivors"
    total = f"**{found}**, in {seconds:.0f} s on {processes} processes."
    nearest = min((o for o in outcomes if o.detected), key=lambda outcome: outcome.excess)
    lines = [
        _HEAD,
        total,
        "",
        *_table(outcomes),
        "",
        "The margin is the least difference that any detected mutant of the module makes, over what is allowed.",
        "",
        f"Slowest, {1e3 * slowest.seconds:.0f} ms: {_told(slowest)}",
        "",
        f"Nearest to being missed, {_number(nearest.excess)} times what is allowed: {_told(nearest)}",
        "",
        "## Survivors",
        "",
        *([f"- {_told(outcome)}" for outcome in survivors] or ["None."]),
    ]
    return "\n".join(lines) + "\n"


def _table(outcomes: Iterable[Outcome]) -> list[str]:
    modules: dict[str, list[Outcome]] = {}
    for outcome in outcomes:
        modules.setdefault(outcome.mutant.module, []).append(outcome)
    rows = ["| module | mutants | detected | survivors | margin | slowest, ms |", "|---|---|---|---|---|---|"]
    for name, found in modules.items():
        seen = [outcome.excess for outcome in found if outcome.detected]
        slowest = 1e3 * max(outcome.seconds for outcome in found)
        margin = _number(min(seen)) if seen else ""
        rows.append(
            f"| `{name}` | {len(found)} | {len(seen)} | {len(found) - len(seen)} | {margin} | {slowest:.0f} |"
        )
    return rows


def _number(value: float) -> str:
    return "no number" if math.isinf(value) else f"{value:.1e}"


def _told(outcome: Outcome) -> str:
    m = outcome.mutant
    return f"`{m.module}.{m.function}`, line {m.line}, `{m.entry}`: `{m.expression}` {m.change}"
