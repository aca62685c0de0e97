"""A status and a source for all numbers of one file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

import proprotor as pp
from proprotor.deck.template import deck_text
from proprotor.errors import InputError
from proprotor.model.provenance import reservations

Write = Callable[..., pp.Case]

OWN = """
[case]
name = "own"
title = "Own"
default_status = "measured"
default_source = "report 12"

[rotor]
n_blades = 3
radius = "4 m"
root_cutout = "0.2 m"
flap_hinge_offset = "0.1 m"
lag_hinge_offset = "0.1 m"
precone = { value = "2 deg", source = "drawing 7" }
mass_distribution = { r_over_R = [0, 1], value = [8, 4], unit = "kg/m" }
flap_frequency = "0.5/rev"
lag_stiffness = "90000 N*m/rad"
flap_outboard_fraction = 0.5
lag_outboard_fraction = 0.5
gimbal_stiffness = "300 N*m/rad"
pitch_gimbal_coupling = { value = -0.2, status = "assumed" }
pitch_inertia = "0.4 kg*m**2"
control_stiffness = "9000 N*m/rad"
chord = { r_over_R = [0.05, 1], value = [0.3, 0.3], unit = "m" }
twist = "-40 deg"

[rotor.airfoil]
lift_slope = "5.7/rad"
drag = 0.01

[operation]
rotor_speed = "48 rad/s"
density = "1.2 kg/m**3"
speed_of_sound = "340 m/s"
trim = { collective = "30 deg" }

[support]
kind = "normal-modes"
includes_rotor = false

[[support.modes]]
name = "beam"
coordinate = "length"
frequency = "0.42/rev"
damping_ratio = 0.01
generalized_mass = "400 kg"
z = 1
"""


@pytest.fixture
def write(tmp_path: Path) -> Write:
    def written(text: str = OWN, name: str = "own.toml", **settings: str) -> pp.Case:
        (tmp_path / name).write_text(text)
        return pp.load_case(tmp_path / name, settings)

    return written


def test_every_number_of_a_file_has_the_default_unless_it_states_its_own(write: Write) -> None:
    given = write().given
    own = {path: (n.status, n.source) for path, n in given.items() if n.source != "report 12"}
    assert own == {"rotor.precone": ("measured", "drawing 7"), "rotor.pitch_gimbal_coupling": ("assumed", "")}
    rest = {n.status for path, n in given.items() if path not in own}
    assert rest == {"measured"}
    for path in (
        "rotor.n_blades",
        "rotor.mass_distribution",
        "rotor.airfoil.lift_slope",
        "operation.trim.collective",
        "support.includes_rotor",
        "support.modes[beam].frequency",
    ):
        assert path in given


def test_the_default_changes_no_value(write: Write) -> None:
    plain = OWN.replace('default_status = "measured"\ndefault_source = "report 12"\n', "")
    stated, unstated = write().given, write(plain, "plain.toml").given
    assert {p: (n.written, str(n.si), n.unit) for p, n in stated.items()} == {
        p: (n.written, str(n.si), n.unit) for p, n in unstated.items()
    }


def test_a_measured_number_is_no_reservation(write: Write) -> None:
    (sentence,) = reservations(write())
    assert "1 assumed, of" in sentence and "measured" not in sentence and "unstated" not in sentence


def test_a_default_belongs_to_its_own_file_not_to_the_base_or_a_variant(write: Write, tmp_path: Path) -> None:
    write()
    variant = 'base = "own.toml"\n[case]\nname = "v"\n[rotor]\nprecone = "1 deg"\n'
    given = write(variant, "variant.toml").given
    assert (given["rotor.precone"].status, given["rotor.radius"].status) == ("unstated", "measured")
    calibrated = variant.replace('name = "v"', 'name = "v"\ndefault_status = "calibrated"')
    given = write(calibrated, "calibrated.toml").given
    assert (given["rotor.precone"].status, given["rotor.radius"].status) == ("calibrated", "measured")
    assert write(**{"rotor.precone": "1 deg"}).given["rotor.precone"].status == "assumed"


def test_the_left_side_of_an_aircraft_has_the_default_of_its_file(write: Write) -> None:
    text = (
        'base = "xv15-aircraft"\n[case]\nname = "left"\ndefault_status = "measured"\n'
        '[left]\n"rotor.control_stiffness" = "8000 ft*lbf/rad"\n'
    )
    assert write(text, "left.toml").given["left.rotor.control_stiffness"].status == "measured"


def test_a_deck_written_from_one_with_a_default_keeps_every_status(write: Write, tmp_path: Path) -> None:
    write()
    copy = deck_text(pp.deck.read_tables(tmp_path / "own.toml"), tmp_path / "copy.toml")
    assert write(copy, "copy.toml").given == write().given


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ('default_status = "guessed"', "case.default_status = guessed: must be one of published, measured"),
        ('default_source = "report"', "case.default_source = report: must be given with default_status"),
        ('default_status = "measured"\ndefault_source = 3', "case.default_source = 3: must be text"),
        ("default_status = [1]", "case.default_status = [1]: must be one of published, measured"),
    ],
)
def test_a_default_that_is_none_is_refused(write: Write, lines: str, message: str) -> None:
    with pytest.raises(InputError) as error:
        write(f'base = "xv15"\n[case]\nname = "bad"\n{lines}\n', "bad.toml")
    assert message in str(error.value)


def test_a_default_cannot_be_set_for_a_run(write: Write) -> None:
    with pytest.raises(InputError, match="must stand in the file of a deck"):
        write(**{"case.default_status": "measured"})
