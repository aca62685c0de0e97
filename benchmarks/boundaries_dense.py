"""Boundaries of random decks against dense sweeps whose roots, signs and neutral test are their own.

    OPENBLAS_NUM_THREADS=1 python -m benchmarks.boundaries_dense --decks 500

Every deck is searched by three scans. The reference knows nothing of the package but its matrices: eigenvalues of the
companion matrix every 0.2 kt, each root matched to the nearest one that a straight line through its last two points
leads to, and again every 0.002 kt wherever a root crosses, turns back near the level, or is not followed clearly. The
sign of a root that double precision leaves in doubt is that of the determinant's root in 50 digits.
"""

from __future__ import annotations

import argparse
import tempfile
import time
import warnings
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import mpmath
import numpy as np
from hypothesis import HealthCheck, Phase, given, settings
from rich.console import Console

import proprotor as pp
from proprotor.model.first_order import held_coordinates
from proprotor.stability.boundaries import scan_speeds
from proprotor.units import KNOT

COARSE, FINE = 0.2, 0.002  # kt
APART = 0.01  # kt: boundaries nearer to each other than that are left out
DOUBTFUL = 1e-9  # rad/s: growth whose sign double precision may not tell
NEUTRAL = 1e-12  # of |λ|: growth, in 50 digits, that the rounding of the matrices themselves makes
AGREES = 1e-3  # kt
MANY = 6  # points at which a root in doubt is looked at first
LEVELS = (0.0, 0.02)
OPTIONS = {"section_damping": False}  # which has more boundaries
Signed = tuple[float, bool]  # position in kt, and whether a root becomes unstable


def random_decks(count: int) -> Iterator[tuple[Any, Any]]:
    """Flights on modes, the same ones every time."""
    from tests.deck.test_random_decks import flights_on_modes

    made: list[tuple[Any, Any]] = []

    @settings(
        max_examples=count,
        derandomize=True,
        deadline=None,
        database=None,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(flights_on_modes())
    def collect(one: tuple[Any, Any]) -> None:
        made.append(one)

    collect()
    yield from made


def growth(values: np.ndarray, level: float) -> np.ndarray:
    return values.real + level * np.abs(values)


class Reference:
    """Dense sweeps of one case."""

    def __init__(self, case: pp.Case, level: float) -> None:
        self.case, self.level = case, level

    def values(self, knots: np.ndarray) -> np.ndarray:
        """Roots (k, states) at airspeeds; NaN where there is no trim."""
        model = self.case.linearize(knots * KNOT, **OPTIONS)
        return companion_roots(model)

    def crossings(self, low: float, high: float, step: float = COARSE) -> list[Signed]:
        """Crossings between two airspeeds in kt, by root and place."""
        knots = np.linspace(low, high, int(np.ceil((high - low) / step)) + 1)
        found: list[Signed] = []
        values = self.values(knots)
        works = np.isfinite(values).all(axis=1)
        for start, stop in runs(works):
            if stop - start >= 4:
                found += self._along(knots[start:stop], values[start:stop], step)
        return sorted(found)

    def confirms(self, one: Signed) -> bool:
        """Whether the number of roots beyond the level changes at a place, where no sweep reached it."""
        ends = growth(self.values(np.array([one[0] - FINE / 4, one[0] + FINE / 4])), self.level)
        counts = (ends > 0).sum(axis=1)
        return bool(np.isfinite(ends).all() and (counts[1] > counts[0] if one[1] else counts[1] < counts[0]))

    def _along(self, knots: np.ndarray, values: np.ndarray, step: float) -> list[Signed]:
        placed, clear = followed(values)
        value = growth(placed, self.level)
        sign = np.sign(value)
        for state, doubtful in enumerate((np.abs(value) < DOUBTFUL).T):
            points = np.flatnonzero(doubtful)
            if len(points):
                sign[points, state] = self._signs(knots[points], placed[points, state])
        upper = (placed.imag >= 0)[:-1] | (placed.imag >= 0)[1:]
        beyond = sign > 0
        steps, states = np.nonzero(upper & (beyond[:-1] != beyond[1:]))
        if step <= FINE:
            places = zip(steps.tolist(), states.tolist(), strict=True)
            return [self._place(knots, placed[:, state], sign[:, state], step) for step, state in places]
        look = np.zeros(len(knots) - 1, dtype=bool)
        look[steps] = True
        # A turn: the parabola through three points comes within its own height of the level.
        a, b, c = value[:-2], value[1:-1], value[2:]
        bend = np.abs(a - 2 * b + c)
        turns = (np.abs(b) <= 2 * bend + np.maximum(np.abs(b - a), np.abs(c - b)) * (bend > 1e-12)) & ~(
            (sign[:-2] == 0) & (sign[1:-1] == 0) & (sign[2:] == 0)
        )
        turns &= ((c - b) * (b - a) <= 0) | (np.abs(b) <= bend)
        turn = np.flatnonzero((turns & upper[:-1]).any(axis=1))
        look[turn] = look[turn + 1] = True
        look |= (~clear & (np.abs(value[:-1]) < np.abs(np.diff(placed, axis=0)) + 0.05)).any(axis=1)
        found: list[Signed] = []
        for start, stop in runs(look):
            pad = 4 * FINE  # so that the first steps have something to lead them
            inner = self.crossings(max(knots[start] - pad, knots[0]), min(knots[stop] + pad, knots[-1]), FINE)
            found += [one for one in inner if knots[start] <= one[0] < knots[stop]]
        return found

    def _place(self, knots: np.ndarray, values: np.ndarray, sign: np.ndarray, step: int) -> Signed:
        """Return where one root (k,) passes the level in a step, and whether it becomes unstable.

        A root that is in doubt at an end of the step is in doubt over a stretch: its place there is that of the exact
        root, between the two ends of the stretch.
        """
        onset = bool(sign[step + 1] > 0)
        known = np.flatnonzero(sign != 0)
        before, after = known[known <= step], known[known > step]
        start = int(before[-1]) if len(before) else step
        end = int(after[0]) if len(after) else step + 1
        ends = growth(values[[start, end]], self.level)
        if np.abs(ends).min() < DOUBTFUL and sign[start] * sign[end] < 0:
            return self._exact_place(knots[[start, end]], values[[start, end]]), onset
        share = 0.5 if ends[0] == ends[1] else np.clip(ends[0] / (ends[0] - ends[1]), 0, 1)
        return float(knots[start] + share * (knots[end] - knots[start])), onset

    def _exact_place(self, ends: np.ndarray, values: np.ndarray) -> float:
        """Return where the growth of the exact root is zero between two airspeeds, by regula falsi in 50 digits."""
        reach = [self._exact_growth(knot, value) for knot, value in zip(ends, values, strict=True)]
        low, high = (float(knot) for knot in ends)
        for _ in range(8):
            place = low + (high - low) * float(reach[0] / (reach[0] - reach[1]))
            here = self._exact_growth(place, values[0])
            if here * reach[0] > 0:
                low, reach[0] = place, here
            else:
                high, reach[1] = place, here
        return place

    def _exact_growth(self, knot: float, value: complex) -> Any:
        """Return the growth of the exact root next to a number, in 50 digits."""
        exact = exact_root(self.case.linearize(knot * KNOT, **OPTIONS), value)
        return exact.real + self.level * abs(exact)

    def _signs(self, knots: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Signs of a root in doubt along points: between two that have the same, all have it."""
        signs = np.full(len(knots), np.nan)
        some = np.unique(np.linspace(0, len(knots) - 1, MANY).astype(int))
        while len(some):
            signs[some] = [self._sign(knots[point], values[point]) for point in some]
            known = np.flatnonzero(np.isfinite(signs))
            some = np.array([], dtype=int)
            for first, last in pairwise(known.tolist()):
                if signs[first] == signs[last]:
                    signs[first:last] = signs[first]
                elif last > first + 1:
                    some = np.append(some, (first + last) // 2)
        return signs

    def _sign(self, knot: float, value: complex) -> float:
        exact = exact_root(self.case.linearize(knot * KNOT, **OPTIONS), value)
        reach = exact.real + self.level * abs(exact)
        return 0.0 if abs(reach) < NEUTRAL * max(abs(exact), 1e-3) else float(np.sign(float(reach)))


def companion_roots(model: pp.LinearModel) -> np.ndarray:
    """Eigenvalues (k, states), by a companion matrix of its own, in coordinates of a unit mass diagonal."""
    n, held = len(model.dofs), held_coordinates(model)
    good = np.isfinite(model.M).all(axis=(-2, -1))
    values = np.full((len(good), n + len(held)), complex(np.nan, np.nan))
    if good.any():
        M, C, K = (getattr(model, name)[good] for name in "MCK")
        size = 1 / np.sqrt(np.abs(np.diagonal(M, axis1=-2, axis2=-1)))
        M, C, K = (matrix * size[:, None, :] * size[:, :, None] for matrix in (M, C, K))
        inverse = np.linalg.inv(M)
        top = np.concatenate([-inverse @ C, -inverse @ K[..., held]], axis=-1)
        bottom = np.zeros((len(M), len(held), n + len(held)))
        bottom[:, np.arange(len(held)), held] = 1
        values[good] = np.linalg.eigvals(np.concatenate([top, bottom], axis=-2))
    return values


def exact_root(model: pp.LinearModel, value: complex) -> Any:
    """The root of the determinant next to a number, in 50 digits: where 1 / (cᵀ T⁻¹ b) of two vectors vanishes."""
    held = held_coordinates(model)
    with mpmath.workdps(50):
        M, C, K = (mpmath.matrix(getattr(model, name).tolist()) for name in "MCK")
        n, root = M.rows, mpmath.mpc(complex(value))
        b, c = ([mpmath.mpf(1) / (place + k) for place in range(n)] for k in (2, 3))
        for _ in range(30):
            whole, slope = M * root**2 + C * root + K, M * (2 * root) + C
            for place in set(range(n)) - set(held):  # a rate alone
                for row in range(n):
                    whole[row, place], slope[row, place] = M[row, place] * root + C[row, place], M[row, place]
            try:
                factors, order = mpmath.mp.LU_decomp(whole)
            except ZeroDivisionError:
                return root
            first = mpmath.mp.U_solve(factors, mpmath.mp.L_solve(factors, mpmath.matrix(b), order))
            load = slope * first
            second = mpmath.mp.U_solve(factors, mpmath.mp.L_solve(factors, load, order))
            one, two = (sum(c[k] * part[k] for k in range(n)) for part in (first, second))
            step = one / two
            root -= step
            if abs(step) < mpmath.mpf(10) ** -40 * (1 + abs(root)):
                break
        return root


def followed(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Roots in the places of those that a straight line leads to, and which steps of which were clear (k - 1, m)."""
    from scipy.optimize import linear_sum_assignment

    placed, clear = [values[0]], []
    for here in values[1:]:
        ahead = placed[-1] if len(placed) < 2 else 2 * placed[-1] - placed[-2]
        apart = np.abs(ahead[:, None] - here[None, :])
        first = apart.argmin(axis=1)
        order = first if len(set(first.tolist())) == len(first) else linear_sum_assignment(apart)[1]
        chosen = apart[np.arange(len(here)), order]
        rest = apart.copy()
        rest[np.arange(len(here)), order] = np.inf
        clear.append(chosen < 0.2 * rest.min(axis=1))
        placed.append(here[order])
    return np.array(placed), np.array(clear)


def runs(mask: np.ndarray) -> list[tuple[int, int]]:
    """First and one after the last place of each run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(int)))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))


class Verdict(NamedTuple):
    """What a scan missed, told though it is not there, and how many boundaries were compared."""

    missed: list[Signed]
    invented: list[Signed]
    compared: int


def compare(
    found: list[Signed], reference: list[Signed], known: list[Signed], low: float, high: float
) -> Verdict:
    """Return what a scan missed of the reference, and what it told that is not there, or twice.

    `known` are those of the reference where the scan says that it could analyse.
    """
    inside = [one for one in known if low + APART < one[0] < high - APART]
    alone = [
        one for place, one in enumerate(inside)
        if all(abs(one[0] - other[0]) >= APART for k, other in enumerate(inside) if k != place)
    ]  # fmt: skip
    missed = [one for one in alone if not any(_same(one, other) for other in found)]
    twice = [one for one in alone if sum(_same(one, other) for other in found) > 1]
    invented = [
        one for one in found
        if low + APART < one[0] < high - APART and not any(_near(one, other) for other in reference)
    ]  # fmt: skip
    return Verdict(missed, invented + twice, len(alone))


def _same(one: Signed, other: Signed) -> bool:
    return abs(one[0] - other[0]) <= AGREES + FINE and one[1] == other[1]


def _near(one: Signed, other: Signed) -> bool:
    return abs(one[0] - other[0]) <= 2 * FINE and one[1] == other[1]


def scans(case: pp.Case) -> dict[str, np.ndarray]:
    """Airspeeds of the three scans, m/s."""
    default = scan_speeds(case)
    low, high = default[0], default[-1]
    made = {f"{step} kt": np.append(np.arange(low, high, step * KNOT), high) for step in (5, 20)}
    return made | {"default": default}


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--decks", type=int, default=500)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--verbose", action="store_true")
    chosen = parser.parse_args()
    console, totals = Console(width=120), {}
    from tests.deck.test_random_decks import load

    warnings.simplefilter("ignore")
    begin = time.process_time()
    with tempfile.TemporaryDirectory() as folder:
        for number, (flight, modes) in enumerate(random_decks(chosen.decks)):
            if number < chosen.first:
                continue
            case = load(Path(folder), flight, modes)
            level = LEVELS[number % len(LEVELS)]
            line = scan_speeds(case) / KNOT
            dense = Reference(case, level)
            reference = dense.crossings(line[0], line[-1])
            for name, speeds in scans(case).items():
                told = case.flutter_point(speeds, level=level, **OPTIONS)
                low, high = (speed / KNOT for speed in told.searched)
                found = [(b.position / KNOT, b.onset) for b in told.boundaries]
                gaps = [(first / KNOT, last / KNOT) for first, last, _ in told.failed]
                known = [
                    one for one in reference if not any(a - APART <= one[0] <= b + APART for a, b in gaps)
                ]
                verdict = compare(found, reference, known, low, high)
                verdict = verdict._replace(
                    invented=[one for one in verdict.invented if one in reference or not dense.confirms(one)]
                )
                totals.setdefault(name, []).append((verdict, told.eigen_solves))
                if verdict.missed or verdict.invented:
                    console.print(number, name, level, "missed", verdict.missed, "invented", verdict.invented)
            if chosen.verbose:
                console.print(number, len(reference), f"{time.process_time() - begin:.0f} s")
    for name, verdicts in totals.items():
        missed, invented, compared = (
            sum(len(v[k]) if k < 2 else v[k] for v, _ in verdicts) for k in range(3)
        )
        solves = np.mean([count for _, count in verdicts])
        console.print(
            f"{name}: {len(verdicts)} decks, {compared} boundaries compared, {missed} missed, "
            f"{invented} told that are not there, {solves:.0f} eigen-solves a deck"
        )
    console.print(f"{time.process_time() - begin:.0f} s of processor time")


if __name__ == "__main__":
    main()
