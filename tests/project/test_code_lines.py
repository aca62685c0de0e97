"""Lines of code are counted without docstrings, comments and blank lines."""

from collections import Counter

from benchmarks.code_lines import by_room, code_lines

MODULE = '''"""Of a module,
on two lines."""

import os  # with a comment


class A:
    """Of a class."""

    name: str
    """Of an attribute."""

    def f(self):
        """Of a function."""
        # a comment
        text = """a value
        on two lines"""
        return (
            text,
        )
'''


def test_docstrings_comments_and_blank_lines_do_not_count():
    """import, class, name, def, two of the value, three of the return."""
    assert code_lines(MODULE) == 9
    assert code_lines("") == 0


def test_lines_are_summed_by_the_folder_below_the_package(tmp_path):
    for name, text in {
        "__init__.py": "",
        "errors.py": "A = 1\n",
        "rotor/trim.py": "B = 1\n\nC = 2\n",
    }.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    assert by_room(tmp_path) == Counter({"rotor": 2, "beside the rooms": 1})
