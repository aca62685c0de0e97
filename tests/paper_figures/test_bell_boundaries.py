"""Bell's points as the benchmark reads and judges them, and the identity that splits slopes into parts."""

from pathlib import Path

import numpy as np
import pytest

import proprotor as pp
from benchmarks.bell_boundaries import below, relative, root_mean_square, slope_parts
from benchmarks.bell_effects import ACREE
from benchmarks.bell_points import (
    CONFIGURATIONS,
    NONE,
    PUBLISHED,
    SYMMETRIES,
    Crossing,
    Point,
    beside,
    boundaries,
    first_crossings,
    read,
    tip_mach,
)
from proprotor.tables.points import read_points

KNOT = 1852 / 3600
PAGE = Path(__file__).parents[2] / "docs" / "xv15-aircraft.md"
AS_HANDED_OUT = """\
figure,configuration,mode,rotor_rpm,altitude_ft,airspeed_kt
7.2.3,airplane mode (on downstop),wing chord sym,458,0,400
7.2.5,airplane mode; wing and pylon stiffness -20%,wing beam asym,458,0,455
7.2.1,conversion mode 1 deg mast; downstops not engaged,wing chord sym (label SYM),458,0,381
"""


def test_the_40_points_are_read_by_the_benchmark_and_by_every_plot():
    points, drawn = read(), read_points(PUBLISHED)
    assert len(points) == len(drawn.label) == 40
    count = {(name, mode): 0 for name in CONFIGURATIONS for mode in SYMMETRIES}
    for point in points:
        count[point.configuration, point.mode] += 1
    assert list(count.values()) == [10, 7, 9, 3, 7, 4]
    assert [point.airspeed for point in points] == drawn.columns["airspeed"].values.tolist()
    assert set(drawn.label) == {f"{name}: {mode}" for name, mode in count}


def test_points_are_read_in_the_words_of_the_report_too(tmp_path):
    file = tmp_path / "points.csv"
    file.write_text(AS_HANDED_OUT)
    assert read(file) == [
        Point("on the downstop", "chord symmetric", 458, 0, 400),
        Point("20 % less stiff", "beam antisymmetric", 458, 0, 455),
        Point("off the downstop", "chord symmetric", 458, 0, 381),
    ]
    assert set(read(file)) <= set(read())


@pytest.mark.parametrize(
    ("old", "new", "rule"),
    [
        ("rotor_rpm", "rpm", "needs a column"),
        ("458,0,400", "458,0,fast", "line 2.*must be a number"),
        ("airplane mode (on downstop)", "helicopter", "line 2.*must be a configuration"),
        ("wing chord sym,", "pylon yaw,", "line 2.*must be a mode"),
    ],
)
def test_other_points_are_refused(tmp_path, old, new, rule):
    file = tmp_path / "points.csv"
    file.write_text(AS_HANDED_OUT.replace(old, new))
    with pytest.raises(pp.InputError, match=rule):
        read(file)


def test_tip_mach_numbers_of_two_points_of_the_report():
    """By sea-level air: tip speed 244 m/s at 610 rpm, 340.3 m/s of sound."""
    for rpm, airspeed in ((610, 455), (300, 439)):
        mach = tip_mach(Point("", "", rpm, 0, airspeed), CONFIGURATIONS["on the downstop"])
        assert mach == pytest.approx(np.hypot(rpm * np.pi / 30 * 3.81, airspeed * KNOT) / 340.294, rel=1e-5)


def test_bands_hold_the_published_frequency_of_their_mode_alone():
    low, high = CONFIGURATIONS["on the downstop"].band("symmetric")
    assert 3.0 < low < 5.9 < high < 7.9
    low, high = CONFIGURATIONS["20 % less stiff"].band("antisymmetric")
    assert low < np.sqrt(0.8) * 5.6 < np.sqrt(0.8) * 7.3 < high < np.sqrt(0.8) * 19.3


def test_the_softer_aircraft_has_all_stiffness_less():
    whole, soft = (CONFIGURATIONS[name].case().support for name in ("on the downstop", "20 % less stiff"))
    assert whole.names[3:6] == ("symmetric beam", "symmetric chord", "symmetric torsion")
    ratio = np.diag(soft.stiffness)[3:6] / np.diag(whole.stiffness)[3:6]
    np.testing.assert_allclose(ratio, 0.8, rtol=1e-4)  # the axial stiffness stays


@pytest.fixture(scope="module")
def at_458():
    found = boundaries(CONFIGURATIONS["on the downstop"].case(), [458.0])
    return [
        first_crossings(found, one, CONFIGURATIONS["on the downstop"].band(one))[0]
        for one in SYMMETRIES.values()
    ]


def test_a_boundary_is_the_first_onset_of_its_symmetry_in_the_band(at_458):
    point = Point("on the downstop", "chord symmetric", 458, 0, 400)
    assert beside([point]) == {point: at_458[0]}
    case = CONFIGURATIONS["on the downstop"].case()
    found = case.boundaries("150:600:7.5ktas").boundaries
    for symmetry, own in zip(SYMMETRIES.values(), at_458, strict=True):
        low, high = CONFIGURATIONS["on the downstop"].band(symmetry)
        first = next(
            one
            for one in found
            if one.onset and one.mode.startswith(symmetry) and low < one.frequency / (2 * np.pi) < high
        )
        assert own.airspeed == pytest.approx(first.position / KNOT, rel=1e-8)


def test_the_parts_of_a_slope_add_up_to_the_slope(at_458):
    """Boundaries scale with the rotor speed if every input with a time in its units does: dimensions, and no model."""
    case = CONFIGURATIONS["on the downstop"].case()
    for crossing in at_458:
        own = relative(case, crossing)
        parts = slope_parts(own, crossing.airspeed)
        assert sum(parts.values()) == pytest.approx(own["operation.rotor_speed"] / 458, abs=1e-6)


def test_root_mean_square_tells_points_without_a_boundary():
    points = [Point("on the downstop", "chord symmetric", rpm, 0, 400) for rpm in (300, 458, 610)]
    found = dict(zip(points, (Crossing(403, 5, "a"), Crossing(396, 5, "a"), NONE), strict=True))
    assert root_mean_square(found, lambda point: True) == (pytest.approx(np.sqrt(12.5)), 2, 1)
    assert [below(point) for point in points] == [True, True, False]


@pytest.fixture(scope="module")
def found():
    return beside(read())


def test_the_symmetric_boundary_is_near_the_published_points(found):
    """At most 20 kt, root mean square over the points below a tip Mach number of .9: what was asked for, not a fit."""
    chord, beam = (
        root_mean_square(found, lambda point, mode=mode: point.mode == mode and below(point))
        for mode in SYMMETRIES
    )
    assert chord[0] < 20
    assert (chord[1:], beam[1:]) == ((23, 0), (9, 0))
    page = PAGE.read_text()
    assert f"rms **{chord[0]:.1f} kt** below tip Mach .9 ({chord[1]} points)" in page
    assert f"rms **{beam[0]:.1f} kt** below tip Mach .9 ({beam[1]} points)" in page


def test_the_antisymmetric_boundary_lies_between_the_two_published_ones(found):
    point = Point("on the downstop", "beam antisymmetric", 458, 0, 465)
    assert ACREE < found[point].airspeed < 465
