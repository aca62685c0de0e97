"""Types of arrays and numbers in annotations; docstrings give the shapes and units.

The element type is left open: the same code takes real numbers and, for derivatives by a complex step, complex numbers.
"""

from __future__ import annotations

from typing import Any, TypeAlias

from numpy.typing import NDArray

Array: TypeAlias = NDArray[Any]
Numbers: TypeAlias = float | Array  # a number, or an array that broadcasts with the other arguments
