"""Where arrays of all kinds begin in memory."""

import numpy as np
import pytest

from proprotor.compiled.columns import address, start_of


def _read_only():
    array = np.arange(6.0)
    array.flags.writeable = False
    return array


@pytest.mark.parametrize(
    "array",
    [
        np.zeros((2, 3, 3)),
        _read_only(),
        np.empty((0, 4)),
        np.arange(12.0)[1::2],
        np.zeros((3, 4)).T,
        np.broadcast_to(1.0, 5),
        np.zeros(3, dtype=bool),
    ],
    ids=["whole", "read only", "empty", "with gaps", "by columns", "of one number", "of bytes"],
)
def test_an_array_begins_where_numpy_says(array):
    assert start_of(array) == array.ctypes.data
    assert (address(array).value or 0) == array.ctypes.data
