"""Margins of control loops against closed forms, python-control, and the eigenvalues of loops that were changed.

Tolerances: `EXACT` for numbers that both sides have by a search to rounding; `GRID` where python-control has a grid.
"""

from dataclasses import replace

import control
import matplotlib.pyplot as plt
import numpy as np
import pytest

import proprotor as pp
from proprotor.control.control_loop import ControlLoop
from proprotor.plots import plot_margins
from proprotor.stability.margin_ranges import Needed, decibels, kept_ranges
from proprotor.stability.margin_search import frequencies, margins_of
from proprotor.stability.modes import eigenvalues
from tests.documentation import DOCS

EXACT = 1e-7
GRID = 1e-3
CASE = pp.load_case("xv15")
SPEED = 170.0
KNOT = 1852 / 3600
DAMPER = ControlLoop(
    name="damper",
    sensors="x acceleration",
    inputs="cyclic_1c",
    gain=-0.0455 / 400,
    law=([1 / 65.0, 1.0, 0.0], np.polymul([1.0, 5.4], [1 / 20.3**2, 2 * 0.22 / 20.3, 1.0])),
    actuator_bandwidth=125.7,
    actuator_damping=0.7,
    delay=0.01,
)
GIMBAL = ControlLoop(
    name="gimbal", sensors="gimbal_1s", inputs="cyclic_1s", gain=0.1, actuator_bandwidth=60.0
)


def searched(system, delay=0.0):
    """The margins of a loop of python-control's, by its roots alone."""
    roots = np.concatenate([system.poles(), control.feedback(system).poles()])

    def transfer(omega):
        flat = np.reshape(omega, -1)
        return (system(1j * flat) * np.exp(-1j * flat * delay)).reshape(np.shape(omega))

    return margins_of(transfer, frequencies(roots, delay))


def with_more(omega, at):
    """A grid of frequencies with more of them around one, as fine as the peak there."""
    return np.unique(np.concatenate([omega, at * (1 + np.linspace(-0.02, 0.02, 2001))]))


def test_three_lags_have_the_margins_of_their_closed_form():
    """L = k/(s + 1)³: the phase is -180° at √3, where |L| = k/8; |L| = 1 at √(k^(2/3) - 1)."""
    k = 3.0
    found = searched(control.tf([k], [1.0, 3.0, 3.0, 1.0]))
    assert found.gain_margin.value == pytest.approx(8 / k, rel=EXACT)
    assert found.gain_margin.frequency == pytest.approx(np.sqrt(3), rel=EXACT)
    crossing = np.sqrt(k ** (2 / 3) - 1)
    phase = np.pi - 3 * np.arctan(crossing)
    assert found.phase_margin.value == pytest.approx(phase, rel=EXACT)
    assert found.delay_margin.value == pytest.approx(phase / crossing, rel=EXACT)
    assert found.gain_reduction.value == 0.0


def test_a_divergent_plant_that_a_gain_holds_has_a_gain_reduction_at_rest():
    """L = 3/(s - 1): stable for gains above 1/3, which is lost at rest, and for all gains above."""
    found = searched(control.tf([3.0], [1.0, -1.0]))
    assert found.gain_reduction.value == pytest.approx(1 / 3, rel=1e-6)
    assert found.gain_reduction.frequency == 0.0
    assert found.gain_margin.value == np.inf
    assert found.phase_margin.value == pytest.approx(np.arctan(np.sqrt(8)), rel=EXACT)


def test_an_integrator_with_a_delay_has_the_margins_of_its_closed_form():
    """L = k e^{-sτ}/s: |L| = 1 at k, with the phase -90° - kτ; the phase is -180° at π/2τ, where |L| = 2kτ/π."""
    k, tau = 2.0, 0.3
    found = searched(control.tf([k], [1.0, 0.0]), tau)
    assert found.gain_margin.value == pytest.approx(np.pi / (2 * k * tau), rel=1e-6)
    assert found.phase_margin.value == pytest.approx(np.pi / 2 - k * tau, rel=EXACT)
    assert found.delay_margin.value == pytest.approx((np.pi / 2 - k * tau) / k, rel=EXACT)


@pytest.mark.parametrize("seed", range(6))
def test_random_loops_have_the_margins_of_python_control(seed):
    draw = np.random.default_rng(seed)
    while True:
        lightly = [
            -z * w + 1j * w for z, w in zip(draw.uniform(0.02, 0.4, 2), draw.uniform(1, 20, 2), strict=True)
        ]
        poles = np.concatenate([-draw.uniform(0.2, 3, 2), lightly, np.conj(lightly)])
        zeros = -draw.uniform(0.5, 30, 2)
        system = control.zpk(zeros, poles, draw.uniform(10, 400))
        if (control.feedback(system).poles().real < -1e-3).all():
            break
    found = searched(system)
    gains, phases, _, at_gain, _, _ = control.stability_margins(system, returnall=True)
    above, below = gains[gains > 1], gains[(gains < 1) & (gains > 0)]
    assert found.gain_margin.value == pytest.approx(above.min() if len(above) else np.inf, rel=1e-5)
    assert found.gain_reduction.value == pytest.approx(below.max() if len(below) else 0.0, rel=1e-5)
    if len(above):
        assert found.gain_margin.frequency == pytest.approx(at_gain[gains > 1][above.argmin()], rel=1e-5)
    either = np.minimum(np.mod(phases, 360), 360 - np.mod(phases, 360))
    expected = np.radians(either.min()) if len(either) else np.inf
    assert found.phase_margin.value == pytest.approx(expected, rel=1e-5)
    disk, _, _ = control.disk_margins(
        system, with_more(np.geomspace(1e-3, 1e3, 4001), found.disk_margin.frequency)
    )
    assert found.disk_margin.value == pytest.approx(disk, rel=1e-5)
    assert found.disk_margin.value <= disk * (1 + 1e-9)  # the search finds the peak between the grid


@pytest.fixture(scope="module")
def found():
    return CASE.with_control(DAMPER, GIMBAL).margins([120.0, SPEED])


def test_python_control_has_the_same_margins_on_the_whole_rotor(found):
    """One loop cut at its actuator with the other closed, by python-control's own algebra; delays of order 8."""
    opened = CASE.open_loop(SPEED).to_state_space().to_control()

    def chain(loop):
        law = control.ss(loop.law.A, loop.law.B, loop.law.C, loop.law.D)
        w, z = loop.actuator_bandwidth, loop.actuator_damping
        lag = control.tf([w**2], [1.0, 2 * z * w, w**2]) if z else control.tf([w], [1.0, w])
        late = control.tf(*control.pade(loop.delay, 8)) if loop.delay else control.tf([1.0], [1.0])
        return control.ss(lag) * control.ss(late) * (loop.gain * law)

    def place(names, wanted):
        return names.index(wanted)

    for own, other in ((DAMPER, GIMBAL), (GIMBAL, DAMPER)):
        rows = [place(opened.output_labels, loop.sensors[0]) for loop in (own, other)]
        columns = [place(opened.input_labels, loop.inputs[0]) for loop in (own, other)]
        plant = control.ss(opened.A, opened.B[:, columns], opened.C[rows], opened.D[np.ix_(rows, columns)])
        apart = control.append(control.ss([], [], [], [[0.0]]), chain(other))
        held = control.feedback(plant, apart, sign=1)
        path = control.ss(held.A, held.B[:, :1], held.C[:1], held.D[:1, :1])
        loop = -1 * chain(own) * path
        here = found.sel(airspeed=SPEED, loop=own.name)
        for name in ("gain_margin", "gain_reduction"):
            if np.isfinite(at := float(here[f"{name}_frequency"])):
                assert complex(loop(1j * at)) == pytest.approx(-1 / float(here[name]), rel=1e-5)
        if np.isfinite(at := float(here.phase_margin_frequency)):
            crossing = complex(loop(1j * at))
            assert abs(crossing) == pytest.approx(1.0, rel=1e-5)
            assert abs(np.angle(-crossing)) == pytest.approx(float(here.phase_margin), rel=1e-5)
        worst = 1j * float(here.disk_margin_frequency)
        disk, _, _ = control.disk_margins(loop, with_more(np.geomspace(0.05, 2000, 5000), worst.imag))
        assert float(here.disk_margin) == pytest.approx(disk, rel=1e-4)
        # no other crossing is nearer
        omega = np.unique(np.concatenate([np.geomspace(0.05, 2000, 4000), np.linspace(5, 150, 4000)]))
        gains, phases, _, _, _, _ = control.stability_margins(
            control.frd(loop(1j * omega), omega, smooth=True), returnall=True
        )
        above, below = gains[gains > 1], gains[gains < 1]
        assert (above > float(here.gain_margin) * (1 - GRID)).all()
        assert (below < float(here.gain_reduction) * (1 + 20 * GRID)).all()
        either = np.radians(np.minimum(np.mod(phases, 360), 360 - np.mod(phases, 360)))
        assert (either > float(here.phase_margin) * (1 - GRID)).all()


def test_a_loop_changed_by_its_margin_is_neutral_at_the_frequency_told(found):
    """Eigenvalues know nothing of the search: gain times its margin, and the delay longer by its margin."""
    here = found.sel(airspeed=SPEED, loop="damper")
    for name in ("gain_margin", "gain_reduction"):
        factor = float(here[name])
        if not 0 < factor < np.inf:
            continue
        changed = replace(DAMPER, gain=DAMPER.gain * factor, delay_order=8)
        roots = eigenvalues(CASE.with_control(changed, GIMBAL).linearize(SPEED))
        nearest = roots[np.abs(roots - 1j * float(here[f"{name}_frequency"])).argmin()]
        assert abs(nearest - 1j * float(here[f"{name}_frequency"])) < 1e-4
    later = replace(DAMPER, delay=DAMPER.delay + float(here.delay_margin), delay_order=8)
    roots = eigenvalues(CASE.with_control(later, GIMBAL).linearize(SPEED))
    at = 1j * float(here.delay_margin_frequency)
    assert np.abs(roots - at).min() < 2e-3


def test_within_the_disk_margin_gain_and_phase_may_change_at_once(found):
    """The disk allows gains (2 - α)/(2 + α) … and phases to 2 atan(α/2): no margin is smaller."""
    for loop in found.loop.values:
        here = found.sel(loop=loop)
        alpha = here.disk_margin.values
        assert (here.gain_margin.values >= (2 + alpha) / (2 - alpha) * (1 - 1e-9)).all()
        assert (here.gain_reduction.values <= (2 - alpha) / (2 + alpha) * (1 + 1e-9)).all()
        assert (here.phase_margin.values >= 2 * np.arctan(alpha / 2) * (1 - 1e-9)).all()


def test_an_unstable_point_has_no_margins_and_says_so():
    over = CASE.with_control(replace(DAMPER, gain=-DAMPER.gain))
    found = over.margins([100.0, 200.0])
    assert not found.stable[1]
    assert np.isnan(found.disk_margin.values[1]).all()


def test_a_loop_of_several_inputs_is_cut_at_each():
    both = ControlLoop(
        name="both", sensors="x rate", inputs=("cyclic_1c", "cyclic_1s"), gain=-0.01, actuator_bandwidth=80.0
    )
    found = CASE.with_control(both).margins([120.0])
    assert found.loop.values.tolist() == ["both cyclic_1c", "both cyclic_1s"]
    apart = [
        ControlLoop(name=name, sensors="x rate", inputs=name, gain=-0.01, actuator_bandwidth=80.0)
        for name in ("cyclic_1c", "cyclic_1s")
    ]
    same = CASE.with_control(*apart).margins([120.0])
    for name in ("gain_margin", "phase_margin", "disk_margin"):
        np.testing.assert_allclose(found[name].values, same[name].values, rtol=1e-6)


def test_the_airspeeds_over_which_margins_suffice_end_where_they_just_do():
    case = CASE.with_control(DAMPER, GIMBAL)
    found = case.margins(np.array([150.0, 175.0, 200.0]))
    (kept, *more) = [one for one in kept_ranges(case, found, Needed(6.0, np.pi / 4)) if one.loop == "damper"]
    assert not more and kept.open_start and not kept.open_stop and kept.start == 150.0
    below, above = (case.margins(np.array([kept.stop + step])).sel(loop="damper") for step in (-0.01, 0.01))
    assert decibels(below).min() >= 6 and float(below.phase_margin.item()) >= np.pi / 4
    lost = not above.stable.item() or decibels(above).min() < 6 or above.phase_margin.item() < np.pi / 4
    assert lost and kept.lost_by in ("gain margin", "phase margin", "instability")
    nothing = kept_ranges(case, found, Needed(200.0, np.pi / 4))
    assert not [one for one in nothing if one.loop == "damper"]


def test_the_law_of_the_page_keeps_6_db_and_45_degrees_to_115_percent_of_its_target(tmp_path):
    """One fixed law at all airspeeds; without it the wing flutters below."""
    page = (DOCS / "howto" / "close-a-loop.md").read_text(encoding="utf-8")
    (tmp_path / "loop.toml").write_text(page.split("```toml")[1].split("```")[0], encoding="utf-8")
    case = pp.load_case(tmp_path / "loop.toml")
    limit = 1.15 * 335
    found = case.margins(np.append(np.arange(140.0, limit, 15.0), limit) * KNOT)
    assert (
        found.stable.all() and (decibels(found) > 6).all() and (found.phase_margin.values > np.pi / 4).all()
    )
    assert case.with_control().flutter_point().speed < 340 * KNOT < limit * KNOT < case.flutter_point().speed


def test_the_picture_has_both_margins_of_every_loop_and_what_is_needed(found):
    figure = plot_margins(found, title="a title", unit="m/s")
    above, below = figure.axes
    shown = [line for line in above.get_lines() if line.get_label() in ("damper", "gimbal")]
    assert {line.get_label() for line in shown} == {"damper", "gimbal"}
    (damper,) = [line for line in above.get_lines() if line.get_label() == "damper"]
    np.testing.assert_allclose(damper.get_ydata(), np.minimum(decibels(found)[:, 0], 30))
    assert "needed: 45 deg" in [text.get_text() for text in below.texts]
    assert "damper: x acceleration to cyclic_1c" in " ".join(
        text.get_text().replace("\n", " ") for text in figure.texts
    )
    plt.close(figure)


def test_an_airspeed_that_failed_is_hatched_and_not_told_to_be_unstable(found):
    failed = found.copy(deep=True)
    failed["stable"][:], failed["reason"][0] = False, "no trim was found"
    first, last = failed.airspeed.values
    middle = (first + last) / 2
    for ax in plot_margins(failed, unit="m/s").axes:
        stretches = {bool(patch.get_hatch()): patch for patch in ax.patches}
        assert stretches[True].get_x() + stretches[True].get_width() == pytest.approx(middle)
        assert stretches[False].get_x() == pytest.approx(middle)
        assert stretches[False].get_x() + stretches[False].get_width() == pytest.approx(last)
    plt.close("all")


def test_refusals():
    with pytest.raises(pp.InputError, match="has no control loop"):
        CASE.margins([120.0])
    with pytest.raises(pp.InputError, match="must be one design"):
        CASE.with_control(replace(DAMPER, gain=np.array([1.0, 2.0]))).margins([120.0])
    with pytest.raises(pp.InputError, match="must be a list of airspeeds"):
        CASE.with_control(DAMPER).margins(120.0)
