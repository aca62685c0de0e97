"""The XV-15's modes at 200 and 300 kt for every combination of switches."""

import itertools
from pathlib import Path

import numpy as np

import proprotor as pp
from benchmarks.xv15_boundary import KNOT
from proprotor.figures.published import PAPER_FREQUENCIES
from proprotor.options import CHOICES
from tests.golden.modes import Modes, Record, modes_at

SWITCHES = ("equations", "pitch", "structure", "airloads", "compressibility", "rotor_speed")
KNOTS = (200, 300)
RECORD = Record(Path(__file__).with_name("xv15_switches.csv"), (*SWITCHES, "knots"))


def computed() -> Modes:
    """Modes of the model as it is, both speeds in one call."""
    case = pp.load_case("xv15")
    found = {}
    for choice in itertools.product(*(CHOICES[name] for name in SWITCHES)):
        options = dict(zip(SWITCHES, choice, strict=True))
        if options["structure"] == "tabulated":
            options["frequencies"] = PAPER_FREQUENCIES
        modes = case.linearize(np.array(KNOTS) * KNOT, **options).modes()
        for place, knots in enumerate(KNOTS):
            found[*map(str, choice), str(knots)] = modes_at(modes, place, case.operation.rotor_speed)
    return found
