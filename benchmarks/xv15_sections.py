"""What the airfoils along the XV-15's blade do to its boundaries: each of them alone, and all together.

    python -m benchmarks.xv15_sections           # prints the table
    python -m benchmarks.xv15_sections --page    # and writes it into docs/xv15-effects.md

The numbers are those of the deck xv15-sections, put into the decks of the semispan wing and of the aircraft.
"""

from __future__ import annotations

from collections.abc import Iterator

from rich.console import Console
from rich.table import Table

import proprotor as pp
from benchmarks.bell_points import CONFIGURATIONS, SYMMETRIES, boundaries, first_crossings
from benchmarks.page_table import markdown, page_is_wanted, write_table
from proprotor.deck.file import read_tables
from proprotor.deck.template import toml
from proprotor.units import KNOT

_RPM = 458.0
_JOINTS = ("airfoil.region_ends", "airfoil.blend")
_SLOPE, _ANGLE, _MOMENT = ("airfoil.lift_slope", "airfoil.zero_lift_angle", "airfoil.moment")
CHANGES = {
    "one airfoil, as the deck is": (),
    "lift slopes by region": (_SLOPE,),
    "zero-lift line": (_ANGLE,),
    "section moments by region": (_MOMENT,),
    "chord in place of the Lock number's": ("chord",),
    "lift slopes and chord": (_SLOPE, "chord"),
    "all of them": (_SLOPE, _ANGLE, _MOMENT, "chord"),
}


def settings(fields: tuple[str, ...]) -> dict[str, str]:
    """Return some fields of the rotor of xv15-sections as settings of another deck, with the regions they need."""
    rotor = read_tables("xv15-sections")["rotor"]
    tables = {"chord": rotor["chord"]} | {
        f"airfoil.{name}": entry for name, entry in rotor["airfoil"].items()
    }
    by_region = any(name.startswith("airfoil") for name in fields)
    names = (*fields, *_JOINTS) if by_region else fields
    return {f"rotor.{name}": toml(tables[name]) for name in names}


def semispan(fields: tuple[str, ...]) -> tuple[float, str]:
    """Return the flutter speed of the semispan wing, kt, and the mode."""
    found = pp.load_case("xv15", settings(fields)).flutter_point()
    return found.speed / KNOT, found.mode


def aircraft(fields: tuple[str, ...]) -> Iterator[float]:
    """Yield the first boundary of the aircraft on the downstop for each symmetry, kt."""
    configuration = CONFIGURATIONS["on the downstop"]
    found = boundaries(configuration.case(settings(fields)), (_RPM,))
    for symmetry in SYMMETRIES.values():
        yield first_crossings(found, symmetry, configuration.band(symmetry))[0].airspeed


def rows() -> Iterator[tuple[str, ...]]:
    """Yield each change with the boundaries of the semispan wing and of the aircraft."""
    for name, fields in CHANGES.items():
        speed, mode = semispan(fields)
        yield (name, f"{speed:.1f} {mode}", *(f"{one:.1f}" for one in aircraft(fields)))


def main() -> None:
    page = page_is_wanted(__doc__)
    found = list(rows())
    table = Table("", "semispan, kt", *(f"aircraft, {mode}, kt" for mode in SYMMETRIES))
    for row in found:
        table.add_row(*row)
    Console(width=120).print(table)
    if page:
        headings = ("airfoils", "semispan `xv15`, kt", *(f"aircraft, {mode}, kt" for mode in SYMMETRIES))
        mark = "python -m benchmarks.xv15_sections --page"
        write_table("xv15-effects.md", mark, markdown(headings, found))


if __name__ == "__main__":
    main()
