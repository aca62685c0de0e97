"""NASA TN D-659 (Reed and Bland, 1961): backward whirl of a propeller on a two-axis pivot."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

import proprotor as pp
from benchmarks import propeller_strips
from benchmarks import reed_bland as report
from proprotor.errors import InputError
from proprotor.model.first_order import state_matrix
from proprotor.model.mount import mount
from proprotor.model.rigid_propeller import WhirlDerivatives, rigid_propeller
from proprotor.model.structural_damping import neutral_damping
from proprotor.rotor.motions import HUB
from proprotor.stability.sweep import sweep
from proprotor.support.normal_modes import two_axis_pivot

RATIOS = tuple(report.CHART)
J = report.CHART_ADVANCE_RATIOS
TRANSVERSE = [HUB.index(name) for name in ("x", "y", "alpha_x", "alpha_y")]


def reported_propeller():
    return report.propeller(J, report.reported_derivatives(J))


def small_propeller(airspeed, derivatives=None, **instead):
    """A propeller of round numbers, with the report's derivatives."""
    given = {"radius": 2.0, "rotor_speed": 30.0, "density": 1.0, "mass": 40.0, "polar_inertia": 60.0}
    given |= {"diametral_inertia": 30.0} | instead
    return rigid_propeller(airspeed, derivatives or report.reported_derivatives(1.8), **given)


def reported_points(ratio):
    model = reported_propeller()
    return report.neutral(model, ratio)


# The report's propeller -------------------------------------------------------------------------------------


@pytest.mark.parametrize("ratio", RATIOS)
def test_the_chart(ratio):
    chart = report.CHART[ratio]
    tolerance = np.maximum(report.CHART_RELATIVE * chart, report.CHART_ABSOLUTE)
    assert np.all(np.abs(reported_points(ratio).damping[:, 0] - chart) < tolerance)


def equations_of_the_report(s, g, j, ratio):
    """The report's pitch and yaw equations, in its own axes and as it prints them; ω_θ = R = I_Y = 1."""
    z_theta, z_psi, z_r, m_psi, m_q = (float(value) for value in report.reported_derivatives(j))
    V, Omega = report.REDUCED_SPEED, np.pi * report.REDUCED_SPEED / j
    I_X = report.POLAR_INERTIA / report.PIVOT_INERTIA
    rho_S = report.DENSITY * np.pi * report.RADIUS**5 / report.PIVOT_INERTIA
    l = report.PIVOT_DISTANCE / report.RADIUS  # noqa: E741
    bar = 1 - l * s / V
    F_Z = rho_S * V**2 / 2 * np.array([z_theta * bar, z_psi * bar + z_r * s / V])
    F_Y = rho_S * V**2 / 2 * np.array([z_psi * bar + z_r * s / V, -z_theta * bar])
    M_Y = rho_S * V**2 * np.array([m_q * s / V, m_psi * bar])
    M_Z = rho_S * V**2 * np.array([-m_psi * bar, m_q * s / V])
    pitch = np.array([s**2 + 1 + 1j * g, I_X * Omega * s]) - M_Y + l * F_Z
    yaw = np.array([-I_X * Omega * s, s**2 + ratio * (1 + 1j * g)]) - M_Z - l * F_Y
    return np.array([pitch, yaw])


@pytest.mark.parametrize("ratio", RATIOS)
def test_the_equations_as_the_report_prints_them(ratio):
    """Every neutral oscillation solves them with its own shape, forward whirl too: axes and signs agree."""
    points = reported_points(ratio)
    for place, found in np.argwhere(np.isfinite(points.damping)):
        omega = points.frequency[place, found] / report.PITCH_FREQUENCY
        equations = equations_of_the_report(1j * omega, points.damping[place, found], J[place], ratio)
        np.testing.assert_allclose(equations @ points.shape[place, found], 0, atol=1e-9)


@pytest.mark.parametrize("ratio", RATIOS)
def test_backward_whirl_is_the_one_that_needs_damping(ratio):
    points = reported_points(ratio)
    assert np.all(np.isfinite(points.damping).sum(axis=-1) == 2)
    assert np.all(points.damping[:, 0] > 0) and np.all(report.whirl(points.shape[:, 0]) == -1)
    assert np.all(points.damping[:, 1] < 0) and np.all(report.whirl(points.shape[:, 1]) == 1)
    assert np.all(points.frequency[:, 0] < points.frequency[:, 1])


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize(("factor", "backward"), [(0.9, -1), (1.0, 0), (1.1, 1)])
def test_neutral_among_all_modes(ratio, factor, backward):
    """At one frequency a structural damping is a viscous one, and the eigenvalues say the same."""
    model = reported_propeller()
    points = report.neutral(model, ratio)
    for place in range(len(J)):
        support = report.pivot(ratio, factor * points.damping[place, 0], points.frequency[place, 0])
        modes = mount(model, support).modes().isel(airspeed=place)
        low, high = modes.damping_ratio.values
        assert high > 0.01
        assert np.sign(np.round(low, 9)) == backward
        assert report.whirl(modes.shape.values[0]) == -1
        assert report.whirl(modes.shape.values[1]) == 1


def test_the_slow_mode_of_a_spinning_body_whirls_backward_in_a_vacuum():
    model = small_propeller(0.0, density=0.0)
    modes = mount(model, two_axis_pivot(0.8, (50.0, 50.0), (4e4, 4e4), includes_rotor=False)).modes()
    inertia, momentum = 50 + 30 + 40 * 0.8**2, 60 * 30.0
    expected = np.abs(np.roots([inertia, momentum, -4e4]))
    np.testing.assert_allclose(modes.frequency, np.sort(expected), rtol=1e-12)
    assert list(report.whirl(modes.shape.values)) == [-1, 1]


def test_the_share_of_the_propeller_in_the_pivot_inertia_does_not_matter():
    heavy, light = (report.propeller(J, report.reported_derivatives(J), mass) for mass in (200.0, 0.0))
    support = report.pivot(1.96)
    np.testing.assert_allclose(mount(heavy, support).M, mount(light, support).M, rtol=1e-12)


# In a rotor's place -----------------------------------------------------------------------------------------


def test_one_array_of_airspeeds_or_many_numbers():
    speeds = np.linspace(0.0, 120.0, 7)
    model = small_propeller(speeds)
    for place, speed in enumerate(speeds):
        one = small_propeller(speed)
        for name in "MCK":
            np.testing.assert_array_equal(getattr(model, name)[place], getattr(one, name))
    modes = sweep(mount(model, two_axis_pivot(0.8, (50.0, 50.0), (4e4, 6e4), includes_rotor=False)))
    assert modes.frequency.shape == (7, 2)
    assert np.all(modes.reason == "")


def test_what_is_refused():
    model, support = reported_propeller(), report.pivot(1.0)
    with pytest.raises(InputError, match="mass_at_rest: must be given with the model"):
        mount(replace(model, mass_at_rest=None), support)
    with pytest.raises(InputError, match="dofs = x, y: must begin with x, y, z, alpha_x"):
        mount(model.submodel(("x", "y")), support)
    with pytest.raises(InputError, match=r"springs = .*: must be invertible on pitch, yaw"):
        neutral_damping(mount(model, support), np.diag([1.0, 0.0]))
    with pytest.raises(InputError, match=r"diametral_inertia = -1\.0: must not be negative"):
        small_propeller(50.0, diametral_inertia=-1.0)
    with pytest.raises(InputError, match="m_q = nan: must be finite"):
        small_propeller(50.0, WhirlDerivatives(-0.4, 0.1, -0.2, 0.1, np.nan))
    with pytest.raises(InputError, match=r"inertia = .*: must have the shape"):
        two_axis_pivot(1.0, (1.0, 1.0, 1.0), (1.0, 1.0), includes_rotor=False)


def test_viscous_damping_alone_and_failed_points():
    """Without rotation each axis is an oscillator, neutral where gS = -cω; a failed point finds nothing."""
    support = two_axis_pivot(0.5, (2.0, 3.0), (200.0, 1200.0), (1.0, 6.0), includes_rotor=True)
    model = small_propeller([0.0, 0.0], rotor_speed=0.0, mass=0.0, diametral_inertia=0.0)
    model.M[1], model.K[1] = np.nan, np.nan
    points = neutral_damping(mount(model, support), support.stiffness)
    np.testing.assert_allclose(points.damping[0, :2], [-0.05, -0.1], rtol=1e-9)
    np.testing.assert_allclose(points.frequency[0, :2], [10.0, 20.0], rtol=1e-9)
    assert np.isnan(points.damping[0, 2:]).all() and np.isnan(points.damping[1]).all()


def test_neutral_oscillations_of_any_model():
    """Random coupled matrices: each point found is an oscillation with structural damping, to rounding."""
    draw = np.random.default_rng(659).normal(size=(5, 40, 3, 3))
    mass, springs = (a @ np.swapaxes(a, -1, -2) + 0.3 * np.eye(3) for a in draw[:2])
    damping = 0.3 * draw[2] + draw[3] - np.swapaxes(draw[3], -1, -2)
    translations = small_propeller(np.zeros(40)).submodel(("x", "y", "z"))
    model = replace(translations, M=mass, C=damping, K=springs[0] + 0.5 * draw[4])
    points = neutral_damping(model, springs[0])
    found = np.isfinite(points.damping)
    assert np.all(found.any(axis=-1))
    for case, place in np.argwhere(found):
        g, omega, shape = (values[case, place] for values in points)
        stiffness = model.K[case] + 1j * g * springs[0]
        residual = (stiffness + 1j * omega * model.C[case] - omega**2 * model.M[case]) @ shape
        np.testing.assert_allclose(residual, 0, atol=1e-10 * np.abs(stiffness).max())


# The propeller as a rotor with everything locked ------------------------------------------------------------


def test_a_locked_rotor_in_a_vacuum_is_a_rigid_propeller():
    rotor = report.bladed_rotor(chord=0.4)
    operation = pp.Operation(rotor_speed=60.0, density=0.0, speed_of_sound=340.0, trim={"collective": 0.6})
    model = pp.rotor_model(rotor, operation, 50.0, **report.QUASI_STEADY)
    rigid = rigid_propeller(
        50.0,
        report.reported_derivatives(1.8),
        radius=rotor.radius,
        rotor_speed=60.0,
        density=0.0,
        mass=4 * rotor.blade_mass,
        polar_inertia=4 * rotor.blade_inertia,
        diametral_inertia=2 * rotor.blade_inertia,
    )
    assert model.dofs == rigid.dofs
    for name in "MCK":
        wanted = getattr(rigid, name)
        np.testing.assert_allclose(
            getattr(model, name), wanted, rtol=0, atol=1e-12 * np.abs(wanted).max() + 1e-9
        )


def strip_derivatives(rotor, j):
    """Quasi-steady strips without steady load: with x = r/R, λ = J/π and A_n = ∫ xⁿ/√(x² + λ²) dx,

    C_Zθ = -½σa λA₀,  C_Zr = -½σa A₂ = -2 C_mψ,  C_mq = -¼σa A₄/λ,  C_Zψ = 0,  σa = N c c_lα / (πR).
    """
    advance = j / np.pi
    root = rotor.root_cutout / rotor.radius
    A = [quad(lambda x, n=n: x**n / np.hypot(x, advance), root, 1, epsabs=1e-13)[0] for n in (0, 2, 4)]
    loading = rotor.n_blades * rotor.chord * rotor.airfoil.lift_slope / (np.pi * rotor.radius)
    return loading * np.array([-advance * A[0] / 2, 0, -A[1] / 2, A[1] / 4, -A[2] / advance / 4])


def test_derivatives_of_the_rotor_are_those_of_strips():
    rotor = report.bladed_rotor(chord=0.4)
    derivatives = np.array(report.rotor_derivatives(rotor, J, airloads="lift-slope"))
    expected = np.transpose([strip_derivatives(rotor, j) for j in J])
    np.testing.assert_allclose(derivatives, expected, rtol=1e-9, atol=1e-14)
    with_steady_loads = np.array(report.rotor_derivatives(rotor, J))
    np.testing.assert_allclose(with_steady_loads, expected, rtol=0.025, atol=1e-14)


def test_the_convention_of_the_report_holds_all_of_the_rotor():
    """Airloads rebuilt from the rotor's five derivatives are its own, in all entries across the shaft."""
    rotor = report.bladed_rotor(chord=0.4)
    still, moving = (report.rotor_on_hub(rotor, J, airloads=airloads) for airloads in ("none", "lift-slope"))
    derivatives = report.whirl_derivatives(
        moving.C - still.C, moving.K - still.K, report.AIRSPEED, report.RADIUS, report.DENSITY
    )
    rebuilt, unloaded = (
        report.propeller(J, WhirlDerivatives(*(f * d for d in derivatives))) for f in (1.0, 0.0)
    )
    across = np.ix_(range(len(J)), TRANSVERSE, TRANSVERSE)
    for name in "CK":
        own = (getattr(moving, name) - getattr(still, name))[across]
        other = (getattr(rebuilt, name) - getattr(unloaded, name))[across]
        np.testing.assert_allclose(other, own, rtol=0, atol=1e-9 * np.abs(own).max())


@pytest.mark.parametrize("ratio", RATIOS)
def test_the_lag_of_lift_is_what_quasi_steady_blades_lack(ratio):
    """Without the side force of yaw the report's own set needs as much more damping as the rotor does."""
    chart = report.CHART[ratio]
    without_side_force = report.chart_of_report(z_psi=0.0)[ratio] / chart - 1
    quasi_steady, lagging = (
        report.chart_of_blades(unsteady)[ratio] / chart - 1 for unsteady in (False, True)
    )
    assert np.all((without_side_force > 0.15) & (without_side_force < 0.4))
    assert np.all((quasi_steady > 0.15) & (quasi_steady < 0.35))
    assert np.all(np.abs(lagging) < 0.1)


def test_one_fitted_chord_gives_the_derivatives_at_every_blade_angle():
    reported = report.reported_derivatives(report.ADVANCE_RATIOS)
    rotor = report.fitted_rotor(unsteady=True)
    lift = report.lift_factor(rotor.chord, report.ADVANCE_RATIOS, unsteady=True)
    computed = report.rotor_derivatives(rotor, report.ADVANCE_RATIOS, lift)
    for name in ("z_theta", "z_psi", "z_r", "m_psi"):
        np.testing.assert_allclose(getattr(computed, name), getattr(reported, name), rtol=0.1)
    np.testing.assert_allclose(computed.m_q[:-1], reported.m_q[:-1], rtol=0.1)  # the last one is small
    quasi_steady = report.rotor_derivatives(report.fitted_rotor(unsteady=False), report.ADVANCE_RATIOS)
    np.testing.assert_allclose(quasi_steady.z_psi, 0, atol=1e-12)


def test_the_rotor_mounts_as_the_propeller_does():
    rotor = report.bladed_rotor(chord=0.4)
    model = report.rotor_on_hub(rotor, J)
    mounted = mount(model, report.pivot(1.0))
    assert mounted.dofs == ("pitch", "yaw")
    np.testing.assert_allclose(
        mounted.M, np.broadcast_to(report.PIVOT_INERTIA * np.eye(2), mounted.M.shape), rtol=1e-12, atol=1e-9
    )


# Lift that lags with states of its own ----------------------------------------------------------------------


def test_with_lag_of_one_change_a_turn_every_point_is_within_nine_per_cent():
    """The report's derivatives are those of a slow hub. The cutout, 0.2 R, was fixed before; the chord fits C_Zθ."""
    found = report.chart_with_lag()
    for ratio, chart in report.CHART.items():
        assert np.all(np.abs(found[ratio] / chart - 1) < 0.09)


@pytest.fixture(scope="module")
def with_states():
    return report.chart_with_states()


def test_the_lag_at_the_frequencies_of_the_whirl_takes_off_more(with_states):
    """Blades see the whirl at Ω ± ω, no longer near Ω where the rotor turns slowly: one point is beyond 9 per cent."""
    slow = report.chart_with_lag()
    for ratio, chart in report.CHART.items():
        assert np.all(with_states[ratio] < slow[ratio])
        assert np.all(np.abs(with_states[ratio][:-1] / chart[:-1] - 1) < 0.09)
    assert 0.15 < 1 - with_states[1.96][-1] / report.CHART[1.96][-1] < 0.2


@pytest.mark.parametrize("slow_hub", [True, False])
def test_strips_written_down_apart_need_the_same_damping(slow_hub):
    """Without steady load and with Jones' function the states are the strips, to what two shape functions leave."""
    chord = float(report.rotor_fitted_with_lag().chord)
    strips = report.chart_of_strips(propeller_strips.jones, slow_hub=slow_hub)
    for place, j in enumerate(J):
        r = np.linspace(0.05, 1.0, 96) * report.RADIUS
        unloaded = replace(report.bladed_rotor(chord), twist=(r, np.arctan(j * report.RADIUS / (np.pi * r))))
        alone = report.rotor_on_hub(unloaded, j, lift="lagged", airloads="lift-slope")
        for ratio in RATIOS:
            if slow_hub:
                found = report.neutral(report.at_one_per_turn(alone), ratio).damping[0]
            else:
                found = report.neutral_with_states(alone, ratio)
            assert found == pytest.approx(strips[ratio][place], rel=2e-3)


def test_strips_without_lag_are_the_quasi_steady_blades():
    chord = float(report.rotor_fitted_with_lag().chord)
    strips = report.chart_of_strips(propeller_strips.at_once)
    for place, j in enumerate(J):
        r = np.linspace(0.05, 1.0, 400) * report.RADIUS
        unloaded = replace(report.bladed_rotor(chord), twist=(r, np.arctan(j * report.RADIUS / (np.pi * r))))
        alone = report.rotor_on_hub(unloaded, j, airloads="lift-slope")
        for ratio in RATIOS:
            assert report.neutral(alone, ratio).damping[0] == pytest.approx(strips[ratio][place], rel=1e-4)


def test_the_one_point_is_missed_by_strips_with_the_function_itself_too():
    """What the chart has there is the lag of one change a turn: the frequency of the whirl makes the difference."""
    whirl, slow = (
        report.chart_of_strips(propeller_strips.theodorsen, slow_hub=slow_hub) for slow_hub in (False, True)
    )
    for ratio, chart in report.CHART.items():
        assert np.all(np.abs(slow[ratio] / chart - 1) < 0.09)
        assert np.all(np.abs(whirl[ratio][:-1] / chart[:-1] - 1) < 0.09)
    assert 0.15 < 1 - whirl[1.96][-1] / report.CHART[1.96][-1] < 0.2


@pytest.mark.parametrize("ratio", RATIOS)
def test_neutral_with_states_among_all_modes(ratio, with_states):
    """With a viscous damping that is the structural one at the frequency of the whirl, a root lies on the axis."""
    rotor = report.rotor_fitted_with_lag()
    for place, j in enumerate(J):
        alone = report.with_lag(rotor, j)
        omega = report.PITCH_FREQUENCY
        for _ in range(6):
            model = mount(alone, report.pivot(ratio, with_states[ratio][place], omega))
            roots = np.linalg.eigvals(state_matrix(model))
            slow = roots[(roots.imag > 0) & (np.abs(roots.imag - omega) < 6)]
            least = slow[np.abs(slow.real).argmin()]
            omega = least.imag
        assert abs(least.real) < 1e-5 * omega
