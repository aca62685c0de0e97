"""Name the equations and tables of the paper as headings of pages, and the anchors of these headings."""

from __future__ import annotations

import re


def heading(number: int | str) -> str:
    """Return the heading of an equation or table: `Eq. 13`, `Table 1`, `Nomenclature ν_β`."""
    if isinstance(number, int):
        return f"Eq. {number}"
    return number if number.startswith("Table") else f"Nomenclature {number}"


def anchor(title: str) -> str:
    """Return the anchor that a forge gives a heading: `eq-13` for `Eq. 13`."""
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
