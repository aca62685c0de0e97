"""Take the rotor's share off the masses of a support whose modes were measured or computed with the rotor on.

The share depends on how the rotor was held at that time, never on the options of an analysis. It is the rotor's mass
matrix at rest with locked blades, reduced by the motion of a free gimbal or a free shaft (a Schur complement).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError
from proprotor.model.mass_at_rest import MASS_AT_REST
from proprotor.rotor.kept import kept
from proprotor.rotor.motions import HUB
from proprotor.support.normal_modes import NormalModes
from proprotor.typing import Array

_TRANSLATION = np.diag([1.0] * 3 + [0.0] * 3)
_ABOUT_SHAFT = [HUB.index("alpha_z")]  # moves a rotor at rest exactly as the azimuth does
_GIMBAL = [MASS_AT_REST.index(name) for name in ("gimbal_1c", "gimbal_1s")]
_ROUNDING = 1e-9  # relative to a mass scaled to a unit diagonal, as for the masses of a support
_REPORTED = 1e-3  # smallest relative change of a frequency by the hub spring that gives a warning
_NO_MASS = 1e-12  # relative to the largest eigenvalue of a scaled mass


def _how_held(support: NormalModes, mass_at_rest: Array) -> str:
    """Return how the rotor was held: as the support says; for True "gimballed" with a gimbal, "rigid" without."""
    if isinstance(support.includes_rotor, str):
        return support.includes_rotor
    return "gimballed" if mass_at_rest.shape[-1] == len(MASS_AT_REST) else "rigid"


def rotor_share(mass_at_rest: ArrayLike, held: str, shaft: str = "held") -> Array:
    """Return the mass that a rotor adds at its hub.

    Parameters
    ----------
    mass_at_rest : array_like, shape (..., 8, 8) or (..., 6, 6)
        `proprotor.model.mass_at_rest.mass_at_rest` of the rotor, or on the hub's coordinates alone for a rotor without
        gimbal; SI.
    held : "gimballed", "rigid" or "mass only"
        Free to tilt on its gimbal, as one body with the shaft, or a point mass at the hub.
    shaft : "held" or "free"
        Whether the rotor could turn about its shaft; without effect on a point mass.

    Returns
    -------
    array (..., 6, 6)
        On the hub's coordinates: kg, kg m and kg m².

    Raises
    ------
    InputError
        When the matrix has another size, or a gimballed rotor has no gimbal.
    """
    mass = np.asarray(mass_at_rest)
    if mass.shape[-2:] not in ((len(HUB),) * 2, (len(MASS_AT_REST),) * 2):
        raise InputError("mass_at_rest", f"array of shape {mass.shape}", "must be (..., 6, 6) or (..., 8, 8)")
    if held == "mass only":
        return np.asarray(mass[..., :1, :1] * _TRANSLATION)
    if held == "gimballed" and mass.shape[-1] == len(HUB):
        raise InputError("includes_rotor", held, 'needs a rotor with a gimbal; this one has none: "rigid"')
    free = (_GIMBAL if held == "gimballed" else []) + (_ABOUT_SHAFT if shaft == "free" else [])
    return _released(mass, free) if free else mass[..., : len(HUB), : len(HUB)]


def _released(mass: Array, free: list[int]) -> Array:
    """Return the mass that the hub moves when some coordinates are free to follow."""
    own, coupling = mass[..., free, :][..., free], mass[..., free, : len(HUB)]
    without = np.diagonal(own, axis1=-2, axis2=-1) == 0  # a coordinate without mass does not follow
    own = own + without[..., None] * np.eye(len(free))
    at_hub = mass[..., : len(HUB), : len(HUB)]
    return np.asarray(at_hub - np.swapaxes(coupling, -1, -2) @ np.linalg.solve(own, coupling))


def without_rotors(
    support: NormalModes, rotors: Iterable[tuple[Array, Array | None]]
) -> tuple[Array, Array | None]:
    """Take the shares of the rotors off the mass of a support.

    Parameters
    ----------
    support : NormalModes
    rotors : iterable of (hub, mass_at_rest)
        The motion of each rotor's hub (..., 6, n), and the rotor's mass at rest as for `rotor_share`.

    Returns
    -------
    mass : array (..., n, n)
        The mass of the support without the rotors, SI.
    refusal : array (...) of str, or None
        The reason for which the remainder is no valid mass, "" for a valid one; None where all are valid.

    Raises
    ------
    InputError
        When a mass at rest is needed and missing.
    """
    given: list[Array] = []
    for hub, at_rest in rotors if support.includes_rotor else ():
        if at_rest is None:
            rule = "must be given with the model: the support's masses include the rotor"
            raise InputError("mass_at_rest", None, rule)
        given += [hub, at_rest]
    if not given:
        return support.mass, None
    held = (*(_how_held(support, at_rest) for at_rest in given[1::2]), support.shaft)
    return _without(held, tuple(support.names), support.mass, *given)


@kept
def _without(
    held: tuple[str, ...], names: tuple[str, ...], whole: Array, *rotors: Array
) -> tuple[Array, Array | None]:
    """Return mass and refusal as `without_rotors` does, the same at every airspeed.

    Parameters
    ----------
    held : tuple of str
        How each rotor was held, then whether the shaft was.
    names : tuple of str
        Of the coordinates of the support.
    whole : array (..., n, n)
        Mass of the support with the rotors.
    *rotors : array
        Hub motion and mass at rest of each rotor in turn.
    """
    *ways, shaft = held
    mass = whole
    for way, hub, at_rest in zip(ways, rotors[::2], rotors[1::2], strict=True):
        mass = mass - np.swapaxes(hub, -1, -2) @ rotor_share(at_rest, way, shaft) @ hub
    if _all_positive(mass, whole):
        return mass, None
    given, refusal = np.broadcast_to(np.real(whole), mass.shape), np.full(mass.shape[:-2], "", dtype=object)
    for place in np.ndindex(refusal.shape):
        refusal[place] = _refusal(np.real(mass[place]), given[place], names, ways[-1])
    return mass, refusal


def settled(support: NormalModes, mass_at_rest: Array) -> NormalModes:
    """Return the support with the way its rotor was held in words; refuse a support without mass of its own.

    In a batch each design fails alone, when the rotor is mounted.

    Raises
    ------
    InputError
        When the share of the rotor leaves no mass; the rule names includes_rotor and the units.
    """
    _, refusal = without_rotors(support, [(support.hub, mass_at_rest)])
    refuse(refusal, support)
    if support.includes_rotor is not True:
        return support
    return replace(support, includes_rotor=_how_held(support, mass_at_rest))


def refuse(refusal: Array | None, support: NormalModes) -> None:
    """Raise an error if a single design is refused; of many designs, each fails alone."""
    if refusal is not None and not refusal.ndim and (reason := str(refusal[()])):
        raise InputError("support.includes_rotor", support.includes_rotor, reason)


def _all_positive(left: Array, given: Array) -> bool:
    """Return whether no remaining mass is negative, but for rounding: all have a Cholesky factor."""
    scaled, _ = _scaled(np.real(left), np.real(given))
    try:
        np.linalg.cholesky(scaled + _ROUNDING * np.eye(scaled.shape[-1]))
    except np.linalg.LinAlgError:
        return False
    return True


def _scaled(left: Array, given: Array) -> tuple[Array, Array]:
    """Return the remaining mass for coordinates with a unit diagonal of the given mass, and the scale of each."""
    diagonal = np.diagonal(given, axis1=-2, axis2=-1) + np.abs(np.diagonal(left, axis1=-2, axis2=-1))
    size = np.sqrt(np.where(diagonal > 0, diagonal, 1.0))
    return left / size[..., :, None] / size[..., None, :], size


def _refusal(left: Array, given: Array, names: Sequence[str], held: str) -> str:
    """Return the motion of one design in which the rotor's share exceeds the whole mass, in words; "" without one."""
    scaled, size = _scaled(left, given)
    values, motions = np.linalg.eigh(scaled)
    if values[0] >= -_ROUNDING:
        return ""
    motion = motions[:, 0] / size
    whole, rest = motion @ given @ motion, motion @ left @ motion
    most = names[int(np.argmax(np.abs(motions[:, 0])))]
    times = f"{1 - rest / whole:.3g} times" if whole > 0 else "more than"
    return (
        f"leaves no mass: in {most} the share of the rotor, {held}, is {times} the whole mass given. Check how the "
        "rotor was held (false where it was not on) and the units (lb for slug, length_unit, mass_unit)"
    )


def spring_warnings(
    support: NormalModes, mass_at_rest: Array, gimbal_stiffness: ArrayLike
) -> tuple[str, ...]:
    """Return a warning of modes whose frequencies the hub spring of a gimballed rotor changes, or no warning.

    The rotor's share is that of a gimbal without spring, because a spring has no mass.

    Parameters
    ----------
    support : NormalModes
    mass_at_rest : array (..., 8, 8)
    gimbal_stiffness : float or array (...)
        N m/rad.
    """
    if not support.includes_rotor or _how_held(support, mass_at_rest) != "gimballed":
        return ()
    frequency, ratio, names = _modes_with_spring(support, np.real(mass_at_rest), np.real(gimbal_stiffness))
    changes = [
        f"{name} at {hertz:.4g} Hz by {100 * (times - 1):+.2g} %"
        for name, hertz, times in zip(names, frequency / (2 * np.pi), ratio, strict=True)
        if abs(times - 1) > _REPORTED
    ]
    if not changes:
        return ()
    return (
        f"At rest the hub spring moves {', '.join(changes)} from the frequency given: the rotor's share of the "
        "support's modes is that of a gimbal without spring, for a spring is no mass.",
    )


def _modes_with_spring(
    support: NormalModes, mass_at_rest: Array, gimbal_stiffness: ArrayLike
) -> tuple[Array, Array, list[str]]:
    """Return frequencies (n,) of the undamped modes in rad/s, their ratios with and without spring, and names.

    Of many designs, each mode is returned for the design that the spring changes most. For one mode and the gimbal tilt
    it causes, with unit modal mass, tilt c per unit, gimbal inertia I and spring K, the squares λ of the frequencies
    solve I λ² - (I (ω² + K c²) + K) λ + ω² K = 0.
    """
    square, shapes, scaled = undamped_modes(np.real(support.mass), np.real(support.stiffness))
    own = mass_at_rest[..., _GIMBAL, :][..., _GIMBAL]
    tilt = np.linalg.solve(own, mass_at_rest[..., _GIMBAL, : len(HUB)]) @ np.real(support.hub) @ shapes
    inertia, spring = own[..., :1, 0], np.asarray(gimbal_stiffness, dtype=float)[..., None]
    middle = inertia * (square + spring * np.sum(tilt**2, axis=-2)) + spring
    root = np.sqrt(np.maximum(middle**2 - 4 * inertia * square * spring, 0.0))
    upper = (middle + root) / (2 * inertia)
    lower = square * spring / (inertia * upper)
    held = square > 0
    found = np.where(spring < inertia * square, upper, lower)
    ratio = np.where(held, np.sqrt(found / np.where(held, square, 1.0)), 1.0)
    names = np.array(support.names)[np.abs(scaled).argmax(axis=-2)]
    n = ratio.shape[-1]
    square, ratio, names = (
        np.broadcast_to(part, ratio.shape).reshape(-1, n) for part in (square, ratio, names)
    )
    worst = np.abs(ratio - 1).argmax(axis=0), np.arange(n)
    return np.sqrt(square[worst]), ratio[worst], names[worst].tolist()


def undamped_modes(mass: Array, stiffness: Array) -> tuple[Array, Array, Array]:
    """Return ω² (..., n), shapes of unit modal mass, and the same shapes scaled; zero for a motion without mass."""
    size = np.sqrt(np.diagonal(mass, axis1=-2, axis2=-1))
    size = np.where(size > 0, size, 1.0)
    values, vectors = np.linalg.eigh(mass / size[..., :, None] / size[..., None, :])
    has_mass = values > _NO_MASS * values[..., -1:]
    root = np.where(has_mass, 1 / np.sqrt(np.where(has_mass, values, 1.0)), 0.0)
    inverse = (vectors * root[..., None, :]) @ np.swapaxes(vectors, -1, -2) / size[..., :, None]
    flexible = np.swapaxes(inverse, -1, -2) @ stiffness @ inverse
    square, turned = np.linalg.eigh((flexible + np.swapaxes(flexible, -1, -2)) / 2)
    shapes = inverse @ turned
    return np.where(square > _NO_MASS * square[..., -1:], square, 0.0), shapes, shapes * size[..., :, None]
