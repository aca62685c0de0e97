"""Modes of the XV-15 for every combination of switches are the accepted ones, until others are accepted."""

import itertools

import pytest

from proprotor.options import CHOICES
from tests.golden import switches


@pytest.fixture(scope="module")
def kept():
    return switches.kept()


def test_modes_are_the_accepted_ones(kept):
    found = switches.changes(kept, now := switches.computed())
    if found:
        accept = "`python -m tests.accept_golden` accepts this and leaves it to be seen in review."
        pytest.fail(f"{switches.told(found, len(now))}\n{accept}", pytrace=False)


def test_every_combination_is_there(kept):
    choices = [map(str, CHOICES[name]) for name in switches.SWITCHES]
    assert list(kept) == list(itertools.product(*choices, map(str, switches.KNOTS)))


@pytest.mark.parametrize("moved", [{"frequency": 0.5 * (1 + 3e-8)}, {"damping_ratio": 0.01 + 3e-8}])
def test_a_small_change_is_found_told_and_alone_accepted(moved):
    mode, other = switches.Mode("chord", 0.5, 0.01), switches.Mode("beam", 0.3, 0.02)
    defaults = tuple(str(CHOICES[name][0]) for name in switches.SWITCHES)
    points = [(*defaults, "200"), (*defaults, "300")]
    was = {point: [other, mode] for point in points}
    rounded = other._replace(damping_ratio=0.02 + 1e-12)
    now = {points[0]: [rounded, mode], points[1]: [rounded, mode._replace(**moved)]}
    (change,) = switches.changes(was, now)
    assert change == (points[1], mode, mode._replace(**moved))
    assert "chord" in switches.told([change], 2) and "300 1" in switches.told([change], 2)
    assert switches.accepted(was, now) == {points[0]: was[points[0]], points[1]: now[points[1]]}


def test_a_mode_that_comes_or_goes_is_a_change():
    point, mode = ("any",), switches.Mode("lag_1c", 0.7, 0.05)
    assert switches.changes({point: [mode]}, {point: []}) == [(point, mode, None)]
    assert switches.changes({}, {point: [mode]}) == [(point, None, mode)]
    assert "went" in switches._movement(switches.Change(point, mode, None))
