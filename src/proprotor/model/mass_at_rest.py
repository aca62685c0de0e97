"""The mass matrix of a rotor at rest, from which the rotor's share in the masses of a support follows."""

from __future__ import annotations

from proprotor_equations import FIXED_COORDINATES, offset_mass

from proprotor.model.quantities import of_rotor
from proprotor.rotor.fused import mass_at_trim, trim_integrals
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
    quantities = of_rotor(rotor) | dict.fromkeys((*UNKNOWNS, "pitch"), 0.0)
    quantities["beside_axis"] = rotor.is_beside_axis
    quantities |= trim_integrals(quantities)
    if rotor.offset_mass is not None:
        quantities |= evaluate(offset_mass.trim_integrals, quantities)._asdict()
    found = mass_at_trim(quantities, [FIXED_COORDINATES.index(name) for name in MASS_AT_REST])
    found.flags.writeable = False
    return found
