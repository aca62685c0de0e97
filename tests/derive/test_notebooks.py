"""The notebooks run, hold no physics of their own, show every equation, and are what docs/notebooks has."""

import ast
import io
import re

import jupytext
import pytest
from PIL import Image

from derive.audit import printed
from derive.audit.headings import heading
from derive.pages import notebooks

SOURCES = notebooks.sources()
NAMES = ["kinematics", "inertia", "springs", "airloads", "pitch-and-couplings", "assembly-and-errata"]
NUMBERS = [
    *range(1, 38),
    *printed.NOMENCLATURE,
    "Table 1",
    "Table 2",
]
NUMBER = re.compile(r"\d+\.\d+")
# A boundary is interpolated between points 5 kt apart: another linear algebra library may move its last digit.
TOLERANCE = {"rel": 0.005, "abs": 0.06}


def cells(source, kind):
    """Return the cells of a kind, without those that a reader may change: tests/derive/test_chains.py runs these."""
    return [
        cell
        for cell in jupytext.read(source).cells
        if cell.cell_type == kind and cell.source and "chain" not in cell.metadata.get("tags", ())
    ]


def test_there_are_six_notebooks_in_the_order_of_the_derivation():
    assert [source.stem for source in SOURCES] == [f"{n}-{name}" for n, name in enumerate(NAMES, start=1)]
    pages = {path.stem for path in notebooks.PAGES.glob("*.md")}
    assert pages == {source.stem for source in SOURCES}


@pytest.fixture(scope="module")
def run_together():
    """Every notebook with its outputs, by name: what several derive is derived once."""
    ran = notebooks.executed(SOURCES)
    return {source.stem: notebook for source, notebook in zip(SOURCES, ran, strict=True)}


@pytest.mark.parametrize("source", SOURCES, ids=lambda source: source.stem)
def test_a_notebook_runs_without_a_warning_and_shows_what_its_page_shows(source, run_together):
    executed = run_together[source.stem]
    outputs = [output for cell in executed.cells for output in cell.get("outputs", ())]
    assert not [output for output in outputs if output.output_type in ("error", "stream")]
    assert all(
        cell.outputs for cell in executed.cells if cell.cell_type == "code" and "import" not in cell.source
    )
    text, pictures = notebooks.rendered(source, executed)
    page = notebooks.page_of(source).read_text(encoding="utf-8")
    told = f"`python -m derive.pages.notebooks {source.stem}` writes the page anew"
    assert NUMBER.split(page) == NUMBER.split(text), told
    shown, wanted = ([float(number) for number in NUMBER.findall(of)] for of in (page, text))
    assert shown == pytest.approx(wanted, **TOLERANCE), told
    assert {path.name for path in notebooks.PAGES.glob(f"{source.stem}-*.png")} == set(pictures), told
    for name, data in pictures.items():
        assert _size_of_drawn(data) == _size_of_drawn((notebooks.PAGES / name).read_bytes()), (
            f"{name}: {told}"
        )


SMALL = """# %% [markdown]
# See [the audit](../docs/audit.md), [springs](3-springs.py) and [the code](../derive/audit/report.py).

# %%
print("to a stream")
"to the page"

# %%
from IPython.display import Image, Markdown, display
from matplotlib.figure import Figure
import io
file = io.BytesIO()
Figure(figsize=(1, 1)).savefig(file, format="png")
display(Image(file.getvalue(), metadata={"alt": "a square"}), Markdown("*as it is*"))
"""


def test_pages_are_written_with_their_pictures_alone(tmp_path, monkeypatch, capsys):
    pages = tmp_path / "docs" / "notebooks"
    monkeypatch.setattr(notebooks, "ROOT", tmp_path)
    monkeypatch.setattr(notebooks, "NOTEBOOKS", tmp_path)
    monkeypatch.setattr(notebooks, "PAGES", pages)
    for name in ("7-small", "8-not-asked-for"):
        (tmp_path / f"{name}.py").write_text(SMALL)
    pages.mkdir(parents=True)
    for old in ("7-small-2.png", "8-not-asked-for-1.png"):
        (pages / old).touch()
    monkeypatch.chdir(tmp_path)  # where the sockets of the kernel are, as of the shell that starts it
    monkeypatch.setattr("sys.argv", ["derive.pages.notebooks", "7-small"])
    assert notebooks.main() == 0
    assert capsys.readouterr().out == "written: docs/notebooks/7-small.md\n"
    found = {path.name for path in pages.iterdir()}
    assert found == {"7-small.md", "7-small-1.png", "8-not-asked-for-1.png"}
    with Image.open(pages / "7-small-1.png") as picture:
        assert picture.size == (100, 100)
    text = (pages / "7-small.md").read_text()
    assert (
        "[the audit](../audit.md), [springs](3-springs.md) and [the code](../../derive/audit/report.py)"
        in text
    )
    assert "```text\nto a stream\n```" in text and "```text\n'to the page'\n```" in text
    assert "![a square](7-small-1.png)\n\n*as it is*\n" in text


def test_a_notebook_has_no_names_of_those_before_it(tmp_path, monkeypatch):
    monkeypatch.setattr(notebooks, "ROOT", tmp_path)
    monkeypatch.chdir(tmp_path)  # where the sockets of the kernel are
    (tmp_path / "1-names.py").write_text("# %%\nsomething = 1\nsomething")
    (tmp_path / "2-asks.py").write_text("# %%\nglobals().get('something', 'unknown')")
    first, second = notebooks.executed([tmp_path / "1-names.py", tmp_path / "2-asks.py"])
    assert first.cells[-1].outputs[0].data["text/plain"] == "1"
    assert second.cells[-1].outputs[0].data["text/plain"] == "'unknown'"


def test_a_notebook_that_there_is_not_is_told(monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["derive.pages.notebooks", "9-none"])
    assert notebooks.main() == 2
    told = capsys.readouterr().out
    assert told.startswith("no such notebook: 9-none; known: 1-kinematics, ") and told.count("\n") == 1


def _size_of_drawn(data: bytes) -> tuple[int, int]:
    """Return the size of a picture, on which more than a frame on white is drawn."""
    with Image.open(io.BytesIO(data)) as image:
        grey = image.convert("L")
        assert min(grey.size) > 200 and sum(grey.histogram()[:128]) > 1000
        return grey.size


def test_every_equation_and_table_has_its_cell_below_its_heading():
    found = []
    for source in SOURCES:
        name = None
        for cell in jupytext.read(source).cells:
            if cell.cell_type == "markdown":
                headings = re.findall(r"^### (.*)$", cell.source, re.MULTILINE)
                assert len(headings) <= 1 and (name is None or not headings), cell.source
                name = headings[0] if headings else name
            elif name is not None:
                (call,) = (statement.value for statement in ast.parse(cell.source).body)
                assert call.func.id == ("table" if name.startswith("Table") else "equation")
                shown = call.args[0].value
                assert (f"Table {shown}" if call.func.id == "table" else heading(shown)) == name
                found.append(name)
                name = None
    assert sorted(found) == sorted(heading(number) for number in NUMBERS)


@pytest.mark.parametrize("source", SOURCES, ids=lambda source: source.stem)
def test_a_notebook_only_calls_what_derive_has(source):
    """Imports of derive and calls by name: no arithmetic, no symbol, no number but that of an equation."""
    allowed = (
        ast.Module,
        ast.Expr,
        ast.ImportFrom,
        ast.alias,
        ast.Call,
        ast.Name,
        ast.Attribute,
        ast.Constant,
    )
    for cell in cells(source, "code"):
        tree = ast.parse(cell.source)
        for node in ast.walk(tree):
            assert isinstance(node, (*allowed, ast.expr_context)), ast.unparse(node)
            if isinstance(node, ast.ImportFrom):
                assert node.module.partition(".")[0] in ("derive", "proprotor")
            if isinstance(node, ast.Constant):
                assert node.value in NUMBERS or isinstance(node.value, str), ast.unparse(tree)


@pytest.mark.parametrize("source", SOURCES, ids=lambda source: source.stem)
def test_a_page_shows_print_beside_derivation_and_links_to_the_index(source):
    page = notebooks.page_of(source).read_text(encoding="utf-8")
    sections = re.split(r"^### ", page, flags=re.MULTILINE)[1:]
    assert sections
    for section in sections:
        name = section.partition("\n")[0]
        header = (
            "| relation | verdict |" if name.startswith("Table") else "|  | printed | derived | verdict |"
        )
        assert header in section, name
        assert f"](../equations.md#{name.lower().replace('. ', '-').replace(' ', '-')})" in section


@pytest.mark.parametrize("source", SOURCES, ids=lambda source: source.stem)
def test_mathematics_is_safe_from_markdown(source):
    """Forges read emphasis and escapes before formulas: no underscore after a mark or blank, no escaped mark."""
    page = notebooks.page_of(source).read_text(encoding="utf-8")
    formulas = re.findall(r"\$\$\n(.*?)\n\$\$|\$([^$\n]+)\$", page)
    assert formulas and all(line.count("$") % 2 == 0 for line in page.splitlines())
    for formula in (display or inline for display, inline in formulas):
        assert not re.search(r"[^\w]_|[*|]|\\[^A-Za-z]|^\s|\s$", formula), formula
        assert formula.count("{") == formula.count("}")
