"""Whirl-flutter stability of gimballed tiltrotors, with equations derived from first principles.

`import proprotor as pp` offers the names in ``__all__``, which `proprotor.interface` imports. Data flow down this list
of rooms, and a room imports only the rooms above it. docs/architecture.md describes the rooms, and the docstring of
each room is its map.

    errors typing needs units datum files   the ground: messages, types, packages and memory, SI, numbers, files
    compiled    C for a point or many: eigenvalues, trims and matrices, where there is a compiler
    records     time histories of a test: frequency and damping of their modes, with errors
    nastran     files of Nastran: modes at a grid point, matrices of a reduced structure
    rotor       a rotor trimmed in its air: section loads, operation, options, the trim
    support     the structure that carries a rotor: normal modes, beam wing, files of other programs
    control     control loops: laws, delays, actuators
    model       M, C, K, B of a rotor, of a support, and of both; the stamp that every result has
    deck        text to configuration and back
    stability   modes, their names, sweeps, flutter boundaries, sensitivities, stability maps
    responses   spectra in turbulence, outputs over time for inputs and gusts
    case        a configuration with the analyses as methods
    study       many designs: sampling, workers, uncertainty
    exchange    other programs: netCDF, MATLAB, OpenMDAO
    tables calibration plots     numbers and pictures of a result; inputs fitted to test points
    report explore   pages: a report of a case, a page with sliders
    commands    the command line
"""

from __future__ import annotations

import logging
import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from proprotor.interface import *  # noqa: F403
    from proprotor.interface import __all__ as __all__


class _Package(ModuleType):
    """The package; `import proprotor` imports no more than this file, so that `proprotor --help` answers at once."""

    def __getattr__(self, name: str) -> Any:
        special = name.startswith("__") and name != "__all__"  # Python asks for many of these
        interface = {} if special else vars(import_module("proprotor.interface"))
        if name not in interface:
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        return interface[name]

    @property
    def __version__(self) -> str:
        """The version that is installed."""
        from importlib.metadata import version  # here, because it takes longer to import than this file

        return version("proprotor")

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self.__all__})

    @property
    def study(self) -> Any:
        """The function, although a room has the same name."""
        return self.__getattr__("study")

    @study.setter
    def study(self, room: ModuleType) -> None:
        """Leave the function where the import system sets the room."""

    @property
    def explore(self) -> Any:
        """The function, although a room has the same name."""
        return self.__getattr__("explore")

    @explore.setter
    def explore(self, room: ModuleType) -> None:
        """Leave the function where the import system sets the room."""


sys.modules[__name__].__class__ = _Package
logging.getLogger(__name__).addHandler(logging.NullHandler())  # the application says where messages go
