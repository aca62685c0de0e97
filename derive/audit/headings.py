"""Headings of the paper's equations and tables in notebooks and index, and the anchors they make."""

from __future__ import annotations

import re


def heading(number: int | str) -> str:
    """`Eq. 13`, `Table 1`, `Nomenclature ν_β`."""
    if isinstance(number, int):
        return f"Eq. {number}"
    return number if number.startswith("Table") else f"Nomenclature {number}"


def anchor(title: str) -> str:
    """What a forge makes of a heading: `Eq. 13` is `eq-13`."""
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
