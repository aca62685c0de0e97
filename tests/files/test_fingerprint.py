"""A fingerprint is that of the inputs: the same in another process, another for anything that gives other results.

What functions hold is tried in pairs that differ in one thing held, each pair by a way of holding it.
"""

import collections
import datetime
import decimal
import enum
import functools
import importlib
import math
import operator
import os
import pathlib
import subprocess
import sys
import threading
import types
from dataclasses import dataclass, replace

import numpy as np
import pytest
import xarray
from scipy.interpolate import CubicSpline, PchipInterpolator, RegularGridInterpolator, make_interp_spline

import proprotor as pp
from proprotor.errors import InputError
from proprotor.files.fingerprint import fingerprint

CASE = pp.load_case("xv15-uncoupled")
SCALE, TABLE, HOLDER = 1.0, np.linspace(1, 2, 5), {"k": [1.0]}


class Table:
    """A table with a method as a curve."""

    unit = 1.0

    def __init__(self, value):
        self.value = value

    def curve(self, x):
        return self.value * self.unit + 0 * x

    def __call__(self, x):
        return self.curve(x)

    @property
    def doubled(self):
        return 2 * self.value

    @staticmethod
    def of(x):
        return SCALE + 0 * x


class Slotted:
    __slots__ = ("value",)

    def __init__(self, value):
        self.value = value

    def __call__(self, x):
        return self.value


@dataclass(frozen=True)
class Record:
    value: float

    def __call__(self, x):
        return self.value


class Kind(enum.Enum):
    ONE, TWO = 1, 2


Pair = collections.namedtuple("Pair", "a b")


def test_a_fingerprint_tells_apart():
    different = [
        *(1, 1.0, True, "1", b"1", None, (1,), [1], ["1"], ("a", "bc"), ("ab", "c"), {"a": 1}, {"a": 2}),
        *(
            {1: "a"},
            {"1": "a"},
            0.0,
            -0.0,
            float("nan"),
            1j,
            -1j,
            ...,
            range(3),
            range(4),
            slice(3),
            10**5000,
        ),
        *(np.array([1.0]), np.array([[1.0]]), np.array([1]), np.float64(1), np.float32(1), np.int64(1)),
        *(np.array("2020", "M8[Y]"), np.array("2021", "M8[Y]"), np.array([]), np.array([], int)),
        np.array(["a", None], dtype=object),
        np.array(["b", None], dtype=object),
        np.array([(1, 2)], "i4,i4"),
        np.array([(1, 2)], [("a", "i4"), ("b", "i4")]),
        np.ma.array([1.0, 2.0], mask=[0, 1]),
        np.ma.array([1.0, 2.0], mask=[1, 0]),
        *({"a"}, {"a", "b"}, frozenset("a"), {("a", 1)}),
        *(np.sin, np.cos, math.sin, len, np.linalg.norm, operator.itemgetter(1), operator.itemgetter(2)),
        *(Kind.ONE, Kind.TWO, Pair(1, 2), Pair(2, 1), (1, 2), Record(1), Record(2), Slotted(1), Slotted(2)),
        *(decimal.Decimal("1"), decimal.Decimal("1.0"), datetime.date(2020, 1, 1), datetime.date(2020, 1, 2)),
        *(pathlib.PurePosixPath("a"), pathlib.PurePosixPath("b"), types.SimpleNamespace(a=1)),
        *(collections.OrderedDict(a=1), collections.OrderedDict(a=2), collections.deque([1])),
        *(
            lambda r: r,
            lambda r: r + 1,
            lambda r: r + 2,
            lambda r, s=1: r,
            lambda r, s=2: r,
            lambda r, *, s=2: r,
        ),
        lambda r: max(r, key=lambda x: x + 1),
        lambda r: max(r, key=lambda x: x + 2),
        lambda r: math.sin(r),
        lambda r: math.cos(r),
        *(pp.load_case("xv15-wing"), CASE),
        replace(CASE, rotor=replace(CASE.rotor, precone=np.nextafter(CASE.rotor.precone, 1))),
    ]
    assert len({fingerprint(one) for one in different}) == len(different)
    assert fingerprint({"a": 1, "b": 2}) == fingerprint({"b": 2, "a": 1})
    assert fingerprint(set("abc")) == fingerprint(set("cab"))


# What functions hold ------------------------------------------------------------------------------


def closure(value):
    return lambda x: value + 0 * x


def nested_closure(value):
    def outer(x):
        def inner():
            return value

        return inner()

    return outer


def self_referring(value):
    def curve(x):
        return value if x <= 0 else curve(x - 1)

    return curve


def each_other(value):
    def even(x):
        return value if x == 0 else odd(x - 1)

    def odd(x):
        return even(x - 1)

    return odd


def in_a_list_that_holds_itself(value):
    held = [value]
    held.append(held)
    return lambda x: held[0]


def in_a_set(value):
    held = {1, 2, value}
    return lambda x: min(held)


def in_an_object_that_holds_its_method(value):
    table = Table(value)
    table.self = table.curve
    return table.curve


def with_attribute(value):
    def curve(x):
        return curve.value

    curve.value = value
    return curve


def with_globals(value, source="lambda x: scale + 0 * x"):
    """A function of a script that has a global."""
    return eval(source, {"__name__": "script", "scale": value, "math": math})


def through_a_function_of_the_script(value):
    own = {"__name__": "script", "scale": value}
    exec("def inner(x):\n    return scale\ndef curve(x):\n    return inner(x)", own)
    return own["curve"]


def through_a_class_of_the_script(value):
    own = {"__name__": "script", "scale": value}
    exec("class Inner:\n    def at(self, x):\n        return scale\ncurve = lambda x: Inner().at(x)", own)
    return own["curve"]


def through_a_base_class(value):
    base = type("Base", (), {"value": value, "__module__": "script"})
    return type("Curve", (base,), {"__call__": lambda self, x: self.value, "__module__": "script"})()


def through_a_module(value):
    module = types.ModuleType("tables_of_mine")
    module.unused = threading.Lock()  # holds nothing of the function, which does not name it
    exec(f"scale = {value!r}\ndef inner(x):\n    return scale", vars(module))
    return eval("lambda x: tables.inner(x)", {"__name__": "script", "tables": module})


def as_metaclass_made(value):
    kind = type("Meta", (type,), {"value": value, "__module__": "script"})
    return kind("Curve", (), {"__call__": lambda self, x: type(type(self)).value, "__module__": "script"})()


def cached(value):
    return functools.cache(closure(value))


def wrapped(value):
    @functools.wraps(closure(value))
    def curve(x):
        return curve.__wrapped__(x)

    return curve


def property_of_class(value):
    kind = type("Curve", (), {"at": property(lambda self: value), "__module__": "script"})
    it = kind()
    return lambda x: it.at


HOLDING = {
    "a bound method": lambda value: Table(value).curve,
    "an object that is called": Table,
    "an object with slots": Slotted,
    "a record": Record,
    "a bound method of C": lambda value: {0.5: value}.get,
    "a partial": lambda value: functools.partial(operator.mul, value),
    "a partial of a bound method": lambda value: functools.partial(Table(value).curve),
    "a default": lambda value: lambda x, held=value: held,
    "a keyword default": lambda value: lambda x, *, held=value: held,
    "a constant": lambda value: eval(f"lambda x: {value!r}"),
    "a closure": closure,
    "a closure within": nested_closure,
    "a closure that holds itself": self_referring,
    "two closures that hold each other": each_other,
    "a list that holds itself": in_a_list_that_holds_itself,
    "a set": in_a_set,
    "an object that holds its method": in_an_object_that_holds_its_method,
    "an attribute of a function": with_attribute,
    "a global": with_globals,
    "a global of a lambda within": lambda value: with_globals(
        value, "lambda x: max([x], key=lambda y: scale)"
    ),
    "a global of a comprehension": lambda value: with_globals(value, "lambda x: [scale for _ in (1,)]"),
    "a global array": lambda value: with_globals(np.full(3, value)),
    "a global mapping": lambda value: with_globals({"k": [value]}),
    "a global object": lambda value: with_globals(Table(value)),
    "a global function": through_a_function_of_the_script,
    "a global class": through_a_class_of_the_script,
    "a base class": through_a_base_class,
    "a metaclass": as_metaclass_made,
    "a module": through_a_module,
    "a cached function": cached,
    "a wrapped function": wrapped,
    "a property": property_of_class,
    "a spline": lambda value: CubicSpline([0, 1, 2], [value, 1, 2]),
    "a spline's method": lambda value: PchipInterpolator([0, 1, 2], [value, 1, 2]).__call__,
    "a spline of SciPy's newest kind": lambda value: make_interp_spline([0, 1, 2], [value, 1, 2], k=1),
    "a grid": lambda value: RegularGridInterpolator(([0, 1, 2],), [value, 1, 2]),
    "np.vectorize": lambda value: np.vectorize(closure(value)),
    "a polynomial": lambda value: np.polynomial.Polynomial([value, 1]),
    "a labelled array": lambda value: xarray.DataArray([value, 1.0], {"x": [0, 1]}, "x").interp,
    "np.interp in a closure": lambda value: lambda x: np.interp(x, [0, 1], [value, 2]),
}


@pytest.mark.parametrize("way", HOLDING)
def test_what_a_function_holds_counts(way):
    hold = HOLDING[way]
    found = fingerprint(hold(1.9))
    assert found != fingerprint(hold(1.1))
    assert found == fingerprint(hold(1.9))


def test_the_published_case():
    """Frequencies by a bound method once gave the results of another table's."""
    one, other = (
        replace(
            CASE,
            frequencies=pp.BladeFrequencies(
                at_rotor_speed=CASE.operation.rotor_speed, flap=Table(v).curve, lag=1.5
            ),
        )
        for v in (1.9, 1.1)
    )
    assert fingerprint(one) != fingerprint(other)


def test_globals_of_a_module_count_at_the_time(monkeypatch):
    for name, value in (("SCALE", 2.0), ("TABLE", TABLE + 1e-9), ("HOLDER", {"k": [2.0]})):
        curve = {"SCALE": Table.of, "TABLE": lambda x: TABLE[0], "HOLDER": lambda x: HOLDER["k"][0]}[name]
        before = fingerprint(curve)
        monkeypatch.setitem(globals(), name, value)
        assert fingerprint(curve) != before
        monkeypatch.undo()
        assert fingerprint(curve) == before
    curve, before = Table(1.0).curve, fingerprint(Table(1.0).curve)
    monkeypatch.setattr(Table, "unit", 2.0)
    assert fingerprint(curve) != before


def test_what_follows_from_the_rest_does_not_count():
    class Curve:
        value = 1.0

        @functools.cached_property
        def worked_out(self):
            return np.ones(3)

    curve = Curve()
    before = fingerprint(curve)
    assert curve.worked_out.sum() == 3
    assert fingerprint(curve) == before
    other = pp.load_case("xv15-uncoupled")
    before = fingerprint(other)
    other.linearize(100.0)
    assert fingerprint(other) == before


CODE = """
import collections, functools, math
import numpy as np
import proprotor as pp
from scipy.interpolate import CubicSpline
from proprotor.files.fingerprint import fingerprint

TABLE, NAMES = np.linspace(0, 1, 7), {"chord", "beam", "torsion", ("a", 1), frozenset("xyz")}

class Base:
    scale = 2.0

class Curve(Base):
    def __init__(self, value):
        self.value, self.names = value, set("chord")

    def at(self, x):
        return self.scale * np.interp(x, TABLE, TABLE) + math.sin(self.value) + len(NAMES | {"late", "early"})

def outer(value):
    def inner(x):
        return value if x in {"b", "a", "c"} else inner(x)
    return inner

print(fingerprint([
    pp.load_case("xv15-uncoupled"), Curve(2.0), Curve(2.0).at, outer(3.0), functools.partial(outer(3.0), x=1), NAMES,
    collections.Counter("abcabd"), CubicSpline([0, 1, 2], [1, 2, 4]), np.vectorize(math.sin), np.sin, math.sin,
]))
"""


def test_a_fingerprint_is_the_same_in_another_process(tmp_path):
    found = set()
    (tmp_path / "late.py").write_text("")
    for seed in "012":
        done = subprocess.run(
            [sys.executable, "-c", CODE if seed != "2" else f"\n\nimport decimal, json\n\n{CODE}"],
            env=os.environ | {"PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=True,
        )
        found.add(done.stdout)
    assert len(found) == 1


def test_what_a_function_imports_as_it_runs_counts(tmp_path, monkeypatch):
    """One's own module by what the function takes of it, an installed one by its version, imported yet or not."""
    monkeypatch.syspath_prepend(tmp_path)
    curve = with_globals(None, "lambda x: __import__")  # which is told apart from the statement
    own = {"__name__": "script"}
    exec("def curve(x):\n    import table_of_mine\n    return table_of_mine.scale", own)
    with pytest.raises(InputError, match="an import of table_of_mine"):
        fingerprint(own["curve"])
    (tmp_path / "table_of_mine.py").write_text("scale, unused = 1.0, open")
    found = []
    for value in (1.0, 2.0, 1.0):
        monkeypatch.setattr(importlib.import_module("table_of_mine"), "scale", value)
        found.append(fingerprint(own["curve"]))
    assert found[0] == found[2] != found[1]
    del sys.modules["table_of_mine"]
    exec("def curve(x):\n    import antigravity, tornado.websocket, colorsys\n    return x", own)
    assert fingerprint(own["curve"]) == fingerprint(own["curve"])
    with pytest.raises(InputError, match=r"a call of __import__\(\)"):
        fingerprint(curve)


# What cannot be identified ------------------------------------------------------------------------


def generator():
    yield 1


def nested(depth):
    held = []
    for _ in range(depth):
        held = [held]
    return held


REFUSED = {
    "a lock": threading.Lock,
    "a generator": generator,
    "an open file": lambda: open(os.devnull, encoding="utf-8"),  # noqa: SIM115
    "a lock in an object": lambda: Table(threading.Lock()).curve,
    "a lock in a closure": lambda: closure(threading.Lock()),
    "a lock in a global": lambda: with_globals(threading.Lock()),
    "a lock in a partial": lambda: functools.partial(operator.mul, threading.Lock()),
    "a ufunc of a function": lambda: np.frompyfunc(closure(1.0), 1, 1),
    "a function that reads a file": lambda: with_globals(1, "lambda x: open('table.txt').read()"),
    "a function that evaluates text": lambda: with_globals(1, "lambda x: eval('scale')"),
    "what is nested without end": lambda: nested(100_000),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_cannot_be_told_is_refused_in_one_message(what):
    held = REFUSED[what]()
    try:
        with pytest.raises(InputError) as caught:
            fingerprint({"flap": held}, "case")
    finally:
        getattr(held, "close", lambda: None)()
    told = str(caught.value)
    assert told.startswith("checkpoint = ") and "\n" not in told
    assert "stands among the inputs of the study (case → flap" in told and "cannot be identified" in told


def test_nothing_is_computed_of_a_study_whose_inputs_cannot_be_told(tmp_path, monkeypatch):
    from proprotor.study.batch import Analysis

    monkeypatch.setattr(Analysis, "__call__", lambda self, batch: pytest.fail("a point was computed"))
    held = closure(threading.Lock())
    case = replace(
        CASE,
        frequencies=pp.BladeFrequencies(
            at_rotor_speed=CASE.operation.rotor_speed, flap=lambda x: 1.2 + 0 * x + 0 * bool(held), lag=1.5
        ),
    )
    with pytest.raises(
        InputError, match=r"^checkpoint = _thread.lock: .* \(case → frequencies → flap → held → value\)"
    ):
        pp.study(case, {"rotor.precone": [0.03]}, 100.0, checkpoint=tmp_path / "kept", structure="tabulated")
    assert not (tmp_path / "kept").exists()
