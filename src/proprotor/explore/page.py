"""The page: sliders on the left, the flutter speed above, damping and root locus below."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np
from bokeh.layouts import column, row
from bokeh.models import ColumnDataSource, CustomJS, HoverTool, Range1d, TabPanel, Tabs
from bokeh.models.annotations import BoxAnnotation, Legend, LegendItem, Span
from bokeh.models.widgets import Button, Div, MultiChoice, Select, Slider, TextInput
from bokeh.plotting import figure

from proprotor.case import Case
from proprotor.deck.vary import design_inputs
from proprotor.errors import InputError
from proprotor.explore.altered_deck import altered_deck, explored_name
from proprotor.explore.analysis import LiveModes, live_modes
from proprotor.explore.curves import curves, ends
from proprotor.explore.inputs import SliderInput, first_inputs, slider_input
from proprotor.model.doubts import MARK, doubtful_near, doubts_along, footnotes, marked
from proprotor.model.provenance import reservations
from proprotor.model.stamp import of_case, unusual_options
from proprotor.plots.style import UNSTABLE
from proprotor.rotor.options import CHOICES
from proprotor.typing import Array
from proprotor.units import KNOT, KTAS, to_si

if TYPE_CHECKING:
    from bokeh.document import Document

_SWITCHES = tuple(name for name in CHOICES if name != "reactionless")
_TOGETHER = 15  # ms: several moves within this time cause one analysis
_DAMPING, _FREQUENCY, _GROWTH = (-5, 20), (0, 4.5), (-0.3, 0.15)
_SIDE, _HEIGHT = 330, 560  # pixels

_DOWNLOAD = """
const place = document.createElement("a");
place.href = URL.createObjectURL(new Blob(cb_obj.data.text, {type: "application/toml"}));
place.download = name;
place.click();
URL.revokeObjectURL(place.href);
"""
_HELP = """<p>Move a slider, or focus it (Tab) and press the arrow keys. <b>Reset</b> brings the
deck's own values back, and <b>Save as a deck</b> downloads your settings as a TOML file that alters the deck.</p>
<p>Damping below zero is unstable. On the right, each root moves towards its dot, which is at the highest airspeed.
Broad lines are modes of the support and modes that become unstable. The flutter speed is interpolated between the
airspeeds analysed; <code>proprotor flutter</code> finds it to rounding.</p>"""


class ExplorePage:
    """One reader's page.

    Parameters
    ----------
    case : Case
    base : str
        Name or path of the deck, as a saved deck shall refer to it.
    airspeeds : array (points,)
        m/s.
    settings : mapping
        Fields that were set on the command line.
    options : mapping
        All options of the model.
    """

    def __init__(
        self,
        case: Case,
        base: str,
        airspeeds: Array,
        settings: Mapping[str, str],
        options: Mapping[str, Any],
    ) -> None:
        self.case, self.base, self.airspeeds, self.settings = case, base, airspeeds, settings
        self.options, self.first_options = dict(options), dict(options)
        self.values: dict[str, float] = {}  # inputs that differ from the deck, in SI units
        self.sliders: dict[str, Slider] = {}
        self.inputs: dict[str, SliderInput] = {}
        self.document: Document | None = None
        self._waiting = self._held = False
        self.lines, self.dots = ColumnDataSource(name="lines"), ColumnDataSource(name="dots")
        self.readout = Div(name="readout", width=850)
        self.message = Div(name="message", width=850)
        self.foot = Div(name="reservations", width=850)
        self.side = column(name="sliders", width=_SIDE)
        self.guide = Div(name="help", width=_SIDE)
        self.deck = ColumnDataSource(name="deck")  # the browser gets the text when the reader saves the deck
        self.choice = MultiChoice(
            title="Inputs with a slider (type to find others)",
            options=list(design_inputs(case)),
            value=first_inputs(case),
            width=_SIDE,
            name="choice",
        )
        self.exact = TextInput(
            title="Set exactly, then Enter: rotor.precone = 1.5 deg", name="exact", width=_SIDE
        )
        self.switches = {name: _switch(case, name, options[name]) for name in _SWITCHES}

    def put_on(self, document: Document) -> None:
        """Build the page in a Bokeh document, and draw the modes of the deck."""
        self.document = document
        document.title = f"{self.case.title or self.case.name}: explore"
        self._show_sliders(self.choice.value)
        self.choice.on_change("value", lambda _, __, chosen: self._show_sliders(chosen))
        self.exact.on_change("value", lambda _, __, text: self._set_exactly(text))
        for name, switch in self.switches.items():
            switch.on_change("value", partial(self._switch_to, name))
        document.add_root(self._layout())
        document.add_root(self.deck)
        self.update()

    def update(self) -> None:
        """Analyse and draw the case with all settings; if that is impossible, say why and keep the last drawing."""
        self._waiting = False
        try:
            found = live_modes(self.case, self.airspeeds, self.values, **self.options)
        except InputError as error:
            self.message.text = _alert(f"{error}. The curves are those of the settings before.")
            return
        rotor_speed = self.values.get("operation.rotor_speed", float(self.case.operation.rotor_speed))
        self.lines.data = columns = curves(found, rotor_speed, KNOT)
        self.dots.data = ends(columns)
        self.readout.text = readout(found, self.values, self.inputs)
        self.message.text = messages(found)
        origin = (*unusual_options(of_case(self.case, self.options)), *reservations(self.case))
        self.foot.text = f"<small>{escape(' '.join(origin))}</small>"

    # Settings ---------------------------------------------------------------------------------------------------

    def _show_sliders(self, paths: list[str]) -> None:
        for path in paths:
            if path not in self.sliders:
                self._add_slider(slider_input(self.case, path))
        self.side.children = [self.sliders[path] for path in paths]
        meanings = (
            f"<dt><b>{escape(self.inputs[path].label)}</b></dt><dd>{escape(self.inputs[path].meaning)}</dd>"
            for path in paths
        )
        self.guide.text = f"{_HELP}<dl>{''.join(meanings)}</dl>"

    def _add_slider(self, given: SliderInput) -> None:
        self.inputs[given.path] = given
        slider = Slider(
            title=given.label,
            value=given.value,
            start=given.low,
            end=given.high,
            step=given.step,
            format="0,0.[00000]",
            width=_SIDE - 20,
            height=36,
            name=given.path,
            bar_color="#0072B2",
        )
        slider.on_change("value", lambda _, __, value: self._moved(given.path, value))
        self.sliders[given.path] = slider

    def _moved(self, path: str, value: float) -> None:
        given = self.inputs[path]
        if value == given.value:
            self.values.pop(path, None)
        else:
            self.values[path] = value * given.factor
        self._soon()

    def _switch_to(self, name: str, _: str, __: str, chosen: str) -> None:
        self.options[name] = {"yes": True, "no": False}.get(chosen, chosen)
        self._soon()

    def _set_exactly(self, text: str) -> None:
        path, _, written = (part.strip() for part in text.partition("="))
        if not text:
            return
        try:
            given = slider_input(self.case, path)
            if given.unit == "/rev" and written.endswith("/rev"):
                value = to_si(written.removesuffix("/rev"), "")
            else:
                value = to_si(written, design_inputs(self.case)[path].unit) / given.factor
        except InputError as error:
            self.message.text = _alert(f"{error if error.field else error.within(path)}.")
            return
        if path not in self.choice.value:
            self.choice.value = [*self.choice.value, path]
        slider = self.sliders[path]
        slider.update(start=min(slider.start, value), end=max(slider.end, value))
        slider.value = value

    def _reset(self) -> None:
        self._held = True
        for path, slider in self.sliders.items():
            given = self.inputs[path]
            slider.update(start=given.low, end=given.high, value=given.value)
        for name, switch in self.switches.items():
            switch.value = _word(self.first_options[name])
        self.values, self.options, self._held = {}, dict(self.first_options), False
        self.update()

    def _save(self) -> None:
        text = altered_deck(self.base, self.case, self.values, self.settings, self.options)
        self.deck.data = {"text": [text]}

    def _soon(self) -> None:
        """Update the page once for all moves within a short time."""
        if self._waiting or self._held or self.document is None:
            return
        self._waiting = True
        self.document.add_timeout_callback(self.update, _TOGETHER)

    # Layout and plots -------------------------------------------------------------------------------------------

    def _layout(self) -> Any:
        reset = Button(label="Reset", name="reset", width=90)
        reset.on_click(self._reset)
        save = Button(label="Save as a deck", name="save", button_type="primary", width=150)
        save.on_click(self._save)
        file = {"name": f"{explored_name(self.case)}.toml"}
        self.deck.js_on_change("data", CustomJS(args=file, code=_DOWNLOAD))
        tabs = {
            "Inputs": self.side,
            "More inputs": column(self.exact, self.choice),
            "Model": column(*self.switches.values()),
            "Help": self.guide,
        }
        panels = Tabs(tabs=[TabPanel(title=name, child=child) for name, child in tabs.items()], name="tabs")
        side = column(row(reset, save), panels, width=_SIDE + 20)
        heading = escape(self.case.title or self.case.name)
        title = Div(text=f"<h1 style='font-size:18px;margin:4px 0'>{heading}</h1>", width=850)
        plots = row(self._damping(), self._root_locus())
        return row(side, column(title, self.readout, plots, self.message, self.foot), spacing=8)

    def _damping(self) -> Any:
        ends = tuple(float(speed) / KNOT for speed in self.airspeeds[[0, -1]])
        plot = _figure(
            "Damping", 490, ("Airspeed, KTAS", ends), ("Damping −Re s/|s| (% of critical)", _DAMPING)
        )
        self._draw(plot, "airspeed", "damping", [("airspeed", "$x{0.0} KTAS"), ("damping", "$y{0.00} %")])
        plot.add_layout(Span(location=0, dimension="width", line_color="black"))
        plot.add_layout(BoxAnnotation(top=0, fill_color=UNSTABLE, fill_alpha=1, level="image"))
        return plot

    def _root_locus(self) -> Any:
        across, up = ("Growth Re s (per rev)", _GROWTH), ("Frequency |Im s| (per rev)", _FREQUENCY)
        plot = _figure("Root locus", 360, across, up)
        self._draw(plot, "growth", "frequency", [("growth", "$x{0.000}"), ("frequency", "$y{0.000}")])
        plot.scatter("growth", "frequency", source=self.dots, color="colour", size=7)
        plot.add_layout(Span(location=0, dimension="height", line_color="black"))
        plot.add_layout(BoxAnnotation(left=0, fill_color=UNSTABLE, fill_alpha=1, level="image"))
        return plot

    def _draw(self, plot: Any, across: str, up: str, values: list[tuple[str, str]]) -> None:
        """Draw the lines of all modes, with the values that show beside the pointer, and a legend below damping."""
        style = {"line_color": "colour", "line_dash": "dash", "line_width": "width"}
        drawn = plot.multi_line(across, up, source=self.lines, **style)
        tooltips = [("mode", "@mode"), *values]
        plot.add_tools(HoverTool(renderers=[drawn], tooltips=tooltips, line_policy="nearest"))
        if up == "damping":
            legend = Legend(items=[LegendItem(label={"field": "mode"}, renderers=[drawn])])
            legend.update(label_text_font_size="10px", spacing=5, padding=3, glyph_width=28, glyph_height=12)
            legend.update(location="bottom_left", ncols=4, label_height=12, border_line_color=None)
            plot.add_layout(legend, "below")
        plot.toolbar.logo = None


def _figure(title: str, width: int, across: tuple[str, Any], up: tuple[str, Any]) -> Any:
    """Return an empty plot whose axes, across and up, each have a label and two ends."""
    return figure(
        width=width,
        height=_HEIGHT,
        x_range=Range1d(*across[1]),
        y_range=Range1d(*up[1]),
        x_axis_label=across[0],
        y_axis_label=up[0],
        tools="pan,wheel_zoom,box_zoom,reset,save",
        title=title,
        name=title.lower().replace(" ", "-"),
    )


def _switch(case: Case, name: str, value: Any) -> Select:
    """Return a widget that chooses an option of the model."""
    lacking = (None, "tabulated") if case.frequencies is None else (None,)
    choices: list[Any] = [_word(choice) for choice in CHOICES[name] if choice not in lacking]
    label = name.replace("_", " ").capitalize()
    return Select(title=label, value=_word(value), options=choices, width=_SIDE - 20, name=name)


def _word(value: Any) -> str:
    """Return a choice as the page shows it."""
    return {True: "yes", False: "no"}.get(value, str(value))


def _alert(text: str) -> str:
    """Return the HTML of a message that screen readers read at once."""
    style = "border-left:6px double #b34700;background:#fdf3ec;padding:4px 10px;margin:0"
    return f'<p role="alert" style="{style}"><b>Cannot be:</b> {escape(text)}</p>'


def readout(found: LiveModes, values: Mapping[str, float], inputs: Mapping[str, SliderInput]) -> str:
    """Return the flutter speed and the changed inputs as HTML."""
    low, high = (f"{speed / KNOT:.4g}" for speed in found.airspeed[[0, -1]])
    onset = found.flutter
    if not np.any(found.reason == ""):
        verdict = "No airspeed could be analysed."
    elif onset is None:
        verdict = f"No mode becomes unstable between {low} and {high} KTAS."
    else:
        speed = marked(f"{onset.start / KNOT:.1f}", doubtful_near(found.airspeed, found.warning, onset.start))
        verdict = f"Flutter speed {speed} KTAS ({escape(onset.mode)}), interpolated."
    if already := [one.mode for one in found.unstable if one.open_start]:
        verdict += f" Already unstable at {low} KTAS: {escape(', '.join(already))}."
    changed = [
        f"{given.name} {value / given.factor:.4g} {given.unit} (deck {given.value:.4g})"
        for given, value in ((inputs[path], value) for path, value in values.items())
    ]
    set_to = "Changed: " + "; ".join(changed) if changed else "All inputs as in the deck."
    return f'<div aria-live="polite"><b style="font-size:16px">{verdict}</b><br>{escape(set_to)}</div>'


def messages(found: LiveModes) -> str:
    """Return the reasons why points failed or are doubtful as HTML."""
    lines = []
    for text in dict.fromkeys(found.reason[found.reason != ""].tolist()):
        at = found.airspeed[found.reason == text] / KNOT
        lines.append(f"Not analysed at {len(at)} airspeeds, {at[0]:.4g} to {at[-1]:.4g} KTAS: {text}.")
    lines += [f"{MARK} {line}" for line in footnotes(doubts_along(found.airspeed, found.warning), KTAS, KNOT)]
    return "".join(f"<p>{escape(line)}</p>" for line in lines)
