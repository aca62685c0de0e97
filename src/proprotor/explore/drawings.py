"""The plots of the page: damping and frequency over airspeed, root locus, and the stability map."""

from __future__ import annotations

from typing import Any

import numpy as np
from bokeh.layouts import row
from bokeh.models import ColumnDataSource, HoverTool, Range1d
from bokeh.models.annotations import BoxAnnotation, Span
from bokeh.plotting import figure
from bokeh.plotting.contour import contour_data

from proprotor.explore.analysis import LiveModes
from proprotor.explore.curves import curves, ends
from proprotor.explore.growth_plane import GrowthPlane
from proprotor.explore.inputs import MapAxis
from proprotor.explore.post import Columns
from proprotor.plots.style import STABLE, UNSTABLE
from proprotor.typing import Array
from proprotor.units import KNOT

_AXES = ("airspeed", "damping", "growth", "frequency")
_DAMPING, _FREQUENCY, _GROWTH = (-5, 20), (0, 4.5), (-0.3, 0.15)
_HEIGHT = 280  # pixels
_BESIDE = "#8c8c8c"  # lines of the deck, with which the page compares
_FAILED = "#d9d9d9"
_LARGEST = 1e4  # 1/s: growth that is larger is drawn as this
_LEVELS = (-10 * _LARGEST, 0.0, 10 * _LARGEST)
# As many plots beside each other as there is room for.
_GRID = ":host{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(340px,100%),1fr));gap:4px}"

_Ends = tuple[float, float]


class Drawings:
    """The plots of one reader's page.

    Parameters
    ----------
    airspeeds : array (points,)
        m/s, of which the first and the last are the ends of the axes.
    """

    def __init__(self, airspeeds: Array) -> None:
        self.lines = _columns("lines", *_AXES, "mode", "colour", "dash", "width")
        self.dots = _columns("dots", "mode", "growth", "frequency", "colour")
        self.deck = ColumnDataSource(_nothing(), name="deck")
        self.boundary, self.here = _columns("boundary", "x", "y"), _columns("here", "x", "y")
        self.deck_boundary = ColumnDataSource({"x": [], "y": []}, name="deck-boundary")
        self.across = Range1d(start=airspeeds[0] / KNOT, end=airspeeds[-1] / KNOT)
        self.map = _figure("Stability map", ("", (0, 1)), ("", (0, 1)))
        self.plots = (self._damping(), self._root_locus(), self._frequency(), self._map())

    def layout(self) -> Any:
        """Return the plots side by side, as many as there is room for."""
        return row(*self.plots, sizing_mode="stretch_width", stylesheets=[_GRID], name="plots")

    def show(self, found: LiveModes, rotor_speed: float) -> dict[str, list[Any]]:
        """Draw modes, and return the columns of their lines."""
        columns = curves(found, rotor_speed, KNOT)
        self.across.update(start=found.airspeed[0] / KNOT, end=found.airspeed[-1] / KNOT)
        self.lines.data, self.dots.data = columns, ends(columns)
        return columns

    def compare(self, found: LiveModes | None, rotor_speed: float) -> None:
        """Draw the modes of the deck in grey behind the others; None removes them."""
        self.deck.data = _nothing() if found is None else curves(found, rotor_speed, KNOT)

    def show_map(self, plane: GrowthPlane, axes: tuple[MapAxis, MapAxis], cut: str) -> None:
        """Draw a stability map.

        Parameters
        ----------
        plane : GrowthPlane
        axes : (MapAxis, MapAxis)
            x and y of the plane.
        cut : str
            Where the plane is cut, for the title: " at 300 KTAS", or nothing.
        """
        x, y = axes
        across, up = plane.x / x.factor, plane.y / y.factor
        growth = np.ma.masked_invalid(np.clip(plane.growth, -_LARGEST, _LARGEST))
        filled: Any = contour_data(across, up, growth, _LEVELS, want_line=False).fill_data
        self.filled.data = {"xs": filled.xs, "ys": filled.ys}
        self.boundary.data = _line_columns(plane, axes)
        self.map.x_range.update(start=across[0], end=across[-1])
        self.map.y_range.update(start=up[0], end=up[-1])
        self.map.xaxis.axis_label, self.map.yaxis.axis_label = x.label, y.label
        self.map.title.text = f"Stability map{cut}, hatched where unstable"

    def compare_map(self, plane: GrowthPlane | None, axes: tuple[MapAxis, MapAxis]) -> None:
        """Draw the boundary of the deck in grey; None removes it."""
        self.deck_boundary.data = {"x": [], "y": []} if plane is None else _line_columns(plane, axes)

    def show_place(self, x: float | None, y: float | None) -> None:
        """Mark the settings on the map, in the units of its axes; None where an axis is no setting."""
        self.here.data = {"x": np.array([x], float), "y": np.array([y], float)}

    # Plots --------------------------------------------------------------------------------------------------------

    def _damping(self) -> Any:
        plot = _figure(
            "Damping", ("Airspeed, KTAS", self.across), ("Damping −Re s/|s| (% of critical)", _DAMPING)
        )
        self._draw(plot, "airspeed", "damping", [("airspeed", "$x{0.0} KTAS"), ("damping", "$y{0.00} %")])
        plot.add_layout(Span(location=0, dimension="width", line_color="black"))
        plot.add_layout(BoxAnnotation(top=0, fill_color=UNSTABLE, fill_alpha=1, level="image"))
        return plot

    def _frequency(self) -> Any:
        plot = _figure(
            "Frequency", ("Airspeed, KTAS", self.across), ("Frequency |Im s| (per rev)", _FREQUENCY)
        )
        told = [("airspeed", "$x{0.0} KTAS"), ("frequency", "$y{0.000}")]
        self._draw(plot, "airspeed", "frequency", told)
        return plot

    def _root_locus(self) -> Any:
        plot = _figure(
            "Root locus", ("Growth Re s (per rev)", _GROWTH), ("Frequency |Im s| (per rev)", _FREQUENCY)
        )
        self._draw(plot, "growth", "frequency", [("growth", "$x{0.000}"), ("frequency", "$y{0.000}")])
        plot.scatter("growth", "frequency", source=self.dots.model, color="colour", size=7)
        plot.add_layout(Span(location=0, dimension="height", line_color="black"))
        plot.add_layout(BoxAnnotation(left=0, fill_color=UNSTABLE, fill_alpha=1, level="image"))
        return plot

    def _draw(self, plot: Any, across: str, up: str, values: list[tuple[str, str]]) -> None:
        """Draw the lines of all modes over those of the deck, with the values that show beside the pointer."""
        plot.multi_line(across, up, source=self.deck, line_color=_BESIDE, line_width=1, line_dash="dash")
        style = {"line_color": "colour", "line_dash": "dash", "line_width": "width"}
        drawn = plot.multi_line(across, up, source=self.lines.model, **style)
        tooltips = [("mode", "@mode"), *values]
        plot.add_tools(HoverTool(renderers=[drawn], tooltips=tooltips, line_policy="nearest"))

    def _map(self) -> Any:
        """Return the map: what could not be analysed is grey, what is unstable is hatched."""
        self.map.background_fill_color = _FAILED
        nothing = np.full((2, 2), -1.0)
        filled = self.map.contour(
            np.arange(2.0),
            np.arange(2.0),
            nothing,
            _LEVELS,
            fill_color=[STABLE, UNSTABLE],
            hatch_pattern=[" ", "/"],
            hatch_color="#b34700",
            hatch_alpha=0.35,
        )
        self.filled = Columns(filled.fill_renderer.data_source)
        self.map.multi_line("x", "y", source=self.deck_boundary, line_color=_BESIDE, line_width=1.5)
        self.map.multi_line("x", "y", source=self.boundary.model, line_color="black", line_width=2)
        self.map.scatter(
            "x", "y", source=self.here.model, marker="cross", size=16, line_width=2, line_color="#0072B2"
        )
        return self.map


def _figure(title: str, across: tuple[str, _Ends | Range1d], up: tuple[str, _Ends]) -> Any:
    """Return an empty plot whose axes, across and up, each have a label and two ends."""
    plot = figure(
        height=_HEIGHT,
        min_width=280,
        sizing_mode="stretch_width",
        x_range=across[1]
        if isinstance(across[1], Range1d)
        else Range1d(start=across[1][0], end=across[1][1]),
        y_range=Range1d(start=up[1][0], end=up[1][1]),
        x_axis_label=across[0],
        y_axis_label=up[0],
        tools="pan,wheel_zoom,box_zoom,reset,save",
        title=title,
        name=title.lower().replace(" ", "-"),
    )
    plot.toolbar.logo = None
    return plot


def _nothing() -> dict[str, list[Any]]:
    """Return the columns of no line."""
    return {axis: [] for axis in _AXES}


def _columns(name: str, *columns: str) -> Columns:
    """Return columns without rows, to be sent with a post."""
    return Columns(ColumnDataSource({column: [] for column in columns}, name=name))


def _line_columns(plane: GrowthPlane, axes: tuple[MapAxis, MapAxis]) -> dict[str, list[Any]]:
    """Return the boundary of a map as columns of lines, in the units of the axes."""
    lines = plane.boundary
    return {name: [line[:, place] / axes[place].factor for line in lines] for place, name in enumerate("xy")}
