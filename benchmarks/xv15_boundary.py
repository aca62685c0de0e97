"""The stability boundary of the XV-15 on its semispan wing: what the other benchmarks share.

A boundary is where a mode's damping falls through zero, by linear interpolation between points 5 kt apart.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import proprotor as pp
from benchmarks.paper_figures.mode_following import follow_support_modes
from proprotor.stability.modes import eigensystem
from proprotor.units import KNOT

SPEEDS = np.arange(100, 521, 5) * KNOT
WING = ("beam", "chord", "torsion")


def boundaries(case: pp.Case, **options) -> dict[str, float]:
    """Lowest speed (kt) at which each wing mode, and any of the rotor's own, loses its damping; else NaN."""
    model = case.linearize(SPEEDS[None], **options)
    system = eigensystem(model)
    wing = follow_support_modes(model, system)[0]
    values = system.values[0]
    of_wing = (values[:, :, None] == wing[:, None, :]).any(axis=-1)
    of_rotor = np.where(of_wing | ~(values.imag > 0), np.nan, _ratio(values))
    columns = dict(zip(WING, _ratio(wing).T, strict=True)) | {"rotor": np.fmin.reduce(of_rotor, axis=1)}
    return {name: _first_fall(damping) for name, damping in columns.items()}


def _ratio(values: NDArray) -> NDArray:
    with np.errstate(all="ignore"):
        return -values.real / np.abs(values)


def _first_fall(damping: NDArray) -> float:
    """Where damping first falls through zero, kt; NaN where it does not."""
    crossing = np.flatnonzero((damping[:-1] > 0) & (damping[1:] <= 0))
    if not len(crossing):
        return np.nan
    i = crossing[0]
    return float(np.interp(0, [damping[i + 1], damping[i]], SPEEDS[[i + 1, i]] / KNOT))


def lowest_of_wing(found: dict[str, float]) -> float:
    """The lowest boundary of a wing mode, kt; NaN where none has one."""
    return float(np.fmin.reduce([found[name] for name in WING]))


def told(speed: float) -> str:
    """A boundary in kt."""
    return f"{speed:.0f}" if np.isfinite(speed) else f"> {SPEEDS[-1] / KNOT:.0f}"
