"""Airloads of the wing against a strip sum written out, closed forms of a rigid wing, and the work they do."""

from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp
from proprotor.errors import InputError
from proprotor.support.beam_wing import beam_structure, on_coordinates
from proprotor.support.wing_aerodynamics import (
    Strips,
    WingAerodynamics,
    beam_strips,
    cantilever_strips,
    in_airstream,
)
from tests.support.test_beam_wing import BODY, wing

RHO, V, A, C, SPAN = 1.1, 90.0, 5.6, 1.6, 4.9
QUADRATURE = 1e-12


def rigid(rise, pitch, sweep=0.0, **fields):
    """A wing of one stiff strip."""
    strips = Strips(np.array([SPAN]), np.array([[rise]]), np.array([[pitch]]))
    airloads = WingAerodynamics(lift_slope=A, chord=C, elastic_axis=0.4, sweep=sweep, **fields)
    damping, stiffness = airloads.matrices(strips)
    return RHO * V * damping[0, 0], RHO * V**2 * stiffness[0, 0]


def test_heave_of_a_rigid_wing_is_damped_by_half_rho_v_c_a_span():
    damping, stiffness = rigid(1.0, 0.0)
    assert damping == pytest.approx(RHO * V * C * A * SPAN / 2, rel=QUADRATURE)
    assert stiffness == 0


def test_pitch_of_a_rigid_wing():
    """Lift ahead of the elastic axis takes stiffness off; downwash behind it damps with that lift's arm."""
    damping, stiffness = rigid(0.0, 1.0)
    ahead, behind = (0.4 - 0.25) * C, (0.75 - 0.4) * C
    assert stiffness == pytest.approx(-RHO * V**2 * C * A * SPAN / 2 * ahead, rel=QUADRATURE)
    assert damping == pytest.approx(-RHO * V * C * A * SPAN / 2 * ahead * behind, rel=QUADRATURE)


def test_sweep_takes_its_cosine():
    np.testing.assert_allclose(
        rigid(1.0, 0.4, sweep=0.5), np.cos(0.5) * np.array(rigid(1.0, 0.4)), rtol=1e-14
    )


def test_assumed_shape_is_a_tip_loaded_cantilever():
    """∫ of its square: 33/140 of the tip's, the share of a cantilever's mass; of linear twist: 1/3."""
    hub = np.zeros((6, 3))
    hub[0] = [1.0, 0.0, 1.3]  # beam; chord; torsion about a tip 1.3 m behind the hub
    hub[2, 1], hub[4, 2] = 1.0, 1.0
    support = pp.NormalModes(("beam", "chord", "torsion"), np.eye(3), np.eye(3), np.eye(3), hub, False)
    strips = cantilever_strips(support, SPAN, 1.3)
    airloads = WingAerodynamics(lift_slope=A, chord=C, elastic_axis=0.25)
    damping, stiffness = airloads.matrices(strips)
    flow = A * C * SPAN / 2
    assert damping[0, 0] == pytest.approx(flow * 33 / 140, rel=QUADRATURE)
    assert stiffness[0, 2] == pytest.approx(-flow * 11 / 40, rel=QUADRATURE)  # ∫ η (3η² - η³)/2
    assert damping[0, 2] == pytest.approx(-flow * C / 2 * 11 / 40, rel=QUADRATURE)
    np.testing.assert_array_equal(damping[1], 0)
    np.testing.assert_allclose(strips.rise[:, 2], 0, atol=1e-15)  # the tip stays where it is


def strip_sum(structure, motion, rate, count=20_000):
    """Generalised airloads by a sum over thin strips, in the displacements of a bent line: no shape functions.

    Positions, slopes and twist between nodes from the nodes' own motion: cubics through their ends.
    """
    loads = np.zeros(structure.nodes.shape[-1])
    positions, nodes = structure.positions, structure.nodes
    edge = 0.4  # elastic axis
    for one, two, left, right in zip(positions[:-1], positions[1:], nodes[:-1], nodes[1:], strict=True):
        length = np.linalg.norm(two - one)
        axis = (two - one) / length
        t = (np.arange(count // (len(nodes) - 1)) + 0.5) / (count // (len(nodes) - 1))

        def bent(q, length=length, axis=axis, left=left, right=right, t=t):
            """Rise and nose-up turn of the line, in the coordinates q."""
            u, w = left @ q, right @ q
            slopes = [np.cross(end[3:], axis) * length for end in (u, w)]
            h = [2 * t**3 - 3 * t**2 + 1, t**3 - 2 * t**2 + t, -2 * t**3 + 3 * t**2, t**3 - t**2]
            d = [6 * t**2 - 6 * t, 3 * t**2 - 4 * t + 1, -6 * t**2 + 6 * t, 3 * t**2 - 2 * t]
            ends = (u[:3], slopes[0], w[:3], slopes[1])
            across = [end - axis * (axis @ end) for end in ends]
            line = sum(np.outer(f, end) for f, end in zip(h, across, strict=True))
            along = np.outer(1 - t, axis * (axis @ u[:3])) + np.outer(t, axis * (axis @ w[:3]))
            slope = sum(np.outer(f, end) for f, end in zip(d, across, strict=True)) / length
            twist = (1 - t) * (axis @ u[3:]) + t * (axis @ w[3:])
            turn = np.cross(axis, slope) + np.outer(twist, axis)
            return (line + along)[:, 0], turn[:, 1]

        _, pitch = bent(motion)
        rise_rate, pitch_rate = bent(rate)
        wash = V * pitch - (rise_rate - (0.75 - edge) * C * pitch_rate)
        lift = RHO * V * np.cos(0.3) * A * C / 2 * wash * (two - one)[1] / len(t)
        for place in range(len(loads)):
            rise, turn = bent(np.eye(len(loads))[place])
            loads[place] += np.sum(lift * (rise + (edge - 0.25) * C * turn))
    return loads


def test_beam_strips_against_a_sum_written_out():
    """A swept wing with dihedral, moved at random: the virtual work of thin strips."""
    structure = beam_structure(wing(sweep=0.3, dihedral=0.1, elements=3), replace(BODY, pitch_stiffness=1e6))
    airloads = WingAerodynamics(lift_slope=A, chord=C, elastic_axis=0.4, sweep=0.3)
    damping, stiffness = airloads.matrices(beam_strips(structure, np.eye(len(structure.names))))
    rng = np.random.default_rng(3)
    motion, rate = rng.normal(size=(2, len(structure.names)))
    expected = strip_sum(structure, motion, rate)
    loads = -(RHO * V * damping @ rate + RHO * V**2 * stiffness @ motion)
    np.testing.assert_allclose(loads, expected, rtol=1e-5, atol=1e-6 * np.abs(expected).max())


def test_heaving_takes_energy_out_of_a_mode():
    """Per cycle, in still-air modes: the work of the airloads is -πω Re(q* C q), and of heave alone it is negative."""
    structure = beam_structure(wing(), BODY)
    found = on_coordinates(structure, 3, 0.0, 0.0)
    airloads = WingAerodynamics(lift_slope=A, chord=C, elastic_axis=0.25)
    support = in_airstream(found.support, beam_strips(structure, found.shapes), airloads)
    moving = support.at(V, RHO)
    place = support.names.index("beam")
    assert moving.damping[place, place] > 0
    np.testing.assert_array_equal(moving.mass, found.support.mass)
    still = support.at(0.0, RHO)
    np.testing.assert_array_equal(still.stiffness, found.support.stiffness)
    np.testing.assert_array_equal(support.at(V, 0.0).damping, found.support.damping)


def test_airspeeds_and_densities_broadcast_and_may_be_complex():
    structure = beam_structure(wing(), BODY)
    found = on_coordinates(structure, 4, 0.01, 0.0)
    strips = beam_strips(structure, found.shapes)
    support = in_airstream(found.support, strips, WingAerodynamics(lift_slope=A, chord=C, elastic_axis=0.4))
    speeds, densities = np.array([50.0, V, 120.0]), np.array([[RHO], [0.6]])
    batch = support.at(speeds, densities)
    assert batch.damping.shape == (2, 3, 4, 4)
    one = support.at(V, 0.6)
    np.testing.assert_array_equal(batch.stiffness[1, 1], one.stiffness)
    step = 1e-3
    by_differences = (support.at(V + step, RHO).stiffness - support.at(V - step, RHO).stiffness) / (2 * step)
    exact = support.at(V + 1e-30j, RHO).stiffness.imag / 1e-30
    np.testing.assert_allclose(exact, by_differences, rtol=1e-6, atol=1e-6 * np.abs(exact).max())


def deck(tmp_path, text):
    path = tmp_path / "wing.toml"
    path.write_text(text, encoding="utf-8")
    return pp.load_case(path)


AIRLOADS = """
base = "{base}"
[case]
name = "flown"
title = "wing airloads on"
[support.wing_aerodynamics]
lift_slope = "5.7/rad"
chord = "5.25 ft"
elastic_axis = 0.35
{more}
"""


@pytest.mark.parametrize(
    ("base", "more"), [("xv15-uncoupled", 'span = "1.333 ft"\nmast_length = "4.275 ft"'), ("xv15-wing", "")]
)
def test_a_deck_turns_airloads_on(tmp_path, base, more):
    """The beam mode gains ½ρVcaL 33/140 for a unit rise of the tip; a little less where it pitches up too."""
    still = pp.load_case(base)
    flown = deck(tmp_path, AIRLOADS.format(base=base, more=more.replace("1.333", "16.66")))
    speeds = np.array([100.0, 150.0])
    assert type(still.support.at(speeds, 1.2)) is pp.NormalModes
    damped = flown.linearize(speeds).C - still.linearize(speeds).C
    place = flown.support.names.index("beam")
    span = 16.66 * 0.3048 if base == "xv15-uncoupled" else 165 * 0.0254
    expected = still.operation.density * speeds * 5.7 * 5.25 * 0.3048 * span / 2 * 33 / 140
    mast = 4.275 * 0.3048 if base == "xv15-uncoupled" else 47.3 * 0.0254
    hub = flown.support.hub[:, place]
    tip = hub[0] - mast * hub[4]  # the hub pitches up with the beam mode
    np.testing.assert_allclose(damped[:, place, place], expected * tip**2, rtol=0.1)
    densities = np.array([[0.6], [1.2]])
    assert flown.vary({"operation.density": densities}).linearize(speeds).C.shape[:2] == (2, 2)


def test_airloads_that_cannot_be(tmp_path):
    with pytest.raises(InputError, match=r"^chord = 0.0: must be above zero"):
        WingAerodynamics(lift_slope=A, chord=0.0, elastic_axis=0.3)
    with pytest.raises(InputError, match=r"^sweep = nan: must be finite"):
        WingAerodynamics(lift_slope=A, chord=C, elastic_axis=0.3, sweep=np.nan)
    with pytest.raises(InputError, match=r"^span = .*: must be above zero"):
        cantilever_strips(pp.load_case("xv15-uncoupled").support, 0.0, 1.0)
    with pytest.raises(InputError, match=r"^strips = 1: must move with the 3 coordinates"):
        strips = Strips(np.ones(2), np.ones((2, 1)), np.ones((2, 1)))
        in_airstream(
            pp.load_case("xv15-uncoupled").support,
            strips,
            WingAerodynamics(lift_slope=A, chord=C, elastic_axis=0.3),
        )
    with pytest.raises(InputError, match=r"^support.wing_aerodynamics.span: is missing"):
        deck(tmp_path, AIRLOADS.format(base="xv15-uncoupled", more='mast_length = "1 ft"'))
    with pytest.raises(InputError, match=r"^support.wing_aerodynamics.sapn = 1 ft: unknown field 'sapn'"):
        deck(tmp_path, AIRLOADS.format(base="xv15-wing", more='sapn = "1 ft"'))
