"""Numbers of a column have the same count of significant digits, as they are written by hand."""

import math

import pytest

from proprotor.tables.digits import alike, significant


@pytest.mark.parametrize(
    ("value", "digits", "sign", "text"),
    [
        (1.5, 3, "", "1.50"),
        (-1.5, 3, "+", "-1.50"),
        (0.875, 3, "+", "+0.875"),
        (2.0, 1, "", "2"),
        (206.0, 4, "", "206.0"),
        (5555.6, 4, "", "5556"),
        (123456.0, 4, "", "1.235e+05"),
        (0.0, 3, "+", "+0.00"),
        (math.nan, 3, "", "nan"),
    ],
)
def test_zeros_at_the_end_stay(value, digits, sign, text):
    assert significant(value, digits, sign) == text


@pytest.mark.parametrize(
    ("values", "texts"),
    [
        ([340.0, 400.0], ["340", "400"]),
        ([71.04, 206.0, 426.23], ["71.04", "206.00", "426.23"]),
        ([98.5, 1000.26], ["98.5", "1000.3"]),
        ([], []),
    ],
)
def test_decimals_are_alike_and_whole_numbers_stay_whole(values, texts):
    assert alike(values, 4) == texts
