"""Build the state space of a linear model, with names, for control design, frequency response and simulation.

Inputs are swashplate collective and cyclics (rad) and gusts along I, J, K (m/s). Outputs are hub motion, the rotor's
loads on the hub and the blades' motion; of two rotors, each of these in symmetric and antisymmetric motion. With the
pitch equations kept, the pitch coordinates are the whole perturbation of blade pitch.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from proprotor.errors import InputError
from proprotor.model.first_order import (
    held_coordinates,
    lacking_states,
    state_matrix,
    without_massless,
)
from proprotor.model.linear_model import Feedback, LinearModel
from proprotor.model.pair import halves_of, hub_inputs, hub_rows
from proprotor.model.stamp import Stamp, of_model
from proprotor.needs import need
from proprotor.rotor.motions import HALVES, HUB, in_half
from proprotor.typing import Array

if TYPE_CHECKING:
    import control

_Rows = tuple[Array, Array, Array]  # displacements, rates and accelerations per unit of each state
# Names of outputs with their rows of C and of D, None for zeros.
_Block = tuple[tuple[str, ...], Array, Array | None]

LOADS = ("force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z")


@dataclass(frozen=True, eq=False)
class StateSpace:
    """ẋ = A x + B u, y = C x + D u, batched over leading axes; NaN at failed points.

    Of two rotors, an input or output of a half, "symmetric force_x", is that of the right rotor in this half of the
    motion: the left one is alike in its mirrored axes, or the opposite in the antisymmetric half.

    Along an axis in which a coordinate without displacement moves the hub, as heave does an aircraft, rate and
    acceleration of the hub are outputs and the displacement is none.

    If a shaft holds the azimuth at some points of a batch only, the azimuth is a state and an output. At the other
    points its row and column of A, its rows of B, C and D and its column of C are NaN. Its rate is an output too.

    Attributes
    ----------
    A : array (..., states, states)
        SI units.
    B : array (..., states, inputs)
        SI units.
    C : array (..., outputs, states)
        SI units.
    D : array (..., outputs, inputs)
        SI units.
    states, inputs, outputs : tuple of str
        States are displacements (without the rotor's azimuth unless a shaft holds it), then rates ("… rate").
        Outputs are hub displacement, rate and acceleration, the rotor's loads on the hub (N, N m, along and about
        inertial axes) and the rotor's own coordinates; for an azimuth that no shaft holds, the rate.
    warning, reason : array of str
        (...): the reason for which a point is doubtful, and the reason for which a point failed; empty without one.
    stamp : mapping of str to str
        The case and the options in force, see `proprotor.model.stamp`.
    """

    A: Array
    B: Array
    C: Array
    D: Array
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    warning: Array
    reason: Array
    stamp: Stamp = field(default_factory=dict)

    def __repr__(self) -> str:
        """Return how many states, inputs and outputs there are, their names, and the failed points, in a few lines."""
        points = f"batch of shape {self.A.shape[:-2]}" if self.A.ndim > 2 else "one point"
        lines = [f"StateSpace: {len(self.states)} states, {points}"]
        for name in ("inputs", "outputs"):
            names = getattr(self, name)
            lines.append(f"  {len(names)} {name}: {', '.join(names)}")
        for told, texts in (("failed", self.reason), ("doubtful", self.warning)):
            if count := np.count_nonzero(np.asarray(texts, dtype=str)):
                lines.append(f"  {count} of {np.size(texts)} {told}")
        return "\n".join(lines)

    def to_control(self) -> control.StateSpace:
        """Return one point as a `control.StateSpace` of python-control.

        Returns
        -------
        control.StateSpace

        Raises
        ------
        InputError
            When the model is a batch of several points, or python-control is not installed.
        """
        need("control", "to_control", "state spaces", "control")
        import control

        if self.A.ndim != 2:
            raise InputError(
                "airspeed", f"array of shape {self.A.shape[:-2]}", "must be one speed for python-control"
            )
        return control.StateSpace(
            self.A, self.B, self.C, self.D, states=self.states, inputs=self.inputs, outputs=self.outputs
        )


def state_space(model: LinearModel) -> StateSpace:
    """Return the state space of a rotor, alone or on a support.

    Parameters
    ----------
    model : LinearModel
        Leading axes of a batch are kept.

    Returns
    -------
    StateSpace

    Raises
    ------
    InputError
        When the model has no inputs, such as a model from elsewhere.
    """
    if model.B is None:
        raise InputError("B", None, "must be given: the model has no inputs")
    system, mass = state_matrix(model), without_massless(model).M
    n, held = len(model.dofs), held_coordinates(model)
    rates = slice(len(held), len(held) + n)
    acceleration_by_input = np.linalg.solve(mass, model.B)
    inputs = np.zeros((*system.shape[:-1], len(model.inputs)), dtype=acceleration_by_input.dtype)
    inputs[..., rates, :] = acceleration_by_input
    displacement = np.pad(np.eye(n)[:, held], ((0, 0), (0, n)))
    rate = np.pad(np.eye(n), ((0, 0), (len(held), 0)))
    motion = (displacement, rate, system[..., rates, :])
    names, rows, feedthrough = _outputs(model, motion, acceleration_by_input)
    failed = ~np.isfinite(mass).all(axis=(-2, -1))
    for state, free in lacking_states(model):
        output = names.index(model.dofs[held[state]])
        inputs[free, state], rows[free, :, state] = np.nan, np.nan
        rows[free, output], feedthrough[free, output] = np.nan, np.nan
    for part in (inputs, rows, feedthrough):
        part[failed] = np.nan
    states = (*(model.dofs[place] for place in held), *(f"{name} rate" for name in model.dofs))
    doubt = model.trim.warning, model.trim.reason
    return StateSpace(system, inputs, rows, feedthrough, states, model.inputs, names, *doubt, of_model(model))


class _Loads(NamedTuple):
    """The loads on a hub, of one rotor or of one half of the motion of two rotors.

    half : "", or the half; to_rotor (..., 6 + own, n) : the rotor's coordinates per unit of each coordinate of the
    model; rows : hub rows of M, C and K (..., 6, n); inputs (..., 6, inputs) : hub rows of the inputs.
    """

    half: str
    to_rotor: Array
    rows: dict[str, Array]
    inputs: Array

    def names(self, names: tuple[str, ...], ending: str = "") -> tuple[str, ...]:
        """Return names of outputs, with the half before and an ending after each."""
        return tuple(f"{self.half} {name}{ending}".lstrip() for name in names)


def _outputs(
    model: LinearModel, motion: _Rows, acceleration_by_input: Array
) -> tuple[tuple[str, ...], Array, Array]:
    """Return the names of the outputs and their rows of C and D."""
    displacement, rate, acceleration = motion
    shape, own = acceleration.shape[:-2], _own_coordinates(model)
    blocks: list[_Block] = []
    for part in _hubs(model):
        hub = part.to_rotor[..., : len(HUB), :]
        loads, loads_by_input = _hub_loads(part, motion, acceleration_by_input, model.feedback)
        known = _with_displacement(hub, displacement)
        blocks += [
            (part.names(tuple(HUB[axis] for axis in known)), (hub @ displacement)[..., known, :], None),
            (part.names(HUB, " rate"), hub @ rate, None),
            (part.names(HUB, " acceleration"), hub @ acceleration, hub @ acceleration_by_input),
            (part.names(LOADS), loads, loads_by_input),
        ]
    blocks += _own_motion(model, own, displacement, rate)
    names = tuple(name for part, _, _ in blocks for name in part)
    rows = [part for _, part, _ in blocks]
    none = np.zeros((1, len(model.inputs)))
    feedthrough = [none.repeat(len(part), axis=0) if d is None else d for part, _, d in blocks]
    return names, _stacked(rows, shape), _stacked(feedthrough, shape)


def _with_displacement(hub: Array, displacement: Array) -> list[int]:
    """Return the hub axes whose displacement follows from states: no coordinate that has a rate alone moves them."""
    free = ~displacement.any(axis=-1)
    moved = (hub[..., free] != 0).any(axis=-1)
    return [axis for axis in range(len(HUB)) if not moved[..., axis].any()]


def _stacked(parts: list[Array], shape: tuple[int, ...]) -> Array:
    """Return matrices with the same columns one below the other, at each point of a batch."""
    return np.concatenate([np.broadcast_to(p, (*shape, *p.shape[-2:])) for p in parts], axis=-2)


def _own_coordinates(model: LinearModel) -> list[int]:
    """Return the places of the coordinates of the rotor, or of both rotors."""
    rotor = model if model.rotor is None else model.rotor
    own = rotor.dofs[len(HUB) :]
    halves = [half for half in HALVES if half in model.symmetry] or [""]
    names = {in_half(half, name) if half else name for half in halves for name in own}
    return [place for place, name in enumerate(model.dofs) if name in names]


def _own_motion(model: LinearModel, own: list[int], displacement: Array, rate: Array) -> list[_Block]:
    """Return the rotor's own displacements, and the rate of a coordinate that is not a state at every point."""
    held = held_coordinates(model)
    mixed = [held[state] for state, _ in lacking_states(model)]
    moved = [place for place in own if place in held]
    turning = [place for place in own if place not in held or place in mixed]
    return [
        (tuple(model.dofs[p] for p in moved), displacement[moved], None),
        (tuple(f"{model.dofs[p]} rate" for p in turning), rate[turning], None),
    ]


def _hub_loads(
    part: _Loads, motion: _Rows, acceleration_by_input: Array, feedback: Feedback | None
) -> tuple[Array, Array]:
    """Return the perturbation of the rotor's loads on the hub by states and inputs.

    These loads are minus the hub rows of the rotor alone, plus the hub rows of its inputs, to which control loops add.
    """
    displacement, rate, acceleration = motion
    rows = part.rows
    if feedback is not None:
        rows = {name: rows[name] - part.inputs @ own for name, own in zip("KCM", feedback, strict=True)}
    loads = -(rows["M"] @ acceleration + rows["C"] @ rate + rows["K"] @ displacement)
    return loads, part.inputs - rows["M"] @ acceleration_by_input


def _hubs(model: LinearModel) -> list[_Loads]:
    """Return the loads on the hub of a rotor, or on both hubs by half of the motion."""
    if model.left_hub is not None:
        rows, inputs = {name: hub_rows(model, name) for name in "MCK"}, hub_inputs(model)
        return [
            _Loads(half, to_rotor, {name: rows[name][half] for name in "MCK"}, _of_all(model, inputs[half]))
            for half, to_rotor in halves_of(model)
        ]
    rotor, to_rotor = _rotor_alone(model)
    if rotor.dofs[: len(HUB)] != HUB:
        raise InputError(
            "dofs", ", ".join(rotor.dofs), "must begin with the hub's, from which its loads follow"
        )
    assert rotor.B is not None  # the mounted model has inputs, so its rotor has too
    of_hub = {name: getattr(rotor, name)[..., : len(HUB), :] @ to_rotor for name in "MCK"}
    return [_Loads("", to_rotor, of_hub, _of_all(model, rotor.B[..., : len(HUB), :]))]


def _of_all(model: LinearModel, inputs: Array) -> Array:
    """Return the hub rows of all inputs of a model (..., 6, inputs): those of its support do not load the rotor."""
    more = len(model.inputs) - inputs.shape[-1]
    return np.pad(inputs, [(0, 0)] * (inputs.ndim - 1) + [(0, more)])


def _rotor_alone(model: LinearModel) -> tuple[LinearModel, Array]:
    """Return the rotor alone, and its coordinates per unit of each coordinate of a model that may be mounted."""
    if model.rotor is None or model.hub is None:
        return model, np.eye(len(model.dofs))
    own = model.rotor.dofs[len(HUB) :]
    # A coordinate that a submodel leaves out stays at zero.
    rows = (np.array(own, dtype=object)[:, None] == np.array(model.dofs, dtype=object)).astype(float)
    rows = np.broadcast_to(rows, (*model.hub.shape[:-2], *rows.shape))
    return model.rotor, np.concatenate([model.hub, rows], axis=-2)
