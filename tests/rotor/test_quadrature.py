"""Integrals along the blade: radial moments of section loads, and the mass integrals of a mass distribution.

Section loads are kinked where chord or twist are tabulated and where a segment begins, and vary over V/Ω elsewhere. A
moment is held to 1e-10 of itself with the loads' signs left out, segment by segment: a torque that vanishes has no
size of its own. A straight lift line has effective chord and twist at a few stations (`test_effective_sections.py`
holds these to their definition); any other airfoil has panels between the kinks.
"""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

import proprotor as pp
from tests.rotors import between, mass_distributions, zero_or

many = settings(max_examples=150, derandomize=True, deadline=None, phases=[Phase.generate])

RADIUS, TIP_SPEED = 4.0, 180.0
SPEED = TIP_SPEED / RADIUS


@st.composite
def tables(draw, low, high):
    """Anything tabulated from the centre to the tip, two stations or many."""
    inner = draw(st.lists(st.integers(1, 99), max_size=12, unique=True))
    values = draw(st.lists(between(low, high), min_size=len(inner) + 2, max_size=len(inner) + 2))
    return RADIUS * np.array([0, *sorted(inner), 100]) / 100, np.array(values)


def blade(radius, cutout, flap, gap, chord, twist):
    """A blade by shares of its radius, or many by arrays; tables stretch with the radius."""

    def stretched(distribution):
        if not isinstance(distribution, tuple):
            return distribution
        return np.asarray(radius)[..., None] * distribution[0] / RADIUS, distribution[1]

    r, mass = stretched((np.array([0.0, RADIUS]), [5.0, 5.0]))
    return pp.Rotor.from_mass_distribution(
        r,
        mass,
        n_blades=3,
        radius=radius,
        root_cutout=radius * cutout,
        flap_hinge_offset=radius * flap,
        lag_hinge_offset=radius * (flap + gap),
        flap_stiffness=1.0,
        lag_stiffness=1.0,
        chord=stretched(chord),
        twist=stretched(twist),
        airfoil=pp.Airfoil(lift_slope=5.7),
    )


# Shares of the radius that put a hinge on either side of the cutout, or on it, or at the centre.
SHARES = (between(0.05, 0.3), zero_or(between(0.01, 0.4)), zero_or(between(0.01, 0.3)))
chords = between(0.1, 0.5) | tables(0.1, 0.5)
twists = between(-0.9, 0.0) | tables(-0.3, 0.9)
blades = st.tuples(*SHARES, chords, twists).map(lambda drawn: blade(RADIUS, *drawn))


airspeeds = between(np.log(0.02), np.log(3.0)).map(lambda logarithm: TIP_SPEED * np.exp(logarithm))


def section_loads(tangential, axial, radial, pitch, sound, chord, square, cube):
    """Lift and drag along i', n and d, and moment, per unit span, of a linear airfoil in air of density 2.

    With the lift and the moment of a section that turns at 3 rad/s. Powers of the chord stand for themselves.
    """
    speed = np.sqrt(tangential**2 + axial**2)
    factor = 1 / np.sqrt(1 - (speed / sound) ** 2)
    lift = 5.7 * factor * (chord * (pitch - np.arctan(axial / tangential) + 0.03) + square * 1.5 / speed)
    drag = 0.01 * chord
    along = speed * np.array([lift * axial + drag * tangential, lift * tangential - drag * axial])
    return np.array([*along, -drag * speed * radial, -0.02 * factor * square * speed**2 - cube * speed])


def loads_and_derivatives(station, chord, square, cube, twist, airspeed, sound):
    """(20, stations): the loads, and what they change per unit of each velocity and of pitch, by complex steps."""
    pitch = np.arctan(airspeed / (0.75 * TIP_SPEED)) + twist
    arguments = np.array(np.broadcast_arrays(SPEED * station, airspeed, 0.05 * airspeed, pitch))
    steps = 1e-30j * np.eye(4)[:, :, None]
    powers = sound, chord, square, cube
    rates = (np.imag(section_loads(*(arguments + step), *powers)) / 1e-30 for step in steps)
    return np.concatenate([section_loads(*arguments, *powers), *rates])


def at(distribution, station):
    """Chord, or twist from its value at three quarters of the radius."""
    if isinstance(distribution, tuple):
        return np.interp(station, *distribution)
    return np.full_like(station, distribution)


def twist_at(rotor, station):
    if isinstance(rotor.twist, tuple):
        return at(rotor.twist, station) - at(rotor.twist, np.array(0.75 * RADIUS))
    return rotor.twist * (station / RADIUS - 0.75)


def segment_ends(rotor):
    """Cutout and tip, and the hinges between them."""
    hinges = (rotor.flap_hinge_offset, rotor.lag_hinge_offset)
    ends = np.unique([rotor.root_cutout, *np.clip(hinges, rotor.root_cutout, RADIUS), RADIUS])
    return ends[np.append(True, np.diff(ends) > 1e-12 * RADIUS)]


def kinks(rotor):
    return np.concatenate(
        [np.asarray(d[0]) for d in (rotor.chord, rotor.twist) if isinstance(d, tuple)] or [[]]
    )


def fine_moments(rotor, airspeed, sound, start, end):
    """Moments, and moments without signs, by twenty points on each of hundreds of panels that widen from the root."""
    inside = [kink for kink in kinks(rotor) if start < kink < end]
    edges = np.unique([*np.geomspace(start, end, 201), *inside])
    nodes, weights = np.polynomial.legendre.leggauss(20)
    half = np.diff(edges)[:, None] / 2
    station, weight = (edges[:-1, None] + half * (1 + nodes)).ravel(), (half * weights).ravel()
    chord = at(rotor.chord, station)
    loads = loads_and_derivatives(
        station, chord, chord**2, chord**3, twist_at(rotor, station), airspeed, sound
    )
    moments = weight[:, None] * station[:, None] ** np.arange(3)
    return loads @ moments, np.abs(loads) @ moments


class AnyAirfoil:
    """Any airfoil but a straight lift line: its loads are not asked for here, and Mach numbers are its own affair."""

    contains_compressibility = True

    def coefficients(self, alpha, mach):
        raise AssertionError("not asked for")


@pytest.mark.parametrize("straight", [True, False], ids=["straight lift line", "any airfoil"])
@many
@given(blades, airspeeds)
def test_radial_moments_of_section_loads(straight, rotor, airspeed):
    rotor = rotor if straight else replace(rotor, airfoil=AnyAirfoil())
    sound = np.hypot(TIP_SPEED, airspeed) / (0.8 if straight else 1e-30)  # by the Mach number of the tip
    own, r = rotor.sections, rotor.quadrature.stations
    assert rotor.has_effective_sections == straight
    square, cube = own.chord**2 * own.square, own.chord**3 * own.cube
    loads = loads_and_derivatives(r, own.chord, square, cube, own.twist, airspeed, sound)
    moments = rotor.quadrature.moments(loads)
    ends = segment_ends(rotor)
    assert moments.shape == (20, len(ends) - 1, 3)
    for segment, (start, end) in enumerate(itertools.pairwise(ends)):
        expected, size = fine_moments(rotor, airspeed, sound, start, end)
        assert np.all(np.abs(moments[:, segment] - expected) <= 1e-10 * size)


@many
@given(blades)
def test_segments_lie_between_the_hinges(rotor):
    quadrature, ends = rotor.quadrature, segment_ends(rotor)
    middles = (ends[:-1] + ends[1:]) / 2
    assert np.array_equal(quadrature.beyond_flap_hinge, middles > rotor.flap_hinge_offset)
    assert np.array_equal(quadrature.beyond_lag_hinge, middles > rotor.lag_hinge_offset)
    lengths = quadrature.moments(np.ones((1, quadrature.stations.shape[-1])))[0, :, 0]
    assert np.allclose(lengths, np.diff(ends), rtol=1e-13)
    stations = quadrature.stations
    segments = np.searchsorted(ends, stations) - 1
    assert np.array_equal(quadrature.counts, np.bincount(segments)) and np.all(np.diff(segments) >= 0)


def moments_of_a_load(rotor, quadrature):
    """Of chord times twist squared, which takes no function that might round otherwise in arrays."""
    own = rotor.sections
    return quadrature.moments(own.chord * own.twist * own.twist)


@pytest.mark.parametrize("step", [0.0, 1e-30j])
@settings(many, max_examples=40)
@given(st.lists(st.tuples(between(3.5, 4.5), *SHARES), min_size=5, max_size=9), chords, twists)
def test_each_of_many_blades_has_the_quadrature_it_would_have_alone(step, shares, chord, twist):
    """Bit for bit, however many stations the others have, and to the imaginary parts of a complex step."""
    radius, *others = np.transpose(shares)
    radius = radius * (1 + step)
    singles = [blade(*numbers, chord, twist) for numbers in zip(radius, *others, strict=True)]
    whole = blade(radius, *others, chord, twist).quadrature
    seen = []
    for rows in whole.alike():
        some = blade(radius[rows], *(other[rows] for other in others), chord, twist)
        moments = moments_of_a_load(some, whole.take(rows))
        for row, found in zip(rows, moments, strict=True):
            alone = singles[row].quadrature
            present = whole.counts[row] > 0
            assert np.array_equal(whole.counts[row][present], alone.counts)
            assert np.array_equal(whole.edges[row][present], alone.edges)
            for name in ("stations", "weights"):
                own = getattr(alone, name)
                assert np.array_equal(getattr(whole, name)[row][: len(own)], own)
            assert not whole.weights[row, len(alone.stations) :].any()
            assert np.array_equal(found[present], moments_of_a_load(singles[row], alone))
            assert not found[~present].any()
        seen += rows.tolist()
    assert sorted(seen) == list(range(len(shares)))


@many
@given(mass_distributions(RADIUS), zero_or(between(0.01, 0.6)), zero_or(between(0.01, 0.3)))
def test_mass_integrals_of_a_distribution(distribution, flap_hinge, gap):
    flap_hinge, lag_hinge = RADIUS * flap_hinge, RADIUS * (flap_hinge + gap)
    rotor = pp.Rotor.from_mass_distribution(
        *distribution,
        n_blades=3,
        radius=RADIUS,
        flap_hinge_offset=flap_hinge,
        lag_hinge_offset=lag_hinge,
        flap_stiffness=1.0,
        lag_stiffness=1.0,
        chord=0.3,
        airfoil=pp.Airfoil(lift_slope=5.7),
    )

    def integral(power, hinge):
        edges = np.unique([*(r for r in distribution[0] if r > hinge), hinge])

        def integrand(r):
            return np.interp(r, *distribution) * (r - hinge) ** power

        return sum(quad(integrand, *piece)[0] for piece in itertools.pairwise(edges))

    assert np.isclose(rotor.blade_mass, integral(0, 0.0), rtol=1e-12)
    for name, hinge in (("blade", 0.0), ("flap", flap_hinge), ("lag", lag_hinge)):
        assert np.isclose(getattr(rotor, f"{name}_first_moment"), integral(1, hinge), rtol=1e-12)
        assert np.isclose(getattr(rotor, f"{name}_inertia"), integral(2, hinge), rtol=1e-12)


@pytest.mark.parametrize("hinge", ["flap", "lag"])
def test_mass_within_a_hinge_does_not_count_for_it(hinge):
    """A blade that is bare outboard of a hinge has nothing to flap or lag."""
    offsets = (
        {"flap_hinge_offset": 2.5, "lag_hinge_offset": 2.5} if hinge == "flap" else {"lag_hinge_offset": 2.5}
    )
    with pytest.raises(pp.InputError, match=f"{hinge}_inertia = 0.0: must be above zero"):
        pp.Rotor.from_mass_distribution(
            [0.0, 2.0, 2.1, RADIUS],
            [5.0, 5.0, 0.0, 0.0],
            n_blades=3,
            radius=RADIUS,
            flap_stiffness=1.0,
            lag_stiffness=1.0,
            chord=0.3,
            airfoil=pp.Airfoil(lift_slope=5.7),
            **offsets,
        )
