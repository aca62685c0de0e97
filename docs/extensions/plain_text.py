"""Docstrings and help texts are plain text with a little reStructuredText: a bar is the bar of |s|, no markup.

Lines that a help text keeps as they are, which sphinx-click marks with a bar before each, are shown as they are.
"""

from __future__ import annotations

from itertools import groupby

from sphinx.application import Sphinx


def of_docstring(app: Sphinx, *arguments: object) -> None:
    lines = arguments[-1]
    assert isinstance(lines, list)
    lines[:] = [line.replace("|", r"\|") for line in lines]


def of_help(app: Sphinx, context: object, lines: list[str]) -> None:
    text: list[str] = []
    for kept, group in groupby(lines, key=lambda line: line.startswith("|")):
        if kept:
            text += ["::", "", *(f"   {line.removeprefix('|').removeprefix(' ')}" for line in group), ""]
        else:
            text += [line.replace("|", r"\|") for line in group]
    lines[:] = text


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("autodoc-process-docstring", of_docstring)
    for part in ("description", "epilog", "options"):
        app.connect(f"sphinx-click-process-{part}", of_help)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
