"""A server of the page for this machine alone."""

from __future__ import annotations

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

if TYPE_CHECKING:
    from bokeh.document import Document

ADDRESS = "127.0.0.1"


class _OwnPages(BokehTornado):
    """Answers pages of its own, asked for by the machine's own names, and nobody else.

    A foreign page may have a name of its own point here; the browser then sends that name along. It may also ask here
    by the right name, from which the browser sends an origin, or that the page is of another site.
    """

    names: frozenset[str] = frozenset()

    def find_handler(self, request: Any, **more: Any) -> Any:
        if not self._is_own(request):
            return self.get_handler_delegate(request, ErrorHandler, {"status_code": 403})
        return super().find_handler(request, **more)

    def _is_own(self, request: Any) -> bool:
        if request.host not in self.names or request.path.startswith("/autoload"):
            return False  # the latter is Bokeh's script for foreign pages, which has a session
        if (origin := request.headers.get("Origin")) is not None:
            return origin in {f"http://{name}" for name in self.names}
        # From another port of this machine is "same-site"; what a reader has typed is "none".
        return request.headers.get("Sec-Fetch-Site", "none") in ("none", "same-origin")


def listen(port: int) -> socket.socket:
    """A socket on this machine's own address; port 0 takes a free one.

    Raises
    ------
    OSError
        When the port is taken.
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


def serve(page: Callable[[Document], None], opened: socket.socket, ready: Callable[[str], None]) -> None:
    """Serve a page until it is interrupted.

    Parameters
    ----------
    page : callable
        Puts a page on the document of each reader.
    opened : socket
        Of `listen`.
    ready : callable
        Told the address once the page can be opened.
    """
    port = opened.getsockname()[1]
    names = frozenset(f"{name}:{port}" for name in (ADDRESS, "localhost"))
    loop = IOLoop()
    application = _OwnPages(
        {"/": Application(FunctionHandler(page))}, extra_websocket_origins=sorted(names), use_index=False
    )
    application.names = names
    http = HTTPServer(application)
    http.add_socket(opened)
    server = BaseServer(loop, application, http)
    server.start()
    ready(f"http://{ADDRESS}:{port}/")
    try:
        loop.start()
    except KeyboardInterrupt:
        pass
    finally:
        server.stop()
        http.stop()
        loop.close(all_fds=True)
