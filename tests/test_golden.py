"""Modes of every deck and of every combination of switches are the accepted ones, until others are accepted."""

import itertools

import pytest

import proprotor as pp
from proprotor.options import CHOICES
from tests import accept_golden
from tests.golden import decks, switches
from tests.golden.modes import COMMAND, Change, Mode, Record, accepted, changes, movement

SOURCES = {"switches": switches, "decks": decks}


@pytest.mark.parametrize("name", SOURCES)
def test_modes_are_the_accepted_ones(name):
    record, now = SOURCES[name].RECORD, SOURCES[name].computed()
    if found := changes(record.kept(), now):
        told = f"`{COMMAND}` accepts this and leaves it to be seen in review."
        pytest.fail(f"{record.told(found, len(now))}\n{told}", pytrace=False)


def test_every_combination_is_there():
    choices = [map(str, CHOICES[name]) for name in switches.SWITCHES]
    assert list(switches.RECORD.kept()) == list(itertools.product(*choices, map(str, switches.KNOTS)))
    points = itertools.product(pp.list_cases(), decks.CHOICES, map(str, decks.ADVANCE))
    assert list(decks.RECORD.kept()) == list(points)


@pytest.mark.parametrize("moved", [{"frequency": 0.5 * (1 + 3e-8)}, {"damping_ratio": 0.01 + 3e-8}])
def test_a_small_change_is_found_told_and_alone_accepted(moved):
    mode, other = Mode("chord", 0.5, 0.01), Mode("beam", 0.3, 0.02)
    defaults = tuple(str(CHOICES[name][0]) for name in switches.SWITCHES)
    points = [(*defaults, "200"), (*defaults, "300")]
    was = {point: [other, mode] for point in points}
    rounded = other._replace(damping_ratio=0.02 + 1e-12)
    now = {points[0]: [rounded, mode], points[1]: [rounded, mode._replace(**moved)]}
    (change,) = changes(was, now)
    assert change == (points[1], mode, mode._replace(**moved))
    told = switches.RECORD.told([change], 2)
    assert "chord" in told and "300 1" in told
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
