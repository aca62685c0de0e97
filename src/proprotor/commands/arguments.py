"""Arguments and options that commands share, so that each is the same everywhere."""

from __future__ import annotations

import inspect
import re
from collections import defaultdict
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import click
from click.shell_completion import CompletionItem
from click.types import StringParamType

from proprotor.errors import InputError
from proprotor.rotor.options import CHOICES, LOCKABLE, Options, default_choice

if TYPE_CHECKING:
    from proprotor.case import Case

Command = Callable[..., Any]
Option = Callable[[Command], Command]  # a decorator

EXIT_CODES = """\b
Exit codes:
  0  done; unstable modes and single speeds that fail are results
  1  no speed could be analysed, or an output could not be written
  2  an input cannot be used: the message says which and why
  130  interrupted (Ctrl-C)"""

NUMBERS = ("pitch_flap_coupling", "pitch_lag_coupling")  # options of the model that are plain numbers
_RANGE = re.compile(r"(?:[\d.:+\s-]|[eE](?=[\d+-]))*")  # those of a range; what follows is the unit
_PERCENT_OF_LEVEL = 'Damping that counts as the boundary, of critical: "3 %" or 0.03.'


class CaseName(StringParamType):
    """A bundled case or a TOML file, which the shell completes."""

    name = "case"

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        from proprotor.deck.file import list_cases

        found = [name for name in list_cases() if name.startswith(incomplete)]
        return [CompletionItem(name) for name in found] or [CompletionItem(incomplete, type="file")]


class Field(StringParamType):
    """A field of a deck, which the shell completes."""

    name = "field"
    ending = ""

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        return [
            CompletionItem(f"{path}{self.ending}") for path in self.paths(ctx) if path.startswith(incomplete)
        ]

    def paths(self, ctx: click.Context) -> Iterable[str]:
        """Every field there is."""
        from proprotor.deck.describe import deck_fields

        return dict.fromkeys(field.path for field in deck_fields())


class Setting(Field):
    """FIELD=VALUE; the shell completes the field."""

    name, ending = "setting", "="

    def paths(self, ctx: click.Context) -> Iterable[str]:
        """Every field there is, entries of lists by the names that the case gives them."""
        plain = (path for path in super().paths(ctx) if "[NAME]" not in path)
        return dict.fromkeys((*plain, *(path for path in _numbers_of_case(ctx) if "[" in path)))


class Input(Field):
    """A number of the case that may vary, or the airspeed."""

    name = "input"

    def paths(self, ctx: click.Context) -> Iterable[str]:
        """Of the case, once it is given."""
        return _numbers_of_case(ctx) or super().paths(ctx)


class InputValues(Input):
    """INPUT=VALUES; the shell completes the input."""

    name, ending = "values", "="

    def paths(self, ctx: click.Context) -> Iterable[str]:
        """Of the case, and the airspeed."""
        return ("airspeed", *super().paths(ctx))


def _numbers_of_case(ctx: click.Context) -> tuple[str, ...]:
    """Inputs of the case on the command line; none before one is given, or while it cannot be read."""
    from proprotor.deck.vary import design_inputs

    # click leaves the words it could not place in args, as after an option that still misses its value
    name = ctx.params.get("case") or ctx.params.get("name") or next(iter(ctx.args), None)
    try:
        return tuple(design_inputs(loaded_case(name, ()))) if name else ()
    except InputError:
        return ()


def case_argument(command: Command) -> Command:
    """CASE and `--set`, for `loaded_case`."""
    return click.argument("case", type=CaseName())(set_option(command))


def set_option(command: Command) -> Command:
    """`--set`, for `settings_of`."""
    return click.option(
        "--set",
        "settings",
        multiple=True,
        type=Setting(),
        metavar="FIELD=VALUE",
        help='A field of the deck to set first, such as rotor.precone="1.5 deg", operation.trim=windmill or '
        '"support.modes[beam].frequency=3 Hz"; `proprotor describe` lists them. Frequencies in /rev are those of the '
        "deck's own rotor speed, and keep their hertz where another is set. Repeatable.",
    )(command)


def settings_of(texts: tuple[str, ...]) -> dict[str, str]:
    """Fields and values of `--set`.

    Raises
    ------
    InputError
        For a text that is not FIELD=VALUE, or a field given twice.
    """
    found: dict[str, str] = {}
    for text in texts:
        path, equals, value = (part.strip() for part in text.partition("="))
        if not equals or not path or not value:
            raise InputError("--set", text, 'must be a field and its value, such as rotor.precone="1.5 deg"')
        if path in found:
            raise InputError("--set", text, "must not set a field twice")
        found[path] = value
    return found


def loaded_case(name: str, settings: tuple[str, ...]) -> Case:
    """The case of a deck with the fields of `--set`.

    Raises
    ------
    InputError
        For a deck or field that cannot be used.
    """
    from proprotor.case import load_case

    return load_case(name, settings_of(settings))


SCAN_HELP = 'Where boundaries are looked for: "50:400:5kt"; by default 0.2 to 1.2 of the tip speed.'


def scan_option(command: Command) -> Command:
    """`--scan`, airspeeds between which boundaries are looked for."""
    return click.option("--scan", metavar="RANGE", help=SCAN_HELP)(command)


def level_option(command: Command) -> Command:
    """`--level`, for `level_of`."""
    return click.option("--level", default="0", show_default=True, metavar="DAMPING", help=_PERCENT_OF_LEVEL)(
        command
    )


def level_of(text: str) -> float:
    """A damping ratio from ``"3 %"`` or ``"0.03"``.

    Raises
    ------
    InputError
        For what is no damping ratio.
    """
    from proprotor.units import to_si

    try:
        level = to_si(text, "")
    except InputError as error:
        raise error.within("--level") from None
    if not -1 < level < 1:
        raise InputError("--level", text, 'must lie between -1 and 1; write three percent as "3 %"')
    return level


def one_speed(text: str, option: str = "--speed") -> float:
    """A single airspeed, m/s.

    Raises
    ------
    InputError
        For text that is not one.
    """
    from proprotor.units import speeds

    found = speeds(text, option)
    if len(found) != 1:
        raise InputError(option, text, 'must be one speed, such as "300 kt"')
    return float(found[0])


def unit_of(text: str) -> str:
    """The unit of a value or range, as written; "" for none."""
    return _RANGE.sub("", text, count=1).strip()


def model_options(command: Command) -> Command:
    """A flag for each choice of the model, as `proprotor.rotor.options` has them."""
    meanings = _meanings(Options)
    locked: dict[str, Any] = {
        "multiple": True,
        "type": click.Choice(LOCKABLE),
        "help": f"{meanings['locked']} Repeatable.",
    }
    command = click.option("--locked", **locked)(command)
    for name in reversed(NUMBERS):
        command = click.option(f"--{name.replace('_', '-')}", type=float, help=meanings[name])(command)
    for name, choices in reversed(CHOICES.items()):
        command = _model_option(name, choices, meanings[name])(command)
    return command


def in_order(options: dict[str, Any]) -> dict[str, Any]:
    """The options of the model, in a fixed order; a structure that is not given is the deck's.

    Section damping that is not given stands as the model takes it, so that what is printed and written says it.
    """
    found = {name: options[name] for name in (*CHOICES, *NUMBERS, "locked")}
    if found["section_damping"] is None:
        found["section_damping"] = default_choice("section_damping", found)
    return {name: value for name, value in found.items() if name != "structure" or value is not None}


def _model_option(name: str, choices: tuple[Any, ...], meaning: str) -> Option:
    flag = name.replace("_", "-")
    declared: dict[str, Any] = {"default": choices[0], "show_default": True, "help": meaning}
    if name == "structure":
        declared |= {"default": None, "show_default": "coupled; tabulated where the deck has frequencies"}
    if name == "section_damping":
        declared["show_default"] = "on; off with --equations published"
    if isinstance(choices[-1], bool):
        return click.option(f"--{flag}/--no-{flag}", name, **declared)
    return click.option(f"--{flag}", name, type=click.Choice(choices), **declared)


def _meanings(documented: type) -> dict[str, str]:
    """What the docstring says on each parameter; nothing in a Python without docstrings."""
    lines = inspect.getdoc(documented) or ""
    found = re.findall(r"^([\w, ]+) : .*\n((?:    .*\n)+)", lines, re.MULTILINE)
    meanings = {name: " ".join(text.split()) for names, text in found for name in names.split(", ")}
    return defaultdict(str, meanings)
