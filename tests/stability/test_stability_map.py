"""Stability in the plane of two inputs, against boundaries found along lines."""

import numpy as np
import pytest

import proprotor as pp
from proprotor.stability.boundary_lines import boundary_lines
from proprotor.stability.map import _Edges, _lines, largest_growth, stability_map
from tests.known_systems import linear_model

KNOT = 1852 / 3600
STIFFNESS = "rotor.control_stiffness"


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


@pytest.fixture(scope="module")
def plane(case):
    own = case.given[STIFFNESS].si
    return case.stability_map({STIFFNESS: np.linspace(0.8, 1.3, 6) * own, "airspeed": "340:400:10kt"})


def test_the_boundary_is_that_found_along_airspeed(case, plane):
    """Where a line of the grid at one stiffness crosses, the flutter point of that stiffness is."""
    vertices = plane.boundary.values
    checked = 0
    for value in plane[STIFFNESS].values[1:-1]:
        on_line = vertices[np.abs(vertices[:, 0] - value) < 1e-9 * value]
        expected = case.vary({STIFFNESS: value}).flutter_point("340:400:10kt").speed
        if np.isfinite(expected):
            assert np.abs(on_line[:, 1] - expected).min() < 1e-7 * expected
            checked += 1
    assert checked >= 3


def test_points_have_the_growth_of_single_points(case, plane):
    for row, column in ((0, 0), (3, 2), (6, 5)):
        design = case.vary({STIFFNESS: plane[STIFFNESS].values[column]})
        modes = design.linearize(plane.airspeed.values[row]).modes()
        critical = modes.eigenvalue.values[modes.eigenvalue.values.real.argmax()]
        assert plane.growth.values[row, column] == pytest.approx(critical.real, rel=1e-9)
        assert plane.frequency.values[row, column] == pytest.approx(abs(critical.imag), rel=1e-9)


def test_failed_points_carry_their_reason(case):
    found = stability_map(case, {"airspeed": [150.0, 160.0, 400.0], "rotor.precone": [0.02, 0.04, 0.06]})
    assert np.isnan(found.growth.values[:, 2]).all() and "Mach" in found.reason.values[0, 2]
    assert found.growth.dims == ("rotor.precone", "airspeed")
    assert np.isfinite(found.growth.values[:, :2]).all()


def test_a_circle_is_one_closed_line():
    """Crossings of x² + y² = 1 with a grid, joined in order."""
    grid = np.linspace(-1.5, 1.5, 8)
    x, y = np.meshgrid(grid, grid)
    largest = 1 - x**2 - y**2
    first, last, crossing = [], [], []
    for (row, column), value in np.ndenumerate(largest):
        for other in ((row, column + 1), (row + 1, column)):
            if max(other) < 8 and (largest[other] > 0) != (value > 0):
                a = np.array([grid[column], grid[row]])
                b = np.array([grid[other[1]], grid[other[0]]])
                way = np.roots([(b - a) @ (b - a), 2 * a @ (b - a), a @ a - 1])
                share = next(t for t in way if 0 <= t <= 1)
                first.append((row, column))
                last.append(other)
                crossing.append(a + share * (b - a))
    places = _lines(_Edges(*(np.array(part) for part in (first, last, crossing, crossing))), largest)
    assert len(places) == len(first) + 1 and places[0] == places[-1]
    line = np.array(crossing)[places]
    np.testing.assert_allclose((line**2).sum(axis=1), 1)
    angle = np.unwrap(np.arctan2(line[:, 1], line[:, 0]))
    assert np.all(np.diff(angle) > 0) or np.all(np.diff(angle) < 0)


@pytest.mark.parametrize("height", [0.3, -0.3])
def test_at_a_saddle_the_boundary_parts_what_the_middle_keeps_apart(height):
    """x y + height on a square of four corners: the corners of the sign that the middle has are joined."""
    largest = np.array([[1.0, -1.0], [-1.0, 1.0]]) + height
    crossings = {((0, 0), (0, 1)): (0.0, -1.0), ((0, 0), (1, 0)): (-1.0, 0.0),
                 ((0, 1), (1, 1)): (1.0, 0.0), ((1, 0), (1, 1)): (0.0, 1.0)}  # fmt: skip
    points = np.array(list(crossings.values()))
    edges = _Edges(*(np.array(part) for part in zip(*crossings, strict=True)), points, points[:, 0])
    places = _lines(edges, largest)
    parts = np.split(places, np.flatnonzero(places < 0))
    middles = sorted(tuple(points[part[part >= 0]].mean(axis=0)) for part in parts)
    corner = 0.5 if height > 0 else -0.5  # the corners cut off: (1, -1) and (-1, 1), or (-1, -1) and (1, 1)
    assert middles == sorted([(0.5, -corner), (-0.5, corner)])


def test_the_level_shifts_the_growth():
    """ζ = 0.02: growth at a level of 0.05 is that of the missing damping."""
    model = linear_model(np.eye(1)[None], 0.4 * np.eye(1)[None], 100 * np.eye(1)[None])
    found, value = largest_growth(model, 0.05)
    assert found == pytest.approx([10 * (0.05 - 0.02)]) and abs(value[0]) == pytest.approx(10)


@pytest.mark.parametrize(
    ("axes", "options", "message"),
    [
        ({"airspeed": [100.0, 150.0]}, {}, "two inputs"),
        ({"airspeed": [150.0, 100.0], "rotor.precone": [0.0, 0.1]}, {}, "rise"),
        ({"rotor.radius": [3.0, 4.0], "rotor.precone": [0.0, 0.1]}, {}, "must be given"),
        ({"airspeed": [100.0, 150.0], "rotor.precone": [0.0, 0.1]}, {"airspeed": 100.0}, "already"),
        ({"airspeed": [100.0, 150.0], "rotor.precon": [0.0, 0.1]}, {}, "did you mean"),
    ],
)
def test_what_cannot_be_mapped_is_told(case, axes, options, message):
    with pytest.raises(pp.InputError, match=message):
        stability_map(case, axes, **options)


def test_the_lines_of_a_damping_level_are_named_after_the_modes_that_have_it():
    """The root at the level has a real part, by which another may be nearer to the imaginary axis."""
    case, level = pp.load_case("xv15-uncoupled"), -0.1
    axes = {"airspeed": np.linspace(160.0, 280.0, 8), "rotor.precone": np.deg2rad([1.0, 1.5, 2.0])}
    lines = boundary_lines(case, case.stability_map(axes, level=level))
    assert lines
    for line in lines:
        middle = len(line.x) // 2
        modes = case.vary({"rotor.precone": line.y[middle]}).sweep([line.x[middle]]).isel(airspeed=0)
        found = modes.sel(mode=line.mode)
        assert found.damping_ratio.item() == pytest.approx(level, rel=1e-6)
        assert found.frequency.item() == pytest.approx(line.frequency[middle], rel=1e-6)


def test_a_line_ends_at_the_last_edge_before_a_failed_point():
    """Growth changes sign between the second and the third column; the second point of the first row has failed."""
    largest = np.tile([-2.0, -1.0, 1.0], (3, 1))
    largest[0, 1] = np.nan
    first, last = np.array([[1, 1], [2, 1]]), np.array([[1, 2], [2, 2]])
    edges = _Edges(first, last, first.astype(float), first[:, 0].astype(float))
    assert _lines(edges, largest).tolist() == [0, 1]
