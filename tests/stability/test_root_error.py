"""How exact roots are, against the same roots in 60 digits: refined ones, their errors, and what is neutral."""

import mpmath
import numpy as np
import pytest

import proprotor as pp
from proprotor.model.first_order import held_coordinates
from proprotor.stability.modes import decomposition
from proprotor.stability.root_error import error_near_zero, errors_of, refined, roots
from tests.known_systems import linear_model

SPRINGS = [1.0, 1e4, 1e9, 1e14, 1e18]


def exact_roots(model, near):
    """Roots of det(λ²M + λC + K) next to some numbers, in 60 digits: where 1 / (cᵀ T⁻¹ b) vanishes."""
    with mpmath.workdps(60):
        M, C, K = (mpmath.matrix(getattr(model, name)[0].tolist()) for name in "MCK")
        n, held = M.rows, held_coordinates(model)
        b, c = ([mpmath.mpf(1) / (place + k) for place in range(n)] for k in (2, 3))
        found = []
        for value in near:
            root = mpmath.mpc(complex(value))
            for _ in range(25):
                whole, slope = M * root**2 + C * root + K, M * (2 * root) + C
                for place in set(range(n)) - set(held):
                    for row in range(n):
                        whole[row, place], slope[row, place] = (
                            M[row, place] * root + C[row, place],
                            M[row, place],
                        )
                try:
                    factors, order = mpmath.mp.LU_decomp(whole)
                except ZeroDivisionError:  # upon the root
                    break
                parts = [mpmath.matrix(b)]
                for load in (lambda: parts[0], lambda: slope * parts[1]):  # noqa: B023
                    parts.append(mpmath.mp.U_solve(factors, mpmath.mp.L_solve(factors, load(), order)))
                step = sum(c[k] * parts[1][k] for k in range(n)) / sum(c[k] * parts[2][k] for k in range(n))
                root -= step
                if abs(step) < mpmath.mpf(10) ** -45 * (1 + abs(root)):
                    break
            found.append(root)
        return found


def distances(exact, values):
    with mpmath.workdps(60):
        return np.array(
            [float(abs(one - mpmath.mpc(complex(value)))) for one, value in zip(exact, values, strict=True)]
        )


def random_model(seed, spring, heavy):
    """Coordinates coupled by mass and springs, one of which is stiff; `heavy` makes two move nearly the same mass."""
    rng = np.random.default_rng(seed)
    factor = rng.normal(size=(4, 4))
    mass = factor @ factor.T + 0.1 * np.eye(4)
    if heavy:
        mass[3] = mass[2] * (1 + 1e-7 * rng.random())
        mass[:, 3] = mass[3]
        mass[3, 3] = mass[2, 2] * (1 + 1e-6)
        mass[2, 3] = mass[3, 2] = mass[2, 2]
    damping, stiffness = rng.normal(size=(2, 4, 4)) * np.array([0.3, 30.0])[:, None, None]
    stiffness = stiffness + 100 * np.eye(4)
    arm = rng.normal(size=4) * np.array([1, 0, 0, 0])
    return linear_model(mass[None], damping[None], (stiffness + spring * np.outer(arm, arm))[None])


@pytest.mark.parametrize("heavy", [False, True])
@pytest.mark.parametrize("spring", SPRINGS)
def test_refined_roots_are_within_their_errors_and_as_good_beside_a_stiff_spring(spring, heavy):
    for seed in range(6):
        model = random_model(seed, spring, heavy)
        spectrum = decomposition(model)
        found = refined(model, spectrum.all_modes)
        exact = exact_roots(model, found.values[0])
        off = distances(exact, found.values[0])
        assert np.all(off <= found.error[0]), (seed, off / found.error[0])
        plain = distances(exact, spectrum.values[0])
        assert np.all(plain <= errors_of(model, spectrum)[0]), (seed, plain)
        slow = np.abs(found.values[0]) < 1e3
        if not heavy:
            assert found.error[0, slow].max() < 1e-10  # whatever the spring


@pytest.mark.parametrize("stiffness", [None, 1e12, 1e18])
def test_the_error_of_a_rotor_on_its_wing_is_covered_and_small(stiffness):
    case = pp.load_case("xv15-uncoupled")
    case = case if stiffness is None else case.vary({"rotor.control_stiffness": stiffness})
    model = case.linearize([200.0])
    found = refined(model, decomposition(model).all_modes)
    slow = np.flatnonzero((np.abs(found.values[0]) < 1e3) & (found.values[0].imag >= 0))
    off = distances(exact_roots(model, found.values[0, slow]), found.values[0, slow])
    assert np.all(off <= found.error[0, slow])
    # A stiff control system leaves the roots of the wing as well known as they were: to a billionth of a rad/s.
    assert found.error[0, slow].max() < 1e-9


def gyroscopic(seed, stiff):
    """Springs and gyroscopic terms without dampers: all roots on the imaginary axis."""
    rng = np.random.default_rng(seed)
    mass, stiffness = (part @ part.T + np.eye(5) for part in rng.normal(size=(2, 5, 5)))
    turning = rng.normal(size=(5, 5))
    scale = np.diag([1, 1, 1, 1, stiff**0.5])
    return linear_model(mass[None], 3 * (turning - turning.T)[None], (scale @ stiffness @ scale * 50)[None])


@pytest.mark.parametrize("stiff", [1.0, 1e6, 1e12])
def test_what_nothing_damps_is_neutral(stiff):
    for seed in range(8):
        values, error = roots(gyroscopic(seed, stiff))
        assert np.all(np.abs(values.real) <= error)
        assert np.all(error <= 1e-10 * np.abs(values) + 1e-9)


@pytest.mark.parametrize("growth", [1e-10, 1e-9])
def test_what_is_damped_a_little_beside_a_fast_root_is_not_neutral(growth):
    """λ² ∓ 2gλ + 100 beside a root of 1e9 rad/s: a share of the largest root would swallow it."""
    model = linear_model(np.eye(2)[None], np.diag([-2 * growth, 1.0])[None], np.diag([100.0, 1e18])[None])
    values, error = roots(model)
    slow = np.abs(values[0]) < 100
    np.testing.assert_allclose(values[0, slow].real, growth, rtol=1e-3)
    assert np.all(error[0, slow] < growth / 10)


def test_a_motion_that_nothing_holds_has_two_roots_at_zero_that_are_neutral():
    """A free mass beside an oscillator it is coupled to by mass: λ = 0 twice, one vector."""
    mass = np.array([[2.0, 0.7], [0.7, 1.0]])
    model = linear_model(mass[None], np.diag([0.0, 0.5])[None], np.diag([0.0, 100.0])[None])
    values, error = roots(model)
    zero = np.argsort(np.abs(values[0]))[:2]
    assert np.all(np.abs(values[0, zero]) <= error[0, zero])
    assert np.all(error[0, zero] < 1e-6)
    modes = model.modes()
    assert np.isnan(modes.damping_ratio.values[0, np.abs(modes.eigenvalue.values[0]) < 1e-6]).all()
    assert np.isfinite(modes.damping_ratio.values[0, -1])


def test_a_double_root_away_from_zero_is_known_to_the_square_root_of_rounding():
    """(λ + 1)² on one vector: an error of 1e-8, not of none and not without bound."""
    model = linear_model(np.eye(1)[None], np.full((1, 1, 1), 2.0), np.ones((1, 1, 1)))
    spectrum = decomposition(model)
    error = errors_of(model, spectrum)
    assert np.all(np.abs(spectrum.values + 1) <= error) and np.all(error < 1e-6)


def test_errors_of_known_eigenvalues_belong_to_them_in_any_order():
    model = gyroscopic(3, 1.0)
    values = decomposition(model).values[:, ::-1]
    error = error_near_zero(model, values)
    assert np.all(np.abs(values.real) <= error) and np.all(error > 0)
    damped = linear_model(np.eye(1)[None], np.ones((1, 1, 1)), np.full((1, 1, 1), 9.0))
    assert np.all(error_near_zero(damped, decomposition(damped).values) == 0)
