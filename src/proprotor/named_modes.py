"""The modes of a case at one airspeed by their names, with their vectors."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from proprotor.errors import InputError, unknown_name
from proprotor.model import LinearModel
from proprotor.modes import decomposition
from proprotor.speed import in_metres_per_second
from proprotor.sweep import sweep_case
from proprotor.tracking import Modes

if TYPE_CHECKING:
    from proprotor.case import Case


class NamedModes(NamedTuple):
    """Modes at an airspeed.

    names (modes,); modes, their eigenvalues and vectors; model, at speed in m/s; eigen_solves, what finding them took.
    """

    names: list[str]
    modes: Modes
    model: LinearModel
    speed: float
    eigen_solves: int


def named_modes(case: Case, airspeed: Any, mode: str | None, options: Mapping[str, Any]) -> NamedModes:
    """The modes of a case at one airspeed, or one of them by its name.

    Raises
    ------
    InputError
        For an airspeed that is not one, or that cannot be analysed, many designs, and an unknown mode.
    """
    speed = in_metres_per_second(airspeed).reshape(-1)
    if len(speed) != 1:
        raise InputError("airspeed", airspeed, "must be one speed")
    named = sweep_case(case, speed, **options)
    if named.sizes["airspeed"] != 1:
        raise InputError("case", case.name, f"must be one design, not {named.sizes['airspeed']}")
    named = named.isel(airspeed=0)
    if named.reason.item():
        raise InputError("airspeed", airspeed, named.reason.item())
    found = named.isel(mode=np.flatnonzero(np.isfinite(named.eigenvalue.values.real)))
    names = [str(name) for name in found.mode.values]
    if mode is not None and mode not in names:
        raise InputError("mode", mode, unknown_name(mode, names, "mode"))
    names = names if mode is None else [mode]
    model = case.linearize(speed[0], **options)
    spectrum = decomposition(model)
    wanted = found.eigenvalue.sel(mode=names).values
    places = np.abs(spectrum.values[None, :] - wanted[:, None]).argmin(axis=1)
    solves = int(named.attrs["eigen_solves"]) + 1
    return NamedModes(names, spectrum.modes(places), model, float(speed[0]), solves)
