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
WINDOWS = (4, 8, 16)


def slopes(rng, k):
    """Slopes at the undeflected blade and at a trim, some within the bound and some not."""
    structure = np.eye(k) + 0.1 * rng.standard_normal((POINTS, k, k))
    airloads = rng.uniform(0.0, 0.3, (POINTS, 1, 1)) * rng.standard_normal((POINTS, k, k))
    change = rng.uniform(0.0, 0.6, (POINTS, 1, 1)) * rng.standard_normal((POINTS, k, k))
    return Slopes(structure + airloads, airloads), Slopes(structure + airloads + change, airloads + change)


def by_moments(slopes, sprung):
    """Slopes per moment of the springs of flap and lag, and per moment of the stiffest of them for the other angles."""
    springs = slopes.full - slopes.airloads
    stiffest = np.abs(springs[..., sprung]).max(axis=(1, 2), initial=0.0)
    moments = np.where(sprung[:, None], springs, np.eye(len(sprung)) * stiffest[:, None, None])
    inverse = np.linalg.inv(moments) if sprung.any() else np.broadcast_to(np.eye(len(sprung)), springs.shape)
    return Slopes(slopes.full @ inverse, slopes.airloads @ inverse)


def radius_of_windows(before, after, windows):
    """The largest spectral radius of |P J(end) - 1| over the ends of the windows, by the definition of the bound."""
    found = np.zeros(POINTS)
    for window in range(windows):
        middle = (2 * window + 1) / (2 * windows)
        first, last = (one.full - (1 - middle) * one.airloads for one in (before, after))
        inverse = np.linalg.inv((first + last) / 2)
        in_share = inverse @ (before.airloads + after.airloads) / 2 / (2 * windows)
        in_place = inverse @ (last - first) / 2
        radii = np.abs(np.linalg.eigvals(np.abs(in_share) + 2.0 * np.abs(in_place))).max(axis=1)
        found = np.maximum(found, radii)
    return found


def least_radius(before, after, sprung):
    """The least radius over the numbers of windows, with slopes by angles and by moments."""
    ends = ((before, after), tuple(by_moments(end, sprung) for end in (before, after)))
    return np.min([radius_of_windows(*pair, windows) for pair in ends for windows in WINDOWS], axis=0)


def rows_of(k):
    """Rows of flap and lag among the first, as in a trim, for a number of unknowns."""
    return np.arange(k) < min(2, k - 1)


@pytest.mark.parametrize("k", SIZES)
def test_what_leads_to_the_end_contracts_in_every_window(k):
    before, after = slopes(np.random.default_rng(k), k)
    found, radius = bounds.lead_to_end(rows_of(k), before, after), least_radius(before, after, rows_of(k))
    assert (radius[found] <= CONTRACTION).all() and found[radius < 0.8 * CONTRACTION].all()
    assert 0.1 < found.mean() < 0.9


@pytest.mark.parametrize("k", SIZES)
def test_the_bound_is_that_of_numpy(k):
    before, after = slopes(np.random.default_rng(10 + k), k)
    ends = np.zeros(POINTS), np.ones(POINTS)
    # No radius is enough: NumPy takes all steps of the iteration, and slopes by moments as well as by angles.
    radii = [
        contraction(rows_of(k), before, after, *ends, windows=windows, enough=0.0) for windows in WINDOWS
    ]
    clear = (np.abs(np.array(radii) - CONTRACTION) > 1e-9).all(axis=0)
    found = bounds.lead_to_end(rows_of(k), before, after)
    assert (found == (np.min(radii, axis=0) <= CONTRACTION))[clear].all() and clear.mean() > 0.9
    few = radii[0] <= CONTRACTION
    assert found[few].all() and (k == 1 or (found & ~few).any())  # more windows show more


@pytest.mark.parametrize("k", SIZES)
def test_slopes_near_each_other_differ_by_a_contraction(k):
    one, other = slopes(np.random.default_rng(20 + k), k)
    found = bounds.near_each_other(rows_of(k), other, one)
    pairs = ((one, other), tuple(by_moments(end, rows_of(k)) for end in (one, other)))
    radius = np.min([relative(*pair) for pair in pairs], axis=0)
    assert (radius[found] <= CONTRACTION).all() and found[radius < 0.8 * CONTRACTION].all()
    assert 0.1 < found.mean() < 1.0


def relative(one, other):
    """The spectral radius of the difference of slopes in the first of them."""
    return np.abs(np.linalg.eigvals(np.abs(np.linalg.inv(one.full) @ (other.full - one.full)))).max(axis=1)


def test_a_point_is_the_same_in_any_company_and_nan_spoils_no_other():
    before, after = slopes(np.random.default_rng(30), 4)
    sprung = rows_of(4)
    found = bounds.lead_to_end(sprung, before, after)
    near = bounds.near_each_other(sprung, after, before)
    order = np.random.default_rng(31).permutation(POINTS)
    assert (bounds.lead_to_end(sprung, before.of(order), after.of(order)) == found[order]).all()
    assert (bounds.near_each_other(sprung, after.of(order), before.of(order)) == near[order]).all()
    bad = 7
    before.full[bad, 0, 0] = np.nan
    again = bounds.lead_to_end(sprung, before, after)
    assert not again[bad] and (np.delete(again, bad) == np.delete(found, bad)).all()
    again = bounds.near_each_other(sprung, after, before)
    assert not again[bad] and (np.delete(again, bad) == np.delete(near, bad)).all()
