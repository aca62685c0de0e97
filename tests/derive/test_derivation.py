"""The derivation and what it generates: dimensions, reproducible text, the check of the generated files, and no more
symbols than quantities that are declared.

To derive takes a while, so it is done once for each of two hash seeds, one of them at random, side by side, in
processes of their own; `make verify-versions` takes three.
"""

import dataclasses
import functools
import itertools
import os
import pickle
import random
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest
import sympy as sp
from hypothesis import Phase, given, settings
from proprotor_equations import inertia
from scipy.integrate import quad

from derive import __main__ as command_line
from derive import airloads, emit, equations, multiblade
from derive import inertia as blade_inertia
from derive import kinematics as kin
from derive import symbols as s
from derive.function import (
    FORCE,
    MOMENT,
    DimensionError,
    Entry,
    Function,
    coordinate_dimension,
    dimension_of,
    entries,
    row_dimension,
)
from derive.symbols import MissingError
from tests.rotors import between, mass_distributions, zero_or

HASH_SEEDS = (0, random.randrange(1, 2**32))
GIGABYTE = 2**30

DERIVE = """
import pickle, re, resource, sys
from pathlib import Path
from derive import emit

functions, render_module = [], emit.render_module

def recorded(module_functions, title, *template):
    functions.extend(module_functions)
    return render_module(module_functions, title, *template)

emit.render_module = recorded
files = emit.derive_files(progress=lambda line: None)
# On Linux a new process starts with the largest size of its parent in ru_maxrss: VmHWM is the process's own.
status = Path("/proc/self/status")
own = re.search(r"VmHWM:\\s+(\\d+) kB", status.read_text()) if status.exists() else None
peak = 1024 * (int(own[1]) if own else resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
pickle.dump((files, functions, peak), sys.stdout.buffer)
"""


@pytest.fixture(scope="session")
def derivations():
    """(files, functions, peak memory in bytes) by hash seed."""
    processes = [
        subprocess.Popen(
            [sys.executable, "-c", DERIVE],
            cwd=emit.ROOT,
            env=os.environ | {"PYTHONHASHSEED": str(seed)},
            stdout=subprocess.PIPE,
        )
        for seed in HASH_SEEDS
    ]
    outputs = [process.communicate()[0] for process in processes]
    assert not [seed for seed, process in zip(HASH_SEEDS, processes, strict=True) if process.returncode]
    return [pickle.loads(output) for output in outputs]


@pytest.fixture
def files(derivations):
    return derivations[0][0]


@pytest.fixture
def functions(derivations):
    return derivations[0][1]


@pytest.fixture
def derived_once(files, monkeypatch):
    monkeypatch.setattr(emit, "derive_files", lambda progress=print: files)


# Dimensions ---------------------------------------------------------------------------------------


def test_every_entry_is_dimensionally_homogeneous(functions):
    assert {function.module for function in functions} == set(equations.STEPS)
    for function in functions:
        function.check_dimensions()
    checked = sum(len(function.steps) + len(function.entries) for function in functions)
    assert checked > 1000


PRIMES = map(sp.prime, itertools.count(1))


@functools.cache
def stand_in(entry):
    """A product of quantities with the dimension of an entry of a blade's matrix, times a prime lest two cancel."""
    row, column = (index.name.removeprefix("BLADE_").lower() for index in entry.indices)
    order = {"mass": 2, "damping": 1}.get(entry.base.label.name, 0)
    force = s.flap_stiffness / s.radial_station
    work = force if row_dimension(row) == FORCE else s.flap_stiffness
    _, length, time = coordinate_dimension(column)
    per_motion = s.radial_station**-length * s.rotor_speed**time
    return next(PRIMES) * work * per_motion / s.rotor_speed**order


def test_the_rotor_has_the_dimensions_of_its_blades(functions):
    """Entries that refer to a blade's matrices, with quantities of the same dimension in their place."""
    of_blades = [function for function in functions if function.blade_matrices]
    assert {"mass", "damping", "stiffness"} <= {function.name for function in of_blades}
    for function in of_blades:
        for entry in function.entries.values():
            value = entry.value.replace(lambda e: isinstance(e, sp.Indexed), stand_in)
            assert dimension_of(value, function.name) == entry.dimension


def test_products_over_segments_have_the_dimensions_of_a_blade(functions):
    """W^T L U of the airloads, along every path from a row to a column."""
    matrices = {f.name: f.entries for f in functions if f.module == "airloads" and f.entries}

    def dimensions(row, column, motion):
        for (load, _), virtual in _column(matrices["virtual_motion"], row):
            for (_, name), derivative in _row(matrices["load_derivatives"], load):
                if (name, column) in matrices[motion]:
                    parts = virtual, derivative, matrices[motion][name, column]
                    yield tuple(map(sum, zip(*(part.dimension for part in parts), strict=True)))

    for motion, order in (("rate_motion", 1), ("displacement_motion", 0), ("gust_motion", 0)):
        for row in {name for _, name in matrices["virtual_motion"]}:
            for column in {name for _, name in matrices[motion]}:
                work, per_motion = row_dimension(row), coordinate_dimension(column)
                expected = tuple(a + b - c for a, b, c in zip(work, (0, 0, order), per_motion, strict=True))
                assert set(dimensions(row, column, motion)) <= {expected}


def _column(entries, name):
    return [(place, entry) for place, entry in entries.items() if place[1] == name]


def _row(entries, name):
    return [(place, entry) for place, entry in entries.items() if place[0] == name]


def a_function(value, dimension=MOMENT, steps=()):
    """A function with one entry."""
    entries = {("flap", "flap"): Entry(value, "Eq. 0", dimension)}
    return Function("test", "entry", "", "", list(steps), rows=("flap",), columns=("flap",), entries=entries)


@pytest.mark.parametrize(
    "value",
    [
        s.flap_stiffness + s.flap_inertia * s.rotor_speed,  # terms that do not go together
        s.flap_inertia * s.rotor_speed,  # homogeneous, but no moment
        s.flap_stiffness + 1,
        s.flap_stiffness * sp.cos(s.flap_hinge_offset),
        s.flap_stiffness * sp.sqrt(s.flap_hinge_offset),
        s.flap_stiffness * sp.sqrt(s.rotor_speed * s.airspeed),
    ],
)
def test_an_entry_of_the_wrong_dimension_is_refused(value):
    a_function(s.flap_stiffness).check_dimensions()
    with pytest.raises(DimensionError):
        a_function(value).check_dimensions()


def test_a_step_of_the_wrong_dimension_is_refused():
    with pytest.raises(DimensionError, match="coning"):
        a_function(s.flap_stiffness * s.coning, steps=[(s.coning, s.flap_hinge_offset)]).check_dimensions()


def test_an_entry_broken_on_purpose_is_found(functions):
    """Another factor on one term of a real entry."""
    gyroscopic = next(f for f in functions if (f.module, f.name) == ("inertia", "gyroscopic"))
    (place, entry) = next(item for item in gyroscopic.entries.items() if item[1].value.is_Mul)
    broken = dataclasses.replace(entry, value=entry.value + entry.value * s.rotor_speed)
    with pytest.raises(DimensionError, match=re.escape(str(place))):
        dataclasses.replace(gyroscopic, entries=gyroscopic.entries | {place: broken}).check_dimensions()


# Symbols ------------------------------------------------------------------------------------------

STRAY = sp.Symbol("stray", real=True)


@pytest.mark.parametrize("blade_matrices", [(), ("mass",)], ids=["of a blade", "of the rotor"])
def test_a_symbol_that_is_no_quantity_is_refused(blade_matrices):
    value = s.flap_stiffness * STRAY
    if blade_matrices:
        value = multiblade.MASS[0, 0] * STRAY
    function = dataclasses.replace(a_function(value), blade_matrices=blade_matrices)
    with pytest.raises(ValueError, match="stray"):
        emit.describe(function)


def test_a_step_with_a_symbol_that_is_no_quantity_is_refused():
    with pytest.raises(ValueError, match="stray"):
        emit.describe(a_function(s.coning, steps=[(s.coning, STRAY)]))


def test_the_error_names_the_symbol_and_the_file_to_declare_it_in():
    told = (
        'test.entry uses the symbol stray, .*: declare it in derive/symbols.py, stray = quantity\\("stray", '
    )
    with pytest.raises(MissingError, match=told):
        emit.describe(a_function(s.flap_stiffness * STRAY))
    with pytest.raises(MissingError, match=told.replace("test.entry", r"test.entry: \('flap', 'flap'\)")):
        a_function(s.flap_stiffness * STRAY).check_dimensions()
    with pytest.raises(MissingError, match="stray = quantity"):
        a_function(s.coning, steps=[(STRAY, s.coning)]).check_dimensions()


def test_a_perturbation_that_is_left_over_is_told_apart():
    with pytest.raises(
        MissingError, match=r"q_flap, .*: it is a coordinate's perturbation: .*derive/kinematics.py"
    ):
        emit.describe(a_function(s.flap_stiffness * kin.q["flap"]))


@pytest.mark.parametrize(
    ("symbol", "remedy"),
    [
        (STRAY, "stray: declare it in derive/symbols.py"),
        (s.chord, "chord: add it to `geometry` or `operation` of `SegmentKinematics` in derive/airloads.py"),
    ],
)
def test_a_motion_of_a_section_with_another_symbol_says_where_it_is_listed(symbol, remedy):
    with pytest.raises(MissingError, match=remedy):
        airloads.segment_kinematics().ring(s.airspeed * symbol)


def test_a_motion_of_the_mass_with_another_arm_says_where_it_is_listed():
    with pytest.raises(MissingError, match=r"chord: add it to `ARMS` .* derive/inertia.py"):
        blade_inertia.blade_motion().ring(kin.flap_arm * s.chord)
    with pytest.raises(
        MissingError, match=r"no integral of the mass times flap_arm\*\*3: .*derive/inertia.py"
    ):
        blade_inertia.integrate_mass(kin.flap_arm**3, blade_inertia.TRIM_INTEGRALS)


def test_a_name_that_is_no_coordinate_says_where_these_are_listed():
    with pytest.raises(MissingError, match=r"sweep is no coordinate of the blade: .*derive/coordinates.py"):
        kin.q["sweep"]
    with pytest.raises(MissingError, match=r"sweep is no coordinate: .*derive/coordinates.py, with its unit"):
        row_dimension("sweep")
    with pytest.raises(MissingError, match=r"the row sweep: add it to `ROW_EQUATION` of derive/kinds.py"):
        entries(["sweep"], ["flap"], lambda row, column: sp.Integer(1), lambda *_: MOMENT, {"flap": "Eq. 0"})


def test_a_coordinate_that_no_coordinate_of_the_rotor_moves_is_told(monkeypatch):
    monkeypatch.setattr(kin, "COORDINATES", (*kin.COORDINATES, "sweep"))
    told = (
        "moves sweep of the blade: add it to `FIXED` of derive/coordinates.py and to `blade_coordinates` of"
    )
    with pytest.raises(MissingError, match=told):
        multiblade.blade_coordinates.__wrapped__()


def test_a_quantity_is_declared_once():
    with pytest.raises(ValueError, match="declared twice"):
        s.quantity("rotor_speed", r"\Omega", "rad/s", "again")


def test_what_cannot_be_printed_is_refused():
    with pytest.raises((ValueError, NotImplementedError)):
        emit.print_code(sp.Function("f")(s.coning))


@pytest.mark.parametrize("power", [-3, 3])
def test_a_cube_is_printed_without_a_general_power(power):
    text = emit.print_code(s.coning**power)
    assert "**2*" in text and "**3" not in text and "**(-" not in text
    assert eval(text, {"coning": 1.7}) == pytest.approx(1.7**power, rel=1e-15)


@pytest.mark.parametrize("factor", [1, -6, s.lag, s.lag / s.pitch, s.lag / s.pitch**3])
def test_a_cube_below_a_fraction_bar_is_divided_by_as_a_whole(factor):
    """The product that stands for a cube has brackets there: 6/(x**2*x), not 6/x**2*x."""
    values = {s.coning: 1.7, s.lag: 0.3, s.pitch: 0.9}
    expression = factor / s.coning**3
    text = emit.print_code(expression)
    assert "**2*" in text
    found = eval(text, {symbol.name: value for symbol, value in values.items()})
    assert found == pytest.approx(float(expression.subs(values)), rel=1e-14)


def test_one_name_is_one_index_in_a_module():
    functions = [
        dataclasses.replace(a_function(s.flap_stiffness), rows=rows, columns=("flap",))
        for rows in (("flap", "lag"), ("lag", "flap"))
    ]
    assert emit.index_groups(functions[:1])
    with pytest.raises(ValueError, match="would be two indices"):
        emit.index_groups(functions)


def test_a_harmonic_that_the_sum_over_three_blades_does_not_take_is_refused():
    with pytest.raises(ValueError, match="harmonic above 2"):
        multiblade.azimuth_mean(sp.cos(multiblade.psi) ** 3)


# The check ----------------------------------------------------------------------------------------


def copy_of_generated(folder):
    return shutil.copytree(emit.GENERATED, folder / "equations", ignore=shutil.ignore_patterns("__pycache__"))


def run_check(monkeypatch, folder=None):
    """Exit code of ``python -m derive --check``, on another folder if one is given."""
    monkeypatch.setattr(sys, "argv", ["derive", "--check"])
    if folder is not None:
        monkeypatch.setattr(emit, "differences", functools.partial(emit.differences, folder))
    return command_line.main()


def test_the_generated_files_match_the_derivation(derived_once, monkeypatch, capsys):
    assert run_check(monkeypatch) == 0
    assert capsys.readouterr().out == "generated files match the derivation\n"


def test_an_untouched_copy_matches(derived_once, monkeypatch, tmp_path):
    assert run_check(monkeypatch, copy_of_generated(tmp_path)) == 0


def test_a_file_edited_by_hand_is_shown_as_a_difference(derived_once, monkeypatch, capsys, tmp_path):
    folder = copy_of_generated(tmp_path)
    path = folder / "pitch.py"
    path.write_text(path.read_text().replace("= pitch_inertia\n", "= 2 * pitch_inertia\n", 1))
    assert run_check(monkeypatch, folder) == 1
    out = capsys.readouterr().out
    assert "--- generated/pitch.py\n+++ derived/pitch.py" in out
    assert "= 2 * pitch_inertia\n+" in out
    assert out.endswith("generated files differ from the derivation\n")


def test_a_missing_file_is_told(derived_once, monkeypatch, capsys, tmp_path):
    folder = copy_of_generated(tmp_path)
    (folder / "trim.py").unlink()
    assert run_check(monkeypatch, folder) == 1
    assert "missing: trim.py\n" in capsys.readouterr().out


@pytest.mark.parametrize("orphan", ["old.py", "published/old.py", "notes.txt"])
def test_an_orphan_file_is_told(derived_once, monkeypatch, capsys, tmp_path, orphan):
    folder = copy_of_generated(tmp_path)
    (folder / orphan).touch()
    assert run_check(monkeypatch, folder) == 1
    assert f"orphan: {orphan}\n" in capsys.readouterr().out


def test_a_folder_that_is_not_there_is_all_missing(derived_once, monkeypatch, capsys, files, tmp_path):
    assert run_check(monkeypatch, tmp_path / "nowhere") == 1
    assert capsys.readouterr().out.count("missing: ") == len(files)


def test_an_update_writes_all_files_and_removes_orphans(derived_once, files, tmp_path):
    folder = copy_of_generated(tmp_path)
    (folder / "old.py").touch()
    (folder / "trim.py").unlink()
    emit.update(folder)
    assert emit.generated_paths(folder) == set(files)
    assert emit.differences(folder) == []


def test_the_text_does_not_depend_on_the_hash_seed(derivations):
    (files, _, _), (others, _, _) = derivations
    differ = [name for name in files if others.get(name) != files[name]]
    assert others.keys() == files.keys() and not differ, f"hash seeds {HASH_SEEDS}: {differ}"


def test_the_derivation_needs_little_memory(derivations):
    assert all(peak < GIGABYTE for _, _, peak in derivations)


# What is generated --------------------------------------------------------------------------------

RUN = """
import sys
import numpy as np
import proprotor as pp
import proprotor_equations
pp.load_case(pp.list_cases()[0]).sweep(np.array([80.0, 100.0]))
derivation = {"sympy", "derive"}  # xarray may bring jinja2 along, where dask is installed
print(*sorted(derivation & {name.partition(".")[0] for name in sys.modules}))
"""


def test_nothing_of_the_derivation_is_imported_at_run_time(tmp_path):
    command = [sys.executable, "-c", RUN]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout.split() == []


def test_generated_files_import_numpy_alone(files):
    imported = set()
    for text in files.values():
        imported |= set(re.findall(r"^(?:import|from) (\S+)", text, flags=re.MULTILINE))
    assert {name for name in imported if not name.startswith(".")} <= {"numpy", "typing"}


@settings(max_examples=100, derandomize=True, deadline=None, phases=[Phase.generate])
@given(mass_distributions(4.0), zero_or(between(0.01, 0.5)), zero_or(between(0.01, 0.3)))
def test_dependent_inertias_are_integrals_over_the_blade(distribution, flap_hinge, gap):
    """I_βα = ∫ m r ρβ, I_ζα = ∫ m r ρζ, I_βζ = ∫ m ρβ ρζ."""
    flap_hinge, lag_hinge = 4.0 * flap_hinge, 4.0 * (flap_hinge + gap)
    edges = np.unique([*distribution[0], flap_hinge, lag_hinge])

    def integral(*hinges):
        def integrand(r):
            return np.interp(r, *distribution) * np.prod([max(r - hinge, 0.0) for hinge in hinges])

        return sum(quad(integrand, *piece)[0] for piece in itertools.pairwise(edges))

    dependent = inertia.dependent_inertias(
        flap_hinge_offset=flap_hinge,
        lag_hinge_offset=lag_hinge,
        flap_first_moment=integral(flap_hinge),
        flap_inertia=integral(flap_hinge, flap_hinge),
        lag_first_moment=integral(lag_hinge),
        lag_inertia=integral(lag_hinge, lag_hinge),
    )
    assert np.isclose(dependent.flap_hub_inertia, integral(0.0, flap_hinge), rtol=1e-12)
    assert np.isclose(dependent.lag_hub_inertia, integral(0.0, lag_hinge), rtol=1e-12)
    assert np.isclose(dependent.flap_lag_inertia, integral(flap_hinge, lag_hinge), rtol=1e-12)
