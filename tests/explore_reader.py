"""A reader of the explorer's page without a browser: moves sliders over the page's own socket, and reads the answers.

Bokeh's own client cannot do this: while it waits for a reply it throws away what the server sends in between.
"""

import asyncio
import json

from bokeh.client.websocket import WebSocketClientConnectionWrapper
from bokeh.document import Document
from bokeh.document.events import ModelChangedEvent
from bokeh.protocol import Protocol
from bokeh.protocol.receiver import Receiver
from bokeh.util.token import generate_jwt_token, generate_session_id
from tornado.websocket import websocket_connect

_LONGEST = 60  # s until an answer


class Reader:
    """One reader's page."""

    def __init__(self, socket):
        self._socket, self._protocol = WebSocketClientConnectionWrapper(socket), Protocol()
        self._receiver, self.document = Receiver(self._protocol), Document()

    @classmethod
    async def opened(cls, address):
        """A reader who has opened the page at an address."""
        token = generate_jwt_token(generate_session_id())
        url = address.replace("http", "ws") + "ws"
        reader = cls(await websocket_connect(url, subprotocols=["bokeh", token], max_message_size=2**26))
        await reader._message("ACK")
        await reader._send("PULL-DOC-REQ")
        (await reader._message("PULL-DOC-REPLY")).push_to_document(reader.document)
        return reader

    @property
    def told(self):
        """The flutter speed and the changed inputs, as HTML."""
        content = self.document.get_model_by_name("curves-post").data["content"][0]
        return next(part for part in json.loads(content) if isinstance(part, str))

    async def move(self, name, value):
        """Move a slider, by the name of its model."""
        slider = self.document.get_model_by_name(name)
        await self._send("PATCH-DOC", [ModelChangedEvent(self.document, slider, "value", value)])

    async def answer(self):
        """Wait for the next change of the page, and return the names of what was changed."""
        message = await asyncio.wait_for(self._message("PATCH-DOC"), _LONGEST)
        message.apply_to_document(self.document)
        return [
            self.document.get_model_by_id(event["model"]["id"]).name for event in message.content["events"]
        ]

    async def close(self):
        self._socket.close()
        while await self._socket.read_message(None) is not None:
            pass  # until the server has closed as well

    async def _send(self, kind, *content):
        await self._protocol.create(kind, *content).send(self._socket)

    async def _message(self, kind):
        """The next message of a kind; others are left out."""
        while True:
            fragment = await self._socket.read_message(None)
            assert fragment is not None, "the server closed the page"
            message = await self._receiver.consume(fragment)
            if message is not None and message.msgtype == kind:
                return message
