"""What the model says to targets, with exact derivatives by the inputs.

At the first design a mode is found by its name. From there on it is the root nearest to where the derivatives say that
it moved: a name could pass to another root where two of them exchange their motions.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from proprotor.calibration.targets import Target
from proprotor.deck.vary import inputs_at, vary
from proprotor.errors import InputError, check_known
from proprotor.model.configuration import Configuration
from proprotor.model.doubts import reasons_for_doubt
from proprotor.stability import damping_rate, decomposition, eigenvalue_rates
from proprotor.stability.named_modes import named_modes
from proprotor.tables.points import FREQUENCY
from proprotor.typing import Array


class _Roots(NamedTuple):
    """Roots of the targets at a design: values (targets,), and derivatives (targets, inputs), SI."""

    values: Array
    rates: Array


@dataclass
class Predictor:
    """The numbers of targets at designs of a case.

    Parameters
    ----------
    case : Case
    paths : sequence of str
        Inputs that vary.
    targets : sequence of Target
    options : mapping
        Of the model.
    at : array (inputs,)
        Design at which `roots` are known.
    roots : _Roots
    """

    case: Configuration
    paths: Sequence[str]
    targets: Sequence[Target]
    options: Mapping[str, Any]
    at: Array = field(init=False)
    roots: _Roots = field(init=False)

    def __post_init__(self) -> None:
        self.at = start_of(self.case, self.paths)
        found = np.empty(len(self.targets), dtype=complex)
        for airspeed, places in self._by_airspeed():
            names, modes, *_ = named_modes(self.case, airspeed, None, self.options)
            for place in places:
                check_known("mode", self.targets[place].mode, names, "mode")
                found[place] = modes.values[names.index(self.targets[place].mode)]
        self.roots = self._with_rates(self.at, found)

    def values(self, design: Array) -> Array:
        """Return the numbers of the targets (targets,) at a design (inputs,); NaN where it cannot be analysed."""
        return _numbers(self.targets, self._roots_at(design))

    def move_to(self, design: Array) -> Array:
        """Take a design as the one from which others are reached; return the derivatives of the numbers there.

        Returns
        -------
        array (targets, inputs)
            SI units of the number per SI unit of the input.
        """
        self.roots = self._with_rates(design, self._roots_at(design))
        self.at = design.copy()
        return _derivatives(self.targets, self.roots)

    def names_and_doubts(self, design: Array) -> tuple[list[str], list[str]]:
        """Return what moves in the root of each target at a design, and what makes the model doubtful there."""
        found, doubts = [""] * len(self.targets), []
        values = self._roots_at(design)
        for airspeed, places in self._by_airspeed():
            names, modes, model, _ = named_modes(self.design(design), airspeed, None, self.options)
            doubts.append(str(model.trim.warning))
            for place in places:
                found[place] = names[int(np.argmin(np.abs(modes.values - values[place])))]
        return found, list(reasons_for_doubt(doubts))

    def design(self, values: Array) -> Configuration:
        """Return the case with some values of the inputs."""
        return vary(self.case, dict(zip(self.paths, values.tolist(), strict=True)))

    def _by_airspeed(self) -> list[tuple[float, list[int]]]:
        """Return the airspeeds with the places of their targets."""
        groups: dict[float, list[int]] = {}
        for place, target in enumerate(self.targets):
            groups.setdefault(target.airspeed, []).append(place)
        return list(groups.items())

    def _roots_at(self, design: Array) -> Array:
        """Return the roots (targets,) that those of the known design become at another."""
        moved = self.roots.values + self.roots.rates @ (design - self.at)
        found = np.full(len(self.targets), complex(np.nan, np.nan))
        try:
            case = self.design(design)
            groups = self._by_airspeed()
            model = case.linearize(np.array([airspeed for airspeed, _ in groups]), **self.options)
        except InputError:  # a design outside what is physical
            return found
        spectrum = decomposition(model)
        for point, (_, places) in enumerate(groups):
            if not model.trim.reason[point]:
                own = spectrum.at(point)
                found[places] = own.values[own.nearest(moved[places])]
        return found

    def _with_rates(self, design: Array, values: Array) -> _Roots:
        """Return roots at a design with their derivatives."""
        case = self.design(design)
        inputs = inputs_at(case, self.paths)
        rates = np.empty((len(values), len(self.paths)), dtype=complex)
        for airspeed, places in self._by_airspeed():
            model = case.linearize(airspeed, **self.options)
            spectrum = decomposition(model)
            modes = spectrum.modes(spectrum.nearest(values[places]))
            rates[places] = eigenvalue_rates(case, inputs, airspeed, modes, model, self.options)[0].T
        return _Roots(values, rates)


def _numbers(targets: Sequence[Target], roots: Array) -> Array:
    is_frequency = np.array([target.quantity == FREQUENCY for target in targets])
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(is_frequency, np.abs(roots.imag), -roots.real / np.abs(roots))


def start_of(case: Configuration, paths: Sequence[str]) -> Array:
    """Return the values of the deck (inputs,), SI."""
    return np.array([float(number.si) for number in inputs_at(case, paths).values()])


def _derivatives(targets: Sequence[Target], roots: _Roots) -> Array:
    is_frequency = np.array([[target.quantity == FREQUENCY] for target in targets])
    values = roots.values[:, None]
    frequency = np.sign(values.imag) * roots.rates.imag
    return np.where(is_frequency, frequency, damping_rate(values, roots.rates))
