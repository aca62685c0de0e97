"""What the page says, as HTML: the flutter speed, what differs from the deck, doubts, failures, names of the lines."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from typing import Any

import numpy as np

from proprotor.explore.analysis import LiveModes
from proprotor.explore.growth_plane import GrowthPlane
from proprotor.explore.inputs import SliderInput
from proprotor.model.doubts import MARK, doubtful_near, doubts_along, footnotes, marked, reasons_for_doubt
from proprotor.units import KNOT, KTAS

HELP = """<p>Move a slider, or focus it (Tab) and press the arrow keys. <b>Reset</b> brings the
deck's own values back. What <b>Save</b> has: your settings as a TOML file that alters the deck, the numbers of the
curves, and pictures.</p>
<p>Damping below zero is unstable. In the root locus each root moves towards its dot, which is at the highest airspeed.
Broad lines are modes of the support and modes that become unstable; thin grey lines are those of the deck. The flutter
speed and the boundary of the map are interpolated between the points analysed; <code>proprotor flutter</code> and
<code>proprotor map</code> find them to rounding. The cross on the map is where the settings are; with airspeed on an
axis, at the flutter speed.</p>"""
_DASHES = {"solid": "", "dashed": "6 3", "dotted": "2 2"}


def alert(text: str) -> str:
    """Return a message that screen readers read at once."""
    style = "border-left:6px double #b34700;background:#fdf3ec;padding:4px 10px;margin:0"
    return f'<p role="alert" style="{style}"><b>Cannot be:</b> {escape(text)}</p>'


def readout(found: LiveModes, values: Mapping[str, float], inputs: Mapping[str, SliderInput]) -> str:
    """Return the flutter speed and the changed inputs."""
    low, high = (f"{speed / KNOT:.4g}" for speed in found.airspeed[[0, -1]])
    onset = found.flutter
    if not np.any(found.reason == ""):
        verdict = "No airspeed could be analysed."
    elif onset is None:
        verdict = f"No mode becomes unstable between {low} and {high} KTAS."
    else:
        speed = marked(f"{onset.start / KNOT:.1f}", doubtful_near(found.airspeed, found.warning, onset.start))
        verdict = f"Flutter speed {speed} KTAS ({escape(onset.mode)}), interpolated."
    if already := [one.mode for one in found.unstable if one.open_start]:
        verdict += f" Already unstable at {low} KTAS: {escape(', '.join(already))}."
    set_to = f"Changed: {changes}" if (changes := changed(values, inputs)) else "All inputs as in the deck."
    return f'<div><b style="font-size:16px">{verdict}</b><br>{escape(set_to)}</div>'


def changed(values: Mapping[str, float], inputs: Mapping[str, SliderInput]) -> str:
    """Return the inputs that differ from the deck, as plain text."""
    given = ((inputs[path], value) for path, value in values.items())
    return "; ".join(
        f"{one.name} {value / one.factor:.4g} {one.unit} (deck {one.value:.4g})" for one, value in given
    )


def messages(found: LiveModes) -> str:
    """Return the reasons why points failed or are doubtful."""
    lines = []
    for text in dict.fromkeys(found.reason[found.reason != ""].tolist()):
        at = found.airspeed[found.reason == text] / KNOT
        lines.append(f"Not analysed at {len(at)} airspeeds, {at[0]:.4g} to {at[-1]:.4g} KTAS: {text}.")
    lines += [f"{MARK} {line}" for line in footnotes(doubts_along(found.airspeed, found.warning), KTAS, KNOT)]
    return _paragraphs(lines)


def map_messages(plane: GrowthPlane) -> str:
    """Return the reasons why points of the map failed or are doubtful."""
    lines = [
        f"Map: not analysed at {len(places)} of {plane.reason.size} points (grey): {text}."
        for text, places in reasons_for_doubt(plane.reason.ravel().tolist()).items()
    ]
    lines += [
        f"{MARK} Map: doubtful at {len(places)} of {plane.warning.size} points: {text}."
        for text, places in reasons_for_doubt(plane.warning.ravel().tolist()).items()
    ]
    return _paragraphs(lines)


def legend(columns: Mapping[str, list[Any]], compared: bool) -> str:
    """Return a sample of each line with the name of its mode."""
    kinds = zip(columns["mode"], columns["colour"], columns["dash"], columns["width"], strict=True)
    rows = [_sample(name, colour, _DASHES[dash], width) for name, colour, dash, width in kinds]
    if compared:
        rows.append(_sample("the deck", "#8c8c8c", "", 1))
    style = "display:flex;flex-wrap:wrap;gap:2px 14px;margin:0;padding:0;list-style:none;font-size:11px"
    return f'<ul aria-label="Lines" style="{style}">{"".join(rows)}</ul>'


def table(found: LiveModes, rotor_speed: float) -> str:
    """Return the least damping of each mode, the airspeed of it and the frequency there, as a table."""
    rows = []
    for name, damping, root in zip(found.names, found.damping.T, found.eigenvalue.T, strict=True):
        if not np.isfinite(damping).any():
            continue
        place = int(np.nanargmin(damping))
        least = marked(f"{damping[place]:.2f}", found.warning[place])
        numbers = (least, f"{found.airspeed[place] / KNOT:.4g}", f"{abs(root[place].imag) / rotor_speed:.3f}")
        cells = "".join(f'<td style="text-align:right;padding:0 8px">{one}</td>' for one in numbers)
        rows.append(f'<tr><th scope="row" style="text-align:left">{escape(name)}</th>{cells}</tr>')
    heads = "".join(f'<th scope="col">{head}</th>' for head in ("mode", "least damping, %", KTAS, "per rev"))
    return f"<table><thead><tr>{heads}</tr></thead><tbody>{''.join(rows)}</tbody></table>"


def _sample(name: str, colour: str, dashes: str, width: float) -> str:
    line = f'<line x1="0" y1="5" x2="26" y2="5" stroke="{colour}" stroke-width="{width}" stroke-dasharray="{dashes}"/>'
    return f'<li><svg width="26" height="10" aria-hidden="true">{line}</svg> {escape(name)}</li>'


def _paragraphs(lines: list[str]) -> str:
    return "".join(f"<p>{escape(line)}</p>" for line in lines)
