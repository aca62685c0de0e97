"""Doubts about the units of a structure from a file, by what its masses amount to beside the rotor.

A file has no units. Inches, millimetres, lbf s²/in or tonnes that nobody named make masses and lengths 40 to 1000 times
too large or too small. Where the modes include the rotor, a structure that is too light is refused already, see
`proprotor.model.rotor_share`. Feet and slugs, factors of 3 and 15, are within the spread of structures and not seen.
"""

from __future__ import annotations

import numpy as np

from proprotor.errors import InputError
from proprotor.model.rotor_share import without_rotors
from proprotor.rotor.motions import HUB
from proprotor.support.modal_reduction import lowest_modes
from proprotor.support.normal_modes import NormalModes
from proprotor.typing import Array

# Bundled decks have 0.2 to 1.6 times the mass of the rotor, and 0.8 to 3.3 times its radius of gyration.
_MASS, _LENGTH = (0.02, 50.0), (1 / 12, 12.0)
_MODES = 6
_TILT = HUB.index("alpha_x")
_MOVES, _TURNS = slice(0, 3), slice(3, 6)  # of the hub's coordinates


def unit_warnings(support: NormalModes, mass_at_rest: Array) -> tuple[str, ...]:
    """Return a warning for a mass and one for a length of the structure that do not go with the rotor.

    The mass is that which the hub feels in the direction in which it moves most easily, 1/λ with λ the largest
    eigenvalue of Φ Φᵀ of its displacements in the lowest modes, normalised to the mass; a node at the hub may have
    little mass of its own, which modes far above those of a wing show. The length is that of hub displacements to hub
    rotations, beside the rotor's radius of gyration about a diameter.

    Parameters
    ----------
    support : NormalModes
    mass_at_rest : array (8, 8) or (6, 6)
        `proprotor.model.mass_at_rest.mass_at_rest` of the rotor.
    """
    mass, refusal = without_rotors(support, [(support.hub, mass_at_rest)])
    if mass.ndim > 2 or np.ndim(mass_at_rest) > 2 or (refusal is not None and refusal[()]):
        return ()
    try:
        shapes = lowest_modes(np.real(mass), np.real(support.stiffness)).shapes[:, :_MODES]
    except InputError:  # of a structure without modes, which the analysis tells
        return ()
    moved = np.real(support.hub) @ shapes
    mobility = moved @ moved.T
    moves, turns = (mobility[part, part] for part in (_MOVES, _TURNS))
    rotor_mass, inertia = np.real(mass_at_rest[0, 0]), np.real(mass_at_rest[_TILT, _TILT])
    largest, turning = float(np.linalg.eigvalsh(moves)[-1]), float(np.trace(turns))
    if not (largest > 0 and turning > 0 and rotor_mass > 0 and inertia > 0):
        return ()
    felt, length = 1 / largest, float(np.sqrt(np.trace(moves) / turning))
    found = {
        f"the hub feels a mass of {felt:.3g} kg of the structure": (felt / rotor_mass, _MASS),
        f"the hub moves {length:.3g} m per radian": (length / np.sqrt(inertia / rotor_mass), _LENGTH),
    }
    beside = f"beside a rotor of {rotor_mass:.3g} kg with a radius of gyration of {np.sqrt(inertia / rotor_mass):.3g} m"
    return tuple(
        f"The units of the support's file are doubtful: {text}, {beside}. Check length_unit and mass_unit."
        for text, (ratio, (low, high)) in found.items()
        if not low <= ratio <= high
    )
