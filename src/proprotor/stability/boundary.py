"""Records of stability boundaries: one crossing of a damping level, and all crossings along a line."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from proprotor.model import stamp
from proprotor.model.doubts import Doubt, marked
from proprotor.model.stamp import Stamp


def instability(kind: str, mode: str) -> str:
    """Return what is unstable in words: "flutter of beam"."""
    return f"{'rigid-body instability' if kind == 'rigid body' else kind} of {mode}"


@dataclass(frozen=True, repr=False)
class Boundary:
    """One crossing of a damping level.

    Attributes
    ----------
    position : float
        Airspeed in m/s, or another input in SI.
    mode : str
        What moves most in the mode that crosses, by `proprotor.stability.mode_names`: its name at the boundary itself.
    kind : "flutter", "divergence" or "rigid body"
        A pair; a real root; or a pair in which an aircraft moves as one body: see `proprotor.stability.kinds`.
    onset : bool
        Whether damping falls through the level as the position grows; otherwise damping rises through the level.
    eigenvalue : complex
        rad/s.
    rate : float
        dG/dposition, 1/s per unit of the position: the growth Re λ + ζ0 |λ| with ζ0 the level.
    eigenvalue_rate : complex
        dλ/dposition, rad/s per SI unit of the position.
    mechanism : mapping of str to float
        Participation at the boundary, dimensionless, the largest first, by the names of modes.
    defect : float
        Dimensionless: 1 for a well-separated mode, large where the mode nearly falls into one with another
        (`proprotor.stability.eigenvalue_derivatives.defect`).
    eigen_solves : int
        Eigen-solves for this crossing beyond the eigen-solves that bracketed it.
    branch : str
        The exact root that crosses, by what moves in it where branches are named (`proprotor.stability.branches`).
    warning : str
        What makes the boundary doubtful, such as Mach numbers beyond the airfoil data; empty where nothing does.
    level : float
        Damping ratio that is crossed.
    stamp : mapping of str to str
        The case and the options in force, see `proprotor.model.stamp`; empty on a line that is of no case.
    """

    position: float
    mode: str
    kind: str
    onset: bool
    eigenvalue: complex
    rate: float
    eigenvalue_rate: complex
    mechanism: Mapping[str, float]
    defect: float
    eigen_solves: int
    branch: str = ""
    warning: str = ""
    level: float = 0.0
    stamp: Stamp = field(default_factory=dict)

    def __repr__(self) -> str:
        """Return where which mode crosses the level, and how."""
        hertz = f", {self.frequency / math.tau:.4g} Hz" if self.eigenvalue.imag else ""
        doubt = f" (doubtful: {self.warning})" if self.warning else ""
        return f"Boundary at {marked(f'{self.position:.6g}', self.warning)}: {self.event}{hertz}{doubt}"

    def _repr_html_(self) -> str:
        """Return what a notebook shows."""
        from proprotor.stability.in_notebook import boundary_html  # here, because most uses need no HTML

        return boundary_html(self)

    @property
    def frequency(self) -> float:
        """|Im λ|, rad/s."""
        return abs(self.eigenvalue.imag)

    @property
    def event(self) -> str:
        """What happens at the boundary, as "flutter of beam begins"."""
        return f"{instability(self.kind, self.mode)} {'begins' if self.onset else 'ends'}"


class Failed(NamedTuple):
    """A stretch of a scan that could not be analysed.

    Parameters
    ----------
    first, last : float
        Neighbouring positions that could be analysed, or the ends of the scan: m/s or in SI units of the input.
    reason : str
        Why the stretch could not be analysed.
    """

    first: float
    last: float
    reason: str

    def message(self, unit: str = "", factor: float = 1.0) -> str:
        """Return a sentence on the stretch.

        Parameters
        ----------
        unit : str
            Unit of the positions.
        factor : float
            SI units in that unit.

        Returns
        -------
        str
        """
        low, high = (f"{end / factor:.4g}" for end in (self.first, self.last))
        where = low if low == high else f"{low} to {high}"
        return f"Not analysed: {where} {unit}".rstrip() + f" ({self.reason})."


class LeastDamping(NamedTuple):
    """The smallest damping ratio found at the points of a line, dimensionless, with its mode and position."""

    ratio: float
    mode: str
    position: float


NOWHERE = LeastDamping(np.nan, "", np.nan)


class Crossings(NamedTuple):
    """Boundaries along a line, with the modes beyond the level at its start.

    Parameters
    ----------
    boundaries : tuple of Boundary
        By position.
    unstable_at_start : tuple of str
        Modes beyond the level at the lowest position that could be analysed.
    searched : tuple of float
        Lowest and highest position that could be analysed, m/s or in SI units of the input.
    scan_solves, eigen_solves : int
        Eigen-solves that bracketed every boundary, and all eigen-solves.
    least : LeastDamping
        The smallest damping ratio of any mode at the points of the search, with the mode's name and the position.
    doubts : tuple of Doubt
        What makes positions of the scan doubtful, and from where to where.
    stamp : mapping of str to str
        The case and the options in force, see `proprotor.model.stamp`; empty on a line that is of no case.
    failed : tuple of Failed
        Positions of the scan that could not be analysed, with the reason: why the range searched ends where it does, or
        has gaps; then stretches over which a mode passes the level where it cannot be followed, as in a jump of the
        trim.
    """

    boundaries: tuple[Boundary, ...]
    unstable_at_start: tuple[str, ...]
    searched: tuple[float, float]
    scan_solves: int
    eigen_solves: int
    least: LeastDamping = NOWHERE
    doubts: tuple[Doubt, ...] = ()
    stamp: Stamp = {}  # noqa: RUF012 - never changed
    failed: tuple[Failed, ...] = ()

    def __repr__(self) -> str:
        """Return all boundaries of the line, which need not be airspeeds, in SI."""
        low, high = self.searched
        first = f"{len(self.boundaries)} boundaries from {low:.6g} to {high:.6g}"
        if not self.boundaries and self.least.mode:
            ratio, mode, position = self.least
            first += f"; least damping {100 * ratio:.2g} % of critical: {mode} at {position:.6g}"
        lines = [*map(repr, self.boundaries), *start_and_gaps(self.unstable_at_start, self.failed)]
        return "\n  ".join([first, *lines, *stamp.unusual_options(self.stamp)])

    def _repr_html_(self) -> str:
        """Return what a notebook shows."""
        from proprotor.stability.in_notebook import crossings_html  # here, because most uses need no HTML

        return crossings_html(self)


def start_and_gaps(
    unstable_at_start: tuple[str, ...], failed: tuple[Failed, ...], unit: str = "", factor: float = 1.0
) -> Iterator[str]:
    """Yield a line on modes beyond the level at the start, then one on each stretch that could not be analysed."""
    if unstable_at_start:
        yield f"from the start beyond the level: {', '.join(unstable_at_start)}"
    yield from (stretch.message(unit, factor) for stretch in failed)
