"""Closed-form lift-slope moments against quadrature, from no airspeed to three times the tip speed."""

import dataclasses

import numpy as np
import pytest
from proprotor_equations import lift_slope

import proprotor as pp

RATIOS = np.array([0.0, 1e-9, 1e-4, 1e-2, 0.05, 0.2, 0.5, 1.0, 1.7, 3.0])
RADIUS, ROTOR_SPEED, DENSITY, CHORD, SLOPE = 3.81, 47.96, 1.225, 0.3706, 5.7


def closed_form(inner: float, outer: float) -> dict[str, np.ndarray]:
    moments = lift_slope.load_moments(
        rotor_speed=ROTOR_SPEED,
        density=DENSITY,
        chord=CHORD,
        radius=RADIUS,
        lift_slope=SLOPE,
        inflow_ratio=np.maximum(RATIOS, 1e-150),
        inner_edge=inner,
        outer_edge=outer,
    )
    return moments._asdict()


def quadrature(inner: float, outer: float) -> dict[str, np.ndarray]:
    """The same by 20 Gauss points on panels that halve towards the root, from the derivatives of L written out."""
    edges = np.unique(
        np.clip(np.concatenate([[inner, outer], 2.0 ** -np.arange(60), np.linspace(0, 1, 33)]), inner, outer)
    )
    nodes, weights = np.polynomial.legendre.leggauss(20)
    half = np.diff(edges)[:, None] / 2
    r = RADIUS * (edges[:-1, None] + half * (1 + nodes)).ravel()
    dr = RADIUS * (half * weights).ravel()
    u_t, u_p = ROTOR_SPEED * r, ROTOR_SPEED * RADIUS * RATIOS[:, None]
    u = np.hypot(u_t, u_p)
    lift = (
        DENSITY * CHORD * SLOPE / 2
    )  # L = lift U² alpha, alpha = theta - atan(u_p / u_t), trim lift left out
    by_alpha = {"fx": lift * u * u_p, "fn": lift * u * u_t}
    alpha = {"ut": u_p / u**2, "up": -u_t / u**2, "theta": np.ones_like(u)}
    return {
        f"{load}_{by}_{n}": (by_alpha[load] * alpha[by] * r**n) @ dr
        for load in by_alpha
        for by in alpha
        for n in range(3)
    }


@pytest.mark.parametrize(
    ("inner", "outer"), [(0.0875, 1.0), (0.02, 1.0), (0.3, 1.0), (0.0, 1.0), (0.0875, 0.1123)]
)
def test_closed_form_is_the_quadrature(inner, outer):
    """Each moment to 1e-12 of itself; a narrow segment near the root loses what it adds least of."""
    ours, reference = closed_form(inner, outer), quadrature(inner, outer)
    assert len(ours) == 17
    tolerance = 1e-12 if outer == 1.0 else 1e-10
    for name, moment in ours.items():
        assert np.allclose(moment, reference[name], rtol=tolerance, atol=1e-140), (
            name
        )  # 1e-150 stands for no airspeed


def test_the_model_uses_it():
    """Published, lift-slope and incompressible: the same matrices with a chord that has to be integrated."""
    case = pp.load_case("xv15-uncoupled")
    options = {"equations": "published", "airloads": "lift-slope", "compressibility": False}
    as_function = dataclasses.replace(case.rotor, chord=lambda r: np.full_like(r, case.rotor.chord))
    closed = pp.rotor_model(case.rotor, case.operation, [60.0, 150.0], **options)
    integrated = pp.rotor_model(as_function, case.operation, [60.0, 150.0], **options)
    for name in "CK":
        ours, reference = getattr(closed, name), getattr(integrated, name)
        assert np.abs(ours - reference).max() < 1e-11 * np.abs(reference).max()
        assert np.any(ours != reference)
