"""The least damping of the modes along a line: what a search that finds no boundary still says."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from proprotor.crossings import NEUTRAL

if TYPE_CHECKING:
    from proprotor.path import Path


class LeastDamping(NamedTuple):
    """The smallest damping ratio found at the points of a line, dimensionless, with its mode and position."""

    ratio: float
    mode: str
    position: float


NOWHERE = LeastDamping(np.nan, "", np.nan)


def least_damping(path: Path, names: Sequence[str]) -> LeastDamping:
    """Return the least damping ratio -Re λ/|λ| of the followed modes, neutral ones left out.

    Parameters
    ----------
    path : Path
        With a position for each of its points.
    names : sequence of str
        Of the followed states.

    Returns
    -------
    LeastDamping
        `NOWHERE` where no point has a mode.
    """
    values = path.values
    size = np.abs(values)
    moves = (values.imag >= 0) & (size > NEUTRAL * size.max(initial=0))
    if not moves.any():
        return NOWHERE
    ratio = np.where(moves, -values.real, np.inf) / np.where(moves, size, 1)
    point, state = map(int, np.unravel_index(np.argmin(ratio), ratio.shape))
    return LeastDamping(float(ratio[point, state]), names[state], float(path.positions[path.points[point]]))
