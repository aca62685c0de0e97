"""Text that may be shown: nothing in it moves a cursor, colours, hides or turns round what stands beside it."""

from __future__ import annotations

import unicodedata

# Controls, formats such as those that turn the direction of text round, halves of characters, characters without a
# known shape, ends of lines.
_NEVER = ("Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp")


def unprintable(text: str) -> str:
    """The first character of a text that may not be shown, such as ``U+001B``; empty where there is none."""
    found = next((c for c in text if unicodedata.category(c) in _NEVER), "")
    return f"U+{ord(found):04X}" if found else ""


def printable(text: str, keep: str = "") -> str:
    """A text with a space for each character that may not be shown, except those to keep."""
    if text.isprintable():
        return text
    return "".join(c if c in keep or c.isprintable() else " " for c in text)
