"""Text, quantities of pint and data arrays of xarray wherever numbers are taken, and the same results as by SI."""

import numpy as np
import pytest
import xarray as xr
from pint import UnitRegistry

import proprotor as pp

KT, DEG = 1852 / 3600, np.pi / 180
FOREIGN = UnitRegistry()  # not the package's own
CASE = pp.load_case("xv15-uncoupled")


def data_array(values, units):
    return xr.DataArray(np.asarray(values, dtype=float), dims="x", attrs={"units": units})


@pytest.mark.parametrize(
    "speed",
    ["250 kt", 250 * FOREIGN.knot, xr.DataArray(250.0, attrs={"units": "kt"}), xr.DataArray(250 * KT)],
)
def test_one_speed_is_one_point(speed):
    model, expected = CASE.linearize(speed), CASE.linearize(250 * KT)
    assert model.M.shape == expected.M.shape == (15, 15)
    np.testing.assert_allclose(model.K, expected.K, rtol=1e-12, atol=1e-6)
    assert CASE.sweep(speed).sizes["airspeed"] == 1
    assert "airspeed" not in model.modes().dims


@pytest.mark.parametrize(
    "speeds",
    [
        "200:300:50 kt",
        ["200 kt", "250 kt", "300 kt"],
        [200, 250, 300] * FOREIGN.knot,
        data_array([200, 250, 300], "kt"),
        data_array(np.array([200, 250, 300]) * KT, "m/s"),
        xr.DataArray(np.array([200, 250, 300]) * KT, dims="anything"),
    ],
)
def test_several_speeds_are_a_line(speeds):
    np.testing.assert_allclose(CASE.linearize(speeds).airspeed, np.array([200, 250, 300]) * KT, rtol=1e-14)


@pytest.mark.parametrize(
    "angles", ["1:2:1 deg", ["1 deg", "2 deg"], [1, 2] * FOREIGN.degree, data_array([1, 2], "deg")]
)
def test_inputs_that_vary(angles):
    expected = np.array([1, 2]) * DEG
    np.testing.assert_allclose(CASE.vary({"rotor.precone": angles}).rotor.precone, expected)
    found = CASE.sweep("250 kt", {"rotor.precone": angles})
    np.testing.assert_allclose(found["rotor.precone"], expected)
    np.testing.assert_allclose(
        found.eigenvalue, CASE.sweep(250 * KT, {"rotor.precone": expected}).eigenvalue, rtol=1e-9
    )
    axes = {"airspeed": "200:300:100 kt", "rotor.precone": angles}
    np.testing.assert_allclose(CASE.stability_map(axes)["rotor.precone"], expected)
    found = pp.study(CASE, {"rotor.precone": angles}, "250 kt", workers=1, progress=False)
    np.testing.assert_allclose(found["rotor.precone"], expected)
    assert "airspeed" not in found.dims


@pytest.mark.parametrize("frequency", ["1:3:1 Hz", ["1 Hz", "2 Hz", "3 Hz"], data_array([1, 2, 3], "Hz")])
def test_frequencies_of_a_response(frequency):
    found = pp.frequency_response(CASE.linearize("250 kt"), frequency)
    np.testing.assert_allclose(found.frequency, 2 * np.pi * np.array([1, 2, 3]))


def test_a_margin():
    point = CASE.flutter_point()
    assert point.margin("300 kt") == point.margin(300 * FOREIGN.knot) == point.margin(300 * KT)


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda: CASE.linearize(data_array([1], "deg")), "airspeed = deg: must be a speed"),
        (lambda: CASE.linearize(["fast"]), "airspeed = fast: must be a number and a unit"),
        (lambda: CASE.linearize([None, "x"]), "airspeed"),
        (lambda: CASE.vary({"rotor.precone": "2 kt"}), "rotor.precone = 2 kt: must be an angle"),
        (
            lambda: CASE.sweep("250 kt", {"rotor.precone": "3:1:1 deg"}),
            "rotor.precone = 3:1:1 deg: must rise",
        ),
        (lambda: CASE.sweep("250 kt", {"rotor.precon": [1]}), "did you mean rotor.precone?"),
        (lambda: CASE.stability_map({"rotor.precon": [1, 2], "airspeed": "1:2:1 kt"}), "rotor.precone?"),
        (lambda: pp.standard_air("10000 ft"), "altitude = 10000 ft: must be a number in SI units"),
        (
            lambda: pp.Operation(rotor_speed="458 rpm", density=1.2, speed_of_sound=340.0),
            "rotor_speed = 458 rpm: must be a number in SI units",
        ),
        (lambda: pp.DriveTrain(drive_inertia="2"), "drive_inertia = 2: must be a number in SI units"),
        (lambda: pp.Airfoil(lift_slope="5.7/rad"), "lift_slope = 5.7/rad: must be a number in SI units"),
    ],
)
def test_what_is_no_value_is_told(call, told):
    with pytest.raises(pp.InputError) as caught:
        call()
    assert told in str(caught.value)
    assert "\n" not in str(caught.value)
