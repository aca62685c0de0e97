"""Ways to spoil bytes and texts, and the values that break programs."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from random import Random

NUMBERS = (
    *("0", "-0.0", "1", "-1", "0.5", "3", "7", "1e-3", "1e3", "1e-30", "1e30", "1e-308", "5e-324", "1e308"),
    *("1e309", "nan", "inf", "-inf", "9" * 400, "0x10", "1_000", "1__0", "+5", ".5", "5.", "1e", "--1"),
    *("2147483648", "9223372036854775808", "1,5", "½", "٣"),
)
UNITS = (
    *(
        "ft",
        "in",
        "m",
        "deg",
        "rad",
        "rpm",
        "Hz",
        "/rev",
        "slug",
        "slug*ft",
        "slug*ft**2",
        "kg/m**3",
        "%",
        "",
    ),
    *(
        "in*lbf/deg",
        "lbf",
        "kt",
        "m/s",
        "furlong",
        "parsec",
        "ft**-9",
        "ft**99",
        "ft**ft",
        "1/0",
        "((((",
        "-",
    ),
    *("N*m*s/rad", "lbf*in**2", "lb/in", "/rad", "rad/ft", "ft/rad", "ft ft", "ft;ft", "__class__", "e"),
)
TEXTS = (
    *("", " ", "x" * 5000, "[bold]x[/nope]", "[/]", "\x1b[31mred", "a\nb", "a\rb", "\0", "\ud7ff", "😀" * 30),
    *(
        "../../etc/passwd",
        "/etc/passwd",
        "/dev/zero",
        "/proc/self/mem",
        "/",
        ".",
        "..",
        "~",
        "xv15-uncoupled",
        "a" * 300,
    ),
    *(
        "__import__('os').system('touch executed')",
        "$(touch executed)",
        "`touch executed`",
        "; touch executed",
    ),
    *("!!python/object/apply:os.system ['touch executed']", "{0.__class__}", "%s%n%n", "${jndi:ldap://x}"),
    *("windmill", "normal-modes", "beam-wing", "matrices", "pivot", "rigid", "length", "angle", "published"),
)
_NUMBER = re.compile(r"-?\d+\.?\d*(?:[eE][+-]?\d+)?")

Spoil = Callable[[Random, str], str]


def spoiled_bytes(rng: Random, content: bytes, others: Sequence[bytes] = ()) -> bytes:
    """Bytes with one to a few edits; spans may come from other contents."""
    data = bytearray(content)
    for _ in range(rng.choice((1, 1, 2, 4, 16))):
        place, length = rng.randint(0, len(data)), rng.choice((1, 1, 2, 7, 64, 1000))
        source = rng.choice(others) if others else bytes(data)
        start = rng.randint(0, len(source))
        match rng.randrange(7):
            case 0 if data:
                data[place % len(data)] ^= 1 << rng.randrange(8)
            case 1:
                data[place : place + length] = rng.randbytes(min(length, 64))
            case 2:
                del data[place : place + length]
            case 3:
                data[place:place] = source[start : start + length]
            case 4:
                data[place : place + length] = source[start : start + length]
            case 5:
                data[place:place] = rng.choice(
                    (b"\0", b"\xff\xfe", b"\xef\xbb\xbf", b"\r\n", b"[" * 2000, b"\x1b[2J")
                )
            case _:
                del data[place:]
    return bytes(data)


def other_number(rng: Random, text: str) -> str:
    """One number of a text a little or far away, or replaced by a strange one."""
    found = list(_NUMBER.finditer(text))
    if not found:
        return text
    match = rng.choice(found)
    if rng.random() < 0.25:
        new = rng.choice(NUMBERS)
    else:
        factor = rng.choice((0.5, 0.9, 1.1, 2.0, 10.0, -1.0, 0.0, 1e-6, 1e6, 10 ** rng.uniform(-12, 12)))
        new = repr(float(match[0]) * factor) if len(match[0]) < 300 else "0"
    return text[: match.start()] + new + text[match.end() :]


def other_lines(rng: Random, text: str) -> str:
    """Lines left out, doubled, moved or cut short."""
    lines = text.split("\n")
    place, other = rng.randrange(len(lines)), rng.randrange(len(lines))
    match rng.randrange(5):
        case 0:
            del lines[place]
        case 1:
            lines.insert(other, lines[place])
        case 2:
            lines[place], lines[other] = lines[other], lines[place]
        case 3:
            lines[place] = lines[place][: rng.randint(0, len(lines[place]))]
        case _:
            del lines[min(place, other) : max(place, other)]
    return "\n".join(lines)


def several(rng: Random, text: str, ways: Sequence[Spoil]) -> str:
    """A text spoiled in one to a few of these ways."""
    for _ in range(rng.choice((1, 1, 1, 2, 3, 6))):
        text = rng.choice(ways)(rng, text)
    return text
