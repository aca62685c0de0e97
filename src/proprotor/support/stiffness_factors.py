"""Stiffness factors of a wing whose lowest frequencies are known: a factor each on beam, chord and torsion stiffness.

With shapes of unit modal mass, ω² is twice the strain energy, so that ∂ ln ω² / ∂ ln f is the share of a mode's strain
energy that the stiffness with the factor f has. Newton's method on ln f uses these shares. A last step with complex
numbers gives the derivatives of the factors, as a complex step expects.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import permutations
from typing import Any, NamedTuple

import numpy as np

from proprotor.support.beam_wing import Pylon, Wing, beam_structure
from proprotor.support.modal_reduction import StructuralModes, lowest_modes
from proprotor.typing import Array, Numbers

KINDS = ("beam", "chord", "torsion")
_STEPS = 50
_LARGEST_STEP = 1.0  # in ln f
_FURTHEST = (
    1000.0  # a larger factor, or a smaller one than its inverse, is no correction of a known stiffness
)
_DIGITS = 6  # of a sum of shares; what is beyond is rounding, and tells no order from another
_NONE = 1e-14  # of the strain energy, so that a stiffness without any moves as far as a step may
_NEAR = 1e-12  # of ω², where the steps end; rounding leaves less
_FOUND = 1e-10  # of ω², where the frequencies count as those wanted


class FittedFactors(NamedTuple):
    """Factors (...) by kind, and for each kind the reasons (...) for which there is none, "" where there is one."""

    factors: dict[str, Array]
    reasons: dict[str, Array]


def stiffened(wing: Wing, factors: Mapping[str, Numbers]) -> Wing:
    """Return the wing with its beam, chord and torsion stiffnesses times factors (...), by kind."""
    changed: dict[str, Any] = {}
    for kind, factor in factors.items():
        own = getattr(wing, f"{kind}_stiffness")
        if isinstance(own, tuple):
            changed[f"{kind}_stiffness"] = (own[0], np.asarray(factor)[..., None] * np.asarray(own[1]))
        else:
            changed[f"{kind}_stiffness"] = factor * own
    return replace(wing, **changed)


def stiffness_factors(
    wing: Wing, pylon: Pylon, at_hub: Array, frequency: Mapping[str, Numbers]
) -> FittedFactors:
    """Return the factors on a wing's stiffnesses with which its lowest modes have given frequencies.

    The three lowest modes of wing and pylon, with the rotor's mass at the hub, are the beam, the chord and the torsion
    mode, in any order: each has most of its strain energy in the stiffness of its name. Springs of the pylon and
    stiffnesses without a frequency stay as they are.

    Parameters
    ----------
    wing, pylon : Wing, Pylon
        Numbers or arrays (...) of designs; complex for derivatives by a complex step.
    at_hub : array (..., 6, 6)
        Mass of the rotor on the motions of the hub, SI.
    frequency : mapping of str to float or array (...)
        Wanted frequencies of one or more of the kinds beam, chord and torsion, rad/s.

    Returns
    -------
    FittedFactors

    Raises
    ------
    InputError
        As for `Wing`, `Pylon` and `proprotor.support.modal_reduction.lowest_modes`.
    """
    problem = _Problem.of(wing, pylon, at_hub, frequency)
    real = problem.real
    logs = np.zeros(real.wanted.shape)
    going = np.ones(logs.shape[:-1], dtype=bool)  # a design that has arrived stays, whatever company it is in
    for _ in range(_STEPS):
        left, step = real.step(logs)
        going = going & ~(np.abs(left) < _NEAR).all(axis=-1)
        if not going.any():
            break
        moved = logs + np.clip(step, -_LARGEST_STEP, _LARGEST_STEP)
        clipped = np.clip(moved, -np.log(_FURTHEST), np.log(_FURTHEST))
        logs = np.where(going[..., None], clipped, logs)
    reasons = real.reasons(logs)
    found = (reasons == "").all(axis=-1, keepdims=True)
    factors = np.exp(logs + np.where(found, problem.step(logs)[1], 0.0))
    return FittedFactors(_by_kind(factors, problem.kinds), _by_kind(reasons, problem.kinds))


def _by_kind(values: Array, kinds: tuple[str, ...]) -> dict[str, Array]:
    """Return values (..., kinds) by kind."""
    return {kind: values[..., place] for place, kind in enumerate(kinds)}


class _Problem(NamedTuple):
    """Wing, pylon and rotor, and the wanted frequencies.

    kinds : tuple of str
        Kinds whose frequencies are wanted.
    mass : array (..., n, n)
        With the rotor at the hub.
    parts : array (3, ..., n, n)
        Stiffness of beam, chord and torsion, with the springs of the pylon that belong to each.
    own : array (kinds, ..., n, n)
        What the factors multiply of these.
    stiffness : array (..., n, n)
        The whole stiffness, with factors of 1.
    wanted : array (..., kinds)
        ln ω².
    """

    kinds: tuple[str, ...]
    mass: Array
    parts: Array
    own: Array
    stiffness: Array
    wanted: Array

    @classmethod
    def of(cls, wing: Wing, pylon: Pylon, at_hub: Array, frequency: Mapping[str, Numbers]) -> _Problem:
        """Return the problem; what a factor multiplies is the difference that a factor of 2 makes."""
        kinds = tuple(kind for kind in KINDS if kind in frequency)
        once, twice = (
            beam_structure(stiffened(wing, dict.fromkeys(kinds, factor)), pylon) for factor in (1.0, 2.0)
        )
        mass = once.mass + once.hub.T @ at_hub @ once.hub
        own = [twice.stiffness_parts[kind] - once.stiffness_parts[kind] for kind in kinds]
        parts = [once.stiffness_parts[kind] for kind in KINDS]
        wanted = 2 * np.log(np.stack(np.broadcast_arrays(*(frequency[kind] for kind in kinds)), axis=-1))
        batch = np.broadcast_shapes(mass.shape[:-2], once.stiffness.shape[:-2], wanted.shape[:-1])
        whole = (*batch, *mass.shape[-2:])
        return cls(
            kinds,
            np.broadcast_to(mass, whole),
            np.stack([np.broadcast_to(part, whole) for part in parts]),
            np.stack([np.broadcast_to(part, whole) for part in own]),
            np.broadcast_to(once.stiffness, whole),
            np.broadcast_to(wanted, (*batch, len(kinds))),
        )

    @property
    def real(self) -> _Problem:
        """The problem with the real parts of all numbers."""
        return self._replace(**{name: np.real(getattr(self, name)) for name in self._fields[1:]})

    def step(self, logs: Array) -> tuple[Array, Array]:
        """Return how much ln ω² (..., kinds) lacks at ln f (..., kinds), and the step of ln f that Newton takes."""
        modes, places, _ = self._at(logs)
        shapes = np.take_along_axis(np.real(modes.shapes), places[..., None, :], axis=-1)
        square = np.take_along_axis(modes.frequency**2, places, axis=-1)
        energy = np.exp(logs)[..., None, :] * np.moveaxis(_energies(np.real(self.own), shapes), 0, -1)
        left = self.wanted - np.log(square)
        slopes = energy / np.real(square)[..., None] + _NONE * np.eye(len(self.kinds))
        return left, np.linalg.solve(slopes, left[..., None])[..., 0]

    def reasons(self, logs: Array) -> Array:
        """Return for each kind why there are no factors, "" for a kind that has one, at the end ln f (..., kinds).

        Where frequencies are out of reach, the reason stands at the one that is furthest from the wing's own.
        """
        modes, places, shares = self._at(logs)
        square = np.take_along_axis(modes.frequency**2, places, axis=-1)
        missed = (np.abs(self.wanted - np.log(square)) > _FOUND).any(axis=-1, keepdims=True)
        most = np.take_along_axis(shares, places[..., None, :], axis=-1).argmax(axis=-2)
        swapped = ~missed & (most != np.array([KINDS.index(kind) for kind in self.kinds]))
        first, places, _ = self._at(np.zeros(logs.shape))
        own = np.take_along_axis(first.frequency, places, axis=-1)
        away = np.abs(self.wanted - 2 * np.log(own))
        missed = missed & (away == away.max(axis=-1, keepdims=True))
        reasons = np.full(logs.shape, "", dtype=object)
        for at in np.argwhere(missed):
            reasons[tuple(at)] = _out_of_reach(self.kinds, own[*at[:-1]])
        for at in np.argwhere(swapped):
            reasons[tuple(at)] = _swapped(self.kinds[at[-1]], KINDS[most[tuple(at)]])
        return reasons

    def _at(self, logs: Array) -> tuple[StructuralModes, Array, Array]:
        """Return the three lowest modes, the place (..., kinds) of each kind's mode, and shares of energy.

        The shares (..., 3 kinds, 3 modes) are of the strain energy. The modes belong to the kinds in the order with the
        largest sum of shares; of equal orders, in the one that leaves the highest mode to torsion. Where no mode has
        any energy of torsion, the torsion mode is above all three.
        """
        more = np.moveaxis(np.exp(logs) - 1, -1, 0)[..., None, None]
        modes = lowest_modes(self.mass, self.stiffness + (more * self.own).sum(axis=0), len(KINDS))
        shapes, parts = np.real(modes.shapes), list(np.real(self.parts))
        for place, kind in enumerate(self.kinds):
            parts[KINDS.index(kind)] = parts[KINDS.index(kind)] + more[place] * np.real(self.own[place])
        energies = np.moveaxis(_energies(np.stack(parts), shapes), 0, -2)
        shares = energies / np.real(modes.frequency)[..., None, :] ** 2
        orders = np.array(list(permutations(range(len(KINDS)))))
        scores = shares[..., np.arange(len(KINDS)), orders].sum(axis=-1)
        order = orders[np.round(scores, _DIGITS).argmax(axis=-1)]
        return modes, order[..., [KINDS.index(kind) for kind in self.kinds]], shares


def _energies(parts: Array, shapes: Array) -> Array:
    """Return φᵀ K φ (parts, ..., k) of each part of a stiffness (parts, ..., n, n) for shapes (..., n, k)."""
    energies: Array = (shapes * (parts @ shapes)).sum(axis=-2)
    return energies


def _out_of_reach(kinds: tuple[str, ...], own: Array) -> str:
    """Return that no factors give the frequencies, and the wing's own frequencies (kinds,), rad/s."""
    listed = ", ".join(f"{kind} {hertz:.4g} Hz" for kind, hertz in zip(kinds, own / (2 * np.pi), strict=True))
    return (
        "is out of reach together with the other frequencies given: no stiffness factors from "
        f"{1 / _FURTHEST:g} to {_FURTHEST:g} were found; with factors of 1 the wing and the rotor have {listed}"
    )


def _swapped(kind: str, other: str) -> str:
    """Return that the mode with the frequency is one of another kind."""
    return (
        f"is that of a mode with most of its strain energy in {other}, not in {kind}: the modes have swapped; give the "
        "frequencies to the other modes, or a stiffness factor"
    )
