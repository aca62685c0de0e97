"""The first page of a report: verdict, margin, numbers of the rotor, inputs that matter, and their doubts."""

import io
import math

import numpy as np
import pytest
from pypdf import PdfReader

import proprotor as pp
from proprotor.report import analyse, pdf_of, report_document
from proprotor.report.document import Table, Text

KT = 1852 / 3600
ENVELOPE = {"envelope.dive_speed": "200 keas", "envelope.altitudes": '{ value = [0, 1], unit = "km" }'}


def reported(case, speeds, margin_at=None, **options):
    found = analyse(case, None if speeds is None else case.sweep(speeds).airspeed.values, options)
    more = {"settings": {"rotor.precone": "2.5 deg"}, "deck_hash": "0", "date": "2025-10-09"}
    return found, report_document(case, found, margin_at=margin_at, **more)


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


@pytest.fixture(scope="module")
def unstable(case):
    return reported(case, "340:400:20kt", 350 * KT)


@pytest.fixture(scope="module")
def cells(unstable):
    table = next(block for block in unstable[1].summary if isinstance(block, Table))
    return dict(zip(table.columns, map(float, table.rows[0]), strict=True))


def tables(document):
    return {block.caption: block for block in document.summary if isinstance(block, Table)}


def test_the_margin_at_an_airspeed_stands_beside_the_flutter_speed(unstable):
    found, document = unstable
    knots = found.flutter.speed / KT
    assert document.verdict[0].startswith(f"Flutter speed {knots:.2f} KTAS: chord, flutter")
    assert document.verdict[1] == f"Margin at 350 KTAS: {100 * (knots / 350 - 1):+.1f} % of that airspeed."


def test_without_an_airspeed_the_margin_is_said_to_be_missing(case):
    _, document = reported(case, "340:400:30kt")
    assert document.verdict[1].startswith("No margin") and "--margin-at" in document.verdict[1]


def test_the_numbers_of_the_rotor_follow_from_its_inputs(case, cells, unstable):
    """Closed forms with the inputs of the deck: three blades of constant chord."""
    rotor, operation, speed = case.rotor, case.operation, unstable[0].speed
    chord, radius = 1.2158 * 0.3048, 12.5 * 0.3048
    tip = 458 * math.pi / 30 * radius
    assert cells["solidity σ"] == pytest.approx(3 * chord / (math.pi * radius), rel=0.01)
    lock = 1.225 * 5.7 * chord * radius**4 / float(rotor.blade_inertia)
    assert cells["Lock number γ"] == pytest.approx(lock, rel=0.01)
    assert cells["tip Mach Ω R / a"] == pytest.approx(tip / 340.3, rel=0.002)
    assert cells["along the helix"] == pytest.approx(np.hypot(tip, speed) / 340.3, rel=0.002)
    assert cells["K_PG"] == float(rotor.pitch_gimbal_coupling)
    assert float(operation.speed_of_sound) == pytest.approx(340.3, rel=1e-3)


def test_the_frequencies_of_the_blade_are_those_of_springs_that_turn_with_its_pitch(cells, unstable):
    """Written down with the numbers of Table 1 in feet and slugs: springs of the blade at rest, and centrifugal force.

    The springs give 59.8 and 103 rad/s at rest; their axes stand at the pitch of the blade and 15 deg more.
    """
    flap_inertia, lag_inertia, turning = 81.8, 70.4, (458 * math.pi / 30) ** 2
    flap_spring, lag_spring = flap_inertia * 59.8**2, lag_inertia * 103**2
    trim, at = unstable[0].trim, unstable[0].sweep.airspeed.values
    pitch = np.interp(unstable[0].speed, at, trim.collective + trim.elastic_pitch) + math.radians(15)
    sine, cosine = math.sin(pitch) ** 2, math.cos(pitch) ** 2
    flap = (
        (flap_spring * cosine + lag_spring * sine) / (flap_inertia * turning) + 1 + 0.80 * 10.2 / flap_inertia
    )
    lag = (flap_spring * sine + lag_spring * cosine) / (lag_inertia * turning) + 1.404 * 8.69 / lag_inertia
    assert cells["ν_β, /rev"] == pytest.approx(math.sqrt(flap), abs=2e-3)
    assert cells["ν_ζ, /rev"] == pytest.approx(math.sqrt(lag), abs=2e-3)


def test_the_inputs_that_matter_most_come_first(case, unstable):
    rates = unstable[0].causes.sensitivity
    change = abs(rates.relative.values) / 100 / KT
    order = rates.input.values[np.argsort(-change)]
    most = tables(unstable[1])["Inputs that move the flutter speed most"]
    assert [row[0] for row in most.rows] == order[:5].tolist()
    assert [abs(float(row[2])) for row in most.rows] == pytest.approx(sorted(change)[::-1][:5], rel=5e-3)


def test_the_inputs_without_a_source_that_matter_most_are_named(case, unstable):
    doubtful = [path for path, n in case.sources.items() if n.status in ("assumed", "recalled", "calibrated")]
    (table,) = (table for name, table in tables(unstable[1]).items() if "not read in a source" in name)
    assert table.caption.endswith(f"of {len(doubtful)}")
    assert len(table.rows) == 5
    assert all(row[0] in doubtful and row[3].endswith("*") for row in table.rows)


def test_what_was_analysed_and_set_is_said(unstable):
    (text,) = (block for block in unstable[1].summary if isinstance(block, Text))
    assert text.paragraphs[0].startswith("Analysed: 4 airspeeds from 340 to 400 KTAS; equations consistent")
    assert text.paragraphs[1] == "Set for this run: rotor.precone = 2.5 deg."


def test_an_envelope_is_the_margin_and_one_that_fails_says_why(case):
    whole = pp.load_case("xv15-uncoupled", ENVELOPE)
    found, document = reported(whole, "340:400:30kt")
    (told,) = (sentence for sentence in document.verdict if sentence.startswith("Envelope: "))
    met = int((found.envelope.verdict.values == "met").sum())
    assert f"{found.envelope.verdict.size} places: {met} met" in told and "Worst case" in told
    high = pp.load_case(
        "xv15-uncoupled",
        ENVELOPE | {"envelope.altitudes": '{ value = [0, 40], unit = "km" }'},
    )
    _, document = reported(high, "340:400:30kt")
    assert any("The envelope could not be found: altitude = 40000 m" in line for line in document.verdict)


def test_a_doubtful_flutter_speed_has_its_reason_on_the_first_page():
    """In thin air the boundary lies where the blades meet the air beyond the Mach number of the linear theory."""
    case = pp.load_case("xv15-uncoupled", {"operation.speed_of_sound": "290 m/s"})
    found, document = reported(case, "300:420:20kt")
    assert found.flutter.warning
    assert "?" in document.verdict[0]
    assert any("the flutter speed" in line and found.flutter.warning in line for line in document.caution)


def test_failed_airspeeds_have_their_reasons_on_the_first_page(case):
    _, document = reported(case, "300:800:100kt")
    assert any(line.startswith("Not analysed: ") for line in document.verdict)
    assert any(line.startswith("Not analysed at 800 KTAS: tip Mach number") for line in document.caution)


def test_where_nothing_could_be_analysed_the_summary_has_what_needs_no_trim(case):
    _, document = reported(case, "780:800:10kt", 250 * KT)
    assert document.verdict == ("No airspeed could be analysed.",)
    (table,) = tables(document).values()
    assert {"Lock number γ", "solidity σ", "K_PG"} <= set(table.columns) and "ν_β, /rev" not in table.columns


@pytest.mark.parametrize("name", ["xv15", "xv15-aircraft", "v22-fifth-scale"])
def test_the_summary_is_one_page(name):
    _, document = reported(pp.load_case(name), "300:400:50kt")
    pages = [page.extract_text() for page in PdfReader(io.BytesIO(pdf_of(document))).pages]
    assert "Analysed: 3 airspeeds" in pages[0]
    contents = pages[0].partition("Contents\n")[2].splitlines()
    assert [line.rstrip(" .0123456789") for line in contents[: len(document.sections)]] == [
        section.title for section in document.sections
    ]
    assert pages[1].startswith(document.sections[0].title)
