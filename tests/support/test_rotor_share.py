"""What a support's masses hold of the rotor: its share by lumped masses, and refusal of what leaves no mass.

The lumped rotor is points of mass on coned blades. What is free to follow the hub takes the motion of least energy,
found by least squares: no mass integral, no multiblade sum and no Schur complement as in the package.
"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh

import proprotor as pp
from proprotor.errors import InputError
from proprotor.model.mass_at_rest import mass_at_rest
from proprotor.model.rigid_propeller import WhirlDerivatives, rigid_propeller
from proprotor.model.rotor_model import rotor_model
from proprotor.model.rotor_share import rotor_share, spring_warnings, without_rotors
from proprotor.model.several_rotors import MountedRotor, mount_rotors
from proprotor.rotor.motions import HUB
from proprotor.support.matrix_files import support_from_matrices
from proprotor.support.normal_modes import INCLUDES_ROTOR, SHAFT
from tests.support.test_beam_wing import xv15_wing
from tests.support.test_nastran import to_aircraft, write_op2

ROUNDING = 1e-11  # of the largest entry, with products of some hundred terms
SLUG, FT, LB = 14.593902937, 0.3048, 0.45359237
REFUSED = r"support\.includes_rotor = .*: leaves no mass: in .* the share of the rotor, {}, is .* the whole mass given"
REFUSED += (
    r"\. Check how the rotor was held \(false .*\) and the units \(lb for slug, length_unit, mass_unit\)"
)


@pytest.fixture(scope="module")
def xv15():
    return pp.load_case("xv15-uncoupled")


# The share --------------------------------------------------------------------------------------------------------


class Lumped:
    """Blades of point masses, and what the package's rotor needs to know of them."""

    def __init__(self, seed):
        rng = np.random.default_rng(seed)
        self.blades, self.precone = int(rng.integers(3, 7)), rng.uniform(-0.1, 0.1)
        self.r, self.m = np.sort(rng.uniform(0.05, 4.0, 12)), rng.uniform(0.5, 5.0, 12)
        self.flap, self.lag = 0.1, 0.3
        self.pitch_inertia, self.coupling = rng.uniform(0.0, 0.8), rng.uniform(-0.5, 0.5)

    @property
    def rotor(self):
        def moment(offset, power):
            return float(np.sum(self.m * np.maximum(self.r - offset, 0.0) ** power))

        return pp.Rotor(
            n_blades=self.blades,
            radius=4.0,
            precone=self.precone,
            flap_hinge_offset=self.flap,
            lag_hinge_offset=self.lag,
            blade_mass=moment(0.0, 0),
            blade_first_moment=moment(0.0, 1),
            blade_inertia=moment(0.0, 2),
            flap_first_moment=moment(self.flap, 1),
            flap_inertia=moment(self.flap, 2),
            lag_first_moment=moment(self.lag, 1),
            lag_inertia=moment(self.lag, 2),
            flap_stiffness=1e4,
            lag_stiffness=1e5,
            pitch_inertia=self.pitch_inertia,
            pitch_gimbal_coupling=self.coupling,
            chord=0.4,
            airfoil=pp.Airfoil(lift_slope=5.7),
        )

    def share(self, held, shaft):
        """Mass matrix (6, 6) on the hub's motions: of each, and of what is free, the velocity of every mass."""
        if held == "mass only":
            return self.blades * self.m.sum() * np.diag([1.0] * 3 + [0.0] * 3)
        rows, weights = [], []
        turns = np.eye(3)
        for azimuth in 2 * np.pi * np.arange(self.blades) / self.blades:
            radial = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
            line = np.cos(self.precone) * radial + np.sin(self.precone) * turns[2]
            for r, m in zip(self.r, self.m, strict=True):
                swing = np.cross(turns, r * line).T  # columns: velocity per turn about x, y, z
                rows.append(np.hstack([np.eye(3), swing, swing]))  # hub, its turns, gimbal x and y and shaft
                weights += [m] * 3
            # A gimbal that tilts the blade up against the swashplate turns its pitch, in which the hub has no part.
            flapped = np.cross(radial, turns[2])
            rows.append(self.coupling * np.hstack([np.zeros(6), flapped])[None])
            weights.append(self.pitch_inertia)
        motion = np.sqrt(weights)[:, None] * np.vstack(rows)
        free = [6, 7] * (held == "gimballed") + [8] * (shaft == "free")
        hub = motion[:, :6]
        following = np.linalg.lstsq(motion[:, free], hub, rcond=None)[0] if free else np.zeros((0, 6))
        rest = hub - motion[:, free] @ following
        return rest.T @ rest


@pytest.mark.parametrize("shaft", SHAFT)
@pytest.mark.parametrize("held", ["gimballed", "rigid", "mass only"])
def test_the_share_is_that_of_lumped_masses(held, shaft):
    for seed in range(20):
        lumped = Lumped(seed)
        expected, found = lumped.share(held, shaft), rotor_share(mass_at_rest(lumped.rotor), held, shaft)
        np.testing.assert_allclose(found, expected, rtol=0, atol=ROUNDING * np.abs(expected).max())


def test_a_free_shaft_is_the_azimuth_of_the_model(xv15):
    """What is left of the rotor's matrix without its azimuth, and without gimbal and azimuth."""
    still = {"airloads": "none", "pitch": "rigid", "locked": ("flap", "lag")}
    rotor = replace(xv15.rotor, pitch_inertia=0.0)
    model = rotor_model(
        rotor, replace(xv15.operation, density=0.0, rotor_speed=1e-6, trim={"collective": 0.0}), 1e-9, **still
    )
    for held, free in (("rigid", ["azimuth"]), ("gimballed", ["azimuth", "gimbal_1c", "gimbal_1s"])):
        compliance = np.linalg.pinv(model.submodel(tuple(free)).M)
        coupling = model.submodel((*HUB, *free)).M[6:, :6]
        expected = model.submodel(HUB).M - coupling.T @ compliance @ coupling
        found = rotor_share(mass_at_rest(rotor), held, "free")
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * np.abs(expected).max())


def test_the_share_follows_many_designs(xv15):
    masses, cones = np.array([50.0, 60.0, 70.0])[:, None], np.array([0.0, 0.05])
    many = mass_at_rest(replace(xv15.rotor, blade_mass=masses, precone=cones))
    for place in np.ndindex(3, 2):
        one = mass_at_rest(replace(xv15.rotor, blade_mass=masses[place[0], 0], precone=cones[place[1]]))
        for held in ("gimballed", "rigid", "mass only"):
            np.testing.assert_allclose(
                np.broadcast_to(rotor_share(many, held, "free"), (3, 2, 6, 6))[place],
                rotor_share(one, held, "free"),
                rtol=0,
                atol=1e-10,
            )


def test_a_propeller_is_rigid_and_has_no_gimbal():
    none = WhirlDerivatives(0.0, 0.0, 0.0, 0.0, 0.0)
    given = {"radius": 2.0, "rotor_speed": 30.0, "density": 1.0}
    alone = rigid_propeller(50.0, none, **given, mass=40.0, polar_inertia=60.0, diametral_inertia=30.0)
    expected = {
        (True, "held"): [40, 40, 40, 30, 30, 60],
        ("rigid", "held"): [40, 40, 40, 30, 30, 60],
        ("rigid", "free"): [40, 40, 40, 30, 30, 0],
        ("mass only", "held"): [40, 40, 40, 0, 0, 0],
        (False, "held"): [0] * 6,
    }
    for (held, shaft), share in expected.items():
        whole = np.diag([100.0] * 6)
        support = pp.NormalModes(HUB, whole, 0 * whole, whole, np.eye(6), held, shaft)
        mounted = pp.mount(alone, support)
        np.testing.assert_allclose(mounted.M, whole - np.diag(share) + alone.M, rtol=1e-14)
    with pytest.raises(InputError, match="includes_rotor = gimballed: needs a rotor with a gimbal"):
        pp.mount(alone, replace(support, includes_rotor="gimballed"))
    massless = replace(alone, mass_at_rest=np.zeros((6, 6)))
    np.testing.assert_array_equal(rotor_share(massless.mass_at_rest, "rigid", "free"), np.zeros((6, 6)))


# Modes given with the rotor on --------------------------------------------------------------------------------------


def at_rest(case, **options):
    """Frequencies per revolution of 458 rpm, and shapes, in a vacuum with the blades locked and hardly any speed."""
    operation = replace(case.operation, rotor_speed=1e-6, density=0.0, trim={"collective": 0.0})
    locked = {"locked": ("flap", "lag"), "pitch": "rigid", "airloads": "none"} | options
    model = replace(case, operation=operation).linearize(1e-9, **locked)
    values, shapes = eigh(model.K, model.M)
    return np.sqrt(np.maximum(values, 0)) / (458 * np.pi / 30), shapes, model.dofs


def test_torsion_given_with_the_rotor_on_comes_out_as_given(xv15):
    """1.30 per rev, today 1.433: at rest with the gimbal free the modes are those given, all three of them."""
    free = replace(xv15, rotor=replace(xv15.rotor, gimbal_stiffness=0.0))
    per_rev, _, _ = at_rest(free, rotor_speed="constant")
    np.testing.assert_allclose(per_rev[2:], [0.42, 0.70, 1.30], rtol=1e-9)
    sprung, _, _ = at_rest(xv15, rotor_speed="constant")
    assert sprung[-1] == pytest.approx(1.3024, abs=5e-5)


@pytest.mark.parametrize("shaft", SHAFT)
@pytest.mark.parametrize("held", ["gimballed", "rigid"])
def test_modes_come_out_as_given_when_the_rotor_is_held_as_it_was(xv15, held, shaft):
    case = pp.load_case(
        "xv15-uncoupled",
        {"support.includes_rotor": held, "support.shaft": shaft, "rotor.gimbal_stiffness": "0 N*m/rad"},
    )
    locked = ("flap", "lag") + ("gimbal",) * (held == "rigid")
    per_rev, _, _ = at_rest(case, locked=locked, rotor_speed="constant" if shaft == "held" else "windmilling")
    np.testing.assert_allclose(per_rev[-3:], [0.42, 0.70, 1.30], rtol=1e-9)


def test_a_hub_spring_is_told_where_it_moves_a_mode(xv15):
    (told,) = [warning for warning in xv15.warnings if "hub spring" in warning]
    assert told.startswith(
        "At rest the hub spring moves torsion at 9.923 Hz by +0.19 % from the frequency given"
    )
    soft = pp.load_case("xv15-uncoupled", {"rotor.gimbal_stiffness": "1000 in*lbf/deg"})  # 0.7 per mille
    rigid = pp.load_case("xv15-uncoupled", {"support.includes_rotor": "rigid"})
    assert not any("hub spring" in warning for case in (soft, rigid) for warning in case.warnings)


@pytest.mark.parametrize("times", [1e-3, 0.5, 3.0, 30.0, 1e4])
def test_what_a_hub_spring_does_is_what_the_model_has_at_rest(xv15, times):
    """One mode, from a soft hub to one that all but holds the rotor, against the eigenvalues of the whole model."""
    alone = pp.NormalModes(
        ("torsion",), [[1356.0]], [[0.0]], [[1356.0 * 62.35**2]], xv15.support.hub[:, 2:], "gimballed"
    )
    rotor = replace(xv15.rotor, gimbal_stiffness=times * 1e5)
    per_rev, shapes, _ = at_rest(replace(xv15, rotor=rotor, support=alone), rotor_speed="constant")
    mode = int(np.argmax(np.abs(shapes[0]) * np.sqrt(1356.0)))
    change = 100 * (per_rev[mode] * 458 * np.pi / 30 / 62.35 - 1)
    told = " ".join(spring_warnings(alone, mass_at_rest(rotor), rotor.gimbal_stiffness))
    assert (f"torsion at 9.923 Hz by {change:+.2g} %" in told) == (abs(change) > 0.1)
    assert bool(told) == (abs(change) > 0.1)


def test_the_result_says_how_the_rotor_was_held(xv15):
    assert "found with the rotor on, gimballed, shaft held" in repr(xv15)
    assert (xv15.sources["support.includes_rotor"].si, xv15.sources["support.shaft"].si) == (
        "gimballed",
        "held",
    )
    plain = pp.load_case("xv15-uncoupled", {"support.includes_rotor": "true"})
    assert plain.support.includes_rotor == plain.sources["support.includes_rotor"].si == "gimballed"
    assert plain.sources["support.includes_rotor"].source.endswith(
        'true: taken as "gimballed", for there is a gimbal'
    )
    np.testing.assert_array_equal(plain.linearize(100.0).M, xv15.linearize(100.0).M)
    without = pp.load_case("xv15-uncoupled", {"support.includes_rotor": "false"})
    assert without.support.includes_rotor is False and "rotor on" not in repr(without)


def test_no_option_of_an_analysis_changes_the_share(xv15):
    def own(**options):
        model = xv15.linearize(120.0, **options)
        hub = xv15.support.hub
        return model.M[:3, :3] - hub.T @ model.rotor.M[:6, :6] @ hub

    usual = own()
    for options in (
        {"locked": ("gimbal",)},
        {"locked": ("flap", "lag", "gimbal")},
        {"rotor_speed": "constant"},
        {"pitch": "rigid"},
        {"equations": "published"},
        {"airloads": "none"},
    ):
        np.testing.assert_allclose(own(**options), usual, rtol=0, atol=1e-10 * usual.max())


def test_parts_of_a_model_add_up_to_it(xv15):
    from proprotor.stability.origins import model_parts

    for held in INCLUDES_ROTOR:
        case = replace(xv15, support=replace(xv15.support, includes_rotor=held))
        model = case.linearize(120.0)
        whole = sum(part.M for part in model_parts(case, model).values())
        np.testing.assert_allclose(whole, model.M, rtol=0, atol=1e-10 * np.abs(model.M).max())


# What leaves no mass ------------------------------------------------------------------------------------------------

LIGHT = {
    "normal-modes": """
        [[support.modes]]
        name = "beam"
        coordinate = "length"
        generalized_mass = "59 lb"
        frequency = "3.2 Hz"
        damping_ratio = "1 %"
        x = 1
    """,
    "pivot": """
        distance = "1.2 m"
        pitch_inertia = "100 kg*m**2"
        yaw_inertia = "1000 kg*m**2"
        pitch_stiffness = "2e6 N*m/rad"
        yaw_stiffness = "2e6 N*m/rad"
    """,
    "matrices": 'file = "light.npz"\n',
    "nastran": 'file = "light.op2"\ngrid = 1101\n',
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Files of a structure lighter than the rotor: in units that the deck does not tell."""
    place = tmp_path_factory.mktemp("light")
    names = np.array([f"hub_{axis}" for axis in HUB])
    light = np.diag([50.0, 50.0, 50.0, 5.0, 5.0, 5.0])
    np.savez(place / "light.npz", mass=light, stiffness=1e4 * light, dofs=names)
    frequency = 2 * np.pi * np.array([3.2, 5.3, 9.9])
    write_op2(place / "light.op2", frequency, np.ones(3), to_aircraft(np.eye(6)[:, [0, 2, 4]]))
    return place


def light_deck(folder, kind, held):
    text = f'base = "xv15-uncoupled"\n[case]\nname = "light"\ntitle = "light"\n[support]\nkind = "{kind}"\n'
    word = str(held).lower() if isinstance(held, bool) else f'"{held}"'
    path = folder / f"{kind}-{word.strip(chr(34)).replace(' ', '-')}.toml"
    path.write_text(f"{text}includes_rotor = {word}\n{LIGHT[kind]}", encoding="utf-8")
    return path


@pytest.mark.parametrize("held", [held for held in INCLUDES_ROTOR if held])
@pytest.mark.parametrize("kind", LIGHT)
def test_a_support_lighter_than_its_rotor_is_refused(folder, kind, held):
    path = light_deck(folder, kind, held)
    with pytest.raises(InputError, match=REFUSED.format("gimballed" if held is True else held)):
        pp.load_case(path)


@pytest.mark.parametrize("kind", LIGHT)
def test_the_same_without_a_rotor_is_none_of_its_business(folder, kind):
    assert not pp.load_case(light_deck(folder, kind, False)).support.includes_rotor


def test_a_motion_of_several_coordinates_is_found():
    """Each coordinate alone has more mass than the rotor; together they have less."""
    hub = np.zeros((6, 2))
    hub[0] = 1.0
    alone = pp.LinearModel(
        *3 * [np.eye(6)],
        dofs=HUB,
        trim=None,
        airspeed=np.zeros(()),
        mass_at_rest=np.diag([40.0] * 3 + [1.0] * 3),
    )
    for coupling, refused in ((0.0, False), (-30.0, True)):
        mass = np.array([[90.0, coupling], [coupling, 90.0]])
        support = pp.NormalModes(("a", "b"), mass, 0 * mass, mass, hub, True)
        left, refusal = without_rotors(support, [(hub, alone.mass_at_rest)])
        assert (refusal is not None) == refused == bool(np.linalg.eigvalsh(left)[0] < 0)


def test_all_of_the_mass_may_be_the_rotors(xv15):
    """Nothing left but rounding is no negative mass, whatever the units of the coordinates."""
    share = rotor_share(mass_at_rest(xv15.rotor), "rigid")
    for scale in (1e-6, 1.0, 1e6):
        hub = scale * np.eye(6)
        mass = hub.T @ share @ hub
        support = pp.NormalModes(HUB, mass, 0 * mass, mass, hub, "rigid")
        _, refusal = without_rotors(support, [(hub, mass_at_rest(xv15.rotor))])
        assert refusal is None
        less = replace(support, mass=mass * (1 - 1e-6))
        assert without_rotors(less, [(hub, mass_at_rest(xv15.rotor))])[1][()] != ""


LIGHT_TORSION = "support.modes[torsion].generalized_mass"


def test_one_design_is_refused_before_anything_is_computed(xv15):
    with pytest.raises(InputError, match=rf"{REFUSED.format('gimballed')}"):
        xv15.vary({LIGHT_TORSION: 200.0})
    with pytest.raises(InputError, match=r"leaves no mass: in beam .*, gimballed, is 14\.7 times"):
        slips = {f"support.modes[{mode}].generalized_mass": "59 lb" for mode in ("beam", "chord")}
        pp.load_case("xv15-uncoupled", slips | {LIGHT_TORSION: "1000 lb*ft**2"})
    with pytest.raises(InputError, match="leaves no mass"):  # heavier blades on the same modes
        xv15.vary({"rotor.blade_mass": 700.0})


def test_of_many_designs_the_refused_one_fails_alone(xv15):
    masses = np.array([1356.0, 200.0, 1300.0])
    many = xv15.vary({LIGHT_TORSION: masses[:, None]})
    model = many.linearize(np.array([100.0, 140.0]))
    assert model.trim.converged.tolist() == [[True, True], [False, False], [True, True]]
    for reason in model.trim.reason[1]:
        assert reason.startswith(
            "support.includes_rotor = gimballed: leaves no mass: in torsion the share of the rotor, gimballed"
        )
    for place in (0, 2):
        one = xv15.vary({LIGHT_TORSION: masses[place]}).linearize(np.array([100.0, 140.0]))
        np.testing.assert_array_equal(model.M[place], one.M)
        assert (model.trim.reason[place] == "").all()
    modes = model.modes()
    assert np.isnan(modes.eigenvalue.values[1]).all() and np.isfinite(modes.eigenvalue.values[[0, 2]]).all()


def test_a_study_tells_the_refused_design(xv15):
    found = pp.study(
        xv15, {LIGHT_TORSION: [1356.0, 200.0, 1300.0]}, airspeed=[100.0, 140.0], quantities=("least_stable",)
    )
    reasons = found.reason.values.reshape(3, 2)
    assert (reasons[[0, 2]] == "").all()
    assert all("leaves no mass: in torsion" in reason for reason in reasons[1])
    assert np.isnan(found.damping_ratio.values.reshape(3, 2)[1]).all()


def test_a_sweep_along_the_mass_tells_where_it_ends(xv15):
    found = xv15.sweep(100.0, vary={LIGHT_TORSION: np.linspace(150.0, 1400.0, 6)})
    reasons = found.reason.values
    assert "leaves no mass" in reasons[0] and (reasons[1:] == "").all()


def test_mounting_by_hand_is_refused_alike(xv15):
    rotor = rotor_model(xv15.rotor, xv15.operation, 100.0, rotor_speed="constant")
    light = replace(xv15.support, mass=0.1 * xv15.support.mass)
    with pytest.raises(InputError, match=r"^support\.includes_rotor = gimballed: leaves no mass"):
        pp.mount(rotor, light)
    with pytest.raises(InputError, match=r"^support\.includes_rotor = gimballed: leaves no mass"):
        mount_rotors({"a": MountedRotor(rotor, light.hub)}, light)
    both = replace(xv15.support, mass=0.6 * xv15.support.mass)  # enough for one rotor, not for two
    mount_rotors({"a": MountedRotor(rotor, both.hub)}, both)
    with pytest.raises(InputError, match=r"^support\.includes_rotor = gimballed: leaves no mass"):
        mount_rotors({name: MountedRotor(rotor, both.hub) for name in "ab"}, both)


def test_what_is_left_of_a_finite_element_wing_is_the_wing(tmp_path):
    """A point mass at the hub's grid point, on all coordinates: taken off, the wing is the one without."""
    from proprotor.support.beam_wing import beam_structure

    wing, pylon, _ = xv15_wing()
    structure = beam_structure(wing, pylon)
    case = pp.load_case("xv15-uncoupled")
    weight = float(case.rotor.n_blades * case.rotor.blade_mass)
    loaded = structure.mass + weight * structure.hub.T @ np.diag([1.0] * 3 + [0.0] * 3) @ structure.hub
    support = pp.NormalModes(
        structure.names, loaded, 0 * loaded, structure.stiffness, structure.hub, "mass only"
    )
    left, refusal = without_rotors(support, [(support.hub, mass_at_rest(case.rotor))])
    assert refusal is None
    np.testing.assert_allclose(left, structure.mass, rtol=0, atol=1e-12 * np.abs(loaded).max())


def test_a_rotor_is_not_on_twice():
    """A rotor's mass for the modes, beside a matrix that has the rotor already, was passed over without a word."""
    matrix = np.diag([900.0] * 3 + [400.0] * 3)
    message = r"rotor_mass = 180\.0: must not be given where the mass includes the rotor"
    dofs = [f"hub_{axis}" for axis in HUB]
    for held in (held for held in INCLUDES_ROTOR if held):
        with pytest.raises(InputError, match=message):
            support_from_matrices(matrix, 1e4 * matrix, dofs=dofs, includes_rotor=held, rotor_mass=180.0)
        support_from_matrices(matrix, 1e4 * matrix, dofs=dofs, includes_rotor=held, rotor_mass=0.0)


def test_unknown_words_are_refused(xv15):
    for settings, message in (
        (
            {"support.includes_rotor": "gimbaled"},
            'must be "gimballed" or "rigid" or "mass only" or true or false',
        ),
        ({"support.includes_rotor": "1"}, 'must be "gimballed" or "rigid" or "mass only" or true or false'),
        ({"support.shaft": "locked"}, 'must be "held" or "free"'),
    ):
        with pytest.raises(InputError, match=message):
            pp.load_case("xv15-uncoupled", settings)
    with pytest.raises(InputError, match='includes_rotor = 1: must be "gimballed"'):
        replace(xv15.support, includes_rotor=1)
    with pytest.raises(InputError, match='shaft = loose: must be "held" or "free"'):
        replace(xv15.support, shaft="loose")
    with pytest.raises(InputError, match=r"mass_at_rest = .*: must be \(\.\.\., 6, 6\) or \(\.\.\., 8, 8\)"):
        rotor_share(np.eye(7), "rigid")
