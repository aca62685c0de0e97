"""A whole rotor: which functions of the other steps are called, what is summed, and what goes into the fixed frame.

Nothing is derived here. Each assembly below is a generated function that calls others; `made` finds these and their
arguments. The matrices of one blade in rotating axes come first, the sum over the blades after them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import sympy as sp

from derive import airloads, flap_lag_springs, offset_mass, pitch, section
from derive import kinematics as kin
from derive import symbols as s
from derive.function import Function
from derive.symbols import QUANTITIES

# Of one segment of the blade; everything else holds for the whole blade.
OF_SEGMENTS = frozenset({kin.beyond_flap_hinge, kin.beyond_lag_hinge, *airloads.MOMENTS.values()})

# What blades have whose masses or aerodynamic centres lie beside the pitch axis; zero on the axis.
OFFSETS = frozenset(
    {
        *offset_mass.DATA,
        *offset_mass.INTEGRALS.values(),
        section.center_along,
        section.center_below,
        *(airloads.MOMENTS["fd_spin", power] for power in airloads.POWERS),
    }
)

# What many rotors do not have; zero where it is not given.
OPTIONAL = OFFSETS | {
    *s.HINGE_LINKAGES,
    s.pitch_flap_coupling,
    s.pitch_lag_coupling,
    s.drive_inertia,
    s.drive_damping,
    s.shaft_stiffness,
    flap_lag_springs.cyclic_flap_stiffness_excess,
    pitch.cyclic_control_stiffness_excess,
}


@dataclass(frozen=True)
class Call:
    """A call of a generated function; `drops` says that the function is another one in another set of equations."""

    function: Function
    drops: bool

    @property
    def results(self) -> tuple[str, ...]:
        """Return the names of the values that the function gives; none for a matrix."""
        if isinstance(self.function, Assembly):
            return tuple(self.function.results)
        return tuple(map(str, self.function.values))


class Code(str):
    """A term that is no call: what it is in the generated function, such as a field of an earlier result."""

    __slots__ = ()


@dataclass(frozen=True)
class Line:
    """A result, and the calls or fields of earlier results whose sum it is."""

    result: str
    terms: tuple[Call | Code, ...]


@dataclass(frozen=True)
class Assembly(Function):
    """A generated function that calls others.

    results are the returned matrices with units, meaning and shape; without them the last line is returned. `segments`
    says that all calls are of segments, so that quantities of the whole blade get an axis for these.
    """

    lines: tuple[Line, ...] = ()
    results: dict[str, str] = field(default_factory=dict)
    segments: bool = False

    @property
    def calls(self) -> list[Call]:
        return [term for line in self.lines for term in line.terms if isinstance(term, Call)]

    @property
    def chooses_equations(self) -> bool:
        """Say whether any called function is another one in another set of equations."""
        return any(
            call.drops or (isinstance(call.function, Assembly) and call.function.chooses_equations)
            for call in self.calls
        )

    @property
    def needed(self) -> list[sp.Symbol]:
        """Return the arguments of all calls that no earlier call gives, in the order of declaration."""
        wanted = {symbol for call in self.calls for symbol in call.function.arguments}
        made = {name for call in self.calls for name in call.results}
        return [symbol for symbol in QUANTITIES if symbol in wanted and symbol.name not in made]


_BLADE = "of one blade in rotating axes, (..., 12, 12)"
_ROTOR = "of the rotor in the fixed frame, (..., 18, 18)"
_GUSTS = "[N s/m, N s] loads of gusts along i, j, k, (..., 12, 3)"
_MASS, _DAMPING, _STIFFNESS = "[kg, kg m, kg m^2]", "[N s/m, N s, N m s]", "[N/m, N, N m]"

Lines = dict[str, tuple[str, ...]]  # a result and the functions, by module and name, whose sum it is


@dataclass(frozen=True)
class Recipe:
    """What an assembly is made of, before the functions are found: see `Assembly`."""

    summary: str
    lines: Lines
    results: dict[str, str] = field(default_factory=dict)
    blade_matrices: tuple[str, ...] = ()
    segments: bool = False


BLADE_AIRLOADS = Recipe(
    "Airload damping and stiffness of one blade, and loads of gusts on it, from the loads of its segments.",
    {
        "geometry": ("airloads.segment_geometry",),
        "virtual_motion": ("airloads.virtual_motion",),
        "rate_motion": ("airloads.rate_motion",),
        "displacement_motion": ("airloads.displacement_motion",),
        "geometric_stiffness": ("airloads.geometric_stiffness",),
        "gust_motion": ("airloads.gust_motion",),
        "load_derivatives": ("airloads.load_derivatives",),
        "damping": ("airloads.damping",),
        "stiffness": ("airloads.stiffness",),
        "gusts": ("airloads.gust_loads",),
    },
    {
        "damping": f"{_DAMPING} airload damping {_BLADE}",
        "stiffness": f"{_STIFFNESS} airload stiffness {_BLADE}",
        "gusts": _GUSTS,
    },
    segments=True,
)
BLADE_MATRICES = Recipe(
    "Mass, damping and stiffness of one blade in rotating axes with its airloads, and loads of gusts on it.",
    {
        "integrals": ("inertia.trim_integrals",),
        "beside_axis": ("offset_mass.trim_integrals",),
        "air": ("rotor.blade_airloads",),
        "mass": ("inertia.mass", "offset_mass.mass", "pitch.mass"),
        "damping": ("inertia.gyroscopic", "offset_mass.gyroscopic", "pitch.damping", Code("air.damping")),
        "stiffness": (
            "inertia.centrifugal_stiffness",
            "offset_mass.centrifugal_stiffness",
            "pitch.stiffness",
            "flap_lag_springs.stiffness",
            Code("air.stiffness"),
        ),
        "gusts": (Code("air.gusts"),),
    },
    {
        "mass": f"{_MASS} mass {_BLADE}",
        "damping": f"{_DAMPING} damping and gyroscopic matrix {_BLADE}",
        "stiffness": f"{_STIFFNESS} stiffness {_BLADE}",
        "gusts": _GUSTS,
    },
)
FIXED_FRAME = Recipe(
    "M, C, K and B of N blades in the fixed frame, with engine and shaft, from the matrices of one blade.",
    {
        "M": ("multiblade.mass", "drive_train.mass"),
        "C": ("multiblade.damping", "drive_train.damping"),
        "K": ("multiblade.stiffness", "drive_train.stiffness", "multiblade.cyclic_restraint"),
        "swashplate": ("multiblade.swashplate_loads",),
        "gust": ("multiblade.gust_loads",),
        "B": (Code("_beside(swashplate, gust)"),),
    },
    {
        "M": f"{_MASS} mass {_ROTOR}",
        "C": f"{_DAMPING} damping and gyroscopic matrix {_ROTOR}",
        "K": f"{_STIFFNESS} stiffness {_ROTOR}",
        "B": "[N/rad, N m/rad, N s/m, N s] loads per unit of swashplate and gusts, `coordinates.INPUTS`, (..., 18, 6)",
    },
    blade_matrices=("mass", "damping", "stiffness", "gusts"),
)
MATRICES = Recipe(
    "M, C, K and B of a whole rotor, from its quantities in trim and the radial moments of its section loads.",
    {"blade": ("rotor.blade_matrices",), "rotor": ("rotor.fixed_frame",)},
)


def made(lines: Lines, find: Callable[[str], Call]) -> tuple[Line, ...]:
    """Return the lines with the functions that they call."""
    return tuple(
        Line(result, tuple(term if isinstance(term, Code) else find(term) for term in terms))
        for result, terms in lines.items()
    )
