"""A case: a configuration with its analyses as methods."""

from __future__ import annotations

import os
from collections.abc import Mapping

from proprotor.deck.build import load
from proprotor.deck.file import list_cases
from proprotor.deck.vary import vary as _vary
from proprotor.model.configuration import Configuration
from proprotor.stability.attribution import attribution as _attribution
from proprotor.stability.boundaries import boundaries as _boundaries
from proprotor.stability.flutter import flutter_point as _flutter_point
from proprotor.stability.map import stability_map as _stability_map
from proprotor.stability.sensitivity import sensitivity as _sensitivity
from proprotor.stability.sweep import sweep_case as _sweep_case

__all__ = ["Case", "list_cases", "load_case"]


class Case(Configuration):
    """A rotor, how it is operated and what carries it, with the analyses of all three as methods.

    A method is the function of the same name whose first argument is the case; its attributes are those of
    `proprotor.model.configuration.Configuration`.
    """

    vary = _vary
    sweep = _sweep_case
    boundaries = _boundaries
    flutter_point = _flutter_point
    sensitivity = _sensitivity
    attribution = _attribution
    stability_map = _stability_map


def load_case(name_or_path: str | os.PathLike[str], settings: Mapping[str, str] | None = None) -> Case:
    """The case of a deck.

    Parameters
    ----------
    name_or_path : str or path
        A bundled deck (`list_cases`) or a TOML file; `proprotor describe` tells its fields.
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
