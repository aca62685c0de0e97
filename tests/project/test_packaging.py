"""What a release says of itself agrees: version, changelog, citation, licence, extras, the two distributions."""

import re
import tomllib
from importlib.metadata import version
from itertools import chain
from pathlib import Path

import pytest
import yaml
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.utils import canonicalize_name
from packaging.version import Version

import proprotor as pp
from tests.verify import environment_page
from tests.verify.tests_of_dependencies import ALL, SHORT

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
EQUATIONS = tomllib.loads((ROOT / "generated" / "pyproject.toml").read_text(encoding="utf-8"))
CITATION = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
# Of the Citation File Format 1.2.0: what must be there, and what this file uses.
REQUIRED = {"cff-version", "message", "title", "authors"}
KNOWN = REQUIRED | {"type", "version", "abstract", "keywords", "license", "date-released", "url"}


def test_one_version():
    own = PROJECT["project"]["version"]
    assert version("proprotor") == pp.__version__ == own
    assert EQUATIONS["project"]["version"] == own
    assert f"proprotor-equations=={own}" in PROJECT["project"]["dependencies"]
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


@pytest.mark.parametrize(
    ("project", "folder", "package"),
    [(PROJECT, ROOT, "proprotor"), (EQUATIONS, ROOT / "generated", "proprotor_equations")],
)
def test_each_wheel_is_told_to_have_one_package(project, folder, package):
    (place,) = project["tool"]["hatch"]["build"]["targets"]["wheel"]["packages"]
    assert Path(place).name == package
    assert (folder / place / "__init__.py").is_file()


def test_one_licence_and_the_same_authors():
    """The text is twice in the repository, because a distribution cannot have a file from beside its folder."""
    text = (ROOT / "LICENSE").read_bytes()
    assert (ROOT / "generated" / "LICENSE").read_bytes() == text
    (author,) = CITATION["authors"]
    assert author["name"] in text.decode()
    for project in (PROJECT["project"], EQUATIONS["project"]):
        assert project["license"] == CITATION["license"] == "BSD-3-Clause"
        assert project["license-files"] == ["LICENSE"]
        assert project["authors"] == [author]
        assert project["requires-python"] == PROJECT["project"]["requires-python"]


def test_the_package_says_that_it_has_types():
    assert (ROOT / "src" / "proprotor" / "py.typed").is_file()
    assert "Typing :: Typed" in PROJECT["project"]["classifiers"]


def test_the_page_of_extras_names_each_and_what_it_brings():
    page = (ROOT / "docs" / "install.md").read_text(encoding="utf-8").lower()
    rows = {}
    for extra, brings in re.findall(r"^\| `(\w+)` \| ([^|]+) \|", page, re.MULTILINE):
        rows.setdefault(extra, set()).update(re.split(r", | ", brings))
    names = {"dask": "dask.distributed", "control": "python-control"}
    for extra, entries in PROJECT["project"]["optional-dependencies"].items():
        packages = {re.split(r"[\[<>=]", entry)[0].lower() for entry in entries}
        assert rows.pop(extra) == {names.get(package, package) for package in packages}
    assert not rows


def test_workflows_and_hooks_call_targets_that_exist():
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
    hooks = yaml.safe_load((ROOT / ".pre-commit-config.yaml").read_text(encoding="utf-8"))
    ruff, own = hooks["repos"]
    assert f"ruff=={ruff['rev'].removeprefix('v')}" in PROJECT["dependency-groups"]["derive"]
    called = {hook["entry"].removeprefix("make ") for hook in own["hooks"]}
    assert called <= targets and called
    for path in (ROOT / ".github" / "workflows").glob("*.yml"):
        for job in yaml.safe_load(path.read_text(encoding="utf-8"))["jobs"].values():
            for command in [step["run"] for step in job["steps"] if "run" in step]:
                if command.startswith("python -m tests."):
                    assert (ROOT / f"{command.split()[2].replace('.', '/')}.py").is_file(), command
                elif command.startswith(".ci/"):
                    assert (ROOT / command).is_file()


@pytest.mark.parametrize("lists", [ALL, SHORT], ids=["all", "short"])
def test_every_dependency_has_tests_that_run_in_other_environments(lists):
    assert set(lists) == set(environment_page.bounds())
    for places in lists.values():
        for place in places:
            file, _, name = place.partition("::")
            assert (ROOT / "tests" / file).exists(), place
            assert not name or f"\ndef {name}(" in (ROOT / "tests" / file).read_text(encoding="utf-8"), place


def test_the_bounds_are_those_that_were_tested():
    """Whoever changes a bound, or adds a dependency, tests the lowest versions again."""
    declared = [
        *PROJECT["project"]["dependencies"],
        *chain(*PROJECT["project"]["optional-dependencies"].values()),
    ]
    wanted = {canonicalize_name(one.name): one.specifier for one in map(Requirement, declared)}
    tested = environment_page.recorded()
    assert tested
    for one in tested:
        for name, bound in wanted.items():
            assert Version(one.versions[name]) in bound, (one.place, name)
        if one.dependencies == "lowest":
            assert {name: SpecifierSet(bound) for name, bound in one.bounds.items()} == wanted


def test_the_page_of_environments_is_what_was_recorded():
    page = (ROOT / "docs" / "environments.md").read_text(encoding="utf-8")
    assert page == environment_page.page(environment_page.recorded())


@pytest.mark.parametrize("extra", PROJECT["project"]["optional-dependencies"])
def test_tests_have_what_every_extra_brings(extra):
    tested = [entry for entry in PROJECT["dependency-groups"]["test"] if isinstance(entry, str)]
    assert set(PROJECT["project"]["optional-dependencies"][extra]) <= set(tested)
