"""C81 files: cells, counts, lines and bytes of a good one changed."""

from __future__ import annotations

import re
from pathlib import Path
from random import Random

import numpy as np

from proprotor import AirfoilTable
from tests.c81_files import as_c81, made_up_tables
from tests.fuzz.mutation import NUMBERS, other_lines, other_number, several, spoiled_bytes

SEEDS = tuple(as_c81("made up", **made_up_tables(n_mach)) for n_mach in (1, 3, 11, 21))
_SEPARATED = SEEDS[1].replace("-", " -").replace("\n  ", "\n ")
_DIALECTS = (
    f"# FREE FORMAT\n{_SEPARATED}",
    f"1 0 0\n0 1\n0.158\nCOMMENT\n200000 0.2\n{SEEDS[1]}",
    f"{SEEDS[0]}END\n# the second\n{SEEDS[1]}",
    SEEDS[1].partition("\n")[0]
    + re.sub(r"(?<=[0-9]) +(?=[-0-9.])", ",", "\n" + _SEPARATED.partition("\n")[2]),
)
_ANGLES, _MACH = np.linspace(-4, 4, 9)[:, None], np.linspace(0, 1.2, 5)
_CELL = 7


def make(rng: Random) -> tuple[dict[str, bytes], dict]:
    """The files of an input by name, and how they are used."""
    text = rng.choice((*SEEDS, *_DIALECTS))
    if rng.random() < 0.3:
        content = spoiled_bytes(rng, text.encode(), [seed.encode() for seed in SEEDS])
    else:
        ways = (other_number, other_lines, _other_cell, _other_cell, _other_counts)
        content = several(rng, text, ways).encode("latin-1", "replace")
    return {"airfoil.c81": content}, {}


def use(folder: Path) -> None:
    table = AirfoilTable.from_c81(folder / "airfoil.c81")
    found = table.coefficients(_ANGLES, _MACH)
    assert all(np.isfinite(number).all() for number in found), "a coefficient is not finite"
    assert all(mask.shape == (9, 5) for mask in table.warnings(_ANGLES, _MACH).values())


def _other_cell(rng: Random, text: str) -> str:
    """One number of seven columns, of its own length or not."""
    lines = text.split("\n")
    place, cell = rng.randrange(len(lines)), rng.randrange(10)
    new = rng.choice((*NUMBERS, " ", "abc", f"{rng.uniform(-200, 200):.3f}", f"{rng.uniform(0, 1):.4f}"))
    new = new[:_CELL].rjust(_CELL) if rng.random() < 0.8 else new
    start = cell * _CELL
    lines[place] = lines[place][:start].ljust(start) + new + lines[place][start + _CELL :]
    return "\n".join(lines)


def _other_counts(rng: Random, text: str) -> str:
    counts = "".join(rng.choice((" 0", " 1", " 2", "11", "24", "99", "-1", "1 ", "xx")) for _ in range(6))
    place = 30 + 2 * rng.randrange(6)
    first, _, rest = text.partition("\n")
    first = first[:place] + counts[:2] + first[place + 2 :] if rng.random() < 0.7 else first[:30] + counts
    return f"{first}\n{rest}"
