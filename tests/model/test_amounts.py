"""What inputs amount to, against formulas written here for a uniform blade, and the marks of doubtful numbers."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import proprotor as pp
from proprotor.errors import InputError
from proprotor.model.amount_rules import RULES, doubt_of
from proprotor.model.amounts import amounts, blade_at_trims, support_modes
from proprotor.tables.amounts_table import amounts_tables

EXACT = 1e-12  # two ways of the same few operations

M, R, CUTOUT, E, OMEGA, RHO, SLOPE = 6.0, 4.0, 0.4, 0.4, 50.0, 1.2, 5.7  # kg/m, m, m, m, rad/s, kg/m³, 1/rad
K_FLAP, K_LAG, K_PITCH, K_GIMBAL, OFFSET = 60000.0, 250000.0, 9000.0, 8000.0, 0.1
ROOT, TIP = 0.4, 0.2  # chord at the cutout and at the tip, m
INERTIA = M * (R - E) ** 3 / 3  # outboard of both hinges
FIRST = M * (R - E) ** 2 / 2

DECK = f"""
[case]
name = "uniform"
title = "Uniform blade"
[rotor]
n_blades = 3
radius = "{R} m"
root_cutout = "{CUTOUT} m"
flap_hinge_offset = "{E} m"
lag_hinge_offset = "{E} m"
precone = "1.5 deg"
mass_distribution = {{ r_over_R = [0, 1], value = [{M}, {M}], unit = "kg/m" }}
flap_stiffness = "{K_FLAP} N*m/rad"
lag_stiffness = "{K_LAG} N*m/rad"
flap_outboard_fraction = 1
lag_outboard_fraction = 1
structural_pitch_offset = "{OFFSET} rad"
gimbal_stiffness = "{K_GIMBAL} N*m/rad"
pitch_gimbal_coupling = -0.2
pitch_inertia = "0.4 kg*m**2"
control_stiffness = "{K_PITCH} N*m/rad"
chord = {{ r_over_R = [{CUTOUT / R}, 1], value = [{ROOT}, {TIP}], unit = "m" }}
twist = "-40 deg"
[rotor.airfoil]
lift_slope = "{SLOPE}/rad"
drag = 0.01
[operation]
rotor_speed = "{OMEGA} rad/s"
density = "{RHO} kg/m**3"
speed_of_sound = "340 m/s"
[support]
kind = "normal-modes"
includes_rotor = false
[[support.modes]]
name = "beam"
coordinate = "length"
frequency = "20 rad/s"
damping_ratio = 0.01
generalized_mass = "400 kg"
x = 1
"""

Make = Callable[..., pp.Case]


@pytest.fixture
def make(tmp_path: Path) -> Make:
    def made(**settings: str) -> pp.Case:
        (tmp_path / "uniform.toml").write_text(DECK)
        return pp.load_case(
            tmp_path / "uniform.toml", {key.replace("__", "."): v for key, v in settings.items()}
        )

    return made


def moment(n: int) -> float:
    """Return ∫ c rⁿ dr of the tapered chord, exactly."""
    chord = np.polynomial.Polynomial.fit([CUTOUT, R], [ROOT, TIP], 1).convert()
    whole = (chord * np.polynomial.Polynomial([0] * n + [1])).integ()
    return float(whole(R) - whole(CUTOUT))


def test_the_amounts_of_a_uniform_blade(make: Make) -> None:
    found = {one.name: one.value for one in amounts(make())}
    i_b, m_b, s_b = M * R**3 / 3, M * R, M * R**2 / 2
    chord_by_cube = moment(3) / ((R**4 - CUTOUT**4) / 4)
    by_hand = {
        "mean chord": (ROOT + TIP) / 2,
        "solidity": 3 * (ROOT + TIP) / 2 / (np.pi * R),
        "Lock number": RHO * SLOPE * chord_by_cube * R**4 / i_b,
        "tip Mach number": OMEGA * R / 340,
        "blade mass": m_b,
        "blade first moment": s_b,
        "blade inertia": i_b,
        "flap first moment": FIRST,
        "flap inertia": INERTIA,
        "lag first moment": FIRST,
        "lag inertia": INERTIA,
        "I_βα": M * ((R**3 - E**3) / 3 - E * (R**2 - E**2) / 2),
        "I_ζα": M * ((R**3 - E**3) / 3 - E * (R**2 - E**2) / 2),
        "I_βζ": INERTIA,
        "centre of mass": R / 2,
        "radius of gyration": R / np.sqrt(3),
        "gimbal frequency": np.sqrt(1 + K_GIMBAL / (1.5 * i_b * OMEGA**2)),
        "precone": np.radians(1.5),
        "density": RHO,
        "speed of sound": 340,
    }
    assert {name: found[name] for name in by_hand} == pytest.approx(by_hand, rel=1e-10)
    assert set(found) - set(by_hand) == {"smallest eigenvalue of the Gram matrix"}


def test_equal_hinges_make_the_gram_matrix_singular_and_two_points_of_mass_do_too(make: Make) -> None:
    (equal,) = [one for one in amounts(make()) if "Gram" in one.name]
    assert abs(equal.value) < EXACT and "Gram" in equal.doubt
    (apart,) = [one for one in amounts(make(rotor__lag_hinge_offset="1.2 m")) if "Gram" in one.name]
    assert 1e-4 < apart.value < 1 and not apart.doubt


def test_frequencies_and_couplings_at_trim_are_those_of_turned_springs(make: Make) -> None:
    """A blade spring turned by θ has β' = β cos θ + ζ sin θ and ζ' = ζ cos θ - β sin θ as its deflections."""
    found = blade_at_trims(make())
    assert len(found) == 5 and all(np.diff([blade.collective for blade in found]) > 0)
    for blade in found:
        theta = blade.collective + blade.elastic_pitch + OFFSET
        c, s = np.cos(theta), np.sin(theta)
        centrifugal = E * FIRST / INERTIA
        flap = np.sqrt(1 + centrifugal + (K_FLAP * c**2 + K_LAG * s**2) / (INERTIA * OMEGA**2))
        lag = np.sqrt(centrifugal + (K_FLAP * s**2 + K_LAG * c**2) / (INERTIA * OMEGA**2))
        assert (blade.flap_frequency, blade.lag_frequency) == pytest.approx((flap, lag), rel=1e-10)
        across = blade.coning * c + blade.lag * s
        along = blade.lag * c - blade.coning * s
        # U = (K_β β'² + K_ζ ζ'²)/2, ∂U/∂θ = (K_β - K_ζ) β' ζ'; K_P is its gradient over the control stiffness.
        couplings = [(K_FLAP - K_LAG) * (c * along - s * across), (K_FLAP - K_LAG) * (s * along + c * across)]
        pair = (blade.pitch_flap_coupling, blade.pitch_lag_coupling)
        assert pair == pytest.approx(np.array(couplings) / K_PITCH, rel=1e-9)
        cyclic = (blade.cyclic_pitch_flap_coupling, blade.cyclic_pitch_lag_coupling)
        assert cyclic == pair


def test_couplings_of_a_swashplate_that_tilts_on_a_stiffness_of_its_own(make: Make) -> None:
    """K_P of each harmonic times its stiffness is the same torque; only the table of such a rotor has both."""
    plain, softer = make(), make(rotor__cyclic_control_stiffness=f"{0.4 * K_PITCH!r} N*m/rad")
    for one, other in zip(blade_at_trims(plain), blade_at_trims(softer), strict=True):
        assert other.pitch_flap_coupling == one.pitch_flap_coupling
        assert 0.4 * other.cyclic_pitch_flap_coupling == pytest.approx(one.pitch_flap_coupling, rel=1e-12)
        assert 0.4 * other.cyclic_pitch_lag_coupling == pytest.approx(one.pitch_lag_coupling, rel=1e-12)
    heads = [amounts_tables(case)[0][1].columns for case in (plain, softer)]
    assert heads[1] == (*heads[0], "K_Pβ, cyclic", "K_Pζ, cyclic")


def test_the_modes_of_the_support_carry_the_blades_on_request(make: Make) -> None:
    (mode,) = support_modes(make())
    alone = 20.0 / (2 * np.pi)
    assert (mode.name, mode.alone) == ("beam", pytest.approx(alone, rel=EXACT))
    # The blades' mass moves with the hub. Their centre of mass stands off the gimbal by the cone, so the gimbal tilts.
    lift, i_b = np.sin(np.radians(1.5)), M * R**3 / 3
    tilting = 1.5 * (i_b * (1 + lift**2) + 0.4 * 0.2**2)  # pitch inertia times the square of K_PG
    carried = 3 * M * R - (3 * M * R**2 / 2 * lift) ** 2 / tilting
    assert mode.with_rotor == pytest.approx(alone * np.sqrt(400 / (400 + carried)), rel=1e-9)


@pytest.mark.parametrize(
    ("settings", "name"),
    [
        ({"rotor__chord": "14 ft"}, "mean chord"),
        ({"operation__density": "0.00238 lb/ft**3"}, "density"),
        ({"operation__density": "0.0765 slug/ft**3"}, "density"),
        ({"rotor__lock_number": "40"}, "Lock number"),
        ({"operation__rotor_speed": "458 rad/s"}, "tip Mach number"),
        ({"rotor__precone": "0.5 rad"}, "precone"),
    ],
)
def test_a_slip_of_a_unit_is_marked_with_its_rule(make: Make, settings: dict[str, str], name: str) -> None:
    doubts = {one.name: one.doubt for one in amounts(make(**settings)) if one.doubt}
    assert RULES[name].reason in doubts[name]
    assert name not in {one.name for one in amounts(make()) if one.doubt}


def test_a_soft_lag_hinge_is_marked_at_each_trim(make: Make) -> None:
    at_root = {"rotor__flap_outboard_fraction": "0", "rotor__lag_outboard_fraction": "0"}
    assert not any("resonance" in blade.doubt for blade in blade_at_trims(make(**at_root)))
    soft = blade_at_trims(make(**at_root, rotor__lag_stiffness="2000 N*m/rad"))
    assert soft and all("resonance" in blade.doubt for blade in soft)


@pytest.mark.parametrize("name", RULES)
def test_a_rule_marks_what_lies_outside_and_nothing_inside(name: str) -> None:
    low, high, reason, unit = RULES[name]
    assert not doubt_of(name, low) and not doubt_of(name, min(high, 1e6))
    assert reason in doubt_of(name, low - 0.1 * abs(low) - 1e-12)
    assert np.isinf(high) or f"above {high:g} {unit}".rstrip() + f": {reason}" in doubt_of(name, 1.1 * high)


def test_a_vacuum_and_a_rotor_without_control_stiffness_are_no_doubts(make: Make) -> None:
    vacuum = make(operation__density="0 kg/m**3", operation__trim='{ collective = "30 deg" }')
    doubts = [one.name for one in amounts(vacuum) if one.doubt]
    assert "density" not in doubts and "Lock number" not in doubts
    free = blade_at_trims(make(rotor__control_stiffness="0 N*m/rad"))
    assert len(free) == 5 and all(np.isnan(blade.pitch_flap_coupling) for blade in free)


def test_many_designs_at_once_are_refused(make: Make) -> None:
    many = make().vary({"rotor.precone": np.array([0.0, 0.1])})
    for found in (amounts, blade_at_trims, support_modes):
        with pytest.raises(InputError, match="must be a single design"):
            found(many)
