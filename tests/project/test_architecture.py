"""The list of rooms is the same in the contract, on the page of the architecture and in the docstring of the package."""

import re

import proprotor
from tests.documentation import DOCS
from tests.rooms import ROOMS, SOURCE, modules, tree_of


def test_the_page_has_a_row_for_each_room_in_order():
    page = (DOCS / "architecture.md").read_text(encoding="utf-8")
    assert tuple(re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE)) == ROOMS


def test_the_docstring_of_the_package_lists_the_rooms_in_order():
    lists = re.findall(r"^    (\w+(?: \w+)*?) {2,}\S", proprotor.__doc__, re.MULTILINE)
    assert tuple(" ".join(lists).split()) == ROOMS


def test_the_map_of_a_room_names_each_of_its_files():
    """A file that the map leaves out, or a line for a file that is gone."""
    for room in ("model", "deck"):
        doc = tree_of(SOURCE / room / "__init__.py").body[0].value.value
        listed = re.findall(r"^    (\w+) {2,}\S", doc, re.MULTILINE)
        assert sorted(listed) == sorted(
            name.partition(".")[2] for name in modules() if name.startswith(f"{room}.")
        )
