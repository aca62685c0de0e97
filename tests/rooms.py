"""The contract of the rooms of `src/proprotor`: which room may import which, and what each shows of itself.

    python -m tests.rooms             # print every breach; exit 1 if there is one
    python -m tests.rooms --imports   # print which room imports which

A file imports its own room and the rooms above that one in `ROOMS`. A room shows the names in ``__all__`` of its
``__init__``, its face: objects, or modules of the room whose public names all belong to the face. Other rooms import
nothing else of it. A name that only its own module uses starts with an underscore.
"""

from __future__ import annotations

import argparse
import ast
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

SOURCE = Path(__file__).parents[1] / "src" / "proprotor"
# From the ground up to the workbench: data flow from the first to the last.
ROOMS = (
    "errors", "typing", "needs", "units", "datum", "files", "compiled", "records", "nastran",
    "rotor", "support", "control", "model",
    "deck", "stability", "responses", "case", "study", "exchange", "tables", "calibration",
    "plots", "report", "explore", "commands",
)  # fmt: skip
# The one import of a room further down, deferred: a model's method that gives its modes.
EXCEPTION = ("model", "stability", "LinearModel.modes")
MOST_MODULES = 6  # beside the rooms
INTERFACE = ("__init__", "__main__", "interface")  # the package's own modules, which are no room


class Import(NamedTuple):
    """One name that a file imports from the package.

    file : of the importer, below the package; line; module : imported from, below the package; name : what of it, empty
    for a module as a whole; scope : the class or function in which the import stands
    """

    file: str
    line: int
    module: str
    name: str
    scope: str

    @property
    def origin(self) -> str:
        """The room of the importing file; empty for the package's own modules."""
        return room_of(self.file)

    @property
    def target(self) -> str:
        """The room of the imported module; empty for the package's own modules."""
        return room_of(self.module.partition(".")[0])


def room_of(file: str) -> str:
    """Return the room of a file by its path below the package."""
    first = Path(file).parts[0].removesuffix(".py")
    return "" if first in INTERFACE else first


@cache
def modules() -> dict[str, Path]:
    """Return every module by its dotted name below the package; a room's own name stands for its ``__init__``."""
    found = {}
    for path in sorted(SOURCE.rglob("*.py")):
        parts = path.relative_to(SOURCE).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


@cache
def tree_of(path: Path) -> ast.Module:
    """Return the syntax tree of a file."""
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def imports() -> tuple[Import, ...]:
    """Return every import of the package by itself, deferred and type-only ones included."""
    return tuple(one for path in modules().values() for one in _imports_below(tree_of(path), path, ()))


def _imports_below(node: ast.AST, path: Path, scope: tuple[str, ...]) -> Iterator[Import]:
    """Yield the imports in a part of a file."""
    for child in ast.iter_child_nodes(node):
        inner = scope
        if isinstance(child, ast.FunctionDef | ast.ClassDef | ast.AsyncFunctionDef):
            inner = (*scope, child.name)
        yield from _imports_of(child, path, ".".join(scope))
        yield from _imports_below(child, path, inner)


def _imports_of(node: ast.AST, path: Path, scope: str) -> Iterator[Import]:
    """Yield the imports of one statement."""
    file = path.relative_to(SOURCE).as_posix()
    if isinstance(node, ast.Import):
        for alias in node.names:
            if alias.name.startswith("proprotor."):
                yield Import(file, node.lineno, alias.name.removeprefix("proprotor."), "", scope)
    elif isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] == "proprotor":
        module = (node.module or "").partition(".")[2]
        for alias in node.names:
            inside = f"{module}.{alias.name}".strip(".")
            known = inside in modules()
            yield Import(file, node.lineno, inside if known else module, "" if known else alias.name, scope)


@cache
def face(room: str) -> tuple[str, ...]:
    """Return the names in ``__all__`` of a room; of a module that is a room of its own, its public names."""
    names = _all_of(tree_of(modules()[room]))
    if names is None and (SOURCE / f"{room}.py").exists():
        return tuple(_defined(room))
    return names or ()


def _all_of(tree: ast.Module) -> tuple[str, ...] | None:
    """Return what ``__all__`` lists in a module, or None without one."""
    for node in tree.body:
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "__all__":
            return tuple(ast.literal_eval(node.value))
    return None


def _defined(module: str) -> dict[str, int]:
    """Return the public-looking names that a module defines at its top level, with their lines."""
    found = {}
    for node in tree_of(modules()[module]).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            found[node.name] = node.lineno
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            found |= {
                name.id: node.lineno
                for target in targets
                for name in ast.walk(target)
                if isinstance(name, ast.Name)
            }
    return {name: line for name, line in found.items() if not name.startswith("_")}


def _in_face(module: str, name: str) -> bool:
    """Return whether other rooms may import a name of a module; a room as a whole, always."""
    room, _, inner = module.partition(".")
    shown = face(room)
    by_module = inner.partition(".")[0] in shown and not name.startswith("_")
    return by_module or (name in shown if name else not inner)


def _between_rooms() -> Iterator[Import]:
    """Yield the imports of one room by another; the imports of the one exception are left out."""
    for one in imports():
        if one.origin not in ("", one.target) and (one.origin, one.target, one.scope) != EXCEPTION:
            yield one


def upward() -> list[str]:
    """Return the imports of a room by a room above it."""
    return [
        f"{one.file}:{one.line}: {one.origin} imports {one.module} {one.name}, which lies below"
        for one in _between_rooms()
        if ROOMS.index(one.target) > ROOMS.index(one.origin)
    ]


def not_shown() -> list[str]:
    """Return the imports of another room's names that are not in that room's face."""
    return [
        f"{one.file}:{one.line}: {one.module} {one.name} is not in the face of {one.target}"
        for one in imports()
        if one.origin != one.target and not _in_face(one.module, one.name)
    ]


def looks_public() -> list[str]:
    """Return public-looking names that neither a face nor another module of the room knows."""
    known = {(one.module, one.name) for one in imports() if one.name}
    wholes = {(one.origin, one.module) for one in imports() if not one.name}
    found = []
    for module in modules():
        room, _, inner = module.partition(".")
        if not inner or (room, module) in wholes:
            continue
        for name, line in _defined(module).items():
            if (module, name) not in known and not _in_face(module, name):
                found.append(f"{module}:{line}: {name} is used by its own module alone, or by none")
    return found


def beside_rooms() -> list[str]:
    """Return what is wrong with the modules beside the rooms: unknown ones, or too many."""
    alone = sorted(path.stem for path in SOURCE.glob("*.py") if path.stem not in INTERFACE)
    found = [
        f"{name}.py: stands beside the rooms, and is none of {ROOMS}" for name in alone if name not in ROOMS
    ]
    if len(alone) > MOST_MODULES:
        found.append(f"{len(alone)} modules beside the rooms, more than {MOST_MODULES}")
    return found + [
        f"{room}: is no room"
        for room in sorted({room_of(str(p.relative_to(SOURCE))) for p in modules().values()} - {"", *ROOMS})
    ]


def cycles() -> list[str]:
    """Return the pairs of rooms that import each other."""
    pairs = {(one.origin, one.target) for one in _between_rooms()}
    return [f"{a} and {b} import each other" for a, b in sorted(pairs) if a < b and (b, a) in pairs]


CHECKS = {
    "imports of a room further down": upward,
    "pairs of rooms that import each other": cycles,
    "modules that belong to no room": beside_rooms,
    "imports of what a room does not show": not_shown,
    "public-looking names outside the faces": looks_public,
}


def main() -> int:
    """Print every breach of the contract, and how many there are of each kind."""
    parser = argparse.ArgumentParser(prog="python -m tests.rooms", description=__doc__)
    parser.add_argument("--imports", action="store_true", help="print which room imports which")
    if parser.parse_args().imports:
        for room in ROOMS:
            targets = {one.target for one in imports() if one.origin == room} - {room}
            print(f"{room:10} imports {', '.join(sorted(targets, key=ROOMS.index)) or 'nothing'}")
        return 0
    found = {name: check() for name, check in CHECKS.items()}
    for breaches in found.values():
        print(*breaches, sep="\n", end="\n" if breaches else "")
    for name, breaches in found.items():
        print(f"{len(breaches):4} {name}")
    return int(any(found.values()))


if __name__ == "__main__":
    sys.exit(main())
