"""Animation of a mode: rotor and wing in motion, as a GIF."""

from __future__ import annotations

import os
import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from proprotor.errors import InputError
from proprotor.files.output import check_place, write_whole
from proprotor.model import stamp
from proprotor.model.doubts import MARK, marked
from proprotor.needs import check_memory
from proprotor.plots.mode_motion import ModeMotion
from proprotor.plots.mode_shape import draw_moving, draw_still
from proprotor.typing import Axes
from proprotor.units import KNOT, KTAS

if TYPE_CHECKING:
    from PIL.Image import Image

_SIZE = (8.0, 4.4)  # inches
_PLACES = {"3d": (0.0, 0.03, 0.49, 0.87), "front": (0.46, 0.09, 0.35, 0.76), "side": (0.82, 0.09, 0.17, 0.76)}
_TITLES = {"3d": "", "front": "from ahead", "side": "from outboard"}
_COLOURS = 32  # colours of the GIF
_CANVAS = 16  # bytes for a pixel while one picture is drawn: the canvas, its background, the colours
_LETTERS = 170  # letters in a line of the small print


def animate_mode(
    motion: ModeMotion,
    path: str | os.PathLike[str],
    *,
    frames: int = 24,
    frames_per_second: float = 12.0,
    dpi: int = 80,
) -> Path:
    """Write one cycle of a mode as a GIF that repeats forever, in perspective, from ahead and from the side.

    Parameters
    ----------
    motion : ModeMotion
        Result of `proprotor.plots.mode_motion.mode_motion`.
    path : str or path
        A file that ends in .gif.
    frames : int
        Number of pictures of one cycle, at least 4.
    frames_per_second : float
        Frames in 1 s; the title gives the true frequency.
    dpi : int
        Dots per inch of the pictures, which are 8 by 4.4 inches large.

    Returns
    -------
    pathlib.Path
        The file. The amplitude is the same throughout: neither growth nor decay is shown.

    Raises
    ------
    InputError
        For another ending, a file that cannot be written, numbers that make no animation, or pictures that do not fit
        into memory.
    """
    check_place(path, ".gif")
    if frames < 4 or not frames_per_second > 0 or not dpi > 0:
        given = f"{frames} frames, {frames_per_second} per second, {dpi} dpi"
        raise InputError("frames", given, "must be at least 4, at a speed and a size above zero")
    picture = _SIZE[0] * _SIZE[1] * float(dpi) ** 2  # pixels
    check_memory("frames", frames, picture * (frames + _CANVAS), "the pictures", "take fewer or smaller ones")
    first, *others = _frames(motion, frames, dpi)
    milliseconds = round(1000 / frames_per_second)
    how: dict[str, Any] = {"append_images": others, "duration": milliseconds, "loop": 0, "optimize": True}
    write_whole(path, lambda file: first.save(file, format="GIF", save_all=True, **how))
    return Path(path)


def title_of(motion: ModeMotion) -> str:
    """Return the title of a mode: its name, airspeed, frequency and damping.

    Parameters
    ----------
    motion : ModeMotion

    Returns
    -------
    str
    """
    value = motion.eigenvalue
    per_rev = f", {value.imag / motion.rotor_speed:.2f}/rev" if motion.rotor_speed else ""
    damping = -100 * value.real / abs(value)
    hertz = value.imag / (2 * np.pi)
    return (
        f"{motion.mode} at {marked(f'{motion.airspeed / KNOT:.0f}', motion.warning)} {KTAS}: {hertz:.2f} Hz{per_rev}, "
        f"damping {damping:.2f} % of critical"
    )


def _frames(motion: ModeMotion, count: int, dpi: int) -> list[Image]:
    """Return the pictures of one cycle. The trim state is drawn once, and the moving lines over copies of the state."""
    from PIL import Image  # here, because PIL takes long to import

    canvas, axes = _still(motion, dpi)
    background = canvas.copy_from_bbox(canvas.figure.bbox)
    pictures: list[Image.Image] = []
    palette: Image.Image | None = None
    for phase in 2 * np.pi * np.arange(count) / count:
        canvas.restore_region(background)
        for view, ax in axes.items():
            for line in draw_moving(ax, motion, view, float(phase)):
                ax.draw_artist(line)
                line.remove()
        whole = Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy())
        palette = palette or whole.quantize(_COLOURS)  # one for all pictures, so that shades do not flicker
        pictures.append(whole.quantize(palette=palette, dither=Image.Dither.NONE))
    return pictures


def _still(motion: ModeMotion, dpi: int) -> tuple[Any, dict[str, Axes]]:
    """Return the canvas of a figure with titles and the trim state, and its axes by view.

    Matplotlib does not type the methods of the canvas.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure  # both here, because matplotlib takes long to import

    figure = Figure(figsize=_SIZE, dpi=dpi)
    canvas: Any = FigureCanvasAgg(figure)
    axes: dict[str, Axes] = {}
    for view, place in _PLACES.items():
        axes[view] = ax = figure.add_axes(place, projection="3d" if view == "3d" else None)
        draw_still(ax, motion, view)
        ax.set_axis_off()
        ax.set_title(_TITLES[view], fontsize=8, color="0.3")
    figure.text(0.02, 0.975, f"{motion.case}\n{title_of(motion)}", fontsize=9, va="top", parse_math=False)
    figure.text(0.02, 0.02, _small_print(motion), fontsize=6.5, color="0.35", va="bottom", parse_math=False)
    canvas.draw()
    return canvas, axes


def _small_print(motion: ModeMotion) -> str:
    """Return the text below the pictures: how the mode is drawn, its case and options, and a doubt about it."""
    drawing = "Blades are shown at azimuths that stand still. Amplitude enlarged and held; grey: trim."
    sketch = " The wing is a sketch in the proportions of the XV-15." if motion.sketched else ""
    doubt = f" {MARK} Doubtful: {motion.warning}." if motion.warning else ""
    origin = textwrap.fill(f"{stamp.line(motion.stamp)}{doubt}", _LETTERS)
    return "\n".join(filter(None, (drawing + sketch, origin)))
