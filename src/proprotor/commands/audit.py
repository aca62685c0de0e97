"""The command `proprotor audit`: every printed equation of the paper against the derivation."""

from __future__ import annotations

import csv
import os
import subprocess
import sys
from collections import Counter
from pathlib import Path

import click

from proprotor.commands import output
from proprotor.commands.arguments import EXIT_CODES
from proprotor.errors import InputError

_RECORD = Path("tests", "golden", "audit.csv")


@click.command(epilog=EXIT_CODES, short_help="The paper's equations against the derivation.")
@click.option("--check", is_flag=True, help="Derive everything again and compare; takes a minute and SymPy.")
@output.output_options()
def audit(check: bool, as_json: bool) -> None:
    """Every printed equation and table of AIAA-2002-1604 against the derivation, term by term.

    The audit belongs to the repository, where the derivation is; an installed package has its result in the equations.
    Without --check the recorded verdicts are told. docs/audit.md discusses them.

    \b
    Examples:
      proprotor audit
      proprotor audit --check
    """
    root = _repository()
    if check:
        if as_json:
            raise InputError("--json", None, "goes without --check")
        encoding = f"{sys.stdout.encoding}:backslashreplace"  # the paper has letters that a terminal may lack
        command = [sys.executable, "-m", "derive.audit", "--quick"]
        done = subprocess.run(command, cwd=root, env=os.environ | {"PYTHONIOENCODING": encoding})
        raise click.exceptions.Exit(min(done.returncode, 1))
    with (root / _RECORD).open(encoding="utf-8", newline="") as file:
        terms = list(csv.DictReader(file))
    if as_json:
        output.print_json(terms)
        return
    verdicts = tuple(Counter(term["verdict"] for term in terms))
    rows = []
    for number in dict.fromkeys(term["number"] for term in terms):
        counts = Counter(term["verdict"] for term in terms if term["number"] == number)
        rows.append((number, *(str(counts[verdict] or "") for verdict in verdicts)))
    output.print_table(("number", *verdicts), rows, text=("number",))
    output.console().print(f"{len(terms)} terms, as recorded; docs/audit.md tells the reasons.")


def _repository() -> Path:
    """Where the derivation is.

    Raises
    ------
    InputError
        When proprotor was installed without it.
    """
    import proprotor

    root = Path(proprotor.__file__).resolve().parents[2]
    if not (root / "derive" / "audit" / "__main__.py").is_file() or not (root / _RECORD).is_file():
        rule = "needs the repository, which has the derivation: clone it and run `make audit` there"
        raise InputError("audit", None, rule)
    return root
