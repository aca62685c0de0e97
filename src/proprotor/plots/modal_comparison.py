"""Measured modes beside those of a model: the modal assurance criterion of all pairs."""

from __future__ import annotations

import numpy as np

from proprotor.plots.canvas import axes_or_new, note, say_origin
from proprotor.plots.style import LABEL_SIZE, in_style
from proprotor.typing import Axes, Dataset

_DARK = 0.6  # of the criterion: from here on numbers are white


@in_style
def plot_mac(found: Dataset, ax: Axes | None = None) -> Axes:
    """Draw the modal assurance criterion of measured modes and modes of a model, with a frame around each pair.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `proprotor.calibration.modal_comparison.compare_modes`.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes
        The given axes, or the new ones.
    """
    mac = found.mac.values
    rows, columns = mac.shape
    ax = axes_or_new(ax, size=(2.5 + 0.9 * columns, 1.8 + 0.55 * rows))
    ax.imshow(mac, cmap="Greys", vmin=0, vmax=1, aspect="auto")
    for row, column in np.ndindex(mac.shape):
        colour = "white" if mac[row, column] > _DARK else "black"
        ax.text(
            column,
            row,
            f"{mac[row, column]:.2f}",
            ha="center",
            va="center",
            fontsize=LABEL_SIZE,
            color=colour,
        )
    names = found.model.values.tolist()
    for row, pair in enumerate(found.pair.values.tolist()):
        if pair:
            across = [names.index(pair) + side for side in (-0.5, 0.5, 0.5, -0.5, -0.5)]
            ax.plot(
                across, [row + side for side in (-0.5, -0.5, 0.5, 0.5, -0.5)], color="#D55E00", linewidth=2
            )
    hertz = found.frequency_of_model.values / (2 * np.pi)
    ax.set_xticks(
        range(columns), [f"{n}\n{f:.3g} Hz" for n, f in zip(names, hertz, strict=True)], fontsize=LABEL_SIZE
    )
    own = [
        f"{name}, {frequency / (2 * np.pi):.3g} Hz, {round(100 * misfit, 1) + 0.0:+.1f} %"
        for name, frequency, misfit in zip(
            found.measured.values.tolist(),
            found.measured_frequency.values,
            found.frequency_misfit.values,
            strict=True,
        )
    ]
    ax.set_yticks(range(rows), own, fontsize=LABEL_SIZE)
    ax.set(xlabel="Modes of the model", ylabel="Measured modes")
    note(
        ax, "Numbers: modal assurance criterion; frames: pairs; percent: how far the model's frequency is off"
    )
    say_origin(ax, found.attrs)
    return ax
