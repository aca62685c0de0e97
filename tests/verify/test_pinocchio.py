"""Inertial matrices of the rotor against a rigid-body engine: the blade tree of `blade_tree`, in Pinocchio.

Both sides share only a list of point masses, the hinge offsets, the precone and the trim angles. What the
rotor model adds to inertia is known here in closed form: hub springs, which do not turn with pitch, and no
dampers.

An entry is measured against the inertia of its two blocks: |difference| ≤ 1e-10 √(m_a m_b) Ωᵏ, where m_a is
the largest entry of the block (a, a) of the tree's mass matrix, and k = 0, 1, 2 for M, C, K.
"""

from dataclasses import dataclass
from functools import cache
from itertools import product

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation

import proprotor as pp
from tests.verify.blade_tree import (
    HUB_JOINTS,
    PointMassBlade,
    blade_azimuths,
    blade_tree,
    coordinate_names,
    multiblade_matrices,
    steady_loads,
)

pytestmark = pytest.mark.verify

TOLERANCE = 1e-10
BLOCKS = {
    "hub translation": ("x", "y", "z"),
    "hub rotation": ("alpha_x", "alpha_y", "alpha_z"),
    "flap": ("flap_0", "flap_1c", "flap_1s"),
    "lag": ("lag_0", "lag_1c", "lag_1s"),
    "azimuth": ("azimuth",),
    "gimbal": ("gimbal_1c", "gimbal_1s"),
}
BLOCK_OF = {name: block for block, names in BLOCKS.items() for name in names}

# Offsets of the flap and lag hinges as fractions of the radius.
HINGES = {
    "hinges apart": (0.06, 0.17),
    "flap hinge central": (0.0, 0.12),
    "hinges together": (0.08, 0.08),
    "both hinges central": (0.0, 0.0),
}
# In air the blades cone and lag under steady loads; the airloads of the perturbations are left out.
DENSITIES = {"in air": 1.225, "in vacuum": 0.0}


@dataclass(frozen=True)
class SampleRotor:
    """A random rotor of point-mass blades, and the steady state about which it is linearised."""

    blade: PointMassBlade
    n_blades: int
    radius: float
    rotor_speed: float
    density: float
    airspeed: float
    collective: float
    flap_stiffness: float
    lag_stiffness: float

    def linearize(self):
        rotor = pp.Rotor(
            n_blades=self.n_blades,
            radius=self.radius,
            flap_hinge_offset=self.blade.flap_hinge_offset,
            lag_hinge_offset=self.blade.lag_hinge_offset,
            precone=self.blade.precone,
            **self.blade.mass_integrals(),
            flap_stiffness=self.flap_stiffness,
            lag_stiffness=self.lag_stiffness,
            flap_outboard_fraction=0.0,
            lag_outboard_fraction=0.0,
            gimbal_stiffness=0.0,
            pitch_gimbal_coupling=0.0,
            pitch_inertia=0.0,
            control_stiffness=1.0e4,
            flap_damping=0.0,
            lag_damping=0.0,
            pitch_damping=0.0,
            gimbal_damping=0.0,
            structural_pitch_offset=0.0,
            propeller_moment=False,
            chord=0.1 * self.radius,
            twist=-0.6,
            root_cutout=0.2 * self.radius,
            airfoil=pp.Airfoil(lift_slope=5.7, drag=0.01),
        )
        operation = pp.Operation(
            rotor_speed=self.rotor_speed,
            density=self.density,
            speed_of_sound=340.3,
            trim={"collective": self.collective},
        )
        model = pp.rotor_model(rotor, operation, self.airspeed, airloads="none", locked=("pitch",))
        assert np.all(model.trim.converged), model.trim.reason
        return model

    def spring_stiffness(self, dofs):
        """The springs' part of K: a collective row carries N, a cyclic row N/2."""
        hinge = {"flap": self.flap_stiffness, "lag": self.lag_stiffness}
        blades = {"0": self.n_blades, "1c": self.n_blades / 2, "1s": self.n_blades / 2}
        names = (dof.split("_") for dof in dofs)
        return np.diag([hinge.get(name[0], 0.0) * blades.get(name[-1], 0.0) for name in names])


def sample_rotor(n_blades, hinges, atmosphere, seed):
    rng = np.random.default_rng([n_blades, *hinges.encode(), *atmosphere.encode(), seed])
    radius = rng.uniform(2.0, 5.0)
    blade = sample_blade(rng, radius, *HINGES[hinges])
    inertia = blade.mass_integrals()
    rotor_speed = rng.uniform(150.0, 200.0) / radius
    airspeed = rng.uniform(60.0, 130.0)
    inflow_angle = np.arctan2(airspeed, 0.75 * rotor_speed * radius)
    return SampleRotor(
        blade=blade,
        n_blades=n_blades,
        radius=radius,
        rotor_speed=rotor_speed,
        density=DENSITIES[atmosphere],
        airspeed=airspeed,
        collective=inflow_angle + rng.choice([-1, 1]) * rng.uniform(0.03, 0.08),
        flap_stiffness=rng.uniform(0.2, 2.0) * inertia["flap_inertia"] * rotor_speed**2,
        lag_stiffness=rng.uniform(0.4, 3.0) * inertia["lag_inertia"] * rotor_speed**2,
    )


def sample_blade(rng, radius, flap_hinge, lag_hinge):
    """Two point masses on the yoke, two between the hinges and six outboard, where there is room for them."""
    stations = [(0.0, flap_hinge, 2), (flap_hinge, lag_hinge, 2), (lag_hinge, 1.0, 6)]
    fractions = np.concatenate([rng.uniform(start, end, n) for start, end, n in stations if end > start])
    return PointMassBlade(
        radii=radius * fractions,
        masses=rng.uniform(0.05, 0.2, fractions.size) * radius**2,
        flap_hinge_offset=radius * flap_hinge,
        lag_hinge_offset=radius * lag_hinge,
        precone=rng.choice([-1, 1]) * rng.uniform(0.01, 0.1),
    )


SAMPLES = list(product((3, 4, 5), HINGES, DENSITIES, (0, 1)))
every_sample = pytest.mark.parametrize("sample", SAMPLES, ids=lambda sample: ", ".join(map(str, sample)))
one_of_each_size = pytest.mark.parametrize("n_blades", (3, 4, 5))


@cache
def both_sides(sample):
    """The dofs, inertial M, C, K of the rotor model, those of the tree, and the scales of their entries."""
    rotor = sample_rotor(*sample)
    model = rotor.linearize()
    dofs = list(model.dofs)
    ours = [model.M, model.C, model.K - rotor.spring_stiffness(dofs)]
    names, *matrices = tree_matrices(rotor, float(model.trim.coning), float(model.trim.lag))
    kept = [names.index(dof) for dof in dofs]
    theirs = [matrix[np.ix_(kept, kept)] for matrix in matrices]
    return dofs, ours, theirs, entry_scales(theirs[0], dofs, rotor.rotor_speed)


def tree_matrices(rotor, coning, lag, azimuth=0.7, hub_joints=HUB_JOINTS):
    tree = blade_tree(rotor.blade, rotor.n_blades, hub_joints)
    return multiblade_matrices(tree, rotor.n_blades, rotor.rotor_speed, azimuth, coning, lag)


def entry_scales(mass, names, rotor_speed):
    """√(m_a m_b) Ωᵏ for M, C, K; a coordinate outside the blocks is a block of its own."""
    blocks = np.array([BLOCK_OF.get(name, name) for name in names])
    inertia = np.array([np.abs(mass[np.ix_(blocks == block, blocks == block)]).max() for block in blocks])
    scale = np.sqrt(np.outer(inertia, inertia))
    return [scale * rotor_speed**k for k in range(3)]


def disagreements(ours, theirs, scale, dofs, tolerance=TOLERANCE):
    """What differs, worst first: (error by scale, block of row, block of column, row, column)."""
    error = np.abs(ours - theirs) / scale
    entries = [
        (error[a, b], BLOCK_OF.get(dofs[a]), BLOCK_OF.get(dofs[b]), dofs[a], dofs[b])
        for a, b in np.argwhere(~(error <= tolerance))  # so that a nan disagrees too
    ]
    return sorted(entries, key=lambda entry: -entry[0])


@every_sample
def test_inertial_matrices_agree_with_rigid_body_engine(sample):
    dofs, ours, theirs, scales = both_sides(sample)
    assert set(dofs) == set(BLOCK_OF)
    for name, mine, other, scale in zip("MCK", ours, theirs, scales, strict=True):
        wrong = disagreements(mine, other, scale, dofs)
        assert not wrong, f"{name}: {wrong}"


@pytest.mark.parametrize("matrix", range(3), ids=["M", "C", "K"])
def test_comparison_notices_one_entry_of_the_wrong_sign(matrix):
    dofs, ours, theirs, scales = both_sides((3, "hinges apart", "in air", 0))
    mine, other, scale = ours[matrix], theirs[matrix], scales[matrix]
    off_diagonal = ~np.eye(len(dofs), dtype=bool)
    present = np.argwhere(off_diagonal & (np.abs(other) > 1e-8 * scale))
    assert len(present) >= 4
    for a, b in present:
        flipped = mine.copy()
        flipped[a, b] *= -1.0
        assert [entry[-2:] for entry in disagreements(flipped, other, scale, dofs)] == [(dofs[a], dofs[b])]


def test_samples_cover_general_steady_states():
    """Coning and lag take finite values of either sign, so their sines and cosines are put to the test."""
    states = [sample_rotor(*sample).linearize().trim for sample in SAMPLES if "in air" in sample]
    for angles in ([float(state.coning) for state in states], [float(state.lag) for state in states]):
        assert min(angles) < -0.02
        assert max(angles) > 0.02


@pytest.mark.parametrize("sample", [sample for sample in SAMPLES if "in vacuum" in sample], ids=str)
def test_vacuum_trim_balances_springs_and_centrifugal_forces(sample):
    rotor = sample_rotor(*sample)
    trim = rotor.linearize().trim
    coning, lag = float(trim.coning), float(trim.lag)
    tree = blade_tree(rotor.blade, rotor.n_blades)
    loads = steady_loads(tree, rotor.rotor_speed, 0.0, coning, lag)
    inertia = rotor.blade.mass_integrals()
    flap_scale = inertia["flap_inertia"] * rotor.rotor_speed**2
    lag_scale = inertia["lag_inertia"] * rotor.rotor_speed**2
    assert abs(loads["flap[0]"] + rotor.flap_stiffness * coning) < TOLERANCE * flap_scale
    assert abs(loads["lag[0]"] + rotor.lag_stiffness * lag) < TOLERANCE * lag_scale
    assert coning * rotor.blade.precone < 0.0  # centrifugal forces flatten the cone


# The tree by itself: that it is the rotor it claims to be, whatever the engine then does with it.


@one_of_each_size
def test_tree_puts_each_mass_where_the_position_formula_does(n_blades):
    rng = np.random.default_rng(n_blades)
    blade = sample_rotor(n_blades, "hinges apart", "in air", 0).blade
    tree = blade_tree(blade, n_blades)
    state = dict(zip(coordinate_names(tree), rng.uniform(-0.5, 0.5, tree.nq), strict=True))
    data = tree.createData()
    pin.framesForwardKinematics(tree, data, np.array(list(state.values())))
    for number, point in product(range(n_blades), range(blade.radii.size)):
        placed = data.oMf[tree.getFrameId(f"mass[{number}, {point}]")].translation
        stated = position(blade, n_blades, number, blade.radii[point], state)
        assert np.allclose(placed, stated, rtol=0, atol=1e-13)


def position(blade, n_blades, number, r, state):
    """hub + R_h R_y {(r − ρβ) d1 + ρβ d2 + ρζ [(cos ζ − 1) d2 + sin ζ i]}, the tilts one after another."""
    psi = state["azimuth"] + blade_azimuths(n_blades)[number]
    flap, lag = state[f"flap[{number}]"], state[f"lag[{number}]"]
    i, j, k = np.array([[np.sin(psi), -np.cos(psi), 0], [np.cos(psi), np.sin(psi), 0], [0, 0, 1]])
    d1 = np.cos(blade.precone) * j + np.sin(blade.precone) * k
    d2 = np.cos(blade.precone + flap) * j + np.sin(blade.precone + flap) * k
    flap_arm, lag_arm = max(r - blade.flap_hinge_offset, 0.0), max(r - blade.lag_hinge_offset, 0.0)
    hub_turn = Rotation.from_euler("XYZ", [state["alpha_x"], state["alpha_y"], state["alpha_z"]])
    yoke_tilt = Rotation.from_euler("XY", [state["gimbal_1s"], -state["gimbal_1c"]])
    arm = (r - flap_arm) * d1 + flap_arm * d2 + lag_arm * ((np.cos(lag) - 1) * d2 + np.sin(lag) * i)
    return np.array([state["x"], state["y"], state["z"]]) + (hub_turn * yoke_tilt).apply(arm)


@one_of_each_size
def test_multiblade_matrices_do_not_depend_on_azimuth(n_blades):
    """Reactionless ones included."""
    rotor = sample_rotor(n_blades, "hinges apart", "in air", 0)
    names, *first = tree_matrices(rotor, 0.05, -0.08, azimuth=0.0)
    for azimuth in (0.4, 1.9, 5.0):
        assert_same_matrices(names, first, tree_matrices(rotor, 0.05, -0.08, azimuth)[1:], rotor)


@one_of_each_size
def test_order_of_successive_tilts_does_not_matter(n_blades):
    """Steady rotation has no moment at the hub, hence no second-order difference between tilts."""
    rotor = sample_rotor(n_blades, "hinges apart", "in air", 0)
    order = ("z", "y", "x", "alpha_z", "alpha_y", "alpha_x", "gimbal_1c", "gimbal_1s", "azimuth")
    reordered = {name: HUB_JOINTS[name] for name in order}
    names, *one = tree_matrices(rotor, 0.05, -0.08)
    _, *other = tree_matrices(rotor, 0.05, -0.08, hub_joints=reordered)
    assert_same_matrices(names, one, other, rotor)
    loads = steady_loads(blade_tree(rotor.blade, n_blades), rotor.rotor_speed, 0.7, 0.05, -0.08)
    flap_moment = abs(loads["flap[0]"])
    assert all(abs(loads[name]) < 1e-12 * flap_moment for name in HUB_JOINTS if name not in "xyz")


@pytest.mark.parametrize("n_blades", (4, 5))
def test_reactionless_modes_decouple(n_blades):
    rotor = sample_rotor(n_blades, "hinges apart", "in air", 0)
    names, *matrices = tree_matrices(rotor, 0.05, -0.08)
    reactionless = np.array([name not in BLOCK_OF for name in names])
    assert reactionless.sum() == 2 * (n_blades - 3)
    for matrix, scale in zip(matrices, entry_scales(matrices[0], names, rotor.rotor_speed), strict=True):
        coupling = np.abs(matrix) / scale
        assert coupling[np.ix_(reactionless, ~reactionless)].max() < 1e-13
        assert coupling[np.ix_(~reactionless, reactionless)].max() < 1e-13


def assert_same_matrices(names, first, second, rotor):
    scales = entry_scales(first[0], names, rotor.rotor_speed)
    for one, other, scale in zip(first, second, scales, strict=True):
        assert not disagreements(one, other, scale, names, tolerance=1e-13)
