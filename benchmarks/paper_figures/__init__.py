"""The analytical figures of AIAA-2002-1604, made with this model.

`NUMBERS` lists them, `make_figure` analyses one and `benchmarks.paper_figures.drawing.draw` draws it.
"""

from benchmarks.paper_figures.analyses import Analyses
from benchmarks.paper_figures.catalogue import NUMBERS, decks_with_bands, make_figure
from benchmarks.paper_figures.content import Content, Curve, csv_of

__all__ = ["NUMBERS", "Analyses", "Content", "Curve", "csv_of", "decks_with_bands", "make_figure"]
