"""The order in which a server does what its readers wait for: curves first, and parts of maps in between."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from typing import Protocol

_PAUSE = 0.002  # s after each part, in which the server receives the moves that have come meanwhile
_LONGEST = 0.1  # s for which a part of a map waits for curves


class _Loop(Protocol):
    """What turns need of an event loop."""

    def time(self) -> float:
        """Return the time, s."""

    def call_later(self, delay: float, callback: Callable[[], None]) -> object:
        """Call a function after a delay, s."""


class Turns:
    """The maps that the readers of one server wait for, computed a part of one map at a time.

    A part goes when no reader waits for curves, so that a move waits for one part at most, however many readers wait
    for maps. Maps take turns. Where readers never stop to wait for curves, a part goes after a tenth of a second
    nevertheless.

    Parameters
    ----------
    loop : tornado.ioloop.IOLoop
        Of the server.
    """

    def __init__(self, loop: _Loop) -> None:
        self._loop = loop
        self._curves: set[object] = set()  # readers who wait for curves
        self._maps: deque[Iterator[None]] = deque()
        self._since = 0.0  # when the last part was done, or the first map came
        self._going = False  # whether the loop will call for the next part

    def curves_wait(self, reader: object) -> None:
        """Let the maps wait for the curves of a reader."""
        self._curves.add(reader)

    def curves_done(self, reader: object) -> None:
        """Let the maps wait no longer for a reader, whose curves are drawn or who has left."""
        self._curves.discard(reader)

    def add_map(self, parts: Iterator[None]) -> None:
        """Compute a map; each step of `parts` is a part of it."""
        self._maps.append(parts)
        if not self._going:
            self._go_on()

    def _go_on(self) -> None:
        self._since = self._loop.time()
        if going := bool(self._maps):
            self._loop.call_later(_PAUSE, self._turn)
        self._going = going

    def _turn(self) -> None:
        """Compute the next part of the map that has waited longest, unless curves come first."""
        if self._curves and self._loop.time() - self._since < _LONGEST:
            self._loop.call_later(_PAUSE, self._turn)
            return
        parts = self._maps.popleft()
        try:
            next(parts)
            self._maps.append(parts)
        except StopIteration:
            pass
        finally:
            self._go_on()
