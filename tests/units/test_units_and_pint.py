"""Units in text mean what pint makes of them, over all names, prefixes, powers and products, and pint is not loaded."""

import random
import re
import subprocess
import sys

import pint
import pytest

from proprotor.errors import InputError
from proprotor.units import factor_to_si, unit_registry

REGISTRY = unit_registry()
NAMES = sorted({name for name in dir(REGISTRY) if not name.startswith("_")} & set(REGISTRY._units))
SI = (
    "",
    "m",
    "rad",
    "m/s",
    "rad/s",
    "1/s",
    "kg",
    "kg*m**2",
    "kg/m**3",
    "N",
    "N*m**2",
    "N*m/rad",
    "K",
    "keas",
)
# Other units of the same dimension for each name in a unit of SI.
ALSO = {
    "m": ("m", "ft", "in", "yd", "mi", "nmi", "cm", "mm", "km", "metres"),
    "rad": ("rad", "deg", "rev", "degrees"),
    "s": ("s", "min", "h", "ms"),
    "kg": ("kg", "slug", "lb", "g", "lbm"),
    "N": ("N", "lbf", "kN", "kilonewton"),
    "K": ("K", "degC", "degF", "degR"),
    "keas": ("keas", "KEAS"),
}


def by_pint(written, unit):
    try:
        return REGISTRY.Quantity(1.0, REGISTRY.parse_units(written)).to(unit).magnitude
    except pint.DimensionalityError:
        return None


def by_proprotor(written, unit):
    try:
        return factor_to_si(written, written, unit)
    except InputError:
        return None


def agree(written, unit):
    expected, found = by_pint(written, unit), by_proprotor(written, unit)
    assert found == (expected if expected is None else pytest.approx(expected, rel=1e-15)), (written, unit)
    return found is not None


def test_names_with_prefixes_and_plurals():
    assert len(NAMES) > 50
    readable = 0
    for prefix in ("", "kilo", "k", "centi", "c", "milli", "m"):
        for name in NAMES:
            for plural in ("", "s"):
                written = f"{prefix}{name}{plural}"
                if written in REGISTRY:
                    readable += any([agree(written, unit) for unit in SI])
                else:
                    with pytest.raises(InputError, match="unknown unit"):
                        factor_to_si(written, written, "")
    assert readable > 500


def test_products_powers_and_ratios():
    rng = random.Random(17)
    same = 0
    for _ in range(3000):
        unit, other = rng.choice(SI), rng.choice(SI)
        written = re.sub(r"[A-Za-z]+", lambda name: rng.choice(ALSO[name[0]]), unit)
        if rng.random() < 0.3:
            written = written.replace("*", " ").replace("  ", "^")
        if rng.random() < 0.3 and written:
            written = f"h/(min/({written}))/h min"
        same += agree(written, unit)
        agree(written, other)
    assert same > 1000


@pytest.mark.parametrize(
    "written", ["m*/s", "m//s", "((m)", "m)", ")m(", "()", "m()", "*m", "m*", "1/", "m**2**2", "2*m"]
)
def test_what_is_no_product_is_refused(written):
    with pytest.raises(InputError, match="cannot be read"):
        factor_to_si(written, written, "m")


@pytest.mark.parametrize(
    ("written", "plain"),
    [
        ("N m²", "N*m**2"),
        ("lbf·in²", "lbf*in**2"),
        ("kg/m³", "kg/m**3"),
        ("in·lbf/°", "in*lbf/deg"),
        ("°", "deg"),
    ],
)
def test_powers_and_degrees_as_reports_write_them(written, plain):
    for unit in SI:
        assert by_proprotor(written, unit) == by_proprotor(plain, unit)
    assert any(by_proprotor(written, unit) for unit in SI)


@pytest.mark.parametrize("written", ["²", "m²²", "m²3", "2²", "²m", "m**²"])
def test_a_power_of_nothing_is_refused(written):
    with pytest.raises(InputError, match="cannot be read"):
        factor_to_si(written, written, "m")


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("Nm", "N*m"),
        ("kNm²", "kN*m"),
        ("Nm^2", "N*m"),
        ("inlbf/deg", "in*lbf"),
        ("ftlb", "ft*lb"),
        ("kgm", "kg*m"),
    ],
)
def test_units_without_a_sign_between_are_told_with_it(written, meant):
    with pytest.raises(InputError, match=rf"unknown unit '\w+'; did you mean {re.escape(meant)}\?$"):
        factor_to_si(written, written, "m")


def test_text_is_read_without_pint():
    code = (
        "import sys; from proprotor.units import to_si; to_si('12.5 ft', 'm'); print('pint' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout.strip() == "False", done.stderr
