"""What must hold for every rotor, whoever derived its equations: conservation, symmetry, and air that stands still.

Tolerance: 1e-12 of the largest entry of the block that is compared. A block that ought to vanish has no entry to go by
and is held to 1e-14 of what inertia at 1/rev would put there, Ω^k √(M_ii M_jj) for M, C, K with k = 0, 1, 2.
"""

import inspect
from dataclasses import fields, replace

import numpy as np
import proprotor_equations as equations
import pytest
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st

import proprotor as pp
from proprotor.rotor.generated import evaluate
from tests.rotors import HUB, Flight, between, flights, random_support, seeds

# A rotor that fails is shown as it was drawn: to shrink one takes minutes.
any_rotor = settings(max_examples=50, derandomize=True, deadline=None, phases=[Phase.generate])

DOFS = equations.FIXED_COORDINATES
BLOCKS = (HUB[:3], HUB[3:], DOFS[6:9], DOFS[9:12], DOFS[12:15], ("azimuth",), ("gimbal_1c", "gimbal_1s"))
OPTIONS = st.fixed_dictionaries(
    {},
    optional={
        "pitch": st.sampled_from(["dynamic", "coupling", "rigid"]),
        "compressibility": st.booleans(),
        "section_damping": st.booleans(),
        "rotor_speed": st.sampled_from(["windmilling", "constant"]),
        "locked": st.lists(st.sampled_from(["flap", "lag", "pitch", "gimbal"]), unique=True),
    },
)


# Models and comparisons ---------------------------------------------------------------------------


def trimmed(flight, **options):
    model = flight.model(**options)
    assume(model.trim.converged)
    return model


def undamped(flight, **options):
    """Bent by the airloads of its trim, but none when it moves, and no dampers."""
    return trimmed(flight.without_dampers(), airloads="none", **options)


def by_block(dofs):
    """Places of the coordinates of each block."""
    found = ([dofs.index(name) for name in block if name in dofs] for block in BLOCKS)
    return [places for places in found if places]


def assert_equal(actual, expected, dofs, scale, columns=None, away=0.0):
    """Entry by entry to 1e-12 of the larger block, or 1e-14 of its inertial scale; and `away` from each other."""
    for rows in by_block(dofs):
        for places in columns or by_block(dofs):
            block = np.ix_(rows, places)
            largest = max(np.abs(actual[block]).max(), np.abs(expected[block]).max())
            error, allowed = np.abs(actual[block] - expected[block]).max(), 1e-12 * largest
            assert error <= allowed + 1e-14 * scale[block].max() + away, (
                f"{dofs[rows[0]]} by {dofs[places[0]]}"
            )


class Matrices:
    """M, C and K of a model, with the inertial scale of their blocks."""

    def __init__(self, model, rotor_speed):
        self.dofs = model.dofs
        self.matrix = {name: getattr(model, name) for name in "MCK"}
        root = np.sqrt(np.diag(model.M))
        for places in by_block(model.dofs):
            root[places] = root[places].max()
        self.scale = {name: np.outer(root, root) * rotor_speed**k for k, name in enumerate("MCK")}

    def assert_equal(self, name, actual, expected):
        assert_equal(actual, expected, self.dofs, self.scale[name])

    def rows(self, **loads):
        """A column with the given entries."""
        return np.array([loads.get(name, 0.0) for name in self.dofs])

    def along(self, name, **motion):
        """A matrix times a motion such as ``alpha_x=1, gimbal_1s=-1``; coordinates that are absent stay at rest."""
        return self.matrix[name] @ self.rows(**motion)

    def assert_loads_equal(self, name, actual, expected, *moved, by_trim=False):
        """Two columns of loads that motions along some coordinates cause.

        `by_trim` says that numbers of the trim are compared with the matrices: these are of the trim before its last
        step, of up to 1e-13 rad, by which an entry changes as much as the largest does.
        """
        scale = self.scale[name][:, [self.dofs.index(dof) for dof in moved]].max(axis=1)
        away = 1e-13 * np.abs(self.matrix[name]).max() if by_trim else 0.0
        assert_equal(actual[:, None], expected[:, None], self.dofs, scale[:, None], columns=[[0]], away=away)

    def assert_cancel(self, name, by_trim=False, **motion):
        """Coordinates that move together cause no load, although each alone may."""
        (first, amount), *others = motion.items()
        alone, rest = self.along(name, **{first: amount}), self.along(name, **dict(others))
        self.assert_loads_equal(name, alone, -rest, *motion, by_trim=by_trim)


# Without airloads and dampers ---------------------------------------------------------------------


@any_rotor
@given(flights())
def test_mass_and_stiffness_are_symmetric_and_gyroscopic_terms_skew(flight):
    matrices = Matrices(undamped(flight), flight.rotor_speed)
    for name, sign in (("M", 1), ("C", -1), ("K", 1)):
        matrices.assert_equal(name, matrices.matrix[name], sign * matrices.matrix[name].T)


def unit_diagonal(matrix):
    """The matrix in other units of its coordinates: eigenvalues keep their signs."""
    root = np.sqrt(np.diag(matrix))
    return matrix / np.outer(root, root)


def least(matrix):
    return np.linalg.eigvalsh(unit_diagonal(matrix)).min()


@any_rotor
@given(flights())
def test_mass_is_nowhere_negative(flight):
    assert least(undamped(flight).M) > -1e-12


@any_rotor
@given(flights(hinges="off centre"), seeds)
def test_mass_is_positive_once_the_hub_carries_inertia(flight, seed):
    """With the hinges off the centre of rotation; the next test has them on it."""
    model = flight.on(random_support(flight, seed), airloads="none")
    assume(model.trim.converged)
    assert least(model.M) > 1e-12


ON_AXIS = {"offset_mass": None}
NO_MASSES = dict.fromkeys((entry.name for entry in fields(pp.OffsetMass)), 0.0)
UNLINKED = dict.fromkeys(("kinematic_pitch_flap_coupling", "kinematic_pitch_lag_coupling"), 0.0)


def lumped_inertia(rotor):
    """Pitch inertia that no mass beside the axis has."""
    return rotor.pitch_inertia - (0.0 if rotor.offset_mass is None else rotor.offset_mass.inertia)


@pytest.mark.parametrize(
    "beside_axis", [False, True], ids=["masses on the axis", "no inertia but of masses beside it"]
)
@any_rotor
@given(flight=flights(hinges="at centre"))
def test_blades_hinged_at_the_centre_move_as_yoke_and_shaft_move_them(beside_axis, flight):
    """Flap and lag can then undo a gimbal tilt and a turn of the shaft, and no hub inertia makes the mass positive.

    Masses beside the axis, here of blades without linkages, stay where they are if pitch undoes the turn of the
    sections too; the lumped pitch inertia feels such a pitch and no turn.
    """
    rotor = flight.rotor
    assume(not beside_axis or (rotor.offset_mass.inertia > 1e-3 * rotor.pitch_inertia))
    alone = {"pitch_inertia": rotor.offset_mass.inertia, "propeller_inertia": None, **UNLINKED}
    flight = flight.with_rotor(**(alone if beside_axis else ON_AXIS))
    model, rotor = undamped(flight), flight.rotor
    cone, lag = rotor.precone + model.trim.coning, model.trim.lag
    rise, swing = np.cos(cone) * np.tan(lag), np.sin(cone)
    of_flap, of_lag = rotor.kinematic_pitch_flap_coupling, rotor.kinematic_pitch_lag_coupling
    turn, roll = (-np.sin(cone) / np.cos(lag), 1 - np.cos(cone) / np.cos(lag)) if beside_axis else (0.0, 0.0)
    # Pitch that undoes what the linkages of hinges and gimbal turn the blades by.
    along, across = rotor.pitch_gimbal_coupling - of_flap, swing * of_lag - rise * of_flap - roll
    # The model has the matrices of its trim before the last step, of up to 1e-13 rad.
    after = structure(flight.without_dampers().rotor, flight.rotor_speed, angles_of(model.trim))
    matrices = Matrices(replace(model, **after), flight.rotor_speed)
    for name in "MC":
        turned = {"flap_0": swing * np.tan(lag), "lag_0": np.cos(cone)}
        turned["pitch_0"] = of_flap * turned["flap_0"] + of_lag * turned["lag_0"] + turn
        matrices.assert_cancel(name, azimuth=1, by_trim=True, **turned)
        pitched = {"pitch_1c": along, "pitch_1s": across}
        matrices.assert_cancel(
            name, gimbal_1c=1, flap_1c=-1, flap_1s=-rise, lag_1s=swing, by_trim=True, **pitched
        )
        pitched = {"pitch_1s": along, "pitch_1c": -across}
        matrices.assert_cancel(
            name, gimbal_1s=1, flap_1s=-1, flap_1c=rise, lag_1c=-swing, by_trim=True, **pitched
        )


@any_rotor
@given(flights())
def test_the_hub_alone_has_no_stiffness(flight):
    """Springs and centrifugal loads go with the rotor wherever it is held, and whichever way it points."""
    matrices = Matrices(undamped(flight), flight.rotor_speed)
    for dof in (*HUB, "azimuth"):
        matrices.assert_loads_equal("K", matrices.along("K", **{dof: 1}), matrices.rows(), dof)


@any_rotor
@given(flights())
def test_a_shaft_turned_back_against_the_hub_moves_no_mass(flight):
    """αz − ψs; nor does it meet new air, so this holds with airloads and dampers too."""
    matrices = Matrices(trimmed(flight), flight.rotor_speed)
    for name in "MCK":
        matrices.assert_cancel(name, alpha_z=1, azimuth=-1)


UNCOUPLED = {
    "no pitch-gimbal coupling": ({"pitch_gimbal_coupling": 0.0}, {}),
    "no pitch inertia": ({"pitch_inertia": 0.0}, {"pitch": "rigid"}),
}


@pytest.mark.parametrize("case", UNCOUPLED)
@any_rotor
@given(flight=flights())
def test_a_gimbal_tilted_back_against_the_hub_moves_no_mass(case, flight):
    """αx − β_GS and αy + β_GC where I_θ K_PG = 0, of masses on the pitch axis."""
    without, options = UNCOUPLED[case]
    matrices = Matrices(undamped(flight.with_rotor(**without, **ON_AXIS), **options), flight.rotor_speed)
    for name in "MC":
        matrices.assert_cancel(name, alpha_x=1, gimbal_1s=-1)
        matrices.assert_cancel(name, alpha_y=1, gimbal_1c=1)


@any_rotor
@given(flights())
def test_blades_that_follow_the_swashplate_move_no_pitch_inertia(flight):
    """With K_PG the same holds once the blades pitch by K_PG times the tilt, which leaves Θs as it was."""
    matrices = Matrices(undamped(flight.with_rotor(**ON_AXIS)), flight.rotor_speed)
    coupling = flight.rotor.pitch_gimbal_coupling
    for name in "MC":
        matrices.assert_cancel(name, alpha_x=1, gimbal_1s=-1, pitch_1s=-coupling)
        matrices.assert_cancel(name, alpha_y=1, gimbal_1c=1, pitch_1c=coupling)


@any_rotor
@given(flights())
def test_a_gimbal_tilted_back_against_the_hub_turns_masses_beside_the_axis(flight):
    """The blade stays, the swashplate has tilted: the masses turn as pitch turns them, the lumped inertia does not."""
    free = flight.with_rotor(pitch_gimbal_coupling=0.0, **UNLINKED)
    matrices, rotor = Matrices(undamped(free), flight.rotor_speed), free.rotor
    lumped = rotor.n_blades / 2 * lumped_inertia(rotor)
    gyroscopic = 2 * lumped * flight.rotor_speed  # of a pitch that goes round
    for tilt, pitch, later, sense in (
        ({"alpha_x": 1, "gimbal_1s": -1}, "pitch_1c", "pitch_1s", -1),
        ({"alpha_y": 1, "gimbal_1c": 1}, "pitch_1s", "pitch_1c", 1),
    ):
        moved = {"M": {pitch: lumped}, "C": {later: sense * gyroscopic}}
        for name, own in moved.items():
            pitched = matrices.along(name, **{pitch: 1}) - matrices.rows(**own)
            matrices.assert_loads_equal(name, matrices.along(name, **tilt), pitched, *tilt, pitch)


@any_rotor
@given(flights())
def test_a_gimbal_tilted_back_against_the_hub_only_pitches_the_blades(flight):
    """Without gimbal spring and K_PG: springs and airloads feel Θy = Θs − γ change, control system and inertia do not.

    A steady torque Q is half on the gimbal rows: a rotation vector added to another one turns about their mean.
    """
    free = flight.with_rotor(gimbal_stiffness=0.0, pitch_gimbal_coupling=0.0).without_dampers()
    model, rotor = trimmed(free), free.rotor
    matrices = Matrices(model, free.rotor_speed)
    cyclic = rotor.cyclic_control_stiffness
    restraint = rotor.control_stiffness if cyclic is None else cyclic
    turning = rotor.n_blades / 2 * lumped_inertia(rotor) * free.rotor_speed**2
    held = {
        "pitch": rotor.n_blades / 2 * restraint - turning,
        "flap": rotor.kinematic_pitch_flap_coupling * turning,
        "lag": rotor.kinematic_pitch_lag_coupling * turning,
    }
    for tilt, pitch, across in (
        ({"alpha_x": 1, "gimbal_1s": -1}, "pitch_1c", "gimbal_1c"),
        ({"alpha_y": 1, "gimbal_1c": 1}, "pitch_1s", "gimbal_1s"),
    ):
        part = pitch.removeprefix("pitch")
        not_felt = matrices.rows(**{f"{angle}{part}": value for angle, value in held.items()})
        pitched = matrices.along("K", **{pitch: 1}) - not_felt
        torque = matrices.rows(**{across: model.trim.torque / 2})
        matrices.assert_loads_equal("K", matrices.along("K", **tilt), pitched + torque, *tilt, pitch)


# Frequencies and mechanical instability -----------------------------------------------------------


def state_matrix(M, C, K):
    zero, one = np.zeros_like(M), np.eye(len(M))
    return np.block([[zero, one], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])


def collective_frequencies(model):
    """Of one blade on a held hub, rad/s: a collective row is N times a blade's."""
    blade = model.submodel(tuple(name for name in model.dofs if name.endswith("_0")))
    return np.sort(np.linalg.eigvals(state_matrix(blade.M, blade.C, blade.K)).imag)


def rotating_frequencies(model, rotor_speed):
    """Of blades and gimbal on a held hub, as seen by the blades, rad/s: a motion forward at ω is at ω + Ω.

    q_1c − i q_1s is one complex coordinate where no direction in the disk is better than another.
    """
    cosine = [place for place, name in enumerate(model.dofs) if name.endswith("_1c")]
    sine = [place for place, name in enumerate(model.dofs) if name.endswith("_1s")]
    parts = (getattr(model, name)[cosine] for name in "MCK")
    forward = state_matrix(*(part[:, cosine] + 1j * part[:, sine] for part in parts))
    return np.sort(np.linalg.eigvals(forward).imag) + rotor_speed


@any_rotor
@given(flights())
def test_collective_and_cyclic_motions_are_those_of_one_blade(flight):
    """Where the swashplate is as stiff in tilt as in heave."""
    model = undamped(flight.with_rotor(cyclic_control_stiffness=None), locked=("gimbal",))
    one_blade, cyclic = collective_frequencies(model), rotating_frequencies(model, flight.rotor_speed)
    assert np.allclose(one_blade, cyclic, rtol=0, atol=1e-10 * flight.rotor_speed)


def growth(model):
    """The largest |Re s| of an undamped model, whose roots come in pairs ±s, and the largest |s|."""
    roots = model.modes().eigenvalue.values
    return np.abs(roots.real).max(), np.abs(roots).max()


@pytest.mark.parametrize("locked", [(), ("gimbal",)], ids=["gimballed", "gimbal locked"])
@any_rotor
@given(flight=flights(hinges="off centre", stiff=True), seed=seeds)
def test_nothing_grows_when_all_rotating_frequencies_are_above_one_per_rev(locked, flight, seed):
    """Pitch and gimbal included: as many motions above 1/rev as there are coordinates, none below and none diverging.

    To 1e-14 of the largest root, times the square root of the mass's condition: in coordinates that measure energy the
    state matrix is skew, its roots are as good as its entries, and these are divided by a root of the mass. (Flap and
    gimbal of blades hinged near the centre move almost the same masses: conditions reach 1e8.)
    """
    frequencies = rotating_frequencies(undamped(flight, locked=locked), flight.rotor_speed)
    assume(np.sum(frequencies > flight.rotor_speed) == len(frequencies) / 2)
    support = random_support(flight, seed)
    for speed in ("windmilling", "constant"):
        options = {"airloads": "none", "locked": locked, "rotor_speed": speed}
        model = flight.without_dampers().on(support, **options)
        largest, of = growth(model)
        assert largest < 1e-14 * np.sqrt(np.linalg.cond(unit_diagonal(model.M))) * of


def uniform_rotor(rotor_speed, *, flap, lag, pitch, gimbal, n_blades=3):
    """Uniform blades whose springs alone give each motion a frequency per rev; the gimbal's adds to its 1/rev."""
    limp = pp.Rotor.from_mass_distribution(
        [0.0, 4.0],
        [7.0, 7.0],
        n_blades=n_blades,
        radius=4.0,
        root_cutout=0.3,
        flap_hinge_offset=0.25,
        lag_hinge_offset=0.4,
        precone=0.03,
        flap_stiffness=1.0,
        lag_stiffness=1.0,
        pitch_inertia=20.0,
        chord=0.3,
        airfoil=pp.Airfoil(lift_slope=5.7),
    )
    disk = n_blades / 2 * limp.blade_inertia
    inertias = {
        "flap": limp.flap_inertia,
        "lag": limp.lag_inertia,
        "control": limp.pitch_inertia,
        "gimbal": disk,
    }
    per_rev = {"flap": flap, "lag": lag, "control": pitch, "gimbal": gimbal}
    springs = {f"{name}_stiffness": inertias[name] * (rotor_speed * per_rev[name]) ** 2 for name in inertias}
    return replace(limp, **springs)


def on_soft_support(rotor, rotor_speed, hub_per_rev, **options):
    """In vacuum at a small collective, each hub coordinate on a mass as heavy as the rotor and a spring."""
    operation = pp.Operation(
        rotor_speed=rotor_speed, density=0.0, speed_of_sound=340.0, trim={"collective": 0.15}
    )
    alone = pp.rotor_model(rotor, operation, 0.0, airloads="none", rotor_speed="constant", **options)
    mass = np.diag([alone.M[0, 0]] * 3 + [alone.M[5, 5]] * 3)
    stiffness = 2 * mass * (hub_per_rev * rotor_speed) ** 2
    support = pp.NormalModes(
        names=HUB, mass=mass, damping=0 * mass, stiffness=stiffness, hub=np.eye(6), includes_rotor=False
    )
    case = pp.Case("unstable", rotor, operation, support)
    return alone, case.linearize(0.0, airloads="none", rotor_speed="constant", **options)


@pytest.mark.parametrize("n_blades", [3, 4, 5])
def test_blades_lagging_below_one_per_rev_shake_a_soft_hub_apart(n_blades):
    """Ground resonance where a hub frequency is 1 − ν_ζ; on the same hub stiff blades do nothing."""
    speed = 45.0
    for lag, unstable in ((0.4, True), (1.4, False)):
        rotor = uniform_rotor(speed, flap=0.8, lag=lag, pitch=4.0, gimbal=0.3, n_blades=n_blades)
        alone, model = on_soft_support(rotor, speed, 0.43, locked=("gimbal",))
        assert (rotating_frequencies(alone, speed)[3:].min() < speed) == unstable
        assert (growth(model)[0] > 0.01 * speed) == unstable


def test_a_gimbal_below_one_per_rev_is_unstable_although_every_blade_is_above():
    """The tilt of a soft gimbal turns the blades' chords, and the propeller moment makes it softer than free."""
    speed = 45.0
    for gimbal, unstable in ((0.0, True), (0.5, False)):
        rotor = uniform_rotor(speed, flap=0.9, lag=1.4, pitch=0.7, gimbal=gimbal)
        alone, model = on_soft_support(rotor, speed, 0.001)
        assert collective_frequencies(alone)[3:].min() > 1.1 * speed
        assert (rotating_frequencies(alone, speed)[4:].min() < speed) == unstable
        assert (growth(model)[0] > 0.01 * speed) == unstable


# Mirrors ------------------------------------------------------------------------------------------

# Seen in a mirror along the I-K plane: vectors lose the sign of y, rotations those of x and z; azimuth runs backwards,
# trailing is leading and nose up is nose down, on blades that have swapped sides.
REVERSED = (
    "y",
    "alpha_x",
    "alpha_z",
    "flap_1s",
    "lag_0",
    "lag_1c",
    "pitch_0",
    "pitch_1c",
    "azimuth",
    "gimbal_1s",
)
MIRROR = np.diag([-1.0 if dof in REVERSED else 1.0 for dof in DOFS])


def angles_of(trim):
    return {name: float(getattr(trim, name)) for name in ("coning", "lag", "elastic_pitch", "collective")}


def structure(rotor, rotor_speed, trim):
    """M, C, K without airloads, straight from the generated functions: any sign of the rotor speed."""
    pool = (
        {entry.name: getattr(rotor, entry.name) for entry in fields(rotor)}
        | (NO_MASSES if rotor.offset_mass is None else vars(rotor.offset_mass))
        | trim
        | {"rotor_speed": rotor_speed, "pitch_inertia": lumped_inertia(rotor)}
    )
    pool["propeller_moment"] = rotor.propeller_share
    linked = rotor.kinematic_pitch_flap_coupling * trim["coning"]
    linked += rotor.kinematic_pitch_lag_coupling * trim["lag"]
    pool["pitch"] = trim["collective"] + trim["elastic_pitch"] - linked
    pool["structural_pitch"] = pool["pitch"] + rotor.structural_pitch_offset
    inertia, springs, pitch = equations.inertia, equations.flap_lag_springs, equations.pitch
    beside = equations.offset_mass
    steps = (
        inertia.dependent_inertias,
        inertia.trim_integrals,
        beside.trim_integrals,
        springs.effective_stiffness,
    )
    for named in steps:
        pool |= evaluate(named, pool)._asdict()
    mass = sum(evaluate(part.mass, pool) for part in (inertia, beside, pitch))
    damping = sum(evaluate(part.gyroscopic, pool) for part in (inertia, beside)) + evaluate(
        pitch.damping, pool
    )
    stiffness = sum(evaluate(part.centrifugal_stiffness, pool) for part in (inertia, beside))
    stiffness = stiffness + sum(evaluate(part.stiffness, pool) for part in (springs, pitch))
    multiblade, cyclic = equations.multiblade, rotor.cyclic_control_stiffness
    pool["cyclic_flap_stiffness_excess"] = 0.0
    pool["cyclic_control_stiffness_excess"] = 0.0 if cyclic is None else cyclic - rotor.control_stiffness
    tilted = evaluate(multiblade.cyclic_restraint, pool)
    return {
        "M": evaluate(multiblade.mass, pool, mass),
        "C": evaluate(multiblade.damping, pool, mass, damping),
        "K": evaluate(multiblade.stiffness, pool, mass, damping, stiffness) + tilted,
    }


def mirrored(rotor):
    """Blades that are twisted the other way, and whose masses lie on the other side of the axis."""
    beside = vars(rotor.offset_mass)
    turned = ("offset_cosine_moment", "offset_cosine_lag_inertia", "offset_product_inertia")
    return replace(
        rotor,
        offset_mass=pp.OffsetMass(**beside | {name: -beside[name] for name in turned}),
        pitch_gimbal_coupling=-rotor.pitch_gimbal_coupling,
        kinematic_pitch_flap_coupling=-rotor.kinematic_pitch_flap_coupling,  # lag changes sign as pitch does
        structural_pitch_offset=-rotor.structural_pitch_offset,
    )


@any_rotor
@given(flights())
def test_a_rotor_turning_the_other_way_is_a_mirror_image(flight):
    """Dampers included."""
    model = trimmed(flight, airloads="none")
    trim = angles_of(model.trim)
    reflected = {name: value if name == "coning" else -value for name, value in trim.items()}
    forward = structure(flight.rotor, flight.rotor_speed, trim)
    backward = structure(mirrored(flight.rotor), -flight.rotor_speed, reflected)
    matrices = Matrices(model, flight.rotor_speed)
    for name in "MCK":
        # The model has the matrices of its trim before the last step, of up to 1e-13 rad; `forward` has those after it.
        away = 1e-13 * np.abs(forward[name]).max() * len(trim)
        np.testing.assert_allclose(forward[name], matrices.matrix[name], rtol=1e-12, atol=away)
        matrices.assert_equal(name, MIRROR @ backward[name] @ MIRROR, forward[name])


@any_rotor
@given(flights(), between(-0.6, 0.6))
def test_a_mirror_image_run_backwards_in_time_turns_the_same_way(flight, collective):
    """In vacuum: the trim angles are mirrored by themselves, and gyroscopic terms change sign."""

    def in_vacuum(rotor, collective):
        operation = replace(flight.operation, density=0.0, trim={"collective": collective})
        return undamped(replace(flight, rotor=rotor, operation=operation))

    model, image = in_vacuum(flight.rotor, collective), in_vacuum(mirrored(flight.rotor), -collective)
    for name, sign in (("M", 1), ("C", -1), ("K", 1)):
        seen, own = sign * MIRROR @ getattr(image, name) @ MIRROR, getattr(model, name)
        # Both are those of a trim before its last step, of up to 1e-13 rad, and the steps are no mirror images.
        away = 1e-13 * np.abs(own).max() * 4
        np.testing.assert_allclose(seen, own, rtol=1e-12, atol=away)


# Directions and azimuth ---------------------------------------------------------------------------


PAIRS = (
    ("x", "y"),
    ("alpha_x", "alpha_y"),
    *((f"{n}_1c", f"{n}_1s") for n in ("flap", "lag", "pitch", "gimbal")),
)


def turned_about_shaft(angle, dofs=DOFS):
    """Coordinates of axes turned about K: each pair in the plane of the disk turns as one vector."""
    turn = np.eye(len(dofs))
    block = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    for pair in PAIRS:
        if set(pair) <= set(dofs):
            places = [dofs.index(name) for name in pair]
            turn[np.ix_(places, places)] = block
    return turn


@any_rotor
@given(flights(), OPTIONS, between(-3.2, 3.2))
def test_no_direction_in_the_disk_is_better_than_another(flight, options, angle):
    """With airloads and dampers too."""
    matrices = Matrices(trimmed(flight, **options), flight.rotor_speed)
    turn = turned_about_shaft(angle, matrices.dofs)
    for name in "MCK":
        matrices.assert_equal(name, turn @ matrices.matrix[name] @ turn.T, matrices.matrix[name])


def coordinates_of_a_blade(azimuth):
    """Hub motion and gimbal tilt along a blade's axes i, j, k, and its own angles, from those of the fixed frame."""
    s, c = np.sin(azimuth), np.cos(azimuth)
    axes = np.array([[s, -c, 0], [c, s, 0], [0, 0, 1]])
    series = np.kron(np.eye(3), [[1, c, s]])
    blade = np.zeros((12, 18))
    blade[0:3, 0:3] = blade[3:6, 3:6] = axes
    blade[6:9, 6:15] = series
    blade[9, 15] = 1
    blade[10:12, 16:18] = [[c, s], [-s, c]]  # β_G and γ
    return blade


@pytest.mark.parametrize("n_blades", [3, 4, 5, 6, 7])
@pytest.mark.parametrize("azimuth", [0.0, 0.4, 2.0])
def test_the_sum_over_the_blades_does_not_depend_on_azimuth(n_blades, azimuth):
    """The blades summed one by one, whatever the blade's matrices. T'' = mean − T, T' = T a quarter turn on − mean."""
    speed = 3.0
    rng = np.random.default_rng(n_blades)
    mass, damping, stiffness = rng.normal(size=(3, 12, 12))
    M, C, K = np.zeros((3, 18, 18))
    for blade in azimuth + 2 * np.pi * np.arange(n_blades) / n_blades:
        T = coordinates_of_a_blade(blade)
        mean = (T + coordinates_of_a_blade(blade + np.pi)) / 2
        rate, acceleration = coordinates_of_a_blade(blade + np.pi / 2) - mean, mean - T
        M += T.T @ mass @ T
        C += T.T @ (2 * speed * mass @ rate + damping @ T)
        K += T.T @ (speed**2 * mass @ acceleration + speed * damping @ rate + stiffness @ T)
    keywords = {"n_blades": n_blades, "rotor_speed": speed}
    multiblade = equations.multiblade
    for summed, constant in (
        (M, multiblade.mass(mass, n_blades=n_blades)),
        (C, multiblade.damping(mass, damping, **keywords)),
        (K, multiblade.stiffness(mass, damping, stiffness, **keywords)),
    ):
        assert np.allclose(summed, constant, rtol=0, atol=1e-12 * np.abs(constant).max())


def nearest(roots, others):
    """Distance of each root to the nearest of the others."""
    return np.abs(roots[:, None] - others[None, :]).min(axis=1)


@any_rotor
@given(flights(hinges="off centre"), seeds, between(-3.2, 3.2))
def test_a_support_turned_about_the_shaft_keeps_its_eigenvalues(flight, seed, angle):
    """To 1e-12 of the largest, and what the condition of the mass, which may be 1e8, makes of rounding."""
    support, turn = random_support(flight, seed), turned_about_shaft(angle, HUB)
    turned = {name: turn @ getattr(support, name) @ turn.T for name in ("mass", "damping", "stiffness")}
    here = flight.on(support)
    assume(here.trim.converged)
    there = flight.on(replace(support, **turned))
    roots, others = here.modes().eigenvalue.values, there.modes().eigenvalue.values
    assert roots.shape == others.shape
    error = max(nearest(roots, others).max(), nearest(others, roots).max())
    rounding = 1e-15 * np.linalg.cond(unit_diagonal(here.M))
    assert error < (1e-12 + rounding) * np.abs(roots).max()


# What the mass may depend on ----------------------------------------------------------------------


def test_mass_knows_nothing_but_masses_geometry_and_deflection():
    """Not how fast the rotor turns or flies, what holds its blades, or the air."""
    known = {
        "lag_first_moment",
        "lag_inertia",
        "blade_mass",
        "pitch_inertia",
        "pitch_gimbal_coupling",
        "kinematic_pitch_flap_coupling",
        "kinematic_pitch_lag_coupling",
        "n_blades",
    }
    known |= {"cos_cone", "sin_cone", "cos_lag", "sin_lag"}
    known |= set(equations.inertia.TrimIntegrals._fields)
    for function in (equations.inertia.mass, equations.pitch.mass, equations.multiblade.mass):
        assert set(inspect.signature(function).parameters) - {"mass"} <= known


@any_rotor
@given(flights(), between(1.05, 1.2))
def test_mass_of_an_undeflected_rotor_is_the_same_in_any_flight(flight, factor):
    """Bit for bit."""
    springs = ("flap_stiffness", "lag_stiffness", "gimbal_stiffness", "control_stiffness")
    flight = flight.with_rotor(
        **ON_AXIS
    )  # what lies beside the axis goes up and down with the pitch of the flight
    stiffer = flight.with_rotor(**{name: factor * getattr(flight.rotor, name) for name in springs})
    faster = replace(flight.operation, rotor_speed=factor * flight.rotor_speed, density=0.3, trim="windmill")
    elsewhere = Flight(stiffer.without_dampers().rotor, faster, factor * flight.airspeed)
    still = {"locked": ("flap", "lag", "pitch")}
    assert np.array_equal(trimmed(flight, **still).M, trimmed(elsewhere, **still).M)


@any_rotor
@given(flights())
def test_mass_has_no_share_of_airloads_and_dampers(flight):
    """Bit for bit."""
    mass = undamped(flight).M
    for airloads in ("full", "lift-slope"):
        assert np.array_equal(trimmed(flight, airloads=airloads).M, mass)


# Air at rest --------------------------------------------------------------------------------------


@any_rotor
@given(flights(), OPTIONS)
def test_still_air_is_the_same_everywhere(flight, options):
    """No load from where the hub is, nor from a turn about the shaft, nor from the rotor's azimuth."""
    matrices = Matrices(trimmed(flight, **options), flight.rotor_speed)
    for dof in {"x", "y", "z", "alpha_z", "azimuth"} & set(matrices.dofs):
        matrices.assert_loads_equal("K", matrices.along("K", **{dof: 1}), matrices.rows(), dof)


@any_rotor
@given(flights(), OPTIONS)
def test_a_tilted_rotor_that_flies_along_its_shaft_only_tilts_its_loads(flight, options):
    """Tilt the hub by αy and let it fly at V αy along x, so that it still meets the air along its shaft: blades and

    gimbal feel nothing, thrust T and torque Q tilt along. αx goes with −V along y.
    """
    model = trimmed(flight, **options)
    matrices = Matrices(model, flight.rotor_speed)
    thrust, torque = model.trim.thrust, model.trim.torque
    tilt, drift = matrices.along("K", alpha_y=1), flight.airspeed * matrices.along("C", x=1)
    loads = matrices.rows(x=-thrust, alpha_x=-torque)
    matrices.assert_loads_equal("K", tilt, loads - drift, "alpha_y", by_trim=True)
    tilt, drift = matrices.along("K", alpha_x=1), -flight.airspeed * matrices.along("C", y=1)
    loads = matrices.rows(y=thrust, alpha_y=torque)
    matrices.assert_loads_equal("K", tilt, loads - drift, "alpha_x", by_trim=True)


# Zero cone ----------------------------------------------------------------------------------------


def flat_in_vacuum(flight, collective, **options):
    """Neither precone nor coning: nothing bends a flat blade in vacuum."""
    unlinked = dict.fromkeys(
        ("pitch_gimbal_coupling", "kinematic_pitch_flap_coupling", "kinematic_pitch_lag_coupling"), 0.0
    )
    flat = flight.with_rotor(precone=0.0, propeller_moment=False, **unlinked, **ON_AXIS).without_dampers()
    operation = replace(flat.operation, density=0.0, trim={"collective": collective})
    return trimmed(replace(flat, operation=operation), airloads="none", pitch="rigid", **options)


def springs_in_series(rotor, pitch):
    """Stiffness of hub springs and of blade springs that turn with the pitch, by adding their flexibilities."""
    flexibility = np.array([1 / rotor.flap_stiffness, 1 / rotor.lag_stiffness])
    outboard = np.array([rotor.flap_outboard_fraction, rotor.lag_outboard_fraction])
    c, s = np.cos(pitch), np.sin(pitch)
    turn = np.array([[c, s], [-s, c]])
    return np.linalg.inv(
        np.diag((1 - outboard) * flexibility) + turn @ np.diag(outboard * flexibility) @ turn.T
    )


@any_rotor
@given(flights(), between(-0.6, 0.9))
def test_flap_lag_and_gimbal_frequencies_of_a_flat_rotor(flight, collective):
    """ν_β² = 1 + e_βS_β/I_β + K_ββ/(I_βΩ²), ν_ζ² = e_ζS_ζ/I_ζ + K_ζζ/(I_ζΩ²), gimbal ν² = 1 + K_G/((N/2) I_b Ω²)."""
    model, rotor, speed = flat_in_vacuum(flight, collective), flight.rotor, flight.rotor_speed
    springs = springs_in_series(rotor, collective + rotor.structural_pitch_offset)
    flap, lag = (model.submodel((name,)) for name in ("flap_0", "lag_0"))
    expected = 1 + rotor.flap_hinge_offset * rotor.flap_first_moment / rotor.flap_inertia
    expected += springs[0, 0] / (rotor.flap_inertia * speed**2)
    assert np.isclose((flap.K / flap.M).item(), expected * speed**2, rtol=1e-12)
    expected = rotor.lag_hinge_offset * rotor.lag_first_moment / rotor.lag_inertia
    expected += springs[1, 1] / (rotor.lag_inertia * speed**2)
    assert np.isclose((lag.K / lag.M).item(), expected * speed**2, rtol=1e-12)
    gimbal = rotating_frequencies(model.submodel(("gimbal_1c", "gimbal_1s")), speed)
    expected = 1 + rotor.gimbal_stiffness / (rotor.n_blades / 2 * rotor.blade_inertia * speed**2)
    assert np.allclose(gimbal, np.sqrt(expected) * speed * np.array([-1, 1]), rtol=1e-12)


@any_rotor
@given(flights())
def test_a_flat_rigid_rotor_is_a_gyroscope(flight):
    """Its inertia tensor, and the moment that turns its angular momentum."""
    model = flat_in_vacuum(flight, 0.3, locked=("flap", "lag", "gimbal"), rotor_speed="constant")
    matrices, rotor = Matrices(model, flight.rotor_speed), flight.rotor
    mass, polar = rotor.n_blades * rotor.blade_mass, rotor.n_blades * rotor.blade_inertia
    gyroscopic = np.zeros((6, 6))
    gyroscopic[3, 4], gyroscopic[4, 3] = polar * flight.rotor_speed, -polar * flight.rotor_speed
    matrices.assert_equal("M", model.M, np.diag([mass, mass, mass, polar / 2, polar / 2, polar]))
    matrices.assert_equal("C", model.C, gyroscopic)
    matrices.assert_equal("K", model.K, np.zeros((6, 6)))


# Units --------------------------------------------------------------------------------------------

KILOGRAM, METRE, SECOND = 1 / 8, 4.0, 2.0
"""In the units of somebody else; powers of two, so that nothing is rounded on the way."""

IN_OTHER_UNITS = {
    **dict.fromkeys(("radius", "root_cutout", "flap_hinge_offset", "lag_hinge_offset"), METRE),
    "blade_mass": KILOGRAM,
    **dict.fromkeys(("blade_first_moment", "flap_first_moment", "lag_first_moment"), KILOGRAM * METRE),
    **dict.fromkeys(("blade_inertia", "flap_inertia", "lag_inertia", "pitch_inertia"), KILOGRAM * METRE**2),
    **dict.fromkeys(
        (
            "flap_stiffness",
            "lag_stiffness",
            "gimbal_stiffness",
            "control_stiffness",
            "cyclic_control_stiffness",
        ),
        KILOGRAM * METRE**2 / SECOND**2,
    ),
    **dict.fromkeys(
        ("flap_damping", "lag_damping", "pitch_damping", "gimbal_damping"), KILOGRAM * METRE**2 / SECOND
    ),
    "rotor_speed": 1 / SECOND,
    "density": KILOGRAM / METRE**3,
    "speed_of_sound": METRE / SECOND,
}


def converted(part, **instead):
    """A rotor or an operation with its plain numbers in the other units."""
    given = {name: getattr(part, name) for name in IN_OTHER_UNITS if getattr(part, name, None) is not None}
    return replace(part, **{name: IN_OTHER_UNITS[name] * value for name, value in given.items()}, **instead)


def along_blade(distribution, unit):
    """Chord, twist or aerodynamic centre: a number or a table."""
    if isinstance(distribution, tuple):
        return METRE * distribution[0], unit * distribution[1]
    return unit * distribution


def in_other_units(flight):
    given = flight.rotor
    tables = {"chord": METRE, "twist": 1.0, "aerodynamic_center": METRE}
    along = {name: along_blade(getattr(given, name), unit) for name, unit in tables.items()}
    units = {
        name: KILOGRAM * METRE if name.endswith("moment") else KILOGRAM * METRE**2
        for name in vars(given.offset_mass)
    }
    beside = pp.OffsetMass(**{name: units[name] * value for name, value in vars(given.offset_mass).items()})
    propeller = None if given.propeller_inertia is None else KILOGRAM * METRE**2 * given.propeller_inertia
    rotor = converted(given, **along, offset_mass=beside, propeller_inertia=propeller)
    return Flight(rotor, converted(flight.operation), METRE / SECOND * flight.airspeed)


@any_rotor
@given(flights(), OPTIONS)
def test_units_do_not_matter(flight, options):
    """Every term of an entry has the entry's dimension. Bit for bit."""
    here, there = trimmed(flight, **options), trimmed(in_other_units(flight), **options)
    lever = np.array([1.0 if name in HUB[:3] else METRE for name in here.dofs])
    for name, rate in (("M", 1), ("C", 1 / SECOND), ("K", 1 / SECOND**2)):
        unit = KILOGRAM * rate * np.outer(lever, lever)
        assert np.array_equal(getattr(there, name), unit * getattr(here, name))
