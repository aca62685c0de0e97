"""Reading the CSV files that commands write."""

from pathlib import Path


def without_comments(file: Path) -> list[str]:
    """The lines of a file but those that tell where its numbers come from."""
    return [line for line in file.read_text(encoding="utf-8").splitlines() if not line.startswith("# ")]
