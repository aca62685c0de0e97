"""What every doubtful input of the XV-15 does to its stability boundary, alone and together.

    python -m benchmarks.xv15_inputs           # prints the tables
    python -m benchmarks.xv15_inputs --page    # and writes them into docs/xv15-effects.md

Ranges are judgements of what an input could be, not measured scatter. The boundary is the lowest airspeed at
which a wing mode loses its damping, with the pitch equations and all else as the model has it by default.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from rich.console import Console

import proprotor as pp
from benchmarks.page_table import PageTable, page_is_wanted
from benchmarks.paper_figures.blade_state import blade_state
from benchmarks.xv15_boundary import WING, as_text, boundaries, lowest_of_wing
from proprotor.rotor.rotor import MASS_INTEGRALS
from proprotor.support.normal_modes import HUB_AXES
from proprotor.units import KNOT

PUBLISHED_BOUNDARIES = "published: 285 kt (Nixon) to 305 kt (Johnson), elastic blades on the semispan wing"
MARK = "python -m benchmarks.xv15_inputs --page"
DEG, FT = np.pi / 180, 0.3048
FT_LBF = SLUG_FT2 = 4.4482216152605 * FT

Alteration = Callable[[pp.Case], pp.Case]
End = tuple[str, Alteration]


class Input(NamedTuple):
    """An input, where its value comes from, and both ends of its range."""

    name: str
    status: str
    low: End
    high: End


def rotor(**values: Any) -> Alteration:
    """Fields of the rotor set."""
    return lambda case: replace(case, rotor=replace(case.rotor, **values))


def scaled_rotor(factor: float, *names: str) -> Alteration:
    """Fields of the rotor multiplied."""
    return lambda case: rotor(**{name: factor * getattr(case.rotor, name) for name in names})(case)


def airfoil(**values: Any) -> Alteration:
    """Fields of the airfoil set."""
    return lambda case: rotor(airfoil=replace(case.rotor.airfoil, **values))(case)


def scaled_air(factor: float, name: str) -> Alteration:
    """Density or speed of sound multiplied."""

    def alter(case: pp.Case) -> pp.Case:
        return replace(
            case, operation=replace(case.operation, **{name: factor * getattr(case.operation, name)})
        )

    return alter


def blade(deck: str) -> Alteration:
    """The mass integrals of another deck, and the springs that give them the same frequencies."""
    names = (*MASS_INTEGRALS, "flap_stiffness", "lag_stiffness")
    return lambda case: rotor(**{name: getattr(pp.load_case(deck).rotor, name) for name in names})(case)


def lag_damper(ratio: float) -> Alteration:
    """A damper that gives the lag of the standing blade a fraction of critical damping."""

    def alter(case: pp.Case) -> pp.Case:
        critical = 2 * np.sqrt(case.rotor.lag_stiffness * case.rotor.lag_inertia)
        return rotor(lag_damping=ratio * critical)(case)

    return alter


def scaled_mode(factor: float, mode: str, quantity: str) -> Alteration:
    """Generalised mass, frequency or damping of one wing mode multiplied, the other two as they are."""
    powers = {
        "generalised mass": {"mass": 1, "damping": 1, "stiffness": 1},
        "frequency": {"damping": 1, "stiffness": 2},
        "damping": {"damping": 1},
    }

    def alter(case: pp.Case) -> pp.Case:
        scale = np.where(np.array(case.support.names) == mode, factor, 1.0)
        scaled = {
            name: getattr(case.support, name) * scale**power for name, power in powers[quantity].items()
        }
        return replace(case, support=replace(case.support, **scaled))

    return alter


def scaled_hub(factor: float, *entries: tuple[str, str]) -> Alteration:
    """Motions of the hub in a wing mode multiplied."""

    def alter(case: pp.Case) -> pp.Case:
        hub = np.array(case.support.hub)
        for axis, mode in entries:
            hub[HUB_AXES.index(axis), case.support.names.index(mode)] *= factor
        return replace(case, support=replace(case.support, hub=hub))

    return alter


def between(low: float, high: float, unit: str, si: float, field: str) -> tuple[End, End]:
    """A field of the rotor from one value to another."""
    return tuple((f"{value:g} {unit}", rotor(**{field: value * si})) for value in (low, high))


def times(low: float, high: float, build: Callable[..., Alteration], *what: Any) -> tuple[End, End]:
    """Something multiplied."""
    return tuple((f"{factor:g} ×", build(factor, *what)) for factor in (low, high))


AS_IT_IS = rotor()


def wing_inputs() -> Iterator[Input]:
    """The three modes, and how the hub moves in them."""
    for mode in WING:
        yield Input(
            f"{mode}: generalised mass", "assumed", *times(0.7, 1.3, scaled_mode, mode, "generalised mass")
        )
        yield Input(f"{mode}: frequency", "recalled", *times(0.9, 1.1, scaled_mode, mode, "frequency"))
        yield Input(f"{mode}: damping", "recalled", *times(0, 2, scaled_mode, mode, "damping"))
    mast = (("x", "torsion"), ("y", "chord"))
    yield Input("mast height h", "recalled", *times(0.8, 1.2, scaled_hub, *mast))
    slope = (("alpha_z", "beam"), ("alpha_x", "chord"), ("y", "chord"))
    yield Input("end slope s of the wing", "derived", *times(0.8, 1.2, scaled_hub, *slope))


def rotor_inputs() -> Iterator[Input]:
    """Control system, springs, hinges and masses of the blade."""
    control = between(5000, 22400, "ft lbf/rad", FT_LBF, "control_stiffness")
    yield Input("control stiffness K_θ", "calibrated", *control)
    offset = between(10, 25, "deg", DEG, "structural_pitch_offset")
    yield Input("structural pitch offset δs", "calibrated", *offset)
    yield Input("precone", "published", *between(1.5, 3.5, "deg", DEG, "precone"))
    for spring in ("flap", "lag"):
        yield Input(f"{spring} stiffness", "published", *times(0.8, 1.2, scaled_rotor, f"{spring}_stiffness"))
    yield Input("pitch inertia", "assumed", *between(0.4, 0.7, "slug ft²", SLUG_FT2, "pitch_inertia"))
    yield Input("lag damping of the blade", "assumed", ("0", AS_IT_IS), ("1 % of critical", lag_damper(0.01)))
    yield Input("flap hinge offset", "derived", *between(0.79, 0.9, "ft", FT, "flap_hinge_offset"))
    for_105 = rotor(flap_hinge_offset=(105 - 81.8) / 10.2 * FT)  # I_βα = I_β + e_β S_β
    yield Input("I_βα", "published", ("90 slug ft²", AS_IT_IS), ("105 slug ft²", for_105))
    masses = times(0.95, 1.05, scaled_rotor, "blade_mass", "blade_first_moment")
    yield Input("blade mass, first moment", "derived", *masses)
    distribution = ("mass distribution", blade("xv15-mass-distribution"))
    yield Input("mass integrals", "derived", ("Table 1", AS_IT_IS), distribution)


def air_inputs() -> Iterator[Input]:
    """Sections and air."""
    yield Input("chord", "derived", ("14 in, drawn", rotor(chord=14 / 12 * FT)), ("14.6 in", AS_IT_IS))
    yield Input("profile drag", "assumed", ("0.004", airfoil(drag=0.004)), ("0.010", airfoil(drag=0.010)))
    zero_lift = ("-2 deg", airfoil(zero_lift_angle=-2 * DEG))
    yield Input("zero-lift angle", "assumed", zero_lift, ("0 deg", AS_IT_IS))
    yield Input("section moment c_m", "assumed", ("-0.03", airfoil(moment=-0.03)), ("0", AS_IT_IS))
    yield Input("density", "assumed", *times(0.95, 1.05, scaled_air, "density"))
    yield Input("speed of sound", "assumed", *times(0.97, 1.03, scaled_air, "speed_of_sound"))


def altered(case: pp.Case, *alterations: Alteration) -> pp.Case:
    for alter in alterations:
        case = alter(case)
    return case


def boundary(case: pp.Case, *alterations: Alteration) -> float:
    """Boundary of the wing modes in kt; NaN where no such rotor can be, infinity beyond the sweep."""
    try:
        return lowest_of_wing(boundaries(altered(case, *alterations)))
    except pp.InputError:
        return np.nan


class Effect(NamedTuple):
    """An input, the boundary at both ends of its range, and with the input as the deck has it."""

    input: Input
    boundaries: tuple[float, float]
    baseline: float

    @property
    def worst(self) -> End:
        """The end with the lower boundary."""
        return (self.input.low, self.input.high)[int(np.nanargmin(self.boundaries))]

    @property
    def lowering(self) -> float:
        """What that end takes off the boundary, kt."""
        return max(self.baseline - np.nanmin(self.boundaries), 0.0)


def effects(case: pp.Case) -> list[Effect]:
    """Every input alone; the one that lowers the boundary most comes first."""
    baseline = boundary(case)
    found = []
    for one in (*wing_inputs(), *rotor_inputs(), *air_inputs()):
        found.append(Effect(one, tuple(boundary(case, alter) for _, alter in (one.low, one.high)), baseline))
    return sorted(found, key=lambda effect: -effect.lowering)


def combined(case: pp.Case, found: list[Effect]) -> tuple[float, float]:
    """Boundaries with all inputs at their lower end: of the wing, and of the rotor's own modes."""
    alterations = [alter for _, alter in (effect.worst for effect in found)]
    found = boundaries(altered(case, *alterations))
    return lowest_of_wing(found), found["rotor"]


def groups(found: list[Effect]) -> dict[str, list[Effect]]:
    """Which inputs to move together, of those that lower the boundary by half a knot or more."""
    found = [effect for effect in found if effect.lowering >= 0.5]
    not_published = [effect for effect in found if effect.input.status != "published"]
    wing = {one.name for one in wing_inputs()}
    return {
        "of the wing": [effect for effect in found if effect.input.name in wing],
        "neither published nor calibrated": [e for e in not_published if e.input.status != "calibrated"],
        "not published": not_published,
        "all of the table": found,
    }


def alone(found: list[Effect]) -> PageTable:
    """Return the boundary at both ends of the range of each input."""
    rows = []
    for effect in found:
        name, status, (low, _), (high, _) = effect.input
        speeds = ("not possible" if np.isnan(speed) else as_text(speed) for speed in effect.boundaries)
        rows.append((name, status, low, high, *speeds))
    return PageTable(f"{MARK}: alone", ("input", "status", "from", "to", "kt, from", "to"), rows)


def together(case: pp.Case, found: list[Effect]) -> PageTable:
    """Return the boundary with the inputs of each group together."""
    rows = []
    for name, group in groups(found).items():
        independent = group[0].baseline - np.sqrt(sum(effect.lowering**2 for effect in group))
        rows.append((name, str(len(group)), as_text(independent), *map(as_text, combined(case, group))))
    columns = ("number", "wing, root of squares", "wing, all at worst", "rotor alone, all at worst")
    return PageTable(f"{MARK}: together", ("inputs together (those that lower the boundary)", *columns), rows)


def one_after_another(case: pp.Case, group: list[Effect]) -> PageTable:
    """Return the boundary with one more input at its worst in each row."""
    rows = []
    for count, effect in enumerate(group, start=1):
        end, _ = effect.worst
        rows.append((f"{effect.input.name} {end}", *map(as_text, combined(case, group[:count]))))
    return PageTable("", ("and", "wing", "rotor"), rows)


def control_stiffness(case: pp.Case) -> PageTable:
    """Return the boundaries with the softest control system of the range, and with those calibrated at two speeds."""
    own = case.rotor.control_stiffness
    at_300 = float(blade_state(case, 300 * KNOT).pitch_lag_coupling[0])
    stiffnesses = {
        "the softest of the range": 5000 * FT_LBF,
        "K_Pζ = -0.3 at 300 kt": own * at_300 / -0.3,  # couplings are inversely proportional to it
        "K_Pζ = -0.3 at the boundary, as in the deck": own,
    }
    rows = []
    for name, stiffness in stiffnesses.items():
        found = boundaries(rotor(control_stiffness=stiffness)(case))
        speeds = (as_text(lowest_of_wing(found)), as_text(found["rotor"]))
        rows.append((name, f"{stiffness / FT_LBF:,.0f}", *speeds))
    return PageTable(
        f"{MARK}: control stiffness", ("control system", "K_θ, ft lbf/rad", "wing, kt", "rotor, kt"), rows
    )


def main() -> None:
    """Print all tables, and write those of the page into it."""
    page, console = page_is_wanted(__doc__), Console(width=110, highlight=False)
    case = pp.load_case("xv15-uncoupled")
    found = effects(case)
    tables = {
        f"boundary of the wing {found[0].baseline:.0f} kt; with one input at an end of its range": alone(
            found
        ),
        "inputs together: boundary, kt": together(case, found),
        "control stiffness alone": control_stiffness(case),
    }
    for title, table in tables.items():
        console.print(table.printed(title))
        if page:
            table.write("xv15-effects.md")
    last = one_after_another(case, groups(found)["not published"])
    console.print(last.printed("not published, one more in each row: boundary, kt"))
    console.print(PUBLISHED_BOUNDARIES)


if __name__ == "__main__":
    main()
