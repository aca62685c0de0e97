"""The least damping of the modes along a line: what a search that finds no boundary still says."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from proprotor.stability.crossings import Points


class LeastDamping(NamedTuple):
    """The smallest damping ratio found at the points of a line, dimensionless, with its mode and position."""

    ratio: float
    mode: str
    position: float


NOWHERE = LeastDamping(np.nan, "", np.nan)


def least_damped(points: Points) -> tuple[int, int] | None:
    """Return the point and the state with the least damping ratio -Re λ/|λ|; None where no point has a mode.

    Roots at zero within their error have no damping ratio and are left out.
    """
    values = points.spectrum.values
    size = np.abs(values)
    moves = (values.imag >= 0) & (size > points.error)
    if not moves.any():
        return None
    ratio = np.where(moves, -values.real, np.inf) / np.where(moves, size, 1)
    point, state = np.unravel_index(np.argmin(ratio), ratio.shape)
    return int(point), int(state)
