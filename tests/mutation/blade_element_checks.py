"""An element of an elastic blade beside its energies as products of rows: Hermite cubics as tabulated."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from tests.mutation.beam_checks import hermite
from tests.mutation.comparison import Check, matrix_check, values_check

_COUNT = 9
_IN, _OUT = (np.array([0, 1, 4, 5]), np.array([2, 3, 6, 7]))  # motions of the ends in and out of the disk
_MODULE = "blade_element"


def checks() -> Iterator[Check]:
    rng = np.random.default_rng(17)
    stations = [
        {
            "element_length": rng.uniform(0.4, 2.5),
            "element_position": rng.uniform(0.1, 0.9),
            "rotor_speed": rng.uniform(0.5, 2.0),
            "station_mass": rng.uniform(0.5, 3.0),
            "station_tension": rng.uniform(0.5, 3.0),
            "station_flatwise_stiffness": rng.uniform(0.5, 3.0),
            "station_edgewise_stiffness": rng.uniform(3.0, 6.0),
            "station_angle": rng.uniform(-1.0, 1.0),
        }
        for _ in range(_COUNT)
    ]
    given = {name: np.array([one[name] for one in stations]) for name in stations[0]}
    told = "Hermite cubics"
    yield matrix_check((_MODULE, "motion"), told, given, np.array([_motion(**one) for one in stations]), 1.0)
    for name, products in (("mass", _mass), ("stiffness", _stiffness), ("twist_stiffness", _twisted)):
        parts = [products(**one) for one in stations]
        expected, sizes = (
            np.array([sum(kind(p) for p in one) for one in parts]) for kind in (_as_is, np.abs)
        )
        yield matrix_check((_MODULE, name), "energies at a station", given, expected, sizes)
    yield _tension(rng)


def _as_is(part: NDArray) -> NDArray:
    return part


def _rows(length: float, place: float) -> tuple[NDArray, ...]:
    """In-plane and out-of-plane displacement, slope and curvature (3, 8) per motion of the ends."""
    cubics = np.array(hermite(length, place))
    both = []
    for places in (_IN, _OUT):
        rows = np.zeros((3, 8))
        rows[:, places] = cubics
        both.append(rows)
    return both[0], both[1]


def _motion(element_length: float, element_position: float, **_: float) -> NDArray:
    inside, out = _rows(element_length, element_position)
    return np.concatenate([inside[:2], out[:2]])


def _mass(element_length: float, element_position: float, station_mass: float, **_: float) -> list[NDArray]:
    return [station_mass * np.outer(own[0], own[0]) for own in _rows(element_length, element_position)]


def _curvatures(length: float, place: float, angle: float) -> tuple[NDArray, NDArray]:
    """Flatwise and edgewise curvature: nose up, the flatwise axis leans against the rotation."""
    inside, out = (rows[2] for rows in _rows(length, place))
    return out * np.cos(angle) + inside * np.sin(angle), inside * np.cos(angle) - out * np.sin(angle)


def _stiffness(
    element_length: float,
    element_position: float,
    rotor_speed: float,
    station_mass: float,
    station_tension: float,
    station_flatwise_stiffness: float,
    station_edgewise_stiffness: float,
    station_angle: float,
) -> list[NDArray]:
    flat, edge = _curvatures(element_length, element_position, station_angle)
    inside, out = _rows(element_length, element_position)
    return [
        station_flatwise_stiffness * np.outer(flat, flat),
        station_edgewise_stiffness * np.outer(edge, edge),
        *(station_tension * np.outer(own[1], own[1]) for own in (inside, out)),
        -station_mass * rotor_speed**2 * np.outer(inside[0], inside[0]),
    ]


def _twisted(
    element_length: float,
    element_position: float,
    station_flatwise_stiffness: float,
    station_edgewise_stiffness: float,
    station_angle: float,
    **_: float,
) -> list[NDArray]:
    """A turn makes flatwise curvature of edgewise, and edgewise of minus flatwise."""
    flat, edge = _curvatures(element_length, element_position, station_angle)
    turned = np.outer(flat, edge) + np.outer(edge, flat)
    return [station_flatwise_stiffness * turned, -station_edgewise_stiffness * turned]


def _tension(rng: np.random.Generator) -> Check:
    """Compare the centrifugal force of what is outboard with a sum over Gauss points."""
    names = ("element_length", "element_position", "inner_radius", "inner_mass_per_length")
    names += ("outer_mass_per_length", "rotor_speed", "outer_tension")
    given = {name: rng.uniform(0.2, 0.9, _COUNT) for name in names}
    points, weights = np.polynomial.legendre.leggauss(4)
    start = given["element_position"][:, None]
    place = start + (1 - start) * (1 + points) / 2
    mass = (1 - place) * given["inner_mass_per_length"][:, None] + place * given["outer_mass_per_length"][
        :, None
    ]
    radius = given["inner_radius"][:, None] + place * given["element_length"][:, None]
    force = (mass * radius * weights).sum(axis=1) * (1 - start[:, 0]) / 2 * given["element_length"]
    expected = given["outer_tension"] + given["rotor_speed"] ** 2 * force
    return values_check((_MODULE, "tension"), "a sum over Gauss points", given, {"station_tension": expected})
