"""What each input of the whole XV-15 does to its stability boundaries, one input at a time.

    python -m benchmarks.bell_effects           # prints the table
    python -m benchmarks.bell_effects --page    # and writes it into docs/xv15-aircraft.md

A row has the first boundary of each symmetry at 458 rpm, how both fall with the rotor speed, and what 20 % less
stiffness of wing and pylon and the loss of the downstop do. The ranges are judgements of what an input could be,
not measured scatter.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from rich.console import Console

import proprotor as pp
from benchmarks.bell_points import CONFIGURATIONS, SYMMETRIES, Crossing, boundaries, first_crossings
from benchmarks.page_table import PageTable, page_is_wanted

RPM_OF_SLOPES = (380.0, 458.0, 517.0)  # where Bell has points of both modes below a tip Mach number of .9
_AT = RPM_OF_SLOPES.index(458.0)
_ON, _SOFT, _OFF = CONFIGURATIONS
ACREE = 335  # kt, antisymmetric beam at 458 rpm: Acree, Peyran and Johnson 1999, another analysis
_HEADINGS = (
    "on the downstop at 458 rpm, KTAS",
    *("symmetric", "antisymmetric", "its mode", "slope, kt/rpm, sym.", "anti."),
    *("20 % less stiff, kt, sym.", "anti.", "off the downstop, kt, sym.", "anti."),
)
_OTHERS = [
    ("Bell (NASA TM X-62,407)", "400", "465", "", "-0.23", "-0.11", "-34", "-10", "-19", "-39"),
    ("Acree, Peyran and Johnson 1999", "", f"{ACREE}", *[""] * 7),
]


class Change(NamedTuple):
    """Settings of the deck and options of the model that change one input."""

    settings: Mapping[str, str] = {}
    options: Mapping[str, Any] = {}


class Effect(NamedTuple):
    """Boundaries with one input changed; knots, and knots per rpm; NaN where there is no boundary.

    reason : why the model cannot have the change, "" where it can.
    at_458 : first boundary of each symmetry at 458 rpm on the downstop.
    slope : of the boundary of each symmetry over the rotor speed.
    softer, off : change of each boundary at 458 rpm with 20 % less stiffness, and off the downstop.
    """

    reason: str
    at_458: tuple[Crossing, ...] = ()
    slope: tuple[float, ...] = ()
    softer: tuple[float, ...] = ()
    off: tuple[float, ...] = ()


def _fuselage(**values: str) -> Change:
    return Change({f"support.fuselage.{name}": value for name, value in values.items()})


def _inertias(**values: float) -> Change:
    return _fuselage(**{f"{axis}_inertia": f"{value:g} slug*ft**2" for axis, value in values.items()})


def _damping(percent: float) -> Change:
    names = ("damping_ratio", *(f"{kind}_damping_ratio" for kind in ("beam", "chord", "torsion")))
    return Change({f"support.{name}": f"{percent:g} %" for name in names})


def _rotor(**values: str) -> Change:
    return Change({f"rotor.{name}": value for name, value in values.items()})


def _box(**values: str) -> Change:
    return Change({f"support.carry_through.{name}": value for name, value in values.items()})


_NO_AREA = "1e-6 ft**2"
_PUBLISHED = {"roll": 40500, "pitch": 13200, "yaw": 50300}  # slug ft², NASA TM X-62,407
_RECALLED = {"roll": 52800, "pitch": 21400, "yaw": 69400}  # slug ft², of published simulation models


def changes() -> Iterator[tuple[str, Change]]:
    """Yield a name and a change for each row."""
    yield "as the deck is", Change()
    yield "without Prandtl and Glauert's factor", Change(options={"compressibility": False})
    for stiffness in (7400, 11000):
        yield f"K_θ {stiffness:,} ft lbf/rad", _rotor(control_stiffness=f"{stiffness} ft*lbf/rad")
    yield "rigid in pitch", Change(options={"pitch": "rigid"})
    for percent in (0, 3):
        yield f"structural damping {percent} %", _damping(percent)
    for degrees in (10, 25):
        yield f"δs {degrees}° (15°)", _rotor(structural_pitch_offset=f"{degrees} deg")
    yield "precone 1.5° (2.5°)", _rotor(precone="1.5 deg")
    bell = {"structure": "tabulated", "frequencies": pp.load_case("xv15-bell-frequencies").frequencies}
    yield "Bell's blade frequencies", Change(options=bell)
    incompressible = {"compressibility": False}
    yield "the same, without Prandtl and Glauert's factor", Change(options=bell | incompressible)
    soft = _rotor(control_stiffness="7400 ft*lbf/rad").settings
    yield "K_θ 7,400, without Prandtl and Glauert's factor", Change(soft, incompressible)
    yield "without damping of sections", Change(options={"section_damping": False})
    yield "section moment c_m -.02 (0)", Change({"rotor.airfoil.moment": "-0.02"})
    yield "blade chord 14 in (14.6 in)", _rotor(chord="14 in")
    yield "rotor speed constant", Change(options={"rotor_speed": "constant"})
    yield "no sweep", Change({"support.sweep": "0 deg"})
    for slope in ("chord_slope", "bending_slope"):
        yield f"{slope.replace('_', ' ')} held at BL 28", _box(**{slope: "held"})
    for axis, value in _RECALLED.items():
        yield f"{axis} inertia {value:,} slug ft² ({_PUBLISHED[axis]:,})", _inertias(**{axis: value})
    yield "all three of the simulation models", _inertias(**_RECALLED)
    yield (
        "the same, chord slope held",
        Change({**_inertias(**_RECALLED).settings, **_box(chord_slope="held").settings}),
    )
    for axis, value in _PUBLISHED.items():
        for share in (0.8, 1.2):
            yield f"{axis} inertia {100 * (share - 1):+.0f} %", _inertias(**{axis: share * value})
    for pounds in (10400, 15600):
        yield f"weight {pounds:,} lb (13,000)", _fuselage(mass=f"{pounds} lb")
    for inches in (0, -48):
        yield f"centre of mass {-inches} in below the wing (24)", _fuselage(centre_up=f"{inches} in")
    yield "centre of mass 5 in ahead of the axis (23.8)", _fuselage(centre_forward="5 in")
    yield "without airloads of the wing", Change({"support.wing_aerodynamics.lift_slope": "1e-9/rad"})
    tails = {f"support.{tail}_tail.area": _NO_AREA for tail in ("horizontal", "vertical")}
    yield "without tails", Change(tails)


def effect(change: Change) -> Effect:
    """Return the boundaries with one input changed."""
    try:
        on = _boundaries(_ON, change, RPM_OF_SLOPES)
    except pp.InputError as error:
        return Effect(str(error))
    soft, off = (_boundaries(name, change, (458.0,)) for name in (_SOFT, _OFF))
    return Effect(
        "",
        tuple(line[_AT] for line in on),
        tuple(slope_of(RPM_OF_SLOPES, [one.airspeed for one in line]) for line in on),
        _differences(soft, on),
        _differences(off, on),
    )


def _boundaries(name: str, change: Change, rpm: tuple[float, ...]) -> list[list[Crossing]]:
    """Return the first boundary of each symmetry of a configuration at some rotor speeds."""
    configuration = CONFIGURATIONS[name]
    found = boundaries(configuration.case(change.settings), rpm, **change.options)
    return [first_crossings(found, one, configuration.band(one)) for one in SYMMETRIES.values()]


def _differences(changed: list[list[Crossing]], on: list[list[Crossing]]) -> tuple[float, ...]:
    return tuple(one[0].airspeed - other[_AT].airspeed for one, other in zip(changed, on, strict=True))


def slope_of(rpm: Any, airspeeds: Any) -> float:
    """Return the slope of the line through points of a boundary, least squares; NaN with fewer than two points."""
    rpm, airspeeds = np.asarray(rpm, dtype=float), np.asarray(airspeeds, dtype=float)
    there = np.isfinite(airspeeds)
    return float(np.polyfit(rpm[there], airspeeds[there], 1)[0]) if there.sum() > 1 else np.nan


def written(value: float, layout: str) -> str:
    """Return a number as text; "none" for NaN."""
    return "none" if np.isnan(value) else format(value, layout)


def table() -> PageTable:
    """Return the boundaries with each input changed, and those of two other analyses."""
    found = {name: effect(change) for name, change in changes()}
    first = next(iter(found.values()))
    rows = [
        (name, *(_cells(own, first) if not own.reason else ("refused", *[""] * (len(_HEADINGS) - 2))))
        for name, own in found.items()
    ]
    return PageTable("python -m benchmarks.bell_effects --page", _HEADINGS, _OTHERS + rows)


def _cells(found: Effect, first: Effect) -> Iterable[str]:
    for one, before in zip(found.at_458, first.at_458, strict=True):
        yield f"{written(one.airspeed, '.0f')} ({written(one.airspeed - before.airspeed, '+.0f')})"
    antisymmetric = found.at_458[1]
    yield antisymmetric.mode.removeprefix("antisymmetric ")
    for layout, pair in (("+.2f", found.slope), ("+.0f", found.softer), ("+.0f", found.off)):
        yield from (written(value, layout) for value in pair)


def main() -> None:
    """Print the table, and write it into its page."""
    page, found = page_is_wanted(__doc__), table()
    rpm = ", ".join(f"{one:g}" for one in RPM_OF_SLOPES)
    Console(width=170, highlight=False).print(found.printed(f"one input at a time; slopes over {rpm} rpm"))
    if page:
        found.write("xv15-aircraft.md")


if __name__ == "__main__":
    main()
