"""A server of the page for this machine alone."""

from __future__ import annotations

import hmac
import socket
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from bokeh.application import Application
from bokeh.application.handlers.function import FunctionHandler
from bokeh.server.server import BaseServer
from bokeh.server.tornado import BokehTornado
from tornado.httpserver import HTTPServer
from tornado.ioloop import IOLoop
from tornado.web import ErrorHandler

from proprotor.explore.turns import Turns

if TYPE_CHECKING:
    from bokeh.document import Document

ADDRESS = "127.0.0.1"


class _OwnPages(BokehTornado):
    """A server that answers only requests of its own page, sent to one of this machine's own names.

    A foreign site may let its own name point to this machine; then the browser sends that name along as the host. A
    foreign page may also send requests to the right name; then the browser sends the origin of the page along, or says
    that the page belongs to another site. A notebook is such a foreign page: it may show the page of a server whose
    place only the notebook knows.

    names : own names with the port; secret : the place of the page that others may show, "" for none
    """

    names: frozenset[str] = frozenset()
    secret: str = ""

    def find_handler(self, request: Any, **more: Any) -> Any:
        if not self._is_own(request):
            return self.get_handler_delegate(request, ErrorHandler, {"status_code": 403})
        return super().find_handler(request, **more)

    def _is_own(self, request: Any) -> bool:
        if request.host not in self.names or request.path.removeprefix(self.secret).startswith("/autoload"):
            return False  # /autoload is Bokeh's script for foreign pages, and opens a session
        if (origin := request.headers.get("Origin")) is not None:
            return origin in {f"http://{name}" for name in self.names}
        if self.secret and hmac.compare_digest(request.path, self.secret):
            return True
        # "same-site" is a page from another port of this machine; "none" is an address that the reader has typed.
        return request.headers.get("Sec-Fetch-Site", "none") in ("none", "same-origin")


def listen(port: int) -> socket.socket:
    """Return a socket on this machine's own address; port 0 takes a free port.

    Raises
    ------
    OSError
        If the port is taken.
    """
    opened = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    opened.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        opened.bind((ADDRESS, port))
        opened.listen(16)
    except OSError:
        opened.close()
        raise
    opened.setblocking(False)
    return opened


def started(
    page: Callable[[Document, Turns], None], opened: socket.socket, loop: IOLoop, place: str = ""
) -> BaseServer:
    """Start a server of a page on an event loop.

    Parameters
    ----------
    page : callable
        Puts a page into the Bokeh document of each reader; takes the turns of all readers too.
    opened : socket
        Result of `listen`.
    loop : IOLoop
    place : str
        A secret word: the page then is at this place alone, and other pages that know the place may show it.
    """
    port, turns = opened.getsockname()[1], Turns(loop)
    names = frozenset(f"{name}:{port}" for name in (ADDRESS, "localhost"))
    application = _OwnPages(
        {f"/{place}": Application(FunctionHandler(lambda document: page(document, turns)))},
        extra_websocket_origins=sorted(names),
        use_index=False,
    )
    application.names, application.secret = names, f"/{place}" if place else ""
    http = HTTPServer(application)
    http.add_socket(opened)
    server = BaseServer(loop, application, http)
    server.start()
    return server


def serve(
    page: Callable[[Document, Turns], None], opened: socket.socket, ready: Callable[[str], None]
) -> None:
    """Serve a page until it is interrupted.

    Parameters
    ----------
    page : callable
        Puts a page into the Bokeh document of each reader; takes the turns of all readers too.
    opened : socket
        Result of `listen`.
    ready : callable
        Called with the address once the page can be opened.
    """
    loop = IOLoop()
    server = started(page, opened, loop)
    ready(f"http://{ADDRESS}:{opened.getsockname()[1]}/")
    try:
        loop.start()
    except KeyboardInterrupt:
        pass
    finally:
        server.stop()
        loop.close(all_fds=True)
