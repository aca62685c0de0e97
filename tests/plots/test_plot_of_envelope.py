"""The picture of an envelope: what is drawn is what was found."""

import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.colors import to_rgba

import proprotor as pp
from proprotor.plots import plot_envelope, small_print

KNOT, FOOT = 1852 / 3600, 0.3048


@pytest.fixture(scope="module")
def found():
    settings = {
        "envelope.dive_speed": "270 keas",
        "envelope.dive_mach": "0.5",
        "envelope.altitudes": '{ value = [0, 10000, 20000], unit = "ft" }',
        "envelope.rotor_speeds": '{ value = [458, 540], unit = "rpm" }',
        "variants.soft.rotor.control_stiffness": "5400 N*m/rad",
    }
    return pp.load_case("xv15-wing", settings).envelope()


@pytest.fixture
def drawn(found):
    axes = plot_envelope(found)
    yield axes
    pyplot.close("all")


def line(axes, label):
    (one,) = [line for line in axes.get_lines() if line.get_label() == label]
    return one


def test_each_condition_is_drawn_at_its_lowest_onset(drawn, found):
    for place, name in enumerate(found.condition.values.tolist()):
        x, y = np.asarray(line(drawn, name).get_xydata()).T
        lowest = np.nanmin(found.equivalent_onset.values[place], axis=(0, 1)) / KNOT
        np.testing.assert_allclose(x, lowest, rtol=1e-12)
        np.testing.assert_allclose(y, found.altitude.values / FOOT, rtol=1e-12)


def test_conditions_differ_in_colour_dashes_and_markers(drawn, found):
    lines = [line(drawn, name) for name in found.condition.values.tolist()]
    for part in ("get_color", "get_linestyle", "get_marker"):
        assert len({getattr(one, part)() for one in lines}) == len(lines)


def test_the_speeds_needed_have_their_corner(drawn):
    x, y = np.asarray(line(drawn, "needed of normal conditions").get_xydata()).T
    assert x[0] == pytest.approx(1.15 * 270, rel=1e-6) and x[-1] < x[0] - 20
    straight = y <= 10_000
    np.testing.assert_allclose(x[straight], x[0], rtol=1e-12)
    dive = np.asarray(line(drawn, "$V_D$, $M_D$: needed of failures").get_xydata()).T[0]
    np.testing.assert_allclose(x, 1.15 * dive, rtol=1e-9)


def test_doubtful_onsets_are_hollow_and_told(found):
    doubtful = found.copy()
    doubtful["warning"] = found.warning.copy(data=np.full(found.warning.shape, "an invented doubt"))
    axes = plot_envelope(doubtful)
    hollow = [one for one in axes.get_lines() if to_rgba(one.get_markerfacecolor()) == to_rgba("white")]
    assert sum(len(one.get_xdata()) for one in hollow) == found.sizes["condition"] * found.sizes["altitude"]
    assert "an invented doubt" in small_print.read(axes)
    pyplot.close("all")


def test_a_condition_without_an_onset_is_named(found):
    none = found.isel(condition=[0]).copy()
    none["equivalent_onset"] = none.equivalent_onset * np.nan
    axes = plot_envelope(none)
    assert "No onset in the search: as the deck" in small_print.read(axes)
    pyplot.close("all")


def test_the_altitude_has_a_unit_of_the_users_choice(found):
    axes = plot_envelope(found, unit="m")
    assert axes.get_ylabel() == "Pressure altitude (m)"
    assert axes.get_ylim()[1] == pytest.approx(1.03 * found.altitude.values[-1])
    pyplot.close("all")
    with pytest.raises(pp.InputError, match="unit"):
        plot_envelope(found, unit="kt")
