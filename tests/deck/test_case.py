"""Cases: a deck as rotor, operation and support, its errors told as written."""

import pickle
from dataclasses import fields

import numpy as np
import pytest

from proprotor.case import Case, list_cases, load_case
from proprotor.deck.sections import AirfoilSection, OperationSection, RotorSection
from proprotor.errors import InputError
from proprotor.rotor.airfoil import Airfoil
from proprotor.rotor.airfoil_regions import AirfoilRegions
from proprotor.rotor.operation import Operation
from proprotor.rotor.rotor import Rotor
from proprotor.support.normal_modes import NormalModes
from tests.c81_files import as_c81, made_up_tables

FT = 0.3048
LBF = 0.45359237 * 9.80665
SLUG = LBF / FT
RPM = np.pi / 30


def altered(tmp_path, text: str, base: str = "xv15-uncoupled") -> Case:
    path = tmp_path / "deck.toml"
    path.write_text(f'base = "{base}"\n[case]\nname = "altered"\n{text}')
    return load_case(path)


@pytest.mark.parametrize("name", list_cases())
def test_bundled_cases_load(name):
    case = load_case(name)
    assert case.name == name
    assert case.title and case.description and case.calibration
    assert len(case.sources) > 40


def test_xv15_in_si():
    case = load_case("xv15-uncoupled")
    rotor, operation = case.rotor, case.operation
    assert rotor.n_blades == 3
    assert rotor.radius == pytest.approx(12.5 * FT)
    assert rotor.blade_inertia == pytest.approx(105 * SLUG * FT**2)
    assert rotor.flap_stiffness == pytest.approx(81.8 * SLUG * FT**2 * 59.8**2)
    assert rotor.lag_stiffness == pytest.approx(70.4 * SLUG * FT**2 * 103**2)
    assert rotor.gimbal_stiffness == pytest.approx(12892 * FT * LBF, rel=1e-4)
    assert rotor.propeller_moment is True
    assert operation.rotor_speed == pytest.approx(458 * RPM)
    assert operation.trim == "windmill"
    assert case.warnings
    flap = case.sources["rotor.flap_frequency"]
    assert (flap.written, flap.si, flap.status) == ("59.8 rad/s", 59.8, "published")
    assert case.sources["rotor.flap_stiffness"].status == "derived"


def test_xv15_gimbal_frequency_is_the_published_one():
    rotor, operation = (case := load_case("xv15-uncoupled")).rotor, case.operation
    squared = 1 + rotor.gimbal_stiffness / (
        rotor.n_blades / 2 * rotor.blade_inertia * operation.rotor_speed**2
    )
    assert squared == pytest.approx(1.0355, abs=2e-4)


def test_xv15_support():
    support = load_case("xv15-uncoupled").support
    omega = np.array([0.42, 0.70, 1.30]) * 458 * RPM
    mass = np.array([59 * SLUG, 59 * SLUG, 1000 * SLUG * FT**2])
    slope, mast = 1.5 / (1.333 * 12.5 * FT), 0.342 * 12.5 * FT
    assert support.names == ("beam", "chord", "torsion")
    np.testing.assert_allclose(support.mass, np.diag(mass), rtol=1e-12)
    np.testing.assert_allclose(support.stiffness, np.diag(mass * omega**2), rtol=1e-12)
    np.testing.assert_allclose(
        support.damping, np.diag(2 * np.array([0.01, 0.02, 0.01]) * omega * mass), rtol=1e-12
    )
    hub = np.zeros((6, 3))
    hub[[0, 5], 0] = 1, -slope
    hub[[2, 3, 1], 1] = 1, slope, -mast * slope
    hub[[4, 0], 2] = 1, mast
    np.testing.assert_allclose(support.hub, hub, rtol=1e-4)  # the deck gives the slope to four digits
    assert support.includes_rotor


def test_the_mass_distribution_gives_the_published_integrals():
    rotor = load_case("xv15-mass-distribution").rotor
    unit = SLUG * FT
    assert rotor.blade_mass == pytest.approx(4.14375 * SLUG, rel=1e-9)  # trapezoids are exact
    assert rotor.blade_first_moment == pytest.approx(14.2 * unit, rel=5e-3)
    assert rotor.blade_inertia == pytest.approx(102.57 * unit * FT, rel=1e-4)
    assert rotor.flap_first_moment == pytest.approx(11.49 * unit, rel=1e-3)
    assert rotor.flap_inertia == pytest.approx(82.1 * unit * FT, rel=1e-3)
    assert rotor.lag_first_moment == pytest.approx(9.86 * unit, rel=1e-3)
    assert rotor.lag_inertia == pytest.approx(69.2 * unit * FT, rel=1e-3)
    assert rotor.flap_stiffness == pytest.approx(rotor.flap_inertia * 59.8**2)


def test_the_mass_distribution_alters_nothing_else():
    a, b = load_case("xv15-uncoupled").sources, load_case("xv15-mass-distribution").sources
    assert {field for field in a.keys() & b.keys() if a[field] != b[field]} == {
        "rotor.flap_stiffness",
        "rotor.lag_stiffness",
    }


def test_a_deck_has_the_fields_of_what_it_describes():
    def names(kind) -> set[str]:
        return {entry.name for entry in fields(kind)}

    instead = {
        "flap_frequency",
        "lag_frequency",
        "lock_number",
        "mass_distribution",
        "hub_mass",
        "mass_offset",
    }
    beside = {"frequencies"}  # of the case, as its drive train
    made = {"offset_mass"}  # of mass_offset
    assert set(RotorSection.model_fields) - instead - beside == names(Rotor) - made
    of_table = {"table", "table_name", "table_reynolds"}
    of_regions = names(AirfoilRegions) - {"airfoils"}
    assert set(AirfoilSection.model_fields) - of_table == names(Airfoil) | of_regions
    assert set(OperationSection.model_fields) - {"altitude", "temperature_offset"} == names(Operation)


def test_chord_from_lock_number(tmp_path):
    case = altered(tmp_path, "[rotor]\nlock_number = 3.83\n")
    assert case.rotor.chord == pytest.approx(1.2158 * FT, rel=1e-5)
    assert case.sources["rotor.chord"].status == "derived"
    with pytest.raises(InputError, match=r"rotor.lock_number = 3.83: needs a density above zero"):
        altered(tmp_path, '[rotor]\nlock_number = 3.83\n[operation]\ndensity = "0 kg/m**3"\n')


def test_an_airfoil_table(tmp_path):
    (tmp_path / "a.c81").write_text(as_c81("MADE UP", **made_up_tables()))
    text = '[rotor.airfoil]\ntable = { value = "a.c81", status = "assumed", source = "made up" }\n'
    case = altered(tmp_path, text)
    assert case.rotor.airfoil.name == "MADE UP"
    assert (case.sources["rotor.airfoil.table"].written, case.sources["rotor.airfoil.table"].status) == (
        "a.c81",
        "assumed",
    )
    assert case.rotor.airfoil.contains_compressibility
    assert case.linearize(100.0, compressibility=False).trim.converged
    with pytest.raises(InputError) as caught:
        altered(tmp_path, text + "[rotor]\nlock_number = 3.83\n")
    assert (
        str(caught.value)
        == "rotor.lock_number = 3.83: needs one lift_slope; with airfoil tables or regions give chord"
    )


@pytest.mark.parametrize(
    ("content", "rule"),
    [(None, "no such file"), ("not C81\n", "line 1: must have six counts of two digits in columns 31 to 42")],
)
def test_an_airfoil_table_that_cannot_be_used(tmp_path, content, rule):
    if content is not None:
        (tmp_path / "a.c81").write_text(content)
    with pytest.raises(InputError) as caught:
        altered(tmp_path, '[rotor.airfoil]\ntable = "a.c81"\n')
    assert str(caught.value) == f"rotor.airfoil.table = a.c81: {rule}"


def test_a_frequency_per_revolution(tmp_path):
    case = altered(tmp_path, '[rotor]\nlag_frequency = "2/rev"\n[operation]\nrotor_speed = "400 rpm"\n')
    assert case.rotor.lag_stiffness == pytest.approx(case.rotor.lag_inertia * (2 * 400 * RPM) ** 2)
    frequency = case.sources["rotor.lag_frequency"]
    assert (frequency.written, frequency.unit) == ("2/rev", "rad/s")
    assert frequency.si == pytest.approx(2 * 400 * RPM)


def test_distributions_along_the_blade(tmp_path):
    case = altered(
        tmp_path, '[rotor]\nchord = { r_over_R = [0.08, 0.25, 1], value = [17, 14, 14], unit = "in" }\n'
    )
    r, chord = case.rotor.chord
    np.testing.assert_allclose(r, np.array([0.08, 0.25, 1]) * 12.5 * FT)
    np.testing.assert_allclose(chord, np.array([17, 14, 14]) / 12 * FT)


def test_fixed_collective(tmp_path):
    case = altered(tmp_path, '[operation]\ntrim = { collective = "30 deg" }\n')
    assert case.operation.trim == {"collective": pytest.approx(np.pi / 6)}
    assert case.sources["operation.trim.collective"].written == "30 deg"


@pytest.mark.parametrize(
    ("text", "begins"),
    [
        ('[rotor]\nlag_hinge_offset = "0.5 ft"', "rotor.lag_hinge_offset = 0.5 ft: "),
        ('[rotor]\nroot_cutout = "13 ft"', "rotor.root_cutout = 13 ft: "),
    ],
)
def test_what_the_rotor_refuses_is_told_as_written(tmp_path, text, begins):
    with pytest.raises(InputError) as caught:
        altered(tmp_path, text)
    assert str(caught.value).startswith(begins)


@pytest.mark.parametrize(
    "text",
    [
        '[rotor]\nflap_inertia = "120 slug*ft**2"',  # more than the blade has about the centre
        '[rotor]\nlag_hinge_offset = "13 ft"',
        '[rotor]\nblade_mass = "0.1 slug"',
    ],
)
def test_a_blade_that_cannot_be_is_refused_in_one_line(tmp_path, text):
    with pytest.raises(InputError) as caught:
        altered(tmp_path, text)
    assert str(caught.value).startswith("rotor.")
    assert "\n" not in str(caught.value)


def test_a_case_and_its_error_can_be_sent_to_another_process(tmp_path):
    case = pickle.loads(pickle.dumps(load_case("xv15-uncoupled")))
    assert case.sources == load_case("xv15-uncoupled").sources
    error = pickle.loads(
        pickle.dumps(InputError("a.b", 3, "must be more", [InputError("c", None, "is missing")]))
    )
    assert str(error) == "a.b = 3: must be more\nc: is missing"


GOOD = dict(
    names=["up", "twist"],
    mass=[[2.0, 0.1], [0.1, 1.0]],
    damping=np.zeros((2, 2)),
    stiffness=np.eye(2),
    hub=np.ones((6, 2)),
    includes_rotor=False,
)


def test_normal_modes_may_be_coupled():
    support = NormalModes(**GOOD)
    assert support.mass.shape == (2, 2)
    assert support.hub.shape == (6, 2)
    with pytest.raises(ValueError, match="read-only"):
        support.mass[0, 0] = 3


@pytest.mark.parametrize(
    ("field", "value", "rule"),
    [
        ("names", ["up", "up"], "must name each mode, all differently"),
        ("names", [], "must name each mode"),
        ("mass", np.eye(3), r"must have the shape \(2, 2\)"),
        ("hub", np.ones((2, 6)), r"must have the shape \(6, 2\)"),
        ("stiffness", [[1.0, 0.2], [0.1, 1.0]], "must be symmetric"),
        ("damping", [[np.nan, 0.0], [0.0, 1.0]], "must be finite"),
        ("mass", [[1.0, 2.0], [2.0, 1.0]], "must not be negative"),
        ("mass", [[-1.0, 0.0], [0.0, 1.0]], "must not be negative"),
        ("mass", [[0.0, 0.1], [0.1, 1.0]], "must not be negative"),
    ],
)
def test_normal_modes_that_cannot_be(field, value, rule):
    with pytest.raises(InputError, match=f"^{field} = .*: {rule}"):
        NormalModes(**GOOD | {field: value})
