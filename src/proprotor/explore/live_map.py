"""The stability map of the page: computed in parts, so that a slider is answered in between."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from functools import partial
from typing import TYPE_CHECKING, Any

from bokeh.layouts import column
from bokeh.models.widgets import Slider

from proprotor.errors import InputError
from proprotor.explore import words
from proprotor.explore.analysis import LiveModes
from proprotor.explore.chosen import Chosen
from proprotor.explore.controls import GRIDS, airspeed_of_map, map_selections
from proprotor.explore.drawings import Drawings
from proprotor.explore.growth_plane import GrowthPlane, growth_plane
from proprotor.explore.inputs import MapAxis, map_axis, slider_input
from proprotor.explore.post import Post, Text
from proprotor.explore.turns import Turns
from proprotor.stability.parameter_lines import AIRSPEED
from proprotor.units import KNOT, KTAS

if TYPE_CHECKING:
    from bokeh.document import Document

_RESTS = 250  # ms after the last move: where NumPy computes the map, the map waits for the slider to rest
_Axes = tuple[MapAxis, MapAxis]
_Draws = Iterator[Callable[[], None] | None]  # between parts of a map, what is to be drawn, if anything


class LiveMap:
    """The map of one reader's page, with its controls.

    Parameters
    ----------
    chosen : Chosen
        What the map shall show.
    drawings : Drawings
    up : str
        Input on the axis up, at first.
    """

    def __init__(self, chosen: Chosen, drawings: Drawings, up: str) -> None:
        self.chosen, self.drawings = chosen, drawings
        self.document: Document | None = None
        self._turns: Turns | None = None
        self.x, self.y, self.grid = map_selections(chosen.case, up)
        self.at: Slider = airspeed_of_map(chosen.case, chosen.airspeeds)
        self.at.visible = self.airspeed is not None
        self.compared = True
        self.message = Text("map-message", sizing_mode="stretch_width")
        self.post = Post("map-post", drawings.filled, drawings.boundary, self.message)
        self._computing = False
        self._resting: Any = None  # Bokeh's callback that begins a map
        self._drawn: object = None  # the settings that the map shows
        self._drawn_deck: object = None  # the grid that the boundary of the deck was computed on
        for control in (self.x, self.y, self.grid, self.at):
            control.on_change("value", lambda _, __, ___: self._choose())

    def controls(self) -> Any:
        """Return the controls, one above the other."""
        return column(self.x, self.y, self.at, self.grid)

    def put_on(self, document: Document, turns: Turns | None) -> None:
        """Show the map in a Bokeh document, computed in turn with what other readers wait for, if there are turns."""
        self.document, self._turns = document, turns
        self.post.put_on(document)

    def leave(self) -> None:
        """Compute and draw no longer."""
        self.document = self._turns = None

    @property
    def axes(self) -> _Axes:
        """Both axes with the values of the grid."""
        x, y = (
            map_axis(self.chosen.case, name, self.chosen.airspeeds, self.chosen.values.get(name), points)
            for name, points in zip(self._names, GRIDS[self.grid.value], strict=True)
        )
        return x, y

    @property
    def airspeed(self) -> float | None:
        """The airspeed at which the plane of two inputs is cut, m/s; None if airspeed is one of the axes."""
        return None if AIRSPEED in self._names else float(self.at.value) * KNOT

    @property
    def _names(self) -> tuple[str, str]:
        return self.x.value, self.y.value

    def draw(self) -> None:
        """Compute and draw the map of the settings at once."""
        for drawn in self._drawing():
            if drawn is not None:
                drawn()

    def soon(self) -> None:
        """Begin the map at once if compiled functions compute it, else when the slider rests."""
        if self.document is None:
            return
        if self._resting is not None:
            self.document.remove_timeout_callback(self._resting)
        wait = 0 if self.chosen.options["backend"] == "compiled" else _RESTS
        self._resting = self.document.add_timeout_callback(self._rested, wait)

    def _rested(self) -> None:
        self._resting = None
        self._begin()

    def _choose(self) -> None:
        self.at.visible = self.airspeed is not None
        self._begin()

    def _begin(self) -> None:
        """Begin the map, unless one is being computed: that one is drawn first, and the next one follows."""
        if not self._computing and self._turns is not None:
            self._computing = True
            self._turns.add_map(self._parts())

    def _parts(self) -> Iterator[None]:
        """Compute the map, and draw when the document lets the map."""
        for drawn in self._drawing():
            if self.document is None:
                return
            if drawn is not None:
                self.document.add_next_tick_callback(drawn)
            yield
        self._computing = False
        if self._drawn != self._settings(self.axes):
            self._begin()

    def _settings(self, axes: _Axes) -> object:
        """Return all that the map depends on."""
        others = {path: value for path, value in self.chosen.values.items() if path not in self._names}
        return self._plane_of(axes), others, dict(self.chosen.options), self.compared

    def _plane_of(self, axes: _Axes) -> object:
        """Return the grid of the map, and the airspeed at which the plane is cut."""
        return self._names, self.airspeed, [axis.values.tolist() for axis in axes]

    def _drawing(self) -> _Draws:
        """Compute the map, then the boundary of the deck; yield between parts, and what is to be drawn."""
        axes, at = self.axes, self.airspeed
        self._drawn = self._settings(axes)
        try:
            plane = yield from self._computed(axes, at, self.chosen.values, self.chosen.options)
            yield partial(self._show, plane, axes, at)
            yield from self._comparing(plane, axes, at)
        except InputError as error:
            yield partial(self._tell, words.alert(f"{error}. The map is that of the settings before."))

    def _show(self, plane: GrowthPlane, axes: _Axes, at: float | None) -> None:
        cut = "" if at is None else f" at {at / KNOT:.4g} {KTAS}"
        self.drawings.show_map(plane, axes, cut)
        self._tell(words.map_messages(plane))

    def _tell(self, message: str) -> None:
        self.message.text = message
        self.post.send()

    def _comparing(self, plane: GrowthPlane, axes: _Axes, at: float | None) -> _Draws:
        """Compute the boundary of the deck, unless it is drawn already."""
        wanted = self._plane_of(axes) if self.compared else None
        if self._drawn_deck == wanted:
            return
        self._drawn_deck = wanted
        deck = None
        if self.compared:
            of_deck = self.chosen.are_of_deck
            deck = plane if of_deck else (yield from self._computed(axes, at, {}, self.chosen.first_options))
        yield partial(self.drawings.compare_map, deck, axes)

    def _computed(
        self, axes: _Axes, at: float | None, values: Any, options: Any
    ) -> Generator[None, None, GrowthPlane]:
        """Return the stability over both axes; yield between parts."""
        given = {axis.path: axis.values for axis in axes}
        return (yield from growth_plane(self.chosen.case, given, at, dict(values), dict(options)))

    def show_place(self, found: LiveModes) -> None:
        """Mark the settings on the map, on an axis of airspeed the flutter speed."""
        places = []
        for name in self._names:
            if name == AIRSPEED:
                places.append(None if found.flutter is None else found.flutter.start / KNOT)
            else:
                given = slider_input(self.chosen.case, name)
                places.append(self.chosen.values.get(name, given.value * given.factor) / given.factor)
        self.drawings.show_place(*places)
