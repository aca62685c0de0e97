"""What the derivation, the audit and the pages may import, and that the audit changes nothing of the runtime."""

import ast
from pathlib import Path

import pytest

DERIVE = Path(__file__).parents[2] / "derive"
FILES = sorted(DERIVE.rglob("*.py"))
ROOMS = ("derive", "derive.audit", "derive.pages")  # each may import itself and those before it


def room_of(name):
    return max((room for room in ROOMS if f"{name}.".startswith(f"{room}.")), key=len)


def imported(path):
    """Modules that a file imports, at its top or in a function."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (name.name for name in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield from (f"{node.module}.{name.name}" for name in node.names)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.relative_to(DERIVE).as_posix())
def test_a_file_imports_its_own_room_and_those_before(path):
    module = ".".join(path.relative_to(DERIVE.parent).with_suffix("").parts)
    for name in imported(path):
        if name.startswith("derive."):
            assert ROOMS.index(room_of(name)) <= ROOMS.index(room_of(module)), name


def test_the_consequences_alone_import_the_runtime_by_its_public_names_and_pages_its_style():
    users = {
        path: [name for name in imported(path) if name.partition(".")[0] == "proprotor"] for path in FILES
    }
    style = ("proprotor.plots.rests_on", "proprotor.plots.style.")
    for path, names in users.items():
        if path.parent == DERIVE / "pages":
            assert all(name.startswith(style) for name in names), path
    assert {path: names for path, names in users.items() if names and path.parent != DERIVE / "pages"} == {
        DERIVE / "audit" / "consequences.py": ["proprotor"]
    }


def test_nothing_is_patched_or_executed_from_text():
    for path in FILES:
        assert not any(name.startswith("unittest") for name in imported(path))
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
                assert node.func.id not in ("exec", "eval", "setattr"), path
            assert not (isinstance(node, ast.Attribute) and node.attr == "__dict__"), path
