"""How exact the radial moments of the section loads are, with the stations that the package takes.

    OPENBLAS_NUM_THREADS=1 python -m benchmarks.stations

The reference has some thousand stations: panels with edges at every knot of the tables and a few more towards the root,
24 points on each. Moments are those of the loads and of all their derivatives, on each segment, at the trim of the
reference. The error of a moment is told in the moment itself; a moment that is a small difference of large parts has no
size of its own, so the error by the moment of the load without its sign stands beside it. Short panels are those of
airfoil tables, and were those of every airfoil. Chord tables are invented, and their kinks are not where those of the
twist are.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

import proprotor as pp
from proprotor.model.first_order import state_matrix
from proprotor.model.quantities import model_quantities
from proprotor.rotor.options import Options
from proprotor.rotor.quadrature import RadialQuadrature, short_panels
from proprotor.rotor.section_loads import BladeSections, load_moments, segment_quantities
from proprotor.rotor.trim import UNKNOWNS, with_trim
from proprotor.units import KNOT

SHARES = (0.02, 0.05, 0.1, 0.2, 0.4, 0.8, 1.2)  # airspeed by tip speed
POINTS = 24
OURS = "as the package"
TAPER = (np.array([0.05, 0.19, 0.33, 0.71, 0.97, 1.0]), np.array([0.3, 0.5, 0.42, 0.36, 0.3, 0.12]))
SPEEDS = np.linspace(100, 400, 13) * KNOT


def with_panels(rotor: pp.Rotor, points: int | None) -> pp.Rotor:
    """The rotor with short panels and the chord and twist of the tables at the stations; more points on each."""
    knots = [np.asarray(table[0]) for table in (rotor.chord, rotor.twist) if isinstance(table, tuple)]
    joined = np.concatenate([*knots, np.geomspace(0.01, 0.3, 12) * rotor.radius] if points else knots)
    radii = {
        name: getattr(rotor, name)
        for name in ("root_cutout", "radius", "flap_hinge_offset", "lag_hinge_offset")
    }
    panels = short_panels(**radii, knots=joined)
    if points:
        panels = panels._replace(points=np.where(panels.points > 0, points, 0))
    own = replace(rotor)
    own.__dict__["_panels"] = panels
    own.__dict__["sections"] = own._sections_at(own.quadrature)
    return own


def moments(rotor: pp.Rotor, case: pp.Case, airspeed: NDArray, state: dict[str, NDArray], sign: Any) -> Any:
    """Radial moments of all section loads at a trim: names to (points, segments)."""
    options = Options()
    shape = airspeed.shape
    given = model_quantities(rotor, case.operation, options, airspeed, shape)
    quantities = with_trim(given, options, state)
    sections = BladeSections.of(rotor, shape)
    sections = replace(sections, quadrature=sign(sections.quadrature))
    segments = segment_quantities(sections, quantities)
    return load_moments(sections, segments, compressibility=True)


class Unsigned(RadialQuadrature):
    """Moments of the loads without their signs."""

    def moments(self, section_load: NDArray) -> NDArray:
        return super().moments(np.abs(section_load))

    @classmethod
    def of(cls, quadrature: RadialQuadrature) -> Unsigned:
        return cls(**{name: getattr(quadrature, name) for name in quadrature.__dataclass_fields__})


def errors(case: pp.Case, airspeed: NDArray) -> dict[str, tuple[int, NDArray, NDArray]]:
    """Stations, and the largest errors (points,) of a moment by itself and without signs, of each rule."""
    rotor = case.rotor
    exact = with_panels(rotor, POINTS)
    trim = pp.rotor_model(exact, case.operation, airspeed).trim
    state = {name: getattr(trim, name) for name in UNKNOWNS}
    reference = moments(exact, case, airspeed, state, lambda quadrature: quadrature)
    sizes = moments(exact, case, airspeed, state, Unsigned.of)
    found = {}
    for name, own in {"short panels": with_panels(rotor, None), OURS: rotor}.items():
        ours = moments(own, case, airspeed, state, lambda quadrature: quadrature)
        parts = []
        for load, value in ours.items():
            difference = np.abs(value - reference[load])
            for scale in (np.abs(reference[load]), sizes[load]):
                parts.append(
                    np.broadcast_to(difference / np.where(scale > 0, scale, 1.0), (len(airspeed), 2)).max(
                        axis=-1
                    )
                )
        found[name] = own.quadrature.stations.shape[-1], *(np.max(parts[k::2], axis=0) for k in (0, 1))
    return found


def cases() -> dict[str, pp.Case]:
    """The XV-15, with more of its own section's loads, and with a chord that tapers."""
    xv15 = pp.load_case("xv15")
    lively = replace(xv15, rotor=replace(xv15.rotor, airfoil=replace(xv15.rotor.airfoil, moment=-0.02)))
    radius = xv15.rotor.radius
    tapered = replace(lively, rotor=replace(lively.rotor, chord=(TAPER[0] * radius, TAPER[1])))
    return {"XV-15": xv15, "with a section's moment": lively, "and a tapered chord": tapered}


def print_moments(console: Console) -> None:
    for name, case in cases().items():
        tip_speed = case.operation.rotor_speed * case.rotor.radius
        found = errors(case, np.array(SHARES) * tip_speed)
        table = Table(
            "V/ΩR",
            *(f"{rule}, {count}: {by}" for rule, (count, *_) in found.items() for by in ("itself", "size")),
            title=name,
        )
        for place, share in enumerate(SHARES):
            table.add_row(
                f"{share:g}", *(f"{part[place]:.1e}" for _, *parts in found.values() for part in parts)
            )
        console.print(table)


def print_models(console: Console) -> None:
    """State matrices and flutter speeds beside those of the reference."""
    case = pp.load_case("xv15")
    rules = {"short panels": None, "reference": POINTS}
    own = {name: replace(case, rotor=with_panels(case.rotor, points)) for name, points in rules.items()}
    own[OURS] = case
    reference = state_matrix(own["reference"].linearize(SPEEDS))
    scale = np.abs(reference).max(axis=(1, 2))
    exact = case_boundary(own["reference"])
    for name in ("short panels", OURS):
        difference = np.abs(state_matrix(own[name].linearize(SPEEDS)) - reference).max(axis=(1, 2)) / scale
        console.print(
            f"{name}: state matrix within {difference.max():.1e} of its largest entry, "
            f"flutter speed within {abs(case_boundary(own[name]) - exact):.1e} m/s"
        )


def case_boundary(case: pp.Case) -> float:
    """The flutter speed, m/s."""
    return float(case.flutter_point("300:420:20kt").speed)


def main() -> None:
    """Print all of it."""
    console = Console(width=130, highlight=False)
    print_moments(console)
    print_models(console)


if __name__ == "__main__":
    main()
