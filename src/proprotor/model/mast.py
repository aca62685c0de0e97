"""A mast that twists between a rotor and its gearbox and engine.

The coordinate is the twist, azimuth of the gearbox less azimuth of the rotor: the azimuth alone then still turns rotor
and engine together, and needs no displacement unless a shaft holds it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from proprotor_equations import FIXED_COORDINATES, drive_train

from proprotor.model.linear_model import LinearModel
from proprotor.rotor.drive_train import DriveTrain
from proprotor.rotor.generated import evaluate
from proprotor.rotor.motions import MAST_TWIST, ROTOR_SPEED
from proprotor.typing import Array

_KINDS = {"M": drive_train.mass, "C": drive_train.damping, "K": drive_train.stiffness}


def with_mast(model: LinearModel, train: DriveTrain) -> LinearModel:
    """Return the model of a rotor alone with its mast twist as last coordinate, and with the engine at its end.

    The engine is a drive train on the azimuth of the gearbox, the sum of azimuth and twist.

    Parameters
    ----------
    model : LinearModel
        With the azimuth among its coordinates.
    train : DriveTrain
        With a mast stiffness.
    """
    matrices: dict[str, Any] = {
        name: _with_engine(getattr(model, name), evaluate(kind, train.at_engine), model.dofs)
        for name, kind in _KINDS.items()
    }
    matrices["K"] = matrices["K"] + np.asarray(train.mast_stiffness)[..., None, None] * _twist(
        len(model.dofs)
    )
    inputs = None if model.B is None else np.pad(model.B, [(0, 0)] * (model.B.ndim - 2) + [(0, 1), (0, 0)])
    return replace(model, **matrices, B=inputs, dofs=(*model.dofs, MAST_TWIST))


def _with_engine(matrix: Array, engine: Array, dofs: tuple[str, ...]) -> Array:
    """Return a matrix (..., n, n) of a rotor with that of an engine (..., 18, 18), on one more coordinate."""
    n = len(dofs)
    to_engine = np.zeros((len(FIXED_COORDINATES), n + 1))
    own = [name for name in FIXED_COORDINATES if name in dofs]
    to_engine[[FIXED_COORDINATES.index(name) for name in own], [dofs.index(name) for name in own]] = 1
    to_engine[FIXED_COORDINATES.index(ROTOR_SPEED), n] = 1
    whole = np.pad(matrix, [(0, 0)] * (matrix.ndim - 2) + [(0, 1), (0, 1)])
    added: Array = whole + to_engine.T @ engine @ to_engine
    return added


def _twist(place: int) -> Array:
    """Return the matrix (place + 1, place + 1) that has a one at the last coordinate alone."""
    found = np.zeros((place + 1, place + 1))
    found[place, place] = 1
    return found
