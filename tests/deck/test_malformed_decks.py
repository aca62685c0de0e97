"""Malformed decks of many kinds, through every command that takes a case.

Each is told in one message on the error stream with the field, the value as written and the rule; the exit code is 2,
nothing is printed, nothing is written. With ``-s`` the messages are printed as a table.
"""

import os
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest
from click.testing import CliRunner

from proprotor.commands.main import main

DECKS = Path(sys.modules["proprotor"].__file__).parent / "deck" / "decks"
XV15 = (DECKS / "xv15-uncoupled.toml").read_text(encoding="utf-8")
VARIANT = 'base = "xv15-uncoupled"\n[case]\nname = "my"\n'

# Arguments that make a command run and write files, beside the deck.
SPEED = ("--speed", "300 kt")
COMMANDS = {
    "cases": (),
    "export": ("a.mat", "--speed", "250 kt"),
    "sweep": (*SPEED, "--csv", "a.csv", "--plot", "a.png"),
    "flutter": ("--csv", "a.csv"),
    "margins": (*SPEED, "--csv", "a.csv", "--plot", "a.png"),
    "map": (
        "--x",
        "airspeed=200:300:50kt",
        "--y",
        "rotor.precone=1:3:1 deg",
        "--csv",
        "a.csv",
        "--plot",
        "a.png",
    ),
    "boundary": (
        "--against",
        "operation.rotor_speed=400:500:50 rpm",
        "--csv",
        "a.csv",
        "--plot",
        "a.png",
    ),
    "envelope": ("--csv", "a.csv", "--plot", "a.png"),
    "sensitivity": ("--csv", "a.csv", "--plot", "a.png"),
    "attribution": (*SPEED, "--csv", "a.csv", "--plot", "a.png"),
    "gust": (*SPEED, "--csv", "a.csv", "--plot", "a.png"),
    "calibrate": ("--to", "points.csv", "--input", "rotor.precone", "--out", "a.toml"),
    "mac": ("xv15", "--csv", "a.csv", "--plot", "a.png"),
    "study": ("--vary", "rotor.precone=1:3:1 deg", *SPEED, "--out", "a.nc", "--checkpoint", "kept"),
}


class Malformed(NamedTuple):
    text: str | bytes  # of the file deck.toml
    told: str  # what the message begins with
    rule: str = ""  # what it has further on


def variant(text: str) -> str:
    return f"{VARIANT}{text}\n"


def without(*lines: str) -> str:
    """The whole XV-15 without lines that begin so."""
    kept = [line for line in XV15.splitlines() if not line.startswith(lines)]
    assert len(kept) == len(XV15.splitlines()) - len(lines)
    return "\n".join(kept)


def instead(old: str, new: str) -> str:
    assert XV15.count(old) == 1, old
    return XV15.replace(old, new)


MALFORMED = {
    "empty": Malformed("", "case: is missing"),
    "not TOML": Malformed(
        '[case]\nname = "my\n', "deck = deck.toml: is not TOML: ", "(at line 2, column 11)"
    ),
    "a key twice": Malformed(
        variant('[rotor]\nradius = "12 ft"\nradius = "13 ft"'), "deck = deck.toml: is not TOML: "
    ),
    "another encoding": Malformed(
        VARIANT.encode("utf-16")[:-1], "deck = deck.toml: must be text in UTF-16-LE"
    ),
    "binary": Malformed(bytes(range(256)) * 8, "deck = deck.toml: must be text in UTF-8"),
    "a terminal sequence in the title": Malformed(
        VARIANT + 'title = "my \\u001b[2J\\u001b[31mFlutter speed 999 kt"\n',
        "case.title = my  [2J [31mFlutter speed 999 kt: must be printable text, without U+001B",
    ),
    "a line of its own in the title": Malformed(
        VARIANT + 'title = "my\\nFlutter speed 999 kt"\n',
        "case.title = my Flutter speed 999 kt: must be printable text",
    ),
    "text that turns round": Malformed(
        VARIANT + 'title = "my \\u202e999 kt"\n', "case.title = my  999 kt: must be printable text"
    ),
    "a terminal sequence in a source": Malformed(
        variant('[rotor]\nprecone = { value = "1 deg", status = "assumed", source = "x\\u009b2J" }'),
        "rotor.precone.source = x 2J: must be printable text",
    ),
    "a terminal sequence in a warning": Malformed(
        VARIANT + 'warnings = ["\\u0007"]\n', "case.warnings[0] =  : must be printable text"
    ),
    "a terminal sequence in the name of a file": Malformed(
        variant('[rotor]\nairfoil.table = "a\\u001b.c81"'),
        "rotor.airfoil.table = a .c81: must be printable text",
    ),
    "a terminal sequence in a unit": Malformed(
        variant('[rotor]\nradius = "3 ft\\u001b[2J"'), "rotor.radius = 3 ft [2J: "
    ),
    "a terminal sequence in a name of a field": Malformed(
        variant('[rotor]\n"a\\u001b[2J\\n" = 1'), "rotor.a [2J  = 1: unknown field"
    ),
    "a mode named like the rotor's": Malformed(
        variant(
            '[support]\nkind = "normal-modes"\nincludes_rotor = false\nmodes = [{ name = "coning", '
            'coordinate = "length", generalized_mass = "9 kg", frequency = "9 Hz", damping_ratio = 0, x = 1 }]'
        ),
        "support.names = coning: must not be the name that a motion of a rotor has",
    ),
    "too large": Malformed(b"#" * 1_000_001, "deck = deck.toml: must not be larger than 1000000 bytes"),
    "section missing": Malformed(XV15.partition("[support]")[0], "support: is missing"),
    "section unknown": Malformed(
        variant('[rotors]\nradius = "12 ft"'), "rotors = { … }: unknown field 'rotors'; did you mean rotor?"
    ),
    "section is a number": Malformed(
        'base = "xv15-uncoupled"\nrotor = 3\n[case]\nname = "my"\n', "rotor = 3: must be a table"
    ),
    "field missing": Malformed(without("radius ="), "rotor.radius: is missing"),
    "field misspelt": Malformed(
        variant('[rotor]\npre_cone = "1 deg"'),
        "rotor.pre_cone = 1 deg: unknown field 'pre_cone'; did you mean precone?",
    ),
    "unit missing": Malformed(
        variant("[rotor]\nradius = 3.81"), "rotor.radius = 3.81: needs a unit; it is a length", "12.5 ft"
    ),
    "unit of another dimension": Malformed(
        variant('[rotor]\ngimbal_stiffness = "2700 in*lb/deg"'),
        "rotor.gimbal_stiffness = 2700 in*lb/deg: must be a moment per angle",
        "lb is a mass, lbf a force",
    ),
    "unit unknown": Malformed(
        variant('[rotor]\nradius = "12.5 foott"'),
        "rotor.radius = 12.5 foott: has an unknown unit 'foott'; did you mean foot?",
    ),
    "number as text": Malformed(
        variant('[rotor]\nn_blades = "3"'), "rotor.n_blades = 3: must be a whole number"
    ),
    "number in words": Malformed(
        variant('[rotor]\nradius = "twelve feet"'), "rotor.radius = twelve feet: must be a number and a unit"
    ),
    "not a number": Malformed(
        variant("[rotor]\npitch_gimbal_coupling = nan"), "rotor.pitch_gimbal_coupling = nan: must be finite"
    ),
    "huge": Malformed(variant('[rotor]\nradius = "1e300 ft"'), "rotor.radius = 1e300 ft: must not be beyond"),
    "infinite": Malformed(
        variant('[operation]\nrotor_speed = "1e999 rpm"'), "operation.rotor_speed = 1e999 rpm: must be finite"
    ),
    "negative inertia": Malformed(
        variant('[rotor]\nblade_inertia = "-105 slug*ft**2"'),
        "rotor.blade_inertia = -105 slug*ft**2: must be positive",
    ),
    "two blades": Malformed(
        variant("[rotor]\nn_blades = 2"), "rotor.n_blades = 2: must be a whole number, at least 3"
    ),
    "hinges in the wrong order": Malformed(
        variant('[rotor]\nlag_hinge_offset = "0.5 ft"'),
        "rotor.lag_hinge_offset = 0.5 ft: must not lie inboard of the flap hinge",
    ),
    "cutout beyond the tip": Malformed(
        variant('[rotor]\nroot_cutout = "13 ft"'),
        "rotor.root_cutout = 13 ft: must lie inboard of the tip",
    ),
    "mass integrals of no blade": Malformed(
        variant('[rotor]\nblade_inertia = "20 slug*ft**2"'),
        "rotor.flap_inertia = 81.8 slug*ft**2: breaks I_βα² ≤ I_b I_β",
    ),
    "both of two alternatives": Malformed(
        instead("[rotor.twist]", "lock_number = 3.83\n[rotor.twist]"),
        "rotor.lock_number: must not be given twice over; give chord or lock_number",
    ),
    "status unknown": Malformed(
        variant('[rotor]\nradius = { value = "12.5 ft", status = "guessed" }'),
        "rotor.radius.status = guessed: must be one of published, measured, derived, recalled, calibrated, assumed",
    ),
    "columns of unequal length": Malformed(
        variant('[rotor]\nchord = { r_over_R = [0.1, 1], value = [1, 2, 3], unit = "ft" }'),
        "rotor.chord.value = 3 values: must have one value for each of the 2 r_over_R",
    ),
    "stations out of order": Malformed(
        variant('[rotor]\nchord = { r_over_R = [0.9, 0.1], value = [1, 2], unit = "ft" }'),
        "rotor.chord.r_over_R = 0.9, 0.1: must increase from station to station",
    ),
    "stations file without the column": Malformed(
        variant('[rotor]\nchord = { file = "stations.csv", column = "chord" }'),
        "rotor.chord.file = stations.csv: unknown column 'chord'",
    ),
    "airfoil file missing": Malformed(
        variant('[rotor.airfoil]\ntable = "nowhere.c81"'),
        "rotor.airfoil.table = nowhere.c81: no such file",
    ),
    "airfoil file malformed": Malformed(
        variant('[rotor.airfoil]\ntable = "wrong.c81"'), "rotor.airfoil.table = wrong.c81: "
    ),
    "two modes of one name": Malformed(
        instead('name = "chord" #', 'name = "beam" #'), "support.modes.name = beam: must not name two modes"
    ),
    "mode that moves nothing": Malformed(
        instead("x = { value = 1, status", "# ").replace("alpha_z = ", "# "),
        "support.modes[beam]: must move the hub; give one or more of x, y, z",
    ),
    "kind of support unknown": Malformed(
        variant('[support]\nkind = "beam"'), "support.kind = beam: must be 'normal-modes'"
    ),
    "trim unknown": Malformed(
        variant("[operation.trim]\nthrust = 0.01"),
        "operation.trim.thrust = 0.01: unknown trim 'thrust'; did you mean thrust_coefficient?",
    ),
    "altitude out of range": Malformed(
        variant('[operation]\naltitude = "50 km"'),
        "operation.altitude = 50 km: must lie between -610 and 32000 m",
    ),
    "base that does not exist": Malformed(
        'base = "xv51"\n', "deck = xv51: unknown deck 'xv51'; did you mean xv15?"
    ),
    "base that leads in a circle": Malformed(
        'base = "other.toml"\n', "base = other.toml: must not lead back to the deck itself"
    ),
    "base that is no text": Malformed("base = 15\n", "base = 15: must be the name or path of a deck"),
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty folder to work in, with the files that some of the decks name."""
    (tmp_path / "other.toml").write_text('base = "deck.toml"\n')
    (tmp_path / "stations.csv").write_text("r_over_R,twist (deg)\n0,1\n1,2\n")
    (tmp_path / "wrong.c81").write_text("no table\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def takes_a_case(name: str) -> bool:
    arguments = {p.name for p in main.commands[name].params if p.param_type_name == "argument"}
    return "case" in arguments or name == "cases"


def commands_of_a_case() -> list[str]:
    return [name for name in main.commands if takes_a_case(name)]


def refused(command: str, deck: str, folder: Path) -> str:
    """The one message by which a command refuses a deck."""
    before = {file: file.read_bytes() for file in folder.iterdir() if file.is_file()}
    result = CliRunner().invoke(main, [command, deck, *COMMANDS.get(command, ())])
    assert isinstance(result.exception, SystemExit), (command, result.exception)
    assert result.exit_code == 2, (command, result.output)
    assert result.stdout == ""
    assert "Traceback" not in result.stderr
    assert {file: file.read_bytes() for file in folder.iterdir() if file.is_file()} == before
    assert set(folder.iterdir()) == set(before)
    return result.stderr


def test_there_are_twenty_kinds_and_every_command_has_its_arguments():
    assert len(MALFORMED) >= 20
    assert len({case.told for case in MALFORMED.values()}) >= 20
    assert set(COMMANDS) <= set(commands_of_a_case())


@pytest.mark.parametrize("kind", MALFORMED)
def test_every_command_tells_a_malformed_deck_in_one_message(folder, kind):
    text, told, rule = MALFORMED[kind]
    (folder / "deck.toml").write_bytes(text if isinstance(text, bytes) else text.encode())
    for command in commands_of_a_case():
        message = refused(command, "deck.toml", folder)
        assert message.startswith(f"Error: {told}"), (command, message)
        assert rule in message
        # an empty deck misses four sections: a line each
        assert len(message.splitlines()) == (4 if kind == "empty" else 1), message
    print(f"\n{kind:<34} {message.strip()}", end="")


@pytest.mark.parametrize(
    ("deck", "told"),
    [
        ("folder.toml", "deck = folder.toml: must be a file, not a folder"),
        ("nowhere.toml", "deck = nowhere.toml: no such file"),
        ("xv51", "deck = xv51: unknown deck 'xv51'; did you mean xv15?"),
        ("", 'deck = "": '),
    ],
)
def test_every_command_tells_a_deck_that_is_no_file(folder, deck, told):
    (folder / "folder.toml").mkdir()
    for command in commands_of_a_case():
        result = CliRunner().invoke(main, [command, deck, *COMMANDS.get(command, ())])
        assert (result.exit_code, result.stdout) == (2, ""), command
        assert result.stderr.startswith(f"Error: {told}"), result.stderr
        assert len(result.stderr.splitlines()) == 1


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="who may read everything is refused nothing")
def test_a_deck_that_may_not_be_read(folder):
    (folder / "deck.toml").write_text(VARIANT)
    (folder / "deck.toml").chmod(0)
    assert refused("sweep", "deck.toml", folder).startswith("Error: deck = deck.toml: cannot be read (")


def test_the_installed_command_says_the_same(folder):
    (folder / "deck.toml").write_text(MALFORMED["negative inertia"].text)
    command = [sys.executable, "-c", "from proprotor.commands.main import main; main()"]
    done = subprocess.run(
        [*command, "sweep", "deck.toml", *COMMANDS["sweep"]], capture_output=True, text=True, cwd=folder
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"Error: {MALFORMED['negative inertia'].told}\n"
