"""The search of a box for its lowest flutter speed: designs in batches, then descents along exact derivatives.

The lowest flutter speed of a design is the least of those of its modes. Where one mode takes over from another the
speed has an edge, but none that traps a descent: beyond the edge it falls faster. A descent leaves out modes that are
nowhere the first near its way, so one begins at the lowest design of each mode.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np

from proprotor.case import Case
from proprotor.errors import InputError
from proprotor.model.linear_model import LinearModel
from proprotor.stability.eigenvalue_derivatives import eigenvalue_change, with_changes
from proprotor.stability.modes import decomposition
from proprotor.study import sampling
from proprotor.study.box import Box
from proprotor.study.study import study
from proprotor.study.variables import ABOVE, BELOW
from proprotor.typing import Array, Dataset

SPEED, FREQUENCY, _MODE = "flutter_speed", "flutter_frequency", "flutter_mode"
_TOLERANCE = 1e-8  # m/s, on a flutter speed, so that a descent sees no steps
_NEAR = 1e-3  # of a root and of 1 rad/s: how near to the neutral root of a design
_MOST_DESIGNS = 30  # of a descent: along the edge of what can be analysed it would go on for long
_FLAT = 1e-4  # m/s over the width of the box: derivatives at which a descent ends
_LITTLE = 1e-9  # of a speed: what a step gains, at which a descent ends


class BoxSearch:
    """The designs of a box that were tried, and what was found of each.

    Attributes
    ----------
    places : array (designs, inputs)
        In the box, 0 to 1.
    found : xarray.Dataset
        The study of the designs.
    """

    def __init__(self, case: Case, box: Box, airspeeds: Any, options: Mapping[str, Any]) -> None:
        self.case, self.box, self._airspeeds, self._options = case, box, airspeeds, options
        self.places = np.empty((0, len(box.known)))
        self._studies: list[Dataset] = []

    @property
    def found(self) -> Dataset:
        import xarray  # here, because it takes long to import

        return xarray.concat(self._studies, "design", combine_attrs="override")

    def try_at(self, places: Array, workers: int | None = 1) -> Dataset:
        """Analyse designs at places (designs, inputs), and return their study."""
        plan = sampling.points(self.box.values(places))
        some = study(
            self.case,
            plan,
            self._airspeeds,
            "flutter",
            workers=workers,
            progress=False,
            tolerance=_TOLERANCE,
            **self._options,
        )
        self.places = np.concatenate([self.places, places])
        self._studies.append(
            some.drop_vars(["reason", "warning"]).assign(reason=some.reason.isel(airspeed=0))
        )
        return some

    @property
    def speeds(self) -> Array:
        """Flutter speeds (designs,), m/s: -inf below the airspeeds, inf above them, NaN where nothing is known."""
        found = self.found
        speeds = np.where(np.isfinite(found[ABOVE]), np.inf, found[SPEED])
        return np.where(np.isfinite(found[BELOW]), -np.inf, speeds)

    @property
    def worst(self) -> int:
        """The design with the lowest flutter speed; without any, the one with the least damping."""
        speeds = self.speeds
        if np.isfinite(speeds).any() or np.isneginf(speeds).any():
            return int(np.nanargmin(speeds))
        damping = np.where(np.isnan(speeds), np.nan, self.found.flutter_least_damping)
        return int(np.nanargmin(damping))

    def lowest_of_each_mode(self) -> dict[str, int]:
        """Return the lowest design of each mode that is the first instability of a design, the lowest of all first."""
        speeds, modes = self.speeds, self.found[_MODE].values
        found: dict[str, int] = {}
        for place in np.argsort(speeds):
            if np.isfinite(speeds[place]):
                found.setdefault(str(modes[place]), int(place))
        return found

    def go_down(self, start: int) -> None:
        """Descend from a design that was tried to a design whose flutter speed is the lowest near it."""
        from scipy.optimize import minimize  # here, because it takes long to import

        highest = float(self.found.airspeed.values[-1])

        def speed_and_derivatives(place: Array) -> tuple[float, Array]:
            one = self.try_at(place[None, :])
            speed = float(one[SPEED][0])
            if np.isfinite(one[BELOW][0]) or not np.isfinite(
                speed
            ):  # nothing lower is to be found, or nothing at all
                low = one[BELOW][0] if np.isfinite(one[BELOW][0]) else highest
                return float(low), np.zeros(len(place))
            return speed, self.derivatives(place, speed, float(one[FREQUENCY][0])) * self.box.width

        settings = {"maxfun": _MOST_DESIGNS, "gtol": _FLAT, "ftol": _LITTLE}
        limits = [(0.0, 1.0)] * len(self.box.known)
        minimize(
            speed_and_derivatives,
            self.places[start],
            jac=True,
            method="L-BFGS-B",
            bounds=limits,
            options=settings,
        )

    def derivatives(self, place: Array, speed: float, frequency: float) -> Array:
        """Return dV/dp (inputs,) of the flutter speed of a design, m/s per SI unit; NaN where it has none.

        A boundary Re λ(V, p) = 0 moves by dV/dp = -Re λ_p / Re λ_V.
        """
        values = {path: float(value[0]) for path, value in self.box.values(place[None, :]).items()}
        rates = []
        for path in ("", *values):
            at = np.array([speed if not path else values[path]])
            model, changes = with_changes(partial(self._model, values, speed, path), at)
            every = decomposition(model).all_modes
            rates.append(eigenvalue_change(model, changes, every).real[0])
        # Of roots at the same place, such as that of a free azimuth beside a divergence, the one that moves.
        roots, along = every.values[0], rates[0]
        near = np.abs(roots - 1j * frequency) < _NEAR * (1 + frequency)
        if not near.any():
            return np.full(len(values), np.nan)
        state = int(np.where(near, np.abs(along), -1.0).argmax())
        with np.errstate(all="ignore"):
            return np.array([-rate[state] / along[state] for rate in rates[1:]])

    def _model(self, values: Mapping[str, float], speed: float, path: str, x: Array) -> LinearModel:
        """Return models (k,) of a design with values x (k,) of one input, or of the airspeed without a path."""
        case = self.case.vary({**values, path: x} if path else values)
        return case.linearize(np.full(x.shape, speed) if path else x, **self._options)

    def check_known(self) -> None:
        """Refuse a box in which no design can be analysed."""
        if np.isnan(self.speeds).all():
            raise InputError("box", None, f"has no design that can be analysed: {self.first_failure}")

    @property
    def failed(self) -> Array:
        """Designs (designs,) of whose flutter speed nothing is known."""
        return np.isnan(self.speeds)

    @property
    def first_failure(self) -> str:
        """Why the first of the designs failed of which nothing is known; empty if none failed."""
        failed = np.flatnonzero(self.failed)
        return str(self.found.flutter_note.values[failed[0]]) if len(failed) else ""
