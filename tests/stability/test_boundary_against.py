"""Boundaries against an input: each is the boundary of the case with that input, found one by one."""

import json

import numpy as np
import pytest
from click.testing import CliRunner

import proprotor as pp
from proprotor.commands.main import main
from proprotor.tables.boundary_table import boundary_records, of_mode, only_first, without_doubtful

KNOT = 1852 / 3600
SPEEDS = "240:400:20ktas"
RPM = np.pi / 30
CASE = pp.load_case("xv15-mass-distribution")


@pytest.fixture(scope="module")
def found():
    return CASE.boundary_against({"operation.rotor_speed": "430:550:40 rpm"}, SPEEDS)


def run(*arguments):
    return CliRunner().invoke(main, arguments)


def test_each_boundary_is_that_of_its_own_case(found):
    """The search of a single case names and follows branches; it shares the crossings, not the way to them."""
    for row, rpm in enumerate((430, 470, 510, 550)):
        own = CASE.vary({"operation.rotor_speed": rpm * RPM}).boundaries(SPEEDS)
        here = found.isel({"operation.rotor_speed": row})
        order = np.argsort(here.airspeed.values)[: len(own.boundaries)]
        assert np.isfinite(here.airspeed.values).sum() == len(own.boundaries) > 0
        for place, boundary in zip(order, own.boundaries, strict=True):
            at = here.isel(branch=int(place))
            assert float(at.airspeed) == pytest.approx(boundary.position, rel=1e-8)
            assert float(at.frequency) == pytest.approx(boundary.frequency, rel=1e-6)
            assert (str(at["mode"].item()), str(at.kind.item())) == (boundary.mode, boundary.kind)
            assert str(at.warning.item()) == boundary.warning and bool(at.onset) == boundary.onset
        first = next(boundary for boundary in own.boundaries if boundary.onset)
        assert float(here["first"]) == pytest.approx(first.position, rel=1e-8)


def test_a_root_is_neutral_at_every_boundary(found):
    """By the eigenvalues of the state matrix that M, C and K make, without the package's own solver."""
    for record in boundary_records(found, "rpm"):
        speed = record["airspeed (m/s)"]
        model = CASE.vary({"operation.rotor_speed": record["operation.rotor_speed (rpm)"] * RPM}).linearize(
            speed
        )
        n, solve = len(model.dofs), np.linalg.solve
        state = np.block(
            [[np.zeros((n, n)), np.eye(n)], [-solve(model.M, model.K), -solve(model.M, model.C)]]
        )
        values = np.linalg.eigvals(state)
        wanted = 2j * np.pi * record["frequency (Hz)"]
        assert np.abs(values - wanted).min() < 1e-6 * abs(wanted)


def test_a_branch_is_one_root(found):
    """Chord is a smooth line over the rotor speed: its slopes change little from step to step."""
    chord = found.sel(branch="chord").airspeed.values
    assert np.isfinite(chord).all()
    assert np.abs(np.diff(chord, 2)).max() < 0.02 * chord.max()


def test_equivalent_airspeeds_hold_in_the_air_of_each_altitude():
    case = pp.load_case("xv15-uncoupled", {"operation.altitude": "0 ft"})
    found = case.boundary_against({"operation.altitude": "0:12000:6000 ft"}, "300:400:10keas")
    # Density ratios of the standard atmosphere at 0, 6000 and 12 000 ft, as tables print them.
    ratio = np.array([1.0, 0.8359, 0.6932])
    low = found.searched.sel(end="low").values
    np.testing.assert_allclose(low, 300 * KNOT / np.sqrt(ratio), rtol=1e-4)
    chord = found.sel(branch="chord")
    np.testing.assert_allclose(
        chord.equivalent_airspeed.values / chord.airspeed.values, np.sqrt(ratio), rtol=1e-4
    )
    assert "air_density" not in found.attrs


def test_what_has_no_boundary_says_why():
    found = CASE.boundary_against({"operation.rotor_speed": "430:550:120 rpm"}, "240:280:20ktas")
    assert found.sizes["branch"] == 0 and np.isnan(found["first"].values).all()
    assert found.note.values.tolist() == ["no mode becomes unstable up to 280 KTAS"] * 2
    assert only_first(found).sizes["branch"] == 0 and without_doubtful(found)[0].sizes["branch"] == 0
    fast = CASE.boundary_against({"operation.rotor_speed": "430:550:120 rpm"}, "700:740:20ktas")
    assert all("Mach" in reason for reason in fast.reason.values.tolist())
    assert all("from 700 KTAS on" in reason for reason in fast.reason.values.tolist())
    assert fast.note.values.tolist() == ["no airspeed could be analysed"] * 2
    early = CASE.boundary_against({"operation.rotor_speed": "550:560:10 rpm"}, "370:390:10ktas")
    assert all(
        note.startswith("already unstable at the lowest airspeed, 370 KTAS") for note in early.note.values
    )


def test_a_level_and_parts_of_the_result(found):
    with_margin = CASE.boundary_against({"operation.rotor_speed": "430:550:40 rpm"}, SPEEDS, level=0.01)
    assert (with_margin["first"].values < found["first"].values).all()
    chord = of_mode(found, "chord")
    assert set(chord["mode"].values.ravel()) == {"chord"} or "chord" in chord.branch.values
    first = only_first(found)
    assert first.branch.values.tolist() == ["first instability"]
    np.testing.assert_array_equal(first.airspeed.values[:, 0], found["first"].values)
    with pytest.raises(pp.InputError, match=r"mode = chrod: .*did you mean chord"):
        of_mode(found, "chrod")


@pytest.mark.parametrize(
    ("against", "airspeeds", "message"),
    [
        ({}, None, "against"),
        (
            {"rotor.precone": [0.01], "rotor.radius": [3.0]},
            None,
            "against = rotor.precone, rotor.radius: must be one",
        ),
        ({"rotor.precon": [0.01]}, None, "rotor.precon"),
        ({"rotor.precone": [0.02, 0.01]}, None, "rotor.precone = .*: must be a list of values that rise"),
        ({"rotor.precone": []}, None, "rotor.precone = .*: must be a list of values that rise"),
        ({"rotor.precone": [0.01, 0.02]}, "300 kt", "airspeed = 300 kt: must be a range of airspeeds"),
        ({"operation.rotor_speed": [-1.0, 2.0]}, None, "operation.rotor_speed"),
    ],
)
def test_requests_that_cannot_be(against, airspeeds, message):
    with pytest.raises(pp.InputError, match=message):
        CASE.boundary_against(against, airspeeds)


def test_the_command_writes_what_the_analysis_finds(found, tmp_path):
    csv, png = tmp_path / "b.csv", tmp_path / "b.png"
    arguments = ("boundary", CASE.name, "--against", "rotor_speed=430:550:40 rpm", "--scan", SPEEDS)
    result = run(*arguments, "--csv", str(csv), "--plot", str(png), "--json")
    assert result.exit_code == 0, result.output
    document = json.loads(result.stdout)
    speeds = [record["airspeed (m/s)"] for record in document["boundaries"]]
    assert sorted(speeds) == pytest.approx(sorted(found.airspeed.values[np.isfinite(found.airspeed.values)]))
    rows = [line for line in csv.read_text().splitlines() if not line.startswith("#")]
    assert rows[0].startswith("operation.rotor_speed (rpm),branch,airspeed (KTAS),airspeed (KEAS)")
    assert len(rows) == 1 + len(speeds) and png.stat().st_size > 20_000
    table = run(*arguments, "--first").stdout
    assert table.count(" begins") == 4 and "KTAS" in table and "KEAS" in table


def test_an_altitude_takes_the_place_of_a_density():
    more = ("--scan", "340:420:10kt", "--mode", "chord", "--json")
    result = run("boundary", "xv15-uncoupled", "--against", "altitude=0:10000:10000 ft", *more)
    records = json.loads(result.stdout)["boundaries"]
    assert [record["operation.altitude (ft)"] for record in records] == [0, 10000]
    own = pp.load_case("xv15-uncoupled", {"operation.altitude": "10000 ft"}).flutter_point("340:420:10kt")
    assert records[1]["airspeed (m/s)"] == pytest.approx(own.speed, rel=1e-8)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (("--against", "altitude=0:10:5"), "needs a unit"),
        (("--against", "altitude"), "--against = altitude: must be an input and its values"),
        (("--against", "rotor.precon=1:2:1 deg"), "rotor.precon"),
        (("--against", "rotor_speed=430:550:40 rpm", "--first", "--mode", "chord"), "goes without --mode"),
        (("--against", "rotor_speed=430:550:40 rpm", "--scan", "300 kt"), "must be a range of airspeeds"),
        (("--against", "rotor_speed=430:550:40 rpm", "--points", "x.csv"), "goes with --plot"),
    ],
)
def test_commands_that_cannot_be(more, message):
    result = run("boundary", "xv15-uncoupled", *more)
    assert result.exit_code == 2 and message in result.output, result.output


def test_branches_that_are_doubtful_throughout_are_left_out(found):
    doubtful = found.copy(deep=True)
    doubtful["warning"] = found.warning.astype(object)
    doubtful.warning[:, :] = "no air"
    kept, left_out = without_doubtful(doubtful)
    assert left_out
    first = set(filter(None, found.first_branch.values.tolist()))
    highest = np.nanmax(kept.airspeed.values, axis=1)
    for label in found.branch.values.tolist():
        speed = found.airspeed.sel(branch=label).values
        above = (np.isnan(speed) | (speed >= highest)).all()
        assert (label in left_out) == (above and label not in first), label
    assert sorted([*kept.branch.values.tolist(), *left_out]) == sorted(found.branch.values.tolist())
    place = found.branch.values.tolist().index(left_out[0])
    doubtful.warning[int(np.isfinite(found.airspeed.values[:, place]).argmax()), place] = ""
    assert left_out[0] in without_doubtful(doubtful)[0].branch.values


def test_the_command_shows_doubtful_branches_on_request(tmp_path):
    """At 600 rpm the tip of the blades is beyond Mach .85 well below the boundaries of rotor modes."""
    given = (
        "boundary",
        "xv15-uncoupled",
        "--against",
        "rotor_speed=560:600:40 rpm",
        "--scan",
        "300:480:30kt",
    )
    short, whole = run(*given), run(*given, "--all-boundaries")
    assert "doubtful throughout (--all-boundaries)" in short.stdout
    assert len(short.stdout.splitlines()) < len(whole.stdout.splitlines())
    file = tmp_path / "rows.csv"
    assert run(*given, "--csv", str(file)).exit_code == 0
    rows = [line for line in file.read_text().splitlines() if line[:3] in ("560", "600")]
    assert len(rows) == sum(line[:4] in ("560 ", "600 ") for line in whole.stdout.splitlines())


def test_an_altitude_in_place_of_the_density_is_not_told_as_a_single_altitude():
    found = run(
        "boundary", "xv15-uncoupled", "--against", "altitude=0:9000:9000 ft", "--scan", "360:420:20kt"
    )
    assert found.exit_code == 0 and "altitude = 0" not in found.stdout
