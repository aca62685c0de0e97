"""The page: controls on the left, the flutter speed above, the plots below."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import partial
from html import escape
from typing import TYPE_CHECKING, Any

from bokeh.events import DocumentReady
from bokeh.layouts import column, row
from bokeh.models import CustomJS, TabPanel, Tabs
from bokeh.models.widgets import Button, Checkbox, Div

from proprotor.case import Case
from proprotor.deck.vary import design_inputs
from proprotor.errors import InputError
from proprotor.explore import words
from proprotor.explore.analysis import live_modes
from proprotor.explore.chosen import Chosen
from proprotor.explore.controls import SIDE, choice_of, option_switch, word
from proprotor.explore.drawings import Drawings
from proprotor.explore.input_panel import InputPanel
from proprotor.explore.inputs import SliderInput, first_inputs
from proprotor.explore.live_map import LiveMap
from proprotor.explore.post import Post, Text, script
from proprotor.explore.save_panel import SavePanel
from proprotor.explore.turns import Turns
from proprotor.model.provenance import reservations
from proprotor.model.stamp import of_case, unusual_options
from proprotor.rotor.options import CHOICES
from proprotor.stability.parameter_lines import AIRSPEED
from proprotor.typing import Array

if TYPE_CHECKING:
    from bokeh.document import Document

_SWITCHES = tuple(name for name in CHOICES if name != "reactionless")
_WRAPS = ":host{flex-wrap:wrap}"
_FILLS = ":host{flex:1 1 320px;min-width:0}"


class ExplorePage:
    """One reader's page.

    Parameters
    ----------
    case : Case
    base : str
        Name or path of the deck, as a saved deck shall refer to it.
    airspeeds : array (points,)
        m/s.
    fields : mapping
        Fields that were set on the command line.
    options : mapping
        All options of the model.
    """

    def __init__(
        self,
        case: Case,
        base: str,
        airspeeds: Array,
        fields: Mapping[str, str],
        options: Mapping[str, Any],
    ) -> None:
        self.case, self.chosen = case, Chosen(case, airspeeds, options)
        self.document: Document | None = None
        self._turns: Turns | None = None
        self._waiting = self._held = False
        self._compared: object = None  # what the curves of the deck show
        self._told_of: object = None  # the options that the text at the foot tells
        self.readout, self.message, self.legend, self.foot = (
            Text(name, sizing_mode="stretch_width")
            for name in ("readout", "message", "legend", "reservations")
        )
        self.modes, self.guide = Text("modes", width=SIDE), Text("help", width=SIDE)
        self.drawings = Drawings(airspeeds)
        plots = (self.drawings.lines, self.drawings.dots, self.drawings.here)
        texts = (self.readout, self.message, self.legend, self.foot, self.modes, self.guide)
        self.post = Post("curves-post", *plots, *texts)
        self.inputs = InputPanel(self.chosen, self._soon, self._refuse, self._explain)
        self.switches = {name: option_switch(case, name, options[name]) for name in _SWITCHES}
        self.compare = Checkbox(label="Compare with the deck", active=True, name="compare")
        up = [*first_inputs(case), *design_inputs(case), AIRSPEED][0]
        self.map = LiveMap(self.chosen, self.drawings, up)
        self.saves = SavePanel(self.chosen, self.inputs.inputs, self.map, (base, fields), self._refuse)

    def put_on(self, document: Document, turns: Turns | None = None) -> None:
        """Build the page in a Bokeh document, and draw the modes of the deck.

        `turns` are those of the readers of a server, without which the map is drawn when `map.draw` is called alone.
        """
        self.document, self._turns = document, turns
        document.on_session_destroyed(lambda _: self._leave())
        document.title = f"{self.case.title or self.case.name}: explore"
        for name in ("quick.js", "names.js"):
            document.js_on_event(DocumentReady, CustomJS(code=script(name)))
        for name, switch in self.switches.items():
            switch.on_change("value", partial(self._switch_to, name))
        self.compare.on_change("active", lambda _, __, ___: self._soon())
        document.add_root(self._layout())
        document.add_root(self.saves.file)
        self.post.put_on(document)
        self.map.put_on(document, turns)
        self.update()

    def update(self) -> None:
        """Analyse and draw the case with all settings; if that is impossible, say why and keep the last drawing."""
        self._wait(False)
        own = self.chosen
        try:
            found = live_modes(own.case, own.airspeeds, own.values, **own.options)
        except InputError as error:
            self._refuse(f"{error}. The curves are those of the settings before")
            return
        self._show_deck()
        columns = self.drawings.show(found, own.rotor_speed)
        self.readout.text = words.readout(found, own.values, self.inputs.inputs)
        self.message.text = words.messages(found)
        self.legend.text = words.legend(columns, self.compare.active)
        self.modes.text = words.table(found, own.rotor_speed)
        self._show_origin()
        self.map.show_place(found)
        self.post.send()
        self.map.soon()

    def _show_origin(self) -> None:
        """Say what the numbers rest on, unless it is said already: a stamp takes the time of many points."""
        if self._told_of == (options := dict(self.chosen.options)):
            return
        self._told_of = options
        origin = (*unusual_options(of_case(self.case, options)), *reservations(self.case))
        self.foot.text = f"<small>{escape(' '.join(origin))}</small>"

    def _show_deck(self) -> None:
        """Draw the curves of the deck, unless they are drawn already."""
        own, shown = self.chosen, bool(self.compare.active)
        self.map.compared = shown
        if self._compared == (wanted := (shown, own.airspeeds.tobytes())):
            return
        self._compared = wanted
        deck = live_modes(own.case, own.airspeeds, **own.first_options) if shown else None
        self.drawings.compare(deck, float(own.case.operation.rotor_speed))

    def _refuse(self, reason: str) -> None:
        self.message.text = words.alert(f"{reason}.")
        self.post.send()

    def _explain(self, shown: Iterable[SliderInput]) -> None:
        """Put the meaning of each input that has a slider into the help."""
        meanings = (
            f"<dt><b>{escape(given.label)}</b></dt><dd>{escape(given.meaning)}</dd>" for given in shown
        )
        self.guide.text = f"{words.HELP}<dl>{''.join(meanings)}</dl>"
        self.post.send()

    def _switch_to(self, name: str, _: str, __: str, chosen: str) -> None:
        self.chosen.options[name] = choice_of(chosen)
        self._soon()

    def _reset(self) -> None:
        self._held = True
        self.inputs.reset()
        for name, switch in self.switches.items():
            switch.value = word(self.chosen.first_options[name])
        self.chosen.reset()
        self._held = False
        self.update()

    def _soon(self) -> None:
        """Update the page once for all moves that wait for an update."""
        if self._waiting or self._held or self.document is None:
            return
        self._wait(True)
        self.document.add_next_tick_callback(self.update)

    def _wait(self, waiting: bool) -> None:
        """Let the maps of all readers wait for the curves of this page, or not."""
        self._waiting = waiting
        if self._turns is not None:
            (self._turns.curves_wait if waiting else self._turns.curves_done)(self)

    def _leave(self) -> None:
        """Do nothing more for a reader who has closed the page."""
        self._wait(False)
        self.document = self._turns = None
        self.map.leave()

    def _layout(self) -> Any:
        reset = Button(label="Reset", name="reset", width=90)
        reset.on_click(self._reset)
        tabs = {
            "Inputs": self.inputs.side,
            "More": column(self.inputs.exact, self.inputs.choice),
            "Model": column(*self.switches.values()),
            "Map": self.map.controls(),
            "Modes": self.modes.model,
            "Save": self.saves.buttons,
            "Help": self.guide.model,
        }
        panels = Tabs(tabs=[TabPanel(title=name, child=child) for name, child in tabs.items()], name="tabs")
        side = column(row(reset, self.compare), panels, width=SIDE + 20)
        heading = escape(self.case.title or self.case.name)
        title = Div(text=f"<h1 style='font-size:16px;margin:0'>{heading}</h1>", sizing_mode="stretch_width")
        above, below = (self.readout, self.message), (self.legend, self.map.message, self.foot)
        plots = self.drawings.layout()
        shown = (title, *(text.model for text in above), plots, *(text.model for text in below))
        main = column(*shown, sizing_mode="stretch_width", stylesheets=[_FILLS])
        return row(side, main, spacing=8, sizing_mode="stretch_width", stylesheets=[_WRAPS])
