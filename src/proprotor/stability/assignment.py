"""The assignment of columns to rows with the largest sum, for the few matrices whose best entries fall together.

`scipy.optimize.linear_sum_assignment` does the same; its import takes longer than a flutter speed does. Matrices are
small, so that plain numbers are several times quicker than arrays.
"""

from __future__ import annotations

from math import inf

import numpy as np

from proprotor.typing import Array


def best_assignment(gain: Array) -> Array:
    """Return the column of each row in the assignment of columns to rows with the largest sum.

    A row keeps its best column where no row before it takes it. Each further row gets its column by a shortest
    augmenting path, as of Jonker and Volgenant (Computing 38, 1987, 325-340): prices of rows and columns make the cost
    of each assigned pair zero and no cost negative, and the rows on the cheapest way to a free column change their
    columns.

    Parameters
    ----------
    gain : array (rows, columns)
        Finite, with at least as many columns as rows.

    Returns
    -------
    array (rows,) of int
        Different columns. Of several assignments with the largest sum, any.

    Raises
    ------
    ValueError
        When a gain is not finite, or there are more rows than columns.
    """
    rows, columns = gain.shape
    if rows > columns or not np.isfinite(gain).all():
        raise ValueError("an assignment needs finite gains, and a column for each row")
    if not rows:
        return np.empty(0, dtype=int)
    column_of, row_of = gain.argmax(axis=1).tolist(), [-1] * columns
    left = []
    for row, column in enumerate(column_of):
        if row_of[column] < 0:
            row_of[column] = row
        else:
            left.append(row)
    cost = (gain.max(axis=1, keepdims=True) - gain).tolist() if left else []
    row_price, column_price = [0.0] * rows, [0.0] * columns
    for row in left:
        way, column, length, passed = _cheapest_way(cost, row_price, column_price, row_of, row)
        for place, reached in passed:
            column_price[place] += reached - length
            row_price[row_of[place]] += length - reached
        row_price[row] += length
        changed = -1
        while changed != row:
            changed = row_of[column] = way[column]
            column_of[changed], column = column, column_of[changed]
    return np.array(column_of)


def _cheapest_way(
    cost: list[list[float]], row_price: list[float], column_price: list[float], row_of: list[int], row: int
) -> tuple[list[int], int, float, list[tuple[int, float]]]:
    """Return the cheapest way from a row to a free column (Dijkstra's algorithm).

    Returns
    -------
    way : list of int
        The row from which the way enters each column.
    column : int
        The free column.
    length : float
        Cost of the way.
    passed : list of (int, float)
        The columns that the search has passed, and the cost of the way to each.
    """
    shortest, way, ahead = [inf] * len(row_of), [row] * len(row_of), list(range(len(row_of)))
    passed: list[tuple[int, float]] = []
    here, length = row, 0.0
    while True:
        own, start = cost[here], length - row_price[here]
        nearest, length = -1, inf
        for column in ahead:
            through = start + own[column] - column_price[column]
            if through < shortest[column]:
                shortest[column], way[column] = through, here
            else:
                through = shortest[column]
            if through < length or (through == length and row_of[column] < 0):  # a free one first
                nearest, length = column, through
        if row_of[nearest] < 0:
            return way, nearest, length, passed
        passed.append((nearest, length))
        ahead.remove(nearest)
        here = row_of[nearest]
