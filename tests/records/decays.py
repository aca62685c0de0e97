"""Records of free decays with known modes: sums of decaying sinusoids by their definition, an offset and noise."""

import numpy as np

from proprotor.records import Record

HERTZ = 2 * np.pi
BEAM = (3.2, 0.03, 1.0, 0.4)  # Hz (damped), damping ratio, amplitude, phase


def decay(modes=(BEAM,), *, seed=0, noise=0.05, seconds=4.0, rate=200.0, channels=1, offset=0.3):
    """A record whose channels differ in phase; noise is the standard deviation in each sample."""
    random = np.random.default_rng(seed)
    time = np.arange(0, seconds, 1 / rate)
    columns = []
    for channel in range(channels):
        column = np.full_like(time, offset)
        for hertz, ratio, size, phase in modes:
            omega = HERTZ * hertz
            envelope = size * np.exp(-ratio / np.sqrt(1 - ratio**2) * omega * time)
            column += envelope * np.cos(omega * time + phase + channel)
        columns.append(column + noise * random.standard_normal(len(time)))
    return Record(time, np.array(columns).T, [f"channel {place}" for place in range(channels)])
