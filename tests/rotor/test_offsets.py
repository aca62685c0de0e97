"""Masses and aerodynamic centres beside the pitch axis: closed forms of one blade, integrals, and what is refused.

Closed forms are held to 1e-12 of the largest entry of a matrix, integrals to 1e-12 of the same of the absolute value.
"""

import numpy as np
import pytest
from click.testing import CliRunner

import proprotor as pp
from proprotor.commands.main import main
from proprotor.deck.blade_file import read_blade
from proprotor.model.quantities import closed_couplings

RADIUS, MASS, SPEED, DENSITY, CHORD, SLOPE = 4.0, 6.0, 40.0, 1.2, 0.3, 5.7
FLAP_INERTIA, FIRST_MOMENT = MASS * RADIUS**3 / 3, MASS * RADIUS**2 / 2
PITCH_INERTIA = 0.6
LOCK = DENSITY * SLOPE * CHORD * RADIUS**4 / FLAP_INERTIA
MOTIONS = ("flap_0", "pitch_0")


def uniform_rotor(**changes):
    """Uniform blades without twist, hinged at the centre of rotation."""
    given = {
        "n_blades": 3,
        "radius": RADIUS,
        "flap_stiffness": 0.0,
        "lag_stiffness": 1e6,
        "pitch_inertia": PITCH_INERTIA,
        "control_stiffness": 4e3,
        "chord": CHORD,
        "airfoil": pp.Airfoil(lift_slope=SLOPE),
    }
    return pp.Rotor.from_mass_distribution([0.0, RADIUS], [MASS, MASS], **given | changes)


def hovering(**changes):
    """The collective motions of a rotor with flat pitch in still air."""
    air = {"density": DENSITY, "speed_of_sound": 340.0, "trim": {"collective": 0.0}}
    options = {"section_damping": False, "compressibility": False, "locked": ("lag", "gimbal")}
    model = pp.rotor_model(uniform_rotor(**changes), pp.Operation(rotor_speed=SPEED, **air), 0.0, **options)
    assert model.trim.converged, model.trim.reason
    return model.submodel(MOTIONS)


def classical(mass_offset, stiffness):
    """M, C, K of flap and pitch of one blade, as textbooks have them: S = ∫ m x r, quasi-steady lift on the axis."""
    s, lift = mass_offset * FIRST_MOMENT, LOCK / 8 * FLAP_INERTIA * SPEED
    mass = np.array([[FLAP_INERTIA, -s], [-s, PITCH_INERTIA]])
    damping = np.array([[lift, 0.0], [0.0, 0.0]])
    held = mass * SPEED**2 + np.diag([0.0, stiffness])
    return mass, damping, held - np.array([[0.0, lift * SPEED], [0.0, 0.0]])


@pytest.mark.parametrize("mass_offset", [-0.02, 0.0, 0.03])
def test_flap_and_pitch_of_a_blade_are_those_of_textbooks(mass_offset):
    model = hovering(mass_offset=mass_offset, control_stiffness=4e3)
    for matrix, expected in zip((model.M, model.C, model.K), classical(mass_offset, 4e3), strict=True):
        assert np.abs(matrix / 3 - expected).max() < 1e-12 * np.abs(expected).max()


def test_a_blade_with_its_mass_aft_diverges_where_its_control_system_is_too_soft():
    """K_θ/Ω² + I_θ = S (γ/8 + S/I_β), below which there is no trim; with its mass ahead a blade does not diverge."""
    for mass_offset in (0.03, 0.06):
        s = mass_offset * FIRST_MOMENT
        boundary = SPEED**2 * (s * (LOCK / 8 + s / FLAP_INERTIA) - PITCH_INERTIA)
        near, far = (
            np.linalg.det(hovering(mass_offset=mass_offset, control_stiffness=share * boundary).K)
            for share in (1.01, 1.11)
        )
        assert np.isclose(far / near, 11.0, rtol=1e-9)  # linear in K_θ, and zero at the boundary
        with pytest.raises(AssertionError, match="path from the undeflected blade"):
            hovering(mass_offset=mass_offset, control_stiffness=0.9 * boundary)
    assert np.linalg.det(hovering(mass_offset=-0.03, control_stiffness=1.0).K) > 0


def test_a_blade_with_its_mass_aft_flutters_and_one_with_its_mass_ahead_does_not():
    """Flutter of the textbook's two motions, by Routh and Hurwitz: 0 < S/I_β < γ/8 I_θ Ω² / K_θ."""
    stiffness = 6e4  # too stiff to diverge
    last = LOCK / 8 * PITCH_INERTIA * SPEED**2 / stiffness * FLAP_INERTIA / FIRST_MOMENT
    for share, grows in ((-3.0, False), (-0.1, False), (0.1, True), (0.9, True), (1.1, False), (2.0, False)):
        model = hovering(mass_offset=share * last, control_stiffness=stiffness)
        assert (model.modes().eigenvalue.values.real.max() > 0) == grows


def test_an_aerodynamic_centre_aft_of_the_axis_holds_the_blade_against_its_pitch():
    """Lift a θ at x_a behind the axis turns the nose down: K_θθ grows by k = ∫ ρ/2 c a x_a (Ωr)² dr.

    A blade that is up turns in space by Ω β about its span. The centre then goes down, and the lift grows by k β. A
    nose that comes up takes the centre down as well: K_βθ has no x_a, C_βθ and C_θθ have.
    """
    center = 0.05
    on_axis, aft = hovering(), hovering(aerodynamic_center=center)
    lift = DENSITY / 2 * CHORD * SLOPE * center
    k = lift * SPEED**2 * RADIUS**3 / 3
    expected = np.array([[-k, 0.0], [center * lift * SPEED**2 * RADIUS**2 / 2, k]])
    assert np.abs((aft.K - on_axis.K) / 3 - expected).max() < 1e-9 * k
    per_rate = lift * SPEED * RADIUS**3 / 3
    expected = np.array([[0.0, -per_rate], [-per_rate, center * lift * SPEED * RADIUS**2 / 2]])
    assert np.abs((aft.C - on_axis.C) / 3 - expected).max() < 1e-9 * per_rate


def test_couplings_of_the_control_system_have_the_masses_beside_the_axis():
    """K_Pβ = -∫ m x r Ω² / K_θ of an untwisted flat blade: a blade that flaps up with its mass aft turns nose up."""
    rotor = uniform_rotor(mass_offset=0.02)
    operation = pp.Operation(rotor_speed=SPEED, density=0.0, speed_of_sound=340.0, trim={"collective": 0.0})
    from proprotor.model.quantities import model_quantities
    from proprotor.rotor.options import parse_options
    from proprotor.rotor.trim import UNKNOWNS, with_trim

    options = parse_options({})
    given = model_quantities(rotor, operation, options, np.asarray(0.0), ())
    found = closed_couplings(with_trim(given, options, dict.fromkeys(UNKNOWNS, 0.0)))
    expected = -0.02 * FIRST_MOMENT * SPEED**2 / 4e3
    assert np.isclose(found["pitch_flap_coupling"], expected, rtol=1e-12)
    assert abs(found["pitch_lag_coupling"]) < 1e-12


# Integrals ----------------------------------------------------------------------------------------


STATIONS = np.array([0.0, 0.35, 0.9, 1.7, 2.6, 4.0])
TABLES = {
    "mass": np.array([30.0, 9.0, 7.0, 5.0, 6.5, 3.0]),
    "offset": np.array([0.01, -0.02, 0.03, 0.015, 0.0, 0.02]),
    "twist": np.array([0.7, 0.6, 0.4, 0.2, 0.05, -0.1]),
}


@pytest.mark.parametrize("hinge", [0.0, 0.5, 0.9])
def test_integrals_are_sums_over_the_blade(hinge):
    rotor = uniform_rotor()
    rotor = pp.Rotor.from_mass_distribution(
        STATIONS,
        TABLES["mass"],
        n_blades=3,
        radius=RADIUS,
        lag_hinge_offset=hinge,
        flap_stiffness=1e5,
        lag_stiffness=1e6,
        pitch_inertia=0.3,
        chord=0.3,
        twist=(STATIONS[[0, 2, 5]], TABLES["twist"][[0, 2, 5]]),
        airfoil=rotor.airfoil,
        mass_offset=(STATIONS[1:], TABLES["offset"][1:], "held"),
    )
    edges = np.unique(np.concatenate([np.linspace(hinge, RADIUS, 4001), STATIONS[hinge < STATIONS]]))
    nodes, weights = np.polynomial.legendre.leggauss(4)
    half = np.diff(edges)[:, None] / 2
    r, weight = (edges[:-1, None] + half * (1 + nodes)).ravel(), (half * weights).ravel()
    mass = np.interp(r, STATIONS, TABLES["mass"])
    x = np.interp(r, STATIONS[1:], TABLES["offset"][1:])
    knots, twist = STATIONS[[0, 2, 5]], TABLES["twist"][[0, 2, 5]]
    angle = np.interp(r, knots, twist) - np.interp(0.75 * RADIUS, knots, twist)
    cosine, sine = x * np.cos(angle), x * np.sin(angle)
    parts = (cosine, sine, cosine * (r - hinge), sine * (r - hinge), cosine**2, cosine * sine, sine**2)
    for found, part in zip(vars(rotor.offset_mass).values(), parts, strict=True):
        assert abs(found - (weight * mass * part).sum()) < 1e-12 * (weight * mass * np.abs(part)).sum()


def test_places_on_the_axis_change_nothing():
    """Bit for bit; a table of zeros goes by other plans, to rounding."""
    case = pp.load_case("xv15-mass-distribution")
    on_axis = pp.load_case("xv15-mass-distribution", {"rotor.aerodynamic_center": "0 ft"})
    zero = pp.load_case(
        "xv15-mass-distribution", {"rotor.aerodynamic_center": "0 ft", "rotor.mass_offset": "0 in"}
    )
    models = [part.linearize(np.array([100.0, 140.0])) for part in (case, on_axis, zero)]
    for name in "MCKB":
        own, same, near = (getattr(model, name) for model in models)
        assert np.array_equal(own, same)
        assert np.abs(near - own).max() < 1e-11 * np.abs(own).max()


# What is refused ----------------------------------------------------------------------------------


def test_masses_that_no_blade_can_have_are_refused():
    with pytest.raises(
        pp.InputError, match=r"pitch_inertia = 0\.01: must be at least ∫ m x² = 0\.0216 kg m²"
    ):
        uniform_rotor(mass_offset=0.03, pitch_inertia=0.01)
    whole = dict.fromkeys(pp.OffsetMass.__dataclass_fields__, 0.0) | {"offset_cosine_moment": 1.0}
    with pytest.raises(pp.InputError, match=r"offset_mass = .*: cannot belong to this blade"):
        uniform_rotor(offset_mass=pp.OffsetMass(**whole))
    with pytest.raises(pp.InputError, match=r"offset_sine_inertia = -1\.0: must not be negative"):
        pp.OffsetMass(**whole | {"offset_sine_inertia": -1.0})
    with pytest.raises(
        pp.InputError, match=r"mass_offset = 2 values: has stations from 0\.25 R to 1 R; they must"
    ):
        uniform_rotor(mass_offset=(np.array([1.0, RADIUS]), np.array([0.01, 0.01])))
    with pytest.raises(
        pp.InputError, match=r"aerodynamic_center = 2 values: has stations from 0\.25 R to 1 R"
    ):
        uniform_rotor(aerodynamic_center=(np.array([1.0, RADIUS]), np.array([0.01, 0.01])))


def test_an_offset_needs_to_know_where_the_mass_is():
    rule = r"rotor\.mass_offset = 1 in: must be given with mass_distribution"
    with pytest.raises(pp.InputError, match=rule):
        pp.load_case("xv15", {"rotor.mass_offset": "1 in"})


# Stations -----------------------------------------------------------------------------------------


HEAD = "r [m], mass [kg/m], EI_flat [N*m**2], EI_edge [N*m**2], GJ [N*m**2], twist [deg], chord [m], I_theta [kg*m]"
ROWS = [(0.4, 20.0), (1.0, 9.0), (2.0, 7.0), (3.0, 6.0), (4.0, 5.0)]


def stations_file(folder, head, cells):
    lines = [f"{HEAD}, {head}"]
    lines += [f"{r}, {m}, 1e5, 2e6, 3e5, {40 - 10 * r}, 0.35, 0.05, {cells}" for r, m in ROWS]
    path = folder / "stations.csv"
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def from_stations(path):
    blade = read_blade(path, pitch_bearing=0.5, control_stiffness=3e4)
    pitch = np.radians([20.0, 35.0, 50.0])
    airfoil = pp.Airfoil(lift_slope=5.7, drag=0.008)
    return blade, pp.Rotor.from_stations(blade, rotor_speed=45.0, pitch=pitch, n_blades=3, airfoil=airfoil)


@pytest.mark.parametrize(
    ("head", "cells"),
    [
        ("x_cg [mm], x_ac [mm]", "12, -4"),
        ("mass_offset [m], aerodynamic_center [cm]", "0.012, -0.4"),
        ("cg [mm], ac [mm], elastic_axis [mm]", "112, 96, 100"),
    ],
)
def test_a_rotor_of_stations_has_the_places_on_the_chord(tmp_path, head, cells):
    blade, rotor = from_stations(stations_file(tmp_path, head, cells))
    assert np.allclose(blade.mass_offset, 0.012, rtol=1e-12)
    assert np.allclose(rotor.aerodynamic_center[1], -0.004, rtol=1e-12)
    held = rotor.lag_first_moment
    angle = blade.angle(np.array([4.0]))  # twist makes less of the offset than its whole
    assert 0.012 * held * np.cos(angle[0]) * 0.8 < rotor.offset_mass.offset_cosine_lag_inertia < 0.012 * held
    assert np.isclose(rotor.offset_mass.inertia, 0.012**2 * mass_beyond(rotor.lag_hinge_offset), rtol=1e-12)


def test_the_deck_of_stations_has_them_too(tmp_path):
    """Lines of `proprotor blade --deck` in a deck give the rotor that Python makes of the same stations."""
    path = stations_file(tmp_path, "x_cg [mm], x_ac [mm]", "12, -4")
    arguments = ["blade", str(path), "--at-rotor-speed", "45 rad/s", "--collective", "20:50:15 deg", "--deck"]
    arguments += [
        str(tmp_path / "rotor.toml"),
        "--control-stiffness",
        "3e4 N*m/rad",
        "--pitch-bearing",
        "0.5 m",
    ]
    result = CliRunner().invoke(main, arguments)
    assert result.exit_code == 0, result.output
    lines = (tmp_path / "rotor.toml").read_text(encoding="utf-8")
    twist = 'twist = { r_over_R = [0.1, 0.25, 0.5, 0.75, 1], value = [36, 30, 20, 10, 0], unit = "deg", beyond = "held"'
    twist += " }\n"
    deck = f'base = "xv15-uncoupled"\n[case]\nname = "made"\n{lines}{twist}chord = "0.3 m"\n'
    (tmp_path / "made.toml").write_text(deck, encoding="utf-8")
    rotor, (_, expected) = pp.load_case(tmp_path / "made.toml").rotor, from_stations(path)
    # The hinge lies within an element of the blade in bending, whose sums over Gauss points do not end at the hinge.
    assert rotor.lag_inertia == pytest.approx(expected.lag_inertia, rel=1e-5)
    # The place of a hinge is that of a minimum, known to the root of rounding.
    for name, value in vars(expected.offset_mass).items():
        assert getattr(rotor.offset_mass, name) == pytest.approx(value, rel=1e-6)
    assert np.allclose(rotor.aerodynamic_center[1], -0.004, rtol=1e-9)


def mass_beyond(hinge):
    r, mass = np.transpose(ROWS)
    edges = np.unique([hinge, *r[r > hinge]])
    values = np.interp(edges, r, mass)
    return float((np.diff(edges) * (values[1:] + values[:-1]) / 2).sum())


def test_an_elastic_axis_without_places_that_count_from_it_is_refused(tmp_path):
    with pytest.raises(pp.InputError, match="has a column for elastic_axis, and none for mass_offset"):
        read_blade(stations_file(tmp_path, "elastic_axis [m]", "0.1"), control_stiffness=3e4)
