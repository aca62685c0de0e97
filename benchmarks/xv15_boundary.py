"""The stability boundary of the XV-15 on its semispan wing, for the other benchmarks."""

from __future__ import annotations

from typing import Any

import numpy as np

import proprotor as pp
from benchmarks.paper_figures.wing_modes import OF_THE_ROTOR, WingModes
from proprotor.units import KNOT

SPEEDS = np.arange(100, 521, 5) * KNOT
WING = ("beam", "chord", "torsion")


def boundaries(case: pp.Case, **options: Any) -> dict[str, float]:
    """Return the lowest speed in kt at which each wing mode, and any mode of the rotor, becomes unstable.

    Infinite where none is found. A wing mode that is unstable at the lowest speed has that speed.
    """
    wing = WingModes(case, SPEEDS, options)
    return {name: wing.speed(name) for name in WING} | {"rotor": wing.speed(OF_THE_ROTOR)}


def lowest_of_wing(found: dict[str, float]) -> float:
    """Return the lowest boundary of a wing mode, kt; infinite where none has one."""
    return min(found[name] for name in WING)


def as_text(speed: float) -> str:
    """Return a boundary in kt as text."""
    return f"{speed:.0f}" if np.isfinite(speed) else f"> {SPEEDS[-1] / KNOT:.0f}"
