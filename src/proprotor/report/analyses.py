"""The analyses that a report tells of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from proprotor.errors import InputError
from proprotor.rotor.trim import Trim
from proprotor.stability.boundaries import scan_speeds
from proprotor.stability.flutter import FlutterPoint, flutter_point
from proprotor.typing import Array

if TYPE_CHECKING:
    import xarray

    from proprotor.case import Case


@dataclass(frozen=True, eq=False)
class Findings:
    """What a report tells.

    Attributes
    ----------
    sweep : xarray.Dataset
        Of `Case.sweep`.
    trim : Trim
        At the airspeeds of the sweep.
    flutter : FlutterPoint
    speed, mode : float, str
        Where causes are looked at: the flutter point, or the mode that is damped least at the highest airspeed that
        could be analysed. NaN and "" where there is none.
    causes : Causes, optional
        None where they could not be found, with the reason in `no_causes`.
    no_causes : str
    """

    sweep: xarray.Dataset
    trim: Trim
    flutter: FlutterPoint
    speed: float
    mode: str
    causes: Causes | None
    no_causes: str = ""

    @property
    def flutters(self) -> bool:
        """Whether anything becomes unstable."""
        return bool(np.isfinite(self.flutter.speed))

    @property
    def warning(self) -> str:
        """What makes the point at which causes are looked at doubtful; empty where nothing does."""
        if self.flutters:
            return self.flutter.warning
        return str(self.causes.attribution.warning.item()) if self.causes else ""


@dataclass(frozen=True, eq=False)
class Causes:
    """Datasets on one mode at one airspeed: its modes, `Case.sensitivity` and `Case.attribution`."""

    modes: xarray.Dataset
    sensitivity: xarray.Dataset
    attribution: xarray.Dataset


def analyse(case: Case, airspeeds: Array | None, options: Mapping[str, Any]) -> Findings:
    """All that a report tells of a case.

    Parameters
    ----------
    case : Case
    airspeeds : array (points,), optional
        m/s; those of `Case.flutter_point` by default.
    options : mapping
        See `proprotor.rotor.options.Options`.

    Raises
    ------
    InputError
        As `Case.sweep`.
    """
    speeds = scan_speeds(case) if airspeeds is None else airspeeds
    sweep = case.sweep(speeds, **options)
    trim = case.linearize(speeds, **options).trim
    found = flutter_point(case, speeds, **options)
    speed, mode = (found.speed, found.mode) if found.mode else _damped_least(sweep)
    if not mode:
        return Findings(sweep, trim, found, speed, mode, None, "no airspeed could be analysed")
    try:
        causes = _causes(case, speed, mode, bool(found.mode), speeds, options)
    except InputError as error:
        return Findings(sweep, trim, found, speed, mode, None, str(error))
    return Findings(sweep, trim, found, speed, mode, causes)


def _damped_least(sweep: xarray.Dataset) -> tuple[float, str]:
    """The highest airspeed that could be analysed, and the mode that is damped least there."""
    works = np.flatnonzero(sweep.reason.values == "")
    if not len(works):
        return np.nan, ""
    here = sweep.isel(airspeed=int(works[sweep.airspeed.values[works].argmax()]))
    return float(here.airspeed), str(here.mode.values[int(np.nanargmin(here.damping_ratio.values))])


def _causes(
    case: Case, speed: float, mode: str, flutters: bool, airspeeds: Array, options: Mapping[str, Any]
) -> Causes:
    if flutters:
        rates = case.sensitivity("flutter_speed", airspeed=airspeeds, **options)
    else:
        rates = case.sensitivity("damping", airspeed=speed, mode=mode, **options)
    modes = case.sweep(np.array([speed]), **options)
    return Causes(modes, rates, case.attribution(speed, mode, **options))
