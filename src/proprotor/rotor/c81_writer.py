"""Write an airfoil from tables as a C81 file in fixed columns, which other programs read.

Every number stands in seven columns, the first of which stays blank. So programs that read columns (MBDyn, CAMRAD,
RCAS) and programs that read numbers separated by blanks (DUST) read the same numbers.
"""

from __future__ import annotations

import os
from collections.abc import Iterator

import numpy as np

from proprotor.errors import InputError, check_finite, printable
from proprotor.files.output import check_writable, write_whole
from proprotor.rotor.airfoil_table import AirfoilTable
from proprotor.rotor.c81 import airfoils_in
from proprotor.rotor.c81_layouts import TO_A_LINE, WIDTH, Fault
from proprotor.typing import Array

_MOST = 99  # Mach numbers or angles, for counts of two digits
_TITLE = 30  # columns
_PREAMBLE = ("1 0 0", "0 1", "0.158")  # of one table; DUST reads the first number alone


def write_c81(airfoil: AirfoilTable, path: str | os.PathLike[str], *, reynolds: float | None = None) -> None:
    """Write the tables of an airfoil as a C81 file.

    Numbers are rounded to what six columns hold: at most 0.00005 off below 1 and 0.0005 off below 10, and 0.05 deg in
    angles beyond -100 deg.

    Parameters
    ----------
    airfoil : AirfoilTable
        Its name becomes the title, without what is no ASCII and without what is beyond 30 characters.
    path : str or path
        A file that exists is replaced, and stays as it is when writing fails.
    reynolds : float, optional
        Reynolds number of the tables, dimensionless. With a Reynolds number the file has the lines before the table
        that DUST needs, and a title of one word; without one it has the title first, as all other programs expect.

    Raises
    ------
    InputError
        When the airfoil has more than 99 angles or Mach numbers, a number does not fit into its columns, or two angles
        or Mach numbers are the same once they are rounded. Nothing is written then.
    OSError
        When the file cannot be written.

    Examples
    --------
    >>> import proprotor as pp
    >>> section = pp.AirfoilTable.from_c81("section.c81")  # doctest: +SKIP
    >>> pp.write_c81(section, "dust.c81", reynolds=2e6)  # doctest: +SKIP
    """
    check_writable(path)
    text = "\n".join(_lines(airfoil, reynolds)) + "\n"
    try:
        airfoils_in(text)
    except Fault as fault:
        rule = f"cannot be told apart with the digits of a C81 file, whose {fault}"
        raise InputError("airfoil", airfoil.name, rule) from None
    write_whole(path, lambda file: file.write(text.encode("ascii")))


def _lines(airfoil: AirfoilTable, reynolds: float | None) -> Iterator[str]:
    """Yield the lines of the file."""
    title = printable(airfoil.name.encode("ascii", "ignore").decode()).strip() or "airfoil"
    tables = airfoil.tables.values()
    counts = "".join(f"{_count(len(part)):2d}" for alpha, mach, _ in tables for part in (mach, alpha))
    if reynolds is not None:
        check_finite("reynolds", reynolds, "above zero")
        yield from (*_PREAMBLE, title, f"{reynolds:.0f} 0.0")
        # DUST takes the first word for the title, and the digits after the next blanks in pairs.
        title, counts = "_".join(title.split())[: _TITLE - 1], counts.replace(" ", "0")
    yield f"{title[:_TITLE]:{_TITLE}}{counts}"
    for table in tables:
        yield from _table_lines(*table)


def _count(count: int) -> int:
    """Return a count of Mach numbers or angles, if it has two digits."""
    if count > _MOST:
        raise InputError(
            "airfoil", count, f"must have at most {_MOST} angles and Mach numbers for a C81 file"
        )
    return count


def _table_lines(alpha: Array, mach: Array, values: Array) -> Iterator[str]:
    """Yield the lines of one table: the Mach numbers, and a row for each angle."""
    yield from _row(" " * WIDTH, mach)
    for angle, row in zip(np.rad2deg(alpha), values, strict=True):
        yield from _row(_field(angle), row)


def _row(start: str, numbers: Array) -> Iterator[str]:
    """Yield the lines of one row, with seven blanks in the second and later ones."""
    fields = [_field(number) for number in numbers]
    for place in range(0, len(fields), TO_A_LINE):
        yield (" " * WIDTH if place else start) + "".join(fields[place : place + TO_A_LINE])


def _field(number: float) -> str:
    """Return a number in seven columns, the first blank: the nearest text that fits, the shortest of several.

    A decimal point always stands, because formats such as F7.4 put one where there is none.
    """
    texts = [f"{number + 0.0:.{digits}f}" for digits in range(1, WIDTH)]
    texts += [f"{number:.0f}.", *(text.replace("0.", ".", 1) for text in texts if abs(float(text)) < 1)]
    fitting = [text for text in texts if len(text) < WIDTH]
    if not fitting:
        raise InputError("airfoil", number, f"must fit into {WIDTH - 1} columns of a C81 file")
    return f"{min(fitting, key=lambda text: abs(float(text) - number)):>{WIDTH}}"
