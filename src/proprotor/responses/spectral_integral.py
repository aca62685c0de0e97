"""Integrals from zero to infinity over the frequency, of functions with resonances.

Roots near the axis of frequencies make a function change fast near their frequency. Panels between breakpoints at
distances that double from each root keep every root as far from a panel as the panel is long, so that Gauss's
quadrature converges fast in each. Beyond the last breakpoint the frequency is ω_end / v³, which makes a smooth
function of v from powers of ω^(-1/3), those of turbulence.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from proprotor.typing import Array

_NODES = 10  # of a panel
_TAIL_NODES = 40
_BEYOND = 8.0  # times the largest root: where the tail begins


class _Rule(NamedTuple):
    """Frequencies (k,), rad/s, and weights (k,) of values there whose sum is the integral."""

    frequency: Array
    weight: Array


def rule_for(roots: Array) -> _Rule:
    """Return a rule for functions of the frequency whose singularities in the plane of s are roots (k,), rad/s."""
    size = np.abs(roots)
    roots = roots[np.isfinite(size) & (size > 0)]
    size = np.abs(roots)
    end, smallest = _BEYOND * float(size.max()), float(size.min())
    edges = [np.array([0.0, end]), smallest * 2.0 ** np.arange(-2, np.log2(end / smallest))]
    for root in roots:
        distance = max(abs(root.real), 1e-9 * end)
        steps = distance * 2.0 ** np.arange(-1, np.log2(2 * end / distance) + 1)
        edges.append(np.concatenate([abs(root.imag) + steps, abs(root.imag) - steps, [abs(root.imag)]]))
    inside = np.unique(np.concatenate(edges))
    inside = inside[(inside >= 0) & (inside <= end)]
    inside = inside[np.concatenate([[True], np.diff(inside) > 1e-12 * end])]
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    half = np.diff(inside)[:, None] / 2
    panels = (inside[:-1, None] + half * (nodes + 1)).ravel(), (half * weights).ravel()
    nodes, weights = np.polynomial.legendre.leggauss(_TAIL_NODES)
    v = (nodes + 1) / 2
    tail = end / v**3, weights / 2 * 3 * end / v**4
    return _Rule(*(np.concatenate(pair) for pair in zip(panels, tail, strict=True)))
