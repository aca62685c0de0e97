"""The wheels under every Python found, with the newest and with the lowest dependencies that are declared.

    python -m tests.verify.environments            (make verify-environments)

For each Python and each of the two sets of dependencies a new environment gets both wheels, as `pip install` would
bring them, with all extras, and runs the tests that use a dependency against the installed package. A table says what
passed. `--page` also writes each row, with the versions that were installed, to a page of the documentation. `--short`
runs a few tests of each dependency, for a machine that is busy or has to test many environments.

Pythons are those of `make verify-versions`: this one, those on the path, of pyenv or uv, or named by `--python` or,
with the system's separator of paths between them, by the variable PROPROTOR_PYTHONS.

Lowest is the lowest version that a dependency's bound allows and that has a wheel for the Python: old versions of
compiled packages have none for a new Python.
"""

from __future__ import annotations

import argparse
import os
import platform
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Iterator
from datetime import UTC, datetime
from pathlib import Path

from tests.verify.determinism import ROOT, other_pythons
from tests.verify.environment_page import (
    PAGE,
    RESOLUTIONS,
    Environment,
    bounds,
    extras,
    name_of,
    project_tables,
    record,
    table,
)
from tests.verify.tests_of_dependencies import ALL, SHORT, Tests

_COUNTED = ("tests", "failures", "errors", "skipped")


def main(arguments: list[str] | None = None) -> int:
    """Test every environment that was asked for; further arguments are those of pytest."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.verify.environments", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--python", action="append", help="a Python to test; may be repeated")
    parser.add_argument("--dependencies", choices=RESOLUTIONS, action="append", help="one set alone")
    parser.add_argument("--short", action="store_true", help="a few tests of each dependency, not all")
    parser.add_argument("--page", action="store_true", help=f"write {PAGE.relative_to(ROOT).as_posix()}")
    given, more = parser.parse_known_args(arguments)
    named = [path for path in os.environ.get("PROPROTOR_PYTHONS", "").split(os.pathsep) if path]
    pythons = given.python or [sys.executable, *other_pythons(), *named]
    tests = "short" if given.short else "all"
    found = []
    with tempfile.TemporaryDirectory() as wheels:
        build(Path(wheels))
        for python in pythons:
            for dependencies in given.dependencies or RESOLUTIONS:
                found.append(tested(python, dependencies, Path(wheels), tests, more))
                print(*table(found), *found[-1].failed, sep="\n", flush=True)
                if given.page:
                    record(found[-1])
    return int(any(one.failed or not one.passed for one in found))


def uv(*arguments: object) -> str:
    """Run uv; return what it prints.

    Raises
    ------
    SystemExit
        When uv fails, with its own words.
    """
    command = [sys.executable, "-m", "uv", "--quiet", *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=False)
    if done.returncode:
        raise SystemExit(f"uv {' '.join(map(str, arguments))}\n{done.stderr}")
    return done.stdout


def build(folder: Path) -> None:
    """Build both wheels."""
    for project in (ROOT / "generated", ROOT):
        uv("build", "--wheel", "--out-dir", folder, project)


# One environment ----------------------------------------------------------------------------------


def tested(python: str, dependencies: str, wheels: Path, tests: str, more: Iterable[str]) -> Environment:
    """Make an environment, run the tests in it, and remove it."""
    folder = wheels / "environment"
    uv("venv", "--clear", "--python", python, folder)
    interpreter = folder / ("Scripts" if os.name == "nt" else "bin") / "python"
    try:
        install(interpreter, dependencies, wheels)
        passed, failed, skipped = run(interpreter, folder, {"all": ALL, "short": SHORT}[tests], more)
        number = subprocess.run([interpreter, "-V"], capture_output=True, text=True, check=True).stdout
        date = datetime.now(UTC).date().isoformat()
        return Environment(
            number.split()[1],
            platform.system(),
            dependencies,
            tests,
            date,
            passed,
            failed,
            skipped,
            bounds=bounds(),
            versions=installed(interpreter),
        )
    finally:
        shutil.rmtree(folder)


def installed(interpreter: Path) -> dict[str, str]:
    """Return the versions of the packages that the project asks for."""
    lines = uv("pip", "freeze", "--python", interpreter).split()
    found = {name_of(line): line.partition("==")[2] for line in lines if "==" in line}
    return {name: found[name] for name in bounds() if name in found}


def install(interpreter: Path, dependencies: str, wheels: Path) -> None:
    """Install the wheels with all extras, what the tests need, and a set of dependencies."""
    project, groups = project_tables()
    asked = (*project["dependencies"], *extras(project), *groups["test"], *derivation(project, groups))
    wanted = wheels / "wanted.txt"
    wanted.write_text("\n".join(text for text in asked if isinstance(text, str)), encoding="utf-8")
    from_where = ("--python", interpreter, "--only-binary", ":all:", "--find-links", wheels)
    resolution = ("--resolution", RESOLUTIONS[dependencies])
    resolved = uv("pip", "compile", *from_where, *resolution, "--no-annotate", "--no-header", wanted)
    pinned = wheels / "pinned.txt"
    pinned.write_text(resolved, encoding="utf-8")
    names = ",".join(project["optional-dependencies"])
    package = f"proprotor[{names}]=={project['version']}"
    uv("pip", "install", *from_where, "--requirements", pinned, package)


def derivation(project: dict, groups: dict) -> Iterator[str]:
    """Yield the pinned packages that tests import the derivation with, but for those whose bound is tested here."""
    own = {name_of(entry) for entry in project["dependencies"]}
    return (entry for entry in groups["derive"] if name_of(entry) not in own)


def run(
    interpreter: Path, folder: Path, tests: Tests, more: Iterable[str]
) -> tuple[int, tuple[str, ...], int]:
    """Run the tests; return how many passed, those that failed, and how many were passed over."""
    report = folder / "tests.xml"
    files = sorted({f"tests/{place}" for places in tests.values() for place in places})
    command = [
        interpreter,
        "-m",
        "pytest",
        "-q",
        "-p",
        "no:cacheprovider",
        f"--junitxml={report}",
        *files,
        *more,
    ]
    own = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    more_of_own = {"OPENBLAS_NUM_THREADS": "1", "PYTEST_DEBUG_TEMPROOT": str(folder)}  # files of no other run
    subprocess.run(command, cwd=ROOT, env=own | more_of_own, check=False)
    return result(report) if report.exists() else (0, ("no test ran",), 0)


def result(report: Path) -> tuple[int, tuple[str, ...], int]:
    """Read pytest's report."""
    root = ET.parse(report).getroot()
    total, failures, errors, skipped = (
        sum(int(suite.get(what, 0)) for suite in root.iter("testsuite")) for what in _COUNTED
    )
    failed = tuple(
        f"{case.get('classname')}::{case.get('name')}"
        for case in root.iter("testcase")
        if case.find("failure") is not None or case.find("error") is not None
    )
    return total - failures - errors - skipped, failed, skipped


if __name__ == "__main__":
    sys.exit(main())
