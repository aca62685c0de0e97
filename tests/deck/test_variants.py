"""Variants of a deck, [variants.NAME]: read, described, written again, with provenance and files of their own."""

import json

import jsonschema
import numpy as np
import pytest
from click.testing import CliRunner

import proprotor as pp
from proprotor.commands.main import main
from proprotor.deck.conditions import conditions_of
from proprotor.deck.file import read_tables
from proprotor.deck.schema import deck_schema
from proprotor.deck.template import deck_text

DECK = """
base = "xv15-wing"

[case]
name = "wing"
default_status = "measured"
default_source = "weighed"

[envelope]
dive_speed = "270 keas"
altitudes = { value = [0, 15000], unit = "ft" }

[variants.heavy]
condition = "normal"
support.mass_per_length = "4 lb/in"

[variants."mast spring lost"]
support.downstop = false
support.beam_damping_ratio = { value = "0.5 %", status = "assumed" }
"""


@pytest.fixture
def deck(tmp_path):
    path = tmp_path / "wing.toml"
    path.write_text(DECK)
    return path


def cases(deck):
    return {condition.name: condition.case for condition in conditions_of(pp.load_case(deck))}


def test_a_variant_differs_in_its_own_fields_alone(deck):
    found = cases(deck)
    assert list(found) == ["as the deck", "heavy", "mast spring lost", "heavy, mast spring lost"]
    own = found["as the deck"].given
    for name, paths in {
        "heavy": {"support.mass_per_length"},
        "mast spring lost": {"support.beam_damping_ratio"},
        "heavy, mast spring lost": {"support.mass_per_length", "support.beam_damping_ratio"},
    }.items():
        given = found[name].given
        assert {path for path in given if given[path].si != own[path].si} == paths
        assert found[name].deck.support.downstop == ("spring" not in name)
        assert found[name].title.endswith(name)


def test_numbers_of_variants_have_the_status_of_their_file(deck):
    found = cases(deck)
    heavy = found["heavy"].given["support.mass_per_length"]
    assert (heavy.status, heavy.source) == ("measured", "weighed")
    assert found["mast spring lost"].given["support.beam_damping_ratio"].status == "assumed"
    assert found["heavy"].given["support.chord_damping_ratio"].status == "recalled"  # of the base


def test_a_frequency_per_revolution_in_a_variant_is_that_of_its_file(tmp_path):
    text = '\n[variants.stiff]\nrotor.flap_frequency = "0.5/rev"\n'
    (tmp_path / "a.toml").write_text(DECK.partition("[variants.heavy]")[0] + text)
    stiff = cases(tmp_path / "a.toml")["stiff"]
    omega = pp.load_case("xv15-wing").operation.rotor_speed
    assert stiff.given["rotor.flap_frequency"].si == pytest.approx(0.5 * omega, rel=1e-12)
    assert "rotor.flap_stiffness" not in stiff.given  # which the frequency replaces


def test_files_of_a_variant_start_from_the_folder_of_its_deck(tmp_path, monkeypatch):
    wing = pp.load_case("xv15-wing").support
    (tmp_path / "inner").mkdir()
    names = np.array(wing.names)
    np.savez(
        tmp_path / "inner" / "wing.npz",
        mass=wing.mass, damping=wing.damping, stiffness=wing.stiffness, hub=wing.hub, dofs=names,
    )  # fmt: skip
    text = DECK.partition("[variants.heavy]")[0] + (
        '[variants.measured]\nsupport = { kind = "matrices", file = "wing.npz", includes_rotor = false, '
        'carries = "one rotor" }\n'
    )
    (tmp_path / "inner" / "a.toml").write_text(text)
    monkeypatch.chdir(tmp_path)
    found = cases("inner/a.toml")["measured"]
    np.testing.assert_allclose(found.support.mass, wing.mass)


def test_a_deck_that_is_written_again_keeps_its_variants(deck, tmp_path):
    text = deck_text(read_tables(deck), tmp_path / "again.toml", "wing")
    (tmp_path / "again.toml").write_text(text)
    again, first = pp.load_case(tmp_path / "again.toml"), pp.load_case(deck)
    assert again.deck.variants == first.deck.variants and again.deck.envelope == first.deck.envelope
    np.testing.assert_array_equal(
        [condition.case.support.mass for condition in conditions_of(again)],
        [condition.case.support.mass for condition in conditions_of(first)],
    )


def test_the_schema_takes_variants_and_refuses_others(deck):
    schema, tables = deck_schema(), read_tables(deck)
    plain = json.loads(json.dumps(tables))
    jsonschema.validate(plain | {"base": "xv15-wing"}, schema)
    plain["variants"]["heavy"]["condition"] = "sometimes"
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(plain | {"base": "xv15-wing"}, schema)


@pytest.mark.parametrize("field", ["envelope.dive_speed", "variants.NAME.condition", "variants.condition"])
def test_a_field_is_described(field):
    result = CliRunner().invoke(main, ["describe", field], env={"COLUMNS": "100"})
    assert result.exit_code == 0, result.stderr
    assert "V_D" in result.stdout if "dive" in field else "failure" in result.stdout


def test_numbers_of_the_envelope_are_no_inputs_of_a_design(deck):
    case = pp.load_case(deck)
    assert "envelope.dive_speed" in case.given
    assert not any(path.startswith("envelope") for path in pp.design_inputs(case))
    with pytest.raises(pp.InputError):
        case.vary({"envelope.dive_speed": 300.0})


def test_a_setting_of_a_variant_is_assumed_and_one_of_the_deck_holds_in_its_variants(deck):
    settings = {"variants.heavy.support.mass_per_length": "5 lb/in", "rotor.precone": "2 deg"}
    found = {one.name: one.case for one in conditions_of(pp.load_case(deck, settings))}
    heavy = found["heavy"].given
    assert heavy["support.mass_per_length"].status == "assumed"
    assert heavy["support.mass_per_length"].si == pytest.approx(5 * 0.45359237 / 0.0254)
    assert heavy["rotor.precone"].si == pytest.approx(np.deg2rad(2))
