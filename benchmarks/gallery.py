"""Makes the pictures of docs/plots.md in docs/gallery with the code that the page shows.

python -m benchmarks.gallery
"""

from __future__ import annotations

import contextlib
import re
import warnings
from pathlib import Path

import matplotlib

DOCS = Path(__file__).parents[1] / "docs"
PAGE, GALLERY = DOCS / "plots.md", DOCS / "gallery"


def code_of_page() -> str:
    """All Python of the page, in its order."""
    return "\n".join(re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL))


def make(folder: Path) -> None:
    """Run the code of the page in a folder."""
    matplotlib.use("Agg")
    from matplotlib import pyplot

    folder.mkdir(parents=True, exist_ok=True)
    with contextlib.chdir(folder), warnings.catch_warnings():
        warnings.simplefilter("error")
        exec(compile(code_of_page(), str(PAGE), "exec"), {"__name__": "gallery"})
    pyplot.close("all")


def main() -> None:
    make(GALLERY)
    for picture in sorted(GALLERY.iterdir()):
        print(f"{picture.stat().st_size / 1024:6.0f} kB  {picture.name}")


if __name__ == "__main__":
    main()
