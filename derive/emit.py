"""Print the intermediate form and render it: derivation in, `generated/proprotor_equations` out.

Expressions are printed here, by one printer; the templates only lay them out; the formatter makes lines readable.
"""

from __future__ import annotations

import ast
import dataclasses
import difflib
import functools
import hashlib
import itertools
import re
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, cast

import jinja2
import sympy as sp
from sympy.printing.numpy import NumPyPrinter

from derive import c_code, coordinates, multiblade
from derive.coordinates import PARTNER, SAME_TURN
from derive.equations import REDUCED_MODULES, STEPS, consistent_functions, reduced_functions
from derive.files import write_whole
from derive.function import Function
from derive.fused import FusedFunction, functions_of_rotor
from derive.fused_trim import functions_of_trim
from derive.plain import ALL_ROTORS, ON_AXIS, PLAIN_ROTORS, Catalogue
from derive.plan import print_line
from derive.published import DROPPED_TERMS
from derive.rotor import OF_SEGMENTS, OFFSETS, OPTIONAL, Assembly, Call
from derive.symbols import QUANTITIES

ROOT = Path(__file__).resolve().parent.parent
TEMPLATES = ROOT / "templates"
GENERATED = ROOT / "generated" / "proprotor_equations"

Place = tuple[str, str]  # row and column of an entry
Progress = Callable[[str], None]  # takes a line for each step


class ArrayPrinter(NumPyPrinter):  # type: ignore[misc]  # SymPy has no types
    """NumPy code with ``np.`` in front; entries of blade matrices broadcast over leading axes."""

    _module = "np"
    _kf = {name: f"np.{path.rpartition('.')[2]}" for name, path in NumPyPrinter._kf.items()}  # noqa: RUF012
    _kc = {name: f"np.{path.rpartition('.')[2]}" for name, path in NumPyPrinter._kc.items()}  # noqa: RUF012

    def _print_Pow(self, expr: sp.Pow, rational: bool = False) -> str:
        """NumPy squares quickly, but takes a general power for any other exponent."""
        base, exponent = expr.as_base_exp()
        if exponent == 3 and base.is_Symbol:
            return f"{self._print(base)}**2*{self._print(base)}"
        if exponent == -3 and base.is_Symbol:
            return f"1/({self._print(base)}**2*{self._print(base)})"
        printed: str = super()._print_Pow(expr, rational=rational)
        return printed

    def _print_Mul(self, expr: sp.Mul) -> str:
        """A cube is printed as a product, so below a fraction bar it needs brackets."""
        printed: str = super()._print_Mul(expr)
        return re.sub(r"/(\w+)\*\*2\*\1\b", r"/(\1**2*\1)", printed)

    def _print_Indexed(self, expr: sp.Indexed) -> str:
        row, column = expr.indices
        return f"{expr.base.label}[..., {row}, {column}]"

    def _print_Transpose(self, expr: sp.Transpose) -> str:
        return f"np.swapaxes({self._print(expr.arg)}, -1, -2)"

    def _print_MatMul(self, expr: sp.MatMul) -> str:
        sign, factors = expr.as_coeff_matrices()
        product = " @ ".join(self._print(factor) for factor in factors)
        return f"-({product})" if sign == -1 else product


def print_code(expression: sp.Expr) -> str:
    printed: str = ArrayPrinter({"fully_qualified_modules": True}).doprint(expression)
    if "Not supported" in printed:
        raise ValueError(f"cannot print {expression}")
    return printed


def argument_lines(function: Function) -> list[dict[str, str]]:
    """Name, unit and meaning of each argument, for the docstring."""
    lines = []
    for symbol in function.arguments:
        if function.product is not None:
            shape = f"(..., segments, {symbol.shape[0]}, {symbol.shape[1]})"
            lines.append({"name": symbol.name, "unit": shape, "meaning": f"see `{symbol.name}`"})
        else:
            quantity = QUANTITIES[symbol]
            lines.append({"name": symbol.name, "unit": quantity.unit or "-", "meaning": quantity.meaning})
    return lines


# An entry of more operations than this refers to its mirror image, if it is equal or opposite to it.
_SHORT = 2


def printed_entries(function: Function) -> list[dict[str, str]]:
    """Assignments of a matrix; every entry shows its formula but a long one that mirrors an earlier entry."""
    lines, equation = [], None
    for place, entry in function.entries.items():
        told = entry.equation if entry.equation != equation else ""
        code = _mirrored(function, place) or print_code(entry.value)
        lines.append({"place": _printed_place(function, place), "code": code, "equation": told})
        equation = entry.equation
    return lines


def _printed_place(function: Function, place: Place) -> str:
    row, column = place
    return f"matrix[..., {function.row_prefix}{row.upper()}, {column.upper()}]"


def _mirrored(function: Function, place: Place) -> str:
    """The earlier entry that a long one mirrors, with its sign; empty where there is none."""
    mirror, sign = _mirror(function, place)
    return "" if mirror is None else f"{'-' * (sign < 0)}{_printed_place(function, mirror)}"


def _mirror(function: Function, place: Place) -> tuple[Place | None, int]:
    value = function.entries[place].value
    if sp.count_ops(value) <= _SHORT:
        return None, 1
    places = list(function.entries)
    earlier = places[: places.index(place)]
    for other in _images(place):
        if other in earlier:
            for sign in (1, -1):
                if sp.expand(value - sign * function.entries[other].value) == 0:
                    return other, sign
    return None, 1


def _images(place: Place) -> Iterator[Place]:
    """Places that mirror one: transposed, turned by a quarter of the rotor, or of another turn of the blade like it."""
    row, column = place
    for left, right in itertools.product(
        (row, SAME_TURN.get(row, row)), (column, SAME_TURN.get(column, column))
    ):
        yield left, right
        yield right, left
    if row in PARTNER and column in PARTNER:
        yield PARTNER[row], PARTNER[column]
        yield PARTNER[column], PARTNER[row]


def operations(function: Function) -> int:
    """Arithmetic operations per point, as printed."""
    expressions = [value for _, value in function.steps]
    for place, entry in function.entries.items():
        if _mirror(function, place)[0] is None:
            expressions.append(entry.value)
    return int(sum(sp.count_ops(expression) for expression in expressions))


def describe(function: Function) -> dict[str, Any]:
    """Everything the template needs, printed."""
    if isinstance(function, Assembly):
        return _describe_assembly(function)
    return {
        "name": function.name,
        "summary": function.summary,
        "origin": function.origin,
        "arguments": argument_lines(function),
        "steps": [{"name": str(symbol), "code": print_code(value)} for symbol, value in function.steps],
        "values": [
            {"name": str(v), "unit": QUANTITIES[v].unit or "-", "meaning": QUANTITIES[v].meaning}
            for v in function.values
        ],
        "tuple_name": _tuple_name(function.name),
        "rows": function.rows,
        "columns": function.columns,
        "entries": printed_entries(function),
        "blade_matrices": function.blade_matrices,
        "product": print_code(function.product) if function.product is not None else "",
        "shape": getattr(function.product, "shape", (len(function.rows), len(function.columns))),
    }


def _tuple_name(function: str) -> str:
    return "".join(part.capitalize() for part in function.split("_"))


def _describe_assembly(assembly: Assembly) -> dict[str, Any]:
    """The same of a function that calls others."""
    arguments = [
        {
            "name": symbol.name,
            "unit": QUANTITIES[symbol].unit or "-",
            "meaning": QUANTITIES[symbol].meaning + ", (..., segments)" * (symbol in OF_SEGMENTS),
            "optional": symbol in OPTIONAL,
        }
        for symbol in assembly.arguments
    ]
    along = [symbol.name for symbol in assembly.arguments if symbol not in OF_SEGMENTS]
    last = assembly.lines[-1].terms[0]
    returned = assembly if assembly.results else cast(Call, last).function
    return {
        "name": assembly.name,
        "summary": assembly.summary,
        "origin": assembly.origin,
        "arguments": arguments,
        "blade_matrices": assembly.blade_matrices,
        "chooses_equations": assembly.chooses_equations,
        "along": along if assembly.segments else [],
        "lines": _printed_lines(assembly),
        "results": list(assembly.results.items()),
        "returns": _tuple_name(returned.name),
        "tuple_name": _tuple_name(assembly.name),
    }


def _printed_lines(assembly: Assembly) -> list[dict[str, str]]:
    """Each line as an assignment; what it gives is known by its name, or by the names of its fields."""
    known: dict[str, str] = {}
    lines = []
    for line in assembly.lines:
        terms = [_printed_call(term, known) if isinstance(term, Call) else str(term) for term in line.terms]
        lines.append({"name": line.result, "code": " + ".join(terms)})
        fields = [name for term in line.terms if isinstance(term, Call) for name in term.results]
        known |= {name: f"{line.result}.{name}" for name in fields} or {line.result: line.result}
    return lines


def _printed_call(call: Call, known: Mapping[str, str]) -> str:
    """A call by keywords, from what is known or the arguments of the same names."""
    function = call.function
    if isinstance(function, Assembly):
        place = ""
    else:
        place = f"equations.{function.module}." if call.drops else f"_{function.module}."
    given = [known.get(name, name) for name in function.blade_matrices]
    given += [f"{symbol.name}={known.get(symbol.name, symbol.name)}" for symbol in function.arguments]
    if isinstance(function, Assembly) and function.chooses_equations:
        given.append("equations=equations")
    return f"{place}{function.name}({', '.join(given)})"


def _describe_fused(function: FusedFunction) -> dict[str, Any]:
    """Everything the template needs of a plan."""
    return {
        "name": function.name,
        "summary": function.summary,
        "operations": function.plan.operations,
        "called": function.called,
        "into": function.into,
        "groups": [{"name": g.name, "meaning": g.meaning, "members": g.members} for g in function.groups],
        "arguments": [
            {
                "name": symbol.name,
                "unit": QUANTITIES[symbol].unit or "-",
                "meaning": QUANTITIES[symbol].meaning,
                "optional": symbol in OPTIONAL,
            }
            for symbol in function.arguments
        ],
        "lines": _lines_of(function),
        "results": function.plan.results,
        "layouts": list(function.plan.layouts.items()),
    }


def _lines_of(function: FusedFunction) -> list[dict[str, str]]:
    """Lines of a plan as code."""
    results = function.plan.results if function.into else []
    return [
        {"name": name, "code": _put(print_line(value), results.index(name))}
        if name in results
        else {"name": name, "code": print_line(value)}
        for name, value in function.plan.lines
    ]


_OPERATIONS = {
    ast.Add: "add",
    ast.Sub: "subtract",
    ast.Mult: "multiply",
    ast.Div: "divide",
    ast.USub: "negative",
}


def _put(code: str, place: int) -> str:
    """Code that puts a result into an array: the last operation does so itself, which takes no copy."""
    last = ast.parse(code, mode="eval").body
    if isinstance(last, ast.BinOp):
        given = f"{ast.unparse(last.left)}, {ast.unparse(last.right)}"
    elif isinstance(last, ast.UnaryOp):
        given = ast.unparse(last.operand)
    else:
        return f"np.positive({code}, into[{place}])"
    return f"np.{_OPERATIONS[type(last.op)]}({given}, into[{place}])"


_FUSED = {
    "plain": ("Plain rotors, without linkages and drive train, as plans of few operations", PLAIN_ROTORS),
    "general": ("Rotors with linkages and drive train as plans of few operations", ON_AXIS),
    "offset": ("Rotors with something beside the pitch axis as plans of few operations", ALL_ROTORS),
}
_IN_C = ("plain", "general")


def render_fused(module: str) -> str:
    """Text of a module of fused functions; those that an earlier module has are taken from there."""
    title, rotors = _FUSED[module]
    functions = _fused_functions(rotors)
    shared: dict[str, list[FusedFunction]] = {}
    for earlier, (_, others) in itertools.takewhile(lambda entry: entry[0] != module, _FUSED.items()):
        known = [one for found in shared.values() for one in found]
        same = [one for one in functions if one in _fused_functions(others) and one not in known]
        shared |= {earlier: same} if same else {}
    taken = [one for found in shared.values() for one in found]
    given = {
        "title": title,
        "module": module,
        "functions": [_describe_fused(function) for function in functions if function not in taken],
        "shared": {earlier: _names_of(found) for earlier, found in shared.items()},
        "names": _names_of(functions),
        "quantities": [quantity["name"] for quantity in c_code.places(functions)] if module in _IN_C else [],
        "takes_array": any(function.into for function in functions if function not in taken),
        "absent": [symbol.name for symbol in QUANTITIES if symbol in rotors.absent - OFFSETS],
    }
    return _rendered("fused.py.jinja", f"fused/{module}.py", **given)


def _names_of(functions: list[FusedFunction]) -> list[str]:
    """Names of functions and of their tables."""
    return sorted(name for function in functions for name in (function.name.upper(), function.name))


@functools.cache
def _fused_functions(rotors: Catalogue) -> list[FusedFunction]:
    return [*functions_of_rotor(rotors), *functions_of_trim(rotors)]


def render_c(module: str) -> str:
    """Text of a header of C with the plans of a module."""
    title, rotors = _FUSED[module]
    functions = _fused_functions(rotors)
    given = {
        "title": title,
        "module": module,
        "quantities": c_code.places(functions),
        "functions": [c_code.described(function) for function in functions],
    }
    return _environment().get_template("plans.h.jinja").render(**given, **_header())


def _rendered(template: str, name: str, **given: Any) -> str:
    """Text of a template, formatted."""
    return formatted(_environment().get_template(template).render(**given, **_header()), name)


def coordinate_lists() -> list[dict[str, Any]]:
    """The records of `derive.coordinates`, list by list."""
    return [
        {
            "name": name,
            "meaning": meaning,
            "records": [
                {"kind": type(record).__name__, "fields": _fields(record)}
                for record in getattr(coordinates, name)
            ],
        }
        for name, meaning in coordinates.LISTS.items()
    ]


def _fields(record: coordinates.Named) -> list[tuple[str, Any]]:
    """Fields of a record, name first and unit last."""
    fields = dataclasses.asdict(record)
    unit = fields.pop("unit")
    return [*fields.items(), ("unit", unit)]


def index_groups(functions: list[Function]) -> list[dict[str, str | int]]:
    """Row and column names of a module's matrices as index constants, one group per list of names."""
    groups: dict[tuple[str, ...], None] = {}
    for function in functions:
        rows = tuple(f"{function.row_prefix}{row}" for row in function.rows)
        groups |= dict.fromkeys(names for names in (rows, function.columns) if names)
    if any(function.blade_matrices for function in functions):
        for indices in (multiblade.BLADE_INDEX, multiblade.GUST_INDEX):
            groups[tuple(symbol.name for symbol in indices.values())] = None
    constants: dict[str, int] = {}
    for names in groups:
        for place, name in enumerate(names):
            if constants.setdefault(name, place) != place:
                raise ValueError(f"{name} would be two indices in one module")
    return [{"name": name.upper(), "place": place} for name, place in constants.items()]


def derivation_hash() -> str:
    """Digest of the derivation and the templates, so that a file says what made it."""
    digest = hashlib.sha256()
    for path in [*sorted((ROOT / "derive").glob("*.py")), *sorted(TEMPLATES.glob("*.jinja"))]:
        digest.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()[:16]


def formatted(source: str, name: str) -> str:
    """The source as the formatter lays it out."""
    command = [
        sys.executable,
        "-m",
        "ruff",
        "format",
        "--isolated",
        "--line-length",
        "110",
        "--stdin-filename",
        name,
        "-",
    ]
    return subprocess.run(command, input=source, capture_output=True, text=True, check=True).stdout


def _environment() -> jinja2.Environment:
    return jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
    )


def render_module(functions: list[Function], title: str, template: str = "module.py.jinja") -> str:
    """Text of one generated module, formatted; dimensions are checked on the way."""
    for function in functions:
        function.check_dimensions()
    calls = [call for function in functions if isinstance(function, Assembly) for call in function.calls]
    text = (
        _environment()
        .get_template(template)
        .render(
            title=title,
            functions=[describe(function) for function in functions],
            indices=index_groups(functions),
            **({} if calls else {"operations": sum(operations(function) for function in functions)}),
            records=coordinate_lists(),
            modules=list(
                dict.fromkeys(call.function.module for call in calls if call.function.module != "rotor")
            ),
            choices=REDUCED_MODULES,
            **_header(),
        )
    )
    return formatted(text, "module.py")


def _header() -> dict[str, str]:
    return {"sympy_version": sp.__version__, "derivation": derivation_hash()}


def render() -> Iterator[tuple[str, str]]:
    """File name and text of every generated module, one step of the derivation after another."""
    for module, step in STEPS.items():
        yield f"{module}.py", render_module(consistent_functions(module), step.title, step.template)
    for module in REDUCED_MODULES:
        title = f"{STEPS[module].title}, as published"
        yield f"published/{module}.py", render_module(reduced_functions(module), title)
    for module in _FUSED:
        yield f"fused/{module}.py", render_fused(module)
    for module in _IN_C:
        yield f"fused/{module}.h", render_c(module)
    yield "fused/lanes.h", _environment().get_template("lanes.h.jinja").render(**_header())
    yield "fused/__init__.py", _rendered("fused_package.py.jinja", "__init__.py")
    yield "__init__.py", _rendered("package.py.jinja", "__init__.py", modules=list(STEPS))
    terms = [{"name": n, **vars(term)} for n, term in DROPPED_TERMS.items()]
    text = _rendered("published.py.jinja", "__init__.py", modules=REDUCED_MODULES, terms=terms)
    yield "published/__init__.py", text


def derive_files(progress: Progress = print) -> dict[str, str]:
    """All generated files, with a progress line per step."""
    files, total = {}, len(STEPS) + len(REDUCED_MODULES) + len(_FUSED) + len(_IN_C) + 4
    start = time.perf_counter()
    for count, (name, text) in enumerate(render(), start=1):
        files[name] = text
        progress(
            f"[{count}/{total}] {name:<24} {len(text.splitlines()):>5} lines  {time.perf_counter() - start:6.1f} s"
        )
    return files


def generated_paths(folder: Path) -> set[str]:
    """Files below the generated package, by their path in it."""
    files = (path for path in folder.rglob("*") if path.is_file() and "__pycache__" not in path.parts)
    return {path.relative_to(folder).as_posix() for path in files}


def update(folder: Path = GENERATED, progress: Progress = print) -> None:
    """Rewrite the generated package; files that nothing generates any more are removed.

    Everything is derived before the first file is written, and a file is whole or as it was: a run that is stopped
    leaves files of both derivations at worst, which a check tells.
    """
    files = derive_files(progress)
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        write_whole(folder / name, text)
    for orphan in generated_paths(folder) - set(files):
        (folder / orphan).unlink()


def differences(folder: Path = GENERATED, progress: Progress = print) -> list[str]:
    """What a check finds: a diff for each stale or hand-edited file, a line for each missing or orphan one."""
    files = derive_files(progress)
    found = [f"missing: {name}" for name in sorted(set(files) - generated_paths(folder))]
    found += [f"orphan: {name}" for name in sorted(generated_paths(folder) - set(files))]
    for name in sorted(set(files) & generated_paths(folder)):
        present = (folder / name).read_text(encoding="utf-8")
        if present != files[name]:
            diff = difflib.unified_diff(
                present.splitlines(),
                files[name].splitlines(),
                f"generated/{name}",
                f"derived/{name}",
                lineterm="",
            )
            found.append("\n".join(diff))
    return found
