"""Mark doubtful numbers with a question mark wherever they are shown, and give the reasons in footnotes."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from proprotor.typing import Array, Dataset

MARK = "?"
_SHARE = re.compile(r"\d+(?=%)")  # a percentage, which differs from point to point for the same reason


class Doubt(NamedTuple):
    """A reason for which numbers are doubtful, and the positions between which they are.

    Parameters
    ----------
    text : str
    low, high : float
        The lowest and the highest doubtful position, m/s or in SI units of the input.
    """

    text: str
    low: float
    high: float


def reasons_for_doubt(warnings: Iterable[str]) -> dict[str, list[int]]:
    """Return each reason in some warnings, in the order of appearance, with the places of its warnings.

    A reason that appears with several percentages is kept once, with the largest.
    """
    found: dict[str, list[tuple[int, str]]] = defaultdict(list)
    for place, warning in enumerate(warnings):
        for text in filter(None, str(warning).split("; ")):
            found[_SHARE.sub("", text)].append((place, text))
    return {_largest([text for _, text in own]): [place for place, _ in own] for own in found.values()}


def _largest(texts: list[str]) -> str:
    """Return the text with the largest percentage, as "up to", or the only text."""
    if len(set(texts)) == 1:
        return texts[0]
    largest = max(texts, key=lambda text: [int(share) for share in _SHARE.findall(text)])
    return _SHARE.sub(lambda share: f"up to {share[0]}", largest)


def doubts_along(positions: Array | float, warnings: Array) -> tuple[Doubt, ...]:
    """Return the doubts along a line of positions (points,) with warnings (points,), or at one position."""
    at = np.atleast_1d(np.asarray(positions, dtype=float))
    found = reasons_for_doubt(np.atleast_1d(warnings).tolist())
    return tuple(
        Doubt(text, float(at[places].min()), float(at[places].max())) for text, places in found.items()
    )


def doubtful_near(positions: Array, warnings: Array, at: float) -> bool:
    """Return whether one of the two points nearest to a position, below and above, is doubtful."""
    near = [positions[positions <= at].max(initial=-np.inf), positions[positions >= at].min(initial=np.inf)]
    return bool((warnings[np.isin(positions, near)] != "").any())


def doubt_at(doubts: Iterable[Doubt], position: float) -> str:
    """Return the reasons for which a position is doubtful, from the doubts along its line; "" without any."""
    return "; ".join(doubt.text for doubt in doubts if doubt.low <= position <= doubt.high)


def marked(number: str, warning: object) -> str:
    """Return a number as it is shown: with a question mark if it has a warning."""
    return f"{number}{MARK}" if warning else number


def position(value: float) -> str:
    """Return a position in a sentence: from 1 on with two decimals at most, below with six digits."""
    return f"{round(value, 2) if abs(value) >= 1 else value:g}"


def footnotes(doubts: Iterable[Doubt], unit: str, factor: float = 1.0) -> Iterator[str]:
    """Yield a sentence on each doubt, with positions in a unit; `factor` is the size of the unit in SI."""
    for doubt in doubts:
        low, high = (f"{position(end / factor)} {unit}".strip() for end in doubt[1:])
        where = f"at {low}" if low == high else f"from {low} to {high}"
        yield f"Doubtful {where}: {doubt.text}."


def map_doubts(found: Dataset) -> Iterator[str]:
    """Yield a sentence on each doubt of a stability map, at its points and along its boundary."""
    points, vertices = (
        found[name].values.ravel().tolist() if name in found else []
        for name in ("warning", "boundary_warning")
    )
    for text, places in reasons_for_doubt([*points, *vertices]).items():
        inside = sum(place < len(points) for place in places)
        yield f"Doubtful at {inside} points and {len(places) - inside} of the boundary: {text}."
