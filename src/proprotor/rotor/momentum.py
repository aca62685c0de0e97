"""The trim with induced velocity by momentum theory: T = 2ρA λ(V + λ), uniform over the disk, in axial flight.

Blades know of the induced velocity by the air that comes through the disk, V + λ in place of V. So the trim with
induced velocity is the trim without it at another axial velocity, and λ is the one unknown of

    g(λ) = T(V + λ) - 2ρA λ(V + λ)

Newton's method takes the slope of the thrust along the trims by a complex step. Momentum theory has two roots; the one
that is zero without thrust has V + 2λ > 0. Each point stops by itself, whatever the other points of a batch do.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from proprotor_equations import inflow

from proprotor.rotor.generated import evaluate
from proprotor.rotor.options import Options
from proprotor.rotor.section_loads import BladeSections
from proprotor.rotor.trim import THRUST, Target
from proprotor.rotor.trim_balance import is_last
from proprotor.rotor.trim_solver import Settled, solve_trim
from proprotor.typing import Array

_ITERATIONS = 30
_STEP = 1e-30  # of the complex step, m/s
_NO_FLOW = (
    "momentum theory has no induced velocity for this thrust: the mass flow V + λ of the harmonics or V + 2λ of the "
    "uniform inflow would not be positive"
)
_NO_AIR = "no dynamic inflow in a vacuum: there is no air that could move"
_NOT_FOUND = "no trim with induced velocity found: Newton did not converge"


def with_induced(
    sections: BladeSections,
    few: BladeSections,
    quantities: Mapping[str, Any],
    options: Options,
    target: Target,
    points: int,
) -> Settled:
    """Return the trim with induced velocity, whose quantities have the air through the disk as the airspeed.

    Parameters
    ----------
    sections, few, quantities, options, target, points
        As for `proprotor.rotor.trim_solver.solve_trim`. Complex numbers have small imaginary parts: the trim is exact
        to first order in these parts.

    Returns
    -------
    Settled
        With `trim.inflow`; points without a root of momentum theory have failed.
    """
    whole = _Rotor(sections, few, quantities, options, target, points)
    real = whole.real
    induced, reason = real.induced()
    if options.inflow_is_dynamic:
        reason[(reason == "") & real.in_vacuum()] = _NO_AIR
    if whole.is_complex:
        _, slope, _ = real.left(induced)
        left, *_ = whole.left(induced, slope=False)
        induced = induced - 1j * left.imag / slope
    induced = np.where(reason == "", induced, np.nan)  # so that these points fail
    settled = whole.trimmed(induced)
    told = np.where(reason == "", settled.trim.reason, reason).astype(object)
    return replace(settled, trim=replace(settled.trim, inflow=induced, reason=told))


@dataclass(frozen=True)
class _Rotor:
    """What is known of all points before the search."""

    sections: BladeSections
    few: BladeSections
    quantities: Mapping[str, Any]
    options: Options
    target: Target
    points: int

    @property
    def is_complex(self) -> bool:
        """Whether any number has an imaginary part."""
        numbers = (*self.quantities.values(), self.target.collective, self.target.load)
        return self.sections.is_complex or any(map(np.iscomplexobj, numbers))

    @property
    def real(self) -> _Rotor:
        """The same without imaginary parts."""
        collective = None if self.target.collective is None else np.real(self.target.collective)
        sections = self.sections.real
        return replace(
            self,
            sections=sections,
            few=sections if self.few is self.sections else self.few.real,
            quantities={name: np.real(value) for name, value in self.quantities.items()},
            target=replace(self.target, collective=collective, load=np.real(self.target.load)),
        )

    def induced(self) -> tuple[Array, Array]:
        """Return the induced velocity (points,) and reasons of the points that have none, empty for the others."""
        airspeed, size = self._each("airspeed"), self._each("rotor_speed") * self._each("radius")
        reason, before = np.full(self.points, "", dtype=object), np.full(self.points, np.inf)
        with np.errstate(all="ignore"):
            found = self._first_guess()
            unknown = ~np.isfinite(found) | ~(airspeed >= 0)
            found[unknown] = 0.0
            going = np.arange(self.points)
            for _ in range(_ITERATIONS):
                if not len(going):
                    return found, reason
                left, slope, failed = (part[going] for part in self.left(found))
                step = np.where((failed != "") | (left == 0), 0.0, left / slope)
                found[going] -= step
                flows = ~unknown[going] & (airspeed[going] + 2 * found[going] > 0)
                reason[going] = np.where((failed == "") & ~flows, _NO_FLOW, failed)
                share = np.abs(step) / size[going]
                done = is_last(share, before[going]) | (reason[going] != "")
                before[going] = share
                found[going[reason[going] != ""]] = 0.0
                going = going[~done]
        reason[going] = _NOT_FOUND
        return found, reason

    def in_vacuum(self) -> Array:
        """Return the points (points,) without air, whose inflow could have no states."""
        return np.asarray(self._each("density") == 0)

    def left(self, induced: Array, slope: bool = True) -> tuple[Array, Array, Array]:
        """Return g (points,), its slope with the induced velocity, and reasons of points without a trim."""
        step = 1j * _STEP if slope else 0.0
        trim = self.trimmed(induced + step).trim
        by_momentum = self._momentum(induced)
        thrust = trim.thrust.real if slope else trim.thrust
        by_speed = trim.thrust.imag / _STEP - by_momentum.uniform_mass_flow
        return thrust - by_momentum.momentum_thrust, by_speed, trim.reason

    def trimmed(self, induced: Array) -> Settled:
        """Return the trim with the air through the disk as the airspeed."""
        through = self.quantities["airspeed"] + induced
        given = {**self.quantities, "airspeed": through}
        return solve_trim(self.sections, self.few, given, self.options, self.target, self.points)

    def _momentum(self, induced: Array) -> Any:
        through = self.quantities["airspeed"] + induced
        return evaluate(
            inflow.momentum, {**self.quantities, "induced_velocity": induced, "axial_flow": through}
        )

    def _first_guess(self) -> Array:
        """Return the root of momentum theory for the thrust that is asked for, or that is there without inflow.

        Power that is put in stands for the thrust of a rotor without losses, which has one without airspeed too. A
        thrust without a root is the end of it only where this thrust is asked for. At a given collective or power
        induced velocity changes the thrust, and Newton starts without any: as what is left curves downwards, the
        steps go down to the root and not past it.
        """
        airspeed, load = self._each("airspeed"), self._spread(self.target.load) * self._each("n_blades")
        disk = 2 * self._each("density") * np.pi * self._each("radius") ** 2
        disk = np.where(disk > 0, disk, np.inf)  # in a vacuum no air is moved
        if not self.target.finds_collective:
            thrust = np.nan_to_num(self.trimmed(np.zeros(self.points)).trim.thrust)
        elif self.target.row == THRUST:
            thrust = load
        elif self.target.windmilling:
            thrust = np.zeros(self.points)
        else:
            power = -load * self._each("rotor_speed")
            thrust = power / (airspeed + np.cbrt(np.maximum(power, 0.0) / disk))
        root = np.asarray((np.sqrt(airspeed**2 + 4 * thrust / disk) - airspeed) / 2)
        asked = self.target.finds_collective and self.target.row == THRUST
        return root if asked else np.where(np.isnan(root), 0.0, root)

    def _each(self, name: str) -> Array:
        return self._spread(self.quantities[name])

    def _spread(self, value: Any) -> Array:
        return np.broadcast_to(value, (self.points,))
