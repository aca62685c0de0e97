"""Docstrings and signatures of all that is public: parameters, results, errors, units, types.

They are read with numpydoc, the standard of the ecosystem. What is public: the names of the package, the functions and
classes of the modules listed below, and of all those classes the public methods and properties.
"""

import asyncio
import dataclasses
import inspect
import re
import sys
import typing
from collections import ChainMap
from collections.abc import Callable, Iterator
from types import ModuleType
from typing import Any

import numpy as np
import proprotor_equations
import pytest
from numpydoc.docscrape import NumpyDocString

import proprotor as pp
from proprotor import plots, sampling
from proprotor.deck.vary import vary
from proprotor.exchange import matlab as matlab_file
from proprotor.exchange import netcdf as results_file
from proprotor.exchange import openmdao
from proprotor.model import state_space
from proprotor.plots import animation, mode_motion
from proprotor.plots.accessor import Results
from proprotor.rotor.options import Options
from proprotor.rotor.trim import Trim
from proprotor.stability import flutter
from proprotor.stability.attribution import attribution
from proprotor.stability.boundaries import boundaries
from proprotor.stability.boundary import Boundary, Crossings, Failed
from proprotor.stability.boundary_lines import boundary_lines
from proprotor.stability.frequency_response import frequency_response
from proprotor.stability.map import stability_map
from proprotor.stability.modes import modes
from proprotor.stability.sensitivity import sensitivity
from proprotor.stability.sweep import sweep_case
from proprotor.study import mode_damping
from tests.measured_point import measured_point

# All functions and classes of these are public, and of others those that are named.
MODULES: tuple[ModuleType, ...] = (
    animation,
    sys.modules[boundaries.__module__],
    sys.modules[boundary_lines.__module__],
    flutter,
    sys.modules[frequency_response.__module__],
    matlab_file,
    mode_motion,
    openmdao,
    results_file,
    sampling,
    state_space,
)
OTHERS = (attribution, vary, mode_damping, modes, Options, sensitivity, stability_map, sweep_case, Trim)
OTHERS += (Boundary, Crossings, Failed, Results)
OTHERS += tuple(entry for entry in map(vars(sampling).get, sampling.__all__) if inspect.isclass(entry))
# What says that a number has no dimension, or which it has.
DIMENSION = re.compile(
    r"(?i:\bdimensionless\b)|\bratio|\bfraction|\bshare\b|\bfactor|per revolution|\bSI\b|\bunit|\bcoefficient"
    r"|\bC_[TP]\b|in chords|"
    r"(?<![A-Za-z])(kg|rad|deg|dpi|m|s|N|Pa|K|Hz|kt|rpm|inches|percent|per cent|%|slug|ft)"
    r"([ /·²³*)\],.;:]|$)|1/(s|rad|m)|seconds"
)
NO_NUMBERS = re.compile(r"array of (int or bool|bool|str|int)")
NUMBER = re.compile(r"\b(float|array|complex|ndarray|array_like)\b")


def public_objects() -> dict[str, Any]:
    """Functions and classes by name, each once."""
    named = {name: getattr(pp, name) for name in pp.__all__ if not inspect.ismodule(getattr(pp, name))}
    shown = {name: entry for name, entry in vars(plots).items() if name in plots.__all__}
    named |= {name: entry for name, entry in shown.items() if not inspect.ismodule(entry)}
    found = [(module, entry) for module in MODULES for entry in vars(module).values()]
    own = [entry for module, entry in found if getattr(entry, "__module__", "") == module.__name__]
    for entry in (*own, *OTHERS):
        known = any(entry is other for other in named.values())
        if (inspect.isfunction(entry) or inspect.isclass(entry)) and not known and entry.__name__[0] != "_":
            named[f"{entry.__module__.rpartition('.')[2]}.{entry.__name__}"] = entry
    return named


def own_bases(cls: type) -> list[type]:
    """A class and those of its bases that are the package's own."""
    return [base for base in cls.__mro__ if base.__module__.partition(".")[0] == "proprotor"]


def members(cls: type) -> Iterator[tuple[str, Any]]:
    """Public methods and properties that a class or a base of the package defines."""
    for name, entry in ChainMap(*(vars(base) for base in own_bases(cls))).items():
        if name.startswith("_"):
            continue
        inner = entry.__func__ if isinstance(entry, classmethod | staticmethod) else entry
        if inspect.isfunction(inner) or isinstance(inner, property) or hasattr(inner, "func"):
            yield name, inner


PUBLIC = public_objects()
CLASSES = {name: entry for name, entry in PUBLIC.items() if inspect.isclass(entry)}
FUNCTIONS: dict[str, Callable[..., Any]] = {
    name: entry for name, entry in PUBLIC.items() if inspect.isfunction(entry)
} | {
    f"{name}.{member}": entry
    for name, cls in CLASSES.items()
    for member, entry in members(cls)
    if inspect.isfunction(entry)
}
PROPERTIES = {
    f"{name}.{member}": entry
    for name, cls in CLASSES.items()
    for member, entry in members(cls)
    if not inspect.isfunction(entry)
}


def docstring(entry: Any) -> NumpyDocString:
    return NumpyDocString(inspect.getdoc(entry) or "")


def documented(parts: list[Any]) -> dict[str, tuple[str, str]]:
    """Type and text of each name of a section; names that share a line share both."""
    return {name.strip(): (part.type, " ".join(part.desc)) for part in parts for name in part.name.split(",")}


def parameters(entry: Callable[..., Any]) -> dict[str, inspect.Parameter]:
    marks = {inspect.Parameter.VAR_KEYWORD: "**", inspect.Parameter.VAR_POSITIONAL: "*"}
    return {
        f"{marks.get(p.kind, '')}{name}": p
        for name, p in inspect.signature(entry).parameters.items()
        if name not in ("self", "cls")
    }


def own_parameters(cls: type) -> set[str]:
    """What a class is made from: fields of a record or tuple, or arguments of its own constructor."""
    if dataclasses.is_dataclass(cls):
        return {entry.name for entry in dataclasses.fields(cls) if entry.init}
    if hasattr(cls, "_fields"):
        return set(cls._fields)
    return set(parameters(cls)) if "__init__" in vars(cls) else set()


def says_its_dimension(kind: str, text: str) -> bool:
    kind = NO_NUMBERS.sub("", kind)
    return not NUMBER.search(kind) or bool(DIMENSION.search(f"{kind}; {text}"))


def raises_input_error(entry: Callable[..., Any]) -> bool:
    return "raise InputError" in inspect.getsource(entry)


def test_there_is_something_to_check():
    assert len(FUNCTIONS) > 80 and len(CLASSES) > 20 and len(PROPERTIES) > 8


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_says_what_it_takes_gives_and_raises(name):
    entry = FUNCTIONS[name]
    told, signature = docstring(entry), inspect.signature(entry)
    assert told["Summary"], "no summary"
    given = documented([*told["Parameters"], *told["Other Parameters"]])
    assert set(given) == set(parameters(entry))
    for parameter, (kind, text) in given.items():
        if not parameter.startswith("**"):
            assert kind and says_its_dimension(kind, text), (parameter, kind, text)
    if signature.return_annotation not in (None, "None"):
        results = told["Returns"] or told["Yields"]
        assert results, f"gives {signature.return_annotation}"
        for result in results:
            assert says_its_dimension(result.type or result.name, " ".join(result.desc)), result
    if raises_input_error(entry):
        assert any("InputError" in f"{part.name}{part.type}" for part in told["Raises"]), "raises InputError"


@pytest.mark.parametrize("name", CLASSES)
def test_a_class_says_what_it_is_made_of(name):
    cls = CLASSES[name]
    told, every = docstring(cls), [docstring(base) for base in own_bases(cls)]
    assert told["Summary"]
    own = own_parameters(cls)
    given = documented([part for one in every for part in (*one["Parameters"], *one["Attributes"])])
    if own and not getattr(cls, "_is_protocol", False):
        assert {entry for entry in given if entry in own or not hasattr(cls, entry)} == own
    for entry, (kind, text) in given.items():
        assert kind and says_its_dimension(kind, text), (entry, kind, text)
    maker = "__post_init__" if dataclasses.is_dataclass(cls) else "__init__"
    if inspect.isfunction(vars(cls).get(maker)) and raises_input_error(vars(cls)[maker]):
        assert any("InputError" in f"{part.name}{part.type}" for part in told["Raises"])


@pytest.mark.parametrize("name", PROPERTIES)
def test_a_property_says_what_it_is(name):
    entry = PROPERTIES[name]
    function = getattr(entry, "fget", None) or entry.func
    text = inspect.getdoc(function) or ""
    assert text.partition("\n")[0].endswith((".", ":"))
    gives = str(typing.get_type_hints(function, vars(typing) | vars(pp) | _names(function)).get("return"))
    assert gives != "None"
    if re.search(r"ndarray|float|complex", gives):
        assert DIMENSION.search(text), text


def _names(function: Callable[..., Any]) -> dict[str, Any]:
    """What annotations may name, that is imported for the type checker alone."""
    import xarray

    from proprotor.case import Case

    return {"xarray": xarray, "Case": Case, **function.__globals__}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_parameter_and_result_has_a_type(name):
    entry = FUNCTIONS[name]
    signature = inspect.signature(entry)
    untyped = [n for n, p in parameters(entry).items() if p.annotation is inspect.Parameter.empty]
    assert untyped == []
    assert signature.return_annotation is not inspect.Signature.empty


# Generated functions ------------------------------------------------------------------------------


def generated_functions() -> dict[str, Callable[..., Any]]:
    import importlib
    import pkgutil

    found = {}
    prefix = f"{proprotor_equations.__name__}."
    for module in pkgutil.walk_packages(proprotor_equations.__path__, prefix):
        names = vars(importlib.import_module(module.name))
        found |= {
            f"{module.name.removeprefix(prefix)}.{name}": entry
            for name, entry in names.items()
            if inspect.isfunction(entry) and not name.startswith("_") and entry.__module__ == module.name
        }
    return found


GENERATED = generated_functions()


UNIT_OR_SHAPE = re.compile(r"^\[[^\]]+\] |\(\.\.\., [\w, ]+\)")
SOURCE = re.compile(
    r"Source: .*(Eqs?\. \d|nomenclature|strip theory|Prandtl-Glauert|Euler-Bernoulli|NASA|steady loads"
    r"|momentum theory)",
    re.DOTALL,
)


@pytest.mark.parametrize("name", GENERATED)
def test_a_generated_function_says_shapes_units_and_equations(name):
    """Numbers by unit, matrices by shape, results by shape or as records whose fields have units; and the source."""
    entry = GENERATED[name]
    told = docstring(entry)
    given = documented(told["Parameters"])
    assert set(given) == set(parameters(entry))
    for parameter, (kind, text) in given.items():
        assert UNIT_OR_SHAPE.search(f"{kind} {text}"), (parameter, kind, text)
    assert SOURCE.search(inspect.getdoc(entry))
    result = told["Returns"][0]  # rows and columns follow
    record = vars(inspect.getmodule(entry)).get(result.type)
    if record is None:
        assert re.match(
            r"Array \(\.\.\., \d+, \d+\)|Array \(\d+, \.\.\.\)|tuple of \d+ numbers", result.type
        ), result
    for field in getattr(record, "_fields", ()):
        assert re.search(rf"{field}: np.ndarray\n    \"\"\"\[", inspect.getsource(record)), field


# Unknown keywords ---------------------------------------------------------------------------------

SPEEDS = [100.0, 150.0, 200.0]
AXES = {"airspeed": SPEEDS, "rotor.precone": [0.01, 0.04]}


@pytest.fixture(scope="module")
def case() -> pp.Case:
    return pp.load_case("xv15-uncoupled")


def with_envelope(case: pp.Case) -> pp.Case:
    """The deck of a case with an envelope."""
    altitudes = '{ value = [0, 1], unit = "km" }'
    return pp.load_case(case.name, {"envelope.dive_speed": "200 keas", "envelope.altitudes": altitudes})


def explored(case: pp.Case, **more: Any) -> None:
    """The page of a case, in an event loop as a notebook has one."""

    async def cell() -> None:
        pp.explore(case, SPEEDS, **more).stop()

    asyncio.run(cell())


# How each function with options of the model is called.
LOOP = pp.ControlLoop(name="hold", sensors="x rate", inputs="cyclic_1c", gain=-1e-3)
WITH_OPTIONS: dict[str, Callable[..., Any]] = {
    "Case.linearize": lambda case, **more: case.linearize(150.0, **more),
    "Case.open_loop": lambda case, **more: case.open_loop(150.0, **more),
    "Case.margins": lambda case, **more: case.with_control(LOOP).margins([150.0], **more),
    "Case.sweep": lambda case, **more: case.sweep(SPEEDS, **more),
    "Case.boundaries": lambda case, **more: case.boundaries(SPEEDS, **more),
    "Case.flutter_point": lambda case, **more: case.flutter_point(SPEEDS, **more),
    "Case.sensitivity": lambda case, **more: case.sensitivity(airspeed=SPEEDS, **more),
    "Case.envelope": lambda case, **more: with_envelope(case).envelope(SPEEDS, **more),
    "envelope": lambda case, **more: pp.envelope(with_envelope(case), SPEEDS, **more),
    "explore": explored,
    "Case.growth_constraint": lambda case, **more: case.growth_constraint(SPEEDS, (), **more),
    "growth_constraint": lambda case, **more: pp.growth_constraint(case, SPEEDS, (), **more),
    "Case.attribution": lambda case, **more: case.attribution(150.0, **more),
    "Case.stability_map": lambda case, **more: case.stability_map(AXES, **more),
    "Case.around": lambda case, **more: case.around(150.0, shaft_angle=0.05, **more),
    "Case.floquet": lambda case, **more: case.floquet(150.0, shaft_angle=0.05, **more),
    "Case.boundary_against": lambda case, **more: case.boundary_against(
        {"rotor.precone": [0.01, 0.04]}, SPEEDS, **more
    ),
    "rotor_model": lambda case, **more: pp.rotor_model(case.rotor, case.operation, 150.0, **more),
    "study": lambda case, **more: pp.study(case, {"rotor.precone": [0.01]}, 150.0, **more),
    "calibrate": lambda case, **more: pp.calibrate(case, measured_point(), ["rotor.precone"], **more),
    "attribution.attribution": lambda case, **more: attribution(case, 150.0, **more),
    "boundary_lines.boundary_lines": lambda case, **more: boundary_lines(
        case, case.stability_map(AXES, airloads="none"), **more
    ),
    "boundaries.boundaries": lambda case, **more: boundaries(case, SPEEDS, **more),
    "flutter.flutter_point": lambda case, **more: flutter.flutter_point(case, SPEEDS, **more),
    "mode_motion.mode_motion": lambda case, **more: mode_motion.mode_motion(case, 150.0, "beam", **more),
    "sensitivity.sensitivity": lambda case, **more: sensitivity(case, airspeed=SPEEDS, **more),
    "map.stability_map": lambda case, **more: stability_map(case, AXES, **more),
    "sweep.sweep_case": lambda case, **more: sweep_case(case, SPEEDS, **more),
    "robust_boundary": lambda case, **more: pp.robust_boundary(
        case, {"rotor.precone": ("1 deg", "2 deg")}, SPEEDS, **more
    ),
}
STATIONS = pp.BladeStations(
    radius=np.array([0.0, 0.5, 1.0]),
    **dict.fromkeys(
        ("mass_per_length", "flatwise_stiffness", "edgewise_stiffness", "torsion_stiffness", "chord"),
        np.ones(3),
    ),
    twist=np.zeros(3),
    control_stiffness=1.0,
)
# Those of Rotor.
OTHER_KEYWORDS: dict[str, Callable[..., Any]] = {
    "Rotor.from_mass_distribution": lambda **more: pp.Rotor.from_mass_distribution(
        [0, 1], [1.0, 1.0], **more
    ),
    "Rotor.from_stations": lambda **more: pp.Rotor.from_stations(
        STATIONS, rotor_speed=1.0, pitch=[0.1, 0.2, 0.3], **more
    ),
}


def takes_any_keyword(entry: Callable[..., Any]) -> bool:
    kinds = (p.kind for p in inspect.signature(entry).parameters.values())
    return inspect.Parameter.VAR_KEYWORD in kinds


def test_which_functions_take_options():
    assert {name for name, entry in FUNCTIONS.items() if takes_any_keyword(entry)} == {
        *WITH_OPTIONS,
        *OTHER_KEYWORDS,
    }


@pytest.mark.parametrize("name", WITH_OPTIONS)
def test_an_unknown_option_is_told_with_the_nearest(case, name):
    with pytest.raises(
        pp.InputError, match=r"^compresibility = false: unknown option .* mean compressibility"
    ):
        WITH_OPTIONS[name](case, compresibility=False)


@pytest.mark.parametrize("name", [name for name in (*FUNCTIONS, *CLASSES) if name not in WITH_OPTIONS])
def test_an_unknown_keyword_is_refused(name):
    """By Python itself, and by nothing that would swallow it."""
    entry = FUNCTIONS.get(name) or CLASSES[name]
    if name in OTHER_KEYWORDS:
        with pytest.raises(TypeError, match="precne"):
            OTHER_KEYWORDS[name](precne=0.1)
    elif name in ("openmdao.WhirlFlutter", "openmdao.GrowthConstraint"):
        with pytest.raises((KeyError, TypeError)):  # options that OpenMDAO keeps
            entry(no_such_keyword=1)
    else:
        with pytest.raises(TypeError):
            entry(no_such_keyword=1)
        assert not takes_any_keyword(entry)


@pytest.mark.parametrize("component", [openmdao.WhirlFlutter, openmdao.GrowthConstraint])
def test_the_options_of_a_component_are_those_it_documents(component):
    told = documented(docstring(component)["Parameters"])
    own = set(component().options._dict)
    assert set(told) <= own
    assert own - set(told) == {
        name for name in own if name in set(openmdao.om.ExplicitComponent().options._dict)
    }
