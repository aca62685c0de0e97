"""Count the lines of code of a package, room by room; docstrings, comments and blank lines do not count.

    python -m benchmarks.code_lines [FOLDER]...

A folder is `src/proprotor` unless others are given, such as that of an earlier commit:

    git archive --prefix=before/ COMMIT src | tar -x -C ..
    python -m benchmarks.code_lines ../before/src/proprotor src/proprotor
"""

from __future__ import annotations

import ast
import io
import sys
import tokenize
from collections import Counter
from pathlib import Path

PACKAGE = Path(__file__).parents[1] / "src" / "proprotor"
_ALONE = "beside the rooms"
_NO_CODE = {
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENCODING,
    tokenize.ENDMARKER,
}


def code_lines(source: str) -> int:
    """Return the number of lines with code in a module; a statement that is a text alone is a docstring."""
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    code = {
        line
        for token in tokens
        if token.type not in _NO_CODE
        for line in range(token.start[0], token.end[0] + 1)
    }
    return len(code - _docstring_lines(source))


def _docstring_lines(source: str) -> set[int]:
    """Return the lines of statements that are a text alone."""
    return {
        line
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
        for line in range(node.lineno, (node.end_lineno or node.lineno) + 1)
    }


def by_room(folder: Path) -> Counter[str]:
    """Return the lines of code of each subfolder of a package, and of the modules beside the subfolders."""
    found: Counter[str] = Counter()
    for path in sorted(folder.rglob("*.py")):
        inside = path.relative_to(folder).parts
        found[inside[0] if len(inside) > 1 else _ALONE] += code_lines(path.read_text(encoding="utf-8"))
    return found


def main() -> None:
    """Print the lines of code of each folder given."""
    for folder in map(Path, sys.argv[1:] or [str(PACKAGE)]):
        rooms = by_room(folder)
        print(f"{rooms.total():6}  {folder}")
        for room in sorted(rooms):
            print(f"{rooms[room]:6}    {room}")


if __name__ == "__main__":
    main()
