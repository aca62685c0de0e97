"""Words that change as often as the curves."""

from __future__ import annotations

from importlib import resources
from typing import TYPE_CHECKING, Any

from bokeh.models import ColumnDataSource, CustomJS
from bokeh.models.widgets import Div

if TYPE_CHECKING:
    from bokeh.document import Document


def script(name: str) -> Any:
    """Return a script of this room for the browser."""
    return resources.files("proprotor.explore").joinpath(name).read_text(encoding="utf-8")


class Text:
    """A piece of HTML on the page.

    Bokeh lays out the whole page when the text of a Div changes, which takes longer than the curves. So the text is
    sent by itself, and a script of the browser puts the text into the Div.

    Attributes
    ----------
    div : Div
        Part of the layout.
    source : ColumnDataSource
        Sends the text.
    """

    def __init__(self, name: str, **style: Any) -> None:
        self.div = Div(name=name, disable_math=True, margin=(2, 5), **style)
        self.source = ColumnDataSource({"text": [""]}, name=f"{name}-text")
        self.source.js_on_change("data", CustomJS(args={"div": self.div}, code=script("text.js")))

    def put_on(self, document: Document) -> None:
        """Show the text from the beginning of a page, and each later text."""
        self.div.text = self.text
        document.add_root(self.source)

    @property
    def text(self) -> str:
        """HTML."""
        return self.source.data["text"][0]  # type: ignore[no-any-return]

    @text.setter
    def text(self, html: str) -> None:
        if html != self.text:
            self.source.data = {"text": [html]}
