"""Newton's method for the trim of many points by the compiled functions: all steps of a stage in one call."""

from __future__ import annotations

import numpy as np

from proprotor.compiled.plans import Search, Searched, search_trim
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
    blades = compiled_blades(balance.sections, balance.quantities, balance.options.compressibility)
    search = Search(
        unknowns=balance.free,
        rows=balance.rows,
        target=balance.target.row,
        load=balance.target.load,
        structural_offset=balance.quantities["structural_pitch_offset"],
        diagonal=balance.options.structure == "diagonal",
        unloaded=come_near,
        ends_near=come_near,
        most=most,
    )
    whole = np.array([state[name] for name in UNKNOWNS])
    found = search_trim(balance.plans, blades, search, whole, iterations, wanted)
    for name, values in zip(UNKNOWNS, whole, strict=True):
        state[name][:] = values
    return found
