"""The XV-15's first boundaries on a semispan wing: which wing, which lag and which control stiffness give what.

    python -m benchmarks.semispan_band           # prints the tables
    python -m benchmarks.semispan_band --page    # and writes them into docs/xv15.md

Published semispan flutter speeds stand beside the table. Nothing is tuned: each wing, each set of blade frequencies and
each control stiffness has a source of its own.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

import proprotor as pp
from benchmarks.page_table import markdown, page_is_wanted, write_table
from benchmarks.paper_figures.wing_modes import OF_THE_ROTOR, WingModes
from benchmarks.xv15_boundary import SPEEDS, as_text

PUBLISHED = {  # kt
    "Johnson, TM X-62,369": 305,
    "Hathaway 2005": 302,
    "NASA SP-4517": 300,
    "Nixon": 285,
}
WINGS = {
    "xv15-uncoupled": "three typed modes, uncoupled",
    "xv15": "as built, frequencies of the semispan test",
    "xv15-wing": "as built, published stiffnesses alone",
}
BELL = pp.load_case("xv15-bell-frequencies").frequencies
LAGS: dict[str, Mapping[str, Any]] = {
    "springs of Table 1": {},
    "Bell's frequencies": {"structure": "tabulated", "frequencies": BELL},
}
CONTROL_STIFFNESS = {  # ft lbf/rad
    22400: "control system of the later rotor, TP-2004-212262",
    11000: "in series with the blade's GJ, torque ∝ 1 - r/R",
    8000: "calibrated to K_Pζ = -0.3, as in the decks",
    7400: "in series with the blade's GJ, torque spread evenly",
}
_OF_THE_WING = {  # what the wing as built assumes
    "as the deck": {},
    "nacelle's centre of mass 10 in ahead": {"support.nacelle_forward": "10 in"},
    "nacelle's centre of mass 10 in behind": {"support.nacelle_forward": "-10 in"},
    "span 1.333 R, as the semispan models": {"support.span": "16.66 ft"},
    "no sweep, no dihedral": {"support.sweep": "0 deg", "support.dihedral": "0 deg"},
    "rotor rigid with its shaft at rest": {"support.rotor_held": "rigid"},
    "rotor a point mass at rest": {"support.rotor_held": "mass only"},
    "shaft free at rest": {"support.shaft": "free"},
    "damping 1 % of each mode": {"support.chord_damping_ratio": "1 %"},
}


def boundaries(wing: str, settings: Mapping[str, str], options: Mapping[str, Any]) -> dict[str, float]:
    """Return the speed in kt at which each mode of the wing, and any mode of the rotor, first becomes unstable."""
    found = WingModes(pp.load_case(wing, settings), SPEEDS, options)
    return {name: found.speed(name) for name in ("beam", "chord", "torsion", OF_THE_ROTOR)}


def of_inputs(wings: Iterable[str] = WINGS) -> Iterator[tuple[str, str, int, dict[str, float]]]:
    """Yield wing, lag, control stiffness and boundaries for each choice."""
    for wing in wings:
        for lag, options in LAGS.items():
            for stiffness in CONTROL_STIFFNESS:
                given = {"rotor.control_stiffness": f"{stiffness} ft*lbf/rad"}
                yield wing, lag, stiffness, boundaries(wing, given, options)


@cache
def as_built() -> tuple[tuple[str, int, dict[str, float]], ...]:
    """Return lag, control stiffness and boundaries of the wing as built, for each choice."""
    return tuple((lag, stiffness, found) for _, lag, stiffness, found in of_inputs(("xv15",)))


def first_of_wing(found: Mapping[str, float]) -> float:
    """Return the first boundary of the wing in kt; infinite without any."""
    return min(speed for name, speed in found.items() if name != OF_THE_ROTOR)


def of_the_wing() -> Iterator[tuple[str, str, dict[str, float]]]:
    """Yield what is altered of the wing as built, the lag, and boundaries."""
    for altered, settings in _OF_THE_WING.items():
        for lag, options in LAGS.items():
            yield altered, lag, boundaries("xv15", settings, options)


COLUMNS = ("beam", "chord", "torsion", "rotor", "first of the wing")
INPUTS, STRUCTURE = ("wing", "lag", "K_θ, ft lbf/rad"), ("`xv15`", "lag")


def _table(title: str, first: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> Table:
    table = Table(*first, *COLUMNS, title=title)
    for row in rows:
        table.add_row(*row)
    return table


def _cells(found: Mapping[str, float]) -> Iterator[str]:
    """Yield the boundaries as text, and the first of the wing."""
    yield from map(as_text, found.values())
    speeds = {name: speed for name, speed in found.items() if name != OF_THE_ROTOR}
    first = min(speeds, key=speeds.__getitem__)
    yield f"{first} {as_text(speeds[first])}" if np.isfinite(speeds[first]) else "none"


def main() -> None:
    """Print both tables and the published speeds."""
    page, console = page_is_wanted(__doc__), Console(width=150, highlight=False)
    inputs = [
        (f"`{wing}`", lag, f"{stiffness:,}", *_cells(found)) for wing, lag, stiffness, found in of_inputs()
    ]
    structure = [(altered, lag, *_cells(found)) for altered, lag, found in of_the_wing()]
    console.print(_table("Wing, lag and control stiffness; kt, section damping on", INPUTS, inputs))
    title = "The wing as built, what its structure assumes; K_θ 8,000"
    console.print(_table(title, STRUCTURE, structure))
    for what in (WINGS, CONTROL_STIFFNESS):
        for name, meaning in what.items():
            console.print(f"{name}: {meaning}")
    console.print("Published: " + ", ".join(f"{name} {speed} kt" for name, speed in PUBLISHED.items()))
    if page:
        mark = "python -m benchmarks.semispan_band --page"
        write_table("xv15.md", f"{mark}: inputs", markdown((*INPUTS, *COLUMNS), inputs))
        write_table("xv15.md", f"{mark}: structure", markdown((*STRUCTURE, *COLUMNS), structure))


if __name__ == "__main__":
    main()
