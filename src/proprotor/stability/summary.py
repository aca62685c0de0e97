"""What a case, a model and a boundary say of themselves at a prompt: a few lines, for people."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from proprotor.model import stamp
from proprotor.model.doubts import MARK, doubt_at, footnotes, marked
from proprotor.stability.boundary_summary import failed_told, least_told
from proprotor.units import KNOT

if TYPE_CHECKING:
    from proprotor.stability.flutter import Boundary, Crossings, FlutterPoint


def of_boundary(boundary: Boundary) -> str:
    """Where which mode crosses the level, and how."""
    hertz = f", {boundary.frequency / math.tau:.4g} Hz" if boundary.kind == "flutter" else ""
    return f"Boundary at {_position(boundary)}: {_event(boundary)}{hertz}{_reason(boundary.warning)}"


def of_crossings(found: Crossings) -> str:
    """All boundaries of a line, which need not be airspeeds: SI."""
    low, high = found.searched
    lines = [f"{len(found.boundaries)} boundaries from {low:.6g} to {high:.6g}"]
    if not found.boundaries and found.least.mode:
        ratio, mode, position = found.least
        lines[0] += f"; least damping {100 * ratio:.2g} % of critical: {mode} at {position:.6g}"
    lines += [f"  {of_boundary(boundary)}" for boundary in found.boundaries]
    options = [f"  {line}" for line in stamp.unusual_options(found.stamp)]
    return "\n".join([*lines, *_at_start(found), *_failed(found, "", 1.0), *options])


def of_flutter_point(found: FlutterPoint) -> str:
    """The flutter speed, and the other boundaries of the range."""
    low, high = (marked(f"{at / KNOT:.4g}", doubt_at(found.doubts, at)) for at in found.searched)
    if math.isnan(found.speed):
        first = f"FlutterPoint: nothing becomes unstable between {low} and {high} kt"
        first += f"; least damping {told}" if (told := least_told(found, "kt", KNOT)) else ""
    else:
        where = f"{marked(f'{found.speed / KNOT:.2f}', found.warning)} kt ({found.speed:.6g} m/s)"
        first = f"FlutterPoint: {where}, {found.kind} of {found.mode}, {found.frequency / math.tau:.4g} Hz"
    if found.level:
        first += f"; damping of {100 * found.level:g} % counts as the boundary"
    others = [boundary for boundary in found.boundaries if boundary.position != found.speed]
    lines = [
        f"  {marked(f'{boundary.position / KNOT:.2f}', boundary.warning)} kt: {_event(boundary)}"
        for boundary in others
    ]
    doubts = [f"  {MARK} {line}" for line in footnotes(found.doubts, "kt", KNOT)]
    options = [f"  {line}" for line in stamp.unusual_options(found.stamp)]
    return "\n".join([first, *lines, *_at_start(found), *_failed(found, "kt", KNOT), *doubts, *options])


def _position(boundary: Boundary) -> str:
    return marked(f"{boundary.position:.6g}", boundary.warning)


def _reason(warning: str) -> str:
    return f" (doubtful: {warning})" if warning else ""


def _event(boundary: Boundary) -> str:
    return f"{boundary.kind} of {boundary.mode} {'begins' if boundary.onset else 'ends'}"


def _at_start(found: Crossings | FlutterPoint) -> Iterator[str]:
    if found.unstable_at_start:
        yield f"  from the start beyond the level: {', '.join(found.unstable_at_start)}"


def _failed(found: Crossings | FlutterPoint, unit: str, factor: float) -> Iterator[str]:
    for told in failed_told(found, unit, factor):
        yield f"  {told}"
