"""Every analysis on a whole aircraft: two rotors, halves that do not couple, and sides that differ."""

from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp
from proprotor.explore.analysis import live_modes
from proprotor.model.first_order import state_matrix
from proprotor.model.rotor_model import rotor_model
from proprotor.model.several_rotors import MountedRotor, mount_rotors
from proprotor.model.side import Side
from proprotor.plots.mode_motion import mode_motion
from proprotor.report import analyse, html_of, report_document
from proprotor.rotor.motions import half_of
from proprotor.stability.modes import decomposition
from proprotor.stability.origins import model_parts
from tests import airframes

TRAIN = {
    "drive_train.mast_stiffness": "2.5e5 N*m/rad",
    "drive_train.engine_inertia": "45 kg*m**2",
    "drive_train.interconnect_stiffness": "3e4 N*m/rad",
}
OUT = {"left.drive_train.engine_inertia": "4 kg*m**2", "left.rotor.control_stiffness": "18000 ft*lbf/rad"}
SPEEDS = np.linspace(120.0, 215.0, 20)


@pytest.fixture(scope="module")
def aircraft():
    return pp.load_case("xv15-aircraft", TRAIN)


@pytest.fixture(scope="module")
def engine_out():
    return pp.load_case("xv15-aircraft", TRAIN | OUT)


def test_modes_have_the_names_of_one_rotor_with_their_half_before_them(aircraft):
    found = aircraft.sweep(SPEEDS)
    names = found.mode.values.tolist()
    of_rotor = pp.load_case("xv15-uncoupled").sweep(SPEEDS[:2]).mode.values.tolist()[3:]
    for half in ("symmetric", "antisymmetric"):
        own = {half_of(name)[1] for name in names if half_of(name)[0] == half}
        assert {*of_rotor, "mast twist", "beam", "chord", "torsion"} <= own
    assert {"symmetric heave", "symmetric surge", "symmetric pitch"} <= set(names)
    assert {"antisymmetric sway", "antisymmetric roll", "antisymmetric yaw"} <= set(names)
    for name in names:
        dominant = {half_of(text)[0] for text in found.dominant.sel(mode=name).values.tolist() if text}
        assert dominant == {half_of(name)[0]}


@pytest.mark.parametrize("kind", ["aircraft", "engine_out"])
def test_the_parts_of_the_matrices_make_the_model(kind, request):
    case = request.getfixturevalue(kind)
    model = case.linearize(150.0)
    assert model.halves_couple == (kind == "engine_out")
    parts = model_parts(case, model)
    assert {"drive train", "interconnect shaft", "support inertia", "inertia"} <= set(parts)
    for place, name in enumerate("MCK"):
        whole = getattr(model, name)
        np.testing.assert_allclose(
            sum(part[place] for part in parts.values()), whole, rtol=0, atol=1e-12 * np.abs(whole).max()
        )
    shaft = parts["interconnect shaft"].K
    strained = [model.dofs.index(f"antisymmetric {name}") for name in ("azimuth", "mast twist")]
    np.testing.assert_array_equal(shaft[np.ix_(strained, strained)], np.full((2, 2), 2 * 3e4))
    assert np.count_nonzero(shaft) == 4
    found = case.attribution(150.0)
    assert np.abs(found.contribution.sum("origin")).max() < 1e-9 * np.abs(found.contribution).max()


@pytest.mark.parametrize("kind", ["aircraft", "engine_out"])
def test_derivatives_of_the_flutter_speed_are_those_of_differences(kind, request):
    case = request.getfixturevalue(kind)
    paths = ["rotor.control_stiffness", "drive_train.interconnect_stiffness", "support.beam_stiffness"]
    found = case.sensitivity(wrt=paths, airspeed=SPEEDS)
    for path, exact in zip(paths, found.derivative.values, strict=True):
        value = float(case.given[path].si)
        speeds = [case.vary({path: value * (1 + step)}).flutter_point(SPEEDS).speed for step in (1e-4, -1e-4)]
        assert exact == pytest.approx((speeds[0] - speeds[1]) / (2e-4 * value), rel=1e-4, abs=1e-12)
    if kind == "aircraft":
        assert found.attrs["mode"].startswith("symmetric") and found.derivative.values[1] == 0


def test_a_study_has_the_modes_of_each_aircraft(aircraft):
    inputs = {"operation.density": [1.0, 1.1]}
    found = pp.study(aircraft, inputs, SPEEDS[:3], quantities=("eigenvalue", "modes", "vectors"))
    for density in inputs["operation.density"]:
        alone = aircraft.vary({"operation.density": density}).sweep(SPEEDS[:3])
        here = found.sel({"operation.density": density})
        for point in range(3):
            names, values = here.mode_name.values[point], here.mode_eigenvalue.values[point]
            for name, value in zip(names, values, strict=True):
                if value.imag >= 0 and name in alone.mode:
                    same = alone.eigenvalue.sel(mode=name).values[point]
                    assert (
                        value == pytest.approx(same, rel=1e-8, abs=1e-8)
                        or f"{name}, second root" in alone.mode
                    )


def test_a_map_and_boundaries_against_an_input_end_where_flutter_begins(aircraft):
    densities, speeds = np.array([1.1, 1.2]), np.linspace(150.0, 215.0, 6)
    found = aircraft.stability_map({"airspeed": speeds, "operation.density": densities})
    against = aircraft.boundary_against({"operation.density": densities}, SPEEDS)
    on_lines = np.isin(found.boundary.values[:, 1], densities)
    vertices = found.boundary.values[on_lines]
    for density, first in zip(densities, against["first"].values, strict=True):
        flutter = aircraft.vary({"operation.density": density}).flutter_point(SPEEDS)
        assert first == pytest.approx(flutter.speed, rel=1e-9)
        assert np.abs(vertices[vertices[:, 1] == density, 0] - flutter.speed).min() < 1e-6 * flutter.speed
    assert set(against.kind.values.ravel().tolist()) <= {"flutter", "rigid body", "divergence", ""}


def test_the_explorer_and_the_report_show_both_halves(aircraft):
    live = live_modes(aircraft, SPEEDS)
    flutter = aircraft.flutter_point(SPEEDS)
    assert live.flutter.mode == flutter.mode and live.flutter.start == pytest.approx(flutter.speed, rel=0.01)
    unstable = replace(live, unstable=[replace_mode(live.flutter, "symmetric pitch", 100.0), live.flutter])
    assert unstable.flutter is live.flutter  # an unstable flight is no flutter
    found = analyse(aircraft, SPEEDS, {})
    page = html_of(report_document(aircraft, found, settings={}, deck_hash="", date="", unit="kt"))
    for text in (flutter.mode, "antisymmetric", "symmetric regressive gimbal"):
        assert text in page


def replace_mode(found, mode, start):
    return found._replace(mode=mode, start=start)


@pytest.mark.parametrize("mode", ["symmetric beam", "antisymmetric chord", "symmetric pitch"])
def test_a_mode_is_drawn_with_both_sides(aircraft, mode):
    """The left side is the mirror image of the right one, or its opposite."""
    parts = {part.name: part for part in mode_motion(aircraft, 150.0, mode).parts}
    sign = -1 if mode.startswith("anti") else 1
    for name in ("wing", "mast", "blade 1", "blade 3", "tip path"):
        right, left = parts[name], parts[f"left {name}"]
        np.testing.assert_allclose(left.motion * [1, -1, 1], sign * right.motion, rtol=0, atol=1e-12)
        apart = right.points * [1, -1, 1] - left.points
        np.testing.assert_allclose(
            apart, np.broadcast_to([0, 2 * (4.191 + 0.7112), 0], apart.shape), atol=1e-9
        )
        assert np.abs(right.motion).max() > 0


def test_an_aircraft_that_turns_as_one_body_is_drawn_without_bending():
    """Roots of the wings move as the hubs do, about the same axis."""
    case = airframes.aircraft(airframes.half("symmetric", 3, flexibility=1e-6))
    motion = {part.name: part for part in mode_motion(case, 110.0, "symmetric pitch").parts}
    points, moved = motion["wing"].points, motion["wing"].motion
    design = np.concatenate([np.broadcast_to(np.eye(3), (len(points), 3, 3)), -cross(points)], axis=2)
    rigid, *_ = np.linalg.lstsq(design.reshape(-1, 6).astype(complex), moved.ravel(), rcond=None)
    rest = moved.ravel() - design.reshape(-1, 6) @ rigid
    assert np.abs(rest).max() < 1e-3 * np.abs(moved).max()


def cross(points):
    """Return matrices (k, 3, 3) whose product with a turn is points × turn."""
    x, y, z = points.T
    none = np.zeros_like(x)
    return np.stack([none, -z, y, z, none, -x, -y, x, none], axis=1).reshape(-1, 3, 3)


def test_a_file_for_matlab_has_the_inputs_of_both_halves(aircraft, tmp_path):
    from scipy.io import loadmat

    pp.save_matlab(aircraft.linearize(150.0), tmp_path / "aircraft.mat")
    found = loadmat(tmp_path / "aircraft.mat", squeeze_me=True)
    assert found["B"].shape == (len(found["dofs"]), 12) and found["inputs"][6] == "antisymmetric collective"


def test_a_left_side_is_not_overruled_by_the_options_of_a_result(engine_out):
    """What the right side brings is in force on the right side alone, also where an analysis goes on from a result."""
    boundary = engine_out.flutter_point(SPEEDS).boundary
    found = engine_out.sensitivity(wrt=["rotor.precone"], airspeed=SPEEDS)
    assert found.attrs["value"] == boundary.position
    same = engine_out.linearize(150.0, drive_train=engine_out.drive_train)
    np.testing.assert_array_equal(same.M, engine_out.linearize(150.0).M)
    other = pp.DriveTrain(drive_inertia=1.0)  # an option of its own is one for both sides
    both = engine_out.linearize(150.0, drive_train=other)
    assert "symmetric mast twist" not in both.dofs


def test_the_side_counts_in_the_fingerprint_of_a_case():
    from proprotor.model.deck_fingerprint import deck_fingerprint

    case = airframes.aircraft()
    other = replace(case, left=Side(replace(case.rotor, precone=0.02), case.operation))
    assert deck_fingerprint(case) != deck_fingerprint(other)


def test_a_downstop_lost_on_either_side_is_the_same_aircraft_in_a_mirror():
    left = pp.load_case("xv15-aircraft", TRAIN | {"left.support.downstop": "false"})
    right = pp.load_case(
        "xv15-aircraft", TRAIN | {"support.downstop": "false", "left.support.downstop": "true"}
    )
    found, mirrored = (decomposition(case.linearize([120.0, 180.0])).values for case in (left, right))
    for one, other in zip(found, mirrored, strict=True):
        apart = np.abs(one[:, None] - other).min(axis=1)
        assert (apart <= 1e-7 * np.maximum(np.abs(one), 1)).all()
    assert left.linearize(150.0).halves_couple
    boundaries = left.flutter_point(SPEEDS).boundaries
    assert [one.kind for one in boundaries] == ["flutter"] * len(boundaries)
    assert boundaries[0].mode == "chord"  # the structure has neither symmetry there


@pytest.mark.parametrize("settings", [{}, OUT], ids=["equal sides", "an engine out"])
def test_the_aircraft_of_a_deck_has_the_roots_of_both_rotors_in_their_own_coordinates(settings):
    """Without interconnect and mast, which the other way of mounting does not know."""
    case = pp.load_case("xv15-aircraft", {"drive_train.engine_inertia": "45 kg*m**2"} | settings)
    speeds = np.array([100.0, 180.0])
    frame = case.support.at(speeds, case.operation.density)
    doubled = {kind: 2 * getattr(frame, kind) for kind in ("mass", "damping", "stiffness")}
    sides = [case, case if case.left is None else case.left]
    rotors = [rotor_model(side.rotor, side.operation, speeds, drive_train=side.drive_train) for side in sides]
    mounted = {
        "right": MountedRotor(rotors[0], frame.hub),
        "left": MountedRotor(rotors[1], airframes.MIRROR @ frame.left_hub, mirrored=True),
    }
    names = tuple(name.replace(" ", "_") for name in frame.names)
    whole = np.linalg.eigvals(state_matrix(mount_rotors(mounted, replace(frame, names=names, **doubled))))
    for own, every in zip(decomposition(case.linearize(speeds)).values, whole, strict=True):
        apart = np.abs(own[:, None] - every).min(axis=1)
        assert (apart <= 1e-9 * np.maximum(np.abs(own), 1)).all()
