"""Readers take turns: a map that one of them waits for keeps no other from being answered, and comes to an end."""

import itertools
from collections import deque

import pytest

import proprotor as pp
from proprotor.explore.page import ExplorePage
from proprotor.explore.turns import Turns
from proprotor.rotor.options import CHOICES, Options
from proprotor.stability.boundaries import scan_speeds


class Loop:
    """An event loop that calls what waits in the order in which it came, and stands in for a document of each page.

    A call takes 10 ms of its clock.
    """

    title = ""

    def __init__(self):
        self.waiting = deque()
        self.calls = 0

    def time(self):
        return 0.01 * self.calls

    def call_later(self, _, call):
        self.waiting.append(call)

    def add_next_tick_callback(self, call):
        self.waiting.append(call)

    def add_timeout_callback(self, call, _):
        self.waiting.append(call)
        return call

    def remove_timeout_callback(self, call):
        self.waiting.remove(call)

    def call(self):
        """Call what has waited longest."""
        self.calls += 1
        self.waiting.popleft()()

    def run_until(self, done):
        """Call what waits until something has happened, and return the number of calls."""
        calls = 0
        while not done():
            self.call()
            calls += 1
        return calls


@pytest.fixture
def readers():
    """Two pages of one server."""
    case, loop = pp.load_case("xv15-uncoupled"), Loop()
    own = vars(Options())
    options = {name: own[name] for name in (*CHOICES, "locked")}
    pages = [ExplorePage(case, case.name, scan_speeds(case, 8), {}, options) for _ in range(2)]
    turns = Turns(loop)
    for page in pages:
        page.map.grid.value = "coarse"
        page.document = page.map.document = loop
        page._turns = page.map._turns = turns
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
            loop.call()
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


# The turns alone ----------------------------------------------------------------------------------------------------


class Steps:
    """A map that keeps what was done, and when."""

    def __init__(self, name, parts, done):
        self.name, self.parts, self.done = name, parts, done

    def __iter__(self):
        for _ in range(self.parts):
            self.done.append(self.name)
            yield


@pytest.fixture
def turns():
    loop, done = Loop(), []
    return Turns(loop), loop, done


def test_maps_take_turns_part_by_part(turns):
    turns, loop, done = turns
    for name, parts in (("a", 3), ("b", 2), ("c", 1)):
        turns.add_map(iter(Steps(name, parts, done)))
    loop.run_until(lambda: not loop.waiting)
    assert "".join(done) == "abcaba"


def test_between_two_parts_the_loop_may_do_other_things(turns):
    """Parts of eight maps one after the other would keep a move waiting for all of them."""
    turns, loop, done = turns
    for name in "abcdefgh":
        turns.add_map(iter(Steps(name, 2, done)))
    assert len(loop.waiting) == 1
    for count in range(1, 17):
        loop.call()
        assert len(done) == count and len(loop.waiting) == 1


def test_curves_of_any_reader_come_before_all_maps(turns):
    turns, loop, done = turns
    turns.add_map(iter(Steps("a", 3, done)))
    turns.curves_wait("one")
    turns.curves_wait("another")
    for _ in range(3):
        loop.call()
    turns.curves_done("one")
    for _ in range(3):
        loop.call()
    assert not done
    turns.curves_done("another")
    loop.call()
    assert done == ["a"]


def test_no_map_starves_where_readers_wait_for_curves_without_end(turns):
    turns, loop, done = turns
    turns.curves_wait("one")
    for name in "ab":
        turns.add_map(iter(Steps(name, 3, done)))
    at = [loop.time()]
    while loop.waiting:
        before = len(done)
        loop.call()
        if len(done) > before:
            at.append(loop.time())
    assert "".join(done) == "ababab"
    assert all(later - earlier <= 0.13 for earlier, later in itertools.pairwise(at))


def test_a_map_that_begins_the_next_one_does_not_double_the_turns(turns):
    turns, loop, done = turns

    def first():
        yield
        turns.add_map(iter(Steps("next", 2, done)))

    turns.add_map(first())
    while loop.waiting:
        assert len(loop.waiting) == 1
        loop.call()
    assert done == ["next", "next"]


def test_a_map_that_breaks_ends_alone(turns):
    turns, loop, done = turns

    def broken():
        yield
        raise ZeroDivisionError

    turns.add_map(broken())
    turns.add_map(iter(Steps("a", 2, done)))
    with pytest.raises(ZeroDivisionError):
        loop.run_until(lambda: not loop.waiting)
    loop.run_until(lambda: not loop.waiting)
    assert done == ["a", "a"]


def test_a_reader_who_leaves_keeps_nobody_waiting(readers):
    gone, other, loop = readers
    gone.map.grid.value = "fine"
    gone.inputs.sliders["rotor.precone"].value = 1.0
    loop.waiting = deque(
        call for call in loop.waiting if call != gone.update
    )  # Bokeh drops what a session waits for
    gone._leave()
    before = other.drawings.boundary.data
    other.inputs.sliders["rotor.precone"].value = 1.5
    calls = loop.run_until(lambda: other.drawings.boundary.data is not before)
    assert calls < 12
    loop.run_until(lambda: not loop.waiting)
