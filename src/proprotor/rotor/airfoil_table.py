"""An airfoil from tables of lift, drag and moment against angle of attack and Mach number."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError
from proprotor.rotor.airfoil import SectionCoefficients
from proprotor.rotor.c81 import read_c81
from proprotor.rotor.c81_layouts import COEFFICIENTS, Table
from proprotor.rotor.coefficient_surface import CoefficientSurface, broken_rules
from proprotor.typing import Array

_NO_STALL = 100.0  # rad, beyond every angle


@dataclass(frozen=True, kw_only=True, eq=False)
class AirfoilTable:
    """Section coefficients interpolated in a table, with the exact derivatives of the interpolation.

    `proprotor.rotor.coefficient_surface` interpolates: smooth, exact at the nodes, without overshoot along the rows
    and columns of the table. Outside the table the coefficients continue on straight lines in angle of attack and are
    constant in Mach number (a table from -180 to 180 deg closes on itself); `warnings` says where a point lies outside.

    Parameters
    ----------
    alpha : array (n,), optional
        Angles of attack, rad, increasing within half a turn; not needed when each coefficient has its own.
    mach : array (m,), optional
        Mach numbers, increasing; a single one makes coefficients that hold at every Mach number.
    lift, drag, moment : array (n, m), or a tuple (alpha, mach, values)
        Section coefficients c_l, c_d (not negative) and c_m about the reference line, nose up, dimensionless, at the
        angles and Mach numbers of the table, or with angles and Mach numbers of their own.
    name : str
        Name of the airfoil.

    Raises
    ------
    InputError
        When the arrays do not fit each other, or an entry is not finite, out of order or out of its range.
    """

    alpha: ArrayLike | None = field(default=None, repr=False)
    mach: ArrayLike | None = field(default=None, repr=False)
    lift: ArrayLike | tuple[ArrayLike, ArrayLike, ArrayLike] = field(repr=False)
    drag: ArrayLike | tuple[ArrayLike, ArrayLike, ArrayLike] = field(repr=False)
    moment: ArrayLike | tuple[ArrayLike, ArrayLike, ArrayLike] = field(repr=False)
    name: str = ""

    def __post_init__(self) -> None:
        for name, least in COEFFICIENTS.items():
            surface = self._surfaces[name]
            for row, rule in broken_rules(surface.alpha, surface.mach, surface.values, least):
                raise InputError(name, None, f"{rule} ({f'row {row}' if row else 'mach'})")

    @classmethod
    def from_c81(
        cls,
        path: str | os.PathLike[str],
        table_name: str | None = None,
        table_reynolds: float | None = None,
    ) -> AirfoilTable:
        """Return an airfoil of a C81 file; the title in the file is the airfoil's name.

        `proprotor.rotor.c81` says which dialects are read.

        Parameters
        ----------
        path : str or path
            A C81 file.
        table_name : str, optional
            Title of the airfoil in a file of several; the first airfoil without a title.
        table_reynolds : float, optional
            Reynolds number of the table, dimensionless; needed in a file of DUST with several.

        Returns
        -------
        AirfoilTable

        Raises
        ------
        InputError
            When the file cannot be read or is not C81, with the line and the rule, or has no such table.
        """
        found = read_c81(path, table_name, table_reynolds)
        return cls(name=found.title, **found.tables)

    @property
    def tables(self) -> dict[str, Table]:
        """Angles of attack (rad), Mach numbers and values of lift, drag and moment."""
        return {name: self._table(name) for name in COEFFICIENTS}

    @property
    def contains_compressibility(self) -> bool:
        """Whether the coefficients depend on Mach number, and take no Prandtl-Glauert factor."""
        return any(len(surface.mach) > 1 for surface in self._surfaces.values())

    def coefficients(self, alpha: ArrayLike, mach: ArrayLike) -> SectionCoefficients:
        """Return coefficients and derivatives by smooth interpolation.

        Complex arguments give complex coefficients, for derivatives by a complex step.

        Parameters
        ----------
        alpha : array_like (...)
            Angle of attack, rad.
        mach : array_like (...)
            Mach number of the section, dimensionless.

        Returns
        -------
        SectionCoefficients
            Coefficients, dimensionless, and their derivatives with angle (1/rad) and Mach number, of the
            broadcast shape.
        """
        alpha, mach = np.broadcast_arrays(alpha, mach)
        with np.errstate(invalid="ignore"):  # NaN gives NaN
            parts = [self._surfaces[name].at(alpha, mach) for name in COEFFICIENTS]
        return SectionCoefficients(*(number for part in parts for number in part))

    def warnings(self, alpha: ArrayLike, mach: ArrayLike) -> dict[str, Array]:
        """Return where the coefficients are doubtful, and why.

        Stall begins at the first maximum of the lift curve above the angle nearest zero, and at the first
        minimum below that angle; between the columns of the table these angles are linear in Mach number.

        Parameters
        ----------
        alpha : array_like (...)
            Angle of attack, rad.
        mach : array_like (...)
            Mach number of the section, dimensionless.

        Returns
        -------
        dict of str to array of bool
            Masks of the broadcast shape, by reason.
        """
        alpha, mach = np.broadcast_arrays(alpha, mach)
        angle = np.real(self._surfaces["lift"].turned(alpha))
        lowest, highest = (np.interp(np.real(mach), *stall) for stall in self._stall)
        surfaces, outside = self._surfaces.values(), "outside the airfoil table"
        return {
            "angle of attack beyond stall": (angle < lowest) | (angle > highest),
            f"angle of attack {outside}": np.any([s.beyond_alpha(alpha) for s in surfaces], axis=0),
            f"Mach number {outside}": np.any([s.beyond_mach(mach) for s in surfaces], axis=0),
        }

    @cached_property
    def _surfaces(self) -> dict[str, CoefficientSurface]:
        """Surfaces of lift, drag and moment by name."""
        return {name: CoefficientSurface(*self._table(name)) for name in COEFFICIENTS}

    def _table(self, name: str) -> Table:
        """Return angles, Mach numbers and values of one coefficient as arrays of matching shapes."""
        given = getattr(self, name)
        parts = given if isinstance(given, tuple) and len(given) == 3 else (self.alpha, self.mach, given)
        try:
            alpha, mach, values = (np.array(part, dtype=float) for part in parts)
        except (TypeError, ValueError):
            raise InputError(name, None, "must be numbers at every angle of attack and Mach number") from None
        if alpha.ndim != 1 or mach.ndim != 1 or len(alpha) < 2 or len(mach) < 1:
            raise InputError(name, None, "must have two angles of attack or more and a list of Mach numbers")
        if values.shape != (len(alpha), len(mach)):
            rule = f"must have {len(alpha)} rows, one for each angle, and {len(mach)} columns of Mach numbers"
            raise InputError(name, f"array of shape {values.shape}", rule)
        return alpha, mach, values

    @cached_property
    def _stall(self) -> tuple[tuple[Array, Array], ...]:
        """Mach numbers with the angle of stall below zero, and Mach numbers with the angle of stall above zero."""
        lift = self._surfaces["lift"]
        start = int(np.argmin(np.abs(lift.alpha)))
        rises = np.diff(lift.values, axis=0) > 0
        below = -_first_stop(rises[:start][::-1], -lift.alpha[start:0:-1])
        above = _first_stop(rises[start:], lift.alpha[start:-1])
        return (lift.mach, below), (lift.mach, above)


def _first_stop(rises: Array, angles: Array) -> Array:
    """Return the angle (m,) where the first step (n, m) that does not rise begins; `_NO_STALL` if all steps rise."""
    stops = np.vstack([~rises, np.ones(rises.shape[1], dtype=bool)])
    return np.asarray(np.append(angles, _NO_STALL)[stops.argmax(axis=0)])
