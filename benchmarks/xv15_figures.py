"""Figures of docs/xv15.md: couplings and lag frequency of the XV-15 against airspeed.

python -m benchmarks.xv15_figures docs/figures
"""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

import proprotor as pp
from benchmarks.xv15_boundary import KNOT, lowest_of_wing
from benchmarks.xv15_frequencies import on_rigid_hub
from benchmarks.xv15_switches import PAPER_FREQUENCIES, blade_state, boundaries

AIRSPEEDS = np.arange(50, 451, 5) * KNOT
BLACK, BLUE, RED, GREEN = "#000000", "#0072B2", "#D55E00", "#009E73"  # Okabe and Ito


def axes(title: str, label: str) -> Axes:
    _, ax = plt.subplots(figsize=(7.5, 4.2), layout="constrained")
    ax.set_title(title, loc="left", fontsize=10)
    ax.set_xlabel("Airspeed (kt)")
    ax.set_ylabel(label)
    ax.set_xlim(AIRSPEEDS[0] / KNOT, AIRSPEEDS[-1] / KNOT)
    ax.grid(color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)
    return ax


def couplings(case: pp.Case) -> Axes:
    """K_Pβ and K_Pζ of Eqs. 36 and 37."""
    ax = axes("Pitch-flap and pitch-lag coupling, XV-15", "Coupling (nose down per angle)")
    state, knots = blade_state(case, AIRSPEEDS), AIRSPEEDS / KNOT
    ax.axhline(0, color="0.4", linewidth=0.8)
    ax.plot(knots, state.pitch_flap_coupling, "--", color=BLUE, label="$K_{Pβ}$")
    ax.plot(knots, state.pitch_lag_coupling, color=RED, linewidth=2, label="$K_{Pζ}$")
    without_lag = state.pitch_lag_coupling_without_lag
    ax.plot(knots, without_lag, ":", color=RED, label="$K_{Pζ}$ without the trim lag $\\bar{ζ}_0$")
    boundary = lowest_of_wing(boundaries(case, pitch="coupling"))
    ax.axvline(boundary, color="0.4", linewidth=0.8)
    ax.text(boundary - 4, 0.98, f"boundary, {boundary:.0f} kt", rotation=90, ha="right", va="top", fontsize=8)
    marker = {"color": "white", "markeredgecolor": BLACK, "zorder": 3}
    ax.plot([boundary], [-0.3], "o", **marker, label="−0.3, to which $K_θ$ is calibrated")
    ax.set_ylim(-1, 1)
    ax.legend(frameon=False, loc="upper right", bbox_to_anchor=(0.79, 1))
    return ax


def lag_frequency(case: pp.Case) -> Axes:
    """The low-frequency cyclic lag mode, and the frequencies it comes from."""
    ax = axes("Low-frequency cyclic lag mode, XV-15 on a rigid hub", "Frequency (per rev, fixed frame)")
    knots = AIRSPEEDS / KNOT
    for airloads, label, style, color in (
        ("full", "with airloads", "-", BLACK),
        ("none", "in a vacuum", "--", BLUE),
    ):
        frequency = on_rigid_hub(case, AIRSPEEDS, airloads=airloads, pitch="coupling")["low cyclic lag"]
        ax.plot(knots, frequency, style, color=color, linewidth=2, label=label)
    uncoupled = blade_state(case, AIRSPEEDS).lag_frequency - 1
    ax.plot(knots, uncoupled, ":", color=RED, label="uncoupled $ν_ζ − 1$")
    speeds, given = np.array(PAPER_FREQUENCIES.at) / KNOT, np.array(PAPER_FREQUENCIES.lag) - 1
    label = "$ν_ζ − 1$ of AIAA-2002-1604, first and last (speeds assumed)"
    ax.plot(speeds, given, "s", color=GREEN, clip_on=False, zorder=3, label=label)
    ax.set_ylim(0, 1.2)
    ax.legend(frameon=False)
    return ax


def main() -> None:
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    case = pp.load_case("xv15")
    for draw, name in ((couplings, "xv15-couplings"), (lag_frequency, "xv15-lag-frequency")):
        draw(case).figure.savefig(folder / f"{name}.png", dpi=150)


if __name__ == "__main__":
    main()
