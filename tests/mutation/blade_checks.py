"""Inertia, springs, pitch and dampers of one blade in rotating axes."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Iterator

import numpy as np
from proprotor_equations import BLADE_COORDINATES
from proprotor_equations.fused import plain as plans

from proprotor.rotor.fused import effective_stiffness
from proprotor.rotor.fused import trim_integrals as integrals_by_plan
from tests.mutation import one_blade, paper_blade
from tests.mutation.comparison import Check, Names, matrix_check, values_check
from tests.mutation.inputs import (
    Quantities,
    blade_quantities,
    first_order_integrals,
    natural_sizes,
    points,
    published_quantities,
    spring_constants,
    spring_energy,
    stacked,
    trim_integrals,
)
from tests.mutation.one_blade import STEP, Matrices

# So that the plans for plain rotors are taken.
_NO_LINKAGES = dict.fromkeys(plans.ABSENT, 0.0) | {"beside_axis": False}


def checks() -> Iterator[Check]:
    yield from _mass_integrals()
    yield from _inertia()
    yield from _beside_axis()
    yield from _springs()
    yield from _pitch()
    yield _couplings()
    yield _given_frequencies()


def _of_matrices(
    names: Iterable[Names | None], told: str, quantities: Quantities, matrices: Iterable[Matrices]
) -> Iterator[Check]:
    """Checks of the functions that make M, C and K of a blade; None where there is no function."""
    by_kind = zip(*matrices, strict=True)
    for sees, expected, natural in zip(names, by_kind, natural_sizes(), strict=True):
        if sees is not None:
            yield matrix_check(sees, told, quantities, np.array(expected), natural)


def _mass_integrals() -> Iterator[Check]:
    for sees, made in (
        (("inertia", "dependent_inertias"), one_blade.hub_couplings),
        (("inertia", "trim_integrals"), trim_integrals),
        (("published.inertia", "trim_integrals"), first_order_integrals),
    ):
        yield values_check(sees, "sums over point masses", blade_quantities(), stacked(map(made, points())))
    sums = stacked(map(trim_integrals, points()))
    sums = {name: sums[name] for name in plans.TRIM_INTEGRALS}
    fused = functools.partial(integrals_by_plan, blade_quantities() | _NO_LINKAGES)
    yield Check(("fused.plain", "trim_integrals"), "sums over point masses", fused, sums, sums)


def _inertia() -> Iterator[Check]:
    kinds = ("mass", "gyroscopic", "centrifugal_stiffness")
    names = [("inertia", kind) for kind in kinds]
    told = "accelerations of the nonlinear rotor"
    yield from _of_matrices(names, told, blade_quantities(), map(one_blade.mass_matrices, points()))
    names = [("published.inertia", kind) for kind in kinds]
    told = "kinematics of the nonlinear rotor without what the paper leaves out"
    yield from _of_matrices(names, told, published_quantities(), map(paper_blade.mass_matrices, points()))


def _beside_axis() -> Iterator[Check]:
    """Masses beside the pitch axis."""
    sums = stacked(map(one_blade.beside_line, points()))
    told = "sums over point masses beside the axis"
    yield values_check(("offset_mass", "trim_integrals"), told, blade_quantities(), sums)
    names = [("offset_mass", kind) for kind in ("mass", "gyroscopic", "centrifugal_stiffness")]
    told = "accelerations of the nonlinear rotor, with and without its offsets"
    yield from _of_matrices(names, told, blade_quantities(), map(one_blade.offset_matrices, points()))
    places = [BLADE_COORDINATES.index(name) for name in ("flap", "lag")]
    pitch = BLADE_COORDINATES.index("pitch")
    expected = []
    for p in points():
        _, _, stiffness = one_blade.offset_matrices(one_blade.without_linkages(p))
        moments = stiffness[pitch, places] / p.rotor.control_stiffness
        expected.append(dict(zip(("pitch_flap_coupling", "pitch_lag_coupling"), moments, strict=True)))
    sizes = [
        natural_sizes()[2][:, pitch, place] / blade_quantities()["control_stiffness"] for place in places
    ]
    natural = dict(zip(expected[0], sizes, strict=True))
    names = ("offset_mass", "couplings")
    yield values_check(names, told, blade_quantities(), stacked(expected), natural)


def _springs() -> Iterator[Check]:
    quantities, constants = blade_quantities(), stacked(map(spring_constants, points()))
    size = quantities["flap_stiffness"] + quantities["lag_stiffness"]  # slopes are differences of the two
    sees, told = ("flap_lag_springs", "effective_stiffness"), "energy of springs in series"
    yield values_check(sees, told, quantities, constants, dict.fromkeys(constants, size))
    fused = functools.partial(effective_stiffness, quantities | _NO_LINKAGES)
    yield Check(
        ("fused.plain", "effective_stiffness"), told, fused, constants, dict.fromkeys(constants, size)
    )
    matrices = [one_blade.spring_matrices(p) for p in points()]
    yield from _of_matrices((None, None, ("flap_lag_springs", "stiffness")), told, quantities, matrices)
    flap, lag, pitch = (BLADE_COORDINATES.index(name) for name in ("flap", "lag", "pitch"))
    kept = np.zeros((len(BLADE_COORDINATES),) * 2)
    kept[np.ix_((flap, lag, pitch), (flap, lag))] = 1.0  # springs that stay at the pitch of trim
    alone = (one_blade.spring_matrices(one_blade.without_linkages(p)) for p in points())
    published = [tuple(matrix * kept for matrix in three) for three in alone]
    names = (None, None, ("published.flap_lag_springs", "stiffness"))
    yield from _of_matrices(names, f"{told} at the pitch of trim", quantities, published)


def _pitch() -> Iterator[Check]:
    names = [("pitch", kind) for kind in ("mass", "damping", "stiffness")]
    told = "energies and dampers of the nonlinear rotor"
    yield from _of_matrices(names, told, blade_quantities(), map(one_blade.pitch_matrices, points()))
    names = (("published.pitch", "mass"), None, ("published.pitch", "stiffness"))
    absent = ("propeller_moment", "pitch_gimbal_coupling")
    matrices = (one_blade.pitch_matrices(one_blade.without_linkages(p), *absent) for p in points())
    told = f"{told} without propeller moment and linkages"
    yield from _of_matrices(names, told, blade_quantities(), matrices)


def _couplings() -> Check:
    """K_Pβ and K_Pζ: change of the springs' pitch moment with an angle, over the control system's stiffness."""
    expected = []
    for p in points():
        coning, lag, step = p.state["coning"], p.state["lag"], 1j * STEP
        bent = {"pitch_flap_coupling": (coning + step, lag), "pitch_lag_coupling": (coning, lag + step)}
        moments = {name: spring_energy(p, *angles).rate.imag / STEP for name, angles in bent.items()}
        expected.append({name: float(moment) / p.rotor.control_stiffness for name, moment in moments.items()})
    return values_check(
        ("pitch", "couplings"), "energy of springs in series", blade_quantities(), stacked(expected)
    )


def _given_frequencies() -> Check:
    """Springs that bring a flat blade of point masses to given frequencies."""
    flap, lag, cyclic = (
        np.array([51.0, 60.0, 47.0]),
        np.array([70.0, 20.0, 90.0]),
        np.array([80.0, 81.0, 55.0]),
    )
    expected = []
    for place, p in enumerate(points()):
        mass, (r, flap_arm, lag_arm), omega = p.rotor.mass, one_blade.arms(p), p.rotor.rotor_speed
        flap_inertia, lag_inertia = mass @ flap_arm**2, mass @ lag_arm**2
        # Centrifugal force holds a flapping blade all along r; of a lagging one only the hinge's offset is a lever.
        flap_held, lag_held = (
            omega**2 * (mass @ (r * flap_arm)),
            omega**2 * (mass @ ((r - lag_arm) * lag_arm)),
        )
        values = {
            "flap_flap_stiffness": flap_inertia * flap[place] ** 2 - flap_held,
            "lag_lag_stiffness": lag_inertia * lag[place] ** 2 - lag_held,
            "cyclic_flap_stiffness_excess": flap_inertia * (cyclic[place] ** 2 - flap[place] ** 2),
        }
        expected.append(values)
    quantities = blade_quantities()
    given = {"rotating_flap_frequency": flap, "rotating_lag_frequency": lag, "cyclic_flap_frequency": cyclic}
    sizes = dict.fromkeys(expected[0], quantities["blade_inertia"] * quantities["rotor_speed"] ** 2)
    sees = ("flap_lag_springs", "stiffness_of_frequencies")
    return values_check(sees, "a flat blade of point masses", quantities | given, stacked(expected), sizes)
