"""Drawing for a file: no window opens, and no display is needed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from proprotor.typing import Axes, Figure


@contextmanager
def drawn(draw: Callable[[], Axes | Figure]) -> Iterator[tuple[Axes | Figure, Figure]]:
    """Call a function that draws; yield the axes or figure that it returns, and their figure. Close it afterwards.

    What Matplotlib draws with is as before afterwards: a notebook shows its own pictures by something else.
    """
    import matplotlib  # here, because matplotlib takes long to import

    before = matplotlib.get_backend(auto_select=False)
    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure = None
    try:
        plot = draw()
        figure = plot.get_figure(root=True)
        if figure is None:
            raise RuntimeError("axes without a figure")
        yield plot, figure
    finally:
        if figure is not None:
            pyplot.close(figure)
        if before is not None:
            with suppress(ImportError):  # named in the environment, but there is no display for it
                matplotlib.use(before)
