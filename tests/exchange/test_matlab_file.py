"""Files of MATLAB, read back with SciPy: the same numbers under names that MATLAB takes."""

import re

import numpy as np
import pytest
import xarray
from scipy.io import loadmat

import proprotor as pp
from proprotor.exchange.matlab import matlab_names, save_matlab
from proprotor.stability.sweep import sweep

MATLAB_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,62}")


def saved(results, folder):
    save_matlab(results, folder / "results.mat")
    return loadmat(folder / "results.mat", simplify_cells=True)


def all_names(content):
    for name, entry in content.items():
        if not name.startswith("__"):
            yield name
            if isinstance(entry, dict) and name != "names":
                yield from all_names(entry)


@pytest.fixture(scope="module")
def model():
    return pp.load_case("xv15-uncoupled").linearize(np.array([100.0, 140.0, 330.0]))


def test_a_model(model, tmp_path):
    found = saved(model, tmp_path)
    for name in ("M", "C", "K", "B"):
        np.testing.assert_array_equal(np.moveaxis(found[name], -1, 0), getattr(model, name))
    space = model.to_state_space()
    for name in "ABCD":
        own = getattr(space, name)
        pages = found["state_space"][name]
        pages = np.moveaxis(pages, -1, 0) if pages.ndim == 3 else pages
        np.testing.assert_array_equal(pages, own)
    for name in ("states", "inputs", "outputs"):
        assert tuple(found["state_space"][name]) == getattr(space, name)
    assert tuple(found["dofs"]) == model.dofs
    np.testing.assert_array_equal(found["airspeed"], model.airspeed)
    np.testing.assert_array_equal(found["hub"], model.hub)
    assert found["trim"]["converged"].tolist() == [1, 1, 0]
    assert "Mach" in found["trim"]["reason"][2]
    np.testing.assert_array_equal(found["trim"]["collective"], model.trim.collective)


def test_one_point_has_no_pages(tmp_path):
    model = pp.load_case("xv15-uncoupled").linearize(140.0)
    found = saved(model, tmp_path)
    np.testing.assert_array_equal(found["K"], model.K)
    assert found["airspeed"] == 140.0


def test_a_sweep(model, tmp_path):
    results = sweep(model)
    found = saved(results, tmp_path)
    for name in ("eigenvalue", "frequency", "damping_ratio", "shape", "whirl"):
        np.testing.assert_array_equal(found[name], results[name].values)
        assert tuple(np.atleast_1d(found["dims"][name])) == results[name].dims
    assert found["mode"].tolist() == results.mode.values.tolist()
    assert found["units"]["airspeed"] == "m/s"
    assert found["attributes"]["eigen_solves"] == results.attrs["eigen_solves"]


def test_any_dataset_and_its_names(tmp_path):
    results = xarray.Dataset(
        {
            "rotor.precone": ("design", [0.01, 0.02], {"units": "rad"}),
            "support.modes[beam].x": ("design", [1.0, 2.0]),
            "stable": ("design", [True, False]),
            "end": ((), 3.0),
            "_hidden": ((), 4.0),
            "dims": ((), 5.0),
            "count": ("design", np.array([1, 2], dtype=np.int64)),
            "text": ((), "η of β"),
            "when": ("design", np.array(["2024-05-01", "2024-05-02"], dtype="datetime64[ns]")),
        },
        attrs={"made by": "a test", "n": 3},
    )
    found = saved(results, tmp_path)
    names = {own: name for name, own in found["names"].items()}
    assert names["rotor.precone"] == "rotor_precone"
    assert names["end"] != "end"
    assert names["dims"] != "dims"
    for own, name in names.items():
        if own not in ("text", "when"):
            np.testing.assert_array_equal(found[name], results[own].values)
    assert found["text"] == "η of β"
    assert found["when"][0].startswith("2024-05-01")
    assert found["units"] == {"rotor_precone": "rad"}
    assert found["attributes"] == {"made_by": "a test", "n": 3}
    assert all(MATLAB_NAME.fullmatch(name) for name in all_names(found))


def test_names_stay_apart():
    found = matlab_names(["a.b", "a_b", "a b", "x" * 70, "x" * 80, "for", "1st", "β", "a_"])
    assert len(set(found.values())) == len(found)
    assert all(MATLAB_NAME.fullmatch(name) for name in found.values())
    assert found["a.b"] == "a_b"
    assert found["a_"] == "a_"


@pytest.mark.parametrize(
    ("name", "message"),
    [("results.txt", "must end in .mat"), ("nowhere/results.mat", "must be in a folder that exists")],
)
def test_where_it_cannot_be(model, tmp_path, name, message):
    with pytest.raises(pp.InputError, match=message):
        save_matlab(model, tmp_path / name)


def test_what_it_cannot_be(tmp_path):
    with pytest.raises(pp.InputError, match="results = list: must be a LinearModel or an"):
        save_matlab([1.0], tmp_path / "results.mat")
    assert not list(tmp_path.iterdir())


def test_what_a_mat_file_cannot_hold_is_told_before_it_is_written(tmp_path):
    large = xarray.Dataset({"x": ("point", np.broadcast_to(1.0, (2**28,)))})  # 2 GB, and no memory
    with pytest.raises(pp.InputError, match=r"results = x: must be below 2 GB in a \.mat file"):
        save_matlab(large, tmp_path / "x.mat")
    assert list(tmp_path.iterdir()) == []
