"""The rotating elastic blade against published frequencies, polynomials along the whole blade, and differences."""

import numpy as np
import pytest
from scipy.linalg import eigh

from proprotor.errors import InputError
from proprotor.rotor.blade_stations import BladeStations
from proprotor.rotor.elastic_blade import ElasticBlade

# Uniform cantilever, frequencies out of the disk in units of sqrt(EI/mL^4), by rotor speed: Wright, Smith, Thresher and
# Wang, Vibration modes of centrifugally stiffened beams, J. Appl. Mech. 49 (1982).
PUBLISHED = {
    0: (3.5160, 22.0345, 61.6972),
    1: (3.6816, 22.1810, 61.8418),
    3: (4.7973, 23.3203, 62.9850),
    6: (7.3604, 26.8091, 66.6840),
    12: (13.1702, 37.6031, 79.6145),
}


def stations(count=25, **changed):
    one = np.ones(count)
    given = {
        "radius": np.linspace(0, 1, count),
        "mass_per_length": one,
        "flatwise_stiffness": one,
        "edgewise_stiffness": 4 * one,
        "torsion_stiffness": one,
        "twist": 0 * one,
        "control_stiffness": 3.0,
    }
    return BladeStations(**given | changed)


def tapered_blade(seed, count=31):
    """A twisted blade whose properties are linear along it, all of it outboard of the bearing."""
    rng = np.random.default_rng(seed)
    r = np.linspace(0.08, 1.1, count)
    names = ("mass_per_length", "flatwise_stiffness", "edgewise_stiffness", "torsion_stiffness")
    columns = {
        name: size * (rng.uniform(1.0, 2.0) - rng.uniform(0, 0.8) * r)
        for name, size in zip(names, (1, 1, 6, 1), strict=True)
    }
    return BladeStations(radius=r, **columns, twist=0.6 - 0.7 * r, control_stiffness=2.0)


def bent_blade(seed=0, count=9):
    """A blade whose properties differ from station to station, with a twist and a bearing between two stations."""
    rng = np.random.default_rng(seed)
    r = np.sort(np.concatenate([[0.08, 1.1], rng.uniform(0.15, 1.0, count - 2)]))
    names = ("mass_per_length", "flatwise_stiffness", "edgewise_stiffness", "torsion_stiffness")
    columns = {
        name: size * rng.uniform(0.5, 2.0, count) for name, size in zip(names, (1, 1, 6, 1), strict=True)
    }
    return BladeStations(radius=r, **columns, twist=0.6 - 0.7 * r, pitch_bearing=0.2, control_stiffness=2.0)


@pytest.mark.parametrize("speed", PUBLISHED)
def test_a_uniform_blade_has_the_published_frequencies(speed):
    """In the disk the square of each frequency is less by that of the rotor speed."""
    found = ElasticBlade(stations(edgewise_stiffness=np.ones(25))).modes(speed, 0.0, "clamped", 6).frequency
    out = np.array(PUBLISHED[speed])
    expected = np.sort(np.concatenate([out, np.sqrt(out**2 - speed**2)]))
    np.testing.assert_allclose(found, expected, rtol=3e-5)


def test_southwell():
    """ω² is at least ω₀² + (least quotient at no stiffness) Ω², and grows less than in proportion with Ω²."""
    speeds = np.linspace(0, 10, 6)
    square = (
        ElasticBlade(stations(edgewise_stiffness=np.full(25, 1e4)))
        .modes(speeds, 0.0, "clamped", 1)
        .frequency[:, 0]
        ** 2
    )
    slopes = np.diff(square) / np.diff(speeds**2)
    assert (np.diff(slopes) < 0).all()
    assert (slopes > 1.0).all()  # that of a rigid blade at its centre


@pytest.mark.parametrize("pitch", [0.0, 0.3, 1.2])
@pytest.mark.parametrize("hub", [0.0, 0.1])
def test_on_a_free_gimbal_a_blade_tilts_once_per_revolution(hub, pitch):
    """Whatever its stiffness: the disk then turns about another axis."""
    blade = ElasticBlade(stations(radius=np.linspace(hub, 1, 25), edgewise_stiffness=np.full(25, 40.0)))
    found = blade.modes(2.0, pitch, "gimballed", 1).frequency
    assert found[0] == pytest.approx(2.0, rel=1e-6)  # rounding, beside a largest frequency of 3e4


@pytest.mark.parametrize("seed", range(3))
def test_frequencies_are_those_of_polynomials_along_the_whole_blade(seed):
    """A Ritz model on polynomials of r with its own sums."""
    table = tapered_blade(seed)
    speed, pitch = 1.7, 0.35
    found = ElasticBlade(table).modes(speed, pitch, "clamped", 3).frequency
    np.testing.assert_allclose(found, ritz(table, speed, pitch)[:3], rtol=1e-5)


def ritz(table, speed, pitch, terms=14):
    """Frequencies by Legendre polynomials times (r - r0)², on 4,000 midpoints of the blade."""
    r0, tip = table.radius[0], table.radius[-1]
    edges = np.linspace(r0, tip, 4001)
    r, step = (edges[1:] + edges[:-1]) / 2, np.diff(edges)
    x = (r - r0) / (tip - r0)
    rows = []
    for n in range(terms):
        p = np.polynomial.Legendre.basis(n, domain=[0, 1])
        first, second = p.deriv()(x), p.deriv(2)(x)
        value = x**2 * p(x)
        slope = 2 * x * p(x) + x**2 * first
        curvature = 2 * p(x) + 4 * x * first + x**2 * second
        rows.append([value, slope / (tip - r0), curvature / (tip - r0) ** 2])
    value, slope, curvature = np.swapaxes(np.array(rows), 0, 1)

    def column(name):
        return np.interp(r, table.radius, getattr(table, name))

    mass = column("mass_per_length")
    tension = speed**2 * (np.cumsum((mass * r * step)[::-1])[::-1] - mass * r * step / 2)
    twist = column("twist") - np.interp(0.75 * tip, table.radius, table.twist)
    angle = pitch + twist
    flat, edge = column("flatwise_stiffness"), column("edgewise_stiffness")

    def sums(first, weight, second):
        return (first * (weight * step)) @ second.T

    sine, cosine = np.sin(angle), np.cos(angle)
    own = sums(slope, tension, slope)
    inside = (
        sums(curvature, flat * sine**2 + edge * cosine**2, curvature)
        + own
        - speed**2 * sums(value, mass, value)
    )
    out = sums(curvature, flat * cosine**2 + edge * sine**2, curvature) + own
    both = sums(curvature, (flat - edge) * sine * cosine, curvature)
    stiffness = np.block([[inside, both], [both, out]])
    whole = np.kron(np.eye(2), sums(value, mass, value))
    return np.sqrt(eigh(stiffness, whole, eigvals_only=True))


def test_torque_is_the_change_of_the_energy_with_pitch():
    blade, step = ElasticBlade(bent_blade()), 1e-5
    shape = np.random.default_rng(4).normal(size=(4 * len(blade.stations.nodes), 2))
    _, torque = blade.deflection(0.4, shape)
    ends = [shape.T @ blade.stiffness(1.3, 0.4 + side * step) @ shape for side in (1, -1)]
    np.testing.assert_allclose(
        torque, (ends[0] - ends[1]) / (2 * step), rtol=1e-7, atol=1e-7 * np.abs(torque).max()
    )
    along = blade.torque_along(0.4, shape)
    np.testing.assert_allclose((along * blade.weight).sum(axis=(-2, -1)), torque, rtol=1e-12)


def test_a_turn_under_an_even_torque():
    """Control system and blade in series: T/K + (x - x²/2) T/GJ for a unit blade with its bearing at the centre."""
    blade = ElasticBlade(stations())
    turn, total = blade.turned_by(np.ones(blade.weight.shape), 0.75)
    assert total == pytest.approx(1.0, rel=1e-12)
    assert turn == pytest.approx(1 / 3 + 0.75 - 0.75**2 / 2, rel=1e-12)


def test_nothing_inboard_of_the_bearing_turns_with_the_pitch():
    soft = np.where(np.linspace(0, 1, 25) < 0.5, 1.0, 1e3)
    held = ElasticBlade(
        stations(flatwise_stiffness=soft, edgewise_stiffness=np.full(25, 1e3), pitch_bearing=0.55)
    )
    first, last = (held.modes(1.0, pitch, "clamped", 1).frequency for pitch in (0.0, 1.0))
    assert first == pytest.approx(last, rel=1e-2)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"radius": np.linspace(1, 0, 25)}, "radius = 25 stations: must increase from station to station"),
        ({"twist": np.zeros(3)}, "twist = array of shape (3,): must have a value for each of 25 stations"),
        ({"mass_per_length": np.zeros(25)}, "must be above zero"),
        (
            {"pitch_bearing": 0.8},
            "pitch_bearing = 0.8: must lie inboard of 0.75 R (0.75 m), where pitch is counted",
        ),
        ({"control_stiffness": np.nan}, "control_stiffness = nan: must be finite"),
        ({"radius": np.array([0.0, 1.0])}, "must be a list of at least 3 stations"),
    ],
)
def test_impossible_stations_are_refused(changed, message):
    with pytest.raises(InputError) as caught:
        stations(**changed)
    assert message in str(caught.value)
