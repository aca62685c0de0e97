"""Samples of distributions by closed forms: ratios that are equally likely, and inputs that vary together."""

import numpy as np
import pytest

import proprotor as pp
from proprotor import sampling
from proprotor.datum import Datum
from proprotor.errors import InputError

KNOWN = {
    "mast": Datum("", 2.0, "m"),
    "slope": Datum("", -0.5, "rad"),
    "swing": Datum("", 3.0, "m"),
    "word": Datum("", "held", ""),
}


def test_all_ratios_of_a_logarithmic_range_are_equally_likely():
    """Each of 20 designs lies in another twentieth of the logarithm."""
    inputs = {
        "mast": sampling.LogRange("2 ft", "8 ft"),
        "swing": sampling.Relative(0.5, 2.0, logarithmic=True),
    }
    values = sampling.latin_hypercube(inputs, 20).resolve(KNOWN).values
    for name, low in (("mast", 2 * 0.3048), ("swing", 1.5)):
        strata = np.floor(20 * np.log(values[name] / low) / np.log(4) + 1e-9)
        assert sorted(strata) == list(range(20))


def test_inputs_that_vary_together_have_one_factor_and_factors_multiply():
    inputs = {("mast", "swing"): (0.8, 1.2), ("slope", "swing"): sampling.Range(0.5, 1.5)}
    designs = sampling.latin_hypercube(inputs, 16, seed=4).resolve(KNOWN)
    mast, slope = designs.values["mast"] / 2, designs.values["slope"] / -0.5
    np.testing.assert_allclose(designs.values["swing"], 3 * mast * slope, rtol=1e-14)
    for factor, low, width in ((mast, 0.8, 0.4), (slope, 0.5, 1.0)):
        assert sorted(np.floor(16 * (factor - low) / width + 1e-9)) == list(range(16))
    assert designs.units == {"mast": "m", "slope": "rad", "swing": "m"}
    assert designs.sample["inputs"] == ["mast, swing", "slope, swing"]


def test_a_factor_multiplies_what_its_input_varies_alone():
    inputs = {("mast", "swing"): (0.8, 1.2), "swing": (10.0, 20.0)}
    values = sampling.sobol(inputs, 8).resolve(KNOWN).values
    alone = values["swing"] / (values["mast"] / 2)
    assert sorted(np.floor(8 * (alone - 10) / 10 + 1e-9)) == list(range(8))


@pytest.mark.parametrize(
    ("plan", "message"),
    [
        (sampling.latin_hypercube({("mast", "word"): (0.8, 1.2)}, 4), "must be a number of the deck"),
        (sampling.latin_hypercube({("mast", "airspeed"): (0.8, 1.2)}, 4), "must be a number of the deck"),
        (sampling.latin_hypercube({("mast", "wing"): (0.8, 1.2)}, 4), "wing"),
        (sampling.latin_hypercube({("mast", "swing"): ("1 ft", "2 ft")}, 4), "mast, swing"),
        (sampling.latin_hypercube({"mast": sampling.LogRange(0, 1)}, 4), "limits above zero"),
        (
            sampling.latin_hypercube({"mast": sampling.Relative(0, 1, logarithmic=True)}, 4),
            "limits above zero",
        ),
    ],
)
def test_what_cannot_vary_so_is_refused(plan, message):
    with pytest.raises(InputError, match=message):
        plan.resolve(KNOWN)


@pytest.mark.parametrize("plan", [sampling.grid, sampling.points])
def test_inputs_of_a_grid_or_list_do_not_vary_together(plan):
    with pytest.raises(InputError, match=r"^mast, swing = .*only in a sample"):
        plan({("mast", "swing"): [0.8, 1.2]})


def test_a_study_varies_inputs_together():
    """A mast 10 % longer on each mode it stands in: the same as a deck written so."""
    case, paths = pp.load_case("xv15-uncoupled"), ("support.modes[torsion].x", "support.modes[chord].y")
    found = pp.study(case, sampling.latin_hypercube({paths: (0.9, 1.1)}, 2), 120.0, "eigenvalue", workers=1)
    for design in range(2):
        factor = found[paths[0]].values[design] / case.given[paths[0]].si
        one = case.vary({path: case.given[path].si * factor for path in paths})
        alone = pp.study(one, {}, 120.0, "eigenvalue", workers=1)
        np.testing.assert_allclose(found.eigenvalue[design], alone.eigenvalue[0], rtol=1e-9)
