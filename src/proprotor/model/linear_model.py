"""The record of a linear model: equations of motion about a trim, at one or many airspeeds."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from proprotor_equations import FIXED_GUSTS

from proprotor.model import stamp
from proprotor.model.doubts import reasons_for_doubt
from proprotor.model.massless import massless
from proprotor.model.stamp import Origin
from proprotor.rotor.motions import HALVES, ROTOR_SPEED, in_half
from proprotor.rotor.trim import Trim
from proprotor.typing import Array, Dataset

if TYPE_CHECKING:
    from proprotor.model.state_space import StateSpace
    from proprotor.rotor.moving_blade import Motion

SWASHPLATE = ("collective", "cyclic_1c", "cyclic_1s")
INPUTS = (*SWASHPLATE, *FIXED_GUSTS)
GUSTS = tuple(FIXED_GUSTS)
_AZIMUTHS = tuple(in_half(half, ROTOR_SPEED) for half in reversed(HALVES))


class Feedback(NamedTuple):
    """What control loops add to the inputs of a model (..., inputs, n), by the motion of each coordinate.

    displacement, rate, acceleration : in the input's unit per m or rad, per s and per s²
    """

    displacement: Array
    rate: Array
    acceleration: Array

    def at(self, places: list[int]) -> Feedback:
        """Return the feedback from some of the coordinates."""
        return Feedback(*(part[..., places] for part in self))


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
        Loads per unit of the inputs `INPUTS`: swashplate collective and cyclics in rad, gusts along I, J, K in m/s; of
        two rotors, the loads of each half of the motion in turn.
    hub : array (6, n), optional
        Hub motion per unit of each coordinate; None for a model whose first six coordinates are the hub's own. Of two
        rotors, the motion of the right hub.
    rotor : LinearModel, optional
        The rotor alone of a rotor on a support, from which the hub loads follow; of two rotors, the right one.
    mass_at_rest : array (..., 6, 6) or (..., 8, 8), optional
        For a rotor alone: its mass matrix at rest with locked blades, in kg, kg m and kg m², on the hub's coordinates
        and, for a rotor with a gimbal, on the gimbal's, whatever the options. A support whose masses include the rotor
        needs this matrix. See `proprotor.model.mass_at_rest`.
    shapes : array (..., m, k), optional
        Shapes of the first k coordinates, for a support whose shapes differ from design to design: see
        `proprotor.support.normal_modes.NormalModes`.
    origin : Origin, optional
        The options in force and the case, if the model is one of a case: see `proprotor.model.stamp`.
    rates : tuple of str
        Coordinates along which nothing has stiffness, such as the heave of an aircraft: only their rates are states.
    rigid_body : tuple of str
        Coordinates that move an aircraft as one body.
    symmetry : tuple of str
        Of a model of two mirrored rotors (`proprotor.model.pair`): "symmetric", "antisymmetric" or "" for each
        coordinate; empty for any other model.
    halves_couple : bool
        Whether symmetric coordinates couple with antisymmetric ones; if not, the terms between them are exactly zero,
        and each half is a problem of its own.
    apart : tuple of tuple of str
        Groups of coordinates that couple with no other coordinate, such as reactionless motions of one harmonic: the
        terms between them and others are exactly zero, and each group is a problem of its own.
    left : LinearModel, optional
        Of two rotors that differ: the left rotor alone, in its mirrored axes.
    left_hub : array (..., 6, n), optional
        Of two rotors: motion of the left hub per unit of each coordinate, m and rad, in the mirrored axes of the left
        rotor.
    swing : Motion, optional
        Of a rotor alone at an angle or in a pull-up: what its blades and its gimbal do around the turn, see
        `proprotor.rotor.moving_blade`.
    inputs : tuple of str
        Names of the columns of `B`: `INPUTS`, of two rotors "symmetric collective" and so on; then the support's.
    feedback : Feedback, optional
        Of a model with control loops, which its matrices contain: `proprotor.model.closed_loop`.
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
    rates: tuple[str, ...] = ()
    rigid_body: tuple[str, ...] = ()
    symmetry: tuple[str, ...] = ()
    halves_couple: bool = True
    apart: tuple[tuple[str, ...], ...] = ()
    left: LinearModel | None = None
    left_hub: Array | None = None
    inputs: tuple[str, ...] = INPUTS
    swing: Motion | None = None
    feedback: Feedback | None = None

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

    def _repr_html_(self) -> str:
        """Return what a notebook shows."""
        from proprotor.model.in_notebook import model_html  # here, because most uses need no HTML

        return model_html(self)

    @property
    def matrices(self) -> dict[str, Array]:
        """M, C, K and, for a model with inputs, B, by name; SI."""
        return {name: matrix for name in "MCKB" if (matrix := getattr(self, name)) is not None}

    @property
    def blocks(self) -> list[list[int]]:
        """Places of the coordinates, in groups of which no two couple: those of `apart` behind the others."""
        groups = [[self.dofs.index(name) for name in group] for group in self.apart]
        apart = {place for group in groups for place in group}
        others = [place for place in range(len(self.dofs)) if place not in apart]
        if self.halves_couple or not self.symmetry:
            return [group for group in (others, *groups) if group]
        halves = [[place for place in others if self.symmetry[place] == half] for half in HALVES]
        return [group for group in (*halves, *groups) if group]

    @property
    def is_compiled(self) -> bool:
        """Whether compiled functions take the points of the batch."""
        return self.origin is not None and self.origin.options.backend == "compiled"

    @cached_property
    def finite(self) -> Array:
        """Points (...) whose mass matrix has numbers, SI; failed points have NaN in place of these numbers."""
        return np.asarray(np.isfinite(self.M).all(axis=(-2, -1)))

    def note_mass(self) -> None:
        """Note what the caller has found: every mass matrix is finite and has an inverse."""
        vars(self)["finite"] = np.ones(self.M.shape[:-2], dtype=bool)
        vars(self)["massless"] = np.zeros(self.M.shape[:-2], dtype=bool)

    @cached_property
    def massless(self) -> Array:
        """Points (...) whose mass matrix, scaled to be dimensionless, has no inverse; False at failed points."""
        return massless(self.M, self.is_compiled)

    @cached_property
    def azimuths(self) -> tuple[str, ...]:
        """Coordinates that are displacements only where a shaft holds them; what holds one holds those before it too.

        An interconnect shaft between two rotors holds the antisymmetric azimuth alone.
        """
        names = _AZIMUTHS if self.symmetry else (ROTOR_SPEED,)
        return tuple(self.dofs[place] for place in _places_of(names, self.dofs))

    @cached_property
    def azimuths_held(self) -> Array:
        """Points (..., azimuths) at which a shaft makes an azimuth a displacement, in rad.

        Without a shaft only the rate of an azimuth counts.
        """
        places = _places_of(self.azimuths, self.dofs)
        return np.asarray(self.K.real[..., places, places] > 0)

    @property
    def shaft_holds_azimuth(self) -> Array:
        """Points (...) at which shafts make every azimuth a displacement, in rad: see `azimuths_held`."""
        return np.asarray(self.azimuths_held.all(axis=-1) & bool(self.azimuths))

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
        parts = {name: getattr(self, name).take(places, -1).take(places, -2) for name in "MCK"}
        inputs = None if self.B is None else self.B[..., places, :]
        hub, left = (None if motion is None else motion[..., places] for motion in (self.hub, self.left_hub))
        whole = self.shapes is not None and places[: self.shapes.shape[-1]] == [*range(self.shapes.shape[-1])]
        shapes = self.shapes if whole else None
        rates, rigid = (tuple(name for name in own if name in dofs) for own in (self.rates, self.rigid_body))
        apart = (tuple(name for name in group if name in dofs) for group in self.apart)
        more: dict[str, Any] = {"rates": rates, "rigid_body": rigid, "left_hub": left}
        more["apart"] = tuple(group for group in apart if group)
        more["feedback"] = None if self.feedback is None else self.feedback.at(places)
        if self.symmetry:
            more["symmetry"] = tuple(self.symmetry[place] for place in places)
        return replace(self, dofs=tuple(dofs), B=inputs, hub=hub, shapes=shapes, **parts, **more)


@lru_cache(maxsize=32)
def _places_of(names: tuple[str, ...], dofs: tuple[str, ...]) -> list[int]:
    """Return the places of some names among coordinates, without names that are not there; not to be written to."""
    return [dofs.index(name) for name in names if name in dofs]


def range_text(values: Array) -> str:
    """Return the range of some numbers as text, such as "50 to 400"; one number where all are the same."""
    low, high = float(np.min(values.real)), float(np.max(values.real))
    return f"{low:.6g}" if low == high else f"{low:.6g} to {high:.6g}"
