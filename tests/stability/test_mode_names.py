"""What a mode is called: what moves in it at the point, whoever asks, and beside it which root that is.

Judges: systems without couplings, whose motions are known; participations in coordinates of the uncoupled modes; the
best of all assignments; roots followed by their neighbourhood alone in small steps.
"""

from dataclasses import replace
from itertools import combinations, pairwise

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

import proprotor as pp
from proprotor.explore.analysis import live_modes
from proprotor.model.first_order import state_matrix
from proprotor.model.rigid_propeller import WhirlDerivatives, rigid_propeller
from proprotor.plots.mode_motion import mode_motion
from proprotor.rotor.motions import SECOND, motions, name_list
from proprotor.rotor.options import LOCKABLE
from proprotor.stability.boundary_lines import boundary_lines
from proprotor.stability.branches import by_branch
from proprotor.stability.matching import POOR
from proprotor.stability.mode_names import DOUBTFUL, moving
from proprotor.stability.modes import decomposition
from proprotor.stability.participation import coordinate_shares
from tests.known_systems import continued, roots

KNOT, RPM = 1852 / 3600, np.pi / 30
DECKS = ("xv15-uncoupled", "xv15-wing", "wrats-770-on", "v22-fifth-scale")
SPRINGS = ("stiffness", "frequency", "pitch_inertia")


def random_case(seed):
    """A bundled case with other springs, rotor speed and number of blades."""
    rng = np.random.default_rng(seed)
    case = pp.load_case(
        rng.choice(["xv15-uncoupled", "xv15-mass-distribution", "wrats-770-on", "v22-fifth-scale"])
    )
    springs = [
        path for path, number in case.given.items() if path.endswith(SPRINGS) and np.ndim(number.si) == 0
    ]
    values = {path: float(case.given[path].si) * 2 ** rng.uniform(-1.5, 1.5) for path in springs}
    # The wing's masses hold those of the rotor, whatever its blades are.
    masses = [path for path in case.given if path.endswith("generalized_mass")]
    values |= {path: 5 * float(case.given[path].si) for path in masses}
    values["operation.rotor_speed"] = float(case.operation.rotor_speed) * 2 ** rng.uniform(-1.3, 0.3)
    case = case.vary(values)
    # More blades may weigh more than the modes that were measured with three: these are of a wing without rotor.
    wing = replace(case.support, includes_rotor=False)
    return replace(case, rotor=replace(case.rotor, n_blades=int(rng.choice([3, 4, 5]))), support=wing)


def slow_four_blades():
    """The rotor of the XV-15 with four blades at 200 rpm, where participations are mixed most."""
    case = pp.load_case("xv15-uncoupled").vary({"operation.rotor_speed": 200 * RPM})
    return replace(case, rotor=replace(case.rotor, n_blades=4))


def airspeeds(case, points=9):
    tip = float(case.operation.rotor_speed) * float(case.rotor.radius)
    return np.linspace(0.15, 1.05, points) * tip


def named(model):
    """Eigenvalues of all states of the points and what moves in them."""
    values, right, left = decomposition(model).all_modes
    return values, moving(model, values, left, right)


# What moves ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(12))
def test_without_couplings_a_mode_is_named_after_the_only_thing_that_moves(seed):
    """Blocks of single coordinates and of cyclic pairs: their roots are those of polynomials, each with its motion.

    A pair that is alike in all directions is one complex coordinate z = c + is: a root above the real axis whirls with
    the rotor, one below against it, and the first is progressive above the rotor speed.
    """
    case = random_case(seed)
    speed = float(case.operation.rotor_speed)
    model = case.linearize(airspeeds(case, 5), section_damping=True)
    blocks = {name: np.zeros_like(getattr(model, name)) for name in "MCK"}
    expected = [{} for _ in range(5)]
    for motion in motions(model.dofs):
        places = np.ix_(motion.places, motion.places)
        for kind, block in blocks.items():
            own = getattr(model, kind)[(slice(None), *places)]
            if len(motion.places) == 2:  # alike in all directions
                same = (own[:, 0, 0] + own[:, 1, 1]) / 2
                turned = (own[:, 0, 1] - own[:, 1, 0]) / 2
                own = same[:, None, None] * np.eye(2) + turned[:, None, None] * np.array([[0, 1], [-1, 0]])
            block[(slice(None), *places)] = own
        for point in range(5):
            first = (motion.places[0],) * 2
            coefficients = [blocks[kind][(point, *first)] + 0j for kind in "MCK"]
            if len(motion.places) == 2:
                cross = motion.places
                coefficients = [
                    c - 1j * blocks[kind][(point, *cross)]
                    for c, kind in zip(coefficients, "MCK", strict=False)
                ]
            elif motion.names == ("rotor speed",):
                coefficients = coefficients[:2]
            for root in np.roots(coefficients):
                ahead = root.imag > speed
                expected[point].setdefault(motion.names[int(ahead and len(motion.names) == 2)], []).append(
                    root
                )
    values, found = named(replace(model, **blocks))
    for point, polynomial in enumerate(expected):
        for name, wanted in polynomial.items():
            own = values[point, found.names[point] == name]
            for root in wanted:
                nearest = np.abs(own[:, None] - [root, np.conj(root)]).min()
                assert nearest < 1e-7 * np.abs(values[point]).max(), (name, root, own)
    assert np.nanmin(found.share) > 1 - 1e-6


def participations(matrix, basis):
    """Sizes of left times right components (states, states) of a matrix, in the coordinates of a basis in columns."""
    turned = np.linalg.solve(basis, matrix @ basis)
    values, right = np.linalg.eig(turned)
    order = np.lexsort((values.imag, values.real))
    return values[order], np.abs(np.linalg.inv(right).T * right)[:, order]


def uncoupled_modes(model, point, places):
    """Modes of a cyclic pair alone, alike in all directions: which is progressive (4,), and vectors (4, 4)."""
    blocks = []
    for kind in "MCK":
        own = getattr(model, kind)[point][np.ix_(places, places)]
        turned = np.array([[0.0, -1.0], [1.0, 0.0]])
        blocks.append((own - turned @ own @ turned) / 2)  # the mean over all directions
    mass, damping, stiffness = blocks
    alone = np.zeros((4, 4))
    alone[:2, 2:] = np.eye(2)
    alone[2:] = -np.linalg.solve(mass, np.hstack([stiffness, damping]))
    values, vectors = np.linalg.eig(alone)
    with_rotor = np.abs(vectors[0] + 1j * vectors[1]) > np.abs(vectors[0] - 1j * vectors[1])
    speeds = np.where(with_rotor, values.imag, -values.imag)  # how fast each goes round with the rotor
    return speeds > speeds.mean(), vectors


def judged_shares(model, point):
    """Shares of names at one point: by matrices, on coordinates that go round and on those of uncoupled modes."""
    n, matrix = len(model.dofs), state_matrix(model)[point]
    held = [place for place, name in enumerate(model.dofs) if name != "azimuth"]
    rates, rows = len(held), []
    for motion in motions(model.dofs):
        states = [held.index(place) for place in motion.places if place in held]
        states += [rates + place for place in motion.places]
        basis = np.eye(rates + n, dtype=complex)
        if len(motion.places) == 2:
            for pair in (states[:2], states[2:]):
                basis[np.ix_(pair, pair)] = np.array([[1, 1], [-1j, 1j]]) / np.sqrt(2)
        values, sizes = participations(matrix, basis)
        whole = sizes[states].sum(axis=0)
        if len(motion.places) == 1:
            rows.append(whole)
            continue
        progressive, vectors = uncoupled_modes(model, point, motion.places)
        basis[np.ix_(states, states)] = vectors
        _, own = participations(matrix, basis)
        part = own[np.array(states)[progressive]].sum(axis=0) / own[states].sum(axis=0)
        rows += [whole * (1 - part), whole * part]
    shares, above = (
        np.array(rows),
        values.imag > 1e-7 * np.abs(values).max(),
    )  # real roots come out with rounding
    return values[above], (shares / shares.sum(axis=0))[:, above]


@pytest.mark.parametrize(
    "case", [pp.load_case("xv15-uncoupled"), slow_four_blades(), random_case(3), random_case(8)]
)
def test_the_sum_of_shares_is_the_largest_possible(case):
    model = case.linearize(airspeeds(case, 25))
    values, found = named(model)
    judged = 0
    for point in range(25):
        above, shares = judged_shares(model, point)
        if 2 * len(above) + 1 < len(values[point]):  # pairs that have parted: the judge knows pairs alone
            continue
        whole = [place for place, name in enumerate(name_list(model.dofs)) if name != "rotor speed"]
        rows, columns = linear_sum_assignment(shares[whole], maximize=True)
        judged += 1
        own = found.share[point, values[point].imag > 0]
        assert own.sum() == pytest.approx(shares[whole][rows, columns].sum(), abs=2e-6)
        place = {
            name: above[column]
            for name, column in zip(np.array(found.known)[whole][rows], columns, strict=False)
        }
        for root, name in zip(values[point], found.names[point], strict=True):
            if root.imag > 0:
                assert root == pytest.approx(place[name], rel=1e-8)
        order = np.argsort(values[point].imag[values[point].imag > 0])
        expected = shares[:, np.argsort(above.imag)]
        np.testing.assert_allclose(
            found.shares[point][:, values[point].imag > 0][:, order], expected, atol=1e-6
        )
    assert judged >= 10


def test_the_names_of_the_xv15_at_50_knots_are_what_moves():
    """Chord was 94 % cyclic lag there, and regressive lag 97 % wing chord."""
    modes = pp.load_case("xv15-uncoupled").sweep("50 kt").isel(airspeed=0)
    assert modes.participation.sel(mode="chord", dof="chord") > 0.9
    assert modes.participation.sel(mode="regressive lag", dof=["lag_1c", "lag_1s"]).sum() > 0.9
    assert set(
        modes.branch.values[[modes.mode.values.tolist().index(name) for name in ("chord", "regressive lag")]]
    ) == {
        "regressive lag",
        "chord",
    }


@pytest.mark.parametrize("damping", [False, True])
@pytest.mark.parametrize("name", DECKS)
def test_where_no_share_is_low_the_named_motion_is_the_largest(name, damping):
    """A share above one half leaves no room for a larger one."""
    case = pp.load_case(name)
    _, found = named(case.linearize(airspeeds(case, 60), section_damping=damping))
    largest = found.shares.argmax(axis=-2)
    clear = found.share > 0.5
    assert (largest[clear] == found.place[clear]).all()
    assert clear.mean() > 0.9 and (found.share < DOUBTFUL).mean() < 0.05


@pytest.mark.parametrize("seed", range(6))
def test_a_hand_over_is_single(seed):
    """No root changes its name for fewer than five of 400 points of the range and takes it back."""
    case = random_case(100 + seed)
    sweep = case.sweep(airspeeds(case, 400), section_damping=True)
    label, names = sweep.branch.values, sweep.mode.values.tolist()
    for branch in np.unique(label[label != ""]):
        points, places = np.nonzero(label == branch)
        changes = np.flatnonzero(np.diff(places))
        for first, again in pairwise(changes):
            back = places[first] == places[again + 1] and again - first < 5
            assert not back, (branch, names[places[first]], sweep.airspeed.values[points[first]])


def test_names_that_fit_equally_well_do_not_hang_on_rounding():
    """A propeller alike in all directions: pitch and yaw take part alike in both of its modes."""
    propeller = rigid_propeller(
        np.linspace(10.0, 40.0, 7), radius=0.5, rotor_speed=300.0, density=1.2, mass=2.0, polar_inertia=0.2,
        diametral_inertia=0.1, derivatives=WhirlDerivatives(*np.zeros(len(WhirlDerivatives._fields))),
    )  # fmt: skip
    pivot = pp.two_axis_pivot(
        0.3, inertia=[0.5, 0.5], stiffness=[900.0, 900.0], damping=[0.0, 0.0], includes_rotor=False
    )
    model = pp.mount(propeller, pivot)
    rng = np.random.default_rng(0)
    for _ in range(20):
        noise = 1 + 1e-13 * rng.standard_normal(model.M.shape)
        values, found = named(replace(model, M=model.M * noise, K=model.K * noise))
        low = np.where(values.imag > 0, values.imag, np.inf).argmin(axis=-1)
        assert (np.take_along_axis(found.place, low[:, None], 1) == 0).all()


def test_two_roots_that_fall_into_one_have_shares():
    """A mass without spring has the right vectors (1, 0) and (1, -δ), and the left ones (1, 1/δ) and (0, -1/δ)."""
    near = 2.0**-960
    right, left = np.array([[1, 1], [0, -near]]), np.array([[1, 1 / near], [0, -1 / near]])
    both = np.kron(np.eye(2), right)[[0, 2, 1, 3]], np.kron(np.eye(2), left)[:, [0, 2, 1, 3]]
    shares = coordinate_shares([0, 1], 2, both[1] + 0j, both[0] + 0j)
    np.testing.assert_array_equal(shares, [[1, 1, 0, 0], [0, 0, 1, 1]])


def test_the_modes_of_a_propeller_on_a_pivot_whirl():
    """The slower one goes round against the rotor, the faster one with it: gyroscopic precession and nutation."""
    propeller = rigid_propeller(
        np.array([10.0]), radius=0.5, rotor_speed=300.0, density=1.2, mass=2.0, polar_inertia=0.2,
        diametral_inertia=0.1, derivatives=WhirlDerivatives(*np.zeros(len(WhirlDerivatives._fields))),
    )  # fmt: skip
    pivot = pp.two_axis_pivot(
        0.3, inertia=[0.5, 0.5], stiffness=[900.0, 900.0], damping=[0.0, 0.0], includes_rotor=False
    )
    from proprotor.stability.sweep import sweep

    modes = sweep(pp.mount(propeller, pivot)).isel(airspeed=0).sortby("frequency")
    np.testing.assert_allclose(modes.whirl, [-1, 1], atol=1e-9)
    # I θ̈ ∓ iHθ̇ + kθ = 0 with H = I_p Ω: the quicker root turns as the rotor does.
    inertia = 0.5 + 0.1 + 2.0 * 0.3**2
    half = 0.2 * 300.0 / (2 * inertia)
    expected = np.sqrt(half**2 + 900.0 / inertia) + np.array([-half, half])
    np.testing.assert_allclose(modes.frequency, expected, rtol=1e-9)


# The same for everyone ----------------------------------------------------------------------------------------------


def told(sweep, speeds):
    """Names by eigenvalue and branch at airspeeds of a sweep."""
    some = sweep.sel(airspeed=speeds, method="nearest")
    np.testing.assert_allclose(some.airspeed, speeds, rtol=1e-12)
    return [
        {
            str(mode): (value, str(branch))
            for mode, value, branch in zip(
                some.mode.values, some.eigenvalue.values[row], some.branch.values[row], strict=True
            )
            if np.isfinite(value)
        }
        for row in range(len(speeds))
    ]


def assert_same(one, other):
    for here, there in zip(one, other, strict=True):
        assert here.keys() == there.keys()
        for mode, (value, branch) in here.items():
            assert there[mode][0] == pytest.approx(value, rel=1e-7, abs=1e-7)
            assert there[mode][1] == branch, mode


@pytest.mark.parametrize("damping", [False, True])
@pytest.mark.parametrize("case", [*DECKS, "slow", 0, 1, 2, 3, 4, 5])
def test_names_and_branches_are_those_of_any_step_and_range(case, damping):
    case = (
        slow_four_blades()
        if case == "slow"
        else random_case(case)
        if isinstance(case, int)
        else pp.load_case(case)
    )
    top = int(min(1.1 * case.operation.rotor_speed * case.rotor.radius / KNOT, 460) / 20) * 20
    common = np.arange(20, top + 1, 20) * KNOT
    if np.isnan(case.linearize(common, section_damping=damping).M).any():
        common = common[np.isfinite(case.linearize(common, section_damping=damping).M).all(axis=(1, 2))]
    finest = case.sweep(np.arange(20, top + 0.5, 1) * KNOT, section_damping=damping)
    assert finest.tracking_quality.min() > POOR and "which root" not in " ".join(finest.warning.values)
    expected = told(finest, common)
    for step in (2, 5, 20):
        assert_same(
            told(case.sweep(np.arange(20, top + 0.5, step) * KNOT, section_damping=damping), common), expected
        )
    for some in (common[:2], common[-3:], common[::-1], common[[len(common) // 2]]):
        found = told(case.sweep(some, section_damping=damping), np.sort(some)) if len(some) > 1 else None
        alone = told(case.sweep(some[:1], section_damping=damping), some[:1])
        assert_same(alone, [expected[np.flatnonzero(common == some[0])[0]]])
        if found is not None:
            assert_same(found, [expected[np.flatnonzero(common == speed)[0]] for speed in np.sort(some)])


@pytest.mark.parametrize("case", [pp.load_case("xv15-uncoupled"), slow_four_blades(), random_case(1)])
def test_every_analysis_calls_a_mode_by_the_same_name(case):
    """Sweep, modes of one model, attribution, sensitivity, explorer, animation: one name, one eigenvalue."""
    speed = float(airspeeds(case)[3])
    expected = case.sweep([speed]).isel(airspeed=0)
    by_name = {
        str(mode): value for mode, value in zip(expected.mode.values, expected.eigenvalue.values, strict=True)
    }
    single = case.linearize(speed).modes()
    assert sorted(single.name.values) == sorted(name.split(",")[0] for name in by_name)
    for name, value in zip(single.name.values, single.eigenvalue.values, strict=True):
        assert np.abs(
            value - [by_name[mode] for mode in by_name if mode.startswith(name)]
        ).min() < 1e-7 * abs(value)
    share = {name: value for name, value in zip(single.name.values, single.share.values, strict=True)}
    assert share["beam"] == pytest.approx(expected.share.sel(mode="beam").item(), rel=1e-9)
    causes, rates = case.attribution(speed), case.sensitivity("eigenvalue", ["rotor.precone"], airspeed=speed)
    lively = live_modes(case, np.array([0.9, 1.0, 1.1, 1.2]) * speed)
    for mode, value in by_name.items():
        assert causes.eigenvalue.sel(mode=mode).item() == pytest.approx(value, rel=1e-9, abs=1e-9)
        assert rates.eigenvalue.sel(mode=mode).item() == pytest.approx(value, rel=1e-9, abs=1e-9)
        assert lively.eigenvalue[1, lively.names.index(mode)] == pytest.approx(value, rel=1e-9, abs=1e-9)
    assert mode_motion(case, speed, "chord").eigenvalue == pytest.approx(by_name["chord"], rel=1e-9)


@pytest.mark.parametrize("name", ["xv15-uncoupled", "wrats-888-on"])
def test_a_boundary_is_named_as_the_mode_is_at_its_airspeed(name):
    case = pp.load_case(name)
    found = case.boundaries().boundaries
    assert found
    for boundary in found:
        here = case.sweep([boundary.position]).isel(airspeed=0).sel(mode=boundary.mode)
        assert here.eigenvalue.item() == pytest.approx(
            boundary.eigenvalue, abs=1e-5 * abs(boundary.eigenvalue)
        )
        assert str(here.branch.item()) == boundary.branch
        assert boundary.mechanism[boundary.mode] == pytest.approx(here.share.item(), abs=1e-5)


def test_names_go_with_the_rotor_speed_of_the_point():
    """Where the rotor speed varies, progressive is what goes round faster than the rotor of that point."""
    case = pp.load_case("xv15-uncoupled")
    speeds = np.array([300.0, 458.0, 600.0]) * RPM
    along = case.sweep(60.0, {"operation.rotor_speed": speeds})
    for place, speed in enumerate(speeds):
        alone = case.vary({"operation.rotor_speed": speed}).sweep([60.0]).isel(airspeed=0)
        here = along.isel({"operation.rotor_speed": place})
        for mode in alone.mode.values:
            np.testing.assert_allclose(
                here.eigenvalue.sel(mode=mode), alone.eigenvalue.sel(mode=mode), rtol=1e-9
            )


def test_the_lines_of_a_map_are_named_by_what_is_neutral_there():
    case = pp.load_case("xv15-uncoupled")
    axes = {"airspeed": np.arange(340, 421, 20) * KNOT, "rotor.precone": np.deg2rad([1.0, 1.5, 2.0])}
    for line in boundary_lines(case, case.stability_map(axes)):
        middle = len(line.x) // 2
        modes = case.vary({"rotor.precone": line.y[middle]}).sweep([line.x[middle]]).isel(airspeed=0)
        found = modes.sel(mode=line.mode)
        assert abs(found.eigenvalue.real.item()) < 1e-3
        assert found.frequency.item() == pytest.approx(line.frequency[middle], rel=1e-3)


def test_a_study_names_modes_as_a_sweep_does():
    case, speeds = pp.load_case("xv15-uncoupled"), np.arange(60, 180, 20.0)
    found = pp.study(case, {"rotor.precone": np.deg2rad([1.0, 2.5])}, speeds, ["modes", "flutter"], workers=1)
    for design, precone in enumerate(np.deg2rad([1.0, 2.5])):
        sweep = case.vary({"rotor.precone": precone}).sweep(speeds)
        for point in range(len(speeds)):
            names = found.mode_name.values[design, point]
            values = found.mode_eigenvalue.values[design, point]
            for name, value in zip(names, values, strict=True):
                if value.imag > 0:
                    wanted = sweep.eigenvalue.sel(mode=name).values[point]
                    assert value == pytest.approx(wanted, rel=1e-9)


# Beam wings ---------------------------------------------------------------------------------------------------------

CHORD, AXIAL = "support.chord_stiffness", "support.axial_stiffness"


@pytest.fixture(scope="module")
def wing():
    return pp.load_case("xv15-wing")


def test_a_beam_wing_in_company_is_what_it_is_alone(wing):
    """The wing's chord mode lies below its beam mode in some of the designs, above it in others."""
    stiffness = np.array([1.0, 0.15, 2.0, 0.3]) * wing.given[CHORD].si
    model = wing.vary({CHORD: stiffness}).linearize(120.0)
    values, found = named(model)
    orders = set()
    for design, value in enumerate(stiffness):
        alone = wing.vary({CHORD: float(value)})
        own, names = named(alone.linearize(np.array([120.0])))
        orders.add(alone.support.names[:2])
        for name in names.known:
            one, other = (
                v[n == name] for v, n in ((own[0], names.names[0]), (values[design], found.names[design]))
            )
            np.testing.assert_allclose(np.sort_complex(one), np.sort_complex(other), rtol=1e-8, atol=1e-8)
            place, own_place = found.known.index(name), names.known.index(name)
            assert found.share[design, found.place[design] == place] == pytest.approx(
                names.share[0, names.place[0] == own_place], abs=1e-8
            )
    assert orders == {("beam", "chord"), ("chord", "beam")}
    assert not model.trim.warning.any()


def test_a_sweep_over_the_chord_stiffness_follows_the_roots_where_beam_and_chord_swap(wing):
    """The judge follows roots alone, without vectors, in steps small enough that the nearest is the next."""
    ends = np.array([0.28, 0.5]) * wing.given[CHORD].si
    dense = np.geomspace(*ends, 65)
    options = {"rotor_speed": "constant"}
    every = continued(roots(wing.vary({CHORD: dense}).linearize(120.0, **options)))
    coarse = wing.sweep(120.0, {CHORD: dense[::16]}, **options)
    assert coarse.tracking_quality.min() > POOR and not coarse.warning.any()
    names = {wing.vary({CHORD: float(value)}).support.names[:2] for value in ends}
    assert len(names) == 2
    judged = 0
    for branch in np.unique(coarse.branch.values):
        followed = coarse.eigenvalue.values[coarse.branch.values == branch]
        if "second root" in branch or not (followed.imag > 1.0).all():
            continue
        start = np.abs(every[0] - followed[0]).argmin()
        np.testing.assert_allclose(followed, every[::16, start], rtol=1e-8)
        judged += 1
    assert judged >= 12


def test_a_beam_wing_with_modes_of_other_kinds_says_so(wing):
    """With a stiff axis the sixth mode is a third one of the beam: it stands under the name of the case's own."""
    varied = wing.vary({AXIAL: np.array([1.0, 5.0]) * wing.given[AXIAL].si})
    assert "beam_3" in wing.vary({AXIAL: 5.0 * float(wing.given[AXIAL].si)}).support.names
    warning = varied.linearize(120.0).trim.warning
    assert (
        warning[0] == ""
        and warning[1] == "the wing has other modes than in the case's own design: beam_3 is named axial"
    )
    study = pp.study(wing, {AXIAL: np.array([1.0, 5.0]) * wing.given[AXIAL].si}, 120.0, workers=1)
    assert "beam_3" in str(study.warning.values[1])


def test_designs_of_a_beam_wing_flutter_in_company_as_they_do_alone(wing):
    """Whichever is the first of a batch, and of those that the search for a boundary still asks for."""
    stiffness, speeds = np.array([0.15, 1.0]) * wing.given[CHORD].si, np.arange(80.0, 200.0, 10.0)
    expected = {}
    for value in stiffness:
        point = wing.vary({CHORD: float(value)}).flutter_point(speeds, section_damping=False)
        first = next(found for found in point.boundaries if found.onset)
        expected[value] = point.mode, max(first.mechanism, key=first.mechanism.get), point.speed
    assert {mode for mode, *_ in expected.values()} == {"beam", "chord"}
    for order in (stiffness, stiffness[::-1]):
        found = pp.study(wing, {CHORD: order}, speeds, ("flutter",), workers=1, section_damping=False)
        for place, value in enumerate(order):
            mode, moves_most, speed = expected[value]
            assert found.flutter_mode.values[place] == mode
            assert found.flutter_coordinate.values[place] == moves_most
            assert found.flutter_speed.values[place] == pytest.approx(speed, abs=1e-4)


def test_vectors_of_a_study_are_those_of_the_coordinates_they_stand_under(wing):
    stiffness = np.array([0.15, 1.0]) * wing.given[CHORD].si
    found = pp.study(wing, {CHORD: stiffness}, 120.0, ("eigenvalue", "vectors"), workers=1)
    for place, value in enumerate(stiffness):
        alone = wing.vary({CHORD: float(value)}).linearize(120.0).modes()
        for root, shape in zip(alone.eigenvalue.values, alone["shape"], strict=True):
            if root.imag < 1.0:
                continue
            state = int(np.abs(found.eigenvalue.values[place] - root).argmin())
            own = found.vector[place].isel(state=state)
            for name in ("beam", "chord"):  # a shape of the wing has either sign
                assert abs(own.sel(dof=name).item()) == pytest.approx(
                    abs(shape.sel(dof=name).item()), abs=1e-6
                )


def test_branches_of_a_beam_wing_have_the_labels_of_the_anchor_wherever_a_line_begins(wing):
    own = float(wing.given[CHORD].si)
    options = {"rotor_speed": "constant"}
    along = wing.sweep(120.0, {CHORD: own * np.array([0.3, 1.0])}, **options)
    alone = wing.sweep([120.0], **options)
    for mode in ("beam", "chord"):
        assert along.branch.sel(mode=mode).values[1] == alone.branch.sel(mode=mode).values[0]


# Roots --------------------------------------------------------------------------------------------------------------


def test_a_sweep_by_branch_has_the_same_roots_each_in_one_place():
    case = pp.load_case("xv15-uncoupled")
    sweep = case.sweep("50:400:10kt")
    roots_of = by_branch(sweep)
    assert set(roots_of.branch.values) == {str(name) for name in np.unique(sweep.branch.values)}
    for point in range(sweep.sizes["airspeed"]):
        for place, branch in enumerate(sweep.branch.values[point]):
            root = roots_of.isel(airspeed=point).sel(branch=branch)
            assert root.eigenvalue.item() == sweep.eigenvalue.values[point, place]
            assert root.name.item() == sweep.mode.values[place]
    fine = case.sweep("50:400:1kt")
    steps = np.abs(np.diff(by_branch(fine).eigenvalue.values, axis=0))
    leap = np.nanmax(np.abs(np.diff(fine.eigenvalue.values, axis=0)))
    assert np.nanmax(steps) < 0.1 * leap


def test_a_step_of_no_quality_is_a_warning_of_a_study():
    """Steps of 60 kt leave out where roots meet."""
    case, speeds = pp.load_case("xv15-uncoupled"), np.array([60.0, 91.0, 122.0, 153.0, 184.0])
    found = pp.study(case, {"rotor.precone": [0.03, 0.05]}, speeds, "modes", workers=1)
    lost = (found.mode_quality <= 0).any("state")
    assert lost.any() and not lost.all()
    for design, point in np.ndindex(lost.shape):
        assert ("which root is which" in str(found.warning.values[design, point])) == lost.values[
            design, point
        ]


# One name for one mode -----------------------------------------------------------------------------------------------


def _options(fewest):
    """Every set of so many locked motions or more, with every way in which air and lift may have states."""
    ways = [{}, {"inflow": "dynamic"}, {"lift": "lagged"}, {"airloads": "none"}, {"pitch": "rigid"}]
    for count in range(fewest, len(LOCKABLE) + 1):
        for locked in combinations(LOCKABLE, count):
            for way in ways:
                yield {"locked": locked, **way}


@pytest.mark.parametrize(("deck", "fewest"), [("xv15-uncoupled", 0), ("xv15-aircraft", 4)])
def test_no_two_modes_of_a_point_have_one_name(deck, fewest):
    """Names are counted point by point; sweeps and single models have the same ones for the same eigenvalues."""
    case, seconds = pp.load_case(deck), 0
    for options in _options(fewest):
        try:
            model = case.linearize(airspeeds(case, 3), **options)
        except pp.InputError:  # options that exclude each other, such as rigid pitch that is locked
            continue
        found = model.modes()
        for names, values in zip(found.name.values, found.eigenvalue.values, strict=True):
            there = [name for name, value in zip(names, values, strict=True) if np.isfinite(value)]
            assert "" not in there and len(set(there)) == len(there), options
            for name in there:
                if name.endswith(SECOND):
                    seconds += 1
                    first, second = (
                        values[names.tolist().index(one)] for one in (name.removesuffix(SECOND), name)
                    )
                    assert first.imag == second.imag == 0 and second.real <= first.real
    assert seconds


@pytest.mark.parametrize("options", [{"inflow": "dynamic", "locked": LOCKABLE}, {"lift": "lagged"}, {}])
def test_a_single_model_and_a_sweep_have_the_same_names(options):
    case = pp.load_case("xv15")
    speeds = airspeeds(case, 5)
    swept, alone = case.sweep(speeds, **options), case.linearize(speeds, **options).modes()
    for row in range(len(speeds)):
        wanted = dict(zip(swept.mode.values.tolist(), swept.eigenvalue.values[row], strict=True))
        wanted = {name: value for name, value in wanted.items() if np.isfinite(value)}
        found = dict(zip(alone.name.values[row].tolist(), alone.eigenvalue.values[row], strict=True))
        found.pop("", None)
        assert found.keys() == wanted.keys()
        for name, value in found.items():
            assert value == pytest.approx(wanted[name], rel=1e-9, abs=1e-9)
