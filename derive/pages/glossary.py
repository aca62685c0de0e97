"""Write docs/symbols.md, the glossary of the symbols of the derivation.

python -m derive.pages.glossary            write the page
python -m derive.pages.glossary --check    write nothing; exit 1 if the page is stale

Every symbol is declared once, with its unit and meaning, in the module where it is first needed; the page has the same
order.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import sympy as sp

from derive.equations import STEPS
from derive.files import write_whole
from derive.symbols import QUANTITIES, Quantity

PAGE = Path(__file__).resolve().parents[2] / "docs" / "symbols.md"
# Where symbols are declared, in the order of the derivation: a symbol belongs to the first module that has it.
TITLES = {
    "symbols": "Inputs and trim",
    "kinematics": "Kinematics",
    **{name: step.title for name, step in STEPS.items()},
    "fused_trim": "Sections with a straight lift line, in the fused trim",
}

HEAD = """\
# Symbols

Written by `python -m derive.pages.glossary` from the declarations in `derive/`. The name is the keyword argument of the
[generated functions](reference/equations.md) and, for inputs, the field of [a deck](decks.md). SI units; angles are in
rad. Signs and axes are those of [the conventions](theory/conventions.md).
"""


def _symbols_in(value: Any) -> Iterator[sp.Symbol]:
    """Yield the symbols in a value of a module: a symbol, or a collection with symbols."""
    if isinstance(value, sp.Symbol):
        yield value
    elif isinstance(value, dict):
        for entry in value.values():
            yield from _symbols_in(entry)
    elif isinstance(value, list | tuple):
        for entry in value:
            yield from _symbols_in(entry)


def by_module() -> dict[str, list[Quantity]]:
    """Return every declared quantity by the module that declares it, in the order of declaration.

    Raises
    ------
    LookupError
        If a quantity is in no module of `TITLES`.
    """
    declared: dict[sp.Symbol, str] = {}
    for name in TITLES:
        module = importlib.import_module(f"derive.{name}")
        for symbol in _symbols_in(list(vars(module).values())):
            declared.setdefault(symbol, name)
    importlib.import_module("derive.equations")
    homeless = [str(symbol) for symbol in QUANTITIES if symbol not in declared]
    if homeless:
        raise LookupError(f"in no module of the glossary: {', '.join(homeless)}")
    found: dict[str, list[Quantity]] = {name: [] for name in TITLES}
    for symbol, quantity in QUANTITIES.items():
        found[declared[symbol]].append(quantity)
    return {name: quantities for name, quantities in found.items() if quantities}


def _row(quantity: Quantity) -> str:
    unit = quantity.unit.replace("^2", "²").replace("^3", "³")
    return f"| ${quantity.latex}$ | `{quantity.symbol.name}` | {unit or 'number'} | {quantity.meaning} |"


def page() -> str:
    """Return the glossary as Markdown."""
    sections = [HEAD]
    for name, quantities in by_module().items():
        rows = "\n".join(map(_row, quantities))
        sections.append(
            f"## {TITLES[name]}\n\n| symbol | name | unit | meaning |\n|---|---|---|---|\n{rows}\n"
        )
    return "\n".join(sections)


def main() -> int:
    """Run the command; return 1 if `--check` finds the page stale."""
    if "--check" in sys.argv[1:]:
        current = PAGE.read_text(encoding="utf-8") == page()
        print(
            "the glossary is current" if current else "the glossary is stale: python -m derive.pages.glossary"
        )
        return 0 if current else 1
    write_whole(PAGE, page())
    return 0


if __name__ == "__main__":
    sys.exit(main())
