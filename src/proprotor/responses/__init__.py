"""Responses of a linear model over time and to the air: to inputs as they run, to turbulence and to single gusts.

In come linear models with inputs, the motion of the swashplate and the gusts at the rotor; out come datasets of
outputs, hub loads and hub motion among them.

    time_response       outputs over time for inputs that run linearly between samples, exact at the samples
    turbulence          spectra of von Kármán and Dryden, their scales, and the filter of Dryden's
    gust_response       spectra and root mean squares of outputs in turbulence
    spectral_integral   integrals over all frequencies of what has resonances
    design_gusts        sizes of design gusts and of design turbulence by 14 CFR 25.341
    discrete_gust       outputs in gusts of one minus the cosine

Gusts act on the rotor alone, evenly over its disk. The room may import the rooms above it, from `errors` to
`stability`.
"""

from proprotor.responses.design_gusts import design_gust, design_turbulence
from proprotor.responses.discrete_gust import discrete_gust
from proprotor.responses.gust_response import gust_response
from proprotor.responses.time_response import time_response
from proprotor.responses.turbulence import COMPONENTS, SPECTRA, Turbulence, dryden_filter

__all__ = [
    "COMPONENTS",
    "SPECTRA",
    "Turbulence",
    "design_gust",
    "design_turbulence",
    "discrete_gust",
    "dryden_filter",
    "gust_response",
    "time_response",
]
