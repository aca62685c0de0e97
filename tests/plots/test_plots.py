"""The drawings of a sweep: they go where they are told to, and show what they say."""

from itertools import pairwise

import matplotlib
import numpy as np
import pytest

import proprotor as pp
from proprotor.plots import plot_damping, plot_frequency, plot_sweep, small_print
from proprotor.tables.sweep_summary import leaps, unstable_ranges

matplotlib.use("Agg")
from matplotlib import pyplot as plt

KNOT = 1852 / 3600


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


@pytest.fixture(scope="module")
def sweep(case):
    return case.sweep("50:400:10kt")


@pytest.fixture(autouse=True)
def close_figures():
    yield
    plt.close("all")


def line_of(ax, label):
    return next(line for line in ax.lines if line.get_label() == label)


def points_of(ax, label):
    """What is drawn of a line (2, points), without the gaps in it."""
    points = np.array(line_of(ax, label).get_xydata()).T
    return points[:, np.isfinite(points[1])]


@pytest.mark.parametrize("plot", [plot_frequency, plot_damping])
def test_a_plot_goes_into_the_axes_given_and_returns_them(sweep, plot):
    figure, (left, right) = plt.subplots(1, 2)
    assert plot(sweep, right) is right
    assert not left.lines
    assert plt.get_fignums() == [figure.number]


@pytest.mark.parametrize("plot", [plot_frequency, plot_damping])
def test_a_plot_makes_its_own_axes_without_any(sweep, plot):
    assert plot(sweep).lines


def test_lines_are_the_numbers_of_the_sweep(case, sweep):
    figure = plot_sweep(sweep, rotor_speed=case.operation.rotor_speed)
    above, below = figure.axes
    for mode in sweep.mode.values.tolist():
        data = sweep.sel(mode=mode)
        airspeed = sweep.airspeed / KNOT
        per_rev, percent = data.frequency / case.operation.rotor_speed, 100 * data.damping_ratio
        np.testing.assert_allclose(points_of(above, mode), [airspeed, per_rev])
        np.testing.assert_allclose(points_of(below, mode), [airspeed, percent])
    assert below.get_ylim() == (-5, 20)
    assert "KTAS" in below.get_xlabel()
    assert "per rev" in above.get_ylabel()
    assert "critical" in below.get_ylabel()


def test_a_line_is_broken_where_its_name_leaps_to_another_root_and_goes_on_where_roots_veer(sweep):
    """Near 130 kt chord and regressive lag exchange motions at 7 % of critical; near 380 kt a name leaps to 80 %."""
    leaping = leaps(sweep)
    passes = sweep.branch.values[1:] != sweep.branch.values[:-1]
    assert (leaping & ~passes).sum() == 0 and (passes & ~leaping).any() and leaping.any()
    ax = plot_damping(sweep)
    for place, mode in enumerate(sweep.mode.values.tolist()):
        x, y = np.array(line_of(ax, mode).get_xydata()).T
        gaps = x[np.isnan(y)]
        between = sweep.airspeed.values[np.flatnonzero(leaping[:, place])] / KNOT
        np.testing.assert_allclose(gaps, between + 5)
    chord = sweep.eigenvalue.sel(mode="chord").values
    assert not leaping[:, sweep.mode.values.tolist().index("chord")].any()
    assert np.abs(np.diff(chord)).max() < 0.03 * np.abs(chord).min()
    told = plot_sweep(sweep).texts
    assert any("broken" in text.get_text() for text in told)


def test_frequency_is_in_hertz_when_the_rotor_speed_is_not_known(sweep):
    ax = plot_frequency(sweep)
    assert "Hz" in ax.get_ylabel()
    np.testing.assert_allclose(points_of(ax, "beam")[1], sweep.frequency.sel(mode="beam") / (2 * np.pi))


def test_no_two_modes_look_the_same(sweep):
    ax = plot_damping(sweep)
    lines = [line_of(ax, mode) for mode in sweep.mode.values.tolist()]
    assert len({(line.get_color(), line.get_linestyle()) for line in lines}) == len(lines)


def test_labels_do_not_overlap_and_stay_in_the_figure(case, sweep):
    figure = plot_sweep(sweep, rotor_speed=case.operation.rotor_speed, title="title", footer="footer")
    figure.draw_without_rendering()
    for ax in figure.axes:
        labels = [text for text in ax.texts if text.get_text() in sweep.mode.values]
        assert len(labels) > 8
        boxes = sorted((text.get_window_extent() for text in labels), key=lambda box: box.y0)
        assert all(low.y1 <= high.y0 for low, high in pairwise(boxes))
        assert all(ax.bbox.x1 < box.x0 and box.x1 < figure.bbox.x1 for box in boxes)


def test_modes_that_leave_the_axis_are_named(sweep):
    ax = plot_damping(sweep)
    low, high = ax.get_ylim()
    percent = 100 * sweep.damping_ratio
    outside = ~((percent >= low) & (percent <= high)).any("airspeed")
    named = small_print.read(ax).partition("Beyond the axis of damping: ")[2].partition(".")[0].split(", ")
    assert outside.any() and named == sweep.mode.values[outside.values].tolist()
    beside = {text.get_text().partition(", unstable")[0].rstrip(" ↑↓") for text in ax.texts}
    assert set(sweep.mode.values[~outside.values].tolist()) <= beside


def test_boundaries_are_marked_on_the_zero_line(sweep):
    circles = next(line for line in plot_damping(sweep).lines if line.get_marker() == "o")
    speeds = []
    for found in unstable_ranges(sweep):
        speeds += [found.start] * (not found.open_start) + [found.stop] * (not found.open_stop)
    assert len(speeds) > 0
    np.testing.assert_allclose(circles.get_xdata(), np.array(speeds) / KNOT)
    np.testing.assert_array_equal(circles.get_ydata(), 0)


def test_failed_airspeeds_are_gaps_with_a_mark(case):
    sweep = case.sweep("0:600:100kt")
    failed = sweep.reason.values != ""
    assert failed.any()
    for plot in (plot_frequency, plot_damping):
        ax = plot(sweep)
        crosses = next(line for line in ax.lines if line.get_marker() == "x")
        np.testing.assert_allclose(crosses.get_xdata(), sweep.airspeed.values[failed] / KNOT)
        np.testing.assert_array_equal(np.isnan(line_of(ax, "beam").get_ydata()), failed)
        assert "could not be analysed" in ax.get_xlabel()


@pytest.mark.parametrize("speeds", ["300 kt", "300:350:50kt"])
def test_short_sweeps_can_be_drawn(case, speeds):
    figure = plot_sweep(case.sweep(speeds), rotor_speed=case.operation.rotor_speed)
    figure.draw_without_rendering()


def test_the_footer_of_a_figure_can_say_what_it_rests_on(sweep):
    figure = plot_sweep(sweep, footer="9 inputs are assumed.")
    assert any("9 inputs are assumed." in text.get_text().replace("\n", " ") for text in figure.texts)


def test_an_unknown_unit_is_an_input_error(sweep):
    with pytest.raises(pp.InputError, match="speed"):
        plot_damping(sweep, unit="kg")


@pytest.mark.parametrize(
    ("growth", "expected"),
    [
        ((-1, -1, 3), [(12.5, 20, False, True)]),
        ((1, -1, -1), [(0, 5, True, False)]),
        ((-1, 1, -3), [(5, 12.5, False, False)]),
        ((1, 1, 1), [(0, 20, True, True)]),
        ((1, -1, 1), [(0, 5, True, False), (15, 20, False, True)]),
        ((-1, 0, 0), []),
        ((-1, np.nan, 1), [(10, 20, False, True)]),
        ((np.nan, 1, 1), [(10, 20, True, True)]),
    ],
)
def test_unstable_ranges_are_interpolated_between_neighbouring_points(sweep, growth, expected):
    few = sweep.isel(airspeed=slice(3), mode=slice(1)).assign_coords(airspeed=[0.0, 10.0, 20.0])
    few["eigenvalue"] = ("airspeed", "mode"), np.array(growth)[:, None] + 2j
    assert [found[1:5] for found in unstable_ranges(few)] == expected
