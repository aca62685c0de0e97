"""A propeller on an elastic nacelle and ground resonance of hinged blades: every digit that their authors print."""

import numpy as np
import pytest

from benchmarks import published_systems as published

HALF_A_DIGIT = 5.001e-6  # of roots, which have five decimals


@pytest.mark.parametrize("airspeed", published.NACELLE_ROOTS)
def test_whirl_of_a_propeller_on_its_nacelle(airspeed):
    found = published.nacelle_roots(airspeed)
    expected = np.array(published.NACELLE_ROOTS[airspeed])
    np.testing.assert_allclose(found.real, expected.real, rtol=0, atol=HALF_A_DIGIT)
    np.testing.assert_allclose(found.imag, expected.imag, rtol=0, atol=HALF_A_DIGIT)


def test_flutter_of_a_propeller_on_its_nacelle():
    speed, frequency = published.nacelle_flutter()
    assert speed == pytest.approx(7.76409, abs=5e-6)
    assert frequency == pytest.approx(33.388, abs=5e-4)


def test_the_slower_whirl_of_a_fast_propeller_without_air_is_the_backward_one():
    """In a vacuum the closed form holds: I s² ∓ i I_p Ω s + c s + k = 0 for forward and backward whirl."""
    whirls = []
    for sense in (1, -1):
        terms = [
            published.PIVOT_INERTIA,
            published.PIVOT_DAMPING - sense * 1j * published.POLAR_INERTIA * published.ROTOR_SPEED,
            published.PIVOT_STIFFNESS,
        ]
        whirls.append(np.roots(terms)[np.argmax(np.roots(terms).imag)])
    forward, backward = whirls
    slow = published.nacelle_roots(1e-6)  # still air: the airloads of the turning blades alone
    assert backward.imag < forward.imag
    np.testing.assert_allclose(slow.imag, [backward.imag, forward.imag], rtol=0.02)


@pytest.mark.parametrize("rpm", published.GROUND_RESONANCE)
def test_ground_resonance_of_four_hinged_blades(rpm):
    found = published.ground_resonance_roots(rpm)
    expected = np.array(sorted(published.GROUND_RESONANCE[rpm], key=lambda root: root.imag))
    np.testing.assert_allclose(found.real, expected.real, rtol=0, atol=HALF_A_DIGIT)
    np.testing.assert_allclose(found.imag, expected.imag, rtol=0, atol=HALF_A_DIGIT)


def test_ground_resonance_without_dampers():
    growth, rpm = published.largest_growth()
    assert growth == pytest.approx(1.885, abs=5e-4)
    assert rpm == pytest.approx(253, abs=0.5)
    elsewhere = [published.ground_resonance_roots(rpm, damped=False).real.max() for rpm in range(60, 400, 10)]
    assert max(elsewhere) < 1.885 and elsewhere[0] < 1e-9  # slow blades meet no frequency of the hub
