"""Tables within a width: no line is longer, no number is cut, no word is lost, and the order of words is kept."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from proprotor.commands.columns import laid_out

HEADS = ("KTAS", "Hz", "mode", "mechanism")
ROWS = [
    ("391.60", "5.147", "symmetric chord", "symmetric chord 74 %, symmetric regressive gimbal 6 %"),
    ("1193.8?", "15.777", "antisymmetric regressive gimbal", "antisymmetric torsion 56 %"),
]
TEXT = HEADS[2:]
WORDS = st.lists(st.text("abcdefgh", min_size=1, max_size=9), max_size=9).map(" ".join)
NUMBERS = st.floats(-1e6, 1e6).map(lambda value: f"{value:.4g}")
TABLES = st.lists(st.tuples(NUMBERS, WORDS, NUMBERS, WORDS), max_size=6)


def words_of(lines):
    return sorted(word for line in lines for word in line.split())


@pytest.mark.parametrize("width", [40, 60, 80, 100, 200])
def test_a_table_of_modes_fits(width):
    head, body = laid_out(HEADS, ROWS, TEXT, width, 30)
    assert max(map(len, [*head, *body])) <= width
    assert words_of(head) == sorted(HEADS)
    assert words_of(body) == sorted(word for row in ROWS for cell in row for word in cell.split())


def test_where_there_is_room_a_row_is_a_line():
    head, body = laid_out(HEADS, ROWS, TEXT, 200, 30)
    assert len(head) == 1 and len(body) == len(ROWS)
    assert head[0].index("mode") == body[0].index("symmetric") == body[1].index("antisymmetric")
    assert body[0].index("391.60") + 6 == body[1].index("1193.8?") + 7  # numbers to the right


def test_long_text_stands_beneath_its_row_where_little_room_is_left():
    _, body = laid_out(HEADS, ROWS, TEXT, 70, 30)
    assert body[1].strip() == ROWS[0][-1] and body[1].startswith("    ")
    assert body[0].endswith("symmetric chord")
    assert body[-1].endswith("antisymmetric torsion 56 %") and body[-1].startswith("1193.8?") is False


def test_a_number_stays_beside_its_percent_sign():
    for width in range(30, 80):
        _, body = laid_out(("mechanism",), [(ROWS[0][-1],)], ("mechanism",), width, 30)
        assert not any(line.strip().startswith("%") for line in body)


def test_a_name_that_is_too_long_breaks_between_its_parts():
    rows = [("support.modes[antisymmetric].frequency", "1.30/rev", "+42.62")]
    _, body = laid_out(("input", "value", "change"), rows, ("input", "value"), 44, 30)
    assert max(map(len, body)) <= 44
    assert "".join(line.split()[0] for line in body) == rows[0][0]
    assert "1.30/rev" in body[0]
    assert body[0].split()[0][-1] in "._]"


@given(rows=TABLES, width=st.integers(46, 200))
def test_no_line_is_longer_than_the_width_and_nothing_is_lost(rows, width):
    columns = ("first", "second", "third", "fourth")
    head, body = laid_out(columns, rows, ("second", "fourth"), width, 20)
    assert max(map(len, [*head, *body])) <= width
    assert words_of(head) == sorted(columns)
    assert words_of(body) == sorted(word for row in rows for cell in row for word in cell.split())
