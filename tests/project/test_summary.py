"""What objects say of themselves at a prompt: short, and the numbers they hold."""

import math

import numpy as np
import pytest

import proprotor as pp
from proprotor.stability.flutter_messages import verdict

CASE = pp.load_case("xv15-uncoupled")


def test_a_case_says_what_it_is_and_rests_on():
    told = repr(CASE)
    assert (
        "xv15-uncoupled" in told
        and "3 blades" in told
        and "458 rpm" in told
        and "beam, chord, torsion" in told
    )
    assert "assumed" in told and len(told.splitlines()) < 9


def test_many_designs_are_told_by_their_range():
    told = repr(CASE.vary({"operation.rotor_speed": np.array([40.0, 50.0])}))
    assert "381.972 to 477.465 rpm" in told


def test_a_model_says_its_coordinates_and_what_failed():
    told = repr(CASE.linearize(np.array([0.0, 100.0, 400.0])))
    assert "15 coordinates" in told and "shape (3,)" in told and "gimbal_1s" in told
    assert told.count("1 of 3 failed") == 2 and "Mach" in told
    assert "one point" in repr(CASE.linearize(100.0))


def test_the_margin_at_an_airspeed_is_told_in_words():
    found = CASE.flutter_point("240:440:20kt")
    speed = found.speed * 3600 / 1852

    def at(knots):
        return list(verdict(found, knots / 3600 * 1852, "KTAS", 1852 / 3600))

    assert at(250) == [
        f"Flutter speed {speed:.2f} KTAS ({found.mode}, flutter).",
        f"Margin at 250 KTAS: {100 * (speed / 250 - 1):+.1f} % of that airspeed.",
    ]
    modes = CASE.sweep(np.array([430.0]) * 1852 / 3600)
    count = int((modes.damping_ratio < 0).sum())
    told = f"At 430 KTAS {count} mode{'s are' if count > 1 else ' is'} unstable."
    assert count and told in at(430)
    assert "500 KTAS lies outside the range searched, 240 to 440 KTAS." in at(500)


def test_a_flutter_point_says_the_speed_in_knots_and_all_boundaries():
    found = CASE.flutter_point("100:440:20kt")
    told = repr(found)
    knots = found.speed * 3600 / 1852
    assert f"{knots:.2f} KTAS" in told and "flutter of chord" in told
    assert f"{found.frequency / (2 * math.pi):.4g} Hz" in told
    assert len(told.splitlines()) >= len(found.boundaries)
    undamped = repr(CASE.flutter_point("100:440:20kt", section_damping=False))
    assert "from the start beyond the level: progressive pitch" in undamped
    nothing = repr(CASE.flutter_point("200:240:20kt"))
    assert nothing.startswith(
        "FlutterPoint: nothing becomes unstable between 200 and 240 KTAS; least damping "
    )
    least = CASE.sweep("200:240:20kt").damping_ratio
    assert f"least damping {100 * float(least.min()):.2g} % of critical: " in nothing
    assert "3 % counts" in repr(CASE.flutter_point("300:440:20kt", level=0.03))


def test_boundaries_are_looked_for_in_the_same_range_as_flutter():
    found = CASE.boundaries()
    assert found.boundaries == CASE.flutter_point().boundaries
    told = repr(found)
    assert told.startswith(f"{len(found.boundaries)} boundaries from ")
    assert all(repr(boundary) in told for boundary in found.boundaries)


def test_a_line_without_boundaries_tells_the_least_damping():
    found = CASE.boundaries("200:240:20kt")
    ratio, mode, position = found.least
    told = f"; least damping {100 * ratio:.2g} % of critical: {mode} at {position:.6g}"
    assert repr(found).startswith("0 boundaries from ") and repr(found).endswith(told)


def test_one_input_that_varies_needs_an_airspeed():
    with pytest.raises(pp.InputError, match="airspeeds: must be one airspeed"):
        CASE.boundaries(vary={"rotor.precone": np.linspace(0.01, 0.06, 5)})
