"""Airfoils by region of the span: by two ways through the package, alone and in batches, and what is refused.

Their airloads are compared with those of the nonlinear rotor in tests/derive/test_airloads_virtual_work.py.
"""

from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp
from proprotor.rotor.fused_balance import serves_sections
from proprotor.rotor.section_loads import BladeSections
from proprotor.stability.origins import model_parts

SPEEDS = np.array([90.0, 120.0, 150.0])
ROUNDING = 1e-11  # of the largest entry: two quadratures of a smooth load, each converged to 1e-12
CASE = pp.load_case("xv15")
ENDS = [0.55, 0.8]


class Line(pp.Airfoil):
    """A straight lift line that the package does not know to be one: it takes short panels and readable functions."""


def three(kind=pp.Airfoil):
    return (
        kind(lift_slope=6.1, zero_lift_angle=-0.03, drag=0.01, moment=-0.075),
        kind(lift_slope=5.8, zero_lift_angle=-0.02, drag=0.006, moment=-0.008),
        kind(lift_slope=6.5, zero_lift_angle=-0.02, drag=0.007, moment=-0.02),
    )


def as_table(airfoil, mach=(0.0,)):
    """A straight lift line in a table, between angles that the blade does not leave."""
    alpha = np.radians([-80.0, -20.0, 20.0, 80.0])
    lift = airfoil.lift_slope * (alpha - airfoil.zero_lift_angle)
    columns = np.ones(len(mach))
    return pp.AirfoilTable(
        alpha=alpha,
        mach=mach,
        lift=lift[:, None] * columns,
        drag=np.full((4, len(mach)), airfoil.drag),
        moment=np.full((4, len(mach)), airfoil.moment),
    )


def regions(airfoils=None, ends=ENDS, blend=0.0):
    return pp.AirfoilRegions(airfoils=airfoils or three(), region_ends=ends, blend=blend)


def model(airfoil, speeds=SPEEDS, **options):
    return replace(CASE, rotor=replace(CASE.rotor, airfoil=airfoil)).linearize(speeds, **options)


def assert_alike(one, other, tolerance=ROUNDING):
    assert np.all(one.trim.converged) and np.all(other.trim.converged)
    for name in "MCK":
        found, expected = getattr(one, name), getattr(other, name)
        assert np.abs(found - expected).max() <= tolerance * np.abs(expected).max(), name


def test_one_airfoil_in_all_regions_is_one_airfoil():
    airfoil = three()[0]
    assert_alike(model(regions((airfoil,) * 3, blend=0.1)), model(airfoil), 1e-12)
    table = as_table(airfoil)
    assert_alike(model(regions((table,) * 3, blend=0.1)), model(table), 1e-12)


@pytest.mark.parametrize("blend", [0.0, 0.2, [0.3, 0.0]], ids=["sharp", "blended", "one of each"])
@pytest.mark.parametrize(
    "other", [lambda: three(Line), lambda: tuple(map(as_table, three()))], ids=["line", "table"]
)
def test_regions_of_any_model_have_the_loads_of_straight_lift_lines(blend, other):
    """Fused functions on long panels, against readable ones on short panels that add up coefficients."""
    fast, slow = regions(blend=blend), regions(other(), blend=blend)
    rotor = replace(CASE.rotor, airfoil=fast)
    assert serves_sections(BladeSections.of(rotor, ()))
    assert not serves_sections(BladeSections.of(replace(rotor, airfoil=slow), ()))
    assert_alike(model(fast), model(slow))


def test_a_joint_that_narrows_becomes_sharp():
    """To first order a joint adds on one side of the end what it takes on the other; its square is left."""
    sharp = model(regions()).K
    wide, narrow = (np.abs(model(regions(blend=width)).K - sharp).max() for width in (0.02, 0.01))
    assert 3.9 < wide / narrow < 4.1


def test_the_shares_along_the_blade_are_as_stated():
    """Between two lift slopes the slope is linear across the width, which is centred on the end."""
    airfoils = (pp.Airfoil(lift_slope=6.0), pp.Airfoil(lift_slope=5.0, zero_lift_angle=-0.03))
    at = np.array([0.1, 0.449, 0.475, 0.5, 0.525, 0.551, 0.99])
    found = pp.AirfoilRegions(airfoils=airfoils, region_ends=0.5, blend=0.1).at(at, ())
    slope = np.array([6.0, 6.0, 5.75, 5.5, 5.25, 5.0, 5.0])
    np.testing.assert_allclose(found.lift_slope, [slope], rtol=1e-14)
    share = (6.0 - slope) / 1.0
    lift = (1 - share) * 6.0 * 0.1 + share * 5.0 * (0.1 + 0.03)
    np.testing.assert_allclose(
        found.coefficients(np.array(0.1), np.array(0.3)).lift_coefficient, [lift], rtol=1e-14
    )


@pytest.mark.parametrize("kind", [pp.Airfoil, Line])
def test_a_design_is_in_a_batch_what_it_is_alone(kind):
    """Designs that differ in ends, widths and coefficients."""
    first, second, third = three(kind)
    slopes, ends, widths = np.array([5.5, 6.0, 6.5]), np.array([0.5, 0.55, 0.6]), np.array([0.0, 0.1, 0.2])

    def design(slope, end, width):
        shape = np.shape(slope)
        both = np.stack([np.broadcast_to(end, shape), np.full(shape, 0.85)], axis=-1)
        return regions((first, replace(second, lift_slope=slope), third), both, np.asarray(width)[..., None])

    batch = model(design(slopes, ends, widths))
    for place, values in enumerate(zip(slopes, ends, widths, strict=True)):
        alone = model(design(*values), SPEEDS[place])
        for name in "MCK":
            found, expected = getattr(batch, name)[place], getattr(alone, name)
            assert np.abs(found - expected).max() <= 1e-12 * np.abs(expected).max()


@pytest.mark.parametrize("kind", [pp.Airfoil, Line])
@pytest.mark.parametrize("what", ["end", "blended end", "width", "slope"])
def test_a_complex_step_goes_through(kind, what):
    """Against central differences, extrapolated once."""
    first, second, third = three(kind)

    def at(change):
        airfoils = (
            (first, replace(second, lift_slope=5.8 + change), third) if what == "slope" else three(kind)
        )
        ends = np.array([0.55 + (change if "end" in what else 0.0), 0.8])
        wide = what in ("blended end", "width")
        return model(
            regions(airfoils, ends, [0.1 * wide + (change if what == "width" else 0.0), 0.0]), 120.0
        ).K

    step = 1e-3
    coarse, fine = ((at(h) - at(-h)) / (2 * h) for h in (step, step / 2))
    expected = (4 * fine - coarse) / 3
    assert np.abs(expected).max() > 1.0
    found = np.imag(at(1e-30j)) / 1e-30
    assert np.abs(found - expected).max() <= 1e-6 * np.abs(expected).max()


def test_a_width_of_zero_has_no_derivative():
    """A complex step of a sharp joint moves nothing, as `test_a_joint_that_narrows_becomes_sharp` says of the model."""
    assert np.abs(np.imag(model(regions(blend=1e-30j), 120.0).K)).max() <= 1e-40


def test_a_doubt_names_the_region():
    """Tables that end at ten degrees: inboard of half the radius nobody asks, and at the tip the angles are small."""
    short = pp.AirfoilTable(
        alpha=np.radians([-0.1, 0.1]),
        mach=[0.0],
        lift=[[-0.01], [0.01]],
        drag=[[0.01]] * 2,
        moment=[[0.0]] * 2,
    )
    whole = as_table(three()[0])
    warning = model(regions((whole, short, whole)), np.array([150.0])).trim.warning[0]
    assert "angle of attack outside the airfoil table in airfoil region 2 outboard of 0.5 R" in warning
    assert "region 1" not in warning and "region 3" not in warning


def test_a_root_with_drag_alone_may_stand_beside_tables_at_several_mach_numbers():
    """Nothing of the root takes a Prandtl-Glauert factor, so that it makes no difference who has it."""
    root = pp.Airfoil(lift_slope=0.0, drag=0.3)
    tables = [as_table(airfoil, (0.0, 0.9)) for airfoil in three()[1:]]
    found = model(regions((root, *tables), [0.2, 0.8]))
    lines = [as_table(airfoil) for airfoil in three()[1:]]
    assert_alike(found, model(regions((root, *lines), [0.2, 0.8]), compressibility=False))


A, TABLE = pp.Airfoil(lift_slope=5.7), as_table(pp.Airfoil(lift_slope=5.7), (0.0, 0.5))


@pytest.mark.parametrize(
    ("airfoils", "ends", "blend", "field", "rule"),
    [
        ((A,), [], 0.0, "region_ends", "must be one fewer than the regions"),
        ((A, A), [0.3, 0.5], 0.0, "region_ends", "must be one fewer than the regions"),
        ((A, A, A), [0.5, 0.3], 0.0, "region_ends", "must increase"),
        ((A, A), 0.0, 0.0, "region_ends", "must increase from region to region, between 0"),
        ((A, A), 1.0, 0.0, "region_ends", "must increase from region to region, between 0"),
        ((A, A), float("nan"), 0.0, "region_ends", "must be finite"),
        ((A, A, A), [0.3, 0.5], 0.3, "blend", "must not make two joints overlap"),
        ((A, A), 0.95, 0.2, "blend", "must not reach beyond centre or tip"),
        ((A, A), 0.5, -0.1, "blend", "must not be negative"),
        ((A, A, A), [0.3, 0.5], [0.1, 0.1, 0.1], "blend", "must be one, or 2"),
        ((A, TABLE), 0.5, 0.0, "airfoils", "must all contain compressibility"),
    ],
)
def test_what_does_not_fit_is_refused(airfoils, ends, blend, field, rule):
    with pytest.raises(pp.InputError) as caught:
        pp.AirfoilRegions(airfoils=airfoils, region_ends=ends, blend=blend)
    assert caught.value.field == field and rule in caught.value.rule


def test_joints_may_meet():
    pp.AirfoilRegions(airfoils=(A, A, A, A), region_ends=[0.65, 0.75, 0.8], blend=[0.1, 0.1, 0.0])


@pytest.mark.parametrize("kind", [pp.Airfoil, Line])
def test_origins_add_up_with_regions(kind):
    """The parts of a model by origin, which take coefficients one by one, are the whole model."""
    case = replace(CASE, rotor=replace(CASE.rotor, airfoil=regions(three(kind), blend=0.1)))
    whole = case.linearize(120.0)
    parts = model_parts(case, whole)
    for name in "MCK":
        total = sum(getattr(part, name) for part in parts.values())
        assert np.abs(total - getattr(whole, name)).max() <= 1e-11 * np.abs(getattr(whole, name)).max()
