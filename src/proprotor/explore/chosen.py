"""What a reader has set on the page, beside what the page began with."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from proprotor.case import Case
from proprotor.typing import Array


class Chosen:
    """The settings of one reader's page.

    Attributes
    ----------
    case : Case
        The case of the deck.
    values : dict of str to float
        Inputs that differ from the deck, SI values by path.
    airspeeds : array (points,)
        m/s.
    options : dict
        All options of the model.
    first_airspeeds, first_options : array, mapping
        Those that the page began with.
    """

    def __init__(self, case: Case, airspeeds: Array, options: Mapping[str, Any]) -> None:
        self.case, self.first_airspeeds, self.first_options = case, airspeeds, dict(options)
        self.reset()

    def reset(self) -> None:
        """Go back to what the page began with."""
        self.values: dict[str, float] = {}
        self.airspeeds, self.options = self.first_airspeeds, dict(self.first_options)

    @property
    def are_of_deck(self) -> bool:
        """Whether inputs and options are those that the page began with."""
        return not self.values and self.options == self.first_options

    @property
    def varied(self) -> Case:
        """The case with the inputs that were set."""
        return self.case.vary(self.values) if self.values else self.case

    @property
    def rotor_speed(self) -> float:
        """rad/s."""
        return self.values.get("operation.rotor_speed", float(self.case.operation.rotor_speed))
