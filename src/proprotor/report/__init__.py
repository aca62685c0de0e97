"""The report on a case: one page with all results, and every input with its source, as HTML, PDF or DOCX.

In come a case, airspeeds and options; out goes the content of a file. Each step takes the result of the step before.

    analyses        the results that a report shows: `analyse` returns `Findings`
    content         the findings in words, tables and pictures: `report_document` returns a `Document`
    summary         what stands on the first page: verdict, numbers of the rotor, inputs that matter
    pictures        the plots of a report, as SVG or PNG
    document        the parts of a document, the same for every layout
    page            a document as HTML, by the template page.html
    typeset         a document as PDF, by the layout page.typ and Typst (extra `report`)
    word            a document as DOCX, by python-docx (extra `report`)

The same deck gives the same file, except for the date. This room may import the rooms above it, from `errors` to
`plots`.
"""

from proprotor.report.analyses import Findings, analyse
from proprotor.report.content import report_document
from proprotor.report.document import Document
from proprotor.report.page import html_of
from proprotor.report.typeset import check_typesetter, pdf_of
from proprotor.report.word import check_word, docx_of

__all__ = [
    "Document",
    "Findings",
    "analyse",
    "check_typesetter",
    "check_word",
    "docx_of",
    "html_of",
    "pdf_of",
    "report_document",
]
