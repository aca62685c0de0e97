"""Analyses that figures share: each model and each sample is made once."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmarks.paper_figures.blade_state import AS_THE_PAPER, BladeState, blade_state, on_rigid_hub
from benchmarks.paper_figures.input_ranges import RANGES
from benchmarks.paper_figures.mode_following import follow_support_modes
from benchmarks.paper_figures.published import PAPER_FREQUENCIES
from benchmarks.paper_figures.uncertainty_band import Band, boundary, damping_band, least_damping
from proprotor.case import load_case
from proprotor.model.doubts import MARK, doubts_along, footnotes
from proprotor.rotor.blade_frequencies import BladeFrequencies
from proprotor.typing import Array
from proprotor.units import KNOT

if TYPE_CHECKING:
    from proprotor.case import Case
    from proprotor.model.linear_model import LinearModel

XV15 = "xv15"
# kt; slower, the neglected induced velocity is more than a twentieth of the airspeed, or the paper shows nothing
_AIRSPEEDS = {XV15: (50, 500), "xv15-mass-distribution": (50, 500), "v22-fifth-scale": (50, 250)}
_WRATS = (60, 180)


class Analyses:
    """Models, samples and trims of the bundled decks, kept once they are made.

    Parameters
    ----------
    step : float
        Between airspeeds, kt.
    samples : int
        Designs of an uncertainty band; none at all with 0.
    seed : int
        Of the sample.
    advance : callable
        Told the share of a sample that was analysed since it was told last.
    """

    def __init__(
        self,
        step: float = 5.0,
        samples: int = 300,
        seed: int = 0,
        advance: Callable[[float], object] = lambda share: None,
    ) -> None:
        self.step, self.samples, self.seed, self.advance = step, samples, seed, advance
        self.case: Callable[[str], Case] = lru_cache(load_case)
        self.model: Callable[[str, str], LinearModel] = lru_cache(self._linearized)
        self.band: Callable[..., Band | None] = lru_cache(self._sampled)

    def airspeeds(self, deck: str) -> Array:
        """Airspeeds (points,) of a deck, m/s."""
        first, last = _AIRSPEEDS.get(deck, _WRATS)
        return np.arange(first, last + self.step / 2, self.step) * KNOT

    def knots(self, deck: str) -> Array:
        """The same in kt."""
        return np.round(self.airspeeds(deck) / KNOT, 9)

    def damping(self, deck: str, mode: str, variant: str) -> Array:
        """Damping (points,) of a mode of the wing in percent of critical; NaN at failed points."""
        values = self._followed(deck, variant)[:, self.case(deck).support.names.index(mode)]
        return -100 * values.real / np.abs(values)

    def doubts(self, deck: str) -> list[str]:
        """Sentences on where the model is doubtful, and why."""
        doubts = doubts_along(self.knots(deck), self.warnings(deck))
        return [f"{MARK} {line}" for line in footnotes(doubts, "kt")]

    def warnings(self, deck: str) -> Array:
        """What makes the airspeeds (points,) of a deck doubtful."""
        warnings: Array = self.model(deck, "couplings").trim.warning[0]
        return warnings

    def boundary(self, deck: str, variant: str) -> float:
        """Lowest boundary of a mode that moves the wing, kt; infinite beyond the last airspeed."""
        return float(boundary(self.knots(deck), least_damping(self.model(deck, variant)))[0])

    def blade_state(self, deck: str) -> BladeState:
        """Trim and couplings over the airspeeds of a deck."""
        return blade_state(self.case(deck), self.airspeeds(deck))

    @cached_property
    def rotor_on_rigid_hub(self) -> Callable[..., dict[str, Array]]:
        """Frequencies per rev of the XV-15's rotor modes by options."""

        def frequencies(**options: Any) -> dict[str, Array]:
            return on_rigid_hub(self.case(XV15), self.airspeeds(XV15), pitch="coupling", **options)

        return frequencies

    def _linearized(self, deck: str, variant: str) -> LinearModel:
        return self.case(deck).linearize(self.airspeeds(deck)[None], **self.options(deck, variant))

    def _followed(self, deck: str, variant: str) -> Array:
        followed: Array = follow_support_modes(self.model(deck, variant))[0]
        return followed

    def _sampled(self, deck: str, variant: str = "couplings") -> Band | None:
        if not self.samples:
            return None
        return damping_band(
            self.case(deck),
            self.airspeeds(deck),
            RANGES[deck],
            count=self.samples,
            seed=self.seed,
            advance=self.advance,
            **self.options(deck, variant),
        )

    def options(self, deck: str, variant: str) -> dict[str, Any]:
        """Options of the model of a variant, see `VARIANTS`."""
        return {"pitch": "coupling"} | AS_THE_PAPER | VARIANTS[variant](self, deck)


def _kept_couplings(analyses: Analyses, deck: str) -> dict[str, Array]:
    state = analyses.blade_state(deck)
    return {
        "pitch_flap_coupling": state.pitch_flap_coupling,
        "pitch_lag_coupling": state.pitch_lag_coupling,
    }


def own_frequencies(analyses: Analyses, deck: str) -> BladeFrequencies:
    """Lag as this model has it in a vacuum, and coning at 1.85 per rev, given against airspeed."""
    vacuum = on_rigid_hub(analyses.case(deck), analyses.airspeeds(deck), airloads="none", pitch="coupling")
    lag = 1 + vacuum["low cyclic lag"]
    return BladeFrequencies(
        flap=PAPER_FREQUENCIES.flap, lag=lag, against="airspeed", at=analyses.airspeeds(deck)
    )


# What each variant changes of the paper's model: couplings in place of the pitch equations, no section damping.
VARIANTS: dict[str, Callable[[Analyses, str], dict[str, Any]]] = {
    "couplings": lambda analyses, deck: {},
    "published equations": lambda analyses, deck: {"equations": "published"},
    "pitch equations": lambda analyses, deck: {"pitch": "dynamic"},
    "pitch equations, section damping": lambda analyses, deck: {"pitch": "dynamic", "section_damping": True},
    "no couplings": lambda analyses, deck: {"pitch_flap_coupling": 0.0, "pitch_lag_coupling": 0.0},
    "no pitch-flap coupling": lambda analyses, deck: {"pitch_flap_coupling": 0.0},
    "no flap-lag stiffness": lambda analyses, deck: (
        {"structure": "diagonal"} | _kept_couplings(analyses, deck)
    ),
    "no flap-lag stiffness, couplings follow": lambda analyses, deck: {"structure": "diagonal"},
    "given frequencies": lambda analyses, deck: (
        {"structure": "tabulated", "frequencies": PAPER_FREQUENCIES} | _kept_couplings(analyses, deck)
    ),
    "own frequencies given": lambda analyses, deck: (
        {"structure": "tabulated", "frequencies": own_frequencies(analyses, deck)}
        | _kept_couplings(analyses, deck)
    ),
}
