"""The explorer without a browser: its analysis is the engine's, its decks hold what was set, its server is private."""

import asyncio
import tomllib
import urllib.error
import urllib.request

import numpy as np
import pytest
from bokeh.document import Document
from click.testing import CliRunner
from tornado.httpclient import HTTPClientError, HTTPRequest
from tornado.websocket import websocket_connect

import proprotor as pp
from proprotor.commands.main import main
from proprotor.explore.altered_deck import altered_deck
from proprotor.explore.analysis import live_modes
from proprotor.explore.curves import curves
from proprotor.explore.inputs import first_inputs, slider_input
from proprotor.explore.page import ExplorePage
from proprotor.rotor.options import CHOICES, Options
from proprotor.stability.boundaries import scan_speeds
from proprotor.tables.sweep_summary import leaps
from tests.explore_server import serving

KT = 1852 / 3600
DEG = np.pi / 180
CHORD = "support.modes[chord].frequency"
COUPLING = "rotor.kinematic_pitch_flap_coupling"  # which the deck leaves out


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


@pytest.fixture(scope="module")
def speeds(case):
    return scan_speeds(case, 60)


def options(**changed):
    chosen = vars(Options(**changed))
    return {name: chosen[name] for name in (*CHOICES, "pitch_flap_coupling", "pitch_lag_coupling", "locked")}


# The analysis -------------------------------------------------------------------------------------------------------


def random_designs(case, count):
    random = np.random.default_rng(7)
    paths = first_inputs(case)
    for _ in range(count):
        chosen = random.choice(paths, 3, replace=False)
        sliders = [slider_input(case, path) for path in chosen]
        yield {s.path: random.uniform(s.low, s.high) * s.factor for s in sliders}


def test_modes_are_those_of_sweep_under_the_same_names(case, speeds):
    told_apart = 0
    for values in ({}, *random_designs(case, 8)):
        live, exact = live_modes(case, speeds, values), case.vary(values).sweep(speeds)
        assert live.names == exact.mode.values.tolist(), values
        found = np.stack([live.eigenvalue, exact.eigenvalue.values])
        if (
            exact.tracking_quality.min() == 0
        ):  # two roots meet, of which the sweep looks between the airspeeds too
            found = np.sort(found, axis=2)
        else:
            told_apart += 1
        np.testing.assert_allclose(*found, rtol=1e-9, atol=1e-9)
        assert live.reason.tolist() == exact.reason.values.tolist()
    assert told_apart >= 6


@pytest.mark.parametrize("changed", [{"pitch": "rigid"}, {"airloads": "none"}, {"rotor_speed": "constant"}])
def test_switches_are_those_of_sweep(case, speeds, changed):
    live, exact = live_modes(case, speeds, **changed), case.sweep(speeds, **changed)
    assert live.names == exact.mode.values.tolist()
    np.testing.assert_allclose(live.eigenvalue, exact.eigenvalue.values, rtol=1e-9, atol=1e-9)


def test_the_flutter_speed_is_near_the_exact_one(case, speeds):
    onset, exact = live_modes(case, speeds).flutter, case.flutter_point()
    assert onset.mode == exact.mode == "chord"
    assert onset.start == pytest.approx(exact.speed, abs=1.0)


def test_failed_points_keep_their_reason(case):
    found = live_modes(case, np.linspace(300, 800, 11) * KT)
    failed = found.reason != ""
    assert 0 < failed.sum() < 11
    assert np.isnan(found.eigenvalue[failed]).all() and np.isfinite(found.eigenvalue[~failed]).any()


def test_where_nothing_works_there_is_no_mode(case):
    found = live_modes(case, np.array([780.0, 800.0]) * KT)
    assert found.names == [] and found.flutter is None and (found.reason != "").all()


def test_lines_are_in_the_units_of_the_axes(case, speeds):
    found = live_modes(case, speeds)
    columns = curves(found, 48.0, KT)
    chord = columns["mode"].index("chord")
    value = found.eigenvalue[:, chord]
    np.testing.assert_allclose(columns["damping"][chord], -100 * value.real / abs(value), rtol=1e-5)
    np.testing.assert_allclose(columns["frequency"][chord], abs(value.imag) / 48, rtol=1e-5)
    np.testing.assert_allclose(columns["airspeed"][chord], speeds / KT, rtol=1e-6)
    assert columns["width"][chord] > columns["width"][columns["mode"].index("regressive flap")]
    styles = list(zip(columns["colour"], columns["dash"], strict=True))
    assert len(set(styles)) == len(styles)


# Sliders ------------------------------------------------------------------------------------------------------------


def test_a_line_is_broken_where_its_name_leaps_to_another_root(case):
    """As in a plot of the same sweep: near 380 kt regressive lag passes from 8 % of critical to 80 %."""
    speeds = np.arange(350, 401, 5) * KT
    found = live_modes(case, speeds)
    columns = curves(found, 48.0, KT)
    sweep = case.sweep(speeds)
    leaping = leaps(sweep)
    assert leaping.any()
    for place, mode in enumerate(found.names):
        of_sweep = sweep.mode.values.tolist().index(mode)
        gaps = columns["airspeed"][place][np.isnan(columns["damping"][place])]
        between = speeds[np.flatnonzero(leaping[:, of_sweep])] / KT + 2.5
        np.testing.assert_allclose(gaps, between, rtol=1e-6, err_msg=mode)


@pytest.mark.parametrize("name", pp.list_cases())
def test_every_input_of_every_deck_has_a_slider_that_holds_its_value(name):
    case = pp.load_case(name)
    assert 4 <= len(first_inputs(case)) <= 13
    for path, number in pp.design_inputs(case).items():
        slider = slider_input(case, path)
        assert slider.low <= slider.value <= slider.high and slider.low < slider.high, path
        assert slider.value * slider.factor == pytest.approx(float(number.si), rel=1e-9), path
        assert 100 <= (slider.high - slider.low) / slider.step <= 250, path
        assert slider.meaning, path


def test_an_unknown_input_is_told(case):
    with pytest.raises(pp.InputError, match=r"did you mean rotor\.precone"):
        slider_input(case, "rotor.precon")


# Decks --------------------------------------------------------------------------------------------------------------


def test_the_saved_deck_is_what_was_set(case, tmp_path):
    values = {
        "rotor.precone": 1.5 * DEG,
        CHORD: 0.8 * case.operation.rotor_speed,
        "rotor.gimbal_stiffness": 2e4,
    }
    text = altered_deck("xv15-uncoupled", case, values, {}, options(pitch="coupling"))
    place = tmp_path / "found.toml"
    place.write_text(text, encoding="utf-8")
    saved = pp.load_case(place)
    assert tomllib.loads(text)["base"] == "xv15-uncoupled"
    assert "--pitch coupling" in text
    for path, value in values.items():
        assert saved.sources[path].si == pytest.approx(value, rel=1e-10)
        assert saved.sources[path].status == "assumed"
    others = set(case.sources) - set(values)
    assert all(saved.sources[path] == case.sources[path] for path in others)
    want = case.vary(values).sweep("300 kt", pitch="coupling").eigenvalue
    np.testing.assert_allclose(saved.sweep("300 kt", pitch="coupling").eigenvalue, want, rtol=1e-7, atol=1e-7)


def test_fields_set_on_the_command_line_are_saved_too(tmp_path):
    settings = {"rotor.control_stiffness": "9000 ft*lbf/rad", "rotor.precone": "1 deg"}
    case = pp.load_case("xv15-uncoupled", settings)
    place = tmp_path / "found.toml"
    place.write_text(
        altered_deck("xv15-uncoupled", case, {"rotor.precone": 2 * DEG}, settings), encoding="utf-8"
    )
    saved = pp.load_case(place)
    assert saved.rotor.precone == pytest.approx(2 * DEG)
    assert saved.rotor.control_stiffness == case.rotor.control_stiffness


# The page without a browser -----------------------------------------------------------------------------------------


@pytest.fixture
def page(case):
    made = ExplorePage(case, "xv15-uncoupled", scan_speeds(case, 20), {}, options())
    made.put_on(Document())
    return made


def test_moving_a_slider_moves_what_is_drawn_and_told(page, case):
    before = page.drawings.lines.data["damping"][1].copy()
    page.inputs.sliders["rotor.precone"].value = 4.0
    page.update()
    wanted = live_modes(case, page.chosen.airspeeds, {"rotor.precone": 4 * DEG})
    assert f"{wanted.flutter.start / KT:.1f} KTAS ({wanted.flutter.mode})" in page.readout.text
    assert "precone 4 deg (deck 2.5)" in page.readout.text
    assert not np.array_equal(before, page.drawings.lines.data["damping"][1])
    page._reset()
    np.testing.assert_array_equal(before, page.drawings.lines.data["damping"][1])
    assert page.chosen.values == {} and "as in the deck" in page.readout.text


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("rotor.radius = -1 ft", "must be above zero"),
        ("rotor.precone = 3 kg", "must be an angle"),
        ("rotor.precon = 3 deg", "did you mean rotor.precone"),
        ("<script> = 3 deg", "&lt;script&gt;"),
        ("nonsense", "unknown"),
        ("rotor.precone = 1:3:1 deg", "must be one number"),
        ("rotor.precone", "must be a number and a unit"),
        (f"{COUPLING} = 95 deg", "must lie within 90 deg"),
        ("rotor.frequencies.flap = 1/rev", "rotor.frequencies.flap"),
    ],
)
def test_what_cannot_be_is_told_on_the_page(page, text, told):
    drawn = page.drawings.lines.data
    page.inputs.exact.value = text
    page.update() if page.chosen.values else None
    assert "Cannot be" in page.message.text and told in page.message.text
    assert page.drawings.lines.data is drawn or page.drawings.lines.data == drawn
    page._reset()
    page.inputs.sliders["rotor.precone"].value = 2.0
    page.update()
    assert page.message.text == "" and "precone 2 deg" in page.readout.text


def test_a_value_is_set_exactly(page, case):
    page.inputs.exact.value = "support.modes[chord].frequency = 0.9/rev"
    assert page.chosen.values[CHORD] == pytest.approx(0.9 * case.operation.rotor_speed)
    page.inputs.exact.value = "rotor.control_stiffness = 40000 ft*lbf/rad"
    assert page.inputs.sliders["rotor.control_stiffness"].end == pytest.approx(40000)


@pytest.mark.parametrize(
    ("text", "path", "value"),
    [
        ("rotor.pitch_gimbal_coupling = -12 deg", "rotor.pitch_gimbal_coupling", np.tan(-12 * DEG)),
        (f"{COUPLING} = 10 deg", COUPLING, np.tan(10 * DEG)),
        (f"{COUPLING} = 0.2", COUPLING, 0.2),
        (f"{CHORD} = 42 rad/s", CHORD, 42.0),
        (f"{CHORD} = 6 Hz", CHORD, 12 * np.pi),
    ],
)
def test_a_value_is_read_as_in_a_deck_which_may_leave_the_input_out(page, case, text, path, value, tmp_path):
    page.inputs.exact.value = text
    page.update()
    assert page.message.text == ""
    assert page.chosen.values == {path: pytest.approx(value, rel=1e-12)}
    assert path in page.inputs.choice.value and path in page.inputs.choice.options
    wanted = live_modes(case, page.chosen.airspeeds, {path: value})
    assert f"{wanted.flutter.start / KT:.1f} KTAS" in page.readout.text
    place = tmp_path / "found.toml"
    place.write_text(altered_deck("xv15-uncoupled", case, page.chosen.values), encoding="utf-8")
    assert pp.load_case(place).given[path].si == pytest.approx(value, rel=1e-10)


def test_a_switch_of_the_model_is_that_of_the_engine(page, case):
    page.switches["pitch"].value = "rigid"
    page.update()
    wanted = live_modes(case, page.chosen.airspeeds, pitch="rigid")
    assert page.drawings.lines.data["mode"] == wanted.names


# The command and the server -----------------------------------------------------------------------------------------


def test_without_bokeh_one_message_says_what_to_install(monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "bokeh", None)
    result = CliRunner().invoke(main, ["explore", "xv15-uncoupled"])
    assert result.exit_code == 2
    assert 'pip install "proprotor[explore]"' in result.stderr


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("xv16",), "did you mean xv15?"),
        (("xv15-uncoupled", "--speed", "300 kt"), "must be a range"),
        (("xv15-uncoupled", "--set", "rotor.radius=-1 ft"), "rotor.radius"),
    ],
)
def test_an_unusable_input_is_one_message(arguments, told):
    result = CliRunner().invoke(main, ["explore", *arguments])
    assert result.exit_code == 2 and told in result.stderr


def test_a_port_that_is_taken_is_one_message():
    import socket

    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        result = CliRunner().invoke(main, ["explore", "xv15-uncoupled", "--port", port, "--no-browser"])
    assert result.exit_code == 1 and f"--port = {port}" in result.stderr


def status(address, host, **headers):
    headers = {name.replace("_", "-"): value for name, value in headers.items()}
    request = urllib.request.Request(address, headers={"Host": host, **headers})
    try:
        with urllib.request.urlopen(request, timeout=30) as answer:
            assert "Access-Control-Allow-Origin" not in answer.headers
            return answer.status
    except urllib.error.HTTPError as error:
        assert "Access-Control-Allow-Origin" not in error.headers
        error.close()
        return error.code


async def handshake(address, origin):
    """What a websocket from a page of some origin is answered."""
    url = address.replace("http", "ws") + "ws"
    try:
        opened = await websocket_connect(HTTPRequest(url, headers={"Origin": origin}))
    except HTTPClientError as error:
        return error.code
    opened.close()
    while await opened.read_message() is not None:
        pass  # until the server has closed as well, and with it the socket
    return 101


def test_the_server_answers_this_machine_alone():
    with serving("xv15-uncoupled") as address:
        assert address.startswith("http://127.0.0.1:")
        own = address.removeprefix("http://").rstrip("/")
        port = own.rpartition(":")[2]
        assert status(address, own) == status(address, f"localhost:{port}") == 200
        assert status(address, f"evil.example:{port}") == status(address, "127.0.0.1:1") == 403
        assert asyncio.run(handshake(address, "http://evil.example")) == 403
        assert asyncio.run(handshake(address, f"http://{own}")) == 101
        for place in ("", "metadata", "static/js/bokeh.min.js"):
            for name in (own, f"localhost:{port}"):
                assert status(address + place, name) == 200
                assert status(address + place, name, Origin=f"http://{name}") == 200
                assert status(address + place, name, Sec_Fetch_Site="same-origin") == 200
        # Every place, to whoever is of another name, origin or site: another port of this machine is one too.
        element = "?bokeh-autoload-element=x&bokeh-app-path=/&bokeh-absolute-url=" + address
        for place in ("", "metadata", "static/js/bokeh.min.js", "ws", f"autoload.js{element}"):
            assert status(address + place, f"evil.example:{port}") == 403
            assert status(address + place, "localhost") == 403
            for origin in (
                "http://evil.example",
                f"https://{own}",
                f"http://localhost:{int(port) + 1}",
                "null",
            ):
                assert status(address + place, own, Origin=origin) == 403
            assert status(address + place, own, Sec_Fetch_Site="cross-site") == 403
            assert status(address + place, own, Sec_Fetch_Site="same-site") == 403
        # A foreign page's <script> sends no origin, and an old browser no site.
        for place in (f"autoload.js{element}", f"autoloadXjs{element}"):
            assert status(address + place, own) == 403
