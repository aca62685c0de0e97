"""The assignment of columns to rows with the largest sum, for the few matrices whose best entries fall together.

`scipy.optimize.linear_sum_assignment` does the same; its import takes longer than a flutter speed does.
"""

from __future__ import annotations

import numpy as np

from proprotor.typing import Array


def best_assignment(gain: Array) -> Array:
    """Return the column of each row in the assignment of columns to rows with the largest sum.

    A row keeps its best column where no other row takes it. Each further row gets its column by a shortest augmenting
    path, as of Jonker and Volgenant (Computing 38, 1987, 325-340): prices of rows and columns make the cost of each
    assigned pair zero and no cost negative, and the rows on the cheapest way to a free column change their columns.

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
    cost = gain.max(axis=1, keepdims=True) - gain
    column_of, row_of = _best_of_rows(cost)
    row_price, column_price = np.zeros(rows), np.zeros(columns)
    for row in np.flatnonzero(column_of < 0).tolist():
        way, column, length, reached = _cheapest_way(cost - column_price, row_price, row_of, row)
        on_way = np.flatnonzero(reached < length)
        column_price[on_way] += reached[on_way] - length
        row_price[row_of[on_way]] += length - reached[on_way]
        row_price[row] += length
        while column >= 0:
            before = column_of[way[column]]
            row_of[column], column_of[way[column]] = way[column], column
            column = before
    return column_of


def _best_of_rows(cost: Array) -> tuple[Array, Array]:
    """Return the column of each row and the row of each column, -1 where a row's best columns are all taken."""
    column_of, row_of = (np.full(size, -1) for size in cost.shape)
    row, column = np.arange(len(cost)), cost.argmin(axis=1)
    while len(row):
        row_of[column] = row  # of several rows, the last
        taken = np.flatnonzero(row_of >= 0)
        column_of[row_of[taken]] = taken
        row, free = np.flatnonzero(column_of < 0), np.flatnonzero(row_of < 0)
        best = cost[np.ix_(row, free)]
        also = best.min(axis=1, initial=np.inf) == 0
        row, column = row[also], free[best[also].argmin(axis=1)] if also.any() else free
    return column_of, row_of


def _cheapest_way(cost: Array, row_price: Array, row_of: Array, row: int) -> tuple[Array, int, float, Array]:
    """Return the cheapest way from a row to a free column (Dijkstra's algorithm).

    Returns
    -------
    way : array (columns,) of int
        The row from which the way enters each column.
    column : int
        The free column.
    length : float
        Cost of the way.
    reached : array (columns,)
        Cost of the way to each column that the search has passed, else infinity.
    """
    shortest, way = np.full(len(row_of), np.inf), np.empty(len(row_of), dtype=int)
    reached, length = np.full(len(row_of), np.inf), 0.0
    while True:
        through = np.where(reached < np.inf, np.inf, length - row_price[row] + cost[row])
        way[through < shortest] = row
        shortest = np.where(reached < np.inf, np.inf, np.minimum(shortest, through))
        length = shortest.min()
        nearest = np.flatnonzero(shortest == length)
        column = nearest[row_of[nearest].argmin()]  # a free one first
        reached[column], row = length, row_of[column]
        if row < 0:
            return way, column, length, reached
