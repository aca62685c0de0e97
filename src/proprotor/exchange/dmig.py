"""A rotor as direct matrix input of Nastran: M, B and K at one airspeed, for SOL 107, 110 and 145.

The file has entries DMIG on six components of the hub's grid point and on one extra point (EPOINT) for each coordinate
of the rotor, in the units of the run. The matrices are not symmetric, so that they enter as M2PP, B2PP and K2PP.
Structure and rotor meet at the grid point alone, as `proprotor.model.mount` couples them.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping

import numpy as np

from proprotor.errors import InputError, check_finite
from proprotor.files.output import check_place, write_whole
from proprotor.model.linear_model import LinearModel
from proprotor.model.mount import check_hub
from proprotor.model.stamp import line, of_model
from proprotor.nastran.dmig import Coordinate, write_dmig
from proprotor.nastran.found import COMPONENTS
from proprotor.rotor.motions import HUB
from proprotor.support import hub_components
from proprotor.support.nastran import AIRCRAFT_AXES
from proprotor.typing import Array

MATRICES = {"M": "MROTOR", "C": "BROTOR", "K": "KROTOR"}  # names of the file by those of the model
_ENDING = ".bdf"
_LARGEST_POINT = 99_999_999  # eight characters


def save_dmig(
    model: LinearModel,
    path: str | os.PathLike[str],
    *,
    grid: int,
    first_extra_point: int,
    hub: Mapping[str, str] | None = None,
    length_unit: float = 1.0,
    mass_unit: float = 1.0,
) -> None:
    """Write a rotor at one airspeed as matrices MROTOR, BROTOR and KROTOR of Nastran.

    Case control takes the matrices with M2PP = MROTOR, B2PP = BROTOR and K2PP = KROTOR. The structure of the run must
    be without the rotor, since all masses of the rotor are in the file. The airloads are those of the airspeed and
    density of the model, whatever the run has.

    Parameters
    ----------
    model : LinearModel
        At one airspeed: a rotor alone, or a rotor on a support, which is left out. Of two rotors, the right one.
    path : str or path
        Ends in ``.bdf``. A file that exists is replaced, and stays as it is when writing fails.
    grid : int
        The grid point at the hub, with six components in its output coordinate system.
    first_extra_point : int
        Number of the first extra point; the coordinates of the rotor take one after another from there.
    hub : mapping of str to str, optional
        For each of x, y, z, alpha_x, alpha_y, alpha_z one of T1 … R3, with "-" before a component that points the other
        way; `proprotor.support.nastran.AIRCRAFT_AXES` by default.
    length_unit, mass_unit : float
        m and kg per unit of the run, such as 0.0254 and 175.1268 for inches and lbf s²/in.

    Raises
    ------
    InputError
        When the model has more than one airspeed, has control loops, failed or has no hub, a number is no point or
        unit, a component of the hub is missing, or the path does not end in ``.bdf`` or cannot be written.
    OSError
        When the file cannot be written.
    """
    check_place(path, _ENDING)
    if model.feedback is not None:
        rule = "are not among the rotor's matrices: take the model without them, case.with_control()"
        raise InputError("model", "its control loops", rule)
    rotor = model if model.rotor is None else model.rotor
    _check(rotor, grid, first_extra_point)
    check_finite("length_unit", length_unit, "above zero")
    check_finite("mass_unit", mass_unit, "above zero")
    coordinates, units = _coordinates(rotor, grid, first_extra_point, hub, length_unit)
    energy = mass_unit * length_unit**2
    matrices = {own: units[:, None] * getattr(rotor, name) * units / energy for name, own in MATRICES.items()}
    lines = [*_heading(model, rotor, coordinates, units, length_unit, mass_unit)]
    for name, matrix in matrices.items():
        lines += write_dmig(name, matrix, coordinates)
    text = "".join(f"{one}\n" for one in lines)
    write_whole(path, lambda file: file.write(text.encode("ascii", "replace")))


def _check(rotor: LinearModel, grid: int, first_extra_point: int) -> None:
    """Refuse a model that is not one rotor at one point, and numbers that are no points."""
    check_hub("model", rotor)
    if rotor.M.ndim > 2:
        raise InputError("model", f"{rotor.M.shape[:-2]} points", "must be at one airspeed")
    if reason := str(rotor.trim.reason):
        raise InputError("airspeed", f"{float(rotor.airspeed):.6g} m/s", reason)
    count = len(rotor.dofs) - len(HUB)
    for name, point, largest in (
        ("grid", grid, _LARGEST_POINT),
        ("first_extra_point", first_extra_point, _LARGEST_POINT - count + 1),  # others follow
    ):
        if type(point) is bool or not isinstance(point, int | np.integer) or not 1 <= point <= largest:
            raise InputError(name, point, f"must be a number of a point, from 1 to {largest}")
    last = first_extra_point + count - 1
    if first_extra_point <= grid <= last:
        raise InputError("grid", grid, f"must not be one of the extra points, {first_extra_point} to {last}")


def _coordinates(
    rotor: LinearModel, grid: int, first: int, hub: Mapping[str, str] | None, length_unit: float
) -> tuple[list[Coordinate], Array]:
    """Return point and component of each coordinate, and the coordinate in SI per unit of Nastran's."""
    components = hub_components(AIRCRAFT_AXES if hub is None else hub, COMPONENTS)
    if len({name for name, _, _ in components}) < len(components):
        raise InputError("hub", None, "must name six different components")
    places = [(grid, COMPONENTS.index(name) + 1) for name, _, _ in components]
    places += [(first + number, 0) for number in range(len(rotor.dofs) - len(HUB))]
    signs = [sign * (length_unit if axis in ("x", "y", "z") else 1.0) for _, sign, axis in components]
    return places, np.array(signs + [1.0] * (len(places) - len(signs)))


def _heading(
    model: LinearModel,
    rotor: LinearModel,
    coordinates: list[Coordinate],
    units: Array,
    length_unit: float,
    mass_unit: float,
) -> Iterator[str]:
    """Yield comments on what the file holds, and the extra points."""
    yield f"$ Rotor at {float(rotor.airspeed):.6g} m/s. {line(of_model(model))}".rstrip()
    yield f"$ Units of the run: {length_unit:.10g} m, {mass_unit:.10g} kg, s, rad."
    if warning := str(rotor.trim.warning):
        yield f"$ Doubtful: {warning}"
    yield "$ Case control: M2PP = MROTOR, B2PP = BROTOR, K2PP = KROTOR"
    for name, unit, (point, component) in zip(rotor.dofs, units, coordinates, strict=True):
        if component:
            sign = "-" if unit < 0 else ""
            yield f"$ {point} {sign}{COMPONENTS[component - 1]}: {name} of the hub"
        else:
            yield f"$ {point}: {name}"
            yield f"{'EPOINT':8}{point:8d}"
