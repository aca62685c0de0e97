"""The elastic blade in a vacuum: its rotating modes, its flexibility, and how it turns under its own bending.

Elements from station to station by `proprotor_equations.blade_element`, with sums over the Gauss points of each.
Motions of a station are displacement and slope in the plane of the disk, positive as lag, then out of it, positive up.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from proprotor_equations import blade_element as element

from proprotor.rotor.blade_stations import BladeStations
from proprotor.rotor.element_chain import assembled
from proprotor.rotor.generated import evaluate
from proprotor.rotor.quadrature import gauss
from proprotor.typing import Array

PER_NODE = 4
_POINTS = 6  # exact for mass, tension and two cubics; the twist within an element needs the rest
_HELD = slice(0, PER_NODE)  # motions of the first station


class RotatingModes(NamedTuple):
    """Modes of a rotating blade: frequency (..., modes) in rad/s, shape (..., motions, modes) of unit modal mass."""

    frequency: Array
    shape: Array


@dataclass(frozen=True, eq=False)
class ElasticBlade:
    """The elements of a blade: properties at the Gauss points (elements, points) of each element."""

    stations: BladeStations

    @functools.cached_property
    def length(self) -> Array:
        """Length of each element (elements, 1), m."""
        return np.asarray(np.diff(self.stations.nodes)[:, None])

    @functools.cached_property
    def place(self) -> Array:
        """Places of the points (points,) in an element, 0 to 1."""
        return (1 + gauss(_POINTS)[0]) / 2

    @functools.cached_property
    def weight(self) -> Array:
        """Weights of the points (elements, points), m."""
        return self.length * gauss(_POINTS)[1] / 2

    @functools.cached_property
    def radius(self) -> Array:
        """Radii of the points (elements, points), m."""
        return np.asarray(self.stations.nodes[:-1, None] + self.length * self.place)

    @functools.cached_property
    def turns(self) -> Array:
        """Which points (elements, points) are outboard of the bearing, and turn with the pitch."""
        return np.asarray(self.radius > self.stations.pitch_bearing)

    @functools.cached_property
    def motion(self) -> Array:
        """Displacements and slopes of the points (elements, points, 4, 8) per motion of the ends of their element."""
        return np.asarray(evaluate(element.motion, self._given))

    @functools.cached_property
    def mass(self) -> Array:
        """Mass (motions, motions) of the whole blade."""
        return self._assembled(evaluate(element.mass, self._given))

    @functools.cached_property
    def _given(self) -> dict[str, Array]:
        """Properties at the points by the names of the derivation."""
        columns = {
            "mass": "mass_per_length",
            "flatwise_stiffness": "flatwise_stiffness",
            "edgewise_stiffness": "edgewise_stiffness",
        }
        given = {f"station_{name}": self.stations.at(of, self.radius) for name, of in columns.items()}
        return given | {"element_length": self.length, "element_position": self.place}

    def _at(self, rotor_speed: ArrayLike, pitch: ArrayLike) -> dict[str, Array]:
        """Return properties at the points (..., elements, points) at rotor speeds and pitches (...)."""
        speed, pitch = (np.asarray(value)[..., None, None] for value in (rotor_speed, pitch))
        angle = np.where(self.turns, pitch + self.stations.angle(self.radius), 0.0)
        return self._given | {
            "rotor_speed": speed,
            "station_angle": angle,
            "station_tension": speed**2 * self._tension,
        }

    @functools.cached_property
    def _tension(self) -> Array:
        """Tension at the points (elements, points) at unit rotor speed."""
        nodes = self.stations.nodes
        mass = self.stations.at("mass_per_length", nodes)
        ends = {
            "inner_radius": nodes[:-1],
            "inner_mass_per_length": mass[:-1],
            "outer_mass_per_length": mass[1:],
            "rotor_speed": 1.0,
        }
        whole = {"element_length": self.length[:, 0], "element_position": 0.0, "outer_tension": 0.0}
        (own,) = evaluate(element.tension, ends | whole)
        outer = np.cumsum(own[::-1])[::-1] - own
        inside = {name: np.asarray(value)[..., None] for name, value in ends.items()}
        inside |= {"element_length": self.length, "element_position": self.place}
        (found,) = evaluate(element.tension, inside | {"outer_tension": outer[:, None]})
        return np.asarray(found)

    def _assembled(self, per_length: Array) -> Array:
        """Return the sum (..., motions, motions) over all points of matrices (..., elements, points, 8, 8)."""
        return assembled(np.einsum("...epij,ep->...eij", per_length, self.weight))

    def stiffness(self, rotor_speed: ArrayLike, pitch: ArrayLike) -> Array:
        """Return the stiffness (..., motions, motions) at rotor speeds (rad/s) and pitches (rad) that broadcast."""
        total = self._assembled(evaluate(element.stiffness, self._at(rotor_speed, pitch)))
        # What carries the first station is straight: on a gimbal it tilts with the first slope, under the same tension.
        within = np.asarray(rotor_speed) ** 2 * self._root_tension * self.stations.radius[0]
        total[..., element.OUT_OF_PLANE_SLOPE, element.OUT_OF_PLANE_SLOPE] += within
        return total

    @functools.cached_property
    def _root_tension(self) -> float:
        """Tension at the first station at unit rotor speed, kg m."""
        mass = self.stations.at("mass_per_length", self.radius)
        return float((mass * self.radius * self.weight).sum())

    def integral(self, motion: int, factor: Array) -> Array:
        """Return the integral (motions,) along the blade of a factor (elements, points) times a motion."""
        of_elements = np.einsum("epj,ep,ep->ej", self.motion[..., motion, :], factor, self.weight)
        total = np.zeros(PER_NODE * len(self.stations.nodes))
        for place, own in enumerate(of_elements):
            total[PER_NODE * place : PER_NODE * (place + 2)] += own
        return total

    def at_points(self, shape: Array, motion: int) -> Array:
        """Return a motion at the points (..., elements, points) of shapes (..., motions) of the stations."""
        ends = self._ends(shape[..., None])[..., 0]
        return np.asarray(np.einsum("epj,...ej->...ep", self.motion[..., motion, :], ends))

    def at_radius(self, shape: Array, motion: int, radius: float) -> Array:
        """Return a motion (...) at a radius, m, of shapes (..., motions) of the stations."""
        nodes = self.stations.nodes
        own = min(int(np.searchsorted(nodes, radius, side="right")) - 1, len(nodes) - 2)
        length = nodes[own + 1] - nodes[own]
        given = {"element_length": length, "element_position": (radius - nodes[own]) / length}
        per_end = evaluate(element.motion, given)[motion]
        return np.asarray(shape[..., PER_NODE * own : PER_NODE * (own + 2)] @ per_end)

    def held(self, hold: str) -> Array:
        """Return the motions of the stations (motions, free) per free motion.

        The first station does not move ("clamped"), or turns about the centre of rotation out of the disk
        ("gimballed").
        """
        size = PER_NODE * len(self.stations.nodes)
        free = np.eye(size)[:, PER_NODE:]
        if hold == "clamped":
            return free
        tilt = np.zeros((size, 1))
        tilt[element.OUT_OF_PLANE] = self.stations.radius[0]
        tilt[element.OUT_OF_PLANE_SLOPE] = 1.0
        return np.concatenate([tilt, free], axis=1)

    def modes(self, rotor_speed: ArrayLike, pitch: ArrayLike, hold: str, count: int) -> RotatingModes:
        """Return the lowest modes in a vacuum.

        Parameters
        ----------
        rotor_speed, pitch : float or array (...)
            rad/s; rad at 0.75 R.
        hold : "clamped" or "gimballed"
            How the first station is held: as in motion that all blades make alike, or as a blade on a free gimbal.
        count : int
            Number of modes.
        """
        free = self.held(hold)
        stiffness = free.T @ self.stiffness(rotor_speed, pitch) @ free
        inverse = np.linalg.inv(np.linalg.cholesky(free.T @ self.mass @ free))
        square, turned = np.linalg.eigh(inverse @ stiffness @ inverse.T)
        shape = free @ (inverse.T @ turned[..., :count])
        return RotatingModes(np.sqrt(np.maximum(square[..., :count], 0.0)), shape)

    def flexibility(self, rotor_speed: ArrayLike, pitch: ArrayLike) -> Array:
        """Return the motions of the clamped blade (..., motions, motions) per unit of loads on them."""
        free = self.held("clamped")
        inverse = np.linalg.inv(free.T @ self.stiffness(rotor_speed, pitch) @ free)
        return np.asarray(free @ inverse @ free.T)

    def deflection(self, pitch: ArrayLike, shape: Array) -> tuple[Array, Array]:
        """Return the mass (..., 2, 2) of two deflections, and the change of their stiffness with pitch.

        Parameters
        ----------
        pitch : array (...)
            rad at 0.75 R.
        shape : array (..., motions, 2)
        """
        turned = self._assembled(self._twist_stiffness(self._at(0.0, pitch)))
        across = np.swapaxes(shape, -1, -2)
        return across @ self.mass @ shape, across @ turned @ shape

    def strain_energy(self, pitch: ArrayLike, shape: Array) -> Array:
        """Return the strain energy (elements, points) of shapes (..., motions, 2), summed over pitches and shapes."""
        per_length = evaluate(element.stiffness, self._at(0.0, pitch))
        ends = self._ends(shape)
        energy = np.einsum("...eia,...epij,...eja->...ep", ends, per_length, ends)
        return np.asarray(energy.reshape(-1, *self.weight.shape).sum(axis=0) * self.weight / 2)

    def _ends(self, shape: Array) -> Array:
        """Return the motions (..., elements, 8, columns) of the ends of each element."""
        return np.stack(
            [shape[..., PER_NODE * p : PER_NODE * (p + 2), :] for p in range(len(self.length))], axis=-3
        )

    def torque_along(self, pitch: ArrayLike, shape: Array) -> Array:
        """Return the change of stiffness with pitch per length (..., 2, 2, elements, points) of two deflections."""
        per_length = self._twist_stiffness(self._at(0.0, pitch))
        ends = self._ends(shape)
        return np.asarray(np.einsum("...eia,...epij,...ejb->...abep", ends, per_length, ends))

    def _twist_stiffness(self, given: dict[str, Array]) -> Array:
        """Return the change of stiffness with pitch per length (..., elements, points, 8, 8)."""
        found = evaluate(element.twist_stiffness, given)
        return np.where(self.turns[..., None, None], found, 0.0)

    def turned_by(self, torque: Array, radius: float) -> tuple[Array, Array]:
        """Return the turn (...) at a radius under a torque per length, and the sum (...) of this torque.

        The control system holds the blade at its pitch bearing; what turns inboard of the bearing turns nothing.
        """
        own = np.where(self.turns, torque * self.weight, 0.0)
        total = own.sum(axis=(-2, -1))
        reach = np.minimum(self.radius, radius)
        turn = total / self.stations.control_stiffness
        return turn + (own * self._flexibility(reach)).sum(axis=(-2, -1)), total

    def _flexibility(self, radius: Array) -> Array:
        """Return the integral of 1/GJ from the pitch bearing to radii, rad/(N m)."""
        start = np.array(max(self.stations.pitch_bearing, self.stations.nodes[0]))
        return self._flexible_to(radius) - self._flexible_to(start)

    def _flexible_to(self, radius: Array) -> Array:
        """Return the integral of 1/GJ from the first station to radii; GJ is linear between stations."""
        nodes = self.stations.nodes
        ends = self.stations.at("torsion_stiffness", nodes)
        place, weight = (1 + gauss(16)[0]) / 2, gauss(16)[1] / 2
        inner = np.clip(np.searchsorted(nodes, radius, side="right") - 1, 0, len(nodes) - 2)
        step, rise = np.diff(nodes), np.diff(ends)
        of_element = (weight / (ends[:-1, None] + rise[:, None] * place)).sum(axis=1) * step
        whole = np.concatenate([[0.0], np.cumsum(of_element)])
        part = np.clip((radius - nodes[inner]) / step[inner], 0.0, 1.0)
        within = ends[inner][..., None] + (rise[inner] * part)[..., None] * place
        return np.asarray(whole[inner] + (weight / within).sum(axis=-1) * part * step[inner])
