"""The command envelope: the numbers of `Case.envelope`, in every form of output, within 80 columns."""

import csv
import json
import re

import numpy as np
import pytest
from click.testing import CliRunner

import proprotor as pp
from proprotor.commands.main import main
from proprotor.tables.envelope_table import SCOPE
from tests.csv_files import without_comments

KNOT = 1852 / 3600
DECK = """
base = "xv15-wing"

[case]
name = "wing"
title = "A wing"

[envelope]
dive_speed = "270 keas"
altitudes = { value = [0, 15000], unit = "ft" }
powers = { value = [0, 600], unit = "kW" }

[variants.heavy]
condition = "normal"
support.mass_per_length = "4 lb/in"

[variants.soft-controls]
rotor.control_stiffness = "5400 N*m/rad"
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("envelope")
    (path / "wing.toml").write_text(DECK)
    return path


@pytest.fixture(scope="module")
def found(folder):
    return pp.load_case(folder / "wing.toml").envelope()


def run(folder, *arguments):
    path = str(folder / "wing.toml")
    result = CliRunner().invoke(main, ["envelope", path, *map(str, arguments)], env={"COLUMNS": "80"})
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result


@pytest.fixture(scope="module")
def written(folder):
    """The whole output: what is printed, and the files."""
    return run(folder, "--csv", folder / "a.csv", "--plot", folder / "a.png")


def test_the_table_fits_into_80_columns_and_has_the_worst_altitude_of_each_condition(written, found):
    assert written.exit_code == 0
    lines = written.stdout.splitlines()
    assert max(map(len, lines)) <= 80
    rows = [line.split() for line in lines if re.match(r"(not )?met ", line)]
    assert len(rows) == found.sizes["condition"] * found.sizes["power"]
    margins = 100 * found.margin.min("altitude").values.ravel()
    shown = [
        float(re.search(r" ([+-]\d+\.\d) ", line)[1]) for line in lines if re.match(r"(not )?met ", line)
    ]
    np.testing.assert_allclose(shown, margins, atol=0.051)
    text = " ".join(written.stdout.split())
    assert SCOPE in text and "Worst case: " in text
    assert f"{found.verdict.size} places: " in text


def test_the_csv_has_every_place_in_units_that_people_read(written, folder, found):
    rows = list(csv.DictReader(without_comments(folder / "a.csv")))
    assert len(rows) == found.verdict.size
    for row, place in zip(rows, np.ndindex(found.verdict.shape), strict=True):
        here = found.isel(dict(zip(found.verdict.dims, place, strict=True)))
        assert row["condition"] == here.condition.item() and row["verdict"] == here.verdict.item()
        assert float(row["power (kW)"]) == pytest.approx(here.power.item() / 1e3)
        assert float(row["altitude (m)"]) == pytest.approx(here.altitude.item())
        assert float(row["onset (KTAS)"]) == pytest.approx(here.onset.item() / KNOT, rel=1e-12)
        assert float(row["onset (KEAS)"]) == pytest.approx(here.equivalent_onset.item() / KNOT, rel=1e-12)
        assert float(row["dive (KEAS)"]) == pytest.approx(270, rel=1e-12)
        needed = 270 if here.failure.item() else 1.15 * 270
        assert float(row["needed (KEAS)"]) == pytest.approx(needed, rel=1e-12)
        assert float(row["margin"]) == pytest.approx(float(row["onset (KEAS)"]) / needed - 1, rel=1e-9)
        assert float(row["damping per knot (KEAS)"]) == pytest.approx(
            here.damping_rate.item() * KNOT, rel=1e-12
        )
    assert (folder / "a.png").stat().st_size > 10_000


def test_json_has_all_of_it(folder, found):
    result = run(folder, "--json", "--only", "heavy")
    document = json.loads(result.stdout)
    assert len(document["places"]) == found.verdict.size // 2
    assert {place["condition"] for place in document["places"]} == {"as the deck", "heavy"}
    assert document["scope"] == SCOPE and document["case"] == "wing"
    assert document["worst case"].split(",")[0] in ("as the deck", "heavy")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--only", "heavi"), "variants = heavi: unknown variant 'heavi'; did you mean heavy?"),
        (("--scan", "300 keas"), "--scan = 300 keas: must be a range of airspeeds that rise"),
        (
            ("--set", "envelope.dive_speed=270 kt"),
            "envelope.dive_speed = 270 kt: must be an equivalent airspeed",
        ),
        (("--plot", "a.txt"), "--plot = a.txt: must end in .png"),
    ],
)
def test_a_mistake_is_one_message_before_anything_is_computed(folder, arguments, message):
    result = run(folder, *arguments)
    assert result.exit_code == 2 and result.stdout == ""
    assert message in result.stderr and len(result.stderr.splitlines()) == 1


def test_a_case_without_an_envelope_says_what_it_needs():
    result = CliRunner().invoke(main, ["envelope", "xv15"])
    assert result.exit_code == 2
    assert result.stderr.startswith("Error: envelope: is missing; a deck says in [envelope]")


def test_where_nothing_can_be_analysed_the_reasons_are_shown_and_the_exit_code_is_1(folder):
    result = run(folder, "--scan", "0:0.2:0.1keas", "--only", "heavy")
    assert result.exit_code == 1
    assert "not known" in result.stdout and "Traceback" not in result.stderr
