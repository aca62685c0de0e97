"""The nonlinear rotor in JAX: its Lagrangian from the position vector, its matrices by automatic differentiation.

Nothing is expanded and nothing derived by hand. Hub and yoke turn by rotation vectors, the blade by finite flap and lag
angles, and the mass enters by its integrals over the arms (1, r - rho_beta, rho_beta, rho_zeta), as in the generated
equations. Rows are d/dt dL/dq' - dL/dq with the dampers, in the order of Eq. 17; hub rows are generalised forces, which
to first order are the resultants as long as no steady moment acts.
"""

from __future__ import annotations

from collections.abc import Mapping

import jax
import jax.numpy as jnp

jax.config.update("jax_enable_x64", True)

N_BLADES = 3  # blades are an axis of the arrays
N_COORDINATES = 18
INPUTS = (
    *("rotor_speed", "precone", "flap_hinge_offset", "lag_hinge_offset", "pitch_gimbal_coupling"),
    *("blade_mass", "blade_first_moment", "blade_inertia", "flap_first_moment", "flap_inertia"),
    *("lag_first_moment", "lag_inertia", "pitch_inertia", "propeller_moment", "structural_pitch_offset"),
    *("flap_stiffness", "lag_stiffness", "flap_outboard_fraction", "lag_outboard_fraction"),
    *("gimbal_stiffness", "control_stiffness"),
    *("flap_damping", "lag_damping", "pitch_damping", "gimbal_damping"),
    *("coning", "lag", "elastic_pitch", "collective"),
)
HUB, TURN = slice(0, 3), slice(3, 6)
FLAP, LAG, PITCH, AZIMUTH = 6, 9, 12, 15
GIMBAL = slice(16, 18)


def turned(rotation, vector):
    """exp([rotation]x) vector, its coefficients as power series: smooth at zero."""
    squared = jnp.sum(rotation * rotation)
    sine = 1 - squared / 6 * (1 - squared / 20 * (1 - squared / 42))
    versine = (1 - squared / 12 * (1 - squared / 30 * (1 - squared / 56))) / 2
    once = jnp.cross(rotation, vector)
    return vector + sine * once + versine * jnp.cross(rotation, once)


def on_blade(q, first, azimuth):
    """An angle of each blade from its three multiblade coordinates."""
    return q[first] + q[first + 1] * jnp.cos(azimuth) + q[first + 2] * jnp.sin(azimuth)


def azimuths(p, t):
    return p["rotor_speed"] * t + 2 * jnp.pi / N_BLADES * jnp.arange(N_BLADES)


def arm_vectors(p, q, t):
    """The vectors (blade, 4, 3) that the arms (1, r - rho_beta, rho_beta, rho_zeta) multiply."""
    nominal = azimuths(p, t)
    azimuth = nominal + q[AZIMUTH]
    flap, lag = on_blade(q, FLAP, nominal), on_blade(q, LAG, nominal)
    still = jnp.zeros_like(azimuth)
    i = jnp.stack([jnp.sin(azimuth), -jnp.cos(azimuth), still], -1)
    j = jnp.stack([jnp.cos(azimuth), jnp.sin(azimuth), still], -1)
    k = jnp.array([0.0, 0.0, 1.0])
    cone = (p["precone"] + flap)[:, None]
    root = jnp.cos(p["precone"]) * j + jnp.sin(p["precone"]) * k
    raised = jnp.cos(cone) * j + jnp.sin(cone) * k
    swing = (jnp.cos(lag)[:, None] - 1) * raised + jnp.sin(lag)[:, None] * i
    in_yoke = jnp.stack([root, raised, swing], 1)
    tilt = jnp.array([q[GIMBAL][1], -q[GIMBAL][0], 0.0])
    inertial = turned(q[TURN], turned(tilt, in_yoke))
    hub = jnp.broadcast_to(q[HUB], (N_BLADES, 1, 3))
    return jnp.concatenate([hub, inertial], 1)


def pitch_angles(p, q, t):
    """Pitch of each blade relative to the shaft and to the yoke."""
    nominal = azimuths(p, t)
    azimuth = nominal + q[AZIMUTH]
    cosine, sine = jnp.cos(azimuth), jnp.sin(azimuth)
    flap = q[GIMBAL][0] * cosine + q[GIMBAL][1] * sine
    roll = q[GIMBAL][1] * cosine - q[GIMBAL][0] * sine
    to_shaft = p["collective"] + on_blade(q, PITCH, nominal) - p["pitch_gimbal_coupling"] * flap
    return to_shaft, to_shaft - roll


def arm_inertia(p):
    """Integrals (4, 4) of the mass times two of the arms."""
    flap_hub = p["flap_inertia"] + p["flap_hinge_offset"] * p["flap_first_moment"]
    lag_hub = p["lag_inertia"] + p["lag_hinge_offset"] * p["lag_first_moment"]
    gap = p["lag_hinge_offset"] - p["flap_hinge_offset"]
    flap_lag = p["lag_inertia"] + gap * p["lag_first_moment"]
    first = p["blade_first_moment"] - p["flap_first_moment"]
    second = p["blade_inertia"] - 2 * flap_hub + p["flap_inertia"]
    to_flap, to_lag = flap_hub - p["flap_inertia"], lag_hub - flap_lag
    return jnp.array(
        [
            [p["blade_mass"], first, p["flap_first_moment"], p["lag_first_moment"]],
            [first, second, to_flap, to_lag],
            [p["flap_first_moment"], to_flap, p["flap_inertia"], flap_lag],
            [p["lag_first_moment"], to_lag, flap_lag, p["lag_inertia"]],
        ]
    )


def potential(p, q, t):
    """Hinge springs in series, control system, propeller moment, gimbal spring."""
    nominal = azimuths(p, t)
    flap, lag, elastic = (on_blade(q, first, nominal) for first in (FLAP, LAG, PITCH))
    _, pitch = pitch_angles(p, q, t)
    c, s = jnp.cos(pitch + p["structural_pitch_offset"]), jnp.sin(pitch + p["structural_pitch_offset"])
    soft_flap, soft_lag = 1 / p["flap_stiffness"], 1 / p["lag_stiffness"]
    flat, edge = p["flap_outboard_fraction"] * soft_flap, p["lag_outboard_fraction"] * soft_lag
    flap_flap = soft_flap - flat + flat * c**2 + edge * s**2
    lag_lag = soft_lag - edge + flat * s**2 + edge * c**2
    flap_lag = (flat - edge) * s * c
    bent = lag_lag * flap**2 - 2 * flap_lag * flap * lag + flap_flap * lag**2
    hinges = bent / (flap_flap * lag_lag - flap_lag**2)
    propeller = p["propeller_moment"] * p["pitch_inertia"] * p["rotor_speed"] ** 2 * jnp.sin(pitch) ** 2
    blades = jnp.sum(hinges + propeller + p["control_stiffness"] * elastic**2)
    return (blades + p["gimbal_stiffness"] * jnp.sum(q[GIMBAL] ** 2)) / 2


def lagrangian(p, q, rate, t):
    moving = (q, t), (rate, jnp.ones_like(t))
    _, velocity = jax.jvp(lambda q, t: arm_vectors(p, q, t), *moving)
    _, (pitch_rate, _) = jax.jvp(lambda q, t: pitch_angles(p, q, t), *moving)
    weighted = jnp.sum(
        arm_inertia(p)[:, :, None] * velocity[:, None], 2
    )  # sums: small products are slow on CPUs
    kinetic = jnp.sum(weighted * velocity) + p["pitch_inertia"] * jnp.sum(pitch_rate**2)
    return kinetic / 2 - potential(p, q, t)


def damper_rows(p, q, rate, t):
    """Dampers of hinges, pitch and gimbal, as loads on the left."""

    def angles(q, t):
        nominal = azimuths(p, t)
        return jnp.stack([on_blade(q, first, nominal) for first in (FLAP, LAG, PITCH)])

    _, angle_rates = jax.jvp(angles, (q, t), (rate, jnp.ones_like(t)))
    constants = jnp.stack([p["flap_damping"], p["lag_damping"], p["pitch_damping"]])
    _, pull = jax.vjp(lambda q: angles(q, t), q)
    (rows,) = pull(constants[:, None] * angle_rates)
    return rows.at[GIMBAL].add(p["gimbal_damping"] * rate[GIMBAL])


def rows(p, q, rate, acceleration, t):
    """Left-hand side of the equations of motion."""
    momentum = jax.grad(lagrangian, argnums=2)
    _, momentum_rate = jax.jvp(
        lambda q, rate, t: momentum(p, q, rate, t), (q, rate, t), (rate, acceleration, jnp.ones_like(t))
    )
    return momentum_rate - jax.grad(lagrangian, argnums=1)(p, q, rate, t) + damper_rows(p, q, rate, t)


def trim(p):
    """Hub still, yoke level, every blade alike."""
    q = jnp.zeros(N_COORDINATES)
    for place, name in ((FLAP, "coning"), (LAG, "lag"), (PITCH, "elastic_pitch")):
        q = q.at[place].set(p[name])
    return q


def matrices(p: Mapping[str, jax.Array]) -> tuple[jax.Array, jax.Array, jax.Array]:
    """M, C, K (18, 18) of one rotor about its trim."""
    still, t = jnp.zeros(N_COORDINATES), jnp.zeros(())
    stiffness, damping, mass = jax.jacfwd(lambda *state: rows(p, *state, t), argnums=(0, 1, 2))(
        trim(p), still, still
    )
    return mass, damping, stiffness


def energy_form(p, vectors, inertia, q, t):
    """M, C and K of the kinetic energy 1/2 sum I_kl P_k' . P_l' of vectors P (blade, k, ...) at rest, I constant.

    M = sum I P,i . P,j    C = 2 sum I P,i . d/dt P,j    K = sum I (P,i . d2/dt2 P,j + P,ij . d2/dt2 P)
    """

    def slopes(t):
        return jax.jacfwd(lambda q: vectors(q, t))(q)

    def rate(function):
        return lambda t: jax.jvp(function, (t,), (jnp.ones_like(t),))[1]

    def product(left, right):
        axes = tuple(range(left.ndim - 1))
        return jnp.sum(left[..., :, None] * right[..., None, :], axes)

    def weighted(values):
        shape = (1, *inertia.shape, *[1] * (values.ndim - 2))
        return jnp.sum(inertia.reshape(shape) * values[:, None], 2)

    virtual = slopes(t)
    acceleration = weighted(rate(rate(lambda t: vectors(q, t)))(t))
    turned_work = jax.hessian(lambda q: jnp.sum(vectors(q, t) * acceleration))(q)
    moved = product(virtual, weighted(rate(rate(slopes))(t)))
    gyroscopic = 2 * product(virtual, weighted(rate(slopes)(t)))
    return product(virtual, weighted(virtual)), gyroscopic, moved + turned_work


def short_matrices(p: Mapping[str, jax.Array]) -> tuple[jax.Array, jax.Array, jax.Array]:
    """The same M, C, K from the slopes of positions: what a hand adds is that only positions need differentiating."""
    q, t = trim(p), jnp.zeros(())
    still = jnp.zeros(N_COORDINATES)
    blade = energy_form(p, lambda q, t: arm_vectors(p, q, t), arm_inertia(p), q, t)
    to_shaft = energy_form(
        p, lambda q, t: pitch_angles(p, q, t)[0][:, None], p["pitch_inertia"].reshape(1, 1), q, t
    )
    springs = jax.hessian(lambda q: potential(p, q, t))(q)
    held, dampers = jax.jacfwd(lambda q, rate: damper_rows(p, q, rate, t), argnums=(0, 1))(q, still)
    mass, damping, stiffness = (a + b for a, b in zip(blade, to_shaft, strict=True))
    return mass, damping + dampers, stiffness + springs + held


FORMS = {"Lagrangian": matrices, "positions": short_matrices}
