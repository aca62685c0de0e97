"""The wheel and the source distribution, made and used without the repository."""

import subprocess
import sys
import tarfile
import venv
import zipfile
from pathlib import Path

import pytest

pytestmark = pytest.mark.verify

ROOT = Path(__file__).parents[2]
NEEDED_OF_SOURCE = (
    "pyproject.toml",
    "README.md",
    "CHANGELOG.md",
    "CITATION.cff",
    "Makefile",
    "derive/equations.py",
    "templates",
    "generated/proprotor_equations/multiblade.py",
    "src/proprotor/deck/decks/xv15.toml",
    "tests/derive/test_closed_forms.py",
    "benchmarks/paper_figures/command.py",
)
NEEDED_OF_WHEEL = (
    "proprotor/deck/decks/xv15.toml",
    "proprotor/commands/main.py",
    "proprotor_equations/__init__.py",
    "proprotor_equations/published/__init__.py",
)
ONLY_IN_A_CLONE = ("figures", "audit")  # once commands of the package
LOCAL = (".venv", ".git/", ".ci", "__pycache__", ".hypothesis")  # what belongs to one machine


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """The folder of a source distribution, and of the wheel that was made from it."""
    folder = tmp_path_factory.mktemp("dist")
    subprocess.run([sys.executable, "-m", "build", "--outdir", folder, ROOT], check=True, capture_output=True)
    return folder


@pytest.fixture(scope="module")
def python(built, tmp_path_factory):
    """The interpreter of a new environment that has the wheel and what it asks for."""
    folder = tmp_path_factory.mktemp("environment")
    venv.create(folder, with_pip=True)
    interpreter = folder / "bin" / "python"
    (wheel,) = built.glob("*.whl")
    subprocess.run([interpreter, "-m", "pip", "install", "--quiet", wheel], check=True, capture_output=True)
    return interpreter


def test_the_source_distribution_has_all_that_makes_the_package(built):
    (archive,) = built.glob("*.tar.gz")
    with tarfile.open(archive) as file:
        names = [name.partition("/")[2] for name in file.getnames()]
    for needed in NEEDED_OF_SOURCE:
        assert any(name == needed or name.startswith(f"{needed}/") for name in names), needed
    assert not [name for name in names if any(part in name for part in LOCAL)]
    assert archive.stat().st_size < 10e6


def test_the_wheel_has_both_packages_and_nothing_else(built):
    (wheel,) = built.glob("*.whl")
    names = zipfile.ZipFile(wheel).namelist()
    assert set(NEEDED_OF_WHEEL) <= set(names)
    tops = {name.partition("/")[0] for name in names}
    assert {top for top in tops if not top.endswith(".dist-info")} == {"proprotor", "proprotor_equations"}
    assert not [name for name in names if any(part in name for part in ONLY_IN_A_CLONE)]


def run(python, folder, *arguments):
    """Output of a command of the new environment, run where there is nothing."""
    done = subprocess.run(
        [python.parent / arguments[0], *arguments[1:]],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_command_runs_without_the_repository(python, tmp_path):
    table = run(python, tmp_path, "proprotor", "sweep", "xv15", "--speed", "100:300:50kt")
    assert "chord" in table
    assert len([line for line in table.splitlines() if line.split()[:1] and line.split()[0] in SPEEDS]) == 5


SPEEDS = ("100", "150", "200", "250", "300")


def test_both_packages_are_imported_from_the_environment(python, tmp_path):
    code = (
        "import proprotor, proprotor_equations, sys; from importlib.metadata import version;"
        "print(proprotor.__file__); print(proprotor_equations.__file__); print(version('proprotor'));"
        "print(proprotor.load_case('xv15').linearize(150.0).M.shape)"
    )
    first, second, version, shape = run(python, tmp_path, "python", "-c", code).splitlines()
    for file in (first, second):
        assert Path(file).is_relative_to(python.parents[1])
    assert version
    assert shape == "(15, 15)"


def test_results_are_kept_in_files_without_any_extra(python, tmp_path):
    code = (
        "import importlib.util, proprotor as pp;"
        "print([name for name in ('SALib', 'dask', 'control', 'bokeh') if importlib.util.find_spec(name)]);"
        "case = pp.load_case('xv15'); found = case.sweep([80.0, 90.0]); pp.save_results(found, 'sweep.nc');"
        "print(pp.load_results('sweep.nc').equals(found));"
        "pp.study(case, {'rotor.precone': [0.03, 0.04]}, 100.0, checkpoint='kept', workers=2)"
    )
    assert run(python, tmp_path, "python", "-c", code).splitlines() == ["[]", "True"]
    assert (tmp_path / "kept" / "manifest.json").is_file()
