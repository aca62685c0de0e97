"""The compiled bound on the path to a trim, beside eigenvalues of the matrices that it bounds and beside NumPy's."""

import numpy as np
import pytest

from proprotor.compiled import bounds
from proprotor.compiled.library import why_not
from proprotor.rotor.trim_balance import Slopes
from proprotor.rotor.trim_bound import CONTRACTION, contraction

pytestmark = pytest.mark.skipif("there is no C compiler" in why_not(), reason="there is no C compiler")
POINTS = 499  # a last vector has fewer points than lanes
SIZES = (1, 2, 3, 4)
WINDOWS = 4


def slopes(rng, k):
    """Slopes at the undeflected blade and at a trim, some within the bound and some not."""
    structure = np.eye(k) + 0.1 * rng.standard_normal((POINTS, k, k))
    airloads = rng.uniform(0.0, 0.3, (POINTS, 1, 1)) * rng.standard_normal((POINTS, k, k))
    change = rng.uniform(0.0, 0.6, (POINTS, 1, 1)) * rng.standard_normal((POINTS, k, k))
    return Slopes(structure + airloads, airloads), Slopes(structure + airloads + change, airloads + change)


def radius_of_windows(before, after):
    """The largest spectral radius of |P J(end) - 1| over the ends of the windows, by the definition of the bound."""
    found = np.zeros(POINTS)
    for window in range(WINDOWS):
        middle = (2 * window + 1) / (2 * WINDOWS)
        first, last = (one.full - (1 - middle) * one.airloads for one in (before, after))
        inverse = np.linalg.inv((first + last) / 2)
        in_share = inverse @ (before.airloads + after.airloads) / 2 / (2 * WINDOWS)
        in_place = inverse @ (last - first) / 2
        radii = np.abs(np.linalg.eigvals(np.abs(in_share) + 2.0 * np.abs(in_place))).max(axis=1)
        found = np.maximum(found, radii)
    return found


@pytest.mark.parametrize("k", SIZES)
def test_what_leads_to_the_end_contracts_in_every_window(k):
    before, after = slopes(np.random.default_rng(k), k)
    found, radius = bounds.lead_to_end(before, after), radius_of_windows(before, after)
    assert (radius[found] <= CONTRACTION).all() and found[radius < 0.8 * CONTRACTION].all()
    assert 0.1 < found.mean() < 0.9


@pytest.mark.parametrize("k", SIZES)
def test_the_bound_is_that_of_numpy(k):
    before, after = slopes(np.random.default_rng(10 + k), k)
    ends = np.zeros(POINTS), np.ones(POINTS)
    # No radius is enough: NumPy takes all steps of the iteration, as the compiled functions do where it matters.
    radius = contraction(np.zeros(k, dtype=bool), before, after, *ends, windows=WINDOWS, enough=0.0)
    clear = np.abs(radius - CONTRACTION) > 1e-9
    assert (bounds.lead_to_end(before, after) == (radius <= CONTRACTION))[clear].all()


@pytest.mark.parametrize("k", SIZES)
def test_slopes_near_each_other_differ_by_a_contraction(k):
    one, other = slopes(np.random.default_rng(20 + k), k)
    found = bounds.near_each_other(other.full, one.full)
    inverse = np.linalg.inv(one.full)
    radius = np.abs(np.linalg.eigvals(np.abs(inverse @ (other.full - one.full)))).max(axis=1)
    assert (radius[found] <= CONTRACTION).all() and found[radius < 0.8 * CONTRACTION].all()
    assert 0.1 < found.mean() < 1.0


def test_a_point_is_the_same_in_any_company_and_nan_spoils_no_other():
    before, after = slopes(np.random.default_rng(30), 4)
    found = bounds.lead_to_end(before, after)
    near = bounds.near_each_other(after.full, before.full)
    order = np.random.default_rng(31).permutation(POINTS)
    assert (bounds.lead_to_end(before.of(order), after.of(order)) == found[order]).all()
    assert (bounds.near_each_other(after.full[order], before.full[order]) == near[order]).all()
    bad = 7
    before.full[bad, 0, 0] = np.nan
    again = bounds.lead_to_end(before, after)
    assert not again[bad] and (np.delete(again, bad) == np.delete(found, bad)).all()
    again = bounds.near_each_other(after.full, before.full)
    assert not again[bad] and (np.delete(again, bad) == np.delete(near, bad)).all()
