"""A case and a linear model as HTML, as a notebook shows them."""

from __future__ import annotations

import math
from collections import Counter
from typing import TYPE_CHECKING

import numpy as np

from proprotor.model import html, stamp
from proprotor.model.designs import designs
from proprotor.model.doubts import marked, reasons_for_doubt
from proprotor.model.provenance import doubtful_inputs, reservations
from proprotor.support.airframe import Airframe
from proprotor.units import KNOT, KTAS

if TYPE_CHECKING:
    from proprotor.model.configuration import Configuration
    from proprotor.model.linear_model import LinearModel

_MOST_POINTS = 12  # of a model


def case_html(case: Configuration) -> str:
    """Return rotor, operation and support of a case, and what its numbers rest on."""
    rotor, operation, support = case.rotor, case.operation, case.support
    rotors = "two rotors, each" if isinstance(support, Airframe) else "rotor"
    rows = [
        (rotors, f"{rotor.n_blades} blades, radius {_number(rotor.radius)} m"),
        ("rotor speed", f"{_number(operation.rotor_speed, math.pi / 30)} rpm"),
        (
            "air",
            f"{_number(operation.density)} kg/m³, speed of sound {_number(operation.speed_of_sound)} m/s",
        ),
        ("support", ", ".join(support.names) or "a rigid hub"),
    ]
    title = f"Case {case.name}" + (f": {case.title}" if case.title else "")
    remarks = html.folded(f"{len(case.warnings)} remarks on the input", html.lines(case.warnings))
    return html.block(
        title,
        html.table(("", ""), rows),
        html.lines(filter(None, [designs(case)])),
        html.lines(reservations(case)),
        remarks if case.warnings else "",
        html.inputs_not_read(doubtful_inputs(case)),
    )


def model_html(model: LinearModel) -> str:
    """Return the coordinates of a model and the trim of its points, with failed and doubtful ones."""
    trim, count = model.trim, int(np.size(model.trim.converged))
    columns = (model.airspeed, trim.collective, trim.thrust, trim.reason, trim.warning)
    flat = [np.ravel(np.broadcast_to(column, np.shape(trim.converged))) for column in columns]
    rows = [
        (
            f"{speed.real / KNOT:.4g}",
            *("" if reason else marked(f"{value:.5g}", warning) for value in (math.degrees(pitch), thrust)),
            str(reason or warning),
        )
        for speed, pitch, thrust, reason, warning in list(zip(*map(_real, flat), strict=True))[:_MOST_POINTS]
    ]
    reasons = Counter(str(reason) for reason in flat[3] if reason)
    told = [f"{at} of {count} failed: {reason}" for reason, at in reasons.most_common(3)]
    doubts = reasons_for_doubt(flat[4].tolist()).items()
    more = [f"{count - _MOST_POINTS} more points"] if count > _MOST_POINTS else []
    case = None if model.origin is None else model.origin.case
    return html.block(
        f"LinearModel: {len(model.dofs)} coordinates, {count} {'point' if count == 1 else 'points'}",
        html.lines([", ".join(model.dofs)]),
        html.table((KTAS, "collective, deg", "thrust, N", ""), rows, numbers=3),
        html.lines([*more, *told]),
        html.doubt_lines(f"{len(at)} of {count} doubtful: {text}" for text, at in doubts),
        html.origin_lines(stamp.of_model(model)),
        "" if case is None else html.inputs_not_read(doubtful_inputs(case)),
    )


def _real(column: np.ndarray) -> np.ndarray:
    return column.real if column.dtype.kind == "c" else column


def _number(values: object, size: float = 1.0) -> str:
    """Return a number in a unit, or the range of the numbers of many designs."""
    array = np.real(np.asarray(values)) / size
    low, high = f"{float(array.min()):.5g}", f"{float(array.max()):.5g}"
    return low if low == high else f"{low} to {high}"
