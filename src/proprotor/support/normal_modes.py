"""Support of a rotor: coordinates with mass, damping and stiffness, and their motion at the hub.

The simplest supports are here too: a two-axis pivot, and a support that does not move.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, ClassVar, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError, is_choice, list_choices, nowhere_negative, unknown_name
from proprotor.rotor.motions import check_support_names
from proprotor.support.wing_circulation import WingCirculation, WingLift
from proprotor.typing import Array

HUB_AXES = ("x", "y", "z", "alpha_x", "alpha_y", "alpha_z")
TRANSLATION, ROTATION = slice(0, 3), slice(3, 6)  # of the hub axes, or of the six motions of any node
INCLUDES_ROTOR = ("gimballed", "rigid", "mass only", True, False)
SHAFT = ("held", "free")
CARRIES = ("one rotor", "two rotors")


@dataclass(frozen=True, eq=False)
class NormalModes:
    """Generalised coordinates p of a support: M p̈ + C ṗ + K p = Φᵀ f, where Φ p is the motion of the hub.

    Parameters
    ----------
    names : sequence of str
        One name for each coordinate, all different, and none the name of a coordinate or mode of a rotor.
    mass, damping, stiffness : array_like, shape (..., n, n)
        Symmetric, SI (kg or kg m² and so on, as the coordinate is a length in m or an angle in rad).
        The mass must have no negative eigenvalue. Leading axes are many supports at once.
    hub : array_like, shape (..., 6, n)
        Φ: displacement (x, y, z) and rotation (αx, αy, αz) of the hub per unit of each coordinate, in the
        inertial axes I, J, K of the rotor, K along the shaft.
    includes_rotor : "gimballed", "rigid", "mass only", True or False
        How the rotor was held when `mass` was measured or computed with the rotor on, its blades locked or stiff: free
        to tilt on its gimbal; as one body with its shaft; a point mass at the hub. The rotor's share of the mass, which
        follows from this choice, is subtracted so that it does not count twice. False: no rotor was on. True:
        "gimballed" for a rotor with a gimbal, "rigid" for a rotor without one.
    shaft : "held" or "free"
        Whether the rotor was free to turn about its shaft when `mass` was found; without effect for a point mass.
    shapes : array, shape (..., m, n), optional
        Shapes of the structure for each coordinate, if these differ between designs: the shapes show which coordinates
        of two designs belong together.
    warning : array of str, shape (...), optional
        Why a design is doubtful, a text for each of many designs.
    inputs : tuple of str
        Names of inputs that load the support, such as "flaperon", in rad.
    loads : array (..., n, inputs), optional
        Generalised forces per unit of each input, N or N m per rad.

    Raises
    ------
    InputError
        When sizes differ, a name is taken, or a matrix is not finite, not symmetric, or (mass) negative, and for an
        unknown word.
    """

    names: Sequence[str]
    mass: Array  # this and the next three are kept as arrays, also when given as lists
    damping: Array
    stiffness: Array
    hub: Array
    includes_rotor: bool | str
    shaft: str = "held"
    shapes: Array | None = None
    warning: Array | None = None
    inputs: tuple[str, ...] = ()
    loads: Array | None = None

    symmetric: ClassVar[tuple[str, ...]] = ("mass", "damping", "stiffness")
    wing: ClassVar[WingLift | None] = None

    def __post_init__(self) -> None:
        names = tuple(self.names)
        if len(set(names)) < len(names) or (not names and np.size(self.mass)):
            raise InputError("names", ", ".join(names), "must name each mode, all differently")
        for field, choices in (("includes_rotor", INCLUDES_ROTOR), ("shaft", SHAFT)):
            if not is_choice(getattr(self, field), choices):
                raise InputError(field, getattr(self, field), f"must be {list_choices(choices)}")
        check_support_names("names", names)
        object.__setattr__(self, "names", names)
        self._check_matrices(len(names))

    def _check_matrices(self, n: int) -> None:
        """Keep the matrices as arrays, or refuse matrices of a wrong shape, not symmetric or with a negative mass."""
        object.__setattr__(self, "hub", _finite("hub", self.hub, (len(HUB_AXES), n)))
        for field in ("mass", "damping", "stiffness"):
            matrix = _finite(field, getattr(self, field), (n, n))
            turned = np.swapaxes(matrix, -1, -2)
            rounding = 1e-12 * np.abs(matrix).max(axis=(-2, -1), keepdims=True, initial=0)
            differs = field in self.symmetric and not np.array_equal(matrix, turned)
            if differs and not np.allclose(matrix, turned, rtol=1e-9, atol=rounding):
                raise InputError(field, matrix.tolist(), "must be symmetric")
            object.__setattr__(self, field, matrix)
        if not nowhere_negative(np.real(self.mass)):
            raise InputError("mass", self.mass.tolist(), "must not be negative in any direction")

    def at(self, airspeed: ArrayLike, density: ArrayLike) -> NormalModes:
        """Return the support at airspeeds and densities: itself, since its matrices depend on neither.

        Parameters
        ----------
        airspeed : float or array (...)
            m/s.
        density : float or array (...)
            kg/m³.

        Returns
        -------
        NormalModes
        """
        return self

    def wing_circulation(self, airspeed: ArrayLike, density: ArrayLike) -> WingCirculation | None:
        """Return the work of the lift of the support's wing at airspeeds and densities, if it has one with airloads.

        Parameters
        ----------
        airspeed : float or array (...)
            m/s.
        density : float or array (...)
            kg/m³.

        Returns
        -------
        WingCirculation, or None
        """
        return None if self.wing is None else self.wing.at(airspeed, density)

    @classmethod
    def from_frequencies(
        cls,
        names: Sequence[str],
        generalized_mass: ArrayLike,
        frequency: ArrayLike,
        damping_ratio: ArrayLike,
        hub: ArrayLike,
        includes_rotor: bool | str,
        shaft: str = "held",
        carries: str = "one rotor",
    ) -> NormalModes:
        """Return a support of normal modes: stiffness m ω², damping 2 ζ ω m, with the whole generalised mass m.

        Parameters
        ----------
        names : sequence of str
            As for `NormalModes`.
        generalized_mass, frequency, damping_ratio : array_like, shape (..., n)
            m in kg or kg m², ω in rad/s, ζ as a fraction of critical.
        hub : array_like, shape (..., 6, n)
            As for `NormalModes`, SI.
        includes_rotor, shaft : bool or str, str
            As for `NormalModes`.
        carries : "one rotor" or "two rotors"
            What the structure of the generalised masses carries, see `share_of_one_rotor`.

        Returns
        -------
        NormalModes

        Raises
        ------
        InputError
            When sizes differ, or a value is not finite or negative, and for an unknown word.
        """
        n = (len(names),)
        m = share_of_one_rotor(carries) * _finite("generalized_mass", generalized_mass, n)
        omega = _finite("frequency", frequency, n)
        if np.any(np.real(omega) < 0):
            raise InputError("frequency", np.min(np.real(omega)), "must not be negative")
        zeta = _finite("damping_ratio", damping_ratio, n)
        return cls(
            names=names,
            mass=_diagonal(m),
            damping=_diagonal(2 * zeta * omega * m),
            stiffness=_diagonal(m * omega**2),
            hub=np.asarray(hub),
            includes_rotor=includes_rotor,
            shaft=shaft,
        )


_Support = TypeVar("_Support", bound=NormalModes)


def in_air(
    support: NormalModes, kind: type[_Support], damping: Array, stiffness: Array, **others: Any
) -> _Support:
    """Return a support with the damping and stiffness of an airstream; all else was checked when it was made.

    Parameters
    ----------
    support : NormalModes
    kind : type
        Class of the result, whose other fields `support` or `others` give.
    damping, stiffness : array (..., n, n)
        SI.
    **others
        Further fields that change.

    Raises
    ------
    InputError
        When a matrix is not finite.
    """
    found, size = object.__new__(kind), (len(support.names),) * 2
    others |= {
        "damping": _finite("damping", damping, size),
        "stiffness": _finite("stiffness", stiffness, size),
    }
    for entry in fields(kind):
        own = others[entry.name] if entry.name in others else getattr(support, entry.name)
        object.__setattr__(found, entry.name, own)
    return found


def share_of_one_rotor(carries: str) -> float:
    """Return the share of a structure's matrices that goes with one of its rotors.

    Parameters
    ----------
    carries : "one rotor" or "two rotors"
        Two rotors are those of a whole aircraft, in modes that are all symmetric or all antisymmetric: the left hub
        then moves as the mirror image of the right hub, or opposite to the mirror image, and the whole structure with
        two rotors has the same roots as half of the structure with one rotor.

    Returns
    -------
    float
        1, or ½ with two rotors.

    Raises
    ------
    InputError
        For an unknown word.
    """
    if not is_choice(carries, CARRIES):
        raise InputError("carries", carries, f"must be {list_choices(CARRIES)}")
    return 1.0 if carries == "one rotor" else 0.5


def two_axis_pivot(
    distance: float,
    inertia: ArrayLike,
    stiffness: ArrayLike,
    damping: ArrayLike = (0.0, 0.0),
    *,
    includes_rotor: bool | str,
    shaft: str = "held",
) -> NormalModes:
    """Return a rigid shaft that pitches and yaws about a point behind the hub, like a propeller in its nacelle.

    Pitch raises the hub along I and yaw moves it outboard along J, each by `distance` per radian.

    Parameters
    ----------
    distance : float or array (...)
        Distance from the pivot forward to the hub, m.
    inertia, stiffness, damping : array_like, shape (..., 2)
        Values of pitch and yaw about the pivot: kg m², N m/rad, N m s/rad (viscous; for hysteretic damping see
        `proprotor.model.structural_damping`).
    includes_rotor, shaft : bool or str, str
        How the inertias include the rotor's, with its mass at the hub: as for `NormalModes`.

    Returns
    -------
    NormalModes
        With the coordinates pitch and yaw, rad.

    Raises
    ------
    InputError
        When a value is not finite or an inertia negative.
    """
    shape = (*np.shape(distance), len(HUB_AXES), 2)
    hub = np.zeros(shape, dtype=np.result_type(distance, float))
    hub[..., HUB_AXES.index("x"), 0], hub[..., HUB_AXES.index("alpha_y"), 0] = distance, 1.0
    hub[..., HUB_AXES.index("y"), 1], hub[..., HUB_AXES.index("alpha_x"), 1] = distance, -1.0
    return NormalModes(
        names=("pitch", "yaw"),
        mass=_diagonal(_finite("inertia", inertia, (2,))),
        damping=_diagonal(_finite("damping", damping, (2,))),
        stiffness=_diagonal(_finite("stiffness", stiffness, (2,))),
        hub=hub,
        includes_rotor=includes_rotor,
        shaft=shaft,
    )


def rigid_support() -> NormalModes:
    """Return a support that does not move: no coordinate, the hub fixed.

    Returns
    -------
    NormalModes
    """
    none = np.zeros((0, 0))
    return NormalModes((), none, none, none, hub=np.zeros((len(HUB_AXES), 0)), includes_rotor=False)


def signed_names(hub: Mapping[str, str], what: str) -> Iterator[tuple[str, str, float]]:
    """Yield each hub axis with the name given for the axis, and the sign before that name.

    Parameters
    ----------
    hub : mapping of str to str
        For each of `HUB_AXES` a name, with "-" before it if the named motion points the other way.
    what : str
        What the names are, for the message.

    Raises
    ------
    InputError
        For an axis that is missing or unknown.
    """
    for axis in hub:
        if axis not in HUB_AXES:
            raise InputError(f"hub.{axis}", hub[axis], unknown_name(axis, HUB_AXES, "axis"))
    for axis in HUB_AXES:
        if axis not in hub:
            raise InputError(f"hub.{axis}", None, f"is missing: all six {what} of the hub must be named")
        written = str(hub[axis])
        yield axis, written.removeprefix("-"), -1.0 if written.startswith("-") else 1.0


def _finite(field: str, value: ArrayLike, shape: tuple[int, ...]) -> Array:
    """Return a read-only array whose last axes have the shape; refuse another shape or numbers that are not finite."""
    array = np.array(value, dtype=complex if np.iscomplexobj(value) else float)
    if array.shape[-len(shape) :] != shape:
        raise InputError(field, f"array of shape {array.shape}", f"must have the shape {shape}")
    if not np.isfinite(array).all():
        raise InputError(field, array.tolist(), "must be finite")
    array.flags.writeable = False
    return array


def _diagonal(values: Array) -> Array:
    """Return diagonal matrices (..., n, n) of values (..., n)."""
    return values[..., None] * np.eye(values.shape[-1])


def hub_components(hub: Mapping[str, str], components: Sequence[str]) -> list[tuple[str, float, str]]:
    """Return component, sign and axis of the hub for each of x … αz.

    Parameters
    ----------
    hub : mapping of str to str
        As for `signed_names`.
    components : sequence of str
        Names of the motions of a point in the file, displacements first.

    Raises
    ------
    InputError
        For an axis or a component that is missing or unknown.
    """
    found = []
    for axis, name, sign in signed_names(hub, "motions"):
        if name not in components:
            raise InputError(f"hub.{axis}", hub[axis], unknown_name(name, components, "component"))
        found.append((name, sign, axis))
    return found


def motion_of_hub(motion: Array, hub: Mapping[str, str], components: Sequence[str]) -> Array:
    """Return the rows x … αz of motions whose rows are the components of a file; see `hub_components`."""
    named = hub_components(hub, components)
    return np.array([sign * motion[components.index(name)] for name, sign, _ in named])
