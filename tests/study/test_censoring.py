"""Limits of flutter speeds that lie beyond the airspeeds of a study: by hand, and in studies of the XV-15."""

import numpy as np
import pytest

import proprotor as pp
from proprotor.study.censoring import put_limits
from proprotor.study.variables import STABLE, UNSTABLE

NAN = np.nan
CASE = pp.load_case("xv15-uncoupled")
# In air in which the tips are supersonic before it flutters.
COLD = pp.load_case("xv15-uncoupled", {"operation.speed_of_sound": "230 m/s"})
SPEEDS = np.array([100.0, 110.0, 120.0, 130.0])

# Of each design: which airspeeds failed, its note and flutter speed; then the limits that follow.
DESIGNS = {
    "stable": ("....", STABLE, NAN, 130, NAN),
    "unstable from the start": ("....", UNSTABLE, NAN, NAN, 100),
    "flutters": ("....", "", 115.0, NAN, NAN),
    "unstable, and another mode flutters": ("....", UNSTABLE, 125.0, NAN, 100),
    "failed at high speeds": ("..xx", f"{STABLE}; 2 airspeeds failed, at 120 m/s: tip Mach", NAN, 110, NAN),
    "failed between": (".x..", f"{STABLE}; 1 airspeeds failed, at 110 m/s: no trim", NAN, 100, NAN),
    "failed at low speeds": ("xx..", f"{STABLE}; 2 airspeeds failed, at 100 m/s: no trim", NAN, 130, NAN),
    "failed at low speeds, unstable then": ("x...", UNSTABLE, NAN, NAN, 110),
    "failed": ("xxxx", "no trim", NAN, NAN, NAN),
    "lost": ("....", "the search for its boundary failed: a jump", NAN, NAN, NAN),
}


def test_a_limit_is_the_last_airspeed_up_to_which_all_is_known():
    marks, notes, speeds, above, below = map(list, zip(*DESIGNS.values(), strict=True))
    found = {
        "reason": np.array(
            [["no trim" if mark == "x" else "" for mark in row] for row in marks], dtype=object
        ),
        "flutter_note": np.array(notes, dtype=object),
        "flutter_speed": np.array(speeds),
        "flutter_speed_above": np.full(len(marks), NAN),
        "flutter_speed_below": np.full(len(marks), NAN),
    }
    put_limits(found, SPEEDS)
    np.testing.assert_array_equal(found["flutter_speed_above"], np.array(above, dtype=float))
    np.testing.assert_array_equal(found["flutter_speed_below"], np.array(below, dtype=float))


@pytest.mark.parametrize(
    ("case", "speeds", "above", "below"),
    [
        (CASE, [100.0, 120.0], 120.0, NAN),
        (CASE, [0.0, 100.0, 120.0], 120.0, NAN),  # no trim at rest
        (COLD, [100.0, 120.0, 190.0], 120.0, NAN),
        (CASE, [200.0, 205.0], NAN, 200.0),
        (CASE, [100.0, 220.0], NAN, NAN),
    ],
)
def test_a_study_says_the_limits_of_each_design(case, speeds, above, below):
    options = {"pitch": "rigid"} if case is COLD else {}
    found = pp.study(case, {}, speeds, "flutter", workers=1, **options).isel(design=0)
    limits = [float(found.flutter_speed_above), float(found.flutter_speed_below)]
    np.testing.assert_array_equal(limits, [above, below])
    assert np.isfinite([float(found.flutter_speed), *limits]).sum() == 1
    assert (case is COLD) == ("tip Mach" in found.reason.values[-1])
