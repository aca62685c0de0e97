"""The page of `proprotor explore`: sliders on the inputs of a deck, and modes and a map that follow the sliders.

In come a case and the settings of a reader; out go curves and sentences on the page, and files to keep.

    analysis        the modes of the case with other inputs, fast enough for a slider
    growth_plane    the stability of the case over two inputs, a few points at a time
    inputs          the sliders and the axes of the map: which inputs have one, and the range of each
    curves          the data of the lines that the page draws
    drawings        the plots, in Bokeh
    chosen          what a reader has set
    controls        sliders and selections, in Bokeh
    input_panel     the controls of inputs and airspeeds
    live_map        the stability map with its controls, computed in parts
    save_panel      the buttons that save files
    words           what the page says
    post            what changes with each move, sent as one message
    altered_deck    the settings of the page as a deck of its own
    saves           numbers and pictures to keep
    turns           the order of what readers wait for: curves before maps
    page            the page, put together
    server          a server of the page for this machine alone
    notebook        the page in a notebook

`download.js`, `names.js`, `post.js` and `quick.js` run in the browser: they save a file, name sliders and plots for
screen readers, show what a post brings, and spare Bokeh what it does at each paint for nothing. This room may import
the rooms above it, from `errors` to `plots`. What is in Bokeh, `page` and `server` need an extra that takes long to
import; import them when the page is wanted.
"""

__all__ = ["analysis", "explore", "page", "server", "turns"]
