"""Trim and matrices of rotors in one call of the compiled functions: whole for points without any reservation."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping
from functools import cache
from types import ModuleType
from typing import NamedTuple

import numpy as np

from proprotor.compiled.columns import address, place_of, start_of
from proprotor.compiled.plans import (
    FIRST_POINTS,
    OF_POINTS,
    POWERS,
    Blades,
    Search,
    function_of,
    layouts_of,
    search_of,
)
from proprotor.typing import Array

_AIRSPEED = "airspeed"


class _Limits(ctypes.Structure):
    """What keeps a point from being without reservation, see whole.h."""

    _fields_ = (
        *(
            (name, ctypes.c_double)
            for name in ("angle", "from_air", "induced", "incidence", "mach", "no_spring")
        ),
        ("finds_collective", ctypes.c_int32),
        ("lag_is_free", ctypes.c_int32),
        ("sprung", ctypes.c_ubyte * 4),
    )


class Limits(NamedTuple):
    """What keeps a point from being without reservation.

    angle : of coning, lag and elastic pitch, rad.
    from_air : of the collective from the direction of the air, rad.
    induced : thrust in that of a disk that turns the air by its whole speed.
    incidence, mach : angle of attack, rad, and Mach number of outboard sections.
    no_spring : lag spring in the flap spring that holds nothing.
    finds_collective, lag_is_free : bool
    sprung : tuple of bool
        Which of the free unknowns are those of flap and lag.
    """

    angle: float
    from_air: float
    induced: float
    incidence: float
    mach: float
    no_spring: float
    finds_collective: bool
    lag_is_free: bool
    sprung: tuple[bool, ...]


class InFlight(NamedTuple):
    """Rotors at n points.

    served, trimmed : array (n,)
        Which points have all of this, and which have at least state, before and iterations. All other numbers mean
        nothing.
    state, before : array (4, n)
        Unknowns of the trim, and these before the last step.
    thrust, torque : array (n,)
        Of the rotor.
    iterations : array (n,)
    matrices : dict
        M, C, K and B (n, rows, columns).
    """

    served: Array
    trimmed: Array
    state: Array
    before: Array
    thrust: Array
    torque: Array
    iterations: Array
    matrices: dict[str, Array]


class Rotors:
    """Rotors as the compiled call takes them, prepared once for all airspeeds of a design.

    Parameters
    ----------
    plans : module
    blades : Blades
        Of many designs, or of one without its airspeed.
    stages : two of Search
        From the undeflected blade near the trim, and on to the trim.
    limits : Limits
    shapes : mapping
        Rows and columns of M, C, K and B.
    """

    def __init__(
        self,
        plans: ModuleType,
        blades: Blades,
        stages: tuple[Search, Search],
        limits: Limits,
        shapes: Mapping[str, tuple[int, int]],
    ) -> None:
        self._record, self._kept = blades.record(plans)
        self._blades, self._shapes = blades, shapes
        self._call = function_of(plans, "rotors_in_flight")
        first = FIRST_POINTS + 3 * (len(OF_POINTS) + plans.QUANTITIES.index(_AIRSPEED))
        self._airspeed = slice(first, first + 3)
        near, last = (search_of(plans, stage) for stage in stages)
        own = (near, last, _limits_of(limits), layouts_of(plans))
        self._asked = (*map(ctypes.byref, own), address(_moment_places(plans)))

    def in_flight(self, points: int, airspeed: Array | None = None) -> InFlight:
        """Return trim and matrices at points, with airspeeds (points,) in place of the blades' own if given."""
        record = self._record
        if airspeed is not None:
            record = record.copy()
            record[self._airspeed] = place_of(airspeed[:, None])
        numbers, kinds = np.empty((10, points)), np.empty((2, points), dtype=bool)
        counts = np.empty(points, dtype=np.int64)
        matrices = {name: np.empty((points, *shape)) for name, shape in self._shapes.items()}
        state, before, (thrust, torque), (served, trimmed) = numbers[:4], numbers[4:8], numbers[8:], kinds
        arrays = (state, before, thrust, torque, counts, served, trimmed, *matrices.values())
        places = _PLACES(*map(start_of, arrays))
        self._call(ctypes.c_ssize_t(points), address(record), *self._asked, ctypes.byref(places))
        return InFlight(served, trimmed, state, before, thrust, torque, counts, matrices)


_PLACES = ctypes.c_void_p * 11  # of the results, see whole.h


@cache
def _limits_of(limits: Limits) -> _Limits:
    """Return limits as the library takes them."""
    *numbers, sprung = limits
    return _Limits(*numbers, (ctypes.c_ubyte * 4)(*sprung))


@cache
def _moment_places(plans: ModuleType) -> Array:
    """Return the places of the radial moments of the loads among the quantities, -1 for one that no plan takes."""
    known = {name: place for place, name in enumerate(plans.QUANTITIES)}
    names = [f"{load}_{power}" for load in plans.SECTION_LOADS[:-2] for power in range(POWERS)]
    return np.array([known.get(name, -1) for name in names], dtype=np.int32)
