"""Symmetric modes of the XV-15 with a free fuselage: why its chord mode is not that of a cantilever.

    python -m benchmarks.free_aircraft

The wing of the deck `xv15-wing` is let go at its mount, where half the fuselage is a rigid body that may rise, move
fore and aft and pitch, as symmetric motion allows. Gross weight and pitch inertia of the aircraft are recalled; both
are varied. The cantilever is the limit of a fuselage that weighs very much.
"""

from dataclasses import fields

import numpy as np
import scipy.linalg

import proprotor as pp
from proprotor.support.beam_wing import beam_structure, rigid_motion, wing_elements

POUND, SLUG_FOOT2 = 0.45359237, 1.3558179483314
SYMMETRIC = (0, 2, 4)  # x, z and alpha_y of the mount


def modes(wing: pp.Wing, pylon: pp.Pylon, rotor_mass: float, fuselage: np.ndarray) -> np.ndarray:
    """The lowest elastic frequencies in Hz with a body (3, 3) of half the fuselage on x, z, alpha_y of the mount."""
    structure = beam_structure(wing, pylon)
    n = len(structure.names)
    motion = np.zeros((*structure.nodes.shape[:2], n + 3))
    motion[..., :n] = structure.nodes
    motion[0, SYMMETRIC, n + np.arange(3)] = 1.0
    motion = motion.reshape(-1, n + 3)
    elements, parts, _ = wing_elements(wing)
    stiffness = motion.T @ sum(parts.values()) @ motion
    of_nodes = structure.nodes.reshape(-1, n)
    mass = motion.T @ elements @ motion
    mass[:n, :n] += structure.mass - of_nodes.T @ elements @ of_nodes
    mass[:n, :n] += rotor_mass * structure.hub[:3].T @ structure.hub[:3]
    mass[n:, n:] += fuselage
    roots = scipy.linalg.eigh(stiffness, mass, eigvals_only=True)
    return np.sqrt(np.clip(roots, 0, None))[3:6] / (2 * np.pi)


def half_fuselage(weight: float, pitch_inertia: float, behind: float) -> np.ndarray:
    """Mass (3, 3) on x, z, alpha_y of the mount, of a body whose centre of mass lies `behind` it, SI."""
    body = np.diag([weight, weight, weight, 0.0, pitch_inertia, 0.0])
    motion = rigid_motion([0.0, 0.0, -behind])
    return (motion.T @ body @ motion)[np.ix_(SYMMETRIC, SYMMETRIC)]


def of_deck(case: pp.Case) -> tuple[pp.Wing, pp.Pylon, float]:
    """Wing, pylon and rotor mass as the deck gives them, on the downstop."""
    given = {path.removeprefix("support."): number.si for path, number in case.given.items()}
    wing, pylon = (
        kind(**{entry.name: given[entry.name] for entry in fields(kind) if entry.name in given})
        for kind in (pp.Wing, pp.Pylon)
    )
    return wing, pylon, given["rotor_mass"]


def main() -> None:
    """Print the frequencies of cantilever and free aircraft."""
    wing, pylon, rotor_mass = of_deck(pp.load_case("xv15-wing"))
    print("published, symmetric                        3.30  6.30  8.30 Hz")
    rows = [("held at the mount", 1e9, 1e9, 0.0)]
    for gross in (11_000, 13_000, 15_000):
        rest = (gross - 2 * (1583 + 559 + 400)) / 2
        rows.append((f"free, {gross} lb, pitch inertia 8000 slug ft2", rest * POUND, 8000 * SLUG_FOOT2, 0.0))
    rows.append(("free, 13000 lb, fuselage cannot pitch", 3958 * POUND, 1e9, 0.0))
    for told, weight, inertia, behind in rows:
        found = modes(wing, pylon, rotor_mass, half_fuselage(weight, inertia, behind))
        print(f"{told:42s}", "  ".join(f"{hz:4.2f}" for hz in found))


if __name__ == "__main__":
    main()
