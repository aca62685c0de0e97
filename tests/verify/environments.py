"""The wheels under every Python found, with the newest and with the lowest dependencies that are declared.

    python -m tests.verify.environments            (make verify-environments)

For each Python and each of the two sets of dependencies a new environment gets both wheels, as `pip install` would
bring them, with all extras, and runs the tests of `TESTS` against the installed package. A table says what passed.
`--page` also writes it, with the versions that were installed, to a page of the documentation.

Pythons are those of `make verify-versions`: this one, those on the path, of pyenv or uv, or named by `--python` or,
with the system's separator of paths between them, by the variable PROPROTOR_PYTHONS.

Lowest is the lowest version that a dependency's bound allows and that has a wheel for the Python: old versions of
compiled packages have none for a new Python.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from tests.verify.determinism import ROOT, other_pythons

PAGE = ROOT / "docs" / "environments.md"
RESOLUTIONS = {"newest": "highest", "lowest": "lowest-direct"}
# What uses each dependency, at every place where the package calls it. The other tests ask about the equations, the
# numbers and the project itself, for which `make test` has one environment, and `make verify` several kernels.
TESTS = {
    "bokeh": ("explore",),
    "click": ("commands/test_command_line.py",),
    "contourpy": ("stability/test_stability_map.py",),
    "control": ("model/test_inputs_outputs.py",),
    "dask": ("study/test_study_distributed.py",),
    "filelock": ("study/test_study_resume.py",),
    "fluids": ("rotor/test_atmosphere.py",),
    "h5py": ("nastran/test_other_results.py",),
    "jinja2": ("report",),
    "matplotlib": ("plots",),
    "netcdf4": ("files/test_output_file.py",),
    "numpy": ("stability/test_sweep.py", "model/test_frequency_response.py"),
    "openmdao": ("exchange/test_openmdao.py",),
    "pillow": ("plots/test_plots_of_motion.py",),
    "pint": ("units", "deck/test_inputs_with_units.py"),
    "proprotor-equations": ("derive/test_equations_alone.py",),
    "psutil": ("project/test_needs.py::test_a_limit_of_a_control_group_counts",),
    "pydantic": ("deck/test_deck.py",),
    "rich": ("tables",),
    "salib": ("study/test_sampling.py", "study/test_uncertainty.py"),
    "scipy": ("support/test_matrix_market.py", "exchange/test_matlab_file.py"),
    "tornado": ("explore",),
    "typst": ("report",),
    "xarray": ("stability/test_airspeeds.py", "study/test_mode_damping.py"),
}
_COUNTED = ("tests", "failures", "errors", "skipped")


class Environment(NamedTuple):
    """One Python with one set of dependencies, and what came of it."""

    python: str
    dependencies: str
    versions: dict[str, str]
    passed: int
    failed: tuple[str, ...]
    skipped: int


def main(arguments: list[str] | None = None) -> int:
    """Test every environment that was asked for; further arguments are those of pytest."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.verify.environments", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--python", action="append", help="a Python to test; may be repeated")
    parser.add_argument("--dependencies", choices=RESOLUTIONS, action="append", help="one set alone")
    parser.add_argument("--page", action="store_true", help=f"write {PAGE.relative_to(ROOT).as_posix()}")
    given, more = parser.parse_known_args(arguments)
    named = [path for path in os.environ.get("PROPROTOR_PYTHONS", "").split(os.pathsep) if path]
    pythons = given.python or [sys.executable, *other_pythons(), *named]
    found = []
    with tempfile.TemporaryDirectory() as wheels:
        build(Path(wheels))
        for python in pythons:
            for dependencies in given.dependencies or RESOLUTIONS:
                found.append(tested(python, dependencies, Path(wheels), more))
                print(*rows(found[-1:]), *found[-1].failed, sep="\n", flush=True)
    print(*table(found), sep="\n")
    if given.page:
        PAGE.write_text(page(found), encoding="utf-8", newline="\n")
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


def tested(python: str, dependencies: str, wheels: Path, more: Iterable[str]) -> Environment:
    """Make an environment, run the tests in it, and remove it."""
    folder = wheels / "environment"
    uv("venv", "--clear", "--python", python, folder)
    interpreter = folder / ("Scripts" if os.name == "nt" else "bin") / "python"
    try:
        install(interpreter, dependencies, wheels)
        passed, failed, skipped = run(interpreter, folder, more)
        versions = dict(
            line.split("==") for line in uv("pip", "freeze", "--python", interpreter).split() if "==" in line
        )
        number = subprocess.run([interpreter, "-V"], capture_output=True, text=True, check=True).stdout
        return Environment(number.split()[1], dependencies, versions, passed, failed, skipped)
    finally:
        shutil.rmtree(folder)


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


def project_tables() -> tuple[dict, dict]:
    """Return the tables of the project and of its dependency groups, groups within the tests' put in their place."""
    read = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    groups = read["dependency-groups"]
    inner = [groups[entry["include-group"]] for entry in groups["test"] if isinstance(entry, dict)]
    return read["project"], groups | {"test": [*groups["test"], *(one for group in inner for one in group)]}


def extras(project: dict) -> list[str]:
    """Return what all extras bring."""
    return [entry for extra in project["optional-dependencies"].values() for entry in extra]


def derivation(project: dict, groups: dict) -> Iterator[str]:
    """Yield the pinned packages that tests import the derivation with, but for those whose bound is tested here."""
    own = {name_of(entry) for entry in project["dependencies"]}
    return (entry for entry in groups["derive"] if name_of(entry) not in own)


def name_of(requirement: str) -> str:
    """Return the name of a package, as indexes write it."""
    return re.split(r"[\[<>=!~; ]", requirement)[0].lower().replace("_", "-")


def run(interpreter: Path, folder: Path, more: Iterable[str]) -> tuple[int, tuple[str, ...], int]:
    """Run the tests; return how many passed, those that failed, and how many were passed over."""
    report = folder / "tests.xml"
    files = sorted({f"tests/{place}" for places in TESTS.values() for place in places})
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
    subprocess.run(command, cwd=ROOT, env=own | {"OPENBLAS_NUM_THREADS": "1"}, check=False)
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


# The table ----------------------------------------------------------------------------------------

_HEAD = ("Python", "dependencies", "passed", "failed", "passed over")


def rows(found: Iterable[Environment]) -> Iterator[str]:
    """Yield a row for each environment."""
    for one in found:
        cells = (one.python, one.dependencies, one.passed, len(one.failed), one.skipped)
        yield f"| {' | '.join(map(str, cells))} |"


def table(found: Iterable[Environment]) -> Iterator[str]:
    """Yield the lines of the table of results."""
    yield f"| {' | '.join(_HEAD)} |"
    yield "|---" * len(_HEAD) + "|"
    yield from rows(found)


def table_of_versions(found: list[Environment]) -> Iterator[str]:
    """Yield the lines of a table of the packages that the project asks for, with the version in each environment."""
    project, _ = project_tables()
    yield f"| package, bound | {' | '.join(f'{one.python}, {one.dependencies}' for one in found)} |"
    yield "|---" * (len(found) + 1) + "|"
    for entry in (*project["dependencies"], *extras(project)):
        name = name_of(entry)
        known = [{name_of(key): value for key, value in one.versions.items()}.get(name, "") for one in found]
        yield f"| {entry} | {' | '.join(known)} |"


def page(found: list[Environment]) -> str:
    """Return the text of the page."""
    return f"""\
# Environments

Written by `make verify-environments`.

In each environment below, both wheels were installed with all extras, and {len(TESTS)} dependencies were tried by the
tests that use them (`tests/verify/environments.py` lists which). Newest is what `pip install` brings; lowest is the
lowest version that a bound of `pyproject.toml` allows and that has a wheel for that Python, which shows that the bounds
are true.

{os.linesep.join(table(found))}

## Versions

{os.linesep.join(table_of_versions(found))}
""".replace(os.linesep, "\n")


if __name__ == "__main__":
    sys.exit(main())
