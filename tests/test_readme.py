"""What the README shows works as shown."""

import re
import shlex
from pathlib import Path

import pytest
from click.testing import CliRunner

from proprotor.command_line import main

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("code", re.findall(r"```python\n(.*?)```", README, re.DOTALL))
def test_python_examples_run(code, capsys):
    exec(code, {})
    assert capsys.readouterr().out


@pytest.mark.parametrize("command", re.findall(r"^ +\.venv/bin/proprotor (.*)$", README, re.MULTILINE))
def test_commands_run(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert CliRunner().invoke(main, shlex.split(command)).exit_code == 0


def test_what_the_readme_points_to_exists():
    targets = re.findall(r"\]\((?!http)([^)]+)\)", README) + re.findall(
        r"^\| `([^`]+)`", README, re.MULTILINE
    )
    assert len(targets) > 4
    for target in targets:
        assert (ROOT / target).exists(), target


def test_make_targets_named_in_the_readme_exist():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    named = set(re.findall(r"make ([a-z-]+)`", README)) | set(
        re.findall(r"^ +make ([a-z-]+)$", README, re.MULTILINE)
    )
    assert {"test", "verify", "regenerate-equations"} <= named
    for target in named:
        assert re.search(rf"^{target}:", makefile, re.MULTILINE), target
