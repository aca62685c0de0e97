"""The worst flutter speed of a box of inputs, looked for by a search: what percentiles do not tell."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from proprotor.case import Case
from proprotor.datum import deck_unit
from proprotor.model import stamp
from proprotor.stability.boundaries import scan_speeds
from proprotor.study.box import Box, box_of
from proprotor.study.box_search import FREQUENCY, SPEED, BoxSearch
from proprotor.study.designs import check_count
from proprotor.study.variables import ABOVE, BELOW, VARIABLE
from proprotor.typing import Array, Dataset

_MOST_DESCENTS = 6
_OF_INSTABILITY = {
    "speed": SPEED,
    "frequency": FREQUENCY,
    "mode": "flutter_mode",
    "coordinate": "flutter_coordinate",
    "warning": "flutter_warning",
}
_TEXTS, _NOTHING = ("flutter_mode", "flutter_coordinate", "flutter_warning"), (np.nan, "")
_OF_DESIGN = {"speed_below": BELOW, "speed_above": ABOVE, "least_damping": "flutter_least_damping"}


def robust_boundary(
    case: Case,
    box: Mapping[str, Any],
    airspeeds: Any = None,
    *,
    size: int = 64,
    seed: int = 0,
    workers: int | None = None,
    **options: Any,
) -> Dataset:
    """Return the lowest flutter speed that a search finds in a box of inputs, and where.

    The search tries the middle of the box, its corners if they are few, and a sample of its inside, and goes down along
    exact derivatives from the lowest design of each mode. A search is no proof that no design of the box is worse.

    Parameters
    ----------
    case : Case
    box : mapping
        By deck path (`proprotor.design_inputs`) a pair of limits in any unit, or a `Range`, `LogRange` or `Relative` of
        `proprotor.sampling`.
    airspeeds : array (points,) in m/s, text such as "100:400:10kt", or pint quantity, optional
        The range of the flutter speeds; 0.2 to 1.2 of the tip speed by default.
    size : int
        Number of designs inside the box that are tried first, a power of two.
    seed : int
        Of the sample inside the box.
    workers : int, optional
        Processes for the designs that are tried first, as in `proprotor.study`.
    **options
        See `proprotor.rotor.options.Options`.

    Returns
    -------
    xarray.Dataset
        speed, the lowest flutter speed, m/s; speed_below, the limit where a design is unstable at the lowest airspeed
        already, or speed_above, where all are stable throughout; frequency (rad/s), mode and coordinate of the
        instability, warning, what makes the speed doubtful, and least_damping. Over ``input``: value, low and high of
        the box in SI; side, "low", "high" or "inside"; derivative of the speed, m/s per SI unit. Over ``first``, the
        modes that are the first instability of some design: speed_of_first, the lowest found, m/s, and value_of_first
        (first, input). Attributes: numbers of designs, evaluated, below and above the airspeeds, and failed; reason,
        why the first of these failed; search, how the box was searched; the case and its options
        (`proprotor.model.stamp`).

    Raises
    ------
    InputError
        For an unknown input or option, limits that are none, airspeeds that `proprotor.study` refuses, or a box in
        which no design can be analysed.
    """
    own = box_of(case, box)
    check_count("size", size)
    search = BoxSearch(case, own, scan_speeds(case) if airspeeds is None else airspeeds, options)
    middle = np.full((1, len(own.known)), 0.5)
    search.try_at(np.concatenate([middle, own.corners, own.inside(size, seed)]), workers)
    search.check_known()
    starts = list(search.lowest_of_each_mode().values())[:_MOST_DESCENTS]
    if np.isneginf(search.speeds).any():  # nothing is lower
        starts = []
    for start in starts:
        search.go_down(start)
    return _dataset(search, _words(own, size, len(starts)))


def _words(box: Box, size: int, descents: int) -> str:
    """Return how a box was searched, in a sentence."""
    corners = f"{len(box.corners)} corners" if box.has_few_corners else "no corner of so many"
    return (
        f"The middle, {corners}, {size} designs inside and {descents} descents along derivatives were tried; "
        "a search is no proof that no design of the box is worse."
    )


def _dataset(search: BoxSearch, words: str) -> Dataset:
    import xarray  # here, because it takes long to import

    box, found, worst = search.box, search.found, search.worst
    one, place = found.isel(design=worst), search.places[worst]
    if np.isfinite(one[BELOW]):  # the flutter speed is that of another mode, which follows
        one = one.assign({own: ((), _NOTHING[own in _TEXTS]) for own in _OF_INSTABILITY.values()})
    names = _OF_INSTABILITY | _OF_DESIGN
    data: dict[str, Any] = {name: ((), one[own].item(), _attributes(own)) for name, own in names.items()}
    firsts = search.lowest_of_each_mode()
    designs = list(firsts.values())
    data |= {
        "value": ("input", _inputs(box, place[None, :])[0], {"long_name": "of the worst design, SI"}),
        "low": ("input", box.low, {"long_name": "lower limit of the box, SI"}),
        "high": ("input", box.high, {"long_name": "upper limit of the box, SI"}),
        "side": ("input", box.sides(place), {"long_name": "where the worst design lies in the box"}),
        "derivative": ("input", _derivatives(search, one, place), {"units": "m/s per SI unit of the input"}),
        "speed_of_first": ("first", search.speeds[designs], {"units": "m/s"}),
        "value_of_first": (("first", "input"), _inputs(box, search.places[designs])),
    }
    in_deck = [deck_unit(number) for number in box.known.values()]
    coordinates = {
        "input": list(box.known),
        "unit": ("input", [number.unit for number in box.known.values()]),
        "deck_unit": ("input", [unit for unit, _ in in_deck]),
        "deck_unit_in_si": ("input", [size for _, size in in_deck]),
        "first": list(firsts),
    }
    counts = {"evaluated": len(search.places), "failed": int(search.failed.sum())}
    counts |= {"below": int(np.isneginf(search.speeds).sum()), "above": int(np.isposinf(search.speeds).sum())}
    own = counts | {
        "reason": search.first_failure,
        "search": words,
        "title": str(found.attrs.get("title", "")),
    }
    return xarray.Dataset(data, coordinates, stamp.of(found.attrs) | own)


def _attributes(name: str) -> dict[str, str]:
    return {"long_name": VARIABLE[name].meaning} | (
        {"units": VARIABLE[name].units} if VARIABLE[name].units else {}
    )


def _inputs(box: Box, places: Array) -> Array:
    """Return the inputs (designs, inputs), SI."""
    return np.stack(list(box.values(places).values()), axis=-1)


def _derivatives(search: BoxSearch, one: Dataset, place: Array) -> Array:
    """Return the derivatives (inputs,) of the flutter speed of the worst design; NaN without a flutter speed."""
    speed, frequency = float(one[SPEED]), float(one[FREQUENCY])
    if not np.isfinite(speed):
        return np.full(len(place), np.nan)
    return search.derivatives(place, speed, frequency)
