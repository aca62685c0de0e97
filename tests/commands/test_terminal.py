"""What people see in a terminal: lines that fit, a sign of life in every step, the answer last, pipes all alike."""

import fcntl
import os
import pty
import struct
import subprocess
import sys
import termios
import threading
from pathlib import Path

import pytest
from click.testing import CliRunner

from proprotor.commands import waiting
from proprotor.commands.main import main
from proprotor.model.configuration import Configuration
from tests import extras

PROPROTOR = [sys.executable, "-c", "from proprotor.commands.main import main; main()"]
# Of each command arguments whose output is as wide as it may be.
LINES = {
    "cases": ("xv15-aircraft",),
    "new": ("new.toml",),
    "describe": ("xv15-aircraft",),
    "sweep": ("xv15-aircraft", "--speed", "300:700:200kt", "--all-modes"),
    "flutter": ("xv15-aircraft", "--scan", "350:400:25kt"),
    "boundary": ("xv15-aircraft", "--against", "altitude=0:1:1km", "--scan", "350:450:25kt"),
    "envelope": extras.PLAIN["envelope"],
    "margins": ("closed.toml", "--speed", "100:200:50kt"),
    "map": ("xv15-uncoupled", "--x", "airspeed=200:300:50kt", "--y", "rotor.precone=1:3:1 deg"),
    "sensitivity": ("xv15-aircraft", "--scan", "350:400:25kt", "--top", "0"),
    "blade": extras.PLAIN["blade"],
    "attribution": ("xv15-aircraft", "--speed", "380 kt"),
    "gust": ("xv15", "--speed", "200 kt"),
    "identify": ("decay.csv",),
    "calibrate": ("xv15-uncoupled", "--to", "points.csv", "--input", "support.modes[beam].frequency"),
    "mac": ("xv15-uncoupled", "xv15"),
    "report": ("xv15-uncoupled", "--speed", "340:400:30kt", "--out", "a.html"),
    "explore": ("--help",),
    "study": ("xv15", "--vary", "rotor.precone=1:2:1 deg", "--speed", "300:400:50kt", "--flutter"),
    "export": ("xv15-uncoupled", "a.mat", "--speed", "200 kt"),
}


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """A folder with the files that commands read."""
    monkeypatch.chdir(tmp_path)
    texts = {
        "stations.csv": extras.STATIONS,
        "decay.csv": extras.DECAY,
        "points.csv": extras.POINTS,
        "closed.toml": extras.CLOSED,
    }
    for name, text in texts.items():
        Path(name).write_text(text, encoding="utf-8")


def run(command, width="80", **env):
    Path("new.toml").unlink(missing_ok=True)
    done = CliRunner().invoke(main, [command, *LINES[command]], env={"COLUMNS": width, **env})
    assert done.exit_code == 0, (done.output, done.exception)
    return done


def on_a_terminal(columns, *words, piped):
    """What a command prints where all three streams are a terminal, or where its output alone is a pipe."""
    own, other = pty.openpty()
    fcntl.ioctl(other, termios.TIOCSWINSZ, struct.pack("HHHH", 50, columns, 0, 0))
    env = {name: value for name, value in os.environ.items() if name not in ("COLUMNS", "LINES")}
    output = subprocess.PIPE if piped else other
    done = subprocess.Popen([*PROPROTOR, *words], stdin=other, stdout=output, stderr=other, env=env)
    os.close(other)
    told = b""
    if done.stdout is not None:
        told = done.stdout.read()
        done.stdout.close()
    else:
        try:
            while part := os.read(own, 1 << 16):
                told += part
        except OSError:  # the other side is closed
            pass
    os.close(own)
    assert done.wait() == 0
    return told.decode()


def test_every_command_is_here():
    assert set(LINES) == set(main.commands)


@pytest.mark.parametrize("width", [80, 100, 200])
@pytest.mark.parametrize("command", [name for name in LINES if name != "explore"])
def test_every_line_fits_the_terminal(command, width):
    lines = run(command, str(width)).stdout.splitlines()
    assert [line for line in lines if len(line) > width] == []


@pytest.mark.parametrize("command", [name for name in LINES if name != "explore"])
def test_nothing_is_analysed_in_silence(command, monkeypatch):
    """Every analysis is within a step that a spinner announces, and so is the import of the command."""
    told, silent = [], []

    class Recorder(waiting._Spinner):
        def begin(self, step):
            told.append(step)
            self.steps.append(step)

        def end(self):
            self.steps.pop()

    spinner = Recorder()
    monkeypatch.setattr(waiting, "_SPINNER", spinner)
    linearize = Configuration.linearize

    def watched(*given, **more):
        if not spinner.steps:
            silent.append(command)
        return linearize(*given, **more)

    monkeypatch.setattr(Configuration, "linearize", watched)
    run(command, TTY_COMPATIBLE="1")
    assert told[0] == "Starting"
    assert silent == [] or command == "study"  # which has a bar of its own
    assert not spinner.steps


def test_a_step_that_ends_as_the_spinner_starts_leaves_no_trace(monkeypatch, capsys):
    """The timer may fire at any moment: here its thread goes on only once the last step is over."""
    spinner, failed = waiting._Spinner(), []
    monkeypatch.setattr(waiting, "_PATIENCE", 0.0)
    monkeypatch.setattr(waiting, "_SOON", 0.0)
    monkeypatch.setattr(threading, "excepthook", failed.append)
    show, over = spinner._show, threading.Event()
    monkeypatch.setattr(spinner, "_show", lambda: over.wait(60) and show())
    spinner.begin("A short step")
    assert spinner.timer is not None
    monkeypatch.setattr(spinner.timer, "cancel", over.set)  # it has fired already
    spinner.end()
    assert not failed and spinner.bar is None and capsys.readouterr().err == ""


def test_a_pipe_has_the_same_lines_however_wide_the_terminal_is():
    (text,) = {on_a_terminal(columns, "flutter", "xv15", piped=True) for columns in (40, 200)}
    assert max(map(len, text.splitlines())) <= 80 and "\x1b" not in text and "\r" not in text


def test_the_worst_design_fits_the_terminal():
    words = ["boundary", "xv15-uncoupled", "--worst-of", "rotor.precone=2:3 deg", "--scan", "300:420:60ktas"]
    lines = CliRunner().invoke(main, words, env={"COLUMNS": "80"}).stdout.splitlines()
    assert any("designs were analysed" in line for line in lines)
    assert [line for line in lines if len(line) > 80] == []


@pytest.mark.parametrize(
    "words",
    [
        (
            "boundary",
            "xv15-uncoupled",
            "--against",
            "rotor_speed=400:500:100 rpm",
            "--scan",
            "300:420:60ktas",
        ),
        (
            "map",
            "xv15-uncoupled",
            "--x",
            "airspeed=200:300:50kt",
            "--y",
            "operation.rotor_speed=400:500:50 rpm",
        ),
    ],
)
def test_the_title_tells_no_rotor_speed_where_it_varies(words):
    told = CliRunner().invoke(main, words, env={"COLUMNS": "200"}).stdout
    assert told.startswith("XV-15 with three uncoupled wing modes\n") and "458 rpm" not in told


@pytest.mark.parametrize("command", ["", *main.commands])
def test_help_fits_the_terminal(command):
    lines = CliRunner().invoke(main, [*command.split(), "--help"], env={"COLUMNS": "80"}).stdout.splitlines()
    assert lines and [line for line in lines if len(line) > 80] == []


def test_a_title_that_has_the_rotor_speed_does_not_tell_it_twice():
    told = CliRunner().invoke(main, ["flutter", "wrats-770-on", "--scan", "100:200:50kt"]).stdout
    assert told.splitlines()[0] == "WRATS model, 770 rpm, on downstop"


def test_a_wide_terminal_is_used():
    wide = on_a_terminal(200, "flutter", "xv15", piped=False)
    line = next(line for line in wide.splitlines() if "408." in line)
    assert "torsion 30 %" in line and "chord 5 %" in line


def test_the_answer_of_flutter_is_its_last_line_and_with_brief_its_first():
    words = ["flutter", "xv15-uncoupled", "--scan", "300:800:100kt"]  # with airspeeds that fail, and doubts
    whole, brief = (
        CliRunner().invoke(main, [*words, *more]).stdout.splitlines() for more in ((), ("--brief",))
    )
    assert whole[-1] == brief[0] and brief[0].startswith("Flutter speed ")
    rest = " ".join(brief[1:])
    assert "? Doubtful" in rest and "Not analysed" in rest and "not read in a source" in rest
    margin = CliRunner().invoke(main, [*words, "--speed", "250 kt"]).stdout.splitlines()[-1]
    assert margin.startswith("Margin at 250 KTAS: +")


def test_brief_is_refused_beside_json():
    done = CliRunner().invoke(main, ["flutter", "xv15", "--brief", "--json"])
    assert done.exit_code == 2 and "--brief: goes without --json" in done.stderr
