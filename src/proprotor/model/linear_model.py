"""The record of a linear model: equations of motion about a trim, at one or many airspeeds."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from proprotor_equations import FIXED_GUSTS

from proprotor.model import stamp
from proprotor.model.doubts import reasons_for_doubt
from proprotor.model.stamp import Origin
from proprotor.rotor.motions import ROTOR_SPEED
from proprotor.rotor.trim import Trim
from proprotor.typing import Array, Dataset

if TYPE_CHECKING:
    from proprotor.model.state_space import StateSpace

SWASHPLATE = ("collective", "cyclic_1c", "cyclic_1s")
INPUTS = (*SWASHPLATE, *FIXED_GUSTS)


@dataclass(frozen=True, eq=False, repr=False)
class LinearModel:
    """M q̈ + C q̇ + K q = B u about trim, batched over leading axes.

    Attributes
    ----------
    M, C, K : array (..., n, n)
        SI units; rows are virtual work per coordinate, hub rows are resultants in inertial axes. NaN at failed points.
    dofs : tuple of str
        Names of the n coordinates.
    trim : Trim
        Arrays of the batch's shape, with the reason of every failed point.
    airspeed : array (...)
        m/s.
    B : array (..., n, 6), optional
        Loads per unit of the inputs `INPUTS`: swashplate collective and cyclics in rad, gusts along I, J, K in m/s.
    hub : array (6, n), optional
        Hub motion per unit of each coordinate; None for a model whose first six coordinates are the hub's own.
    rotor : LinearModel, optional
        The rotor alone of a rotor on a support, from which the hub loads follow.
    mass_at_rest : array (..., 6, 6) or (..., 8, 8), optional
        For a rotor alone: its mass matrix at rest with locked blades, in kg, kg m and kg m², on the hub's coordinates
        and, for a rotor with a gimbal, on the gimbal's, whatever the options. A support whose masses include the rotor
        needs this matrix. See `proprotor.model.mass_at_rest`.
    shapes : array (..., m, k), optional
        Shapes of the first k coordinates, for a support whose shapes differ from design to design: see
        `proprotor.support.normal_modes.NormalModes`.
    origin : Origin, optional
        The options in force and the case, if the model is one of a case: see `proprotor.model.stamp`.
    """

    M: Array
    C: Array
    K: Array
    dofs: tuple[str, ...]
    trim: Trim
    airspeed: Array
    B: Array | None = None
    hub: Array | None = None
    rotor: LinearModel | None = None
    mass_at_rest: Array | None = None
    shapes: Array | None = None
    origin: Origin | None = None

    def __repr__(self) -> str:
        """Return the coordinates, the shape of the batch and its failed and doubtful points, in a few lines."""
        converged = np.asarray(self.trim.converged)
        shape = f"batch of shape {converged.shape}" if converged.ndim else "one point"
        lines = [
            f"LinearModel: {len(self.dofs)} coordinates, {shape}, {range_text(self.airspeed)} m/s",
            f"  {', '.join(self.dofs)}",
        ]
        lines += [f"  {line}" for line in stamp.unusual_options(stamp.of_model(self))]
        reasons = Counter(str(reason) for reason in np.ravel(self.trim.reason) if reason)
        lines += [
            f"  {count} of {converged.size} failed: {reason}" for reason, count in reasons.most_common(5)
        ]
        doubts = reasons_for_doubt(np.ravel(self.trim.warning).tolist())
        lines += [f"  {len(at)} of {converged.size} doubtful: {text}" for text, at in doubts.items()]
        return "\n".join(lines)

    @property
    def matrices(self) -> dict[str, Array]:
        """M, C, K and, for a model with inputs, B, by name; SI."""
        return {name: matrix for name in "MCKB" if (matrix := getattr(self, name)) is not None}

    @property
    def shaft_holds_azimuth(self) -> Array:
        """Points (...) at which a shaft with an end of constant speed makes the azimuth a displacement, in rad.

        Without a shaft only the rate of the azimuth counts.
        """
        if ROTOR_SPEED not in self.dofs:
            return np.zeros(self.K.shape[:-2], dtype=bool)
        place = self.dofs.index(ROTOR_SPEED)
        return np.asarray(np.nan_to_num(np.real(self.K[..., place, place])) > 0)

    def modes(self) -> Dataset:
        """Return eigenvalues and mode shapes, see `proprotor.stability.modes.modes`.

        Returns
        -------
        xarray.Dataset
            eigenvalue (..., mode), rad/s, and more.

        Raises
        ------
        InputError
            When the mass matrix has no inverse, as that of a rotor alone may not.
        """
        from proprotor.stability.modes import modes

        return modes(self)

    def to_state_space(self) -> StateSpace:
        """Return A, B, C, D with named states, inputs and outputs, see `proprotor.model.state_space.state_space`.

        Returns
        -------
        StateSpace

        Raises
        ------
        InputError
            When the model has no inputs, such as a model from elsewhere.
        """
        from proprotor.model.state_space import state_space

        return state_space(self)

    def submodel(self, dofs: tuple[str, ...]) -> LinearModel:
        """Return the model with all other coordinates held at zero.

        Parameters
        ----------
        dofs : tuple of str
            Names of the coordinates to keep, in the wanted order.

        Returns
        -------
        LinearModel
        """
        places = [self.dofs.index(name) for name in dofs]
        parts = {name: getattr(self, name)[..., places, :][..., places] for name in "MCK"}
        inputs = None if self.B is None else self.B[..., places, :]
        hub = None if self.hub is None else self.hub[:, places]
        whole = self.shapes is not None and places[: self.shapes.shape[-1]] == [*range(self.shapes.shape[-1])]
        shapes = self.shapes if whole else None
        return replace(self, dofs=tuple(dofs), B=inputs, hub=hub, shapes=shapes, **parts)


def range_text(values: Array) -> str:
    """Return the range of some numbers as text, such as "50 to 400"; one number where all are the same."""
    low, high = float(np.min(values.real)), float(np.max(values.real))
    return f"{low:.6g}" if low == high else f"{low:.6g} to {high:.6g}"
