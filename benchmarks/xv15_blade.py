"""The XV-15's blade by stations: bending stiffness from its first modes, its second modes, and its pitch stiffness.

    OPENBLAS_NUM_THREADS=1 python -m benchmarks.xv15_blade

Mass, twist and GJ are published (benchmarks/data/xv15_blade.csv), bending stiffness is not. It is taken to follow GJ
along the blade, with one factor flatwise and one edgewise, and one more of each for the hub inboard of the pitch horn;
the four factors are calibrated to the ends of Bell's first cyclic (lag) and first collective mode (coning). His second
modes, which the calibration does not see, are the check. Then: the nearest hinged blade, how far it is from the elastic
one, the pitch stiffness by the way a torque is spread, and the first boundary of the wing with each.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy.optimize import least_squares

import proprotor as pp
from proprotor.model.blade_comparison import compare_blades
from proprotor.rotor.elastic_blade import ElasticBlade
from proprotor.rotor.hinged_blade import HingedBlade, hinged_blade
from proprotor.tables.blade_table import comparison_rows, number_rows, verdict
from proprotor.typing import Array
from proprotor.units import KNOT

FOOT, SLUG, POUND = 0.3048, 14.593902937206, 4.4482216152605
RADIUS = 12.5 * FOOT
OMEGA = 458 * np.pi / 30
HORN = 0.11  # of the radius; NASA/TP-2004-212262, published
CONTROL = 22_400.0  # ft lbf/rad at the root; NASA/TP-2004-212262, published
PITCH = np.radians([20.0, 30.0, 40.0, 50.0])  # assumed, as in the deck xv15-bell-frequencies
CHORD = 1.16625 * FOOT
# NASA TM X-62,407, Figs. 7.1.1 and 7.1.2, per rev at the ends of the airplane's collective range; calculated there.
LAG, CONING = (1.454, 1.052), (1.69, 2.04)
SECOND = {"cyclic 2": (3.59, 4.03), "collective 2": (4.22, 3.87)}
FT_LBF = FOOT * POUND
BLADE = Path(__file__).resolve().parent / "data" / "xv15_blade.csv"


def published() -> dict[str, Array]:
    """Return stations, mass, GJ and twist in SI."""
    with BLADE.open(encoding="utf-8") as file:
        rows = [row for row in csv.reader(line for line in file if not line.startswith("#"))][1:]
    r, mass, torsion, twist = np.array(rows, dtype=float).T
    return {
        "radius": r * RADIUS,
        "mass_per_length": mass * SLUG / FOOT,
        "torsion_stiffness": torsion * POUND * FOOT**2,
        "twist": np.radians(twist),
    }


def blade(factors: Array, control: float = CONTROL) -> pp.BladeStations:
    """Return the stations for factors flatwise and edgewise, and of both in the hub."""
    columns = published()
    hub = columns["radius"] <= HORN * RADIUS
    flat, edge, flat_hub, edge_hub = factors
    torsion = columns["torsion_stiffness"]
    return pp.BladeStations(
        **columns,
        flatwise_stiffness=torsion * flat * np.where(hub, flat_hub, 1.0),
        edgewise_stiffness=torsion * edge * np.where(hub, edge_hub, 1.0),
        chord=np.full(torsion.shape, CHORD),
        # Assumed, for the spread of the propeller moment alone: as if the mass were spread evenly over the chord.
        pitch_inertia_per_length=columns["mass_per_length"] * CHORD**2 / 12,
        pitch_bearing=HORN * RADIUS,
        control_stiffness=control * FT_LBF,
    )


def frequencies(factors: Array, pitch: Array) -> tuple[Array, Array]:
    """Return collective and cyclic frequencies (p, 4) per rev."""
    elastic = ElasticBlade(blade(factors))
    both = (elastic.modes(OMEGA, pitch, hold, 4).frequency / OMEGA for hold in ("clamped", "gimballed"))
    collective, cyclic = both
    return collective, cyclic


def misfit(logarithms: Array) -> Array:
    """Return the differences of lag and coning from Bell's, per rev."""
    collective, cyclic = frequencies(np.exp(logarithms), PITCH[[0, -1]])
    return np.concatenate([cyclic[:, 1] - LAG, collective[:, 1] - CONING])


def calibrated() -> Array:
    """Return the four factors that are calibrated to Bell's first modes."""
    fit = least_squares(misfit, np.log([3.5, 20.0, 1.7, 0.16]), diff_step=1e-4, ftol=1e-7, max_nfev=12)
    return np.exp(fit.x)


def boundaries(stiffness: list[float]) -> Iterator[str]:
    """Yield the first boundary of the semispan wing, kt, for control stiffnesses in ft lbf/rad."""
    case = pp.load_case("xv15")
    for one in stiffness:
        found = case.vary({"rotor.control_stiffness": one * FT_LBF}).flutter_point("50:500:10kt")
        yield f"{found.speed / KNOT:.1f} {found.mode}" if found.mode else "none to 500"


def spreads(found: HingedBlade) -> dict[str, float]:
    """Return pitch stiffnesses in ft lbf/rad by the way a torque is spread."""
    named = {
        "deck, calibrated": 8000.0,
        "flap and lag bending, of couplings": found.numbers["control_stiffness"] / FT_LBF,
        "flap and lag bending, of torques": found.pitch_stiffness.flap_lag / FT_LBF,
        "section moments": (found.pitch_stiffness.section_moment or np.nan) / FT_LBF,
        "propeller moment": (found.pitch_stiffness.propeller_moment or np.nan) / FT_LBF,
        "even": found.pitch_stiffness.even / FT_LBF,
        "control system alone": CONTROL,
    }
    return named


def main() -> None:
    """Calibrate the blade and print what follows."""
    console = Console()
    factors = calibrated()
    names = ("flatwise", "edgewise", "flatwise in the hub", "edgewise in the hub")
    shown = ", ".join(f"{name} {value:.3g}" for name, value in zip(names, factors, strict=True))
    console.print(f"EI / GJ, calibrated to Bell's first modes: {shown} (of the blade's).")
    collective, cyclic = frequencies(factors, PITCH)
    table = Table("per rev at 20 and 50 deg", "Bell", "here", "")
    for name, bell, own, note in (
        ("lag, cyclic 1", LAG, cyclic[:, 1], "calibrated"),
        ("coning, collective 1", CONING, collective[:, 1], "calibrated"),
        ("cyclic 2", SECOND["cyclic 2"], cyclic[:, 2], "check"),
        ("collective 2", SECOND["collective 2"], collective[:, 2], "check"),
    ):
        table.add_row(name, "{:.3f} {:.3f}".format(*bell), f"{own[0]:.3f} {own[-1]:.3f}", note)
    console.print(table)
    stations = blade(factors)
    found = hinged_blade(stations, OMEGA, PITCH)
    table = Table("field", "value", "unit")
    for row in number_rows(found):
        table.add_row(*row)
    console.print(table)
    compared = compare_blades(stations, found)
    table = Table("quantity", "elastic 20°", "hinged 20°", "elastic 50°", "hinged 50°", "difference")
    for row in comparison_rows(compared):
        table.add_row(*row)
    console.print(table, *verdict(compared))
    named = spreads(found)
    table = Table("pitch stiffness", "ft lbf/rad", "first boundary of xv15, kt")
    for (name, value), first in zip(named.items(), boundaries(list(named.values())), strict=True):
        table.add_row(name, f"{value:,.0f}", first)
    console.print(table)


if __name__ == "__main__":
    main()
