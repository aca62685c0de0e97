"""Transfer of inputs to outputs at a frequency, and names and units of both.

C (iω - A)⁻¹ B + D for batches of state spaces, of which points may lack states.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from proprotor.errors import InputError, check_known
from proprotor.model.linear_model import INPUTS, SWASHPLATE, LinearModel
from proprotor.model.state_space import LOADS, StateSpace
from proprotor.rotor.motions import HUB, half_of, is_inflow, is_lift
from proprotor.stability.root_error import roots
from proprotor.typing import Array
from proprotor.units import values_in_si

_PER = {" rate": "/s", " acceleration": "/s**2"}  # by the end of an output's name
_GUSTS = tuple(name for name in INPUTS if name not in SWASHPLATE)
_BLOCK = 4096  # matrices solved at once


def frequencies_in_si(frequency: Any) -> Array:
    """Return frequencies (k,) in rad/s; raise an error for one that is negative or not finite."""
    omega = values_in_si(frequency, "rad/s", "frequency").reshape(-1)
    wrong = ~(np.isfinite(omega) & (omega >= 0))
    if wrong.any():
        raise InputError("frequency", omega[wrong][0], "must be finite and not negative")
    return omega


def places_of(wanted: Sequence[str] | None, known: tuple[str, ...], what: str) -> list[int]:
    """Return the places of wanted names among known names; of all names where none is wanted."""
    names = known if wanted is None else (wanted,) if isinstance(wanted, str) else tuple(wanted)
    for name in names:
        check_known(what, name, known, what.removesuffix("s"))
    return [known.index(name) for name in names]


class System(NamedTuple):
    """ẋ = A x + B u, y = C x + D u."""

    A: Array
    B: Array
    C: Array
    D: Array


def system_at(space: StateSpace, point: tuple[int, ...]) -> System:
    """Return one point of a batch, with the states that the point has."""
    leading = space.A.shape[:-2]
    whole = (space.A, space.B, space.C, space.D)
    a, b, c, d = (np.broadcast_to(m, (*leading, *m.shape[-2:]))[point] for m in whole)
    own = np.isfinite(np.diagonal(a))
    return System(a[np.ix_(own, own)], b[own], c[:, own], d)


def transfer(space: StateSpace | System, omega: Array, rows: list[int], columns: list[int]) -> Array:
    """Return C (iω - A)⁻¹ B + D (..., frequencies, rows, columns)."""
    leading = space.A.shape[:-2]
    count = int(np.prod(leading, dtype=int))
    whole = space.A, space.B[..., columns], space.C[..., rows, :], space.D[..., rows, :][..., columns]
    a, b, c, d = (np.broadcast_to(m, (*leading, *m.shape[-2:])).reshape(count, *m.shape[-2:]) for m in whole)
    found = np.full((count, len(omega), len(rows), len(columns)), complex(np.nan, np.nan))
    for points, own in _alike(a):
        parts = a[points][:, own][:, :, own], b[points][:, own], c[points][:, :, own], d[points]
        found[points] = _of_alike(*parts, omega)
    return found.reshape(*leading, *found.shape[1:])


def _of_alike(a: Array, b: Array, c: Array, d: Array, omega: Array) -> Array:
    """Return C (iω - A)⁻¹ B + D (points, frequencies, rows, columns) of points with the same states."""
    found = np.empty((len(a), len(omega), *d.shape[1:]), dtype=complex)
    step = max(1, _BLOCK // max(len(a), 1))
    for start in range(0, len(omega), step):
        at = slice(start, start + step)
        turning = 1j * omega[at, None, None] * np.eye(a.shape[-1])
        found[:, at] = c[:, None] @ _solved(turning - a[:, None], b[:, None]) + d[:, None]
    return found


def _alike(systems: Array) -> Iterator[tuple[Array, Array]]:
    """Yield points (k,) of matrices (points, states, states) with the same states, and the states; no failed points."""
    present = np.isfinite(np.diagonal(systems, axis1=-2, axis2=-1))
    kinds, kind = np.unique(present, axis=0, return_inverse=True)
    for place, states in enumerate(kinds):
        points = np.flatnonzero(kind.reshape(-1) == place)
        own = np.flatnonzero(states)
        if not len(own):
            continue
        works = np.isfinite(systems[points][:, own][:, :, own]).all(axis=(-2, -1))
        yield points[works], own


def _solved(matrices: Array, loads: Array) -> Array:
    """Return solutions (points, frequencies, states, columns); NaN where a matrix is singular."""
    loads = np.broadcast_to(loads, (*matrices.shape[:-1], loads.shape[-1]))
    try:
        return np.linalg.solve(matrices, loads)
    except np.linalg.LinAlgError:  # one of them, at least, is singular
        solutions = np.full(loads.shape, np.nan, dtype=complex)
        for place in np.ndindex(matrices.shape[:-2]):
            try:
                solutions[place] = np.linalg.solve(matrices[place], loads[place])
            except np.linalg.LinAlgError:
                continue
        return solutions


def decays_everywhere(model: LinearModel) -> NDArray[np.bool_]:
    """Return at which points (...) every root decays, by more than its error."""
    values, error = roots(model)
    decays = (values.real < -error) | np.isnan(values)  # a state that a point does not have
    return np.asarray(decays.all(axis=-1) & np.isfinite(values).any(axis=-1))


def unit_of_input(name: str) -> str:
    """Return the SI unit of an input by its name."""
    return "m/s" if half_of(name)[1] in _GUSTS else "rad"


def unit_of_output(output: str) -> str:
    """Return the SI unit of an output by its name."""
    name = half_of(output)[1]
    if name in LOADS:
        return "N" if name.startswith("force") else "N*m"
    per = next((unit for ending, unit in _PER.items() if name.endswith(ending)), "")
    motion = name.removesuffix(" rate")
    length = name.split(" ")[0] in HUB[:3] or is_lift(motion) or is_inflow(motion)
    return ("m" if length else "rad") + per
