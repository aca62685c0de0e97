"""Types of arrays and numbers in annotations; docstrings give the shapes and units.

The element type is left open: the same code takes real numbers and, for derivatives by a complex step, complex numbers.
Types of packages that are slow to import have their names here, so that an annotation loads none of these packages.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

from numpy.typing import NDArray

__all__ = ["Array", "Axes", "DataArray", "Dataset", "Figure", "Line2D", "Numbers"]

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    from xarray import DataArray, Dataset
else:
    Axes = Figure = Line2D = DataArray = Dataset = Any

Array: TypeAlias = NDArray[Any]
Numbers: TypeAlias = float | Array  # a number, or an array that broadcasts with the other arguments
