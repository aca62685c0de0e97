"""What holds for every command: options, JSON, exit codes, help, completion, interrupts, pipes and outputs."""

import json
import os
import re
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

import click
import pytest
from click.testing import CliRunner, Result

import proprotor as pp
from proprotor.commands.arguments import EXIT_CODES
from proprotor.commands.main import main
from tests import extras

PROPROTOR = [sys.executable, "-c", "from proprotor.commands.main import main; main()"]
MAP = ("xv15-uncoupled", "--x", "airspeed=200:300:50kt", "--y", "rotor.precone=1:3:1 deg")
STUDY = ("xv15-uncoupled", "--vary", "rotor.precone=1:2:1 deg", "--speed", "200 kt", "--workers", "1")
ENVELOPE = (
    *("xv15-uncoupled", "--set", "envelope.dive_speed=150 keas", "--scan", "140:180:20keas"),
    *("--set", 'envelope.altitudes={ value = [0, 1], unit = "km" }'),
)
GIVEN_FILES = {"decay.csv", "points.csv"}
FAST = ("--pitch", "rigid", "--rotor-speed", "constant")
GUST = ("xv15-uncoupled", "--speed", "200 kt", "--output", "force_x")
MAC = ("xv15-uncoupled", "xv15")
CALIBRATE = ("xv15-uncoupled", "--to", "points.csv", "--input", "support.modes[beam].frequency")
# Of each command arguments that succeed, and some that fail with 2; with 1 where it can.
SUCCEED = {
    "cases": [(), ("xv15-uncoupled",), ("xv15-uncoupled", "--set", "rotor.precone=1 deg")],
    "new": [("new.toml",)],
    "describe": [("rotor.precone",), (), ("beam-wing",)],
    "sweep": [("xv15-uncoupled", "--speed", "0:200:200kt")],  # no airspeed at the first
    "flutter": [("xv15-uncoupled", "--speed", "160 kt", *FAST), ("xv15-uncoupled", "--scan", "100:110:5kt")],
    "map": [(*MAP, *FAST)],
    "envelope": [(*ENVELOPE, *FAST)],
    "sensitivity": [
        ("xv15-uncoupled", "--wrt", "rotor.precone"),
        ("xv15-uncoupled", "--of", "damping", "--speed", "300 kt", "--mode", "beam", *FAST),
    ],
    "attribution": [("xv15-uncoupled", "--speed", "300 kt", *FAST)],
    "study": [STUDY],
    "gust": [(*GUST, *FAST), (*GUST, "--gradient", "30:60:30 ft", *FAST)],
    "identify": [("decay.csv",), ("decay.csv", "--method", "moving-block", "--at", "200 keas")],
    "calibrate": [(*CALIBRATE, *FAST)],
    "mac": [MAC],
    "export": [
        ("xv15-uncoupled", "a.bdf", "--speed", "200 kt", "--grid", "1", "--first-extra-point", "11"),
        ("xv15-uncoupled", "a.mat", "--speed", "200 kt", *FAST),
    ],
}
FAIL = {
    "cases": (("xv16",), "did you mean xv15?"),
    "new": (("new.txt",), "FILE = new.txt: must end in .toml"),
    "describe": (("rotor.precon",), "did you mean rotor.precone?"),
    "sweep": (("xv15-uncoupled", "--speed", "50"), "--speed = 50: needs a unit"),
    "flutter": (("xv15-uncoupled", "--scan", "50:60"), "--scan = 50:60: must be a speed"),
    "map": (
        ("xv15-uncoupled", "--x", "airspeed=1:2:1kt", "--y", "rotor.precon=1:2:1 deg"),
        "did you mean rotor.precone?",
    ),
    "envelope": ((*ENVELOPE, "--only", "heavy"), "variants = heavy: unknown variant"),
    "sensitivity": (("xv15-uncoupled", "--wrt", "rotor.precon"), "rotor.precon: unknown input"),
    "attribution": (("xv15-uncoupled", "--speed", "300 kt", "--mode", "bean"), "did you mean beam?"),
    "study": (
        ("xv15-uncoupled", "--vary", "rotor.precone", "--speed", "200 kt"),
        "--vary = rotor.precone: must be",
    ),
    "gust": ((*GUST[:3], "--output", "force_u"), "unknown output 'force_u'"),
    "identify": (("decay.csv", "--channel", "b"), "channels = b: unknown channel"),
    "calibrate": ((*CALIBRATE[:3], "--input", "rotor.precon"), "did you mean rotor.precone?"),
    "mac": (("xv15-uncoupled", "xv16"), "did you mean xv15?"),
    "export": (("xv15-uncoupled", "a.txt", "--speed", "200 kt"), "FILE = a.txt: must end in .bdf"),
}
NOTHING_ANALYSED = {
    "sweep": ("xv15-uncoupled", "--speed", "0 kt"),
    "flutter": ("xv15-uncoupled", "--scan", "0:0.2:0.1kt"),
    "map": ("xv15-uncoupled", "--x", "airspeed=0:0.2:0.1kt", "--y", "rotor.precone=1:2:1 deg"),
    "study": ("xv15-uncoupled", "--vary", "rotor.precone=1 deg", "--speed", "0 kt", "--workers", "1"),
}
# Options that write, with arguments that reach them.
OUTPUTS = [
    ("sweep", ("xv15-uncoupled", "--speed", "200 kt"), "--csv", "x.csv"),
    ("sweep", ("xv15-uncoupled", "--speed", "200 kt"), "--plot", "x.png"),
    ("flutter", ("xv15-uncoupled",), "--csv", "x.csv"),
    ("map", MAP, "--csv", "x.csv"),
    ("map", MAP, "--plot", "x.pdf"),
    ("envelope", ENVELOPE, "--csv", "x.csv"),
    ("envelope", ENVELOPE, "--plot", "x.png"),
    ("sensitivity", ("xv15-uncoupled",), "--csv", "x.csv"),
    ("sensitivity", ("xv15-uncoupled",), "--plot", "x.svg"),
    ("attribution", ("xv15-uncoupled", "--speed", "200 kt"), "--csv", "x.csv"),
    ("attribution", ("xv15-uncoupled", "--speed", "200 kt"), "--plot", "x.png"),
    ("gust", GUST, "--csv", "x.csv"),
    ("gust", GUST, "--plot", "x.png"),
    ("mac", MAC, "--csv", "x.csv"),
    ("mac", MAC, "--plot", "x.png"),
    ("calibrate", CALIBRATE, "--csv", "x.csv"),
    ("calibrate", CALIBRATE, "--out", "x.toml"),
    ("study", STUDY, "--out", "x.nc"),
    ("study", STUDY, "--csv", "x.csv"),
    ("study", STUDY, "--save", "x.toml"),
]


def run(*arguments: str) -> Result:
    result = CliRunner().invoke(main, list(arguments), env={"COLUMNS": "120"})
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result


@pytest.fixture(autouse=True)
def empty_folder(tmp_path, monkeypatch):
    """A folder with nothing but a record and test points."""
    monkeypatch.chdir(tmp_path)
    for name, text in (("decay.csv", extras.DECAY), ("points.csv", extras.POINTS)):
        (tmp_path / name).write_text(text)
    return tmp_path


def options_of(command: click.Command) -> dict[str, click.Parameter]:
    return {p.opts[0]: p for p in command.params if isinstance(p, click.Option)}


# Options ------------------------------------------------------------------------------------------


def test_an_option_is_the_same_wherever_it_is():
    """Type, place-holder, and how often it may be given; an airspeed is one or a range, which its place-holder says."""
    found: dict[str, set] = {}
    for command in main.commands.values():
        for flag, option in options_of(command).items():
            kind = (type(option.type), option.multiple, option.is_flag, tuple(option.secondary_opts))
            metavar = "" if flag == "--speed" else option.metavar
            if flag not in ("--out", "--samples", "--size"):  # a file or a folder
                found.setdefault(flag, set()).add((*kind, metavar))
    assert {flag: kinds for flag, kinds in found.items() if len(kinds) > 1} == {}
    speeds = [options_of(c)["--speed"] for c in main.commands.values() if "--speed" in options_of(c)]
    assert {option.metavar for option in speeds} == {"SPEED", "RANGE"}


def test_what_analyses_a_case_takes_settings_and_options_of_the_model():
    for name, command in main.commands.items():
        if any(p.name == "case" for p in command.params):
            assert {"--set", "--equations", "--structure", "--locked"} <= set(options_of(command)), name


def test_every_option_says_what_it_is():
    for name, command in main.commands.items():
        for flag, option in options_of(command).items():
            assert option.help and option.help.endswith("."), (name, flag)


@pytest.mark.parametrize("command", SUCCEED)
def test_help_is_enough_to_begin_with(command):
    text = run(command, "--help").stdout
    assert "Examples:" in text and "Exit codes:" in text
    own = main.commands[command]
    told = own.help.partition("Examples:\n")[2].replace("\\\n", "")  # as a shell goes on after a backslash
    examples = [shlex.split(line.partition(" > ")[0]) for line in told.splitlines() if line.strip()]
    assert examples
    for program, name, *arguments in examples:
        assert (program, name) == ("proprotor", command)
        own.make_context(name, arguments)  # which takes every word of it


def test_every_command_is_examined_here():
    here = set(SUCCEED)
    assert here == set(FAIL)
    assert here <= set(main.commands)


# JSON and exit codes ------------------------------------------------------------------------------


def refuse(constant: str):
    raise AssertionError(constant)


@pytest.mark.parametrize("command", SUCCEED)
def test_json_is_strict_and_alone_on_standard_output(command):
    for arguments in SUCCEED[command]:
        result = run(command, *arguments, "--json")
        assert result.exit_code == 0, result.stderr
        assert json.loads(result.stdout, parse_constant=refuse)
        told = [line for line in result.stderr.splitlines() if not line.startswith("Wrote ")]
        assert told == []  # no progress where nobody looks


@pytest.mark.parametrize("command", SUCCEED)
def test_success_is_0_and_an_unusable_input_2(command):
    result = run(command, *SUCCEED[command][0])
    assert result.exit_code == 0
    assert result.stdout or result.stderr.startswith("Wrote ")
    arguments, told = FAIL[command]
    result = run(command, *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert told in result.stderr and result.stderr.startswith(("Error: ", "Usage: "))
    assert len(result.stderr.splitlines()) == 1


@pytest.mark.parametrize("command", NOTHING_ANALYSED)
def test_nothing_analysed_is_1(command):
    for more in ((), ("--json",)):
        result = run(command, *NOTHING_ANALYSED[command], *more)
        assert result.exit_code == 1 and result.stdout
        if more:
            json.loads(result.stdout, parse_constant=refuse)


def test_the_help_lists_the_exit_codes_there_are():
    assert re.findall(r"^  (\d+) ", EXIT_CODES, re.MULTILINE) == ["0", "1", "2", "130"]


# Outputs ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("command", "arguments", "option", "file"), OUTPUTS)
def test_an_output_that_cannot_be_written_is_told_before_the_analysis(
    monkeypatch, command, arguments, option, file
):
    def analysed(*_):
        raise AssertionError("analysed first")

    monkeypatch.setattr("proprotor.commands.arguments.load_case", analysed)
    result = run(command, *arguments, option, f"missing/{file}")
    assert (result.exit_code, result.stdout) == (1, "")
    assert (
        result.stderr == f"Error: {option} = missing/{file}: cannot be written (No such file or directory)\n"
    )
    Path(file).mkdir()
    result = run(command, *arguments, option, file)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == f"Error: {option} = {file}: must be a file\n"


@pytest.mark.parametrize(("command", "arguments", "option", "file"), OUTPUTS)
def test_a_file_named_minus_is_standard_output_or_refused(command, arguments, option, file):
    """Tables are printed, nothing else with them; what is no text, or has its kind from its ending, needs a file."""
    result = run(command, *arguments, option, "-")
    assert {entry.name for entry in Path().iterdir()} == GIVEN_FILES
    if option != "--csv":
        assert (result.exit_code, result.stdout) == (2, "") and " = -: must end in " in result.stderr
        return
    assert (result.exit_code, result.stderr) == (0, "")
    assert run(command, *arguments, "--csv", "x.csv").exit_code == 0
    assert result.stdout == Path("x.csv").read_text(encoding="utf-8")
    result = run(command, *arguments, "--csv", "-", "--json")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == "Error: --csv = -: goes without --json: both would be printed\n"


@pytest.mark.parametrize("name", ["my deck.toml", "Rotor-Blätter ψ.toml", 'it\'s "quoted".toml'])
def test_names_of_files_may_have_spaces_and_any_letters(name):
    Path(name).write_text('base = "xv15-uncoupled"\n[case]\nname = "my"\n', encoding="utf-8")
    out = Path(name).with_suffix(".csv")
    assert run("sweep", name, "--speed", "200 kt", "--csv", str(out), *FAST).exit_code == 0
    assert out.stat().st_size > 100
    assert run("new", f"new {name}", "--from", name, "--variant").exit_code == 0
    assert pp.load_case(f"new {name}").rotor.radius == pp.load_case("xv15-uncoupled").rotor.radius


def test_a_figure_needs_no_display(empty_folder):
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    done = subprocess.run(
        [*PROPROTOR, "sweep", "xv15-uncoupled", "--speed", "200:300:50kt", "--plot", "x.png"],
        capture_output=True,
        text=True,
        env=environment | {"MPLBACKEND": "TkAgg"},
    )
    assert (done.returncode, done.stderr) == (0, "Wrote x.png\n")
    assert (empty_folder / "x.png").stat().st_size > 10_000


# Streams and signals ------------------------------------------------------------------------------


def shell(script: str) -> subprocess.CompletedProcess:
    script = f'proprotor() {{ {shlex.join(PROPROTOR)} "$@"; }}\n{script}'
    return subprocess.run(["bash", "-c", script], capture_output=True, text=True)


@pytest.mark.parametrize(
    "arguments",
    ["describe", "describe --json", "sweep xv15-uncoupled --speed 100:300:5kt --json", "describe --markdown"],
)
def test_a_reader_that_leaves_early_is_told_nothing(arguments):
    done = shell(f"proprotor {arguments} | head -c 1")
    assert (len(done.stdout), done.stderr) == (1, "")


@pytest.mark.parametrize("arguments", ["cases", "cases --json", "sweep xv15-uncoupled --speed '200 kt'"])
def test_standard_output_that_takes_nothing(arguments):
    if Path("/dev/full").exists():
        done = shell(f"proprotor {arguments} > /dev/full")
        assert done.returncode == 1
        assert done.stderr == "Error: standard output: No space left on device\n"
    closed = shell(f"unset COLUMNS; proprotor {arguments} >&-")
    assert closed.returncode in (0, 1)
    assert "Traceback" not in closed.stderr


@pytest.mark.skipif(os.name == "nt", reason="signals as POSIX has them")
@pytest.mark.parametrize(
    "arguments",
    [
        (
            "map",
            "xv15-uncoupled",
            "--x",
            "airspeed=100:300:0.1kt",
            "--y",
            "rotor.precone=0:5:0.01 deg",
            "--csv",
            "x.csv",
        ),
        (
            "study",
            "xv15-uncoupled",
            "--vary",
            "rotor.precone=0:5:0.0001 deg",
            "--speed",
            "100:300:1kt",
            "--out",
            "x.nc",
        ),
    ],
)
def test_an_interrupt_ends_in_one_line_and_leaves_no_half_of_a_file(empty_folder, arguments):
    running = subprocess.Popen(
        [*PROPROTOR, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    time.sleep(6)  # well into the analysis
    assert running.poll() is None
    os.killpg(running.pid, signal.SIGINT)  # as a terminal does, to all of them
    out, err = running.communicate(timeout=60)
    assert running.returncode == 130, err
    assert err.strip() == "interrupted; no file was left half-written"
    assert out == ""
    assert not any(
        entry.suffix in (".tmp", ".nc") or entry.name == "x.csv" for entry in empty_folder.iterdir()
    )


# Completion ---------------------------------------------------------------------------------------


def completed(shell_name: str, words: str, incomplete: str = "") -> list[str]:
    """What a shell is offered for the next word."""
    count = len(shlex.split(words))
    asked = {
        "bash": {"COMP_WORDS": f"{words} {incomplete}", "COMP_CWORD": str(count)},
        "zsh": {"COMP_WORDS": f"{words} {incomplete}", "COMP_CWORD": str(count)},
        "fish": {"COMP_WORDS": f"{words} {incomplete}", "COMP_CWORD": incomplete},
    }[shell_name]
    result = CliRunner().invoke(
        main, [], env=asked | {"_PROPROTOR_COMPLETE": f"{shell_name}_complete"}, prog_name="proprotor"
    )
    lines = result.stdout.splitlines()
    if shell_name == "bash":
        return [line.partition(",")[2] for line in lines]
    if shell_name == "fish" and lines and not lines[0].startswith(("plain", "file", "dir")):
        return lines[1::3] if len(lines) % 3 == 0 else lines
    return [line.partition(",")[2] for line in lines] if shell_name == "fish" else lines[1::3]


@pytest.mark.parametrize("shell_name", ["bash", "zsh", "fish"])
@pytest.mark.parametrize(
    ("words", "incomplete", "offered"),
    [
        ("proprotor", "sw", "sweep"),
        ("proprotor sweep", "xv15-w", "xv15-wing"),
        ("proprotor cases", "wrats-7", "wrats-742-off"),
        ("proprotor new my.toml --from", "v22", "v22-fifth-scale"),
        ("proprotor sweep xv15-uncoupled --set", "rotor.prec", "rotor.precone="),
        ("proprotor sweep xv15-uncoupled --set", "support.modes", "support.modes[beam].frequency="),
        ("proprotor map xv15-uncoupled --x", "airs", "airspeed="),
        ("proprotor study xv15-uncoupled --vary", "rotor.control_st", "rotor.control_stiffness="),
        ("proprotor sensitivity xv15-uncoupled --wrt", "rotor.prec", "rotor.precone"),
        ("proprotor describe", "rotor.prec", "rotor.precone"),
        ("proprotor sweep xv15-uncoupled --pitch", "c", "coupling"),
        ("proprotor sweep xv15-uncoupled", "--all", "--all-modes"),
    ],
)
def test_the_shell_completes(shell_name, words, incomplete, offered):
    found = [text.split("\t")[0] for text in completed(shell_name, words, incomplete)]
    assert offered in found
    assert all(text.startswith(incomplete) for text in found)


@pytest.mark.parametrize("shell_name", ["bash", "zsh", "fish"])
def test_the_shell_is_given_a_script(shell_name):
    result = CliRunner().invoke(
        main, [], env={"_PROPROTOR_COMPLETE": f"{shell_name}_source"}, prog_name="proprotor"
    )
    if shell_name == "bash" and result.exit_code:  # click asks the bash that is installed for its version
        pytest.skip("no bash that completes")
    assert "_PROPROTOR_COMPLETE" in result.stdout
