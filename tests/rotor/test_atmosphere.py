"""Air at altitude against the tables of the standard atmosphere, and decks that give an altitude."""

import numpy as np
import pytest

import proprotor as pp
from proprotor.rotor.atmosphere import standard_air

# U.S. Standard Atmosphere 1976 (the same as ISO 2533 up to 32 km), table of base levels: geopotential altitude in m,
# temperature in K, pressure in Pa, density in kg/m³, speed of sound in m/s, to the digits printed there.
TABLE = (
    (0.0, 288.150, 101325.0, 1.2250, 340.294),
    (11_000.0, 216.650, 22632.0, 0.36392, 295.069),
    (20_000.0, 216.650, 5474.8, 0.088035, 295.069),
    (32_000.0, 228.650, 868.01, 0.013225, 303.131),
)
PRINTED = 1e-4  # relative; the digits of the table allow a fifth of it
R, GAMMA = 287.05287, 1.4  # J/(kg K), and the ratio of specific heats, of the standard


@pytest.mark.parametrize(("altitude", "temperature", "pressure", "density", "speed_of_sound"), TABLE)
def test_the_published_table(altitude, temperature, pressure, density, speed_of_sound):
    air = standard_air(altitude)
    np.testing.assert_allclose(
        [air.temperature, air.pressure, air.density, air.speed_of_sound],
        [temperature, pressure, density, speed_of_sound],
        rtol=PRINTED,
    )


def test_a_hot_day_is_thinner_and_faster_at_the_same_pressure():
    """ISA + 15 at sea level: ρ = p / R T, a = √(γ R T)."""
    air = standard_air(0.0, 15.0)
    assert air.pressure == pytest.approx(101325)
    assert air.density == pytest.approx(101325 / (R * 303.15), rel=1e-5)
    assert air.speed_of_sound == pytest.approx(np.sqrt(GAMMA * R * 303.15), rel=1e-5)


def test_altitudes_are_geopotential():
    """Nothing but the layer's lapse rate is between the levels: 6.5 K a kilometre."""
    np.testing.assert_allclose(
        standard_air(np.array([1000.0, 5000.0, 10_000.0])).temperature, [281.65, 255.65, 223.15], rtol=1e-12
    )


@pytest.mark.parametrize("altitude", [-300.0, 3000.0, 15_000.0, 27_000.0])
def test_a_complex_step_is_the_derivative(altitude):
    """Against the mean of the standard's own hydrostatics, by central differences of 1 m."""
    exact = standard_air(np.array(altitude) + 1e-30j, 7.0)
    above, below = (standard_air(altitude + step, 7.0) for step in (1.0, -1.0))
    for name in air_fields():
        difference = (getattr(above, name) - getattr(below, name)) / 2
        assert getattr(exact, name).imag / 1e-30 == pytest.approx(difference, rel=1e-6, abs=1e-12)


def air_fields():
    return ("density", "speed_of_sound", "pressure", "temperature")


@pytest.mark.parametrize(
    ("altitude", "offset", "message"),
    [
        (40_000.0, 0.0, "altitude = 40000 m: must lie between -610 and 32000 m"),
        (-1000.0, 0.0, "altitude"),
        (np.nan, 0.0, "altitude"),
        (0.0, 288.15, "temperature_offset = 288.15 K: must lie between -100 and 100 K"),
        (np.array([0.0, 1e6]), 0.0, "altitude = 1e"),
    ],
)
def test_air_that_is_not_there(altitude, offset, message):
    with pytest.raises(pp.InputError, match=message):
        standard_air(altitude, offset)


@pytest.fixture
def deck(tmp_path):
    """A deck that alters the XV-15's operation."""

    def write(operation):
        path = tmp_path / "high.toml"
        path.write_text(
            f'base = "xv15-uncoupled"\n[case]\nname = "high"\ntitle = "High"\n[operation]\n{operation}\n'
        )
        return path

    return write


def test_a_deck_may_give_an_altitude(deck):
    case = pp.load_case(deck('altitude = "20000 ft"\ntemperature_offset = "15 degC"'))
    air = standard_air(6096.0, 15.0)
    assert case.operation.density == pytest.approx(air.density, rel=1e-12)
    assert case.operation.speed_of_sound == pytest.approx(air.speed_of_sound, rel=1e-12)
    assert case.sources["operation.density"].status == "derived"
    assert "operation.density" not in pp.design_inputs(case)
    assert {"operation.altitude", "operation.temperature_offset"} <= set(pp.design_inputs(case))
    # 20 000 ft, ISA + 15: T = 288.15 - 6.5e-3 * 6096 + 15 = 263.526 K
    assert case.operation.speed_of_sound == pytest.approx(np.sqrt(GAMMA * R * 263.526), rel=1e-4)


def test_the_offset_may_be_left_out_and_sea_level_is_the_deck_of_the_xv15(deck):
    low, xv15 = pp.load_case(deck('altitude = "0 m"')), pp.load_case("xv15-uncoupled")
    assert low.operation.density == pytest.approx(xv15.operation.density, rel=1e-4)
    assert low.operation.speed_of_sound == pytest.approx(xv15.operation.speed_of_sound, rel=1e-4)


def test_altitude_varies_in_batches_and_by_complex_steps(deck):
    case = pp.load_case(deck('altitude = "10000 ft"'))
    altitudes = np.array([0.0, 3048.0, 6096.0])
    batch = case.vary({"operation.altitude": altitudes}).linearize(150.0)
    for place, altitude in enumerate(altitudes):
        single = case.vary({"operation.altitude": altitude}).linearize(150.0)
        np.testing.assert_allclose(batch.C[place], single.C, rtol=1e-9, atol=1e-9 * np.abs(single.C).max())
    exact = case.vary({"operation.altitude": 3048.0 + 1e-30j}).linearize(150.0).C.imag / 1e-30
    ends = [case.vary({"operation.altitude": 3048.0 + step}).linearize(150.0).C for step in (1.0, -1.0)]
    np.testing.assert_allclose(exact, (ends[0] - ends[1]) / 2, rtol=1e-4, atol=1e-6 * np.abs(exact).max())


@pytest.mark.parametrize(
    ("operation", "message"),
    [
        ('altitude = "20000"', "operation.altitude = 20000: needs a unit"),
        ('altitude = "200000 ft"', "operation.altitude = 200000 ft: must lie between"),
        ('altitude = "0 ft"\ndensity = "1.2 kg/m**3"', "must not be given twice over"),
        ('temperature_offset = "15 K"', "operation.altitude: is missing"),
        ('altitude = "0 ft"\ntemperature_offset = "15 m"', "operation.temperature_offset = 15 m: must be a"),
    ],
)
def test_malformed_altitudes(deck, operation, message):
    with pytest.raises(pp.InputError) as error:
        pp.load_case(deck(operation))
    assert message in str(error.value)
    assert "\n" not in str(error.value)
