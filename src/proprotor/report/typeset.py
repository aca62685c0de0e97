"""A document as PDF, by Typst (extra `report`)."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import fields
from datetime import date
from importlib import resources
from typing import Any

from proprotor.needs import need
from proprotor.report.document import Document, Picture


def check_typesetter() -> None:
    """Refuse to make a PDF without Typst; call this function before an analysis.

    Raises
    ------
    InputError
        If Typst is not installed.
    """
    need("typst", "--pdf", "a PDF", "report")


def pdf_of(document: Document) -> bytes:
    """Return the document as PDF. Typst reads all text as data, so that no text can act as a command.

    Raises
    ------
    InputError
        If Typst is not installed.
    """
    check_typesetter()
    import typst  # here, because only a PDF needs typst

    pictures = {
        f"{block.name}.svg": block.svg
        for section in document.sections
        for block in section.blocks
        if isinstance(block, Picture)
    }
    layout = resources.files("proprotor.report") / "templates" / "page.typ"
    files = {"main.typ": layout.read_bytes(), "document.json": json.dumps(document, default=_plain).encode()}
    noon = 86_400 * (date.fromisoformat(document.date) - date(1970, 1, 1)).days + 43_200
    compiled: Callable[..., bytes] = typst.compile  # the types of typst leave out a mapping of files
    return compiled({**files, **pictures}, timestamp=noon, ignore_system_fonts=True)


def _plain(part: Any) -> Any:
    """Return a part of a document as data for JSON; a picture without its content, which is a file by itself."""
    if isinstance(part, frozenset):
        return sorted(part)
    names = [field.name for field in fields(part) if field.name != "draw"] + ["kind"] * hasattr(part, "kind")
    return {name: getattr(part, name) for name in names}
