"""Tables as CSV: comments that begin with # name the case and the options of the numbers, then come head and rows."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from proprotor.errors import printable
from proprotor.model import stamp

_FORMULA = ("=", "+", "-", "@")  # first characters of a cell that a spreadsheet computes
_QUANTITY = re.compile(r"[-+][\d.]+(e[-+]?\d+)?( ?[\w*/%°]+)?")


def csv_of(
    records: Sequence[Mapping[str, Any]], columns: Sequence[str], found: Mapping[Any, Any] | None = None
) -> bytes:
    """Return records as CSV in UTF-8, with all digits; an empty cell for None and numbers that are not finite.

    Parameters
    ----------
    records : sequence of mapping
    columns : sequence of str
        The head: names of the entries of a record, in their order.
    found : mapping, optional
        Attributes of the results, whose case and options stand in comments above the head (pandas: ``comment="#"``).

    Returns
    -------
    bytes
    """
    text = io.StringIO(newline="")
    for line in _comments(found or {}):
        text.write(f"# {printable(line)}\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([_cell(column) for column in columns])
    writer.writerows([_cell(record[column]) for column in columns] for record in records)
    return text.getvalue().encode()


def _comments(found: Mapping[Any, Any]) -> Iterator[str]:
    """Yield the comments above a table: the case, all options, and the reservations about the case."""
    own = stamp.of(found)
    if "options" not in own:
        return
    if "title" in own:
        yield own["title"]
    yield f"{stamp.line(own)} {own['made_by']}."
    yield f"options: {own['options']}"
    yield from filter(None, (own.get("reservations"), own.get("case_warnings")))


def _cell(value: Any) -> Any:
    """Return a value as a cell: a spreadsheet must read a number as a number, and a text never as a formula."""
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, str):
        shown = printable(value)
        is_formula = shown.startswith(_FORMULA) and not _QUANTITY.fullmatch(shown)
        return f"'{shown}" if is_formula else shown
    return value
