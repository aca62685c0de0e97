"""Tables along the blade that end early: refused, or what follows is said, at each end and by every way in.

Right values come from scipy's quadrature of the line between the stations, written here.
"""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

import proprotor as pp
from proprotor.deck.file import read_tables
from proprotor.errors import InputError
from proprotor.rotor.rotor import MASS_INTEGRALS

FT, SLUG, LB = 0.3048, 14.593902937, 0.45359237
RADIUS = 12.5 * FT
CUTOUT = 1.09375 / 12.5
ROTOR = dict(n_blades=3, radius=4.0, root_cutout=0.4, flap_stiffness=1e4, lag_stiffness=1e5)
ROTOR |= dict(flap_hinge_offset=0.2, lag_hinge_offset=0.5, airfoil=pp.Airfoil(lift_slope=5.7))
COLUMNS = {  # of each the unit, values at the ends, what its table may say and the word for what is refused
    "chord": ("inch", (17.0, 14.0), "held"),
    "twist": ("deg", (30.0, -6.0), "held"),
    "mass_distribution": ("slug/ft", (0.5, 0.15), "nothing"),
}
ENDS = {"root": (0.2, 1.0), "tip": (0.0, 0.9), "both": (0.2, 0.9)}
EARLY = [(column, end) for column in COLUMNS for end in ENDS]


def integral(stations, values, offset, power):
    """∫ m (r - offset)^power outboard of the offset, of the line through the stations."""
    corners = [r for r in stations if offset < r < stations[-1]]
    start = max(offset, stations[0])
    edges = [start, *(r for r in corners if r > start), stations[-1]]
    return sum(
        quad(lambda r: np.interp(r, stations, values) * (r - offset) ** power, a, b, epsabs=0, epsrel=1e-12)[
            0
        ]
        for a, b in pairwise(edges)
    )


def integrals(stations, values, flap, lag):
    """The seven integrals in the order of the package's names."""
    wanted = [(0.0, 0), (0.0, 1), (0.0, 2), (flap, 1), (flap, 2), (lag, 1), (lag, 2)]
    return [integral(stations, values, *each) for each in wanted]


def found(rotor):
    return [getattr(rotor, name) for name in MASS_INTEGRALS]


def blade(stations, values, *beyond, **given):
    return pp.Rotor.from_mass_distribution(stations, values, *beyond, **(ROTOR | {"chord": 0.4} | given))


# Right values -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("first", [0.0, 0.1, 0.45, 0.9])
@pytest.mark.parametrize("last", [2.0, 3.6, 4.0])
def test_no_mass_beyond_the_stations_where_the_table_says_so(first, last):
    stations, values = np.array([first, (first + last) / 2, last]), np.array([9.0, 6.0, 3.0])
    expected = integrals(stations, values, 0.2, 0.5)
    np.testing.assert_allclose(found(blade(stations, values, "nothing")), expected, rtol=1e-10)


def test_the_hub_has_a_mass_and_no_inertia():
    stations, values = np.array([0.3, 2.0, 4.0]), np.array([9.0, 6.0, 3.0])
    expected = integrals(stations, values, 0.2, 0.5)
    expected[0] += 60.0 / 3
    np.testing.assert_allclose(found(blade(stations, values, hub_mass=60.0)), expected, rtol=1e-10)
    elsewhere = blade(stations, values, hub_mass=0.0)
    np.testing.assert_allclose(elsewhere.blade_mass, integral(stations, values, 0.0, 0), rtol=1e-12)
    many = blade(stations, values, hub_mass=np.array([0.0, 30.0, 60.0]))
    np.testing.assert_allclose(many.blade_mass, expected[0] - np.array([20.0, 10.0, 0.0]), rtol=1e-12)


def test_a_table_that_ended_at_nine_tenths_lost_a_quarter_of_the_inertia(tmp_path):
    """The blade of NASA/TP-2004-212262 to 0.9 R, as it used to be integrated without a word."""
    table = read_tables("xv15-mass-distribution")["rotor"]["mass_distribution"]
    r, m = np.array(table["r_over_R"]), np.array(table["value"])
    kept = r <= 0.9
    text = f'r_over_R = {r[kept].tolist()}, value = {m[kept].tolist()}, unit = "slug/ft"'
    with pytest.raises(InputError, match=r'from 0 R to 0\.9 R; they must .* say beyond = "nothing"'):
        deck(tmp_path, f"mass_distribution = {{ {text} }}")
    short = deck(tmp_path, f'mass_distribution = {{ {text}, beyond = "nothing" }}').rotor.blade_inertia
    whole = pp.load_case("xv15-mass-distribution").rotor.blade_inertia
    unit = SLUG / FT
    assert short == pytest.approx(integral(r[kept] * RADIUS, m[kept] * unit, 0.0, 2), rel=1e-8)
    assert whole == pytest.approx(integral(r * RADIUS, m * unit, 0.0, 2), rel=1e-8)
    assert short / whole == pytest.approx(0.755, abs=0.001)


def test_stations_printed_to_three_digits_reach_the_ends():
    """And are taken to be there: nothing of the mass is lost by the rounding."""
    values = np.array([9.0, 6.0, 3.0])
    expected = integrals(np.array([0.0, 2.0, 4.0]), values, 0.2, 0.5)
    for first, last in ((0.0, 3.998), (0.0, 4.002), (0.003, 4.0), (-0.002, 4.0), (0.002, 3.997)):
        np.testing.assert_allclose(found(blade([first, 2.0, last], values)), expected, rtol=1e-10)
    for first, last in ((0.0, 3.99), (0.01, 4.0), (0.0, 4.01), (-0.01, 4.0)):
        with pytest.raises(InputError, match="mass_distribution = 3 values: has stations from"):
            blade([first, 2.0, last], values)
    for r in ([0.403, 4.0], [0.0, 3.997], [0.0, 4.5]):
        replace(blade([0.0, 4.0], [9.0, 3.0]), chord=(np.array(r), np.array([0.4, 0.3])))


def test_held_ends_are_the_same_table_written_out():
    short = np.array([0.8, 3.0]), np.array([0.5, 0.3])
    long = np.array([0.4, 0.8, 3.0, 4.0]), np.array([0.5, 0.5, 0.3, 0.3])
    rotor = blade([0.0, 4.0], [9.0, 3.0])
    r = np.linspace(0.4, 4.0, 50)
    for name in ("chord", "twist"):
        held, written = (replace(rotor, **{name: table}) for table in ((*short, "held"), long))
        at = f"{name}_at"
        np.testing.assert_allclose(getattr(held, at)(r), getattr(written, at)(r), rtol=0, atol=1e-15)


# Refused, by every way in -------------------------------------------------------------------------------------------


def deck(folder, rotor, base="xv15-uncoupled"):
    path = folder / "ends.toml"
    path.write_text(f'base = "{base}"\n[case]\nname = "ends"\n[rotor]\n{rotor}\n', encoding="utf-8")
    return pp.load_case(path)


def in_the_deck(folder, column, stations, said):
    unit, values, _ = COLUMNS[column]
    return deck(
        folder, f'{column} = {{ r_over_R = {list(stations)}, value = {list(values)}, unit = "{unit}"{said} }}'
    )


def in_a_file(folder, column, stations, said, head="r_over_R", factor=1.0):
    unit, values, _ = COLUMNS[column]
    rows = "\n".join(f"{r * factor},{value}" for r, value in zip(stations, values, strict=True))
    (folder / "stations.csv").write_text(f"{head},it [{unit}]\n{rows}\n", encoding="utf-8")
    return deck(folder, f'{column} = {{ file = "stations.csv", column = "it"{said} }}')


def in_a_file_by_radius(folder, column, stations, said):
    return in_a_file(folder, column, stations, said, head="r [ft]", factor=12.5)


def as_a_setting(folder, column, stations, said):
    unit, values, _ = COLUMNS[column]
    table = f'{{ r_over_R = {list(stations)}, value = {list(values)}, unit = "{unit}"{said} }}'
    return pp.load_case("xv15-uncoupled", {f"rotor.{column}": table})


def in_python(folder, column, stations, said):
    case = pp.load_case("xv15-uncoupled")
    table = np.array(stations) * RADIUS, np.array([2.0, 1.0]), *((COLUMNS[column][2],) if said else ())
    if column != "mass_distribution":
        return replace(case, rotor=replace(case.rotor, **{column: table}))
    given = {name: getattr(case.rotor, name) for name in ("radius", "n_blades", "airfoil", "chord")}
    return replace(
        case, rotor=pp.Rotor.from_mass_distribution(*table, **given, flap_stiffness=1e4, lag_stiffness=1e5)
    )


WAYS = (in_the_deck, in_a_file, in_a_file_by_radius, as_a_setting, in_python)


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize(("column", "end"), EARLY)
def test_a_table_that_ends_early_is_refused(tmp_path, way, column, end):
    first, last = ENDS[end]
    word = COLUMNS[column][2]
    with pytest.raises(InputError) as error:
        way(tmp_path, column, (first, last), "")
    told = str(error.value)
    assert error.value.field.removeprefix("rotor.") == column
    assert f"has stations from {first:g} R to {last:g} R; they must reach from " in told
    assert f'say beyond = "{word}"' in told and len(told.splitlines()) == 1
    if column == "mass_distribution":
        assert "Give hub_mass for the mass inboard of the first" in told
    else:
        assert "from the root cutout, 0.0875 R, to the tip" in told


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize(("column", "end"), EARLY)
def test_and_accepted_where_it_says_what_follows(tmp_path, way, column, end):
    word = COLUMNS[column][2]
    case = way(tmp_path, column, ENDS[end], f', beyond = "{word}"')
    if way is not in_python:
        assert case.sources[f"rotor.{column}"].beyond == word
        assert case.sources[f"rotor.{column}"].written.endswith(f", {word} beyond")


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("column", ["chord", "twist"])
def test_what_lies_inboard_of_the_cutout_is_not_asked_for(tmp_path, way, column):
    way(tmp_path, column, (CUTOUT, 1.0), "")


@pytest.mark.parametrize("column", ["chord", "twist"])
def test_a_cutout_moved_inboard_of_the_table_is_refused(tmp_path, column):
    case = in_the_deck(tmp_path, column, (CUTOUT, 1.0), "")
    case.vary({"rotor.root_cutout": 0.5, "rotor.radius": 4.0})  # r/R stays
    for cutout in (0.1, np.array([0.5, 0.1])):
        with pytest.raises(
            InputError, match=rf"rotor\.{column} = 2 values in .*must reach from the root cutout"
        ):
            case.vary({"rotor.root_cutout": cutout})


def test_other_words_are_refused(tmp_path):
    for column, word in (("chord", "nothing"), ("twist", "zero"), ("mass_distribution", "held")):
        for way in (in_the_deck, in_a_file, as_a_setting):
            right = COLUMNS[column][2]
            with pytest.raises(InputError, match=rf'beyond = {word}: must be "{right}", or left out'):
                way(tmp_path, column, (0.2, 0.9), f', beyond = "{word}"')
    rotor = blade([0.0, 4.0], [9.0, 3.0])
    with pytest.raises(InputError, match='must be \\(r, values\\), or \\(r, values, "held"\\)'):
        replace(rotor, chord=([0.0, 4.0], [0.4, 0.3], "nothing"))
    with pytest.raises(InputError, match='must have beyond = "nothing", or no beyond'):
        blade([0.0, 4.0], [9.0, 3.0], "held")


def test_the_wing_has_no_such_word(tmp_path):
    with pytest.raises(InputError, match="beyond"):
        pp.load_case(
            "xv15-wing",
            {
                "support.mass_per_length": '{ y_over_span = [0, 1], value = [1, 1], unit = "kg/m", beyond = "held" }',
            },
        )


# The hub's own mass ---------------------------------------------------------------------------------------------


BEGINS = 'mass_distribution = { r_over_R = [0.1, 1], value = [0.4, 0.15], unit = "slug/ft" }\n'


def test_a_hub_mass_in_the_deck(tmp_path):
    with pytest.raises(InputError, match="Give hub_mass"):
        deck(tmp_path, BEGINS)
    case = deck(tmp_path, f'{BEGINS}hub_mass = "90 lb"\n')
    stations, values = np.array([0.1, 1.0]) * RADIUS, np.array([0.4, 0.15]) * SLUG / FT
    expected = integral(stations, values, 0.0, 0) + 90 * LB / 3
    assert case.rotor.blade_mass == pytest.approx(expected, rel=1e-8)
    assert case.rotor.blade_inertia == pytest.approx(integral(stations, values, 0.0, 2), rel=1e-8)
    more = case.vary({"rotor.hub_mass": np.array([90.0, 120.0]) * LB})
    np.testing.assert_allclose(more.rotor.blade_mass, expected + np.array([0.0, 10.0]) * LB, rtol=1e-8)


def test_a_hub_mass_that_would_count_twice(tmp_path):
    with pytest.raises(
        InputError, match=r"^rotor\.hub_mass = 90 lb: must be given with mass_distribution; blade_mass"
    ):
        pp.load_case("xv15-uncoupled", {"rotor.hub_mass": "90 lb"})
    with pytest.raises(
        InputError, match=r"rotor\.hub_mass = 90 lb: must not be given with a mass_distribution that"
    ):
        deck(tmp_path, 'hub_mass = "90 lb"', base="xv15-mass-distribution")
    for bad in (-1.0, np.nan):
        with pytest.raises(InputError, match=r"hub_mass = .*: must be finite and not negative"):
            blade([0.3, 4.0], [9.0, 3.0], hub_mass=bad)


def test_integrals_replace_a_distribution_and_its_hub(tmp_path):
    deck(tmp_path, f'{BEGINS}hub_mass = "90 lb"\n')
    (tmp_path / "ends.toml").rename(tmp_path / "first.toml")
    own = read_tables("xv15-uncoupled")["rotor"]
    lines = "\n".join(f'{name} = "{own[name]["value"]}"' for name in MASS_INTEGRALS)
    case = deck(tmp_path, lines, base="first.toml")
    assert case.rotor.blade_mass == pp.load_case("xv15-uncoupled").rotor.blade_mass
    assert "rotor.hub_mass" not in case.sources
