"""Damping and boundaries of a wing for a sample of designs: what doubtful inputs leave of a result."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import xarray

import proprotor as pp
from benchmarks.paper_figures.input_ranges import InputRange
from benchmarks.paper_figures.wing_modes import WingModes
from proprotor.study import mode_damping
from proprotor.study.variables import STABLE, UNSTABLE
from proprotor.typing import Array
from proprotor.units import KNOT

PERCENTILES = (5, 50, 95)


@dataclass(frozen=True, eq=False)
class Band:
    """A sample of designs, analysed.

    Attributes
    ----------
    results : xarray.Dataset
        A study of the designs with their modes. Flutter speeds are those of the first mode that moves the wing.
    """

    results: xarray.Dataset

    def damping(self, mode: str) -> Array:
        """Return the damping (designs, airspeeds) of a wing mode in percent of critical; NaN at failed points."""
        return 100 * mode_damping(self.results, mode).values

    def percentiles(self, mode: str) -> Array:
        """Return 5, 50 and 95 % (percentiles, airspeeds) of a wing mode's damping, in percent of critical."""
        return np.nanpercentile(self.damping(mode), PERCENTILES, axis=0)

    @cached_property
    def speed_percentiles(self) -> list[float]:
        """5, 50 and 95 % of the flutter speeds, kt; infinite beyond the last airspeed."""
        found = pp.distribution(self.results, percentiles=PERCENTILES)
        return [float(speed) / KNOT for speed in found.value.values]

    def share_below(self, speed: float) -> float:
        """Return the share of the designs, 0 to 1, whose wing becomes unstable below an airspeed in kt."""
        return pp.share_below(self.results, min(speed * KNOT, float(self.results.airspeed[-1])))

    def speeds_below(self, speed: float) -> Array:
        """Return the airspeeds in kt from which on designs are unstable, of those that are so below a given one."""
        return self._speeds[self._speeds < speed]

    def least_damping(self, speed: float) -> float:
        """Return the least damping, in percent of critical, of modes that move the wing below an airspeed in kt.

        Of the designs whose wing becomes unstable below that airspeed; NaN where there is none.
        """
        below = self.results.airspeed.values / KNOT < speed
        return 100 * float(mode_damping(self.results)[self._speeds < speed, below].min())

    @property
    def _speeds(self) -> Array:
        """Airspeed (designs,) in kt from which on each design is unstable; NaN where it is stable."""
        at_start = self.results.flutter_note == UNSTABLE
        speeds: Array = self.results.flutter_speed.where(~at_start, self.results.airspeed[0]).values
        return speeds / KNOT


def sample(ranges: Sequence[InputRange], samples: int, seed: int = 0) -> pp.sampling.Plan:
    """Return the plan of a Latin hypercube of designs over ranges of inputs."""
    return pp.sampling.latin_hypercube({one.inputs: one.distribution for one in ranges}, samples, seed)


def damping_band(
    case: pp.Case, airspeeds: Array, ranges: Sequence[InputRange], samples: int, seed: int = 0, **options: Any
) -> Band:
    """Return a Latin hypercube of designs over ranges of inputs, with modes and flutter speeds.

    Parameters
    ----------
    case : Case
        Made from a deck.
    airspeeds : array (airspeeds,)
        m/s, rising.
    ranges : sequence of InputRange
    samples : int
        Number of designs.
    seed : int
    **options
        See `proprotor.rotor.options.Options`.

    Returns
    -------
    Band

    Raises
    ------
    InputError
        As `proprotor.study`.
    """
    plan = sample(ranges, samples, seed)
    found = pp.study(case, plan, airspeeds, ("modes", "flutter"), **options)
    return Band(_with_speeds_of_the_wing(case, found, options))


def _with_speeds_of_the_wing(
    case: pp.Case, found: xarray.Dataset, options: Mapping[str, Any]
) -> xarray.Dataset:
    """Return results whose flutter speeds are those of the first mode that moves the wing.

    A study finds the first onset of any mode. Where that is a mode of the rotor, the boundaries beyond are looked for.
    """
    speed, note = found.flutter_speed.copy(deep=True), found.flutter_note.copy(deep=True)
    least = mode_damping(found).values
    at_start = least[:, 0] < 0
    of_rotor = np.isfinite(speed) & ~found.flutter_coordinate.isin(case.support.names)
    inputs = [str(path) for path in found.coords if path not in found.dims]
    for place in np.flatnonzero(of_rotor & ~at_start):
        design = case.vary({path: float(found[path][place]) for path in inputs})
        speed[place] = _first_onset(design, found.airspeed.values, options, float(speed[place]), least[place])
    of_wing = np.where(np.isfinite(speed), "", STABLE)
    note = note.where(~of_rotor & (note != UNSTABLE), of_wing)
    speed, note = speed.where(~at_start), note.where(~at_start, UNSTABLE)
    lowest, highest = found.airspeed.values[[0, -1]]
    above, below = found.flutter_speed_above, found.flutter_speed_below
    limits = {
        "flutter_speed_above": above.where(note != STABLE, highest).where(np.isnan(speed) & ~at_start),
        "flutter_speed_below": below.where(~at_start, lowest).where(note == UNSTABLE),
    }
    return found.assign(flutter_speed=speed, flutter_note=note, **limits)


def _first_onset(
    design: pp.Case, airspeeds: Array, options: Mapping[str, Any], lowest: float, least_damping: Array
) -> float:
    """Return the airspeed in m/s at which a mode that moves the wing becomes unstable; NaN without one.

    No mode becomes unstable below `lowest`. The least damping (airspeeds,) of modes that move the wing says up to which
    airspeed a search finds a boundary; only without one the rest is searched too.
    """
    start = max(int(np.searchsorted(airspeeds, lowest)) - 1, 0)
    ends = [int(end) for end in np.flatnonzero(least_damping <= 0) if end > start][:1]
    for end in (*ends, len(airspeeds) - 1):
        onset = WingModes(design, airspeeds[start : end + 1], options).first_onset
        if onset is not None:
            return onset.position
    return np.nan
