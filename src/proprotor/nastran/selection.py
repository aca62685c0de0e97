"""Choose the eigenvectors of one subcase at one grid point, and the table with their generalised masses."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from proprotor.errors import InputError
from proprotor.nastran.found import EigenvalueTable, Found, ModeSet

_IN_BASIC = "B"  # begins the names of tables in the basic coordinate system
_NEAR, _NEAR_ZERO = 1e-4, 1e-3  # ω² of one mode in two tables, relative and absolute
_SAME_MOTION = 1e-5  # of the largest component


def chosen_set(found: Found, grid: int, subcase: int | None, file: str) -> ModeSet:
    """Return the eigenvectors of one subcase that have the grid point.

    Where several tables have them, the motion in the output coordinate system of the grid point goes before that in the
    basic one. Superelements have their own eigenvectors in the same subcase; those with the grid point are taken.

    Raises
    ------
    InputError
        When there are no real eigenvectors, the subcase is missing or unknown, no eigenvector has the grid point, or
        several differ in its motion.
    """
    if not found.sets:
        rule = "has no real eigenvectors: ask Nastran for DISPLACEMENT(PLOT) = ALL"
        if found.has_complex:
            rule = "has complex eigenvectors alone: ask Nastran for real ones (SOL 103)"
        raise InputError("file", file, rule)
    numbers = list(dict.fromkeys(one.subcase for one in found.sets))
    listed = ", ".join(map(str, numbers))
    if subcase is None and len(numbers) > 1:
        raise InputError("subcase", None, f"must be given: the file has {listed}")
    if subcase is not None and subcase not in numbers:
        raise InputError("subcase", subcase, f"is not in the file, which has {listed}")
    wanted = numbers[0] if subcase is None else subcase
    having = [one for one in found.sets if one.subcase == wanted and one.has_grid]
    if not having:
        raise InputError("grid", grid, "has no eigenvectors in the file: the hub's grid point is missing")
    having.sort(key=is_in_output_system, reverse=True)
    first, *others = (one for one in having if one.table == having[0].table)
    if not all(_same(first, other) for other in others):
        rule = f"has {len(others) + 1} sets of eigenvectors of the grid point that differ: keep one of them in the file"
        raise InputError("subcase", wanted, rule)
    return first


def table_of(modes: ModeSet, tables: Sequence[EigenvalueTable]) -> EigenvalueTable | None:
    """Return the table with the eigenvalues of the modes; None without such a table.

    Eigenvectors that come without eigenvalues (SORT2) have those of the only table, or of the table of their subcase.
    """
    numbered = [table for table in tables if set(modes.numbers) <= set(table.numbers.tolist())]
    if not np.isnan(modes.eigenvalues).any():
        return next((table for table in numbered if _belongs(table, modes)), None)
    own = [table for table in numbered if table.subcase == modes.subcase]
    if len(own) == 1:
        return own[0]
    return numbered[0] if len(numbered) == 1 else None


def rows_of(modes: ModeSet, table: EigenvalueTable) -> list[int]:
    """Return the place of each mode in a table."""
    numbers = table.numbers.tolist()
    return [numbers.index(number) for number in modes.numbers]


def is_in_output_system(modes: ModeSet) -> bool:
    """Return whether the motion is in the output coordinate system of the grid point."""
    return not modes.table.startswith(_IN_BASIC)


def _belongs(table: EigenvalueTable, modes: ModeSet) -> bool:
    """Return whether the eigenvalues of a table are those of the modes."""
    values = table.eigenvalues[rows_of(modes, table)]
    return bool(np.allclose(values, modes.eigenvalues, rtol=_NEAR, atol=_NEAR_ZERO))


def _same(one: ModeSet, other: ModeSet) -> bool:
    """Return whether two sets have the same modes with the same motion."""
    if one.numbers != other.numbers:
        return False
    size = np.abs(one.motion).max(initial=0.0)
    return bool((np.abs(one.motion - other.motion) <= _SAME_MOTION * size).all())
