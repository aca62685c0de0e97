"""Reasons why a point has no trim, and warnings where a trim is doubtful."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from proprotor.rotor.elimination import solve
from proprotor.rotor.trim import THRUST, Target
from proprotor.rotor.trim_balance import Balance, Linear, State
from proprotor.rotor.trim_path import Path
from proprotor.rotor.trim_start import FARTHEST
from proprotor.typing import Array

LOST = "the trim at the end of the path from the undeflected blade was lost: Newton did not stay near it"
# Of the airspeed: above this share the neglected induced velocity turns the inflow by degrees.
INDUCED_SHARE = 0.05
LARGEST_ANGLE = np.radians(20)  # of a blade that rigid hinges stand for
_QUADRATURE = 1e-10  # relative error of the loads and their slopes
_GIVEN_SPRINGS = ("flap_flap_stiffness", "lag_lag_stiffness", "cyclic_flap_stiffness_excess")
_ANGLES = ("coning", "lag", "elastic_pitch")


def before_trim(balance: Balance, points: int) -> Array:
    """Return the reasons (points,) that are known before any iteration, empty for points without one."""
    quantities, options = balance.quantities, balance.options
    reason = np.full(points, "", dtype=object)
    airspeed = np.broadcast_to(quantities["airspeed"], (points,))
    reason[~np.isfinite(airspeed)] = "airspeed is not a finite number"
    reason[airspeed < 0] = "airspeed is negative: the model is for axial flight along +K"
    if balance.target.finds_collective:
        vacuum = np.broadcast_to(quantities["density"], (points,)) == 0
        reason[vacuum & (reason == "")] = "no trim by airloads in a vacuum: give a collective"
    if options.compressibility and not balance.sections.airfoil.contains_compressibility:
        tip_speed = np.asarray(quantities["rotor_speed"]) * quantities["radius"]
        mach = np.broadcast_to(np.hypot(tip_speed, airspeed) / quantities["speed_of_sound"], (points,))
        for place in np.flatnonzero((reason == "") & (mach >= 1)):
            reason[place] = f"tip Mach number {mach[place]:.3f}: Prandtl-Glauert needs it below 1"
    return reason


def not_found(target: Target) -> str:
    """Return the reason of a point for which no trim with its target was found."""
    if not target.finds_collective:
        return "no trim found: Newton did not converge"
    if target.row == THRUST:
        return "no trim with this thrust coefficient found: Newton did not converge"
    name = "windmilling trim" if target.windmilling else "trim with this power coefficient"
    return (
        f"no {name} found: the torque has no such value near zero angle of attack, or Newton did not converge"
    )


def path_ended(path: Path) -> Array:
    """Return why the path of each point (n,) ended before all of the loads; empty for points that arrived."""
    reason = np.full(len(path.share), "", dtype=object)
    for place in np.flatnonzero(~path.arrived):
        at = f"at {np.floor(1000 * path.share[place]) / 10:.1f} % of airloads and precone's load"
        ended = f"turns back {at}: no trim belongs to it" if path.turned[place] else f"was lost {at}"
        reason[place] = f"the path from the undeflected blade {ended}"
        if not path.rigid[place]:
            reason[place] = not_found(path.balance.target)
    return reason


def beyond_reach(balance: Balance, state: State, reason: Array) -> Array:
    """Return the reasons after points have failed whose trim is on another branch or has an angle beyond 90 deg."""
    reason = reason.copy()
    if balance.target.finds_collective:
        turned = np.abs(np.real(state["collective"]) - balance.air_direction(len(reason)))
        reason[(reason == "") & ~(turned < FARTHEST)] = not_found(balance.target)
    for name in _ANGLES:
        far = ~(np.abs(state[name]) < np.pi / 2)
        reason[(reason == "") & far] = f"trim {name.replace('_', ' ')} beyond 90 deg"
    return reason


def warnings(balance: Balance, here: Linear, thrust: Array, doubts: Mapping[str, Array]) -> Array:
    """Return what makes each point (n,) doubtful, empty where nothing does.

    A point is doubtful by neglected induced velocity, by blades that diverge or are deflected far, by frequencies that
    take a negative spring, and by sections outside the range of the airfoil.
    """
    points = len(thrust)
    airspeed, density, radius = (np.real(here.quantities[name]) for name in ("airspeed", "density", "radius"))
    thrust = np.abs(np.real(thrust))
    disk = 2 * density * np.pi * radius**2 * airspeed**2
    share = np.broadcast_to(thrust / np.where(disk > 0, disk, np.inf), (points,))
    still = np.broadcast_to((airspeed == 0) & (density > 0), (points,)) & (thrust > 0)
    if balance.options.has_inflow:  # nothing is neglected
        still, share = np.zeros(points, dtype=bool), np.zeros(points)
    masks = {
        "without airspeed the neglected induced velocity is all the inflow": still,
        **_doubtful_blades(balance, here),
        **_negative_springs(balance, here),
        **doubts,
    }
    induced = share > INDUCED_SHARE
    found = np.full(points, "", dtype=object)
    for place in np.flatnonzero(np.logical_or.reduce([induced, *masks.values()])):
        notes = [text for text, mask in masks.items() if mask[place]]
        if induced[place]:
            notes.insert(0, f"induced velocity, neglected, would be {share[place]:.0%} of the airspeed")
        found[place] = "; ".join(notes)
    return found


def _doubtful_blades(balance: Balance, here: Linear) -> dict[str, Array]:
    """Return where blades diverge or are deflected farther than rigid hinges can represent, masks (n,) by warning."""
    hinged = np.flatnonzero(balance.hinged)
    stiffness = np.real(here.slopes.full)[:, hinged][:, :, hinged]
    text = "the rotor diverges: its blades' stiffness with airloads has a negative real eigenvalue"
    found = {text: _diverges(stiffness)}
    for name in _ANGLES:
        angle = np.broadcast_to(np.abs(np.real(here.quantities[name])), len(stiffness))
        limit = f"{np.degrees(LARGEST_ANGLE):.0f} deg"
        text = f"{name.replace('_', ' ')} beyond {limit}, where rigid hinges are no model"
        found[text] = angle > LARGEST_ANGLE
    return found


def _negative_springs(balance: Balance, here: Linear) -> dict[str, Array]:
    """Return where given frequencies are below those of centrifugal force alone, masks (n,) by warning."""
    options, n = balance.options, len(here.residual)
    if options.frequencies is None:
        return {}
    flap, lag, excess = (np.real(here.quantities[name]) for name in _GIVEN_SPRINGS)
    springs = {"flap": {"flap": flap, "cyclic flap": flap + excess}, "lag": {"lag": lag}}
    kept = {
        name: k for hinge, own in springs.items() if hinge not in options.locked for name, k in own.items()
    }
    text = "the given {} frequency is below that of centrifugal force alone, so its spring is negative"
    return {text.format(name): np.broadcast_to(spring < 0, (n,)) for name, spring in kept.items()}


def _diverges(stiffness: Array) -> Array:
    """Return which matrices (n, k, k) have a real eigenvalue below zero by more than its error.

    A matrix (k up to 3) whose sums of principal minors are all positive has none; the eigenvalues of the other matrices
    are computed. The error is the error of the entries, each with the relative error of the quadrature, times the
    condition of the eigenvalue.
    """
    k = stiffness.shape[-1]
    found = np.zeros(len(stiffness), dtype=bool)
    trace = np.trace(stiffness, axis1=1, axis2=2)
    minors = (trace**2 - (stiffness * stiffness.swapaxes(1, 2)).sum(axis=(1, 2))) / 2
    sums = [trace, minors, np.linalg.det(stiffness)][:k]  # the last of the k sums is the determinant
    suspect = np.flatnonzero(~np.logical_and.reduce([part > 0 for part in sums]))
    if not k or not len(suspect):
        return found
    matrix = stiffness[suspect]
    values, right = np.linalg.eig(matrix)
    left = solve(right, np.broadcast_to(np.eye(k), right.shape))
    error = _QUADRATURE * np.einsum("nij,njk,nki->ni", np.abs(left), np.abs(matrix), np.abs(right))
    real = np.abs(values.imag) <= error
    found[suspect] = (real & (values.real < -error)).any(axis=-1)
    return found
