"""A study in a few numbers: points that failed, doubts, the range of flutter speeds or the lowest damping."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np

from proprotor.errors import InputError
from proprotor.model.doubts import reasons_for_doubt
from proprotor.study.uncertainty import distribution
from proprotor.tables.sobol_table import sobol_summary
from proprotor.typing import DataArray, Dataset


def study_summary(results: Dataset) -> dict[str, Any]:
    """Return the results of a study in a few numbers, as plain data.

    Parameters
    ----------
    results : xarray.Dataset
        Of `proprotor.study`.

    Returns
    -------
    dict
        title; points, how many failed and why, the most frequent reason first, and how many are doubtful and why;
        reservations; of flutter speeds how many were found and are doubtful, how many lie above or below the airspeeds,
        the lowest and the highest in m/s, of a sample percentiles, of a Saltelli sample shares of the variance; without
        flutter speeds how many points are unstable, and the lowest damping.
    """
    reasons = _most_frequent(results.reason)
    summary: dict[str, Any] = {
        "title": results.title,
        "points": int(results.reason.size),
        "failed": sum(reasons.values()),
        "reasons": reasons,
        "points doubtful": int((results.warning != "").sum()),
        "doubts of points": _doubts(results.warning),
        "reservations": results.attrs["reservations"],
    }
    if "flutter_speed" in results:
        return summary | _of_flutter_speeds(results) | _percentiles(results) | sobol_summary(results)
    if summary["failed"] == summary["points"]:
        return summary
    return summary | {
        "points unstable": int((results.growth_rate > 0).sum()),
        "lowest damping (% of critical)": 100 * float(results.damping_ratio.min()),
    }


def _most_frequent(texts: DataArray) -> dict[str, int]:
    """Return how often each text stands in an array, the most frequent first; empty texts do not count."""
    return dict(Counter(str(text) for text in texts.values.ravel() if text).most_common())


def _doubts(warnings: DataArray) -> dict[str, int]:
    """Return the number of warnings by reason."""
    return {text: len(places) for text, places in reasons_for_doubt(warnings.values.ravel().tolist()).items()}


def _of_flutter_speeds(results: Dataset) -> dict[str, Any]:
    found = np.asarray(results.flutter_speed.values, dtype=float)
    speeds = np.sort(found[np.isfinite(found)])
    return {
        "flutter speeds found": len(speeds),
        "flutter speeds doubtful": int((results.flutter_warning != "").sum()),
        "doubts": _doubts(results.flutter_warning),
        "flutter speeds above the airspeeds": int(np.isfinite(results.flutter_speed_above.values).sum()),
        "flutter speeds below the airspeeds": int(np.isfinite(results.flutter_speed_below.values).sum()),
        "lowest flutter speed (m/s)": float(speeds[0]) if len(speeds) else None,
        "highest flutter speed (m/s)": float(speeds[-1]) if len(speeds) else None,
        "notes": _most_frequent(results.flutter_note),
    }


def _percentiles(results: Dataset) -> dict[str, Any]:
    """Return percentiles of the flutter speeds of a sample; nothing for designs that were chosen, as in a grid."""
    if "sample" not in results.attrs:
        return {}
    try:
        found = distribution(results)
    except InputError:  # no flutter speed is known
        return {}
    bounds = zip(found.percentile.values, found.at_least.values, found.at_most.values, strict=True)
    names = ("percentile", "at least (m/s)", "at most (m/s)")
    return {
        "percentiles of the flutter speed": [dict(zip(names, map(float, row), strict=True)) for row in bounds]
    }
