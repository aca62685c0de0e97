"""The path from the undeflected blade to the trim, followed in small steps of its length, many rotors at once.

Written from the geometry of one blade: point masses, springs in series, sections in the air by plain quadrature, and
slopes by differences. A share λ multiplies precone, and the airloads in flap, lag and pitch. The path's own length is
the parameter, so that a path that turns back is followed around its turn and seen to do so.
"""

from dataclasses import dataclass, fields, replace

import numpy as np

FLAP, LAG, PITCH, COLLECTIVE = range(4)
CLOSING = ("collective", "thrust", "torque")
_POINTS, _PANELS = 9, 4  # of each panel; panels outboard of the lag hinge
_DIFFERENCE = 1e-6  # rad
_LONGEST, _SHORTEST = 0.01, 1e-9  # steps of the path's length, rad and share together
_BEND = np.cos(0.1)  # the path's direction may turn by so much in a step
_CORRECTIONS = 8


@dataclass(frozen=True)
class Blades:
    """One blade of each of n rotors in flight; arrays (n,), station and mass (n, s), in SI units.

    `closing` is what closes the trim: "collective" at a given value, or "thrust" or "torque" of one blade.
    """

    closing: str
    closed_at: np.ndarray
    rotor_speed: np.ndarray
    airspeed: np.ndarray
    density: np.ndarray
    speed_of_sound: np.ndarray
    radius: np.ndarray
    root_cutout: np.ndarray
    flap_hinge_offset: np.ndarray
    lag_hinge_offset: np.ndarray
    precone: np.ndarray
    station: np.ndarray
    mass: np.ndarray
    flap_stiffness: np.ndarray
    lag_stiffness: np.ndarray
    flap_outboard_fraction: np.ndarray
    lag_outboard_fraction: np.ndarray
    structural_pitch_offset: np.ndarray
    control_stiffness: np.ndarray
    pitch_inertia: np.ndarray
    chord: np.ndarray
    twist: np.ndarray
    lift_slope: np.ndarray
    zero_lift_angle: np.ndarray
    drag: np.ndarray
    moment: np.ndarray

    def of(self, rows):
        """Some of the rotors."""
        arrays = {f.name: getattr(self, f.name)[rows] for f in fields(self) if f.name != "closing"}
        return replace(self, **arrays)


def arms(blades, r):
    """ρβ and ρζ of radii (n, s)."""
    return (
        np.maximum(r - hinge[:, None], 0) for hinge in (blades.flap_hinge_offset, blades.lag_hinge_offset)
    )


def inertia(blades, state):
    """Flap and lag moments (n, 2) of the centrifugal force, on the left of the balance."""
    coning, lag = (state[:, place, None] for place in (FLAP, LAG))
    flap_arm, lag_arm = arms(blades, blades.station)
    root, cone = blades.precone[:, None], blades.precone[:, None] + coning
    outboard = flap_arm + lag_arm * (np.cos(lag) - 1)
    out = (blades.station - flap_arm) * np.cos(root) + outboard * np.cos(cone)
    aft = lag_arm * np.sin(lag)
    by_flap = out * -outboard * np.sin(cone)
    by_lag = out * -lag_arm * np.sin(lag) * np.cos(cone) + aft * lag_arm * np.cos(lag)
    pull = -blades.mass * blades.rotor_speed[:, None] ** 2
    return np.stack([(pull * by_flap).sum(1), (pull * by_lag).sum(1)], axis=1)


def springs(blades, state):
    """Flap, lag and pitch moments (n, 3) of hinge springs, control system and propeller moment."""
    turn = state[:, PITCH] + state[:, COLLECTIVE] + blades.structural_pitch_offset
    inboard = [
        (1 - getattr(blades, f"{n}_outboard_fraction")) / getattr(blades, f"{n}_stiffness")
        for n in ("flap", "lag")
    ]
    flat, edge = (
        getattr(blades, f"{n}_outboard_fraction") / getattr(blades, f"{n}_stiffness") for n in ("flap", "lag")
    )
    c, s = np.cos(turn), np.sin(turn)
    flap_flap, lag_lag = inboard[0] + flat * c**2 + edge * s**2, inboard[1] + flat * s**2 + edge * c**2
    flap_lag = (flat - edge) * s * c
    determinant = flap_flap * lag_lag - flap_lag**2
    coning, lag = state[:, FLAP], state[:, LAG]
    flap_moment = (lag_lag * coning - flap_lag * lag) / determinant
    lag_moment = (flap_flap * lag - flap_lag * coning) / determinant
    # The energy ½ mᵀ F m of moments m falls as the flexibility F grows.
    growth = (flat - edge) * (
        np.sin(2 * turn) * (lag_moment**2 - flap_moment**2) / 2 + np.cos(2 * turn) * flap_moment * lag_moment
    )
    pitch = state[:, PITCH] + state[:, COLLECTIVE]
    propeller = blades.pitch_inertia * blades.rotor_speed**2 * np.sin(pitch) * np.cos(pitch)
    return np.stack(
        [flap_moment, lag_moment, blades.control_stiffness * state[:, PITCH] + propeller - growth], axis=1
    )


def sections(blades):
    """Stations and weights (n, s) of panels from cutout to tip, with corners at the hinges."""
    root, tip = blades.root_cutout, blades.radius
    first, second = (np.maximum(root, hinge) for hinge in (blades.flap_hinge_offset, blades.lag_hinge_offset))
    shares = np.linspace(0, 1, _PANELS + 1) ** 1.5
    edges = np.concatenate(
        [np.stack([root, first], 1), second[:, None] + (tip - second)[:, None] * shares], axis=1
    )
    node, weight = np.polynomial.legendre.leggauss(_POINTS)
    half, start = np.diff(edges, axis=1)[..., None] / 2, edges[:, :-1, None]
    n = len(root)
    return (start + half * (1 + node)).reshape(n, -1), (half * weight).reshape(n, -1)


def airloads(blades, state, r, weight):
    """Work (n, 5) of the airloads of one blade in flap, lag, pitch, azimuth, and along the shaft."""
    b = {
        f.name: getattr(blades, f.name)[..., None]
        for f in fields(blades)
        if f.name not in ("closing", "station", "mass")
    }
    coning, lag, elastic, collective = (state[:, place, None] for place in range(4))
    flap_arm, lag_arm = arms(blades, r)
    flapped, lagged = r > b["flap_hinge_offset"], r > b["lag_hinge_offset"]
    cone, angle = b["precone"] + coning * flapped, lag * lagged
    sc, cc, sl, cl = np.sin(cone), np.cos(cone), np.sin(angle), np.cos(angle)
    full, root = b["precone"] + coning, b["precone"]
    outboard = flap_arm + lag_arm * (np.cos(lag) - 1)
    aft = lag_arm * np.sin(lag)
    out = (r - flap_arm) * np.cos(root) + outboard * np.cos(full)
    omega = b["rotor_speed"]
    vi, vj, vk = -omega * out, omega * aft, b["airspeed"]
    tangential = -(vi * cl - vj * sl * cc - vk * sl * sc)
    axial = -vj * sc + vk * cc
    radial = vi * sl + vj * cl * cc + vk * cl * sc
    speed = np.hypot(tangential, axial)
    mach = speed / b["speed_of_sound"]
    factor = 1 / np.sqrt(1 - mach**2)
    twist = b["twist"] * (r / b["radius"] - 0.75)
    attack = collective + elastic + twist - np.arctan2(axial, tangential)
    dynamic = b["density"] * b["chord"] * speed * weight / 2
    lift = dynamic * b["lift_slope"] * factor * (attack - b["zero_lift_angle"])
    drag = dynamic * b["drag"]
    moment = dynamic * speed * b["chord"] * b["moment"] * factor
    # Over the speed: sin φ = axial/speed, cos φ = tangential/speed.
    along = lift * axial + drag * tangential
    normal = lift * tangential - drag * axial
    spanwise = -drag * radial
    fi = along * cl + spanwise * sl
    fj = -along * sl * cc - normal * sc + spanwise * cl * cc
    fk = -along * sl * sc + normal * cc + spanwise * cl * sc
    flap = outboard * (-fj * np.sin(full) + fk * np.cos(full)) * flapped + moment * sl * flapped
    works = (flap, lag_arm * along, moment, fj * aft - fi * out + moment * cl * sc, fk)
    return np.stack([work.sum(1) for work in works], axis=1)


def balance(blades, state, share, grid):
    """Flap, lag and pitch at a share (n,) of the loads, and what closes the trim with all of them: (n, 4)."""
    blades = replace(blades, precone=share * blades.precone)
    left, work = np.zeros((len(state), 4)), airloads(blades, state, *grid)
    left[:, :3] = springs(blades, state) - share[:, None] * work[:, :3]
    left[:, :2] += inertia(blades, state)
    closed = {"collective": state[:, COLLECTIVE], "torque": work[:, 3], "thrust": work[:, 4]}[blades.closing]
    left[:, COLLECTIVE] = closed - blades.closed_at
    return left


def scales(blades):
    """Size (n, 4) of each row, so that residuals are of the order of angles."""
    size = (blades.mass * blades.station**2).sum(1) * blades.rotor_speed**2
    pitch = blades.control_stiffness + blades.pitch_inertia * blades.rotor_speed**2
    closing = np.ones_like(size)
    if blades.closing != "collective":
        closing = blades.density * blades.radius**3 * blades.chord * (blades.rotor_speed * blades.radius) ** 2
        closing = closing / (blades.radius if blades.closing == "thrust" else 1.0)
    return np.stack([size, size, pitch, closing], axis=1)


def linear(blades, state, share, grid):
    """Residual (n, 4), its slopes (n, 4, 4) by differences, and its change with the share (n, 4), all made small."""
    size = scales(blades)
    here = balance(blades, state, share, grid) / size
    slopes = np.empty((len(state), 4, 5))
    for column in range(5):
        moved = np.column_stack([state, share])
        moved[:, column] += _DIFFERENCE
        slopes[:, :, column] = (balance(blades, moved[:, :4], moved[:, 4], grid) / size - here) / _DIFFERENCE
    return here, slopes[..., :4], slopes[..., 4]


def rigid_start(blades, grid):
    """State (n, 4) without loads: a rigid blade, whose torque or thrust is linear in its pitch, and control system."""
    state = np.zeros((len(blades.radius), 4))
    pitch = np.arctan2(blades.airspeed, 0.75 * blades.rotor_speed * blades.radius)
    moment = blades.pitch_inertia * blades.rotor_speed**2
    if blades.closing == "collective":
        low, high = np.pi * np.round(blades.closed_at / np.pi), blades.closed_at.copy()
        for _ in range(200):
            pitch = (low + high) / 2
            left = blades.control_stiffness * (pitch - blades.closed_at) + moment * np.sin(2 * pitch) / 2
            upper = left * np.sign(blades.closed_at) > 0
            low, high = np.where(upper, low, pitch), np.where(upper, pitch, high)
        state[:, COLLECTIVE], state[:, PITCH] = blades.closed_at, pitch - blades.closed_at
        return state
    for _ in range(3):
        values = []
        for more in (0.0, 1.0):
            state[:, COLLECTIVE] = pitch + more
            values.append(balance(blades, state, np.zeros(len(state)), grid)[:, COLLECTIVE])
        pitch = pitch - values[0] / (values[1] - values[0])
    state[:, PITCH] = -moment * np.sin(2 * pitch) / 2 / blades.control_stiffness
    state[:, COLLECTIVE] = pitch - state[:, PITCH]
    return state


def bordered(slopes, by_share, last):
    """Slopes of state and share together, (n, 5, 5), with a last row."""
    whole = np.zeros((len(slopes), 5, 5))
    whole[:, :4, :4], whole[:, :4, 4], whole[:, 4] = slopes, by_share, last
    return whole


def direction(slopes, by_share, last):
    """Unit direction (n, 5) of the path, the way the last one went."""
    right = np.zeros((len(slopes), 5, 1))
    right[:, 4] = 1
    found = np.linalg.solve(bordered(slopes, by_share, last), right)[..., 0]
    return found / np.linalg.norm(found, axis=1, keepdims=True)


def newton(blades, state, share, grid, steps=12):
    """State of equilibrium at a share, and whether Newton came to it."""
    size = np.full(len(state), np.inf)
    for _ in range(steps):
        here, slopes, _ = linear(blades, state, share, grid)
        step = np.linalg.solve(slopes, here[..., None])[..., 0]
        state = state - step
        size = np.abs(step).max(axis=1)
    return state, size < 1e-10


@dataclass
class Ends:
    """Where the paths end: state (n, 4), share reached (n,), and whether the path came to all loads or turned back."""

    state: np.ndarray
    share: np.ndarray
    arrived: np.ndarray
    turned: np.ndarray


def follow(blades, steps=4000, longest=_LONGEST):
    """Follow the path of each rotor to all of its loads, or to where it turns back."""
    n, grid = len(blades.radius), sections(blades)
    state = rigid_start(blades, grid)
    ends = Ends(state, np.zeros(n), np.zeros(n, bool), np.zeros(n, bool))
    way = np.zeros((n, 5))
    way[:, 4] = 1
    _, slopes, by_share = linear(blades, state, ends.share, grid)
    way = direction(slopes, by_share, way)
    length = np.full(n, longest)
    active = np.flatnonzero(np.isfinite(state).all(axis=1))
    for _ in range(steps):
        if not len(active):
            break
        some, at = blades.of(active), (grid[0][active], grid[1][active])
        start = np.column_stack([ends.state[active], ends.share[active]])
        here, good = corrected(some, start, way[active], length[active], at)
        _, slopes, by_share = linear(some, here[:, :4], here[:, 4], at)
        ahead = np.zeros_like(here)
        good &= np.isfinite(slopes).all(axis=(1, 2)) & np.isfinite(by_share).all(axis=1)
        ahead[good] = direction(slopes[good], by_share[good], way[active[good]])
        good &= (ahead * way[active]).sum(1) > _BEND
        took = active[good]
        before = ends.state[took], ends.share[took]
        ends.state[took], ends.share[took], way[took] = here[good, :4], here[good, 4], ahead[good]
        length[active] = np.where(good, np.minimum(1.5 * length[active], longest), length[active] / 2)
        ends.turned[took] = (way[took, 4] < 0) & (ends.share[took] < 1)
        over = took[ends.share[took] >= 1]
        if len(over):
            place = np.isin(took, over)
            part = ((1 - before[1][place]) / (ends.share[over] - before[1][place]))[:, None]
            guess = before[0][place] + part * (ends.state[over] - before[0][place])
            there, well = newton(blades.of(over), guess, np.ones(len(over)), (grid[0][over], grid[1][over]))
            ends.state[over], ends.arrived[over] = there, well & (np.abs(there - guess).max(1) < 10 * longest)
        active = active[(ends.share[active] < 1) & ~ends.turned[active] & (length[active] > _SHORTEST)]
    return ends


def corrected(blades, start, way, length, grid):
    """States and shares (n, 5) a step further on the path, and whether Newton came to them from the step's end."""
    guess = start + length[:, None] * way
    here, size = guess.copy(), np.full(len(start), np.inf)
    for _ in range(_CORRECTIONS):
        left, slopes, by_share = linear(blades, here[:, :4], here[:, 4], grid)
        along = ((here - guess) * way).sum(1)
        right = np.column_stack([left, along])
        fit = np.isfinite(right).all(1) & np.isfinite(slopes).all((1, 2))
        step = np.full_like(here, np.nan)
        step[fit] = np.linalg.solve(bordered(slopes[fit], by_share[fit], way[fit]), right[fit, :, None])[
            ..., 0
        ]
        here = here - step
        size = np.abs(step).max(1)
        if not (size > 1e-9).any():
            break
    good = (size < 1e-8) & (np.abs(here - guess).max(1) < length)
    return here, good
