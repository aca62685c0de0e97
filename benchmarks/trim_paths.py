"""Trims of random rotors beside paths followed in small steps by other means: are they on the same branch?

    python -m benchmarks.trim_paths [rotors]

Each rotor is trimmed by the package, all in one batch, and led along the path from its undeflected blade by
`tests.oracles.trim_paths`, which has its own balance and goes by the path's length. Where that path turns back the
package must have failed the point with this reason, and where it comes to all of the loads both must have the same
angles. A quarter of the rotors each is closed by a collective, a thrust, a power and no power; some are soft enough to
diverge, and a tenth has no springs.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

import proprotor as pp
from tests.oracles.trim_paths import Blades, Ends, follow

KINDS = ("collective", "thrust_coefficient", "power_coefficient", "windmill")
CLOSING = {"collective": "collective", "thrust_coefficient": "thrust"}  # the others are torques
ARTICULATED = 0.1  # of the rotors
MASSES = 6  # of each blade
TURNED = "turns back"
LIMITS = ("beyond 90 deg", "trim with this", "no windmilling trim")  # what fails on any branch
FOLDED = np.radians(75)  # angles of a blade that is no rotor's any more: there paths are long and steps short
AGREEMENT = 1e-8  # rad
_BLOCK = 250  # rotors whose sections stay in the cache


@dataclass(frozen=True)
class Population:
    """Random rotors of one kind of trim: one batch of the package, and their blades for the oracle."""

    kind: str
    rotor: pp.Rotor
    operation: pp.Operation
    airspeed: NDArray
    blades: Blades
    articulated: NDArray

    def trim(self) -> pp.Trim:
        """By the package; sections without pitch damping, which the oracle does not have."""
        return pp.rotor_model(self.rotor, self.operation, self.airspeed, section_damping=False).trim

    def paths(self) -> Ends:
        """By the oracle."""
        n = len(self.airspeed)
        parts = [follow(self.blades.of(slice(at, at + _BLOCK))) for at in range(0, n, _BLOCK)]
        columns = zip(*(vars(part).values() for part in parts), strict=True)
        return Ends(*(np.concatenate(column) for column in columns))


def population(kind: str, n: int, seed: int) -> Population:
    """n rotors, from stiff to soft, from light to heavy loads."""
    rng = np.random.default_rng((KINDS.index(kind), seed))

    def between(low: float, high: float) -> NDArray:
        return rng.uniform(low, high, n)

    radius, tip_speed = between(1.0, 6.0), between(140.0, 320.0)
    speed, airspeed = tip_speed / radius, tip_speed * between(0.2, 0.9)
    flap_hinge = radius * between(0.0, 0.1)
    lag_hinge = flap_hinge + radius * np.maximum(between(-0.05, 0.1), 0.0)
    station = np.sort(rng.uniform(0.05, 0.98, (n, MASSES)), axis=1) * radius[:, None]
    mass = rng.uniform(0.2, 2.0, (n, MASSES)) * (radius[:, None] / 4) ** 3 * between(1.0, 8.0)[:, None]
    arms = [np.maximum(station - hinge[:, None], 0.0) for hinge in (flap_hinge, lag_hinge)]
    inertia, (flap_inertia, lag_inertia) = (mass * station**2).sum(1), [(mass * a**2).sum(1) for a in arms]
    articulated = rng.uniform(size=n) < ARTICULATED
    sprung = np.where(articulated, 0.0, 1.0)
    pitch_inertia = inertia * between(2e-4, 2e-2)
    shared = {
        "radius": radius,
        "root_cutout": radius * between(0.02, 0.3),
        "flap_hinge_offset": flap_hinge,
        "lag_hinge_offset": lag_hinge,
        "precone": np.maximum(between(-0.05, 0.08), -0.02),
        "flap_stiffness": sprung * flap_inertia * (speed * between(0.3, 1.6)) ** 2,
        "lag_stiffness": sprung * lag_inertia * (speed * between(0.4, 2.5)) ** 2,
        "flap_outboard_fraction": between(0.0, 1.0),
        "lag_outboard_fraction": between(0.0, 1.0),
        "structural_pitch_offset": np.maximum(between(-0.8, 0.8), -0.5),
        "pitch_inertia": pitch_inertia,
        "control_stiffness": pitch_inertia * (speed * between(1.5, 7.0)) ** 2,
        "twist": between(-1.0, 0.0),
    }
    chord = radius * between(0.05, 0.13)
    section = {
        "lift_slope": between(4.5, 6.5),
        "zero_lift_angle": between(-0.05, 0.02),
        "drag": between(0.005, 0.02),
        "moment": between(-0.03, 0.01),
    }
    n_blades, density = rng.integers(3, 6, n), between(0.5, 1.3)
    sound = np.hypot(tip_speed, airspeed) / between(0.3, 0.9)
    value = {
        "collective": np.arctan2(airspeed, 0.75 * tip_speed) + between(-0.08, 0.12),
        "thrust_coefficient": between(-0.01, 0.02),
        "power_coefficient": between(-0.01, 0.03),
        "windmill": np.zeros(n),
    }[kind]
    force = density * np.pi * radius**2 * tip_speed**2 / n_blades
    closed_at = value * {"thrust_coefficient": force, "power_coefficient": -force * radius}.get(kind, 1.0)
    moments = {
        "blade_mass": mass.sum(1),
        "blade_first_moment": (mass * station).sum(1),
        "blade_inertia": inertia,
        "flap_first_moment": (mass * arms[0]).sum(1),
        "flap_inertia": flap_inertia,
        "lag_first_moment": (mass * arms[1]).sum(1),
        "lag_inertia": lag_inertia,
    }
    rotor = pp.Rotor(n_blades=n_blades, **shared, **moments, chord=chord, airfoil=pp.Airfoil(**section))
    target = "windmill" if kind == "windmill" else {kind: value}
    operation = pp.Operation(rotor_speed=speed, density=density, speed_of_sound=sound, trim=target)
    softest = {name: np.maximum(shared[name], 1e-12) for name in ("flap_stiffness", "lag_stiffness")}
    blades = Blades(
        closing=CLOSING.get(kind, "torque"),
        closed_at=closed_at,
        rotor_speed=speed,
        airspeed=airspeed,
        density=density,
        speed_of_sound=sound,
        station=station,
        mass=mass,
        chord=chord,
        **(shared | softest),
        **section,
    )
    return Population(kind, rotor, operation, airspeed, blades, articulated)


def verdicts(trim: pp.Trim, ends: Ends) -> NDArray:
    """What comparing says of each rotor, in words."""
    state = np.stack([trim.coning, trim.lag, trim.elastic_pitch, trim.collective], axis=1)
    apart = np.abs(state - ends.state).max(axis=1)
    limits = np.array([any(text in reason for text in LIMITS) for reason in trim.reason])
    folded = ~trim.converged & (np.abs(ends.state[:, :3]).max(axis=1) > FOLDED)
    turned = np.array([TURNED in reason for reason in trim.reason])
    cases = {
        "same trim": trim.converged & ends.arrived & (apart <= AGREEMENT),
        "ANOTHER TRIM": trim.converged & ends.arrived & (apart > AGREEMENT),
        "both turn back": turned & ends.turned,
        "TRIM WHERE THE PATH TURNS BACK": trim.converged & ends.turned,
        "TURNS BACK WHERE THE PATH ARRIVES": turned & ends.arrived,
        "beyond what angles mean": limits | folded,
        "trim where the path is lost": trim.converged & ~ends.arrived & ~ends.turned,
    }
    return np.select(list(cases.values()), list(cases), "lost")


def compare(n: int, seed: int = 0) -> dict[str, tuple[Population, pp.Trim, Ends, NDArray]]:
    """n rotors of each kind: population, trims, paths and verdicts."""
    found = {}
    for kind in KINDS:
        rotors = population(kind, n, seed)
        trim, ends = rotors.trim(), rotors.paths()
        found[kind] = rotors, trim, ends, verdicts(trim, ends)
    return found


def main(rotors: int = 10_000) -> None:
    start = time.process_time()
    found = compare(rotors // len(KINDS))
    counts = {kind: Counter(verdict.tolist()) for kind, (*_, verdict) in found.items()}
    names = sorted(set().union(*counts.values()))
    table = Table(
        "", *KINDS, title=f"{rotors} random rotors, {time.process_time() - start:.0f} s of processor time"
    )
    for name in names:
        table.add_row(name, *(str(counts[kind][name]) for kind in KINDS))
    Console(width=120).print(table)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
