"""Loads of the sections of a batch that has no points left."""

import numpy as np
import pytest
from proprotor_equations import airloads

import proprotor as pp
from proprotor.rotor import section_loads
from proprotor.rotor.section_loads import BladeSections


@pytest.mark.parametrize("scales", [1.0, np.array([1.0, 1.1])], ids=["one blade", "two blades"])
@pytest.mark.parametrize("plain", [0, 3], ids=["all with points", "some without axes"])
def test_no_points_have_no_loads(scales, plain):
    """A search that has ended at all points asks for the loads of none; a plain number counts as no point."""
    deck = pp.load_case("xv15-uncoupled")
    rotor = deck.vary({"rotor.flap_hinge_offset": deck.given["rotor.flap_hinge_offset"].si * scales}).rotor
    sections = BladeSections.of(rotor, np.shape(scales)).take(np.zeros(0, dtype=int))
    segments = {name: np.zeros((0, 1)) for name in section_loads.quantities_of_air(airloads)}
    segments |= dict.fromkeys(list(segments)[:plain], np.float64(1.0))
    found = section_loads.load_moments(sections, segments, compressibility=True)
    assert {np.shape(moment)[:1] for moment in found.values()} <= {(), (0,)}
