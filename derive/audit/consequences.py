"""What a difference between print and derivation does to the stability boundary of the XV-15, in knots.

A term is dropped, or put back, by deriving the modules again that have it. A sign of the print is put into the derived
matrix. A number of the print that no rotor can have goes into a rotor without checks. The boundary is the lowest speed
at which a mode loses its damping.

No other module of `derive` computes with the runtime, and this one does by its public names.
"""

from __future__ import annotations

import functools
import importlib.util
import tempfile
from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import proprotor_equations
import sympy as sp
import xarray
from numpy.typing import ArrayLike, NDArray

import proprotor as pp
from derive import multiblade
from derive import symbols as s
from derive.audit.counterparts import COUNTERPARTS
from derive.audit.printed import TABLES
from derive.audit.printed.notation import TIME
from derive.emit import render_module
from derive.equations import REDUCED_MODULES, STEPS, reduced_functions
from derive.function import Function
from derive.published import CONSISTENT, DROPPED_TERMS, PUBLISHED, check_names

KNOT = 1852 / 3600
SPEEDS = np.arange(100, 521, 5) * KNOT
SLUG_FT2 = 1.3558179483

Boundary = tuple[str, float, float]
"""What was changed, the boundary with the change and the boundary without it, kt."""

# The audit is of the paper's equations: an option that stands for a dropped term is set as the paper has it.
AS_THE_PAPER: dict[str, Any] = {term.option: False for term in DROPPED_TERMS.values() if term.option}


# Modes and boundaries


@functools.cache
def xv15() -> pp.Case:
    """Return the XV-15 of the paper's Table 1."""
    return pp.load_case("xv15-uncoupled")


@functools.cache
def hub_held() -> pp.Case:
    """Return the XV-15 with its rotor on a hub that does not move."""
    return replace(xv15(), support=pp.rigid_support())


def modes_of(case: pp.Case | None = None, speeds: NDArray[Any] = SPEEDS, **options: Any) -> xarray.Dataset:
    """Return the roots of the XV-15, or of another case, at some airspeeds, by branch.

    A branch is one root, followed from speed to speed. A name of a mode would pass from root to root where motions are
    exchanged, and the damping would jump there. Section damping is off where no option says otherwise.
    """
    return pp.by_branch((case or xv15()).sweep(speeds, **AS_THE_PAPER | options))


def boundary(case: pp.Case | None = None, **options: Any) -> float:
    """Return the lowest speed at which the damping of a mode goes through zero, kt; NaN where none does."""
    return lowest(boundaries(modes_of(case, **options)))


def boundaries(modes: xarray.Dataset) -> dict[str, float]:
    """Return the lowest speed at which each root loses its damping, kt, without the roots that keep it."""
    found: dict[str, float] = {}
    for name, damping in zip(modes.branch.values.tolist(), modes.damping_ratio.values.T, strict=True):
        for i in np.flatnonzero((damping[:-1] > 0) & (damping[1:] <= 0))[:1]:
            speeds = SPEEDS[[i + 1, i]] / KNOT
            found[name] = float(np.interp(0, [damping[i + 1], damping[i]], speeds))
    return found


def lowest(boundaries: dict[str, float]) -> float:
    """Return the lowest of the boundaries, kt; NaN where there is none."""
    return min(boundaries.values(), default=np.nan)


def in_knots(boundary: float) -> str:
    """Return a boundary as tables show it."""
    return f"none below {SPEEDS[-1] / KNOT:.0f} kt" if np.isnan(boundary) else f"{boundary:.1f} kt"


@functools.cache
def base(equations: str = "consistent", pitch: str = "dynamic") -> float:
    """Return the boundary without a change, kt."""
    return boundary(equations=equations, pitch=pitch)


# Equations without some terms


class _Asking(frozenset[str]):
    """An empty set of dropped terms that keeps the names that the derivation looks up in it.

    It equals nothing else, so that no result of an earlier derivation is taken from a cache.
    """

    def __init__(self) -> None:
        self.asked: set[str] = set()

    def __contains__(self, term: object) -> bool:
        self.asked.add(str(term))
        return False

    __hash__ = object.__hash__
    __eq__ = object.__eq__


@functools.cache
def _terms_of(module: str) -> frozenset[str]:
    """Return the dropped terms that the derivation of a module asks for."""
    dropped = _Asking()
    STEPS[module].changing(dropped)
    return frozenset(dropped.asked)


def reached_by(term: str) -> tuple[str, ...]:
    """Return the modules that change without a term: those whose derivation asks whether the term is dropped."""
    return tuple(module for module in REDUCED_MODULES if term in _terms_of(module))


def _imported(module: str, functions: list[Function]) -> ModuleType:
    """Import generated functions that no file of the repository has, from a temporary file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"{module}.py")
        path.write_text(render_module(functions, STEPS[module].title), encoding="utf-8")
        spec = importlib.util.spec_from_file_location(f"changed_{module}", path)
        assert spec is not None and spec.loader is not None
        found = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(found)
    return found


@functools.cache
def _without(module: str, dropped: frozenset[str]) -> ModuleType:
    """Return a generated module derived without some terms."""
    return _imported(module, reduced_functions(module, dropped))


def equation_set(equations: str) -> pp.EquationSet:
    """Return the modules of ``"consistent"`` or ``"published"`` equations, as they are generated."""
    package = {"consistent": proprotor_equations, "published": proprotor_equations.published}[equations]
    return pp.EquationSet(**{module: getattr(package, module) for module in REDUCED_MODULES})


def equations_without(dropped: frozenset[str], equations: str, changed: frozenset[str]) -> pp.EquationSet:
    """Return a set of equations with the modules derived again that some terms reach.

    Parameters
    ----------
    dropped : frozenset of str
        Terms that the modules derived again do without.
    equations : "consistent" or "published"
        The set that has the other modules.
    changed : frozenset of str
        Terms that the set has and the result has not, or the other way round.

    Raises
    ------
    ValueError
        For a term that is not in the list.
    """
    check_names(dropped | changed)
    modules = {module for term in changed for module in reached_by(term)}
    again = {module: _without(module, dropped & _terms_of(module)) for module in sorted(modules)}
    return replace(equation_set(equations), **again)


def consistent_but(*terms: str) -> pp.EquationSet:
    """Return the consistent equations without some terms."""
    dropped = frozenset(terms)
    return equations_without(dropped, "consistent", dropped)


def published_and(*terms: str) -> pp.EquationSet:
    """Return the published equations with some terms put back."""
    back = frozenset(terms)
    return equations_without(PUBLISHED - back, "published", back)


@functools.cache
def boundaries_without(term: str) -> dict[str, float]:
    """Return the boundary of each mode by the consistent equations without one term, kt."""
    return boundaries(modes_of(equations=consistent_but(term)))


def without(term: str) -> float:
    """Return the boundary of the consistent equations without one term, kt."""
    return lowest(boundaries_without(term))


@functools.cache
def published_with(*terms: str) -> float:
    """Return the boundary of the published equations with some terms put back, kt."""
    return boundary(equations=published_and(*terms))


def gimbal_question() -> dict[str, float]:
    """Return boundaries with the gimbal's two terms in Eq. 3 of the published equations: none, either alone, both."""
    return {
        "as published, neither": base("published"),
        "with the gimbal's Coriolis term alone": published_with("gimbal_coriolis"),
        "with the roll of the rigid yoke alone": published_with("yoke_roll"),
        "with both, the rigid yoke": published_with("gimbal_coriolis", "yoke_roll"),
        "consistent without the roll": without("yoke_roll"),
        "consistent without the Coriolis term": without("gimbal_coriolis"),
        "consistent": base(),
    }


# Conflicts


@functools.cache
def with_printed_coriolis_sign(equations: str) -> pp.EquationSet:
    """Return a set of equations whose flap row has the lag rate with the sign of Eq. 13; the lag row stays."""
    dropped = {"consistent": CONSISTENT, "published": PUBLISHED}[equations]
    functions = [
        _with_flap_lag_turned(function) if function.name == "gyroscopic" else function
        for function in reduced_functions("inertia", dropped)
    ]
    return replace(equation_set(equations), inertia=_imported("inertia", functions))


def _with_flap_lag_turned(gyroscopic: Function) -> Function:
    place = ("flap", "lag")
    entry = gyroscopic.entries[place]
    return replace(gyroscopic, entries=gyroscopic.entries | {place: replace(entry, value=-entry.value)})


def printed_coriolis_sign() -> Boundary:
    """Return what the sign of the lag rate in Eq. 13 does to the published equations."""
    changed = boundary(equations=with_printed_coriolis_sign("published"))
    return "published, ζ' term of Eq. 13 as printed", changed, base("published")


def couplings(model: pp.LinearModel, lag: ArrayLike | None = None) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return K_Pβ and K_Pζ of Eqs. 36 and 37 at the trim of a model of the XV-15.

    Parameters
    ----------
    model : LinearModel
    lag : float or array (...), optional
        Trim lag in rad in place of the model's own.
    """
    rotor, trim = xv15().rotor, model.trim
    springs = proprotor_equations.flap_lag_springs.effective_stiffness(
        flap_stiffness=rotor.flap_stiffness,
        lag_stiffness=rotor.lag_stiffness,
        flap_outboard_fraction=rotor.flap_outboard_fraction,
        lag_outboard_fraction=rotor.lag_outboard_fraction,
        structural_pitch=trim.pitch + rotor.structural_pitch_offset,
    )
    found = proprotor_equations.pitch.couplings(
        control_stiffness=rotor.control_stiffness,
        coning=trim.coning,
        lag=trim.lag if lag is None else lag,
        flap_flap_stiffness_slope=springs.flap_flap_stiffness_slope,
        flap_lag_stiffness_slope=springs.flap_lag_stiffness_slope,
        lag_lag_stiffness_slope=springs.lag_lag_stiffness_slope,
    )
    return found.pitch_flap_coupling, found.pitch_lag_coupling


class _CouplingsTurned(pp.Case):
    """The XV-15 with both couplings of opposite sign at every airspeed."""

    def linearize(self, airspeed: Any, **options: Any) -> pp.LinearModel:
        flap, lag = couplings(super().linearize(airspeed, **options))
        return super().linearize(airspeed, **options, pitch_flap_coupling=-flap, pitch_lag_coupling=-lag)


def couplings_turned() -> pp.Case:
    """Return the XV-15 with K_Pβ and K_Pζ turned round, as Eq. 35 by its sign turns them."""
    return _CouplingsTurned(**_fields(xv15()))


def printed_coupling_sign() -> Boundary:
    """Return what the sign of Eq. 35 does."""
    changed = boundary(couplings_turned(), pitch="coupling")
    return "K_Pβ and K_Pζ by the sign of Eq. 35", changed, base(pitch="coupling")


class _Unchecked(pp.Rotor):
    """A rotor that may have an I_βα that no blade has, which `pp.Rotor` refuses."""

    def __post_init__(self) -> None:
        """Check nothing."""


def with_flap_hub_inertia(value: float) -> pp.Case:
    """Return the XV-15 with another I_βα (kg m²), which may be one that no blade has."""

    class Printed(_Unchecked):
        flap_hub_inertia = value

    return replace(xv15(), rotor=Printed(**_fields(xv15().rotor)))


def _fields(record: Any) -> dict[str, Any]:
    return {entry.name: getattr(record, entry.name) for entry in fields(record)}


def printed_flap_hub_inertia() -> Boundary:
    """Return what the I_βα of Table 1 does."""
    printed = TABLES[0].values["I_βα"] * SLUG_FT2
    consistent = xv15().rotor.flap_hub_inertia / SLUG_FT2
    case = with_flap_hub_inertia(printed)
    label = f"I_βα = {TABLES[0].values['I_βα']:g} as printed, for {consistent:.1f} slug ft² of one blade; "
    label += (
        f"a mode has {100 * least_damping_at_best(case):.0f} % of critical or less at every speed, the others"
    )
    return label, boundary(case), base()


def least_damping_at_best(case: pp.Case) -> float:
    """Return the damping ratio of the worst mode at the speed where it is best.

    The case is unstable at every speed when the ratio is below zero.
    """
    return float(modes_of(case).damping_ratio.min("branch").max())


# What a conflict does, by equation or table. `without` tells what an absent term does.
OF_CONFLICT: dict[int | str, Callable[[], Boundary]] = {
    13: printed_coriolis_sign,
    35: printed_coupling_sign,
    "Table 1": printed_flap_hub_inertia,
}


# Steady tilt


def steady_tilt(azimuth: float = 0.0) -> dict[str, float]:
    """Return the in-plane acceleration of the XV-15's tip under a steady tilt beta_GS, m/s² per degree.

    Parameters
    ----------
    azimuth : float
        Of the blade, rad.

    Returns
    -------
    dict of str to float
        With either of the gimbal's two terms alone, and with both, which is the rigid yoke.
    """
    dropped = {
        "Coriolis term alone": frozenset({"yoke_roll"}),
        "roll of the yoke alone": frozenset({"gimbal_coriolis"}),
        "rigid yoke": frozenset(),
    }
    at = {multiblade.psi: azimuth}
    return {label: float(_tip_acceleration(terms).subs(at)) for label, terms in dropped.items()}


@functools.cache
def _tip_acceleration(dropped: frozenset[str]) -> sp.Expr:
    """Return the tip's acceleration along i as an expression in the azimuth."""
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
