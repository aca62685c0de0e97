"""Pitch-flap and pitch-lag coupling of the control system's flexibility: K_Pβ = −∂θ/∂β and K_Pζ = −∂θ/∂ζ.

The closed form, the energy of the springs and Eqs. 36 and 37 of AIAA-2002-1604 agree to 1e-10, sign included: a blade
that cones or lags further pitches by −K_P times as much, where the control spring alone holds its pitch.
"""

from dataclasses import replace

import numpy as np
import pytest
from proprotor_equations.flap_lag_springs import effective_stiffness
from proprotor_equations.pitch import couplings

import proprotor as pp
from benchmarks.couplings import SPEEDS, pitch_couplings
from tests.derive.test_airloads_virtual_work import CASES, Case
from tests.oracles.comparison import assert_matrices_match
from tests.oracles.nonlinear_rotor import FLAP, LAG, PITCH, central_difference, inertia_rows, linearised
from tests.oracles.random_rotors import NO_OFFSETS
from tests.oracles.virtual_work import airload_rows

SPRINGS = (
    "flap_stiffness",
    "lag_stiffness",
    "flap_outboard_fraction",
    "lag_outboard_fraction",
    "control_stiffness",
)


def random_blades(seed, count=40):
    """Springs, trim and control system by the names of the derivation; the first ones at the limits of R."""
    rng = np.random.default_rng(seed)
    fractions = rng.uniform(0, 1, (2, count))
    fractions[:, :4] = [[0, 1, 0, 1], [1, 0, 0, 1]]
    return {
        "flap_stiffness": rng.uniform(1e5, 6e5, count),
        "lag_stiffness": rng.uniform(1e5, 2e6, count),
        "flap_outboard_fraction": fractions[0],
        "lag_outboard_fraction": fractions[1],
        "structural_pitch": rng.uniform(-1.5, 1.5, count),
        "control_stiffness": rng.uniform(5e3, 6e4, count),
        "coning": rng.uniform(-0.1, 0.1, count),
        "lag": rng.uniform(-0.1, 0.1, count),
    }


BLADES = random_blades(seed=1)


def closed_form(blades):
    """(K_Pβ, K_Pζ) of the package."""
    named = blades.copy()
    trim = {name: named.pop(name) for name in ("control_stiffness", "coning", "lag")}
    stiffness = effective_stiffness(**named)._asdict()
    slopes = {name: value for name, value in stiffness.items() if name.endswith("_slope")}
    return np.array(couplings(**trim, **slopes))


def scale(blades):
    """What a coupling is made of."""
    springs = np.maximum(blades["flap_stiffness"], blades["lag_stiffness"])
    return springs * (np.abs(blades["coning"]) + np.abs(blades["lag"])) / blades["control_stiffness"]


# The springs, with their flexibilities added and inverted numerically


def flexibility(blades, twist):
    """Hub springs and blade springs turned by the pitch, (..., 2, 2)."""
    turn = blades["structural_pitch"] + twist
    share = np.stack([blades["flap_outboard_fraction"], blades["lag_outboard_fraction"]], axis=-1)
    soft = 1 / np.stack([blades["flap_stiffness"], blades["lag_stiffness"]], axis=-1)
    c, s = np.cos(turn), np.sin(turn)
    blade = np.moveaxis(np.array([[c, -s], [s, c]]), (0, 1), (-2, -1))
    outboard = blade @ ((share * soft)[..., None] * np.swapaxes(blade, -1, -2))
    return outboard + ((1 - share) * soft)[..., None] * np.eye(2)


def spring_energy(blades, flap, lag, twist):
    bent = np.stack([flap, lag], axis=-1)[..., None]
    return 0.5 * (np.swapaxes(bent, -1, -2) @ np.linalg.solve(flexibility(blades, twist), bent))[..., 0, 0]


def pitch_moment(blades, flap, lag):
    """−∂U/∂θ by a complex step."""
    return -spring_energy(blades, flap, lag, 1e-30j).imag / 1e-30


def pitch_by_springs(blades):
    """(∂θ/∂β, ∂θ/∂ζ) where K_θ alone resists; the energy is quadratic in the angles, so any step is exact."""
    coning, lag = blades["coning"], blades["lag"]
    by_flap = pitch_moment(blades, coning + 0.5, lag) - pitch_moment(blades, coning - 0.5, lag)
    by_lag = pitch_moment(blades, coning, lag + 0.5) - pitch_moment(blades, coning, lag - 0.5)
    return np.array([by_flap, by_lag]) / blades["control_stiffness"]


def test_couplings_are_minus_the_pitch_of_a_blade_bent_further():
    error = np.abs(closed_form(BLADES) + pitch_by_springs(BLADES))
    assert (error < 1e-10 * scale(BLADES)).all()
    assert (np.abs(pitch_by_springs(BLADES)[:, 3:]) > 1e-4).all(), (
        "the blades must couple for this to test anything"
    )


# As printed


def printed_stiffness(K_β, K_ζ, R_β, R_ζ, θ):
    """Eqs. 21 and 22: (K_ββ, K_βζ, K_ζζ, Δ)."""
    s, c = np.sin(θ), np.cos(θ)
    Δ = 1 + (2 * R_β * R_ζ - R_β - R_ζ) * s**2
    Δ = Δ + (R_β * (1 - R_β) * K_ζ / K_β + R_ζ * (1 - R_ζ) * K_β / K_ζ) * s**2
    mixed = R_β * K_ζ - R_ζ * K_β
    return (K_β + mixed * s**2) / Δ, -mixed * c * s / Δ, (K_ζ - mixed * s**2) / Δ, Δ


def printed_outboard_shares(K_β, K_ζ, R_β, R_ζ, θ):
    """Eq. 31: W, X, Y and Z."""
    s, c = np.sin(θ), np.cos(θ)
    *_, Δ = printed_stiffness(K_β, K_ζ, R_β, R_ζ, θ)
    lag_in_flap = (R_β - K_β / K_ζ * R_ζ) * (R_ζ - 1)
    flap_in_lag = (R_ζ - K_ζ / K_β * R_β) * (R_β - 1)
    W, X = (R_β + lag_in_flap * s**2) / Δ, flap_in_lag * s * c / Δ
    Y, Z = -lag_in_flap * s * c / Δ, (R_ζ + flap_in_lag * s**2) / Δ
    return W, X, Y, Z


def printed_inboard_shares(K_β, K_ζ, R_β, R_ζ, θ):
    """Eq. 30: A, B, C and D."""
    s, c = np.sin(θ), np.cos(θ)
    *_, Δ = printed_stiffness(K_β, K_ζ, R_β, R_ζ, θ)
    flap_in_lag = (R_ζ - K_ζ / K_β * R_β) * (R_β - 1)
    lag_in_flap = (R_β - K_β / K_ζ * R_ζ) * (R_ζ - 1)
    A, B = (1 - R_β + flap_in_lag * s**2) / Δ, -flap_in_lag * s * c / Δ
    C, D = lag_in_flap * s * c / Δ, (1 - R_ζ + lag_in_flap * s**2) / Δ
    return A, B, C, D


def printed_arguments(blades):
    return [blades[name] for name in (*SPRINGS[:4], "structural_pitch")]


def printed_couplings(blades):
    """Eqs. 36 and 37."""
    given = printed_arguments(blades)
    K_ββ, K_βζ, K_ζζ, _ = printed_stiffness(*given)
    W, X, Y, Z = printed_outboard_shares(*given)
    β0, ζ0, K_θ = blades["coning"], blades["lag"], blades["control_stiffness"]
    mixed = Z * K_ββ - (X - Y) * K_βζ - W * K_ζζ
    K_Pβ = (2 * (Y * K_ββ - W * K_βζ) * β0 + mixed * ζ0) / K_θ
    K_Pζ = (mixed * β0 + 2 * (Z * K_βζ - X * K_ζζ) * ζ0) / K_θ
    return np.array([K_Pβ, K_Pζ])


def test_couplings_are_those_printed():
    """With their printed sign."""
    actual, printed = closed_form(BLADES), printed_couplings(BLADES)
    assert (np.abs(actual - printed) < 1e-10 * scale(BLADES)).all()
    assert (np.sign(actual) == np.sign(printed))[:, 3:].all()


def test_printed_stiffness_and_shares_are_those_of_springs_in_series():
    """Eqs. 18 to 31, of which Eqs. 36 and 37 are made."""
    given = printed_arguments(BLADES)
    K_ββ, K_βζ, K_ζζ, _ = printed_stiffness(*given)
    stiffness = np.moveaxis(np.array([[K_ββ, K_βζ], [K_βζ, K_ζζ]]), (0, 1), (-2, -1))
    assert np.allclose(stiffness @ flexibility(BLADES, 0.0), np.eye(2), rtol=0, atol=1e-10)
    shares = np.array(printed_inboard_shares(*given)) + printed_outboard_shares(*given)
    assert np.allclose(shares, [[1], [0], [0], [1]], rtol=0, atol=1e-10)


# Limits


def test_no_coupling_with_all_flexibility_inboard():
    inboard = BLADES | dict.fromkeys(("flap_outboard_fraction", "lag_outboard_fraction"), np.zeros(40))
    assert np.array_equal(closed_form(inboard), np.zeros((2, 40)))


def test_no_coupling_of_a_straight_blade():
    straight = BLADES | {"coning": 0.0, "lag": 0.0}
    assert np.array_equal(closed_form(straight), np.zeros((2, 40)))


def test_coupling_falls_as_the_control_system_stiffens():
    stiff = BLADES | {"control_stiffness": 8 * BLADES["control_stiffness"]}
    assert np.array_equal(8 * closed_form(stiff), closed_form(BLADES))


# What else holds the pitch of a blade


def blade_pitch_equation(model):
    """(K_θβ, K_θζ, K_θθ) of one blade in vacuum: a collective row is N blades."""
    row = model.K[..., model.dofs.index("pitch_0"), :] / 3
    return [row[..., model.dofs.index(f"{name}_0")] for name in ("flap", "lag", "pitch")]


def bent_blades(rotor, trim):
    given = {name: np.full_like(trim.coning, getattr(rotor, name)) for name in SPRINGS}
    by_flap = rotor.kinematic_pitch_flap_coupling * trim.coning
    by_lag = rotor.kinematic_pitch_lag_coupling * trim.lag
    turn = {"structural_pitch": trim.pitch - by_flap - by_lag + rotor.structural_pitch_offset}
    return given | turn | {"coning": trim.coning, "lag": trim.lag}


def spring_curvature(blades):
    """∂²U/∂θ² of the springs, from the pitch moment by differences of eighth order."""

    def moment(angle):
        turned = blades | {"structural_pitch": blades["structural_pitch"] + angle}
        return pitch_moment(turned, blades["coning"], blades["lag"])

    return -central_difference(moment, 0.01)


@pytest.mark.parametrize("propeller_moment", [True, False])
def test_propeller_moment_and_bent_springs_share_the_moment_with_the_control_spring(propeller_moment):
    """−∂θ/∂β and −∂θ/∂ζ of the whole pitch equation are K_P K_θ/(K_θ + ∂²U/∂θ² + I_θ Ω² cos 2Θ)."""
    case = pp.load_case("xv15-uncoupled")
    rotor = replace(case.rotor, propeller_moment=propeller_moment)
    model = pp.rotor_model(rotor, case.operation, SPEEDS, airloads="none", section_damping=False)
    blades = bent_blades(rotor, model.trim)
    propeller = rotor.pitch_inertia * case.operation.rotor_speed**2 * np.cos(2 * model.trim.pitch)
    stiffness = rotor.control_stiffness + spring_curvature(blades) + propeller_moment * propeller
    by_flap, by_lag, held = blade_pitch_equation(model)
    assert np.allclose(held, stiffness, rtol=1e-10)
    static = np.array([by_flap, by_lag]) / held
    assert np.allclose(static, closed_form(blades) * rotor.control_stiffness / stiffness, rtol=1e-10)
    table = pitch_couplings(replace(case, rotor=rotor), SPEEDS)
    assert np.allclose(np.array([table.flap, table.lag]) * table.share, static, rtol=1e-10)


# In the equations of the rotor


def coupled_case(name="powered, tables"):
    """The closed forms as printed have masses and aerodynamic centre on the pitch axis."""
    return Case(**CASES[name], **NO_OFFSETS)


def test_couplings_of_the_model_pitch_the_airloads_and_nothing_else():
    """Given values −a δβ − b δζ in place of the closed forms, against the airloads of the nonlinear rotor."""
    case = coupled_case()
    rigid = case.model(pitch="rigid")
    rotor, trim = case.oracle(rigid)
    unturned = replace(case.air, section_damping=False)  # the pitch of the couplings is a static angle
    _, _, by_pitch = linearised(lambda q, time: airload_rows(unturned, rotor, q, time), trim, 0.0)
    inertia, _, _ = linearised(lambda q, time: inertia_rows(rotor, q, time), trim, 0.0)
    left = [place for place in range(18) if place not in range(PITCH, PITCH + 3)]
    for flap, lag in ((0.3, -0.2), (0.0, 0.4), (-0.5, 0.0)):
        added = np.zeros((18, 18))
        added[:, FLAP : FLAP + 3] = -flap * by_pitch[:, PITCH : PITCH + 3]
        added[:, LAG : LAG + 3] = -lag * by_pitch[:, PITCH : PITCH + 3]
        model = case.model(pitch="coupling", pitch_flap_coupling=flap, pitch_lag_coupling=lag)
        changed = [getattr(model, name) - getattr(rigid, name) for name in "MCK"]
        expected = [np.zeros((15, 15)), np.zeros((15, 15)), added[np.ix_(left, left)]]
        assert_matrices_match(
            changed, expected, inertia[np.ix_(left, left)], rotor.rotor_speed, model.dofs, 1e-10, 1e-13
        )


def test_a_given_coupling_overrides_its_own_closed_form_alone():
    """Each of the two adds its share, whatever the other is."""
    case = coupled_case()
    rigid, both = case.model(pitch="rigid"), case.model(pitch="coupling")
    flap_alone = case.model(pitch="coupling", pitch_lag_coupling=0.0)
    lag_alone = case.model(pitch="coupling", pitch_flap_coupling=0.0)
    shares = [alone.K - rigid.K for alone in (flap_alone, lag_alone)]
    for share, first in zip(shares, ("flap_0", "lag_0"), strict=True):
        start = rigid.dofs.index(first)
        assert np.abs(share).max() > 1e-3 * np.abs(rigid.K).max()
        assert not np.delete(share, range(start, start + 3), axis=1).any()
    assert np.abs(both.K - rigid.K - sum(shares)).max() < 1e-13 * np.abs(rigid.K).max()


def test_given_closed_forms_change_nothing():
    case = coupled_case()
    model = case.model(pitch="coupling")
    blades = bent_blades(case.pair.package, model.trim)
    flap, lag = printed_couplings(blades)
    given = case.model(pitch="coupling", pitch_flap_coupling=float(flap), pitch_lag_coupling=float(lag))
    assert np.abs(given.K - model.K).max() < 1e-10 * np.abs(model.K).max()


@pytest.mark.parametrize("name", ["windmilling", "powered, tables"])
def test_no_couplings_are_rigid_pitch(name):
    """Bit for bit."""
    case = coupled_case(name)
    rigid = case.model(pitch="rigid")
    without = case.model(pitch="coupling", pitch_flap_coupling=0.0, pitch_lag_coupling=0.0)
    for matrix in ("M", "C", "K", "B"):
        assert np.array_equal(getattr(without, matrix), getattr(rigid, matrix))


@pytest.mark.parametrize("option", ["pitch_flap_coupling", "pitch_lag_coupling"])
def test_given_couplings_need_the_pitch_option(option):
    case = coupled_case()
    for pitch in ("dynamic", "rigid"):
        with pytest.raises(pp.InputError, match=f'{option} = 0.1: goes with pitch="coupling"'):
            case.model(pitch=pitch, **{option: 0.1})
    with pytest.raises(pp.InputError, match=f"{option} = nan: must be finite"):
        case.model(pitch="coupling", **{option: np.nan})
