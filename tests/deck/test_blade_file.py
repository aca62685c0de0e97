"""Stations of an elastic blade from CSV files with the habits of spreadsheets: read right, or refused in one line."""

import numpy as np
import pytest

from proprotor.deck.blade_file import read_blade
from proprotor.errors import InputError

FOOT, INCH, SLUG, POUND = 0.3048, 0.0254, 14.59390294, 4.4482216152605
HEADS = "r [in],mass [slug/ft],EI_flat [lbf*in**2],EI_edge [lbf*in**2],GJ [lbf*ft**2],twist [deg]"
ROWS = (
    "15,1.156,4.1e7,9.0e7,344000,30.03",
    "45,0.184,2.2e7,3.1e8,93700,17.53",
    "100,0.17,8.0e6,2.4e8,21000,2",
    "150,0.161,1e6,5e7,4310,-5.82",
)


def read(tmp_path, text, **more):
    path = tmp_path / "blade.csv"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return read_blade(path, **{"control_stiffness": 3e4} | more)


def check(blade):
    np.testing.assert_allclose(blade.radius, np.array([15, 45, 100, 150]) * INCH, rtol=1e-12)
    np.testing.assert_allclose(
        blade.mass_per_length, np.array([1.156, 0.184, 0.17, 0.161]) * SLUG / FOOT, rtol=1e-8
    )
    flat = np.array([4.1e7, 2.2e7, 8e6, 1e6]) * POUND * INCH**2
    np.testing.assert_allclose(blade.flatwise_stiffness, flat, rtol=1e-9)
    np.testing.assert_allclose(blade.torsion_stiffness[0], 344000 * POUND * FOOT**2, rtol=1e-9)
    np.testing.assert_allclose(blade.twist, np.radians([30.03, 17.53, 2, -5.82]), rtol=1e-12)
    assert blade.chord is None


def test_units_in_the_headings(tmp_path):
    check(read(tmp_path, "\n".join((HEADS, *ROWS))))


def test_units_in_parentheses_names_in_capitals_and_columns_of_no_use(tmp_path):
    heads = "Station (in),MASS (slug/ft),ei_beamwise (lbf*in**2),EI_chordwise (lbf*in**2),gj (lbf*ft**2),Twist (deg)"
    rows = (f"{row},see drawing {n}" for n, row in enumerate(ROWS))
    check(read(tmp_path, "\n".join((f"{heads},remark", *rows))))


def test_decimal_commas_between_semicolons_with_a_byte_order_mark(tmp_path):
    table = "\r\n".join((HEADS, *ROWS)).replace(",", ";").replace(".", ",")
    check(read(tmp_path, "\ufeff" + table + "\r\n;;;;;\r\n"))


def test_stations_as_parts_of_the_radius(tmp_path):
    rows = [f"{float(r) / 150},{rest}" for r, rest in (row.split(",", 1) for row in ROWS)]
    text = "\n".join((HEADS.replace("r [in]", "r/R"), *rows))
    check(read(tmp_path, text, radius=150 * INCH))
    with pytest.raises(
        InputError, match=r"file = blade.csv: column 1 \(r/R\): needs the radius of the rotor"
    ):
        read(tmp_path, text)


@pytest.mark.parametrize("unit", ["lbf·in²", "lbf in²", "lbf*in²", "lbf-in^2", "in² lbf"])
def test_units_as_reports_write_them(tmp_path, unit):
    heads = HEADS.replace("lbf*in**2", unit).replace("twist [deg]", "twist [°]")
    check(read(tmp_path, "\n".join((heads, *ROWS))))


@pytest.mark.parametrize(
    ("head", "last", "told"),
    [
        ("r [in]", "150", "is 0.984252 R"),  # beside another radius of the rotor
        ("r [ft]", "150", "is 11.811 R"),  # in another unit than the head says
        ("r/R", "150", "is 150 R"),  # lengths below the head of r/R
        ("r/R", "120", "is 120 R"),
        ("r_over_R [%]", "95", "is 0.95 R"),  # a table that ends before the tip
    ],
)
def test_the_last_station_is_the_tip(tmp_path, head, last, told):
    """Else the blade has another radius than the rotor, and nothing says so."""
    text = "\n".join((HEADS.replace("r [in]", head), *ROWS)).replace("\n150,", f"\n{last},")
    text = text.replace("100,0.17", "90,0.17")
    with pytest.raises(InputError) as caught:
        read(tmp_path, text, radius=3.87096)
    column = f"line 5, column 1 ({head})"
    assert f"{column}: {told}; the last station must be the tip, R = 3.87096 m" in str(caught.value)


def test_a_radius_beside_stations_in_metres_may_be_rounded(tmp_path):
    check(read(tmp_path, "\n".join((HEADS, *ROWS)), radius=3.8102))


def test_a_table_that_begins_outboard_is_held_there(tmp_path):
    """A missing root is no blade of zeros."""
    assert read(tmp_path, "\n".join((HEADS, *ROWS))).nodes[0] == pytest.approx(15 * INCH)


def test_chord_and_pitch_inertia(tmp_path):
    rows = (f"{row},14,0.02" for row in ROWS)
    blade = read(tmp_path, "\n".join((f"{HEADS},chord [in],pitch_inertia [slug*ft]", *rows)))
    np.testing.assert_allclose(blade.chord, 14 * INCH)
    np.testing.assert_allclose(blade.pitch_inertia_per_length, 0.02 * SLUG * FOOT, rtol=1e-8)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda t: t.replace("100,0.17", "45,0.17"),
            "line 4, column 1 (r [in]): is the station of the line before;",
        ),
        (
            lambda t: t.replace("100,0.17", "40,0.17"),
            "line 4, column 1 (r [in]): must increase from line to line",
        ),
        (lambda t: t.replace("0.184", ""), "line 3, column 2 (mass [slug/ft]): is empty"),
        (lambda t: t.replace("0.184", "n/a"), 'line 3, column 2 (mass [slug/ft]): "n/a" is no number'),
        (lambda t: t.replace("0.184", "-1"), "line 3, column 2 (mass [slug/ft]): must be above zero"),
        (lambda t: t.replace("GJ [lbf*ft**2]", "GJ"), "column 5 (GJ): "),
        (lambda t: t.replace("GJ [lbf*ft**2]", "GJ [lbf]"), "column 5 (GJ [lbf]): "),
        (
            lambda t: t.replace("GJ", "torque"),
            "has no column for torsion_stiffness; name it GJ or torsion_stiffness",
        ),
        (lambda t: t.replace("EI_edge", "EI_flat"), '"EI_flat" is named twice'),
        (
            lambda t: t.replace("EI_edge", "EI_beam"),
            "has two columns for flatwise_stiffness: EI_flat [lbf*in**2] and",
        ),
        (lambda t: t.replace(".", ",", 3), "cells for 6 columns"),
        (
            lambda t: t.replace(",", ";").replace("0.17;", "0,17;"),
            "has decimal commas (line 4) and decimal points",
        ),
        (lambda t: "", "is empty"),
        (lambda t: "\n".join(t.split("\n")[:2]), "must have at least 3 stations, and has 1"),
    ],
)
def test_a_fault_is_one_line(tmp_path, change, message):
    with pytest.raises(InputError) as caught:
        read(tmp_path, change("\n".join((HEADS, *ROWS))))
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)
