"""Many readers of one server at once: each is answered, with what that reader has set."""

import asyncio
import re

import numpy as np

import proprotor as pp
from proprotor.explore.analysis import live_modes
from proprotor.explore.inputs import first_inputs, slider_input
from tests.explore_reader import Reader
from tests.explore_server import serving

SPEEDS = "200:400:25kt"
READERS, MOVES = 8, 5
KNOT = 1852 / 3600


def places(case):
    """For each reader another slider, and where the reader moves it: the last place is 0.7 of its range."""
    sliders = [slider_input(case, path) for path in first_inputs(case)[:READERS]]
    parts = np.linspace(0.4, 0.7, MOVES)
    return {
        one.path: [float(f"{one.low + part * (one.high - one.low):.4g}") for part in parts] for one in sliders
    }


def flutter(told):
    found = re.search(r"Flutter speed ([\d.]+) KTAS", told)
    return found and float(found[1])


async def moved(address, moves):
    """What each reader's page tells after all have moved their sliders at once, and what it told on the way."""
    readers = [await Reader.opened(address) for _ in moves]

    async def move_all(reader, path, values):
        for value in values:
            await reader.move(path, value)
            await asyncio.sleep(0.02)
        heard = []
        while not heard or f" {values[-1]:.4g} " not in heard[-1]:
            await reader.answer()
            heard.append(reader.told)
        return heard

    pairs = zip(readers, moves.items(), strict=True)
    heard = await asyncio.gather(*(move_all(one, *move) for one, move in pairs))
    for reader in readers:
        await reader.close()
    return heard


def test_each_of_eight_readers_gets_the_latest_answer_to_that_readers_own_moves():
    case = pp.load_case("xv15-uncoupled")
    moves, speeds = places(case), np.arange(200, 401, 25) * KNOT
    assert len(moves) == READERS
    with serving("xv15-uncoupled", "--speed", SPEEDS) as address:
        heard = asyncio.run(moved(address, moves))
    for told, (path, values) in zip(heard, moves.items(), strict=True):
        given = slider_input(case, path)
        others = {slider_input(case, other).name for other in moves} - {given.name}
        assert not [other for text in told for other in others if f"{other} " in text], path
        wanted = live_modes(case, speeds, {path: values[-1] * given.factor}).flutter
        assert f"Changed: {given.name} {values[-1]:.4g}" in told[-1]
        assert flutter(told[-1]) == (wanted and float(f"{wanted.start / KNOT:.1f}")), path
