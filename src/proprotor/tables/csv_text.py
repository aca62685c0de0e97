"""Tables as CSV: what the numbers come from and rest on in lines that begin with #, then a head and a row each."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from proprotor.errors import printable
from proprotor.model import stamp

_FORMULA = ("=", "+", "-", "@")  # with which a cell begins that a spreadsheet works out
_QUANTITY = re.compile(r"[-+][\d.]+(e[-+]?\d+)?( ?[\w*/%°]+)?")


def csv_of(
    records: Sequence[Mapping[str, Any]], columns: Sequence[str], found: Mapping[Any, Any] | None = None
) -> bytes:
    """Records as CSV in UTF-8, with all digits; an empty cell for None and what is not finite.

    Parameters
    ----------
    records : sequence of mapping
    columns : sequence of str
        The head.
    found : mapping, optional
        Attributes of the results, whose stamp is told in comments above the head (pandas: ``comment="#"``).
    """
    text = io.StringIO(newline="")
    for line in head(found or {}):
        text.write(f"# {printable(line)}\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([_cell(column) for column in columns])
    writer.writerows([_cell(record[column]) for column in columns] for record in records)
    return text.getvalue().encode()


def head(found: Mapping[Any, Any]) -> Iterator[str]:
    """What stands above a table: the case, its options, all of them, and what the numbers rest on."""
    own = stamp.of(found)
    if "options" not in own:
        return
    if "title" in own:
        yield own["title"]
    yield f"{stamp.line(own)} {own['made_by']}."
    yield f"options: {own['options']}"
    yield from filter(None, (own.get("reservations"), own.get("case_warnings")))


def _cell(value: Any) -> Any:
    """A value as a spreadsheet is to take it: numbers as numbers, and text never as a formula."""
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, str):
        shown = printable(value)
        is_formula = shown.startswith(_FORMULA) and not _QUANTITY.fullmatch(shown)
        return f"'{shown}" if is_formula else shown
    return value
