"""What is kept for one design is found once, is forgotten with its objects, and changes nothing that can be seen."""

import gc
import pickle
from dataclasses import fields, replace
from weakref import ref

import numpy as np
import pytest

import proprotor as pp
from proprotor.model import rotor_share
from proprotor.model.deck_fingerprint import deck_fingerprint
from proprotor.rotor import section_loads
from proprotor.rotor.kept import kept
from proprotor.support.normal_modes import NormalModes
from proprotor.support.wing_aerodynamics import WingInAirstream

CASES = ["xv15", "wrats-742-off", "xv15-wing", "xv15-aircraft"]


class Thing:
    """Something that can be asked for."""


def counted(asked):
    return kept(lambda *given: asked.append(1) or np.array([len(given)]))


def test_the_same_objects_are_asked_for_once_and_others_anew():
    asked, one, other = [], Thing(), Thing()
    function = counted(asked)
    assert function(one, other) is function(one, other)
    assert function(other, one) is not function(one, other)
    assert function(one, other, "held") is function(one, other, "".join(["he", "ld"]))
    assert function(one, other, "held") is not function(one, other, "free")
    assert len(asked) == 4


def test_a_result_is_forgotten_with_the_first_of_its_objects():
    function, one, other = kept(lambda *given: Thing()), Thing(), Thing()
    result = ref(function(one, other))
    gc.collect()
    assert result() is not None
    del one
    gc.collect()
    assert result() is None


def test_nothing_is_kept_for_an_array_that_can_be_written_to():
    double = kept(lambda array: 2 * array)
    array = np.ones(2)
    assert double(array)[0] == 2
    array[0] = 5
    assert double(array)[0] == 10
    array.flags.writeable = False
    assert double(array) is double(array)


def test_objects_given_by_name_are_not_looked_up():
    asked, one = [], Thing()
    function = kept(lambda thing: asked.append(thing))
    function(thing=one), function(thing=one)
    assert asked == [one, one]


@pytest.mark.parametrize("name", CASES)
def test_a_case_is_forgotten_after_its_models(name):
    """Caches that held a case would fill the memory of a study, which makes a new case for each batch of designs."""
    case = pp.load_case(name)
    case.linearize(100.0)
    parts = [ref(part) for part in (case, case.rotor, case.support, case.support.mass)]
    del case
    gc.collect()
    assert [part() for part in parts] == [None] * 4


@pytest.mark.parametrize("name", CASES)
def test_a_model_changes_neither_the_pickle_nor_the_fingerprint_of_its_case(name):
    case = pp.load_case(name)
    names = {part: set(vars(part)) for part in (case, case.support)}
    anew = deck_fingerprint.__wrapped__  # without what is kept of it
    before = anew(case)
    case.linearize(100.0)
    assert {part: set(vars(part)) for part in names} == names
    assert anew(case) == before == anew(pickle.loads(pickle.dumps(case)))


def test_every_result_of_a_case_has_the_fingerprint_that_was_made_once():
    case = pp.load_case("xv15-uncoupled")
    assert deck_fingerprint(case) is deck_fingerprint(case)
    assert deck_fingerprint(case) == deck_fingerprint(pp.load_case("xv15-uncoupled"))


@pytest.mark.parametrize("name", CASES)
def test_a_second_model_of_a_case_derives_nothing_of_the_design_again(monkeypatch, name):
    """A fresh copy of the case does, and comes to the same matrices."""
    done = []
    case = pp.load_case(name)
    for place, function in ((section_loads.BladeSections, "of"), (rotor_share, "_all_positive")):
        genuine = getattr(place, function)
        monkeypatch.setattr(
            place, function, lambda *given, real=genuine, **named: done.append(1) or real(*given, **named)
        )
    first = case.linearize(120.0)
    count = len(done)
    second = case.linearize(np.array([90.0, 120.0]))
    assert count and len(done) == count
    fresh = replace(case, rotor=replace(case.rotor), support=replace(case.support)).linearize(120.0)
    assert len(done) > count
    for kind in "MCK":
        np.testing.assert_array_equal(getattr(first, kind), getattr(fresh, kind))
        scale = np.abs(getattr(first, kind)).max()
        np.testing.assert_allclose(getattr(second, kind)[1], getattr(first, kind), rtol=0, atol=1e-13 * scale)


def wing_in_airstream():
    support = pp.load_case("xv15-wing").support
    own = {entry.name: getattr(support, entry.name) for entry in fields(NormalModes)}
    airloads = np.random.default_rng(5).normal(size=(2, *support.mass.shape))
    return WingInAirstream(**own, airload_damping=airloads[0], airload_stiffness=airloads[1])


@pytest.mark.parametrize("make", [wing_in_airstream, lambda: pp.load_case("xv15-aircraft").support])
def test_a_support_in_other_air_is_checked_no_more_than_its_new_matrices(make):
    """Mass and hub are the same arrays, so that what follows from them is known."""
    support = make()
    there, still = support.at(100.0, 1.0), support.at(0.0, 1.0)
    assert there.mass is support.mass and there.hub is support.hub and there.names is support.names
    np.testing.assert_allclose(
        there.stiffness, support.stiffness + 100.0**2 * support.airload_stiffness, rtol=1e-14
    )
    np.testing.assert_array_equal(still.stiffness, support.stiffness)
    np.testing.assert_array_equal(there.at(50.0, 1.0).damping, there.damping)  # the airloads are in already
    with np.errstate(all="ignore"), pytest.raises(pp.InputError, match="must be finite"):
        support.at(np.inf, 1.0)
    with pytest.raises(ValueError, match="read-only"):
        there.damping[0, 0] = 1.0
