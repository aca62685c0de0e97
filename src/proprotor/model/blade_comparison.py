"""The hinged blade of a rotor beside the elastic blade that it was made from.

Two frequencies can always be met by two springs. So the comparison has the shapes, the loads on the hub and the
couplings with pitch as well, over the whole range of collective.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from proprotor_equations import blade_element as element

from proprotor.model.linear_model import LinearModel
from proprotor.model.rotor_model import rotor_model
from proprotor.rotor.airfoil import Airfoil
from proprotor.rotor.blade_stations import BladeStations
from proprotor.rotor.elastic_blade import ElasticBlade, RotatingModes
from proprotor.rotor.hinged_blade import REFERENCE, HingedBlade, spring_matrix
from proprotor.rotor.operation import Operation
from proprotor.rotor.rotor import Rotor
from proprotor.typing import Array, Numbers

GOOD = 0.05  # largest difference of a judged quantity for which a hinged blade is a good model
_NO_AIR: dict[str, Any] = {"density": 1e-9, "speed_of_sound": 340.0}
_COLLECTIVE = ("flap_0", "lag_0")
_CYCLIC = ("gimbal_1c", "gimbal_1s", "flap_1c", "flap_1s", "lag_1c", "lag_1s")
_PLANES = {"flap": element.OUT_OF_PLANE, "lag": element.IN_PLANE}


class Compared(NamedTuple):
    """One quantity of both blades over the collective range: (p,), SI.

    counts : whether the quantity counts in the judgement.
    scale : what differences are parts of, by default the largest value of the elastic blade.
    """

    name: str
    unit: str
    elastic: Array
    hinged: Array
    counts: bool = True
    scale: float | None = None

    @property
    def difference(self) -> float:
        """Largest difference, as a part of the scale, dimensionless."""
        scale = np.max(np.abs(self.elastic)) if self.scale is None else self.scale
        return float(np.max(np.abs(self.hinged - self.elastic)) / scale) if scale else 0.0


class BladeComparison(NamedTuple):
    """Quantities of the elastic blade and of its hinged blade over collectives (p,), rad at 0.75 R."""

    pitch: Array
    rotor_speed: float
    quantities: tuple[Compared, ...]

    @property
    def poor(self) -> list[Compared]:
        """The quantities for which a hinged blade is no good model of this blade."""
        return [one for one in self.quantities if one.counts and one.difference > GOOD]


def compare_blades(stations: BladeStations, hinged: HingedBlade) -> BladeComparison:
    """Return the hinged blade beside the elastic blade at the rotor speed and pitches of its fit.

    Parameters
    ----------
    stations : BladeStations
    hinged : HingedBlade
        Of `proprotor.rotor.hinged_blade.hinged_blade`, for these stations.
    """
    pitch, speed = hinged.pitch, hinged.rotor_speed
    blade = ElasticBlade(stations)
    clamped, tilting = (blade.modes(speed, pitch, hold, 4) for hold in ("clamped", "gimballed"))
    rotor = in_vacuum(hinged)
    collective, cyclic = hinged_frequencies(rotor, speed, pitch)
    found = [
        Compared("coning frequency", "rad/s", *_in_order(blade, clamped, collective, "flap")),
        Compared("collective lag frequency", "rad/s", *_in_order(blade, clamped, collective, "lag")),
        Compared("cyclic lag frequency", "rad/s", _lag(tilting.frequency, speed), _lag(cyclic, speed)),
        Compared("cyclic flap frequency", "rad/s", tilting.frequency[:, 2], cyclic[:, 2], counts=False),
    ]
    for name in _PLANES:
        found += _shapes(blade, rotor, clamped, name, speed)
    found += _couplings(blade, hinged)
    return BladeComparison(pitch, speed, tuple(found))


def in_vacuum(hinged: HingedBlade) -> Rotor:
    """Return a rotor of hinged blades; without air its number of blades, chord and airfoil have no effect."""
    airfoil = Airfoil(lift_slope=1.0, drag=0.0)
    numbers: dict[str, Any] = dict(hinged.numbers)
    return Rotor(n_blades=3, chord=0.1 * numbers["radius"], airfoil=airfoil, **numbers)


def hinged_frequencies(rotor: Rotor, rotor_speed: Numbers, pitch: Array) -> tuple[Array, Array]:
    """Return frequencies in a vacuum and rotating axes, rad/s: collective (p, 2) and cyclic (p, 3)."""
    run: dict[str, Any] = {"rotor_speed": rotor_speed, "trim": {"collective": pitch}}
    operation = Operation(**run, **_NO_AIR)
    held = {"airloads": "none", "pitch": "rigid", "rotor_speed": "constant"}
    model = rotor_model(rotor, operation, np.ones(np.shape(pitch)), **held)
    alike = model.submodel(_COLLECTIVE)
    square = np.linalg.eigvals(np.linalg.solve(alike.M, alike.K)).real
    return np.sort(np.sqrt(np.maximum(square, 0.0)), axis=-1), _cyclic_frequencies(model.submodel(_CYCLIC))


def _cyclic_frequencies(model: LinearModel) -> Array:
    """Return frequencies (p, 3) in rotating axes of cyclic motions.

    With cosine and sine part as one complex number the roots are iΩ away from those of rotating axes, all to one side.
    """
    mass, damping, stiffness = (
        matrix[..., ::2, ::2] - 1j * matrix[..., ::2, 1::2] for matrix in (model.M, model.C, model.K)
    )
    own = np.broadcast_to(np.eye(mass.shape[-1]), mass.shape)
    forces = np.linalg.solve(mass, np.concatenate([stiffness, damping], axis=-1))
    roots = np.linalg.eigvals(
        np.concatenate([np.concatenate([0 * own, own], axis=-1), -forces], axis=-2)
    ).imag
    return np.asarray(np.sort(np.abs(roots - roots.mean(axis=-1, keepdims=True)), axis=-1)[..., ::2])


def _lag(cyclic: Array, speed: float) -> Array:
    """Return of the first two cyclic frequencies the one (p,) that is not the disk's tilt, once per revolution."""
    away = np.abs(cyclic[:, :2] - speed).argmax(axis=1)
    return np.asarray(np.take_along_axis(cyclic[:, :2], away[:, None], axis=1)[:, 0])


def _place(blade: ElasticBlade, modes: RotatingModes, name: str) -> Array:
    """Return which of the two lowest modes (p,) moves the tip the most in a plane, of its motion in both."""
    at_tip = {plane: np.abs(modes.shape[:, place - 4, :2]) for plane, place in _PLANES.items()}
    flap = np.argmax(at_tip["flap"] / np.hypot(at_tip["flap"], at_tip["lag"]), axis=-1)
    return np.asarray(flap if name == "flap" else 1 - flap)


def _in_order(blade: ElasticBlade, modes: RotatingModes, hinged: Array, name: str) -> tuple[Array, Array]:
    """Return the frequency of flap or lag (p,) of the elastic blade, and that in its place of the hinged blade."""
    place = _place(blade, modes, name)[:, None]
    elastic, own = (np.take_along_axis(found, place, axis=-1)[:, 0] for found in (modes.frequency, hinged))
    return elastic, own


def _shapes(
    blade: ElasticBlade, rotor: Rotor, modes: RotatingModes, name: str, speed: float
) -> list[Compared]:
    """Return the shape at 0.75 R, and shear and moment at the hub, per displacement of the tip."""
    plane = _PLANES[name]
    place = _place(blade, modes, name)
    shape = np.take_along_axis(modes.shape, place[:, None, None], axis=-1)[..., 0]
    along = blade.at_points(shape, plane) / shape[:, plane - 4, None, None]
    square = np.take_along_axis(modes.frequency, place[:, None], axis=-1)[:, 0] ** 2
    mass = blade.stations.at("mass_per_length", blade.radius) * blade.weight
    first, second = (np.einsum("ep,nep->n", weight, along) for weight in (mass, mass * blade.radius))
    arm = blade.stations.tip - getattr(rotor, f"{name}_hinge_offset")
    middle = REFERENCE * blade.stations.tip
    own = (
        max(middle - getattr(rotor, f"{name}_hinge_offset"), 0.0) / arm,
        getattr(rotor, f"{name}_first_moment") / arm,
        getattr(rotor, f"{name}_hub_inertia") / arm,
    )
    force = square + (speed**2 if name == "lag" else 0.0)
    turn = square - (speed**2 if name == "flap" else 0.0)
    points = (
        (f"{name} at 0.75 R, of the tip's", "", _at(blade, shape, plane, middle), own[0] + 0 * square),
        (f"hub shear per {name} of the tip", "N/m", force * first, force * own[1]),
        (f"hub moment per {name} of the tip", "N", turn * second, turn * own[2]),
    )
    return [Compared(*one) for one in points]


def _at(blade: ElasticBlade, shape: Array, plane: int, radius: float) -> Array:
    """Return a displacement (n,) at a radius as a part of the tip's, for shapes (n, motions)."""
    along = blade.at_radius(shape, plane, radius)
    return np.asarray(along / shape[:, plane - 4])


def _couplings(blade: ElasticBlade, hinged: HingedBlade) -> list[Compared]:
    """Return how much flap and lag turn the blade at 0.75 R, per deflection in the trim: K_Pβ and K_Pζ per radian."""
    elastic, numbers = hinged.elastic, hinged.numbers
    torque = blade.torque_along(hinged.pitch, elastic.shape)
    turn, _ = blade.turned_by(torque, REFERENCE * blade.stations.tip)
    _, slope = spring_matrix(numbers, hinged.pitch)
    own = slope / numbers["control_stiffness"]
    names = {
        (0, 0): "K_Pβ per radian of coning",
        (0, 1): "K_Pβ per radian of lag, K_Pζ of coning",
        (1, 1): "K_Pζ per radian of lag",
    }
    # A trim has coning and lag at once: a coupling counts by its size beside the largest of the three.
    largest = float(np.abs(turn).max())
    return [Compared(name, "", turn[:, i, j], own[:, i, j], scale=largest) for (i, j), name in names.items()]
