"""What came of each environment, kept from one run to the next, and the page that shows it.

A run renews the rows of its own environments and leaves the others, so the table can be made piece by piece.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from tests.verify.determinism import ROOT

PAGE = ROOT / "docs" / "environments.md"
RECORDS = ROOT / "tests" / "verify" / "environments.json"
RESOLUTIONS = {"newest": "highest", "lowest": "lowest-direct"}  # of uv
_HEAD = ("Python", "system", "dependencies", "tests", "passed", "failed", "passed over", "date")
_BOUND = re.compile(r"(?P<name>[\w-]+)(?:\[\w+\])?(?P<bound>.*)")


class Environment(NamedTuple):
    """One Python with one set of dependencies, and what came of it."""

    python: str
    system: str
    dependencies: str
    tests: str  # all, or short
    date: str
    passed: int
    failed: tuple[str, ...]
    skipped: int
    bounds: dict[str, str]  # as pyproject.toml had them
    versions: dict[str, str]  # of the packages that have a bound

    @property
    def place(self) -> tuple[str, ...]:
        """The minor version of Python and the set of dependencies: one row of the table."""
        return (minor(self.python), self.dependencies)


def minor(python: str) -> str:
    """Return the first two numbers of a version."""
    return ".".join(python.split(".")[:2])


# What is declared ---------------------------------------------------------------------------------


def project_tables() -> tuple[dict, dict]:
    """Return the tables of the project and of its dependency groups, groups within the tests' put in their place."""
    read = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    groups = read["dependency-groups"]
    inner = [groups[entry["include-group"]] for entry in groups["test"] if isinstance(entry, dict)]
    return read["project"], groups | {"test": [*groups["test"], *(one for group in inner for one in group)]}


def extras(project: dict) -> list[str]:
    """Return what all extras bring."""
    return [entry for extra in project["optional-dependencies"].values() for entry in extra]


def name_of(requirement: str) -> str:
    """Return the name of a package, as indexes write it."""
    return _BOUND.match(requirement)["name"].lower().replace("_", "-")


def bounds() -> dict[str, str]:
    """Return the bound of each package that the project and its extras ask for."""
    project, _ = project_tables()
    entries = (*project["dependencies"], *extras(project))
    return {name_of(entry): _BOUND.match(entry)["bound"] for entry in entries}


def pythons() -> list[str]:
    """Return the versions of Python that the project's classifiers name."""
    project, _ = project_tables()
    found = (
        re.fullmatch(r"Programming Language :: Python :: (3\.\d+)", one) for one in project["classifiers"]
    )
    return [one[1] for one in found if one]


# Records ------------------------------------------------------------------------------------------


def recorded() -> list[Environment]:
    """Return what came of the environments that were tested so far, in the order of the table."""
    if not RECORDS.exists():
        return []
    read = json.loads(RECORDS.read_text(encoding="utf-8"))
    return [Environment(**one | {"failed": tuple(one["failed"])}) for one in read]


def record(found: Environment) -> None:
    """Put an environment in the place of its row, and write the records and the page."""
    known = {one.place: one for one in recorded()} | {found.place: found}
    rows = [known[place] for place in places() if place in known]
    text = json.dumps([one._asdict() for one in rows], indent=1, ensure_ascii=False) + "\n"
    RECORDS.write_text(text, encoding="utf-8", newline="\n")
    PAGE.write_text(page(rows), encoding="utf-8", newline="\n")


def places() -> list[tuple[str, str]]:
    """Return every row that the table can have."""
    return [(python, dependencies) for python in pythons() for dependencies in RESOLUTIONS]


# The page -----------------------------------------------------------------------------------------


def table(found: Iterable[Environment]) -> Iterator[str]:
    """Yield the lines of the table of results."""
    yield f"| {' | '.join(_HEAD)} |"
    yield "|---" * len(_HEAD) + "|"
    for one in found:
        cells = (
            one.python,
            one.system,
            one.dependencies,
            one.tests,
            one.passed,
            len(one.failed),
            one.skipped,
            one.date,
        )
        yield f"| {' | '.join(map(str, cells))} |"


def table_of_versions(found: list[Environment]) -> Iterator[str]:
    """Yield the lines of a table of the packages that the project asks for, with the version in each environment."""
    yield f"| package, bound | {' | '.join(f'{one.python}, {one.dependencies}' for one in found)} |"
    yield "|---" * (len(found) + 1) + "|"
    for name, bound in bounds().items():
        yield f"| {name}{bound} | {' | '.join(one.versions.get(name, '') for one in found)} |"


def not_tried(found: list[Environment]) -> str:
    """Return a sentence about what is not in the table."""
    tried = {one.place for one in found}
    missing = [f"Python {' '.join(place)}" for place in places() if place not in tried]
    return f"Not tried: {', '.join([*missing, 'systems that are not in the table'])}."


def failures(found: list[Environment]) -> Iterator[str]:
    """Yield the tests that failed, with their environment."""
    for one in found:
        yield from (f"- Python {one.python}, {one.dependencies}: `{test}`" for test in one.failed)


def page(found: list[Environment]) -> str:
    """Return the text of the page."""
    lines = (
        "# Environments",
        "",
        "Written by `make verify-environments`.",
        "",
        "In each environment, both wheels were installed with all extras, and each dependency was tried by the tests",
        "that use it: all, or the short list, which has a few tests of each (`tests/verify/tests_of_dependencies.py`).",
        "",
        "Newest is what `pip install` brings; lowest is the lowest version that a bound of `pyproject.toml` allows and",
        "that has a wheel for that Python.",
        "",
        *table(found),
        "",
        not_tried(found),
        *(["", "Failed:", "", *failures(found)] if any(one.failed for one in found) else []),
        "",
        "## Versions",
        "",
        *table_of_versions(found),
    )
    return "\n".join(lines) + "\n"
