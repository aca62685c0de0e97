"""The free aircraft against both wings assembled anew, closed forms of a rigid body, and the cantilever.

The assembly here shares nothing with the package: elements by integrals of Hermite's cubics, all nodes of both wings in
the axes of the right rotor, and one fuselage, with the rigid motions among the modes.
"""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg

from proprotor.errors import InputError
from proprotor.support.aircraft_airloads import Tail, aircraft_motion, with_airloads
from proprotor.support.aircraft_structure import CarryThrough, Fuselage, WingSide, half_aircraft
from proprotor.support.beam_wing import Pylon, Wing, beam_wing
from proprotor.support.free_airframe import free_airframe
from proprotor.support.wing_aerodynamics import WingAerodynamics

UP, OUTBOARD, FORWARD = np.eye(3)
ROTOR = 180.0  # kg at each hub
HEAVY = 1e9

WING = Wing(
    span=4.2,
    beam_stiffness=1.06e7,
    chord_stiffness=3.2e7,
    torsion_stiffness=8.0e6,
    axial_stiffness=3e8,
    mass_per_length=40.0,
    torsional_inertia_per_length=7.0,
    sweep=-0.11,
    dihedral=0.035,
    elements=3,
)
PYLON = Pylon(
    nacelle_mass=720.0,
    nacelle_pitch_inertia=420.0,
    nacelle_yaw_inertia=400.0,
    nacelle_roll_inertia=90.0,
    nacelle_forward=0.2,
    nacelle_up=0.1,
    nacelle_outboard=-0.05,
    mast_length=1.2,
    mast_height=0.15,
    mast_outboard=0.05,
    hub_mass=70.0,
    pitch_stiffness=7e6,
    yaw_stiffness=1.6e7,
)
BOX = CarryThrough(half_width=0.7, bending_slope=2e7, chord_slope="free", twist=3e7)
BODY = Fuselage(
    mass=3500.0,
    roll_inertia=2700.0,
    pitch_inertia=14000.0,
    yaw_inertia=16000.0,
    product_of_inertia=-400.0,
    centre_forward=0.5,
    centre_up=-1.1,
)
SIDE = WingSide(BOX, WING, PYLON)


def model(right=SIDE, left=None, body=BODY, **options):
    return free_airframe(body, right, left, **{"rotor_mass": ROTOR, "modes": 6} | options)


def cross(vector):
    """Matrix of ω × r on ω: displacement of a point r of a body that turns."""
    x, y, z = vector
    return np.array([[0, z, -y], [-z, 0, x], [y, -x, 0]])


def carried(offset):
    return np.block([[np.eye(3), cross(offset)], [np.zeros((3, 3)), np.eye(3)]])


def element(axis, own):
    """Mass and stiffness (12, 12) of one element, by integrals over its shape functions."""
    length = np.linalg.norm(axis)
    along = axis / length
    up = UP - (UP @ along) * along
    up /= np.linalg.norm(up)
    aft = np.cross(along, up)
    points, weights = np.polynomial.legendre.leggauss(6)
    mass, stiffness = np.zeros((12, 12)), np.zeros((12, 12))
    for point, weight in zip((points + 1) / 2, weights / 2 * length, strict=True):
        s = point
        cubics = np.array([1 - 3 * s**2 + 2 * s**3, s - 2 * s**2 + s**3, 3 * s**2 - 2 * s**3, s**3 - s**2])
        curved = np.array([12 * s - 6, 6 * s - 4, 6 - 12 * s, 6 * s - 2]) / length**2
        for across, bending in ((up, own["beam"]), (aft, own["chord"])):
            slope = np.cross(along, across)  # ω × along, along `across`: ω · (along × across)
            ends = np.concatenate([across, slope * length])
            spread = [
                np.concatenate([c[0] * ends[:3], c[1] * ends[3:], c[2] * ends[:3], c[3] * ends[3:]])
                for c in (cubics, curved)
            ]
            mass += weight * own["mass"] * np.outer(spread[0], spread[0])
            stiffness += weight * bending * np.outer(spread[1], spread[1])
        for start, inertia, rigidity in ((0, own["mass"], own["axial"]), (3, own["inertia"], own["torsion"])):
            linear, rate = np.zeros(12), np.zeros(12)
            linear[start : start + 3], linear[6 + start : 9 + start] = (1 - s) * along, s * along
            rate[start : start + 3], rate[6 + start : 9 + start] = -along / length, along / length
            mass += weight * inertia * np.outer(linear, linear)
            stiffness += weight * rigidity * np.outer(rate, rate)
    return mass, stiffness


def whole_aircraft(right, left, body):
    """Mass and stiffness of both wings, pylons, rotors and the fuselage, and the motion of both hubs.

    Coordinates: six of the fuselage's datum, six of each node of the chain, six of each pylon at its wing tip; then
    what the fuselage and the spindles tie is taken out.
    """
    mirror = np.diag([1.0, -1.0, 1.0])
    points, properties, sides = [], [], []
    for side, turn in ((left, mirror), (right, np.eye(3))):
        box = (
            np.linspace(0, 1, side.carry_through.elements + 1)[:, None]
            * side.carry_through.half_width
            * OUTBOARD
        )
        tip = side.wing.span * np.array([np.tan(side.wing.dihedral), 1.0, -np.tan(side.wing.sweep)])
        wing = box[-1] + np.linspace(0, 1, side.wing.elements + 1)[:, None] * tip
        own = dict(
            beam=side.wing.beam_stiffness,
            chord=side.wing.chord_stiffness,
            torsion=side.wing.torsion_stiffness,
            axial=side.wing.axial_stiffness,
            mass=side.wing.mass_per_length,
            inertia=side.wing.torsional_inertia_per_length,
        )
        chain = np.concatenate([box[:-1], wing]) @ turn
        points.append(chain)
        properties.append(own)
        sides.append((side, turn))
    nodes = np.concatenate([points[0][:0:-1], points[1]])
    count_left = len(points[0]) - 1
    count = 6 + 6 * len(nodes) + 12
    mass, stiffness = np.zeros((count, count)), np.zeros((count, count))
    for k in range(len(nodes) - 1):
        place = slice(6 + 6 * k, 18 + 6 * k)
        added = element(nodes[k + 1] - nodes[k], properties[0 if k < count_left else 1])
        mass[place, place] += added[0]
        stiffness[place, place] += added[1]
    rigid = np.diag([body.mass] * 3 + [body.yaw_inertia, body.pitch_inertia, body.roll_inertia])
    rigid[3, 5] = rigid[5, 3] = -body.product_of_inertia
    moved = carried([body.centre_up, 0.0, body.centre_forward])
    mass[:6, :6] += moved.T @ rigid @ moved
    ties, hubs = [], []
    for number, (side, turn) in enumerate(sides):
        tip = 6 if number == 0 else 6 * len(nodes)
        own = 6 + 6 * len(nodes) + 6 * number
        pylon = side.pylon
        nacelle = np.diag(
            [pylon.nacelle_mass] * 3
            + [pylon.nacelle_yaw_inertia, pylon.nacelle_pitch_inertia, pylon.nacelle_roll_inertia]
        )
        block = slice(own, own + 6)
        for offset, inertia in (
            (pylon.nacelle, nacelle),
            (pylon.hub, np.diag([pylon.hub_mass + ROTOR] * 3 + [0.0] * 3)),
        ):
            moved = carried(turn @ offset)
            mass[block, block] += moved.T @ inertia @ moved
        motion = np.zeros((6, count))
        motion[:, block] = carried(turn @ pylon.hub)
        hubs.append(motion)
        for axis, spring in (
            (3, pylon.yaw_stiffness),
            (4, pylon.pitch_stiffness),
            *((k, None) for k in (0, 1, 2, 5)),
        ):
            difference = np.zeros(count)
            difference[own + axis], difference[tip + axis] = 1.0, -1.0
            if spring is None:
                ties.append(difference)
            else:
                stiffness += spring * np.outer(difference, difference)
        k = count_left + (-1 if number == 0 else 1) * side.carry_through.elements
        offset = carried(nodes[k])
        joints = (side.carry_through.chord_slope, side.carry_through.twist, side.carry_through.bending_slope)
        for axis, joint in enumerate(("held",) * 3 + joints):
            difference = np.zeros(count)
            difference[:6], difference[6 + 6 * k + axis] = -offset[axis], 1.0
            if joint == "held":
                ties.append(difference)
            elif joint != "free":
                stiffness += joint * np.outer(difference, difference)
    free = scipy.linalg.null_space(np.array(ties))
    return free.T @ mass @ free, free.T @ stiffness @ free, [hub @ free for hub in hubs]


def elastic(mass, stiffness, count):
    """Frequencies of the lowest modes above the six rigid ones; a shift keeps all digits of the lowest modes."""
    shift = 100.0
    found = scipy.linalg.eigh(mass, stiffness + shift * mass, eigvals_only=True)[::-1]
    return np.sqrt(1 / found[6 : 6 + count] - shift)


@pytest.mark.parametrize(
    "pylon", [PYLON, replace(PYLON, pitch_stiffness=None), replace(PYLON, yaw_stiffness=None)]
)
@pytest.mark.parametrize(
    "box", [BOX, CarryThrough(half_width=0.7), replace(BOX, bending_slope="held", chord_slope=5e6)]
)
def test_both_halves_have_the_frequencies_of_the_whole_aircraft(pylon, box):
    side = WingSide(box, WING, pylon)
    expected = elastic(*whole_aircraft(side, side, BODY)[:2], 12)
    found = np.sort(
        np.concatenate([model(side, symmetry=s, modes=10).frequency for s in ("symmetric", "antisymmetric")])
    )
    np.testing.assert_allclose(found[:12], expected, rtol=1e-10)


OTHER = WingSide(
    replace(BOX, twist="held", bending_slope="free"),
    replace(WING, torsion_stiffness=5e6, mass_per_length=50.0),
    replace(PYLON, pitch_stiffness=2e6, yaw_stiffness=None),
)


def test_two_different_sides_are_one_problem():
    free = model(SIDE, OTHER, modes=5)
    expected = elastic(*whole_aircraft(SIDE, OTHER, BODY)[:2], 10)
    np.testing.assert_allclose(free.frequency, expected, rtol=1e-10)
    assert free.airframe.symmetry[6:] == ("",) * 10
    assert {"torsion", "torsion_2", "beam"} <= set(free.airframe.names)


def test_the_mirror_image_has_the_same_frequencies_with_the_hubs_exchanged():
    one, mirrored = model(SIDE, OTHER), model(OTHER, SIDE)
    np.testing.assert_allclose(mirrored.frequency, one.frequency, rtol=1e-10)
    for first, second in (
        (one.airframe.hub, mirrored.airframe.left_hub),
        (one.airframe.left_hub, mirrored.airframe.hub),
    ):
        mobility = [
            (hub[:, 6:] / scale**2) @ hub[:, 6:].T
            for hub, scale in ((first, one.frequency), (second, mirrored.frequency))
        ]
        np.testing.assert_allclose(mobility[1], mobility[0], atol=1e-9 * np.abs(mobility[0]).max())


def test_two_equal_sides_as_one_problem_are_the_symmetric_aircraft():
    whole, halves = model(SIDE, SIDE, modes=5).airframe, model(modes=10)
    rows = np.sort(halves.frequency)[:10]
    np.testing.assert_allclose(np.sqrt(np.diag(whole.stiffness)[6:]), rows, rtol=1e-10)
    # Each mode is symmetric or antisymmetric by itself, and the halves of each energy are the same halves.
    for right, left in zip(whole.hub[:, 6:].T, whole.left_hub[:, 6:].T, strict=True):
        assert min(np.abs(right - left).max(), np.abs(right + left).max()) < 1e-7 * np.abs(right).max()
    rigid = [halves.airframe.names.index(name) for name in whole.names[:6]]
    np.testing.assert_allclose(
        whole.mass[:6, :6], halves.airframe.mass[np.ix_(rigid, rigid)], atol=1e-9 * BODY.mass
    )


def test_hub_motions_are_those_of_a_mirrored_pair():
    airframe = model().airframe
    for place, symmetry in enumerate(airframe.symmetry):
        sign = 1 if symmetry == "symmetric" else -1
        np.testing.assert_array_equal(airframe.left_hub[:, place], sign * airframe.hub[:, place])
    couples = np.array(airframe.symmetry)[:, None] != np.array(airframe.symmetry)
    for matrix in (airframe.mass, airframe.damping, airframe.stiffness):
        assert not matrix[couples].any()


def rigid_parts(side=SIDE, body=BODY):
    """Mass, centre and inertia tensor about it of every part of the aircraft; the wings by 2000 pieces."""
    parts = [(body.mass, np.array([body.centre_up, 0, body.centre_forward]),
              np.array([[body.yaw_inertia, 0, -body.product_of_inertia], [0, body.pitch_inertia, 0],
                        [-body.product_of_inertia, 0, body.roll_inertia]]))]  # fmt: skip
    box = side.carry_through.half_width * OUTBOARD
    wing = side.wing.span * np.array([np.tan(side.wing.dihedral), 1.0, -np.tan(side.wing.sweep)])
    for turn in (np.eye(3), np.diag([1.0, -1.0, 1.0])):
        for start, axis in ((np.zeros(3), box), (box, wing)):
            length = np.linalg.norm(axis)
            along = turn @ axis / length
            piece = length / 2000
            twist = side.wing.torsional_inertia_per_length * piece * np.outer(along, along)
            parts += [
                (side.wing.mass_per_length * piece, turn @ (start + (k + 0.5) / 2000 * axis), twist)
                for k in range(2000)
            ]
        tip = box + wing
        pylon = side.pylon
        own = np.diag([pylon.nacelle_yaw_inertia, pylon.nacelle_pitch_inertia, pylon.nacelle_roll_inertia])
        parts += [
            (pylon.nacelle_mass, turn @ (tip + pylon.nacelle), own),
            (pylon.hub_mass + ROTOR, turn @ (tip + pylon.hub), 0 * own),
        ]
    return parts


def test_the_rigid_block_has_the_total_mass_centre_and_inertia():
    airframe, parts = model().airframe, rigid_parts()
    mass = sum(part[0] for part in parts)
    centre = sum(part[0] * part[1] for part in parts) / mass
    inertia = sum(part[2] + part[0] * cross(part[1] - centre).T @ cross(part[1] - centre) for part in parts)
    hubs = airframe.hub[:3], airframe.left_hub[:3]
    loaded = airframe.mass + ROTOR / 2 * sum(hub.T @ hub for hub in hubs)
    place = {
        name.partition(" ")[2]: k for k, name in enumerate(airframe.names) if name in airframe.rigid_body
    }
    for name, expected in dict(
        heave=mass, surge=mass, sway=mass, pitch=inertia[1, 1], roll=inertia[2, 2], yaw=inertia[0, 0]
    ).items():
        np.testing.assert_allclose(2 * loaded[place[name], place[name]], expected, rtol=1e-6)
    np.testing.assert_allclose(2 * loaded[place["roll"], place["yaw"]], inertia[0, 2], rtol=1e-4)
    rigid = list(place.values())
    rest = [k for k in range(len(loaded)) if k not in rigid]
    # About the centre of mass translation and rotation do not couple, and no mode moves the whole aircraft.
    for one, other in (("heave", "pitch"), ("surge", "pitch"), ("sway", "roll"), ("sway", "yaw")):
        assert abs(loaded[place[one], place[other]]) < 1e-9 * mass
    scale = np.sqrt(np.diag(loaded))
    assert np.abs((loaded / scale / scale[:, None])[np.ix_(rigid, rest)]).max() < 1e-10
    assert not airframe.stiffness[rigid].any() and not airframe.stiffness[:, rigid].any()
    np.testing.assert_allclose(
        airframe.hub[:, place["roll"]][:3],
        cross(PYLON.hub + WING.tip + 0.7 * OUTBOARD - centre)[:, 2],
        rtol=1e-5,
    )


def test_the_fuselage_is_what_wings_nacelles_and_rotors_leave():
    parts = rigid_parts()
    mass = sum(part[0] for part in parts)
    centre = sum(part[0] * part[1] for part in parts) / mass
    inertia = sum(part[2] + part[0] * cross(part[1] - centre).T @ cross(part[1] - centre) for part in parts)
    whole = Fuselage(
        mass=mass, roll_inertia=inertia[2, 2], pitch_inertia=inertia[1, 1], yaw_inertia=inertia[0, 0],
        product_of_inertia=-inertia[0, 2], centre_forward=centre[2], centre_up=centre[0],
    )  # fmt: skip
    rest = half_aircraft(SIDE).rigid_mass(ROTOR)
    left = whole.without(rest)
    for name in (
        "mass",
        "roll_inertia",
        "pitch_inertia",
        "yaw_inertia",
        "product_of_inertia",
        "centre_forward",
        "centre_up",
    ):
        np.testing.assert_allclose(getattr(left, name), getattr(BODY, name), rtol=1e-4)
    for name in ("mass", "roll_inertia"):
        with pytest.raises(InputError, match=f"{name} = .*must be more than wing, nacelles and rotors have"):
            replace(whole, **{name: 1000.0}).without(rest)


@pytest.mark.parametrize("symmetry", ["symmetric", "antisymmetric"])
def test_a_very_heavy_fuselage_that_holds_the_wing_gives_the_cantilever(symmetry):
    heavy = {
        name: HEAVY * getattr(BODY, name)
        for name in ("mass", "roll_inertia", "pitch_inertia", "yaw_inertia", "product_of_inertia")
    }
    held = WingSide(CarryThrough(half_width=0.7, bending_slope="held", chord_slope="held"), WING, PYLON)
    cantilever = beam_wing(WING, PYLON, modes=5, rotor_mass=ROTOR)
    free = model(held, body=replace(BODY, **heavy), symmetry=symmetry, modes=5)
    np.testing.assert_allclose(free.frequency, np.sqrt(np.diag(cantilever.stiffness)), rtol=1e-6)
    hub = free.airframe.hub[:, 3:]
    sign = np.sign(np.sum(hub * cantilever.hub, axis=0))
    np.testing.assert_allclose(hub * sign, cantilever.hub, atol=1e-6 * np.abs(cantilever.hub).max())
    np.testing.assert_allclose(free.airframe.mass[3:, 3:] * np.outer(sign, sign), cantilever.mass, atol=1e-6)


@pytest.mark.parametrize("joint", ["bending_slope", "chord_slope", "twist"])
def test_a_stiff_joint_is_held_and_a_soft_one_is_free(joint):
    def frequency(value, symmetry):
        side = WingSide(replace(BOX, **{joint: value}), WING, PYLON)
        return model(side, symmetry=symmetry).frequency

    for symmetry in ("symmetric", "antisymmetric"):
        np.testing.assert_allclose(frequency(1e14, symmetry), frequency("held", symmetry), rtol=1e-6)
    np.testing.assert_allclose(
        frequency(1e-2, "antisymmetric"), frequency("free", "antisymmetric"), rtol=1e-6
    )
    assert np.abs(frequency("held", "antisymmetric") / frequency("free", "antisymmetric") - 1).max() > 1e-3


def test_a_wing_that_one_side_alone_keeps_from_turning_is_held_through_the_box():
    """A joint that is free is the limit of a soft spring, and the other side still holds the wing."""
    lost, soft = (WingSide(replace(BOX, twist=twist), WING, PYLON) for twist in ("free", 1e-3))
    np.testing.assert_allclose(model(left=lost).frequency, model(left=soft).frequency, rtol=1e-8)
    with pytest.raises(InputError, match=r"carry_through.twist = free: must be held or a stiffness"):
        model(right=lost, left=lost)


def test_stiff_springs_of_the_pylon_are_rigid():
    stiff = model(WingSide(BOX, WING, replace(PYLON, pitch_stiffness=1e14, yaw_stiffness=1e14))).frequency
    rigid = model(WingSide(BOX, WING, replace(PYLON, pitch_stiffness=None, yaw_stiffness=None))).frequency
    np.testing.assert_allclose(stiff, rigid, rtol=1e-6)


def test_a_soft_spindle_gives_pylon_yaw_alone():
    free = model(WingSide(BOX, WING, replace(PYLON, yaw_stiffness=1e4)))
    place = free.airframe.names.index("symmetric pylon yaw") - 3
    nacelle, arm, masses = PYLON.nacelle_yaw_inertia, PYLON.hub, PYLON.hub_mass + ROTOR
    about = nacelle + PYLON.nacelle_mass * (PYLON.nacelle[1:] ** 2).sum() + masses * (arm[1:] ** 2).sum()
    np.testing.assert_allclose(
        free.frequency[place], np.sqrt(1e4 / about), rtol=0.1
    )  # the wing tip gives way a little


def test_damping_follows_the_kind_of_each_mode():
    ratios = dict(
        zip(("beam", "chord", "torsion", "axial", "pylon yaw"), (0.01, 0.02, 0.03, 0.04, 0.05), strict=True)
    )
    free = model(damping_ratio=ratios)
    elastic_modes = [k for k, name in enumerate(free.airframe.names) if name not in free.airframe.rigid_body]
    kinds = [free.airframe.names[k].partition(" ")[2].partition("_")[0] for k in elastic_modes]
    found = np.diag(free.airframe.damping)[elastic_modes] / (2 * free.frequency)
    np.testing.assert_allclose(found, [ratios[kind] for kind in kinds], rtol=1e-12)
    assert len(set(kinds)) >= 4


# Airloads -----------------------------------------------------------------------------------------

TAIL = Tail(area=4.6, lift_slope=3.9, arm=6.4, height=0.3, wash=0.35)
FINS = Tail(area=4.7, lift_slope=2.9, arm=6.7, height=0.4)
AIR = WingAerodynamics(lift_slope=4.7, chord=1.6, elastic_axis=0.39, sweep=-0.11)


def loaded(**airloads):
    free = model()
    return with_airloads(free.airframe, aircraft_motion(free), **airloads), free


def rigid_block(airframe, *names):
    places = [
        airframe.names.index(next(n for n in airframe.rigid_body if n.endswith(name))) for name in names
    ]
    return np.ix_(places, places)


def centre():
    parts = rigid_parts()
    return sum(part[0] * part[1] for part in parts) / sum(part[0] for part in parts)


def test_a_horizontal_tail_has_the_static_stability_and_the_damping_of_its_closed_form():
    airframe, _ = loaded(horizontal_tail=TAIL)
    forward = centre()[2]
    arm = TAIL.arm + forward  # from the centre of mass
    slope = TAIL.area * TAIL.lift_slope / 4  # of half the tail: ½ ρ V² S a α
    block = rigid_block(airframe, "heave", "pitch")
    expected = slope * (1 - TAIL.wash) * np.array([[0, -1], [0, arm]])
    np.testing.assert_allclose(airframe.airload_stiffness[block], expected, rtol=1e-6)
    heave = (1 - TAIL.wash) * np.array([1, -arm])  # what the tail sees of a steady rise
    turn = np.array([-arm, arm**2]) - TAIL.wash * np.array([-forward, arm * forward])
    np.testing.assert_allclose(airframe.airload_damping[block], slope * np.array([heave, turn]).T, rtol=1e-6)


def test_the_neutral_point_of_wing_and_tail_is_where_the_moment_does_not_depend_on_incidence():
    airframe, _ = loaded(wing=AIR, horizontal_tail=TAIL)
    forward = centre()[2]
    wing_slope = AIR.lift_slope * AIR.chord * (WING.span + 0.7) * np.cos(AIR.sweep) / 2
    box, span = 0.7, WING.span
    ahead = (AIR.elastic_axis - 0.25) * AIR.chord + span**2 / 2 * np.tan(0.11) / (box + span) - forward
    tail_slope = TAIL.area * TAIL.lift_slope * (1 - TAIL.wash) / 4
    lift, moment = airframe.airload_stiffness[rigid_block(airframe, "heave", "pitch")][:, 1]
    np.testing.assert_allclose(-lift, wing_slope + tail_slope, rtol=1e-6)
    np.testing.assert_allclose(moment, tail_slope * (TAIL.arm + forward) - wing_slope * ahead, rtol=1e-5)


def test_fins_turn_the_aircraft_into_the_wind_and_damp_its_turns():
    airframe, _ = loaded(vertical_tail=FINS)
    up, _, forward = centre()
    arm, height, slope = FINS.arm + forward, FINS.height - up, FINS.area * FINS.lift_slope / 4
    moved = np.array([1.0, height, arm])  # to the right per sway, roll and yaw
    block = rigid_block(airframe, "sway", "roll", "yaw")
    np.testing.assert_allclose(airframe.airload_damping[block], slope * np.outer(moved, moved), rtol=1e-6)
    np.testing.assert_allclose(
        airframe.airload_stiffness[block], slope * np.outer(moved, [0, 0, 1.0]), rtol=1e-6, atol=1e-12
    )


def test_the_wing_damps_roll_as_strips_do():
    airframe, _ = loaded(wing=AIR)
    tip = 0.7 + WING.span
    place = airframe.names.index("antisymmetric roll")
    expected = AIR.lift_slope * AIR.chord * np.cos(AIR.sweep) / 2 * tip**3 / 3
    np.testing.assert_allclose(airframe.airload_damping[place, place], expected, rtol=1e-9)


def test_rates_have_exactly_no_stiffness_in_structure_and_air():
    airframe, _ = loaded(wing=AIR, horizontal_tail=TAIL, vertical_tail=FINS)
    at_speed = airframe.at(200.0, 1.2)
    assert {name.partition(" ")[2] for name in airframe.rates} == {"heave", "surge", "sway", "roll"}
    for name in airframe.rates:
        assert not at_speed.stiffness[:, airframe.names.index(name)].any()
    couples = np.array(airframe.symmetry)[:, None] != np.array(airframe.symmetry)
    assert not at_speed.stiffness[couples].any() and not at_speed.damping[couples].any()


def test_airloads_of_two_different_sides_are_the_mean_of_both():
    free = model(SIDE, OTHER)
    airframe = with_airloads(free.airframe, aircraft_motion(free), wing=AIR)
    same = model(SIDE, SIDE)
    symmetric = with_airloads(same.airframe, aircraft_motion(same), wing=AIR)
    # The sides differ in stiffness and mass, not in shape, so as one body both aircraft meet the same air.
    lift = airframe.airload_stiffness[:6, :6], symmetric.airload_stiffness[:6, :6]
    np.testing.assert_allclose(lift[0][0, 2], lift[1][0, 2], rtol=1e-12)
    assert np.abs(airframe.airload_stiffness[:6, 6:]).max() > 0


# What is refused ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (dict(symmetry="odd"), 'symmetry = odd: must be "both" or "symmetric" or "antisymmetric"'),
        (
            dict(left=OTHER, symmetry="symmetric"),
            'symmetry = symmetric: must be "both" for an aircraft whose left side differs',
        ),
        (
            dict(right=WingSide(replace(BOX, twist="free"), WING, PYLON)),
            "carry_through.twist = free: must be held or a stiffness",
        ),
        (dict(modes=99, symmetry="symmetric"), "modes = 99: must be from 1 to"),
        (dict(damping_ratio={"beam": 0.01}), r"damping_ratio\[chord\]: is missing"),
        (dict(damping_ratio=1.5), "damping_ratio = 1.5: must be at least 0 and below 1"),
    ],
)
def test_impossible_aircraft_are_refused(change, message):
    with pytest.raises(InputError, match=message):
        model(**change)


@pytest.mark.parametrize(
    ("record", "change", "message"),
    [
        (BODY, dict(mass=0.0), "mass = 0.0: must be above zero"),
        (BODY, dict(pitch_inertia=-1.0), "pitch_inertia = -1.0: must not be negative"),
        (BODY, dict(product_of_inertia=1e5), "product_of_inertia = 100000.0: must not exceed"),
        (BOX, dict(half_width=0.0), "half_width = 0.0: must be above zero"),
        (BOX, dict(twist="loose"), 'twist = loose: must be "held", "free" or a stiffness'),
        (BOX, dict(chord_slope=0.0), "chord_slope = 0.0: must be above zero"),
        (BOX, dict(elements=0), "elements = 0: must be a whole number from 1 to 200"),
        (BOX, dict(elements=5000), "elements = 5000: must be a whole number from 1 to 200"),
        (PYLON, dict(yaw_stiffness=0.0), "yaw_stiffness = 0.0: must be above zero"),
        (TAIL, dict(area=-1.0), "area = -1.0: must not be negative"),
    ],
)
def test_impossible_parts_are_refused(record, change, message):
    with pytest.raises(InputError, match=message):
        replace(record, **change)
