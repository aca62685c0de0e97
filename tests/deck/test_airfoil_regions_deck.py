"""Airfoils by region in decks: lists of numbers and of files, provenance, variants, and what is refused."""

import numpy as np
import pytest
from click.testing import CliRunner

import proprotor as pp
from proprotor.commands.main import main
from proprotor.deck.vary import varied_numbers
from proprotor.explore.altered_deck import altered_deck
from proprotor.model import stamp
from proprotor.model.amounts import amounts
from proprotor.model.deck_fingerprint import deck_fingerprint
from proprotor.model.first_order import state_matrix
from tests.c81_files import as_c81, made_up_tables

HEAD = 'base = "xv15"\n[case]\nname = "regions"\n'
THREE = """
[rotor.airfoil]
region_ends = { value = [0.55, 0.8], status = "published", source = "a report" }
lift_slope = { value = [6.1, 5.8, 6.5], unit = "1/rad" }
zero_lift_angle = { value = [-2, -1, -1], unit = "deg", status = "assumed", source = "a guess" }
moment = { value = [-0.075, -0.008, -0.02] }
"""


@pytest.fixture
def deck(tmp_path):
    def write(text, name="deck.toml"):
        (tmp_path / name).write_text(text if name != "deck.toml" else HEAD + text)
        return tmp_path / name

    return write


def test_a_list_has_a_value_for_each_region_and_a_number_holds_for_all(deck):
    case = pp.load_case(deck(THREE))
    airfoil = case.rotor.airfoil
    np.testing.assert_array_equal(airfoil.region_ends, [0.55, 0.8])
    assert [part.lift_slope for part in airfoil.airfoils] == [6.1, 5.8, 6.5]
    np.testing.assert_allclose([part.zero_lift_angle for part in airfoil.airfoils], np.radians([-2, -1, -1]))
    assert [part.drag for part in airfoil.airfoils] == [0.0065] * 3
    assert case.sources["rotor.airfoil.region_ends"].source == "a report"
    assert case.sources["rotor.airfoil.zero_lift_angle"].status == "assumed"


def test_files_start_from_the_folder_of_the_deck_and_a_file_may_hold_several(deck, tmp_path):
    one, two = made_up_tables(), made_up_tables()
    (tmp_path / "inner.c81").write_text(as_c81("INNER", **one))
    (tmp_path / "outer.c81").write_text(as_c81("OUTER", **two))
    text = '[rotor.airfoil]\nregion_ends = 0.6\nblend = 0.1\ntable = ["inner.c81", "outer.c81"]\n'
    case = pp.load_case(deck(text))
    assert [part.name for part in case.rotor.airfoil.airfoils] == ["INNER", "OUTER"]
    assert case.given["rotor.airfoil.table"].written == "inner.c81, outer.c81"
    (tmp_path / "both.c81").write_text(as_c81("INNER", **one) + as_c81("OUTER", **two))
    text = '[rotor.airfoil]\nregion_ends = 0.6\ntable = "both.c81"\ntable_name = ["OUTER", "INNER"]\n'
    turned = pp.load_case(deck(text))
    assert [part.name for part in turned.rotor.airfoil.airfoils] == ["OUTER", "INNER"]
    swapped = pp.load_case(deck(text.replace('"OUTER", "INNER"', '"INNER", "OUTER"')))
    assert len({deck_fingerprint(case) for case in (turned, swapped)}) == 2


def test_the_end_of_two_regions_and_the_width_may_vary(deck):
    text = "[rotor.airfoil]\nregion_ends = 0.6\nblend = 0.1\nmoment = { value = [-0.075, -0.02] }\n"
    case = pp.load_case(deck(text))
    assert {"rotor.airfoil.region_ends", "rotor.airfoil.blend"} <= set(pp.design_inputs(case))
    batch = case.vary({"rotor.airfoil.region_ends": [0.5, 0.6], "rotor.airfoil.blend": [0.0, 0.1]})
    found, own = batch.linearize(120.0), case.linearize(120.0)
    assert np.abs(found.K[1] - own.K).max() <= 1e-12 * np.abs(own.K).max()
    assert np.abs(found.K[0] - own.K).max() > 1e-6 * np.abs(own.K).max()


ENTRY = "rotor.airfoil.lift_slope[2]"
SPEED = 150.0


@pytest.fixture
def three(deck):
    return pp.load_case(deck(THREE))


def test_entries_of_a_list_are_inputs_from_the_root_outward(three):
    known = pp.design_inputs(three)
    slopes = [known[f"rotor.airfoil.lift_slope[{place}]"] for place in (1, 2, 3)]
    assert [number.si for number in slopes] == [6.1, 5.8, 6.5]
    assert (slopes[1].written, slopes[1].unit) == ("5.8 1/rad", "1/rad")
    assert known["rotor.airfoil.zero_lift_angle[1]"].source == "a guess"
    assert {"rotor.airfoil.region_ends[2]", "rotor.airfoil.moment[3]", "rotor.airfoil.drag"} <= set(known)
    assert "rotor.airfoil.lift_slope" not in known
    with pytest.raises(pp.InputError, match=r"a value for each region: rotor\.airfoil\.lift_slope\[1\]"):
        three.vary({"rotor.airfoil.lift_slope": 6.0})
    with pytest.raises(pp.InputError, match=r"lift_slope\[4\]"):
        three.vary({"rotor.airfoil.lift_slope[4]": 6.0})


@pytest.mark.parametrize(
    ("path", "values", "written"),
    [
        (ENTRY, [5.8, 6.2], "lift_slope = { value = [6.1, 6.2, 6.5]"),
        ("rotor.airfoil.region_ends[1]", [0.55, 0.5], "region_ends = { value = [0.5, 0.8]"),
        ("rotor.airfoil.moment[3]", [-0.02, -0.05], "moment = { value = [-0.075, -0.008, -0.05]"),
    ],
)
def test_designs_with_another_entry_are_those_of_decks_with_it(three, deck, path, values, written):
    """One entry varies, in a batch, and the deck that says the same gives the same matrices."""
    field = path.rpartition(".")[2].partition("[")[0]
    lines = [
        written + line[line.index("]") + 1 :] if line.startswith(field) else line
        for line in THREE.split("\n")
    ]
    other = pp.load_case(deck("\n".join(lines)))
    batch, one = three.vary({path: values}).linearize(SPEED), other.linearize(SPEED)
    for name, own in (("K", three.linearize(SPEED).K), ("K", one.K)):
        place = 0 if own is not one.K else 1
        assert np.abs(getattr(batch, name)[place] - own).max() <= 1e-11 * np.abs(own).max()
    stamps = [stamp.of_model(model)["deck"] for model in (batch, three.linearize(SPEED), one)]
    assert len(set(stamps)) == 3
    assert np.abs(batch.K[0] - batch.K[1]).max() > 1e-7 * np.abs(one.K).max()


@pytest.mark.parametrize("path", [ENTRY, "rotor.airfoil.zero_lift_angle[3]", "rotor.airfoil.region_ends[2]"])
def test_derivatives_by_an_entry(three, path):
    """Beside central differences, of the beam mode; exact, by a complex step."""
    found = three.sensitivity("eigenvalue", airspeed=SPEED, wrt=[path], mode="beam")
    own, step = float(pp.design_inputs(three)[path].si), 1e-4
    roots = [
        three.vary({path: own + sign * step}).linearize(SPEED).modes().eigenvalue.values for sign in (1, -1)
    ]
    ahead, behind = (values[np.abs(values - found.eigenvalue.item()).argmin()] for values in roots)
    assert bool(found.exact.all())
    assert found.derivative.item() == pytest.approx((ahead - behind) / (2 * step), rel=1e-4)


def test_studies_and_cases_that_were_varied_hold_entries(three, tmp_path):
    varied = three.vary({ENTRY: 6.3, "rotor.precone": 0.03})
    assert varied_numbers(varied) == {ENTRY: 6.3, "rotor.precone": 0.03}
    again = three.vary(varied_numbers(varied))
    assert [part.lift_slope for part in again.rotor.airfoil.airfoils] == [6.1, 6.3, 6.5]
    designs = pp.study(varied, {ENTRY: [5.9, 6.3]}, SPEED, quantities="eigenvalue", workers=1)
    expected = np.linalg.eigvals(state_matrix(varied.linearize(SPEED)))
    for value in designs.eigenvalue.values[1]:
        assert np.abs(expected - value).min() < 1e-10 * np.abs(expected).max()
    assert designs[ENTRY].values.tolist() == [5.9, 6.3]


def test_the_explorer_writes_the_whole_list(three, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = altered_deck("deck.toml", three, {ENTRY: 6.25, "rotor.airfoil.moment[1]": -0.05})
    (tmp_path / "explored.toml").write_text(text)
    case = pp.load_case(tmp_path / "explored.toml")
    assert [part.lift_slope for part in case.rotor.airfoil.airfoils] == [6.1, 6.25, 6.5]
    assert [part.moment for part in case.rotor.airfoil.airfoils] == [-0.05, -0.008, -0.02]


def test_regions_stay_with_a_variant_that_gives_one_lift_slope(deck):
    """The new number holds in every region, the lists of the base in theirs."""
    deck(HEAD + THREE, "three.toml")
    case = pp.load_case(
        deck(
            'base = "three.toml"\n[case]\nname = "one"\n[rotor.airfoil]\nlift_slope = "5.9/rad"\n', "one.toml"
        )
    )
    assert [part.lift_slope for part in case.rotor.airfoil.airfoils] == [5.9] * 3
    assert [part.moment for part in case.rotor.airfoil.airfoils] == [-0.075, -0.008, -0.02]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (
            THREE.replace("5.8, 6.5", "5.8"),
            "rotor.airfoil.lift_slope = 2 values in 1/rad: must have one value for each region, 3",
        ),
        (
            THREE.replace("region_ends", "# region_ends"),
            "rotor.airfoil.region_ends: is missing; lift_slope has 3 values in 1/rad",
        ),
        (
            THREE.replace("0.55, 0.8", "0.8, 0.55"),
            "rotor.airfoil.region_ends = 2 values: must increase from region to region",
        ),
        (
            THREE + "blend = { value = [0.1, 0.1, 0.1] }",
            "blend = 3 values: must have one value for each end of a region, 2",
        ),
        (THREE + "blend = 0.4", "rotor.airfoil.blend = 0.4: must not make two joints overlap"),
        (THREE + "blend = -0.1", "rotor.airfoil.blend = -0.1: must lie between 0 and 1"),
        (THREE.replace(', unit = "1/rad"', ""), "rotor.airfoil.lift_slope.unit: is missing"),
        ("[rotor.airfoil]\nblend = 0.1\n", "rotor.airfoil.blend = 0.1: must be given with region_ends"),
        ('[rotor.airfoil]\nregion_ends = 0.5\ntable = ["a.c81"]\n', "must have two files or more"),
        (
            '[rotor.airfoil]\nregion_ends = 0.5\ntable = ["a.c81", 3]\n',
            "rotor.airfoil.table = 3: must be the name of a file",
        ),
        ('[rotor.airfoil]\nregion_ends = 0.5\ntable = ["a.c81", "b.c81"]\n', "a.c81"),
        ("[rotor]\nlock_number = 3.83\n" + THREE, "rotor.lock_number = 3.83: needs one lift_slope"),
    ],
)
def test_what_is_wrong_with_them_is_told(deck, text, told):
    with pytest.raises(pp.InputError) as caught:
        pp.load_case(deck(text))
    assert told in str(caught.value)
    assert len(str(caught.value).splitlines()) <= 2


def test_the_bundled_deck_has_four_lift_slopes_and_a_zero_lift_line_by_tenths():
    """The published numbers, and the lift slopes without the compressibility of their Mach numbers."""
    airfoil = pp.load_case("xv15-sections").rotor.airfoil
    at = np.array([0.3, 0.4, 0.6, 0.7, 0.9, 0.97])
    found = airfoil.at(at, ())
    np.testing.assert_allclose(
        np.degrees(found.zero_lift_angle[0]), [-2.1, -1.4, -1.0, -1.2, -1.3, -1.3], rtol=1e-12
    )
    np.testing.assert_allclose(found.moment[0], [-0.075, -0.075, -0.008, -0.008, -0.017, -0.02], rtol=1e-12)
    mach = np.array([0.293, 0.293, 0.475, 0.475, 0.606, 0.672])
    published = [6.4, 6.4, 6.65, 6.65, 7.75, 8.75]
    np.testing.assert_allclose(found.lift_slope[0] / np.sqrt(1 - mach**2), published, rtol=1e-4)


@pytest.mark.parametrize(
    ("name", "values"), [("xv15-sections", "6.119, 6.119, "), ("xv15-bell-frequencies", "1.69, 2.04")]
)
def test_a_report_shows_the_values_of_a_list(tmp_path, monkeypatch, name, values):
    monkeypatch.chdir(tmp_path)
    result = CliRunner().invoke(main, ["report", name, "--out", "report.html"])
    assert result.exit_code == 0, result.output
    assert values in (tmp_path / "report.html").read_text()


def test_the_left_rotor_may_have_airfoils_of_its_own(deck):
    """A list on one side, one number on the other."""
    text = 'base = "xv15-aircraft"\n[case]\nname = "apart"\n[left.rotor.airfoil]\nregion_ends = 0.6\n'
    case = pp.load_case(deck(text + "moment = { value = [-0.075, -0.02] }\n", "apart.toml"))
    assert [part.moment for part in case.left.rotor.airfoil.airfoils] == [-0.075, -0.02]
    assert case.rotor.airfoil.moment == 0 and case.given["left.rotor.airfoil.moment"].si == (-0.075, -0.02)
    assert case.linearize(120.0).trim.converged


def test_the_lock_number_has_the_lift_slope_of_each_radius(deck):
    """With a constant chord: the mean of the lift slopes, weighed by r³ between the cutout and the tip."""
    case = pp.load_case(deck(THREE))
    edges = np.array([float(case.rotor.root_cutout / case.rotor.radius), 0.55, 0.8, 1.0])
    share = np.diff(edges**4) / (1 - edges[0] ** 4)
    rotor = case.rotor
    unit = case.operation.density * rotor.chord * rotor.radius**4 / rotor.blade_inertia
    found = next(one for one in amounts(case) if one.name == "Lock number")
    np.testing.assert_allclose(found.value, unit * (share @ [6.1, 5.8, 6.5]), rtol=1e-12)
