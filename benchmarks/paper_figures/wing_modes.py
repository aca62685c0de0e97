"""The modes of a wing along airspeeds: their damping, and exactly where each loses its damping."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import xarray

import proprotor as pp
from proprotor.model.linear_model import LinearModel
from proprotor.stability.boundaries import find_crossings
from proprotor.stability.boundary import Boundary, Crossings
from proprotor.stability.branches import by_branch
from proprotor.stability.parameter_lines import ParameterLine
from proprotor.stability.sweep import sweep
from proprotor.typing import Array
from proprotor.units import KNOT

OF_THE_ROTOR = ""  # in place of a wing mode's name
_MOVES_THE_WING = 0.1  # participation of the wing from which on a mode counts as one that moves the wing


@dataclass(frozen=True, eq=False)
class WingModes:
    """The modes of a case along airspeeds that have the names of the support's coordinates.

    In the lower half of the airspeeds a wing mode is the mode that moves the wing's coordinate most: where a mode of
    the rotor meets the wing mode, the name passes from one root to the other. In the upper half, where the rotor takes
    over modes that flutter, a wing mode is the root that has its name in the middle, followed from there.

    Attributes
    ----------
    case : Case
    airspeeds : array (points,)
        m/s, rising.
    options : mapping
        See `proprotor.rotor.options.Options`. A value may be a function of the airspeeds (k,) of a model.
    """

    case: pp.Case
    airspeeds: Array
    options: Mapping[str, Any]

    @property
    def names(self) -> tuple[str, ...]:
        """The wing's modes."""
        return tuple(self.case.support.names)

    @cached_property
    def sweep(self) -> xarray.Dataset:
        """All modes at the airspeeds."""
        return sweep(self._linearize(self.airspeeds), self._line)

    @cached_property
    def crossings(self) -> Crossings:
        """All boundaries of stability within the airspeeds."""
        return find_crossings(self._line)

    def damping(self, mode: str) -> Array:
        """Return the damping (points,) of a wing mode in percent of critical; NaN at failed points."""
        by_motion = self.sweep.damping_ratio.sel(mode=mode).values
        by_root = by_branch(self.sweep).damping_ratio.sel(branch=self._roots[mode]).values
        ratio: Array = np.where(self.airspeeds <= self._middle, by_motion, by_root)
        return 100 * ratio

    @cached_property
    def onsets(self) -> dict[str, Boundary]:
        """The first onset of instability of each wing mode that has one, and of the rotor's modes."""
        found = [boundary for boundary in self.crossings.boundaries if boundary.onset]
        return {self._wing_mode_at(boundary): boundary for boundary in reversed(found)}

    def speed(self, mode: str) -> float:
        """Return the airspeed in kt at which a wing mode first becomes unstable; infinite where none is found."""
        if mode in self.crossings.unstable_at_start:
            return self._lowest
        return self.onsets[mode].position / KNOT if mode in self.onsets else np.inf

    @cached_property
    def unstable_at_start(self) -> bool:
        """Whether a mode that moves the wing is unstable at the lowest airspeed."""
        modes = self._linearize(self.airspeeds[:1]).modes()
        share = modes.participation.sel(dof=list(self.names)).sum("dof")
        return bool(((modes.damping_ratio < 0) & (share >= _MOVES_THE_WING)).any())

    @property
    def first_speed(self) -> float:
        """The lowest airspeed in kt at which a mode that moves the wing becomes unstable; infinite without one."""
        if self.unstable_at_start:
            return self._lowest
        return self.first_onset.position / KNOT if self.first_onset else np.inf

    @property
    def first_onset(self) -> Boundary | None:
        """The lowest boundary beyond which a mode that moves the wing is unstable."""
        onsets = (boundary for boundary in self.crossings.boundaries if boundary.onset)
        return next((boundary for boundary in onsets if self._moves_the_wing(boundary)), None)

    @cached_property
    def _line(self) -> ParameterLine:
        return ParameterLine(self.airspeeds, self._linearize)

    def _linearize(self, airspeed: Array) -> LinearModel:
        given = {name: value(airspeed) if callable(value) else value for name, value in self.options.items()}
        return self.case.linearize(airspeed, **given)

    @property
    def _lowest(self) -> float:
        return self.crossings.searched[0] / KNOT

    @property
    def _middle(self) -> float:
        return float(self.airspeeds[len(self.airspeeds) // 2])

    @cached_property
    def _roots(self) -> dict[str, str]:
        """The label of the root that each wing mode has in the middle of the airspeeds."""
        middle = self.sweep.branch.isel(airspeed=len(self.airspeeds) // 2)
        return {name: str(middle.sel(mode=name).item()) for name in self.names}

    def _wing_mode_at(self, boundary: Boundary) -> str:
        """Return the name of the wing mode that crosses at a boundary, or `OF_THE_ROTOR`."""
        if boundary.position <= self._middle:
            return boundary.mode if boundary.mode in self.names else OF_THE_ROTOR
        return {root: name for name, root in self._roots.items()}.get(boundary.branch, OF_THE_ROTOR)

    def _moves_the_wing(self, boundary: Boundary) -> bool:
        return sum(boundary.mechanism.get(name, 0.0) for name in self.names) >= _MOVES_THE_WING
