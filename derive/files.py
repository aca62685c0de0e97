"""Files that the derivation writes: each is complete, or stays as it was."""

from __future__ import annotations

import os
import secrets
from pathlib import Path


def write_whole(path: Path, content: str | bytes) -> None:
    """Write a file under another name, and put it in its place when it is complete.

    `proprotor` has a writer of its own, which cannot be imported while the generated equations are missing.

    Raises
    ------
    OSError
        When the file cannot be written; the file that was there stays.
    """
    unfinished = path.with_name(f".proprotor-{secrets.token_hex(8)}.tmp")
    data = content.encode() if isinstance(content, str) else content
    try:
        with unfinished.open("xb") as file:
            file.write(data)
        os.replace(unfinished, path)
    finally:
        unfinished.unlink(missing_ok=True)
