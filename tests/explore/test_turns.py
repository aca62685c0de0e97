"""Readers take turns: a map that one of them waits for keeps no other from being answered, and comes to an end."""

from collections import deque

import pytest

import proprotor as pp
from proprotor.explore.page import ExplorePage
from proprotor.rotor.options import CHOICES, Options
from proprotor.stability.boundaries import scan_speeds


class Loop:
    """An event loop that calls what waits in the order in which it came, and stands in for a document of each page."""

    title = ""

    def __init__(self):
        self.waiting = deque()

    def add_next_tick_callback(self, call):
        self.waiting.append(call)

    def add_timeout_callback(self, call, _):
        self.waiting.append(call)
        return call

    def remove_timeout_callback(self, call):
        self.waiting.remove(call)

    def run_until(self, done):
        """Call what waits until something has happened, and return the number of calls."""
        calls = 0
        while not done():
            self.waiting.popleft()()
            calls += 1
        return calls


@pytest.fixture
def readers():
    """Two pages of one server."""
    case, loop = pp.load_case("xv15-uncoupled"), Loop()
    own = vars(Options())
    options = {name: own[name] for name in (*CHOICES, "locked")}
    pages = [ExplorePage(case, case.name, scan_speeds(case, 8), {}, options) for _ in range(2)]
    for page in pages:
        page.map.grid.value = "coarse"
        page.document = page.map.document = loop
        page.update()
    loop.run_until(lambda: not loop.waiting)
    return *pages, loop


def told(page):
    return page.readout.text


def test_a_move_of_one_reader_is_answered_between_the_parts_of_anothers_map(readers):
    one, other, loop = readers
    one.map.grid.value = "fine"  # 12 parts
    before, map_before = told(other), one.drawings.boundary.data
    loop.run_until(lambda: len(loop.waiting) == 1)
    other.inputs.sliders["rotor.precone"].value = 1.0
    calls = loop.run_until(lambda: told(other) != before)
    assert calls <= 3 and one.drawings.boundary.data is map_before
    loop.run_until(lambda: one.drawings.boundary.data is not map_before)
    assert told(one) == before and one.chosen.values == {}


def test_a_slider_that_never_rests_does_not_keep_the_map_from_being_drawn(readers):
    """Moves come between all parts; the map in the making is drawn, and then one of later settings."""
    page, _, loop = readers
    slider = page.inputs.sliders["rotor.control_stiffness"]
    drawn, moves = [page.drawings.boundary.data], 0
    while len(drawn) < 4 and moves < 100:
        slider.value += slider.step
        moves += 1
        for _ in range(min(3, len(loop.waiting))):
            loop.waiting.popleft()()
        if page.drawings.boundary.data is not drawn[-1]:
            drawn.append(page.drawings.boundary.data)
    assert len(drawn) == 4
    loop.run_until(lambda: not loop.waiting)
    last = page.drawings.boundary.data["x"]
    page.map.draw()
    assert [line.tolist() for line in page.drawings.boundary.data["x"]] == [line.tolist() for line in last]


def test_moves_that_come_together_are_answered_together(readers):
    page, _, loop = readers
    for value in (1.0, 1.5, 2.0):
        page.inputs.sliders["rotor.precone"].value = value
    assert len(loop.waiting) == 1
    loop.run_until(lambda: "precone 2 deg" in told(page))
