"""Texts of a deck whose meaning depends on the file in which they are written."""

from __future__ import annotations

from pathlib import Path

from proprotor.errors import InputError
from proprotor.units import to_si


class FileName(str):
    """The name of a file as a deck has it, with the folder from which the name starts."""

    folder = Path()

    @classmethod
    def inside(cls, folder: Path, name: str) -> FileName:
        """Return a name that starts from a folder."""
        file = cls(name)
        file.folder = folder
        return file


class FilePath(str):
    """The path of a file, the SI value of a field that names a file."""


class PerRevolution(str):
    """A frequency per revolution as a deck has it, with the rotor speed (rad/s) of the file in which it is written."""

    rotor_speed: float

    @classmethod
    def of(cls, text: str, rotor_speed: float) -> PerRevolution:
        """Return a frequency per revolution of a rotor speed."""
        frequency = cls(text)
        frequency.rotor_speed = rotor_speed
        return frequency

    @property
    def per_second(self) -> str:
        """The same frequency in rad/s; unchanged text that is not a number."""
        try:
            return f"{to_si(self.removesuffix('/rev'), '') * self.rotor_speed!r} rad/s"
        except InputError:
            return str(self)
