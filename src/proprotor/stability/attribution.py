"""What makes a mode grow or decay: its eigenvalue by the physical origin of the matrices.

If all terms of one origin grew by a small part ε, an eigenvalue would move by ε times

    λ_g = -yᴴ(λ² M_g + λ C_g + K_g) x / yᴴ(2λM + C) x ,

which is computed here for each origin g, with trim, mode and all other terms held. Where Re λ_g is positive the
origin drives the mode. If the terms of all origins grow alike nothing moves: the sum of λ_g is zero.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from proprotor.model import stamp
from proprotor.model.configuration import Configuration
from proprotor.stability.eigenvalue_derivatives import eigenvalue_change
from proprotor.stability.named_modes import doubtful_numbers, named_modes
from proprotor.stability.origins import model_parts
from proprotor.typing import Dataset


def attribution(case: Configuration, airspeed: Any, mode: str | None = None, **options: Any) -> Dataset:
    """Return what drives and what damps the modes of a case at one airspeed.

    Parameters
    ----------
    case : Case
    airspeed : float in m/s, text such as "300 kt", or pint quantity
    mode : str, optional
        One mode by what moves at the airspeed; all by default.
    **options
        See `proprotor.rotor.options.Options`.

    Returns
    -------
    xarray.Dataset
        contribution (origin, mode), rad/s: the change of the eigenvalue if all terms of an origin grew by 100 %, to
        first order; growth, its real part, positive where the origin drives the mode; eigenvalue (mode,); warning, what
        makes the numbers doubtful. Attributes: airspeed in m/s, and the case and its options (`proprotor.model.stamp`).

    Raises
    ------
    InputError
        For a value that is no single airspeed, an airspeed that cannot be analysed, and an unknown mode.
    """
    import xarray  # here, because it takes long to import

    found = named_modes(case, airspeed, mode, options)
    parts = model_parts(case, found.model, **options)
    # λ_g of each part and mode; the sum over all parts is zero.
    changes = np.stack([eigenvalue_change(found.model, part, found.modes) for part in parts.values()])
    by_origin, units = ("origin", "mode"), {"units": "rad/s"}
    return xarray.Dataset(
        {
            "contribution": (by_origin, changes, units),
            "growth": (by_origin, changes.real, units),
            "eigenvalue": ("mode", found.modes.values, units),
            "warning": doubtful_numbers(found.model.trim.warning),
        },
        coords={"origin": list(parts), "mode": found.names},
        attrs=stamp.of_model(found.model) | {"airspeed": found.speed},
    )
