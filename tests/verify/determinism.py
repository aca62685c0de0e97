"""The generated equations under other hash seeds, another Python and another SymPy.

    python -m tests.verify.determinism            (make verify-versions)

Under other hash seeds, and under another version of Python with the packages of the group `derive` as they are pinned,
the derivation must write every file of `generated/` byte for byte. Under another version of SymPy, the newest or, where
that is the pinned one, the newest before it, the text may differ; every function must give the same numbers.

Environments are made once, in `.venv-verify`, for what is found: Pythons on the path, of pyenv or uv, or named by
`--python`. Nothing is fetched but packages; a machine without a second Python is told so in the last line.
"""

from __future__ import annotations

import argparse
import contextlib
import difflib
import importlib
import inspect
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import venv
import zlib
from collections.abc import Callable, Iterator, Mapping
from importlib.metadata import version
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
GENERATED = ROOT / "generated" / "proprotor_equations"
ENVIRONMENTS = ROOT / ".venv-verify"
OLDEST = (3, 11)
HASH_SEEDS = (0, 1, 271828)
TOLERANCE = 1e-13  # of each entry, cancellation allowed for as `compared` says

# Where versions of Python are kept that are not on the path: those of pyenv and of uv, below the home folder.
_KEPT = (".pyenv/versions/3.*/bin/python", ".local/share/uv/python/cpython-3.*/bin/python3")

_DERIVE = (
    "import json, sys; from derive import emit; json.dump(emit.derive_files(lambda line: None), sys.stdout)"
)
_MATRIX = re.compile(r"^(\w+) : .*\(\.\.\., (segments, )?(\d+), (\d+)\)", re.MULTILINE)
_GROUP = re.compile(r"^(\w+) : \[SI\] (\d+) numbers", re.MULTILINE)  # of a fused function
_INTO = re.compile(r"^into : .* the (\d+) results$", re.MULTILINE)  # of a fused function
_OF_NUMPY = {"cos": np.cos, "sin": np.sin}
_MORE = {"speed_of_sound": 1.2}  # what is added to keep the air subsonic

Files = dict[str, str]
Functions = dict[str, dict[str, Callable]]  # by path of the module, and by name


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m tests.verify.determinism", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--python", action="append", help="another Python to derive with; may be repeated")
    given = parser.parse_args(arguments)
    accepted = {path: (GENERATED / path).read_text(encoding="utf-8") for path in generated_files()}
    pythons = given.python or other_pythons()
    shown = [_hash_seeds(accepted), *(_python(python, accepted) for python in pythons), _sympy(accepted)]
    if not pythons:
        print(NO_PYTHON)
    return int(not all(shown))


def generated_files() -> list[str]:
    return sorted(path.relative_to(GENERATED).as_posix() for path in GENERATED.rglob("*.py"))


NO_PYTHON = (
    f"A second Python: NOT shown, for {'.'.join(map(str, sys.version_info[:2]))} alone is on the path, of pyenv or of "
    f"uv; install {'.'.join(map(str, OLDEST))} or later, or name one by --python"
)


# Hash seeds and another Python --------------------------------------------------------------------


def _hash_seeds(accepted: Files) -> bool:
    """Whether this Python writes the same files under each hash seed."""
    python = Path(sys.executable)
    return all(_told(derived(python, seed), accepted, f"Hash seed {seed}") for seed in HASH_SEEDS)


def _told(files: Files, accepted: Files, under: str) -> bool:
    """Whether the files are those that are accepted; tell."""
    for line in differences(accepted, files):
        print(line)
    same = files == accepted
    print(f"{under}: {len(files)} files, {'byte for byte' if same else 'NOT the same'}", flush=True)
    return same


def other_pythons() -> list[str]:
    """One interpreter of each minor version that is not this one's."""
    names = [f"python3.{minor}" for minor in range(OLDEST[1], 30)]
    on_path = [found for name in names if (found := shutil.which(name))]
    kept = sorted(str(path) for places in _KEPT for path in Path.home().glob(places))
    found: dict[tuple[int, int], str] = {}
    for python in (*on_path, *kept):
        number = _version_of(python)
        if number is not None and number[:2] >= OLDEST and number[:2] != sys.version_info[:2]:
            found.setdefault(number[:2], python)
    return list(found.values())


def _version_of(python: str) -> tuple[int, ...] | None:
    """The version of an interpreter; None where it does not run (a shim of pyenv that leads to none)."""
    command = [python, "-c", "import sys, ensurepip; print(*sys.version_info[:3])"]
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except OSError:
        return None
    return None if done.returncode else tuple(map(int, done.stdout.split()))


def _python(python: str, accepted: Files) -> bool:
    """Whether another Python writes the same files."""
    number = _version_of(python)
    if number is None:
        print(f"{python}: does not run")
        return False
    name = "python-" + ".".join(map(str, number))
    files = derived(environment(name, python, requirements()))
    return _told(files, accepted, f"Python {'.'.join(map(str, number))}, SymPy {version('sympy')}")


def differences(accepted: Files, files: Files) -> Iterator[str]:
    for path in sorted(set(accepted) | set(files)):
        texts = [side.get(path, "").splitlines() for side in (accepted, files)]
        yield from difflib.unified_diff(*texts, f"generated/{path}", f"derived/{path}", lineterm="")


# Another SymPy ------------------------------------------------------------------------------------


def _sympy(accepted: Files) -> bool:
    """Whether another SymPy derives functions that give the same numbers."""
    pinned = version("sympy")
    newest = environment("sympy-newest", sys.executable, [*requirements(without="sympy"), "sympy"])
    number = _installed(newest, "sympy")
    if number == pinned:
        print(f"SymPy {pinned}, the pinned one, is the newest: compared with the newest before it")
        older = [*requirements(without="sympy"), f"sympy<{pinned}"]
        newest = environment("sympy-before", sys.executable, older)
        number = _installed(newest, "sympy")
    files = derived(newest)
    if set(files) != set(accepted):
        print(f"SymPy {number}: other files: {sorted(set(files) ^ set(accepted))}")
        return False
    functions, worst, where = compared(accepted, files)
    text = sum(_body(files[path]) != _body(accepted[path]) for path in files)
    same = worst <= TOLERANCE
    print(
        f"SymPy {number} and {pinned}: {functions} functions, largest difference {worst:.1e} of an entry ({where}), "
        f"{'within' if same else 'NOT within'} {TOLERANCE:g}; {text} of {len(files)} files differ in their text"
    )
    return same


def _body(text: str) -> str:
    """A file without the line that says which SymPy made it."""
    return "\n".join(line for line in text.splitlines() if not line.startswith("# SymPy "))


def compared(one: Files, other: Files) -> tuple[int, float, str]:
    """How many functions there are, and by how much their values differ at most, and where.

    The difference of an entry f is relative to the largest of |f| and |x ∂f/∂x|, x any argument: where terms cancel,
    rounding the arguments alone moves f by as much, and no order of the terms can do better.
    """
    if set(one) != set(other):
        return 0, np.inf, min(set(one) ^ set(other))
    with _imported(one, "accepted_equations") as first, _imported(other, "derived_equations") as second:
        return _compared(first, second)


def _compared(one: Functions, other: Functions) -> tuple[int, float, str]:
    count, worst, where = 0, 0.0, "none"
    for path in one:
        if list(one[path]) != list(other[path]):
            return count, np.inf, path
        for name, function in one[path].items():
            count += 1
            for seed in range(3):
                arguments = random_arguments(function, seed)
                found = _difference(function, other[path][name], arguments)
                if found > worst:
                    worst, where = found, f"{path.removesuffix('.py')}.{name}"
    return count, worst, where


@contextlib.contextmanager
def _imported(files: Files, package: str) -> Iterator[Functions]:
    """The public functions of each module by its path, imported as a package of another name."""
    with tempfile.TemporaryDirectory() as folder:
        for path, text in files.items():
            place = Path(folder, package, path)
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_text(text, encoding="utf-8")
        sys.path.insert(0, folder)
        try:
            yield {path: _functions(package, path) for path in files}
        finally:
            sys.path.remove(folder)
            for name in [name for name in sys.modules if name.partition(".")[0] == package]:
                del sys.modules[name]


def _functions(package: str, path: str) -> dict[str, Callable]:
    """The public functions of a module."""
    if path.endswith("__init__.py"):
        return {}
    name = ".".join((package, *Path(path).with_suffix("").parts))
    return {
        function: entry
        for function, entry in vars(importlib.import_module(name)).items()
        if inspect.isfunction(entry) and entry.__module__ == name and not function.startswith("_")
    }


def random_arguments(function, seed: int) -> dict[str, np.ndarray]:
    """Numbers of order one for each argument, the same for a name wherever it stands; matrices as documented."""
    text = _documented(function)
    shapes: dict[str, tuple[int, ...]] = {
        name: ((2,) if segments else ()) + (int(n), int(m)) for name, segments, n, m in _MATRIX.findall(text)
    }
    shapes |= {name: (int(count),) for name, count in _GROUP.findall(text)}
    found = {}
    for name in inspect.signature(function).parameters:
        # The modules of its own package, and what is no number that goes in.
        if name in ("equations", "into") or name in _OF_NUMPY:
            continue
        rng = np.random.default_rng([seed, zlib.crc32(name.encode())])
        found[name] = rng.uniform(0.2, 0.9, shapes.get(name, ())) + _MORE.get(name, 0.0)
    return found


def _documented(function: Callable) -> str:
    """The docstring without its indentation, which __doc__ has before Python 3.13 alone."""
    return inspect.getdoc(function) or ""


def _difference(function, other, arguments: Mapping[str, np.ndarray]) -> float:
    """The largest difference of an entry relative to it, cancellation allowed for."""
    values, others = (_entries(_called(it, arguments)) for it in (function, other))
    if values.shape != others.shape or not (np.isfinite(values).all() and np.isfinite(others).all()):
        return np.inf
    difference = np.abs(values - others)
    if not difference.any():
        return 0.0
    scale = np.abs(values)
    for name in arguments:
        moved = dict(arguments) | {name: arguments[name] * (1 + 1e-6)}
        scale = np.maximum(scale, np.abs(_entries(_called(function, moved)) - values) / 1e-6)
    return float(np.max(difference / np.where(scale > 0, scale, 1.0)))


def _called(function: Callable, arguments: Mapping[str, np.ndarray]):
    """The results, with the functions of NumPy and the array for results that a fused function takes."""
    names = inspect.signature(function).parameters
    given: dict[str, object] = {name: wave for name, wave in _OF_NUMPY.items() if name in names}
    if "into" in names:
        (count,) = _INTO.findall(_documented(function))
        given["into"] = np.full((int(count), 1), np.nan)
    return function(**given, **arguments)


def _entries(values) -> np.ndarray:
    """All numbers of a matrix or of a record, one after another."""
    parts = values if isinstance(values, tuple) else (values,)
    return np.concatenate([np.ravel(np.asarray(part, dtype=float)) for part in parts])


# Environments -------------------------------------------------------------------------------------


def requirements(without: str = "") -> list[str]:
    """The group `derive`, and numpy, which SymPy's printer asks for."""
    groups = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["dependency-groups"]
    return [one for one in groups["derive"] if not without or not one.startswith(without)] + ["numpy"]


def environment(name: str, python: str, wanted: list[str]) -> Path:
    """The interpreter of an environment with these packages, made when it is not there or has other ones."""
    folder = ENVIRONMENTS / name
    record = folder / "requirements.txt"
    interpreter = folder / "bin" / "python"
    if not record.exists() or record.read_text(encoding="utf-8").split("\n") != wanted:
        shutil.rmtree(folder, ignore_errors=True)
        if python == sys.executable:
            venv.create(folder, with_pip=True, symlinks=True)
        else:
            subprocess.run([python, "-m", "venv", folder], check=True)
        subprocess.run([interpreter, "-m", "pip", "install", "--quiet", *wanted], check=True)
        record.write_text("\n".join(wanted), encoding="utf-8")
    return interpreter


def _installed(interpreter: Path, package: str) -> str:
    command = [interpreter, "-c", f"from importlib.metadata import version; print(version({package!r}))"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def derived(interpreter: Path, hash_seed: int | None = None) -> Files:
    """All generated files as this interpreter derives them; its hash seed is a random one where none is given."""
    seed = "random" if hash_seed is None else str(hash_seed)
    environment = os.environ | {"PYTHONHASHSEED": seed}
    done = subprocess.run(
        [interpreter, "-c", _DERIVE], cwd=ROOT, env=environment, capture_output=True, text=True
    )
    if done.returncode:
        raise SystemExit(f"{interpreter}: the derivation failed\n{done.stderr[-4000:]}")
    return json.loads(done.stdout)


if __name__ == "__main__":
    sys.exit(main())
