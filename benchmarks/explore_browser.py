"""How fast and how long the page of `proprotor explore` follows its sliders in a real Chromium.

OPENBLAS_NUM_THREADS=1 python -m benchmarks.explore_browser [--moves 1000] [--clients 1] [--backend compiled]

Each move sets a slider in the browser and waits until the page has drawn the new curves: the way to the server and
back, the analysis, and the drawing. Every tenth move also waits for the stability map. Times are those of a clock, so
that other programs on the machine count in; processor times stand beside them. Memory is what the page's scripts hold
after their garbage was collected, and what the server's process holds.
"""

from __future__ import annotations

import argparse
import tempfile
import threading
import time
from typing import Any

import numpy as np
import psutil
from selenium import webdriver

from tests.browser.chromium import chromium
from tests.explore_server import serving

_BATCH = 50  # moves of one call of the browser
_MOVES = """
const [seed, moves, done] = arguments;
const page = Bokeh.documents[0], find = (name) => page.get_model_by_name(name);
const lines = find("lines"), boundary = find("boundary"), curves = [], maps = [];
const sliders = [...find("sliders").children].filter((one) => one.type === "Slider");
let state = seed;
const random = () => (state = (state * 48271) % 2147483647) / 2147483647;
const drawn = (source) => new Promise((resolve) => {
  const changed = () => {
    source.properties.data.change.disconnect(changed);
    requestAnimationFrame(() => setTimeout(resolve));
  };
  source.properties.data.change.connect(changed);
});
(async () => {
  for (let move = 0; move < moves; move++) {
    const slider = sliders[Math.floor(random() * sliders.length)];
    const start = performance.now(), after_curves = drawn(lines);
    const after_map = move % 10 === 0 ? drawn(boundary) : null;
    slider.value = slider.start + (0.3 + 0.4 * random()) * (slider.end - slider.start);
    await after_curves;
    curves.push(performance.now() - start);
    if (after_map) {
      await Promise.race([after_map, new Promise((resolve) => setTimeout(resolve, 3000))]);
      maps.push(performance.now() - start);
    }
  }
  done([curves, maps]);
})();
"""


def moved(driver: Any, moves: int, seed: int) -> tuple[list[float], list[float]]:
    """Milliseconds until the curves, and until the map, of each move."""
    driver.set_script_timeout(600)
    curves, maps = [], []
    for batch in range(0, moves, _BATCH):
        some = driver.execute_async_script(_MOVES, seed + batch, min(_BATCH, moves - batch))
        curves += some[0]
        maps += some[1]
    return curves, maps


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
    return driver


def _line(name: str, times: list[float]) -> str:
    return f"{name:<24}{np.median(times):>8.0f}{np.percentile(times, 95):>8.0f}{max(times):>8.0f}"


def all_moved(drivers: list[Any], moves: int, seed: int) -> tuple[list[float], list[float]]:
    """The times of `moved` of several browsers that move their sliders at once."""
    parts: list[Any] = [None] * len(drivers)

    def run(place: int) -> None:
        parts[place] = moved(drivers[place], moves, 1000 * place + seed)

    threads = [threading.Thread(target=run, args=(place,)) for place in range(len(drivers))]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    return [time for part in parts for time in part[0]], [time for part in parts for time in part[1]]


def spent_by(process: psutil.Process) -> float:
    """Seconds of the processor that a process and those that it has started took."""
    return sum(sum(one.cpu_times()[:2]) for one in (process, *process.children(recursive=True)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--moves", type=int, default=1000)
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
        all_moved(drivers, _BATCH, 7)
        print(f"{chosen.case}, {chosen.backend}, {chosen.clients} clients, load {psutil.getloadavg()[0]:.1f}")
        print(f"{'moves':>8}{'page, MB':>10}{'server, MB':>12}")
        curves: list[float] = []
        maps: list[float] = []
        start, started = spent_by(server), sum(map(spent_by, browsers))
        styles = metric(drivers[0], "RecalcStyleCount")
        step = max(1, min(500, chosen.moves // 4))
        for done in range(0, chosen.moves + 1, step):
            print(f"{done:>8}{heap(drivers[0]):>10.1f}{server.memory_info().rss / 1e6:>12.1f}", flush=True)
            if done < chosen.moves:
                of_curves, of_maps = all_moved(drivers, step, done + 1)
                curves += of_curves
                maps += of_maps
        print(f"{'ms of the clock':<24}{'median':>8}{'95 %':>8}{'most':>8}")
        print(_line("until the curves", curves))
        print(_line("until the map", maps))
        server_s, browser_s = spent_by(server) - start, sum(map(spent_by, browsers)) - started
        print(
            f"ms of the processor for each move, map included: server {1e3 * server_s / len(curves):.0f}, "
            f"browser {1e3 * browser_s / len(curves):.0f}"
        )
        computed = (metric(drivers[0], "RecalcStyleCount") - styles) * len(drivers) / len(curves)
        print(f"styles computed {computed:.1f} times for each move")
        for driver in drivers:
            driver.quit()


if __name__ == "__main__":
    main()
