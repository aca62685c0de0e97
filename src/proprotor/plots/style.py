"""Colours, dashes and markers that differ for colour-blind readers and on grey prints; a style for each mode."""

from __future__ import annotations

from itertools import cycle
from typing import Any, NamedTuple

from proprotor.tables.sweep_summary import broad_modes
from proprotor.typing import Dataset

# Okabe and Ito's colours, which colour-blind readers can distinguish; without the yellow, which is too pale on white.
COLOURS = ("#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
DRIVES, DAMPS = "#D55E00", "#0072B2"  # of bars that lower stability, and of bars that raise stability
STABLE = "#D8EEE6"  # a light green that prints as a light grey
UNSTABLE = "#FBE9DF"
GREY = "0.35"
LABEL_SIZE = 8  # points
_DASHES = ("-", "--", ":")
_SYMMETRIC, _ANTISYMMETRIC = ("-", "-."), ("--", ":")  # dashes of the modes of an aircraft
_MARKERS = "s^DvP<>"  # on broad lines, because their colours alone do not differ on a grey print

# Hatches of bars by the status of a number; the bar of a number that was read in a source has no hatch.
STATUS_HATCHES = {"recalled": "////", "assumed": "xxxx", "calibrated": "...."}


def white_box(pad: float) -> dict[str, Any]:
    """Return the box of a text that stands over lines; `pad` is the room around the text, points."""
    return {"facecolor": "white", "edgecolor": "none", "pad": pad}


class ModeStyle(NamedTuple):
    """Style of the line of one mode; the fields are arguments of Matplotlib's `plot`."""

    color: str
    linestyle: str
    linewidth: float
    marker: str


def mode_styles(sweep: Dataset) -> list[ModeStyle]:
    """Return a style for each mode of a sweep, in the order of the modes.

    No two of as many modes as a plot draws share both colour and dashes. The same mode looks the same in every plot of
    a sweep. Modes of the support and unstable modes have broad lines with markers. Of an aircraft the symmetric and the
    antisymmetric mode of one motion share their colour; the antisymmetric one is broken.
    """
    broad = broad_modes(sweep)
    modes = sweep.mode.values.tolist()
    motions = list(dict.fromkeys(map(_motion, modes)))
    markers = dict(zip([motion for motion in motions if motion in set(map(_motion, broad))], cycle(_MARKERS)))
    single = "o" if len(sweep.reason) == 1 else ""
    return [
        ModeStyle(
            color=COLOURS[motions.index(_motion(mode)) % len(COLOURS)],
            linestyle=_dashes(mode, motions.index(_motion(mode)) // len(COLOURS)),
            linewidth=2.4 if mode in broad else 1.2,
            marker=markers[_motion(mode)] if mode in broad else single,
        )
        for mode in modes
    ]


def _motion(mode: str) -> str:
    """Return what moves in a mode, of an aircraft without the symmetry."""
    return mode.removeprefix("anti").removeprefix("symmetric ")


def _dashes(mode: str, turn: int) -> str:
    """Return the dashes of a mode, of the colours' first turn or a later one."""
    own = {"symmetric": _SYMMETRIC, "antisymmetric": _ANTISYMMETRIC}.get(mode.partition(" ")[0], _DASHES)
    return own[turn % len(own)]
