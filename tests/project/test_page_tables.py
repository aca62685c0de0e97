"""Numbers of pages that no block of code prints: tables between marks, and flutter speeds in sentences."""

import re

import numpy as np
import pytest

import proprotor as pp
from benchmarks.page_table import DOCS, END, markdown, with_table
from proprotor.units import KNOT
from tests.documentation import ROOT

MARK = re.compile(r"^<!-- python -m benchmarks\.(\w+) --page(?:: ([^>]+))? -->$", re.MULTILINE)
PAGES = {page: page.read_text(encoding="utf-8") for page in sorted(DOCS.rglob("*.md"))}
MARKS = [(page, match) for page, text in PAGES.items() for match in MARK.finditer(text)]


@pytest.mark.parametrize(("page", "mark"), MARKS, ids=[match[0][5:-4] for _, match in MARKS])
def test_a_mark_names_a_benchmark_that_writes_the_table_below_it(page, mark):
    source = (ROOT / "benchmarks" / f"{mark[1]}.py").read_text(encoding="utf-8")
    assert f'"{page.relative_to(DOCS).as_posix()}"' in source
    assert f"python -m benchmarks.{mark[1]} --page" in source
    below, end, _ = PAGES[page][mark.end() :].partition(END)
    assert end and "<!--" not in below
    assert len(re.findall(r"^\|", below, re.MULTILINE)) > 2


def test_a_table_is_replaced_and_nothing_else():
    page = f"before\n\n<!-- one -->\n\nold\n\n{END}\n\n<!-- two -->\n\nkept\n\n{END}\n"
    changed = with_table(page, "one", markdown(("a", "b"), [("1", "")]))
    assert changed == page.replace("old", "| a | b |\n|---|---|\n| 1 | |")
    with pytest.raises(ValueError, match="no place for a table"):
        with_table(page, "three", ["new"])


# Page, sentence with the number, deck, and how the mode's name begins whose first boundary it is.
STATED = [
    ("README.md", r"semispan wing, ([\d.]+) kt", "xv15", "beam"),
    ("README.md", r"the wing is at ([\d.]+) kt", "xv15-bell-frequencies", "beam"),
    ("README.md", r"comes first, at ([\d.]+) kt", "xv15-bell-frequencies", "regressive"),
    ("docs/tutorial.md", r"the XV-15 as it is has ([\d.]+) kt", "xv15", "beam"),
    ("docs/howto/close-a-loop.md", r"this wing flutters at ([\d.]+) KTAS", "xv15", "beam"),
    ("docs/howto/flutter.md", r"The wing follows at ([\d.]+) kt", "xv15-bell-frequencies", "beam"),
    ("docs/theory/linkages.md", r"\| as it is \| ([\d.]+) beam", "xv15", "beam"),
    (
        "docs/theory/linkages.md",
        r"\| as it is \| .*\| ([\d.]+) symmetric",
        "xv15-aircraft",
        "symmetric chord",
    ),
    ("docs/theory/tilted-flight.md", r"\| 0 \| ([\d.]+) \| beam", "xv15", "beam"),
    (
        "docs/xv15.md",
        r"`xv15-uncoupled` \| springs of Table 1 \| 8,000 .* chord (\d+) \|",
        "xv15-uncoupled",
        "chord",
    ),
    ("docs/xv15-effects.md", r"\| one airfoil, as the deck is \| ([\d.]+) beam", "xv15", "beam"),
    ("docs/xv15-effects.md", r"\| all of them \| ([\d.]+) beam", "xv15-sections", "beam"),
    ("docs/xv15-effects.md", r"\| as the deck is \| ([\d.]+) ", "xv15", "beam"),
]


@pytest.fixture(scope="module")
def first_boundary():
    """The first boundary of a mode of a deck, kt; each deck is searched once."""
    found = {}

    def of(deck, mode):
        if deck not in found:
            found[deck] = pp.load_case(deck).boundaries("200:420:20kt").boundaries
        own = [one.position / KNOT for one in found[deck] if one.onset and one.mode.startswith(mode)]
        return min(own, default=np.nan)

    return of


@pytest.mark.parametrize(("page", "sentence", "deck", "mode"), STATED)
def test_a_flutter_speed_in_a_page_is_that_of_the_deck(first_boundary, page, sentence, deck, mode):
    text = (ROOT / page).read_text(encoding="utf-8")
    number = re.search(sentence.replace(" ", r"\s+"), text)
    assert number, f"{page} has no such sentence: {sentence}"
    decimals = len(number[1].partition(".")[2])
    assert f"{first_boundary(deck, mode):.{decimals}f}" == number[1]
