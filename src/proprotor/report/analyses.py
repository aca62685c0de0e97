"""The analyses behind a report."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from proprotor.case import Case
from proprotor.errors import InputError
from proprotor.rotor.trim import Trim
from proprotor.stability.boundaries import scan_speeds
from proprotor.stability.flutter import FlutterPoint, flutter_point
from proprotor.typing import Array, Dataset


@dataclass(frozen=True, eq=False)
class Findings:
    """Results of the analyses behind a report.

    Attributes
    ----------
    sweep : xarray.Dataset
        Result of `Case.sweep`.
    trim : Trim
        Steady state at the airspeeds of the sweep.
    flutter : FlutterPoint
    speed, mode : float, str
        Airspeed (m/s) and mode of which the report shows the causes: the flutter point, or the mode that is damped
        least at the highest airspeed that could be analysed. NaN and "" if no airspeed could be analysed.
    causes : Causes, optional
        None if the causes could not be found; `no_causes` says why.
    no_causes : str
    envelope : xarray.Dataset, optional
        Result of `Case.envelope`, of a deck that has an envelope; `no_envelope` says why it could not be found.
    no_envelope : str
    """

    sweep: Dataset
    trim: Trim
    flutter: FlutterPoint
    speed: float
    mode: str
    causes: Causes | None
    no_causes: str = ""
    envelope: Dataset | None = None
    no_envelope: str = ""

    @property
    def flutters(self) -> bool:
        """Whether a mode becomes unstable."""
        return bool(np.isfinite(self.flutter.speed))

    @property
    def warning(self) -> str:
        """The reasons for which the point of the causes is doubtful; empty without a doubt."""
        if self.flutters:
            return self.flutter.warning
        return str(self.causes.attribution.warning.item()) if self.causes else ""


@dataclass(frozen=True, eq=False)
class Causes:
    """Datasets at one airspeed: all modes, and the sensitivities and the attribution of one mode."""

    modes: Dataset
    sensitivity: Dataset
    attribution: Dataset


def analyse(
    case: Case,
    airspeeds: Array | None,
    options: Mapping[str, Any],
    tell: Callable[[str], object] = lambda step: None,
) -> Findings:
    """Run all analyses of a report.

    Parameters
    ----------
    case : Case
    airspeeds : array (points,), optional
        m/s; the airspeeds of `Case.flutter_point` by default.
    options : mapping
        Options of the model, see `proprotor.rotor.options.Options`.
    tell : callable
        Told the name of each step as it begins.

    Raises
    ------
    InputError
        As `Case.sweep`.
    """
    speeds = scan_speeds(case) if airspeeds is None else airspeeds
    tell("Frequency and damping")
    sweep = case.sweep(speeds, **options)
    trim = case.linearize(speeds, **options).trim
    tell("Looking for boundaries")
    found = flutter_point(case, speeds, **options)
    speed, mode = (found.speed, found.mode) if found.mode else _damped_least(sweep)
    causes, no_causes = None, "" if mode else "no airspeed could be analysed"
    if mode:
        tell("Deriving causes and sensitivities")
        try:
            causes = _causes(case, speed, mode, bool(found.mode), speeds, options)
        except InputError as error:
            no_causes = str(error)
    tell("Envelope")
    return Findings(sweep, trim, found, speed, mode, causes, no_causes, *_envelope(case, options))


def _envelope(case: Case, options: Mapping[str, Any]) -> tuple[Dataset | None, str]:
    """Return the envelope of a case whose deck has one, or why it could not be found."""
    if case.deck is None or case.deck.envelope is None:
        return None, ""
    try:
        return case.envelope(**options), ""
    except InputError as error:
        return None, str(error)


def _damped_least(sweep: Dataset) -> tuple[float, str]:
    """Return the highest airspeed that could be analysed, and the mode that is damped least at this airspeed."""
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
    return Causes(case.sweep(np.array([speed]), **options), rates, case.attribution(speed, mode, **options))
