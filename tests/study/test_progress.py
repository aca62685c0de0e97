"""Progress of a study: told to a function, on a terminal, in a notebook, and nowhere that nobody looks."""

import os
import pty
import re
import subprocess
import sys

import pytest

import proprotor as pp
from derive.pages import notebooks

CASE = pp.load_case("xv15-uncoupled")
SPEEDS = [0.0, 110.0, 120.0, 130.0]  # no trim at rest


def test_a_function_is_told_points_done_and_failed():
    told = []
    pp.study(CASE, {}, SPEEDS, workers=1, batch=2, progress=lambda *numbers: told.append(numbers))
    assert told == [(0, 4, 0), (2, 4, 1), (4, 4, 1)]


def test_points_that_were_kept_count_as_done(tmp_path):
    told = []
    for _ in range(2):
        told.append([])
        pp.study(
            CASE, {}, SPEEDS, workers=1, batch=2, checkpoint=tmp_path, progress=lambda *n: told[-1].append(n)
        )
    assert told[1] == [(4, 4, 0)]


SCRIPT = """
import proprotor as pp
found = pp.study(pp.load_case("xv15-uncoupled"), {}, [0.0, 110.0, 120.0, 130.0], workers=1, batch=2)
"""


def test_nothing_is_shown_where_the_error_stream_is_no_terminal():
    done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


@pytest.mark.skipif(os.name == "nt", reason="Windows has no pseudo-terminals")
def test_a_terminal_shows_a_bar_from_the_first_moment_on():
    ours, theirs = pty.openpty()
    process = subprocess.Popen([sys.executable, "-c", SCRIPT], stderr=theirs, stdout=theirs)
    os.close(theirs)
    shown = b""
    while True:
        try:
            part = os.read(ours, 4096)
        except OSError:  # the other side is closed
            break
        if not part:
            break
        shown += part
    assert process.wait() == 0
    os.close(ours)
    text = re.sub(r"\x1b\[[0-9;?]*[a-zA-Z]", "", shown.decode())
    assert text.index("Preparing") < text.index("Analysing") and "4/4" in text and "1 failed" in text


def test_a_notebook_shows_a_bar_below_its_cell(tmp_path, monkeypatch):
    monkeypatch.setattr(notebooks, "ROOT", tmp_path)
    monkeypatch.chdir(tmp_path)  # where the sockets of the kernel are
    source = tmp_path / "study.py"
    source.write_text(f"# %%{SCRIPT}")
    (notebook,) = notebooks.executed([source])
    (output,) = notebook.cells[0].outputs
    shown = output["data"]["text/html"]
    assert shown.startswith('<progress value="4" max="4"></progress> 4 of 4 points, 1 failed, ')
