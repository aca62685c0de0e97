"""Chains of beam elements against another engine, closed forms, a Ritz model and the mass of rigid bodies."""

import numpy as np
import pytest
from pystran import beam, model, section
from scipy.optimize import brentq
from scipy.special import iv, jv

from proprotor.errors import InputError
from proprotor.support.beam import BeamProperties, beam_chain, rigid_motion, section_motions
from proprotor.support.modal_reduction import lowest_modes

ENGINE = 1e-10  # of another engine's largest entry; 4e-15 in fact
EXACT = 1e-12  # sums that differ in their order alone
L, EI, EIC, GJ, EA, M, IT = 5.0, 2.1e6, 6.3e6, 1.6e6, 1e9, 50.0, 3.0
UNIFORM = dict(
    beam_stiffness=EI,
    chord_stiffness=EIC,
    torsion_stiffness=GJ,
    axial_stiffness=EA,
    mass_per_length=M,
    torsional_inertia_per_length=IT,
)
PARTS = ("beam", "chord", "torsion", "axial")


def along_j(elements, length=L):
    return np.linspace(0, length, elements + 1)[:, None] * np.eye(3)[1]


def cantilever(positions, **changed):
    """Mass and stiffness of a chain that is held at its first node."""
    mass, parts = beam_chain(positions, BeamProperties(**UNIFORM | changed))
    return mass[..., 6:, 6:], sum(parts.values())[..., 6:, 6:]


def frequencies(*matrices):
    return lowest_modes(*matrices).frequency


def nearest(values, expected):
    return values[np.abs(values[:, None] - expected).argmin(axis=0)]


def random_chain(seed, elements=4, **more):
    """Nodes along a bent line outboard, and properties that differ from node to node."""
    rng = np.random.default_rng(seed)
    steps = np.stack(
        [rng.uniform(-0.4, 0.4, elements), rng.uniform(0.5, 1.5, elements), rng.uniform(-0.6, 0.6, elements)]
    )
    positions = rng.uniform(-1, 1, 3) + np.concatenate([np.zeros((1, 3)), np.cumsum(steps.T, axis=0)])
    given = {name: value * rng.uniform(0.5, 2.0, elements + 1) for name, value in UNIFORM.items()}
    given |= {name: rng.uniform(-0.4, 0.4, elements + 1) for name in ("mass_up", "mass_forward")}
    return positions, given | more, rng


# Another engine


@pytest.mark.parametrize("seed", range(5))
def test_a_straight_beam_of_constant_properties_is_that_of_another_engine(seed):
    """pystran: axes by the same rule, any direction of the beam but up."""
    rng = np.random.default_rng(seed)
    given = {name: value * rng.uniform(0.5, 2.0) for name, value in UNIFORM.items()}
    direction = np.array([rng.uniform(-1, 1), rng.uniform(0.5, 1), rng.uniform(-1, 1)])
    positions = rng.uniform(-1, 1, 3) + np.linspace(0, rng.uniform(1, 6), 4)[:, None] * direction
    mass, parts = beam_chain(positions, BeamProperties(**given))
    for found, expected in zip((mass, *parts.values()), pystran_chain(positions, given), strict=True):
        np.testing.assert_allclose(found, expected, rtol=0, atol=ENGINE * np.abs(expected).max())


def pystran_chain(positions, given):
    """Mass, and the beam, chord, torsion and axial stiffness; pystran has x along the beam, z up and y forward."""
    sections = (
        dict(rho=1.0, A=given["mass_per_length"], Ix=given["torsional_inertia_per_length"]),
        dict(E=1.0, Iy=given["beam_stiffness"]),
        dict(E=1.0, Iz=given["chord_stiffness"]),
        dict(G=1.0, J=given["torsion_stiffness"]),
        dict(E=1.0, A=given["axial_stiffness"]),
    )
    frame, count = model.create(3), len(positions)
    for node, position in enumerate(positions):
        model.add_joint(frame, node, position, dof=6 * node + np.arange(6))
    for place, properties in enumerate(sections):
        matrix = np.zeros((6 * count, 6 * count))
        member = {"section": section.beam_3d_section("own", xz_vector=np.eye(3)[0], **properties)}
        assemble = beam.assemble_stiffness if place else beam.assemble_mass
        for node in range(count - 1):
            assemble(matrix, member, frame["joints"][node], frame["joints"][node + 1])
        yield matrix


# Closed forms


def test_a_uniform_cantilever():
    """(βL)² of cos βL cosh βL = -1, and odd multiples of π/2 in torsion and extension."""
    found = frequencies(*cantilever(along_j(32)))
    for stiffness in (EI, EIC):
        unit = np.sqrt(stiffness / (M * L**4))
        expected = np.array([3.5160, 22.0345, 61.6972])
        np.testing.assert_allclose(nearest(found, expected * unit) / unit, expected, rtol=1e-5)
    for stiffness, inertia in ((GJ, IT), (EA, M)):
        expected = np.pi / (2 * L) * np.sqrt(stiffness / inertia)
        assert nearest(found, [expected])[0] == pytest.approx(
            expected, rel=1.1e-4
        )  # (π/64)²/24, linear twist


def test_a_cantilever_with_a_mass_at_its_tip():
    ratio = 0.7  # of the mass of the beam
    mass, stiffness = cantilever(along_j(24))
    for axis in range(3):
        mass[axis - 6, axis - 6] += ratio * M * L

    def condition(x):
        return 1 + np.cos(x) * np.cosh(x) + ratio * x * (np.cos(x) * np.sinh(x) - np.sin(x) * np.cosh(x))

    expected = brentq(condition, 0.5, 1.8) ** 2 * np.sqrt(EI / (M * L**4))
    assert nearest(frequencies(mass, stiffness), [expected])[0] == pytest.approx(expected, rel=1e-7)


def test_a_wedge_has_the_frequencies_of_kirchhoff():
    """Depth linear to a point: J₁(z) I₂(z) + I₁(z) J₂(z) = 0 and ω = z²/4 √(EI/mL⁴), 5.315 at first."""
    roots = [
        brentq(lambda z: jv(1, z) * iv(2, z) + iv(1, z) * jv(2, z), *ends) for ends in ((4, 5), (7, 8.5))
    ]
    expected = np.array(roots) ** 2 / 4
    np.testing.assert_allclose(expected, [5.315, 15.21], atol=5e-3)

    def found(elements):
        depth = np.maximum(np.linspace(1, 0, elements + 1), 1e-6)
        own = dict(beam_stiffness=EI * depth**3, mass_per_length=M * depth)
        return nearest(frequencies(*cantilever(along_j(elements), **own)), expected * np.sqrt(EI / M) / L**2)

    coarse, fine = (found(elements) / np.sqrt(EI / M) * L**2 for elements in (32, 64))
    np.testing.assert_allclose(fine, expected, rtol=2e-3)
    np.testing.assert_allclose((4 * fine - coarse) / 3, expected, rtol=2e-4)  # linear between nodes: order h²


def test_a_tapered_cantilever_bends_as_its_integral():
    """δ = P ∫ (L - y)²/EI dy with EI linear, in closed form with c of EI lost at the tip."""
    lost, elements = 0.75, 32
    _, stiffness = cantilever(along_j(elements), beam_stiffness=EI * np.linspace(1, 1 - lost, elements + 1))
    load = np.zeros(len(stiffness))
    load[-6] = 1.0
    found = np.linalg.solve(stiffness, load)[-6]
    left = (1 - lost) / lost  # ∫₀¹ s²/(s + left) ds / lost, s from the tip
    expected = L**3 / EI / lost * (0.5 - left + left**2 * np.log((1 + left) / left))
    assert found == pytest.approx(expected, rel=1e-6)


def test_a_load_beside_the_shear_centre_twists():
    """The nodes lie ahead of the elastic axis: a load up on the last node raises the tip, and noses it up."""
    ahead = 0.3
    mass, parts = beam_chain(along_j(3), BeamProperties(**UNIFORM), elastic_axis=[0.0, 0.0, -ahead])
    load = np.zeros(len(mass))
    load[-6] = 1.0
    moved = np.linalg.solve(sum(parts.values())[6:, 6:], load[6:])
    assert moved[-2] == pytest.approx(ahead * L / GJ, rel=1e-9)
    assert moved[-6] == pytest.approx(L**3 / (3 * EI) + ahead**2 * L / GJ, rel=1e-9)


# Coupling of bending and torsion


def test_an_offset_mass_couples_bending_and_torsion_as_in_a_ritz_model():
    """Polynomials of order 3 to 16 from a kinetic energy written down anew; all properties linear along the beam."""
    ends = {name: value * np.array([1.0, 0.6]) for name, value in UNIFORM.items()}
    offset = dict(mass_up=0.21, mass_forward=-0.34)
    expected = ritz_frequencies(**ends, **offset)[:6]

    def found(elements):
        given = {name: np.linspace(*value, elements + 1) for name, value in ends.items()}
        return frequencies(*cantilever(along_j(elements), **given | offset))[:6]

    coarse, fine = found(32), found(64)
    np.testing.assert_allclose((4 * fine - coarse) / 3, expected, rtol=1e-6)
    without = ritz_frequencies(**ends, mass_up=0.0, mass_forward=0.0)[:6]
    assert (np.abs(expected / without - 1) > 1e-3).all()


def ritz_frequencies(mass_up, mass_forward, **ends):
    """Frequencies of a cantilever: each displacement and the twist a polynomial in y/L that is held at the root."""
    points, weights = np.polynomial.legendre.leggauss(40)
    y, weights = L * (1 + points) / 2, L * weights / 2
    at = {name: inner + (outer - inner) * y / L for name, (inner, outer) in ends.items()}
    bending, straight = (shapes(y, first) for first in (2, 1))
    count = len(bending[0])

    def placed(kind, functions):
        rows = np.zeros((4 * count, len(y)))
        rows[kind * count : (kind + 1) * count] = functions
        return rows

    (up, up_slope, up_bent), (ahead, ahead_slope, ahead_bent) = (
        [placed(kind, part) for part in bending] for kind in (0, 1)
    )
    (out, out_slope, _), (twist, twist_slope, _) = (
        [placed(kind, part) for part in straight] for kind in (2, 3)
    )
    # A nose-up twist lifts a mass ahead and moves a mass above back; where the beam slopes up, a mass above goes in.
    moving = (
        (at["mass_per_length"], up + mass_forward * twist),
        (at["mass_per_length"], ahead - mass_up * twist),
        (at["mass_per_length"], out - mass_up * up_slope - mass_forward * ahead_slope),
        (at["torsional_inertia_per_length"], twist),
    )
    strained = (
        (at["beam_stiffness"], up_bent),
        (at["chord_stiffness"], ahead_bent),
        (at["torsion_stiffness"], twist_slope),
        (at["axial_stiffness"], out_slope),
    )
    mass, stiffness = (sum((p * w * weights) @ p.T for w, p in parts) for parts in (moving, strained))
    factor = np.linalg.inv(np.linalg.cholesky(mass))
    return np.sqrt(np.linalg.eigvalsh(factor @ stiffness @ factor.T))


def shapes(y, first, count=14):
    """Legendre polynomials times (y/L)^first, with two derivatives along y."""
    stretched = [np.polynomial.Polynomial([0, 1 / L]) ** first * legendre(k) for k in range(count)]
    return [np.array([shape.deriv(order)(y) for shape in stretched]) for order in range(3)]


def legendre(k):
    return np.polynomial.Legendre.basis(k, domain=[0, L]).convert(kind=np.polynomial.Polynomial)


# Rigid motions


def moved(offset):
    """Motion of a point of a rigid body per motion of its origin: ω × r, written out."""
    x, y, z = offset
    matrix = np.eye(6)
    matrix[:3, 3:] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]
    return matrix


@pytest.mark.parametrize("seed", range(3))
def test_a_rigid_motion_has_no_strain_and_the_mass_of_a_rigid_body(seed):
    """Total mass, first moments and inertia tensor of a bent, tapered chain with masses beside it, on rigid arms."""
    positions, given, rng = random_chain(seed)
    arms = rng.uniform(-0.3, 0.3, positions.shape)
    mass, parts = beam_chain(positions, BeamProperties(**given), elastic_axis=arms)
    motion = np.vstack([moved(position) for position in positions])
    for part in parts.values():
        np.testing.assert_allclose(part @ motion, 0, atol=1e-10 * np.abs(part).max())
    expected = rigid_mass(positions + arms, given)
    np.testing.assert_allclose(
        motion.T @ mass @ motion, expected, rtol=0, atol=EXACT * np.abs(expected).max()
    )


def rigid_mass(axis, given):
    """Mass (6, 6) about the origin; from each node on the mass and its offset fade out linearly to the next node."""
    points, weights = np.polynomial.legendre.leggauss(3)
    total = np.zeros((6, 6))
    for element in range(len(axis) - 1):
        step = axis[element + 1] - axis[element]
        length = np.linalg.norm(step)
        along = step / length
        up = np.array([1.0, 0.0, 0.0]) - along[0] * along
        up /= np.linalg.norm(up)
        ahead = np.cross(up, along)
        for place, weight in zip((1 + points) / 2, length * weights / 2, strict=True):
            for node, share in ((element, 1 - place), (element + 1, place)):
                at = (
                    axis[element]
                    + place * step
                    + given["mass_up"][node] * up
                    + given["mass_forward"][node] * ahead
                )
                point = moved(at)[:3]
                total += weight * share * given["mass_per_length"][node] * point.T @ point
                turn = np.outer(along, along) * given["torsional_inertia_per_length"][node]
                total[3:, 3:] += weight * share * turn
    return total


# Refinement


@pytest.mark.parametrize("seed", range(2))
def test_a_finer_mesh_has_the_energies_of_a_coarse_one(seed):
    """Moved as the coarse element moves, elements of half the length have its strain and kinetic energy."""
    constant = dict(
        mass_up=0.23, mass_forward=-0.31
    )  # so that the moments are linear along the coarse element
    positions, given, _ = random_chain(seed, elements=1, **constant)
    middle = section_motions(positions, np.array([0.5]))[0, 0]
    motion = np.vstack([np.eye(6, 12), middle, np.eye(6, 12, 6)])
    halves = {
        name: value if name in constant else np.insert(value, 1, value.mean())
        for name, value in given.items()
    }
    coarse = beam_chain(positions, BeamProperties(**given))
    fine = beam_chain(np.insert(positions, 1, positions.mean(axis=0), axis=0), BeamProperties(**halves))
    for name, whole, split in pairs(coarse, fine):
        np.testing.assert_allclose(
            motion.T @ split @ motion, whole, rtol=0, atol=EXACT * np.abs(whole).max(), err_msg=name
        )


def pairs(one, other):
    yield "mass", one[0], other[0]
    for name in PARTS:
        yield name, one[1][name], other[1][name]


def test_the_motion_within_an_element_is_that_of_its_nodes_at_its_ends():
    positions, *_ = random_chain(3)
    ends = section_motions(positions, np.array([0.0, 1.0]))
    np.testing.assert_allclose(ends[:, 0], np.broadcast_to(np.eye(6, 12), (4, 6, 12)), atol=1e-14)
    np.testing.assert_allclose(ends[:, 1], np.broadcast_to(np.eye(6, 12, 6), (4, 6, 12)), atol=1e-14)


# Batches and complex steps


def test_a_batch_is_each_of_its_chains_to_the_last_bit():
    chains = [random_chain(seed) for seed in range(3)]
    together = {name: np.stack([given[name] for _, given, _ in chains]) for name in chains[0][1]}
    mass, parts = beam_chain(np.stack([positions for positions, *_ in chains]), BeamProperties(**together))
    for place, (positions, given, _) in enumerate(chains):
        alone, own = beam_chain(positions, BeamProperties(**given))
        np.testing.assert_array_equal(mass[place], alone)
        for name in PARTS:
            np.testing.assert_array_equal(parts[name][place], own[name])


def test_complex_steps_are_central_differences():
    positions, given, rng = random_chain(4)
    arms = rng.uniform(-0.3, 0.3, positions.shape)
    direction = {name: value * rng.uniform(-1, 1, value.shape) for name, value in given.items()}
    step, turn, shift = 1e-5, rng.uniform(-1, 1, positions.shape), rng.uniform(-1, 1, positions.shape)

    def at(h):
        properties = {name: value + h * direction[name] for name, value in given.items()}
        return beam_chain(positions + h * turn, BeamProperties(**properties), elastic_axis=arms + h * shift)

    exact = at(1e-30j)
    for name, forward, back in pairs(at(step), at(-step)):
        derivative = np.imag(exact[0] if name == "mass" else exact[1][name]) / 1e-30
        difference = (forward - back) / (2 * step)
        np.testing.assert_allclose(derivative, difference, rtol=0, atol=1e-8 * np.abs(difference).max())


# What cannot be


@pytest.mark.parametrize(
    ("positions", "changed", "more", "message"),
    [
        (along_j(2), {"beam_stiffness": 0.0}, {}, "beam_stiffness = 0.0: must be above zero"),
        (
            along_j(2),
            {"mass_per_length": [1.0, -1.0, 1.0]},
            {},
            r"mass_per_length = .*: must not be negative",
        ),
        (along_j(2), {"mass_up": np.nan}, {}, "mass_up = nan: must be finite"),
        (
            along_j(2),
            {"mass_up": [0.1, 0.2]},
            {},
            r"mass_up = array .*: must have a value for each of 3 nodes",
        ),
        (np.zeros((2, 3)), {}, {}, "positions: must differ from each node to the next"),
        (along_j(2), {}, {"up": [0.0, 1.0, 0.0]}, "up = .*: must not point along an element"),
    ],
)
def test_a_chain_that_cannot_be(positions, changed, more, message):
    with pytest.raises(InputError, match=f"^{message}"):
        beam_chain(positions, BeamProperties(**UNIFORM | changed), **more)


def test_a_point_of_a_rigid_body():
    np.testing.assert_array_equal(rigid_motion([1.0, 2.0, 3.0]), moved([1.0, 2.0, 3.0]))
