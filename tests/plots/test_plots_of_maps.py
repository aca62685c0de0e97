"""The stability map: the shaded side is stable, its edge is the boundary, and lines have the name of their mode."""

import matplotlib
import numpy as np
import pytest
import xarray
from matplotlib.path import Path

import proprotor as pp
from proprotor import plots
from proprotor.plots import small_print
from proprotor.stability.boundary_lines import boundary_lines
from proprotor.stability.modes import decomposition

matplotlib.use("Agg")
from matplotlib import pyplot as plt

KNOT = 1852 / 3600
STIFFNESS = "rotor.control_stiffness"


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


@pytest.fixture(scope="module")
def found(case):
    return case.stability_map({"airspeed": "100:440:20kt", STIFFNESS: np.linspace(6000, 40000, 16)})


@pytest.fixture(scope="module")
def lines(case, found):
    return boundary_lines(case, found)


@pytest.fixture(autouse=True)
def close_figures():
    yield
    plt.close("all")


def shaded(ax):
    return [Path(path.vertices) for path in ax.collections[0].get_paths()]


def made_up(growth, boundary=((np.nan, np.nan),)):
    rows, columns = np.shape(growth)
    return xarray.Dataset(
        {
            "growth": (("b", "a"), np.array(growth, dtype=float)),
            "boundary": (("vertex", "axis"), np.array(boundary)),
        },
        {"a": np.arange(columns, dtype=float), "b": np.arange(rows, dtype=float), "axis": ["a", "b"]},
    )


def test_a_map_goes_into_the_axes_given_with_units_on_both(found):
    _, (left, right) = plt.subplots(1, 2)
    assert plots.plot_stability_map(found, right, units={STIFFNESS: "ft*lbf/rad"}) is right
    assert not left.lines
    assert right.get_xlabel() == "Airspeed, KTAS"
    assert right.get_ylabel() == "Control stiffness (ft·lbf/rad)"
    np.testing.assert_allclose(right.get_xlim(), (100, 440))
    with pytest.raises(pp.InputError):
        plots.plot_stability_map(found, units={STIFFNESS: "kt"})


def test_the_boundary_that_is_drawn_is_the_one_that_was_found(found):
    ax = plots.plot_stability_map(found)
    (line,) = (line for line in ax.lines if len(line.get_xdata()) == len(found.vertex))
    np.testing.assert_allclose(line.get_xdata() * KNOT, found.boundary.values[:, 0])
    np.testing.assert_allclose(line.get_ydata(), found.boundary.values[:, 1])


def test_the_shaded_side_is_stable_at_points_between_those_of_the_grid(case, found):
    ax = plots.plot_stability_map(found)
    rng = np.random.default_rng(4)
    points = rng.uniform((110, 7000), (430, 39000), (60, 2))
    model = case.vary({STIFFNESS: points[:, 1]}).linearize(points[:, 0] * KNOT)
    stable = decomposition(model).values.real.max(axis=-1) <= 1e-9
    inside = np.any([path.contains_points(points) for path in shaded(ax)], axis=0)
    assert stable.any() and not stable.all()
    # between crossings the edge is straight, so a point right at it may be on the other side
    assert (inside == stable).mean() > 0.96


def test_shading_ends_at_crossings_in_every_kind_of_cell():
    one_corner = made_up([[-1, 1], [1, 1]], [(0.3, 0.0), (0.0, 0.8)])
    (polygon,) = plots.plot_stability_map(one_corner).collections[0].get_paths()
    assert {tuple(point) for point in polygon.vertices.tolist()} == {(0, 0), (0.3, 0), (0, 0.8)}
    apart = made_up([[-1, 3], [3, -1]], [(0.2, 0.0), (1.0, 0.8), (0.8, 1.0), (0.0, 0.2)])
    assert len(plots.plot_stability_map(apart).collections[0].get_paths()) == 2
    joined = made_up([[-3, 1], [1, -3]], [(0.8, 0.0), (1.0, 0.2), (0.2, 1.0), (0.0, 0.8)])
    (polygon,) = plots.plot_stability_map(joined).collections[0].get_paths()
    assert len({tuple(point) for point in polygon.vertices.tolist()}) == 6


def test_cells_with_a_failed_corner_are_left_blank_and_marked():
    ax = plots.plot_stability_map(made_up([[-1, -1, -1], [-1, -1, np.nan]]))
    assert len(ax.collections[0].get_paths()) == 1
    (crosses,) = (line for line in ax.lines if line.get_marker() == "x")
    assert crosses.get_xydata().tolist() == [[2.0, 1.0]]
    assert "could not be analysed" in small_print.read(ax)


def test_regions_are_named_on_their_own_side(found):
    ax = plots.plot_stability_map(found)
    words = {text.get_text(): text for text in ax.texts}
    for word, expected in (("stable", True), ("unstable", False)):
        at = ax.transData.inverted().transform(ax.transAxes.transform(words[word].get_position()))
        assert any(path.contains_point(at) for path in shaded(ax)) == expected


def test_lines_have_the_name_of_the_mode_that_is_neutral_on_them(case, found, lines):
    assert len(lines) > 1
    for line in lines:
        place = len(line.x) // 2
        modes = case.vary({STIFFNESS: line.y[place]}).sweep(line.x[place : place + 1]).isel(airspeed=0)
        root = modes.eigenvalue.sel(mode=line.mode).item()
        assert abs(root.real) < 1e-5 * abs(root)
        assert abs(root.imag) == pytest.approx(line.frequency[place], rel=1e-6)
    drawn = np.unique(np.concatenate([np.column_stack([line.x, line.y]) for line in lines]), axis=0)
    wanted = found.boundary.values[np.isfinite(found.boundary.values).all(axis=1)]
    np.testing.assert_allclose(drawn, np.unique(wanted, axis=0))


def test_named_lines_are_labelled_once_each_and_differ(found, lines):
    ax = plots.plot_stability_map(found, lines=lines)
    named = [line for line in ax.lines if not line.get_label().startswith("_")]
    labels = [line.get_label() for line in named]
    assert sorted(labels) == sorted({line.mode for line in lines})
    assert set(labels) <= {text.get_text() for text in ax.texts}
    assert len({(line.get_color(), line.get_linestyle()) for line in named}) == len(named)
    ax.get_figure().draw_without_rendering()
    frame = ax.get_window_extent()
    for text in (text for text in ax.texts if not text.get_text().startswith("Case ")):
        box = text.get_window_extent()
        assert frame.x0 <= box.x0 and box.x1 <= frame.x1 and frame.y0 <= box.y0 and box.y1 <= frame.y1


def test_a_level_of_damping_is_told(case):
    found = case.stability_map(
        {"airspeed": "200:400:50kt", STIFFNESS: np.linspace(8000, 30000, 4)}, level=0.01
    )
    assert "1 % of critical" in small_print.read(plots.plot_stability_map(found))
