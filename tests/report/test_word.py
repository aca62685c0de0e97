"""The DOCX of a report, read again by python-docx: the same sentences, tables and pictures, to go on writing in."""

import dataclasses
import io
import struct
import zipfile
from xml.etree import ElementTree

import docx
import pytest

import proprotor as pp
from proprotor.report import analyse, docx_of, report_document
from proprotor.report.document import Document, Picture, Section, Table, Text

HOSTILE = "<w:p>&amp; ]]> ${x}"
W = "{http://schemas.openxmlformats.org/wordprocessingml/2006/main}"


@pytest.fixture(scope="module")
def document():
    case = pp.load_case("xv15-uncoupled")
    found = analyse(case, pp.load_case("xv15-uncoupled").sweep("340:400:30kt").airspeed.values, {})
    return report_document(case, found, settings={}, deck_hash="0", date="2025-10-09")


@pytest.fixture(scope="module")
def content(document):
    return docx_of(document)


@pytest.fixture(scope="module")
def file(content):
    return docx.Document(io.BytesIO(content))


def blocks_of(document, kind):
    parts = [*document.summary, *(block for section in document.sections for block in section.blocks)]
    return [part for part in parts if isinstance(part, kind)]


def test_the_headings_are_styles_that_a_text_processor_lists(file, document):
    headings = [p.text for p in file.paragraphs if p.style.name == "Heading 1"]
    assert headings == [section.title for section in document.sections]
    assert [p.text for p in file.paragraphs if p.style.name == "Title"] == [document.title]
    first = next(p for p in file.paragraphs if p.style.name == "Heading 1")
    assert first.paragraph_format.page_break_before


def test_the_contents_lead_to_every_section(file, document):
    """Each line is a link to the bookmark of a heading, and a field that has its page."""
    places = {
        place.get(f"{W}name"): "".join(text.text for text in heading.iter(f"{W}t"))
        for heading in file.element.body.iter(f"{W}p")
        for place in heading.iter(f"{W}bookmarkStart")
    }
    links = list(file.element.body.iter(f"{W}hyperlink"))
    titles = [section.title for section in document.sections]
    assert ["".join(text.text for text in link.iter(f"{W}t")).strip() for link in links] == titles
    assert [places[link.get(f"{W}anchor")] for link in links] == titles
    fields = [field.get(f"{W}instr") for field in file.element.body.iter(f"{W}fldSimple")]
    assert fields == [f"PAGEREF {link.get(f'{W}anchor')}" for link in links]


def test_a_short_table_stays_on_one_page(file):
    for table in file.tables:
        *kept, last = ([cell.paragraphs[0].paragraph_format for cell in row.cells] for row in table.rows)
        together = {form.keep_with_next for row in kept for form in row}
        assert together == {len(table.rows) <= 16} and not any(form.keep_with_next for form in last)


def test_the_verdict_and_what_it_rests_on_come_first(file, document):
    texts = [p.text for p in file.paragraphs]
    end = texts.index(document.sections[0].title)
    assert [text for text in texts[:end] if text in document.verdict] == list(document.verdict)
    assert set(document.caution) <= set(texts[:end])


def test_the_tables_are_those_of_the_document(file, document):
    tables = blocks_of(document, Table)
    assert len(file.tables) == len(tables) > 8
    for written, meant in zip(file.tables, tables, strict=True):
        rows = [
            [cell.text.replace("\N{NO-BREAK SPACE}%", " %") for cell in row.cells] for row in written.rows
        ]
        assert rows == [list(meant.columns), *map(list, meant.rows)]
        assert written.rows[0]._tr.trPr.find(f"{W}tblHeader") is not None
        widths = [column.width.mm for column in written.columns]
        assert sum(widths) <= 178.1 and min(widths) > 3


def test_the_bands_of_tables_are_pale_enough_to_read_small_print_on(file):
    for table in file.tables:
        shades = [band.get(f"{W}fill") for band in table.style.element.iter(f"{W}shd")]
        assert shades and all(min(bytes.fromhex(shade)) > 0xE0 for shade in shades)
        assert not any(
            "theme" in name for band in table.style.element.iter(f"{W}shd") for name in band.attrib
        )


def test_every_paragraph_of_text_is_there(file, document):
    texts = [p.text for p in file.paragraphs]
    for block in blocks_of(document, Text):
        assert set(block.paragraphs) <= set(texts)


def test_pictures_have_their_width_and_a_description(file, content, document):
    pictures = blocks_of(document, Picture)
    shapes = list(file.inline_shapes)
    assert [shape._inline.docPr.get("descr") for shape in shapes] == [picture.alt for picture in pictures]
    for shape, picture in zip(shapes, pictures, strict=True):
        assert shape.width.mm == pytest.approx(178 * picture.share, abs=0.1)
        width, height = struct.unpack(">II", picture.png[16:24])  # of the header of a PNG
        assert width > 800 and shape.height / shape.width == pytest.approx(height / width, rel=0.01)


def test_the_same_document_gives_the_same_bytes(content, document):
    assert docx_of(document) == content
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        assert {member.date_time for member in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        assert archive.testzip() is None


def test_its_properties_are_those_of_the_report(file, document):
    assert file.core_properties.title == document.title
    assert file.core_properties.created.date().isoformat() == "2025-10-09"
    assert file.sections[0].page_width.mm == pytest.approx(210, abs=0.1)
    assert document.date in file.sections[0].footer.paragraphs[0].text


def test_hostile_text_is_text():
    document = Document(
        HOSTILE,
        HOSTILE,
        "2025-10-09",
        (HOSTILE,),
        (HOSTILE,),
        (Text((HOSTILE,)), Table(HOSTILE, (HOSTILE, "b"), ((HOSTILE, ""),))),
        (Section(HOSTILE, (Text((HOSTILE,), warning=True),)),),
    )
    content = docx_of(document)
    file = docx.Document(io.BytesIO(content))
    assert [p.text for p in file.paragraphs].count(HOSTILE) >= 5
    assert file.tables[0].rows[1].cells[0].text == HOSTILE
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        for name in archive.namelist():
            if name.endswith(".xml"):
                ElementTree.fromstring(archive.read(name))


def test_a_document_without_sections_is_a_file(document):
    assert docx.Document(io.BytesIO(docx_of(dataclasses.replace(document, sections=(), caution=()))))
