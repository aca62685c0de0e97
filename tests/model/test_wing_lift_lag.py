"""Lag of a wing's lift against strips that lag one by one, closed forms of one strip, and in every analysis.

Strips lag in the frequency domain, by Jones' function of the reduced frequency, without states and shape functions.
"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm

import proprotor as pp
from benchmarks import reed_bland as report
from proprotor.errors import InputError
from proprotor.explore.analysis import live_modes
from proprotor.model.first_order import state_matrix
from proprotor.model.wing_lift_lag import with_wing_lag
from proprotor.stability.boundaries import scan_speeds
from proprotor.stability.origins import model_parts
from proprotor.study.study import study
from proprotor.support import wing_circulation
from proprotor.support.wing_aerodynamics import Strips, WingAerodynamics, in_airstream
from tests.known_systems import linear_model
from tests.model.test_lift_lag import wagner
from tests.oracles.lagging_lift import jones

RHO, V, CHORD, SLOPE = 1.1, 90.0, 1.6, 5.7
K = np.array([0.01, 0.03, 0.1, 0.2, 0.3, 0.5, 1.0, 3.0])  # reduced frequencies
AIR = WingAerodynamics(lift_slope=SLOPE, chord=CHORD, elastic_axis=0.4, sweep=0.2)
LAGS = ("lagged", "lagged-wing")


def support_of(strips):
    """Coordinates without stiffness and damping of their own, on strips."""
    count = strips.rise.shape[-1]
    names, none = [f"q{place}" for place in range(count)], np.zeros((count, count))
    support = pp.NormalModes(names, np.eye(count), none, none, np.zeros((6, count)), False)
    return in_airstream(support, strips, AIR)


def on_air(support, lagged=True, airspeed=V):
    """The support alone in the air, its lift at once or late."""
    moving = support.at(airspeed, RHO)
    model = linear_model(moving.mass, moving.damping, moving.stiffness, dofs=tuple(support.names))
    return with_wing_lag(model, support.wing_circulation(airspeed, RHO)) if lagged else model


def dynamic(model, s):
    """Stiffness at exp(st) of the coordinates whose displacements are states, the others condensed."""
    whole, own = s**2 * model.M + s * model.C + model.K, len(model.dofs) - len(model.rates)
    assert not model.K[:, own:].any()
    rates = s * model.M + model.C
    return whole[:own, :own] - rates[:own, own:] @ np.linalg.solve(rates[own:, own:], whole[own:, :own])


def strips_one_by_one(strips, s):
    """Work of strips whose lift lags by Jones' function, on the left, and the size of it without the lag."""
    ahead, behind = (0.4 - 0.25) * CHORD, (0.75 - 0.4) * CHORD
    late = jones(s * CHORD / (2 * V))
    total, at_once = 0.0, 0.0
    for width, rise, pitch in zip(*strips, strict=True):
        downwash = V * pitch - s * (rise - behind * pitch)
        lift = RHO * V * np.cos(0.2) * SLOPE * CHORD / 2 * width * downwash
        total = total - np.outer(rise + ahead * pitch, lift * late)
        at_once = at_once - np.outer(rise + ahead * pitch, lift)
    return total, at_once


def bent_wing(count=40):
    """Heave, roll, bending and twist of a wing by many strips."""
    width = np.full(count, 4.9 / count)
    share = (np.arange(count) + 0.5) / count
    rise = np.stack([0 * share + 1, share, (3 * share**2 - share**3) / 2, 0 * share], axis=-1)
    pitch = np.stack([0 * share, 0 * share, 0 * share, share], axis=-1)
    return Strips(width, rise, pitch)


# Strips -----------------------------------------------------------------------------------------------------


def one_strip():
    return Strips(np.array([2.0]), np.array([[1.0, 0.3]]), np.array([[0.0, 1.0]]))


@pytest.fixture
def with_functions(monkeypatch):
    return lambda count: monkeypatch.setattr(wing_circulation, "_SHAPES", count)


def test_one_strip_is_jones_function(with_functions):
    with_functions(1)
    strips = one_strip()
    model = on_air(support_of(strips))
    for k in K:
        s = 2j * k * V / CHORD
        expected, at_once = strips_one_by_one(strips, s)
        found = dynamic(model, s) - s**2 * np.eye(2)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * np.abs(at_once).max())


def test_one_strip_beside_theodorsen(with_functions):
    """Within 2.5 per cent in modulus; the phase is as Jones' function has it, within a degree and a half."""
    with_functions(1)
    support = support_of(Strips(np.array([2.0]), np.array([[1.0]]), np.array([[0.0]])))
    late, at_once = on_air(support), on_air(support, lagged=False)
    ratio = np.array(
        [(dynamic(late, s) - s**2)[0, 0] / (dynamic(at_once, s) - s**2)[0, 0] for s in 2j * K * V / CHORD]
    )
    exact = report.theodorsen(K)
    assert np.max(np.abs(np.abs(ratio / exact) - 1)) < 0.025
    assert np.max(np.abs(np.degrees(np.angle(ratio / exact)))) < 1.5


def test_a_step_of_the_incidence_beside_wagner(with_functions):
    """Within 1.5 per cent at every time, from the states of a strip that is turned at once."""
    with_functions(1)
    strips = Strips(np.array([2.0]), np.array([[1.0, 0.0]]), np.array([[0.0, 1.0]]))
    model = on_air(support_of(strips))
    rates, force = model.C[2:, 2:], model.K[0, 1] - RHO * V**2 * support_of(strips).airload_stiffness[0, 1]
    for s in (0.0, 0.5, 2.0, 5.0, 20.0, 50.0):
        time = s * CHORD / 2 / V
        driven = -model.K[2:, 1]
        state = np.linalg.solve(rates, driven - expm(-rates * time) @ driven)
        lift = model.K[0, 1] + model.C[0, 2:] @ state
        ratio = lift / (RHO * V**2 * support_of(strips).airload_stiffness[0, 1])
        np.testing.assert_allclose(ratio, wagner(s), rtol=0.015)
    assert force != 0


@pytest.mark.parametrize("count", [1, 2, 3])
def test_the_lift_of_a_steady_motion_is_that_at_once(count, with_functions):
    with_functions(count)
    support = support_of(bent_wing())
    late, at_once = dynamic(on_air(support), 0.0), dynamic(on_air(support, lagged=False), 0.0)
    np.testing.assert_allclose(late, at_once, rtol=1e-12, atol=1e-12 * np.abs(at_once).max())


def test_three_functions_of_the_span_are_enough(with_functions):
    """Beside strips that lag one by one: within half a per cent of the lift at once, and better with each."""
    strips, errors = bent_wing(), {}
    for count in (1, 2, wing_circulation._SHAPES, 4):
        with_functions(count)
        model = on_air(support_of(strips))
        errors[count] = 0.0
        for k in K:
            s = 2j * k * V / CHORD
            expected, at_once = strips_one_by_one(strips, s)
            size = np.abs(at_once).max(axis=1, keepdims=True)
            error = np.abs(dynamic(model, s) - s**2 * np.eye(4) - expected) / size
            errors[count] = max(errors[count], error.max())
    assert list(errors) == [1, 2, 3, 4]
    assert errors[1] > 5 * errors[2] > 25 * errors[3] and errors[4] < 1e-10
    assert errors[3] < 5e-3


def test_a_chord_of_no_length_gives_lift_at_once():
    thin = replace(AIR, chord=1e-12, lift_slope=SLOPE * CHORD * 1e12)
    strips = bent_wing()
    support = replace(support_of(strips), wing=thin.lift(strips))
    damping, stiffness = thin.matrices(strips)
    moving = support.at(0.0, RHO)
    quasi_steady = linear_model(
        moving.mass, RHO * V * damping, RHO * V**2 * stiffness, dofs=tuple(support.names)
    )
    late = with_wing_lag(quasi_steady, support.wing_circulation(V, RHO))
    for s in 2j * K * V / CHORD:
        found, expected = dynamic(late, s), dynamic(quasi_steady, s)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * np.abs(expected).max())


# Decks ------------------------------------------------------------------------------------------------------

WING = """
base = "xv15"
[case]
name = "with lift of the wing"
[support.wing_aerodynamics]
lift_slope = {value = "5.7/rad", status = "assumed", source = "test"}
chord = {value = "5.2 ft", status = "assumed", source = "test"}
elastic_axis = {value = 0.4, status = "assumed", source = "test"}
"""
CHORD_OF_WING = "support.wing_aerodynamics.chord"


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    path = tmp_path_factory.mktemp("deck") / "wing.toml"
    path.write_text(WING, encoding="utf-8")
    return pp.load_case(path)


@pytest.fixture(scope="module")
def aircraft():
    return pp.load_case("xv15-aircraft")


def with_jones(case, model, s):
    """The model at exp(st) with its wing's lift less what Jones' function holds back of it."""
    wing, n = case.support, len(case.support.names)
    density, speed = float(case.operation.density), float(model.airspeed)
    chord = float(case.given[CHORD_OF_WING].si)
    held = 1 - jones(s * chord / (2 * speed))
    whole = (s**2 * model.M + s * model.C + model.K).astype(complex)
    late = s * density * speed * wing.airload_damping + density * speed**2 * wing.airload_stiffness
    whole[:n, :n] -= held * late
    return whole


@pytest.mark.parametrize("airspeed", [80.0, 150.0])
def test_a_wing_of_a_deck_lags_as_its_strips_do(case, airspeed):
    """All strips have one reduced frequency, so that the whole lift is multiplied by one number."""
    at_once, late = (case.linearize(airspeed, lift=lift) for lift in ("quasi-steady", "lagged-wing"))
    n = len(case.support.names)
    assert late.dofs[: len(at_once.dofs)] == at_once.dofs
    assert late.dofs[-1] == "fast wing lift 3" and late.rates == late.dofs[len(at_once.dofs) :]
    for s in (20j, 40j, -0.5 + 30j):
        whole = s**2 * late.M + s * late.C + late.K
        own = len(at_once.dofs)
        found = whole[:own, :own] - whole[:own, own:] @ np.linalg.solve(whole[own:, own:], whole[own:, :own])
        expected = with_jones(case, at_once, s)
        of_lift = np.abs(expected - (s**2 * at_once.M + s * at_once.C + at_once.K)).max()
        assert np.abs((found - expected)[:n, :n]).max() < 1e-2 * of_lift
        np.testing.assert_array_equal(np.delete(found - expected, range(n), axis=0), 0)


def test_roots_of_the_wing_are_those_of_its_strips(case):
    """Newton's iteration on the strips that lag one by one arrives where the states have their root."""
    at_once, late = (case.linearize(150.0, lift=lift) for lift in ("quasi-steady", "lagged-wing"))
    modes = late.modes()
    named = dict(zip(modes.name.values.tolist(), modes.eigenvalue.values, strict=True))
    for name in ("beam", "chord", "torsion"):
        root, s = named[name], named[name]
        for _ in range(8):
            smallest = [np.linalg.eigvals(with_jones(case, at_once, s + step)) for step in (0.0, 1e-4)]
            value, near = (values[np.abs(values).argmin()] for values in smallest)
            s = s - value * 1e-4 / (near - value)
        assert abs(s - root) < 1e-4 * abs(root), name
        plain = at_once.modes()
        quasi_steady = plain.eigenvalue.values[plain.name.values.tolist().index(name)]
        if name == "beam":
            assert abs(s - quasi_steady) > 5e-3 * abs(root)  # there is something to see


def test_derivatives_through_the_lag(case):
    path, step, options = CHORD_OF_WING, 1e-4, {"lift": "lagged-wing"}
    found = case.sensitivity("eigenvalue", airspeed=150.0, wrt=[path], **options)
    own = float(case.given[path].si)
    ahead, behind = (
        np.linalg.eigvals(state_matrix(case.vary({path: own + sign * step}).linearize(150.0, **options)))
        for sign in (1, -1)
    )
    for value, derivative in zip(found.eigenvalue.values, found.derivative.values[0], strict=True):
        if abs(derivative) * own < 1e-3:
            continue
        moved = [
            roots[
                np.abs(roots - value - sign * step * derivative).argmin()
            ]  # roots of the lag are close together
            for sign, roots in ((1, ahead), (-1, behind))
        ]
        assert derivative == pytest.approx((moved[0] - moved[1]) / (2 * step), rel=1e-5)
    assert bool(found.exact.all())


def test_sweep_study_boundary_and_explorer(case):
    options = {"lift": "lagged"}
    sweep = case.sweep("250:350:20kt", **options)
    assert {"slow wing lift", "fast wing lift 3", "cyclic slow lift"} <= set(sweep.mode.values.tolist())
    speeds = scan_speeds(case, 40)
    live, exact = live_modes(case, speeds, **options), case.sweep(speeds, **options)
    good = np.isfinite(exact.eigenvalue.values).all(axis=1)
    order = [np.sort_complex(values[good]) for values in (live.eigenvalue, exact.eigenvalue.values)]
    np.testing.assert_allclose(*order, rtol=1e-8, atol=1e-8)
    designs = study(case, {CHORD_OF_WING: [1.2, 1.6]}, [120.0, 150.0], quantities="eigenvalue", **options)
    for place, chord in enumerate((1.2, 1.6)):
        matrix = state_matrix(case.vary({CHORD_OF_WING: chord}).linearize(150.0, **options))
        expected = np.linalg.eigvals(matrix)
        for value in designs.eigenvalue.values[place, 1]:
            assert np.abs(expected - value).min() < 1e-10 * np.abs(expected).max()
    point = case.flutter_point("300:420:20kt", **options)
    root = np.linalg.eigvals(state_matrix(case.linearize(point.speed, **options)))
    assert np.abs(root.real).min() < 1e-6


def test_origins_have_the_lag_of_the_wing_apart(case, aircraft):
    for one in (case, aircraft):
        model = one.linearize(150.0, lift="lagged")
        parts = model_parts(one, model)
        assert {"lag of lift", "lag of the wing's lift"} <= set(parts)
        for place, kind in enumerate("MCK"):
            whole = getattr(model, kind)
            np.testing.assert_allclose(
                sum(part[place] for part in parts.values()),
                whole,
                rtol=1e-9,
                atol=1e-12 * np.abs(whole).max(),
            )


def test_frequency_response_and_points_without_a_trim(case):
    model = case.linearize(np.array([150.0, 2000.0]), lift="lagged-wing")
    assert np.isnan(model.C[1]).all() and np.isfinite(model.C[0]).all() and model.trim.reason[1]
    found = pp.frequency_response(model, [5.0, 20.0], inputs=["cyclic_1c"], outputs=["force_x"])
    one = case.linearize(150.0, lift="lagged-wing")
    motion = np.linalg.solve(one.K + 20j * one.C - 400 * one.M, one.B[:, 1])
    to_rotor = np.zeros((len(one.rotor.dofs), len(one.dofs)))
    to_rotor[:6] = one.hub
    for row, name in enumerate(one.rotor.dofs[6:], start=6):
        to_rotor[row, one.dofs.index(name)] = 1
    of_rotor = to_rotor @ motion
    load = one.rotor.B[0, 1] - (one.rotor.K + 20j * one.rotor.C - 400 * one.rotor.M)[0] @ of_rotor
    assert found.response.values[0, 1, 0, 0] == pytest.approx(load, rel=1e-8)


def test_both_halves_of_an_aircraft(aircraft):
    model = aircraft.linearize(150.0, lift="lagged-wing")
    late = [name for name in model.rates if "wing lift" in name]
    assert len(late) == 2 * 2 * wing_circulation._SHAPES
    assert (
        dict(zip(model.dofs, model.symmetry, strict=True))["antisymmetric slow wing lift 2"]
        == "antisymmetric"
    )
    assert not model.halves_couple and len(model.blocks) == 2
    for one, other in (model.blocks, model.blocks[::-1]):
        for name in "MCK":
            assert not getattr(model, name)[np.ix_(one, other)].any()
    half = pp.load_case("xv15-aircraft", {"support.symmetry": "symmetric"})
    alone = np.linalg.eigvals(state_matrix(half.linearize(150.0, lift="lagged-wing")))
    every = np.linalg.eigvals(state_matrix(model))
    for value in alone:
        assert np.abs(every - value).min() < 1e-8 * np.abs(every).max()


def test_an_option_for_a_wing_without_airloads_is_refused():
    case = pp.load_case("xv15")
    with pytest.raises(InputError, match=r"lift = lagged-wing: goes with .*wing_aerodynamics"):
        case.linearize(100.0, lift="lagged-wing")
    assert case.linearize(100.0, lift="lagged").dofs == case.linearize(100.0, lift="lagged-blades").dofs
    assert case.linearize(100.0, lift="lagged-wing", airloads="none") if "wing" in case.name else True
