"""Modes of many designs, each followed along the airspeeds of its own design, all designs at once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from proprotor.stability.matching import Spectrum, link
from proprotor.typing import Array


class Followed(NamedTuple):
    """Where each state of a design is at each airspeed.

    places (designs, speeds, states) of int, by the frequency at the design's first good airspeed; quality
    (designs, speeds, states) of the step from the good airspeed before, see `proprotor.stability.matching.link`: NaN at the first
    and at failed points. first (designs,) is the place of the first good airspeed, -1 where there is none.
    """

    places: Array
    quality: Array
    first: Array


def follow_designs(spectrum: Spectrum, start: Array) -> Followed:
    """Follow states over failed points.

    Parameters
    ----------
    spectrum : Spectrum
        Of points (designs, speeds).
    start : array (designs, speeds, states) of int
        The order of the states that a design begins with.
    """
    designs, speeds, states = spectrum.values.shape
    good = spectrum.works
    points = np.flatnonzero(good)
    same_design = np.diff(points // speeds) == 0
    before, after = points[:-1][same_design], points[1:][same_design]
    flat = Spectrum(*(array.reshape(designs * speeds, *array.shape[2:]) for array in spectrum[:2]))
    steps = link(flat, before, after)
    first = np.where(good.any(axis=1), good.argmax(axis=1), -1)
    places = start.reshape(-1, states).copy()
    quality = np.full(places.shape, np.nan)
    for speed in range(1, speeds):
        rows = np.flatnonzero(after % speeds == speed)
        here = places[before[rows]]
        places[after[rows]] = np.take_along_axis(steps.successor[rows], here, -1)
        quality[after[rows]] = np.take_along_axis(steps.quality[rows], here, -1)
    shape = (designs, speeds, states)
    return Followed(places.reshape(shape), quality.reshape(shape), first)
