"""Modes along a line of points by what moves in them, each with the root that it is, followed from point to point."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError
from proprotor.model import stamp
from proprotor.model.configuration import Configuration
from proprotor.model.linear_model import LinearModel
from proprotor.rotor.motions import SECOND
from proprotor.stability.branches import branch_labels, name_states
from proprotor.stability.following import follow
from proprotor.stability.mode_names import Moving, moving, whirl
from proprotor.stability.modes import at_columns, mode_dataset
from proprotor.stability.parameter_lines import ParameterLine, line_of_case, with_approach
from proprotor.stability.root_error import errors_of
from proprotor.typing import Array, Dataset


def sweep(
    model: LinearModel, line: ParameterLine | None = None, *, approach: ParameterLine | None = None
) -> Dataset:
    """Return the modes of a line of points, named and followed.

    Parameters
    ----------
    model : LinearModel
        One point for each position of the line.
    line : ParameterLine, optional
        Airspeeds of the model by default; if the line can be linearised between its points, steps that do not tell
        which mode is which are divided.
    approach : ParameterLine, optional
        From the anchor, where branches get their labels, to the point of the line that is nearest to the anchor, both
        included: labels then do not depend on where the line begins and ends. Without an approach, or where it fails,
        labels are given at the first point that works.

    Returns
    -------
    xarray.Dataset
        As `LinearModel.modes`, with mode names as coordinate: what moves (`proprotor.stability.mode_names`), at each
        point by itself, so that a name passes from one root to another where the two exchange their motions. share, how
        much of the mode is that motion, 0 to 1; branch, which exact root has the name at a point, by its label where
        branches are named (`proprotor.stability.branches`); tracking_quality, the trust in that label, 0 to 1: the
        least of all steps from that point; whirl (-1 against the rotor to 1 with it, in the fixed frame). A step that
        does not tell roots apart is a warning. Attributes: eigen_solves, named_at, where branches are named, and the
        case and its options (`proprotor.model.stamp`).

    Raises
    ------
    InputError
        When the points do not form a line.
    """
    if model.airspeed.ndim != 1:
        raise InputError(
            "airspeed", f"array of shape {model.airspeed.shape}", "must be a list of speeds to sweep"
        )
    line = replace(ParameterLine(model.airspeed) if line is None else line, model=model)
    points, branches = len(model.airspeed), follow(model, line)
    named = name_states(branches, line, approach)
    spectrum = branches.spectrum.at(slice(points))
    every = spectrum.all_modes
    found = moving(model, every.values, every.left, every.right)
    columns, modes = mode_columns(found, every.values)
    data = mode_dataset(model, every, errors_of(model, spectrum), columns, line)
    by_mode = data.eigenvalue.dims
    way = {"units": "1", "long_name": "whirl with the rotor, in the fixed frame"}
    data["whirl"] = by_mode, at_columns(whirl(model, every), columns), way
    labels = branch_labels(branches, named, points)
    for name, values, meaning in (
        ("share", found.share, "participation of the motion that the mode is named after"),
        ("branch", labels.label, "exact root, by what moves in it where branches are named"),
        ("tracking_quality", labels.trust, "trust in the steps from where branches are named to the point"),
    ):
        data[name] = by_mode, at_columns(values, columns), {"long_name": meaning}
    data["branch"] = data.branch.astype(str)
    data["warning"] = data.warning.dims, _joined(data.warning.values, labels.doubt), data.warning.attrs
    data.attrs |= {"eigen_solves": len(branches.points) + named.eigen_solves, "named_at": named.where}
    return data.assign_coords(mode=modes)


def _joined(first: Array, second: Array) -> Array:
    """Return two arrays of warnings as one, with a semicolon between warnings of the same point."""
    both = ["; ".join(filter(None, texts)) for texts in zip(first.tolist(), second.tolist(), strict=True)]
    return np.array(both, dtype=str)


def mode_columns(found: Moving, values: Array) -> tuple[Array, list[str]]:
    """Return which state each mode is at each point (points, modes), and the names of the modes.

    The state is -1 where a point lacks the mode. Modes are in the order of the coordinates. A mode is the state of a
    pair that is above the real axis, or a real root. Two real roots that have one name are two modes: the one that
    decays faster, or grows less, is the second root.
    """
    columns, modes = [], []
    counts = values.imag >= 0
    for place, name in enumerate(found.known):
        own = counts & (found.place == place)
        for suffix in ("", SECOND):
            if not own.any():
                break
            best = np.where(own, values.real, -np.inf).argmax(axis=1)
            columns.append(np.where(own.any(axis=1), best, -1))
            modes.append(name + suffix)
            own[np.arange(len(own)), best] = False
    stacked = np.stack(columns, axis=1) if columns else np.empty((len(values), 0), dtype=int)
    return stacked, modes


def sweep_case(
    case: Configuration, airspeeds: Any, vary: Mapping[str, ArrayLike] | None = None, **options: Any
) -> Dataset:
    """Return the modes of a case along airspeeds, or along one input at one airspeed: see `sweep`.

    Modes have their names by what moves at each point. Branches get their labels at the anchor, the case's own inputs
    near cruise (`proprotor.stability.parameter_lines.approach_to`), and are followed from the anchor, in steps that are
    divided until they tell roots apart. So names and labels are the same in any range and for any step.

    Parameters
    ----------
    case : Case
    airspeeds : array (points,) in m/s, text such as "50:400:5kt", or pint quantity
        One airspeed with `vary`.
    vary : mapping of str to array (points,), optional
        One input by its path in the deck (`proprotor.deck.vary.design_inputs`), and its values in SI.
    **options
        See `proprotor.rotor.options.Options`.

    Returns
    -------
    xarray.Dataset
        As `sweep` has it.

    Raises
    ------
    InputError
        For an unknown option or input, airspeeds that do not form a line, or more than one input.
    """
    line = line_of_case(case, airspeeds, vary, options)
    if line is None:  # points differ in more than their airspeed
        found = sweep(case.linearize(airspeeds, **options))
    else:
        model, approach = with_approach(case, line, options)
        found = sweep(model, line, approach=approach)
    return found.assign_attrs(
        stamp.of_case(case, options, vary or ())
    )  # of the case itself, not of one that is varied
