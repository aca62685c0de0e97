"""The comparison of generated equations between versions finds what differs. `make verify-versions` uses it."""

import inspect
from pathlib import Path

import pytest

from tests.verify import determinism


@pytest.fixture(scope="module")
def accepted():
    return {path: (determinism.GENERATED / path).read_text("utf-8") for path in determinism.generated_files()}


def test_every_function_is_compared_and_the_same_files_do_not_differ(accepted):
    functions, worst, where = determinism.compared(accepted, accepted)
    assert functions == sum(text.count("\ndef ") - text.count("\ndef _") for text in accepted.values())
    assert worst == 0 and where == "none"


@pytest.mark.parametrize(
    ("path", "old", "new"),
    [
        ("pitch.py", "pitch_inertia\n", "(1 + 1e-12) * pitch_inertia\n"),
        (
            "multiblade.py",
            "n_blades * (\n        (1 / 2) * mass[..., BLADE_HUB_I",
            "n_blades * (\n        0.500000000001 * mass[..., BLADE_HUB_I",
        ),
        ("airloads.py", "(-(np.swapaxes(", "(1 + 1e-12) * (-(np.swapaxes("),
        ("fused/plain.py", "    r7 = density * r7", "    r7 = (1 + 1e-12) * density * r7"),
    ],
)
def test_a_part_in_a_million_million_is_found(accepted, path, old, new):
    assert old in accepted[path]
    other = accepted | {path: accepted[path].replace(old, new, 1)}
    _, worst, where = determinism.compared(accepted, other)
    assert where.startswith((path.removesuffix(".py"), "rotor."))  # which calls the function that is changed
    assert worst > 5 * determinism.TOLERANCE


def test_shapes_are_read_from_a_docstring_with_its_indentation_and_without():
    """The compiler takes the indentation away from Python 3.13 on."""
    text = """Return a matrix.

    Parameters
    ----------
    mass : array (..., 3, 5)
    section : array (..., segments, 2, 4)
    group : [SI] 7 numbers
    """

    def function(mass, section, group): ...

    shapes = []
    for function.__doc__ in (text, inspect.cleandoc(text)):
        shapes.append([values.shape for values in determinism.random_arguments(function, 0).values()])
    assert shapes == [[(3, 5), (2, 2, 4), (7,)]] * 2


def test_the_same_number_that_is_not_finite_counts_as_a_difference(accepted):
    path = "pitch.py"
    other = {path: accepted[path].replace("pitch_inertia\n", "np.nan * pitch_inertia\n", 1)}
    _, worst, where = determinism.compared(accepted | other, accepted | other)
    assert worst == float("inf") and where.startswith(("pitch.", "rotor."))


def test_a_machine_without_a_second_python_is_told_so_in_one_line(accepted, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(determinism, "derived", lambda interpreter, hash_seed=None: accepted)
    monkeypatch.setattr(determinism, "environment", lambda *_: Path("python"))
    monkeypatch.setattr(determinism, "_installed", lambda *_: "1.99")
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("HOME", str(tmp_path))
    assert determinism.main([]) == 0
    told = capsys.readouterr().out.splitlines()
    assert sum("byte for byte" in line for line in told) == len(determinism.HASH_SEEDS) == len(told) - 2
    assert told[-1].startswith("A second Python: NOT shown, for 3.")


def test_interpreters_kept_by_pyenv_and_uv_are_found(tmp_path, monkeypatch):
    numbers = {}
    for place, number in (
        (".pyenv/versions/3.12.1/bin/python", (3, 12, 1)),
        (".local/share/uv/python/cpython-3.13.1-linux-x86_64-gnu/bin/python3", (3, 13, 1)),
        (".pyenv/versions/3.10.2/bin/python", (3, 10, 2)),
    ):
        path = tmp_path / place
        path.parent.mkdir(parents=True)
        path.touch()
        numbers[str(path)] = number
    monkeypatch.setattr(determinism, "_version_of", numbers.get)
    monkeypatch.setattr(determinism.sys, "version_info", (3, 11, 7))
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("HOME", str(tmp_path))
    assert sorted(map(numbers.get, determinism.other_pythons())) == [(3, 12, 1), (3, 13, 1)]


def test_another_text_is_shown_as_a_difference(accepted):
    other = accepted | {"trim.py": accepted["trim.py"].replace("import numpy as np", "import numpy", 1)}
    lines = list(determinism.differences(accepted, other))
    assert lines[:2] == ["--- generated/trim.py", "+++ derived/trim.py"]
    assert "-import numpy as np" in lines and "+import numpy" in lines
