"""The flutter point of a case: the lowest airspeed at which a mode becomes unstable, of an aircraft by flutter."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from proprotor.errors import InputError
from proprotor.model import stamp
from proprotor.model.configuration import Configuration
from proprotor.model.doubts import MARK, Doubt, doubt_at, footnotes, marked
from proprotor.model.stamp import Stamp
from proprotor.stability.boundaries import boundaries
from proprotor.stability.boundary import Boundary, Failed, start_and_gaps
from proprotor.stability.flutter_messages import least_damping_message
from proprotor.stability.kinds import leading_onset
from proprotor.units import KNOT, KTAS, in_metres_per_second


@dataclass(frozen=True, repr=False)
class FlutterPoint:
    """The lowest onset of instability, and all boundaries of the range that was searched.

    Of an aircraft that flies free, the point is the lowest onset of flutter: divergence and instabilities of the rigid
    body are among the boundaries with their kinds (`proprotor.stability.kinds`).

    Attributes
    ----------
    speed : float
        m/s; NaN where nothing becomes unstable.
    frequency : float
        rad/s.
    mode, kind : str
        Of the boundary at the flutter speed; empty where nothing becomes unstable.
    boundaries : tuple of Boundary
        By airspeed.
    unstable_at_start : tuple of str
        What moves in the modes that are beyond the level at the lowest airspeed already.
    searched : tuple of float
        Lowest and highest airspeed that could be analysed, m/s.
    failed : tuple of Failed
        Airspeeds of the scan that could not be analysed, with the reason.
    eigen_solves : int
        All eigen-solves of the search.
    scan_solves : int
        Eigen-solves that bracketed every boundary.
    level : float
        Damping ratio.
    least_damping : float
        The smallest damping ratio of any mode at the airspeeds of the search, dimensionless; NaN without any mode.
    least_damping_mode : str
        The mode with the least damping.
    least_damping_speed : float
        Airspeed of the least damping, m/s.
    doubts : tuple of Doubt
        What makes airspeeds of the search doubtful, and from where to where in m/s.
    stamp : mapping of str to str
        The case and the options in force, see `proprotor.model.stamp`.
    """

    speed: float
    frequency: float
    mode: str
    kind: str
    boundaries: tuple[Boundary, ...]
    unstable_at_start: tuple[str, ...]
    searched: tuple[float, float]
    eigen_solves: int
    scan_solves: int
    level: float = 0.0
    least_damping: float = np.nan
    least_damping_mode: str = ""
    least_damping_speed: float = np.nan
    doubts: tuple[Doubt, ...] = ()
    stamp: Stamp = field(default_factory=dict)
    failed: tuple[Failed, ...] = ()

    def __repr__(self) -> str:
        """Return the flutter speed, and the other boundaries of the range."""
        low, high = (marked(f"{at / KNOT:.4g}", doubt_at(self.doubts, at)) for at in self.searched)
        if math.isnan(self.speed):
            begun = any(one.onset for one in self.boundaries)
            what = "no flutter begins" if begun else "nothing becomes unstable"
            first = f"FlutterPoint: {what} between {low} and {high} {KTAS}"
            least = least_damping_message(self, KTAS, KNOT)
            first += f"; least damping {least}" if least else ""
        else:
            where = f"{marked(f'{self.speed / KNOT:.2f}', self.warning)} {KTAS} ({self.speed:.6g} m/s)"
            first = f"FlutterPoint: {where}, {self.kind} of {self.mode}, {self.frequency / math.tau:.4g} Hz"
        if self.level:
            first += f"; damping of {100 * self.level:g} % counts as the boundary"
        lines = [
            f"{marked(f'{other.position / KNOT:.2f}', other.warning)} {KTAS}: {other.event}"
            for other in self.boundaries
            if other is not self.boundary
        ]
        lines += start_and_gaps(self.unstable_at_start, self.failed, KTAS, KNOT)
        lines += [f"{MARK} {line}" for line in footnotes(self.doubts, KTAS, KNOT)]
        return "\n  ".join([first, *lines, *stamp.unusual_options(self.stamp)])

    def _repr_html_(self) -> str:
        """Return what a notebook shows."""
        from proprotor.stability.in_notebook import flutter_html  # here, because most uses need no HTML

        return flutter_html(self)

    @property
    def boundary(self) -> Boundary | None:
        """The boundary at the flutter speed; None where there is none."""
        own = (one for one in self.boundaries if one.position == self.speed and one.kind == self.kind)
        return next((one for one in own if one.onset), None)

    @property
    def warning(self) -> str:
        """What makes the flutter speed doubtful; empty where nothing does."""
        return "" if self.boundary is None else self.boundary.warning

    def margin(self, airspeed: Any) -> float:
        """Return how far the flutter speed lies above an airspeed, as a part of the airspeed.

        Parameters
        ----------
        airspeed : float in m/s, text such as "250 kt", or pint quantity

        Returns
        -------
        float
            Dimensionless; NaN where nothing becomes unstable.
        """
        return self.speed / float(in_metres_per_second(airspeed, stamp.density_of(self.stamp))) - 1


def boundary_of(found: FlutterPoint, mode: str | None) -> Boundary:
    """Return the boundary at the flutter speed, or the first one of the mode with a name.

    Parameters
    ----------
    found : FlutterPoint
    mode : str or None
        Name of the mode; None for the boundary at the flutter speed.

    Returns
    -------
    Boundary

    Raises
    ------
    InputError
        Where there is none.
    """
    named = next((one for one in found.boundaries if one.mode == mode), None)
    wanted = found.boundary if mode is None else named
    if wanted is None:
        nothing = (
            "no flutter begins" if any(one.onset for one in found.boundaries) else "nothing becomes unstable"
        )
        rule = nothing if mode is None else "has no boundary"
        low, high = found.searched
        raise InputError("flutter_speed", mode, f"{rule} between {low:.6g} and {high:.6g} m/s")
    return wanted


def flutter_point(
    case: Configuration, airspeeds: Any = None, *, level: float = 0.0, **options: Any
) -> FlutterPoint:
    """Return the lowest airspeed at which a mode becomes unstable, with all boundaries of the range.

    Of an aircraft that flies free, the lowest airspeed at which flutter begins.

    Parameters
    ----------
    case : Case
    airspeeds : array (points,) in m/s, text such as "50:400:5kt", or pint quantity, optional
        The scan; 0.2 to 1.2 of the tip speed by default.
    level : float
        Damping ratio that counts as the boundary: 0.03 for a margin of 3 % of critical.
    **options
        See `proprotor.rotor.options.Options`.

    Returns
    -------
    FlutterPoint

    Raises
    ------
    InputError
        As `boundaries`.
    """
    found = boundaries(case, airspeeds, level=level, **options)
    onset = leading_onset(case, found.boundaries)
    own = (onset.position, onset.frequency, onset.mode, onset.kind) if onset else (np.nan, np.nan, "", "")
    return FlutterPoint(
        *own,
        found.boundaries,
        found.unstable_at_start,
        found.searched,
        found.eigen_solves,
        found.scan_solves,
        level,
        *found.least,
        found.doubts,
        found.stamp,
        found.failed,
    )
