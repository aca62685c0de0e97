"""Hostile batches for the compiled functions, to be run where the library was built with sanitizers.

    python -m tests.verify.sanitized            batches of all sizes, strides and numbers; prints how many
    python -m tests.verify.sanitized --fault    one call with too little memory, which the sanitizer must report

`tests/verify/test_sanitizers.py` builds the library and runs both. A sanitizer ends the process at the first fault.
"""

from __future__ import annotations

import sys
from collections import Counter

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import proprotor as pp
from proprotor.compiled import eigenvalues, motion, screening
from proprotor.compiled.library import library, why_not
from tests.compiled.matrices import FAMILIES

calls: Counter[str] = Counter()
hostile = settings(
    max_examples=300, deadline=None, database=None, derandomize=True, suppress_health_check=HealthCheck
)
counts, seeds = st.integers(0, 19), st.integers(0, 2**32 - 1)
BAD = (np.nan, np.inf, -np.inf, 0.0, 1e300, -1e-310)
SIZES = st.one_of(
    st.integers(1, 70), st.sampled_from([127, eigenvalues.MOST_STATES, eigenvalues.MOST_STATES + 1])
)


def spoiled(rng, matrices):
    """Matrices with some lanes that hold what is no number, too large or too small, in another order in memory."""
    for lane in np.flatnonzero(rng.random(len(matrices)) < 0.3):
        matrices[lane].flat[rng.integers(matrices[lane].size)] = rng.choice(BAD)
    views = (
        matrices,
        matrices.swapaxes(1, 2),
        matrices[::-1],
        np.repeat(matrices, 2, axis=0)[::2],
        matrices[1:],
    )
    return views[rng.integers(len(views))]


@hostile
@given(st.sampled_from(sorted(FAMILIES)), SIZES, counts, seeds)
def eigenvalue_problems(family, n, count, seed):
    rng = np.random.default_rng(seed)
    matrices = spoiled(rng, FAMILIES[family](rng, count if n <= 70 else min(count, 2), n))
    with np.errstate(all="ignore"):
        if n > eigenvalues.MOST_STATES:
            matrices = np.nan_to_num(matrices)
        for solve in (eigenvalues.eigvals, eigenvalues.eig):
            try:
                solve(matrices)
            except np.linalg.LinAlgError:
                assert not np.isfinite(matrices).all()
    calls["eigenvalue problems"] += 1


@hostile
@given(st.one_of(st.integers(1, 40), st.sampled_from([128, 129, 200])), counts, seeds)
def equations_of_motion(n, count, seed):
    rng = np.random.default_rng(seed)
    mass, damping, stiffness = (spoiled(rng, rng.standard_normal((count, n, n))) for _ in range(3))
    alike = min(map(len, (mass, damping, stiffness)))
    held = np.flatnonzero(rng.random(n) < rng.random())
    eigenvalues.roots_of_motion(mass[:alike], damping[:alike], stiffness[:alike], held)
    motion.state_matrices(mass[:alike], damping[:alike], stiffness[:alike], held)
    motion.have_mass(mass)
    calls["equations of motion"] += 1


@hostile
@given(st.integers(6, 40), st.integers(0, 60), counts, st.booleans(), seeds)
def supports(size, modes, count, shared, seed):
    rng = np.random.default_rng(seed)
    modes = min(modes, motion.MOST_ROWS + 6 - size)
    matrices = [spoiled(rng, rng.standard_normal((count, size, size))) for _ in range(3)]
    if rng.random() < 0.5:
        matrices.append(rng.standard_normal((count, size, rng.integers(1, 10))))
    alike = min(map(len, matrices))
    shape = () if shared else (alike,)
    hub = rng.standard_normal((*shape, 6, modes))
    additions = [rng.standard_normal((*shape, modes, modes)) for _ in range(3)]
    motion.on_support([matrix[:alike] for matrix in matrices], motion.Support(hub, additions))
    calls["supports"] += 1


@hostile
@given(SIZES, st.integers(0, 5), st.integers(2, 9), st.floats(-0.9, 0.9), seeds)
def scans(states, lines, points, level, seed):
    """Scans of roots of all sizes, alike and in pairs, in blocks, whose points stand in any order."""
    rng = np.random.default_rng(seed)
    values = rng.standard_normal((lines * points, states)) + 1j * rng.integers(
        -1, 2, (lines * points, states)
    )
    values *= rng.choice([1e-150, 1.0, 1.0, 1.0, 1e150], (len(values), 1))
    values[:, states // 2 :][:, : states // 3] = values[:, : states // 3].conj()
    order = rng.permutation(len(values)).reshape(lines, points)
    line, position = np.empty(len(values), dtype=int), np.empty(len(values))
    line[order], position[order] = np.arange(lines)[:, None], np.arange(points)
    before, after = order[:, :-1].ravel(), order[:, 1:].ravel()
    block = np.sort(rng.integers(0, rng.integers(1, 3), states))
    error = np.where(rng.random(values.shape) < 0.2, rng.choice([1e-9, np.inf]), 0.0)
    if states <= eigenvalues.MOST_STATES:
        assert screening.serves_screening(values)
        successor, shared = screening.nearest_roots(values, block, before, after)
        for step in np.flatnonzero(shared):
            successor[step] = rng.permutation(states)
        steps = (before, after, successor)
        screening.screened_steps(values, error, block, position, line, steps, level)
    calls["scans"] += 1


@settings(hostile, max_examples=80)
@given(st.data(), counts, seeds)
def models(data, count, seed):
    """Trims and matrices of many designs in batches of all sizes, some with numbers that no rotor has."""
    rng, case = np.random.default_rng(seed), CASES[data.draw(st.sampled_from(sorted(CASES)))]
    options = {
        "pitch": data.draw(st.sampled_from(["dynamic", "rigid", "coupling"])),
        "airloads": data.draw(st.sampled_from(["full", "none"])),
    }
    speeds = np.where(rng.random(count) < 0.1, 0.0, rng.uniform(1.0, 250.0, count))
    with np.errstate(all="ignore"):
        case.linearize(speeds[:: data.draw(st.sampled_from([1, -1, 2]))], backend="compiled", **options)
        if count:
            inputs = {"operation.density": 10.0 ** rng.uniform(-8, 2, (count, 1))}
            case.vary(inputs).linearize(speeds[:3], backend="compiled", **options)
    calls["models"] += 1


def fault():
    """Ask for the eigenvalues of more matrices than there are."""
    function, matrices, found = library().eigenvalues, np.ones((1, 8, 8)), np.empty((64, 8), dtype=complex)
    room, rest = np.empty(4 * 8 * 9 * 8 + 8), np.zeros(64, dtype=bool)
    room = room[-room.ctypes.data % 64 // 8 :]
    places = (matrices.ctypes, found.ctypes, None, rest.ctypes, room.ctypes)
    function(8, 64, *(None if place is None else place.data_as(_POINTER) for place in places))


def main():
    reason = why_not()
    assert not reason, reason
    if "--fault" in sys.argv:
        fault()
        return
    for run in (eigenvalue_problems, equations_of_motion, supports, scans, models):
        run()
    print(*(f"{count} {name}" for name, count in calls.items()), sep=", ")


if __name__ == "__main__":
    import ctypes

    _POINTER = ctypes.c_void_p
    CASES = {name: pp.load_case(name) for name in ("xv15", "xv15-uncoupled", "wrats-742-off")}
    main()
