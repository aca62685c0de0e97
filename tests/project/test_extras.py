"""Every command with the packages of all extras hidden."""

import re
import subprocess
import sys
import tomllib

from tests import extras
from tests.documentation import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
COMMANDS_NEED = {"study", "report", "explore"}  # the other extras are for Python and for decks


def test_every_extra_that_a_command_needs_is_asked_for():
    assert {extra for extra, _ in extras.NEEDING.values()} == COMMANDS_NEED
    assert set(PROJECT["optional-dependencies"]) >= COMMANDS_NEED


def test_every_command_runs_without_an_extra_or_says_which_it_needs(tmp_path):
    hidden = {
        re.split(r"[\[<>=]", entry)[0]
        for extra in PROJECT["optional-dependencies"].values()
        for entry in extra
    }
    command = [sys.executable, "-m", "tests.extras", tmp_path, *sorted(hidden | {"distributed"})]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, encoding="utf-8", check=False)
    assert done.returncode == 0, done.stderr
    counts = len(extras.PLAIN), len(extras.NEEDING)
    assert done.stdout == "{} commands run without an extra, {} say which they need\n".format(*counts)
