"""Flutter speeds of random designs by compiled functions: every word that NumPy's have, and the same speeds."""

import pytest

from benchmarks.compiled_boundaries import ALLOWED, compare, found_by
from proprotor.compiled.library import why_not

pytestmark = pytest.mark.skipif("there is no C compiler" in why_not(), reason="there is no C compiler")


@pytest.mark.parametrize("seed", [3, 4])
def test_both_backends_find_the_same(seed):
    one, other = (found_by(backend, 25, seed, 1e-10) for backend in ("numpy", "compiled"))
    found = compare(one, other)
    assert found.with_flutter > 3
    assert {name: places for name, places in found.differ.items() if places} == {}
    assert found.worst["flutter_speed"] <= ALLOWED and found.agrees


def test_a_difference_is_seen():
    one = found_by("numpy", 8, 3, 1e-10)
    other = one.copy(deep=True)
    other.flutter_note[2], other.flutter_speed[:] = "another note", other.flutter_speed + 2 * ALLOWED
    found = compare(one, other)
    assert found.differ["flutter_note"] == [2] and found.worst["flutter_speed"] > ALLOWED and not found.agrees
