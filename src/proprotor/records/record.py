"""Records: channels over time, sampled evenly, from arrays or from a CSV file.

::

    time [s], wing beam [N*m], wing chord [N*m]
    0.000,    812.4,           -31.0
    0.002,    815.1,           -29.7

The column ``time`` has a unit; every other column is a channel. `proprotor.files.csv_columns` has the rules of all such
files.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from proprotor.errors import InputError, check_known
from proprotor.files.csv_columns import Fault, factor_of, head_of, number_in, table_of
from proprotor.files.text import read_text
from proprotor.typing import Array
from proprotor.units import values_in_si

_LARGEST = 200_000_000  # bytes
_FEWEST = 16  # samples
_UNEVEN = 0.1  # of a step: what a sample may be early or late


@dataclass(frozen=True, eq=False)
class Record:
    """Channels over time, sampled evenly.

    Parameters
    ----------
    time : array_like, shape (samples,)
        s, in even steps.
    values : array_like, shape (samples, channels) or (samples,)
        In any unit: frequency and damping do not depend on it.
    channels : sequence of str
        A name for each channel, all different.
    units : sequence of str, optional
        A unit for each channel, to be shown; "" where there is none.
    name : str
        Where the record comes from.

    Raises
    ------
    InputError
        For sizes that differ, fewer than 16 samples, uneven steps, values that are not finite, or a name twice.
    """

    time: Array
    values: Array
    channels: Sequence[str]
    units: Sequence[str] = ()
    name: str = "record"

    def __post_init__(self) -> None:
        time, values = np.asarray(self.time, dtype=float), np.asarray(self.values, dtype=float)
        values = values[:, None] if values.ndim == 1 else values
        names, units = tuple(self.channels), tuple(self.units) or ("",) * len(self.channels)
        if time.ndim != 1 or len(time) < _FEWEST:
            raise InputError("time", f"array of shape {time.shape}", f"must be at least {_FEWEST} samples")
        if values.shape != (len(time), len(names)) or not names:
            rule = f"must have a row for each of {len(time)} samples and a column for each of {len(names)} channels"
            raise InputError("values", f"array of shape {values.shape}", rule)
        if len(set(names)) < len(names) or len(units) != len(names):
            raise InputError(
                "channels", ", ".join(names), "must be different names, each with a unit if any has"
            )
        if not np.isfinite(values).all():
            sample, channel = np.argwhere(~np.isfinite(values))[0]
            raise InputError(
                names[channel], values[sample, channel], f"must be finite, at {time[sample]:g} s too"
            )
        _check_even(time)
        for field, own in (("time", time), ("values", values), ("channels", names), ("units", units)):
            object.__setattr__(self, field, own)

    @property
    def step(self) -> float:
        """Time between two samples, s."""
        return float((self.time[-1] - self.time[0]) / (len(self.time) - 1))

    @property
    def duration(self) -> float:
        """Time that the samples stand for, s: one step each."""
        return self.step * len(self.time)

    def part(self, channels: Sequence[str] | None = None, between: Any = None) -> Record:
        """Return some of the channels, in a part of the time.

        Parameters
        ----------
        channels : sequence of str, optional
            Names; all by default.
        between : (start, stop), optional
            Times in s, text such as "1.2 s", or pint quantities; the whole record by default.

        Returns
        -------
        Record

        Raises
        ------
        InputError
            For an unknown channel, and for times that hold too few samples.
        """
        wanted = tuple(self.channels) if channels is None else tuple(channels)
        for name in wanted:
            check_known("channels", name, self.channels, "channel")
        columns = [self.channels.index(name) for name in wanted]
        start, stop = (-np.inf, np.inf) if between is None else _ends(between)
        kept = (self.time >= start) & (self.time <= stop)
        if kept.sum() < _FEWEST:
            have = f"the record has {self.time[0]:g} to {self.time[-1]:g} s"
            raise InputError(
                "between", f"{start:g} to {stop:g} s", f"must hold at least {_FEWEST} samples; {have}"
            )
        units = tuple(self.units[column] for column in columns)
        return Record(self.time[kept], self.values[kept][:, columns], wanted, units, self.name)


def _ends(between: Any) -> tuple[float, float]:
    if not isinstance(between, Sequence) or isinstance(between, str) or len(between) != 2:
        raise InputError("between", between, "must be two times, a start and a stop")
    ends = [values_in_si(end, "s", "between").reshape(-1) for end in between]
    if any(len(end) != 1 for end in ends):
        raise InputError("between", between, "must be two times, a start and a stop")
    return float(ends[0][0]), float(ends[1][0])


def _check_even(time: Array) -> None:
    """Refuse time that does not run in even steps."""
    step = (time[-1] - time[0]) / (len(time) - 1)
    if not (np.isfinite(time).all() and step > 0):
        raise InputError("time", None, "must be finite and rise")
    off = np.abs(time - time[0] - step * np.arange(len(time)))
    if off.max() > _UNEVEN * step:
        late = time[int(np.argmax(off))]
        raise InputError(
            "time", f"{late:g} s", f"must run in even steps of {step:g} s; sample the record anew"
        )


def read_record(path: str | os.PathLike[str], field: str = "record") -> Record:
    """Return the record of a CSV file.

    Parameters
    ----------
    path : str or path
    field : str
        Name of the input, for messages.

    Returns
    -------
    Record

    Raises
    ------
    InputError
        When the file cannot be read or is malformed: one line with the file, the line and column in it and the rule.
    """
    name = Path(path).name
    try:
        heads, rows = table_of(read_text(Path(path), field, name, _LARGEST))
        head = head_of(heads, "time")
        factor = factor_of(head, "s")
        others = [other for other in heads if other is not head]
        lines = [[number_in(number, cells, column) for column in (head, *others)] for number, cells in rows]
        table = np.array(lines).reshape(-1, 1 + len(others))
        names, units = ([getattr(other, part) for other in others] for part in ("name", "unit"))
        return Record(table[:, 0] * factor, table[:, 1:], names, units, name)
    except Fault as fault:
        raise InputError(field, name, str(fault)) from None
    except InputError as error:
        raise InputError(field, name, f"{error.field}: {error.rule}") from None
