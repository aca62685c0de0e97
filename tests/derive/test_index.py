"""The index of the equations is current, every link of it leads where it says, and nothing generated is left out."""

import inspect
import re
import subprocess
import sys

import proprotor_equations
import pytest

from derive.audit import printed
from derive.audit.counterparts import COUNTERPARTS
from derive.pages import index

LINK = re.compile(r"\[([^\]]+)\]\(([^)#]*)(?:#([^)]*))?\)")
PAGE = index.PAGE.read_text(encoding="utf-8")
SECTIONS = dict(section.split("\n", 1) for section in re.split(r"^## ", PAGE, flags=re.MULTILINE)[1:])


def headings(path):
    """Anchors of a Markdown page, by the rule of the forge: lower case, no punctuation, hyphens for blanks."""
    titles = re.findall(r"^#+ (.*)$", path.read_text(encoding="utf-8"), re.MULTILINE)
    kept = ("".join(c for c in title.lower() if c.isalnum() or c in " -_") for title in titles)
    return {title.replace(" ", "-") for title in kept}


def links(kind, section):
    (line,) = [line for line in SECTIONS[section].splitlines() if line.startswith(f"- {kind}:")] or [""]
    return {name for name, *_ in LINK.findall(line)}


def test_the_page_is_current():
    assert index.page() == PAGE, "`python -m derive.pages.index` writes docs/equations.md anew"


def test_every_equation_and_table_is_in_the_index_with_all_four_places():
    names = [f"Eq. {number}" for number in range(1, 38)]
    assert list(SECTIONS) == [
        *names,
        *(f"Nomenclature {n}" for n in printed.NOMENCLATURE),
        "Table 1",
        "Table 2",
    ]
    for name, text in SECTIONS.items():
        for kind in ("print", "derivation", "generated", "notebook"):
            assert f"\n- {kind}" in text, (name, kind)


def test_every_link_leads_to_the_line_that_defines_what_it_names():
    for name, target, place in LINK.findall(PAGE):
        path = (index.PAGE.parent / target).resolve() if target else index.PAGE
        assert path.exists(), target
        if path.suffix == ".md":
            assert not place or place in headings(path), (target, place)
            continue
        line = path.read_text(encoding="utf-8").splitlines()[int(place.removeprefix("L")) - 1]
        if target.startswith("../derive/audit/printed/"):
            assert re.match(r"\s*Printed(Equation|Table)\($|\s*PrintedEquation\(\d", line), (
                target,
                place,
                line,
            )
        else:
            defined = re.escape(name.rpartition(".")[2])
            assert re.match(rf"(def|class) {defined}\b|{defined}(, \w+)* = ", line), (name, line)


@pytest.mark.parametrize("number", [*printed.EQUATIONS, *printed.NOMENCLATURE])
def test_print_and_counterpart_are_those_of_the_number(number):
    """By what Python imports, where the index reads the sources."""
    function = getattr(COUNTERPARTS[number], "func", COUNTERPARTS[number])
    place = index.counterparts()[number]
    assert place.name == f"counterparts.{function.__name__}"
    lines, first = inspect.getsourcelines(function)
    assert first <= place.line < first + len(lines)
    after = (
        index.prints()[number]
        .path.read_text(encoding="utf-8")
        .splitlines()[index.prints()[number].line - 1 :]
    )
    assert re.match(rf'\s*PrintedEquation\(\s*"?{number}"?,', "\n".join(after[:2]))


def test_every_generated_function_stands_at_the_equations_its_docstring_names():
    """Docstrings as the package has them, read by another rule than the index's."""
    checked = 0
    for module_name in ("", *proprotor_equations.__all__):
        for prefix in ("", "published."):
            module = _module(prefix + module_name)
            for name, function in inspect.getmembers(module, inspect.isfunction):
                if name.startswith("_") or function.__module__ != module.__name__:
                    continue
                for number in _numbers(inspect.getdoc(function).partition("Parameters\n")[0]):
                    kind = "generated, published set" if prefix else "generated"
                    assert f"{prefix}{module_name}.{name}" in links(kind, f"Eq. {number}"), (name, number)
                    checked += 1
    assert checked > 200


def _module(name):
    module = proprotor_equations
    for part in filter(None, name.split(".")):
        module = getattr(module, part, None)
    return module


def _numbers(text):
    """Numbers from each `Eq` to the next word that is none, ranges filled."""
    words = re.sub(r"[,;.]", " ", text).split()
    found, listing = set(), False
    for word in words:
        if word in ("Eq", "Eqs"):
            listing = True
        elif listing and re.fullmatch(r"\d+(-\d+)?", word):
            first, _, last = word.partition("-")
            found |= set(range(int(first), int(last or first) + 1))
        elif word != "and":
            listing = False
    return found


def test_an_equation_named_in_lists_and_ranges_is_found():
    assert index.equations_named("Eqs. 2, 3, 14-16 and 32; rotor torque, Eq. 17; u_T, 99") == {
        2,
        3,
        14,
        15,
        16,
        17,
        32,
    }
    assert index.equations_named("strip theory, NASA TN D-7677") == set()


def test_a_stale_page_is_told(tmp_path, monkeypatch, capsys):
    stale = tmp_path / "equations.md"
    stale.write_text(PAGE.replace("Eq. 13", "Eq. 14", 1), encoding="utf-8")
    monkeypatch.setattr(index, "ROOT", tmp_path)
    monkeypatch.setattr(index, "PAGE", stale)
    monkeypatch.setattr(index, "page", lambda: PAGE)
    monkeypatch.setattr(sys, "argv", ["index", "--check"])
    assert index.main() == 1
    assert "python -m derive.pages.index" in capsys.readouterr().out
    monkeypatch.setattr(sys, "argv", ["index"])
    assert index.main() == 0 and stale.read_text(encoding="utf-8") == PAGE


def test_the_check_runs_as_a_command():
    command = [sys.executable, "-m", "derive.pages.index", "--check"]
    assert subprocess.run(command, cwd=index.ROOT, capture_output=True, check=False).returncode == 0
