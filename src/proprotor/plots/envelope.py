"""An envelope: equivalent airspeed across, altitude up, the speeds needed, the onset of each condition."""

from __future__ import annotations

from itertools import cycle
from typing import Any

import numpy as np

from proprotor.errors import InputError
from proprotor.model.doubts import marked, reasons_for_doubt
from proprotor.plots.canvas import axes_or_new, grid, note, say_origin, write_headline
from proprotor.plots.style import COLOURS, GREY, in_style
from proprotor.stability.envelope_dataset import with_worst
from proprotor.typing import Array, Axes, Dataset
from proprotor.units import KEAS, KNOT, factor_to_si

_MARKERS = "os^DvP<>X"
_DASHES = ("-", "--", "-.", ":")
_INSIDE = "0.92"  # grey of the speeds at which normal conditions must be free of flutter
_ROOM = 0.08  # of the range of speeds, beyond the last


@in_style
def plot_envelope(found: Dataset, ax: Axes | None = None, *, unit: str = "ft") -> Axes:
    """Draw where each condition of an envelope becomes unstable, and the speeds that it must reach.

    The grey area, V_D with its factor, must stay free of lines with markers; those are the lowest onsets of all rotor
    speeds and powers. A condition without an onset at an altitude has no marker there. Hollow markers are doubtful.

    Parameters
    ----------
    found : xarray.Dataset
        Of `Case.envelope`.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default.
    unit : str
        Unit of the altitude.

    Returns
    -------
    matplotlib.axes.Axes
        The given axes, or the new ones.

    Raises
    ------
    InputError
        For a unit that is no length.
    """
    try:
        factor = factor_to_si(unit, unit, "m")
    except InputError as error:
        raise error.within("unit") from None
    ax = axes_or_new(ax, size=(8, 5))
    altitude = found.altitude.values / factor
    shown = _draw_needed(ax, found, found.height.values / factor)
    lowest = _lowest(found)
    none = []
    names = found.condition.values.tolist()
    styles = zip(names, cycle(_MARKERS), cycle(_DASHES), strict=False)
    for place, (name, marker, dashes) in enumerate(styles):
        # A line that others cover is broader, so that its edges are seen.
        under = 1 - place / max(len(names) - 1, 1)
        speed, doubtful = (part[place] for part in lowest)
        if not np.isfinite(speed).any():
            none.append(name)
            continue
        colour = COLOURS[place % len(COLOURS)]
        ax.plot(
            speed,
            altitude,
            color=colour,
            linestyle=dashes,
            linewidth=1.4 + 2.6 * under,
            marker=marker,
            markersize=5.5 + 3.5 * under,
            label=name,
        )
        hollow: dict[str, Any] = {
            "color": colour,
            "markerfacecolor": "white",
            "markersize": 5.5 + 3.5 * under,
        }
        ax.plot(speed[doubtful], altitude[doubtful], marker, **hollow)
        shown = np.append(shown, speed[np.isfinite(speed)])
    _set_limits(ax, shown, altitude)
    ax.set_xlabel(f"Equivalent airspeed, {KEAS}")
    ax.set_ylabel(f"Pressure altitude ({unit})")
    grid(ax)
    if none:
        note(ax, f"No onset in the search: {'; '.join(none)}")
    ax.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False)
    doubts = reasons_for_doubt(found.warning.values.ravel().tolist())
    write_headline(ax, _worst(found, factor, unit))
    say_origin(ax, found.attrs, [f"Doubtful where markers are hollow: {text}." for text in doubts])
    return ax


def _worst(found: Dataset, factor: float, unit: str) -> str:
    """Return the verdict of the worst case, its margin to the speed required, and which mode has its onset where."""
    place = with_worst(found).attrs["worst_place"]  # of what is drawn, which may be a part of what was found
    here = found.isel(dict(zip(found.verdict.dims, place, strict=True)))
    where = f"{here.condition.item()}, {float(here.altitude) / factor:,.0f} {unit}"
    margin, verdict = float(here.margin), str(here.verdict.item())
    if not np.isfinite([margin, float(here.equivalent_onset)]).all():
        why = f"{here.why.item()} ({where})" if here.why.item() else "no onset in the search"
        return f"{verdict}: {why}"
    onset = marked(f"{float(here.equivalent_onset) / KNOT:.0f}", here.warning.item())
    return f"{verdict}, least margin {_signed(100 * margin)} %: {here['mode'].item()} at {onset} {KEAS} ({where})"


def _signed(value: float) -> str:
    return f"{value:+.0f}".replace("-", "−")


def _draw_needed(ax: Axes, found: Dataset, height: Array) -> Array:
    """Draw V_D and M_D, and the speeds needed of normal conditions and of failures; return these speeds in knots."""
    dive, normal, failure = (
        found.limits.sel(limit=name).values / KNOT for name in ("dive", "normal", "failure")
    )
    with_failures = bool(found.failure.any())
    same = np.allclose(failure, dive)
    ax.fill_betweenx(height, 0, normal, color=_INSIDE, linewidth=0, zorder=0)
    style: dict[str, Any] = {"color": GREY, "zorder": 1.5}
    label = "$V_D$, $M_D$" + (": needed of failures" if with_failures and same else "")
    ax.plot(dive, height, linestyle="-", linewidth=1.0, label=label, **style)
    ax.plot(normal, height, linestyle="-", linewidth=2.6, label="needed of normal conditions", **style)
    if with_failures and not same:
        ax.plot(failure, height, linestyle=(0, (1, 1)), linewidth=1.6, label="needed of failures", **style)
    return np.concatenate([dive, normal])


def _lowest(found: Dataset) -> tuple[Array, Array]:
    """Return the lowest onset (conditions, altitudes) of all rotor speeds and powers, knots; whether it is doubtful."""
    speed = np.nan_to_num(found.equivalent_onset.values / KNOT, nan=np.inf)
    conditions, altitudes = speed.shape[0], speed.shape[-1]
    flat = speed.reshape(conditions, -1, altitudes)
    place = flat.argmin(axis=1)[:, None, :]
    lowest = np.take_along_axis(flat, place, 1)[:, 0]
    doubtful = (found.warning.values != "").reshape(flat.shape)
    of_lowest = np.take_along_axis(doubtful, place, 1)[:, 0]
    return np.where(np.isfinite(lowest), lowest, np.nan), of_lowest & np.isfinite(lowest)


def _set_limits(ax: Axes, shown: Array, altitude: Array) -> None:
    """Set the limits of the axes: all speeds that are shown, and all altitudes."""
    low, high = float(np.nanmin(shown)), float(np.nanmax(shown))
    room = max(_ROOM * (high - low), 0.02 * high)
    ax.set_xlim(max(0.0, low - 3 * room), high + room)
    edge = 0.03 * (altitude[-1] - altitude[0]) or 1.0  # of a single altitude
    ax.set_ylim(altitude[0] - edge, altitude[-1] + edge)
