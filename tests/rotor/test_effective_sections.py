"""Effective chord and twist against the projection they are defined by, written out as sums over fine panels.

The projection of a function onto polynomials of a degree below n on a panel is the sum of Legendre polynomials whose
coefficients are integrals of the function, taken here by 24 Gauss points between all knots.
"""

from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp
from benchmarks import stations
from proprotor.rotor.effective_sections import Line, effective_sections
from proprotor.rotor.quadrature import long_panels
from proprotor.rotor.section_loads import BladeSections

NODES, WEIGHTS = np.polynomial.legendre.leggauss(24)
SEEDS = range(12)
RADIUS = 4.0
RADII = {"radius": RADIUS, "root_cutout": 0.31, "flap_hinge_offset": 0.2, "lag_hinge_offset": 0.62}
STEP = 1e-30
ROUNDING = 1e-13


def random_table(rng, low, high, reach=True):
    """Knots from the centre to the tip, two of them on a hinge and on the cutout, and values."""
    inner = np.sort([0.31, 0.62, *rng.choice(np.arange(2, 98), rng.integers(1, 12), replace=False) / 25])
    knots = np.array([0.0, *inner, RADIUS]) if reach else inner
    return knots, rng.uniform(low, high, len(knots))


def projection(function, knots, start, end, count):
    """Projection of a function of r on a panel at its Gauss points; the function has kinks at the knots."""
    middle, half = (start + end) / 2, (end - start) / 2
    edges = np.unique([start, end, *(knot for knot in knots if start < knot < end)])
    width = np.diff(edges)[:, None] / 2
    r, weight = (edges[:-1, None] + width * (1 + NODES)).ravel(), (width * WEIGHTS).ravel() / half
    polynomials = np.polynomial.legendre.legvander((r - middle) / half, count - 1)
    coefficients = (np.arange(count) + 0.5) * ((weight * function(r)) @ polynomials)
    return np.polynomial.legendre.legval(np.polynomial.legendre.leggauss(count)[0], coefficients)


def projections(function, knots, panels):
    """The same at all stations of the panels of one blade."""
    each = zip(panels.starts, panels.widths, panels.points, strict=True)
    return np.concatenate([projection(function, knots, a, a + width, n) for a, width, n in each if n])


def products(c, t):
    return c, c * t, c**2, c**3


def found_products(sections):
    c = sections.chord
    return c, c * sections.twist, c**2 * sections.square, c**3 * sections.cube


# The closed form ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", SEEDS)
def test_projections_of_chord_and_twist_and_their_products(seed):
    """With knots of their own, on edges and within panels; the tables may end before the blade does."""
    rng = np.random.default_rng(seed)
    chord, twist = random_table(rng, 0.1, 0.5), random_table(rng, -0.5, 0.9, reach=seed % 2 == 0)
    panels = long_panels(**RADII)
    found = effective_sections(Line.through(*chord), Line.through(*twist), panels)
    knots = np.concatenate([chord[0], twist[0]])
    for place, mine in enumerate(found_products(found)):
        expected = projections(
            lambda r, place=place: products(np.interp(r, *chord), np.interp(r, *twist))[place], knots, panels
        )
        np.testing.assert_allclose(mine, expected, rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("gap", [1e-3, 1e-5, 1e-7])
def test_steps_of_a_table_are_two_knots_that_nearly_meet(gap):
    """Chord and twist step at the same radius; powers of such steep slopes lose no digits."""
    knots = np.array([0.0, 2.0, 2.0 + gap, RADIUS])
    chord, twist = (knots, np.array([0.5, 0.5, 0.1, 0.08])), (knots, np.array([0.6, 0.4, 0.1, -0.1]))
    panels = long_panels(**RADII)
    found = effective_sections(Line.through(*chord), Line.through(*twist), panels)
    for place, mine in enumerate(found_products(found)):
        expected = projections(
            lambda r, place=place: products(np.interp(r, *chord), np.interp(r, *twist))[place], knots, panels
        )
        np.testing.assert_allclose(mine, expected, rtol=0, atol=1e-16 * RADIUS / gap + 1e-13)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_constant_chord_leaves_the_projection_of_the_twist(seed):
    twist = random_table(np.random.default_rng(seed), -0.5, 0.9)
    panels = long_panels(**RADII)
    found = effective_sections(Line.straight(np.array(0.4), np.array(0.0)), Line.through(*twist), panels)
    expected = projections(lambda r: np.interp(r, *twist), twist[0], panels)
    np.testing.assert_allclose(found.twist, expected, rtol=0, atol=ROUNDING)
    assert found.chord == 0.4 and found.square == found.cube == 1.0


def test_lines_are_their_own_projection():
    panels = long_panels(**RADII)
    r = panels.quadrature().stations
    chord, twist = Line.straight(np.array(0.5), np.array(-0.06)), Line.straight(np.array(0.7), np.array(-0.2))
    found = effective_sections(chord, twist, panels)
    for mine, expected in zip(found_products(found), products(0.5 - 0.06 * r, 0.7 - 0.2 * r), strict=True):
        np.testing.assert_allclose(mine, expected, rtol=1e-13)


@pytest.mark.parametrize("seed", SEEDS)
def test_tables_times_polynomials_are_integrated_exactly(seed):
    """Up to a degree of one less than the points of the panel with the fewest."""
    rng = np.random.default_rng(seed)
    chord, twist = random_table(rng, 0.1, 0.5), random_table(rng, -0.5, 0.9)
    panels = long_panels(**RADII)
    quadrature, found = (
        panels.quadrature(),
        effective_sections(Line.through(*chord), Line.through(*twist), panels),
    )
    degree = panels.points[panels.points > 0].min() - 1
    edges = np.unique([0.31, RADIUS, *(k for k in (*chord[0], *twist[0]) if 0.31 < k < RADIUS)])
    width = np.diff(edges)[:, None] / 2
    r, weight = (edges[:-1, None] + width * (1 + NODES)).ravel(), (width * WEIGHTS).ravel()
    for power in range(degree + 1):
        exact = products(np.interp(r, *chord), np.interp(r, *twist))
        for mine, function in zip(found_products(found), exact, strict=True):
            integral = quadrature.weights[:, 0] @ ((quadrature.stations / RADIUS) ** power * mine)
            assert integral == pytest.approx(
                weight @ ((r / RADIUS) ** power * function), rel=1e-12, abs=1e-14
            )


# Derivatives -------------------------------------------------------------------------------------------------------


def material_rate(table, moved, start, end):
    """Rate of the table's value at a fixed share of a panel, as a function of r; rates of what moves by name."""
    knots, values = table
    slopes = np.concatenate([[0.0], np.diff(values) / np.diff(knots), [0.0]])
    rates_of_knots, rates_of_values = moved.get("knots", 0 * knots), moved.get("values", 0 * knots)

    def rate(r):
        share = (r - start) / (end - start)
        motion = (1 - share) * moved.get("start", 0.0) + share * moved.get("end", 0.0)
        piece = np.searchsorted(knots, r, side="right")
        before, after = np.maximum(piece - 1, 0), np.minimum(piece, len(knots) - 1)
        gap = np.where(after > before, knots[after] - knots[before], 1.0)
        part = np.where(after > before, (r - knots[before]) / gap, 0.0)

        def between(rates):
            return (1 - part) * rates[before] + part * rates[after]

        return slopes[piece] * (motion - between(rates_of_knots)) + between(rates_of_values)

    return rate


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("moving", ["start", "end", "knots", "values"])
def test_complex_steps_give_the_derivatives_of_the_projection(seed, moving):
    """At fixed shares of the panel the kernel of the projection stands still, so rates are projections of rates.

    A knot stands on the cutout and one on the hinge; the edges there are the blade's ends, hinges stay.
    """
    rng = np.random.default_rng(seed)
    table = random_table(rng, -0.5, 0.9)
    count = len(table[0])
    moved = {
        "start": {"start": rng.normal()},
        "end": {"end": rng.normal()},
        "knots": {"knots": rng.normal(size=count)},
        "values": {"values": rng.normal(size=count)},
    }[moving]
    radii = RADII | {"flap_hinge_offset": 0.0, "lag_hinge_offset": 0.0}
    plain = long_panels(**radii)
    stepped = {
        "root_cutout": 0.31 + 1j * STEP * moved.get("start", 0.0),
        "radius": RADIUS + 1j * STEP * moved.get("end", 0.0),
    }
    line = Line.through(
        table[0] + 1j * STEP * moved.get("knots", 0.0), table[1] + 1j * STEP * moved.get("values", 0.0)
    )
    constant = Line.straight(np.array(0.4), np.array(0.0))
    found = effective_sections(constant, line, long_panels(**(radii | stepped))).twist
    expected = projections(material_rate(table, moved, 0.31, RADIUS), table[0], plain)
    np.testing.assert_allclose(found.imag / STEP, expected, rtol=0, atol=1e-11)
    real = effective_sections(constant, Line.through(*table), plain).twist
    np.testing.assert_allclose(found.real, real, rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("name", ["radius", "root_cutout", "flap_hinge_offset", "lag_hinge_offset"])
def test_complex_steps_go_through_a_tapered_rotor(name):
    """Its state matrix against differences by small steps, with chord and twist from tables."""
    case = tapered()
    size, step = getattr(case.rotor, name), 1e-5

    def stiffness(value):
        return replace(case, rotor=replace(case.rotor, **{name: value})).linearize(120.0).K

    exact = stiffness(size * (1 + 1j * STEP)).imag / STEP
    around = [stiffness(size * (1 + k * step)) for k in (-2, -1, 1, 2)]
    difference = (around[0] - 8 * around[1] + 8 * around[2] - around[3]) / (12 * step)
    assert np.abs(exact - difference).max() <= 1e-8 * np.abs(exact).max()


# Rotors ------------------------------------------------------------------------------------------------------------


def tapered():
    """The XV-15 with a tapered chord that is kinked where its twist is not; both tables go on beyond the tip."""
    case = pp.load_case("xv15-uncoupled")
    shares, chord = np.array([0.0, 0.19, 0.33, 0.71, 0.97, 1.2]), np.array([0.3, 0.5, 0.42, 0.36, 0.3, 0.12])
    knots, twist = case.rotor.twist[:2]
    twist = np.append(knots, 1.2 * case.rotor.radius), np.append(twist, 11 * twist[-1] - 10 * twist[-2])
    return replace(case, rotor=replace(case.rotor, chord=(shares * case.rotor.radius, chord), twist=twist))


class MyAirfoil(pp.Airfoil):
    """A straight lift line by its class, and any other by its coefficients."""


@pytest.mark.parametrize(
    "change",
    [
        {"airfoil": MyAirfoil(lift_slope=5.7)},
        {"chord": lambda r: 0.4 + 0 * r},
        {"twist": lambda r: 0.6 - 0.1 * r},
    ],
    ids=["an airfoil of one's own", "a chord by a function", "a twist by a function"],
)
def test_other_rotors_have_the_chord_and_twist_of_their_stations(change):
    rotor = replace(tapered().rotor, **change)
    assert not rotor.has_effective_sections
    stations = rotor.quadrature.stations
    np.testing.assert_array_equal(rotor.sections.chord, rotor.chord_at(stations))
    np.testing.assert_array_equal(rotor.sections.twist, rotor.twist_at(stations))
    assert rotor.quadrature.stations.size > 2 * tapered().rotor.quadrature.stations.size


@pytest.mark.parametrize("options", [{}, {"section_damping": False}, {"airloads": "lift-slope"}])
@pytest.mark.parametrize("airspeed", [20.0, 90.0, 180.0])
def test_both_ways_lead_to_the_same_matrices(options, airspeed):
    """With all loads of a section: a moment, and the damping of its turn, by the chord's square and cube."""
    case = tapered()
    airfoil = {"lift_slope": 5.7, "drag": 0.0065, "moment": -0.03}
    ours, theirs = (
        replace(case, rotor=replace(case.rotor, airfoil=kind(**airfoil))).linearize(airspeed, **options)
        for kind in (pp.Airfoil, MyAirfoil)
    )
    for name in "MCK":
        mine, other = getattr(ours, name), getattr(theirs, name)
        assert np.abs(mine - other).max() <= 1e-10 * np.abs(other).max()
    assert abs(ours.trim.pitch - theirs.trim.pitch) < 1e-11


@pytest.mark.parametrize("airspeed", [20.0, 150.0])
def test_an_effective_chord_may_change_its_sign(airspeed):
    """Where the chord drops to a hundredth, a polynomial swings below zero; loads are those of the table."""
    case = tapered()
    shares, chord = np.array([0.0, 0.5, 0.505, 1.2]), np.array([0.5, 0.5, 0.002, 0.002])
    airfoil = {"lift_slope": 5.7, "drag": 0.0065, "moment": -0.03}
    ours, theirs = (
        replace(case.rotor, chord=(shares * case.rotor.radius, chord), airfoil=kind(**airfoil))
        for kind in (pp.Airfoil, MyAirfoil)
    )
    assert ours.sections.chord.min() < 0
    models = [replace(case, rotor=rotor).linearize(airspeed) for rotor in (ours, theirs)]
    for name in "MCK":
        mine, other = (getattr(model, name) for model in models)
        assert np.abs(mine - other).max() <= 1e-9 * np.abs(other).max()


def test_each_of_many_designs_has_the_sections_it_would_have_alone():
    """Bit for bit, whether tables stretch with the radius or stay, in any number of designs."""
    rotor = tapered().rotor
    shares = np.linspace(0.8, 1.15, 9)
    knots, values = rotor.chord
    many = replace(
        rotor,
        radius=rotor.radius * shares,
        root_cutout=rotor.root_cutout * shares[::-1],
        chord=(knots * shares[:, None], values),
    )
    for place, share in enumerate(shares):
        one = replace(
            rotor,
            radius=rotor.radius * share,
            root_cutout=rotor.root_cutout * shares[::-1][place],
            chord=(knots * share, values),
        )
        for mine, alone in zip(many.sections, one.sections, strict=True):
            own = mine[place] if mine.ndim > 1 else mine  # what all designs have alike has no axis of designs
            np.testing.assert_array_equal(own[: alone.size], alone)


def test_designs_of_twist_alone_share_their_stations():
    rotor = replace(tapered().rotor, twist=np.array([-0.5, -0.7]))
    assert rotor.quadrature.stations.ndim == 1 and rotor.sections.twist.shape[0] == 2
    for place in (0, 1):
        one = replace(rotor, twist=rotor.twist[place])
        np.testing.assert_array_equal(rotor.sections.twist[place], one.sections.twist)


def test_a_large_batch_is_taken_a_block_at_a_time():
    rotor = tapered().rotor
    radius = rotor.radius * np.linspace(0.9, 1.1, 300)
    many, few = (replace(rotor, radius=some) for some in (radius, radius[::7]))
    for mine, alone in zip(many.sections, few.sections, strict=True):
        np.testing.assert_array_equal(mine[::7][..., : alone.shape[-1]], alone)


def test_stall_is_told_by_the_twist_of_the_table():
    """An effective twist swings about a steep table; the angle of attack at a station does not."""
    rotor = tapered().rotor
    sections = BladeSections.of(rotor, ())
    r = sections.quadrature.stations
    np.testing.assert_allclose(sections.along.twist + sections.along.bent, rotor.twist_at(r), atol=1e-15)
    assert np.abs(sections.along.bent).max() > 1e-4


@pytest.mark.parametrize("cutout", [0.0, 0.002, 0.03, 0.08])
def test_blades_that_begin_near_the_axis_have_more_panels(cutout):
    """Ends of neighbouring panels meet, and no panel but the first spans more than a range of twenty."""
    panels = long_panels(**(RADII | {"root_cutout": RADIUS * cutout, "flap_hinge_offset": 0.0}))
    there = panels.points > 0
    starts, ends = panels.starts[there], (panels.starts + panels.widths)[there]
    assert starts[0] == RADIUS * cutout and ends[-1] == RADIUS
    np.testing.assert_allclose(ends[:-1], starts[1:], rtol=1e-14)
    assert (ends[1:] / starts[1:]).max(initial=0) < 20


@pytest.mark.parametrize("name", stations.cases())
def test_moments_of_the_xv15_are_exact_to_nine_digits_of_themselves(name):
    """From a twentieth of the tip speed, with 36 stations; the reference has panels between all kinks."""
    case = stations.cases()[name]
    tip_speed = case.operation.rotor_speed * case.rotor.radius
    count, by_itself, by_size = stations.errors(case, tip_speed * np.array([0.05, 0.3, 1.0]))[stations.OURS]
    assert count == 36 and by_itself.max() < 1e-9 and by_size.max() < 1e-11
