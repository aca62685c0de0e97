"""What a release says of itself agrees: version, changelog, citation, extras."""

import re
import tomllib
from importlib.metadata import version
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
CITATION = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
# Of the Citation File Format 1.2.0: what must be there, and what this file uses.
REQUIRED = {"cff-version", "message", "title", "authors"}
KNOWN = REQUIRED | {"type", "version", "abstract", "keywords", "license", "date-released", "url"}


def test_one_version():
    own = PROJECT["project"]["version"]
    assert version("proprotor") == own
    assert CITATION["version"] == own
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    released = re.findall(r"^## \[(\d+\.\d+\.\d+)\]", changes, re.MULTILINE)
    assert "## [Unreleased]" in changes or own in released
    assert not released or released[0] == own


def test_the_citation_is_one():
    assert set(CITATION) >= REQUIRED
    assert set(CITATION) <= KNOWN
    assert CITATION["cff-version"] == "1.2.0"
    assert CITATION["type"] == "software"
    for author in CITATION["authors"]:
        assert set(author) & {"name", "family-names"}


def test_the_wheel_is_told_to_have_both_packages():
    packages = PROJECT["tool"]["hatch"]["build"]["targets"]["wheel"]["packages"]
    assert {Path(place).name for place in packages} == {"proprotor", "proprotor_equations"}
    for place in packages:
        assert (ROOT / place / "__init__.py").is_file()


@pytest.mark.parametrize("extra", PROJECT["project"]["optional-dependencies"])
def test_tests_have_what_every_extra_brings(extra):
    tested = [entry for entry in PROJECT["dependency-groups"]["test"] if isinstance(entry, str)]
    assert set(PROJECT["project"]["optional-dependencies"][extra]) <= set(tested)
