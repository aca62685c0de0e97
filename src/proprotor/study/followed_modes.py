"""Modes of many designs, each followed along the airspeeds of its own design, all designs at once."""

from __future__ import annotations

import numpy as np
from proprotor_equations import FIXED_COORDINATES

from proprotor.model.first_order import held_coordinates
from proprotor.model.linear_model import LinearModel
from proprotor.stability.matching import NOT_TOLD, Spectrum, match_modes
from proprotor.stability.mode_names import moving
from proprotor.stability.modes import coordinate_shares
from proprotor.study.roots import by_frequency
from proprotor.typing import Array


def modes_along(model: LinearModel, spectrum: Spectrum) -> dict[str, Array]:
    """Return the variables of the quantity "modes" for a batch of designs and airspeeds.

    Parameters
    ----------
    model : LinearModel
        Points (designs, airspeeds).
    spectrum : Spectrum
        Eigenvalues and vectors of the model.
    """
    modes = spectrum.all_modes
    places, quality, first = _follow(spectrum)
    followed = np.take_along_axis(modes.values, places, -1)
    moves = moving(model, modes.values, modes.left, modes.right)
    shares = coordinate_shares(held_coordinates(model), len(model.dofs), modes.left, modes.right)
    support = [place for place, name in enumerate(model.dofs) if name not in FIXED_COORDINATES]
    designs = np.arange(len(places))
    largest = np.nan_to_num(shares[designs, first]).argmax(axis=-2)
    main = np.take_along_axis(largest, places[designs, first], -1)
    none = np.isnan(followed[designs, first])
    return {
        "mode_eigenvalue": followed,
        "mode_quality": np.where(np.isnan(followed), np.nan, quality),
        "mode_name": np.take_along_axis(moves.names, places, -1),
        "mode_share": np.take_along_axis(moves.share, places, -1),
        "mode_support_share": np.take_along_axis(shares[..., support, :].sum(axis=-2), places, -1),
        "mode_coordinate": np.where(none, "", np.array(model.dofs, dtype=object)[main]),
    }


def _follow(spectrum: Spectrum) -> tuple[Array, Array, Array]:
    """Follow the states of each design along its airspeeds, over its failed points.

    Parameters
    ----------
    spectrum : Spectrum
        Eigenvalues and vectors of points (designs, speeds).

    Returns
    -------
    places : array (designs, speeds, states) of int
        Place of each followed state at each airspeed; states by their frequency at the design's first good airspeed.
    quality : array (designs, speeds, states)
        Trust in the step from the good airspeed before, see `proprotor.stability.matching.match_modes`; NaN at the
        first good airspeed and at failed points.
    first : array (designs,) of int
        Place of the first good airspeed, -1 where there is none.
    """
    designs, speeds, states = spectrum.values.shape
    good = spectrum.works
    points = np.flatnonzero(good)
    same_design = np.diff(points // speeds) == 0
    before, after = points[:-1][same_design], points[1:][same_design]
    flat_values, flat_right = (
        array.reshape(designs * speeds, *array.shape[2:]) for array in (spectrum.values, spectrum.right)
    )
    flat = Spectrum(flat_values, flat_right, blocks=spectrum.blocks)
    steps = match_modes(flat, before, after)
    places = by_frequency(spectrum.values).reshape(-1, states)
    quality = np.full(places.shape, np.nan)
    for speed in range(1, speeds):
        rows = np.flatnonzero(after % speeds == speed)
        here = places[before[rows]]
        places[after[rows]] = np.take_along_axis(steps.successor[rows], here, -1)
        quality[after[rows]] = np.take_along_axis(steps.quality[rows], here, -1)
    first = np.where(good.any(axis=1), good.argmax(axis=1), -1)
    return places.reshape(designs, speeds, states), quality.reshape(designs, speeds, states), first


def doubted(warning: Array, quality: Array) -> Array:
    """Return warnings (designs, speeds), with a further warning at points to which a step of no quality leads."""
    joined = np.array(warning, dtype=object)
    lost = (quality <= 0).any(axis=-1)
    joined[lost] = [f"{text}; {NOT_TOLD}" if text else NOT_TOLD for text in joined[lost]]
    return joined
