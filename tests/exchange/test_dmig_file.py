"""A rotor as direct matrix input of Nastran: read back, and on a structure in another program's units and axes."""

import numpy as np
import pytest
from scipy.linalg import eigvals

import proprotor as pp
from proprotor.errors import InputError
from proprotor.nastran.dmig import read_dmig
from proprotor.nastran.text_files import lines_of

DIGITS = (
    5e-11  # fields of 16 characters have room for 11 digits of a negative number below 1, and more of others
)
INCH, SLINCH = 0.0254, 4.4482216152605 / 0.0254
GRID, FIRST = 1101, 9001
# x up, y outboard and z forward on X aft, Y to the right, Z up: component and sign of each motion of the hub.
COMPONENTS = [(3, 1.0), (2, 1.0), (1, -1.0), (6, 1.0), (5, 1.0), (4, -1.0)]


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15")


@pytest.fixture(scope="module")
def model(case):
    return case.linearize(190.0)


def write(model, path, **options):
    given = dict(grid=GRID, first_extra_point=FIRST, length_unit=INCH, mass_unit=SLINCH)
    pp.save_dmig(model, path, **given | options)
    return path


def matrices_in(path):
    """The matrices of a file by (point, component), read by columns of 8 and 16 characters and by nothing else."""
    found, column, name = {}, None, ""
    for line in path.read_text(encoding="ascii").splitlines():
        assert line.startswith("$") or len(line) <= 72
        if line.startswith("DMIG*"):
            name, column = line[8:24].strip(), (int(line[24:40]), int(line[40:56]))
        elif line.startswith("DMIG "):
            assert line[24:].split() == ["1", "2", "2"] or line.split()[2:] == ["0", "1", "2", "2"]
            found[line[8:16].strip()] = {}
        elif line.startswith("*"):
            row = int(line[8:24]), int(line[24:40])
            found[name][row, column] = float(line[40:56].replace("D", "e"))
    return found


def in_si(entries, dofs):
    """A matrix (n, n) in SI, in the order of the rotor's coordinates: work per unit of each motion of the hub."""
    places = [(GRID, component) for component, _ in COMPONENTS]
    places += [(FIRST + extra, 0) for extra in range(len(dofs) - 6)]
    unit = [sign / (INCH if component <= 3 else 1.0) for component, sign in COMPONENTS] + [1.0] * (
        len(dofs) - 6
    )
    energy = SLINCH * INCH**2
    return np.array(
        [
            [entries.get((row, column), 0.0) * energy * unit[i] * unit[j] for j, column in enumerate(places)]
            for i, row in enumerate(places)
        ]
    )


def test_the_matrices_of_the_file_are_those_of_the_rotor(model, tmp_path):
    found = matrices_in(write(model, tmp_path / "rotor.bdf"))
    assert list(found) == ["MROTOR", "BROTOR", "KROTOR"]
    for name, own in (("MROTOR", model.rotor.M), ("BROTOR", model.rotor.C), ("KROTOR", model.rotor.K)):
        np.testing.assert_allclose(in_si(found[name], model.rotor.dofs), own, rtol=DIGITS, atol=0)


def test_the_reader_of_direct_matrix_input_reads_them_too(model, tmp_path):
    path = write(model, tmp_path / "rotor.bdf")
    read, entries = read_dmig(lines_of(path)), matrices_in(path)
    assert read.names == (*(f"{GRID}.{part}" for part in ("T1", "T2", "T3", "R1", "R2", "R3")),
                          *(str(FIRST + extra) for extra in range(12)))  # fmt: skip
    for name, matrix in read.matrices.items():
        assert sorted(matrix[matrix != 0]) == sorted(entries[name].values())


def test_on_a_structure_in_inches_the_roots_are_those_of_the_mounted_rotor(case, model, tmp_path):
    """The run: modes of the bare wing at the grid point, and the matrices at the grid point and the extra points."""
    found = matrices_in(write(model, tmp_path / "rotor.bdf"))
    support, energy = case.support, SLINCH * INCH**2
    free = (
        model.M[:3, :3] - support.hub.T @ model.rotor.M[:6, :6] @ support.hub
    )  # of the wing without the rotor
    motion = np.zeros((6, 3))
    for (component, sign), row in zip(COMPONENTS, support.hub, strict=True):
        motion[component - 1] = sign * row / (INCH if component <= 3 else 1.0)
    points = [(GRID, component) for component in range(1, 7)] + [(FIRST + extra, 0) for extra in range(12)]
    onto = np.block([[motion, np.zeros((6, 12))], [np.zeros((12, 3)), np.eye(12)]])
    whole = []
    for name, wing in (("MROTOR", free), ("BROTOR", support.damping), ("KROTOR", support.stiffness)):
        rotor = np.array([[found[name].get((row, column), 0.0) for column in points] for row in points])
        own = np.zeros((15, 15))
        own[:3, :3] = wing / energy
        whole.append(own + onto.T @ rotor @ onto)
    mass, damping, stiffness = whole
    zero, one = np.zeros((15, 15)), np.eye(15)
    roots = eigvals(np.block([[zero, one], [-stiffness, -damping]]), np.block([[one, zero], [zero, mass]]))
    expected = model.modes().eigenvalue.values
    expected = expected[np.isfinite(expected) & (expected.imag > 1.0)]
    assert len(expected) > 10
    for root in expected:
        assert np.abs(roots - root).min() < 1e-9 * abs(root)


def test_the_heading_names_what_the_points_are(model, tmp_path):
    text = write(model, tmp_path / "rotor.bdf").read_text(encoding="ascii")
    assert "$ Rotor at 190 m/s. Case xv15 (" in text
    assert "$ 1101 -T1: z of the hub\n" in text
    for extra, name in enumerate(model.rotor.dofs[6:]):
        assert f"$ {FIRST + extra}: {name}\nEPOINT  {FIRST + extra:8d}\n" in text


def test_a_rotor_alone_and_other_axes(model, tmp_path):
    one = write(model, tmp_path / "a.bdf").read_text(encoding="ascii")
    assert write(model.rotor, tmp_path / "b.bdf").read_text(encoding="ascii") == one
    axes = {"x": "T1", "y": "T2", "z": "T3", "alpha_x": "R1", "alpha_y": "R2", "alpha_z": "-R3"}
    found = matrices_in(write(model, tmp_path / "c.bdf", hub=axes, length_unit=1.0, mass_unit=1.0))
    assert found["MROTOR"][(GRID, 1), (GRID, 1)] == pytest.approx(model.rotor.M[0, 0], rel=DIGITS)
    assert found["BROTOR"][(GRID, 3), (GRID, 6)] == pytest.approx(-model.rotor.C[2, 5], rel=DIGITS)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"grid": 0}, "grid = 0: must be a number of a point"),
        (
            {"first_extra_point": 99_999_999},
            "first_extra_point = 99999999: must be a number of a point, from 1 to",
        ),
        ({"grid": 1101.5}, "grid = 1101.5: must be a number of a point"),
        ({"grid": "1101"}, "grid = 1101: must be a number of a point"),
        ({"grid": True}, "grid = true: must be a number of a point"),
        ({"first_extra_point": None}, "first_extra_point: must be a number of a point"),
        ({"first_extra_point": 1100}, "grid = 1101: must not be one of the extra points, 1100 to 1111"),
        ({"length_unit": 0.0}, "length_unit = 0.0: must be above zero"),
        ({"mass_unit": float("nan")}, "mass_unit = nan: must be finite"),
        ({"hub": {"x": "T1"}}, "hub.y: is missing"),
        (
            {"hub": dict.fromkeys(("x", "y", "z", "alpha_x", "alpha_y", "alpha_z"), "T1")},
            "hub: must name six different components",
        ),
    ],
)
def test_what_cannot_be_written_is_refused_before_a_file_is_there(model, tmp_path, options, message):
    with pytest.raises(InputError) as caught:
        write(model, tmp_path / "rotor.bdf", **options)
    assert str(caught.value).startswith(message)
    assert not list(tmp_path.iterdir())


def test_models_that_are_no_rotor_at_one_airspeed(case, model, tmp_path):
    with pytest.raises(InputError, match=r"^model = \(2,\) points: must be at one airspeed"):
        write(case.linearize([100.0, 190.0]), tmp_path / "rotor.bdf")
    with pytest.raises(InputError, match=r"^model = .*: must begin with x"):
        write(model.rotor.submodel(model.rotor.dofs[6:]), tmp_path / "rotor.bdf")
    with pytest.raises(InputError, match=r"must end in \.bdf"):
        write(model, tmp_path / "rotor.txt")
    failed = case.linearize(2000.0)
    with pytest.raises(InputError, match=r"^airspeed = 2000 m/s: "):
        write(failed, tmp_path / "rotor.bdf")
    assert not list(tmp_path.iterdir())


def test_control_loops_are_refused_since_they_are_no_part_of_the_rotor(tmp_path):
    loop = pp.ControlLoop(name="hold", sensors="x rate", inputs="cyclic_1c", gain=-1e-3)
    closed = pp.load_case("xv15-uncoupled").with_control(loop).linearize(100.0)
    with pytest.raises(pp.InputError, match="are not among the rotor's matrices"):
        pp.save_dmig(closed, tmp_path / "a.bdf", grid=1, first_extra_point=10)
    assert not list(tmp_path.iterdir())
