"""Decks: the text of good ones spoiled, and tables of several put together at random."""

from __future__ import annotations

import contextlib
import functools
import io
import json
import re
import tomllib
from importlib import resources
from pathlib import Path
from random import Random
from typing import Any

import click
import numpy as np

import proprotor as pp
from proprotor.commands.main import main
from tests.fuzz import airfoils, supports
from tests.fuzz.mutation import NUMBERS, TEXTS, UNITS, other_lines, other_number, several, spoiled_bytes

# Kinds of support that no bundled deck has.
_MORE = {
    "pivot": """
kind = "pivot"
includes_rotor = false
distance = "3 ft"
pitch_inertia = "500 slug*ft**2"
yaw_inertia = "500 slug*ft**2"
pitch_stiffness = "2e6 ft*lbf/rad"
yaw_stiffness = "2e6 ft*lbf/rad"
""",
    "rigid": 'kind = "rigid"\n',
    "npz": 'kind = "matrices"\nfile = "support.npz"\nincludes_rotor = false\nmodes = 3\n',
    "mtx": """
kind = "matrices"
mass = "mass.mtx"
stiffness = "stiffness.mtx"
dofs = { value = "dofs.txt", status = "derived", source = "made up" }
includes_rotor = true
[support.hub]
x = "hub_x"
y = "-hub_y"
z = "hub_z"
alpha_x = "hub_alpha_x"
alpha_y = "hub_alpha_y"
alpha_z = "hub_alpha_z"
[support.wing_aerodynamics]
lift_slope = "5.7/rad"
chord = "5 ft"
elastic_axis = 0.35
span = "16 ft"
mast_length = "4 ft"
""",
}
_ASSIGNMENT = re.compile(r"^([A-Za-z_]+) *= *(.*)$", re.MULTILINE)
_QUOTED = re.compile(r'"([^"\n]*)"')
_OUTPUT = "out"
_SHARE_OF_LINEARIZED, _SHARE_OF_SWEPT = 0.3, 0.03


@functools.cache
def seeds() -> tuple[str, ...]:
    """The bundled decks, and one for each further kind of support and of airfoil."""
    folder = resources.files("proprotor.deck") / "decks"
    bundled = [(folder / f"{name}.toml").read_text(encoding="utf-8") for name in pp.list_cases()]
    more = [f'base = "xv15-uncoupled"\n[case]\nname = "fuzz"\n[support]\n{text}' for text in _MORE.values()]
    table = 'base = "xv15-uncoupled"\n[case]\nname = "fuzz"\n[rotor.airfoil]\ntable = "airfoil.c81"\n'
    by_region = 'region_ends = 0.6\nblend = 0.1\ntable = ["airfoil.c81", "airfoil.c81"]\n'
    return (*bundled, *more, table, table.replace('table = "airfoil.c81"\n', by_region))


def make(rng: Random) -> tuple[dict[str, bytes], dict]:
    """The files of an input by name, and how they are used."""
    kind = rng.random()
    if kind < 0.15:
        content = spoiled_bytes(rng, rng.choice(seeds()).encode(), [seed.encode() for seed in seeds()])
    elif kind < 0.65:
        ways = (
            other_number,
            other_number,
            other_lines,
            _other_value,
            _other_value,
            _other_text,
            _other_section,
        )
        content = several(rng, rng.choice(seeds()), ways).encode("utf-8", "replace")
    else:
        content = written(_put_together(rng)).encode("utf-8", "replace")
    files = {"deck.toml": content}
    if b".npz" in content:
        files["support.npz"] = supports.good_archive(6)
    if b".mtx" in content:
        files |= supports.good_market(6)
    if b".c81" in content:
        files["airfoil.c81"] = airfoils.SEEDS[1].encode()
    depth = rng.random()
    return files, {
        "linearized": depth < _SHARE_OF_LINEARIZED,
        "swept": depth < _SHARE_OF_SWEPT,
        "airspeed": rng.choice((0.0, 1e-9, 30.0, 100.0, 200.0, 300.0, 1e4)),
    }


def use(folder: Path, linearized: bool, swept: bool, airspeed: float) -> None:
    case = pp.load_case(folder / "deck.toml")
    if linearized:
        model = case.linearize(airspeed)
        assert bool(model.trim.converged) != bool(model.trim.reason), "a failed point must have its reason"
        if model.trim.converged:
            for name in "MCK":
                assert np.isfinite(getattr(model, name)).all(), f"{name} is not finite"
        model.modes()
        with contextlib.redirect_stdout(io.StringIO()):
            main(["cases", str(folder / "deck.toml")], standalone_mode=False)
    if swept:
        arguments = [
            "sweep",
            str(folder / "deck.toml"),
            "--speed",
            "50:250:100kt",
            "--csv",
            str(folder / _OUTPUT / "a"),
        ]
        told = io.StringIO()
        with (
            contextlib.redirect_stdout(told),
            contextlib.redirect_stderr(told),
            contextlib.suppress(click.exceptions.Exit),
        ):
            main(arguments, standalone_mode=False)
        assert (folder / _OUTPUT / "a").stat().st_size, "an empty result"


# Texts --------------------------------------------------------------------------------------------


def _value(rng: Random) -> Any:
    """A value of TOML, as Python has it."""
    number = rng.choice(NUMBERS)
    match rng.randrange(9):
        case 0 | 1 | 2:
            return f"{number} {rng.choice(UNITS)}"
        case 3:
            return rng.choice(TEXTS)
        case 4:
            return rng.choice(
                (0, 1, -1, 3, 10**6, 10**19, 0.0, -0.0, 1e308, float("nan"), float("inf"), True, False)
            )
        case 5:
            return {"value": _value(rng), "status": rng.choice(("published", "guessed")), "source": "x"}
        case 6:
            stations = sorted(rng.uniform(-0.1, 1.1) for _ in range(rng.randint(0, 4)))
            values = [rng.choice((0.0, 1.0, -1.0, 1e300, float("nan"))) for _ in range(rng.randint(0, 4))]
            return {
                rng.choice(("r_over_R", "y_over_span")): stations,
                "value": values,
                "unit": rng.choice(UNITS),
            }
        case 7:
            return [_value(rng) for _ in range(rng.randint(0, 2))]
        case _:
            return {rng.choice(("value", "collective", "name", "x")): _value(rng)}


def _other_value(rng: Random, text: str) -> str:
    """A field with another value, or that of another field."""
    found = list(_ASSIGNMENT.finditer(text))
    if not found:
        return text
    match = rng.choice(found)
    new = rng.choice(found)[2] if rng.random() < 0.4 else _literal(_value(rng))
    return text[: match.start(2)] + new + text[match.end(2) :]


def _other_text(rng: Random, text: str) -> str:
    """What stands between quotation marks: another unit, another text."""
    found = list(_QUOTED.finditer(text))
    if not found:
        return text
    match = rng.choice(found)
    number = match[1].split(" ")[0]
    new = f"{number} {rng.choice(UNITS)}" if rng.random() < 0.5 else rng.choice(TEXTS)
    return text[: match.start()] + _literal(new) + text[match.end() :]


def _other_section(rng: Random, text: str) -> str:
    """A section of another deck put in, where there may be one already."""
    sections = re.split(r"(?m)^(?=\[)", rng.choice(seeds()))
    place = rng.choice([0, *(match.start() for match in re.finditer(r"(?m)^\[", text)), len(text)])
    return text[:place] + rng.choice(sections) + text[place:]


# Tables -------------------------------------------------------------------------------------------


@functools.cache
def _tables() -> tuple[str, ...]:
    return tuple(json.dumps(tomllib.loads(seed)) for seed in seeds())


def _put_together(rng: Random) -> dict[str, Any]:
    """Tables of one deck with entries lost, replaced, or taken from the same place of another."""
    tables, other = (json.loads(rng.choice(_tables())) for _ in range(2))
    for _ in range(rng.choice((1, 1, 2, 4, 10))):
        inner, given = tables, other
        key = rng.choice(list(inner))
        while isinstance(inner[key], dict) and inner[key] and rng.random() < 0.8:
            given = given.get(key, {}) if isinstance(given, dict) else {}
            inner = inner[key]
            key = rng.choice(list(inner))
        match rng.randrange(4):
            case 0 if len(inner) > 1:
                del inner[key]
            case 1 if isinstance(given, dict) and given:
                key = rng.choice(list(given))
                inner[key] = given[key]
            case 2:
                inner[rng.choice((*inner, "extra", "modes", "value"))] = _value(rng)
            case _:
                inner[key] = _value(rng)
    return tables


def written(tables: dict[str, Any]) -> str:
    """A TOML file of the tables, each on one line."""
    return "\n".join(f"{_key(key)} = {_literal(value)}" for key, value in tables.items())


def _key(name: str) -> str:
    return name if re.fullmatch("[A-Za-z0-9_-]+", name) else json.dumps(name)


def _literal(value: Any) -> str:
    """A value as TOML writes it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(key)} = {_literal(entry)}" for key, entry in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_literal, value)) + "]"
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)
