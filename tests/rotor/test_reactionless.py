"""Blade motions that load no hub: harmonics from the second on, and neighbours against each other for an even number.

The blades move one by one in the nonlinear rotor; a numerical multiblade transform of all of them gives every
coordinate of the model, and the reactionless ones beyond. Tolerance: 1e-10 of the largest entry of a block; a block
that ought to vanish, 1e-13 of what inertia at 1/rev would put there.
"""

from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp
from tests.derive.test_airloads_virtual_work import Case
from tests.oracles.nonlinear_rotor import DOFS, FLAP, LAG, PITCH, linearised, rows_in_vacuum
from tests.oracles.random_rotors import NO_LINKAGES
from tests.oracles.virtual_work import airload_rows

ANGLES = ("flap", "lag", "pitch")
BEYOND = {
    4: ("flap_d", "lag_d", "pitch_d"),
    5: ("flap_2c", "flap_2s", "lag_2c", "lag_2s", "pitch_2c", "pitch_2s"),
    6: ("flap_2c", "flap_2s", "lag_2c", "lag_2s", "pitch_2c", "pitch_2s", "flap_d", "lag_d", "pitch_d"),
    7: tuple(f"{angle}_{n}{part}" for n in (2, 3) for angle in ANGLES for part in "cs"),
}
SHAFT = [place for place, name in enumerate(DOFS) if name.rpartition("_")[0] not in ANGLES]


POWERED = {"collective": 0.8}


def flown(n_blades):
    """Windmilling, or with a steady torque for an odd number of blades."""
    return Case(20 + n_blades, 100.0, POWERED if n_blades % 2 else "windmill", n_blades=n_blades)


# All blades of the nonlinear rotor on their own


def blade_by_blade(case, model, airloads, shaft):
    """M, C, K on the coordinates of hub, shaft and gimbal, and on flap, lag and pitch of each blade.

    A rotor of one blade at the azimuth of each: its collective coordinates are the blade's own. What there is once per
    rotor is shared out.
    """
    rotor, trim = case.oracle(model)
    n_blades = rotor.n_blades
    shares = {name: getattr(rotor, name) / n_blades for name in ("gimbal_stiffness", "gimbal_damping")}
    one = replace(rotor, n_blades=1, **shares)

    def rows(q, time):
        return rows_in_vacuum(one, q, time) + (airload_rows(case.air, one, q, time) if airloads else 0.0)

    size = len(SHAFT) + 3 * n_blades
    whole = np.zeros((3, size, size))
    for blade in range(n_blades):
        azimuth = shaft + 2 * np.pi * blade / n_blades
        own = [len(SHAFT) + 3 * blade + angle for angle in range(3)]
        places = np.ix_(range(3), [*range(len(SHAFT)), *own], [*range(len(SHAFT)), *own])
        picked = [*SHAFT, FLAP, LAG, PITCH]
        whole[places] += np.array(linearised(rows, trim, azimuth / rotor.rotor_speed))[:, picked][
            :, :, picked
        ]
    return whole


def harmonics(name, azimuth, blade):
    """A multiblade coordinate on one blade, and its first and second derivative by azimuth."""
    kind = name.rpartition("_")[2]
    if kind in ("0", "d"):
        return np.array([(-1.0) ** blade if kind == "d" else 1.0, 0.0, 0.0])
    n, turn = int(kind[0]), 0.0 if kind[1] == "c" else -np.pi / 2
    angle = n * azimuth + turn
    return np.array([np.cos(angle), -n * np.sin(angle), -(n**2) * np.cos(angle)])


def multiblade_transform(dofs, n_blades, shaft):
    """Single blades in multiblade coordinates, and the derivatives of that by azimuth: (3, single, dofs)."""
    transform = np.zeros((3, len(SHAFT) + 3 * n_blades, len(dofs)))
    for column, name in enumerate(dofs):
        angle = name.rpartition("_")[0]
        if angle not in ANGLES:
            transform[0, [DOFS[place] for place in SHAFT].index(name), column] = 1
            continue
        for blade in range(n_blades):
            row = len(SHAFT) + 3 * blade + ANGLES.index(angle)
            transform[:, row, column] = harmonics(name, shaft + 2 * np.pi * blade / n_blades, blade)
    return transform


def in_multiblade_coordinates(single, dofs, n_blades, rotor_speed, shaft):
    M, C, K = single
    T, rate, acceleration = multiblade_transform(dofs, n_blades, shaft)
    rate, acceleration = rotor_speed * rate, rotor_speed**2 * acceleration
    return T.T @ M @ T, T.T @ (2 * M @ rate + C @ T), T.T @ (M @ acceleration + C @ rate + K @ T)


def blocks(dofs):
    """Places of the coordinates of one kind."""
    hub = [dofs[:3], dofs[3:6], ("azimuth",), ("gimbal_1c", "gimbal_1s")]
    kinds = [[name for name in dofs if name.rpartition("_")[0] == angle] for angle in ANGLES]
    split = [[name for name in kind if (name in DOFS) == low] for kind in kinds for low in (True, False)]
    return [[dofs.index(name) for name in block if name in dofs] for block in (*hub, *split) if len(block)]


def assert_same(actual, expected, model, rotor_speed):
    root = np.sqrt(np.diag(model.M))
    for power, (is_, should_be) in enumerate(zip(actual, expected, strict=True)):
        for rows in blocks(model.dofs):
            for columns in blocks(model.dofs):
                block = np.ix_(rows, columns)
                natural = rotor_speed**power * root[rows].max() * root[columns].max()
                allowed = 1e-10 * np.abs(should_be[block]).max() + 1e-13 * natural
                error = np.abs(is_[block] - should_be[block]).max()
                assert error <= allowed, ("MCK"[power], model.dofs[rows[0]], model.dofs[columns[0]], error)


@pytest.mark.parametrize(
    ("n_blades", "airloads"), [(4, "full"), (5, "full"), (6, "full"), (7, "full"), (4, "none"), (5, "none")]
)
def test_all_blades_of_the_nonlinear_rotor(n_blades, airloads):
    """The whole model, reactionless or not, from each blade on its own, at an azimuth like any other."""
    case, shaft = flown(n_blades), 0.7
    model = case.model(reactionless=True, airloads=airloads)
    single = blade_by_blade(case, model, airloads == "full", shaft)
    expected = in_multiblade_coordinates(single, model.dofs, n_blades, case.pair.rotor_speed, shaft)
    assert_same((model.M, model.C, model.K), expected, model, case.pair.rotor_speed)


# What it adds, and what it leaves alone


@pytest.mark.parametrize("n_blades", BEYOND)
def test_reactionless_motions_come_last_and_couple_with_nothing(n_blades):
    """Bit for bit."""
    case = flown(n_blades)
    without, model = case.model(), case.model(reactionless=True)
    assert without.dofs == DOFS
    assert model.dofs == (*DOFS, *BEYOND[n_blades])
    for name in "MCK":
        matrix = getattr(model, name)
        assert np.array_equal(matrix[:18, :18], getattr(without, name))
        assert not matrix[:18, 18:].any()
        assert not matrix[18:, :18].any()
    assert np.array_equal(model.B[:18], without.B)
    assert not model.B[18:].any()


def test_three_blades_have_none():
    case = flown(3)
    without, model = case.model(), case.model(reactionless=True)
    assert model.dofs == without.dofs
    for name in ("M", "C", "K", "B"):
        assert np.array_equal(getattr(model, name), getattr(without, name))


REMOVED = {
    "flap": ({"locked": ("flap",)}, ("flap",)),
    "lag and gimbal": ({"locked": ("lag", "gimbal")}, ("lag",)),
    "pitch": ({"locked": ("pitch",)}, ("pitch",)),
    "rigid pitch": ({"pitch": "rigid"}, ("pitch",)),
    "pitch by coupling": ({"pitch": "coupling"}, ("pitch",)),
    "blades": ({"locked": ("flap", "lag", "pitch")}, ANGLES),
}


@pytest.mark.parametrize("n_blades", [4, 5, 6])
@pytest.mark.parametrize("name", REMOVED)
def test_what_is_locked_is_locked_there_too(name, n_blades):
    options, removed = REMOVED[name]
    model = flown(n_blades).model(reactionless=True, **options)
    left = [dof for dof in BEYOND[n_blades] if dof.rpartition("_")[0] not in removed]
    assert [dof for dof in model.dofs if dof not in DOFS] == left


def test_different_harmonics_couple_with_each_other_no_more():
    model = flown(7).model(reactionless=True)
    second, third = ([model.dofs.index(dof) for dof in BEYOND[7] if f"_{n}" in dof] for n in (2, 3))
    for name in "MCK":
        assert not getattr(model, name)[np.ix_(second, third)].any()
        assert not getattr(model, name)[np.ix_(third, second)].any()


@pytest.mark.parametrize("n_blades", [4, 5, 6, 7])
def test_a_harmonic_shifts_the_frequency_of_a_blade(n_blades):
    """A flat blade at ν per rev is at |ν − n| and ν + n in the n-th harmonic, and at ν against its neighbours."""
    flap, lag, speed = 1.13, 2.4, 44.0
    pair = flown(n_blades).pair
    flat = replace(
        pair.package, precone=0.0, flap_damping=0.0, lag_damping=0.0, offset_mass=None, **NO_LINKAGES
    )
    operation = pp.Operation(rotor_speed=speed, density=0.0, speed_of_sound=340.0, trim={"collective": 0.3})
    given = {
        "structure": "tabulated",
        "frequencies": pp.BladeFrequencies(at_rotor_speed=speed, flap=flap, lag=lag, cyclic_flap=1.9),
    }
    model = pp.rotor_model(flat, operation, 0.0, airloads="none", pitch="rigid", reactionless=True, **given)
    beyond = [dof for dof in model.dofs if dof not in DOFS]
    expected = []
    for nu in (flap, lag):
        expected += [nu] * (n_blades % 2 == 0)
        expected += [shifted for n in range(2, (n_blades + 1) // 2) for shifted in (abs(nu - n), nu + n)]
    found = model.submodel(tuple(beyond)).modes().frequency.values / speed
    assert np.allclose(found, sorted(expected), rtol=0, atol=1e-12)


def test_reactionless_modes_leave_the_hub_alone():
    """On a support too: all other modes are where they were."""
    case, support = flown(5), pp.load_case("xv15-uncoupled").support
    mounted = pp.Case("five blades", case.pair.package, case.operation, support)
    few, all_ = (mounted.linearize(100.0, reactionless=choice).modes() for choice in (False, True))
    still = np.abs(all_.shape.sel(dof=list(BEYOND[5]))).max("dof") < 1e-6
    assert np.allclose(all_.eigenvalue.values[still.values], few.eigenvalue.values, rtol=1e-9)
