"""Frequencies of an elastic blade and of its hinged blade, over collective and over rotor speed (a fan plot)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from proprotor.model.blade_comparison import hinged_frequencies, in_vacuum
from proprotor.plots import small_print
from proprotor.plots.canvas import grid, note
from proprotor.plots.style import COLOURS, GREY, LABEL_SIZE, SMALL_SIZE, in_style
from proprotor.rotor.blade_stations import BladeStations
from proprotor.rotor.elastic_blade import ElasticBlade
from proprotor.rotor.hinged_blade import HingedBlade
from proprotor.typing import Array, Axes, Figure

_MODES = 4
_SPEEDS = 25
_HARMONICS = 5
_RPM = np.pi / 30
_ELASTIC: dict[str, Any] = {"color": COLOURS[0], "linewidth": 1.4}
_HINGED: dict[str, Any] = {"color": COLOURS[2], "linestyle": "--", "linewidth": 1.8}


@in_style
def plot_blade_frequencies(
    stations: BladeStations, found: HingedBlade, rotor_speeds: Sequence[float]
) -> Figure:
    """Draw the frequencies of both blades in a vacuum, in rotating axes.

    Parameters
    ----------
    stations : BladeStations
    found : HingedBlade
        Of these stations.
    rotor_speeds : (float, float)
        Ends of the fan, rad/s.

    Returns
    -------
    matplotlib.figure.Figure
        Above, per revolution over collective at the rotor speed of the fit; below, in Hz over the rotor speed at the
        middle collective. On the left modes in which all blades move alike, on the right those that tilt the gimbal.
    """
    import matplotlib.pyplot as plt  # here, because matplotlib takes long to import

    figure, axes = plt.subplots(2, 2, figsize=(9, 7), sharey="row", layout="constrained")
    small_print.own(figure)
    blade, rotor = ElasticBlade(stations), in_vacuum(found)
    pitch, speed = np.linspace(found.pitch.min(), found.pitch.max(), _SPEEDS), found.rotor_speed
    own = hinged_frequencies(rotor, speed, pitch)
    # The rotor's equations want a speed above zero.
    speeds = np.linspace(max(rotor_speeds[0], 0.02 * rotor_speeds[1]), rotor_speeds[1], _SPEEDS)
    middle = float(np.median(found.pitch))
    turning = hinged_frequencies(rotor, speeds, np.full(_SPEEDS, middle))
    for column, hold in enumerate(("clamped", "gimballed")):
        above, below = axes[:, column]
        elastic = blade.modes(speed, pitch, hold, _MODES).frequency / speed
        _draw(above, np.degrees(pitch), elastic, own[column] / speed)
        fan = blade.modes(speeds, middle, hold, _MODES).frequency / (2 * np.pi)
        hinged = turning[column] / (2 * np.pi)
        _draw(below, speeds / _RPM, fan, hinged)
        above.set_title(("All blades alike", "Cyclic, on a free gimbal")[column], fontsize=LABEL_SIZE + 1)
        above.set_xlabel("Collective at 0.75 R (deg)")
        below.set_xlabel("Rotor speed (rpm)")
        below.axvline(speed / _RPM, color="0.6", linewidth=0.8, linestyle="-.")
    axes[0, 0].set_ylabel("Frequency (per rev)")
    axes[1, 0].set_ylabel("Frequency (Hz)")
    axes[0, 0].legend()
    axes[0, 0].set_ylim(0, 1.05 * float(elastic.max()))
    axes[1, 0].set_ylim(0, 1.05 * float(fan.max()))
    for below in axes[1]:
        _draw_harmonics(below, speeds)
    note(axes[0, 0], "Blades in a vacuum, in rotating axes")
    note(axes[0, 0], f"Above at {speed / _RPM:.4g} rpm, which a line marks below")
    note(axes[1, 0], f"Below at {np.degrees(middle):.3g}° collective")
    return figure


def _draw(ax: Axes, across: Array, elastic: Array, hinged: Array) -> None:
    """Draw the modes of both blades, those of the hinged one dashed."""
    for values, style, name in ((elastic, _ELASTIC, "elastic blade"), (hinged, _HINGED, "hinged blade")):
        for place, mode in enumerate(values.T):
            ax.plot(across, mode, label=name if place == 0 else None, **style)
    grid(ax)
    ax.set_xlim(across[0], across[-1])


def _draw_harmonics(ax: Axes, speeds: Array) -> None:
    """Draw the multiples of the rotor speed, their names beside the axes, of which the limits are set."""
    for n in range(1, _HARMONICS + 1):
        ax.plot(speeds / _RPM, n * speeds / (2 * np.pi), color="0.75", linewidth=0.7, zorder=0)
        end = (speeds[-1] / _RPM, n * speeds[-1] / (2 * np.pi))
        beside: dict[str, Any] = {"xytext": (3, 0), "textcoords": "offset points", "va": "center"}
        if end[1] <= ax.get_ylim()[1]:
            ax.annotate(f"{n}/rev", end, fontsize=SMALL_SIZE, color=GREY, annotation_clip=False, **beside)
