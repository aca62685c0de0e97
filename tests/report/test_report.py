"""The report: the numbers of the functions behind it, everything on one page, whole or not at all."""

import base64
import html.parser
import io
import json
import re
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
from click.testing import CliRunner
from pypdf import PdfReader

import proprotor as pp
from proprotor.commands.main import main

KT = 1852 / 3600
SPEEDS = "340:400:20kt"  # holds the boundary of the chord mode
DAY = {"SOURCE_DATE_EPOCH": "1760000000"}  # 9 October 2025
HOSTILE = '<script>alert("1")</script> & #emph[x] $y$'


def run(*arguments, **env):
    result = CliRunner().invoke(main, ["report", *map(str, arguments)], env={"COLUMNS": "120", **DAY, **env})
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result


class Page(html.parser.HTMLParser):
    """Tables by caption, pictures, and all text of a page."""

    def __init__(self, text):
        super().__init__()
        self.tables, self.pictures, self.tags, self.text, self.scopes = {}, [], [], "", []
        self._rows, self._cell, self._caption = [], None, None
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        given = dict(attributes)
        if tag == "table":
            self._rows = []
        elif tag == "tr":
            self._rows.append([])
        elif tag in ("td", "th"):
            self._cell = ""
            if tag == "th":
                self.scopes.append(given.get("scope"))
        elif tag == "caption":
            self._caption = ""
        elif tag == "img":
            self.pictures.append(given)

    def handle_endtag(self, tag):
        if tag in ("td", "th"):
            self._rows[-1].append(self._cell)
            self._cell = None
        elif tag == "caption":
            self._name, self._caption = self._caption, None
        elif tag == "table":
            self.tables[self._name] = self._rows

    def handle_data(self, data):
        self.text += data
        if self._cell is not None:
            self._cell += data
        if self._caption is not None:
            self._caption += data


def table(page, beginning):
    (rows,) = (rows for name, rows in page.tables.items() if name.startswith(beginning))
    return rows


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    place = tmp_path_factory.mktemp("report") / "xv15.html"
    result = run("xv15-uncoupled", "--speed", SPEEDS, "--out", place, "--pdf", "--json")
    assert result.exit_code == 0, result.stderr
    return place, json.loads(result.stdout)


@pytest.fixture(scope="module")
def page(written):
    return Page(written[0].read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


def test_the_boundaries_are_those_of_flutter_point(page, written, case):
    point = case.flutter_point(SPEEDS)
    rows = table(page, "Boundaries")
    assert [row[4] for row in rows[1:]] == [boundary.mode for boundary in point.boundaries]
    assert [float(row[0]) for row in rows[1:]] == pytest.approx(
        [boundary.position / KT for boundary in point.boundaries], abs=0.006
    )
    hertz = point.frequency / (2 * np.pi)
    assert f"Flutter speed {point.speed / KT:.2f} KTAS: chord, flutter, at {hertz:.3f} Hz" in page.text
    assert written[1]["flutter speed (m/s)"] == pytest.approx(point.speed, rel=1e-9)


def test_points_of_a_file_stand_on_the_plots_that_have_their_columns(tmp_path):
    points = tmp_path / "points.csv"
    points.write_text("airspeed [ktas], damping [%], label\n250, 3, wind tunnel of Elsewhere\n")
    out = tmp_path / "report.html"
    more = ("--speed", "250:300:50kt", "--points", str(points), "--out", str(out))
    result = CliRunner().invoke(main, ["report", "xv15-uncoupled", *more])
    assert result.exit_code == 0, result.output
    plain = tmp_path / "plain.html"
    CliRunner().invoke(main, ["report", "xv15-uncoupled", *more[:2], "--out", str(plain)])
    assert len(out.read_bytes()) > len(plain.read_bytes())


def test_the_tables_of_modes_are_those_of_sweep(page, case):
    modes = case.sweep(SPEEDS)
    damping, frequency = table(page, "Damping"), table(page, "Frequency")
    assert damping[0] == ["mode", "340 KTAS", "360 KTAS", "380 KTAS", "400 KTAS"]
    names = [row[0] for row in damping[1:]]
    assert names == [row[0] for row in frequency[1:]] == modes.mode.values.tolist()
    chord = dict(zip(names, damping[1:], strict=True))["chord"]
    exact = 100 * modes.damping_ratio.sel(mode="chord").values
    assert [float(cell.rstrip("*")) for cell in chord[1:]] == pytest.approx(exact, abs=0.006)
    assert [cell.endswith("*") for cell in chord[1:]] == (exact < 0).tolist()
    turns = abs(modes.eigenvalue.sel(mode="beam").values.imag) / float(case.operation.rotor_speed)
    beam = dict(zip(names, frequency[1:], strict=True))["beam"]
    assert [float(cell) for cell in beam[1:]] == pytest.approx(turns, abs=6e-4)


def test_the_table_of_sensitivities_is_that_of_sensitivity(page, case):
    rates = case.sensitivity("flutter_speed", airspeed=SPEEDS)
    rows = {row[0]: row for row in table(page, "Exact derivatives")[1:]}
    assert set(rows) == set(rates.input.values)
    precone = float(rates.derivative.sel(input="rotor.precone")) / KT * np.pi / 180  # kt per degree
    assert float(rows["rotor.precone"][2]) == pytest.approx(precone, rel=1e-3)
    assert rows["rotor.precone"][1] == "2.5 deg" and rows["rotor.precone"][5] == "published"


def test_the_trim_is_that_of_the_model(page, case):
    trim = case.linearize(SPEEDS).trim
    rows = table(page, "Steady state at some airspeeds; every airspeed could be analysed")[1:]
    assert [float(row[1]) for row in rows] == pytest.approx(np.degrees(trim.collective), abs=6e-4)
    assert [float(row[5]) for row in rows] == pytest.approx(trim.thrust, abs=0.6)


def test_every_input_stands_there_with_value_status_and_source(page, case):
    rows = {row[0]: row for row in table(page, "All inputs")[1:]}
    assert set(rows) == set(case.sources)
    for path, number in case.sources.items():
        _, written, si, status, source = rows[path]
        assert written == number.written and status.rstrip("*") == number.status
        assert source == (number.source or "–")
        assert status.endswith("*") == (number.status not in ("published", "measured", "derived"))
        if isinstance(number.si, float):
            assert float(si.split()[0]) == pytest.approx(number.si, rel=1e-5)
    stations = [cell for row in table(page, "rotor.twist")[1:] for cell in row[::2] if cell]
    assert sorted(map(float, stations)) == pytest.approx(case.sources["rotor.twist"].r_over_R)


def test_what_the_inputs_amount_to_stands_there(page, case):
    numbers = {row[0]: row[1] for row in table(page, "Blade, rotor and air")[1:]}
    tip = float(case.operation.rotor_speed * case.rotor.radius / case.operation.speed_of_sound)
    assert float(numbers["tip Mach number"].rstrip("?")) == pytest.approx(tip, rel=1e-4)
    trims = table(page, "The blade at trim")[1:]
    assert [len(row) for row in trims] == [8] * 5
    modes = {row[0]: row for row in table(page, "Modes of the support without")[1:]}
    assert set(modes) == {"beam", "chord", "torsion"}


def test_what_the_numbers_rest_on_stands_on_its_face(page, case):
    front = page.text.partition("All crossings")[0]
    assert "11 assumed, 2 calibrated, 7 recalled, of 51" in front
    assert case.calibration.rstrip(".") in front
    assert case.warnings[0] in front


@pytest.mark.parametrize("speeds", ["340:400:20kt", "180:200:10m/s", "350:400:25keas", "400:450:25mph"])
def test_pictures_are_described_in_the_unit_of_the_page(tmp_path, speeds):
    """A reader who hears the page meets one unit of airspeed."""
    out = tmp_path / "x.html"
    assert run("xv15-uncoupled", "--speed", speeds, "--out", out).exit_code == 0
    page = Page(out.read_text(encoding="utf-8"))
    low, high, unit = re.search(r"zero damping between (\S+) and (\S+) (\S+),", page.text).groups()
    lines = [picture["alt"] for picture in page.pictures if " of the modes " in picture["alt"]]
    assert len(lines) == 3
    for told in lines:
        assert f"from {low} to {high} {unit}; " in told


def test_the_page_needs_nothing_else_and_tells_what_it_shows(written, page):
    text = written[0].read_text(encoding="utf-8")
    assert not {"script", "link", "iframe"} & set(page.tags)
    assert not re.findall(r"(?:src|href)=\"(?!data:|#)", text)
    assert len(page.pictures) == 6
    for picture in page.pictures:
        assert len(picture["alt"]) > 40
        kind, _, content = picture["src"].partition(",")
        assert kind == "data:image/svg+xml;base64"
        assert ElementTree.fromstring(base64.b64decode(content)).tag.endswith("svg")
    assert set(page.scopes) == {"col", "row"}
    assert page.tags.count("h1") == 1 and page.tags.count("h2") > 8


def test_the_same_deck_gives_the_same_files_but_for_the_date(written, tmp_path):
    place = tmp_path / "again.html"
    assert run("xv15-uncoupled", "--speed", SPEEDS, "--out", place, "--pdf").exit_code == 0
    for suffix in (".html", ".pdf"):
        assert place.with_suffix(suffix).read_bytes() == written[0].with_suffix(suffix).read_bytes(), suffix
    assert "2025-10-09" in place.read_text(encoding="utf-8")


def test_the_pdf_has_the_same_numbers(written, page):
    reader = PdfReader(io.BytesIO(written[0].with_suffix(".pdf").read_bytes()))
    text = " ".join(" ".join(sheet.extract_text() for sheet in reader.pages).split()).replace("\u200b", "")
    for row in table(page, "Boundaries")[1:] + table(page, "Damping")[1:]:
        for cell in row[:-1]:
            assert cell in text, cell
    assert reader.metadata.title == "XV-15 with three uncoupled wing modes"
    assert len(reader.pages) > 4


def test_a_hostile_title_is_text(tmp_path):
    deck = tmp_path / "hostile.toml"
    deck.write_text(
        f"base = \"xv15-uncoupled\"\n[case]\nname = \"hostile\"\ntitle = '''{HOSTILE}'''\n", encoding="utf-8"
    )
    place = tmp_path / "out.html"
    assert run(deck, "--speed", "200kt", "--out", place, "--pdf").exit_code == 0
    text = place.read_text(encoding="utf-8")
    assert "<script" not in text and "&lt;script&gt;" in text
    assert HOSTILE in Page(text).text
    reader = PdfReader(io.BytesIO(place.with_suffix(".pdf").read_bytes()))
    assert reader.metadata.title == HOSTILE


def test_a_case_that_does_not_flutter_is_reported(tmp_path):
    place = tmp_path / "calm.html"
    result = run("xv15-uncoupled", "--speed", "250:300:25kt", "--out", place)
    assert result.exit_code == 0
    assert "No mode becomes unstable between 250 and 300 KTAS." in result.stdout
    page = Page(place.read_text(encoding="utf-8"))
    assert "Nothing becomes unstable" in page.text
    assert any(name.startswith("Exact derivatives of the damping") for name in page.tables)
    assert len(page.pictures) == 6


def test_failed_points_are_reported_with_their_reason(tmp_path, case):
    place = tmp_path / "fast.html"
    speeds = "300:800:100kt"
    result = run("xv15-uncoupled", "--speed", speeds, "--out", place, "--json")
    modes = case.sweep(speeds)
    failed = modes.reason.values != ""
    assert 0 < failed.sum() < len(failed)
    assert result.exit_code == 0
    assert json.loads(result.stdout)["failed airspeeds (m/s)"] == pytest.approx(modes.airspeed.values[failed])
    told = Page(place.read_text(encoding="utf-8"))
    assert not any("every airspeed could be analysed" in name for name in told.tables)
    rows = table(told, "Airspeeds that could not")
    assert sum(int(row[1]) for row in rows[1:]) == failed.sum()
    assert {row[2] for row in rows[1:]} == set(modes.reason.values[failed])


def test_where_nothing_can_be_analysed_the_report_says_so(tmp_path):
    place = tmp_path / "none.html"
    result = run("xv15-uncoupled", "--speed", "780:800:10kt", "--out", place)
    assert result.exit_code == 1
    page = Page(place.read_text(encoding="utf-8"))
    assert "No airspeed could be analysed." in page.text
    assert len(table(page, "All inputs")) > 40


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("xv16",), "did you mean xv15?"),
        (("xv15-uncoupled", "--out", "page.txt"), "--out = page.txt: must end in .html or .pdf"),
        (("xv15-uncoupled", "--speed", "fast"), "--speed"),
        (("xv15-uncoupled", "--set", "rotor.radius=-1 ft"), "rotor.radius"),
    ],
)
def test_an_unusable_input_is_one_message(arguments, told, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run(*arguments)
    assert result.exit_code == 2
    assert told in result.stderr and "Traceback" not in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_date_that_is_none_is_told(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run("xv15-uncoupled", SOURCE_DATE_EPOCH="yesterday")
    assert result.exit_code == 2 and "SOURCE_DATE_EPOCH" in result.stderr


def test_without_typst_a_pdf_is_refused_before_the_analysis(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "typst", None)
    monkeypatch.setattr("proprotor.report.analyse", lambda *_: pytest.fail("analysed"))
    result = run("xv15-uncoupled", "--out", tmp_path / "x.pdf")
    assert result.exit_code == 2
    assert 'pip install "proprotor[report]"' in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_failed_write_leaves_what_was_there(tmp_path, monkeypatch):
    place = tmp_path / "kept.html"
    place.write_text("as it was", encoding="utf-8")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("proprotor.files.output.os.replace", full)
    result = run("xv15-uncoupled", "--speed", "200kt", "--out", place)
    assert result.exit_code == 1
    assert "No space left on device" in result.stderr
    assert place.read_text(encoding="utf-8") == "as it was"
    assert list(tmp_path.iterdir()) == [place]


def test_the_envelope_of_a_deck_stands_there(tmp_path):
    deck = """
base = "xv15-uncoupled"
[case]
name = "wing"
title = "A wing"
[envelope]
dive_speed = "260 keas"
altitudes = { value = [0, 15000], unit = "ft" }
[variants.soft]
rotor.control_stiffness = "5400 N*m/rad"
"""
    (tmp_path / "wing.toml").write_text(deck)
    run(tmp_path / "wing.toml", "--speed", SPEEDS, "--out", tmp_path / "wing.html")
    page = Page((tmp_path / "wing.html").read_text())
    found = pp.load_case(tmp_path / "wing.toml").envelope()
    (rows,) = [
        rows for caption, rows in page.tables.items() if caption.startswith("Each condition at its worst")
    ]
    assert [row[-1] for row in rows[1:]] == ["as the deck", "soft"] == found.condition.values.tolist()
    margins = [float(row[rows[0].index("margin")]) for row in rows[1:]]
    np.testing.assert_allclose(margins, 100 * found.margin.min("altitude").values.ravel(), atol=0.051)
    assert "one part of what a showing of compliance needs" in page.text
    assert any("Lines of the onset of as the deck, soft" in picture["alt"] for picture in page.pictures)


def test_an_envelope_that_cannot_be_found_is_told(tmp_path):
    settings = (
        "--set",
        "envelope.dive_speed=260 keas",
        "--set",
        'envelope.altitudes={value=[0, 40], unit="km"}',
    )
    run("xv15-uncoupled", "--speed", SPEEDS, "--out", tmp_path / "a.html", *settings)
    text = Page((tmp_path / "a.html").read_text()).text
    assert "The envelope could not be found: altitude = 40000 m: must lie between" in text
