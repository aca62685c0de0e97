"""Chains of elements: the sum of the matrices of elements that follow one another."""

from __future__ import annotations

import numpy as np

from proprotor.typing import Array


def assembled(elements: Array) -> Array:
    """Return the sum of the matrices of a chain of elements.

    Parameters
    ----------
    elements : array (..., k, 2m, 2m)
        Matrices of k elements, on the m motions of the inner and the m motions of the outer end.

    Returns
    -------
    array (..., km + m, km + m)
        On the m motions of the first end, of the second, and so on.
    """
    count, per_end = elements.shape[-3], elements.shape[-1] // 2
    size = per_end * (count + 1)
    total = np.zeros((*elements.shape[:-3], size, size), dtype=elements.dtype)
    for place in range(count):
        own = slice(per_end * place, per_end * (place + 2))
        total[..., own, own] += elements[..., place, :, :]
    return total
