"""Drawings of axes, hinges, gimbal and swashplate, as SVG in docs/figures: `python -m derive.pages.drawings`.

Every point of a blade and every axis is one of the derivation (`derive.kinematics`), numbers put in, so a drawing
cannot show another sign than the equations have. Angles are drawn far larger than they are. The swashplate and its link
alone are a sketch: the derivation has their pitch and no geometry.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import sympy as sp
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray

from derive import kinematics as kin
from derive import multiblade
from derive import symbols as s

Array = NDArray[Any]
FIGURES = Path(__file__).resolve().parents[2] / "docs" / "figures"
FLAP_HINGE, LAG_HINGE, RADIUS = 0.18, 0.3, 1.0  # of the radius, as drawn
PRECONE, FLAP, LAG, TILT = 0.12, 0.28, 0.35, 0.3  # rad, as drawn
GREY = "0.55"
# Where I (up), J (outboard), K (forward) point on the page for who stands behind the rotor, to its left and above.
OBLIQUE = np.array([[0.0, 1.0, -0.62], [1.0, 0.0, 0.36]])


def numbers(expression: sp.Matrix, values: dict[Any, float] | None = None) -> Array:
    """Return a matrix of the derivation with numbers: perturbations and trim angles are zero unless given."""
    zero: dict[Any, float] = dict.fromkeys((*kin.q.values(), s.precone, s.coning, s.lag), 0.0)
    return np.array(expression.subs(zero | (values or {})).evalf(), dtype=float)


def point_of_blade(radius: float, values: dict[Any, float] | None = None) -> Array:
    """Return a point of the blade's line in the axes i, j, k."""
    arms = {
        kin.inboard_arm: min(radius, FLAP_HINGE),
        kin.outboard_arm: max(radius - FLAP_HINGE, 0.0),
        kin.lag_arm: max(radius - LAG_HINGE, 0.0),
    }
    return numbers(kin.blade_line(), {s.precone: PRECONE, **arms, **(values or {})}).ravel()


def blade(values: dict[Any, float] | None = None) -> Array:
    """Return centre, hinges and tip of a blade, one point a row."""
    return np.array([point_of_blade(radius, values) for radius in (0.0, FLAP_HINGE, LAG_HINGE, RADIUS)])


def axes_of_blade(azimuth: float) -> Array:
    """Return i, j, k of a blade in I, J, K, one axis a row."""
    columns = sp.Matrix.hstack(multiblade.I_AZIMUTH, multiblade.J_AZIMUTH, kin.K_AXIS)
    return numbers(columns, {multiblade.psi: azimuth}).T


def tilted(azimuth: float, cosine: float, sine: float) -> Array:
    """Return the tip of a straight blade in I, J, K, the gimbal tilted by its two coordinates."""
    shares = {"gimbal_1c": cosine, "gimbal_1s": sine}
    tilt = {}
    for name in ("gimbal_flap", "gimbal_roll"):
        seen = sum(multiblade.transform(name, column) * share for column, share in shares.items())
        tilt[kin.q[name]] = float(seen.subs(multiblade.psi, azimuth))
    along_blade = numbers(kin.GIMBAL_TILT * kin.J_AXIS, tilt).ravel()
    return along_blade @ axes_of_blade(azimuth)


# Lines on a page


def _page(columns: int, width: float, height: float) -> tuple[Figure, list[Axes]]:
    figure = Figure(figsize=(width, height), layout="constrained")
    axes = list(figure.subplots(1, columns, squeeze=False)[0])
    for ax in axes:
        ax.set_aspect("equal")
        ax.axis("off")
    return figure, axes


def _arrow(
    ax: Axes, start: ArrayLike, end: ArrayLike, text: str = "", color: str = "black", **style: Any
) -> None:
    start, end = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    arrow = {"arrowstyle": "-|>", "color": color, "shrinkA": 0, "shrinkB": 0} | style
    ax.annotate("", tuple(end), tuple(start), arrowprops=arrow)
    ax.update_datalim([start, end])
    if text:
        across, along = (end - start) / np.hypot(*(end - start))
        side = "center" if abs(across) < 0.5 else "left" if across > 0 else "right"
        place = end[0] + 0.05 * across, end[1] + 0.09 * along
        box = {"facecolor": "white", "edgecolor": "none", "pad": 0.8}  # so that no line strikes the text
        ax.text(*place, text, ha=side, va="center", color=color, bbox=box)


def _arc(ax: Axes, center: ArrayLike, radius: float, start: float, end: float, text: str) -> None:
    """Draw an angle with an arrow at its end, and its name beyond."""
    angles = np.linspace(start, end, 30)
    line = np.asarray(center) + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    ax.plot(*line.T, color="black", linewidth=1)
    _arrow(ax, line[-2], line[-1], linewidth=1)
    middle = (start + end) / 2
    x, y = np.asarray(center) + (radius + 0.07) * np.array([np.cos(middle), np.sin(middle)])
    ax.text(x, y, text, ha="left", va="center")


def _line(ax: Axes, points: ArrayLike, **style: Any) -> None:
    looks: dict[str, Any] = {"color": "black", "linewidth": 3, "solid_capstyle": "round"} | style
    ax.plot(*np.asarray(points).T, **looks)


def _hinge(ax: Axes, place: Array, name: str, below: float = -0.11) -> None:
    ax.plot(*place, "o", color="black", markerfacecolor="white", markersize=8, zorder=3)
    ax.text(place[0], place[1] + below, name, ha="center", va="top")


# Drawings


def on_page(points: Any) -> Array:
    """Return where points in I, J, K stand on the page."""
    places: Array = np.asarray(points) @ OBLIQUE.T
    return places


def axes_and_motions() -> Figure:
    """Axes of the hub I, J, K with their motions, and axes of a blade i, j, k that turn with it at Ω."""
    figure, (ax,) = _page(1, 6.4, 5.0)
    circle = np.array([axes_of_blade(angle)[1] for angle in np.linspace(0, 2 * np.pi, 100)])
    _line(ax, on_page(circle), color=GREY, linewidth=0.8, linestyle="--")
    for axis, name in zip(
        np.eye(3),
        ("I, up: $x$, $\\alpha_x$", "J, outboard: $y$, $\\alpha_y$", "K, forward: $z$, $\\alpha_z$"),
        strict=True,
    ):
        _arrow(ax, on_page(0 * axis), on_page(1.35 * axis), name)
    azimuth = np.deg2rad(72)
    for place in range(3):
        i, j, k = axes_of_blade(azimuth + place * 2 * np.pi / 3)
        _line(ax, on_page([0 * j, j]), color="black" if place == 0 else GREY)
        if place == 0:
            for axis, name in ((i, "i, trailing edge: ζ"), (j, "j, outboard"), (k, "k, thrust: β")):
                _arrow(ax, on_page(j), on_page(j + 0.4 * axis), name)
    angles = np.linspace(0, azimuth, 30)
    turning = on_page([0.5 * axes_of_blade(angle)[1] for angle in angles])
    _line(ax, turning, linewidth=1)
    _arrow(ax, turning[-2], turning[-1])
    x, y = 0.7 * turning[15]
    ax.text(x, y, "ψ, Ω", ha="center", va="center")
    return figure


def hinges() -> Figure:
    """A blade from the side, raised by the flap angle, and from above, back by the lag angle."""
    figure, (side, top) = _page(2, 9.0, 3.4)
    still, raised = blade(), blade({kin.q["flap"]: FLAP})
    for ax, of_axis in ((side, 2), (top, 0)):
        ax.set_xlim(-0.15, 1.35)
        ax.set_ylim(-0.45, 0.6)
        ax.plot([0, 1.1], [0, 0], color=GREY, linewidth=0.8, linestyle="--")
        ax.plot(0, 0, "+", color="black", markersize=12)
        _line(ax, still[:, [1, of_axis]], color=GREY, linestyle=":")
    view = [1, 2]
    _line(side, raised[:, view])
    for place, name in ((1, "$e_\\beta$"), (2, "$e_\\zeta$")):
        _hinge(side, raised[place, view], name)
    cone = np.arctan2(*(still[-1] - still[0])[[2, 1]])
    up = np.arctan2(*(raised[-1] - raised[1])[[2, 1]])
    _arc(side, np.zeros(2), 0.9, 0.0, cone, "$\\beta_P$")
    _arc(side, raised[1, view], 0.85, cone, up, "$\\bar\\beta_0+\\beta$")
    _arrow(side, [0, 0], [0, 0.45], "k, shaft")
    _arrow(side, [0, -0.25], [0.3, -0.25], "j")
    side.set_title("From the side, seen from the trailing edge", fontsize=10, pad=14)
    behind, view = blade({kin.q["lag"]: LAG}), [1, 0]
    _line(top, behind[:, view])
    for place, name in ((1, "$e_\\beta$"), (2, "$e_\\zeta$")):
        _hinge(top, behind[place, view], name)
    _arc(
        top,
        behind[2, view],
        0.6,
        0.0,
        np.arctan2(*(behind[-1] - behind[2])[[0, 1]]),
        "$\\bar\\zeta_0+\\zeta$",
    )
    _arrow(top, [0, 0], [0, 0.45], "i, trailing edge")
    _arrow(top, [1.0, -0.12], [1.0, -0.35], "Ω")
    top.set_title("Along the shaft, seen from behind", fontsize=10, pad=14)
    return figure


def gimbal() -> Figure:
    """The disk tilted by each coordinate of the gimbal: up at azimuth 0, and up at azimuth 90 degrees."""
    figure, axes = _page(2, 9.0, 3.0)
    views = ((0, (TILT, 0.0), "GC", "I, azimuth 0"), (1, (0.0, TILT), "GS", "J, azimuth 90°"))
    for ax, (along, tilt, name, axis) in zip(axes, views, strict=True):
        ahead = tilted(along * np.pi / 2, *tilt)[[along, 2]]
        behind = tilted(along * np.pi / 2 + np.pi, *tilt)[[along, 2]]
        ax.plot([-1.1, 1.1], [0, 0], color=GREY, linewidth=0.8, linestyle="--")
        _line(ax, [behind, ahead])
        ax.plot(0, 0, "o", color="black", markerfacecolor="white", markersize=9, zorder=3)
        _arc(ax, np.zeros(2), 0.8, 0.0, float(np.arctan2(ahead[1], ahead[0])), f"$\\beta_{{{name}}}$")
        _arrow(ax, [0, 0], [0, 0.75], "K, shaft")
        _arrow(ax, [0.9, 0], [1.25, 0])
        ax.text(1.1, -0.13, axis, ha="center", va="center")
        ax.set_xlim(-1.25, 1.5)
    return figure


def swashplate() -> Figure:
    """A section seen from the root: the swashplate raises a link, a spring gives way, and the nose turns up."""
    figure, (ax,) = _page(1, 6.4, 4.0)
    pitch = 0.35
    # Nose up is a turn about +j, as in the springs; the page has i to the right and k upward, seen from the root.
    turn = numbers(sp.rot_ccw_axis2(pitch))[[0, 2]][:, [0, 2]]
    outline = np.array([[x, y] for x, y in _airfoil()])
    _line(ax, outline @ turn.T, linewidth=1.5)
    _line(ax, np.array([[-0.55, 0.0], [1.0, 0.0]]), color=GREY, linewidth=0.8, linestyle="--")
    chord = np.array([[-0.3, 0.0], [0.75, 0.0]]) @ turn.T
    _line(ax, chord, color=GREY, linewidth=0.8)
    horn = np.array([-0.5, 0.0]) @ turn.T
    _line(ax, [np.zeros(2), horn], linewidth=2)
    ax.plot(0, 0, "o", color="black", markerfacecolor="white", markersize=9, zorder=3)
    ax.text(0.03, 0.13, "pitch axis", ha="left")
    coil = np.linspace(horn[1], -0.55, 15)
    offset = 0.04 * np.array([0, 0, *([1, -1] * 5), 0, 0, 0])
    _line(ax, np.column_stack([horn[0] + offset, coil]), linewidth=1)
    ax.text(horn[0] - 0.1, -0.25, "link and control\nsystem: $K_\\theta$", ha="right", va="center")
    _line(ax, [[-0.95, -0.58], [0.3, -0.58]], linewidth=5, color=GREY)
    ax.text(
        0.35, -0.58, "swashplate: turns with the rotor,\nfollows the shaft and not the gimbal", va="center"
    )
    _arrow(ax, [-0.8, -0.95], [-0.8, -0.65])
    ax.text(-0.75, -0.85, "collective, cyclic", ha="left", va="center")
    _arc(ax, np.zeros(2), 0.62, np.pi, np.pi - pitch, "")
    ax.text(-0.78, 0.14, "$\\bar\\theta+\\theta$, nose up", ha="right", va="center")
    _arrow(ax, [1.05, 0.35], [1.35, 0.35], "i")
    _arrow(ax, [1.05, 0.35], [1.05, 0.65], "k")
    ax.set_xlim(-1.7, 1.7)
    return figure


def _airfoil() -> list[tuple[float, float]]:
    """Return the outline of a symmetric section, 12 % thick, its pitch axis at a quarter of the chord."""
    x = (1 - np.cos(np.linspace(0, np.pi, 40))) / 2
    half = 0.6 * (0.2969 * np.sqrt(x) - 0.126 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4)
    upper, lower = zip(x - 0.25, half, strict=True), zip(x[::-1] - 0.25, -half[::-1], strict=True)
    return [*upper, *lower]


DRAWINGS: dict[str, Callable[[], Figure]] = {
    "axes": axes_and_motions,
    "hinges": hinges,
    "gimbal": gimbal,
    "swashplate": swashplate,
}


def write(folder: Path) -> None:
    """Write every drawing into a folder, with the same bytes each time."""
    for name, draw in DRAWINGS.items():
        with mpl.rc_context({"svg.hashsalt": name, "svg.fonttype": "path", "font.size": 10}):
            draw().savefig(folder / f"{name}.svg", metadata={"Date": None}, bbox_inches="tight")


if __name__ == "__main__":
    write(FIGURES)
