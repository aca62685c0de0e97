"""A folder in which a study keeps each finished batch, so that a study that was killed can go on.

The lock `.held` keeps other studies from the folder while one is running; only the study that holds the lock reads,
writes or removes files. `manifest.json` names the study of the batches, and how the study is divided; `batch-00000012`
is a SHA-256 and then a NumPy archive of one batch. Every file is written beside its place and moved there when it is
complete. The SHA-256 covers the study and the batch's number too, so that a batch of another study is never taken for
one of this study.
"""

from __future__ import annotations

import hashlib
import io
import json
import logging
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from warnings import warn

import numpy as np

from proprotor.errors import InputError
from proprotor.files.output import write_whole
from proprotor.typing import Array

_FORMAT = 3
_CODES = " codes"  # after the name of a text: which of its different values stands in each place
_MANIFEST, _LOCK = "manifest.json", ".held"
_log = logging.getLogger(__name__)
_DIGEST = hashlib.sha256().digest_size


class Checkpoint:
    """The batches of one study in one folder.

    Parameters
    ----------
    folder : path
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        self._study = b""  # identity and division of the study of the batches

    @contextmanager
    def open(self, identity: Mapping[str, str], division: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
        """Hold the folder, and begin a study in it or go on with the batches of a study that was killed.

        The folder is free again at the end of the ``with`` block, or when the process ends before.

        Parameters
        ----------
        identity : mapping of str
            Everything that the results depend on, by name: a fingerprint, or the text itself.
        division : mapping
            How the study is divided into batches.

        Yields
        ------
        dict
            The division the study was begun with.

        Raises
        ------
        InputError
            When the folder holds another study, is in use by a running study, or cannot be used.
        """
        with self._hold():
            self._check_ours()
            division = self._begun(identity, division)
            self._study = json.dumps([dict(identity), division], sort_keys=True).encode()
            yield division

    def begun_with(self, part: str) -> str:
        """Return a part of the identity with which a study in the folder was begun; empty without one."""
        try:
            manifest = json.loads((self.folder / _MANIFEST).read_text(encoding="utf-8"))
            return str(manifest["identity"].get(part, ""))
        except (OSError, ValueError, KeyError, TypeError, AttributeError):  # `open` says what is wrong
            return ""

    @contextmanager
    def _hold(self) -> Iterator[None]:
        """Keep all other threads and processes from the folder."""
        from filelock import FileLock, Timeout  # here, because most studies keep nothing

        lock = FileLock(self.folder / _LOCK, timeout=0)
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            self._check_ours()  # before the lock is put there
            lock.acquire()
        except Timeout:
            raise InputError("checkpoint", self.folder, "is in use by a study that is running") from None
        except (OSError, NotImplementedError) as error:
            raise self._unusable(error) from None
        try:
            yield
        finally:
            lock.release()

    def _check_ours(self) -> None:
        """Refuse a folder with files and without a manifest.

        The files are looked for first: a study that begins meanwhile writes its manifest before any other file.
        """
        if any(self.folder.glob("[!.]*")) and not (self.folder / _MANIFEST).exists():
            rule = "must be an empty folder, or that of a study begun before"
            raise InputError("checkpoint", self.folder, rule)

    def _begun(self, identity: Mapping[str, str], division: Mapping[str, Any]) -> dict[str, Any]:
        """Return the division in the manifest; write the manifest first if there is none."""
        place = self.folder / _MANIFEST
        manifest = {"format": _FORMAT, "identity": dict(identity), "division": dict(division)}
        try:
            for unfinished in self.folder.glob(".*.tmp"):  # of a study that was killed
                unfinished.unlink()
            if not place.exists():
                write_whole(place, lambda file: file.write(json.dumps(manifest, indent=1).encode()))
            manifest = json.loads(place.read_text(encoding="utf-8"))
            stored, begun_with = manifest["identity"], dict(manifest["division"])
            differ = [name for name in identity if stored.get(name) != identity[name]]
        except OSError as error:
            raise self._unusable(error) from None
        except (ValueError, KeyError, TypeError, AttributeError):
            rule = "cannot be read: delete the folder to begin again"
            raise InputError("checkpoint", place, rule) from None
        if manifest.get("format") != _FORMAT or differ:
            what = ", ".join(differ) or "its format"
            rule = f"holds another study (different: {what}); give another folder, or delete this one"
            raise InputError("checkpoint", self.folder, rule)
        return begun_with

    def _unusable(self, error: Exception) -> InputError:
        reason = getattr(error, "strerror", None) or error
        return InputError("checkpoint", self.folder, f"cannot be used ({reason})")

    def save(self, number: int, found: Mapping[str, Array]) -> None:
        """Keep a finished batch."""
        content = io.BytesIO()
        arrays = {name: array for name, array in found.items() if array.dtype != object}
        for name in found.keys() - arrays.keys():
            # Each text once: all have the width of the longest in the file, which needs no pickle.
            values, codes = np.unique(found[name].astype(str), return_inverse=True)
            arrays |= {name: values, f"{name}{_CODES}": codes.reshape(found[name].shape).astype(np.int32)}
        np.savez(content, **arrays)  # type: ignore[arg-type]
        payload = content.getbuffer()
        digest = self._digest(number, payload)
        write_whole(self._place(number), lambda file: file.writelines((digest, payload)))
        _log.info("kept batch %d in %s", number, self.folder)

    def _digest(self, number: int, payload: Any) -> bytes:
        digest = hashlib.sha256(self._study)
        digest.update(number.to_bytes(8, "big"))
        digest.update(payload)
        return digest.digest()

    def finished(self, count: int) -> Iterator[tuple[int, dict[str, Array]]]:
        """Yield the kept batches among the first `count`, with their numbers.

        A batch whose bytes are not the ones that this study has written is removed and left out, with a warning.
        """
        for number in range(count):
            place = self._place(number)
            if not place.exists():
                continue
            content = place.read_bytes()
            digest, payload = content[:_DIGEST], memoryview(content)[_DIGEST:]
            if self._digest(number, payload) == digest:
                with np.load(io.BytesIO(payload), allow_pickle=False) as stored:
                    arrays = dict(stored)
                _log.info("found batch %d of %d in %s", number, count, self.folder)
                yield number, _with_texts(arrays)
            else:
                warn(f"{place} is damaged: the batch is computed again", stacklevel=2)
                place.unlink()

    def _place(self, number: int) -> Path:
        return self.folder / f"batch-{number:08d}"


def _with_texts(stored: Mapping[str, Array]) -> dict[str, Array]:
    """Return stored arrays, the texts among them in their places."""
    texts = [name for name in stored if f"{name}{_CODES}" in stored]
    plain = {name: array for name, array in stored.items() if not name.endswith(_CODES)}
    return plain | {name: stored[name].astype(object)[stored[f"{name}{_CODES}"]] for name in texts}
