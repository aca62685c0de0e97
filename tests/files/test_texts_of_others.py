"""Texts that come from files and other people: read in whatever way they were saved, shown as text and nothing else."""

import codecs
import json
import re
import unicodedata
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st

import proprotor as pp
from proprotor.commands.main import main
from proprotor.commands.terminal import PlainConsole
from proprotor.deck.stations import read_stations
from proprotor.errors import printable, unprintable
from proprotor.rotor.airfoil_table import AirfoilTable
from proprotor.rotor.motions import HUB, SECOND, motions, name_list, reactionless_coordinates
from proprotor.support.matrix_files import read_matrix_market
from proprotor.support.matrix_market import read_matrix
from proprotor.tables.points import read_points
from tests import extras
from tests.commands.test_command_contract import SUCCEED

DECK = 'base = "xv15-uncoupled"\n[case]\nname = "mine"\ntitle = "Mine"\n'
C81 = "MINE" + " " * 26 + " 1 2 1 2 1 2\n" + (" " * 7 + "   0.00\n" + "  -10.0  0.100\n   10.0  0.200\n") * 3
STATIONS = "r_over_R,twist [deg]\n0.1,30\n1,-5\n"
POINTS = "airspeed [ktas],damping [%]\n100,2\n200,1.5\n"
SPARSE = "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 2.0\n2 2 3.0\n"
FULL = "%%MatrixMarket matrix array real general\n2 2\n1\n0\n0\n4\n"

HOSTILE = "\x1b[2J\x1b[31mred\x1b[0m", "\x9b2J", "\x07", "\x08\x08", "\r", "a\u202eb", "\u2066", "\u2028"
READERS = {
    "deck": (DECK, lambda path: pp.load_case(path).title),
    "C81": (C81, lambda path: (AirfoilTable.from_c81(path).name, AirfoilTable.from_c81(path).coefficients)),
    "stations": (STATIONS, lambda path: read_stations(path, "twist", "rad")),
    "points": (
        POINTS,
        lambda path: [column.values.tolist() for column in read_points(path).columns.values()],
    ),
    "sparse matrix": (SPARSE, lambda path: read_matrix(path).toarray().tolist()),
    "full matrix": (FULL, lambda path: read_matrix(path).tolist()),
}


MARKS = {
    "utf-8": codecs.BOM_UTF8,  # Notepad
    "utf-16-le": codecs.BOM_UTF16_LE,  # PowerShell
    "utf-16-be": codecs.BOM_UTF16_BE,
    "utf-32-le": codecs.BOM_UTF32_LE,
    "utf-32-be": codecs.BOM_UTF32_BE,
}


@pytest.mark.parametrize("encoding", MARKS)
@pytest.mark.parametrize("kind", READERS)
@pytest.mark.parametrize("line_end", ["\n", "\r\n"])
def test_a_byte_order_mark_changes_nothing(tmp_path, kind, line_end, encoding):
    text, read = READERS[kind]
    plain, marked = tmp_path / "plain.toml", tmp_path / "marked.toml"
    text = text.replace("\n", line_end)
    plain.write_bytes(text.encode())
    marked.write_bytes(MARKS[encoding] + text.encode(encoding))
    assert str(read(marked)) == str(read(plain))


# What is opened without being a text of a user.
OPENED = {
    "files/text.py": "the one place",
    "files/output.py": "what is written",
    "files/source_code.py": "this package",
    "needs.py": "files of the system",
    "plots/animation.py": "the bytes of a film",
    "compiled/library.py": "sources of this package",
    "compiled/single_file.py": "sources of this package",
    "study/checkpoint.py": "what a study wrote",
    "study/study.py": "the folder of a study",
    "report/typeset.py": "the layout of reports",
    "commands/report.py": "bytes for a fingerprint",
    "support/matlab_file.py": "a binary file",
    "nastran/kinds_of_file.py": "the first bytes of a file",
    "nastran/op2.py": "a binary file",
    "nastran/op4.py": "a binary file",
    "commands/main.py": "the null device",
    "commands/explore.py": "a browser",
    "explore/post.py": "scripts of this package",
}


def test_texts_of_users_are_decoded_in_one_place():
    """A reader that opened a text itself would not know the byte order marks."""
    opens = re.compile(
        r"(?<![\w.])open\(|\.(open|read_text|read_bytes)\(|(loadtxt|genfromtxt|fromfile)\((?!io)"
    )
    root = Path(pp.__file__).parent
    found = {
        path.relative_to(root).as_posix()
        for path in root.rglob("*.py")
        for line in path.read_text(encoding="utf-8").splitlines()
        if opens.search(line) and not line.lstrip().startswith("#")
    }
    assert found == OPENED.keys()


def test_a_byte_order_mark_before_the_names_of_coordinates(tmp_path):
    names = [f"hub_{axis}" for axis in ("x", "y", "z", "alpha_x", "alpha_y", "alpha_z")]
    matrix = tmp_path / "m.mtx"
    matrix.write_text(
        "%%MatrixMarket matrix array real general\n6 6\n" + "\n".join(map(str, np.eye(6).ravel()))
    )
    dofs = tmp_path / "dofs.txt"
    dofs.write_bytes(codecs.BOM_UTF8 + "\n".join(names).encode())
    assert list(read_matrix_market(matrix, matrix, dofs=dofs).names) == names
    dofs.write_bytes(b"\xff\xff")  # no mark
    with pytest.raises(
        pp.InputError,
        match=r"^dofs = .*: must be text in UTF-8: line 1 is not; save the file in that encoding$",
    ):
        read_matrix_market(matrix, matrix, dofs=dofs)


@given(st.text())
@settings(max_examples=200)
def test_what_is_printable_says_nothing_to_a_terminal(text):
    shown = printable(text)
    assert not unprintable(shown) and len(shown) == len(text)
    assert not re.search("[\x00-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]", shown)
    assert shown.isprintable()
    other_spaces = any(unicodedata.category(c) == "Zs" and c != " " for c in text)  # which become plain ones
    assert bool(unprintable(text)) or other_spaces == (shown != text)
    assert shown != text or not unprintable(text)
    assert not unprintable(str(pp.InputError(text, text, text)))


@pytest.mark.parametrize("hostile", HOSTILE)
def test_text_that_steers_a_terminal_is_refused_wherever_a_deck_has_text(tmp_path, hostile):
    text = json.dumps(hostile)  # escapes as TOML has them
    number = f'{{ value = "1 deg", status = "assumed", source = {text} }}'
    for place, lines in {
        "case.title": f"title = {text}",
        "case.description": f"description = {text}",
        "case.calibration": f"calibration = {text}",
        "case.warnings[0]": f"warnings = [{text}]",
        "rotor.precone.source": f"[rotor]\nprecone = {number}",
        "rotor.airfoil.table": f"[rotor.airfoil]\ntable = {text}",
    }.items():
        path = tmp_path / "deck.toml"
        path.write_text(f'base = "xv15-uncoupled"\n[case]\nname = "mine"\n{lines}\n', encoding="utf-8")
        prose = place.rpartition(".")[2] in ("description", "calibration", "warnings[0]", "source")
        if prose and not hostile.strip():  # ends of lines in prose are spaces
            continue
        with pytest.raises(pp.InputError) as caught:
            pp.load_case(path)
        assert str(caught.value).startswith(f"{place} = ") and "must be printable text" in str(caught.value)
        assert not unprintable(str(caught.value))
    with pytest.raises(pp.InputError, match="must be printable text"):
        pp.load_case("xv15-uncoupled", {"case.title": hostile})


def test_prose_of_many_lines_is_one(tmp_path):
    path = tmp_path / "deck.toml"
    path.write_text(DECK + 'description = """\nFirst\tline\r\n   second\n"""\n', encoding="utf-8")
    assert pp.load_case(path).description == "First line second"


def test_what_a_terminal_shows_of_a_case_made_in_python_is_text(capsys):
    out = PlainConsole()
    out.print("[red]a[/red] \x1b[31mb\n\x9bc :smile:")
    from rich.text import Text

    out.print(Text("[b]\x1b[2Jd", "bold"))
    assert capsys.readouterr().out == "[red]a[/red]  [31mb\n c :smile:\n[b] [2Jd\n"


def test_names_and_titles_of_other_files_are_printable(tmp_path):
    path = tmp_path / "a.c81"
    path.write_bytes(C81.replace("MINE  ", "M\x9b2J\x1b ").encode("latin-1"))
    assert AirfoilTable.from_c81(path).name == "M 2J"
    for name in (*HOSTILE, "", " "):
        with pytest.raises(pp.InputError, match=r"^names = .*: must be printable text$"):
            pp.NormalModes.from_frequencies([name], [1.0], [1.0], [0.0], np.eye(6)[:, :1], False)


def support(*names):
    one = np.ones(len(names))
    return pp.NormalModes.from_frequencies(names, one, one, 0 * one, np.eye(6)[:, : len(names)], False)


@pytest.mark.parametrize("n_blades", range(3, 13))
def test_no_support_has_a_name_of_a_motion_of_any_rotor(n_blades):
    case = pp.load_case("xv15-uncoupled")
    own = case.linearize(100.0).rotor.dofs[len(HUB) :]
    dofs = (*own, *(coordinate.name for coordinate in reactionless_coordinates(n_blades)))
    for name in (*dofs, *name_list(dofs)):
        for taken in (name, name + SECOND):
            with pytest.raises(pp.InputError, match="must not be the name that a motion of a rotor has"):
                support(taken)


@given(st.lists(st.text("abc_01cs ", min_size=1, max_size=6), min_size=1, max_size=5))
@settings(max_examples=200)
def test_coordinates_that_are_accepted_have_modes_of_different_names(names):
    try:
        accepted = support(*names)
    except pp.InputError:
        return
    told = name_list(tuple(accepted.names))
    assert len({*told, *(name + SECOND for name in told)}) == 2 * len(told)
    assert sum(len(motion.names) for motion in motions(tuple(accepted.names))) == len(told)


@pytest.mark.parametrize("encoding", ["cp1252", "ascii"])
@pytest.mark.parametrize("command", SUCCEED)
def test_every_command_works_on_a_terminal_of_few_characters(command, encoding, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, text in (("decay.csv", extras.DECAY), ("points.csv", extras.POINTS)):
        (tmp_path / name).write_text(text)
    for arguments in SUCCEED[command]:
        result = CliRunner(charset=encoding).invoke(main, [command, *arguments], env={"COLUMNS": "200"})
        assert result.exit_code == 0, (arguments, result.output, result.exception)
        result.stdout_bytes.decode(encoding)


MARKUP = "[red]a[/] $5 $\\\\foo <script>alert(1)</script> &amp; {{7*7}} #pagebreak()"


@pytest.fixture(scope="module")
def hostile(tmp_path_factory):
    path = tmp_path_factory.mktemp("hostile") / "deck.toml"
    path.write_text(
        f'base = "xv15-uncoupled"\n[case]\nname = "mine"\ntitle = "{MARKUP}"\ncalibration = "{MARKUP}"\n'
        f'warnings = ["{MARKUP}"]\n[rotor]\n'
        f'precone = {{ value = "1.5 deg", status = "assumed", source = "{MARKUP}" }}\n',
        encoding="utf-8",
    )
    return path


def test_markup_in_a_deck_is_text_everywhere(hostile, tmp_path):
    shown = pp.load_case(hostile).title
    speeds = ("--speed", "200:300:50kt")
    result = CliRunner().invoke(main, ["sweep", str(hostile), *speeds], env={"COLUMNS": "300"})
    assert result.exit_code == 0 and shown in result.stdout
    figure = tmp_path / "a.svg"
    assert CliRunner().invoke(main, ["sweep", str(hostile), *speeds, "--plot", str(figure)]).exit_code == 0
    page = tmp_path / "a.html"
    result = CliRunner().invoke(main, ["report", str(hostile), "--out", str(page), *speeds])
    assert result.exit_code == 0, result.output
    text = page.read_text(encoding="utf-8")
    assert "<script" not in text and "{{7*7}}" in text and "&lt;script&gt;alert(1)" in text
    assert "&amp;amp;" in text


NO_TEXTS = {
    "a workbook or an archive": b"PK\x03\x04\x14\x00\x06\x00",
    "an old workbook or document": b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
    "a file of HDF5": b"\x89HDF\r\n\x1a\n",
    "a file of MATLAB": b"MATLAB 5.0 MAT-file, Platform: GLNXA64",
}


@pytest.mark.parametrize("what", NO_TEXTS)
@pytest.mark.parametrize("kind", ["deck", "C81", "stations", "points"])
def test_a_file_that_is_no_text_is_named_as_what_it_is(tmp_path, kind, what):
    path = tmp_path / {"deck": "case.toml", "C81": "airfoil.c81"}.get(kind, "table.csv")
    path.write_bytes(NO_TEXTS[what] + bytes(200))
    with pytest.raises(pp.InputError) as told:
        READERS[kind][1](path)
    assert f"must be text, and is {what}" in str(told.value) and "\n" not in str(told.value)
    assert path.name in str(told.value)
