"""What a reader sees in five seconds: the headline, where modes are unstable, one look for one mode in all pictures."""

import re

import matplotlib
import numpy as np
import pytest
from matplotlib.path import Path

import proprotor as pp
from proprotor import plots
from proprotor.plots import small_print
from proprotor.plots.style import mode_styles
from proprotor.stability.boundary_lines import boundary_lines
from proprotor.stability.margin_ranges import Needed, kept_ranges
from proprotor.tables.boundary_table import of_mode, only_first
from proprotor.tables.sweep_summary import growth_rate

matplotlib.use("Agg")
from matplotlib import pyplot as plt

KNOT = 1852 / 3600
RPM = np.pi / 30
STIFFNESS = "rotor.control_stiffness"
SPEEDS = "50:430:10kt"
CASE = pp.load_case("xv15")


@pytest.fixture(scope="module")
def sweep():
    return CASE.sweep(SPEEDS)


@pytest.fixture(scope="module")
def along():
    return CASE.sweep("350 kt", vary={STIFFNESS: np.linspace(8000, 28000, 41)})


@pytest.fixture(scope="module")
def against():
    return CASE.boundary_against({"operation.rotor_speed": "400:600:50 rpm"}, "250:450:25ktas")


@pytest.fixture(scope="module")
def stability_map():
    stiffness = np.linspace(6000, 40000, 6)
    return CASE.stability_map({"airspeed": "100:440:40kt", STIFFNESS: stiffness})


@pytest.fixture(autouse=True)
def close_figures():
    yield
    plt.close("all")


def stable(case, knots):
    """Whether all eigenvalues of a case at an airspeed have negative real parts, by NumPy."""
    model = case.linearize(knots * KNOT)
    zero, one = np.zeros_like(model.M), np.eye(len(model.M))
    rates = -np.linalg.solve(model.M, np.hstack([model.K, model.C]))
    state = np.vstack([np.hstack([zero, one]), rates])
    return np.linalg.eigvals(state).real.max() < 1e-9


def label(ax, mode):
    return next(
        text.get_text() for text in ax.texts if text.get_text().partition(",")[0].rstrip(" ↑↓") == mode
    )


DRAWN = [plots.plot_frequency, plots.plot_damping, plots.plot_root_locus]


@pytest.mark.parametrize("plot", DRAWN)
def test_names_tell_where_modes_are_unstable(sweep, plot):
    """The numbers after the names lie between the points of the sweep between which the eigenvalue crosses."""
    ax = plot(sweep)
    speeds = sweep.airspeed.values / KNOT
    for mode in ("beam", "chord", "torsion"):
        real = sweep.eigenvalue.sel(mode=mode).values.real
        told = re.findall(r"unstable above (\d+)", label(ax, mode))
        if (real < 0).all():
            assert "unstable" not in label(ax, mode)
            continue
        (place,) = np.flatnonzero((real[:-1] < 0) & (real[1:] >= 0))
        assert len(told) == 1 and speeds[place] <= int(told[0]) <= speeds[place + 1] + 0.5
    assert "unstable" in label(ax, "beam")


def test_every_name_of_an_unstable_root_says_so_wherever_the_name_comes_to_it():
    """Over the highest airspeeds names pass to roots that are unstable already."""
    sweep = CASE.sweep("71:426:7kt")
    ax = plots.plot_damping(sweep)
    unstable = (growth_rate(sweep) > 0).any(axis=0)
    assert unstable.sum() > 3
    for mode, is_unstable in zip(sweep.mode.values.tolist(), unstable, strict=True):
        names = [text.get_text() for text in ax.texts if text.get_text().startswith(mode)]
        assert all(("unstable" in name) == is_unstable for name in names), mode


@pytest.mark.parametrize("plot", DRAWN)
def test_the_headline_of_a_sweep_over_an_input_tells_its_airspeed_and_the_side(along, plot):
    ax = plot(along)
    told = re.fullmatch(r"unstable below (\d+) N·m/rad \((\w+)\), at 350 KTAS", ax.get_title())
    assert told and told[2] == "beam"
    edge = float(told[1])
    assert not stable(pp.load_case("xv15", {STIFFNESS: f"{0.98 * edge} N*m/rad"}), 350)
    assert stable(pp.load_case("xv15", {STIFFNESS: f"{1.02 * edge} N*m/rad"}), 350)
    assert label(ax, "beam").startswith(f"beam, unstable below {told[1]}")


@pytest.mark.parametrize("plot", [plots.plot_frequency, plots.plot_damping])
def test_a_sweep_over_an_input_tells_its_airspeed_in_axes_of_others(along, plot):
    _, ax = plt.subplots()
    assert "at 350 KTAS" in small_print.read(plot(along, ax))
    assert ax.get_title() == ""


def test_what_is_never_or_always_unstable_is_told(sweep):
    def headline(of):
        return plots.plot_damping(of).get_title()

    speeds = sweep.airspeed.values / KNOT
    assert headline(sweep.sel(mode=["torsion"]).isel(airspeed=slice(0, 20))) == (
        f"no mode is unstable from 50 to {speeds[19]:.0f} KTAS"
    )
    late = sweep.isel(airspeed=speeds > 395)
    assert re.fullmatch(r"\w[\w ]* is unstable at 400\?? KTAS already", headline(late))
    assert "beam, unstable throughout" in label(plots.plot_damping(late), "beam")


def test_a_doubtful_boundary_has_its_mark_in_headline_and_names(sweep):
    doubtful = sweep.copy(deep=True)
    doubtful["warning"] = sweep.warning.copy(data=np.full(sweep.warning.shape, "an invented doubt"))
    ax = plots.plot_damping(doubtful)
    assert re.search(r"at \d+\? KTAS", ax.get_title())
    assert re.search(r"above \d+\?$", label(ax, "beam"))


@pytest.mark.parametrize("plot", DRAWN)
def test_two_sweeps_are_told_side_by_side_and_each_origin_once(sweep, plot):
    other = pp.load_case("xv15", {"rotor.precone": "1.5 deg"}).sweep(SPEEDS)
    wing = ["beam", "chord", "torsion"]
    ax = plot(sweep.sel(mode=wing), name="as it is")
    ax = plot(other.sel(mode=wing), ax, name="flatter")
    assert re.fullmatch(
        r"as it is: beam from \d+ KTAS; flatter: beam from \d+ KTAS", ax.get_title().replace("\n", " ")
    )
    told = small_print.read(ax)
    assert told.count("Case xv15") == told.count("”: Case xv15") == 2


def test_sweeps_of_one_origin_have_it_told_with_each_name(sweep):
    told = small_print.read(plots.plot_damping(sweep, plots.plot_damping(sweep)))
    assert told.count("Case xv15") == told.count("”: Case xv15") == 2


@pytest.mark.parametrize("plot", DRAWN)
def test_a_title_of_the_user_takes_the_place_of_the_headline_and_stays(sweep, plot):
    ax = plot(sweep)
    assert "becomes unstable" in ax.get_title()
    ax.set_title("My rotor")
    assert plot(sweep, ax, name="again").get_title() == "My rotor"
    assert [ax.get_title(loc=loc) for loc in ("left", "right")] == ["", ""]


def test_a_mode_looks_the_same_in_sweeps_maps_and_boundaries(sweep, against, stability_map):
    styles = dict(zip(sweep.mode.values.tolist(), mode_styles(sweep), strict=True))
    boundaries = plots.plot_boundary_against(against)
    of_map = plots.plot_stability_map(stability_map, lines=boundary_lines(CASE, stability_map))
    compared = 0
    for ax in (boundaries, of_map):
        for line in ax.lines:
            if (style := styles.get(line.get_label())) is not None:
                assert (line.get_color(), line.get_linestyle()) == (style.color, style.linestyle)
                compared += 1
    assert compared >= 5


def test_the_headline_of_boundaries_is_the_lowest_that_is_drawn(against):
    for shown in (against, only_first(against), of_mode(against, "chord")):
        ax = plots.plot_boundary_against(shown, unit="rpm")
        told = re.fullmatch(r"lowest boundary: (.*) at (\d+)\?? KTAS and (\d+) rpm", ax.get_title())
        assert int(told[2]) == round(float(np.nanmin(shown.airspeed)) / KNOT)
    turned = pp.load_case("xv15", {"operation.rotor_speed": f"{told[3]} rpm"})
    assert stable(turned, 0.9 * float(np.nanmin(against.airspeed)) / KNOT)


def test_the_shaded_side_of_boundaries_is_unstable(against):
    ax = plots.plot_boundary_against(against, unit="rpm")
    grounds = [Path(path.vertices) for patch in ax.collections for path in patch.get_paths()]
    inside = {True: 0, False: 0}
    for rpm in (425.0, 475.0, 525.0, 575.0):
        turned = pp.load_case("xv15", {"operation.rotor_speed": f"{rpm} rpm"})
        for knots in (270, 290, 320, 350, 400, 430):
            shaded = any(path.contains_point((rpm, knots)) for path in grounds)
            near = any(
                path.contains_point((rpm, knots + off)) != shaded for path in grounds[:1] for off in (-4, 4)
            )
            if not near:
                assert shaded != stable(turned, knots), (rpm, knots)
                inside[shaded] += 1
    assert inside[True] > 6 and inside[False] > 4
    names = {text.get_text() for text in ax.texts}
    assert {"stable", "unstable"} <= names


def test_an_instability_of_flight_is_neither_the_lowest_boundary_nor_shaded(against):
    place = int(np.nanargmin(np.nanmin(np.where(against.onset, against.airspeed, np.nan), axis=0)))
    flight = against.copy(deep=True)
    flight["kind"] = against.kind.astype(object)
    flight["kind"][:, place] = "rigid body"
    ax, before = plots.plot_boundary_against(flight), plots.plot_boundary_against(against)
    lowest = float(against.airspeed.isel(branch=place).min()) / KNOT
    assert f"at {lowest:.0f}" in before.get_title() and f"at {lowest:.0f}" not in ax.get_title()
    grounds = [
        min(path.vertices[:, 1].min() for patch in one.collections for path in patch.get_paths())
        for one in (before, ax)
    ]
    assert grounds[0] == pytest.approx(lowest) and grounds[1] > lowest + 1
    assert "nothing is shaded" in small_print.read(ax)


def test_doubtful_boundaries_are_hollow(against):
    doubtful = against.copy(deep=True)
    doubtful["warning"] = against.warning.copy(data=np.full(against.warning.shape, "an invented doubt"))
    ax = plots.plot_boundary_against(doubtful)
    hollow = [
        line for line in ax.lines if line.get_linestyle() == "None" and line.get_markerfacecolor() == "white"
    ]
    assert sum(len(line.get_xdata()) for line in hollow) == int(np.isfinite(against.airspeed).sum())
    assert "Hollow markers: doubtful" in small_print.read(ax)
    assert "?" in ax.get_title()


def test_a_map_marks_the_deck(stability_map):
    own = float(CASE.rotor.control_stiffness)
    assert stability_map[STIFFNESS].attrs["of_deck"] == pytest.approx(own)
    ax = plots.plot_stability_map(stability_map)
    assert "the deck" in {text.get_text() for text in ax.texts}
    assert any(np.allclose(line.get_ydata(), own) for line in ax.lines)
    both = CASE.stability_map(
        {"rotor.precone": "0:4:2 deg", STIFFNESS: np.linspace(6000, 40000, 4)}, airspeed=150.0
    )
    (star,) = (line for line in plots.plot_stability_map(both).lines if line.get_marker() == "*")
    np.testing.assert_allclose(star.get_xydata(), [[2.5, own]])
    beyond = CASE.stability_map(
        {"rotor.precone": "3:4:1 deg", STIFFNESS: np.linspace(6000, 40000, 4)}, airspeed=150.0
    )
    assert "the deck" not in {text.get_text() for text in plots.plot_stability_map(beyond).texts}


def test_the_headline_of_an_envelope_is_its_worst_case():
    settings = {"envelope.dive_speed": "290 keas", "envelope.dive_mach": "0.6"}
    settings |= {"envelope.altitudes": '{ value = [0, 20000], unit = "ft" }'}
    found = pp.load_case("xv15", settings).envelope("200:500:20ktas")
    told = plots.plot_envelope(found).get_title()
    margins = 100 * found.margin.values
    assert f"least margin {np.nanmin(margins):+.0f} %".replace("-", "−") in told
    assert told.startswith("not met") == bool((found.verdict == "not met").any())
    low = found.isel(altitude=[0])
    assert f"{100 * float(low.margin.min()):+.0f} %".replace("-", "−") in plots.plot_envelope(low).get_title()


def test_the_headline_of_margins_is_where_the_first_is_lost():
    """Beside the search that halves between two airspeeds, and beside made-up margins that are kept."""
    loop = pp.ControlLoop(
        name="whirl", sensors="gimbal_1s", inputs="cyclic_1s", gain=0.1, actuator_bandwidth=60.0
    )
    case = CASE.with_control(loop)
    found = case.margins(np.arange(100.0, 181.0, 5.0))
    texts = {text.get_text() for text in plots.plot_margins(found, gain_margin=20.0).texts}
    told = next(filter(None, (re.fullmatch(r"(.*) from (\d+)\?? KTAS", text) for text in texts)), None)
    (kept,) = kept_ranges(case, found, Needed(gain=20.0))
    assert not kept.open_stop and abs(int(told[2]) - kept.stop / KNOT) < 3
    assert kept.lost_by == "gain margin" and told[1] == "whirl has less than 20 dB of gain margin"
    easy = found.assign(gain_margin=found.gain_margin * 0 + 1e3, gain_reduction=found.gain_reduction * 0)
    easy = easy.assign(phase_margin=found.phase_margin * 0 + 3.0, stable=found.stable | True)
    texts = [text.get_text() for text in plots.plot_margins(easy).texts]
    assert any(text.startswith("all loops keep 6 dB and 45 deg from 194.4 to") for text in texts)
