"""Physical units: text such as ``"12.5 ft"``, quantities and labelled arrays become SI numbers.

The units listed below are known and no others. An angle is a dimension of its own here, which
pint's usual registry does not do: a stiffness that has lost its "per degree", or 3.2 Hz taken
for 3.2 rad/s, is then an error and not a factor of 57 or of 6. Text is read without pint, whose import takes longer
than many an analysis.

Single quantities come first, then lists and ranges of a quantity, then airspeeds, which every analysis takes as a
number in m/s, a quantity or text such as ``"50:400:5ktas"``. Numbers, m/s and knots (kt, ktas) are true airspeeds; an
equivalent airspeed (keas) has a dimension of its own, since only the density of the air makes it a true one.
"""

from __future__ import annotations

import math
import re
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from proprotor.errors import InputError, unknown_name
from proprotor.needs import check_memory
from proprotor.typing import Array

if TYPE_CHECKING:
    import pint

KNOT = 1852 / 3600  # m/s
KTAS, KEAS = "KTAS", "KEAS"  # knots of true and of equivalent airspeed, as outputs name them
SEA_LEVEL_DENSITY = 1.225  # kg/m³, ISO 2533: an equivalent airspeed has the dynamic pressure of this air

_DEFINITIONS = """
kilo- = 1e3 = k-
centi- = 1e-2 = c-
milli- = 1e-3 = m-

radian = [angle] = rad
degree = 3.141592653589793 / 180 * radian = deg
turn = 2 * 3.141592653589793 * radian = _ = rev = revolution = cycle
percent = 0.01 = %

second = [time] = s
minute = 60 * second = min
hour = 3600 * second = h
hertz = turn / second = Hz
rpm = turn / minute

meter = [length] = m = metre
inch = 0.0254 * meter = in
foot = 0.3048 * meter = ft = feet
yard = 3 * foot = yd
furlong = 220 * yard
mile = 5280 * foot = mi
nautical_mile = 1852 * meter = nmi
knot = nautical_mile / hour = kt = kts = ktas = KTAS
keas = [equivalent_airspeed] = _ = KEAS
mph = mile / hour

gram = [mass] = g
pound = 0.45359237 * kilogram = lb = lbm
newton = kilogram * meter / second ** 2 = N
pound_force = 9.80665 * pound * meter / second ** 2 = lbf
slug = pound_force * second ** 2 / foot
watt = newton * meter / second = W
horsepower = 550 * foot * pound_force / second = hp

# differences of temperature only: degrees of both kinds, and no zero
kelvin = [temperature] = K = degC
rankine = 5 / 9 * kelvin = degR = degF
"""

# What each SI unit measures, and how a user would write one; for messages.
_MEANINGS = {
    "": ("a plain number", '0.0065 or "1 %"'),
    "m": ("a length", '"12.5 ft"'),
    "s": ("a time", '"0.5 s"'),
    "m**2": ("an area", '"50 ft**2"'),
    "rad": ("an angle", '"2.5 deg"'),
    "1/rad": ("a slope per angle", '"5.7/rad"'),
    "rad/m": ("an angle per length", '"-0.09 rad/ft"'),
    "m/rad": ("a length per angle", '"4.3 ft/rad"'),
    "m/s": ("a speed", '"300 kt"'),
    "keas": ("an equivalent airspeed", '"250 keas"'),
    "1/s": ("a rate of growth", '"-0.4 1/s"'),
    "rad/s": ("a rotational speed or frequency", '"458 rpm", "60 rad/s" or "9.5 Hz"'),
    "kg": ("a mass", '"4.1 slug"'),
    "kg*m": ("a first moment of mass", '"14 slug*ft"'),
    "kg*m**2": ("a moment of inertia", '"105 slug*ft**2"'),
    "kg/m": ("a mass per length", '"0.2 slug/ft"'),
    "kg/m**3": ("a density", '"1.225 kg/m**3"'),
    "kg*m**2/m": ("a moment of inertia per length", '"2 lb*ft**2/ft"'),
    "N": ("a force", '"1.5e8 lbf"'),
    "W": ("a power", '"900 hp"'),
    "N*m**2": ("a bending or torsion stiffness", '"3.7e9 lbf*in**2"'),
    "N*m/rad": ("a moment per angle", '"2700 in*lbf/deg"'),
    "K": ("a difference of temperature", '"15 K" or "15 degC"'),
    "N*m*s/rad": ("a moment per rate of angle", '"12 N*m*s/rad"'),
}

_NUMBER = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_NUMBER_AND_UNIT = re.compile(rf"\s*({_NUMBER}|[+-]?(?:nan|inf)\b)\s*(.*?)\s*", re.IGNORECASE)
_RANGE_AND_UNIT = re.compile(rf"\s*({_NUMBER})(?:\s*:\s*({_NUMBER})\s*:\s*({_NUMBER}))?\s*(.*?)\s*")
_LONGEST = 80  # characters in a quantity
LARGEST = 1e30  # of any quantity in SI: the product of several quantities must be finite too
_MOST_VALUES = 100_000_000
_ANY_RANGE = re.compile(r"\s*([^:\s]+)\s*:\s*([^:\s]+)\s*:\s*([0-9.eE+-]*[0-9.])\s*(.*?)\s*")
_MOST_SPEEDS = 100_000
_EQUIVALENT = re.compile(r"(?<![A-Za-z])(keas|KEAS)\b")
_INDICATED = ("kcas", "kias")  # which a message must not take for a misspelt ktas
_KNOTS = ("kt", "kts", "knot", "knots", "ktas", KTAS)

# A unit is a product of names, each with at most a one-digit power: nothing else ever reaches a parser, so
# no text can become a costly power such as 10**10**10.
_UNIT_TOKEN = re.compile(
    r"[A-Za-z_][A-Za-z0-9_]*(?:\s*(?:\*\*|\^)\s*-?[0-9](?![0-9]))?|[%()/]|\*(?!\*)|1(?=\s*/)"
)


# A number or a name, with its power: a factor of a product, also in the definitions.
_FACTOR = re.compile(
    r"(?P<number>[0-9][0-9.e]*)|(?P<name>[A-Za-z_][A-Za-z0-9_]*|%)(?:\s*(?:\*\*|\^)\s*(?P<power>-?[0-9]))?"
)
# Units that people write without a sign between, such as Nm.
_RUN_TOGETHER = re.compile(r"(k?N|lbf?|kg|slug|ft|in)(m|cm|mm|ft|in|lbf?)")
# How tables of reports write powers and degrees.
_AS_WRITTEN = str.maketrans({"²": "**2", "³": "**3", "°": "deg"})
_Unit = tuple[float, dict[str, int]] | None  # so many times a product of other units; None for a base unit


@cache
def unit_registry() -> pint.UnitRegistry[Any]:
    """Return the registry of the units that a deck may use, a `pint.UnitRegistry` made on first use."""
    import pint  # here, because it is slow to import

    registry: pint.UnitRegistry[Any] = pint.UnitRegistry(None)
    registry.load_definitions(_DEFINITIONS.strip().splitlines())
    return registry


def to_si(text: str | float, unit: str) -> float:
    """Return the SI value of a quantity written as text.

    Parameters
    ----------
    text : str or float
        ``"12.5 ft"``, ``"2700 in*lbf/deg"``; a number, or a text without unit, is dimensionless.
    unit : str
        SI unit of the result, such as ``"m"`` or ``"N*m/rad"``; ``""`` for a plain number.

    Raises
    ------
    InputError
        With an empty field name, when the text is no quantity, not finite or of another dimension.
    """
    number, written_unit = _split(text)
    if not math.isfinite(number):
        raise InputError("", text, "must be finite")
    return _finite(text, number * factor_to_si(text, written_unit, unit))


def factor_to_si(text: object, written_unit: str, unit: str) -> float:
    """Return how many SI units one `written_unit` is; `text` is what the user wrote, for the message.

    Raises
    ------
    InputError
        With an empty field name, when the unit is unknown or of another dimension.
    """
    powers = _parse_unit(text, written_unit)
    for name, power in _parse_unit(unit, unit).items():
        powers[name] = powers.get(name, 0) - power
    factor, dimension = _in_base_units(powers)
    if any(dimension.values()):
        raise InputError("", text, _dimension_rule(written_unit, unit))
    return factor


def has_own_unit(value: Any) -> bool:
    """Return whether a value names its unit.

    Such a value is text, a quantity, a data array with an attribute ``units``, or a list of these.
    """
    if isinstance(value, list | tuple):
        return any(map(has_own_unit, value))
    return isinstance(value, str) or hasattr(value, "to") or "units" in getattr(value, "attrs", {})


def as_si(
    value: ArrayLike | str | pint.Quantity[Any], unit: str, field: str = "value"
) -> NDArray[np.float64]:
    """Return an argument in SI: numbers and arrays are SI already; text, quantities and labelled arrays are converted.

    Parameters
    ----------
    value : array_like, str, pint.Quantity or xarray.DataArray
        A quantity may come from any pint registry. An attribute ``units`` of a data array is its unit.
    unit : str
        SI unit of the result.
    field : str
        Name of the argument, for the message.

    Raises
    ------
    InputError
        When the value has another dimension or is not numeric.
    """
    written = str(getattr(value, "attrs", {}).get("units") or "")
    try:
        if isinstance(value, str):
            return np.asarray(to_si(value, unit))
        if written:  # "1" stands for no unit
            factor = factor_to_si(written, "" if written == "1" else written, unit)
            return np.asarray(value, dtype=float) * factor
    except InputError as error:
        raise error.within(field) from None
    try:
        return np.asarray(value.to(unit).magnitude if hasattr(value, "to") else value, dtype=float)
    except (TypeError, ValueError):  # pint's DimensionalityError is a TypeError
        raise InputError(field, value, f"must be {meaning(unit)}") from None


def values_in_si(given: Any, unit: str, field: str = "value") -> NDArray[np.float64]:
    """Return values in SI from all that `as_si` takes, a list of such values, or a range such as ``"1:4:0.5 deg"``.

    Parameters
    ----------
    given : array_like, str, pint.Quantity, xarray.DataArray, or a list of them
        A range is start:stop:step, the stop included.
    unit : str
        SI unit of the result.
    field : str
        Name of the argument, for the message.

    Raises
    ------
    InputError
        When a value has another dimension or is not numeric, or a range does not rise.
    """
    if isinstance(given, str) and ":" in given:
        return _written_range(given, unit, field)
    if isinstance(given, list | tuple):
        return np.array([as_si(value, unit, field) for value in given], dtype=float)
    return as_si(given, unit, field)


def _written_range(text: str, unit: str, field: str) -> NDArray[np.float64]:
    """Return the values of a range in text, the stop included."""
    match = _ANY_RANGE.fullmatch(text)
    if match is None:
        raise InputError(field, text, 'must be a value such as "2 deg" or a range such as "1:4:0.5 deg"')
    numbers = [float(as_si(f"{match[place]} {match[4]}".strip(), unit, field)) for place in (1, 2, 3)]
    return _rising(text, numbers, _MOST_VALUES, "values", field)


def _rising(text: str, numbers: list[float], most: int, what: str, field: str = "") -> NDArray[np.float64]:
    """Return start, start + step, … up to the stop, which is included; refuse a range that does not rise."""
    start, stop, step = numbers
    if not step > 0 or stop < start:
        raise InputError(field, text, "must rise from start to stop, start:stop:step, by a positive step")
    steps = (stop - start) / step * (1 + 1e-12)  # slightly more, so that 0:1:0.1 includes the stop
    if not steps < most:
        raise InputError(field, text, f"must have at most {most} {what}")
    check_memory(field, text, 24 * steps, f"{steps:.4g} {what}", "take a larger step")
    return start + step * np.arange(int(steps) + 1, dtype=float)


# Airspeeds ----------------------------------------------------------------------------------------


def in_metres_per_second(airspeed: Any, density: ArrayLike | None = None) -> Array:
    """Return an airspeed as an array in m/s, true.

    Parameters
    ----------
    airspeed : float, array (...), text, pint quantity or xarray.DataArray
        A bare number is in m/s and may be complex, for derivatives by a complex step; text such as "250 ktas" (one
        speed) or "50:400:5ktas" (a list), quantities, lists of these, and data arrays with an attribute
        ``units`` are converted. The unit keas is an equivalent airspeed; every other unit of speed is a true airspeed.
    density : float or array (...), optional
        Density of the air, kg/m³, for equivalent airspeeds; an array broadcasts with the airspeeds.

    Returns
    -------
    array (...)
        m/s; without axes for a single speed in air of one density.

    Raises
    ------
    InputError
        When the value is not a speed, or an equivalent airspeed where the density is not known or zero.
    """
    if isinstance(airspeed, float | int):
        return np.asarray(airspeed, dtype=float)
    if is_equivalent(airspeed):
        equivalent = _metres_per_second(airspeed, "keas")
        return np.asarray(equivalent * speed_factor(KEAS, density, airspeed))
    return _metres_per_second(airspeed, "m/s")


def is_equivalent(airspeed: Any) -> bool:
    """Return whether an airspeed is given in keas.

    Raises
    ------
    InputError
        For a list of which some airspeeds are equivalent and others true.
    """
    if isinstance(airspeed, list | tuple):
        found = set(map(is_equivalent, airspeed))
        if len(found) > 1:
            raise InputError("airspeed", airspeed, "must be true airspeeds, or all of them keas")
        return found == {True}
    unit = getattr(airspeed, "attrs", {}).get("units") or getattr(airspeed, "units", "")
    written = airspeed if isinstance(airspeed, str) else str(unit)
    return bool(_EQUIVALENT.search(written))


def speeds(text: str, field: str = "airspeed", density: ArrayLike | None = None) -> NDArray[np.float64]:
    """Return true speeds in m/s from ``"300 ktas"`` or a range ``"50:400:5ktas"``, start:stop:step, the stop included.

    Parameters
    ----------
    text : str
        With the unit kt or ktas, keas, or any other unit of speed, which then is a true airspeed.
    field : str
        Name of the argument, for the message.
    density : float, optional
        Density of the air, kg/m³, for keas.

    Returns
    -------
    numpy.ndarray
        One dimension, increasing, m/s.

    Raises
    ------
    InputError
        When the text is no speed or range of speeds, with the reason.
    """
    if not is_equivalent(text):
        return _written_speeds(text, field, "m/s")
    found: NDArray[np.float64] = _written_speeds(text, field, "keas") * speed_factor(
        KEAS, density, text, field
    )
    return found


def speed_factor(
    unit: str, density: ArrayLike | None = None, given: object = None, field: str = "airspeed"
) -> Any:
    """Return how many m/s of true airspeed a unit of airspeed is.

    Parameters
    ----------
    unit : str
        "kt", "ktas", "keas", "m/s", "mph", …
    density : float or array (...), optional
        Density of the air, kg/m³, for keas: V = EAS √(ρ0/ρ) with ρ0 = 1.225 kg/m³.
    given, field : object, str
        What the user wrote and where, for the message; by default the unit.

    Returns
    -------
    float or array (...)
        As the density.

    Raises
    ------
    InputError
        For another dimension than speed, and for keas where the density is not known or zero.
    """
    given = unit if given is None else given
    if not is_equivalent(unit):
        return factor_to_si(given, unit, "m/s")
    if density is None or np.any(np.equal(density, 0)):
        why = "has no meaning in a vacuum" if density is not None else "needs air of one density"
        raise InputError(field, given, f'is an equivalent airspeed, which {why}: give a true one, "250 ktas"')
    return KNOT * np.sqrt(SEA_LEVEL_DENSITY / np.asarray(density))[()]


def airspeed_unit(unit: str) -> str:
    """Return a unit of airspeed as outputs name it: KTAS or KEAS for knots, other units as they are."""
    return KEAS if is_equivalent(unit) else KTAS if unit in _KNOTS else unit


def _metres_per_second(airspeed: Any, unit: str) -> Array:
    """Return an airspeed as an array in m/s or keas."""
    if isinstance(airspeed, str):
        found = _written_speeds(airspeed, "airspeed", unit)
        return found if ":" in airspeed else found.reshape(())
    if has_own_unit(airspeed):
        return values_in_si(airspeed, unit, "airspeed")
    try:
        return np.asarray(airspeed, dtype=complex if np.iscomplexobj(airspeed) else float)
    except (TypeError, ValueError):
        raise InputError("airspeed", airspeed, 'must be in m/s, or text such as "300 ktas"') from None


def _written_speeds(text: str, field: str, unit: str) -> NDArray[np.float64]:
    """Return the speeds of a text in m/s or keas."""
    match = _RANGE_AND_UNIT.fullmatch(text) if len(text) <= _LONGEST else None
    if match is None or ":" in match[4]:
        raise InputError(field, text, 'must be a speed such as "300 kt" or a range such as "50:400:5kt"')
    try:
        factor = factor_to_si(text, match[4], unit)
        numbers = [_finite(text, float(number)) for number in match.group(1, 2, 3) if number]
        if numbers[0] < 0:
            raise InputError("", text, "must not be negative")
        written = _rising(text, numbers, _MOST_SPEEDS, "speeds") if len(numbers) > 1 else np.array(numbers)
    except InputError as error:
        raise error.within(field) from None
    return written * factor


# Reading ------------------------------------------------------------------------------------------


def _split(text: str | float) -> tuple[float, str]:
    """Return the number and the unit of a quantity written as text."""
    if isinstance(text, str):
        match = _NUMBER_AND_UNIT.fullmatch(text) if len(text) <= _LONGEST else None
        if match is None:
            raise InputError("", text, 'must be a number and a unit, such as "12.5 ft"')
        return float(match[1]), match[2]
    try:
        return float(text), ""
    except OverflowError:  # an integer beyond the floating-point range
        return math.inf, ""


def _parse_unit(text: object, unit: str) -> dict[str, int]:
    """Return the power of each name in a unit, or refuse a unit that is unknown or no product of names."""
    product = f"1{unit}" if unit.startswith("/") else unit  # "5.7/rad"
    product = product.translate(_AS_WRITTEN)
    product = re.sub(r"(?<=[A-Za-z0-9])[-·](?=[A-Za-z])", "*", product)  # in-lbf, as reports write it
    if len(unit) > _LONGEST or _UNIT_TOKEN.sub("", product).strip() or not _is_product(product):
        raise InputError("", text, 'has a unit that cannot be read; write it as in "2700 in*lbf/deg"')
    powers: dict[str, int] = {}
    for written, power in _read_product(product)[1].items():
        name = _known_unit(written)
        if name is None:
            raise InputError("", text, _unknown_unit(written))
        powers[name] = powers.get(name, 0) + power
    return powers


def _unknown_unit(name: str) -> str:
    """Return the rule that an unknown unit breaks."""
    if name.lower() in _INDICATED:
        return f"must be ktas or keas; {name} is none of the units here"
    if together := _RUN_TOGETHER.fullmatch(name):
        return f"has an unknown unit {name!r}; did you mean {together[1]}*{together[2]}?"
    return f"has an {unknown_name(name, _unit_names(), 'unit')}"


def _is_product(text: str) -> bool:
    """Return whether a text is empty or a product of names, each sign between two factors, parentheses in pairs."""
    shape = re.sub(r"\s", "", _FACTOR.sub("x", text))
    while shape != (shape := re.sub(r"\(x(?:[*/]?x)*\)", "x", shape)):
        pass
    return re.fullmatch(r"(?:x(?:[*/]?x)*)?", shape) is not None


def _read_product(text: str) -> tuple[float, dict[str, int]]:
    """Return the product of the numbers in a product, and the power of each name."""
    scale, powers = 1.0, dict[str, int]()
    outside, sign = [1], 1  # +1 to multiply by and -1 to divide by: a parenthesis, the next factor
    for match in re.finditer(rf"{_FACTOR.pattern}|[*/()]", text):
        if match[0] in ("*", "/"):
            sign = 1 if match[0] == "*" else -1
            continue
        if match[0] == "(":
            outside.append(outside[-1] * sign)
        elif match[0] == ")":
            outside.pop()
        elif match["name"]:
            power = outside[-1] * sign * int(match["power"] or 1)
            powers[match["name"]] = powers.get(match["name"], 0) + power
        else:
            scale *= float(match["number"]) ** (outside[-1] * sign)
        sign = 1
    return scale, powers


@cache
def _definitions() -> tuple[dict[str, _Unit], dict[str, str], dict[str, float]]:
    """Return all units by name, the name of each alias, and the factor of each prefix."""
    units, names, prefixes = dict[str, _Unit](), dict[str, str](), dict[str, float]()
    for line in filter(None, (line.partition("#")[0].strip() for line in _DEFINITIONS.splitlines())):
        name, meant, *aliases = line.split(" = ")
        if name.endswith("-"):
            prefixes |= {prefix.rstrip("-"): float(meant) for prefix in (name, *aliases)}
            continue
        units[name] = None if meant.startswith("[") else _read_product(meant)
        names |= dict.fromkeys((name, *aliases), name)
    del names["_"]
    return units, names, prefixes


def _known_unit(written: str) -> str | None:
    """Return the name of a unit, which may have a prefix and the s of a plural; None for an unknown unit."""
    units, names, prefixes = _definitions()
    if written in names:
        return names[written]
    for stem in dict.fromkeys((written, written.removesuffix("s"))):
        if len(stem) > 1 and stem in names:
            return names[stem]
        for prefix, scale in prefixes.items():
            rest = stem.removeprefix(prefix)
            if rest != stem and rest in names and (stem == written or len(rest) > 1):
                name = f"{prefix}{names[rest]}"
                units[name] = scale, {names[rest]: 1}
                return name
    return None


def _in_base_units(powers: dict[str, int]) -> tuple[float, dict[str, int]]:
    """Return the factor of a product of units in base units, and the power of each base unit."""
    scales: dict[float, int] = {}
    base: dict[str, int] = {}
    _collect(powers, 1, scales, base)
    # Equal scales cancel, and what remains is multiplied before it is divided: 1 m is exactly 1 m.
    ordered = sorted(scales.items(), key=lambda one: one[1] < 0)
    return math.prod((scale**power for scale, power in ordered), start=1.0), base


def _collect(powers: dict[str, int], times: int, scales: dict[float, int], base: dict[str, int]) -> None:
    """Add a product of units, to some power, to the powers of factors and of base units."""
    units, _, _ = _definitions()
    for name, power in powers.items():
        unit = units[_known_unit(name) or name]
        if unit is None:
            base[name] = base.get(name, 0) + power * times
        else:
            scales[unit[0]] = scales.get(unit[0], 0) + power * times
            _collect(unit[1], power * times, scales, base)


def _unit_names() -> list[str]:
    """Return the names of all units and their aliases, for messages."""
    lines = [line.split(" = ") for line in _DEFINITIONS.splitlines() if " = " in line and "- = " not in line]
    return [name for first, _, *aliases in lines for name in (first, *aliases) if name != "_"]


def _dimension_rule(written_unit: str, unit: str) -> str:
    """Return the rule that a quantity of another dimension breaks."""
    if not written_unit:
        return f"needs a unit; it is {meaning(unit)}"
    if is_equivalent(written_unit) and unit == "m/s":
        return 'is an equivalent airspeed; here must stand a true speed, such as "250 ktas"'
    # the most frequent mistake in US units
    hint = " (lb is a mass, lbf a force)" if "N" in unit and re.search(r"\blb\b", written_unit) else ""
    return f"must be {meaning(unit)}{hint}"


def meaning(unit: str) -> str:
    """Return what an SI unit measures, with an example, as the end of a sentence."""
    name, example = _MEANINGS[unit]
    return f"{name}, such as {example}"


def _finite(text: object, number: float) -> float:
    """Return the number, or refuse a number that is not finite or too large for SI products."""
    if not math.isfinite(number):
        raise InputError("", text, "must be finite")
    if abs(number) > LARGEST:
        raise InputError("", text, f"must not be beyond {LARGEST:g} in SI units")
    return number
