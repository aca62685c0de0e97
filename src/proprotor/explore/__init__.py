"""The page of `proprotor explore`: sliders on the inputs of a deck, and at once what they do to the modes.

`analysis` is what each move of a slider costs, `inputs` the sliders, `curves` the data that is drawn, `altered_deck`
what is taken home; `page` puts them together in Bokeh and `server` serves that to this machine alone.
"""
