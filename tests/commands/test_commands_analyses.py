"""The commands flutter, map, sensitivity, attribution, cases, study: the same numbers as the functions behind the
commands, in the units people read, in every form of output."""

import csv
import json
import math

import numpy as np
import pytest
from click.testing import CliRunner, Result

import proprotor as pp
from proprotor.commands.main import main
from proprotor.study.batch import Analysis
from tests.csv_files import without_comments

KT = 1852 / 3600
OMEGA = 458 * np.pi / 30  # of the XV-15
SCAN = "340:400:10kt"  # holds the boundary of the chord mode
CHORD = "support.modes[chord].frequency"


def run(*arguments: object) -> Result:
    result = CliRunner().invoke(main, [str(a) for a in arguments], env={"COLUMNS": "120"})
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result


def document(*arguments: object):
    def refuse(constant: str):
        raise AssertionError(constant)

    result = run(*arguments, "--json")
    assert result.exit_code == 0, result.stderr
    return json.loads(result.stdout, parse_constant=refuse)


def growth(speed, name="chord", **values):
    """Re s of a mode of the XV-15 at an airspeed in kt."""
    modes = pp.load_case("xv15-uncoupled").vary(values).sweep(f"{speed!r} kt")
    return float(modes.eigenvalue.sel(mode=name).values.real[0])


# flutter ------------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def boundaries():
    return document("flutter", "xv15-uncoupled", "--scan", SCAN, "--speed", "350 kt")


def test_the_mode_is_neutral_at_the_flutter_speed(boundaries):
    speed = boundaries["flutter speed (KTAS)"]
    assert boundaries["flutter speed (m/s)"] == pytest.approx(speed * KT, rel=1e-12)
    assert boundaries["mode"] == "chord"
    assert abs(growth(speed)) < 1e-6
    assert growth(speed - 1) < 0 < growth(speed + 1)


def test_boundaries_have_speed_frequency_mode_and_mechanism(boundaries):
    first = boundaries["boundaries"][0]
    assert first["mode"] == "chord" and first["kind"] == "flutter" and first["onset"] is True
    assert first["frequency (Hz)"] * 2 * np.pi == pytest.approx(
        first["frequency (per rev)"] * OMEGA, rel=1e-9
    )
    modes = pp.load_case("xv15-uncoupled").sweep(f"{first['airspeed (KTAS)']!r} kt")
    frequency = abs(modes.eigenvalue.sel(mode="chord").values.imag[0])
    assert first["frequency (Hz)"] * 2 * np.pi == pytest.approx(frequency, rel=1e-6)
    assert next(iter(first["mechanism"])) == "chord"
    positions = [b["airspeed (KTAS)"] for b in boundaries["boundaries"]]
    assert positions == sorted(positions) and all(340 <= p <= 400 for p in positions)


def test_the_flutter_speed_stands_below_the_doubts():
    shown = run("flutter", "xv15-bell-frequencies", "--scan", "230:400:34kt").stdout
    assert "? Doubtful" in shown
    assert shown.splitlines()[-1].startswith("Flutter speed 244.1")


def test_options_that_are_tables_have_units():
    shown = " ".join(run("flutter", "xv15-bell-frequencies", "--scan", "230:260:10kt").stdout.split())
    assert "at 0.3491 and 0.8727 rad, at rotor speed 47.96 rad/s" in shown


def test_the_margin_is_that_of_the_airspeed_given(boundaries):
    at = boundaries["at"]
    assert at["airspeed (m/s)"] == pytest.approx(350 * KT)
    assert at["margin"] == pytest.approx(boundaries["flutter speed (KTAS)"] / 350 - 1)
    assert at["modes beyond the level"] == 0
    for speed, count in (("390 kt", 1), ("300 kt", None)):
        again = document("flutter", "xv15-uncoupled", "--scan", SCAN, "--speed", speed)["at"]
        assert again["modes beyond the level"] == count, speed
        assert again["margin"] == pytest.approx(
            boundaries["flutter speed (KTAS)"] * KT / again["airspeed (m/s)"] - 1
        )


def test_the_table_of_boundaries(boundaries, tmp_path):
    file = tmp_path / "boundaries.csv"
    result = run("flutter", "xv15-uncoupled", "--scan", SCAN, "--speed", "350 kt", "--csv", file)
    assert result.exit_code == 0
    speed = boundaries["flutter speed (KTAS)"]
    assert f"Flutter speed {speed:.2f} KTAS (chord, flutter)." in result.stdout
    assert f"Margin at 350 KTAS: {100 * (speed / 350 - 1):+.1f} % of that airspeed." in result.stdout
    assert "not read in a source" in " ".join(result.stdout.split())
    rows = list(csv.DictReader(without_comments(file)))
    assert [float(r["airspeed (KTAS)"]) for r in rows] == [
        b["airspeed (KTAS)"] for b in boundaries["boundaries"]
    ]
    assert rows[0]["mechanism"].startswith("chord ")


def test_flutter_in_another_unit_at_a_level_with_settings():
    lower = document(
        "flutter",
        "xv15-uncoupled",
        "--scan",
        "150:210:5 m/s",
        "--level",
        "0.5 %",
        "--set",
        "rotor.precone=2 deg",
    )
    assert lower["level (damping ratio)"] == 0.005
    assert lower["set"] == {"rotor.precone": "2 deg"}
    chord = next(b for b in lower["boundaries"] if b["mode"] == "chord")
    modes = pp.load_case("xv15-uncoupled", {"rotor.precone": "2 deg"}).sweep(
        chord["airspeed (m/s)"] * np.ones(1)
    )
    assert float(modes.damping_ratio.sel(mode="chord").values[0]) == pytest.approx(0.005, abs=1e-8)


def test_nothing_that_flutters_is_a_result_and_nothing_that_works_a_failure():
    stable = run("flutter", "xv15-uncoupled", "--scan", "200:260:20kt")
    assert stable.exit_code == 0
    assert "No mode becomes unstable between 200 and 260 KTAS." in stable.stdout
    found = document("flutter", "xv15-uncoupled", "--scan", "200:260:20kt")
    assert found["flutter speed (KTAS)"] is None
    least, mode, at = (
        found[name]
        for name in (
            "least damping (% of critical)",
            "mode of the least damping",
            "airspeed of the least damping (KTAS)",
        )
    )
    told = f"The least damping there is {least:.2g} % of critical: {mode} at {at:.4g} KTAS."
    assert told in " ".join(stable.stdout.split())
    damping = pp.load_case("xv15-uncoupled").sweep("200:260:20kt").damping_ratio
    assert least == pytest.approx(100 * float(damping.min()), rel=1e-9)
    failed = run("flutter", "xv15-uncoupled", "--scan", "0:0.1:0.1kt")
    assert failed.exit_code == 1
    assert "No airspeed could be analysed." in failed.stdout


# sensitivity --------------------------------------------------------------------------------------------------------


def test_the_flutter_speed_moves_as_told():
    found = document(
        "sensitivity", "xv15-uncoupled", "--scan", SCAN, "--wrt", "rotor.precone", "--wrt", CHORD
    )
    by_input = {record["input"]: record for record in found["sensitivities"]}
    speed = found["value (KTAS)"]
    precone, chord = by_input["rotor.precone"], by_input[CHORD]
    assert (precone["unit"], chord["unit"]) == ("deg", "/rev")
    for text, record, step in (("rotor.precone={} deg", precone, 0.01), (f"{CHORD}={{}}/rev", chord, 0.001)):
        at = float(record["value"].removesuffix("deg").removesuffix("/rev"))
        ends = [
            document("flutter", "xv15-uncoupled", "--scan", SCAN, "--set", text.format(at + side * step))[
                "flutter speed (KTAS)"
            ]
            for side in (-1, 1)
        ]
        slope = record["derivative (KTAS per unit)"]
        assert (ends[1] - ends[0]) / (2 * step) == pytest.approx(slope, rel=1e-4)
        assert record["for +1 % (KTAS)"] == pytest.approx(0.01 * at * slope, rel=1e-9)
    assert speed == pytest.approx(pp.load_case("xv15-uncoupled").flutter_point().speed / KT, rel=1e-9)


def test_the_damping_of_a_mode_moves_as_told(tmp_path):
    file = tmp_path / "damping.csv"
    arguments = ("sensitivity", "xv15-uncoupled", "--of", "damping", "--speed", "300 kt", "--mode", "chord")
    found = document(*arguments)
    result = run(*arguments, "--csv", file, "--top", 3)
    assert result.exit_code == 0
    assert f"Damping {found['value (% of critical)']:.4g} % of critical at 300 KTAS (chord)" in result.stdout
    assert "more inputs (--top 0)" in result.stdout
    changes = [abs(r["for +1 % (% of critical)"] or 0) for r in found["sensitivities"]]
    assert changes == sorted(changes, reverse=True) and len(changes) > 40
    rows = list(csv.DictReader(without_comments(file)))
    assert [row["input"] for row in rows] == [record["input"] for record in found["sensitivities"]]
    record = next(
        r for r in found["sensitivities"] if r["input"] == CHORD.replace("frequency", "damping_ratio")
    )
    assert record["unit"] == "%"
    ends = [
        100
        * float(
            pp.load_case("xv15-uncoupled", {record["input"]: f"{x} %"})
            .sweep("300 kt")
            .damping_ratio.sel(mode="chord")[0]
        )
        for x in (1.99, 2.01)
    ]
    assert (ends[1] - ends[0]) / 0.02 == pytest.approx(
        record["derivative (% of critical per unit)"], rel=1e-4
    )


def test_without_a_mode_the_least_damped_is_told():
    found = document(
        "sensitivity", "xv15-uncoupled", "--of", "damping", "--speed", "300 kt", "--wrt", "rotor.precone"
    )
    modes = pp.load_case("xv15-uncoupled").sweep("300 kt")
    assert found["mode"] == str(modes.mode.values[np.nanargmin(modes.damping_ratio.values[0])])


# attribution --------------------------------------------------------------------------------------------------------


def test_attribution_sums_to_nothing_and_is_sorted(tmp_path):
    file = tmp_path / "chord.csv"
    arguments = ("attribution", "xv15-uncoupled", "--speed", "390 kt")
    found = document(*arguments, "--mode", "chord")
    assert document(*arguments)["mode"] == "chord"  # the only one that is unstable there
    for column in ("growth (1/s)", "frequency (rad/s)", "damping (% of critical)"):
        values = [origin[column] for origin in found["origins"]]
        assert abs(sum(values)) < 1e-8 * max(map(abs, values))
    sizes = [abs(origin["growth (1/s)"]) for origin in found["origins"]]
    assert sizes == sorted(sizes, reverse=True)
    assert found["damping (% of critical)"] < 0 < found["Re s (rad/s)"]
    result = run(*arguments, "--csv", file)
    assert result.exit_code == 0
    assert "chord at 390 KTAS" in result.stdout and "drives" in result.stdout and "damps" in result.stdout
    rows = list(csv.DictReader(without_comments(file)))
    assert [r["origin"] for r in rows] == [origin["origin"] for origin in found["origins"]]


def test_damping_of_an_origin_is_what_growing_it_does():
    """The support's damping is an origin that can be grown by itself."""
    found = document("attribution", "xv15-uncoupled", "--speed", "380 kt", "--mode", "chord")
    told = next(o for o in found["origins"] if o["origin"] == "support damping")["damping (% of critical)"]
    names = ("beam", "chord", "torsion")
    deck = {"beam": 1, "chord": 2, "torsion": 1}
    ends = []
    for share in (0.99, 1.01):
        values = {f"support.modes[{name}].damping_ratio": f"{deck[name] * share} %" for name in names}
        modes = pp.load_case("xv15-uncoupled", values).sweep("380 kt")
        ends.append(100 * float(modes.damping_ratio.sel(mode="chord")[0]))
    assert (ends[1] - ends[0]) / 0.02 == pytest.approx(told, rel=1e-3)


# map ----------------------------------------------------------------------------------------------------------------

MAP = ("map", "xv15-uncoupled", "--x", "airspeed=360:390:10kt", "--y", "rotor.precone=2:3:0.5 deg")


def test_a_map_says_where_it_is_stable(tmp_path):
    file = tmp_path / "map.csv"
    found = document(*MAP)
    assert (found["x"], found["y"]) == ("airspeed (KTAS)", "rotor.precone (deg)")
    assert [p["airspeed (KTAS)"] for p in found["points"][:4]] == [360, 370, 380, 390]
    for point in found["points"]:
        modes = pp.load_case(
            "xv15-uncoupled", {"rotor.precone": f"{point['rotor.precone (deg)']} deg"}
        ).sweep(f"{point['airspeed (KTAS)']} kt")
        largest = np.nanmax(modes.eigenvalue.values.real)
        assert point["largest growth (1/s)"] == pytest.approx(largest, rel=1e-6, abs=1e-8)
    for line in found["boundary"]:
        for speed, precone in line[:2]:
            case = pp.load_case("xv15-uncoupled", {"rotor.precone": f"{precone!r} deg"})
            assert abs(np.nanmax(case.sweep(f"{speed!r} kt").eigenvalue.values.real)) < 1e-6
    result = run(*MAP, "--csv", file)
    assert result.exit_code == 0
    rows = list(csv.DictReader(without_comments(file)))
    assert [float(r["largest growth (1/s)"]) for r in rows] == [
        p["largest growth (1/s)"] for p in found["points"]
    ]
    drawn = {"3": "", "2.5": "", "2": ""}
    for line in result.stdout.splitlines():
        words = line.split()
        if len(words) == 2 and words[0] in drawn and set(words[1]) <= set(".#?"):
            drawn[words[0]] = words[1]
    for precone, marks in drawn.items():
        points = [p for p in found["points"] if p["rotor.precone (deg)"] == float(precone)]
        assert marks == "".join("#" if p["largest growth (1/s)"] > 0 else "." for p in points)


@pytest.mark.parametrize(
    "arguments",
    [
        (*MAP,),
        ("sensitivity", "xv15-uncoupled", "--scan", SCAN, "--top", 8),
        ("attribution", "xv15-uncoupled", "--speed", "380 kt"),
    ],
)
def test_figures_are_written_and_not_blank(tmp_path, arguments):
    from matplotlib.image import imread

    file = tmp_path / "figure.png"
    result = run(*arguments, "--plot", file)
    assert result.exit_code == 0, result.stderr
    image = imread(file)[::3, ::3, :3]
    colours = np.round(image * 255) @ [65536, 256, 1]
    assert len(np.unique(colours)) > 50
    assert 0.005 < np.mean(image.min(axis=-1) < 0.9) < 0.9


# Inputs that cannot be used -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("flutter", "xv16"), "did you mean xv15?"),
        (("flutter", "xv15-uncoupled", "--scan", "300"), "--scan = 300: needs a unit"),
        (
            ("flutter", "xv15-uncoupled", "--speed", "300:400:10kt"),
            "--speed = 300:400:10kt: must be one speed",
        ),
        (("flutter", "xv15-uncoupled", "--speed", "0 kt"), "--speed = 0 kt: must be above zero"),
        (
            ("flutter", "xv15-uncoupled", "--level", "3"),
            '--level = 3: must lie between -1 and 1; write three percent as "3 %"',
        ),
        (("flutter", "xv15-uncoupled", "--level", "3 ft"), "--level = 3 ft: must be a plain number"),
        (("flutter", "xv15-uncoupled", "--csv", "/"), "--csv = /: must be a file"),
        (("sensitivity", "xv15-uncoupled", "--wrt", "rotor.precon"), "did you mean rotor.precone?"),
        (("sensitivity", "xv15-uncoupled", "--of", "damping"), "--speed: must be given"),
        (("sensitivity", "xv15-uncoupled", "--speed", "300 kt"), "--speed = 300 kt: goes with --of damping"),
        (
            ("sensitivity", "xv15-uncoupled", "--of", "damping", "--speed", "300 kt", "--scan", SCAN),
            "--scan = 340:400:10kt",
        ),
        (("sensitivity", "xv15-uncoupled", "--scan", "200:260:20kt"), "nothing becomes unstable"),
        (("sensitivity", "xv15-uncoupled", "--plot", "tornado.gif"), ".png, .pdf, .svg"),
        (("attribution", "xv15-uncoupled", "--speed", "300 kt", "--mode", "cord"), "did you mean chord?"),
        (("attribution", "xv15-uncoupled", "--speed", "0 kt"), "airspeed"),
        (("attribution", "xv15-uncoupled"), "--speed"),
        (
            ("map", "xv15-uncoupled", "--x", "airspeed=1:2:1kt", "--y", "rotor.precon=1:2:1 deg"),
            "did you mean rotor.precone?",
        ),
        (
            ("map", "xv15-uncoupled", "--x", "airspeed=1:2:1kt", "--y", "rotor.precone=1:2:1 kg"),
            "must be an angle",
        ),
        (
            ("map", "xv15-uncoupled", "--x", "airspeed=1:2:1kt", "--y", "rotor.precone=1 deg"),
            "must be a range",
        ),
        (
            ("map", "xv15-uncoupled", "--x", "airspeed=1:2:1kt", "--y", "rotor.precone"),
            "must be an input and its values",
        ),
        (
            ("map", "xv15-uncoupled", "--x", "airspeed=1:2:1kt", "--y", "airspeed=1:2:1kt"),
            "must not be the input of --x",
        ),
        (
            ("map", "xv15-uncoupled", "--x", "rotor.precone=1:2:1 deg", "--y", f"{CHORD}=5:6:1 Hz"),
            "--speed: must be given",
        ),
        ((*MAP, "--speed", "300 kt"), "is one of the axes already"),
        (
            ("boundary", "xv15-uncoupled", "--against", "altitude=0:9:3 m/s"),
            "operation.altitude = 0 m/s: must be a length",
        ),
        (
            ("boundary", "xv15-uncoupled", "--against", "rotor_speed=400:500:20"),
            "operation.rotor_speed = 400: needs a unit",
        ),
        (
            ("boundary", "xv15-uncoupled", "--against", "rotor_speed=400:500:20 rpm", "--scan", "300kt"),
            "--scan = 300kt: must be a range",
        ),
        (("cases", "--set", "rotor.precone=1 deg"), "needs a case"),
        (
            ("study", "xv15-uncoupled", "--vary", "rotor.precone=1 deg", "--speed", "9 kt", "--set", "x=1"),
            "unknown field",
        ),
    ],
)
def test_an_unusable_input_is_told_without_a_traceback(arguments, told):
    result = run(*arguments)
    assert result.exit_code == 2
    assert told in result.stderr
    assert result.stdout == ""


# The others ---------------------------------------------------------------------------------------------------------


def test_cases_as_json():
    listed = json.loads(run("cases", "--json").stdout)
    assert [entry["name"] for entry in listed] == list(pp.list_cases())
    found = json.loads(run("cases", "xv15-uncoupled", "--set", "rotor.precone=1 deg", "--json").stdout)
    precone = found["inputs"]["rotor.precone"]
    assert (precone["written"], precone["unit"], precone["status"]) == ("1 deg", "rad", "assumed")
    assert precone["si"] == pytest.approx(math.radians(1))
    assert len(found["inputs"]["rotor.twist"]["si"]) == len(found["inputs"]["rotor.twist"]["r_over_R"])


def test_sweep_takes_settings():
    found = document("sweep", "xv15-uncoupled", "--speed", "300 kt", "--set", "rotor.precone=1 deg")
    modes = pp.load_case("xv15-uncoupled").vary({"rotor.precone": math.radians(1)}).sweep("300 kt")
    told = {p["mode"]: p["damping (% of critical)"] for p in found["points"]}
    for mode in modes.mode.values.tolist():
        assert told[mode] == pytest.approx(
            100 * float(modes.damping_ratio.sel(mode=mode)[0]), rel=1e-9, abs=1e-9
        )
    assert "(rotor.precone = 1 deg)" in found["title"]
    assert (
        "(rotor.precone = 1 deg)"
        in run(
            "sweep", "xv15-uncoupled", "--speed", "300 kt", "--set", "rotor.precone=1 deg"
        ).stdout.splitlines()[0]
    )


def test_a_study_as_json(tmp_path):
    arguments = (
        "study",
        "xv15-uncoupled",
        "--vary",
        "rotor.precone=1 deg, 2 deg",
        "--speed",
        "200 kt",
        "--workers",
        1,
    )
    found = document(*arguments, "--set", "rotor.control_stiffness=9000 ft*lbf/rad")
    assert (found["points"], found["failed"]) == (2, 0)
    lowest = [
        float(
            pp.load_case("xv15-uncoupled", {"rotor.control_stiffness": "9000 ft*lbf/rad", "rotor.precone": f"{x} deg"})
            .sweep("200 kt").damping_ratio.min()
        )
        for x in (1, 2)
    ]  # fmt: skip
    assert found["lowest damping (% of critical)"] == pytest.approx(100 * min(lowest), rel=1e-6)


# The worst of a box, and shares of the variance ----------------------------------------------------------------------

BOX = ("--worst-of", "rotor.precone=2:3 deg", "--worst-of", "rotor.control_stiffness=0.9:1.1 of deck")


def test_the_worst_of_a_box_is_told_as_table_json_and_csv(tmp_path):
    case, scan = "xv15-uncoupled", ("--scan", "300:420:10kt")
    table = run("boundary", case, *BOX, *scan, "--csv", tmp_path / "a.csv")
    document = json.loads(run("boundary", case, *BOX, *scan, "--json").stdout)
    limits = {"rotor.precone": ("2 deg", "3 deg"), "rotor.control_stiffness": pp.sampling.Relative(0.9, 1.1)}
    found = pp.robust_boundary(pp.load_case(case), limits, "300:420:10kt", workers=1)
    assert f"Worst flutter speed found: {float(found.speed) / KT:.2f} KTAS" in table.stdout
    assert "a search is no proof" in table.stdout and f"{found.attrs['evaluated']} designs" in table.stdout
    assert document["worst flutter speed (m/s)"] == pytest.approx(float(found.speed), abs=1e-9)
    assert document["evaluated"] == found.attrs["evaluated"] and document["mode"] == found["mode"]
    rows = list(csv.DictReader(without_comments(tmp_path / "a.csv")))
    for row, name in zip(rows, limits, strict=True):
        one = found.sel(input=name)
        assert row["input"] == name and row["side"] == one.side
        assert float(row["worst"]) == pytest.approx(float(one.value / one.deck_unit_in_si), rel=1e-9)
    assert [row["unit"] for row in rows] == ["deg", "ft*lbf/rad"]
    assert float(rows[0]["low"]) == pytest.approx(2) and float(rows[0]["high"]) == pytest.approx(3)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ((*BOX, "--first"), "--first: goes without --worst-of"),
        ((*BOX, "--against", "rotor.precone=1:2:1 deg"), "--against: goes without --worst-of"),
        ((*BOX, *BOX[:2]), "must not give an input twice"),
        (("--worst-of", "rotor.precone=2 deg"), "must have two limits"),
        (("--worst-of", "rotor.precone"), "must be an input and two limits"),
        (("--worst-of", "rotor.precone=a:b of deck"), "must have two factors"),
        ((), "--against: must be given"),
    ],
)
def test_what_is_no_box_is_refused_in_one_line(given, told):
    done = run("boundary", "xv15-uncoupled", *given)
    assert done.exit_code == 2 and told in done.stderr and not done.stdout


SALTELLI = ("--vary", "rotor.precone=2:3 deg", "--vary", "rotor.control_stiffness=0.9:1.1 of deck")


def test_shares_of_the_variance_of_a_saltelli_sample_have_their_intervals():
    sample = (*SALTELLI, "--sample", "saltelli", "--size", "4", "--flutter", "--workers", "1")
    asked = ("study", "xv15-uncoupled", *sample, "--speed", "300:440:20kt")
    document = json.loads(run(*asked, "--json").stdout)
    shares = document["shares of the variance"]
    inputs = {"rotor.precone": ("2 deg", "3 deg"), "rotor.control_stiffness": pp.sampling.Relative(0.9, 1.1)}
    plan = pp.sampling.saltelli(inputs, 4)
    found = pp.sobol_indices(
        pp.study(pp.load_case("xv15-uncoupled"), plan, "300:440:20kt", "flutter", workers=1)
    )
    for record in shares:
        own = found.sel(input=record["input"])
        assert record["with interactions (%)"] == pytest.approx(100 * float(own.total), rel=1e-9)
        assert record["alone ± (%)"] == pytest.approx(100 * float(own.first_half_interval), rel=1e-9)
    table = run(*asked).stdout
    assert "± is half of an interval of 95 % confidence" in table
    for record in shares:
        assert f"{record['with interactions ± (%)']:.1f}" in table
    stable = run("study", "xv15-uncoupled", *sample, "--speed", "100:140:20kt").stdout
    assert "shares of the variance" not in stable.lower() or "No shares of the variance" in stable


def test_an_interrupted_study_says_that_its_checkpoint_goes_on(tmp_path, monkeypatch):
    def stops(*_):
        raise KeyboardInterrupt

    asked = ("study", "xv15-uncoupled", "--vary", "rotor.precone=1 deg, 2 deg", "--speed", "300 kt")
    with monkeypatch.context() as patch:
        patch.setattr(Analysis, "__call__", stops)
        alone, kept = run(*asked), run(*asked, "--checkpoint", tmp_path / "batches")
    assert alone.exit_code == kept.exit_code == 130
    assert alone.stderr.strip() == "interrupted; no file was left half-written"
    assert "batches keeps all finished batches, and the same command goes on" in kept.stderr
    assert run(*asked, "--checkpoint", tmp_path / "batches").exit_code == 0
