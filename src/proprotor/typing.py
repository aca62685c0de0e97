"""Names of array types in annotations; shapes and units stand in the docstrings.

The element type is left open: the same code takes real numbers and, for exact derivatives, complex ones.
"""

from __future__ import annotations

from typing import Any, TypeAlias

from numpy.typing import NDArray

Array: TypeAlias = NDArray[Any]
Numbers: TypeAlias = float | Array  # one number, or an array of them that broadcasts with the others
