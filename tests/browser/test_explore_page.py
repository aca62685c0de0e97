"""The explorer in a real browser: a slider is moved with the keyboard, and the page shows what the engine says.

Needs Chromium and its driver; `make test-browser` runs this and tells where they are missing.
"""

import re
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

PRECONE = "rotor.precone"
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


def test_the_page_fits_a_small_screen_and_says_nothing_to_the_console(page):
    wide, seen = page.execute_script(
        "return [document.documentElement.scrollWidth, document.documentElement.clientWidth];"
    )
    assert wide <= seen
    assert [one for one in page.get_log("browser") if one["level"] == "SEVERE"] == []
    assert page.title
