"""A short text that is the same for the same inputs, today and in another process, and differs for other inputs.

Numbers, texts, arrays and containers count by value. An object counts by its class and by the state that another
process would receive in a pickle. A function counts by its code, its defaults, the contents of its closure and its
attributes, and every global to which it refers. Installed modules count by name and version instead, because these
define the code. Where an object contains itself, its place on the walk counts in its stead.

An object whose content cannot be read, such as an open file, is refused: without that content the fingerprint could be
the fingerprint of other inputs.
"""

from __future__ import annotations

import builtins
import copyreg
import dataclasses
import dis
import functools
import hashlib
import importlib.util
import pickle
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import (
    CodeType,
    EllipsisType,
    FunctionType,
    MappingProxyType,
    MethodType,
    ModuleType,
    NotImplementedType,
)
from typing import Any

import numpy as np

from proprotor.errors import InputError

_OWN = ("proprotor", "proprotor_equations")  # `source_code` makes a fingerprint of their text
_PLAIN = (type(None), bool, float, complex, bytes, EllipsisType, NotImplementedType)
_CACHED_FUNCTION = type(functools.cache(lambda: None))
_WRAPPERS = (property, staticmethod, classmethod, functools.cached_property, _CACHED_FUNCTION)
# Instructions of compiled code that read a global, and that import a module.
_OF_GLOBALS, _OF_IMPORTS = ("LOAD_GLOBAL", "LOAD_NAME", "LOAD_FROM_DICT_OR_GLOBALS"), ("IMPORT_NAME",)
_LONGEST = 8  # names of a path in a message
_MADE_AS_IT_RUNS = 1 << 9  # flag of a class that Python code has made
# Builtins that read something outside the function.
_UNSEEN = ("eval", "exec", "open", "input", "globals", "__import__")
_MADE_BY_PYTHON = (  # entries of a class that Python adds by itself
    *("__module__", "__qualname__", "__doc__", "__dict__", "__weakref__", "__firstlineno__", "__slotnames__"),
    *("__abstractmethods__", "__static_attributes__", "__dataclass_fields__", "__dataclass_params__"),
    "_abc_impl",
)


def fingerprint(content: Any, name: str = "") -> str:
    """Return the SHA-256 of nested numbers, texts, arrays, containers, records, objects and functions, in hexadecimal.

    Parameters
    ----------
    content : object
    name : str
        Name of the content, for the message.

    Raises
    ------
    InputError
        When something within the content cannot be read.
    """
    walk = _Walk([name] if name else [])
    try:
        walk.add(content)
    except RecursionError:
        raise walk.refusal("an object that is nested too deeply") from None
    return walk.digest.hexdigest()


class _Walk:
    """A walk through everything that an object contains, with the digest of all that was met."""

    def __init__(self, path: list[str]) -> None:
        self.digest = hashlib.sha256()
        self.path = path  # names of the parts that are being read, from the outermost to the innermost
        # Parts that are being read, by identity, with their place on the walk.
        self.around: dict[int, int] = {}
        self.met: dict[int, tuple[int, Any]] = {}  # functions and classes by identity: number and object

    def add(self, it: Any) -> None:
        """Add one object with everything that it contains."""
        kind = type(it)
        if kind in _PLAIN:
            self.text(kind.__name__, repr(it))
        elif kind is str:
            self.text("str", it)
        elif kind is int:
            self.text("int", hex(it))
        elif kind is np.ndarray or isinstance(it, np.generic):
            self._array(kind, np.asarray(it))
        elif id(it) in self.around:
            self.text("around", str(self.around[id(it)]))
        else:
            self.around[id(it)] = len(self.around)
            self._inside(kind, it)
            del self.around[id(it)]

    def text(self, kind: str, text: str) -> None:
        """Add one piece of text with its length, so that two pieces never read as one."""
        raw = text.encode(errors="surrogatepass")
        self.digest.update(f"{kind}:{len(raw)}:".encode() + raw)

    def refusal(self, kind: str) -> InputError:
        """Return the error for an object whose content cannot be read."""
        path = self.path if len(self.path) <= _LONGEST else [*self.path[:_LONGEST], "…"]
        where = f" of the study ({' → '.join(path)})" if path else ""
        rule = f"stands among the inputs{where}, and its content cannot be identified: give another, or no checkpoint"
        return InputError("checkpoint", kind, rule)

    @contextmanager
    def _within(self, name: str) -> Iterator[None]:
        """Keep a name on the path while the part of that name is read."""
        self.path.append(name)
        yield
        self.path.pop()

    def _named(self, entries: Iterable[tuple[str, Any]]) -> None:
        """Add values with their names."""
        for name, value in entries:
            self.text("name", name)
            with self._within(name):
                self.add(value)

    def _each(self, kind: str, many: Iterable[Any]) -> None:
        """Add the number of some objects, and each of the objects."""
        entries = list(many)
        self.text(kind, str(len(entries)))
        for entry in entries:
            self.add(entry)

    def _alone(self, it: Any) -> str:
        """Return the fingerprint of an entry of a set, which must not depend on the entries before that one."""
        walk = _Walk(self.path)
        walk.around, walk.met = dict(self.around), dict(self.met)
        walk.add(it)
        return walk.digest.hexdigest()

    def _array(self, kind: type, it: np.ndarray[Any, Any]) -> None:
        """Add type, shape and entries of an array."""
        self.text(kind.__name__, f"{it.dtype!r}{it.shape}")
        if it.dtype.hasobject:
            self._each("entries", it.reshape(-1).tolist())
        else:
            self.digest.update(np.ascontiguousarray(it).reshape(-1).view(np.uint8).data)

    def _inside(self, kind: type, it: Any) -> None:
        """Add an object that contains others, in the way of its kind."""
        if kind in (list, tuple):
            self._each(kind.__name__, it)
        elif kind in (dict, MappingProxyType):
            self._mapping(it)
        elif kind in (set, frozenset):
            self._each(kind.__name__, sorted(map(self._alone, it)))
        elif kind in (FunctionType, type) or isinstance(it, type):
            self._once(it)
        elif kind is CodeType:
            self._code(it)
        elif kind is MethodType:
            self._each("method", (it.__func__, it.__self__))
        elif kind is ModuleType:
            self._module(it, None)
        elif kind in _WRAPPERS:
            self._wrapper(kind, it)
        else:
            self._object(kind, it)

    def _mapping(self, it: Mapping[Any, Any]) -> None:
        """Add keys and values of a mapping, in an order that does not depend on insertion."""
        if all(type(key) is str for key in it):
            self.text("by name", str(len(it)))
            self._named(sorted(it.items()))
        else:
            self.text("mapping", str(len(it)))
            for key in sorted(it, key=self._alone):
                self.add(key)
                self.add(it[key])

    # Objects --------------------------------------------------------------------------------------

    def _object(self, kind: type, it: Any) -> None:
        """Add class and state of an object; of this package's records the fields alone, without cached results."""
        self.text("object", kind.__name__)
        self.add(kind)
        if dataclasses.is_dataclass(it) and _package(kind.__module__) in _OWN:
            self._named((entry.name, getattr(it, entry.name)) for entry in dataclasses.fields(it))
            return
        try:
            own = copyreg.dispatch_table.get(kind)
            reduced: str | tuple[Any, ...] = own(it) if own else it.__reduce_ex__(pickle.HIGHEST_PROTOCOL)
        except Exception:  # a class that cannot be pickled may raise anything
            raise self.refusal(f"{kind.__module__}.{kind.__qualname__}") from None
        if isinstance(reduced, str):  # the name of a global
            module = str(pickle.whichmodule(it, reduced))  # type: ignore[attr-defined]
            if not _is_installed(it, module, reduced):
                raise self.refusal(f"{kind.__module__}.{kind.__qualname__}")
            self.text("installed", f"{_package(module)} {_version(module)} {reduced}")
            return
        state, entries, pairs, *_ = (*reduced[2:], None, None, None)
        self._each("made by", reduced[:2])
        self.add(_without_cached(kind, state))
        self._each("entries", entries or ())
        self._mapping(dict(pairs or ()))

    def _wrapper(self, kind: type, it: Any) -> None:
        """Add what stands within a property, a method of a class or a cached function."""
        self.text("wrapper", kind.__qualname__)
        names = ("fget", "fset", "fdel", "func", "__func__", "__wrapped__")
        self._named((name, getattr(it, name)) for name in names if hasattr(it, name))

    # Functions, classes and modules ---------------------------------------------------------------

    def _once(self, it: Any) -> None:
        """Add a function or class: the first time by its content, after that by its number."""
        if id(it) in self.met:
            self.text("met", str(self.met[id(it)][0]))
            return
        self.met[id(it)] = len(self.met), it
        if _is_compiled(it) or _is_installed(it, it.__module__, it.__qualname__):
            self.text("installed", f"{it.__module__}.{it.__qualname__} {_version(it.__module__)}")
        elif isinstance(it, type):
            self._class(it)
        else:
            self._function(it)

    def _class(self, it: type) -> None:
        """Add the bases and the entries of a class."""
        self._each("class", (type(it), *it.__bases__))
        own = {name for name in vars(it) if not name.startswith("__annot")}
        self._mapping({name: vars(it)[name] for name in own.difference(_MADE_BY_PYTHON)})

    def _function(self, it: FunctionType) -> None:
        """Add code, defaults, closure and attributes of a function, and every global to which its code refers."""
        self.text("function", "")
        self.add(it.__code__)
        self._each("defaults", (it.__defaults__, it.__kwdefaults__))
        cells = zip(it.__code__.co_freevars, it.__closure__ or (), strict=True)
        self._named((name, _content(cell)) for name, cell in cells)
        self._mapping(vars(it))
        home = it.__globals__.get("__name__", "")
        if _version(home) is not None:  # the version stands for the content of its module
            self.text("of", f"{home} {_version(home)}")
            return
        codes = list(_nested(it.__code__))
        names = {name for code in codes for name in code.co_names}
        names |= {text for code in codes for text in code.co_consts if isinstance(text, str)}
        for name in _names_in(codes, _OF_GLOBALS):
            with self._within(name):
                self._global(name, it.__globals__, names)
        for name in _names_in(codes, _OF_IMPORTS):
            with self._within(name):
                self._imported(name, names)

    def _global(self, name: str, own: Mapping[str, Any], names: set[str]) -> None:
        """Add a global of a function's module, or the name of a builtin."""
        self.text("global", name)
        if name not in own:
            if name in _UNSEEN:
                raise self.refusal(f"a call of {name}()")
            self.text("builtin" if hasattr(builtins, name) else "missing", name)
        elif isinstance(own[name], ModuleType):
            self._module(own[name], names)
        else:
            self.add(own[name])

    def _imported(self, name: str, names: set[str]) -> None:
        """Add a module that a function imports while it runs."""
        self.text("import", name)
        if _version(name) is not None:
            self.text("installed", f"{name} {_version(name)}")
        elif name in sys.modules:
            self._module(sys.modules[name], names)
        else:
            raise self.refusal(f"an import of {name}")

    def _module(self, it: ModuleType, names: set[str] | None) -> None:
        """Add a module by its version, else by the attributes that a function names, or by all without names."""
        if _version(it.__name__) is not None:
            self.text("installed", f"{it.__name__} {_version(it.__name__)}")
            return
        self.text("module", it.__name__)
        found = {name: value for name, value in vars(it).items() if not name.startswith("__")}
        for name in sorted(found.keys() if names is None else found.keys() & names):
            self.text("attribute", name)
            with self._within(name):
                value = found[name]
                if not isinstance(value, ModuleType):
                    self.add(value)
                elif id(value) not in self.around:
                    self.around[id(value)] = len(self.around)
                    self._module(value, names)
                    del self.around[id(value)]

    def _code(self, it: CodeType) -> None:
        """Add names, constants and instructions of compiled code."""
        arguments = it.co_varnames[: it.co_argcount + it.co_kwonlyargcount]
        counts = (it.co_argcount, it.co_posonlyargcount, it.co_kwonlyargcount, it.co_flags)
        self._each("code", (counts, arguments, it.co_names, it.co_cellvars, it.co_freevars))
        self._each("instructions", (it.co_code, it.co_exceptiontable, it.co_consts))


def _content(cell: Any) -> Any:
    """Return the content of a closure's cell."""
    try:
        return cell.cell_contents
    except ValueError:
        return NotImplemented, "nothing was put into it"


def _without_cached(kind: type, state: Any) -> Any:
    """Return the state of an object without the values of its cached properties; None if nothing is left."""
    if not isinstance(state, dict):
        return state
    cached = functools.cached_property
    own = {
        name: value for name, value in state.items() if not isinstance(getattr(kind, str(name), None), cached)
    }
    return own or None


def _nested(code: CodeType) -> Iterator[CodeType]:
    """Yield the code of a function and of all functions and classes defined within that function."""
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _nested(constant)


def _names_in(codes: Iterable[CodeType], instructions: tuple[str, ...]) -> list[str]:
    """Return the names to which some instructions of compiled code refer, in alphabetical order."""
    steps = (step for code in codes for step in dis.get_instructions(code))
    return sorted({step.argval for step in steps if step.opname in instructions})


def _package(module: str) -> str:
    """Return the package to which a module belongs."""
    return module.partition(".")[0]


def _is_compiled(it: Any) -> bool:
    """Return whether an object is a class of compiled code, which no script can make or alter."""
    return isinstance(it, type) and not it.__flags__ & _MADE_AS_IT_RUNS


def _is_installed(it: Any, module: str | None, name: str) -> bool:
    """Return whether an object is the one that an installed module has under that name."""
    found: Any = sys.modules.get(module or "")
    if found is None or _version(found.__name__) is None:
        return False
    for part in name.split("."):
        found = getattr(found, part, None)
    return found is it


def _place(package: str) -> Path:
    """Return the path of a package, imported or not; an empty path if no such package exists."""
    if (module := sys.modules.get(package)) is not None:
        return Path(getattr(module, "__file__", None) or next(iter(getattr(module, "__path__", ())), ""))
    try:
        found = importlib.util.find_spec(package)
    except ValueError:  # for an empty name
        return Path()
    return Path((found and found.origin) or "")


@functools.cache
def _version(module: str) -> str | None:
    """Return the version of the package that installed a module; None for a module that was not installed."""
    from importlib import metadata

    package = _package(module)
    if package in _OWN:
        return ""
    if package in sys.stdlib_module_names:
        return None if package == "__main__" else ".".join(map(str, sys.version_info[:2]))
    if not {"site-packages", "dist-packages"} & set(_place(package).parts):
        return None
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        names = metadata.packages_distributions().get(package, [])
    return " ".join(metadata.version(name) for name in names) or None
