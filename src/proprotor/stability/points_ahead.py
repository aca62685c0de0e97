"""Points within steps, solved together with the points that are likely to be asked for next.

A step whose roots cannot be told apart is halved a number of times. A few points cost little more than one, since most
of their cost is that of a call: with the middle of such a step, the middles of its halves and quarters are solved, and
wait until they are asked for. Which points the search looks at, and what it finds, stays the same.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from proprotor.stability.points import Points, Solved
from proprotor.typing import Array

_Solve = Callable[[Array, Array], Solved]
_FEW = 2  # steps that are halved: with more of them the points ahead cost more than the calls that they spare
_HALVINGS = 2  # of a halved step


class PointsAhead:
    """Points that were solved and not asked for yet.

    Who solves the points is told at each call and not kept: the search that holds these points would be held by them,
    and its memory would wait for Python's collector of cycles.
    """

    def __init__(self) -> None:
        self._points: Points | None = None
        self._waiting: dict[tuple[int, float], int] = {}  # line and position to the place among the points

    @property
    def lines(self) -> list[int]:
        """The line of each point that nothing has asked for."""
        return [line for line, _ in self._waiting]

    def within(self, line: Array, ends: Array, share: Array, solve: _Solve) -> tuple[Points | None, Array]:
        """Return the points at shares (k,) of steps with both ends (2, k), and which (k,) of the points work.

        `solve` takes lines (k,) and positions (k,) and returns what is found there.
        """
        at = ends[0] + share * (ends[1] - ends[0])
        asked = list(zip(line.tolist(), at.tolist(), strict=True))
        new = np.array([one not in self._waiting for one in asked])
        if new.any():
            halved = new & (share == 0.5)
            few = halved if halved.sum() <= _FEW else np.zeros(len(at), dtype=bool)
            lines, places = _further(line[few], ends[:, few])
            self._put(np.concatenate([line[new], lines]), np.concatenate([at[new], places]), solve)
        rows = np.array([self._waiting.pop(one, -1) for one in asked])
        works = rows >= 0
        return (self._points.at(rows[works]) if self._points is not None and works.any() else None), works

    def _put(self, line: Array, position: Array, solve: _Solve) -> None:
        """Solve points and let those that work wait, with the points that wait already."""
        found = solve(line, position).points
        if found is None:
            return
        waiting = list(self._waiting)
        if self._points is not None and waiting:
            found = self._points.at(np.array(list(self._waiting.values()))).joined(found)
        keys = zip(found.line.tolist(), found.position.tolist(), strict=True)
        self._points, self._waiting = found, {key: row for row, key in enumerate(keys)}


def _further(line: Array, ends: Array) -> tuple[Array, Array]:
    """Return lines and positions (m,) of the middles of halves and quarters of steps with both ends (2, k)."""
    lines, positions = [line[:0]], [ends[0, :0]]
    for _ in range(_HALVINGS):
        middle = ends[0] + 0.5 * (ends[1] - ends[0])
        line = np.tile(line, 2)
        ends = np.stack([np.concatenate([ends[0], middle]), np.concatenate([middle, ends[1]])])
        lines.append(line)
        positions.append(ends[0] + 0.5 * (ends[1] - ends[0]))
    return np.concatenate(lines), np.concatenate(positions)
