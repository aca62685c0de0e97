"""`proprotor_equations` without `proprotor`: the rotor that docs/howto/equations-alone.md builds, beside the engine's.

Both sides take the same stations along the blade and trim to rounding: matrices agree to 1e-13 of their largest entry.
"""

import ast
import functools
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from proprotor_equations import (
    BLADE_COORDINATES,
    FIXED_COORDINATES,
    FIXED_GUSTS,
    airloads,
    coordinates,
    published,
    rotor,
)

import proprotor as pp
from tests.documentation import DOCS, Runner, blocks

PAGE = DOCS / "howto" / "equations-alone.md"
CODE = [block.text for block in blocks(PAGE) if block.kind == "python"]
AIRSPEEDS = (20.0, 60.0, 150.0, 250.0)
ROUNDING = 1e-13


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """What the code of the page defines, without its last block: that one compares."""
    runner = Runner(tmp_path_factory.mktemp("page"))
    for block in blocks(PAGE):
        if block.kind == "python" and "import proprotor as pp" not in block.text:
            runner.run(block)
    return runner.names


@pytest.fixture(scope="module")
def stations(page):
    """Stations, weights and segments of the engine's quadrature; the page takes the engine's twist there."""
    blade = pp.load_case("xv15-uncoupled").rotor
    own, page["twist"] = blade.quadrature, lambda r: blade.sections.twist
    hinges = [page["known"][name] for name in ("flap_hinge_offset", "lag_hinge_offset")]
    return own.stations, own.weights[:, 0], np.searchsorted(hinges, own.stations)


def assert_alike(found, expected):
    for mine, ours in zip(found, expected, strict=True):
        assert mine.shape == ours.shape
        assert np.abs(mine - ours).max() <= ROUNDING * np.abs(ours).max()


@pytest.mark.parametrize("airspeed", AIRSPEEDS)
def test_the_rotor_of_generated_functions_is_that_of_the_engine(page, stations, airspeed):
    case = pp.load_case("xv15-uncoupled")
    model = pp.rotor_model(case.rotor, case.operation, airspeed)
    assert_alike(page["matrices"](airspeed, *stations), (model.M, model.C, model.K, model.B))


def test_many_rotors_at_once(page, stations):
    """Quantities of the blade (points,), of segments (points, 3)."""
    trims = [page["at"](page["trimmed"](airspeed, *stations), airspeed) for airspeed in AIRSPEEDS]
    pools = [blade | page["segments"](blade, *stations) for blade in trims]
    stacked = {name: np.array([pool[name] for pool in pools]) for name in pools[0]}
    together = page["call"](rotor.matrices, stacked)
    for place, pool in enumerate(pools):
        assert_alike([matrix[place] for matrix in together], page["call"](rotor.matrices, pool))


def test_the_published_equations_come_by_their_modules(page, stations, monkeypatch):
    """`equations=published`, with the published geometry of segments; the section loads have no pitch damping there."""

    @functools.wraps(published.airloads.trim_velocity)
    def trim_velocity(**given):  # the same on all segments of a flat blade
        return np.broadcast_to(published.airloads.trim_velocity(**given), (3, 7, 1))

    published_too = vars(airloads) | {"trim_velocity": trim_velocity}
    published_too["segment_geometry"] = published.airloads.segment_geometry
    monkeypatch.setitem(page["known"], "section_damping", 0.0)
    blade = page["at"](page["trimmed"](150.0, *stations), 150.0)
    monkeypatch.setitem(page, "airloads", SimpleNamespace(**published_too))
    given = blade | page["segments"](blade, *stations) | {"equations": published}
    case = pp.load_case("xv15-uncoupled")
    model = pp.rotor_model(case.rotor, case.operation, 150.0, equations="published", section_damping=False)
    assert_alike(page["call"](rotor.matrices, given), (model.M, model.C, model.K, model.B))


def test_engine_and_shaft_are_added_where_they_are_given(page, stations):
    blade = page["at"](page["trimmed"](150.0, *stations), 150.0)
    given = blade | page["segments"](blade, *stations)
    without = page["call"](rotor.matrices, given)
    driven = page["call"](rotor.matrices, given | {"drive_inertia": 20.0, "shaft_stiffness": 1e4})
    azimuth = FIXED_COORDINATES.index("azimuth")
    assert driven.M[azimuth, azimuth] - without.M[azimuth, azimuth] == pytest.approx(20.0, rel=1e-9)
    assert driven.K[azimuth, azimuth] - without.K[azimuth, azimuth] == pytest.approx(1e4, rel=1e-9)
    assert (driven.C == without.C).all()


def test_the_page_needs_numpy_and_the_equations_alone():
    """Its code but for the last block, in a process of its own that cannot import the engine."""
    imported = {
        (node.module if isinstance(node, ast.ImportFrom) else node.names[0].name)
        for text in CODE[:-1]
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Import | ast.ImportFrom)
    }
    assert imported == {"inspect", "numpy", "proprotor_equations"}
    blocked = "import sys; sys.modules.update(dict.fromkeys(('proprotor', 'scipy', 'sympy', 'xarray')))\n"
    code = blocked + "\n".join(CODE[:-1])
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[0] == "flap_1c flap 1 rad"


# Records


def test_the_package_names_what_the_records_declare():
    for names, records in (
        (BLADE_COORDINATES, coordinates.BLADE),
        (FIXED_COORDINATES, coordinates.FIXED),
        (FIXED_GUSTS, coordinates.FIXED_GUSTS),
    ):
        assert names == tuple(record.name for record in records)
    assert FIXED_COORDINATES[:3] == ("x", "y", "z") and FIXED_COORDINATES[17] == "gimbal_1s"
    assert [motion.unit for motion in coordinates.INPUTS] == ["rad"] * 3 + ["m/s"] * 3


def test_a_blade_has_of_each_coordinate_its_harmonic():
    """T is turned by a Fourier transform over the azimuth: each column has one harmonic, and cosine or sine as told."""
    azimuth = 2 * np.pi * np.arange(8) / 8
    spectrum = np.fft.rfft(coordinates.transform(psi=azimuth), axis=0) / len(azimuth)
    for column, coordinate in enumerate(coordinates.FIXED):
        size = np.abs(spectrum[:, :, column]).max(axis=1)
        assert np.flatnonzero(size > 1e-12).tolist() == [coordinate.harmonic]
        row = next((i for i, c in enumerate(coordinates.BLADE) if c.name == coordinate.angle), None)
        if coordinate.part and row is not None:
            wave = 0.5 if coordinate.part == "c" else -0.5j
            assert spectrum[1, row, column] == pytest.approx(wave, abs=1e-12)
