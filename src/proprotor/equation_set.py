"""Which generated functions make up the model: with every first-order term, or as published."""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType

import proprotor_equations as consistent
from proprotor_equations import published


@dataclass(frozen=True)
class EquationSet:
    """Generated modules that a dropped term can change; what both sets share is imported where it is used.

    `derive.emit.reduced_modules` makes such modules for any choice of dropped terms.
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
