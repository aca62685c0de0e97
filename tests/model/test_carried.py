"""Case, options and doubts go with every result: into records, datasets, files, tables and pictures, and out again."""

import inspect
import json
import pickle
import re
from dataclasses import fields
from functools import cache

import numpy as np
import pytest
import xarray
from bokeh.document import Document
from click.testing import CliRunner
from scipy.io import loadmat

import proprotor as pp
from proprotor import plots, sampling
from proprotor.case import Case
from proprotor.commands.main import main
from proprotor.compiled.library import why_not
from proprotor.exchange.matlab import matlab_names
from proprotor.explore.analysis import live_modes
from proprotor.explore.page import ExplorePage
from proprotor.explore.words import messages, readout
from proprotor.model import options_in_force, options_of_result, stamp
from proprotor.model.deck_fingerprint import deck_fingerprint
from proprotor.model.doubts import doubtful_near, doubts_along, footnotes, marked, reasons_for_doubt
from proprotor.model.several_rotors import MountedRotor
from proprotor.plots import mode_motion, small_print
from proprotor.plots.mode_shape import title_of
from proprotor.rotor.options import CHOICES, Options, parse_options
from proprotor.stability import flutter
from proprotor.stability.attribution import attribution
from proprotor.stability.boundaries import boundaries, scan_speeds
from proprotor.stability.boundary_lines import boundary_lines
from proprotor.stability.map import stability_map
from proprotor.stability.origins import model_parts
from proprotor.stability.sensitivity import at_boundary, sensitivity
from proprotor.stability.sweep import sweep_case
from proprotor.tables import study_summary
from proprotor.tables.csv_text import csv_of
from tests.csv_files import without_comments
from tests.measured_point import measured_point

KNOT = 1852 / 3600
# Air in which the blades of the XV-15 outrun what its linear sections know, from 340 kt on: its flutter speed is there.
THIN = {"operation.speed_of_sound": "300 m/s"}
ENVELOPE = {
    "case.title": pp.load_case("xv15-uncoupled").title,
    "envelope.dive_speed": "200 keas",
    "envelope.altitudes": '{ value = [0, 5], unit = "km" }',
}
CASE, DOUBTFUL = (pp.load_case("xv15-uncoupled", ENVELOPE | more) for more in ({}, THIN))
UNDAMPED = {"section_damping": False}  # with which it flutters in the range of the search
GIVEN = {"section_damping": True, "pitch": "coupling", "pitch_lag_coupling": -0.1, "locked": "gimbal"}
MAP = {"airspeed": "340:440:50kt", "rotor.precone": "1:2:0.5 deg"}
SPEEDS = "300:440:20kt"
AT = "360 kt"

# Everything that takes options of the model and returns a result.
RESULTS = {
    "Case.linearize": lambda case, **o: case.linearize(AT, **o),
    "Case.open_loop": lambda case, **o: case.open_loop(AT, **o),
    "Case.sweep": lambda case, **o: case.sweep(SPEEDS, **o),
    "Case.boundaries": lambda case, **o: case.boundaries(SPEEDS, **o),
    "Case.flutter_point": lambda case, **o: case.flutter_point(SPEEDS, **o),
    "Case.sensitivity": lambda case, **o: case.sensitivity("damping", ["rotor.precone"], airspeed=AT, **o),
    "Case.envelope": lambda case, **o: case.envelope(SPEEDS, variants=[], **o),
    "envelope": lambda case, **o: pp.envelope(case, SPEEDS, **o),
    "Case.growth_constraint": lambda case, **o: case.growth_constraint(SPEEDS, ["rotor.precone"], **o),
    "growth_constraint": lambda case, **o: pp.growth_constraint(case, SPEEDS, (), **o),
    "Case.attribution": lambda case, **o: case.attribution(AT, **o),
    "Case.stability_map": lambda case, **o: case.stability_map(MAP, **o),
    "Case.boundary_against": lambda case, **o: case.boundary_against(
        {"rotor.precone": [0.02, 0.03]}, SPEEDS, **o
    ),
    "boundaries.boundaries": lambda case, **o: boundaries(case, SPEEDS, **o),
    "flutter.flutter_point": lambda case, **o: flutter.flutter_point(case, SPEEDS, **o),
    "sweep_case": lambda case, **o: sweep_case(case, [180.0], {"rotor.precone": [0.02, 0.03]}, **o),
    "sensitivity": lambda case, **o: sensitivity(
        case, "flutter_speed", ["rotor.precone"], airspeed="60:470:10kt", **o
    ),
    "attribution": lambda case, **o: attribution(case, AT, **o),
    "stability_map": lambda case, **o: stability_map(case, MAP, **o),
    "study": lambda case, **o: pp.study(
        case,
        sampling.points({"rotor.precone": [0.02, 0.03]}, drawn=True),
        SPEEDS,
        ["eigenvalue", "flutter"],
        workers=1,
        **o,
    ),
    "robust_boundary": lambda case, **o: pp.robust_boundary(
        case, {"rotor.precone": ("1 deg", "2 deg")}, SPEEDS, size=2, workers=1, **o
    ),
    "mode_motion.mode_motion": lambda case, **o: mode_motion.mode_motion(case, AT, "beam", **o),
    # Without options of their own, from a result that has them.
    "LinearModel.modes": lambda case, **o: case.linearize([180.0, 190.0], **o).modes(),
    "LinearModel.to_state_space": lambda case, **o: case.linearize(AT, **o).to_state_space(),
    "frequency_response": lambda case, **o: pp.frequency_response(case.linearize(AT, **o), "2 Hz"),
    "calibrate": lambda case, **o: pp.calibrate(case, measured_point(), ["rotor.precone"], **o),
    "gust_response": lambda case, **o: pp.gust_response(case.linearize(AT, **o)),
    "discrete_gust": lambda case, **o: pp.discrete_gust(case.linearize(AT, **o), "30 m", outputs=["force_x"]),
    "time_response": lambda case, **o: pp.time_response(
        case.linearize(AT, **o), "0:1:0.1 s", {"gust_x": 1.0}
    ),
    "distribution": lambda case, **o: pp.distribution(found("study", case, **o)),
    "LinearModel.submodel": lambda case, **o: case.linearize(AT, **o).submodel(("beam", "chord")),
}
TAKING_A_RESULT = {"boundary_lines.boundary_lines"}
# With a shaft angle or a load factor, which not all other options go with.
ABOUT_A_PERIODIC_TRIM = {
    "Case.around": lambda case, **o: case.around(AT, **o),
    "Case.floquet": lambda case, **o: case.floquet(AT, **o),
}
OF_A_ROTOR = {"rotor_model"}  # alone: the options, and no case
OF_LOOPS = {"Case.margins"}  # of a case with control loops
IN_A_NOTEBOOK = {"explore"}  # a page in a notebook, whose texts the tests of the explorer read


@cache
def _found(name, case, options):
    return RESULTS[name](case, **dict(options))


def found(name, case, **options):
    """A result, each made once."""
    return _found(name, case, tuple(options.items()))


def stamp_of(result):
    if isinstance(result, xarray.Dataset):
        return stamp.of(result.attrs)
    return stamp.of_model(result) if isinstance(result, pp.LinearModel) else dict(result.stamp)


def expected(case, **options):
    """Options in force by the definition of the options alone."""
    return options_in_force.in_force(parse_options(case.model_options(options)))


def public():
    named = {name: getattr(pp, name) for name in pp.__all__}
    named |= {f"Case.{name}": entry for name, entry in inspect.getmembers(Case) if name[0] != "_"}
    for module in (flutter, mode_motion, *map(inspect.getmodule, (boundaries, boundary_lines))):
        own = {
            name: entry
            for name, entry in vars(module).items()
            if getattr(entry, "__module__", "") == module.__name__
        }
        named |= {f"{module.__name__.rpartition('.')[2]}.{name}": entry for name, entry in own.items()}
    named |= {entry.__name__: entry for entry in (attribution, sensitivity, stability_map, sweep_case)}
    return {name: entry for name, entry in named.items() if inspect.isfunction(entry)}


def test_the_list_of_results_is_complete():
    taking = {
        name
        for name, entry in public().items()
        if any(
            p.name == "options" and p.kind is p.VAR_KEYWORD
            for p in inspect.signature(entry).parameters.values()
        )
    }
    assert taking - set(RESULTS) == TAKING_A_RESULT | OF_A_ROTOR | OF_LOOPS | IN_A_NOTEBOOK | set(
        ABOUT_A_PERIODIC_TRIM
    )


@pytest.mark.parametrize("name", ABOUT_A_PERIODIC_TRIM)
def test_results_about_a_periodic_trim_say_its_flight(name):
    given = {"shaft_angle": 0.02, "load_factor": 1.5, "locked": "gimbal"}
    own = stamp_of(ABOUT_A_PERIODIC_TRIM[name](CASE, **given))
    assert json.loads(own["options"]) == expected(CASE, **given)
    told = stamp.line(own)
    assert "shaft angle 0.02 rad" in told and "load factor 1.5" in told


@pytest.mark.parametrize("name", RESULTS)
def test_every_result_says_its_case_and_all_options_in_force(name):
    own = stamp_of(found(name, CASE, **GIVEN))
    assert options_in_force.options_in_result(own) == expected(CASE, **GIVEN)
    assert set(options_in_force.options_in_result(own)) == {entry.name for entry in fields(Options)}
    assert own["case"] == "xv15-uncoupled" and own["title"] == CASE.title
    assert own["deck"] == deck_fingerprint(CASE) != deck_fingerprint(DOUBTFUL)
    assert "calibrated" in own["reservations"] and "Gram matrix" in own["case_warnings"]
    told = stamp.line(own)
    assert "case xv15-uncoupled" in told.lower() and "locked gimbal" in told and "pitch coupling" in told
    assert "airloads" not in told  # which is as always


def test_results_of_a_closed_loop_say_its_loops(tmp_path):
    loop = pp.ControlLoop(name="hold", sensors="x rate", inputs="cyclic_1c", gain=-1e-3)
    closed = DOUBTFUL.with_control(loop)
    result = closed.margins([170.0, 180.0], **GIVEN)
    own = stamp.of(result.attrs)
    assert own["control"] == "hold: x rate to cyclic_1c" and own["deck"] == deck_fingerprint(closed)
    assert options_in_force.options_in_result(own) == expected(closed, **GIVEN)
    assert "control loops closed: hold" in stamp.line(own) and stamp.unusual_options(own)[-1].startswith(
        "Control"
    )
    assert result.warning.values.tolist() == closed.linearize([170.0, 180.0], **GIVEN).trim.warning.tolist()
    assert (result.warning.values != "").any()
    pp.save_results(result, tmp_path / "a.nc")
    assert stamp.of(pp.load_results(tmp_path / "a.nc").attrs) == own
    assert stamp.of_case(CASE, {})["control"] == "none" and "control" not in stamp.line(
        stamp.of_case(CASE, {})
    )


def test_a_rotor_alone_says_its_options():
    own = stamp.of_model(pp.rotor_model(CASE.rotor, CASE.operation, 100.0, locked=("gimbal",)))
    assert options_in_force.options_in_result(own)["locked"] == ["gimbal"] and "case" not in own
    model = CASE.linearize(100.0).submodel(("beam",))
    assert (
        stamp.of_model(pp.LinearModel(model.M, model.C, model.K, model.dofs, model.trim, model.airspeed))
        == {}
    )


def in_matlab(path):
    """The stamp in a .mat file; there `case` is a word of the language."""
    inside = loadmat(path, simplify_cells=True)["attributes"]
    return {name: inside[own] for name, own in matlab_names(stamp.NAMES).items() if own in inside}


@pytest.mark.parametrize(
    "name", [name for name in RESULTS if isinstance(found(name, CASE, **GIVEN), xarray.Dataset)]
)
def test_datasets_keep_it_all_in_files(name, tmp_path):
    result = found(name, DOUBTFUL, **GIVEN)
    pp.save_results(result, tmp_path / "a.nc")
    again = pp.load_results(tmp_path / "a.nc")
    several_airs = {"air_density"} if name.endswith("envelope") else set()
    assert stamp.of(again.attrs) == stamp.of(result.attrs)
    assert set(stamp.of(again.attrs)) == set(stamp.NAMES) - several_airs
    warnings = [name for name in result.variables if str(name).endswith("warning")]
    for warning in warnings:
        assert again[warning].values.tolist() == result[warning].values.tolist()
    assert warnings or "doubtful" in result
    pp.save_matlab(result, tmp_path / "a.mat")
    assert in_matlab(tmp_path / "a.mat") == stamp.of(result.attrs)


def test_models_and_records_keep_it_all(tmp_path):
    model = found("Case.linearize", CASE, **GIVEN)
    pp.save_matlab(model, tmp_path / "a.mat")
    assert in_matlab(tmp_path / "a.mat") == stamp.of_model(model)
    for name in (
        "Case.flutter_point",
        "Case.boundaries",
        "LinearModel.to_state_space",
        "mode_motion.mode_motion",
    ):
        record = found(name, CASE, **GIVEN)
        assert pickle.loads(pickle.dumps(record)).stamp == record.stamp
    assert "locked gimbal" in repr(found("Case.flutter_point", CASE, **GIVEN)) and "locked gimbal" in repr(
        model
    )


# What goes on from a result ------------------------------------------------------------------------------------------

OTHERWISE = {
    "equations": "published",
    "pitch": "rigid",
    "structure": "diagonal",
    "airloads": "lift-slope",
    "compressibility": False,
    "section_damping": False,
    "lift": "lagged",
    "inflow": "dynamic",
    "rotor_speed": "constant",
    "reactionless": True,
    "backend": "compiled",
    "cyclic": "level",
    "shaft_angle": 0.02,
    "load_factor": 2.0,
    "locked": ("gimbal", "lag"),
    "pitch_flap_coupling": 0.1,
    "pitch_lag_coupling": -0.2,
    "frequencies": pp.BladeFrequencies(at_rotor_speed=CASE.operation.rotor_speed, flap=1.9, lag=1.2),
    "drive_train": pp.DriveTrain(drive_inertia=3.0),
}


def goes_on_from_a_map(**options):
    (line, *_) = boundary_lines(CASE, carried_map(), **options)
    return line.mode, line.frequency.tolist()


@cache
def carried_map():
    axes = {"airspeed": "300:440:35kt", "rotor.precone": "0:3:1 deg"}
    return CASE.stability_map(axes, section_damping=True, locked=("gimbal",))


@cache
def carried_boundary():
    return CASE.flutter_point("60:470:10kt", section_damping=True, locked=("gimbal",), level=0.01).boundaries[
        -1
    ]


def goes_on_from_a_boundary(**options):
    inputs = {"rotor.precone": CASE.given["rotor.precone"]}
    return at_boundary(CASE, carried_boundary(), inputs, options).derivative.item()


@cache
def carried_model():
    return CASE.linearize(180.0, section_damping=True, locked=("gimbal",))


def goes_on_from_a_model(**options):
    return {name: part.K.tolist() for name, part in model_parts(CASE, carried_model(), **options).items()}


TAKERS = (goes_on_from_a_map, goes_on_from_a_boundary, goes_on_from_a_model)


@pytest.mark.parametrize("go_on", TAKERS)
def test_who_takes_a_result_takes_its_options_from_it(go_on):
    plain = go_on()
    assert go_on(section_damping=True) == plain
    assert go_on(locked="gimbal", section_damping=True) == go_on(locked=("gimbal",), pitch="dynamic") == plain
    assert go_on(frequencies=None, structure="coupled") == plain


@pytest.mark.parametrize("option", OTHERWISE)
@pytest.mark.parametrize("go_on", TAKERS)
def test_who_takes_a_result_refuses_other_options(go_on, option):
    if option == "backend" and why_not():
        pytest.skip("there is no C compiler")
    with pytest.raises(pp.InputError) as caught:
        go_on(**{option: OTHERWISE[option]})
    own = expected(CASE, section_damping=True, locked=("gimbal",))[option]
    assert str(caught.value).startswith(f"{option} = ")
    told = str(own).lower() if isinstance(own, bool) else str(own)
    assert f"must be {told}, with which the result was computed" in str(caught.value)
    assert set(OTHERWISE) == {entry.name for entry in fields(Options)}


@pytest.mark.parametrize("go_on", TAKERS)
def test_who_takes_a_result_refuses_what_is_no_option(go_on):
    with pytest.raises(pp.InputError, match="did you mean section_damping"):
        go_on(section_dampin=True)


def test_the_options_of_a_map_are_those_that_name_its_lines():
    """The fault that this is about: without its options a map's lines had modes and frequencies of another model."""
    lines = boundary_lines(CASE, carried_map())
    for line in lines:
        middle = len(line.x) // 2
        varied = CASE.vary({"rotor.precone": line.y[middle]})
        values = (
            varied.linearize(line.x[middle], section_damping=True, locked=("gimbal",))
            .modes()
            .eigenvalue.values
        )
        nearest = values[np.argmin(np.abs(values.real))]
        assert abs(nearest.imag) == pytest.approx(line.frequency[middle], rel=1e-6, abs=1e-6)


def test_another_case_or_airspeed_is_refused():
    with pytest.raises(
        pp.InputError,
        match=r"^case = xv15-uncoupled: must be the case of the result, xv15-uncoupled, with the same numbers",
    ):
        boundary_lines(DOUBTFUL, carried_map())
    with pytest.raises(pp.InputError, match=r"^airspeed = 300 kt: is one of the axes of the map"):
        boundary_lines(CASE, carried_map(), airspeed="300 kt")
    axes = {"rotor.precone": "0:2:1 deg", "rotor.airfoil.lift_slope": [5.0, 6.0]}
    found = CASE.stability_map(axes, airspeed="380 kt", **UNDAMPED)
    assert boundary_lines(CASE, found, airspeed="380 kt")[0].mode == boundary_lines(CASE, found)[0].mode
    with pytest.raises(pp.InputError, match=r"^airspeed = 300 kt: must be 195.489 m/s, that of the map"):
        boundary_lines(CASE, found, airspeed="300 kt")
    with pytest.raises(pp.InputError, match="must say its options"):
        boundary_lines(CASE, found.drop_attrs())


def same(value):
    return 1.9 + 0 * value


@pytest.mark.parametrize(
    ("given", "repeat"),
    [
        ({}, False),
        (
            {
                "structure": "tabulated",
                "frequencies": pp.BladeFrequencies(
                    at_rotor_speed=CASE.operation.rotor_speed, flap=1.9, lag=1.2
                ),
            },
            False,
        ),
        (
            {
                "structure": "tabulated",
                "frequencies": pp.BladeFrequencies(
                    at_rotor_speed=CASE.operation.rotor_speed,
                    flap=[1.9, 1.8],
                    lag=1.2,
                    at=[0.0, 1.0],
                    against="collective",
                ),
            },
            False,
        ),
        (
            {
                "structure": "tabulated",
                "frequencies": pp.BladeFrequencies(
                    at_rotor_speed=CASE.operation.rotor_speed, flap=same, lag=1.2
                ),
            },
            True,
        ),
        ({"drive_train": pp.DriveTrain(drive_inertia=100.0, shaft_stiffness=1e4)}, False),
        ({"pitch": "coupling", "pitch_lag_coupling": [-0.1, -0.2]}, False),
        ({"pitch": "coupling", "pitch_lag_coupling": np.linspace(-0.1, -0.2, 40)}, True),
        ({"equations": "published", "airloads": "lift-slope", "compressibility": False}, False),
    ],
)
def test_options_come_back_from_what_is_written(given, repeat):
    own = json.loads(json.dumps(stamp.of_case(CASE, given)))
    if repeat:
        with pytest.raises(pp.InputError, match="must be given again: the result was computed with"):
            options_of_result.options_of(own, CASE, {})
    back = options_of_result.options_of(own, CASE, given if repeat else {})
    assert expected(CASE, **back) == expected(CASE, **given)
    options_of_result.options_of(own, CASE, given)


@pytest.mark.parametrize("name", pp.list_cases())
def test_what_a_deck_brings_is_in_force_and_its_numbers_are_its_fingerprint(name):
    case = pp.load_case(name)
    own = stamp.of_case(case, {})
    back = options_of_result.options_of(own, case, {})
    assert expected(case, **back) == expected(case) and back["structure"] == expected(case)["structure"]
    radius = case.given["rotor.radius"].si
    assert deck_fingerprint(case.vary({"rotor.radius": radius})) == own["deck"]
    assert deck_fingerprint(case.vary({"rotor.radius": radius * (1 + 1e-15)})) != own["deck"]
    others = [deck_fingerprint(pp.load_case(other)) for other in pp.list_cases() if other != name]
    assert own["deck"] not in others


def test_frequencies_of_a_deck_are_options_in_force(tmp_path):
    deck = tmp_path / "tabulated.toml"
    deck.write_text(
        'base = "xv15-uncoupled"\n[case]\nname = "tabulated"\ntitle = "T"\n'
        '[rotor.frequencies]\nat_rotor_speed = "458 rpm"\nflap = 1.9\nlag = 1.3\n'
        '[drive_train]\ndrive_inertia = "100 kg*m**2"\n'
    )
    case = pp.load_case(deck)
    own = case.sweep("200 kt").attrs
    told = options_in_force.options_in_result(own)
    assert told["structure"] == "tabulated" and told["frequencies"]["flap"] == 1.9
    assert told["drive_train"]["drive_inertia"] == pytest.approx(100.0)
    assert "structure tabulated" in stamp.line(own)
    back = options_of_result.options_of(
        own, case, {}
    )  # the case brings its own frequencies, varied ones as well
    assert "frequencies" not in back and expected(case, **back) == told
    with pytest.raises(pp.InputError, match=r"^structure = coupled: must be tabulated"):
        options_of_result.options_of(own, case, {"structure": "coupled"})
    without = stamp.of_case(case, {"drive_train": None})
    assert expected(case, **options_of_result.options_of(without, case, {}))["drive_train"] is None


def test_the_fingerprint_knows_what_is_no_number():
    settings = ({"operation.trim": "{ collective = '40 deg' }"}, {"support.includes_rotor": "false"})
    plain = deck_fingerprint(pp.load_case("xv15-uncoupled"))
    assert deck_fingerprint(CASE) != plain  # which has an envelope
    soft, softer = (
        deck_fingerprint(
            pp.load_case("xv15-uncoupled", {"variants.soft.rotor.control_stiffness": f"{k} N*m/rad"})
        )
        for k in (900, 800)
    )
    assert len({plain, soft, softer}) == 3
    assert deck_fingerprint(pp.load_case("xv15-uncoupled", {"case.title": "another"})) == plain
    assert deck_fingerprint(pp.load_case("xv15-uncoupled", {"rotor.radius": "150 inch"})) == plain
    assert deck_fingerprint(pp.load_case("xv15-uncoupled", settings[0])) != plain
    own = pp.Case("mine", CASE.rotor, CASE.operation, CASE.support)
    assert deck_fingerprint(own) == deck_fingerprint(
        pp.Case("yours", CASE.rotor, CASE.operation, CASE.support)
    )


# Doubts ---------------------------------------------------------------------------------------------------------------

MACH = "Mach number beyond 0.85"


@pytest.mark.parametrize("name", [name for name in RESULTS if name != "LinearModel.submodel"])
def test_every_result_carries_its_doubts(name):
    result = found(name, DOUBTFUL, **UNDAMPED)
    if isinstance(result, pp.LinearModel):
        texts = result.trim.warning
    elif isinstance(result, xarray.Dataset):
        texts = [
            result.attrs.get("doubts", ""),
            *(v.values for n, v in result.items() if str(n).endswith("warning")),
        ]
    else:
        texts = [getattr(result, "warning", ""), getattr(result, "doubts", "")]
    assert MACH in str(texts)


def test_boundaries_are_as_doubtful_as_the_airspeeds_they_lie_at():
    point = DOUBTFUL.flutter_point(**UNDAMPED)
    assert point.warning and len({bool(boundary.warning) for boundary in point.boundaries}) == 2
    for boundary in point.boundaries:
        assert boundary.warning == DOUBTFUL.linearize(boundary.position, **UNDAMPED).trim.warning
    scan = DOUBTFUL.linearize(scan_speeds(DOUBTFUL), **UNDAMPED)
    for doubt in point.doubts:
        told = np.array([doubt.text in text for text in scan.trim.warning])
        assert (doubt.low, doubt.high) == tuple(scan.airspeed[told][[0, -1]])
    assert any(MACH in doubt.text for doubt in point.doubts)
    vertices = found("stability_map", DOUBTFUL, **UNDAMPED)
    for at, warning in zip(vertices.boundary.values, vertices.boundary_warning.values, strict=True):
        if np.isfinite(at).all():
            varied = DOUBTFUL.vary({"rotor.precone": at[1]})
            assert warning == varied.linearize(at[0], **UNDAMPED).trim.warning.item()
        else:
            assert warning == ""
    results = found("study", DOUBTFUL, **UNDAMPED)
    for design in range(2):
        varied = DOUBTFUL.vary({"rotor.precone": float(results["rotor.precone"][design])})
        speed = float(results.flutter_speed[design])
        assert (
            results.flutter_warning.values[design] == varied.linearize(speed, **UNDAMPED).trim.warning.item()
        )


SHOWN = {
    "sweep": (("--speed", SPEEDS), r"\n +360\? "),
    "flutter": ((), r"\n{speed}\? .*Flutter speed {speed}\? KTAS"),
    "map": (
        ("--x", "airspeed=300:400:50kt", "--y", "rotor.precone=1:2:1deg"),
        r"\n1 \. +[.#]\?.*boundary 1: .*\)\?",
    ),
    "sensitivity": (("--wrt", "rotor.precone"), r"Flutter speed \d+(\.\d)?\? KTAS.*\d\? "),
    "attribution": (("--speed", AT, "--mode", "beam"), r"damping -?\d.*\? % of critical.*\d\? "),
    "study": (
        ("--vary", "rotor.precone=1:2:1 deg", "--speed", SPEEDS, "--flutter", "--workers", "1"),
        r"\n +1 +\d+\.\d+\? +.*\n +2 +\d+\.\d+\? +",
    ),
    "report": (("--speed", "340:400:30kt"), r"Flutter speed {speed}\? KTAS"),
}
SET = ("--set", "operation.speed_of_sound=300 m/s", "--no-section-damping")


@pytest.mark.parametrize("command", SHOWN)
def test_every_command_shows_doubts_and_options(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    arguments, pattern = SHOWN[command]
    speed = DOUBTFUL.flutter_point(**UNDAMPED).speed / KNOT
    pattern = pattern.replace("{speed}", re.escape(f"{speed:.2f}"))
    run = CliRunner()
    plain = run.invoke(main, [command, "xv15-uncoupled", *SET, *arguments], env={"COLUMNS": "200"})
    assert plain.exit_code == 0, plain.output

    assert re.search(pattern, plain.stdout, re.DOTALL), plain.stdout
    assert command == "report" or ("? Doubtful" in plain.stdout and MACH in plain.stdout)
    arguments = [command, "xv15-uncoupled", *SET, *arguments, "--locked", "lag", "--json"]
    result = run.invoke(main, [*arguments, *(("--csv", "a.csv") if command != "report" else ())])
    assert result.exit_code == 0, result.output
    document = json.loads(result.stdout)
    case = pp.load_case("xv15-uncoupled", {"operation.speed_of_sound": "300 m/s"})
    assert document["options"] == expected(case, locked=("lag",), **UNDAMPED)
    assert document["deck"] == deck_fingerprint(case) and document["case"] == "xv15-uncoupled"
    assert MACH in result.stdout
    if "--csv" in arguments or (tmp_path / "a.csv").exists():
        head = [line for line in (tmp_path / "a.csv").read_text().splitlines() if line.startswith("# ")]
        assert any('"locked": ["lag"]' in line for line in head) and "calibrated" in " ".join(head)
        assert "warning" in without_comments(tmp_path / "a.csv")[0] and MACH in "\n".join(
            without_comments(tmp_path / "a.csv")
        )


def test_the_tables_without_a_doubt_have_no_question_mark():
    for command in ("flutter", "sensitivity"):
        result = CliRunner().invoke(
            main, [command, "xv15-uncoupled", "--no-section-damping"], env={"COLUMNS": "200"}
        )
        assert "?" not in result.stdout, result.stdout


def test_pictures_say_case_options_and_doubts():
    options = {"section_damping": True}
    sweep, at = DOUBTFUL.sweep("340:400:20kt", **options), "380 kt"
    drawn = {
        "frequency": plots.plot_frequency(sweep),
        "damping": plots.plot_damping(sweep),
        "locus": plots.plot_root_locus(sweep),
        "participation": plots.plot_participation(sweep, "beam"),
        "map": plots.plot_stability_map(DOUBTFUL.stability_map(MAP, **options)),
        "attribution": plots.plot_attribution(DOUBTFUL.attribution(at, "beam", **options)),
        "sensitivity": plots.plot_sensitivity(
            DOUBTFUL.sensitivity("damping", airspeed=at, mode="beam", **options)
        ),
        "shape": plots.plot_mode_shape(mode_motion.mode_motion(DOUBTFUL, at, "beam", **options)),
        "distribution": plots.plot_distribution(found("study", DOUBTFUL, **UNDAMPED)),
        "campbell": plots.plot_campbell(
            DOUBTFUL.sweep(at, {"operation.rotor_speed": [46.0, 48.0]}, **options), n_blades=3
        ),
    }
    for name, ax in drawn.items():
        text = small_print.read(ax)
        assert "Case xv15-uncoupled" in text, name
        assert name == "distribution" or "options: " in text or "default options" in text, name
        assert MACH in text or name == "distribution", name
    figure = plots.plot_sweep(sweep)
    text = " ".join(text.get_text().replace("\n", " ") for text in figure.texts)
    assert "Case xv15-uncoupled" in text and MACH in text
    motion = mode_motion.mode_motion(DOUBTFUL, at, "beam")
    assert "at 380? KTAS" in title_of(motion)


def test_report_and_explorer_say_it(tmp_path):
    page = tmp_path / "a.html"
    arguments = [
        "report",
        "xv15-uncoupled",
        *SET,
        "--locked",
        "lag",
        "--out",
        str(page),
        "--speed",
        "100:440:20kt",
    ]
    assert CliRunner().invoke(main, arguments).exit_code == 0
    text = page.read_text(encoding="utf-8")
    assert "?" in text and MACH in text
    row = text.partition('<th scope="row">locked</th>')[2][:200]
    assert "lag" in row and "chosen" in row
    speeds = np.linspace(100, 440, 35) * KNOT
    live = live_modes(DOUBTFUL, speeds, **UNDAMPED)
    assert re.search(r"Flutter speed 35\d\.\d\? KTAS", readout(live, {}, {}))
    assert "? Doubtful from" in messages(live)
    assert "?" not in readout(live_modes(CASE, speeds, **UNDAMPED), {}, {})


def test_summaries_of_studies_count_doubts():
    summary = study_summary.study_summary(found("study", DOUBTFUL, **UNDAMPED))
    assert summary["flutter speeds doubtful"] == summary["flutter speeds found"] == 2
    assert MACH in str(summary["doubts"]) and summary["points doubtful"] > 0
    assert int(found("distribution", DOUBTFUL, **UNDAMPED).doubtful) == 2


def test_sobol_indices_carry_them():
    inputs = {"rotor.precone": (0.02, 0.04), "rotor.control_stiffness": pp.sampling.Relative(0.9, 1.1)}
    results = pp.study(
        DOUBTFUL, sampling.saltelli(inputs, 8), "300:440:20kt", "flutter", workers=1, **UNDAMPED
    )
    indices = pp.sobol_indices(results)
    assert int(indices.doubtful) == int((results.flutter_warning != "").sum()) > 0
    assert stamp.of(indices.attrs) == stamp.of(results.attrs) and MACH in indices.attrs["doubts"]
    text = small_print.read(plots.plot_sobol(indices))
    assert "Case xv15-uncoupled" in text and MACH in text


def test_doubts_are_grouped_by_their_reason():
    induced = "induced velocity, neglected, would be {}% of the airspeed"
    warnings = np.array(
        [induced.format(30), induced.format(12), "", f"{induced.format(11)}; Mach"], dtype=object
    )
    assert reasons_for_doubt(warnings.tolist()) == {
        "induced velocity, neglected, would be up to 30% of the airspeed": [0, 1, 3],
        "Mach": [3],
    }
    positions = np.array([10.0, 20.0, 30.0, 40.0])
    told = list(footnotes(doubts_along(positions, warnings), "KTAS", 2.0))
    assert told == [
        "Doubtful from 5 KTAS to 20 KTAS: induced velocity, neglected, would be up to 30% of the airspeed.",
        "Doubtful at 20 KTAS: Mach.",
    ]
    assert [doubtful_near(positions, warnings, at) for at in (15.0, 25.0, 30.0, 35.0)] == [
        True,
        True,
        False,
        True,
    ]
    assert (marked("1.0", ""), marked("1.0", "why")) == ("1.0", "1.0?")


def test_cells_of_csv_are_text_or_numbers_and_never_formulas():
    texts = (
        "=1+1",
        "+1+cmd|' /C calc'!A0",
        "-2+3+cmd",
        "@SUM(A1)",
        "-1.5 deg",
        "+3 kt",
        "plain",
        "a\n# case: forged",
    )
    head = {
        "options": json.dumps(options_in_force.in_force(Options())),
        "case": "x\ny",
        "deck": "0",
        "made_by": "p",
    }
    written = csv_of(
        [{"text": text, "=number": np.nan} for text in texts], ["text", "=number"], head
    ).decode()
    comments = [line for line in written.splitlines() if line.startswith("#")]
    assert len(comments) == 2 and "x y" in comments[0]
    cells = [line.rpartition(",")[0].strip('"') for line in written.splitlines()[2:]]
    assert cells == [
        "text",
        "'=1+1",
        "'+1+cmd|' /C calc'!A0",
        "'-2+3+cmd",
        "'@SUM(A1)",
        *texts[4:7],
        "a # case: forged",
    ]
    assert "'=number" in written


def test_choices_have_other_values_to_be_told():
    assert set(CHOICES) < set(OTHERWISE)
    own = expected(CASE, section_damping=True, locked=("gimbal",))
    assert all(options_in_force.plain(value) != own[name] for name, value in OTHERWISE.items())


def test_several_rotors_say_their_options_where_they_are_the_same():
    def mounted(*locked):
        rotors = {
            name: MountedRotor(pp.rotor_model(CASE.rotor, CASE.operation, 100.0, locked=own), np.eye(6))
            for name, own in zip(("left", "right"), locked, strict=True)
        }
        return pp.mount_rotors(rotors, CASE_SUPPORT)

    assert options_in_force.options_in_result(stamp.of_model(mounted("lag", "lag")))["locked"] == ["lag"]
    assert stamp.of_model(mounted("lag", "gimbal")) == {}


CASE_SUPPORT = pp.NormalModes(
    ("a", "b", "c", "d", "e", "f"), 1e4 * np.eye(6), np.zeros((6, 6)), 1e6 * np.eye(6), np.eye(6), False
)


def test_the_page_of_the_explorer_tells_the_options_as_they_are_switched():
    options = {name: getattr(Options(), name) for name in CHOICES} | {"locked": ("gimbal",)}
    page = ExplorePage(CASE, "xv15-uncoupled", np.linspace(100, 300, 8) * KNOT, {}, options)
    page.put_on(Document())
    assert "Options: locked gimbal." in page.foot.text and "calibrated" in page.foot.text
    page.chosen.options["pitch"] = "rigid"
    page.update()
    assert "Options: pitch rigid, locked gimbal." in page.foot.text


def test_that_nothing_flutters_is_as_doubtful_as_the_airspeeds_that_say_so():
    speeds = ("--scan", "300:350:10kt", "--speed", "345 kt", *SET, "--locked", "lag")
    result = CliRunner().invoke(main, ["flutter", "xv15-uncoupled", *speeds], env={"COLUMNS": "200"})
    assert "No mode becomes unstable between 300 and 350? KTAS." in result.stdout, result.stdout
    assert re.search(r"The least damping there is [\d.]+\?? % of critical", result.stdout)
    assert "? Doubtful" in result.stdout and MACH in result.stdout
    document = json.loads(CliRunner().invoke(main, ["flutter", "xv15-uncoupled", *speeds, "--json"]).stdout)
    assert document["flutter speed (m/s)"] is None and MACH in str(document["doubts"])


@pytest.mark.parametrize("name", pp.list_cases())
def test_modes_of_a_sweep_have_names_of_their_own(name):
    case = pp.load_case(name)
    tip = float(case.operation.rotor_speed) * float(case.rotor.radius)
    names = case.sweep(tip * np.linspace(0.3, 0.9, 7)).mode.values.tolist()
    assert len(set(names)) == len(names)
