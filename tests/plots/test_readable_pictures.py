"""What a reader sees: no text over another, nothing drawn where nothing is known, options, sweeps apart, in grey."""

import matplotlib
import numpy as np
import pytest

import proprotor as pp
from proprotor import plots
from proprotor.plots import small_print
from proprotor.plots.mode_motion import mode_motion
from proprotor.plots.style import DAMPS, DRIVES, SHEET, STABLE, UNKNOWN, UNSTABLE, mode_styles
from proprotor.rotor.hinged_blade import hinged_blade
from proprotor.stability.boundary_lines import boundary_lines
from proprotor.tables.sweep_summary import broad_modes, damped_frequency, unstable_ranges
from tests.readable import check_texts

matplotlib.use("Agg")
from matplotlib import pyplot as plt

KNOT = 1852 / 3600
RPM = np.pi / 30
CASE = pp.load_case("xv15")
OTHER = pp.load_case("xv15-uncoupled")
STIFFNESS = "rotor.control_stiffness"
SUPPORT = ["beam", "chord", "torsion"]


def blade():
    """A blade that bends in a short flexure, and its hinged blade."""
    r = np.array([0.2, 0.24, 0.26, 0.34, 0.36, 1.0, 2.85, 3.8])
    soft = (r > 0.25) & (r < 0.35)
    stations = pp.BladeStations(
        radius=r,
        mass_per_length=np.full(8, 12.0),
        flatwise_stiffness=np.where(soft, 3e3, 2e7),
        edgewise_stiffness=np.where(soft, 1.2e4, 2e7),
        torsion_stiffness=np.full(8, 2e5),
        twist=np.radians(30 - 8 * r),
        chord=np.full(8, 0.35),
        pitch_inertia_per_length=np.full(8, 0.09),
        pitch_bearing=0.24,
        control_stiffness=3e4,
    )
    return stations, hinged_blade(stations, 458 * RPM, np.radians([10.0, 30.0, 50.0]))


@pytest.fixture(scope="module")
def results():
    loop = pp.ControlLoop(
        name="gimbal", sensors="gimbal_1s", inputs="cyclic_1s", gain=0.1, actuator_bandwidth=60.0
    )
    dive = {"envelope.dive_speed": "270 keas", "envelope.dive_mach": "0.5"}
    dive |= {"envelope.altitudes": '{ value = [0, 10000, 20000], unit = "ft" }'}
    inputs = {STIFFNESS: pp.sampling.Relative(0.8, 1.2), "rotor.precone": pp.sampling.Relative(0.8, 1.2)}
    sampled = pp.study(CASE, pp.sampling.saltelli(inputs, 8), "240:480:60kt", "flutter")
    aircraft = pp.load_case("xv15-aircraft")
    stiffness = np.linspace(6000, 40000, 6)
    stability_map = CASE.stability_map({"airspeed": "100:440:40kt", STIFFNESS: stiffness})
    return {
        "sweep": CASE.sweep("50:400:25kt"),
        "options": CASE.sweep("50:400:25kt", pitch="coupling"),
        "other": OTHER.sweep("50:400:25kt"),
        "aircraft": aircraft.sweep("150:400:50kt"),
        "fan": CASE.sweep("200 kt", vary={"operation.rotor_speed": np.linspace(150, 600, 10) * RPM}),
        "map": stability_map,
        "lines": boundary_lines(CASE, stability_map),
        "fixed": CASE.stability_map({"rotor.precone": "0:4:2 deg", STIFFNESS: stiffness}, airspeed=180.0),
        "against": CASE.boundary_against({"operation.rotor_speed": "400:600:100 rpm"}, "250:450:50ktas"),
        "slopes": CASE.sensitivity(airspeed="300:400:50kt"),
        "origins": CASE.attribution("350 kt", "chord"),
        "gusts": pp.discrete_gust(CASE.linearize(128.0), "10:50:20 m", outputs=["force_x"], duration="0.5 s"),
        "turbulence": pp.gust_response(CASE.linearize(128.0), outputs=["force_x", "moment_y"]),
        "mac": pp.compare_modes(CASE, OTHER.support),
        "motion": mode_motion(CASE, "350 kt", "chord"),
        "margins": CASE.with_control(loop).margins(np.arange(120.0, 181.0, 15.0)),
        "envelope": pp.load_case("xv15", dive).envelope(),
        "sampled": sampled,
        "indices": pp.sobol_indices(sampled),
        "blade": blade(),
    }


@pytest.fixture(autouse=True)
def close_figures():
    yield
    plt.close("all")


def two_sweeps(results):
    ax = plots.plot_damping(results["sweep"])
    return plots.plot_damping(results["other"], ax)


PICTURES = {
    "sweep": lambda r: plots.plot_sweep(
        r["sweep"], rotor_speed=48.0, title=CASE.title, footer="A footer. " * 30
    ),
    "aircraft": lambda r: plots.plot_sweep(r["aircraft"], rotor_speed=48.0, title="A whole aircraft"),
    "frequency": lambda r: plots.plot_frequency(r["sweep"]),
    "damping": lambda r: plots.plot_damping(r["sweep"]),
    "two sweeps": two_sweeps,
    "root locus": lambda r: plots.plot_root_locus(r["sweep"], rotor_speed=48.0),
    "campbell": lambda r: plots.plot_campbell(r["fan"], n_blades=3, rotor_speed=458 * RPM, limits=(0, 25)),
    "map": lambda r: plots.plot_stability_map(r["map"], lines=r["lines"]),
    "fixed airspeed": lambda r: plots.plot_stability_map(r["fixed"]),
    "against": lambda r: plots.plot_boundary_against(r["against"], unit="rpm"),
    "sensitivity": lambda r: plots.plot_sensitivity(r["slopes"]),
    "participation": lambda r: plots.plot_participation(r["sweep"], "chord"),
    "attribution": lambda r: plots.plot_attribution(r["origins"]),
    "gusts": lambda r: plots.plot_time_response(r["gusts"]),
    "turbulence": lambda r: plots.plot_gust_spectra(r["turbulence"]),
    "mac": lambda r: plots.plot_mac(r["mac"]),
    "mode shape": lambda r: plots.plot_mode_shape(r["motion"]),
    "margins": lambda r: plots.plot_margins(r["margins"], title=CASE.title),
    "envelope": lambda r: plots.plot_envelope(r["envelope"]),
    "distribution": lambda r: plots.plot_distribution(r["sampled"]),
    "indices": lambda r: plots.plot_sobol(r["indices"]),
}
OF_NO_CASE = {
    "blade": lambda r: plots.plot_blade_frequencies(*r["blade"], (0.0, 60.0)),
}


def test_every_kind_of_plot_is_among_the_pictures():
    """By the names that the code of the pictures calls."""
    pictures = (PICTURES | OF_NO_CASE).values()
    called = {name for draw in pictures for name in (*draw.__code__.co_names, *two_sweeps.__code__.co_names)}
    assert {name for name in plots.__all__ if name.startswith("plot_")} <= called


def draw(results, name):
    plot = (PICTURES | OF_NO_CASE)[name](results)
    figure = plot.get_figure(root=True)
    figure.draw_without_rendering()
    return figure


@pytest.mark.parametrize("name", PICTURES | OF_NO_CASE)
def test_no_text_stands_over_another_or_beyond_the_figure(results, name):
    check_texts(draw(results, name))


@pytest.mark.parametrize("name", PICTURES)
def test_case_and_options_stand_in_every_picture(results, name):
    figure = draw(results, name)
    told = small_print.read(figure.axes[0])
    assert "default options" in told and "Case xv15" in told
    (text,) = (text for text in figure.texts if text.get_label() == told)
    assert " ".join(text.get_text().split()) == " ".join(told.split())


def test_options_that_are_no_defaults_are_told_in_own_and_in_given_axes(results):
    own = plots.plot_damping(results["options"])
    _, axes = plt.subplots(2, 2, figsize=(12, 10))
    for ax in axes.flat:
        plots.plot_damping(results["options"].sel(mode=SUPPORT), ax)
    for ax in (own, *axes.flat):
        assert "options: pitch coupling" in small_print.read(ax)
    figure = axes[0, 0].get_figure()
    figure.draw_without_rendering()
    for ax in axes.flat:
        (block,) = (text for text in ax.texts if text.get_label() == small_print.read(ax))
        box = block.get_window_extent()
        below = [other.bbox.y1 for other in axes.flat if other.bbox.y1 < ax.bbox.y0 - 1]
        assert box.y0 > max(below, default=figure.bbox.y0)
        assert box.y1 < ax.xaxis.label.get_window_extent().y0


def test_nothing_stands_where_a_title_may(results):
    """Lines leave the axes of both, and are told in small print; a title takes the place of the headline."""
    for plot in (plots.plot_damping, plots.plot_root_locus):
        ax = plot(results["sweep"])
        assert not any(ax.get_title(loc=loc) for loc in ("left", "right"))
        assert "Beyond the axis of" in small_print.read(ax)


def failing(sweep, places):
    failed = sweep.copy(deep=True)
    for name in ("eigenvalue", "frequency", "damping_ratio"):
        failed[name][places] = np.nan
    failed["reason"][places] = "no trim was found"
    return failed


def pixels(figure):
    figure.canvas.draw()
    return np.asarray(figure.canvas.buffer_rgba())[..., :3].astype(int)


@pytest.mark.parametrize("plot", [plots.plot_frequency, plots.plot_damping])
@pytest.mark.parametrize("places", [[5, 6], [12, 13, 14], [14]])
def test_no_line_crosses_a_stretch_that_could_not_be_analysed(results, plot, places):
    """The pixels within the stretch are those of a picture without any mode: white, grey hatches, the fill, a cross."""
    sweep = failing(results["sweep"].sel(mode=SUPPORT), places)
    ax = plot(sweep, limits=(-5, 20))
    figure = ax.get_figure()
    figure.draw_without_rendering()
    speeds = sweep.airspeed.values / KNOT
    left, right = (speeds[places[0] - 1] + speeds[places[0]]) / 2, speeds[places[-1]]
    columns = [round(ax.transData.transform((x, 0))[0]) for x in (left, right)]
    height = figure.bbox.height
    rows = [round(height - ax.bbox.y1) + 3, round(height - ax.bbox.y0) - 8]
    inside = pixels(figure)[rows[0] : rows[1], columns[0] + 2 : columns[1] - 2]
    assert inside.size
    coloured = np.ptp(inside, axis=-1) > 40
    assert not coloured.any()
    stretches = [patch for patch in ax.patches if patch.get_hatch()]
    assert [patch.get_x() for patch in stretches] == [pytest.approx(left)]


def test_labels_of_lines_that_end_early_are_not_joined_to_them(results):
    ax = plots.plot_damping(failing(results["sweep"].sel(mode=SUPPORT), [14]))
    for line in ax.lines:
        if line.get_transform() == ax.transAxes and line.get_linewidth() < 1:
            raise AssertionError("a thin line joins a label to a line that ends before the edge")
    ax = plots.plot_damping(results["sweep"].sel(mode=SUPPORT))
    joined = [line for line in ax.lines if line.get_transform() == ax.transAxes and line.get_linewidth() < 1]
    assert len(joined) == len(SUPPORT)


def name_of(text):
    """The name of a line beside axes, without where its mode is unstable."""
    return text.get_text().partition(", unstable")[0].rstrip(" ↑↓")


@pytest.mark.parametrize("plot", [plots.plot_frequency, plots.plot_damping, plots.plot_root_locus])
@pytest.mark.parametrize(
    ("other", "names"), [("other", ("xv15", "xv15-uncoupled")), ("options", None), ("again", None)]
)
def test_two_sweeps_on_one_axes_differ_in_label_dashes_and_markers(results, plot, other, names):
    first = results["sweep"].sel(mode=SUPPORT)
    second = first if other == "again" else results[other].sel(mode=SUPPORT)
    ax = plot(second, plot(first))
    names = (
        names
        or {"options": ("default options", "options: pitch coupling"), "again": ("sweep 1", "sweep 2")}[other]
    )
    lines = {line.get_label(): line for line in ax.lines if "," in line.get_label()}
    assert set(lines) == {f"{mode}, {name}" for mode in SUPPORT for name in names}
    assert set(lines) <= {name_of(text) for text in ax.texts}
    for mode in SUPPORT:
        one, two = (lines[f"{mode}, {name}"] for name in names)
        assert one.get_color() == two.get_color()
        assert one._dash_pattern != two._dash_pattern
        if plot is not plots.plot_root_locus:
            assert one.get_markerfacecolor() != two.get_markerfacecolor()
    assert all(f"“{name}”" in small_print.read(ax) for name in names if other == "again")
    own = plot(second, plot(first), name="mine")
    assert {"beam, mine"} < {line.get_label() for line in own.lines}


def luminance(colour):
    """Return the relative luminance of a colour (IEC 61966-2-1), which is what a grey print keeps."""
    rgb = np.array(matplotlib.colors.to_rgb(colour))
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    return float(linear @ (0.2126, 0.7152, 0.0722))


def contrast(one, other):
    bright, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (bright + 0.05) / (dark + 0.05)


def test_fields_and_bars_differ_on_a_grey_print():
    assert contrast(DRIVES, DAMPS) > 2
    assert contrast(STABLE, UNSTABLE) > 1.15
    assert UNKNOWN["hatch"] and contrast(UNKNOWN["edgecolor"], UNSTABLE) > 1.8


def test_broad_lines_differ_by_more_than_colour(results):
    """On a grey print each broad line has a marker of its own; the two halves of an aircraft differ in dashes."""
    for sweep in (results["sweep"], results["aircraft"]):
        broad = broad_modes(sweep)
        styles = [
            (style.marker, str(style.linestyle))
            for mode, style in zip(sweep.mode.values.tolist(), mode_styles(sweep), strict=True)
            if mode in broad
        ][: 2 * 7]
        assert len(set(styles)) == len(styles)
        assert all(marker for marker, _ in styles)


def test_the_first_boundary_is_told_with_its_frequency(results):
    sweep = results["sweep"]
    figure = plots.plot_sweep(sweep, rotor_speed=48.0, title="A title")
    first = min(unstable_ranges(sweep), key=lambda found: found.start)
    at = int(np.searchsorted(sweep.airspeed.values, first.start))
    branch = sweep.branch.values[at - 1 : at + 1] == first.branch
    ends = damped_frequency(sweep)[at - 1 : at + 1][branch]
    told = next(text.get_text() for text in figure.texts if "becomes unstable" in text.get_text())
    mode, rest = told.split(" becomes unstable at ")
    assert mode == first.mode and rest.startswith(f"{first.start / KNOT:.0f} KTAS: ")
    hertz, per_rev = (float(part.split()[0]) for part in rest.partition(": ")[2].split(", "))
    assert ends.min() / (2 * np.pi) - 0.006 < hertz < ends.max() / (2 * np.pi) + 0.006
    assert per_rev == pytest.approx(2 * np.pi * hertz / 48.0, abs=0.006)
    names = [text.get_text() for text in figure.axes[1].texts]
    assert f"{first.mode}, unstable above {first.start / KNOT:.0f}" in names


def test_a_map_tells_its_airspeed_and_what_is_not_known(results):
    assert f"at {180 / KNOT:.4g} KTAS" in small_print.read(plots.plot_stability_map(results["fixed"]))
    failed = results["fixed"].copy(deep=True)
    failed["growth"][:2, :2] = np.nan
    ax = plots.plot_stability_map(failed)
    (hatched,) = (one for one in ax.collections if one.get_hatch())
    growth = failed.growth.transpose(*[str(name) for name in failed.axis.values][::-1]).values
    known = np.isfinite(growth)
    cells = known[:-1, :-1] & known[1:, :-1] & known[:-1, 1:] & known[1:, 1:]
    assert len(hatched.get_paths()) == (~cells).sum() > 0
    assert matplotlib.colors.to_hex(ax.get_facecolor()).upper() == UNSTABLE


def test_settings_of_a_user_go_before_the_style_sheet(results):
    before = dict(matplotlib.rcParams)
    plots.plot_participation(results["sweep"], "chord")
    assert dict(matplotlib.rcParams) == before
    with matplotlib.rc_context({"axes.labelsize": 17.0}):
        ax = plots.plot_participation(results["sweep"], "chord")
    assert ax.xaxis.label.get_fontsize() == 17 != SHEET["axes.labelsize"]
    assert ax.xaxis.get_ticklabels()[0].get_fontsize() == SHEET["xtick.labelsize"]
