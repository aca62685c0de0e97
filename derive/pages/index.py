"""The index of the paper's equations: print, derivation, generated function and notebook of each, in docs/equations.md.

python -m derive.pages.index            write the page
python -m derive.pages.index --check    write nothing; exit 1 if the page is stale

Every place is found in the sources: the print and the counterpart by their numbers, the derivation by what the
counterpart calls, generated functions by the equations their docstrings name, notebook cells by their headings.
"""

from __future__ import annotations

import ast
import csv
import functools
import re
import sys
from collections import Counter, deque
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import cast

from derive import equations
from derive.audit import printed
from derive.audit.comparison import VERDICTS
from derive.audit.headings import anchor, heading
from derive.audit.report import LETTERS, RECORD
from derive.files import write_whole
from derive.pages.notebooks import page_of, sources

ROOT = Path(__file__).resolve().parents[2]
DERIVE = ROOT / "derive"
AUDIT = DERIVE / "audit"
GENERATED = ROOT / "generated" / "proprotor_equations"
PAGE = ROOT / "docs" / "equations.md"
COUNTERPARTS = "counterparts"
# Steps of the derivation; what only declares symbols, holds polynomials or prints is none.
STEPS = ("kinematics", *equations.STEPS)

Number = int | str


@dataclass(frozen=True, order=True)
class Place:
    """A line of a file, with a name for it."""

    name: str
    path: Path
    line: int

    @property
    def link(self) -> str:
        up = "" if self.path.is_relative_to(PAGE.parent) else "../"
        base = PAGE.parent if self.path.is_relative_to(PAGE.parent) else ROOT
        return f"[{self.name}]({up}{self.path.relative_to(base).as_posix()}#L{self.line})"


def numbers() -> list[Number]:
    """Everything the paper numbers, and the two frequencies of its nomenclature."""
    tables = [f"Table {table.number}" for table in printed.TABLES]
    return [*printed.EQUATIONS, *printed.NOMENCLATURE, *tables]


@functools.cache
def _tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


def _definitions(path: Path) -> dict[str, ast.stmt]:
    """What a module defines, by name."""
    found: dict[str, ast.stmt] = {}
    for statement in _tree(path).body:
        if isinstance(statement, ast.FunctionDef | ast.ClassDef):
            found[statement.name] = statement
        elif isinstance(statement, ast.Assign | ast.AnnAssign):
            targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
            for name in (node for target in targets for node in ast.walk(target)):
                if isinstance(name, ast.Name):
                    found.setdefault(name.id, statement)
    return found


# Print


@functools.cache
def prints() -> dict[Number, Place]:
    """Where each equation and table is transcribed."""
    found: dict[Number, Place] = {}
    for path in sorted((AUDIT / "printed").glob("*.py")):
        for call in ast.walk(_tree(path)):
            if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.args:
                first = call.args[0]
                number = first.value if isinstance(first, ast.Constant) else None
                if call.func.id == "PrintedEquation" and isinstance(number, int | str):
                    found[number] = _place_in_print(path, call)
                elif call.func.id == "PrintedTable" and isinstance(number, int):
                    found[f"Table {number}"] = _place_in_print(path, call)
    return found


def _place_in_print(path: Path, call: ast.Call) -> Place:
    return Place(f"printed/{path.name}", path, call.lineno)


# Derivation


@functools.cache
def counterparts() -> dict[Number, Place]:
    """The function that derives each equation: that of `derive.audit.counterparts`, or of the tables' audit."""
    path = AUDIT / f"{COUNTERPARTS}.py"
    found: dict[Number, Place] = {}
    for function in _tree(path).body:
        if not isinstance(function, ast.FunctionDef):
            continue
        for decorator in function.decorator_list:
            if isinstance(decorator, ast.Call) and getattr(decorator.func, "id", "") == "counterpart":
                place = Place(f"{COUNTERPARTS}.{function.name}", path, function.lineno)
                found |= {ast.literal_eval(argument): place for argument in decorator.args}
    tables = AUDIT / "tables.py"
    table = Place("tables.audit_table", tables, _definitions(tables)["audit_table"].lineno)
    return found | {f"Table {of.number}": table for of in printed.TABLES}


def _aliases(path: Path) -> dict[str, str]:
    """Modules of the derivation by the name they are imported under."""
    found: dict[str, str] = {}
    for statement in _tree(path).body:
        if isinstance(statement, ast.ImportFrom) and statement.module == "derive":
            found |= {name.asname or name.name: name.name for name in statement.names if name.name in STEPS}
    return found


@functools.cache
def derivations(number: Number) -> tuple[Place, ...]:
    """Steps of the derivation that a counterpart calls, nearest first; constants where it calls no function."""
    start = counterparts()[number]
    names = _used(start.path, start.name.partition(".")[2])
    places = [(_place_of_step(*name), name) for name in names]
    functions = [place for place, name in places if _is_function(*name)]
    return tuple(functions or [place for place, _ in places])


def _used(path: Path, name: str) -> list[tuple[str, str]]:
    """(module, name) of the derivation in the order they are met, through the module's own functions."""
    known, aliases = _definitions(path), _aliases(path)
    queue, seen = deque([name]), {name}
    found: dict[tuple[str, str], None] = {}
    while queue:
        for node in _in_order(known[queue.popleft()]):
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                if node.value.id in aliases:
                    found.setdefault((aliases[node.value.id], node.attr))
            elif isinstance(node, ast.Name) and node.id in known and node.id not in seen:
                seen.add(node.id)
                queue.append(node.id)
    return list(found)


def _in_order(node: ast.AST) -> Iterator[ast.AST]:
    """Nodes as they stand in the text, without decorators."""
    for name, value in ast.iter_fields(node):
        if name == "decorator_list":
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST):
                yield child
                yield from _in_order(child)


def _definition_of_step(module: str, name: str) -> ast.stmt:
    return _definitions(DERIVE / f"{module}.py")[name]


def _is_function(module: str, name: str) -> bool:
    return isinstance(_definition_of_step(module, name), ast.FunctionDef | ast.ClassDef)


def _place_of_step(module: str, name: str) -> Place:
    return Place(f"{module}.{name}", DERIVE / f"{module}.py", _definition_of_step(module, name).lineno)


# Generated functions


_EQUATIONS = re.compile(r"Eqs?\. ((?:\d+(?:-\d+)?(?:, | and )?)+)")
_SOURCE = re.compile(r"Source: (.*)")


def equations_named(text: str) -> set[int]:
    """Numbers of `Eq. 17` and `Eqs. 2, 3, 14-16 and 32`."""
    found: set[int] = set()
    for listed in _EQUATIONS.findall(text):
        for first, last in re.findall(r"(\d+)(?:-(\d+))?", listed):
            found |= set(range(int(first), int(last or first) + 1))
    return found


@functools.cache
def generated_functions() -> dict[Place, str]:
    """Every generated function with the source its docstring gives."""
    found = {}
    for path in sorted(GENERATED.rglob("*.py")):
        module = ".".join(path.relative_to(GENERATED).with_suffix("").parts)
        for function in _tree(path).body:
            if isinstance(function, ast.FunctionDef) and not function.name.startswith("_"):
                source = _SOURCE.search(ast.get_docstring(function) or "")
                place = Place(f"{module}.{function.name}", path, function.lineno)
                found[place] = source.group(1) if source else ""
    return found


def generated(number: Number) -> tuple[Place, ...]:
    """Functions whose docstring names the equation, or the nomenclature where it has no number."""
    if isinstance(number, int):
        return tuple(of for of, source in generated_functions().items() if number in equations_named(source))
    return tuple(of for of, source in generated_functions().items() if "nomenclature" in source)


@functools.cache
def _emitted() -> dict[str, set[tuple[str, str]]]:
    """What of the derivation each line of `derive.equations` is made from, by module.name."""
    path = DERIVE / "equations.py"
    aliases = _aliases(path)
    found: dict[str, set[tuple[str, str]]] = {}
    known = _definitions(path)
    for step in ast.walk(_tree(path)):
        if isinstance(step, ast.Call) and getattr(step.func, "id", "") == "Step":
            module, lines = ast.literal_eval(step.args[0]), known[cast(ast.Name, step.args[2]).id]
            for call in ast.walk(lines):
                if isinstance(call, ast.Call) and call.args and isinstance(call.args[0], ast.Constant):
                    found.setdefault(f"{module}.{call.args[0].value!s}", set()).update(
                        (aliases[node.value.id], node.attr)
                        for node in ast.walk(call)
                        if isinstance(node, ast.Attribute)
                        and isinstance(node.value, ast.Name)
                        and node.value.id in aliases
                    )
    return found


@functools.cache
def _reached(module: str, name: str) -> frozenset[tuple[str, str]]:
    """A step of the derivation and the functions it uses, of its own module and of others."""
    found, queue = {(module, name)}, deque([(module, name)])
    while queue:
        of, name = queue.popleft()
        path = DERIVE / f"{of}.py"
        known, aliases = _definitions(path), _aliases(path)
        if name not in known:
            continue
        for node in ast.walk(known[name]):
            step = None
            if isinstance(node, ast.Name) and node.id in known:
                step = (of, node.id)
            elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                step = (aliases[node.value.id], node.attr) if node.value.id in aliases else None
            if step and step not in found:
                found.add(step)
                queue.append(step)
    return frozenset(found)


def generated_from(number: Number) -> tuple[Place, ...]:
    """Functions made from the same step of the derivation, for an equation that no docstring names."""
    steps = {tuple(place.name.split(".", 1)) for place in derivations(number)}
    names = {name for name, used in _emitted().items() if any(steps & _reached(*step) for step in used)}
    return tuple(place for place in generated_functions() if place.name in names)


# Notebooks


@functools.cache
def cells() -> dict[str, tuple[str, str]]:
    """Title of the notebook and link to the cell, by heading."""
    found = {}
    for source in sources():
        text = source.read_text(encoding="utf-8")
        title = re.findall(r"^# # (.*)$", text, re.MULTILINE)[0]
        page = page_of(source).relative_to(PAGE.parent).as_posix()
        for name in re.findall(r"^# ### (.*)$", text, re.MULTILINE):
            found[name] = (title, f"{page}#{anchor(name)}")
    return found


# Page


@functools.cache
def recorded_verdicts() -> dict[str, Counter[str]]:
    """How many terms, or relations of a table, have each verdict in the record of the audit."""
    found: dict[str, Counter[str]] = {}
    with RECORD.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            found.setdefault(row["number"], Counter())[row["verdict"]] += 1
    return found


def page() -> str:
    """The index as Markdown."""
    lines = [
        "# Where each equation is",
        "",
        "Written by `python -m derive.pages.index`. Of each equation of AIAA-2002-1604: its transcription, the",
        "function that derives it and the steps of the derivation it calls, the generated functions whose docstrings",
        "name it, and the notebook cell that shows print and derivation side by side. Verdicts are the recorded ones",
        "of [the audit](audit.md).",
        "",
        *_overview(),
    ]
    for number in numbers():
        lines += ["", f"## {heading(number)}", "", *_entry(number)]
    return "\n".join(lines) + "\n"


def _overview() -> list[str]:
    by_notebook: dict[tuple[str, str], list[str]] = {}
    for name, (title, link) in cells().items():
        shown = f"[{name.removeprefix('Eq. ').removeprefix('Nomenclature ')}](#{anchor(name)})"
        by_notebook.setdefault((title, link.partition("#")[0]), []).append(shown)
    rows = [f"| [{title}]({link}) | {' '.join(names)} |" for (title, link), names in by_notebook.items()]
    return ["| notebook | equations |", "|---|---|", *rows]


def _entry(number: Number) -> Iterator[str]:
    known = printed.EQUATIONS | printed.NOMENCLATURE | {f"Table {t.number}": t for t in printed.TABLES}
    of, counts = known[number], recorded_verdicts()[str(number)]
    verdict = max(counts, key=VERDICTS.index)
    told = ", ".join(f"{counts[v]} {LETTERS[v]}" for v in VERDICTS if counts[v])
    yield f"{of.title[0].upper()}{of.title[1:]}, page {of.page}: **{verdict}** ({told})."
    yield ""
    title, cell = cells()[heading(number)]
    yield f"- print: {prints()[number].link}"
    steps = ", ".join(place.link for place in derivations(number))
    yield f"- derivation: {counterparts()[number].link}" + (f", from {steps}" if steps else "")
    named, made = generated(number), generated_from(number)
    for kind, wanted in (("generated", False), ("generated, published set", True)):
        links = [place.link for place in named if place.name.startswith("published.") == wanted]
        if links:
            yield f"- {kind}: {', '.join(links)}"
    if made and not named:
        yield f"- generated, from the same step: {', '.join(place.link for place in made)}"
    yield f"- notebook: [{title}]({cell})"


def main() -> int:
    text = page()
    if "--check" in sys.argv[1:]:
        stale = not PAGE.exists() or PAGE.read_text(encoding="utf-8") != text
        print(
            f"{PAGE.relative_to(ROOT)} is "
            + ("stale: python -m derive.pages.index" if stale else "as it should be")
        )
        return int(stale)
    write_whole(PAGE, text)
    print(f"written: {PAGE.relative_to(ROOT)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
