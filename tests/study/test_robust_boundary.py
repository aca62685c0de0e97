"""The worst design of a box: against grids of all its designs, the same speeds by another way, and differences."""

import json
from functools import cache

import numpy as np
import pytest

import proprotor as pp
from proprotor import sampling
from proprotor.errors import InputError
from proprotor.exchange.netcdf import load_results, save_results
from proprotor.study.box import box_of
from proprotor.study.robust_boundary import robust_boundary

CASE = pp.load_case("xv15-uncoupled")
FLAP, STIFFNESS, PRECONE = "rotor.flap_frequency", "rotor.control_stiffness", "rotor.precone"
CHORD = "support.modes[chord].frequency"
SPEEDS = np.linspace(110, 230, 31)
RELATIVE = sampling.Relative
FINER = 1e-6  # m/s: flutter speeds of a study are found to 1e-8 here, and by `flutter_point` to a billionth

# Boxes whose worst design lies inside along one input, at a corner, and on an edge.
BOXES = {
    "inside": {FLAP: RELATIVE(0.56, 0.8), PRECONE: ("2 deg", "3 deg"), STIFFNESS: RELATIVE(0.95, 1.05)},
    "corner": {CHORD: RELATIVE(0.9, 1.1), PRECONE: ("1 deg", "4 deg"), STIFFNESS: RELATIVE(0.7, 1.5)},
    "two modes": {
        "operation.rotor_speed": ("300 rpm", "600 rpm"),
        PRECONE: ("1 deg", "2 deg"),
        CHORD: RELATIVE(0.9, 1.1),
    },
}


@cache
def worst_of(name):
    """The worst design of a box, which several tests ask about."""
    return robust_boundary(CASE, BOXES[name], SPEEDS, workers=1, size=32)


def flutter_speed(values):
    return CASE.vary(values).flutter_point(SPEEDS)


def by_force(box, points):
    """The lowest flutter speed of all designs of a grid over a box."""
    own = box_of(CASE, box)
    along = np.linspace(0, 1, points)
    places = np.stack(np.meshgrid(*[along] * len(box), indexing="ij"), axis=-1).reshape(-1, len(box))
    found = pp.study(CASE, sampling.points(own.values(places)), SPEEDS, "flutter", workers=1)
    speeds = found.flutter_speed.values
    assert not np.isfinite(found.flutter_speed_below).any()
    lowest = int(np.nanargmin(speeds))
    return speeds[lowest], places[lowest], found.flutter_mode.values[lowest]


@pytest.mark.parametrize("name", BOXES)
def test_no_design_of_a_grid_is_worse(name):
    found = worst_of(name)
    lowest, place, mode = by_force(BOXES[name], 7)
    speed = float(found.speed)
    assert speed <= lowest + FINER
    assert mode in found["first"].values
    worst = dict(zip(found.input.values.tolist(), found.value.values.tolist(), strict=True))
    again = flutter_speed(worst)
    assert abs(again.speed - speed) < FINER and again.mode == found.mode
    assert abs(again.frequency - float(found.frequency)) < FINER
    assert (found.low <= found.value).all() and (found.value <= found.high).all()
    sides = np.where(found.value == found.low, "low", np.where(found.value == found.high, "high", "inside"))
    assert sides.tolist() == found.side.values.tolist()
    if name == "corner":
        assert speed == pytest.approx(lowest, abs=FINER)
        assert ((place == 1) == (found.side == "high")).all() and (found.side != "inside").all()


@pytest.mark.parametrize("name", BOXES)
def test_derivatives_are_those_of_differences_and_point_out_of_the_box(name):
    found = worst_of(name)
    worst = dict(zip(found.input.values.tolist(), found.value.values.tolist(), strict=True))
    for path, derivative, side, width in zip(
        worst, found.derivative.values, found.side.values, (found.high - found.low).values, strict=True
    ):
        step = 1e-5 * width
        ends = [flutter_speed(worst | {path: worst[path] + sign * step}).speed for sign in (-1, 1)]
        # The curvature of a speed over 1e-5 of the width is far below 1e-4 m/s a width.
        assert np.diff(ends)[0] / 2e-5 == pytest.approx(derivative * width, rel=1e-4, abs=2e-3)
        signs = {"low": derivative > 0, "high": derivative < 0, "inside": abs(derivative * width) < 0.02}
        assert signs[side], (path, side)


def test_a_valley_of_each_mode_is_found_beside_the_jump_between_them():
    """Along the flap frequency one mode has its valley below a jump, another above: a fine grid finds both."""
    box = {FLAP: RELATIVE(0.56, 0.8)}
    found = robust_boundary(CASE, box, SPEEDS, workers=1, size=16)
    number = pp.design_inputs(CASE)[FLAP].si
    grid = pp.study(CASE, {FLAP: np.linspace(0.56, 0.8, 241) * number}, SPEEDS, "flutter", workers=1)
    for mode in ("progressive gimbal", "regressive gimbal"):
        lowest = float(grid.flutter_speed.where(grid.flutter_mode == mode).min())
        own = float(found.speed_of_first.sel(first=mode))
        assert lowest - 5e-3 < own <= lowest + FINER, mode
    jumps = np.abs(np.diff(grid.flutter_speed.values))
    assert jumps.max() > 10  # m/s, between two designs of the grid
    assert found.mode == "regressive gimbal" and found.side == ["inside"]


def test_what_was_tried_is_told():
    found = worst_of("corner")
    assert found.attrs["evaluated"] > 1 + 8 + 32 and found.attrs["failed"] == 0 and found.attrs["below"] == 0
    assert "8 corners, 32 designs inside" in found.attrs["search"] and "no proof" in found.attrs["search"]
    assert json.loads(found.attrs["options"])["backend"] == "numpy" and found.attrs["case"] == CASE.name


def test_a_design_that_is_unstable_at_the_lowest_airspeed_is_a_limit_and_no_speed():
    found = robust_boundary(CASE, {PRECONE: ("1 deg", "4 deg")}, np.linspace(190, 230, 21), workers=1, size=8)
    at_start = CASE.vary({PRECONE: float(found.value[0])}).flutter_point(np.linspace(190, 230, 21))
    if not at_start.unstable_at_start:
        pytest.fail("the worst design is stable at the lowest airspeed")
    assert (
        found.speed_below == 190 and np.isnan(found.speed) and found.mode == "" and found.attrs["below"] > 0
    )
    assert np.isnan(found.derivative).all()


def test_a_box_that_is_stable_throughout_has_a_limit_and_the_least_damped_design():
    found = robust_boundary(CASE, {PRECONE: ("2 deg", "3 deg")}, [80.0, 90.0, 100.0], workers=1, size=8)
    assert np.isnan(found.speed) and found.speed_above == 100 and not found.sizes["first"]
    assert found.attrs["above"] == found.attrs["evaluated"] == 11
    places = CASE.vary({PRECONE: float(found.value[0])}).sweep([80.0, 90.0, 100.0])
    assert float(found.least_damping) == pytest.approx(float(places.damping_ratio.min()), rel=1e-6)


def test_designs_that_fail_are_counted_with_a_reason_and_spoil_no_other():
    box = {"operation.rotor_speed": ("458 rpm", "900 rpm")}
    found = robust_boundary(CASE, box, SPEEDS, workers=1, size=16)
    assert found.attrs["failed"] > 0 and "Mach" in found.attrs["reason"]
    assert np.isfinite(found.speed)


def test_a_large_box_has_no_corners_and_derivatives_lead_there():
    names = (PRECONE, STIFFNESS, CHORD, FLAP, "rotor.lag_frequency", "rotor.pitch_inertia")
    names += ("support.modes[beam].frequency", "support.modes[torsion].frequency", "operation.density")
    box = dict.fromkeys(names, RELATIVE(0.97, 1.03))
    found = robust_boundary(CASE, box, SPEEDS, workers=1, size=16)
    assert "no corner of so many" in found.attrs["search"]
    own = box_of(CASE, box)
    assert not len(own.corners)
    middle = flutter_speed(
        {path: float(value[0]) for path, value in own.values(np.full((1, 9), 0.5)).items()}
    )
    assert found.speed < middle.speed
    outward = np.where(found.side == "low", found.derivative > 0, found.derivative < 0)
    assert outward[found.side != "inside"].all()


def test_results_go_into_a_file(tmp_path):
    found = robust_boundary(CASE, {PRECONE: ("2 deg", "3 deg")}, SPEEDS, workers=1, size=4)
    save_results(found, tmp_path / "robust.nc")
    assert load_results(tmp_path / "robust.nc").equals(found)


@pytest.mark.parametrize(
    ("box", "said"),
    [
        ({}, "must have at least one input"),
        ({"rotor.precon": (0, 1)}, "rotor.precone"),
        ({PRECONE: sampling.Normal(0.04, 0.01)}, "must have two limits"),
        ({PRECONE: 1.0}, "must be a pair of limits"),
        ({PRECONE: ("3 deg", "2 deg")}, "lower limit first"),
    ],
)
def test_what_is_no_box_is_refused(box, said):
    with pytest.raises(InputError, match=said):
        robust_boundary(CASE, box, SPEEDS, workers=1)


def test_a_box_in_which_nothing_can_be_analysed_is_refused():
    with pytest.raises(InputError, match="has no design that can be analysed"):
        robust_boundary(CASE, {"operation.rotor_speed": ("2000 rpm", "3000 rpm")}, SPEEDS, workers=1, size=4)
    with pytest.raises(InputError, match="power of two"):
        robust_boundary(CASE, {PRECONE: ("2 deg", "3 deg")}, SPEEDS, size=3)
