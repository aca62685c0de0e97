"""Fields of a deck set from outside, described, templated and as a JSON schema: all from one definition."""

import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from click.testing import CliRunner, Result

import proprotor as pp
from proprotor.case import load_case
from proprotor.commands.main import main
from proprotor.datum import Datum
from proprotor.deck import build
from proprotor.deck.describe import deck_fields, find_fields
from proprotor.deck.fields_page import markdown
from proprotor.deck.file import list_cases, read_tables
from proprotor.deck.numbers import numbers_of
from proprotor.deck.schema import deck_schema
from proprotor.deck.settings import with_settings
from proprotor.deck.template import case_name, deck_text, example
from proprotor.deck.validation import validate
from proprotor.errors import InputError

DECKS = Path(sys.modules["proprotor"].__file__).parent / "deck" / "decks"
DOCS = Path(__file__).parents[2] / "docs"
DEG, SLUG_FT2 = np.pi / 180, 14.593902937206365 * 0.3048**2


def run(*arguments: str | Path) -> Result:
    result = CliRunner().invoke(main, [str(a) for a in arguments], env={"COLUMNS": "200"})
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result


def numbers(case):
    return {path: number.si for path, number in case.sources.items()}


# --set ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("path", "text", "expected"),
    [
        ("rotor.precone", "1.5 deg", 1.5 * DEG),
        ("rotor.precone", '"1.5 deg"', 1.5 * DEG),
        ("rotor.n_blades", "4", 4),
        ("rotor.pitch_gimbal_coupling", "-0.3", -0.3),
        ("rotor.pitch_inertia", "0.4 slug*ft**2", 0.4 * SLUG_FT2),
        ("rotor.airfoil.drag", "1 %", 0.01),
        ("operation.rotor_speed", "30 rad/s", 30),
        ("support.modes[beam].frequency", "3 Hz", 6 * np.pi),
        ("support.modes[0].damping_ratio", "3 %", 0.03),
        ("support.modes[torsion].x", "2 m/rad", 2),
    ],
)
def test_a_number_is_set_and_nothing_else(path, text, expected):
    case, deck = load_case("xv15-uncoupled", {path: text}), load_case("xv15-uncoupled")
    named = path.replace("[0]", "[beam]")
    assert case.sources[named].si == pytest.approx(expected, rel=1e-12)
    assert case.sources[named].status == "assumed"
    changed = {p for p, si in numbers(case).items() if si != numbers(deck)[p]}
    assert changed == {named}


def test_what_is_no_number_is_set():
    no_warnings = {"case.warnings": "[]", "rotor.gimbal_stiffness": "0 N*m/rad"}  # a hub spring is told of
    case = load_case("xv15-uncoupled", {"rotor.propeller_moment": "false", "case.title": "3", **no_warnings})
    assert (case.rotor.propeller_moment, case.title, case.warnings) == (False, "3", ())
    case = load_case("xv15-uncoupled", {"operation.trim": '{ collective = "40 deg" }'})
    assert case.operation.trim == {"collective": pytest.approx(40 * DEG)}
    again = load_case("xv15-uncoupled", {"operation.trim.power_coefficient": "0.01"})
    assert again.operation.trim == {"power_coefficient": 0.01}
    twist = '{ r_over_R = [0, 1], value = [20, 0], unit = "deg" }'
    r, angle = load_case("xv15-uncoupled", {"rotor.twist": twist}).rotor.twist
    np.testing.assert_allclose(r, [0, 3.81])
    np.testing.assert_allclose(angle, [20 * DEG, 0])


def test_an_alternative_gives_way():
    case = load_case("xv15-uncoupled", {"rotor.lock_number": "3.6", "rotor.flap_stiffness": "1e5 N*m/rad"})
    assert case.sources["rotor.chord"].status == "derived"
    assert "rotor.flap_frequency" not in case.sources
    assert case.rotor.flap_stiffness == 1e5


def test_a_trim_target_gives_way_to_another(tmp_path):
    (tmp_path / "a.toml").write_text(
        'base = "xv15-uncoupled"\n[case]\nname = "a"\n[operation]\ntrim = { collective = "40 deg" }\n'
    )
    text = 'base = "a.toml"\n[case]\nname = "b"\n[operation.trim]\nthrust_coefficient = 0.004\n'
    (tmp_path / "b.toml").write_text(text)
    assert load_case(tmp_path / "b.toml").operation.trim == {"thrust_coefficient": 0.004}
    again = load_case(tmp_path / "b.toml", {"operation.trim": "windmill"})
    assert again.operation.trim == "windmill"


def test_another_kind_of_support_is_set():
    assert load_case("xv15-uncoupled", {"support.kind": "rigid"}).support.names == ()
    pivot = {
        "kind": "pivot",
        "includes_rotor": "true",
        "distance": "4 ft",
        "pitch_inertia": "3000 kg*m**2",
        "yaw_inertia": "3000 kg*m**2",
        "pitch_stiffness": "1e6 N*m/rad",
        "yaw_stiffness": "2e6 N*m/rad",
    }
    case = load_case("xv15-uncoupled", {f"support.{name}": value for name, value in pivot.items()})
    np.testing.assert_allclose(np.diag(case.support.stiffness), [1e6, 2e6])


def test_the_title_tells_what_was_set_and_tables_stay_as_they_are():
    tables = read_tables("xv15-uncoupled")
    before = json.dumps(tables)
    changed = with_settings(tables, {"rotor.precone": "1.5 deg", "support.modes[beam].x": "0.9"})
    assert json.dumps(tables) == before
    assert changed["case"]["title"].endswith("(rotor.precone = 1.5 deg, support.modes[beam].x = 0.9)")
    many = {
        f"support.modes[{m}].{f}": "1 %" for m in ("beam", "chord", "torsion") for f in ("damping_ratio",)
    }
    assert with_settings(tables, many)["case"]["title"].count("1 %") == 3
    assert with_settings(tables, {"rotor.precone": " " * 400 + "1 deg"})["case"]["title"].endswith("1 deg)")


REFUSED = [
    (("rotor.precon=1 deg",), "rotor.precon = 1 deg: unknown field 'precon'; did you mean precone?"),
    (("precone=1 deg",), "precone = 1 deg: unknown field 'precone'; did you mean rotor.precone?"),
    (("rotors.precone=1 deg",), "rotors.precone = 1 deg: unknown field 'rotors'; did you mean rotor?"),
    (("rotor.precone=1 kg",), 'rotor.precone = 1 kg: must be an angle, such as "2.5 deg"'),
    (("rotor.precone=1",), "rotor.precone = 1: needs a unit"),
    (("rotor.precone=1 degg",), "rotor.precone = 1 degg: has an unknown unit 'degg'; did you mean deg?"),
    (("rotor.precone=",), "--set = rotor.precone=: must be a field and its value"),
    (("rotor.precone",), "--set = rotor.precone: must be a field and its value"),
    (("rotor.precone=1 deg", "rotor.precone=2 deg"), "--set = rotor.precone=2 deg: must not set a field twice"),
    (("rotor.n_blades=3.5",), "rotor.n_blades = 3.5: must be a whole number, at least 3"),
    (("rotor.n_blades=2",), "rotor.n_blades = 2: must be a whole number, at least 3"),
    (("rotor.radius=-1 ft",), "rotor.radius = -1 ft: must be positive"),
    (("rotor.airfoil=3",), "rotor.airfoil = 3: must be a table"),
    (("rotor.airfoil=3", "rotor.airfoil.drag=0"), "rotor.airfoil.drag: must not be set together with airfoil"),
    (("rotor.propeller_moment=yes",), "rotor.propeller_moment = yes: must be true or false"),
    (("operation.trim=glide",), 'operation.trim = glide: must be "windmill" or { collective = "30 deg" }'),
    (("operation.trim.thrust=0.01",), "operation.trim.thrust = 0.01: unknown trim 'thrust'"),
    (("support.kind=pivots",), "support.kind = pivots: must be 'normal-modes', 'beam-wing'"),
    (("support.kind=pivot",), "support.includes_rotor: is missing"),
    (("support.modes[bean].frequency=3 Hz",), "support.modes[bean]: unknown name 'bean'; did you mean beam?"),
    (("support.modes[7].frequency=3 Hz",), "support.modes[7]: unknown name '7'"),
    (("support.modes[beam].frequenzy=3 Hz",), "support.modes[beam].frequenzy = 3 Hz: unknown field"),
    (("rotor[0].precone=3 deg",), "rotor[0]: is no entry of a list of this deck"),
    (("support.modes[beam=3",), "support.modes[beam = 3: must be a field of a deck, such as rotor.precone"),
    (("rotor..precone=1 deg",), "rotor..precone = 1 deg: must be a field of a deck"),
    (("case.name=a/b",), "case.name = a/b: must be letters, digits"),
    (("base=xv15-wing",), "base = xv15-wing: unknown field 'base'"),
    (("rotor.lock_number=3", "rotor.chord=1 ft"), "rotor.lock_number: must not be given twice over"),
    (("rotor.radius=" + "[" * 5000,), "rotor.radius = [[["),
    (("rotor.radius=1 ft\nblade = 3",), "rotor.radius = 1 ft blade = 3: must be printable text"),
]  # fmt: skip


@pytest.mark.parametrize(("settings", "told"), REFUSED, ids=[told[:40] for _, told in REFUSED])
def test_a_setting_that_cannot_be_used_is_told_in_one_message(settings, told):
    result = run("cases", "xv15-uncoupled", *(f"--set={text}" for text in settings))
    assert result.exit_code == 2
    assert result.stdout == ""
    first, *others = result.stderr.strip().removeprefix("Error: ").splitlines()
    assert first.startswith(told), first
    assert all(": " in line for line in others)


def test_every_command_that_takes_a_case_takes_settings():
    for name, command in main.commands.items():
        arguments = {p.name for p in command.params}
        if "case" in arguments or name == "cases":
            assert "settings" in arguments, name
        assert "as_json" in arguments, name


# describe -----------------------------------------------------------------------------------------------------------


def test_every_field_says_what_it_means_and_takes():
    fields = deck_fields()
    assert len({(f.path, f.kind) for f in fields}) == len(fields)
    for field in fields:
        assert field.meaning.endswith("."), field
        assert len(field.takes) > 3, field
        assert field.meaning[0].isupper() or field.meaning[0] in '"γΩ', field


@pytest.mark.parametrize("name", list_cases())
def test_every_number_of_a_bundled_deck_is_a_field_that_is_described(name):
    known = {(f.path, f.kind) for f in deck_fields()}
    case = load_case(name)
    kind = read_tables(name)["support"]["kind"]
    for path in case.given:
        plain = re.sub(r"\[.*?\]", "[NAME]", path)
        assert (plain, kind if path.startswith("support") else "") in known, path


def test_descriptions_have_what_the_reader_enforces():
    (precone,) = find_fields("rotor.precone")
    assert (precone.unit, precone.range, precone.required, precone.default) == ("rad", "", True, "")
    (damping,) = find_fields("rotor.flap_damping")
    assert (damping.range, damping.required, damping.default) == ("0 or more", False, "0 N*m*s/rad")
    (lock,) = find_fields("lock_number")
    assert lock.instead_of == ("chord",) and lock.required
    (drag,) = find_fields("rotor.airfoil.drag")
    assert (
        drag.instead_of == ("table", "table_name", "table_reynolds")
        and not drag.required
        and drag.default == "0"
    )
    (blades,) = find_fields("rotor.n_blades")
    assert blades.range == "3 or more"
    assert {f.kind for f in find_fields("support.kind")} == {
        "normal-modes", "beam-wing", "aircraft", "matrices", "nastran", "universal", "pivot", "rigid"}  # fmt: skip
    assert {f.path for f in find_fields("pivot")} >= {"support.distance", "support.pitch_damping"}


def test_defaults_are_those_of_the_objects():
    """Leaving a field out and writing its default make the same rotor."""
    for field in deck_fields():
        if field.path.startswith("rotor.") and field.default and field.unit:
            case = load_case("xv15-mass-distribution", {field.path: field.default})
            tables = read_tables("xv15-mass-distribution")
            section = tables["rotor"]
            for part in field.path.split(".")[1:-1]:
                section = section[part]
            section.pop(field.path.rpartition(".")[2], None)
            without = build.assemble(deck := validate(tables), numbers_of(deck), kind=pp.Case)
            name = field.path.removeprefix("rotor.").removeprefix("airfoil.")
            source = "airfoil" if "airfoil" in field.path else None
            given, left_out = (getattr(c.rotor, source) if source else c.rotor for c in (case, without))
            assert getattr(given, name) == getattr(left_out, name), field.path


def test_the_page_of_fields_is_up_to_date():
    page = (DOCS / "decks.md").read_text(encoding="utf-8")
    assert page == markdown(), "run: proprotor describe --markdown > docs/decks.md"
    for field in deck_fields():
        assert f"| `{field.path.rpartition('.')[2]}` | {field.meaning}" in page


def test_describe_tells_what_the_inputs_of_a_deck_amount_to(tmp_path):
    output = run("describe", "xv15-uncoupled").stdout
    assert re.search(r"Lock number +3\.83 ", output) and re.search(r"gimbal frequency +1\.0176 +/rev", output)
    assert re.search(r"^beam ", output, re.MULTILINE) and "K_Pζ" in output and "?" not in output
    slip = tmp_path / "slip.toml"
    slip.write_text('base = "xv15-uncoupled"\n[case]\nname = "slip"\n[rotor]\nchord = "14 ft"\n')
    output = " ".join(run("describe", str(slip)).stdout.split())
    assert "? mean chord 1.12 R is above 0.4 R: blades have 0.05 to 0.25 of the radius" in output
    found = json.loads(run("describe", "xv15-uncoupled", "--json").stdout)
    assert {"Lock number", "solidity"} < {one["name"] for one in found["amounts"]}
    assert len(found["blade at trim"]) == 5 and len(found["support modes"]) == 3


def test_describe_tells_a_field_a_section_and_all():
    output = run("describe", "rotor.precone").stdout
    assert "Cone built into the hub" in output and "rad" in output
    assert "support.span" in run("describe", "beam-wing").stdout
    for field, line in (
        ("rotor.flap_damping", "default 0 N*m*s/rad"),
        ("rotor.n_blades", "range 3 or more"),
        ("rotor.blade_mass", "instead of mass_distribution"),
        ("support.span", 'of [support] of kind "beam-wing"'),
    ):
        assert line in re.sub(r" +", " ", run("describe", field).stdout), field
    everything = run("describe").stdout
    assert all(f.path in everything for f in deck_fields())
    records = json.loads(run("describe", "operation", "--json").stdout)
    assert {r["path"] for r in records} >= {"operation.density", "operation.trim"}
    for near, meant in (
        ("rotor.precon", "rotor.precone"),
        ("precon", "rotor.precone"),
        ("beem-wing", "beam-wing"),
        ("xv51", "xv15"),
    ):
        result = run("describe", near)
        assert result.exit_code == 2 and f"did you mean {meant}?" in result.stderr


# JSON schema --------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def schema():
    found = json.loads(run("describe", "--schema").stdout)
    assert found == json.loads(json.dumps(deck_schema()))
    jsonschema.Draft7Validator.check_schema(found)
    return jsonschema.Draft7Validator(found)


@pytest.mark.parametrize("name", list_cases())
def test_bundled_decks_obey_the_schema(schema, name):
    tables = tomllib.loads((DECKS / f"{name}.toml").read_text(encoding="utf-8"))
    assert [e.message for e in schema.iter_errors(tables)] == []


@pytest.mark.parametrize(
    ("section", "name", "value"),
    [
        ("rotor", "precon", "1 deg"),
        ("rotor", "precone", 2.5),  # needs a unit
        ("rotor", "precone", {"value": "1 deg", "statu": "assumed"}),
        ("rotor", "precone", {"value": "1 deg", "status": "guessed"}),
        ("rotor", "precone", None),
        ("rotor", "n_blades", 2),
        ("rotor", "n_blades", 3.5),
        ("rotor", "flap_outboard_fraction", 1.5),
        ("rotor", "airfoil", {"drag": -1}),
        ("operation", "trim", "glide"),
        ("operation", "trim", {"thrust": 1}),
        ("support", "kind", "pivots"),
        ("support", "kind", None),
        ("case", "title", ""),
    ],
)
def test_the_schema_refuses_what_the_reader_refuses(schema, section, name, value):
    tables = read_tables("xv15-uncoupled")
    if value is None:
        del tables[section][name]
    else:
        tables[section][name] = value
    assert list(schema.iter_errors(tables))
    with pytest.raises(InputError):
        validate(tables)


def test_a_deck_with_a_base_may_leave_out_everything(schema):
    variant = {"base": "xv15-uncoupled", "case": {"name": "b"}, "rotor": {"precone": "1 deg"}}
    assert not list(schema.iter_errors(variant))
    del variant["base"]
    assert list(schema.iter_errors(variant))


# Templates ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", list_cases())
@pytest.mark.parametrize("variant", [False, True])
def test_a_template_is_the_case_it_was_made_from(tmp_path, name, variant):
    file = tmp_path / "my deck.toml"
    file.write_text(deck_text(read_tables(name), file, name, variant), encoding="utf-8")
    made, origin = load_case(file), load_case(name)
    assert made.name == "my deck"
    assert made.sources == origin.sources
    assert (made.title, made.description, made.warnings) == (
        origin.title,
        origin.description,
        origin.warnings,
    )
    assert made.operation == origin.operation


def test_files_of_a_template_start_from_its_folder(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    table = '[rotor.airfoil]\ntable = { value = "x.c81", status = "assumed", source = "made up" }\n'
    (tmp_path / "a" / "one.toml").write_text(f'base = "xv15-uncoupled"\n[case]\nname = "one"\n{table}')
    tables = read_tables(tmp_path / "a" / "one.toml")
    file = tmp_path / "b" / "two.toml"
    file.write_text(deck_text(tables, file))
    read = validate(read_tables(file)).rotor.airfoil.table
    assert read is not None and Path(read.si).resolve() == tmp_path / "a" / "x.c81"


@pytest.mark.parametrize("name", ["xv15-uncoupled", "xv15-wing", "xv15-aircraft"])
def test_every_field_that_is_left_out_has_an_example_that_can_be_read(tmp_path, name):
    tables, count = read_tables(name), 0
    kind = tables["support"]["kind"]
    angles = {"value": [0, 20, 40], "unit": "deg"}
    needed = {"at_rotor_speed": "458 rpm", "at": angles, "flap": 1.9, "lag": 1.3}
    tables["rotor"]["frequencies"] = needed
    altitudes = {"value": [0, 10], "unit": "km"}
    tables["envelope"] = {"dive_speed": "250 keas", "altitudes": altitudes}
    tables["variants"] = {"NAME": {"rotor": {"precone": "2 deg"}}}
    of_aircraft, of_wings = ("left.", "variants.NAME.left"), "variants.NAME.support"
    for field in deck_fields():
        if field.kind in ("", kind) and "[NAME]" not in field.path and "wing_aerodynamics" not in field.path:
            text = example(field)
            value = tomllib.loads(f"v = {text}")["v"]
            if field.form in ("", "list") and not field.default:
                continue  # text of one's own
            if field.path in (
                "operation.temperature_offset",
                "rotor.hub_mass",
                "rotor.mass_offset",
                "rotor.airfoil.table_reynolds",
                "rotor.airfoil.blend",
            ):
                continue  # goes with an altitude, with mass distributions, with a table, with region_ends
            if field.path.startswith(of_aircraft) and kind != "aircraft":
                continue
            if field.path == of_wings and kind == "normal-modes":
                continue  # which has no downstop
            if (
                field.path in ("operation.density", "operation.speed_of_sound")
                and "altitude" in tables["operation"]
            ):
                continue
            deck = validate(with_settings(tables, {field.path: text}))
            assert deck and value is not None
            count += 1
    assert count > 40


def test_new_writes_a_deck_that_runs_and_keeps_what_is_there(tmp_path):
    file = tmp_path / "my.toml"
    result = run("new", file)
    assert result.exit_code == 0 and "proprotor sweep" in result.stdout
    assert run("sweep", file, "--speed", "200 kt").exit_code == 0
    text = file.read_text(encoding="utf-8")
    assert text.count("\n# ") > 60
    file.write_text(text + "# mine\n", encoding="utf-8")
    refused = run("new", file)
    assert refused.exit_code == 2 and "--force" in refused.stderr
    assert file.read_text(encoding="utf-8").endswith("# mine\n")
    assert run("new", file, "--force").exit_code == 0
    assert file.read_text(encoding="utf-8") == text
    variant = tmp_path / "other" / "variant.toml"
    variant.parent.mkdir()
    assert json.loads(run("new", variant, "--from", file, "--variant", "--json").stdout)["variant"] is True
    assert 'base = "../my.toml"' in variant.read_text(encoding="utf-8")
    assert load_case(variant).sources == load_case(file).sources


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("deck.txt",), "must end in .toml"),
        (("my.toml", "--from", "xv16"), "did you mean xv15?"),
        (("missing/my.toml",), "cannot be written"),
    ],
)
def test_a_template_that_cannot_be_written(tmp_path, arguments, told, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run("new", *arguments)
    assert result.exit_code in (1, 2) and told in result.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("file", "name"),
    [("my.toml", "my"), ("/a/ä b.toml", "b"), ("...toml", "case"), ("x" * 99 + ".toml", "x" * 60)],
)
def test_a_case_is_named_after_its_file(file, name):
    assert case_name(file) == name


def test_text_of_any_kind_comes_back(tmp_path):
    tables = read_tables("xv15-uncoupled")
    tables["case"]["description"] = 'quotes " and \\ and \n lines, tab\t, é, 雪, \x7f'
    file = tmp_path / "t.toml"
    file.write_text(deck_text(tables, file), encoding="utf-8")
    assert read_tables(file)["case"] == tables["case"] | {"name": "t"}


# Start and completion -------------------------------------------------------------------------------------------------


def test_help_of_every_command_starts_without_the_slow_imports():
    slow = ("pint", "pydantic", "xarray", "matplotlib", "rich")
    code = f"""
import sys
from proprotor.commands.main import main
for name in main.commands:
    main([name, "--help"], standalone_mode=False)
print([name for name in {slow} if name in sys.modules])
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (
            ["sweep", "xv15-"],
            {
                "xv15-aircraft",
                "xv15-aircraft-off",
                "xv15-wing",
                "xv15-mass-distribution",
                "xv15-uncoupled",
                "xv15-bell-frequencies",
                "xv15-sections",
            },
        ),
        (["sweep", "xv15-uncoupled", "--set", "rotor.prec"], {"rotor.precone="}),
        (["describe", "rotor.airfoil.z"], {"rotor.airfoil.zero_lift_angle"}),
        (["fl"], {"flutter"}),
    ],
)
def test_the_shell_completes(words, expected):
    from click.shell_completion import ShellComplete

    completer = ShellComplete(main, {}, "proprotor", "_PROPROTOR_COMPLETE")
    assert {item.value for item in completer.get_completions(words[:-1], words[-1])} == expected


def test_a_name_that_is_no_case_completes_as_a_file():
    from proprotor.commands.arguments import CaseName

    (item,) = CaseName().shell_complete(None, None, "my")  # type: ignore[arg-type]
    assert item.type == "file"


def test_a_number_of_a_deck_says_its_unit():
    from proprotor.datum import deck_unit

    assert deck_unit(Datum("2.5 deg", 0.04, "rad")) == ("deg", pytest.approx(DEG))
    assert deck_unit(Datum("0.42/rev", 21.0, "rad/s", rotor_speed=50.0)) == ("/rev", 50.0)
    assert deck_unit(Datum("5.7/rad", 5.7, "1/rad")) == ("/rad", 1.0)
    assert deck_unit(Datum("1 %", 0.01, "")) == ("%", 0.01)
    assert deck_unit(Datum("1", 1.0, "")) == ("", 1.0)
