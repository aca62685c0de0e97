"""What changes with a move goes to the browser as one message, from which a reader of JSON gets all of it back."""

import json

import numpy as np
import pytest
from bokeh.document import Document
from bokeh.models import ColumnDataSource
from bokeh.protocol import Protocol

import proprotor as pp
from proprotor.explore.page import ExplorePage
from proprotor.explore.post import Columns, Post, Text
from proprotor.rotor.options import CHOICES, Options
from proprotor.stability.boundaries import scan_speeds


def unpacked(source):
    """What `post.js` makes of a message."""
    text, numbers = source.data["content"][0], source.data["numbers"][0]
    at = 0

    def taken(found):
        nonlocal at
        if list(found) != ["numbers"]:
            return found
        at += found["numbers"]
        return numbers[at - found["numbers"] : at].tolist()

    content = json.loads(text, object_hook=taken)
    assert at == len(numbers)
    return content


def test_arrays_come_back_where_they_were():
    lines, filled, text = Columns(ColumnDataSource()), Columns(ColumnDataSource()), Text("told")
    lines.data = {"x": [np.array([1.0, np.nan]), np.array([])], "mode": ["chord <b>"]}
    filled.data = {"deep": [[[np.arange(3.0)], [np.array([-4.0])]]], "width": [3.0], "none": []}
    text.text = 'a "text"'
    post = Post("post", lines, text, filled)
    post.send()
    back = unpacked(post.source)
    np.testing.assert_array_equal(back[0]["x"][0], [1.0, np.nan])
    assert back[0]["x"][1] == [] and back[0]["mode"] == ["chord <b>"] and back[1] == 'a "text"'
    assert back[2] == {"deep": [[[[0.0, 1.0, 2.0]], [[-4.0]]]], "width": [3.0], "none": []}


@pytest.fixture(scope="module")
def moved():
    """A page of which one slider was moved, and what its server then sends: for the curves, and for the map."""
    case, own = pp.load_case("xv15-uncoupled"), vars(Options())
    options = {name: own[name] for name in (*CHOICES, "locked")}
    page, document, sent = ExplorePage(case, case.name, scan_speeds(case, 20), {}, options), Document(), []
    page.put_on(document)
    page.map.draw()
    page.inputs.sliders["rotor.precone"].value = 1.0
    document.on_change(lambda event: sent.append(event) if hasattr(event, "model") else None)
    page.update()
    page.map.draw()
    return page, sent


def test_a_move_is_one_message_for_the_curves_and_one_for_the_map(moved):
    page, sent = moved
    assert [event.model for event in sent] == [page.post.source, page.map.post.source]
    for event in sent:
        message = Protocol().create("PATCH-DOC", [event])
        assert len(message.buffers) == 1


def test_the_message_holds_what_is_drawn_and_told(moved):
    page, _ = moved
    lines, dots, here, *texts = unpacked(page.post.source)
    for column in ("airspeed", "damping", "growth", "frequency"):
        assert len(lines[column]) == len(lines["mode"]) > 10
        for got, wanted in zip(lines[column], page.drawings.lines.data[column], strict=True):
            np.testing.assert_array_equal(got, wanted)
    assert len(dots["growth"]) == len(lines["mode"]) and len(here["x"]) == 1
    assert "precone 1 deg" in texts[0] and page.readout.text == texts[0]
    filled, boundary, _ = unpacked(page.map.post.source)
    assert len(filled["xs"]) == 2  # stable and unstable
    np.testing.assert_allclose(boundary["x"][0], page.drawings.boundary.data["x"][0], rtol=1e-6)
