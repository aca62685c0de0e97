"""An analysis case: rotor, operation and support, with the source of every number."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from proprotor.datum import PER_REV, Datum
from proprotor.deck.file import ALTERNATIVES, list_cases, read_tables
from proprotor.deck.support_of_deck import support_of
from proprotor.errors import InputError
from proprotor.model.linear_model import LinearModel, mass_at_rest, rotor_model
from proprotor.model.mount import mount
from proprotor.model.rotor_share import settled, spring_warnings
from proprotor.rotor.airfoil import Airfoil, SectionModel
from proprotor.rotor.airfoil_table import AirfoilTable
from proprotor.rotor.atmosphere import standard_air
from proprotor.rotor.blade_frequencies import BladeFrequencies
from proprotor.rotor.drive_train import DriveTrain
from proprotor.rotor.operation import Operation
from proprotor.rotor.rotor import Rotor
from proprotor.support.normal_modes import NormalModes

if TYPE_CHECKING:
    import xarray

    from proprotor.deck.fields import Section
    from proprotor.deck.sections import Deck
    from proprotor.stability.flutter import Crossings, FlutterPoint

__all__ = ["Case", "list_cases", "load_case"]


@dataclass(frozen=True, eq=False, repr=False)
class Case:
    """A rotor, how it is operated, and what carries it.

    Attributes
    ----------
    name, title, description : str
        What the case is.
    rotor : Rotor
    operation : Operation
    support : NormalModes
    calibration : str
        What was calibrated to which published result; empty when nothing was.
    warnings : tuple of str
        What a reader of results should know about the input.
    sources : mapping of str to Datum
        Every number of the deck by its field (``rotor.radius``, ``support.modes[beam].frequency``): the
        value as written, its SI value and unit, status and source. What follows from the deck's
        numbers, such as a stiffness from a frequency, stands here as well.
    frequencies : BladeFrequencies, optional
        Of the blades; with them the model has structure="tabulated" unless an option says otherwise.
    drive_train : DriveTrain, optional
        On the rotor's azimuth, unless an option says otherwise.
    deck : Deck, optional
        The deck the case was made from, which says how its numbers hang together.
    given : mapping of str to Datum
        Those of `sources` that the deck gives.
    """

    name: str
    rotor: Rotor
    operation: Operation
    support: NormalModes
    title: str = ""
    description: str = ""
    calibration: str = ""
    warnings: tuple[str, ...] = ()
    sources: Mapping[str, Datum] = field(default_factory=dict)
    frequencies: BladeFrequencies | None = None
    drive_train: DriveTrain | None = None
    deck: Deck | None = None
    given: Mapping[str, Datum] = field(default_factory=dict)

    def __repr__(self) -> str:
        from proprotor.stability.summary import of_case

        return of_case(self)

    def linearize(self, airspeed: Any, **options: Any) -> LinearModel:
        """Equations of motion of the rotor on its support.

        Parameters
        ----------
        airspeed : float, array (...) in m/s, text such as "250 kt", pint quantity or xarray.DataArray
            One speed, or a batch of any shape.
        **options
            See `proprotor.rotor.options.Options`.

        Returns
        -------
        LinearModel
            M, C, K (..., n, n), SI, on the coordinates of support and rotor; failed points are NaN, with their
            reason in `trim`. A point whose mass matrix has no inverse has its matrices, but no modes.

        Raises
        ------
        InputError
            For an unknown option, an airspeed that is none, or a rotor that the options do not allow.
        """
        rotor_alone = rotor_model(self.rotor, self.operation, airspeed, **self.model_options(options))
        support = self.support.at(rotor_alone.airspeed, self.operation.density)
        model = mount(rotor_alone, support)
        return model if model.origin is None else replace(model, origin=model.origin._replace(case=self))

    def model_options(self, options: Mapping[str, Any]) -> dict[str, Any]:
        """Options of the model with what the case has in place of those that are not given.

        Parameters
        ----------
        options : mapping
            See `proprotor.rotor.options.Options`.

        Returns
        -------
        dict
            With ``structure="tabulated"`` and ``frequencies`` where the case has blade frequencies, and
            ``drive_train`` where it has one; it turns nothing where the rotor speed is constant.
        """
        found = dict(options)
        if self.frequencies is not None and found.get("structure", "tabulated") == "tabulated":
            found = {"structure": "tabulated", "frequencies": self.frequencies} | found
        if self.drive_train is not None and found.get("rotor_speed") != "constant":
            found = {"drive_train": self.drive_train} | found
        return found

    def vary(self, values: Mapping[str, Any]) -> Case:
        """The case with other numbers in its deck, and all that follows from them: see `proprotor.deck.vary.vary`.

        Parameters
        ----------
        values : mapping of str to float, array, text, pint quantity or xarray.DataArray
            By path in the deck (`proprotor.design_inputs`): SI, or with their unit.

        Returns
        -------
        Case

        Raises
        ------
        InputError
            For an unknown path, with the nearest known one, or a value that is not physical.
        """
        from proprotor.deck.vary import vary

        return vary(self, values)

    def sweep(self, airspeeds: Any, vary: Mapping[str, Any] | None = None, **options: Any) -> xarray.Dataset:
        """Modes along airspeeds, or along one input, named and followed: see `proprotor.stability.sweep.sweep_case`.

        Parameters
        ----------
        airspeeds : array (points,) in m/s, text such as "50:400:5kt", pint quantity or xarray.DataArray
            One airspeed with `vary`.
        vary : mapping of str to array (points,), optional
            One input by its path in the deck, and its values in SI.
        **options
            See `proprotor.rotor.options.Options`.

        Returns
        -------
        xarray.Dataset
            See `proprotor.stability.sweep.sweep`.

        Raises
        ------
        InputError
            For an unknown option or input, airspeeds that do not form a line, or more than one input.
        """
        from proprotor.stability.sweep import sweep_case

        return sweep_case(self, airspeeds, vary, **options)

    def boundaries(
        self,
        airspeeds: Any = None,
        vary: Mapping[str, Any] | None = None,
        *,
        level: float = 0.0,
        **options: Any,
    ) -> Crossings:
        """All crossings of a damping level along airspeeds, or one input: see `proprotor.stability.flutter.boundaries`.

        Parameters
        ----------
        airspeeds : array (points,) in m/s, text such as "50:400:5kt", pint quantity or xarray.DataArray, optional
            The scan; one airspeed with `vary`.
        vary : mapping of str to array (points,), optional
            One input by its path in the deck, and the values of the scan in SI.
        level : float
            Damping ratio that counts as the boundary.
        **options
            See `proprotor.rotor.options.Options`.

        Returns
        -------
        Crossings
            By position, m/s or in SI units of the input.

        Raises
        ------
        InputError
            As `sweep`.
        """
        from proprotor.stability.flutter import boundaries

        return boundaries(self, airspeeds, vary, level=level, **options)

    def flutter_point(self, airspeeds: Any = None, *, level: float = 0.0, **options: Any) -> FlutterPoint:
        """The lowest airspeed at which a mode becomes unstable: see `proprotor.stability.flutter.flutter_point`.

        Parameters
        ----------
        airspeeds : array (points,) in m/s, text such as "50:400:5kt", pint quantity or xarray.DataArray, optional
            The scan; 0.2 to 1.2 of the tip speed by default.
        level : float
            Damping ratio that counts as the boundary: 0.03 for a margin of 3 % of critical.
        **options
            See `proprotor.rotor.options.Options`.

        Returns
        -------
        FlutterPoint

        Raises
        ------
        InputError
            As `sweep`.
        """
        from proprotor.stability.flutter import flutter_point

        return flutter_point(self, airspeeds, level=level, **options)

    def sensitivity(
        self, of: str = "flutter_speed", wrt: Sequence[str] | None = None, **options: Any
    ) -> xarray.Dataset:
        """Exact derivatives by inputs of the deck: see `proprotor.stability.sensitivity.sensitivity`.

        Parameters
        ----------
        of : "flutter_speed", "damping" or "eigenvalue"
        wrt : sequence of str, optional
            Paths of inputs; all by default.
        **options
            airspeed, mode and level of `proprotor.stability.sensitivity.sensitivity`, and those of `proprotor.rotor.options.Options`.

        Returns
        -------
        xarray.Dataset
            derivative (input,) or (input, mode), SI units per SI unit of the input.

        Raises
        ------
        InputError
            For an unknown quantity, input, mode or option, or where nothing becomes unstable.
        """
        from proprotor.stability.sensitivity import sensitivity

        return sensitivity(self, of, wrt, **options)

    def attribution(self, airspeed: Any, mode: str | None = None, **options: Any) -> xarray.Dataset:
        """What drives and what damps each mode, by physical origin: see `proprotor.stability.attribution.attribution`.

        Parameters
        ----------
        airspeed : float in m/s, text such as "300 kt", pint quantity or xarray.DataArray
        mode : str, optional
            One mode by name; all by default.
        **options
            See `proprotor.rotor.options.Options`.

        Returns
        -------
        xarray.Dataset
            contribution and growth (origin, mode), rad/s.

        Raises
        ------
        InputError
            For an airspeed that is not one, or that cannot be analysed, and an unknown mode.
        """
        from proprotor.stability.attribution import attribution

        return attribution(self, airspeed, mode, **options)

    def stability_map(self, axes: Mapping[str, Any], **options: Any) -> xarray.Dataset:
        """Where in the plane of two inputs the case is stable: see `proprotor.stability.map.stability_map`.

        Parameters
        ----------
        axes : mapping of str to array
            Two inputs by path, or "airspeed", and their rising values, in SI.
        **options
            airspeed and level of `proprotor.stability.map.stability_map`, and those of `proprotor.rotor.options.Options`.

        Returns
        -------
        xarray.Dataset
            growth (y, x), 1/s, positive where a mode is beyond the level; boundary (vertex, axis), the line between.

        Raises
        ------
        InputError
            For axes that are not two, values that do not rise, an unknown input, or an airspeed that is missing.
        """
        from proprotor.stability.map import stability_map

        return stability_map(self, axes, **options)


def load_case(name_or_path: str | os.PathLike[str], settings: Mapping[str, str] | None = None) -> Case:
    """The case of a deck.

    Parameters
    ----------
    name_or_path : str or path
        A bundled deck (`list_cases`) or a TOML file; `proprotor describe` tells its fields.
    settings : mapping of str to str, optional
        Fields to set first, as text: ``{"rotor.precone": "1.5 deg"}``. See `proprotor.deck.settings`.

    Returns
    -------
    Case

    Raises
    ------
    InputError
        When the deck cannot be found or read, or a field is missing, unknown or not physical: one line for
        each problem, with the field, the value as written and the rule.
    """
    from proprotor.deck.sections import validate  # here, because pydantic is slow to import

    tables = read_tables(name_or_path)
    if settings:
        from proprotor.deck.settings import with_settings

        tables = with_settings(tables, settings)
    deck = validate(tables)
    return assemble(deck, {path: _per_second(n, deck.operation.rotor_speed.si) for path, n in _numbers(deck)})


def assemble(deck: Deck, numbers: Mapping[str, Datum], names: tuple[str, ...] = ()) -> Case:
    """The case of a deck with these numbers by path, which may be arrays of many designs or complex.

    `names` of the support's coordinates are the order in which designs of a beam wing have them.

    Raises
    ------
    InputError
        When a number is not physical, as the deck has it.
    """
    with _told_as_written("operation", numbers):
        trim = deck.operation.trim
        given, air = _with_air(_values(numbers, "operation"))
        operation = Operation(
            **given,
            trim=trim if isinstance(trim, str) else _values(numbers, "operation.trim"),
        )
    with _told_as_written("rotor.airfoil", numbers):
        airfoil = _airfoil(_values(numbers, "rotor.airfoil"))
    with _told_as_written("rotor", numbers):
        given = {"airfoil": airfoil, "propeller_moment": deck.rotor.propeller_moment}
        rotor, derived = _rotor(_values(numbers, "rotor") | given, operation.density)
    with _told_as_written("rotor.frequencies", numbers):
        frequencies = _frequencies(deck, _values(numbers, "rotor.frequencies"))
    with _told_as_written("drive_train", numbers):
        train = None if deck.drive_train is None else DriveTrain(**_values(numbers, "drive_train"))
    with _told_as_written("support", numbers):
        at_rest = mass_at_rest(rotor)
        support = settled(support_of(deck.support, numbers, names), at_rest)
        doubts = spring_warnings(support, at_rest, rotor.gimbal_stiffness)
    return Case(
        name=deck.case.name,
        title=deck.case.title,
        description=deck.case.description,
        calibration=deck.case.calibration,
        warnings=(*deck.case.warnings, *doubts),
        rotor=rotor,
        operation=operation,
        support=support,
        sources=dict(numbers) | air | derived | _how_held(support, numbers),
        frequencies=frequencies,
        drive_train=train,
        deck=deck,
        given=numbers,
    )


def _numbers(section: Section, path: str = "") -> Iterator[tuple[str, Datum]]:
    """Every number of a section and those within it, by its path."""
    for name in type(section).model_fields:
        entry, here = getattr(section, name), f"{path}.{name}" if path else name
        if isinstance(entry, Datum):
            yield here, entry
        elif name == "modes" and entry is not None:
            for mode in entry:
                yield from _numbers(mode, f"{here}[{mode.name}]")
        elif hasattr(type(entry), "model_fields"):
            yield from _numbers(entry, here)


def _per_second(number: Datum, rotor_speed: float) -> Datum:
    """A frequency per revolution in rad/s: n cycles per revolution are n Ω, with Ω of the file it was written in."""
    if number.unit != PER_REV:
        return number
    own = rotor_speed if number.rotor_speed is None else number.rotor_speed
    return replace(number, si=number.si * own, unit="rad/s", rotor_speed=own)


def _values(numbers: Mapping[str, Datum], section: str) -> dict[str, Any]:
    """The SI values of a section's own numbers by field; a distribution as (r in m, values) and what lies beyond."""
    own = {
        path.removeprefix(f"{section}."): n for path, n in numbers.items() if path.startswith(f"{section}.")
    }
    return {name: _value(n, numbers) for name, n in own.items() if "." not in name}


def _value(number: Datum, numbers: Mapping[str, Datum]) -> Any:
    if number.r_over_R is None:
        return number.si
    radius = np.asarray(numbers["rotor.radius"].si)
    beyond = () if number.beyond is None else (number.beyond,)
    return np.array(number.r_over_R) * radius[..., None], np.array(number.si), *beyond


def _with_air(given: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Datum]]:
    """What an operation is given, and the air that follows from its altitude."""
    if "altitude" not in given:
        return given, {}
    found = standard_air(given.pop("altitude"), given.pop("temperature_offset", 0.0))
    source = "altitude, temperature_offset: standard atmosphere"
    air = {
        "density": Datum("p / R T", found.density, "kg/m**3", "derived", source),
        "speed_of_sound": Datum("√(γ R T)", found.speed_of_sound, "m/s", "derived", source),
    }
    given |= {name: number.si for name, number in air.items()}
    return given, {f"operation.{name}": number for name, number in air.items()}


def _airfoil(given: dict[str, Any]) -> SectionModel:
    return AirfoilTable.from_c81(given["table"]) if "table" in given else Airfoil(**given)


def _frequencies(deck: Deck, given: dict[str, Any]) -> BladeFrequencies | None:
    section = deck.rotor.frequencies
    return None if section is None else BladeFrequencies(against=section.against, **given)


def _rotor(given: dict[str, Any], density: float) -> tuple[Rotor, dict[str, Datum]]:
    """The rotor, and the numbers that follow from those given."""
    omega = {name: given.pop(f"{name}_frequency") for name in ("flap", "lag") if f"{name}_frequency" in given}
    lock_number = given.pop("lock_number", None)
    build: Callable[..., Rotor] = Rotor
    if "mass_distribution" in given:
        build = partial(
            Rotor.from_mass_distribution,
            *given.pop("mass_distribution"),
            hub_mass=given.pop("hub_mass", None),
        )
    # Springs and chord may follow from inertias that only the rotor knows: hence the stand-ins.
    bare = build(**{"flap_stiffness": 0.0, "lag_stiffness": 0.0, "chord": 1.0} | given)
    derived = {f"{name}_stiffness": _spring(bare, name, frequency) for name, frequency in omega.items()}
    if lock_number is not None:
        derived["chord"] = _chord(bare, lock_number, density)
    rotor = replace(bare, **{name: number.si for name, number in derived.items()})
    return rotor, {f"rotor.{name}": number for name, number in derived.items()}


def _how_held(support: NormalModes, numbers: Mapping[str, Datum]) -> dict[str, Datum]:
    """Return how the rotor was held while the modes were found, where the deck leaves that to the program."""
    taken = {}
    given = numbers.get("support.includes_rotor")
    if given is not None and given.si is True:
        source = (
            f"{given.source}; " * bool(given.source) + 'true: taken as "gimballed", for there is a gimbal'
        )
        taken["support.includes_rotor"] = replace(given, si=support.includes_rotor, source=source)
    if support.includes_rotor in ("gimballed", "rigid") and "support.shaft" not in numbers:
        taken["support.shaft"] = Datum("held", "held", "", source="left out")
    return taken


def _spring(rotor: Rotor, hinge: str, frequency: float) -> Datum:
    stiffness = getattr(rotor, f"{hinge}_inertia") * frequency**2
    return Datum(
        "I ω²", stiffness, "N*m/rad", "derived", f"{hinge}_inertia, {hinge}_frequency (non-rotating)"
    )


def _chord(rotor: Rotor, lock_number: float, density: float) -> Datum:
    if np.any(np.asarray(density) == 0):
        raise InputError("lock_number", lock_number, "needs a density above zero; give chord instead")
    if not isinstance(rotor.airfoil, Airfoil):
        raise InputError("lock_number", lock_number, "needs a lift_slope; with an airfoil table give chord")
    chord = lock_number * rotor.blade_inertia / (density * rotor.airfoil.lift_slope * rotor.radius**4)
    return Datum(
        "γ I_b / (ρ c_lα R⁴)", chord, "m", "derived", "lock_number, density, lift_slope, blade_inertia"
    )


@contextmanager
def _told_as_written(section: str, numbers: Mapping[str, Datum]) -> Iterator[None]:
    """Errors about an SI value told with the deck's field, and the value as the deck has it."""
    try:
        yield
    except InputError as error:
        name = error.field.rpartition(".")[2]
        for written_as in (name, *_instead_of(name)):
            if number := numbers.get(f"{section}.{written_as}"):
                raise InputError(f"{section}.{written_as}", number.written, error.rule) from None
        raise error.within(section) from None


def _instead_of(name: str) -> tuple[str, ...]:
    """The fields that may be given in place of one."""
    return tuple(other for left, right in ALTERNATIVES if name in left for other in right)
