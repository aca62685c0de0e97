"""The deck of a calibrated case: calibrated numbers say so, and the deck says to which points."""

from __future__ import annotations

import os
from collections.abc import Mapping

from proprotor.calibration.calibrate import Calibration
from proprotor.datum import Datum, deck_unit
from proprotor.deck.file import read_tables


def calibrated_deck(
    calibration: Calibration,
    base: str | os.PathLike[str],
    file: str | os.PathLike[str],
    settings: Mapping[str, str] | None = None,
) -> str:
    """Return the text of a deck with the calibrated inputs, complete without the deck that it was made from.

    Parameters
    ----------
    calibration : Calibration
    base : str or path
        Bundled deck or TOML file of the case that was calibrated.
    file : str or path
        Place of the new deck: names of files start from its folder, and the case takes its name.
    settings : mapping of str to str, optional
        Fields with which the case was loaded, as for `proprotor.case.load_case`.

    Returns
    -------
    str

    Raises
    ------
    InputError
        For a base that cannot be read.
    """
    # Here, because the fields of decks take long to import.
    from proprotor.deck.settings import with_settings
    from proprotor.deck.template import deck_text, toml

    found = calibration.found
    tables = read_tables(base)
    source = f"calibrated to {found.attrs['points']}"
    changed = dict(settings or {})
    for path, value, error in zip(
        found.input.values.tolist(), found.value.values, found.standard_error.values, strict=True
    ):
        number = calibration.case.given[path]
        texts = {
            "value": _written(number, float(value)),
            "status": "calibrated",
            "source": f"{source}, standard error {_written(number, float(error), 3)}",
        }
        changed[path] = toml(texts)
    case = tables.get("case", {})
    title = case.get("title") or case.get("name", "")
    changed["case.title"] = toml(f"{title} ({source})".strip())
    modes = ", ".join(dict.fromkeys(found["mode"].values.tolist()))
    quantities = " and ".join(dict.fromkeys(found.quantity.values.tolist()))
    earlier = f"{case['calibration'].rstrip('.')}. " if case.get("calibration") else ""
    changed["case.calibration"] = toml(
        f"{earlier}{found.attrs['inputs']} to the {quantities} of {modes} in {found.attrs['points']}"
    )
    return deck_text(with_settings(tables, changed), file, str(base))


def _written(number: Datum, value: float, digits: int = 12) -> str:
    """Return a value in the unit in which the deck has the number; a frequency per revolution in rad/s."""
    unit, factor = deck_unit(number)
    if unit == "/rev":
        unit, factor = "rad/s", 1.0
    return f"{value / factor:.{digits}g} {unit}".strip()
