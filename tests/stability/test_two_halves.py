"""Halves of the motion that do not couple: their roots pass each other, and no two of them are ever one mode."""

from dataclasses import replace

import numpy as np
import pytest

from proprotor.model.first_order import held_coordinates
from proprotor.stability.branches import by_branch
from proprotor.stability.following import follow
from proprotor.stability.modes import coordinate_motion, decomposition, eigenvalues
from proprotor.stability.root_error import errors_of
from proprotor.support.airframe import Airframe
from tests import airframes

SPEEDS = np.linspace(60.0, 140.0, 9)


def hubs_at_rest(names, stiffness, damping, by_airspeed=None, airload_damping=None):
    """An airframe of unit masses that does not move the hubs."""
    n = len(names)
    hub = np.zeros((6, n))
    zero = np.zeros(n)
    return Airframe(
        names=names,
        mass=np.eye(n),
        damping=np.diag(damping),
        stiffness=np.diag(stiffness),
        hub=hub,
        includes_rotor=False,
        left_hub=hub,
        symmetry=tuple(name.split()[0] for name in names),
        airload_damping=np.diag(zero if airload_damping is None else airload_damping),
        airload_stiffness=np.diag(zero if by_airspeed is None else by_airspeed),
    )


@pytest.fixture(scope="module")
def twins():
    """Both halves are the same: every root is there twice, and the chord of each becomes unstable at 100 m/s."""
    names = ("symmetric beam", "symmetric chord", "antisymmetric beam", "antisymmetric chord")
    base = airframes.aircraft(airframes.half("symmetric", 3))
    gone = -np.array([0.0, 2.0, 0.0, 2.0]) / 100.0 / float(base.operation.density)
    frame = hubs_at_rest(names, [400.0, 900.0] * 2, [1.0, 2.0] * 2, airload_damping=gone)
    return replace(base, support=frame)


def test_roots_of_both_halves_are_named_and_followed_apart(twins):
    found = twins.sweep(SPEEDS)
    assert found.attrs["eigen_solves"] < 40  # no step is parted
    assert (found.tracking_quality.values > 0.9).all() and not (found.warning.values != "").any()
    names = found.mode.values.tolist()
    for name in names:
        half, _, rest = name.partition(" ")
        twin = f"{'antisymmetric' if half == 'symmetric' else 'symmetric'} {rest}"
        np.testing.assert_array_equal(found.eigenvalue.sel(mode=name), found.eigenvalue.sel(mode=twin))
        others = [dof for dof in found.dof.values if not dof.startswith(f"{half} ")]
        assert not found["shape"].sel(mode=name, dof=others).values.any()
        assert not found.participation.sel(mode=name, dof=others).values.any()
        assert all(label.startswith(f"{half} ") for label in found.branch.sel(mode=name).values.tolist())
    labels = by_branch(found).branch.values.tolist()
    assert len(labels) == len(set(labels)) == len(names)


def test_a_crossing_of_both_halves_is_found_in_each(twins):
    found = twins.boundaries(SPEEDS)
    told = [(round(one.position, 6), one.mode) for one in found.boundaries]
    assert sorted(told) == [(100.0, "antisymmetric chord"), (100.0, "symmetric chord")]
    assert [one.branch for one in found.boundaries] == [one.mode for one in found.boundaries]
    assert [one.defect for one in found.boundaries] == pytest.approx([1.0, 1.0], abs=0.01)


def test_roots_of_two_halves_pass_each_other_on_any_way():
    """A root of each half, with the same damping, at one frequency in the middle of the range."""
    base = airframes.aircraft(airframes.half("symmetric", 3))
    density = float(base.operation.density)
    frame = hubs_at_rest(
        ("symmetric beam", "antisymmetric chord"),
        [400.0, 900.0],
        [1.0, 1.0],
        by_airspeed=np.array([500.0, 0.0]) / 100.0**2 / density,
    )
    case = replace(base, support=frame)
    branches = follow(case.linearize(np.linspace(60.0, 140.0, 8)))
    assert branches.quality.min() > 0.9
    found = case.sweep([60.0, 140.0])
    assert found.attrs["eigen_solves"] < 40
    beam, chord = (
        found.eigenvalue.sel(mode=name).values.imag for name in ("symmetric beam", "antisymmetric chord")
    )
    assert beam[0] < chord[0] and beam[1] > chord[1]
    np.testing.assert_allclose(beam**2 + 0.25, 400.0 + 500.0 * np.array([0.6, 1.4]) ** 2, rtol=1e-10)


def test_vectors_of_a_half_solve_the_equations_of_the_whole():
    model = airframes.aircraft().linearize(SPEEDS)
    spectrum = decomposition(model)
    values, held = spectrum.values, held_coordinates(model)
    motion = coordinate_motion(held, len(model.dofs), values, spectrum.right)
    s = values[:, None, :]
    rest = s**2 * (model.M @ motion) + s * (model.C @ motion) + model.K @ motion
    size = np.abs(s) ** 2 * (np.abs(model.M) @ np.abs(motion)) + np.abs(model.K) @ np.abs(motion)
    assert (np.abs(rest) <= 1e-9 * size.max(axis=1, keepdims=True)).all()
    error = errors_of(model, spectrum)
    assert np.isfinite(error).all() and (error < 1e-6).all()
    np.testing.assert_allclose(
        np.sort_complex(eigenvalues(model)), np.sort_complex(values), rtol=1e-9, atol=1e-9
    )


def test_rates_have_one_root_each_and_no_root_at_zero():
    model = airframes.aircraft().linearize(90.0)
    values = eigenvalues(model)
    assert values.shape == (2 * 36 - 4 - 2,) and (np.abs(values) > 1e-3).all()
    in_vacuum = airframes.aircraft(airframes.whole(airloads=0.0)).linearize(
        [60.0, 90.0, 120.0], airloads="none"
    )
    modes = in_vacuum.modes()
    free = {*in_vacuum.rates, "symmetric rotor speed", "antisymmetric rotor speed"}
    for point in range(3):
        here = modes.isel(airspeed=point)
        at_zero = here.name.values[np.isnan(here.damping_ratio.values)].tolist()
        # Pitch and yaw are displacements that a vacuum does not hold: ω² is zero to the rounding of the stiffness.
        turns = ["symmetric pitch", "antisymmetric yaw"]
        turns += [f"{name}, second root" for name in turns]
        assert sorted(name for name in at_zero if name not in turns) == sorted(free)
        assert not here.frequency.values[np.isnan(here.damping_ratio.values)].any()
        still = here.natural_frequency.values[np.isin(here.name, turns)]
        assert len(still) in (2, 4) and (still**2 < 1e-12).all()  # a pair, or two roots at zero each
