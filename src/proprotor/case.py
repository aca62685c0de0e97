"""A case: a configuration with the analyses as its methods."""

from __future__ import annotations

import os
from collections.abc import Mapping

from proprotor.deck.build import load
from proprotor.deck.file import list_cases
from proprotor.deck.vary import vary, with_control
from proprotor.model.configuration import Configuration
from proprotor.stability.attribution import attribution
from proprotor.stability.boundaries import boundaries
from proprotor.stability.boundary_against import boundary_against
from proprotor.stability.envelope import envelope
from proprotor.stability.floquet import floquet
from proprotor.stability.flutter import flutter_point
from proprotor.stability.growth_constraint import growth_constraint
from proprotor.stability.map import stability_map
from proprotor.stability.margins import margins
from proprotor.stability.sensitivity import sensitivity
from proprotor.stability.sweep import sweep_case

__all__ = ["Case", "list_cases", "load_case"]


class Case(Configuration):
    """A rotor, its operation and its support, with the analyses as methods.

    The attributes are described in `proprotor.model.configuration.Configuration`. Each analysis is a function of the
    engine whose first argument is a case.
    """

    vary = vary
    with_control = with_control
    sweep = sweep_case
    boundaries = boundaries
    boundary_against = boundary_against
    flutter_point = flutter_point
    margins = margins
    sensitivity = sensitivity
    attribution = attribution
    stability_map = stability_map
    floquet = floquet
    growth_constraint = growth_constraint
    envelope = envelope


def load_case(name_or_path: str | os.PathLike[str], settings: Mapping[str, str] | None = None) -> Case:
    """Return the case of a deck.

    Parameters
    ----------
    name_or_path : str or path
        Name of a bundled deck (`list_cases`) or path of a TOML file; `proprotor describe` lists the fields of a deck.
    settings : mapping of str to str, optional
        Fields to set first, as text: ``{"rotor.precone": "1.5 deg"}``. See `proprotor.deck.settings`.

    Returns
    -------
    Case

    Raises
    ------
    InputError
        When the deck cannot be found or read, or a field is missing, unknown or not physical: one line for
        each problem, with the field, the value as written and the rule.
    """
    return load(name_or_path, settings, kind=Case)
