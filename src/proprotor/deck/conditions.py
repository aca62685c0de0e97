"""The conditions of an envelope: the deck itself, its normal variants, and each failure joined with each of these."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any, Generic, NamedTuple

import numpy as np

from proprotor.deck.build import C, assemble
from proprotor.deck.envelope_sections import FAILURE
from proprotor.deck.numbers import numbers_of
from proprotor.deck.validation import deck_of_condition
from proprotor.deck.vary import varied_numbers, vary
from proprotor.errors import InputError, check_known
from proprotor.model.configuration import Configuration

_AS_DECK = "as the deck"  # the name of the condition without a variant
_AIR = ("altitude", "temperature_offset", "density", "speed_of_sound")


class Condition(NamedTuple, Generic[C]):
    """A condition: its name, whether it is a failure, and its case in the standard atmosphere at sea level."""

    name: str
    failure: bool
    case: C


def conditions_of(case: C, only: Sequence[str] | None = None) -> list[Condition[C]]:
    """Return the conditions of a case's deck, normal ones first, each as a case whose altitude may vary.

    With powers in its envelope a condition is trimmed to a power coefficient; a chord that follows from a Lock number
    is that in the deck's own air, at every altitude.

    Parameters
    ----------
    case : Case
        Made from a deck with an envelope.
    only : sequence of str, optional
        Names of variants; all of them by default. The deck itself is always a condition.

    Raises
    ------
    InputError
        For a case without a deck or an envelope, an unknown variant, and a variant that sets what the envelope varies.
    """
    deck = case.deck
    if deck is None or deck.envelope is None:
        rule = "is missing; a deck says in [envelope] where it must be free of flutter: dive_speed, altitudes"
        raise InputError("envelope", None, rule)
    for name in only or ():
        check_known("variants", name, deck.variants, "variant")
    chosen = [name for name in deck.variants if only is None or name in only]
    for name in chosen:
        _check(deck, name)
    failures = [(name,) for name in chosen if deck.variants[name].condition == FAILURE]
    normal = [(), *((name,) for name in chosen if deck.variants[name].condition != FAILURE)]
    joined = [(*other, *failure) for failure, other in product(failures, normal)]
    return [
        Condition(", ".join(names) or _AS_DECK, failed, _case_of(case, names))
        for some, failed in ((normal, False), (joined, True))
        for names in some
    ]


def _check(deck: Any, name: str) -> None:
    """Refuse a variant that sets what the envelope varies."""
    envelope, given = deck.envelope, deck.variants[name].operation or {}
    varied = {field: "the altitudes" for field in _AIR}
    if envelope.rotor_speeds is not None:
        varied["rotor_speed"] = "rotor_speeds"
    if envelope.powers is not None:
        varied["trim"] = "powers"
    for field in given:
        if field in varied:
            rule = f"must not be set in a variant, because the envelope gives {varied[field]}"
            raise InputError(f"variants.{name}.operation.{field}", None, rule)


def _case_of(case: C, names: Sequence[str]) -> C:
    """Return the case of a condition, in the standard atmosphere at sea level."""
    own = deck_of_condition(case.deck, names)
    changes: dict[str, Any] = {"operation": {"altitude": "0 m"} | _offset(case)}
    if case.deck.envelope.powers is not None:
        changes["operation"]["trim"] = {"power_coefficient": 0.0}
    if own.rotor.lock_number is not None:
        chord = f"{np.asarray(_assembled(case, own).rotor.chord).item()!r} m"
        source = "lock_number, in the air of the deck"
        changes["rotor"] = {"chord": {"value": chord, "status": "derived", "source": source}}
    return _assembled(case, deck_of_condition(case.deck, names, changes), names)


def _offset(case: Configuration) -> dict[str, str]:
    """Return the temperature offset of the envelope as a field of [operation]; none if it gives none."""
    offset = case.deck.envelope.temperature_offset or case.given.get("operation.temperature_offset")
    return {} if offset is None else {"temperature_offset": offset.written}


def _assembled(case: C, deck: Any, names: Sequence[str] = ()) -> C:
    """Return the case of a deck, with the numbers in which the given case differs from its own deck."""
    title = f"{deck.case.title}, {', '.join(names)}" if names else deck.case.title
    whole = deck.model_copy(update={"case": deck.case.model_copy(update={"title": title})})
    there, own = numbers_of(deck), numbers_of(case.deck)
    built = assemble(whole, there, kind=type(case))
    values = {path: si for path, si in varied_numbers(case).items() if _is_same(path, own, there)}
    return vary(built, values) if values else built


def _is_same(path: str, own: Mapping[str, Any], there: Mapping[str, Any]) -> bool:
    """Return whether a condition has a number as the deck has it."""
    return path in there and there[path].si == own[path].si
