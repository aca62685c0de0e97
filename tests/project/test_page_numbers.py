"""Speeds in the sentences of pages: each is printed on its page, follows from a table there, or is given.

Tables between marks and blocks of output are written or compared by machine. A sentence that repeats such a number,
or tells what a table comes to, goes stale without anyone noticing; here it is compared with the table.
"""

import re
from typing import NamedTuple

import pytest

from benchmarks.page_table import DOCS
from tests.documentation import FENCE, INDENTED, ROOT, name_of, pages
from tests.project.test_page_tables import STATED

WRITTEN_PAGE = re.compile(r"[Ww]ritten by\s+`?(python|make|proprotor)")
TABLE = re.compile(
    r"^<!-- python -m benchmarks\.(.*?) --page(?:: (.*?))? -->\n(.*?)^<!-- end of the table -->$",
    re.DOTALL | re.MULTILINE,
)
NUMBER = r"[-+]?(?:\d[\d,]*)?\.?\d+"
SPEED = re.compile(rf"(?<![\w.,-])({NUMBER})(?:,? (?:to|and|or|for) ({NUMBER}))?\*{{0,2}}\s(?:kt|KTAS)\b")

# Numbers of sentences that nothing computes, and what they are.
GIVEN = {
    "docs/howto/close-a-loop.md": {"335": "the target of the example", "385": "1.15 times the target"},
    "docs/howto/optimise.md": {"320": "the dive speed of the example"},
    "docs/lag-frequency.md": {"285": "published", "305": "published"},
    "docs/theory/pitch.md": {"100": "an airspeed of the paper's Fig. 21"},
    "docs/theory/stability.md": {"50": "an airspeed"},
    "docs/theory/trim.md": {"300": "154.333 m/s in the code below"},
    "docs/xv15-aircraft.md": {
        **{"285": "published", "305": "published"},
        "130": "465 by Bell less 335 by Acree, Peyran and Johnson",
        **{speed: "an airspeed of tests/model/test_aircraft_oracle.py" for speed in ("300", "400")},
    },
    "docs/xv15-effects.md": {"285": "published", "305": "published"},
    "docs/xv15.md": {
        **{"285": "published", "305": "published"},
        **{speed: "tests/paper_figures/test_xv15.py" for speed in ("147", "201")},
    },
    "README.md": {
        **{"285": "published", "305": "published"},
        **{speed: "an end of the airspeeds of `make`" for speed in ("50", "400")},
    },
}


class Table(NamedTuple):
    """A table between marks: its headings, and its rows as text."""

    headings: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    def of(self, row, *columns):
        """The numbers in some columns, by default in all, of the row that begins with these cells."""
        cells = (row,) if isinstance(row, str) else row
        (found,) = (line for line in self.rows if line[: len(cells)] == cells)
        wanted = columns or self.headings[len(cells) :]
        return [first_number(found[self.headings.index(column)]) for column in wanted]

    def changes(self, row):
        """The numbers in brackets behind those of a row."""
        (found,) = (line for line in self.rows if line[0] == row)
        return [float(text) for cell in found for text in re.findall(r"\(([-+][\d.]+)\)", cell)]


def first_number(cell):
    found = re.search(r"\d[\d,.]*|[-+][\d,.]+", cell)
    return float(re.search(r"[-+]?[\d,.]+", cell)[0].replace(",", "")) if found else float("nan")


def tables(page):
    """The tables of a page, by benchmark and name."""
    found = {}
    for benchmark, name, body in TABLE.findall((DOCS / page).read_text(encoding="utf-8")):
        lines = [
            tuple(cell.strip() for cell in line.strip("|").split("|"))
            for line in body.splitlines()
            if line.startswith("|")
        ]
        found[benchmark, name] = Table(lines[0], tuple(lines[2:]))
    return found


def prose(text):
    """The sentences of a page: no code, no output, no written table."""
    for block in (TABLE, FENCE, INDENTED, re.compile(r"`[^`]*`")):
        text = block.sub(lambda match: "\n" * match[0].count("\n"), text)
    return text


def printed(text):
    """All numbers of the written tables, of the code and of the output of a page."""
    parts = [match[0] for block in (TABLE, FENCE, INDENTED) for match in block.finditer(text)]
    return [float(number.replace(",", "")) for part in parts for number in re.findall(NUMBER, part)]


def decimals(number):
    return len(number.partition(".")[2])


# What the tables of a page come to ------------------------------------------------------------------------------------

WINGS = ("xv15-uncoupled", "xv15", "xv15-wing")
LAGS, STIFFNESSES = ("springs of Table 1", "Bell's frequencies"), ("22,400", "11,000", "8,000", "7,400")


def first_of_wing(wing, lag, stiffness):
    (found,) = tables("xv15.md")["semispan_band", "inputs"].of(
        (f"`{wing}`", lag, stiffness), "first of the wing"
    )
    return found


def ends(values):
    values = [abs(value) for value in values]
    return min(values), max(values)


def of_lag():
    return ends(first_of_wing("xv15", LAGS[0], k) - first_of_wing("xv15", LAGS[1], k) for k in STIFFNESSES)


def of_stiffness():
    return ends(first_of_wing("xv15", lag, "22,400") - first_of_wing("xv15", lag, "7,400") for lag in LAGS)


def of_wings(one, other):
    return ends(
        first_of_wing(one, lag, k) - first_of_wing(other, lag, k) for lag in LAGS for k in STIFFNESSES
    )


def of_airfoils():
    found = tables("xv15-effects.md")["xv15_sections", ""]
    semispan, *aircraft = (
        one - other
        for one, other in zip(found.of("all of them"), found.of("one airfoil, as the deck is"), strict=True)
    )
    return semispan, *ends(aircraft)


def effects():
    return tables("xv15-effects.md")["xv15_effects", ""]


def of_pitch_stiffness():
    stiff = effects().of("K_θ 22,400 ft lbf/rad: control system alone")
    soft = effects().of("K_θ 5,346 ft lbf/rad: section moments")
    return stiff[0] - soft[0], stiff[1] - soft[1]


def of_inertia():
    modes = tables("supports-aircraft.md")["airframe_modes", "modes"]
    rows = [row for row in modes.rows if row[0] in ("antisymmetric beam", "antisymmetric chord")]
    return ends(float(percent) for row in rows for percent in re.findall(r"\(([-+]\d+) %\)", " ".join(row)))


def root_mean_square(mode):
    page = (DOCS / "validation.md").read_text(encoding="utf-8")
    return [float(re.search(rf"\*\*{mode}, all\*\* \| \d+ \| \*\*([\d.]+)\*\*", page)[1])]


def of_offsets(*rows):
    found = tables("theory/offsets.md")["offsets", ""]
    return ends(
        one - other
        for row, without in rows
        for one, other in zip(found.of(row), found.of(without), strict=True)
    )


AXIS, QUARTER = "both on the axis", "quarter chord as published, c.g. on the axis"
BY_MASS = [
    "c.g. on the published quarter chord",
    *(
        f"c.g. {where} of it"
        for where in ("1 % of the chord aft", "2 % of the chord aft", "2 % of the chord ahead")
    ),
]
EFFECTS, AIRCRAFT = "docs/xv15-effects.md", "docs/xv15-aircraft.md"


def band():
    return ends(first_of_wing("xv15", lag, k) for lag in LAGS for k in STIFFNESSES)


def loss(name, row):
    return lambda: tables("xv15-aircraft.md")["bell_boundaries", name].of(row)


def at(speeds, column):
    found = tables("xv15.md")["xv15_switches", "trim and lag"]
    return [found.of(speed, column)[0] for speed in speeds]


def of_coning(air):
    found = tables("xv15.md")["xv15_frequencies", "xv15-uncoupled"]
    return ends(found.of(row[0], f"coning {air}")[0] for row in found.rows)


def of_table_1():
    found = tables("lag-frequency.md")["lag_frequency", "Table 1"]
    return [
        found.of(speed, column)[0] for column in ("uncoupled ν_ζ", "Θ + δs, deg") for speed in ("50", "400")
    ]


def of_figure_14():
    found = tables("lag-frequency.md")["lag_frequency", "Table 1"]
    return [found.of(speed, "1 + Fig. 14: the same with airloads")[0] for speed in ("100", "400")]


# Page, sentence in which # stands for a number, and the numbers by the tables.
CONCLUDED = [
    ("docs/xv15.md", "wing as built, # to # kt", band),
    ("docs/xv15.md", "which lag\\*\\* is worth # to # kt", of_lag),
    ("docs/xv15.md", "which K_θ\\*\\* # to # kt", of_stiffness),
    ("docs/xv15.md", "coupling takes # to # kt", lambda: of_wings("xv15-uncoupled", "xv15")),
    ("docs/xv15.md", "own frequencies # to # kt", lambda: of_wings("xv15", "xv15-wing")),
    ("docs/xv15.md", "falls from # at 100 kt to # at 400 kt", lambda: at(("100", "400"), "low cyclic lag")),
    ("docs/xv15.md", "itself falls from # to # only", lambda: at(("50", "450"), "ν_ζ uncoupled")),
    ("docs/xv15.md", "in a vacuum the mode ends at #", lambda: at(("450",), "in a vacuum")),
    ("docs/xv15.md", "Coning.\\*\\* # to # with airloads", lambda: of_coning("with airloads")),
    ("docs/xv15.md", "# to # in a vacuum \\(the paper", lambda: of_coning("in a vacuum")),
    ("docs/lag-frequency.md", "So # → # belongs to # to #°", of_table_1),
    ("docs/lag-frequency.md", "from # at 100 kt to # at 400 kt", of_figure_14),
    (AIRCRAFT, "lag # to # for 1.454", lambda: of_table_1()[:2]),
    (AIRCRAFT, "# to # kt by wing, lag and K_θ", band),
    (AIRCRAFT, "# to # % above", of_inertia),
    (AIRCRAFT, "rms \\*\\*# kt\\*\\* below tip Mach .9 \\(23", lambda: root_mean_square("chord symmetric")),
    (AIRCRAFT, "rms \\*\\*# kt\\*\\* below tip Mach .9 \\(9", lambda: root_mean_square("beam antisymmetric")),
    (AIRCRAFT, "# kt symmetric, for -34; # kt antisymmetric, for -10", loss("stiffness", "sum")),
    (AIRCRAFT, "# kt symmetric, for -19; # kt antisymmetric, for -39", loss("downstop", "both")),
    (EFFECTS, "worth # kt of the semispan wing and # to # kt of the aircraft", of_airfoils),
    (EFFECTS, "is # kt of the semispan wing and # kt of the aircraft", of_pitch_stiffness),
    (
        EFFECTS,
        "stations lowers every boundary by # to # kt",
        lambda: ends(effects().changes("blade from stations")),
    ),
    (EFFECTS, "raises every boundary by # or # kt", lambda: ends(effects().changes("dynamic inflow"))),
    ("docs/theory/offsets.md", "takes # to # kt off", lambda: of_offsets((QUARTER, AXIS))),
    (
        "docs/theory/offsets.md",
        "moves it by up to # kt",
        lambda: of_offsets(*((row, QUARTER) for row in BY_MASS))[1:],
    ),
]
CONCLUDED = [(page, sentence.replace("#", f"({NUMBER})"), value) for page, sentence, value in CONCLUDED]


def read(page):
    return (ROOT / page).read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("page", "sentence", "value"), CONCLUDED, ids=[one[1].replace(f"({NUMBER})", "#") for one in CONCLUDED]
)
def test_a_sentence_tells_what_its_table_comes_to(page, sentence, value):
    told = re.search(sentence.replace(" ", r"\s+"), read(page))
    assert told, "the page has no such sentence"
    for text, number in zip(told.groups(), value(), strict=True):
        # Half a unit of the last digit, and a little: some tables have been rounded once already.
        assert float(text) == pytest.approx(number, abs=0.51 * 10 ** -decimals(text)), text


def unexplained(page, text):
    """The speeds in the sentences of a page that are not printed there, given, or compared with something."""
    sentences = [one[1] for one in (*STATED, *CONCLUDED) if one[0] == page]
    text_of_sentences = prose(text)
    compared = [
        match.span()
        for sentence in sentences
        for match in re.finditer(sentence.replace(" ", r"\s+"), text_of_sentences)
    ]
    known = printed(text)
    for match in SPEED.finditer(text_of_sentences):
        for group in (one for one in (1, 2) if match[one]):
            start, number = match.start(group), match[group]
            if any(begin <= start < end for begin, end in compared) or number in GIVEN.get(page, {}):
                continue
            value = float(number.replace(",", ""))
            # A number of one or two digits is found in any table: it has to be compared with what it says.
            digits = len(re.findall(r"\d", number))
            if digits > 2 and any(round(other, decimals(number)) == value for other in known):
                continue
            yield f"line {text_of_sentences.count(chr(10), 0, start) + 1}: {number} kt"


BY_HAND = [page for page in pages() if not WRITTEN_PAGE.search(page.read_text(encoding="utf-8")[:400])]


@pytest.mark.parametrize("page", BY_HAND, ids=name_of)
def test_every_speed_in_a_sentence_is_printed_given_or_compared(page):
    assert list(unexplained(name_of(page), page.read_text(encoding="utf-8"))) == []


def test_a_stale_speed_is_found():
    page = "Flutter is at 340 kt.\n\n```text\nflutter 339.8 kt\n```\n"
    assert list(unexplained("docs/any.md", page)) == []
    assert list(unexplained("docs/any.md", page.replace("340", "341"))) == ["line 1: 341 kt"]
    assert list(unexplained("docs/any.md", page.replace("340", "5 to 9"))) == ["line 1: 5 kt", "line 1: 9 kt"]


def test_what_is_given_is_still_in_its_page():
    for page, numbers in GIVEN.items():
        words = set(re.findall(NUMBER, prose(read(page))))
        assert set(numbers) <= words, page
