"""The lag frequency of the XV-15's rotor: what is published, what Table 1 gives, and what would give each value.

    python -m benchmarks.lag_frequency           # prints the tables and draws the figure
    python -m benchmarks.lag_frequency --page    # and writes the tables into docs/lag-frequency.md

Frequencies are per revolution at 458 rpm unless a line says otherwise. AIAA-2002-1604 ("the paper"): 1.8 at low speed
to 1.2 at high speed. Bell, calculated (NASA TM X-62,407): 1.454 to 1.052, and 1.736 measured at one pitch. The springs
of the paper's Table 1 turn with the structural pitch, the pitch of the blade plus δs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from rich.console import Console
from scipy.optimize import brentq, least_squares, minimize_scalar

import proprotor as pp
from benchmarks import pictures
from benchmarks.page_table import PageTable, page_is_wanted
from benchmarks.paper_figures.blade_state import blade_state, couplings, effective_springs, on_rigid_hub
from benchmarks.paper_figures.published import PAPER_FREQUENCIES
from proprotor.plots.style import GREY, LABEL_SIZE
from proprotor.typing import Array, Figure
from proprotor.units import KNOT

DECKS = ("xv15-uncoupled", "xv15-wing")
CASE = pp.load_case(DECKS[0])
BELL = pp.load_case("xv15-bell-frequencies").frequencies
ROTOR, OMEGA = CASE.rotor, CASE.operation.rotor_speed
RPM = np.pi / 30
SLUG_FT2, FT_LBF = 1.3558179483314004, 1.3558179483314004  # kg m², N m
SPEEDS = np.array([50.0, 400.0])  # kt, the ends of the paper's Fig. 14 that the text calls low and high
KNOTS = np.arange(50.0, 401.0, 50.0)
SCAN = "50:480:10kt"
MEASURED = 1.736


class Target(NamedTuple):
    """Published lag frequencies at two pitches of the blade (rad)."""

    name: str
    frequency: tuple[float, float]
    pitch: Array


@cache
def pitch_at(knots: float) -> float:
    """Return the pitch of the windmilling blade in rad."""
    return float(blade_state(CASE, knots * KNOT).structural_pitch[0]) - ROTOR.structural_pitch_offset


def targets() -> tuple[Target, Target]:
    """Return the paper's frequencies at its speeds, and Bell's at the collectives assumed in the deck."""
    paper = Target("paper", (1.8, 1.2), np.array([pitch_at(speed) for speed in SPEEDS]))
    lag = tuple(float(value) for value in np.asarray(BELL.lag))
    return paper, Target("Bell", (lag[0], lag[1]), np.asarray(BELL.at))


# Closed forms -------------------------------------------------------------------------------------


def uncoupled(rotor: pp.Rotor, pitch: Any, rotor_speed: float = OMEGA) -> tuple[Array, Array]:
    """Return ν_β and ν_ζ at pitches (rad): ν² = ν_c² + K/(I Ω²), ν_c² = 1 + e S/I in flap and e S/I in lag."""
    springs = effective_springs(rotor, pitch + rotor.structural_pitch_offset)
    flap_part = 1 + rotor.flap_hinge_offset * rotor.flap_first_moment / rotor.flap_inertia
    lag_part = rotor.lag_hinge_offset * rotor.lag_first_moment / rotor.lag_inertia
    flap = flap_part + springs.flap_flap_stiffness / (rotor.flap_inertia * rotor_speed**2)
    lag = lag_part + springs.lag_lag_stiffness / (rotor.lag_inertia * rotor_speed**2)
    with np.errstate(invalid="ignore"):
        return np.sqrt(flap), np.sqrt(lag)


def lag_frequency(rotor: pp.Rotor, pitch: Any, rotor_speed: float = OMEGA) -> Array:
    """Return ν_ζ at pitches of the blade (rad)."""
    return uncoupled(rotor, pitch, rotor_speed)[1]


def coupled_on_rigid_hub(rotor: pp.Rotor, pitch: Array) -> tuple[Array, Array]:
    """Return coning and cyclic lag of the whole rotor in a vacuum, in rotating axes, at pitches of the blade (rad)."""
    operation = replace(CASE.operation, density=0.0, trim={"collective": pitch})
    case = replace(CASE, rotor=rotor, operation=operation)
    found = on_rigid_hub(case, np.full(len(pitch), 100.0), airloads="none", pitch="rigid")
    return found["coning"], 1 + found["low cyclic lag"]


def blade_alone(rotor: pp.Rotor, structural_pitch: Array) -> Array:
    """Return the lower frequency of a blade that flaps and lags, its gimbal held and its hub still, at no cone."""
    springs = effective_springs(rotor, structural_pitch)
    stiffness = np.empty((*np.shape(structural_pitch), 2, 2))
    stiffness[..., 0, 0] = springs.flap_flap_stiffness
    stiffness[..., 0, 0] += OMEGA**2 * (
        rotor.flap_inertia + rotor.flap_hinge_offset * rotor.flap_first_moment
    )
    stiffness[..., 1, 1] = springs.lag_lag_stiffness
    stiffness[..., 1, 1] += OMEGA**2 * rotor.lag_hinge_offset * rotor.lag_first_moment
    stiffness[..., 0, 1] = stiffness[..., 1, 0] = springs.flap_lag_stiffness
    # flap and lag of one blade: two directions, so no mass couples them without a cone
    inertia = np.array([rotor.flap_inertia, rotor.lag_inertia])
    squared = np.linalg.eigvals(stiffness / inertia[:, None]).real.min(axis=-1)
    lower: Array = np.sqrt(squared) / OMEGA
    return lower


# Rotors that differ in one or two inputs ----------------------------------------------------------


def with_springs(rotor: pp.Rotor, flap: float | None = None, lag: float | None = None) -> pp.Rotor:
    """Return a rotor with springs K = I ω² of non-rotating frequencies in rad/s."""
    given = {"flap_stiffness": (rotor.flap_inertia, flap), "lag_stiffness": (rotor.lag_inertia, lag)}
    return replace(
        rotor, **{name: inertia * omega**2 for name, (inertia, omega) in given.items() if omega is not None}
    )


def scaled_springs(rotor: pp.Rotor, flap: float, lag: float) -> pp.Rotor:
    """Return a rotor with both springs multiplied."""
    return replace(rotor, flap_stiffness=flap * rotor.flap_stiffness, lag_stiffness=lag * rotor.lag_stiffness)


class Input(NamedTuple):
    """One input: how a rotor gets a value, the range in which it is sought, and how it is shown."""

    name: str
    rotor: Callable[[float], pp.Rotor]
    range: tuple[float, float]
    now: float
    unit: str
    scale: float = 1.0


def inputs() -> tuple[Input, ...]:
    """Return the inputs of Table 1 on which the lag frequency depends, and those that it leaves out."""
    flap, lag = (
        np.sqrt(getattr(ROTOR, f"{n}_stiffness") / getattr(ROTOR, f"{n}_inertia")) for n in ("flap", "lag")
    )
    deg = np.pi / 180
    return (
        Input("ω_ζ0", lambda x: with_springs(ROTOR, lag=x), (1.0, 400.0), lag, "rad/s"),
        Input("ω_β0", lambda x: with_springs(ROTOR, flap=x), (1.0, 400.0), flap, "rad/s"),
        Input(
            "δs", lambda x: replace(ROTOR, structural_pitch_offset=x), (0.0, np.pi / 2), 15 * deg, "deg", deg
        ),
        Input("R_ζ", lambda x: replace(ROTOR, lag_outboard_fraction=x), (0.0, 1.0), 1.0, ""),
        Input("R_β", lambda x: replace(ROTOR, flap_outboard_fraction=x), (0.0, 1.0), 1.0, ""),
        Input(
            "e_ζ",
            lambda x: replace(ROTOR, lag_hinge_offset=x),
            (ROTOR.flap_hinge_offset, 3.0),
            ROTOR.lag_hinge_offset,
            "ft",
            0.3048,
        ),
        Input("both springs ×", lambda x: scaled_springs(ROTOR, x, x), (0.01, 2.0), 1.0, ""),
    )


def value_for(one: Input, frequency: float, pitch: float) -> tuple[float, float]:
    """Return the value that gives a lag frequency at a pitch, NaN without one, and the nearest frequency there is."""

    def missed(x: float) -> float:
        try:
            return float(lag_frequency(one.rotor(x), pitch)) - frequency
        except pp.InputError:  # no blade has such integrals
            return np.nan

    at = np.linspace(*one.range, 161)
    error = np.array([missed(x) for x in at])
    crossing = np.flatnonzero(error[:-1] * error[1:] <= 0)
    nearest = frequency + error[np.nanargmin(np.abs(error))]
    if not len(crossing):
        return np.nan, nearest
    nearest_to_now = min(crossing, key=lambda place: abs(at[place] - one.now))
    return brentq(missed, at[nearest_to_now], at[nearest_to_now + 1]), frequency


def both_springs(target: Target) -> pp.Rotor:
    """Return the rotor whose two springs give both lag frequencies, δs as in the deck: K_ζζ is linear in both."""
    turn = target.pitch + ROTOR.structural_pitch_offset
    centrifugal = ROTOR.lag_hinge_offset * ROTOR.lag_first_moment
    wanted = OMEGA**2 * (np.square(target.frequency) * ROTOR.lag_inertia - centrifugal)
    lag, flap = np.linalg.solve(np.column_stack([np.cos(turn) ** 2, np.sin(turn) ** 2]), wanted)
    return replace(ROTOR, flap_stiffness=flap, lag_stiffness=lag)


class Fit(NamedTuple):
    """Turning springs that come near to Bell's four coupled frequencies, and the root mean square of the misses."""

    rotor: pp.Rotor
    pitch: Array
    root_mean_square: float


@cache
def fitted_to_bell(degrees: tuple[int, int] = (20, 50), fractions: bool = False) -> Fit:
    """Return the springs and δs nearest to Bell's frequencies at two pitches; R_β and R_ζ too where `fractions`."""
    pitch, published = np.radians(degrees), np.concatenate([np.asarray(BELL.flap), np.asarray(BELL.lag)])

    def rotor(x: Array) -> pp.Rotor:
        outboard = dict(zip(("flap_outboard_fraction", "lag_outboard_fraction"), x[3:], strict=False))
        return replace(with_springs(ROTOR, x[0], x[1]), structural_pitch_offset=x[2], **outboard)

    def missed(x: Array) -> Array:
        return np.nan_to_num(np.concatenate(coupled_on_rigid_hub(rotor(x), pitch)) - published, nan=1.0)

    free = 5 if fractions else 3
    found = least_squares(
        missed,
        [50.0, 100.0, 0.4, 0.9, 0.9][:free],
        x_scale=[50.0, 80.0, 0.3, 1.0, 1.0][:free],
        bounds=([10.0, 10.0, -0.3, 0.0, 0.0][:free], [200.0, 300.0, 1.5, 1.0, 1.0][:free]),
    )
    return Fit(rotor(found.x), pitch, float(np.sqrt(np.mean(found.fun**2))))


# Flutter ------------------------------------------------------------------------------------------

Changed = tuple[str, pp.Rotor | None, pp.BladeFrequencies | None]


def candidates() -> Iterator[Changed]:
    """Yield each explanation with the springs or the table that stand for it."""
    paper, bell = targets()
    by_hub_inertia = ROTOR.lag_inertia / ROTOR.blade_inertia
    yield "springs of Table 1, δs 15°", None, None
    yield "δs 0°", replace(ROTOR, structural_pitch_offset=0.0), None
    least = np.pi / 2 - pitch_at(400.0)
    yield (
        f"δs {np.degrees(least):.1f}°, the least uncoupled ν_ζ at 400 kt",
        replace(ROTOR, structural_pitch_offset=least),
        None,
    )
    yield "ω_ζ0 for 1.8 at 50 kt", inputs()[0].rotor(value_for(inputs()[0], 1.8, paper.pitch[0])[0]), None
    yield "both springs × .67 = I_ζ/I_b", scaled_springs(ROTOR, by_hub_inertia, by_hub_inertia), None
    yield "Table 1 per rev of 565 rpm", scaled_springs(ROTOR, *2 * [(458 / 565) ** 2]), None
    yield "both springs for the paper's lag", both_springs(paper), None
    yield "both springs for Bell's lag", both_springs(bell), None
    yield "springs and δs nearest to Bell's four", fitted_to_bell().rotor, None
    yield "paper's lag in a table, bent blades do not pitch", None, PAPER_FREQUENCIES
    yield "Bell's table, bent blades do not pitch", None, replace(BELL, pitch_coupling="none")
    yield "Bell's table, coupling of the springs", None, BELL


def onsets(case: pp.Case, **options: Any) -> tuple[str, str]:
    """Return the first onset of instability, and the first of a wing mode, each with its mode and airspeed in kt."""
    found = [boundary for boundary in case.flutter_point(SCAN, **options).boundaries if boundary.onset]
    of_wing = [boundary for boundary in found if boundary.mode in ("beam", "chord", "torsion")]
    first, wing = (next(iter(listed), None) for listed in (found, of_wing))
    return tuple(
        "none to 480" if one is None else f"{one.mode} {one.position / KNOT:.0f}" for one in (first, wing)
    )


def flutter(deck: str, changed: Changed, rotor_speed: float | None = None) -> tuple[str, str]:
    """Return the onsets of a deck with other springs, or a table of frequencies, at a rotor speed in rad/s."""
    case, (_, rotor, table) = pp.load_case(deck), changed
    case = case if rotor is None else replace(case, rotor=rotor)
    if rotor_speed is not None:
        case = replace(case, operation=replace(case.operation, rotor_speed=rotor_speed))
    return onsets(case, **({} if table is None else {"structure": "tabulated", "frequencies": table}))


# Tables -------------------------------------------------------------------------------------------


MARK = "python -m benchmarks.lag_frequency --page"


def _row(values: Array) -> list[str]:
    return ["" if np.isnan(value) else f"{value:.3f}" for value in values]


def cyclic_lag_in_air(**options: Any) -> Array:
    """Return the mode of Fig. 14 at `KNOTS`, near enough to each other for the mode to be followed."""
    return on_rigid_hub(CASE, KNOTS * KNOT, pitch="coupling", **options)["low cyclic lag"]


def over_airspeed() -> PageTable:
    """Return the lag frequencies of Table 1 at the trims of the windmilling rotor."""
    state = blade_state(CASE, KNOTS * KNOT)
    pitch = state.structural_pitch - ROTOR.structural_pitch_offset
    _, lag = uncoupled(ROTOR, pitch)
    _, cyclic = coupled_on_rigid_hub(ROTOR, pitch)
    air = cyclic_lag_in_air()
    headings = (
        *("kt", "pitch, deg", "Θ + δs, deg", "uncoupled ν_ζ", "blade, gimbal held"),
        *("cyclic lag of the rotor, vacuum", "1 + Fig. 14: the same with airloads"),
    )
    columns = np.column_stack([lag, blade_alone(ROTOR, state.structural_pitch), cyclic, 1 + air])
    rows = [
        (f"{speed:.0f}", f"{angle:.1f}", f"{turned:.1f}", *_row(row))
        for speed, angle, turned, row in zip(
            KNOTS, np.degrees(pitch), np.degrees(state.structural_pitch), columns, strict=True
        )
    ]
    return PageTable(f"{MARK}: Table 1", headings, rows)


def definitions() -> PageTable:
    """Return what may be called lag frequency at 50 and 400 kt, and at the structural pitches at the ends of all."""
    paper, _ = targets()
    pitch = np.concatenate([paper.pitch, np.array([0.0, np.pi / 2]) - ROTOR.structural_pitch_offset])
    flap, lag = uncoupled(ROTOR, pitch)
    of_flap, of_lag = (part**2 for part in uncoupled(scaled_springs(ROTOR, 1e-12, 1e-12), 0.0))
    air = cyclic_lag_in_air()[[0, -1]]
    nowhere = np.full(2, np.nan)
    rows = {
        "rotating, uncoupled: √(K_ζζ/(I_ζΩ²) + eS/I_ζ)": lag,
        "non-rotating over Ω: √(K_ζζ/(I_ζΩ²))": np.sqrt(lag**2 - of_lag),
        "1 + low cyclic lag mode of the rotor, vacuum": np.append(
            coupled_on_rigid_hub(ROTOR, paper.pitch)[1], nowhere
        ),
        "1 + low cyclic lag mode, airloads (Fig. 14)": np.append(1 + air, nowhere),
        "with I_b: √(K_ζζ/(I_bΩ²) + eS/I_ζ)": np.sqrt(
            of_lag + (lag**2 - of_lag) * ROTOR.lag_inertia / ROTOR.blade_inertia
        ),
        "rotating, uncoupled, per revolution of 565 rpm": lag_frequency(ROTOR, pitch, 565 * RPM),
        "coning, uncoupled": flap,
        "coning with I_b": np.sqrt(of_flap + (flap**2 - of_flap) * ROTOR.flap_inertia / ROTOR.blade_inertia),
        "coning, uncoupled, per revolution of 565 rpm": uncoupled(ROTOR, pitch, 565 * RPM)[0],
    }
    headings = ("definition, numbers of Table 1", "50 kt", "400 kt", "Θ + δs = 0°", "90°")
    return PageTable(
        f"{MARK}: definitions", headings, [(name, *_row(values)) for name, values in rows.items()]
    )


def single_inputs() -> PageTable:
    """Return the value that each input alone takes for each published frequency."""
    ends = [
        (f"{target.name}: {value} at {np.degrees(at):.0f}°", value, float(at))
        for target in targets()
        for value, at in zip(target.frequency, target.pitch, strict=True)
    ]
    rows = []
    for one in inputs():
        now = f"{one.now / one.scale:.4g} {one.unit}".rstrip()
        rows.append((one.name, now, *(_value_or_nearest(one, value, at) for _, value, at in ends)))
    return PageTable(f"{MARK}: single inputs", ("input", "now", *(name for name, _, _ in ends)), rows)


def _value_or_nearest(one: Input, frequency: float, pitch: float) -> str:
    value, nearest = value_for(one, frequency, pitch)
    return f"at best {nearest:.2f}" if np.isnan(value) else f"{value / one.scale:.3g}"


def others() -> PageTable:
    """Return what else follows from Table 1, and from Bell's frequencies."""
    turn = np.radians(np.linspace(0, 90, 181))
    lag = lag_frequency(ROTOR, turn - ROTOR.structural_pitch_offset)
    lower = minimize_scalar(
        lambda x: float(blade_alone(ROTOR, np.array(x))), bounds=(0, np.pi / 2), method="bounded"
    )
    given = cyclic_lag_in_air(structure="tabulated", frequencies=PAPER_FREQUENCIES)
    spring, _ = value_for(inputs()[0], MEASURED, float(np.asarray(BELL.at)[0]))
    flap, bell = np.asarray(BELL.flap), np.asarray(BELL.lag)
    total = ROTOR.flap_inertia * flap**2 + ROTOR.lag_inertia * bell**2
    rows = {
        "uncoupled ν_ζ, over all structural pitches": f"{lag.max():.3f} (0°) to {lag.min():.3f} (90°)",
        "lower frequency of a blade that flaps and lags, least": f"{lower.fun:.3f}",
        "share of the centrifugal force in ν_ζ²": f"{_centrifugal_share():.3f}",
        "Fig. 14 with uncoupled 1.8 to 1.2 given, at 100 and 400 kt": " and ".join(
            f"{value:.2f}" for value in given[[1, -1]]
        ),
        "I_ζ/I_b": f"{ROTOR.lag_inertia / ROTOR.blade_inertia:.3f}",
        "(458/565)²": f"{(458 / 565) ** 2:.3f}",
        f"ω_ζ0 for {MEASURED} at 20° of pitch": f"{spring:.1f} rad/s",
        f"structural pitch of {MEASURED} at 458 rpm": f"{_pitch_of(MEASURED, OMEGA):.1f}°",
        "the same per revolution of 565 rpm": f"{_pitch_of(MEASURED, 565 * RPM):.1f}°",
        "I_β ν_β² + I_ζ ν_ζ² of Bell's frequencies, at 50° over that at 20°": f"{total[1] / total[0]:.3f}",
    }
    return PageTable(f"{MARK}: others", ("what follows", "value"), list(rows.items()))


def _centrifugal_share() -> float:
    """Return the part of ν_ζ² that no spring makes."""
    return ROTOR.lag_hinge_offset * ROTOR.lag_first_moment / ROTOR.lag_inertia


def _pitch_of(frequency: float, rotor_speed: float) -> float:
    """Return the structural pitch in deg at which the springs of Table 1 give a lag frequency."""
    offset = ROTOR.structural_pitch_offset
    return float(
        np.degrees(
            brentq(lambda x: float(lag_frequency(ROTOR, x - offset, rotor_speed)) - frequency, 0, np.pi / 2)
        )
    )


def fits() -> PageTable:
    """Return the springs that give two frequencies exactly, and those nearest to Bell's four."""
    rows = []
    paper, bell = targets()
    for name, target in (("both for the paper's lag", paper), ("both for Bell's lag", bell)):
        rotor = both_springs(target)
        rows.append((name, *_springs_of(rotor), *_ends(uncoupled(rotor, target.pitch)), "0"))
    for name, fit in (
        ("nearest to Bell's four, 20 to 50°", fitted_to_bell()),
        ("the same with R_β and R_ζ free", fitted_to_bell(fractions=True)),
        ("nearest to Bell's four, 10 to 60°", fitted_to_bell((10, 60))),
    ):
        found = coupled_on_rigid_hub(fit.rotor, fit.pitch)
        rows.append((name, *_springs_of(fit.rotor), *_ends(found), f"{fit.root_mean_square:.3f}"))
    columns = ("ω_β0", "ω_ζ0", "δs, deg", "R_β", "R_ζ", "coning at both ends", "lag at both ends", "rms miss")
    return PageTable(f"{MARK}: fits", ("springs", *columns), rows)


def _springs_of(rotor: pp.Rotor) -> Iterator[str]:
    """Yield non-rotating frequencies in rad/s, δs in deg, and the outboard fractions of a rotor."""
    for name in ("flap", "lag"):
        yield f"{np.sqrt(getattr(rotor, f'{name}_stiffness') / getattr(rotor, f'{name}_inertia')):.1f}"
    yield f"{np.degrees(rotor.structural_pitch_offset):.1f}"
    yield f"{rotor.flap_outboard_fraction:.2f}"
    yield f"{rotor.lag_outboard_fraction:.2f}"


def _ends(found: tuple[Array, Array]) -> Iterator[str]:
    return (" to ".join(_row(values)) for values in found)


def first_and_wing(found: tuple[str, str]) -> str:
    """Return the first onset, and in brackets the first of a wing mode where that is another."""
    first, wing = found
    return first if first == wing else f"{first} ({wing})"


def candidate_boundaries() -> PageTable:
    """Return the first onset with each explanation."""
    rows = [
        (changed[0], *(first_and_wing(flutter(deck, changed)) for deck in DECKS)) for changed in candidates()
    ]
    return PageTable(f"{MARK}: boundary", ("springs", *(f"`{deck}`" for deck in DECKS)), rows)


def bell_band() -> PageTable:
    """Return the onsets with Bell's table, its inputs at the ends of what is known, on the first deck."""
    read = 15 / 458  # per rev
    lag, flap = np.asarray(BELL.lag), np.asarray(BELL.flap)
    tables = {
        "as in the deck": BELL,
        "lag - 15 cycles per minute": replace(BELL, lag=lag - read),
        "lag + 15 cycles per minute": replace(BELL, lag=lag + read),
        "coning - 15 cycles per minute": replace(BELL, flap=flap - read),
        "coning + 15 cycles per minute": replace(BELL, flap=flap + read),
        "pitch from 10 to 50°": replace(BELL, at=np.radians([10, 50])),
        "pitch from 20 to 60°": replace(BELL, at=np.radians([20, 60])),
        "pitch from 10 to 60°": replace(BELL, at=np.radians([10, 60])),
    }
    rows = [(name, *flutter(DECKS[0], (name, None, given))) for name, given in tables.items()]
    for stiffness in (11000, 14000, 22400):
        rotor = replace(ROTOR, control_stiffness=stiffness * FT_LBF)
        for given, springs in ((BELL, ""), (None, ", springs of Table 1")):
            told = f"K_θ {stiffness:,} ft lbf/rad{springs}"
            rows.append((told, *flutter(DECKS[0], ("", rotor, given))))
    return PageTable(f"{MARK}: Bell", ("Bell's table, `xv15-uncoupled`", "first onset", "wing"), rows)


def couplings_at_trim() -> PageTable:
    """Return K_Pβ and K_Pζ of both decks, by their own trims and the slopes of the springs of Table 1."""
    knots = np.array([100.0, 200.0, 250.0, 300.0, 350.0])
    rows = []
    for name in (DECKS[0], "xv15-bell-frequencies"):
        case = pp.load_case(name)
        trim = case.linearize(knots * KNOT, pitch="coupling").trim
        found = couplings(
            case.rotor,
            effective_springs(case.rotor, trim.pitch + case.rotor.structural_pitch_offset),
            trim.coning,
            trim.lag,
        )
        angles = {"coning, deg": np.degrees(trim.coning), "lag, deg": np.degrees(trim.lag)}
        own = angles | {"K_Pβ": found.pitch_flap_coupling, "K_Pζ": found.pitch_lag_coupling}
        rows += [(f"`{name}`", label, *(f"{value:.2f}" for value in values)) for label, values in own.items()]
    return PageTable(f"{MARK}: couplings", ("deck", "at", *(f"{speed:.0f} kt" for speed in knots)), rows)


def rotor_speeds() -> PageTable:
    """Return the onsets with a table per revolution of the rotor speed of the day, and with its springs."""
    rows = []
    for name, given in (
        ("Bell's, bent blades do not pitch", replace(BELL, pitch_coupling="none")),
        ("Bell's, coupling of the springs", BELL),
        ("paper's lag, bent blades do not pitch", PAPER_FREQUENCIES),
        ("paper's lag, coupling of the springs", replace(PAPER_FREQUENCIES, pitch_coupling="springs")),
    ):
        for rpm in (300, 380, 458, 517):
            before = replace(given, at_rotor_speed=rpm * RPM)
            found = (
                first_and_wing(flutter(deck, ("", None, one), rpm * RPM))
                for deck in DECKS
                for one in (before, given)
            )
            rows.append((name, str(rpm), *found))
    columns = [f"`{deck}`, {which}" for deck in DECKS for which in ("per rev", "springs")]
    return PageTable(f"{MARK}: rotor speeds", ("table", "rpm", *columns), rows)


TABLES = {
    over_airspeed: "Springs of Table 1, δs 15°, per rev",
    others: "What follows from Table 1",
    definitions: "Definitions",
    single_inputs: "One input alone, uncoupled frequency",
    fits: "Two inputs and more; frequencies of the last three coupled, in a vacuum",
    candidate_boundaries: "First onset in kt (pitch equations, damping of sections)",
    couplings_at_trim: "Couplings at trim",
    bell_band: "Bell's table with coupling of the springs: onsets in kt",
    rotor_speeds: "Tables at another rotor speed: first onset in kt",
}


def draw() -> Figure:
    """Draw lag frequencies against the pitch of the blade: published, and by the springs of Table 1."""
    pitch = np.linspace(0, 60, 61)
    turn = np.radians(pitch)
    knots = np.arange(50.0, 401.0, 10.0)
    in_air = 1 + on_rigid_hub(CASE, knots * KNOT, pitch="coupling")["low cyclic lag"]
    at = np.degrees(blade_state(CASE, knots * KNOT).structural_pitch - ROTOR.structural_pitch_offset)
    paper, bell = targets()
    figure, (axes,) = pictures.panels(1, 7.5, 5.5)
    cases = (
        ("springs of Table 1, δs 15°: uncoupled, 458 rpm", pitch, lag_frequency(ROTOR, turn)),
        ("the same per rev of 565 rpm", pitch, lag_frequency(ROTOR, turn, 565 * RPM)),
        ("the same springs: cyclic lag in a vacuum", pitch, coupled_on_rigid_hub(ROTOR, turn)[1]),
        ("with airloads, 50 to 400 kt", at, in_air),
    )
    for place, (label, x, y) in enumerate(cases):
        pictures.draw_case(axes, x, y, place, label)
    read: dict[str, Any] = {"color": GREY, "linewidth": 1.0, "markerfacecolor": "white", "markersize": 7}
    axes.plot(
        np.degrees(paper.pitch),
        paper.frequency,
        "o:",
        label="the paper's text (pitches of 50 and 400 kt)",
        **read,
    )
    told = "Bell, calculated (pitches assumed)"
    axes.errorbar(np.degrees(bell.pitch), bell.frequency, yerr=15 / 458, fmt="s:", label=told, **read)
    axes.axhline(MEASURED, color=GREY, linestyle="--", linewidth=1.0)
    above: dict[str, Any] = {"fontsize": LABEL_SIZE, "ha": "right", "va": "bottom"}
    axes.text(60, MEASURED + 0.005, f"measured: {MEASURED}, pitch not at hand", **above)
    axes.set(
        xlabel="Pitch of the blade at 0.75 R (deg)",
        ylabel="Lag frequency, rotating axes (per rev)",
        ylim=(1, 2.2),
    )
    axes.legend(loc="lower left")
    pictures.tell_case(axes, CASE, pitch="coupling")
    return figure


def main() -> None:
    """Print all tables, draw the figure, and write the tables into the page."""
    page, console = page_is_wanted(__doc__), Console(width=150, highlight=False)
    for make, title in TABLES.items():
        table = make()
        console.print(table.printed(title))
        if page:
            table.write("lag-frequency.md")
    pictures.write(draw, "lag-frequency.png")


if __name__ == "__main__":
    main()
