"""Units of a structure from a file that its deck does not tell, by what its masses amount to beside the rotor."""

import numpy as np
import pytest

import proprotor as pp
from proprotor.model.mass_at_rest import mass_at_rest
from proprotor.model.rotor_share import without_rotors
from proprotor.model.unit_doubts import unit_warnings
from proprotor.support.matrix_files import support_from_matrices
from proprotor.support.normal_modes import HUB_AXES
from tests.nastran.written import HUB, Op2, run_of

UNITS = {  # m and kg of a run
    "SI": (1.0, 1.0),
    "inches and lbf s²/in": (0.0254, 4.4482216152605 / 0.0254),
    "millimetres and tonnes": (1e-3, 1e3),
    "millimetres and kg": (1e-3, 1.0),
    "inches and lb": (0.0254, 0.45359237),
}


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15")


@pytest.fixture(scope="module")
def bare(case):
    """Mass of the wing without its rotor."""
    return without_rotors(case.support, [(case.support.hub, mass_at_rest(case.rotor))])[0]


def unit_warnings_of(tmp_path, case, bare, unit, told):
    """Warnings of the deck of the wing's modes without rotor, from a run in units that the deck tells or not."""
    length, mass = UNITS[unit]
    run = run_of(bare, case.support.stiffness, case.support.hub, length, mass)
    Op2(width=8).lama(run).vectors(run).save(tmp_path / "wing.op2")
    text = 'base = "xv15"\n[case]\nname = "a"\ntitle = "a"\n[support]\nkind = "nastran"\nfile = "wing.op2"\n'
    text += f"grid = {HUB}\nincludes_rotor = false\n"
    text += f'length_unit = "{length} m"\nmass_unit = "{mass} kg"\n' if told else ""
    (tmp_path / "deck.toml").write_text(text, encoding="utf-8")
    return [text for text in pp.load_case(tmp_path / "deck.toml").warnings if "units" in text]


@pytest.mark.parametrize("unit", UNITS)
def test_units_that_are_told_raise_no_doubt(tmp_path, case, bare, unit):
    assert not unit_warnings_of(tmp_path, case, bare, unit, told=True)


@pytest.mark.parametrize(
    ("unit", "doubts"),
    [
        ("SI", []),
        ("inches and lbf s²/in", ["the hub feels a mass of", "the hub moves"]),
        ("millimetres and tonnes", ["the hub feels a mass of", "the hub moves"]),
        ("millimetres and kg", ["the hub moves"]),
        ("inches and lb", ["the hub moves"]),
    ],
)
def test_units_that_are_not_told_are_doubted(tmp_path, case, bare, unit, doubts):
    found = unit_warnings_of(tmp_path, case, bare, unit, told=False)
    assert len(found) == len(doubts)
    for warning, doubt in zip(found, doubts, strict=True):
        assert warning.startswith(f"The units of the support's file are doubtful: {doubt}")
        assert warning.endswith("Check length_unit and mass_unit.")


def test_the_mass_and_the_length_are_those_of_a_pivot(case):
    """A shaft that pitches about a point 2 m behind the hub with 400 kg m²: the hub feels 100 kg, and moves 2 m/rad."""
    at_rest = np.diag([50.0] * 3 + [5000.0] * 3)
    pivot = pp.two_axis_pivot(2.0, (400.0, 400.0), (1e6, 1e6), includes_rotor=False)
    assert unit_warnings(pivot, at_rest) == ()
    light = pp.two_axis_pivot(2.0, (0.4, 0.4), (1e6, 1e6), includes_rotor=False)
    (warning,) = unit_warnings(light, at_rest)
    assert (
        "a mass of 0.1 kg of the structure, beside a rotor of 50 kg with a radius of gyration of 10 m"
        in warning
    )
    (warning,) = unit_warnings(
        pp.two_axis_pivot(200.0, (4e6, 4e6), (1e6, 1e6), includes_rotor=False), at_rest
    )
    assert "the hub moves 200 m per radian" in warning


def test_a_light_node_at_the_hub_is_no_light_structure():
    """400 kg on a wing's spring, and 0.1 kg at the hub itself on a mast a thousand times as stiff."""
    names = [f"{part}_{axis}" for part in ("hub", "wing") for axis in HUB_AXES]
    soft, stiff, one = 1e6, 1e9, np.eye(6)
    stiffness = np.block([[stiff * one, -stiff * one], [-stiff * one, (stiff + soft) * one]])
    mass = np.diag([0.1] * 6 + [400.0] * 6)
    support = support_from_matrices(mass, stiffness, dofs=names)
    assert unit_warnings(support, np.diag([100.0] * 3 + [100.0] * 3)) == ()


@pytest.mark.parametrize("name", pp.list_cases())
def test_bundled_decks_are_within_the_bounds(name):
    case = pp.load_case(name)
    if case.support.names:
        assert unit_warnings(case.support, np.asarray(mass_at_rest(case.rotor))) == ()
