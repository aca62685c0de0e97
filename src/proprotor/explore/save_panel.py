"""The buttons of the page that save files: the browser downloads what the server makes."""

from __future__ import annotations

import base64
from collections.abc import Callable, Mapping
from functools import partial

from bokeh.layouts import column
from bokeh.models import ColumnDataSource, CustomJS
from bokeh.models.widgets import Button

from proprotor.errors import InputError
from proprotor.explore import saves
from proprotor.explore.altered_deck import altered_deck, explored_name
from proprotor.explore.chosen import Chosen
from proprotor.explore.controls import SIDE
from proprotor.explore.inputs import SliderInput
from proprotor.explore.live_map import LiveMap
from proprotor.explore.post import script
from proprotor.explore.words import changed


class SavePanel:
    """The buttons that save files.

    Parameters
    ----------
    chosen : Chosen
    inputs : mapping of str to SliderInput
        Inputs that have a slider, by path.
    map_shown : LiveMap
    deck : (str, mapping)
        Name or path of the deck, as a saved deck shall refer to it, and the fields that were set on the command line.
    refused : callable
        Called with the reason why nothing could be saved.
    """

    def __init__(
        self,
        chosen: Chosen,
        inputs: Mapping[str, SliderInput],
        map_shown: LiveMap,
        deck: tuple[str, Mapping[str, str]],
        refused: Callable[[str], None],
    ) -> None:
        self.chosen, self.inputs, self.map = chosen, inputs, map_shown
        self.base, self.fields = deck
        self._refused = refused
        self.file = ColumnDataSource(name="file")  # what the browser saves next
        self.file.js_on_change("data", CustomJS(code=script("download.js")))
        self.buttons = column(*self._buttons(), name="save")

    def _buttons(self) -> list[Button]:
        name = explored_name(self.chosen.case)
        buttons = [
            self._button("Deck (TOML)", f"{name}.toml", "application/toml", self._deck),
            self._button("Curves (CSV)", f"{name}.csv", "text/csv", self._curves),
        ]
        pictures = {"Frequency and damping": "sweep", "Root locus": "root-locus", "Map": "map"}
        for title, short in pictures.items():
            for form, media in saves.PICTURES.items():
                make = partial(self._picture, short, form)
                buttons.append(
                    self._button(f"{title} ({form.upper()})", f"{name}-{short}.{form}", media, make)
                )
        return buttons

    def _button(self, title: str, file: str, kind: str, make: Callable[[], bytes]) -> Button:
        button = Button(label=title, name=f"save {title}", width=SIDE - 20)
        button.on_click(partial(self._save, file, kind, make))
        return button

    def _save(self, name: str, kind: str, make: Callable[[], bytes]) -> None:
        """Send a file to the browser, or tell why there is none."""
        try:
            content = make()
        except InputError as error:
            self._refused(f"{error}. Nothing was saved")
            return
        self.file.data = {"name": [name], "kind": [kind], "content": [base64.b64encode(content).decode()]}

    def _deck(self) -> bytes:
        own = self.chosen
        return altered_deck(self.base, own.case, own.values, self.fields, own.options).encode()

    def _curves(self) -> bytes:
        return saves.curves_csv(self.chosen.varied, self.chosen.airspeeds, self.chosen.options)

    def _picture(self, which: str, form: str) -> bytes:
        own, changes = self.chosen, changed(self.chosen.values, self.inputs)
        told = f"Changed from the deck: {changes}." if changes else ""
        if which == "map":
            return saves.map_picture(own.varied, self.map.axes, self.map.airspeed, own.options, told, form)
        draw = saves.curves_picture if which == "sweep" else saves.root_locus_picture
        return draw(own.varied, own.airspeeds, own.options, told, form)
