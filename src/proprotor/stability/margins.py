"""Margins of the control loops of a case along airspeeds: gain, phase, delay and disk, one loop at a time."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np

from proprotor.errors import InputError
from proprotor.model import stamp
from proprotor.model.configuration import Configuration
from proprotor.model.linear_model import LinearModel
from proprotor.stability.loop_transfer import LoopTransfer, cuts_of
from proprotor.stability.margin_search import LoopMargins, frequencies, margins_of
from proprotor.stability.modes import doubt_and_failure
from proprotor.stability.root_error import roots
from proprotor.typing import Array, Dataset

_MEANINGS = {  # by the names of the margins, in the order of `LoopMargins`
    "gain_margin": ("1", "factor on the gain, above 1, at which the loop becomes unstable"),
    "gain_reduction": ("1", "factor on the gain, below 1, at which the loop becomes unstable"),
    "phase_margin": ("rad", "change of phase, to either side, at which the loop becomes unstable"),
    "delay_margin": ("s", "further delay at which the loop becomes unstable"),
    "disk_margin": ("1", "gain and phase that may change together, 0 to 2"),
}


def margins(case: Configuration, airspeeds: Any, **options: Any) -> Dataset:
    """Return how much each control loop may change before the case becomes unstable, the other loops closed.

    Each loop is cut at its actuator, or at each of its actuators in turn. Delays are exact; stability itself is that of
    the model, in which they are approximated.

    Parameters
    ----------
    case : Case
        With control loops, of one design.
    airspeeds : array (points,) in m/s, text such as "50:400:5kt", or pint quantity
    **options
        See `proprotor.rotor.options.Options`.

    Returns
    -------
    xarray.Dataset
        Over airspeed and loop: gain_margin and gain_reduction, factors above and below 1 (inf and 0 where no gain makes
        the loop unstable), phase_margin (rad), delay_margin (s; both inf where the loop gain stays below 1) and
        disk_margin, α of S - T; each with the frequency where it is lost, such as gain_margin_frequency (rad/s, NaN
        without one). Over airspeed: stable, warning and reason; margins are NaN where the closed loop is unstable or a
        point failed. Attributes: the case and its options (`proprotor.model.stamp`).

    Raises
    ------
    InputError
        For a case without control loops, numbers of loops that are arrays, or airspeeds that do not form a line.
    """
    _check(case)
    closed, stable = _closed(case, airspeeds, options)
    loops = list(cuts_of(case.loops))
    found = np.full((len(stable), len(loops), len(_MEANINGS), 2), np.nan)
    for point in np.flatnonzero(stable):
        found[point] = _at(case, float(closed.airspeed[point]), options)
    return _dataset(closed, stable, found, loops)


def _check(case: Configuration) -> None:
    """Refuse a case without control loops, and one of many designs."""
    if not case.loops:
        rule = "has no control loop: give [control] in its deck, or case.with_control(...)"
        raise InputError("case", case.name, rule)
    for loop in case.loops:
        if loop.shape:
            raise InputError(
                f"control.loops[{loop.name}]", f"array of shape {loop.shape}", "must be one design"
            )


def _closed(case: Configuration, airspeeds: Any, options: Mapping[str, Any]) -> tuple[LinearModel, Array]:
    """Return the case with its loops closed at airspeeds (k,), and which of the points are stable."""
    closed = case.linearize(airspeeds, **options)
    if closed.airspeed.ndim != 1:
        raise InputError(
            "airspeeds", f"array of shape {closed.airspeed.shape}", "must be a list of airspeeds"
        )
    values, error = roots(closed)
    decays = (values.real < -error) | np.isnan(values)  # a state that a point does not have
    return closed, np.asarray(decays.all(axis=-1) & np.isfinite(values).any(axis=-1))


def _at(case: Configuration, airspeed: float, options: Mapping[str, Any]) -> list[LoopMargins]:
    """Return the margins of all loops at an airspeed at which the case is stable."""
    loops = LoopTransfer(case.open_loop(airspeed, **options), case.loops)
    delay, closed = (
        sum(0.0 if loop.delay is None else float(loop.delay) for loop in case.loops),
        loops.roots(),
    )
    return [
        margins_of(
            partial(loops.transfer, cut), frequencies(np.concatenate([closed, loops.roots(cut)]), delay)
        )
        for cut in cuts_of(case.loops).values()
    ]


def _dataset(closed: LinearModel, stable: Array, found: Array, loops: list[str]) -> Dataset:
    """Return the dataset of margins (points, loops, kinds, value and frequency)."""
    import xarray  # here, because it takes long to import

    dims = ("airspeed", "loop")
    data: dict[str, Any] = {}
    for kind, (name, (units, meaning)) in enumerate(_MEANINGS.items()):
        data[name] = dims, found[:, :, kind, 0], {"units": units, "long_name": meaning}
        where = {"units": "rad/s", "long_name": f"frequency at which the {name.replace('_', ' ')} is lost"}
        data[f"{name}_frequency"] = dims, found[:, :, kind, 1], where
    data["stable"] = "airspeed", stable, {"long_name": "whether every mode of the closed loop decays"}
    coordinates = {"airspeed": ("airspeed", closed.airspeed, {"units": "m/s"}), "loop": loops}
    return xarray.Dataset(data | doubt_and_failure(closed, dims[:1]), coordinates, stamp.of_model(closed))
