"""Margins of control loops over airspeed: gain above, phase below."""

from __future__ import annotations

import numpy as np

from proprotor.model.doubts import doubtful_near, doubts_along, footnotes, marked
from proprotor.model.stamp import density_of
from proprotor.plots import small_print
from proprotor.plots.canvas import grid, note, say_origin, two_axes, write_title
from proprotor.plots.end_labels import label_lines
from proprotor.plots.line_of_sweep import Positions, axis_of, written
from proprotor.plots.mode_lines import mark_failed
from proprotor.plots.style import LABEL_SIZE, UNSTABLE, in_style, line_style
from proprotor.stability.margin_ranges import Needed, decibels
from proprotor.typing import Array, Axes, Dataset, Figure

_TOPS = (30.0, 180.0)  # of the axes, dB and degrees: more is as good as no limit


@in_style
def plot_margins(
    margins: Dataset,
    *,
    gain_margin: float = 6.0,
    phase_margin: float = np.pi / 4,
    unit: str | None = None,
    title: str = "",
    footer: str = "",
) -> Figure:
    """Draw the gain margin and, below, the phase margin of each control loop over airspeed, in a new figure.

    Parameters
    ----------
    margins : xarray.Dataset
        Result of `Case.margins`.
    gain_margin : float
        Needed to either side, in dB, a ratio; a line marks it.
    phase_margin : float
        Needed to either side, rad.
    unit : str, optional
        Unit of the airspeed, "ktas" by default.
    title, footer : str
        Texts above and below the plots.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the unit is no unit of airspeed.
    """
    line = axis_of("airspeed", margins.airspeed.values, "m/s", unit, density_of(margins.attrs))
    figure, (above, below) = two_axes((8, 7))
    needed = Needed(gain_margin, phase_margin)
    write_title(figure, title, _first_lost(margins, line, needed))
    _draw(above, line, margins, decibels(margins), _TOPS[0], needed.gain, "dB")
    _draw(
        below,
        line,
        margins,
        np.degrees(margins.phase_margin.values),
        _TOPS[1],
        float(np.degrees(needed.phase)),
        "deg",
    )
    above.set_ylabel("Gain margin, either way (dB)")
    below.set_ylabel("Phase margin (deg)")
    above.set_xlabel("")
    small_print.add(below, footer)
    say_origin(below, margins.attrs, _doubts(margins, line))
    return figure


def _first_lost(margins: Dataset, line: Positions, needed: Needed) -> str:
    """Return which loop lacks a margin at the lowest airspeed, interpolated between the airspeeds of the result."""
    degrees = float(np.degrees(needed.phase))
    lost = [
        (at, f"{loop} has less than {least:.3g} {unit}")
        for values, least, unit in (
            (decibels(margins), needed.gain, "dB of gain margin"),
            (np.degrees(margins.phase_margin.values), degrees, "deg of phase margin"),
        )
        for loop, own in zip(margins.loop.values.tolist(), values.T, strict=True)
        if (at := _falls_below(margins.airspeed.values, own, least)) is not None
    ]
    unstable = margins.airspeed.values[~margins.stable.values & (margins.reason.values == "")]
    lost += [(float(at), "the closed loop is unstable") for at in unstable[:1]]
    unit = written(line.unit)
    if not lost:
        return f"all loops keep {needed.text} from {line.values[0]:.4g} to {line.values[-1]:.4g} {unit}"
    at, what = min(lost)
    doubtful = doubtful_near(margins.airspeed.values, margins.warning.values, at)
    return f"{what} from {marked(f'{at / line.factor:.0f}', doubtful)} {unit}"


def _falls_below(airspeed: Array, values: Array, least: float) -> float | None:
    """Return the lowest airspeed at which a margin is less than the least one; None where it never is."""
    below = np.flatnonzero(values < least)
    if not len(below):
        return None
    place = int(below[0])
    before = values[place - 1] if place else np.nan
    if not np.isfinite(before):
        return float(airspeed[place])
    return float(np.interp(least, [values[place], before], [airspeed[place], airspeed[place - 1]]))


def _doubts(margins: Dataset, line: Positions) -> list[str]:
    """Return a sentence for each doubt along the airspeeds."""
    doubts = doubts_along(margins.airspeed.values, margins.warning.values)
    return list(footnotes(doubts, written(line.unit), line.factor))


def _draw(
    ax: Axes, line: Positions, margins: Dataset, values: Array, top: float, needed: float, unit: str
) -> None:
    """Draw one margin (airspeed, loop) up to a top, the margin that is needed, and where the loop is unstable."""
    shown = np.where(np.isnan(values), np.nan, np.minimum(values, top))
    lines = []
    for place, loop in enumerate(margins.loop.values.tolist()):
        style = line_style(place) | {"markersize": 4, "linewidth": 2.0}
        if np.isfinite(shown[:, place]).any():
            lines += ax.plot(line.values, shown[:, place], label=str(loop), **style)
    ax.axhline(needed, color="black", linewidth=0.9, linestyle="--", zorder=1)
    ax.text(
        0.01,
        needed,
        f"needed: {needed:.3g} {unit}",
        fontsize=LABEL_SIZE,
        va="bottom",
        transform=ax.get_yaxis_transform(),
    )
    ax.margins(x=0.01)
    ax.set_ylim(0, top * 1.02)
    failed = margins.reason.values != ""
    _mark_instability(ax, line, margins.stable.values | failed)
    mark_failed(ax, line, failed, first=True)
    grid(ax)
    if (values > top).any():
        note(ax, f"At {top:g} {unit}: that much or more, or no limit")
    label_lines(ax, lines, "the margin")


def _mark_instability(ax: Axes, line: Positions, stable: Array) -> None:
    """Shade the airspeeds at which the closed loop is unstable, from the middle between two airspeeds on."""
    middles = np.concatenate([line.values[:1], (line.values[1:] + line.values[:-1]) / 2, line.values[-1:]])
    for place in np.flatnonzero(~stable):
        ax.axvspan(middles[place], middles[place + 1], color=UNSTABLE, linewidth=0, zorder=0.5)
    if not stable.all():
        ax.text(
            0.99,
            0.03,
            "shaded: unstable",
            fontsize=LABEL_SIZE,
            ha="right",
            transform=ax.transAxes,
        )
