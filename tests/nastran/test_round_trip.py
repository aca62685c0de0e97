"""The same modes by number in a deck and in each kind of file have the same flutter boundary."""

import numpy as np
import pytest

import proprotor as pp
from tests.nastran.written import HUB, Op2, run_of, save_hdf5, save_printed, save_punch

UNITS = {"SI": (1.0, 1.0), "inches": (0.0254, 4.4482216152605 / 0.0254)}
DOUBLE, SINGLE, SEVEN_DIGITS = 1e-9, 1.2e-7, 1e-6  # of the boundary: the digits of the numbers in the files


def op2(path, run, width, order="<"):
    return Op2(width=width, order=order).lama(run).vectors(run).save(path)


KINDS = {
    "op2, 8 bytes": ("a.op2", lambda path, run: op2(path, run, 8), "", DOUBLE),
    "op2, 8 bytes, other order": ("a.op2", lambda path, run: op2(path, run, 8, ">"), "", DOUBLE),
    "op2, 4 bytes": ("a.op2", lambda path, run: op2(path, run, 4), "", SINGLE),
    "op2 without LAMA": (
        "a.op2",
        lambda path, run: Op2(width=8).vectors(run).save(path),
        "generalized_mass = 1\n",
        DOUBLE,
    ),
    "op2 by grid points": (
        "a.op2",
        lambda path, run: Op2(width=8).lama(run).vectors_by_point(run).save(path),
        "",
        DOUBLE,
    ),
    "h5": ("a.h5", lambda path, run: save_hdf5(path, [run]), "", DOUBLE),
    "pch": ("a.pch", lambda path, run: save_punch(path, [run]), "generalized_mass = 1\n", SEVEN_DIGITS),
    "f06": ("a.f06", lambda path, run: save_printed(path, [run]), "", SEVEN_DIGITS),
}


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


@pytest.fixture(scope="module")
def boundary(case):
    """Flutter speed and frequency of the modes typed by number; the ending of the search is the same for all."""
    return flutter(case)


def flutter(case):
    found = case.flutter_point("320:380:5kt", section_damping=False)
    return np.array([found.speed, *(one.position for one in found.boundaries)])


@pytest.mark.parametrize("unit", UNITS)
@pytest.mark.parametrize("kind", KINDS)
def test_a_deck_of_the_file_has_the_boundary_of_the_modes(tmp_path, case, boundary, kind, unit):
    name, write, more, rtol = KINDS[kind]
    length, mass = UNITS[unit]
    support = case.support
    write(tmp_path / name, run_of(support.mass, support.stiffness, support.hub, length, mass))
    ratio = np.diag(support.damping) / (2 * np.sqrt(np.diag(support.mass) * np.diag(support.stiffness)))
    text = 'base = "xv15-uncoupled"\n[case]\nname = "a"\ntitle = "a"\n[support]\nkind = "nastran"\n'
    text += f'file = "{name}"\n{more}'
    text += f'grid = {HUB}\nnames = ["beam", "chord", "torsion"]\nincludes_rotor = "gimballed"\n'
    text += f"damping_ratio = {{ value = {ratio.tolist()} }}\n"
    text += f'length_unit = "{length} m"\nmass_unit = "{mass!r} kg"\n'
    (tmp_path / "deck.toml").write_text(text, encoding="utf-8")
    found = pp.load_case(tmp_path / "deck.toml")
    assert (found.support.names, found.support.includes_rotor) == (support.names, support.includes_rotor)
    np.testing.assert_allclose(flutter(found), boundary, rtol=rtol)
