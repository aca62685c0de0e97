"""Boundaries of a case against one input: the airspeed of each boundary over altitude, rotor speed or another number.

Every value of the input is a line of airspeeds, and the boundaries of all lines are found at once, each exactly
(`proprotor.stability.crossings`, `proprotor.stability.brackets`). Boundaries at neighbouring values are one branch if
the root that is neutral at one is, by its vectors, the root that is neutral at the other.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from proprotor.deck.input_values import input_values
from proprotor.deck.vary import inputs_at
from proprotor.deck.vary import vary as vary_case
from proprotor.errors import InputError
from proprotor.model import stamp
from proprotor.model.configuration import Configuration
from proprotor.stability.boundaries import scan_shares
from proprotor.stability.boundary_search import (
    Found,
    Lines,
    OfLine,
    check_size,
    points_of,
    search_lines,
    stacked,
)
from proprotor.stability.kinds import FLUTTER, flies_free
from proprotor.stability.matching import Spectrum, conjugate, match_modes
from proprotor.stability.parameter_lines import AIRSPEED
from proprotor.typing import Array, Dataset
from proprotor.units import SEA_LEVEL_DENSITY, in_metres_per_second

_FEWEST = 51  # airspeeds of a value, at least about: wide steps are divided


def boundary_against(
    case: Configuration,
    against: Mapping[str, ArrayLike],
    airspeeds: Any = None,
    *,
    level: float = 0.0,
    **options: Any,
) -> Dataset:
    """Return the boundaries of a case against one input.

    Parameters
    ----------
    case : Case
    against : mapping of str to array
        One input by its path in the deck (`proprotor.deck.vary.design_inputs`), and its values, rising: numbers in SI,
        text such as "300:610:20 rpm", quantities and data arrays.
    airspeeds : array (points,) in m/s, text such as "100:400:5keas", or pint quantity, optional
        The scan at each value of the input, by default 0.2 of the lowest to 1.2 of the highest tip speed. Equivalent
        airspeeds hold in the air of each value.
    level : float
        Damping ratio that counts as the boundary.
    **options
        See `proprotor.rotor.options.Options`.

    Returns
    -------
    xarray.Dataset
        Over the input and ``branch``, one for each root that becomes unstable or stable again: airspeed, m/s, true, and
        equivalent_airspeed, m/s; frequency, rad/s; mode, what moves at the boundary; kind, flutter, divergence or, of
        an aircraft, rigid body; warning, what makes the boundary doubtful. NaN and "" where a branch has no boundary.
        onset (branch,): whether the root becomes unstable. Over the input alone: first, the lowest onset, of a free
        aircraft of flutter, m/s, and first_branch; note, why there is no onset, or that it is not the first
        instability; reason, why airspeeds failed; searched (end,), the lowest and the highest airspeed that could be
        analysed, m/s; density, kg/m³; rotor_speed, rad/s. Attributes: level, eigen_solves, and the case and its options
        (`proprotor.model.stamp`).

    Raises
    ------
    InputError
        For an unknown input or option, values that do not rise or are not physical, airspeeds that do not rise, and a
        level that is no damping ratio.
    """
    if not -1 < level < 1:
        raise InputError("level", level, "must be a damping ratio, between -1 and 1")
    path, values = _input_of(case, against)
    asked = () if airspeeds is None else in_metres_per_second(airspeeds, 1.0).shape[-1:]
    check_size("against", len(values), max(*asked, _FEWEST, 1))
    varied = vary_case(case, {path: values})  # raises an error that names what is wrong with the values
    lines = _lines(varied, path, values, airspeeds)
    found, solves = search_lines(case, lines, level, options)
    dataset = _dataset(path, values, varied, found, flies_free(case))
    dataset["rotor_speed"] = (
        path,
        np.broadcast_to(varied.operation.rotor_speed, values.shape),
        {"units": "rad/s"},
    )
    dataset[path].attrs["units"] = inputs_at(case, [path])[path].unit
    own_stamp = stamp.of_case(case, options, (path,))
    return dataset.assign_attrs(own_stamp | {"level": level, "eigen_solves": solves})


def _input_of(case: Configuration, against: Mapping[str, ArrayLike]) -> tuple[str, Array]:
    """Return the path of the input and its values in SI."""
    if len(against) != 1:
        raise InputError("against", ", ".join(against), "must be one input and its values")
    (path, given), *_ = against.items()
    values = np.atleast_1d(input_values(path, given, inputs_at(case, [path])[path]))
    if values.ndim != 1 or not values.size or not np.all(np.diff(values) > 0):
        raise InputError(path, np.array2string(values, threshold=6), "must be a list of values that rise")
    return path, values


def _lines(varied: Configuration, path: str, values: Array, airspeeds: Any) -> Lines:
    """Return the scans of all values: as asked for, or from the lowest to the highest default scan of all values."""
    operation, rotor = varied.operation, varied.rotor
    density = np.broadcast_to(operation.density, values.shape)
    tips = np.broadcast_to(np.asarray(operation.rotor_speed) * rotor.radius, values.shape)
    if airspeeds is None:
        shares = scan_shares()
        asked = np.array([shares[0] * tips.min(), shares[-1] * tips.max()])
    else:
        asked = in_metres_per_second(airspeeds, density[:, None])
        if asked.ndim == 0 or asked.shape[-1] < 2 or not np.all(np.diff(asked) > 0):
            raise InputError(AIRSPEED, airspeeds, "must be a range of airspeeds that rise")
    each = np.broadcast_to(asked, (len(values), asked.shape[-1]))
    return Lines({path: values}, *points_of(list(each), tips.tolist()))


# Branches ------------------------------------------------------------------------------------------------------------


_Branch = dict[int, Found]  # boundaries by the place of their value


def _branches(lines: list[OfLine]) -> list[_Branch]:
    """Return boundaries as branches; the branch with the lowest airspeed first."""
    found = [one for line in lines for one in line.boundaries]
    at = [place for place, line in enumerate(lines) for _ in line.boundaries]
    successor: dict[int, int] = {}
    if found:
        spectrum = stacked([one.crossing for one in found])
        own = [[k for k, place in enumerate(at) if place == line] for line in range(len(lines))]
        for before, after in pairwise(own):
            successor |= _links(found, spectrum, before, after)
    starts = set(range(len(found))) - set(successor.values())
    branches = []
    for start in starts:
        chain = [start]
        while chain[-1] in successor:
            chain.append(successor[chain[-1]])
        branches.append({at[k]: found[k] for k in chain})
    return sorted(branches, key=lambda branch: min(one.crossing.position for one in branch.values()))


def _links(found: list[Found], spectrum: Spectrum, before: list[int], after: list[int]) -> dict[int, int]:
    """Return which boundary of one line is which of the next: by vectors first, then by name, the nearest first."""
    pairs = [(a, b) for a in before for b in after if found[a].crossing.onset == found[b].crossing.onset]
    if not pairs:
        return {}
    first, last = np.array(pairs).T
    states = np.array([one.crossing.state for one in found])
    successor = match_modes(spectrum, first, last).successor[np.arange(len(first)), states[first]]
    twin = conjugate(spectrum.values)[last, states[last]]
    same_root = (successor == states[last]) | (successor == twin)
    speed = np.array([one.crossing.position for one in found])
    same_name = np.array([found[a].mode == found[b].mode for a, b in pairs])
    links: dict[int, int] = {}
    for place in np.lexsort((np.abs(speed[first] - speed[last]), ~same_root)):
        a, b = pairs[place]
        if (same_root | same_name)[place] and a not in links and b not in links.values():
            links[a] = b
    return links


def _begins(branch: _Branch) -> bool:
    """Return whether the root of a branch becomes unstable, and not stable again."""
    return next(iter(branch.values())).crossing.onset


def _labels(branches: list[_Branch]) -> list[str]:
    """Return a label of each branch: the name that most of its boundaries have, with a number from the second on."""
    taken: Counter[str] = Counter()
    labels = []
    for branch in branches:
        mode = Counter(one.mode for one in branch.values()).most_common(1)[0][0]
        name = mode if _begins(branch) else f"{mode}, stable again"
        taken[name] += 1
        labels.append(name if taken[name] == 1 else f"{name} ({taken[name]})")
    return labels


def _dataset(path: str, values: Array, varied: Configuration, found: list[OfLine], free: bool) -> Dataset:
    """Return the dataset of the branches over the values of the input; of a free aircraft, flutter comes first."""
    import xarray  # here, because it takes long to import

    branches = _branches(found)
    shape = len(values), len(branches)
    density = np.broadcast_to(varied.operation.density, values.shape)
    speed, frequency = np.full(shape, np.nan), np.full(shape, np.nan)
    mode, kind, warning = (np.full(shape, "", dtype=object) for _ in range(3))
    for place, branch in enumerate(branches):
        for line, one in branch.items():
            at = line, place
            speed[at], frequency[at] = one.crossing.position, abs(one.crossing.value.imag)
            mode[at], kind[at], warning[at] = one.mode, one.kind, one.warning
    note, reason = (np.array([getattr(one, text) for one in found], dtype=str) for text in ("note", "reason"))
    labels = _labels(branches)
    onset = np.array([_begins(branch) for branch in branches], dtype=bool)
    first, first_branch = _lowest(np.where(free & (kind != FLUTTER), np.nan, speed), onset, labels)
    both, per_density = (path, "branch"), np.sqrt(density / SEA_LEVEL_DENSITY)
    return xarray.Dataset(
        {
            "airspeed": (both, speed, {"units": "m/s", "long_name": "true airspeed of the boundary"}),
            "equivalent_airspeed": (
                both,
                speed * per_density[:, None],
                {"units": "m/s", "long_name": "equivalent airspeed of the boundary"},
            ),
            "frequency": (both, frequency, {"units": "rad/s", "long_name": "|Im s|; 0: divergence"}),
            "mode": (both, mode.astype(str), {"long_name": "what moves in the mode at the boundary"}),
            "kind": (both, kind.astype(str), {"long_name": "flutter, divergence or rigid body"}),
            "warning": (both, warning.astype(str), {"long_name": "what makes the boundary doubtful"}),
            "onset": ("branch", onset, {"long_name": "whether the root becomes unstable"}),
            "first": (path, first, {"units": "m/s", "long_name": "lowest true airspeed of an onset"}),
            "first_branch": (path, first_branch, {"long_name": "branch of the lowest onset"}),
            "note": (path, note, {"long_name": "on the lowest onset"}),
            "reason": (path, reason, {"long_name": "why airspeeds failed"}),
            "searched": (
                (path, "end"),
                np.array([one.searched for one in found]),
                {"units": "m/s", "long_name": "lowest and highest true airspeed that could be analysed"},
            ),
            "density": (path, density, {"units": "kg/m**3", "long_name": "of the air"}),
        },
        coords={path: values, "branch": np.array(labels, dtype=str), "end": ["low", "high"]},
    )


def _lowest(speed: Array, onset: Array, labels: list[str]) -> tuple[Array, Array]:
    """Return the lowest onset (values,) over the branches, NaN where there is none, and its branch."""
    onsets = np.where(onset & np.isfinite(speed), speed, np.inf)
    if not onsets.shape[1]:
        return np.full(len(speed), np.nan), np.full(len(speed), "")
    place = onsets.argmin(axis=1)
    lowest = onsets[np.arange(len(speed)), place]
    names = np.where(np.isfinite(lowest), np.array(labels)[place], "")
    return np.where(np.isfinite(lowest), lowest, np.nan), names
