"""The environment of a process that runs the package of a folder, as it runs once it is installed."""

from __future__ import annotations

import os
from pathlib import Path


def of_package(folder: Path, compiled: str) -> dict[str, str]:
    """Return the variables of the environment, with a folder for compiled modules: compiled once, then read."""
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    paths = os.pathsep.join(str(folder / part) for part in ("src", "generated"))
    return kept | {"PYTHONPATH": paths, "PYTHONPYCACHEPREFIX": compiled}
