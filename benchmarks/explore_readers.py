"""How long many readers of `proprotor explore` wait for their curves when all move their sliders at once.

OPENBLAS_NUM_THREADS=1 python -m benchmarks.explore_readers [--readers 1 8] [--moves 20] [--backend compiled]

The readers are sockets without a browser, in one process beside that of the server. Each moves a slider, waits until
its page tells of the move, and moves again; the server computes their maps in between. Times are those of a clock.
"""

from __future__ import annotations

import argparse
import asyncio
import time

import numpy as np

from tests.explore_reader import Reader
from tests.explore_server import serving

_PATH = "rotor.precone"


async def waited(address: str, count: int, moves: int) -> tuple[list[float], list[int]]:
    """Milliseconds that each move waited for its curves, and the number of maps that each reader got."""
    readers = [await Reader.opened(address) for _ in range(count)]
    maps, times = [0] * count, []

    async def move_all(place: int) -> None:
        reader = readers[place]
        for move in range(moves):
            value = 3 + 0.1 * place + 0.001 * move  # told with four digits
            start = time.perf_counter()
            await reader.move(_PATH, value)
            while f"precone {value:.4g} deg" not in reader.told:
                maps[place] += (await reader.answer()).count("map-post")
            times.append(1e3 * (time.perf_counter() - start))

    await asyncio.gather(*map(move_all, range(count)))
    for reader in readers:
        await reader.close()
    return times, maps


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--readers", type=int, nargs="+", default=[1, 8])
    parser.add_argument("--moves", type=int, default=20, help="at most 99")
    parser.add_argument("--backend", default="compiled")
    parser.add_argument("--case", default="xv15-uncoupled")
    given = parser.parse_args()
    print(f"{'readers':>8}{'median':>8}{'95 %':>8}{'most':>8}  ms until the curves; maps of each reader")
    with serving(given.case, "--backend", given.backend) as address:
        for count in given.readers:
            times, maps = asyncio.run(waited(address, count, given.moves))
            told = "".join(f"{value:>8.0f}" for value in (np.median(times), *np.percentile(times, [95, 100])))
            print(f"{count:>8}{told}  {min(maps)} to {max(maps)}", flush=True)


if __name__ == "__main__":
    main()
