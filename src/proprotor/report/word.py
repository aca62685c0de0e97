"""A document as DOCX, for people who go on writing in it (extra `report`)."""

from __future__ import annotations

import io
import zipfile
from datetime import UTC, datetime, time
from datetime import date as day
from typing import Any

from proprotor.needs import need
from proprotor.report.document import Document, Picture, Table, Text

_WIDTH = 178.0  # mm between the margins of A4
_MARGIN = 16.0  # mm
_BLUE, _RED = "0072B2", "B34700"  # the bars beside the verdict and beside warnings
_MOST, _LONGEST = 200, 40  # characters of a cell, and of a word, that count for the width of a column
_CHARACTER, _BESIDE = 1.6, 3  # mm of a character of a table, and characters of the space between two cells
_SMALL, _SMALLER, _MANY = 8, 7, 9  # points of a table, and of one with many columns; how many are many
_TOGETHER = 15  # rows of the longest table that is not split between two pages
_TABLE = "Light Shading"  # the style of tables
_PADDING = "20"  # above and below the text of a cell, in twentieths of a point
_BAND = "F2F2F2"  # every other row of a table, pale enough to read small print on
_FONT = "Arial"  # which every text processor has, or one of the same widths
_FIRST_DATE = (1980, 1, 1, 0, 0, 0)  # that a ZIP archive can have


def check_word() -> None:
    """Refuse to make a DOCX without its package; call this function before an analysis.

    Raises
    ------
    InputError
        If python-docx is not installed.
    """
    need("docx", "--docx", "a DOCX", "report")


def docx_of(document: Document) -> bytes:
    """Return the document as DOCX: headings, tables and captions in styles, pictures with their descriptions.

    The same document gives the same bytes.

    Raises
    ------
    InputError
        If python-docx is not installed.
    """
    check_word()
    import docx  # here, because only a DOCX needs docx

    file = docx.Document()
    _set_up(file, document)
    file.add_paragraph(document.title, "Title")
    file.add_paragraph(f"{document.subtitle}. Whirl-flutter report of {document.date}.", "Subtitle")
    for sentence in document.verdict:
        _barred(file, sentence, _BLUE, bold=True)
    if document.caution:
        file.add_paragraph().add_run("What this rests on").bold = True
        for sentence in document.caution:
            _barred(file, sentence, _RED)
    for part in document.summary:
        _add(file, part)
    _add_contents(file, document)
    for number, section in enumerate(document.sections):
        heading = file.add_heading(section.title, 1)
        heading.paragraph_format.page_break_before = number == 0
        _mark(heading, number)
        for block in section.blocks:
            _add(file, block)
    content = io.BytesIO()
    file.save(content)
    return _undated(content.getvalue())


def _add_contents(file: Any, document: Document) -> None:
    """List the sections with their pages. The number of a page is a field, which the text processor computes."""
    from docx.enum.text import WD_TAB_ALIGNMENT, WD_TAB_LEADER
    from docx.shared import Mm, Pt

    if document.sections:
        head = file.add_paragraph()
        head.add_run("Contents").bold = True
        head.paragraph_format.space_before, head.paragraph_format.keep_with_next = Pt(9), True
    for number, section in enumerate(document.sections):
        line = file.add_paragraph()
        line.paragraph_format.space_after = Pt(0)
        line.paragraph_format.tab_stops.add_tab_stop(Mm(_WIDTH), WD_TAB_ALIGNMENT.RIGHT, WD_TAB_LEADER.DOTS)
        link = _element("w:hyperlink", anchor=_place(number))
        link.append(line.add_run(f"{section.title}\t")._r)
        line._p.append(link)
        _add_field(line, f"PAGEREF {_place(number)}")


def _mark(heading: Any, number: int) -> None:
    """Give a heading a bookmark, to which the line of the contents leads."""
    start, end = (
        _element("w:bookmarkStart", id=str(number), name=_place(number)),
        _element("w:bookmarkEnd", id=str(number)),
    )
    heading._p.get_or_add_pPr().addnext(start)
    heading._p.append(end)


def _place(number: int) -> str:
    """Return the name of the bookmark of a section."""
    return f"section_{number + 1}"


def _set_up(file: Any, document: Document) -> None:
    """Set paper, fonts, properties, and the line at the foot of every page."""
    from docx.oxml.ns import qn
    from docx.shared import Mm, Pt

    section = file.sections[0]
    section.page_width, section.page_height = Mm(210), Mm(297)
    for side in ("left", "right", "top", "bottom"):
        setattr(section, f"{side}_margin", Mm(_MARGIN))
    for name, size, after in (
        ("Normal", 10, 3),
        ("Caption", 9, 3),
        ("Title", 19, 2),
        ("Subtitle", 10, 4),
        ("Footer", 8, 0),
    ):
        style = file.styles[name]
        style.font.size, style.paragraph_format.space_after = Pt(size), Pt(after)
    for name in ("Normal", "Title", "Heading 1"):  # the other styles follow these
        _set_font(file.styles[name])
    file.styles["Caption"].paragraph_format.keep_with_next = True
    for side in file.styles[_TABLE].element.iter(qn("w:tblCellMar")):
        for name in ("top", "bottom"):
            side.find(qn(f"w:{name}")).set(qn("w:w"), _PADDING)
    for band in file.styles[_TABLE].element.iter(qn("w:shd")):
        band.attrib.clear()
        band.attrib.update({qn("w:val"): "clear", qn("w:color"): "auto", qn("w:fill"): _BAND})
    properties, moment = (
        file.core_properties,
        datetime.combine(day.fromisoformat(document.date), time(12), UTC),
    )
    properties.title, properties.author, properties.comments = document.title, "proprotor", document.subtitle
    properties.created = properties.modified = moment.replace(tzinfo=None)
    foot = section.footer.paragraphs[0]
    foot.add_run(f"{document.subtitle}, {document.date}, page ")
    _add_field(foot, "PAGE")
    foot.add_run(" of ")
    _add_field(foot, "NUMPAGES")


def _set_font(style: Any) -> None:
    """Let a style have the font of the report in place of the font of the theme."""
    from docx.oxml.ns import qn

    style.font.name = _FONT
    fonts = style.element.rPr.rFonts
    for name in [name for name in fonts.attrib if name.endswith("Theme")]:
        del fonts.attrib[name]
    fonts.set(qn("w:hAnsi"), _FONT)


def _add(file: Any, block: Text | Table | Picture) -> None:
    """Add a block at the end of the file."""
    if isinstance(block, Text):
        for paragraph in block.paragraphs:
            if block.warning:
                _barred(file, paragraph, _RED)
            else:
                file.add_paragraph(paragraph)
    elif isinstance(block, Table):
        _add_table(file, block)
    else:
        _add_picture(file, block)


def _barred(file: Any, sentence: str, colour: str, *, bold: bool = False) -> None:
    """Add a paragraph with a bar of a colour to its left."""
    from docx.shared import Mm

    paragraph = file.add_paragraph()
    paragraph.add_run(sentence).bold = bold
    paragraph.paragraph_format.left_indent = Mm(3)
    border = _element("w:pBdr")
    border.append(_element("w:left", val="single", sz="24", space="6", color=colour))
    paragraph._p.get_or_add_pPr().insert_element_before(
        border, "w:shd", "w:tabs", "w:spacing", "w:ind", "w:jc"
    )


def _add_table(file: Any, block: Table) -> None:
    """Add a table beneath its caption; its headings stand on every page, and rows are not torn apart."""
    from docx.enum.text import WD_ALIGN_PARAGRAPH
    from docx.shared import Mm, Pt

    file.add_paragraph(block.caption, "Caption")
    widths = [Mm(width) for width in _widths(block)]
    size = Pt(_SMALLER if len(widths) > _MANY else _SMALL)
    table = file.add_table(len(block.rows) + 1, len(block.columns), _TABLE)
    table.autofit = False
    for column, width in zip(table.columns, widths, strict=True):
        column.width = width
    grid = [list(row.cells) for row in table.rows]
    for place, (texts, cells) in enumerate(zip((block.columns, *block.rows), grid, strict=True)):
        for text, cell, width, column in zip(texts, cells, widths, block.columns, strict=True):
            cell.width = width
            paragraph = cell.paragraphs[0]
            paragraph.paragraph_format.space_after = Pt(0)
            paragraph.paragraph_format.keep_with_next = place < len(block.rows) <= _TOGETHER
            run = paragraph.add_run(text.replace(" %", "\N{NO-BREAK SPACE}%"))
            run.font.size, run.bold = size, place == 0
            if column in block.numbers:
                paragraph.alignment = WD_ALIGN_PARAGRAPH.RIGHT
    for place, row in enumerate(table.rows):
        properties = row._tr.get_or_add_trPr()
        properties.append(_element("w:cantSplit"))
        if place == 0:
            properties.append(_element("w:tblHeader"))
    file.add_paragraph().paragraph_format.space_after = Pt(0)


def _widths(block: Table) -> list[float]:
    """Return the widths of columns (mm): what their longest texts need.

    Where that is too much, each column has what its longest word or number needs, and shares of the rest.
    """
    columns = list(zip(block.columns, *block.rows, strict=True))
    whole = [max(min(_MOST, len(text)) for text in texts) + _BESIDE for texts in columns]
    least = [max(_longest_word(text) for text in texts) + _BESIDE for texts in columns]
    wanted, room = sum(whole) - sum(least), _WIDTH / _CHARACTER - sum(least)
    share = min(1.0, max(0.0, room) / wanted) if wanted else 0.0
    lengths = [few + share * (many - few) for few, many in zip(least, whole, strict=True)]
    scale = min(_CHARACTER, _WIDTH / sum(lengths))
    return [scale * length for length in lengths]


def _longest_word(text: str) -> int:
    return max((min(_LONGEST, len(word)) for word in text.split()), default=0)


def _add_picture(file: Any, block: Picture) -> None:
    """Add a picture above its caption, with a description for readers who cannot see it."""
    from docx.shared import Mm

    paragraph = file.add_paragraph()
    paragraph.paragraph_format.keep_with_next = True
    shape = paragraph.add_run().add_picture(io.BytesIO(block.png), width=Mm(block.share * _WIDTH))
    shape._inline.docPr.set("descr", block.alt)
    shape._inline.docPr.set("name", block.name)
    caption = file.add_paragraph(block.caption, "Caption")
    caption.paragraph_format.keep_with_next = False


def _add_field(paragraph: Any, name: str) -> None:
    """Add a field that the text processor computes, such as the number of the page."""
    field = _element("w:fldSimple", instr=name)
    field.append(paragraph.add_run("1")._r)
    paragraph._p.append(field)


def _element(name: str, /, **attributes: str) -> Any:
    """Return an element of WordprocessingML with its attributes."""
    from docx.oxml import OxmlElement
    from docx.oxml.ns import qn

    element = OxmlElement(name)
    for attribute, value in attributes.items():
        element.set(qn(f"w:{attribute}"), value)
    return element


def _undated(content: bytes) -> bytes:
    """Return an archive with the same members, none of which has the time at which it was written."""
    found = io.BytesIO()
    with (
        zipfile.ZipFile(io.BytesIO(content)) as old,
        zipfile.ZipFile(found, "w", zipfile.ZIP_DEFLATED) as new,
    ):
        for name in old.namelist():
            new.writestr(zipfile.ZipInfo(name, _FIRST_DATE), old.read(name), zipfile.ZIP_DEFLATED)
    return found.getvalue()
