"""The mass matrix of a rotor at rest, which comes from the plans, beside the readable equations."""

import numpy as np
import pytest
from proprotor_equations import FIXED_COORDINATES, inertia, multiblade, offset_mass, pitch

import proprotor as pp
from proprotor.model.mass_at_rest import MASS_AT_REST, mass_at_rest
from proprotor.model.quantities import of_rotor
from proprotor.rotor.generated import evaluate
from proprotor.rotor.trim import UNKNOWNS

BLADE = {
    "n_blades": 4,
    "radius": 4.0,
    "flap_hinge_offset": 0.3,
    "lag_hinge_offset": 0.5,
    "precone": 0.04,
    "flap_stiffness": 2e4,
    "lag_stiffness": 1e6,
    "pitch_inertia": 0.6,
    "control_stiffness": 4e3,
    "chord": 0.3,
    "airfoil": pp.Airfoil(lift_slope=5.7),
}
KINDS = {
    "plain": {},
    "linkages": {"kinematic_pitch_flap_coupling": 0.3, "kinematic_pitch_lag_coupling": -0.2},
    "beside the axis": {"mass_offset": 0.02},
    "both": {"mass_offset": -0.03, "kinematic_pitch_flap_coupling": 0.3},
    "many designs": {"precone": np.linspace(-0.1, 0.1, 5), "flap_hinge_offset": np.linspace(0.1, 0.3, 5)},
}


def expected_of(rotor):
    """The matrix as the readable equations sum it over the blades, for the undeflected rotor."""
    quantities = of_rotor(rotor) | dict.fromkeys((*UNKNOWNS, "pitch"), 0.0)
    quantities |= evaluate(inertia.trim_integrals, quantities)._asdict()
    blade = evaluate(inertia.mass, quantities) + evaluate(pitch.mass, quantities)
    if rotor.offset_mass is not None:
        quantities |= evaluate(offset_mass.trim_integrals, quantities)._asdict()
        blade = blade + evaluate(offset_mass.mass, quantities)
    places = [FIXED_COORDINATES.index(name) for name in MASS_AT_REST]
    return evaluate(multiblade.mass, quantities, blade)[..., places, :][..., places]


@pytest.mark.parametrize("kind", KINDS)
def test_the_mass_at_rest_is_that_of_the_readable_equations(kind):
    rotor = pp.Rotor.from_mass_distribution([0.0, 0.4, 4.0], [12.0, 9.0, 5.0], **BLADE | KINDS[kind])
    found, expected = mass_at_rest(rotor), expected_of(rotor)
    assert found.shape == expected.shape and not found.flags.writeable
    assert (rotor.offset_mass is not None) == ("mass_offset" in KINDS[kind])
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-14 * np.abs(expected).max())
