"""Small pieces of HTML for notebooks: text is escaped, styles are inline, nothing is loaded."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape

from proprotor.datum import Datum
from proprotor.model import stamp
from proprotor.model.doubts import MARK

_CELL = "padding: 0.1em 0.8em 0.1em 0; border: 0; vertical-align: top; text-align: "
_WIDEST = 100  # characters of a text in a table


def block(title: str, *parts: str) -> str:
    """Return parts, which are HTML, below a title, which is text."""
    return f'<div style="line-height: 1.35"><b>{escape(title)}</b>{"".join(parts)}</div>'


def lines(texts: Iterable[str]) -> str:
    """Return texts as lines."""
    return "".join(f"<div>{escape(text)}</div>" for text in texts)


def doubt_lines(texts: Iterable[str]) -> str:
    """Return texts as lines behind the mark of doubtful numbers."""
    return lines(f"{MARK} {text}" for text in texts)


def table(heads: Sequence[str], rows: Iterable[Sequence[str]], numbers: int = 0) -> str:
    """Return a table of texts.

    Parameters
    ----------
    heads : sequence of str
    rows : iterable of sequences of str
    numbers : int
        How many of the first columns hold numbers, which are set to the right.
    """

    def row(cells: Sequence[str], tag: str) -> str:
        sides = ["right" if place < numbers else "left" for place in range(len(cells))]
        return "".join(
            f'<{tag} style="{_CELL}{side}">{escape(_short(cell))}</{tag}>'
            for side, cell in zip(sides, cells, strict=True)
        )

    head = f"<thead><tr>{row(heads, 'th')}</tr></thead>" if any(heads) else ""
    body = "".join(f"<tr>{row(cells, 'td')}</tr>" for cells in rows)
    return f'<table style="border-collapse: collapse; margin: 0.3em 0">{head}<tbody>{body}</tbody></table>'


def folded(summary: str, inside: str) -> str:
    """Return HTML that stays folded below a text until the reader opens it."""
    return f"<details><summary>{escape(summary)}</summary>{inside}</details>"


def inputs_not_read(inputs: Mapping[str, Datum]) -> str:
    """Return the inputs that were not read in a source, folded; nothing without such inputs."""
    if not inputs:
        return ""
    rows = [(path, one.written, one.status, one.source) for path, one in inputs.items()]
    shown = table(("input", "value", "status", "source"), rows)
    return folded(f"{len(rows)} inputs that were not read in a source", shown)


def origin_lines(found: stamp.Stamp) -> str:
    """Return the options that are no defaults, and the reservations about the numbers, of a result."""
    return lines([*stamp.unusual_options(found), *filter(None, [found.get("reservations", "")])])


def _short(text: str) -> str:
    return text if len(text) <= _WIDEST else f"{text[: _WIDEST - 1]}…"
