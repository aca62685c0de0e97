"""Matrices by origin, and what each origin does to a mode."""

import numpy as np
import pytest

import proprotor as pp
from proprotor.stability.attribution import attribution
from proprotor.stability.eigenvalue_derivatives import eigenvalue_change
from proprotor.stability.modes import decomposition
from proprotor.stability.origins import _Part, model_parts
from tests.known_systems import linear_model

VARIANTS = {
    "default": {},
    "couplings": {"pitch": "coupling"},
    "given couplings": {"pitch": "coupling", "pitch_flap_coupling": 0.1, "pitch_lag_coupling": -0.3},
    "lift slope": {"airloads": "lift-slope"},
    "no airloads": {"airloads": "none"},
    "published": {"equations": "published", "pitch": "coupling"},
    "closed forms": {"equations": "published", "airloads": "lift-slope", "compressibility": False},
    "no section damping": {"section_damping": False},
    "published, section damping": {"equations": "published", "section_damping": True},
    "published lift slope, section damping": {
        "equations": "published",
        "airloads": "lift-slope",
        "compressibility": False,
        "section_damping": True,
    },
    "diagonal": {"structure": "diagonal", "pitch": "rigid"},
    "locked": {"locked": ("gimbal", "lag"), "rotor_speed": "constant"},
    "drive train": {"drive_train": pp.DriveTrain(drive_inertia=10, shaft_stiffness=1e4, drive_damping=3)},
}
SPEEDS = np.array([100.0, 180.0])
# A trim is as good as its last step; with couplings the matrices are those of a state that differs by some 1e-13 rad.
SUM = 1e-10


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


@pytest.mark.parametrize("options", VARIANTS.values(), ids=VARIANTS)
def test_parts_sum_to_the_model(case, options):
    model = case.linearize(SPEEDS, **options)
    parts = model_parts(case, model, **options)
    for name in "MCK":
        whole = getattr(model, name)
        total = sum(getattr(part, name) for part in parts.values())
        assert np.abs(total - whole).max() < SUM * np.abs(whole).max()


@pytest.mark.parametrize("name", pp.list_cases())
def test_parts_of_every_bundled_case(name):
    case = pp.load_case(name)
    speed = 0.6 * np.ravel(case.operation.rotor_speed)[0] * case.rotor.radius
    model = case.linearize(speed)
    parts = model_parts(case, model)
    for matrix in "MCK":
        whole = getattr(model, matrix)
        assert (
            np.abs(sum(getattr(part, matrix) for part in parts.values()) - whole).max()
            < SUM * np.abs(whole).max()
        )


def contributions(model, parts, modes):
    """λ_g (parts, modes) of each part, rad/s."""
    return np.stack([eigenvalue_change(model, part, modes) for part in parts.values()])


@pytest.mark.parametrize("options", VARIANTS.values(), ids=VARIANTS)
def test_contributions_sum_to_nothing(case, options):
    """Every term grown alike moves no eigenvalue."""
    model = case.linearize(150.0, **options)
    modes = decomposition(model).all_modes
    found = contributions(model, model_parts(case, model, **options), modes)
    assert np.abs(found.sum(axis=0)).max() < SUM * np.abs(found).sum(axis=0).max()


def test_parts_are_where_they_belong(case):
    model = case.linearize(150.0)
    parts = model_parts(case, model)
    for name in ("gyroscopic",):
        assert not parts[name].M.any()
        assert np.abs(parts[name].C + parts[name].C.T).max() < 1e-9 * np.abs(parts[name].C).max()
    assert np.count_nonzero(parts["support damping"].C) == 3 and not parts["support damping"].K.any()
    assert "section moment" not in " ".join(parts)  # the deck's airfoil has none
    lag, flap = model.dofs.index("lag_0"), model.dofs.index("flap_0")
    assert parts["lag spring"].K[lag, lag] > 0 and not parts["lag spring"].K[flap].any()


def test_an_oscillator():
    """λ_g of spring and damper in closed form."""
    model = linear_model(np.array([[2.0]]), np.array([[0.6]]), np.array([[50.0]]))
    zero = np.zeros((1, 1))
    parts = {
        "mass": _Part(model.M, zero, zero),
        "damper": _Part(zero, model.C, zero),
        "spring": _Part(zero, zero, model.K),
    }
    spectrum = decomposition(model).all_modes
    found = contributions(model, parts, spectrum)
    value = spectrum.values
    slope = 4 * value + 0.6
    np.testing.assert_allclose(found, [-2 * value**2 / slope, -0.6 * value / slope, -50 / slope], rtol=1e-12)


def test_a_contribution_is_the_derivative_by_the_size_of_its_terms(case):
    """The modes with one part grown by a small step, both ways."""
    model = case.linearize(180.0)
    parts, spectrum = model_parts(case, model), decomposition(model).all_modes
    found = contributions(model, parts, spectrum)
    step = 1e-4
    for place, name in enumerate(parts):
        values = []
        for sign in (1, -1):
            grown = {
                matrix: getattr(model, matrix) + sign * step * getattr(parts[name], matrix)
                for matrix in "MCK"
            }
            changed = decomposition(
                pp.LinearModel(**grown, dofs=model.dofs, trim=model.trim, airspeed=model.airspeed)
            )
            values.append(
                changed.values[np.abs(changed.values[None] - spectrum.values[:, None]).argmin(axis=1)]
            )
        limit = (values[0] - values[1]) / (2 * step)
        scale = np.abs(found).max(axis=0)
        assert (np.abs(limit - found[place]) / scale).max() < 1e-4, name


def test_what_drives_the_flutter_of_the_xv15(case):
    """Lift and the pitch-lag coupling of the springs drive it, as the paper finds; the wing does not."""
    found = attribution(case, "370 kt", mode="chord")
    growth = found.growth.sel(mode="chord").to_series()
    assert growth.idxmax() == "airloads: lift slope"
    assert growth["pitch-lag coupling of the springs"] > growth["pitch-flap coupling of the springs"] > 0
    assert growth["support damping"] < 0 and growth["control system"] < 0
    assert found.eigenvalue.sel(mode="chord").item().real < 0


def test_what_cannot_be_had_is_told(case):
    with pytest.raises(pp.InputError, match="did you mean chord"):
        attribution(case, 150.0, mode="cord")
    with pytest.raises(pp.InputError, match="one speed"):
        attribution(case, [150.0, 160.0])
    with pytest.raises(pp.InputError, match="Mach"):
        attribution(case, 1000.0)
    with pytest.raises(pp.InputError, match="not taken apart"):
        model_parts(case, case.linearize(150.0, reactionless=True))
