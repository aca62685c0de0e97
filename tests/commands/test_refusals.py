"""Mistakes that no other test makes: each is told by field, value and rule, in one message."""

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from click.testing import CliRunner

import proprotor as pp
from proprotor import InputError, sampling
from proprotor.case import Case
from proprotor.commands.main import main
from proprotor.deck.settings import with_settings
from proprotor.exchange.netcdf import save_results
from proprotor.files.output import write_whole
from proprotor.model.several_rotors import MountedRotor, mount_rotors
from proprotor.rotor.blade_frequencies import BladeFrequencies
from proprotor.rotor.motions import HUB
from proprotor.stability import flutter
from proprotor.stability.parameter_lines import ParameterLine
from proprotor.stability.sweep import sweep
from proprotor.study.uncertainty import share_below
from proprotor.support.modal_reduction import lowest_modes

CASE = pp.load_case("xv15-uncoupled")
PRECONE = "rotor.precone"
NOTHING = ("design", [np.nan, np.nan])
FLUTTER = xr.Dataset(
    dict.fromkeys(("flutter_speed", "flutter_speed_above", "flutter_speed_below"), NOTHING)
    | {"flutter_note": ("design", ["no trim", "no trim"])},
    attrs={"sample": "{}"},
)


def told(call, *parts: str) -> None:
    """One message with these parts, in this order."""
    with pytest.raises(InputError) as error:
        call()
    message, start = str(error.value), 0
    assert "\n" not in message
    for part in parts:
        assert part in message[start:], (part, message)
        start = message.index(part, start) + len(part)


# Samples ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("size", [0, -4, 2.0, True])
def test_the_size_of_a_sample_is_a_whole_number_above_zero(size):
    rule = "must be a whole number above zero"
    told(lambda: sampling.latin_hypercube({PRECONE: (0, 1)}, size), "size", str(size).lower(), rule)


@pytest.mark.parametrize("seed", [-1, 1.5, False])
def test_the_seed_of_a_sample_is_a_whole_number(seed):
    rule = "must be a whole number, not negative"
    told(lambda: sampling.latin_hypercube({PRECONE: (0, 1)}, 4, seed), "seed", str(seed).lower(), rule)


def test_a_sample_has_an_input():
    told(lambda: sampling.sobol({}, 4), "inputs", "must have at least one input to sample")


def test_a_grid_that_no_machine_holds_is_refused_before_it_is_laid_out():
    plan = sampling.grid(
        {PRECONE: np.linspace(0, 0.1, 10**5), "operation.density": np.linspace(1, 1.2, 10**5)}
    )
    told(lambda: plan.resolve(pp.design_inputs(CASE)), "inputs", "1e+10 designs", "must be at most")


def test_a_share_of_what_is_no_number_of_the_deck():
    plan = sampling.latin_hypercube({"airspeed": sampling.Relative(0.9, 1.1)}, 4)
    told(lambda: plan.resolve(pp.design_inputs(CASE)), "airspeed", "must be given in absolute terms")


# Designs and lines --------------------------------------------------------------------------------


def test_a_number_of_a_deck_is_varied_by_numbers():
    told(lambda: CASE.vary({PRECONE: [object()]}), PRECONE, "must be")
    told(lambda: CASE.vary({PRECONE: np.array([True, False])}), PRECONE, "must be a number")


def test_a_case_without_a_deck_has_no_numbers_to_vary():
    made = Case(**{name: getattr(CASE, name) for name in ("name", "rotor", "operation", "support")})
    told(lambda: made.vary({PRECONE: 0.02}), "case", "xv15-uncoupled", "must be made from a deck")


def test_modes_are_followed_along_a_list_of_speeds():
    model = CASE.linearize(np.array([[100.0, 110.0], [120.0, 130.0]]))
    told(lambda: sweep(model), "airspeed", "array of shape (2, 2)", "must be a list of speeds")


def test_a_boundary_in_an_input_has_one_airspeed():
    told(lambda: flutter.boundaries(CASE, vary={PRECONE: [0.02, 0.03]}), "airspeeds", "must be one airspeed")


def test_boundaries_of_many_designs_are_not_one_line():
    many = CASE.vary({PRECONE: [0.02, 0.03]})
    told(lambda: flutter.boundaries(many, [100.0, 120.0]), "case", "xv15-uncoupled", "must be one design")


def test_a_line_that_came_without_its_models_has_none():
    told(
        lambda: ParameterLine(np.array([100.0])).models(np.array([101.0])),
        "line",
        "airspeed",
        "must come with a function",
    )


def test_motions_without_a_sum_need_one_number_of_blades():
    rotor = replace(CASE.rotor, n_blades=np.array([4, 5]))
    rule = "must be one number with reactionless=True"
    told(lambda: replace(CASE, rotor=rotor).linearize([100.0, 110.0], reactionless=True), "n_blades", rule)


def test_a_frequency_that_a_function_gives_is_above_zero():
    table = BladeFrequencies(
        at_rotor_speed=CASE.operation.rotor_speed,
        against="airspeed",
        at=[0, 200],
        flap=lambda speed: 1.5 - speed / 100,
        lag=1.5,
    )
    rule = "must be above zero wherever a function gives them"
    told(
        lambda: CASE.linearize([100.0, 180.0], structure="tabulated", frequencies=table),
        "frequencies",
        "-0.3",
        rule,
    )


def test_options_of_a_study_hold_no_arrays():
    train = pp.DriveTrain(drive_inertia=np.array([[20.0], [30.0]]), drive_damping=0.0, shaft_stiffness=4e4)
    told(
        lambda: pp.study(CASE, {PRECONE: [0.02, 0.03]}, [100.0, 110.0], drive_train=train),
        "options",
        "drive_train",
        "must not hold arrays",
    )


# Supports -----------------------------------------------------------------------------------------


def support(**changed):
    given = {
        "names": ("a", "b"),
        "generalized_mass": [1.0, 2.0],
        "frequency": [10.0, 20.0],
        "damping_ratio": [0.01, 0.01],
        "hub": np.eye(6)[:, :2],
        "includes_rotor": True,
    }
    return pp.NormalModes.from_frequencies(**given | changed)


def test_a_frequency_of_a_support_is_not_negative():
    told(lambda: support(frequency=[10.0, -20.0]), "frequency", "-20", "must not be negative")


def test_a_support_and_its_rotors_have_coordinates_of_their_own():
    model = pp.rotor_model(CASE.rotor, CASE.operation, 100.0)
    own = model.dofs[len(HUB)]
    rotor = MountedRotor(model, np.eye(6)[:, :2])
    rule = "must differ from the rotors' coordinates"
    told(
        lambda: mount_rotors({"left": rotor}, support(names=("a", f"left {own}"))),
        "support.names",
        f"left {own}",
        rule,
    )


def test_a_stiffness_that_does_not_hold_the_structure():
    told(lambda: lowest_modes(np.eye(3), -np.eye(3)), "stiffness", "must not be negative in any direction")


def test_a_mass_that_is_negative_somewhere():
    told(
        lambda: lowest_modes(np.diag([1.0, -1.0]), np.eye(2)), "mass", "must not be negative in any direction"
    )


# Settings and results -----------------------------------------------------------------------------


def test_a_field_is_not_set_twice():
    twice = {"operation.trim": "{ thrust_coefficient = 1 }", " operation.trim": "{ thrust_coefficient = 2 }"}
    told(lambda: with_settings({}, twice), "operation.trim", "must not be set twice")


def test_a_complex_coordinate_cannot_be_stored(tmp_path):
    results = xr.Dataset(coords={"root": ("x", [1j, 2j])})
    told(
        lambda: save_results(results, tmp_path / "a.nc"),
        "root",
        "cannot be stored: it is a complex coordinate",
    )
    assert not list(tmp_path.iterdir())


def test_a_name_that_a_complex_part_needs_is_free(tmp_path):
    taken = xr.Dataset({"root": ("x", [1j]), "root_real": ("x", [1.0]), "root.real": ("x", [1.0])})
    told(
        lambda: save_results(taken, tmp_path / "a.nc"),
        "real",
        "has the name that a part of root is stored under",
    )
    assert not list(tmp_path.iterdir())


def test_a_share_of_designs_without_a_value_is_none():
    told(lambda: share_below(FLUTTER, 100.0), "flutter_speed", "has no value for any design")


def test_a_folder_is_no_file_to_write(tmp_path):
    told(lambda: write_whole(tmp_path, lambda file: None), "output", str(tmp_path)[-30:], "must be a file")


# Commands -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "parts"),
    [
        (("describe", "--schema", "--json"), ("--schema", "must not be given with --markdown or --json")),
        (
            ("describe", "rotor.precone", "--schema"),
            ("FIELD = rotor.precone", "goes with the table or --json"),
        ),
        (("new", "own.toml", "--from", "own.toml", "--variant", "--force"), ("FILE", "must not be the deck")),
    ],
)
def test_what_does_not_go_together_on_a_command_line(tmp_path, monkeypatch, arguments, parts):
    monkeypatch.chdir(tmp_path)
    own, text = Path("own.toml"), 'base = "xv15-uncoupled"\n[case]\nname = "own"\n'
    own.write_text(text, encoding="utf-8")
    done = CliRunner().invoke(main, arguments)
    assert done.exit_code == 2 and not done.stdout
    start = 0
    for part in parts:
        assert part in done.stderr[start:], done.stderr
        start = done.stderr.index(part, start)
    assert own.read_text(encoding="utf-8") == text and os.listdir() == ["own.toml"]
