"""Bell's stability boundaries of the whole XV-15 beside the model's.

    python -m benchmarks.bell_boundaries
    python -m benchmarks.bell_boundaries --page           # writes what sets the boundaries into docs/xv15-aircraft.md
    python -m benchmarks.bell_boundaries --points FILE    # a CSV file of other points with the same columns

The 40 points are read off Figs. 7.2.1, 7.2.3 and 7.2.5 of NASA TM X-62,407 (to 3 kt), calculations of 1975. The
model is the decks `xv15-aircraft` and `xv15-aircraft-off` as they are, with the published control stiffness of
22,400 ft lbf/rad; no input was matched to any point. `benchmarks.bell_points` says which boundary of the model
belongs to a point.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Mapping

import numpy as np
from rich.console import Console
from rich.table import Table

import proprotor as pp
from benchmarks.bell_effects import Change, effect, slope_of, written
from benchmarks.bell_points import (
    CONFIGURATIONS,
    HIGH_MACH,
    PUBLISHED,
    SYMMETRIES,
    Crossing,
    Point,
    beside,
    boundaries,
    first_crossings,
    read,
    tip_mach,
)
from benchmarks.page_table import PageTable
from proprotor.units import KNOT

MARK = "python -m benchmarks.bell_boundaries --page"
_AT = 458.0  # rpm
_ON, _SOFT, _OFF = CONFIGURATIONS
_Found = Mapping[Point, Crossing]

BANDS = """\
Bands of frequency, from the published frequencies of the airframe at rest alone. Symmetric chord: between the
geometric means with beam below and torsion above. Antisymmetric: beam, chord and torsion are too near each other to
be told apart, so one band from half an octave below the first to half an octave above the last.
"""


# Points ---------------------------------------------------------------------------------------------------------------


def print_points(console: Console, found: _Found) -> None:
    """Print every point beside the model, a table for each configuration and mode."""
    for name, mode in dict.fromkeys((point.configuration, point.mode) for point in found):
        symmetry, configuration = SYMMETRIES[mode], CONFIGURATIONS[name]
        low, high = configuration.band(symmetry)
        title = f"{name}: {mode}; first flutter among {symmetry} roots of {low:.2f} to {high:.2f} Hz, KTAS"
        table = Table(
            "rpm",
            "altitude, ft",
            "Bell",
            "model",
            "difference",
            "Hz",
            "model's name",
            "tip Mach at Bell's point",
            title=title,
        )
        for point, crossing in found.items():
            if (point.configuration, point.mode) == (name, mode):
                table.add_row(*_cells(point, crossing))
        console.print(table)


def _cells(point: Point, crossing: Crossing) -> tuple[str, ...]:
    mach = tip_mach(point, CONFIGURATIONS[point.configuration])
    return (
        f"{point.rpm:g}",
        f"{point.altitude:g}",
        f"{point.airspeed:g}",
        written(crossing.airspeed, ".1f"),
        written(crossing.airspeed - point.airspeed, "+.1f"),
        written(crossing.frequency, ".2f"),
        crossing.mode,
        f"{mach:.3f}" + (f"  >= {HIGH_MACH}" if mach >= HIGH_MACH else ""),
    )


def root_mean_square(found: _Found, which: Callable[[Point], bool]) -> tuple[float, int, int]:
    """Return the root mean square difference of some points in knots, their number, and how many have no boundary."""
    differences = np.array([own.airspeed - point.airspeed for point, own in found.items() if which(point)])
    there = np.isfinite(differences)
    rms = float(np.sqrt(np.mean(differences[there] ** 2))) if there.any() else np.nan
    return rms, int(there.sum()), int((~there).sum())


def below(point: Point) -> bool:
    """Return whether the blade tips at a point are below the Mach number at which the model's air ends."""
    return tip_mach(point, CONFIGURATIONS[point.configuration]) < HIGH_MACH


def print_summary(console: Console, found: _Found) -> None:
    """Print root mean square differences, and slopes over the rotor speed."""
    columns = (f"rms below {HIGH_MACH}, kt", "rms of all, kt", "Bell, kt/rpm", "model, kt/rpm")
    table = Table(
        "",
        *columns,
        title="root mean square differences, and slopes over the points below a tip Mach number of .9",
    )
    for mode in SYMMETRIES:
        for name in (*CONFIGURATIONS, ""):
            own = {
                point: one
                for point, one in found.items()
                if point.mode == mode and name in ("", point.configuration)
            }
            if own:
                table.add_row(f"{mode}, {name or 'all configurations'}", *_summary(own, slopes=bool(name)))
    console.print(table)


def _summary(own: _Found, *, slopes: bool) -> Iterable[str]:
    for which in (below, lambda point: True):
        rms, count, lost = root_mean_square(own, which)
        yield f"{written(rms, '.1f')} ({count} points{f', {lost} without boundary' if lost else ''})"
    low = [point for point in own if below(point)]
    rpm = [point.rpm for point in low]
    for airspeeds in ([point.airspeed for point in low], [own[point].airspeed for point in low]):
        yield written(slope_of(rpm, airspeeds), "+.2f") if slopes and len(set(rpm)) > 1 else ""


def print_changes(console: Console, found: _Found) -> None:
    """Print what 20 % less stiffness and the loss of the downstop do, at each rotor speed with points of both."""
    table = Table("kt", "rpm", "Bell", "model", title="differences from the boundary on the downstop")
    at = {(point.configuration, point.mode, point.rpm, point.altitude): point for point in found}
    for point in found:
        on = at.get((_ON, *point[1:4]))
        if on is not None and point.configuration != _ON:
            model = found[point].airspeed - found[on].airspeed
            name = f"{point.mode}, {point.configuration}"
            table.add_row(
                name, f"{point.rpm:g}", f"{point.airspeed - on.airspeed:+g}", written(model, "+.1f")
            )
    if table.row_count:
        console.print(table)


# What sets slopes, -20 % and downstop ---------------------------------------------------------------------------------

_SPRINGS_OF_AIRFRAME = {
    "wing in beam bending": "support.beam_stiffness",
    "wing in chord bending": "support.chord_stiffness",
    "wing in torsion": "support.torsion_stiffness",
    "downstop": "support.downstop_stiffness_on",
    "spindle in yaw": "support.spindle_yaw_stiffness_on",
}
# Inputs with a time in their units, and the power of that time: what does not follow the rotor speed sets the slope.
_TIMED = {
    "speed of sound (tip Mach number)": {"operation.speed_of_sound": 1},
    "flap spring of the blade": {"rotor.flap_frequency": 1},
    "lag spring of the blade": {"rotor.lag_frequency": 1},
    "control stiffness K_θ": {"rotor.control_stiffness": 2},
    "hub spring": {"rotor.gimbal_stiffness": 2},
    "stiffness of wing and pylon": dict.fromkeys(
        (*_SPRINGS_OF_AIRFRAME.values(), "support.axial_stiffness"), 2
    ),
}


def relative(case: pp.Case, on: Crossing) -> dict[str, float]:
    """Return the exact derivative of a boundary by each input times the input, kt."""
    scan = f"{on.airspeed - 40:g}:{on.airspeed + 40:g}:8ktas"
    found = case.sensitivity(mode=on.mode, airspeed=scan)
    return dict(zip(found.input.values.tolist(), (found.relative.values / KNOT).tolist(), strict=True))


def slope_parts(own: Mapping[str, float], airspeed: float) -> dict[str, float]:
    """Return the parts of the slope of a boundary over the rotor speed, kt/rpm.

    If every input with a time in its units followed the rotor speed, the boundary would be proportional to the rotor
    speed; an input that stays as it is takes its own share from that. The parts add up to the slope.
    """
    parts = {"everything in proportion to the rotor speed": airspeed / _AT}
    for name, powers in _TIMED.items():
        parts[f"but for the {name}"] = -sum(power * own[path] for path, power in powers.items()) / _AT
    return parts


def what_sets(on: tuple[Crossing, ...]) -> tuple[PageTable, ...]:
    """Return the parts of slopes, of 20 % less stiffness and of the loss of the downstop at 458 rpm."""
    case = CONFIGURATIONS[_ON].case()
    own = [relative(case, one) for one in on]
    parts = [slope_parts(one, crossing.airspeed) for one, crossing in zip(own, on, strict=True)]
    slopes = [(name, *(f"{one[name]:+.3f}" for one in parts)) for name in parts[0]]
    slopes.append(("sum", *(f"{sum(one.values()):+.3f}" for one in parts)))
    slopes.append(
        ("derivative by the rotor speed", *(f"{one['operation.rotor_speed'] / _AT:+.3f}" for one in own))
    )
    softer = {path: [np.log(0.8) * one[path] for one in own] for path in _SPRINGS_OF_AIRFRAME.values()}
    stiffness = [
        (name, *(f"{value:+.1f}" for value in softer[path])) for name, path in _SPRINGS_OF_AIRFRAME.items()
    ]
    stiffness.append(("sum", *(f"{value:+.1f}" for value in np.sum(list(softer.values()), axis=0))))
    off = [(name, *(written(one, "+.1f") for one in changes)) for name, changes in _off_by_parts(on).items()]
    return (
        PageTable(f"{MARK}: slopes", ("kt/rpm, exact derivatives", *SYMMETRIES), slopes),
        PageTable(f"{MARK}: stiffness", ("20 % less stiff, kt, to first order", *SYMMETRIES), stiffness),
        PageTable(f"{MARK}: downstop", ("off the downstop, kt", *SYMMETRIES), off),
    )


def _off_by_parts(on: tuple[Crossing, ...]) -> dict[str, list[float]]:
    """Return the change of each boundary at 458 rpm with one spring of the pylon, and both, off the downstop."""
    deck = CONFIGURATIONS[_ON].deck
    soft = {
        spring: pp.load_case(deck).given[f"support.{spring}_off"].si
        for spring in ("downstop_stiffness", "spindle_yaw_stiffness")
    }
    pitch, yaw = ({f"support.{spring}_on": value} for spring, value in soft.items())
    named = {
        "pitch spring as off the downstop": pitch,
        "yaw spring as off the downstop": yaw,
        "both": pitch | yaw,
    }
    return {name: _changed(pp.load_case(deck).vary(values), on) for name, values in named.items()}


def _changed(case: pp.Case, on: tuple[Crossing, ...]) -> list[float]:
    found = boundaries(case, [_AT])
    crossings = (
        first_crossings(found, one, CONFIGURATIONS[_OFF].band(one))[0] for one in SYMMETRIES.values()
    )
    return [one.airspeed - before.airspeed for one, before in zip(crossings, on, strict=True)]


def main() -> None:
    """Print all tables, or those of the points of a file, and write those of the page into it."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument(
        "--points", default=PUBLISHED, help="CSV file of points, by default the 40 published ones"
    )
    parser.add_argument("--page", action="store_true", help="write what sets the boundaries into its page")
    asked = parser.parse_args()
    console = Console(width=170)
    found = beside(read(asked.points))
    console.print(BANDS)
    print_points(console, found)
    print_summary(console, found)
    print_changes(console, found)
    if asked.points == PUBLISHED:
        for table in what_sets(effect(Change()).at_458):
            console.print(table.printed("at 458 rpm"))
            if asked.page:
                table.write("xv15-aircraft.md")


if __name__ == "__main__":
    main()
