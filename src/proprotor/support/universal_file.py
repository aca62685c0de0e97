"""Datasets of a universal file (.unv, .uff) that modes of a structure need, with the number of their line.

A dataset stands between two lines ``-1``; its first line is its number. Read are 15 and 2411 (nodes), 55 and 2414
(data at nodes: real normal modes) and 164 (units), as SDRC published them; all others are passed over, binary ones
too.

The package has a reader of its own: pyuff 2.5.8, which the tests compare with, takes no D exponents and no six complex
motions of a node in dataset 55, counts lines rather than values, and tells no line of an error.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

_NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eEdD][-+]?[0-9]+)?")
_END = "-1"
_NORMAL_MODE, _AT_NODES = 2, 1
_REAL, _COMPLEX = (2, 4), (5, 6)  # single and double precision
_MOTIONS = (3, 6)  # values of a node: translations, perhaps with rotations
_OF_OTHERS = {11: "velocity", 12: "acceleration"}  # quantities whose shapes belong to another modal mass
_LARGEST = 1e100  # beyond this value products overflow
_WIDTH = 10  # columns of a whole number


class UniversalFault(Exception):
    """A rule that a line of the file breaks."""

    def __init__(self, line: int, rule: str) -> None:
        super().__init__(f"line {line}: {rule}")


@dataclass
class Mode:
    """A normal mode in units of the file: frequency (Hz), modal mass, ratios of damping, motions of nodes."""

    number: int
    frequency: float
    mass: float
    viscous: float
    hysteretic: float
    motions: dict[int, list[float]]  # three translations, perhaps with three rotations


@dataclass
class UniversalFile:
    """What a file has: positions of nodes, modes, factors from SI (length, force), and how many modes are complex."""

    nodes: dict[int, list[float]] = field(default_factory=dict)
    modes: list[Mode] = field(default_factory=list)
    factors: tuple[float, float] | None = None
    complex_modes: int = 0


@dataclass
class _Block:
    """A dataset: its lines, and the number of the line before them."""

    lines: Sequence[str]
    before: int
    place: int = 0

    def take(self, what: str) -> str:
        """Return the next line, or refuse a dataset that ends before it."""
        if self.place == len(self.lines):
            raise self.fault(f"must not end the dataset, which needs {what}", 1)
        self.place += 1
        return self.lines[self.place - 1]

    def numbers(self, count: int, what: str) -> list[float]:
        """Return so many numbers from as many lines as they take."""
        found: list[float] = []
        while len(found) < count:
            line = self.take(what)
            if _NUMBER.sub("", line).strip():
                raise self.fault(f"must have numbers, {what}")
            found += [float(word.lower().replace("d", "e")) for word in _NUMBER.findall(line)]
        if len(found) > count or max(map(abs, found)) > _LARGEST:
            raise self.fault(f"must have {count} numbers, at most {_LARGEST:g}, {what}")
        return found

    def integers(self, count: int, what: str) -> list[int]:
        """Return the first whole numbers of the next line; blanks are zeros."""
        line = self.take(what)
        words = line.split()
        if len(words) < count and len(line.rstrip()) > _WIDTH:  # fields that touch or are blank
            words = [line[k : k + _WIDTH].strip() or "0" for k in range(0, count * _WIDTH, _WIDTH)]
        if len(words) < count or not all(re.fullmatch("[-+]?[0-9]{1,15}", word) for word in words[:count]):
            raise self.fault(f"must have {count} whole numbers, {what}")
        return [int(word) for word in words[:count]]

    def fault(self, rule: str, further: int = 0) -> UniversalFault:
        """Return the error of the line read last, or of a line further down."""
        return UniversalFault(self.before + self.place + further, rule)

    @property
    def has_more(self) -> bool:
        """Whether a line follows."""
        return self.place < len(self.lines)


def universal_file(text: str) -> UniversalFile:
    """Return what the text of a universal file has for modes.

    Raises
    ------
    UniversalFault
        With the number of the wrong line and its rule.
    """
    found = UniversalFile()
    for kind, block in _blocks(re.split("\r\n|\r|\n", text)):
        if kind in ("15", "2411"):
            _read_nodes(block, found, two_lines=kind == "2411")
        elif kind == "164":
            block.take("a code of units")
            length, force, _ = block.numbers(3, "the factors of units")
            found.factors = length, force
        elif kind == "55":
            _read_mode_of_55(block, found)
        elif kind == "2414":
            _read_mode_of_2414(block, found)
    return found


def _blocks(lines: list[str]) -> Iterator[tuple[str, _Block]]:
    """Yield number and lines of each dataset."""
    starts = [place for place, line in enumerate(lines) if line[:80].strip() == _END]
    if not starts:
        raise UniversalFault(1, "must be -1, as the first line of each dataset of a universal file")
    for start, end in zip(starts[::2], [*starts[1::2], None][: len(starts[::2])], strict=True):
        kind = lines[start + 1].split()[:1] if start + 1 < len(lines) else []
        if end is None:
            raise UniversalFault(
                len(lines), f"ends the file inside dataset {(kind or ['?'])[0]}, without its last line -1"
            )
        yield kind[0] if kind else "", _Block(lines[start + 2 : end], start + 2)


def _read_nodes(block: _Block, found: UniversalFile, *, two_lines: bool) -> None:
    """Add the positions of nodes: a label and three codes, then the coordinates on the same line or the next."""
    while block.has_more:
        if two_lines:
            label = block.integers(1, "the label of a node")[0]
            found.nodes[label] = block.numbers(3, "the coordinates of a node")
        else:
            numbers = block.numbers(7, "label, three codes and coordinates of a node")
            found.nodes[int(numbers[0])] = numbers[4:]


def _read_mode_of_55(block: _Block, found: UniversalFile) -> None:
    """Add the mode of a dataset 55, if it is a normal mode."""
    for _ in range(5):
        block.take("five lines of text")
    kinds = block.integers(6, "the kinds of data")
    if kinds[1] != _NORMAL_MODE or not _is_real(block, kinds, found):
        return
    *_, number = block.integers(4, "load case and mode number")
    what = "frequency, modal mass, viscous and hysteretic damping"
    frequency, mass, viscous, hysteretic = block.numbers(4, what)
    found.modes.append(Mode(number, frequency, mass, viscous, hysteretic, _motions(block, kinds[5])))


def _read_mode_of_2414(block: _Block, found: UniversalFile) -> None:
    """Add the mode of a dataset 2414, if it is a normal mode at nodes."""
    block.take("a label")
    block.take("a name")
    place = block.integers(1, "where the data are")[0]
    for _ in range(5):
        block.take("five lines of text")
    kinds = block.integers(6, "the kinds of data")
    if kinds[1] != _NORMAL_MODE or place != _AT_NODES or not _is_real(block, kinds, found):
        return
    number = block.integers(8, "eight whole numbers, the sixth of which is the mode")[5]
    block.take("two whole numbers")
    _, frequency, _, mass, viscous, hysteretic = block.numbers(6, "the numbers of the mode")
    block.numbers(6, "six further numbers of the mode")
    found.modes.append(Mode(number, frequency, mass, viscous, hysteretic, _motions(block, kinds[5])))


def _is_real(block: _Block, kinds: list[int], found: UniversalFile) -> bool:
    """Return whether the data are real motions of nodes; count complex ones and refuse other quantities."""
    _, _, _, quantity, data, count = kinds
    if data in _COMPLEX:
        found.complex_modes += 1
        return False
    if data not in _REAL or count not in _MOTIONS:
        return False
    if quantity in _OF_OTHERS:
        rule = f"says that the mode is one of {_OF_OTHERS[quantity]}; export shapes of displacement (8)"
        raise block.fault(rule)
    return True


def _motions(block: _Block, count: int) -> dict[int, list[float]]:
    """Return the motions of nodes by label."""
    found = {}
    while block.has_more:
        label = block.integers(1, "the label of a node")[0]
        found[label] = block.numbers(count, f"the {count} motions of node {label}")
    return found
