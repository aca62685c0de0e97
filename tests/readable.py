"""What makes a picture readable, checked on the figure: no text over another, lines that differ on a grey print."""

from itertools import combinations

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text


def boxes(figure):
    """Return each text that is seen, with the box of its letters."""
    renderer = FigureCanvasAgg(figure).get_renderer()
    texts = {id(text): text for text in [*figure.texts, figure._suptitle] if text is not None}
    for ax in figure.axes:
        if not ax.axison:
            texts |= {id(text): text for text in [*ax.texts, ax.title]}
            continue
        axis_texts = [ax.title, ax._left_title, ax._right_title, ax.xaxis.label, ax.yaxis.label]
        inside = [tick.label1 for axis in (ax.xaxis, ax.yaxis) for tick in axis._update_ticks()]
        legend = ax.get_legend().get_texts() if ax.get_legend() else []
        texts |= {id(text): text for text in [*ax.texts, *axis_texts, *inside, *legend]}
    for text in texts.values():
        annotates = hasattr(text, "xyann")
        if (
            text.get_text().strip()
            and text.get_visible()
            and not (annotates and not text._check_xy(renderer))
        ):
            yield text, Text.get_window_extent(text, renderer)


def check_texts(figure, least=6):
    """Fail where a text covers another or leaves the figure, and where there are fewer texts than a picture needs."""
    figure.draw_without_rendering()
    found = [(text.get_text(), box) for text, box in boxes(figure)]
    assert len(found) >= least
    for (one, first), (other, second) in combinations(found, 2):
        width = min(first.x1, second.x1) - max(first.x0, second.x0)
        height = min(first.y1, second.y1) - max(first.y0, second.y0)
        assert width < 1.5 or height < 1.5, f"{one!r} over {other!r}"
    for text, box in found:
        assert box.x0 > -1 and box.x1 < figure.bbox.x1 + 1, text
        assert box.y0 > -1 and box.y1 < figure.bbox.y1 + 1, text


def check_lines_differ(figure):
    """Fail where two lines of one axes that have names differ in colour alone."""
    for ax in figure.axes:
        styles = [
            (line.get_marker(), line.get_linestyle(), str(line._dash_pattern))
            for line in ax.lines
            if not line.get_label().startswith("_")
        ]
        assert len(set(styles)) == len(styles), ax.get_title()
