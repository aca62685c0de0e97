"""The decks of the whole XV-15 against an aircraft of textbook frame elements, `tests.oracles.aircraft`.

Both sides share the rotor alone, whose equations have oracles of their own. Airloads of wing and tails are taken away:
closed forms test them (`tests.support.test_aircraft_structure`). What limits the agreement is rounding: the largest
root ω² of the chain is some 1e8 times the lowest elastic one; 2e-10 of a frequency was found.
"""

import numpy as np
import pytest
from scipy.optimize import brentq

import proprotor as pp
from proprotor.model.first_order import state_matrix
from proprotor.support.beam_wing import Pylon, Wing, beam_wing
from tests.oracles.aircraft import half_aircraft, roots, with_rotor

KNOT = 1852 / 3600
RATIO = 0.015
SYMMETRIES = ("symmetric", "antisymmetric")
STILL_AIR = {  # of wing and tails; a number must be above zero
    "support.wing_aerodynamics.lift_slope": "1e-12/rad",
    "support.horizontal_tail.area": "1e-12 m**2",
    "support.vertical_tail.area": "1e-12 m**2",
}
SAME_DAMPING = {
    f"support.{name}": f"{100 * RATIO} %"
    for name in ("damping_ratio", *(f"{kind}_damping_ratio" for kind in ("beam", "chord", "torsion")))
}
DECKS = {"on": "xv15-aircraft", "off": "xv15-aircraft-off"}
ELASTIC = 1e-9
EIGENVALUES = 1e-9  # of the larger of 1/s and the root itself
SPEEDS = np.array([200.0, 300.0, 400.0]) * KNOT
RATES = 1e-6  # 1/s: surge and the rate of the rotor have roots of 3e-4 1/s, rigid displacements have roots of zero


def aircraft(symmetry, downstop="on", **settings):
    return pp.load_case(DECKS[downstop], STILL_AIR | SAME_DAMPING | {"support.symmetry": symmetry} | settings)


def numbers(case):
    return {path: datum.si for path, datum in case.given.items()}


def farthest(wanted, among):
    """Return the largest distance of wanted roots to the nearest other one, per the larger of 1/s and the root."""
    distance = np.abs(wanted[:, None] - among).min(axis=1)
    return (distance / np.maximum(np.abs(wanted), 1.0)).max()


def moving(values):
    """Return the roots that are not zero."""
    return values[np.abs(values) > RATES]


@pytest.mark.parametrize("chord_slope", ["free", "held"])
@pytest.mark.parametrize("downstop", DECKS)
@pytest.mark.parametrize("symmetry", SYMMETRIES)
def test_elastic_frequencies_and_hub_motions(symmetry, downstop, chord_slope):
    case = aircraft(symmetry, downstop, **{"support.carry_through.chord_slope": chord_slope})
    held = ("twist", "chord_slope") if chord_slope == "held" else ("twist",)
    half = half_aircraft(numbers(case), symmetry, downstop=downstop, held=held)
    np.testing.assert_allclose(np.sqrt(np.diag(case.support.stiffness)[3:]), half.frequency, rtol=ELASTIC)
    assert np.abs(half.zeros).max() < ELASTIC * half.frequency[0] ** 2
    own, oracles = (np.abs(mass[3:, 3:]) for mass in (case.support.mass, half.mass))
    np.testing.assert_allclose(own, oracles, atol=ELASTIC)
    sign = np.sign(np.sum(case.support.hub[:, 3:] * half.hub[:, 3:], axis=0))
    scale = np.abs(half.hub[:, 3:]).max()
    np.testing.assert_allclose(case.support.hub[:, 3:] * sign, half.hub[:, 3:], atol=ELASTIC * scale)


@pytest.mark.parametrize("downstop", DECKS)
@pytest.mark.parametrize("symmetry", SYMMETRIES)
def test_eigenvalues_with_the_rotor(symmetry, downstop):
    """The oracle keeps rigid displacements, whose roots are zero, as coordinates; the package has their rates alone."""
    case = aircraft(symmetry, downstop)
    half = half_aircraft(numbers(case), symmetry, downstop=downstop)
    oracles = roots(*with_rotor(half, pp.rotor_model(case.rotor, case.operation, SPEEDS), RATIO))
    own = np.linalg.eigvals(state_matrix(case.linearize(SPEEDS)))
    for mine, others in zip(own, oracles, strict=True):
        assert len(moving(mine)) == len(moving(others)) == len(mine)
        assert farthest(mine, moving(others)) < EIGENVALUES
        assert farthest(moving(others), mine) < EIGENVALUES


@pytest.mark.parametrize(("symmetry", "low", "high"), [("symmetric", 4.2, 6.8), ("antisymmetric", 4.0, 10.3)])
def test_the_boundary_at_458_rpm(symmetry, low, high):
    """The first root of the wing that becomes unstable, in the frequencies (Hz) of `benchmarks.bell_points`."""
    case = aircraft(symmetry)
    half = half_aircraft(numbers(case), symmetry)

    def growth(speed):
        found = roots(*with_rotor(half, pp.rotor_model(case.rotor, case.operation, speed), RATIO))
        return found[(found.imag > 2 * np.pi * low) & (found.imag < 2 * np.pi * high)].real.max()

    speeds = np.arange(300.0, 460.0, 20.0) * KNOT
    first = next(end for end in speeds if growth(end) > 0)
    oracles = brentq(growth, first - 20 * KNOT, first, xtol=1e-9)
    found = case.boundaries("300:460:20ktas").boundaries
    own = next(one for one in found if one.onset and low < one.frequency / (2 * np.pi) < high)
    assert own.position == pytest.approx(oracles, rel=1e-8)
    assert own.mode.startswith(symmetry) and own.kind == "flutter"


@pytest.mark.parametrize("symmetry", SYMMETRIES)
def test_a_very_heavy_fuselage_gives_the_wing_and_its_rotor_on_a_wall(symmetry):
    """By a fuselage of 1e9 of the aircraft's mass and inertias that holds the wing at its side in all motions."""
    heavy = {"mass": "6e12 kg"} | {f"{axis}_inertia": "5e13 kg*m**2" for axis in ("roll", "pitch", "yaw")}
    settings = {f"support.fuselage.{name}": value for name, value in heavy.items()}
    settings |= {"support.fuselage.whole_aircraft": "false"}
    settings |= {f"support.carry_through.{slope}": "held" for slope in ("bending_slope", "chord_slope")}
    case = aircraft(symmetry, **settings)
    given = {path.removeprefix("support."): value for path, value in numbers(case).items()}
    springs = {
        "pitch_stiffness": given["downstop_stiffness_on"],
        "yaw_stiffness": given["spindle_yaw_stiffness_on"],
    }
    wing, pylon = (
        kind(
            **{name: value for name, value in (given | springs).items() if name in kind.__dataclass_fields__}
        )
        for kind in (Wing, Pylon)
    )
    wall = beam_wing(wing, pylon, modes=6, damping_ratio=RATIO, rotor_mass=given["rotor_mass"])
    rotor = pp.rotor_model(case.rotor, case.operation, SPEEDS)
    on_wall = np.linalg.eigvals(state_matrix(pp.mount(rotor, wall)))
    free = np.linalg.eigvals(state_matrix(case.linearize(SPEEDS)))
    for mine, held in zip(free, on_wall, strict=True):
        assert farthest(held, mine) < 1e-6
        rigid = np.sort(np.abs(mine))[: len(mine) - len(held)]
        assert rigid.max() < 1e-3  # the fuselage hardly moves


@pytest.mark.parametrize(
    ("field", "intact", "lost"),
    [
        ("support.downstop", "true", "false"),
        ("rotor.control_stiffness", "22400 ft*lbf/rad", "11000 ft*lbf/rad"),
    ],
)
def test_left_and_right_exchanged_is_the_mirror_image(tmp_path, field, intact, lost):
    """A loss on the left has the roots of the same loss on the right."""
    whole, on_left, on_right = (
        np.linalg.eigvals(state_matrix(aircraft_with(tmp_path, field, right, left).linearize(SPEEDS)))
        for right, left in ((intact, intact), (intact, lost), (lost, intact))
    )
    for one, other in zip(on_left, on_right, strict=True):
        assert farthest(one, other) < 1e-8 and farthest(other, one) < 1e-8
    assert farthest(on_left[-1], whole[-1]) > 1e-3


def aircraft_with(folder, field, right, left):
    """Return the aircraft with a field set on either side."""
    deck = folder / "sides.toml"
    head = 'base = "xv15-aircraft"\n[case]\nname = "sides"\ntitle = "Two sides"\n'
    deck.write_text(f"{head}[left]\n{field} = {_as_toml(left)}\n")
    return pp.load_case(deck, {field: right})


def _as_toml(text):
    return (
        text
        if text in ("true", "false")
        else f'{{ value = "{text}", status = "assumed", source = "a test" }}'
    )
