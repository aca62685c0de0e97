"""Rotors simple enough for a formula: rotating and fixed-frame frequencies, ground resonance, a rigid disk.

All in vacuum. Exact formulas are held to rounding: 1e-12 of one per rev or of the largest entry.
"""

from itertools import pairwise

import numpy as np
import pytest
from scipy.linalg import cholesky, eigvals, inv
from scipy.optimize import brentq

import proprotor as pp

RIGID = {"pitch": "rigid", "rotor_speed": "constant"}


def vacuum_model(rotor, speed, locked, collective=0.0, **options):
    operation = pp.Operation(
        rotor_speed=speed, density=0.0, speed_of_sound=340.0, trim={"collective": collective}
    )
    model = pp.rotor_model(rotor, operation, 0.0, airloads="none", locked=locked, **(RIGID | options))
    assert model.trim.converged, model.trim.reason
    return model


def part(model, *dofs):
    """M, C, K of some coordinates, the others held."""
    index = [model.dofs.index(name) for name in dofs]
    return tuple(getattr(model, name)[np.ix_(index, index)] for name in "MCK")


def roots(M, C, K):
    """Eigenvalues of M q̈ + C q̇ + K q = 0 with positive frequency, slowest first.

    Scaled to unit inertia, and time to the stiffest spring, so that rounding is that of numbers near one.
    """
    whiten = inv(cholesky(M, lower=True))
    C, K = whiten @ C @ whiten.T, whiten @ K @ whiten.T
    rate = np.sqrt(np.abs(K).max())
    zero, one = np.zeros_like(M), np.eye(len(M))
    s = rate * eigvals(np.block([[zero, one], [-K / rate**2, -C / rate]]))
    return sorted(s[s.imag > 0], key=lambda root: (root.imag, root.real))


def frequencies(M, C, K):
    return np.imag(roots(M, C, K))


# One blade motion at a time

N_BLADES, RADIUS, ROTOR_SPEED = 4, 3.8, 48.0
FLAP = ("flap_0", "flap_1c", "flap_1s")
LAG = ("lag_0", "lag_1c", "lag_1s")
GIMBAL = ("gimbal_1c", "gimbal_1s")


def uniform_rotor(hinge_offset=0.0, **fields):
    """Uniform blades, no precone, springs all inboard of the pitch bearing."""
    given = {
        "n_blades": N_BLADES,
        "radius": RADIUS,
        "flap_hinge_offset": hinge_offset,
        "lag_hinge_offset": hinge_offset,
        "precone": 0.0,
        "flap_stiffness": 3e5,
        "lag_stiffness": 9e5,
        "flap_outboard_fraction": 0.0,
        "lag_outboard_fraction": 0.0,
        "gimbal_stiffness": 2e4,
        "pitch_gimbal_coupling": 0.0,
        "pitch_inertia": 1.4,
        "control_stiffness": 3e4,
        "propeller_moment": False,
        "chord": 0.37,
        "twist": -0.6,
        "root_cutout": 0.4,
        "airfoil": pp.Airfoil(lift_slope=5.7),
    } | fields
    return pp.Rotor.from_mass_distribution(np.array([0.0, RADIUS]), np.array([7.0, 7.0]), **given)


def uniform_blade_inertia(hinge_offset=0.0):
    return 7.0 * (RADIUS - hinge_offset) ** 3 / 3


def per_rev_in_fixed_frame(nu, collective):
    """Cyclic coordinates see a blade mode of ν per rev at |ν − 1| and ν + 1, the collective at ν."""
    return sorted([abs(nu - 1), nu + 1] + [nu] * collective)


@pytest.mark.parametrize("gimbal_stiffness", [1.0, 2e4, 3e5])
def test_gimbal_is_a_tilting_disk(gimbal_stiffness):
    """ν² = 1 + K_G/((N/2) I_b Ω²)."""
    model = vacuum_model(uniform_rotor(gimbal_stiffness=gimbal_stiffness), ROTOR_SPEED, ("flap", "lag"))
    spring = gimbal_stiffness / (N_BLADES / 2 * uniform_blade_inertia() * ROTOR_SPEED**2)
    expected = per_rev_in_fixed_frame(np.sqrt(1 + spring), collective=False)
    assert np.allclose(frequencies(*part(model, *GIMBAL)) / ROTOR_SPEED, expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize("hinge", [0.0, 0.07, 0.3])
def test_flap_of_a_uniform_blade(hinge):
    """ν² = 1 + (3/2) ē + K/(IΩ²), ē = e/(R − e)."""
    offset = hinge * RADIUS
    model = vacuum_model(uniform_rotor(offset), ROTOR_SPEED, ("lag", "gimbal"))
    nu = np.sqrt(1 + 1.5 * hinge / (1 - hinge) + 3e5 / (uniform_blade_inertia(offset) * ROTOR_SPEED**2))
    expected = per_rev_in_fixed_frame(nu, collective=True)
    assert np.allclose(frequencies(*part(model, *FLAP)) / ROTOR_SPEED, expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize("hinge", [0.0, 0.07, 0.3])
@pytest.mark.parametrize("lag_stiffness", [1e4, 9e5])
def test_lag_of_a_uniform_blade(hinge, lag_stiffness):
    """ν² = (3/2) ē + K/(IΩ²), soft and stiff in-plane."""
    offset = hinge * RADIUS
    model = vacuum_model(uniform_rotor(offset, lag_stiffness=lag_stiffness), ROTOR_SPEED, ("flap", "gimbal"))
    nu = np.sqrt(1.5 * hinge / (1 - hinge) + lag_stiffness / (uniform_blade_inertia(offset) * ROTOR_SPEED**2))
    expected = per_rev_in_fixed_frame(nu, collective=True)
    assert np.allclose(frequencies(*part(model, *LAG)) / ROTOR_SPEED, expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize("collective", [0.0, 0.5, 1.1])
def test_pitch_feels_the_control_spring_and_the_propeller_moment(collective):
    """(K_θ + I_θ Ω² cos 2Θ)/I_θ, Θ the total trim pitch, where K_θ θ̄0 + ½ I_θ Ω² sin 2Θ = 0."""
    rotor = uniform_rotor(propeller_moment=True)
    model = vacuum_model(rotor, ROTOR_SPEED, ("flap", "lag", "gimbal"), collective, pitch="dynamic")
    twist = float(model.trim.elastic_pitch)
    total = collective + twist
    propeller_moment = 0.7 * ROTOR_SPEED**2  # largest
    assert abs(3e4 * twist + propeller_moment * np.sin(2 * total)) < 1e-11 * propeller_moment
    nu = np.sqrt(3e4 / 1.4 / ROTOR_SPEED**2 + np.cos(2 * total))
    expected = per_rev_in_fixed_frame(nu, collective=True)
    pitch = frequencies(*part(model, "pitch_0", "pitch_1c", "pitch_1s"))
    assert np.allclose(pitch / ROTOR_SPEED, expected, rtol=0, atol=1e-12)


# A rigid rotor


@pytest.mark.parametrize("precone", [0.0, 0.05])
def test_rigid_rotor_is_a_gyroscope(precone):
    """Coned rods: their inertia tensor about the hub, their raised mass centre and gyroscopic moment."""
    model = vacuum_model(uniform_rotor(precone=precone), ROTOR_SPEED, ("flap", "lag", "gimbal"))
    hub = ("x", "y", "z", "alpha_x", "alpha_y", "alpha_z")
    assert model.dofs == hub
    mass, first_moment, inertia = N_BLADES * 7.0 * np.array([RADIUS, RADIUS**2 / 2, RADIUS**3 / 3])
    polar = inertia * np.cos(precone) ** 2
    diametral = inertia * (np.cos(precone) ** 2 / 2 + np.sin(precone) ** 2)
    M, C, K = np.diag([mass, mass, mass, diametral, diametral, polar]), np.zeros((6, 6)), np.zeros((6, 6))
    height = first_moment * np.sin(precone)  # a tilt αy carries the mass centre along +x, αx along −y
    M[0, 4] = M[4, 0] = height
    M[1, 3] = M[3, 1] = -height
    C[3, 4], C[4, 3] = polar * ROTOR_SPEED, -polar * ROTOR_SPEED
    for name, actual, expected in zip("MCK", (model.M, model.C, model.K), (M, C, K), strict=True):
        scale = inertia * ROTOR_SPEED ** "MCK".index(name)
        assert np.allclose(actual, expected, rtol=0, atol=1e-12 * scale), name


def test_a_free_shaft_spins_all_the_polar_inertia():
    """With rigid blades αz and ψs turn the same masses."""
    model = vacuum_model(uniform_rotor(), ROTOR_SPEED, ("flap", "lag", "gimbal"), rotor_speed="windmilling")
    M, C, K = part(model, "alpha_z", "azimuth")
    polar = N_BLADES * uniform_blade_inertia()
    assert np.allclose(M, polar * np.ones((2, 2)), rtol=1e-13)
    assert np.abs(C).max() < 1e-12 * polar * ROTOR_SPEED
    assert np.abs(K).max() < 1e-12 * polar * ROTOR_SPEED**2


# Lagging blades on a hub that moves in its plane


def lagging_rotor(n_blades, mass, length, lag_stiffness, lag_damping=0.0):
    """Point masses on rods of `length`, lag hinges on the shaft."""
    return pp.Rotor(
        n_blades=n_blades,
        radius=length,
        flap_hinge_offset=0.0,
        lag_hinge_offset=0.0,
        precone=0.0,
        blade_mass=mass,
        blade_first_moment=mass * length,
        blade_inertia=mass * length**2,
        flap_first_moment=mass * length,
        flap_inertia=mass * length**2,
        lag_first_moment=mass * length,
        lag_inertia=mass * length**2,
        flap_stiffness=1.0,
        lag_stiffness=lag_stiffness,
        flap_outboard_fraction=0.0,
        lag_outboard_fraction=0.0,
        gimbal_stiffness=0.0,
        pitch_gimbal_coupling=0.0,
        pitch_inertia=1.0,
        control_stiffness=1.0,
        lag_damping=lag_damping,
        propeller_moment=False,
        chord=0.1,
        twist=0.0,
        root_cutout=0.1 * length,
        airfoil=pp.Airfoil(lift_slope=5.7),
    )


def on_in_plane_support(model, mass, damping, stiffness):
    """The lagging rotor on hub masses, dampers and springs along x and, given a second one, y."""
    hub = ("x", "y")[: len(mass)]
    M, C, K = part(model, *hub, *LAG)
    for axis in range(len(hub)):
        M[axis, axis] += mass[axis]
        C[axis, axis] += damping[axis]
        K[axis, axis] += stiffness[axis]
    return M, C, K


AT_REST = 1e-6  # the model asks for a turning rotor; this moves no frequency by more than itself
GROUND_RESONANCE = {
    AT_REST: [0.62311, 1.96807, 5.06413, 5.07023],
    3.0: [0.62306, 1.93997, 2.06423, 8.12449],
    4.0: [0.62289, 1.02747, 1.97204, 9.14955],
    7.0: [0.62326, 1.96817, 1.96817, 12.24220],
}
HALF_A_DIGIT = 5e-6


def three_lagging_blades(rotor_speed):
    """Hub 50000 on springs 2e5 and 2e4; three point masses 500 at 30, lagging at 1.6π rad/s at rest."""
    rotor = lagging_rotor(3, 500.0, 30.0, 500.0 * 30.0**2 * (1.6 * np.pi) ** 2)
    model = vacuum_model(rotor, rotor_speed, ("flap", "gimbal"))
    return roots(*on_in_plane_support(model, [50000.0] * 2, [0.0] * 2, [2e5, 2e4]))


@pytest.mark.parametrize("rotor_speed", GROUND_RESONANCE)
def test_ground_resonance_of_three_lagging_blades(rotor_speed):
    """Every printed digit of the frequencies, and the collective lag mode that no hub motion excites."""
    found = np.imag(three_lagging_blades(rotor_speed))
    expected = sorted([*GROUND_RESONANCE[rotor_speed], 1.6 * np.pi])
    assert np.allclose(found, expected, rtol=0, atol=HALF_A_DIGIT)


def test_ground_resonance_is_unstable_where_lag_and_hub_meet():
    growth = {speed: np.real(three_lagging_blades(speed)) for speed in GROUND_RESONANCE}
    rounding = 1e-10  # nothing is damped
    for speed in (AT_REST, 3.0, 4.0):
        assert np.abs(growth[speed]).max() < rounding
    assert np.allclose(sorted(growth[7.0][1:3]), [-0.05239, 0.05239], rtol=0, atol=HALF_A_DIGIT)
    assert np.abs(np.delete(growth[7.0], [1, 2])).max() < rounding


class Deutsch:
    """Blades that lag on a damped hub whose frequency meets the regressing lag mode: ω_x = (1 − ν_ζ)Ω.

    Deutsch: for weak coupling and one hub axis, c_x c_ζ = (N/4) S_ζ² ω_x² (1 − ν_ζ)/ν_ζ just holds ground
    resonance down. The mass ratio of blades to hub is the strength of the coupling; the damping is split so
    that the hub and the blades decay alike.
    """

    n_blades, rotor_speed, blade_mass, length = 4, 20.0, 5.0, 4.0

    def __init__(self, nu, mass_ratio, axes):
        self.axes = axes
        self.hub_mass = self.n_blades * self.blade_mass / mass_ratio
        self.hub_frequency = (1 - nu) * self.rotor_speed
        self.first_moment, self.inertia = self.blade_mass * self.length, self.blade_mass * self.length**2
        self.lag_stiffness = self.inertia * (nu * self.rotor_speed) ** 2
        self.closed_form = self.n_blades / 4 * self.first_moment**2 * self.hub_frequency**2 * (1 - nu) / nu

    def growth(self, product):
        """Largest growth rate with a damping product of `product` closed forms, per radian of the rotor."""
        root_product = np.sqrt(product * self.closed_form)
        lag_damping = root_product * np.sqrt(self.inertia / self.hub_mass)
        hub_damping = root_product * np.sqrt(self.hub_mass / self.inertia)
        rotor = lagging_rotor(self.n_blades, self.blade_mass, self.length, self.lag_stiffness, lag_damping)
        model = vacuum_model(rotor, self.rotor_speed, ("flap", "gimbal"))
        support_mass = self.hub_mass - self.n_blades * self.blade_mass
        matrices = on_in_plane_support(
            model,
            [support_mass] * self.axes,
            [hub_damping] * self.axes,
            [self.hub_mass * self.hub_frequency**2] * self.axes,
        )
        return max(np.real(roots(*matrices))) / self.rotor_speed

    def neutral_product(self):
        """Exact c_x c_ζ of neutral stability, in closed forms."""
        return brentq(self.growth, 0.5, 3.0, xtol=1e-14, rtol=1e-14)


@pytest.mark.parametrize("nu", [0.3, 0.6])
def test_deutsch_criterion_is_the_limit_of_weak_coupling(nu):
    """At a mass ratio μ the exact product is 1 + aμ + bμ² + cμ³ + … closed forms.

    Extrapolating twice from μ = 1e-2, 1e-3 and 1e-4 leaves 1e-9 c, where c is small (a is a few 1e-2, b a few
    1e-3 at most). At μ = 1e-4 the growth rate changes by 1e-3 per unit of the product; good to some 1e-16, it
    gives the product to some 1e-13. Both stay within 1e-11.
    """
    ratios = (1e-2, 1e-3, 1e-4)
    first = [Deutsch(nu, ratio, axes=1).neutral_product() for ratio in ratios]
    second = [(10 * weaker - stronger) / 9 for stronger, weaker in pairwise(first)]
    third = (100 * second[1] - second[0]) / 99
    assert 1e-3 < (first[0] - 1) / ratios[0] < 1e-1
    assert abs(third - 1) < 1e-11


@pytest.mark.parametrize("nu", [0.3, 0.6])
@pytest.mark.parametrize("mass_ratio", [0.3, 1e-2, 1e-4])
def test_isotropic_hub_needs_twice_the_product_at_any_coupling(nu, mass_ratio):
    """Forward and backward whirl part ways, and the backward pair is neutral at ω_x itself: it is exact."""
    assert abs(Deutsch(nu, mass_ratio, axes=2).neutral_product() - 2) < 1e-11
