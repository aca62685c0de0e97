"""Files to keep of what the page shows: numbers of the curves and of the map, and pictures for print."""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from typing import Any

from proprotor.case import Case
from proprotor.explore.inputs import MapAxis
from proprotor.model.provenance import reservations
from proprotor.plots import plot_root_locus, plot_stability_map, plot_sweep, rests_on
from proprotor.plots.headless import drawn
from proprotor.tables.sweep_table import SweepTable, heading
from proprotor.typing import Array, Axes, Figure

PICTURES = {"png": "image/png", "svg": "image/svg+xml"}  # media types by kind of file


def curves_csv(case: Case, airspeeds: Array, options: Mapping[str, Any]) -> bytes:
    """Return the curves as CSV, as `proprotor sweep --csv` writes them."""
    return SweepTable(case.sweep(airspeeds, **options), case.operation.rotor_speed, "ktas").csv()


def curves_picture(
    case: Case, airspeeds: Array, options: Mapping[str, Any], changed: str, form: str
) -> bytes:
    """Return a picture of frequency and damping, in a form of `PICTURES`; `changed` says what differs from the deck."""
    found = case.sweep(airspeeds, **options)
    footer = " ".join(filter(None, (changed, *reservations(case))))
    return _picture(
        lambda: plot_sweep(
            found, rotor_speed=case.operation.rotor_speed, unit="ktas", title=heading(case), footer=footer
        ),
        form,
    )


def root_locus_picture(
    case: Case, airspeeds: Array, options: Mapping[str, Any], changed: str, form: str
) -> bytes:
    """Return a picture of the root locus; arguments as of `curves_picture`."""
    found, speed = case.sweep(airspeeds, **options), float(case.operation.rotor_speed)
    return _picture(
        lambda: rests_on(
            plot_root_locus(found, rotor_speed=speed, unit="ktas"), case, *_sentences(case, changed)
        ),
        form,
    )


def map_picture(
    case: Case,
    axes: tuple[MapAxis, MapAxis],
    airspeed: float | None,
    options: Mapping[str, Any],
    changed: str,
    form: str,
) -> bytes:
    """Return a picture of the stability map with its exact boundary; `airspeed` where it is none of the axes, m/s."""
    found = case.stability_map({axis.path: axis.values for axis in axes}, airspeed=airspeed, **options)
    return _picture(lambda: rests_on(plot_stability_map(found), case, *_sentences(case, changed)), form)


def _sentences(case: Case, changed: str) -> list[str]:
    return [f"{heading(case)}.", *([changed] if changed else [])]


def _picture(draw: Callable[[], Axes | Figure], form: str) -> bytes:
    content = io.BytesIO()
    with drawn(draw) as (_, figure):
        figure.savefig(content, format=form, dpi=160, bbox_inches="tight")
    return content.getvalue()
