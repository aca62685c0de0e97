"""The figures of AIAA-2002-1604, each with the paper's axes and the variants of the model that it compares."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from benchmarks.paper_figures.analyses import XV15, Analyses
from benchmarks.paper_figures.content import BandCurves, Content, Curve
from benchmarks.paper_figures.published import (
    CONING_FREQUENCY,
    CYCLIC_FLAP_FREQUENCY,
    LAG_AIRSPEEDS,
    LAG_FREQUENCIES,
    PAPER_FREQUENCIES,
    PITCH_LAG_COUPLING,
    XV15_MARK,
)
from benchmarks.paper_figures.wing_modes import WingModes
from proprotor.errors import InputError
from proprotor.model import stamp
from proprotor.model.doubts import MARK, footnotes, marked
from proprotor.typing import Array
from proprotor.units import KNOT

_DAMPING = "Modal damping"
_UNDAMPED = "Sections turn without damping, as in the paper (section_damping=False)."
_PERCENT = "% of critical"
_BELOW_ZERO = -2.0  # lower end of the damping axes; the paper's begin at zero
_TITLES = {"beam": "wing vertical bending", "chord": "wing chordwise bending", "torsion": "wing torsion"}
_WRATS_AXES = ((60.0, 180.0), 8.0)
_XV15_RANGE = (0.0, 500.0)


class _Damping(NamedTuple):
    """A figure of the damping of one mode: its variants with their labels, and the paper's axes."""

    what: str
    deck: str
    mode: str
    x_limits: tuple[float, float]
    highest: float
    curves: dict[str, str]
    with_band: bool = False


_COUPLINGS = "couplings in place of pitch equations, all terms"
_MODEL = {"couplings": _COUPLINGS, "published equations": "the same with the paper's terms alone"}
_MODEL_AND_PITCH = _MODEL | {"pitch equations": "pitch equations, all terms"}
_STIFFNESS = {
    "couplings": "baseline",
    "no flap-lag stiffness": "$K_{βζ} = 0$, couplings as they were",
    "no flap-lag stiffness, couplings follow": "$K_{βζ} = 0$, in the couplings as well",
    "given frequencies": "lag 1.8 to 1.2, flap 1.85 per rev given",
    "own frequencies given": "lag of this model, flap 1.85 per rev given",
}
_PITCH = {
    "couplings": "baseline, both couplings",
    "pitch equations": "pitch equations",
    "no pitch-flap coupling": "$K_{Pβ} = 0$",
    "no couplings": "$K_{Pβ} = K_{Pζ} = 0$",
}


def _wrats(condition: str) -> str:
    return f"WRATS model ({condition}, air)"


_V22 = "1/5-scale V-22 model (85 % rpm, on downstop, air)"
_DAMPING_FIGURES = {
    4: _Damping("XV-15 semispan", XV15, "beam", _XV15_RANGE, 10, _MODEL_AND_PITCH, True),
    5: _Damping("XV-15 semispan", XV15, "chord", _XV15_RANGE, 8, _MODEL_AND_PITCH, True),
    6: _Damping("XV-15 semispan", XV15, "torsion", _XV15_RANGE, 16, _MODEL_AND_PITCH, True),
    7: _Damping(_V22, "v22-fifth-scale", "beam", (0, 200), 8, _MODEL, True),
    8: _Damping(_V22, "v22-fifth-scale", "chord", (0, 250), 6, _MODEL, True),
    9: _Damping(_wrats("742 rpm, off downstop"), "wrats-742-off", "beam", *_WRATS_AXES, _MODEL, True),
    10: _Damping(_wrats("888 rpm, off downstop"), "wrats-888-off", "beam", *_WRATS_AXES, _MODEL, True),
    11: _Damping(_wrats("770 rpm, on downstop"), "wrats-770-on", "beam", *_WRATS_AXES, _MODEL, True),
    12: _Damping(_wrats("888 rpm, on downstop"), "wrats-888-on", "beam", *_WRATS_AXES, _MODEL, True),
    15: _Damping("XV-15, flap-lag stiffness", XV15, "beam", _XV15_RANGE, 10, _STIFFNESS),
    16: _Damping("XV-15, flap-lag stiffness", XV15, "chord", _XV15_RANGE, 8, _STIFFNESS),
    17: _Damping("XV-15, flap-lag stiffness", XV15, "torsion", _XV15_RANGE, 12, _STIFFNESS),
    22: _Damping("XV-15, modelling of pitch", XV15, "beam", _XV15_RANGE, 10, _PITCH),
    23: _Damping("XV-15, modelling of pitch", XV15, "chord", _XV15_RANGE, 8, _PITCH),
    24: _Damping("XV-15, modelling of pitch", XV15, "torsion", _XV15_RANGE, 12, _PITCH),
}


def make_figure(number: int, analyses: Analyses) -> Content:
    """Return the content of a figure, analysed.

    Raises
    ------
    InputError
        When the paper has no analytical figure of that number.
    """
    check_number(number)
    if number in _DAMPING_FIGURES:
        return _damping_figure(number, _DAMPING_FIGURES[number], analyses)
    return _OTHER_FIGURES[number](analyses)


def check_number(number: int) -> None:
    """Raise an `InputError` with the known numbers when the paper has no analytical figure of a number."""
    if number not in NUMBERS:
        known = ", ".join(map(str, NUMBERS))
        raise InputError("figure", number, f"is no analytical figure of AIAA-2002-1604; they are {known}")


def _damping_figure(number: int, figure: _Damping, analyses: Analyses) -> Content:
    knots = analyses.knots(figure.deck)
    curves = []
    for variant, label in figure.curves.items():
        wing = analyses.wing(figure.deck, variant)
        legend = f"{label}: {_boundary_in_words(wing, figure.mode, figure.x_limits[1])}"
        boundary = wing.speed(figure.mode) if figure.mode in wing.onsets else np.nan
        curves.append(Curve(variant, knots, wing.damping(figure.mode), legend, boundary))
    return Content(
        number=number,
        title=f"{figure.what}: {_TITLES[figure.mode]} mode",
        quantity=_DAMPING,
        unit=_PERCENT,
        x_limits=figure.x_limits,
        y_limits=(_BELOW_ZERO, _top(figure, curves[0])),
        curves=tuple(curves),
        band=_band(figure, analyses) if figure.with_band else None,
        marks=(XV15_MARK,) if figure.deck == XV15 else (),
        is_damping=True,
        **_reservations(analyses, figure.deck),
    )


def _top(figure: _Damping, model: Curve) -> float:
    """Return the paper's upper end of the axis, or a higher end if the model's curve needs it."""
    shown = model.values[model.airspeed <= figure.x_limits[1]]
    return max(figure.highest, 2 * float(np.ceil(np.nanmax(shown) / 2)))


def _band(figure: _Damping, analyses: Analyses) -> BandCurves | None:
    band = analyses.band(figure.deck)
    if band is None:
        return None
    low, median, high = band.percentiles(figure.mode)
    label = f"{analyses.samples} samples of the doubtful inputs: 5 to 95 % at each airspeed, and the median (thin line)"
    return BandCurves(analyses.knots(figure.deck), low, median, high, label)


def _boundary_in_words(wing: WingModes, mode: str, end: float) -> str:
    """Return where a wing mode becomes unstable, up to the end of the axis in kt."""
    speed = wing.speed(mode)
    if mode in wing.crossings.unstable_at_start:
        return f"unstable at {speed:.0f} kt"
    if speed > end:
        return f"stable to {min(end, wing.airspeeds[-1] / KNOT):.0f} kt"
    return f"boundary {marked(f'{speed:.0f}', wing.onsets[mode].warning)} kt"


def _reservations(analyses: Analyses, deck: str) -> dict[str, Any]:
    case, wing = analyses.case(deck), analyses.wing(deck, "couplings")
    notes = [
        _UNDAMPED,
        wing.sweep.attrs["reservations"],
        *(f"{MARK} {line}" for line in footnotes(wing.crossings.doubts, "kt", KNOT)),
        stamp.line(wing.sweep.attrs),
    ]
    if deck != XV15:  # the XV-15's warning is on its mass integrals, which do not move the boundary
        notes.insert(0, case.warnings[0])
    statuses = {number.status for number in case.sources.values()}
    return {"notes": tuple(filter(None, notes)), "assumed": bool(statuses & {"assumed", "recalled"})}


def _curves(knots: Array, *rows: tuple[str, Array, str]) -> tuple[Curve, ...]:
    """Return the curves of names, values and labels over the same airspeeds in kt."""
    return tuple(Curve(name, knots, values, label) for name, values, label in rows)


def _lag_frequency(analyses: Analyses) -> Content:
    knots = analyses.knots(XV15)
    frequencies = analyses.rotor_on_rigid_hub
    lag = "low cyclic lag"
    given = frequencies(structure="tabulated", frequencies=PAPER_FREQUENCIES)[lag]
    uncoupled = analyses.blade_state(XV15).lag_frequency
    label = f"lag frequency given, a line from {LAG_FREQUENCIES[0]:g} to {LAG_FREQUENCIES[1]:g} per rev"
    label += f" between {LAG_AIRSPEEDS[0]:.0f} and {LAG_AIRSPEEDS[1]:.0f} kt (speeds assumed)"
    return Content(
        number=14,
        title="XV-15: low-frequency cyclic lag mode on a rigid hub",
        quantity="Frequency in the fixed frame",
        unit="per rev",
        x_limits=_XV15_RANGE,
        y_limits=(0, 1),
        curves=_curves(
            knots,
            ("coupled flap and lag", frequencies()[lag], "flap-lag springs that turn with the pitch"),
            ("given frequencies", given, label),
            ("coupled, in a vacuum", frequencies(airloads="none")[lag], "springs that turn, in a vacuum"),
            ("uncoupled lag less 1", uncoupled - 1, "uncoupled $ν_ζ − 1$ of these springs"),
        ),
        **_reservations(analyses, XV15),
    )


def _flap_frequencies(analyses: Analyses) -> Content:
    knots = analyses.knots(XV15)
    frequencies = analyses.rotor_on_rigid_hub
    air, vacuum = frequencies(), frequencies(airloads="none")
    given = frequencies(structure="tabulated", frequencies=PAPER_FREQUENCIES)
    cyclic = np.full(len(knots), CYCLIC_FLAP_FREQUENCY)
    in_a_vacuum = "cyclic (gimbal), in a vacuum; airloads damp it by 75 to 95 % of critical"
    return Content(
        number=18,
        title="XV-15: collective and cyclic flap on a rigid hub",
        quantity="Frequency in the rotating frame",
        unit="per rev",
        x_limits=_XV15_RANGE,
        y_limits=(0.5, 2.5),
        curves=_curves(
            knots,
            ("coning", air["coning"], "coning, gimbal and flap springs as they are"),
            ("coning, in a vacuum", vacuum["coning"], "coning, in a vacuum"),
            ("coning, given frequencies", given["coning"], f"coning, {CONING_FREQUENCY:g} per rev given"),
            ("cyclic (gimbal), in a vacuum", 1 + vacuum["low gimbal"], in_a_vacuum),
            ("cyclic, given", cyclic, f"cyclic, {CYCLIC_FLAP_FREQUENCY:g} per rev, the paper's input"),
        ),
        **_reservations(analyses, XV15),
    )


def _couplings(analyses: Analyses) -> Content:
    knots, state = analyses.knots(XV15), analyses.blade_state(XV15)
    without_lag = "$K_{Pζ}$ without the trim lag $\\bar{ζ}_0$"
    speed = analyses.wing(XV15, "couplings").first_speed
    label = f"$−0.3$ at this model's boundary, {speed:.0f} kt, to which $K_θ$ is calibrated"
    return Content(
        number=21,
        title="XV-15: pitch-flap and pitch-lag coupling",
        quantity="Coupling, nose down per angle",
        unit="1",
        x_limits=_XV15_RANGE,
        y_limits=(-0.8, 0.6),
        curves=_curves(
            knots,
            ("K_P_zeta", state.pitch_lag_coupling, "$K_{Pζ}$"),
            ("K_P_beta", state.pitch_flap_coupling, "$K_{Pβ}$"),
            ("K_P_zeta without trim lag", state.pitch_lag_coupling_without_lag, without_lag),
        ),
        points=((speed, PITCH_LAG_COUPLING, label),),
        marks=(XV15_MARK,),
        **_reservations(analyses, XV15),
    )


_OTHER_FIGURES: dict[int, Callable[[Analyses], Content]] = {
    14: _lag_frequency,
    18: _flap_frequencies,
    21: _couplings,
}
NUMBERS = tuple(sorted((*_DAMPING_FIGURES, *_OTHER_FIGURES)))
