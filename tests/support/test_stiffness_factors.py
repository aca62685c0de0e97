"""Stiffness factors fitted to frequencies: against closed forms, a search by halving, differences and the rotor."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import brentq

import proprotor as pp
from proprotor.deck import build_support
from proprotor.errors import InputError
from proprotor.model.first_order import state_matrix
from proprotor.support.beam_wing import beam_structure, beam_wing
from proprotor.support.stiffness_factors import KINDS, stiffened, stiffness_factors
from tests.support.test_beam_wing import BARE, BODY, EI, EIC, GJ, L, massless, wing
from tests.support.test_rotor_share import at_rest

FOUND = 1e-9  # of a frequency that was asked for
POINT = 400.0 * np.diag([1.0] * 3 + [0.0] * 3)  # a rotor's mass, kg
OMEGA = 458 * np.pi / 30
GIVEN = {"support.beam_frequency": 0.42, "support.chord_frequency": 0.70, "support.torsion_frequency": 1.30}
FACTORS = [f"support.{kind}_stiffness_factor" for kind in KINDS]


def lowest(one, pylon, at_hub):
    """The three lowest frequencies, by another eigenvalue solver."""
    structure = beam_structure(one, pylon)
    mass = structure.mass + structure.hub.T @ at_hub @ structure.hub
    return np.sqrt(eigh(structure.stiffness, mass, eigvals_only=True)[: len(KINDS)])


def test_a_massless_cantilever_has_the_factors_of_its_closed_forms():
    """A point mass at the tip: ω² = 3 EI f / (m L³) for each bending; a roll inertia about J: ω² = GJ f / (I L)."""
    inertia = 900.0
    pylon = replace(BARE, nacelle_pitch_inertia=inertia)
    wanted = {"beam": 21.0, "chord": 37.0, "torsion": 29.0}
    found = stiffness_factors(massless(), pylon, POINT, wanted)
    expected = {kind: w**2 * 400.0 * L**3 / 3 for kind, w in wanted.items()} | {
        "torsion": 29.0**2 * inertia * L
    }
    for kind, stiffness in zip(KINDS, (EI, EIC, GJ), strict=True):
        assert found.factors[kind] == pytest.approx(expected[kind] / stiffness, rel=FOUND)
        assert found.reasons[kind] == ""


def test_one_factor_is_that_of_a_search_by_halving():
    one = wing(sweep=-0.11, dihedral=0.035)
    wanted = 1.15 * lowest(one, BODY, POINT)[2]
    expected = brentq(
        lambda factor: lowest(stiffened(one, {"torsion": factor}), BODY, POINT)[2] - wanted,
        0.5,
        3.0,
        xtol=1e-13,
    )
    found = stiffness_factors(one, BODY, POINT, {"torsion": wanted})
    assert found.factors["torsion"] == pytest.approx(expected, rel=FOUND)


def test_a_mode_that_is_not_yet_among_the_lowest_is_found():
    """Twist so stiff that the second beam mode is lower; of a straight wing no bending mode has any energy of twist."""
    stiff = wing(torsion_stiffness=500 * GJ)
    pylon = replace(BARE, nacelle_pitch_inertia=420.0, nacelle_yaw_inertia=400.0, nacelle_roll_inertia=90.0)
    assert beam_wing(stiff, pylon, modes=3, rotor_mass=400.0).names == ("beam", "chord", "beam_2")
    found = stiffness_factors(stiff, pylon, POINT, {"torsion": 30.0})
    assert found.reasons["torsion"] == ""
    assert np.abs(lowest(stiffened(stiff, found.factors), pylon, POINT) - 30.0).min() < 30.0 * FOUND


@pytest.mark.parametrize("held", ["gimballed", "rigid", "mass only"])
@pytest.mark.parametrize("shaft", ["held", "free"])
def test_the_whole_rotor_on_the_wing_has_the_frequencies_of_the_deck(held, shaft):
    """At rest in a vacuum, blades locked and no hub spring: of the equations of the rotor, not of its share."""
    case = pp.load_case(
        "xv15", {"support.rotor_held": held, "support.shaft": shaft, "rotor.gimbal_stiffness": "0 N*m/rad"}
    )
    if held == "mass only":
        support = case.support
        hub = support.hub[:3]
        mass = support.mass + case.rotor.n_blades * case.rotor.blade_mass * hub.T @ hub
        per_rev = np.sqrt(eigh(support.stiffness, mass, eigvals_only=True)) / OMEGA
    else:
        locked = ("flap", "lag") + ("gimbal",) * (held == "rigid")
        speed = "constant" if shaft == "held" else "windmilling"
        per_rev, _, dofs = at_rest(case, locked=locked, rotor_speed=speed)
        per_rev = per_rev[len(dofs) - len(case.support.names) :]
    np.testing.assert_allclose(per_rev[:3], list(GIVEN.values()), rtol=FOUND)
    assert case.support.names[:3] == KINDS


def test_the_deck_shows_its_factors_and_takes_them():
    """Given as numbers, the factors make the same wing."""
    case = pp.load_case("xv15")
    shown = {path: case.sources[path] for path in FACTORS}
    assert {number.status for number in shown.values()} == {"calibrated"}
    assert shown[FACTORS[0]].source.startswith(
        "fitted to beam_frequency with the rotor gimballed at the hub; "
    )
    again = pp.load_case("xv15", {path: repr(float(number.si)) for path, number in shown.items()})
    assert not set(GIVEN) & set(again.given)
    np.testing.assert_allclose(again.support.stiffness, case.support.stiffness, rtol=1e-9, atol=1e-3)
    np.testing.assert_allclose(again.support.hub, case.support.hub, rtol=0, atol=1e-12)


def test_without_frequencies_a_wing_is_what_it_was():
    """Factors of 1, and the rotor as a point mass in place of a mass typed by hand."""
    aircraft = pp.load_case("xv15-wing")
    same = pp.load_case("xv15-wing", {path: "1" for path in FACTORS} | {"support.rotor_held": "mass only"})
    frequency = [
        eigh(case.support.stiffness, case.support.mass, eigvals_only=True) for case in (aircraft, same)
    ]
    np.testing.assert_allclose(*frequency, rtol=1e-9)


def test_many_designs_are_each_design():
    case = pp.load_case("xv15")
    speeds, masses = np.array([0.40, 0.42]) * OMEGA, np.array([[4.0], [4.3]]) * 14.593902937
    many = case.vary({"support.beam_frequency": speeds, "rotor.blade_mass": masses})
    factors = many.sources[FACTORS[0]].si
    assert factors.shape == (2, 2) and many.support.hub.shape == (2, 2, 6, 3)
    for place in np.ndindex(2, 2):
        one = case.vary({"support.beam_frequency": speeds[place[1]], "rotor.blade_mass": masses[place[0], 0]})
        assert factors[place] == pytest.approx(one.sources[FACTORS[0]].si, rel=1e-9)
        np.testing.assert_allclose(many.support.hub[place], one.support.hub, rtol=0, atol=1e-10)


@pytest.mark.parametrize(
    "path", ["support.beam_frequency", "support.span", "support.nacelle_forward", "rotor.blade_mass"]
)
def test_derivatives_of_factors_by_a_complex_step_are_those_by_differences(path):
    case = pp.load_case("xv15", {"support.nacelle_forward": "3 in"})
    at, step = case.given[path].si, 1e-30

    def factors(value):
        return np.array([case.vary({path: value}).sources[name].si for name in FACTORS])

    exact = factors(np.asarray(at + 1j * step)).imag / step
    size = 1e-3 * at
    coarse, fine = ((factors(at + one) - factors(at - one)) / (2 * one) for one in (size, size / 2))
    np.testing.assert_allclose(exact, (4 * fine - coarse) / 3, rtol=1e-6, atol=1e-8 / at)


def test_derivatives_of_roots_go_through_the_fit():
    """The beam root with respect to frequencies and to masses that the fit holds, exactly and by differences."""
    case, airspeed = pp.load_case("xv15"), 150.0
    paths = [
        "support.beam_frequency",
        "support.torsion_frequency",
        "rotor.blade_mass",
        "support.nacelle_mass",
    ]
    found = case.sensitivity("eigenvalue", paths, airspeed=airspeed, mode="beam")
    assert found.exact.values.all()
    near = found.eigenvalue.item()
    for path in paths:
        own, moved = float(case.given[path].si), []
        for factor in (1.001, 0.999):
            roots = np.linalg.eigvals(state_matrix(case.vary({path: own * factor}).linearize(airspeed)))
            moved.append(roots[np.abs(roots - near).argmin()])
        limit = (moved[0] - moved[1]) / (0.002 * own)
        assert found.derivative.sel(input=path).item() == pytest.approx(limit, rel=1e-4)


def test_a_mode_of_another_kind_does_not_count():
    """A wing and an offset hub that couple so much that the mode of the beam frequency strains mostly in chord."""
    coupled = wing(sweep=0.21490692543428436, dihedral=0.6384882751244689)
    pylon = replace(BODY, mast_height=0.30401111, mast_outboard=0.48457436, mast_length=1.17747997)
    wanted = {"beam": 39.49839444074708, "chord": 44.88481731517471, "torsion": 19.697768732497742}
    found = stiffness_factors(coupled, pylon, POINT, wanted)
    assert str(found.reasons["beam"]).startswith(
        "is that of a mode with most of its strain energy in chord, not in"
    )
    frequency = lowest(stiffened(coupled, found.factors), pylon, POINT)
    np.testing.assert_allclose(frequency, np.sort(list(wanted.values())), rtol=FOUND)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (
            {"support.torsion_frequency": "40 Hz"},
            r"^support.torsion_frequency = 40 Hz: is out of reach together .* the rotor have beam 3.08\d Hz, chord",
        ),
        (
            # Coupled through the mass, two modes cannot come as near to each other as that.
            {"support.torsion_frequency": "4 Hz"},
            r"^support.torsion_frequency = 4 Hz: is out of reach together",
        ),
        ({"support.beam_frequency": "0 Hz"}, r"^support.beam_frequency = 0 Hz: must be positive"),
        ({"support.beam_stiffness_factor": "0"}, r"^support.beam_stiffness_factor = 0: must be positive"),
        ({"support.rotor_held": "loose"}, r'^support.rotor_held = loose: must be "gimballed" or "rigid" or'),
        (
            {"support.rotor_held": "false"},
            r'^support.rotor_held = false: must be "gimballed" or "rigid" or',
        ),
    ],
)
def test_frequencies_that_no_factor_gives(settings, message):
    with pytest.raises(InputError, match=message) as caught:
        pp.load_case("xv15", settings)
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            'beam_frequency = "3 Hz"\nbeam_stiffness_factor = 1.1',
            "support.beam_stiffness_factor: must not be given with beam_frequency, to which the factor is fitted",
        ),
        (
            'rotor_held = "rigid"\nrotor_mass = "12 slug"',
            "support.rotor_held: must not be given with rotor_mass",
        ),
    ],
)
def test_of_two_ways_to_say_it_a_deck_takes_one(tmp_path, text, message):
    path = tmp_path / "wing.toml"
    path.write_text(f'base = "xv15-wing"\n[case]\nname = "w"\n[support]\n{text}\n', encoding="utf-8")
    with pytest.raises(InputError) as caught:
        pp.load_case(path)
    assert str(caught.value) == message


def test_of_many_designs_the_one_without_a_factor_fails_alone():
    designs = {"support.torsion_frequency": [1.3 * OMEGA, 250.0]}
    found = pp.study(pp.load_case("xv15"), designs, airspeed=[100.0], quantities=("least_stable",))
    assert found.reason.values[0] == "" and "is out of reach" in str(found.reason.values[1])
    assert np.isfinite(found.damping_ratio.values[0]).all() and np.isnan(found.damping_ratio.values[1]).all()


def test_a_beam_mode_as_built_pitches_as_trials_of_the_geometry_say():
    """Sweep and the rotor 47.3 in ahead turn the hub nose up by .06 to .12 rad per metre of rise; typed, by nothing.

    In the torsion mode the hub moves .6 to .9 m per radian, and the mass is 440 to 580 slug ft² (design notes).
    """
    support = pp.load_case("xv15").support
    beam, torsion = support.hub[:, 0], support.hub[:, 2]
    assert 0.06 < beam[4] / beam[0] < 0.12
    assert 0.6 < torsion[0] / torsion[4] < 0.9
    assert pp.load_case("xv15-uncoupled").support.hub[4, 0] == 0


def test_factors_that_stay_are_those_of_the_same_numbers_alone():
    """A search asks for the same wings in other company; complex numbers, and neighbours in rounding, are others."""
    case = pp.load_case("xv15")
    path, factor = "support.nacelle_mass", "support.torsion_stiffness_factor"
    mass = case.given[path].si
    near, step = np.nextafter(mass, np.inf), mass + 1e-20j
    apart = {value: case.vary({path: value}).sources[factor].si for value in (mass, near, 1.1 * mass, step)}
    build_support._FACTORS.clear()
    for company in ([mass, 1.1 * mass], [1.1 * mass, near, mass], [near, near]):
        found = case.vary({path: np.array(company)}).sources[factor].si
        np.testing.assert_array_equal(found, [apart[value] for value in company])
    derivative = case.vary({path: np.array([step, step])}).sources[factor].si.imag
    assert (derivative == apart[step].imag).all() and (derivative != 0).all()
    assert not np.iscomplexobj(case.vary({path: np.array([mass])}).sources[factor].si)
