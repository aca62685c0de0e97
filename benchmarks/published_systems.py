"""Two systems of other authors, whose inputs and eigenvalues are published: a propeller on an elastic nacelle, and
ground resonance of four blades with lag hinges.

    python -m benchmarks.published_systems

Nothing is fitted. `docs/validation.md` shows the tables.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

import proprotor as pp

# The propeller of the Mair datum in the Julia notebook of Gali, Göhmann and Riso: rigid blades, quasi-steady strips.
RADIUS, ROTOR_SPEED, N_BLADES, CHORD = 0.152, 40.0, 4, 0.026  # m, rad/s, m
LIFT_SLOPE, DENSITY = 2 * np.pi, 1.225
PIVOT_DISTANCE = 0.25 * RADIUS
POLAR_INERTIA, PIVOT_INERTIA = 1.03e-4, 1.78e-4  # kg m², the second about the pivot, the propeller included
PIVOT_DAMPING, PIVOT_STIFFNESS = 0.001, 0.4  # N m s/rad, N m/rad, of pitch and of yaw
NACELLE_ROOTS = {  # m/s: backward and forward whirl, rad/s
    1.0: (-4.27685 + 36.87543j, -7.29441 + 60.02150j),
    5.0: (-1.99826 + 35.61375j, -8.77373 + 58.75982j),
    8.0: (0.18004 + 33.14436j, -10.69858 + 56.29043j),
}
NACELLE_FLUTTER = 7.76409, 33.388  # m/s, rad/s, backward whirl
_LOCKED = ("flap", "lag", "pitch", "gimbal")

# Hammond (1974): blades that lag on a hub with two in-plane motions, no lag springs, in a vacuum.
BLADES, BLADE_MASS, FIRST_MOMENT, LAG_INERTIA = 4, 94.9, 289.1, 1084.7  # kg, kg m, kg m²
LAG_HINGE, LAG_DAMPER = 0.3048, 4067.5  # m, N m s/rad
HUB_MASS, HUB_STIFFNESS = (8026.6, 3283.6), (1240481.8, 1240481.8)  # kg beside the blades, N/m
HUB_DAMPING = (51078.7, 51078.7 / 2)  # N s/m
GROUND_RESONANCE = {  # rpm: roots in rad/s
    250.0: (-0.32953 + 18.53925j, -3.09444 + 11.78295j, -4.43802 + 17.34927j, -2.73917 + 36.21474j),
    300.0: (-0.73519 + 21.44341j, -3.06721 + 11.77524j, -4.13316 + 18.14020j, -2.66560 + 43.31334j),
}
UNDAMPED_GROWTH = 1.885, 253.0  # 1/s at rpm: the largest without dampers
_LAG = ("x", "y", "lag_1c", "lag_1s")


def propeller(airspeed: float) -> pp.Rotor:
    """Rigid blades whose twist follows the inflow angle, so that no section has an incidence at this airspeed."""
    inertia, first_moment = (
        POLAR_INERTIA / N_BLADES,
        1e-4,
    )  # any blade mass will do: the pivot's inertia includes it
    return pp.Rotor(
        n_blades=N_BLADES,
        radius=RADIUS,
        blade_mass=1e-3,
        blade_first_moment=first_moment,
        blade_inertia=inertia,
        flap_first_moment=first_moment,
        flap_inertia=inertia,
        lag_first_moment=first_moment,
        lag_inertia=inertia,
        flap_stiffness=1.0,
        lag_stiffness=1.0,
        chord=CHORD,
        twist=lambda r: np.arctan(airspeed / (ROTOR_SPEED * r)),
        airfoil=pp.Airfoil(lift_slope=LIFT_SLOPE),
    )


def nacelle_roots(airspeed: float) -> NDArray:
    """Backward and forward whirl of the propeller on its nacelle, rad/s."""
    operation = pp.Operation(
        rotor_speed=ROTOR_SPEED,
        density=DENSITY,
        speed_of_sound=340.0,
        trim={"collective": np.arctan(airspeed / (0.75 * ROTOR_SPEED * RADIUS))},
    )
    model = pp.rotor_model(
        propeller(airspeed),
        operation,
        airspeed,
        locked=_LOCKED,
        rotor_speed="constant",
        compressibility=False,
        section_damping=False,
    )
    support = pp.two_axis_pivot(
        PIVOT_DISTANCE,
        [PIVOT_INERTIA] * 2,
        [PIVOT_STIFFNESS] * 2,
        [PIVOT_DAMPING] * 2,
        includes_rotor="rigid",
    )
    coupled = pp.mount(model, support)
    return _upper_roots(coupled.M, coupled.C, coupled.K)


def nacelle_flutter() -> tuple[float, float]:
    """Airspeed (m/s) and frequency (rad/s) at which backward whirl is neutral."""
    speed = brentq(lambda airspeed: nacelle_roots(airspeed)[0].real, 5.0, 10.0, xtol=1e-13)
    return float(speed), float(nacelle_roots(speed)[0].imag)


def hinged_rotor(damper: float) -> pp.Rotor:
    """Four blades on lag hinges without springs; what the blade weighs inboard of the hinge is no matter."""
    return pp.Rotor(
        n_blades=BLADES,
        radius=8.0,
        lag_hinge_offset=LAG_HINGE,
        blade_mass=BLADE_MASS,
        blade_first_moment=FIRST_MOMENT + BLADE_MASS * LAG_HINGE,
        blade_inertia=LAG_INERTIA + 2 * LAG_HINGE * FIRST_MOMENT + BLADE_MASS * LAG_HINGE**2,
        flap_first_moment=FIRST_MOMENT + BLADE_MASS * LAG_HINGE,
        flap_inertia=LAG_INERTIA + 2 * LAG_HINGE * FIRST_MOMENT + BLADE_MASS * LAG_HINGE**2,
        lag_first_moment=FIRST_MOMENT,
        lag_inertia=LAG_INERTIA,
        flap_stiffness=0.0,
        lag_stiffness=0.0,
        lag_damping=damper,
        chord=0.4,
        airfoil=pp.Airfoil(lift_slope=LIFT_SLOPE),
    )


def ground_resonance_roots(rpm: float, *, damped: bool = True) -> NDArray:
    """The four roots of hub and cyclic lag, rad/s, by frequency."""
    operation = pp.Operation(
        rotor_speed=rpm * np.pi / 30, density=0.0, speed_of_sound=340.0, trim={"collective": 0.0}
    )
    locked = ("flap", "pitch", "gimbal")
    rotor = hinged_rotor(LAG_DAMPER * damped)
    model = pp.rotor_model(
        rotor, operation, 0.0, airloads="none", pitch="rigid", rotor_speed="constant", locked=locked
    )
    index = np.ix_(*[[model.dofs.index(name) for name in _LAG]] * 2)
    hub = [np.append(part, (0.0, 0.0)) for part in (HUB_MASS, damped * np.array(HUB_DAMPING), HUB_STIFFNESS)]
    M, C, K = (getattr(model, name)[index] + np.diag(own) for name, own in zip("MCK", hub, strict=True))
    return _upper_roots(M, C, K)


def largest_growth() -> tuple[float, float]:
    """The largest growth (1/s) without dampers, and its rotor speed (rpm)."""
    speeds = np.linspace(240.0, 270.0, 601)
    growth = [ground_resonance_roots(rpm, damped=False).real.max() for rpm in speeds]
    return float(np.max(growth)), float(speeds[np.argmax(growth)])


def _upper_roots(M: NDArray, C: NDArray, K: NDArray) -> NDArray:
    """Roots with positive frequency, by frequency."""
    n = len(M)
    lower = -np.linalg.solve(M, np.hstack([K, C]))
    values = np.linalg.eigvals(np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), lower]))
    upper = values[values.imag > 0]
    return upper[np.argsort(upper.imag)]


def section() -> Iterator[str]:
    """Yield the lines of the section of docs/validation.md."""
    yield "## Two published systems of other authors"
    yield ""
    yield "Inputs and results are published whole; nothing is fitted. `python -m benchmarks.published_systems` prints"
    yield "the tables, and `tests/model/test_published_systems.py` holds each printed digit. A propeller on a two-axis"
    yield "mount with measured derivatives has [its own page](reed-bland.md)."
    yield ""
    yield "**A propeller on an elastic nacelle** (Mair's datum in the Julia notebook of Gali, Göhmann and Riso): four"
    yield "rigid blades, quasi-steady strips, helical twist, pitch and yaw. Roots in rad/s:"
    yield ""
    yield "| airspeed, m/s (true) | backward whirl, published | here | forward whirl, published | here |"
    yield "|---|---|---|---|---|"
    for airspeed, published in NACELLE_ROOTS.items():
        pairs = zip(published, nacelle_roots(airspeed), strict=True)
        yield f"| {airspeed:g} | " + " | ".join(_written(root) for pair in pairs for root in pair) + " |"
    speed, frequency = nacelle_flutter()
    yield ""
    published = "published {:.5f} m/s, {:.3f} rad/s".format(*NACELLE_FLUTTER)
    yield f"Backward whirl flutters at {speed:.5f} m/s with {frequency:.3f} rad/s; {published}."
    yield ""
    yield "**Ground resonance** (Hammond, 1974): four blades with lag hinges and dampers and without springs, on a hub"
    yield "with two in-plane motions, in a vacuum. Roots in rad/s:"
    yield ""
    yield "| rotor speed, rpm | published | here |"
    yield "|---|---|---|"
    for rpm, published in GROUND_RESONANCE.items():
        own = ground_resonance_roots(rpm)
        for root in sorted(published, key=lambda root: root.imag):
            nearest = own[np.abs(own - root).argmin()]
            yield f"| {rpm:g} | {_written(root)} | {_written(nearest)} |"
    growth, at = largest_growth()
    yield ""
    published = "published {:.3f} 1/s at {:.0f} rpm".format(*UNDAMPED_GROWTH)
    yield f"Without dampers the largest growth is {growth:.3f} 1/s at {at:.0f} rpm; {published}."
    yield ""


def _written(root: complex) -> str:
    return f"{root.real:.5f} + {root.imag:.5f} i".replace("-", "−")


if __name__ == "__main__":
    print("\n".join(section()))
