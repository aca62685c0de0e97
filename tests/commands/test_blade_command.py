"""The command `proprotor blade`: its table, files and messages."""

import json
import tomllib

import numpy as np
import pytest
from click.testing import CliRunner

from proprotor.commands.main import main


@pytest.fixture
def table(tmp_path):
    """A blade that bends in short flexures near its root and hardly elsewhere."""
    r = np.array([0.2, 0.24, 0.26, 0.34, 0.36, 1.0, 2.85, 3.8])
    soft = (r > 0.25) & (r < 0.35)
    flat, edge = np.where(soft, 3e3, 2e7), np.where(soft, 1.2e4, 2e7)
    rows = [
        f"{a:.4f},12,{b},{c},2e5,{30 - 8 * a:.3f},0.35,0.09" for a, b, c in zip(r, flat, edge, strict=True)
    ]
    heads = "r [m],mass [kg/m],EI_flat [N*m**2],EI_edge [N*m**2],GJ [N*m**2],twist [deg],chord [m],pitch_inertia [kg*m]"
    path = tmp_path / "blade.csv"
    path.write_text("\n".join((heads, *rows)), encoding="utf-8")
    return path


def run(*words):
    return CliRunner().invoke(main, ["blade", *map(str, words)])


GIVEN = ("--at-rotor-speed", "458 rpm", "--collective", "10:50:20 deg", "--control-stiffness", "3e4 N*m/rad")


def test_the_answer_and_its_files(table, tmp_path):
    deck, picture, rows = (tmp_path / name for name in ("rotor.toml", "fan.png", "rows.csv"))
    found = run(table, *GIVEN, "--deck", deck, "--plot", picture, "--csv", rows)
    assert found.exit_code == 0, found.output
    assert "flap_hinge_offset" in found.output
    assert "The blade is held at its first station, 0.2 m" in found.output
    fields = tomllib.loads(deck.read_text(encoding="utf-8"))["rotor"]
    assert fields["radius"]["value"] == "3.8 m"
    assert all(one["status"] == "derived" and "blade.csv" in one["source"] for one in fields.values())
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert rows.read_text(encoding="utf-8").count("coning frequency") == 3


def test_json(table):
    found = json.loads(run(table, *GIVEN, "--json").output)
    assert found["good"] is True
    assert found["rotor (SI)"]["flap_hinge_offset"] == pytest.approx(0.3, abs=0.02)
    assert max(found["differences"].values()) < 0.05


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--at-rotor-speed", "0 rpm"), "--at-rotor-speed = 0 rpm: must be above zero"),
        (("--at-rotor-speed", "458 kg"), "--at-rotor-speed = 458 kg: "),
        (("--collective", "20 deg"), "--collective = 20 deg: must have at least 3 values"),
        (("--control-stiffness", "3e4"), "--control-stiffness = 3e4: "),
        (("--pitch-bearing", "3.5 m"), "pitch_bearing = 3.5: must lie inboard of 0.75 R"),
        (("--deck", "nowhere/rotor.toml"), "nowhere"),
    ],
)
def test_a_slip_is_one_line(table, words, message):
    found = run(table, *GIVEN, *words)
    assert found.exit_code != 0
    assert message in found.output
    assert "Traceback" not in found.output
