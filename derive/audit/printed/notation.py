"""Symbols of AIAA-2002-1604 that the derivation does not have, and the form in which its equations are kept.

Where the paper's quantity is one of the derivation's, the symbol is that of `derive.symbols`. Motions are symbols
too, with a dot per time derivative and a prime per derivative with azimuth, so that an equation is a polynomial in
them.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import sympy as sp

from derive.multiblade import psi
from derive.symbols import QUANTITIES, Dimension, dimension_of_unit

DIMENSIONS: dict[sp.Symbol, Dimension] = {psi: (0, 0, 0)}


def printed(name: str, unit: str = "") -> sp.Symbol:
    """Declare a symbol of the paper with its unit."""
    symbol = sp.Symbol(name, real=True)
    DIMENSIONS[symbol] = dimension_of_unit(unit)
    return symbol


def _motion(name: str, unit: str) -> tuple[sp.Symbol, sp.Symbol, sp.Symbol]:
    return tuple(printed(name + dots, unit + " " * bool(unit) + rate) for dots, rate in _RATES)


_RATES = (("", ""), ("_dot", "/s"), ("_ddot", "/s^2"))

# The fixed frame's coordinates in the paper's notation, by the derivation's names (Eq. 17).
FIXED_NAMES = {
    "x": "x",
    "y": "y",
    "z": "z",
    "alpha_x": "alpha_x",
    "alpha_y": "alpha_y",
    "alpha_z": "alpha_z",
    "flap_0": "beta_0",
    "flap_1c": "beta_1C",
    "flap_1s": "beta_1S",
    "lag_0": "zeta_0",
    "lag_1c": "zeta_1C",
    "lag_1s": "zeta_1S",
    "pitch_0": "theta_0",
    "pitch_1c": "theta_1C",
    "pitch_1s": "theta_1S",
    "azimuth": "psi_s",
    "gimbal_1c": "beta_GC",
    "gimbal_1s": "beta_GS",
}
BLADE_NAMES = {"flap": "beta", "lag": "zeta", "pitch": "theta", "gimbal_flap": "beta_G"}
_LENGTHS = ("x", "y", "z")

# A motion and its first and second derivative: with time, and with azimuth.
TIME = {
    name: _motion(symbol, "m" if name in _LENGTHS else "")
    for name, symbol in (FIXED_NAMES | BLADE_NAMES).items()
}
AZIMUTH = {
    name: tuple(
        printed(TIME[name][0].name + "_prime" * order, "m" if name in _LENGTHS else "") for order in range(3)
    )
    for name in TIME
}

e = printed("e", "m")  # the one hinge offset
m = printed("m", "kg/m")
mean_offset = printed("e_bar")  # e/(R - e)
a_i, a_j, a_k = (printed(f"a_{axis}", "m/s^2") for axis in "ijk")
M_beta, M_zeta = printed("M_beta", "N m"), printed("M_zeta", "N m")
M_beta_elas, M_zeta_elas = printed("M_beta_elas", "N m"), printed("M_zeta_elas", "N m")
M_beta_aero = printed("M_beta_aero", "N m")
dM_theta, M_theta = printed("Delta_M_theta", "N m"), printed("M_theta", "N m")
dM_theta_aero = printed("dM_theta_aero", "N")
F_x, F_z, F_r = (
    printed(f"F_{axis}", "N/m") for axis in "xzr"
)  # F_x and F_z: airloads and inertia; F_r: inertia
section_inertia = printed("I_theta_section", "kg m")
K_beta_H, K_beta_B, K_zeta_H, K_zeta_B = (
    printed(f"K_{angle}{place}", "N m/rad") for angle in ("beta", "zeta") for place in "HB"
)
beta_in, zeta_in, beta_out, zeta_out = (
    printed(name) for name in ("beta_in", "zeta_in", "beta_out", "zeta_out")
)
A, B, C, D, W, X, Y, Z = (printed(name) for name in "ABCDWXYZ")
flexibility_in = {pair: printed(f"K_in_inverse_{pair}", "rad/N m") for pair in ("bb", "zz")}
flexibility_out = {pair: printed(f"K_out_inverse_{pair}", "rad/N m") for pair in ("bb", "bz", "zz")}


@dataclass(frozen=True)
class PrintedEquation:
    """One numbered equation: the expression printed for each quantity it gives, and what is unsure in the reading."""

    number: int | str
    page: int
    title: str
    parts: dict[str, sp.Expr]
    # Unit of each part's terms; the parts' own where they differ.
    unit: str | dict[str, str] = ""
    # What the text at hand has lost, if the equation had to be restored.
    restored: str = ""
    # Names in READINGS of what is to be tried where a term does not agree as it stands.
    readings: tuple[str, ...] = ()
    doubt: str = field(default="")

    def dimension(self, part: str) -> Dimension:
        return dimension_of_unit(self.unit[part] if isinstance(self.unit, dict) else self.unit)


_GREEK = ("alpha", "beta", "zeta", "theta", "psi", "Delta", "nu", "omega")
_ACCENTS = {
    "_ddot": r"\ddot ",
    "_dot": r"\dot ",
    "_prime_prime": "''",
    "_prime": "'",
    "_out": r"_\mathrm{out}",
    "_in": r"_\mathrm{in}",
    "_section": "",
}


def latex_names() -> dict[sp.Symbol, str]:
    """Notation of every symbol of print and derivation."""
    names = {symbol: _latex(symbol.name) for symbol in DIMENSIONS}
    return names | {symbol: known.latex for symbol, known in QUANTITIES.items()}


def _latex(name: str) -> str:
    if name.startswith("Delta_"):
        return r"\Delta " + _latex(name.removeprefix("Delta_"))
    accent = next((ending for ending in _ACCENTS if name.endswith(ending)), "")
    base, _, index = name.removesuffix(accent).partition("_")
    base = "\\" + base if base in _GREEK else base
    index = index.removeprefix("s_") if index else ""
    index = "".join(("\\" + part + " ") if part in _GREEK else part for part in index.split("_"))
    mark = _ACCENTS.get(accent, "")
    subscript = f"_{{{index}}}" if index else ""
    if mark.startswith("_"):
        return f"{base}{mark}"
    if mark.startswith("\\"):
        return f"{mark}{base}{subscript}"
    return f"{base}{mark}{subscript}"
