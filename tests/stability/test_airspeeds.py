"""True and equivalent airspeeds: every analysis takes both, and results say which they show."""

import json

import numpy as np
import pytest
from click.testing import CliRunner

import proprotor as pp
from proprotor import plots
from proprotor.commands.main import main
from proprotor.tables.sweep_table import SweepTable
from proprotor.units import airspeed_unit, in_metres_per_second, speed_factor, speeds

KNOT = 1852 / 3600
HIGH = {"operation.altitude": "20000 ft"}
# U.S. Standard Atmosphere 1976 at 20 000 ft: density ratio 0.5328, as tables of the atmosphere print it.
DENSITY_RATIO = 0.5328


@pytest.fixture(scope="module")
def high():
    return pp.load_case("xv15-uncoupled", HIGH)


def run(*arguments):
    return CliRunner().invoke(main, arguments)


def test_an_equivalent_airspeed_has_the_dynamic_pressure_of_sea_level():
    density = np.array([1.225, 0.6527, 0.1])
    true = in_metres_per_second("250 keas", density)
    np.testing.assert_allclose(density * true**2, 1.225 * (250 * KNOT) ** 2, rtol=1e-14)


def test_a_table_of_the_atmosphere_at_20000_feet(high):
    true = high.linearize("250 keas").airspeed
    assert float(true) / KNOT == pytest.approx(250 / np.sqrt(DENSITY_RATIO), rel=1e-4)


@pytest.mark.parametrize("unit", ["kt", "kts", "ktas", "KTAS", "knot"])
def test_knots_without_more_are_true(unit):
    assert in_metres_per_second(f"250 {unit}", 0.5) == pytest.approx(250 * KNOT, rel=1e-15)
    assert airspeed_unit(unit) == "KTAS"


def test_ranges_lists_quantities_and_labelled_arrays():
    xarray = pytest.importorskip("xarray")
    each = np.array([100.0, 150.0, 200.0]) * KNOT * np.sqrt(1.225 / 0.5)
    for given in (
        "100:200:50keas",
        ["100 keas", "150 KEAS", "200keas"],
        xarray.DataArray([100.0, 150.0, 200.0], attrs={"units": "keas"}),
    ):
        np.testing.assert_allclose(in_metres_per_second(given, 0.5), each, rtol=1e-14)
    np.testing.assert_allclose(speeds("100:200:50keas", density=0.5), each, rtol=1e-14)


@pytest.mark.parametrize(
    ("given", "density", "message"),
    [
        ("250 keas", None, "airspeed = 250 keas: is an equivalent airspeed, which needs air of one density"),
        ("250 keas", 0.0, "airspeed = 250 keas: is an equivalent airspeed, which has no meaning in a vacuum"),
        (["250 keas", "300 ktas"], 1.0, "must be true airspeeds, or all of them keas"),
        ("250 kcas", 1.0, "airspeed = 250 kcas: must be ktas or keas; kcas is none of the units here"),
        ("250 kmas", 1.0, "airspeed = 250 kmas: has an unknown unit"),
        ("-5 keas", 1.0, "airspeed = -5 keas: must not be negative"),
        ("9:5:1keas", 1.0, "airspeed = 9:5:1keas: must rise from start to stop"),
        ("3 keas*s", 1.0, "airspeed = 3 keas.s: must be an equivalent airspeed"),
    ],
)
def test_airspeeds_that_cannot_be(given, density, message):
    with pytest.raises(pp.InputError, match=message):
        in_metres_per_second(given, density)


def test_other_speeds_are_true():
    with pytest.raises(pp.InputError, match="speed_of_sound = 600 keas: is an equivalent airspeed"):
        pp.load_case("xv15-uncoupled", {"operation.speed_of_sound": "600 keas"})


ANALYSES = {
    "linearize": lambda case, speed: case.linearize(speed).K,
    "sweep": lambda case, speed: case.sweep(speed).airspeed.values,
    "sensitivity": lambda case, speed: (
        case.sensitivity("damping", ["rotor.precone"], airspeed=speed, mode="chord").derivative.values
    ),
    "attribution": lambda case, speed: case.attribution(speed, "chord").contribution.values,
    "study": lambda case, speed: (
        pp.study(case, {"rotor.precone": [0.03, 0.04]}, speed, workers=1).growth_rate.values
    ),
    "map": lambda case, speed: (
        case.stability_map(
            {"rotor.precone": [0.03, 0.04], "rotor.control_stiffness": [1e4, 2e4]}, airspeed=speed
        ).growth.values
    ),
    "input": lambda case, speed: case.sweep(speed, {"rotor.precone": [0.03, 0.04]}).eigenvalue.values,
}


@pytest.mark.parametrize("name", ANALYSES)
def test_every_analysis_takes_both(high, name):
    true = 250 * speed_factor("keas", high.operation.density)
    np.testing.assert_array_equal(ANALYSES[name](high, "250 keas"), ANALYSES[name](high, true))


def test_the_margin_and_the_range_of_a_search(high):
    found = high.flutter_point("150:360:10keas")
    assert found.searched[0] == pytest.approx(150 * speed_factor("keas", high.operation.density))
    assert found.margin("200 keas") == found.margin(200 * speed_factor("keas", high.operation.density))


@pytest.mark.parametrize("path", ["operation.altitude", "operation.temperature_offset"])
def test_points_of_different_density_need_true_airspeeds(path):
    case = pp.load_case(
        "xv15-uncoupled", {"operation.altitude": "0 ft", "operation.temperature_offset": "0 K"}
    )
    for analyse in (
        lambda: case.sweep("250 keas", {path: [0.0, 10.0]}),
        lambda: case.stability_map({path: [0.0, 10.0], "airspeed": "200:300:50keas"}),
        lambda: case.stability_map({path: [0.0, 10.0], "rotor.precone": [0.03, 0.04]}, airspeed="250 keas"),
        lambda: pp.study(case, {path: [0.0, 10.0]}, "250 keas"),
    ):
        with pytest.raises(pp.InputError, match="needs air of one density"):
            analyse()
    refused = run("map", "xv15-uncoupled", "--set", "operation.altitude=0 ft", "--x", "airspeed=200:300:50keas", "--y",
                  "operation.altitude=0:100:50m")  # fmt: skip
    assert refused.exit_code == 2 and "needs air of one density" in refused.output


def test_a_batch_of_densities_takes_them_each(high):
    batch = high.vary({"operation.altitude": np.array([0.0, 6096.0])}).linearize("250 keas")
    single = high.linearize("250 keas")
    assert batch.airspeed.shape == (2,)
    assert float(batch.airspeed[1]) == pytest.approx(float(single.airspeed), rel=1e-14)
    np.testing.assert_allclose(batch.K[1], single.K, rtol=1e-11, atol=1e-9 * np.abs(single.K).max())


def test_tables_and_axes_are_in_the_unit_asked_for(high):
    found = high.sweep("200:300:50keas")
    table = SweepTable(found, float(high.operation.rotor_speed), "keas")
    np.testing.assert_allclose(table.airspeed, [200, 250, 300], rtol=1e-10)
    assert "airspeed (KEAS)" in next(table.records())
    ax = plots.plot_damping(found, unit="keas")
    assert ax.get_xlabel() == "Airspeed, KEAS" and ax.get_xlim() == pytest.approx((200, 300))
    many = high.vary({"operation.altitude": np.array([0.0, 1.0, 2.0])})
    with pytest.raises(pp.InputError, match="unit = keas"):
        plots.plot_damping(many.sweep(found.airspeed.values), unit="keas")


def test_a_flutter_speed_at_altitude_has_both(high):
    arguments = (
        "flutter",
        "xv15-uncoupled",
        "--set",
        "operation.altitude=20000 ft",
        "--scan",
        "250:470:10ktas",
    )
    document = json.loads(run(*arguments, "--json").stdout)
    true, equivalent = (document[f"flutter speed ({unit})"] for unit in ("KTAS", "KEAS"))
    assert equivalent / true == pytest.approx(np.sqrt(DENSITY_RATIO), rel=1e-4)
    assert f"{true:.2f}? KTAS, {equivalent:.2f}? KEAS" in run(*arguments).stdout
    at_sea_level = run("flutter", "xv15-uncoupled", "--scan", "300:400:10ktas").stdout
    assert "KTAS" in at_sea_level and "KEAS" not in at_sea_level


def test_commands_take_both():
    margin = json.loads(
        run(
            "flutter",
            "xv15-uncoupled",
            "--set",
            "operation.altitude=20000 ft",
            "--scan",
            "250:470:10kt",
            "--speed",
            "200 keas",
            "--json",
        ).stdout
    )["at"]
    assert margin["airspeed (m/s)"] == pytest.approx(200 * KNOT / np.sqrt(DENSITY_RATIO), rel=1e-4)
    told = run("attribution", "xv15-uncoupled", "--speed", "350keas", "--mode", "chord").stdout
    assert "chord at 350 KEAS" in told
    refused = run("sweep", "xv15-uncoupled", "--set", "operation.density=0 kg/m**3", "--speed", "250 keas")
    assert refused.exit_code == 2 and "no meaning in a vacuum" in refused.output
