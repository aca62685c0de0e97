"""Blade stations from CSV files: numbers as written, and one clear message for each malformed file."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import proprotor as pp
from proprotor.deck.file import read_tables
from proprotor.deck.stations import read_stations

FOOT, SLUG, DEGREE = 0.3048, 14.59390294, np.pi / 180
STATIONS = """# a blade
r [ft], twist [deg], chord [inch], mass_per_length [slug/ft]

1.25, 30.0, 17.0, 0.32
6.25, 7.03, 14.5, 0.20
12.5, -5.82, 14.0, 0.15
"""


@pytest.fixture
def file(tmp_path):
    def write(text, name="stations.csv"):
        path = tmp_path / name
        path.write_bytes(text.encode() if isinstance(text, str) else text)
        return path

    return write


def test_a_column_in_si(file):
    found = read_stations(file(STATIONS), "twist", "rad", radius=12.5 * FOOT)
    np.testing.assert_allclose(found.r_over_R, [0.1, 0.5, 1.0], rtol=1e-14)
    np.testing.assert_allclose(found.values, np.array([30.0, 7.03, -5.82]) * DEGREE, rtol=1e-14)
    mass = read_stations(file(STATIONS), "mass_per_length", "kg/m", radius=12.5 * FOOT).values
    np.testing.assert_allclose(mass, np.array([0.32, 0.20, 0.15]) * SLUG / FOOT, rtol=1e-8)


@pytest.mark.parametrize(
    "text",
    [
        "r_over_R,chord [m]\n0.1,0.4\n1,0.3\n",
        "r_over_R;chord [m]\r\n0.1;0.4\r\n1;0.3\r\n",
        "\ufeffr_over_R\tchord [m]\r0.1\t0.4\r1.0\t.3\r",
        'r_over_R,name,chord [m]\n1e-1,"root, inboard",0.4\n1,tip,3e-1\n',
        "chord [cm],r_over_R,,\n40,0.1,,\n30,1,,\n,,,\n",
        "r [%],chord [m]".replace("r [%]", "r_over_R [%]") + "\n10,0.4\n100,0.3",
        "r_over_R [-],chord [m]\n0.1,0.4\n1,0.3\n",
        "sep=;\r\nr_over_R (–);chord [m]\r\n0,1;0,4\r\n1;0,3\r\n",
        "\ufeffSEP=,\nr_over_R,chord [m]\n0.1,0.4\n1,0.3\n",
    ],
)
def test_what_spreadsheets_write(file, text):
    found = read_stations(file(text), "chord", "m")
    np.testing.assert_allclose(found.r_over_R, [0.1, 1.0])
    np.testing.assert_allclose(found.values, [0.4, 0.3])


def test_a_tip_in_another_unit_is_the_tip(file):
    found = read_stations(file("r [inch],chord [m]\n15,1\n150,1"), "chord", "m", radius=12.5 * FOOT)
    assert found.r_over_R[-1] == pytest.approx(1.0, abs=1e-14)
    assert found.r_over_R[-1] <= 1


HEAD = "r_over_R,twist [deg]\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty"),
        ("# only a remark\n\n", "is empty"),
        (HEAD, "must have two stations or more"),
        (HEAD + "0.1,3\n", "must have two stations or more"),
        (HEAD + "0.1,3\n1,abc\n", 'line 3, column 2 (twist [deg]): "abc" is no number'),
        (HEAD + "0.1,3\n1,=1+2\n", 'line 3, column 2 (twist [deg]): "=1+2" is no number'),
        (HEAD + "0.1,3\n1,__import__('os')\n", "is no number"),
        (HEAD + "0.1,3\n1,nan\n", 'line 3, column 2 (twist [deg]): "nan" is no number'),
        (HEAD + "0.1,3\n1,1e999\n", "line 3, column 2 (twist [deg]): must be finite"),
        (HEAD + "0.1,3\n1,٣\n", "is no number"),
        (HEAD + "0.1,3\n1,\n", "line 3, column 2 (twist [deg]): has no such cell"),
        ("twist [deg],r_over_R\n3,0.1\n,1\n", "line 3, column 1 (twist [deg]): is empty"),
        (HEAD + "0.1,3\n1,4,5\n", "line 3: has 3 cells for 2 columns"),
        (HEAD + "0,1,3,5\n1,4\n", "line 2: has 4 cells for 2 columns"),
        (HEAD + "0.1,3\n0.1,4\n", "line 3, column 1 (r_over_R): is the station of the line before; set"),
        (HEAD + "0.2,3\n0.1,4\n", "line 3, column 1 (r_over_R): must increase from line to line"),
        (
            "Blade 301\n" + HEAD + "0.1,3\n1,4\n",
            "line 1: must name the columns; a title is a line that begins",
        ),
        ("\nBlade 301;;;\nr_over_R;twist [deg]\n0,1;3\n1;4\n", "line 2: must name the columns; a title"),
        ("sep=;\n", "is empty"),
        (HEAD + "0.5,3\n0.1,4\n", "line 3, column 1 (r_over_R): must increase"),
        (HEAD + "0.5,3\n1.1,4\n", "line 3, column 1 (r_over_R): is 1.1 R; must lie between 0"),
        (HEAD + "-0.5,3\n1,4\n", "line 2, column 1 (r_over_R): is -0.5 R"),
        (HEAD + '0.1,"3\n1,4\n', "line 2: has a quotation mark that is not closed"),
        (
            "r_over_R,twist\n0.1,3\n1,4\n",
            'column 2 (twist): needs a unit; it is an angle, such as "2.5 deg"; write "twist [unit]"',
        ),
        ("r_over_R,twist [m]\n0.1,3\n1,4\n", "column 2 (twist [m]): must be an angle"),
        ("r_over_R,twist [degr]\n0.1,3\n1,4\n", "column 2 (twist [degr]): has an unknown unit"),
        ("r_over_R,twist [deg\n0.1,3\n1,4\n", "line 1, column 2: must be a name and a unit"),
        ("r_over_R,twist [deg],\t,x\n0.1,3,1,1\n1,4,1,1\n", "line 1, column 3: must be a name and a unit"),
        ("x,twist [deg]\n0.1,3\n1,4\n", 'has no column of stations; give "r_over_R", or "r" with a unit'),
        ("r,twist [deg]\n0.1,3\n1,4\n", "column 1 (r): needs a unit; it is a length"),
        ("r_over_R,r [m],twist [deg]\n0.1,1,3\n1,2,4\n", "has two columns of stations"),
        ("r_over_R,twist [deg],twist [deg]\n0.1,3,3\n1,4,4\n", 'line 1, column 3: "twist" is named twice'),
        ("r_over_R,twits [deg]\n0.1,3\n1,4\n", "did you mean twits?"),
        (b"r_over_R,twist [deg]\n0.1,\xff\n1,4\n", "must be text in UTF-8"),
        (
            b"PK\x03\x04" + b"\x14" * 2_000_000,
            "must be text, and is a workbook or an archive; save a sheet as CSV",
        ),
        (
            b"\xd0\xcf\x11\xe0\xa1\xb1",
            "must be text, and is an old workbook or document; save a sheet as CSV",
        ),
        (b"\x00" * 2_000_000, "must not be larger than 1000000 bytes"),
        (HEAD + "".join(f"{k / 20000},1\n" for k in range(20000)), "must have at most 10000 stations"),
    ],
)
def test_malformed_files(file, text, message):
    with pytest.raises(pp.InputError) as error:
        read_stations(file(text), "twist", "rad", radius=3.81)
    assert message in str(error.value)
    assert str(error.value).startswith("file = stations.csv: ")
    assert len(str(error.value).splitlines()) == 1


def test_stations_by_r_need_a_radius(file):
    with pytest.raises(pp.InputError, match="needs the radius; give r_over_R"):
        read_stations(file(STATIONS), "twist", "rad")


@given(
    st.binary(max_size=200)
    | st.text(alphabet='r_ovR,;"\t[deg]0123456789.e-+# \n\r=', max_size=120).map(str.encode)
)
@settings(max_examples=300, deadline=None)
def test_any_content_is_read_or_told(tmp_path_factory, content):
    path = tmp_path_factory.getbasetemp() / "any.csv"
    path.write_bytes(content)
    try:
        found = read_stations(path, "e", "rad", radius=1.0)
    except pp.InputError as error:
        assert len(str(error).splitlines()) == 1
    else:
        assert np.isfinite([found.r_over_R, found.values]).all()


def deck(file, rotor):
    return file(f'base = "xv15-uncoupled"\n[case]\nname = "csv"\n[rotor]\n{rotor}\n', "csv.toml")


def test_a_deck_with_its_stations_in_a_file(file, monkeypatch):
    file(STATIONS)
    path = deck(
        file,
        'twist = { file = "stations.csv", column = "twist", beyond = "held", status = "published", '
        'source = "a drawing" }\n'
        'chord = { file = "stations.csv", column = "chord", beyond = "held" }\n'
        'mass_distribution = { file = "stations.csv", column = "mass_per_length", beyond = "nothing" }',
    )
    monkeypatch.chdir("/")  # the name starts from the deck's folder
    case, radius = pp.load_case(path), 12.5 * FOOT
    r = np.array([0.1, 0.5, 1.0]) * radius
    np.testing.assert_allclose(case.rotor.chord[0], r)
    np.testing.assert_allclose(case.rotor.chord[1], np.array([17.0, 14.5, 14.0]) * 0.0254)
    np.testing.assert_allclose(case.rotor.twist[1], np.array([30.0, 7.03, -5.82]) * DEGREE)
    mass = np.array([0.32, 0.20, 0.15]) * SLUG / FOOT
    assert case.rotor.blade_mass == pytest.approx(np.trapezoid(mass, r), rel=1e-8)
    assert case.sources["rotor.twist"].status == "published"
    assert case.sources["rotor.twist"].written == "3 values of twist in stations.csv, held beyond"
    assert case.sources["rotor.chord"].status == "unstated"


def test_the_same_blade_written_in_the_deck_and_in_a_file(file):
    """The twist of the XV-15 as a file of its own numbers."""
    twist = read_tables("xv15-uncoupled")["rotor"]["twist"]
    rows = "\n".join(f"{r},{value}" for r, value in zip(twist["r_over_R"], twist["value"], strict=True))
    file(f"r_over_R,twist [deg]\n{rows}\n")
    case = pp.load_case(deck(file, 'twist = { file = "stations.csv", column = "twist" }'))
    own = pp.load_case("xv15-uncoupled")
    np.testing.assert_array_equal(case.linearize(150.0).K, own.linearize(150.0).K)


def test_a_deck_replaces_a_file_whole(file):
    """Neither the column nor the source of the base's file stays."""
    file(STATIONS)
    file("r_over_R,twist [deg]\n0,20\n1,-20\n", "other.csv")
    deck(file, 'twist = { file = "stations.csv", column = "twist", source = "a drawing" }')
    above = '[case]\nname = "above"\n[rotor]\n'
    other = file(
        f'base = "csv.toml"\n{above}twist = {{ file = "other.csv", column = "twist" }}', "above.toml"
    )
    assert pp.load_case(other).sources["rotor.twist"].source == ""
    number = file(f'base = "csv.toml"\n{above}twist = "-30 deg"', "number.toml")
    assert pp.load_case(number).rotor.twist == pytest.approx(-30 * DEGREE)


@pytest.mark.parametrize(
    ("rotor", "message"),
    [
        ('twist = { file = "nowhere.csv", column = "twist" }', "nowhere.csv: no such file"),
        ('twist = { file = "stations.csv" }', "rotor.twist.column: is missing"),
        ('twist = { column = "twist" }', "rotor.twist.file: is missing"),
        ('twist = { file = 3, column = "twist" }', "rotor.twist.file = 3: must be the name of a file"),
        (
            'twist = { file = "stations.csv", column = 2 }',
            "rotor.twist.column = 2: must be the name of a column",
        ),
        (
            'twist = { file = "stations.csv", column = "twits" }',
            "unknown column 'twits'; did you mean twist?",
        ),
        ('twist = { file = "stations.csv", column = "twist", unit = "deg" }', "unknown field 'unit'"),
        ('twist = { file = "stations.csv", column = "chord" }', "column 3 (chord [inch]): must be an angle"),
        ('chord = { file = "bad.csv", column = "chord" }', "line 3, column 2 (chord [m]): must be positive"),
        (
            'radius = "10 ft"\ntwist = { file = "stations.csv", column = "twist" }',
            "is 1.25 R; must lie between",
        ),
        (
            'radius = "0 ft"\ntwist = { file = "stations.csv", column = "twist" }',
            "rotor.radius = 0 ft: must be positive",
        ),
    ],
)
def test_malformed_decks(file, rotor, message):
    file(STATIONS)
    file("r_over_R,chord [m]\n0,0.4\n1,-0.3\n", "bad.csv")
    with pytest.raises(pp.InputError) as error:
        pp.load_case(deck(file, rotor))
    assert message in str(error.value)
    assert len(str(error.value).splitlines()) == 1
