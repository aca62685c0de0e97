"""What must hold for every rotor, whoever derived its equations: conservation, symmetry, and air that stands still.

Tolerance: 1e-12 of the largest entry of the block that is compared. A block that ought to vanish has no entry of its
own and is held to 1e-14 of what inertia at 1/rev would put there, Ω^k √(M_ii M_jj) for M, C, K with k = 0, 1, 2.
"""

import inspect
from dataclasses import replace

import numpy as np
import proprotor_equations as equations
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import proprotor as pp
from proprotor.evaluation import evaluate
from proprotor.model import rotor_quantities
from proprotor.trim import UNKNOWNS, with_trim
from tests.rotors import HUB, flights, random_support, seeds

any_rotor = settings(max_examples=60, derandomize=True, deadline=None)

DOFS = equations.FIXED_COORDINATES
BLOCKS = ((*HUB[:3],), (*HUB[3:],), DOFS[6:9], DOFS[9:12], DOFS[12:15], ("azimuth",), ("gimbal_1c", "gimbal_1s"))
OPTIONS = st.fixed_dictionaries(
    {},
    optional={
        "pitch": st.sampled_from(["dynamic", "coupling", "rigid"]),
        "compressibility": st.booleans(),
        "rotor_speed": st.sampled_from(["windmilling", "constant"]),
        "locked": st.sets(st.sampled_from(["flap", "lag", "pitch", "gimbal"])),
    },
)


# Models and comparisons -------------------------------------------------------------------------------------------


def trimmed(flight, **options):
    model = flight.model(**options)
    assume(model.trim.converged)
    return model


def undamped(flight, **options):
    """In vacuum as far as perturbations go, but bent by the airloads of its trim; no dampers."""
    return trimmed(flight.without_dampers(), airloads="none", **options)


def groups(dofs):
    """Places of the coordinates, block by block."""
    found = ([dofs.index(name) for name in block if name in dofs] for block in BLOCKS)
    return [places for places in found if places]


def inertial_scale(model, rotor_speed):
    """Ω^k √(M_ii M_jj) of each block, for M, C and K."""
    root = np.sqrt(np.abs(np.diag(model.M)))
    for places in groups(model.dofs):
        root[places] = root[places].max()
    return {name: np.outer(root, root) * rotor_speed**k for k, name in enumerate("MCK")}


def assert_equal(actual, expected, dofs, scale):
    """Entry by entry, to 1e-12 of the largest entry of the block; columns too, as matrices of one column."""
    columns = groups(dofs) if actual.ndim == 2 else [[0]]
    actual, expected, scale = (part.reshape(len(dofs), -1) for part in (actual, expected, scale))
    for rows in groups(dofs):
        for places in columns:
            block = np.ix_(rows, places)
            largest = max(np.abs(actual[block]).max(), np.abs(expected[block]).max())
            error = np.abs(actual[block] - expected[block]).max()
            assert error <= 1e-12 * largest + 1e-14 * scale[block].max(), f"{dofs[rows[0]]} by {dofs[places[0]]}"


class Columns:
    """Columns of a model's matrices, combined by the names of their coordinates."""

    def __init__(self, model, rotor_speed):
        self.model, self.scale = model, inertial_scale(model, rotor_speed)

    def along(self, matrix, **motion):
        """The matrix times a motion, such as ``along("K", alpha_x=1, gimbal_1s=-1)``; absent coordinates are held."""
        return getattr(self.model, matrix) @ self.vector(**motion)

    def vector(self, **motion):
        return np.array([motion.get(name, 0.0) for name in self.model.dofs], dtype=float)

    def assert_equal(self, matrix, actual, expected, *names):
        """With the scale of the named columns."""
        places = [self.model.dofs.index(name) for name in names]
        scale = self.scale[matrix][:, places].max(axis=1)
        assert_equal(actual, expected, self.model.dofs, scale)

    def assert_no_effect(self, matrix, **motion):
        """The coordinates moved together leave nothing of the columns they have alone."""
        apart = [self.along(matrix, **{name: value}) for name, value in motion.items()]
        largest = np.max(np.abs(apart), axis=0)
        together = self.along(matrix, **motion)
        self.assert_equal(matrix, together + largest, largest, *motion)


# Without airloads and dampers ---------------------------------------------------------------------------------------


@any_rotor
@given(flights())
def test_mass_and_stiffness_are_symmetric_and_gyroscopic_terms_skew(flight):
    model = undamped(flight)
    scale = inertial_scale(model, flight.rotor_speed)
    for name, sign in (("M", 1), ("C", -1), ("K", 1)):
        matrix = getattr(model, name)
        assert_equal(matrix, sign * matrix.T, model.dofs, scale[name])


def unit_diagonal(matrix):
    """The matrix in coordinates scaled to a unit diagonal, which leaves the signs of its eigenvalues."""
    root = np.sqrt(np.diag(matrix))
    return matrix / np.outer(root, root)


@any_rotor
@given(flights())
def test_mass_is_nowhere_negative(flight):
    assert np.linalg.eigvalsh(unit_diagonal(undamped(flight).M)).min() > -1e-12


@any_rotor
@given(flights(hinges_at_centre=False), seeds)
def test_mass_is_positive_once_the_hub_carries_inertia(flight, seed):
    """With the hinges off the centre; see below for hinges on it."""
    support = random_support(flight, seed)
    mass = flight.without_dampers().on(support, airloads="none").M
    assume(np.isfinite(mass).all())
    assert np.linalg.eigvalsh(unit_diagonal(mass)).min() > 1e-12


@any_rotor
@given(flights())
def test_hinges_at_the_centre_turn_the_same_masses_as_yoke_and_shaft(flight):
    """Then a blade that flaps and lags makes up for a gimbal that tilts, and for a shaft that turns."""
    central = flight.with_rotor(flap_hinge_offset=0.0, lag_hinge_offset=0.0)
    assume(np.ptp([central.rotor.lag_inertia, central.rotor.blade_inertia]) == 0)
