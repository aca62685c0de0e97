"""Divergence, instability of the rigid body and flutter: three named results, with the flutter of an aircraft first."""

from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp
from proprotor.stability.flutter import boundary_of
from proprotor.stability.flutter_messages import boundary_record, verdict
from proprotor.stability.kinds import flies_free, kinds
from proprotor.stability.modes import decomposition
from proprotor.support.airframe import Airframe
from tests import airframes

PITCH, BEAM, CHORD = 90.0, 105.0, 130.0  # m/s: where each of three uncoupled motions becomes unstable
SCAN = np.linspace(60.0, 150.0, 19)


def three_motions(density, pitch=PITCH, beam=BEAM, chord=CHORD):
    """An airframe whose coordinates do not move the hubs: pitch and chord lose their damping, beam its stiffness."""
    mass, frequency = np.array([9e3, 400.0, 400.0]), np.array([0.0, 12.0, 25.0])
    damping = np.array([3e4, 600.0, 900.0])
    gone = np.array([1 / pitch, 0.0, 1 / chord])
    stiffness = mass * frequency**2
    lost = np.array([-8.0, stiffness[1] / (density * beam**2), 0.0])
    hub = np.zeros((6, 3))
    names = ("symmetric pitch", "symmetric beam", "antisymmetric chord")
    return Airframe(
        names=names,
        mass=np.diag(mass),
        damping=np.diag(damping),
        stiffness=np.diag(stiffness),
        hub=hub,
        includes_rotor=False,
        left_hub=hub,
        symmetry=tuple(name.split()[0] for name in names),
        rigid_body=names[:1],
        airload_damping=np.diag(-damping * gone / density),
        airload_stiffness=np.diag(-lost),
    )


@pytest.fixture(scope="module")
def case():
    base = airframes.aircraft(airframes.half("symmetric", 3))
    return replace(base, support=three_motions(float(base.operation.density)))


def test_each_crossing_has_its_kind(case):
    found = case.boundaries(SCAN).boundaries
    told = [(one.position, one.mode, one.kind, one.event) for one in found]
    positions, modes, kind, events = zip(*told, strict=True)
    np.testing.assert_allclose(positions, [PITCH, BEAM, CHORD], rtol=1e-9)
    assert modes == ("symmetric pitch", "symmetric beam", "antisymmetric chord")
    assert kind == ("rigid body", "divergence", "flutter")
    assert events[0] == "rigid-body instability of symmetric pitch begins"
    assert events[1:] == ("divergence of symmetric beam begins", "flutter of antisymmetric chord begins")
    assert "Hz" in repr(found[0]) and "Hz" not in repr(found[1])


def test_the_flutter_of_an_aircraft_leads_and_the_others_are_listed(case):
    found = case.flutter_point(SCAN)
    assert found.speed == pytest.approx(CHORD) and found.kind == "flutter"
    assert found.boundary is found.boundaries[2] and boundary_of(found, None) is found.boundary
    assert boundary_of(found, "symmetric beam").kind == "divergence"
    sentences = list(verdict(found, None, "m/s", 1.0))
    assert sentences == [
        "At 90.00 m/s rigid-body instability of symmetric pitch begins.",
        "At 105.00 m/s divergence of symmetric beam begins.",
        "Flutter speed 130.00 m/s (antisymmetric chord, flutter).",  # last, where people look
    ]
    assert repr(found).startswith("FlutterPoint: 252.70 KTAS (130 m/s), flutter of antisymmetric chord")
    assert "rigid-body instability of symmetric pitch begins" in repr(found)
    assert [boundary_record(one, case)["kind"] for one in found.boundaries] == [
        "rigid body",
        "divergence",
        "flutter",
    ]


def test_an_aircraft_without_flutter_has_no_flutter_speed(case):
    calm = replace(case, support=three_motions(float(case.operation.density), chord=1e4))
    found = calm.flutter_point(SCAN)
    assert np.isnan(found.speed) and found.boundary is None and not found.warning
    sentences = list(verdict(found, None, "m/s", 1.0))
    assert sentences[-1] == "No flutter begins between 60 and 150 m/s."
    assert "At 90.00 m/s rigid-body instability of symmetric pitch begins." in sentences
    assert "At 105.00 m/s divergence of symmetric beam begins." in sentences
    assert repr(found).startswith("FlutterPoint: no flutter begins")
    with pytest.raises(pp.InputError, match=r"^flutter_speed: no flutter begins between 60 and 150 m/s"):
        boundary_of(found, None)


def test_a_wing_on_its_root_leads_with_its_lowest_boundary_of_any_kind():
    case = pp.load_case("xv15-uncoupled")
    found = case.flutter_point()
    assert not flies_free(case)
    assert found.speed == next(one.position for one in found.boundaries if one.onset)
    assert {one.kind for one in found.boundaries} <= {"flutter", "divergence"}


def test_a_mode_is_of_the_rigid_body_by_more_than_half_of_its_participation():
    """Two equal oscillators with a spring between them share each of their modes; one alone has all of it."""
    from tests.known_systems import linear_model

    mass, none = np.eye(2), 0.01 * np.eye(2)
    names = ("symmetric pitch", "symmetric beam")
    kept = []
    for stiffness in (100.5, 101.0, 1e4):
        model = linear_model(mass, none, np.array([[100.0, 1.0], [1.0, stiffness]]), names)
        model = replace(model, rigid_body=names[:1])
        modes = decomposition(model).all_modes
        products = np.abs(modes.left * modes.right.T)
        shares = products[:, [0, 2]].sum(axis=1) / products.sum(axis=1)
        np.testing.assert_array_equal(kinds(model, modes) == "rigid body", shares > 0.5)
        kept.append(int((kinds(model, modes) == "rigid body").sum()))
    assert kept == [2, 2, 2]


def test_a_study_of_aircraft_tells_flutter_from_what_else_begins(case, monkeypatch):
    """Designs are densities, which a case without a deck takes by hand."""
    from proprotor.study.flutter_speeds import put_flutter_speeds
    from proprotor.study.variables import STABLE, blank

    density = float(case.operation.density)
    designs = [case] + [
        replace(case, support=three_motions(density, **more)) for more in ({"chord": 1e4}, {"pitch": 50.0})
    ]

    class Batch:
        shape, speeds = (3, len(SCAN)), SCAN

    def models(rows, speeds):
        each = [designs[row].linearize(speed) for row, speed in zip(rows, speeds, strict=True)]
        stacked = {name: np.stack([getattr(one, name) for one in each]) for name in "MCK"}
        trim = each[0].trim.broadcast((len(each),))
        speeds = np.array([one.airspeed for one in each]).real
        return replace(each[0], **stacked, trim=trim, airspeed=speeds, B=None, rotor=None)

    found = blank(("flutter",), Batch.shape, 0, 0)
    put_flutter_speeds(found, Batch(), np.arange(3), models, 0, 1e-6, flies_free=True)
    np.testing.assert_allclose(found["flutter_speed"], [CHORD, np.nan, CHORD], rtol=1e-6)
    assert found["flutter_note"].tolist() == ["", STABLE, ""]
    begins = "rigid-body instability of symmetric pitch begins at 90 m/s"
    assert found["flutter_warning"].tolist() == [
        begins,
        begins,
        "divergence of symmetric beam begins at 105 m/s",
    ]


def test_a_study_takes_the_flutter_speed_of_each_aircraft():
    """By the searches of single aircraft; the lowest crossing of a free aircraft need not be flutter."""
    case = pp.load_case("xv15-aircraft")
    inputs = {"operation.density": [1.15, 1.3]}
    found = pp.study(case, inputs, np.linspace(60.0, 215.0, 32), quantities="flutter")
    for density, speed in zip(inputs["operation.density"], found.flutter_speed.values, strict=True):
        alone = case.vary({"operation.density": density}).flutter_point(np.linspace(60.0, 215.0, 32))
        assert alone.kind == "flutter" and speed == pytest.approx(alone.speed, rel=1e-4)
