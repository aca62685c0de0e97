"""Decks: units, provenance, alteration of another deck, and one clear line for every mistake."""

import os
import re
import subprocess
import sys
import time
import tomllib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from proprotor.datum import STATUSES, Datum
from proprotor.deck.file import list_cases, read_tables
from proprotor.deck.validation import validate
from proprotor.errors import InputError
from proprotor.units import as_si, speeds, to_si, unit_registry

DECKS = Path(sys.modules["proprotor"].__file__).parent / "deck" / "decks"
XV15 = (DECKS / "xv15-uncoupled.toml").read_text(encoding="utf-8")

US_DECK = """
[case]
name = "small"
title = "A small deck"

[rotor]
n_blades = 3
radius = "12.5 ft"
root_cutout = "1 ft"
precone = "2.5 deg"
flap_hinge_offset = "0.8 ft"
lag_hinge_offset = "1.4 ft"
blade_mass = "4.14 slug"
blade_first_moment = "14.2 slug*ft"
blade_inertia = "105 slug*ft**2"
flap_first_moment = "10.2 slug*ft"
flap_inertia = "81.8 slug*ft**2"
lag_first_moment = "8.69 slug*ft"
lag_inertia = "70.4 slug*ft**2"
flap_frequency = "9.5 Hz"
lag_stiffness = "550000 ft*lbf/rad"
flap_outboard_fraction = 1
lag_outboard_fraction = "100 %"
gimbal_stiffness = "2700 in*lbf/deg"
pitch_gimbal_coupling = -0.268
pitch_inertia = "0.5 slug*ft**2"
control_stiffness = "10000 ft*lbf/rad"
gimbal_damping = "12 ft*lbf*s/rad"
chord = "14 in"
twist = { r_over_R = [0.1, 0.75, 1], value = [30, 0, -6], unit = "deg" }

[rotor.airfoil]
lift_slope = "5.7/rad"
drag = 0.0065

[operation]
rotor_speed = "458 rpm"
density = "0.0023769 slug/ft**3"
speed_of_sound = "1116.45 ft/s"

[support]
kind = "normal-modes"
includes_rotor = true

[[support.modes]]
name = "beam"
coordinate = "length"
generalized_mass = "59 slug"
frequency = "0.42/rev"
damping_ratio = "1 %"
x = 1
alpha_z = "-0.09 rad/ft"

[[support.modes]]
name = "torsion"
coordinate = "angle"
generalized_mass = "1000 slug*ft**2"
frequency = "9.9 Hz"
damping_ratio = "1 %"
alpha_y = 1
x = "4.275 ft/rad"
"""

# The exact definitions of the units, by hand: nothing here comes from the registry under test.
FT = 0.3048
LBF = 0.45359237 * 9.80665
SLUG = LBF / FT
DEG = np.pi / 180


def changed(*replacements: tuple[str, str], text: str = US_DECK) -> str:
    for old, new in replacements:
        assert text.count(old) >= 1, old
        text = text.replace(old, new, 1)
    return text


def read(tmp_path: Path, text: str | bytes):
    path = tmp_path / "deck.toml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return validate(read_tables(path))


def si_values(section, path=""):
    """Every number of a deck by its path."""
    for name in type(section).model_fields:
        value, here = getattr(section, name), f"{path}{name}"
        if isinstance(value, Datum):
            yield here, value
        elif isinstance(value, list):
            for i, entry in enumerate(value):
                if hasattr(type(entry), "model_fields"):
                    yield from si_values(entry, f"{here}[{i}].")
        elif hasattr(type(value), "model_fields"):
            yield from si_values(value, f"{here}.")


# What is changed in the deck above, to what, and how the line about it begins.
MISTAKES = [
    ('radius = "12.5 ft"\n', "", "rotor.radius: is missing"),
    ('[operation]\nrotor_speed = "458 rpm"\n', "[odd]\n", "operation: is missing"),
    ("precone =", "pre_cone =", "rotor.pre_cone = 2.5 deg: unknown field 'pre_cone'; did you mean precone?"),
    ("x = 1\n", "w = 1\n", "support.modes[beam].w = 1: unknown field 'w'; known: name, coordinate, "),
    ("[operation]", "[operations]", "operations = "),
    (
        '"12.5 ft"',
        '{ value = "12.5 ft", statu = "published" }',
        "rotor.radius.statu = published: unknown field 'statu'; did you mean status?",
    ),
    (
        '"12.5 ft"',
        '{ value = "12.5 ft", status = "guessed" }',
        "rotor.radius.status = guessed: must be one of published, measured, derived, recalled, calibrated, assumed",
    ),
    ('"12.5 ft"', '{ value = "12.5 ft", source = 3 }', "rotor.radius.source = 3: must be text"),
    ('"12.5 ft"', '{ status = "derived" }', "rotor.radius.value: is missing"),
    ("12.5 ft", "12.5 furlong/s", 'rotor.radius = 12.5 furlong/s: must be a length, such as "12.5 ft"'),
    (
        "2700 in*lbf/deg",
        "2700 in*lb/deg",
        'rotor.gimbal_stiffness = 2700 in*lb/deg: must be a moment per angle, such as "2700 in*lbf/deg"',
    ),
    (
        "2700 in*lbf/deg",
        "2700 in*lbf",
        'rotor.gimbal_stiffness = 2700 in*lbf: must be a moment per angle, such as "2700 in*lbf/deg"',
    ),
    ('"2.5 deg"', "2.5", 'rotor.precone = 2.5: needs a unit; it is an angle, such as "2.5 deg"'),
    ("12.5 ft", "12.5 foott", "rotor.radius = 12.5 foott: has an unknown unit 'foott'; did you mean foot?"),
    (
        "12.5 ft",
        "12.5 ft/(",
        'rotor.radius = 12.5 ft/(: has a unit that cannot be read; write it as in "2700 in*lbf/deg"',
    ),
    ("12.5 ft", "twelve feet", 'rotor.radius = twelve feet: must be a number and a unit, such as "12.5 ft"'),
    ("-0.268", "nan", "rotor.pitch_gimbal_coupling = nan: must be finite"),
    ("12.5 ft", "nan ft", "rotor.radius = nan ft: must be finite"),
    ("12.5 ft", "1e999 ft", "rotor.radius = 1e999 ft: must be finite"),
    ("12.5 ft", "1e306 km", "rotor.radius = 1e306 km: must be finite"),
    ("-0.268", "9" * 400, "rotor.pitch_gimbal_coupling = 9999999"),
    ('root_cutout = "1 ft"', 'root_cutout = "-1 ft"', "rotor.root_cutout = -1 ft: must not be negative"),
    ("12.5 ft", "0 ft", "rotor.radius = 0 ft: must be positive"),
    ("0.0065", "-0.0065", "rotor.airfoil.drag = -0.0065: must not be negative"),
    ("100 %", "110 %", "rotor.lag_outboard_fraction = 110 %: must lie between 0 and 1"),
    ("-0.268", "true", 'rotor.pitch_gimbal_coupling = true: must be a plain number, such as 0.0065 or "1 %"'),
    ('"12.5 ft"', "[1, 2]", 'rotor.radius = [1, 2]: must be a length, such as "12.5 ft"'),
    ('"12.5 ft"', "1979-05-27", 'rotor.radius = 1979-05-27: must be a length, such as "12.5 ft"'),
    ('title = "A small deck"', "title = 3", "case.title = 3: must be text"),
    ('"A small deck"', '""', 'case.title = "": must not be empty'),
    (
        "includes_rotor = true",
        'includes_rotor = "yes"',
        'support.includes_rotor = yes: must be "gimballed" or "rigid" or "mass only" or true or false',
    ),
    ("n_blades = 3", "n_blades = 2", "rotor.n_blades = 2: must be a whole number, at least 3"),
    ("n_blades = 3", "n_blades = 3.5", "rotor.n_blades = 3.5: must be a whole number, at least 3"),
    ("[rotor.airfoil]", "airfoil = 1\n[case.odd]", "rotor.airfoil = 1: must be a table"),
    ('lift_slope = "5.7/rad"\n', "", "rotor.airfoil.lift_slope: is missing; give lift_slope or table"),
    ('lift_slope = "5.7/rad"', 'table = "a.c81"', "rotor.airfoil.table = a.c81: must not be given with drag"),
    (
        'lift_slope = "5.7/rad"\ndrag = 0.0065',
        "table = 3",
        "rotor.airfoil.table = 3: must be the name of a file",
    ),
    (
        'lift_slope = "5.7/rad"\ndrag = 0.0065',
        'table = ""',
        'rotor.airfoil.table = "": must be the name of a file',
    ),
    (
        "flap_frequency",
        "lag_frequency",
        "rotor.flap_stiffness: is missing; give flap_stiffness or flap_frequency",
    ),
    (
        'chord = "14 in"',
        'chord = "14 in"\nlock_number = 3.8',
        "rotor.lock_number: must not be given twice over; give chord or lock_number",
    ),
    ('lag_inertia = "70.4 slug*ft**2"', "", "rotor.lag_inertia: is missing"),
    (
        "value = [30, 0, -6]",
        "value = [30, 0]",
        "rotor.twist.value = 2 values: must have one value for each of the 3 r_over_R",
    ),
    (
        "[0.1, 0.75, 1]",
        "[0.1, 0.1, 1]",
        "rotor.twist.r_over_R = 0.1, 0.1: must increase from station to station",
    ),
    (
        "[0.1, 0.75, 1]",
        "[0.1, 0.75, 1.2]",
        "rotor.twist.r_over_R = [0.1, 0.75, 1.2]: must lie between 0 (centre of rotation) and 1 (tip)",
    ),
    ("[0.1, 0.75, 1]", "[0.1]", "rotor.twist.r_over_R = [0.1]: must have two stations or more"),
    ("[30, 0, -6]", '[30, "x", -6]', "rotor.twist.value = [30, 'x', -6]: must be a list of numbers"),
    ("[30, 0, -6]", "[30, nan, -6]", "rotor.twist.value = nan: must be finite"),
    ('unit = "deg"', 'unit = "ft"', 'rotor.twist.unit = ft: must be an angle, such as "2.5 deg"'),
    (', unit = "deg"', "", "rotor.twist.unit: is missing"),
    (
        "[support]",
        "trim = 3\n[support]",
        'operation.trim = 3: must be "windmill" or { collective = "30 deg" }',
    ),
    (
        "[support]",
        'trim = { collective = "3 ft" }\n[support]',
        'operation.trim.collective = 3 ft: must be an angle, such as "2.5 deg"',
    ),
    ('kind = "normal-modes"', 'kind = "beam"', "support.kind = beam: must be 'normal-modes'"),
    ('name = "torsion"', 'name = "beam"', "support.modes.name = beam: must not name two modes"),
    (
        'name = "torsion"',
        'name = "a\\nb"',
        "support.modes[a b].name = a b: must be printable text, without U+000A",
    ),
    (
        'coordinate = "angle"',
        'coordinate = "rad"',
        "support.modes[torsion].coordinate = rad: must be 'length' or 'angle'",
    ),
    (
        "1000 slug*ft**2",
        "1000 slug",
        'support.modes[torsion].generalized_mass = 1000 slug: must be a moment of inertia, such as "105',
    ),
    (
        "4.275 ft/rad",
        "4.275 ft",
        'support.modes[torsion].x = 4.275 ft: must be a length per angle, such as "4.3 ft/rad"',
    ),
    (
        'damping_ratio = "1 %"',
        "damping_ratio = 1",
        'support.modes[beam].damping_ratio = 1: must be at least 0 and below 1; write one percent as "1',
    ),
    (
        "x = 1\nalpha_z",
        "#",
        "support.modes[beam]: must move the hub; give one or more of x, y, z, alpha_x, alpha_y, alpha_z",
    ),
    ("0.42/rev", "-0.42/rev", "support.modes[beam].frequency = -0.42/rev: must not be negative"),
    (
        "12.5 ft",
        "__import__('os').getcwd()",
        "rotor.radius = __import__('os').getcwd(): must be a number and a unit, such as \"12.5 ft\"",
    ),
    (
        "12.5 ft",
        "1 __import__('os')",
        "rotor.radius = 1 __import__('os'): has a unit that cannot be read; write it as in \"2700",
    ),
    (
        "12.5 ft",
        "10**10**10 ft",
        'rotor.radius = 10**10**10 ft: has a unit that cannot be read; write it as in "2700 in*lbf/deg"',
    ),
    (
        "12.5 ft",
        "1 ft**10**10",
        'rotor.radius = 1 ft**10**10: has a unit that cannot be read; write it as in "2700 in*lbf/deg"',
    ),
    ("12.5 ft", "1 " + "ft*" * 9999, "rotor.radius = 1 ft*ft*ft"),
    ("9.5 Hz", " " * 99_999, "rotor.flap_frequency =  "),
]


@pytest.mark.parametrize(("old", "new", "line"), MISTAKES, ids=[mistake[2] for mistake in MISTAKES])
def test_a_mistake_is_told_in_one_line(tmp_path, old, new, line):
    started = time.perf_counter()
    with pytest.raises(InputError) as caught:
        read(tmp_path, changed((old, new)))
    assert time.perf_counter() - started < 5  # no text may keep the reader busy
    lines = str(caught.value).splitlines()
    assert any(told.startswith(line) for told in lines), lines
    assert len(lines) <= 2  # a misspelt field is an unknown one and a missing one


def test_all_mistakes_are_told_at_once(tmp_path):
    text = changed(("12.5 ft", "12.5 kt"), ("0.0065", "-1"), ("59 slug", "59 lbf"))
    with pytest.raises(InputError) as caught:
        read(tmp_path, text)
    lines = str(caught.value).splitlines()
    assert [line.split(" = ")[0] for line in lines] == [
        "rotor.radius",
        "rotor.airfoil.drag",
        "support.modes[beam].generalized_mass",
    ]


toml_values = st.recursive(
    st.booleans() | st.integers() | st.floats() | st.text(max_size=20) | st.dates() | st.times(),
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(st.sampled_from(["value", "r_over_R", "unit", "status", "name"]), inner, max_size=4)
    ),
    max_leaves=6,
)


def places(table, path=()):
    """Every place in nested tables and lists."""
    for key, entry in table.items() if isinstance(table, dict) else enumerate(table):
        yield (*path, key)
        if isinstance(entry, dict | list):
            yield from places(entry, (*path, key))


@given(place=st.sampled_from(list(places(tomllib.loads(US_DECK)))), value=toml_values)
def test_any_value_anywhere_is_read_or_refused(place, value):
    tables = tomllib.loads(US_DECK)
    inner = tables
    for key in place[:-1]:
        inner = inner[key]
    inner[place[-1]] = value
    try:
        validate(tables)
    except InputError as error:
        assert all(": " in line for line in str(error).splitlines())


@given(st.text("0123456789.eE+-*/^()% \tmftslugNradkHz_·'\"[]{},:\0µ", max_size=30))
@example("1 (" + "(" * 70)
@example("9" * 79)
@example("1 m" + "**-9" * 10)
@example("1 " + "aeiou" * 15)
@example("1 %%%%%%%%")
@example("0.4//rev")
def test_any_text_is_a_quantity_or_refused(text):
    for read_text in (lambda: to_si(text, "m"), lambda: speeds(text)):
        try:
            assert np.isfinite(read_text()).all()
        except InputError as error:
            assert "\n" not in str(error)


def test_a_file_that_is_not_toml_is_told_with_its_line(tmp_path):
    with pytest.raises(InputError, match=r"deck = .*: is not TOML: .*line 2"):
        read(tmp_path, "[case]\nname = \n")


@pytest.mark.parametrize(
    ("content", "rule"),
    [
        (b"\xff", "must be text in UTF-8"),
        (b"a = " + b"[" * 100_000, "nested too deeply"),
        (b"a = " + b"9" * 5_000, "is not TOML"),
        (b"#" * 1_100_000, "must not be larger"),
        (b"", "case: is missing"),
    ],
)
def test_a_file_that_is_no_deck(tmp_path, content, rule):
    with pytest.raises(InputError, match=rule):
        read(tmp_path, content)


@pytest.mark.parametrize(
    ("name", "rule"),
    [
        ("xv51", r"unknown deck 'xv51'; did you mean xv15\?"),
        ("XV15.toml", r"no such file; did you mean the bundled deck xv15\?"),
        ("nowhere/xv15-wng.toml", r"no such file; did you mean the bundled deck xv15-wing\?"),
        ("nowhere/deck.toml", "no such file$"),
        (os.sep, "must be a file, not a folder"),
        ("/dev/zero", "no such file"),
        ("a" * 9999, "cannot be read"),
        ("\0", "unknown deck"),
    ],
)
def test_a_deck_that_cannot_be_found(name, rule):
    with pytest.raises(InputError, match=rule):
        read_tables(name)


def test_units_of_a_deck(tmp_path):
    deck = dict(si_values(read(tmp_path, US_DECK)))
    expected = {
        "rotor.radius": 12.5 * FT,
        "rotor.precone": 2.5 * DEG,
        "rotor.blade_first_moment": 14.2 * SLUG * FT,
        "rotor.blade_inertia": 105 * SLUG * FT**2,
        "rotor.flap_frequency": 9.5 * 2 * np.pi,  # hertz are cycles
        "rotor.lag_outboard_fraction": 1,
        "rotor.gimbal_stiffness": 2700 * LBF * FT / 12 / DEG,
        "rotor.gimbal_damping": 12 * FT * LBF,
        "rotor.chord": 14 / 12 * FT,
        "rotor.airfoil.lift_slope": 5.7,
        "operation.rotor_speed": 458 * 2 * np.pi / 60,
        "operation.density": 0.0023769 * SLUG / FT**3,
        "support.modes[0].alpha_z": -0.09 / FT,
        "support.modes[0].damping_ratio": 0.01,
        "support.modes[1].generalized_mass": 1000 * SLUG * FT**2,
        "support.modes[1].x": 4.275 * FT,
    }
    assert {field: deck[field].si for field in expected} == pytest.approx(expected, rel=1e-14)
    assert deck["rotor.twist"].si == pytest.approx([30 * DEG, 0, -6 * DEG], rel=1e-14)
    assert deck["rotor.radius"].written == "12.5 ft"
    assert deck["rotor.radius"].status == "unstated"


def test_the_same_deck_in_si_has_the_same_values(tmp_path):
    si_units = [
        ("slug*ft**2", "kg*m**2", SLUG * FT**2),
        ("slug*ft", "kg*m", SLUG * FT),
        ("slug/ft**3", "kg/m**3", SLUG / FT**3),
        ("slug", "kg", SLUG),
        ("in*lbf/deg", "N*m/rad", FT / 12 * LBF / DEG),
        ("ft*lbf*s/rad", "N*m*s/rad", FT * LBF),
        ("ft*lbf/rad", "N*m/rad", FT * LBF),
        ("ft/rad", "m/rad", FT),
        ("rad/ft", "rad/m", 1 / FT),
        ("ft/s", "m/s", FT),
        ("ft", "m", FT),
        ("in", "m", FT / 12),
        ("rpm", "rad/s", np.pi / 30),
        ("deg", "rad", DEG),
    ]
    text = US_DECK
    for written, si, factor in si_units:
        number = rf'"([-+.0-9e]+) {re.escape(written)}"'
        text = re.sub(number, lambda m, s=si, f=factor: f'"{float(m[1]) * f!r} {s}"', text)
    text = changed(('[30, 0, -6], unit = "deg"', f'[{30 * DEG!r}, 0, {-6 * DEG!r}], unit = "rad"'), text=text)
    assert not re.search('slug|ft[*/"]|lbf|deg|rpm', text)
    here, there = dict(si_values(read(tmp_path, US_DECK))), dict(si_values(read(tmp_path, text)))
    assert here.keys() == there.keys()
    for field in here:
        np.testing.assert_allclose(there[field].si, here[field].si, rtol=1e-12, err_msg=field)


@pytest.mark.parametrize("name", list_cases())
def test_every_number_of_a_bundled_deck_has_status_and_source(name):
    numbers = dict(si_values(validate(read_tables(name))))
    assert len(numbers) > 40
    for field, datum in numbers.items():
        assert datum.status in STATUSES, field
        assert len(datum.source) > 3, field


def test_no_number_of_a_bundled_deck_stands_outside_a_table():
    for path in DECKS.glob("*.toml"):
        for line in path.read_text(encoding="utf-8").splitlines():
            plain = re.fullmatch(r"\s*(\w+) = [-+\"]?[0-9.].*", line)
            assert not plain, f"{path.name}: {line}"


def test_xv15_chord_is_that_of_its_lock_number():
    deck = dict(si_values(validate(read_tables("xv15-uncoupled"))))
    slope, density = deck["rotor.airfoil.lift_slope"].si, deck["operation.density"].si
    chord, radius, inertia = (deck[f"rotor.{name}"].si for name in ("chord", "radius", "blade_inertia"))
    assert density * slope * chord * radius**4 / inertia == pytest.approx(3.83, rel=1e-4)


def test_a_deck_alters_another(tmp_path):
    text = """
    base = "xv15-uncoupled"
    [case]
    name = "stiffer"
    [rotor]
    control_stiffness = "22400 ft*lbf/rad"
    lock_number = 3.68
    [rotor.airfoil]
    drag = 0
    [operation]
    trim = { collective = "30 deg" }
    """
    base, deck = (
        dict(si_values(validate(read_tables("xv15-uncoupled")))),
        dict(si_values(read(tmp_path, text))),
    )
    different = {field for field in base.keys() | deck.keys() if base.get(field) != deck.get(field)}
    assert different == {
        "rotor.control_stiffness",
        "rotor.chord",  # gives way to
        "rotor.lock_number",
        "rotor.airfoil.drag",
        "operation.trim.collective",
    }


def test_a_deck_alters_a_file_beside_it(tmp_path):
    (tmp_path / "base.toml").write_text(US_DECK)
    deck = read(tmp_path, 'base = "base.toml"\n[case]\nname = "other"\n')
    assert (deck.case.name, deck.case.title) == ("other", "A small deck")


def test_a_table_stands_in_for_an_airfoil_and_the_other_way_round(tmp_path):
    folder = tmp_path / "folder"
    folder.mkdir()
    table = '[rotor.airfoil]\ntable = { value = "a.c81", status = "assumed", source = "made up" }\n'
    (folder / "tabulated.toml").write_text(f'base = "xv15-uncoupled"\n[case]\nname = "tabulated"\n{table}')
    deck = dict(si_values(read(folder, (folder / "tabulated.toml").read_text())))
    airfoil = {field: datum for field, datum in deck.items() if field.startswith("rotor.airfoil")}
    assert airfoil == {"rotor.airfoil.table": Datum("a.c81", str(folder / "a.c81"), "", "assumed", "made up")}

    renamed = 'base = "folder/tabulated.toml"\n[case]\nname = "renamed"\n'
    assert dict(si_values(read(tmp_path, renamed))) == deck  # the name starts from the deck that has it
    here = dict(si_values(read(tmp_path, renamed + '[rotor.airfoil]\ntable = "a.c81"\n')))
    assert here["rotor.airfoil.table"].si == str(tmp_path / "a.c81")
    linear = dict(si_values(read(tmp_path, renamed + '[rotor.airfoil]\nlift_slope = "6/rad"\n')))
    assert {field for field in linear if field.startswith("rotor.airfoil")} == {"rotor.airfoil.lift_slope"}


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ('base = "deck.toml"', "base = deck.toml: must not lead back to the deck itself"),
        ('base = "./deck.toml"', "base = ./deck.toml: must not lead back to the deck itself"),
        ('base = "folder/../deck.toml"', "base = folder/../deck.toml: must not lead back to the deck itself"),
        ("base = 3", "base = 3: must be the name or path of a deck"),
        ('base = "xv16"', "deck = xv16: unknown deck 'xv16'; did you mean xv15?"),
        ('base = "xv15-uncoupled"', "case.name: is missing"),
    ],
)
def test_a_base_that_cannot_be_used(tmp_path, text, line):
    (tmp_path / "folder").mkdir()
    with pytest.raises(InputError) as caught:
        read(tmp_path, text)
    assert str(caught.value) == line


@pytest.mark.parametrize(
    ("text", "knots"),
    [
        ("300 kt", [300]),
        ("50:400:5kt", np.arange(50, 401, 5)),
        ("50:400:100 kt", [50, 150, 250, 350]),
        (" 100 : 200 : 50 kts ", [100, 150, 200]),
        ("100:100:5kt", [100]),
        ("0:1:0.1kt", np.linspace(0, 1, 11)),
    ],
)
def test_speeds(text, knots):
    np.testing.assert_allclose(speeds(text), np.asarray(knots) * 1852 / 3600, rtol=1e-14, atol=1e-14)


def test_speeds_in_other_units():
    np.testing.assert_allclose(speeds("10:30:10 m/s"), [10, 20, 30], rtol=1e-15)
    np.testing.assert_allclose(speeds("36 km/h"), [10], rtol=1e-14)


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        ("fast", "must be a speed such as"),
        ("300", "needs a unit"),
        ("50:400:5", "needs a unit"),
        ("50:400 kt", "or a range such as"),
        ("300 ft", "must be a speed"),
        ("300 nots", "unknown unit"),
        ("-5 kt", "must not be negative"),
        ("400:50:5kt", "must rise from start to stop"),
        ("50:400:0kt", "by a positive step"),
        ("50:400:-5kt", "by a positive step"),
        ("0:1e9:1e-3kt", "at most 100000 speeds"),
        ("0:1e999:1kt", "must be finite"),
        ("0:1:1e999kt", "must be finite"),
        ("0:1" * 200, "must be a speed such as"),
    ],
)
def test_speeds_that_are_none(text, rule):
    with pytest.raises(InputError, match=f"^airspeed = .*: .*{rule}") as caught:
        speeds(text)
    assert "\n" not in str(caught.value)


def test_arguments_may_be_quantities():
    import pint

    elsewhere = pint.UnitRegistry()
    assert as_si(30.0, "m/s") == 30
    assert as_si("36 km/h", "m/s") == pytest.approx(10)
    np.testing.assert_allclose(as_si(elsewhere.Quantity([36, 72], "km/h"), "m/s"), [10, 20])
    with pytest.raises(InputError, match="airspeed = 3 meter: must be a speed"):
        as_si(elsewhere.Quantity(3, "m"), "m/s", "airspeed")


def test_every_unit_agrees_with_the_usual_registry():
    """Except where they differ on purpose: an angle is a dimension, and hertz are cycles per second."""
    import pint

    usual = pint.UnitRegistry()
    of = {
        "m": ["ft", "in", "yd", "mi", "nmi", "mm", "cm", "km"],
        "kg": ["slug", "lb", "g", "lbf*s**2/ft", "kN*s**2/m"],
        "m/s": ["kt", "mph", "km/h", "ft/min"],
        "rad/s": ["rpm", "deg/s"],
        "rad": ["deg", "turn"],
        "N*m/rad": ["in*lbf/deg"],
        "": ["%"],
    }
    for si, unit in ((si, unit) for si, units in of.items() for unit in units):
        expected = usual.Quantity(1, unit).to(si).magnitude
        assert to_si(f"1 {unit}", si) == pytest.approx(expected, rel=1e-14), unit
    assert to_si("1 Hz", "rad/s") == pytest.approx(2 * np.pi)


def test_a_unit_may_be_written_in_many_ways():
    for text in ("2700in*lbf/deg", "2.7e3 in lbf / deg", "2700 in-lbf/deg", "2700 in·lbf/deg"):
        assert to_si(text, "N*m/rad") == pytest.approx(2700 * FT / 12 * LBF / DEG)
    for text in ("3 slug*ft**2", "3 slug ft^2", "3 slug-ft**2", "3 (slug*ft)*ft"):
        assert to_si(text, "kg*m**2") == pytest.approx(3 * SLUG * FT**2)
    for text in ("5.7/rad", "5.7 /rad", "5.7 1/rad", "5.7 rad**-1"):
        assert to_si(text, "1/rad") == pytest.approx(5.7)


def test_the_package_loads_without_the_unit_and_schema_libraries():
    code = "import proprotor.units, proprotor.deck.file, sys; print({'pint', 'pydantic'} & set(sys.modules))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "set()"


def test_one_registry_serves_all():
    assert unit_registry() is unit_registry()
