"""The modes of a case at one airspeed by their names, with their vectors."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from proprotor.errors import InputError, check_known
from proprotor.model.configuration import Configuration
from proprotor.model.linear_model import LinearModel
from proprotor.stability.matching import Modes
from proprotor.stability.mode_names import moving
from proprotor.stability.modes import decomposition
from proprotor.stability.sweep import mode_columns
from proprotor.units import in_metres_per_second


class _NamedModes(NamedTuple):
    """Modes at an airspeed.

    names (modes,); modes : eigenvalues and vectors; model : at the airspeed; speed : m/s.
    """

    names: list[str]
    modes: Modes
    model: LinearModel
    speed: float


def named_modes(
    case: Configuration, airspeed: Any, mode: str | None, options: Mapping[str, Any]
) -> _NamedModes:
    """Return the modes of a case at one airspeed, or one of these modes by its name.

    Raises
    ------
    InputError
        For a value that is no single airspeed, an airspeed that cannot be analysed, many designs, and an unknown mode.
    """
    speed = in_metres_per_second(airspeed, case.operation.density).reshape(-1)
    if len(speed) != 1:
        raise InputError("airspeed", airspeed, "must be one speed")
    model = case.linearize(speed[0], **options)
    if model.airspeed.ndim:
        raise InputError("case", case.name, f"must be one design, not {model.airspeed.size}")
    if model.trim.reason.item():
        raise InputError("airspeed", airspeed, model.trim.reason.item())
    spectrum = decomposition(model)
    values, right, left = spectrum.all_modes
    found = moving(model, values, left, right)
    columns, names = mode_columns(found._replace(place=found.place[None]), values[None])
    if mode is not None:
        check_known("mode", mode, names, "mode")
    chosen = np.array([names.index(name) for name in (names if mode is None else [mode])])
    wanted = spectrum.modes(columns[0, chosen])
    return _NamedModes([names[place] for place in chosen], wanted, model, float(speed[0]))


def doubtful_numbers(warning: Any) -> tuple[tuple[()], str, dict[str, str]]:
    """Return the variable of a dataset that tells what makes all its numbers doubtful."""
    return (), str(warning), {"long_name": "what makes the numbers doubtful"}
