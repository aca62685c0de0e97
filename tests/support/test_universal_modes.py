"""Modes in universal files: written by pyuff or line by line as SDRC published them, read as the modes that they are.

Files of tests have translations of accelerometers alone; here these are those of a rigid nacelle around the hub.
"""

import codecs
import re

import numpy as np
import pytest
import pyuff

import proprotor as pp
from proprotor.errors import InputError
from proprotor.support.normal_modes import HUB_AXES, NormalModes
from proprotor.support.universal_file import universal_file
from proprotor.support.universal_modes import universal_modes
from tests.support.test_modal_files import FOOT, FREQUENCY, HUB, MASS, RATIO, SLUG

DIGITS = 2e-5  # of E13.5
NODE, HUB_AT = 101, np.array([3.0, 5.0, 1.0])  # axes X aft, Y to the right, Z up
AROUND = {11: [3.5, 5.2, 1.1], 12: [4.1, 4.8, 0.9], 13: [4.0, 5.1, 1.6], 14: [3.2, 4.9, 0.5]}
# X = -z, Y = y, Z = x and likewise about them.
SHAPES = np.array([-HUB[2], HUB[1], HUB[0], -HUB[5], HUB[4], HUB[3]])  # (6, modes)
EXPECTED = NormalModes.from_frequencies(("mode_1", "mode_2", "mode_3"), MASS, FREQUENCY, RATIO, HUB, False)
GIVEN = {"includes_rotor": False, "length_unit": 1.0, "mass_unit": 1.0}


def is_the_structure(found, expected=EXPECTED, rtol=DIGITS):
    assert found.names == expected.names
    for matrix in ("mass", "damping", "stiffness", "hub"):
        wanted = getattr(expected, matrix)
        np.testing.assert_allclose(
            getattr(found, matrix), wanted, rtol=3 * rtol, atol=rtol * np.abs(wanted).max(), err_msg=matrix
        )


def translations(place: int, length: float = 1.0) -> dict[int, np.ndarray]:
    """The translations of accelerometers on a rigid nacelle in one mode: u + θ × r."""
    motion = SHAPES[:, place]
    return {
        name: (motion[:3] + np.cross(motion[3:], np.array(at) - HUB_AT)) / length
        for name, at in AROUND.items()
    }


# As pyuff writes ----------------------------------------------------------------------------------


def of_pyuff(folder, sets):
    path = folder / "modes.unv"
    pyuff.UFF(str(path)).write_sets(sets, mode="overwrite")
    return path


def set_55(place: int, motions: dict, **changes) -> dict:
    values = np.array(list(motions.values()))
    columns = {f"r{k + 1}": values[:, k] for k in range(values.shape[1])}
    # Half of the damping is given as viscous and half as hysteretic, which counts twice its ratio.
    damping = {"modal_damp_vis": RATIO[place] / 2, "modal_damp_his": RATIO[place]}
    return {
        "type": 55, "id1": "a", "id2": "b", "id3": "c", "id4": "d", "id5": "e",
        "model_type": 1, "analysis_type": 2, "data_ch": 3 if values.shape[1] == 6 else 2, "spec_data_type": 8,
        "data_type": 2, "n_data_per_node": values.shape[1], "load_case": 1, "mode_n": place + 1,
        "freq": FREQUENCY[place] / (2 * np.pi), "modal_m": MASS[place], "node_nums": list(motions),
        **damping, **columns, **changes,
    }  # fmt: skip


def test_a_file_of_finite_elements_by_pyuff(tmp_path):
    other = np.ones(6)
    sets = [set_55(k, {7: other, NODE: SHAPES[:, k], 9: other}) for k in (2, 0, 1)]  # not in order
    is_the_structure(universal_modes(of_pyuff(tmp_path, sets), NODE, **GIVEN))


def test_a_ground_vibration_test_by_pyuff(tmp_path):
    """Accelerometers in inches, with the units of the file, nodes in dataset 2411 and in dataset 15."""
    inch, pound = 0.0254, 4.4482216152605
    units = {
        "type": 164, "units_code": 7, "units_description": "Inch (pound f)", "temp_mode": 1, "length": 1 / inch,
        "force": 1 / pound, "temp": 1.8, "temp_offset": 459.67,
    }  # fmt: skip
    at = np.array([HUB_AT, *AROUND.values()]) / inch
    names = [NODE, *AROUND]
    energy = pound * inch  # a modal mass is a mass times a length²: lbf s²/in in²
    modes = [set_55(k, translations(k, inch), modal_m=MASS[k] / energy) for k in range(3)]
    for kind in (15, 2411):
        code = [1] * len(names)
        nodes = {"type": kind, "node_nums": names, "def_cs": code, "disp_cs": code, "color": code}
        nodes |= dict(zip("xyz", at.T, strict=True))
        path = of_pyuff(tmp_path, [units, nodes, *modes])
        found = universal_modes(path, NODE, includes_rotor=False, rigid_nodes=list(AROUND))
        is_the_structure(found, rtol=20 * DIGITS)  # rotations follow from differences of rounded numbers


# Line by line -------------------------------------------------------------------------------------


def rows(numbers, cell="{:13.5E}") -> list[str]:
    return ["".join(cell.format(x) for x in numbers[k : k + 6]) for k in range(0, len(numbers), 6)]


def dataset(kind: str, *lines: str) -> list[str]:
    return ["    -1", f"{kind:>6}", *lines, "    -1"]


def integers(*numbers: int) -> str:
    return "".join(f"{number:10d}" for number in numbers)


TEXTS = ["NONE"] * 5


def mode_55(k, motions=None, data=2, quantity=8, analysis=2, mass=None, cell="{:13.5E}") -> list[str]:
    motions = {NODE: SHAPES[:, k]} if motions is None else motions
    count = len(next(iter(motions.values()))) // (2 if data == 5 else 1)
    numbers = [FREQUENCY[k] / (2 * np.pi), MASS[k] if mass is None else mass, RATIO[k], 0.0]
    body = [line for name, motion in motions.items() for line in (integers(name), *rows(motion, cell))]
    kinds = integers(1, analysis, 3, quantity, data, count)
    return dataset("55", *TEXTS, kinds, integers(2, 4, 1, k + 1), *rows(numbers, cell), *body)


def mode_2414(k, motions=None, data=4, location=1) -> list[str]:
    motions = {NODE: SHAPES[:, k]} if motions is None else motions
    body = [line for name, motion in motions.items() for line in (integers(name), *rows(motion))]
    numbers = [0.0, FREQUENCY[k] / (2 * np.pi), FREQUENCY[k] ** 2, MASS[k], RATIO[k], 0.0]
    head = [integers(k + 1), "MODE", integers(location), *TEXTS, integers(1, 2, 3, 8, data, 6)]
    return dataset(
        "2414",
        *head,
        integers(1, 0, 1, 0, 1, k + 1, 0, 0),
        integers(0, 0),
        *rows(numbers),
        *rows([0.0] * 6),
        *body,
    )


UNITS = dataset(
    "164", "         1SI: Meter (newton)         2", "  1.0D+00  1.0D+00  1.0D+00", "  2.7315D+02"
)
HEAD = dataset("151", "a model", "NONE", "a program", "01-JAN-20  10:00:00", "NONE")
IN_55 = [line for k in range(3) for line in mode_55(k)]
IN_2414 = [line for k in range(3) for line in mode_2414(k)]
BINARY = dataset(
    "58b     1     2          11        1024     0     0           0           0", "\x00\x1a-1\xff"
)
READ = {
    "55": IN_55,
    "2414": IN_2414,
    "units and other datasets first": [*HEAD, *UNITS, *dataset("2412", "         1  94"), *IN_55],
    "a binary dataset between": [*IN_55[: len(IN_55) // 3], *BINARY, *IN_55[len(IN_55) // 3 :]],
    "complex modes beside real ones": [*mode_55(0, {NODE: np.ones(12)}, data=5), *IN_55],
    "a static case beside modes": [*mode_55(0, analysis=1), *IN_55],
    "data on elements beside modes": [*mode_2414(0, location=2), *IN_2414],
    "D exponents": [re.sub(r"E([+-][0-9]{2})", r"D\1", line) for line in IN_55],
    "blanks up to column 80": [line.ljust(80) for line in IN_55],
    "no blanks at the ends of lines": [line.rstrip() for line in IN_55],
    "numbers of all digits": [line for k in range(3) for line in mode_55(k, cell="{:25.16E}")],
}


@pytest.mark.parametrize("kind", READ)
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_files_of_many_programs(tmp_path, kind, end):
    path = tmp_path / "modes.unv"
    path.write_bytes(end.join(READ[kind]).encode("latin-1"))
    is_the_structure(universal_modes(path, NODE, **GIVEN))


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_files_with_a_byte_order_mark(tmp_path, encoding):
    path = tmp_path / "modes.unv"
    path.write_bytes("\r\n".join(IN_55).encode(encoding))
    is_the_structure(universal_modes(path, NODE, **GIVEN))
    assert path.read_bytes()[:2] in (codecs.BOM_UTF8[:2], codecs.BOM_UTF16)


def test_fields_that_touch_are_parted_by_their_columns():
    lines = mode_55(0)
    at = lines.index(integers(1, 2, 3, 8, 2, 6))
    lines[at] = "         1         2         3         8         2         6"
    lines[at + 1] = integers(2, 4, 1234567890, 1)
    assert universal_file("\n".join(lines)).modes[0].number == 1


# Choices and refusals -----------------------------------------------------------------------------


def write(folder, lines):
    path = folder / "modes.unv"
    path.write_text("\n".join(lines), encoding="latin-1")
    return path


def test_damping_is_that_of_the_file_or_as_given(tmp_path):
    path = write(tmp_path, IN_55)
    given = universal_modes(path, NODE, **GIVEN, damping_ratio=[0.02, 0.03], modes=2)
    np.testing.assert_allclose(
        np.diag(given.damping),
        [2 * z * w * m for z, w, m in zip([0.02, 0.03], FREQUENCY[:2], MASS[:2], strict=True)],
        rtol=DIGITS,
    )


def test_units_of_the_file_give_way_to_those_that_are_given(tmp_path):
    path = write(tmp_path, [*UNITS, *IN_55])
    is_the_structure(universal_modes(path, NODE, includes_rotor=False))
    feet = universal_modes(path, NODE, includes_rotor=False, length_unit=FOOT, mass_unit=SLUG)
    np.testing.assert_allclose(feet.mass, EXPECTED.mass * SLUG * FOOT**2, rtol=DIGITS)
    np.testing.assert_allclose(feet.hub[:3], EXPECTED.hub[:3] * FOOT, rtol=DIGITS, atol=1e-6)


def without_positions(k):
    return mode_55(k, translations(k))


NODES = dataset(
    "2411",
    *(
        x
        for name, at in {NODE: HUB_AT, **AROUND}.items()
        for x in (integers(name, 1, 1, 11), "".join(f"{a:25.16E}" for a in at))
    ),
)
LINE = dataset(
    "2411", *(x for k in range(5) for x in (integers([NODE, *AROUND][k], 1, 1, 11), f" {k:d}.0 0.0 0.0"))
)
TESTED = [line for k in range(3) for line in without_positions(k)]
BENT = [
    line
    for k in range(3)
    for line in mode_55(k, {name: k * np.sin(name + np.arange(3.0)) + 1 for name in AROUND})
]
REFUSED = {
    "no universal file": (["hello"], {}, "file = .*: line 1: must be -1, as the first line of each dataset"),
    "a file that ends early": (IN_55[:-3], {}, f"file = .*: line {len(IN_55) - 3}: ends the file inside dataset 55"),
    "a dataset that ends early": ([*IN_55[:9], "    -1"], {}, "line 10: must not end the dataset, which needs"),
    "no modes": (UNITS, {}, "file = .*: has no normal modes"),
    "complex modes alone": (mode_55(0, {NODE: np.ones(12)}, data=5), {}, r"has complex modes alone \(1\): export real"),
    "no modal mass": (mode_55(0, mass=0.0), {}, "has no modal mass of mode 1: export modes with their modal mass"),
    "shapes of acceleration": (mode_55(0, quantity=12), {}, "says that the mode is one of acceleration; export shapes"),
    "words for numbers": ([line.replace("E-0", "x-0") for line in IN_55], {}, "line 10: must have numbers, frequency"),
    "one mode twice": ([*mode_55(0), *mode_55(0)], {}, "has mode 1 twice: keep one analysis in the file"),
    "no such node": (IN_55, {"node": 7}, "^node = 7: is not among the nodes of mode 1; of a test"),
    "more modes than there are": (IN_55, {"modes": 4}, "^modes = 4: must be from 1 to 3, the modes of the file"),
    "no units": (IN_55, {"length_unit": None}, r"^length_unit: must be given: the file has no units \(dataset 164\)"),
    "a unit of zero": (IN_55, {"mass_unit": 0.0}, "^mass_unit = 0.0: must be above zero"),
    "translations alone": (TESTED, {"node": 11}, "^rigid_nodes: must be given: the file has translations alone"),
    "no positions": (TESTED, {"rigid_nodes": [11, 12, 13]}, "^rigid_nodes = 101: has no position in the file"),
    "two nodes": ([*NODES, *TESTED], {"rigid_nodes": [11, 12]}, "must be three nodes or more that are not on one line"),
    "nodes on a line": ([*LINE, *TESTED], {"rigid_nodes": [11, 12, 13]}, "must be three nodes or more that are not on"),
    "a node that was not measured": ([*NODES, *IN_55], {"rigid_nodes": [11, 12, 13]}, "^rigid_nodes = 11: is not"),
    "nodes that bend": ([*NODES, *BENT], {"rigid_nodes": list(AROUND)}, "must move as one rigid body; [0-9]+% of"),
    "an axis that is none": (IN_55, {"hub": dict.fromkeys(HUB_AXES, "T3")}, "^hub.x = T3: unknown component"),
}  # fmt: skip


@pytest.mark.parametrize("kind", REFUSED)
def test_a_file_that_is_no_support_is_refused_in_one_line(tmp_path, kind):
    lines, options, message = REFUSED[kind]
    with pytest.raises(InputError) as caught:
        universal_modes(write(tmp_path, lines), **{"node": NODE} | GIVEN | options)
    told = re.sub(r"/\S*…", "…", str(caught.value))
    assert re.search(message, told) and "\n" not in told, told


def test_a_deck_takes_the_modes_of_a_file_and_those_of_a_test(tmp_path):
    head = 'base = "xv15-uncoupled"\n[case]\nname = "m"\ntitle = "m"\n[support]\nkind = "universal"\n'
    head += 'file = "modes.unv"\nnode = 101\nincludes_rotor = false\n'

    def deck(text):
        (tmp_path / "deck.toml").write_text(head + text, encoding="utf-8")
        return pp.load_case(tmp_path / "deck.toml")

    write(tmp_path, [*UNITS, *IN_55])
    is_the_structure(deck("").support)
    ratios = deck("damping_ratio = { value = [0.03, 0.01] }").support
    expected = 2 * np.array([0.03, 0.01, 0.01]) * FREQUENCY * MASS
    np.testing.assert_allclose(np.diag(ratios.damping), expected, rtol=DIGITS)
    write(tmp_path, [*UNITS, *NODES, *TESTED])
    is_the_structure(deck('rigid_nodes = "11, 12 13 14"').support, rtol=20 * DIGITS)
    with pytest.raises(InputError, match=r"^support.rigid_nodes = 11 x: must be whole numbers"):
        deck('rigid_nodes = "11 x"')
