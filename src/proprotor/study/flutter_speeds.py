"""The flutter speed of each design of a batch: the lowest airspeed of a range at which a mode becomes unstable."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from proprotor.model.first_order import held_coordinates
from proprotor.model.linear_model import LinearModel
from proprotor.stability.boundary import instability
from proprotor.stability.brackets import Brackets, Crossing
from proprotor.stability.crossings import Search
from proprotor.stability.kinds import FLUTTER, kinds
from proprotor.stability.matching import Modes, Spectrum
from proprotor.stability.mode_names import moving
from proprotor.stability.participation import coordinate_shares
from proprotor.study.censoring import put_limits
from proprotor.study.variables import ALWAYS, STABLE, UNSTABLE
from proprotor.typing import Array

if TYPE_CHECKING:
    from proprotor.study.batch import Batch

# From rows of a batch, and an airspeed for each row, to the models of these designs at these airspeeds.
_Models = Callable[[Array, Array], LinearModel]


def put_flutter_speeds(
    found: dict[str, Array],
    batch: Batch,
    rows: Array,
    models: _Models,
    states: int,
    tolerance: float,
    flies_free: bool = False,
) -> None:
    """Put the variables of the quantity "flutter" of some designs in their places.

    Parameters
    ----------
    found : dict of array
        The variables of the batch, with the reasons of designs that the case refuses.
    batch : Batch
    rows : array of int
        The designs to search.
    models : callable
        From rows of the batch and an airspeed for each row, to the models.
    states : int
        Number of eigenvalues of the model; 0 if the number is not known.
    tolerance : float
        Tolerance of a flutter speed, m/s.
    flies_free : bool
        Whether the designs are aircraft, whose flutter speed is the lowest onset of flutter alone, and not of
        divergence or of an instability of the rigid body.
    """
    speeds = batch.shape[1]
    search = Search(
        models,
        np.repeat(rows, speeds),
        np.tile(np.asarray(batch.speeds, dtype=float), len(rows)),
        onset_only=not flies_free,
        forgiving=True,
        states=states or None,
    )
    for name in ALWAYS:
        found[name][rows] = getattr(search.scanned, name).reshape(len(rows), speeds)
    found["flutter_note"][:] = _notes(found["reason"], batch, search, models if flies_free else None)
    if search.scanned.points is None:
        return
    brackets = Brackets(search, tolerance)
    onsets = [one for one in brackets.close() if one.onset]
    aside: dict[int, str] = {}
    if flies_free and onsets:
        onsets, aside = _flutter_apart(onsets, models)
    downwards = sorted(onsets, key=lambda one: one.position, reverse=True)
    first = {one.line: one for one in downwards}  # the lowest onset of each design that has one
    for place, why in brackets.lost.items():
        if brackets.line[place] not in first:
            found["flutter_note"][brackets.line[place]] = f"the search for its boundary failed: {why}"
    _put_least_damping(found, search)
    if first:
        _put_onsets(found, first, models)
    put_limits(found, np.asarray(batch.speeds, dtype=float))
    for line, text in aside.items():
        found["flutter_warning"][line] = "; ".join(filter(None, (str(found["flutter_warning"][line]), text)))


def _flutter_apart(onsets: list[Crossing], models: _Models) -> tuple[list[Crossing], dict[int, str]]:
    """Return the onsets that are flutter, and a sentence by line on the lowest onset that is not."""
    lines, positions = np.array([one.line for one in onsets]), np.array([one.position for one in onsets])
    model, every = models(lines, positions), _modes_at(onsets)
    kind, names = kinds(model, every), moving(model, every.values, every.left, every.right).names
    flutters, aside = [], {}
    for row in np.argsort(-positions):
        one = onsets[row]
        if kind[row, one.state] == FLUTTER:
            flutters.append(one)
        else:
            event = instability(kind[row, one.state], names[row, one.state])
            aside[one.line] = f"{event} begins at {one.position:.6g} m/s"
    return flutters, aside


def _modes_at(onsets: list[Crossing]) -> Modes:
    """Return all modes at some crossings."""
    values, right = (
        np.stack([getattr(one.spectrum, part) for one in onsets]) for part in ("values", "right")
    )
    return Spectrum(values, right, blocks=onsets[0].spectrum.blocks).all_modes


def _put_onsets(found: dict[str, Array], first: Mapping[int, Crossing], models: _Models) -> None:
    """Put the lowest onset of each design in its place, with the name and the main coordinate of the mode."""
    rows, onsets = np.array(list(first)), list(first.values())
    model = models(rows, np.array([one.position for one in onsets]))
    values, right, left = _modes_at(onsets)
    every, state = np.arange(len(rows)), np.array([one.state for one in onsets])
    held = held_coordinates(model, values.shape[-1])
    shares = coordinate_shares(held, len(model.dofs), left, right)[every, :, state]
    found["flutter_speed"][rows] = [one.position for one in onsets]
    found["flutter_frequency"][rows] = [abs(one.value.imag) for one in onsets]
    found["flutter_mode"][rows] = moving(model, values, left, right).names[every, state]
    found["flutter_coordinate"][rows] = np.array(model.dofs, dtype=object)[shares.argmax(axis=-1)]
    found["flutter_warning"][rows] = model.trim.warning
    stable = found["flutter_note"][rows] != UNSTABLE
    found["flutter_note"][rows[stable]] = ""


def _notes(reason: Array, batch: Batch, search: Search, models: _Models | None) -> Array:
    """Return a sentence on each design before any boundary is known; with `models`, of aircraft, by flutter alone."""
    notes = np.array([why[0] or "no airspeed could be analysed" for why in reason], dtype=object)
    if search.scanned.points is not None:
        points = search.first_points
        order = np.lexsort((points.position, points.line))
        lines, place = np.unique(points.line[order], return_index=True)
        first = order[place]
        beyond = points.growth[first] > points.error[first]
        if models is not None:
            model = models(points.line[first], points.position[first])
            beyond &= kinds(model, points.spectrum.at(first).all_modes) == FLUTTER
        grows = np.any(beyond, axis=1)
        for line, unstable in zip(lines, grows, strict=True):
            notes[line] = UNSTABLE if unstable else STABLE + _beyond(batch.speeds, reason[line])
    return notes


def _beyond(airspeed: Array, reason: Array) -> str:
    """Return which failed airspeeds leave open whether a design is stable."""
    failed = np.flatnonzero(reason != "")
    if not len(failed):
        return ""
    return f"; {len(failed)} airspeeds failed, at {airspeed[failed[0]]:.6g} m/s: {reason[failed[0]]}"


def _put_least_damping(found: dict[str, Array], search: Search) -> None:
    """Put the lowest damping ratio of each design at the airspeeds of the range in its place."""
    scanned = search.first_points
    values, size = scanned.spectrum.values, np.abs(scanned.spectrum.values)
    with np.errstate(all="ignore"):
        ratio = np.where(size > scanned.error, -values.real / size, np.inf).min(axis=1)
    least = np.full(len(found["flutter_note"]), np.inf)
    np.minimum.at(least, scanned.line, ratio)
    found["flutter_least_damping"][:] = np.where(np.isfinite(least), least, np.nan)
