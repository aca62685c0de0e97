"""Points of CSV files: numbers as written with their error bars, and one clear message for each malformed file."""

import numpy as np
import pytest

import proprotor as pp
from proprotor.tables.points import Quantity, read_points

KNOT = 1852 / 3600
RPM = np.pi / 30
AIRSPEED = Quantity("airspeed", "m/s", KNOT, {"keas": 2.0})
ROTOR_SPEED = Quantity("operation.rotor_speed", "rad/s", RPM)
FILE = """# a comment
rotor_speed [rpm], airspeed [ktas], airspeed_error, damping [%], damping_low, damping_high, label, source

458, 285, 10, 2.0, 1.5, 3, Nixon, "thesis, Fig. 8"
500, 305,   ,    ,    ,  , Johnson,
"""


@pytest.fixture
def file(tmp_path):
    def write(text, name="points.csv"):
        path = tmp_path / name
        path.write_bytes(text.encode() if isinstance(text, str) else text)
        return path

    return write


def test_numbers_error_bars_and_words(file):
    points = read_points(file(FILE))
    assert points.label.tolist() == ["Nixon", "Johnson"]
    assert points.source.tolist() == ["thesis, Fig. 8", ""]
    x, y = points.on_axes(ROTOR_SPEED, AIRSPEED)
    np.testing.assert_allclose(x.values, [458, 500], rtol=1e-14)
    np.testing.assert_allclose([y.values, y.low, y.high], [[285, 305], [275, 305], [295, 305]], rtol=1e-14)
    _, damping = points.on_axes(ROTOR_SPEED, Quantity("damping", "", 1.0))
    np.testing.assert_allclose([damping.values[0], damping.low[0], damping.high[0]], [0.02, 0.015, 0.03])
    assert np.isnan(damping.values[1])
    assert points.on_axes(ROTOR_SPEED, Quantity("frequency", "rad/s")) is None


def test_a_file_without_labels_is_its_own_label(file):
    points = read_points(file("operation.rotor_speed [rad/s]; airspeed [m/s]\n48; 150\n", "bell.csv"))
    assert points.label.tolist() == ["bell.csv"]
    x, y = points.on_axes(ROTOR_SPEED, AIRSPEED)
    assert (x.values[0] * RPM, y.values[0] * KNOT) == pytest.approx((48, 150))


def test_units_whose_size_depends_on_the_point(file):
    points = read_points(file("altitude [ft], airspeed [keas]\n0, 300\n20000, 300\n"))
    ratio = np.array([1.0, 0.5328])
    equivalent = lambda x: KNOT / np.sqrt(np.interp(x, [0, 6096], ratio))  # noqa: E731
    up = Quantity("airspeed", "m/s", KNOT, {"keas": equivalent})
    _, y = points.on_axes(Quantity("operation.altitude", "m", 0.3048), up)
    np.testing.assert_allclose(y.values, 300 / np.sqrt(ratio), rtol=1e-12)
    per_rev = read_points(file("airspeed [ktas], frequency [per rev]\n300, 0.5\n"))
    _, frequency = per_rev.on_axes(AIRSPEED, Quantity("frequency", "rad/s", 2 * np.pi, {"per rev": 48.0}))
    assert frequency.values[0] == pytest.approx(0.5 * 48 / (2 * np.pi))


HEAD = "rotor_speed [rpm], airspeed [ktas], airspeed_error [ktas]\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty; its first line must name the columns"),
        (HEAD, "must have 1 to 10000 points"),
        ("airspeed [ktas], label\n300, a\n", "must have a column for each axis"),
        (HEAD + "458, fast\n", r'line 2, column 2 \(airspeed \[ktas\]\): "fast" is no number'),
        (HEAD + "458, 1e999\n", r"line 2, column 2 \(airspeed \[ktas\]\): must be finite"),
        (HEAD + "458, 300, -2\n", r"line 2, column 3 \(airspeed_error \[ktas\]\): must not be negative"),
        (HEAD + "458, 300, 2, 7\n", "line 2: has 4 cells for 3 columns"),
        (
            HEAD.replace("error [ktas]", "error [m/s]") + "4, 5, 1\n",
            r"must have the unit of airspeed \[ktas\]",
        ),
        (
            "rotor_speed [rpm], airspeed [ktas], airspeed_low, airspeed_high\n458, 300, 310, 320\n",
            r"line 2, column 2 \(airspeed \[ktas\]\): must lie between the ends of its error bar",
        ),
        (
            "rotor_speed [rpm], airspeed [ktas], airspeed_low, airspeed_error\n458, 300, 290, 20\n",
            "airspeed: must have airspeed_error or airspeed_low and _high, not both",
        ),
        ("a [m], a [m]\n1, 2\n", '"a" is named twice'),
        (b"\xff\xfd\x00", "must be text in UTF-8"),
    ],
)
def test_files_that_cannot_be(file, text, message):
    with pytest.raises(pp.InputError, match=f"^points = points.csv: .*{message}"):
        read_points(file(text))


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(pp.InputError, match=r"points = none\.csv: no such file"):
        read_points(tmp_path / "none.csv")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "rotor_speed [rpm], damping [%]\n458, 2\n",
            "needs a column airspeed for this plot; it has rotor_speed",
        ),
        ("speed [rpm], airspeed [ktas]\n458, 2\n", "needs a column rotor_speed for this plot"),
        ("rotor_speed [rpm], airspeed [deg]\n458, 2\n", r"column 2 \(airspeed \[deg\]\): must be a speed"),
        (
            "rotor_speed [rpm], airspeed [kias]\n458, 2\n",
            r"column 2 \(airspeed \[kias\]\): must be ktas or keas",
        ),
        ("rotor_speed [rpm], airspeed\n458, 2\n", r"column 2 \(airspeed\): needs a unit"),
        (
            "rotor_speed [m], airspeed [ktas]\n458, 2\n",
            r"column 1 \(rotor_speed \[m\]\): must be a rotational",
        ),
    ],
)
def test_points_that_a_plot_cannot_show(file, text, message):
    with pytest.raises(pp.InputError, match=message):
        read_points(file(text)).check(ROTOR_SPEED, [AIRSPEED])
