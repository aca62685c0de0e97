"""Needs of a computation: packages and memory, checked before the first point is computed.

A computation that fails at its end for lack of a package or of memory has cost its time for nothing. So each check
stands at the start, and its one message says which package to install or which input to reduce.
"""

from __future__ import annotations

import importlib
from pathlib import Path

from proprotor.errors import InputError

_SMALL = 64e6  # bytes; for less the system is not asked
_GROUPS, _GROUP_OF_PROCESS = Path("/sys/fs/cgroup"), Path("/proc/self/cgroup")  # where Linux keeps its limits
_FILES = {  # of control groups, versions 2 and 1: limit, use, and the part in use that the system would free
    "": ("memory.max", "memory.current", "inactive_file"),
    "memory": ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"),
}


def need(package: str, field: str, purpose: str, extra: str = "") -> None:
    """Refuse a request that needs a package which cannot be imported.

    Parameters
    ----------
    package : str
        Name of the package's module, or of a module within the package.
    field : str
        Name of the input that needs the package, for the message.
    purpose : str
        What the package is for, as in "needs netCDF4 for netCDF files".
    extra : str
        The extra of proprotor that installs the package; empty for a package that proprotor itself installs.

    Raises
    ------
    InputError
        With the command that installs the package.
    """
    name = package.partition(".")[0]
    try:
        importlib.import_module(name)
        importlib.import_module(package)
    except ImportError as error:
        install = f'pip install "proprotor[{extra}]"' if extra else f"pip install {name}"
        reason = "" if error.name == name else f" ({error})"  # an installed package that cannot be imported
        raise InputError(field, None, f"needs {name} for {purpose}: {install}{reason}") from None


def free_memory() -> float:
    """Return the memory that this process may still take, bytes."""
    import psutil  # here, because small computations do not need it

    return min(float(psutil.virtual_memory().available), _free_of_group(), _free_address_space())


def _free_of_group() -> float:
    """Return the memory that the control group of a container or a cluster's job leaves, bytes; inf without a limit."""
    try:
        lines = _GROUP_OF_PROCESS.read_text(encoding="utf-8").splitlines()
    except OSError:  # not on Linux
        return float("inf")
    free = float("inf")
    for line in lines:
        _, controllers, own = line.split(":", 2)
        if controllers in _FILES:
            root = _GROUPS / controllers
            group = root / own.lstrip("/")
            around = [folder for folder in (group, *group.parents) if folder.is_relative_to(root)]
            free = min(free, *(_left(folder, *_FILES[controllers]) for folder in around))
    return free


def _left(group: Path, limit: str, used: str, cached: str) -> float:
    """Return the memory that one control group leaves, bytes; inf without a limit."""
    try:
        most, taken = (int((group / name).read_text(encoding="ascii")) for name in (limit, used))
        stat = dict(line.split() for line in (group / "memory.stat").read_text(encoding="ascii").splitlines())
    except (OSError, ValueError):  # no such group, or "max" for no limit
        return float("inf")
    return max(0.0, float(most - taken + int(stat.get(cached, 0))))


def _free_address_space() -> float:
    """Return the address space that a limit on the process (``ulimit -v``) leaves, bytes; inf without a limit."""
    try:
        import resource
    except ImportError:  # Windows has no such limit
        return float("inf")
    most, _ = resource.getrlimit(resource.RLIMIT_AS)
    if most == resource.RLIM_INFINITY:
        return float("inf")
    import psutil

    return max(0.0, float(most - psutil.Process().memory_info().vms))


def check_memory(field: str, value: object, size: float, what: str, remedy: str = "") -> None:
    """Refuse a computation that would not fit into the free memory, before any memory is taken.

    Parameters
    ----------
    field, value : str, object
        The input that makes the computation large, for the message.
    size : float
        Bytes that will be taken at once.
    what : str
        What takes the memory, such as "the results of 1e+12 designs".
    remedy : str
        What the user can do, if not to reduce the field.

    Raises
    ------
    InputError
    """
    if size <= _SMALL:
        return
    free = free_memory()
    if size > free:
        taken = f"{what} would take {_gigabytes(size)} of memory, and {_gigabytes(free)} are free"
        raise InputError(field, value, f"{taken}: {remedy or f'reduce {field}'}")


def _gigabytes(size: float) -> str:
    """Return a number of bytes as text in GB."""
    return f"{size / 1e9:,.1f} GB"
