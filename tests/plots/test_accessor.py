"""The accessor of datasets: registered with xarray whoever imports it first, with plots and tables of each kind."""

import csv
import json
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import proprotor as pp
from proprotor.interface import _register_accessor
from tests.csv_files import without_comments

PRECONE = "rotor.precone"
CASE = pp.load_case("xv15-uncoupled")
OF_SAMPLE = pp.sampling.saltelli({PRECONE: (0.02, 0.06), "rotor.control_stiffness": (11e3, 20e3)}, 2)


def with_envelope():
    """The same deck with an envelope."""
    altitudes = '{ value = [0, 1], unit = "km" }'
    return pp.load_case(
        "xv15-uncoupled", {"envelope.dive_speed": "180 keas", "envelope.altitudes": altitudes}
    )


@pytest.fixture(scope="module")
def results():
    """A result of each kind, small."""
    sampled = pp.study(CASE, OF_SAMPLE, "160:460:50kt", "flutter", workers=1)
    axes = {"airspeed": "340:440:50kt", PRECONE: "1:2:0.5 deg"}
    return {
        "sweep": CASE.sweep("100:140:20kt"),
        "study": sampled,
        "distribution": pp.distribution(sampled),
        "indices": pp.sobol_indices(sampled, beyond="limit"),
        "stability map": CASE.stability_map(axes),
        "boundaries": CASE.boundary_against({PRECONE: [0.02, 0.05]}, "300:440:20kt"),
        "growth constraint": CASE.growth_constraint("100:140:20kt", [PRECONE]),
        "envelope": with_envelope().envelope("150:240:45keas"),
        "sensitivity": CASE.sensitivity("damping", [PRECONE], airspeed="300 kt", mode="beam"),
        "attribution": CASE.attribution("300 kt"),
    }


KINDS = (
    "sweep",
    "study",
    "distribution",
    "indices",
    "stability map",
    "boundaries",
    "growth constraint",
    "envelope",
    "sensitivity",
    "attribution",
)


@pytest.mark.parametrize("kind", KINDS)
def test_a_result_knows_what_it_is_and_keeps_knowing_it_in_a_file(results, kind, tmp_path):
    found = results[kind]
    assert found.proprotor.kind == kind and kind in repr(found.proprotor)
    found.proprotor.to_netcdf(tmp_path / "a.nc")
    assert pp.load_results(tmp_path / "a.nc").proprotor.kind == kind


@pytest.mark.parametrize("kind", KINDS)
def test_every_plot_that_it_offers_can_be_drawn(results, kind):
    accessor = results[kind].proprotor
    own = {"plot_participation": ["beam"], "plot_attribution": ["beam"]}
    for name in accessor.plots:
        assert name in dir(accessor)
        assert isinstance(getattr(accessor, name)(*own.get(name, [])), Axes | Figure)
    pyplot.close("all")
    assert accessor.plots or kind in ("distribution", "growth constraint")
    if kind == "sweep":
        assert isinstance(accessor.plot(), Figure)
        assert accessor.plot_damping(unit="m/s").get_xlabel() != accessor.plot_damping().get_xlabel()
        pyplot.close("all")
        with pytest.raises(AttributeError, match="did you mean plot_damping"):
            accessor.plot_dampin()
        with pytest.raises(AttributeError):
            accessor.save()
    if not accessor.plots:
        with pytest.raises(pp.InputError, match="has no plot of its own"):
            accessor.plot()


def test_tables_of_a_study_a_sweep_and_boundaries(results, tmp_path):
    study, sweep, against = (results[kind] for kind in ("study", "sweep", "boundaries"))
    assert len(study.proprotor.records()) == study.sizes["design"] == 8
    assert len(sweep.proprotor.records(rotor_speed=40.0)) == sweep.sizes["airspeed"] * sweep.sizes["mode"]
    assert {record[f"{PRECONE} (rad)"] for record in against.proprotor.records()} == {0.02, 0.05}
    study.proprotor.to_csv(tmp_path / "a.csv")
    lines = without_comments(tmp_path / "a.csv")
    speeds = [row["flutter speed (m/s)"] for row in csv.DictReader(lines)]
    np.testing.assert_array_equal(
        [float(text) if text else np.nan for text in speeds], study.flutter_speed.values
    )
    for kind, options in (("study", {}), ("sweep", {"rotor_speed": 40.0}), ("boundaries", {"unit": "deg"})):
        results[kind].proprotor.to_json(tmp_path / "a.json", **options)
        document = json.loads((tmp_path / "a.json").read_text())
        rows = document["designs" if kind == "study" else "records"]
        assert len(rows) == len(results[kind].proprotor.records(**options)) and document["deck"]


def test_what_has_no_table_or_no_rotor_speed_is_told_and_nothing_is_written(results, tmp_path):
    with pytest.raises(pp.InputError, match="has no table"):
        results["stability map"].proprotor.to_csv(tmp_path / "a.csv")
    with pytest.raises(pp.InputError, match="rotor_speed: must be given for a sweep"):
        results["sweep"].proprotor.to_csv(tmp_path / "a.csv")
    with pytest.raises(pp.InputError, match=r"must end in \.csv"):
        results["study"].proprotor.to_csv(tmp_path / "a.txt")
    assert not list(tmp_path.iterdir())


def test_a_sweep_over_the_rotor_speed_has_a_campbell_diagram_and_no_table():
    found = CASE.sweep("200 kt", {"operation.rotor_speed": "400:500:50 rpm"})
    assert isinstance(found.proprotor.plot_campbell(n_blades=3), Axes)
    pyplot.close("all")
    with pytest.raises(pp.InputError, match="a sweep over airspeeds"):
        found.proprotor.records(rotor_speed=40.0)


def test_doubts_are_told(results):
    thin = pp.load_case("xv15-uncoupled", {"operation.speed_of_sound": "300 m/s"})
    assert any("Mach number" in text for text in thin.sweep("340:400:20kt").proprotor.doubts)
    assert results["sweep"].proprotor.doubts == []


def test_any_other_dataset_offers_nothing():
    other = xr.Dataset({"x": ("y", [1.0])}).proprotor
    assert other.kind == "other" and other.plots == () and other.doubts == []
    _register_accessor()  # once more: without a warning


ORDERS = {
    "proprotor first": "import proprotor as pp; pp.load_case; assert 'xarray' not in sys.modules; import xarray",
    "xarray first": "import xarray; import proprotor as pp; pp.load_case",
    "by a result": "import proprotor as pp; pp.load_case('xv15-uncoupled').sweep('200 kt'); import xarray",
}


@pytest.mark.parametrize("order", ORDERS)
def test_the_accessor_is_there_whoever_imports_xarray_first(order):
    """And no finder stays behind that asks again, or hides where xarray is from."""
    code = f"import sys; {ORDERS[order]}; xarray.Dataset().proprotor.kind; print(xarray.__spec__.name)"
    done = subprocess.run([sys.executable, "-W", "error", "-c", code], capture_output=True, text=True)
    assert done.stdout == "xarray\n", done.stderr


def test_an_xarray_that_is_missing_is_missing():
    code = """
import sys
class Hidden:
    def find_spec(self, name, path=None, target=None):
        if name == "xarray": raise ModuleNotFoundError("No module named 'xarray'", name=name)
import proprotor as pp; pp.load_case
sys.meta_path.insert(1, Hidden())
for _ in range(2):
    try: import xarray
    except ModuleNotFoundError as error: print(error)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout == "No module named 'xarray'\n" * 2, done.stderr
