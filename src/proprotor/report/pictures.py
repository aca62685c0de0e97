"""The plots of a report, as SVG or PNG."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from proprotor.case import Case
from proprotor.plots import (
    plot_attribution,
    plot_damping,
    plot_envelope,
    plot_frequency,
    plot_participation,
    plot_root_locus,
    plot_sensitivity,
)
from proprotor.plots.headless import drawn
from proprotor.report.document import Picture
from proprotor.tables.points import DAMPING, FREQUENCY, Points
from proprotor.typing import Axes, Dataset

if TYPE_CHECKING:
    from proprotor.report.analyses import Causes, Findings

_DPI = 200  # of a PNG
_UNDATED: Any = {"svg": {"Date": None}, "png": {"Software": None}}  # without date and version of matplotlib
_SHARE = 0.75  # share of the width of a sheet, for plots of bars
_TWO = 0.9  # and for two plots that stand on one sheet
# Without a salt the names within an SVG are random; with math text a dollar in the name of a mode begins a formula.
_FIXED: Any = {"svg.hashsalt": "proprotor", "text.parse_math": False}


def _drawing(plot: Callable[[], Axes]) -> Callable[[str], bytes]:
    """Return a function that draws a plot as a file of a form; the same plot gives the same bytes."""

    def draw(form: str) -> bytes:
        import matplotlib  # here, because matplotlib takes long to import

        file = io.BytesIO()
        with matplotlib.rc_context(_FIXED), drawn(plot) as (_, figure):
            figure.savefig(file, format=form, dpi=_DPI, bbox_inches="tight", metadata=_UNDATED[form])
        return file.getvalue()

    return draw


def of_sweep(
    case: Case, found: Findings, unit: str, factor: float, points: Points | None = None
) -> Iterator[Picture]:
    """Yield the plots of frequency and damping, with points of a file that has their columns, and the root locus."""
    of_frequency, of_damping = (
        points if points and name in points.columns else None for name in (FREQUENCY, DAMPING)
    )
    omega = float(case.operation.rotor_speed)
    low, high = (f"{speed / factor:.4g}" for speed in found.flutter.searched)
    across = f"from {low} to {high} {unit}; the tables of modes have the numbers."
    names = ", ".join(map(str, found.sweep.mode.values))
    broad = "Broad lines with markers: modes of the support, and modes that become unstable."
    yield Picture(
        "frequency",
        f"Frequency of each mode over airspeed. {broad}",
        f"Line plot of the frequency, per revolution, of the modes {names}, {across}",
        _drawing(lambda: plot_frequency(found.sweep, rotor_speed=omega, unit=unit, points=of_frequency)),
        _TWO,
    )
    yield Picture(
        "damping",
        "Damping of each mode over airspeed; below zero a mode is unstable. "
        "Circles are interpolated between the airspeeds drawn, the boundaries of the summary are exact.",
        f"Line plot of the damping, in percent of critical, of the modes {names}, {across}",
        _drawing(lambda: plot_damping(found.sweep, unit=unit, points=of_damping)),
        _TWO,
    )
    yield Picture(
        "root-locus",
        "Root locus: growth across, frequency up; right of zero a mode is unstable.",
        f"Roots of the modes {names} in the plane of growth and frequency, {across}",
        _drawing(lambda: plot_root_locus(found.sweep, rotor_speed=omega, unit=unit)),
        0.85,
    )


def of_envelope(found: Dataset) -> Iterator[Picture]:
    """Yield the picture of an envelope."""
    conditions = ", ".join(map(str, found.condition.values))
    yield Picture(
        "envelope",
        "Onset of each condition over equivalent airspeed and altitude. The grey area, up to the speed needed of "
        "normal conditions, must stay free of onsets of these.",
        f"Lines of the onset of {conditions}, beside V_D, M_D and the speeds needed; the table has the numbers.",
        _drawing(lambda: plot_envelope(found)),
    )


def of_causes(causes: Causes, mode: str, where: str, unit: str) -> Iterator[Picture]:
    """Yield the plots of participation, attribution and sensitivity of one mode at one airspeed."""
    if mode in causes.modes.mode.values:
        yield Picture(
            "participation",
            f"Coordinates that take part in {mode} {where}.",
            f"Bars of the share of each coordinate in {mode} {where}.",
            _drawing(lambda: plot_participation(causes.modes, mode, unit=unit)),
            _SHARE,
        )
    yield Picture(
        "attribution",
        f"What drives and what damps {mode} {where}, by the physical origin of the terms.",
        f"Bars of the change of damping of {mode} {where} per origin of the terms; hatched bars drive the mode.",
        _drawing(lambda: plot_attribution(causes.attribution)),
        _SHARE,
    )
    yield Picture(
        "sensitivity",
        "Change if an input grows by 1 % of itself; hatches mark inputs that were not read in a source.",
        "Tornado of the inputs with the largest changes; the table of sensitivities has the numbers.",
        _drawing(lambda: plot_sensitivity(causes.sensitivity, unit=unit)),
        _SHARE,
    )
