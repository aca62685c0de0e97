"""Boundaries of a case against one input: the airspeed of each boundary over altitude, rotor speed or another number.

Every value of the input is a line of airspeeds, and the boundaries of all lines are found at once, each exactly
(`proprotor.stability.crossings`, `proprotor.stability.brackets`). Boundaries at neighbouring values are one branch if
the root that is neutral at one is, by its vectors, the root that is neutral at the other.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.deck.vary import check_input, design_inputs
from proprotor.deck.vary import vary as vary_case
from proprotor.errors import InputError
from proprotor.model import stamp
from proprotor.model.configuration import Configuration
from proprotor.model.linear_model import LinearModel
from proprotor.needs import check_memory
from proprotor.stability.boundaries import scan_shares, steps_of_scan
from proprotor.stability.brackets import Brackets, Crossing, each_once
from proprotor.stability.crossings import Search
from proprotor.stability.kinds import FLUTTER, flies_free, kinds
from proprotor.stability.matching import Spectrum, conjugate, match_modes
from proprotor.stability.mode_names import moving
from proprotor.stability.parameter_lines import AIRSPEED, models_at
from proprotor.typing import Array, Dataset
from proprotor.units import KNOT, KTAS, SEA_LEVEL_DENSITY, in_metres_per_second, values_in_si

_AT_ONCE = 2048  # points of one batch
_FEWEST = 51  # airspeeds of a value, at least about: wide steps are divided
_BYTES_PER_POINT, _BYTES_AT_ONCE = 100.0, 230_000.0  # of each point, and while a point is analysed


class _Lines(NamedTuple):
    """Lines of airspeeds, one for each value of the input.

    path : of the input; values, density (k,) : of the input and of the air, SI; line, position (points,) : all points
    of the scans, in the order of the lines and rising along each.
    """

    path: str
    values: Array
    density: Array
    line: Array
    position: Array


class _Found(NamedTuple):
    """A boundary at one value of the input.

    crossing; mode, what moves; kind, see `proprotor.stability.kinds`; warning, what makes the boundary doubtful.
    """

    crossing: Crossing
    mode: str
    kind: str
    warning: str


class _OfLine(NamedTuple):
    """What was found at one value of the input.

    boundaries, by airspeed; note, why there is no onset, or that it is not the first instability; reason, why airspeeds
    failed; searched, the lowest and the highest airspeed that could be analysed, m/s.
    """

    boundaries: list[_Found]
    note: str
    reason: str
    searched: tuple[float, float] = (np.nan, np.nan)


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
    _check_size(len(values), airspeeds)
    varied = vary_case(case, {path: values})  # raises an error that names what is wrong with the values
    lines = _lines(varied, path, values, airspeeds)
    found: list[_OfLine] = []
    solves = 0
    for some in _batches(lines):
        own, count = _boundaries_of(case, some, level, options)
        found += own
        solves += count
    dataset = _dataset(lines, found, flies_free(case))
    dataset["rotor_speed"] = (
        path,
        np.broadcast_to(varied.operation.rotor_speed, values.shape),
        {"units": "rad/s"},
    )
    dataset[path].attrs["units"] = design_inputs(case)[path].unit
    own_stamp = stamp.of_case(case, options, (path,))
    return dataset.assign_attrs(own_stamp | {"level": level, "eigen_solves": solves})


def _input_of(case: Configuration, against: Mapping[str, ArrayLike]) -> tuple[str, Array]:
    """Return the path of the input and its values in SI."""
    if len(against) != 1:
        raise InputError("against", ", ".join(against), "must be one input and its values")
    (path, given), *_ = against.items()
    known = design_inputs(case)
    check_input(path, known)
    values = np.atleast_1d(values_in_si(given, known[path].unit, path))
    if values.ndim != 1 or not values.size or not np.all(np.diff(values) > 0):
        raise InputError(path, np.array2string(values, threshold=6), "must be a list of values that rise")
    return path, values


def _check_size(values: int, airspeeds: Any) -> None:
    """Refuse a search that does not fit into memory."""
    asked = () if airspeeds is None else in_metres_per_second(airspeeds, 1.0).shape[-1:]
    count = values * max(*asked, _FEWEST, 1)
    size = _BYTES_PER_POINT * count + _BYTES_AT_ONCE * min(count, _AT_ONCE)
    check_memory("against", f"{count:.4g} points", size, "the boundaries", "take larger steps")


def _lines(varied: Configuration, path: str, values: Array, airspeeds: Any) -> _Lines:
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
    scans = [steps_of_scan(own, tip) for own, tip in zip(each, tips.tolist(), strict=True)]
    line = np.repeat(np.arange(len(values)), [len(scan) for scan in scans])
    return _Lines(path, values, density, line, np.concatenate(scans))


def _batches(lines: _Lines) -> Iterator[_Lines]:
    """Yield the lines in batches of about `_AT_ONCE` points, whole lines each, numbered from 0."""
    batch = (np.cumsum(np.bincount(lines.line)) - 1) // _AT_ONCE
    for number in np.unique(batch):
        rows = np.flatnonzero(batch == number)
        points = np.isin(lines.line, rows)
        line = lines.line[points] - rows[0]
        yield lines._replace(values=lines.values[rows], line=line, position=lines.position[points])


def _boundaries_of(
    case: Configuration, lines: _Lines, level: float, options: Mapping[str, Any]
) -> tuple[list[_OfLine], int]:
    """Return what was found on each line, and the number of eigen-solves."""

    def models(line: Array, position: Array) -> LinearModel:
        return models_at(case, {lines.path: lines.values[line], AIRSPEED: position}, options)

    search = Search(models, lines.line, lines.position, level, forgiving=True)
    reasons = [_reason(search, lines, line) for line in range(len(lines.values))]
    if search.scanned.points is None:
        return [_OfLine([], "no airspeed could be analysed", reason) for reason in reasons], 0
    brackets = Brackets(search)
    boundaries = _named(each_once(brackets.close()), models)
    for place, why in brackets.lost.items():
        line = int(brackets.line[place])
        reasons[line] = "; ".join(filter(None, (reasons[line], f"a boundary was lost: {why}")))
    found = []
    for line, reason in enumerate(reasons):
        own = [one for one in boundaries if one.crossing.line == line]
        found.append(_OfLine(own, *_note(search, line, own, level, reason)))
    return found, int(search.solves.sum() + brackets.solves.sum())


def _note(
    search: Search, line: int, own: list[_Found], level: float, reason: str
) -> tuple[str, str, tuple[float, float]]:
    """Return the note on a line, the reason again, and the range that could be analysed."""
    points = search.points
    places = np.flatnonzero(points.line == line)
    if not len(places):
        return "no airspeed could be analysed", reason, (np.nan, np.nan)
    position = points.position[places]
    low, high = float(position.min()), float(position.max())
    first = places[position.argmin()]
    if np.any(points.growth[first] > points.error[first]):
        beyond = f"below {100 * level:g} % of critical" if level else "unstable"
        return f"already {beyond} at the lowest airspeed, {low / KNOT:.4g} {KTAS}", reason, (low, high)
    stable = not any(one.crossing.onset for one in own)
    return f"no mode becomes unstable up to {high / KNOT:.4g} {KTAS}" * stable, reason, (low, high)


def _named(crossings: Sequence[Crossing], models: Any) -> list[_Found]:
    """Return the boundaries of crossings, with what moves in each and what makes it doubtful."""
    if not crossings:
        return []
    lines, positions = np.array([(one.line, one.position) for one in crossings]).T
    model = models(lines.astype(int), positions)
    spectrum = _stacked(crossings)
    every = spectrum.all_modes
    names, kind = moving(model, every.values, every.left, every.right).names, kinds(model, every)
    return [
        _Found(one, str(names[row, one.state]), str(kind[row, one.state]), str(model.trim.warning[row]))
        for row, one in enumerate(crossings)
    ]


def _stacked(crossings: Sequence[Crossing]) -> Spectrum:
    """Return the spectra of crossings as one, a point for each."""
    values, right = (
        np.stack([getattr(one.spectrum, part) for one in crossings]) for part in ("values", "right")
    )
    shapes = [one.spectrum.shapes for one in crossings]
    known = [shape for shape in shapes if shape is not None]
    own = np.stack(known) if len(known) == len(shapes) else None
    return crossings[0].spectrum._replace(values=values, right=right, shapes=own)


def _reason(search: Search, lines: _Lines, line: int) -> str:
    """Return why airspeeds of a line failed, by the first of them; empty where all could be analysed."""
    places = np.flatnonzero((lines.line == line) & ~search.scanned.works)
    if not len(places):
        return ""
    where = f"{len(places)} airspeeds from {lines.position[places[0]] / KNOT:.4g} {KTAS} on"
    return f"{where}: {search.scanned.reason[places[0]]}"


# Branches ------------------------------------------------------------------------------------------------------------


_Branch = dict[int, _Found]  # boundaries by the place of their value


def _branches(lines: list[_OfLine]) -> list[_Branch]:
    """Return boundaries as branches; the branch with the lowest airspeed first."""
    found = [one for line in lines for one in line.boundaries]
    at = [place for place, line in enumerate(lines) for _ in line.boundaries]
    successor: dict[int, int] = {}
    if found:
        spectrum = _stacked([one.crossing for one in found])
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


def _links(found: list[_Found], spectrum: Spectrum, before: list[int], after: list[int]) -> dict[int, int]:
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


def _dataset(lines: _Lines, found: list[_OfLine], free: bool) -> Dataset:
    """Return the dataset of the branches over the values of the input; of a free aircraft, flutter comes first."""
    import xarray  # here, because it takes long to import

    branches = _branches(found)
    shape = len(lines.values), len(branches)
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
    both, per_density = (lines.path, "branch"), np.sqrt(lines.density / SEA_LEVEL_DENSITY)
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
            "first": (lines.path, first, {"units": "m/s", "long_name": "lowest true airspeed of an onset"}),
            "first_branch": (lines.path, first_branch, {"long_name": "branch of the lowest onset"}),
            "note": (lines.path, note, {"long_name": "on the lowest onset"}),
            "reason": (lines.path, reason, {"long_name": "why airspeeds failed"}),
            "searched": (
                (lines.path, "end"),
                np.array([one.searched for one in found]),
                {"units": "m/s", "long_name": "lowest and highest true airspeed that could be analysed"},
            ),
            "density": (lines.path, lines.density, {"units": "kg/m**3", "long_name": "of the air"}),
        },
        coords={lines.path: lines.values, "branch": np.array(labels, dtype=str), "end": ["low", "high"]},
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
