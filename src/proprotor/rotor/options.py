"""Modelling options: one keyword for each, the same in every function and command.

The first choice is the default. A first choice None stands for one of the other choices: `default_choice` says for
which one, from the rest of the options.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError, check_finite, unknown_name
from proprotor.rotor.blade_frequencies import BladeFrequencies
from proprotor.rotor.drive_train import DriveTrain
from proprotor.rotor.generated import EQUATION_SETS, EquationSet

CHOICES: dict[str, tuple[Any, ...]] = {
    "equations": tuple(EQUATION_SETS),
    "pitch": ("dynamic", "coupling", "rigid"),
    "structure": ("coupled", "diagonal", "tabulated"),
    "airloads": ("full", "lift-slope", "none"),
    "compressibility": (True, False),
    "section_damping": (None, True, False),
    "lift": ("quasi-steady", "lagged", "lagged-blades", "lagged-wing"),
    "inflow": ("none", "momentum", "dynamic"),
    "rotor_speed": ("windmilling", "constant"),
    "reactionless": (False, True),
    "cyclic": ("none", "level"),
    "backend": ("numpy", "compiled", "auto"),
}
_FURTHER = (
    *("locked", "frequencies", "pitch_flap_coupling", "pitch_lag_coupling", "drive_train"),
    *("shaft_angle", "load_factor"),
)
LARGEST_SHAFT_ANGLE = math.radians(15)
LOCKABLE = ("flap", "lag", "pitch", "gimbal")


def default_choice(name: str, options: Mapping[str, Any]) -> Any:
    """Return the value of an option that is not given.

    Section damping is off with the paper's equations, and on with the consistent ones.
    """
    if name == "section_damping":
        return options.get("equations", CHOICES["equations"][0]) != "published"
    return CHOICES[name][0]


@dataclass(frozen=True, kw_only=True)
class Options:
    """Choices of the model.

    The object always holds section damping as True or False, given or not.

    Parameters
    ----------
    equations : "consistent" or "published"
        Every first-order term, or the terms that AIAA-2002-1604 keeps in the perturbation equations (the trim is the
        same); an `EquationSet` has generated modules of its own.
    pitch : "dynamic", "coupling" or "rigid"
        Pitch equations kept; replaced by the couplings of Eqs. 36 and 37 in the airloads' pitch; or left out.
    structure : "coupled", "diagonal" or "tabulated"
        Springs that turn with the pitch (Eqs. 20-22); these springs without the flap-lag stiffness; or, in place of
        the rotor's springs, the stiffness that gives the frequencies of `frequencies` at their own rotor speed.
    frequencies : BladeFrequencies
        For structure="tabulated".
    pitch_flap_coupling, pitch_lag_coupling : float or array that broadcasts with the airspeeds, optional
        For pitch="coupling": values (dimensionless) in place of Eqs. 36 and 37.
    airloads : "full", "lift-slope" or "none"
        Perturbation airloads: all, the part proportional to the lift slope, or none. The trim always has all airloads.
    compressibility : bool
        Put the Prandtl-Glauert factor on lift and moment.
    section_damping : bool, optional
        Quasi-steady damping of turning sections (lift by the incidence at 3/4 chord, and the moment about the quarter
        chord), in the trim too. When not given, the damping is on, but off with equations="published"; True adds the
        damping to these equations. Lift-slope airloads keep the lift of the damping alone.
    lift : "quasi-steady", "lagged", "lagged-blades" or "lagged-wing"
        Lift that follows the motion at once, or that shed vortices hold back, with states of its own: of blades
        (consistent equations with airloads) and of the wing, if the support has one with airloads; or of one of the
        two. The trim is the same.
    inflow : "none", "momentum" or "dynamic"
        Velocity that the rotor's thrust induces, for consistent equations in axial flight: none; by momentum theory in
        the trim, which perturbations leave as it is; or in the trim and with states that follow thrust and hub moments,
        uniform and of the first harmonics. Goes with lift of blades that is quasi-steady: lag and inflow are two models
        of one wake.
    rotor_speed : "windmilling" or "constant"
        Whether the rotor speed perturbation is a degree of freedom.
    drive_train : DriveTrain, optional
        Engine and shaft on the rotor's azimuth.
    reactionless : bool
        Keep the blade motions that make no load at the hub, for more than three blades.
    shaft_angle : float or array that broadcasts with the airspeeds
        Angle of the shaft above the direction of flight, nose up, rad: the rotor meets the air at this angle. Up to
        15°.
    load_factor : float or array that broadcasts with the airspeeds
        Load factor n of a steady pull-up, whose turn at g(n - 1)/V the rotor follows; 1 in straight flight.
    cyclic : "none" or "level"
        With a shaft angle or a load factor: a swashplate without cyclic pitch, or the cyclic pitch that keeps the
        gimbal level; without a gimbal, the pitch that keeps the blades from flapping once a turn.
    backend : "numpy", "compiled" or "auto"
        What computes trims, matrices and eigenvalues: NumPy with LAPACK, or compiled functions
        (see `proprotor.compiled`), to rounding the same. "auto" takes these where there is a C compiler, and results
        say which of both it took.
    locked : collection of "flap", "lag", "pitch", "gimbal"
        Coordinates that are removed; they stay at zero in the trim too.

    Raises
    ------
    InputError
        For a choice that does not exist, with the choices that do.
    """

    equations: str | EquationSet = "consistent"
    pitch: str = "dynamic"
    structure: str = "coupled"
    frequencies: BladeFrequencies | None = None
    pitch_flap_coupling: ArrayLike | None = None
    pitch_lag_coupling: ArrayLike | None = None
    airloads: str = "full"
    compressibility: bool = True
    section_damping: bool | None = None
    lift: str = "quasi-steady"
    inflow: str = "none"
    rotor_speed: str = "windmilling"
    drive_train: DriveTrain | None = None
    reactionless: bool = False
    shaft_angle: ArrayLike = 0.0
    load_factor: ArrayLike = 1.0
    cyclic: str = "none"
    backend: str = "numpy"
    locked: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name, choices in CHOICES.items():
            value = getattr(self, name)
            if not isinstance(value, EquationSet) and value not in choices:
                raise InputError(name, value, f"must be one of {', '.join(map(str, choices))}")
        if self.section_damping is None:
            object.__setattr__(self, "section_damping", default_choice("section_damping", vars(self)))
        if self.backend != "numpy":
            object.__setattr__(self, "backend", _backend(self.backend))
        locked = (self.locked,) if isinstance(self.locked, str) else tuple(self.locked)
        for name in locked:
            if name not in LOCKABLE:
                raise InputError("locked", name, f"must be of {', '.join(LOCKABLE)}")
        object.__setattr__(self, "locked", locked)
        self._check_combinations()

    def _check_combinations(self) -> None:
        """Refuse options that do not go together."""
        if (self.structure == "tabulated") != isinstance(self.frequencies, BladeFrequencies):
            rule = 'must be BladeFrequencies, with structure="tabulated" only'
            raise InputError("frequencies", self.frequencies, rule)
        for name in ("pitch_flap_coupling", "pitch_lag_coupling"):
            if (value := getattr(self, name)) is not None:
                if self.pitch != "coupling":
                    raise InputError(name, value, 'goes with pitch="coupling"')
                check_finite(name, value)
        if self.drive_train is not None and not isinstance(self.drive_train, DriveTrain):
            raise InputError("drive_train", self.drive_train, "must be a DriveTrain")
        if self.drive_train is not None and self.rotor_speed == "constant":
            raise InputError("drive_train", self.drive_train, 'goes with rotor_speed="windmilling"')
        if self.blades_lag:
            self.check_blades_may_lag(self.lift)
        if self.has_inflow:
            self._check_inflow()
        for name in ("shaft_angle", "load_factor"):
            check_finite(name, getattr(self, name))
        if np.any(np.abs(self.shaft_angle) > LARGEST_SHAFT_ANGLE):
            rule = (
                f"must be within {math.degrees(LARGEST_SHAFT_ANGLE):.0f} deg, given in rad: farther from axial flight "
                "the induced velocity, which the model leaves out, shapes the inflow"
            )
            raise InputError("shaft_angle", self.shaft_angle, rule)
        if self.is_tilted:
            self._check_tilted()

    def _check_inflow(self) -> None:
        """Refuse options that induced velocity does not serve."""
        if self.equation_set != EQUATION_SETS["consistent"]:
            raise InputError("inflow", self.inflow, 'goes with equations="consistent"')
        if self.frequencies is not None and self.frequencies.against == "airspeed":
            raise InputError("inflow", self.inflow, "goes with blade frequencies against the collective")
        if self.inflow_is_dynamic and self.airloads == "none":
            raise InputError("inflow", self.inflow, 'goes with airloads="full" or "lift-slope"')
        if self.blades_lag:
            rule = (
                f'goes with lift="quasi-steady" or "lagged-wing", not "{self.lift}": a part of the wake would count '
                "twice"
            )
            raise InputError("inflow", self.inflow, rule)

    def _check_tilted(self) -> None:
        """Refuse options that the periodic trim of a rotor at an angle, or in a turn, does not serve."""
        name = "shaft_angle" if np.any(np.not_equal(self.shaft_angle, 0)) else "load_factor"
        served = {
            "equations": "consistent",
            "airloads": "full",
            "lift": "quasi-steady",
            "inflow": "none",
            "reactionless": False,
        }
        for other, choice in served.items():
            if getattr(self, other) != choice:
                raise InputError(name, getattr(self, name), f"goes with {other}={choice!r}".replace("'", '"'))
        if self.structure == "tabulated":
            raise InputError(name, getattr(self, name), 'goes with structure="coupled" or "diagonal"')
        if self.pitch == "coupling":
            raise InputError(name, getattr(self, name), 'goes with pitch="dynamic" or "rigid"')
        if self.cyclic == "level" and {"gimbal", "flap"} <= {*self.locked}:
            raise InputError("cyclic", self.cyclic, "needs a gimbal or a flap hinge that is not locked")

    @cached_property
    def is_tilted(self) -> bool:
        """Whether the rotor flies at an angle or in a turn, so that its trim is periodic."""
        at_angle = np.any(np.not_equal(self.shaft_angle, 0))
        return bool(at_angle or np.any(np.not_equal(self.load_factor, 1)))

    def check_blades_may_lag(self, lift: str) -> None:
        """Refuse options without equations for the lag of lift.

        Parameters
        ----------
        lift : str
            What asks for the lag, for the message.

        Raises
        ------
        InputError
            For other equations than the consistent ones, and without airloads.
        """
        if self.equation_set != EQUATION_SETS["consistent"]:
            raise InputError("lift", lift, 'goes with equations="consistent"')
        if self.airloads == "none":
            raise InputError("lift", lift, 'goes with airloads="full" or "lift-slope"')

    @property
    def blades_lag(self) -> bool:
        """Whether the lift of blade sections lags."""
        return self.lift in ("lagged", "lagged-blades")

    @property
    def wing_lags(self) -> bool:
        """Whether the lift of the support's wing lags, if the support has one."""
        return self.lift in ("lagged", "lagged-wing")

    @property
    def has_inflow(self) -> bool:
        """Whether the trim has induced velocity."""
        return self.inflow != "none"

    @property
    def inflow_is_dynamic(self) -> bool:
        """Whether the induced velocity has states."""
        return self.inflow == "dynamic"

    @property
    def equation_set(self) -> EquationSet:
        """The generated modules of the chosen equations."""
        return self.equations if isinstance(self.equations, EquationSet) else EQUATION_SETS[self.equations]

    @property
    def pitch_is_free(self) -> bool:
        """Whether the pitch equations are part of the model."""
        return self.pitch == "dynamic" and "pitch" not in self.locked


def _backend(wanted: str) -> str:
    """Return the backend that is there: "auto" stands for the compiled one, or for NumPy without a compiler."""
    from proprotor.compiled.library import why_not  # here, because most results need no compiler

    reason = why_not()
    if reason and wanted == "compiled":
        raise InputError(
            "backend", wanted, f'needs the compiled functions: {reason}; "auto" takes NumPy then'
        )
    return "numpy" if reason else "compiled"


def parse_options(options: Mapping[str, Any]) -> Options:
    """Return `Options` from keywords.

    Raises
    ------
    InputError
        For an unknown keyword, with the known keywords.
    """
    try:
        return _parsed_once(**options)
    except TypeError:  # an array among the choices
        return _parsed(**options)


def _parsed(**options: Any) -> Options:
    known = (*CHOICES, *_FURTHER)
    for name in options:
        if name not in known:
            rule = f"{unknown_name(name, known, 'option')} (options: {', '.join(known)})"
            raise InputError(name, options[name], rule)
    return Options(**options)


# An analysis asks with the same options at each of its batches; an aircraft has two sides.
_parsed_once = lru_cache(maxsize=2, typed=True)(_parsed)
