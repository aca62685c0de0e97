"""Scaling laws: what a wind-tunnel model must have in common with the aircraft, and what it may not.

A model has its lengths times λ, its masses times μ and its times times τ, all three at will. Then moments are times
μλ²/τ², dampers μλ²/τ, speeds λ/τ, the air's density μ/λ³; angles, N and what has no dimension stay. The laws:

    in general      s τ, and so s/Ω, of every mode stays, if the speed of sound is times λ/τ too
    Mach scaling    τ = λ: speeds stay, and the speed of sound, as in the same air; Ω is times 1/λ
    Froude scaling  τ = √λ: speeds times √λ. Nothing here weighs anything, so that τ is as free as elsewhere; but the
                    speed of sound ought to be times √λ, and in the same air is not: s/Ω stays without
                    compressibility alone

The density is scaled with μ = δλ³ by whatever δ the air of the tunnel is denser. Another law: N blades, each 3/N times
as heavy, as stiff, as damped and as broad, are the same rotor for every N, if c_m is N/3 times as large: the moment of
a section goes with the square of its chord. The damping of turning sections goes with its square and cube, and is out.

`test_invariants.test_units_do_not_matter` has the case of powers of two on a rotor alone, bit for bit; here λ, δ and
τ are any numbers, the rotor is on a support, and modes are compared.

Tolerance: 1e-12 of each entry, or of what inertia at 1/rev would put there, √(M_ii M_jj) Ω^k; for roots 1e-10 of |s| or
Ω, whichever is larger, or what rounding in M⁻¹K does to a root that is so ill conditioned that this is more.
"""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st
from scipy.linalg import eig
from scipy.optimize import linear_sum_assignment

import proprotor as pp
from proprotor.deck.file import read_tables
from proprotor.model.first_order import held_coordinates, state_matrix
from tests.fuzz.decks import written
from tests.rotors import DAMPERS, HUB, between, flights, random_support, seeds

TOLERANCE = 1e-10
ENTRIES = 1e-12
any_rotor = settings(max_examples=15, derandomize=True, deadline=None, phases=[Phase.generate])

LENGTHS = ("radius", "root_cutout", "flap_hinge_offset", "lag_hinge_offset")
INERTIAS = ("blade_inertia", "flap_inertia", "lag_inertia", "pitch_inertia")
FIRST_MOMENTS = ("blade_first_moment", "flap_first_moment", "lag_first_moment")
SPRINGS = (
    "flap_stiffness",
    "lag_stiffness",
    "gimbal_stiffness",
    "control_stiffness",
    "cyclic_control_stiffness",
)
OF_ONE_BLADE = (
    "blade_mass",
    *FIRST_MOMENTS,
    *INERTIAS,
    "flap_stiffness",
    "lag_stiffness",
    "control_stiffness",
    "cyclic_control_stiffness",
)
OF_ONE_BLADE += ("flap_damping", "lag_damping", "pitch_damping")


# Models -------------------------------------------------------------------------------------------


def beside_axis(rotor, mass, length):
    """Integrals of masses that are times as heavy, at places that are times as far from the pitch axis."""
    if rotor.offset_mass is None:
        return {}
    powers = {name: 1 if name.endswith("moment") else 2 for name in vars(rotor.offset_mass)}
    numbers = {name: mass * length ** powers[name] * value for name, value in vars(rotor.offset_mass).items()}
    given = rotor.propeller_inertia
    return {
        "offset_mass": pp.OffsetMass(**numbers),
        "propeller_inertia": None if given is None else mass * length**2 * given,
    }


def times(value, factor):
    """A number times a factor; None, for a stiffness that is none of its own, stays."""
    return None if value is None else value * factor


class Model:
    """What the lengths, masses and times of a model are times those of the aircraft."""

    def __init__(self, length, mass, time):
        self.length, self.mass, self.time = length, mass, time
        self.moment = mass * length**2 / time**2
        self.speed = length / time

    def rotor(self, rotor):
        factors = {
            **dict.fromkeys(LENGTHS, self.length),
            "blade_mass": self.mass,
            **dict.fromkeys(FIRST_MOMENTS, self.mass * self.length),
            **dict.fromkeys(INERTIAS, self.mass * self.length**2),
            **dict.fromkeys(SPRINGS, self.moment),
            **dict.fromkeys(DAMPERS, self.moment * self.time),
        }
        scaled = {name: times(getattr(rotor, name), factor) for name, factor in factors.items()}
        scaled |= beside_axis(rotor, self.mass, self.length)
        units = {"chord": self.length, "twist": 1.0, "aerodynamic_center": self.length}
        along = {name: self._along(getattr(rotor, name), unit) for name, unit in units.items()}
        return replace(rotor, **scaled, **along)

    def _along(self, distribution, factor):
        if isinstance(distribution, tuple):
            return distribution[0] * self.length, distribution[1] * factor
        return distribution * factor

    def operation(self, operation, same_air):
        return replace(
            operation,
            rotor_speed=operation.rotor_speed / self.time,
            density=operation.density * self.mass / self.length**3,
            speed_of_sound=operation.speed_of_sound * (1.0 if same_air else self.speed),
        )

    def support(self, support):
        """Of coordinates that are the hub's."""
        lever = np.array([1.0] * 3 + [self.length] * 3)
        unit = self.mass * np.outer(lever, lever)
        return replace(
            support,
            mass=support.mass * unit,
            damping=support.damping * unit / self.time,
            stiffness=support.stiffness * unit / self.time**2,
        )


def on_support(flight, support, **options):
    case = pp.Case("random", flight.rotor_for(options), flight.operation, support)
    return case.linearize(flight.airspeed, **options)


def roots(model, rotor_speed):
    """Eigenvalues per rotor speed, and by how much rounding alone may move each."""
    a = state_matrix(model) / rotor_speed
    size = np.sqrt(
        np.diag(model.M)
    )  # coordinates in units of energy: what rounding does must not depend on units
    scale = np.concatenate([size[held_coordinates(model)] * rotor_speed, size])
    a = a * scale[:, None] / scale
    values, left, right = eig(a, left=True)
    condition = 1 / np.abs(np.sum(left.conj() * right, axis=0))
    of_mass = np.linalg.cond(model.M / np.outer(size, size))
    return values, np.finfo(float).eps * of_mass * condition * np.linalg.norm(a, 2)


def assert_same_modes(one, other, rotor_speeds):
    (was, rounding), (now, _) = (roots(m, speed) for m, speed in zip((one, other), rotor_speeds, strict=True))
    rows, columns = linear_sum_assignment(np.abs(was[:, None] - now))
    allowed = np.maximum(TOLERANCE * np.maximum(np.abs(was), 1.0), rounding)
    error = np.abs(was[rows] - now[columns])
    assert (error <= allowed[rows]).all(), f"{(error / allowed[rows]).max():.1e} of what is allowed"


def assert_same_entries(one, other, unit, rotor_speeds):
    """Matrices, those of the model by their unit."""
    size = np.sqrt(np.diag(one.M))
    for power, name in enumerate("MCK"):
        scale = np.outer(size, size) * rotor_speeds[0] ** power
        expected = getattr(one, name)
        found = getattr(other, name) / unit / (rotor_speeds[1] / rotor_speeds[0]) ** power
        allowed = ENTRIES * np.maximum(scale, np.abs(expected))
        np.testing.assert_array_less(np.abs(found - expected), allowed, name)


def assert_scaled(flight, seed, model, same_air, **options):
    """The aircraft and its model have the same entries and the same modes."""
    support = random_support(flight, seed)
    small = replace(
        flight,
        rotor=model.rotor(flight.rotor),
        operation=model.operation(flight.operation, same_air),
        airspeed=flight.airspeed * model.speed,
    )
    pair = on_support(flight, support, **options), on_support(small, model.support(support), **options)
    assume(pair[0].trim.converged)
    assert pair[1].trim.converged
    lever = np.array([1.0 if name in HUB[:3] else model.length for name in pair[0].dofs])
    rotor_speeds = flight.rotor_speed, small.rotor_speed
    assert_same_entries(*pair, model.mass * np.outer(lever, lever), rotor_speeds)
    assert_same_modes(*pair, rotor_speeds)


scales = between(0.08, 1.6)
densities = between(0.3, 4.0)


@any_rotor
@given(
    flights(hinges="off centre"),
    seeds,
    scales,
    densities,
    between(0.1, 3.0),
    st.sampled_from(["dynamic", "coupling"]),
)
def test_any_length_mass_and_time(flight, seed, length, denser, time, pitch):
    model = Model(length, denser * length**3, time)
    assert_scaled(flight, seed, model, same_air=False, pitch=pitch)


@any_rotor
@given(flights(hinges="off centre"), seeds, scales, densities)
def test_a_mach_scaled_model_has_the_modes_of_the_aircraft(flight, seed, length, denser):
    model = Model(length, denser * length**3, length)
    assert_scaled(flight, seed, model, same_air=True)


@any_rotor
@given(flights(hinges="off centre"), seeds, scales, densities)
def test_a_froude_scaled_model_has_them_where_the_air_does_not_compress(flight, seed, length, denser):
    model = Model(length, denser * length**3, np.sqrt(length))
    assert_scaled(flight, seed, model, same_air=True, compressibility=False)


def test_a_froude_scaled_model_has_other_modes_in_air_that_compresses():
    """The XV-15 at a fifth of its size: the test above could not tell if it left compressibility out by itself."""
    case, model = pp.load_case("xv15-uncoupled"), Model(0.2, 0.2**3, np.sqrt(0.2))
    rotor, operation = model.rotor(case.rotor), model.operation(case.operation, same_air=True)
    rigid = {"airspeed": 130.0}
    full = pp.rotor_model(case.rotor, case.operation, rigid["airspeed"], pitch="coupling")
    small = pp.rotor_model(rotor, operation, rigid["airspeed"] * model.speed, pitch="coupling")
    places = [full.dofs.index(name) for name in ("flap_0", "flap_1c", "flap_1s", "lag_0", "lag_1c", "lag_1s")]
    damping = [
        m.C[np.ix_(places, places)] / np.outer(*2 * [np.sqrt(np.diag(m.M)[places])]) for m in (full, small)
    ]
    change = np.abs(damping[0] / case.operation.rotor_speed - damping[1] / operation.rotor_speed).max()
    assert change > 0.01


@any_rotor
@given(flights(hinges="off centre"), seeds, st.integers(3, 7), st.sampled_from(["full", "none"]))
def test_more_blades_that_are_lighter_and_narrower_are_the_same_rotor(flight, seed, n_blades, airloads):
    """What sums over the blades leave of them: N/2 of a blade, and N."""
    support = random_support(flight, seed)
    share = flight.rotor.n_blades / n_blades
    chord = flight.rotor.chord
    chord = (chord[0], chord[1] * share) if isinstance(chord, tuple) else chord * share
    fields = {name: times(getattr(flight.rotor, name), share) for name in OF_ONE_BLADE}
    fields |= beside_axis(flight.rotor, share, 1.0)
    airfoil = replace(flight.rotor.airfoil, moment=flight.rotor.airfoil.moment / share)
    other = flight.with_rotor(n_blades=n_blades, chord=chord, airfoil=airfoil, **fields)
    options = {"airloads": airloads, "section_damping": False}
    one, two = (on_support(it, support, **options) for it in (flight, other))
    assume(one.trim.converged)
    assert two.trim.converged
    assert_same_entries(one, two, 1.0, 2 * [flight.rotor_speed])
    assert_same_modes(one, two, 2 * [flight.rotor_speed])


# Units of decks -----------------------------------------------------------------------------------

# Exact by definition: the international foot and pound, standard gravity.
TO_SI = {
    "m": ("ft", 0.3048),
    "kg": ("lb", 0.45359237),
    "N": ("lbf", 0.45359237 * 9.80665),
    "rad": ("deg", np.pi / 180),
}
TO_SI |= {"s": ("min", 60.0)}
AIRSPEED = 110.0


def in_us_units(value, unit):
    """A number of SI, and its SI unit, in feet, pounds, pounds of force, degrees and minutes."""
    words = []
    for sign, part in ((1, unit.partition("/")[0]), (-1, unit.partition("/")[2])):
        for word in filter(None, part.replace("1", "").split("*")) if "**" not in part else _powers(part):
            name, _, power = word.partition("^")
            other, factor = TO_SI[name]
            value = value / factor ** (sign * int(power or 1))
            words.append((sign, other + (f"**{power}" if power else "")))
    over = "*".join(word for sign, word in words if sign > 0) or "1"
    under = "".join(f"/{word}" for sign, word in words if sign < 0)
    return value, over + under


def _powers(part):
    return part.replace("**", "^").split("*")


def in_si_units(value, unit):
    return value, unit


def rewritten(tables, numbers, units, path=""):
    """The tables of a deck with every number that has a unit in other units."""
    for key, entry in tables.items():
        here = f"{path}.{key}" if path else key
        if here in numbers:
            tables[key] = _in_units(numbers[here], units)
        elif isinstance(entry, dict):
            rewritten(entry, numbers, units, here)
        elif key == "modes" and isinstance(entry, list):
            for mode in entry:
                rewritten(mode, numbers, units, f"{here}[{mode['name']}]")
    return tables


def _in_units(datum, units):
    if datum.r_over_R is not None:
        values, unit = units(np.array(datum.si), datum.unit)
        stations = "y_over_span" if datum.unit in ("N*m**2", "N", "kg*m**2/m") else "r_over_R"
        return {stations: list(datum.r_over_R), "value": np.asarray(values).tolist(), "unit": unit}
    if isinstance(datum.si, tuple):  # a table of blade frequencies, or its abscissae
        values, unit = units(np.array(datum.si), datum.unit)
        return {"value": values.tolist()} | ({"unit": unit} if datum.unit else {})
    if not datum.unit or isinstance(datum.si, str):
        return datum.si
    value, unit = units(datum.si, datum.unit)
    return f"{float(value)!r} {unit}"


@pytest.mark.parametrize("units", [in_si_units, in_us_units])
@pytest.mark.parametrize("name", pp.list_cases())
def test_a_deck_in_other_units_is_the_same_aircraft(tmp_path, name, units):
    case = pp.load_case(name)
    text = written(rewritten(read_tables(name), case.given, units))
    path = tmp_path / "deck.toml"
    path.write_text(text, encoding="utf-8")
    other = pp.load_case(path)
    assert other.given.keys() == case.given.keys()
    assert other.given["rotor.radius"].written.endswith(" ft" if units is in_us_units else " m")
    one, two = case.linearize(AIRSPEED), other.linearize(AIRSPEED)
    # A coordinate that nothing holds, such as the heave of an aircraft, has the size of its mass at rotor speed.
    mass, stiffness = np.abs(np.diag(one.M)), np.abs(np.diag(one.K))
    # Elements of 14 in are 1e4 times as stiff as the lowest mode of the aircraft, which therefore loses four digits;
    # so does the lowest mode of a wing whose stiffness is fitted to the mode's frequency.
    by_modes = case.deck.support.kind == "aircraft" or "support.beam_frequency" in case.given
    rounding = 1e-11 if by_modes else 1e-12
    sizes = {"M": mass, "K": np.where(stiffness > 0, stiffness, case.operation.rotor_speed**2 * mass)}
    for part in "MCK":
        expected = getattr(one, part)
        size = np.sqrt(sizes[part]) if part in sizes else None
        scale = np.abs(expected).max() if size is None else np.maximum(np.outer(size, size), np.abs(expected))
        np.testing.assert_array_less(np.abs(getattr(two, part) - expected), rounding * scale + 1e-300, part)
