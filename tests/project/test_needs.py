"""What a computation needs is asked for before its first point: packages, places to write to, memory.

Each missing package is simulated, each size is one that somebody could type; nothing may have been computed, and the
one message says what to install or what to reduce.
"""

import ast
import importlib.util
import json
import re
import subprocess
import sys
import tomllib
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from click.testing import CliRunner

import proprotor as pp
from proprotor import needs
from proprotor.case import Case
from proprotor.commands.main import main
from proprotor.errors import InputError
from proprotor.nastran.hdf5 import read_hdf5
from proprotor.needs import check_memory, free_memory
from proprotor.plots.animation import animate_mode
from proprotor.plots.mode_motion import mode_motion
from proprotor.stability.frequency_response import frequency_response

ROOT = Path(pp.__file__).parent
PROJECT = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8"))
PRECONE = "rotor.precone"
CASE = pp.load_case("xv15-uncoupled")
MODEL = CASE.linearize(100.0)


@pytest.fixture
def computed(monkeypatch):
    """Points computed since the test began."""
    points = []
    linearize = Case.linearize
    monkeypatch.setattr(Case, "linearize", lambda *a, **k: points.append(a) or linearize(*a, **k))
    return points


# Packages -----------------------------------------------------------------------------------------


def command(*arguments):
    """A command; what it tells as the error that a call would raise."""
    done = CliRunner().invoke(main, [str(argument) for argument in arguments])
    if done.exit_code == 2 and isinstance(done.exception, SystemExit):
        raise InputError("command", None, done.stderr.strip())
    assert done.exit_code == 0, done.output
    return done


SAMPLED = (
    "study",
    "xv15-uncoupled",
    "--vary",
    f"{PRECONE}=1:2 deg",
    "--speed",
    "200 kt",
    "--size",
    "2",
    "--sample",
)
GRID = ("study", "xv15-uncoupled", "--vary", f"{PRECONE}=1:2:1 deg", "--speed", "200 kt", "--out")


OF_SALTELLI = xr.Dataset({"growth_rate": ("design", np.ones(3))}, attrs={"sample": json.dumps({})})
BASE = "a package that comes with proprotor"
NEEDS = {
    "to_control": ("control", "control", lambda folder: MODEL.to_state_space().to_control()),
    "saltelli": ("SALib", "study", lambda folder: pp.sampling.saltelli({PRECONE: ("1 deg", "2 deg")}, 2)),
    "--sample saltelli": ("SALib", "study", lambda folder: command(*SAMPLED, "saltelli")),
    "sobol_indices": ("SALib", "study", lambda folder: pp.sobol_indices(OF_SALTELLI, "growth_rate")),
    "save_results": ("netCDF4", BASE, lambda folder: pp.save_results(xr.Dataset(), folder / "x.nc")),
    "--out study.nc": ("netCDF4", BASE, lambda folder: command(*GRID, folder / "x.nc")),
    "--out report.pdf": (
        "typst",
        "report",
        lambda folder: command("report", "xv15-uncoupled", "--out", folder / "x.pdf"),
    ),
    "--pdf": (
        "typst",
        "report",
        lambda folder: command("report", "xv15-uncoupled", "--out", folder / "x.html", "--pdf"),
    ),
    "--out report.docx": (
        "docx",
        "report",
        lambda folder: command("report", "xv15-uncoupled", "--out", folder / "x.docx"),
    ),
    "--docx": (
        "docx",
        "report",
        lambda folder: command("report", "xv15-uncoupled", "--out", folder / "x.html", "--docx"),
    ),
    "explore": ("bokeh", "explore", lambda folder: command("explore", "xv15-uncoupled", "--no-browser")),
    "explore's server": (
        "tornado",
        "explore",
        lambda folder: command("explore", "xv15-uncoupled", "--no-browser"),
    ),
    "Nastran's HDF5 file": ("h5py", "nastran", lambda folder: read_hdf5(Path(__file__), grid=1)),
}


@pytest.mark.parametrize("what", NEEDS)
def test_a_missing_package_is_told_before_anything_is_computed(tmp_path, monkeypatch, computed, what):
    package, extra, use = NEEDS[what]
    for name in [name for name in sys.modules if name.partition(".")[0] == package]:
        monkeypatch.setitem(sys.modules, name, None)
    monkeypatch.setitem(sys.modules, package, None)
    install = f"pip install {package}" if extra is BASE else f'pip install "proprotor[{extra}]"'
    with pytest.raises(InputError) as caught:
        use(tmp_path)
    told = str(caught.value)
    assert f"needs {package} for " in told and told.endswith(f": {install}") and "\n" not in told
    assert computed == [] and list(tmp_path.iterdir()) == []


def test_openmdao_is_asked_for_where_its_component_is_imported():
    code = "import sys; sys.modules['openmdao'] = None\nimport proprotor.exchange.openmdao"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    last = done.stderr.strip().splitlines()[-1]
    assert (
        last == 'ImportError: proprotor.exchange.openmdao needs OpenMDAO: pip install "proprotor[openmdao]"'
    )


def test_a_package_that_is_there_and_broken_is_told_with_its_reason(tmp_path, monkeypatch):
    (tmp_path / "half_a_package.py").write_text("import nowhere_to_be_found")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(
        InputError, match=r"pip install half_a_package \(No module named 'nowhere_to_be_found'\)$"
    ):
        needs.need("half_a_package", "x", "a test")


def _packages(entries):
    return {re.split(r"[\[<>=]", entry)[0] for entry in entries}


EXTRAS = PROJECT["project"]["optional-dependencies"]
MODULES = {package for extra in EXTRAS.values() for package in _packages(extra)} | {"distributed"}
# A client of a cluster is made by whoever has `distributed`, and `openmdao` is told where it is imported.
ELSEWHERE = {("workers.py", "distributed"), ("openmdao.py", "openmdao")}


def test_every_package_of_an_extra_is_asked_for():
    """A new import of one needs a `need` in its module, or in that of the command, and a case above."""
    asked, used = set(), set()
    for path in sorted(ROOT.rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for block in [node for node in ast.walk(tree) if isinstance(node, ast.If)]:
            if ast.unparse(block.test) == "TYPE_CHECKING":
                block.body = [ast.Pass()]
        for node in ast.walk(tree):
            names = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                names = [node.module or ""]
            elif isinstance(node, ast.Call) and ast.unparse(node.func) == "need":
                asked |= {
                    text.value.partition(".")[0] for text in node.args if isinstance(text, ast.Constant)
                }
            used |= {(path.name, name.partition(".")[0]) for name in names}
    used = {(file, package) for file, package in used if package in MODULES} - ELSEWHERE
    assert {package for _, package in used} <= asked
    assert {package for _, package in used} <= {package for package, _, _ in NEEDS.values()}


BASE_INSTALL = """
import sys

class WithoutExtras:
    def __init__(self, finder):
        self.finder = finder

    def __getattr__(self, name):
        return getattr(self.finder, name)

    def find_spec(self, name, *more):
        hidden = name.partition(".")[0] in sys.argv[2].split(",")
        return None if hidden else self.finder.find_spec(name, *more)

sys.meta_path[:] = map(WithoutExtras, sys.meta_path)
import numpy as np
import proprotor as pp
from proprotor.commands.main import main

case = pp.load_case("xv15-uncoupled")
found = case.sweep([80.0, 90.0])
pp.save_results(found, f"{sys.argv[1]}/sweep.nc")
again = pp.load_results(f"{sys.argv[1]}/sweep.nc")
assert again.eigenvalue.dtype == complex
assert np.array_equal(again.eigenvalue, found.eigenvalue, equal_nan=True)
study = ["study", "xv15-uncoupled", "--vary", "rotor.precone=1:2 deg", "--sample", "sobol", "--size", "2"]
main([*study, "--workers", "2", "--speed", "200 kt", "--out", f"{sys.argv[1]}/study.nc"], standalone_mode=False)
print(pp.load_results(f"{sys.argv[1]}/study.nc").eigenvalue.dtype)
"""


def test_results_are_kept_in_files_without_any_extra(tmp_path):
    """Complex numbers included: what extras bring is hidden, what the project asks for itself is not."""
    hidden = MODULES - _packages(PROJECT["project"]["dependencies"])
    assert {"SALib", "control", "distributed"} <= hidden
    command = [sys.executable, "-c", BASE_INSTALL, tmp_path, ",".join(sorted(hidden))]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.stdout.splitlines()[-1] == "complex128", done.stderr


# What a command imports ---------------------------------------------------------------------------

NO_COMMAND = {
    "dask",
    "pint",
    "scipy.optimize",
    "scipy.linalg",
    "matplotlib",
    "bokeh",
    "netCDF4",
    "SALib",
    "IPython",
}
NO_TABLE = {*NO_COMMAND, "scipy", "xarray", "pandas"}
IMPORTED = {
    ("--help",): {*NO_TABLE, "numpy", "rich", "pydantic", "proprotor.case", "proprotor_equations"},
    ("cases",): {*NO_TABLE, "rich", "pydantic", "proprotor.study", "proprotor.exchange"},
    ("flutter", "xv15-uncoupled"): {*NO_TABLE, "proprotor.study", "proprotor.exchange"},
    ("sweep", "xv15-uncoupled", "--speed", "100:120:10kt"): {*NO_COMMAND, "scipy"},
}
A_COMMAND = """
import sys
from proprotor.commands.main import main

try:
    main()
finally:
    print("imported", *(name for name, module in sys.modules.items() if module is not None))
"""


@pytest.mark.parametrize("words", IMPORTED, ids=" ".join)
def test_a_command_imports_what_it_needs_and_nothing_slow_beside(words):
    """A package that is installed, and that somebody's import would bring along."""
    assert all(map(importlib.util.find_spec, IMPORTED[words]))
    done = subprocess.run([sys.executable, "-c", A_COMMAND, *words], capture_output=True, text=True)
    shown, _, imported = done.stdout.rpartition("imported ")
    assert shown and done.returncode == 0, done.stderr
    assert IMPORTED[words] & {*imported.split()} == set()


def test_a_command_in_a_session_of_python_leaves_its_packages_alone():
    code = "from proprotor.commands.main import main; main(['cases'], standalone_mode=False)"
    done = subprocess.run(
        [sys.executable, "-c", f"{code}; import dask, pint"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr


# Places to write to -------------------------------------------------------------------------------

FILES = {
    "no such folder": lambda folder: folder / "missing" / "x.nc",
    "a folder": lambda folder: folder,
    "below a file": lambda folder: Path(__file__) / "x.nc",
    "a folder nobody can write": lambda folder: Path("/proc/self/x.nc"),
    "too long a name": lambda folder: folder / f"{'n' * 253}.nc",
}


@pytest.mark.parametrize("where", FILES)
def test_an_output_that_cannot_be_written_is_told_before_anything_is_computed(tmp_path, computed, where):
    place = FILES[where](tmp_path)
    done = CliRunner().invoke(main, [*GRID, str(place)])
    assert done.exit_code in (1, 2) and isinstance(done.exception, SystemExit)
    assert len(done.stderr.splitlines()) == 1 and "--out" in done.stderr
    with pytest.raises(InputError):
        pp.save_results(xr.Dataset(), place)
    assert computed == [] and list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("where", ["below a file", "a folder nobody can write"])
def test_a_checkpoint_that_cannot_be_is_told_before_anything_is_computed(tmp_path, computed, where):
    with pytest.raises(InputError, match=r"^checkpoint = .*: cannot be used"):
        pp.study(CASE, {PRECONE: [0.03]}, 100.0, checkpoint=FILES[where](tmp_path))
    assert computed == []


# Memory -------------------------------------------------------------------------------------------

TRILLION = 10**12
FAR = np.broadcast_to(np.float64(100.0), (10**9,))  # takes no memory itself
VARY = ("--vary", f"{PRECONE}=1:4 deg", "--speed", "100:200:1kt")


def aircraft_of_elements(count):
    """The aircraft of the deck with many elements in each wing and box, and two different sides."""
    parts = "support.elements", "support.carry_through.elements"
    return pp.load_case(
        "xv15-aircraft", dict.fromkeys(parts, str(count)) | {"left.support.downstop": "false"}
    )


LARGE = {
    "elements of an aircraft": lambda: aircraft_of_elements(200),
    "--size": lambda: command(
        "study", "xv15-uncoupled", *VARY, "--sample", "latin-hypercube", "--size", TRILLION
    ),
    "--size of sobol": lambda: command(
        "study", "xv15-uncoupled", *VARY, "--sample", "sobol", "--size", 2**50
    ),
    "--size of saltelli": lambda: command(
        "study", "xv15-uncoupled", *VARY, "--sample", "saltelli", "--size", 2**50
    ),
    "size of results": lambda: pp.study(CASE, pp.sampling.sobol({PRECONE: (0, 0.1)}, 2**20), "1:99:1kt"),
    "a step": lambda: command(
        "study", "xv15-uncoupled", "--vary", f"{PRECONE}=1:4:1e-300 deg", "--speed", "200 kt"
    ),
    "a step of nothing": lambda: command(
        "study", "xv15-uncoupled", "--vary", f"{PRECONE}=1:4:1e-400 deg", "--speed", "9 kt"
    ),
    "a grid": lambda: pp.study(
        CASE, dict.fromkeys([PRECONE, "rotor.chord", "rotor.radius"], FAR[:4000]), 1.0
    ),
    "--speed": lambda: command("sweep", "xv15-uncoupled", "--speed", "1:400:1e-9kt"),
    "--speed without end": lambda: command("sweep", "xv15-uncoupled", "--speed", "1:infkt:1kt"),
    "--speed of nan": lambda: command("sweep", "xv15-uncoupled", "--speed", "1:400:nankt"),
    "--speed of a tiny step": lambda: command("sweep", "xv15-uncoupled", "--speed", "1:400:1e-320kt"),
    "--scan": lambda: command("flutter", "xv15-uncoupled", "--scan", "1:400:1e-9kt"),
    "--x": lambda: command(
        *("map", "xv15-uncoupled", "--x", f"{PRECONE}=1:4:1e-6 deg", "--y", "airspeed=100:400:1e-3kt")
    ),
    "airspeeds": lambda: CASE.linearize(FAR),
    "airspeeds of a sweep": lambda: CASE.sweep(FAR),
    "airspeeds of boundaries": lambda: CASE.boundaries(FAR),
    "against": lambda: CASE.boundary_against({PRECONE: np.linspace(0.01, 0.05, 10**6)}, "1:400:1e-2kt"),
    "values of an input": lambda: CASE.sweep(100.0, {"rotor.blade_mass": FAR}),
    "workers": lambda: pp.study(CASE, {PRECONE: FAR[:200_000]}, 100.0, workers=200_000),
    "batch": lambda: pp.study(CASE, pp.sampling.points({PRECONE: FAR[: 10**6]}), 100.0, batch=10**6),
    "frames": lambda: animate_mode(MOTION, "x.gif", frames=TRILLION),
    "dpi": lambda: animate_mode(MOTION, "x.gif", dpi=10**7),
    "frequencies": lambda: frequency_response(MODEL, FAR[: 10**8]),
    "n_blades": lambda: pp.load_case("xv15-uncoupled", {"rotor.n_blades": "1000000"}).linearize(
        100.0, reactionless=True
    ),
    "resamples": lambda: pp.sobol_indices(SALTELLI, "growth_rate", resamples=10**11),
}
MOTION = mode_motion(CASE, "200 kt", "chord")
SALTELLI = xr.Dataset(
    {"growth_rate": ("design", np.arange(3.0))},
    attrs={
        "sample": json.dumps(
            {"method": "saltelli", "size": 1, "seed": 0, "inputs": [PRECONE], "second_order": False}
        )
    },
)


@pytest.mark.parametrize("what", LARGE)
def test_a_size_beyond_memory_is_told_before_any_is_taken(tmp_path, monkeypatch, computed, what):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(needs, "free_memory", lambda: 4e9)  # whatever this machine has
    tracemalloc.start()
    try:
        with pytest.raises(InputError) as caught:
            LARGE[what]()
        taken = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert "\n" not in str(caught.value)
    assert taken < 2e9  # what was typed may be laid out where it fits, such as ten million values
    if not what.startswith(("airspeeds", "n_blades")):  # which are refused within
        assert computed == []


def test_the_message_says_what_would_be_taken_what_is_free_and_what_to_reduce(monkeypatch):
    monkeypatch.setattr(needs, "free_memory", lambda: 2.5e9)
    check_memory("size", 100, 2.5e9, "the results")
    with pytest.raises(InputError) as caught:
        check_memory("size", 100, 3.2e9, "the results")
    assert str(caught.value) == (
        "size = 100: the results would take 3.2 GB of memory, and 2.5 GB are free: reduce size"
    )


LIMITED = """
import resource
import proprotor as pp
from proprotor.needs import free_memory
case = pp.load_case("xv15-uncoupled")
import psutil
used = psutil.Process().memory_info().vms
resource.setrlimit(resource.RLIMIT_AS, (used + 400_000_000, resource.RLIM_INFINITY))
assert abs(free_memory() - 4e8) < 5e7, free_memory()
try:
    case.sweep("100:300:0.02kt")
except pp.InputError as error:
    print(error)
"""


def test_a_limit_on_the_process_counts():
    """As batch systems set it: without the check these ten thousand speeds end in a MemoryError."""
    done = subprocess.run([sys.executable, "-c", LIMITED], capture_output=True, text=True)
    assert re.fullmatch(
        r"airspeed = 10001 points: following their modes would take 2\.3 GB of memory, and 0\.4 GB are free: "
        r"take fewer points\n",
        done.stdout,
    ), done.stderr


FILES_OF_GROUPS = {
    "0::": ("", "memory.max", "memory.current", "inactive_file"),
    "9:memory:": ("memory", "memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"),
}


@pytest.mark.parametrize("version", FILES_OF_GROUPS)
def test_a_limit_of_a_control_group_counts(tmp_path, monkeypatch, version):
    """As containers and jobs of a cluster have it; the tightest of a group and those around it."""
    root, limit, use, files = FILES_OF_GROUPS[version]
    inner = tmp_path / root / "job" / "step"
    inner.mkdir(parents=True)
    monkeypatch.setattr(needs, "_GROUPS", tmp_path)
    monkeypatch.setattr(needs, "_GROUP_OF_PROCESS", tmp_path / "cgroup")
    (tmp_path / "cgroup").write_text(f"3:cpu,cpuacct:/job\n{version}/job/step\n")
    unlimited = free_memory()
    for group, most, used, cached in ((inner, "max", 1, 0), (inner.parent, "3000000", 2500000, 100000)):
        (group / limit).write_text(f"{most}\n")
        (group / use).write_text(f"{used}\n")
        (group / "memory.stat").write_text(f"anon 5\n{files} {cached}\n")
    assert free_memory() == 600000 < unlimited
    (inner / limit).write_text("100\n")
    assert free_memory() == 99


SIZES = {
    "linearize": (lambda: CASE.linearize(np.linspace(60, 200, 4000)), 4000, 36_000),
    "sweep": (lambda: CASE.sweep(np.linspace(60, 200, 1000)), 1000, 230_000),
    "boundaries": (lambda: CASE.boundaries(np.linspace(60, 200, 1000)), 1000, 230_000),
    "sweep of a wing": (lambda: pp.load_case("xv15-wing").sweep(np.linspace(60, 200, 1000)), 1000, 230_000),
}


@pytest.mark.parametrize("what", SIZES)
def test_what_is_asked_for_is_what_is_taken(what):
    """Within a factor of four, and never less."""
    analyse, points, asked = SIZES[what]
    analyse()  # so that what is kept for good does not count
    tracemalloc.start()
    try:
        analyse()
        taken = tracemalloc.get_traced_memory()[1] / points
    finally:
        tracemalloc.stop()
    assert asked / 4 < taken < asked
