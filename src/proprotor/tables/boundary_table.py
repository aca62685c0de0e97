"""Boundaries against an input as records and as cells of a table, and the choice of some of the boundaries."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from proprotor.errors import InputError, unknown_name
from proprotor.model.doubts import marked
from proprotor.typing import Dataset
from proprotor.units import KEAS, KNOT, KTAS, factor_to_si

FIRST = "first instability"  # the branch of `only_first`


def input_of(found: Dataset) -> str:
    """Return the path of the input of `Case.boundary_against`."""
    return str(found["first"].dims[0])


def of_mode(found: Dataset, mode: str) -> Dataset:
    """Return the boundaries of one mode: branches that have its name at any of their points.

    Parameters
    ----------
    found : xarray.Dataset
        Of `Case.boundary_against`.
    mode : str

    Raises
    ------
    InputError
        For a name that no boundary has, with the names that there are.
    """
    names = found["mode"].values
    known = sorted(set(names[names != ""].tolist()))
    if mode not in known:
        rule = unknown_name(mode, known, "mode with a boundary") if known else "has no boundary"
        raise InputError("mode", mode, rule)
    return found.isel(branch=np.flatnonzero((names == mode).any(axis=0)))


def only_first(found: Dataset) -> Dataset:
    """Return the lowest onset at each value of the input as one branch, "first instability".

    Parameters
    ----------
    found : xarray.Dataset
        Of `Case.boundary_against`.
    """
    import xarray  # here, because it takes long to import

    path = input_of(found)
    has = xarray.DataArray(np.isfinite(found["first"].values), dims=path)
    if not found.sizes["branch"]:
        return found
    labels = found.branch.values.tolist()
    place = [labels.index(name) if name else 0 for name in found.first_branch.values.tolist()]
    at = xarray.DataArray(place, dims=path)
    rows = xarray.DataArray(np.arange(len(place)), dims=path)
    own = [name for name, part in found.data_vars.items() if part.dims == (path, "branch")]
    one = {
        name: found[name]
        .isel({path: rows, "branch": at})
        .drop_vars("branch")
        .where(has, "" if found[name].dtype.kind == "U" else np.nan)
        .expand_dims(branch=[FIRST], axis=1)
        for name in own
    }
    kept = found.drop_vars([*own, "onset", "branch"]).assign(one)
    return kept.assign(onset=("branch", np.array([True]), found.onset.attrs)).assign_attrs(found.attrs)


def without_doubtful(found: Dataset) -> tuple[Dataset, list[str]]:
    """Return the boundaries without the branches of which every boundary is doubtful, and the labels of these.

    Nothing is left out below a boundary that stays: a branch stays that is the lowest or the first instability at any
    value of the input, or has a lower airspeed than a branch that stays.

    Parameters
    ----------
    found : xarray.Dataset
        Of `Case.boundary_against`.
    """
    speed = np.nan_to_num(found.airspeed.values, nan=np.inf)
    lowest = speed == speed.min(axis=1, initial=np.inf, keepdims=True)
    sure = (np.isfinite(speed) & (lowest | (found.warning.values == ""))).any(axis=0)
    shown, before = sure | np.isin(found.branch.values, found.first_branch.values), np.zeros_like(sure)
    while not np.array_equal(shown, before):
        highest = np.where(np.isfinite(speed) & shown, speed, 0).max(axis=1, initial=0, keepdims=True)
        before, shown = shown, shown | (speed < highest).any(axis=0)
    return found.isel(branch=np.flatnonzero(shown)), found.branch.values[~shown].tolist()


def boundary_records(found: Dataset, unit: str) -> list[dict[str, Any]]:
    """Return a record for each boundary, by the input and the airspeed; one without airspeed where there is none.

    Parameters
    ----------
    found : xarray.Dataset
        Of `Case.boundary_against`.
    unit : str
        Unit of the input; "" for a plain number.
    """
    path = input_of(found)
    factor = factor_to_si(unit, unit, str(found[path].attrs["units"]))
    return [
        record
        for row, value in enumerate((found[path].values / factor).tolist())
        for record in _at_one(found.isel({path: row}), f"{path} ({unit})" if unit else path, _rounded(value))
    ]


def _rounded(value: float) -> float:
    """Return a value without the rounding of the conversion of its unit."""
    return float(f"{value:.10g}")


def _at_one(here: Dataset, column: str, value: float) -> list[dict[str, Any]]:
    """Return the records of one value of the input."""
    speed = here.airspeed.values
    places = [place for place in np.argsort(speed, kind="stable") if np.isfinite(speed[place])]
    return [_record(here, column, value, place) for place in (places or [None])]


def _record(here: Dataset, column: str, value: float, place: int | None) -> dict[str, Any]:
    """Return the record of a boundary; without a boundary, the note and the reason alone."""
    own = here.isel(branch=place) if place is not None else None

    def of(name: str, factor: float = 1.0) -> float | None:
        return None if own is None else float(own[name]) / factor

    def text(name: str) -> str | None:
        return None if own is None else str(own[name].item())

    return {
        column: value,
        "branch": text("branch"),
        f"airspeed ({KTAS})": of("airspeed", KNOT),
        f"airspeed ({KEAS})": of("equivalent_airspeed", KNOT),
        "airspeed (m/s)": of("airspeed"),
        "frequency (Hz)": of("frequency", 2 * math.pi),
        "frequency (per rev)": of("frequency", float(here.rotor_speed)),
        "mode": text("mode"),
        "kind": text("kind"),
        "onset": None if own is None else bool(own.onset),
        "warning": text("warning") or "",
        "note": str(here.note.item()),
        "failure": str(here.reason.item()),
    }


def boundary_cells(record: dict[str, Any]) -> tuple[str, ...]:
    """Return a record as cells: the input, KTAS, KEAS, Hz, /rev, mode, kind, and "begins" or "ends", or the note."""
    value = f"{next(iter(record.values())):g}"
    if record["branch"] is None:
        note = "; ".join(filter(None, (record["note"], record["failure"])))
        return (value, "", "", "", "", note, "", "")
    speeds = (marked(f"{record[f'airspeed ({unit})']:.2f}", record["warning"]) for unit in (KTAS, KEAS))
    frequency = f"{record['frequency (Hz)']:.3f}", f"{record['frequency (per rev)']:.3f}"
    return (
        value,
        *speeds,
        *frequency,
        record["mode"],
        record["kind"],
        "begins" if record["onset"] else "ends",
    )
