"""Normal modes from Nastran results: a wing's modes, written as an .op2 file and read back."""

import numpy as np
import pytest

import proprotor as pp
from proprotor.errors import InputError
from proprotor.support.beam_wing import beam_structure, beam_wing
from proprotor.support.modal_reduction import lowest_modes
from proprotor.support.nastran import nastran_modes
from tests.nastran.written import HUB, Op2, Run
from tests.support.test_beam_wing import furthest, on_the_rotor, with_rotor, xv15_wing

SINGLE = 1e-6  # the file holds single precision
INCH, SLINCH = 0.0254, 4.4482216152605 / 0.0254  # lbf s²/in


def to_aircraft(hub):
    """Hub motion along I, J, K in axes X aft, Y to the right, Z up, translations in inches."""
    up, right, forward, *turns = hub
    return np.array([-forward / INCH, right / INCH, up / INCH, -turns[2], turns[1], turns[0]])


def write_op2(path, frequency, generalized_mass, motion, subcases=(1,), eigenvalues=True):
    """Modes (6, k) of the grid point HUB, and those of another in which nothing moves."""
    file = Op2()
    runs = [Run(frequency**2, np.asarray(generalized_mass), motion, subcase) for subcase in subcases]
    if eigenvalues and runs:
        file.lama(runs[0])
    for run in runs:
        file.vectors(run)
    return file.save(path)


@pytest.fixture(scope="module")
def modes():
    """The lowest eight of the XV-15's wing without the rotor, of the size Nastran's MAX normalisation gives them."""
    wing, pylon, _ = xv15_wing()
    structure = beam_structure(wing, pylon)
    frequency, shapes = lowest_modes(structure.mass, structure.stiffness, 8)
    size = 1 / np.abs(structure.hub @ shapes).max(axis=0)
    return frequency, size**2, structure.hub @ shapes * size


@pytest.fixture(scope="module")
def file(tmp_path_factory, modes):
    frequency, mass, hub = modes
    path = tmp_path_factory.mktemp("nastran") / "wing.op2"
    return write_op2(path, frequency, mass / (SLINCH * INCH**2), to_aircraft(hub))


def read(file, **options):
    given = dict(grid=HUB, includes_rotor=False, length_unit=INCH, mass_unit=SLINCH)
    return nastran_modes(file, **given | options)


def test_modes_are_read_in_the_rotors_axes_and_units(file, modes):
    frequency, mass, hub = modes
    support = read(file, damping_ratio=[0.01, 0.02])
    assert support.names[:2] == ("mode_1", "mode_2")
    np.testing.assert_allclose(np.diag(support.mass), mass, rtol=SINGLE)
    np.testing.assert_allclose(np.diag(support.stiffness), mass * frequency**2, rtol=3 * SINGLE)
    np.testing.assert_allclose(support.hub, hub, rtol=SINGLE, atol=SINGLE)
    ratio = np.diag(support.damping) / (2 * np.diag(support.mass) * frequency)
    np.testing.assert_allclose(ratio, [0.01] + 7 * [0.02], rtol=3 * SINGLE)


def test_of_a_run_with_two_rotors_half_goes_with_one(file):
    one, two = read(file), read(file, carries="two rotors")
    for matrix in ("mass", "stiffness"):
        np.testing.assert_array_equal(getattr(two, matrix), getattr(one, matrix) / 2)
    np.testing.assert_array_equal(two.hub, one.hub)
    with pytest.raises(InputError, match=r'^carries = both: must be "one rotor" or "two rotors"'):
        read(file, carries="both")


def test_with_the_rotor_they_are_the_wing_they_came_from(file):
    """Eight modes, and six named by hand, of the finite elements all of whose coordinates were kept."""
    wing, pylon, _ = xv15_wing()
    roots = on_the_rotor(beam_wing(wing, pylon, damping_ratio=0.01))
    assert furthest(on_the_rotor(read(file, damping_ratio=0.01)), roots, below=150.0) < 0.01
    names = ("beam", "chord", "torsion", "a", "b", "c")
    assert read(file, modes=6, names=names).names == names


def test_a_deck_of_nastran_results(file, tmp_path):
    path = tmp_path / "deck.toml"
    path.write_text(
        'base = "xv15-uncoupled"\n[case]\nname = "n"\ntitle = "n"\n'
        f'[support]\nkind = "nastran"\nfile = "{file}"\ngrid = {HUB}\n'
        'includes_rotor = false\nlength_unit = "1 in"\nmass_unit = "1 lbf*s**2/in"\ndamping_ratio = "1 %"\n',
        encoding="utf-8",
    )
    np.testing.assert_allclose(
        pp.load_case(path).support.stiffness, read(file, damping_ratio=0.01).stiffness, rtol=1e-9
    )


def test_axes_can_be_named(file):
    hub = {"x": "T1", "y": "-T2", "z": "T3", "alpha_x": "R1", "alpha_y": "-R2", "alpha_z": "R3"}
    turned, usual = read(file, hub=hub).hub, read(file).hub
    np.testing.assert_array_equal(turned[[0, 1, 2]], [-usual[2], -usual[1], usual[0]])
    np.testing.assert_array_equal(turned[[3, 4, 5]], [-usual[5], -usual[4], usual[3]])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"grid": 5}, "grid = 5: has no eigenvectors in the file: the hub's grid point is missing"),
        ({"modes": 9}, "modes = 9: must be from 1 to 8, the modes of the file"),
        ({"subcase": 3}, "subcase = 3: is not in the file, which has 1"),
        ({"hub": {"x": "T3"}}, "hub.y: is missing: all six motions"),
        ({"hub": {"w": "T3"}}, "hub.w = T3: unknown axis 'w'; known: x"),
        (
            {"hub": dict.fromkeys(("x", "y", "z", "alpha_x", "alpha_y", "alpha_z"), "T9")},
            "hub.x = T9: unknown",
        ),
        ({"damping_ratio": 2.0}, "damping_ratio = 2.0: must be at least 0 and below 1"),
    ],
)
def test_what_is_not_in_the_file(file, options, message):
    with pytest.raises(InputError) as caught:
        read(file, **options)
    assert str(caught.value).startswith(message)


def test_files_without_what_is_needed(tmp_path, modes):
    frequency, mass, hub = modes
    several = write_op2(tmp_path / "two.op2", frequency, mass, hub, subcases=(1, 2))
    with pytest.raises(InputError, match=r"^subcase: must be given: the file has 1, 2"):
        read(several)
    assert len(read(several, subcase=2).names) == 8
    bare = write_op2(tmp_path / "bare.op2", frequency, mass, hub, eigenvalues=False)
    with pytest.raises(InputError, match=r"has no eigenvalue table \(LAMA\)"):
        read(bare)
    empty = write_op2(tmp_path / "empty.op2", frequency, mass, hub, subcases=())
    with pytest.raises(InputError, match=r"has no real eigenvectors"):
        read(empty)
    nothing = write_op2(tmp_path / "zero.op2", frequency, 0 * mass, hub)
    with pytest.raises(InputError, match=r"must hold finite eigenvectors and generalised masses above zero"):
        read(nothing)


@pytest.mark.parametrize("share", [0.0, 0.02, 0.3, 0.9])
def test_a_damaged_file_is_refused_in_one_line(file, tmp_path, share):
    content = file.read_bytes()
    broken = tmp_path / "broken.op2"
    broken.write_bytes(content[: int(share * len(content))])
    with pytest.raises(InputError) as caught:
        read(broken)
    assert str(caught.value).startswith("file = ") and "\n" not in str(caught.value)
    with pytest.raises(InputError, match="no such file"):
        read(tmp_path / "none.op2")


def test_modes_with_the_rotors_mass_on(tmp_path):
    """includes_rotor: the run had the whole rotor as a rigid body, which the rotor model then takes off again."""
    wing, pylon, _ = xv15_wing()
    structure = beam_structure(wing, pylon)
    rotor_mass = 181.0
    loaded = with_rotor(structure, rotor_mass)
    frequency, shapes = lowest_modes(loaded.mass, loaded.stiffness, 5)
    path = write_op2(tmp_path / "on.op2", frequency, np.ones(5), to_aircraft(structure.hub @ shapes))
    support = read(path, includes_rotor=True, mass_unit=1 / INCH**2)
    assert support.includes_rotor
    np.testing.assert_allclose(np.diag(support.mass), 1, rtol=SINGLE)
