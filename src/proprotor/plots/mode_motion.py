"""Motion of wing, mast and blades in a mode, as points in space: the numbers behind a picture of the mode.

Positions are as in the derivation: a straight blade with a flap and a lag hinge on precone, in its trim state, on
a gimbal. Motions are linear in the coordinates. Coordinates of the fixed frame give the deflection of the blade that
passes an azimuth, β(ψ) = β_0 + β_1c cos ψ + β_1s sin ψ. Therefore blades are drawn at azimuths that stand still, and
the path of the tips is a closed line.

The wing is a sketch. The analysis knows only how a support moves the hub; between root and tip the sketch bends as a
cantilever that is loaded at its tip, and twists in proportion to the distance from its root.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from proprotor.case import Case
from proprotor.errors import InputError, check_known
from proprotor.model.linear_model import LinearModel
from proprotor.model.stamp import Stamp, of_model
from proprotor.rotor.motions import HALVES, half_of
from proprotor.rotor.rotor import Rotor
from proprotor.rotor.trim import Trim
from proprotor.typing import Array
from proprotor.units import in_metres_per_second

_SPAN, _MAST, _CHORD = 1.333, 0.342, 0.42  # of the XV-15, in radii: for a deck without a wing
_PER_BLADE, _PER_WING, _PER_CIRCLE = 12, 12, 73  # points
_LARGEST_TRAVEL, _LARGEST_ANGLE = 0.22, 0.35  # radii, rad: larger motions would look torn
_HARMONIC = re.compile(r"(flap|lag|pitch|gimbal)_(0|(\d+)([cs]))")


class WingSketch(NamedTuple):
    """Size of a wing to be drawn.

    Parameters
    ----------
    span : float
        From the root to the axis of the pylon, m.
    mast : float
        From the wing forward to the hub, m.
    chord : float
        Chord of the wing, m.
    sweep : float
        Sweep of the wing's axis, rad, positive backwards.
    assumed : bool
        Whether the size is assumed because the deck does not give it.
    root : float
        From the plane of symmetry of an aircraft to the root, m.
    """

    span: float
    mast: float
    chord: float
    sweep: float = 0.0
    assumed: bool = False
    root: float = 0.0


class Part(NamedTuple):
    """A line of the picture.

    Parameters
    ----------
    name : str
    points : array (k, 3)
        x, y, z from the hub at trim, m.
    motion : array (k, 3)
        Complex amplitudes of the points, m.
    """

    name: str
    points: Array
    motion: Array


@dataclass(frozen=True, eq=False)
class ModeMotion:
    """A mode as moving lines.

    Attributes
    ----------
    mode, case : str
        Names.
    airspeed : float
        m/s.
    eigenvalue : complex
        rad/s, in the upper half plane.
    rotor_speed, radius : float
        rad/s, m.
    parts : tuple of Part
        Motions scaled so that they can be seen.
    sketched : bool
        Whether the size of the wing is assumed because the deck does not give it.
    warning : str
        What makes the mode doubtful; empty if nothing does.
    stamp : mapping of str to str
        The case and the options in force, see `proprotor.model.stamp`.
    """

    mode: str
    case: str
    airspeed: float
    eigenvalue: complex
    rotor_speed: float
    radius: float
    parts: tuple[Part, ...]
    sketched: bool
    warning: str = ""
    stamp: Stamp = field(default_factory=dict)

    def at(self, phase: float) -> dict[str, Array]:
        """Return the points of every part at a phase of the cycle, without growth or decay.

        Parameters
        ----------
        phase : float
            Phase of the cycle, rad.

        Returns
        -------
        dict of str to array (k, 3)
            Points in x, y, z from the hub at trim, m, by the name of the part.
        """
        return {part.name: part.points + (part.motion * np.exp(1j * phase)).real for part in self.parts}


def mode_motion(
    case: Case, airspeed: Any, mode: str, *, wing: WingSketch | None = None, **options: Any
) -> ModeMotion:
    """Return the motion of one mode of a case.

    Parameters
    ----------
    case : Case
        One design.
    airspeed : float in m/s, text such as "300 kt", or pint quantity
    mode : str
        Name that the mode has at the airspeed.
    wing : WingSketch, optional
        Size of the wing; by default that of the deck, or the proportions of the XV-15 if the deck gives none.
    **options
        See `proprotor.rotor.options.Options`.

    Returns
    -------
    ModeMotion

    Raises
    ------
    InputError
        For an airspeed that cannot be analysed, a mode that is unknown or does not oscillate, or coordinates of blades
        that belong to no azimuth.
    """
    speed = in_metres_per_second(airspeed, case.operation.density).reshape(-1)
    if len(speed) != 1:
        raise InputError("airspeed", airspeed, "must be one speed")
    found = case.sweep(speed, **options).isel(airspeed=0)
    if found.reason.item():
        raise InputError("airspeed", airspeed, found.reason.item())
    check_known("mode", mode, found.mode.values.tolist(), "mode")
    chosen = found.sel(mode=mode)
    value, shape = complex(chosen.eigenvalue.item()), chosen["shape"].values
    if not value.imag:
        raise InputError("mode", mode, "does not oscillate at this airspeed")
    if value.imag < 0:
        value, shape = value.conjugate(), shape.conj()
    model = case.linearize(speed[0], **options)
    sketch = wing or sketch_of(case)
    by_side = [_parts(side, sketch) for side in _sides(case, model, shape, sketch)]
    parts = [part for own, _ in by_side for part in own]
    largest_angle = max(largest for _, largest in by_side)
    scale = _scale(parts, largest_angle, float(case.rotor.radius))
    return ModeMotion(
        mode=mode,
        case=case.title or case.name,
        airspeed=float(speed[0]),
        eigenvalue=value,
        rotor_speed=float(case.operation.rotor_speed),
        radius=float(case.rotor.radius),
        parts=tuple(part._replace(motion=scale * part.motion) for part in parts),
        sketched=sketch.assumed,
        warning=str(model.trim.warning),
        stamp=of_model(model),
    )


def sketch_of(case: Case) -> WingSketch:
    """Return the size of a case's wing, or the proportions of the XV-15 if the deck gives no wing.

    Parameters
    ----------
    case : Case

    Returns
    -------
    WingSketch
        m and rad.
    """
    given = {path.removeprefix("support."): number.si for path, number in case.given.items()}
    radius = float(case.rotor.radius)
    if "distance" in given:  # a pivot: a mast and no wing
        return WingSketch(0.0, float(given["distance"]), 0.0)
    for section in ("", "wing_aerodynamics."):
        if f"{section}span" in given:
            span, mast = given[f"{section}span"], given[f"{section}mast_length"]
            chord = given.get("wing_aerodynamics.chord", _CHORD * radius)
            sweep = given.get(f"{section}sweep", 0.0)
            root = float(given.get("carry_through.half_width", 0.0))
            return WingSketch(float(span), float(mast), float(chord), float(sweep), root=root)
    return WingSketch(_SPAN * radius, _MAST * radius, _CHORD * radius, assumed=True)


class _Side(NamedTuple):
    """A rotor of a case with its wing: the trim, and the motion in a mode.

    coordinates : of the rotor by name; hub (6,) : displacement and rotation of the hub, and rigid (6,), the part of
    it in which the aircraft moves as one body; left : m from the right hub to the left one, for a left side, whose
    motion is that of its mirror image.
    """

    rotor: Rotor
    trim: Trim
    coordinates: dict[str, complex]
    hub: Array
    rigid: Array
    left: float | None = None


def _sides(case: Case, model: LinearModel, shape: Array, wing: WingSketch) -> list[_Side]:
    """Return the rotor of a case in a mode, or both rotors of an aircraft."""
    own = dict(zip(model.dofs, shape.tolist(), strict=True))
    if model.hub is None or model.left_hub is None:
        hub = shape[:6] if model.hub is None else model.hub @ shape
        return [_Side(case.rotor, model.trim, own, hub, np.zeros(6))]
    moved = np.where(np.isin(model.dofs, model.rigid_body), shape, 0)
    right, left = ((one, one @ shape, one @ moved) for one in (model.hub, model.left_hub))
    other = case.rotor if case.left is None else case.left.rotor
    trim = model.trim if model.left is None else model.left.trim
    return [
        _Side(case.rotor, model.trim, _of_side(own, 1), *right[1:]),
        _Side(other, trim, _of_side(own, -1), *left[1:], left=2 * (wing.span + wing.root)),
    ]


def _of_side(coordinates: dict[str, complex], sign: int) -> dict[str, complex]:
    """Return the coordinates of the right rotor (1) or of the left one (-1), sum or difference of both halves."""
    found: dict[str, complex] = {}
    for name, value in coordinates.items():
        half, own = half_of(name)
        found[own] = found.get(own, 0) + (sign * value if half == HALVES[1] else value)
    return found


def _mirrored(part: Part, left: float) -> Part:
    """Return a line of a left side, from its mirrored axes, where the right hub has its axes."""
    mirror = np.array([1.0, -1.0, 1.0])
    return Part(f"left {part.name}", part.points * mirror - np.array([0.0, left, 0.0]), part.motion * mirror)


def _parts(side: _Side, wing: WingSketch) -> tuple[list[Part], float]:
    """Return all lines of a side with their motions, and the largest angle of any coordinate."""
    blade, coordinates, hub = _Blade(side.rotor, side.trim), side.coordinates, side.hub
    azimuths = 2 * np.pi * np.arange(int(side.rotor.n_blades)) / int(side.rotor.n_blades)
    parts = _wing(wing, hub - side.rigid)
    for place, part in enumerate(parts):
        carried = side.rigid[:3] + np.cross(side.rigid[3:], part.points)
        parts[place] = part._replace(motion=part.motion + carried)
    for number, azimuth in enumerate(azimuths.tolist(), start=1):
        parts.append(Part(f"blade {number}", *blade.outline(azimuth, coordinates, hub)))
    circle = np.linspace(0, 2 * np.pi, _PER_CIRCLE)
    tips = [blade.line(azimuth, coordinates, hub) for azimuth in circle.tolist()]
    rings = np.array([points[-1] for points, _ in tips]), np.array([motion[-1] for _, motion in tips])
    parts.append(Part("tip path", *rings))
    angles = [abs(value) for name, value in coordinates.items() if _HARMONIC.fullmatch(name)]
    if side.left is not None:
        parts = [_mirrored(part, side.left) for part in parts]
    return parts, max([*angles, *np.abs(hub[3:]).tolist()])


def _scale(parts: list[Part], largest_angle: float, radius: float) -> float:
    """Return the factor that makes a mode as large as it can be drawn."""
    travel = max(float(np.linalg.norm(np.abs(part.motion), axis=1).max()) for part in parts)
    limits = [_LARGEST_TRAVEL * radius / travel] if travel > 0 else []
    limits += [_LARGEST_ANGLE / largest_angle] if largest_angle > 0 else []
    return min(limits, default=1.0)


def _wing(wing: WingSketch, hub: Array) -> list[Part]:
    """Return the mast, and the outline of the wing from its root to the pylon, in coordinates from the hub."""
    still, turn = hub[:3], hub[3:]
    foot = np.array([0.0, 0.0, -wing.mast])
    mast = np.array([np.zeros(3), foot])
    parts = [Part("mast", mast, still + np.cross(turn, mast))]
    if not wing.span:
        return parts
    share = np.linspace(0, 1, _PER_WING)[:, None]
    axis = np.array([0.0, wing.span, -wing.span * np.tan(wing.sweep)])
    line = foot - axis + share * axis
    # A cantilever with a given displacement and slope at its end: Hermite's cubics.
    slope = np.cross(turn, axis)
    bent = (3 * share**2 - 2 * share**3) * (still + np.cross(turn, foot)) + (share**3 - share**2) * slope
    twist = np.array([0.0, turn[1], 0.0])
    edges = [np.array([0.0, 0.0, offset * wing.chord]) for offset in (0.4, -0.6)]
    points = [line + edge for edge in edges]
    motions = [bent + share * np.cross(twist, edge) for edge in edges]
    around = (np.concatenate([front, rear[::-1]]) for front, rear in (points, motions))
    return [*parts, Part("wing", *around)]


class _Blade:
    """A blade of a rotor, in its trim state.

    r, flap_arm, lag_arm, chord : arrays (k,), m; pitch : of the sections (k,), rad; the others are angles in rad and a
    ratio of angles.
    """

    def __init__(self, rotor: Rotor, trim: Trim) -> None:
        self.r = np.linspace(float(rotor.root_cutout), float(rotor.radius), _PER_BLADE)
        self.flap_arm = np.maximum(self.r - float(rotor.flap_hinge_offset), 0)
        self.lag_arm = np.maximum(self.r - float(rotor.lag_hinge_offset), 0)
        self.linkages = {
            "flap": float(rotor.kinematic_pitch_flap_coupling),
            "lag": float(rotor.kinematic_pitch_lag_coupling),
        }
        by_hinges = self.linkages["flap"] * float(trim.coning) + self.linkages["lag"] * float(trim.lag)
        self.pitch = float(trim.pitch) - by_hinges + np.asarray(rotor.twist_at(self.r))
        self.chord = np.broadcast_to(rotor.chord_at(self.r), self.r.shape)
        self.precone, self.flap, self.lag = float(rotor.precone), float(trim.coning), float(trim.lag)
        self.pitch_gimbal_coupling = float(rotor.pitch_gimbal_coupling)

    def line(self, azimuth: float, coordinates: dict[str, complex], hub: Array) -> tuple[Array, Array]:
        """Return points (k, 3) of the reference line from the hub, and the motions of the points."""
        i, j, k = _axes(azimuth)
        inner, outer = self.precone, self.precone + self.flap
        d1, d2 = np.cos(inner) * j + np.sin(inner) * k, np.cos(outer) * j + np.sin(outer) * k
        normal = np.cos(outer) * k - np.sin(outer) * j
        b, z = self.flap_arm[:, None], self.lag_arm[:, None]
        cosine, sine = np.cos(self.lag), np.sin(self.lag)
        points = (self.r[:, None] - b) * d1 + b * d2 + z * ((cosine - 1) * d2 + sine * i)
        by_flap = (b + z * (cosine - 1)) * normal
        by_lag = z * (cosine * i - sine * d2)
        motion = _at_azimuth("flap", azimuth, coordinates) * by_flap
        motion = motion + _at_azimuth("lag", azimuth, coordinates) * by_lag
        carried = hub[:3] + np.cross(_turn(coordinates, hub), points)  # by hub, gimbal and azimuth
        return points, motion + carried

    def outline(self, azimuth: float, coordinates: dict[str, complex], hub: Array) -> tuple[Array, Array]:
        """Return the closed outline (2 k + 1, 3), leading edge outwards and trailing edge back, and its motion."""
        points, motion = self.line(azimuth, coordinates, hub)
        i, j, k = _axes(azimuth)
        normal = np.cos(self.precone + self.flap) * k - np.sin(self.precone + self.flap) * j
        cosine, sine = np.cos(self.pitch)[:, None], np.sin(self.pitch)[:, None]
        ahead = sine * normal - cosine * i  # towards the leading edge
        turned = cosine * normal + sine * i  # change of `ahead` with the pitch
        tilt = coordinates.get("gimbal_1c", 0.0), coordinates.get("gimbal_1s", 0.0)
        flap = tilt[0] * np.cos(azimuth) + tilt[1] * np.sin(azimuth)
        roll = tilt[1] * np.cos(azimuth) - tilt[0] * np.sin(azimuth)
        pitch = _at_azimuth("pitch", azimuth, coordinates) - self.pitch_gimbal_coupling * flap - roll
        pitch -= sum(
            ratio * _at_azimuth(hinge, azimuth, coordinates) for hinge, ratio in self.linkages.items()
        )
        turn = _turn(coordinates, hub)
        by_pitch = pitch * turned + np.cross(turn, ahead)
        offsets = [share * self.chord[:, None] for share in (0.25, -0.75)]  # from the axis of pitch
        edges = [points + offset * ahead for offset in offsets]
        moved = [motion + offset * by_pitch for offset in offsets]
        outline, motion = (np.concatenate([front, rear[::-1], front[:1]]) for front, rear in (edges, moved))
        return outline, motion


def _axes(azimuth: float) -> tuple[Array, Array, Array]:
    """Return unit vectors in x, y, z: i against the rotation, j along the blade, k along the shaft."""
    cosine, sine = np.cos(azimuth), np.sin(azimuth)
    return np.array([sine, -cosine, 0.0]), np.array([cosine, sine, 0.0]), np.array([0.0, 0.0, 1.0])


def _at_azimuth(stem: str, azimuth: float, coordinates: dict[str, complex]) -> complex:
    """Return an angle of the blade that passes an azimuth, from the coordinates of the fixed frame."""
    total = 0j
    for name, value in coordinates.items():
        if not name.startswith(f"{stem}_"):
            continue
        found = _HARMONIC.fullmatch(name)
        if found is None:
            rule = "is no motion of the fixed frame: leave reactionless=True out"
            raise InputError("coordinates", name, rule)
        n = int(found[3] or 0)
        total += value * (np.sin(n * azimuth) if found[4] == "s" else np.cos(n * azimuth))
    return total


def _turn(coordinates: dict[str, complex], hub: Array) -> Array:
    """Return the rotation (3,) of the whole rotor: hub, gimbal g = β_GS I - β_GC J, and azimuth."""
    gimbal = coordinates.get("gimbal_1s", 0.0), -coordinates.get("gimbal_1c", 0.0)
    return np.array([hub[3] + gimbal[0], hub[4] + gimbal[1], hub[5] + coordinates.get("azimuth", 0.0)])
