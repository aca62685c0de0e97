"""The modes of every bundled deck at three airspeeds, for every combination of switches and with each hinge locked."""

import itertools
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import proprotor as pp
from benchmarks.paper_figures.published import PAPER_FREQUENCIES
from proprotor.rotor.options import CHOICES, LOCKABLE
from tests.golden.modes import Modes, Record, modes_at_each

ADVANCE = (0.25, 0.5, 0.7)  # airspeed by tip speed: the same for models of any size
SWITCHES = ("equations", "pitch", "structure", "airloads", "compressibility", "rotor_speed")
# Of every combination that does not say otherwise, so that a record's numbers are of one set of equations throughout.
WITHOUT_DAMPING = {"section_damping": False}
# With every other switch as the deck has it, its own blade frequencies included:
# what would double the combinations, or multiply them by sixteen.
ALONE: dict[str, dict[str, Any]] = {
    "section damping": {"section_damping": True},
    **{f"{name} locked": {"locked": [name]} for name in LOCKABLE},
}


def record(deck: str) -> Record:
    """The accepted modes of a deck."""
    file = Path(__file__).with_name(f"{deck}.csv")
    return Record(file, (*(name.replace("_", " ") for name in SWITCHES), "also", "advance"))


def choices(
    rotor_speed: float = PAPER_FREQUENCIES.at_rotor_speed,
) -> Iterator[tuple[tuple[str, ...], dict[str, Any]]]:
    """Each combination as the record names it, and the options that make it for a rotor of a speed in rad/s."""
    default = {name: CHOICES[name][0] for name in SWITCHES}
    for choice in itertools.product(*(CHOICES[name] for name in SWITCHES)):
        options = dict(zip(SWITCHES, choice, strict=True))
        if options["structure"] == "tabulated":
            # The XV-15's, per revolution of this rotor; of the other rotors none are published.
            options["frequencies"] = replace(PAPER_FREQUENCIES, at_rotor_speed=rotor_speed)
        yield (*map(str, choice), ""), WITHOUT_DAMPING | options
    for name, options in ALONE.items():
        yield (*map(str, default.values()), name), WITHOUT_DAMPING | options


def computed(deck: str) -> Modes:
    """Modes of a deck as the model is, all airspeeds of a choice in one call."""
    case = pp.load_case(deck)
    rotor_speed = case.operation.rotor_speed
    airspeeds = np.array(ADVANCE) * rotor_speed * case.rotor.radius
    found = {}
    for choice, options in choices(rotor_speed):
        model = case.linearize(airspeeds, **options)
        assert model.trim.converged.all(), (deck, choice, model.trim.reason)
        for advance, modes in zip(ADVANCE, modes_at_each(model.modes(), rotor_speed), strict=True):
            found[*choice, str(advance)] = modes
    return found
