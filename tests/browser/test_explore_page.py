"""The explorer in a real browser: a slider is moved with the keyboard, and the page shows what the engine says.

Needs Chromium and its driver; `make test-browser` runs this and tells where they are missing.
"""

import re
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

import proprotor as pp
from proprotor.explore.analysis import live_modes
from proprotor.stability.boundaries import scan_speeds
from tests.browser.chromium import CHROMIUM, DRIVER, chromium
from tests.explore_server import serving

PRECONE, STIFFNESS = "rotor.precone", "rotor.control_stiffness"
KNOT = 1852 / 3600
MODEL = "const model = Bokeh.documents[0].get_model_by_name(arguments[0]);"


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    if not (CHROMIUM and DRIVER):
        pytest.fail("needs Chromium and its driver: on Debian `apt-get install chromium chromium-driver`")
    downloads = tmp_path_factory.mktemp("downloads")
    driver = chromium(str(tmp_path_factory.mktemp("profile")), str(downloads))
    driver.downloads = downloads
    yield driver
    driver.quit()


@pytest.fixture
def page(browser):
    with serving("xv15-uncoupled") as address:
        browser.get(address)
        wait(browser, lambda: "Flutter speed" in readout(browser))
        yield browser
        browser.get("about:blank")  # or the page would call for its server after that has ended


def wait(browser, condition):
    return WebDriverWait(browser, 30).until(lambda _: condition())


def readout(browser):
    script = "return typeof Bokeh == 'undefined' || !Bokeh.documents.length ? '' : "
    return browser.execute_script(
        script + "Bokeh.documents[0].get_model_by_name('readout')?.text ?? ''",
    )


def damping(browser):
    script = (
        "const lines = Bokeh.documents[0].get_model_by_name('lines');"
        "return Array.from(lines.get_column('damping')[arguments[0]]);"
    )
    return np.array(browser.execute_script(script, 1))


def focus(browser, name):
    """The handle of a slider, by the name of its model, with the keyboard on it."""
    script = (
        MODEL
        + """
      const view = [...Bokeh.index.all_views()].find((one) => one.model === model);
      const handle = view.shadow_el.querySelector(".noUi-handle");
      handle.focus();
      return handle;"""
    )
    return browser.execute_script(script, name)


def told_speed(browser):
    return float(re.search(r"Flutter speed ([\d.]+) KTAS", readout(browser))[1])


def test_a_slider_moved_with_the_keyboard_moves_curves_and_readout(page):
    case = pp.load_case("xv15-uncoupled")
    speeds = scan_speeds(case, 60)
    deck = live_modes(case, speeds).flutter
    assert told_speed(page) == pytest.approx(deck.start / KNOT, abs=0.06)
    before = damping(page)
    handle = focus(page, PRECONE)
    for _ in range(10):
        handle.send_keys(Keys.ARROW_RIGHT)
    wait(page, lambda: "Changed: " in readout(page))
    time.sleep(1)  # moves that came together are told together
    value = page.execute_script(MODEL + "return model.value;", PRECONE)
    assert value > 2.5
    moved = live_modes(case, speeds, {PRECONE: np.deg2rad(value)})
    assert moved.flutter.start != pytest.approx(deck.start, abs=0.1 * KNOT)
    wait(page, lambda: told_speed(page) == pytest.approx(moved.flutter.start / KNOT, abs=0.06))
    place = moved.names.index("chord")
    after = damping(page)
    assert not np.allclose(before, after, equal_nan=True)
    np.testing.assert_allclose(after, moved.damping[:, place], rtol=1e-4, atol=1e-4)


def test_what_was_set_is_downloaded_as_a_deck_that_runs(page):
    focus(page, PRECONE).send_keys(Keys.ARROW_LEFT * 5)
    wait(page, lambda: "Changed: " in readout(page))
    time.sleep(1)
    value = page.execute_script(MODEL + "return model.value;", PRECONE)
    page.execute_script(
        MODEL
        + """
      const view = [...Bokeh.index.all_views()].find((one) => one.model === model);
      view.shadow_el.querySelector("button").click();""",
        "save Deck (TOML)",
    )
    saved = Path(page.downloads, "xv15-uncoupled-explored.toml")
    wait(page, saved.exists)
    case = pp.load_case(saved)
    assert np.rad2deg(case.rotor.precone) == pytest.approx(value)
    assert case.sources[PRECONE].status == "assumed"


def fits(browser):
    wide, seen = browser.execute_script(
        "return [document.documentElement.scrollWidth, document.documentElement.clientWidth];"
    )
    return wide <= seen


def columns_of_plots(browser):
    script = """const plots = Bokeh.documents[0].get_model_by_name("plots");
      const view = Bokeh.index.find_one(plots);
      return view.child_views.map((one) => Math.round(one.el.getBoundingClientRect().left));"""
    return len(set(browser.execute_script(script)))


def test_the_page_fits_screens_of_all_widths_and_says_nothing_to_the_console(page):
    assert fits(page)
    for width, columns in ((500, 1), (1280, 2)):
        page.set_window_size(width, 800)
        wait(page, lambda columns=columns: columns_of_plots(page) == columns)
        assert fits(page)
    assert [one for one in page.get_log("browser") if one["level"] == "SEVERE"] == []
    assert page.title


def test_sliders_and_plots_have_names_for_those_who_do_not_see_them(page):
    assert focus(page, PRECONE).get_attribute("aria-label") == "precone (deg)"
    assert focus(page, "airspeed").get_attribute("aria-label") == "Airspeeds (KTAS), lowest"
    script = """return [...Bokeh.index.all_views()].filter((one) => one.model.type === "Figure")
      .map((one) => [one.el.getAttribute("role"), one.el.getAttribute("aria-label")]);"""
    named = page.execute_script(script)
    assert {role for role, _ in named} == {"img"}
    assert {name.partition(":")[0] for _, name in named} >= {"Damping", "Frequency", "Root locus"}


def boundary(browser):
    script = """const source = Bokeh.documents[0].get_model_by_name("boundary");
      return [...source.get_column("x")].map((line) => Array.from(line));"""
    return browser.execute_script(script)


def test_the_map_follows_a_slider(page):
    wait(page, lambda: boundary(page))
    before = boundary(page)
    focus(page, STIFFNESS).send_keys(Keys.ARROW_LEFT * 20)
    wait(page, lambda: boundary(page) != before)
    assert page.execute_script(MODEL + "return model.get_column('x').length;", "deck-boundary") > 0


def style_computations(browser):
    metrics = browser.execute_cdp_cmd("Performance.getMetrics", {})["metrics"]
    return next(one["value"] for one in metrics if one["name"] == "RecalcStyleCount")


def test_a_move_does_not_let_the_browser_compute_its_styles_again_and_again(page):
    """With Bokeh's own way to paint these were 40 in a move, and took half of its time."""
    page.execute_cdp_cmd("Performance.enable", {})
    wait(page, lambda: boundary(page))
    before, moves = style_computations(page), 4
    for place in range(moves):
        told, line = readout(page), boundary(page)
        page.execute_script(MODEL + "model.value = arguments[1];", STIFFNESS, 6000 + 500 * place)
        wait(page, lambda told=told: readout(page) != told)
        wait(page, lambda line=line: boundary(page) != line)
    assert style_computations(page) - before < 20 * moves


def test_bad_input_is_told_in_the_page_which_goes_on(page):
    set_line = MODEL + "model.value = arguments[1];"
    shown = """const message = Bokeh.documents[0].get_model_by_name("message");
      return Bokeh.index.find_one(message).markup_el.textContent;"""
    page.execute_script(set_line, "exact", "airspeed = 300 kg")
    wait(page, lambda: "Cannot be: airspeed" in page.execute_script(shown))
    page.execute_script(set_line, "exact", "airspeed = 300:800:50kt")
    wait(page, lambda: "Not analysed at" in page.execute_script(shown))


def test_readers_have_settings_of_their_own(page, tmp_path):
    """A second browser on the same server starts from the deck, and its slider moves nothing of the first one."""
    focus(page, PRECONE).send_keys(Keys.ARROW_RIGHT * 5)
    value = page.execute_script(MODEL + "return model.value;", PRECONE)
    wait(page, lambda: f"precone {value:.4g} deg" in readout(page))
    mine = readout(page)
    other = chromium(str(tmp_path))
    try:
        other.get(page.current_url)
        wait(other, lambda: "All inputs as in the deck" in readout(other))
        focus(other, STIFFNESS).send_keys(Keys.ARROW_RIGHT * 5)
        wait(other, lambda: "Changed: control stiffness" in readout(other))
        assert "precone" not in readout(other) and readout(page) == mine
    finally:
        other.quit()


NOTEBOOK = """
import asyncio
import proprotor as pp

async def cell():
    page = pp.explore(pp.load_case("xv15-uncoupled"), "300:400:20kt")
    print(page._repr_html_(), flush=True)
    await asyncio.sleep(600)

asyncio.run(cell())
"""


def test_a_notebook_of_another_origin_shows_the_page_in_a_frame(browser, tmp_path):
    (tmp_path / "kernel.py").write_text(NOTEBOOK)
    kernel = subprocess.Popen([sys.executable, tmp_path / "kernel.py"], stdout=subprocess.PIPE, text=True)
    try:
        frame = kernel.stdout.readline()
        (tmp_path / "notebook.html").write_text(f"<html><body>{frame}</body></html>")
        browser.get((tmp_path / "notebook.html").as_uri())
        browser.switch_to.frame(0)
        wait(browser, lambda: "between 300 and 400 KTAS" in readout(browser) or "Flutter" in readout(browser))
    finally:
        browser.switch_to.default_content()
        browser.get("about:blank")
        kernel.terminate()
        kernel.wait(timeout=30)
        kernel.stdout.close()
