"""The library of compiled functions: built by the system's C compiler on first use, and kept in a cache.

The name of the cached file is made of the sources, the compiler, its flags and the processor's instructions, so that
another version, compiler or machine builds a library of its own. A machine without a compiler, or a folder from which
nothing may be run, has no library, and a reason.
"""

from __future__ import annotations

import ctypes
import hashlib
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

from proprotor_equations import fused

from proprotor.errors import InputError
from proprotor.files.output import check_writable, write_whole

SOURCES = Path(__file__).parent
GENERATED = Path(fused.__file__).parent
# One product and one sum at a time, as NumPy does: every width of vector has the same bits then.
_FLAGS = (
    "-O2",
    "-std=gnu11",
    "-fPIC",
    "-shared",
    "-ffp-contract=off",
    "-fno-math-errno",
    "-fno-trapping-math",
)
# By GCC and Clang: on most processors, with registers as wide as these are, and on some others.
_OWN_PROCESSOR = (("-march=native", "-mprefer-vector-width=512"), ("-march=native",), ("-mcpu=native",))
_PATIENCE = 300  # s, for the compiler
_CACHE = "PROPROTOR_CACHE"
_HELP = f"set {_CACHE} to a folder whose files may be run"


class Unavailable(Exception):
    """The compiled functions cannot be used here; the text says why."""


@cache
def why_not() -> str:
    """Return why there are no compiled functions here; empty if there are."""
    try:
        library()
    except Unavailable as error:
        return str(error)
    return ""


@cache
def library() -> ctypes.CDLL:
    """Return the library of compiled functions, built if the cache has none.

    Raises
    ------
    Unavailable
        Without a C compiler, or where its result cannot be loaded.
    """
    compiler = _compiler()
    flags = (*_FLAGS, *_own_processor(compiler))
    place = cache_folder() / f"{_key(compiler, flags)}.so"
    try:
        return ctypes.CDLL(str(place))
    except OSError:  # not built yet, or damaged
        _check_cache(place)
        _build(compiler, flags, place)
    try:
        return ctypes.CDLL(str(place))
    except OSError as error:
        raise Unavailable(f"the compiled library cannot be loaded: {error}; {_HELP}") from None


def compiler_version() -> str:
    """Return what the C compiler says of its version.

    Raises
    ------
    Unavailable
        Without a C compiler.
    """
    return _version_of(_compiler()).decode(errors="replace")


def cache_folder() -> Path:
    """Return the folder of compiled libraries: that of the variable PROPROTOR_CACHE, or the user's cache.

    Raises
    ------
    Unavailable
        Without the variable and without a home.
    """
    if own := os.environ.get(_CACHE):
        return Path(own)
    try:
        home = Path.home()
    except RuntimeError:
        raise Unavailable(f"the compiled library cannot be kept: the user has no home; {_HELP}") from None
    if sys.platform == "darwin":
        return home / "Library" / "Caches" / "proprotor"
    return Path(os.environ.get("XDG_CACHE_HOME") or home / ".cache") / "proprotor"


def _compiler() -> tuple[str, ...]:
    """Return the command of the C compiler: that of the variable CC, or `cc`."""
    given = os.environ.get("CC", "")
    try:
        import shlex  # here, as what follows below: most processes compile nothing

        command = tuple(shlex.split(given)) or ("cc",)
    except ValueError as error:
        raise Unavailable(f"there is no C compiler: the variable CC is {given}: {error}") from None
    _version_of(command)
    return command


def _version_of(compiler: tuple[str, ...]) -> bytes:
    return _output_of((*compiler, "--version"), "there is no C compiler")


def _own_processor(compiler: tuple[str, ...]) -> tuple[str, ...]:
    """Return the flags for the instructions of this processor that the compiler knows."""
    for flags in _OWN_PROCESSOR:
        try:
            _output_of((*compiler, *flags, "-E", "-x", "c", os.devnull), "")
        except Unavailable:
            continue
        return flags
    return ()


def _key(compiler: tuple[str, ...], flags: tuple[str, ...]) -> str:
    """Return the name of the library: a digest of all that makes it."""
    digest = hashlib.sha256()
    for source in (*_sources("h"), *_sources("c"), *GENERATED.glob("*.h")):
        digest.update(source.name.encode() + source.read_bytes())
    digest.update(_version_of(compiler))
    # The compiler's own constants name the instructions that it may use.
    constants = (*flags[len(_FLAGS) :], "-dM", "-E", "-x", "c", os.devnull)
    digest.update(_output_of((*compiler, *constants), "the C compiler fails"))
    digest.update(" ".join(flags).encode())
    return digest.hexdigest()[:24]


def _sources(ending: str) -> list[Path]:
    """Return the files of C with an ending, in their order."""
    return sorted(SOURCES.glob(f"*.{ending}"))


def _build(compiler: tuple[str, ...], flags: tuple[str, ...], place: Path) -> None:
    """Compile the sources into the cache."""
    import tempfile

    with tempfile.TemporaryDirectory(prefix="proprotor-") as folder:
        built = Path(folder) / "library.so"
        sources = (f"-I{GENERATED}", f"-I{SOURCES}", "-o", str(built), *map(str, _sources("c")), "-lm")
        _output_of((*compiler, *flags, *sources), "the C compiler fails")
        content = built.read_bytes()
    with _keeping(place):
        write_whole(place, lambda file: file.write(content))


def _check_cache(place: Path) -> None:
    """Make the folder of a library and try whether a file can be written there, which costs less than compiling."""
    with _keeping(place):
        place.parent.mkdir(parents=True, exist_ok=True)
        check_writable(place)


@contextmanager
def _keeping(place: Path) -> Iterator[None]:
    """Turn what goes wrong with the place of a library into a reason."""
    try:
        yield
    except (OSError, InputError) as error:
        raise Unavailable(
            f"the compiled library cannot be kept in {place.parent}: {error}; {_HELP}"
        ) from None


def _output_of(command: tuple[str, ...], failure: str) -> bytes:
    """Return what a command prints.

    Raises
    ------
    Unavailable
        With the failure and the first error that the command tells, or its last line.
    """
    import subprocess

    try:
        return subprocess.run(command, capture_output=True, check=True, timeout=_PATIENCE).stdout
    except subprocess.CalledProcessError as error:
        lines = error.stderr.decode(errors="replace").strip().splitlines()
        told = [line for line in lines if "error" in line] or lines[-1:]
        reason = f": {told[0]}" if told else ""
        raise Unavailable(f"{failure} ({command[0]}{reason})") from None
    except (OSError, subprocess.TimeoutExpired) as error:
        raise Unavailable(f"{failure} ({command[0]}: {error})") from None
