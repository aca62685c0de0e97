"""A document as PDF, set by Typst (extra `report`)."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import is_dataclass
from datetime import date
from importlib import resources
from typing import Any

from proprotor.needs import need
from proprotor.report.document import Document, Picture


def check_typesetter() -> None:
    """Refuse a PDF before anything is analysed.

    Raises
    ------
    InputError
        When Typst is not installed.
    """
    need("typst", "--pdf", "a PDF", "report")


def pdf_of(document: Document) -> bytes:
    """The document as PDF. Text is handed over as data, so that nothing in it is taken for a command.

    Raises
    ------
    InputError
        When Typst is not installed.
    """
    check_typesetter()
    import typst

    pictures = {
        f"{block.name}.svg": block.svg
        for section in document.sections
        for block in section.blocks
        if isinstance(block, Picture)
    }
    layout = resources.files("proprotor.report") / "templates" / "page.typ"
    files = {"main.typ": layout.read_bytes(), "document.json": json.dumps(_plain(document)).encode()}
    noon = 86_400 * (date.fromisoformat(document.date) - date(1970, 1, 1)).days + 43_200
    compiled: Callable[..., bytes] = typst.compile  # whose types leave out a mapping of files
    return compiled({**files, **pictures}, timestamp=noon, ignore_system_fonts=True)


def _plain(it: Any) -> Any:
    """Nested records as JSON has them; of a picture the name of its file."""
    if isinstance(it, tuple):
        return [_plain(entry) for entry in it]
    if isinstance(it, frozenset):
        return sorted(it)
    if not is_dataclass(it) or isinstance(it, type):
        return it
    if isinstance(it, Picture):
        return {"kind": it.kind, "name": it.name, "caption": it.caption, "alt": it.alt, "share": it.share}
    told = {name: _plain(getattr(it, name)) for name in it.__dataclass_fields__}
    return told | ({"kind": it.kind} if hasattr(it, "kind") else {})
