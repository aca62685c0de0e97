"""Files of studies: what a study is asked, as TOML, to ask the same again.

Paths in a file start from its folder::

    [study]
    case = "xv15"
    plan = "latin-hypercube"
    size = 100
    seed = 0
    airspeed = "160:440:40kt"
    quantities = ["flutter"]

    [inputs]
    "rotor.precone" = { low = "1 deg", high = "4 deg" }
    "support.chord_frequency" = { low = 0.9, high = 1.1, relative = true }

    [options]
    pitch = "coupling"

    [outputs]
    csv = "study.csv"
"""

from __future__ import annotations

import json
import os
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from proprotor.case import Case, list_cases, load_case
from proprotor.errors import InputError, check_known
from proprotor.files.output import check_place, write_whole
from proprotor.files.text import read_text
from proprotor.model.deck_fingerprint import deck_fingerprint
from proprotor.rotor.blade_frequencies import BladeFrequencies
from proprotor.rotor.drive_train import DriveTrain
from proprotor.study import sampling
from proprotor.study.description import ATTRIBUTE, IN_RESULTS, NONE
from proprotor.study.designs import Plan
from proprotor.typing import Dataset
from proprotor.units import as_si

_TABLES = {
    "study": (
        *("case", "deck", "plan", "size", "seed", "second_order", "drawn"),
        *("airspeed", "quantities", "tolerance"),
    ),
    "set": (),
    "vary": (),
    "inputs": (),
    "options": (),
    "outputs": ("results", "csv", "json"),
}
_PLANS = {
    "grid": sampling.grid,
    "points": sampling.points,
    "latin-hypercube": sampling.latin_hypercube,
    "sobol": sampling.sobol,
    "saltelli": sampling.saltelli,
}
_OF_PLAN = ("size", "seed", "second_order", "drawn")
_RECORDS = {"frequencies": BladeFrequencies, "drive_train": DriveTrain}
_DISTRIBUTION = ("low", "high", "relative", "logarithmic", "mean", "deviation", "scipy", "args", "kwds")
_LARGEST = 100_000_000  # bytes

_Description = dict[str, Any]


def read_study(path: str | os.PathLike[str]) -> _Description:
    """Return the tables of a study file, with paths from the working folder.

    Parameters
    ----------
    path : str or path
        A .toml file.

    Raises
    ------
    InputError
        When the file cannot be read, is no TOML, or has a table or an entry that no study has.
    """
    label = os.fspath(path)
    try:
        tables = tomllib.loads(read_text(Path(path), "study", label, _LARGEST))
    except ValueError as error:
        if isinstance(error, InputError):
            raise
        raise InputError("study", label, f"is not TOML: {error}") from None
    for name, entries in tables.items():
        check_known("study", name, _TABLES, "table")
        if not isinstance(entries, dict):
            raise InputError("study", label, f"must have [{name}] as a table")
        for entry in entries if _TABLES[name] else ():
            check_known(name, entry, _TABLES[name], "entry")
    for table, entry in (("study", "case"), *(("outputs", name) for name in tables.get("outputs", ()))):
        given = tables.get(table, {}).get(entry)
        known = entry == "case" and given in ("", *list_cases())  # a case without a deck has no name
        if isinstance(given, str) and not known:
            tables[table][entry] = os.path.normpath(Path(path).parent / given)
    return tables


def is_study_file(path: str | os.PathLike[str]) -> bool:
    """Return whether a path is that of a TOML file with a table [study]; a deck has none.

    Parameters
    ----------
    path : str or path
    """
    place = Path(path)
    if place.suffix.lower() != ".toml" or not place.is_file():
        return False
    try:
        return isinstance(tomllib.loads(read_text(place, "study", str(path), _LARGEST)).get("study"), dict)
    except ValueError:
        return False


def _description_of(results: Dataset) -> _Description:
    """Return what the study of some results was asked, with the lists of values that its coordinates hold.

    Parameters
    ----------
    results : xarray.Dataset
        Of `proprotor.study`.

    Raises
    ------
    InputError
        When the results do not say what was asked.
    """
    if ATTRIBUTE not in results.attrs:
        rule = "must say what was asked, as results of proprotor.study do whose attributes were kept"
        raise InputError("results", None, rule)
    found: _Description = json.loads(results.attrs[ATTRIBUTE])
    for name, values in found["inputs"].items():
        if values == IN_RESULTS:
            found["inputs"][name] = results[name].values.tolist()
    if found["study"].get("airspeed") == IN_RESULTS:
        found["study"]["airspeed"] = results["airspeed"].values.tolist()
    return found


def save_study(
    results: Dataset, path: str | os.PathLike[str], outputs: Mapping[str, str] | None = None
) -> None:
    """Write a file from which the study of some results can be repeated: ``proprotor.study(path)``.

    Parameters
    ----------
    results : xarray.Dataset
        Of `proprotor.study`.
    path : str or path
        Ends in ``.toml``. A file that exists is replaced.
    outputs : mapping of str to str, optional
        Files that the command `proprotor study` writes when it repeats the study: ``results`` (.nc), ``csv``, ``json``.

    Raises
    ------
    InputError
        When the results do not say what was asked, or the path does not end in ``.toml`` or cannot be written.
    OSError
        When the file cannot be written.
    """
    found = _description_of(results)
    check_place(path, ".toml")
    folder = Path(path).resolve().parent
    case = found["study"]["case"]
    if case and case not in list_cases():
        found["study"]["case"] = os.path.relpath(case, folder)
    if outputs:
        found["outputs"] = {name: os.path.relpath(place, folder) for name, place in outputs.items()}
    text = "# A study: `proprotor study` with this file repeats it.\n"
    for table in _TABLES:
        entries = found.get(table)
        if entries:
            text += "\n".join(["", f"[{table}]", *(_entry(*entry) for entry in entries.items()), ""])
    write_whole(path, lambda file: file.write(text.encode()))


def _entry(name: str, value: Any) -> str:
    from proprotor.deck.template import toml  # here, because pydantic takes long to import

    quoted = name if name.replace("_", "").isalnum() and name.isascii() else toml(name)
    return f"{quoted} = {toml(value)}"


def repeated(
    case: Case | Dataset | str | os.PathLike[str], inputs: Any, given: Mapping[str, Any]
) -> dict[str, Any] | None:
    """Return the arguments of the study that a file or results stand for; None for a study with inputs of its own.

    Parameters
    ----------
    case, inputs : object
        As for `proprotor.study`.
    given : mapping
        Other arguments; None for those that were not given.

    Raises
    ------
    InputError
        When an argument is given that stands in the study to repeat, when something of the study was not written out,
        or when the deck of the study has changed.
    """
    own = case if isinstance(case, Case) else None
    source: Any = case if own is None else inputs
    if isinstance(source, str | os.PathLike):
        description = read_study(source)
    elif hasattr(source, "attrs"):
        description = _description_of(source)
    elif own is None:
        raise InputError(
            "case", case, "must be a case of proprotor.load_case, a file of a study, or its results"
        )
    else:
        return None
    for name, value in {**given, "inputs": inputs if own is None else None}.items():
        if value is not None:
            raise InputError(name, value, "stands in the study that is repeated: leave it out")
    return _asked(description, own)


def _asked(description: _Description, case: Case | None) -> dict[str, Any]:
    """Return the arguments of `proprotor.study` that a description stands for, for its own or another case.

    Raises
    ------
    InputError
        When something of the study was not written out, or the deck is not the one of the study any more.
    """
    own = description.get("study", {})
    case = case or _case_of(description)
    if own.get("deck", deck_fingerprint(case)) != deck_fingerprint(case):
        rule = (
            f"must be the case of the study, whose deck had the fingerprint {own['deck']}: its numbers differ"
        )
        raise InputError("case", case.name, rule)
    options = {name: _option(name, value) for name, value in description.get("options", {}).items()}
    found = {name: own[name] for name in ("airspeed", "quantities", "tolerance") if name in own}
    return {"case": case, "inputs": _plan_of(description), **found, **options}


def _case_of(description: _Description) -> Case:
    """Return the case of a description, with what was set and varied in it."""
    name = description.get("study", {}).get("case")
    if not name:
        rule = "must be given again: the study was not of a case that was loaded from a deck"
        raise InputError("case", None, rule)
    case = load_case(name, description.get("set"))
    varied = description.get("vary", {})
    for path, value in varied.items():
        if isinstance(value, str):
            raise InputError("case", path, f"must be given again: the study was of a case with {value}")
    return case.vary(varied) if varied else case


def _plan_of(description: _Description) -> Plan:
    """Return the plan of the inputs of a description."""
    own = description.get("study", {})
    method = str(own.get("plan", "grid")).replace(" ", "-")
    check_known("plan", method, _PLANS, "plan")
    read = _values if method in ("grid", "points") else _distribution
    inputs = {_path(label): read(label, given) for label, given in description.get("inputs", {}).items()}
    settings = {name: own[name] for name in _OF_PLAN if name in own}
    try:
        plan: Plan = _PLANS[method](inputs, **settings)  # type: ignore[operator]
    except TypeError:
        given = ", ".join(settings) or "no settings"
        raise InputError(
            "plan", method, f"does not go with {given}: a sample has a size and may have a seed"
        ) from None
    return plan


def _path(label: str) -> str | tuple[str, ...]:
    """Return the deck path of an input, or the paths of inputs that vary together, from its label."""
    paths = tuple(part.strip() for part in label.split(","))
    return paths if len(paths) > 1 else label


def _values(label: str, given: Any) -> Any:
    if given == IN_RESULTS:
        raise InputError(label, given, "must be a list of values: repeat the study from its results")
    return given


def _distribution(label: str, given: Any) -> Any:
    """Return the distribution of an input from a table."""
    if not isinstance(given, Mapping):
        return given  # a pair of limits
    if "unknown" in given:
        rule = "must be given again: it was a distribution that cannot be written"
        raise InputError(label, given["unknown"], rule)
    for name in given:
        check_known(label, name, _DISTRIBUTION, "entry of a distribution")
    if "scipy" in given:
        return _of_scipy(label, given)
    pair = ("mean", "deviation") if "mean" in given else ("low", "high")
    if not set(pair) <= set(given):
        raise InputError(label, dict(given), "must have low and high, mean and deviation, or scipy")
    first, second = (given[name] for name in pair)
    if pair[0] == "mean":
        return sampling.Normal(first, second)
    if given.get("relative"):
        low, high = (float(as_si(factor, "", label)) for factor in (first, second))
        return sampling.Relative(low, high, bool(given.get("logarithmic", False)))
    return (sampling.LogRange if given.get("logarithmic") else sampling.Range)(first, second)


def _of_scipy(label: str, given: Mapping[str, Any]) -> Any:
    """Return a frozen distribution of scipy.stats by its name."""
    from scipy import stats  # here, because it takes long to import

    known = [name for name, one in vars(stats).items() if isinstance(one, stats.rv_continuous)]
    check_known(label, given["scipy"], known, "distribution of scipy.stats")
    try:
        return getattr(stats, given["scipy"])(*given.get("args", ()), **given.get("kwds", {}))
    except TypeError as error:
        raise InputError(label, dict(given), f"must have the arguments of scipy.stats: {error}") from None


def _option(name: str, value: Any) -> Any:
    """Return an option of the model from plain data."""
    if name in _RECORDS and value == NONE:
        return None
    parts = value.values() if isinstance(value, Mapping) else [value]
    lost = next((part for part in parts if str(part).startswith(("function ", "array of shape"))), None)
    if lost is not None:
        raise InputError(name, None, f"must be given again: the study had {lost}")
    if name in _RECORDS and isinstance(value, Mapping):
        return _RECORDS[name](**value)
    return tuple(value) if isinstance(value, list) and name == "locked" else value
