"""The fused functions of the trim beside the readable ones, which are their oracle: random rotors, designs and options.

A number may differ by 1e-13 of the largest of its kind at the point: the two add the same terms in another order.
"""

import dataclasses
import sys

import numpy as np
import pytest

import proprotor as pp
from proprotor.rotor import balance_of_one, trim_balance, trim_bound, trim_solver
from proprotor.rotor.trim import UNKNOWNS
from tests.rotor.test_trim import OPERATION, TABLES, alone, assert_rounding_of, rotor

ROUNDING = 1e-13
POINTS = 7
RNG = np.random.default_rng(3)


def spread(middle, width):
    return middle * RNG.uniform(1 - width, 1 + width, POINTS)


DESIGNS = {
    "numbers": {},
    "tables": TABLES,
    "springs and offsets": {
        "precone": spread(0.05, 0.5),
        "flap_stiffness": spread(3e5, 0.5),
        "control_stiffness": spread(4e4, 0.3),
        "structural_pitch_offset": spread(0.2, 1.0),
    },
    "stations of their own": {
        "flap_hinge_offset": spread(0.2, 0.5),
        "lag_hinge_offset": spread(0.6, 0.2),
        "root_cutout": spread(0.4, 0.3),
        "twist": spread(-0.6, 0.2),
        "chord": spread(0.35, 0.2),
    },
    "airfoils": {
        "airfoil": pp.Airfoil(
            lift_slope=spread(5.7, 0.1),
            zero_lift_angle=spread(-0.02, 1.0),
            drag=spread(0.01, 0.5),
            moment=spread(-0.02, 0.5),
        )
    },
}
SERVED = (
    {},
    {"compressibility": False},
    {"section_damping": False},
    {"structure": "diagonal"},
    {"pitch": "rigid"},
    {"locked": ("lag",)},
    {"locked": ("flap", "pitch")},
    {"equations": "published"},
)
TRIMS = ("windmill", {"collective": 0.75}, {"thrust_coefficient": 0.004}, {"power_coefficient": 0.002})
SPEEDS = np.linspace(60.0, 140.0, POINTS)


def given_to_the_trim(monkeypatch, *model, **options):
    """The balance that the trim of a model is made of."""
    module, found = sys.modules["proprotor.model.rotor_model"], []
    original = module.solve_trim

    def solve(sections, few, quantities, choice, target, points, one=False):
        free = trim_solver._free_unknowns(choice, target.finds_collective)
        found.append(trim_balance.Balance(sections, quantities, choice, target, free, points))
        return original(sections, few, quantities, choice, target, points, one=one)

    with monkeypatch.context() as patch:
        patch.setattr(module, "solve_trim", solve)
        pp.rotor_model(*model, **options)
    return found[0]


def some_states():
    ranges = dict(zip(UNKNOWNS, ((-0.1, 0.1), (-0.1, 0.1), (-0.05, 0.05), (0.4, 0.9)), strict=True))
    return {name: RNG.uniform(*ends, POINTS) for name, ends in ranges.items()}


def assert_alike(found, expected):
    """Arrays (n, ...) of a point's residual, work or slopes."""
    size = np.abs(expected).reshape(len(expected), -1).max(axis=-1)
    size = size.reshape(-1, *[1] * (expected.ndim - 1))
    assert (np.abs(found - expected) <= ROUNDING * size).all()


def assert_same_balance(balance):
    state, rows = some_states(), np.arange(POINTS)
    assert balance.fused
    readable = dataclasses.replace(balance)
    readable.__dict__["fused"] = False
    for some in (rows, rows[[5, 1, 2]]):
        for share in (None, 0.0, np.linspace(0.2, 0.9, len(some))):
            found, expected = (b.near(state, some, share=share) for b in (balance, readable))
            for name in ("work", "work_slopes"):
                assert_alike(getattr(found, name), getattr(expected, name))
            assert_alike(found.residual, expected.residual)
            assert_alike(found.slopes.full, expected.slopes.full)
            loads, readable_loads = found.along(), expected.along()
            for name, value in loads.items():
                assert np.shape(value) in (np.shape(readable_loads[name]), (), (len(some), 3)), name
                size = np.abs(readable_loads[name]).max() + 1e-300
                assert np.abs(value - readable_loads[name]).max() <= 1e-12 * size, name


@pytest.mark.parametrize("design", DESIGNS)
def test_the_balance_of_designs_is_the_readable_one(design, monkeypatch):
    model = rotor(**DESIGNS[design]), OPERATION, SPEEDS
    assert_same_balance(given_to_the_trim(monkeypatch, *model))


@pytest.mark.parametrize("options", SERVED, ids=str)
@pytest.mark.parametrize("trim", TRIMS, ids=str)
def test_the_balance_of_every_option_that_is_served(trim, options, monkeypatch):
    model = rotor(), dataclasses.replace(OPERATION, trim=trim), SPEEDS
    assert_same_balance(given_to_the_trim(monkeypatch, *model, **options))


@pytest.mark.parametrize("options", SERVED, ids=str)
@pytest.mark.parametrize("trim", TRIMS, ids=str)
@pytest.mark.parametrize("changes", [{}, TABLES], ids=["numbers", "tables"])
def test_one_point_is_a_batch_of_one_to_rounding(trim, options, changes):
    operation = dataclasses.replace(OPERATION, trim=trim)
    for airspeed in (70.0, 120.0):
        one = pp.rotor_model(rotor(**changes), operation, airspeed, **options)
        assert_rounding_of(alone(rotor(**changes), operation, airspeed, **options), one)


def test_one_point_without_doubt_is_found_by_plain_numbers(monkeypatch):
    """And a doubtful one by the search for batches, which says why it is in doubt."""
    found = []
    original = trim_solver.trim_of_one

    def searched(balance):
        found.append(original(balance))
        return found[-1]

    monkeypatch.setattr(trim_solver, "trim_of_one", searched)
    case = pp.load_case("xv15-uncoupled")
    assert not pp.rotor_model(case.rotor, case.operation, 120.0).trim.warning
    assert found[-1] is not None and found[-1].iterations == 4
    doubtful = pp.rotor_model(case.rotor, case.operation, 280.0).trim
    assert doubtful.warning and found[-1] is None
    pp.rotor_model(case.rotor, case.operation, [120.0])
    assert len(found) == 2


def test_other_airfoils_and_frequencies_take_the_readable_functions(monkeypatch):
    alpha, mach = np.radians([-20.0, 20.0]), np.array([0.0, 0.9])
    lift = 5.7 * np.outer(alpha, np.ones(2))
    table = pp.AirfoilTable(alpha=alpha, mach=mach, lift=lift, drag=0.01 + 0 * lift, moment=0 * lift)
    assert not given_to_the_trim(monkeypatch, rotor(airfoil=table), OPERATION, SPEEDS).fused
    frequencies = pp.BladeFrequencies(at_rotor_speed=40.0, flap=1.1, lag=1.6)
    options = {"structure": "tabulated", "frequencies": frequencies}
    assert not given_to_the_trim(monkeypatch, rotor(), OPERATION, SPEEDS, **options).fused


@pytest.mark.parametrize("size", [1, 2, 3, 4])
def test_the_quick_bound_of_one_point_is_a_bound(size):
    """Of the eigenvalues of N, made from its definition, in each window of the path."""
    verdicts, windows = [], trim_bound._WINDOWS[0]
    for spread in np.geomspace(0.003, 3.0, 100):
        first, last = (np.eye(size) + spread * RNG.standard_normal((size, size)) for _ in range(2))
        parts = [spread * RNG.standard_normal((size, size)) for _ in range(2)]
        verdicts.append(trim_bound.leads_to_end(np.array([(first, parts[0]), (last, parts[1])])))
        if not verdicts[-1]:
            continue
        mean, of_air = (first + last) / 2, (parts[0] + parts[1]) / 2
        for share in (np.arange(windows) + 0.5) / windows:
            inverse = np.linalg.inv(mean - (1 - share) * of_air)
            aside = (last - first) / 2 - (1 - share) * (parts[1] - parts[0]) / 2
            moved = np.abs(inverse @ of_air) / (2 * windows) + 2 * np.abs(inverse @ aside)
            assert np.abs(np.linalg.eigvals(moved)).max() <= 0.5 * (1 + 1e-9)
    assert any(verdicts) and not all(verdicts)


@pytest.mark.parametrize("size", [1, 2, 3, 4])
def test_a_few_equations(size):
    """With pivots on the diagonal that are zero."""
    matrix = RNG.standard_normal((size, size))
    matrix[0, 0] = 0.0 if size > 1 else 2.0
    right = RNG.standard_normal(size)
    found = balance_of_one.solve(matrix.tolist(), right.tolist())
    np.testing.assert_allclose(found, np.linalg.solve(matrix, right), rtol=1e-12)
    assert balance_of_one.solve(np.zeros((size, size)).tolist(), right.tolist()) is None


@pytest.mark.parametrize("size", [1, 2, 3])
def test_sums_of_minors_are_coefficients_of_the_characteristic_polynomial(size):
    matrix = RNG.standard_normal((size, size))
    signs = (-1.0) ** np.arange(1, size + 1)
    np.testing.assert_allclose(
        balance_of_one.sums_of_minors(matrix.tolist()), signs * np.poly(matrix)[1:], rtol=1e-10
    )


def test_a_design_has_its_bits_in_blocks_of_any_size(monkeypatch):
    """Also with stations of its own."""
    from proprotor.rotor import section_loads

    for changes in ({}, DESIGNS["stations of their own"]):
        model = rotor(**changes), OPERATION, SPEEDS
        whole = pp.rotor_model(*model)
        with monkeypatch.context() as patch:
            patch.setattr(section_loads, "_BLOCK", 100)
            parted = pp.rotor_model(*model)
        for name in "MCK":
            assert np.array_equal(getattr(whole, name), getattr(parted, name))
