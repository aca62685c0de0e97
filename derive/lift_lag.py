"""Lag of lift: circulation of a section that follows its quasi-steady value late, as that of a thin airfoil does.

The lift of a section is rho U times its circulation, c/2 times U c_l, and vortices that the section has shed hold the
circulation back. With Jones' approximation of Wagner's function, 1 - sum A_i exp(-b_i s), s the way of the air in half
chords, a change of U c_l = w (of the air, the pitch or the rotation of the section) gives a lift that lacks

    rho U c/2 sum v_i        v_i' + b_i (2 U/c) v_i = A_i w'

Only the change of the circulation lags: a change of the speed U acts on the steady circulation at once. The factor of
compressibility is part of c_l, before the lag. Lift stays normal to the air; drag and moment do not lag.

Along a blade v_i is a sum of few shape functions P_k(r), and the equation holds in the mean, weighed with P_k times
U c/2. With the moments of the change of circulation

    f_k = int P_k (U c/2) w dr        G_kl = int P_k P_l (U c/2) dr        H_kl = int P_k P_l U² dr

the lag is a state x_i that follows the change of circulation, v_i = A_i (G^-1 f - x_i):

    G x_i' + b_i H x_i = b_i H G^-1 f

x_i takes neither accelerations nor rates of gusts. In a steady state v_i vanishes, whatever the shape functions are.
"""

from __future__ import annotations

import functools

import sympy as sp

from derive import kinematics as kin
from derive import section
from derive import symbols as s
from derive.airloads import ARGUMENTS
from derive.coordinates import BLADE_GUSTS, LOAD, MOTION, SEGMENT_LOADS, SEGMENT_MOTIONS

circulation_weight = s.quantity(
    "circulation_weight", "Uc/2", "m^2/s", "weight of a section's circulation in the mean over the blade"
)
circulation_decay = s.quantity(
    "circulation_decay", "U^2", "m^2/s^2", "the weight times the way of the air in half chords per second"
)
# Change of the circulation of a section, weighed, and what a unit of U c_l adds to the forces.
CHANGES = {
    argument: s.quantity(
        f"circulation_{argument}",
        rf"g{{}}_{{,{ARGUMENTS[f'_{argument}'][0]}}}",
        {"theta": "m^3/s^2", "spin": "m^3/s"}.get(argument, "m^2/s"),
        f"weighed change of U c_l{ARGUMENTS[f'_{argument}'][2]}",
    )
    for argument in ("ut", "up", "theta", "spin")
}
FORCES = {
    load: s.quantity(
        f"{load}_circulation", rf"{latex}{{}}_{{,w}}", "N s/m^2", f"{meaning} per unit span and U c_l"
    )
    for load, latex, meaning in (("fx", "f_x", "force along i'"), ("fn", "f_n", "force along n"))
}
moment_of_circulation = s.quantity(
    "m_circulation", r"m{}_{,w}", "N s/m", "moment about d, nose up, per unit span and U c_l"
)
CHANGES_AT_CENTER = {
    symbol: s.quantity(
        f"{symbol.name}_at_center",
        f"{s.QUANTITIES[symbol].latex}{{}}_{{|a}}",
        s.QUANTITIES[symbol].unit,
        f"{s.QUANTITIES[symbol].meaning}, of the aerodynamic centre",
    )
    for symbol in CHANGES.values()
}


def _moment_unit(unit: str, power: int) -> str:
    """Return the unit of an integral over the radius of r^power times a quantity of a section."""
    forces = ("N s/m^2", "N s/m", "N s")
    if unit in forces:
        return forces[forces.index(unit) + power + 1]
    lengths, _, denominator = unit.removeprefix("m^").partition("/")
    return f"m^{int(lengths) + power + 1}/{denominator}"


MOMENTS = {
    (symbol.name, power): s.quantity(
        f"{symbol.name}_{power}",
        rf"\int P r^{power} {s.QUANTITIES[symbol].latex}",
        _moment_unit(s.QUANTITIES[symbol].unit, power),
        f"integral of a shape function times r^{power} times the {s.QUANTITIES[symbol].meaning}",
    )
    for powers, symbols in (
        ((0, 1), (CHANGES["ut"], CHANGES["up"], *FORCES.values())),
        ((0,), (CHANGES["theta"], CHANGES["spin"], moment_of_circulation)),
    )
    for symbol in symbols
    for power in powers
}


def change_of_circulation() -> list[tuple[sp.Symbol, sp.Expr]]:
    """Weighed change of a section's circulation with the air's velocity, pitch and rotation, and the force it makes."""
    circulation = section.section_speed * section.coefficient("lift")
    along = section.derivative(circulation, section.section_speed)
    across = section.named(sp.diff(circulation, section.inflow_angle) / section.section_speed)
    changes = {
        "ut": along * section.inflow_cosine - across * section.inflow_sine,
        "up": along * section.inflow_sine + across * section.inflow_cosine,
        "theta": section.derivative(circulation, section.section_pitch),
        "spin": section.derivative(circulation, section.section_spin),
    }
    force = s.density * circulation_weight
    return [
        (circulation_weight, section.section_speed * s.chord / 2),
        (circulation_decay, section.section_speed**2),
        *((CHANGES[name], circulation_weight * value) for name, value in changes.items()),
        (FORCES["fx"], force * section.inflow_sine),
        (FORCES["fn"], force * section.inflow_cosine),
    ]


def change_beside_axis() -> list[tuple[sp.Symbol, sp.Expr]]:
    """Weighed change of a section's circulation, its force and its moment, where its centre lies beside the axis."""
    at_center = change_of_circulation()
    along, below = section.center_along, section.center_below
    return [
        *((CHANGES_AT_CENTER.get(symbol, symbol), value) for symbol, value in at_center),
        *((symbol, section.along_argument(name, _changes_at_center)) for name, symbol in CHANGES.items()),
        (moment_of_circulation, -along * FORCES["fn"] - below * FORCES["fx"]),
    ]


def _changes_at_center(argument: str) -> sp.Expr:
    return CHANGES_AT_CENTER[CHANGES[argument]] if argument in CHANGES else sp.Integer(0)


def change(_: str, motion: str) -> sp.Expr:
    """Change of a segment's circulation in one shape function, per unit of the motions of the segment."""
    of = MOTION[motion]
    if of.argument not in CHANGES:
        return sp.Integer(0)
    return MOMENTS[CHANGES[of.argument].name, of.power]


def load(row: str, _: str) -> sp.Expr:
    """Generalised loads of a segment per unit of U c_l in one shape function."""
    of = LOAD[row]
    made = FORCES | {"m": moment_of_circulation}
    return MOMENTS[made[of.section_load].name, of.power] if of.section_load in made else sp.Integer(0)


@functools.cache
def products() -> dict[str, sp.MatrixExpr]:
    """What each segment adds to the change of a blade's circulation, and to the loads that circulation makes."""
    loads, motions, coordinates = len(SEGMENT_LOADS), len(SEGMENT_MOTIONS), len(kin.COORDINATES)
    virtual = sp.MatrixSymbol("virtual_motion", loads, coordinates)
    changed = sp.MatrixSymbol("change", 1, motions)
    rate = sp.MatrixSymbol("rate_motion", motions, coordinates)
    displacement = sp.MatrixSymbol("displacement_motion", motions, coordinates)
    gust = sp.MatrixSymbol("gust_motion", motions, len(BLADE_GUSTS))
    return {
        "change_by_rates": changed * rate,
        "change_by_displacements": changed * displacement,
        "change_by_gusts": changed * gust,
        "work": virtual.T * sp.MatrixSymbol("load", loads, 1),
    }
