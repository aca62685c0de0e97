"""Links from a page to a file of the repository lead to a page of the site that shows the file, at its line."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

from docutils import nodes
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import get_lexer_for_filename
from pygments.util import ClassNotFound
from sphinx.application import Sphinx

ROOT = Path(__file__).parents[2]
SCHEME = "source:"
# ](../derive/kinematics.py#L102), from a page in docs/ or in a folder of it
LINK = re.compile(r"\]\((?:\.\./)+((?:derive|generated|src|tests|benchmarks|notebooks|templates)/[^)\s]*)\)")
OUTSIDE = re.compile(r"\]\((?:\.\./)+([A-Z][\w.]*|pyproject\.toml|Makefile)\)")


def mark(app: Sphinx, page: str, text: list[str]) -> None:
    """Give links out of docs/ a scheme of their own, so that they are not looked for among the pages."""
    depth = page.count("/") + 1

    def marked(match: re.Match[str]) -> str:
        up = match[0].count("../")
        return f"]({SCHEME}{match[1]})" if up == depth else match[0]

    text[0] = LINK.sub(marked, text[0])


def shown(document: nodes.document) -> Iterator[nodes.reference]:
    for link in document.findall(nodes.reference):
        if link.get("refuri", "").startswith(SCHEME):
            yield link


def lead_there(app: Sphinx, document: nodes.document, page: str) -> None:
    for link in shown(document):
        path, _, place = link["refuri"].removeprefix(SCHEME).partition("#")
        if not (ROOT / path).is_file():
            raise FileNotFoundError(f"{page}: no such file: {path}")
        app.source_files.add(path)  # type: ignore[attr-defined]
        up = "../" * page.count("/")
        link["refuri"] = f"{up}source/{path}.html" + (f"#{place}" if place else "")


def write(app: Sphinx, error: Exception | None) -> None:
    """A page for each file that was linked."""
    if error is not None:
        return
    for path in sorted(app.source_files):  # type: ignore[attr-defined]
        target = Path(app.outdir) / "source" / f"{path}.html"
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(as_page(path), encoding="utf-8")


def as_page(path: str) -> str:
    code = (ROOT / path).read_text(encoding="utf-8")
    try:
        lexer = get_lexer_for_filename(PurePosixPath(path).name)
    except ClassNotFound:
        lexer = get_lexer_for_filename("x.txt")
    formatter = HtmlFormatter(full=True, title=path, linenos="inline", linespans="L")
    return re.sub(r'id="L-(\d+)"', r'id="L\1"', highlight(code, lexer, formatter))


def setup(app: Sphinx) -> dict[str, bool]:
    app.source_files = set()  # type: ignore[attr-defined]
    app.connect("source-read", mark)
    app.connect("doctree-resolved", lead_there)
    app.connect("build-finished", write)
    return {"parallel_read_safe": False, "parallel_write_safe": False}
