"""Numbers of other sources that the figures show, and where the numbers were read."""

from __future__ import annotations

import numpy as np

import proprotor as pp
from benchmarks.paper_figures.content import Mark
from proprotor.units import KNOT

XV15_FLUTTER = {
    "Nixon": 285.0,
    "NASA SP-4517": 300.0,
    "Hathaway 2005": 302.0,
    "Johnson, NASA TM X-62,369": 305.0,
}  # kt, lowest mode of the semispan wing
XV15_MARK = Mark(
    tuple(XV15_FLUTTER.values()),
    "published flutter speeds, lowest mode: "
    + ", ".join(f"{speed:.0f} kt ({source})" for source, speed in XV15_FLUTTER.items()),
)

# The lag frequency falls from 1.8 per rev at low speed to 1.2 at high, and coning is at 1.85 (AIAA-2002-1604,
# Figs. 14 and 18). A straight line between 50 and 400 kt is assumed: the curve is not printed as numbers.
LAG_AIRSPEEDS = (50.0, 400.0)
LAG_FREQUENCIES = (1.8, 1.2)
CONING_FREQUENCY = 1.85
CYCLIC_FLAP_FREQUENCY = 1.0355
PAPER_FREQUENCIES = pp.BladeFrequencies(
    flap=CONING_FREQUENCY,
    lag=LAG_FREQUENCIES,
    against="airspeed",
    at=np.array(LAG_AIRSPEEDS) * KNOT,
    at_rotor_speed=458 * np.pi / 30,  # Table 1
)
PITCH_LAG_COUPLING = -0.3  # near the boundary, AIAA-2002-1604 on Fig. 21
