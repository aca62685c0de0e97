"""Spectra of outputs in turbulence."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from proprotor.errors import InputError
from proprotor.plots.canvas import axes_or_new, grid, note, say_origin
from proprotor.plots.input_names import output_name
from proprotor.plots.line_of_sweep import written
from proprotor.plots.style import in_style, line_style
from proprotor.stability import places_of
from proprotor.typing import Axes, Dataset
from proprotor.units import KNOT, KTAS

_SPECTRA = {"von-karman": "von Kármán’s spectrum", "dryden": "Dryden’s spectrum"}
_USUAL = ("force_x", "force_z", "moment_x", "moment_y")


@in_style
def plot_gust_spectra(
    found: Dataset, ax: Axes | None = None, *, outputs: Sequence[str] | None = None
) -> Axes:
    """Draw spectral densities of outputs in turbulence over frequency, each over its variance.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `proprotor.responses.gust_response.gust_response`, at one airspeed.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default.
    outputs : sequence of str, optional
        Names of outputs; at most four loads of the hub by default. The legend has their root mean squares.

    Returns
    -------
    matplotlib.axes.Axes
        The given axes, or the new ones.

    Raises
    ------
    InputError
        For an unknown output, several airspeeds, and a result without numbers.
    """
    if found.rms.ndim != 1:
        raise InputError("found", f"{found.rms.ndim} axes", "must be at one airspeed: found.isel(airspeed=0)")
    if found.reason.item():
        raise InputError("found", None, found.reason.item())
    known = tuple(found.output.values.tolist())
    usual = [name for name in known if name.rpartition(" ")[2] in _USUAL][: len(_USUAL)] or known[
        : len(_USUAL)
    ]
    ax = axes_or_new(ax)
    hertz = found.frequency.values / (2 * np.pi)
    for place, column in enumerate(places_of(outputs or usual, known, "outputs")):
        own = found.isel(output=column)
        rms, unit = float(own.rms), str(own.output_unit.item())
        density = own.psd.values / rms**2 * 2 * np.pi if rms > 0 else np.full(len(hertz), np.nan)
        style = line_style(place) | {"marker": "", "linewidth": 1.6}
        ax.plot(hertz, density, label=f"{output_name(known[column])}, rms {rms:.3g} {written(unit)}", **style)
    ax.set(
        xscale="log", yscale="log", xlabel="Frequency (Hz)", ylabel="Spectral density over variance (1/Hz)"
    )
    grid(ax)
    ax.legend()
    about = found.attrs
    spectrum = _SPECTRA[str(about["spectrum"])]
    what = f"{about['component'].capitalize()} turbulence, {spectrum}, {about['intensity']:g} m/s"
    at = f" at {float(found.airspeed) / KNOT:.4g} {KTAS}" if "airspeed" in found else ""
    note(ax, what + at)
    say_origin(ax, found.attrs, filter(None, [found.warning.item()]))
    return ax
