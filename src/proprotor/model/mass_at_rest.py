"""The mass matrix of a rotor at rest, from which the rotor's share in the masses of a support follows."""

from __future__ import annotations

import numpy as np
from proprotor_equations import FIXED_COORDINATES, inertia, multiblade, offset_mass, pitch

from proprotor.model.quantities import of_rotor
from proprotor.rotor.generated import evaluate
from proprotor.rotor.kept import kept
from proprotor.rotor.motions import HUB
from proprotor.rotor.rotor import Rotor
from proprotor.rotor.trim import UNKNOWNS
from proprotor.typing import Array

MASS_AT_REST = (*HUB, "gimbal_1c", "gimbal_1s")  # coordinates of a rotor at rest with locked blades


@kept
def mass_at_rest(rotor: Rotor) -> Array:
    """Return the mass matrix of the undeflected rotor with locked blades, which no option of an analysis changes.

    Parameters
    ----------
    rotor : Rotor

    Returns
    -------
    array (..., 8, 8)
        On the coordinates `MASS_AT_REST`, in kg, kg m and kg m²; not to be written to.
    """
    quantities = of_rotor(rotor) | dict.fromkeys(UNKNOWNS, 0.0)
    quantities |= evaluate(inertia.trim_integrals, quantities)._asdict()
    blade = evaluate(inertia.mass, quantities) + evaluate(pitch.mass, quantities)
    if rotor.offset_mass is not None:
        quantities |= {"pitch": 0.0}
        quantities |= evaluate(offset_mass.trim_integrals, quantities)._asdict()
        blade = blade + evaluate(offset_mass.mass, quantities)
    places = np.array([FIXED_COORDINATES.index(name) for name in MASS_AT_REST])
    found = np.asarray(evaluate(multiblade.mass, quantities, blade)[..., places[:, None], places])
    found.flags.writeable = False
    return found
