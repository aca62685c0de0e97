"""The stability boundary of the XV-15 on its semispan wing: what the other benchmarks share.

A boundary is where a mode's damping falls through zero, by linear interpolation between points 5 kt apart.
"""

from __future__ import annotations

import numpy as np

import proprotor as pp

KNOT = 1852 / 3600
SPEEDS = np.arange(100, 521, 5) * KNOT
WING = ("beam", "chord", "torsion")


def boundaries(case: pp.Case, **options) -> dict[str, float]:
    """Lowest speed (kt) at which each wing mode, and any of the rotor's own, loses its damping; else NaN."""
    modes = case.sweep(SPEEDS, **options)
    found = {}
    for name in modes.mode.values.tolist():
        damping = modes.damping_ratio.sel(mode=name).values
        crossing = np.flatnonzero((damping[:-1] > 0) & (damping[1:] <= 0))
        if len(crossing):
            i = crossing[0]
            found[name] = float(np.interp(0, [damping[i + 1], damping[i]], SPEEDS[[i + 1, i]] / KNOT))
    wing = {name: min((v for n, v in found.items() if n.endswith(name)), default=np.nan) for name in WING}
    return wing | {"rotor": min((v for n, v in found.items() if not n.endswith(WING)), default=np.nan)}


def lowest_of_wing(found: dict[str, float]) -> float:
    """The lowest boundary of a wing mode, kt; NaN where none has one."""
    return float(np.fmin.reduce([found[name] for name in WING]))


def told(speed: float) -> str:
    """A boundary in kt."""
    return f"{speed:.0f}" if np.isfinite(speed) else f"> {SPEEDS[-1] / KNOT:.0f}"
