"""The modes of every bundled deck at three airspeeds, by default and with each switch thrown alone."""

from pathlib import Path
from typing import Any

import numpy as np

import proprotor as pp
from proprotor.options import LOCKABLE
from tests.golden.modes import Modes, Record, modes_at

ADVANCE = (0.25, 0.5, 0.7)  # airspeed by tip speed: the same for models of any size
CHOICES: dict[str, dict[str, Any]] = {
    "default": {},
    "published": {"equations": "published"},
    "coupling": {"pitch": "coupling"},
    "rigid pitch": {"pitch": "rigid"},
    "diagonal": {"structure": "diagonal"},
    "lift-slope": {"airloads": "lift-slope"},
    "no airloads": {"airloads": "none"},
    "incompressible": {"compressibility": False},
    "section damping": {"section_damping": True},
    "constant speed": {"rotor_speed": "constant"},
    "as the paper": {"equations": "published", "pitch": "coupling", "airloads": "lift-slope"},
    **{f"{name} locked": {"locked": [name]} for name in LOCKABLE},
}
RECORD = Record(Path(__file__).with_name("deck_modes.csv"), ("deck", "choice", "advance"))


def computed() -> Modes:
    """Modes of the decks as they are, all airspeeds of a choice in one call."""
    found = {}
    for deck in pp.list_cases():
        case = pp.load_case(deck)
        rotor_speed = case.operation.rotor_speed
        airspeeds = np.array(ADVANCE) * rotor_speed * case.rotor.radius
        for choice, options in CHOICES.items():
            model = case.linearize(airspeeds, **options)
            assert model.trim.converged.all(), (deck, choice, model.trim.reason)
            modes = model.modes()
            for place, advance in enumerate(ADVANCE):
                found[deck, choice, str(advance)] = modes_at(modes, place, rotor_speed)
    return found
