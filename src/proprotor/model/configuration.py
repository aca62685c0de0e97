"""The record of a configuration: a rotor, its operation and its support, with the source of every number."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from proprotor.control.control_loop import ControlLoop, loop_text
from proprotor.datum import Datum
from proprotor.errors import InputError
from proprotor.model.closed_loop import close_loops
from proprotor.model.designs import designs
from proprotor.model.floquet import checked
from proprotor.model.linear_model import LinearModel, range_text
from proprotor.model.mount import mount
from proprotor.model.pair import mount_pair
from proprotor.model.provenance import reservations
from proprotor.model.rotor_model import model_of, rotor_model
from proprotor.model.side import Side
from proprotor.model.wing_lift_lag import with_wing_lag
from proprotor.rotor.blade_frequencies import BladeFrequencies
from proprotor.rotor.drive_train import DriveTrain
from proprotor.rotor.operation import Operation
from proprotor.rotor.options import parse_options
from proprotor.rotor.rotor import Rotor
from proprotor.support.airframe import Airframe
from proprotor.support.normal_modes import NormalModes

_RPM = math.pi / 30  # rad/s


@dataclass(frozen=True, eq=False, repr=False)
class Configuration:
    """A rotor, its operation and its support.

    Attributes
    ----------
    name, title, description : str
        The case in words.
    rotor : Rotor
    operation : Operation
    support : NormalModes
    calibration : str
        Which inputs were calibrated to which published result; empty when none was.
    remarks : tuple of str
        Remarks on the input that deck and control laws bring.
    find_doubts : callable
        Returns further remarks, which follow from the numbers: found when `warnings` are read, because they take a
        quarter of the time that many designs take to build, and nobody reads those of the designs of a study.
    sources : mapping of str to Datum
        Every number of the deck by its field (``rotor.radius``, ``support.modes[beam].frequency``): the
        value as written, its SI value and unit, status and source. Numbers that follow from numbers of the deck,
        such as a stiffness from a frequency, are included.
    frequencies : BladeFrequencies, optional
        Frequencies of the blades; a case that has some has structure="tabulated" unless an option says otherwise.
    drive_train : DriveTrain, optional
        Drive train on the rotor's azimuth, unless an option says otherwise.
    left : Side, optional
        The left side of an aircraft whose sides differ; the support then is an `proprotor.support.airframe.Airframe`
        with symmetric and antisymmetric coordinates, which the two sides couple.
    deck : Deck, optional
        The deck of the configuration, from which `proprotor.deck.vary` builds other designs.
    given : mapping of str to Datum
        The numbers of `sources` that the deck gives.
    loops : tuple of ControlLoop
        Control loops that every model of the configuration has closed.
    """

    name: str
    rotor: Rotor
    operation: Operation
    support: NormalModes
    title: str = ""
    description: str = ""
    calibration: str = ""
    remarks: tuple[str, ...] = ()
    find_doubts: Callable[[], tuple[str, ...]] = tuple
    sources: Mapping[str, Datum] = field(default_factory=dict)
    frequencies: BladeFrequencies | None = None
    drive_train: DriveTrain | None = None
    left: Side | None = None
    deck: Any = None
    given: Mapping[str, Datum] = field(default_factory=dict)
    loops: tuple[ControlLoop, ...] = ()

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Remarks on the input that a reader of results needs."""
        return (*self.remarks, *self.find_doubts())

    def __repr__(self) -> str:
        """Return the rotor, its support and the doubtful numbers, in a few lines."""
        rotor, speed = self.rotor, np.asarray(self.operation.rotor_speed) / _RPM
        radius = range_text(np.asarray(rotor.radius))
        rotors = "two rotors, each" if isinstance(self.support, Airframe) else "rotor"
        lines = [
            f"Case {self.name}" + (f": {self.title}" if self.title else ""),
            f"  {rotors}: {rotor.n_blades} blades, radius {radius} m, {range_text(speed)} rpm",
            f"  support: {', '.join(self.support.names) or 'a rigid hub'}{_held(self.support)}",
        ]
        lines += [f"  {found}"] if (found := designs(self)) else []
        lines += [f"  control loop {loop_text(loop)}" for loop in self.loops]
        return "\n".join(lines + [f"  {sentence}" for sentence in reservations(self)])

    def _repr_html_(self) -> str:
        """Return what a notebook shows."""
        from proprotor.model.in_notebook import case_html  # here, because most uses need no HTML

        return case_html(self)

    def linearize(self, airspeed: Any, **options: Any) -> LinearModel:
        """Return the equations of motion of the rotor on its support.

        Parameters
        ----------
        airspeed : float, array (...) in m/s, text such as "250 ktas" or "200 keas", pint quantity or xarray.DataArray
            One airspeed, or a batch of any shape.
        **options
            See `proprotor.rotor.options.Options`.

        Returns
        -------
        LinearModel
            M, C, K (..., n, n), SI, on the coordinates of support and rotor, then of the control loops, which are
            closed; failed points are NaN, with the reason in `trim`. A point whose mass matrix has no inverse has
            matrices, but no modes.

        Raises
        ------
        InputError
            For an unknown option, a malformed airspeed, or a rotor that the options do not allow.
        """
        return close_loops(self.open_loop(airspeed, **options), self.loops)

    def open_loop(self, airspeed: Any, **options: Any) -> LinearModel:
        """Return the model without its control loops, see `linearize`.

        Parameters
        ----------
        airspeed : float, array, text, pint quantity or xarray.DataArray
            m/s, as for `linearize`.
        **options
            See `proprotor.rotor.options.Options`.

        Returns
        -------
        LinearModel

        Raises
        ------
        InputError
            As `linearize`.
        """
        if parse_options(self.model_options(options)).is_tilted:
            return checked(self.around(airspeed, **options), self.passage)
        return self._linearized(airspeed, options)

    def around(self, airspeed: Any, **options: Any) -> LinearModel:
        """Return the equations of motion about a periodic trim, with a last axis of the batch for azimuth.

        Parameters
        ----------
        airspeed : as `linearize`
        **options
            See `proprotor.rotor.options.Options`, with a shaft angle or a load factor.

        Returns
        -------
        LinearModel
            M, C, K (..., azimuths, n, n) at equal steps of one Nth of a turn.

        Raises
        ------
        InputError
            As `linearize`; without a shaft angle and a load factor, for a free aircraft, and with control loops.
        """
        if not parse_options(self.model_options(options)).is_tilted:
            raise InputError("load_factor", 1, "or shaft_angle must be another than in straight axial flight")
        name = "load_factor" if np.all(np.equal(options.get("shaft_angle", 0), 0)) else "shaft_angle"
        if isinstance(self.support, Airframe):
            rule = (
                "goes with a rotor on a support that stands still: a free aircraft that flies at an angle turns its "
                "weight and the lift of its wing as it rolls, which the model leaves out"
            )
            raise InputError(name, options.get(name), rule)
        if self.loops:
            rule = "goes without control loops: what averaging leaves out is known for the open loop alone"
            raise InputError(name, options.get(name), rule)
        return self._linearized(airspeed, options, around=True)

    @property
    def passage(self) -> Any:
        """Blade passage frequency NΩ, rad/s."""
        return np.asarray(self.rotor.n_blades) * np.asarray(self.operation.rotor_speed)

    def _linearized(self, airspeed: Any, options: Mapping[str, Any], around: bool = False) -> LinearModel:
        own = self.model_options(options)
        rotor_alone = model_of(self.rotor, self.operation, airspeed, own, case=self, around=around)
        support = self.support.at(rotor_alone.airspeed, self.operation.density)
        if isinstance(support, Airframe):
            coupled = self._pair(rotor_alone, support, airspeed, options)
        else:
            self._check_one_rotor(own)
            coupled = mount(rotor_alone, support)
        return self._with_wing_lag(coupled, str(own.get("lift", "")))

    def _with_wing_lag(self, coupled: LinearModel, lift: str) -> LinearModel:
        """Return the coupled model with the lag of its wing's lift, where the option asks for it."""
        assert coupled.origin is not None  # of this case
        if not coupled.origin.options.wing_lags:
            return coupled
        found = self.support.wing_circulation(coupled.airspeed, self.operation.density)
        if found is not None:
            return with_wing_lag(coupled, found)
        if not coupled.origin.options.blades_lag:
            raise InputError(
                "lift", lift, "goes with a support whose wing has airloads, [support.wing_aerodynamics]"
            )
        return coupled

    def model_options(self, options: Mapping[str, Any]) -> dict[str, Any]:
        """Return options of the model, completed with the blade frequencies and the drive train of the case.

        Parameters
        ----------
        options : mapping
            See `proprotor.rotor.options.Options`.

        Returns
        -------
        dict
            The options given, with ``structure="tabulated"`` and ``frequencies`` if the case has blade frequencies,
            and with ``drive_train`` if the case has one and the rotor speed is not constant.
        """
        return _completed(options, self.frequencies, self.drive_train)

    def _pair(
        self, right: LinearModel, airframe: Airframe, airspeed: Any, options: Mapping[str, Any]
    ) -> LinearModel:
        """Return the model of an aircraft: its right rotor, and the mirror image of that rotor or another left one."""
        own = self.model_options(options)
        if self.left is None:
            return mount_pair(right, airframe, None, _interconnect(own, own))
        for name in ("rotor_speed", "density"):
            value, same = (getattr(side.operation, name) for side in (self.left, self))
            if not np.all(np.equal(value, same)):
                raise InputError(f"left.operation.{name}", value, f"must be that of the right side, {same}")
        other = self._left_options(self.left, options)
        return mount_pair(right, airframe, _left_rotor(self.left, airspeed, other), _interconnect(own, other))

    def _left_options(self, left: Side, options: Mapping[str, Any]) -> dict[str, Any]:
        """Return the options of the left side, with blade frequencies and a drive train of its own.

        An option that repeats what the right side of the case brings is none for the left side.
        """
        own = {"frequencies": self.frequencies, "drive_train": self.drive_train}
        given = {
            name: value for name, value in options.items() if value is None or value is not own.get(name)
        }
        return _completed(given, left.frequencies, left.drive_train)

    def _check_one_rotor(self, options: Mapping[str, Any]) -> None:
        """Refuse what only an aircraft with two rotors has."""
        if self.left is not None:
            raise InputError("left", None, "goes with an aircraft that has two rotors")
        train = options.get("drive_train")
        if train is not None and np.any(np.real(train.interconnect_stiffness) > 0):
            rule = "must be zero without a second rotor"
            raise InputError("drive_train.interconnect_stiffness", train.interconnect_stiffness, rule)


def _left_rotor(left: Side, airspeed: Any, options: Mapping[str, Any]) -> LinearModel:
    """Return the left rotor alone, in its mirrored axes."""
    try:
        return rotor_model(left.rotor, left.operation, airspeed, **options)
    except InputError as error:
        raise error.within("left") from None


def _interconnect(right: Mapping[str, Any], left: Mapping[str, Any]) -> Any:
    """Return the stiffness of the interconnect shaft, N m/rad, by the options of both sides."""
    trains = [options.get("drive_train") for options in (right, left)]
    stiffness, other = (0.0 if train is None else train.interconnect_stiffness for train in trains)
    if not np.array_equal(stiffness, other):
        rule = f"must be that of the right side, {stiffness}: one shaft connects both"
        raise InputError("left.drive_train.interconnect_stiffness", other, rule)
    return stiffness


def _completed(
    options: Mapping[str, Any], frequencies: BladeFrequencies | None, drive_train: DriveTrain | None
) -> dict[str, Any]:
    """Return options completed with the blade frequencies and the drive train of a side."""
    found = dict(options)
    if frequencies is not None and found.get("structure", "tabulated") == "tabulated":
        found = {"structure": "tabulated", "frequencies": frequencies} | found
    if drive_train is not None and found.get("rotor_speed") != "constant":
        found = {"drive_train": drive_train} | found
    return found


def _held(support: NormalModes) -> str:
    """Return how the rotor was held when the modes of the support were found, if the rotor was on."""
    if not support.includes_rotor:
        return ""
    shaft = "" if support.includes_rotor == "mass only" else f", shaft {support.shaft}"
    return f"; found with the rotor on, {support.includes_rotor}{shaft}"
