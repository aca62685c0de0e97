"""The pictures of pages and notebooks: drawn under the style sheet of the plots, and readable as these are."""

import ast
from pathlib import Path

import matplotlib
import numpy as np
import pytest

import proprotor as pp
from benchmarks import lag_frequency, linkages, offsets, pictures, tilted_flight
from benchmarks.paper_figures.content import Mark
from benchmarks.paper_figures.drawing import intervals
from derive.pages import display, figures
from proprotor import plots
from proprotor.plots.style import SHEET, in_style
from tests.readable import check_lines_differ, check_texts

ROOT = Path(__file__).parents[2]
# Where a figure is made or saved, and what brings it under the style sheet.
MAKERS = {
    "benchmarks/pictures.py": "calls what draws under the sheet",
    "derive/pages/figures.py": "`Picture` of display.py calls what draws under the sheet",
    "derive/pages/display.py": "calls what draws under the sheet",
    "derive/pages/drawings.py": "drawings of points of the derivation, without axes, legends or small print",
    "benchmarks/gallery.py": "closes what the code of the pages has drawn",
    "benchmarks/examples.py": "closes what the examples have drawn",
}
NAMES = ("pyplot", "savefig", "subplots", "add_subplot", "Figure", "rcParams", "rc_context")


def names_of(path):
    """Names that a file takes from Matplotlib to make, save or style a figure; not those in annotations."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield from (part for alias in node.names for part in alias.name.split(".") if part == "pyplot")
        elif isinstance(node, ast.Attribute):
            yield node.attr
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            yield node.func.id


@pytest.mark.parametrize("folder", ["benchmarks", "derive"])
def test_no_module_makes_or_saves_a_figure_of_its_own(folder):
    found = {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / folder).rglob("*.py")
        if set(names_of(path)) & set(NAMES)
    }
    assert found == {name for name in MAKERS if name.startswith(folder)}


def test_every_plot_of_the_product_is_drawn_under_the_sheet():
    for name in plots.__all__:
        if name.startswith("plot_"):
            assert hasattr(getattr(plots, name), "__wrapped__"), name


def test_what_is_written_is_drawn_under_the_sheet(tmp_path, monkeypatch):
    seen = []

    def draw():
        seen.append({name: matplotlib.rcParams[name] for name in SHEET})
        return pictures.panels(1, 2, 2)[0]

    monkeypatch.setattr(pictures, "FOLDER", tmp_path)
    pictures.write(draw, "one.png")
    display.Picture(draw)
    assert len(seen) == 2
    assert all(one[name] == SHEET[name] for one in seen for name in SHEET)
    assert SHEET["axes.labelsize"] != matplotlib.rcParams["axes.labelsize"]
    assert (tmp_path / "one.png").read_bytes().startswith(b"\x89PNG")


def invented_boundaries():
    """Boundaries of 340 kt and more, invented: the picture is looked at, and not the numbers."""
    speeds = {cyclic: 175 + step * np.arange(6) for step, cyclic in enumerate(tilted_flight.LABELS)}
    found = {
        cyclic: [tilted_flight.Boundary(speed, "beam", 0.0, 0.0) for speed in of]
        for cyclic, of in speeds.items()
    }
    return pp.load_case("xv15"), found, found["none"][:5]


ROWS = [("narrow", 370.0, 360.0, 372.0, 380.0), ("wide", 370.0, 350.0, 372.0, 390.0)]
PICTURES = {
    "lag frequency": lag_frequency.draw,
    "tilted flight": lambda: tilted_flight.draw(*invented_boundaries()),
    "intervals": lambda: intervals(ROWS, Mark((365.0, 375.0), "published"), "Boundary, KTAS", ["A note."]),
    "blade tip": figures.steady_tilt,
    "springs": figures.frequencies_against_collective,
    "inertias": figures.flap_hub_inertia_of_tables,
}
DRAWINGS = {"linkages": linkages.draw_panels, "offsets": offsets.draw}


@pytest.mark.parametrize("name", PICTURES | DRAWINGS)
def test_a_picture_is_readable(name):
    figure = in_style((PICTURES | DRAWINGS)[name])()
    check_texts(figure, least=3)
    if name in PICTURES:
        check_lines_differ(figure)
        for ax in figure.axes:
            assert ax.get_xlabel() and figure.axes[0].get_ylabel() + "".join(
                tick.get_text() for tick in ax.get_yticklabels()
            )


def test_two_cases_of_one_picture_differ_by_more_than_colour():
    figure, (ax,) = pictures.panels(1, 5, 4)
    for place in range(7):
        pictures.draw_case(ax, np.arange(20), np.arange(20) + place, place, f"case {place}")
    check_lines_differ(figure)
    ax.plot([0, 1], color="red", label="one")
    ax.plot([1, 0], color="blue", label="other")
    with pytest.raises(AssertionError):
        check_lines_differ(figure)
