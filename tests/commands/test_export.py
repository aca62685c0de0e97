"""The command export: the files that the functions write."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.io import loadmat

import proprotor as pp
from proprotor.commands.main import main

POINTS = ("--grid", "4001", "--first-extra-point", "9001")
INCHES = ("--length-unit", "1 in", "--mass-unit", "1 lbf*s**2/in")


@pytest.fixture(autouse=True)
def empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def run(*arguments, speed="200 kt"):
    return CliRunner().invoke(main, ["export", "xv15-uncoupled", *arguments, "--speed", speed])


def test_direct_matrix_input_is_that_of_the_function():
    assert run("rotor.bdf", *POINTS, *INCHES, "--pitch", "rigid").exit_code == 0
    model = pp.load_case("xv15-uncoupled").linearize("200 kt", pitch="rigid", section_damping=True)
    units = dict(length_unit=0.0254, mass_unit=4.4482216152605 / 0.0254)
    pp.save_dmig(model, "expected.bdf", grid=4001, first_extra_point=9001, **units)
    assert Path("rotor.bdf").read_text(encoding="utf-8") == Path("expected.bdf").read_text(encoding="utf-8")


def test_a_file_of_matlab_has_the_model():
    assert run("a.mat").exit_code == 0
    expected = pp.load_case("xv15-uncoupled").linearize("200 kt")
    np.testing.assert_allclose(loadmat("a.mat")["K"], expected.K, rtol=1e-13)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("a.txt",), "FILE = a.txt: must end in .bdf, for Nastran, or in .mat, for MATLAB"),
        (("a.bdf",), "--grid: must be given with a .bdf file"),
        (("a.bdf", "--grid", "1"), "--first-extra-point: must be given with a .bdf file"),
        (("a.mat", "--grid", "1"), "--grid = 1: goes with a .bdf file"),
        (("a.bdf", *POINTS, "--mass-unit", "1 m"), "--mass-unit = 1 m: must be a mass"),
        (("a.bdf", "--grid", "0", "--first-extra-point", "1"), "grid = 0: must be a number of a point"),
        (("none/a.bdf", *POINTS), "FILE = none/a.bdf"),
    ],
)
def test_what_cannot_be_written_is_one_message(arguments, message):
    result = run(*arguments)
    assert result.exit_code != 0 and isinstance(result.exception, SystemExit)
    assert message in result.stderr and len(result.stderr.strip().splitlines()) == 1
    assert not list(Path().iterdir())


@pytest.mark.parametrize("arguments", [("a.bdf", *POINTS), ("a.mat",), ("a.mat", "--json")])
def test_an_airspeed_that_cannot_be_analysed_leaves_no_file(arguments):
    """A file of matrices without a number looks like a result."""
    result = run(*arguments, speed="3700 kt")
    assert result.exit_code == 2 and not result.stdout
    assert result.stderr.startswith("Error: --speed = 3700 kt: tip Mach number")
    assert not list(Path().iterdir())


@pytest.mark.parametrize("name", ["rotor.bdf", "rotor.BDF", "wing.mat", "wing.MAT"])
def test_the_coordinates_told_are_those_in_the_file(name):
    told = json.loads(run(name, *(POINTS if name.startswith("rotor") else ()), "--json").stdout)[
        "coordinates"
    ]
    if name.startswith("rotor"):
        lines = re.findall(r"^\$ \d+(?: -?[TR]\d)?: (\w+)", Path(name).read_text(encoding="ascii"), re.M)
        assert told == lines
    else:
        assert told == [str(cell[0][0]) for cell in loadmat(name, appendmat=False)["dofs"]]
