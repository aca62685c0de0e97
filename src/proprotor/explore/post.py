"""What changes with each move, sent to the browser as one message."""

from __future__ import annotations

import json
from collections.abc import Mapping
from importlib import resources
from typing import TYPE_CHECKING, Any

import numpy as np
from bokeh.events import DocumentReady
from bokeh.models import ColumnDataSource, CustomJS
from bokeh.models.widgets import Div

from proprotor.typing import Array

if TYPE_CHECKING:
    from bokeh.document import Document


def script(name: str) -> Any:
    """Return a script of this room for the browser."""
    return resources.files("proprotor.explore").joinpath(name).read_text(encoding="utf-8")


class Text:
    """A piece of HTML on the page, sent by a post.

    Attributes
    ----------
    model : Div
        Part of the layout, in the browser with the text.
    text : str
        HTML.
    """

    def __init__(self, name: str, **style: Any) -> None:
        self.model = Div(name=name, disable_math=True, margin=(2, 5), **style)
        self.text = ""


class Columns:
    """The data of a plot, sent by a post.

    Attributes
    ----------
    model : ColumnDataSource
        What the plot draws, in the browser with the data. Columns that `data` lacks stay as they are.
    data : mapping of str to sequence
        A column of words, numbers or arrays by its name.
    """

    def __init__(self, model: ColumnDataSource) -> None:
        self.model = model
        self.data: Mapping[str, Any] = dict(model.data)


class Post:
    """Sends texts and data of plots together.

    Bokeh sends each property by a message of its own, and each array by two more. The browser takes longer to receive
    a hundred messages than to draw the curves, and draws a plot anew for each of them. A new text of a Div even is a
    reason for Bokeh to lay out the whole page. So texts and data are sent as one text and one array, and a script of
    the browser puts them where they belong.

    Parameters
    ----------
    name : str
        Of the source that brings the message.
    *parts : Text or Columns
        What is sent, each time all of it.
    """

    def __init__(self, name: str, *parts: Text | Columns) -> None:
        self._parts = parts
        self.source = ColumnDataSource({"content": [], "numbers": []}, name=name)
        models = [part.model for part in parts]
        self._opened = CustomJS(args={"post": self.source, "models": models}, code=script("post.js"))
        self.source.js_on_change("data", self._opened)

    def put_on(self, document: Document) -> None:
        """Show what was sent from the beginning of a page."""
        document.add_root(self.source)
        document.js_on_event(DocumentReady, self._opened)

    def send(self) -> None:
        """Send all parts as they are now."""
        content, numbers = _packed(
            [part.text if isinstance(part, Text) else part.data for part in self._parts]
        )
        self.source.data = {"content": [content], "numbers": [numbers]}


def _packed(content: Any) -> tuple[str, Array]:
    """Return content as JSON, in which `{"numbers": n}` stands for an array of n numbers, and all numbers in one array.

    Arrays stand in the order in which a reader of the JSON meets them.
    """
    arrays: list[Array] = [np.empty(0, np.float32)]

    def placed(array: Array) -> dict[str, int]:
        arrays.append(np.asarray(array, np.float32))
        return {"numbers": len(array)}

    text = json.dumps(content, default=placed, allow_nan=False)
    return text, np.concatenate(arrays)
