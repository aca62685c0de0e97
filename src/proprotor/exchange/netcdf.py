"""Results in netCDF files: complex numbers are stored as real and imaginary parts, so that every reader opens them."""

from __future__ import annotations

import errno
import os
from threading import Lock

import numpy as np

from proprotor.errors import InputError
from proprotor.files.output import check_place, write_whole
from proprotor.files.text import check_file
from proprotor.needs import need
from proprotor.typing import Dataset

_PARTS = ("_real", "_imag")
_COMPLEX = "complex_of"  # attribute of both parts: the name of their complex variable
_ONE_AT_A_TIME = Lock()  # the netCDF library is not made for threads: two at once crash the process


def save_results(results: Dataset, path: str | os.PathLike[str]) -> None:
    """Write a dataset of this package, such as a study or a sweep, as netCDF.

    A complex variable ``eigenvalue`` is stored as ``eigenvalue_real`` and ``eigenvalue_imag``.

    Parameters
    ----------
    results : xarray.Dataset
    path : str or path
        Ends in ``.nc``. A file that exists is replaced, and stays as it is when writing fails.

    Raises
    ------
    InputError
        When the path does not end in ``.nc`` or cannot be written, the library that writes netCDF is missing, or a
        variable has the name that a part would have.
    OSError
        When the file cannot be written.
    """
    check_path(path)
    write_whole(path, lambda file: _write(_in_parts(results), file.name))


def check_path(path: str | os.PathLike[str], field: str = "path") -> None:
    """Check that results can be written to a path, before they are computed.

    Parameters
    ----------
    path : str or path
    field : str
        Name of the path in a message.

    Raises
    ------
    InputError
        When the path does not end in ``.nc``, is a folder, lies in no folder or cannot be written, or the library that
        writes netCDF is missing.
    """
    check_place(path, ".nc", field)
    need("netCDF4", field, "netCDF files")


def load_results(path: str | os.PathLike[str]) -> Dataset:
    """Return the dataset that `save_results` has written, with complex numbers made of their two parts.

    Parameters
    ----------
    path : str or path
        A .nc file.

    Returns
    -------
    xarray.Dataset

    Raises
    ------
    InputError
        When the file does not exist or is no netCDF file.
    """
    import xarray  # here, because it takes long to import

    check_file("path", path)
    need("netCDF4", "path", "netCDF files")
    try:
        with _ONE_AT_A_TIME, xarray.open_dataset(path, engine="netcdf4") as stored:
            return _whole(stored.load())
    except OSError as error:
        raise InputError("path", path, f"cannot be read as netCDF ({error.strerror or error})") from None


def _write(results: Dataset, path: str) -> None:
    """Write a dataset without complex numbers.

    Raises
    ------
    OSError
        When the file cannot be written.
    """
    try:
        with _ONE_AT_A_TIME:
            results.to_netcdf(path, engine="netcdf4", format="NETCDF4")
    except RuntimeError as error:  # raised by the library when the disk is full
        raise OSError(errno.EIO, f"{error}: is the disk full?") from None


def _in_parts(results: Dataset) -> Dataset:
    """Return a dataset with complex variables as two parts; the parts are views, not copies."""
    parts = {}
    for name, variable in results.variables.items():
        if not np.iscomplexobj(variable.values):
            continue
        if name in results.coords:
            raise InputError(str(name), None, "cannot be stored: it is a complex coordinate")
        for ending, array in zip(_PARTS, (variable.values.real, variable.values.imag), strict=True):
            if f"{name}{ending}" in results.variables:
                rule = f"has the name that a part of {name} is stored under"
                raise InputError(f"{name}{ending}", None, rule)
            parts[f"{name}{ending}"] = (variable.dims, array, {**variable.attrs, _COMPLEX: name})
    whole = {attributes[_COMPLEX] for _, _, attributes in parts.values()}
    return results.drop_vars(whole).assign(parts)


def _whole(stored: Dataset) -> Dataset:
    """Return a dataset with complex variables made of their two parts."""
    for name in dict.fromkeys(v.attrs[_COMPLEX] for v in stored.data_vars.values() if _COMPLEX in v.attrs):
        real, imaginary = (stored[f"{name}{ending}"] for ending in _PARTS)
        number = np.empty(real.shape, dtype=complex)  # real + 1j * imaginary would lose signs and infinities
        number.real, number.imag = real.values, imaginary.values
        attributes = {key: value for key, value in real.attrs.items() if key != _COMPLEX}
        stored = stored.assign({name: (real.dims, number, attributes)})
        stored = stored.drop_vars([f"{name}{ending}" for ending in _PARTS])
    return stored
