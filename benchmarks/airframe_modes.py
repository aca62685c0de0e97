"""Modes of the XV-15's airframe beside the two published sets, on and off the downstop, and what sets each.

    python -m benchmarks.airframe_modes           # prints the tables
    python -m benchmarks.airframe_modes --page    # and writes them into two pages: docs/supports-aircraft.md
                                                  # and docs/xv15-aircraft.md

The rotors are point masses at the hubs, without gyroscopics and airloads. Four springs are calibrated, each to one
frequency of Fig. 7.1.4, which is marked; all other rows are computed from inputs that were not matched to any of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from rich.console import Console

import proprotor as pp
from benchmarks.page_table import PageTable, page_is_wanted

MARK = "python -m benchmarks.airframe_modes --page"

KINDS = ("beam", "chord", "torsion", "pylon yaw")
BELL = {  # NASA TM X-62,407, Fig. 7.1.4, Hz: off the downstop, on the downstop
    "symmetric": ((3.0, 5.5, 6.8, 11.8), (3.0, 5.9, 7.9, 19.6)),
    "antisymmetric": ((5.35, 6.0, 6.4, 11.4), (5.6, 6.15, 7.3, 19.3)),
}
NASA = (3.3, 6.3, 8.3, None)  # NASA/TP-2004-212262, symmetric, on the downstop
CALIBRATED = (("symmetric", "torsion"), ("symmetric", "pylon yaw"))
CLOSE = 0.10
COLUMNS = (
    "off: Fig. 7.1.4",
    "off: computed",
    "on: Fig. 7.1.4",
    "on: TP-2004-212262",
    "on: computed",
)
RECALLED = {"roll": 52800, "pitch": 21400, "yaw": 69400}  # slug ft², of published simulation models
_SIMULATION = {f"support.fuselage.{axis}_inertia": f"{value} slug*ft**2" for axis, value in RECALLED.items()}
CHANGES = {
    "roll inertia - 20 %": {"support.fuselage.roll_inertia": "32400 slug*ft**2"},
    "roll inertia + 20 %": {"support.fuselage.roll_inertia": "48600 slug*ft**2"},
    "pitch inertia + 20 %": {"support.fuselage.pitch_inertia": "15840 slug*ft**2"},
    "pitch inertia - 20 %": {"support.fuselage.pitch_inertia": "10560 slug*ft**2"},
    "yaw inertia + 20 %": {"support.fuselage.yaw_inertia": "60360 slug*ft**2"},
    "yaw inertia - 20 %": {"support.fuselage.yaw_inertia": "40240 slug*ft**2"},
    "weight + 20 %": {"support.fuselage.mass": "15600 lb"},
    "weight - 20 %": {"support.fuselage.mass": "10400 lb"},
    "inertias of simulation models": _SIMULATION,
    "centre of mass 1 ft below the wing": {"support.fuselage.centre_up": "-12 in"},
    "centre of mass 18.8 in further aft": {"support.fuselage.centre_forward": "5 in"},
    "box held in bending slope": {"support.carry_through.bending_slope": "held"},
    "box held in chord slope": {"support.carry_through.chord_slope": "held"},
    "the same, simulation models": _SIMULATION | {"support.carry_through.chord_slope": "held"},
    "box half as stiff in chord": {"support.carry_through.chord_stiffness": "5.6e9 lbf*in**2"},
    "nacelles 5 % lighter": {"support.nacelle_mass": "1504 lb"},
    "no sweep, no dihedral": {"support.sweep": "0 deg", "support.dihedral": "0 deg"},
}


def hertz(case: pp.Case) -> dict[str, float]:
    """Return the frequency of each elastic coordinate, whose mass with the rotors on is one kilogram."""
    support = case.support
    frequency = np.sqrt(np.diag(support.stiffness)) / (2 * np.pi)
    return dict(zip(support.names, frequency.tolist(), strict=True))


def nearest(computed: float, *published: float | None) -> float:
    """Return the relative difference from the nearest published value."""
    return min((computed / value - 1 for value in published if value is not None), key=abs)


def beside_published() -> PageTable:
    """Return the modes of both decks beside the published ones, bold where far from each of them."""
    off, on = (hertz(pp.load_case(deck)) for deck in ("xv15-aircraft-off", "xv15-aircraft"))
    rows = []
    for symmetry, (bell_off, bell_on) in BELL.items():
        for kind, first, second, other in zip(KINDS, bell_off, bell_on, NASA, strict=True):
            name = f"{symmetry} {kind}"
            nasa = other if symmetry == "symmetric" else None
            cells = (_written(off[name], name, first), str(second), "" if nasa is None else str(nasa))
            rows.append((name, str(first), *cells, _written(on[name], name, second, nasa)))
    return PageTable(f"{MARK}: modes", ("Hz", *COLUMNS), rows)


def _written(computed: float, name: str, *published: float | None) -> str:
    """Return a frequency with its difference from the nearest published one, or the mark of a calibrated one."""
    if tuple(name.split(" ", 1)) in CALIBRATED:
        return f"{computed:.2f} c"
    difference = nearest(computed, *published)
    bold = "**" if abs(difference) > CLOSE else ""
    return f"{bold}{computed:.2f}{bold} ({100 * difference:+.0f} %)"


def what_sets_each() -> PageTable:
    """Return the modes on the downstop with one input changed at a time."""
    names = [f"{symmetry} {kind}" for symmetry in BELL for kind in KINDS]
    short = [name.replace("antisymmetric", "anti.").replace("symmetric", "sym.") for name in names]
    rows = [(told, *_row(settings, names)) for told, settings in ({"as the deck is": {}} | CHANGES).items()]
    return PageTable(f"{MARK}: changes", ("on the downstop, Hz", *short), rows)


def _row(settings: Mapping[str, str], names: list[str]) -> Iterator[str]:
    try:
        found = hertz(pp.load_case("xv15-aircraft", settings))
    except pp.InputError:
        yield from ["refused"] * len(names)
    else:
        yield from (f"{found[name]:.2f}" if name in found else "–" for name in names)


def chord_slope() -> PageTable:
    """Return the modes of chord with the slope of chord bending free at BL 28, and held."""
    (_, bell_off, *_), (_, bell_on, *_) = BELL["symmetric"]
    headings = (
        "chord slope at BL 28",
        f"off the downstop: Bell {bell_off}",
        f"on: Bell {bell_on}, TP-2004-212262 {NASA[1]}",
        f"antisymmetric, on: Bell {BELL['antisymmetric'][1][1]}",
        "the same with recalled inertias",
    )
    rows = []
    for state in ("free", "held"):
        settings = {"support.carry_through.chord_slope": state}
        off, on, recalled = (
            hertz(pp.load_case(deck, settings | more))
            for deck, more in (
                ("xv15-aircraft-off", {}),
                ("xv15-aircraft", {}),
                ("xv15-aircraft", _SIMULATION),
            )
        )
        symmetric = (found["symmetric chord"] for found in (off, on))
        others = (found["antisymmetric chord"] for found in (on, recalled))
        rows.append((state, *(f"{value:.2f}" for value in (*symmetric, *others))))
    return PageTable(f"{MARK}: chord slope", headings, rows)


def main() -> None:
    """Print all tables, and write them into their pages."""
    page, console = page_is_wanted(__doc__), Console(width=150)
    for where, table in (
        ("supports-aircraft.md", beside_published()),
        ("supports-aircraft.md", what_sets_each()),
        ("xv15-aircraft.md", chord_slope()),
    ):
        console.print(table.printed("Hz; c: calibrated to the published value"))
        if page:
            table.write(where)


if __name__ == "__main__":
    main()
