"""Newton's method for the trim of many points by the compiled functions: all steps of a stage in one call."""

from __future__ import annotations

import numpy as np

from proprotor.compiled.plans import Blades, Search, Searched, search_trim
from proprotor.rotor.fused_balance import compiled_blades
from proprotor.rotor.trim import UNKNOWNS
from proprotor.rotor.trim_balance import Balance, State
from proprotor.typing import Array


def serves(balance: Balance) -> bool:
    """Return whether the compiled functions search the trim of these blades: straight lift lines, alike stations."""
    return balance.compiled and balance.fused and balance.sections.quadrature.counts.ndim == 1


def searched(
    balance: Balance, state: State, rows: Array, iterations: Array, most: int, come_near: bool
) -> Searched:
    """Move the state of some points to their trims, or near them from the undeflected blade without loads."""
    wanted = np.zeros(balance.points, dtype=bool)
    wanted[rows] = True
    whole = np.array([state[name] for name in UNKNOWNS])
    search = stage(balance, most, come_near)
    found = search_trim(balance.plans, blades_of(balance), search, whole, iterations, wanted)
    for name, values in zip(UNKNOWNS, whole, strict=True):
        state[name][:] = values
    return found


def stage(balance: Balance, most: int, come_near: bool) -> Search:
    """Return a stage of the search: from the undeflected blade near the trim, or on to the trim."""
    return Search(
        unknowns=tuple(balance.free),
        rows=tuple(balance.rows),
        target=balance.target.row,
        diagonal=balance.options.structure == "diagonal",
        unloaded=come_near,
        ends_near=come_near,
        most=most,
    )


def blades_of(balance: Balance) -> Blades:
    """Return the blades of a balance for the compiled plans."""
    target, quantities = balance.target, balance.quantities
    return compiled_blades(
        balance.sections,
        quantities,
        balance.options.compressibility,
        load=target.load,
        collective=0.0 if target.collective is None else target.collective,
        structural_offset=quantities["structural_pitch_offset"],
    )
