"""Kinds of instability: divergence, an instability of the rigid body, or flutter of the structure."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from proprotor.model.configuration import Configuration
from proprotor.model.first_order import held_coordinates
from proprotor.model.linear_model import LinearModel
from proprotor.stability.boundary import Boundary
from proprotor.stability.matching import Modes
from proprotor.stability.participation import coordinate_shares
from proprotor.support.airframe import Airframe
from proprotor.typing import Array

DIVERGENCE, RIGID_BODY, FLUTTER = "divergence", "rigid body", "flutter"
_DOMINATES = 0.5  # participation of all coordinates of the rigid body together


def kinds(model: LinearModel, modes: Modes) -> Array:
    """Return the kind of instability (..., modes) that each mode would be where the mode crosses a level.

    A real root is divergence, whatever moves. A pair in which the coordinates that move the aircraft as one body take
    most part is an instability of the rigid body, such as an unstable short period; any other pair is flutter.
    """
    values, right, left = modes
    shares = coordinate_shares(held_coordinates(model, right.shape[-2]), len(model.dofs), left, right)
    rigid = [model.dofs.index(name) for name in model.rigid_body]
    pair = np.where(shares[..., rigid, :].sum(axis=-2) > _DOMINATES, RIGID_BODY, FLUTTER)
    return np.where(values.imag == 0, DIVERGENCE, pair)


def flies_free(case: Configuration) -> bool:
    """Return whether a case is an aircraft that moves as one body, so that flutter is one of three kinds of result."""
    return isinstance(case.support, Airframe) and bool(case.support.rigid_body)


def leading_onset(case: Configuration, boundaries: Iterable[Boundary]) -> Boundary | None:
    """Return the onset that a search leads with: the lowest one; of an aircraft, the lowest onset of flutter.

    A free aircraft has instabilities of flight, slow and often harmless, that say nothing about its structure.
    """
    free = flies_free(case)
    return next((one for one in boundaries if one.onset and (not free or one.kind == FLUTTER)), None)
