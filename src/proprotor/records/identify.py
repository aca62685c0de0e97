"""Frequency and damping of the modes of a record by one of three methods, as a dataset."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from proprotor.errors import InputError, check_known
from proprotor.records.least_squares import Fit, decaying_modes, too_close, too_few_cycles
from proprotor.records.logarithmic_decrement import logarithmic_decrement
from proprotor.records.moving_block import moving_block
from proprotor.records.record import Record
from proprotor.records.root_errors import Root
from proprotor.typing import Dataset
from proprotor.units import values_in_si

METHODS = ("least squares", "logarithmic decrement", "moving block")
_LEAST_SQUARES, _DECREMENT, _BLOCK = METHODS


def identify(
    record: Record,
    method: str = "least squares",
    *,
    channels: Sequence[str] | None = None,
    between: Any = None,
    frequency: Any = None,
    modes: int | None = None,
    block: Any = None,
) -> Dataset:
    """Return frequency and damping of the modes in the record of a free decay, with standard errors.

    Parameters
    ----------
    record : Record
        See `read_record`.
    method : "least squares", "logarithmic decrement" or "moving block"
        The first finds several modes in several channels at once; the others one mode in one channel.
    channels : sequence of str, optional
        Channels to take; all by default.
    between : (start, stop), optional
        Times in s, or text such as "1.2 s": the part of the record in which the motion decays freely.
    frequency : float in rad/s, text such as "3 Hz", or pint quantity, optional
        Near which the mode is sought; by default all modes, or of the methods for one mode where the channel is
        strongest.
    modes : int, optional
        Of least squares: how many modes there are, by default as many as the record tells apart from noise.
    block : float in s, text, or pint quantity, optional
        Of the moving block: its length, half of the record by default.

    Returns
    -------
    xarray.Dataset
        frequency (mode,), damped, rad/s; damping_ratio; frequency_error and damping_error, standard errors; warning
        (mode,), why a number is doubtful. Of least squares also amplitude (mode, channel) at the start of the record,
        and noise (channel,), in the units of the channels. Errors follow from the noise beside the modes, as if it were
        white; they say nothing of a damping that depends on the amplitude. Attributes: record, method, start and
        duration (s).

    Raises
    ------
    InputError
        For an unknown method or channel, a record that is too short or too coarse for the mode, a channel that stands
        still, and in the methods for one mode for a channel that does not decay evenly, such as a beat of two modes.
    """
    check_known("method", method, METHODS, "method")
    part = record.part(channels, between)
    near = None if frequency is None else _one("frequency", frequency, "rad/s")
    _check_combinations(method, part, modes, block)
    if method == _LEAST_SQUARES:
        return _of_fit(part, decaying_modes(part, modes, near), near)
    if method == _DECREMENT:
        root = logarithmic_decrement(part, near)
    else:
        root = moving_block(part, near, None if block is None else _one("block", block, "s"))
    return _dataset(part, method, [root], [""])


def _one(field: str, value: Any, unit: str) -> float:
    """Return one number above zero, SI."""
    found = values_in_si(value, unit, field).reshape(-1)
    if len(found) != 1 or not np.isfinite(found[0]) or found[0] <= 0:
        raise InputError(field, value, "must be one number above zero")
    return float(found[0])


def _check_combinations(method: str, record: Record, modes: Any, block: Any) -> None:
    """Refuse what does not go with a method."""
    for field, value, own in (("modes", modes, _LEAST_SQUARES), ("block", block, _BLOCK)):
        if value is not None and method != own:
            raise InputError(field, value, f'goes with the method "{own}"')
    if modes is not None and (not isinstance(modes, int | np.integer) or modes < 1):
        raise InputError("modes", modes, "must be a whole number above zero")
    if method != _LEAST_SQUARES and len(record.channels) > 1:
        rule = f'must be one channel for the method "{method}"'
        raise InputError("channels", ", ".join(record.channels), rule)


def _of_fit(record: Record, fit: Fit, near: float | None) -> Dataset:
    """Return the dataset of a fit; of the mode nearest to a frequency alone if one is given."""
    found = _dataset(record, _LEAST_SQUARES, fit.roots, [*_doubts(record, fit)])
    size = np.abs(fit.amplitude)
    found["amplitude"] = ("mode", "channel"), size, {"units": "channel_unit"}
    found["noise"] = "channel", fit.noise, {"units": "channel_unit"}
    found = found.assign_coords(channel=list(record.channels), channel_unit=("channel", list(record.units)))
    if near is None:
        return found
    return found.isel(mode=[int(np.argmin(np.abs(found.frequency.values - near)))])


def _doubts(record: Record, fit: Fit) -> Iterator[str]:
    """Yield what makes each mode of a fit doubtful."""
    close, few = too_close(fit.roots, record.duration), too_few_cycles(fit.roots, record.duration)
    for near, short in zip(close, few, strict=True):
        doubts = {
            "another mode is closer than one over the record's duration": near,
            "the record holds less than three cycles": short,
            "the noise is not white, so that errors may be larger": fit.coloured,
        }
        yield "; ".join(text for text, holds in doubts.items() if holds)


def _dataset(record: Record, method: str, roots: Sequence[Root], warnings: Sequence[str]) -> Dataset:
    import xarray  # here, because it takes long to import

    error = "standard error"
    return xarray.Dataset(
        {
            "frequency": (
                "mode",
                [root.frequency for root in roots],
                {"units": "rad/s", "long_name": "damped frequency"},
            ),
            "frequency_error": (
                "mode",
                [root.frequency_error for root in roots],
                {"units": "rad/s", "long_name": error},
            ),
            "damping_ratio": (
                "mode",
                [root.damping_ratio for root in roots],
                {"units": "1", "long_name": "fraction of critical damping"},
            ),
            "damping_error": (
                "mode",
                [root.damping_error for root in roots],
                {"units": "1", "long_name": error},
            ),
            "warning": ("mode", np.array(warnings, dtype=str), {"long_name": "what makes a number doubtful"}),
        },
        attrs={
            "record": record.name,
            "method": method,
            "start": float(record.time[0]),
            "duration": record.duration,
        },
    )
