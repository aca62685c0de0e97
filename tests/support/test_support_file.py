"""Supports from files of matrices: the same wing as its finite elements, and files that are none."""

import zipfile
from dataclasses import replace

import numpy as np
import pytest
from scipy.io import mmwrite
from scipy.sparse import coo_array, csc_array

import proprotor as pp
from proprotor.errors import InputError
from proprotor.model.first_order import state_matrix
from proprotor.support.beam_wing import beam_structure, beam_wing
from proprotor.support.matrix_files import read_matrix_market, read_npz, support_from_matrices
from proprotor.support.modal_reduction import lowest_modes
from proprotor.support.normal_modes import HUB_AXES
from tests.support.test_beam_wing import furthest, on_the_rotor, xv15_wing

RATIO = [0.01, 0.02, 0.01]


@pytest.fixture(scope="module")
def elements():
    wing, pylon, numbers = xv15_wing()
    return beam_wing(wing, pylon, damping_ratio=RATIO, rotor_mass=numbers["rotor_mass"])


def saved(folder, support, **changes):
    """The support's matrices in an .npz file."""
    arrays = {name: getattr(support, name) for name in ("mass", "stiffness", "damping")}
    arrays = arrays | {"dofs": np.array(support.names)} | changes
    np.savez(folder / "wing.npz", **{name: array for name, array in arrays.items() if array is not None})
    return folder / "wing.npz"


def written(folder, support):
    """The same as Matrix Market files and a list of names, with all digits."""
    files = {name: folder / f"{name}.mtx" for name in ("mass", "stiffness", "damping")}
    for name, path in files.items():
        mmwrite(path, coo_array(getattr(support, name)), precision=17)
    files["dofs"] = folder / "names.txt"
    files["dofs"].write_text("\n".join(support.names), encoding="utf-8")
    return files


def test_a_file_of_full_matrices_is_the_wing(tmp_path, elements):
    roots = on_the_rotor(elements)
    for support in (read_npz(saved(tmp_path, elements)), read_matrix_market(**written(tmp_path, elements))):
        assert support.names == elements.names
        assert furthest(roots, on_the_rotor(support)) < 1e-9


def test_six_modes_of_a_file_are_within_a_percent(tmp_path, elements):
    rotor = xv15_wing()[2]["rotor_mass"]
    path = saved(tmp_path, elements, damping=None)
    six = read_npz(path, modes=6, damping_ratio=RATIO, rotor_mass=rotor)
    assert six.names == tuple(f"mode_{k}" for k in range(1, 7))
    assert furthest(on_the_rotor(elements), on_the_rotor(six), below=300.0) < 0.01


def test_other_units_and_axes_are_the_same_wing(elements):
    """In inches and lbf s²/in, with axes X aft, Y to the right and Z up as structural codes have them."""
    inch, slinch = 0.0254, 4.4482216152605 / 0.0254
    translation = np.array(
        [not name.rpartition("_")[2].startswith("a") and "alpha" not in name for name in elements.names]
    )
    count = np.where(translation, inch, 1.0)  # metres per number of the file
    flip = np.array([-1.0 if name in ("hub_z", "hub_alpha_z") else 1.0 for name in elements.names])
    to_file = np.diag(count * flip)
    energy = slinch * inch**2
    parts = {
        name: to_file @ getattr(elements, name) @ to_file / energy
        for name in ("mass", "stiffness", "damping")
    }
    hub = {axis: f"hub_{axis}" for axis in HUB_AXES} | {"z": "-hub_z", "alpha_z": "-hub_alpha_z"}
    support = support_from_matrices(**parts, dofs=elements.names, hub=hub, length_unit=inch, mass_unit=slinch)
    assert furthest(on_the_rotor(elements), on_the_rotor(support)) < 1e-8


def test_a_large_sparse_structure_is_reduced_to_its_lowest_modes():
    """2000 springs and masses in a row beside the hub's six: the hub moves as it would alone."""
    n = 2000
    chain = 1e6 * (2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))
    stiffness, mass = np.zeros((n + 6, n + 6)), np.eye(n + 6)
    stiffness[:n, :n] = chain
    stiffness[n:, n:] = np.diag([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]) * 1e-3
    names = [f"link {k}" for k in range(n)] + [f"hub_{axis}" for axis in HUB_AXES]
    support = support_from_matrices(csc_array(mass), csc_array(stiffness), dofs=names, modes=4)
    np.testing.assert_allclose(np.diag(support.stiffness), np.array([1, 2, 3, 4]) * 1e-3, rtol=1e-8)
    np.testing.assert_allclose(np.abs(support.hub), np.eye(6)[:, :4], atol=1e-6)
    few = lowest_modes(mass[-6:, -6:], stiffness[-6:, -6:], 4)
    np.testing.assert_allclose(few.frequency**2, np.diag(support.stiffness), rtol=1e-8)


def test_a_structure_that_is_free_to_move_keeps_its_rigid_modes():
    stiffness = np.zeros((6, 6))
    stiffness[0, 0] = 400.0
    names = [f"hub_{axis}" for axis in HUB_AXES]
    support = support_from_matrices(100 * np.eye(6), stiffness, dofs=names)
    np.testing.assert_array_equal(support.stiffness, stiffness)
    np.testing.assert_allclose(lowest_modes(100 * np.eye(6), stiffness).frequency, [0, 0, 0, 0, 0, 2])


def good(n=7):
    names = ["inner", *(f"hub_{axis}" for axis in HUB_AXES)]
    return dict(mass=np.eye(n), stiffness=100 * np.eye(n), dofs=names)


def entry(matrix, row, column, value):
    changed = np.array(matrix, dtype=float)
    changed[row, column] = value
    return changed


HUB = {axis: f"hub_{axis}" for axis in HUB_AXES}
MISTAKES = [
    (
        {"dofs": ["a", "b", "c", "d", "e", "f", "g"]},
        "hub.x = hub_x: is none of the coordinates of the matrices",
    ),
    ({"hub": {a: n for a, n in HUB.items() if a != "alpha_z"}}, "hub.alpha_z: is missing: all six"),
    ({"hub": HUB | {"y": "hub_x"}}, "hub.y = hub_x: must not be named for two axes"),
    ({"hub": HUB | {"q": "hub_x"}}, "hub.q = hub_x: unknown axis 'q'; known: x"),
    ({"dofs": ["hub_x", *good()["dofs"][1:]]}, "dofs = hub_x: must not name two coordinates"),
    ({"mass": np.eye(6)}, "mass = 6 x 6: must be 7 x 7, one row and column for each of the dofs"),
    ({"stiffness": np.ones((7, 6))}, "stiffness = 7 x 6: must be 7 x 7"),
    ({"stiffness": np.ones(7)}, "stiffness = 7: must be 7 x 7"),
    ({"stiffness": entry(100 * np.eye(7), 0, 1, 3.0)}, "stiffness: must be symmetric: 1 entries differ"),
    ({"damping": entry(np.zeros((7, 7)), 2, 1, 3.0)}, "damping: must be symmetric"),
    ({"mass": entry(np.eye(7), 0, 0, np.nan)}, "mass: must be finite"),
    ({"mass": np.eye(7) * 1j}, "mass = numbers of type complex128: must be real numbers"),
    ({"mass": np.full((7, 7), "a")}, "mass = numbers of type <U1: must be real numbers"),
    ({"mass": -np.eye(7)}, "mass: must not be negative in any direction"),
    ({"mass": np.zeros((7, 7))}, "mass: must not be zero"),
    ({"stiffness": -np.eye(7)}, "stiffness: must not be negative in any direction"),
    ({"mass": np.diag([0, 1, 1, 1, 1, 1, 1.0])}, "modes: must be given: there are coordinates without mass"),
    ({"modes": 9}, "modes = 9: must be from 1 to 7"),
    ({"damping_ratio": -0.1}, "damping_ratio = -0.1: must be at least 0 and below 1"),
    ({"length_unit": 0.0}, "length_unit = 0.0: must be above zero"),
]


@pytest.mark.parametrize(("changes", "message"), MISTAKES, ids=[message for _, message in MISTAKES])
def test_matrices_that_are_no_support(changes, message):
    with pytest.raises(InputError) as caught:
        support_from_matrices(**good() | changes)
    assert str(caught.value).startswith(message)
    assert "\n" not in str(caught.value)


def test_a_large_structure_must_be_reduced():
    names = [*(f"inner {k}" for k in range(500)), *HUB.values()]
    with pytest.raises(InputError, match=r"^modes: must be given with more than 400 coordinates"):
        support_from_matrices(np.eye(506), np.eye(506), dofs=names)


def damaged(path, cut=0.5):
    content = path.read_bytes()
    path.write_bytes(content[: int(len(content) * cut)])


def test_damaged_and_foreign_npz_files(tmp_path, elements):
    path = saved(tmp_path, elements)
    damaged(path)
    with pytest.raises(InputError, match=r"^file = .*: is damaged, or another kind of file$"):
        read_npz(path)
    (tmp_path / "text.npz").write_text("mass", encoding="utf-8")
    with pytest.raises(InputError, match=r"^file = .*: is damaged"):
        read_npz(tmp_path / "text.npz")
    with pytest.raises(InputError, match=r"^file = .*: no such file"):
        read_npz(tmp_path / "none.npz")
    with pytest.raises(InputError, match=r"^file = .*: no such file"):
        read_npz(tmp_path)
    with pytest.raises(InputError, match=r"^file = .*: holds Python objects"):
        read_npz(saved(tmp_path, elements, mass=np.array([{}], dtype=object)))
    with pytest.raises(InputError, match=r"^file = .*: has no array dofs"):
        read_npz(saved(tmp_path, elements, dofs=None))
    with pytest.raises(InputError, match=r"^file = .*: unknown array 'masss'; did you mean mass\?"):
        read_npz(saved(tmp_path, elements, masss=np.eye(2)))


def test_a_file_that_unpacks_to_too_much_is_not_read(tmp_path):
    path = tmp_path / "bomb.npz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive, archive.open("mass.npy", "w") as entry:
        for _ in range(60):
            entry.write(bytes(10_000_000))
    with pytest.raises(InputError, match=r"^file = .*: must not hold more than 500 MB"):
        read_npz(path)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "is damaged"),
        ("%%MatrixMarket matrix coordinate real general\n3 3 2\n1 1 1.0\n", "is damaged"),
        ("%%MatrixMarket matrix coordinate real general\n3 3 1\n9 9 1.0\n", "is damaged"),
        ("%%MatrixMarket matrix coordinate real general\n99999999 99999999 1\n1 1 1.0\n", "is too large"),
        ("%%MatrixMarket matrix array real general\n90000 90000\n", "is too large"),
        ("%%MatrixMarket matrix coordinate complex general\n1 1 1\n1 1 1.0 2.0\n", "must hold real numbers"),
        ("\x00\x01\x02", "is damaged"),
    ],
)
def test_damaged_matrix_market_files(tmp_path, elements, content, message):
    files = written(tmp_path, elements)
    files["stiffness"].write_text(content, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_matrix_market(**files)
    assert str(caught.value).startswith("stiffness = ")
    assert message in str(caught.value) and "\n" not in str(caught.value)


def deck(tmp_path, text):
    path = tmp_path / "deck.toml"
    path.write_text(
        'base = "xv15-uncoupled"\n[case]\nname = "filed"\ntitle = "filed"\n' + text, encoding="utf-8"
    )
    return pp.load_case(path)


def test_a_deck_of_files_that_stand_beside_it(tmp_path, elements):
    saved(tmp_path, elements)
    written(tmp_path, elements)
    one = deck(tmp_path, '[support]\nkind = "matrices"\nfile = "wing.npz"\nincludes_rotor = false\n')
    several = deck(
        tmp_path,
        '[support]\nkind = "matrices"\nmass = "mass.mtx"\nstiffness = "stiffness.mtx"\ndamping = "damping.mtx"\n'
        'dofs = "names.txt"\nincludes_rotor = false\n[support.hub]\n'
        + "".join(f'{axis} = "{name}"\n' for axis, name in HUB.items()),
    )
    for case in (one, several):
        np.testing.assert_allclose(case.support.stiffness, elements.stiffness, rtol=1e-12)
    reduced = deck(
        tmp_path,
        '[support]\nkind = "matrices"\nfile = "wing.npz"\nincludes_rotor = false\nmodes = 3\nrotor_mass = "12 slug"\n',
    )
    assert reduced.support.names == ("mode_1", "mode_2", "mode_3")


def test_decks_of_a_pivot_and_of_a_rigid_support(tmp_path):
    pivot = deck(
        tmp_path,
        '[support]\nkind = "pivot"\ndistance = "4 ft"\npitch_inertia = "900 slug*ft**2"\n'
        'yaw_inertia = "950 slug*ft**2"\npitch_stiffness = "1e6 ft*lbf/rad"\nyaw_stiffness = "2e6 ft*lbf/rad"\n'
        "includes_rotor = true\n",
    ).support
    assert pivot.names == ("pitch", "yaw")
    np.testing.assert_allclose(pivot.hub[0], [4 * 0.3048, 0])
    np.testing.assert_allclose(pivot.stiffness[1, 1] / pivot.stiffness[0, 0], 2)
    fixed = deck(tmp_path, '[support]\nkind = "rigid"\n')
    model = fixed.linearize([80.0, 150.0])
    alone = pp.load_case("xv15-uncoupled").linearize([80.0, 150.0])
    own = [name for name in alone.dofs if name not in ("beam", "chord", "torsion")]
    for kind in "MCK":
        np.testing.assert_array_equal(getattr(model, kind), getattr(alone.submodel(tuple(own)), kind))
    assert np.isfinite(state_matrix(model)).all()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('kind = "beam"', "support.kind = beam: must be 'normal-modes', 'beam-wing'"),
        ("includes_rotor = true\nkind = 3", "support.kind = 3: must be 'normal-modes'"),
        ('kind = "rigid"\nspan = "1 m"', "support.span = 1 m: unknown field 'span'; known: kind"),
        ('kind = "pivot"\nincludes_rotor = true', "support.distance: is missing"),
        ('kind = "matrices"\nincludes_rotor = true', "support.file: is missing; give file or mass"),
        (
            'kind = "matrices"\nincludes_rotor = true\nfile = "a.npz"\nmass = "b.mtx"',
            "support.mass: must not be given with file",
        ),
        ('kind = "matrices"\nincludes_rotor = true\nmass = "b.mtx"', "support.stiffness: is missing"),
        ('kind = "matrices"\nincludes_rotor = true\nfile = "a.npz"', "support.file = a.npz: no such file"),
        (
            'kind = "matrices"\nincludes_rotor = true\nfile = "a.npz"\nmodes = 1.5',
            "support.modes = 1.5: must be a whole number, at least 1",
        ),
        (
            'kind = "matrices"\nincludes_rotor = true\nfile = "a.npz"\nhub = 3',
            "support.hub = 3: must be a table",
        ),
        (
            'kind = "nastran"\ngrid = 11\nfile = "a.op2"\nincludes_rotor = true',
            "support.file = a.op2: no such file",
        ),
    ],
)
def test_a_support_of_a_deck_that_cannot_be(tmp_path, text, message):
    with pytest.raises(InputError) as caught:
        deck(tmp_path, f"[support]\n{text}\n")
    lines = str(caught.value).splitlines()
    assert any(line.startswith(message) for line in lines), lines


def test_decks_of_a_beam_wing_that_cannot_be(tmp_path):
    def changed(text):
        path = tmp_path / "wing.toml"
        path.write_text(
            f'base = "xv15-wing"\n[case]\nname = "w"\ntitle = "w"\n[support]\n{text}\n', encoding="utf-8"
        )
        return pp.load_case(path)

    for text, message in [
        ('span = "165 deg"', "support.span = 165 deg: must be a length"),
        (
            'beam_stiffness = "3.7e9 lbf"',
            'support.beam_stiffness = 3.7e9 lbf: must be a bending or torsion stiffness, such as "3.7e9',
        ),
        (
            'damping_ratio = "1 %"\nloss_factor = "2 %"',
            "support.loss_factor: must not be given with damping_ratio",
        ),
        (
            'downstop_stiffness_off = "0 N*m/rad"',
            "support.downstop_stiffness_off = 0 N*m/rad: must be positive",
        ),
        ('sweep = "95 deg"', "support.sweep = 95 deg: must lie between -90 and 90 degrees"),
        (
            'mass_per_length = { y_over_span = [0.0, 0.5], value = [1, 2], unit = "lb/in" }',
            "support.mass_per_length = 2 values in lb/in: must have stations that rise from 0 to 1",
        ),
        (
            'mass_per_length = { y_over_span = [0.0, 1.5], value = [1, 2], unit = "lb/in" }',
            "support.mass_per_length.y_over_span = [0.0, 1.5]: must lie between 0 (mount) and 1 (tip)",
        ),
    ]:
        with pytest.raises(InputError) as caught:
            changed(text)
        assert str(caught.value).startswith(message), str(caught.value)
    tapered = changed('mass_per_length = { y_over_span = [0, 1], value = [3, 2], unit = "lb/in" }')
    uniform = pp.load_case("xv15-wing")
    assert tapered.support.names == uniform.support.names
    wing, pylon, _ = xv15_wing()
    profile = (np.array([0.0, 1.0]), np.array([3.0, 2.0]) * 0.45359237 / 0.0254)
    expected = beam_structure(replace(wing, mass_per_length=profile, elements=8), pylon)
    found = lowest_modes(expected.mass, expected.stiffness, 3).frequency
    given = lowest_modes(tapered.support.mass, tapered.support.stiffness, 3).frequency
    np.testing.assert_allclose(given, found, rtol=1e-3)  # on modes that have the rotor's mass at the hub
