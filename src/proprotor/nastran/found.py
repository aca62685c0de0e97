"""What a file of results holds: sets of real eigenvectors at one grid point, and tables of eigenvalues."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from proprotor.typing import Array

COMPONENTS = ("T1", "T2", "T3", "R1", "R2", "R3")


class FileFault(ValueError):
    """Fault of a file, as the end of a sentence whose subject is the file."""


@dataclass
class ModeSet:
    """Real eigenvectors of one subcase, from one table of the file.

    Attributes
    ----------
    subcase : int
    table : str
        Name of the table, empty in text files.
    label : str
        What the run wrote above the eigenvectors, which tells superelements apart.
    numbers : list of int
        Number of each mode.
    eigenvalues : list of float
        ω² of each mode; NaN where the eigenvectors come without it.
    motions : list of array (6,), or None for a mode without the grid point
        Motion T1 … R3 of the grid point.
    """

    subcase: int
    table: str = ""
    label: str = ""
    numbers: list[int] = field(default_factory=list)
    eigenvalues: list[float] = field(default_factory=list)
    motions: list[Array | None] = field(default_factory=list)

    @property
    def has_grid(self) -> bool:
        """Return whether every mode has the motion of the grid point."""
        return bool(self.numbers) and all(motion is not None for motion in self.motions)

    @property
    def motion(self) -> Array:
        """Return the motion (6, modes) of the grid point."""
        return np.array(self.motions, dtype=float).T


class EigenvalueTable(NamedTuple):
    """A table of real eigenvalues: arrays (modes,) of numbers, ω² and generalised masses; subcase 0 if not told."""

    subcase: int
    numbers: Array
    eigenvalues: Array
    generalized_mass: Array


@dataclass
class Found:
    """What a file holds on a grid point.

    Attributes
    ----------
    sets : list of ModeSet
        Real eigenvectors.
    tables : list of EigenvalueTable
    has_complex : bool
        Whether the file has complex eigenvectors.
    output_system : int
        Number of the output coordinate system of the grid point (field CD of GRID); 0 for the basic one, or if the file
        does not tell.
    """

    sets: list[ModeSet] = field(default_factory=list)
    tables: list[EigenvalueTable] = field(default_factory=list)
    has_complex: bool = False
    output_system: int = 0

    def add(
        self,
        key: tuple[int, str, str],
        number: int,
        eigenvalue: float,
        motion: Array | None,
        in_pieces: bool = False,
    ) -> None:
        """Add an eigenvector to the set of its subcase, table and label, or begin a new set where numbers start anew.

        Parameters
        ----------
        key : (int, str, str)
            Subcase, table and label.
        number, eigenvalue : int, float
            Number and ω² of the mode.
        motion : array (6,) or None
            Motion of the grid point, if it is among the points of this eigenvector.
        in_pieces : bool
            Whether a number that is repeated goes on with the same eigenvector, as after a page break.
        """
        same = [one for one in self.sets if (one.subcase, one.table, one.label) == key]
        last = same[-1] if same else None
        if last and in_pieces and last.numbers[-1] == number and last.eigenvalues[-1] == eigenvalue:
            if motion is not None:
                last.motions[-1] = motion
            return
        if last is None or number <= last.numbers[-1]:
            last = ModeSet(*key)
            self.sets.append(last)
        last.numbers.append(number)
        last.eigenvalues.append(eigenvalue)
        last.motions.append(motion)
