"""A study as a table of its designs: read back by other readers, against single analyses and conversions by hand."""

import csv
import io
import json
import math

import jsonschema
import numpy as np
import pandas
import pytest

import proprotor as pp
from proprotor.files.json_text import json_text
from proprotor.tables.study_table import StudyTable

KNOT = 1852 / 3600
CASE = pp.load_case("xv15-uncoupled")
PRECONE, STIFFNESS = "rotor.precone", "rotor.control_stiffness"
SPEEDS = "160:400:40kt"
FOOT_POUND = 0.3048 * 0.45359237 * 9.80665  # N m


@pytest.fixture(scope="module")
def grid():
    """Four designs: two that flutter below 400 KTAS, two that do not; and two without a precone."""
    inputs = {
        PRECONE: [math.radians(2), math.radians(4), math.nan],
        STIFFNESS: ["8000 ft*lbf/rad", "16000 ft*lbf/rad"],
    }
    return pp.study(CASE, inputs, SPEEDS, ("flutter", "trim"), workers=1)


def rows_of(content: bytes):
    lines = [line for line in content.decode().splitlines(keepends=True) if not line.startswith("#")]
    return list(csv.DictReader(io.StringIO("".join(lines))))


def test_every_design_has_a_row_with_its_inputs_in_the_units_of_the_deck(grid):
    rows = rows_of(StudyTable(grid).csv())
    assert [int(row["design"]) for row in rows] == [*range(6)]
    assert [row[f"{PRECONE} (deg)"] for row in rows] == ["2.0", "2.0", "4.0", "4.0", "", ""]
    np.testing.assert_allclose(
        [float(row[f"{STIFFNESS} (ft*lbf/rad)"]) for row in rows], [8000, 16000] * 3, rtol=1e-11
    )


def test_flutter_speeds_are_those_of_the_designs_alone(grid):
    rows = rows_of(StudyTable(grid).csv())
    for row, precone in ((rows[2], 4.0), (rows[3], 4.0)):
        stiffness = float(row[f"{STIFFNESS} (ft*lbf/rad)"]) * FOOT_POUND
        design = CASE.vary({PRECONE: math.radians(precone), STIFFNESS: stiffness})
        alone = design.flutter_point(SPEEDS)
        assert row["result"] == alone.kind == "flutter" and row["flutter mode"] == alone.mode
        assert float(row["flutter speed (m/s)"]) == pytest.approx(alone.speed, rel=1e-6)
        assert float(row["flutter speed (KTAS)"]) == pytest.approx(alone.speed / KNOT, rel=1e-6)
        assert float(row["flutter frequency (Hz)"]) == pytest.approx(alone.frequency / math.tau, rel=1e-5)
        assert row["reason"] == row["warning"] == row["note"] == "" == row["flutter speed above (KTAS)"]


def test_a_stable_design_is_a_result_with_its_limit(grid):
    for row in rows_of(StudyTable(grid).csv())[:2]:
        assert row["result"] == "none up to 400.00 KTAS" and row["flutter speed (KTAS)"] == ""
        assert float(row["flutter speed above (KTAS)"]) == pytest.approx(400)
        assert row["note"] == "stable throughout" and row["reason"] == ""


def test_a_design_that_failed_has_its_reason(grid):
    for row in rows_of(StudyTable(grid).csv())[4:]:
        assert row["result"] == "failed" and "rotor.precone" in row["reason"] and "finite" in row["reason"]
        assert row["flutter speed (KTAS)"] == row["flutter speed above (KTAS)"] == ""


def test_doubts_of_points_stand_in_the_row(grid):
    rows = rows_of(StudyTable(grid).csv())
    doubtful = (grid.warning != "").any("airspeed").values.ravel()
    assert [bool(row["doubts"]) for row in rows] == doubtful.tolist()


def test_pandas_reads_the_same_table(grid, tmp_path):
    (tmp_path / "designs.csv").write_bytes(StudyTable(grid).csv())
    frame = pandas.read_csv(tmp_path / "designs.csv", comment="#")
    np.testing.assert_array_equal(frame["flutter speed (m/s)"], grid.flutter_speed.values.ravel())
    np.testing.assert_allclose(
        frame["flutter speed above (KTAS)"] * KNOT, grid.flutter_speed_above.values.ravel(), rtol=1e-15
    )


SCHEMA = {
    "type": "object",
    "required": ["title", "deck", "options", "study", "points", "failed", "designs"],
    "properties": {
        "options": {"type": "object"},
        "study": {"type": "object", "required": ["study", "inputs", "options"]},
        "points": {"type": "integer"},
        "designs": {
            "type": "array",
            "items": {
                "type": "object",
                "required": ["design", "result", "flutter speed (KTAS)", "reason", "warning", "doubts"],
                "properties": {
                    "design": {"type": "integer"},
                    "result": {"type": "string"},
                    "flutter speed (KTAS)": {"type": ["number", "null"]},
                    "flutter speed above (KTAS)": {"type": ["number", "null"]},
                    "reason": {"type": "string"},
                    "warning": {"type": "string"},
                    "doubts": {"type": "string"},
                },
            },
        },
    },
}


def test_json_has_the_same_rows_and_null_for_what_is_not_there(grid):
    document = json.loads(json_text(StudyTable(grid).document()), parse_constant=pytest.fail)
    jsonschema.validate(document, SCHEMA)
    assert document["designs"] == StudyTable(grid).records() and len(document["designs"]) == 6
    assert document["designs"][0]["flutter speed (KTAS)"] is None
    assert document["failed"] == 14 and document["points"] == 42
    assert "percentiles of the flutter speed" not in document  # of a grid


def test_percentiles_stand_in_the_document_of_a_sample_with_their_bounds():
    plan = pp.sampling.points({PRECONE: ["2 deg", "4 deg"], STIFFNESS: "8000 ft*lbf/rad"}, drawn=True)
    found = pp.study(CASE, plan, SPEEDS, "flutter", workers=1)
    percentiles = StudyTable(found).document()["percentiles of the flutter speed"]
    speed = float(found.flutter_speed[1])
    lower, upper = percentiles[0], percentiles[-1]
    assert lower == {"percentile": 1.0, "at least (m/s)": speed, "at most (m/s)": speed}
    assert upper["at least (m/s)"] == pytest.approx(400 * KNOT) and upper["at most (m/s)"] == math.inf


def test_without_flutter_speeds_a_row_tells_the_point_with_the_lowest_damping():
    found = pp.study(CASE, {PRECONE: ["1 deg", "2 deg"]}, "0:300:150kt", "least_stable", workers=1)
    for record, precone in zip(StudyTable(found).records(), (1.0, 2.0), strict=True):
        alone = CASE.vary({PRECONE: math.radians(precone)}).sweep("150:300:150kt")
        lowest = alone.damping_ratio.min("mode").values
        at = float(alone.airspeed[lowest.argmin()])
        assert record["lowest damping (% of critical)"] == pytest.approx(100 * lowest.min(), rel=1e-6)
        assert record["lowest damping at (KTAS)"] == pytest.approx(at / KNOT)
        assert record["reason"].startswith("1 of 3 airspeeds failed, at 0 KTAS: ")


def test_an_airspeed_of_each_design_is_an_input():
    plan = pp.sampling.points({"airspeed": ["200 kt", "250 kt"], PRECONE: "2 deg"})
    first, second = StudyTable(pp.study(CASE, plan, workers=1)).records()
    assert (first["airspeed (KTAS)"], second["airspeed (KTAS)"]) == (200.0, 250.0)
    trim = CASE.vary({PRECONE: math.radians(2)}).linearize("250 kt").trim
    assert second["collective (deg)"] == pytest.approx(math.degrees(float(trim.collective)), rel=1e-12)


def test_other_results_are_no_study():
    with pytest.raises(pp.InputError, match="must be a study"):
        StudyTable(CASE.sweep("200 kt"))
