"""The figures of AIAA-2002-1604: the command, the files, the bands, and what the figures must show relatively."""

import csv
from dataclasses import replace
from functools import partial
from io import BytesIO

import matplotlib.image
import numpy as np
import pytest
from click.testing import CliRunner

import proprotor as pp
from benchmarks import claims, pictures
from benchmarks.paper_figures import NUMBERS, Analyses, command, csv_of, make_figure
from benchmarks.paper_figures.analyses import XV15, own_frequencies
from benchmarks.paper_figures.content import Mark
from benchmarks.paper_figures.drawing import draw, intervals
from benchmarks.paper_figures.input_ranges import RANGES
from benchmarks.paper_figures.sample_band import damping_band, sample
from benchmarks.paper_figures.wing_modes import WingModes
from proprotor.plots import small_print
from proprotor.plots.style import UNKNOWN
from tests.readable import check_lines_differ, check_texts

KNOT = 1852 / 3600
ALL = (4, 5, 6, 7, 8, 9, 10, 11, 12, 14, 15, 16, 17, 18, 21, 22, 23, 24)


@pytest.fixture(scope="module")
def analyses():
    """Without samples, every 5 kt: as fine as the figures themselves."""
    return Analyses(samples=0)


@pytest.fixture(scope="module")
def coarse():
    return Analyses(step=10, samples=6)


def run(*arguments):
    return CliRunner().invoke(command.figures, [str(argument) for argument in arguments])


def rows_of(text):
    lines = [line for line in text.splitlines() if not line.startswith("# ")]
    head, *rows = csv.reader(lines)
    return head, [[float(cell) if cell else np.nan for cell in row] for row in rows]


# The command --------------------------------------------------------------------------------------


def test_the_command_writes_a_picture_and_its_numbers(tmp_path):
    out = tmp_path / "new" / "folder"
    result = run(21, 9, 21, "--out", out, "--samples", 4, "--step", 20)
    assert result.exit_code == 0, result.output
    names = sorted(path.name for path in out.iterdir())
    assert names == ["figure-09.csv", "figure-09.png", "figure-21.csv", "figure-21.png"]
    for name in ("figure-09.png", "figure-21.png"):
        image = matplotlib.image.imread(out / name)
        assert image.shape[0] > 500 and image[..., :3].std() > 0.05
    head, rows = rows_of((out / "figure-09.csv").read_text())
    assert head[0] == "airspeed (kt)" and all(name.endswith("(% of critical)") for name in head[1:])
    assert [row[0] for row in rows] == [60, 80, 100, 120, 140, 160, 180]
    assert np.isfinite(rows).all()


@pytest.mark.parametrize("number", [3, 13, 19, 25, -4, 0])
def test_a_figure_that_is_not_there_is_refused_with_the_list(tmp_path, number):
    result = run("--out", tmp_path / "out", "--", number)
    assert result.exit_code == 2 and "Traceback" not in result.output
    assert ", ".join(map(str, ALL)) in result.output
    assert not (tmp_path / "out").exists()


def test_an_output_that_is_a_file_is_refused(tmp_path):
    file = tmp_path / "figures"
    file.write_text("mine")
    result = run(21, "--out", file)
    assert result.exit_code == 2 and "must be a folder" in result.output
    assert run(21, "--out", file / "below").exit_code == 1
    assert file.read_text() == "mine"


def test_a_figure_is_written_whole_or_not_at_all(tmp_path, monkeypatch):
    (tmp_path / "figure-21.png").write_text("before")

    def fail(content, file):
        file.write(b"half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(command, "save", fail)
    result = run(21, "--out", tmp_path, "--step", 20)
    assert result.exit_code == 1 and "No space left on device" in result.output
    assert [path.name for path in tmp_path.iterdir()] == ["figure-21.png"]
    assert (tmp_path / "figure-21.png").read_text() == "before"


def test_an_interruption_is_one_message_and_leaves_no_half_written_file(tmp_path, monkeypatch):
    def interrupted(number, analyses):
        raise KeyboardInterrupt

    monkeypatch.setattr(command, "make_figure", interrupted)
    result = run(21, "--out", tmp_path)
    assert result.exit_code == 130 and "no file was left half-written" in result.stderr
    assert not list(tmp_path.iterdir())


def test_the_help_names_every_option_and_an_example():
    result = run("--help")
    assert result.exit_code == 0
    for text in (
        "--out",
        "--samples",
        "--step",
        "--seed",
        "python -m benchmarks.paper_figures --out figures/",
    ):
        assert text in result.output


# Contents -----------------------------------------------------------------------------------------


def test_every_analytical_figure_is_known():
    assert NUMBERS == ALL
    with pytest.raises(pp.InputError, match="they are 4, 5"):
        make_figure(20, Analyses())


@pytest.mark.parametrize("number", ALL)
def test_each_figure_has_labelled_curves_with_units_and_says_what_it_rests_on(coarse, number):
    content = make_figure(number, coarse)
    names = [curve.name for curve in content.curves]
    assert len(set(names)) == len(names) >= 2
    assert all(curve.label for curve in content.curves)
    shown = content.curves[0].values[content.curves[0].airspeed <= content.x_limits[1]]
    assert np.isfinite(shown).all()
    assert np.mean((shown >= content.y_limits[0]) & (shown <= content.y_limits[1])) > 0.5
    assert content.assumed and any("Rests on inputs" in note for note in content.notes)
    assert (content.band is not None) == (number <= 12)
    if content.title.startswith("XV-15") and number not in (14, 18):
        assert min(content.marks[0].airspeeds) == 285 and max(content.marks[0].airspeeds) == 305
    head, rows = rows_of(csv_of(content).decode())
    assert head[0] == "airspeed (kt)" and all(name.endswith(f"({content.unit})") for name in head[1:])
    np.testing.assert_allclose(np.array(rows)[:, 1], content.curves[0].values, rtol=1e-6)


def test_the_picture_shows_what_the_content_has(coarse):
    content = make_figure(9, coarse)
    ax = draw(content).axes[0]
    np.testing.assert_array_equal(ax.lines[1].get_ydata(), content.curves[0].values)  # after the zero line
    assert ax.get_xlabel() == "Airspeed, KTAS" and ax.get_ylabel() == "Modal damping (% of critical)"
    told = " ".join(text.get_text() for text in (*ax.texts, *ax.figure.texts))
    assert "rests on assumed inputs" in told and "no prediction" in told
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert len(labels) == len(content.curves) + 1


def test_a_figure_is_readable(coarse):
    for number in (5, 8, 15, 21):
        figure = draw(make_figure(number, coarse))
        check_texts(figure)
        check_lines_differ(figure)
        told = small_print.read(figure.axes[0])
        assert "Case " in told and "options: pitch coupling, section damping no" in told


def test_a_circle_marks_where_the_damping_falls_through_zero(coarse):
    """As the curve of each variant has it, by interpolation; no circle where a curve stays above zero."""
    content = make_figure(5, coarse)
    ax = draw(content).axes[0]
    (circles,) = (line for line in ax.lines if line.get_marker() == "o")
    expected = []
    for curve in content.curves:
        after = int(np.argmax(curve.values < 0))
        steps = curve.values[[after, after - 1]], curve.airspeed[[after, after - 1]]
        expected.append(np.interp(0, *steps))
    np.testing.assert_allclose(circles.get_xdata(), expected, atol=0.7)
    assert not np.any(circles.get_ydata())
    stable = draw(make_figure(9, coarse)).axes[0]
    assert not [line for line in stable.lines if line.get_marker() == "o"]


def test_an_airspeed_that_failed_is_hatched(coarse):
    content = make_figure(9, coarse)
    values = content.curves[0].values.copy()
    values[3:6] = np.nan
    curves = (replace(content.curves[0], values=values), *content.curves[1:])
    ax = draw(replace(content, curves=curves)).axes[0]
    (stretch,) = (patch for patch in ax.patches if patch.get_hatch() == UNKNOWN["hatch"])
    knots = content.curves[0].airspeed
    assert stretch.get_x() == pytest.approx((knots[2] + knots[3]) / 2)
    assert stretch.get_x() + stretch.get_width() == pytest.approx((knots[5] + knots[6]) / 2)
    assert "could not be analysed" in ax.get_xlabel()


# What the figures must show: relative statements of the paper; sizes by test_xv15's tables --------


def test_couplings_lower_every_boundary_of_the_xv15(analyses):
    """Figs. 22 to 24: by more than 100 kt together, by much less for K_Pβ alone."""
    base = claims.mode_boundaries(analyses, "couplings")
    neither = claims.mode_boundaries(analyses, "no couplings")
    flap = claims.mode_boundaries(analyses, "no pitch-flap coupling")
    assert 100 < neither["chord"] - base["chord"] < 130
    assert np.isinf(neither["beam"]) and np.isinf(neither["torsion"])
    assert 5 < flap["chord"] - base["chord"] < 40


def test_couplings_are_nearer_to_pitch_equations_than_neither_is(analyses):
    for mode in ("beam", "chord", "torsion"):
        base, dynamic, neither = (
            analyses.wing(XV15, variant).damping(mode)[analyses.knots(XV15) <= 350]
            for variant in ("couplings", "pitch equations", "no couplings")
        )
        assert np.abs(base - dynamic).max() < np.abs(neither - dynamic).max(), mode


def test_flap_lag_stiffness_moves_boundaries_by_tens_of_knots(analyses):
    """Figs. 15 to 17, upwards in all three modes; and the peak of beam damping to a higher speed."""
    base = claims.mode_boundaries(analyses, "couplings")
    without = claims.mode_boundaries(analyses, "no flap-lag stiffness")
    for mode in base:
        assert 5 < without[mode] - base[mode] < 40
    below = analyses.knots(XV15) < 400
    peaks = [
        analyses.knots(XV15)[below][analyses.wing(XV15, variant).damping("beam")[below].argmax()]
        for variant in ("couplings", "no flap-lag stiffness")
    ]
    assert peaks[1] > peaks[0] + 25


def test_given_frequencies_of_this_model_come_nearer_than_dropping_the_stiffness(analyses):
    change = {v: claims.chord_change(analyses, v) for v in ("own frequencies given", "no flap-lag stiffness")}
    assert 2 < abs(change["own frequencies given"]) < abs(change["no flap-lag stiffness"])
    assert own_frequencies(analyses.case(XV15), analyses.airspeeds(XV15)).lag[0] > 1.8


def test_the_low_lag_mode_falls_and_follows_what_is_given(analyses):
    """Fig. 14."""
    content = make_figure(14, analyses)
    curves = {curve.name: curve for curve in content.curves}
    knots, coupled = curves["coupled flap and lag"].airspeed, curves["coupled flap and lag"].values
    assert (np.diff(coupled) < 0).all()
    assert coupled[knots == 100] > 0.7 and coupled[knots == 400] < 0.25
    given = curves["given frequencies"].values[(knots >= 100) & (knots <= 400)]
    assert np.abs(given - coupled[(knots >= 100) & (knots <= 400)]).max() < 0.15


def test_one_flap_spring_and_one_gimbal_spring_give_two_frequencies(analyses):
    """Fig. 18: coning well above the gimbal mode, whose frequency follows from the hub spring alone at zero cone."""
    curves = {curve.name: curve.values for curve in make_figure(18, analyses).curves}
    assert (curves["coning"] > 1.5).all() and (curves["coning"] < 2.0).all()
    rotor, operation = pp.load_case("xv15-uncoupled").rotor, pp.load_case("xv15-uncoupled").operation
    nu = np.sqrt(1 + rotor.gimbal_stiffness / (1.5 * rotor.blade_inertia * operation.rotor_speed**2))
    np.testing.assert_allclose(curves["cyclic (gimbal), in a vacuum"], nu, atol=0.003)


def test_couplings_against_speed_have_the_signs_of_the_paper(analyses):
    """Fig. 21: K_Pζ falls through zero to about -0.3 where the wing becomes unstable, K_Pβ of the same size there."""
    content = make_figure(21, analyses)
    lag, flap = (curve.values for curve in content.curves[:2])
    knots = content.curves[0].airspeed
    assert lag[0] > 0 > lag[-1] and (np.diff(lag) < 0).all() and (flap < 0).all()
    speed = content.points[0][0]
    assert np.interp(speed, knots, lag) == pytest.approx(-0.3, abs=0.03)
    assert 0.5 < np.interp(speed, knots, flap) / np.interp(speed, knots, lag) < 2


def test_no_verdict_of_the_claims_is_unknown_and_every_group_has_one(analyses):
    found = claims.all_claims(analyses)
    assert {claim.verdict for claim in found} <= set(claims.VERDICTS)
    assert len(found) >= 25 and all(claim.here and "inf" not in claim.here for claim in found)
    boundary_claim = next(claim for claim in found if claim.place == "Figs. 4-6")
    assert boundary_claim.verdict != claims.REPRODUCED


# Following modes, and bands -----------------------------------------------------------------------


COUPLING = {"pitch": "coupling"}


def test_wing_modes_stay_near_the_frequencies_of_the_wing_and_do_not_jump():
    case = pp.load_case("xv15-uncoupled")
    wing = WingModes(case, np.arange(60, 301, 5) * KNOT, COUPLING)
    assert wing.names == ("beam", "chord", "torsion")
    for name in wing.names:
        alone = case.sources[f"support.modes[{name}].frequency"].si
        frequency = wing.sweep.frequency.sel(mode=name).values
        assert np.abs(frequency / alone - 1).max() < 0.15, name
        assert np.abs(np.diff(wing.damping(name))).max() < 1, name


@pytest.mark.parametrize("deck", ["v22-fifth-scale", "wrats-888-off"])
def test_wing_modes_have_the_damping_of_the_sweep_of_the_case(deck):
    case, airspeeds = pp.load_case(deck), np.arange(80, 181, 5) * KNOT
    modes, wing = case.sweep(airspeeds, **COUPLING), WingModes(case, airspeeds, COUPLING)
    for name in wing.names:
        ratio = modes.damping_ratio.sel(mode=name).values
        np.testing.assert_allclose(wing.damping(name), 100 * ratio, rtol=1e-8)


def test_beyond_its_boundary_a_wing_mode_is_the_root_that_became_unstable():
    """What moves torsion most beyond 420 kt is another root, well damped."""
    airspeeds = np.arange(50, 501, 5) * KNOT
    wing = WingModes(pp.load_case("xv15-uncoupled"), airspeeds, COUPLING | {"section_damping": False})
    damping = wing.damping("torsion")
    assert (damping[airspeeds / KNOT > wing.speed("torsion")] < 0).all()
    assert 100 * wing.sweep.damping_ratio.sel(mode="torsion").values[damping < 0].max() > 5


def test_a_failed_airspeed_is_passed_over():
    wing = WingModes(pp.load_case("xv15-uncoupled"), np.array([100, 200, 300, 400, 600]) * KNOT, COUPLING)
    for name in wing.names:
        assert np.isfinite(wing.damping(name)[:4]).all() and np.isnan(wing.damping(name)[4])


def test_a_wing_mode_becomes_unstable_where_its_damping_falls_through_zero(analyses):
    """Between the points of the figure by interpolation, within a tenth of their distance."""
    for variant in ("couplings", "no flap-lag stiffness", "given frequencies"):
        wing, knots = analyses.wing(XV15, variant), analyses.knots(XV15)
        for name in wing.names:
            damping = wing.damping(name)
            if np.isinf(wing.speed(name)):
                assert (damping > 0).all()
                continue
            after = int(np.argmax(damping < 0))
            crossed = np.interp(0, damping[[after, after - 1]], knots[[after, after - 1]])
            assert wing.speed(name) == pytest.approx(crossed, abs=0.5)
        assert wing.first_speed == min(wing.speed(name) for name in wing.names)


def test_options_that_depend_on_airspeed_are_those_of_each_airspeed():
    case, airspeeds = pp.load_case("xv15-uncoupled"), np.arange(200, 301, 25) * KNOT
    coupling = np.linspace(-0.4, -0.2, len(airspeeds))
    given = {"pitch_flap_coupling": lambda speed: np.interp(speed.real, airspeeds, coupling)}
    wing = WingModes(case, airspeeds, COUPLING | given)
    for place in (0, 3):
        alone = case.sweep(airspeeds[[place]], pitch_flap_coupling=coupling[place], **COUPLING)
        ratio = alone.damping_ratio.sel(mode="beam").item()
        assert wing.damping("beam")[place] == pytest.approx(100 * ratio, rel=1e-9)


@pytest.mark.parametrize("deck", RANGES)
def test_ranges_name_numbers_of_the_deck_that_are_doubtful_and_contain_them(deck):
    case = pp.load_case(deck)
    inputs = pp.design_inputs(case)
    doubtful = {
        path for path, number in case.given.items() if number.status in ("assumed", "calibrated", "recalled")
    }
    ranged = {path for one in RANGES[deck] for path in one.paths}
    assert ranged <= set(inputs)
    assert not [path for path in ranged if inputs[path].status == "published"]
    left_out = (doubtful - ranged) & set(inputs)  # distributions and words have no range
    assert left_out <= {
        "rotor.root_cutout",
        "rotor.precone",
    }  # no airload there; a derived deck may publish it
    for one in RANGES[deck]:
        assert one.reason and one.low < one.high
        if one.unit == "×":
            assert one.low <= 1 <= one.high


def test_a_sample_is_stratified_stays_within_its_ranges_and_ties_paths():
    case = pp.load_case("xv15-uncoupled")
    values = sample(RANGES["xv15-uncoupled"], 20).resolve(pp.design_inputs(case)).values
    stiffness = values["rotor.control_stiffness"] / (4.4482216152605 * 0.3048)
    strata = np.floor(20 * np.log(stiffness / 5000) / np.log(22400 / 5000) + 1e-9)
    assert sorted(strata) == list(range(20))
    assert (values["rotor.airfoil.zero_lift_angle"] <= 0).all()
    assert values["rotor.airfoil.zero_lift_angle"].min() >= np.radians(-2)
    mast = values["support.modes[torsion].x"] / case.given["support.modes[torsion].x"].si
    slope = values["support.modes[beam].alpha_z"] / case.given["support.modes[beam].alpha_z"].si
    swing = values["support.modes[chord].y"] / case.given["support.modes[chord].y"].si
    np.testing.assert_allclose(swing, mast * slope, rtol=1e-12)


def test_a_band_holds_what_one_design_at_a_time_gives():
    """Where the first onset is that of a mode of the rotor, the band has that of the wing."""
    case, airspeeds = pp.load_case("xv15-uncoupled"), np.arange(250, 451, 10) * KNOT
    options = {"pitch": "dynamic", "section_damping": False}
    band = damping_band(case, airspeeds, RANGES["xv15-uncoupled"], 5, seed=3, **options)
    plan = sample(RANGES["xv15-uncoupled"], 5, seed=3)
    designs = plan.resolve(pp.design_inputs(case)).values
    for design in range(5):
        one = case.vary({path: values[design] for path, values in designs.items()})
        wing = WingModes(one, airspeeds, options)
        for name in wing.names:
            np.testing.assert_allclose(band.damping(name)[design], wing.damping(name), rtol=1e-6, atol=1e-7)
        speed = band.results.flutter_speed.values[design] / KNOT
        assert np.nan_to_num(speed, nan=np.inf) == pytest.approx(wing.first_speed, abs=1e-4)
    of_any_mode = pp.study(case, plan, airspeeds, "flutter", **options).flutter_coordinate.values
    assert not set(of_any_mode.tolist()) <= {*wing.names, ""}
    low, median, high = band.percentiles("beam")
    assert (low <= median).all() and (median <= high).all()
    first, middle, last = band.speed_percentiles
    assert first <= middle <= last
    assert band.share_below(first) <= 0.05 <= band.share_below(last)


def test_the_sample_is_the_same_for_the_same_seed():
    case, airspeeds = pp.load_case("wrats-742-off"), np.array([80, 120]) * KNOT
    one, same, other = (
        damping_band(case, airspeeds, RANGES[case.name], 4, seed, **COUPLING).damping("beam")
        for seed in (1, 1, 2)
    )
    np.testing.assert_array_equal(one, same)
    assert np.abs(one - other).max() > 1e-6


def test_intervals_are_as_wide_as_their_percentiles():
    """Two rows side by side, the second of which spans twice as much."""
    rows = [("narrow", 370.0, 360.0, 372.0, 380.0), ("wide", 370.0, 350.0, 372.0, 390.0)]
    first, again = BytesIO(), BytesIO()
    for file in (first, again):
        mark = Mark((365.0, 375.0), "published")
        pictures.save(partial(intervals, rows, mark, "Boundary, KTAS"), file)
    assert first.getvalue() == again.getvalue()
    pixels = matplotlib.image.imread(BytesIO(first.getvalue()))[..., :3]
    blue = (pixels[..., 2] > pixels[..., 0] + 0.2) & (pixels[..., 2] > 0.85)
    rows_of_pixels = [np.flatnonzero(row) for row in blue if row.sum() > 100]
    narrow, wide = rows_of_pixels[0], rows_of_pixels[-1]
    assert np.ptp(wide) / np.ptp(narrow) == pytest.approx(2, rel=0.01)
    assert wide.min() + wide.max() == pytest.approx(narrow.min() + narrow.max(), abs=4)  # both about 370
