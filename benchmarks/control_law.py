"""Design one fixed law for the XV-15's wing, from two accelerometers to the cyclic, and show its margins over airspeed.

    python -m benchmarks.control_law                         # the search, with the law that it finds, rounded
    python -m benchmarks.control_law --figure FILE           # the margins of the law of docs/howto/close-a-loop.md

The law is u = g (w_x ẍ + w_y ÿ) · s (1 + s/l)/((s + d)(1 + 2ζ s/ω + s²/ω²)), with an actuator of 20 Hz and a delay of
10 ms. Differential evolution with a fixed seed looks for the law whose smallest disk margin over six airspeeds, up to
1.15 of the target, is largest: a disk margin of 0.83 holds 45° and 7.6 dB. A law that leaves a mode unstable at one of
the airspeeds costs more than any that does not. The search sees neither the airspeeds between nor those above.
"""

from __future__ import annotations

import argparse
from functools import partial

import numpy as np
from scipy.optimize import differential_evolution

import proprotor as pp
from benchmarks import pictures
from proprotor.files.output import write_whole
from proprotor.model.closed_loop import close_loops
from proprotor.model.provenance import reservations
from proprotor.model.sensors import sensor
from proprotor.plots import plot_margins
from proprotor.stability.modes import eigenvalues

KNOT = 1852 / 3600
TARGET = 335.0  # KTAS; the open loop flutters at 340
SPEEDS = np.linspace(140.0, 1.15 * TARGET, 6) * KNOT
SENSORS = ("x acceleration", "y acceleration")
UNIT = 400.0  # m/s² per rad, so that the unknowns of the search are near one
DECAY = 0.02  # 1/s that every mode keeps
OMEGA = np.unique(np.concatenate([np.geomspace(0.5, 600, 150), np.linspace(8, 60, 150)]))
BOUNDS = {
    "log gain": (-3, 2.5),
    "direction": (-np.pi, np.pi),  # of the measured acceleration, from x to y
    "log washout": (-1, 1.3),
    "log frequency": (0.5, 2.5),
    "damping": (0.2, 1.5),
    "log lead": (0.5, 3),
}
SEED, GENERATIONS = 1, 40


def law(unknowns: np.ndarray) -> pp.ControlLoop:
    """The loop of six unknowns, in the order of `BOUNDS`."""
    gain, direction, washout, frequency, damping, lead = unknowns
    washout, frequency, lead = 10**washout, 10**frequency, 10**lead
    return pp.ControlLoop(
        name="whirl",
        sensors=SENSORS,
        weights=(np.cos(direction), np.sin(direction)),
        inputs="cyclic_1c",
        gain=10**gain / UNIT,
        law=(
            [1 / lead, 1.0, 0.0],
            np.polymul([1.0, washout], [1 / frequency**2, 2 * damping / frequency, 1.0]),
        ),
        actuator_bandwidth=20 * 2 * np.pi,
        actuator_damping=0.7,
        delay=0.010,
    )


class Search:
    """The cost of a law on a case, whose motion per unit of cyclic is computed once."""

    def __init__(self, case: pp.Case) -> None:
        self.opened = case.open_loop(SPEEDS)
        self.read = np.stack([_accelerations(case.open_loop(speed)) for speed in SPEEDS])

    def __call__(self, unknowns: np.ndarray) -> float:
        loop = law(unknowns)
        growth = np.nanmax(eigenvalues(close_loops(self.opened, [loop])).real, axis=1)
        lacks = np.maximum(growth + DECAY, 0).sum()
        if lacks > 0:
            return 5.0 + lacks
        transfer = -(self.read @ loop.response(OMEGA, 0.0)[:, 0, :, None])[..., 0]
        return -2 / np.abs((1 - transfer) / (1 + transfer)).max()


def _accelerations(model: pp.LinearModel) -> np.ndarray:
    """What the sensors read (frequencies, 1, sensors) per rad of cyclic."""
    s = 1j * OMEGA[:, None, None]
    cyclic = model.B[:, [model.inputs.index("cyclic_1c")]].astype(complex)
    motion = np.linalg.solve(s**2 * model.M + s * model.C + model.K, cyclic)[..., 0]
    return np.stack([(sensor(model, name).at(OMEGA) * motion).sum(-1) for name in SENSORS], axis=-1)[:, None]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--figure", metavar="FILE", help="draw the margins of the law of a deck instead of a search"
    )
    parser.add_argument("--deck", default="loop.toml", help="deck with the law, for --figure")
    given = parser.parse_args()
    if given.figure:
        case = pp.load_case(given.deck)
        found = case.margins(np.arange(140.0, 401.0, 5.0) * KNOT)
        draw = partial(plot_margins, found, title=case.title, footer=" ".join(reservations(case)))
        write_whole(given.figure, partial(pictures.save, draw))
        return
    found = differential_evolution(
        Search(pp.load_case("xv15")),
        list(BOUNDS.values()),
        seed=SEED,
        maxiter=GENERATIONS,
        popsize=12,
        tol=1e-6,
        polish=False,
    )
    print(f"smallest disk margin {-found.fun:.3f} after {found.nfev} laws")
    for name, value in zip(BOUNDS, found.x, strict=True):
        print(f"  {name:14} {value:.4f}")
    loop = law(found.x)
    print(f"weights {np.round(loop.weights, 3)}, gain {loop.gain:.4g}")
    washout, frequency, lead = (10 ** found.x[place] for place in (2, 3, 5))
    print(f"washout {washout:.3g}, frequency {frequency:.4g}, lead {lead:.4g} rad/s")


if __name__ == "__main__":
    main()
