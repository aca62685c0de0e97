"""The wheels and source distributions of both packages, made and used without the repository."""

import os
import shutil
import subprocess
import sys
import tarfile
import tomllib
import venv
import zipfile
from pathlib import Path

import pytest

pytestmark = pytest.mark.verify

ROOT = Path(__file__).parents[2]
LOWEST_NUMPY = tomllib.loads((ROOT / "generated" / "pyproject.toml").read_text(encoding="utf-8"))["project"][
    "dependencies"
][0].partition(">=")[2]
NEEDED_OF_SOURCE = (
    "pyproject.toml",
    "README.md",
    "CHANGELOG.md",
    "CITATION.cff",
    "Makefile",
    "derive/equations.py",
    "templates",
    "generated/proprotor_equations/multiblade.py",
    "generated/pyproject.toml",
    "LICENSE",
    "src/proprotor/deck/decks/xv15.toml",
    "tests/derive/test_closed_forms.py",
    "benchmarks/paper_figures/command.py",
)
NEEDED_OF_WHEEL = (
    "proprotor/deck/decks/xv15.toml",
    "proprotor/commands/main.py",
    "proprotor/compiled/eigenvalues.c",
    "proprotor/py.typed",
)
NEEDED_OF_EQUATIONS = (
    "proprotor_equations/__init__.py",
    "proprotor_equations/fused/plain.h",
    "proprotor_equations/published/__init__.py",
)
SOURCES = {"proprotor": ROOT / "src", "proprotor_equations": ROOT / "generated"}
ONLY_IN_A_CLONE = ("figures", "audit")  # once commands of the package
LOCAL = (".venv", ".git/", ".ci", "__pycache__", ".hypothesis")  # what belongs to one machine


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """The folder of both source distributions, and of the wheels that were made from them."""
    folder = tmp_path_factory.mktemp("dist")
    for project in (ROOT / "generated", ROOT):
        command = [sys.executable, "-m", "build", "--outdir", folder, project]
        subprocess.run(command, check=True, capture_output=True)
    return folder


def new_environment(folder, *wanted):
    """The interpreter of a new environment that has what is wanted, and what that asks for, by the pip of this one."""
    venv.create(folder)
    interpreter = folder / ("Scripts" if os.name == "nt" else "bin") / "python"
    command = [sys.executable, "-m", "pip", "--python", interpreter, "install", "--quiet", *wanted]
    subprocess.run(command, check=True, capture_output=True)
    return interpreter


@pytest.fixture(scope="module")
def python(built, tmp_path_factory):
    """The interpreter of a new environment that has both wheels, without extras."""
    return new_environment(tmp_path_factory.mktemp("environment"), *built.glob("*.whl"))


def test_the_source_distribution_has_all_that_makes_the_package(built):
    (archive,) = built.glob("proprotor-0*.tar.gz")
    with tarfile.open(archive) as file:
        names = [name.partition("/")[2] for name in file.getnames()]
    for needed in NEEDED_OF_SOURCE:
        assert any(name == needed or name.startswith(f"{needed}/") for name in names), needed
    assert not [name for name in names if any(part in name for part in LOCAL)]
    assert archive.stat().st_size < 10e6


@pytest.mark.parametrize(
    ("package", "needed"), [("proprotor", NEEDED_OF_WHEEL), ("proprotor_equations", NEEDED_OF_EQUATIONS)]
)
def test_a_wheel_has_its_package_and_nothing_else(built, package, needed):
    """No file is in both: whoever removed one distribution would damage the other."""
    (wheel,) = built.glob(f"{package}-*.whl")
    names = zipfile.ZipFile(wheel).namelist()
    assert set(needed) <= set(names)
    assert sources_in_c(SOURCES[package]) == {name for name in names if name.endswith((".c", ".h"))}
    tops = {name.partition("/")[0] for name in names}
    assert {top for top in tops if not top.endswith(".dist-info")} == {package}
    assert any(name.endswith("licenses/LICENSE") for name in names)
    assert not [name for name in names if any(part in name for part in ONLY_IN_A_CLONE)]


def sources_in_c(folder):
    """Files of C below a folder, by their path in it."""
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*.[ch]")}


@pytest.mark.skipif(not shutil.which("cc"), reason="there is no C compiler")
@pytest.mark.parametrize("plans", ["plain", "general"])
def test_the_headers_of_the_equations_compile_alone(built, tmp_path, plans):
    (wheel,) = built.glob("proprotor_equations-*.whl")
    zipfile.ZipFile(wheel).extractall(tmp_path)
    source = tmp_path / "own.c"
    source.write_text(f'#include "{plans}.h"\nint count(void) {{ return QUANTITIES; }}\n', encoding="utf-8")
    folder = tmp_path / "proprotor_equations" / "fused"
    command = ["cc", "-std=gnu11", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", f"-I{folder}", source]
    subprocess.run(command, check=True)


@pytest.mark.skipif(not shutil.which("cc"), reason="there is no C compiler")
def test_the_wheels_compute_with_a_compiler_and_without(python, tmp_path):
    """The same flutter speed; without a compiler the option `auto` takes NumPy."""
    code = (
        "import proprotor as pp; case = pp.load_case('xv15');"
        "print(case.linearize(100.0, backend='auto').origin.options.backend);"
        "print(case.flutter_point('250:350:10kt', backend='auto').speed)"
    )
    cache = {"PROPROTOR_CACHE": str(tmp_path / "cache")}
    compiled, speed = run(python, tmp_path, "python", "-c", code, **cache).splitlines()
    numpy, other = run(python, tmp_path, "python", "-c", code, **cache, PATH="", CC="").splitlines()
    assert (compiled, numpy) == ("compiled", "numpy")
    assert abs(float(speed) - float(other)) < 1e-9


EQUATIONS_ALONE = """
import sys

before = set(sys.modules)  # such as what setuptools imports as Python starts
from importlib import import_module
from pathlib import Path

import proprotor_equations

folder = Path(proprotor_equations.__file__).parent
for path in folder.rglob("*.py"):
    import_module(".".join(path.relative_to(folder.parent).with_suffix("").parts))
print(proprotor_equations.pitch.damping(
    n_blades=3, flap_damping=1.0, lag_damping=2.0, pitch_damping=3.0, gimbal_damping=6.0
).sum())
foreign = {name.partition(".")[0] for name, module in sys.modules.items()
    if name not in before and "site-packages" in str(getattr(module, "__file__", None))}
print(*sorted(foreign))
"""


@pytest.mark.parametrize("numpy", ["numpy", f"numpy=={LOWEST_NUMPY}"], ids=["newest", "lowest"])
def test_the_equations_need_numpy_alone(built, tmp_path, numpy):
    (wheel,) = built.glob("proprotor_equations-*.whl")
    python = new_environment(tmp_path / "environment", wheel, numpy)
    total, foreign = run(python, tmp_path, "python", "-c", EQUATIONS_ALONE).splitlines()
    assert total == "10.0"  # 1 + 2 + 3, and twice the blade's third of 6
    assert foreign == "numpy proprotor_equations"


def test_the_tutorial_runs_with_what_is_installed(python):
    """Its blocks of code and what they print, from the page; the package from the environment."""
    command = [python, "-m", "tests.verify.tutorial"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, encoding="utf-8", check=False)
    assert done.returncode == 0, done.stderr
    assert Path(done.stdout.splitlines()[-1]).is_relative_to(python.parents[1])


def test_every_bundled_deck_is_there(python, tmp_path):
    code = (
        "import proprotor as pp;"
        "print(*(name for name in pp.list_cases() if pp.load_case(name).linearize(90.0).M.size))"
    )
    decks = {path.stem for path in (ROOT / "src" / "proprotor" / "deck" / "decks").glob("*.toml")}
    assert set(run(python, tmp_path, "python", "-c", code).split()) == decks


def test_every_command_runs_without_an_extra_or_says_which_it_needs(python, tmp_path):
    """As tests/project/test_extras.py with the extras hidden, here where there are none."""
    command = [python, "-m", "tests.extras", tmp_path]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, encoding="utf-8", check=False)
    assert done.returncode == 0, done.stderr


def run(python, folder, *arguments, **environment):
    """Output of a command of the new environment, run where there is nothing."""
    done = subprocess.run(
        [python.parent / arguments[0], *arguments[1:]],
        cwd=folder,
        env=os.environ | environment,
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
