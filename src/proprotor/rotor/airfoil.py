"""What a blade section makes of its angle of attack and Mach number."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar, NamedTuple, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError, check_number
from proprotor.typing import Array


class SectionCoefficients(NamedTuple):
    """Lift, drag and moment coefficients and their derivatives with angle of attack (rad) and Mach number."""

    lift_coefficient: ArrayLike
    lift_coefficient_alpha: ArrayLike
    lift_coefficient_mach: ArrayLike
    drag_coefficient: ArrayLike
    drag_coefficient_alpha: ArrayLike
    drag_coefficient_mach: ArrayLike
    moment_coefficient: ArrayLike
    moment_coefficient_alpha: ArrayLike
    moment_coefficient_mach: ArrayLike


class SectionModel(Protocol):
    """Anything that can stand for an airfoil.

    `contains_compressibility` says that the coefficients depend on Mach number already, so that no Prandtl-
    Glauert factor is
    put on them.
    """

    @property
    def contains_compressibility(self) -> bool: ...

    def coefficients(self, alpha: Array, mach: Array) -> SectionCoefficients:
        """Coefficients and derivatives at angles of attack (rad) and Mach numbers of the same shape."""
        ...


@runtime_checkable
class Warns(Protocol):
    """A section model that knows where its coefficients are not to be trusted."""

    def warnings(self, alpha: Array, mach: Array) -> dict[str, Array]:
        """Reasons for mistrust and where each holds, masks of the shape of `alpha` and `mach` broadcast."""
        ...


# Beyond these a straight lift line and the Prandtl-Glauert factor are not to be trusted (assumed, typical of
# thin sections).
LINEAR_ALPHA = np.radians(12.0)
LINEAR_MACH = 0.85


@dataclass(frozen=True, kw_only=True)
class Airfoil:
    """Constant lift slope and zero-lift line, constant drag and moment; any Mach number.

    Parameters
    ----------
    lift_slope : float
        c_lα, 1/rad, not negative. Any of the four may be an array that broadcasts with the airspeeds.
    zero_lift_angle : float
        Angle of attack without lift, rad.
    drag : float
        c_d, dimensionless, not negative.
    moment : float
        c_m about the reference line, nose up, dimensionless.

    Raises
    ------
    InputError
        When a value is not finite, or lift slope or drag is negative.
    """

    lift_slope: float
    zero_lift_angle: float = 0.0
    drag: float = 0.0
    moment: float = 0.0

    contains_compressibility: ClassVar[bool] = False

    def __post_init__(self) -> None:
        for entry in fields(self):
            value = getattr(self, entry.name)
            check_number(entry.name, value)
            if not np.all(np.isfinite(value)):
                raise InputError(entry.name, value, "must be finite")
        for name in ("lift_slope", "drag"):
            if np.any(np.real(getattr(self, name)) < 0):
                raise InputError(name, getattr(self, name), "must not be negative")

    def coefficients(self, alpha: Array, mach: Array) -> SectionCoefficients:
        """Linear lift, constant drag and moment.

        Parameters
        ----------
        alpha : array (...)
            Angle of attack, rad.
        mach : array (...)
            Mach number of the section, dimensionless.

        Returns
        -------
        SectionCoefficients
            Coefficients, dimensionless, and their derivatives with angle (1/rad) and Mach number; shapes as `alpha`.
        """
        return SectionCoefficients(
            lift_coefficient=self.lift_slope * (alpha - self.zero_lift_angle),
            lift_coefficient_alpha=self.lift_slope,
            lift_coefficient_mach=0.0,
            drag_coefficient=self.drag,
            drag_coefficient_alpha=0.0,
            drag_coefficient_mach=0.0,
            moment_coefficient=self.moment,
            moment_coefficient_alpha=0.0,
            moment_coefficient_mach=0.0,
        )

    def flattened(self, shape: tuple[int, ...]) -> Airfoil:
        """Arrays of designs broadcast to `shape` and flattened, with a last axis for the stations.

        Parameters
        ----------
        shape : tuple of int
            Of the batch.

        Returns
        -------
        Airfoil
        """
        arrays = {entry.name: np.asarray(getattr(self, entry.name)) for entry in fields(self)}
        many: dict[str, Any] = {
            name: np.broadcast_to(value, shape).reshape(-1, 1) for name, value in arrays.items() if value.ndim
        }
        return replace(self, **many)

    def take(self, rows: Array | slice) -> Airfoil:
        """A flattened airfoil at some of the points.

        Parameters
        ----------
        rows : slice, or array of int or bool
            Places in the batch.

        Returns
        -------
        Airfoil
        """
        values = {entry.name: getattr(self, entry.name) for entry in fields(self)}
        many = {name: value[rows] for name, value in values.items() if np.ndim(value)}
        return replace(self, **many) if many else self

    def warnings(self, alpha: Array, mach: Array) -> dict[str, Array]:
        """Where linear lift or the Prandtl-Glauert factor is not to be trusted.

        Parameters
        ----------
        alpha : array (...)
            Angle of attack, rad.
        mach : array (...)
            Mach number of the section, dimensionless.

        Returns
        -------
        dict of str to array of bool
            Masks of the broadcast shape, by reason.
        """
        return {
            f"angle of attack beyond {np.degrees(LINEAR_ALPHA):.0f} deg": np.abs(alpha) > LINEAR_ALPHA,
            f"Mach number beyond {LINEAR_MACH:g}": np.real(mach) > LINEAR_MACH,
        }
