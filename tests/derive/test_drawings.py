"""Drawings show the signs that docs/theory/conventions.md states, and docs/figures has every one of them."""

import re
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

from derive import kinematics as kin
from derive.pages import drawings
from tests.documentation import DOCS


def test_flap_raises_and_lag_takes_back():
    still = drawings.blade()
    chordwise, radial, axial = (drawings.blade({kin.q["flap"]: 0.1}) - still)[-1]
    assert axial > 0 and radial < 0 and chordwise == pytest.approx(0)
    chordwise, radial, axial = (drawings.blade({kin.q["lag"]: 0.1}) - still)[-1]
    assert chordwise > 0 and radial < 0


@pytest.mark.parametrize(("azimuth", "tilt"), [(0.0, (0.1, 0.0)), (np.pi / 2, (0.0, 0.1))])
def test_each_tilt_of_the_gimbal_is_up_at_its_azimuth(azimuth, tilt):
    assert drawings.tilted(azimuth, *tilt)[2] == pytest.approx(0.1)
    assert drawings.tilted(azimuth + np.pi, *tilt)[2] == pytest.approx(-0.1)
    assert drawings.tilted(azimuth + np.pi / 2, *tilt)[2] == pytest.approx(0, abs=1e-12)


def test_a_blade_at_azimuth_0_is_up_and_turns_right_handed_about_the_shaft():
    chordwise, along, shaft = drawings.axes_of_blade(0.0)
    assert along == pytest.approx([1, 0, 0]) and shaft == pytest.approx([0, 0, 1])
    assert np.cross(chordwise, along) == pytest.approx(shaft)
    later = drawings.axes_of_blade(0.01)[1]
    assert np.cross(along, later)[2] > 0 and np.dot(later - along, chordwise) < 0


def test_every_drawing_is_in_the_pages_and_is_written_alike_twice(tmp_path):
    page = (DOCS / "theory" / "conventions.md").read_text(encoding="utf-8")
    assert set(re.findall(r"figures/(\w+)\.svg", page)) == set(drawings.DRAWINGS)
    folders = [tmp_path / name for name in "ab"]
    for folder in folders:
        folder.mkdir()
        drawings.write(folder)
    for name in drawings.DRAWINGS:
        first, second = ((folder / f"{name}.svg").read_bytes() for folder in folders)
        assert first == second
        for text in (first, (drawings.FIGURES / f"{name}.svg").read_bytes()):
            assert ElementTree.fromstring(text).tag.endswith("svg")
