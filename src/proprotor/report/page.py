"""A document as one HTML file that needs no other file."""

from __future__ import annotations

from base64 import b64encode

from proprotor.report.document import Document


def html_of(document: Document) -> str:
    """Return the document as HTML, with pictures inside and no scripts, and nothing from a network.

    All text is escaped.
    """
    import jinja2  # here, because only a report needs jinja2

    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("proprotor.report", "templates"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters["data_uri"] = lambda svg: f"data:image/svg+xml;base64,{b64encode(svg).decode()}"
    return environment.get_template("page.html").render(document=document)
