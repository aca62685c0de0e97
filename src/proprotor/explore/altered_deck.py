"""A deck with the settings of the page, so that a reader can keep the settings."""

from __future__ import annotations

import functools
import operator
from collections.abc import Mapping
from typing import Any

from proprotor.case import Case
from proprotor.deck.file import read_tables
from proprotor.deck.per_revolution import as_one_file
from proprotor.deck.settings import with_settings
from proprotor.deck.template import toml
from proprotor.deck.vary import list_of
from proprotor.deck.written import PerRevolution
from proprotor.explore.inputs import slider_input
from proprotor.rotor.options import CHOICES, default_choice


def _settings_of_values(case: Case, values: Mapping[str, float]) -> dict[str, str]:
    """Return SI values by path as texts for a deck, in the units of the case's own deck."""
    found = _lists_by_region(case, {path: value for path, value in values.items() if list_of(path)})
    for path, value in values.items():
        if list_of(path):
            continue
        slider = slider_input(case, path)
        number = f"{value / slider.factor:.12g}"
        text = number + ("" if slider.unit.startswith("/") else " " * bool(slider.unit)) + slider.unit
        found[path] = PerRevolution.of(text, slider.factor) if slider.unit == "/rev" else text
    return found


def _lists_by_region(case: Case, values: Mapping[str, float]) -> dict[str, str]:
    """Return whole lists by region, in SI units, as texts for a deck, of which some entries have other values."""
    numbers = case.vary(values).given if values else {}
    found = {}
    for path in dict.fromkeys(map(list_of, values)):
        unit = f", unit = {toml(numbers[path].unit)}" if numbers[path].unit else ""
        entries = ", ".join(f"{float(value):.12g}" for value in numbers[path].si)
        found[path] = f"{{ value = [{entries}]{unit} }}"
    return found


def altered_deck(
    base: str,
    case: Case,
    values: Mapping[str, float],
    settings: Mapping[str, str] | None = None,
    options: Mapping[str, Any] | None = None,
) -> str:
    """Return the text of a deck that alters another; each changed number is marked as assumed.

    Frequencies keep their hertz: if the new deck has another rotor speed, frequencies per revolution are written in
    rad/s.

    Parameters
    ----------
    base : str
        Name of a bundled deck, or of a file in the folder of the new deck.
    case : Case
        Case of the base with the settings.
    values : mapping of str to float
        SI values by path.
    settings : mapping of str to str, optional
        Fields that were set before, on the command line.
    options : mapping, optional
        Options of the model. A deck holds no options, so a comment lists the options that are no default.

    Raises
    ------
    InputError
        For a path that is no input.
    """
    changed = dict(settings or {}) | _settings_of_values(case, values)
    tables = as_one_file(with_settings(read_tables(base), changed))
    lines = ["# Made by `proprotor explore`: the fields below replace those of the base."]
    chosen = {name: value for name, value in (options or {}).items() if name in CHOICES}
    flags = [_flag(name, value) for name, value in chosen.items() if value != default_choice(name, chosen)]
    if flags:
        lines.append(f"# Explored with {' '.join(flags)}")
    lines += [f"base = {toml(base)}", "", "[case]", f"name = {toml(explored_name(case))}"]
    lines.append(f"title = {toml(tables['case'].get('title', case.name))}")
    sections: dict[str, list[str]] = {}
    for path in changed:
        section, _, name = path.rpartition(".")
        if "[" not in path and section != "case":
            value = functools.reduce(operator.getitem, path.split("."), tables)
            sections.setdefault(section, []).append(f"{name} = {toml(value)}")
    for section, entries in sorted(sections.items()):
        lines += ["", f"[{section}]", *entries]
    # A list replaces the list of the base, so all entries are written.
    for listed in dict.fromkeys(path.partition("[")[0] for path in changed if "[" in path):
        whole: Any = functools.reduce(operator.getitem, listed.split("."), tables)
        for one in whole:
            lines += ["", f"[[{listed}]]", *(f"{name} = {toml(value)}" for name, value in one.items())]
    return "\n".join(lines) + "\n"


def explored_name(case: Case) -> str:
    """Return the name of the deck with the settings of the page."""
    return f"{case.name.removesuffix('-explored')}-explored"


def _flag(name: str, value: Any) -> str:
    flag = name.replace("_", "-")
    if isinstance(value, bool):
        return f"--{flag}" if value else f"--no-{flag}"
    return f"--{flag} {value}"
