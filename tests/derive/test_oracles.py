"""The oracles against each other and against first principles: a wrong oracle proves nothing.

Everything here is exact but for rounding and the eighth-order differences of the Lagrangian (truncation and
rounding near 1e-13 of the largest entry), so the tolerances are 1e-12 and 1e-11.
"""

from dataclasses import replace

import numpy as np
import pytest

from tests.oracles.motion import Motion, cos, cross, reciprocal, sin, turned, vector
from tests.oracles.nonlinear_rotor import (
    DOFS,
    HUB_MOMENT,
    central_difference,
    inertia_rows,
    lagrange_rows,
    linearised,
    rows_in_vacuum,
)
from tests.oracles.random_rotors import random_rotor
from tests.oracles.virtual_work import airload_rows, quadrature

AIRSPEED, DENSITY = 110.0, 1.225


class SteadyState:
    """Any steady state will do here; equilibrium is not needed."""

    collective, coning, lag, elastic_pitch = 0.75, -0.02, 0.03, -0.04


def oracle(seed, **changes):
    pair = random_rotor(seed, **changes)
    rotor, trim = pair.oracle(SteadyState)
    return rotor, trim, pair.air(AIRSPEED, DENSITY)


def close(actual, expected, tolerance):
    """To `tolerance` of the largest entry of each matrix."""
    pairs = zip(actual, expected, strict=True)
    return all(np.abs(a - b).max() <= tolerance * np.abs(b).max() for a, b in pairs)


def test_motions_are_the_derivatives_of_what_they_say():
    def swinging(t):
        angle = Motion(1.3 + 0.5 * t + 0.4 * t**2, 0.5 + 0.8 * t, 0.8)
        arm = vector(cos(angle), sin(angle) * angle, reciprocal(angle))
        axis = vector(0.1 * angle, 0.2, -0.3 * angle * angle)
        return turned(axis, cross(axis, arm) + arm)

    for derivative, of in (("rate", "value"), ("acceleration", "rate")):
        differenced = central_difference(lambda t, of=of: getattr(swinging(t), of), 0.003)
        assert np.allclose(getattr(swinging(0.0), derivative), differenced, rtol=0, atol=1e-12)


def test_turning_is_a_rotation():
    rotation = np.array([0.2, -0.1, 0.3])
    matrix = turned(vector(*rotation), Motion(np.eye(3))).value
    angle = np.linalg.norm(rotation)
    assert np.allclose(matrix @ matrix.T, np.eye(3), rtol=0, atol=1e-15)
    assert np.isclose(np.trace(matrix), 1 + 2 * np.cos(angle), rtol=0, atol=1e-15)
    assert np.allclose(rotation @ matrix, rotation, rtol=0, atol=1e-15)
    quarter_of_a_radian = turned(vector(0.0, 0.0, 0.25), Motion(np.array([1.0, 0.0, 0.0]))).value
    assert np.allclose(quarter_of_a_radian, [np.cos(0.25), np.sin(0.25), 0.0], rtol=0, atol=1e-15)


@pytest.mark.parametrize("n_blades", [3, 4])
def test_lagrangian_and_accelerations_agree(n_blades):
    """Two roads to the same nonlinear rows; at a moving state, where every term is alive."""
    rotor, _, _ = oracle(n_blades, n_blades=n_blades)
    rng = np.random.default_rng(7)
    q = Motion(*(scale * rng.standard_normal(len(DOFS)) for scale in (0.05, 1.0, 20.0)))
    lagrange = lagrange_rows(rotor, q, time=0.02)
    newton = rows_in_vacuum(rotor, q, time=0.02)
    # Away from the trim the moments on the hub are resultants, not generalised forces of a rotation vector.
    rest = np.delete(np.arange(len(DOFS)), HUB_MOMENT)
    assert close([newton[rest]], [lagrange[rest]], 1e-11)


def test_coefficients_do_not_depend_on_azimuth():
    rotor, trim, air = oracle(1, n_blades=3, tables=True)

    def rows(q, time):
        return rows_in_vacuum(rotor, q, time) + airload_rows(air, rotor, q, time)

    assert close(linearised(rows, trim, 0.0137), linearised(rows, trim, 0.0), 1e-12)


def test_conservative_rotor_is_symmetric_and_gyroscopic():
    undamped = dict.fromkeys(("flap_damping", "lag_damping", "pitch_damping", "gimbal_damping"), 0.0)
    rotor, trim, _ = oracle(2, **undamped)
    M, C, K = linearised(lambda q, time: rows_in_vacuum(rotor, q, time), trim, 0.0)
    assert close([M, C, K], [M.T, -C.T, K.T], 1e-12)


def test_a_steady_rotor_pulls_its_hub_neither_way():
    """The condition under which moments about the hub equal generalised forces of its rotation."""
    rotor, trim, _ = oracle(3)
    at_rest = Motion(trim)
    rows = inertia_rows(rotor, at_rest, 0.0).real
    assert np.abs(rows[:6]).max() < 1e-12 * np.abs(rows).max()


def test_tilting_a_flying_rotor_is_a_sideslip_and_turns_its_loads():
    rotor, trim, air = oracle(4)
    at_rest = Motion(trim)
    steady = -airload_rows(air, rotor, at_rest, 0.0).real
    _, C, K = linearised(lambda q, time: airload_rows(air, rotor, q, time), trim, 0.0)
    thrust, torque = steady[2], steady[5]
    expected = -AIRSPEED * C[:, 0]  # a shaft tilted by αy meets the air sideways at −V αy
    expected[0] -= thrust
    expected[3] -= torque
    assert close([K[:, 4]], [expected], 1e-12)
    unmoved = [DOFS.index(name) for name in ("x", "y", "z", "alpha_z", "azimuth")]
    assert np.abs(K[:, unmoved]).max() < 1e-12 * np.abs(K).max()


def test_axial_motion_is_a_change_of_airspeed():
    rotor, trim, air = oracle(5)
    at_rest = Motion(trim)
    _, C, _ = linearised(lambda q, time: airload_rows(air, rotor, q, time), trim, 0.0)
    faster = central_difference(
        lambda dV: airload_rows(replace(air, airspeed=AIRSPEED + dV), rotor, at_rest, 0.0).real, 1.0
    )
    assert close([C[:, 2]], [faster], 1e-11)


def test_quadrature_has_converged():
    rotor, trim, air = oracle(6)  # linear twist: the longest panels
    at_rest = Motion(trim)
    station, weight = quadrature(air, rotor)
    finer_station, finer_weight = quadrature(air, rotor, order=30)
    assert np.isclose(weight @ station**4, finer_weight @ finer_station**4, rtol=1e-14)
    coarse, fine = (airload_rows(air, rotor, at_rest, 0.0, order=order) for order in (14, 30))
    assert close([coarse], [fine], 1e-13)
