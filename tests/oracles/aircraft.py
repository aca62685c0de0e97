"""Half of a free aircraft, from textbook frame elements and the numbers of a deck.

Everything about the structure is written down here anew: the stiffness and mass matrices of a frame element, the chain
from the plane of symmetry to the nacelle, the springs of the nacelle, what the fuselage holds, the fuselage itself, and
the aircraft's modes. The modes are those of the whole eigenvalue problem, whose first three roots are the zeros of
rigid motion; the package never solves it. Nothing is imported from the package.

Axes: I up, J outboard to the right, K forward; a motion is three displacements, then three rotations.
"""

from collections.abc import Mapping
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import scipy.linalg

UP, OUTBOARD, FORWARD, ABOUT_UP, ABOUT_OUTBOARD, ABOUT_FORWARD = range(6)
FREE_AXES = {  # motions of the plane of symmetry
    "symmetric": (UP, FORWARD, ABOUT_OUTBOARD),
    "antisymmetric": (OUTBOARD, ABOUT_FORWARD, ABOUT_UP),
}
SLOPES = {"bending_slope": ABOUT_FORWARD, "chord_slope": ABOUT_UP, "twist": ABOUT_OUTBOARD}


class HalfAircraft(NamedTuple):
    """Rigid motions and lowest elastic modes of half an aircraft.

    frequency : array (k,)
        Of the elastic modes with the rotor's mass at the hub, rad/s.
    mass : array (3 + k, 3 + k)
        Without that mass. With it the modes have unit mass, and do not couple with the rigid motions.
    hub : array (6, 3 + k)
        Motion of the right hub per unit of each coordinate.
    zeros : array (3,)
        The roots ω² of rigid motion as computed, (rad/s)²; rounding errors.
    """

    frequency: np.ndarray
    mass: np.ndarray
    hub: np.ndarray
    zeros: np.ndarray


def frame_element(length, stiffness, mass_per_length, inertia_per_length):
    """Return stiffness and consistent mass (12, 12) of a straight beam along its first axis.

    The order at each end is three displacements, then three rotations. `stiffness` is (EA, GJ, EI of bending along the
    second axis, EI of bending along the third).
    """
    axial, torsion, second, third = stiffness
    bar, flat = np.array([[1, -1], [-1, 1]]), np.array([[2, 1], [1, 2]]) / 6
    one, two = length, length**2
    bending = np.array(
        [
            [12, 6 * one, -12, 6 * one],
            [6 * one, 4 * two, -6 * one, 2 * two],
            [-12, -6 * one, 12, -6 * one],
            [6 * one, 2 * two, -6 * one, 4 * two],
        ]
    )
    sway = np.array(
        [
            [156, 22 * one, 54, -13 * one],
            [22 * one, 4 * two, 13 * one, -3 * two],
            [54, 13 * one, 156, -22 * one],
            [-13 * one, -3 * two, -22 * one, 4 * two],
        ]
    )
    other_way = np.diag(
        [1, -1, 1, -1]
    )  # a displacement along the third axis goes with a turn against the second
    parts = (
        ((0, 6), axial / length * bar, mass_per_length * length * flat),
        ((3, 9), torsion / length * bar, inertia_per_length * length * flat),
        ((1, 5, 7, 11), second / length**3 * bending, mass_per_length * length / 420 * sway),
        (
            (2, 4, 8, 10),
            third / length**3 * other_way @ bending @ other_way,
            mass_per_length * length / 420 * other_way @ sway @ other_way,
        ),
    )
    K, M = np.zeros((12, 12)), np.zeros((12, 12))
    for places, k, m in parts:
        K[np.ix_(places, places)] += k
        M[np.ix_(places, places)] += m
    return K, M


def turned_element(start, end, deck):
    """Return the matrices of the element between two points, in the axes of the aircraft."""
    along = (end - start) / np.linalg.norm(end - start)
    upward = np.eye(3)[UP] - along[UP] * along
    upward /= np.linalg.norm(upward)
    turn = np.kron(np.eye(4), [along, upward, np.cross(along, upward)])
    stiffness = [deck[f"support.{name}_stiffness"] for name in ("axial", "torsion", "beam", "chord")]
    inertia = deck["support.torsional_inertia_per_length"]
    matrices = frame_element(np.linalg.norm(end - start), stiffness, deck["support.mass_per_length"], inertia)
    return (turn.T @ matrix @ turn for matrix in matrices)


def carried(offset):
    """Return the motion of a point of a rigid body per motion of the body at another point, an offset away."""
    up, outboard, forward = offset
    motion = np.eye(6)
    motion[:3, 3:] = [[0, forward, -outboard], [-forward, 0, up], [outboard, -up, 0]]  # rotation × offset
    return motion


def half_aircraft(
    deck: Mapping[str, float],
    symmetry: str,
    *,
    downstop: str = "on",
    held: tuple[str, ...] = ("twist",),
    fuselage_alone: bool = False,
    modes: int = 6,
) -> HalfAircraft:
    """Return half an aircraft in motions of one symmetry.

    Parameters
    ----------
    deck : mapping of str to float
        Numbers of a deck of kind "aircraft" by their paths, SI.
    symmetry : "symmetric" or "antisymmetric"
    downstop : "on" or "off"
    held : tuple of str
        Rotations of the wing at its side that the fuselage holds; the others are free.
    fuselage_alone : bool
        Whether the deck's fuselage is that without wings, nacelles and rotors.
    modes : int
    """
    points = _points(deck)
    count = 6 * len(points)
    centre = np.array([deck["support.fuselage.centre_up"], 0.0, deck["support.fuselage.centre_forward"]])
    # Coordinates: the fuselage at its centre of mass, each node relative to the fuselage, pitch and yaw of the nacelle.
    size = 6 + count + 2
    nodes = np.concatenate(
        [np.concatenate([carried(point - centre) for point in points]), np.eye(count), np.zeros((count, 2))],
        axis=1,
    )
    M, K = np.zeros((size, size)), np.zeros((size, size))
    for place, (start, end) in enumerate(pairwise(points)):
        k, m = turned_element(start, end, deck)
        ends = slice(6 * place, 6 * place + 12)
        K[6:-2, 6:-2][ends, ends] += k
        M += nodes[ends].T @ m @ nodes[ends]
    nacelle = nodes[-6:].copy()
    nacelle[ABOUT_OUTBOARD, -2] = nacelle[ABOUT_UP, -1] = 1.0
    K[-2, -2] += deck[f"support.downstop_stiffness_{downstop}"]
    K[-1, -1] += deck[f"support.spindle_yaw_stiffness_{downstop}"]
    inertias = [deck[f"support.nacelle_{axis}_inertia"] for axis in ("yaw", "pitch", "roll")]
    M += nacelle.T @ np.diag([*3 * [deck["support.nacelle_mass"]], *inertias]) @ nacelle
    hub = carried([0.0, 0.0, deck["support.mast_length"]]) @ nacelle
    at_hub = hub[:3].T @ hub[:3]
    M += deck["support.hub_mass"] * at_hub
    M[:6, :6] += _half_fuselage(deck, M + deck["support.rotor_mass"] * at_hub, fuselage_alone)
    kept = _kept(len(points), symmetry, held)
    M, K, at_hub, hub = M[np.ix_(kept, kept)], K[np.ix_(kept, kept)], at_hub[np.ix_(kept, kept)], hub[:, kept]
    square, shapes = scipy.linalg.eigh(K, M + deck["support.rotor_mass"] * at_hub)
    shapes = shapes[:, : 3 + modes]
    shapes[:, :3] = np.eye(len(kept))[:, :3]
    return HalfAircraft(np.sqrt(square[3 : 3 + modes]), shapes.T @ M @ shapes, hub @ shapes, square[:3])


def _points(deck):
    """Return the nodes, from the plane of symmetry to the wing tip."""
    side = deck["support.carry_through.half_width"] * np.eye(3)[OUTBOARD]
    slopes = np.array([np.tan(deck["support.dihedral"]), 1.0, -np.tan(deck["support.sweep"])])
    tip = side + deck["support.span"] * slopes
    outer = np.linspace(0, 1, int(deck["support.elements"]) + 1)[1:, None]
    return np.concatenate([np.linspace(0, 1, 3)[:, None] * side, side + outer * (tip - side)])


def _half_fuselage(deck, of_others, alone):
    """Return half of the fuselage's mass (6, 6), which with the others' makes half of the aircraft."""
    inertias = [deck[f"support.fuselage.{axis}_inertia"] for axis in ("yaw", "pitch", "roll")]
    body = np.diag([*3 * [deck["support.fuselage.mass"]], *inertias]) / 2
    if alone:
        return body
    of_both_sides = of_others[
        :6, :6
    ].copy()  # the other side is a mirror image, and cancels what couples the symmetries
    symmetric, antisymmetric = FREE_AXES.values()
    of_both_sides[np.ix_(symmetric, antisymmetric)] = of_both_sides[np.ix_(antisymmetric, symmetric)] = 0.0
    return body - of_both_sides


def _kept(count, symmetry, held):
    """Return the coordinates that one symmetry and the fuselage leave free."""
    free = FREE_AXES[symmetry]
    slopes = tuple(axis for name, axis in SLOPES.items() if name not in held)
    at = {0: free, 2: slopes} | {place: range(6) for place in (1, *range(3, count))}
    of_nodes = [6 + 6 * place + axis for place in sorted(at) for axis in sorted(at[place])]
    return [*free, *of_nodes, 6 + 6 * count, 7 + 6 * count]


def with_rotor(half: HalfAircraft, rotor, damping_ratio: float):
    """Return M, C and K (..., n, n) of half an aircraft with one rotor.

    Parameters
    ----------
    half : HalfAircraft
    rotor : object
        With matrices M, C and K (..., m, m) of a rotor alone, whose first six coordinates are the motion of the hub.
    damping_ratio : float
        Structural damping of all elastic modes as a fraction of critical.
    """
    stiffness, damping = np.zeros_like(half.mass), np.zeros_like(half.mass)
    elastic = np.arange(3, len(half.mass))
    stiffness[elastic, elastic] = half.frequency**2
    damping[elastic, elastic] = 2 * damping_ratio * half.frequency
    size, own = len(half.mass), rotor.M.shape[-1] - 6
    motion = np.zeros((6 + own, size + own))
    motion[:6, :size], motion[6:, size:] = half.hub, np.eye(own)
    found = []
    for matrix, added in ((rotor.M, half.mass), (rotor.C, damping), (rotor.K, stiffness)):
        coupled = motion.T @ matrix @ motion
        coupled[..., :size, :size] += added
        found.append(coupled)
    return tuple(found)


def roots(M, C, K):
    """Return the roots (..., 2n) of M q̈ + C q̇ + K q = 0."""
    size = M.shape[-1]
    state = np.zeros((*M.shape[:-2], 2 * size, 2 * size))
    state[..., :size, size:] = np.eye(size)
    state[..., size:, :size], state[..., size:, size:] = -np.linalg.solve(M, K), -np.linalg.solve(M, C)
    return np.linalg.eigvals(state)
