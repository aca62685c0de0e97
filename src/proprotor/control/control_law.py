"""A control law as a state space: ẋ = A x + B y, u = C x + D y, from sensors y to commands u."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError
from proprotor.typing import Array

_MATRICES = ("A", "B", "C", "D")
_KINDS = (
    "must be a transfer function (numerator, denominator), a state space (A, B, C, D), or an object that has num and "
    "den or A, B, C and D"
)
_IMPROPER = "must not have a higher degree than the denominator: such a law is no state space; add a filter"


@dataclass(frozen=True, eq=False)
class ControlLaw:
    """ẋ = A x + B y, u = C x + D y.

    Parameters
    ----------
    A : array (k, k)
        1/s.
    B : array (k, signals)
        States per second and per unit of each signal y of the sensors.
    C : array (commands, k)
        Commands u per unit of each state.
    D : array (commands, signals)
        Commands per unit of each signal.

    Raises
    ------
    InputError
        When sizes do not fit, or an entry is not finite.
    """

    A: Array
    B: Array
    C: Array
    D: Array

    def __post_init__(self) -> None:
        for name in _MATRICES:
            object.__setattr__(self, name, _matrix(name, getattr(self, name)))
        states, (commands, signals) = len(self.A), self.D.shape
        shapes = {"A": (states, states), "B": (states, signals), "C": (commands, states)}
        for name, shape in shapes.items():
            own = getattr(self, name)
            if own.shape != shape and not (own.size == 0 and 0 in shape):
                rule = (
                    f"must have the shape {shape}, for the {states} states of A and the {self.D.shape} of D"
                )
                raise InputError(name, f"array of shape {own.shape}", rule)
            object.__setattr__(self, name, own.reshape(shape))

    @classmethod
    def gain(cls, signals: int, commands: int) -> ControlLaw:
        """Return the law without states that leads each signal to one command, or one signal to all commands.

        Parameters
        ----------
        signals, commands : int
            How many there are.

        Returns
        -------
        ControlLaw

        Raises
        ------
        InputError
            For other numbers of signals and commands.
        """
        if signals != commands and signals != 1:
            rule = (
                f"is missing: {signals} sensors and {commands} inputs need weights, or a law that joins them"
            )
            raise InputError("law", None, rule)
        through = np.ones((commands, 1)) if signals == 1 else np.eye(commands)
        return cls(np.zeros((0, 0)), np.zeros((0, signals)), np.zeros((commands, 0)), through)

    @classmethod
    def of(cls, given: Any) -> ControlLaw:
        """Return the law in a transfer function, a state space, or an object of another program that has one.

        Parameters
        ----------
        given : ControlLaw, (numerator, denominator), (A, B, C, D), or object
            Coefficients of powers of s, the highest first. An object has ``A, B, C, D`` or ``num, den``, as those of
            python-control and scipy.signal; its time must be continuous.

        Returns
        -------
        ControlLaw

        Raises
        ------
        InputError
            For anything else, an improper transfer function, or discrete time.
        """
        if isinstance(given, cls):
            return given
        if getattr(given, "dt", None):  # None and 0 are continuous
            raise InputError("law", f"sampled at {given.dt} s", "must be continuous in time")
        if isinstance(given, tuple) and len(given) == 4:
            return cls(*given)
        if isinstance(given, tuple) and len(given) == 2:
            return _of_transfer_function(*given)
        if all(hasattr(given, name) for name in _MATRICES):
            return cls(*(getattr(given, name) for name in _MATRICES))
        if hasattr(given, "num") and hasattr(given, "den"):
            return _of_matrix(given.num, given.den)
        raise InputError("law", type(given).__name__, _KINDS)

    @property
    def poles(self) -> Array:
        """Eigenvalues (k,) of A, rad/s."""
        return np.linalg.eigvals(self.A) if len(self.A) else np.zeros(0, dtype=complex)

    def response(self, omega: Array) -> Array:
        """Return the frequency response C (iω - A)⁻¹ B + D.

        Parameters
        ----------
        omega : array (frequencies,)
            Frequencies ω, rad/s.

        Returns
        -------
        array (frequencies, commands, signals)
            Commands per unit of each signal.
        """
        turning = 1j * np.asarray(omega)[:, None, None] * np.eye(len(self.A))
        return np.asarray(
            self.C @ np.linalg.solve(turning - self.A, np.asarray(self.B, dtype=complex)) + self.D
        )


def _matrix(name: str, given: ArrayLike) -> Array:
    """Return a matrix of finite numbers."""
    try:
        found = np.array(given, dtype=float)
    except (TypeError, ValueError):
        raise InputError(name, given, "must be a matrix of real numbers") from None
    found = np.atleast_2d(found) if found.size else found.reshape(found.shape if found.ndim == 2 else (0, 0))
    if found.ndim != 2 or not np.isfinite(found).all():
        raise InputError(name, given, "must be a matrix of finite numbers")
    found.flags.writeable = False
    return found


def _of_matrix(numerators: Any, denominators: Any) -> ControlLaw:
    """Return the law in a transfer function, or in a matrix of them with a row for each command."""
    if isinstance(denominators[0], int | float):  # np.float64 is one
        return _of_transfer_function(np.squeeze(np.asarray(numerators)), denominators)
    rows = [
        _beside([_of_transfer_function(*pair) for pair in zip(*row, strict=True)])
        for row in zip(numerators, denominators, strict=True)
    ]
    parts = [(one.A, one.B, one.C, one.D) for one in rows]
    return ControlLaw(
        _diagonal([a for a, *_ in parts]),
        np.concatenate([b for _, b, _, _ in parts]),
        _diagonal([c for _, _, c, _ in parts]),
        np.concatenate([d for *_, d in parts]),
    )


def _beside(laws: Sequence[ControlLaw]) -> ControlLaw:
    """Return the law of one command that is the sum of laws, each of a signal of its own."""
    return ControlLaw(
        _diagonal([law.A for law in laws]),
        _diagonal([law.B for law in laws]),
        np.concatenate([law.C for law in laws], axis=1),
        np.concatenate([law.D for law in laws], axis=1),
    )


def _diagonal(blocks: Sequence[Array]) -> Array:
    """Return blocks along a diagonal, zeros elsewhere; a block may have no rows or no columns."""
    from scipy.linalg import block_diag  # here, because it takes long to import

    return np.asarray(block_diag(*blocks))


def _of_transfer_function(numerator: ArrayLike, denominator: ArrayLike) -> ControlLaw:
    """Return the controllable form of a transfer function, by coefficients of powers of s, the highest first."""
    num, den = (
        np.trim_zeros(_coefficients(name, given), "f")
        for name, given in (("numerator", numerator), ("denominator", denominator))
    )
    if not len(den):
        raise InputError("denominator", denominator, "must not be zero")
    if len(num) > len(den):
        raise InputError("numerator", num.tolist(), _IMPROPER)
    states = len(den) - 1
    num, den = np.pad(num, (len(den) - len(num), 0)) / den[0], den / den[0]
    through = num[0]
    A = np.eye(states, k=-1)
    A[:1] = -den[1:]
    return ControlLaw(A, np.eye(states, 1), (num - through * den)[None, 1:], np.array([[through]]))


def _coefficients(name: str, given: ArrayLike) -> Array:
    """Return the coefficients (k,) of a polynomial; one number is a polynomial too."""
    try:
        found = np.atleast_1d(np.array(given, dtype=float))
    except (TypeError, ValueError):
        raise InputError(name, given, "must be real coefficients of powers of s, the highest first") from None
    if found.ndim != 1 or not np.isfinite(found).all():
        raise InputError(
            name, given, "must be a list of finite coefficients of powers of s, the highest first"
        )
    return found
