"""Which combinations of inputs the points do not tell, from the singular values of the weighted derivatives.

Columns are scaled by the size of each input, so that a singular value is the number of standard errors by which the
points move when the inputs change by as much as themselves in that direction: its inverse is the relative standard
error of the combination.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from proprotor.typing import Array

_TOLD = 1.0  # standard errors: a combination that moves the points by less for a change of its own size is not told
_PART = 0.2  # of the unit vector of a combination: what is worth a name
_SINGULAR = 1e-12  # of the largest singular value


class Directions(NamedTuple):
    """Singular values (k,), and unit vectors (k, inputs) in relative changes of the inputs, largest value first."""

    values: Array
    vectors: Array


def directions(jacobian: Array, size: Array) -> Directions:
    """Return the directions of the inputs in the order in which points tell them.

    Parameters
    ----------
    jacobian : array (targets, inputs)
        Derivatives of the targets over their errors, per SI unit of the inputs.
    size : array (inputs,)
        SI.
    """
    _, values, vectors = np.linalg.svd(jacobian * size)
    return Directions(np.pad(values, (0, len(size) - len(values))), vectors)


def covariance(found: Directions, size: Array) -> Array:
    """Return the covariance (inputs, inputs), SI; infinite variances are those of directions without any effect."""
    values = np.maximum(found.values, _SINGULAR * found.values.max())
    scaled = found.vectors.T / values**2 @ found.vectors
    return np.asarray(scaled * size * size[:, None])


def not_told(found: Directions, paths: Sequence[str]) -> list[str]:
    """Return a sentence for each combination of inputs that the points do not tell."""
    sentences = []
    for value, vector in zip(found.values, found.vectors, strict=True):
        if value < _TOLD:
            signed = vector * np.sign(vector[np.argmax(np.abs(vector))])
            parts = [
                f"{share:+.2f} {path}"
                for share, path in zip(signed, paths, strict=True)
                if abs(share) > _PART
            ]
            inverse = f"{1 / value:.0%}" if value > 1e-4 else "more than 10000 %"
            what = "" if len(parts) == 1 else " together (relative changes)"
            sentences.append(f"the points do not tell {', '.join(parts)}{what}: standard error {inverse}")
    return sentences
