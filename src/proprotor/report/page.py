"""A document as one HTML file that needs nothing else."""

from __future__ import annotations

from base64 import b64encode

from proprotor.report.document import Document


def html_of(document: Document) -> str:
    """The document as HTML: pictures inside, no script, nothing from a network; all text is escaped."""
    import jinja2  # here, because only a report needs it

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
