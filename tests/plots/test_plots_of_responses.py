"""Spectra, outputs over time, and the modal assurance criterion: what stands on the axes is what was found."""

from functools import cache

import numpy as np
import pytest

import proprotor as pp
from proprotor import plots

CASE = pp.load_case("xv15")


@cache
def model():
    return CASE.linearize(128.0)


def test_spectra_are_over_their_variance_and_in_hertz():
    found = pp.gust_response(model(), outputs=["force_x", "moment_y"])
    assert found.proprotor.kind == "turbulence"
    ax = found.proprotor.plot()
    assert len(ax.lines) == 2
    x, y = ax.lines[0].get_data()
    rms, unit = float(found.rms[0]), found.output_unit.values[0]
    assert x * 2 * np.pi == pytest.approx(found.frequency.values)
    assert y / (2 * np.pi) * rms**2 == pytest.approx(found.psd.values[:, 0])
    assert ax.get_legend().get_texts()[0].get_text() == f"hub force along x, rms {rms:.3g} {unit}"
    assert ax.get_legend().get_texts()[1].get_text().endswith("N·m")


def test_spectra_of_several_airspeeds_or_of_none_are_refused():
    both = pp.gust_response(CASE.linearize([128.0, 230.0]), outputs=["force_x"])
    with pytest.raises(pp.InputError, match="must be at one airspeed"):
        plots.plot_gust_spectra(both)
    with pytest.raises(pp.InputError, match="not damped"):
        plots.plot_gust_spectra(both.isel(airspeed=1))


def test_outputs_over_time_have_a_line_for_each_gust():
    found = pp.discrete_gust(model(), "10:50:20 m", outputs=["force_x", "force_z", "x"], duration="0.5 s")
    assert found.proprotor.kind == "single gusts"
    ax = found.proprotor.plot()
    lines = [line for line in ax.lines if not line.get_label().startswith("_")]
    assert [line.get_label() for line in lines] == [f"H = {h} m" for h in (10, 30, 50)]
    assert ax.get_ylabel() == "Hub force along x (N)"
    largest = np.abs(found.response.sel(output="force_x")).max("time")
    at = int(largest.values.argmax())
    number, gust = ax.get_title().removeprefix("largest: ").split(" N, in the gust with H = ")
    assert gust == f"{(10, 30, 50)[at]} m" and "e" not in number
    assert float(number.replace(",", "")) == pytest.approx(float(largest[at]), rel=5e-3)
    assert lines[2].get_ydata() == pytest.approx(found.response.sel(output="force_x").values[2])
    two = plots.plot_time_response(found.isel(gradient=0, drop=True), outputs=["force_x", "force_z"])
    assert two.get_ylabel() == "Hub force along x, hub force along z (N)"
    with pytest.raises(pp.InputError, match="must have one unit"):
        plots.plot_time_response(found, outputs=["force_x", "x"])


def test_inputs_over_time_have_a_plot_of_their_outputs():
    found = pp.time_response(model(), "0:1:0.01 s", {"cyclic_1c": "1 deg"}, outputs=["gimbal_1c"])
    assert found.proprotor.kind == "time response"
    assert found.proprotor.plot().lines[0].get_ydata() == pytest.approx(found.response.values[:, 0])


def test_the_criterion_is_written_in_every_field_and_pairs_have_a_frame():
    found = pp.compare_modes(CASE, pp.load_case("xv15-uncoupled").support)
    assert found.proprotor.kind == "modes beside a test"
    ax = found.proprotor.plot()
    written = [text.get_text() for text in ax.texts][: found.mac.size]
    assert written == [f"{value:.2f}" for value in found.mac.values.ravel()]
    assert len(ax.lines) == (found.pair != "").sum()
