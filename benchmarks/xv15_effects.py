"""What blade data, places on the chord, linkages, lag of lift and inflow are worth on the XV-15, in knots.

    OPENBLAS_NUM_THREADS=1 python -m benchmarks.xv15_effects           # prints the table
    OPENBLAS_NUM_THREADS=1 python -m benchmarks.xv15_effects --page    # and writes it into docs/xv15-effects.md

Each row changes one thing of the decks xv15, a semispan wing, and xv15-aircraft, and tells the first boundary and how
far it is from that of the deck as it is. Airfoils are those of the deck xv15-sections. The blade of stations is the
hinged blade nearest to the one of benchmarks.xv15_blade, with bending stiffness calibrated to Bell's first modes.
Linkages and the stiffness of a swashplate that tilts are assumed: nothing published tells them apart. Places on the
chord are those of benchmarks.offsets, with the mass by stations that they need.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table

import proprotor as pp
from benchmarks import offsets
from benchmarks import xv15_blade as stations
from benchmarks.bell_points import CONFIGURATIONS, SCAN, SYMMETRIES
from benchmarks.page_table import markdown, page_is_wanted, write_table
from benchmarks.xv15_sections import CHANGES, settings
from proprotor.rotor.hinged_blade import HingedBlade, hinged_blade
from proprotor.units import KNOT

DECKS = ("xv15", "xv15-aircraft")
LAGS = {
    "lag of lift, blades": "lagged-blades",
    "lag of lift, wing": "lagged-wing",
    "lag of lift, both": "lagged",
}
INFLOWS = {"induced velocity in the trim": "momentum", "dynamic inflow": "dynamic"}


class Effect(NamedTuple):
    """One change: fields of the deck that it sets, fields of the rotor that it replaces, and options.

    tilt : stiffness of a swashplate that tilts, as a share of the deck's control stiffness.
    places : quarter chord as published or on the axis, and the centre of gravity, as in benchmarks.offsets.
    """

    fields: Mapping[str, str] = {}
    rotor: Mapping[str, float] = {}
    options: Mapping[str, Any] = {}
    tilt: float | None = None
    places: tuple[bool, float | None] | None = None

    def case(self, deck: str) -> pp.Case:
        """Return a deck with the change."""
        if self.places is not None:
            return with_places(deck, *self.places)
        case = pp.load_case(deck, dict(self.fields))
        changed = dict(self.rotor)
        if self.tilt is not None:
            changed["cyclic_control_stiffness"] = self.tilt * float(case.rotor.control_stiffness)
        return replace(case, rotor=replace(case.rotor, **changed)) if changed else case


def with_places(deck: str, published: bool, aft: float | None) -> pp.Case:
    """Return a deck with its mass by stations and with places on the chord."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "offsets.toml"
        path.write_text(offsets.deck(deck, published, aft), encoding="utf-8")
        return pp.load_case(path)


def effects(blade: HingedBlade) -> Iterator[tuple[str, Effect]]:
    """Yield each change with its title."""
    yield "as the deck is", Effect()
    yield "airfoils by region, all of `xv15-sections`", Effect(settings(CHANGES["all of them"]))
    yield "blade from stations", Effect(rotor=blade.numbers)
    kept = {name: value for name, value in blade.numbers.items() if name != "control_stiffness"}
    yield "the same with K_θ of the deck", Effect(rotor=kept)
    for name, value in stations.spreads(blade).items():
        if not name.startswith("deck"):
            field = {"rotor.control_stiffness": f"{value!r} ft*lbf/rad"}
            yield f"K_θ {value:,.0f} ft lbf/rad: {name}", Effect(field)
    for name, places in offsets.CHANGES.items():
        yield f"mass by stations, {name}", Effect(places=places)
    for name, times in (("half", 0.5), ("twice", 2.0)):
        yield f"swashplate that tilts {name} as stiff", Effect(tilt=times)
    for angle in (15, -15):
        field = {"rotor.kinematic_pitch_flap_coupling": f"{angle} deg"}
        yield f"δ3 = {angle} deg of the flap hinge", Effect(field)
    for coupling in (0.1, -0.1):
        field = {"rotor.kinematic_pitch_lag_coupling": str(coupling)}
        yield f"K_P4 = {coupling} of the lag hinge", Effect(field)
    for name, lift in LAGS.items():
        yield name, Effect(options={"lift": lift})
    for name, inflow in INFLOWS.items():
        yield name, Effect(options={"inflow": inflow})


def semispan(effect: Effect) -> tuple[float, str]:
    """Return the flutter speed of the semispan wing, kt, and the mode; NaN and no mode without one."""
    found = effect.case(DECKS[0]).flutter_point("50:520:10kt", **effect.options)
    return (found.speed / KNOT, found.mode) if found.mode else (float("nan"), "")


def aircraft(effect: Effect) -> Iterator[float]:
    """Yield the first boundary of the aircraft on the downstop for each symmetry, kt; NaN without one."""
    found = effect.case(DECKS[1]).boundaries(SCAN, **effect.options).boundaries
    for symmetry in SYMMETRIES.values():
        low, high = CONFIGURATIONS["on the downstop"].band(symmetry)
        own = (one for one in found if one.onset and one.mode.startswith(symmetry))
        speeds = [one.position / KNOT for one in own if low <= one.frequency / (2 * np.pi) <= high]
        yield min(speeds, default=float("nan"))


def shown(value: float, base: float) -> str:
    """Return a speed and its distance from that of the deck."""
    return "none" if value != value else f"{value:.1f} ({value - base:+z.1f})"


def rows(blade: HingedBlade) -> Iterator[tuple[str, ...]]:
    """Yield the rows of the table; the semispan wing has no airloads of its own that could lag."""
    base: list[float] = []
    for name, effect in effects(blade):
        of_wing_alone = effect.options.get("lift") == "lagged-wing"
        speed, mode = (base[0], "") if of_wing_alone else semispan(effect)
        speeds = [speed, *aircraft(effect)]
        base = base or speeds
        first, *others = (shown(one, own) for one, own in zip(speeds, base, strict=True))
        yield (name, "–" if of_wing_alone else f"{first} {mode}", *others)


def main() -> None:
    page = page_is_wanted(__doc__)
    blade = hinged_blade(stations.blade(stations.calibrated()), stations.OMEGA, stations.PITCH)
    table = Table("", "semispan, kt", *(f"aircraft, {mode}, kt" for mode in SYMMETRIES))
    found = list(rows(blade))
    for row in found:
        table.add_row(*row)
    Console(width=140, highlight=False).print(table)
    if page:
        headings = ("change", "semispan `xv15`", *(f"aircraft, {mode}" for mode in SYMMETRIES))
        mark = "python -m benchmarks.xv15_effects --page"
        write_table("xv15-effects.md", mark, markdown(headings, found))


if __name__ == "__main__":
    main()
