"""A test point as a file of points gives it."""

import numpy as np

from proprotor.files.csv_columns import Head
from proprotor.tables.points import Column, Points


def measured_point() -> Points:
    """The frequency of the beam mode at one airspeed."""
    columns = {
        "airspeed": Column(*[np.array([180.0])] * 3, Head(0, "", "airspeed", "m/s")),
        "frequency": Column(
            *(np.array([end]) for end in (20.0, 19.0, 21.0)), Head(1, "", "frequency", "rad/s")
        ),
    }
    return Points("point", columns, *(np.array([word], dtype=object) for word in ("point", "", "beam")))
