"""Modelling options: one keyword each, the same everywhere, the first choice is the default."""

from __future__ import annotations

from dataclasses import dataclass

from proprotor.equation_set import EQUATION_SETS, EquationSet
from proprotor.errors import InputError, unknown_name

CHOICES: dict[str, tuple] = {
    "equations": tuple(EQUATION_SETS),
    "pitch": ("dynamic", "coupling", "rigid"),
    "airloads": ("full", "lift-slope", "none"),
    "compressibility": (True, False),
    "rotor_speed": ("windmilling", "constant"),
}
LOCKABLE = ("flap", "lag", "pitch", "gimbal")


@dataclass(frozen=True, kw_only=True)
class Options:
    """Choices of the model.

    Parameters
    ----------
    equations : "consistent" or "published"
        Every first-order term, or what AIAA-2002-1604 keeps of the perturbation equations (the trim is the same); an
        `EquationSet` of generated modules stands for itself.
    pitch : "dynamic", "coupling" or "rigid"
        Pitch equations kept; replaced by the couplings of Eqs. 36 and 37 in the airloads' pitch; or left out.
    airloads : "full", "lift-slope" or "none"
        Perturbation airloads: all, those proportional to the lift slope, or none. The trim has them all.
    compressibility : bool
        Prandtl-Glauert factor on lift and moment.
    rotor_speed : "windmilling" or "constant"
        Whether the rotor speed perturbation is a degree of freedom.
    locked : collection of "flap", "lag", "pitch", "gimbal"
        Coordinates removed; they stay at zero in trim too.

    Raises
    ------
    InputError
        For a choice that does not exist, with those that do.
    """

    equations: str | EquationSet = "consistent"
    pitch: str = "dynamic"
    airloads: str = "full"
    compressibility: bool = True
    rotor_speed: str = "windmilling"
    locked: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name, choices in CHOICES.items():
            value = getattr(self, name)
            if isinstance(value, EquationSet):
                continue
            if value not in choices:
                raise InputError(name, value, f"must be one of {', '.join(map(str, choices))}")
        locked = (self.locked,) if isinstance(self.locked, str) else tuple(self.locked)
        for name in locked:
            if name not in LOCKABLE:
                raise InputError("locked", name, f"must be of {', '.join(LOCKABLE)}")
        object.__setattr__(self, "locked", locked)

    @property
    def equation_set(self) -> EquationSet:
        """The generated modules of the chosen equations."""
        return self.equations if isinstance(self.equations, EquationSet) else EQUATION_SETS[self.equations]

    @property
    def pitch_is_free(self) -> bool:
        """Whether the pitch equations are part of the model."""
        return self.pitch == "dynamic" and "pitch" not in self.locked


def parse_options(options: dict) -> Options:
    """`Options` from keywords.

    Raises
    ------
    InputError
        For an unknown keyword, with the known ones.
    """
    known = (*CHOICES, "locked")
    for name in options:
        if name not in known:
            raise InputError(name, options[name], f"{unknown_name(name, known, 'option')} (options: {', '.join(known)})")
    return Options(**options)
