"""How often analyses ask a case for its equations of motion: a sweep once, a search once for its scan."""

import numpy as np
import pytest

import proprotor as pp
from proprotor.model.configuration import Configuration


@pytest.fixture
def asked(monkeypatch):
    """Airspeeds of every call of `linearize`, in the order of the calls."""
    calls, linearize = [], Configuration.linearize

    def counting(case, airspeed, **options):
        calls.append(np.atleast_1d(airspeed))
        return linearize(case, airspeed, **options)

    monkeypatch.setattr(Configuration, "linearize", counting)
    return calls


def tip(case):
    return case.operation.rotor_speed * case.rotor.radius


@pytest.mark.parametrize("name", pp.list_cases())
def test_a_sweep_linearises_points_and_approach_in_one_call(name, asked):
    """Further calls are for points between, where a step does not tell roots apart: none is a point of the sweep."""
    case = pp.load_case(name)
    speeds = np.linspace(0.2, 0.65, 24) * tip(case)
    modes = case.sweep(speeds)
    approach = [speed for speed in asked[0] if speed not in speeds]
    assert set(speeds) <= set(asked[0])
    assert max(approach) == pytest.approx(0.7 * tip(case))  # the anchor
    assert modes.named_at == f"airspeed {0.7 * tip(case):.6g} m/s"
    for between in asked[1:]:
        assert not set(between) & (set(speeds) | set(approach))


def test_a_sweep_whose_steps_tell_roots_apart_is_one_call(asked):
    case = pp.load_case("xv15-uncoupled")
    case.sweep(np.linspace(0.6, 0.75, 16) * tip(case))
    assert len(asked) == 1


def test_a_sweep_of_an_input_is_one_call(asked):
    case = pp.load_case("xv15-uncoupled")
    own = case.given["rotor.control_stiffness"].si
    case.sweep(0.7 * tip(case), {"rotor.control_stiffness": np.linspace(0.9, 1.1, 21) * own})
    assert len(asked) == 1 and len(asked[0]) > 21


def test_a_sweep_looks_for_a_lower_anchor_where_the_first_has_no_trim(asked):
    """The tip is supersonic at seven tenths of its speed."""
    case = pp.load_case("xv15-uncoupled")
    slow = case.vary({"operation.speed_of_sound": 1.15 * tip(case)})
    speeds = np.array([50.0, 60.0, 70.0])
    assert slow.sweep(speeds).named_at == f"airspeed {0.5 * tip(case):.6g} m/s"
    assert sum(set(speeds) <= set(call) for call in asked) == 1


def test_a_search_for_boundaries_linearises_its_scan_once(asked):
    """As a complex step; the approach is a second call, and what follows are points between and the boundaries."""
    case = pp.load_case("xv15-uncoupled")
    scan = np.linspace(0.3, 1.1, 41) * tip(case)
    found = case.flutter_point(scan)
    assert found.boundaries
    complex_calls = [call for call in asked if np.iscomplexobj(call)]
    assert sum(set(scan) <= set(call.real) for call in asked) == 1
    assert set(scan) <= set(complex_calls[0].real)
    real = [call for call in asked if not np.iscomplexobj(call)]
    assert real[0][0] == pytest.approx(0.7 * tip(case))  # the approach, from the anchor
    positions = [boundary.position for boundary in found.boundaries]
    assert real[-1][2:].tolist() == positions  # named with the lowest and the least damped point, in one call
