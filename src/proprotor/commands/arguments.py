"""Arguments and options that several commands share, so that an option is the same in every command.

`case_argument` and `model_options` go together: the command gets the case, the fields of `--set` and the options of the
model as one `Request`.
"""

from __future__ import annotations

import inspect
import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import wraps
from typing import Any, NamedTuple

import click
from click.shell_completion import CompletionItem
from click.types import FloatParamType, StringParamType

from proprotor.case import Case, list_cases, load_case
from proprotor.commands.exit_codes import EXIT_CODES
from proprotor.commands.waiting import waiting
from proprotor.deck.vary import design_inputs
from proprotor.errors import InputError
from proprotor.rotor.options import CHOICES, LOCKABLE, Options, default_choice
from proprotor.tables.points import Points, Quantity, read_points
from proprotor.units import airspeed_unit, speeds, to_si

Command = Callable[..., Any]
Option = Callable[[Command], Command]  # a decorator

# Quantities that a file of `--points` may have, in any unit.
FREQUENCY = Quantity("frequency", "rad/s", 1.0, {"per rev": 1.0})
DAMPING = Quantity("damping", "", 1.0)

_NUMBERS = ("pitch_flap_coupling", "pitch_lag_coupling")  # options of the model that are plain numbers
_FLIGHT = ("shaft_angle", "load_factor")  # the angle with a unit, and a plain number
_MODEL = (
    *CHOICES,
    *_NUMBERS,
    *_FLIGHT,
    "locked",
)  # the options of the model, in the order in which results list them
_OF_DECK = " of deck"
_RANGE = re.compile(r"(?:[\d.:+\s-]|[eE](?=[\d+-]))*")  # the characters of a range; the unit follows them


def command(name: str | None = None, **settings: Any) -> Callable[[Command], click.Command]:
    """Make a function a command whose help ends with the exit codes; `settings` are those of `click.command`."""
    return click.command(name, epilog=EXIT_CODES, **settings)


class Request(NamedTuple):
    """The case that a command shall analyse, with the choices of the user.

    name : of a bundled case, or of a TOML file; settings : fields of `--set` with their values, as text; options : of
    the model, see `proprotor.rotor.options.Options`
    """

    name: str
    settings: Mapping[str, str]
    options: Mapping[str, Any]

    def load(self) -> Case:
        """Return the case of the deck, with the fields of `--set`.

        Raises
        ------
        InputError
            For a deck or field that cannot be used.
        """
        with waiting("Reading the deck"):
            return load_case(self.name, self.settings)


class Angle(FloatParamType):
    """The type of an angle with its unit, such as "5deg"; rad without a unit."""

    name = "angle"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        try:
            return float(value)
        except ValueError:
            pass
        try:
            return to_si(value, "rad")
        except InputError as error:
            self.fail(f"{value!r} {error.rule}", param, ctx)


class CaseName(StringParamType):
    """The type of an argument that is a bundled case or a TOML file; the shell completes it."""

    name = "case"

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        found = [name for name in list_cases() if name.startswith(incomplete)]
        return [CompletionItem(name) for name in found] or [CompletionItem(incomplete, type="file")]


class Field(StringParamType):
    """The type of an argument that is a field of a deck; the shell completes it."""

    name = "field"
    ending = ""

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        return [
            CompletionItem(f"{path}{self.ending}") for path in self.paths(ctx) if path.startswith(incomplete)
        ]

    def paths(self, ctx: click.Context) -> Iterable[str]:
        """Return the fields that the shell offers: all fields of decks."""
        from proprotor.deck.describe import deck_fields

        return dict.fromkeys(field.path for field in deck_fields())


class FieldOrCase(Field):
    """The type of an argument that is a field or a deck; the shell completes fields and bundled cases."""

    def paths(self, ctx: click.Context) -> Iterable[str]:
        """Return all fields of decks, and the bundled cases."""
        return (*super().paths(ctx), *list_cases())


class _Setting(Field):
    """The type of FIELD=VALUE; the shell completes the field."""

    name, ending = "setting", "="

    def paths(self, ctx: click.Context) -> Iterable[str]:
        """Return all fields of decks; entries of lists have the names that the case gives them."""
        plain = (path for path in super().paths(ctx) if "[NAME]" not in path)
        return dict.fromkeys((*plain, *(path for path in _numbers_of_case(ctx) if "[" in path)))


class Input(Field):
    """The type of an argument that is an input: a number of the case that may vary."""

    name = "input"

    def paths(self, ctx: click.Context) -> Iterable[str]:
        """Return the inputs of the case once the command line names one, and all fields of decks before."""
        return _numbers_of_case(ctx) or super().paths(ctx)


class InputValues(Input):
    """The type of INPUT=VALUES; the shell completes the input."""

    name, ending = "values", "="

    def paths(self, ctx: click.Context) -> Iterable[str]:
        """Return the airspeed and the inputs of the case."""
        return ("airspeed", *super().paths(ctx))


def _numbers_of_case(ctx: click.Context) -> tuple[str, ...]:
    """Return the inputs of the case on the command line; none before a case is given, or if it cannot be read."""
    # After an option that still misses its value, click leaves the words in args.
    name = ctx.params.get("case") or ctx.params.get("name") or next(iter(ctx.args), None)
    try:
        return tuple(design_inputs(load_case(name))) if name else ()
    except InputError:
        return ()


def case_argument(command: Command) -> Command:
    """Add CASE and `--set` to a command that has `model_options`; the command gets all three as `request`."""

    @wraps(command)
    def with_request(*, case: str, settings: tuple[str, ...], **given: Any) -> Any:
        options = _with_defaults({name: given.pop(name) for name in _MODEL})
        return command(request=Request(case, settings_of(settings), options), **given)

    return click.argument("case", type=CaseName())(set_option(with_request))


def set_option(command: Command) -> Command:
    """Add `--set` to a command; `settings_of` reads the texts that the user gave."""
    return click.option(
        "--set",
        "settings",
        multiple=True,
        type=_Setting(),
        metavar="FIELD=VALUE",
        help='Change a field of the deck for this run: rotor.precone="1.5 deg", operation.trim=windmill, '
        '"support.modes[beam].frequency=3 Hz". `proprotor describe` lists the fields. Frequencies in '
        "/rev keep the hertz that they have at the deck's own rotor speed. Repeatable.",
    )(command)


def settings_of(texts: tuple[str, ...]) -> dict[str, str]:
    """Return the fields and values of `--set`.

    Raises
    ------
    InputError
        For a text that is not FIELD=VALUE, or a field given twice.
    """
    found: dict[str, str] = {}
    for text in texts:
        path, value = name_and_value(
            "--set", text, 'must be a field and its value, such as rotor.precone="1.5 deg"'
        )
        if path in found:
            raise InputError("--set", text, "must not set a field twice")
        found[path] = value
    return found


def name_and_value(option: str, text: str, rule: str) -> tuple[str, str]:
    """Return the two sides of NAME=VALUE, without spaces around the sides.

    Raises
    ------
    InputError
        With the rule, if a side or the sign is missing.
    """
    name, _, value = (part.strip() for part in text.partition("="))
    if not name or not value:
        raise InputError(option, text, rule)
    return name, value


def limits(option: str, whole: str, text: str) -> Any:
    """Return the limits of an input: of ``"1:4 deg"``, or of ``"0.9:1.1 of deck"`` as factors of the deck's value.

    Raises
    ------
    InputError
        For anything else, with the whole text that the option was given.
    """
    low, colon, high = text.removesuffix(_OF_DECK).strip().partition(":")
    if not colon or ":" in high:
        raise InputError(option, whole, 'must have two limits, such as "rotor.precone=1:4 deg"')
    if not text.endswith(_OF_DECK):
        return f"{low.strip()} {unit_of(high)}", high.strip()
    from proprotor.study.sampling import Relative  # here, because most commands sample nothing

    try:
        return Relative(float(low), float(high))
    except ValueError:
        raise InputError(option, whole, 'must have two factors, such as "0.9:1.1 of deck"') from None


def scan_option(command: Command) -> Command:
    """Add `--scan`, the airspeeds between which a command searches for boundaries."""
    scan_help = (
        'Airspeeds between which to search: "50:400:5ktas" (kt is the same) or "50:400:5keas"; by default 0.2 to 1.2 '
        "of the tip speed."
    )
    return click.option("--scan", metavar="RANGE", help=scan_help)(command)


def points_option(command: Command) -> Command:
    """Add `--points`, a file of points to draw; `points_of` reads it."""
    points_help = 'CSV file of points to draw beside the results: "airspeed [ktas], damping [%], label".'
    return click.option("--points", metavar="FILE", help=points_help)(command)


def airspeed_points(density: float | None) -> Quantity:
    """Return the airspeed as a column of points may have it; in keas only in air of a known density (kg/m³)."""
    return Quantity("airspeed", "m/s", 1.0, {"keas": 1.0} if density else {})


def points_of(path: str | None, plot: str | None, across: Quantity, up: Sequence[Quantity]) -> Points | None:
    """Return the points of the file of `--points` for a plot with some axes; None without a file.

    Raises
    ------
    InputError
        Without `--plot`, and as `read_points` and `Points.check` of `proprotor.tables.points`.
    """
    if path is None:
        return None
    if plot is None:
        raise InputError("--points", path, "goes with --plot")
    points = read_points(path, "--points")
    points.check(across, up, "--points")
    return points


def range_option(meaning: str, *, required: bool = False) -> Option:
    """Return `--speed` for a command that takes a range of airspeeds; `meaning` is the help."""
    return click.option("--speed", required=required, metavar="RANGE", help=meaning)


def level_option(command: Command) -> Command:
    """Add `--level`; the command gets the damping ratio as `level`."""
    return click.option(
        "--level",
        default="0",
        show_default=True,
        metavar="DAMPING",
        callback=lambda _, __, text: _level_of(text),
        help='Damping ratio below which a mode counts as unstable: "3 %" or 0.03.',
    )(command)


def _level_of(text: str) -> float:
    """Return the damping ratio of ``"3 %"`` or ``"0.03"``.

    Raises
    ------
    InputError
        For a text that is no damping ratio.
    """
    try:
        level = to_si(text, "")
    except InputError as error:
        raise error.within("--level") from None
    if not -1 < level < 1:
        raise InputError("--level", text, 'must lie between -1 and 1; write three percent as "3 %"')
    return level


def one_speed(text: str, case: Case) -> float:
    """Return the single airspeed of `--speed` in the air of a case, m/s, true.

    Raises
    ------
    InputError
        For a text that is not exactly one airspeed.
    """
    found = speeds(text, "--speed", case.operation.density)
    if len(found) != 1:
        raise InputError("--speed", text, 'must be one speed, such as "300 kt"')
    return float(found[0])


def unit_of(text: str) -> str:
    """Return the unit of a value or range, as written; "" without a unit."""
    return _RANGE.sub("", text, count=1).strip()


def written_speed(text: str) -> str:
    """Return an airspeed of the command line with its unit as outputs name it: "350 KTAS" for "350kt"."""
    unit = unit_of(text)
    return f"{text.strip().removesuffix(unit).strip()} {airspeed_unit(unit)}"


def model_options(command: Command) -> Command:
    """Add a flag for each option of the model; names, choices and help are those of `proprotor.rotor.options`."""
    meanings = _meanings(Options)
    locked_help = f"{meanings['locked']} Repeatable."
    command = click.option("--locked", multiple=True, type=click.Choice(LOCKABLE), help=locked_help)(command)
    for name, kind in reversed([*zip(_FLIGHT, (Angle(), float), strict=True)]):
        command = click.option(f"--{name.replace('_', '-')}", type=kind, help=meanings[name])(command)
    for name in reversed(_NUMBERS):
        command = click.option(f"--{name.replace('_', '-')}", type=float, help=meanings[name])(command)
    for name, choices in reversed(CHOICES.items()):
        command = _model_option(name, choices, meanings[name])(command)
    return command


def _with_defaults(found: dict[str, Any]) -> dict[str, Any]:
    """Return the options of the model, with defaults in place of some options that are not given.

    Section damping that is not given gets the value that the model would take, so that results print and write this
    value. Other options that are not given are left out: the deck chooses the structure, the model the couplings.
    """
    if found["section_damping"] is None:
        found["section_damping"] = default_choice("section_damping", found)
    return {name: value for name, value in found.items() if value is not None}


def _model_option(name: str, choices: tuple[Any, ...], meaning: str) -> Option:
    """Return the option of the command line for one option of the model."""
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
    """Return the text of a docstring on each parameter; "" for all in a Python that drops docstrings (-OO)."""
    lines = inspect.getdoc(documented) or ""
    found = re.findall(r"^([\w, ]+) : .*\n((?:    .*\n)+)", lines, re.MULTILINE)
    meanings = {name: " ".join(text.split()) for names, text in found for name in names.split(", ")}
    return defaultdict(str, meanings)
