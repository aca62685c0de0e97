"""Modes of many designs, each followed along the airspeeds of its own design, all designs at once."""

from __future__ import annotations

import numpy as np
from proprotor_equations import FIXED_COORDINATES

from proprotor.model.linear_model import LinearModel
from proprotor.rotor.motions import name_list
from proprotor.stability.matching import NOT_TOLD, Spectrum
from proprotor.stability.names_and_steps import Steps, Walk, joined, names_and_steps
from proprotor.study.roots import by_frequency
from proprotor.typing import Array


def walk(model: LinearModel, spectrum: Spectrum) -> Walk:
    """Return the points of a few designs at their airspeeds, by name and with the steps from point to point.

    Parameters
    ----------
    model : LinearModel
        Points (designs, airspeeds).
    spectrum : Spectrum
        Eigenvalues and vectors of the model.
    """
    support = [place for place, name in enumerate(model.dofs) if name not in FIXED_COORDINATES]
    return names_and_steps(model, spectrum, support)


def modes_along(walks: list[Walk], speeds: int, coordinates: tuple[str, ...]) -> dict[str, Array]:
    """Return the variables of the quantity "modes" for a batch of designs and airspeeds.

    Parameters
    ----------
    walks : list of Walk
        Of all designs of the batch.
    speeds : int
        Number of airspeeds.
    coordinates : tuple of str
        Of the model.
    """
    values, found, steps = joined(walks)
    shape = (-1, speeds, values.shape[1])
    places, quality = _followed(values, steps, speeds)
    followed, name, share, of_support, main = (
        np.take_along_axis(part, places, -1).reshape(shape) for part in (values, *found)
    )
    works = np.isfinite(followed).any(axis=-1)
    first = np.arange(len(works)), works.argmax(axis=1)
    names, dofs = (
        np.array(list(some), dtype=object) for some in ([*name_list(coordinates), ""], coordinates)
    )
    none = np.isnan(followed)
    return {
        "mode_eigenvalue": followed,
        "mode_quality": np.where(none, np.nan, quality.reshape(shape)),
        "mode_name": names[name],
        "mode_share": share,
        "mode_support_share": of_support,
        "mode_coordinate": np.where(none[first], "", dofs[main[first]]),
    }


def _followed(values: Array, steps: Steps, speeds: int) -> tuple[Array, Array]:
    """Follow the states of each design along its airspeeds, over its failed points.

    Parameters
    ----------
    values : array (points, states)
        Eigenvalues, the airspeeds of one design after those of another.
    steps : Steps
    speeds : int
        Number of airspeeds.

    Returns
    -------
    places : array (points, states) of int
        Place of each followed state; states by their frequency at the design's first good airspeed.
    quality : array (points, states)
        Trust in the step from the good airspeed before, see `proprotor.stability.matching.match_modes`; NaN at the
        first good airspeed and at failed points.
    """
    places, quality = by_frequency(values), np.full(values.shape, np.nan)
    for speed in range(1, speeds):
        rows = np.flatnonzero(steps.after % speeds == speed)
        here, there = places[steps.before[rows]], steps.after[rows]
        places[there] = np.take_along_axis(steps.successor[rows], here, -1)
        quality[there] = np.take_along_axis(steps.quality[rows], here, -1)
    return places, quality


def doubted(warning: Array, quality: Array) -> Array:
    """Return warnings (designs, speeds), with a further warning at points to which a step of no quality leads."""
    joined = np.array(warning, dtype=object)
    lost = (quality <= 0).any(axis=-1)
    joined[lost] = [f"{text}; {NOT_TOLD}" if text else NOT_TOLD for text in joined[lost]]
    return joined
