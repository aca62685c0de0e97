"""The page of plots: its code runs, and makes the pictures it shows."""

import re

import pytest
from PIL import Image

from benchmarks import gallery


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("gallery")
    gallery.make(folder)
    return folder


def test_the_page_shows_what_its_code_makes(made):
    shown = re.findall(r"\]\(gallery/([^)]+)\)", gallery.PAGE.read_text(encoding="utf-8"))
    assert sorted(shown) == sorted(path.name for path in made.iterdir())
    assert sorted(shown) == sorted(path.name for path in gallery.GALLERY.iterdir())


def test_pictures_in_the_gallery_are_as_large_as_those_just_made_and_small_as_files(made):
    for path in made.iterdir():
        with Image.open(path) as new, Image.open(gallery.GALLERY / path.name) as kept:
            assert (new.size, new.format) == (kept.size, kept.format), path.name
        assert (gallery.GALLERY / path.name).stat().st_size < 300_000, path.name
