"""Root locus, Campbell's diagram, participation, and sweeps over an input: what is drawn is what was found."""

from itertools import pairwise

import matplotlib
import numpy as np
import pytest

import proprotor as pp
from proprotor import plots
from proprotor.plots import small_print
from proprotor.plots.style import COLOURS, mode_styles

matplotlib.use("Agg")
from matplotlib import pyplot as plt

KNOT = 1852 / 3600
RPM = np.pi / 30
FOOT_POUND = 0.3048 * 4.4482216152605


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


@pytest.fixture(scope="module")
def sweep(case):
    return case.sweep("50:400:10kt")


@pytest.fixture(scope="module")
def fan(case):
    return case.sweep("200 kt", vary={"operation.rotor_speed": np.linspace(150, 600, 31) * RPM})


@pytest.fixture(scope="module")
def along_stiffness(case):
    stiffness = np.linspace(5000, 12000, 15) * FOOT_POUND
    return case.sweep("370 kt", vary={"rotor.control_stiffness": stiffness})


@pytest.fixture(autouse=True)
def close_figures():
    yield
    plt.close("all")


def line_of(ax, label):
    return next(line for line in ax.lines if line.get_label() == label)


@pytest.mark.parametrize(
    "plot",
    [
        lambda data, ax: plots.plot_root_locus(data["sweep"], ax),
        lambda data, ax: plots.plot_campbell(data["fan"], ax),
        lambda data, ax: plots.plot_participation(data["sweep"], "chord", ax),
    ],
)
def test_a_plot_goes_into_the_axes_given_and_returns_them(sweep, fan, plot):
    figure, (left, right) = plt.subplots(1, 2)
    assert plot({"sweep": sweep, "fan": fan}, right) is right
    assert not left.lines and not left.patches
    assert right.get_xlabel() and (right.get_ylabel() or right.get_yticklabels())
    assert plt.get_fignums() == [figure.number]
    figure.draw_without_rendering()


def test_a_root_locus_has_the_roots_of_the_sweep(case, sweep):
    omega = case.operation.rotor_speed
    ax = plots.plot_root_locus(sweep, rotor_speed=omega)
    for mode in sweep.mode.values.tolist():
        roots = sweep.eigenvalue.sel(mode=mode).values / omega
        drawn = np.array(line_of(ax, mode).get_xydata())
        drawn = drawn[np.isfinite(drawn[:, 0])]  # without gaps where the name leaps to another root
        np.testing.assert_allclose(drawn, np.column_stack([roots.real, np.abs(roots.imag)]), atol=1e-9)
    assert "per rev" in ax.get_xlabel() and "per rev" in ax.get_ylabel()
    assert "rad/s" in plots.plot_root_locus(sweep).get_xlabel()


def test_markers_of_a_root_locus_stand_at_round_speeds_and_grow(sweep):
    ax = plots.plot_root_locus(sweep, marks=100)
    at = np.flatnonzero(np.isin(np.round(sweep.airspeed.values / KNOT), (100, 200, 300, 400)))
    for mode, marks in zip(sweep.mode.values.tolist(), ax.collections, strict=False):
        roots = sweep.eigenvalue.sel(mode=mode).values[at]
        np.testing.assert_allclose(
            marks.get_offsets(), np.column_stack([roots.real, np.abs(roots.imag)]), atol=1e-6
        )
        assert all(small < large for small, large in pairwise(marks.get_sizes()))
    assert "every 100, growing from 100 to 400 KTAS" in small_print.read(ax)


def test_rays_of_a_root_locus_have_the_damping_ratio_they_tell(sweep):
    ax = plots.plot_root_locus(sweep)
    told = [float(text.get_text().removesuffix(" %")) for text in ax.texts if text.get_text().endswith(" %")]
    rays = [
        line
        for line in ax.lines
        if len(line.get_xdata()) == 2 and line.get_xdata()[0] == 0 > line.get_xdata()[1]
    ]
    found = [100 * -x / np.hypot(x, y) for x, y in (ray.get_xydata()[1] for ray in rays)]
    np.testing.assert_allclose(found, [50, 20, 10, 5, 2, 1])
    assert set(told) <= {50, 20, 10, 5, 2, 1} and {50, 20, 10} <= set(told)
    ax.get_figure().draw_without_rendering()
    for text in (text for text in ax.texts if text.get_text().endswith(" %")):  # at the end of its own ray
        ray = rays[[50, 20, 10, 5, 2, 1].index(float(text.get_text().removesuffix(" %")))]
        np.testing.assert_allclose(text.xy, ray.get_xydata()[1])


def test_a_root_locus_holds_modes_of_the_support_and_unstable_ones(sweep):
    ax = plots.plot_root_locus(sweep)
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    for mode in ("beam", "chord", "torsion"):
        roots = sweep.eigenvalue.sel(mode=mode).values
        assert left < roots.real.min() and roots.real.max() < right
        assert low <= np.abs(roots.imag).min() and np.abs(roots.imag).max() < high
    outside = small_print.read(ax).partition("growth or frequency: ")[2]
    assert "flap" in outside and "chord" not in outside


def test_campbell_has_frequencies_in_hertz_over_rpm_and_its_rays(fan):
    ax = plots.plot_campbell(fan, harmonics=(1, 3), rotor_speed=458 * RPM)
    for mode in fan.mode.values.tolist():
        line = line_of(ax, mode)
        np.testing.assert_allclose(line.get_xdata(), np.linspace(150, 600, 31))
        np.testing.assert_allclose(line.get_ydata(), fan.frequency.sel(mode=mode) / (2 * np.pi))
    rays = [
        line
        for line in ax.lines
        if line.get_label().startswith("_") and len(line.get_xdata()) == 2 and not line.get_xydata()[0].any()
    ]
    np.testing.assert_allclose([y / x for x, y in (ray.get_xydata()[1] for ray in rays)], [1 / 60, 3 / 60])
    assert {"1/rev", "3/rev", "458 rpm"} <= {text.get_text() for text in ax.texts}
    assert "(rpm)" in ax.get_xlabel() and "(Hz)" in ax.get_ylabel()


def test_campbell_marks_multiples_of_the_blades_and_refuses_other_sweeps(sweep, fan):
    ax = plots.plot_campbell(fan, n_blades=3)
    strong = {
        text.get_text() for text in ax.texts if text.get_text().endswith("/rev") and text.get_color() == "0.1"
    }
    assert strong == {"3/rev"}
    with pytest.raises(pp.InputError, match="rotor_speed"):
        plots.plot_campbell(sweep)
    with pytest.raises(pp.InputError):
        plots.plot_campbell(fan, unit="kg")


def test_a_sweep_over_an_input_is_drawn_over_it(along_stiffness):
    ax = plots.plot_damping(along_stiffness, unit="ft*lbf/rad")
    np.testing.assert_allclose(line_of(ax, "chord").get_xdata(), np.linspace(5000, 12000, 15))
    np.testing.assert_allclose(
        line_of(ax, "chord").get_ydata(), 100 * along_stiffness.damping_ratio.sel(mode="chord"), atol=1e-6
    )
    assert ax.get_xlabel() == "Control stiffness (ft·lbf/rad)"
    assert plots.plot_frequency(along_stiffness).get_xlabel() == "Control stiffness (N·m/rad)"
    with pytest.raises(pp.InputError):
        plots.plot_damping(along_stiffness, unit="kt")


def test_boundaries_of_a_sweep_over_an_input_are_where_damping_changes_sign(along_stiffness):
    ax = plots.plot_damping(along_stiffness)
    circles = next(line for line in ax.lines if line.get_marker() == "o" and not line.get_label().isalpha())
    chord = along_stiffness.eigenvalue.sel(mode="chord").values.real
    stiffness = along_stiffness["rotor.control_stiffness"].values
    (place,) = np.flatnonzero((chord[:-1] > 0) & (chord[1:] <= 0))
    crossing = np.interp(0, -chord[place : place + 2], stiffness[place : place + 2])
    assert np.isclose(circles.get_xdata(), crossing).any()


def test_failed_points_are_gaps_everywhere(case):
    failing = case.sweep("0:600:100kt")
    failed = failing.reason.values != ""
    assert failed.any() and not failed.all()
    locus = plots.plot_root_locus(failing, marks=100)
    np.testing.assert_array_equal(np.isnan(line_of(locus, "beam").get_ydata()), failed)
    assert (
        np.isnan(np.ma.filled(locus.collections[0].get_offsets(), np.nan)).any(axis=1).sum() == failed.sum()
    )
    at = plots.plot_participation(failing, "beam")
    assert [text.get_text() for text in at.get_legend().get_texts()] == ["100 KTAS", "500 KTAS"]
    still = case.sweep("0 kt", vary={"operation.rotor_speed": np.array([40.0, 50.0])})
    ax = plots.plot_campbell(still)
    assert "could not be analysed" in ax.get_xlabel()
    ax.get_figure().draw_without_rendering()


def test_participation_bars_are_the_shares_of_the_sweep(sweep):
    ax = plots.plot_participation(sweep, "chord", at=[200, 400])
    names = [label.get_text() for label in ax.get_yticklabels()]
    for bars, speed in zip(ax.containers, (200, 400), strict=True):
        share = sweep.participation.sel(mode="chord").isel(airspeed=(speed - 50) // 10)
        drawn = dict(zip(names, (bar.get_width() for bar in bars), strict=True))
        assert drawn["chord"] == pytest.approx(100 * float(share.sel(dof="chord")))
        assert drawn["lag 1s"] == pytest.approx(100 * float(share.sel(dof="lag_1s")))
        assert sum(drawn.values()) == pytest.approx(100)
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["200 KTAS", "400 KTAS"]
    assert "%" in ax.get_xlabel()


def test_participation_refuses_what_it_cannot_draw(sweep):
    with pytest.raises(pp.InputError, match="did you mean chord"):
        plots.plot_participation(sweep, "cord")
    with pytest.raises(pp.InputError, match="at most"):
        plots.plot_participation(sweep, "chord", at=[100, 150, 200, 250, 300, 350])


def test_a_mode_looks_the_same_in_every_plot_and_unlike_any_other(sweep):
    styles = dict(zip(sweep.mode.values.tolist(), mode_styles(sweep), strict=True))
    assert len({(style.color, style.linestyle) for style in styles.values()}) == len(styles)
    for ax in (plots.plot_frequency(sweep), plots.plot_damping(sweep), plots.plot_root_locus(sweep)):
        for mode, style in styles.items():
            line = line_of(ax, mode)
            assert (line.get_color(), line.get_linestyle()) == (style.color, style.linestyle)


def test_colours_differ_in_brightness_or_are_told_apart_without_red_and_green():
    """Simulated deuteranopia (Machado and others 2009, severity 1) leaves every two colours apart."""
    deuteranopia = np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    )
    rgb = np.array([matplotlib.colors.to_rgb(colour) for colour in COLOURS])
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    seen = np.clip(linear @ deuteranopia.T, 0, 1) ** (1 / 2.4)
    distance = np.linalg.norm(seen[:, None] - seen[None], axis=-1) + np.eye(len(seen))
    assert distance.min() > 0.12


@pytest.mark.parametrize("beside", [True, False])
def test_what_a_case_rests_on_stands_beneath_and_takes_nothing_from_the_plot(case, sweep, beside):
    ax = plots.plot_root_locus(sweep) if beside else plots.plot_participation(sweep, "chord")
    figure = ax.get_figure()
    figure.draw_without_rendering()
    height, before = figure.get_size_inches()[1], ax.get_window_extent().height
    assert plots.rests_on(ax, case, "First of all.") is ax
    figure.draw_without_rendering()
    (text,) = figure.texts
    told = text.get_text().replace("\n", " ")
    assert told.startswith("First of all.") and "assumed" in told and "Calibration" in told
    assert figure.get_size_inches()[1] > height
    assert ax.get_window_extent().height == pytest.approx(before, rel=0.02)
    below = min(ax.get_tightbbox().y0, ax.xaxis.label.get_window_extent().y0)
    assert text.get_window_extent().y0 >= 0 and text.get_window_extent().y1 <= below
    assert text.get_window_extent().x1 <= figure.bbox.x1


@pytest.fixture(scope="module")
def of_aircraft():
    return pp.load_case("xv15-aircraft").sweep("150:400:125kt")


def overlaps(boxes):
    """Return how many neighbours among the boxes of texts overlap, from the lowest to the highest."""
    boxes = sorted(boxes, key=lambda box: box.y0)
    return sum(low.y1 > high.y0 + 1 for low, high in pairwise(boxes))


def test_the_names_of_an_aircrafts_modes_have_room(of_aircraft):
    figure = plots.plot_sweep(of_aircraft, rotor_speed=458 * RPM, title="XV-15 aircraft")
    figure.canvas.draw()
    above, below = figure.axes
    for ax in (above, below):
        names = [text for text in ax.texts if text.get_text().startswith(("symmetric", "antisymmetric"))]
        boxes = [text.get_window_extent() for text in names]
        assert len(names) >= 12 and not overlaps(boxes)
        assert max(box.x1 for box in boxes) <= figure.bbox.width
        assert max(box.y1 for box in boxes) <= ax.bbox.y1 + 8
        assert "24 other modes are not drawn" in small_print.read(ax)
    assert figure._suptitle.get_window_extent().y0 >= above.get_window_extent().y1


def test_symmetric_and_antisymmetric_modes_of_one_motion_have_one_colour(of_aircraft):
    axes = plots.plot_root_locus(of_aircraft), plots.plot_damping(of_aircraft)
    for ax in axes:
        chord = [line_of(ax, f"{half} chord") for half in ("symmetric", "antisymmetric")]
        assert chord[0].get_color() == chord[1].get_color()
        assert chord[0].get_linestyle() == "-" and chord[1].get_linestyle() == "--"
        drawn = {line.get_label() for line in ax.lines}
        assert "symmetric coning" not in drawn and "antisymmetric torsion" in drawn
    support = of_aircraft.isel(mode=slice(18))
    styles = [(style.color, style.linestyle) for style in mode_styles(support)]
    assert len(set(styles)) == len(styles)


def test_an_axis_is_no_higher_than_its_lines_need(sweep, case):
    """Half the usual axis where all lines stay below it, unless limits were given or a further sweep is higher."""
    wing = sweep.sel(mode=["beam", "chord"])
    low, high = wing.copy(deep=True), wing.copy(deep=True)
    low["damping_ratio"][:] = np.minimum(wing.damping_ratio, 0.085)
    high["damping_ratio"][:] = 0.12
    ax = plots.plot_damping(low)
    assert ax.get_ylim() == (-5, 10)
    assert plots.plot_damping(high, ax).get_ylim() == (-5, 20)
    assert plots.plot_damping(low, limits=(-1, 30)).get_ylim() == (-1, 30)
    omega = case.operation.rotor_speed
    assert plots.plot_frequency(wing, rotor_speed=omega).get_ylim() == (0, 2.5)
    assert plots.plot_frequency(sweep, rotor_speed=omega).get_ylim() == (0, 5)
