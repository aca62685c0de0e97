"""The page of a case in a notebook: a frame on a server in the kernel."""

from __future__ import annotations

import asyncio
import secrets
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from proprotor.case import Case, load_case
from proprotor.deck.vary import added_loops, varied_numbers
from proprotor.errors import InputError
from proprotor.model.stamp import one_density
from proprotor.needs import need
from proprotor.rotor.options import CHOICES, parse_options
from proprotor.stability.boundaries import scan_speeds
from proprotor.units import in_metres_per_second

if TYPE_CHECKING:
    from proprotor.explore.page import ExplorePage
    from proprotor.explore.turns import Turns

_POINTS = 60  # airspeeds by default
_HEIGHT = 920  # pixels


class _Explorer:
    """The page of a case in a notebook; the last expression of a cell shows it.

    Attributes
    ----------
    address : str
        Of the page, for this machine alone. Whoever knows the address can open it, and nobody can guess it.
    """

    def __init__(self, page: Any, first: Case) -> None:
        from tornado.ioloop import IOLoop  # here, because only a page needs it

        from proprotor.explore.server import ADDRESS, listen, started

        self._first, self._page = first, page
        self._shown: ExplorePage | None = None
        opened, place = listen(0), secrets.token_urlsafe(24)
        self.address = f"http://{ADDRESS}:{opened.getsockname()[1]}/{place}"
        self._server = started(self._put_on, opened, IOLoop.current(), place)

    def _put_on(self, document: Any, turns: Turns) -> None:
        self._shown = self._page()
        self._shown.put_on(document, turns)

    @property
    def case(self) -> Case:
        """The case with the settings of the page that was opened last."""
        return self._first if self._shown is None else self._shown.chosen.varied

    @property
    def options(self) -> dict[str, Any]:
        """The options of the model, as the page that was opened last has them."""
        return {} if self._shown is None else dict(self._shown.chosen.options)

    def stop(self) -> None:
        """End the server; a page that is open does not answer any more."""
        self._server.stop()

    def _repr_html_(self) -> str:
        """Return the page in a frame."""
        title = escape(f"Explore {self._first.title or self._first.name}")
        style = "width:100%;border:1px solid #ccc"
        return f'<iframe src="{self.address}" title="{title}" height="{_HEIGHT}" style="{style}"></iframe>'

    def __repr__(self) -> str:
        return f"Explorer of {self._first.name} at {self.address}"


def explore(case: Case, airspeed: Any = None, **options: Any) -> _Explorer:
    """Return a page with sliders on the inputs of a case, which a notebook shows below the cell.

    The page is that of `proprotor explore`. It is served by the kernel, to the machine of the kernel alone, and answers
    between cells. Needs the extra `explore`.

    Parameters
    ----------
    case : Case
        From a deck. What `Case.vary` has changed stands at its value, and counts as changed from the deck.
    airspeed : array (points,) in m/s, text such as "100:400:5kt", or pint quantity
        Airspeeds to draw; by default 60 from 0.2 to 1.2 of the tip speed.
    **options
        See `proprotor.rotor.options.Options`. Compiled functions are taken where there is a C compiler, unless
        `backend` says otherwise.

    Returns
    -------
    object
        Shows the page in a notebook; `address` is that of the page. `case` and `options` are the case and the options
        with what was set on the page, and `stop()` ends the server.

    Raises
    ------
    InputError
        For a case that is not from a deck, or has control loops that are not, airspeeds that are no range, unusable
        options, without the packages of the extra, and outside a notebook.
    """
    need("bokeh", "explore", "the page", "explore")
    need("tornado", "explore", "the page", "explore")
    _check_runs_in_notebook()
    if case.deck is None:
        raise InputError("case", case.name, "must be from a deck: its numbers are what the sliders set")
    if added_loops(case):
        raise InputError(
            "case", case.name, "must have its control loops in the deck, which is what the page shows"
        )
    base, settings = case.deck.origin
    deck = load_case(base, settings)
    drawn = _airspeeds(case, airspeed)
    choice = parse_options(deck.model_options({"backend": "auto"} | options))
    in_force = {name: getattr(choice, name) for name in (*CHOICES, *options)}
    values = {path: float(value) for path, value in varied_numbers(case).items()}

    def page() -> ExplorePage:
        from proprotor.explore.page import ExplorePage  # here, because bokeh takes long to import

        made = ExplorePage(deck, base, drawn, settings, in_force)
        made.inputs.set_values(values)
        return made

    page()  # an unusable input ends here, before anything is served
    return _Explorer(page, case)


def _check_runs_in_notebook() -> None:
    """Refuse where no event loop runs that could answer the page."""
    try:
        asyncio.get_running_loop()
    except RuntimeError:
        raise InputError(
            "explore", None, "needs a notebook; in a terminal `proprotor explore my.toml` opens the page"
        ) from None


def _airspeeds(case: Case, airspeed: Any) -> Any:
    """Return the airspeeds to draw, m/s."""
    if airspeed is None:
        return scan_speeds(case, _POINTS)
    given = np.unique(in_metres_per_second(airspeed, one_density(case)))
    if len(given) < 2:
        raise InputError("airspeed", airspeed, "must be a range of airspeeds")
    return given
