"""Decks of random rotors on random supports: any units, any number of designs and airspeeds at once, no jumps.

`test_scaling`, `test_design` and `test_limits` ask the same of the bundled decks, input by input; here decks are made
up, for what their numbers happen not to meet.
"""

import numpy as np
from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st

import proprotor as pp
from tests.fuzz.decks import written
from tests.rotor.test_limits import ROUNDING, TOGETHER
from tests.rotor.test_scaling import assert_same_entries, in_si_units, in_us_units
from tests.rotors import DAMPERS, between, flights

any_deck = settings(
    max_examples=12,
    derandomize=True,
    deadline=None,
    phases=[Phase.generate],
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
UNITS = {
    "n_blades": "",
    **dict.fromkeys(("radius", "root_cutout", "flap_hinge_offset", "lag_hinge_offset", "chord"), "m"),
    **dict.fromkeys(("precone", "structural_pitch_offset", "twist"), "rad"),
    "blade_mass": "kg",
    **dict.fromkeys(("blade_first_moment", "flap_first_moment", "lag_first_moment"), "kg*m"),
    **dict.fromkeys(("blade_inertia", "flap_inertia", "lag_inertia", "pitch_inertia"), "kg*m**2"),
    **dict.fromkeys(("flap_stiffness", "lag_stiffness", "gimbal_stiffness", "control_stiffness"), "N*m/rad"),
    **dict.fromkeys(DAMPERS, "N*m*s/rad"),
    **dict.fromkeys(("flap_outboard_fraction", "lag_outboard_fraction", "pitch_gimbal_coupling"), ""),
}
AIRFOIL = {"lift_slope": "1/rad", "zero_lift_angle": "rad", "drag": "", "moment": ""}
OPERATION = {"rotor_speed": "rad/s", "density": "kg/m**3", "speed_of_sound": "m/s"}
HUB = {"x": "", "y": "", "z": "", "alpha_x": "rad/m", "alpha_y": "rad/m", "alpha_z": "rad/m"}
OPTIONS = st.sampled_from(
    [
        {},
        {"pitch": "coupling"},
        {"equations": "published"},
        {"airloads": "lift-slope"},
        {"airloads": "none"},
        {"section_damping": False, "compressibility": False},
    ]
)


@st.composite
def modes(draw, flight):
    """Three to five modes of a support, each of a length that moves the hub along and about every axis."""
    rotor = flight.rotor
    mass = between(0.5, 5.0).map(lambda share: share * rotor.n_blades * rotor.blade_mass)
    along = {name: between(-1.0, 1.0) for name in "xyz"}
    about = {f"alpha_{name}": between(-1.0, 1.0).map(lambda share: share / rotor.radius) for name in "xyz"}
    mode = st.fixed_dictionaries(
        {
            "generalized_mass": mass,
            "frequency": between(0.1, 2.0).map(lambda per_rev: per_rev * flight.rotor_speed),
            "damping_ratio": between(0.0, 0.05),
            **along,
            **about,
        }
    )
    found = draw(st.lists(mode, min_size=3, max_size=5))
    return [{"name": f"mode{number}", **one} for number, one in enumerate(found)]


@st.composite
def flights_on_modes(draw):
    flight = draw(flights(hinges="off centre"))
    return flight, draw(modes(flight))


def deck(flight, support_modes, units):
    """The text of a deck, each number with a unit of a system."""

    def told(value, unit):
        if isinstance(value, tuple):  # a table along the blade
            values, in_unit = units(value[1], unit)
            stations = (value[0] / flight.rotor.radius).tolist()
            return {"r_over_R": stations, "value": np.asarray(values).tolist(), "unit": in_unit}
        if not unit:
            return value
        number, in_unit = units(value, unit)
        return f"{float(number)!r} {in_unit}"

    def fields(of, wanted):
        return {name: told(getattr(of, name), unit) for name, unit in wanted.items()}

    rotor, operation = flight.rotor, flight.operation
    trim = (
        operation.trim
        if isinstance(operation.trim, str)
        else {"collective": told(operation.trim["collective"], "rad")}
    )
    mode_units = {"generalized_mass": "kg", "frequency": "rad/s", "damping_ratio": "", **HUB}
    tables = {
        "case": {"name": "random", "title": "A random rotor"},
        "rotor": fields(rotor, UNITS)
        | {"propeller_moment": rotor.propeller_moment, "airfoil": fields(rotor.airfoil, AIRFOIL)},
        "operation": fields(operation, OPERATION) | {"trim": trim},
        "support": {
            "kind": "normal-modes",
            "includes_rotor": False,
            "modes": [
                {"name": mode["name"], "coordinate": "length"}
                | {name: told(mode[name], unit) for name, unit in mode_units.items()}
                for mode in support_modes
            ],
        },
    }
    return written(tables)


def load(folder, flight, support_modes, units=in_si_units):
    path = folder / "deck.toml"
    path.write_text(deck(flight, support_modes, units), encoding="utf-8")
    return pp.load_case(path)


@any_deck
@given(flights_on_modes(), OPTIONS)
def test_units_of_a_deck_do_not_matter(tmp_path, made, options):
    flight, support_modes = made
    si, us = (load(tmp_path, flight, support_modes, units) for units in (in_si_units, in_us_units))
    assert si.given["rotor.radius"].written.endswith(" m") and us.given["rotor.radius"].written.endswith(
        " ft"
    )
    one, two = (case.linearize(flight.airspeed, **options) for case in (si, us))
    assume(one.trim.converged)
    assert two.trim.converged
    assert_same_entries(one, two, 1.0, 2 * [flight.rotor_speed])


def inputs(case):
    """Numbers of a deck that may be varied alone; integrals of one blade belong together."""
    return {
        path: datum.si
        for path, datum in pp.design_inputs(case).items()
        if not path.endswith((*TOGETHER, "blade_mass", "blade_first_moment")) and datum.si
    }


@any_deck
@given(flights_on_modes(), OPTIONS, st.data())
def test_a_batch_is_its_points_bit_for_bit(tmp_path, made, options, data):
    """Designs that differ in any inputs, rotor and support, at an airspeed each."""
    flight, support_modes = made
    case = load(tmp_path, flight, support_modes)
    numbers = inputs(case)
    paths = data.draw(st.lists(st.sampled_from(sorted(numbers)), min_size=1, max_size=6, unique=True))
    shares = np.array([0.97, 0.99, 0.995, 1.0])
    values = {path: numbers[path] * shares for path in paths}
    airspeeds = flight.airspeed * np.array([1.0, 0.5, 1.1, 0.9])
    batch = case.vary(values).linearize(airspeeds, **options)
    for place in range(len(airspeeds)):
        design = case.vary({path: value[place] for path, value in values.items()})
        one = design.linearize(airspeeds[place : place + 1], **options)
        assert batch.trim.reason[place] == one.trim.reason[0]
        for name in "MCKB":
            assert np.array_equal(getattr(batch, name)[place], getattr(one, name)[0], equal_nan=True), name
        for name in ("collective", "coning", "lag", "elastic_pitch"):
            own = getattr(one.trim, name)[0]
            assert np.array_equal(getattr(batch.trim, name)[place], own, equal_nan=True)


@any_deck
@given(flights_on_modes(), st.data())
def test_no_input_makes_a_jump(tmp_path, made, data):
    """17 steps over a hundredth of an input: none is much larger than the others."""
    flight, support_modes = made
    case = load(tmp_path, flight, support_modes)
    numbers = inputs(case)
    path = data.draw(st.sampled_from(sorted(numbers)))
    shares = 1 - 0.01 * np.linspace(0.003, 1, 18)  # to smaller numbers, where a share of one has neighbours
    model = case.vary({path: numbers[path] * shares}).linearize(flight.airspeed)
    assume(model.trim.converged.all())
    size, speed = np.sqrt(np.diagonal(model.M, axis1=-2, axis2=-1)).max(axis=0), flight.rotor_speed
    parts = [getattr(model, name) / np.outer(size, size) / speed**power for power, name in enumerate("MCK")]
    steps = np.abs(np.diff(np.stack(parts), axis=1)).max(axis=(0, 2, 3))
    assert steps.max() <= 4 * np.median(steps) + ROUNDING, path
