"""What a difference between print and derivation does to the XV-15's stability boundary, in knots.

Each variant of the equations is made in memory, below the runtime's own checks where those would refuse it. The
boundary is the lowest speed at which a mode loses its damping.
"""

from __future__ import annotations

import copy
import functools
from collections.abc import Callable
from dataclasses import replace
from types import ModuleType, SimpleNamespace
from unittest import mock

import numpy as np
from proprotor_equations import BLADE_COORDINATES

import proprotor as pp
from derive import multiblade
from derive import symbols as s
from derive.counterparts import COUNTERPARTS
from derive.emit import MODULE_TITLES, render_module
from derive.equations import reduced_functions
from derive.printed import TABLES
from derive.printed.notation import TIME
from derive.published import PUBLISHED
from proprotor import model as runtime
from proprotor.equation_set import EQUATION_SETS, EquationSet

_FLAP, _LAG = (BLADE_COORDINATES.index(name) for name in ("flap", "lag"))
KNOT = 1852 / 3600
SPEEDS = np.arange(100, 521, 5) * KNOT
SLUG_FT2 = 1.3558179483

# Modules a dropped term changes; inertia alone where nothing is said.
_CHANGED = {
    "yoke_roll": ("inertia", "flap_lag_springs", "pitch", "airloads"),
    "cone_in_airloads": ("airloads",),
    "steady_airloads_on_moving_blade": ("airloads",),
    "springs_follow_pitch": ("flap_lag_springs",),
    "spring_curvature": ("flap_lag_springs",),
    "gimbal_pitch_inertia": ("pitch",),
    "propeller_moment": ("pitch",),
}


@functools.cache
def xv15() -> pp.Case:
    return pp.load_case("xv15")


def boundary(case: pp.Case | None = None, **options) -> float:
    """Lowest speed at which the damping of a mode goes through zero, kt; NaN where none does."""
    modes = (case or xv15()).sweep(SPEEDS, **options)
    crossings = []
    for damping in modes.damping_ratio.values.T:
        for i in np.flatnonzero((damping[:-1] > 0) & (damping[1:] <= 0)):
            crossings.append(np.interp(0, [damping[i + 1], damping[i]], SPEEDS[[i + 1, i]] / KNOT))
    return float(min(crossings, default=np.nan))


@functools.cache
def base(equations: str = "consistent", pitch: str = "dynamic") -> float:
    return boundary(equations=equations, pitch=pitch)


@functools.cache
def _module(name: str, dropped: frozenset[str]) -> ModuleType:
    module = ModuleType(f"reduced_{name}")
    exec(render_module(reduced_functions(name, dropped), MODULE_TITLES[name]), vars(module))
    return module


def _reached_by(term: str) -> tuple[str, ...]:
    return _CHANGED.get(term, ("inertia",))


def equations_without(dropped: frozenset[str], of: str, changed: frozenset[str]) -> EquationSet:
    """The set `of` with the modules derived again that the terms of `changed` reach."""
    names = sorted({module for term in changed for module in _reached_by(term)})
    in_module = {name: frozenset(term for term in dropped if name in _reached_by(term)) for name in names}
    return replace(EQUATION_SETS[of], **{name: _module(name, in_module[name]) for name in names})


@functools.cache
def without(term: str) -> float:
    """Boundary of the consistent equations without one term."""
    dropped = frozenset({term})
    return boundary(equations=equations_without(dropped, "consistent", dropped))


@functools.cache
def published_with(*terms: str) -> float:
    """Boundary of the published equations with terms put back."""
    back = frozenset(terms)
    return boundary(equations=equations_without(PUBLISHED - back, "published", back))


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


def _with_printed_coriolis_sign(of: str) -> EquationSet:
    """The flap row's lag rate with the sign of Eq. 13; the lag row keeps its own."""
    inertia = EQUATION_SETS[of].inertia

    @functools.wraps(inertia.gyroscopic)
    def gyroscopic(**quantities):
        matrix = np.array(inertia.gyroscopic(**quantities))
        matrix[..., _FLAP, _LAG] *= -1
        return matrix

    return replace(EQUATION_SETS[of], inertia=SimpleNamespace(**vars(inertia) | {"gyroscopic": gyroscopic}))


def printed_coriolis_sign() -> tuple[str, float, float]:
    changed = boundary(equations=_with_printed_coriolis_sign("published"))
    return "published, ζ' term of Eq. 13 as printed", changed, base("published")


def printed_coupling_sign() -> tuple[str, float, float]:
    """Eq. 35 taken by its sign turns both couplings round."""
    couplings = runtime.pitch.couplings

    @functools.wraps(couplings)
    def turned(**quantities):
        values = couplings(**quantities)
        return values._replace(**{name: -value for name, value in values._asdict().items()})

    with mock.patch.object(runtime, "pitch", SimpleNamespace(**vars(runtime.pitch) | {"couplings": turned})):
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
    label = f"I_βα = {TABLES[0].values['I_βα']:g} as printed, for {consistent:.1f} slug ft² of one blade"
    return label, boundary(with_flap_hub_inertia(printed)), base()


# Consequences of conflicts, by equation or table; those of absent terms are `without` each.
OF_CONFLICT: dict[int | str, Callable[[], tuple[str, float, float]]] = {
    13: printed_coriolis_sign,
    35: printed_coupling_sign,
    "Table 1": printed_flap_hub_inertia,
}


def steady_tilt() -> dict[str, float]:
    """In-plane acceleration of the XV-15's tip per degree of steady gimbal tilt, m/s²: one term alone, rigid yoke."""
    rotor = xv15().rotor
    numbers = {
        s.radial_station: rotor.radius,
        s.precone: rotor.precone,
        s.coning: 0,
        s.rotor_speed: xv15().operation.rotor_speed,
        multiblade.psi: 0,
        TIME["gimbal_1s"][0]: np.radians(1),
    }
    still = {q: 0 for motion in TIME.values() for q in motion}

    def at_tip(dropped: frozenset[str]) -> float:
        along_i = COUNTERPARTS[3](dropped)["i"].subs(numbers).subs(still)
        return float(along_i)

    return {"Coriolis term alone": at_tip(frozenset({"yoke_roll"})), "rigid yoke": at_tip(frozenset())}
