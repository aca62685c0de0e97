"""Points of a CSV file on every plot with two axes: where they stand, and what plots refuse."""

import numpy as np
import pytest
from click.testing import CliRunner

import proprotor as pp
from proprotor import plots
from proprotor.commands.main import main
from proprotor.plots.boundary_against import plot_boundary_against
from proprotor.tables.points import read_points

KNOT = 1852 / 3600
CASE = pp.load_case("xv15-uncoupled")


@pytest.fixture(autouse=True)
def close():
    import matplotlib.pyplot as plt

    yield
    plt.close("all")


@pytest.fixture
def points(tmp_path):
    def write(text):
        path = tmp_path / "points.csv"
        path.write_text(text)
        return read_points(path)

    return write


@pytest.fixture(scope="module")
def sweep():
    return CASE.sweep("200:300:50kt")


def places(ax):
    """Return the points with error bars on axes by label: x, y, and the ends of the bars up."""
    return {
        container.get_label(): (
            *container.lines[0].get_data(),
            *(np.array(bars.get_segments()) for bars in container.lines[2]),
        )
        for container in ax.containers
    }


def test_frequency_and_damping_have_their_own_columns(sweep, points):
    read = points(
        "airspeed [m/s], frequency [Hz], damping [%], damping_error, label\n"
        "120, 3.3, 2, .5, beam\n130, 5.1, , , chord\n140, , 45, 1, torsion\n"
    )
    omega = float(CASE.operation.rotor_speed)
    figure = plots.plot_sweep(sweep, rotor_speed=omega, points=read)
    above, below = figure.axes[:2]
    (x, y), (x2, y2) = places(above)["beam"][:2], places(above)["chord"][:2]
    assert (float(x[0]), float(y[0])) == pytest.approx((120 / KNOT, 3.3 * 2 * np.pi / omega))
    assert (float(x2[0]), float(y2[0])) == pytest.approx((130 / KNOT, 5.1 * 2 * np.pi / omega))
    assert "torsion" not in places(above) and "chord" not in places(below)
    bar = places(below)["beam"][2][0]
    np.testing.assert_allclose(bar[:, 1], [1.5, 2.5])
    assert below.get_ylim()[1] > 46  # an error bar beyond the limits widens the axis
    assert [text.get_text() for text in below.get_legend().get_texts()] == ["beam", "torsion"]
    markers = [plot.containers[-1].lines[0].get_marker() for plot in (above, below)]
    assert len(set(markers)) == 2  # of chord and of torsion: a label keeps its marker in all plots


def test_equivalent_airspeeds_stand_at_their_true_airspeed(points):
    high = pp.load_case("xv15-uncoupled", {"operation.altitude": "20000 ft"})
    found = high.sweep("300:400:50kt")
    ax = plots.plot_damping(found, points=points("airspeed [keas], damping [%]\n250, 2\n"))
    assert float(places(ax)["points.csv"][0][0]) == pytest.approx(250 / np.sqrt(0.5328), rel=1e-4)


def test_per_revolution_of_the_rotor_speed_of_each_point(points):
    found = CASE.sweep("200 kt", {"operation.rotor_speed": np.array([40.0, 50.0])})
    read = points("rotor_speed [rad/s], frequency [Hz]\n45, 5\n")
    ax = plots.plot_frequency(found, rotor_speed=np.array([40.0, 50.0]), points=read)
    assert float(places(ax)["points.csv"][1][0]) == pytest.approx(5 * 2 * np.pi / 45)
    ax = plots.plot_campbell(found, points=read)
    x, y = places(ax)["points.csv"][:2]
    assert (float(x[0]), float(y[0])) == pytest.approx((45 * 30 / np.pi, 5))


def test_maps_root_loci_and_boundaries(sweep, points):
    axes = {"airspeed": "200:300:50kt", "rotor.precone": "0:4:2 deg"}
    ax = plots.plot_stability_map(
        CASE.stability_map(axes),
        points=points("airspeed [ktas], precone [rad], precone_error\n250, .02, .01\n"),
    )
    x, y, bar = places(ax)["points.csv"]
    assert (float(x[0]), float(y[0])) == pytest.approx((250, np.degrees(0.02)))
    np.testing.assert_allclose(bar[0][:, 1], np.degrees([0.01, 0.03]))
    ax = plots.plot_root_locus(
        sweep, rotor_speed=48.0, points=points("growth [1/s], frequency [per rev]\n-2.4, 0.5\n")
    )
    x, y = places(ax)["points.csv"][:2]
    assert (float(x[0]), float(y[0])) == pytest.approx((-0.05, 0.5))


def test_points_on_a_boundary_over_altitude(points):
    case = pp.load_case("xv15-uncoupled", {"operation.altitude": "0 ft"})
    found = case.boundary_against({"operation.altitude": "0:20000:20000 ft"}, "300:360:20keas")
    read = points("altitude [ft], airspeed [keas], airspeed_error\n20000, 310, 10\n")
    ratio = np.sqrt(0.5328)
    for unit, expected in (("ktas", 310 / ratio), ("keas", 310)):
        ax = plot_boundary_against(found, points=read, unit="ft", speed_unit=unit)
        x, y, bar = places(ax)["points.csv"]
        assert (float(x[0]), float(y[0])) == pytest.approx((20000, expected), rel=1e-4)
        assert np.ptp(bar[0][:, 1]) == pytest.approx(20 / 310 * expected, rel=1e-4)
        assert ax.get_ylabel() == f"Airspeed of the boundary, {unit.upper()}"
    lines = {line.get_label(): line for line in ax.lines}
    chord = found.sel(branch="chord").equivalent_airspeed.values / KNOT
    np.testing.assert_allclose(lines["chord"].get_ydata(), chord)


def test_points_at_the_ends_of_an_axis_stand_within(sweep, points):
    ax = plots.plot_damping(sweep, points=points("airspeed [ktas], damping [%]\n200, 20\n300, -5\n"))
    assert ax.get_xlim()[0] < 200 < 300 < ax.get_xlim()[1]
    assert ax.get_ylim()[0] < -5 < 20 < ax.get_ylim()[1]


def test_a_label_is_written_as_it_is(sweep, points):
    """No formula, no hidden label, no character that a terminal or a font cannot show."""
    read = points("airspeed [ktas], damping [%], label\n220, 2, $\\frac$\n230, 3, _own\n240, 3, a\x1bb\n")
    ax = plots.plot_damping(sweep, points=read)
    ax.figure.canvas.draw()
    assert [text.get_text() for text in ax.get_legend().get_texts()][-3:] == ["$\\frac$", "_own", "a b"]


def test_what_plots_refuse(sweep, points):
    with pytest.raises(pp.InputError, match="needs a column damping"):
        plots.plot_damping(sweep, points=points("airspeed [ktas], frequency [Hz]\n200, 3\n"))
    with pytest.raises(pp.InputError, match="needs a column frequency or damping"):
        plots.plot_sweep(sweep, points=points("airspeed [ktas], growth [1/s]\n200, 3\n"))
    with pytest.raises(pp.InputError, match="must be a rotational speed or frequency"):
        plots.plot_frequency(sweep, points=points("airspeed [ktas], frequency [kg]\n200, 3\n"))


def test_commands_draw_points(tmp_path):
    file, png = tmp_path / "points.csv", tmp_path / "plot.png"
    file.write_text("airspeed [ktas], damping [%], precone [deg]\n250, 2, 2\n")
    for arguments in (
        ("sweep", "xv15-uncoupled", "--speed", "200:300:50kt"),
        ("map", "xv15-uncoupled", "--x", "airspeed=200:300:50kt", "--y", "rotor.precone=0:4:2 deg"),
        ("boundary", "xv15-uncoupled", "--against", "rotor.precone=0:4:2 deg", "--scan", "300:400:20kt"),
    ):
        result = CliRunner().invoke(main, (*arguments, "--points", str(file), "--plot", str(png)))
        assert result.exit_code == 0, result.output
        with_points = png.read_bytes()
        CliRunner().invoke(main, (*arguments, "--plot", str(png)))
        assert png.read_bytes() != with_points
        alone = CliRunner().invoke(main, (*arguments, "--points", str(file)))
        assert alone.exit_code == 2 and "goes with --plot" in alone.output
