"""Settings of all tests."""

import gc
import sys
import weakref

import pytest
from hypothesis import given, settings
from hypothesis.internal.conjecture import providers
from hypothesis.strategies import none

# Hypothesis mixes constants of whatever local modules are imported into its examples. Then the examples of a test would
# depend on the tests that ran before it in the same process, and on lines that have nothing to do with it.
providers.is_local_module_file = lambda path: False

# A first example that has to import a library is slow, and no fault.
settings.register_profile("proprotor", deadline=None)
settings.load_profile("proprotor")


@given(none())
def first_example(_):
    """Hypothesis looks at its first example for who holds its random numbers, and does not see what is frozen."""


# New objects before the garbage collector looks for cycles: at 700, its usual number, that takes a tenth of the time.
OBJECTS = 20_000


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """What is collected stays until the end, so the garbage collector need not look through it, now or later."""
    first_example()
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.set_threshold(OBJECTS)
        gc.enable()


LONGEST = ("tests/verify/",)  # whose files would be the last by name


def pytest_collection_modifyitems(items):
    """Files that take longest come first: at the end, when processes run out of files, none is left alone with one."""
    items.sort(key=lambda item: not item.nodeid.startswith(LONGEST))


_opened: "weakref.WeakSet[object]" = weakref.WeakSet()
sys.addaudithook(lambda event, given: _opened.add(given[0]) if event == "socket.__new__" else None)


@pytest.fixture(autouse=True, scope="module")
def no_socket_left_open():
    """Who opens a socket closes it.

    Else the garbage collector does, some time later, with a warning that fails whatever test runs then.
    """
    before = set(_opened)
    yield
    left = [opened for opened in set(_opened) - before if opened.fileno() != -1]
    assert not left, left


@pytest.fixture(autouse=True)
def no_figures_left_open():
    """A figure that one test leaves open is not there for the next."""
    yield
    if pyplot := sys.modules.get("matplotlib.pyplot"):
        pyplot.close("all")
