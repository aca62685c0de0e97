"""What a difference between print and derivation does to the XV-15's stability boundary, in knots.

Each variant of the equations is made in memory, below the runtime's own checks where those would refuse it. The
boundary is the lowest speed at which a mode loses its damping.
"""

from __future__ import annotations

import contextlib
import copy
import functools
from collections.abc import Callable, Iterator
from dataclasses import replace
from types import ModuleType, SimpleNamespace
from typing import Any, cast
from unittest import mock

import numpy as np
import sympy as sp
import xarray
from numpy.typing import NDArray
from proprotor_equations import BLADE_COORDINATES
from proprotor_equations import pitch as pitch_equations

import proprotor as pp
from derive import multiblade
from derive import symbols as s
from derive.counterparts import COUNTERPARTS
from derive.emit import render_module
from derive.equations import REDUCED_MODULES, STEPS
from derive.printed import TABLES
from derive.printed.notation import TIME
from derive.published import DROPPED_TERMS, PUBLISHED
from proprotor import model as runtime
from proprotor.branches import by_branch
from proprotor.equation_set import EQUATION_SETS, EquationSet

_FLAP, _LAG = (BLADE_COORDINATES.index(name) for name in ("flap", "lag"))
KNOT = 1852 / 3600
SPEEDS = np.arange(100, 521, 5) * KNOT
SLUG_FT2 = 1.3558179483


# The audit is of the paper's equations: what is not of the derivation by dropped terms is as the paper has it.
AS_THE_PAPER: dict[str, Any] = {term.option: False for term in DROPPED_TERMS.values() if term.option}


@functools.cache
def xv15() -> pp.Case:
    return pp.load_case("xv15")


def modes_of(case: pp.Case | None = None, **options: Any) -> xarray.Dataset:
    """Return the roots of the XV-15, or another case, over `SPEEDS`; no section damping where nothing else is chosen.

    By branch, for what moves is handed from root to root, and its damping then jumps.
    """
    return by_branch((case or xv15()).sweep(SPEEDS, **AS_THE_PAPER | options))


def boundary(case: pp.Case | None = None, **options: Any) -> float:
    """Lowest speed at which the damping of a mode goes through zero, kt; NaN where none does."""
    return lowest(boundaries(modes_of(case, **options)))


def boundaries(modes: xarray.Dataset) -> dict[str, float]:
    """Lowest speed at which each root loses its damping, kt; roots that do not lose it are left out."""
    found: dict[str, float] = {}
    for name, damping in zip(modes.branch.values.tolist(), modes.damping_ratio.values.T, strict=True):
        for i in np.flatnonzero((damping[:-1] > 0) & (damping[1:] <= 0))[:1]:
            speeds = SPEEDS[[i + 1, i]] / KNOT
            found[name] = float(np.interp(0, [damping[i + 1], damping[i]], speeds))
    return found


def lowest(of: dict[str, float]) -> float:
    return min(of.values(), default=np.nan)


def in_knots(boundary: float) -> str:
    """A boundary as tables show it."""
    return f"none below {SPEEDS[-1] / KNOT:.0f} kt" if np.isnan(boundary) else f"{boundary:.1f} kt"


@functools.cache
def base(equations: str = "consistent", pitch: str = "dynamic") -> float:
    return boundary(equations=equations, pitch=pitch)


class _Asking(frozenset[str]):
    """No dropped term at all; keeps the names it is asked for. Equal to nothing else, so no cached result answers."""

    def __init__(self) -> None:
        self.asked: set[str] = set()

    def __contains__(self, term: object) -> bool:
        self.asked.add(str(term))
        return False

    __hash__ = object.__hash__
    __eq__ = object.__eq__


@functools.cache
def _derivation(module: str) -> tuple[frozenset[str], dict[str, tuple[Any, ...]]]:
    """Dropped terms the derivation of a module asks for, and the arguments of its functions with none dropped."""
    dropped = _Asking()
    changing = STEPS[module].changing(dropped)
    arguments = {function.name: tuple(function.arguments) for function in changing}
    return frozenset(dropped.asked), arguments


def reached_by(term: str) -> tuple[str, ...]:
    """Modules whose derivation asks whether a term is dropped: no other one can change without it."""
    return tuple(module for module in REDUCED_MODULES if term in _derivation(module)[0])


@functools.cache
def _module(name: str, dropped: frozenset[str]) -> ModuleType:
    _, arguments = _derivation(name)
    changing = STEPS[name].changing(dropped)
    functions = [replace(function, signature=arguments[function.name]) for function in changing]
    module = ModuleType(f"reduced_{name}")
    exec(render_module(functions, STEPS[name].title), vars(module))
    return module


def equations_without(dropped: frozenset[str], of: str, changed: frozenset[str]) -> EquationSet:
    """The set `of` with the modules derived again that the terms of `changed` reach."""
    names = sorted({module for term in changed for module in reached_by(term)})
    in_module = {name: dropped & _derivation(name)[0] for name in names}
    return replace(EQUATION_SETS[of], **{name: _module(name, in_module[name]) for name in names})


def consistent_but(*terms: str) -> EquationSet:
    """The consistent equations without some terms."""
    dropped = frozenset(terms)
    return equations_without(dropped, "consistent", dropped)


def published_and(*terms: str) -> EquationSet:
    """The published equations with terms put back."""
    back = frozenset(terms)
    return equations_without(PUBLISHED - back, "published", back)


@functools.cache
def boundaries_without(term: str) -> dict[str, float]:
    """Boundary of each mode by the consistent equations without one term."""
    return boundaries(modes_of(equations=consistent_but(term)))


def without(term: str) -> float:
    """Boundary of the consistent equations without one term."""
    return lowest(boundaries_without(term))


@functools.cache
def published_with(*terms: str) -> float:
    """Boundary of the published equations with terms put back."""
    return boundary(equations=published_and(*terms))


def gimbal_question() -> dict[str, float]:
    """Eq. 3's gimbal terms in the published equations: none, either alone, both."""
    return {
        "as published, neither": base("published"),
        "with the gimbal's Coriolis term alone": published_with("gimbal_coriolis"),
        "with the roll of the rigid yoke alone": published_with("yoke_roll"),
        "with both, the rigid yoke": published_with("gimbal_coriolis", "yoke_roll"),
        "consistent without the roll": without("yoke_roll"),
        "consistent without the Coriolis term": without("gimbal_coriolis"),
        "consistent": base(),
    }


def with_printed_coriolis_sign(of: str) -> EquationSet:
    """The flap row's lag rate with the sign of Eq. 13; the lag row keeps its own."""
    inertia = EQUATION_SETS[of].inertia

    @functools.wraps(inertia.gyroscopic)
    def gyroscopic(**quantities: Any) -> NDArray[Any]:
        matrix = np.array(inertia.gyroscopic(**quantities))
        matrix[..., _FLAP, _LAG] *= -1
        return matrix

    changed = SimpleNamespace(**vars(inertia) | {"gyroscopic": gyroscopic})
    return replace(EQUATION_SETS[of], inertia=cast(ModuleType, changed))


def printed_coriolis_sign() -> tuple[str, float, float]:
    changed = boundary(equations=with_printed_coriolis_sign("published"))
    return "published, ζ' term of Eq. 13 as printed", changed, base("published")


@contextlib.contextmanager
def couplings_turned() -> Iterator[None]:
    """Eq. 35 taken by its sign turns both couplings round."""
    couplings = pitch_equations.couplings

    @functools.wraps(couplings)
    def turned(**quantities: Any) -> Any:
        values = couplings(**quantities)
        return values._replace(**{name: -value for name, value in values._asdict().items()})

    with mock.patch.object(
        runtime, "pitch", SimpleNamespace(**vars(pitch_equations) | {"couplings": turned})
    ):
        yield


def printed_coupling_sign() -> tuple[str, float, float]:
    with couplings_turned():
        changed = boundary(pitch="coupling")
    return "K_Pβ and K_Pζ by the sign of Eq. 35", changed, base(pitch="coupling")


def with_flap_hub_inertia(value: float) -> pp.Case:
    """The XV-15 with an I_βα (kg m²) of its own. `Rotor` would refuse it, so it goes in after validation."""
    rotor = copy.copy(xv15().rotor)
    rotor.__dict__["_dependent"] = rotor._dependent._replace(flap_hub_inertia=value)
    return replace(xv15(), rotor=rotor)


def printed_flap_hub_inertia() -> tuple[str, float, float]:
    printed = TABLES[0].values["I_βα"] * SLUG_FT2
    consistent = xv15().rotor.flap_hub_inertia / SLUG_FT2
    case = with_flap_hub_inertia(printed)
    label = f"I_βα = {TABLES[0].values['I_βα']:g} as printed, for {consistent:.1f} slug ft² of one blade; "
    label += (
        f"a mode has {100 * least_damping_at_best(case):.0f} % of critical or less at every speed, the others"
    )
    return label, boundary(case), base()


def least_damping_at_best(case: pp.Case) -> float:
    """Damping ratio of the worst mode where it is best; below zero, the case is unstable at every speed."""
    return float(modes_of(case).damping_ratio.min("branch").max())


# Consequences of conflicts, by equation or table; those of absent terms are `without` each.
OF_CONFLICT: dict[int | str, Callable[[], tuple[str, float, float]]] = {
    13: printed_coriolis_sign,
    35: printed_coupling_sign,
    "Table 1": printed_flap_hub_inertia,
}


def steady_tilt(azimuth: float = 0.0) -> dict[str, float]:
    """In-plane acceleration of the XV-15's tip per degree of steady tilt beta_GS, m/s²: a term alone, rigid yoke."""
    of = {
        "Coriolis term alone": frozenset({"yoke_roll"}),
        "roll of the yoke alone": frozenset({"gimbal_coriolis"}),
        "rigid yoke": frozenset(),
    }
    at = {multiblade.psi: azimuth}
    return {label: float(_tip_acceleration(dropped).subs(at)) for label, dropped in of.items()}


@functools.cache
def _tip_acceleration(dropped: frozenset[str]) -> sp.Expr:
    """Along i, of the azimuth."""
    rotor = xv15().rotor
    numbers = {
        s.radial_station: rotor.radius,
        s.precone: rotor.precone,
        s.coning: 0,
        s.rotor_speed: xv15().operation.rotor_speed,
        TIME["gimbal_1s"][0]: np.radians(1),
    }
    still = {q: 0 for motion in TIME.values() for q in motion}
    return COUNTERPARTS[3](dropped)["i"].subs(numbers).subs(still)
