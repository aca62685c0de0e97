"""The style sheet of all plots: sizes, colours, dashes and markers; a style for each mode.

Colours, dashes and markers differ for colour-blind readers and on grey prints.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from functools import wraps
from itertools import count
from typing import Any, NamedTuple, ParamSpec, TypeVar

from proprotor.tables.sweep_summary import broad_modes
from proprotor.typing import Dataset

# Okabe and Ito's colours, which colour-blind readers can distinguish; without the yellow, which is too pale on white.
COLOURS = ("#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
# Of bars that lower stability, or of the lower end of a range, and of the others; light and dark on a grey print.
DRIVES, DAMPS = "#E69F00", "#0072B2"
STABLE = "#C4E3D8"  # a green that prints as a light grey
UNSTABLE = "#FBE9DF"  # prints as almost white
UNKNOWN: dict[str, Any] = {"facecolor": "0.93", "edgecolor": "0.6", "hatch": "////", "linewidth": 0}
RING: dict[str, Any] = {"markerfacecolor": "white", "markeredgecolor": "black", "zorder": 5}  # of a boundary
GREY = "0.35"
TITLE_SIZE, LABEL_SIZE, SMALL_SIZE = 11, 8, 7  # points: titles, names within plots and legends, small print
# Settings of Matplotlib for axes, their texts and legends; a user's own settings go before these.
SHEET: dict[str, Any] = {
    "axes.edgecolor": "0.25",
    "axes.labelsize": 9.0,
    "axes.linewidth": 0.7,
    "axes.titlelocation": "left",
    "axes.titlesize": TITLE_SIZE,
    "hatch.linewidth": 0.7,
    "legend.edgecolor": "0.8",
    "legend.fontsize": LABEL_SIZE,
    "legend.framealpha": 0.95,
    "legend.title_fontsize": LABEL_SIZE,
    "xtick.labelsize": LABEL_SIZE,
    "ytick.labelsize": LABEL_SIZE,
}
_DASHES = ("-", "--", ":")
_CASE_DASHES = ("-", "--", "-.", ":")  # of cases, gusts or variants that one picture compares
_SYMMETRIC, _ANTISYMMETRIC = ("-", "-."), ("--", ":")  # dashes of the modes of an aircraft
_LATER = {  # dashes of the same line of a further sweep on the same axes
    "-": (0, (6, 1.6)),
    "--": (0, (3, 3)),
    ":": (0, (1, 3)),
    "-.": (0, (8, 2, 1, 2, 1, 2)),
}
_MARKERS = "s^DvP<>Xp8dhH*"  # on broad lines, because their colours alone do not differ on a grey print
# Places of motions in the turns of colours and dashes: in every picture of every case a motion looks the same.
_TURN = (
    *("beam", "chord", "torsion", "coning", "regressive flap", "progressive flap", "collective lag"),
    *("regressive lag", "progressive lag", "collective pitch", "regressive pitch", "progressive pitch"),
    *("rotor speed", "regressive gimbal", "progressive gimbal"),
)
_PLACES = {motion: place for place, motion in enumerate(_TURN)}
# Of aircraft, whose modes of the support are drawn, and of the rotor those alone that become unstable.
_PLACES |= {"heave": 3, "pylon pitch": 4, "axial": 4, "pylon yaw": 5, "pitch": 6, "beam_2": 7, "chord_2": 8}
_PLACES |= {"torsion_2": 9, "surge": 10, "sway": 11, "roll": 12, "yaw": 13}

# Hatches of bars by the status of a number; the bar of a number that was read in a source has no hatch.
STATUS_HATCHES = {"recalled": "////", "assumed": "xxxx", "calibrated": "...."}


_NUMBERED = re.compile(r"mode ([1-9]\d?)")
_Given = ParamSpec("_Given")
_Drawn = TypeVar("_Drawn")


def in_style(draw: Callable[_Given, _Drawn]) -> Callable[_Given, _Drawn]:
    """Draw with the settings of `SHEET` that the user has left as Matplotlib has them."""

    @wraps(draw)
    def drawn(*args: _Given.args, **given: _Given.kwargs) -> _Drawn:
        import matplotlib  # here, because matplotlib takes long to import

        usual: Any = matplotlib.rcParamsDefault  # typed for literal names alone
        now: Any = matplotlib.rcParams
        free: Any = {name: value for name, value in SHEET.items() if now[name] == usual[name]}
        with matplotlib.rc_context(free):
            return draw(*args, **given)

    return drawn


def halo() -> list[Any]:
    """Return the effects of a text over lines: a thin white edge around letters, which hides little of the lines."""
    from matplotlib import patheffects  # here, because matplotlib takes long to import

    return [patheffects.withStroke(linewidth=2, foreground="white")]


def white_box(pad: float) -> dict[str, Any]:
    """Return the box of a text that stands over lines; `pad` is the room around the text, points."""
    return {"facecolor": "white", "edgecolor": "none", "pad": pad}


class ModeStyle(NamedTuple):
    """Style of the line of one mode; the fields are arguments of Matplotlib's `plot`."""

    color: str
    linestyle: Any
    linewidth: float
    marker: str


def mode_styles(sweep: Dataset) -> list[ModeStyle]:
    """Return a style for each mode of a sweep, in the order of the modes.

    No two of as many modes as a plot draws share both colour and dashes. The same mode looks the same in every plot of
    every case, as far as the other modes leave its style free. Modes of the support and unstable modes have broad lines
    with markers. Of an aircraft the symmetric and the antisymmetric mode of one motion share their colour; the
    antisymmetric one is broken.
    """
    broad = broad_modes(sweep)
    modes = sweep.mode.values.tolist()
    styles = styles_of_modes([*filter(broad.__contains__, modes), *modes])
    single = "o" if len(sweep.reason) == 1 else ""
    return [
        styles[mode] if mode in broad else styles[mode]._replace(linewidth=1.2, marker=single)
        for mode in modes
    ]


def styles_of_modes(modes: Iterable[str]) -> dict[str, ModeStyle]:
    """Return the style of a broad line of each mode, which is the same in every picture of every case.

    Where two motions have one place, the first of them has it, and the other one the next that is free.
    """
    places = mode_places(modes)
    return {
        mode: ModeStyle(
            color=COLOURS[place % len(COLOURS)],
            linestyle=_dashes(mode, place // len(COLOURS)),
            linewidth=2.4,
            marker=_MARKERS[place % len(_MARKERS)],
        )
        for mode, place in places.items()
    }


def mode_places(modes: Iterable[str]) -> dict[str, int]:
    """Return the place of each mode in the turns of colours and dashes: its motion's own, or the next that is free."""
    modes = list(dict.fromkeys(modes))
    taken: dict[str, int] = {}
    motions = dict.fromkeys(map(_motion, modes))
    # Motions without a place come last.
    for motion in sorted(motions, key=lambda motion: _usual_place(motion) is None):
        free = (place for place in count(_usual_place(motion) or 0) if place not in taken.values())
        taken[motion] = next(free)
    return {mode: taken[_motion(mode)] for mode in modes}


def _usual_place(motion: str) -> int | None:
    """Return the place of a motion that has one: those of the list, and modes that a support numbers."""
    number = _NUMBERED.fullmatch(motion)
    return int(number[1]) - 1 if number else _PLACES.get(motion)


def line_style(place: int) -> dict[str, Any]:
    """Return colour, dashes and marker of the line of the first, second and so on case that one picture compares."""
    return {
        "color": COLOURS[place % len(COLOURS)],
        "linestyle": _CASE_DASHES[place % len(_CASE_DASHES)],
        "marker": _MARKERS[place % len(_MARKERS)],
    }


def of_later_sweep(style: ModeStyle, place: int) -> ModeStyle:
    """Return the style of a mode's line in a further sweep on the same axes, the `place` of which is 1 or more."""
    _, dashes = _LATER[style.linestyle]
    longer = 1 + 0.6 * (place - 1)
    width = style.linewidth * (0.75 if style.linewidth > 2 else 1)
    return style._replace(linestyle=(0, tuple(longer * part for part in dashes)), linewidth=width)


def _motion(mode: str) -> str:
    """Return what moves in a mode, of an aircraft without the symmetry."""
    return mode.removeprefix("anti").removeprefix("symmetric ")


def _dashes(mode: str, turn: int) -> str:
    """Return the dashes of a mode, of the colours' first turn or a later one."""
    own = {"symmetric": _SYMMETRIC, "antisymmetric": _ANTISYMMETRIC}.get(mode.partition(" ")[0], _DASHES)
    return own[turn % len(own)]
