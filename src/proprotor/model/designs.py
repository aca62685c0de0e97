"""Tell of a case that stands for many designs how many there are, and which inputs have several values."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from proprotor.model.linear_model import range_text
from proprotor.typing import Array

if TYPE_CHECKING:
    from proprotor.model.configuration import Configuration


def designs(case: Configuration) -> str:
    """Return how many designs a case stands for and the range of each input that varies; empty for one design."""
    varied = list(_varied(case))
    if not varied:
        return ""
    count = np.broadcast(*(values for _, values, _ in varied)).size
    ranges = (f"{path} {range_text(values)} {unit}".rstrip() for path, values, unit in varied)
    return f"{count} {'design' if count == 1 else 'designs'}: {', '.join(ranges)}"


def _varied(case: Configuration) -> Iterator[tuple[str, Array, str]]:
    """Yield path, values and unit of each number of the deck that is an array and no distribution along the blade."""
    for path, number in case.given.items():
        entries = {path: number.si}
        if isinstance(number.si, tuple):  # by region of the span
            entries = {f"{path}[{place}]": entry for place, entry in enumerate(number.si, start=1)}
        for name, values in entries.items():
            if isinstance(values, np.ndarray) and values.ndim and number.r_over_R is None:
                yield name, values, number.unit
