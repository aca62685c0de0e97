"""Bars: sensitivities, origins of damping, distributions and Sobol indices."""

import matplotlib
import numpy as np
import pytest
import xarray

import proprotor as pp
from proprotor import plots
from proprotor.plots import small_print
from proprotor.plots.bars import signed
from proprotor.plots.input_names import short_name, short_names

matplotlib.use("Agg")
from matplotlib import pyplot as plt

KNOT = 1852 / 3600


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


@pytest.fixture(scope="module")
def slopes(case):
    return case.sensitivity(airspeed="300:420:20kt")


@pytest.fixture(scope="module")
def origins(case):
    return case.attribution("350 kt")


@pytest.fixture(scope="module")
def sampled():
    """A study of a sample, made up: 200 flutter speeds, one design above the range, one below, one failed."""
    speed = np.append(np.linspace(150, 200, 197), [np.nan] * 3)
    note = np.array(
        [""] * 197 + ["stable throughout", "unstable from the lowest airspeed on", ""], dtype=object
    )
    from proprotor.study.variables import STABLE, UNSTABLE

    note[197], note[198] = STABLE, UNSTABLE
    return xarray.Dataset(
        {
            "flutter_speed": ("design", speed, {"units": "m/s"}),
            "flutter_speed_above": ("design", np.where(note == STABLE, 250.0, np.nan)),
            "flutter_speed_below": ("design", np.where(note == UNSTABLE, 100.0, np.nan)),
            "flutter_note": ("design", note.astype(str)),
        },
        {"airspeed": [100.0, 250.0]},
        {"sample": "{}"},
    )


@pytest.fixture(scope="module")
def indices():
    names = ["rotor.precone", "rotor.control_stiffness", "support.modes[chord].frequency"]
    values = {"first": [0.1, 0.5, 0.0], "total": [0.2, 0.7, 0.01]}
    data = {name: ("input", np.array(share)) for name, share in values.items()}
    data |= {f"{name}_half_interval": ("input", np.array([0.02, 0.05, 0.01])) for name in values}
    return xarray.Dataset(data, {"input": names}, {"of": "flutter_speed"})


@pytest.fixture(autouse=True)
def close_figures():
    yield
    plt.close("all")


def names_of(ax):
    return [label.get_text() for label in ax.get_yticklabels()]


def widths(container):
    return [bar.get_width() for bar in container]


@pytest.mark.parametrize("which", ["slopes", "origins", "sampled", "indices"])
def test_a_plot_goes_into_the_axes_given_and_returns_them(request, which):
    data = request.getfixturevalue(which)
    figure, (left, right) = plt.subplots(1, 2)
    drawn = {
        "slopes": lambda: plots.plot_sensitivity(data, right),
        "origins": lambda: plots.plot_attribution(data, "chord", right),
        "sampled": lambda: plots.plot_distribution(data, right),
        "indices": lambda: plots.plot_sobol(data, right),
    }[which]()
    assert drawn is right
    assert not left.patches
    assert any(unit in right.get_xlabel() for unit in ("KTAS", "%"))
    assert plt.get_fignums() == [figure.number]
    if right.get_legend():
        texts = [text.get_text() for text in right.get_legend().get_texts()]
        assert len(set(texts)) == len(texts)
    figure.draw_without_rendering()


def test_sensitivity_bars_are_the_change_in_knots_for_a_percent_longest_on_top(slopes):
    ax = plots.plot_sensitivity(slopes, percent=2, count=8)
    expected = (0.02 * slopes.derivative * slopes.value / KNOT).to_series()
    expected = expected[expected != 0]
    order = expected.abs().sort_values(ascending=False).index[:8]
    (bars,) = ax.containers
    assert names_of(ax)[::-1] == short_names(list(order))
    np.testing.assert_allclose(widths(bars)[::-1], expected[order])
    assert f"flutter speed, {slopes.attrs['value'] / KNOT:.0f} KTAS" in ax.get_xlabel()
    assert "+2 %" in ax.get_xlabel()


def test_sensitivity_bars_tell_by_colour_and_hatch(slopes):
    ax = plots.plot_sensitivity(slopes, count=100)
    by_name = {short_name(path): path for path in slopes.input.values.tolist()}
    (bars,) = ax.containers
    colours, hatched = set(), set()
    for name, bar in zip(names_of(ax), bars, strict=True):
        status = str(slopes.status.sel(input=by_name[name]).item())
        if bar.get_width():
            colours.add((bar.get_width() > 0, bar.get_facecolor()))
        hatched.add((status, bar.get_hatch()))
    assert len(colours) == 2
    assert dict(hatched)["published"] in (None, "")
    assert len({hatch for status, hatch in hatched if status not in ("published", "derived")}) == 3
    legend = {text.get_text() for text in ax.get_legend().get_texts()}
    assert {"lowers it", "raises it", "assumed", "recalled", "calibrated"} == legend


def test_sensitivity_over_ranges_has_a_bar_for_each_end(slopes):
    value = float(slopes.value.sel(input="rotor.precone"))
    ranges = {"rotor.precone": (0.5 * value, 2 * value), "rotor.airfoil.zero_lift_angle": (-0.03, 0.0)}
    ax = plots.plot_sensitivity(slopes, ranges=ranges)
    rate = slopes.derivative.sel(input=list(ranges)).values / KNOT
    low, high = ax.containers
    place = names_of(ax).index("precone")
    assert low[place].get_width() == pytest.approx(-0.5 * value * rate[0])
    assert high[place].get_width() == pytest.approx(value * rate[0])
    assert low[1 - place].get_width() == pytest.approx(-0.03 * rate[1])
    assert high[1 - place].get_width() == 0
    with pytest.raises(pp.InputError, match="did you mean"):
        plots.plot_sensitivity(slopes, ranges={"rotor.precon": (0, 1)})


def test_sensitivity_of_damping_is_in_percent_of_critical(case):
    found = case.sensitivity("damping", ["rotor.precone"], airspeed="350 kt", mode="chord")
    ax = plots.plot_sensitivity(found)
    ((bar,),) = ax.containers
    assert bar.get_width() == pytest.approx(100 * 0.01 * float(found.relative.item()))
    assert "damping of chord (% of critical)" in ax.get_xlabel()


def test_sensitivity_refuses_what_it_cannot_draw(case, slopes):
    with pytest.raises(pp.InputError, match="speed"):
        plots.plot_sensitivity(slopes, unit="kg")
    both = case.sensitivity("damping", ["rotor.precone"], airspeed="350 kt")
    with pytest.raises(pp.InputError, match="one mode"):
        plots.plot_sensitivity(both)
    with pytest.raises(pp.InputError, match="derivatives of"):
        plots.plot_sensitivity(case.sensitivity("eigenvalue", ["rotor.precone"], airspeed="350 kt"))


def test_a_change_has_two_digits_and_no_exponent():
    written = {4.0: "+4.0", -0.058: "−0.058", 9.97: "+10", -9.949: "−9.9", 123.4: "+123", 0.1: "+0.10"}
    assert {value: signed(value) for value in written} == written


def test_attribution_bars_sum_to_zero_and_are_changes_of_the_damping_ratio(origins):
    ax = plots.plot_attribution(origins, "chord", count=100)
    value = complex(origins.eigenvalue.sel(mode="chord").item())
    bars = [bar for container in ax.containers for bar in container]
    assert sum(bar.get_width() for bar in bars) == pytest.approx(0, abs=1e-6)
    names = names_of(ax)
    for bar in bars:
        origin = names[round(bar.get_y() + bar.get_height() / 2)]
        added = complex(origins.contribution.sel(mode="chord", origin=origin).item())
        step = 1e-6
        ratio = [-root.real / abs(root) for root in (value - step * added, value + step * added)]
        assert bar.get_width() == pytest.approx(100 * (ratio[1] - ratio[0]) / (2 * step), rel=1e-4, abs=1e-6)
    assert {text.get_text() for text in ax.get_legend().get_texts()} == {"drives it", "damps it"}


def test_attribution_bars_that_are_left_out_are_one_bar(origins):
    ax = plots.plot_attribution(origins, "chord", count=5)
    widths_ = [bar.get_width() for container in ax.containers for bar in container]
    assert len(widths_) == 6
    assert sum(widths_) == pytest.approx(0, abs=1e-6)
    assert f"all {len(origins.origin) - 5} others" in names_of(ax)
    with pytest.raises(pp.InputError, match="mode"):
        plots.plot_attribution(origins)


def test_a_distribution_shows_shares_and_percentiles_and_counts_the_rest(sampled):
    ax = plots.plot_distribution(sampled, percentiles=(10, 50, 99.9))
    assert sum(bar.get_height() for bar in ax.patches) == pytest.approx(100 * 197 / 199)
    verticals = [line.get_xdata()[0] for line in ax.lines if len(set(line.get_xdata())) == 1]
    expected = pp.distribution(sampled, percentiles=(10, 50)).value.values / KNOT
    np.testing.assert_allclose(verticals, expected)  # 99.9 % lies among designs above the range
    told = small_print.read(ax)
    assert "199 designs" in told and "1 stable throughout" in told and "1 failed" in told
    assert "99.9 %: > 486" in told  # 250 m/s, the highest airspeed, in knots
    assert ax.get_xlabel() == "Flutter speed, KTAS" and "%" in ax.get_ylabel()
    assert plots.plot_distribution(sampled, unit="m/s").get_xlabel() == "Flutter speed (m/s, true)"


def test_sobol_bars_have_shares_and_intervals_the_largest_on_top(indices):
    ax = plots.plot_sobol(indices)
    assert names_of(ax)[::-1] == ["control stiffness", "precone", "chord: frequency"]
    total, first = (c for c in ax.containers if len(c) == 3 and hasattr(c[0], "get_width"))
    np.testing.assert_allclose(widths(total)[::-1], [70, 20, 1])
    np.testing.assert_allclose(widths(first)[::-1], [50, 10, 0])
    segments = ax.collections[0].get_segments()
    np.testing.assert_allclose([segment[1, 0] - segment[0, 0] for segment in segments][::-1], [10, 4, 2])
    assert names_of(plots.plot_sobol(indices, count=1)) == ["control stiffness"]


def test_short_names_are_those_of_the_deck_and_stay_apart():
    assert short_name("support.modes[chord].generalized_mass") == "chord: generalized mass"
    assert short_name("rotor.airfoil.lift_slope") == "airfoil lift slope"
    assert short_names(["rotor.x_y", "operation.x_y", "rotor.z"]) == ["rotor.x_y", "operation.x_y", "z"]
    for name in pp.list_cases():
        paths = list(pp.design_inputs(pp.load_case(name)))
        assert len(set(short_names(paths))) == len(paths)
