"""How fast and how long the page of `proprotor explore` follows its sliders in a real Chromium.

OPENBLAS_NUM_THREADS=1 python -m benchmarks.explore_browser [--moves 1000] [--minutes 60] [--clients 1]
    [--backend compiled]

Each move sets a slider in the browser and waits until the page has drawn the new curves: the way to the server and
back, the analysis, and the drawing. Every tenth move also waits for the stability map. Times are those of a clock, so
that other programs on the machine count in; processor times stand beside them. Memory is what the page's scripts hold
after their garbage was collected, and what the server's process holds; nodes of the page and its listeners to events
are counted as well. A row is printed after each part of the moves. The moves end by themselves after the minutes given,
and what was measured till then is told. A move that is not answered within ten seconds is counted, and the next one
made.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import psutil
from selenium import webdriver

from tests.browser.chromium import chromium
from tests.explore_server import serving

_BATCH = 1000  # moves of one call of the browser
_ROW = 1000  # moves between two rows that are printed
_FIRST = 50  # moves before anything is measured
_DIGITS = (1, 0, 0, 1, 0, 0, 1)  # of the columns of a row
# Of each call the page keeps 16 kB, the text of a script of the driver: so one call makes many moves.
_MOVES = """
window.moveSliders = (seed, moves, done) => {
const LONGEST = 10000;
const page = Bokeh.documents[0], find = (name) => page.get_model_by_name(name);
const lines = find("lines"), boundary = find("boundary"), curves = [], maps = [];
const sliders = [...find("sliders").children].filter((one) => one.type === "Slider");
let state = seed;
const random = () => (state = (state * 48271) % 2147483647) / 2147483647;
const drawn = (source, longest) => new Promise((resolve) => {
  const ended = (answered) => {
    clearTimeout(limit);
    source.properties.data.change.disconnect(changed);
    resolve(answered);
  };
  const changed = () => {
    source.properties.data.change.disconnect(changed);
    requestAnimationFrame(() => setTimeout(() => ended(true)));
  };
  const limit = setTimeout(() => ended(false), longest);
  source.properties.data.change.connect(changed);
});
(async () => {
  let lost = 0;
  for (let move = 0; move < moves; move++) {
    const slider = sliders[Math.floor(random() * sliders.length)];
    const part = 0.3 + 0.4 * random(), value = slider.start + part * (slider.end - slider.start);
    if (value === slider.value) continue; // no change, and no answer
    const start = performance.now(), after_curves = drawn(lines, LONGEST);
    const after_map = move % 10 === 0 ? drawn(boundary, LONGEST) : null;
    slider.value = value;
    if (await after_curves) curves.push(performance.now() - start);
    else lost++;
    if (after_map && (await after_map)) maps.push(performance.now() - start);
  }
  done([curves, maps, lost]);
})();
};
"""


_CALL = "moveSliders(...arguments)"


@dataclass
class Times:
    """Milliseconds until the curves, and until the map, of each move, and how many moves were not answered."""

    curves: list[float] = field(default_factory=list)
    maps: list[float] = field(default_factory=list)
    lost: int = 0

    def add(self, curves: list[float], maps: list[float], lost: int) -> None:
        """Add the times of other moves."""
        self.curves += curves
        self.maps += maps
        self.lost += lost


def moved(driver: Any, moves: int, seed: int, end: float = np.inf) -> Times:
    """The times of moves in a browser, which stop at an end, in seconds of `time.monotonic`."""
    driver.set_script_timeout(1200)
    times = Times()
    for batch in range(0, moves, _BATCH):
        if time.monotonic() > end:
            break
        times.add(*driver.execute_async_script(_CALL, seed + batch, min(_BATCH, moves - batch)))
    return times


def heap(driver: Any) -> float:
    """MB that the scripts of the page hold."""
    driver.execute_cdp_cmd("HeapProfiler.collectGarbage", {})
    return metric(driver, "JSHeapUsedSize") / 1e6


def metric(driver: Any, name: str) -> float:
    """A number that the browser keeps about its page."""
    metrics = driver.execute_cdp_cmd("Performance.getMetrics", {})["metrics"]
    return float(next(one["value"] for one in metrics if one["name"] == name))


def opened(address: str) -> webdriver.Chrome:
    """A browser with the page."""
    driver = chromium(tempfile.mkdtemp())
    driver.get(address)
    driver.execute_cdp_cmd("Performance.enable", {})
    made = "typeof Bokeh != 'undefined' && Bokeh.documents.length"
    while not driver.execute_script(f"return {made} && !!Bokeh.documents[0].get_model_by_name('lines')"):
        time.sleep(0.2)
    time.sleep(3)
    driver.execute_script(_MOVES)
    return driver


def _line(name: str, times: list[float]) -> str:
    if not times:
        return f"{name:<24}{'none':>8}"
    return f"{name:<24}{np.median(times):>8.0f}{np.percentile(times, 95):>8.0f}{max(times):>8.0f}"


def all_moved(drivers: list[Any], moves: int, seed: int, end: float = np.inf) -> Times:
    """The times of `moved` of several browsers that move their sliders at once."""
    with ThreadPoolExecutor(len(drivers)) as pool:
        seeds = [1000 * place + seed for place in range(len(drivers))]
        parts = list(pool.map(lambda driver, own: moved(driver, moves, own, end), drivers, seeds))
    times = Times()
    for part in parts:
        times.add(part.curves, part.maps, part.lost)
    return times


def spent_by(process: psutil.Process) -> float:
    """Seconds of the processor that a process and those that it has started took."""
    return sum(sum(one.cpu_times()[:2]) for one in (process, *process.children(recursive=True)))


def measured(drivers: list[Any], server: psutil.Process, moves: int, end: float) -> Times:
    """Move all sliders, and tell after each part of the moves what is held and how long the part took.

    Parameters
    ----------
    drivers : list
        Browsers.
    server : psutil.Process
    moves : int
        Of each browser.
    end : float
        s of `time.monotonic`, after which nothing more is moved.
    """
    heads = ("page, MB", "nodes", "listeners", "server, MB", "median, ms", "95 %, ms", "load")
    print(f"{'moves':>8}" + "".join(f"{head:>12}" for head in heads))
    times, done, part = Times(), 0, Times()
    while True:
        held = [heap(drivers[0]), *(metric(drivers[0], name) for name in ("Nodes", "JSEventListeners"))]
        spent = [np.median(part.curves), np.percentile(part.curves, 95)] if part.curves else [np.nan] * 2
        row = zip(
            (*held, server.memory_info().rss / 1e6, *spent, psutil.getloadavg()[0]), _DIGITS, strict=True
        )
        print(f"{done:>8}" + "".join(f"{value:>12.{digits}f}" for value, digits in row), flush=True)
        if done >= moves or time.monotonic() > end:
            return times
        some = min(_ROW, moves - done)
        part = all_moved(drivers, some, done + 1, end)
        done += (len(part.curves) + part.lost) // len(drivers)
        times.add(part.curves, part.maps, part.lost)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--moves", type=int, default=1000)
    parser.add_argument("--minutes", type=float, default=np.inf, help="the moves end after these")
    parser.add_argument("--clients", type=int, default=1)
    parser.add_argument("--backend", default="compiled")
    parser.add_argument("--case", default="xv15-uncoupled")
    parser.add_argument("--speed", default="", help="airspeeds of the page, as of the command")
    chosen = parser.parse_args()
    airspeeds = ("--speed", chosen.speed) if chosen.speed else ()
    with serving(chosen.case, "--backend", chosen.backend, *airspeeds) as address:
        server = next(one for one in psutil.Process().children() if "explore" in one.cmdline())
        drivers = [opened(address) for _ in range(chosen.clients)]
        browsers = [psutil.Process(driver.service.process.pid) for driver in drivers]
        all_moved(drivers, _FIRST, 7)
        print(f"{chosen.case}, {chosen.backend}, {chosen.clients} clients, load {psutil.getloadavg()[0]:.1f}")
        start, started = spent_by(server), sum(map(spent_by, browsers))
        styles = metric(drivers[0], "RecalcStyleCount")
        times = measured(drivers, server, chosen.moves, time.monotonic() + 60 * chosen.minutes)
        print(f"{'ms of the clock':<24}{'median':>8}{'95 %':>8}{'most':>8}")
        print(_line("until the curves", times.curves))
        print(_line("until the map", times.maps))
        count = len(times.curves) + times.lost
        print(f"{count} moves, of which {times.lost} were not answered within 10 s")
        server_s, browser_s = spent_by(server) - start, sum(map(spent_by, browsers)) - started
        print(
            f"ms of the processor for each move, map included: server {1e3 * server_s / count:.0f}, "
            f"browser {1e3 * browser_s / count:.0f}"
        )
        computed = (metric(drivers[0], "RecalcStyleCount") - styles) * len(drivers) / count
        print(f"styles computed {computed:.1f} times for each move")
        for driver in drivers:
            driver.quit()


if __name__ == "__main__":
    main()
