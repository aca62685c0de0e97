"""Habits of other systems: their encodings, line ends, names of folders, and what they lack.

A process gets a console of cp1252, no default encoding for text files, and nothing of what POSIX alone offers. What is
printed and written has to be the same. Names of files are UTF-8 on every system that Python 3.11 supports.
"""

import multiprocessing
import os
import subprocess
import sys

import pytest

import proprotor as pp
from proprotor.errors import InputError

FOLDER = "Ωmega décks (1)"  # blanks, brackets, letters that cp1252 has and letters that it lacks
FOREIGN = {"PYTHONIOENCODING": "cp1252", "PYTHONWARNDEFAULTENCODING": "1"}
COMMANDS = (
    ("cases", "xv15"),
    ("describe", "rotor"),
    ("new", "n.toml"),
    ("sweep", "my deck.toml", "--speed", "100:200:50kt", "--csv", "τ.csv", "--plot", "p.svg"),
    ("flutter", "my deck.toml", "--scan", "300:400:50kt", "--json"),
    (
        *("study", "my deck.toml", "--vary", "rotor.precone=1:2:1 deg", "--speed", "200 kt"),
        *("--checkpoint", "kept", "--out", "s.nc"),
    ),
    ("sweep", "Ω.toml", "--speed", "100 kt"),
)
END = "-----"
# What only POSIX has, taken away after other packages, which have rules of their own, were imported; and a text file
# that is opened without an encoding is an error if this package opens it. Then one command after another.
PROGRAM = f"""
import os, sys, warnings
warnings.simplefilter("ignore", EncodingWarning)
import click, filelock, matplotlib.pyplot, netCDF4, numpy, psutil, pydantic, rich.progress, scipy.optimize, xarray

for module in ("fcntl", "grp", "pwd", "resource", "termios"):
    sys.modules[module] = None
for name in ("chown", "fork", "getpgid", "geteuid", "getuid", "killpg", "sched_getaffinity", "setsid"):
    if hasattr(os, name):
        delattr(os, name)
import signal
for name in ("SIGHUP", "SIGKILL", "SIGUSR1", "SIGALRM", "SIGPIPE"):
    if hasattr(signal, name):
        delattr(signal, name)
warnings.filterwarnings("error", category=EncodingWarning, module=r"proprotor(\\.|_equations)")
from proprotor.commands.main import main

words = sys.argv[1:]
while words:
    place = words.index("{END}")
    command, words = words[:place], words[place + 1 :]
    try:
        main.main(command)
    except SystemExit as end:
        print("{END}", end.code, flush=True)
"""


def run(folder, encoding, environment):
    """What each command prints, with its code, in a folder; and the files there."""
    words = [word for command in COMMANDS for word in (*command, END)]
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, *words],
        cwd=folder,
        env=os.environ | environment,
        capture_output=True,
        check=False,
    )
    assert done.returncode == 0 and b"Traceback" not in done.stderr, done.stderr.decode(encoding, "replace")
    return done.stdout.decode(encoding).replace("\r\n", "\n").split(END), done.stderr.decode(encoding)


def as_cp1252(text):
    return text.encode("cp1252", "backslashreplace").decode("cp1252")


@pytest.fixture(scope="module")
def consoles(tmp_path_factory):
    """Folder, outputs and messages with a console of UTF-8 and with that of another system."""
    found = []
    for encoding, environment in (("utf-8", {"PYTHONIOENCODING": "utf-8"}), ("cp1252", FOREIGN)):
        folder = tmp_path_factory.mktemp(encoding) / FOLDER
        folder.mkdir()
        text = (
            '# Ω, an é and a τ\r\nbase = "xv15-uncoupled"\r\n[case]\r\nname = "a"\r\ntitle = "précône τ"\r\n'
        )
        (folder / "my deck.toml").write_bytes(text.encode())
        found.append((folder, *run(folder, encoding, environment)))
    return found


def test_a_console_that_lacks_letters_gets_their_codes_and_everything_else_as_it_is(consoles):
    (_, expected, messages), (_, found, others) = consoles
    codes = [int(text.partition("\n")[0]) for text in expected[1:]]
    assert codes == [0] * (len(COMMANDS) - 1) + [2], messages
    assert "τ" in "".join(expected)
    # As the codec itself writes what it lacks.
    assert found == [as_cp1252(text) for text in expected]
    assert others == as_cp1252(messages)


def test_files_are_the_same_bytes_whatever_the_console(consoles):
    (here, *_), (there, *_) = consoles
    names = sorted(path.name for path in here.iterdir())
    assert names == sorted(path.name for path in there.iterdir())
    assert {"n.toml", "τ.csv", "p.svg", "s.nc", "kept"} <= set(names)
    for name in ("n.toml", "τ.csv"):
        assert (here / name).read_bytes() == (there / name).read_bytes()
        assert b"\r" not in (here / name).read_bytes()


def test_a_path_with_backslashes_in_a_deck_is_told(tmp_path):
    deck = tmp_path / "deck.toml"
    deck.write_text('base = "xv15"\nname = "C:\\data\\x.csv"\n', encoding="utf-8")
    with pytest.raises(InputError, match=r"is not TOML: .* write a path with / or in single quotes$"):
        pp.load_case(deck)


def boundary(case):
    return case.flutter_point("300:360:20kt").speed


def test_a_case_goes_to_a_process_that_is_started_afresh():
    """As multiprocessing starts one on Windows and macOS: nothing but the pickled case comes along."""
    case = pp.load_case("xv15")
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.apply(type(case).flutter_point, (case, "300:360:20kt")).speed == boundary(case)


def test_a_worker_imports_from_a_folder_whose_name_has_the_separator_of_paths(tmp_path):
    folder = tmp_path / f"a{os.pathsep}b 'c'"
    folder.mkdir()
    (folder / "known_here.py").write_text("def change(case):\n    return case\n", encoding="utf-8")
    code = (
        f"import sys; sys.path.insert(0, {str(folder)!r})\n"
        "from known_here import change\nfrom proprotor.study.workers import Worker\n"
        "worker = Worker(); print(worker.ask(change)); worker.end()"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, encoding="utf-8")
    assert done.stdout == "None\n", done.stderr
