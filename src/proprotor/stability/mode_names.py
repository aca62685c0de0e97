"""Names of modes: what moves in a mode at a point, by participation and by the way cyclic motion whirls.

A model has as many names as modes: one for each coordinate of the support, for coning and the collective motion of each
other blade angle, for the rotor speed, and two for the cyclic motion of each blade angle and of the gimbal, regressive
and progressive. At each point the modes get their names by the assignment with the largest sum of participations, one
name to one mode. The halves of the motion of an aircraft that do not couple have assignments of their own. The names
depend on the eigenvalues and vectors of the point alone, and on no other point. Where two branches veer and exchange
their motions, the names pass from one branch to the other in the middle: where the sum of participations is the same
for either assignment. Which branch is which is another question, answered by following roots:
`proprotor.stability.branches`.

The share that a mode has in its own name says how much the name is worth: near 1 nothing else moves, below one third
something else may move more.

A cyclic motion alone has two modes. In the rotating frame they have one frequency ν and run round the rotor forwards,
progressive, or backwards, regressive; in the fixed frame they appear at ν + 1 and at |ν - 1| per revolution. The
progressive mode whirls with the rotor in the fixed frame; the regressive mode against the rotor for ν > 1, and with the
rotor, but slower than the blades, for ν < 1. A mode of the whole system is progressive by the participation of the
progressive mode, and regressive by that of the regressive mode: motion and rate of β_1c + i β_1s are the sum of both.
How a mode whirls in the fixed frame is another number, `whirl`. In the fixed frame β_1c + i β_1s is what whirls with
the rotor and β_1c - i β_1s what whirls against it, for s = iω, ω > 0 and an azimuth that grows with rotation (β = β_1c
cos ψ + β_1s sin ψ).
"""

from __future__ import annotations

from itertools import combinations
from typing import NamedTuple

import numpy as np

from proprotor.model.first_order import blocks, held_coordinates, some_points
from proprotor.model.linear_model import LinearModel
from proprotor.rotor.motions import HUB, Motion, motions, name_list
from proprotor.stability.assignment import best_assignment
from proprotor.stability.matching import Modes
from proprotor.stability.modes import coordinate_motion
from proprotor.typing import Array

DOUBTFUL = 1 / 3  # a share below which two other motions may each move more
_TIE = 1e-6  # of a share: what parts names that fit equally well, above the rounding of vectors
_STILL = 1e-6  # participation of cyclic motion below which the way it whirls is rounding


class Moving(NamedTuple):
    """What moves in the modes of points.

    Attributes
    ----------
    known : list of str
        The names of the model, in the order of its coordinates.
    place : array (..., states) of int
        The name of each state, by its place in `known`; -1 at failed points. Both states of a pair have one name; a
        name that two real roots have stands twice.
    shares : array (..., names, states)
        Participation of each name's motion in each state, 0 to 1; NaN at failed points.
    """

    known: list[str]
    place: Array
    shares: Array

    @property
    def names(self) -> Array:
        """The name of each state (..., states), as text; empty at failed points."""
        return np.array([*self.known, ""], dtype=object)[self.place]

    @property
    def share(self) -> Array:
        """Participation (..., states) of the motion that each state is named after, 0 to 1."""
        rows = np.maximum(self.place, 0)[..., None, :]
        share: Array = np.take_along_axis(self.shares, rows, -2)[..., 0, :]
        return share


def moving(model: LinearModel, values: Array, left: Array, right: Array) -> Moving:
    """Return what moves in each mode of each point: a function of the point alone.

    Parameters
    ----------
    model : LinearModel
        Its points (...) are the points of the eigenvalues.
    values : array (..., states)
        All eigenvalues, rad/s, each pair side by side.
    left, right : array (..., states, states)
        Left vectors in rows, right ones in columns, left @ right = 1, as from
        `proprotor.stability.matching.Spectrum.all_modes`.
    """
    known = name_list(model.dofs)
    place, exists = np.full(values.shape, -1), np.isfinite(values)
    good = np.asarray(exists.any(axis=-1))
    # A state that a point does not have, though others do, stands as a root at zero while names are given.
    roots = np.where(exists, values, 0)
    if good.all():  # the usual case, without copies
        shares = _name_shares(model, left, right)
    else:
        shares = np.full((*values.shape[:-1], len(known), values.shape[-1]), np.nan)
        shares[good] = _name_shares(some_points(model, good), left[good], right[good])
    held = held_coordinates(model, values.shape[-1])
    for own, (_, columns) in zip(model.blocks, blocks(model, held), strict=True):
        dofs = tuple(model.dofs[one] for one in own)
        names = np.array([known.index(name) for name in name_list(dofs)])
        moved = [dofs.index(model.dofs[one]) for one in held if one in own]
        best = _assign_names(dofs, moved, shares[good][:, names, columns], roots[good][:, columns])
        place[good, columns] = names[best]
    return Moving(known, place, shares)


def _whirl_shares(motion: Motion, held: list[int], left: Array, right: Array) -> Array:
    """Return the participation of whirl against and with the rotor in each state (2, ..., states).

    Parameters
    ----------
    motion : Motion
        A cyclic one.
    held : list of int
        Coordinates whose displacement is a state.
    left, right : array (..., states, states)
        Left vectors in rows, right ones in columns.
    """
    shares = np.zeros(())
    for cosine, sine in zip(*(_states(place, held) for place in motion.places), strict=True):
        c, s = right[..., cosine, :], right[..., sine, :]
        lc, ls = left[..., :, cosine], left[..., :, sine]
        against, with_rotor = (c - 1j * s) * (lc + 1j * ls), (c + 1j * s) * (lc - 1j * ls)
        shares = shares + np.abs([against, with_rotor]) / 2
    return shares


def _states(place: int, held: list[int]) -> list[int]:
    """Return the places of the states of a coordinate: its displacement, where this is a state, and its rate."""
    rate = len(held) + place
    return [held.index(place), rate] if place in held else [rate]


def whirl(model: LinearModel, modes: Modes) -> Array:
    """Return the sense of whirl in the fixed frame (..., modes): 1 with the rotor, -1 against the rotor.

    The cyclic motion of blades and gimbal counts, by participation. In a mode without cyclic motion, as in all modes of
    a propeller on a pivot, the motion of the shaft's axis counts, and where the axis does not tilt, that of the hub's
    centre. NaN for real roots, and where nothing goes round.
    """
    values, right, left = modes
    held = held_coordinates(model, right.shape[-2])
    shares = np.zeros((2, *values.shape))
    for motion in motions(model.dofs):
        if len(motion.places) == 2:
            shares = shares + _whirl_shares(motion, held, left, right)
    shares = np.where(shares.sum(axis=0) < _STILL, _hub_whirl(model, values, right), shares)
    against, with_rotor = shares
    total = against + with_rotor
    turned = np.where(values.imag < 0, -1.0, 1.0) * (with_rotor - against)
    return np.where((total > 0) & (values.imag != 0), turned / np.where(total > 0, total, 1), np.nan)


def _hub_whirl(model: LinearModel, values: Array, right: Array) -> Array:
    """Return the squares of motion against and with the rotor (2, ..., modes) of the shaft's axis, or of the hub."""
    n = len(model.dofs)
    shape = np.nan_to_num(coordinate_motion(held_coordinates(model, right.shape[-2]), n, values, right))
    if model.hub is not None:
        moved = np.asarray(model.hub) @ shape
    else:
        moved = np.zeros((*shape.shape[:-2], len(HUB), shape.shape[-1]), dtype=complex)
        for axis, name in enumerate(HUB):
            if name in model.dofs:
                moved[..., axis, :] = shape[..., model.dofs.index(name), :]
    x, y, _, about_x, about_y, _ = np.moveaxis(moved, -2, 0)
    # The axis k leans by α × k = (α_y, -α_x); x leads y by a quarter where a point goes round with the rotor.
    tilt, way = (np.abs([a - 1j * b, a + 1j * b]) ** 2 for a, b in ((about_y, -about_x), (x, y)))
    return np.where(tilt.sum(axis=0) > 0, tilt, way)


def _name_shares(model: LinearModel, left: Array, right: Array) -> Array:
    """Return the share of each name in each state (..., names, states); it sums to 1 over the names.

    Parameters
    ----------
    model : LinearModel
        With leading axes (...) that broadcast to those of the vectors.
    left, right : array (..., states, states)
        Left vectors in rows, right ones in columns.
    """
    held, columns = held_coordinates(model, right.shape[-2]), []
    for motion in motions(model.dofs):
        if len(motion.places) == 1:
            places = _states(motion.places[0], held)
            columns.append(sum(np.abs(left[..., place] * right[..., place, :]) for place in places))
            continue
        whole = _whirl_shares(motion, held, left, right).sum(axis=0)
        progressive = _progressive_part(model, motion, held, left, right)
        columns += [whole * (1 - progressive), whole * progressive]
    sums = np.stack(columns, axis=-2)
    shares: Array = sums / sums.sum(axis=-2, keepdims=True)
    return shares


def _progressive_part(
    model: LinearModel, motion: Motion, held: list[int], left: Array, right: Array
) -> Array:
    """Return the part of a cyclic motion that is its uncoupled progressive mode, in each state (..., states).

    Alone, z = β_1c + i β_1s has the roots s_p and s_r. Its displacement and rate are the sums z = p + r and
    ż = s_p p + s_r r of both modes, so that p = (ż - s_r z) / (s_p - s_r) and r = (s_p z - ż) / (s_p - s_r); the
    conjugate of z has the conjugates of both.
    """
    faster, slower = _uncoupled_roots(model, motion)
    cosine, sine = (_states(place, held) for place in motion.places)
    progressive, regressive = np.zeros(()), np.zeros(())
    for turn, p, r in ((1j, faster, slower), (-1j, faster.conj(), slower.conj())):
        p, r = p[..., None], r[..., None]
        z, rate = (right[..., c, :] + turn * right[..., s, :] for c, s in zip(cosine, sine, strict=True))
        of_z, of_rate = (left[..., :, c] - turn * left[..., :, s] for c, s in zip(cosine, sine, strict=True))
        progressive = progressive + np.abs((of_z + p * of_rate) * (rate - r * z))
        regressive = regressive + np.abs((of_z + r * of_rate) * (p * z - rate))
    total = progressive + regressive
    return np.where(total > 0, progressive / np.where(total > 0, total, 1), 0.5)


def _uncoupled_roots(model: LinearModel, motion: Motion) -> tuple[Array, Array]:
    """Return the two roots (...) of a cyclic motion with all else held, averaged over directions; progressive first.

    In the rotating frame the roots are σ ± iν. Seen from the fixed frame the rotor's speed is added to both.
    """
    c, s = motion.places
    mass, damping, stiffness = (
        (matrix[..., c, c] + matrix[..., s, s]) / 2 - 0.5j * (matrix[..., c, s] - matrix[..., s, c])
        for matrix in (np.real(getattr(model, name)) for name in "MCK")
    )
    with np.errstate(all="ignore"):
        spread = np.sqrt(damping**2 - 4 * mass * stiffness)
        both = np.stack([-damping + spread, -damping - spread]) / (2 * mass)
    ahead = both[0].imag >= both[1].imag
    return np.where(ahead, both[0], both[1]), np.where(ahead, both[1], both[0])


def _assign_names(dofs: tuple[str, ...], held: list[int], shares: Array, values: Array) -> Array:
    """Return the name of each state (points, states), by its place in `name_list`; a pair has one name.

    The assignment with the largest sum of shares is taken. Where the best names of all states are different, these are
    that assignment. Of assignments that are equally good, as for a propeller on a pivot that is alike in all
    directions, the one is taken in which frequencies rise in the order of the names, so that rounding does not decide.

    Parameters
    ----------
    dofs : tuple of str
    held : list of int
    shares : array (points, names, states)
        Of `_name_shares`.
    values : array (points, states)
        Eigenvalues, each pair side by side.
    """
    slots = _slots(dofs, held)
    gain = np.swapaxes(shares, -1, -2) + _TIE * _by_rank(values, shares.shape[-2])
    upper = values.imag > 0
    best: Array = gain.argmax(axis=-1)
    best[:, 1:] = np.where(upper[:, :-1], best[:, :-1], best[:, 1:])
    counts = (best[..., None] == np.arange(shares.shape[-2])).sum(axis=-2)
    for point in np.flatnonzero((counts != np.bincount(slots)).any(axis=-1)):
        best[point] = _assigned(gain[point], slots, values[point])
    return best


def _by_rank(values: Array, names: int) -> Array:
    """Return products (points, states, names) of the ranks of frequencies and of names, 0 to 1."""
    order = np.lexsort((values.real, np.abs(values.imag)), axis=-1)
    rank = np.empty(values.shape)
    np.put_along_axis(rank, order, np.broadcast_to(np.linspace(0, 1, values.shape[-1]), values.shape), -1)
    return rank[..., None] * np.linspace(0, 1, names)


def _assigned(gain: Array, slots: Array, values: Array) -> Array:
    """Return the best assignment (states,) of one point that gives both states of a pair one name."""
    upper, real = np.flatnonzero(values.imag > 0), np.flatnonzero(values.imag == 0)
    given: Array = slots[best_assignment(gain[:, slots])]
    if (given[upper] == given[upper + 1]).all():
        return given
    # Two real roots that fit different names would split the names of a pair: try each choice of names for real roots.
    counts = np.bincount(slots)
    whole, half = np.flatnonzero(counts == 2), np.flatnonzero(counts == 1)
    if len(upper) > len(whole):  # two rates swing as one pair, which has one of their names
        given[upper + 1] = given[upper]
        return given
    largest = -np.inf
    for left in combinations(whole.tolist(), len(whole) - len(upper)):
        of_pairs, of_real = np.setdiff1d(whole, left), np.array([*left, *left, *half], dtype=int)
        pairs, roots = (
            best_assignment(gain[np.ix_(upper, of_pairs)]),
            best_assignment(gain[np.ix_(real, of_real)]),
        )
        total = 2 * gain[upper, of_pairs[pairs]].sum() + gain[real, of_real[roots]].sum()
        if total > largest:
            largest = total
            given[upper] = given[upper + 1] = of_pairs[pairs]
            given[real] = of_real[roots]
    return given


def _slots(dofs: tuple[str, ...], held: list[int]) -> Array:
    """Return the names in as many places as a model has states: each mode's name twice, that of a rate alone once."""
    counts = [
        1 if len(motion.places) == 1 and motion.places[0] not in held else 2
        for motion in motions(dofs)
        for _ in motion.names
    ]
    return np.repeat(np.arange(len(counts)), counts)
