"""Coefficients of a blade section against angle of attack and Mach number: the linear airfoil, and any other model."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar, NamedTuple, Protocol, TypeGuard, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import check_finite
from proprotor.typing import Array


class SectionCoefficients(NamedTuple):
    """Lift, drag and moment coefficients and their derivatives with angle of attack (1/rad) and Mach number."""

    lift_coefficient: ArrayLike = 0.0
    lift_coefficient_alpha: ArrayLike = 0.0
    lift_coefficient_mach: ArrayLike = 0.0
    drag_coefficient: ArrayLike = 0.0
    drag_coefficient_alpha: ArrayLike = 0.0
    drag_coefficient_mach: ArrayLike = 0.0
    moment_coefficient: ArrayLike = 0.0
    moment_coefficient_alpha: ArrayLike = 0.0
    moment_coefficient_mach: ArrayLike = 0.0


class SectionModel(Protocol):
    """Anything that can stand for an airfoil."""

    @property
    def contains_compressibility(self) -> bool:
        """Whether the coefficients depend on Mach number already, and take no Prandtl-Glauert factor."""
        ...

    def coefficients(self, alpha: Array, mach: Array) -> SectionCoefficients:
        """Return coefficients and derivatives at angles of attack (rad) and Mach numbers of the same shape."""
        ...


@runtime_checkable
class _HasPoints(Protocol):
    """A section model whose numbers may differ from point to point of a batch, and from station to station."""

    @property
    def is_complex(self) -> bool:
        """Whether any number is complex, for derivatives by a complex step."""
        ...

    @property
    def real(self) -> SectionModel:
        """The same model without imaginary parts."""
        ...

    def take(self, rows: Array | slice, stations: slice) -> SectionModel:
        """Return the model at some of the points, and at some of the stations."""
        ...


_WITH_POINTS: dict[type, bool] = {}


def has_points(airfoil: SectionModel) -> TypeGuard[_HasPoints]:
    """Return whether a section model has points, asked once for each class: the question makes its real part."""
    kind = type(airfoil)
    if kind not in _WITH_POINTS:
        _WITH_POINTS[kind] = isinstance(airfoil, _HasPoints)
    return _WITH_POINTS[kind]


@runtime_checkable
class Warns(Protocol):
    """A section model that says where its coefficients are doubtful."""

    def warnings(self, alpha: Array, mach: Array) -> dict[str, Array]:
        """Return masks by reason for doubt, of the shape to which `alpha` and `mach` broadcast."""
        ...


# Limits of a straight lift line and of the Prandtl-Glauert factor (assumed, typical of thin sections).
LINEAR_ALPHA = np.radians(12.0)
LINEAR_MACH = 0.85
_BEYOND_ALPHA = f"angle of attack beyond {np.degrees(LINEAR_ALPHA):.0f} deg"
_BEYOND_MACH = f"Mach number beyond {LINEAR_MACH:g}"


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
            sign = "not negative" if entry.name in ("lift_slope", "drag") else ""
            check_finite(entry.name, getattr(self, entry.name), sign)

    def coefficients(self, alpha: Array, mach: Array) -> SectionCoefficients:
        """Return linear lift, constant drag and constant moment.

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
            drag_coefficient=self.drag,
            moment_coefficient=self.moment,
        )

    def flattened(self, shape: tuple[int, ...]) -> Airfoil:
        """Return the airfoil with arrays of designs broadcast to `shape`, flattened, and with a last axis for stations.

        Parameters
        ----------
        shape : tuple of int
            Shape of the batch.

        Returns
        -------
        Airfoil
        """
        return self._with_arrays(lambda array: np.broadcast_to(array, shape).reshape(-1, 1))

    def take(self, rows: Array | slice, stations: slice = slice(None)) -> Airfoil:
        """Return a flattened airfoil at some of the points.

        Parameters
        ----------
        rows : slice, or array of int or bool
            Places in the batch; an array with one row holds for all points and stays.
        stations : slice
            Stations of the blade to keep, where the airfoil changes along the blade.

        Returns
        -------
        Airfoil
        """

        def some(array: Array) -> Array:
            of_points = array if len(array) == 1 else array[rows]
            return of_points if of_points.shape[-1] == 1 else of_points[:, stations]

        return self._with_arrays(some)

    @property
    def is_complex(self) -> bool:
        """Whether any number is complex, for derivatives by a complex step."""
        return any(map(np.iscomplexobj, vars(self).values()))

    @property
    def real(self) -> Airfoil:
        """The airfoil without imaginary parts."""
        return replace(self, **{name: np.real(value) for name, value in vars(self).items()})

    def _with_arrays(self, change: Callable[[Array], Any]) -> Airfoil:
        """Return the airfoil with a change to each value that is an array."""
        arrays = {name: np.asarray(value) for name, value in vars(self).items() if np.ndim(value)}
        return replace(self, **{name: change(array) for name, array in arrays.items()}) if arrays else self

    def warnings(self, alpha: Array, mach: Array) -> dict[str, Array]:
        """Return where linear lift or the Prandtl-Glauert factor is doubtful.

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
            _BEYOND_ALPHA: np.abs(alpha) > LINEAR_ALPHA,
            _BEYOND_MACH: np.real(mach) > LINEAR_MACH,
        }
