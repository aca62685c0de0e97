"""Every example runs, draws its picture, and is the same as its notebook; the page lists all."""

import re

import nbformat
import pytest
from PIL import Image

from benchmarks import examples
from proprotor.deck.file import read_tables
from proprotor.deck.validation import validate

SCRIPTS = examples.scripts()
TOLD = "`python -m benchmarks.examples` writes it anew"


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_an_example_runs_and_draws_its_picture(script, tmp_path):
    printed = examples.run(script, tmp_path)
    assert re.search(r"\d", printed)
    sizes = []
    for folder in (tmp_path, examples.EXAMPLES):
        with Image.open(folder / f"{script.stem}.png") as picture:
            assert min(picture.size) > 300 and sum(picture.convert("L").histogram()[:128]) > 1000
            sizes.append(picture.size)
    assert sizes[0] == sizes[1], f"the picture is one of an earlier version: {TOLD}"


def test_the_slope_of_the_example_is_that_of_two_searches(tmp_path):
    (script,) = (script for script in SCRIPTS if script.stem == "inputs-that-matter")
    slope, searches = map(float, re.findall(r"(\d+\.\d+) KTAS", examples.run(script, tmp_path)))
    assert slope == pytest.approx(searches, abs=0.01)


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_the_notebook_of_an_example_is_current(script):
    path = script.with_suffix(".ipynb")
    assert path.read_text(encoding="utf-8") == examples.notebook_of(script), TOLD
    nbformat.validate(nbformat.read(path, as_version=4))


def test_the_page_lists_every_file_of_the_examples():
    page = examples.PAGE.read_text(encoding="utf-8")
    assert page == examples.page(), TOLD
    files = {path.name for path in examples.EXAMPLES.iterdir()} - {examples.PAGE.name}
    assert set(re.findall(r"\]\(([\w-]+\.\w+)\)", page)) == files
    assert len(SCRIPTS) == len(re.findall(r"^## ", page, re.MULTILINE)) >= 5


def test_every_deck_of_the_examples_is_one():
    for deck in examples.EXAMPLES.glob("*.toml"):
        validate(read_tables(deck))
