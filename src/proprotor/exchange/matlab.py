"""Results in files of MATLAB (``.mat``, version 5), which Octave and SciPy read as well.

Names that MATLAB does not take are altered (``rotor.precone`` to ``rotor_precone``), and ``names`` in the file keeps
the original names. Lists of text are cell arrays, logical values stay logical, complex numbers complex. Axes of a
batch of models come last, as pages: M(:, :, k) is the mass matrix of the k-th point. A dataset keeps its order of axes,
which ``dims`` names.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping
from dataclasses import fields
from typing import Any

import numpy as np

from proprotor.errors import InputError
from proprotor.files.output import check_place, write_whole
from proprotor.model.linear_model import LinearModel
from proprotor.model.stamp import of_model
from proprotor.typing import Array, Dataset

_LARGEST = 2**31 - 1  # bytes of a variable, which version 5 counts with 32 bits
_LONGEST = 63  # characters of a name
# fmt: off
_KEYWORDS = frozenset([
    "break", "case", "catch", "classdef", "continue", "else", "elseif", "end", "for", "function", "global", "if",
    "otherwise", "parfor", "persistent", "return", "spmd", "switch", "try", "while",
])
# fmt: on
_OWN = ("dims", "units", "names", "attributes")  # variables of the file that are no variables of the dataset


def save_matlab(results: LinearModel | Dataset, path: str | os.PathLike[str]) -> None:
    """Write a linear model or a dataset, such as a sweep or a study, as a file of MATLAB.

    A model becomes M, C, K, B (inputs of the second-order equations), dofs, inputs, airspeed, trim, and, where it has
    inputs, state_space with A, B, C, D, states, inputs and outputs. A dataset becomes one variable for each of its
    variables and coordinates, with dims, units and attributes as structs by the same names. Attributes of a model and
    of a dataset say the case and the options in force (`proprotor.model.stamp`).

    Parameters
    ----------
    results : LinearModel or xarray.Dataset
    path : str or path
        Ends in ``.mat``. A file that exists is replaced, and stays as it is when writing fails.

    Raises
    ------
    InputError
        When the path does not end in ``.mat`` or cannot be written, or the results are something else or too large.
    OSError
        When the file cannot be written.
    """
    from scipy.io import savemat  # here, because it takes long to import

    check_place(path, ".mat")
    content = _of_model(results) if isinstance(results, LinearModel) else _of_dataset(results)
    for name, entry in content.items():
        if getattr(entry, "nbytes", 0) > _LARGEST:
            rule = "must be below 2 GB in a .mat file: proprotor.save_results takes more"
            raise InputError("results", name, rule)
    settings: dict[str, Any] = {"long_field_names": True, "do_compression": True, "oned_as": "column"}
    write_whole(path, lambda file: savemat(file, content, **settings))


def matlab_names(names: Iterable[str], taken: Iterable[str] = ()) -> dict[str, str]:
    """Return a name for MATLAB for each name: a letter, then letters, digits and underscores, 63 characters at most.

    Parameters
    ----------
    names : iterable of str
    taken : iterable of str
        Names that are in use already.

    Returns
    -------
    dict of str to str
        The names of MATLAB by the given names.
    """
    found: dict[str, str] = {}
    used = set(taken)
    for name in names:
        plain = re.sub(r"[^A-Za-z0-9]+", "_", name).strip("_")
        if name.isidentifier() and name.isascii() and name[0] != "_":
            plain = name  # an underscore at its end stays
        if not plain[:1].isalpha() or plain in _KEYWORDS:
            plain = f"x_{plain}"
        free, count = plain[:_LONGEST], 1
        while free in used:
            count += 1
            free = f"{plain[: _LONGEST - 1 - len(str(count))]}_{count}"
        used.add(free)
        found[name] = free
    return found


def _of_model(model: LinearModel) -> dict[str, Any]:
    """Return the variables of a file for a linear model."""
    content: dict[str, Any] = {name: _pages(getattr(model, name)) for name in "MCK"}
    content |= {"dofs": _cells(model.dofs), "airspeed": _plain(model.airspeed)}
    content["trim"] = {entry.name: _plain(getattr(model.trim, entry.name)) for entry in fields(model.trim)}
    content["units"] = {"airspeed": "m/s", "matrices": "SI units and radians"}
    if own := of_model(model):
        content["attributes"] = _attributes(own)
    if model.hub is not None:
        content["hub"] = _pages(model.hub)
    if model.B is not None:
        content |= {"B": _pages(model.B), "inputs": _cells(model.inputs)}
        space = model.to_state_space()
        content["state_space"] = {name: _pages(getattr(space, name)) for name in "ABCD"} | {
            name: _cells(getattr(space, name)) for name in ("states", "inputs", "outputs")
        }
    return content


def _of_dataset(data: Dataset) -> dict[str, Any]:
    """Return the variables of a file for a dataset; refuse results of another type."""
    if not hasattr(data, "data_vars"):
        raise InputError("results", type(data).__name__, "must be a LinearModel or an xarray.Dataset")
    names = matlab_names(map(str, data.variables), _OWN)
    by_name = {names[str(name)]: variable for name, variable in data.variables.items()}
    content: dict[str, Any] = {name: _plain(variable.values) for name, variable in by_name.items()}
    content["dims"] = {name: _cells(map(str, variable.dims)) for name, variable in by_name.items()}
    content["units"] = {
        name: str(variable.attrs["units"]) for name, variable in by_name.items() if "units" in variable.attrs
    }
    content["names"] = {own: name for name, own in names.items()}
    content["attributes"] = _attributes(data.attrs)
    return {name: entry for name, entry in content.items() if not (isinstance(entry, Mapping) and not entry)}


def _attributes(attrs: Mapping[Any, Any]) -> dict[str, Any]:
    names = matlab_names(map(str, attrs))
    numbers = int | float | complex | np.ndarray
    return {
        names[str(name)]: _plain(value) if isinstance(value, numbers) else str(value)
        for name, value in attrs.items()
    }


def _pages(matrices: Array) -> Array:
    """Return matrices (..., n, m) as (n, m, ...)."""
    return np.moveaxis(np.asarray(matrices), (-2, -1), (0, 1))


def _plain(values: Any) -> Any:
    """Return numbers as they are, times and text as text."""
    array = np.asarray(values)
    if array.dtype.kind in "biufc":
        return array
    text = array.astype(str)
    return _cells(text) if text.ndim else str(text)


def _cells(texts: Iterable[Any]) -> Array:
    """Return text as a cell array: a list as a column, an array in its shape."""
    array = np.array(texts if isinstance(texts, np.ndarray) else list(texts), dtype=object)
    return array.reshape(-1, 1) if array.ndim == 1 else array
