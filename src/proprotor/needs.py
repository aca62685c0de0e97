"""What a computation needs of the machine it runs on: packages and memory, asked for before the first point.

A computation that lacks something at its end has cost its time for nothing, so each need is told in one message at
once: which package to install, or which input to reduce.
"""

from __future__ import annotations

import importlib
from pathlib import Path

from proprotor.errors import InputError

_SMALL = 64e6  # bytes; not worth asking the system
_GROUPS, _GROUP_OF_PROCESS = Path("/sys/fs/cgroup"), Path("/proc/self/cgroup")  # where Linux tells its limits


def need(package: str, field: str, purpose: str, extra: str = "") -> None:
    """Refuse what needs a package that cannot be imported.

    Parameters
    ----------
    package : str
        Name of its module, or of one within it.
    field : str
        What the message names as the input that asked for it.
    purpose : str
        What the package is for, as in "needs netCDF4 for netCDF files".
    extra : str
        The extra of proprotor that brings the package; empty for one that proprotor itself brings.

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
        reason = "" if error.name == name else f" ({error})"  # one that is there, and cannot be imported
        raise InputError(field, None, f"needs {name} for {purpose}: {install}{reason}") from None


def free_memory() -> float:
    """Return the memory that this process may still take, bytes."""
    import psutil  # here, because it is not needed for small things

    return min(float(psutil.virtual_memory().available), _free_of_group(), _free_address_space())


def _free_of_group() -> float:
    """Return what the control group of a container or a job of a cluster leaves, bytes; inf where nothing limits it."""
    try:
        own = _GROUP_OF_PROCESS.read_text().removeprefix("0::/").strip()
    except OSError:  # not on Linux
        return float("inf")
    groups = [_GROUPS / own, *(_GROUPS / own).parents]
    return min(_left(group) for group in groups if group.is_relative_to(_GROUPS))


def _left(group: Path) -> float:
    try:
        most, taken = (int((group / name).read_text()) for name in ("memory.max", "memory.current"))
        told = dict(line.split() for line in (group / "memory.stat").read_text().splitlines())
    except (OSError, ValueError):  # no such group, or "max" for no limit
        return float("inf")
    cached = int(told.get("inactive_file", 0))  # of files, which the system gives back
    return max(0.0, float(most - taken + cached))


def _free_address_space() -> float:
    """Return what a limit on the process (``ulimit -v``) leaves of its address space, bytes; inf without a limit."""
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
    """Refuse what would not fit into the memory that is free, before any of it is taken.

    Parameters
    ----------
    field, value : str, object
        The input that makes it large, for the message.
    size : float
        Bytes that will be taken at once.
    what : str
        What takes them, such as "the results of 1e+12 designs".
    remedy : str
        What to do, where that is not to reduce the field.

    Raises
    ------
    InputError
    """
    if size <= _SMALL:
        return
    free = free_memory()
    if size > free:
        taken = f"{what} would take {_told(size)} of memory, and {_told(free)} are free"
        raise InputError(field, value, f"{taken}: {remedy or f'reduce {field}'}")


def _told(size: float) -> str:
    return f"{size / 1e9:,.1f} GB"
