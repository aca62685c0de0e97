"""Every symbol of the derivation: its name in the generated code, its notation, unit and meaning.

A symbol's SymPy name is the keyword argument of the generated functions, so an expression that reaches the
printer needs no renaming. The notation (LaTeX) is for people; the unit gives the dimension that
`derive.function` checks every term of every entry against.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import sympy as sp

Dimension = tuple[int, int, int]  # exponents of kg, m, s; angles are numbers
BASE_UNITS = ("kg", "m", "s")
NUMBER: Dimension = (0, 0, 0)


class MissingError(ValueError):
    """What the derivation needs and nothing declares; the message names it and the file to declare it in."""


def dimension_of_unit(unit: str) -> Dimension:
    """Dimension of a unit written from kg, m, s, rad and N, such as ``"N s/m^2"`` (everything after / divides)."""
    exponents = [0, 0, 0]
    numerator, _, denominator = unit.partition("/")
    for part, sign in ((numerator, 1), (denominator, -1)):
        for name, power in re.findall(r"([A-Za-z]+)(?:\^(\d+))?", part):
            factor = sign * int(power or 1)
            contribution = {"kg": (1, 0, 0), "m": (0, 1, 0), "s": (0, 0, 1), "N": (1, 1, -2), "rad": NUMBER}[
                name
            ]
            exponents = [total + factor * one for total, one in zip(exponents, contribution, strict=True)]
    kg, m, s = exponents
    return kg, m, s


@dataclass(frozen=True)
class Quantity:
    """A symbol with its notation, unit and meaning."""

    symbol: sp.Symbol
    latex: str
    unit: str
    meaning: str

    @property
    def dimension(self) -> Dimension:
        return dimension_of_unit(self.unit)


QUANTITIES: dict[sp.Symbol, Quantity] = {}


def how_to_declare(symbol: sp.Symbol) -> str:
    """What to do about a symbol that is no quantity."""
    return f'declare it in derive/symbols.py, {symbol} = quantity("{symbol}", notation, unit, meaning)'


def quantity(name: str, latex: str, unit: str, meaning: str) -> sp.Symbol:
    """Declare a symbol; the same name twice is an error in the derivation."""
    symbol = sp.Symbol(name, real=True)
    if symbol in QUANTITIES:
        raise ValueError(f"{name} is declared twice")
    QUANTITIES[symbol] = Quantity(symbol, latex, unit, meaning)
    return symbol


# Operation
rotor_speed = quantity("rotor_speed", r"\Omega", "rad/s", "rotational speed about +K")
airspeed = quantity("airspeed", "V", "m/s", "speed of flight along +K")
density = quantity("density", r"\rho", "kg/m^3", "air density")
speed_of_sound = quantity("speed_of_sound", "a_s", "m/s", "speed of sound")
n_blades = quantity("n_blades", "N", "", "number of blades, at least 3")

# Geometry
flap_hinge_offset = quantity("flap_hinge_offset", r"e_\beta", "m", "flap hinge from the centre of rotation")
lag_hinge_offset = quantity("lag_hinge_offset", r"e_\zeta", "m", "lag hinge from the centre of rotation")
precone = quantity("precone", r"\beta_P", "rad", "precone")
radial_station = quantity("radial_station", "r", "m", "distance along the blade from the centre of rotation")
chord = quantity("chord", "c", "m", "chord of the section")

# Mass integrals of one blade (nomenclature of the paper); the last three follow from the others
blade_mass = quantity("blade_mass", "m_b", "kg", "mass")
blade_first_moment = quantity(
    "blade_first_moment", "S_b", "kg m", "first moment about the centre of rotation"
)
blade_inertia = quantity("blade_inertia", "I_b", "kg m^2", "second moment about the centre of rotation")
flap_first_moment = quantity("flap_first_moment", r"S_\beta", "kg m", "first moment about the flap hinge")
flap_inertia = quantity("flap_inertia", r"I_\beta", "kg m^2", "second moment about the flap hinge")
lag_first_moment = quantity("lag_first_moment", r"S_\zeta", "kg m", "first moment about the lag hinge")
lag_inertia = quantity("lag_inertia", r"I_\zeta", "kg m^2", "second moment about the lag hinge")
flap_hub_inertia = quantity("flap_hub_inertia", r"I_{\beta\alpha}", "kg m^2", "flap-hub coupling inertia")
lag_hub_inertia = quantity("lag_hub_inertia", r"I_{\zeta\alpha}", "kg m^2", "lag-hub coupling inertia")
flap_lag_inertia = quantity("flap_lag_inertia", r"I_{\beta\zeta}", "kg m^2", "flap-lag coupling inertia")
pitch_inertia = quantity("pitch_inertia", r"I_\theta", "kg m^2", "pitch inertia, lumped")

# Springs, dampers, control system
flap_stiffness = quantity("flap_stiffness", r"K_\beta", "N m/rad", "flap spring at zero structural pitch")
lag_stiffness = quantity("lag_stiffness", r"K_\zeta", "N m/rad", "lag spring at zero structural pitch")
flap_outboard_fraction = quantity(
    "flap_outboard_fraction", r"R_\beta", "", "fraction of the flap flexibility outboard of the pitch bearing"
)
lag_outboard_fraction = quantity(
    "lag_outboard_fraction", r"R_\zeta", "", "fraction of the lag flexibility outboard of the pitch bearing"
)
gimbal_stiffness = quantity("gimbal_stiffness", "K_G", "N m/rad", "hub spring of the gimbal")
control_stiffness = quantity("control_stiffness", r"K_\theta", "N m/rad", "control system stiffness")
pitch_gimbal_coupling = quantity("pitch_gimbal_coupling", "K_{PG}", "", "pitch-gimbal coupling, tan(delta 3)")
kinematic_pitch_flap_coupling = quantity(
    "kinematic_pitch_flap_coupling", r"K_{P3}", "", "pitch-flap coupling of the blade's hinge, tan(delta 3)"
)
kinematic_pitch_lag_coupling = quantity(
    "kinematic_pitch_lag_coupling", r"K_{P4}", "", "pitch-lag coupling of the blade's hinge, tan(delta 4)"
)
flap_damping = quantity("flap_damping", r"C_\beta", "N m s/rad", "flap damper")
lag_damping = quantity("lag_damping", r"C_\zeta", "N m s/rad", "lag damper")
pitch_damping = quantity("pitch_damping", r"C_\theta", "N m s/rad", "pitch damper")
gimbal_damping = quantity("gimbal_damping", "C_G", "N m s/rad", "gimbal damper, non-rotating")
propeller_moment = quantity("propeller_moment", r"\pi_\theta", "", "1 with the propeller moment, 0 without")

rotating_flap_frequency = quantity(
    "rotating_flap_frequency", r"\omega_\beta", "rad/s", "rotating flap frequency at zero cone, given"
)
rotating_lag_frequency = quantity(
    "rotating_lag_frequency", r"\omega_\zeta", "rad/s", "rotating lag frequency at zero cone, given"
)
cyclic_flap_frequency = quantity(
    "cyclic_flap_frequency",
    r"\omega_{\beta c}",
    "rad/s",
    "rotating flap frequency of the cyclic motions, given",
)

# Drive train
drive_inertia = quantity(
    "drive_inertia", "J_e", "kg m^2", "inertia that turns with the rotor, at rotor speed"
)
drive_damping = quantity("drive_damping", "C_e", "N m s/rad", "damping of the rotor speed perturbation")
shaft_stiffness = quantity(
    "shaft_stiffness", "K_e", "N m/rad", "shaft to an end that turns at constant speed"
)

# Trim
coning = quantity("coning", r"\bar\beta_0", "rad", "trim elastic coning")
lag = quantity("lag", r"\bar\zeta_0", "rad", "trim lag")
elastic_pitch = quantity(
    "elastic_pitch", r"\bar\theta_0", "rad", "trim pitch of the control system's flexibility"
)
pitch = quantity("pitch", r"\Theta", "rad", "trim pitch at 0.75R: collective, elastic pitch and hinges")
structural_pitch = quantity(
    "structural_pitch", r"\Theta + \delta_s", "rad", "trim angle of the blade's structural axes"
)
pitch_flap_coupling = quantity(
    "pitch_flap_coupling", r"K_{P\beta}", "", "pitch-flap coupling, nose down per flap"
)
pitch_lag_coupling = quantity(
    "pitch_lag_coupling", r"K_{P\zeta}", "", "pitch-lag coupling, nose down per lag"
)

# Linkages that turn a blade as it moves: on its own hinges, and with the gimbal.
HINGE_LINKAGES = (kinematic_pitch_flap_coupling, kinematic_pitch_lag_coupling)
LINKAGES = (pitch_gimbal_coupling, *HINGE_LINKAGES)
