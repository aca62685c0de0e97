"""Control loops in decks: what a deck has is what Python has, and what cannot be is one message."""

import json

import jsonschema
import numpy as np
import pytest
from click.testing import CliRunner

import proprotor as pp
from proprotor.commands.main import main
from proprotor.deck.file import read_tables
from proprotor.deck.schema import deck_schema
from proprotor.explore.altered_deck import altered_deck
from proprotor.stability.modes import eigenvalues

HEAD = 'base = "xv15-uncoupled"\n[case]\nname = "closed"\n'
LOOP = """[[control.loops]]
name = "damper"
sensors = ["x acceleration", "beam"]
weights = { value = [1.0, -2.0] }
inputs = ["cyclic_1c"]
numerator = { value = [1, 0] }
denominator = { value = [1, 5, 10] }
gain = { value = 0.01, status = "derived", source = "a search" }
scheduled_at = { value = [200, 300], unit = "kt" }
scheduled_gains = { value = [1.0, 0.5] }
actuator_bandwidth = "20 Hz"
actuator_damping = 0.7
delay = "10 ms"
delay_order = 2
"""
SPACE = """[[control.loops]]
name = "both"
sensors = ["x rate", "gimbal_1c"]
inputs = ["collective", "cyclic_1s"]
state_space = { A = [[-3.0]], B = [[1.0, 0.5]], C = [[0.01], [0.02]], D = [[0.0, 0.001], [0.002, 0.0]] }
actuator_bandwidth = "1.5/rev"
"""
KNOT = 1852 / 3600
GIVEN = pp.ControlLoop(
    name="damper",
    sensors=("x acceleration", "beam"),
    weights=(1.0, -2.0),
    inputs="cyclic_1c",
    law=([1.0, 0.0], [1.0, 5.0, 10.0]),
    gain=0.01,
    scheduled_at=[200 * KNOT, 300 * KNOT],
    scheduled_gains=[1.0, 0.5],
    actuator_bandwidth=40 * np.pi,
    actuator_damping=0.7,
    delay=0.01,
    delay_order=2,
)


@pytest.fixture
def deck(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "closed.toml").write_text(HEAD + LOOP + SPACE, encoding="utf-8")
    return "closed.toml"


def test_a_deck_and_python_make_the_same_model(tmp_path):
    (tmp_path / "one.toml").write_text(HEAD + LOOP, encoding="utf-8")
    one = pp.load_case(tmp_path / "one.toml").linearize([90.0, 140.0])
    other = pp.load_case("xv15-uncoupled").with_control(GIVEN).linearize([90.0, 140.0])
    assert one.dofs == other.dofs
    for name in "MCKB":
        np.testing.assert_allclose(getattr(one, name), getattr(other, name), rtol=1e-12, atol=1e-12)


def test_numbers_of_loops_are_inputs_with_status_and_source(deck):
    case = pp.load_case(deck)
    number = pp.design_inputs(case)["control.loops[damper].gain"]
    assert (number.si, number.status, number.source) == (0.01, "derived", "a search")
    per_revolution = pp.design_inputs(case)["control.loops[both].actuator_bandwidth"]
    assert (
        per_revolution.si == pytest.approx(1.5 * case.operation.rotor_speed)
        and per_revolution.unit == "rad/s"
    )
    faster = pp.load_case(deck, {"operation.rotor_speed": "500 rpm"})  # a frequency keeps its hertz
    assert faster.loops[1].actuator_bandwidth == pytest.approx(per_revolution.si)
    set_one = pp.load_case(deck, {"control.loops[damper].gain": "0.02"})
    varied = case.vary({"control.loops[damper].gain": 0.02})
    np.testing.assert_allclose(
        eigenvalues(set_one.linearize(140.0)), eigenvalues(varied.linearize(140.0)), rtol=1e-9
    )
    assert case.with_control().linearize(140.0).dofs == pp.load_case("xv15-uncoupled").linearize(140.0).dofs


def test_templates_schema_and_saved_decks_keep_the_loops(deck, tmp_path):
    tables = json.loads(json.dumps(read_tables(deck)))
    jsonschema.validate(tables, deck_schema())
    done = CliRunner().invoke(main, ["new", "copy.toml", "--from", deck])
    assert done.exit_code == 0, done.output
    case = pp.load_case(deck)
    own = eigenvalues(case.linearize(140.0))
    np.testing.assert_allclose(eigenvalues(pp.load_case("copy.toml").linearize(140.0)), own, rtol=1e-12)
    text = altered_deck(deck, case, {"control.loops[damper].gain": 0.03})
    (tmp_path / "moved.toml").write_text(text, encoding="utf-8")
    moved = pp.load_case("moved.toml")
    assert [loop.gain for loop in moved.loops] == [pytest.approx(0.03), 1.0]
    changed = eigenvalues(case.vary({"control.loops[damper].gain": 0.03}).linearize(140.0))
    np.testing.assert_allclose(eigenvalues(moved.linearize(140.0)), changed, rtol=1e-9)


def test_a_study_of_a_deck_with_loops_is_repeated_and_one_with_loops_of_python_is_given_again(deck, tmp_path):
    plan, speeds = {"control.loops[damper].gain": [0.0, 0.01]}, "300:340:40kt"
    found = pp.study(pp.load_case(deck), plan, speeds, ("least_stable",), workers=1)
    pp.save_study(found, tmp_path / "study.toml")
    assert pp.study(str(tmp_path / "study.toml"), workers=1).equals(found)
    case = pp.load_case("xv15-uncoupled").with_control(GIVEN)
    in_python = pp.study(case, plan, speeds, ("least_stable",), workers=1)
    pp.save_study(in_python, tmp_path / "other.toml")
    with pytest.raises(pp.InputError, match=r"^case: must be given again"):
        pp.study(str(tmp_path / "other.toml"), workers=1)
    assert pp.study(case, in_python, workers=1).equals(in_python)


def test_the_command_prints_margins_and_what_they_are_of(deck):
    words = ["margins", deck, "--speed", "200:300:100kt"]
    done = CliRunner().invoke(main, [*words, "--json"])
    assert done.exit_code == 0, done.output
    document = json.loads(done.stdout)
    assert document["control"].startswith("damper: x acceleration, beam to cyclic_1c; both: ")
    assert [record["loop"] for record in document["margins"]] == [
        "damper",
        "both collective",
        "both cyclic_1s",
    ] * 2
    found = pp.load_case(deck).margins("200:300:100kt")
    first = document["margins"][0]
    assert first["disk margin"] == pytest.approx(float(found.disk_margin[0, 0]))
    assert document["needed"] == {"gain margin (dB)": 6.0, "phase margin (deg)": 45.0}
    table = CliRunner().invoke(main, words)
    assert "Control loops closed: damper" in table.stdout and "damper: keeps 6 dB and 45 deg" in table.stdout
    nothing = CliRunner().invoke(main, ["margins", "xv15-uncoupled", "--speed", "200 kt"])
    assert nothing.exit_code == 2 and "has no control loop" in nothing.stderr


ONE = '[[control.loops]]\nname = "a"\nsensors = ["x"]\ninputs = ["collective"]\n'
MALFORMED = {
    "no loop": ("[control]\nloops = []\n", "control.loops = []: must not be empty"),
    "no list": ("[control]\nloops = 3\n", "control.loops = 3: must be a list"),
    "twice": (ONE + ONE, "control.loops[a].name = a: must not be the name of two loops"),
    "unknown field": (ONE + 'actuator = "20 Hz"\n', "unknown field 'actuator'"),
    "improper": (
        ONE + "numerator = { value = [1, 0, 0] }\ndenominator = { value = [1, 2] }\n",
        "control.loops[a].numerator = 3 values: must not have a higher degree than the denominator",
    ),
    "half a law": (ONE + "numerator = 2\n", "control.loops[a].denominator: is missing"),
    "two laws": (
        ONE + "numerator = 2\nstate_space = {}\n",
        "control.loops[a].numerator: must not be given with",
    ),
    "no matrix": (
        ONE + "state_space = { A = [[1]], B = [[1]] }\n",
        "control.loops[a].state_space.C: is missing",
    ),
    "ragged": (
        ONE + "state_space = { A = [[1, 2], [1]], B = [[1]], C = [[1]], D = [[0]] }\n",
        "control.loops[a].A = [[1, 2], [1]]: must be a matrix of real numbers",
    ),
    "unit": (ONE + 'delay = "10 m"\n', 'control.loops[a].delay = 10 m: must be a time, such as "0.5 s"'),
    "order": (
        ONE + 'delay = "10 ms"\ndelay_order = 12\n',
        "control.loops[a].delay_order = 12: must be a whole number",
    ),
    "sensor": (ONE.replace('"x"', '"strain"'), "control.loops[a].sensors = strain: unknown motion; known"),
    "input": (
        ONE.replace("collective", "elevator"),
        "control.loops[a].inputs = elevator: unknown input; known",
    ),
}


@pytest.mark.parametrize("kind", MALFORMED)
def test_a_loop_that_cannot_be_is_one_message_of_the_command(kind, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text, told = MALFORMED[kind]
    (tmp_path / "bad.toml").write_text(HEAD + text, encoding="utf-8")
    done = CliRunner().invoke(main, ["sweep", "bad.toml", "--speed", "200:300:100kt", "--csv", "a.csv"])
    assert done.exit_code == 2 and told in done.stderr, done.output
    assert len(done.stderr.strip().splitlines()) == 1 and not (tmp_path / "a.csv").exists()
