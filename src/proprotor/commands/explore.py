"""The command `proprotor explore`: a page on this machine with sliders on the inputs."""

from __future__ import annotations

import webbrowser
from typing import TYPE_CHECKING

import click
import numpy as np
from click.core import ParameterSource

from proprotor.commands import arguments, output
from proprotor.commands.waiting import waiting
from proprotor.errors import InputError
from proprotor.needs import need
from proprotor.stability.boundaries import scan_speeds
from proprotor.units import speeds

if TYPE_CHECKING:
    from bokeh.document import Document

    from proprotor.explore.turns import Turns

_POINTS = 60  # airspeeds by default


@arguments.command()
@arguments.case_argument
@arguments.range_option(
    'Airspeeds to draw: "100:400:5kt"; by default 60 airspeeds from 0.2 to 1.2 of the tip speed.'
)
@click.option(
    "--port",
    type=click.IntRange(0, 65535),
    default=5006,
    show_default=True,
    help="Port of the page on this machine; 0 takes a free port.",
)
@click.option("--no-browser", is_flag=True, help="Print the address, and open no browser.")
@output.json_option
@arguments.model_options
def explore(
    request: arguments.Request, speed: str | None, port: int, no_browser: bool, as_json: bool
) -> None:
    """Open a page with sliders on the inputs of a deck; modes and a stability map follow the sliders.

    CASE is a bundled case or a TOML file. The file stays as it is; the page saves your settings as a new deck. Only
    this machine can open the page, and Ctrl+C ends it. Without --backend the page takes compiled functions where there
    is a C compiler, because the map then follows a slider at once. The command needs the extra `explore`: pip install
    "proprotor[explore]".

    \b
    Examples:
      proprotor explore xv15
      proprotor explore my.toml --speed 100:350:5kt --pitch coupling
      proprotor explore my.toml --port 0 --no-browser
    """
    need("bokeh", "explore", "the page", "explore")
    need("tornado", "explore", "the page", "explore")
    case = request.load()
    chosen = dict(request.options)
    if click.get_current_context().get_parameter_source("backend") is ParameterSource.DEFAULT:
        chosen["backend"] = "auto"
    airspeeds = None if speed is None else np.unique(speeds(speed, "--speed", case.operation.density))
    if airspeeds is not None and len(airspeeds) < 2:
        raise InputError("--speed", speed, "must be a range of airspeeds")
    with waiting("Making the page"):
        # Here, because bokeh takes long to import and may not be installed.
        from proprotor.explore.analysis import live_modes
        from proprotor.explore.page import ExplorePage
        from proprotor.explore.server import ADDRESS, listen, serve

        drawn = scan_speeds(case, _POINTS) if airspeeds is None else airspeeds
        live_modes(case, drawn, **chosen)  # an unusable input ends here, before anything is served
    try:
        opened = listen(port)
    except OSError as error:
        reason = error.strerror or error
        raise click.ClickException(f"--port = {port}: cannot listen on {ADDRESS} ({reason})") from None

    def put_on(document: Document, turns: Turns) -> None:
        options = output.options_in_force(case, chosen)
        ExplorePage(case, request.name, drawn, request.settings, options).put_on(document, turns)

    def ready(address: str) -> None:
        if as_json:
            output.print_json(output.about(case, request) | {"address": address})
        else:
            click.echo(f"{address}  (Ctrl+C ends it)")
        if not no_browser:
            webbrowser.open(address)

    serve(put_on, opened, ready)
