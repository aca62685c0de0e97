"""Whirl flutter of a propeller on a two-axis pivot: NASA TN D-659 (Reed and Bland, 1961).

    python benchmarks/reed_bland.py

First a rigid propeller with the report's derivatives; then a rotor with everything locked and blade-element
airloads. The report's chart has the structural damping g at neutral stability, at v = V/(Rω_θ) = 5.
`docs/reed-bland.md` tells what follows.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from rich.console import Console
from rich.table import Table
from scipy.optimize import brentq
from scipy.special import hankel2

import proprotor as pp
from benchmarks.propeller_strips import Lag, Propeller, neutral_damping
from benchmarks.propeller_strips import theodorsen as theodorsen_of_strips
from proprotor.model.structural_damping import NeutralDamping
from proprotor.rotor.motions import HUB

FT = 0.3048
SLUG = 0.45359237 * 9.80665 / FT

# The report's example.
N_BLADES = 4
RADIUS = 6.75 * FT
DENSITY = 0.001496 * SLUG / FT**3
POLAR_INERTIA = 175 * SLUG * FT**2
PIVOT_INERTIA = 1375 * SLUG * FT**2  # in pitch and in yaw, the propeller included
PIVOT_DISTANCE = 0.3778 * RADIUS
REDUCED_SPEED = 5.0
PITCH_FREQUENCY = 10.0  # ω_θ, rad/s: any will do, at a given reduced speed only ratios count
AIRSPEED = REDUCED_SPEED * RADIUS * PITCH_FREQUENCY

BLADE_ANGLES = np.array([34.7, 42.0, 48.0, 54.0, 58.0])  # deg at 0.75 R
ADVANCE_RATIOS = np.array(
    [1.78, 2.29, 2.90, 3.67, 4.20]
)  # J = V/(nD) of the windmilling propeller at these angles
DERIVATIVE_ANGLES = (34.0, 58.0)  # deg, between which the derivatives are linear
DERIVATIVES = pp.WhirlDerivatives(
    z_theta=(-0.381, -0.545),
    z_psi=(0.082, 0.091),
    z_r=(-0.231, -0.154),
    m_psi=(0.122, 0.080),
    m_q=(-0.114, -0.029),
)
CHART_ADVANCE_RATIOS = np.array([1.8, 2.6, 3.4, 4.2])
CHART = {
    1.0: np.array([0.1075, 0.086, 0.073, 0.064]),
    1.96: np.array([0.068, 0.051, 0.039, 0.032]),
}  # g by S_ψ/S_θ
CHART_RELATIVE, CHART_ABSOLUTE = 0.03, 0.0015  # how well the chart can be read: the larger of the two

# The report's blades are not at hand. One constant is fitted, the chord, to C_Zθ at the first blade angle.
KINDS = {False: "blade elements", True: "blade elements with lift lag"}
ROOT_CUTOUT = 0.2  # of the radius: spinner and round shank
LIFT_SLOPE = 2 * np.pi
TWIST_ADVANCE_RATIO = 2.90  # without load along the whole blade at this one
QUASI_STEADY = {
    "locked": ("flap", "lag", "pitch", "gimbal"),
    "rotor_speed": "constant",
    "compressibility": False,
    "section_damping": False,  # the report's strips have the incidence of the quarter chord
}


def reported_derivatives(advance_ratio: ArrayLike) -> pp.WhirlDerivatives:
    """The report's derivatives at the blade angle that goes with an advance ratio."""
    angle = np.interp(advance_ratio, ADVANCE_RATIOS, BLADE_ANGLES)
    return pp.WhirlDerivatives(*(np.interp(angle, DERIVATIVE_ANGLES, ends) for ends in DERIVATIVES))


def rotor_speed(advance_ratio: ArrayLike) -> NDArray:
    """Ω in rad/s at `AIRSPEED`: J = V/(nD) = πV/(ΩR), hence Ω/ω_θ = πv/J."""
    return np.pi * AIRSPEED / (np.asarray(advance_ratio) * RADIUS)


def propeller(
    advance_ratio: ArrayLike, derivatives: pp.WhirlDerivatives, mass: float = 200.0
) -> pp.LinearModel:
    """The report's propeller as a rigid body; the pivot's inertias include its mass, so any will do."""
    return pp.rigid_propeller(
        AIRSPEED,
        derivatives,
        radius=RADIUS,
        rotor_speed=rotor_speed(advance_ratio),
        density=DENSITY,
        mass=mass,
        polar_inertia=POLAR_INERTIA,
        diametral_inertia=POLAR_INERTIA / 2,
    )


def pivot(stiffness_ratio: float, structural_damping: float = 0.0, frequency: float = 1.0) -> pp.NormalModes:
    """The report's mount by S_ψ/S_θ; viscous dampers gS/ω stand for structural damping at one frequency."""
    stiffness = PIVOT_INERTIA * PITCH_FREQUENCY**2 * np.array([1.0, stiffness_ratio])
    damping = structural_damping * stiffness / frequency
    inertia = (PIVOT_INERTIA, PIVOT_INERTIA)
    return pp.two_axis_pivot(PIVOT_DISTANCE, inertia, stiffness, damping, includes_rotor="rigid")


def neutral(rotor_alone: pp.LinearModel, stiffness_ratio: float) -> NeutralDamping:
    """Structural dampings at neutral stability of a propeller or rotor on the report's mount."""
    support = pivot(stiffness_ratio)
    return pp.neutral_damping(pp.mount(rotor_alone, support), support.stiffness)


def whirl(shape: NDArray) -> NDArray:
    """+1 where pitch and yaw (..., 2) go round with the rotor, -1 where against it.

    The rotor turns from I to J, and so does the hub when yaw follows pitch by a quarter of a cycle.
    """
    return -np.sign(np.imag(shape[..., 1] * np.conj(shape[..., 0])))


def bladed_rotor(chord: float, root_cutout: float = ROOT_CUTOUT) -> pp.Rotor:
    """The propeller as a rotor: blades of constant chord (m) with helical twist, no drag, same inertia."""
    r = np.linspace(0.05, 1.0, 96) * RADIUS
    first_moment, inertia = 30.0, POLAR_INERTIA / N_BLADES
    return pp.Rotor(
        n_blades=N_BLADES,
        radius=RADIUS,
        root_cutout=root_cutout * RADIUS,
        blade_mass=50.0,
        blade_first_moment=first_moment,
        blade_inertia=inertia,
        flap_first_moment=first_moment,
        flap_inertia=inertia,
        lag_first_moment=first_moment,
        lag_inertia=inertia,
        flap_stiffness=1e6,
        lag_stiffness=1e6,
        chord=chord,
        twist=(r, np.arctan(TWIST_ADVANCE_RATIO * RADIUS / (np.pi * r))),
        airfoil=pp.Airfoil(lift_slope=LIFT_SLOPE),
    )


def rotor_on_hub(rotor: pp.Rotor, advance_ratio: ArrayLike, **options) -> pp.LinearModel:
    """The locked, windmilling rotor on its hub coordinates."""
    operation = pp.Operation(rotor_speed=rotor_speed(advance_ratio), density=DENSITY, speed_of_sound=340.0)
    return pp.rotor_model(rotor, operation, AIRSPEED, **(QUASI_STEADY | options))


def rotor_derivatives(
    rotor: pp.Rotor, advance_ratio: ArrayLike, lift: ArrayLike = 1.0, **options
) -> pp.WhirlDerivatives:
    """Whirl derivatives of the rotor's airloads, quasi-steady or with a `lift` as in `lagging`."""
    still = rotor_on_hub(rotor, advance_ratio, airloads="none")
    moving = lagging(rotor, advance_ratio, lift, **options)
    return whirl_derivatives(moving.C - still.C, moving.K - still.K, AIRSPEED, RADIUS, DENSITY)


def whirl_derivatives(
    damping: NDArray, stiffness: NDArray, airspeed: ArrayLike, radius: ArrayLike, density: ArrayLike
) -> pp.WhirlDerivatives:
    """Return the whirl derivatives that the airloads of any axisymmetric rotor contain.

    Parameters
    ----------
    damping, stiffness : array (..., n, n)
        Contribution of the airloads to C and K, SI; the six hub coordinates are the first.
    airspeed, radius, density : float or array (...)
        m/s, above zero; m; kg/m³.

    Returns
    -------
    WhirlDerivatives
        Dimensionless, (...).
    """
    speed, radius, density = (np.asarray(value, dtype=float) for value in (airspeed, radius, density))
    force = density * speed**2 * np.pi * radius**2 / 2
    x, y, alpha_x, alpha_y = (HUB.index(name) for name in ("x", "y", "alpha_x", "alpha_y"))
    return pp.WhirlDerivatives(
        z_theta=stiffness[..., x, alpha_y] / force,
        z_psi=-stiffness[..., y, alpha_y] / force,
        z_r=-damping[..., y, alpha_y] * speed / (force * radius),
        m_psi=-stiffness[..., alpha_x, alpha_y] / (2 * force * radius),
        m_q=-damping[..., alpha_y, alpha_y] * speed / (2 * force * radius**2),
    )


def theodorsen(reduced_frequency: ArrayLike) -> NDArray:
    """C(k), complex, of a section whose flow changes with exp(+iωt)."""
    second, first = hankel2(1, reduced_frequency), hankel2(0, reduced_frequency)
    return second / (second + 1j * first)


def lift_factor(chord: float, advance_ratio: ArrayLike, unsteady: bool) -> NDArray:
    """What is left of quasi-steady lift: C(k) at 0.75 R with k = Ωc/2U, for a change once a turn, or 1."""
    k = chord / (2 * RADIUS * np.hypot(0.75, np.asarray(advance_ratio) / np.pi))
    return theodorsen(k) if unsteady else np.ones_like(k)


def lagging(rotor: pp.Rotor, advance_ratio: ArrayLike, lift: ArrayLike, **options) -> pp.LinearModel:
    """The rotor with a complex factor `lift` on its perturbation airloads.

    Lift that comes late comes at a later azimuth: in-plane forces and moments turn about K by that angle.
    """
    still = rotor_on_hub(rotor, advance_ratio, airloads="none")
    quasi_steady = rotor_on_hub(rotor, advance_ratio, **options)
    late = np.conj(lift) * np.ones_like(advance_ratio)
    turn = np.moveaxis(np.array([[late.real, -late.imag], [late.imag, late.real]]), (0, 1), (-2, -1))
    factor = np.zeros((*turn.shape[:-2], 6, 6))
    factor[..., [2, 5], [2, 5]] = 1.0
    factor[..., :2, :2] = factor[..., 3:5, 3:5] = turn
    C, K = (a + factor @ (b - a) for a, b in ((still.C, quasi_steady.C), (still.K, quasi_steady.K)))
    return replace(quasi_steady, C=C, K=K)


def fitted_rotor(unsteady: bool, root_cutout: float = ROOT_CUTOUT) -> pp.Rotor:
    """The rotor whose C_Zθ is the report's at the first blade angle, by its chord."""
    first = ADVANCE_RATIOS[0]
    quasi_steady = rotor_derivatives(bladed_rotor(1.0, root_cutout), first).z_theta  # proportional to chord
    wanted = reported_derivatives(first).z_theta

    def excess(chord: float) -> float:
        return chord * quasi_steady * lift_factor(chord, first, unsteady).real - wanted

    return bladed_rotor(brentq(excess, 0.01 * RADIUS, RADIUS), root_cutout)


def with_lag(rotor: pp.Rotor, advance_ratio: ArrayLike) -> pp.LinearModel:
    """The locked rotor whose sections' lift lags with states of the package, on its hub coordinates."""
    return rotor_on_hub(rotor, advance_ratio, lift="lagged")


def at_one_per_turn(model: pp.LinearModel) -> pp.LinearModel:
    """The same for a hub that moves so slowly that the lag is that of one change a turn, as the report has it."""
    own, lag = slice(None, len(HUB)), slice(len(HUB), None)
    late = model.C[..., own, lag] @ np.linalg.inv(model.C[..., lag, lag])
    C, K = (part[..., own, own] - late @ part[..., lag, own] for part in (model.C, model.K))
    return replace(model.submodel(HUB), C=C, K=K)


def rotor_fitted_with_lag(root_cutout: float = ROOT_CUTOUT) -> pp.Rotor:
    """The rotor whose C_Zθ, with the lag of its sections, is the report's at the first blade angle, by its chord."""
    first = ADVANCE_RATIOS[0]
    wanted = reported_derivatives(first).z_theta

    def excess(chord: float) -> float:
        rotor = bladed_rotor(chord, root_cutout)
        still = rotor_on_hub(rotor, first, airloads="none")
        moving = at_one_per_turn(with_lag(rotor, first))
        found = whirl_derivatives(moving.C - still.C, moving.K - still.K, AIRSPEED, RADIUS, DENSITY)
        return float(found.z_theta - wanted)

    return bladed_rotor(brentq(excess, 0.05 * RADIUS, 0.5 * RADIUS), root_cutout)


def neutral_with_states(rotor_alone: pp.LinearModel, stiffness_ratio: float) -> NDArray:
    """g of backward whirl at neutral stability of a rotor with states of its own: at its frequency g is real."""
    support = pivot(stiffness_ratio)
    model = pp.mount(rotor_alone, support)
    count = len(support.names)
    own, lag = slice(None, count), slice(count, None)

    def dampings(omega: float) -> NDArray:
        s = 1j * omega
        whole = s**2 * model.M + s * model.C + model.K
        condensed = whole[own, own] - whole[own, lag] @ np.linalg.solve(whole[lag, lag], whole[lag, own])
        found = np.linalg.eigvals(1j * np.linalg.solve(support.stiffness, condensed))
        return found[np.argsort(found.real)]

    start = neutral(at_one_per_turn(rotor_alone), stiffness_ratio).frequency[0]
    return dampings(brentq(lambda omega: dampings(omega)[-1].imag, 0.9 * start, 1.1 * start))[-1].real


def chart_with_lag(root_cutout: float = ROOT_CUTOUT) -> dict[float, NDArray]:
    """g with the lag of one change a turn, from the states of the package."""
    rotor = rotor_fitted_with_lag(root_cutout)
    return chart_of(at_one_per_turn(with_lag(rotor, CHART_ADVANCE_RATIOS)))


def chart_with_states(root_cutout: float = ROOT_CUTOUT) -> dict[float, NDArray]:
    """g with the lag at the frequencies of the whirl, as seen from the blades."""
    rotor = rotor_fitted_with_lag(root_cutout)
    models = [with_lag(rotor, j) for j in CHART_ADVANCE_RATIOS]
    return {ratio: np.array([neutral_with_states(model, ratio) for model in models]) for ratio in CHART}


def chart_of_strips(
    lag: Lag, root_cutout: float = ROOT_CUTOUT, *, slow_hub: bool = False
) -> dict[float, NDArray]:
    """g by strips written down apart, of the same chord and without steady load at any advance ratio."""
    chord = float(rotor_fitted_with_lag(root_cutout).chord)
    return {
        ratio: np.array(
            [_of_strips(lag, chord, root_cutout, j, ratio, slow_hub) for j in CHART_ADVANCE_RATIOS]
        )
        for ratio in CHART
    }


def _of_strips(lag: Lag, chord: float, root_cutout: float, j: float, ratio: float, slow_hub: bool) -> float:
    strips = Propeller(
        n_blades=N_BLADES,
        radius=RADIUS,
        root_cutout=root_cutout * RADIUS,
        chord=chord,
        lift_slope=LIFT_SLOPE,
        rotor_speed=float(rotor_speed(j)),
        polar_inertia=POLAR_INERTIA,
        inertia=PIVOT_INERTIA,
        distance=PIVOT_DISTANCE,
        airspeed=AIRSPEED,
        density=DENSITY,
    )
    springs = PIVOT_INERTIA * PITCH_FREQUENCY**2 * np.array([1.0, ratio])
    near = float(neutral(propeller(j, reported_derivatives(j)), ratio).frequency[0])
    return neutral_damping(strips, springs, near, lag, slow_hub=slow_hub)


def chart_of(rotor_alone: pp.LinearModel) -> dict[float, NDArray]:
    """g at the points of the report's chart."""
    return {ratio: neutral(rotor_alone, ratio).damping[:, 0] for ratio in CHART}


def chart_of_report(**instead: float) -> dict[float, NDArray]:
    """g with the report's derivatives, or some other value for one of them."""
    derivatives = reported_derivatives(CHART_ADVANCE_RATIOS)._replace(**instead)
    return chart_of(propeller(CHART_ADVANCE_RATIOS, derivatives))


def chart_of_blades(unsteady: bool, root_cutout: float = ROOT_CUTOUT) -> dict[float, NDArray]:
    """g with the airloads of blade elements."""
    rotor = fitted_rotor(unsteady, root_cutout)
    lift = lift_factor(rotor.chord, CHART_ADVANCE_RATIOS, unsteady)
    return chart_of(lagging(rotor, CHART_ADVANCE_RATIOS, lift))


def print_charts(console: Console) -> None:
    charts = {"report's derivatives": chart_of_report(), "the same without C_Zψ": chart_of_report(z_psi=0.0)}
    for unsteady, kind in KINDS.items():
        for cutout in (0.1, ROOT_CUTOUT, 0.3):
            charts[f"{kind} from {cutout:g} R"] = chart_of_blades(unsteady, cutout)
    for cutout in (0.15, ROOT_CUTOUT, 0.25):
        charts[f'lift="lagged" from {cutout:g} R, lag of one change a turn'] = chart_with_lag(cutout)
        charts[f'lift="lagged" from {cutout:g} R'] = chart_with_states(cutout)
        charts[f"strips with C(k) from {cutout:g} R, lag of one change a turn"] = chart_of_strips(
            theodorsen_of_strips, cutout, slow_hub=True
        )
        charts[f"strips with C(k) from {cutout:g} R"] = chart_of_strips(theodorsen_of_strips, cutout)
    for ratio, chart in CHART.items():
        title = f"g of backward whirl at neutral stability, S_ψ/S_θ = {ratio:g}"
        table = Table("J", *(f"{j:g}" for j in CHART_ADVANCE_RATIOS), title=title)
        table.add_row("chart", *(f"{g:.4f}" for g in chart))
        for name, values in charts.items():
            excess = values[ratio] / chart - 1
            table.add_row(name, *(f"{g:.4f} ({e:+.1%})" for g, e in zip(values[ratio], excess, strict=True)))
        console.print(table)


def print_whirl(console: Console) -> None:
    model = propeller(CHART_ADVANCE_RATIOS, reported_derivatives(CHART_ADVANCE_RATIOS))
    table = Table("S_ψ/S_θ", "J", "g", "ω/ω_θ", "|ψ/θ|", "whirl", title="All neutral oscillations")
    for ratio in CHART:
        points = neutral(model, ratio)
        for place, found in np.argwhere(np.isfinite(points.damping)):
            g, omega, shape = (values[place, found] for values in points)
            numbers = (g, omega / PITCH_FREQUENCY, abs(shape[1] / shape[0]))
            table.add_row(
                f"{ratio:g}",
                f"{CHART_ADVANCE_RATIOS[place]:g}",
                *(f"{number:.4f}" for number in numbers),
                "forward" if whirl(shape) > 0 else "backward",
            )
    console.print(table)


def print_derivatives(console: Console) -> None:
    report = reported_derivatives(ADVANCE_RATIOS)
    for unsteady, kind in KINDS.items():
        rotor = fitted_rotor(unsteady)
        lift = lift_factor(rotor.chord, ADVANCE_RATIOS, unsteady)
        title = f"{kind}, chord {rotor.chord / RADIUS:.4f} R (in brackets, the report's derivatives)"
        table = Table("blade angle", *(f"{angle:g} deg" for angle in BLADE_ANGLES), title=title)
        derivatives = rotor_derivatives(rotor, ADVANCE_RATIOS, lift)
        for name, values, reported in zip(report._fields, derivatives, report, strict=True):
            table.add_row(name, *(f"{a + 0.0:.4f} ({b:.4f})" for a, b in zip(values, reported, strict=True)))
        collective = np.degrees(rotor_on_hub(rotor, ADVANCE_RATIOS).trim.collective)
        table.add_row("windmilling collective, deg", *(f"{angle:.1f}" for angle in collective))
        console.print(table)


def main() -> None:
    console = Console(width=140)
    print_whirl(console)
    print_derivatives(console)
    print_charts(console)


if __name__ == "__main__":
    main()
