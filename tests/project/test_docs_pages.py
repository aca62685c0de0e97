"""Pages of the documentation: links lead somewhere, pictures have a text, what is written by a command is current."""

import importlib
import re

import proprotor_equations
import pytest

import proprotor
from derive.pages import glossary
from derive.published import DROPPED_TERMS
from derive.symbols import QUANTITIES
from proprotor import plots
from tests.documentation import DOCS, ROOT, blocks, name_of

PAGES = [ROOT / "README.md", *(page for page in sorted(DOCS.rglob("*.md")) if "_build" not in page.parts)]
LINK = re.compile(r"(?<!!)\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^)\s]+)\)")
PICTURE = re.compile(r"!\[([^\]]*)\]\(([^)\s]+)\)")
FENCED = re.compile(r"^(```|~~~).*?^\1", re.DOTALL | re.MULTILINE)


def prose(page):
    return FENCED.sub("", page.read_text(encoding="utf-8"))


def anchors(page):
    """Of the headings, by the rule of forges: lower case, no punctuation, hyphens for blanks."""
    titles = re.findall(r"^#+ (.*)$", prose(page), re.MULTILINE)
    kept = ("".join(c for c in title.lower() if c.isalnum() or c in " -_") for title in titles)
    return {title.replace(" ", "-") for title in kept}


def is_object(name):
    """Whether a dotted name is something of the packages that the reference documents."""
    module, _, attribute = name.rpartition(".")
    try:
        return hasattr(importlib.import_module(module), attribute)
    except ImportError:
        return False


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_links_and_pictures_of_a_page(page):
    for target in LINK.findall(prose(page)):
        if target.startswith(("http:", "https:")):
            continue
        path, _, place = target.partition("#")
        if not path and place.startswith("proprotor"):
            assert is_object(place), target
            continue
        other = (page.parent / path).resolve() if path else page
        assert other.exists(), target
        if place and other.suffix == ".md":
            assert place in anchors(other), target
    for text, target in PICTURE.findall(prose(page)):
        assert text.strip(), f"no text for {target}"
        assert (page.parent / target).exists(), target


def test_no_page_is_left_out_of_the_site():
    listed = set()
    for page in DOCS.rglob("*.md"):
        for tree in re.findall(r"```\{toctree\}\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
            for entry in (line for line in tree.splitlines() if line and not line.startswith(":")):
                listed |= set(page.parent.glob(f"{entry}.md"))
    assert {page for page in PAGES if page.is_relative_to(DOCS)} - listed == {DOCS / "index.md"}


def test_the_glossary_is_current_and_has_every_symbol():
    page = glossary.PAGE.read_text(encoding="utf-8")
    assert page == glossary.page(), "`python -m derive.pages.glossary` writes docs/symbols.md anew"
    assert page.count("\n| $") == len(QUANTITIES)
    for quantity in QUANTITIES.values():
        assert f"`{quantity.symbol.name}`" in page and quantity.meaning in page


def test_every_dropped_term_has_its_row():
    page = (DOCS / "theory" / "published.md").read_text(encoding="utf-8")
    assert re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE) == list(DROPPED_TERMS)


def test_every_public_name_is_in_the_reference():
    page = (DOCS / "reference" / "api.md").read_text(encoding="utf-8")
    documented = {name.rpartition(".")[2] for name in re.findall(r"^   ([\w.]+)$", page, re.MULTILINE)}
    assert set(proprotor.__all__) - {"sampling"} <= documented
    assert {name for name in plots.__all__ if callable(getattr(plots, name, None))} <= documented


def test_every_generated_module_is_in_the_reference_and_every_function_in_the_theory():
    page = (DOCS / "reference" / "equations.md").read_text(encoding="utf-8")
    modules = {name for name in proprotor_equations.__all__ if name.islower()} - {"published", "fused"}
    modules |= {f"fused.{name}" for name in proprotor_equations.fused.__all__}
    published = {f"published.{name}" for name in proprotor_equations.published.__all__ if name.islower()}
    assert set(re.findall(r"automodule:: proprotor_equations\.([\w.]+)", page)) == modules | published
    theory = "".join(page.read_text(encoding="utf-8") for page in (DOCS / "theory").glob("*.md"))
    assert all(f"#proprotor_equations.{name}." in theory for name in modules)


WRITTEN_BY_HAND = [
    page
    for page in PAGES
    if not re.search(r"[Ww]ritten by\s+`?(python|make|proprotor)", page.read_text(encoding="utf-8")[:600])
]
WRITTEN_TABLE = re.compile(r"^<!-- python -m .*?^<!-- end of the table -->", re.DOTALL | re.MULTILINE)
LONGEST_PARAGRAPH = 150  # words, also of an item of a list: more is a wall of text
COLUMNS = 118  # of a line of code or output that the page shows without scrolling; commands wrap
MOST_WORDS = 3000  # of a page that is read, not looked up, as tables of a command are: a quarter of an hour


@pytest.mark.parametrize("page", WRITTEN_BY_HAND, ids=name_of)
def test_a_page_can_be_read_in_a_quarter_of_an_hour(page):
    read = WRITTEN_TABLE.sub("", page.read_text(encoding="utf-8"))
    assert len(read.split()) <= MOST_WORDS, "split the page"


@pytest.mark.parametrize("page", WRITTEN_BY_HAND, ids=name_of)
def test_no_paragraph_is_a_wall_of_text(page):
    for block in re.split(r"\n[ \t]*\n", prose(page)):
        if block.lstrip().startswith(("|", "<!--")):  # a table
            continue
        for item in re.split(r"\n(?=\s*(?:[-*]|\d+\.) )", block):
            words = item.split()
            assert len(words) <= LONGEST_PARAGRAPH, f"split the paragraph: {' '.join(words[:8])} ..."


@pytest.mark.parametrize("page", WRITTEN_BY_HAND, ids=name_of)
def test_code_and_output_fit_the_page(page):
    lines = [line for block in blocks(page) if block.kind != "sh" for line in block.text.splitlines()]
    assert [line for line in lines if len(line) > COLUMNS] == []
