"""Inputs that a deck leaves out, and values in every form of a deck: what varies is what the deck would say."""

import json
import math
import re

import numpy as np
import pytest
from click.testing import CliRunner

import proprotor as pp
from proprotor.commands.main import main
from proprotor.deck.describe import deck_fields, defaults_of
from proprotor.deck.sections import sections_at
from proprotor.deck.vary import inputs_at
from proprotor.errors import InputError
from proprotor.stability.growth_constraint import growth_constraint
from proprotor.study.box import box_of
from proprotor.units import unit_registry

SPEED = 130.0  # m/s
DELTA_3 = "rotor.pitch_gimbal_coupling"
ENTRY = "[NAME]"


def run(*arguments):
    return CliRunner().invoke(main, arguments)


def matrices(case):
    model = case.linearize(SPEED)
    return [np.asarray(getattr(model, name)) for name in ("M", "C", "K")]


def left_out(case):
    """Yield every path of a case that varies though its deck does not give it, by asking for all fields of decks."""
    names = {
        "support.modes": [mode.name for mode in getattr(case.deck.support, "modes", None) or []]
        if case.deck.support.kind == "normal-modes"
        else [],
        "control.loops": [loop.name for loop in case.loops],
    }
    known = pp.design_inputs(case)
    for field in deck_fields():
        if field.kind not in ("", case.deck.support.kind) or field.path in known:
            continue
        table = field.path.partition(ENTRY)[0]
        for name in names[table] if ENTRY in field.path else [""]:
            path = field.path.replace(ENTRY, f"[{name}]")
            if path in known:
                continue
            try:
                yield path, inputs_at(case, [path])[path]
            except InputError:
                continue


@pytest.mark.parametrize("name", ["xv15-aircraft", "xv15-mass-distribution", "wrats-742-off"])
def test_what_a_deck_leaves_out_varies_as_if_the_deck_had_it(name):
    case = pp.load_case(name)
    own = matrices(case)
    found = list(left_out(case))
    assert any(path.startswith("rotor.") for path, _ in found)
    for path, number in found:
        same = matrices(case.vary({path: number.si}))
        for matrix, wanted in zip(same, own, strict=True):
            np.testing.assert_allclose(
                matrix, wanted, rtol=1e-9, atol=1e-9 * np.abs(wanted).max(), err_msg=path
            )
        if path.endswith(
            ("flap_inboard", "flap_outboard", "flap_chord")
        ):  # of a flaperon that no matrix holds
            continue
        other = number.si + {"m/s": 1.0}.get(number.unit, 0.01)
        said = pp.load_case(name, {path: f"{other!r} {number.unit}".strip()})
        for matrix, wanted in zip(matrices(case.vary({path: other})), matrices(said), strict=True):
            np.testing.assert_allclose(
                matrix, wanted, rtol=1e-9, atol=1e-9 * np.abs(wanted).max(), err_msg=path
            )


def test_a_default_is_the_one_that_describe_tells():
    """The text that `proprotor describe` prints, read as a number with a unit, is the number that varies."""
    checked = 0
    for field in deck_fields():
        place, _, name = field.path.replace(ENTRY, "").rpartition(".")
        section = sections_at(tuple(filter(None, place.split(".")))).get(field.kind)
        default = section and defaults_of(section).get(name)
        if isinstance(default, float) and re.match(r"-?\d", field.default):
            assert float(field.default.split()[0]) == pytest.approx(default)
            checked += 1
    assert checked > 40


@pytest.mark.parametrize(
    ("path", "rule"),
    [
        ("drive_train.drive_inertia", "write [drive_train] in the deck"),
        ("support.wing_aerodynamics.span", "unknown input"),
        ("rotor.cyclic_control_stiffness", "no default to vary from"),
        ("rotor.lock_number", "the deck gives chord instead"),
        ("rotor.twist", "distributions"),
        ("rotor.n_blades", "whole number"),
        ("case.name", "it is text"),
        ("left.rotor.precone", "under [left]"),
        ("support.modes[beam].x", "unknown input"),
        ("control.loops[damper].gain", "write [control.loops[damper]] in the deck"),
        ("rotor.airfoil.blend", "the deck gives no region_ends"),
        ("rotor.airfoil.drag[2]", "did you mean rotor.airfoil.drag?"),
        ("rotor.precon", "did you mean rotor.precone?"),
        ("rotor", "unknown input"),
        ("", "unknown input"),
        ("..", "unknown input"),
        ("rotor.[", "unknown input"),
    ],
)
def test_what_cannot_vary_says_what_to_write(path, rule):
    with pytest.raises(InputError) as raised:
        inputs_at(pp.load_case("xv15"), [path])
    assert raised.value.field == path and rule in raised.value.rule


def test_regions_are_named():
    case = pp.load_case(
        "xv15",
        {"rotor.airfoil": "{ lift_slope = { value = [5.7, 5.8], unit = '1/rad' }, region_ends = 0.5 }"},
    )
    with pytest.raises(InputError, match=r"rotor\.airfoil\.lift_slope\[1\], rotor\.airfoil\.lift_slope\[2\]"):
        inputs_at(case, ["rotor.airfoil.lift_slope"])


# Forms of a value ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("path", [field.path for field in deck_fields() if field.form == "tangent"])
def test_every_tangent_takes_its_angle(path):
    case, name = pp.load_case("xv15"), path.rpartition(".")[2]
    wanted = math.tan(math.radians(-15))
    for given in ("-15 deg", "-0.2617993877991494 rad", unit_registry()("-15 deg"), wanted, str(wanted)):
        assert getattr(case.vary({path: given}).rotor, name) == pytest.approx(wanted, rel=1e-14)
    ranged = case.vary({path: "-20:20:10 deg"}).rotor
    np.testing.assert_allclose(
        getattr(ranged, name), np.tan(np.radians([-20, -10, 0, 10, 20])), rtol=1e-12, atol=1e-15
    )
    mixed = case.vary({path: ["-20 deg", 0.1]}).rotor
    np.testing.assert_allclose(getattr(mixed, name), [math.tan(math.radians(-20)), 0.1])
    for given, rule in (
        ("95 deg", "within 90 deg"),
        ("1 kg", "or the angle of which it is the tangent"),
        ("80:100:10 deg", "within 90 deg"),
        ("1 deg,2", "cannot be read"),
        ("nan", "finite"),
        ("", "number and a unit"),
        (["1 deg", "1:2:1 deg"], "list of values"),
    ):
        with pytest.raises(InputError, match=rule):
            case.vary({path: given})


def test_every_frequency_takes_what_is_per_revolution():
    case = pp.load_case("xv15")
    omega = 458 * np.pi / 30
    for path in ("support.beam_frequency", "rotor.flap_frequency"):
        varied = case.vary({path: ["0.42/rev", "5 Hz"]})
        np.testing.assert_allclose(varied.given[path].si, [0.42 * omega, 10 * np.pi], rtol=1e-12)
        ranged = case.vary({path: "0.4:0.6:0.1/rev"})
        np.testing.assert_allclose(ranged.given[path].si, np.array([0.4, 0.5, 0.6]) * omega, rtol=1e-12)
    with pytest.raises(InputError, match=r"support\.beam_frequency = x/rev"):
        case.vary({"support.beam_frequency": "x/rev"})


def analyses(case, path, angle, tangent):
    """Yield each analysis that takes values of an input, with angles and with their tangents."""
    low, high = angle
    wide = f"{low}:{high}:{high - low} deg"
    ends = tuple(f"{one} deg" for one in angle)
    speeds = "100:200:20ktas"
    yield "vary", *(case.vary({path: one}).flutter_point(speeds).speed for one in (ends[0], tangent[0]))
    yield (
        "sweep",
        *(case.sweep("300 kt", vary={path: one}).eigenvalue.values for one in (wide, list(tangent))),
    )
    yield (
        "against",
        *(case.boundary_against({path: one}, speeds)["first"].values for one in (wide, list(tangent))),
    )
    yield (
        "map",
        *(
            case.stability_map({path: one, "airspeed": "300:350:50kt"}).growth.values
            for one in (wide, list(tangent))
        ),
    )
    yield (
        "study",
        *(
            pp.study(case, {path: one}, "300 kt", "least_stable").growth_rate.values
            for one in (wide, list(tangent))
        ),
    )
    yield "box", *(np.concatenate(box_of(case, {path: one})[1:]) for one in (ends, tangent))


def test_every_analysis_takes_angles_for_tangents():
    """What fails here refuses angles, or takes them for something else; the tangents are those of `math`."""
    case = pp.load_case("wrats-742-off")
    angle = (-20, -10)
    tangent = tuple(math.tan(math.radians(one)) for one in angle)
    for name, by_angle, by_tangent in analyses(case, DELTA_3, angle, tangent):
        np.testing.assert_allclose(by_angle, by_tangent, rtol=1e-9, err_msg=name)


def test_commands_take_angles_for_tangents():
    tangent = math.tan(math.radians(-20))
    for command in (
        ["boundary", "wrats-742-off", "--against", f"{DELTA_3}=-20:-10:10 deg", "--scan", "100:200:20ktas"],
        ["study", "wrats-742-off", "--vary", f"{DELTA_3}=-20 deg, -10 deg", "--speed", "300 kt"],
        ["map", "wrats-742-off", "--x", f"{DELTA_3}=-20:-10:10 deg", "--y", "airspeed=300:350:50kt"],
    ):
        result = run(*command, "--json")
        assert result.exit_code == 0, result.output
        assert f"{tangent:.6f}" in result.output, command
        json.loads(result.output)


def test_a_spread_of_an_angle_is_refused_where_only_the_tangent_has_one():
    case = pp.load_case("xv15")
    with pytest.raises(InputError, match="plain number"):
        pp.study(
            case, pp.sampling.latin_hypercube({DELTA_3: pp.sampling.Normal("-15 deg", "2 deg")}, 4), "300 kt"
        )


def test_factors_of_a_number_that_is_zero_are_refused():
    with pytest.raises(InputError, match="the number is 0"):
        pp.robust_boundary(
            pp.load_case("xv15"),
            {"rotor.kinematic_pitch_lag_coupling": pp.sampling.Relative(0.9, 1.1)},
            "300:400:20ktas",
        )


def test_derivatives_at_a_default():
    """By central differences of the flutter speed over two designs that the deck itself describes."""
    case, path, step = pp.load_case("xv15"), "rotor.kinematic_pitch_lag_coupling", 1e-4
    exact = case.sensitivity("flutter_speed", [path]).derivative.item()
    ends = [pp.load_case("xv15", {path: repr(value)}).flutter_point().speed for value in (-step, step)]
    assert exact == pytest.approx((ends[1] - ends[0]) / (2 * step), rel=1e-5)
    assert run("sensitivity", "xv15", "--wrt", path, "--json").exit_code == 0
    assert growth_constraint(case, "300 kt", wrt=[path]) is not None
