"""The section on the whole XV-15 of docs/validation.md, and its pictures: Bell's boundaries beside the model's."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from benchmarks.bell_boundaries import below, root_mean_square
from benchmarks.bell_effects import ACREE, slope_of
from benchmarks.bell_points import (
    CONFIGURATIONS,
    HIGH_MACH,
    PUBLISHED,
    RPM,
    SCAN,
    SYMMETRIES,
    Crossing,
    Point,
    beside,
    read,
    tip_mach,
)
from proprotor.plots.boundary_against import plot_boundary_against
from proprotor.tables.points import Column, Points, read_points
from proprotor.typing import Axes

FIGURES = {
    "on the downstop": "xv15-aircraft-on.png",
    "20 % less stiff": "xv15-aircraft-soft.png",
    "off the downstop": "xv15-aircraft-off.png",
}
_SHOWN = np.arange(275.0, 700.0, 30.0)  # rpm
_WING = (2.0, 10.0)  # Hz, of the modes in the pictures
_LIMITS = (200.0, 520.0)  # kt


class Judged(NamedTuple):
    """Points of Bell's boundaries and the model's boundary of each."""

    found: dict[Point, Crossing]

    def of(self, name: str, mode: str) -> dict[Point, Crossing]:
        """Return the points of a configuration and a mode."""
        return {
            point: own
            for point, own in self.found.items()
            if (point.configuration, point.mode) == (name, mode)
        }


def section() -> Iterator[str]:
    """Yield the lines of the section of docs/validation.md."""
    judged = Judged(beside(read()))
    yield "## The whole XV-15 beside Bell's boundaries"
    yield ""
    yield "The 40 points that NASA TM X-62,407 prints (Figs. 7.2.1, 7.2.3 and 7.2.5, read to 3 kt) beside the decks"
    yield "`xv15-aircraft` and `xv15-aircraft-off`, with the published control stiffness, at sea level, in KTAS. No"
    yield "input was matched to a point. Bell's points are calculations of 1975: a difference is one from another"
    yield "analysis, not from a test. `python -m benchmarks.bell_boundaries` prints these tables, the frequency bands"
    yield "that say which root is meant, and what sets slopes; [the page on the aircraft](xv15-aircraft.md) discusses"
    yield "them."
    yield ""
    for name, mode in dict.fromkeys((point.configuration, point.mode) for point in judged.found):
        yield from _points_table(name, mode, judged.of(name, mode))
    yield f"\\* tip Mach number of {HIGH_MACH:g} or more at Bell's point: Prandtl and Glauert's factor is no model."
    yield ""
    yield from _summary(judged)
    yield f"The antisymmetric boundary at 458 rpm is 465 kt by Bell and {ACREE} kt by Acree, Peyran and Johnson (1999):"
    at_458 = next(
        own for point, own in judged.of("on the downstop", "beam antisymmetric").items() if point.rpm == 458
    )
    yield f"two published analyses, {465 - ACREE} kt apart. Here it is {at_458.airspeed:.0f} kt, {at_458.mode}."
    yield ""
    for name, picture in FIGURES.items():
        yield f"![Boundaries over the rotor speed with Bell's points: {name}](figures/{picture})"
        yield ""
    yield "Modes of the wing alone are drawn. Those of the rotor become unstable near the dotted line, where the tip"
    yield "Mach number reaches 1."
    yield ""


def _points_table(name: str, mode: str, found: dict[Point, Crossing]) -> Iterator[str]:
    low, high = CONFIGURATIONS[name].band(SYMMETRIES[mode])
    yield f"**{mode[0].upper()}{mode[1:]}, {name}**; first {SYMMETRIES[mode]} flutter of {low:.1f} to {high:.1f} Hz:"
    yield ""
    yield from _row("rpm", (f"{point.rpm:g}{'' if below(point) else ' *'}" for point in found))
    yield "|" + "---|" * (len(found) + 1)
    yield from _row("Bell, kt", (f"{point.airspeed:g}" for point in found))
    yield from _row("model, kt", (_written(own.airspeed) for own in found.values()))
    yield from _row(
        "difference", (_written(own.airspeed - point.airspeed, "+") for point, own in found.items())
    )
    yield from _row("model, Hz", (f"{own.frequency:.2f}" for own in found.values()))
    yield from _row("tip Mach", (f"{tip_mach(point, CONFIGURATIONS[name]):.2f}" for point in found))
    yield ""


def _row(name: str, cells: Iterable[str]) -> Iterator[str]:
    yield f"| {name} | " + " | ".join(cells) + " |"


def _written(value: float, sign: str = "") -> str:
    return "none" if np.isnan(value) else format(value, f"{sign}.0f")


def _summary(judged: Judged) -> Iterator[str]:
    yield f"Root mean squares and slopes of the points below a tip Mach number of {HIGH_MACH:g}:"
    yield ""
    yield "| | points | rms, kt | Bell, kt/rpm | model, kt/rpm |"
    yield "|---|---|---|---|---|"
    for mode in SYMMETRIES:
        for name in CONFIGURATIONS:
            own = {point: one for point, one in judged.of(name, mode).items() if below(point)}
            rms, count, _ = root_mean_square(own, below)
            rpm = [point.rpm for point in own]
            slopes = (
                slope_of(rpm, speeds)
                for speeds in ([point.airspeed for point in own], [one.airspeed for one in own.values()])
            )
            yield (
                f"| {mode}, {name} | {count} | {rms:.1f} | "
                + " | ".join(f"{slope:+.2f}" for slope in slopes)
                + " |"
            )
        rms, count, _ = root_mean_square(
            judged.found, lambda point, mode=mode: point.mode == mode and below(point)
        )
        yield f"| **{mode}, all** | {count} | **{rms:.1f}** | | |"
    yield ""


def draw(name: str) -> Axes:
    """Draw the boundaries of a configuration over the rotor speed, with Bell's points."""
    found = CONFIGURATIONS[name].case().boundary_against({"operation.rotor_speed": _SHOWN * RPM}, SCAN)
    hertz, speed = found.frequency / (2 * np.pi), found.airspeed / (1852 / 3600)
    shown = found.onset & ((hertz > _WING[0]) & (hertz < _WING[1]) & (speed < _LIMITS[1])).any(
        "operation.rotor_speed"
    )
    return plot_boundary_against(
        found.isel(branch=np.flatnonzero(shown)),
        points=_points_of(read_points(PUBLISHED), name),
        limits=_LIMITS,
    )


def _points_of(points: Points, name: str) -> Points:
    """Return the points of one configuration."""
    own = np.array([label.startswith(name) for label in points.label])
    columns = {
        path: Column(column.values[own], column.low[own], column.high[own], column.head)
        for path, column in points.columns.items()
    }
    return Points(points.name, columns, points.label[own], points.source[own], points.mode[own])


if __name__ == "__main__":
    print("\n".join(section()))
