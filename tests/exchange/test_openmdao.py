"""The component for OpenMDAO: exact partial derivatives against differences, and points that fail."""

import numpy as np
import pytest

import proprotor as pp

om = pytest.importorskip("openmdao.api")

from proprotor.exchange.openmdao import GrowthConstraint, WhirlFlutter, variable_name  # noqa: E402

INPUTS = ["rotor.precone", "support.modes[chord].frequency"]
SEARCH = "375:395:10kt"  # around the boundary of the XV-15, at about 384 kt
DIFFERENCES = (
    2e-5  # relative: central differences with steps of 1e-5 of the input, of numbers known to about 1e-12
)


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


@pytest.fixture
def problem(case, tmp_path, monkeypatch):
    """A problem of one component, run where OpenMDAO may write its files."""
    monkeypatch.chdir(tmp_path)

    def build(**options):
        made = om.Problem(reports=False)
        made.model.add_subsystem("wing", WhirlFlutter(case=case, **options), promotes=["*"])
        made.setup()
        return made

    return build


def assert_exact(problem):
    """Partial derivatives against central differences, and every one of them there."""
    found = problem.check_partials(
        out_stream=None, method="fd", form="central", step=1e-5, step_calc="rel_avg"
    )["wing"]
    for pair, part in found.items():
        size = np.abs(part["J_fd"]).max()
        assert size > 0, pair
        np.testing.assert_allclose(
            part["J_fwd"], part["J_fd"], rtol=DIFFERENCES, atol=DIFFERENCES * size, err_msg=str(pair)
        )
    return found


def test_flutter_speed(case, problem):
    made = problem(inputs=INPUTS, search=SEARCH)
    made.run_model()
    point = case.flutter_point(SEARCH)
    assert made.get_val("flutter_speed")[0] == pytest.approx(point.speed, rel=1e-12)
    assert made.get_val("flutter_speed", units="kn")[0] == pytest.approx(point.speed * 3600 / 1852, rel=1e-9)
    assert made.get_val("flutter_frequency")[0] == pytest.approx(point.frequency, rel=1e-12)
    found = assert_exact(made)
    assert set(found) == {
        (of, variable_name(path)) for of in ("flutter_speed", "flutter_frequency") for path in INPUTS
    }


def test_damping_at_speeds(case, problem):
    made = problem(inputs=INPUTS[:1], flutter_speed=False, damping=["chord", "beam"], airspeed="250:300:50kt")
    made.run_model()
    sweep = case.sweep("250:300:50kt")
    for mode in ("chord", "beam"):
        expected = sweep.damping_ratio.sel(mode=mode)
        np.testing.assert_allclose(made.get_val(f"damping_{mode}"), expected, rtol=1e-9)
    found = assert_exact(made)
    assert len(found) == 4
    assert ("damping_chord", "airspeed") in found


def test_speeds_in_any_order_and_units_of_the_user(case, problem):
    made = problem(
        inputs={"cone": "rotor.precone"},
        flutter_speed=False,
        damping=["beam"],
        airspeed=[150.0, 100.0, 150.0],
    )
    made.set_val("cone", 2.0, units="deg")
    made.run_model()
    varied = (
        case.vary({"rotor.precone": np.deg2rad(2.0)})
        .sweep(np.array([100.0, 150.0]))
        .damping_ratio.sel(mode="beam")
    )
    np.testing.assert_allclose(made.get_val("damping_beam"), varied.values[[1, 0, 1]], rtol=1e-9)


@pytest.mark.parametrize(
    ("options", "value", "message"),
    [
        ({"search": "100:150:25kt"}, None, "flutter_speed: nothing becomes unstable between 51.4444"),
        ({"search": SEARCH, "mode": "torsion"}, None, "flutter_speed = torsion: has no boundary"),
        ({"search": SEARCH}, -1.0, "rotor.control_stiffness = -1 N\\*m/rad: must not be negative"),
        (
            {"flutter_speed": False, "damping": ["beam"], "airspeed": 330.0},
            None,
            "airspeed = 330 m/s: tip Mach",
        ),
        ({"flutter_speed": False, "damping": ["bean"], "airspeed": 150.0}, None, "did you mean beam"),
    ],
)
def test_points_that_fail_tell_why(problem, options, value, message):
    made = problem(inputs=[*INPUTS, "rotor.control_stiffness"], **options)
    if value is not None:
        made.set_val("rotor_control_stiffness", value)
    with pytest.raises(om.AnalysisError, match=message):
        made.run_model()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"inputs": ["rotor.precon"]}, "did you mean rotor.precone"),
        ({"inputs": "rotor.precone"}, "inputs = rotor.precone: must be a list of paths"),
        ({"damping": "beam", "airspeed": 150.0}, "damping = beam: must be a list of modes"),
        ({"damping": ["beam"]}, "airspeed: must be given for the damping"),
        ({"flutter_speed": False}, "damping: must name a mode"),
    ],
)
def test_setups_that_mean_nothing(problem, options, message):
    with pytest.raises(pp.InputError, match=message):
        problem(**options)


def test_every_unit_of_a_deck_is_one_of_openmdao(case, problem):
    made = problem(inputs=list(pp.design_inputs(case)), search=SEARCH)
    assert made.get_val("rotor_precone", units="deg")[0] == pytest.approx(2.5)
    assert made.get_val("operation_rotor_speed", units="rpm")[0] == pytest.approx(458)


# The constraint ------------------------------------------------------------------------------------------------------


@pytest.fixture
def constrained(case, tmp_path, monkeypatch):
    """A problem of the constraint alone."""
    monkeypatch.chdir(tmp_path)

    def build(**options):
        made = om.Problem(reports=False)
        made.model.add_subsystem("wing", GrowthConstraint(case=case, **options), promotes=["*"])
        made.setup()
        return made

    return build


@pytest.mark.parametrize("airspeed", ["100:200:25kt", "300:420:20kt"], ids=["stable", "unstable"])
def test_the_constraint_exists_at_every_design(case, constrained, airspeed):
    made = constrained(inputs=INPUTS, airspeed=airspeed, level=0.001, sharpness=50.0)
    made.run_model()
    found = case.growth_constraint(airspeed, (), level=0.001, sharpness=50.0)
    assert made.get_val("growth", units="1/min")[0] == pytest.approx(60 * found.constraint.item(), rel=1e-12)
    assert set(assert_exact(made)) == {("growth", variable_name(path)) for path in INPUTS}


def test_the_constraint_tells_why_it_cannot_be_had(constrained):
    made = constrained(inputs=INPUTS, airspeed=[100.0, 400.0])
    with pytest.raises(om.AnalysisError, match="airspeed = 400 m/s: "):
        made.run_model()
    with pytest.raises(pp.InputError, match="airspeed: must be given for the growth"):
        constrained(inputs=INPUTS)
    with pytest.raises(pp.InputError, match=r"did you mean rotor\.precone"):
        constrained(inputs=["rotor.precon"], airspeed=100.0)


def test_an_optimum_is_that_of_a_search(tmp_path, monkeypatch):
    """The least control stiffness that keeps a wing stable, by OpenMDAO and by roots of the flutter speed."""
    from scipy.optimize import brentq

    monkeypatch.chdir(tmp_path)
    wing = pp.load_case("xv15-wing")
    path = "rotor.control_stiffness"
    own = pp.design_inputs(wing)[path].si
    made = om.Problem(reports=False)
    made.model.add_subsystem(
        "scale",
        om.ExecComp(f"control = {own!r} * stiffer", control={"units": "N*m/rad"}, do_coloring=False),
        promotes=["*"],
    )
    constraint = GrowthConstraint(
        case=wing, inputs={"control": path}, airspeed="180:360:10kt", sharpness=2000.0
    )
    made.model.add_subsystem("wing", constraint, promotes=["*"])
    made.model.add_design_var("stiffer", lower=0.8, upper=4.0)
    made.model.add_objective("stiffer")
    made.model.add_constraint("growth", upper=0.0)
    made.driver = om.ScipyOptimizeDriver(optimizer="SLSQP", tol=1e-9, disp=False)
    made.setup()
    made.set_val("stiffer", 3.0)
    assert made.run_driver().success
    wanted = 360 * 1852 / 3600
    lowest = brentq(
        lambda share: wing.vary({path: share * own}).flutter_point("150:480:8kt").speed - wanted,
        1.0,
        3.0,
        xtol=1e-6,
    )
    assert lowest <= made.get_val("stiffer")[0] <= lowest * (1 + 2e-3)
