"""The dataset of an envelope: all conditions together, the limits between its altitudes, and its worst case."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from proprotor.stability.envelope_speeds import EnvelopeSpeeds, envelope_speeds
from proprotor.typing import Array, Dataset

if TYPE_CHECKING:
    from proprotor.deck.conditions import Condition

MET, NOT_MET, NOT_KNOWN = "met", "not met", "not known"
_HEIGHTS = 61  # at which the limits are given, between the altitudes too


def envelope_dataset(
    parts: list[dict[str, Array]],
    conditions: Sequence[Condition[Any]],
    speeds: EnvelopeSpeeds,
    turning: Array | None,
    powers: Array | None,
) -> Dataset:
    """Return the dataset of all conditions.

    Parameters
    ----------
    parts : list of dict of array
        Of each condition, the variables of an envelope over rotor speed, power and altitude.
    conditions : sequence of Condition
    speeds : EnvelopeSpeeds
    turning, powers : array, optional
        Rotor speeds, rad/s, and powers, W, of the envelope.
    """
    import xarray  # here, because it takes long to import

    dims = ("condition", "rotor_speed", "power", "altitude")
    own = np.array([[float(one.case.operation.rotor_speed)] for one in conditions])
    turns = own if turning is None else np.tile(turning, (len(conditions), 1))
    variables = {
        name: (
            (*dims, *(("end",) if name == "searched" else ())),
            np.stack([part[name] for part in parts]),
            about,
        )
        for name, about in _ABOUT.items()
    }
    required = np.stack([speeds.failure if one.failure else speeds.normal for one in conditions])
    of_air = {"dive": speeds.dive, "density": speeds.density, "speed_of_sound": speeds.speed_of_sound}
    return xarray.Dataset(
        variables
        | {
            "required": (("condition", "altitude"), required, _ABOUT_SPEEDS["required"]),
            "failure": ("condition", np.array([one.failure for one in conditions])),
            "turning": (dims[:2], turns, {"units": "rad/s", "long_name": "rotor speed"}),
        }
        | {name: ("altitude", values, _ABOUT_SPEEDS[name]) for name, values in of_air.items()},
        coords={
            "condition": np.array([one.name for one in conditions], dtype=str),
            "rotor_speed": ("rotor_speed", _or_nan(turning), {"units": "rad/s"}),
            "power": ("power", _or_nan(powers), {"units": "W", "long_name": "into each rotor"}),
            "altitude": ("altitude", speeds.altitude, {"units": "m", "long_name": "pressure altitude"}),
            "end": ["low", "high"],
        },
    )


def with_limits(found: Dataset, section: Any, temperature_offset: float) -> Dataset:
    """Return the dataset with the equivalent airspeeds of V_D and of the speeds required between its altitudes too."""
    altitude = found.altitude.values
    height = np.unique(np.append(np.linspace(altitude[0], altitude[-1], _HEIGHTS), altitude))
    speeds = envelope_speeds(section, height, temperature_offset)
    limits = np.stack([speeds.dive, speeds.normal, speeds.failure]) / speeds.per_equivalent
    about = {"units": "m/s", "long_name": "equivalent airspeed"}
    return found.assign(limits=(("limit", "height"), limits, about)).assign_coords(
        limit=["dive", "normal", "failure"],
        height=("height", height, {"units": "m", "long_name": "pressure altitude"}),
    )


def _or_nan(values: Array | None) -> Array:
    return np.array([np.nan]) if values is None else values


def with_worst(found: Dataset) -> Dataset:
    """Return the dataset with its worst case: "not met" first, then "not known", and the least margin of these."""
    rank = np.select([found.verdict.values == NOT_MET, found.verdict.values == NOT_KNOWN], [0, 1], 2)
    margin = np.nan_to_num(found.margin.values, nan=np.inf)
    margin = np.where(
        (rank == 0) & np.isinf(margin), -np.inf, margin
    )  # unstable from the start, or damped too little
    damping = np.nan_to_num(found.damping.values, nan=-np.inf)
    worst = int(np.lexsort((damping.ravel(), margin.ravel(), rank.ravel()))[0])
    place = [int(one) for one in np.unravel_index(worst, rank.shape)]
    here = found.isel(dict(zip(found.verdict.dims, place, strict=True)))
    return found.assign_attrs(worst=_in_words(here), worst_place=place)


def _in_words(here: Dataset) -> str:
    """Return one place of an envelope in words: condition, altitude, rotor speed and power."""
    rpm = float(here.turning) * 30 / np.pi
    power = float(here.power)
    parts = [str(here.condition.item()), f"{float(here.altitude):.4g} m", f"{rpm:.4g} rpm"]
    return ", ".join([*parts, *([f"{power / 1e3:.4g} kW"] if np.isfinite(power) else [])])


_ABOUT: dict[str, dict[str, str]] = {
    "onset": {"units": "m/s", "long_name": "lowest true airspeed at which a mode becomes unstable"},
    "equivalent_onset": {"units": "m/s", "long_name": "equivalent airspeed of the onset"},
    "mach_onset": {"units": "1", "long_name": "flight Mach number of the onset"},
    "mode": {"long_name": "what moves in the mode at the onset"},
    "kind": {"long_name": "flutter, divergence or rigid body"},
    "frequency": {"units": "rad/s", "long_name": "of the mode at the onset"},
    "margin": {"units": "1", "long_name": "onset over the speed required, less 1"},
    "damping_onset": {
        "units": "m/s",
        "long_name": "true airspeed at which damping falls below the one required",
    },
    "damping": {"units": "1", "long_name": "least damping ratio at the speed required"},
    "damping_rate": {"units": "s/m", "long_name": "change of this damping with the equivalent airspeed"},
    "damping_mode": {"long_name": "what moves in the mode with the least damping"},
    "verdict": {"long_name": "whether the requirement is met"},
    "why": {"long_name": "why it is not met, or not known"},
    "warning": {"long_name": "what makes the onset or the damping doubtful"},
    "note": {"long_name": "on the lowest onset"},
    "reason": {"long_name": "why airspeeds failed"},
    "searched": {"units": "m/s", "long_name": "lowest and highest true airspeed that could be analysed"},
}
_ABOUT_SPEEDS: dict[str, dict[str, str]] = {
    "required": {
        "units": "m/s",
        "long_name": "true airspeed up to which the condition must be free of flutter",
    },
    "dive": {"units": "m/s", "long_name": "V_D or M_D, the lower one, as a true airspeed"},
    "density": {"units": "kg/m**3", "long_name": "of the air"},
    "speed_of_sound": {"units": "m/s", "long_name": "in the air"},
}
