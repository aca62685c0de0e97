"""Analyses that figures share: each variant of the model, and each sample, is analysed once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

import proprotor as pp
from benchmarks.paper_figures.blade_state import AS_THE_PAPER, BladeState, blade_state, on_rigid_hub
from benchmarks.paper_figures.input_ranges import RANGES
from benchmarks.paper_figures.published import PAPER_FREQUENCIES
from benchmarks.paper_figures.sample_band import Band, damping_band
from benchmarks.paper_figures.wing_modes import WingModes
from proprotor.typing import Array
from proprotor.units import KNOT

XV15 = "xv15-uncoupled"
BELL = "xv15-bell-frequencies"
# kt; slower, the neglected induced velocity is more than a twentieth of the airspeed, or the paper shows nothing
_AIRSPEEDS = {XV15: (50, 500), "xv15-mass-distribution": (50, 500), "v22-fifth-scale": (50, 250)}
_WRATS = (60, 180)

Variant = Callable[[pp.Case, Array], dict[str, Any]]  # options of a case along airspeeds (points,) in m/s


class Analyses:
    """Modes, boundaries, samples and trims of the bundled decks, kept once they are made.

    Parameters
    ----------
    step : float
        Between airspeeds, kt.
    samples : int
        Designs of an uncertainty band; with 0 there are no bands.
    seed : int
        Seed of the sample.
    """

    def __init__(self, step: float = 5.0, samples: int = 300, seed: int = 0) -> None:
        self.step, self.samples, self.seed = step, samples, seed
        self.case: Callable[[str], pp.Case] = cache(pp.load_case)
        self.wing: Callable[[str, str], WingModes] = cache(self._wing)
        self.band: Callable[..., Band | None] = cache(self._band)

    def airspeeds(self, deck: str) -> Array:
        """Return the airspeeds (points,) of a deck, m/s."""
        first, last = _AIRSPEEDS.get(deck, _WRATS)
        return np.arange(first, last + self.step / 2, self.step) * KNOT

    def knots(self, deck: str) -> Array:
        """Return the airspeeds (points,) of a deck in kt."""
        return np.round(self.airspeeds(deck) / KNOT, 9)

    def blade_state(self, deck: str) -> BladeState:
        """Return trim and couplings over the airspeeds of a deck."""
        return blade_state(self.case(deck), self.airspeeds(deck))

    def rotor_on_rigid_hub(self, **options: Any) -> dict[str, Array]:
        """Return frequencies per revolution of the XV-15's rotor modes by name."""
        return on_rigid_hub(self.case(XV15), self.airspeeds(XV15), pitch="coupling", **options)

    def options(self, deck: str, variant: str) -> dict[str, Any]:
        """Return the options of a variant of the model, see `VARIANTS`."""
        changed = VARIANTS[variant](self.case(deck), self.airspeeds(deck))
        return {"pitch": "coupling"} | AS_THE_PAPER | changed

    def _wing(self, deck: str, variant: str) -> WingModes:
        return WingModes(self.case(deck), self.airspeeds(deck), self.options(deck, variant))

    def _band(self, deck: str, variant: str = "couplings") -> Band | None:
        if not self.samples:
            return None
        options = self.options(deck, variant)
        return damping_band(
            self.case(deck), self.airspeeds(deck), RANGES[deck], self.samples, self.seed, **options
        )


def _kept_couplings(case: pp.Case, airspeeds: Array) -> dict[str, Any]:
    """Return the couplings of the model with flap-lag stiffness, each as a function of airspeed."""
    return {
        "pitch_flap_coupling": lambda airspeed: blade_state(case, airspeed).pitch_flap_coupling,
        "pitch_lag_coupling": lambda airspeed: blade_state(case, airspeed).pitch_lag_coupling,
    }


def own_frequencies(case: pp.Case, airspeeds: Array) -> pp.BladeFrequencies:
    """Return lag as this model has it in a vacuum, and coning at 1.85 per revolution, tabulated against airspeed."""
    vacuum = on_rigid_hub(case, airspeeds, airloads="none", pitch="coupling")
    lag = 1 + vacuum["low cyclic lag"]
    return replace(PAPER_FREQUENCIES, lag=lag, at=airspeeds, at_rotor_speed=case.operation.rotor_speed)


def _tabulated(frequencies: Callable[[pp.Case, Array], pp.BladeFrequencies]) -> Variant:
    """Return the variant with given frequencies of flap and lag in place of the springs."""
    return lambda case, airspeeds: (
        {
            "structure": "tabulated",
            "frequencies": frequencies(case, airspeeds),
        }
        | _kept_couplings(case, airspeeds)
    )


def _with_bell(**options: Any) -> Variant:
    """Return the variant with the blade frequencies that Bell calculated, in place of the springs of Table 1."""
    return lambda case, airspeeds: (
        {"structure": "tabulated", "frequencies": pp.load_case(BELL).frequencies} | options
    )


def _fixed(**options: Any) -> Variant:
    """Return the variant with options that are the same at each airspeed."""
    return lambda case, airspeeds: options


# What each variant changes of the paper's model: couplings in place of the pitch equations, no section damping.
VARIANTS: dict[str, Variant] = {
    "couplings": _fixed(),
    "published equations": _fixed(equations="published"),
    "pitch equations": _fixed(pitch="dynamic"),
    "pitch equations, section damping": _fixed(pitch="dynamic", section_damping=True),
    "no couplings": _fixed(pitch_flap_coupling=0.0, pitch_lag_coupling=0.0),
    "no pitch-flap coupling": _fixed(pitch_flap_coupling=0.0),
    "no pitch-lag coupling": _fixed(pitch_lag_coupling=0.0),
    "no flap-lag stiffness": lambda case, speeds: {"structure": "diagonal"} | _kept_couplings(case, speeds),
    "no flap-lag stiffness, couplings follow": _fixed(structure="diagonal"),
    "given frequencies": _tabulated(lambda case, airspeeds: PAPER_FREQUENCIES),
    "own frequencies given": _tabulated(own_frequencies),
    "Bell's frequencies, couplings": _with_bell(),
    "Bell's frequencies, pitch equations": _with_bell(pitch="dynamic"),
    "Bell's frequencies, pitch equations, section damping": _with_bell(pitch="dynamic", section_damping=True),
}
