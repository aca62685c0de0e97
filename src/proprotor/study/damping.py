"""The damping of a mode of the support along the airspeeds, for all designs of a study."""

from __future__ import annotations

import numpy as np

from proprotor.errors import InputError, unknown_name
from proprotor.typing import Array, DataArray, Dataset

_LEAST_SHARE = 0.1  # participation of the support in a mode that counts as moving the support


def mode_damping(results: Dataset, mode: str | None = None, named_to: float | None = None) -> DataArray:
    """Return the damping ratio of a mode of the support, or the least of all modes that move the support.

    Up to the airspeed `named_to` a mode is at each airspeed the one in which the coordinate of the support moves most:
    where a mode of the rotor meets it, the name passes from one root to the other. From there on the root that has
    the name at `named_to` is followed, because the rotor takes over modes that flutter.

    Percentiles over the designs of a sample are ``mode_damping(results, mode).quantile([0.05, 0.5, 0.95], "design")``.

    Parameters
    ----------
    results : xarray.Dataset
        A study with ``quantities="modes"``.
    mode : str, optional
        A coordinate of the support, such as "chord". Without it, at each airspeed the lowest damping ratio of all
        oscillating modes in which the support takes part with a tenth or more, whatever their names.
    named_to : float, optional
        m/s; the middle one of the airspeeds by default.

    Returns
    -------
    xarray.DataArray
        -Re s/|s| (..., airspeed), dimensionless, NaN at failed points; dimensions of the designs first.

    Raises
    ------
    InputError
        When the results have no modes along airspeeds, or none of this name.
    """
    if "airspeed" not in getattr(results.get("mode_eigenvalue"), "dims", ()):
        raise InputError("results", None, 'must be a study of quantities="modes" along airspeeds')
    in_order = results.transpose(..., "airspeed", "state")
    values = in_order.mode_eigenvalue.values
    with np.errstate(all="ignore"):
        ratio = -values.real / np.abs(values)
    if mode is None:
        counts = (in_order.mode_support_share.values >= _LEAST_SHARE) & (values.imag > 0)
        least = np.where(counts, ratio, np.inf).min(axis=-1)
        damping = np.where(np.isfinite(least), least, np.nan)
    else:
        damping = _of_name(in_order.mode_name.values, values, ratio, mode, _named_points(results, named_to))
    of_points = in_order["mode_eigenvalue"].isel(state=0, drop=True)
    label = "damping ratio of " + (mode or "the modes that move the support")
    return of_points.copy(data=damping).rename("damping_ratio").assign_attrs(units="1", long_name=label)


def _named_points(results: Dataset, named_to: float | None) -> int:
    """Return the number of airspeeds at which the name decides which root is the mode."""
    if named_to is None:
        return results.sizes["airspeed"] // 2 + 1
    return int((results.airspeed.values <= named_to).sum())


def _of_name(names: Array, values: Array, ratio: Array, mode: str, named: int) -> Array:
    """Return the damping ratio (..., airspeeds) of the state that has a name, and is followed beyond its last point.

    Parameters
    ----------
    names, values, ratio : array (..., airspeeds, states)
    mode : str
    named : int
        Number of airspeeds at which the name decides; for a design that failed at all these airspeeds, its first good
        airspeed decides.
    """
    has_name = (names == mode) & (values.imag >= 0)
    if not has_name.any():
        known = sorted(set(names[names != ""].tolist()))
        raise InputError("mode", mode, unknown_name(mode, known, "mode"))
    works, airspeeds = has_name.any(axis=-1), np.arange(names.shape[-2])
    early = works & (airspeeds < named)
    last = np.where(early.any(axis=-1), (early * airspeeds).max(axis=-1), works.argmax(axis=-1))[..., None]
    places = has_name.argmax(axis=-1)
    places = np.where(airspeeds > last, np.take_along_axis(places, last, -1), places)
    found = np.take_along_axis(ratio, places[..., None], -1)[..., 0]
    return np.where(works | (airspeeds > last), found, np.nan)
