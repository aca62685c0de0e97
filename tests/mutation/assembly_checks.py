"""A whole rotor put together: blades of the nonlinear rotor, their sum as numbers, engine, shaft and swashplate."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray
from proprotor_equations import BLADE_COORDINATES, FIXED_COORDINATES

from proprotor.rotor.fused import of_segments, plans_of, rotor_matrices
from tests.mutation import one_blade
from tests.mutation.airload_checks import BEYOND_FLAP, BEYOND_LAG, moments
from tests.mutation.comparison import Check, matrix_check, values_check
from tests.mutation.inputs import (
    GENERAL,
    OFFSET,
    PLAIN,
    Quantities,
    blade_quantities,
    natural_sizes,
    points,
    stacked,
)
from tests.mutation.transform import gusts_over_blades, seen_from_blade, summed_over_blades

_SHAFT = 0.4  # rad, like any other
_ADDED = {
    "drive_inertia": 31.0,
    "drive_damping": 7.0,
    "shaft_stiffness": 5e4,
    "cyclic_flap_stiffness_excess": 2.3e3,
    "cyclic_control_stiffness_excess": 900.0,
}
_NAMES = ("mass", "damping", "stiffness")


def checks() -> Iterator[Check]:
    yield _transform()
    yield from _swashplate()
    blade, size = _blade(with_structure=False), _sizes()
    told = "virtual work of the airloads on the nonlinear rotor"
    yield values_check(("rotor", "blade_airloads"), told, _quantities(), blade, size)
    blade = _blade()
    told = "one blade of the nonlinear rotor in the air"
    yield values_check(("rotor", "blade_matrices"), told, _quantities(), blade, size)
    expected, natural = _rotor(blade, size)
    told = "the sum over blades of the nonlinear rotor"
    yield values_check(("rotor", "matrices"), told, _quantities(), expected, natural)
    told = "the sum over the blades"
    yield values_check(("rotor", "fixed_frame"), told, _quantities(), expected, natural, *blade.values())
    yield from _fused(OFFSET, ("segment", "in_vacuum"))
    yield from _fused(GENERAL, ("segment", "in_vacuum"))
    yield from _fused(PLAIN, ("segment", "of_airloads", "in_vacuum"))


def _fused(kind: str, functions: tuple[str, ...]) -> Iterator[Check]:
    """Checks of the plans of a whole rotor: the same rotors in the air, and without airloads."""
    quantities, in_air = _quantities(kind), _rotor(_blade(kind=kind), _sizes(), kind)
    segments = {name: quantities[name] for name in of_segments(plans_of(quantities))}
    in_vacuum = _rotor(_blade(with_air=False, kind=kind), _sizes(), kind)
    told = f"the sum over blades of the nonlinear rotor, {kind}"
    for name in functions:
        given, (here, size) = (None, in_vacuum) if name == "in_vacuum" else (segments, in_air)
        actual = functools.partial(rotor_matrices, quantities, given, len(points()))
        yield Check((f"fused.{kind}", name), told, actual, here, size)


def _transform() -> Check:
    azimuths = np.array([0.0, 0.3, 1.9, 4.1])
    expected = np.array([seen_from_blade(FIXED_COORDINATES, azimuth)[0] for azimuth in azimuths])
    told = "components along a blade's axes, and waves"
    return matrix_check(("coordinates", "transform"), told, {"psi": azimuths}, expected, 1.0)


def _swashplate() -> Iterator[Check]:
    given = {name: blade_quantities()[name] for name in ("control_stiffness", "pitch_damping", "rotor_speed")}
    given["n_blades"] = _n_blades()
    given["cyclic_control_stiffness_excess"] = _ADDED["cyclic_control_stiffness_excess"]
    expected = np.array([_pulled(place, _ADDED) for place in range(len(points()))])
    size = (given["n_blades"] * given["control_stiffness"])[:, None, None]
    told = "springs and dampers between blades and swashplate"
    yield matrix_check(("multiblade", "swashplate_loads"), told, given, expected, size)


def _n_blades() -> NDArray:
    return np.array([point.n_blades for point in points()])


def _pulled(place: int, added: dict[str, float]) -> NDArray:
    """Loads (18, 3) on a rotor: each blade's pitch is pulled towards a + b cos ψ + c sin ψ by spring and damper.

    Where the swashplate tilts, b and c, the spring has another stiffness.
    """
    spring, damper, omega = (
        blade_quantities()[name][place] for name in ("control_stiffness", "pitch_damping", "rotor_speed")
    )
    n_blades = points()[place].n_blades
    loads = np.zeros((len(FIXED_COORDINATES), 3))
    for azimuth in _SHAFT + 2 * np.pi * np.arange(n_blades) / n_blades:
        own = seen_from_blade(FIXED_COORDINATES, azimuth)[0][BLADE_COORDINATES.index("pitch")]
        asked = np.array([1.0, np.cos(azimuth), np.sin(azimuth)])
        rate = omega * np.array([0.0, -np.sin(azimuth), np.cos(azimuth)])
        springs = spring + added["cyclic_control_stiffness_excess"] * np.array([0.0, 1.0, 1.0])
        loads += np.outer(own, springs * asked + damper * rate)
    return loads


@functools.cache
def _quantities(kind: str = OFFSET) -> Quantities:
    """Of the blades (points,) and of their segments (points, segments)."""
    segments = {"beyond_flap_hinge": BEYOND_FLAP, "beyond_lag_hinge": BEYOND_LAG}
    segments |= stacked(map(moments, points(kind)))
    added = {} if kind == PLAIN else _ADDED
    return blade_quantities(kind) | segments | added | {"n_blades": _n_blades()}


def _blade(with_structure: bool = True, with_air: bool = True, kind: str = OFFSET) -> dict[str, NDArray]:
    """Mass, damping, stiffness (points, 12, 12), gust loads (points, 12, 3) of one blade, or of a part alone."""
    parts = [one_blade.air_matrices] * with_air
    if with_structure:
        parts += [one_blade.mass_matrices, one_blade.offset_matrices]
        parts += [one_blade.spring_matrices, one_blade.pitch_matrices]
    sums = [np.sum([part(point) for part in parts], axis=0) for point in points(kind)]
    found = dict(zip(_NAMES, np.moveaxis(np.array(sums), 1, 0), strict=True))
    if not with_structure:
        del found["mass"]
    return found | {"gusts": with_air * np.array([one_blade.gust_columns(point) for point in points(kind)])}


def _sizes() -> dict[str, NDArray]:
    """Natural sizes of the same; a gust is a velocity of the hub."""
    found = dict(zip(_NAMES, natural_sizes(), strict=True))
    return found | {"gusts": found["damping"][..., :3]}


def _rotor(
    blade: dict[str, NDArray], size: dict[str, NDArray], kind: str = OFFSET
) -> tuple[dict[str, Any], dict[str, Any]]:
    """M, C, K, B of the rotors with engine, shaft and cyclic restraint, and the sizes of what is summed."""
    found: dict[str, list[NDArray]] = {name: [] for name in "MCKB"}
    sizes: dict[str, list[NDArray]] = {name: [] for name in "MCKB"}
    added = dict.fromkeys(_ADDED, 0.0) if kind == PLAIN else _ADDED
    for place, point in enumerate(points()):
        of_blade, of_size = ([part[name][place] for name in _NAMES] for part in (blade, size))
        given = (FIXED_COORDINATES, point.n_blades, blade_quantities()["rotor_speed"][place], _SHAFT)
        sums, _ = summed_over_blades(tuple(of_blade), *given)
        _, natural = summed_over_blades(tuple(of_size), *given)
        gusts = gusts_over_blades(blade["gusts"][place], FIXED_COORDINATES, point.n_blades, _SHAFT)
        matrices = [a + b for a, b in zip(sums, _other(point.n_blades, added), strict=True)]
        for name, matrix in zip("MCKB", [*matrices, np.hstack([_pulled(place, added), gusts])], strict=True):
            found[name].append(matrix)
        for name, matrix in zip("MCKB", [*natural, natural[2][:, :6] + natural[1][:, :6]], strict=True):
            sizes[name].append(matrix)
    return {k: np.array(v) for k, v in found.items()}, {k: np.array(v) for k, v in sizes.items()}


def _other(n_blades: int, added: dict[str, float]) -> list[NDArray]:
    """M, C, K of engine and shaft, and of springs that collective motion does not feel."""
    azimuth, turn = (np.array(FIXED_COORDINATES) == name for name in ("azimuth", "alpha_z"))
    mass = added["drive_inertia"] * np.outer(azimuth | turn, azimuth | turn)
    damping = added["drive_damping"] * np.outer(azimuth, azimuth)
    stiffness = added["shaft_stiffness"] * np.outer(azimuth, azimuth)
    for angle, excess in (("flap", "cyclic_flap"), ("pitch", "cyclic_control")):
        cyclic = np.isin(FIXED_COORDINATES, [f"{angle}_1c", f"{angle}_1s"])
        stiffness = stiffness + n_blades / 2 * added[f"{excess}_stiffness_excess"] * np.diag(cyclic)
    return [mass, damping, stiffness]
