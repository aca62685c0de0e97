"""Model a rigid propeller with published whirl derivatives, in place of a rotor, on the six hub coordinates.

The derivatives have the definitions of NASA TN D-659 (Reed and Bland, 1961), in axes X forward along the shaft, Y to
the right and Z down, the propeller turning about +X:

    F_Z  = ½ρV²S ( C_Zθ θ̄ + C_Zψ ψ̄ + C_Zr ψ̇R/V)        M_Y = ρV²SR ( C_mψ ψ̄ + C_mq θ̇R/V)
    F_Y  = ½ρV²S ( C_Zψ θ̄ - C_Zθ ψ̄ + C_Zr θ̇R/V)        M_Z = ρV²SR (-C_mψ θ̄ + C_mq ψ̇R/V)        S = πR²

with pitch θ about Y (nose up), yaw ψ about Z (nose right), and θ̄, ψ̄ the angles between the shaft and the
hub's path. The rotor's axes are I up, J outboard and K forward along the shaft, and it turns about +K. So
X = K, Y = J, Z = -I, and

    θ = αy        ψ = -αx        θ̄ = αy - ẋ/V        ψ̄ = -αx - ẏ/V
    f_x = -F_Z    f_y = F_Y      m_x = -M_Z          m_y = M_Y

A hub at a distance l ahead of a pivot has ẋ = lθ̇ and ẏ = lψ̇, which gives the report's θ̄ = θ - lθ̇/V.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import check_finite
from proprotor.model.linear_model import LinearModel
from proprotor.rotor.motions import HUB
from proprotor.rotor.trim import Trim
from proprotor.typing import Array, Numbers
from proprotor.units import in_metres_per_second

_LOADS = [HUB.index(name) for name in ("x", "y", "alpha_x", "alpha_y")]
_PATH = _LOADS[:2]
_ANGLES = _LOADS[2:]
_TO_ATTITUDE = np.array([[0.0, 1.0], [-1.0, 0.0]])  # (θ, ψ) from (αx, αy)


class WhirlDerivatives(NamedTuple):
    """Derivatives of a propeller's forces and moments in pitch and yaw, dimensionless, as `rigid_propeller` uses them.

    The propeller is axisymmetric, so these derivatives also give the force along Y and the moment about Z.

    Parameters
    ----------
    z_theta, z_psi : float or array
        C_Zθ and C_Zψ, force against the shaft's angles to its path; dimensionless.
    z_r : float or array
        C_Zr, force against the yaw rate; dimensionless.
    m_psi : float or array
        C_mψ, pitching moment against the yaw angle; dimensionless.
    m_q : float or array
        C_mq, pitching moment against the pitch rate; dimensionless.
    """

    z_theta: Numbers
    z_psi: Numbers
    z_r: Numbers
    m_psi: Numbers
    m_q: Numbers


def rigid_propeller(
    airspeed: Any,
    derivatives: WhirlDerivatives,
    *,
    radius: ArrayLike,
    rotor_speed: ArrayLike,
    density: ArrayLike,
    mass: ArrayLike,
    polar_inertia: ArrayLike,
    diametral_inertia: ArrayLike,
) -> LinearModel:
    """Return the propeller on its six hub coordinates: inertia, gyroscopic moments and airloads.

    The propeller has no steady thrust or torque, turns at constant speed, and its trim has no collective (NaN).

    Parameters
    ----------
    airspeed : float, array (...) in m/s, or pint quantity
        Not negative.
    derivatives : WhirlDerivatives
        Numbers or arrays; all arguments broadcast together to the batch's shape.
    radius : float or array
        R, m.
    rotor_speed : float or array
        Ω about +K, rad/s.
    density : float or array
        ρ, kg/m³.
    mass, polar_inertia, diametral_inertia : float or array
        kg; about the shaft and about a diameter through the hub, kg m².

    Returns
    -------
    LinearModel
        On the hub coordinates x, y, z, alpha_x, alpha_y, alpha_z, SI.

    Raises
    ------
    InputError
        For a value that is not finite, or a negative value that is no derivative.
    """
    given = {
        "airspeed": in_metres_per_second(airspeed, density),
        "radius": radius,
        "rotor_speed": rotor_speed,
        "density": density,
        "mass": mass,
        "polar_inertia": polar_inertia,
        "diametral_inertia": diametral_inertia,
    }
    for name, value in given.items():
        check_finite(name, value, "not negative")
    for name, value in derivatives._asdict().items():
        check_finite(name, value)
    values = (np.asarray(value, dtype=float) for value in (*given.values(), *derivatives))
    speed, radius, omega, density, mass, polar, diametral, *numbers = np.broadcast_arrays(*values)
    damping, stiffness = _airloads(speed, radius, density, WhirlDerivatives(*numbers))
    inertia = np.stack([mass, mass, mass, diametral, diametral, polar], axis=-1)[..., None] * np.eye(len(HUB))
    return LinearModel(
        M=inertia,
        C=_gyroscopic(polar * omega) + damping,
        K=stiffness,
        dofs=HUB,
        trim=_unloaded(speed.shape),
        airspeed=speed,
        mass_at_rest=inertia.copy(),
    )


def _airloads(
    speed: Array, radius: Array, density: Array, derivatives: WhirlDerivatives
) -> tuple[Array, Array]:
    """Return damping and stiffness (..., 6, 6): minus the loads per unit of rate and of displacement."""
    z_theta, z_psi, z_r, m_psi, m_q = derivatives
    arm = 2 * radius
    zero = np.zeros_like(speed)
    # Rows f_x, f_y, m_x, m_y over ½ρV²S; columns θ̄, ψ̄ and θ̇R/V, ψ̇R/V.
    angle_rows = [[-z_theta, -z_psi], [z_psi, -z_theta], [arm * m_psi, zero], [zero, arm * m_psi]]
    rate_rows = [[zero, -z_r], [z_r, zero], [zero, -arm * m_q], [arm * m_q, zero]]
    by_angle, by_rate = (np.moveaxis(np.array(rows), (0, 1), (-2, -1)) for rows in (angle_rows, rate_rows))
    flow = (density * np.pi * radius**2 / 2 * speed)[..., None, None]  # ½ρVS
    speed, radius = speed[..., None, None], radius[..., None, None]
    damping, stiffness = (np.zeros((*by_angle.shape[:-2], len(HUB), len(HUB))) for _ in range(2))
    _set(stiffness, _ANGLES, -flow * speed * by_angle @ _TO_ATTITUDE)
    _set(damping, _ANGLES, -flow * radius * by_rate @ _TO_ATTITUDE)
    _set(damping, _PATH, flow * by_angle)  # θ̄ and ψ̄ have -ẋ/V and -ẏ/V
    return damping, stiffness


def _set(matrix: Array, columns: list[int], loads: Array) -> None:
    """Put the loads into the rows of forces and moments, in some columns of a matrix."""
    matrix[..., np.array(_LOADS)[:, None], np.array(columns)] = loads


def _gyroscopic(momentum: Array) -> Array:
    """Return the matrix of α̇ × momentum K, the moment that turns the spin axis."""
    matrix = np.zeros((*momentum.shape, len(HUB), len(HUB)))
    alpha_x, alpha_y = _ANGLES
    matrix[..., alpha_x, alpha_y], matrix[..., alpha_y, alpha_x] = momentum, -momentum
    return matrix


def _unloaded(shape: tuple[int, ...]) -> Trim:
    """Return a trim without loads, of a batch of some shape."""
    still = {
        name: np.zeros(shape) for name in ("coning", "lag", "elastic_pitch", "thrust", "torque", "inflow")
    }
    return Trim(
        **still,
        collective=np.full(shape, np.nan),
        converged=np.ones(shape, dtype=bool),
        reason=np.full(shape, "", dtype=object),
        warning=np.full(shape, "", dtype=object),
        iterations=np.zeros(shape, dtype=int),
    )
