"""The accessor ``.proprotor`` of `xarray.Dataset`: the pictures, tables and files that a result offers."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import partial
from importlib import import_module
from typing import Any

from proprotor.errors import InputError, unknown_name
from proprotor.exchange.netcdf import save_results
from proprotor.files.json_text import json_text
from proprotor.files.output import check_place, write_whole
from proprotor.model import stamp
from proprotor.model.doubts import map_doubts, reasons_for_doubt
from proprotor.tables.boundary_table import boundary_records, input_of
from proprotor.tables.csv_text import csv_of
from proprotor.tables.envelope_table import envelope_records
from proprotor.tables.study_table import StudyTable
from proprotor.tables.sweep_table import SweepTable
from proprotor.typing import Axes, Dataset, Figure

# Kinds of results: a variable or an attribute that no other kind has, and the plots, the usual one first.
_KINDS = {
    "turbulence": ("gust_psd", ("plot_gust_spectra",)),
    "single gusts": ("gust", ("plot_time_response",)),
    "time response": ("input_over_time", ("plot_time_response",)),
    "modes beside a test": ("pair_mac", ("plot_mac",)),
    "study": ("study", ("plot_distribution",)),
    "indices": ("first_half_interval", ("plot_sobol",)),
    "distribution": ("at_least", ()),
    "growth constraint": ("constraint", ()),
    "envelope": ("damping_onset", ("plot_envelope",)),
    "sensitivity": ("derivative", ("plot_sensitivity",)),
    "attribution": ("contribution", ("plot_attribution",)),
    "stability map": ("boundary_eigenvalue", ("plot_stability_map",)),
    "margins": ("disk_margin", ("plot_margins",)),
    "boundaries": ("first_branch", ("plot_boundary_against",)),
    "sweep": (
        "tracking_quality",
        (
            *("plot_sweep", "plot_frequency", "plot_damping", "plot_root_locus"),
            *("plot_participation", "plot_campbell"),
        ),
    ),
}
_ROTOR_SPEED = "operation.rotor_speed"  # over which a Campbell diagram is drawn


class Results:
    """Pictures, tables and files of a result of this package: ``results.proprotor.plot()``.

    The plots of `plots` are methods, each with the arguments of the function of that name in `proprotor.plots`.

    Parameters
    ----------
    results : xarray.Dataset
    """

    def __init__(self, results: Dataset) -> None:
        self._results = results

    def __repr__(self) -> str:
        """Return the kind of the result, and what it offers."""
        plots = ", ".join(self.plots) or "no plot"
        return f"{self.kind}: {plots}. {stamp.line(self._results.attrs)}".rstrip()

    @property
    def kind(self) -> str:
        """What the result is: "sweep", "study", "stability map", "boundaries", "sensitivity" and so on."""
        for kind, (mark, _) in _KINDS.items():
            if mark in self._results.data_vars or mark in self._results.attrs:
                return kind
        return "other"

    @property
    def plots(self) -> tuple[str, ...]:
        """The names of the plots that the result offers, the usual one first."""
        found = _KINDS[self.kind][1] if self.kind in _KINDS else ()
        over_rotor_speed = _ROTOR_SPEED in self._results.dims
        return tuple(name for name in found if name != "plot_campbell" or over_rotor_speed)

    @property
    def doubts(self) -> list[str]:
        """Sentences on what makes numbers of the result doubtful."""
        if self.kind == "stability map":
            return list(map_doubts(self._results))
        warnings = [name for name in self._results.data_vars if str(name).endswith("warning")]
        texts = [str(text) for name in warnings for text in self._results[name].values.ravel()]
        own = str(self._results.attrs.get("doubts", ""))
        return [*reasons_for_doubt(texts), *filter(None, [own])]

    def __getattr__(self, name: str) -> Callable[..., Axes | Figure]:
        """Return a plot of `proprotor.plots`, such as `plot_damping`, that takes its further arguments."""
        if not name.startswith("plot_"):
            raise AttributeError(name)
        if name not in self.plots:
            raise AttributeError(unknown_name(name, self.plots, f"plot of a result of the kind {self.kind}"))
        return partial(getattr(import_module("proprotor.plots"), name), self._results)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.plots]

    def plot(self) -> Axes | Figure:
        """Draw the usual plot of the result, the first of `plots`.

        Returns
        -------
        matplotlib.axes.Axes or matplotlib.figure.Figure

        Raises
        ------
        InputError
            For a result without a plot, and as that plot.
        """
        if not self.plots:
            raise InputError("results", self.kind, "has no plot of its own")
        drawn: Axes | Figure = getattr(self, self.plots[0])()
        return drawn

    def records(self, *, rotor_speed: float | None = None, unit: str = "") -> list[dict[str, Any]]:
        """Return the result as a table: a record for each row, with units in the names.

        Parameters
        ----------
        rotor_speed : float, optional
            rad/s, of a sweep, for frequencies per revolution.
        unit : str
            Unit of the airspeeds of a sweep, or of the input of boundaries; "ktas" and the SI unit by default.

        Returns
        -------
        list of dict

        Raises
        ------
        InputError
            For a result that has no table, and a sweep without a rotor speed.
        """
        if self.kind == "study":
            return StudyTable(self._results).records()
        if self.kind == "boundaries":
            si = str(self._results[input_of(self._results)].attrs["units"])
            return boundary_records(self._results, unit or si)
        if self.kind == "envelope":
            return envelope_records(self._results)
        if self.kind != "sweep" or "airspeed" not in self._results.dims:
            rule = "has no table: a study, a sweep over airspeeds, boundaries against an input, an envelope have one"
            raise InputError("results", self.kind, rule)
        if rotor_speed is None:
            raise InputError(
                "rotor_speed", None, "must be given for a sweep, in rad/s: case.operation.rotor_speed"
            )
        return list(SweepTable(self._results, rotor_speed, unit or "ktas").records())

    def to_csv(
        self, path: str | os.PathLike[str], *, rotor_speed: float | None = None, unit: str = ""
    ) -> None:
        """Write `records` as CSV, below comments on the case and its options (pandas: ``comment="#"``).

        Parameters
        ----------
        path : str or path
            Ends in ``.csv``. A file that exists is replaced.
        rotor_speed : float, optional
            rad/s, as for `records`.
        unit : str
            As for `records`.

        Raises
        ------
        InputError
            As `records`, and for a path that cannot be written.
        OSError
            When the file cannot be written.
        """
        check_place(path, ".csv")
        records = self.records(rotor_speed=rotor_speed, unit=unit)
        content = csv_of(records, list(records[0]) if records else [], self._results.attrs)
        write_whole(path, lambda file: file.write(content))

    def to_json(
        self, path: str | os.PathLike[str], *, rotor_speed: float | None = None, unit: str = ""
    ) -> None:
        """Write the case, the options and `records` as JSON; of a study also its summary and what was asked.

        Parameters
        ----------
        path : str or path
            Ends in ``.json``. A file that exists is replaced.
        rotor_speed : float, optional
            rad/s, as for `records`.
        unit : str
            As for `records`.

        Raises
        ------
        InputError
            As `records`, and for a path that cannot be written.
        OSError
            When the file cannot be written.
        """
        check_place(path, ".json")
        if self.kind == "study":
            document = StudyTable(self._results).document()
        else:
            document = {
                **stamp.of(self._results.attrs),
                "records": self.records(rotor_speed=rotor_speed, unit=unit),
            }
        write_whole(path, lambda file: file.write(f"{json_text(document)}\n".encode()))

    def to_netcdf(self, path: str | os.PathLike[str]) -> None:
        """Write the result as netCDF with complex numbers in two parts, as `proprotor.save_results`.

        Parameters
        ----------
        path : str or path
            Ends in ``.nc``. A file that exists is replaced.
        """
        save_results(self._results, path)
