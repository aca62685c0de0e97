"""The report on a case: one page with all that was found and all that it rests on, as HTML or PDF.

`analyses` finds the numbers, `content` puts them into the words, tables and pictures of a `document`, and `page` and
`typeset` lay that out. The same deck gives the same file, but for the date.
"""

from proprotor.report.analyses import Findings, analyse
from proprotor.report.content import report_document
from proprotor.report.document import Document
from proprotor.report.page import html_of
from proprotor.report.typeset import check_typesetter, pdf_of

__all__ = ["Document", "Findings", "analyse", "check_typesetter", "html_of", "pdf_of", "report_document"]
