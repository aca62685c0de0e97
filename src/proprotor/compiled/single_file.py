"""Write the compiled eigenvalue solver as one header and one source, for programs in C, Fortran or MATLAB.

    python -m proprotor.compiled.single_file FOLDER

The folder gets `proprotor.h`, `proprotor.c`, `proprotor.f90`, a module of Fortran with the interface, and
`proprotor_mex.c`, a function of MATLAB and Octave.
"""

from __future__ import annotations

import argparse
import os
import re
from pathlib import Path

from proprotor.compiled.library import GENERATED, SOURCES
from proprotor.files.output import write_whole

_PARTS = (
    "eigen.h",
    "motion.h",
    "columns.h",
    "schur.c",
    "vectors.c",
    "motion.c",
    "eigenvalues.c",
    "interface.c",
)
_INTERFACES = ("proprotor.h", "proprotor.f90", "matlab/proprotor_mex.c")  # files that are copied
_OWN_INCLUDE = re.compile(r'^#include "(?!proprotor\.h).*"\n', re.MULTILINE)
_SHARED = re.compile(
    r"^(?=(?:whole|void) \w+\()", re.MULTILINE
)  # between files of the library, here in one file
_HEAD = """\
/* The functions of proprotor.h in one file, by `python -m proprotor.compiled.single_file`. With GCC or Clang:

       cc -O2 -std=gnu11 -march=native -ffp-contract=off -fno-math-errno -fno-trapping-math -c proprotor.c

   Part of the Python package proprotor; licence BSD-3-Clause. */

#include "proprotor.h"

"""


def single_source() -> str:
    """Return the text of the source: vectors of lanes, the solver, and the functions of `proprotor.h`."""
    files = (GENERATED / "lanes.h", *(SOURCES / name for name in _PARTS))
    parts = (_OWN_INCLUDE.sub("", path.read_text(encoding="utf-8")) for path in files)
    whole = _HEAD + "\n".join(_SHARED.sub("static inline ", part) for part in parts)
    # Clang warns of functions of the library that these do not need.
    return whole.replace("static inline ", "static inline __attribute__((unused)) ")


def write_single_file(folder: str | os.PathLike[str]) -> list[Path]:
    """Write header, source, module of Fortran and function of MATLAB into a folder, which is made where it is missing.

    Parameters
    ----------
    folder : str or path

    Returns
    -------
    list of path
        The files that were written.

    Raises
    ------
    OSError
        When the files cannot be written.
    """
    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    sources = [SOURCES / name for name in _INTERFACES]
    texts = {source.name: source.read_text(encoding="utf-8") for source in sources}
    texts["proprotor.c"] = single_source()
    for name, text in texts.items():
        _write_text(place / name, text)
    return [place / name for name in texts]


def _write_text(place: Path, text: str) -> None:
    write_whole(place, lambda file: file.write(text.encode()))


def main() -> None:
    """Write the files into the folder that the command names."""
    parser = argparse.ArgumentParser(
        prog="python -m proprotor.compiled.single_file", description=__doc__.partition("\n")[0]
    )
    parser.add_argument("folder")
    print(*write_single_file(parser.parse_args().folder), sep="\n")


if __name__ == "__main__":
    main()
