"""A short text that is the same for the same inputs, today and in another process, and no other."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Mapping
from pathlib import PurePath
from types import CodeType
from typing import Any

import numpy as np

from proprotor.errors import InputError


def fingerprint(content: Any) -> str:
    """SHA-256 of nested numbers, texts, arrays, mappings, sequences, records and functions, in hexadecimal.

    Raises
    ------
    InputError
        For something whose content cannot be told.
    """
    digest = hashlib.sha256()
    _add(digest, content)
    return digest.hexdigest()


def _add(digest: Any, it: Any) -> None:
    kind = f"{type(it).__module__}.{type(it).__qualname__}"
    if it is None or isinstance(it, bool | int | str | bytes | PurePath):
        _text(digest, kind, repr(it) if not isinstance(it, str) else it)
    elif isinstance(it, float | complex | np.generic):
        _text(digest, kind, repr(it.item() if isinstance(it, np.generic) else it))
    elif isinstance(it, np.ndarray):
        _text(digest, "array", f"{it.dtype.str}{it.shape}")
        if it.dtype.hasobject:
            _add(digest, it.tolist())
        else:
            digest.update(np.ascontiguousarray(it).tobytes())
    elif isinstance(it, Mapping):
        _text(digest, "mapping", str(len(it)))
        for key in sorted(it, key=str):
            _add(digest, key)
            _add(digest, it[key])
    elif isinstance(it, list | tuple):
        _text(digest, kind, str(len(it)))
        for one in it:
            _add(digest, one)
    elif isinstance(it, set | frozenset):
        _add(digest, sorted(map(fingerprint, it)))
    else:
        _add_object(digest, kind, it)


def _add_object(digest: Any, kind: str, it: Any) -> None:
    _text(digest, "object", kind)
    if dataclasses.is_dataclass(it) and not isinstance(it, type):
        # The fields alone: what a record has worked out and kept is no input.
        _add(digest, {entry.name: getattr(it, entry.name) for entry in dataclasses.fields(it)})
    elif isinstance(it, type) or hasattr(it, "__name__"):
        _text(digest, "named", f"{getattr(it, '__module__', '')}.{getattr(it, '__qualname__', it.__name__)}")
        if hasattr(it, "__code__"):
            _add_code(digest, it.__code__)
            cells = [cell.cell_contents for cell in it.__closure__ or ()]
            _add(digest, [cells, it.__defaults__, it.__kwdefaults__])
    elif getattr(it, "__dict__", None):
        _add(digest, {name: value for name, value in vars(it).items() if not name.startswith("__")})
    else:
        raise InputError("checkpoint", kind, "stands among the inputs, and what it holds cannot be told")


def _add_code(digest: Any, code: CodeType) -> None:
    digest.update(code.co_code)
    _add(digest, list(code.co_names))
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            _add_code(digest, constant)
        else:
            _add(digest, constant)


def _text(digest: Any, kind: str, text: str) -> None:
    raw = text.encode()
    digest.update(f"{kind}:{len(raw)}:".encode())
    digest.update(raw)
