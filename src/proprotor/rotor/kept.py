"""Keep the result of a function for as long as the objects live from which it was made.

An analysis asks for the same rotor and the same support at each of its batches of airspeeds.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, ParamSpec, TypeVar
from weakref import ref

import numpy as np

_Given = ParamSpec("_Given")
_Result = TypeVar("_Result")
_BY_VALUE = (str, tuple)


def kept(function: Callable[_Given, _Result]) -> Callable[_Given, _Result]:
    """Return a function that is evaluated once for the same objects; its results are not to be written to.

    Texts and tuples are the same by value, all others by identity. With the first of its objects a result is forgotten,
    so that nothing is kept that could be asked for no more. Nothing is kept for an array that can be written to, or for
    an object given by name.

    Parameters
    ----------
    function : callable
        Takes records that never change, arrays, texts and tuples of texts. The result must not hold one of these
        records or arrays, which would then live for ever.
    """
    found: dict[tuple[Any, ...], tuple[list[ref[Any]], _Result]] = {}

    @wraps(function)
    def once(*given: _Given.args, **named: _Given.kwargs) -> _Result:
        if named:
            return function(*given, **named)
        key = tuple([one if isinstance(one, _BY_VALUE) else id(one) for one in given])
        if (known := found.get(key)) is not None:
            return known[1]
        result = function(*given, **named)
        objects = [one for one in given if not isinstance(one, _BY_VALUE)]
        if not any(isinstance(one, np.ndarray) and one.flags.writeable for one in objects):
            found[key] = [ref(one, lambda _: found.pop(key, None)) for one in objects], result
        return result

    return once
