"""C81 files as different programs and people write them: read with the numbers that they have, or refused in one line.

Every file is made here from the same numbers. What programs read and write is known from their sources: MBDyn cuts
lines into seven columns, DUST reads numbers separated by blanks and a title of one word.
"""

import codecs
from itertools import islice

import numpy as np
import pytest

import proprotor as pp
from proprotor.errors import InputError
from proprotor.rotor.c81 import read_c81
from tests.c81_files import as_c81, made_up_tables

ALPHA, MACH = [-180.0, -10.0, 0.0, 10.0, 180.0], [0.0, 0.4, 0.8]
LIFT = [[0.0] * 3, [-0.995, -1.085, -1.658], [0.0] * 3, [0.995, 1.085, 1.658], [0.0] * 3]
VALUES = {"lift": LIFT, "drag": [[0.01] * 3] * 5, "moment": [[-0.02] * 3] * 5}
COUNTS = " 3 5 3 5 3 5"


def in_columns(number: float) -> str:
    return f"{number:7.3f}" if abs(number) < 100 else f"{number:7.1f}"


def body(cell=in_columns, between="", blank=" " * 7, values=VALUES) -> list[str]:
    """The lines of three tables; `cell` writes a number, `blank` stands where Mach numbers have no angle."""
    lines = []
    for table in values.values():
        lines.append(between.join([blank, *map(cell, MACH)]))
        lines += [between.join(map(cell, [angle, *row])) for angle, row in zip(ALPHA, table, strict=True)]
    return lines


HEADER = f"{'SELF MADE':30}{COUNTS}"
PLAIN = [HEADER, *body()]
COMMAS, BLANKS, TABS = (body("{:g}".format, between, "") for between in (",", " ", "\t"))
EXPONENTS = body("{:.6E}".format, " ", "")
DUST = ["1 0 0", "0 1", "0.158"]


def dust(*reynolds: float, title="SELF_MADE" + " " * 21) -> list[str]:
    blocks = [line for re in reynolds for line in ("COMMENT#1", f"{re:9.0f} 0.200", title + COUNTS, *body())]
    return [f"{len(reynolds)} 0 0", "0 1", "0.158 " * len(reynolds), *blocks]


def fortran_d(number: float) -> str:
    """A number with a D exponent in seven columns, as a Fortran program writes it."""
    return f"{number:7.0e}".replace("e", "D") if abs(number) < 1 else f"{number:7.1f}"


DOUBLED = VALUES | {"lift": (2 * np.array(LIFT)).tolist()}
SECOND = [f"{'SECOND':30}{COUNTS}", *body(values=DOUBLED)]
READ = {
    "plain": PLAIN,
    "numbers, a comment and the Reynolds number before the table": dust(2e5),
    "a title of more than one word in DUST's form": dust(2e5, title=f"{'SELF MADE':30}"),
    "a comment of DUST that begins with #": [*DUST, "# made here", "200000 0.2", *PLAIN],
    "two airfoils": [*PLAIN, *SECOND],
    "two airfoils with END between them": [*PLAIN, "END", *SECOND, "END"],
    "blank lines and a comment between airfoils": [*PLAIN, "", "# the second", *SECOND, "", ""],
    "free format of MBDyn in columns": ["# FREE FORMAT", *PLAIN],
    "free format of MBDyn": ["# FREE FORMAT", HEADER, *BLANKS],
    "free format in small letters": ["# free format, by hand", HEADER, *body("{:g}".format, "  ", "")],
    "separated by blanks, without a word of it": [HEADER, *body("{:12.5f}".format, " ", "")],
    "commas": ["SELF MADE,3,5,3,5,3,5", *COMMAS],
    "commas and blanks": ["SELF MADE, 3, 5, 3, 5, 3, 5", *body("{:g}".format, ", ", "")],
    "a comma in place of the angle of the Mach numbers": [HEADER, *COMMAS],
    "tabs": ["SELF MADE\t3\t5\t3\t5\t3\t5", *TABS],
    "a comma at the end of each line": [HEADER, *(f"{line}," for line in COMMAS)],
    "one number on a line": ["# FREE FORMAT", HEADER, *"\n".join(BLANKS).split()],
    "comments": ["# made here", HEADER, "! lift", *body(), "# end"],
    "remarks at the ends of separated lines": [HEADER, *(f"{line} ! as said" for line in BLANKS)],
    "counts run together after a short title": ["SELF MADE 030503050305", *body()],
    "counts at the end of a long line": [f"{'SELF MADE':50}{COUNTS}", *body()],
    "counts with zeros": [f"{'SELF MADE':30}030503050305", *body()],
    "E exponents in separated numbers": [HEADER, *EXPONENTS],
    "D exponents in separated numbers": [HEADER, *(line.replace("E", "D") for line in EXPONENTS)],
    "d exponents": [HEADER, *(line.replace("E", "d") for line in EXPONENTS)],
    "negative zeros": [HEADER, *(line.replace("  0.000", " -0.000") for line in body())],
    "no blanks at the ends of lines": [line.rstrip() for line in PLAIN],
    "blanks at the ends of lines": [line.ljust(80) for line in PLAIN],
    "a number of the card at the end of each line": [f"{line:72}{i:08d}" for i, line in enumerate(PLAIN)],
}


@pytest.fixture
def read(tmp_path):
    def read(lines, *choice, end="\n"):
        path = tmp_path / "a.c81"
        path.write_bytes(lines if isinstance(lines, bytes) else end.join(lines).encode("latin-1"))
        return read_c81(path, *choice)

    return read


def has_the_numbers(found, values=VALUES) -> None:
    for name, table in values.items():
        alpha, mach, numbers = found.tables[name]
        np.testing.assert_allclose(np.rad2deg(alpha), ALPHA, rtol=1e-14, atol=1e-14)
        np.testing.assert_array_equal(mach, MACH)
        np.testing.assert_array_equal(numbers, table)
        assert not np.signbit([*mach, *alpha[alpha == 0], *numbers[numbers == 0]]).any()


@pytest.mark.parametrize("kind", READ)
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_a_dialect_is_read_with_its_numbers(read, kind, end):
    found = read(READ[kind], end=end)
    assert found.title.replace("_", " ") == "SELF MADE"
    has_the_numbers(found)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-be", "utf-32"])
def test_a_file_of_powershell_or_notepad(read, encoding):
    mark = codecs.BOM_UTF16_BE if encoding == "utf-16-be" else b""
    has_the_numbers(read(mark + "\r\n".join(PLAIN).encode(encoding)))


def test_d_exponents_that_fill_their_columns(read):
    tables = VALUES | {"lift": [[-0.9] * 3, [-0.01] * 3, [0.0] * 3, [0.5] * 3, [2.0] * 3]}
    has_the_numbers(read([HEADER, *body(fortran_d, values=tables)]), tables)


@pytest.mark.parametrize("count", [10, 12, 18, 25, 99])
@pytest.mark.parametrize("layout", ["wide", "separated", "commas"])
def test_rows_wider_than_nine_columns(read, count, layout):
    mach = np.linspace(0, 0.9, count).round(4)
    tables = {
        name: (alpha, mach, np.resize(values, (len(alpha), count)))
        for name, (alpha, _, values) in made_up_tables().items()
    }
    counts = "".join(f"{count:2d}{len(alpha):2d}" for alpha, _, _ in tables.values())
    cell, between, blank = {
        "wide": ("{:7.4f}".format, "", " " * 7),
        "separated": ("{:.4f}".format, " ", ""),
        "commas": ("{:g}".format, ",", ""),
    }[layout]
    angle = "{:7.2f}".format if layout == "wide" else "{:g}".format
    lines = [f"{'WIDE':30}{counts}"]
    for alpha, mach, values in tables.values():
        lines.append(between.join([blank, *map(cell, mach)]))
        lines += [between.join([angle(a), *map(cell, row)]) for a, row in zip(alpha, values, strict=True)]
    found = read(lines).tables
    for name, (alpha, mach, values) in tables.items():
        np.testing.assert_allclose(np.rad2deg(found[name][0]), alpha, atol=1e-12)
        np.testing.assert_array_equal(found[name][1], mach)
        np.testing.assert_array_equal(found[name][2], values)


def test_numbers_that_fill_their_columns_are_no_separated_numbers(read):
    """The columns alone separate ``-180.00-0.2800``; files of other programs have such rows."""
    tables = made_up_tables()
    found = read(as_c81("FULL", **tables).splitlines())
    np.testing.assert_array_equal(found.tables["lift"][2], tables["lift"][2])


def test_an_airfoil_is_chosen_by_its_title(read):
    lines = [*PLAIN, "END", *SECOND]
    has_the_numbers(read(lines, "self made"))
    assert read(lines, "SECOND").title == "SECOND"
    has_the_numbers(read(lines, "second"), DOUBLED)


def test_a_table_is_chosen_by_its_reynolds_number(read):
    lines = dust(2e5, 1e6)
    lines[-len(body()) :] = body(values=DOUBLED)
    has_the_numbers(read(lines, None, 200000))
    has_the_numbers(read(lines, None, 1e6), DOUBLED)


# Nine values that end in column 71: a digit is beyond the columns, and belongs to the number between blanks.
ZEROS = "      0" * 8
TWO_WAYS = [
    f"{'TWO WAYS':30} 9 2 9 2 9 2",
    *3
    * [
        " " * 7 + "".join(f"{0.1 * k:7.1f}" for k in range(9)),
        *(f"{angle:7.1f}{ZEROS}    0.12" for angle in (-10, 10)),
    ],
]
SEVERAL = "table_reynolds: must be given: the file, in the dialect of DUST, has tables at 200000, 1000000"
OF_DUST = "as files of DUST"
REFUSED = {
    "several Reynolds numbers": (dust(2e5, 1e6), (), SEVERAL),
    "an unknown Reynolds number": (
        dust(2e5, 1e6), (None, 5e5), "table_reynolds = 500000.0: must be one of the file's: 200000, 1000000",
    ),
    "a Reynolds number of a file without": (
        PLAIN, (None, 5e5), "table_reynolds = 500000.0: must not be given: the file has no Reynolds numbers",
    ),
    "an unknown title": (
        [*PLAIN, *SECOND], ("THIRD",), "table_name = THIRD: unknown table of the file 'THIRD'; known: SELF MADE",
    ),
    "fewer tables than announced": (
        ["2 0 0", *dust(2e5)[1:]], (), "line 24: ends the file with 1 tables, and its first line announces 2",
    ),
    "a preamble that ends early": ([*DUST[:2], *PLAIN], (), f"line 3: must have numbers, {OF_DUST}"),
    "no Reynolds number": ([*DUST, "COMMENT", "none", *PLAIN], (), "line 5: must have a Reynolds number above zero"),
    "a Reynolds number of zero": ([*DUST, "C", "0 0", *PLAIN], (), "line 5: must have a Reynolds number above zero"),
    "no table": (DUST, (), "line 4: is missing; it must have a comment"),
    "half a table announced": (["0.5 0 0"], (), f"line 1: must begin with the number of tables, {OF_DUST} do"),
    "an exponent without a letter": (
        [HEADER, *(line.replace("  0.010", "1.00-02") for line in body())], (),
        "line 9: must have a number in columns 8 to 14, not '1.00-02'",
    ),
    "a decimal comma": (
        [HEADER, *(line.replace(".", ",") for line in body())], (),
        "line 2: must have a number in columns 8 to 14, not '0,000'",
    ),
    "an empty cell": (
        [HEADER, COMMAS[0], "-180,0,,0", *COMMAS[2:]], (),
        "line 3: must have numbers of row 1 of 5 of the lift table, not ''",
    ),
    "a number too many in a separated row": (
        [HEADER, *BLANKS[:2], "-10 1 1 1 1", *BLANKS[3:]], (),
        "line 4: must have no more than an angle and the 3 values that line 1 announces, for row 2 of 5 of the lift",
    ),
    "a second airfoil with a row too few": (
        [*PLAIN, *SECOND[:-1]], (), "line 38: is missing; it must have row 5 of 5 of the moment table",
    ),
    "a second airfoil without counts": (
        [*PLAIN, "END", "SECOND"], (), "line 21: must not be there: the counts of line 1 end the moment table",
    ),
    "numbers that both layouts have, but different ones": (
        TWO_WAYS, (), "line 2: reads as other numbers in columns than separated by blanks; without columns begin with",
    ),
}  # fmt: skip


@pytest.mark.parametrize("kind", REFUSED)
def test_a_file_that_is_not_one_table_is_refused_in_one_line(read, kind):
    lines, choice, message = REFUSED[kind]
    with pytest.raises(InputError) as caught:
        read(lines, *choice)
    told = str(caught.value)
    assert message in told and "\n" not in told, told


# Writing ------------------------------------------------------------------------------------------


def airfoil(name="MADE UP", n_mach=11) -> pp.AirfoilTable:
    tables = made_up_tables(n_mach)
    return pp.AirfoilTable(name=name, **{key: (np.deg2rad(a), m, v) for key, (a, m, v) in tables.items()})


def as_mbdyn_reads(text: str) -> list[np.ndarray]:
    """The numbers of lift, drag and moment: lines cut into seven columns, nine values a line."""
    lines = iter(text.splitlines())
    header = next(lines)
    counts = [int(header[k : k + 2]) for k in range(30, 42, 2)]
    found = []
    for columns, rows in zip(counts[::2], counts[1::2], strict=True):
        table = []
        for row in range(rows + 1):
            values = [] if row else [np.nan]
            for start in range(0, columns, 9):
                line = next(lines)
                fields = [line[k : k + 7] for k in range(0, len(line), 7)]
                values += [float(field) for field in fields[1 if start or not row else 0 :]]
            table.append(values)
        found.append(np.array(table))
    return found


def as_dust_reads(text: str) -> tuple[float, list[np.ndarray]]:
    """The same from numbers between blanks, which go on over lines, after lines of numbers and a title of one word."""
    lines = text.splitlines()
    assert int(lines[0].split()[0]) == 1
    reynolds, header = float(lines[4].split()[0]), lines[5]
    after = f"{header[header.index(' ') :].lstrip():12}"
    counts = [int(after[k : k + 2]) for k in range(0, 12, 2)]
    words = iter(" ".join(lines[6:]).split())
    found = []
    for columns, rows in zip(counts[::2], counts[1::2], strict=True):
        mach = list(islice(words, columns))
        found.append(
            np.array([["nan", *mach], *(list(islice(words, columns + 1)) for _ in range(rows))], dtype=float)
        )
    assert not list(words)
    return reynolds, found


def numbers_of(table: pp.AirfoilTable) -> list[np.ndarray]:
    return [
        np.vstack([[np.nan, *mach], np.column_stack([np.rad2deg(alpha), values])])
        for alpha, mach, values in table.tables.values()
    ]


@pytest.mark.parametrize("n_mach", [1, 9, 10, 99])
def test_a_written_file_is_what_other_programs_and_this_one_read(tmp_path, n_mach):
    given, path = airfoil(n_mach=n_mach), tmp_path / "a.c81"
    pp.write_c81(given, path)
    plain = as_mbdyn_reads(path.read_text(encoding="ascii"))
    back = pp.AirfoilTable.from_c81(path)
    assert back.name == "MADE UP"
    pp.write_c81(given, path, reynolds=2e6)
    reynolds, of_dust = as_dust_reads(path.read_text(encoding="ascii"))
    assert reynolds == 2e6
    chosen = pp.AirfoilTable.from_c81(path, table_reynolds=2e6)
    all_found = zip(numbers_of(given), plain, of_dust, numbers_of(back), numbers_of(chosen), strict=True)
    for expected, *found in all_found:
        rounded = np.where(np.abs(expected) < 1, 5e-5, 5e-4) + 1e-12  # the digits of six columns
        for numbers in found:
            off = np.abs(numbers - expected)
            assert np.isnan(off).sum() == 1 and np.nanmax(off - rounded) < 0


def test_a_written_file_is_written_again_without_a_change(tmp_path):
    one, two = tmp_path / "one.c81", tmp_path / "two.c81"
    pp.write_c81(airfoil(), one)
    pp.write_c81(pp.AirfoilTable.from_c81(one), two)
    assert one.read_bytes() == two.read_bytes()


@pytest.mark.parametrize(
    ("numbers", "rule"),
    [
        ({"alpha": np.deg2rad(np.linspace(-180, 180, 100))}, "must have at most 99 angles and Mach numbers"),
        ({"mach": [0.1, 0.1000001]}, "line 2: Mach numbers must increase from column to column"),
        ({"alpha": np.deg2rad([-100.01, -100.0])}, "angles of attack must increase from row to row"),
    ],
)
def test_what_does_not_fit_is_not_written(tmp_path, numbers, rule):
    numbers = {"alpha": [-0.1, 0.1], "mach": [0.1, 0.2]} | numbers
    values = np.zeros((len(numbers["alpha"]), len(numbers["mach"])))
    path = tmp_path / "a.c81"
    with pytest.raises(InputError, match=rule) as caught:
        pp.write_c81(pp.AirfoilTable(**numbers, lift=values, drag=values, moment=values, name="x"), path)
    assert "\n" not in str(caught.value) and not path.exists()


def test_titles_of_any_characters(tmp_path):
    path = tmp_path / "a.c81"
    for name, title in {"": "airfoil", "Flügel\n12": "Flgel 12", "x" * 40: "x" * 30}.items():
        pp.write_c81(airfoil(name), path)
        assert pp.AirfoilTable.from_c81(path).name == title
        pp.write_c81(airfoil(name), path, reynolds=1e6)
        assert as_dust_reads(path.read_text(encoding="ascii"))[0] == 1e6


# Decks --------------------------------------------------------------------------------------------


def deck(folder, text: str):
    path = folder / "deck.toml"
    head = 'base = "xv15-uncoupled"\n[case]\nname = "c"\ntitle = "c"\n[rotor.airfoil]\n'
    path.write_text(head + text, encoding="utf-8")
    return pp.load_case(path)


def test_a_deck_names_the_table_of_a_file(tmp_path):
    (tmp_path / "two.c81").write_text("\n".join([*PLAIN, *SECOND]), encoding="ascii")
    (tmp_path / "dust.c81").write_text("\n".join(dust(2e5, 1e6)), encoding="ascii")
    assert deck(tmp_path, 'table = "two.c81"').rotor.airfoil.name == "SELF MADE"
    assert deck(tmp_path, 'table = "two.c81"\ntable_name = "second"').rotor.airfoil.name == "SECOND"
    assert deck(tmp_path, 'table = "dust.c81"\ntable_reynolds = 1000000').rotor.airfoil.name == "SELF_MADE"
    for text, message in {
        'table = "two.c81"\ntable_name = "third"': "rotor.airfoil.table_name = third: unknown table",
        'table = "dust.c81"': "rotor.airfoil.table_reynolds: must be given: the file, in the dialect of DUST",
        'table = "dust.c81"\ntable_reynolds = 7': "rotor.airfoil.table_reynolds = 7: must be one of the file's",
        'table_name = "second"': "rotor.airfoil.table_name: must be given with table",
    }.items():
        with pytest.raises(InputError) as caught:
            deck(tmp_path, text)
        assert str(caught.value).startswith(message) and "\n" not in str(caught.value), str(caught.value)
