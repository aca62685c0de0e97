"""The map, the comparison with the deck, and the files of the explorer: each against the engine or another program."""

import base64
import io
import re
import tomllib
from xml.etree import ElementTree

import numpy as np
import pandas
import pytest
from bokeh.document import Document
from bokeh.events import ButtonClick
from PIL import Image

import proprotor as pp
from proprotor.explore.analysis import live_modes
from proprotor.explore.controls import GRIDS
from proprotor.explore.growth_plane import growth_plane
from proprotor.explore.inputs import map_axis
from proprotor.explore.page import ExplorePage
from proprotor.rotor.options import CHOICES, Options
from proprotor.stability.boundaries import scan_speeds

KT = 1852 / 3600
DEG = np.pi / 180
CONTROL = "rotor.control_stiffness"


def whole(steps):
    """What a generator returns, after all of its steps."""
    while True:
        try:
            next(steps)
        except StopIteration as end:
            return end.value


def options(**changed):
    chosen = vars(Options(**changed))
    return {name: chosen[name] for name in (*CHOICES, "locked")}


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


@pytest.fixture
def page(case):
    made = ExplorePage(case, "xv15-uncoupled", scan_speeds(case, 20), {}, options())
    made.map.grid.value = "coarse"
    made.put_on(Document())
    made.map.draw()
    return made


# The map ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("axes", "airspeed"),
    [
        ({"airspeed": np.linspace(250, 450, 11) * KT, "rotor.precone": np.linspace(0, 5, 6) * DEG}, None),
        ({"rotor.precone": np.linspace(0, 5, 6) * DEG, CONTROL: np.linspace(5e3, 2e4, 8)}, 390 * KT),
        ({"rotor.precone": np.linspace(0, 5, 6) * DEG, "airspeed": np.linspace(250, 450, 7) * KT}, None),
    ],
)
def test_the_plane_is_that_of_the_map_with_other_inputs(case, axes, airspeed):
    values = {
        "rotor.gimbal_stiffness": 2e4,
        "rotor.precone": 0.1,
    }  # the second is an axis, so its value is left out
    plane = whole(growth_plane(case, axes, airspeed, values, {"pitch": "coupling"}))
    exact = case.vary({"rotor.gimbal_stiffness": 2e4}).stability_map(
        axes, airspeed=airspeed, pitch="coupling"
    )
    assert (np.isfinite(plane.growth)).all() and (plane.growth > 0).any() and (plane.growth < 0).any()
    np.testing.assert_allclose(plane.growth, exact.growth, rtol=1e-9, atol=1e-9)


def test_the_interpolated_boundary_is_near_the_exact_one(case):
    """Each airspeed of the boundary within half a step of the grid, 10 kt, of the boundary search at its precone."""
    axes = {"airspeed": np.linspace(250, 450, 21) * KT, "rotor.precone": np.linspace(1.5, 4, 6) * DEG}
    plane = whole(growth_plane(case, axes, None))
    vertices = np.concatenate(plane.boundary)
    on_lines = vertices[np.isclose(vertices[:, 1][:, None], axes["rotor.precone"]).any(axis=1)]
    assert len(on_lines) >= 5
    for speed, precone in on_lines:
        exact = case.vary({"rotor.precone": precone}).flutter_point("250:450:10kt").speed
        assert speed == pytest.approx(exact, abs=5 * KT)


def test_failed_points_of_the_plane_have_a_reason_and_spoil_no_other(case):
    axes = {"airspeed": np.linspace(300, 800, 6) * KT, "rotor.precone": np.linspace(1, 3, 3) * DEG}
    plane = whole(growth_plane(case, axes, None))
    failed = np.isnan(plane.growth)
    assert failed.any() and not failed.all()
    assert ((plane.reason != "") == failed).all()


@pytest.mark.parametrize(
    ("axes", "told"),
    [
        ({"airspeed": np.ones(2)}, "two different"),
        ({"rotor.precone": np.ones(2), CONTROL: np.ones(2)}, "airspeed"),
    ],
)
def test_axes_that_cannot_be_are_told(case, axes, told):
    with pytest.raises(pp.InputError, match=told):
        whole(growth_plane(case, axes, None))


def test_the_answer_comes_in_parts(case):
    axes = {"airspeed": np.linspace(100, 200, 31), "rotor.precone": np.linspace(0, 0.1, 21)}
    assert sum(1 for _ in growth_plane(case, axes, None)) >= 3


def test_the_map_follows_the_settings_and_keeps_the_boundary_of_the_deck(page):
    boundary, deck = page.drawings.boundary, page.drawings.deck_boundary
    first = [line.copy() for line in boundary.data["x"]]
    np.testing.assert_array_equal(first[0], deck.data["x"][0])
    page.inputs.sliders[CONTROL].value *= 1.2
    page.update()
    page.map.draw()
    np.testing.assert_array_equal(first[0], deck.data["x"][0])
    assert not np.array_equal(first[0], boundary.data["x"][0])
    page.compare.active = False
    page.update()
    page.map.draw()
    assert len(deck.data["x"]) == len(page.drawings.deck.data["airspeed"]) == 0


def test_the_cross_stands_on_the_boundary_at_the_flutter_speed(page):
    """With airspeed across and precone up, it must: both are the same boundary."""
    page.inputs.sliders["rotor.precone"].value = 3.0
    page.update()
    page.map.draw()
    x, y = (page.drawings.here.data[name][0] for name in "xy")
    assert y == pytest.approx(3.0)
    found = live_modes(page.case, page.chosen.airspeeds, {"rotor.precone": 3 * DEG})
    assert x == pytest.approx(found.flutter.start / KT)
    lines = [
        np.column_stack(line)
        for line in zip(*(page.drawings.boundary.data[name] for name in "xy"), strict=True)
    ]
    assert min(np.abs(np.concatenate(lines) - (x, y)).max(axis=1)) < 10


def test_two_equal_axes_are_told_on_the_page_and_other_axes_end_it(page):
    page.map.x.value = "rotor.precone"
    page.map.draw()
    assert "Cannot be" in page.map.message.text and "two different inputs" in page.map.message.text
    page.map.y.value = CONTROL
    page.map.draw()
    assert "Cannot be" not in page.map.message.text and page.map.at.visible
    assert " KTAS" in page.drawings.map.title.text


def test_points_of_the_map_that_failed_are_counted_on_the_page(page):
    page.inputs.exact.value = "airspeed = 300:800:50kt"
    page.update()
    page.map.draw()
    columns, rows = GRIDS["coarse"]
    assert f"of {columns * rows} points (grey)" in page.map.message.text
    assert "Not analysed at" in page.message.text


def test_an_axis_reaches_a_value_beyond_its_slider(case):
    axis = map_axis(case, "rotor.precone", np.array([100.0, 200.0]), 30 * DEG, 5)
    assert axis.values[-1] == pytest.approx(30 * DEG) and axis.label == "precone (deg)"


# Airspeeds, and the deck beside -------------------------------------------------------------------------------------


def test_airspeeds_are_those_of_the_slider_and_of_the_line(page):
    page.inputs.range.value = (200, 300)
    page.update()
    assert page.drawings.lines.data["airspeed"][0][[0, -1]].tolist() == pytest.approx([200, 300])
    assert page.drawings.across.start == pytest.approx(200) and page.drawings.across.end == pytest.approx(300)
    page.inputs.exact.value = "airspeed = 100:200:20 keas"
    page.update()
    density = page.case.operation.density
    assert page.chosen.airspeeds[0] == pytest.approx(100 * KT * np.sqrt(1.225 / density))
    assert len(page.chosen.airspeeds) == 6
    page.inputs.exact.value = "airspeed = 300 kt"
    assert "must be a range" in page.message.text
    page._reset()
    np.testing.assert_array_equal(page.chosen.airspeeds, scan_speeds(page.case, 20))
    assert len(page.drawings.deck.data["airspeed"][0]) >= 20


def test_the_curves_of_the_deck_stay_while_others_move(page):
    before = [line.copy() for line in page.drawings.deck.data["damping"]]
    np.testing.assert_array_equal(before[1], page.drawings.lines.data["damping"][1])
    page.inputs.sliders["rotor.precone"].value = 1.0
    page.switches["pitch"].value = "rigid"
    page.update()
    np.testing.assert_array_equal(before[1], page.drawings.deck.data["damping"][1])
    assert "the deck" in page.legend.text


def test_the_modes_are_a_table_as_well(page):
    page.inputs.range.value = (300, 390)
    page.update()
    chord = page.case.sweep(page.chosen.airspeeds).damping_ratio.sel(mode="chord").values
    row = re.search(r">chord</th><td[^>]*>(.*?)</td><td[^>]*>(.*?)</td>", page.modes.text)
    assert float(row[1]) == pytest.approx(100 * chord.min(), abs=0.006)
    assert float(row[2]) == pytest.approx(page.chosen.airspeeds[chord.argmin()] / KT, abs=0.06)


# Files --------------------------------------------------------------------------------------------------------------


def saved(page, title):
    """The name and the content of a file, as the browser gets them."""
    button = next(one for one in page.saves.buttons.children if one.label == title)
    button._trigger_event(ButtonClick(button))
    data = page.saves.file.data
    return data["name"][0], base64.b64decode(data["content"][0])


def test_the_numbers_of_the_curves_are_those_of_a_sweep_of_the_saved_deck(page, tmp_path):
    page.inputs.sliders["rotor.precone"].value = 1.5
    page.inputs.exact.value = "airspeed = 300:400:20kt"
    name, deck = saved(page, "Deck (TOML)")
    (tmp_path / name).write_bytes(deck)
    assert tomllib.loads(deck.decode())["base"] == "xv15-uncoupled"
    again = pp.load_case(tmp_path / name).sweep("300:400:20kt")
    name, text = saved(page, "Curves (CSV)")
    assert name == "xv15-uncoupled-explored.csv"
    table = pandas.read_csv(io.BytesIO(text), comment="#")
    chord = table[table["mode"] == "chord"]
    wanted = 100 * again.damping_ratio.sel(mode="chord").values
    np.testing.assert_allclose(chord["damping (% of critical)"], wanted, rtol=1e-7)
    assert text.startswith(b"# ")  # says where it comes from


def test_every_picture_opens(page):
    page.inputs.exact.value = "airspeed = 300:400:20kt"
    for title in ("Frequency and damping", "Root locus", "Map"):
        name, content = saved(page, f"{title} (PNG)")
        picture = Image.open(io.BytesIO(content))
        assert (
            name.endswith(".png")
            and picture.format == "PNG"
            and len(np.unique(np.asarray(picture.convert("L")))) > 30
        )
        name, content = saved(page, f"{title} (SVG)")
        assert name.endswith(".svg") and ElementTree.fromstring(content).tag.endswith("svg")


def test_a_picture_leaves_what_matplotlib_draws_with_as_it_was(page):
    import matplotlib

    before = matplotlib.get_backend()
    matplotlib.use("svg")
    try:
        saved(page, "Root locus (PNG)")
        assert matplotlib.get_backend().lower() == "svg"
    finally:
        matplotlib.use(before)


def test_what_cannot_be_saved_is_told(page):
    page.chosen.values["rotor.radius"] = -1.0
    button = next(one for one in page.saves.buttons.children if one.label == "Curves (CSV)")
    button._trigger_event(ButtonClick(button))
    assert "rotor.radius" in page.message.text and "Nothing was saved." in page.message.text
    assert "content" not in page.saves.file.data
