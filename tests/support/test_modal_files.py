"""Modes of a structure from a file, and what their generalised masses are of: one rotor's structure, or two rotors'.

The structure is made up here: three modes, each of which moves the hub along all six axes.
"""

import numpy as np
import pytest
from scipy.io import mmwrite

import proprotor as pp
from proprotor.errors import InputError
from proprotor.model.first_order import state_matrix
from proprotor.model.rotor_model import rotor_model
from proprotor.model.several_rotors import MountedRotor, mount_rotors
from proprotor.support.matrix_files import support_from_matrices
from proprotor.support.normal_modes import HUB_AXES

ROUNDING = 1e-12  # two ways to the same numbers
NAMES = ("low", "middle", "high")
MASS = np.array([900.0, 1100.0, 1500.0])  # kg, kg and kg m²
FREQUENCY = np.array([19.0, 33.0, 58.0])  # rad/s
RATIO = np.array([0.011, 0.018, 0.009])
HUB = np.array(
    [
        [1.00, -0.12, 0.70],
        [0.05, -0.35, 0.02],
        [0.08, 1.00, -0.15],
        [-0.02, 0.28, 0.03],
        [0.09, 0.02, 1.00],
        [-0.27, 0.03, -0.06],
    ]
)
FOOT, SLUG = 0.3048, 14.593902937206364


def modal(**changes):
    """The arrays of the structure in SI."""
    arrays = {
        "mass": np.diag(MASS),
        "stiffness": np.diag(MASS * FREQUENCY**2),
        "damping": np.diag(2 * RATIO * FREQUENCY * MASS),
        "dofs": np.array(NAMES),
        "hub": HUB,
    }
    return {name: value for name, value in (arrays | changes).items() if value is not None}


def deck(folder, text):
    path = folder / "deck.toml"
    head = 'base = "xv15-uncoupled"\n[case]\nname = "modal"\ntitle = "modal"\n[support]\nincludes_rotor = "mass only"\n'
    path.write_text(head + text, encoding="utf-8")
    return pp.load_case(path)


def filed(folder, text='carries = "one rotor"\n', **changes):
    np.savez(folder / "modal.npz", **modal(**changes))
    return deck(folder, f'kind = "matrices"\nfile = "modal.npz"\n{text}')


def typed(folder, text="", mass=MASS):
    """The same modes, each number of them written in the deck."""
    lines = ['kind = "normal-modes"', text]
    for place, name in enumerate(NAMES):
        angle = name == "high"
        unit, per, turn = ("kg*m**2", " m/rad", "") if angle else ("kg", "", " rad/m")
        lines += ["[[support.modes]]", f'name = "{name}"', f'coordinate = "{"angle" if angle else "length"}"']
        lines += [f'generalized_mass = "{float(mass[place])!r} {unit}"']
        lines += [f'frequency = "{FREQUENCY[place]!r} rad/s"'.replace("np.float64(", "").replace(")", "")]
        lines += [f"damping_ratio = {float(RATIO[place])!r}"]
        for axis, value in zip(HUB_AXES, HUB[:, place], strict=True):
            after = turn if axis.startswith("alpha") else per
            number = float(value)
            lines += [f'{axis} = "{number!r}{after}"' if after else f"{axis} = {number!r}"]
    return deck(folder, "\n".join(lines) + "\n")


def roots(case):
    return np.sort_complex(np.linalg.eigvals(state_matrix(case.linearize(140.0))))


def test_modes_in_a_file_are_those_typed_by_number(tmp_path):
    by_number, by_file = typed(tmp_path), filed(tmp_path)
    assert by_file.support.names == NAMES == by_number.support.names
    for matrix in ("mass", "damping", "stiffness", "hub"):
        expected = getattr(by_number.support, matrix)
        np.testing.assert_allclose(
            getattr(by_file.support, matrix), expected, rtol=ROUNDING, atol=ROUNDING * np.abs(expected).max()
        )
    np.testing.assert_allclose(by_number.support.hub, HUB, rtol=ROUNDING)
    np.testing.assert_allclose(roots(by_file), roots(by_number), rtol=1e-9)  # eigenvalues lose three digits


def test_matrix_market_files_in_feet_and_slugs_are_the_same_modes(tmp_path):
    """A translation per unit of a coordinate without unit counts feet; masses are slug ft²."""
    energy = SLUG * FOOT**2
    for name in ("mass", "stiffness", "damping"):
        mmwrite(tmp_path / f"{name}.mtx", modal()[name] / energy, precision=17)
    mmwrite(tmp_path / "phi.mtx", HUB / np.array([[FOOT]] * 3 + [[1.0]] * 3), precision=17)
    (tmp_path / "names.txt").write_text("\n".join(NAMES), encoding="utf-8")
    found = deck(
        tmp_path,
        'kind = "matrices"\nmass = "mass.mtx"\nstiffness = "stiffness.mtx"\ndamping = "damping.mtx"\n'
        'dofs = "names.txt"\nhub_motion = "phi.mtx"\ncarries = "one rotor"\n'
        'length_unit = "1 ft"\nmass_unit = "1 slug"\n',
    ).support
    for matrix, expected in modal().items():
        if matrix != "dofs":
            np.testing.assert_allclose(getattr(found, matrix), expected, rtol=ROUNDING, atol=1e-12)


def test_modal_coordinates_may_couple_and_need_no_names(tmp_path):
    """In other coordinates, q = T p, the matrices are full and the roots the same."""
    turn = np.array([[1.0, 0.3, -0.2], [0.1, 1.0, 0.4], [-0.5, 0.2, 1.0]])
    full = {name: turn.T @ modal()[name] @ turn for name in ("mass", "stiffness", "damping")}
    coupled = filed(tmp_path, **full, hub=HUB @ turn, dofs=None)
    assert coupled.support.names == ("mode_1", "mode_2", "mode_3")
    np.testing.assert_allclose(roots(coupled), roots(filed(tmp_path)), rtol=1e-8)


def test_half_of_a_whole_aircraft_with_one_rotor_is_the_aircraft_with_two(tmp_path):
    """The aircraft of the same symmetric modes carries a rotor and its mirror image: mounted without any halving."""
    case = filed(tmp_path, 'carries = "two rotors"\n')
    np.testing.assert_allclose(case.support.mass, np.diag(MASS) / 2, rtol=ROUNDING)
    half = case.linearize(140.0, rotor_speed="constant")
    mirror = np.diag([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    whole = pp.NormalModes(
        NAMES, *(modal()[name] for name in ("mass", "damping", "stiffness")), HUB, includes_rotor="mass only"
    )
    rotor = rotor_model(case.rotor, case.operation, 140.0, rotor_speed="constant")
    hubs = {
        "right": MountedRotor(rotor, HUB),
        "left": MountedRotor(rotor, mirror @ HUB, mirrored=True),
    }
    both = np.linalg.eigvals(state_matrix(mount_rotors(hubs, whole)))
    own = np.linalg.eigvals(state_matrix(half))
    nearest = np.abs(own[:, None] - both).min(axis=1)
    np.testing.assert_array_less(nearest, 1e-9 * np.maximum(np.abs(own), 1))


def test_every_kind_of_modes_takes_one_rotor_or_two(tmp_path):
    one, two = typed(tmp_path), typed(tmp_path, 'carries = "two rotors"', 2 * MASS)
    for matrix in ("mass", "damping", "stiffness"):
        np.testing.assert_allclose(
            getattr(two.support, matrix), getattr(one.support, matrix), rtol=ROUNDING, atol=0
        )
    with pytest.raises(InputError, match=r'^carries = three rotors: must be "one rotor" or "two rotors"'):
        pp.NormalModes.from_frequencies(NAMES, MASS, FREQUENCY, RATIO, HUB, False, carries="three rotors")


def test_the_rotors_mass_goes_to_the_half_that_has_one_rotor():
    """Modes of a whole aircraft looked for with a point mass at each hub are those of its half with one."""
    given = {"damping_ratio": 0.01, "modes": 2}
    arrays = {name: value for name, value in modal(damping=None).items() if name != "dofs"}
    half = {name: arrays[name] / 2 for name in ("mass", "stiffness")} | {"hub": HUB}
    found = support_from_matrices(**arrays, carries="two rotors", rotor_mass=180.0, **given)
    expected = support_from_matrices(**half, carries="one rotor", rotor_mass=180.0, **given)
    np.testing.assert_allclose(found.stiffness, expected.stiffness, rtol=ROUNDING, atol=1e-9)


NOT_SAID = r"^support.carries: is missing: modal coordinates need \"one rotor\".* or \"two rotors\""


@pytest.mark.parametrize(
    ("text", "changes", "message"),
    [
        ("", {}, NOT_SAID),
        ('carries = "aircraft"\n', {}, r'^support.carries = aircraft: must be "one rotor" or "two rotors"'),
        (None, {"hub": HUB[:5]}, r"^support.hub = 5 x 3: must be 6 x 3: x, y, z, alpha_x"),
        (None, {"hub": HUB[:, :2]}, r"^support.hub = 6 x 2: must be 6 x 3"),
        (None, {"hub": HUB * 1j}, r"^support.hub = numbers of type complex128: must be real numbers"),
        (None, {"hub": np.where(HUB == 1.0, np.inf, HUB)}, r"^support.hub: must be finite"),
        (None, {"hub": 0 * HUB}, r"^support.hub: must not be zero: no coordinate moves the hub"),
        (None, {"hub": None}, r"^support.carries = one rotor: must be given with the motion of the hub"),
        (None, {"dofs": None, "hub": None}, r"^support.file = .*: has no array dofs"),
        (None, {"mass": None}, r"^support.file = .*: has no array mass"),
        (None, {"phi": HUB}, r"^support.file = .*: unknown array 'phi'; known: mass, stiffness"),
        (
            'carries = "one rotor"\n[support.hub]\nx = "low"\n',
            {},
            r"^support.hub: must not be given with a file that has the motion of the hub",
        ),
        (
            'carries = "one rotor"\nhub_motion = "phi.mtx"\n',
            {},
            r"^support.hub_motion: must not be given with file",
        ),
    ],
)
def test_modal_files_that_are_no_support(tmp_path, text, changes, message):
    with pytest.raises(InputError, match=message) as caught:
        filed(tmp_path, **({} if text is None else {"text": text}), **changes)
    assert len(str(caught.value).splitlines()) == 1


def test_the_motion_of_the_hub_is_named_or_filed_but_not_both(tmp_path):
    text = 'kind = "matrices"\nmass = "m.mtx"\nstiffness = "k.mtx"\ndofs = "d.txt"\nhub_motion = "phi.mtx"\n'
    with pytest.raises(InputError, match=r"^support.hub: must not be given with hub_motion"):
        deck(tmp_path, text + '[support.hub]\nx = "low"\n')
