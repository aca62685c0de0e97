"""Which of several equilibria a trim is: the end of the path from the undeflected blade, or a reason.

The paths it is compared with are those of `tests.oracles.trim_paths`, which goes along them by their length.
"""

import dataclasses
from collections import Counter

import numpy as np
import pytest

import proprotor as pp
from benchmarks.trim_paths import KINDS, TURNED, population, verdicts
from proprotor.rotor.airfoil import SectionCoefficients
from tests.oracles import trim_paths as oracle

ANGLES = ("coning", "lag", "elastic_pitch")
STATE = (*ANGLES, "collective")

# A soft rotor that has several equilibria, and where the path leads at some collectives (2,000 steps of the share).
SOFT = pp.Rotor(
    n_blades=3,
    radius=5.527968287409176,
    root_cutout=0.14049600829788758,
    flap_hinge_offset=0.16689702589101396,
    lag_hinge_offset=0.3979741114783775,
    precone=0.04264263185395058,
    blade_mass=1.415180831347088,
    blade_first_moment=3.883580001601971,
    blade_inertia=14.409764587160069,
    flap_first_moment=3.6514178122019523,
    flap_inertia=13.152474145561738,
    lag_first_moment=3.345904929572589,
    lag_inertia=11.536410782383069,
    flap_stiffness=29272.199227901485,
    lag_stiffness=82630.27503067508,
    flap_outboard_fraction=0.9082101416703356,
    lag_outboard_fraction=0.0864850774743938,
    control_stiffness=4916.93343415689,
    pitch_inertia=0.0496095640877022,
    flap_damping=1.814823861200391,
    lag_damping=8.208497773086648,
    pitch_damping=0.10194738386651624,
    gimbal_stiffness=282.40040939055586,
    pitch_gimbal_coupling=-0.06429892239551188,
    chord=0.6496311500397747,
    twist=-0.6756404345147096,
    structural_pitch_offset=0.3667530211759381,
    airfoil=pp.Airfoil(lift_slope=5.7, drag=0.011102991676666136),
)
ENDS = {
    0.80811313: (-0.01408544, -0.06626367, -0.00221123),
    0.78: (-0.05361195, -0.17769183, 0.02155851),
    0.83: (0.01900651, 0.02774622, -0.02648283),
    0.85: (0.05062121, 0.11454127, -0.05367244),
}
AIRSPEED = 238.69140269357098
WITHOUT = {"compressibility": False, "section_damping": False}


def operated(trim, **changes):
    given = {"rotor_speed": 57.567516031651195, "density": 1.1575393111065142, "speed_of_sound": 340.0}
    return pp.Operation(**(given | changes), trim=trim)


def soft_trim(collective, **changes):
    return pp.rotor_model(SOFT, operated({"collective": collective}, **changes), AIRSPEED, **WITHOUT).trim


def states(trim):
    return np.stack([getattr(trim, name) for name in STATE], axis=-1)


# The example --------------------------------------------------------------------------------------


def test_a_soft_rotor_trims_to_the_end_of_its_path():
    trim = soft_trim(np.array(list(ENDS)))
    assert trim.converged.all()
    found = np.stack([getattr(trim, name) for name in ANGLES], axis=-1)
    assert (
        np.abs(found - np.array(list(ENDS.values()))).max() < 2e-8
    )  # the digits given, and those of the collective


def test_the_trim_of_a_soft_rotor_is_smooth_in_the_collective():
    """Along 71 collectives: each lies on the cubic through its four neighbours, far within the distance of branches."""
    trim = soft_trim(np.linspace(0.78, 0.85, 71))
    assert trim.converged.all()
    for name in ANGLES:
        assert np.abs(np.diff(getattr(trim, name), 4)).max() < 1e-6


def test_its_trim_follows_a_complex_step():
    """Into the density, beside central differences."""
    density, step = 1.1575393111065142, 1e-4
    exact = soft_trim(0.8, density=np.array(density + 1e-30j))
    lower, higher = (soft_trim(0.8, density=density + sign * step) for sign in (-1, 1))
    for name in ANGLES:
        slope = (getattr(higher, name) - getattr(lower, name)) / (2 * step)
        assert getattr(exact, name).imag / 1e-30 == pytest.approx(float(slope), rel=1e-5)


# Random rotors ------------------------------------------------------------------------------------

EACH = 60


@pytest.fixture(scope="module", params=KINDS)
def compared(request):
    rotors = population(request.param, EACH, seed=1)
    return rotors, rotors.trim(), rotors.paths()


def test_random_rotors_trim_to_the_end_of_their_path_or_say_why_not(compared):
    """To 1e-8 rad; `python -m benchmarks.trim_paths` does it with 10,000."""
    rotors, trim, ends = compared
    counts = Counter(verdicts(trim, ends).tolist())
    assert set(counts) <= {"same trim", "both turn back", "beyond what angles mean"}, counts
    assert counts["same trim"] > 0.8 * EACH
    if rotors.kind == "collective":
        assert counts["both turn back"]


def test_a_failed_or_doubtful_point_is_alone_what_it_is_in_company(compared):
    rotors, trim, _ = compared
    places = [
        *np.flatnonzero([TURNED in reason for reason in trim.reason])[:1],
        *np.argsort(-trim.iterations)[-2:],
        0,
    ]
    for place in places:
        own = {
            entry.name: getattr(rotors.rotor, entry.name)[place]
            for entry in dataclasses.fields(pp.Rotor)
            if np.ndim(getattr(rotors.rotor, entry.name))
        }
        own["n_blades"] = int(own["n_blades"])
        airfoil = pp.Airfoil(**{k: float(v[place]) for k, v in vars(rotors.rotor.airfoil).items()})
        operation = rotors.operation
        target = operation.trim
        single = pp.rotor_model(
            dataclasses.replace(rotors.rotor, **own, airfoil=airfoil),
            pp.Operation(
                **{
                    name: float(getattr(operation, name)[place])
                    for name in ("rotor_speed", "density", "speed_of_sound")
                },
                trim=target if isinstance(target, str) else {k: float(v[place]) for k, v in target.items()},
            ),
            rotors.airspeed[place : place + 1],
            section_damping=False,
        ).trim
        assert single.reason[0] == trim.reason[place] and single.warning[0] == trim.warning[place]
        assert single.iterations[0] == trim.iterations[place]
        assert np.array_equal(states(single)[0], states(trim)[place], equal_nan=True)


# Warnings -----------------------------------------------------------------------------------------


def test_a_rotor_that_diverges_says_so(compared):
    """A real eigenvalue below zero of the oracle's slopes of flap, lag and pitch, at the collective as it is."""
    rotors, trim, ends = compared
    here = np.flatnonzero(trim.converged & ends.arrived)
    blades = rotors.blades.of(here)
    _, slopes, _ = oracle.linear(blades, ends.state[here], np.ones(len(here)), oracle.sections(blades))
    stiffness = (slopes * oracle.scales(blades)[:, :, None])[:, :3, :3]
    values = np.linalg.eigvals(stiffness)
    lowest = np.where(np.abs(values.imag) < 1e-6 * np.abs(values), values.real, np.inf).min(axis=1)
    clear = np.abs(lowest) > 1e-4 * np.abs(values).max(axis=1)
    told = np.array(["diverges" in text for text in trim.warning[here]])
    assert np.array_equal(told[clear], lowest[clear] < 0)


def test_the_soft_rotor_diverges_at_the_higher_collectives():
    trim = soft_trim(np.array([0.78, 0.85]))
    assert ["diverges" in text for text in trim.warning] == [False, True]


def test_angles_beyond_what_rigid_hinges_stand_for_are_told(compared):
    _, trim, _ = compared
    for name in ANGLES:
        told = np.array([f"{name.replace('_', ' ')} beyond 20 deg" in text for text in trim.warning])
        assert np.array_equal(told, np.nan_to_num(np.abs(getattr(trim, name))) > np.radians(20))


# Where a path begins ------------------------------------------------------------------------------


class WavyLift:
    """Lift that comes and goes with the angle of attack, so that a rigid blade's torque vanishes many times."""

    contains_compressibility = True

    def coefficients(self, alpha, mach):
        zero = np.zeros_like(alpha)
        lift, slope = 0.5 * np.sin(24 * alpha + 1.0), 12 * np.cos(24 * alpha + 1.0)
        return SectionCoefficients(lift, slope, zero, zero + 0.01, zero, zero, zero, zero, zero)


@pytest.mark.parametrize("locked", [("flap", "lag", "pitch"), ()], ids=["rigid", "stiff"])
@pytest.mark.parametrize("airspeed", [70.0, 110.0, 150.0])
def test_of_several_collectives_without_torque_the_nearest_to_the_air_is_meant(airspeed, locked):
    """Beside a scan of the rigid blade's torque; a stiff blade ends near it."""
    changes = {
        "flap_stiffness": 1e9,
        "lag_stiffness": 1e9,
        "flap_outboard_fraction": 0.0,
        "lag_outboard_fraction": 0.0,
        "control_stiffness": 1e8,
        "twist": -0.7,
        "airfoil": WavyLift(),
    }
    rotor = dataclasses.replace(SOFT, **changes)
    air = np.arctan2(airspeed, 0.75 * 57.567516031651195 * SOFT.radius)
    rigid = dataclasses.replace(rotor, precone=0.0)
    angles = np.linspace(-np.radians(60), np.radians(60), 24001)
    still = {"locked": ("flap", "lag", "pitch"), **WITHOUT}
    torque = pp.rotor_model(rigid, operated({"collective": air + angles}), airspeed, **still).trim.torque
    crossings = np.flatnonzero(np.diff(np.sign(torque)))
    assert len(crossings) > 3
    nearest = angles[crossings[np.argmin(np.abs(angles[crossings]))]]
    found = pp.rotor_model(rotor, operated("windmill"), airspeed, locked=locked, **WITHOUT).trim
    assert found.converged, found.reason
    assert abs(found.collective - air - nearest) < 2e-3


def test_a_lag_hinge_at_the_centre_that_nothing_holds_trims():
    """Without torque a blade that may lag freely lags nowhere, but it has no path: at no loads nothing holds it."""
    moments = {
        "flap_first_moment": SOFT.blade_first_moment,
        "lag_first_moment": SOFT.blade_first_moment,
        "flap_inertia": SOFT.blade_inertia,
        "lag_inertia": SOFT.blade_inertia,
    }
    hinges = {"flap_hinge_offset": 0.0, "lag_hinge_offset": 0.0, "flap_stiffness": 0.0, "lag_stiffness": 0.0}
    rotor = dataclasses.replace(SOFT, **hinges, **moments)
    trim = pp.rotor_model(rotor, operated("windmill"), 80.0, locked=("pitch",), **WITHOUT).trim
    held = pp.rotor_model(rotor, operated("windmill"), 80.0, locked=("pitch", "lag"), **WITHOUT).trim
    if trim.converged:
        assert trim.coning == pytest.approx(float(held.coning), abs=1e-6)
    assert held.converged and "path" not in str(trim.reason)
