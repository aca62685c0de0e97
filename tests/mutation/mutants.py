"""Every generated function with one value or one term changed: its sign, by one per cent, or left out."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import ModuleType

import proprotor_equations
from proprotor_equations import fused, published


def _flipped(value: ast.expr) -> ast.expr:
    return ast.UnaryOp(ast.USub(), value)


def _dropped(value: ast.expr) -> ast.expr:
    return ast.BinOp(ast.Constant(0), ast.Mult(), value)


def _scaled(value: ast.expr) -> ast.expr:
    return ast.BinOp(ast.Constant(1.01), ast.Mult(), value)


CHANGES: dict[str, Callable[[ast.expr], ast.expr]] = {
    "sign flipped": _flipped,
    "dropped": _dropped,
    "times 1.01": _scaled,
}


@dataclass(frozen=True)
class Mutant:
    """One change of one expression in a generated function.

    module is the name within `proprotor_equations`, entry what the statement gives a value to, expression what is
    changed, change one of `CHANGES`.
    """

    module: str
    function: str
    line: int
    entry: str
    expression: str
    change: str

    def __str__(self) -> str:
        return f"{self.module}.{self.function}:{self.line} {self.entry}: `{self.expression}` {self.change}"


def generated_modules() -> dict[str, ModuleType]:
    """Every generated module by its name within the package."""
    packages = {"": proprotor_equations, "published.": published, "fused.": fused}
    return {
        prefix + name: getattr(package, name)
        for prefix, package in packages.items()
        for name in package.__all__
        if isinstance(getattr(package, name), ModuleType) and getattr(package, name) not in packages.values()
    }


def generated_functions() -> list[tuple[str, str]]:
    """(module, function) of everything generated, in the order of the source."""
    return [
        (name, function.name)
        for name, module in generated_modules().items()
        for function in ast.parse(inspect.getsource(module)).body
        if isinstance(function, ast.FunctionDef) and not function.name.startswith("_")
    ]


class MutatedFunction:
    """A generated function as a syntax tree, one place of which can be changed at a time."""

    def __init__(self, module: str, name: str):
        self.module, self.name = module, name
        self._module = generated_modules()[module]
        tree = ast.parse(inspect.getsource(self._module))
        self._function = next(f for f in tree.body if isinstance(f, ast.FunctionDef) and f.name == name)
        self._function.body = [part for statement in self._function.body for part in _with_copy(statement)]
        self._tree = ast.Module([self._function], [])

    def mutants(self) -> Iterator[Mutant]:
        """All of them, in the order of the source."""
        for mutant, _, _ in self._places():
            yield mutant

    @contextmanager
    def each(self, wanted: Collection[int]) -> Iterator[Iterator[Mutant]]:
        """An iterator over mutants, by their places in the list of all, that puts each into the module in its turn."""
        original = getattr(self._module, self.name)
        try:
            yield self._put_in_place(wanted)
        finally:
            setattr(self._module, self.name, original)

    def _put_in_place(self, wanted: Collection[int]) -> Iterator[Mutant]:
        for place, (mutant, parent, field) in enumerate(self._places()):
            if place not in wanted:
                continue
            kept = getattr(parent, field)
            setattr(parent, field, CHANGES[mutant.change](kept))
            setattr(self._module, self.name, self._compiled())
            yield mutant
            setattr(parent, field, kept)

    def _compiled(self) -> Callable:
        namespace = vars(self._module).copy()
        exec(compile(ast.fix_missing_locations(self._tree), self.module, "exec"), namespace)
        return namespace[self.name]

    def _places(self) -> Iterator[tuple[Mutant, ast.AST, str]]:
        for statement in self._function.body:
            entry = _entry(statement)
            if entry is None:
                continue
            for parent, field in [(statement, "value"), *_terms(statement.value)]:
                expression = getattr(parent, field)
                if isinstance(expression, ast.Constant) and expression.value == 0:
                    continue
                text = ast.unparse(expression)
                for change in CHANGES:
                    mutant = Mutant(self.module, self.name, statement.lineno, entry, text, change)
                    yield mutant, parent, field


_OPERATORS = {"add": ast.Add, "subtract": ast.Sub, "multiply": ast.Mult, "divide": ast.Div}


def _with_copy(statement: ast.stmt) -> list[ast.stmt]:
    """`name = np.add(a, b, into[n])` as `name = a + b` and a copy, whose terms can be changed like all others."""
    call = getattr(statement, "value", None)
    if not (isinstance(statement, ast.Assign) and isinstance(call, ast.Call) and len(call.args) > 1):
        return [statement]
    *operands, into = call.args
    if not isinstance(into, ast.Subscript):
        return [statement]
    operation = call.func.attr
    value = (
        ast.UnaryOp(ast.USub(), *operands)
        if operation == "negative"
        else ast.BinOp(operands[0], _OPERATORS[operation](), operands[1])
    )
    name = statement.targets[0].id
    made = ast.Assign(statement.targets, value)
    copy = ast.Assign([ast.Subscript(into.value, into.slice, ast.Store())], ast.Name(name, ast.Load()))
    return [ast.copy_location(part, statement) for part in (made, copy)]


def _entry(statement: ast.stmt) -> str | None:
    """What a statement gives a value to; None where it computes nothing."""
    if isinstance(statement, ast.Assign):
        if isinstance(statement.targets[0], ast.Tuple):  # names for the members of a group
            return None
        text = ast.unparse(statement.targets[0])
        return None if text == "matrix" else text.removeprefix("matrix")
    if isinstance(statement, ast.Return) and not isinstance(statement.value, ast.Name | ast.Tuple):
        called = statement.value.func if isinstance(statement.value, ast.Call) else None
        return None if isinstance(called, ast.Name) else "result"
    return None


def _terms(value: ast.expr) -> Iterator[tuple[ast.BinOp, str]]:
    """Where the terms of all sums in an expression stand, however deep."""
    for node in ast.walk(value):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
            for field in ("left", "right"):
                operand = getattr(node, field)
                is_sum = isinstance(operand, ast.BinOp) and isinstance(operand.op, ast.Add | ast.Sub)
                if not is_sum:
                    yield node, field
