"""The envelope of a deck: each place against a case made by hand, speeds against closed forms, verdicts."""

import math

import numpy as np
import pytest
import scipy.linalg

import proprotor as pp
from proprotor.stability.envelope_dataset import MET, NOT_KNOWN, NOT_MET

KNOT, FOOT, RPM, HP = 1852 / 3600, 0.3048, math.pi / 30, 550 * 0.3048 * 4.4482216152605
CLOSE = 1e-8  # of an airspeed: a search ends with a correction of a billionth
# m: where 280 KEAS are Mach 0.5, by p = ρ0 V² / (γ M²) and the troposphere of ISO 2533.
CORNER = (
    288.15 / 0.0065 * (1 - (1.225 * (280 * KNOT / 0.5) ** 2 / 1.4 / 101325) ** (287.05287 * 0.0065 / 9.80665))
)
DECK = """
base = "xv15-wing"

[case]
name = "wing"
title = "A wing"

[envelope]
dive_speed = { value = "280 keas", status = "assumed", source = "an example" }
dive_mach = 0.5
altitudes = { value = [0, 12000, 20000], unit = "ft" }

[variants.heavy]
condition = "normal"
support.mass_per_length = "4 lb/in"

[variants.soft-controls]
rotor.control_stiffness = "5400 N*m/rad"
"""
WITH_AXES = """
rotor_speeds = { value = [458, 520], unit = "rpm" }
powers = { value = [0, 900], unit = "hp" }
"""


@pytest.fixture(scope="module")
def deck(tmp_path_factory):
    """A function that writes a deck and loads it."""
    folder = tmp_path_factory.mktemp("decks")

    def load(text=DECK, settings=None):
        path = folder / "wing.toml"
        path.write_text(text)
        return pp.load_case(path, settings)

    return load


@pytest.fixture(scope="module")
def case(deck):
    return deck()


@pytest.fixture(scope="module")
def found(case):
    return case.envelope()


@pytest.fixture(scope="module")
def with_axes(deck):
    return deck(DECK.replace('unit = "ft" }\n', f'unit = "ft" }}{WITH_AXES}')).envelope()


def isa(altitude):
    """Density and speed of sound of the troposphere, by the formulas of ISO 2533."""
    temperature = 288.15 - 0.0065 * altitude
    pressure = 101325 * (temperature / 288.15) ** (9.80665 / (287.05287 * 0.0065))
    return pressure / (287.05287 * temperature), np.sqrt(1.4 * 287.05287 * temperature)


def test_conditions_are_the_deck_its_normal_variants_and_each_failure_with_each_of_these(found):
    assert found.condition.values.tolist() == [
        "as the deck",
        "heavy",
        "soft-controls",
        "heavy, soft-controls",
    ]
    assert found.failure.values.tolist() == [False, False, True, True]


def test_speeds_at_altitude_are_those_of_closed_forms(found):
    altitude = np.insert(np.array([0.0, 12000, 20000]) * FOOT, 1, CORNER)
    np.testing.assert_allclose(found.altitude, altitude, rtol=1e-6)
    density, sound = isa(altitude)
    np.testing.assert_allclose(found.density, density, rtol=2e-6)
    np.testing.assert_allclose(found.speed_of_sound, sound, rtol=2e-6)
    dive = np.minimum(280 * KNOT * np.sqrt(1.225 / density), 0.5 * sound)
    np.testing.assert_allclose(found.dive, dive, rtol=3e-6)
    assert (dive == 0.5 * sound)[[0, 2, 3]].tolist() == [False, True, True]  # M_D above the corner alone
    assert 280 * KNOT * np.sqrt(1.225 / density[1]) == pytest.approx(0.5 * sound[1], rel=1e-9)
    normal, failure = found.required.values[0], found.required.values[2]
    np.testing.assert_allclose(normal, 1.15 * dive, rtol=3e-6)
    np.testing.assert_allclose(failure, dive, rtol=3e-6)
    onset = found.onset.values[0, 0, 0]
    np.testing.assert_allclose(
        found.equivalent_onset.values[0, 0, 0], onset * np.sqrt(density / 1.225), rtol=3e-6
    )
    np.testing.assert_allclose(found.mach_onset.values[0, 0, 0], onset / sound, rtol=3e-6)
    np.testing.assert_allclose(found.margin.values[0, 0, 0], onset / (1.15 * dive) - 1, atol=1e-5)


@pytest.mark.parametrize("altitude", [0.0, 12000.0, 20000.0])
def test_limits_between_the_altitudes_have_their_corner(found, altitude):
    """The line of V_D bends where it meets M_D, wherever the altitudes of the deck are."""
    density, sound = isa(found.height.values)
    equivalent = np.minimum(280 * KNOT, 0.5 * sound * np.sqrt(density / 1.225))
    np.testing.assert_allclose(found.limits.sel(limit="dive"), equivalent, rtol=3e-6)
    np.testing.assert_allclose(found.limits.sel(limit="normal"), 1.15 * equivalent, rtol=3e-6)
    at = np.interp(altitude * FOOT, found.height, found.limits.sel(limit="failure"))
    required = found.required.values[2, int(np.argmin(np.abs(found.altitude.values - altitude * FOOT)))]
    assert at == pytest.approx(required * np.sqrt(isa(altitude * FOOT)[0] / 1.225), rel=1e-3)


def test_a_temperature_offset_thins_the_air(deck):
    hot = deck(settings={"envelope.temperature_offset": "20 K"}).envelope(variants=[])
    altitude = hot.altitude.values
    temperature = 288.15 - 0.0065 * altitude
    density, sound = isa(altitude)
    np.testing.assert_allclose(hot.density, density * temperature / (temperature + 20), rtol=3e-6)
    np.testing.assert_allclose(
        hot.speed_of_sound, sound * np.sqrt((temperature + 20) / temperature), rtol=3e-6
    )
    assert hot.condition.values.tolist() == ["as the deck"]


@pytest.mark.parametrize("condition", range(4))
@pytest.mark.parametrize("altitude", range(4))
def test_a_place_is_the_flutter_point_of_a_case_made_by_hand(found, condition, altitude):
    names = {
        "heavy": ("support.mass_per_length", "4 lb/in"),
        "soft-controls": ("rotor.control_stiffness", "5400 N*m/rad"),
    }
    settings = dict(names[name] for name in found.condition.values[condition].split(", ") if name in names)
    settings["operation.altitude"] = f"{float(found.altitude[altitude])!r} m"
    point = pp.load_case("xv15-wing", settings).flutter_point()
    here = found.isel(condition=condition, altitude=altitude, rotor_speed=0, power=0)
    assert here.onset.item() == pytest.approx(point.speed, rel=CLOSE)
    assert here["mode"].item() == point.mode and here.kind.item() == point.kind
    assert here.frequency.item() == pytest.approx(point.frequency, rel=1e-7)
    assert here.verdict.item() == (MET if point.speed > here.required.item() else NOT_MET)


@pytest.mark.parametrize("place", [(0, 0), (0, 1), (1, 0), (1, 1)])
def test_rotor_speeds_and_powers_are_those_of_a_case_made_by_hand(with_axes, place):
    """A power is a power coefficient that differs with the air and the rotor speed; no power is a windmilling rotor."""
    turning, power = place
    omega = [458, 520][turning] * RPM
    density, _ = isa(12000 * FOOT)
    radius = pp.load_case("xv15-wing").rotor.radius
    coefficient = 900 * HP / (density * math.pi * radius**2 * (omega * radius) ** 3)
    trim = f"{{ power_coefficient = {coefficient!r} }}" if power else "windmill"
    settings = {
        "operation.altitude": "12000 ft",
        "operation.rotor_speed": f"{omega!r} rad/s",
        "operation.trim": trim,
    }
    point = pp.load_case("xv15-wing", settings).flutter_point()
    here = with_axes.isel(condition=0, rotor_speed=turning, power=power, altitude=2)
    assert here.onset.item() == pytest.approx(point.speed, rel=1e-5)  # the air of the test has six digits
    assert here.turning.item() == pytest.approx(omega, rel=1e-12) == here.rotor_speed.item()
    assert here.power.item() == pytest.approx([0, 900 * HP][power], rel=1e-12)


def test_damping_at_the_speed_needed_is_that_of_all_roots(case, found):
    """And its slope is that of differences, per equivalent airspeed."""

    def least(speed, altitude):
        model = pp.load_case("xv15-wing", {"operation.altitude": f"{altitude} ft"}).linearize(speed)
        n = len(model.dofs)
        zero, one = np.zeros((n, n)), np.eye(n)
        left = np.block([[zero, one], [-model.K, -model.C]])
        roots = scipy.linalg.eigvals(left, np.block([[one, zero], [zero, model.M]]))
        roots = roots[np.abs(roots) > 1e-5]
        return (-roots.real / np.abs(roots)).min()

    for place, altitude in ((0, 0), (2, 12000), (3, 20000)):
        here = found.isel(condition=0, rotor_speed=0, power=0, altitude=place)
        speed = here.required.item()
        assert here.damping.item() == pytest.approx(least(speed, altitude), rel=1e-6)
        per = math.sqrt(1.225 / isa(altitude * FOOT)[0])
        slope = (least(speed + 0.05, altitude) - least(speed - 0.05, altitude)) / 0.1 * per
        assert here.damping_rate.item() == pytest.approx(slope, rel=1e-3, abs=1e-8)


def test_the_damping_required_is_sought_up_to_the_dive_speed(deck):
    """In normal conditions alone; where it is lost lower, the place does not meet the requirement."""
    level = 0.0015
    found = deck(
        settings={"envelope.damping_ratio": f"{level}", "envelope.failure_speed_factor": "0.9"}
    ).envelope()
    assert np.isnan(found.damping_onset.values[found.failure.values]).all()
    lost = 0
    for altitude, text in ((0, "0 ft"), (2, "12000 ft"), (3, "20000 ft")):
        here = found.isel(condition=0, rotor_speed=0, power=0, altitude=altitude)
        dive = here.dive.item()
        point = pp.load_case("xv15-wing", {"operation.altitude": text}).flutter_point(level=level)
        first = point.speed if not point.unstable_at_start else 0.0
        if first < dive:
            lost += 1
            assert here.verdict.item() == NOT_MET and "0.15 %" in here.why.item()
            if first:
                assert here.damping_onset.item() == pytest.approx(first, rel=CLOSE)
        else:
            assert np.isnan(here.damping_onset.item())
    assert lost


def test_a_lock_number_does_not_make_the_chord_grow_with_altitude(deck):
    own = pp.load_case("xv15-wing")
    rotor = own.rotor
    lock = (
        own.operation.density
        * rotor.airfoil.lift_slope
        * np.mean(np.atleast_1d(rotor.chord))
        * rotor.radius**4
    ) / rotor.blade_inertia
    given = deck(settings={"rotor.lock_number": f"{float(lock)!r}"}).envelope(variants=[])
    chord = deck(settings={"rotor.chord": f"{float(np.mean(np.atleast_1d(rotor.chord)))!r} m"}).envelope(
        variants=[]
    )
    np.testing.assert_allclose(given.onset, chord.onset, rtol=CLOSE)


def test_what_could_not_be_analysed_is_not_known_and_spoils_no_other(deck, found):
    """Air so cold that blades pass Mach 1 below the speed needed at one rotor speed of two."""
    text = DECK.replace(
        'unit = "ft" }\n', 'unit = "ft" }\nrotor_speeds = { value = [458, 800], unit = "rpm" }\n'
    )
    two = deck(text).envelope("100:350:10keas", variants=[])
    fast = two.isel(condition=0, rotor_speed=1, power=0)
    assert (fast.verdict.values != MET).all() and "Mach" in fast.reason.values[-1]
    slow = two.isel(condition=0, rotor_speed=0, power=0)
    np.testing.assert_allclose(slow.onset, found.onset.values[0, 0, 0], rtol=CLOSE)
    assert (slow.reason.values == "").all()


def test_a_search_that_ends_below_the_speed_needed_says_so(case):
    short = case.envelope("100:250:10keas", variants=[])
    assert (short.verdict.values == NOT_KNOWN).all()
    assert short.why.values[0, 0, 0, 0] == "the search ends at 250 KEAS"


def test_a_case_that_is_unstable_from_the_start_does_not_meet_it(deck):
    found = deck(settings={"envelope.speed_factor": "1.3"}).envelope("335:360:5keas", variants=[])
    here = found.isel(condition=0, rotor_speed=0, power=0, altitude=0)
    assert here.verdict.item() == NOT_MET and np.isnan(here.onset.item())
    assert here.why.item() == "beam is unstable at the lowest airspeed already, 335 KEAS"
    assert found.attrs["worst_place"] == [0, 0, 0, 0]


def test_a_search_that_begins_above_the_speed_needed_says_so(case):
    high = case.envelope("325:330:5keas", variants=[])
    here = high.isel(condition=0, rotor_speed=0, power=0, altitude=0)
    assert here.verdict.item() == NOT_KNOWN and here.why.item() == "the search begins at 325 KEAS"


def test_the_worst_case_is_the_least_margin(found):
    place = np.unravel_index(np.nanargmin(found.margin.values), found.margin.shape)
    assert tuple(found.attrs["worst_place"]) == tuple(map(int, place))
    assert found.attrs["worst"].startswith(str(found.condition.values[place[0]]))


def test_numbers_that_a_case_has_changed_hold_in_all_its_conditions(case, found):
    same = case.vary({"support.torsion_stiffness": 1.5 * case.given["support.torsion_stiffness"].si})
    other = same.envelope(variants=["soft-controls"])
    stiffer = pp.load_case(
        "xv15-wing",
        {"support.torsion_stiffness": "4.2e9 lbf*in**2", "rotor.control_stiffness": "5400 N*m/rad"},
    ).vary({})
    at = stiffer.flutter_point()
    assert other.condition.values.tolist() == ["as the deck", "soft-controls"]
    assert other.onset.values[1, 0, 0, 0] == pytest.approx(at.speed, rel=1e-5)
    assert other.onset.values[1, 0, 0, 0] != pytest.approx(found.onset.values[2, 0, 0, 0], rel=1e-4)


def test_one_side_of_an_aircraft_may_fail(deck):
    text = """
base = "xv15-aircraft"

[case]
name = "aircraft"

[envelope]
dive_speed = "280 keas"
altitudes = { value = [0, 15000], unit = "ft" }

[variants.left-downstop-off]
left.support.downstop = false
"""
    found = deck(text).envelope("150:350:20keas")
    assert found.condition.values.tolist() == ["as the deck", "left-downstop-off"]
    assert set(found.kind.values.ravel().tolist()) <= {"", "flutter"}
    one = """
base = "xv15-aircraft"

[case]
name = "one side"

[operation]
altitude = "15000 ft"

[left]
support.downstop = false
"""
    point = deck(one).flutter_point("150:350:20keas")
    here = found.isel(condition=1, rotor_speed=0, power=0, altitude=1)
    np.testing.assert_allclose(here.onset, point.speed, rtol=CLOSE)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"envelope.dive_speed": "280 kt"}, r"^envelope.dive_speed = 280 kt: must be an equivalent airspeed"),
        (
            {"envelope.altitudes": '{value=[0, 40], unit="km"}'},
            r"^altitude = 40000 m: must lie between -610 and 32000 m",
        ),
        (
            {"variants.heavy.operation.altitude": "3 km"},
            r"^variants.heavy.operation.altitude: must not be set",
        ),
        (
            {"variants.heavy.condtion": "normal"},
            r"^variants.heavy.condtion = normal: unknown field .* condition\?",
        ),
        ({"variants.heavy.support.spam": "1"}, r"^variants.heavy.support.spam = 1: unknown field"),
        (
            {"variants.heavy.condition": "bad"},
            r"^variants.heavy.condition = bad: must be 'normal' or 'failure'",
        ),
        ({"variants.none.condition": "normal"}, r"^variants.none: must have a field in which"),
    ],
)
def test_what_means_nothing_is_refused(deck, settings, message):
    with pytest.raises(pp.InputError, match=message):
        deck(settings=settings).envelope("200:300:50keas", variants=["heavy"])


def test_what_the_envelope_varies_no_variant_may_set(deck):
    text = DECK.replace('unit = "ft" }\n', f'unit = "ft" }}{WITH_AXES}')
    for field, value in (("rotor_speed", "500 rpm"), ("trim", "windmill")):
        with pytest.raises(
            pp.InputError, match=f"^variants.heavy.operation.{field}: must not be set in a variant"
        ):
            deck(text, {f"variants.heavy.operation.{field}": value}).envelope("200:300:50keas")


def test_a_deck_without_an_envelope_says_what_it_needs():
    with pytest.raises(pp.InputError, match=r"^envelope: is missing; a deck says in \[envelope\]"):
        pp.load_case("xv15").envelope()
    with pytest.raises(pp.InputError, match=r"variants = heavi: unknown variant .*did you mean heavy"):
        raise_for = pp.load_case(
            "xv15",
            {
                "envelope.dive_speed": "280 keas",
                "envelope.altitudes": '{value=[0,1],unit="km"}',
                "variants.heavy.rotor.precone": "2 deg",
            },
        )
        raise_for.envelope(variants=["heavi"])


def test_variants_of_a_base_belong_to_the_decks_that_alter_it(tmp_path):
    (tmp_path / "one.toml").write_text(DECK)
    (tmp_path / "two.toml").write_text(
        'base = "one.toml"\n[case]\nname = "two"\n[envelope]\ndive_speed = "250 keas"\n'
        '[variants.heavy]\nsupport.nacelle_mass = "1700 lb"\n'
    )
    two = pp.load_case(tmp_path / "two.toml").deck
    assert set(two.variants) == {"heavy", "soft-controls"} and two.envelope.dive_speed.si == 250.0
    assert set(two.variants["heavy"].support) == {"mass_per_length", "nacelle_mass"}
    assert two.envelope.dive_mach.si == 0.5
