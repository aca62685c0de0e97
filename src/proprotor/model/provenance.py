"""Tell which numbers behind a result were not read in a source."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from proprotor.datum import Datum

if TYPE_CHECKING:
    from proprotor.model.configuration import Configuration

_READ_IN_A_SOURCE = ("published", "measured", "derived")


def doubtful_inputs(case: Configuration) -> dict[str, Datum]:
    """Return the inputs, by field, that are assumed, recalled, calibrated or of unstated origin."""
    return {path: n for path, n in case.sources.items() if n.status not in _READ_IN_A_SOURCE}


def reservations(case: Configuration) -> list[str]:
    """Return the sentences to show with every result of the case: on doubtful inputs, and on the calibration."""
    counts = Counter(number.status for number in doubtful_inputs(case).values())
    sentences = []
    if counts:
        counted = ", ".join(f"{count} {status}" for status, count in sorted(counts.items()))
        sentences.append(
            f"Rests on inputs that were not read in a source: {counted}, of {len(case.sources)}."
        )
    if case.calibration:
        sentences.append(f"Calibration: {case.calibration.rstrip('.')}.")
    return sentences
