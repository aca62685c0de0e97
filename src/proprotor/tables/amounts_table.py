"""What the inputs of a case amount to, as tables of text for the command line and the report."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, NamedTuple

from proprotor.model.amounts import BladeAtTrim, SupportMode, amounts, blade_at_trims, support_modes
from proprotor.model.configuration import Configuration
from proprotor.model.doubts import MARK, marked
from proprotor.tables.digits import significant
from proprotor.units import KNOT

_BLADE = (
    "airspeed, KTAS",
    "collective, deg",
    "coning, deg",
    "lag, deg",
    "ν_β, /rev",
    "ν_ζ, /rev",
    "K_Pβ",
    "K_Pζ",
)
_CYCLIC = ("K_Pβ, cyclic", "K_Pζ, cyclic")


class AmountsTable(NamedTuple):
    """A table of text: a caption, names of columns, rows, and which of the columns are words."""

    caption: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    text: tuple[str, ...]


def amounts_tables(case: Configuration) -> tuple[tuple[AmountsTable, ...], tuple[str, ...]]:
    """Return the tables, and a sentence with the rule for each doubtful number.

    Parameters
    ----------
    case : Configuration
        A single design.

    Returns
    -------
    tables : tuple of AmountsTable
    doubts : tuple of str

    Raises
    ------
    InputError
        For a case with arrays of designs.
    """
    numbers, trims, modes = amounts(case), blade_at_trims(case), support_modes(case)
    omega = float(case.operation.rotor_speed)
    columns = ("what", "value", "unit", "from")
    rows = tuple(
        (one.name, marked(f"{one.value:.5g}", one.doubt), one.unit or "–", one.formula or "as given")
        for one in numbers
    )
    tables = [AmountsTable("Blade, rotor and air, in SI units", columns, rows, ("what", "unit", "from"))]
    if trims:
        caption = "The blade at trim: uncoupled frequencies at zero cone, and couplings"
        apart = case.rotor.cyclic_control_stiffness is not None
        blades = tuple(_trim_row(one, cyclic=apart) for one in trims)
        tables.append(AmountsTable(caption, _BLADE + _CYCLIC * apart, blades, ()))
    if modes:
        head = ("mode", "alone, Hz", "/rev", "with the rotor, Hz", "with it, /rev")
        caption = (
            "Modes of the support without damping and air, alone and with the rotor hanging on its gimbal"
        )
        tables.append(AmountsTable(caption, head, tuple(_mode_row(mode, omega) for mode in modes), ("mode",)))
    found: Iterable[Any] = (*numbers, *trims, *modes)
    doubts = dict.fromkeys(part for one in found for part in one.doubt.split("; ") if part)
    return tuple(tables), tuple(f"{MARK} {doubt}." for doubt in doubts)


def _trim_row(blade: BladeAtTrim, *, cyclic: bool) -> tuple[str, ...]:
    degrees = (f"{math.degrees(angle):.3f}" for angle in (blade.collective, blade.coning, blade.lag))
    frequencies = (f"{ratio:.3f}" for ratio in (blade.flap_frequency, blade.lag_frequency))
    pairs = [blade.pitch_flap_coupling, blade.pitch_lag_coupling]
    if cyclic:
        pairs += [blade.cyclic_pitch_flap_coupling, blade.cyclic_pitch_lag_coupling]
    couplings = ("–" if math.isnan(k) else f"{k:.4f}" for k in pairs)
    return (marked(significant(blade.airspeed / KNOT, 4), blade.doubt), *degrees, *frequencies, *couplings)


def _mode_row(mode: SupportMode, omega: float) -> tuple[str, ...]:
    pairs = (
        (significant(f, 4), significant(2 * math.pi * f / omega, 4)) for f in (mode.alone, mode.with_rotor)
    )
    return (marked(mode.name, mode.doubt), *(text for pair in pairs for text in pair))
