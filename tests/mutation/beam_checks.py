"""A beam element beside sums over its Gauss points: of strains of Hermite cubics as tabulated, and of moving masses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from tests.mutation.comparison import Check, matrix_check

_X, _Y, _Z, _ALPHA_X, _ALPHA_Y, _ALPHA_Z = range(6)  # of an end; those of the outer end follow
_COUNT = 7  # elements
_MASSES = 4  # of a section
_RIGIDITIES = ("beam_stiffness", "chord_stiffness", "torsion_stiffness", "axial_stiffness")


def checks() -> Iterator[Check]:
    rng = np.random.default_rng(11)
    length = rng.uniform(0.4, 2.5, _COUNT)
    yield from _motions(length, rng.uniform(0.1, 0.9, _COUNT))
    for name in _RIGIDITIES:
        yield _stiffness(name, length, rng.uniform(0.5, 3.0, (2, _COUNT)))
    yield _mass(length, rng)


def _motions(length: NDArray, place: NDArray) -> Iterator[Check]:
    expected = np.array([_section(own, at) for own, at in zip(length, place, strict=True)])
    given = {"element_length": length, "element_position": place}
    yield matrix_check(("beam", "motion"), "Hermite cubics and straight lines", given, expected, 1.0)


def hermite(length: float, place: float) -> tuple[NDArray, NDArray, NDArray]:
    """Value, slope and curvature of the cubics of unit displacement and unit slope at the inner and the outer end."""
    x, ell = place, length
    value = [1 - 3 * x**2 + 2 * x**3, ell * (x - 2 * x**2 + x**3), 3 * x**2 - 2 * x**3, ell * (x**3 - x**2)]
    slope = [6 * (x**2 - x) / ell, 1 - 4 * x + 3 * x**2, 6 * (x - x**2) / ell, 3 * x**2 - 2 * x]
    curvature = [(12 * x - 6) / ell**2, (6 * x - 4) / ell, (6 - 12 * x) / ell**2, (6 * x - 2) / ell]
    return np.array(value), np.array(slope), np.array(curvature)


# Where the four cubics stand among the motions of the ends: up with the slope -alpha_z, forward with alpha_x.
_UP = (np.array([_X, _ALPHA_Z, _X + 6, _ALPHA_Z + 6]), np.array([1, -1, 1, -1]))
_FORWARD = (np.array([_Z, _ALPHA_X, _Z + 6, _ALPHA_X + 6]), np.ones(4))


def _row(places: tuple[NDArray, NDArray], values: NDArray) -> NDArray:
    row = np.zeros(12)
    row[places[0]] = places[1] * values
    return row


def _line(axis: int, inner: float, outer: float) -> NDArray:
    row = np.zeros(12)
    row[[axis, axis + 6]] = inner, outer
    return row


def _section(length: float, place: float) -> NDArray:
    """Motion (6, 12) of a section."""
    value, slope, _ = hermite(length, place)
    return np.array(
        [
            _row(_UP, value),
            _line(_Y, 1 - place, place),
            _row(_FORWARD, value),
            _row(_FORWARD, slope),
            _line(_ALPHA_Y, 1 - place, place),
            -_row(_UP, slope),
        ]
    )


def _strain(name: str, length: float, place: float) -> NDArray:
    """Strain (12,) that a stiffness resists."""
    _, _, curvature = hermite(length, place)
    return {
        "beam_stiffness": _row(_UP, curvature),
        "chord_stiffness": _row(_FORWARD, curvature),
        "torsion_stiffness": _line(_ALPHA_Y, -1 / length, 1 / length),
        "axial_stiffness": _line(_Y, -1 / length, 1 / length),
    }[name]


def _gauss() -> Iterator[tuple[float, float]]:
    """Places and weights from 0 to 1, exact for a linear property times two cubics."""
    points, weights = np.polynomial.legendre.leggauss(5)
    yield from zip((1 + points) / 2, weights / 2, strict=True)


def _stiffness(name: str, length: NDArray, ends: NDArray) -> Check:
    expected, sizes = np.zeros((2, _COUNT, 12, 12))
    for element, (own, inner, outer) in enumerate(zip(length, *ends, strict=True)):
        for place, weight in _gauss():
            strain = _strain(name, own, place)
            energy = weight * own * ((1 - place) * inner + place * outer) * np.outer(strain, strain)
            expected[element] += energy
            sizes[element] += np.abs(energy)
    given = {"element_length": length, f"inner_{name}": ends[0], f"outer_{name}": ends[1]}
    return matrix_check(("beam", name), "strain energy at Gauss points", given, expected, sizes)


def _mass(length: NDArray, rng: np.random.Generator) -> Check:
    """Point masses at both ends of each element, in proportion to their distance from the other end, twist apart."""
    masses = rng.uniform(0.5, 3.0, (2, _MASSES, _COUNT))
    up, forward = rng.uniform(-0.4, 0.4, (2, 2, _MASSES, _COUNT))
    twist = rng.uniform(0.5, 3.0, (2, _COUNT))
    expected, sizes = np.zeros((2, _COUNT, 12, 12))
    for element, own in enumerate(length):
        for place, weight in _gauss():
            motion = _section(own, place)
            for end, share in enumerate((1 - place, place)):
                placed = zip(
                    masses[end, :, element], up[end, :, element], forward[end, :, element], strict=True
                )
                energies = [mass * _of_point(motion, x, z) for mass, x, z in placed]
                turn = twist[end, element] * np.outer(motion[_ALPHA_Y], motion[_ALPHA_Y])
                expected[element] += weight * own * share * (sum(energies) + turn)
                sizes[element] += weight * own * share * (np.abs(energies).sum(axis=0) + np.abs(turn))
    given = {"element_length": length} | _moments(masses, up, forward, twist)
    return matrix_check(
        ("beam", "mass"), "point masses that move with their sections", given, expected, sizes
    )


def _of_point(motion: NDArray, up: float, forward: float) -> NDArray:
    """Mass (12, 12) of a unit mass beside the axis; what twist alone does to it belongs to the polar inertia."""
    at_mass = np.eye(3, 6)
    at_mass[:, 3:] = [[0, forward, 0], [-forward, 0, up], [0, -up, 0]]  # rotation x (up, 0, forward)
    velocity = at_mass @ motion
    twist = np.outer(motion[_ALPHA_Y], motion[_ALPHA_Y]) * (up**2 + forward**2)
    return velocity.T @ velocity - twist


def _moments(masses: NDArray, up: NDArray, forward: NDArray, twist: NDArray) -> Mapping[str, NDArray]:
    """By the names of the derivation."""
    ends = {
        "mass_per_length": masses.sum(axis=1),
        "first_moment_up": (masses * up).sum(axis=1),
        "first_moment_forward": (masses * forward).sum(axis=1),
        "second_moment_up": (masses * up**2).sum(axis=1),
        "product_of_inertia": (masses * up * forward).sum(axis=1),
        "second_moment_forward": (masses * forward**2).sum(axis=1),
        "twist_inertia": twist,
    }
    return {
        f"{end}_{name}": values[place]
        for place, end in enumerate(("inner", "outer"))
        for name, values in ends.items()
    }
