"""Airfoil tables: interpolation and its derivatives, where not to trust them, what the rotor makes of them.

Every table is made up, of a formula or of `tests.c81_files`; none is that of a real airfoil.
"""

import pickle
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import proprotor as pp
from proprotor.errors import InputError
from proprotor.rotor.airfoil import Warns
from proprotor.rotor.airfoil_table import AirfoilTable
from tests.c81_files import made_up_tables
from tests.oracles.comparison import assert_matrices_match

NAMES = ("lift", "drag", "moment")
BEYOND_STALL = "angle of attack beyond stall"
BEYOND_ALPHA = "angle of attack outside the airfoil table"
BEYOND_MACH = "Mach number outside the airfoil table"
MADE_UP = {name: (np.deg2rad(alpha), mach, c) for name, (alpha, mach, c) in made_up_tables().items()}
TABLE = AirfoilTable(**MADE_UP, name="made up")


def parts(coefficients, name):
    """Value, derivative with angle and derivative with Mach number of one coefficient."""
    return tuple(getattr(coefficients, f"{name}_coefficient{of}") for of in ("", "_alpha", "_mach"))


def table_of(function, alpha, mach, **changes) -> AirfoilTable:
    """A table whose lift is a function of angle and Mach number."""
    lift = function(alpha[:, None], mach) + np.zeros((len(alpha), len(mach)))
    return AirfoilTable(
        **{"alpha": alpha, "mach": mach, "lift": lift, "drag": 0 * lift, "moment": 0 * lift} | changes
    )


@pytest.mark.parametrize("name", NAMES)
def test_nodes_are_met_exactly(name):
    alpha, mach, values = MADE_UP[name]
    at_nodes = parts(TABLE.coefficients(alpha[:, None], mach), name)[0]
    np.testing.assert_allclose(at_nodes, values, rtol=0, atol=1e-14)


def central_difference(function, x, step=1e-5):
    """Of fifth order: exact for a cubic, but for rounding."""
    far, near = function(x + 2 * step) - function(x - 2 * step), function(x + step) - function(x - step)
    return (8 * near - far) / (12 * step)


@pytest.mark.parametrize("name", NAMES)
def test_derivatives_are_those_of_the_interpolation(name):
    rng = np.random.default_rng(1)
    alpha, mach = rng.uniform(-np.pi, np.pi, 20_000), rng.uniform(0.0, 0.95, 20_000)
    alpha[:10_000] = rng.uniform(-0.5, 0.5, 10_000)
    knots = [
        (np.abs(x[:, None] - nodes) > 3e-5).all(axis=1)
        for x, nodes in zip((alpha, mach), MADE_UP[name][:2], strict=True)
    ]
    alpha, mach = alpha[knots[0] & knots[1]], mach[knots[0] & knots[1]]

    def value(a, m):
        return parts(TABLE.coefficients(a, m), name)[0]

    _, by_alpha, by_mach = parts(TABLE.coefficients(alpha, mach), name)
    np.testing.assert_allclose(
        by_alpha, central_difference(lambda a: value(a, mach), alpha), rtol=1e-7, atol=1e-7
    )
    np.testing.assert_allclose(
        by_mach, central_difference(lambda m: value(alpha, m), mach), rtol=1e-7, atol=1e-7
    )


@pytest.mark.parametrize("name", NAMES)
def test_value_and_derivatives_are_continuous_across_cells(name):
    alpha, mach, _ = MADE_UP[name]
    rng, hair = np.random.default_rng(2), 1e-12
    of_alpha, of_mach = rng.uniform(alpha[0] - 0.1, alpha[-1] + 0.1, 200), rng.uniform(-0.1, 1.1, 200)
    for here in ((alpha[:, None], of_mach), (of_alpha[:, None], mach[1:-1])):
        for step in ((hair, 0.0), (0.0, hair)):
            below, above = (
                parts(TABLE.coefficients(here[0] + sign * step[0], here[1] + sign * step[1]), name)
                for sign in (-1, 1)
            )
            for left, right in zip(below, above, strict=True):
                np.testing.assert_allclose(left, right, rtol=0, atol=2e-9)


def test_a_complex_step_gives_the_derivatives():
    rng = np.random.default_rng(3)
    alpha, mach = rng.uniform(-4, 4, 500), rng.uniform(-0.1, 1.1, 500)
    by_alpha, by_mach = TABLE.coefficients(alpha + 1e-30j, mach), TABLE.coefficients(alpha, mach + 1e-30j)
    for name in NAMES:
        _, slope, mach_slope = parts(TABLE.coefficients(alpha, mach), name)
        np.testing.assert_allclose(parts(by_alpha, name)[0].imag / 1e-30, slope, rtol=1e-13, atol=1e-13)
        np.testing.assert_allclose(parts(by_mach, name)[0].imag / 1e-30, mach_slope, rtol=1e-13, atol=1e-13)


def test_a_stall_leaves_the_linear_range_alone():
    alpha = np.deg2rad(np.arange(-10, 21, 2.0))
    table = table_of(lambda a, m: np.where(a < 0.21, 6 * a, 0.7), alpha, np.array([0.0, 0.8]))
    within = np.deg2rad(np.linspace(-10, 10, 1001))  # the last node before the peak at 12 deg
    slope = parts(table.coefficients(within, 0.3), "lift")[1]
    np.testing.assert_allclose(slope, 6, rtol=1e-12)


@given(st.integers(0, 10_000))
def test_no_overshoot_along_rows_and_columns(seed):
    rng = np.random.default_rng(seed)
    alpha, mach = np.cumsum(rng.uniform(0.01, 0.3, 8)) - 1, np.cumsum(rng.uniform(0.01, 0.2, 5))
    values = rng.choice([-1.0, 0.0, 0.3, 1.0, 20.0], (8, 5))
    table = AirfoilTable(alpha=alpha, mach=mach, lift=values, drag=0 * values, moment=values)
    share = np.linspace(0, 1, 21)
    for along, nodes, across in ((0, alpha, mach), (1, mach, alpha)):
        between = (nodes[:-1, None] + share * np.diff(nodes)[:, None])[..., None]  # (cells, 21, 1)
        here = (between, across) if along == 0 else (across, between)
        found = parts(table.coefficients(*here), "lift")[0]
        ends = np.moveaxis(values, along, 0)
        low, high = np.minimum(ends[:-1], ends[1:]), np.maximum(ends[:-1], ends[1:])
        assert np.all((found >= low[:, None] - 1e-12) & (found <= high[:, None] + 1e-12))


def test_straight_beyond_the_angles_and_held_beyond_the_mach_numbers():
    alpha, mach, moment = MADE_UP["moment"]
    end = parts(TABLE.coefficients(alpha[-1], 0.3), "moment")
    value, slope, by_mach = parts(TABLE.coefficients(alpha[-1] + 0.2, 0.3), "moment")
    np.testing.assert_allclose((value, slope), (end[0] + 0.2 * end[1], end[1]), rtol=1e-13)
    step = parts(TABLE.coefficients(alpha[-1] + 0.2, 0.3 + 1e-30j), "moment")[0]
    assert by_mach == pytest.approx(step.imag / 1e-30)
    for beyond, column in ((-0.1, 0), (1.2, -1)):
        value, slope, by_mach = parts(TABLE.coefficients(alpha, beyond), "moment")
        np.testing.assert_allclose(value, moment[:, column], atol=1e-15)
        np.testing.assert_array_equal(by_mach, 0)
        np.testing.assert_allclose(
            slope, parts(TABLE.coefficients(alpha, mach[column]), "moment")[1], atol=1e-14
        )


def test_a_table_of_the_whole_circle_closes_on_itself():
    alpha = np.deg2rad(np.arange(-180, 181, 5.0))
    table = table_of(lambda a, m: np.sin(2 * a + 0.3), alpha, np.array([0.0, 0.5]))
    angles = np.linspace(-3, 3, 100)
    for turns in (-2, 1, 3):
        there = table.coefficients(angles + 2 * np.pi * turns, 0.2)
        for one, other in zip(
            parts(there, "lift"), parts(table.coefficients(angles, 0.2), "lift"), strict=True
        ):
            np.testing.assert_allclose(one, other, rtol=0, atol=1e-12)
    seam = [parts(table.coefficients(side * np.pi, 0.2), "lift") for side in (-1, 1)]
    np.testing.assert_allclose(*seam, rtol=0, atol=1e-14)
    assert seam[0][1] == pytest.approx(2 * np.cos(0.3), rel=0.02)  # no end of a table
    assert not np.any(table.warnings(np.array([-np.pi, np.pi, 40.0]), 0.2)[BEYOND_ALPHA])


def test_ends_that_disagree_do_not_close():
    table = table_of(lambda a, m: a, np.array([-np.pi, 0.0, np.pi]), np.array([0.0, 0.5]))
    assert parts(table.coefficients(np.pi + 1, 0.1), "lift")[0] == pytest.approx(np.pi + 1)
    assert table.warnings(np.pi + 1, 0.1)[BEYOND_ALPHA]


def test_any_shape():
    for shape in ((), (1,), (3, 4), (0,)):
        coefficients = TABLE.coefficients(np.full(shape, 0.1), 0.3)
        assert all(np.shape(number) == shape for number in coefficients)
        assert all(mask.shape == shape for mask in TABLE.warnings(np.full(shape, 0.1), 0.3).values())
    assert TABLE.coefficients(np.zeros((5, 1)), np.zeros(7)).lift_coefficient.shape == (5, 7)


def test_not_a_number_in_and_out():
    for alpha, mach in ((np.nan, 0.3), (0.1, np.nan), (np.inf, 0.3)):
        assert np.isnan(parts(TABLE.coefficients(np.array([alpha]), np.array([mach])), "lift")[0]).all()


def test_where_a_table_is_not_to_be_trusted():
    assert isinstance(TABLE, Warns)
    mach = np.array([0.0, 0.5, 1.0])
    alpha = np.deg2rad([-10.0, 0.0, 8.0, 12.0])
    lift = np.array([[-1, -0.9, -0.8], [0, 0, 0], [0.9, 0.7, 0.5], [1.2, 0.6, 0.5]])
    own = (np.deg2rad([-20.0, 20.0]), np.array([0.0, 0.6]), np.zeros((2, 2)))
    table = AirfoilTable(alpha=alpha, mach=mach, lift=lift, drag=0 * lift, moment=own)
    # (angle in deg, Mach number): beyond stall, beyond the angles, beyond the Mach numbers
    expected = {
        (0.0, 0.5): (False, False, False),
        (11.9, 0.0): (False, False, False),  # lift rises to the end of the table
        (8.1, 0.5): (True, False, False),
        (7.9, 0.5): (False, False, False),
        (8.1, 1.0): (True, False, True),  # moment ends at Mach 0.6; a plateau is a stall
        (-10.1, 0.5): (False, True, False),
        (12.1, 0.2): (False, True, False),
        (0.0, 1.1): (False, False, True),
    }
    angle, speed = np.array(list(expected)).T
    masks = table.warnings(np.deg2rad(angle), speed)
    found = zip(
        *(masks[reason].tolist() for reason in (BEYOND_STALL, BEYOND_ALPHA, BEYOND_MACH)), strict=True
    )
    assert dict(zip(expected, found, strict=True)) == expected


def test_stall_angles_on_both_sides_and_between_columns():
    alpha = np.deg2rad([-14.0, -12, -10, 0, 10, 14, 16])
    lift = np.array([[-0.9, -0.8], [-1.1, -0.9], [-1.0, -0.95], [0, 0], [0.9, 0.8], [1.2, 0.7], [1.1, 0.6]])
    table = AirfoilTable(alpha=alpha, mach=[0.2, 0.6], lift=lift, drag=0 * lift, moment=0 * lift)
    for mach, lowest, highest in (
        (0.2, -12, 14),
        (0.6, -10, 10),
        (0.4, -11, 12),
        (0.1, -12, 14),
        (0.9, -10, 10),
    ):
        angle = np.deg2rad([lowest - 0.01, lowest + 0.01, highest - 0.01, highest + 0.01])
        assert table.warnings(angle, mach)[BEYOND_STALL].tolist() == [True, False, False, True]


def test_a_single_column_holds_at_every_mach_number():
    alpha = np.array([-0.3, 0.0, 0.3])
    table = table_of(lambda a, m: 6 * a, alpha, np.array([0.2]))
    value, slope, by_mach = parts(table.coefficients(0.1, np.array([0.0, 0.2, 0.9])), "lift")
    np.testing.assert_allclose(value, 0.6, rtol=1e-14)
    np.testing.assert_allclose(slope, 6, rtol=1e-14)
    np.testing.assert_array_equal(by_mach, 0)
    assert not table.warnings(0.1, np.array([0.0, 0.2, 0.9]))[BEYOND_MACH].any()
    assert not table.contains_compressibility
    assert TABLE.contains_compressibility


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        (
            {"alpha": [0.0, 10.0]},
            "lift: the angle of attack must lie between -180 and 180 deg, -π and π rad (row 2)",
        ),
        ({"alpha": [0.1, 0.1]}, "lift: angles of attack must increase from row to row (row 2)"),
        ({"mach": [0.5, 0.4]}, "lift: Mach numbers must increase from column to column (mach)"),
        ({"mach": [0.5, np.nan]}, "lift: Mach numbers must lie between 0 and 10 (mach)"),
        ({"mach": [-0.1, 0.4]}, "lift: Mach numbers must lie between 0 and 10 (mach)"),
        ({"moment": [[0, 0], [0, np.inf]]}, "moment: coefficients must be finite and at most 1000 (row 2)"),
        ({"drag": [[0, -0.1], [0, 0]]}, "drag: coefficients must not be less than 0 (row 1)"),
        (
            {"lift": [[0, 1, 2]]},
            "lift = array of shape (1, 3): must have 2 rows, one for each angle, and 2 columns",
        ),
        ({"lift": [[0, 1], [2]]}, "lift: must be numbers at every angle of attack and Mach number"),
        ({"alpha": None}, "lift: must have two angles of attack or more and a list of Mach numbers"),
        ({"mach": 0.3}, "lift: must have two angles of attack or more and a list of Mach numbers"),
        (
            {"drag": ([0.0], [0.3], [[1.0]])},
            "drag: must have two angles of attack or more and a list of Mach",
        ),
    ],
)
def test_arrays_that_are_no_table(changes, line):
    flat = {"alpha": [-0.1, 0.1], "mach": [0.0, 0.5]} | {name: np.zeros((2, 2)) for name in NAMES}
    AirfoilTable(**flat)
    with pytest.raises(InputError) as caught:
        AirfoilTable(**flat | changes)
    assert str(caught.value).startswith(line)


def test_a_table_keeps_its_values_and_can_be_pickled():
    lift = np.array([[-0.6, -0.6], [0.6, 0.6]])
    table = AirfoilTable(
        alpha=[-0.1, 0.1], mach=[0.0, 0.5], lift=lift, drag=np.zeros((2, 2)), moment=np.zeros((2, 2))
    )
    lift[:] = 9
    for copy in (table, pickle.loads(pickle.dumps(table))):
        assert parts(copy.coefficients(0.05, 0.2), "lift")[:2] == pytest.approx((0.3, 6.0))
    assert repr(TABLE) == "AirfoilTable(name='made up')"


# What the rotor makes of a table: the same matrices as of the linear airfoil it was sampled from.

LINEAR = pp.Airfoil(lift_slope=5.8, zero_lift_angle=-0.03, drag=0.009, moment=-0.02)
XV15 = pp.load_case("xv15-uncoupled")
SPEEDS = np.array([60.0, 110.0, 150.0])


def matrices(airfoil, **options):
    return pp.rotor_model(replace(XV15.rotor, airfoil=airfoil), XV15.operation, SPEEDS, **options)


def assert_same(model, expected, relative):
    still = matrices(LINEAR, airloads="none").M
    for point in range(len(SPEEDS)):
        one, other = ([getattr(m, name)[point] for name in "MCK"] for m in (model, expected))
        speed = XV15.operation.rotor_speed
        assert_matrices_match(one, other, still[point], speed, expected.dofs, relative, relative / 10)


def sampled(mach, factor) -> AirfoilTable:
    """The linear airfoil as a table, lift and moment times a factor that depends on Mach number."""
    alpha = np.deg2rad([-180.0, -40, -7, -1, 0, 2, 30, 175])
    ones = np.ones((len(alpha), len(mach)))
    c = LINEAR.coefficients(alpha[:, None], mach)
    return AirfoilTable(
        alpha=alpha,
        mach=mach,
        lift=c.lift_coefficient * factor(mach) * ones,
        drag=c.drag_coefficient * ones,
        moment=c.moment_coefficient * factor(mach) * ones,
    )


@pytest.mark.parametrize("airloads", ["full", "lift-slope"])
@pytest.mark.parametrize("compressibility", [True, False])
def test_a_table_of_the_linear_airfoil_gives_its_matrices(compressibility, airloads):
    options = {"compressibility": compressibility, "airloads": airloads}
    # With Mach columns the table would be taken to hold compressibility itself.
    mach = [0.0] if compressibility else [0.0, 0.3, 0.5, 0.9]
    table = sampled(np.array(mach), lambda mach: 1.0)
    model, expected = matrices(table, **options), matrices(LINEAR, **options)
    assert expected.trim.converged.all()
    np.testing.assert_allclose(model.trim.collective, expected.trim.collective, rtol=0, atol=1e-12)
    assert_same(model, expected, 1e-9)


@pytest.mark.parametrize(("columns", "relative"), [(18, 1e-4), (4001, 1e-9)])
def test_a_table_with_compressibility_in_it_gives_the_matrices_of_the_factor(columns, relative):
    """As near as the columns are: every 0.05 Mach, as tables are, and as one likes."""
    table = sampled(np.linspace(0.0, 0.85, columns), lambda mach: 1 / np.sqrt(1 - mach**2))
    expected = matrices(LINEAR, compressibility=True)
    assert_same(matrices(table, compressibility=False), expected, relative)


def test_trim_tells_what_a_table_does_not_know():
    warned = matrices(TABLE, compressibility=False).trim.warning
    short = table_of(lambda a, m: 6 * a, np.array([-0.5, 0.5]), np.array([0.0, 0.4]))
    assert not any("table" in text or "stall" in text for text in warned)
    assert all(BEYOND_MACH in text for text in matrices(short, compressibility=False).trim.warning)
