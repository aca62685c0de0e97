"""A support from the normal modes in a universal file, of a test (GVT) or of a finite-element code.

Frequencies, modal masses and measured damping stand with the shapes. A file of finite elements has six motions at the
node of the hub. A test has translations of accelerometers alone: the hub's motion is then that of the rigid body to
which measured nodes around it belong, by least squares.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError
from proprotor.files.text import read_text
from proprotor.support.matrix_files import LARGEST_UNIT
from proprotor.support.modal_reduction import per_mode
from proprotor.support.normal_modes import TRANSLATION, NormalModes, motion_of_hub
from proprotor.support.universal_file import Mode, UniversalFault, UniversalFile, universal_file
from proprotor.typing import Array

_COMPONENTS = ("X", "Y", "Z", "RX", "RY", "RZ")
# The hub axes (I up, J outboard, K forward) in the usual axes of an aircraft: X aft, Y to the right, Z up.
AIRCRAFT_AXES = {"x": "Z", "y": "Y", "z": "-X", "alpha_x": "RZ", "alpha_y": "RY", "alpha_z": "-RX"}
_LARGEST = 500_000_000  # bytes
_NOT_RIGID = 0.2  # of the motion of nodes in a mode, left by the best rigid body
_FLAT = 1e-6  # of the largest singular value: nodes on a line fix no rotation about it


def universal_modes(
    file: str | os.PathLike[str],
    node: int,
    *,
    includes_rotor: bool | str,
    rigid_nodes: Sequence[int] = (),
    shaft: str = "held",
    carries: str = "one rotor",
    damping_ratio: ArrayLike | None = None,
    modes: int | None = None,
    hub: Mapping[str, str] | None = None,
    length_unit: float | None = None,
    mass_unit: float | None = None,
    names: Sequence[str] | None = None,
) -> NormalModes:
    """Return the real normal modes of a universal file as a support.

    Parameters
    ----------
    file : str or path
        A text file with datasets 55 or 2414 of normal modes.
    node : int
        The node at the hub.
    includes_rotor, shaft : bool or str, str
        How the structure had the rotor on, as for `proprotor.support.normal_modes.NormalModes`.
    rigid_nodes : sequence of int
        Measured nodes that move with the hub as one rigid body, three or more that are not on a line, for a file with
        translations alone. Their positions and that of the hub's node must be in the file (dataset 15 or 2411).
    carries : "one rotor" or "two rotors"
        What the structure carries, as for `proprotor.support.nastran.nastran_modes`.
    damping_ratio : float or array, optional
        Fraction of critical damping of the lowest modes, the last value for all modes above; by default those of the
        file, viscous damping and half of the hysteretic one.
    modes : int, optional
        How many of the lowest modes to keep; by default all.
    hub : mapping of str to str, optional
        For each of x, y, z, alpha_x, alpha_y, alpha_z one of X, Y, Z, RX, RY, RZ, with "-" before a component that
        points the other way; `AIRCRAFT_AXES` by default.
    length_unit, mass_unit : float, optional
        m and kg per unit of the file; by default from its dataset 164.
    names : sequence of str, optional
        Names of the modes; by default mode_1 and so on.

    Raises
    ------
    InputError
        When the file cannot be read, is damaged or has no real modes; when a node or a modal mass is missing, when the
        file has no units and none are given, or when the nodes do not move as a rigid body.
    """
    try:
        found = universal_file(read_text(Path(file), "file", str(file), _LARGEST, encoding="latin-1"))
    except UniversalFault as fault:
        raise InputError("file", str(file), str(fault)) from None
    length, mass = _units(found, length_unit, mass_unit)
    chosen = _lowest(found, modes, file)
    at_node = np.array([_motion(mode, node, rigid_nodes, found) for mode in chosen]).T
    motion = motion_of_hub(at_node, AIRCRAFT_AXES if hub is None else hub, _COMPONENTS)
    # The coordinate of a mode is a number without unit: a translation counts lengths in the file's unit.
    motion[TRANSLATION] *= length
    measured = [mode.viscous + mode.hysteretic / 2 for mode in chosen]
    return NormalModes.from_frequencies(
        names=tuple(names) if names else [f"mode_{place}" for place in range(1, len(chosen) + 1)],
        generalized_mass=np.array([mode.mass for mode in chosen]) * mass * length**2,
        frequency=2 * np.pi * np.array([mode.frequency for mode in chosen]),
        damping_ratio=per_mode(measured if damping_ratio is None else damping_ratio, len(chosen)),
        hub=motion,
        includes_rotor=includes_rotor,
        shaft=shaft,
        carries=carries,
    )


def _units(found: UniversalFile, length_unit: float | None, mass_unit: float | None) -> tuple[float, float]:
    """Return m and kg per unit of the file: as given, or by the factors from SI in the file."""
    if found.factors is not None:
        length, force = found.factors
        if not min(length, force) > 1 / LARGEST_UNIT:
            raise InputError("file", None, "must have factors of units above zero in dataset 164")
        length_unit = 1 / length if length_unit is None else length_unit
        mass_unit = length / force if mass_unit is None else mass_unit
    for name, unit in (("length_unit", length_unit), ("mass_unit", mass_unit)):
        if unit is None:
            raise InputError(name, None, "must be given: the file has no units (dataset 164)")
        if not 1 / LARGEST_UNIT <= unit <= LARGEST_UNIT:
            raise InputError(name, unit, f"must be above zero, from {1 / LARGEST_UNIT:g} to {LARGEST_UNIT:g}")
    assert length_unit is not None and mass_unit is not None
    return length_unit, mass_unit


def _lowest(found: UniversalFile, count: int | None, file: str | os.PathLike[str]) -> list[Mode]:
    """Return the lowest modes of the file, with a modal mass each."""
    if not found.modes:
        rule = "has no normal modes (datasets 55 or 2414 of analysis type 2)"
        if found.complex_modes:
            rule = f"has complex modes alone ({found.complex_modes}): export real normal modes (data type 2 or 4)"
        raise InputError("file", str(file), rule)
    numbers = [mode.number for mode in found.modes]
    if twice := [number for number in numbers if numbers.count(number) > 1]:
        raise InputError("file", str(file), f"has mode {twice[0]} twice: keep one analysis in the file")
    count = len(numbers) if count is None else count
    if not 1 <= count <= len(numbers):
        raise InputError("modes", count, f"must be from 1 to {len(numbers)}, the modes of the file")
    chosen = sorted(found.modes, key=lambda mode: mode.frequency)[:count]
    for mode in chosen:
        if not mode.mass > 0:
            rule = f"has no modal mass of mode {mode.number}: export modes with their modal mass"
            raise InputError("file", str(file), rule)
    return chosen


def _motion(mode: Mode, node: int, rigid_nodes: Sequence[int], found: UniversalFile) -> Array:
    """Return the six motions of the hub's node in a mode, along the axes of the file."""
    if rigid_nodes:
        return _of_rigid_body(mode, node, rigid_nodes, found)
    if node not in mode.motions:
        rule = f"is not among the nodes of mode {mode.number}; of a test give rigid_nodes around the hub"
        raise InputError("node", node, rule)
    motion = mode.motions[node]
    if len(motion) < len(_COMPONENTS):
        rule = (
            "must be given: the file has translations alone; name measured nodes that are rigid with the hub"
        )
        raise InputError("rigid_nodes", None, rule)
    return np.array(motion)


def _of_rigid_body(mode: Mode, node: int, rigid_nodes: Sequence[int], found: UniversalFile) -> Array:
    """Return the six motions of the hub's node as a part of the rigid body that fits the translations of nodes best.

    A node at the distance r from the hub is displaced by u + θ × r.
    """
    for name in (node, *rigid_nodes):
        if name not in found.nodes:
            raise InputError("rigid_nodes", name, "has no position in the file (dataset 15 or 2411)")
    missing = [name for name in rigid_nodes if name not in mode.motions]
    if missing:
        raise InputError("rigid_nodes", missing[0], f"is not among the nodes of mode {mode.number}")
    arms = np.array([found.nodes[name] for name in rigid_nodes]) - found.nodes[node]
    size = np.abs(arms).max() or 1.0  # so that translations and rotations are of one size
    crossed = -np.cross(arms[:, None, :] / size, np.eye(3))  # r × e has the opposite of e × r
    matrix = np.concatenate([np.broadcast_to(np.eye(3), crossed.shape), np.swapaxes(crossed, 1, 2)], axis=2)
    matrix, moved = matrix.reshape(-1, 6), np.array([mode.motions[name][:3] for name in rigid_nodes]).ravel()
    values = np.linalg.svd(matrix, compute_uv=False)
    if len(values) < 6 or values[-1] < _FLAT * values[0]:
        raise InputError(
            "rigid_nodes", list(rigid_nodes), "must be three nodes or more that are not on one line"
        )
    motion = np.linalg.lstsq(matrix, moved, rcond=None)[0]
    left = np.linalg.norm(moved - matrix @ motion)
    if left > _NOT_RIGID * np.linalg.norm(moved):
        share = left / np.linalg.norm(moved)
        rule = f"must move as one rigid body; {share:.0%} of their motion in mode {mode.number} does not"
        raise InputError("rigid_nodes", list(rigid_nodes), rule)
    return np.concatenate([motion[:3], motion[3:] / size])
