"""Frequency and damping of modes from records: time histories that a test, or a simulation, left behind.

In come records, free decays sampled evenly; out come the frequency and damping of their modes with standard errors,
which follow from the noise that each record shows. Nothing here knows a rotor.

    record               the record Record: time and channels; `read_record` takes it from a CSV file
    identify             frequency and damping by one of three methods, as a dataset
    least_squares        several modes in several channels by least squares, with the covariance of their roots
    realisation          roots to start from, by the eigensystem realisation algorithm
    single_mode          what methods for one mode share: its strongest line, and the noise beside it
    logarithmic_decrement    one mode by the ratio of successive cycles
    moving_block         one mode by blocks that move along the record
    root_errors          errors of frequency and damping ratio from those of a root

The room may import the ground: `errors`, `typing`, `needs`, `units` and `files`.
"""

from proprotor.records.identify import identify
from proprotor.records.record import Record, read_record

__all__ = ["Record", "identify", "read_record"]
