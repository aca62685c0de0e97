"""Modes of every deck, for every combination of switches, are the accepted ones until others are accepted."""

import itertools

import pytest

import proprotor as pp
from proprotor.rotor.options import CHOICES
from tests import accept_golden
from tests.golden.combinations import ADVANCE, SWITCHES, choices, computed, record
from tests.golden.modes import COMMAND, Change, Mode, Record, accepted, changes, movement


@pytest.mark.parametrize("deck", pp.list_cases())
def test_modes_are_the_accepted_ones(deck):
    now = computed(deck)
    if found := changes(record(deck).kept(), now):
        told = f"`{COMMAND}` accepts this and leaves it to be seen in review."
        pytest.fail(f"{deck}: {record(deck).told(found, len(now))}\n{told}", pytrace=False)


@pytest.mark.parametrize("deck", pp.list_cases())
def test_every_combination_is_there(deck):
    points = [(*choice, str(advance)) for choice, _ in choices() for advance in ADVANCE]
    assert list(record(deck).kept()) == points
    combined = {point[: len(SWITCHES)] for point in points}
    assert combined == set(itertools.product(*(map(str, CHOICES[name]) for name in SWITCHES)))


def test_no_deck_is_left_that_is_gone():
    kept = {file.stem for file in record("any").file.parent.glob("*.csv")} - {"audit"}
    assert kept == set(pp.list_cases())


@pytest.mark.parametrize("moved", [{"frequency": 0.5 * (1 + 3e-8)}, {"damping_ratio": 0.01 + 3e-8}])
def test_a_small_change_is_found_told_and_alone_accepted(moved):
    mode, other = Mode("chord", 0.5, 0.01), Mode("beam", 0.3, 0.02)
    defaults = (*(str(CHOICES[name][0]) for name in SWITCHES), "")
    points = [(*defaults, "0.5"), (*defaults, "0.7")]
    was = {point: [other, mode] for point in points}
    rounded = other._replace(damping_ratio=0.02 + 1e-12)
    now = {points[0]: [rounded, mode], points[1]: [rounded, mode._replace(**moved)]}
    (change,) = changes(was, now)
    assert change == (points[1], mode, mode._replace(**moved))
    told = record("xv15-uncoupled").told([change], 2)
    assert "chord" in told and "0.7 1" in told
    assert accepted(was, now) == {points[0]: was[points[0]], points[1]: now[points[1]]}


def test_a_mode_that_comes_or_goes_is_a_change():
    point, mode = ("any",), Mode("lag_1c", 0.7, 0.05)
    assert changes({point: [mode]}, {point: []}) == [(point, mode, None)]
    assert changes({}, {point: [mode]}) == [(point, None, mode)]
    assert "went" in movement(Change(point, mode, None))


def test_the_table_has_a_line_for_each_mode_with_what_it_was_and_is():
    was, now = Mode("chord", 0.5, 0.01), Mode("chord", 0.51, 0.02)
    told = (
        Record(None, ("deck", "advance")).told([Change(("wrats-888-on", "0.25"), was, now)], 9).splitlines()
    )
    assert told[0] == "1 modes moved, at 1 of 9 points:"
    assert told[-2].split("  ")[0] == "deck" and told[-2].endswith("damping, % of critical")
    line = "wrats-888-on 0.25 chord 0.50000 -> 0.51000, +1.0e-02 1.0000 -> 2.0000, +1.0e+00"
    assert told[-1].split() == line.split()
    assert told[-1].index("chord") == told[-2].index("coordinate")


def test_one_command_accepts_what_moved(tmp_path, capsys):
    record = Record(tmp_path / "modes.csv", ("knots",))
    modes = {(knots,): [Mode("chord", 0.5, 0.01)] for knots in ("200", "300")}
    accept_golden.accept(record, modes)
    assert record.kept() == modes
    moved = modes | {("300",): [Mode("chord", 0.6, 0.01)]}
    accept_golden.accept(record, moved)
    assert record.kept() == moved
    assert "1 modes moved, at 1 of 2 points" in capsys.readouterr().out.split("written: modes.csv")[1]
    accept_golden.accept(record, moved)
    assert capsys.readouterr().out == "nothing moved; modes.csv is as it was\n"
