"""What notebooks show of cases, models and boundaries: well-formed, escaped, with doubts, nothing from elsewhere."""

import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp

THIN = {"operation.speed_of_sound": "300 m/s"}
CASE, DOUBTFUL = pp.load_case("xv15-uncoupled"), pp.load_case("xv15-uncoupled", THIN)
TAGS = {"div", "b", "table", "thead", "tbody", "tr", "th", "td", "details", "summary"}
SHOWN = {
    "case": lambda: CASE,
    "aircraft": lambda: pp.load_case("xv15-aircraft"),
    "designs": lambda: CASE.vary({"rotor.radius": np.array([3.7, 3.8])}),
    "rigid hub": lambda: replace(CASE, support=pp.rigid_support()),
    "model": lambda: CASE.linearize([0.0, 100.0, 200.0], locked="gimbal"),
    "one point": lambda: CASE.linearize(100.0),
    "many points": lambda: CASE.linearize(np.linspace(100, 200, 50)),
    "complex": lambda: CASE.linearize(100.0 + 1e-20j),
    "rotor alone": lambda: pp.rotor_model(CASE.rotor, CASE.operation, 100.0),
    "flutter point": lambda: DOUBTFUL.flutter_point(section_damping=False),
    "no flutter": lambda: CASE.flutter_point("100:150:10kt"),
    "boundaries": lambda: CASE.boundaries(),
    "boundary": lambda: CASE.boundaries().boundaries[0],
    "no boundaries": lambda: CASE.boundaries("100:150:10kt"),
}


def text_of(shown):
    return "\n".join(ET.fromstring(shown._repr_html_()).itertext())


@pytest.mark.parametrize("what", SHOWN)
def test_it_is_well_formed_compact_and_loads_nothing(what):
    html = SHOWN[what]()._repr_html_()
    root = ET.fromstring(html)  # every tag closed, every text escaped
    assert root.tag == "div" and len(html) < 30_000
    assert not {"src", "href", "class", "id", "onclick"} & {
        name for one in root.iter() for name in one.attrib
    }
    assert {one.tag for one in root.iter()} <= set(
        ["div", "b", "table", "thead", "tbody", "tr", "th", "td", "details", "summary"]
    )
    assert "nan" not in html and "http" not in html.replace("https://doi", "")


@pytest.mark.parametrize("what", SHOWN)
def test_the_plain_text_is_short(what):
    shown = repr(SHOWN[what]())
    assert len(shown.splitlines()) < 16 and len(shown) < 2500


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"rotor.precone": [0.03, 0.05, 0.04]}, "3 designs: rotor.precone 0.03 to 0.05 rad"),
        (
            {"rotor.precone": [0.03, 0.04], "support.modes[beam].frequency": [[20.0], [25.0], [30.0]]},
            "6 designs: rotor.precone 0.03 to 0.04 rad, support.modes[beam].frequency 20 to 30 rad/s",
        ),
        (
            {"rotor.kinematic_pitch_flap_coupling": [0.1, 0.2]},
            "2 designs: rotor.kinematic_pitch_flap_coupling 0.1",
        ),
        ({"rotor.precone": ["1 deg"]}, "1 design: rotor.precone 0.0174533 rad"),
    ],
)
def test_a_case_of_many_designs_says_so(values, told):
    """Without that line it reads as the design of its deck."""
    many = CASE.vary(values)
    for shown in (repr(many), text_of(many)):
        assert told in shown


@pytest.mark.parametrize("name", [*pp.list_cases()])
def test_a_case_of_one_design_names_no_range(name):
    case = pp.load_case(name)
    assert "design" not in repr(case).replace(case.title, "").partition("Rests on")[0]
    assert "designs:" not in repr(case.vary({"rotor.precone": 0.04}))


def test_a_state_space_shows_its_names_and_no_matrices():
    one, many = CASE.linearize(100.0).to_state_space(), CASE.linearize([100.0, 900.0]).to_state_space()
    for shown in map(repr, (one, many)):
        assert len(shown.splitlines()) < 6 and "array" not in shown
        assert "6 inputs: collective, cyclic_1c, cyclic_1s, gust_x" in shown and " outputs: x, y, z," in shown
    assert "StateSpace: " in repr(one) and f"{len(one.states)} states, one point" in repr(one)
    assert "batch of shape (2,)" in repr(many) and "1 of 2 failed" in repr(many)


def test_text_of_a_deck_is_escaped():
    named = replace(CASE, title='<script>alert("x")</script> & more', remarks=("<b>bold</b>",))
    html = named._repr_html_()
    assert "<script>" not in html and "<b>bold" not in html
    assert '<script>alert("x")</script> & more' in text_of(named)


def test_a_case_lists_the_inputs_that_were_not_read_in_a_source():
    told = text_of(CASE)
    doubtful = {path: one for path, one in CASE.sources.items() if one.status not in ("published", "derived")}
    assert f"{len(doubtful)} inputs that were not read in a source" in told
    assert all(path in told and one.written[:90] in told for path, one in doubtful.items())
    assert "Calibration: " in told


def test_a_model_shows_trims_with_failures_doubts_and_options():
    model = DOUBTFUL.linearize([0.0, 100.0, 200.0], locked="gimbal")
    told = text_of(model)
    pitch = np.degrees(model.trim.collective)
    assert f"{pitch[1]:.5g}\n" in told and f"{pitch[2]:.5g}?" in told
    assert "1 of 3 failed: " in told and "1 of 3 doubtful: " in told and "locked gimbal" in told
    assert "inputs that were not read in a source" in told


def test_boundaries_show_every_crossing_and_its_doubts():
    point = DOUBTFUL.flutter_point(section_damping=False)
    told = text_of(point)
    for one in point.boundaries:
        assert f"{one.position / (1852 / 3600):.2f}{'?' if one.warning else ''}" in told and one.event in told
    assert any(one.warning for one in point.boundaries) and "? Doubtful " in told
    assert "section damping no" in told and "Rests on inputs" in told
    found = CASE.boundaries()
    assert all(f"{one.position:.6g}" in text_of(found) for one in found.boundaries)
