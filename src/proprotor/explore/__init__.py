"""The page of `proprotor explore`: sliders on the inputs of a deck, and modes that follow the sliders.

In come a case and the settings of a reader; out go curves and sentences on the page, and a deck to keep.

    analysis        the modes of the case with other inputs, fast enough for a slider
    inputs          the sliders: which inputs have one, and the range of each
    curves          the data of the lines that the page draws
    altered_deck    the settings of the page as a deck of its own
    page            the page, put together in Bokeh
    server          a server of the page for this machine alone

This room may import the rooms above it, from `errors` to `plots`. `page` and `server` need Bokeh, an extra that takes
long to import; import them when the page is wanted.
"""

__all__ = ["analysis", "page", "server"]
