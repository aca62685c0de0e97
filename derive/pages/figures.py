"""Figures of the notebooks: what the XV-15 does with the print and with the derivation.

Curves come from the derivation's expressions, the generated functions and the audit's consequences; a figure only lays
them out, in the style sheet and with the small print of the runtime's plots. `display.Picture` calls each function of
this module under the style sheet.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import sympy as sp
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray

from derive import flap_lag_springs
from derive import symbols as s
from derive.audit import consequences, tables
from derive.audit.comparison import CANDIDATES
from derive.audit.consequences import KNOT, SPEEDS, xv15
from derive.audit.counterparts import frequency_squared
from derive.audit.printed import TABLES
from derive.audit.printed.tables import PrintedTable
from derive.inertia import dependent_inertias
from proprotor.plots import rests_on
from proprotor.plots.style import COLOURS, LABEL_SIZE, line_style

Array = NDArray[Any]
DERIVED, OTHER, PRINTED, FOURTH = range(4)  # places of lines: the same in all pictures that have them
BLACK, BLUE, RED, GREEN = COLOURS[:4]
LOW_SPEEDS = np.arange(50, 451, 10) * KNOT
WING = ("beam", "chord", "torsion")


def _figure(columns: int = 1, height: float = 3.2, zero: bool = True) -> tuple[Figure, list[Axes]]:
    """Return a figure without pyplot, and its axes with a line at zero."""
    figure = Figure(figsize=(6.4 if columns == 1 else 8.0, height), dpi=100, layout="constrained")
    axes = list(figure.subplots(1, columns, squeeze=False)[0])
    for ax in axes:
        ax.grid(color="0.9", linewidth=0.6)
        ax.set_axisbelow(True)
        if zero:
            ax.axhline(0, color="0.4", linewidth=0.8)
    return figure, axes


def _titled(ax: Axes, title: str, x: str, y: str) -> None:
    ax.set_title(title, fontsize=10)
    ax.set_xlabel(x)
    ax.set_ylabel(y)


def _line(ax: Axes, x: ArrayLike, y: ArrayLike, place: int, label: str) -> None:
    """Draw a line with colour, dashes and markers of its place."""
    every = max(1, np.size(x) // 8)
    marked: dict[str, Any] = {"markevery": (place * every // 3, every), "markersize": 4.5}
    width = 2.2 if place == DERIVED else 1.6
    ax.plot(x, y, label=label, linewidth=width, **(line_style(place) | marked))


def _tell_case(ax: Axes, *more: str) -> None:
    """Write in small print which rotor this is, how it was analysed, and how far its inputs can be trusted."""
    undamped = "sections turn without damping, as in the paper"
    rests_on(ax, xv15(), f"Case {xv15().name}, {undamped}.", *more)


# Kinematics


def steady_tilt() -> Figure:
    """In-plane acceleration of the tip around the azimuth under one degree of steady tilt."""
    figure, (ax,) = _figure()
    azimuth = np.linspace(0, 2 * np.pi, 73)
    around = [consequences.steady_tilt(angle) for angle in azimuth]
    for label, place in zip(around[0], (PRINTED, OTHER, DERIVED), strict=True):
        _line(ax, np.degrees(azimuth), [at[label] for at in around], place, label)
    _titled(
        ax, "XV-15 blade tip, gimbal tilted by 1° and held", "Azimuth (deg)", "Acceleration along i (m/s²)"
    )
    ax.set_xticks(range(0, 361, 60))
    ax.set_xlim(0, 360)
    ax.legend(frameon=False, loc="upper center", ncols=3)
    ax.set_ylim(-15, 19)
    return figure


# Inertia


def false_growth() -> Figure:
    """Growth rate of a rotor in vacuum without dampers, with the Coriolis sign of Eq. 13 and with the derived one."""
    figure, (ax,) = _figure()
    signs = {
        "ζ′ of Eq. 13 as printed": (consequences.with_printed_coriolis_sign("published"), PRINTED),
        "as derived": ("published", DERIVED),
    }
    for label, (equations, place) in signs.items():
        model = consequences.hub_held().linearize(
            LOW_SPEEDS,
            equations=equations,
            airloads="none",
            pitch="rigid",
            rotor_speed="constant",
            locked=("gimbal", "pitch"),
        )
        growth = model.modes().eigenvalue.real.max("mode") / xv15().operation.rotor_speed
        _line(ax, _structural_pitch(model.trim.pitch), growth, place, label)
    _titled(
        ax,
        "XV-15 flap and lag in a vacuum, no dampers, hub held",
        "Pitch of the structural axes ϑ (deg)",
        "Largest growth rate, Re s/Ω",
    )
    ax.legend(frameon=False)
    _tell_case(ax, "Equations: published. Rigid pitch, constant rotor speed, gimbal held.")
    return figure


def _structural_pitch(pitch: Array) -> Array:
    """Return the pitch of the structural axes, deg, from the blade's pitch in rad."""
    return np.degrees(pitch + xv15().rotor.structural_pitch_offset)


# Springs


def _numbers(
    expression: sp.Expr, values: Mapping[sp.Symbol, float], over: sp.Symbol
) -> Callable[[Array], Array]:
    """Return the expression as a function of one symbol."""
    function: Callable[[Array], Array] = sp.lambdify(over, sp.sympify(expression).subs(values), "numpy")
    return function


def _springs_in(expression: sp.Expr) -> sp.Expr:
    """Replace K_eff by the four constants of the springs and the pitch."""
    numerators, determinant = flap_lag_springs.series_springs()
    stiffness = {
        flap_lag_springs.STIFFNESS[(*pair, 0)]: value / determinant for pair, value in numerators.items()
    }
    return expression.subs(stiffness)


def _of_xv15() -> dict[sp.Symbol, float]:
    symbols = (
        s.flap_stiffness,
        s.lag_stiffness,
        s.flap_outboard_fraction,
        s.lag_outboard_fraction,
        s.flap_inertia,
        s.lag_inertia,
        s.flap_first_moment,
        s.lag_first_moment,
        s.flap_hinge_offset,
        s.lag_hinge_offset,
    )
    values = {symbol: getattr(xv15().rotor, symbol.name) for symbol in symbols}
    return values | {s.rotor_speed: xv15().operation.rotor_speed}


def _of_table(table: PrintedTable) -> dict[sp.Symbol, float]:
    """Return the numbers of a printed table: springs from frequencies at rest, hinges from I_α = I + e S."""
    v = table.values
    return {
        s.flap_stiffness: v["I_β"] * v["ω_β0"] ** 2,
        s.lag_stiffness: v["I_ζ"] * v["ω_ζ0"] ** 2,
        s.flap_outboard_fraction: v["R_β"],
        s.lag_outboard_fraction: v["R_ζ"],
        s.flap_inertia: v["I_β"],
        s.lag_inertia: v["I_ζ"],
        s.flap_first_moment: v["S_β"],
        s.lag_first_moment: v["S_ζ"],
        s.flap_hinge_offset: tables.implied_offset(v, "β"),
        s.lag_hinge_offset: tables.implied_offset(v, "ζ"),
        s.rotor_speed: v["rpm"] * np.pi / 30,
    }


def frequencies_against_collective() -> Figure:
    """Flap and lag frequency in rotating axes and their coupling against the pitch of the structural axes."""
    figure, axes = _figure(columns=2)
    angle = np.radians(np.linspace(0, 90, 91))
    rotors = {"XV-15, Table 1": _of_xv15(), f"{TABLES[1].title}, Table 2": _of_table(TABLES[1])}
    for ax, (name, values) in zip(axes, rotors.items(), strict=True):
        inertia = sp.sqrt(s.flap_inertia * s.lag_inertia) * s.rotor_speed**2
        curves = (
            ("$ν_β$", sp.sqrt(_frequency_squared("flap"))),
            ("$ν_ζ$", sp.sqrt(_frequency_squared("lag"))),
            (
                r"$K_{βζ}/\sqrt{I_β I_ζ}Ω^2$",
                flap_lag_springs.STIFFNESS["flap", "lag", 0] / inertia,
            ),
        )
        for place, (label, expression) in enumerate(curves, OTHER):
            curve = _numbers(_springs_in(expression), values, s.structural_pitch)(angle)
            _line(ax, np.degrees(angle), curve * np.ones_like(angle), place, label)
        shares = f"$R_β$ = {values[s.flap_outboard_fraction]:g}, $R_ζ$ = {values[s.lag_outboard_fraction]:g}"
        _titled(ax, f"{name}: {shares}", "Pitch of the structural axes ϑ (deg)", "Per revolution")
        ax.set_xticks(range(0, 91, 15))
        ax.set_xlim(0, 90)
    axes[1].set_ylabel("")
    axes[0].legend(frameon=False)
    return figure


def _frequency_squared(name: str) -> sp.Expr:
    return frequency_squared(name).subs(dependent_inertias())


# Airloads


def lag_frequency() -> Figure:
    """Regressive lag mode on a rigid hub: in a vacuum, with the published airloads and with the consistent ones."""
    figure, (ax,) = _figure()
    variants: tuple[tuple[str, dict[str, Any], int], ...] = (
        ("in a vacuum", {"airloads": "none"}, OTHER),
        ("published equations", {"equations": "published"}, PRINTED),
        ("consistent equations", {}, DERIVED),
    )
    for label, options, place in variants:
        _line(ax, LOW_SPEEDS / KNOT, _regressive_lag(pitch="coupling", **options), place, label)
    _titled(ax, "XV-15, regressive lag mode, hub held", "Airspeed, KTAS", "Frequency (per rev, fixed frame)")
    ax.set_xlim(50, 450)
    ax.legend(frameon=False)
    rests_on(ax, xv15(), f"Case {xv15().name}, options: pitch coupling.")
    return figure


def _regressive_lag(**options: Any) -> Array:
    """Return the frequency of the regressive lag mode per revolution, with the section damping of each set."""
    modes = consequences.modes_of(consequences.hub_held(), LOW_SPEEDS, section_damping=None, **options)
    frequency: Array = modes.frequency.sel(branch="regressive lag").values
    return frequency / xv15().operation.rotor_speed


def published_and_consistent() -> Figure:
    """Damping of the wing's chord mode with the terms the print lacks in the airloads, and without them."""
    figure, (ax,) = _figure()
    variants = (
        ("published", "published", PRINTED),
        (
            "consistent without the cone in the airloads",
            consequences.consistent_but("cone_in_airloads"),
            OTHER,
        ),
        ("consistent", "consistent", DERIVED),
    )
    for label, equations, place in variants:
        _draw_damping(ax, consequences.modes_of(equations=equations), label, place)
    _of_chord(ax)
    return figure


def _draw_damping(ax: Axes, modes: xarray.Dataset, label: str, place: int) -> None:
    _line(ax, SPEEDS / KNOT, 100 * modes.damping_ratio.sel(branch="chord").values, place, label)


def _of_chord(ax: Axes) -> None:
    _titled(ax, "XV-15, wing chord mode", "Airspeed, KTAS", "Damping (% of critical)")
    ax.set_xlim(200, 450)
    ax.set_ylim(-4, 6)
    ax.legend(frameon=False)
    _tell_case(ax)


# Pitch and couplings


@functools.cache
def _couplings() -> tuple[Array, ...]:
    """Return structural pitch (deg), K_Pβ, K_Pζ, and K_Pζ without trim lag, at the trim of each airspeed."""
    model = consequences.hub_held().linearize(LOW_SPEEDS, pitch="coupling")
    _, without_lag = consequences.couplings(model, lag=0.0)
    return _structural_pitch(model.trim.pitch), *consequences.couplings(model), without_lag


def couplings_against_collective() -> Figure:
    """K_Pβ and K_Pζ along the XV-15's trim, as Eqs. 36 and 37 have them."""
    figure, (ax,) = _figure()
    angle, flap, lag, without_lag = _couplings()
    _line(ax, angle, lag, DERIVED, "$K_{Pζ}$")
    _line(ax, angle, flap, OTHER, "$K_{Pβ}$")
    _line(ax, angle, without_lag, PRINTED, r"$K_{Pζ}$ with $\bar{ζ}_0 = 0$")
    _titled(
        ax, "XV-15 along its trim", "Pitch of the structural axes ϑ (deg)", "Coupling (nose down per angle)"
    )
    ax.set_ylim(-1, 1)
    above = ax.secondary_xaxis("top")
    marks = np.arange(50, 451, 100)
    above.set_xticks(np.interp(marks, LOW_SPEEDS / KNOT, angle), [f"{mark}" for mark in marks])
    above.set_xlabel("Airspeed, KTAS")
    ax.legend(frameon=False)
    rests_on(ax, xv15(), f"Case {xv15().name}, windmilling.")
    return figure


def damping_by_coupling_sign() -> Figure:
    """The chord mode with the couplings of Eqs. 36 and 37, with both turned round by Eq. 35, and with none."""
    figure, (ax,) = _figure()
    _draw_damping(ax, consequences.modes_of(pitch="coupling"), "Eqs. 36 and 37", DERIVED)
    turned = consequences.modes_of(consequences.couplings_turned(), pitch="coupling")
    _draw_damping(ax, turned, "turned round, by the sign of Eq. 35", PRINTED)
    none: dict[str, Any] = {"pitch_flap_coupling": 0.0, "pitch_lag_coupling": 0.0}
    _draw_damping(ax, consequences.modes_of(pitch="coupling", **none), "no coupling", OTHER)
    _of_chord(ax)
    ax.set_xlim(200, 520)
    ax.set_ylim(-4, 8)
    return figure


# Assembly and errata


def gimbal_question() -> Figure:
    """Damping of the chord mode and of regressive flap with neither gimbal term of Eq. 3, either alone, and both."""
    figure, axes = _figure(columns=2)
    variants = (
        ("neither, as published", "published", PRINTED),
        ("Coriolis term alone", consequences.published_and("gimbal_coriolis"), FOURTH),
        ("roll of the yoke alone", consequences.published_and("yoke_roll"), OTHER),
        ("both, the rigid yoke", consequences.published_and("gimbal_coriolis", "yoke_roll"), DERIVED),
    )
    for label, equations, place in variants:
        modes = consequences.modes_of(equations=equations)
        for ax, branch in zip(axes, ("chord", "regressive flap"), strict=True):
            damping = 100 * modes.damping_ratio.sel(branch=branch).values
            _line(ax, SPEEDS / KNOT, damping, place, label)
    for ax, mode in zip(axes, ("Wing chord", "Regressive flap against the gimbal"), strict=True):
        _titled(ax, mode, "Airspeed, KTAS", "Damping (% of critical)")
    axes[0].set_xlim(360, 410)
    axes[0].set_ylim(-2, 2)
    axes[1].set_xlim(100, 450)
    axes[1].set_ylim(-0.2, 0.5)
    axes[1].set_ylabel("")
    axes[0].legend(frameon=False)
    _tell_case(axes[0])
    return figure


def flap_hub_inertia_of_tables() -> Figure:
    """I_βα and I_ζα of both tables by the bound of Cauchy-Schwarz, against the hinge offset that I + e S needs."""
    figure, axes = _figure(columns=2, zero=False)
    for ax, table in zip(axes, TABLES, strict=True):
        _draw_bound(ax, table)
    axes[0].legend(frameon=False, loc="lower right")
    axes[1].set_ylabel("")
    return figure


def _draw_bound(ax: Axes, table: PrintedTable) -> None:
    v = table.values
    offset = np.linspace(0, 0.22, 50) * v["R"]
    ax.axhspan(1, 1.25, color="0.9")
    ax.text(0.005, 1.2, "no mass distribution", fontsize=LABEL_SIZE, color="0.3")
    for angle, color, style, marker in (("β", BLUE, "--", "^"), ("ζ", RED, "-", "D")):
        bound = np.sqrt(v["I_b"] * v[f"I_{angle}"])
        line = (v[f"I_{angle}"] + offset * v[f"S_{angle}"]) / bound
        ax.plot(
            offset / v["R"],
            line,
            style,
            color=color,
            label=f"$(I_{angle} + e S_{angle})/\\sqrt{{I_b I_{angle}}}$",
        )
        implied = tables.implied_offset(v, angle) / v["R"]
        error = tables.rounding(v[f"I_{angle}α"]) / bound
        label = f"$I_{{{angle}α}}$ as printed"
        ax.errorbar(implied, v[f"I_{angle}α"] / bound, error, fmt=marker, color=color, label=label, capsize=3)
    _titled(ax, f"Table {table.number}: {table.title}", "Hinge offset e/R", "Inertia/its bound")
    ax.set_ylim(0.75, 1.25)
    ax.set_xlim(0, 0.22)
    ax.set_xticks(np.arange(5) / 20)


def damping_against_flap_hub_inertia() -> Figure:
    """Least eigenvalue of the XV-15's mass matrix, and its least damped mode at 250 kt, against I_βα."""
    figure, axes = _figure(columns=2)
    unit = consequences.SLUG_FT2
    values = TABLES[0].values
    inertias = np.linspace(85, 106, 43)
    models = [
        consequences.with_flap_hub_inertia(value * unit).linearize(250 * KNOT, **consequences.AS_THE_PAPER)
        for value in inertias
    ]
    least = [_least_eigenvalue(model.M) for model in models]
    damping = [100 * float(model.modes().damping_ratio.min()) for model in models]
    bound = np.sqrt(values["I_b"] * values["I_β"])
    consistent = xv15().rotor.flap_hub_inertia / unit
    for ax, curve in zip(axes, (least, damping), strict=True):
        ax.plot(inertias, curve, color=BLACK, linewidth=2)
        ax.axvline(bound, color=RED, linestyle="--")
        ax.axvline(consistent, color=BLUE, linestyle=":")
        ax.axvline(values["I_βα"], color=GREEN, linestyle="-.")
    names = (
        (bound, r"$\sqrt{I_b I_β}$", RED),
        (consistent, f"one blade, {consistent:.1f}", BLUE),
        (values["I_βα"], f"printed, {values['I_βα']:g}", GREEN),
    )
    for place, name, colour in names:  # beside their lines, which a legend would cover
        style: dict[str, Any] = {"rotation": 90, "ha": "right", "va": "bottom", "color": colour}
        at: dict[str, Any] = {"xycoords": axes[0].get_xaxis_transform(), "textcoords": "offset points"}
        axes[0].annotate(name, (place, 0.3), xytext=(-3, 0), fontsize=LABEL_SIZE, **at, **style)
    x = "$I_{βα}$ (slug ft²)"
    _titled(axes[0], "Mass matrix scaled to unit diagonal", x, "Least eigenvalue")
    _titled(axes[1], "Least damped mode at 250 kt", x, "Damping (% of critical)")
    _tell_case(axes[0])
    return figure


def _least_eigenvalue(mass: Array) -> float:
    scale = np.sqrt(np.abs(np.diagonal(mass)))
    return float(np.linalg.eigvalsh(mass / np.outer(scale, scale))[0])


def boundaries_without_terms() -> Figure:
    """Change of the chord mode's boundary when the consistent equations lose a term that the print does not have."""
    figure, (ax,) = _figure(height=3.0, zero=False)
    base = consequences.boundaries(consequences.modes_of())["chord"]
    names = {name for candidates in CANDIDATES.values() for name in candidates}
    changes = {name: consequences.boundaries_without(name)["chord"] - base for name in sorted(names)}
    for place, name in enumerate(sorted(changes, key=lambda name: changes[name])):
        change = changes[name]
        ax.barh(name.replace("_", " "), change, color=BLUE, height=0.6)
        side, align = (0.15, "left") if change >= 0 else (-0.15, "right")
        ax.text(change + side, place, f"{change:+.1f}", va="center", fontsize=LABEL_SIZE, ha=align)
    ax.axvline(0, color="0.4", linewidth=0.8)
    ax.margins(x=0.2)
    title = f"XV-15, consistent equations without one term; {base:.1f} kt with all"
    _titled(ax, title, "Change of the chord boundary (kt)", "")
    _tell_case(ax)
    return figure
