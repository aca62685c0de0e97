"""Colours, dashes and markers that colour-blind readers and grey prints tell apart, and one style for each mode."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING, NamedTuple

from proprotor.tables.sweep_summary import growth_rate, support_coordinates

if TYPE_CHECKING:
    import xarray

# Okabe and Ito's colours, which colour-blind readers tell apart, less the yellow, too pale on white.
COLOURS = ("#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
DRIVES, DAMPS = "#D55E00", "#0072B2"  # what lowers stability, and what raises it
STABLE = "#D8EEE6"  # a light green that prints as a light grey
UNSTABLE = "#FBE9DF"
GREY = "0.35"
LABEL_SIZE = 8  # points
_DASHES = ("-", "--", ":")
_MARKERS = "s^DvP<>"  # for broad lines, which colour alone would not tell apart on a grey print

# How sure the number is that a deck gives: hatches of bars, the blank one for what was read in a source.
STATUS_HATCHES = {
    "published": "",
    "derived": "",
    "recalled": "////",
    "assumed": "xxxx",
    "calibrated": "....",
}


class ModeStyle(NamedTuple):
    """Of the line of one mode, by the names that Matplotlib has for them."""

    color: str
    linestyle: str
    linewidth: float
    marker: str


def broad_modes(sweep: xarray.Dataset) -> set[str]:
    """Modes drawn in broad lines: the support's, and those that are unstable somewhere."""
    grows = (growth_rate(sweep) > 0).any(axis=0)
    return {*support_coordinates(sweep), *sweep.mode.values[grows].tolist()}


def mode_styles(sweep: xarray.Dataset) -> list[ModeStyle]:
    """One style for each mode of a sweep, in its order: no two have both colour and dashes in common.

    The same mode looks the same in every plot of a sweep. Support modes and unstable ones are broad, with a marker.
    """
    broad = broad_modes(sweep)
    markers = cycle(_MARKERS)
    single = "o" if len(sweep.reason) == 1 else ""
    return [
        ModeStyle(
            color=COLOURS[place % len(COLOURS)],
            linestyle=_DASHES[place // len(COLOURS) % len(_DASHES)],
            linewidth=2.4 if mode in broad else 1.2,
            marker=next(markers) if mode in broad else single,
        )
        for place, mode in enumerate(sweep.mode.values.tolist())
    ]


def along_airspeed(sweep: xarray.Dataset) -> xarray.Dataset:
    """The sweep with its line, whatever varies, under the name that `sweep_summary` reads."""
    line = str(sweep.eigenvalue.dims[0])
    return sweep if line == "airspeed" else sweep.drop_vars("airspeed").rename({line: "airspeed"})
