"""A sweep as a table: lines for a terminal, records for JSON and CSV, and sentences on what the table shows."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from proprotor.case import Case
from proprotor.model.doubts import doubtful_near, doubts_along, footnotes, marked, position
from proprotor.model.stamp import density_of
from proprotor.stability.mode_names import DOUBTFUL
from proprotor.tables.csv_text import csv_of
from proprotor.tables.sweep_summary import (
    UnstableRange,
    broad_modes,
    damped_frequency,
    damping_percent,
    growth_rate,
    modes_of_interest,
    unstable_ranges,
)
from proprotor.typing import Array, Dataset
from proprotor.units import KTAS, airspeed_unit, speed_factor

if TYPE_CHECKING:
    from rich.text import Text

CONVENTION = (
    "Frequency |Im s| per revolution (/rev); damping -Re s/|s| in percent of critical (%), "
    "negative and marked * where a mode is unstable."
)
_SPEED_WIDTH = 7
_MODE_WIDTH = 14


def heading(case: Case, varied: Collection[str] = ()) -> str:
    """Return the title of a case and its rotor speed, as they stand above its tables.

    The rotor speed is left out where it varies, and where the title has it.
    """
    title, speed = case.title or case.name, rotor_speed_in_words(case)
    return title if "operation.rotor_speed" in varied or speed in title else f"{title}, {speed}"


def rotor_speed_in_words(case: Case) -> str:
    """Return the rotor speed of a case in revolutions per minute, with the unit."""
    return f"{case.operation.rotor_speed * 30 / math.pi:.0f} rpm"


@dataclass(frozen=True, eq=False)
class SweepTable:
    """The numbers of a sweep in the units that people read.

    Parameters
    ----------
    sweep : xarray.Dataset
        Of `Case.sweep`.
    rotor_speed : float
        rad/s, for frequencies per revolution.
    unit : str
        Unit of airspeeds, such as "ktas" or "keas"; outputs name knots KTAS or KEAS.

    Raises
    ------
    InputError
        When the unit is not one of airspeed.
    """

    sweep: Dataset
    rotor_speed: float
    unit: str = KTAS

    def __post_init__(self) -> None:
        object.__setattr__(self, "unit", airspeed_unit(self.unit))

    @cached_property
    def factor(self) -> float:
        """The unit of airspeeds in m/s, true."""
        return float(speed_factor(self.unit, density_of(self.sweep.attrs), field="unit"))

    @cached_property
    def airspeed(self) -> Array:
        """Airspeed (airspeed,) in the unit, free of the rounding of conversion."""
        return np.array([float(f"{v:.10g}") for v in self.sweep.airspeed.values / self.factor])

    @cached_property
    def frequency(self) -> Array:
        """Frequency (airspeed, mode) per revolution."""
        return damped_frequency(self.sweep) / self.rotor_speed

    @cached_property
    def damping(self) -> Array:
        """Damping (airspeed, mode) in percent of critical."""
        return damping_percent(self.sweep)

    @cached_property
    def unstable(self) -> Array:
        """Whether a mode is unstable (airspeed, mode)."""
        return np.asarray(growth_rate(self.sweep) > 0)

    @cached_property
    def failed(self) -> Array:
        """Whether a point could not be analysed (airspeed,)."""
        return np.asarray(self.sweep.reason.values != "")

    def lines(self, width: int = 80, all_modes: bool = False) -> Iterator[Text]:
        """Yield the lines of one or more tables no wider than `width`, a row for each airspeed."""
        from rich.text import Text  # here, because rich takes long to import

        fit = max(1, (width - _SPEED_WIDTH - 1) // _MODE_WIDTH)
        shown = range(len(self.sweep.mode)) if all_modes else self._of_interest(fit)
        for modes in self._side_by_side(shown, width):
            yield from self._table(modes, width)
        left_out = [str(name) for i, name in enumerate(self.sweep.mode.values) if i not in shown]
        if left_out and not self.failed.all():
            more = f"{len(left_out)} more modes (--all-modes): {', '.join(left_out)}."
            yield from map(Text, (*textwrap.wrap(more, width), ""))

    def doubts(self) -> list[str]:
        """Return a sentence on each warning of single airspeeds, whose rows have a question mark."""
        return list(footnotes(doubts_along(self.airspeed, self.sweep.warning.values), self.unit))

    def mixed(self) -> str:
        """Return a sentence on modes whose names say little at some airspeeds; empty without such modes."""
        with np.errstate(invalid="ignore"):
            low = self.sweep.share.values < DOUBTFUL
        mixed = []
        for place in np.flatnonzero(low.any(axis=0)):
            speeds = self.airspeed[low[:, place]]
            first, last = (f"{position(end)} {self.unit}" for end in (speeds.min(), speeds.max()))
            where = f"at {first}" if len(speeds) == 1 else f"from {first} to {last}"
            mixed.append(f"{self.sweep.mode.values[place]} {where}")
        if not mixed:
            return ""
        return f"Mixed, less than a third of the mode is what its name says: {', '.join(mixed)}."

    def _of_interest(self, count: int) -> list[int]:
        """Return unstable modes, the support's modes and other modes that move it most, in the order of the sweep."""
        if self.failed.all():
            return []
        broad = np.isin(self.sweep.mode.values, list(broad_modes(self.sweep)))
        return modes_of_interest(self.sweep, max(count, int(broad.sum())))

    def _side_by_side(self, shown: Sequence[int], width: int) -> Iterator[list[int]]:
        """Yield the modes of each table: as many as stand side by side, and none where there is no mode."""
        table: list[int] = []
        used = _SPEED_WIDTH + 1
        for mode in shown:
            if table and used + self._width(mode) > width:
                yield table
                table, used = [], _SPEED_WIDTH + 1
            table.append(mode)
            used += self._width(mode)
        yield table

    def _width(self, mode: int) -> int:
        """Return the width of the columns of a mode, with the space behind: its name stands on two lines at most."""
        return max(_MODE_WIDTH, *(len(line) + 1 for line in _on_two_lines(str(self.sweep.mode.values[mode]))))

    def _table(self, modes: Sequence[int], width: int) -> Iterator[Text]:
        from rich.text import Text

        names = [_on_two_lines(str(self.sweep.mode.values[i])) for i in modes]
        widths = [self._width(mode) for mode in modes]
        for line in zip(*names, strict=True):
            cells = "".join(f"{cell:>{wide - 1}} " for cell, wide in zip(line, widths, strict=True))
            if cells.strip():
                yield Text(" " * (_SPEED_WIDTH + 1) + cells, "bold")
        units = "".join(f"{'/rev':>{wide - 8}}{'%':>7} " for wide in widths)
        yield Text(f"{self.unit:>{_SPEED_WIDTH}} {units}", "dim")
        for point in range(len(self.airspeed)):
            yield from self._failure(point, width) if self.failed[point] else [self._row(point, modes)]
        yield Text("")

    def _failure(self, point: int, width: int) -> Iterator[Text]:
        """Yield the lines of an airspeed that could not be analysed, with the reason."""
        from rich.text import Text

        lines = textwrap.wrap(
            str(self.sweep.reason.values[point]), max(width - _SPEED_WIDTH - 2, _MODE_WIDTH)
        )
        for place, line in enumerate(lines):
            speed = f"{self.airspeed[point]:g}" if not place else ""
            yield Text(f"{speed:>{_SPEED_WIDTH}}").append(f"  {line}", "yellow")

    def _row(self, point: int, modes: Sequence[int]) -> Text:
        from rich.text import Text

        row = Text(f"{self.airspeed[point]:>{_SPEED_WIDTH}g}")
        row.append(marked("", self.sweep.warning.values[point]) or " ", "yellow")
        for mode in modes:
            frequency, damping = self.frequency[point, mode], self.damping[point, mode]
            mark, style = ("*", "bold red") if self.unstable[point, mode] else (" ", "")
            row.append(f"{frequency:>{self._width(mode) - 8}.3f}{damping:>7.2f}{mark}", style)
        return row

    def verdict(self) -> list[str]:
        """Return a sentence on each range of airspeed in which a mode is unstable, or that no mode is unstable."""
        if self.failed.all():
            return ["No airspeed could be analysed."]
        ranges = sorted(unstable_ranges(self.sweep), key=lambda found: found.start)
        stable = "No mode is unstable at the airspeeds analysed."
        return [self._sentence(found) for found in ranges] or [stable]

    def _sentence(self, found: UnstableRange) -> str:
        along, ends = (self.sweep.airspeed.values, self.sweep.warning.values), (found.start, found.stop)
        start, stop = (marked(self._rounded(at), doubtful_near(*along, at)) for at in ends)
        since = f"from about {start} (interpolated)"
        if found.open_start:
            since = f"at {self.airspeed[~self.failed][0]:g} {self.unit}, the lowest airspeed analysed"
        until = "" if found.open_stop else f", stable again from about {stop} (interpolated)"
        return f"{found.mode}: unstable {since}{until}"

    def _rounded(self, speed: float) -> str:
        """Return a speed with its unit, to three digits and at least to whole units."""
        value = speed / self.factor
        digits = 0 if value == 0 else max(0, 2 - math.floor(math.log10(value)))
        return f"{value:.{digits}f} {self.unit}"

    def records(self) -> Iterator[dict[str, Any]]:
        """Yield a record for each airspeed and mode, with units in the names; None at failed points.

        Where every airspeed failed there is no mode, and each airspeed has one record without mode.
        """
        eigenvalue, modes = self.sweep.eigenvalue.values, len(self.sweep.mode)
        columns = {
            "mode": np.broadcast_to(self.sweep.mode.values, eigenvalue.shape),
            "share of its motion": self.sweep.share.values,
            "branch": self.sweep.branch.values,
            "frequency (per rev)": self.frequency,
            "damping (% of critical)": self.damping,
            "Re s (rad/s)": eigenvalue.real,
            "Im s (rad/s)": np.where(np.isnan(eigenvalue), np.nan, eigenvalue.imag),
        }
        for i in range(len(self.airspeed)):
            for j in range(modes) if modes else [None]:
                yield {
                    f"airspeed ({self.unit})": self.airspeed[i].item(),
                    "airspeed (m/s)": self.sweep.airspeed.values[i].item(),
                    **{name: None if j is None else _plain(part[i, j]) for name, part in columns.items()},
                    "warning": str(self.sweep.warning.values[i]),
                    "failure": str(self.sweep.reason.values[i]),
                }

    def csv(self) -> bytes:
        """Return `records` as CSV in UTF-8, see `proprotor.tables.csv_text`; empty cells at failed points."""
        records = list(self.records())
        return csv_of(records, list(records[0]), self.sweep.attrs)


def _on_two_lines(name: str) -> tuple[str, str]:
    """Return the name of a mode on two lines, the shorter the better; the upper line is empty where one suffices."""
    words = name.split()
    if len(name) < _MODE_WIDTH or len(words) == 1:
        return "", name
    ways = [(" ".join(words[:place]), " ".join(words[place:])) for place in range(1, len(words))]
    return min(ways, key=lambda way: max(map(len, way)))


def _plain(entry: Any) -> float | str | None:
    """Return a number or a text of a record; None for an empty text or a number that is not finite."""
    if isinstance(entry, str):
        return str(entry) or None
    return float(entry) if np.isfinite(entry) else None
