"""Pitch-flap and pitch-lag coupling of the XV-15 against airspeed, and what holds the blade's pitch besides K_θ.

    python -m benchmarks.couplings

Eqs. 36 and 37 of AIAA-2002-1604 divide by the control stiffness alone. The springs of a bent blade change their moment
as the blade pitches, and the propeller moment turns it flat: both act in parallel to the control spring, and the
whole pitch equation has K_P K_θ/(K_θ + springs + propeller) in place of K_P. Each is taken at the windmilling trim,
where the elastic pitch moves the collective and none of these.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

import proprotor as pp
from benchmarks.paper_figures.blade_state import couplings, effective_springs
from proprotor.units import KNOT

SPEEDS = np.arange(100, 401, 50) * KNOT


class PitchCouplings(NamedTuple):
    """Couplings by K_θ alone, and what else resists the pitch of a blade, N m/rad; arrays over airspeed."""

    flap: NDArray
    lag: NDArray
    control: float
    springs: NDArray
    propeller: NDArray

    @property
    def share(self) -> NDArray:
        """Of the resistance, what the control spring has."""
        return self.control / (self.control + self.springs + self.propeller)


def pitch_couplings(case: pp.Case, speeds: NDArray) -> PitchCouplings:
    """Return the couplings of a case at the trim of each airspeed (points,) in m/s."""
    rotor = case.rotor
    state = pp.rotor_model(rotor, case.operation, speeds, airloads="none", section_damping=False).trim
    springs = effective_springs(rotor, state.pitch + rotor.structural_pitch_offset)
    flap, lag = couplings(rotor, springs, state.coning, state.lag)
    curvature = (
        springs.flap_flap_stiffness_curvature * state.coning**2
        + 2 * springs.flap_lag_stiffness_curvature * state.coning * state.lag
        + springs.lag_lag_stiffness_curvature * state.lag**2
    ) / 2
    propeller = rotor.pitch_inertia * case.operation.rotor_speed**2 * np.cos(2 * state.pitch)
    return PitchCouplings(flap, lag, rotor.control_stiffness, curvature, rotor.propeller_moment * propeller)


def main() -> None:
    case = pp.load_case("xv15-uncoupled")
    found = pitch_couplings(case, SPEEDS)
    headings = ("kt", "K_Pβ", "K_Pζ", "springs/K_θ", "propeller/K_θ", "K_Pβ with all", "K_Pζ with all")
    table = Table(*headings, title=case.title)
    columns = (
        found.flap,
        found.lag,
        found.springs / found.control,
        found.propeller / found.control,
        found.flap * found.share,
        found.lag * found.share,
    )
    for speed, *numbers in zip(SPEEDS / KNOT, *columns, strict=True):
        table.add_row(f"{speed:.0f}", *(f"{number:+.3f}" for number in numbers))
    Console(width=120).print(table)


if __name__ == "__main__":
    main()
