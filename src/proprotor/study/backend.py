"""What computes a study: one backend for all of its batches, also for those of a study that was killed and goes on."""

from __future__ import annotations

import platform
from collections.abc import Mapping
from typing import Any

from proprotor.case import Case
from proprotor.compiled.library import why_not
from proprotor.errors import InputError
from proprotor.rotor.options import CHOICES, parse_options
from proprotor.study.checkpoint import Checkpoint

_COMPILED = "compiled"


def backend_of(case: Case, options: Mapping[str, Any], kept: Checkpoint | None) -> str:
    """Return what computes a study, "numpy" or "compiled"; the library of compiled functions is then built.

    ``backend="auto"`` goes on with what began the study in a checkpoint, and any other choice must be what began it.

    Parameters
    ----------
    case : Case
    options : mapping
        As the caller gave them.
    kept : Checkpoint, optional

    Raises
    ------
    InputError
        When the study in the checkpoint was begun with another backend, or with one that is not here; for options that
        `proprotor.rotor.options.parse_options` refuses.
    """
    given = options.get("backend", CHOICES["backend"][0])
    begun = "" if kept is None else kept.begun_with("backend")
    if kept is not None and begun and given != begun:
        if given != "auto":
            rule = f'must be "{begun}", with which the study in {kept.folder} was begun'
            raise InputError("backend", given, rule)
        if begun == _COMPILED and why_not():
            rule = (
                f"holds a study begun with the compiled functions, of which there are none here: {why_not()}"
            )
            raise InputError("checkpoint", kept.folder, rule)
        return begun
    return parse_options(case.model_options(options)).backend


def check_backend(options: Mapping[str, Any]) -> None:
    """Raise an `InputError` unless this process has the backend of a study.

    Without this check every design would have the missing compiler as its reason.
    """
    if options.get("backend") == _COMPILED and why_not():
        rule = f"cannot go on with the study, which the compiled functions began: {why_not()}"
        raise InputError("workers", platform.node(), rule)
