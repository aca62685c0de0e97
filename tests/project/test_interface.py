"""`import proprotor` imports nothing else, and offers every name of the interface where it is used."""

import subprocess
import sys
from importlib import import_module

import pytest

import proprotor as pp
from proprotor import interface

AT_FIRST = """
import sys
import proprotor as pp
assert "numpy" not in sys.modules and "proprotor.interface" not in sys.modules
import proprotor.study.sampling  # a room, whose name is also that of a function
assert pp.study.__module__ == "proprotor.study.study" and pp.sampling.__name__ == "proprotor.study.sampling"
from proprotor import *
assert study is pp.study and load_case is pp.load_case
"""


def test_the_package_imports_its_interface_where_a_name_is_used():
    done = subprocess.run([sys.executable, "-c", AT_FIRST], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_every_name_is_offered_and_listed():
    assert pp.__all__ == interface.__all__ == sorted(pp.__all__)
    assert set(pp.__all__) <= set(dir(pp))
    assert all(getattr(pp, name) is getattr(interface, name) for name in pp.__all__)


def test_the_function_stays_where_its_room_is_imported():
    room = import_module("proprotor.study")
    pp.study = room  # as the import system does
    assert pp.study is interface.study is not room
    pp.explore = room = import_module("proprotor.explore")
    assert pp.explore is interface.explore is not room


def test_a_name_that_is_not_there_is_told():
    with pytest.raises(AttributeError, match="module 'proprotor' has no attribute 'flutter_sped'"):
        _ = pp.flutter_sped
