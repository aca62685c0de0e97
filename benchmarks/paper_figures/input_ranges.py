"""Ranges of the doubtful inputs of the bundled decks, each with a reason.

Ranges are judgements of what an input could be, not scatter of measurements. Published inputs have no range; neither
have derived inputs whose effect on the XV-15's boundary is below half a knot (offset of the flap hinge, blade mass and
first moment: `python -m benchmarks.xv15_inputs`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import proprotor as pp

_WING = ("beam", "chord", "torsion")
_FACTOR = "×"


@dataclass(frozen=True, kw_only=True)
class InputRange:
    """The range of an input, and the reason for the range.

    Attributes
    ----------
    name : str
        For tables.
    paths : tuple of str
        Numbers of the deck that vary together.
    low, high : float
        In `unit`.
    unit : str
        Unit of `low` and `high`; ``"×"`` for factors on the deck's numbers.
    reason : str
        Why the input may be anywhere in the range.
    logarithmic : bool
        Whether all ratios between the ends are equally likely, and not all differences.
    """

    name: str
    paths: tuple[str, ...]
    low: float
    high: float
    unit: str
    reason: str
    logarithmic: bool = False

    @property
    def inputs(self) -> str | tuple[str, ...]:
        """What varies, as `proprotor.sampling` names it."""
        return self.paths[0] if len(self.paths) == 1 else self.paths

    @property
    def distribution(self) -> Any:
        """The range, as `proprotor.sampling` takes it."""
        if self.unit == _FACTOR and len(self.paths) == 1:
            return pp.sampling.Relative(self.low, self.high, self.logarithmic)
        ends = (
            (self.low, self.high) if self.unit == _FACTOR else (self._text(self.low), self._text(self.high))
        )
        return (pp.sampling.LogRange if self.logarithmic else pp.sampling.Range)(*ends)

    def _text(self, end: float) -> str:
        return f"{end} {self.unit}".strip()

    def __str__(self) -> str:
        unit = "times" if self.unit == _FACTOR else self.unit
        return f"{self.low:g} to {self.high:g} {unit}".strip()


def _of_wing(
    quantity: str, low: float, high: float, reason: str, logarithmic: bool = False
) -> Iterator[InputRange]:
    """Yield a range for each wing mode, all independent."""
    for mode in _WING:
        path = f"support.modes[{mode}].{quantity}"
        yield _one(f"{mode}: {quantity.replace('_', ' ')}", path, low, high, _FACTOR, reason, logarithmic)


def _one(
    name: str, path: str, low: float, high: float, unit: str, reason: str, logarithmic: bool = False
) -> InputRange:
    """Return the range of a single number of the deck."""
    return InputRange(
        name=name, paths=(path,), low=low, high=high, unit=unit, reason=reason, logarithmic=logarithmic
    )


# The end slope also swings the mast: y = -h s, so the factors of h and s multiply in y.
_GEOMETRY = (
    InputRange(
        name="mast height h",
        paths=("support.modes[torsion].x", "support.modes[chord].y"),
        low=0.8,
        high=1.2,
        unit="×",
        reason="height of the hub above the elastic axis of the wing is not published",
    ),
    InputRange(
        name="end slope s of the wing",
        paths=("support.modes[beam].alpha_z", "support.modes[chord].alpha_x", "support.modes[chord].y"),
        low=0.8,
        high=1.2,
        unit="×",
        reason="a tapered wing that carries a nacelle is no uniform cantilever with a load at its tip",
    ),
)
_SECTIONS = (
    _one("zero-lift angle", "rotor.airfoil.zero_lift_angle", -2, 0, "deg", "sections may be cambered"),
    _one("section moment", "rotor.airfoil.moment", -0.03, 0, "", "sections may be cambered"),
)
_AIR = (
    _one("density", "operation.density", 0.95, 1.05, "×", "temperature and pressure in the tunnel"),
    _one("speed of sound", "operation.speed_of_sound", 0.97, 1.03, "×", "temperature in the tunnel"),
)

XV15 = (
    *_of_wing(
        "generalized_mass",
        0.7,
        1.3,
        "only totals are known: nacelle and rotor of a later aircraft are 13 % more",
    ),
    *_of_wing("frequency", 0.9, 1.1, "recalled; frequencies change with how a wing is mounted"),
    *_of_wing(
        "damping_ratio", 0.0, 2.0, "recalled; measured structural damping scatters by as much as it is"
    ),
    *_GEOMETRY,
    _one(
        "control stiffness",
        "rotor.control_stiffness",
        5000,
        22400,
        "ft*lbf/rad",
        "calibrated; from K_P_zeta = -0.3 at a lower airspeed than here to the later rotor of NASA/TP-2004-212262",
        logarithmic=True,
    ),
    _one(
        "structural pitch offset",
        "rotor.structural_pitch_offset",
        10,
        25,
        "deg",
        "calibrated; built-in twist where the blade bends",
    ),
    _one(
        "pitch inertia",
        "rotor.pitch_inertia",
        0.4,
        0.7,
        "slug*ft**2",
        "radius of gyration about a quarter chord",
    ),
    _one("chord of the blade", "rotor.chord", 14, 14.6, "inch", "the drawing and the Lock number differ"),
    _one("profile drag", "rotor.airfoil.drag", 0.004, 0.010, "", "smooth to rough attached airfoil"),
    *_SECTIONS,
    *_AIR,
)

_LIKENESS = "taken over from the XV-15 by likeness: "
WRATS = (
    *_of_wing("generalized_mass", 0.75, 1.5, _LIKENESS + "the pylon was modified more than once", True),
    *_of_wing("frequency", 0.75, 1.25, _LIKENESS + "wings of this class differ by about a quarter"),
    *_of_wing("damping_ratio", 0.0, 2.0, _LIKENESS + "structural damping scatters by as much as it is"),
    *_GEOMETRY,
    _one(
        "precone", "rotor.precone", 1.5, 3.5, "deg", _LIKENESS + "set for hover, by the thrust of the rotor"
    ),
    _one(
        "control stiffness",
        "rotor.control_stiffness",
        0.36,
        2.0,
        "×",
        _LIKENESS + "from the value calibrated for the XV-15 to twice the later rotor's",
        True,
    ),
    _one(
        "structural pitch offset",
        "rotor.structural_pitch_offset",
        0,
        25,
        "deg",
        _LIKENESS + "where the blade bends is not published",
    ),
    _one("hub spring", "rotor.gimbal_stiffness", 0.5, 2.0, "×", _LIKENESS + "another hub", True),
    _one("pitch inertia", "rotor.pitch_inertia", 0.5, 2.0, "×", _LIKENESS + "another blade", True),
    _one("profile drag", "rotor.airfoil.drag", 0.006, 0.015, "", "low Reynolds number of a small model"),
    *_SECTIONS,
    *_AIR,
)
V22 = (
    *WRATS,
    _one("rotor speed", "operation.rotor_speed", 740, 770, "rpm", "what counts as 100 % is not published"),
)

RANGES = {
    "xv15-uncoupled": XV15,
    "xv15-mass-distribution": XV15,
    "v22-fifth-scale": V22,
    "wrats-742-off": WRATS,
    "wrats-888-off": WRATS,
    "wrats-770-on": WRATS,
    "wrats-888-on": WRATS,
}
