"""Animation of a mode: rotor and wing in motion, as a GIF, as a page for a browser or as a film."""

from __future__ import annotations

import html
import io
import os
import tempfile
import textwrap
from base64 import b64encode
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from proprotor.errors import InputError
from proprotor.files.output import check_place, write_whole
from proprotor.model import stamp
from proprotor.model.doubts import MARK
from proprotor.needs import check_memory
from proprotor.plots.mode_motion import ModeMotion
from proprotor.plots.mode_shape import draw_moving, draw_still, title_of
from proprotor.plots.style import GREY, LABEL_SIZE, SMALL_SIZE
from proprotor.typing import Axes

if TYPE_CHECKING:
    from PIL.Image import Image

_SIZE = (8.0, 4.4)  # inches
_PLACES = {"3d": (0.0, 0.12, 0.49, 0.78), "front": (0.46, 0.09, 0.35, 0.76), "side": (0.82, 0.09, 0.17, 0.76)}
_TITLES = {"3d": "", "front": "from ahead", "side": "from outboard"}
_COLOURS = 32  # colours of the GIF
_CANVAS = 16  # bytes for a pixel while one picture is drawn: the canvas, its background, the colours
_LETTERS = 155  # letters in a line of the small print
_FILM = 8.0  # seconds that a film takes, to whole cycles
# A picture of one cycle after the other; the slider halts at one of them.
_PAGE = """<!DOCTYPE html>
<html lang="en">
<meta charset="utf-8">
<title>{title}</title>
<style>body {{ font-family: sans-serif; text-align: center }} img, input {{ width: min(100%, {width}px) }}</style>
<img id="picture" alt="{title}"><br>
<input id="place" type="range" min="0" max="{last}" value="0" aria-label="picture of the cycle"><br>
<button id="run">halt</button>
<script>
const pictures = [{pictures}];
const [picture, place, run] = ["picture", "place", "run"].map((id) => document.getElementById(id));
let runs = true;
const show = () => {{ picture.src = pictures[place.value]; }};
const keep = (on) => {{ runs = on; run.textContent = on ? "halt" : "run"; }};
run.onclick = () => keep(!runs);
place.oninput = () => {{ keep(false); show(); }};
setInterval(() => {{ if (runs) {{ place.value = (+place.value + 1) % pictures.length; show(); }} }}, {milliseconds});
show();
</script>
</html>
"""


def animate_mode(
    motion: ModeMotion,
    path: str | os.PathLike[str],
    *,
    frames: int = 24,
    frames_per_second: float = 12.0,
    dpi: int = 80,
) -> Path:
    """Write one cycle of a mode, in perspective, from ahead and from the side.

    Parameters
    ----------
    motion : ModeMotion
        Result of `proprotor.plots.mode_motion.mode_motion`.
    path : str or path
        A file that ends in .gif, .html or .mp4. A GIF and a page repeat the cycle forever, and the reader of a page can
        halt at each picture; a film shows the cycle for about 8 s, and needs the program ffmpeg, on the search path or
        where ``matplotlib.rcParams["animation.ffmpeg_path"]`` says.
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
        For another ending, a file that cannot be written, numbers that make no animation, pictures that do not fit into
        memory, and a film without ffmpeg.
    """
    ending = Path(path).suffix.lower()
    if ending not in _WRITERS:
        raise InputError("path", str(path), f"must end in {', '.join(_WRITERS)}")
    check_place(path, ending)
    if frames < 4 or not frames_per_second > 0 or not dpi > 0:
        given = f"{frames} frames, {frames_per_second} per second, {dpi} dpi"
        raise InputError("frames", given, "must be at least 4, at a speed and a size above zero")
    if ending == ".mp4":
        _check_ffmpeg(path)
    picture = _SIZE[0] * _SIZE[1] * float(dpi) ** 2  # pixels
    each = 1 if ending == ".gif" else 3  # bytes for a pixel that is kept
    check_memory(
        "frames", frames, picture * (each * frames + _CANVAS), "the pictures", "take fewer or smaller ones"
    )
    content = _WRITERS[ending](motion, _frames(motion, frames, dpi), frames_per_second)
    write_whole(path, lambda file: file.write(content))
    return Path(path)


def _gif(_: ModeMotion, frames: Iterator[Image], frames_per_second: float) -> bytes:
    from PIL import Image  # here, because PIL takes long to import

    pictures: list[Image.Image] = []
    palette: Image.Image | None = None
    for whole in frames:
        palette = palette or whole.quantize(_COLOURS)  # one for all pictures, so that shades do not flicker
        pictures.append(whole.quantize(palette=palette, dither=Image.Dither.NONE))
    first, *others = pictures
    how: dict[str, Any] = {"append_images": others, "duration": round(1000 / frames_per_second), "loop": 0}
    file = io.BytesIO()
    first.save(file, format="GIF", save_all=True, optimize=True, **how)
    return file.getvalue()


def _page(motion: ModeMotion, frames: Iterator[Image], frames_per_second: float) -> bytes:
    """Return a page that needs nothing but a browser: all pictures are within, with a button and a slider."""
    pictures = []
    for frame in frames:
        width = frame.width
        file = io.BytesIO()
        frame.quantize(_COLOURS).save(file, format="PNG", optimize=True)
        pictures.append(f'"data:image/png;base64,{b64encode(file.getvalue()).decode()}"')
    page = _PAGE.format(
        title=html.escape(f"{motion.case}: {title_of(motion)}"),
        width=width,
        last=len(pictures) - 1,
        pictures=",\n".join(pictures),
        milliseconds=round(1000 / frames_per_second),
    )
    return page.encode()


def _film(_: ModeMotion, frames: Iterator[Image], frames_per_second: float) -> bytes:
    """Return a film in H.264, which every player knows; whole cycles, as many as the shortest film takes."""
    from matplotlib.animation import FFMpegWriter
    from matplotlib.figure import Figure  # both here, because matplotlib takes long to import

    pictures = [np.asarray(frame) for frame in frames]
    height, width, _colours = pictures[0].shape
    figure = Figure(figsize=(width / 100, height / 100), dpi=100)
    shown = figure.figimage(pictures[0])
    cycles = max(1, round(_FILM * frames_per_second / len(pictures)))
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "mode.mp4"
        rate: Any = frames_per_second  # typed as a whole number; ffmpeg takes any
        writer = FFMpegWriter(fps=rate, codec="h264")
        with writer.saving(figure, str(file), 100):
            for picture in pictures * cycles:
                shown.set_data(picture)
                writer.grab_frame()
        return file.read_bytes()


def _check_ffmpeg(path: str | os.PathLike[str]) -> None:
    """Refuse a film where the program that writes it is missing."""
    from matplotlib.animation import FFMpegWriter

    if not FFMpegWriter.isAvailable():
        rule = "needs the program ffmpeg, which is not on the search path; .html and .gif need no program"
        raise InputError("path", str(path), rule)


_Writer = Callable[[ModeMotion, Iterator["Image"], float], bytes]
_WRITERS: dict[str, _Writer] = {".gif": _gif, ".html": _page, ".mp4": _film}


def _frames(motion: ModeMotion, count: int, dpi: int) -> Iterator[Image]:
    """Yield the pictures of one cycle. The trim state is drawn once, and the moving lines over copies of the state."""
    from PIL import Image  # here, because PIL takes long to import

    canvas, axes = _still(motion, dpi)
    background = canvas.copy_from_bbox(canvas.figure.bbox)
    for phase in 2 * np.pi * np.arange(count) / count:
        canvas.restore_region(background)
        for view, ax in axes.items():
            for line in draw_moving(ax, motion, view, float(phase)):
                ax.draw_artist(line)
                line.remove()
        yield Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy())


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
        ax.set_title(_TITLES[view], fontsize=LABEL_SIZE, color="0.3")
    figure.text(
        0.02, 0.975, f"{motion.case}\n{title_of(motion)}", fontsize=LABEL_SIZE + 1, va="top", parse_math=False
    )
    figure.text(
        0.02, 0.02, _small_print(motion), fontsize=SMALL_SIZE, color=GREY, va="bottom", parse_math=False
    )
    canvas.draw()
    return canvas, axes


def _small_print(motion: ModeMotion) -> str:
    """Return the text below the pictures: how the mode is drawn, its case and options, and a doubt about it."""
    drawing = "Blades are shown at azimuths that stand still. Amplitude enlarged and held; grey: trim."
    sketch = " The wing is a sketch in the proportions of the XV-15." if motion.sketched else ""
    doubt = f" {MARK} Doubtful: {motion.warning}." if motion.warning else ""
    origin = textwrap.fill(f"{stamp.line(motion.stamp)}{doubt}", _LETTERS)
    return "\n".join(filter(None, (drawing + sketch, origin)))
