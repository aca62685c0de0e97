"""Lift that lags in every analysis that takes a model: derivatives, studies, maps, the explorer, files for others.

Expected values come from eigenvalues of the model's own matrices, by differences or read back from a file.
"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.io import loadmat
from scipy.linalg import eigvals
from scipy.optimize import linear_sum_assignment

import proprotor as pp
from proprotor.explore.analysis import live_modes
from proprotor.model.first_order import state_matrix
from proprotor.nastran.dmig import read_dmig
from proprotor.nastran.text_files import lines_of
from proprotor.plots import mode_motion
from proprotor.stability.boundaries import scan_speeds
from proprotor.stability.boundary_lines import boundary_lines
from proprotor.study.batch import Analysis
from proprotor.study.study import study
from tests.stability.test_sensitivity import EIGENVALUE, extrapolated, largest_step

LAGGED = {"lift": "lagged"}
AIRSPEED = 150.0
GRID, FIRST = 11, 101


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


@pytest.fixture(scope="module")
def six_blades(case):
    rotor = case.rotor
    return pp.Case("six blades", replace(rotor, n_blades=6), case.operation, case.support)


def assert_same_roots(found, expected, relative):
    """Each root has a partner, whatever the order."""
    apart = np.abs(np.asarray(found)[:, None] - np.asarray(expected))
    assert apart.shape[0] == apart.shape[1]
    rows, columns = linear_sum_assignment(apart)
    assert apart[rows, columns].max() < relative * np.abs(expected).max()


# Derivatives ------------------------------------------------------------------------------------------------

INPUTS = (
    "rotor.radius",
    "rotor.airfoil.lift_slope",
    "rotor.lock_number",
    "rotor.control_stiffness",
    "operation.density",
    "operation.rotor_speed",
    "support.modes[beam].frequency",
)


def test_derivatives_of_roots_through_the_lag(case):
    """Of every root, those of the lag too, beside differences extrapolated to no step."""
    inputs = [path for path in INPUTS if path in case.given]
    assert len(inputs) >= 5
    found = case.sensitivity("eigenvalue", airspeed=AIRSPEED, wrt=inputs, **LAGGED)
    values = found.eigenvalue.values
    assert {"cyclic slow lift", "collective fast lift 2"} <= set(found.mode.values.tolist())
    for path in inputs:

        def values_at(numbers, path=path):
            every = np.linalg.eigvals(state_matrix(case.vary({path: numbers}).linearize(AIRSPEED, **LAGGED)))
            nearest = np.abs(every[:, None, :] - values[:, None]).argmin(axis=2)
            return np.take_along_axis(every, nearest, axis=1)

        own = float(case.given[path].si)
        limit = extrapolated(values_at, own, largest_step(case, path))
        exact = found.derivative.sel(input=path).values
        scale = np.maximum(np.abs(exact), 1e-4 * np.abs(values) / abs(own))
        assert (np.abs(limit - exact) / scale).max() < EIGENVALUE, path


def test_derivatives_of_the_flutter_speed_through_the_lag(case):
    path, step = "support.modes[beam].frequency", 1e-3
    scan = "300:420:20kt"
    found = case.sensitivity("flutter_speed", airspeed=scan, wrt=[path], **LAGGED)
    own = float(case.given[path].si)
    ahead, behind = (
        case.vary({path: own * (1 + sign * step)}).flutter_point(scan, **LAGGED).speed for sign in (1, -1)
    )
    difference = (ahead - behind) / (2 * step * own)
    assert found.derivative.item() == pytest.approx(difference, rel=1e-3)
    assert found.attrs["value"] == pytest.approx(case.flutter_point(scan, **LAGGED).speed, rel=1e-9)


# Many designs -----------------------------------------------------------------------------------------------

PLAN = {"rotor.precone": np.radians([1.0, 2.0, 3.0]), "support.modes[beam].frequency": [20.0, 21.0]}
SPEEDS = np.array([110.0, 150.0, 330.0])  # at the last the tip is faster than sound


def test_a_study_that_stops_goes_on_and_holds_the_roots_of_each_design(case, tmp_path, monkeypatch):
    def run(folder=None):
        return study(
            case,
            PLAN,
            SPEEDS,
            quantities=("eigenvalue", "vectors", "modes", "flutter"),
            batch=6,
            checkpoint=folder,
            workers=1,
            **LAGGED,
        )

    whole, analyse, count = run(), Analysis.__call__, [0]

    def stops(self, batch):
        count[0] += 1
        if count[0] == 3:
            raise KeyboardInterrupt
        return analyse(self, batch)

    monkeypatch.setattr(Analysis, "__call__", stops)
    with pytest.raises(KeyboardInterrupt):
        run(tmp_path)
    monkeypatch.setattr(Analysis, "__call__", analyse)
    again = run(tmp_path)
    assert again.identical(whole)
    for precone in (0, 2):
        for beam in (0, 1):
            values = {
                path: numbers[place]
                for (path, numbers), place in zip(PLAN.items(), (precone, beam), strict=True)
            }
            model = case.vary(values).linearize(SPEEDS[:2], **LAGGED)
            for speed, matrix in enumerate(state_matrix(model)):
                assert_same_roots(
                    whole.eigenvalue.values[precone, beam, speed], np.linalg.eigvals(matrix), 1e-11
                )
    assert np.isnan(whole.eigenvalue.values[:, :, 2]).all()


def test_one_boundary_by_search_by_map_and_by_study(case):
    point = case.flutter_point("300:420:20kt", **LAGGED)
    axes = {"airspeed": "300:420:20kt", "rotor.precone": [case.given["rotor.precone"].si, 0.06]}
    found = case.stability_map(axes, **LAGGED)
    lines = [line for line in boundary_lines(case, found, **LAGGED) if line.mode == point.mode]
    crossed = [line.x[line.y == axes["rotor.precone"][0]] for line in lines]
    assert np.abs(np.concatenate(crossed) / point.speed - 1).min() < 1e-4
    designs = study(
        case, {"rotor.precone": axes["rotor.precone"]}, "300:420:20kt", quantities="flutter", **LAGGED
    )
    assert designs.flutter_speed.values[0] == pytest.approx(point.speed, rel=2e-3)


def test_the_explorer_has_the_roots_of_a_sweep(case):
    speeds = scan_speeds(case, 60)
    live, exact = live_modes(case, speeds, **LAGGED), case.sweep(speeds, **LAGGED)
    assert live.names == exact.mode.values.tolist()
    good = np.isfinite(exact.eigenvalue.values).all(axis=1)
    for found, expected in zip(live.eigenvalue[good], exact.eigenvalue.values[good], strict=True):
        assert_same_roots(found, expected, 1e-9)


def test_motions_are_drawn_where_something_swings(case):
    for mode in ("chord", "cyclic slow lift"):
        motion = mode_motion.mode_motion(case, AIRSPEED, mode, **LAGGED)
        assert "lagged" in motion.stamp["options"]
    with pytest.raises(pp.InputError, match="collective fast lift"):
        mode_motion.mode_motion(case, AIRSPEED, "collective fast lift", **LAGGED)


# Blades beyond three ----------------------------------------------------------------------------------------


def test_reactionless_modes_have_names_and_the_others_stay(six_blades):
    without, model = (
        six_blades.linearize(AIRSPEED, reactionless=choice, **LAGGED) for choice in (False, True)
    )
    few, every = (one.modes() for one in (without, model))
    names = every.name.values.tolist()
    assert len(set(names)) == len(names)
    assert {
        "cyclic slow lift", "cyclic slow lift, harmonic 2", "cyclic fast lift 2, harmonic 2",
        "differential slow lift", "differential fast lift 2",
    } <= set(names)  # fmt: skip
    for value, name in zip(few.eigenvalue.values, few.name.values.tolist(), strict=True):
        assert np.abs(every.eigenvalue.values - value).min() < 1e-9 * abs(value), name
    values = np.concatenate([np.linalg.eigvals(state_matrix(part)) for part in blocks(model)])
    assert_same_roots(np.linalg.eigvals(state_matrix(model)), values, 1e-11)


def blocks(model):
    return [model.submodel(tuple(model.dofs[place] for place in block)) for block in model.blocks]


def test_a_sweep_of_reactionless_motions(six_blades):
    sweep = six_blades.sweep("240:320:20kt", reactionless=True, **LAGGED)
    assert not (sweep.reason != "").any()
    turning = sweep.eigenvalue.sel(mode="cyclic slow lift, harmonic 2").values.imag
    np.testing.assert_allclose(turning / float(six_blades.operation.rotor_speed), 2.0, atol=0.05)


# Files for others -------------------------------------------------------------------------------------------


def roots_of(mass, damping, stiffness):
    """Finite roots of M s² + C s + K by a generalised problem; a rate without stiffness has a root at zero besides."""
    zero, one = np.zeros(mass.shape), np.eye(len(mass))
    return eigvals(np.block([[zero, one], [-stiffness, -damping]]), np.block([[one, zero], [zero, mass]]))


@pytest.mark.parametrize("options", [{}, {"reactionless": True}])
def test_direct_matrix_input_has_the_roots_of_the_model(six_blades, options, tmp_path):
    model = six_blades.linearize(AIRSPEED, **LAGGED, **options)
    axes = {"x": "T1", "y": "T2", "z": "T3", "alpha_x": "R1", "alpha_y": "R2", "alpha_z": "R3"}
    pp.save_dmig(model, tmp_path / "rotor.bdf", grid=GRID, first_extra_point=FIRST, hub=axes)
    read = read_dmig(lines_of(tmp_path / "rotor.bdf"))
    own, support = len(model.rotor.dofs) - 6, six_blades.support
    places = [read.names.index(f"{GRID}.{part}") for part in axes.values()]
    places += [read.names.index(str(FIRST + extra)) for extra in range(own)]
    modes = len(support.names)
    onto = np.block([[support.hub, np.zeros((6, own))], [np.zeros((own, modes)), np.eye(own)]])
    bare = model.M[:modes, :modes] - support.hub.T @ model.rotor.M[:6, :6] @ support.hub
    whole = []
    for name, wing in (("MROTOR", bare), ("BROTOR", support.damping), ("KROTOR", support.stiffness)):
        matrix = onto.T @ read.matrices[name][np.ix_(places, places)] @ onto
        matrix[:modes, :modes] += wing
        whole.append(matrix)
    found, expected = roots_of(*whole), np.linalg.eigvals(state_matrix(model))
    at_rest = np.argsort(np.abs(found))[: len(found) - len(expected)]  # of rates, which have no displacement
    assert np.abs(found[at_rest]).max() < 1e-6
    assert_same_roots(np.delete(found, at_rest), expected, 1e-8)


def test_files_of_matlab_and_netcdf_have_the_roots_of_the_model(case, tmp_path):
    model = case.linearize(AIRSPEED, **LAGGED)
    pp.save_matlab(model, tmp_path / "model.mat")
    content = loadmat(tmp_path / "model.mat", simplify_cells=True)
    assert content["state_space"]["states"][-1] == "fast lift 2_1s rate"
    expected = np.linalg.eigvals(state_matrix(model))
    assert_same_roots(np.linalg.eigvals(content["state_space"]["A"]), expected, 1e-12)
    sweep = case.sweep([AIRSPEED, AIRSPEED + 5], **LAGGED)
    pp.save_results(sweep, tmp_path / "sweep.nc")
    again = pp.load_results(tmp_path / "sweep.nc")
    assert again.identical(sweep) and "lagged" in again.attrs["options"]
    oscillating = expected[expected.imag > 1]
    for value in again.eigenvalue.values[0]:
        if value.imag > 1:
            assert np.abs(oscillating - value).min() < 1e-9 * abs(value)


# Aircraft ---------------------------------------------------------------------------------------------------


def test_derivatives_of_an_aircraft_through_the_lag():
    aircraft = pp.load_case("xv15-aircraft")
    path, step = "rotor.airfoil.lift_slope", 1e-3
    mode = "symmetric chord"
    found = aircraft.sensitivity("eigenvalue", airspeed=AIRSPEED, wrt=[path], mode=mode, **LAGGED)
    own, value = float(aircraft.given[path].si), found.eigenvalue.item()
    moved = [
        np.linalg.eigvals(
            state_matrix(aircraft.vary({path: own + sign * step}).linearize(AIRSPEED, **LAGGED))
        )
        for sign in (1, -1)
    ]
    ahead, behind = (roots[np.abs(roots - value).argmin()] for roots in moved)
    assert found.derivative.item() == pytest.approx((ahead - behind) / (2 * step), rel=1e-5)
