"""Keep the result of a function for as long as the objects live from which it was made.

An analysis asks for the same rotor and the same support at each of its batches of airspeeds.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, ParamSpec, TypeVar
from weakref import ref

_Given = ParamSpec("_Given")
_Result = TypeVar("_Result")


def kept(function: Callable[_Given, _Result]) -> Callable[_Given, _Result]:
    """Return a function that is evaluated once for the same objects; its results are not to be written to.

    Objects are the same by identity. With the first of its objects a result is forgotten, so that nothing is kept that
    could be asked for no more.

    Parameters
    ----------
    function : callable
        Takes objects that never change and that weak references can point to, such as records and arrays. The result
        must not hold one of these objects, which would then live for ever. Objects given by name are not looked up.
    """
    found: dict[tuple[int, ...], tuple[tuple[ref[Any], ...], _Result]] = {}

    @wraps(function)
    def once(*objects: _Given.args, **named: _Given.kwargs) -> _Result:
        if named:
            return function(*objects, **named)
        key = tuple(map(id, objects))
        if (known := found.get(key)) is not None:
            return known[1]
        result = function(*objects, **named)
        found[key] = tuple(ref(one, lambda _: found.pop(key, None)) for one in objects), result
        return result

    return once
