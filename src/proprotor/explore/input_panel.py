"""The inputs of the page: sliders, the choice of inputs that have one, and a line that sets a number exactly."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from typing import Any

import numpy as np
from bokeh.layouts import column
from bokeh.models.widgets import MultiChoice, Slider, TextInput

from proprotor.deck.input_values import input_values
from proprotor.deck.vary import design_inputs, inputs_at
from proprotor.errors import InputError
from proprotor.explore.chosen import Chosen
from proprotor.explore.controls import SIDE, airspeed_slider, input_slider
from proprotor.explore.inputs import SliderInput, first_inputs, slider_input
from proprotor.stability.parameter_lines import AIRSPEED
from proprotor.typing import Array
from proprotor.units import KNOT, speeds


class InputPanel:
    """The controls of inputs and airspeeds.

    Parameters
    ----------
    chosen : Chosen
        Where the settings go.
    changed : callable
        Called after each change of the settings.
    refused : callable
        Called with the reason why a line could not be read.
    shown : callable
        Called with the inputs that have a slider, whenever these are others.
    """

    def __init__(
        self,
        chosen: Chosen,
        changed: Callable[[], None],
        refused: Callable[[str], None],
        shown: Callable[[Iterable[SliderInput]], None],
    ) -> None:
        self.chosen, self._changed, self._refused, self._shown = chosen, changed, refused, shown
        self.sliders: dict[str, Slider] = {}
        self.inputs: dict[str, SliderInput] = {}
        self._quiet = False  # while controls move that no reader has moved
        self.range = airspeed_slider(chosen.case, chosen.airspeeds)
        self.range.on_change("value", lambda _, __, ends: self._range_to(*ends))
        inputs: list[Any] = list(design_inputs(chosen.case))
        self.choice = MultiChoice(
            title="Inputs with a slider (type to find others)",
            options=inputs,
            value=first_inputs(chosen.case),
            width=SIDE,
            name="choice",
        )
        self.choice.on_change("value", lambda _, __, paths: self._show_sliders(paths))
        self.exact = TextInput(
            title="Set exactly, then Enter: rotor.precone = 1.5 deg, or airspeed = 100:400:5kt",
            name="exact",
            width=SIDE,
        )
        self.exact.on_change("value", lambda _, __, text: self._set_exactly(text))
        self.side = column(name="sliders", width=SIDE)
        self._show_sliders(self.choice.value)

    def set_values(self, values: Mapping[str, float]) -> None:
        """Set inputs, SI values by path."""
        self._choose(values)
        for path, value in values.items():
            self._move(path, value / self.inputs[path].factor)

    def reset(self) -> None:
        """Move all controls to where the page began, and tell nobody."""
        self._quiet = True
        for path, slider in self.sliders.items():
            given = self.inputs[path]
            slider.update(start=given.low, end=given.high, value=given.value)
        self.range.value = _in_knots(self.chosen.first_airspeeds)
        self._quiet = False

    def _choose(self, paths: Collection[str]) -> None:
        """Give inputs a slider, also those that the deck leaves out."""
        for listed in ("options", "value"):
            setattr(self.choice, listed, list(dict.fromkeys([*getattr(self.choice, listed), *paths])))

    def _show_sliders(self, paths: list[str]) -> None:
        for path in paths:
            if path not in self.sliders:
                self._add_slider(slider_input(self.chosen.case, path))
        self.side.children = [self.range, *(self.sliders[path] for path in paths)]
        self._shown(self.inputs[path] for path in paths)

    def _add_slider(self, given: SliderInput) -> None:
        self.inputs[given.path] = given
        slider = input_slider(given)
        slider.on_change("value", lambda _, __, value: self._moved(given.path, value))
        self.sliders[given.path] = slider

    def _move(self, path: str, value: float) -> None:
        """Move a slider, beyond its ends as well."""
        slider = self.sliders[path]
        slider.update(start=min(slider.start, value), end=max(slider.end, value))
        slider.value = value

    def _moved(self, path: str, value: float) -> None:
        given = self.inputs[path]
        if value == given.value:
            self.chosen.values.pop(path, None)
        else:
            self.chosen.values[path] = value * given.factor
        self._tell()

    def _range_to(self, low: float, high: float) -> None:
        """Take as many airspeeds as at first between two ends, KTAS."""
        if high > low and not self._quiet:
            count = len(self.chosen.first_airspeeds)
            self.chosen.airspeeds = np.linspace(low * KNOT, high * KNOT, count)
            self._tell()

    def _set_exactly(self, text: str) -> None:
        path, _, written = (part.strip() for part in text.partition("="))
        if not text:
            return
        try:
            if path == AIRSPEED:
                self._set_airspeeds(written)
            else:
                self._set_input(path, written)
        except InputError as error:
            self._refused(str(error if error.field else error.within(path)))

    def _set_airspeeds(self, written: str) -> None:
        """Take airspeeds as the command line takes them."""
        given = np.unique(speeds(written, AIRSPEED, self.chosen.case.operation.density))
        if len(given) < 2:
            raise InputError(AIRSPEED, written, 'must be a range of airspeeds, "100:400:5kt"')
        low, high = ends = _in_knots(given)
        self._quiet = True
        self.range.update(start=min(self.range.start, low), end=max(self.range.end, high), value=ends)
        self._quiet = False
        self.chosen.airspeeds = given
        self._tell()

    def _set_input(self, path: str, written: str) -> None:
        """Set an input to a number, in any form in which a deck may have the number."""
        values = input_values(path, written, inputs_at(self.chosen.case, [path])[path])
        if values.size != 1:
            raise InputError(path, written, "must be one number")
        self.set_values({path: values.item()})

    def _tell(self) -> None:
        if not self._quiet:
            self._changed()


def _in_knots(airspeeds: Array) -> tuple[float, float]:
    """Return both ends of airspeeds, KTAS."""
    first, last = (round(float(speed / KNOT), 1) for speed in airspeeds[[0, -1]])
    return first, last
