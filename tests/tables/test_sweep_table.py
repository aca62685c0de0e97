"""Records, CSV and sentences of a sweep that is written down by hand."""

import csv
import json
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from proprotor.tables.sweep_table import SweepTable, heading

KNOT = 1852 / 3600
NAN = complex(np.nan, np.nan)


def swept(values, reasons):
    """A sweep of two modes at 50 and 100 kt; roots within 1e-6 of zero are neutral."""
    values = np.array(values)
    failed, modes = np.isnan(values), np.array(["beam", "lag"])[: values.shape[1]]
    with np.errstate(invalid="ignore"):
        ratio = -values.real / np.abs(values)
    dims = ("airspeed", "mode")
    return xr.Dataset(
        {
            "eigenvalue": (dims, values),
            "eigenvalue_error": (dims, np.full(values.shape, 1e-6)),
            "damping_ratio": (dims, ratio),
            "share": (dims, np.where(failed, np.nan, 0.75)),
            "branch": (dims, np.where(failed, "", modes).astype(object)),
            "warning": ("airspeed", ["", "the wake is thick"]),
            "reason": ("airspeed", reasons),
        },
        {"airspeed": np.array([50.0, 100.0]) * KNOT, "mode": modes},
    )


ROOTS = [[-3 + 4j, 1e-7 + 20j], [1 + 10j, NAN]]


def test_a_record_for_each_airspeed_and_mode():
    first, neutral, growing, missing = SweepTable(swept(ROOTS, ["", ""]), 40.0).records()
    assert json.loads(json.dumps(first)) == {
        "airspeed (KTAS)": 50,
        "airspeed (m/s)": pytest.approx(50 * 1852 / 3600),
        "mode": "beam",
        "share of its motion": 0.75,
        "branch": "beam",
        "frequency (per rev)": 0.1,
        "damping (% of critical)": pytest.approx(60),
        "Re s (rad/s)": -3,
        "Im s (rad/s)": 4,
        "warning": "",
        "failure": "",
    }
    assert neutral["damping (% of critical)"] == 0 and neutral["frequency (per rev)"] == 0.5
    assert growing["damping (% of critical)"] == pytest.approx(-100 / 101**0.5)
    assert growing["warning"] == "the wake is thick" and missing["mode"] == "lag"
    numbers = ("share of its motion", "branch", "frequency (per rev)", "damping (% of critical)")
    assert {missing[name] for name in (*numbers, "Re s (rad/s)", "Im s (rad/s)")} == {None}


def test_airspeeds_that_all_failed_have_one_record_each_without_a_mode():
    nothing = swept(np.empty((2, 0), dtype=complex), ["no trim", "no trim"])
    records = list(SweepTable(nothing, 40.0).records())
    assert [one["airspeed (KTAS)"] for one in records] == [50, 100]
    assert all(one["mode"] is None and one["Im s (rad/s)"] is None for one in records)
    assert all(one["failure"] == "no trim" for one in records)


def test_csv_has_a_row_for_each_record():
    table = SweepTable(swept(ROOTS, ["", ""]), 40.0)
    rows = list(csv.DictReader(table.csv().decode().splitlines()))
    assert [(row["airspeed (KTAS)"], row["mode"]) for row in rows] == [
        ("50.0", "beam"),
        ("50.0", "lag"),
        ("100.0", "beam"),
        ("100.0", "lag"),
    ]
    assert [row["Re s (rad/s)"] for row in rows] == ["-3.0", "1e-07", "1.0", ""]


def test_the_verdict_says_where_a_mode_is_unstable():
    """Re s of the beam goes from -3 to 1: it is zero at three quarters of the way, beside a doubtful airspeed."""
    verdict = SweepTable(swept(ROOTS, ["", ""]), 40.0).verdict()
    assert verdict == ["beam: unstable from about 87.5 KTAS? (interpolated)"]


def test_the_heading_of_a_table_is_title_and_rotor_speed():
    case = SimpleNamespace(title="", name="mine", operation=SimpleNamespace(rotor_speed=20 * np.pi))
    assert heading(case) == "mine, 600 rpm"


def test_the_names_of_an_aircrafts_modes_break_between_words():
    names = ["symmetric pylon yaw", "antisymmetric beam"]
    sweep = swept(ROOTS, ["", ""]).assign_coords(mode=names)
    lines = [line.plain for line in SweepTable(sweep, 40.0).lines(80, all_modes=True)]
    assert [line.split() for line in lines[:2]] == [["symmetric", "antisymmetric"], ["pylon", "yaw", "beam"]]
