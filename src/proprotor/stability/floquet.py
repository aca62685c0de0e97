"""Floquet exponents of a rotor at an angle or in a pull-up, beside the roots of the average, with the periodic trim."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from proprotor.model.configuration import Configuration
from proprotor.model.floquet import LIMIT, averaged, change_by_average, exponents, with_doubts
from proprotor.model.linear_model import LinearModel
from proprotor.stability.modes import leading_dims, modes

if TYPE_CHECKING:
    from proprotor.rotor.moving_blade import Motion
    from proprotor.typing import Dataset

_ANGLES = ("flap", "lag", "elastic_pitch")


def floquet(case: Configuration, airspeed: Any, **options: Any) -> Dataset:
    """Return the modes of a case about its periodic trim, by the average over azimuth and by Floquet's theory.

    Parameters
    ----------
    case : Case
    airspeed : float, array (...) in m/s, text such as "250 ktas" or "200 keas", pint quantity or xarray.DataArray
    **options
        See `proprotor.rotor.options.Options`, with a shaft angle or a load factor.

    Returns
    -------
    xarray.Dataset
        What `modes` returns of the average, and exponent (..., mode), rad/s, the Floquet exponent nearest to each
        eigenvalue; damping_change (...), the largest change of a damping ratio below 0.1 by the average, from which
        `warning` follows above the attribute limit. Of the trim, in rad: flap, lag and elastic_pitch (..., azimuth) of
        a blade at each azimuth; gimbal_tilt (..., azimuth, part), cosine and sine part, and cyclic (..., part), the
        cyclic pitch of the swashplate. Attributes: the case and its options (`proprotor.model.stamp`).

    Raises
    ------
    InputError
        Without a shaft angle and a load factor, and as `Configuration.linearize`.
    """
    around = case.around(airspeed, **options)
    mean = averaged(around)
    roots = modes(mean).eigenvalue.values
    found = exponents(around, roots, case.passage)
    change = change_by_average(roots, found)
    result = modes(with_doubts(mean, change))
    leading = leading_dims(mean)
    result = result.assign(
        exponent=((*leading, "mode"), found, {"units": "rad/s"}),
        damping_change=(leading, change),
        **_trim(mean, leading),
    )
    result.attrs["limit"] = LIMIT
    return result


def _trim(model: LinearModel, leading: tuple[str, ...]) -> dict[str, Any]:
    """Return the periodic trim of a model, of the right rotor of two, as variables of a dataset."""
    rotor = model if model.rotor is None else model.rotor
    swing: Motion = rotor.swing  # type: ignore[assignment]  # a tilted rotor has one
    unit = {"units": "rad"}
    psi = 2 * np.pi * np.arange(swing.azimuths) / swing.azimuths
    found: dict[str, Any] = {"azimuth": ("azimuth", psi, unit), "part": ("part", ["cosine", "sine"])}
    for place, name in enumerate(_ANGLES):
        found[name] = ((*leading, "azimuth"), swing.angles[..., place], unit)
    found["gimbal_tilt"] = ((*leading, "azimuth", "part"), swing.tilt, unit)
    found["cyclic"] = ((*leading, "part"), swing.cyclic, unit)
    return found
