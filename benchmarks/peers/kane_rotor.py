"""One blade of the rotor through `sympy.physics.mechanics`: Kane's method, then linearised about trim.

    python -m benchmarks.peers.kane_rotor flap lag

prints as JSON how long the equations of these coordinates take; without names, of all twelve.

The blade is written as one writes it with that package: frames, points and three rigid bodies, namely what is inboard
of the flap hinge, between the hinges, and outboard of the lag hinge, each a thin rod of given mass, centre and inertia.
Axes and coordinates are those of `derive.kinematics`: i, j, k turn at the rotor speed, and hub motion and gimbal tilt
are resolved along them. Hub and gimbal turn by angles about body axes, which SymPy has ready made; they differ from
exponential coordinates in the second order, which is felt by steady moments alone, and those cancel over the blades.
"""

from __future__ import annotations

import json
import sys
import time
from dataclasses import dataclass

import sympy as sp
from sympy.physics import mechanics as me

COORDINATES = (
    *("hub_i", "hub_j", "hub_k", "turn_i", "turn_j", "turn_k"),
    *("flap", "lag", "pitch", "azimuth", "gimbal_flap", "gimbal_roll"),
)
HUB_TURNS = ("turn_i", "turn_j", "turn_k")
TRIM = {"flap": "coning", "lag": "lag", "pitch": "elastic_pitch"}  # steady values; zero for the others
BODIES = ("inboard", "middle", "outboard")  # of the flap hinge, between the hinges, of the lag hinge


@dataclass(frozen=True)
class LinearBlade:
    """M q̈ + C q̇ + K q = 0 of one blade in `coordinates`, as SymPy matrices, and what it took, s."""

    coordinates: tuple[str, ...]
    mass: sp.Matrix
    damping: sp.Matrix
    stiffness: sp.Matrix
    seconds: dict[str, float]

    @property
    def symbols(self) -> list[sp.Symbol]:
        """What the matrices depend on, by name."""
        found = self.mass.free_symbols | self.damping.free_symbols | self.stiffness.free_symbols
        return sorted(found, key=lambda symbol: symbol.name)


@dataclass(frozen=True)
class Blade:
    """Coordinates, speeds, and the parts that Kane's method asks for."""

    q: dict[str, sp.Expr]  # every coordinate; zero if it is held
    u: dict[str, sp.Expr]
    inertial: me.ReferenceFrame
    bodies: list[me.RigidBody]
    loads: list[tuple]

    @property
    def free(self) -> list[str]:
        return [name for name, coordinate in self.q.items() if coordinate != 0]


def number(name: str) -> sp.Symbol:
    """A given quantity, under its name in the generated equations where it has one."""
    return sp.Symbol(name)


def blade(coordinates: tuple[str, ...]) -> Blade:
    """Frames, bodies and loads of a blade with the other coordinates held."""
    q = {name: me.dynamicsymbols(f"q_{name}") if name in coordinates else sp.S.Zero for name in COORDINATES}
    q |= {name: number(value) for name, value in TRIM.items() if name not in coordinates}
    u = {name: me.dynamicsymbols(f"u_{name}") for name in coordinates}
    inertial, rotating = me.ReferenceFrame("N"), me.ReferenceFrame("R")
    rotating.set_ang_vel(inertial, number("rotor_speed") * rotating.z)
    bodies = rods(q, inertial, rotating)
    loads = []
    if "pitch" in coordinates:
        bodies.append(pitching_mass(q, inertial))
    for name, torque in torques(q, coordinates).items():
        axis = me.ReferenceFrame(f"axis_{name}")
        axis.set_ang_vel(inertial, q[name].diff() * inertial.x)
        loads.append((axis, torque * inertial.x))
    return Blade({name: q[name] for name in coordinates}, u, inertial, bodies, loads)


def rods(q: dict, inertial: me.ReferenceFrame, rotating: me.ReferenceFrame) -> list[me.RigidBody]:
    """The three rods of the blade, on hub, yoke and hinges."""

    def turned(frame: me.ReferenceFrame, axis: str, angle: sp.Expr) -> me.ReferenceFrame:
        if angle == 0:  # a coordinate that is held
            return frame
        following = me.ReferenceFrame(f"{frame.name}{axis}")
        following.orient_axis(frame, getattr(frame, axis), angle)
        return following

    shaft = rotating  # one axis at a time: SymPy's equations are shorter than with orient_body_fixed
    for axis, name in zip("xyzxyz", (*HUB_TURNS, "gimbal_flap", "gimbal_roll", "azimuth"), strict=True):
        shaft = turned(shaft, axis, q[name])
    yoke = turned(shaft, "x", number("precone"))
    flapped = turned(yoke, "x", q["flap"])
    lagged = turned(flapped, "z", -q["lag"])

    centre = me.Point("O")
    centre.set_vel(inertial, 0)
    displaced = q["hub_i"] * rotating.x + q["hub_j"] * rotating.y + q["hub_k"] * rotating.z
    hub_point = centre.locatenew("hub", displaced)
    hub_point.set_vel(inertial, displaced.dt(inertial))
    flap_offset, lag_offset = number("flap_hinge_offset"), number("lag_hinge_offset")
    flap_hinge = hub_point.locatenew("flap_hinge", flap_offset * yoke.y)
    flap_hinge.v2pt_theory(hub_point, inertial, yoke)
    lag_hinge = flap_hinge.locatenew("lag_hinge", (lag_offset - flap_offset) * flapped.y)
    lag_hinge.v2pt_theory(flap_hinge, inertial, flapped)

    places = zip(BODIES, (hub_point, flap_hinge, lag_hinge), (yoke, flapped, lagged), strict=True)
    found = []
    for name, root, frame in places:
        centre_of_mass = root.locatenew(f"centre_{name}", number(f"{name}_centre") * frame.y)
        centre_of_mass.v2pt_theory(root, inertial, frame)
        about_centre = number(f"{name}_inertia")
        inertia = (me.inertia(frame, about_centre, 0, about_centre), centre_of_mass)
        found.append(me.RigidBody(name, centre_of_mass, frame, number(f"{name}_mass"), inertia))
    return found


def pitch_to_shaft(q: dict) -> sp.Expr:
    """Pitch relative to the shaft: the swashplate turns with it and sees the gimbal's flap angle."""
    seen = q["gimbal_flap"] * sp.cos(q["azimuth"]) + q["gimbal_roll"] * sp.sin(q["azimuth"])
    return number("collective") + q["pitch"] - number("pitch_gimbal_coupling") * seen


def pitch_to_yoke(q: dict) -> sp.Expr:
    roll = q["gimbal_roll"] * sp.cos(q["azimuth"]) - q["gimbal_flap"] * sp.sin(q["azimuth"])
    return pitch_to_shaft(q) - roll


def pitching_mass(q: dict, inertial: me.ReferenceFrame) -> me.RigidBody:
    """The lumped pitch inertia: a massless body that turns about a fixed axis by the pitch relative to the shaft."""
    frame, centre = me.ReferenceFrame("pitching"), me.Point("pitching_centre")
    frame.set_ang_vel(inertial, pitch_to_shaft(q).diff(me.dynamicsymbols._t) * inertial.x)
    centre.set_vel(inertial, 0)
    return me.RigidBody(
        "pitching", centre, frame, 0, (me.inertia(inertial, number("pitch_inertia"), 0, 0), centre)
    )


def torques(q: dict, coordinates: tuple[str, ...]) -> dict[str, sp.Expr]:
    """Generalised forces of springs, propeller moment and dampers."""
    energy = potential(q)
    found = {name: -sp.diff(energy, q[name]) for name in coordinates}
    for name in ("flap", "lag", "pitch"):
        if name in coordinates:
            found[name] -= number(f"{name}_damping") * q[name].diff()
    share, speed = number("gimbal_damping") / number("n_blades"), number("rotor_speed")
    rates = {  # of the tilt in the fixed frame, along the rotating axes
        "gimbal_flap": sp.diff(q["gimbal_flap"], me.dynamicsymbols._t) - speed * q["gimbal_roll"],
        "gimbal_roll": sp.diff(q["gimbal_roll"], me.dynamicsymbols._t) + speed * q["gimbal_flap"],
    }
    for name, rate in rates.items():
        if name in coordinates:
            found[name] -= share * rate
    return {name: torque for name, torque in found.items() if torque != 0}


def potential(q: dict) -> sp.Expr:
    """Springs in series that turn against each other with the pitch, control system, propeller moment and gimbal."""
    turn = pitch_to_yoke(q) + number("structural_pitch_offset")
    c, s = sp.cos(turn), sp.sin(turn)
    soft = {
        (name, part): fraction / number(f"{name}_stiffness")
        for name in ("flap", "lag")
        for part, fraction in (
            ("inboard", 1 - number(f"{name}_outboard_fraction")),
            ("outboard", number(f"{name}_outboard_fraction")),
        )
    }
    flap_flap = soft["flap", "inboard"] + soft["flap", "outboard"] * c**2 + soft["lag", "outboard"] * s**2
    lag_lag = soft["lag", "inboard"] + soft["flap", "outboard"] * s**2 + soft["lag", "outboard"] * c**2
    flap_lag = (soft["flap", "outboard"] - soft["lag", "outboard"]) * s * c
    flap, lag = q["flap"], q["lag"]
    bent = lag_lag * flap**2 - 2 * flap_lag * flap * lag + flap_flap * lag**2
    hinges = bent / (flap_flap * lag_lag - flap_lag**2) / 2
    propeller = number("propeller_moment") * number("pitch_inertia") * number("rotor_speed") ** 2
    twisted = propeller * sp.sin(pitch_to_yoke(q)) ** 2 + number("control_stiffness") * q["pitch"] ** 2
    tilt = q["gimbal_flap"] ** 2 + q["gimbal_roll"] ** 2
    return hinges + twisted / 2 + number("gimbal_stiffness") / number("n_blades") * tilt / 2


def linear_blade(coordinates: tuple[str, ...] = COORDINATES) -> LinearBlade:
    """Kane's equations of the blade, and their linearisation about its trim.

    Parameters
    ----------
    coordinates : tuple of str
        Those left free, of `COORDINATES`.
    """
    seconds, start = {}, time.process_time()

    def lap(name):
        nonlocal start
        seconds[name], start = time.process_time() - start, time.process_time()

    parts = blade(coordinates)
    lap("model")
    q, u = list(parts.q.values()), list(parts.u.values())
    rates = [speed - coordinate.diff() for coordinate, speed in zip(q, u, strict=True)]
    kane = me.KanesMethod(parts.inertial, q_ind=q, u_ind=u, kd_eqs=rates)
    kane.kanes_equations(parts.bodies, parts.loads)
    lap("equations of motion")
    steady = {coordinate: number(TRIM[name]) if name in TRIM else 0 for name, coordinate in parts.q.items()}
    still = dict.fromkeys([*u, *(speed.diff() for speed in u)], 0)
    linearizer = kane.to_linearizer()
    # SymPy counts forces without speeds or accelerations twice (`bead_stiffness`), the centrifugal ones: once here.
    linearizer.f_2 -= me.msubs(linearizer.f_2, dict.fromkeys((speed.diff() for speed in u), 0))
    left, right, _ = linearizer.linearize(op_point=steady | still)
    lap("linearised")
    n = len(q)
    # Rows of the speeds, in SymPy's signs: -M du' = C du + K dq.
    return LinearBlade(coordinates, -left[n:, n:], right[n:, n:], right[n:, :n], seconds)


def bead_stiffness() -> sp.Expr:
    """Stiffness that `KanesMethod.linearize` finds for a bead on an arm turning at w, on a spring k: k - m w²?"""
    r, v = me.dynamicsymbols("r v")
    k, m, w = sp.symbols("k m w")
    inertial, arm, centre = me.ReferenceFrame("N"), me.ReferenceFrame("A"), me.Point("O")
    arm.set_ang_vel(inertial, w * arm.z)
    centre.set_vel(inertial, 0)
    bead = centre.locatenew("bead", r * arm.x)
    bead.set_vel(inertial, (r * arm.x).dt(inertial))
    kane = me.KanesMethod(inertial, [r], [v], kd_eqs=[v - r.diff()])
    kane.kanes_equations([me.Particle("bead", bead, m)], [(bead, -k * r * arm.x)])
    left, right, _, _ = kane.linearize(op_point={v: 0, v.diff(): 0})
    return sp.expand(-m * right[1, 0] / left[1, 1])


def main(coordinates: list[str]) -> None:
    linear = linear_blade(tuple(coordinates) or COORDINATES)
    operations = sum(int(sp.count_ops(part)) for part in (linear.mass, linear.damping, linear.stiffness))
    print(json.dumps({"seconds": linear.seconds, "operations": operations}))


if __name__ == "__main__":
    main(sys.argv[1:])
