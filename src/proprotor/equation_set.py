"""Which generated functions make up the model: with every first-order term, or as published."""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType

import proprotor_equations as consistent
from proprotor_equations import published


@dataclass(frozen=True)
class EquationSet:
    """Generated modules that a dropped term can change, for the option ``equations``.

    The functions that all sets share are imported from `proprotor_equations` where they are used.

    Parameters
    ----------
    inertia, flap_lag_springs, pitch, airloads : module
        Each with the functions of the module of `proprotor_equations.published` that has its name, under the arguments
        of that module. A set of one's own has modules of its own in some of the four places.
    """

    inertia: ModuleType
    flap_lag_springs: ModuleType
    pitch: ModuleType
    airloads: ModuleType


EQUATION_SETS = {
    "consistent": EquationSet(
        consistent.inertia, consistent.flap_lag_springs, consistent.pitch, consistent.airloads
    ),
    "published": EquationSet(
        published.inertia, published.flap_lag_springs, published.pitch, published.airloads
    ),
}
