"""Boundaries as HTML, as a notebook shows them."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

from proprotor.model import html
from proprotor.model.doubts import footnotes, marked
from proprotor.stability.boundary import Boundary, Crossings, start_and_gaps
from proprotor.units import KNOT, KTAS

if TYPE_CHECKING:
    from proprotor.stability.flutter import FlutterPoint

_HEADS = ("Hz", "what happens", "participation", "")


def crossings_html(found: Crossings) -> str:
    """Return all boundaries of a line, which need not be airspeeds, in SI."""
    first, *rest = repr(found).split("\n")[:1]
    return html.block(
        first,
        _table(found.boundaries, "position (SI)", "", 1.0),
        html.lines([*rest, *start_and_gaps(found.unstable_at_start, found.failed)]),
        html.doubt_lines(footnotes(found.doubts, "")),
        html.origin_lines(found.stamp),
    )


def flutter_html(found: FlutterPoint) -> str:
    """Return a flutter point with all boundaries of the range that was searched."""
    return html.block(
        repr(found).split("\n")[0],
        _table(found.boundaries, KTAS, ".2f", KNOT),
        html.lines(start_and_gaps(found.unstable_at_start, found.failed, KTAS, KNOT)),
        html.doubt_lines(footnotes(found.doubts, KTAS, KNOT)),
        html.origin_lines(found.stamp),
    )


def boundary_html(found: Boundary) -> str:
    """Return one boundary in SI."""
    return html.block("Boundary", _table([found], "position (SI)", "", 1.0), html.origin_lines(found.stamp))


def _table(boundaries: Iterable[Boundary], head: str, form: str, size: float) -> str:
    rows = [
        (
            marked(f"{one.position / size:{form or '.6g'}}", one.warning),
            f"{one.frequency / math.tau:.4g}" if one.eigenvalue.imag else "",
            one.event,
            ", ".join(f"{name} {100 * share:.0f} %" for name, share in list(one.mechanism.items())[:3]),
            one.warning,
        )
        for one in boundaries
    ]
    return html.table((head, *_HEADS), rows, numbers=2) if rows else ""
