"""The generated equations against SymPy's Kane on reduced rotors; `benchmarks/peers.md` has the other peers."""

import numpy as np
import pytest
from proprotor_equations import BLADE_COORDINATES

from benchmarks.peers import generated_rotor
from benchmarks.peers.blade_sum import FIXED, fixed_coordinates, over_blades
from benchmarks.peers.cost import worst_disagreement
from benchmarks.peers.kane_rotor import linear_blade
from benchmarks.peers.lambdified import Lambdified
from benchmarks.peers.random_rotors import random_rotors

RELATIVE = 1e-10  # to the entry, or to what inertia at 1/rev would put there; rounding leaves 1e-14


@pytest.mark.parametrize(
    "coordinates",
    [("flap", "lag", "pitch", "azimuth"), ("hub_i", "hub_j", "hub_k", "flap", "lag")],
    ids=["blade-and-azimuth", "hub-displacement"],
)
def test_kane_gives_the_generated_matrices(coordinates):
    blade = linear_blade(coordinates)
    function = Lambdified((blade.mass, blade.damping, blade.stiffness), cse=True)
    places = [FIXED.index(name) for name in fixed_coordinates(coordinates)]
    found = worst_disagreement(lambda q: over_blades(q, coordinates, function(q)), places)
    assert max(found.values()) < RELATIVE, found


def test_sum_over_the_blades_by_numbers():
    quantities = random_rotors(5)
    blade = generated_rotor.blade_matrices(quantities)
    summed = over_blades(quantities, BLADE_COORDINATES, blade)
    for actual, expected in zip(summed, generated_rotor.rotor_matrices(quantities), strict=True):
        np.testing.assert_allclose(actual, expected, rtol=1e-12, atol=1e-12 * np.abs(expected).max())
