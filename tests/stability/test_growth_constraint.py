"""The aggregated growth: against all roots of an independent solver, its derivative against differences, its kinks."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
from scipy.optimize import brentq, minimize

import proprotor as pp
from proprotor.stability.growth_constraint import aggregate

SPEEDS = np.arange(100.0, 181.0, 10.0)  # m/s
INPUTS = ["support.beam_stiffness", "rotor.control_stiffness", "support.mass_per_length", "rotor.precone"]
KNOT = 1852 / 3600


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-wing")


def all_roots(case, speeds, **options):
    """Every root by the generalised eigenvalue problem of M, C and K, which the package does not solve."""
    found = []
    for speed in speeds:
        model = case.linearize(float(speed), **options)
        n = len(model.dofs)
        zero, one = np.zeros((n, n)), np.eye(n)
        left = np.block([[zero, one], [-model.K, -model.C]])
        found.append(scipy.linalg.eigvals(left, np.block([[one, zero], [zero, model.M]])))
    return np.array(found)


@pytest.mark.parametrize("level", [0.0, 0.02])
@pytest.mark.parametrize("sharpness", [20.0, 100.0, 3000.0])
def test_it_lies_above_the_largest_growth_by_no_more_than_it_says(case, level, sharpness):
    found = case.growth_constraint(SPEEDS, (), level=level, sharpness=sharpness)
    roots = all_roots(case, SPEEDS)
    growth = np.where(np.abs(roots) > 1e-5, roots.real + level * np.abs(roots), -np.inf)
    np.testing.assert_allclose(found.largest, growth.max(axis=1), rtol=1e-6)
    counted = np.isfinite(growth).sum()
    assert found.counted == counted
    assert found.bound == pytest.approx(np.log(counted) / sharpness, rel=1e-14)
    above = found.constraint.item() - growth.max()
    assert 0 <= above <= found.bound * (1 + 1e-9)
    if sharpness * np.abs(growth.max()) < 500:  # the sum as it stands does not overflow
        plain = np.log(np.exp(sharpness * growth).sum()) / sharpness
        assert found.constraint.item() == pytest.approx(plain, rel=1e-9)


def test_its_sign_turns_at_the_flutter_speed(case):
    speed = case.flutter_point("200:480:8kt").speed
    for share, sign in ((0.999, -1), (1.001, 1)):
        found = case.growth_constraint([0.9 * speed, share * speed], (), sharpness=1e4)
        assert np.sign(found.constraint.item()) == sign


@pytest.mark.parametrize("speeds", [SPEEDS, SPEEDS[:5]], ids=["unstable", "stable"])
@pytest.mark.parametrize("level", [0.0, 0.02])
def test_derivatives_are_those_of_differences(case, speeds, level):
    found = case.growth_constraint(speeds, INPUTS, level=level)
    assert found.exact.values.all()
    assert (found.largest.max().item() > 0) == (len(speeds) == len(SPEEDS)) or level
    for path, value in zip(INPUTS, found.value.values, strict=True):
        step = 1e-5 * value
        ends = [
            case.vary({path: value + end}).growth_constraint(speeds, (), level=level).constraint.item()
            for end in (step, -step)
        ]
        difference = (ends[0] - ends[1]) / (2 * step)
        assert found.derivative.sel(input=path).item() == pytest.approx(difference, rel=2e-5)


def test_an_aircraft_counts_its_pairs_of_flutter():
    aircraft = pp.load_case("xv15-aircraft")
    found = aircraft.growth_constraint("100:200:50kt", ["support.beam_stiffness"])
    value = found.value.item()
    ends = [
        aircraft.vary({"support.beam_stiffness": value * (1 + end)})
        .growth_constraint("100:200:50kt", ())
        .constraint.item()
        for end in (1e-5, -1e-5)
    ]
    assert found.derivative.item() == pytest.approx((ends[0] - ends[1]) / (2e-5 * value), rel=1e-4)
    roots = all_roots(aircraft, found.airspeed.values)
    slow = np.abs(roots) < 3.0  # rad/s: the aircraft as one body, with a spiral that is hardly damped
    assert roots[slow & (np.abs(roots) > 1e-5)].real.max() > found.constraint.item() + 0.1
    oscillating = np.where(slow | (roots.imag == 0), -np.inf, roots.real)
    np.testing.assert_allclose(found.largest, oscillating.max(axis=1), rtol=1e-6)


def test_a_rotor_without_a_shaft_has_no_root_of_its_azimuth(case):
    """Beside a brute count: the azimuth that nothing holds is a root at zero at every airspeed."""
    roots = all_roots(case, SPEEDS)
    assert ((np.abs(roots) < 1e-5).sum(axis=1) == 1).all()
    assert case.growth_constraint(SPEEDS, ()).constraint.item() < roots.real.max() + 0.1


@pytest.mark.parametrize("yaw_stiffness", [1e6, 0.0])
def test_roots_that_are_zero_throughout_are_left_out(case, yaw_stiffness):
    """In a vacuum the rotor speed has no damping; a pivot without a spring about yaw has one root at zero more."""
    pivot = pp.two_axis_pivot(1.2, (400.0, 400.0), (1e6, 1e6), (1e3, 1e3), includes_rotor=False)
    support = replace(pivot, stiffness=np.diag([1e6, yaw_stiffness]))
    vacuum = replace(case.operation, density=0.0, trim={"collective": 0.6})
    case = replace(case, support=support, operation=vacuum)
    roots = all_roots(case, SPEEDS[:3])
    zero = (np.abs(roots) < 1e-5).sum(axis=1)
    found = pp.growth_constraint(case, SPEEDS[:3], ())
    assert (zero == found.left_out + 1).all()  # the azimuth itself is no state of the package
    assert found.left_out == (1 if yaw_stiffness else 2)
    assert found.counted == roots.size - zero.sum()
    assert 0 <= found.constraint.item() <= found.bound  # a vacuum damps no blade


def test_slopes_stay_finite_where_two_roots_fall_into_one():
    """x'' + 2 c x' + k x = 0 at k = c²: neither root has a derivative there, the sum of both has one on either side."""
    c, sharpness = 1.0, 5.0

    def constraint(k):
        return aggregate(np.roots([1.0, 2 * c, k]).real, sharpness)[0]

    below, above = ((constraint(c**2 + end) - constraint(c**2)) / end for end in (-1e-6, 1e-6))
    assert above == pytest.approx(0.0, abs=1e-6)
    assert below == pytest.approx(-sharpness / 2, rel=1e-4)  # of log cosh(ρ√d) / ρ at d = c² - k = 0


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"airspeeds": [700.0]}, "airspeed = 700 m/s: "),
        ({"level": 1.0}, "level = 1.0: must be a damping ratio"),
        ({"sharpness": 0.0}, "sharpness = 0.0: must be above zero"),
        ({"wrt": ["rotor.precon"]}, "did you mean rotor.precone"),
        ({"airspeeds": []}, "must be one airspeed or more"),
    ],
)
def test_what_means_nothing_is_refused(case, given, message):
    with pytest.raises(pp.InputError, match=message):
        case.growth_constraint(**{"airspeeds": SPEEDS, "wrt": ()} | given)


# An optimisation, whole ----------------------------------------------------------------------------------------------

STIFFNESSES = [f"support.{name}_stiffness" for name in ("beam", "chord", "torsion")]
SPAR, CONTROL = "support.mass_per_length", "rotor.control_stiffness"
PER_WALL, RODS = 25.92, 8.0  # kg/m of spar of the present wall; kg of the present control rods
WANTED = 384.0 * KNOT


class Wing:
    """A wing by the thickness of its spar and the stiffness of its control system, both as shares of the present."""

    def __init__(self, case):
        self.case = case
        self.own = {path: number.si for path, number in pp.design_inputs(case).items()}

    def design(self, x):
        values = {path: self.own[path] * x[0] for path in STIFFNESSES}
        values |= {SPAR: self.own[SPAR] + PER_WALL * (x[0] - 1), CONTROL: self.own[CONTROL] * x[1]}
        return self.case.vary(values)

    def mass(self, x):
        return PER_WALL * self.own["support.span"] * x[0] + RODS * x[1]

    def growth(self, x, airspeeds):
        return self.design(x).growth_constraint(airspeeds, ()).constraint.item()

    def growth_rate(self, x, airspeeds):
        rate = self.design(x).growth_constraint(airspeeds, [*STIFFNESSES, SPAR, CONTROL]).derivative.values
        by_wall = rate[:3] @ [self.own[path] for path in STIFFNESSES] + rate[3] * PER_WALL
        return np.array([by_wall, rate[4] * self.own[CONTROL]])

    def best(self, start, wanted):
        airspeeds = np.linspace(0.55, 1.0, 20) * wanted
        return minimize(
            lambda x: self.mass(x) / 100,
            start,
            bounds=[(0.7, 2.5), (0.5, 5.0)],
            constraints={
                "type": "ineq",
                "fun": lambda x: -self.growth(x, airspeeds),
                "jac": lambda x: -self.growth_rate(x, airspeeds),
            },
            method="SLSQP",
            options={"ftol": 1e-9},
        )

    def flutter_speed(self, x):
        return self.design(x).flutter_point("200:480:8kt").speed

    def lightest_on_a_grid(self, wanted):
        """By flutter speeds alone: at each control stiffness the thinnest spar that reaches the speed wanted."""
        masses = []
        for control in np.arange(4.0, 5.01, 0.25):
            wall = brentq(
                lambda wall, k=control: self.flutter_speed((wall, k)) - wanted, 0.75, 1.6, xtol=1e-5
            )
            masses.append(self.mass((wall, control)))
        return min(masses)


@pytest.fixture(scope="module")
def wing(case):
    return Wing(case)


def test_an_optimiser_finds_the_lightest_wing_from_either_side(wing):
    """The optimum against a search on a grid of flutter speeds, which knows no aggregate and no derivative."""
    found = [wing.best(start, WANTED) for start in ((1.0, 1.0), (1.6, 2.0))]
    assert all(one.success for one in found)
    np.testing.assert_allclose(found[0].x, found[1].x, rtol=1e-3)
    x = found[0].x
    assert wing.flutter_speed(x) >= WANTED
    assert wing.flutter_speed(x) == pytest.approx(
        WANTED, rel=3e-3
    )  # what the aggregate lies above the largest growth
    grid = wing.lightest_on_a_grid(wing.flutter_speed(x))
    assert grid * (1 - 1e-3) <= wing.mass(x) <= grid * (1 + 1e-4)
    slower = wing.best((1.0, 3.0), 0.96 * WANTED)
    assert wing.mass(slower.x) < wing.mass(x) - 1.0
    assert wing.flutter_speed(slower.x) >= 0.96 * WANTED
