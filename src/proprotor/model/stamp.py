"""The stamp of a result: its case, the options in force, and the sources of its numbers.

A stamp is a mapping of names to text, the same in every record, dataset, file and picture. Datasets have the stamp
among their attributes, so that it survives netCDF. `of_case` and `of_model` make a stamp, `of` takes it from the
attributes of a result, and `line` puts it into words. The options in a stamp are read back by
`proprotor.model.options_of_result`.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from proprotor.control.control_loop import loop_text
from proprotor.model.deck_fingerprint import deck_fingerprint
from proprotor.model.options_in_force import chosen, in_force, options_in_result, options_text
from proprotor.model.provenance import reservations
from proprotor.rotor.options import Options, parse_options

if TYPE_CHECKING:
    from proprotor.model.configuration import Configuration
    from proprotor.model.linear_model import LinearModel

Stamp = Mapping[str, str]
_NO_LOOPS = "none"  # among the control loops of a stamp
_AIR = ("operation.density", "operation.altitude", "operation.temperature_offset")
NAMES = (
    *(
        "case",
        "title",
        "deck",
        "air_density",
        "options",
        "control",
        "reservations",
        "case_warnings",
        "made_by",
    ),
)


class Origin(NamedTuple):
    """The options in force of a linear model, and its case; None for a rotor that does not belong to a case."""

    options: Options
    case: Configuration | None = None


def of_case(case: Configuration, options: Mapping[str, Any], varied: Collection[str] = ()) -> dict[str, str]:
    """Return the stamp of a result computed from a case with the options as given.

    Parameters
    ----------
    case : Case
    options : mapping
        As the user gave them.
    varied : collection of str
        Inputs by which the points of the result differ: the stamp has a density of the air only if all have the same.

    Raises
    ------
    InputError
        For an unknown option, or a value that the option cannot have.
    """
    return _stamp(Origin(parse_options(case.model_options(options)), case), varied)


def of_model(model: LinearModel) -> dict[str, str]:
    """Return the stamp of a result computed from a model; empty for a model from elsewhere."""
    return {} if model.origin is None else _stamp(model.origin)


def of(attributes: Mapping[Any, Any]) -> dict[str, str]:
    """Return the stamp among other attributes of a result."""
    return {name: str(attributes[name]) for name in NAMES if name in attributes}


def line(found: Mapping[Any, Any]) -> str:
    """Return the case and the options that are not defaults in one line; empty for a result without options."""
    if "options" not in found:
        return ""
    own = chosen(options_in_result(found))
    options = f"options: {options_text(own)}" if own else "default options"
    closed = f", control loops closed: {loops}" if (loops := _loops(found)) else ""
    if "case" in found:
        return f"Case {found['case']} ({found['deck']}), {options}{closed}."
    return f"{options.capitalize()}."


def _loops(found: Mapping[Any, Any]) -> str:
    """Return the control loops of a result in words; empty without any."""
    loops = str(found.get("control", _NO_LOOPS))
    return "" if loops == _NO_LOOPS else loops


def unusual_options(found: Mapping[Any, Any]) -> list[str]:
    """Return a sentence with the options that are not defaults, and one with the control loops, in a list.

    The list is empty if all options are defaults and no loop is closed.
    """
    own = chosen(options_in_result(found)) if "options" in found else {}
    closed = [f"Control loops closed: {loops}."] if (loops := _loops(found)) else []
    return [*([f"Options: {options_text(own)}."] if own else []), *closed]


def _stamp(origin: Origin, varied: Collection[str] = ()) -> dict[str, str]:
    """Return the stamp of an origin, for points that differ by varied inputs."""
    case = origin.case
    own = {"options": json.dumps(in_force(origin.options)), "made_by": f"proprotor {_version()}"}
    if case is None:
        return own
    density = one_density(case, varied)
    own |= {} if density is None else {"air_density": repr(density)}
    own |= {"control": "; ".join(map(loop_text, case.loops)) or _NO_LOOPS}
    return own | {
        "case": case.name,
        "title": case.title or case.name,
        "deck": deck_fingerprint(case),
        "reservations": " ".join(reservations(case)),
        "case_warnings": " ".join(case.warnings),
    }


def one_density(case: Configuration, varied: Collection[str] = ()) -> float | None:
    """Return the density of the air of a case, kg/m³; None where points of the case, or varied inputs, differ in it."""
    density = case.operation.density
    if np.ndim(density) or np.iscomplexobj(density) or set(varied) & set(_AIR):
        return None
    return float(density)


def density_of(attributes: Mapping[Any, Any]) -> float | None:
    """Return the density of the air of a result, kg/m³, for equivalent airspeeds; None where it is not known."""
    return float(attributes["air_density"]) if "air_density" in attributes else None


@cache
def _version() -> str:
    from importlib.metadata import version

    return version("proprotor")
