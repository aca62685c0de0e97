"""The documentation site builds without a warning, needs no network, and every link within it leads somewhere."""

import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

import pytest

pytestmark = pytest.mark.verify

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
LOADED = {"script": "src", "link": "href", "img": "src", "iframe": "src"}


class Page(HTMLParser):
    """Links, anchors, pictures and what is loaded of an HTML page."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links, self.anchors, self.loaded, self.without_text = [], set(), [], []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.anchors |= {given[key] for key in ("id", "name") if given.get(key)}
        if tag == "a" and given.get("href"):
            self.links.append(given["href"])
        if given.get(LOADED.get(tag, "")):
            self.loaded.append(given[LOADED[tag]])
        if tag == "img" and not (given.get("alt") or "").strip():
            self.without_text.append(given.get("src"))


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """Path and content of every page."""
    folder = tmp_path_factory.mktemp("site")
    command = [
        "sphinx",
        "-W",
        "--keep-going",
        "-q",
        "-b",
        "html",
        "-d",
        folder / "doctrees",
        DOCS,
        folder / "html",
    ]
    done = subprocess.run([sys.executable, "-m", *command], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    pages = {path: Page(path) for path in (folder / "html").rglob("*.html")}
    assert len(pages) > 80
    return pages


def test_every_link_within_the_site_leads_somewhere(site):
    for path, page in site.items():
        for link in page.links:
            if ":" in link.partition("/")[0]:
                continue
            target, _, place = unquote(link).partition("#")
            other = (path.parent / target).resolve() if target else path
            assert other.exists(), (path, link)
            if place and other in site:
                assert place in site[other].anchors, (path, link)


def test_nothing_is_loaded_from_elsewhere(site):
    for path, page in site.items():
        assert not [address for address in page.loaded if "//" in address], path


def test_every_picture_has_a_text(site):
    """But for those that a notebook drew when the site was made, whose code stands above them."""
    for path, page in site.items():
        assert not [source for source in page.without_text if "_images" not in source], path


def test_no_page_shows_where_the_site_was_made(site):
    """Such as the address of an object, or the folder of a module, which every machine has another of."""
    for path in site:
        text = path.read_text(encoding="utf-8")
        assert str(ROOT) not in text and not re.search(r"\bat 0x[0-9a-f]{6}", text), path


def test_formulas_are_set(site):
    source = (DOCS / "theory" / "kinematics.md").read_text(encoding="utf-8")
    written = len(re.findall(r"\$\$.*?\$\$|\$[^$]+\$", source, re.DOTALL))
    (kinematics,) = [path for path in site if path.parts[-2:] == ("theory", "kinematics.html")]
    text = kinematics.read_text(encoding="utf-8")
    assert text.count("<math") == written > 10 and "merror" not in text
