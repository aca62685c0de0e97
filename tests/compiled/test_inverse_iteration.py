"""The bounds of backward errors of `benchmarks/eigenvalues.py`: by singular values, and runs that go on."""

import numpy as np
import pytest

from benchmarks import eigenvalues as run
from benchmarks.inverse_iteration import bounds_of_singular_values
from proprotor.compiled.library import why_not
from tests.compiled.matrices import FAMILIES, normalised

needs_compiler = pytest.mark.skipif("there is no C compiler" in why_not(), reason="there is no C compiler")
ROUNDING = 1e-15  # of the norm: of a product of a matrix and a vector


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("n", [1, 2, 7, 24])
def test_bounds_lie_above_the_singular_values_and_near_them(family, n):
    """At eigenvalues of LAPACK, and at other numbers, where the smallest singular value is no rounding."""
    rng = np.random.default_rng(n)
    matrices, _ = normalised(FAMILIES[family](rng, 6, n))
    values = np.linalg.eigvals(matrices).astype(complex)
    others = rng.standard_normal(values.shape) + 1j * rng.standard_normal(values.shape)
    norm = np.linalg.norm(matrices, axis=(1, 2))[:, None] + 1
    for own in (values, values + 1e-9, others):
        bounds = bounds_of_singular_values(matrices, own, rng)
        exact = run.singular_values(matrices, own)
        assert (bounds >= exact - ROUNDING * norm).all()
        assert (bounds <= 30 * exact + ROUNDING * norm).all()


@needs_compiler
def test_wrong_eigenvalues_are_seen(monkeypatch):
    eigvals = run.compiled.eigvals
    monkeypatch.setattr(run.compiled, "eigvals", lambda matrices: eigvals(matrices) * (1 + 3e-13))
    family, found = run.judge(13 * len(run.KINDS), 10**9)
    assert family == "random" and found.missed == run.BATCH == found.exact


@needs_compiler
def test_a_run_that_was_stopped_finds_what_one_without_a_stop_finds(tmp_path):
    place, batches = tmp_path / "tallies.json", 2 * len(run.KINDS)
    whole = run.started(None, 5)
    whole.go_on(batches, np.inf, None)
    run.started(place, 5).go_on(batches // 3, np.inf, place)
    again = run.started(place, 5)
    assert again.done == batches // 3
    again.go_on(batches, np.inf, place)
    assert again.families == whole.families == run.started(place, 5).families
    assert run.table(again).splitlines()[:-1] == run.table(whole).splitlines()[:-1]
    total = sum(one.matrices for one in whole.families.values())
    assert total == run.BATCH * batches and not any(one.missed for one in whole.families.values())
    with pytest.raises(SystemExit, match="singular values of one matrix in 5"):
        run.started(place, 6)
