"""The documentation's pages as tests read them: their blocks of code in order, and how each kind is run.

What a block is follows from its fence, or from its first line:

| block | what is done |
|---|---|
| ```python, ```{code-cell} | executed, all blocks of a page in one namespace |
| ```sh, or indented commands | each command is run in the page's folder |
| ```text after one of these | compared with what it printed |
| one that begins with `# name.toml` or `# name.csv` | written to the page's folder; a deck or a study is checked |
| one that begins with `# in name.toml` | the lines of a file that set the same keys are replaced |

Everything else is a block that nothing runs, unless `NOT_RUN` names it with the reason.
"""

from __future__ import annotations

import ast
import contextlib
import io
import re
import shlex
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from click.testing import CliRunner

from proprotor.commands.main import main
from proprotor.deck.file import read_tables
from proprotor.deck.validation import validate
from proprotor.study import is_study_file, read_study

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"

# Commands and blocks that no test of a page runs: how they begin, and why.
NOT_RUN = {
    "make": "a whole environment, or minutes; tests/project/test_readme.py holds the targets, CI runs most of them",
    "python -m benchmarks": "minutes; writes the tables and figures of pages",
    "proprotor explore": "a server, which its own tests start",
    "page = pp.explore(": "a notebook's cell; tests/explore/test_notebook.py has an event loop for it",
    "proprotor report": "half a minute each; tests/report/test_report.py makes reports",
    "pip install": "changes the environment; tests/verify/test_packaging.py installs both wheels",
    "source ": "the shell that a reader works in",
    "derive/ ──▶": "a drawing",
    "--- a/": "a change of the derivation, which tests/derive/test_add_a_term.py makes in a copy",
    "SOL 1": "a run of Nastran; tests/exchange/test_dmig_file.py puts the rotor's file on a structure",
    "python -m proprotor.compiled.single_file": "writes files; tests/compiled/test_single_file.py does so",
    "cc -O2": "needs a C compiler; tests/compiled/test_single_file.py has one, or is skipped",
    "cd solver": "needs Octave; the same test runs such a command where there is one",
    '#include "proprotor.h"': "the same test compiles and runs it",
    "program example": "the same test compiles and runs it where there is gfortran",
    "mass = ones(1, 1, 2)": "the same test runs it where there is Octave",
    "radius = {": "a line of a deck; tests/deck/test_deck.py reads such",
    "from distributed import Client": "needs a cluster at that address; tests/study/test_study_distributed.py has one",
}
# Pages that another test runs whole.
RUN_ELSEWHERE = {"notebooks": "tests/derive/test_notebooks.py runs the notebooks and compares what they show"}
INDENTED_COMMAND = re.compile(
    r"(\.venv/bin/)?(proprotor|python|make|git|cd|pip|source|eval|PYTHONPATH=|open) ?|make$"
)
FENCE = re.compile(r"^( {0,3})(`{3,}|~{3,})(\{?[\w-]*\}?)[^\n]*\n(.*?)^\1\2 *$", re.DOTALL | re.MULTILINE)
INDENTED = re.compile(r"(?:^|\n\n)((?:(?: {4}[^\n]*)(?:\n|$)+)+)")
DIRECTIVES = {
    "{toctree}",
    "{eval-rst}",
    "{math}",
    "{include}",
    "{literalinclude}",
    "{note}",
    "{warning}",
    "{tip}",
    "{admonition}",
}


@dataclass(frozen=True)
class Block:
    """A block of code of a page: its kind ("" when indented), its text and the line it begins at."""

    kind: str
    text: str
    line: int

    @property
    def first(self) -> str:
        return self.text.lstrip().partition("\n")[0]

    @property
    def reason_not_to_run(self) -> str | None:
        return next((why for start, why in NOT_RUN.items() if self.first.startswith(start)), None)


def pages() -> list[Path]:
    """The README and every page whose blocks are run here."""
    elsewhere = {"_build", "reference", *RUN_ELSEWHERE}
    found = (page for page in sorted(DOCS.rglob("*.md")) if page.relative_to(DOCS).parts[0] not in elsewhere)
    return [ROOT / "README.md", *found]


def name_of(page: Path) -> str:
    return page.relative_to(ROOT).as_posix()


def blocks(page: Path) -> list[Block]:
    """All blocks of a page but directives, in order."""
    text = page.read_text(encoding="utf-8")
    text = re.sub(r"\A---\n.*?\n---\n", lambda match: "\n" * match[0].count("\n"), text, flags=re.DOTALL)
    found = []
    for match in FENCE.finditer(text):
        kind, body = match[3], re.sub(r"\A(:[\w-]+:[^\n]*\n)+\n?", "", match[4])
        if kind not in DIRECTIVES:
            found.append(Block(kind, body, text.count("\n", 0, match.start()) + 1))
    without = FENCE.sub(lambda match: "\n" * match[0].count("\n"), text)
    lists = re.compile(r"^\s*([-*]|\d+\.) ")
    for match in INDENTED.finditer(without):
        before = without[: match.start(1)].rstrip().rpartition("\n\n")[2]
        if not any(lists.match(line) for line in before.splitlines()):
            line = without.count("\n", 0, match.start(1)) + 1
            found.append(Block("", textwrap.dedent(match[1]).strip("\n") + "\n", line))
    return sorted(found, key=lambda block: block.line)


def commands(text: str) -> Iterator[str]:
    """The commands of a block, continued lines joined, without comments and blank lines."""
    for line in text.replace("\\\n", " ").splitlines():
        command = line.strip()
        if command and not command.startswith("#"):
            yield command


class Runner:
    """Runs the blocks of a page in its order, in a folder of its own.

    Parameters
    ----------
    folder : Path
        The working directory.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.names: dict[str, Any] = {"__name__": "page"}
        self.printed: str | None = None
        self.not_run: list[str] = []

    def run(self, block: Block) -> None:
        """Run a block.

        Raises
        ------
        AssertionError
            If it fails, prints something else than the page shows, or is of no kind that can be run.
        """
        if block.kind == "text":
            assert self.printed is not None, f"no output comes before: {block.first}"
            compare(block.text, self.printed)
            self.printed = None
        elif (
            block.reason_not_to_run and block.kind not in ("sh",) and not INDENTED_COMMAND.match(block.first)
        ):
            self.not_run.append(block.first)
        elif block.kind in ("python", "{code-cell}"):
            self.printed = self._python(block)
        elif block.kind == "sh" or (not block.kind and INDENTED_COMMAND.match(block.first)):
            self.printed = "".join(self._command(command) for command in commands(block.text))
        elif named := re.match(r"# (in )?([\w-]+\.(?:toml|csv))\b", block.first):
            (self._changed if named[1] else self._written)(self.folder / named[2], block.text)
        else:
            raise AssertionError(f"nothing runs this block: {block.first}")

    def _python(self, block: Block) -> str:
        output = io.StringIO()
        tree = ast.parse(block.text)
        with contextlib.redirect_stdout(output):
            exec(compile(tree, f"line {block.line}", "exec"), self.names)
        return output.getvalue()

    def _command(self, command: str) -> str:
        if any(command.startswith(start) for start in NOT_RUN):
            self.not_run.append(command)
            return ""
        program, *arguments = shlex.split(command, comments=True)
        assert program.rpartition("/")[2] == "proprotor", f"nothing runs this command: {command}"
        target = None
        if ">" in arguments:
            place = arguments.index(">")
            target, arguments = self.folder / arguments[place + 1], arguments[:place]
        result = CliRunner().invoke(main, arguments, env={"COLUMNS": "80"})
        assert result.exit_code == 0, f"{command}\n{result.output}"
        if target is not None:
            target.write_text(result.stdout, encoding="utf-8")
        return result.stdout

    def _written(self, path: Path, text: str) -> None:
        path.write_text(text, encoding="utf-8")
        if is_study_file(path):
            read_study(path)
        elif path.suffix == ".toml":
            validate(read_tables(path))

    def _changed(self, path: Path, text: str) -> None:
        """Lines of a file that set the same keys as these, one for each, replaced."""
        changed = path.read_text(encoding="utf-8")
        for line in (line for line in text.splitlines() if " = " in line):
            key = re.escape(line.partition(" = ")[0])
            changed, times = re.subn(rf"(?m)^{key} = .*$", lambda _, line=line: line, changed)
            assert times == 1, f"{path.name} sets {key} {times} times"
        path.write_text(changed, encoding="utf-8")


NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def compare(shown: str, printed: str) -> None:
    """Every line that a page shows was printed, in that order; `...` stands for lines left out.

    Blanks do not count. Numbers may differ by one unit of the last digit shown: that much another linear algebra
    library may move.

    Raises
    ------
    AssertionError
        With the first line that was not printed.
    """
    lines = [line for line in printed.splitlines() if line.strip()]
    place, skip = 0, True
    for line in (line for line in shown.splitlines() if line.strip()):
        if line.strip() == "...":
            skip = True
            continue
        candidates = range(place, len(lines)) if skip else range(place, min(place + 1, len(lines)))
        found = next((i for i in candidates if alike(line, lines[i])), None)
        assert found is not None, f"not printed: {line}\nprinted:\n{printed}"
        place, skip = found + 1, False


def alike(shown: str, printed: str) -> bool:
    def words(line: str) -> str:
        return " ".join(NUMBER.sub(" # ", line).split())

    if words(shown) != words(printed):
        return False
    return all(
        abs(float(a) - float(b)) <= 1.01 * unit_of_last_digit(a)
        for a, b in zip(NUMBER.findall(shown), NUMBER.findall(printed), strict=True)
    )


def unit_of_last_digit(number: str) -> float:
    mantissa, _, exponent = number.partition("e")
    decimals = len(mantissa.partition(".")[2])
    if not decimals and not exponent:
        return 0.0  # a count is exact
    return 10.0 ** (int(exponent or 0) - decimals)
