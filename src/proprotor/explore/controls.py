"""The controls of the page: Bokeh's sliders and selections with the names and ranges of this problem."""

from __future__ import annotations

from typing import Any

import numpy as np
from bokeh.models.widgets import RangeSlider, Select, Slider

from proprotor.case import Case
from proprotor.deck.vary import design_inputs
from proprotor.explore.inputs import SliderInput
from proprotor.rotor.options import CHOICES
from proprotor.stability.parameter_lines import AIRSPEED, tip_speed
from proprotor.typing import Array
from proprotor.units import KNOT, KTAS

SIDE = 330  # pixels, the width of the controls
GRIDS = {"coarse": (21, 15), "usual": (31, 21), "fine": (61, 41)}  # points of the map, across and up
_BLUE = "#0072B2"
_SPEED_STEP, _LARGEST_SPEED = 5, 1.5  # KTAS; of the tip speed


def input_slider(given: SliderInput) -> Slider:
    """Return the slider of an input, in the unit of the deck."""
    return Slider(
        title=given.label,
        value=given.value,
        start=given.low,
        end=given.high,
        step=given.step,
        format="0,0.[00000]",
        width=SIDE - 20,
        height=36,
        name=given.path,
        bar_color=_BLUE,
    )


def airspeed_slider(case: Case, airspeeds: Array) -> RangeSlider:
    """Return the slider of both ends of the airspeeds."""
    first, last = (round(float(speed / KNOT), 1) for speed in airspeeds[[0, -1]])
    most = max(_LARGEST_SPEED * float(tip_speed(case)) / KNOT, last)
    return RangeSlider(
        title=f"Airspeeds ({KTAS})",
        value=(first, last),
        start=min(_SPEED_STEP, first),
        end=_SPEED_STEP * np.ceil(most / _SPEED_STEP),
        step=_SPEED_STEP,
        format="0,0.[0]",
        width=SIDE - 20,
        height=36,
        name=AIRSPEED,
        bar_color=_BLUE,
    )


def airspeed_of_map(case: Case, airspeeds: Array) -> Slider:
    """Return the slider of the airspeed at which a map of two other inputs is cut."""
    most = max(_LARGEST_SPEED * float(tip_speed(case)), float(airspeeds[-1])) / KNOT
    return Slider(
        title=f"At airspeed ({KTAS})",
        value=_SPEED_STEP * round(float(airspeeds[[0, -1]].mean() / KNOT / _SPEED_STEP)),
        start=_SPEED_STEP,
        end=_SPEED_STEP * np.ceil(most / _SPEED_STEP),
        step=_SPEED_STEP,
        width=SIDE - 20,
        height=36,
        name="map-at",
        bar_color=_BLUE,
    )


def option_switch(case: Case, name: str, value: Any) -> Select:
    """Return a selection of an option of the model."""
    lacking = (None, "auto", "tabulated") if case.frequencies is None else (None, "auto")
    choices: list[Any] = [word(choice) for choice in CHOICES[name] if choice not in lacking]
    label = name.replace("_", " ").capitalize()
    return Select(title=label, value=word(value), options=choices, width=SIDE - 20, name=name)


def map_selections(case: Case, up: str) -> tuple[Select, Select, Select]:
    """Return selections of the inputs of the map, across and up, and of its grid."""
    inputs: list[Any] = list(design_inputs(case))
    across = Select(
        title="Across", value=AIRSPEED, options=[AIRSPEED, *inputs], width=SIDE - 20, name="map-x"
    )
    upward = Select(title="Up", value=up, options=[AIRSPEED, *inputs], width=SIDE - 20, name="map-y")
    grids: list[Any] = [(name, f"{name}: {x} × {y}") for name, (x, y) in GRIDS.items()]
    grid = Select(title="Points", value="usual", options=grids, width=SIDE - 20, name="map-points")
    return across, upward, grid


def word(value: Any) -> str:
    """Return a choice as the page shows it."""
    return {True: "yes", False: "no"}.get(value, str(value))


def choice_of(shown: str) -> Any:
    """Return the choice that the page shows as a word."""
    return {"yes": True, "no": False}.get(shown, shown)
