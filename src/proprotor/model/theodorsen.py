"""Lift that lags by Theodorsen's function itself: a model for each frequency, without states of its own.

A motion of the fixed frame with exp(iωt) reaches a blade with the frequencies ω - Ω, ω and ω + Ω, and its loads come
back with ω. With T_h for the harmonics of the transform to a blade, h = -1, 0 and 1, each section of the blade takes
off

    N Σ_h T_-hᵀ W (1 - C(k_h)) (i ω_h R + D) T_h        ω_h = ω + hΩ,   k_h = ω_h c/2U

from the loads of lift at once, with its work W and the changes R and D of its circulation by rates and displacements.
The strips of a wing meet ω alone. At one frequency this is a damping with an imaginary part.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from proprotor_equations import FIXED_COORDINATES
from proprotor_equations import coordinates as of_blade
from proprotor_equations.coordinates import SWASHPLATE

from proprotor.errors import InputError
from proprotor.model.configuration import Configuration
from proprotor.model.lift_lag import LaggingBlade, lagging_blade
from proprotor.model.linear_model import LinearModel
from proprotor.model.mount import mount
from proprotor.model.pair import rotors_on
from proprotor.model.quantities import couplings, model_quantities
from proprotor.rotor.operation import Operation
from proprotor.rotor.options import Options
from proprotor.rotor.rotor import Rotor
from proprotor.rotor.section_loads import BladeSections
from proprotor.rotor.trim import UNKNOWNS, with_trim
from proprotor.support.airframe import Airframe
from proprotor.support.normal_modes import NormalModes
from proprotor.typing import Array

_HARMONICS = (-1, 0, 1)
_AZIMUTHS = 4  # enough to tell the harmonics apart
_PITCH = [place for place, name in enumerate(FIXED_COORDINATES) if name.startswith("pitch_")]


def _theodorsen(reduced_frequency: Array) -> Array:
    """Return C(k), complex, of a section whose flow changes with exp(+iωt); 1 at k = 0, the conjugate at -k."""
    from scipy.special import kve  # here, because scipy takes long to import

    k = np.abs(np.asarray(reduced_frequency, dtype=float))
    moving = k > 0
    argument = 1j * np.where(moving, k, 1.0)
    first, zeroth = kve(1, argument), kve(0, argument)
    found = np.where(moving, first / (first + zeroth), 1.0)
    return np.where(np.asarray(reduced_frequency) < 0, np.conj(found), found)


def at_frequencies(model: LinearModel, frequency: Array) -> Iterator[LinearModel]:
    """Return models whose lift comes late by C(k), one frequency (rad/s) after the other; C and B are complex.

    Parameters
    ----------
    model : LinearModel
        Of a case, with lift at once.
    frequency : array (frequencies,)
        rad/s, not negative.

    Raises
    ------
    InputError
        For a model that belongs to no case, whose lift lags already, or whose airloads have no lag.
    """
    return _models(model, frequency, *_checked(model))


def _models(
    model: LinearModel, frequency: Array, case: Configuration, choice: Options
) -> Iterator[LinearModel]:
    rotors = [_LateRotor.of(case.rotor, case.operation, choice, model, model)]
    if case.left is not None and model.left is not None and model.left.origin is not None:
        of_left = model.left.origin.options
        rotors.append(_LateRotor.of(case.left.rotor, case.left.operation, of_left, model, model.left))
    wing = case.support.wing_circulation(model.airspeed, case.operation.density)
    support = case.support.at(model.airspeed, case.operation.density)
    for omega in frequency:
        added = [rotor.added(float(omega), model) for rotor in rotors]
        whole = _on_support(added, support).submodel(model.dofs)
        damping, stiffness = model.C + whole.C, model.K + whole.K
        if wing is not None and omega:
            late = (1 - _theodorsen(omega / wing.way))[..., None, None]
            own = slice(len(support.names))
            damping[..., own, own] -= late * (wing.damping + wing.stiffness / (1j * omega))
        right = _joined(model.rotor, added[0])
        left = None if model.left is None else _joined(model.left, added[-1])
        assert model.B is not None and whole.B is not None
        yield replace(model, C=damping, K=stiffness, B=model.B + whole.B, rotor=right, left=left)


def _checked(model: LinearModel) -> tuple[Configuration, Options]:
    """Return case and options of a model; refuse a model without a blade, or with a lag of its own."""
    if model.origin is None or model.origin.case is None or model.rotor is None:
        rule = "goes with a model of a case, from Case.linearize, whose blades it needs"
        raise InputError("lift", "theodorsen", rule)
    choice = model.origin.options
    if choice.lift != "quasi-steady":
        raise InputError(
            "lift", "theodorsen", f'goes with a model whose lift is quasi-steady, not "{choice.lift}"'
        )
    if choice.has_inflow:
        rule = f'goes with inflow="none", not "{choice.inflow}": a part of the wake would count twice'
        raise InputError("lift", "theodorsen", rule)
    choice.check_blades_may_lag("theodorsen")
    return model.origin.case, choice


@dataclass(frozen=True)
class _LateRotor:
    """What each section of a rotor at trim does: its motions, its work, and how far the air goes meanwhile.

    blade : of one shape function for each section; way (points, k) : half chords per second; rotor_speed (points,) and
    n_blades; follows : whether the blades follow the swashplate at once.
    """

    blade: LaggingBlade
    way: Array
    rotor_speed: Array
    n_blades: Array
    follows: bool

    @classmethod
    def of(
        cls, rotor: Rotor, operation: Operation, choice: Options, model: LinearModel, trimmed: LinearModel
    ) -> _LateRotor:
        """Return the rotor of a case at the trim of a model."""
        shape = model.M.shape[:-2]
        given = model_quantities(rotor, operation, choice, model.airspeed, shape)
        state = {name: np.broadcast_to(getattr(trimmed.trim, name), shape).reshape(-1) for name in UNKNOWNS}
        quantities = with_trim(given, choice, state)
        quantities |= couplings(choice, quantities)
        points = int(np.prod(shape, dtype=int))
        blade = lagging_blade(BladeSections.of(rotor, shape), quantities, points, choice, _each_section)
        way = np.diagonal(blade.decay, axis1=-2, axis2=-1) / np.diagonal(blade.weight, axis1=-2, axis2=-1)
        speed, count = (np.broadcast_to(quantities[name], points) for name in ("rotor_speed", "n_blades"))
        return cls(blade, way, speed, count, not choice.pitch_is_free)

    def added(self, omega: float, model: LinearModel) -> LinearModel:
        """Return what the lag adds to a rotor alone at one frequency, on its coordinates in the model."""
        by_motion, by_displacement, by_gusts = self._matrices(omega)
        of_swashplate = np.zeros((*by_motion.shape[:-1], len(SWASHPLATE)))
        if self.follows:  # rates of the swashplate are left out, as they are without lag
            of_swashplate = -by_displacement[..., _PITCH]
        assert model.rotor is not None
        rotor, shape = model.rotor, model.M.shape[:-2]
        own = np.equal.outer(np.array(FIXED_COORDINATES), np.array(rotor.dofs)).astype(float)
        whole = (own.T @ by_motion @ own).reshape(*shape, *rotor.M.shape[-2:])
        loads = own.T @ np.concatenate([of_swashplate, -by_gusts], axis=-1)
        damping, stiffness = whole / (1j * omega) if omega else 0 * whole, np.zeros(whole.shape)
        if not omega:  # only displacements count, of coordinates that have any
            held = [name not in (*model.azimuths, *rotor.rates) for name in rotor.dofs]
            stiffness = whole.real * held
        return replace(
            rotor,
            M=np.zeros(whole.shape),
            C=damping,
            K=stiffness,
            B=loads.reshape(*shape, *loads.shape[-2:]),
            mass_at_rest=None,
        )

    def _matrices(self, omega: float) -> tuple[Array, Array, Array]:
        """Return loads (points, 18, n) that come late by motions with exp(iωt), by displacements alone, by gusts."""
        found: list[Any] = [0.0, 0.0, 0.0]
        for harmonic in _HARMONICS:
            turning = harmonic * self.rotor_speed
            late = np.moveaxis(1 - _theodorsen((omega + turning)[..., None] / self.way), -1, 0)[..., None]
            held = self.n_blades[:, None] * self.blade.work * late
            there, back = _transform(harmonic), np.swapaxes(_transform(-harmonic), -1, -2)
            by_rates, by_displacements, by_gusts = (
                back @ np.einsum("kpi,kpj->pij", held, change) @ to_blade
                for change, to_blade in (
                    (self.blade.by_rates, there),
                    (self.blade.by_displacements, there),
                    (self.blade.by_gusts, there[:3, :3]),  # gusts turn as the motion of the hub does
                )
            )
            by_displacements = by_displacements + 1j * turning[:, None, None] * by_rates
            parts = 1j * omega * by_rates + by_displacements, by_displacements, by_gusts
            found = [whole + part for whole, part in zip(found, parts, strict=True)]
        by_motion, by_displacement, by_gust = found
        return by_motion, by_displacement, by_gust


def _each_section(share: Array) -> Array:
    """Return shape functions that are one at one section each."""
    return np.eye(np.shape(share)[-1])


def _transform(harmonic: int) -> Array:
    """Return a harmonic (12, 18) of the transform from the fixed frame to a blade."""
    psi = 2 * np.pi * np.arange(_AZIMUTHS) / _AZIMUTHS
    waves = np.exp(-1j * harmonic * psi)[:, None, None]
    return np.asarray((of_blade.transform(psi=psi) * waves).mean(axis=0))


def _on_support(rotors: list[LinearModel], support: NormalModes) -> LinearModel:
    """Return what the lag adds to one rotor, or to two, on the coordinates of the support and of the rotors."""
    if isinstance(support, Airframe):
        return rotors_on(rotors[0], support, rotors[1] if len(rotors) > 1 else None)
    nothing = np.zeros_like(support.mass)
    carrier = replace(support, mass=nothing, damping=nothing, stiffness=nothing, includes_rotor=False)
    return mount(rotors[0], carrier)


def _joined(rotor: LinearModel | None, added: LinearModel) -> LinearModel:
    """Return a rotor alone with what the lag adds to it."""
    assert rotor is not None and rotor.B is not None and added.B is not None
    return replace(rotor, C=rotor.C + added.C, K=rotor.K + added.K, B=rotor.B + added.B)
