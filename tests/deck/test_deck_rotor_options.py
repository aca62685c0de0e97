"""Blade frequencies and drive train of a deck: the same model as by the options of Python, to the last bit."""

import json
from dataclasses import fields, replace

import numpy as np
import pytest
from click.testing import CliRunner

import proprotor as pp
from proprotor.commands.main import main
from proprotor.deck.describe import deck_fields
from proprotor.errors import InputError
from proprotor.rotor.airfoil import Airfoil

FREQUENCIES = """
[rotor.frequencies]
at_rotor_speed = "458 rpm"
at = { value = [0, 20, 40, 60], unit = "deg" }
flap = { value = [1.95, 1.9, 1.6, 1.4], status = "assumed", source = "a table" }
lag = { value = [1.4, 1.5, 1.7, 1.9] }
cyclic_flap = 1.02
"""
BY_SPEED = """
[rotor.frequencies]
at_rotor_speed = "458 rpm"
against = "airspeed"
at = { value = [0, 200, 400], unit = "kt" }
flap = 1.9
lag = { value = [1.4, 1.5, 1.7] }
"""
DRIVE_TRAIN = """
[drive_train]
drive_inertia = "20 kg*m**2"
drive_damping = "30 N*m*s/rad"
shaft_stiffness = "4e4 N*m/rad"
mast_stiffness = "3e5 N*m/rad"
engine_inertia = "25 kg*m**2"
engine_damping = "10 N*m*s/rad"
"""
KT = 1852 / 3600
RPM_458 = 458 * (np.pi / 30)
TABLE = pp.BladeFrequencies(
    at_rotor_speed=RPM_458,
    at=[float(angle) * (np.pi / 180) for angle in (0, 20, 40, 60)],
    flap=[1.95, 1.9, 1.6, 1.4],
    lag=[1.4, 1.5, 1.7, 1.9],
    cyclic_flap=1.02,
)
TABLE_BY_SPEED = pp.BladeFrequencies(
    at_rotor_speed=RPM_458, against="airspeed", at=[0, 200 * KT, 400 * KT], flap=1.9, lag=[1.4, 1.5, 1.7]
)
TRAIN = pp.DriveTrain(
    drive_inertia=20.0,
    drive_damping=30.0,
    shaft_stiffness=4e4,
    mast_stiffness=3e5,
    engine_inertia=25.0,
    engine_damping=10.0,
)
TABULATED = {"structure": "tabulated", "frequencies": TABLE}


@pytest.fixture
def deck(tmp_path):
    def written(*sections: str):
        path = tmp_path / "deck.toml"
        path.write_text('base = "xv15-uncoupled"\n[case]\nname = "my"\n' + "".join(sections))
        return path

    return written


def same(one, other):
    for name in "MCKB":
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name))
    assert one.dofs == other.dofs


@pytest.mark.parametrize(
    ("sections", "options"),
    [
        ((FREQUENCIES,), TABULATED),
        ((BY_SPEED,), {"structure": "tabulated", "frequencies": TABLE_BY_SPEED}),
        ((DRIVE_TRAIN,), {"drive_train": TRAIN}),
        ((FREQUENCIES, DRIVE_TRAIN), {**TABULATED, "drive_train": TRAIN}),
    ],
)
def test_a_deck_gives_what_the_options_give(deck, sections, options):
    speeds = [60.0, 120.0, 180.0]
    case, plain = pp.load_case(deck(*sections)), pp.load_case("xv15-uncoupled")
    same(case.linearize(speeds), plain.linearize(speeds, **options))
    found, expected = case.sweep(speeds), plain.sweep(speeds, **options)
    np.testing.assert_array_equal(found.eigenvalue, expected.eigenvalue)
    assert not np.array_equal(found.eigenvalue, plain.sweep(speeds).eigenvalue)
    places = [
        [boundary.position for boundary in found.boundaries]
        for found in (case.flutter_point(level=0.03), plain.flutter_point(level=0.03, **options))
    ]
    assert places[0] == places[1] != []
    drives = case.attribution(150.0, "beam"), plain.attribution(150.0, "beam", **options)
    np.testing.assert_array_equal(*(found.contribution for found in drives))


@pytest.mark.parametrize("flap", [[1.95, 1.9, 1.6, 1.4], 1.9, lambda pitch: 2 - pitch**2])
def test_slopes_of_the_table_reach_a_complex_step(flap):
    """Boundaries are found by derivatives with the airspeed, which go through the trim's collective."""
    table = pp.BladeFrequencies(at_rotor_speed=RPM_458, at=TABLE.at, flap=flap, lag=TABLE.lag)
    angles = np.array([-0.1, 0.2, 0.5, 0.9, 1.2])  # at the ends the table is held
    step = 1e-6

    def at(collective):
        return table.rotating(collective, np.zeros(5))

    analytic, high, low = at(angles + 1e-30j), at(angles + step), at(angles - step)
    for name, found in analytic.items():
        np.testing.assert_array_equal(found.real, at(angles)[name])
        np.testing.assert_allclose(
            np.imag(found) / 1e-30, (high[name] - low[name]) / (2 * step), rtol=1e-7, atol=1e-9
        )


@pytest.mark.parametrize(
    ("sections", "options"),
    [
        (FREQUENCIES, {"structure": "coupled"}),
        (FREQUENCIES, {"structure": "diagonal"}),
        (FREQUENCIES, {"structure": "tabulated", "frequencies": TABLE_BY_SPEED}),
        (DRIVE_TRAIN, {"drive_train": None}),
        (DRIVE_TRAIN, {"drive_train": pp.DriveTrain(drive_inertia=3.0)}),
        (DRIVE_TRAIN, {"rotor_speed": "constant"}),
    ],
)
def test_an_option_wins(deck, sections, options):
    same(
        pp.load_case(deck(sections)).linearize(150.0, **options),
        pp.load_case("xv15-uncoupled").linearize(150.0, **options),
    )


def test_commands_take_them_too(deck):
    path, plain = deck(FREQUENCIES, DRIVE_TRAIN), pp.load_case("xv15-uncoupled")

    def points(*more: str):
        result = CliRunner().invoke(main, ["sweep", str(path), "--speed", "200 kt", "--json", *more])
        document = json.loads(result.stdout)
        found = [complex(p["Re s (rad/s)"], p["Im s (rad/s)"]) for p in document["points"]]
        return document["options"]["structure"], found

    for more, told, options in (
        ((), "tabulated", TABULATED),
        (("--structure", "tabulated"), "tabulated", TABULATED),
        (("--structure", "coupled"), "coupled", {}),
    ):
        structure, found = points(*more)
        expected = plain.sweep("200 kt", drive_train=TRAIN, **options).eigenvalue.values.ravel()
        assert structure == told
        np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_inputs_of_the_drive_train_vary(deck):
    """Many designs at once, and derivatives by a complex step, as of any other input."""
    case, plain = pp.load_case(deck(DRIVE_TRAIN)), pp.load_case("xv15-uncoupled")
    given = [entry.name for entry in fields(pp.DriveTrain) if entry.name != "interconnect_stiffness"]
    paths = [f"drive_train.{name}" for name in given]
    assert set(paths) <= set(pp.design_inputs(case))
    dampings = np.array([0.0, 30.0, 300.0])
    batch = case.vary({"drive_train.drive_damping": dampings}).linearize(150.0)
    for place, damping in enumerate(dampings):
        train = replace(TRAIN, drive_damping=damping)
        np.testing.assert_array_equal(batch.C[place], plain.linearize(150.0, drive_train=train).C)
    found = case.sensitivity("damping", paths, airspeed=150.0, mode="chord")
    for path, step in zip(paths, (1e-2, 1e-2, 10.0, 100.0, 1e-2, 1e-2), strict=True):
        value = pp.design_inputs(case)[path].si
        high, low = (
            case.vary({path: value + way * step}).sweep(150.0).damping_ratio.sel(mode="chord").item()
            for way in (1, -1)
        )
        exact = found.derivative.sel(input=path).item()
        assert exact == pytest.approx((high - low) / (2 * step), rel=1e-4, abs=1e-12), path
    assert found.exact.all()


def test_a_study_takes_them(deck):
    case = pp.load_case(deck(FREQUENCIES, DRIVE_TRAIN))
    inputs = {"drive_train.drive_damping": [10.0, 50.0]}
    found = pp.study(case, inputs, 150.0, workers=1, progress=False)
    for damping in inputs["drive_train.drive_damping"]:
        train = replace(TRAIN, drive_damping=damping)
        expected = pp.load_case("xv15-uncoupled").linearize(150.0, drive_train=train, **TABULATED).modes()
        here = found.sel({"drive_train.drive_damping": damping})
        assert here.growth_rate.item() == pytest.approx(expected.eigenvalue.real.max().item(), rel=1e-9)


def test_frequencies_are_no_inputs_that_vary(deck):
    case = pp.load_case(deck(BY_SPEED))
    assert not any(path.startswith("rotor.frequencies") for path in pp.design_inputs(case))
    assert case.sources["rotor.frequencies.flap"].si == 1.9  # but they are told, with their source
    assert pp.load_case(deck(FREQUENCIES)).sources["rotor.frequencies.flap"].source == "a table"


@pytest.mark.parametrize("how", ["a setting", "a variant", "vary"])
def test_their_springs_hold_at_another_rotor_speed(deck, tmp_path, how):
    """Of the deck with that rotor speed from the start: the table keeps the rotor speed at which it was written."""
    path, slower = deck(FREQUENCIES), 300 * (np.pi / 30)
    if how == "a setting":
        case = pp.load_case(path, {"operation.rotor_speed": "300 rpm"})
    elif how == "a variant":
        text = f'base = "{path.name}"\n[case]\nname = "slow"\n[operation]\nrotor_speed = "300 rpm"\n'
        (tmp_path / "slow.toml").write_text(text)
        case = pp.load_case(tmp_path / "slow.toml")
    else:
        case = pp.load_case(path).vary({"operation.rotor_speed": slower})
    plain = pp.load_case("xv15-uncoupled").vary({"operation.rotor_speed": slower})
    same(case.linearize([60.0, 120.0]), plain.linearize([60.0, 120.0], **TABULATED))
    per_rev = pp.load_case(path, {"rotor.frequencies.at_rotor_speed": "300 rpm"})
    other = per_rev.vary({"operation.rotor_speed": slower}).linearize(120.0)
    assert not np.allclose(other.K, case.linearize(120.0).K, rtol=1e-3)


def test_they_keep_the_pitch_coupling_of_the_springs_if_asked(deck):
    keeping = 'pitch_coupling = "springs"\n'
    case, plain = pp.load_case(deck(FREQUENCIES, keeping)), pp.load_case("xv15-uncoupled")
    options = TABULATED | {"frequencies": replace(TABLE, pitch_coupling="springs")}
    same(case.linearize(150.0), plain.linearize(150.0, **options))
    assert not np.allclose(case.linearize(150.0).K, plain.linearize(150.0, **TABULATED).K, rtol=1e-3)


def test_a_field_of_them_is_set(deck):
    case = pp.load_case(
        deck(BY_SPEED, DRIVE_TRAIN),
        {"rotor.frequencies.flap": "1.8", "drive_train.shaft_stiffness": "0 N*m/rad"},
    )
    assert case.frequencies.flap == 1.8
    assert case.drive_train.shaft_stiffness == 0


@pytest.mark.parametrize(
    ("sections", "told"),
    [
        (
            FREQUENCIES.replace("at_rotor_speed", "# at_rotor_speed"),
            "rotor.frequencies.at_rotor_speed: is missing; frequencies per revolution hold at one rotor speed: "
            'write at_rotor_speed = "458 rpm"',
        ),
        (
            FREQUENCIES.replace('"458 rpm"', '"0 rpm"'),
            "rotor.frequencies.at_rotor_speed = 0 rpm: must be positive",
        ),
        (
            FREQUENCIES.replace('"458 rpm"', "458"),
            "rotor.frequencies.at_rotor_speed = 458: needs a unit; it is a rotational speed",
        ),
        (
            FREQUENCIES + 'pitch_coupling = "some"\n',
            "rotor.frequencies.pitch_coupling = some: must be 'none' or 'springs'",
        ),
        (
            FREQUENCIES.replace("flap = {", "flpa = {", 1),
            "rotor.frequencies.flpa = { … }: unknown field 'flpa'; did you mean flap?",
        ),
        (
            FREQUENCIES.replace("1.95, ", ""),
            "rotor.frequencies.flap = 3 values: must have one value for each",
        ),
        (
            FREQUENCIES.replace("at = ", "# at = "),
            "rotor.frequencies.at: is missing; flap has 4 values",
        ),
        (
            FREQUENCIES.replace("[0, 20", "[0, -20"),
            "rotor.frequencies.at.value = 0, -20: must rise from value to value",
        ),
        (FREQUENCIES.replace('"deg"', '"kt"'), "rotor.frequencies.at.unit = kt: must be an angle"),
        (FREQUENCIES.replace(', unit = "deg"', ""), "rotor.frequencies.at.unit: is missing"),
        (
            FREQUENCIES.replace("cyclic_flap = 1.02", "cyclic_flap = -1"),
            "rotor.frequencies.cyclic_flap = -1: must be positive",
        ),
        (
            FREQUENCIES.replace("1.95", '"1.95"'),
            "rotor.frequencies.flap.value = ['1.95', 1.9, 1.6, 1.4]: must be a list of numbers",
        ),
        (FREQUENCIES.replace("1.95", "inf"), "rotor.frequencies.flap.value = inf: must be finite"),
        (
            BY_SPEED.replace('"airspeed"', '"time"'),
            "rotor.frequencies.against = time: must be 'collective' or 'airspeed'",
        ),
        (
            DRIVE_TRAIN.replace("20 kg", "-20 kg"),
            "drive_train.drive_inertia = -20 kg*m**2: must not be negative",
        ),
        (
            DRIVE_TRAIN.replace("drive_damping", "damping"),
            "drive_train.damping = 30 N*m*s/rad: unknown field 'damping'; did you mean drive_damping?",
        ),
        (
            DRIVE_TRAIN.replace("4e4 N*m/rad", "4e4 N*m"),
            "drive_train.shaft_stiffness = 4e4 N*m: must be a mom",
        ),
    ],
)
def test_what_is_wrong_with_them_is_told(deck, sections, told):
    with pytest.raises(InputError) as caught:
        pp.load_case(deck(sections))
    assert told in str(caught.value)
    assert len(str(caught.value).splitlines()) <= 2


def test_every_argument_of_the_classes_behind_a_deck_is_a_field():
    paths = {field.path for field in deck_fields()}
    for prefix, described in (
        ("rotor", pp.Rotor),
        ("rotor.airfoil", Airfoil),
        ("rotor.frequencies", pp.BladeFrequencies),
        ("operation", pp.Operation),
        ("drive_train", pp.DriveTrain),
    ):
        for entry in fields(described):
            if entry.name not in ("airfoil", "offset_mass"):  # a section of its own; of `mass_offset`
                assert f"{prefix}.{entry.name}" in paths
