"""Every block of code in the documentation runs, in the order of its page, and prints what the page shows."""

import re

import pytest
from PIL import Image

from proprotor.commands.main import main
from tests import documentation
from tests.documentation import DOCS, NOT_RUN, Block, Runner, blocks, compare, name_of, pages

PAGES = [page for page in pages() if blocks(page)]


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_the_code_of_a_page_runs_and_prints_what_the_page_shows(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    runner = Runner(tmp_path)
    for block in blocks(page):
        try:
            runner.run(block)
        except Exception as error:
            error.add_note(f"{name_of(page)}, line {block.line}")
            raise
    assert_pictures_are_those_shown(page, tmp_path)


def assert_pictures_are_those_shown(page, made):
    """A picture of the page under a name that its code writes is such a picture: as large, and of the same kind."""
    for shown in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", page.read_text(encoding="utf-8")):
        kept = (page.parent / shown).resolve()
        if (new := made / kept.name).exists():
            with Image.open(new) as one, Image.open(kept) as other:
                assert (one.size, one.format) == (other.size, other.format), shown


def test_every_picture_of_the_gallery_is_made_by_the_code_of_its_page():
    page = DOCS / "plots.md"
    code = "".join(block.text for block in blocks(page))
    shown = re.findall(r"\]\(gallery/([^)]+)\)", page.read_text(encoding="utf-8"))
    assert sorted(shown) == sorted(path.name for path in (DOCS / "gallery").iterdir())
    assert all(f'"{name}"' in code for name in shown)
    assert all((DOCS / "gallery" / name).stat().st_size < 300_000 for name in shown)


def test_what_is_not_run_is_still_somewhere():
    """A name in the list that no page needs any more has to go, unless it is of a command that is not there."""
    firsts = [line.strip() for page in pages() for block in blocks(page) for line in block.text.splitlines()]
    for start in NOT_RUN:
        if start.startswith("proprotor ") and start.split()[1] not in main.commands:
            continue
        assert any(line.startswith(start) for line in firsts), start


def test_a_block_that_nothing_runs_is_found(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(
        "# Page\n\n```fortran\nprint *, 1\n```\n\ntext\n\n    rm -rf everything\n\n```text\n1\n```\n"
    )
    fortran, indented, text = blocks(page)
    assert [block.kind for block in (fortran, indented, text)] == ["fortran", "", "text"]
    for block in (fortran, indented, text, Block("sh", "rm -rf everything\n", 1)):
        with pytest.raises(AssertionError):
            Runner(tmp_path).run(block)


def test_other_numbers_and_other_words_are_found():
    printed = "flutter 373.34 kt\nat 5.1330 Hz\n3 modes\n"
    compare("flutter 373.35 kt\n...\n3 modes\n", printed)
    for shown in (
        "flutter 373.36 kt\n",
        "divergence 373.34 kt\n",
        "4 modes\n",
        "flutter 373.34 kt\n3 modes\n",
    ):
        with pytest.raises(AssertionError, match="not printed"):
            compare(shown, printed)


def test_pages_are_found():
    assert {"README.md", "docs/tutorial.md", "docs/plots.md", "docs/howto/flutter.md"} <= set(
        map(name_of, pages())
    )
    assert set(documentation.RUN_ELSEWHERE) == {"notebooks"}
