"""What must notice a mutant: for every generated function, its entries beside values from elsewhere.

No expected value is generated code's. Inputs are not either, but for the arrays of a segment: W, U, G and L are seen by
their products, and while one of them is a mutant the others are as generated.
"""

from __future__ import annotations

import functools

from tests.mutation import (
    airload_checks,
    assembly_checks,
    beam_checks,
    blade_checks,
    blade_element_checks,
    inflow_checks,
    lag_checks,
    moving_checks,
    rotor_checks,
    section_checks,
)
from tests.mutation.comparison import Check, Names


@functools.cache
def all_checks() -> tuple[Check, ...]:
    """Every check; to make their expectations takes seconds, to run them milliseconds."""
    modules = (
        blade_checks,
        section_checks,
        airload_checks,
        lag_checks,
        inflow_checks,
        moving_checks,
        rotor_checks,
        assembly_checks,
        beam_checks,
        blade_element_checks,
    )
    found = tuple(check for module in modules for check in module.checks())
    for check in found:  # arrays that are kept are made while nothing is a mutant
        check.excess()
    return found


def checks_of(names: Names) -> list[Check]:
    """Those that see a generated function, by (module, function)."""
    return [check for check in all_checks() if check.sees == names]
