"""Tables 1 and 2 of AIAA-2002-1604: can the printed integrals belong to one blade?

A blade is any non-negative mass along the radius. Whether one has the printed integrals, to the last printed digit,
is a linear programme for each pair of hinge offsets, on a grid of R/160 and from its best point on freely.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal

import numpy as np
from scipy.optimize import linprog, minimize

from derive.audit.comparison import AFTER_READING, CONTRADICTS, REPRODUCED, VERDICTS
from derive.audit.printed import PrintedTable
from derive.audit.printed.tables import PrintedNumber

CAUCHY_SCHWARZ = "Cauchy-Schwarz"
MASS_DISTRIBUTION = "non-negative mass"
INTEGRALS = ("I_b", "I_β", "I_βα", "I_ζ", "I_ζα", "S_β", "S_ζ")
STANDARD_DENSITY = 0.0023769  # slug/ft^3
_STATIONS = 251
_OFFSETS = 41


Values = Mapping[str, PrintedNumber]


@dataclass(frozen=True)
class Relation:
    """One relation between printed values."""

    name: str
    values: tuple[str, ...]
    verdict: str
    evidence: str
    invariant: str = ""  # the one a contradiction breaks


@dataclass(frozen=True)
class TableVerdict:
    table: PrintedTable
    relations: tuple[Relation, ...]

    @property
    def verdict(self) -> str:
        return max((relation.verdict for relation in self.relations), key=VERDICTS.index)

    @property
    def conflicts(self) -> list[Relation]:
        return [relation for relation in self.relations if relation.verdict == CONTRADICTS]


def audit_table(table: PrintedTable) -> TableVerdict:
    v = table.values
    relations = [_cauchy_schwarz(v, "I_βα", "I_β"), _cauchy_schwarz(v, "I_ζα", "I_ζ")]
    relations += [*_one_blade(v), _lock_number(v), _shares(v), _delta_3(v)]
    return TableVerdict(table, tuple(relations))


def rounding(value: PrintedNumber) -> float:
    """Half a unit of the last printed digit."""
    return float(Decimal(1).scaleb(int(Decimal(value.text).as_tuple().exponent))) / 2


def _cauchy_schwarz(v: Values, mixed: str, own: str) -> Relation:
    low, high = v[mixed] - rounding(v[mixed]), (v["I_b"] + rounding(v["I_b"])) * (v[own] + rounding(v[own]))
    verdict = REPRODUCED if low**2 <= high else CONTRADICTS
    evidence = f"{mixed}²/(I_b {own}) = {v[mixed] ** 2 / (v['I_b'] * v[own]):.3f}"
    return Relation(f"{mixed}² ≤ I_b {own}", (mixed, "I_b", own), verdict, evidence, CAUCHY_SCHWARZ)


# Mass distributions


@functools.cache
def _arms(radius: float, flap_offset: float, lag_offset: float) -> dict[str, np.ndarray]:
    """Integrands of unit masses at stations from the centre to the tip; the hinges are stations."""
    r = np.unique(np.concatenate([np.linspace(0, radius, _STATIONS), [flap_offset, lag_offset]]))
    flap, lag = np.maximum(r - flap_offset, 0), np.maximum(r - lag_offset, 0)
    return {
        "I_b": r**2,
        "I_β": flap**2,
        "I_βα": r * flap,
        "S_β": flap,
        "I_ζ": lag**2,
        "I_ζα": r * lag,
        "S_ζ": lag,
    }


def misfit(v: Values, names: tuple[str, ...], flap_offset: float, lag_offset: float) -> float:
    """Least largest deviation of any blade's integrals from the printed ones, in half units of the last digit."""
    arms = _arms(v["R"], flap_offset, lag_offset)
    rows = np.array([arms[name] / rounding(v[name]) for name in names])
    wanted = np.array([v[name] / rounding(v[name]) for name in names])
    slack = -np.ones((len(names), 1))
    bounds_ = np.vstack([np.hstack([rows, slack]), np.hstack([-rows, slack])])
    cost = np.zeros(rows.shape[1] + 1)
    cost[-1] = 1
    solution = linprog(cost, A_ub=bounds_, b_ub=np.concatenate([wanted, -wanted]), method="highs")
    return max(round(float(solution.fun), 6), 0.0) if solution.status == 0 else math.inf


def nearest_blade(v: Values, names: tuple[str, ...]) -> tuple[float, list[float], list[float]]:
    """Least misfit over the hinge offsets, and the flap and lag offsets that reach it or have a blade at all."""
    grid = list(np.linspace(0, 0.25 * v["R"], _OFFSETS))
    of_flap, of_lag = (any(angle in name for name in names) for angle in "βζ")
    lag_offsets = [implied_offset(v, "ζ")] if "I_ζα" in names or not of_lag else grid[:: _OFFSETS // 8]
    flap_offsets = [*grid, implied_offset(v, "β")] if of_flap else [0.0]
    found = [(misfit(v, names, flap, lag), flap, lag) for lag in lag_offsets for flap in flap_offsets]
    if 1 < min(found)[0] < math.inf:
        found.append(_refined(v, names, *min(found)[1:]))
    least = min(found)[0]
    near = [(flap, lag) for deviation, flap, lag in found if deviation <= max(least, 1)]
    return least, sorted({flap for flap, _ in near}), sorted({lag for _, lag in near})


def _refined(v: Values, names: tuple[str, ...], *start: float) -> tuple[float, float, float]:
    """The misfit and offsets that a simplex search reaches from a point of the grid."""
    moves = [any(angle in name for name in names) for angle in "βζ"]
    step = v["R"] / 160

    def offsets(moved: np.ndarray) -> list[float]:
        rest = iter(moved)
        return [max(float(next(rest)), 0.0) if free else at for free, at in zip(moves, start, strict=True)]

    first = np.array([at for free, at in zip(moves, start, strict=True) if free])
    found = minimize(
        lambda moved: misfit(v, names, *offsets(moved)),
        first,
        method="Nelder-Mead",
        options={
            "initial_simplex": np.vstack([first, first + step * np.eye(len(first))]),
            "xatol": step / 100,
            "fatol": 1e-2,
            "maxfev": 120,
        },
    )
    flap, lag = offsets(found.x)
    return float(found.fun), flap, lag


def implied_offset(v: Values, angle: str) -> float:
    """e of I_α = I + e S."""
    return (v[f"I_{angle}α"] - v[f"I_{angle}"]) / v[f"S_{angle}"]


def _one_blade(v: Values) -> list[Relation]:
    """All integrals together; if no blade has them, which one has to go for the others to belong to a blade."""
    relations = [_blade_with(v, "one blade has all integrals", INTEGRALS)]
    if relations[0].verdict == CONTRADICTS:
        relations += [_does_not_belong(v, left_out) for left_out in INTEGRALS]
    relations += [
        _blade_with(v, f"one blade has I_b and those of {angle}", ("I_b", *_of(angle))) for angle in "βζ"
    ]
    return [*relations, _order_of_hinges(v)]


def _does_not_belong(v: Values, left_out: str) -> Relation:
    """An integral contradicts the others when they have a blade without it."""
    others = _blade_with(v, "", tuple(name for name in INTEGRALS if name != left_out))
    verdict = CONTRADICTS if others.verdict == REPRODUCED else REPRODUCED
    name = f"the misfit is not due to {left_out}"
    return Relation(name, (left_out,), verdict, f"without it: {others.evidence}", MASS_DISTRIBUTION)


def _of(angle: str) -> tuple[str, ...]:
    return tuple(name for name in INTEGRALS if angle in name)


def _blade_with(v: Values, label: str, names: tuple[str, ...]) -> Relation:
    deviation, flap, lag = nearest_blade(v, names)
    evidence = f"nearest blade {deviation:.2g} half digits away"
    evidence += "".join(
        f", e_{angle} {offsets[0]:.2f} to {offsets[-1]:.2f} ft"
        for angle, offsets in (("β", flap), ("ζ", lag))
        if any(angle in name for name in names)
    )
    verdict = REPRODUCED if deviation <= 1 else CONTRADICTS
    return Relation(label, names, verdict, evidence, MASS_DISTRIBUTION)


def _order_of_hinges(v: Values) -> Relation:
    """The inertia outboard of a hinge falls as the hinge moves out, so the larger inertia has the smaller offset."""
    order = (implied_offset(v, "ζ") - implied_offset(v, "β")) * (v["I_β"] - v["I_ζ"]) >= 0
    offsets = f"e_β = {implied_offset(v, 'β'):.3f} ft, e_ζ = {implied_offset(v, 'ζ'):.3f} ft"
    verdict = REPRODUCED if order else CONTRADICTS
    values = ("I_βα", "I_β", "S_β", "I_ζα", "I_ζ", "S_ζ")
    return Relation(
        "hinge offsets (I_α - I)/S, the smaller the larger I", values, verdict, offsets, MASS_DISTRIBUTION
    )


# Other values


def _lock_number(v: Values) -> Relation:
    """gamma = rho c_l_alpha c R^4 / I_b with the chord of the solidity; the paper gives no density."""
    chord = v["σ"] * math.pi * v["R"] / v["N"]
    density = v["γ"] * v["I_b"] / (v["c_lα"] * chord * v["R"] ** 4)
    names = ("γ", "I_b", "c_lα", "σ", "R", "N")
    uncertain = sum(rounding(v[name]) / v[name] for name in ("γ", "I_b", "c_lα", "σ"))
    standard = abs(density / STANDARD_DENSITY - 1) <= uncertain
    evidence = (
        f"chord {chord:.3f} ft, density {density:.5f} slug/ft³, {density / STANDARD_DENSITY:.3f} of standard"
    )
    return Relation("Lock number and solidity", names, REPRODUCED if standard else AFTER_READING, evidence)


def _shares(v: Values) -> Relation:
    """Shares of the flexibility, of springs that are there (Eqs. 18, 19)."""
    fine = all(0 <= v[name] <= 1 for name in ("R_β", "R_ζ")) and min(v["ω_β0"], v["ω_ζ0"]) > 0
    speed = v["rpm"] * math.pi / 30
    evidence = f"ω_β0/Ω = {v['ω_β0'] / speed:.3f}, ω_ζ0/Ω = {v['ω_ζ0'] / speed:.3f}"
    names = ("R_β", "R_ζ", "ω_β0", "ω_ζ0", "rpm")
    return Relation(
        "shares between 0 and 1, springs above zero", names, REPRODUCED if fine else CONTRADICTS, evidence
    )


def _delta_3(v: Values) -> Relation:
    angle = math.degrees(math.atan(v["K_PG"]))
    whole = abs(angle - round(angle)) <= math.degrees(rounding(v["K_PG"]))
    evidence = f"δ3 = {angle:.2f} deg"
    return Relation(
        "K_PG = tan δ3 of whole degrees", ("K_PG",), REPRODUCED if whole else AFTER_READING, evidence
    )
