"""What a case, a model and a boundary say of themselves at a prompt: a few lines, for people."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from proprotor.model import stamp
from proprotor.model.doubts import MARK, doubt_at, footnotes, marked, reasons_for_doubt
from proprotor.model.provenance import reservations
from proprotor.stability.boundary_summary import failed_told, least_told
from proprotor.units import KNOT

if TYPE_CHECKING:
    from proprotor.case import Case
    from proprotor.model.linear_model import LinearModel
    from proprotor.stability.flutter import Boundary, Crossings, FlutterPoint
    from proprotor.support.normal_modes import NormalModes

_RPM = math.pi / 30  # rad/s


def of_case(case: Case) -> str:
    """The rotor, what carries it, and what its numbers rest on."""
    rotor, speed = case.rotor, np.asarray(case.operation.rotor_speed) / _RPM
    lines = [
        f"Case {case.name}" + (f": {case.title}" if case.title else ""),
        f"  rotor: {rotor.n_blades} blades, radius {_range(np.asarray(rotor.radius))} m, {_range(speed)} rpm",
        f"  support: {', '.join(case.support.names) or 'a rigid hub'}{_held(case.support)}",
    ]
    return "\n".join(lines + [f"  {sentence}" for sentence in reservations(case)])


def _held(support: NormalModes) -> str:
    """How the rotor was held when the modes were found with it on."""
    if not support.includes_rotor:
        return ""
    shaft = "" if support.includes_rotor == "mass only" else f", shaft {support.shaft}"
    return f"; found with the rotor on, {support.includes_rotor}{shaft}"


def of_model(model: LinearModel) -> str:
    """Coordinates, shape of the batch and what failed in it."""
    converged = np.asarray(model.trim.converged)
    shape = f"batch of shape {converged.shape}" if converged.ndim else "one point"
    lines = [
        f"LinearModel: {len(model.dofs)} coordinates, {shape}, {_range(model.airspeed)} m/s",
        f"  {', '.join(model.dofs)}",
    ]
    lines += [f"  {line}" for line in stamp.told_if_unusual(stamp.of_model(model))]
    reasons = Counter(str(reason) for reason in np.ravel(model.trim.reason) if reason)
    lines += [f"  {count} of {converged.size} failed: {reason}" for reason, count in reasons.most_common(5)]
    doubts = reasons_for_doubt(np.ravel(model.trim.warning).tolist())
    lines += [f"  {len(at)} of {converged.size} doubtful: {text}" for text, at in doubts.items()]
    return "\n".join(lines)


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
    options = [f"  {line}" for line in stamp.told_if_unusual(found.stamp)]
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
    options = [f"  {line}" for line in stamp.told_if_unusual(found.stamp)]
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


def _range(values: np.ndarray) -> str:
    low, high = float(np.min(values.real)), float(np.max(values.real))
    return f"{low:.6g}" if low == high else f"{low:.6g} to {high:.6g}"
