"""No analysis leaves its work in a cycle of references.

An object in a cycle is freed only when Python's collector comes round, and the collector counts objects and not bytes:
a handful of objects that hold the models of a batch can wait for many batches, and a worker of a long study grows.
"""

import gc
from types import FunctionType, MethodType

import pytest

import proprotor as pp
from proprotor import sampling
from proprotor.study.variables import QUANTITIES
from tests.model.test_carried import ABOUT_A_PERIODIC_TRIM, CASE, RESULTS, SPEEDS, UNDAMPED


def in_cycles(analyse):
    """Names of the package's objects that an analysis leaves in cycles."""
    analyse()  # what is kept from call to call, such as derived functions, is made here
    gc.collect()
    gc.disable()
    try:
        analyse()
        gc.set_debug(gc.DEBUG_SAVEALL)
        gc.collect()
        return sorted({name for each in gc.garbage if (name := name_of(each)).startswith("proprotor")})
    finally:
        gc.set_debug(0)
        gc.garbage.clear()
        gc.enable()


def name_of(each):
    """Module and name of a function, or of the class of another object."""
    named = each if isinstance(each, FunctionType | MethodType) else type(each)
    return f"{named.__module__}.{named.__qualname__}"


def study(quantities, backend):
    plan = sampling.points({"rotor.precone": [0.02, 0.025, 0.03]}, drawn=True)
    return pp.study(CASE, plan, SPEEDS, quantities, workers=1, backend=backend, **UNDAMPED)


@pytest.mark.parametrize("backend", ["numpy", "auto"])
@pytest.mark.parametrize("quantity", QUANTITIES)
def test_a_study_leaves_nothing_in_a_cycle(quantity, backend):
    assert in_cycles(lambda: study([quantity], backend)) == []


@pytest.mark.parametrize("name", RESULTS)
def test_an_analysis_leaves_nothing_in_a_cycle(name):
    assert in_cycles(lambda: RESULTS[name](CASE)) == []


@pytest.mark.parametrize("name", ABOUT_A_PERIODIC_TRIM)
def test_an_analysis_of_a_periodic_trim_leaves_nothing_in_a_cycle(name):
    analyse = ABOUT_A_PERIODIC_TRIM[name]
    assert in_cycles(lambda: analyse(CASE, shaft_angle=0.02, locked="gimbal")) == []


def test_a_cycle_would_be_seen():
    class Search:
        def __init__(self):
            self.solve = self.models

        def models(self):
            return []

    Search.__module__ = "proprotor.stability"
    assert in_cycles(Search) == ["proprotor.stability.test_a_cycle_would_be_seen.<locals>.Search"]
