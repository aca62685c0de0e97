"""How much each motion takes part in modes, from left and right vectors of the state space.

A state takes part by |l r|, left times right vector, which depends neither on units nor on the scale of vectors. Both
modes of a pair have the same parts, so that one of them is enough. Cyclic motion is taken apart twice: by the way it
whirls in the fixed frame, and into its two uncoupled modes, regressive and progressive.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from proprotor.model.linear_model import LinearModel
from proprotor.rotor.motions import motions
from proprotor.stability.matching import size_of
from proprotor.typing import Array


class _Participation(NamedTuple):
    """Parts of motions in modes of points, 0 to 1; the parts of coordinates sum to 1, and those of names.

    coordinates (n, modes, points) : of each coordinate; names (names, modes, points) : of the motion of each name of
    `proprotor.rotor.motions.name_list`.
    """

    coordinates: Array
    names: Array


class _Cyclic(NamedTuple):
    """The k cyclic motions of a model.

    name (k,) : place of the regressive name, before that of the progressive one; cosine, sine (k,) : coordinates;
    cosine_states, sine_states (2 k,) : displacements of all motions, then their rates; others, singles (n - 2 k,) : all
    other names, and their coordinates.
    """

    name: Array
    cosine: Array
    sine: Array
    cosine_states: Array
    sine_states: Array
    others: Array
    singles: Array
    paired: Array
    partners: Array


def participation(model: LinearModel, held: list[int], left: Array, right: Array) -> _Participation:
    """Return how much each motion takes part.

    Parameters
    ----------
    model : LinearModel
        Points (points,).
    held : list of int
        Coordinates whose displacement is a state.
    left, right : array (states, modes, points)
        Vectors in columns, left times right vector 1.
    """
    n, cyclic = len(model.dofs), _cyclic_motions(model.dofs, tuple(held))
    sums = _of_coordinates(held, n, left, right)
    named = np.empty((2 * len(cyclic.name) + len(cyclic.others), *sums.shape[1:]))
    named[cyclic.others] = sums[cyclic.singles]
    named[cyclic.paired] += sums[cyclic.partners]
    if len(cyclic.name):
        whole = whirling(model.dofs, held, left, right).sum(axis=0)
        progressive = _progressive_part(model, cyclic, left, right)
        np.multiply(whole, progressive, out=progressive)
        named[cyclic.name], named[cyclic.name + 1] = whole - progressive, progressive
    for part in (sums, named):
        part /= part.sum(axis=0)
    return _Participation(sums, named)


def _of_coordinates(held: list[int], n: int, left: Array, right: Array) -> Array:
    """Return |l r| of the displacement and the rate of each coordinate (n, modes, ...).

    Where two modes fall into one, l may be so large and r so small that the square of neither is a number.
    """
    sizes = size_of(left * right)
    sums = sizes[-n:]
    sums[held] += sizes[: len(held)]
    return sums


def coordinate_shares(held: list[int], n: int, left: Array, right: Array) -> Array:
    """Return the share of each coordinate in each mode (..., n, modes), from left times right vector; it sums to 1.

    The share depends neither on units nor on the scale of vectors, unlike the largest component of a mode that mixes
    lengths and angles. Left vectors (..., modes, states) stand in rows, right ones (..., states, modes) in columns.
    """
    columns = np.moveaxis(left, -1, 0), np.moveaxis(right, -2, 0)
    sums = np.moveaxis(_of_coordinates(held, n, *columns), 0, -2)
    return np.asarray(sums / sums.sum(axis=-2, keepdims=True))


def whirling(dofs: tuple[str, ...], held: list[int], left: Array, right: Array) -> Array:
    """Return how much cyclic motion against and with the rotor takes part (2, motions, modes, ...).

    Vectors (states, modes, ...) are those of `participation`.
    """
    cyclic = _cyclic_motions(dofs, tuple(held))
    against, with_rotor = _turning(right[cyclic.cosine_states], right[cyclic.sine_states])
    left_with, left_against = _turning(left[cyclic.cosine_states], left[cyclic.sine_states])
    both = np.sqrt(np.stack([against * left_against, with_rotor * left_with])) / 2
    count = len(cyclic.name)
    return np.asarray(both[:, :count] + both[:, count:])


def _turning(c: Array, s: Array) -> tuple[Array, Array]:
    """Return |c - is|² and |c + is|²."""
    minus = (c.real + s.imag) ** 2 + (c.imag - s.real) ** 2
    plus = (c.real - s.imag) ** 2 + (c.imag + s.real) ** 2
    return minus, plus


@lru_cache(maxsize=16)  # of the models of an analysis, which has many batches
def _cyclic_motions(dofs: tuple[str, ...], held: tuple[int, ...]) -> _Cyclic:
    """Return the cyclic motions of a model with some coordinates whose displacement is a state."""
    names = [(motion, place) for motion in motions(dofs) for place in range(len(motion.names))]
    first = [at for at, (motion, place) in enumerate(names) if len(motion.names) == 2 and place == 0]
    others = [at for at, (motion, _) in enumerate(names) if len(motion.names) == 1]
    paired = [at for at in others if len(names[at][0].places) == 2]
    places = np.array([names[at][0].places for at in first], dtype=int).reshape(-1, 2).T
    states = np.concatenate([np.searchsorted(held, places), len(held) + places], axis=1)
    singles = [names[at][0].places[0] for at in others]
    partners = [names[at][0].places[1] for at in paired]
    ends = (np.array(some, dtype=int) for some in (others, singles, paired, partners))
    return _Cyclic(np.array(first, dtype=int), places[0], places[1], states[0], states[1], *ends)


def _progressive_part(model: LinearModel, cyclic: _Cyclic, left: Array, right: Array) -> Array:
    """Return the part of each cyclic motion that is its uncoupled progressive mode (motions, modes, points).

    Alone, z = β_1c + i β_1s has the roots s_p and s_r. Its displacement and rate are the sums z = p + r and
    ż = s_p p + s_r r of both modes, so that p = (ż - s_r z) / (s_p - s_r) and r = (s_p z - ż) / (s_p - s_r); the
    conjugate of z has the conjugates of both.
    """
    faster, slower = (root.T[:, None, :] for root in _uncoupled_roots(model, cyclic))
    c, s = right[cyclic.cosine_states], 1j * right[cyclic.sine_states]
    lc, ls = left[cyclic.cosine_states], 1j * left[cyclic.sine_states]
    count = len(cyclic.name)
    progressive = regressive = np.zeros(())
    for sign, p, r in ((1, faster, slower), (-1, faster.conj(), slower.conj())):
        whole, of_whole = (c + s, lc - ls) if sign > 0 else (c - s, lc + ls)
        z, rate, of_z, of_rate = whole[:count], whole[count:], of_whole[:count], of_whole[count:]
        progressive = progressive + size_of((of_z + p * of_rate) * (rate - r * z))
        regressive = regressive + size_of((of_z + r * of_rate) * (p * z - rate))
    total = progressive + regressive
    return np.where(total > 0, progressive / np.where(total > 0, total, 1), 0.5)


def _uncoupled_roots(model: LinearModel, cyclic: _Cyclic) -> tuple[Array, Array]:
    """Return both roots (points, motions) of cyclic motions with all else held, averaged over directions.

    The progressive one stands first. In the rotating frame the roots are σ ± iν. Seen from the fixed frame the rotor's
    speed is added to both.
    """
    c, s = cyclic.cosine, cyclic.sine
    mass, damping, stiffness = (
        (matrix[..., c, c] + matrix[..., s, s]) / 2 - 0.5j * (matrix[..., c, s] - matrix[..., s, c])
        for matrix in (np.real(getattr(model, name)) for name in "MCK")
    )
    with np.errstate(all="ignore"):
        spread = np.sqrt(damping**2 - 4 * mass * stiffness)
        both = np.stack([-damping + spread, -damping - spread]) / (2 * mass)
    ahead = both[0].imag >= both[1].imag
    return np.where(ahead, both[0], both[1]), np.where(ahead, both[1], both[0])
