"""A folder in which a study keeps each batch it has finished, so that it can be killed and go on.

`manifest.json` says of which study the batches are, and how it is divided; `batch-00000012` is a SHA-256 and then a
NumPy archive of one batch. Every file is written beside its place and moved there when it is complete.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from warnings import warn

import numpy as np

from proprotor.arrays import Array
from proprotor.errors import InputError
from proprotor.output_file import write_whole

_FORMAT = 1
_MANIFEST = "manifest.json"
_DIGEST = hashlib.sha256().digest_size


class CorruptBatch(Exception):
    """A stored batch that is not what was written."""


class Checkpoint:
    """The batches of one study in one folder.

    Parameters
    ----------
    folder : path
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)

    def open(self, identity: Mapping[str, str], division: Mapping[str, Any]) -> dict[str, Any]:
        """Begin, or go on with what is there.

        Parameters
        ----------
        identity : mapping of str
            A fingerprint of everything that the results depend on, by name.
        division : mapping
            How the study is divided into batches.

        Returns
        -------
        dict
            The division the study was begun with.

        Raises
        ------
        InputError
            When the folder holds another study, or cannot be used.
        """
        place = self.folder / _MANIFEST
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            begun = place.exists()
            if not begun and any(self.folder.glob("[!.]*")):
                raise InputError(
                    "checkpoint", self.folder, "must be an empty folder, or that of a study begun before"
                )
            for unfinished in self.folder.glob(".*.tmp"):  # of a study that was killed
                unfinished.unlink()
            if not begun:
                manifest = {"format": _FORMAT, "identity": dict(identity), "division": dict(division)}
                write_whole(place, lambda file: file.write(json.dumps(manifest, indent=1).encode()))
                return dict(division)
            manifest = json.loads(place.read_text(encoding="utf-8"))
            stored, begun_with = manifest["identity"], dict(manifest["division"])
        except InputError:
            raise
        except OSError as error:
            raise InputError(
                "checkpoint", self.folder, f"cannot be used ({error.strerror or error})"
            ) from None
        except (ValueError, KeyError, TypeError):
            raise InputError(
                "checkpoint", place, "cannot be read: delete the folder to begin again"
            ) from None
        differ = [name for name in identity if stored.get(name) != identity[name]]
        if manifest.get("format") != _FORMAT or differ:
            what = ", ".join(differ) or "its format"
            rule = f"holds another study (different: {what}); give another folder, or delete this one"
            raise InputError("checkpoint", self.folder, rule)
        return begun_with

    def save(self, number: int, found: Mapping[str, Array]) -> None:
        """Keep a finished batch."""
        content = io.BytesIO()
        arrays: dict[str, Any] = {name: _plain(array) for name, array in found.items()}
        np.savez(content, **arrays)
        payload = content.getbuffer()

        def write(file: Any) -> None:
            file.write(hashlib.sha256(payload).digest())
            file.write(payload)
            file.flush()
            os.fsync(file.fileno())

        write_whole(self._place(number), write)

    def load(self, number: int) -> dict[str, Array] | None:
        """A batch kept before, None where there is none.

        Raises
        ------
        CorruptBatch
            When the file is not what was written.
        """
        try:
            content = self._place(number).read_bytes()
        except FileNotFoundError:
            return None
        digest, payload = content[:_DIGEST], memoryview(content)[_DIGEST:]
        if hashlib.sha256(payload).digest() != digest:
            raise CorruptBatch(str(self._place(number)))
        with np.load(io.BytesIO(payload), allow_pickle=False) as stored:
            return {name: _as_objects(stored[name]) for name in stored.files}

    def finished(self, count: int) -> Iterator[tuple[int, dict[str, Array]]]:
        """The batches kept before, of a study of so many; one that is damaged is told, removed and left out."""
        for number in range(count):
            try:
                found = self.load(number)
            except CorruptBatch as error:
                warn(f"{error} is damaged: the batch is computed again", stacklevel=2)
                self._place(number).unlink()
                continue
            if found is not None:
                yield number, found

    def _place(self, number: int) -> Path:
        return self.folder / f"batch-{number:08d}"

    @contextmanager
    def held(self) -> Iterator[None]:
        """Keep other processes from the folder; the hold ends with the process, however it ends."""
        try:
            import fcntl
        except ImportError:  # Windows: two studies in one folder overwrite each other with the same results
            yield
            return
        with (self.folder / ".held").open("w") as file:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                raise InputError("checkpoint", self.folder, "is in use by a study that is running") from None
            yield


def _plain(array: Array) -> Array:
    """Texts with a fixed width, which need no pickle."""
    return array.astype(str) if array.dtype == object else array


def _as_objects(array: Array) -> Array:
    return array.astype(object) if array.dtype.kind == "U" else array
